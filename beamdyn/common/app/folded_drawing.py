"""Additional drawings on the page: folded, and drawn only while they are open."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from nicegui import ui

from beamdyn.common.edge.rendering import drawing, picture

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class FoldedDrawing:
    """A folded drawing of an answer.

    Parameters
    ----------
    title : str
        What it shows.
    draw : callable
        Answer in, figure out.
    """

    def __init__(self, title: str, draw: Callable[[Any], Figure]) -> None:
        self.title, self._draw = title, draw
        self._answer: Any = None
        with (
            ui.expansion(title, on_value_change=self._fill)
            .classes("w-full section")
            .props("dense") as self._fold
        ):
            self._picture: Any = ui.html("", sanitize=False).classes("w-full drawing-frame")

    def show(self, answer: object) -> None:
        """Show another answer."""
        self._answer = answer
        self._fill()

    def _fill(self) -> None:
        if self._fold.value and self._answer is not None:
            made = drawing(lambda: self._draw(self._answer))
            self._picture.set_content(picture(made, self.title))
