"""Inverse design questions with known answers: are they found, or proven to have none?

Run: python -m benchmarks.design            (three minutes)
"""

from __future__ import annotations

from collections.abc import Iterator

from benchmarks.cases.wanted_designs import Wanted, questions
from benchmarks.rows import Row, show

_FOUND = 1e-6  # largest relative error of the numbers, or of the best answer
_MOST = 60  # largest number of solutions of the equations


def ask() -> Iterator[Row]:
    """Yield the number of questions answered correctly, and the number of solutions of equations."""
    asked = [*questions()]
    answers = [each.found() for each in asked]
    right = [error <= _FOUND for error, _ in answers]
    yield f"{len(asked)} questions with a known answer: right", str(sum(right)), str(len(asked))
    there = [error for (error, _), each in zip(answers, asked, strict=True) if not _has_none(each)]
    yield "... largest relative error of those with a design", f"{max(there):.1e}", f"{_FOUND:g}"
    none = [good for good, each in zip(right, asked, strict=True) if _has_none(each)]
    yield "... without a design: proven", str(sum(none)), str(len(none))
    solves = [count for _, count in answers]
    yield "... most solves, and in the mean", f"{max(solves)}, {sum(solves) / len(solves):.0f}", str(_MOST)
    for each, (error, count), good in zip(asked, answers, right, strict=True):
        if not good:
            yield f"missed: {each.name}", f"{error:.1e}, {count} solves", f"{_FOUND:g}"


def _has_none(question: Wanted) -> bool:
    return question.values is None and question.best is None


if __name__ == "__main__":
    show("Designs sought backwards", ask)
