"""Parameter sweeps: results over varied inputs of a file; the designs can be solved one by one."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from beamdyn.common.edge.exit_codes import NoAnswer
from beamdyn.common.edge.inputs import Section
from beamdyn.common.edge.varied_inputs import Axis, Coordinate, designs_of, unknown
from beamdyn.common.inputs.checks import reason_of
from beamdyn.common.inputs.described import Designs, VariedInput, part_at, with_parts
from beamdyn.common.parallel.tasks import Task, TaskRunner
from beamdyn.common.results.columns import Column, Columns, column_named
from beamdyn.common.results.one_line import counted, warned
from beamdyn.common.results.result import Result
from beamdyn.common.words import at_any

MOST_ONE_BY_ONE = 2000  # largest number of designs that are solved one by one, which takes some minutes
_CHUNK = 16  # number of designs that a worker process receives at a time
_MOST_NAMED = 4  # largest number of results that are named in one line of text


@dataclass(frozen=True)
class Output:
    """A scalar result that a sweep can show.

    Parameters
    ----------
    name : str
        Name of the result on the command line and in files.
    words : str
        Description of the result in words.
    of : callable
        Function that takes the solution of a design, and returns the number in SI units.
    unit : str
        Unit in which the number is shown.
    scale : float
        Size of that unit in SI units.
    """

    name: str
    words: str
    of: Callable[[Any], Any]
    unit: str = ""
    scale: float = 1.0

    def shown(self, result: Any) -> Any:
        """Return the number (or an array of numbers) from a solution, in the unit in which it is shown."""
        return np.asarray(self.of(result)) / self.scale


@dataclass(frozen=True)
class InputSweep(Result):
    """Results of a parameter sweep.

    Arrays have shape (n1, ..., nd), with one axis for each of the d inputs; or shape (n,) if the first design
    takes the first value of each input, the second design the second values, and so on.

    Attributes
    ----------
    inputs, units : tuple of str
        Keys of the inputs, and the units in which their values are given.
    values : tuple of ndarray, shape (n,)
        Values of each input, in the input's unit.
    results, result_units : tuple of str
        Names of the results and their units.
    found : tuple of ndarray, shape (n1, ..., nd)
        Values of each result, in the result's unit; nan or inf where there is none.
    warnings : tuple of str
        Designs without a result, and the reason.
    combine : {"product", "zip"}
        Whether every value is combined with every value of the other inputs, or the n-th values of all inputs
        make a design.
    refused, unanswered : tuple of (int, str)
        Designs with invalid inputs, and designs without a result, such as a brake that locks: the row number
        of each (the last input changes fastest) and the reason.
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
        """Yield results, number of designs and inputs for the one-line summary of the result.

        See `Result.headline`.
        """
        shown = ", ".join(self.results[:_MOST_NAMED]) + ", ..." * (len(self.results) > _MOST_NAMED)
        yield f"{shown} of {counted(self.designs.count, 'design')} over {', '.join(self.inputs)}"
        yield warned(self.warnings)

    @property
    def reasons(self) -> dict[int, str]:
        """Return why designs have no result, by their row numbers."""
        return dict((*self.refused, *self.unanswered))

    @property
    def designs(self) -> Designs:
        """Return the designs, with input values in the units in which the user gave them."""
        each = zip(self.inputs, self.units, self.values, strict=True)
        return Designs([VariedInput(*one) for one in each], self.combine)


def chosen(outputs: Sequence[Output], names: str, option: str = "--what") -> list[Output]:
    """Return the outputs whose names are listed in a text, separated by commas, each once.

    Parameters
    ----------
    outputs : sequence of Output
        All outputs that can be chosen.
    names : str
        The names.
    option : str
        Name of the option that gives them, for messages.

    Raises
    ------
    ValueError
        If a name is unknown, or none is given; the message suggests a similar name, else lists all.
    """
    known = {output.name: output for output in outputs}
    wanted = [name.strip() for name in names.split(",") if name.strip()]
    if not wanted:
        raise ValueError(f'{option} = "{names}": name at least one of {", ".join(known)}')
    for name in wanted:
        if name not in known:
            raise ValueError(f'{option} = "{names}": {unknown(name, [*known])}')
    return [known[name] for name in dict.fromkeys(wanted)]


