"""Equilibria at steady speed of a beam that bends by any angle."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np

from beamdyn.equations.elastica import QUANTITIES, DeflectedState, Elastica
from beamdyn.equations.root_motion import Quantity, root_motion
from beamdyn.modal.continuation import NotConverged, Point, find_turning_point, follow, solve_at, start_curve
from beamdyn.scene.motion import MotionSample

Branch = Literal["straight", "bent"]
_SAME = 1e-6  # difference of slope angles below which two equilibria are one [rad]
_PUSH = 0.05  # transverse acceleration over omega^2 L that bends a beam which nothing else does


class NoEquilibrium(ArithmeticError):
    """The beam has no equilibrium on the branch at this speed."""


@dataclass(frozen=True)
class SteadyLoad:
    """Equilibrium of a beam under rotation, with the squared speed as the parameter.

    Parameters
    ----------
    elastica : Elastica
        Equations of motion.
    scale : float
        Squared speed at which rotation matters [rad2/s2].
    push : float
        Further transverse acceleration of the root per squared speed [m].
    """

    elastica: Elastica
    scale: float
    push: float = 0.0

    @property
    def angles(self) -> np.ndarray:
        """Slope angles per coordinate."""
        return self.elastica.angles

    @cached_property
    def _values(self) -> dict[Quantity, float]:
        root = root_motion(self.elastica.linear.mount, MotionSample.steady(1.0))
        values: dict[Quantity, float] = {quantity: float(getattr(root, quantity)) for quantity in QUANTITIES}
        values["root_transverse"] += self.push
        return {quantity: value for quantity, value in values.items() if value}

    @property
    def transverse(self) -> float:
        """Transverse acceleration of the root per squared speed [m]."""
        return self._values.get("root_transverse", 0.0)

    def load(self, state: DeflectedState) -> np.ndarray:
        """Inertial force (n,) per squared speed."""
        return sum(
            (value * state.inertia_of(quantity) for quantity, value in self._values.items()),
            np.zeros(self.elastica.size),
        )

    def residual(self, q: np.ndarray, p: float) -> np.ndarray:
        """Sum of elastic and inertial forces (n,)."""
        return self.elastica.stiffness @ q + p * self.load(self.elastica.at(q))

    def jacobian(self, q: np.ndarray, p: float) -> np.ndarray:
        """Tangent stiffness (n, n)."""
        state = self.elastica.at(q)
        by_rotation = (value * state.stiffness_of(quantity) for quantity, value in self._values.items())
        return self.elastica.stiffness + p * sum(by_rotation, np.zeros_like(self.elastica.stiffness))

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


def follow_to(load: SteadyLoad, speeds: np.ndarray) -> np.ndarray:
    """Follow the equilibria from rest to each of some speeds [rad/s]: coordinates (S, n).

    Raises
    ------
    NoEquilibrium
        If the branch turns back before the fastest.
    """
    found = np.zeros((len(speeds), load.elastica.size))
    pending = [k for k in np.argsort(np.abs(speeds), kind="stable") if speeds[k]]
    if not load.transverse:
        return found  # the straight beam is an equilibrium at every speed
    before = start_curve(load, found[0] if len(found) else np.zeros(load.elastica.size), 0.0, 1.0)
    curve = follow(load, before)
    while pending:
        after = _next(load, curve, before)
        while pending and speeds[pending[0]] ** 2 <= after.p:
            k = pending.pop(0)
            found[k] = solve_at(load, _between(before, after, float(speeds[k]) ** 2), float(speeds[k]) ** 2)
        before = after
    return found


def _next(load: SteadyLoad, curve: Iterator[Point], before: Point) -> Point:
    """The next point of a curve on which the speed must not turn."""
    try:
        after = next(curve)
    except NotConverged:
        speed = np.sqrt(max(before.p, 0.0))
        raise NoEquilibrium(f"the branch from rest could not be followed beyond {speed:.6g} rad/s") from None
    if after.p_rate * before.p_rate < 0:
        turning = np.sqrt(find_turning_point(load, before, after).p)
        raise NoEquilibrium(f"the branch from rest turns back at {turning:.6g} rad/s")
    return after


def _between(before: Point, after: Point, p: float) -> np.ndarray:
    """Coordinates at a parameter between two points of a curve, by linear interpolation."""
    share = (p - before.p) / (after.p - before.p)
    return before.q + share * (after.q - before.q)


def find_bent(load: SteadyLoad, speed: float) -> np.ndarray:
    """Coordinates (n,) of the stable equilibrium on the other side than that of the branch from rest.

    The root is pushed so that the beam bends to the other side, and then released.

    Raises
    ------
    NoEquilibrium
        If the beam does not stay there at this speed.
    """
    length, natural = load.elastica.length, load.transverse
    side = 1.0 if natural >= 0 else -1.0
    push = -2 * natural - side * _PUSH * length
    q = follow_to(replace(load, push=push), np.array([speed]))[0]
    squared = speed**2
    released = Pushed(load, squared, scale=abs(push) * squared)
    point = start_curve(released, q, push * squared, -np.sign(push))
    try:
        for after in follow(released, point):
            if after.p_rate * point.p_rate < 0:
                break
            if after.p * push <= 0:
                return _other_than(load, speed, solve_at(released, _between(point, after, 0.0), 0.0))
            point = after
    except NotConverged:
        pass
    raise _no_bent(speed)


def _other_than(load: SteadyLoad, speed: float, bent: np.ndarray) -> np.ndarray:
    """The bent equilibrium, unless it is that of the branch from rest."""
    straight = follow_to(load, np.array([speed]))[0] if not load.transverse else None
    if straight is not None and np.abs((bent - straight) @ load.angles).max() < _SAME:
        raise _no_bent(speed)
    return bent


def _no_bent(speed: float) -> NoEquilibrium:
    return NoEquilibrium(f"no equilibrium beside the branch from rest exists at {speed:.6g} rad/s")
