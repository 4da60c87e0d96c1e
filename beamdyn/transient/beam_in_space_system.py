"""Equations of motion of a beam in large three-dimensional bending, in modal coordinates, at given times.

In shapes of arrays, n counts coordinates, T times, N Gauss points, k positions along the beam, and l across
it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Self, TypeAlias

import numpy as np

from beamdyn.equations.beam_in_space.moving_beam import Carrier, MovingBeam
from beamdyn.equations.beam_in_space.rotating_beam import RotatingBeam
from beamdyn.equations.effects import check_direction
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.equations.root_motion import RootMotion
from beamdyn.modes.modal.equilibrium import Branch
from beamdyn.modes.modal.model import ModalBasis, Model, reduce_to_modes
from beamdyn.scene.motion.base import Motion
from beamdyn.transient.system import ModalSystem

_STEP = 1e-7  # relative step of finite differences with respect to the coordinates


@dataclass(frozen=True)
class BeamInSpaceSystem:
    """Equations of motion of a beam in large three-dimensional bending, evaluated at arrays of times.

    Parameters
    ----------
    elastica : RotatingBeam
        Equations of motion in modal coordinates.
    motion : Motion
        Motion of the root.
    branch : {"straight", "bent"}
        Equilibrium from which a run in equilibrium starts: the one continued from rest as the speed rises, or
        ("bent") another one that exists besides it.
    """

    elastica: RotatingBeam
    motion: Motion
    branch: Branch = "straight"

    @classmethod
    def of_model(cls, model: Model, basis: ModalBasis, motion: Motion) -> Self:
        """Build the equations of a model with large deflection, in the coordinates of a modal basis."""
        modal = reduce_to_modes(model.bent.about_straight, basis)
        return cls(model.bent.reduced(modal), motion, model.scene.physics.branch)

    @property
    def equations(self) -> Equations:
        """Equations of motion in the same modal coordinates, linearized about the straight beam."""
        return self.elastica.linear

    @property
    def size(self) -> int:
        """Number n of coordinates."""
        return self.elastica.beam.size

    @cached_property
    def straight(self) -> ModalSystem:
        """The linearized `equations` with the motion of the root, to be evaluated at arrays of times."""
        return ModalSystem(self.equations, self.motion)

    def root(self, t: np.ndarray) -> RootMotion:
        """Compute the motion of the root at times t [s]."""
        return self.equations.root(self.motion.at(t))

    def surface(self, q: np.ndarray, xi: np.ndarray, eta: np.ndarray) -> np.ndarray:
        """Compute the deflection [m] of a strip at xi = x/L and eta = 2 y/width: (times, along, across)."""
        return np.repeat(self.shape(q, xi)[:, :, None], len(eta), axis=2)

    def carrier(self, root: RootMotion) -> Carrier:
        """Compute the motion of the carrier that drives the equations."""
        return Carrier.of_root(self.elastica.axis, root)

    def rhs(self, t: float, y: np.ndarray) -> np.ndarray:
        """Compute y' for y = (q, q'), with the arguments of a right-hand side for `solve_ivp`."""
        return np.concatenate([y[self.size :], self._acceleration(t, y)])

    def _acceleration(self, t: float, y: np.ndarray) -> np.ndarray:
        """Solve the equations of motion at a time [s] for the accelerations, which enter linearly."""
        q, v = np.split(y[None], 2, axis=1)
        a = self._steps(q)[2] * np.eye(self.size + 1, self.size, -1)
        still, *moved = self.residual(self.carrier(self.root(np.array([t]))), q, v + 0 * a, a)
        return a[1, 0] * np.linalg.solve((np.array(moved) - still).T, -still)

    def jacobian(self, t: float, y: np.ndarray) -> np.ndarray:
        """Compute the derivatives of y' with respect to y = (coordinates, velocities): a matrix."""
        q, v = np.split(y[None], 2, axis=1)
        motion = self.carrier(self.root(np.array([t]))), q, v, self._acceleration(t, y)[None]
        K, C, M = self.tangents(*motion, self.residual(*motion))[:, 0]
        return np.block([[np.zeros_like(M), np.eye(self.size)], [-np.linalg.solve(M, np.hstack([K, C]))]])

    # Deflections and energy ---------------------------------------------------------------------------

    @cached_property
    def _unloaded(self) -> np.ndarray:
        """Derivatives (3, points) of the undeformed axis' position with respect to the arc length."""
        return self.elastica.beam.at(np.zeros(self.size)).tangents

    def deflections(self, q: np.ndarray) -> np.ndarray:
        """Compute the deflection of the tip [m] at coordinates q: shape (..., 1 or 2)."""
        moved, stations = self.elastica.beam.at(q).tangents - self._unloaded, self.elastica.beam.stations
        return stations.length * (moved @ stations.quadrature.weights)[..., 1 : 1 + self.equations.planes]

    def shape(self, q: np.ndarray, xi: np.ndarray, direction: int = 0) -> np.ndarray:
        """Compute the deflection [m] at positions xi = x/L, for coordinates q at T times: (T, positions)."""
        moved = (self.elastica.beam.at(q).tangents - self._unloaded)[..., 1 + check_direction(direction), :]
        return self.elastica.beam.stations.to_places(np.asarray(xi), moved)

    def energy(self, t: np.ndarray, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Compute the energy [J] at times t: kinetic in the rotating frame, elastic, and root potential.

        The root potential is that of the centrifugal forces and of the root's linear acceleration (an angular
        acceleration has no potential); it is 0 for the undeformed beam.
        """
        carrier = self.carrier(self.root(t))
        return self._moving(carrier, q, v).energy - self._moving(carrier, 0 * q, 0 * v).energy

    # Evaluation of the equations ----------------------------------------------------------------------

    def _moving(self, carrier: Carrier, q: np.ndarray, v: np.ndarray) -> MovingBeam:
        """Build the beam with coordinates and rates on its moving carrier."""
        return MovingBeam(self.elastica.beam.at(q), v, carrier, self.elastica.load)

    def residual(self, carrier: Carrier, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        """Compute the residual of the equations of motion at s times: shape (..., s, coordinates).

        Rates v and accelerations a have the residual's shape; q may lack its leading axes.
        """
        return self._moving(carrier, q, v).residual(a)

    def _steps(self, q: np.ndarray) -> np.ndarray:
        """Choose finite-difference steps (3,) of coordinates, rates, accelerations, by the size of q."""
        # With a unit mass matrix at rest, stiffness entries are squared frequencies.
        fastest = np.sqrt(np.diag(self.elastica.beam.stiffness).max()) or 1.0
        size = np.abs(q).max() + 1 / np.abs(self.elastica.beam.angles).max()
        return size * np.array([_STEP, fastest, fastest**2])

    def tangents(
        self, carrier: Carrier, q: np.ndarray, v: np.ndarray, a: np.ndarray, residual: np.ndarray
    ) -> np.ndarray:
        """Compute derivatives of the residual at s times with respect to coordinates, rates, accelerations.

        Their shape is (3, s, n, n) for n coordinates.  They are computed by finite differences, which are
        exact for rates and accelerations: the residual is quadratic in the rates and linear in the
        accelerations.  For coordinates they are approximate, which suffices for Newton's method.
        """
        dq, dv, da = self._steps(q)[:, None, None, None] * np.eye(self.size)[:, None]
        still = np.zeros_like(dq)
        by_q = self.residual(carrier, q + dq, v + still, a + still) - residual
        rates, accelerations = np.concatenate([dv, -dv, still]), np.concatenate([still, still, da])
        # For unchanged coordinates, the rotations of the sections are computed only once.
        ahead, behind, by_a = np.split(self.residual(carrier, q, v + rates, a + accelerations), 3)
        changes = np.stack([by_q, (ahead - behind) / 2, by_a - residual])
        return np.moveaxis(changes, 1, 3) / self._steps(q)[:, None, None, None]


AnySystem: TypeAlias = ModalSystem | BeamInSpaceSystem
