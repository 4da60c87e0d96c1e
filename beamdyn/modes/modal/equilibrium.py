"""Equilibria at steady speed of a beam that bends by any angle, and its modes about them."""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Literal

import numpy as np

from beamdyn.equations.beam_in_space.rotating_beam import BentState, RotatingBeam
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.equations.root_motion import Quantity, root_motion
from beamdyn.modes.modal.continuation import (
    NotConverged,
    Point,
    count_negative,
    find_at,
    find_turning_point,
    follow,
    scaled_eigenvalues,
    solve_at,
    start_curve,
)
from beamdyn.modes.modal.eigenproblem import Eigen, Eigensolver, Solver
from beamdyn.scene.motion import MotionSample

Branch = Literal["straight", "bent"]
_SAME = 1e-6  # difference of slope angles below which two equilibria are one [rad]
_NEAR = 0.01  # difference of slope angles by which that of a coarse discretization may differ [rad]
_PUSH = 0.05  # transverse acceleration over omega^2 L that bends a beam which nothing else does
_FASTEST = 100.0  # speed over the first angular frequency at rest, to which equilibria are followed
_SOUGHT = 30.0  # the same, to which a loss of stability is sought: beyond, boundary layers make steps short
_PATIENT = 8  # iterations that a step may take there: in boundary layers the last ones gain a few digits each
_COILED = 2 * math.pi  # angle of a section [rad] beyond which no loss of stability is sought


class NoEquilibrium(ArithmeticError):
    """The beam has no equilibrium on the branch at this speed.

    Examples
    --------
    >>> issubclass(bd.NoEquilibrium, Exception)
    True
    """


@dataclass(frozen=True)
class SteadyLoad:
    """Equilibrium of a beam under rotation, with the squared speed as the parameter.

    Parameters
    ----------
    elastica : RotatingBeam
        Equations of motion.
    scale : float
        Squared speed at which rotation matters [rad2/s2].
    push : float
        Further transverse acceleration of the root per squared speed [m].
    """

    elastica: RotatingBeam
    scale: float
    push: float = 0.0

    @property
    def angles(self) -> np.ndarray:
        """Slope angles per coordinate."""
        return self.elastica.angles

    @cached_property
    def _values(self) -> dict[Quantity, float]:
        root = root_motion(self.elastica.linear.mount, MotionSample.steady(1.0))
        quantities = self.elastica.quantities
        values: dict[Quantity, float] = {quantity: float(getattr(root, quantity)) for quantity in quantities}
        values["root_transverse"] += self.push
        return {quantity: value for quantity, value in values.items() if value}

    @property
    def transverse(self) -> float:
        """Transverse acceleration of the root per squared speed [m]."""
        return self._values.get("root_transverse", 0.0)

    @cached_property
    def bends(self) -> bool:
        """Whether rotation loads the straight beam otherwise than along it."""
        return bool(self.load(self.elastica.at(np.zeros(self.elastica.size))).any())

    def load(self, state: BentState) -> np.ndarray:
        """Inertial force (n,) per squared speed."""
        return state.inertia(self._values)

    def residual(self, q: np.ndarray, p: float) -> np.ndarray:
        """Sum of elastic and inertial forces (n,)."""
        return self.elastica.stiffness @ q + p * self.load(self.elastica.at(q))

    def jacobian(self, q: np.ndarray, p: float) -> np.ndarray:
        """Tangent stiffness (n, n)."""
        return self.elastica.stiffness + p * self.elastica.at(q).inertia_change(self._values)

    def rate(self, q: np.ndarray, p: float) -> np.ndarray:
        """Derivative of the residual by the squared speed."""
        return self.load(self.elastica.at(q))


