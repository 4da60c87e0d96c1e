"""Equations of motion for large deflection in modal coordinates, evaluated at times for the integrators.

They are those of `beamdyn.equations.elastica`, in the form in which they cost least.  Positions are sums over
the slope angles, p_i = sum_j P_ji (cos theta_j, sin theta_j), so that the mass enters by one matrix of the
angles, H = P m P': the forces are

    F = -sin theta (H X + a_1 g) + cos theta (H Y + a_2 g) + (moments of inertia),   g = P m,

with X, Y the changes along the beam of the acceleration along b1 and e, as seen from the ground.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple, Protocol, TypeAlias

import numpy as np

from beamdyn.equations.effects import check_direction
from beamdyn.equations.elastica import Elastica
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.equations.root_motion import RootMotion
from beamdyn.modes.modal.equilibrium import Branch
from beamdyn.modes.modal.modal_basis import ModalBasis
from beamdyn.modes.modal.model import Model
from beamdyn.scene.motion import Motion
from beamdyn.transient.system import ModalSystem


class Evaluated(Protocol):
    """Equations at s sets of coordinates, rates and accelerations; derivatives of each set, or of one."""

    @property
    def residual(self) -> np.ndarray:
        """Residual of the equations of motion (s, n)."""
        ...

    @property
    def elastic(self) -> np.ndarray:
        """Elastic force (s, n)."""
        ...

    @property
    def mass(self) -> np.ndarray:
        """Derivative by the accelerations (s or 1, n, n)."""
        ...

    @property
    def damping(self) -> np.ndarray:
        """Derivative by the rates (s or 1, n, n)."""
        ...

    @property
    def stiffness(self) -> np.ndarray:
        """Derivative by the coordinates (s or 1, n, n)."""
        ...


class BentSystem(ABC):
    """Base class of equations of motion of beams that bend by any amount, at arrays of times."""

    elastica: Any
    motion: Motion
    branch: Branch

    @property
    @abstractmethod
    def equations(self) -> Equations:
        """Equations of the same coordinates, linear about the straight beam."""

    @abstractmethod
    def deflections(self, q: np.ndarray) -> np.ndarray:
        """Deflections of the tip [m] at coordinates q (..., n): shape (..., directions)."""

    @abstractmethod
    def shape(self, q: np.ndarray, xi: np.ndarray, direction: int = 0) -> np.ndarray:
        """Deflection [m] at positions xi = x/L (k,) and coordinates q (T, n): shape (T, k)."""

    @abstractmethod
    def energy(self, t: np.ndarray, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Energy [J] at times t (T,), coordinates and rates (T, n)."""

    @abstractmethod
    def drive(self, root: RootMotion) -> Any:
        """Quantities of the root's motion as they enter the equations."""

    @abstractmethod
    def evaluate(self, drive: Any, motion: np.ndarray) -> Any:
        """Evaluate the equations at coordinates, rates and accelerations (3, s, n) under a drive (s,).

        What is returned has the attributes of `Evaluated`.
        """

    @property
    def size(self) -> int:
        """Number n of coordinates."""
        return self.elastica.size

    @cached_property
    def straight(self) -> ModalSystem:
        """Equations of motion of the same coordinates, linear about the straight beam."""
        return ModalSystem(self.equations, self.motion)

    def root(self, t: np.ndarray) -> RootMotion:
        """Motion of the root at times t [s]."""
        return self.equations.root(self.motion.at(t))

    def surface(self, q: np.ndarray, xi: np.ndarray, eta: np.ndarray) -> np.ndarray:
        """Deflection [m] over a strip, whose sections keep their shape, at xi (k,), eta (l,): (T, k, l)."""
        return np.repeat(self.shape(q, xi)[:, :, None], len(eta), axis=2)

    def at(self, drive: Any, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> Evaluated:
        """Evaluate the equations at coordinates, rates and accelerations (s, n) under a drive (s,)."""
        return self.evaluate(drive, np.stack([q, v, a]))

    def rhs(self, t: float, y: np.ndarray) -> np.ndarray:
        """Compute y' for y = (q, q'), as `solve_ivp` calls it."""
        q, v = np.split(y, 2)
        return np.concatenate([v, self._acceleration(t, q, v)])

    def _acceleration(self, t: float, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Accelerations (n,) at a time [s]."""
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


@dataclass(frozen=True)
class ElasticaSystem(BentSystem):
    """Equations of motion of a beam that bends by any angle, at arrays of times.

    Parameters
    ----------
    elastica : Elastica
        Equations of motion in modal coordinates.
    motion : Motion
        Motion of the root.
    branch : {"straight", "bent"}
        Equilibria of which a run begins with one, if it is to begin in equilibrium.
    """

    elastica: Elastica
    motion: Motion
    branch: Branch = "straight"

    @classmethod
    def of_model(cls, model: Model, basis: ModalBasis, motion: Motion) -> ElasticaSystem:
        """Equations of a model for large deflection in the coordinates of a modal basis."""
        assert model.elastica is not None
        elastica = Elastica(model.modal_equations(basis), model.elastica.points)
        return cls(elastica, motion, model.scene.physics.branch)

    @property
    def equations(self) -> Equations:
        """Equations of the same coordinates, linear about the straight beam."""
        return self.elastica.linear

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
        straight, c2 = points.positions(np.ones(len(points.xi))), elastica.in_plane**2
        by_speed = (shortening * (2 * straight + shortening) + c2 * across**2) @ points.mass
        by_speed -= (1 - c2) * sin**2 @ points.tilting
        by_root = root.root_axial * (shortening @ points.mass) + root.root_transverse * (across @ points.mass)
        elastic = np.einsum("ti,ij,tj->t", q, elastica.stiffness, q)
        return (kinetic + elastic - root.speed_squared * by_speed) / 2 + by_root

    # Equations ----------------------------------------------------------------------------------------

    @cached_property
    def kernel(self) -> np.ndarray:
        """Matrix H (N + 1, N + 1) of the mass, by the slope angles [kg m2]."""
        points = self.elastica.points
        positions = points.positions(np.eye(len(points.xi)))
        return (positions * points.mass) @ positions.T

    @cached_property
    def kernel_and_moments(self) -> np.ndarray:
        """-H, as X and Y are summed with the other sign, and in a further row the moments: (N + 2, N + 1).

        The moments g [kg m] are those at the slope angles under a unit acceleration.
        """
        points = self.elastica.points
        return np.vstack([-self.kernel, points.moments(points.mass)])

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
            turning=c * np.stack([root.speed, root.acceleration], axis=-2),
            squared=root.speed_squared,
            root=np.stack([root.root_axial, root.root_transverse], axis=-2),
        )

    def evaluate(self, drive: Drive, motion: np.ndarray) -> Evaluation:
        """Evaluate the equations at coordinates, rates and accelerations (3, s, n) under a drive (s,)."""
        return Evaluation(self, drive, motion)


AnySystem: TypeAlias = ModalSystem | BentSystem


class Drive(NamedTuple):
    """Motion of the root as it drives the beam, at the nodes of a step.

    Parameters
    ----------
    turning : ndarray, shape (..., 2, s)
        c omega [rad/s] and c omega' [rad/s2]: turning of the axes in the plane of bending, negative.
    squared : ndarray, shape (..., s)
        omega^2 [rad2/s2].
    root : ndarray, shape (..., 2, s)
        Acceleration of the root along b1 and e [m/s2].
    """

    turning: np.ndarray
    squared: np.ndarray
    root: np.ndarray

    def step(self, k: int) -> Drive:
        """The drive in one of several steps."""
        return Drive(*(values[k] for values in self))

    def node(self, k: int) -> Drive:
        """The drive at one node of a step alone, s = 1."""
        return Drive(*(values[..., [k]] for values in self))


class Evaluation:
    """The equations at s sets of coordinates, rates and accelerations: their residual and its derivatives.

    Integrators ask for the residual a million times, of arrays so small that the number of operations counts.
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
        """Squared speed (s, 1) in so far as the beam bends out of the plane of rotation [rad2/s2]."""
        return self.system.out_of_plane * self.drive.squared[:, None]

    @cached_property
    def elastic(self) -> np.ndarray:
        """Elastic force (s, n)."""
        return self.q.dot(self.system.elastica.stiffness)

    @property
    def residual(self) -> np.ndarray:
        """Residual of the equations of motion (s, n)."""
        elastica = self.system.elastica
        by_angle = self.cos * self.across - self.sin * self.along
        if self.system.has_inertia:
            by_angle += self.turned * elastica.points.inertia
        if self.system.out_of_plane:
            by_angle += self._softening * elastica.points.tilting * self.cos * self.sin
        total = by_angle.dot(self.system.slopes) + self.elastic
        return total + self.v.dot(elastica.damping) if self.system.is_damped else total

    @cached_property
    def _levers(self) -> np.ndarray:
        """Moments by the coordinates of forces along b1, then of those along e: (s, n, 2 (N + 1))."""
        angles, kernel = self.system.elastica.angles, self.system.kernel
        turned = np.stack([-self.sin, self.cos], axis=1)[:, None] * angles[:, None]
        return turned.dot(kernel).reshape(len(self.q), len(angles), -1)

    def _derivative(self, along: np.ndarray, across: np.ndarray) -> np.ndarray:
        """Derivative (s, n, n) of the moments from those of X and Y by the angles (s, N + 1)."""
        changes = np.stack([along, across], axis=1)[..., None] * self.system.slopes
        return self._levers @ changes.reshape(len(self.q), -1, self.system.size)

    @cached_property
    def mass(self) -> np.ndarray:
        """Derivative by the accelerations (s, n, n)."""
        angles, inertia = self.system.elastica.angles, self.system.elastica.points.inertia
        return self._derivative(-self.sin, self.cos) + (angles * inertia) @ angles.T

    @cached_property
    def damping(self) -> np.ndarray:
        """Derivative by the rates (s, n, n)."""
        rate = -2 * self.turning
        return self._derivative(rate * self.cos, rate * self.sin) + self.system.elastica.damping

    @cached_property
    def stiffness(self) -> np.ndarray:
        """Derivative by the coordinates (s, n, n)."""
        system, angles, softening = self.system, self.system.elastica.angles, self._softening
        along = (self.squared + softening) * self.sin - self.turned * self.cos
        across = -self.squared * self.cos - self.turned * self.sin
        by_angle = -self.cos * self.along - self.sin * self.across
        by_angle += softening * system.elastica.points.tilting * (self.cos**2 - self.sin**2)
        geometric = (by_angle[:, None] * angles) @ angles.T
        return self._derivative(along, across) + geometric + system.elastica.stiffness
