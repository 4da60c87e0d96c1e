"""Equations of motion for large deflection in one plane, in modal coordinates, for the integrators.

The equations are those of the beam in space with one curvature, in their cheapest form.  The positions p_i of
masses m_i are sums over the slope angles theta_j, p_i = sum_j P_ji (cos theta_j, sin theta_j), so that the
mass enters by one matrix H = P m P'.  The generalized forces on the angles are

    F = -sin theta (H X + a_1 g) + cos theta (H Y + a_2 g) + (moments of inertia),   g = P m,

with the root's acceleration a_1, a_2 along b1 (the beam's axis at the root) and e (the direction of bending),
and the second time derivatives X, Y of (cos theta, sin theta) in these directions, as seen from the ground.
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np

from beamdyn.equations.effects import check_direction
from beamdyn.equations.root_motion import RootMotion
from beamdyn.scene.mount import aligned_cos_sin
from beamdyn.transient.beam_in_space_system import BeamInSpaceSystem


class ElasticaSystem(BeamInSpaceSystem):
    """Equations of motion of a straight inextensible beam that bends by any angle in one plane.

    Integrators evaluate them a million times: in one plane this takes a tenth of the time in space.
    """

    # Outputs of the system ----------------------------------------------------------------------------

    def deflections(self, q: np.ndarray) -> np.ndarray:
        """Compute the deflection of the tip along e [m] at coordinates q (..., n): shape (..., 1)."""
        return self.shape(q.reshape(-1, self.size), np.ones(1)).reshape(*q.shape[:-1], 1)

    def shape(self, q: np.ndarray, xi: np.ndarray, direction: int = 0) -> np.ndarray:
        """Compute the deflection [m] at positions xi = x/L (k,) and coordinates q (T, n): shape (T, k)."""
        if check_direction(direction):
            return np.zeros((len(q), len(xi)))
        stations, slopes = self.elastica.beam.stations, np.sin(q @ self.elastica.angles)[..., :-1]
        return stations.length * slopes @ stations.quadrature.integrate_to(np.asarray(xi)).T

    # Evaluation of the equations ----------------------------------------------------------------------

    @cached_property
    def in_plane(self) -> float:
        """Component c of the direction of bending in the plane of rotation: 1, -1 or 0."""
        return aligned_cos_sin(self.equations.mount.bending_angle)[0]

    @cached_property
    def positions(self) -> np.ndarray:
        """Matrix P (N + 1, N + 1 + k): positions of the masses [m] per cosine or sine of each angle."""
        stations, masses = self.elastica.beam.stations, self.elastica.beam.masses
        positions = np.zeros((stations.sections, stations.count))
        positions[:-1] = stations.to_all(np.eye(stations.sections - 1))
        positions[:, : stations.sections] += np.diag(masses.centre[0])
        return positions

    @cached_property
    def kernel(self) -> np.ndarray:
        """Mass matrix (N + 1, N + 1) over the slope angles [kg m2]."""
        return (self.positions * self.elastica.beam.masses.mass) @ self.positions.T

    @cached_property
    def inertia(self) -> np.ndarray:
        """Moments of inertia about the axis of bending (N + 1,) [kg m2]."""
        return self.elastica.beam.masses.inertia[2, 2]

    @cached_property
    def tilting(self) -> np.ndarray:
        """Moments of inertia (N + 1,) by which rotation resists a tilt out of its plane [kg m2]."""
        principal = self.elastica.beam.masses.inertia
        return principal[1, 1] - principal[0, 0]

    @cached_property
    def kernel_and_moments(self) -> np.ndarray:
        """Matrix (N + 2, N + 1): the negative mass matrix `kernel`, and below it a row of moments.

        The moments [kg m] act at the slope angles under a unit acceleration of the root.
        """
        return np.vstack([-self.kernel, self.positions @ self.elastica.beam.masses.mass])

    @cached_property
    def out_of_plane(self) -> float:
        """Factor: 1 where the beam bends out of the plane of rotation, 0 where it bends in that plane."""
        return 1 - self.in_plane**2

    @cached_property
    def has_inertia(self) -> bool:
        """Whether sections or the tip body have moments of inertia."""
        return bool(self.inertia.any())

    @cached_property
    def is_damped(self) -> bool:
        """Whether the beam is damped."""
        return bool(self.elastica.beam.damping.any())

    @cached_property
    def slopes(self) -> np.ndarray:
        """Slope angles per coordinate, shape (N + 1, n) [1/m]."""
        return np.ascontiguousarray(self.elastica.angles.T)

    def drive(self, root: RootMotion) -> Drive:
        """Compute the quantities of the root's motion that drive the equations."""
        c = self.in_plane
        return Drive(
            turning=c * np.stack([root.speed, root.acceleration], axis=-2),
            squared=root.speed_squared,
            root=np.stack([root.root_axial, root.root_transverse], axis=-2),
        )

    def evaluate(self, drive: Drive, motion: np.ndarray) -> Evaluation:
        """Evaluate the equations at coordinates, rates and accelerations (3, s, n) under a drive (s,)."""
        return Evaluation(self, drive, motion)


