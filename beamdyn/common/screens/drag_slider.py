"""A slider that the page moves itself: while it is dragged it does not wait for the program."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nicegui import ui

from beamdyn.common.screens.page_writer import PageWriter

_OFTEN = 0.03  # least time between two messages of a slider that is dragged [s]


class DragSlider(ui.slider, component="drag_slider.js"):
    """A slider that reports while it is dragged.

    Parameters
    ----------
    dragged : callable
        Called with its position, and whether it has been let go, as after a step by a key or a click.
    **options
        Options of `ui.slider`.
    """

    def __init__(self, dragged: Callable[[float, bool], object], **options: Any) -> None:
        super().__init__(**options)
        assert self.component is not None
        self.tag = self.component.tag
        self.on("drag", lambda e: dragged(*e.args), throttle=_OFTEN)

    def put(self, place: float, writer: PageWriter) -> None:
        """Move it to a position; in the page itself while the writer is ahead of NiceGUI."""
        with writer.writing(self):
            self.set_value(place)
        if writer.is_ahead:
            writer.write(self, {"place": place})