def swept(
    designs: Designs,
    outputs: Sequence[Output],
    found: Sequence[Any],
    warnings: Sequence[str] = (),
    refused: Mapping[int, str] | None = None,
) -> InputSweep:
    """Make the result of a parameter sweep.

    Parameters
    ----------
    designs : Designs
        The designs.
    outputs : sequence of Output
        The requested outputs.
    found : sequence of ndarray, shape (N,) or ()
        Values of each output in all N designs, in the output's unit.
    warnings : sequence of str
        Warnings other than the one on designs with invalid inputs.
    refused : mapping of int to str, optional
        The reason for each design with invalid inputs, by row number.

    Raises
    ------
    NoAnswer
        If all designs have invalid inputs; the message gives the reason for the first one.
    """
    refused, said = dict(sorted((refused or {}).items())), []
    if refused:
        first, count = min(refused), len(refused)
        where = designs.at(*map(int, np.unravel_index(first, designs.shape)))
        at = (f"{each.name} = {where[each.name]:.6g} {each.unit}".strip() for each in designs.inputs)
        reason = f"{', '.join(at)}: {refused[first]}"
        if count == designs.count:
            raise NoAnswer(f"there is no answer {at_any(count, 'value')}; {reason}")
        said = [f"at {count} of {designs.count} values there is no answer; {reason}"]
    of_all = (np.broadcast_to(values, (designs.count,)).reshape(designs.shape) for values in found)
    return InputSweep(
        inputs=tuple(each.name for each in designs.inputs),
        units=tuple(each.unit for each in designs.inputs),
        values=tuple(each.values for each in designs.inputs),
        results=tuple(output.name for output in outputs),
        result_units=tuple(output.unit for output in outputs),
        found=tuple(of_all),
        warnings=(*said, *warnings),
        combine=designs.combine,
        refused=tuple(refused.items()),
    )


# Rows of output files and tables -------------------------------------------------------------------------


def sweep_csv(swept: InputSweep) -> Columns:
    """Make columns with one row per design: inputs, results, and the reason if a result is missing."""
    rows, why = [*sweep_rows(swept)], swept.reasons
    named = zip(columns(swept), zip(*rows, strict=True), strict=True)
    each = [column_named(name, values, unit) for (name, unit), values in named]
    reasons = [Column("no_answer", [why.get(row, "") for row in range(len(rows))])] if why else []
    return Columns(*each, *reasons)


def sweep_rows(swept: InputSweep) -> Iterator[list[float]]:
    """Yield inputs and results of each design as a row; the last input changes fastest."""
    cells = [*swept.designs.columns().values(), *(np.ravel(values) for values in swept.found)]
    for row in zip(*(column.tolist() for column in cells), strict=True):
        yield [*row]


def columns(swept: InputSweep) -> list[tuple[str, str]]:
    """Return names and units of the columns: inputs first, then results."""
    inputs = ((path.partition(".")[2] or path).replace(".", "_") for path in swept.inputs)
    return [*zip(inputs, swept.units, strict=True), *zip(swept.results, swept.result_units, strict=True)]


# Designs that are solved one by one, as the model cannot solve arrays of inputs at once --------------


@dataclass(frozen=True)
class SolvedCases:
    """Results of the designs of one task.

    Parameters
    ----------
    values : ndarray, shape (r, n)
        The r results of each of the n designs, in the units of the outputs; nan where there is none.
    refused : tuple of int
        Indices, within the task, of the designs without a solution.
    why : tuple of str
        The reason why each of these designs has no solution.
    """

    values: np.ndarray
    refused: tuple[int, ...]
    why: tuple[str, ...]


