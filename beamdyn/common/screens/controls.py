"""Controls of a drawing: a slider, a button that animates it, and a choice of solution branches."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Mapping
from typing import Any

from nicegui import background_tasks, ui

from beamdyn.common.screens.page_writer import PageWriter
from beamdyn.common.screens.screen_parts import Slider

_OFTEN = (
    0.03  # least time between two messages of a dragged slider, or between two pictures of an animation [s]
)
_LONGEST = 0.2  # longest step in time between two pictures of an animation, so that it does not jump [s]
_REST = 0.3  # time after a release or a key press after which a slider counts as at rest [s]
_STILL = 1.0  # time for which each picture is shown if the user prefers reduced motion [s]
_STILLS = 4  # number of pictures of an animation if the user prefers reduced motion
_PATIENCE = 3.0  # time without painting after which a page counts as hidden [s]

# This script waits until the browser has painted the changes sent to it: until the end of the next frame.
_PAINTED = """return new Promise(done => requestAnimationFrame(() => setTimeout(() => {{
  const seen = getHtmlElement({id})?.offsetParent;
  done(!seen ? "away" : matchMedia("(prefers-reduced-motion: reduce)").matches ? "still" : "moving");
}})))"""


class DragSlider(ui.slider, component="drag_slider.js"):
    """A slider that the browser moves itself; while dragged it sends messages without waiting for replies.

    Parameters
    ----------
    dragged : callable
        Called with the position, and whether the slider was released (also after a key press or click).
    **options
        Options of `ui.slider`.
    """

    def __init__(self, dragged: Callable[[float, bool], object], **options: Any) -> None:
        super().__init__(**options)
        assert self.component is not None
        self.tag = self.component.tag
        self.on("drag", lambda e: dragged(*e.args), throttle=_OFTEN)

    def put(self, place: float, writer: PageWriter) -> None:
        """Move the slider to a position, directly in the browser too if NiceGUI lags behind."""
        with writer.writing(self):
            self.set_value(place)
        if writer.is_ahead:
            writer.write(self, {"place": place})


class Player:
    """A slider above a drawing, with a button (or the space bar) that starts and pauses an animation.

    The slider advances when the browser has painted the last picture, so that pictures never pile up.  The
    animation pauses if the user moves the slider, or if the page is hidden.  If the browser is set to reduced
    motion, a few still pictures are shown instead.

    Parameters
    ----------
    motion : Slider
        Label of the slider, and its position as a function of time.
    writer : PageWriter
        Object that updates the page while the slider is animated or dragged.
    turned : callable
        Called when the slider was moved, or the animation paused.
    """

    def __init__(self, motion: Slider, writer: PageWriter, turned: Callable[[], object]) -> None:
        self._motion, self._writer, self._turned = motion, writer, turned
        self._task: asyncio.Task[None] | None = None
        # Whether the program is setting the slider, and whether the user moves it.
        self._sets, self._swings = False, False
        self._rest: asyncio.TimerHandle | None = None
        last, marks = motion.last, ", ".join(f"{i}: '{mark}'" for i, mark in enumerate(motion.marks))
        with ui.row().classes("stroke w-full"):
            self._slider = DragSlider(
                self._swing, min=0, max=last, step=motion.step, value=last, on_change=turned
            )
            self._slider.props(f'aria-label="{motion.label}" :marker-labels="{{{marks}}}" markers=1')
            self._slider.classes("slider").on("keydown.space.prevent", self.toggle)
            self._slider.on_value_change(lambda: None if self._sets else self.pause())
            self._button: Any = ui.button(on_click=self.toggle).props("flat round dense").classes("player")
        self._show_button()

    @property
    def place(self) -> float:
        """Return the position of the slider."""
        return float(self._slider.value or 0.0)

    @property
    def moves(self) -> bool:
        """Return whether the slider is animated or moved by the user, also in single steps."""
        return self.plays or self._swings

    def _swing(self, place: float, done: bool) -> None:
        self._swings = True
        with self._writer.writing(self._slider):
            self._slider.set_value(place)
        if self._rest is not None:
            self._rest.cancel()
        if done:  # the user may soon press a key again
            self._rest = asyncio.get_running_loop().call_later(_REST, self._stop)

    def _stop(self) -> None:
        """Count the slider as at rest; report to NiceGUI the changes that were written into the page."""
        self._swings = False
        if not self._slider.is_deleted:
            with self._slider:
                self._writer.synchronize()

    @property
    def plays(self) -> bool:
        """Return whether the animation is running."""
        return self._task is not None

    def toggle(self) -> None:
        """Start the animation if it is paused; else pause it."""
        if self.plays:
            self.pause()
        else:
            self._task = background_tasks.create(self._play())
            self._show_button()

    def pause(self) -> None:
        """Pause the animation at the present position."""
        task, self._task = self._task, None
        if task is not None:
            self._show_button()
            self._writer.synchronize()
            self._turned()

    def _show_button(self) -> None:
        words = f"{'pause' if self.plays else 'play'} {self._motion.label}"
        self._button.props["icon"] = "pause" if self.plays else "play_arrow"
        self._button.props["aria-label"] = self._button.props["title"] = words
        self._button.update()

    async def _play(self) -> None:
        task = asyncio.current_task()
        elapsed, last = self._motion.elapsed(self.place), time.monotonic()
        while self._task is task and not self._slider.is_deleted:
            try:  # waits until the browser has painted the changes
                code = _PAINTED.format(id=self._button.id)
                seen = await self._button.client.run_javascript(code, timeout=_PATIENCE)
            except TimeoutError:
                seen = "away"
            if self._task is not task:
                return
            if seen == "away":
                return self.pause()
            still = seen == "still"
            await asyncio.sleep(max((_STILL if still else _OFTEN) - (time.monotonic() - last), 0.0))
            now = time.monotonic()
            elapsed += self._motion.seconds / _STILLS if still else min(now - last, _LONGEST)
            last = now
            if self._task is task:
                self._sets = True
                try:
                    self._slider.put(self._motion.place(elapsed), self._writer)
                finally:
                    self._sets = False


class BranchChoice:
    """Buttons to choose which solution branch is drawn; hidden if there is only one branch.

    Parameters
    ----------
    chosen : callable
        Called when the user has chosen another branch.
    """

    def __init__(self, chosen: Callable[[], object]) -> None:
        self._row: Any = ui.row().classes("items-center gap-2")
        with self._row:
            ui.label("Forces drawn:")
            self._toggle: Any = ui.toggle([], on_change=chosen)
            self._toggle.props('no-caps outline padding="xs md" role="group" aria-label="forces drawn"')
        self._row.set_visibility(False)

    def choose(self, answer: Any, branches: Mapping[str, Any]) -> Any:
        """Return the result with the chosen branch; with the first branch until the user chooses another."""
        names = [*branches]
        if names != self._toggle.options:
            kept = self._toggle.value if self._toggle.value in names else next(iter(names), None)
            self._toggle.set_options(names, value=kept)
        self._row.set_visibility(bool(names))
        return branches.get(self._toggle.value, answer)
