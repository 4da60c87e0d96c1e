"""Time from an event in the browser to the new picture, on every screen of the interactive programs.

Run: python -m benchmarks.event_times [--program brakes|beamdyn] [--screen NAME]

A slider of the form or a point of the drawing is dragged by some pixels, a field is written and left, and the
slider above a drawing is moved by a key, each where the screen has it. The time runs in the page itself: from
the event, as the page hears it, until the browser paints the frame after the first change of the pictures,
which may be preliminary. It is the median of several events, the first of which does not count, on a machine
that does nothing else.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Collection, Iterator
from statistics import median
from typing import Any

from beamdyn.app.program import BEAMDYN
from beamdyn.common.screens.screens import Document, Program, Screen
from benchmarks.rows import Row
from benchmarks.served import PATIENCE, browser, free_port, go, open_page, start, stop
from brakes.app.program import BRAKES

SIZE = {"width": 1440, "height": 900}
RUNS = 9
BOUNDS = {"slider": 150, "handle": 150, "field": 250, "player": 50}  # [ms]
PROGRAMS = {program.name: program for program in (BRAKES, BEAMDYN)}
# The input that is changed on a screen, if not the usual one: the answer of Design does not depend on that.
CHANGED = {"Design": "beam.thickness"}
_USUAL = "mount.radius"
_SHARE = 0.0025  # part of its number by which a field is changed
STEP, LONGEST = 4, 20_000  # pixels of a move; patience with a picture [ms]
_SETTLES = 400  # until what follows a picture has come as well [ms]
_WATCH = """(event) => {
  const shown = [...document.querySelectorAll(".shown")].find((e) => e.offsetParent);
  window.took = window.begun = null;
  const begin = () => { window.begun ??= performance.now(); };
  document.addEventListener(event, begin, { capture: true, once: true });
  const seen = new MutationObserver(() => {
    if (window.begun === null) return;
    seen.disconnect();
    requestAnimationFrame(() => setTimeout(() => { window.took = performance.now() - window.begun; }));
  });
  const drawn = { attributeFilter: ["d", "transform", "points", "src"], subtree: true };
  seen.observe(shown.querySelector(".pictures"), { childList: true, characterData: true, ...drawn });
  seen.observe(shown, { attributeFilter: ["data-solved"] });  // a picture may be the same for other numbers
}"""


def _measure(page: Any, event: str, act: Callable[[int], object]) -> float:
    """Measure the median time [ms] from an event to the next picture; ``act(i)`` makes the ith event."""
    times = []
    for i in range(RUNS + 1):
        page.evaluate(_WATCH, event)
        act(i)
        page.wait_for_function("window.took !== null", timeout=LONGEST)
        times.append(page.evaluate("window.took"))
        page.wait_for_timeout(_SETTLES)
    return median(times[1:])


def _slider(page: Any, path: str) -> Any:
    """Return the visible sliders of the form for an input."""
    return page.get_by_role("slider", name=path.partition(".")[2]).locator("visible=true")


def _handle(page: Any, _: str) -> Any:
    """The points of the drawing that can be dragged."""
    return page.locator(".handle").locator("visible=true")


def _drag(made: Any, across: float, down: int = 0) -> float:
    """Drag an element from a part of its width, by some pixels to the right, and down, at each event."""
    page = made.page
    made.scroll_into_view_if_needed()
    box = made.bounding_box()
    x, y = box["x"] + across * box["width"], box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    took = _measure(page, "mousemove", lambda i: page.mouse.move(x + STEP * (i + 1), y + down * (i + 1)))
    page.mouse.up()
    return took


def _time_slider(page: Any, path: str) -> float:
    return _drag(_slider(page, path).first, 0.3)


def _time_handle(page: Any, path: str) -> float:
    return _drag(_handle(page, path).first, 0.5, STEP)  # some points move up and down alone


def _field(page: Any, path: str) -> Any:
    """Return the visible fields of the form for an input."""
    return page.locator(f'[data-path="{path}"]').locator("visible=true")


def _time_field(page: Any, path: str) -> float:
    made = _field(page, path).first
    number, _, unit = made.input_value().partition(" ")

    def write(i: int) -> None:
        made.fill(f"{float(number) * (1 + _SHARE * (i + 1)):.6g} {unit}")
        made.press("Tab")

    return _measure(page, "input", write)  # the page reacts before the field is left, if that takes long


def _time_player(page: Any, path: str) -> float:
    return _measure(page, "keydown", lambda _: _player(page, path).first.press("ArrowLeft"))


def _player(page: Any, _: str) -> Any:
    """Return the slider above a drawing, where there is one."""
    return page.locator(".stroke").get_by_role("slider").locator("visible=true")


def changed_input(document: Document, screen: Screen) -> str:
    """Return the path of the input that is changed: a number, with its unit where it has one."""
    given = {path: text.partition(" ")[0] for path, text in document.base_entries.items()}
    numbers = [
        path
        for path, text in given.items()
        if path.partition(".")[0] in screen.sections and text.replace(".", "").isdigit() and text.strip("0.")
    ]
    preferred = CHANGED.get(screen.name, _USUAL)
    return preferred if preferred in numbers else numbers[0]


def time_events(program: Program, names: Collection[str] = ()) -> Iterator[Row]:
    """Time the events on some screens of a program, or on all, each on a separate page."""
    process = start(port := free_port(), program.name)
    try:
        with browser() as made:
            for document, screen in ((d, s) for d in program.documents for s in d.screens):
                if screen.name in names or not names:
                    page = open_page(made.new_context(viewport=SIZE), port)
                    yield from _time_screen(page, screen.name, changed_input(document, screen))
                    page.context.close()
    finally:
        stop(process)


def _time_screen(page: Any, name: str, path: str) -> Iterator[Row]:
    from playwright.sync_api import Error

    ways = {
        "slider": (_slider, _time_slider),
        "handle": (_handle, _time_handle),
        "field": (_field, _time_field),
        "player": (_player, _time_player),
    }
    for kind, (there, measure) in ways.items():
        try:
            page.set_default_timeout(1e3 * PATIENCE)  # for complete answers, before measurements begin
            go(page, name)
            page.set_default_timeout(LONGEST)
            if not there(page, path).count():
                continue
            took = f"{measure(page, path):.0f}"
        except Error as error:  # an event failed: the others are still measured
            took = f"not measured: {error.message.partition('Call log')[0].strip()}"
        yield f"{name}: {kind}, event to new picture [ms]", took, f"{BOUNDS[kind]}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else "")
    parser.add_argument("--program", choices=PROGRAMS)
    parser.add_argument("--screen", action="append", help="may be repeated; all if not given")
    given = parser.parse_args()
    for name, program in PROGRAMS.items():
        if given.program in (None, name):
            for row in time_events(program, given.screen or ()):
                print("; bound ".join((": ".join(row[:2]), row[2])), flush=True)


if __name__ == "__main__":
    main()
