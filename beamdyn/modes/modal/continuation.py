"""Continuation of the equilibria of a beam in a parameter, through turning points.

A curve of solutions of r(q, p) = 0 is followed by its arc length, measured by the largest slope angle of the
beam and by the parameter over its scale (Keller's pseudo-arclength method).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from typing import Protocol

import numpy as np

_FIRST, _LONGEST, _SHORTEST = 0.05, 0.2, 1e-7  # arc lengths of a step
_ITERATIONS = 12  # iterations of Newton's method
_EASY = 4  # iterations up to which the next step is longer
_CONVERGED = 1e-14  # change of the slope angles [rad]
_STALLED = 1e-9  # change of the slope angles from which on rounding may end the iteration [rad]
_STRAYED = 0.5  # correction of a step over its length, above which it may have met another curve
_LOOSE = 2.0  # the same where the points on both sides are known to be on one curve
_NEAR = 1e-4  # arc length within which directions of another sign are a bifurcation, and no other curve


class Problem(Protocol):
    """Equations r(q, p) = 0 of coordinates q (n,) and a parameter p."""

    @property
    def angles(self) -> np.ndarray:
        """Slope angles per coordinate (n, k), by which coordinates are measured."""
        ...

    @property
    def scale(self) -> float:
        """Change of the parameter that counts as an angle of 1."""
        ...

    def residual(self, q: np.ndarray, p: float) -> np.ndarray:
        """The residual r (n,)."""
        ...

    def jacobian(self, q: np.ndarray, p: float) -> np.ndarray:
        """The derivative of r by q, shape (n, n)."""
        ...

    def rate(self, q: np.ndarray, p: float) -> np.ndarray:
        """The derivative of r by p, shape (n,)."""
        ...


class NotConverged(ArithmeticError):
    """Newton's method found no solution."""


@dataclass(frozen=True)
class Point:
    """A point of a curve of solutions, with the direction in which it is followed.

    Parameters
    ----------
    q : ndarray, shape (n,)
        Coordinates.
    p : float
        Parameter.
    q_rate : ndarray, shape (n,)
        Change of the coordinates per arc length.
    p_rate : float
        Change of the parameter, over its scale, per arc length.
    """

    q: np.ndarray
    p: float
    q_rate: np.ndarray
    p_rate: float


def solve_at(problem: Problem, q: np.ndarray, p: float) -> np.ndarray:
    """Solve r(q, p) = 0 for q by Newton's method.

    Raises
    ------
    NotConverged
        If it does not converge.
    """
    return _newton(problem, q, p, None)[0]


def start_curve(problem: Problem, q: np.ndarray, p: float, towards: float) -> Point:
    """The point of a curve at a solution, to be followed towards larger (1) or smaller (-1) parameters."""
    q_rate = -np.linalg.solve(problem.jacobian(q, p), problem.rate(q, p)) * problem.scale
    return _normalized(problem, q, p, q_rate, 1.0, towards)


def follow(problem: Problem, start: Point, longest: float = _LONGEST, easy: int = _EASY) -> Iterator[Point]:
    """Yield the points of a curve, beginning after `start`, in steps that follow its curvature.

    Parameters
    ----------
    problem : Problem
        The equations.
    start : Point
        A point of the curve.
    longest : float
        Longest step, by the change of the slope angles, or of the parameter over its size.
    easy : int
        Iterations of Newton's method up to which the next step is longer.

    Raises
    ------
    NotConverged
        If the curve cannot be followed further.
    """
    point, step, before = start, _FIRST, count_negative(problem, start.q, start.p)
    while True:
        try:
            following, iterations = advance(problem, point, step)
            # Stability that changes otherwise than by a turning point is that of another curve.
            stability = count_negative(problem, following.q, following.p)
            if abs(stability - before) != int(following.p_rate * point.p_rate < 0) and step > _NEAR:
                raise NotConverged
        except NotConverged:
            step /= 4
            if step < _SHORTEST:
                raise
            continue
        point, before = following, stability
        yield point
        # The slope angles change by 1, or the parameter by its size, at least by the smaller of arc lengths.
        by_angles, by_parameter = _metric(problem, point.q_rate, 0.0), 1 / (1 + abs(point.p) / problem.scale)
        most = longest * (1 / max(by_angles, by_parameter))
        step = min(most, 1.5 * step) if iterations <= easy else max(step / 2, _SHORTEST)


def count_negative(problem: Problem, q: np.ndarray, p: float) -> int:
    """Number of negative eigenvalues of the symmetric Jacobian at a solution: 0 where it is stable."""
    matrix = problem.jacobian(q, p)
    return int((scaled_eigenvalues(matrix, np.diag(matrix)) < 0).sum())


