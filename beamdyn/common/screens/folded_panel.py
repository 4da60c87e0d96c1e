"""A part of a screen that folds out on the page, and is made only while it is open."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from nicegui import ui

from beamdyn.common.edge.rendering import picture
from beamdyn.common.screens.under_way import UnderWay

STYLE = """
.folded svg { width: 100%; max-width: 960px; height: auto; display: block; }
"""


class FoldedPanel:
    """A part of an answer that folds out, made in another process; the last one stays until it has come.

    Parameters
    ----------
    title : str
        Title of the part.
    make : callable
        ``make(answer)`` returns a future of the part as HTML.
    """

    def __init__(self, title: str, make: Callable[[Any], asyncio.Future[str]]) -> None:
        self.title, self._make = title, make
        self._answer: Any = None
        self._way = UnderWay(self._settle, self._fail)
        self._fold: Any = ui.expansion(title, on_value_change=self._fill)
        with self._fold.classes("w-full section folded").props("dense"):
            self._frame: Any = ui.html("", sanitize=False).classes("w-full drawing-frame")

    def show(self, answer: object) -> None:
        """Show another answer."""
        self._answer = answer
        self._fill()

    def close(self) -> None:
        """End what is being made."""
        self._way.cancel()

    def _fill(self) -> None:
        if self._fold.value and self._answer is not None:
            self._way.want(lambda: self._make(self._answer))

    def _settle(self, future: asyncio.Future[str], last: bool) -> None:
        if self._frame.is_deleted or future.cancelled():
            return
        error = future.exception()
        if error is not None:
            return self._fail(error)
        self._frame.set_content(future.result())

    def _fail(self, error: BaseException) -> None:
        self._frame.set_content(picture(f"There is no drawing: {error}", ""))
