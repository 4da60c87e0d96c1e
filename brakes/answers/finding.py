"""Ranges of results of a brake over tolerances, and values of an input for which a result is as wanted."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from time import perf_counter
from typing import Any

import numpy as np

from beamdyn.common.edge.command_options import SPREAD
from beamdyn.common.edge.exit_codes import NoAnswer
from beamdyn.common.edge.input_sweep import MOST_ONE_BY_ONE, Output, chosen
from beamdyn.common.edge.inputs import Input, Quantity, SlopeQuantity
from beamdyn.common.edge.units import InvalidInput, in_plain_characters, unit_as_written
from beamdyn.common.edge.varied_inputs import Axis, find_input, parse_axis, parse_spreads
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.inputs.described import part_at
from beamdyn.common.parallel.tasks import TaskRunner
from beamdyn.common.results.result import Provenance
from beamdyn.common.spreading import DEFAULT_SAMPLES
from beamdyn.common.spreading.solve import SpreadAnswers, solve_spread
from beamdyn.common.spreading.spread_result import Spread
from beamdyn.common.spreading.statistics import check_samples, check_seed, count_designs
from beamdyn.common.spreading.tolerances import SpreadInput
from brakes.answers.base import ERROR, BrakeType, SweepRequest
from brakes.answers.tables import SCALES
from brakes.common.finding import find, find_whole
from brakes.common.solutions import Solutions
from brakes.config.mechanism import Angle


def spread_of_brake(
    brake: BrakeType[Any],
    tables: Mapping[str, Any],
    source: str,
    texts: Sequence[str],
    results: str | None = None,
    samples: int = DEFAULT_SAMPLES,
    seed: int = 0,
    run: TaskRunner | None = None,
) -> Spread:
    """Find the ranges of a brake's results over tolerances of its inputs.

    Parameters
    ----------
    brake : BrakeType
        Type of the brake.
    tables : mapping
        Tables of the design's file.
    source : str
        Origin of the tables, for messages.
    texts : sequence of str
        Inputs and their tolerances, such as "brake.friction=+-10%".
    results : str, optional
        Names of outputs, separated by commas; by default those of a sweep.
    samples, seed : int
        Number of samples and seed, as for `beamdyn.spread`.
    run : TaskRunner, optional
        Runs the tasks with designs that are solved one by one; by default in this process.

    Raises
    ------
    ValueError
        If an input or a result is not known, or a tolerance is not valid or reaches values that an input
        cannot have.
    NoAnswer
        If no design has an answer.
    """
    design = brake.read(tables, source)
    named = brake.default_results(design) if results is None else results
    wanted = chosen(brake.outputs(design), named, "--what")
    inputs = {entry.path: entry for entry in brake.sweep_inputs(design, tables)}
    used, cautions = check_samples(samples)
    given = parse_spreads([*inputs.values()], texts, lambda entry: nominal_of(design, entry))
    for each in given:
        _check_reach(inputs[each.name], each)
    if (designs := count_designs(len(given), used)) > brake.most_cases:
        bound = f"so many samples make {designs} designs, and at most {brake.most_cases} can be solved"
        raise InvalidValue("--samples", samples, bound, "give fewer samples")
    units = {each.name: each.unit for each in given}
    answers = _BrakeAnswers(brake, SweepRequest(design, tables, (), "zip", run), inputs, units, wanted)
    return solve_spread(named, given, used, check_seed(seed), answers, cautions=cautions)


def nominal_of(design: Any, entry: Input, option: str = SPREAD) -> tuple[float, str]:
    """Return the value of an input in a design, and its SI unit; `option` is named in messages.

    Raises
    ------
    InvalidValue
        If the design has no value of this input.
    """
    value = part_at(design, entry.path)
    if not isinstance(value, int | float):
        raise InvalidValue(option, entry.path, "the file gives it no value", "give it one, or leave it out")
    return float(value), "rad" if isinstance(value, Angle) else entry.quantity.unit


def _check_reach(entry: Input, given: SpreadInput) -> None:
    """Refuse a tolerance that reaches beyond the input's bounds."""
    in_unit = "1 deg" if entry.quantity.unit == "rad" else None  # unit in which the message states the bounds
    for end in given.distribution.reach:
        try:
            entry.quantity.within_bounds(in_unit or end, end)
        except InvalidInput as error:
            said = f", which {given.text} reaches"
            raise InvalidValue(
                given.name, end, error.bound, "give a smaller spread", given.unit, where=said
            ) from None


