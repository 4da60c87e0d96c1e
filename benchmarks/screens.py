"""Speed of the interactive programs' screens, without their page.  Run: python -m benchmarks.screens

Prints how long each screen takes to answer a change of its form, and to draw the answer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from statistics import median
from time import perf_counter

from beamdyn.app.program import BEAMDYN
from beamdyn.common.app.document_report import drawn
from beamdyn.common.app.open_document import OpenDocument
from beamdyn.common.app.screens import Program
from benchmarks.rows import Row, show
from brakes.app.program import BRAKES

RUNS, BOUND = 9, 100  # how often each is timed; the longest answer that feels immediate [ms]


def time_screens(program: Program) -> Iterator[Row]:
    """Every screen of a program, on the design that it opens with."""
    for document in program.documents:
        work = OpenDocument(document)
        for screen in document.screens:
            time = _time(lambda screen=screen, work=work: work.solve(screen))
            yield f"{screen.name}: answer to a change [ms]", f"{1e3 * time:.1f}", f"{BOUND}"
            answer = work.answered[screen.name].answer
            time = _time(lambda screen=screen, answer=answer: drawn(screen, answer, 1.0))
            yield f"{screen.name}: drawing as SVG [ms]", f"{1e3 * time:.0f}", ""


def _time(action: Callable[[], object]) -> float:
    """Median time of an action [s]; the first run, which fills caches, does not count."""
    action()
    times = []
    for _ in range(RUNS):
        start = perf_counter()
        action()
        times.append(perf_counter() - start)
    return median(times)


def time_brakes() -> Iterator[Row]:
    """Screens of `brakes app`."""
    return time_screens(BRAKES)


def time_beamdyn() -> Iterator[Row]:
    """Screens of `beamdyn app`."""
    return time_screens(BEAMDYN)


PARTS = time_brakes, time_beamdyn


def main() -> None:
    show("interactive programs", *PARTS)


if __name__ == "__main__":
    main()
