"""Designs of varied inputs that are solved one by one, where the model takes no arrays of inputs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from beamdyn.common.edge.input_sweep import InputSweep, Output, swept
from beamdyn.common.edge.inputs import Input, Section
from beamdyn.common.edge.program import NoAnswer
from beamdyn.common.edge.varied_inputs import Axis, Coordinate, designs_of
from beamdyn.common.inputs.checks import reason_of
from beamdyn.common.inputs.paths import part_at, with_parts
from beamdyn.common.parallel.tasks import Task, TaskRunner

MOST_ONE_BY_ONE = 2000  # designs, which take minutes
_CHUNK = 16  # designs of a task


@dataclass(frozen=True)
class SolvedCases:
    """Results of the designs of a task.

    Parameters
    ----------
    values : ndarray, shape (r, n)
        The r results of each of the n designs, in the units shown; nan where there is none.
    refused : tuple of int
        Designs without an answer, counted within the task.
    why : tuple of str
        Why each of these has none.
    """

    values: np.ndarray
    refused: tuple[int, ...]
    why: tuple[str, ...]


@dataclass(frozen=True)
class CaseTask:
    """Some designs of a sweep, which a worker solves one by one.

    Parameters
    ----------
    tables : mapping
        The design whose inputs are varied, as the parser of files gives it.
    axes : sequence of Axis
        The d inputs that are varied.
    given : ndarray, shape (n, d)
        Their values in each of the n designs [the axes' units].
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
    """Solve the designs of varied inputs one by one.

    Parameters
    ----------
    tables : mapping
        The design whose inputs are varied, as the parser of files gives it.
    axes : sequence of Axis
        The inputs that are varied.
    outputs : sequence of Output
        The outputs that are wanted.
    solve : callable
        Solves the designs of a task, as `solve_cases` does.
    combine : {"product", "zip"}
        Whether the inputs are combined each with each, or taken together.
    run : TaskRunner, optional
        Runs the tasks; by default in this process.

    Returns
    -------
    InputSweep

    Raises
    ------
    NoAnswer
        If no design has an answer; the message says why the first has none.
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
    """The axis without the class of its table: one that was made while a file was read does not unpickle."""
    entry = replace(axis.input, section=Section)
    if isinstance(entry, Coordinate):
        entry = replace(entry, of=replace(entry.of, section=Section))
    return replace(axis, input=entry)


def solve_cases(task: CaseTask, outputs: Sequence[Output], solve: Solve) -> SolvedCases:
    """Solve the designs of a task.

    Parameters
    ----------
    task : CaseTask
        The designs.
    outputs : sequence of Output
        The outputs that there are.
    solve : callable
        Returns the answer of a design, given as tables.
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
    """The tables of a design with other values [the axes' units] of some inputs."""
    given = {
        axis.input.path: f"{value:.15g} {axis.unit}" if axis.unit else float(value)
        for axis, value in zip(axes, values, strict=True)
    }
    points = [axis.input.of for axis in axes if isinstance(axis.input, Coordinate)]
    missing = {of.path: _default(of) for of in points if not _is_point(part_at(tables, of.path))}
    return with_parts(with_parts(tables, missing), given)


def _is_point(given: Any) -> bool:
    return isinstance(given, list) and len(given) == 2


def _default(entry: Input) -> list[str]:
    """The default of a point, as a file writes it."""
    default: Any = entry.default
    return [f"{number!r} {entry.quantity.unit}".strip() for number in map(float, default)]
