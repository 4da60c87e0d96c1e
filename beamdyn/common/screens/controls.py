"""Controls of a drawing: a slider that the page moves itself, a player of it, and a choice of branches."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Mapping
from typing import Any

from nicegui import background_tasks, ui

from beamdyn.common.screens.page_writer import PageWriter
from beamdyn.common.screens.screen_parts import Slider

_OFTEN = (
    0.03  # least time between two messages of a dragged slider, or between two pictures of a played one [s]
)
_LONGEST = 0.2  # longest time by which one picture of a played motion advances, so that it does not jump [s]
_REST = 0.3  # time after a release or a step by key from which a slider counts as at rest [s]
_STILL = 1.0  # time for which each picture stays where reduced motion is preferred [s]
_STILLS = 4  # number of pictures from one end to the other where reduced motion is preferred
_PATIENCE = 3.0  # time without painting, after which a page counts as not visible [s]

# All that was sent is in the page when this script runs, and is painted once the next frame has begun.
_PAINTED = """return new Promise(done => requestAnimationFrame(() => setTimeout(() => {{
  const seen = getHtmlElement({id})?.offsetParent;
  done(!seen ? "away" : matchMedia("(prefers-reduced-motion: reduce)").matches ? "still" : "moving");
}})))"""


class DragSlider(ui.slider, component="drag_slider.js"):
    """A slider that the page itself moves, and that reports while dragged, without waiting for the server.

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
        """Move the slider to a position; directly in the page while the writer is ahead of NiceGUI."""
        with writer.writing(self):
            self.set_value(place)
        if writer.is_ahead:
            writer.write(self, {"place": place})


class Player:
    """A slider above a drawing, with a button (or the space bar) that plays and pauses it.

    The slider moves on when the page has painted the last picture, so that pictures never pile up.  Moving it
    by hand pauses it, and so does a page that is not seen.  Where the browser prefers reduced motion, a few
    stills are shown.

    Parameters
    ----------
    motion : Slider
        Name of the slider, and its positions over time.
    writer : PageWriter
        Writes into the page while it plays or is dragged.
    turned : callable
        Called when the slider has been moved, or paused.
    """

    def __init__(self, motion: Slider, writer: PageWriter, turned: Callable[[], object]) -> None:
        self._motion, self._writer, self._turned = motion, writer, turned
        self._task: asyncio.Task[None] | None = None
        # Whether the player sets the slider, and whether a hand moves it.
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
        """Position of the slider."""
        return float(self._slider.value or 0.0)

    @property
    def moves(self) -> bool:
        """Whether the slider is played or moved by hand, also by single steps."""
        return self.plays or self._swings

    def _swing(self, place: float, done: bool) -> None:
        self._swings = True
        with self._writer.writing(self._slider):
            self._slider.set_value(place)
        if self._rest is not None:
            self._rest.cancel()
        if done:  # another step of a key may follow soon
            self._rest = asyncio.get_running_loop().call_later(_REST, self._stop)

    def _stop(self) -> None:
        """Come to rest, and tell NiceGUI what has been written into the page."""
        self._swings = False
        if not self._slider.is_deleted:
            with self._slider:
                self._writer.synchronize()

    @property
    def plays(self) -> bool:
        """Whether the slider is being played."""
        return self._task is not None

    def toggle(self) -> None:
        """Start playing if at rest; else pause."""
        if self.plays:
            self.pause()
        else:
            self._task = background_tasks.create(self._play())
            self._show_button()

    def pause(self) -> None:
        """Pause at the present position."""
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
            try:  # waits until the page has painted what it was sent
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
    """Buttons that choose which branch of an answer is drawn; hidden if the answer has only one.

    Parameters
    ----------
    chosen : callable
        Called when another branch has been chosen.
    """

    def __init__(self, chosen: Callable[[], object]) -> None:
        self._row: Any = ui.row().classes("items-center gap-2")
        with self._row:
            ui.label("Forces drawn:")
            self._toggle: Any = ui.toggle([], on_change=chosen)
            self._toggle.props('no-caps outline padding="xs md" role="group" aria-label="forces drawn"')
        self._row.set_visibility(False)

    def choose(self, answer: Any, branches: Mapping[str, Any]) -> Any:
        """Return the chosen branch of an answer; the first one until another is chosen."""
        names = [*branches]
        if names != self._toggle.options:
            kept = self._toggle.value if self._toggle.value in names else next(iter(names), None)
            self._toggle.set_options(names, value=kept)
        self._row.set_visibility(bool(names))
        return branches.get(self._toggle.value, answer)
