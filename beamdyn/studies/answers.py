"""Results (answers) of many designs as arrays, assembled from parts that are computed in any order."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from beamdyn.common.results.statements import after

REFUSED = "refused"  # status of a design whose computation failed or raised an error
NO_ANSWERS = (
    *(REFUSED, "failed", "not found", "divergence", "flutter"),
    *("parametric instability", "past the critical speed", "turns freely about the root"),
)  # statuses of designs without a result


@dataclass(frozen=True)
class Caution:
    """Warning about the results of some designs, formulated for the worst of them.

    Parameters
    ----------
    kind : str
        Key of the subject, such as "a", by which warnings are sorted; those with the same key are merged.
    count : int
        Number of pairs of a design and a speed that the warning concerns.
    weight : float
        Severity, by which the worst of the warnings of one kind is chosen.
    said : str
        Text about the worst design, which follows the number of designs in the shown sentence.  It is a
        `Statement`, a subclass of str, if programs are to read the kind of the warning from it.
    """

    kind: str
    count: int
    weight: float
    said: str


@dataclass(frozen=True)
class DesignAnswers:
    """Results of R designs at S speeds each, with k numbers per result.

    Parameters
    ----------
    value, error : ndarray, shape (R, S, k)
        Results, nan where there is none, and their estimated relative errors.
    status : ndarray of str, shape (R, S, k)
        Status of each result.
    cautions : tuple of Caution
        Warnings about the results.
    method : str
        Method of computation.
    """

    value: np.ndarray
    error: np.ndarray
    status: np.ndarray
    cautions: tuple[Caution, ...]
    method: str


Place = tuple[slice, slice]  # rows (designs) and columns (speeds) that a part of the results fills


@dataclass
class AnswerArrays:
    """Results of all N designs at S speeds each; `put` stores them part by part.

    Parameters
    ----------
    shape : tuple of int
        N, S and k.

    Attributes
    ----------
    value, error : ndarray, shape (N, S, results)
        Results and their estimated relative errors, as in `DesignAnswers`.
    """

    shape: tuple[int, int, int]
    _words: dict[str, int] = field(default_factory=dict)
    _cautions: dict[str, list[tuple[int, int, Caution]]] = field(default_factory=dict)
    _counts: dict[str, int] = field(default_factory=dict)
    _methods: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.value, self.error = np.full(self.shape, np.nan), np.full(self.shape, np.inf)
        # Index of each result's status: the text itself would take forty times the memory.
        self._codes = np.zeros(self.shape, dtype=np.uint8)

    def put(self, place: Place, part: DesignAnswers) -> None:
        """Store one part of the results at its rows and columns in the arrays."""
        self.value[place], self.error[place] = part.value, part.error
        words, codes = np.unique(part.status, return_inverse=True)
        numbers = np.array([self._words.setdefault(word, len(self._words)) for word in words.tolist()])
        self._codes[place] = numbers[codes.reshape(part.status.shape)]
        self._methods[part.method] = (
            self._methods.get(part.method, 0) + part.value.shape[0] * part.value.shape[1]
        )
        for caution in part.cautions:
            # Warnings of one kind are counted together; only the worst is kept, or the first of equally bad
            # ones.
            noted = self._cautions.setdefault(caution.kind, [])
            noted.append((place[0].start, place[1].start, caution))
            self._cautions[caution.kind] = [min(noted, key=lambda each: (-each[2].weight, *each[:2]))]
            self._counts[caution.kind] = self._counts.get(caution.kind, 0) + caution.count

    @property
    def status(self) -> np.ndarray:
        """Statuses of k results of N designs at S speeds, as text: shape (N, S, k)."""
        return np.array([*self._words] or [""])[self._codes]

    def count(self, word: str) -> int:
        """Return the number of results that have a given status."""
        return int((self._codes == self._words[word]).sum()) if word in self._words else 0

    @property
    def method(self) -> str:
        """Methods of computation, separated by semicolons, the most frequent first."""
        return "; ".join(sorted(self._methods, key=lambda method: (-self._methods[method], method)))

    def warnings(self) -> Iterator[str]:
        """Yield a sentence for each kind of warning, with the number of designs and the worst of them."""
        total = self.shape[0] * self.shape[1]
        for kind in sorted(self._cautions):
            yield after(f"at {self._counts[kind]} of {total} designs", self._cautions[kind][0][2].said)


def caution_where(which: Any, kind: str, size: np.ndarray | float, said: str) -> Iterable[Caution]:
    """Yield a warning about the selected designs and speeds; its weight is the largest `size` among them.

    Nothing is yielded if no design is selected.
    """
    if which.any():
        yield Caution(kind, int(which.sum()), float(np.max(np.broadcast_to(size, which.shape)[which])), said)
