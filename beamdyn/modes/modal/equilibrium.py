"""Equilibria at steady speed of a beam with arbitrarily large deflection, and the modes about them.

In shapes of arrays, n counts coordinates, and S speeds.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np

from beamdyn.equations.beam_in_space.rotating_beam import RotatingBeam
from beamdyn.equations.root_motion import Quantity
from beamdyn.modes.modal import continuation
from beamdyn.modes.modal.continuation import Loading, NoEquilibrium, NotConverged, count_negative
from beamdyn.modes.modal.eigenproblem import Eigen, Eigensolver, LoadedSolver, Solver

Branch = Literal["straight", "bent"]
_SAME = 1e-6  # difference of slope angles [rad] below which two equilibria count as the same
# Largest difference of slope angles [rad] between an equilibrium and that of a coarser discretization.
_NEAR = 0.01
_PUSH = 0.05  # transverse acceleration, divided by speed^2 length, that pushes the beam to the other branch
_FASTEST = 100.0  # highest speed of equilibria, divided by the first angular frequency at rest
# Ratio of speed to first angular frequency at rest up to which a loss of stability is searched: at higher
# speeds, boundary layers require short steps.
_SOUGHT = 30.0
# Number of Newton iterations of an easy step (the next step is then longer) in the search for loss of
# stability: with boundary layers, each of the last iterations gains only a few digits.
_PATIENT = 8
# Numbers of the steps in that search, several times as many as it takes: where a basis does not resolve the
# boundary layers, steps get shorter without end.
_STEPS = range(200)
_COILED = 2 * math.pi  # angle of a section [rad] above which no loss of stability is searched


def follow_to(
    load: Loading, speeds: np.ndarray, q: np.ndarray | None = None, start: float = 0.0
) -> np.ndarray:
    """Continue the equilibrium to each of several speeds [rad/s]: coordinates (S, n).

    Parameters
    ----------
    load : Loading
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
    if np.abs(speeds).max(initial=0.0) > most:  # the beam would bend too sharply for any basis
        multiple = f"{_FASTEST:g} times the first angular frequency at rest"
        raise NoEquilibrium(f"equilibria are sought up to {most:.4g} rad/s, {multiple}")
    q = load.at_rest if q is None else q
    squares, found = speeds**2, np.tile(q, (len(speeds), 1))
    for towards in (1.0, -1.0):
        order = np.argsort(towards * squares, kind="stable")
        pending = order[towards * (squares[order] - start**2) > 0]
        # If no load bends the straight beam, it is in equilibrium at every speed.
        if pending.size and (load.bends or q.any()):
            try:
                curve = continuation.start_curve(load, q, start**2, towards)
                found[pending] = continuation.reach(load, curve, squares[pending].tolist())
            except NotConverged as error:
                why, squared = error.args
                raise NoEquilibrium(f"the branch {why} {math.sqrt(max(squared, 0.0)):.6g} rad/s") from None
    return found


class StabilityLoss(NamedTuple):
    """Where the equilibrium continued from rest loses stability, or how far it was followed without a loss.

    Parameters
    ----------
    squared : float
        Squared speed [rad2/s2] of the loss; if stability is not lost, the largest one reached.
    is_lost : bool or None
        Whether stability is lost by a singular stiffness: the branch turns back, or the bent beam buckles.
        None if the equilibrium could not be followed as far as a loss is sought.
    q : ndarray, shape (n,)
        Coordinates of the last stable equilibrium.
    """

    squared: float
    is_lost: bool | None
    q: np.ndarray


