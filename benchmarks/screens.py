"""Speed of the interactive programs' screens, without a browser.  Run: python -m benchmarks.screens

Prints the times in which each screen answers a change of its form and draws the answer to a file, and the
number of positions per second that one process solves and prepares for the page while a point or slider is
dragged.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from statistics import median
from time import perf_counter, process_time
from typing import Any

from beamdyn.app.program import BEAMDYN
from beamdyn.common.screens import page_tasks
from beamdyn.common.screens.chart_options import options_of
from beamdyn.common.screens.form_entries import Entries
from beamdyn.common.screens.handles import draw_sheet
from beamdyn.common.screens.open_document import OpenDocument, ShownAnswer
from beamdyn.common.screens.page_tasks import drawn
from beamdyn.common.screens.screens import Document, Program, Screen
from benchmarks.rows import Row, show
from brakes.app.program import BRAKES

RUNS, BOUND = 9, 100  # number of repetitions; longest time of an answer that feels immediate [ms]
POSITIONS = 20  # number of positions per second that appear as fluent motion


def time_screens(program: Program) -> Iterator[Row]:
    """Measure the times of every screen of a program, on the screen's initial design."""
    for document in program.documents:
        work = OpenDocument(document)
        for screen in document.screens:
            time = _time(lambda screen=screen, work=work: work.solve(screen))
            yield f"{screen.name}: answer to a change [ms]", f"{1e3 * time:.1f}", f"{BOUND}"
            answer = work.answered[screen.name].answer
            time = _time(lambda screen=screen, answer=answer: drawn(screen, answer, 1.0))
            yield f"{screen.name}: drawing as SVG [ms]", f"{1e3 * time:.0f}", ""
            if screen.drags or screen.handles(answer, screen.last):
                yield _positions(document, screen, work.entries)


def _positions(document: Document, screen: Screen, entries: Entries) -> Row:
    """Measure how many positions a second one process solves and prepares for the page."""
    times = []
    for _ in range(RUNS):
        start = process_time()
        found = page_tasks.solve_for_drawing(document, screen, entries)
        assert isinstance(found, ShownAnswer)
        _show(screen, found.answer)
        times.append(process_time() - start)
    # Only screens with a coarser solution while something is dragged have a bound.
    bound = f"{POSITIONS}" if screen.coarser({}) else ""
    return f"{screen.name}: positions a second while dragging", f"{1 / min(times):.0f}", bound


def _show(screen: Screen, answer: Any) -> None:
    """Prepare the parts of an answer that are sent to the page."""
    draw_sheet(screen, answer, screen.last)
    for chart in screen.charts(answer, screen.last) if screen.charts else ():
        json.dumps(options_of(chart))


def _time(action: Callable[[], object]) -> float:
    """Measure the median time of an action [s]; the first run, which fills caches, does not count."""
    action()
    times = []
    for _ in range(RUNS):
        start = perf_counter()
        action()
        times.append(perf_counter() - start)
    return median(times)


def time_brakes() -> Iterator[Row]:
    """Time the screens of `brakes app`."""
    return time_screens(BRAKES)


def time_beamdyn() -> Iterator[Row]:
    """Time the screens of `beamdyn app`."""
    return time_screens(BEAMDYN)


PARTS = time_brakes, time_beamdyn


if __name__ == "__main__":
    show("interactive programs", *PARTS)
