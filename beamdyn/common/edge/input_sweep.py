"""Any input of a file that is varied, such as "stop.speed=10:30:9 km/h", against any result."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, get_args, get_origin

import numpy as np

from beamdyn.common.checks import reason_of
from beamdyn.common.designs import Designs, VariedInput
from beamdyn.common.edge.inputs import Input, Section, parts_of
from beamdyn.common.edge.program import NoAnswer
from beamdyn.common.edge.units import InvalidInput
from beamdyn.common.one_line import counted, warned
from beamdyn.common.parallel.tasks import Task, TaskRunner
from beamdyn.common.results import Result

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_RANGE = re.compile(rf"\s*({_NUMBER})\s*:\s*({_NUMBER})\s*:\s*(\d+)\s*(?::?\s*(log)\b)?\s*([^:]*?)\s*")
_LIST = re.compile(rf"\s*({_NUMBER}(?:\s*,\s*{_NUMBER})+)\s*(.*?)\s*")
_MOST_NAMED = 4  # results in a line
MOST_AT_ONCE = 100_000  # cases at once, of arrays
MOST_ONE_BY_ONE = 2000  # cases, each solved by itself: minutes
_CHUNK = 16  # cases of a task, each solved by itself


@dataclass(frozen=True)
class Axis:
    """An input that is varied, and its values.

    Parameters
    ----------
    input : Input
        What it is.
    unit : str
        Unit in which the values were given.
    given, values : ndarray, shape (n,)
        The values, in that unit and in SI.
    """

    input: Input
    unit: str
    given: np.ndarray
    values: np.ndarray

    @property
    def label(self) -> str:
        """For tables and pictures: the key and its unit."""
        return f"{self.input.name} [{self.unit}]" if self.unit else self.input.name


@dataclass(frozen=True)
class Output:
    """A number of an answer that a sweep can show.

    Parameters
    ----------
    name : str
        Its name on the command line and in files.
    words : str
        What it is.
    of : callable
        Takes it from an answer, in SI.
    unit : str
        Unit in which it is shown.
    scale : float
        That unit in SI.
    """

    name: str
    words: str
    of: Callable[[Any], Any]
    unit: str = ""
    scale: float = 1.0

    def shown(self, result: Any) -> Any:
        """Its value or values in the unit shown."""
        return np.asarray(self.of(result)) / self.scale

    @property
    def label(self) -> str:
        """For tables and pictures: name and unit."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


@dataclass(frozen=True)
class InputSweep(Result):
    """Results over inputs.

    The shape (n1, ..., nd) has an axis for each input, in order, or one for all that are taken together.

    Attributes
    ----------
    inputs, units : tuple of str
        Keys of the inputs, and the units in which their values are given.
    values : tuple of ndarray, shape (n,)
        Their values.
    results, result_units : tuple of str
        Names of the results and their units.
    found : tuple of ndarray, shape (n1, ..., nd)
        The results as arrays; nan or inf where there is none.
    warnings : tuple of str
        Where there is no answer, and why.
    combine : {"product", "zip"}
        Whether the inputs are combined each with each, or taken together.
    refused, unanswered : tuple of (int, str)
        Designs that are refused, and those that lack a result, such as a brake that locks: by their row (the
        last input changes fastest), each with the reason.
    """

    inputs: tuple[str, ...]
    units: tuple[str, ...]
    values: tuple[np.ndarray, ...]
    results: tuple[str, ...]
    result_units: tuple[str, ...]
    found: tuple[np.ndarray, ...]
    warnings: tuple[str, ...] = ()
    combine: str = "product"
    refused: tuple[tuple[int, str], ...] = ()
    unanswered: tuple[tuple[int, str], ...] = ()

    def headline(self) -> Iterator[str]:
        """What it says in one line; see `Result.headline`."""
        shown = ", ".join(self.results[:_MOST_NAMED]) + ", ..." * (len(self.results) > _MOST_NAMED)
        yield f"{shown} of {counted(self.designs.count, 'design')} over {', '.join(self.inputs)}"
        yield warned(self.warnings)

    @property
    def designs(self) -> Designs:
        """The designs, with values as they are given."""
        each = zip(self.inputs, self.units, self.values, strict=True)
        return Designs([VariedInput(*one) for one in each], self.combine)


# Inputs and their values --------------------------------------------------------------------------------


@dataclass(frozen=True)
class Coordinate(Input):
    """One coordinate of an input that is a point.

    Parameters
    ----------
    of : Input
        The input.
    place : int
        Which of its numbers.
    """

    of: Input
    place: int


