"""Equilibria at steady speed of a beam that bends by any angle, and the modes about them."""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Literal

import numpy as np
from scipy.linalg import eigh

from beamdyn.equations.beam_in_space.rotating_beam import BentState, RotatingBeam
from beamdyn.equations.beam_in_space.tip_forces import LoadedBeam
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.equations.root_motion import Quantity
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
from beamdyn.modes.modal.eigenproblem import Eigen, Eigensolver, LoadedSolver, Solver

Branch = Literal["straight", "bent"]
_SAME = 1e-6  # difference of slope angles below which two equilibria count as the same one [rad]
# Largest difference of slope angles between an equilibrium and that of a coarser discretization [rad].
_NEAR = 0.01
_PUSH = 0.05  # transverse acceleration, over omega^2 L, by which the beam is pushed to the other branch
_FASTEST = 100.0  # highest speed at which equilibria are followed, over the first angular frequency at rest
# Speed over the first angular frequency at rest, up to which a loss of stability is sought: beyond, boundary
# layers make steps short.
_SOUGHT = 30.0
# Iterations of an easy step while a loss of stability is sought: in boundary layers the last ones gain a few
# digits each.
_PATIENT = 8
_MOST_TURNS = 20 * math.pi  # angle [rad] by which a load at the tip may bend or twist a section
_COILED = 2 * math.pi  # angle of a section [rad] beyond which no loss of stability is sought


class NoEquilibrium(ArithmeticError):
    """Raised when the beam has no equilibrium on the branch at this speed.

    Examples
    --------
    >>> issubclass(bd.NoEquilibrium, Exception)
    True
    """


@dataclass(frozen=True)
class SteadyLoad:
    """Equations of equilibrium of a beam under rotation, with the squared speed as the parameter.

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
        """Slope angles along the beam per coordinate (n, k), the measure of changes of the coordinates."""
        return self.elastica.angles

    @cached_property
    def values(self) -> dict[Quantity, float]:
        """Quantities of the root's motion per squared speed."""
        values = dict(self.elastica.turning)
        if self.push:
            values["root_transverse"] = values.get("root_transverse", 0.0) + self.push
        return {quantity: value for quantity, value in values.items() if value}

    @property
    def transverse(self) -> float:
        """Transverse acceleration of the root per squared speed [m]."""
        return self.values.get("root_transverse", 0.0)

    @cached_property
    def at_rest(self) -> np.ndarray:
        """Coordinates (n,) in equilibrium at rest: 0 unless a load acts at the tip, which grows from 0.

        Raises
        ------
        NoEquilibrium
            If the branch does not reach the whole load.
        """
        straight = np.zeros(self.elastica.size)
        if not self.elastica.at(straight).force_at_rest.any():
            return straight
        assert self.elastica.load is not None
        growing, reached = LoadedBeam(self.elastica.beam, self.elastica.load), 0.0
        before = start_curve(growing, straight, 0.0, 1.0)
        with suppress(NotConverged):
            for after in follow(growing, before):
                if after.p >= 1:
                    return find_at(growing, before, after, 1.0)
                if after.p_rate < 0 or np.abs(after.q @ self.angles).max() > _MOST_TURNS:
                    break
                before, reached = after, after.p
        raise NoEquilibrium(f"the beam is only followed to {reached:.3g} of the load at its tip: reduce it")

    @cached_property
    def bends(self) -> bool:
        """Whether rotation, or a load at the tip, loads the straight beam otherwise than along it."""
        return bool(self.at_rest.any() or self.load(self.elastica.at(self.at_rest)).any())

    def load(self, state: BentState) -> np.ndarray:
        """Compute the inertial force (n,) per squared speed."""
        return state.inertia(self.values)

    def residual(self, q: np.ndarray, p: float) -> np.ndarray:
        """Sum elastic and inertial forces, less the load at the tip (n,), at q (n,) and squared speed p."""
        state = self.elastica.at(q)
        return state.force_at_rest + p * self.load(state)

    def jacobian(self, q: np.ndarray, p: float) -> np.ndarray:
        """Compute the tangent stiffness (n, n) at q and squared speed p."""
        state = self.elastica.at(q)
        return state.stiffness_at_rest + p * state.inertia_change(self.values)

    def rate(self, q: np.ndarray, p: float) -> np.ndarray:
        """Compute the derivative of the residual by the squared speed, shape (n,)."""
        return self.load(self.elastica.at(q))


