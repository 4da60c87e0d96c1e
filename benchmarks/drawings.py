"""Speed of drawings.  Run: python -m benchmarks.drawings [--browser]

Prints the time to lay out each screen's drawing and to write it as SVG, the size of the SVG, and the time to
place labels.  With --browser, prints measurements in Chromium: the number of different pictures per second
while a point or a slider is dragged (recognized by the position's id in the page), the processor time of each
program, the time from the release to the complete answer or to the sign that a slow screen computes, and the
number of pictures per second while a slider is played.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from beamdyn.common.drawing.label_places import LabelRequest, Obstacles, place_labels
from beamdyn.common.drawing.layout import Paper
from beamdyn.common.drawing.shapes import Arrow, Drawing, Label
from beamdyn.common.drawing.svg import svg_of
from beamdyn.common.screens.handles import draw_sheet
from beamdyn.common.screens.open_document import OpenDocument
from benchmarks.hostile_entries import children_of
from benchmarks.rows import Row, show
from benchmarks.served import PATIENCE, browser, free_port, go, open_page, start, stop, up_to_date
from brakes.app.program import BRAKES

RUNS = 15  # number of times that each drawing is timed
DRAG, STEP = 3.0, 0.004  # duration of a drag, and time between two moves of the mouse [s]
LABELS, SHAPES, BOUND, PAINTED = 40, 180, 5, 20
AT_REST, BUSY = 300, 300  # largest times until the full answer, and until a sign of computing [ms]
REACH = 14  # distance that the mouse moves to either side [px]
POINTS = {
    "Vehicle": "centre of gravity of the load",
    "Kinematics": "tip of the shoe",
    "Drum brake": "pin of the shoe",
    "Caliper": "pivot of the arm of the right pad",
    "Mechanism": "E",  # point E: point C soon moves out of reach
}
SLIDER = "radius, r [mm]"
SLIDERS = {"Frequencies": "", "Rotor": "tip: setting angle", "Mode shapes": ""}  # a point to drag, if any
LONG = ("Steady response", "Transient")
PLAYED = {"brakes": ("Kinematics", "Caliper", "Mechanism"), "beamdyn": ("Mode shapes", "Transient")}
# Script: counts each solved position whose picture is visible when a frame is painted, once.
COUNT = """() => {
  window.pictures = new Set();
  const look = (it) =>
    requestAnimationFrame(() => it.checkVisibility() && window.pictures.add(it.dataset.solved));
  window.counting = new MutationObserver((seen) => look(seen[0].target));
  window.counting.observe(document.body, {subtree: true, attributeFilter: ["data-solved"]});
}"""
COUNTED = "() => { window.counting.disconnect(); return window.pictures.size; }"
# Script: counts for some seconds how often a different picture is visible when a frame is painted.
CHANGES = """(seconds) => new Promise((done) => {
  const end = performance.now() + 1000 * seconds;
  let last = "", count = 0;
  const look = (now) => {
    const shown = [...document.querySelectorAll(".board svg.machine")].filter((e) => e.checkVisibility());
    const name = shown.map((e) => e.id).join();
    if (name !== last) count += 1;
    last = name;
    if (now < end) requestAnimationFrame(look); else done(count);
  };
  requestAnimationFrame(look);
})"""
# Script: waits for some events, and then for a text on the page or a new answer; `window.told` is the time
# between them [ms].
WATCH = """([events, words, answer]) => {
  const shown = (of) => [...document.querySelectorAll(of)].filter((e) => e.checkVisibility());
  const solved = () => shown("[data-solved]").map((e) => e.dataset.solved).join();
  const before = solved();
  const seen = () => answer && solved() !== before
    || shown(".status[role=status], .q-btn").some((e) => e.innerText.trim() === words);
  window.told = new Promise((done) => {
    let begin = null;
    const look = () => seen() ? done(performance.now() - begin) : requestAnimationFrame(look);
    const first = () => { if (begin === null) { begin = performance.now(); requestAnimationFrame(look); } };
    for (const event of events.split(" ")) document.addEventListener(event, first, {capture: true});
  });
}"""
TOLD = "() => window.told"


def time_labels() -> Iterator[Row]:
    """Measure the time to place many labels among many lines."""
    draw = np.random.default_rng(19)
    ends = draw.uniform((40, 40, 40, 40), (640, 480, 640, 480), (SHAPES, 4))
    obstacles = Obstacles((4.0, 4.0, 676.0, 516.0), ends, ends[:, 2:])
    requests = [LabelRequest((60.0, 12.0), end[None, 2:], tuple(end[2:] - end[:2])) for end in ends[:LABELS]]

    def place() -> None:
        fresh = Obstacles(obstacles.frame, obstacles.lines, obstacles.points)
        assert None not in place_labels(requests, fresh)

    yield f"{LABELS} labels among {SHAPES} lines: places [ms]", f"{1e3 * _time(place):.1f}", f"{BOUND}"
    shapes = [Arrow(end[:2], end[2:], "load") for end in ends[: SHAPES - LABELS]]
    labels = [Label(f"{i} N", end[2:], "load", (1.0, 0.0)) for i, end in enumerate(ends[:LABELS])]
    rows = [[Drawing(shapes, labels, "Arrows", unit="mm")]]
    made = svg_of(rows, Paper(680.0, (520.0,)))
    time_ = _time(lambda: svg_of(rows, Paper(680.0, (520.0,))))
    yield f"drawing of {SHAPES} shapes and labels, as SVG [ms]", f"{1e3 * time_:.1f}", ""
    yield f"drawing of {SHAPES} shapes and labels, size [kB]", f"{len(made.encode()) / 1e3:.0f}", ""


def time_screens() -> Iterator[Row]:
    """Measure the time of the drawings of `brakes app`, as they are made while a point is dragged."""
    for document in BRAKES.documents:
        work = OpenDocument(document)
        for screen in document.screens:
            assert work.solve(screen)
            answer = work.answered[screen.name].answer
            made = draw_sheet(screen, answer, screen.last)
            for words, view in (("", None), (" while a point is held", made.view)):
                time_ = _time(lambda s=screen, a=answer, v=view: draw_sheet(s, a, s.last, v))
                yield f"{screen.name}: drawing{words} [ms]", f"{1e3 * time_:.1f}", ""
            yield f"{screen.name}: size of its SVG [kB]", f"{len(made.element.encode()) / 1e3:.1f}", ""


def _time(action: Callable[[], object]) -> float:
    """Measure the least processor time of an action [s]."""
    times = []
    for _ in range(RUNS):
        start = time.process_time()
        action()
        times.append(time.process_time() - start)
    return min(times)


def drag(program: str, things: Mapping[str, str]) -> Iterator[Row]:
    """Measure how each screen of a program follows a drag, and how soon it is solved after the release."""
    process = start(port := free_port(), program)
    try:
        with browser() as made:
            page = open_page(made.new_context(viewport={"width": 1280, "height": 900}), port)
            for name, label in [pair for thing in things.items() for pair in _held(page, *thing)]:
                go(page, name)
                rest(process.pid)
                before = processor_time([process.pid, *children_of(process.pid)])
                painted, late = _drag(page, label)
                spent = processor_time([process.pid, *children_of(process.pid)]) - before
                yield (
                    f"{name}: {label}: pictures painted a second",
                    f"{painted:.1f}",
                    f"{PAINTED}",
                )
                yield (
                    "... of the program's processor time for each [ms]",
                    f"{1e3 * spent / painted / DRAG:.0f}",
                    "",
                )
                yield "... from release to the full answer [ms]", f"{late:.0f}", f"{AT_REST}"
    finally:
        stop(process)


def play(program: str, names: Iterable[str]) -> Iterator[Row]:
    """Measure how often the picture of each screen changes while its slider is played."""
    process = start(port := free_port(), program)
    try:
        with browser() as made:
            page = open_page(made.new_context(viewport={"width": 1280, "height": 900}), port)
            for name in names:
                go(page, name)
                rest(process.pid)
                button = page.locator(".player:visible").first
                button.click()
                found = page.evaluate(CHANGES, DRAG)
                button.click()
                yield f"{name}, played: pictures painted a second", f"{found / DRAG:.1f}", f"{PAINTED}"
    finally:
        stop(process)


def wait_for_sign() -> Iterator[Row]:
    """Measure the time until slow screens show that they compute, or answer, after a key moved a slider."""
    process = start(port := free_port(), "beamdyn")
    try:
        with browser() as made:
            page = open_page(made.new_context(viewport={"width": 1280, "height": 900}), port)
            for name in LONG:
                go(page, name)
                _thing(page, SLIDER).focus()
                page.evaluate(WATCH, ["keydown", "Cancel", True])
                page.keyboard.press("ArrowRight")
                told = page.evaluate(TOLD)
                yield f"{name}: from a change to the busy sign, or the answer [ms]", f"{told:.0f}", f"{BUSY}"
                up_to_date(page)
    finally:
        stop(process)


def rest(program: int) -> None:
    """Wait until a program has finished secondary drawings, and started its spare processes."""
    deadline, last = time.monotonic() + PATIENCE, -1.0
    while (now := processor_time([program, *children_of(program)])) > last and time.monotonic() < deadline:
        last = now
        time.sleep(0.5)


def processor_time(ids: Iterable[int]) -> float:
    """Return the processor time of processes [s], from /proc."""
    ticks = 0
    for process in ids:
        with suppress(OSError):
            fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
            ticks += int(fields[11]) + int(fields[12])
    return ticks / os.sysconf("SC_CLK_TCK")


def _held(page: Any, name: str, point: str) -> list[tuple[str, str]]:
    """List the objects to drag on a screen: a point, and each slider of the form."""
    go(page, name)
    sliders = page.locator(".left .q-slider:visible [role=slider]").all()
    return [(name, label) for label in [point, *(it.get_attribute("aria-label") for it in sliders)] if label]


def _thing(page: Any, label: str) -> Any:
    """Return the handle of a point or of a slider on the visible screen."""
    found = page.get_by_role("slider", name=label, exact=True).locator("visible=true")
    thumb = found.locator("[tabindex='0']")
    return thumb if thumb.count() else found


def _drag(page: Any, label: str) -> tuple[float, float]:
    """Drag a handle; return pictures per second, and the time from release to the answer [ms]."""
    handle = _thing(page, label)
    handle.scroll_into_view_if_needed()
    x, y = _middle(handle)
    slider = page.locator(f".q-slider:has([aria-label='{label}']):visible")
    way = _across(slider.bounding_box()) if slider.count() else partial(_around, x, y)
    page.mouse.move(x, y)
    page.mouse.down()
    page.evaluate(COUNT)
    begin, now = time.monotonic(), 0.0
    while now < DRAG:
        page.mouse.move(*way(now))
        time.sleep(STEP)
        now = time.monotonic() - begin
    found = page.evaluate(COUNTED)
    page.evaluate(WATCH, ["pointerup mouseup", "Up to date.", False])
    page.mouse.move(x, y)  # the release is at a position with an answer
    page.mouse.up()
    rest = page.evaluate(TOLD)
    return found / now, rest


def _middle(thing: Any) -> tuple[float, float]:
    box = thing.bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def _around(x: float, y: float, now: float) -> tuple[float, float]:
    """Return the mouse position while a drawing's point is dragged along a small figure around its start."""
    return x + REACH * np.sin(2.9 * now), y + 9 * np.sin(4.7 * now)


def _across(box: Mapping[str, float]) -> Callable[[float], tuple[float, float]]:
    """Return the mouse position while a slider is dragged across once, so that each value occurs once."""
    return lambda now: (box["x"] + box["width"] * now / DRAG, box["y"] + box["height"] / 2)


PARTS = time_labels, time_screens


def main() -> None:
    if "--browser" in sys.argv[1:]:
        # each row is printed at once, because a browser on a busy machine is slow
        played = chain.from_iterable(play(*which) for which in PLAYED.items())
        for row in chain(drag("brakes", POINTS), drag("beamdyn", SLIDERS), played, wait_for_sign()):
            print("  ".join(row), flush=True)
    else:
        show("drawings", *PARTS)


if __name__ == "__main__":
    main()
