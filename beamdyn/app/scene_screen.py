"""Screens of a scene: what they share, and those that follow from the description of an analysis."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from matplotlib.figure import Figure
from rich.console import RenderableType

from beamdyn.app.inputs import DRAGS, EFFORT, SCENE_TABLES
from beamdyn.app.left_out import left_out_table
from beamdyn.app.sketches import sketch
from beamdyn.common.edge.views import rows_of, tables_of
from beamdyn.common.plots.axes_and_lines import note_below
from beamdyn.common.results.result import Result
from beamdyn.common.screens.screens import Screen
from beamdyn.modes.model_error.left_out_effects import StatesModelError
from beamdyn.results.cautions import describe_choice, notes_of, warnings_of


def scene_screen(
    name: str,
    purpose: str,
    solve: Callable[[Mapping[str, Any]], Any],
    beside: Sequence[str] = ("options",),
    result: Callable[[Any], Result] = lambda answer: answer,
    left_out_of: str = "",
    **special: Any,
) -> Screen:
    """Make a screen on a scene, which shows the result of an answer by its views.

    Parameters
    ----------
    name, purpose, solve
        As for `Screen`.
    beside : sequence of str
        Tables of its form before those of the scene.
    result : callable
        ``result(answer)``: the result, where the answer is more than that.
    left_out_of : str
        What the effects left out change, such as "frequencies"; empty if the screen does not list them.
    **special
        Further arguments of `Screen`.
    """
    tables = (*beside, *SCENE_TABLES)

    def shown(answer: Any) -> Sequence[RenderableType]:
        return [*tables_with_choice(result(answer)), *left_out(result(answer), left_out_of)]

    usual: dict[str, Any] = {
        "tables": shown,
        "draw": lambda answer, _=0.0: drawn(result(answer)),
        "notes": lambda answer: warnings_of(result(answer)),
        "rows": lambda answer: rows_of(result(answer)),
        "drags": DRAGS,
        "effort": EFFORT,
        "sketch": sketch,
    }
    return Screen(name, purpose, tables, tables, solve, **usual | special)


def tables_with_choice(result: Result) -> list[RenderableType]:
    """Tables of a result, and how its physics was chosen."""
    return [tables_of(result), *describe_choice(result)]


def left_out(result: Result, what: str) -> list[RenderableType]:
    """The table of effects left out, and how they change something, such as "frequencies"."""
    if not what or not isinstance(result, StatesModelError):
        return []
    return [left_out_table(result.left_out_effects, what)]


def drawn(result: Result) -> Figure:
    """The picture of a result, with its notes below."""
    figure = Figure(figsize=(9.0, 5.4), layout="constrained")
    result.plot(figure.subplots())  # pyright: ignore[reportAttributeAccessIssue]  (results with a picture)
    return note_below(figure, notes_of(result))
