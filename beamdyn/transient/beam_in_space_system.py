"""Equations of motion of a beam in space in modal coordinates, evaluated at times for the integrators."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from beamdyn.equations.beam_in_space.moving_beam import Carrier, MovingBeam
from beamdyn.equations.beam_in_space.rotating_beam import RotatingBeam
from beamdyn.equations.effects import check_direction
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.equations.root_motion import RootMotion
from beamdyn.modes.modal.equilibrium import Branch
from beamdyn.modes.modal.modal_basis import ModalBasis, reduce_to_modes
from beamdyn.modes.modal.model import Model
from beamdyn.scene.motion import Motion
from beamdyn.transient.elastica_system import BentSystem

_STEP = 1e-5  # of differences, over the size of a coordinate: the tangent only guides Newton's method


class DriveInSpace(NamedTuple):
    """Motion of the root as it drives the beam, at the nodes of a step.

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
        """The drive in one of several steps."""
        return DriveInSpace(*(values[k] for values in self))

    def node(self, k: int) -> DriveInSpace:
        """The drive at one node of a step alone, s = 1."""
        return DriveInSpace(*(values[..., [k]] for values in self))

    @property
    def carrier(self) -> Carrier:
        """The motion of the carrier at the nodes."""
        return Carrier(*(np.moveaxis(values, -1, -2) for values in self))


@dataclass(frozen=True)
class BeamInSpaceSystem(BentSystem):
    """Equations of motion of a beam that bends by any amount in space, at arrays of times.

    Parameters
    ----------
    elastica : RotatingBeam
        Equations of motion in modal coordinates.
    motion : Motion
        Motion of the root.
    branch : {"straight", "bent"}
        Equilibria of which a run begins with one, if it is to begin in equilibrium.
    """

    elastica: RotatingBeam
    motion: Motion
    branch: Branch = "straight"

    @classmethod
    def of_model(cls, model: Model, basis: ModalBasis, motion: Motion) -> BeamInSpaceSystem:
        """Equations of a model for large deflection in the coordinates of a modal basis."""
        assert model.in_space is not None
        modal = reduce_to_modes(model.in_space.about_straight, basis)
        return cls(model.in_space.reduced(modal), motion, model.scene.physics.branch)

    @property
    def equations(self) -> Equations:
        """Equations of the same coordinates, linear about the straight beam."""
        return self.elastica.linear

    # Outputs ------------------------------------------------------------------------------------------

    @cached_property
    def _unloaded(self) -> np.ndarray:
        """Derivatives (3, N) of the position of the unloaded axis."""
        return self.elastica.beam.at(np.zeros(self.size)).tangents

    def deflections(self, q: np.ndarray) -> np.ndarray:
        """Deflection of the tip [m] at coordinates q (..., n): shape (..., 1 or 2)."""
        moved = self.elastica.beam.at(q).tangents - self._unloaded
        stations = self.elastica.beam.stations
        return stations.length * (moved @ stations.quadrature.weights)[..., 1 : 1 + self.equations.planes]

    def shape(self, q: np.ndarray, xi: np.ndarray, direction: int = 0) -> np.ndarray:
        """Deflection [m] at positions xi = x/L (k,) and coordinates q (T, n): shape (T, k)."""
        moved = (self.elastica.beam.at(q).tangents - self._unloaded)[..., 1 + check_direction(direction), :]
        stations = self.elastica.beam.stations
        return stations.length * moved @ stations.quadrature.integrate_to(np.asarray(xi)).T

    def energy(self, t: np.ndarray, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Energy [J] at times t (T,): kinetic relative to the rotating axes, elastic, of the root's motion.

        The last is the potential of the centrifugal forces and of the acceleration of the root, which an
        angular acceleration has not; it is 0 where the beam is unloaded.
        """
        drive = self.drive(self.root(t))
        return self._moving(drive, q, v).energy - self._moving(drive, 0 * q, 0 * v).energy

    # Equations ----------------------------------------------------------------------------------------

    def drive(self, root: RootMotion) -> DriveInSpace:
        """Quantities of the root's motion as they enter the equations."""
        axis = self.elastica.axis[:, None]
        acceleration = [root.root_axial, root.root_transverse, root.root_across]
        return DriveInSpace(
            axis * root.speed[..., None, :],
            axis * root.acceleration[..., None, :],
            np.stack(acceleration, axis=-2),
        )

    def evaluate(self, drive: DriveInSpace, motion: np.ndarray) -> EvaluationInSpace:
        """Evaluate the equations at coordinates, rates and accelerations (3, s, n) under a drive (s,)."""
        return EvaluationInSpace(self, drive, motion)

    def _moving(self, drive: DriveInSpace, q: np.ndarray, v: np.ndarray) -> MovingBeam:
        return MovingBeam(self.elastica.beam.at(q), v, drive.carrier)

    def residual(self, drive: DriveInSpace, motion: np.ndarray) -> np.ndarray:
        """Residual of the equations of motion (s, n)."""
        q, v, a = motion
        return self._moving(drive, q, v).residual(a)


@dataclass(frozen=True)
class EvaluationInSpace:
    """The equations at s sets of coordinates, rates and accelerations: their residual and its derivatives.

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
        """Elastic force (s, n)."""
        return self.motion[0] @ self.system.elastica.stiffness

    @cached_property
    def residual(self) -> np.ndarray:
        """Residual of the equations of motion (s, n)."""
        return self.system.residual(self.drive, self.motion)

    @cached_property
    def _tangents(self) -> np.ndarray:
        """Derivatives (3, s, n, n) by coordinates, rates and accelerations."""
        (_, s, n), angles = self.motion.shape, self.system.elastica.angles
        step = _STEP * (np.abs(self.motion).max(axis=(1, 2)) + 1 / np.abs(angles).max())
        moved = np.broadcast_to(self.motion, (2, 3, n, 3, s, n)).copy()  # sign, of which, which; motion
        for k, i in np.ndindex(3, n):
            moved[:, k, i, k, :, i] += np.array([step[k], -step[k]])[:, None]
        drive = DriveInSpace(*(np.tile(values, 6 * n) for values in self.drive))
        motion = np.moveaxis(moved, 3, 0).reshape(3, -1, n)
        more, less = self.system.residual(drive, motion).reshape(2, 3, n, s, n)
        return np.moveaxis(more - less, 1, 3) / (2 * step)[:, None, None, None]

    @property
    def stiffness(self) -> np.ndarray:
        """Derivative by the coordinates (s, n, n), near enough for Newton's method."""
        return self._tangents[0]

    @property
    def damping(self) -> np.ndarray:
        """Derivative by the rates (s, n, n)."""
        return self._tangents[1]

    @property
    def mass(self) -> np.ndarray:
        """Derivative by the accelerations (s, n, n)."""
        return self._tangents[2]
