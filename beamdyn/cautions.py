"""What must stand beside the numbers of a result: how its physics was chosen, and a large model error."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from beamdyn.common.announced import OUTSIDE
from beamdyn.common.edge.file_words import as_in_files
from beamdyn.common.results import Result
from beamdyn.model_error.left_out_effects import LARGE_MODEL_ERROR, MODEL_ERROR, StatesModelError, say_size

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from beamdyn.spectrum.critical import CriticalPoint
    from beamdyn.spectrum.modes import Modes


def warnings_of(result: Any, tolerance: float | None = None) -> list[str]:
    """Warnings of a result and of its model error past a tolerance, or 1 %, in words and units of files."""
    warnings = (*getattr(result, "warnings", ()), *_of_model_error(result, tolerance))
    return [as_in_files(_in_units_of(result, said)) for said in warnings]


def _in_units_of(result: Any, sentence: str) -> str:
    """A sentence with its speeds in the unit in which the result shows them."""
    return result.display_units.in_sentence(sentence) if isinstance(result, Result) else sentence


def _of_model_error(result: Any, tolerance: float | None = None) -> Iterator[str]:
    if isinstance(result, StatesModelError):
        yield from result.model_warnings(tolerance)


def describe_choice(result: Result) -> list[str]:
    """The line on the physics of a result, where that was chosen."""
    choice = getattr(result, "physics_choice", None)
    return [] if choice is None else [choice.sentence()]


def notes_of(result: Any) -> list[str]:
    """What a picture or a file of numbers alone must say: large deflection included, or what is left out."""
    scene = getattr(result, "scene", None)
    if scene is not None and scene.physics.large_deflection:
        return ["with large deflection"]
    outside = [s for s in getattr(result, "warnings", ()) if OUTSIDE in s or MODEL_ERROR in s]
    each = [said.partition(";")[0] for said in (*outside, *_of_model_error(result))]
    return [_in_units_of(result, said) for said in each]


def critical_label(point: CriticalPoint) -> str:
    """What a picture calls a critical speed."""
    straight = any(OUTSIDE in said for said in point.warnings)
    return "critical speed, were the beam straight:" if straight else "critical speed"


def labels_of(modes: Modes) -> list[str]:
    """Labels of modes, with the model error where that is large."""
    large = modes.model_error > LARGE_MODEL_ERROR
    each = zip(modes.labels(), modes.model_error.tolist(), large.tolist(), strict=True)
    return [f"{label}, model error {say_size(error)}" if it else label for label, error, it in each]


def noted(draw: Callable[[], Figure], result: Any) -> Callable[[], Figure]:
    """A function that draws a figure, with the notes of a result below it."""

    def made() -> Figure:
        from beamdyn.output.notes import note_below

        return note_below(draw(), notes_of(result))

    return made
