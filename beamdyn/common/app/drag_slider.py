"""A slider that moves by itself in the page, so that it waits for no answer while it is dragged."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nicegui import ui

from beamdyn.common.app.page_writer import PageWriter

_OFTEN = 0.03  # least time between two messages of a slider that is dragged [s]


class DragSlider(ui.slider, component="drag_slider.js"):
    """A slider whose drags are told.

    Parameters
    ----------
    dragged : callable
        Called with its place, and whether it has been let go; of a step by a key or a click, it has.
    **options
        Of `ui.slider`.
    """

    def __init__(self, dragged: Callable[[float, bool], object], **options: Any) -> None:
        super().__init__(**options)
        assert self.component is not None
        self.tag = self.component.tag
        self.on("drag", lambda e: dragged(*e.args), throttle=_OFTEN)

    def put(self, place: float, writer: PageWriter) -> None:
        """Move it to a place, past the toolkit while the writer is ahead of that."""
        with writer.writing(self):
            self.set_value(place)
        if writer.is_ahead:
            writer.write(self, {"place": place})
