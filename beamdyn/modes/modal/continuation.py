"""Continuation of the equilibria of a beam over a parameter, through turning points.

A curve of solutions of r(q, p) = 0 is computed in steps of its arc length, measured by the beam's slope
angles and by the parameter divided by its scale (Keller's pseudo-arclength method).

In shapes of arrays, n counts coordinates, and k positions along the beam or points of the curve.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from beamdyn.equations.beam_in_space.bent_beam import Work
from beamdyn.equations.beam_in_space.rotating_beam import RotatingBeam
from beamdyn.equations.root_motion import Quantity

# First, longest and shortest step along a curve, as an arc length (see `_metric`); rounding makes corrections
# larger than a shorter step.
_FIRST, _LONGEST, _SHORTEST = 0.05, 0.2, 1e-7
_ITERATIONS = 12  # largest number of iterations of Newton's method in a step
_EASY = 4  # number of iterations in a step up to which the next step is longer
# Change of slope angles [rad] in an iteration, below which the iteration has converged.
_CONVERGED = 1e-14
# Change of slope angles [rad] in an iteration, below which rounding may stop the iteration.
_STALLED = 1e-9
_STRAYED = 0.5  # ratio of correction to step length above which a step may have reached another curve
_LOOSE = 2.0  # largest ratio of correction to step length if a step is known to end on its curve
_SYMMETRIC = 1e-9  # relative skew-symmetric part of a matrix, below which it counts as rounding error
_MOST_TURNS = 20 * np.pi  # largest angle [rad] by which a load may bend or twist a section
_NEAR = 1e-4  # step below which a change of stability that is no turning point counts as a bifurcation
# Longest step towards a wanted parameter, over the distance to it along the tangent: a step passes the wanted
# parameter only where the curve is nearly straight, and then has a single solution there.
_PAST = 1.05


class NotConverged(ArithmeticError):
    """Raised when Newton's method finds no solution."""


class NoEquilibrium(ArithmeticError):
    """Raised if the beam has no equilibrium on the branch at this speed.

    Examples
    --------
    >>> issubclass(bd.NoEquilibrium, Exception)
    True
    """


@dataclass(frozen=True)
class Loading:
    """Equilibrium equations r(q, p) = 0 under loads that grow in proportion to a parameter p.

    Parameters
    ----------
    elastica : RotatingBeam
        Equations of motion.
    growing : dict of str to float
        Quantities of the root's motion per unit of p, or "unity" for the load at the tip: see
        `BentState.under`.
    scale : float
        Change of p that counts like an angle of 1 rad in the arc length.
    given : dict of str to float
        Constant quantities or tip load that act in addition.
    """

    elastica: RotatingBeam
    growing: Mapping[Quantity, float]
    scale: float = 1.0
    given: Mapping[Quantity, float] = field(default_factory=dict)

    @property
    def angles(self) -> np.ndarray:
        """Slope angles at k positions along the beam per unit of each coordinate, (n, k)."""
        return self.elastica.beam.angles

    def at(self, q: np.ndarray, p: float) -> Work:
        """Compute the residual r at coordinates q and parameter p, and the matrix dr/dq."""
        state, K = self.elastica.at(q), self.elastica.beam.stiffness
        force, change = state.under(self.growing)
        sums = K @ q + p * force, K + p * change
        return Work(*map(np.add, sums, state.under(self.given)) if self.given else sums)

    def rate(self, q: np.ndarray) -> np.ndarray:
        """Compute the derivative of the residual with respect to p."""
        return self.elastica.at(q).under(self.growing).work

    @cached_property
    def at_rest(self) -> np.ndarray:
        """Equilibrium coordinates (n,) at p = 0: 0 unless there is a tip load, which is applied gradually.

        Raises
        ------
        NoEquilibrium
            If the branch ends before the full load.
        """
        straight = np.zeros(self.elastica.beam.size)
        if not self.at(straight, 0.0).work.any():
            return straight
        growing = Loading(self.elastica, self.given)
        try:
            return reach(growing, start_curve(growing, straight, 0.0, 1.0), [1.0])[0]
        except NotConverged as error:
            said = f"no equilibrium was found beyond {error.args[1]:.3g} of the load at the tip"
            raise NoEquilibrium(said) from None

    @cached_property
    def bends(self) -> bool:
        """Whether the growing load, or a tip load, bends the straight beam."""
        return bool(self.at_rest.any() or self.rate(self.at_rest).any())


@dataclass(frozen=True)
class Point:
    """Point on a curve of solutions, with the direction in which the curve is continued.

    Parameters
    ----------
    q : ndarray, shape (n,)
        Coordinates.
    p : float
        Parameter.
    q_rate : ndarray, shape (n,)
        Change of the coordinates per arc length.
    p_rate : float
        Change of the parameter, divided by its scale, per arc length.
    """

    q: np.ndarray
    p: float
    q_rate: np.ndarray
    p_rate: float


