"""Studies as tables for reading and as rows of CSV files."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from rich.console import Group
from rich.text import Text

from beamdyn.common.edge.file_words import as_in_files
from beamdyn.common.edge.tables import table
from beamdyn.common.results.columns import Column, Columns, column_named, name_in_heads
from beamdyn.common.results.digits import supported
from beamdyn.studies.result import Study

_MOST_ROWS = 30  # of a table for reading
_DIGITS = 10  # most digits of a number


def study_table(result: Study, units: dict[str, tuple[str, float]] | None = None) -> Group:
    """Inputs and answers of some designs, spread evenly.

    Parameters
    ----------
    result : Study
        The study.
    units : dict, optional
        By input: the unit in which its values are shown, and that unit in SI; others are shown in SI.
    """
    shown = _spread(int(np.prod(result.shape)), _MOST_ROWS)
    columns, value, error, status = _flat(result)
    in_units = {each.name: (each.unit, 1.0) for each in result.inputs} | (units or {})
    inputs = [columns[name][shown] / in_units[name][1] for name in columns]
    heads = [f"{name} [{in_units[name][0]}]" if in_units[name][0] else name for name in columns]
    rows = (
        (*(f"{column[k]:.6g}" for column in inputs), *_answers(value[i], error[i], status[i]))
        for k, i in enumerate(shown)
    )
    own = [f"{label} [{result.unit}]" for label in result.labels]
    own = own if result.labels else [f"{result.question.kind.word} [{result.unit}]"]
    number = len(value)
    title = f"{number} design{'s' * (number > 1)}, by {result.provenance.method}"
    made = table(title, (*heads, *own, "error"), rows, (), len(heads))
    notes = [f"{len(shown)} of {number} designs are shown; --csv has all."] if len(shown) < number else []
    return Group(made, *map(Text, (*notes, _left_out(result, "number" if len(own) > 1 else ""))))


def _left_out(result: Study, what: str) -> str:
    """The line on the model error; `what` is as for `LeftOutEffects.sentence`."""
    judged = len(result.left_out_places)
    if not judged:
        return "What the model leaves out is not computed: no design has an answer."
    where = f"at the worst of {judged} design{'s' * (judged > 1)}"
    return as_in_files(result.left_out_effects.sentence(what, where))


def _answers(value: np.ndarray, error: np.ndarray, status: np.ndarray) -> Iterator[str]:
    for number, wrong, state in zip(value, error, status, strict=True):
        yield supported(number, wrong * number, _DIGITS) if np.isfinite(number) else str(state)
    known = error[np.isfinite(value)]
    yield f"{known.max():.1g}" if known.size else "-"


def study_csv(result: Study) -> Columns:
    """Inputs in SI, answers, relative errors and states, a row a design; the last input changes fastest."""
    columns, value, error, status = _flat(result)
    numbers = [_plain_name(label) for label in result.labels] or [""]
    units = {each.name: each.unit for each in result.inputs}
    inputs = (column_named(name.replace(".", "_"), each, units[name]) for name, each in columns.items())
    word = result.question.kind.word.replace(" ", "_")
    answers = (column_named(word, each, result.unit, n) for each, n in zip(value.T, numbers, strict=True))
    errors = (Column("relative_error", each, "", n) for each, n in zip(error.T, numbers, strict=True))
    states = (Column("status", each, "", n) for each, n in zip(status.T, numbers, strict=True))
    return Columns(*inputs, *answers, *errors, *states)


def _plain_name(label: str) -> str:
    """A label as a part of a head: a mode by its number, signs of combination frequencies in words."""
    label = label.replace("+", " plus ").replace("-", " minus ")
    return name_in_heads(label.removeprefix("mode "))


def _flat(result: Study) -> tuple[dict[str, np.ndarray], np.ndarray, np.ndarray, np.ndarray]:
    """Inputs (N,) by name, and answers, errors and states (N, k) of all designs."""
    number = int(np.prod(result.shape))
    value, error, status = (each.reshape(number, -1) for each in (result.value, result.error, result.status))
    return result.designs.columns(), value, error, status


def _spread(count: int, most: int) -> np.ndarray:
    return np.linspace(0, count - 1, min(count, most)).round().astype(int)
