"""Equations of motion for large deflection in modal coordinates, evaluated at times for the integrators.

They are those of `beamdyn.equations.elastica`, in the form in which they cost least.  Positions are sums over
the slope angles, p_i = sum_j P_ji (cos theta_j, sin theta_j), so that the mass enters by one matrix of the
angles, H = P m P': the forces are

    F = -sin theta (H X + a_1 g) + cos theta (H Y + a_2 g) + (moments of inertia),   g = P m,

with X, Y the accelerations per length along b1 and e, without that of the root.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beamdyn.equations.directions import check_direction
from beamdyn.equations.elastica import Elastica
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.equations.root_motion import RootMotion
from beamdyn.modal.modal_basis import ModalBasis
from beamdyn.modal.model import Model
from beamdyn.scene.motion import Motion
from beamdyn.transient.system import ModalSystem


@dataclass(frozen=True)
class ElasticaSystem:
    """Equations of motion of a beam that bends by any angle, at arrays of times.

    Parameters
    ----------
    elastica : Elastica
        Equations of motion in modal coordinates.
    motion : Motion
        Motion of the root.
    """

    elastica: Elastica
    motion: Motion

    @classmethod
    def of_model(cls, model: Model, basis: ModalBasis, motion: Motion) -> ElasticaSystem:
        """Equations of a model for large deflection in the coordinates of a modal basis."""
        assert model.elastica is not None
        return cls(Elastica(model.modal_equations(basis), model.elastica.points), motion)

    @property
    def size(self) -> int:
        """Number n of coordinates."""
        return self.elastica.size

    @property
    def equations(self) -> Equations:
        """Equations of the same coordinates, linear about the straight beam."""
        return self.elastica.linear

    @cached_property
    def straight(self) -> ModalSystem:
        """The same system, linear about the straight beam."""
        return ModalSystem(self.equations, self.motion)

    def root(self, t: np.ndarray) -> RootMotion:
        """Motion of the root at times t [s]."""
        return self.equations.root(self.motion.at(t))

    # Outputs ------------------------------------------------------------------------------------------

    def deflections(self, q: np.ndarray) -> np.ndarray:
        """Deflection of the tip along e [m] at coordinates q (..., n): shape (..., 1)."""
        return self.elastica.points.tip(np.sin(q @ self.elastica.angles))[..., None]

    def shape(self, q: np.ndarray, xi: np.ndarray, direction: int = 0) -> np.ndarray:
        """Deflection [m] at positions xi = x/L (k,) and coordinates q (T, n): shape (T, k)."""
        if check_direction(direction):
            return np.zeros((len(q), len(xi)))
        points = self.elastica.points
        slopes = np.sin(q @ self.elastica.angles)[..., :-1]
        return points.length * slopes @ points.quadrature.integrate_to(np.asarray(xi)).T

    def energy(self, t: np.ndarray, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Energy [J] at times t (T,): kinetic relative to the rotating axes, elastic, and of the root's motion.

        The last is the potential of the centrifugal forces and of the acceleration of the root, which an
        angular acceleration has not.
        """
        elastica, points, root = self.elastica, self.elastica.points, self.root(t)
        theta, turning = q @ elastica.angles, v @ elastica.angles
        cos, sin = np.cos(theta), np.sin(theta)
        velocity = points.positions(-sin * turning), points.positions(cos * turning)
        kinetic = (velocity[0] ** 2 + velocity[1] ** 2) @ points.mass + turning**2 @ points.inertia
        shortening, across = points.positions(-2 * np.sin(theta / 2) ** 2), points.positions(sin)
        straight, c2 = points.positions(np.ones(len(points.mass))), elastica.in_plane**2
        by_speed = (shortening * (2 * straight + shortening) + c2 * across**2) @ points.mass
        by_speed -= (1 - c2) * sin**2 @ points.tilting
        by_root = root.root_axial * (shortening @ points.mass) + root.root_transverse * (across @ points.mass)
        elastic = np.einsum("ti,ij,tj->t", q, elastica.stiffness, q)
        return (kinetic + elastic - root.speed_squared * by_speed) / 2 + by_root

    # Equations ----------------------------------------------------------------------------------------

    @cached_property
    def kernel(self) -> np.ndarray:
        """Matrix H (N + 1, N + 1) of the mass, by the slope angles [kg m2]."""
        positions = self.elastica.points.positions(np.eye(len(self.elastica.points.mass)))
        return (positions * self.elastica.points.mass) @ positions.T

    @cached_property
    def moments(self) -> np.ndarray:
        """Moments g (N + 1,) at the slope angles under a unit acceleration [kg m]."""
        return self.elastica.points.moments(self.elastica.points.mass)

    @cached_property
    def _has_tilting(self) -> bool:
        return not self.elastica.in_plane and bool(self.elastica.points.tilting.any())

    @cached_property
    def _has_inertia(self) -> bool:
        return bool(self.elastica.points.inertia.any())

    def at(self, root: RootMotion, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> Evaluation:
        """Evaluate the equations at coordinates, rates and accelerations (s, n), with the root's motion (s,)."""
        return Evaluation(self, root, q, v, a)

    def rhs(self, t: float, y: np.ndarray) -> np.ndarray:
        """Compute y' for y = (q, q'), as `solve_ivp` calls it."""
        q, v = np.split(y, 2)
        return np.concatenate([v, self._acceleration(t, q, v)])

    def _acceleration(self, t: float, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        here = self.at(self.root(np.array([t])), q[None], v[None], np.zeros((1, self.size)))
        return np.linalg.solve(here.mass[0], -here.residual[0])

    def jacobian(self, t: float, y: np.ndarray) -> np.ndarray:
        """Jacobian of y' with respect to y, shape (2 n, 2 n)."""
        n = self.size
        q, v = np.split(y, 2)
        here = self.at(self.root(np.array([t])), q[None], v[None], self._acceleration(t, q, v)[None])
        J = np.zeros((2 * n, 2 * n))
        J[:n, n:] = np.eye(n)
        J[n:] = -np.linalg.solve(here.mass[0], np.hstack([here.stiffness[0], here.damping[0]]))
        return J


class Evaluation:
    """The equations at s sets of coordinates, rates and accelerations: their residual and its derivatives.

    Parameters
    ----------
    system : ElasticaSystem
        The equations.
    root : RootMotion
        Motion of the root, quantities of shape (s,).
    q, v, a : ndarray, shape (s, n)
        Coordinates, their rates and accelerations.
    """

    def __init__(
        self, system: ElasticaSystem, root: RootMotion, q: np.ndarray, v: np.ndarray, a: np.ndarray
    ) -> None:
        elastica, c = system.elastica, system.elastica.in_plane
        self.system, self.q, self.v = system, q, v
        theta, self.turning, self.turned = (
            np.concatenate([q, v, a]).dot(elastica.angles).reshape(3, len(q), -1)
        )
        self.cos, self.sin = np.cos(theta), np.sin(theta)
        self.squared, self.acceleration = root.speed_squared[:, None], root.acceleration[:, None]
        self.coriolis, self.euler = 2 * c * root.speed[:, None], c * self.acceleration
        # Terms along the bent axis (with cos in X, sin in Y) and across it (with -sin in X, cos in Y).
        self.along = self.turning * (self.coriolis - self.turning)
        X = (self.along - self.squared) * self.cos - (self.turned - self.euler) * self.sin
        Y = (self.along - c**2 * self.squared) * self.sin + (self.turned - self.euler) * self.cos
        self.forces = np.concatenate([X, Y]).dot(system.kernel).reshape(2, len(q), -1)
        self.forces[0] += root.root_axial[:, None] * system.moments
        self.forces[1] += root.root_transverse[:, None] * system.moments

    @property
    def residual(self) -> np.ndarray:
        """Residual of the equations of motion (s, n)."""
        system, elastica = self.system, self.system.elastica
        by_angle = self.cos * self.forces[1] - self.sin * self.forces[0]
        if system._has_inertia:
            by_angle += (self.turned - self.euler) * elastica.points.inertia
        if system._has_tilting:
            by_angle += self.squared * elastica.points.tilting * self.sin * self.cos
        total = by_angle.dot(elastica.angles.T) + self.q.dot(elastica.stiffness)
        return total + self.v.dot(elastica.damping)

    @cached_property
    def _weighted(self) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of the slopes along b1 and e by the coordinates, times the kernel: (s, n, N + 1)."""
        angles, kernel = self.system.elastica.angles, self.system.kernel
        return (-self.sin[:, None] * angles) @ kernel, (self.cos[:, None] * angles) @ kernel

    def _derivative(self, X: np.ndarray, Y: np.ndarray, by_angle: np.ndarray | None = None) -> np.ndarray:
        """Derivative (s, n, n) from those of X, Y and of the moments by the angles, each (s, N + 1)."""
        U, V = self._weighted
        angles = self.system.elastica.angles
        total = (U * X[:, None] + V * Y[:, None]) @ angles.T
        return total if by_angle is None else total + (angles * by_angle[:, None]) @ angles.T

    @cached_property
    def mass(self) -> np.ndarray:
        """Derivative by the accelerations (s, n, n)."""
        angles, inertia = self.system.elastica.angles, self.system.elastica.points.inertia
        return self._derivative(-self.sin, self.cos) + (angles * inertia) @ angles.T

    @cached_property
    def damping(self) -> np.ndarray:
        """Derivative by the rates (s, n, n)."""
        rate = self.coriolis - 2 * self.turning
        return self._derivative(rate * self.cos, rate * self.sin) + self.system.elastica.damping

    @cached_property
    def stiffness(self) -> np.ndarray:
        """Derivative by the coordinates (s, n, n)."""
        system, c = self.system, self.system.elastica.in_plane
        across = self.turned - self.euler
        X = -(self.along - self.squared) * self.sin - across * self.cos
        Y = (self.along - c**2 * self.squared) * self.cos - across * self.sin
        by_angle = -self.cos * self.forces[0] - self.sin * self.forces[1]
        if system._has_tilting:
            tilting = system.elastica.points.tilting
            by_angle = by_angle + self.squared * tilting * (self.cos**2 - self.sin**2)
        return self._derivative(X, Y, by_angle) + system.elastica.stiffness
