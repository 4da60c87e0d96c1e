"""The inextensible elastica: a slender beam that bends by any angle in one plane.

The slope angle is theta(x) = sum q_k w_k'(x), with the functions w_k of bending of the discretization: to
first order in q, w = sum q_k w_k is the deflection, and the model the linear one.  A point stands at

    p(x) = int_0^x (cos theta, sin theta) dx

along the beam axis b1 and the direction of bending e.  With the acceleration a of p, virtual work gives

    K q + int rho A a . dp + int rho I (theta'' - c omega') dtheta + tilting = 0,
    a = p'' + 2 omega c (v', -u') + omega' c (v, -u) - omega^2 (u, c^2 v) + a_O,   p = (u, v),

with c the cosine of the bending angle: 1 or -1 in the plane of rotation, 0 out of it.  All integrals are
sums over the points of a Gauss rule, so that the equations follow from one discrete Lagrangian, and energy is
kept as well as in the exact equations.  Derivation: docs/conventions.md.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from beamdyn.common.results.read_only import FieldsOnly
from beamdyn.equations.discretization import ArcQuadrature, Discretization
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.equations.fields.field import Deflection, Load, Term
from beamdyn.equations.root_motion import Quantity, RootMotion
from beamdyn.scene.beam import TipMass
from beamdyn.scene.mount import aligned_cos_sin
from beamdyn.scene.scene import Scene

_BENDING = "bending"


@dataclass(frozen=True)
class MassPoints:
    """Masses along the beam: the N points of a Gauss rule, the centre of gravity of the tip body, k lumps.

    The angles that are given are those at the N points and at the tip: lumps have no moments of inertia.

    Parameters
    ----------
    quadrature : ArcQuadrature
        Integration along the beam.
    length, offset : float
        Length of the beam, and distance of the tip body's centre of gravity beyond it [m].
    lumps : ndarray, shape (k,)
        Positions x/L of the point masses of the beam.
    mass : ndarray, shape (N + 1 + k,)
        Masses [kg].
    inertia : ndarray, shape (N + 1,)
        Moments of inertia about the axis of bending [kg m2].
    tilting : ndarray, shape (N + 1,)
        Moments of inertia by which rotation resists a tilt out of its plane [kg m2].
    """

    quadrature: ArcQuadrature
    length: float
    offset: float
    lumps: np.ndarray
    mass: np.ndarray
    inertia: np.ndarray
    tilting: np.ndarray

    @property
    def xi(self) -> np.ndarray:
        """Positions x/L of the angles, shape (N + 1,)."""
        return np.append(self.quadrature.xi, 1.0)

    def tip(self, slopes: np.ndarray) -> np.ndarray:
        """Position (...) of the tip from cosines or sines (..., N + 1) of the angles [m]."""
        return slopes[..., :-1] @ (self.quadrature.weights * self.length)

    def positions(self, slopes: np.ndarray) -> np.ndarray:
        """Positions (..., N + 1 + k) of the masses from cosines or sines (..., N + 1) of the angles [m]."""
        positions = self.length * self.quadrature.integrate(slopes[..., :-1])
        positions[..., -1] += self.offset * slopes[..., -1]
        if not self.lumps.size:
            return positions
        return np.concatenate([positions, slopes[..., :-1] @ self._to_lumps.T], axis=-1)

    @cached_property
    def _to_lumps(self) -> np.ndarray:
        """Weights (k, N) of the integrals from the root to the lumps [m]."""
        return self.length * self.quadrature.integrate_to(self.lumps)

    def moments(self, forces: np.ndarray) -> np.ndarray:
        """Apply the transpose of `positions`: moments at the angles [N m] by forces (..., N + 1 + k) [N]."""
        forces, on_lumps = np.split(forces, [self.quadrature.xi.size + 1], axis=-1)
        along_beam = self.length * self.quadrature.transposed(forces)
        if self.lumps.size:
            along_beam += on_lumps @ self._to_lumps
        return np.concatenate([along_beam, self.offset * forces[..., -1:]], axis=-1)


def lump_mass(scene: Scene, quadrature: ArcQuadrature) -> MassPoints:
    """Lump the mass of a scene at the points of a quadrature, beside tip body and point masses."""
    beam, tip = scene.modelled_beam, scene.beam.tip or TipMass(0.0)
    lumps, lumped = beam.lumps
    weights, sections = quadrature.weights * beam.length, np.zeros_like(quadrature.weights)
    if beam.rotary_inertia is not None:
        sections = weights * beam.rotary_inertia(quadrature.xi)
    return MassPoints(
        quadrature,
        beam.length,
        tip.offset,
        lumps,
        mass=np.concatenate([weights * beam.mass_per_length(quadrature.xi), [tip.mass], lumped]),
        inertia=np.append(sections, tip.inertia),
        tilting=np.append(-sections, tip.inertia_about_bending_direction - tip.axial_inertia),
    )


@dataclass(frozen=True)
class NodalForces:
    """Forces along b1 and e on the masses [N], (..., N + 1 + k), and moments at the angles [N m]."""

    axial: np.ndarray
    transverse: np.ndarray
    moment: np.ndarray


@dataclass(frozen=True)
class Elastica(FieldsOnly):
    """Equations of motion of a beam that bends by any angle in one plane.

    Parameters
    ----------
    linear : Equations
        Equations of the same coordinates, linear about the straight beam: in trial functions, or in modal
        coordinates.
    points : MassPoints
        Masses along the beam.
    """

    linear: Equations
    points: MassPoints

    @property
    def length(self) -> float:
        """Length of the beam [m]."""
        return self.points.length

    @property
    def size(self) -> int:
        """Number n of coordinates."""
        return self.linear.size

    @property
    def about_straight(self) -> Equations:
        """Equations of small motions about the straight beam."""
        return self.linear

    @property
    def quantities(self) -> tuple[Quantity, ...]:
        """Quantities of the root's motion that load the beam."""
        return QUANTITIES

    @cached_property
    def in_plane(self) -> float:
        """Component c of the direction of bending in the plane of rotation: 1, -1 or 0."""
        return aligned_cos_sin(self.linear.mount.bending_angle)[0]

    @cached_property
    def angles(self) -> np.ndarray:
        """Slope angles at the mass points per coordinate, shape (n, N + 1) [1/m]."""
        return self.linear.deflection(self.points.xi, order=1) / self.length

    @cached_property
    def stiffness(self) -> np.ndarray:
        """Stiffness (n, n) of the beam and of the spring at its root."""
        return self.linear.matrices[0]["unity"]

    @cached_property
    def damping(self) -> np.ndarray:
        """Damping (n, n), that of the straight beam."""
        return self.linear.matrices[1].get("unity", np.zeros((self.size, self.size)))

    def reduced(self, basis: np.ndarray) -> Elastica:
        """Transform the equations to other coordinates: q = basis @ q_reduced, basis of shape (n, m)."""
        return replace(self, linear=self.linear.reduced({(_BENDING,): basis}))

    def at(self, q: np.ndarray) -> DeflectedState:
        """Positions of the beam at coordinates q of shape (..., n)."""
        theta = q @ self.angles
        return DeflectedState(self, q, np.cos(theta), np.sin(theta))

    def tip(self, q: np.ndarray) -> np.ndarray:
        """Position (..., 2) of the tip from the root, along b1 and e [m], at coordinates q (..., n)."""
        state = self.at(q)
        return np.stack([self.points.tip(state.cos), self.points.tip(state.sin)], axis=-1)

    def curvature(self, q: np.ndarray, xi: np.ndarray) -> np.ndarray:
        """Curvature (..., k) [1/m] at coordinates q (..., n) and x/L = xi of shape (k,)."""
        return q @ self.linear.deflection(xi, order=2) / self.length**2

    def tip_angle(self, q: np.ndarray) -> float:
        """Slope angle of the tip [rad] at coordinates q (n,)."""
        return float(q @ self.angles[:, -1])


