"""Equations of motion of a beam bent in space, in modal coordinates, evaluated at times for integrators."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple, Protocol, Self, TypeAlias

import numpy as np

from beamdyn.equations.beam_in_space.moving_beam import Carrier, MovingBeam
from beamdyn.equations.beam_in_space.rotating_beam import RotatingBeam
from beamdyn.equations.effects import check_direction
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.equations.root_motion import RootMotion
from beamdyn.modes.modal.equilibrium import Branch
from beamdyn.modes.modal.model import ModalBasis, Model, reduce_to_modes
from beamdyn.scene.motion import Motion
from beamdyn.transient.system import ModalSystem

_STEP = 1e-5  # relative step of finite differences: the tangent only guides Newton's method


class DriveInSpace(NamedTuple):
    """Motion of the root that drives the beam, at the s nodes of a step.

    Parameters
    ----------
    turning, turning_rate : ndarray, shape (..., 3, s)
        Angular velocity [rad/s] and acceleration [rad/s2] of the carrier.
    root : ndarray, shape (..., 3, s)
        Acceleration of the root [m/s2].
    """

    turning: np.ndarray
    turning_rate: np.ndarray
    root: np.ndarray

    def step(self, k: int) -> DriveInSpace:
        """Select the drive in one of several steps."""
        return DriveInSpace(*(values[k] for values in self))

    def node(self, k: int) -> DriveInSpace:
        """Select the drive at one node of a step, s = 1."""
        return DriveInSpace(*(values[..., [k]] for values in self))

    @property
    def carrier(self) -> Carrier:
        """Motion of the carrier at the nodes of the step."""
        return Carrier(*(values.swapaxes(-1, -2) for values in self))


class Evaluated(Protocol):
    """Equations evaluated at s sets of coordinates, rates and accelerations, with their derivatives."""

    @property
    def residual(self) -> np.ndarray:
        """Residual of the equations of motion, shape (s, n)."""
        ...

    @property
    def elastic(self) -> np.ndarray:
        """Elastic force, shape (s, n)."""
        ...

    @property
    def mass(self) -> np.ndarray:
        """Derivative of the residual by the accelerations, shape (s or 1, n, n)."""
        ...

    @property
    def damping(self) -> np.ndarray:
        """Derivative of the residual by the rates, shape (s or 1, n, n)."""
        ...

    @property
    def stiffness(self) -> np.ndarray:
        """Derivative of the residual by the coordinates, shape (s or 1, n, n)."""
        ...


@dataclass(frozen=True)
class BeamInSpaceSystem:
    """Equations of motion of a beam that bends by any amount in space, at arrays of times.

    Parameters
    ----------
    elastica : RotatingBeam
        Equations of motion in modal coordinates.
    motion : Motion
        Motion of the root.
    branch : {"straight", "bent"}
        Branch of the equilibrium in which a run begins, if it is to begin in equilibrium.
    """

    elastica: RotatingBeam
    motion: Motion
    branch: Branch = "straight"

    @classmethod
    def of_model(cls, model: Model, basis: ModalBasis, motion: Motion) -> Self:
        """Build the equations of a model for large deflection in the coordinates of a modal basis."""
        bends = model.scene.bends_in_space
        modal = reduce_to_modes(model.bent.about_straight if bends else model.equations, basis)
        return cls(model.bent.reduced(modal), motion, model.scene.physics.branch)

    @property
    def equations(self) -> Equations:
        """Equations in the same coordinates, linear about the straight beam."""
        return self.elastica.linear

    @property
    def size(self) -> int:
        """Number n of coordinates."""
        return self.elastica.size

    @cached_property
    def straight(self) -> ModalSystem:
        """Equations of motion in the same coordinates, linear about the straight beam."""
        return ModalSystem(self.equations, self.motion)

    def root(self, t: np.ndarray) -> RootMotion:
        """Compute the motion of the root at times t [s]."""
        return self.equations.root(self.motion.at(t))

    def surface(self, q: np.ndarray, xi: np.ndarray, eta: np.ndarray) -> np.ndarray:
        """Compute the deflection [m] over a strip of rigid sections at xi (k,) and eta (l,): (T, k, l)."""
        return np.repeat(self.shape(q, xi)[:, :, None], len(eta), axis=2)

    def at(self, drive: Any, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> Evaluated:
        """Evaluate the equations at coordinates, rates and accelerations (s, n) under a drive (s,)."""
        return self.evaluate(drive, np.stack([q, v, a]))

    def rhs(self, t: float, y: np.ndarray) -> np.ndarray:
        """Compute y' for y = (q, q'), as `solve_ivp` calls it."""
        q, v = np.split(y, 2)
        return np.concatenate([v, self._acceleration(t, q, v)])

    def _acceleration(self, t: float, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Compute the accelerations (n,) at a time [s]."""
        here = self.at(self.drive(self.root(np.array([t]))), q[None], v[None], np.zeros((1, self.size)))
        return np.linalg.solve(here.mass[0], -here.residual[0])

    def jacobian(self, t: float, y: np.ndarray) -> np.ndarray:
        """Compute the Jacobian of y' with respect to y, shape (2 n, 2 n)."""
        n = self.size
        q, v = np.split(y, 2)
        drive = self.drive(self.root(np.array([t])))
        here = self.at(drive, q[None], v[None], self._acceleration(t, q, v)[None])
        J = np.zeros((2 * n, 2 * n))
        J[:n, n:] = np.eye(n)
        J[n:] = -np.linalg.solve(here.mass[0], np.hstack([here.stiffness[0], here.damping[0]]))
        return J

    # Outputs of the system ----------------------------------------------------------------------------

    @cached_property
    def _unloaded(self) -> np.ndarray:
        """Derivatives (3, N) of the unloaded axis' position by the arc length."""
        return self.elastica.beam.at(np.zeros(self.size)).tangents

    def deflections(self, q: np.ndarray) -> np.ndarray:
        """Compute the deflection of the tip [m] at coordinates q (..., n): shape (..., 1 or 2)."""
        moved = self.elastica.beam.at(q).tangents - self._unloaded
        stations = self.elastica.beam.stations
        return stations.length * (moved @ stations.quadrature.weights)[..., 1 : 1 + self.equations.planes]

    def shape(self, q: np.ndarray, xi: np.ndarray, direction: int = 0) -> np.ndarray:
        """Compute the deflection [m] at positions xi = x/L (k,) and coordinates q (T, n): shape (T, k)."""
        moved = (self.elastica.beam.at(q).tangents - self._unloaded)[..., 1 + check_direction(direction), :]
        stations = self.elastica.beam.stations
        return stations.length * moved @ stations.quadrature.integrate_to(np.asarray(xi)).T

    def energy(self, t: np.ndarray, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Compute the energy [J] at times t (T,): kinetic in rotating axes, elastic, and of the root.

        The last is the potential of the centrifugal forces and of the acceleration of the root (an
        angular acceleration has none); it is 0 for the unloaded beam.
        """
        carrier = Carrier.of_root(self.elastica.axis, self.root(t))
        moving, rest = (self.moving(k * q, k * v, carrier) for k in (1.0, 0.0))
        return moving.energy - rest.energy

    # Evaluation of the equations ----------------------------------------------------------------------

    def drive(self, root: RootMotion) -> Any:
        """Compute the quantities of the root's motion that drive the equations."""
        carrier = Carrier.of_root(self.elastica.axis, root)
        return DriveInSpace(*(values.swapaxes(-1, -2) for values in vars(carrier).values()))

    def evaluate(self, drive: Any, motion: np.ndarray) -> Any:
        """Evaluate the equations at coordinates, rates and accelerations (3, s, n) under a drive (s,).

        The result has the attributes of `Evaluated`.
        """
        return EvaluationInSpace(self, drive, motion)

    def residual(self, drive: DriveInSpace, motion: np.ndarray) -> np.ndarray:
        """Compute the residual of the equations of motion, shape (s, n)."""
        q, v, a = motion
        return self.moving(q, v, drive.carrier).residual(a)

    def moving(self, q: np.ndarray, v: np.ndarray, carrier: Carrier) -> MovingBeam:
        """Return the beam at coordinates and rates (..., n) on a carrier."""
        return MovingBeam(self.elastica.beam.at(q), v, carrier, self.elastica.load)


AnySystem: TypeAlias = ModalSystem | BeamInSpaceSystem


@dataclass(frozen=True)
class EvaluationInSpace:
    """The equations at s sets of coordinates, rates and accelerations: residual and derivatives.

    Parameters
    ----------
    system : BeamInSpaceSystem
        The equations.
    drive : DriveInSpace
        Motion of the root, of shape (s,).
    motion : ndarray, shape (3, s, n)
        Coordinates, their rates and accelerations.
    """

    system: BeamInSpaceSystem
    drive: DriveInSpace
    motion: np.ndarray

    @cached_property
    def elastic(self) -> np.ndarray:
        """Elastic force, shape (s, n)."""
        return self.motion[0] @ self.system.elastica.stiffness

    @cached_property
    def residual(self) -> np.ndarray:
        """Residual of the equations of motion, shape (s, n)."""
        return self.system.residual(self.drive, self.motion)

    @cached_property
    def _tangents(self) -> np.ndarray:
        """Derivatives (3, s, n, n) of the residual by coordinates, rates and accelerations."""
        (q, v, a), n, moving = self.motion, self.system.size, self.system.moving
        step = _STEP * (np.abs(self.motion).max(axis=(1, 2)) + 1 / np.abs(self.system.elastica.angles).max())
        steps, still = step[:, None, None, None] * np.eye(n)[:, None], np.zeros((n, 1, n))
        moved = moving(q + steps[0], v + still, self.drive.carrier).residual(a + still)
        # The shape does not change with rates and accelerations, and is computed once for both.
        rates, accelerations = np.concatenate([steps[1], still]), np.concatenate([still, steps[2]])
        at_same = moving(q, v + rates, self.drive.carrier).residual(a + accelerations)
        change = np.concatenate([moved, at_same]).reshape(3, n, *q.shape) - self.residual
        return np.moveaxis(change, 1, 3) / step[:, None, None, None]

    @property
    def stiffness(self) -> np.ndarray:
        """Derivative of the residual by the coordinates (s, n, n), accurate enough for Newton's method."""
        return self._tangents[0]

    @property
    def damping(self) -> np.ndarray:
        """Derivative of the residual by the rates, shape (s, n, n)."""
        return self._tangents[1]

    @property
    def mass(self) -> np.ndarray:
        """Derivative of the residual by the accelerations, shape (s, n, n)."""
        return self._tangents[2]