def solve_at(load: Loading, q: np.ndarray, p: float, most: float = np.inf) -> np.ndarray:
    """Solve the equilibrium equations r(q, p) = 0 of a load for the coordinates q, by Newton's method.

    Raises
    ------
    NotConverged
        If the iteration does not converge, or changes a slope angle by more than `most` [rad].
    """
    found = _newton(load, q, p, None)[0]
    if np.abs((found - q) @ load.angles).max() > most:
        raise NotConverged
    return found


def start_curve(load: Loading, q: np.ndarray, p: float, towards: float) -> Point:
    """Find the tangent of a curve at a solution, towards larger (1) or smaller (-1) parameters."""
    q_rate = -np.linalg.solve(load.at(q, p).change, load.rate(q)) * load.scale
    return _normalized(load, q, p, towards * q_rate, towards)


def follow(
    load: Loading, start: Point, longest: float = _LONGEST, easy: int = _EASY, goal: float = np.inf
) -> Iterator[Point]:
    """Yield the points of a curve beyond `start` in steps adapted to its curvature, and its turning points.

    Parameters
    ----------
    load : Loading
        The equations.
    start : Point
        A point of the curve.
    longest : float
        Longest step, as a change of the slope angles [rad] or as a relative change of the parameter.
    easy : int
        Number of Newton iterations in a step up to which the next step is longer.
    goal : float
        Wanted parameter, near which steps are shorter, so that none skips several solutions there.

    Raises
    ------
    NotConverged
        If the curve cannot be continued.
    """
    point, step, before = start, _FIRST, count_negative(load, start.q, start.p)
    while True:
        if point.p_rate:
            step = min(step, _PAST * abs(goal - point.p) / abs(point.p_rate * load.scale))
        try:
            following, iterations = advance(load, point, step)
            # A change of stability that is not at a turning point means that the point is on another curve.
            stability = count_negative(load, following.q, following.p)
            if abs(stability - before) != int(following.p_rate * point.p_rate < 0) and step > _NEAR:
                raise NotConverged
        except NotConverged:
            step /= 4
            if step < _SHORTEST:
                raise
            continue
        if following.p_rate * point.p_rate < 0:
            yield replace(_find_between(load, point, following, lambda found: found.p_rate), p_rate=0.0)
        point, before = following, stability
        yield point
        # The longest step changes slope angles by `longest` [rad], or the parameter by that fraction of it.
        size = max(_metric(load, point.q_rate, 0.0), 1 / (1 + abs(point.p) / load.scale))
        step = min(longest / size, 1.5 * step) if iterations <= easy else max(step / 2, _SHORTEST)


def reach(load: Loading, start: Point, goals: Sequence[float]) -> np.ndarray:
    """Compute coordinates (k, n) at given parameters, in the order in which a curve passes them.

    Raises
    ------
    NotConverged
        If the curve ends or turns back before it has reached all of them; the exception's arguments are the
        reason and the parameter at which this happens.
    """
    found, before, towards, why = [], start, np.sign(start.p_rate), "could not be followed beyond"
    steps = (np.array(goals) - start.p) / (start.p_rate * load.scale)
    with suppress(NotConverged):
        if steps[-1] < _LONGEST:  # one step is enough if the curve hardly turns
            near = zip(goals, steps, start.q + steps[:, None] * start.q_rate, strict=True)
            direct = [solve_at(load, q, p, max(_STRAYED * step, _SHORTEST)) for p, step, q in near]
            turned = (start_curve(load, direct[-1], goals[-1], towards).q_rate - start.q_rate) @ load.angles
            same = count_negative(load, direct[-1], goals[-1]) == count_negative(load, start.q, start.p)
            if same and np.abs(turned).max() < _STRAYED:
                return np.array(direct)
    with suppress(NotConverged):
        for after in follow(load, start, goal=goals[-1]):
            while len(found) < len(goals) and towards * (after.p - goals[len(found)]) >= 0:
                found.append(find_at(load, before, after, goals[len(found)]))
            if len(found) == len(goals):
                return np.array(found)
            before, why = after, why if after.p_rate else "turns back at"
            if not after.p_rate or np.abs(after.q @ load.angles).max() > _MOST_TURNS:
                break
    raise NotConverged(why, before.p)


def count_negative(load: Loading, q: np.ndarray, p: float) -> int:
    """Count negative eigenvalues of the Jacobian at a solution; if symmetric, 0 means that it is stable."""
    matrix = load.at(q, p).change
    return int((scaled_eigenvalues(matrix, np.diag(matrix)) < 0).sum())


def scaled_eigenvalues(matrix: np.ndarray, diagonal: np.ndarray) -> np.ndarray:
    """Compute ascending eigenvalues of a square matrix, scaled so that a given diagonal becomes +-1.

    Scaling does not change their signs (Sylvester), but avoids rounding errors if coordinates have very
    different sizes, as with short elements.  If the matrix is not symmetric, as under a load without
    potential, only the real eigenvalues are returned: complex pairs do not change the sign of the
    determinant.
    """
    size = np.sqrt(np.where(diagonal == 0, 1.0, np.abs(diagonal)))
    scaled = matrix / np.outer(size, size)
    if np.abs(scaled - scaled.T).max() < _SYMMETRIC * np.abs(scaled).max():
        return np.linalg.eigvalsh(scaled)
    values = np.linalg.eigvals(scaled)
    return np.sort(values.real[values.imag == 0])