@dataclass
class _BrakeAnswers:
    """Function that solves sampled designs of a brake."""

    brake: BrakeType[Any]
    asked: SweepRequest
    inputs: Mapping[str, Input]
    units: Mapping[str, str]
    wanted: Sequence[Output]
    _called: bool = False

    def __call__(self, columns: dict[str, np.ndarray]) -> SpreadAnswers:
        """Solve the designs of the sampled inputs."""
        axes = [Axis(self.inputs[name], self.units[name], v, v) for name, v in columns.items()]
        later, self._called = self._called, True
        try:
            made, warnings = self.brake.sweep_cases(replace(self.asked, axes=axes), [*self.wanted, ERROR])
        except NoAnswer as error:
            raise ValueError(str(error)) if later else error from None
        value = np.stack(made.found[:-1], axis=-1)
        return SpreadAnswers(
            answers=tuple(output.name for output in self.wanted),
            units=tuple(output.unit for output in self.wanted),
            value=value,
            error=np.broadcast_to(made.found[-1][:, None], value.shape),
            status=np.where(np.isnan(value), "no answer", np.where(np.isinf(value), "infinite", "done")),
            warnings=tuple(warnings),
            method=self.brake.method,
            compared_with=self.brake.error_from,
        )


# A wanted result ---------------------------------------------------------------------------------------


FIND, SO_THAT = "--find", "--so-that"
_USUAL = {"m": "mm", "rad": "deg"}  # units in which values are shown if the file has none
# Without given bounds an input is sought between its value divided by this factor and times this factor.
_TIMES = 10.0
_ROUNDED = 1e-3  # largest relative error that a wanted value may have because it was typed with few digits
# Number of samples at the start of a search, for designs solved together, and for designs solved one by one.
_TOGETHER, _ONE_BY_ONE = 129, 17


def find_in_file(
    brake: BrakeType[Any], tables: Mapping[str, Any], source: str, input: str, so_that: str
) -> Solutions:
    """Find all values of an input for which a result of a brake has a wanted value.

    Parameters
    ----------
    brake : BrakeType
        Type of the brake.
    tables : mapping
        Tables of the design's file.
    source : str
        Origin of the tables, for messages.
    input : str
        The input, such as "brake.friction", which is sought from a tenth to ten times its value in the file;
        or with bounds and number of samples, in the form of a sweep: "brake.friction=0.1:0.6:51".
    so_that : str
        The result and its wanted value, such as "torque = 300 N m".

    Returns
    -------
    Solutions
        The values of the input, in the unit of the bounds or of the file.

    Raises
    ------
    ValueError
        If input or result are not known, a value has a wrong unit, or the input is 0 and has no bounds.
    """
    start, design = perf_counter(), brake.read(tables, source)
    output, target, rounding, wanted = _wanted(brake.outputs(design), so_that)
    axis = _axis(brake, design, tables, input)
    answers = _Designs(brake, SweepRequest(design, tables, (), "zip", None), axis, output)
    if axis.input.quantity.whole:
        how = "each whole number is tried"
        found = find_whole(answers, target, _whole_numbers(brake, axis), answers.reason)
    else:
        how = "samples doubled until rising and falling ranges stay the same; roots by TOMS Algorithm 748"
        found = find(answers, target, np.unique(axis.given), answers.reason, rounding=rounding)
    return replace(
        found,
        input=axis.input.path,
        unit=axis.unit,
        output=output.name,
        output_unit=output.unit,
        wanted="" if wanted == f"{found.target:.6g} {output.unit}".rstrip() else wanted,
        provenance=Provenance.since(start, brake.method, how),
    )


@dataclass(frozen=True)
class _Designs:
    """One result of a brake as a function of one input."""

    brake: BrakeType[Any]
    asked: SweepRequest
    axis: Axis
    output: Output

    def __call__(self, x: np.ndarray) -> np.ndarray:
        """Compute the result at values of the input [unit of `axis`]; nan where a design has none."""
        try:
            return self._sweep(x).found[0]
        except NoAnswer:
            return np.full(len(x), np.nan)

    def reason(self, x: float) -> str:
        """Return the reason why there is no result at a value of the input [unit of `axis`]."""
        try:
            made = self._sweep(np.array([x]))
        except NoAnswer as error:
            return str(error).partition(": ")[2] or str(error)
        said = made.reasons.get(0)
        words = self.output.words.removeprefix("... ")
        return said or (f"{words}: never" if np.isinf(made.found[0][0]) else f"there is no {words}")

    def _sweep(self, x: np.ndarray) -> Any:
        unit, convert = self.axis.unit, self.axis.input.quantity.convert
        values = np.array([convert(f"{each!r} {unit}" if unit else each) for each in x.tolist()])
        asked = replace(self.asked, axes=[replace(self.axis, given=x, values=values)])
        return self.brake.sweep_cases(asked, [self.output, ERROR])[0]


