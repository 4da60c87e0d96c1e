"""Answers of many designs as arrays, put together from parts that end in any order."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from beamdyn.common.results.statements import after

REFUSED = "refused"  # status of a design without an answer
NO_ANSWERS = (
    *(REFUSED, "failed", "not found", "divergence", "flutter"),
    *("parametric instability", "past the critical speed", "turns freely about the root"),
)  # states of numbers that are no answer


@dataclass(frozen=True)
class Caution:
    """What limits the answers of some designs, said for the worst of them.

    Parameters
    ----------
    kind : str
        Subject: cautions of one kind are put together.
    count : int
        Number of designs.
    weight : float
        How bad the worst is.
    said : str
        What is said of it, after the number of designs; a statement where programs may ask for its kind.
    """

    kind: str
    count: int
    weight: float
    said: str


@dataclass(frozen=True)
class DesignAnswers:
    """Answers of R designs at S speeds each, k numbers a design.

    Parameters
    ----------
    value, error : ndarray, shape (R, S, k)
        Answers, nan where there is none, and their estimated relative errors.
    status : ndarray of str, shape (R, S, k)
        States.
    cautions : tuple of Caution
        Limits of the answers.
    method : str
        How they were found.
    """

    value: np.ndarray
    error: np.ndarray
    status: np.ndarray
    cautions: tuple[Caution, ...]
    method: str


Place = tuple[slice, slice]  # designs and speeds of a part


@dataclass
class AnswerArrays:
    """Answers of all N designs at S speeds each; `put` takes them part by part.

    Parameters
    ----------
    shape : tuple of int
        N, S and k.

    Attributes
    ----------
    value, error : ndarray, shape (N, S, k)
        As of `DesignAnswers`.
    """

    shape: tuple[int, int, int]
    _words: dict[str, int] = field(default_factory=dict)
    _cautions: dict[str, list[tuple[int, int, Caution]]] = field(default_factory=dict)
    _counts: dict[str, int] = field(default_factory=dict)
    _methods: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.value, self.error = np.full(self.shape, np.nan), np.full(self.shape, np.inf)
        self._codes = np.zeros(self.shape, dtype=np.uint8)  # of states: text takes forty times the memory

    def put(self, place: Place, part: DesignAnswers) -> None:
        """Take the answers of a part."""
        self.value[place], self.error[place] = part.value, part.error
        words, codes = np.unique(part.status, return_inverse=True)
        numbers = np.array([self._words.setdefault(word, len(self._words)) for word in words.tolist()])
        self._codes[place] = numbers[codes.reshape(part.status.shape)]
        self._methods[part.method] = (
            self._methods.get(part.method, 0) + part.value.shape[0] * part.value.shape[1]
        )
        for caution in part.cautions:
            # Add up cautions of one kind; keep the worst, and of equal ones the first.
            noted = self._cautions.setdefault(caution.kind, [])
            noted.append((place[0].start, place[1].start, caution))
            worst = min(noted, key=lambda each: (-each[2].weight, *each[:2]))
            self._cautions[caution.kind] = [worst]
            self._counts[caution.kind] = self._counts.get(caution.kind, 0) + caution.count

    @property
    def status(self) -> np.ndarray:
        """States (N, S, k)."""
        return np.array([*self._words] or [""])[self._codes]

    def count(self, word: str) -> int:
        """Number of answers of a state."""
        return int((self._codes == self._words[word]).sum()) if word in self._words else 0

    @property
    def method(self) -> str:
        """How the answers were found; of several ways that of most of them first."""
        return "; ".join(sorted(self._methods, key=lambda method: (-self._methods[method], method)))

    def warnings(self) -> Iterator[str]:
        """Yield a sentence for each kind of caution: of how many designs it is, and of the worst."""
        total = self.shape[0] * self.shape[1]
        for kind in sorted(self._cautions):
            yield after(f"at {self._counts[kind]} of {total} designs", self._cautions[kind][0][2].said)


def caution_where(which: Any, kind: str, size: np.ndarray | float, said: str) -> Iterable[Caution]:
    """A caution of the designs of a selection (R, S), if there are any; its weight is the largest size."""
    if which.any():
        yield Caution(kind, int(which.sum()), float(np.max(np.broadcast_to(size, which.shape)[which])), said)