@dataclass(frozen=True)
class Pushed:
    """Equations of equilibrium at a fixed speed, with a transverse acceleration as the parameter.

    Parameters
    ----------
    load : SteadyLoad
        The beam under rotation, without a push.
    squared : float
        Squared speed [rad2/s2].
    scale : float
        Acceleration [m/s2] that counts as much as an angle of 1 rad.
    """

    load: SteadyLoad
    squared: float
    scale: float

    @property
    def angles(self) -> np.ndarray:
        """Slope angles along the beam per coordinate (n, k), the measure of changes of the coordinates."""
        return self.load.angles

    def residual(self, q: np.ndarray, p: float) -> np.ndarray:
        """Compute the sum of elastic and inertial forces (n,) at q and acceleration p."""
        return self.load.residual(q, self.squared) + p * self.rate(q, p)

    def jacobian(self, q: np.ndarray, p: float) -> np.ndarray:
        """Compute the tangent stiffness (n, n) at q and acceleration p."""
        state = self.load.elastica.at(q)
        return self.load.jacobian(q, self.squared) + p * state.stiffness_of("root_transverse")

    def rate(self, q: np.ndarray, p: float) -> np.ndarray:
        """Compute the derivative of the residual by the acceleration, shape (n,)."""
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
        Coordinates in equilibrium at the speed `start` [rad/s]; by default those at rest.

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
    q = load.at_rest if q is None else q
    squares = speeds**2
    found = np.tile(q, (len(speeds), 1))
    for towards in (1.0, -1.0):
        pending = [
            k for k in np.argsort(towards * squares, kind="stable") if towards * (squares[k] - start**2) > 0
        ]
        # Without a load that bends it, the straight beam is in equilibrium at every speed.
        if pending and (load.bends or q.any()):
            found[pending] = _follow_in_order(load, start_curve(load, q, start**2, towards), squares[pending])
    return found


def _follow_in_order(load: SteadyLoad, before: Point, squares: np.ndarray) -> np.ndarray:
    """Compute coordinates at squared speeds, in the order in which a curve of equilibria meets them."""
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
    """Find the squared speed [rad2/s2] at which the equilibrium that follows from rest loses stability.

    Returns
    -------
    squared : float
        Squared speed; where no stability is lost, the largest one reached.
    is_lost : bool
        Whether stability is lost, as the stiffness is singular: the branch turns back, or the beam buckles
        out of the shape into which the rotation bends it.
    """
    from scipy.optimize import brentq  # imported here, because it takes as long to import as all the rest

    if count_negative(load, load.at_rest, 0.0):
        return 0.0, True
    if not load.bends:
        state = load.elastica.at(load.at_rest)
        change = state.inertia_change(load.values)  # symmetric, as every load here has a potential
        softening = max(eigh(-change, state.stiffness_at_rest, eigvals_only=True)[-1], 0.0)
        if softening * _SOUGHT**2 * load.scale > 1:
            return float(1 / softening), True
        return _SOUGHT**2 * load.scale, False
    before = start_curve(load, load.at_rest, 0.0, 1.0)
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
    """Compute the lowest scaled eigenvalue of the stiffness at a squared speed between two branch points."""
    q = find_at(load, before, after, squared)
    return float(scaled_eigenvalues(load.jacobian(q, squared), diagonal)[0])


def find_bent(load: SteadyLoad, speed: float) -> np.ndarray:
    """Find coordinates (n,) of the stable equilibrium that is bent to the other side than the one from rest.

    The root is pushed so that the beam bends to the other side, and then released.

    Raises
    ------
    NoEquilibrium
        If the beam does not stay on the other side at this speed, or has a load at the tip.
    """
    if load.elastica.load is not None:
        said = "with a load at the tip no other branch is sought; "
        raise NoEquilibrium(f"{said}add a small force across, which leads to one if it is there")
    natural, squared = load.transverse, speed**2
    side = 1.0 if natural >= 0 else -1.0
    push = -2 * natural - side * _PUSH * load.elastica.length
    try:
        q = follow_to(replace(load, push=push), np.array([speed]))[0]
        bent = _release(Pushed(load, squared, scale=abs(push) * squared), q, push * squared)
    except (NotConverged, NoEquilibrium):
        bent = None
    with suppress(NoEquilibrium):  # the branch from rest may turn back before this speed
        from_rest = follow_to(load, np.array([speed]))[0] if bent is not None else None
        if from_rest is not None and np.abs((bent - from_rest) @ load.angles).max() < _SAME:
            bent = None
    if bent is None:
        raise NoEquilibrium(f"no equilibrium beside the branch from rest exists at {speed:.6g} rad/s")
    return bent


