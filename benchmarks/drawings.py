"""Speed of drawings.  Run: python -m benchmarks.drawings [--browser]

Prints how long each screen's drawing takes to be laid out and written as SVG, and how large that is, and how
long labels take.  With --browser instead, in Chromium, how many different pictures of a solved position are
painted a second while a point is dragged, told by the id of the picture in the page.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from beamdyn.common.app.handles import draw_sheet
from beamdyn.common.app.open_document import OpenDocument
from beamdyn.common.drawing.label_places import Ground, Wish, place_labels
from beamdyn.common.drawing.shapes import Arrow, Drawing, Label
from beamdyn.common.drawing.sheet import Paper
from beamdyn.common.drawing.svg import svg_of
from benchmarks.rows import Row, show
from benchmarks.served import browser, free_port, go, open_page, start, stop, up_to_date
from brakes.app.program import BRAKES

RUNS = 15  # how often each is timed
DRAG, STEP = 3.0, 0.012  # length of a drag, and between two moves of the mouse [s]
LABELS, SHAPES, BOUND, PAINTED = 40, 180, 5, 20
POINTS = {
    "Vehicle": "centre of gravity of the load",
    "Kinematics": "tip of the shoe",
    "Drum brake": "pin of the shoe",
    "Caliper": "pivot of the arm of the right pad",
    "Mechanism": "C",
}
# Counts each picture that is there when a frame is painted, once.
COUNT = """() => {
  window.pictures = new Set(); window.frames = 0; window.counting = true;
  const look = () => {
    for (const it of document.querySelectorAll('.board svg.machine'))
      if (it.getBoundingClientRect().width) window.pictures.add(it.id);
    window.frames += 1;
    if (window.counting) requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
}"""


def time_labels() -> Iterator[Row]:
    """Places of many labels among many lines."""
    draw = np.random.default_rng(19)
    ends = draw.uniform((40, 40, 40, 40), (640, 480, 640, 480), (SHAPES, 4))
    ground = Ground((4.0, 4.0, 676.0, 516.0), ends, ends[:, 2:])
    wishes = [Wish((60.0, 12.0), end[None, 2:], tuple(end[2:] - end[:2])) for end in ends[:LABELS]]

    def place() -> None:
        fresh = Ground(ground.frame, ground.lines, ground.points)
        assert None not in place_labels(wishes, fresh)

    yield f"{LABELS} labels among {SHAPES} lines: places [ms]", f"{1e3 * _time(place):.1f}", f"{BOUND}"
    shapes = [Arrow(end[:2], end[2:], "load") for end in ends[: SHAPES - LABELS]]
    labels = [Label(f"{i} N", end[2:], "load", (1.0, 0.0)) for i, end in enumerate(ends[:LABELS])]
    rows = [[Drawing(shapes, labels, "Arrows", unit="mm")]]
    made = svg_of(rows, Paper(680.0, (520.0,)))
    time_ = _time(lambda: svg_of(rows, Paper(680.0, (520.0,))))
    yield f"drawing of {SHAPES} shapes and labels, as SVG [ms]", f"{1e3 * time_:.1f}", ""
    yield f"drawing of {SHAPES} shapes and labels, size [kB]", f"{len(made.encode()) / 1e3:.0f}", ""


def time_screens() -> Iterator[Row]:
    """Drawings of the screens of `brakes app`, as they are while a point is dragged."""
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
    """Least processor time of an action [s]."""
    times = []
    for _ in range(RUNS):
        start = time.process_time()
        action()
        times.append(time.process_time() - start)
    return min(times)


def drag_points() -> Iterator[Row]:
    """Pictures painted a second in Chromium while a point of each screen is dragged."""
    process = start(port := free_port())
    try:
        with browser() as made:
            page = open_page(made.new_context(viewport={"width": 1280, "height": 900}), port)
            for name, label in POINTS.items():
                go(page, name)
                painted, frames = _drag(page, label)
                yield (
                    f"{name}: pictures painted a second ({frames:.0f} frames)",
                    f"{painted:.1f}",
                    f"{PAINTED}",
                )
    finally:
        stop(process)


def _drag(page: Any, label: str) -> tuple[float, float]:
    """Drag a point in a small circle; different pictures and frames a second."""
    handle = page.get_by_role("slider", name=label, exact=True).locator("visible=true")
    handle.scroll_into_view_if_needed()
    box = handle.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.evaluate(COUNT)
    begin, now = time.monotonic(), 0.0
    while now < DRAG:
        page.mouse.move(x + 14 * np.sin(2.9 * now), y + 9 * np.sin(4.7 * now))
        time.sleep(STEP)
        now = time.monotonic() - begin
    found = page.evaluate("() => { window.counting = false; return [window.pictures.size, window.frames]; }")
    page.mouse.up()
    up_to_date(page)
    return found[0] / now, found[1] / now


PARTS = time_labels, time_screens


def main() -> None:
    if "--browser" in sys.argv[1:]:
        for row in drag_points():  # each at once: a browser on a machine that does much else takes its time
            print("  ".join(row), flush=True)
    else:
        show("drawings", *PARTS)


if __name__ == "__main__":
    main()
