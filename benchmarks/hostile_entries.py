"""Hostile entries in each field of the interactive programs: their answers, and whether they keep running.

Run: python -m benchmarks.hostile_entries [--program brakes|beamdyn] [--entries 50] [--seed 1]

First each entry is made alone, on the initial design of its screen, in the processes that compute answers.
Then all entries are made in one browser tab, as fast as possible, while another tab is used.
"""

from __future__ import annotations

import argparse
import asyncio
import random
import resource
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from beamdyn.app.program import BEAMDYN
from beamdyn.cli.commands import make_program as make_beamdyn
from beamdyn.common.edge.inputs import Input
from beamdyn.common.screens import page_tasks
from beamdyn.common.screens.open_document import OpenDocument, ShownAnswer
from beamdyn.common.screens.page_tasks import outcome_of
from beamdyn.common.screens.processes import Processes
from beamdyn.common.screens.screens import Document, Program, Screen
from benchmarks.rows import Row, show
from benchmarks.served import browser, free_port, go, open_page, start, stop
from brakes.app.program import BRAKES
from brakes.cli.commands import make_program as make_brakes

MAKERS: dict[str, Callable[[], Program]] = {"brakes": make_brakes, "beamdyn": make_beamdyn}
OTHER = {"brakes": ("Drum brake", "shoe.force_arm"), "beamdyn": ("Frequencies", "mount.radius")}
_PAUSE = 0.02  # time between two entries of the hostile tab [s]
_NUMBERS = ("1e300", "-1e300", "1e-300", "1e9", "-1", "0", "-0.0", "1e999", "nan", "-inf", "1,5", "9" * 400)
_TEXTS = (
    *("", " ", "-", "text", "[", "[" * 5000, "{}", "[]", '""', '"', "true", "1979-05-27", "NaN m", "inf"),
    *("<script>alert(1)</script>", "../../../etc/passwd", "__import__('os')", "9**9**9 m", "1e9 m2 m2 m2"),
    *('["1e300 m", "nan m"]', "[1e300, 1e300]", "[[1, 1e300], [2, nan]]", "m" * 3000, "\u202e\x07\ud7ff"),
)


def hostile_texts(entry: Input, count: int, seed: int) -> list[str]:
    """Return absurd entries for one field, in an order that follows from the seed.

    Parameters
    ----------
    entry : Input
        The field's input, whose unit some of the texts have.
    count : int
        Number of texts.
    seed : int
        Seed of the random texts.
    """
    chance, unit = random.Random(f"{seed} {entry.path}"), entry.quantity.unit
    known = [*_NUMBERS, *(f"{number} {unit}".strip() for number in _NUMBERS), *_TEXTS]
    known = list(dict.fromkeys(known))
    chance.shuffle(known)
    some = (
        f"{chance.choice('+-')}{10 ** chance.uniform(-300, 300):.3g} {unit}".strip() for _ in range(count)
    )
    return [*known, *some][:count]


# Each alone -----------------------------------------------------------------------------------------------


@dataclass
class Found:
    """Outcomes of the entries of a program."""

    kinds: Counter[str] = field(default_factory=Counter)
    unknown: dict[str, str] = field(default_factory=dict)
    slow: list[tuple[float, str]] = field(default_factory=list)
    memory: float = 0.0

    def add(self, where: str, path: str, outcome: page_tasks.Outcome, seconds: float) -> None:
        """Add an outcome to the counts."""
        self.slow = sorted([*self.slow, (seconds, where)], reverse=True)[:3]
        if isinstance(outcome, ShownAnswer):
            self.kinds["answered"] += 1
            return
        said = " ".join(sentence for sentences in outcome.values() for sentence in sentences)
        if "the program does not know" in said:
            self.unknown[where] = said
        given_up = "Given up" in said
        at_field = any(path.startswith(place) and place for place in outcome)
        self.kinds["given up" if given_up else "refused" if at_field else "refused elsewhere"] += 1


async def _alone(name: str, program: Program, count: int, seed: int) -> Found:
    found, processes = Found(), Processes(MAKERS[name])
    room = asyncio.Semaphore(processes.most)
    try:
        await _warm(processes, program)
        async with asyncio.TaskGroup() as group:
            for document, screen, entry, text in _cases(program, count, seed):
                await room.acquire()
                group.create_task(_one(processes, found, (document, screen, entry, text), room))
    finally:
        await processes.close()
    return found