def numbers(inputs: Sequence[Input]) -> list[Input]:
    """The inputs that can be varied: numbers, and the coordinates of points."""
    return [number for entry in inputs for number in _numbers(entry)]


def _numbers(entry: Input) -> Iterator[Input]:
    parts = [*parts_of(entry.kind)]
    if get_origin(entry.kind) is tuple:
        for place, (axis, _) in enumerate(zip("xy", get_args(entry.kind), strict=True)):
            words = replace(entry.quantity, meaning=f"{axis} of the {entry.quantity.meaning}")
            path = f"{entry.path}.{axis}"
            yield Coordinate(path, entry.section, float, words, (), entry.required, None, entry, place)
    elif float in parts and not any(get_origin(part) in (list, tuple, dict) for part in parts):
        yield entry


def parse_axis(inputs: Sequence[Input], text: str, option: str = "--vary", most: int = MOST_AT_ONCE) -> Axis:
    """An input and its values.

    Parameters
    ----------
    inputs : sequence of Input
        Those that may be varied.
    text : str
        KEY=start:stop:count unit, at equal steps; start:stop:count:log unit, at equal ratios; or a list,
        KEY=1,2,5 unit.  The key is a path, or its last part where that is unique.
    option : str
        Its name, for messages.
    most : int
        Largest count.

    Raises
    ------
    ValueError
        If there is no such input, or the values do not fit it.
    """
    key, _, rest = text.partition("=")
    words = f'{option} = "{text}"'
    entry = find_input(inputs, key.strip(), words)
    if match := _RANGE.fullmatch(rest):
        return _range(entry, match, words, most)
    if match := _LIST.fullmatch(rest):
        return _list(entry, match[1].split(","), match[2], words)
    unit = f" {entry.quantity.unit}".rstrip()
    form = f'"{entry.path}=1:2:11{unit}", at equal ratios "1:2:11:log{unit}", or a list, "1,1.5,2{unit}"'
    raise ValueError(f"{words}: give KEY=start:stop:count unit, e.g. {form}")


def _range(entry: Input, match: re.Match[str], words: str, most: int) -> Axis:
    """Values at equal steps, or at equal ratios."""
    start, stop, count, unit = float(match[1]), float(match[2]), int(match[3]), match[5]
    if not 2 <= count <= most or start == stop:
        raise ValueError(f"{words}: give two different ends, and a count from 2 to {most}")
    if match[4] and not start * stop > 0:
        raise ValueError(f"{words}: equal ratios need two ends of one sign, neither of them 0")
    low, high = (_in_si(entry, number, unit, words) for number in match.group(1, 2))
    spaced = np.geomspace if match[4] else np.linspace
    return Axis(entry, unit, spaced(start, stop, count), spaced(low, high, count))


def _list(entry: Input, numbers: Sequence[str], unit: str, words: str) -> Axis:
    values = [_in_si(entry, number.strip(), unit, words) for number in numbers]
    return Axis(entry, unit, np.array([*map(float, numbers)]), np.array(values))


def _in_si(entry: Input, number: str, unit: str, words: str) -> float:
    """A value in SI, checked against the bounds of the input."""
    quantity = entry.quantity
    given = f"{number} {unit}".strip() if quantity.unit or unit else float(number)
    try:
        return quantity.within_bounds(given, quantity.convert(given))
    except InvalidInput as error:
        raise ValueError(f"{words}: {replace(error, field=entry.path)}") from None


def find_input(inputs: Sequence[Input], key: str, words: str) -> Input:
    """The input of a key; `words` are what was given, for messages."""
    matches = [i for i in inputs if key in (i.path, i.name)]
    if all(i.required or i.default is None for i in matches):
        matches = [i for i in matches if i.required] or matches  # the others follow it, as a second shoe does
    if len(matches) > 1:
        raise ValueError(f"{words}: {key} is ambiguous; give {' or '.join(i.path for i in matches)}")
    if not matches:
        raise ValueError(f"{words}: {unknown(key, [i.path for i in inputs], [i.name for i in inputs])}")
    return matches[0]


def unknown(key: str, names: Sequence[str], more: Sequence[str] = ()) -> str:
    """Sentence on an unknown name, with the nearest known name, or all."""
    near = difflib.get_close_matches(key, [*names, *more], n=1)
    advice = f"did you mean {near[0]}?" if near else f"known are {', '.join(names)}"
    return f"unknown name {key!r}; {advice}"


