"""Continuation of the equilibria of a beam in a parameter, through turning points.

A curve of solutions of r(q, p) = 0 is followed by its arc length, measured by the slope angles of the beam
and by the parameter over its scale (Keller's pseudo-arclength method).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from typing import Protocol

import numpy as np

# First, longest and shortest step along a curve, as an arc length (see `_metric`).
_FIRST, _LONGEST, _SHORTEST = 0.05, 0.2, 1e-7
_ITERATIONS = 12  # largest number of iterations of Newton's method in a step
_EASY = 4  # number of iterations of a step up to which the next step is longer
# Change of the slope angles by an iteration, below which the iteration has converged [rad].
_CONVERGED = 1e-14
# Change of the slope angles by an iteration, below which rounding may end the iteration [rad].
_STALLED = 1e-9
_STRAYED = 0.5  # correction of a step over its length, above which the step may have met another curve
_LOOSE = 2.0  # largest correction of a step over its length where both sides are known to be on one curve
_SYMMETRIC = 1e-9  # relative skew-symmetric part of a matrix that counts as rounding
_NEAR = 1e-4  # step within which a change of stability is taken for a bifurcation, not for another curve


class Problem(Protocol):
    """Equations r(q, p) = 0 of coordinates q (n,) and a parameter p."""

    @property
    def angles(self) -> np.ndarray:
        """Slope angles per coordinate (n, k), the measure of changes of the coordinates."""
        ...

    @property
    def scale(self) -> float:
        """Change of the parameter that counts as much as an angle of 1 rad."""
        ...

    def residual(self, q: np.ndarray, p: float) -> np.ndarray:
        """Compute the residual r (n,) at coordinates q (n,) and a parameter p."""
        ...

    def jacobian(self, q: np.ndarray, p: float) -> np.ndarray:
        """Compute the derivative of r by q, shape (n, n)."""
        ...

    def rate(self, q: np.ndarray, p: float) -> np.ndarray:
        """Compute the derivative of r by p, shape (n,)."""
        ...


class NotConverged(ArithmeticError):
    """Raised when Newton's method finds no solution."""


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
    """Find the direction of a curve at a solution, towards larger (1) or smaller (-1) parameters."""
    q_rate = -np.linalg.solve(problem.jacobian(q, p), problem.rate(q, p)) * problem.scale
    return _normalized(problem, q, p, q_rate, 1.0, towards)


def follow(problem: Problem, start: Point, longest: float = _LONGEST, easy: int = _EASY) -> Iterator[Point]:
    """Yield the points of a curve beyond `start`, in steps adapted to its curvature.

    Parameters
    ----------
    problem : Problem
        The equations.
    start : Point
        A point of the curve.
    longest : float
        Longest step, as a change of the slope angles, or of the parameter over its size.
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
            # If stability changes other than at a turning point, the point is on another curve.
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
        # `longest` times the arc length in which the slope angles change by 1, or the parameter by its size.
        by_angles, by_parameter = _metric(problem, point.q_rate, 0.0), 1 / (1 + abs(point.p) / problem.scale)
        most = longest * (1 / max(by_angles, by_parameter))
        step = min(most, 1.5 * step) if iterations <= easy else max(step / 2, _SHORTEST)


def count_negative(problem: Problem, q: np.ndarray, p: float) -> int:
    """Count the negative eigenvalues of the Jacobian at a solution: 0 where it is stable, if symmetric."""
    matrix = problem.jacobian(q, p)
    return int((scaled_eigenvalues(matrix, np.diag(matrix)) < 0).sum())


def scaled_eigenvalues(matrix: np.ndarray, diagonal: np.ndarray) -> np.ndarray:
    """Compute the eigenvalues of a matrix (n, n) scaled so that a given diagonal is +-1, the lowest first.

    Their signs are those of the unscaled eigenvalues (Sylvester), which rounding hides where coordinates have
    unlike sizes, as with short elements.  Of a matrix that is not symmetric, as under a load without
    potential, only the real eigenvalues are returned: complex pairs do not change the determinant's sign.
    """
    size = np.sqrt(np.where(diagonal == 0, 1.0, np.abs(diagonal)))
    scaled = matrix / np.outer(size, size)
    if np.abs(scaled - scaled.T).max() < _SYMMETRIC * np.abs(scaled).max():
        return np.linalg.eigvalsh(scaled)
    values = np.linalg.eigvals(scaled)
    return np.sort(values.real[values.imag == 0])


def advance(problem: Problem, point: Point, step: float, strayed: float = _STRAYED) -> tuple[Point, int]:
    """Advance along a curve by an arc length; return the number of iterations, too.

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
    """Find the point between two successive points of a curve at which the parameter is extreme."""
    return _find_between(problem, before, after, lambda point: point.p_rate)


def find_at(problem: Problem, before: Point, after: Point, p: float) -> np.ndarray:
    """Find the coordinates at a parameter between two successive points of a curve."""
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
    from scipy.optimize import brentq  # imported here, because it takes as long to import as all the rest

    reach = _metric(problem, after.q - before.q, (after.p - before.p) / problem.scale)

    def at(step: float) -> Point:
        return advance(problem, before, step, _LOOSE)[0] if step else before

    while function(at(reach)) * function(before) > 0:
        reach *= 1.1
    return at(float(brentq(lambda step: function(at(step)), 0.0, reach)))


def _newton(problem: Problem, q: np.ndarray, p: float, point: Point | None) -> tuple[np.ndarray, float, int]:
    """Iterate to a solution, at fixed p or in the plane across a curve's direction at `point`."""
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
    """Compute the Jacobian by coordinates and scaled parameter, bordered by the direction of the curve."""
    weights = problem.angles @ (problem.angles.T @ point.q_rate) / problem.angles.shape[1]
    return np.block(
        [
            [problem.jacobian(q, p), problem.rate(q, p)[:, None] * problem.scale],
            [weights[None, :], np.array([[point.p_rate]])],
        ]
    )


def _metric(problem: Problem, q: np.ndarray, p: float) -> float:
    """Compute the arc length of a change: the root mean square of angles, and the scaled parameter."""
    return float(np.sqrt(np.mean((q @ problem.angles) ** 2) + p**2))


def _normalized(
    problem: Problem, q: np.ndarray, p: float, q_rate: np.ndarray, p_rate: float, towards: float | None
) -> Point:
    size = _metric(problem, q_rate, p_rate) * (1.0 if towards is None else np.copysign(1.0, towards * p_rate))
    return Point(q, p, q_rate / size, p_rate / size)
