"""Time from an event in the browser to the new picture, on every screen of `beamdyn app`.

Run: python -m benchmarks.event_times [--screen NAME]

A slider of the form is dragged by some pixels, a text is typed into a field, and the slider above a drawing
is moved by a key, on each screen that has these.  The time is measured in the page: from the event until the
browser paints the frame after the first change of the pictures, which may be preliminary.  The result is the
median of several events without the first one, on a machine that does nothing else.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from statistics import median
from typing import Any

from beamdyn.app.program import BEAMDYN
from benchmarks.rows import Row
from benchmarks.served import PATIENCE, browser, free_port, go, open_page, start, stop

SIZE = {"width": 1440, "height": 900}
RUNS = 9
BOUNDS = {"slider": 150, "field": 250, "player": 50}  # [ms]
# The input that is changed on a screen; if not listed, the radius.
CHANGED = {"Design": "beam.thickness", "Deck": "deck.length"}
_OTHERS = "mount.radius"
# Texts that are typed into the field: first value, step, unit.
FIELDS = {
    "mount.radius": (215.0, 0.5, "mm"),
    "beam.thickness": (0.2, 0.002, "mm"),
    "deck.length": (40.0, 0.2, "m"),
}
STEP, LONGEST = 4, 20_000  # pixels of a mouse move; longest wait for a picture [ms]
_SETTLES = 400  # wait after a picture, until further updates have arrived [ms]
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


def _time_slider(page: Any, path: str) -> float:
    made = _slider(page, path).first
    made.scroll_into_view_if_needed()
    box = made.bounding_box()
    x, y = box["x"] + 0.3 * box["width"], box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    took = _measure(page, "mousemove", lambda i: page.mouse.move(x + STEP * (i + 1), y))
    page.mouse.up()
    return took


def _field(page: Any, path: str) -> Any:
    """Return the visible fields of the form for an input."""
    return page.locator(f'[data-path="{path}"]').locator("visible=true")


def _time_field(page: Any, path: str) -> float:
    made, (start, step, unit) = _field(page, path).first, FIELDS[path]

    def write(i: int) -> None:
        made.fill(f"{start + step * (i + 1):.3f} {unit}")
        made.press("Tab")

    return _measure(page, "input", write)  # the page reacts before the field is left, if that takes long


def _time_player(page: Any, path: str) -> float:
    return _measure(page, "keydown", lambda _: _player(page, path).first.press("ArrowLeft"))


def _player(page: Any, _: str) -> Any:
    """Return the visible slider above a drawing, if any."""
    return page.get_by_role("slider", name="time").locator("visible=true")


def time_events(names: tuple[str, ...]) -> Iterator[Row]:
    """Measure the times of events on some screens, each on a separate page."""
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
    from playwright.sync_api import Error

    ways = {
        "slider": (_slider, _time_slider),
        "field": (_field, _time_field),
        "player": (_player, _time_player),
    }
    path = CHANGED.get(name, _OTHERS)
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
    names = [screen.name for document in BEAMDYN.documents for screen in document.screens]
    parser.add_argument("--screen", choices=names, action="append", help="may be repeated; all if not given")
    given = tuple(parser.parse_args().screen or names)
    for row in time_events(given):
        print("; bound ".join((": ".join(row[:2]), row[2])), flush=True)


if __name__ == "__main__":
    main()