def chosen(outputs: Sequence[Output], names: str, option: str = "--what") -> list[Output]:
    """The outputs with these names, separated by commas.

    Raises
    ------
    ValueError
        If there is none of a name; the message says what there is.
    """
    known = {output.name: output for output in outputs}
    wanted = [name.strip() for name in names.split(",") if name.strip()]
    if not wanted:
        raise ValueError(f'{option} = "{names}": name at least one of {", ".join(known)}')
    for name in wanted:
        if name not in known:
            raise ValueError(f'{option} = "{names}": {unknown(name, [*known])}')
    return [known[name] for name in dict.fromkeys(wanted)]


# The cases ----------------------------------------------------------------------------------------------


def designs_of(axes: Sequence[Axis], combine: str = "product") -> Designs:
    """The designs of inputs, with values as they are given."""
    return Designs([VariedInput(axis.input.path, axis.unit, axis.given) for axis in axes], combine)


def swept(
    designs: Designs,
    outputs: Sequence[Output],
    found: Sequence[Any],
    warnings: Sequence[str] = (),
    refused: Mapping[int, str] | None = None,
) -> InputSweep:
    """Results over inputs.

    Parameters
    ----------
    designs : Designs
        The designs.
    outputs : sequence of Output
        What is wanted.
    found : sequence of array, shape (N,) or ()
        The values of each output in all designs, as shown.
    warnings : sequence of str
        Further limits of the answers.
    refused : mapping of int to str
        Designs that are refused, by row, and why.

    Raises
    ------
    NoAnswer
        If all are refused; the message says why the first is.
    """
    refused = dict(sorted((refused or {}).items()))
    of_all = (np.broadcast_to(values, (designs.count,)).reshape(designs.shape) for values in found)
    return InputSweep(
        inputs=tuple(each.name for each in designs.inputs),
        units=tuple(each.unit for each in designs.inputs),
        values=tuple(each.values for each in designs.inputs),
        results=tuple(output.name for output in outputs),
        result_units=tuple(output.unit for output in outputs),
        found=tuple(of_all),
        warnings=(*_warn_of_refused(designs, refused), *warnings),
        combine=designs.combine,
        refused=tuple(refused.items()),
    )


def _warn_of_refused(designs: Designs, refused: Mapping[int, str]) -> Iterator[str]:
    """Yield at how many designs there is no answer, and why at the first; raise NoAnswer if at all."""
    if not refused:
        return
    first = min(refused)
    where = designs.at(*map(int, np.unravel_index(first, designs.shape)))
    at = (f"{each.name} = {where[each.name]:.6g} {each.unit}".strip() for each in designs.inputs)
    said = f"{', '.join(at)}: {refused[first]}"
    if len(refused) == designs.count:
        raise NoAnswer(f"at none of {len(refused)} values is there an answer; {said}")
    yield f"at {len(refused)} of {designs.count} values there is no answer; {said}"


@dataclass(frozen=True)
class SolvedCases:
    """Results of some cases.

    Parameters
    ----------
    values : ndarray, shape (r, R)
        Each result of each case, as shown; nan where there is none.
    refused : tuple of int
        Cases without an answer.
    why : tuple of str
        Why there is none.
    """

    values: np.ndarray
    refused: tuple[int, ...]
    why: tuple[str, ...]


@dataclass(frozen=True)
class CaseTask:
    """Cases that are solved one by one.

    Parameters
    ----------
    tables : mapping
        The design as the parser of files gives it.
    axes : sequence of Axis
        The inputs.
    given : ndarray, shape (R, d)
        Their values in each case [the axes' units].
    outputs : tuple of str
        Names of the results that are wanted.
    """

    tables: Mapping[str, Any]
    axes: Sequence[Axis]
    given: np.ndarray
    outputs: tuple[str, ...]


Solve = Callable[[Mapping[str, Any]], Any]