class Drive(NamedTuple):
    """Motion of the root that drives the beam, at the nodes of a step.

    Parameters
    ----------
    turning : ndarray, shape (..., 2, s)
        Negative rotation of the axes in the plane of bending, c omega [rad/s] and c omega' [rad/s2].
    squared : ndarray, shape (..., s)
        Squared speed omega^2 [rad2/s2].
    root : ndarray, shape (..., 2, s)
        Acceleration of the root along b1 and e [m/s2].
    """

    turning: np.ndarray
    squared: np.ndarray
    root: np.ndarray

    def step(self, k: int) -> Drive:
        """Select the drive in one of several steps."""
        return Drive(*(values[k] for values in self))

    def node(self, k: int) -> Drive:
        """Select the drive at one node of a step, s = 1."""
        return Drive(*(values[..., [k]] for values in self))


class Evaluation:
    """The equations at s sets of coordinates, rates and accelerations: residual and derivatives.

    Integrators evaluate the residual a million times, on small arrays, so that every operation counts.
    In the plane of rotation, rate and acceleration of an angle as seen from the ground, w and w', leave
    X = -w^2 cos theta - w' sin theta and Y = -w^2 sin theta + w' cos theta; out of it X has
    -omega^2 cos theta, too.

    Parameters
    ----------
    system : ElasticaSystem
        The equations.
    drive : Drive
        Motion of the root, of shape (s,).
    motion : ndarray, shape (3, s, n)
        Coordinates, their rates and accelerations.
    """

    def __init__(self, system: ElasticaSystem, drive: Drive, motion: np.ndarray) -> None:
        self.system, self.drive, (self.q, self.v, _) = system, drive, motion
        _, s, n = motion.shape
        angles = motion.reshape(-1, n).dot(system.elastica.angles).reshape(3, s, -1)
        angles[1:] -= drive.turning[..., None]
        theta, w, self.turned = angles
        self.cos, self.sin, self.squared = np.cos(theta), np.sin(theta), w * w
        self.turning = w
        changes = np.empty((2, s, len(system.kernel) + 1))
        changes[0, :, :-1] = self.cos * self.squared + self.sin * self.turned
        changes[1, :, :-1] = self.sin * self.squared - self.cos * self.turned
        if system.out_of_plane:
            changes[0, :, :-1] += self._softening * self.cos
        changes[..., -1] = drive.root
        along, across = changes.reshape(2 * s, -1).dot(system.kernel_and_moments).reshape(2, s, -1)
        self.along, self.across = along, across

    @property
    def _softening(self) -> np.ndarray:
        """Squared speed (s, 1) [rad2/s2] if the beam bends out of the plane of rotation, else 0."""
        return self.system.out_of_plane * self.drive.squared[:, None]

    @cached_property
    def elastic(self) -> np.ndarray:
        """Elastic force, shape (s, n)."""
        return self.q.dot(self.system.elastica.stiffness)

    @property
    def residual(self) -> np.ndarray:
        """Residual of the equations of motion, shape (s, n)."""
        elastica = self.system.elastica
        by_angle = self.cos * self.across - self.sin * self.along
        if self.system.has_inertia:
            by_angle += self.turned * self.system.inertia
        if self.system.out_of_plane:
            by_angle += self._softening * self.system.tilting * self.cos * self.sin
        total = by_angle.dot(self.system.slopes) + self.elastic
        return total + self.v.dot(elastica.beam.damping) if self.system.is_damped else total

    @cached_property
    def _levers(self) -> np.ndarray:
        """Lever arms: moments per coordinate by unit forces along b1, then e: (s, n, 2 (N + 1))."""
        angles, kernel = self.system.elastica.angles, self.system.kernel
        turned = np.stack([-self.sin, self.cos], axis=1)[:, None] * angles[:, None]
        return turned.dot(kernel).reshape(len(self.q), len(angles), -1)

    def _derivative(self, along: np.ndarray, across: np.ndarray) -> np.ndarray:
        """Compute the derivative (s, n, n) of the moments by the coordinates.

        The arguments (s, N + 1) are the derivatives by the angles of the sums along b1 and across.
        """
        changes = np.stack([along, across], axis=1)[..., None] * self.system.slopes
        return self._levers @ changes.reshape(len(self.q), -1, self.system.size)

    @cached_property
    def mass(self) -> np.ndarray:
        """Derivative of the residual by the accelerations, shape (s, n, n)."""
        angles, inertia = self.system.elastica.angles, self.system.inertia
        return self._derivative(-self.sin, self.cos) + (angles * inertia) @ angles.T

    @cached_property
    def damping(self) -> np.ndarray:
        """Derivative of the residual by the rates, shape (s, n, n)."""
        rate = -2 * self.turning
        return self._derivative(rate * self.cos, rate * self.sin) + self.system.elastica.beam.damping

    @cached_property
    def stiffness(self) -> np.ndarray:
        """Derivative of the residual by the coordinates, shape (s, n, n)."""
        system, angles, softening = self.system, self.system.elastica.angles, self._softening
        along = (self.squared + softening) * self.sin - self.turned * self.cos
        across = -self.squared * self.cos - self.turned * self.sin
        by_angle = -self.cos * self.along - self.sin * self.across
        by_angle += softening * system.tilting * (self.cos**2 - self.sin**2)
        geometric = (by_angle[:, None] * angles) @ angles.T
        return self._derivative(along, across) + geometric + system.elastica.stiffness