@dataclass(frozen=True)
class CaseTask:
    """Some of the designs of a sweep, which a worker process solves one by one.

    Parameters
    ----------
    tables : mapping
        The input file as nested tables, of which some inputs are varied.
    axes : sequence of Axis
        The d inputs that are varied.
    given : ndarray, shape (n, d)
        Values of these inputs in each of the n designs [units of the axes].
    outputs : tuple of str
        Names of the requested results.
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
    """Solve the designs of varied inputs, one after the other.

    Parameters
    ----------
    tables : mapping
        The input file as nested tables, of which some inputs are varied.
    axes : sequence of Axis
        The inputs that are varied.
    outputs : sequence of Output
        The requested outputs.
    solve : callable
        Solves the designs of a task, as `solve_cases` does.
    combine : {"product", "zip"}
        Whether every value is combined with every value of the other inputs, or the n-th values of all inputs
        make a design.
    run : TaskRunner, optional
        Runs the tasks; by default in this process.

    Returns
    -------
    InputSweep

    Raises
    ------
    NoAnswer
        If no design has a solution; the message gives the reason for the first design.
    """
    designs, run = designs_of(axes, combine), run or TaskRunner()
    results, refusals = np.full((len(outputs), designs.count), np.nan), dict[int, str]()
    names = tuple(output.name for output in outputs)
    # Inputs are sent to processes without the class of their table, which may be made while a file is read:
    # such a class cannot be pickled.
    sent = []
    for axis in axes:
        entry = replace(axis.input, section=Section)
        if isinstance(entry, Coordinate):
            entry = replace(entry, of=replace(entry.of, section=Section))
        sent.append(replace(axis, input=entry))

    def make(rows: slice) -> CaseTask:
        return CaseTask(tables, sent, np.stack([*designs.columns(rows).values()], axis=1), names)

    def keep(rows: slice, found: SolvedCases) -> None:
        results[:, rows] = found.values
        refusals.update(zip((rows.start + i for i in found.refused), found.why, strict=True))

    tasks = [Task(partial(make, rows), rows.stop - rows.start, rows) for rows in designs.chunks(_CHUNK)]
    run.run(solve, tasks, keep)
    return swept(designs, outputs, [*results], run.warnings, refusals)


def solve_cases(task: CaseTask, outputs: Sequence[Output], solve: Solve) -> SolvedCases:
    """Solve the designs of a task.

    Parameters
    ----------
    task : CaseTask
        The designs.
    outputs : sequence of Output
        All outputs that the model offers.
    solve : callable
        Function that takes a design as nested tables, and returns its solution.
    """
    wanted = {output.name: output for output in outputs}
    values, refused = np.full((len(task.outputs), len(task.given)), np.nan), dict[int, str]()
    for case, given in enumerate(task.given.tolist()):
        design = placed(task.tables, task.axes, given)
        try:
            answer = solve(design)
            values[:, case] = [float(wanted[name].shown(answer)) for name in task.outputs]
        except (ValueError, ArithmeticError, NoAnswer) as error:
            refused[case] = reason_of(error)
    return SolvedCases(values, tuple(refused), tuple(refused.values()))


def placed(tables: Mapping[str, Any], axes: Sequence[Axis], values: Sequence[float]) -> dict[str, Any]:
    """Return the tables of a design with new values [units of the axes] of the varied inputs."""
    given = {
        axis.input.path: f"{value:.15g} {axis.unit}" if axis.unit else float(value)
        for axis, value in zip(axes, values, strict=True)
    }
    # Default points for inputs of which only one coordinate is varied, and which the file does not give.
    missing: dict[str, Any] = {}
    for axis in axes:
        if isinstance(axis.input, Coordinate):
            of, there = axis.input.of, part_at(tables, axis.input.of.path)
            if not isinstance(there, list) or len(there) != 2:
                default: Any = of.default
                missing[of.path] = [
                    f"{number!r} {of.quantity.unit}".strip() for number in map(float, default)
                ]
    return with_parts(with_parts(tables, missing), given)