def one_by_one(
    tables: Mapping[str, Any],
    axes: Sequence[Axis],
    outputs: Sequence[Output],
    solve: Callable[[CaseTask], SolvedCases],
    combine: str = "product",
    run: TaskRunner | None = None,
) -> InputSweep:
    """Solve the designs of inputs one by one, where they take no arrays.

    Parameters
    ----------
    tables : mapping
        The design as the parser of files gives it.
    axes : sequence of Axis
        The inputs.
    outputs : sequence of Output
        What is wanted.
    solve : callable
        Solves the cases of a task, as `solve_cases` does.
    combine : {"product", "zip"}
        How the inputs are combined.
    run : TaskRunner, optional
        Where they are solved; in this process if not given.

    Raises
    ------
    NoAnswer
        If there is an answer of no design; the message says why there is none of the first.
    """
    designs, run = designs_of(axes, combine), run or TaskRunner()
    results, refusals = np.full((len(outputs), designs.count), np.nan), dict[int, str]()
    names = tuple(output.name for output in outputs)
    sent = tuple(map(_without_section, axes))

    def make(rows: slice) -> CaseTask:
        return CaseTask(tables, sent, np.stack([*designs.columns(rows).values()], axis=1), names)

    def keep(rows: slice, found: SolvedCases) -> None:
        results[:, rows] = found.values
        refusals.update(zip((rows.start + i for i in found.refused), found.why, strict=True))

    tasks = [Task(partial(make, rows), rows.stop - rows.start, rows) for rows in designs.chunks(_CHUNK)]
    run.run(solve, tasks, keep)
    return swept(designs, outputs, [*results], run.warnings, refusals)


def _without_section(axis: Axis) -> Axis:
    """The axis without the class of its table, which may be made as a file is read: no worker knows it."""
    entry = replace(axis.input, section=Section)
    return replace(
        axis,
        input=replace(entry, of=replace(entry.of, section=Section))
        if isinstance(entry, Coordinate)
        else entry,
    )


def solve_cases(task: CaseTask, outputs: Sequence[Output], solve: Solve) -> SolvedCases:
    """Solve the cases of a task: tables go into `solve`, and an answer comes out."""
    wanted = {output.name: output for output in outputs}
    values, refused = np.full((len(task.outputs), len(task.given)), np.nan), dict[int, str]()
    for case, given in enumerate(task.given.tolist()):
        design = task.tables
        for axis, value in zip(task.axes, given, strict=True):
            design = placed(design, axis, value)
        try:
            answer = solve(design)
            values[:, case] = [float(wanted[name].shown(answer)) for name in task.outputs]
        except (ValueError, ArithmeticError, NoAnswer) as error:
            refused[case] = reason_of(error)
    return SolvedCases(values, tuple(refused), tuple(refused.values()))


def placed(tables: Mapping[str, Any], axis: Axis, value: float) -> dict[str, Any]:
    """The tables with the input of an axis replaced by a value [the axis' unit]."""
    entry = axis.input
    given: Any = f"{value:.15g} {axis.unit}" if axis.unit else float(value)
    if not isinstance(entry, Coordinate):
        return _put(tables, entry.path.split("."), lambda _: given)

    def moved(point: Any) -> Any:
        whole = point if isinstance(point, list) and len(point) == 2 else _default(entry.of)
        return [given if i == entry.place else part for i, part in enumerate(whole)]

    return _put(tables, entry.of.path.split("."), moved)


def _default(entry: Input) -> list[str]:
    default: Any = entry.default
    return [f"{number!r} {entry.quantity.unit}".strip() for number in map(float, default)]


def _put(tables: Mapping[str, Any], path: Sequence[str], change: Callable[[Any], Any]) -> dict[str, Any]:
    head, *rest = path
    inner = tables.get(head)
    nested = _put(inner if isinstance(inner, Mapping) else {}, rest, change) if rest else change(inner)
    return dict(tables) | {head: nested}


# Its rows -----------------------------------------------------------------------------------------------


def sweep_csv(swept: InputSweep) -> Iterator[Sequence[object]]:
    """Rows of a sweep's CSV file, with its heads."""
    heads = [f"{n}_{u.replace(' ', '_').replace('/', '_per_')}" if u else n for n, u in columns(swept)]
    why = dict(swept.refused)
    yield heads + ["no_answer"] * bool(why)
    for row, cells in enumerate(sweep_rows(swept)):
        yield cells + [why.get(row, "")] * bool(why)


def sweep_rows(swept: InputSweep) -> Iterator[list[float]]:
    """Inputs and results, one row a case; the last input changes fastest."""
    cells = [*swept.designs.columns().values(), *(np.ravel(values) for values in swept.found)]
    for row in zip(*(column.tolist() for column in cells), strict=True):
        yield [*row]


def columns(swept: InputSweep) -> list[tuple[str, str]]:
    """Names and units of the columns: inputs, then results."""
    inputs = ((path.partition(".")[2] or path).replace(".", "_") for path in swept.inputs)
    return [*zip(inputs, swept.units, strict=True), *zip(swept.results, swept.result_units, strict=True)]
