"""Time from an event in the browser to the new picture, on every screen of `beamdyn app`.

Run: python -m benchmarks.event_times [--screen NAME]

A slider of the form is dragged by some pixels, a field is written and left, and the slider above a drawing is
moved by a key. The time runs in the page itself: from the event, as the page hears it, until the browser
paints the frame after the first change of the pictures. It is the median of several events, the first of
which does not count, on a machine that does nothing else.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from functools import partial
from statistics import median
from typing import Any

from beamdyn.app.program import BEAMDYN
from benchmarks.rows import Row, show
from benchmarks.served import browser, free_port, go, open_page, start, stop, up_to_date

SIZE = {"width": 1440, "height": 900}
RUNS = 9
BOUNDS = {"slider": 150, "field": 250, "player": 50}  # [ms]
FIELD, STEP, LONGEST = (
    "beam.thickness",
    4,
    20_000,
)  # which field; pixels of a move; patience with a picture [ms]
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
  seen.observe(shown, { attributeFilter: ["data-solved"] });
}"""


def _measure(page: Any, event: str, act: Callable[[int], object]) -> float:
    """Median time [ms] from an event to the next picture; ``act(i)`` does it for the ith time."""
    times = []
    for i in range(RUNS + 1):
        page.evaluate(_WATCH, event)
        act(i)
        page.wait_for_function("window.took !== null", timeout=LONGEST)
        times.append(page.evaluate("window.took"))
        page.wait_for_timeout(_SETTLES)
    return median(times[1:])


def _time_slider(page: Any, name: str) -> float:
    made = page.get_by_role("slider", name=name).locator("visible=true").first
    made.scroll_into_view_if_needed()
    box = made.bounding_box()
    x, y = box["x"] + 0.3 * box["width"], box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    took = _measure(page, "mousemove", lambda i: page.mouse.move(x + STEP * (i + 1), y))
    page.mouse.up()
    return took


def _time_field(page: Any) -> float:
    made = page.locator(f'[data-path="{FIELD}"]').locator("visible=true").first

    def write(i: int) -> None:
        made.fill(f"{0.2 + 0.002 * (i + 1):.3f} mm")
        made.press("Tab")

    return _measure(page, "input", write)  # it is heard before the field is left, if that takes long


def _time_player(page: Any) -> float:
    made = page.get_by_role("slider", name="time").locator("visible=true").first
    return _measure(page, "keydown", lambda _: made.press("ArrowLeft"))


def time_events(names: tuple[str, ...]) -> Iterator[Row]:
    """Times of the events on some screens, each on a page of its own."""
    process = start(port := free_port(), BEAMDYN.name)
    try:
        with browser() as made:
            for name in names:
                page = open_page(made.new_context(viewport=SIZE), port)
                yield from _time_screen(page, name)
                page.context.close()
    finally:
        stop(process)


def _time_screen(page: Any, name: str) -> Iterator[Row]:
    go(page, name)
    ways = {"slider": partial(_time_slider, page, "thickness"), "field": partial(_time_field, page)}
    if page.get_by_role("slider", name="time").locator("visible=true").count():
        ways["player"] = partial(_time_player, page)
    for kind, measure in ways.items():
        yield f"{name}: {kind}, event to new picture [ms]", f"{measure():.0f}", f"{BOUNDS[kind]}"
        up_to_date(page)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else "")
    names = [screen.name for document in BEAMDYN.documents for screen in document.screens]
    parser.add_argument("--screen", choices=names, action="append", help="may be repeated; all if not given")
    given = tuple(parser.parse_args().screen or names)
    show("events", lambda: time_events(given))


if __name__ == "__main__":
    main()