def find_bent(load: Loading, speed: float, natural: float = 0.0) -> np.ndarray:
    """Find coordinates (n,) of the stable equilibrium that is bent to the opposite side of the one from rest.

    A transverse acceleration of the root pushes the beam to the opposite side, and is then removed.  The side
    to which the equilibrium from rest bends follows from the root's transverse acceleration or, without one,
    from the sign of `natural`, a load per squared speed.

    Raises
    ------
    NoEquilibrium
        If the beam does not stay on the opposite side at this speed, or has a load at the tip.
    """
    if load.elastica.load is not None:
        said = "with a load at the tip, no other branch is searched; "
        raise NoEquilibrium(f"{said}a small transverse force leads to it, if it exists")
    transverse, squared = load.growing.get("root_transverse", 0.0), speed**2
    natural = transverse or natural
    push = -2 * natural - math.copysign(_PUSH * load.elastica.beam.stations.length, natural + 0.0)
    none_there = NoEquilibrium(f"no equilibrium beside the branch from rest exists at {speed:.6g} rad/s")
    given: dict[Quantity, float] = {name: value * squared for name, value in load.growing.items()}
    pushed = Loading(load.elastica, {"root_transverse": 1.0}, abs(push) * squared, given)
    try:
        pushing = replace(load, growing={**load.growing, "root_transverse": transverse + push})
        q = follow_to(pushing, np.array([speed]))[0]
        curve = continuation.start_curve(pushed, q, push * squared, -np.sign(push))
        bent = continuation.reach(pushed, curve, [0.0])[0]
    except (NotConverged, NoEquilibrium):
        raise none_there from None
    try:
        from_rest = follow_to(load, np.array([speed]))[0]
    except NoEquilibrium:  # the branch from rest turns back before this speed
        return bent
    if np.abs((bent - from_rest) @ load.angles).max() < _SAME:
        raise none_there
    return bent