def advance(load: Loading, point: Point, step: float, strayed: float = _STRAYED) -> tuple[Point, int]:
    """Advance along a curve by an arc length; also return the number of iterations.

    A correction larger than `strayed` times the step raises `NotConverged`.
    """
    q, p = point.q + step * point.q_rate, point.p + step * point.p_rate * load.scale
    corrected, p_corrected, iterations = _newton(load, q, p, point)
    correction = np.abs((corrected - q) @ load.angles).max() + abs(p_corrected - p) / load.scale
    if correction > strayed * abs(step):
        raise NotConverged
    tangent = np.linalg.solve(_bordered(load, corrected, p_corrected, point), np.eye(len(q) + 1)[-1])
    return _normalized(load, corrected, p_corrected, tangent[:-1], tangent[-1]), iterations


def find_loss_between(load: Loading, before: Point, after: Point) -> float:
    """Find the parameter between two successive points of a curve at which stability is lost or gained."""
    # The import is inside the function because it takes as long as all other imports.
    from scipy.optimize import brentq

    diagonal = np.diag(load.at(before.q, before.p).change)

    def least(p: float) -> float:
        return float(scaled_eigenvalues(load.at(find_at(load, before, after, p), p).change, diagonal)[0])

    return float(brentq(least, before.p, after.p, xtol=1e-14 * after.p))


def find_at(load: Loading, before: Point, after: Point, p: float) -> np.ndarray:
    """Find the coordinates at a parameter between two successive points of a curve."""
    if p in (before.p, after.p):
        return before.q if p == before.p else after.q
    between = before.q + (p - before.p) / (after.p - before.p) * (after.q - before.q)
    with suppress(NotConverged):
        return solve_at(load, between, p, np.abs((after.q - before.q) @ load.angles).max() / 2)
    return solve_at(load, _find_between(load, before, after, lambda point: (point.p - p) / load.scale).q, p)


def _find_between(load: Loading, before: Point, after: Point, function: Callable[[Point], float]) -> Point:
    """Find the root of a function between two successive points of a curve, along its arc."""
    # The import is inside the function because it takes as long as all other imports.
    from scipy.optimize import brentq

    reach = _metric(load, after.q - before.q, (after.p - before.p) / load.scale)

    def at(step: float) -> Point:
        return advance(load, before, step, _LOOSE)[0] if step else before

    while function(at(reach)) * function(before) > 0:
        reach *= 1.1
    return at(float(brentq(lambda step: function(at(step)), 0.0, reach)))


def _newton(load: Loading, q: np.ndarray, p: float, point: Point | None) -> tuple[np.ndarray, float, int]:
    """Iterate to a solution, at fixed p or in the plane normal to a curve's direction at `point`.

    Returns q, p and the number of iterations.
    """
    last = np.nan  # no change is known yet, and comparisons with it are false
    for iteration in range(1, _ITERATIONS + 1):
        r, A = load.at(q, p)
        if point is None:
            change = np.linalg.solve(A, -r)
        else:
            full = np.linalg.solve(_bordered(load, q, p, point), np.append(-r, 0.0))
            change, p = full[:-1], p + full[-1] * load.scale
        q = q + change
        size = float(np.abs(change @ load.angles).max())
        # Convergence is at least linear: the next change is at most size**2 / last.
        ends = size < _CONVERGED or (size < _STALLED and size > last / 4)
        if ends or size**2 < _CONVERGED * last:
            # Count an iteration that is predicted to converge but omitted: step sizes depend on the number.
            return q, p, iteration + (not ends)
        last = size
    raise NotConverged


def _bordered(load: Loading, q: np.ndarray, p: float, point: Point) -> np.ndarray:
    """Compute the Jacobian in coordinates and scaled parameter; its last row is the curve's direction."""
    weights = load.angles @ (load.angles.T @ point.q_rate) / load.angles.shape[1]
    A, rate = load.at(q, p).change, load.rate(q)[:, None] * load.scale
    return np.block([[A, rate], [weights[None], np.array([[point.p_rate]])]])


def _metric(load: Loading, q: np.ndarray, p: float) -> float:
    """Compute the arc length of a change from the root mean square of the angles and the scaled parameter."""
    return float(np.sqrt(np.mean((q @ load.angles) ** 2) + p**2))


def _normalized(load: Loading, q: np.ndarray, p: float, q_rate: np.ndarray, p_rate: float) -> Point:
    """Build a point of a curve, with its direction scaled to an arc length of 1."""
    size = _metric(load, q_rate, p_rate)
    return Point(q, p, q_rate / size, p_rate / size)
