"""Results over inputs of a file that are varied: as an object, and as the rows of a CSV file."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from beamdyn.common.edge.program import NoAnswer
from beamdyn.common.edge.varied_inputs import unknown
from beamdyn.common.inputs.designs import Designs, VariedInput
from beamdyn.common.results.columns import Column, Columns, column_named
from beamdyn.common.results.one_line import counted, warned
from beamdyn.common.results.result import Result

_MOST_NAMED = 4  # results in a line


@dataclass(frozen=True)
class Output:
    """A number of an answer that a sweep can show.

    Parameters
    ----------
    name : str
        Its name on the command line and in files.
    words : str
        Description, for people.
    of : callable
        Returns the number, in SI, when given an answer.
    unit : str
        Unit in which it is shown.
    scale : float
        Size of that unit in SI.
    """

    name: str
    words: str
    of: Callable[[Any], Any]
    unit: str = ""
    scale: float = 1.0

    def shown(self, result: Any) -> Any:
        """Value or values in an answer, in the unit shown."""
        return np.asarray(self.of(result)) / self.scale

    @property
    def label(self) -> str:
        """Name and unit, for tables and pictures."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


@dataclass(frozen=True)
class InputSweep(Result):
    """Results over inputs.

    Arrays have shape (n1, ..., nd), with an axis for each of the d inputs, or (n,) where the inputs are taken
    together.

    Attributes
    ----------
    inputs, units : tuple of str
        Keys of the inputs, and the units in which their values are given.
    values : tuple of ndarray, shape (n,)
        Values of each input, in its unit.
    results, result_units : tuple of str
        Names of the results and their units.
    found : tuple of ndarray, shape (n1, ..., nd)
        Values of each result, in its unit; nan or inf where there is none.
    warnings : tuple of str
        Where there is no answer, and why.
    combine : {"product", "zip"}
        Whether the inputs are combined each with each, or taken together.
    refused, unanswered : tuple of (int, str)
        Designs that are refused, and those that lack a result, such as a brake that locks: row of each (the
        last input changes fastest) and the reason.
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
        """The results, the number of designs and the varied inputs in one line; see `Result.headline`."""
        shown = ", ".join(self.results[:_MOST_NAMED]) + ", ..." * (len(self.results) > _MOST_NAMED)
        yield f"{shown} of {counted(self.designs.count, 'design')} over {', '.join(self.inputs)}"
        yield warned(self.warnings)

    @property
    def designs(self) -> Designs:
        """The designs, with values in the units given."""
        each = zip(self.inputs, self.units, self.values, strict=True)
        return Designs([VariedInput(*one) for one in each], self.combine)


def chosen(outputs: Sequence[Output], names: str, option: str = "--what") -> list[Output]:
    """The outputs with the names in a text, separated by commas, each once.

    Parameters
    ----------
    outputs : sequence of Output
        Those that there are.
    names : str
        The names.
    option : str
        Name of the option that gives them, for messages.

    Raises
    ------
    ValueError
        If a name is unknown, or none is given; the message lists the names or says which is meant.
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
    """Make the result of a sweep.

    Parameters
    ----------
    designs : Designs
        The designs.
    outputs : sequence of Output
        The outputs that are wanted.
    found : sequence of ndarray, shape (N,) or ()
        Values of each output in all N designs, in the unit shown.
    warnings : sequence of str
        Warnings besides that of refused designs.
    refused : mapping of int to str, optional
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
    """Yield a sentence on the refused designs, with the reason of the first; raise NoAnswer if all are."""
    if not refused:
        return
    first = min(refused)
    where = designs.at(*map(int, np.unravel_index(first, designs.shape)))
    at = (f"{each.name} = {where[each.name]:.6g} {each.unit}".strip() for each in designs.inputs)
    said = f"{', '.join(at)}: {refused[first]}"
    if len(refused) == designs.count:
        raise NoAnswer(f"at none of {len(refused)} values is there an answer; {said}")
    yield f"at {len(refused)} of {designs.count} values there is no answer; {said}"


# Rows of files and tables --------------------------------------------------------------------------------


def sweep_csv(swept: InputSweep) -> Columns:
    """Inputs and results of each design, a row each, and why some have none."""
    rows, why = [*sweep_rows(swept)], dict(swept.refused)
    cells = [*zip(*rows, strict=True)]
    named = zip(columns(swept), cells, strict=True)
    each = [column_named(name, values, unit) for (name, unit), values in named]
    reasons = [Column("no_answer", [why.get(row, "") for row in range(len(rows))])] if why else []
    return Columns(*each, *reasons)


def sweep_rows(swept: InputSweep) -> Iterator[list[float]]:
    """Yield inputs and results of each design as a row; the last input changes fastest."""
    cells = [*swept.designs.columns().values(), *(np.ravel(values) for values in swept.found)]
    for row in zip(*(column.tolist() for column in cells), strict=True):
        yield [*row]


def columns(swept: InputSweep) -> list[tuple[str, str]]:
    """Names and units of the columns: inputs, then results."""
    inputs = ((path.partition(".")[2] or path).replace(".", "_") for path in swept.inputs)
    return [*zip(inputs, swept.units, strict=True), *zip(swept.results, swept.result_units, strict=True)]
