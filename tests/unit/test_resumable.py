"""Runs of random cases that go on where they stopped."""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from benchmarks.resumable import Cases, SavedRows, add_options


@dataclass(frozen=True)
class Found:
    number: int
    what: str
    values: tuple[float, ...] = ()
    by_name: dict[str, float] = field(default_factory=dict)


def measure(number: int, log: Path) -> list[Found]:
    """Two answers for a case, which notes in a file that it was measured."""
    with log.open("a") as file:
        file.write(f"{number}\n")
    return [
        Found(number, "first", (0.1 * number, math.inf), {"a": 1e-300}),
        Found(number, "second", (math.nan,)),
    ]


def test_a_run_measures_what_its_file_lacks_and_keeps_every_bit(tmp_path: Path) -> None:
    path, log = tmp_path / "answers.jsonl", tmp_path / "log"
    cases = Cases(partial(measure, log=log), Found)
    first = cases.resume(path, [3], workers=1)
    both = cases.resume(path, [1, 3, 7], workers=1)
    assert sorted(log.read_text().split()) == ["1", "3", "7"]
    assert {(a.number, a.what) for a in both} == {
        (n, what) for n in (1, 3, 7) for what in ("first", "second")
    }
    assert both[0] == first[0] == Found(3, "first", (0.1 * 3, math.inf), {"a": 1e-300})
    assert np.isnan(both[1].values).all()
    assert len(path.read_text().splitlines()) == 6


def test_the_options_of_a_run(tmp_path: Path) -> None:
    parser = argparse.ArgumentParser()
    add_options(parser, scenes=3, seed=5)
    cases = Cases(partial(measure, log=tmp_path / "log"), Found)
    given = parser.parse_args(["--first", "4", "--workers", "1"])
    assert (given.seed, given.save) == (5, None)
    assert [a.number for a in cases.run(given)] == [4, 4, 5, 5, 6, 6]
    saved = tmp_path / "a"
    kept = cases.run(parser.parse_args(["--scenes", "1", "--workers", "1", "--save", str(saved)]))
    assert [a.number for a in kept] == [0, 0]
    assert len(cases.load(saved)) == 2


def test_rows_are_measured_once(tmp_path: Path) -> None:
    asked: list[str] = []

    def measure_rows(title: str) -> list[tuple[str, str, str]]:
        asked.append(title)
        return [(f"{title}: time [s]", "1.0", "µs | -")]

    path = tmp_path / "rows.jsonl"
    first = SavedRows(path, "numpy 2").rows("one", measure_rows)
    again = SavedRows(path, "numpy 2")
    assert again.rows("two", measure_rows) != again.rows("one", measure_rows) == first
    assert asked == ["one", "two"]
    with pytest.raises(ValueError, match=r"is of numpy 2, not of numpy 3: name a new file"):
        SavedRows(path, "numpy 3").rows("one", measure_rows)
    SavedRows(None, "numpy 2").rows("one", measure_rows)
    assert asked == ["one", "two", "one"]