class DeflectedSolver(Solver):
    """Eigensolver for small motions about the equilibrium at each speed.

    Inherited properties, such as the lowest frequency at rest, are those of the straight beam.

    Parameters
    ----------
    elastica : RotatingBeam
        Equations of motion.
    branch : {"straight", "bent"}
        Branch of equilibria: the one continued from rest, or the stable one bent to the opposite side.
    guide : DeflectedSolver, optional
        Solver of another discretization, whose equilibria are used as initial guesses.
    """

    def __init__(self, elastica: RotatingBeam, branch: Branch, guide: DeflectedSolver | None = None) -> None:
        super().__init__(elastica.straight.steady())
        self.elastica, self.guide = elastica, guide
        self.branch: Branch = branch
        self._found: dict[float, np.ndarray] = {}
        self._solved: dict[tuple[float, int], Eigen] = {}

    def guiding(self, elastica: RotatingBeam) -> DeflectedSolver:
        """Build another discretization's solver, with equilibria of this solver as initial guesses."""
        return DeflectedSolver(elastica, self.branch, guide=self)

    @property
    def conservative(self) -> bool:
        """False, because a beam that bends in the plane of rotation has gyroscopic coupling."""
        return False

    @cached_property
    def load(self) -> Loading:
        """Equations of equilibrium under rotation, whose squared speed [rad2/s2] is the parameter."""
        given: dict[Quantity, float] = {"unity": 1.0} if self.elastica.load else {}
        return Loading(self.elastica, self.elastica.turning, self.lowest_at_rest, given)

    @property
    def critical_speed(self) -> float:
        """Lowest speed at which the straight beam buckles [rad/s]; inf if it bends at every speed."""
        if self.load.bends or self.elastica.load is None:
            return np.inf if self.load.bends else super().critical_speed
        at_rest = self.load.at_rest
        return 0.0 if count_negative(self.load, at_rest, 0.0) else self._about(at_rest).critical_speed

    eigenvalues = Eigensolver.eigenvalues

    def solve(self, speeds: np.ndarray, count: int) -> Eigen:
        """Compute the `count` lowest modes at each speed [rad/s]; each speed is solved once.

        Raises
        ------
        NoEquilibrium
            If the branch of equilibria does not reach a speed (an ArithmeticError).
        """
        missing = np.array([v for v in np.unique(speeds) if (v, count) not in self._solved])
        for v, q in zip(missing.tolist(), self.equilibria(missing), strict=True):
            self._solved[v, count] = self._about(q).solve(np.array([v]), count)
        return Eigen.joined(self._solved[v, count] for v in speeds.tolist())

    def _about(self, q: np.ndarray) -> Solver:
        """Build the solver for small motions about an equilibrium with coordinates q."""
        return (Solver if self.elastica.load is None else LoadedSolver)(self.elastica.at(q).steady())

    def growth_rate(self, q: np.ndarray, speed: float) -> float:
        """Compute the largest growth rate [1/s] of small motions about an equilibrium q at a speed [rad/s].

        The lower half of the modes is judged; the upper half belongs to the discretization, not to the beam.
        """
        return float(np.real(self._about(q).solve(np.array([speed]), -(-self.size // 2)).eigenvalue).max())

    def is_stable(self, point: continuation.Point) -> bool:
        """Return whether small motions about a point of a curve of equilibria stay small."""
        if self.elastica.load is None:
            return count_negative(self.load, point.q, point.p) == 0
        # A load that follows the tip may cause flutter, which the stiffness does not show.
        return self.growth_rate(point.q, max(point.p, 0.0) ** 0.5) <= 0

    def find_loss_of_stability(self) -> StabilityLoss:
        """Find the speed at which the equilibrium continued from rest loses stability."""
        load, top = self.load, _SOUGHT**2 * self.load.scale
        if count_negative(load, load.at_rest, 0.0):
            return StabilityLoss(0.0, True, load.at_rest)
        if not load.bends:
            squared = self._about(load.at_rest).critical_speed ** 2
            return StabilityLoss(min(squared, top), squared < top, load.at_rest)
        before = continuation.start_curve(load, load.at_rest, 0.0, 1.0)
        with suppress(NotConverged):
            for after, _ in zip(continuation.follow(load, before, easy=_PATIENT), _STEPS, strict=False):
                if not after.p_rate or count_negative(load, after.q, after.p):
                    lost = continuation.find_loss_between(load, before, after) if after.p_rate else after.p
                    return StabilityLoss(lost, True, before.q)
                before = after
                if after.p > top or np.abs(after.q @ load.angles).max() > _COILED:
                    return StabilityLoss(before.p, False, before.q)
        return StabilityLoss(before.p, None, before.q)

    def solve_static(self, speeds: np.ndarray, outputs: np.ndarray) -> np.ndarray:
        """Compute linear functions of the coordinates in equilibrium: see `Eigensolver.solve_static`."""
        return self.equilibria(speeds) @ outputs.T

    def tips(self, speeds: np.ndarray) -> np.ndarray:
        """Compute the tip's transverse deflection in equilibrium [m]: one column, or two in space."""
        beam = self.elastica.beam
        moved = beam.at(self.equilibria(speeds)).tip - beam.at(np.zeros(self.size)).tip
        return moved[:, 1 : 2 if beam.is_planar else 3]

    def equilibria(self, speeds: np.ndarray) -> np.ndarray:
        """Compute the equilibrium coordinates at each speed, in rows; results are cached."""
        missing = np.array([v for v in np.unique(np.abs(speeds)) if v not in self._found])
        if guide := self.guide:
            # An equilibrium close to that of the guide is taken if as many eigenvalues are negative there.
            for v in missing.tolist():
                with suppress(NotConverged, NoEquilibrium):
                    near = guide.equilibria(np.array([v]))[0]
                    start = self.elastica.nearest(guide.elastica, near)
                    q = continuation.solve_at(self.load, start, v**2, _NEAR)
                    if count_negative(self.load, q, v**2) == count_negative(guide.load, near, v**2):
                        self._found[v] = q
            missing = np.array([v for v in missing if v not in self._found])
        if len(missing):
            if not self._found:
                from_rest, v = self.branch == "straight", float(missing[-1])
                self._found |= {0.0: self.load.at_rest} if from_rest else {v: find_bent(self.load, v)}
            start = min(self._found, key=lambda v: abs(v - missing[0]))
            followed = follow_to(self.load, missing, self._found[start], start)
            self._found.update(zip(missing.tolist(), followed, strict=True))
        return np.array([self._found[abs(v)] for v in speeds])
