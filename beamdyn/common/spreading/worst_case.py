"""Worst cases: the smallest and the largest result of all designs within the tolerances.

If a result rises or falls monotonically with each input, both worst cases are at corners of the tolerance
region (each input at an end of its tolerance).  If random designs show that it does not, a search starts at
corners and at the most extreme random designs: it tries steps of each input in both directions, takes the
best one, and halves the steps if none is better (Kolda, Lewis and Torczon, SIAM Review 45 (2003) 385).  It
ends at a design that no step improves, which may be only a local extreme.  Monotonicity is inferred from
pairs of random designs; this is no proof.

In shapes of arrays, d counts inputs, c corners, k results, and n or N designs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np

from beamdyn.common.spreading.tolerances import SpreadInput

RISES, FALLS, BOTH, NEITHER, UNKNOWN = "rises", "falls", "rises and falls", "does not change", "no answer"
_MOST_TURNING = 6  # largest number of inputs for which all combinations of ends are tried
_FIRST_STEP, _LAST_STEP = 0.25, 2.0**-11  # first and last step of a search, in widths of the tolerance
ROUNDING = 1e-12  # relative change of a result below which it counts as unchanged

# A function that returns k results (N, k) of N designs (N, d), not finite where there is none, and their
# absolute errors (N, k), nan if unknown.
Answer = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


def trends_of(random: np.ndarray, error: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Determine how results change with each input, from pairs of random designs that differ only in it.

    Parameters
    ----------
    random : ndarray, shape (2 + d, designs, results)
        Results of the samples A, B, and A with each input in turn from B.
    error : ndarray, shape (2 + d, designs, results)
        Absolute errors of these results.
    first, second : ndarray, shape (designs, d)
        The designs of the samples A and B.

    Returns
    -------
    ndarray of str, shape (d, results)
        "rises", "falls", "rises and falls" or "does not change"; "no answer" if no pair has two results.
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
    """Smallest and largest values of k results.

    Parameters
    ----------
    smallest, largest : ndarray, shape (k,)
        Smallest and largest value of each result [unit of the result]; nan where none was found.
    smallest_error, largest_error : ndarray, shape (k,)
        Absolute errors [unit of the result]: numerical error, plus the distance by which any random design
        lies beyond the value; nan if unknown.
    smallest_at, largest_at : ndarray, shape (k, inputs)
        Inputs of the designs with these values [SI units of the inputs].
    searched : ndarray of bool, shape (k,)
        Whether the values come from a search, so that worse designs may exist; others are at corners of the
        tolerance region.
    cut_short : ndarray of bool, shape (k,)
        Whether the search was stopped at the largest number of designs, before it had converged.
    designs : int
        Number of designs computed at corners and in searches.

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
    """A design, its result, and the absolute error of the result; or arrays of these for several designs."""

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
    """Find the worst cases; a search computes at most as many designs as are known already.

    Parameters
    ----------
    inputs : sequence of SpreadInput
        The d inputs.
    trends : ndarray of str, shape (d, results)
        Trends of the results, as returned by `trends_of`.
    designs, answers : ndarray, shapes (designs, d) and (designs, results)
        Designs with known results; designs outside the tolerances are ignored.
    error : ndarray, shape (designs, results)
        Absolute errors of the results, nan if unknown; a result counts as better only if the difference
        exceeds the errors.
    answer : callable
        Function that computes the results of further designs, and their absolute errors.
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
        (at[rows], value[rows], wrong[rows]), cut[rows], count = _search(
            _Case(at[rows], value[rows], wrong[rows]), rows, (low, high), answer, len(designs)
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
    """Return corners of the tolerance region (rows) at which a result may be smallest or largest.

    `sense` is -1 for the smallest value, and 1 for the largest.
    """
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
    """Yield, for the smallest and the largest value of each result, the best corner and the best design.

    The best design is chosen among the corners and `known`: designs, their results, and errors of these.
    """
    places = np.cumsum([len(part) for part in corners])[:-1]
    values, errors = (np.split(each, places) for each in answer(np.vstack(corners)))
    for end, tried in enumerate(zip(corners, values, errors, strict=True)):
        both = (np.concatenate(pair) for pair in zip(tried, known, strict=True))
        yield _best(tried, end), _best(both, end)


def _best(cases: Iterable[np.ndarray], end: int) -> _Case:
    """Return the design with the smallest or the largest value of a result, among designs (rows).

    The number `end` is 2 i for the smallest value of result i, and 2 i + 1 for the largest.  Results and
    their errors have the shape (designs, results).
    """
    at, answers, errors = cases
    value, error = answers[:, end // 2], errors[:, end // 2]
    rank = np.where(np.isfinite(value), (2 * (end % 2) - 1) * value, -np.inf)
    place = int(rank.argmax())
    there = np.isfinite(rank[place])
    return _Case(at[place], value[place] if there else np.nan, error[place] if there else np.nan)


def _is_beaten(corner: _Case, best: _Case) -> bool:
    """Return whether the best known design is better than the best corner by more than both errors."""
    near = sum(0.0 if np.isnan(each.error) else each.error for each in (corner, best))
    near = near + ROUNDING * np.abs(best.value)
    return bool(np.isfinite(best.value) and not np.abs(best.value - corner.value) <= near)


def _widened(corner: _Case, best: _Case) -> _Case:
    """Increase the error of the best corner by its difference from the best known design."""
    return corner._replace(error=corner.error + np.abs(best.value - corner.value))


def _search(
    start: _Case, rows: np.ndarray, ends: tuple[np.ndarray, np.ndarray], answer: Answer, most: int
) -> tuple[_Case, np.ndarray, int]:
    """Improve each of S designs (S, d) by a search of its own; all searches advance together.

    A search with the number 2 i in `rows` (S,) minimizes result i, one with 2 i + 1 maximizes it.

    Returns
    -------
    cases : _Case
        The best designs, their results (S,) and errors (S,).
    cut : ndarray of bool, shape (S,)
        Whether each search was stopped before it converged.
    count : int
        Number of computed designs, at most `most`.
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
