"""Ranges of a brake's results over tolerances of its inputs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from beamdyn.common.edge.command_options import SPREAD
from beamdyn.common.edge.exit_codes import NoAnswer
from beamdyn.common.edge.input_sweep import Output, chosen
from beamdyn.common.edge.inputs import Input
from beamdyn.common.edge.units import InvalidInput
from beamdyn.common.edge.varied_inputs import Axis, parse_spreads
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.inputs.described import part_at
from beamdyn.common.parallel.tasks import TaskRunner
from beamdyn.common.spreading import DEFAULT_SAMPLES
from beamdyn.common.spreading.solve import SpreadAnswers, solve_spread
from beamdyn.common.spreading.spread_result import Spread
from beamdyn.common.spreading.statistics import check_samples, check_seed, count_designs
from beamdyn.common.spreading.tolerances import SpreadInput
from brakes.answers.base import ERROR, BrakeType, SweepRequest
from brakes.config.caliper import Angle


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
