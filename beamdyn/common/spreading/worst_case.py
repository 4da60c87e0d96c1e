"""Worst cases: the smallest and the largest answer of all designs within the ends of the tolerances.

Where an answer rises or falls with each input throughout, both are at corners.  Where random designs show
that it does not, corners, and the best of the random designs, are where a search begins: it tries steps along
each input, either way, takes the best, and halves the steps where none is better (Kolda, Lewis and Torczon,
SIAM Review 45 (2003) 385).  It ends at a design that no step betters, which need not be the worst of all.
That an answer rises throughout is what pairs of random designs show: it is no proof.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np

from beamdyn.common.spreading.tolerances import SpreadInput

RISES, FALLS, BOTH, NEITHER, UNKNOWN = "rises", "falls", "rises and falls", "does not change", "no answer"
_MOST_TURNING = 6  # largest number of inputs of which all combinations of ends are tried
_FIRST_STEP, _LAST_STEP = 0.25, 2.0**-11  # first and last step of a search, over the width of a tolerance
ROUNDING = 1e-12  # relative change of an answer below which it counts as unchanged

# A function from designs (N, d) to answers (N, k), not finite where there is none, and their absolute errors
# (N, k), nan where none is known.
Answer = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


def trends_of(random: np.ndarray, error: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Decide how answers change with each input, from pairs of random designs that differ in it alone.

    Parameters
    ----------
    random : ndarray, shape (2 + d, n, k)
        Answers of A, of B, and of A with each input of B.
    error : ndarray, shape (2 + d, n, k)
        Their absolute errors.
    first, second : ndarray, shape (n, d)
        The designs A and B.

    Returns
    -------
    ndarray of str, shape (d, k)
        "rises", "falls", "rises and falls" or "does not change"; "no answer" where no pair has one.
    """
    with np.errstate(invalid="ignore"):
        change = random[2:] - random[0]
        rounding = ROUNDING * np.abs(random[0])
        seen = np.abs(change) > error[2:] + error[0] + rounding
        up = np.sign(change) * np.sign((second - first).T)[..., None] > 0
    rises, falls = (seen & up).any(axis=1), (seen & ~up).any(axis=1)
    unknown = ~np.isfinite(change).any(axis=1)
    return np.select([unknown, rises & falls, rises, falls], [UNKNOWN, BOTH, RISES, FALLS], NEITHER)


@dataclass(frozen=True)
class WorstCases:
    """Smallest and largest of k answers.

    Parameters
    ----------
    smallest, largest : ndarray, shape (k,)
        The answers [their units]; nan where none was found.
    smallest_error, largest_error : ndarray, shape (k,)
        Their absolute errors: of the answers of these designs, and by how much any random design lies beyond
        them; nan where none is known.
    smallest_at, largest_at : ndarray, shape (k, d)
        Inputs of their designs [SI units of the inputs].
    searched : ndarray of bool, shape (k,)
        Whether they come from a search, so that there may be worse; others are at corners.
    cut_short : ndarray of bool, shape (k,)
        Whether the search ended, as it took too many designs, before no step was better.
    designs : int
        Number of designs at corners and of the search.

    References
    ----------
    Kolda, Lewis and Torczon (2003), SIAM Review 45, 385.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> found = bd.spread(bd.Scene(strip), {"beam.thickness": "+-2%"}, modes=1, samples=128)
    >>> bool(found.worst.smallest[0] < found.nominal[0] < found.worst.largest[0])
    True
    """

    smallest: np.ndarray
    largest: np.ndarray
    smallest_error: np.ndarray
    largest_error: np.ndarray
    smallest_at: np.ndarray
    largest_at: np.ndarray
    searched: np.ndarray
    cut_short: np.ndarray
    designs: int


class _Case(NamedTuple):
    """A design (d,), its answer, and the answer's absolute error; or S of them."""

    at: np.ndarray
    value: float | np.ndarray
    error: float | np.ndarray


