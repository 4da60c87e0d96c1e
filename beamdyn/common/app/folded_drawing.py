"""Additional drawings on the page: folded, and drawn only while they are open."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from nicegui import ui

from beamdyn.common.app.under_way import UnderWay
from beamdyn.common.edge.rendering import picture


class PictureOf:
    """A picture that is drawn beside the page's process: the last one stays until the next one has come."""

    def __init__(self) -> None:
        self._way = UnderWay(self._settle, self._fail)
        self._frame: Any = ui.html("", sanitize=False).classes("w-full drawing-frame")

    def want(self, start: Callable[[], asyncio.Future[str]]) -> None:
        """Show the picture that this starts to draw; of several the newest."""
        self._way.want(start)

    def close(self) -> None:
        """End what is being drawn."""
        self._way.cancel()

    def _settle(self, future: asyncio.Future[str], last: bool) -> None:
        if self._frame.is_deleted or future.cancelled():
            return
        error = future.exception()
        if error is not None:
            return self._fail(error)
        self._frame.set_content(future.result())
        self._frame.set_visibility(bool(future.result()))

    def _fail(self, error: BaseException) -> None:
        self._frame.set_content(picture(f"There is no drawing: {error}", ""))
        self._frame.set_visibility(True)


class FoldedDrawing:
    """A folded drawing of an answer.

    Parameters
    ----------
    title : str
        What it shows.
    draw : callable
        Answer in; out comes what draws it, which gives HTML.
    """

    def __init__(self, title: str, draw: Callable[[Any], asyncio.Future[str]]) -> None:
        self.title, self._draw = title, draw
        self._answer: Any = None
        with (
            ui.expansion(title, on_value_change=self._fill)
            .classes("w-full section")
            .props("dense") as self._fold
        ):
            self._picture = PictureOf()

    def show(self, answer: object) -> None:
        """Show another answer."""
        self._answer = answer
        self._fill()

    def close(self) -> None:
        """End what is being drawn."""
        self._picture.close()

    def _fill(self) -> None:
        if self._fold.value and self._answer is not None:
            self._picture.want(lambda: self._draw(self._answer))