def _release(pushed: Pushed, q: np.ndarray, push: float) -> np.ndarray | None:
    """Follow an equilibrium while the push is reduced to 0; None if the equilibrium is lost before."""
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
    """Eigensolver for small motions about the equilibrium at each speed.

    Parameters
    ----------
    elastica : RotatingBeam
        Equations of motion.
    branch : {"straight", "bent"}
        Branch of equilibria: the one that follows from rest, or the one next to it.
    guide : DeflectedSolver, optional
        Solver of another discretization; equilibria are sought near its own first.
    """

    def __init__(self, elastica: RotatingBeam, branch: Branch, guide: DeflectedSolver | None = None) -> None:
        super().__init__(elastica.straight.steady())
        self.elastica, self.guide = elastica, guide
        self.branch: Branch = branch
        self._straight = Solver(self.pencil)
        self._found: dict[float, np.ndarray] = {}
        self._solved: dict[tuple[float, int], Eigen] = {}

    def guiding(self, elastica: RotatingBeam) -> DeflectedSolver:
        """Make another discretization's solver, which seeks equilibria near those of this solver."""
        return DeflectedSolver(elastica, self.branch, guide=self)

    @property
    def conservative(self) -> bool:
        """False, because a bent beam in the plane of rotation is gyroscopic."""
        return False

    @cached_property
    def lowest_at_rest(self) -> float:
        """Lowest squared angular frequency at rest [rad2/s2], plus `pencil.shift`."""
        return self._straight.lowest_at_rest

    @cached_property
    def load(self) -> SteadyLoad:
        """Equations of equilibrium under rotation."""
        return SteadyLoad(self.elastica, self.lowest_at_rest)

    @property
    def softening(self) -> float:
        """Largest relative loss of the straight beam's stiffness per squared speed [s2]: see `Solver`."""
        return self._straight.softening

    @property
    def critical_speed(self) -> float:
        """Lowest speed at which the straight beam buckles [rad/s]; inf where it bends from rest on."""
        if self.load.bends:
            return np.inf
        if self.elastica.load is None:
            return self._straight.critical_speed
        squared, is_lost = find_loss_of_stability(self.load)
        return math.sqrt(squared) if is_lost else np.inf

    @property
    def critical_rounding(self) -> float:
        """Estimated relative rounding error of the critical speed."""
        return self._straight.critical_rounding

    def solve(self, speeds: np.ndarray, count: int) -> Eigen:
        """Compute the `count` lowest modes at each speed [rad/s]; each speed is solved once.

        Raises
        ------
        NoEquilibrium
            An ArithmeticError: if the branch of equilibria does not reach a speed.
        """
        missing = np.array([v for v in np.unique(speeds) if (v, count) not in self._solved])
        for v, q in zip(missing.tolist(), self.equilibria(missing), strict=True):
            pencil = self.elastica.at(q).steady()
            solver = Solver(pencil) if self.elastica.load is None else LoadedSolver(pencil)
            self._solved[v, count] = solver.solve(np.array([v]), count)
        each = [self._solved[v, count] for v in speeds.tolist()]
        values = zip(*((e.eigenvalue, e.vector, e.rounding) for e in each), strict=True)
        return Eigen(*map(np.concatenate, values))

    def solve_static(self, speeds: np.ndarray, outputs: np.ndarray) -> np.ndarray:
        """Compute linear functions of the coordinates in equilibrium: see `Eigensolver.solve_static`."""
        return self.equilibria(speeds) @ outputs.T

    def equations(self, speeds: np.ndarray) -> list[Equations]:
        """Linearize the equations about the equilibrium at each speed."""
        return [self.elastica.at(q).linearized() for q in self.equilibria(speeds)]

    def tips(self, speeds: np.ndarray) -> np.ndarray:
        """Compute the tip's deflection across the beam in equilibrium [m], shape (S, 1), in space (S, 2)."""
        moved = self.elastica.tip(self.equilibria(speeds)) - self.elastica.tip(np.zeros(self.size))
        return moved[:, 1:2] if self.elastica.beam.is_planar else moved[:, 1:]

    def equilibria(self, speeds: np.ndarray) -> np.ndarray:
        """Compute the coordinates (S, n) in equilibrium at each speed; results are cached."""
        missing = np.array([v for v in np.unique(np.abs(speeds)) if v not in self._found])
        if self.guide is not None and len(missing):
            self._found |= self._find_near(self.guide, missing)
            missing = np.array([v for v in missing if v not in self._found])
        if len(missing):
            if not self._found and self.branch == "straight":
                self._found[0.0] = self.load.at_rest
            elif not self._found:
                self._found[float(missing[-1])] = find_bent(self.load, float(missing[-1]))
            known = np.array(list(self._found))
            start = float(known[np.abs(known - missing[0]).argmin()])
            followed = follow_to(self.load, missing, self._found[start], start)
            self._found.update(zip(missing.tolist(), followed, strict=True))
        return np.array([self._found[abs(v)] for v in speeds])

    def _find_near(self, guide: DeflectedSolver, speeds: np.ndarray) -> dict[float, np.ndarray]:
        """Find equilibria near another discretization's, of the same stability, at speeds that have them."""
        found: dict[float, np.ndarray] = {}
        for v, of_guide in zip(speeds.tolist(), guide.equilibria(speeds), strict=True):
            near = self.elastica.nearest(guide.elastica, of_guide)
            with suppress(NotConverged):
                q = solve_at(self.load, near, v**2)
                stable = (count_negative(s.load, x, v**2) for s, x in ((self, q), (guide, of_guide)))
                if np.abs((q - near) @ self.load.angles).max() < _NEAR and len({*stable}) == 1:
                    found[v] = q
        return found
