"""A drawing on the page with handles that can be moved by mouse, finger or arrow keys."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial
from typing import Any

from nicegui import ui

from beamdyn.common.screens.handles import Place, Sheet, Viewport
from beamdyn.common.screens.page_writer import PageWriter, toggle
from beamdyn.common.screens.screen_parts import Handle

_OFTEN = 0.03  # least time between two messages while a handle is dragged [s]
_PAUSE = 0.01  # pause after each drawing, in which the browser receives it and sends newer positions [s]
# Functions of page.js that send the position of the pointer, and the direction of an arrow key.
_HOLD, _KEY = "(event) => holdHandle(event, emit)", "(event) => stepHandle(event, emit)"
_FAR = 10  # factor on the step of an arrow key while the shift key is pressed


class DraggableDrawing:
    """A drawing with handles that can be dragged.

    Parameters
    ----------
    words : str
        Description of the drawing for screen readers.
    moved : callable
        Called when a handle is moved, with the handle, its new position (x, y) [m], and whether it was
        released.
    writer : PageWriter
        Object that updates the drawing on the page while a handle or slider is held.

    Attributes
    ----------
    held : Viewport, optional
        Viewport that is kept while a handle is held.
    view : Viewport, optional
        Viewport of the visible drawing.
    """

    def __init__(
        self, words: str, moved: Callable[[Handle, Place, bool], object], writer: PageWriter
    ) -> None:
        self.held: Viewport | None = None
        self.view: Viewport | None = None
        self._moved, self._writer = moved, writer
        self._sheet = Sheet("")
        self._wanted: tuple[int, Place, bool] | None = None
        self._follows = False
        # Positions of handles that arrow keys have moved, until these positions are drawn.
        self._stepped_to: dict[int, Place] = {}
        self._handles: list[Any] = []
        self._places: dict[int, str] = {}
        self._said: Any = ui.label()
        with ui.element("div").classes("w-full drawing-frame"):
            self._board: Any = ui.element("div").classes("board")
        with self._board:
            self._machine: Any = ui.html("", sanitize=False)
        self._board.props["data-words"] = words
        self._how: Any = ui.label("Drag the round points, or choose one by Tab and move it by arrow keys.")
        self._how.classes("status")
        self._board.set_visibility(False)
        self._how.set_visibility(False)

    def show(self, sheet: Sheet, words: Callable[[Handle], str]) -> None:
        """Show a drawing, with a text for screen readers on the position of each handle."""
        parts, self.view = (self._said, self._board, self._machine, self._how), sheet.view
        with self._writer.writing(*parts, *self._handles):
            self._said.set_text(sheet.said)
            self._board.set_visibility(sheet.view is not None)
            if sheet.view is not None:
                self._board.style(f"--ratio: {sheet.ratio:.6g}")
                self._board.props["data-picture"] = sheet.name
                self._machine.set_content(sheet.element)
            self._how.set_visibility(bool(sheet.handles))
            for element in self._handles:
                toggle(element, "away", not sheet.handles)
            if sheet.handles:  # otherwise old handles are only hidden, as one may be held
                self._put_handles(sheet, words)

    def _put_handles(self, sheet: Sheet, words: Callable[[Handle], str]) -> None:
        """Move handles to their positions; the browser gets messages only for handles that have changed."""
        labels = [handle.label for handle in sheet.handles]
        if labels != [handle.label for handle in self._sheet.handles]:
            for element in self._handles:
                element.delete()
            with self._board:
                self._handles = [self._handle(i, label) for i, label in enumerate(labels)]
        self._sheet = sheet
        for element, handle in zip(self._handles, sheet.handles, strict=True):
            x, y = sheet.place(handle)
            at = f"left: {100 * x:.3f}%; top: {100 * y:.3f}%"
            if self.held is None or self._places.get(element.id) != at:
                self._places[element.id] = at
                element.style(at)
                element.props["aria-valuenow"] = round(100 * x)
                element.props["aria-valuetext"] = words(handle)

    def _handle(self, i: int, label: str) -> Any:
        made: Any = ui.element("div").classes("handle")
        made.props('role="slider" tabindex=0 aria-roledescription="point that can be moved"')
        made.props["aria-label"] = made.props["title"] = label
        made.on("pointerdown", partial(self._pulled, i), throttle=_OFTEN, js_handler=_HOLD)
        return made.on("keydown", partial(self._stepped, i), js_handler=_KEY)

    def _stepped(self, i: int, event: Any) -> None:
        across, up, far = event.args
        handle = self._sheet.handles[i]
        x, y = self._stepped_to.get(i, handle.at)
        step = handle.step * (_FAR if far else 1)
        self._stepped_to[i] = x + step * across, y + step * up
        self._moved(handle, self._stepped_to[i], True)

    def forget_steps(self) -> None:
        """Discard the positions set by arrow keys once the drawing shows the present inputs."""
        self._stepped_to.clear()

    async def _pulled(self, i: int, event: Any) -> None:
        """Move a handle to the latest received position; positions received during drawing may be skipped."""
        x, y, done = event.args
        self._wanted = (i, (x, y), done)
        if self._follows:
            return
        self._follows = True
        try:
            while self._wanted is not None:
                (i, place, done), self._wanted = self._wanted, None
                handle, view = self._sheet.handles[i], self._sheet.view
                assert view is not None
                x, y = view.point(place)
                self.held = None if done else view
                self._moved(handle, (x / handle.scale, y / handle.scale), done)
                await asyncio.sleep(_PAUSE)
        finally:
            self._follows = False