def worst_cases(
    inputs: Sequence[SpreadInput],
    trends: np.ndarray,
    designs: np.ndarray,
    answers: np.ndarray,
    error: np.ndarray,
    answer: Answer,
) -> WorstCases:
    """Find the worst cases; a search takes at most as many designs as have been answered.

    Parameters
    ----------
    inputs : sequence of SpreadInput
        The d inputs.
    trends : ndarray of str, shape (d, k)
        As `trends_of` returns them.
    designs, answers : ndarray, shapes (N, d) and (N, k)
        Designs that have been answered; those beyond the ends are not looked at.
    error : ndarray, shape (N, k)
        Absolute errors of the answers, by which one must be better than another; nan where none is known.
    answer : callable
        Returns the answers of further designs, and their absolute errors.
    """
    low, high = np.array([each.distribution.ends for each in inputs]).T
    nominal, k = np.array([each.nominal for each in inputs]), trends.shape[1]
    corners = [_corners(trends[:, i], sense, low, high, nominal) for i in range(k) for sense in (-1, 1)]
    inside = ((designs >= low) & (designs <= high)).all(axis=1)
    ends = [*_ends(corners, answer, (designs[inside], answers[inside], error[inside]))]
    turning = (trends == BOTH).any(axis=0)
    searched = turning | np.reshape([_is_beaten(*pair) for pair in ends], (k, 2)).any(axis=1)
    cases = [best if searched[i // 2] else _widened(corner, best) for i, (corner, best) in enumerate(ends)]
    at, value, wrong = (np.array(each) for each in zip(*cases, strict=True))
    rows, cut, count = np.flatnonzero(np.repeat(searched, 2) & np.isfinite(value)), np.zeros(2 * k, bool), 0
    if rows.size:
        start = _Case(at[rows], value[rows], wrong[rows])
        (at[rows], value[rows], wrong[rows]), cut[rows], count = _search(
            start, rows, (low, high), answer, len(designs)
        )
    return WorstCases(
        smallest=value[::2],
        largest=value[1::2],
        smallest_error=wrong[::2],
        largest_error=wrong[1::2],
        smallest_at=at[::2],
        largest_at=at[1::2],
        searched=searched,
        cut_short=cut[::2] | cut[1::2],
        designs=sum(map(len, corners)) + count,
    )


def _corners(
    trends: np.ndarray, sense: int, low: np.ndarray, high: np.ndarray, nominal: np.ndarray
) -> np.ndarray:
    """Return corners (c, d) at which an answer may be smallest (sense -1) or largest (sense 1)."""
    rises, falls = trends == RISES, trends == FALLS
    up = rises if sense > 0 else falls
    at = np.where(up, high, np.where(rises | falls, low, nominal))
    turning = np.flatnonzero(trends == BOTH)[:_MOST_TURNING]
    made = np.tile(at, (2 ** len(turning), 1))
    made[:, turning] = [*product(*zip(low[turning], high[turning], strict=True))]
    return made


def _ends(
    corners: Sequence[np.ndarray], answer: Answer, known: tuple[np.ndarray, ...]
) -> Iterator[tuple[_Case, _Case]]:
    """Yield, for the smallest and the largest value of each answer, the corner and the design with it.

    The first is the best of the corners, the second the best of the corners and the known designs.
    """
    places = np.cumsum([len(part) for part in corners])[:-1]
    values, errors = (np.split(each, places) for each in answer(np.vstack(corners)))
    for end, tried in enumerate(zip(corners, values, errors, strict=True)):
        both = (np.concatenate(pair) for pair in zip(tried, known, strict=True))
        yield _best(tried, end), _best(both, end)


def _best(cases: Iterable[np.ndarray], end: int) -> _Case:
    """Return the design with the smallest or largest value of an answer, of designs (n, d).

    The number `end` is 2 i for the smallest, and 2 i + 1 for the largest value of answer i. Answers and their
    errors have the shape (n, k).
    """
    at, answers, errors = cases
    value, error = answers[:, end // 2], errors[:, end // 2]
    rank = np.where(np.isfinite(value), (2 * (end % 2) - 1) * value, -np.inf)
    place = int(rank.argmax())
    there = np.isfinite(rank[place])
    return _Case(at[place], value[place] if there else np.nan, error[place] if there else np.nan)


def _is_beaten(corner: _Case, best: _Case) -> bool:
    """Whether a random design lies beyond the best corner by more than the errors of both."""
    near = sum(0.0 if np.isnan(each.error) else each.error for each in (corner, best))
    near = near + ROUNDING * np.abs(best.value)
    return bool(np.isfinite(best.value) and not np.abs(best.value - corner.value) <= near)


def _widened(corner: _Case, best: _Case) -> _Case:
    """Add to the error of the best corner how far random designs lie beyond it."""
    return corner._replace(error=corner.error + np.abs(best.value - corner.value))


def _search(
    start: _Case, rows: np.ndarray, ends: tuple[np.ndarray, np.ndarray], answer: Answer, most: int
) -> tuple[_Case, np.ndarray, int]:
    """Search S better designs (S, d) at once; row 2 i + 1 is the largest of answer i.

    Returns
    -------
    cases : _Case
        The best designs, their answers (S,) and errors (S,).
    cut : ndarray of bool, shape (S,)
        Which searches have not ended by themselves.
    count : int
        Number of designs that were answered, at most `most`.
    """
    (low, high), d = ends, start.at.shape[1]
    which, sense = rows // 2, np.where(rows % 2, 1.0, -1.0)
    moves = np.vstack([np.eye(d), -np.eye(d)]) * (high - low)
    step, count = np.full(len(rows), _FIRST_STEP), 0
    at, value, error = (np.array(each) for each in start)
    while (going := np.flatnonzero(step >= _LAST_STEP)).size and count + len(going) * 2 * d <= most:
        tried = np.clip(at[going, None] + step[going, None, None] * moves, low, high)
        count += len(going) * 2 * d
        found, wrong = (
            np.take_along_axis(each.reshape(len(going), 2 * d, -1), which[going, None, None], axis=2)[..., 0]
            for each in answer(tried.reshape(-1, d))
        )
        rank = np.where(np.isfinite(found), sense[going, None] * found, -np.inf)
        best = rank.argmax(axis=1)
        better = rank[np.arange(len(going)), best] > sense[going] * value[going]
        at[going[better]] = tried[better, best[better]]
        value[going[better]], error[going[better]] = found[better, best[better]], wrong[better, best[better]]
        step[going[~better]] /= 2
    return _Case(at, value, error), step >= _LAST_STEP, count