def scaled_eigenvalues(matrix: np.ndarray, diagonal: np.ndarray) -> np.ndarray:
    """Eigenvalues (n,) of a symmetric matrix in coordinates that make a diagonal one of +-1, from the lowest.

    Their signs are those of the matrix itself (Sylvester), which rounding hides where coordinates are of
    unlike sizes, as those of short elements are.
    """
    size = np.sqrt(np.where(diagonal == 0, 1.0, np.abs(diagonal)))
    return np.linalg.eigvalsh(matrix / np.outer(size, size))


def advance(problem: Problem, point: Point, step: float, strayed: float = _STRAYED) -> tuple[Point, int]:
    """Advance along a curve by an arc length; also the number of iterations that it took.

    A correction larger than the step times `strayed` is refused.
    """
    q, p = point.q + step * point.q_rate, point.p + step * point.p_rate * problem.scale
    corrected, p_corrected, iterations = _newton(problem, q, p, point)
    correction = np.abs((corrected - q) @ problem.angles).max() + abs(p_corrected - p) / problem.scale
    if correction > strayed * abs(step):
        raise NotConverged
    A = _bordered(problem, corrected, p_corrected, point)
    tangent = np.linalg.solve(A, np.append(np.zeros(len(q)), 1.0))
    return _normalized(problem, corrected, p_corrected, tangent[:-1], tangent[-1], None), iterations


def find_turning_point(problem: Problem, before: Point, after: Point) -> Point:
    """Find where the parameter is extreme, between two successive points of a curve."""
    return _find_between(problem, before, after, lambda point: point.p_rate)


def find_at(problem: Problem, before: Point, after: Point, p: float) -> np.ndarray:
    """Find the coordinates at a parameter, between two successive points of a curve."""
    if p in (before.p, after.p):
        return before.q if p == before.p else after.q
    share = (p - before.p) / (after.p - before.p)
    between = before.q + share * (after.q - before.q)
    size = _metric(problem, after.q - before.q, 0.0)
    with suppress(NotConverged):
        q = solve_at(problem, between, p)
        if _metric(problem, q - between, 0.0) < size / 2:
            return q
    point = _find_between(problem, before, after, lambda point: (point.p - p) / problem.scale)
    return solve_at(problem, point.q, p)


def _find_between(problem: Problem, before: Point, after: Point, function: Callable[[Point], float]) -> Point:
    """Find the root of a function between two successive points of a curve, along its arc."""
    from scipy.optimize import brentq  # here, because it takes as long to import as all the rest

    reach = _metric(problem, after.q - before.q, (after.p - before.p) / problem.scale)

    def at(step: float) -> Point:
        return advance(problem, before, step, _LOOSE)[0] if step else before

    while function(at(reach)) * function(before) > 0:
        reach *= 1.1
    return at(float(brentq(lambda step: function(at(step)), 0.0, reach)))


def _newton(problem: Problem, q: np.ndarray, p: float, point: Point | None) -> tuple[np.ndarray, float, int]:
    """Iterate to a solution: at fixed p, or across the direction of a curve that leaves `point`."""
    last = np.inf
    for iteration in range(1, _ITERATIONS + 1):
        r = problem.residual(q, p)
        if point is None:
            change = np.linalg.solve(problem.jacobian(q, p), -r)
        else:
            full = np.linalg.solve(_bordered(problem, q, p, point), np.append(-r, 0.0))
            change, p = full[:-1], p + full[-1] * problem.scale
        q = q + change
        size = float(np.abs(change @ problem.angles).max())
        if size < _CONVERGED or (size < _STALLED and size > last / 4):
            return q, p, iteration
        last = size
    raise NotConverged


def _bordered(problem: Problem, q: np.ndarray, p: float, point: Point) -> np.ndarray:
    """Jacobian by q and p/scale, bordered by the direction of the curve."""
    weights = problem.angles @ (problem.angles.T @ point.q_rate) / problem.angles.shape[1]
    return np.block(
        [
            [problem.jacobian(q, p), problem.rate(q, p)[:, None] * problem.scale],
            [weights[None, :], np.array([[point.p_rate]])],
        ]
    )


def _metric(problem: Problem, q: np.ndarray, p: float) -> float:
    """Arc length of a change: of the root mean square of the angles, and of the scaled parameter."""
    return float(np.sqrt(np.mean((q @ problem.angles) ** 2) + p**2))


def _normalized(
    problem: Problem, q: np.ndarray, p: float, q_rate: np.ndarray, p_rate: float, towards: float | None
) -> Point:
    size = _metric(problem, q_rate, p_rate) * (1.0 if towards is None else np.copysign(1.0, towards * p_rate))
    return Point(q, p, q_rate / size, p_rate / size)