def _wanted(outputs: Sequence[Output], text: str) -> tuple[Output, float, float, str]:
    """Parse a text RESULT = VALUE.

    Return the output, its wanted value, half a unit of the value's last digit, and the value's text.
    """
    name, equals, amount = (part.strip() for part in text.partition("="))
    output, *more = chosen(outputs, name if equals else re.split(r"[^\w.]", name)[0], SO_THAT)
    form = f'give RESULT = VALUE, such as "{output.name} = {f"1 {output.unit}".rstrip()}"'
    if not equals or more:
        raise ValueError(f'{SO_THAT} = "{text}": {form}')
    try:
        target, (number, unit) = _amount(amount, output.unit), _parts(amount)
        half = Decimal(5).scaleb(min(int(number.as_tuple().exponent), 0) - 1)
        rounding = abs(_amount(f"{number + half} {unit}".rstrip(), output.unit) - target)
        shown = f"{float(number):.6g} {unit}".rstrip()
        return output, target, min(rounding, _ROUNDED * abs(target)), shown
    except ValueError as error:
        said = error.advice(str) if isinstance(error, InvalidValue) else "give a plain number"
        raise ValueError(f'{SO_THAT} = "{text}": {said}; {form}') from None


def _parts(text: str) -> tuple[Decimal, str]:
    """Split the text of a quantity into number and unit."""
    text = in_plain_characters(text)
    number = re.match(r"[-+.\deE]*[.\d]", text)
    digits = "" if number is None else number[0]
    return Decimal(digits), text[len(digits) :].strip()


def _amount(text: str, unit: str) -> float:
    """Convert the text of a quantity to a number in a unit; an angle may also be given as a slope in %."""
    if unit == "deg":
        return SlopeQuantity("rad").convert(text) / SCALES["deg"]
    if unit == "K" and not text.endswith("K"):
        raise InvalidValue("", text, "give a difference from the temperature of the surroundings, in K")
    return Quantity(unit).convert(text if unit else float(text))


def _whole_numbers(brake: BrakeType[Any], axis: Axis) -> np.ndarray:
    """Return all whole numbers between the bounds of the search."""
    low, high = np.ceil(min(axis.given)), np.floor(max(axis.given))
    if high - low >= brake.most_cases:
        bound = f"there are more than {brake.most_cases} whole numbers from {low:.6g} to {high:.6g}"
        remedy = f'search in a smaller range: "{axis.input.path}=1:10:10" is 10 numbers from 1 to 10'
        raise InvalidValue(FIND, axis.input.path, bound, remedy)
    return np.arange(low, high + 1)


def _axis(brake: BrakeType[Any], design: Any, tables: Mapping[str, Any], text: str) -> Axis:
    """Make the axis of the sought input, with the samples at which the search begins.

    The samples are those of a text with bounds, such as "brake.friction=0.1:0.6:51". For a text that only
    names the input they lie around the input's value in the file.
    """
    inputs = brake.sweep_inputs(design, tables)
    entry = find_input(inputs, text.partition("=")[0].strip(), f'{FIND} = "{text}"')
    value, _ = nominal_of(design, entry, FIND)
    if "=" in text:
        return parse_axis(inputs, text, FIND)
    if not value:
        example = f"{entry.path}=0:1:{_TOGETHER} {entry.quantity.unit}".rstrip()
        raise InvalidValue(FIND, entry.path, "the file's value is 0", f'give bounds, such as "{example}"')
    written, si = part_at(tables, entry.path), entry.quantity.unit
    has_unit = isinstance(written, str) and "%" not in written
    unit, in_unit = unit_as_written(written if has_unit else f"1 {_USUAL.get(si, si)}", si)
    count = _TOGETHER if brake.most_cases > MOST_ONE_BY_ONE else _ONE_BY_ONE
    low, high = sorted(entry.quantity.nearest_within(end) for end in (value / _TIMES, value * _TIMES))
    values = np.geomspace(low, high, count)
    return Axis(entry, unit, np.array([in_unit(each) for each in values.tolist()]), values)
