"""Equations of motion for large deflection in modal coordinates, evaluated at times for the integrators.

They are those of `beamdyn.equations.elastica`, in the form in which they cost least.  Positions are sums over
the slope angles, p_i = sum_j P_ji (cos theta_j, sin theta_j), so that the mass enters by one matrix of the
angles, H = P m P': the forces are

    F = -sin theta (H X + a_1 g) + cos theta (H Y + a_2 g) + (moments of inertia),   g = P m,

with X, Y the changes along the beam of the acceleration along b1 and e, as seen from the ground.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

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
        """Energy [J] at times t (T,): kinetic relative to the rotating axes, elastic, of the root's motion.

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
    def out_of_plane(self) -> float:
        """1 where the beam bends out of the plane of rotation, 0 where it bends in it."""
        return 1 - self.elastica.in_plane**2

    @cached_property
    def has_inertia(self) -> bool:
        """Whether sections or the tip body have moments of inertia."""
        return bool(self.elastica.points.inertia.any())

    @cached_property
    def is_damped(self) -> bool:
        """Whether the beam is damped."""
        return bool(self.elastica.damping.any())

    @cached_property
    def slopes(self) -> np.ndarray:
        """Slope angles per coordinate, shape (N + 1, n) [1/m]."""
        return np.ascontiguousarray(self.elastica.angles.T)

    def drive(self, root: RootMotion) -> Drive:
        """Quantities of the root's motion as they enter the equations."""
        c = self.elastica.in_plane
        return Drive(
            coriolis=2 * c * root.speed,
            squared=root.speed_squared,
            euler=c * root.acceleration,
            root=root.root_axial + 1j * root.root_transverse,
        )

    def at(self, drive: Drive, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> Evaluation:
        """Evaluate the equations at coordinates, rates and accelerations (s, n) under a drive (s,)."""
        return Evaluation(self, drive, q, v, a)

    def rhs(self, t: float, y: np.ndarray) -> np.ndarray:
        """Compute y' for y = (q, q'), as `solve_ivp` calls it."""
        q, v = np.split(y, 2)
        return np.concatenate([v, self._acceleration(t, q, v)])

    def _acceleration(self, t: float, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        here = self.at(self.drive(self.root(np.array([t]))), q[None], v[None], np.zeros((1, self.size)))
        return np.linalg.solve(here.mass[0], -here.residual[0])

    def jacobian(self, t: float, y: np.ndarray) -> np.ndarray:
        """Jacobian of y' with respect to y, shape (2 n, 2 n)."""
        n = self.size
        q, v = np.split(y, 2)
        drive = self.drive(self.root(np.array([t])))
        here = self.at(drive, q[None], v[None], self._acceleration(t, q, v)[None])
        J = np.zeros((2 * n, 2 * n))
        J[:n, n:] = np.eye(n)
        J[n:] = -np.linalg.solve(here.mass[0], np.hstack([here.stiffness[0], here.damping[0]]))
        return J


class Drive(NamedTuple):
    """What the motion of the root does to the beam, at the nodes of a step: arrays of shape (..., s).

    Parameters
    ----------
    coriolis, squared, euler : ndarray
        2 c omega [rad/s], omega^2 [rad2/s2] and c omega' [rad/s2].
    root : ndarray of complex
        Acceleration of the root along b1, and i times that along e [m/s2].
    """

    coriolis: np.ndarray
    squared: np.ndarray
    euler: np.ndarray
    root: np.ndarray


class Evaluation:
    """The equations at s sets of coordinates, rates and accelerations: their residual and its derivatives.

    Vectors in the plane of bending are complex numbers, x + i y = exp(i theta) (along + i across).

    Parameters
    ----------
    system : ElasticaSystem
        The equations.
    drive : Drive
        Motion of the root, of shape (s,).
    q, v, a : ndarray, shape (s, n)
        Coordinates, their rates and accelerations.
    """

    def __init__(
        self, system: ElasticaSystem, drive: Drive, q: np.ndarray, v: np.ndarray, a: np.ndarray
    ) -> None:
        self.system, self.drive, self.q, self.v = system, drive, q, v
        s = len(q)
        angles = system.slopes.dot(np.concatenate([q, v, a]).T)
        self.cos, self.sin = np.cos(angles[:, :s]), np.sin(angles[:, :s])
        self.turning = angles[:, s : 2 * s]
        self.along = self.turning * (drive.coriolis - self.turning)
        self.across = angles[:, 2 * s :] - drive.euler
        self.axis = self.cos + 1j * self.sin
        acceleration = self.axis * (self.along - drive.squared + 1j * self.across)
        if system.out_of_plane:
            acceleration += 1j * system.out_of_plane * drive.squared * self.sin
        forces = system.kernel.dot(acceleration.view(float)).view(complex)
        forces += np.multiply.outer(system.moments, drive.root)
        turned = forces * np.conj(self.axis)
        self.force_along, self.force_across = np.real(turned), np.imag(turned)

    @property
    def residual(self) -> np.ndarray:
        """Residual of the equations of motion (s, n)."""
        elastica, by_angle = self.system.elastica, self.force_across
        if self.system.has_inertia:
            by_angle = by_angle + self.across * elastica.points.inertia[:, None]
        if self.system.out_of_plane:
            tilting = self.cos * self.sin * elastica.points.tilting[:, None]
            by_angle = by_angle + self.system.out_of_plane * self.drive.squared * tilting
        total = elastica.angles.dot(by_angle).T + self.q.dot(elastica.stiffness)
        return total + self.v.dot(elastica.damping) if self.system.is_damped else total

    @cached_property
    def _turned(self) -> np.ndarray:
        """Slopes by the coordinates, turned by a right angle: (s, N + 1, n)."""
        return 1j * self.axis.T[:, :, None] * self.system.slopes

    @cached_property
    def _weighted(self) -> np.ndarray:
        """The same times the kernel, conjugate and transposed: (s, n, N + 1)."""
        s, _, n = self._turned.shape
        columns = self._turned.transpose(1, 0, 2).reshape(-1, s * n)
        weighted = (self.system.kernel @ columns.view(float)).view(complex)
        return np.conj(weighted).reshape(-1, s, n).transpose(1, 2, 0)

    def _derivative(self, change: np.ndarray) -> np.ndarray:
        """Derivative (s, n, n) from that of the acceleration by the angles, complex (N + 1, s)."""
        return np.real(self._weighted @ (change.T[:, :, None] * self.system.slopes))

    @cached_property
    def mass(self) -> np.ndarray:
        """Derivative by the accelerations (s, n, n)."""
        angles, inertia = self.system.elastica.angles, self.system.elastica.points.inertia
        return self._derivative(1j * self.axis) + (angles * inertia) @ angles.T

    @cached_property
    def damping(self) -> np.ndarray:
        """Derivative by the rates (s, n, n)."""
        rate = self.drive.coriolis - 2 * self.turning
        return self._derivative(rate * self.axis) + self.system.elastica.damping

    @cached_property
    def stiffness(self) -> np.ndarray:
        """Derivative by the coordinates (s, n, n)."""
        system, angles = self.system, self.system.elastica.angles
        along = self.along - self.drive.squared
        change, by_angle = self.axis * (1j * along - self.across), -self.force_along
        if share := system.out_of_plane:
            change += 1j * share * self.drive.squared * self.cos
            tilting = system.elastica.points.tilting[:, None] * (self.cos**2 - self.sin**2)
            by_angle = by_angle + share * self.drive.squared * tilting
        return (
            self._derivative(change) + (by_angle.T[:, None] * angles) @ angles.T + system.elastica.stiffness
        )