async def _warm(processes: Processes, program: Program) -> None:
    """Wait until all worker processes are ready, so that no answer's time includes their start."""
    document = program.documents[0]
    waits = [
        processes.submit(page_tasks.solve, document, document.screens[0], document.base_entries)
        for _ in range(2 * processes.most)
    ]
    await asyncio.wait(waits)


def _cases(program: Program, count: int, seed: int) -> Iterator[tuple[Document, Screen, Input, str]]:
    for document in program.documents:
        inputs = document.inputs(document.base_entries)
        for screen in document.screens:
            for entry in inputs:
                if entry.path.partition(".")[0] in screen.needs:
                    for text in hostile_texts(entry, count, seed):
                        yield document, screen, entry, text


async def _one(processes: Processes, found: Found, case: Any, room: asyncio.Semaphore) -> None:
    document, screen, entry, text = case
    work = OpenDocument(document)
    work.put(entry.path, text)
    begin = time.perf_counter()
    future = processes.submit(page_tasks.solve, document, screen, work.entries)
    await asyncio.wait([future])
    found.memory = max(found.memory, memory_of(processes.ids))
    where = f"{screen.name}, {entry.path} = {text[:30]!r}"
    found.add(where, entry.path, outcome_of(future, work, screen), time.perf_counter() - begin)
    room.release()


