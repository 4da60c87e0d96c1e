"""The equations of motion, as a list of terms.

M q'' + C q' + K q = f for the coordinates of all fields.  Each matrix is a sum of terms
``factor * quantity(t) * matrix``, where the quantity is one of a few of the root's motion, so that
batches over speeds, harmonic balance and the dropping of terms all read the same list.

Derivation and conventions: docs/conventions.md.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import cos, sin
from typing import Literal

import numpy as np
import scipy.linalg

from beamdyn.equations.operators import Operators
from beamdyn.scene.motion import MotionSample
from beamdyn.scene.scene import Mount, Scene

Quantity = Literal["unity", "speed", "acceleration", "speed_squared", "root_axial", "root_transverse"]


@dataclass(frozen=True)
class RootMotion:
    """What the equations need of the motion of the beam's root; arrays of one shape.

    Parameters
    ----------
    unity : ndarray
        1.
    speed, acceleration, speed_squared : ndarray
        omega [rad/s], omega' [rad/s2] and omega^2 [rad2/s2].
    root_axial : ndarray
        Acceleration a_O1 of the root along the beam [m/s2], less gravity.
    root_transverse : ndarray
        Acceleration c a_O2 + s a_O3 of the root in the direction of bending [m/s2], less gravity.
    """

    unity: np.ndarray
    speed: np.ndarray
    acceleration: np.ndarray
    speed_squared: np.ndarray
    root_axial: np.ndarray
    root_transverse: np.ndarray


def root_motion(mount: Mount, sample: MotionSample, gravity: float = 0.0) -> RootMotion:
    """Motion of the beam's root from that of the carrier.

    Parameters
    ----------
    mount : Mount
        Radius r, setting angle phi and bending angle psi.
    sample : MotionSample
        Motion of the carrier.
    gravity : float
        Gravity along -n2 [m/s2].

    Returns
    -------
    RootMotion
    """
    cphi, sphi = _cos_sin(mount.setting_angle)
    cpsi, spsi = _cos_sin(mount.bending_angle)
    r, omega = mount.radius, sample.speed
    v1, v2, v3 = np.moveaxis(sample.carrier_acceleration, -1, 0)
    v2 = v2 + gravity
    radial = omega**2 * r + v1 * np.cos(sample.angle) - v2 * np.sin(sample.angle)
    tangential = v1 * np.sin(sample.angle) + v2 * np.cos(sample.angle) + sample.acceleration * r
    a1 = cphi * radial - sphi * tangential
    a2 = sphi * radial + cphi * tangential
    return RootMotion(
        unity=np.ones_like(omega),
        speed=omega,
        acceleration=sample.acceleration,
        speed_squared=omega**2,
        root_axial=a1,
        root_transverse=cpsi * a2 + spsi * v3,
    )


def _cos_sin(angle: float) -> tuple[float, float]:
    """Cosine and sine, 0 where the angle is the double nearest to a quarter turn."""
    c, s = cos(angle), sin(angle)
    return (0.0 if abs(c) < 2e-16 else c), (0.0 if abs(s) < 2e-16 else s)


@dataclass(frozen=True)
class Term:
    """One term of the left-hand side.

    Parameters
    ----------
    name : str
        What it is.
    rows, columns : str
        Fields whose equations it stands in, and whose coordinates it multiplies.
    order : int
        Which time derivative of the coordinates: 0 stiffness, 1 damping and gyroscopic, 2 mass.
    matrix : ndarray
        Its matrix.
    quantity : str
        Which quantity of the `RootMotion` multiplies it.
    factor : float
        A constant factor.
    """

    name: str
    rows: str
    columns: str
    order: int
    matrix: np.ndarray
    quantity: Quantity = "unity"
    factor: float = 1.0

    def coefficient(self, root: RootMotion) -> np.ndarray:
        """Its coefficient at the times of `root`."""
        return self.factor * getattr(root, self.quantity)


@dataclass(frozen=True)
class Load:
    """One term of the right-hand side: factor * quantity * vector in the equations of one field."""

    name: str
    rows: str
    vector: np.ndarray
    quantity: Quantity
    factor: float = 1.0

    def coefficient(self, root: RootMotion) -> np.ndarray:
        """Its coefficient at the times of `root`."""
        return self.factor * getattr(root, self.quantity)


@dataclass(frozen=True)
class SteadyPencil:
    """The equations at steady speed omega: M q'' + (C + omega G) q' + (K0 + omega^2 K2) q = omega^2 f2.

    Parameters
    ----------
    M, C, G, K0, K2 : ndarray, shape (n, n)
        Mass, damping, gyroscopic coupling per speed, stiffness at rest, stiffness per squared speed.
    f2 : ndarray, shape (n,)
        Static load per squared speed.
    """

    M: np.ndarray
    C: np.ndarray
    G: np.ndarray
    K0: np.ndarray
    K2: np.ndarray
    f2: np.ndarray

    def block(self, place: slice) -> SteadyPencil:
        """One field alone, without damping."""
        M, K0, K2 = (A[place, place] for A in (self.M, self.K0, self.K2))
        return SteadyPencil(M, np.zeros_like(M), np.zeros_like(M), K0, K2, self.f2[place])

    @property
    def conservative(self) -> bool:
        """Whether there is neither damping nor gyroscopic coupling."""
        return not (self.C.any() or self.G.any())


@dataclass(frozen=True)
class Equations:
    """Equations of motion of a scene in one discretization.

    Parameters
    ----------
    fields : dict of str to slice
        Places of the fields' coordinates ("bending", "stretch") in q.
    terms : tuple of Term
        Left-hand side.
    loads : tuple of Load
        Right-hand side.
    mount : Mount
        How the beam is mounted.
    gravity : float
        Gravity [m/s2].
    operators : Operators
        What the terms were made from.
    """

    fields: dict[str, slice]
    terms: tuple[Term, ...]
    loads: tuple[Load, ...]
    mount: Mount
    gravity: float
    operators: Operators

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return max(place.stop for place in self.fields.values())

    def root(self, sample: MotionSample) -> RootMotion:
        """Motion of the root from that of the carrier."""
        return root_motion(self.mount, sample, self.gravity)

    def matrix(self, order: int, root: RootMotion) -> np.ndarray:
        """Sum of the terms of one order: shape (..., n, n) over the shape of `root`."""
        total = np.zeros((*root.unity.shape, self.size, self.size))
        for term in self.terms:
            if term.order == order:
                place = (..., self.fields[term.rows], self.fields[term.columns])
                total[place] += term.coefficient(root)[..., None, None] * term.matrix
        return total

    def load(self, root: RootMotion) -> np.ndarray:
        """Right-hand side: shape (..., n) over the shape of `root`."""
        total = np.zeros((*root.unity.shape, self.size))
        for load in self.loads:
            total[..., self.fields[load.rows]] += load.coefficient(root)[..., None] * load.vector
        return total

    def reduced(self, vectors: dict[str, np.ndarray]) -> Equations:
        """The equations in fewer coordinates: for each field, q = vectors[field] @ q_reduced.

        Parameters
        ----------
        vectors : dict of str to ndarray, shape (n, m)
            Shapes kept of each field: its modes at rest, for instance.

        Returns
        -------
        Equations
        """
        places, start = {}, 0
        for name in self.fields:
            places[name] = slice(start, start + vectors[name].shape[1])
            start = places[name].stop
        terms = (replace(t, matrix=vectors[t.rows].T @ t.matrix @ vectors[t.columns]) for t in self.terms)
        loads = (replace(f, vector=vectors[f.rows].T @ f.vector) for f in self.loads)
        return replace(self, fields=places, terms=tuple(terms), loads=tuple(loads))

    def steady(self) -> SteadyPencil:
        """The equations as a pencil in the speed, about a fixed centre and without gravity."""
        rest, turning = (root_motion(self.mount, MotionSample.steady(speed)) for speed in (0.0, 1.0))
        C, K0 = self.matrix(1, rest), self.matrix(0, rest)
        return SteadyPencil(
            M=self.matrix(2, rest),
            C=C,
            G=self.matrix(1, turning) - C,
            K0=K0,
            K2=self._per_squared_speed(turning),
            f2=self.load(turning),
        )

    def _per_squared_speed(self, turning: RootMotion) -> np.ndarray:
        """Stiffness per squared speed, summed apart from the far larger stiffness at rest."""
        moving = tuple(t for t in self.terms if t.quantity != "unity")
        return replace(self, terms=moving).matrix(0, turning)


def equations(scene: Scene, operators: Operators) -> Equations:
    """Equations of motion (13), (14) of Lee and Yoo (2019), corrected, with tip body and bending angle.

    Parameters
    ----------
    scene : Scene
        Mount, damping and gravity.
    operators : Operators
        The discretized beam.

    Returns
    -------
    Equations
        Terms whose factor is zero in the scene are left out.
    """
    n = len(operators.bending.P)
    fields = {"bending": slice(0, n)}
    terms, loads = [*_bending_terms(scene, operators)], [*_bending_loads(scene, operators)]
    if operators.stretch is not None:
        fields["stretch"] = slice(n, n + len(operators.stretch.P))
        terms += _stretch_terms(scene, operators)
        loads += _stretch_loads(operators)
    kept = tuple(t for t in terms if t.factor and t.matrix.any())
    return Equations(fields, kept, tuple(f for f in loads if f.factor), scene.mount, scene.gravity, operators)


def _bending_terms(scene: Scene, operators: Operators) -> Iterator[Term]:
    op, b = operators.bending, "bending"
    c, s = _cos_sin(scene.mount.bending_angle)
    yield Term("mass", b, b, 2, op.M)
    yield Term("bending stiffness", b, b, 0, op.KB)
    yield Term("centrifugal stiffening", b, b, 0, op.KGB, "speed_squared")
    yield Term("spin softening", b, b, 0, op.S, "speed_squared", -(c**2))
    yield Term("spin of the tip body", b, b, 0, op.J, "speed_squared", s**2)
    yield Term("tension by root acceleration", b, b, 0, op.KGA, "root_axial", -1.0)
    if scene.damping_ratio:
        yield Term("damping", b, b, 1, modal_damping(op.M, op.KB), factor=scene.damping_ratio)


def _bending_loads(scene: Scene, operators: Operators) -> Iterator[Load]:
    op = operators.bending
    c, _ = _cos_sin(scene.mount.bending_angle)
    yield Load("angular acceleration", "bending", op.Q, "acceleration", c)
    yield Load("root acceleration", "bending", op.P, "root_transverse", -1.0)


def _stretch_terms(scene: Scene, operators: Operators) -> Iterator[Term]:
    op, b, s = operators.stretch, "bending", "stretch"
    assert op is not None
    c, _ = _cos_sin(scene.mount.bending_angle)
    yield Term("stretch mass", s, s, 2, op.M)
    yield Term("axial stiffness", s, s, 0, op.KS)
    yield Term("axial spin softening", s, s, 0, op.M, "speed_squared", -1.0)
    yield Term("Coriolis coupling of stretch", s, b, 1, op.M12, "speed", 2 * c)
    yield Term("Coriolis coupling of bending", b, s, 1, op.M12.T, "speed", -2 * c)
    yield Term("Euler coupling of stretch", s, b, 0, op.M12, "acceleration", c)
    yield Term("Euler coupling of bending", b, s, 0, op.M12.T, "acceleration", -c)
    if scene.damping_ratio:
        yield Term("axial damping", s, s, 1, modal_damping(op.M, op.KS), factor=scene.damping_ratio)


def _stretch_loads(operators: Operators) -> Iterator[Load]:
    op = operators.stretch
    assert op is not None
    yield Load("centrifugal stretching", "stretch", op.Q, "speed_squared")
    yield Load("axial root acceleration", "stretch", op.P, "root_axial", -1.0)


def modal_damping(M: np.ndarray, K: np.ndarray) -> np.ndarray:
    """Damping matrix that gives each mode of (K, M) a damping ratio of 1 [kg/s].

    C = 2 L (L^-1 M L^-T)^(1/2) L^T with K = L L^T.
    """
    L = np.linalg.cholesky(K)
    compliance = scipy.linalg.solve_triangular(
        L, scipy.linalg.solve_triangular(L, M, lower=True).T, lower=True
    )
    mu, U = np.linalg.eigh((compliance + compliance.T) / 2)
    root = (U * np.sqrt(np.maximum(mu, 0))) @ U.T
    return 2 * L @ root @ L.T
