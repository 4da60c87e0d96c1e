"""A button that plays a slider, such as the stroke of a brake or the time of a motion."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from typing import Any

from nicegui import background_tasks, ui

from beamdyn.common.screens.courses import Course
from beamdyn.common.screens.drag_slider import DragSlider
from beamdyn.common.screens.page_writer import PageWriter

STYLE = """
.stroke { flex-wrap: nowrap; align-items: center; gap: 0; }
.stroke .player { order: -1; margin-bottom: 1.5rem; }
"""
_LEAST = 0.03  # least time between two pictures [s]
_LONGEST = 0.2  # most time by which one picture advances the motion, so that it does not jump [s]
_STILL = 1.0  # time that each picture stays where reduced motion is preferred [s]
_STILLS = 4  # pictures from one end to the other where reduced motion is preferred
_PATIENCE = 3.0  # time after which a page that has painted nothing counts as not seen [s]

# What has been sent is there when the script runs, and painted after the next frame has been begun.
_PAINTED = """return new Promise(done => requestAnimationFrame(() => setTimeout(() => {{
  const seen = getHtmlElement({id})?.offsetParent;
  done(!seen ? "away" : matchMedia("(prefers-reduced-motion: reduce)").matches ? "still" : "moving");
}})))"""


class Player:
    """A button before a slider, which plays it and pauses it; so does the space bar on the slider.

    The slider moves on when the page has painted the last picture, so that pictures never pile up.  Moving it
    by hand pauses it, and so does a page that is not seen.  Where the browser prefers reduced motion, a few
    stills are shown.

    Parameters
    ----------
    slider : DragSlider
        The slider; whoever draws follows its changes.
    label : str
        Name of what is played, such as "stroke".
    course : Course
        Position of the slider over time.
    writer : PageWriter
        Writes into the page while it plays.
    rested : callable
        Called when it has been paused.
    """

    def __init__(
        self,
        slider: DragSlider,
        label: str,
        course: Course,
        writer: PageWriter,
        rested: Callable[[], object] = lambda: None,
    ) -> None:
        self._slider, self._label, self._course = slider, label, course
        self._writer, self._rested = writer, rested
        self._task: asyncio.Task[None] | None = None
        self._sets = False
        self._button: Any = ui.button(on_click=self.toggle).props("flat round dense").classes("player")
        slider.on("keydown.space.prevent", self.toggle)
        slider.on_value_change(self._by_hand)
        self._show()

    @property
    def plays(self) -> bool:
        """Whether it plays."""
        return self._task is not None

    def toggle(self) -> None:
        """Play; or pause."""
        if self.plays:
            self.pause()
        else:
            self._task = background_tasks.create(self._play())
            self._show()

    def pause(self) -> None:
        """Stop at the present position."""
        task, self._task = self._task, None
        if task is not None:
            self._show()
            self._writer.synchronize()
            self._rested()

    def _by_hand(self) -> None:
        if not self._sets:
            self.pause()

    def _show(self) -> None:
        words = f"{'pause' if self.plays else 'play'} {self._label}"
        self._button.props["icon"] = "pause" if self.plays else "play_arrow"
        self._button.props["aria-label"] = self._button.props["title"] = words
        self._button.update()

    async def _play(self) -> None:
        task = asyncio.current_task()
        elapsed, last = self._course.elapsed(self._slider.value or 0.0), time.monotonic()
        while self._task is task and not self._slider.is_deleted:
            seen = await self._painted()
            if self._task is not task:
                return
            if seen == "away":
                return self.pause()
            still = seen == "still"
            await asyncio.sleep(max((_STILL if still else _LEAST) - (time.monotonic() - last), 0.0))
            now = time.monotonic()
            elapsed += self._course.seconds / _STILLS if still else min(now - last, _LONGEST)
            last = now
            if self._task is task:
                self._put(self._course.place(elapsed))

    def _put(self, place: float) -> None:
        self._sets = True
        try:
            self._slider.put(place, self._writer)
        finally:
            self._sets = False

    async def _painted(self) -> str:
        """Wait until the page has painted what it was sent; return "moving", "still" or "away" (not seen)."""
        code = _PAINTED.format(id=self._button.id)
        try:
            return str(await self._button.client.run_javascript(code, timeout=_PATIENCE))
        except TimeoutError:
            return "away"