def memory_of(ids: Iterable[int]) -> float:
    """Return the memory of processes [MB], from /proc; ended processes count as 0."""
    pages = 0
    for process in ids:
        with suppress(OSError):
            pages += int(Path(f"/proc/{process}/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 1e6


def children_of(process: int) -> list[int]:
    """List the running child processes of a process."""
    try:
        return [int(child) for child in Path(f"/proc/{process}/task/{process}/children").read_text().split()]
    except OSError:
        return []


def each_alone(program: Program, count: int, seed: int) -> Iterator[Row]:
    """Yield the outcomes of absurd entries in each field, made one at a time."""
    found = asyncio.run(_alone(program.name, program, count, seed))
    yield "entries solved one by one", str(found.kinds.total()), ""
    for kind, number in found.kinds.most_common():
        yield f"... {kind}", str(number), ""
    yield "errors that the program does not know", str(len(found.unknown)), "0"
    for where, said in [*found.unknown.items()][:10]:
        yield where, said, ""
    for seconds, where in found.slow:
        yield f"longest: {where}", f"{seconds:.1f} s", ""
    yield "memory of the processes", f"{found.memory:.0f} MB", "1000 MB"


# In a tab beside another ------------------------------------------------------------------------------------

# Script: types texts into fields, visible or folded, with a pause after each.
ENTER = """async ([entries, pause]) => {
  for (const [path, text] of entries) {
    for (const field of document.querySelectorAll(`[data-path="${path}"]`)) {
      const box = field.querySelector("input, textarea") || field;
      if (!("value" in box)) continue;
      Object.getOwnPropertyDescriptor(Object.getPrototypeOf(box), "value").set.call(box, text);
      box.dispatchEvent(new Event("input", {bubbles: true}));
    }
    await new Promise((done) => setTimeout(done, pause));
  }
}"""
_BEGIN = """([enter, given]) => {
  window.sent = false;
  eval(enter)(given).finally(() => { window.sent = true; });
}"""
# Script: times from an entry until the visible screen changes its text, and until it is solved [ms].
_ANSWER = """async ([path, text, patience]) => {
  const status = [...document.querySelectorAll(".status[role=status]")].find((e) => e.checkVisibility());
  const board = [...document.querySelectorAll(".board, .charts")].find(
    (e) => e.getBoundingClientRect().height > 50);
  const was = board.dataset.picture, begin = performance.now();
  const box = [...document.querySelectorAll(`[data-path="${path}"]`)].map(
    (e) => e.querySelector("input") || e).find((e) => e.checkVisibility());
  let reacted = null;
  const watch = new MutationObserver(() => { reacted ??= performance.now() - begin; });
  watch.observe(status, {childList: true, characterData: true, subtree: true});
  Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value").set.call(box, text);
  box.dispatchEvent(new Event("input", {bubbles: true}));
  while (board.dataset.picture === was && performance.now() - begin < patience)
    await new Promise((done) => setTimeout(done, 5));
  watch.disconnect();
  return [reacted, performance.now() - begin];
}"""
_TYPING = 100.0  # delay of a field until it accepts typed text [ms]


class Memory(threading.Thread):
    """A thread that monitors the memory of a process and of its child processes."""

    def __init__(self, process: int) -> None:
        super().__init__(daemon=True)
        self.most, self._root, self._on = 0.0, process, True

    def run(self) -> None:
        """Monitor the memory until `stop` is called."""
        while self._on:
            self.most = max(self.most, memory_of([self._root, *children_of(self._root)]))
            time.sleep(0.2)

    def stop(self) -> None:
        """Stop monitoring the memory."""
        self._on = False
        self.join()


def beside_another_tab(program: Program, count: int, seed: int) -> Iterator[Row]:
    """Measure the response times of one tab while another tab sends the entries of all fields."""
    process = start(port := free_port(), program.name)
    memory = Memory(process.pid)
    memory.start()
    children: list[int] = []
    try:
        with browser() as made:
            hostile, other = (open_page(made.new_context(), port) for _ in range(2))
            # No number occurs twice, so that each one is a change of the field.
            numbers = (f"0.{digits} m" for digits in range(1100, 1_000_000))
            times = [
                time
                for screen in _screens(program)
                for time in _beside(hostile, other, program, screen, _entries(screen, count, seed), numbers)
            ]
        children = children_of(process.pid)
    finally:
        memory.stop()
        ended = stop(process)
    reacted, solved = (sorted(column) for column in zip(*times, strict=True))
    half = len(reacted) // 2
    yield "another tab reacts: median, longest", f"{reacted[half]:.0f}, {reacted[-1]:.0f} ms", "500 ms"
    yield "... and is solved and painted", f"{solved[half]:.0f}, {solved[-1]:.0f} ms", ""
    yield "memory of all processes", f"{memory.most:.0f} MB", "1000 MB"
    yield "SIGTERM ends it within", f"{ended:.1f} s", "5 s"
    yield "processes left", str(sum(Path(f"/proc/{child}").exists() for child in children)), "0"


def _screens(program: Program) -> list[tuple[Document, Screen]]:
    return [(document, screen) for document in program.documents for screen in document.screens]


def _entries(place: tuple[Document, Screen], count: int, seed: int) -> list[tuple[str, str]]:
    """Return paths and texts for all fields of a screen, in an order that follows from the seed."""
    document, screen = place
    entries = [
        (entry.path, text)
        for entry in document.inputs(document.base_entries)
        if entry.path.partition(".")[0] in screen.sections or "." not in entry.path
        for text in hostile_texts(entry, count, seed)
    ]
    random.Random(seed).shuffle(entries)
    return entries


def _beside(
    hostile: Any,
    other: Any,
    program: Program,
    place: tuple[Document, Screen],
    entries: list[tuple[str, str]],
    numbers: Iterator[str],
) -> Iterator[tuple[float, float]]:
    """Yield times of the other tab [ms] while entries are typed into all fields of one screen."""
    name, path = OTHER[program.name]
    hostile.reload()
    hostile.wait_for_function("window.did_handshake")
    hostile.get_by_role("tab", name=place[1].name).first.click()
    go(other, name)
    hostile.evaluate(_BEGIN, [ENTER, [entries, 1e3 * _PAUSE]])
    while not hostile.evaluate("window.sent"):
        reacted, solved = other.evaluate(_ANSWER, [path, next(numbers), 60_000])
        yield (reacted or solved) - _TYPING, solved - _TYPING
        time.sleep(0.1)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--program", choices=MAKERS)
    parser.add_argument("--entries", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    for program in (BRAKES, BEAMDYN):
        if given.program in (None, program.name):
            args = program, given.entries, given.seed
            show(f"{program.name}: each alone", lambda args=args: each_alone(*args))
            show(f"{program.name}: in a tab beside another", lambda args=args: beside_another_tab(*args))


if __name__ == "__main__":
    main()
