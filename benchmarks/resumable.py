"""Files in which long runs store their answers, so that interrupted runs can be resumed.

A file has one answer, or the rows of one table, as JSON, on each line.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar

from beamdyn.common.results.files import write_text
from benchmarks.rows import Row, show

Answer = TypeVar("Answer")


@dataclass(frozen=True)
class Cases(Generic[Answer]):
    """Random cases, identified by their numbers.

    Parameters
    ----------
    measure : callable
        Returns the answers for the case with a number; must be picklable.
    kind : type
        The dataclass that answers are, with the field `number`; its fields are numbers, strings, tuples of
        numbers, and dictionaries of them.
    """

    measure: Callable[[int], Sequence[Answer]]
    kind: type[Answer]

    def measure_all(self, numbers: Iterable[int], workers: int = 2) -> list[Answer]:
        """Measure all cases on several processes."""
        with ProcessPoolExecutor(workers) as pool:
            return [answer for answers in pool.map(self.measure, numbers) for answer in answers]

    def resume(self, path: Path, numbers: Iterable[int], workers: int = 2) -> list[Answer]:
        """Measure the cases that are missing in the file, and add their answers.

        Return all answers that are then in the file.
        """
        numbers, rows = list(numbers), _rows(path)
        path.write_text("".join(f"{json.dumps(row)}\n" for row in rows), encoding="utf-8")
        done = {row["number"] for row in rows}
        with path.open("a", encoding="utf-8") as file, ProcessPoolExecutor(workers) as pool:
            cases = [pool.submit(self.measure, number) for number in numbers if number not in done]
            for answers in (case.result() for case in as_completed(cases)):  # as they complete
                file.write("".join(f"{json.dumps(vars(answer))}\n" for answer in answers))
                file.flush()
        wanted = set(numbers)
        return [answer for answer in self.load(path) if vars(answer)["number"] in wanted]

    def load(self, path: Path) -> list[Answer]:
        """Load the answers from a file; an empty list if there is no such file."""
        return [self.kind(**{name: _frozen(value) for name, value in row.items()}) for row in _rows(path)]

    def run(self, given: argparse.Namespace) -> list[Answer]:
        """Measure the cases that the options of `add_options` request."""
        numbers = range(given.first, given.first + given.scenes)
        if given.save:
            return self.resume(given.save, numbers, given.workers)
        return self.measure_all(numbers, given.workers)


@dataclass(frozen=True)
class SavedRows:
    """Rows of measurements, by the titles of their tables, in a file.

    Parameters
    ----------
    path : Path or None
        The file; None keeps nothing.
    versions : str
        Versions of packages: a file with rows of other versions is refused.
    """

    path: Path | None
    versions: str

    def rows(self, title: str, measure: Callable[[str], list[Row]]) -> list[Row]:
        """Return the rows of a table: from the file, or from `measure`, whose rows are added to it."""
        if self.path is None:
            return measure(title)
        saved = _rows(self.path)
        if others := {each["versions"] for each in saved} - {self.versions}:
            raise ValueError(f"{self.path} is of {others.pop()}, not of {self.versions}: name a new file")
        for each in saved:
            if each["title"] == title:
                return [(what, measured, bound) for what, measured, bound in each["rows"]]
        found = measure(title)
        saved.append({"versions": self.versions, "title": title, "rows": found})
        write_text(self.path, "".join(f"{json.dumps(row)}\n" for row in saved))
        return found


def add_options(parser: argparse.ArgumentParser, scenes: int, seed: int) -> None:
    """Add the options of a run to a command, with the number of its cases and its seed."""
    parser.add_argument("--scenes", type=int, default=scenes)
    parser.add_argument("--first", type=int, default=0, help="number of the first case, to go on in parts")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--seed", type=int, default=seed)
    parser.add_argument("--save", type=Path, help="file of answers, to which a run adds what it lacks")


def measure_random(
    about: str | None,
    title: str,
    cases: Callable[[int], Cases[Answer]],
    summarize: Callable[[list[Answer]], Iterator[Row]],
    scenes: int,
    seed: int,
) -> None:
    """Read the options of a run from the command line, measure its random cases, and print the summary."""
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_options(parser, scenes, seed)
    given = parser.parse_args()
    found = cases(given.seed).run(given)
    show(title, lambda: summarize(found))


def _rows(path: Path) -> list[dict[str, Any]]:
    """Read the lines of a file, without an incomplete last line."""
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    return [json.loads(line) for line in text[: text.rfind("\n") + 1].splitlines()]


def _frozen(value: Any) -> Any:
    return tuple(value) if isinstance(value, list) else value