@dataclass(frozen=True)
class Pushed:
    """Equilibrium at a fixed speed, with a transverse acceleration of the root as the parameter.

    Parameters
    ----------
    load : SteadyLoad
        The beam under rotation, without a push.
    squared : float
        Squared speed [rad2/s2].
    scale : float
        Acceleration that counts as an angle of 1 [m/s2].
    """

    load: SteadyLoad
    squared: float
    scale: float

    @property
    def angles(self) -> np.ndarray:
        """Slope angles per coordinate."""
        return self.load.angles

    def residual(self, q: np.ndarray, p: float) -> np.ndarray:
        """Sum of elastic and inertial forces (n,)."""
        return self.load.residual(q, self.squared) + p * self.rate(q, p)

    def jacobian(self, q: np.ndarray, p: float) -> np.ndarray:
        """Tangent stiffness (n, n)."""
        state = self.load.elastica.at(q)
        return self.load.jacobian(q, self.squared) + p * state.stiffness_of("root_transverse")

    def rate(self, q: np.ndarray, p: float) -> np.ndarray:
        """Derivative of the residual by the acceleration."""
        return self.load.elastica.at(q).inertia_of("root_transverse")


def follow_to(
    load: SteadyLoad, speeds: np.ndarray, q: np.ndarray | None = None, start: float = 0.0
) -> np.ndarray:
    """Follow the equilibria to each of some speeds [rad/s]: coordinates (S, n).

    Parameters
    ----------
    load : SteadyLoad
        The beam under rotation.
    speeds : ndarray, shape (S,)
        The speeds.
    q : ndarray, shape (n,), optional
        Coordinates in equilibrium at the speed `start` [rad/s]; by default the beam at rest.

    Raises
    ------
    NoEquilibrium
        If the branch turns back before a speed, or a speed is too large.
    """
    most = _FASTEST * math.sqrt(load.scale)
    if np.abs(speeds).max(initial=0.0) > most:  # the beam bends too sharply for any basis
        raise NoEquilibrium(
            f"equilibria are sought up to {most:.4g} rad/s, {_FASTEST:g} times the first angular frequency "
            "at rest"
        )
    q = np.zeros(load.elastica.size) if q is None else q
    squares = speeds**2
    found = np.tile(q, (len(speeds), 1))
    for towards in (1.0, -1.0):
        pending = [
            k for k in np.argsort(towards * squares, kind="stable") if towards * (squares[k] - start**2) > 0
        ]
        if pending and (
            load.bends or q.any()
        ):  # otherwise the straight beam is in equilibrium at every speed
            found[pending] = _follow_in_order(load, start_curve(load, q, start**2, towards), squares[pending])
    return found


def _follow_in_order(load: SteadyLoad, before: Point, squares: np.ndarray) -> np.ndarray:
    """Coordinates at squared speeds in the order in which a curve meets them."""
    found, curve, towards = [], follow(load, before), np.sign(before.p_rate)
    while len(found) < len(squares):
        try:
            after = next(curve)
        except NotConverged:
            raise NoEquilibrium(
                f"the branch could not be followed beyond {math.sqrt(max(before.p, 0.0)):.6g} rad/s"
            ) from None
        turning = find_turning_point(load, before, after) if after.p_rate * before.p_rate < 0 else None
        after = turning or after
        while len(found) < len(squares) and towards * (after.p - squares[len(found)]) >= 0:
            squared = float(squares[len(found)])
            try:
                found.append(find_at(load, before, after, squared))
            except NotConverged:
                reason = f"the equilibrium at {math.sqrt(squared):.6g} rad/s was not found to rounding"
                raise NoEquilibrium(reason) from None
        if turning is not None and len(found) < len(squares):
            raise NoEquilibrium(f"the branch turns back at {math.sqrt(max(turning.p, 0.0)):.6g} rad/s")
        before = after
    return np.array(found)


