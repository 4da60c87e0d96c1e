"""Tables and rows of named numbers, from the results of a design or of a sweep."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from itertools import groupby
from math import inf, pi
from operator import attrgetter
from typing import Any

import numpy as np
from rich.console import Group
from rich.text import Text

from beamdyn.common.edge.console import set_apart, table
from beamdyn.common.edge.input_sweep import InputSweep, Output, columns, sweep_rows
from beamdyn.common.edge.inputs import Input
from beamdyn.common.results.columns import evenly_spread, meanings
from beamdyn.common.screens.form_entries import NOT_GIVEN, default_words

_SHOWN = 24  # largest number of rows of a sweep that are shown
_ROUNDING = 1e-12  # relative difference of two results below which they count as equal
# Size of each displayed unit in SI units.
SCALES = {
    "mm": 1e-3,
    "deg": pi / 180,
    "kN": 1e3,
    "MPa": 1e6,
    "MW/m2": 1e6,
}


def take(name: str, words: str, unit: str = "") -> Output:
    """Make an output from the attribute `name` of a result, described by `words` and shown in `unit`."""
    return Output(name, words, attrgetter(name), unit, SCALES.get(unit, 1.0))


def take_fields(kind: type, names: str) -> tuple[Output, ...]:
    """Make outputs of some fields of a result class, with the words and units of each field's `Meaning`.

    `names` has the names of the fields, separated by spaces.
    """
    each = ((name, meanings(kind)[name]) for name in names.split())
    return tuple(take(name, stated.words, stated.shown or stated.unit) for name, stated in each)


def resultant(vector: np.ndarray) -> np.ndarray:
    """Compute the magnitude of vectors of shape (..., 2)."""
    return np.hypot(vector[..., 0], vector[..., 1])


def take_from(part: Callable[[Any], Any], outputs: Iterable[Output]) -> tuple[Output, ...]:
    """Turn outputs of a part of an object into outputs of the object; `part(object)` returns the part."""
    return tuple(
        Output(o.name, o.words, lambda answer, o=o: o.of(part(answer)), o.unit, o.scale) for o in outputs
    )


def take_from_each(
    parts: Callable[[Any], Sequence[Any]], count: int, kind: str, outputs: Iterable[Output]
) -> tuple[Output, ...]:
    """Turn outputs of a part, such as a shoe, into outputs of each of the `count` parts of an object.

    ``parts(object)`` returns the parts; `kind` is the word for a part.
    """
    return tuple(
        Output(f"{o.name}_{i + 1}", f"{o.words}, {kind} {i + 1}", o.of, o.unit, o.scale)
        for i in range(count)
        for o in take_from(lambda answer, i=i: parts(answer)[i], outputs)
    )


def list_outputs(
    outputs: Iterable[Output], results: Sequence[Any], doubtful: Sequence[Sequence[Any]] = ()
) -> list[list[str | Text]]:
    """Make rows of a table: words of each output, its value in each result, and its unit.

    Digits in which a result differs from its `doubtful` variants, such as those with other friction, are
    dimmed.
    """
    doubted = doubtful or [()] * len(results)
    each = [*zip(results, doubted, strict=True)]
    return [[o.words, *(_doubted(o, *one) for one in each), o.unit] for o in outputs]


def _doubted(output: Output, result: Any, doubtful: Sequence[Any]) -> str | Text:
    """Format an output; dim the digits in which it differs in `doubtful` results; nan counts as equal."""
    value = float(output.shown(result))
    changes = [abs(float(output.shown(other)) - value) for other in doubtful]
    change = float(np.fmax.reduce([0.0, *changes]))
    text = format_number(value)
    return set_apart(text, change) if change > _ROUNDING * abs(value) else text


def outputs_table(title: str, outputs: Iterable[Output], result: Any, doubtful: Sequence[Any] = ()) -> Group:
    """Make a table of a result's outputs."""
    return table(title, ("", "value", "unit"), list_outputs(outputs, [result], [doubtful]), (0, 2))


def outputs_csv(outputs: Iterable[Output], **results: Any) -> Iterator[Sequence[object]]:
    """Yield rows of a CSV file: name of each output, its value in each result, and its unit."""
    yield "result", *results, "unit"
    for output in outputs:
        yield output.name, *(float(output.shown(result)) for result in results.values()), output.unit


def keys_tables(inputs: Iterable[Input], optional: Collection[str]) -> Iterator[Group]:
    """Make tables of a file's keys: meaning with unit, bounds and choices, and default.

    `optional` names the tables that may be left out.
    """
    for place, entries in groupby(inputs, key=lambda entry: entry.path.rpartition(".")[0]):
        rows = ((each.name, ": ".join([each.help, *_choices(each)]), _default(each)) for each in entries)
        title = f"[{place}]{', which may be left out' * (place in optional)}" if place else "At the top"
        yield table(title, ("key", "what", "if not given"), rows, (0, 1, 2))


def _choices(entry: Input) -> list[str]:
    return [", ".join(map(str, entry.choices))] if entry.choices else []


def _default(entry: Input) -> str:
    """State the default of a key in the form that a file has."""
    words = "required" if entry.required else default_words(entry)
    return "" if words == NOT_GIVEN else words


def sweep_table(sweep: InputSweep) -> Group:
    """Make the table of a sweep, with a selection of its rows if there are many."""
    rows = [*sweep_rows(sweep)]
    shown = evenly_spread(len(rows), _SHOWN)
    part = "" if len(shown) == len(rows) else f" ({len(shown)} of {len(rows)} rows; CSV and JSON have all)"
    heads = [f"{n} [{u}]" if u else n for n, u in columns(sweep)]
    cells = [[format_number(value) for value in rows[i]] for i in shown]
    title = f"{', '.join(sweep.results)} over {' and '.join(sweep.inputs)}{part}"
    why = sweep.reasons
    if not why:
        return table(title, heads, cells, (), len(sweep.inputs))
    said = ([*row, why.get(int(i), "")] for i, row in zip(shown, cells, strict=True))
    return table(title, [*heads, "no answer, because"], said, (len(heads),), len(sweep.inputs))


def format_number(value: Any) -> str:
    """Format a number with five significant digits and at most four decimals."""
    value = float(value)
    if value != value:
        return "-"
    if value == 0:
        return "0"
    if abs(value) == inf:
        return "never" if value > 0 else str(value)
    if not 1e-3 <= abs(value) < 1e7:
        return f"{value:.2g}" if abs(value) < 1e-3 else f"{value:.4g}"
    whole = len(str(int(abs(value)))) if abs(value) >= 1 else 0
    return f"{value:.{max(0, 5 - max(whole, 1))}f}"
