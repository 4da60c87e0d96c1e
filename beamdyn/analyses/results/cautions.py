"""Warnings and notes on a result: how its physical effects were chosen, and large model errors."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import beamdyn as bd
from beamdyn.common.edge.file_words import in_files
from beamdyn.common.edge.file_words import word as in_terms
from beamdyn.common.plots.axes_and_lines import note_below
from beamdyn.common.results.columns import SI_UNITS
from beamdyn.common.results.pictures import Figure
from beamdyn.common.results.result import Result
from beamdyn.common.results.statements import MODEL_ERROR, OUTSIDE, kind_of, of_kind, said_in
from beamdyn.common.words import Part, worded
from beamdyn.modes.model_error.left_out_effects import LARGE_MODEL_ERROR, StatesModelError, say_size


def warnings_of(result: Any, tolerance: float | None = None, without: str = "") -> list[str]:
    """Return a result's warnings, with inputs named as in files.

    If the model error exceeds the tolerance, or 1 % without one, a warning says so.  Warnings of the kind
    `without` are omitted.
    """
    warnings = (*getattr(result, "warnings", ()), *_of_model_error(result, tolerance))
    said = (each for each in warnings if not without or kind_of(each) != without)
    return [worded(each, _words_of(result)) for each in said]


def _words_of(result: Any) -> Callable[[Part], str]:
    """Return a function that words a part of a text with the result's units, and input names as in files."""
    units = result.display_units if isinstance(result, Result) else SI_UNITS
    own: Callable[[Part], str | None] = getattr(result, "in_own_words", lambda part: None)
    return lambda part: in_files(own(part) or in_terms(part, units))


def _of_model_error(result: Any, tolerance: float | None = None) -> Iterator[str]:
    if isinstance(result, StatesModelError):
        yield from result.model_warnings(tolerance)


def describe_choice(result: Result) -> list[str]:
    """Return the sentence on how physical effects were chosen automatically; empty if they were given."""
    choice = getattr(result, "physics_choice", None)
    return [] if choice is None else [choice.sentence()]


def describe_left_out(result: Result) -> list[str]:
    """Return the sentence on neglected effects, for results whose tables do not list these effects.

    The list has this one sentence; it is empty if no model error is stated for the result.
    """
    if not isinstance(result, StatesModelError) or not result.judged_value:
        return []
    said = result.left_out_effects.sentence(result.counted, f"of {result.judged_value}")
    return [said_in(result.display_units, said)]


def notes_of(result: Any) -> list[str]:
    """Return the notes on a result in pictures and CSV files.

    The note is "with large deflection" if the scene models it; else the notes state that the result is
    outside linear theory, or that its model error is large.  A drawing of the undeformed rotor has no notes.
    """
    if isinstance(result, bd.RotorDrawing):
        return []
    scene = getattr(result, "scene", None)
    if scene is not None and scene.physics.large_deflection:
        return ["with large deflection"]
    outside = of_kind(getattr(result, "warnings", ()), OUTSIDE, MODEL_ERROR)
    said = (*outside, *_of_model_error(result))
    return [_first_clause(worded(each, _words_of(result))) for each in said]


def _first_clause(sentence: str) -> str:
    """Return a sentence up to its first semicolon that is not in brackets."""
    clause, *more = sentence.split(";")
    while clause.count("(") > clause.count(")"):
        clause += ";" + more.pop(0)
    return clause


def critical_label(point: bd.CriticalPoint) -> str:
    """Return the label of a critical speed in a picture; it tells if the speed is that of a straight beam."""
    return "critical speed, were the beam straight:" if of_kind(point.warnings, OUTSIDE) else "critical speed"


def labels_of(modes: bd.Modes) -> list[str]:
    """Return the labels of modes, with the model error if it exceeds 1 %."""
    large = modes.model_error > LARGE_MODEL_ERROR
    each = zip(modes.labels(), modes.model_error.tolist(), large.tolist(), strict=True)
    return [f"{label}, model error {say_size(error)}" if it else label for label, error, it in each]


def noted(draw: Callable[[], Figure], result: Any) -> Callable[[], Figure]:
    """Wrap a function that draws a figure, so that notes on the result are written below the figure."""

    def made() -> Figure:
        return note_below(draw(), notes_of(result))

    return made