def find_loss_of_stability(load: SteadyLoad) -> tuple[float, bool]:
    """Squared speed [rad2/s2] at which the equilibrium that follows from rest loses its stability.

    Returns
    -------
    squared : float
        Where there is none, the largest to which the equilibrium was followed.
    is_lost : bool
        Whether the stiffness is singular there: the branch turns back, or the beam buckles out of the shape
        into which the rotation bends it.
    """
    from scipy.optimize import brentq  # here, because it takes as long to import as all the rest

    before = start_curve(load, np.zeros(load.elastica.size), 0.0, 1.0)
    with suppress(NotConverged):
        for after in follow(load, before, easy=_PATIENT):
            if after.p_rate < 0:
                return find_turning_point(load, before, after).p, True
            if count_negative(load, after.q, after.p):
                diagonal = np.diag(load.jacobian(before.q, before.p))
                least = partial(_least_stiffness, load, before, after, diagonal)
                return float(brentq(least, before.p, after.p, xtol=1e-14 * after.p)), True
            before = after
            if after.p > _SOUGHT**2 * load.scale or np.abs(after.q @ load.angles).max() > _COILED:
                break
    return before.p, False


def _least_stiffness(
    load: SteadyLoad, before: Point, after: Point, diagonal: np.ndarray, squared: float
) -> float:
    """Lowest eigenvalue of the stiffness at a squared speed between two points of a branch, scaled."""
    q = find_at(load, before, after, squared)
    return float(scaled_eigenvalues(load.jacobian(q, squared), diagonal)[0])


def find_bent(load: SteadyLoad, speed: float) -> np.ndarray:
    """Coordinates (n,) of the stable equilibrium on the other side than that of the branch from rest.

    The root is pushed so that the beam bends to the other side, and then released.

    Raises
    ------
    NoEquilibrium
        If the beam does not stay there at this speed.
    """
    natural, squared = load.transverse, speed**2
    side = 1.0 if natural >= 0 else -1.0
    push = -2 * natural - side * _PUSH * load.elastica.length
    try:
        q = follow_to(replace(load, push=push), np.array([speed]))[0]
        bent = _release(Pushed(load, squared, scale=abs(push) * squared), q, push * squared)
    except (NotConverged, NoEquilibrium):
        bent = None
    with suppress(NoEquilibrium):  # the branch from rest may turn back before
        from_rest = follow_to(load, np.array([speed]))[0] if bent is not None else None
        if from_rest is not None and np.abs((bent - from_rest) @ load.angles).max() < _SAME:
            bent = None
    if bent is None:
        raise NoEquilibrium(f"no equilibrium beside the branch from rest exists at {speed:.6g} rad/s")
    return bent


def _release(pushed: Pushed, q: np.ndarray, push: float) -> np.ndarray | None:
    """Follow an equilibrium until the push has ended; None if it is lost before."""
    before = start_curve(pushed, q, push, -np.sign(push))
    for after in follow(pushed, before):
        turned = after.p_rate * before.p_rate < 0
        if turned:
            after = find_turning_point(pushed, before, after)
        if after.p * push <= 0:
            return find_at(pushed, before, after, 0.0)
        if turned:
            return None
        before = after
    return None