def assemble_elastica(scene: Scene, discretization: Discretization, linear: Equations) -> Elastica:
    """Assemble the equations of a scene for large deflection, over those of the straight beam."""
    quadrature = ArcQuadrature(discretization.cells(scene.modelled_beam))
    return Elastica(linear, lump_mass(scene, quadrature))


@dataclass(frozen=True)
class DeflectedState:
    """The beam at given coordinates, or at several sets of them.

    Parameters
    ----------
    elastica : Elastica
        Equations of motion.
    q : ndarray, shape (..., n)
        Coordinates.
    cos, sin : ndarray, shape (..., N + 1)
        Cosine and sine of the slope angle at the mass points.
    """

    elastica: Elastica
    q: np.ndarray
    cos: np.ndarray
    sin: np.ndarray

    @cached_property
    def u(self) -> np.ndarray:
        """Positions of the masses along b1 (..., N + 1 + k) [m]."""
        return self.elastica.points.positions(self.cos)

    @cached_property
    def v(self) -> np.ndarray:
        """Positions of the masses along e (..., N + 1 + k) [m]."""
        return self.elastica.points.positions(self.sin)

    @cached_property
    def gradients(self) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of `u` and `v` by the coordinates, each (..., n, N + 1 + k)."""
        angles, points = self.elastica.angles, self.elastica.points
        return points.positions(-self.sin[..., None, :] * angles), points.positions(
            self.cos[..., None, :] * angles
        )

    def positions(self, xi: np.ndarray) -> np.ndarray:
        """Positions (k, 2) along b1 and e [m] at x/L = xi of shape (k,), for one set of coordinates."""
        points = self.elastica.points
        weights = points.length * points.quadrature.integrate_to(xi)
        return np.stack([weights @ self.cos[:-1], weights @ self.sin[:-1]], axis=-1)

    # What each quantity of the root's motion does to the mass points ----------------------------------

    def inertial_forces(self, quantity: Quantity) -> NodalForces:
        """Mass times acceleration per unit of a quantity that acts on the beam at rest on its carrier."""
        points, c = self.elastica.points, self.elastica.in_plane
        mass, none, unturned = points.mass, np.zeros_like(self.u), np.zeros_like(self.sin)
        if quantity == "speed_squared":
            tilting = (1 - c**2) * points.tilting * self.sin * self.cos
            return NodalForces(-mass * self.u, -(c**2) * mass * self.v, tilting)
        if quantity == "acceleration":
            return NodalForces(c * mass * self.v, -c * mass * self.u, unturned - c * points.inertia)
        if quantity == "root_axial":
            return NodalForces(none + mass, none, unturned)
        return NodalForces(none, none + mass, unturned)

    def generalized(self, forces: NodalForces) -> np.ndarray:
        """Generalized forces (..., n): the virtual work of nodal forces, per coordinate."""
        points = self.elastica.points
        by_forces = -self.sin * points.moments(forces.axial) + self.cos * points.moments(forces.transverse)
        return (by_forces + forces.moment) @ self.elastica.angles.T

    def inertia_of(self, quantity: Quantity) -> np.ndarray:
        """Generalized inertial force (..., n) per unit of a quantity."""
        return self.generalized(self.inertial_forces(quantity))

    def inertia(self, values: Mapping[Quantity, float]) -> np.ndarray:
        """Generalized inertial force (n,) under given values of the quantities."""
        each = (value * self.inertia_of(quantity) for quantity, value in values.items())
        return sum(each, np.zeros(self.elastica.size))

    def inertia_change(self, values: Mapping[Quantity, float]) -> np.ndarray:
        """Derivative (n, n) of `inertia` by the coordinates."""
        each = (value * self.stiffness_of(quantity) for quantity, value in values.items())
        return sum(each, np.zeros((self.elastica.size, self.elastica.size)))

    def work(self, q_rate: np.ndarray, q_acceleration: np.ndarray, root: RootMotion) -> np.ndarray:
        """Residual (..., n) of the equations of motion, for rates and accelerations of the shape of q."""
        elastica, points, c = self.elastica, self.elastica.points, self.elastica.in_plane
        turning, turned = q_rate @ elastica.angles, q_acceleration @ elastica.angles
        velocity = points.positions(-self.sin * turning), points.positions(self.cos * turning)
        relative = (
            points.positions(-self.sin * turned - self.cos * turning**2),
            points.positions(self.cos * turned - self.sin * turning**2),
        )
        coriolis = 2 * c * root.speed[..., None]
        forces = NodalForces(
            points.mass * (relative[0] + coriolis * velocity[1]),
            points.mass * (relative[1] - coriolis * velocity[0]),
            points.inertia * turned,
        )
        total = self.generalized(forces) + self.q @ elastica.stiffness + q_rate @ elastica.damping
        for quantity in QUANTITIES:
            total += getattr(root, quantity)[..., None] * self.inertia_of(quantity)
        return total

    # Linear equations about this state: for one set of coordinates ------------------------------------

    @cached_property
    def mass(self) -> np.ndarray:
        """Mass matrix (n, n)."""
        points, angles = self.elastica.points, self.elastica.angles
        U, V = self.gradients
        return (U * points.mass) @ U.T + (V * points.mass) @ V.T + (angles * points.inertia) @ angles.T

    @cached_property
    def gyroscopic(self) -> np.ndarray:
        """Gyroscopic matrix per speed (n, n)."""
        U, V = self.gradients
        half = (U * self.elastica.points.mass) @ V.T
        return 2 * self.elastica.in_plane * (half - half.T)

    def stiffness_of(self, quantity: Quantity) -> np.ndarray:
        """Derivative (n, n) of `inertia_of` by the coordinates."""
        elastica, points, c = self.elastica, self.elastica.points, self.elastica.in_plane
        angles, forces = elastica.angles, self.inertial_forces(quantity)
        along = -self.cos * points.moments(forces.axial) - self.sin * points.moments(forces.transverse)
        if quantity == "speed_squared":
            along = along + (1 - c**2) * points.tilting * (self.cos**2 - self.sin**2)
        geometric = (angles * along) @ angles.T
        if quantity == "speed_squared":
            U, V = self.gradients
            return geometric - (U * points.mass) @ U.T - c**2 * (V * points.mass) @ V.T
        if quantity == "acceleration":
            return geometric + self.gyroscopic / 2
        return geometric

    def linearized(self) -> Equations:
        """Equations of small motions about this state, the elastic force of which is among the loads."""
        linear, elastica, b = self.elastica.linear, self.elastica, _BENDING
        terms, loads = (
            [Term("mass", b, b, 2, self.mass)],
            [Load("elastic force", b, elastica.stiffness @ self.q, "unity", -1.0)],
        )
        if self.gyroscopic.any():
            terms.append(Term("Coriolis coupling", b, b, 1, self.gyroscopic, "speed"))
        terms += [t for t in linear.terms if t.quantity == "unity" and t.order < 2]
        for quantity in QUANTITIES:
            terms.append(Term(f"stiffness by {quantity}", b, b, 0, self.stiffness_of(quantity), quantity))
            loads.append(Load(f"load by {quantity}", b, self.inertia_of(quantity), quantity, -1.0))
        deflection = Deflection(
            DeflectedShapes(self),
            P=self.gradients[1] @ elastica.points.mass,
            Q=-self.inertia_of("acceleration") / (elastica.in_plane or 1.0),
            Q_across=np.zeros(elastica.size),
        )
        shape = replace(linear.shapes[b], matrix=np.eye(elastica.size))
        return replace(
            linear, terms=(*terms,), loads=(*loads,), deflections={b: deflection}, shapes={b: shape}
        )


QUANTITIES: tuple[Quantity, ...] = ("speed_squared", "acceleration", "root_axial", "root_transverse")


@dataclass(frozen=True)
class DeflectedShapes:
    """Changes of the deflection along e by the coordinates of a deflected beam, as functions of x/L.

    Parameters
    ----------
    state : DeflectedState
        The deflected beam.
    """

    state: DeflectedState

    @property
    def size(self) -> int:
        """Number of functions."""
        return self.state.elastica.size

    def end(self, order: int) -> np.ndarray:
        """Evaluate the `order`-th derivatives at the tip."""
        return self.evaluate(np.ones(1), order)[:, 0]

    def evaluate(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Evaluate the functions (order 0) or their derivatives by x/L (order 1) at xi (k,): shape (n, k)."""
        elastica, state, xi = self.state.elastica, self.state, np.asarray(xi, dtype=float)
        if order == 1:
            slopes = elastica.linear.deflection(xi, order=1)
            return np.cos(state.q @ slopes / elastica.length) * slopes
        if order:
            raise ValueError("only the deflection and its slope follow a deflected beam")
        rotated = state.cos[:-1] * elastica.angles[:, :-1] * elastica.length
        return rotated @ elastica.points.quadrature.integrate_to(xi).T
