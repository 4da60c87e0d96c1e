"""Studies as tables for reading and as rows of CSV files."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

import numpy as np
from rich.console import Group
from rich.text import Text

from beamdyn.common.digits import supported
from beamdyn.common.edge.file_words import as_in_files
from beamdyn.common.edge.tables import table
from beamdyn.studies.result import Study

_MOST_ROWS = 30  # of a table for reading
_DIGITS = 10  # most digits of a number
_PER_UNIT = {"/": "_per_", " ": "_"}


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


def study_csv(result: Study) -> Iterator[Sequence[object]]:
    """Inputs in SI, answers, relative errors and states, a row a design; the last input changes fastest."""
    columns, value, error, status = _flat(result)
    numbers = [f"_{_plain_name(label)}" for label in result.labels] or [""]
    units = {each.name: each.unit for each in result.inputs}
    heads = [_head(name.replace(".", "_"), units[name]) for name in columns]
    answer = _head(result.question.kind.word.replace(" ", "_"), result.unit)
    answers = [f"{answer}{n}" for n in numbers]
    yield *heads, *answers, *(f"relative_error{n}" for n in numbers), *(f"status{n}" for n in numbers)
    inputs = np.array([*columns.values()]).T.tolist()
    for row in zip(inputs, value.tolist(), error.tolist(), status.tolist(), strict=True):
        yield [cell for cells in row for cell in cells]


def _plain_name(label: str) -> str:
    """A label as a part of a head: a mode by its number, signs of combination frequencies in words."""
    label = label.replace("+", " plus ").replace("-", " minus ")
    return re.sub(r"[^0-9A-Za-z.]+", "_", label.removeprefix("mode ")).strip("_")


def _head(name: str, unit: str) -> str:
    for sign, word in _PER_UNIT.items():
        unit = unit.replace(sign, word)
    return f"{name}_{unit}" if unit else name


def _flat(result: Study) -> tuple[dict[str, np.ndarray], np.ndarray, np.ndarray, np.ndarray]:
    """Inputs (N,) by name, and answers, errors and states (N, k) of all designs."""
    number = int(np.prod(result.shape))
    value, error, status = (each.reshape(number, -1) for each in (result.value, result.error, result.status))
    return result.designs.columns(), value, error, status


def _spread(count: int, most: int) -> np.ndarray:
    return np.linspace(0, count - 1, min(count, most)).round().astype(int)