class DeflectedSolver(Eigensolver):
    """Eigensolver about the equilibrium at each speed.

    Parameters
    ----------
    elastica : RotatingBeam
        Equations of motion.
    branch : {"straight", "bent"}
        Equilibria that are meant: those that follow from rest, or those beside them.
    guide : DeflectedSolver, optional
        Solver of another discretization, near whose equilibria these are sought first.
    """

    def __init__(self, elastica: RotatingBeam, branch: Branch, guide: DeflectedSolver | None = None) -> None:
        super().__init__(elastica.about_straight.steady())  # about the straight beam
        self.elastica, self.guide = elastica, guide
        self.branch: Branch = branch
        self._straight = Solver(self.pencil)
        self._found: dict[float, np.ndarray] = {}
        self._solved: dict[tuple[float, int], Eigen] = {}

    def guiding(self, elastica: RotatingBeam) -> DeflectedSolver:
        """Solver of another discretization, whose equilibria are sought near these."""
        return DeflectedSolver(elastica, self.branch, guide=self)

    @property
    def conservative(self) -> bool:
        """False: a bent beam in the plane of rotation is gyroscopic."""
        return False

    @cached_property
    def lowest_at_rest(self) -> float:
        """Lowest squared angular frequency at rest [rad2/s2], plus `pencil.shift`."""
        return self._straight.lowest_at_rest

    @cached_property
    def load(self) -> SteadyLoad:
        """Problem of the equilibria."""
        return SteadyLoad(self.elastica, self.lowest_at_rest)

    @property
    def softening(self) -> float:
        """Largest loss of stiffness of the straight beam per squared speed, as of `Solver`."""
        return self._straight.softening

    @property
    def critical_speed(self) -> float:
        """Lowest speed at which the straight beam buckles [rad/s]; inf where rotation bends it instead."""
        return np.inf if self.load.bends else self._straight.critical_speed

    @property
    def critical_rounding(self) -> float:
        """Estimated relative rounding error of the critical speed."""
        return self._straight.critical_rounding

    def solve(self, speeds: np.ndarray, count: int) -> Eigen:
        """Compute the `count` lowest modes at each speed [rad/s], once each: as `Solver.solve`.

        Raises
        ------
        NoEquilibrium
            An ArithmeticError: if the branch of equilibria does not reach a speed.
        """
        missing = np.array([v for v in np.unique(speeds) if (v, count) not in self._solved])
        for v, equations in zip(missing.tolist(), self.equations(missing), strict=True):
            self._solved[v, count] = Solver(equations.steady()).solve(np.array([v]), count)
        each = [self._solved[v, count] for v in speeds.tolist()]
        values = zip(*((e.eigenvalue, e.vector, e.rounding) for e in each), strict=True)
        return Eigen(*map(np.concatenate, values))

    def solve_static(self, speeds: np.ndarray, outputs: np.ndarray) -> np.ndarray:
        """Compute linear functions of the coordinates in equilibrium: as `Solver.solve_static`."""
        return self.equilibria(speeds) @ outputs.T

    def equations(self, speeds: np.ndarray) -> list[Equations]:
        """Equations linear about the equilibrium at each speed."""
        return [self.elastica.at(q).linearized() for q in self.equilibria(speeds)]

    def tips(self, speeds: np.ndarray) -> np.ndarray:
        """Deflection of the tip across the beam in equilibrium [m], shape (S, 1), in space (S, 2)."""
        moved = self.elastica.tip(self.equilibria(speeds)) - self.elastica.tip(np.zeros(self.size))
        return moved[:, 1:2] if self.elastica.beam.is_planar else moved[:, 1:]

    def equilibria(self, speeds: np.ndarray) -> np.ndarray:
        """Coordinates (S, n) in equilibrium at each speed, each computed once."""
        missing = np.array([v for v in np.unique(np.abs(speeds)) if v not in self._found])
        if self.guide is not None and len(missing):
            self._found |= self._find_near(self.guide, missing)
            missing = np.array([v for v in missing if v not in self._found])
        if len(missing):
            if not self._found and self.branch == "straight":
                self._found[0.0] = np.zeros(self.size)
            elif not self._found:
                self._found[float(missing[-1])] = find_bent(self.load, float(missing[-1]))
            known = np.array(list(self._found))
            start = float(known[np.abs(known - missing[0]).argmin()])
            followed = follow_to(self.load, missing, self._found[start], start)
            self._found.update(zip(missing.tolist(), followed, strict=True))
        return np.array([self._found[abs(v)] for v in speeds])

    def _find_near(self, guide: DeflectedSolver, speeds: np.ndarray) -> dict[float, np.ndarray]:
        """Equilibria near those of another discretization, and as stable, at speeds where there are any."""
        found: dict[float, np.ndarray] = {}
        for v, of_guide in zip(speeds.tolist(), guide.equilibria(speeds), strict=True):
            near = self.elastica.nearest(guide.elastica, of_guide)
            with suppress(NotConverged):
                q = solve_at(self.load, near, v**2)
                stable = (count_negative(s.load, x, v**2) for s, x in ((self, q), (guide, of_guide)))
                if np.abs((q - near) @ self.load.angles).max() < _NEAR and len({*stable}) == 1:
                    found[v] = q
        return found
