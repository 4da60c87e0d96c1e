"""Bilinear forms of kinetic and stored energy: coefficients of pairs of kinematic quantities at each point.

Quantities are named by field, plane and derivative: ("b", 0, 1) is the slope of bending along e1, "s" the
deflection by shear, "e" the stretch.  The notation of the comments is that of `docs/conventions.md`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from mpmath import mp, mpf

from benchmarks.cases.reference.many_digits.fixed import dot, fixed, times, to_float, to_mpf
from benchmarks.cases.reference.many_digits.numbers import Numbers, turned

Quantity = tuple[str, int, int]
Rows = dict[Quantity, np.ndarray]
Side = Callable[[int], list[Quantity]]


@dataclass
class Form:
    """A bilinear form: the sum of a coefficient at each point times two quantities."""

    points: int
    parts: dict[tuple[Quantity, Quantity], np.ndarray] = field(default_factory=dict)

    def add(self, left: Iterable[Quantity], right: Iterable[Quantity], factors: np.ndarray) -> None:
        """Add factors to all pairs of quantities."""
        for a in left:
            for b in right:
                self.parts[a, b] = self.parts.get((a, b), 0) + factors

    def add_at(self, point: int, left: Iterable[Quantity], right: Iterable[Quantity], factor: mpf) -> None:
        """Add a factor of two quantities at one point of the mesh."""
        factors = np.zeros(self.points, dtype=object)
        factors[point] = fixed([factor])[0]
        self.add(left, right, factors)

    def times(self, quantities: Rows) -> Rows:
        """Multiply right vectors' quantities by coefficients: factors of left quantities (points, ...)."""
        found: Rows = {}
        for (a, b), factors in self.parts.items():
            shape = (-1, *[1] * (quantities[b].ndim - 1))
            found[a] = found.get(a, 0) + times(factors.reshape(shape), quantities[b])
        return found


@dataclass(frozen=True)
class Space:
    """Trial functions of all fields, in blocks by field.

    Parameters
    ----------
    numbers : Numbers
        The scene.
    """

    numbers: Numbers

    @cached_property
    def fields(self) -> list[tuple[str, int]]:
        physics = self.numbers.scene.physics
        deflections = [(kind, i) for i in range(physics.planes) for kind in ("b", "s")[: 1 + physics.shear]]
        return [*deflections, *([("e", 0)] if physics.stretch else [])]

    @cached_property
    def rows(self) -> Rows:
        """Values of the functions for each quantity, shape (points, functions of its field)."""
        once, twice = self.numbers.mesh.once(), self.numbers.mesh.twice()
        found: Rows = {}
        for kind, i in self.fields:
            clamped = kind == "b" and self.numbers.root_spring(i) is None
            for order, table in enumerate(twice if kind == "b" else once):
                found[kind, i, order] = table[:, :-1] if clamped else table
        return found

    @cached_property
    def blocks(self) -> dict[tuple[str, int], slice]:
        """Slice of each field's functions among all functions."""
        starts, found = 0, {}
        for kind, i in self.fields:
            size = self.rows[kind, i, 0].shape[1]
            found[kind, i] = slice(starts, starts + size)
            starts += size
        return found

    @property
    def size(self) -> int:
        return max(block.stop for block in self.blocks.values())

    def quantities(self, vectors: np.ndarray) -> Rows:
        """Compute the kinematic quantities of k coordinate vectors (size, k): shape (points, k) each."""
        return {key: dot(rows, vectors[self.blocks[key[:2]]]) for key, rows in self.rows.items()}

    def known(self, vectors: np.ndarray) -> Rows:
        """Return the cached quantities of vectors that are used repeatedly (those of the modes)."""
        if id(vectors) not in self._known:
            # The vectors are kept, so that no other object gets their id.
            self._known[id(vectors)] = vectors, self.quantities(vectors)
        return self._known[id(vectors)][1]

    @cached_property
    def _known(self) -> dict[int, tuple[np.ndarray, Rows]]:
        return {}

    def collect(self, factors: Rows) -> np.ndarray:
        """Sum up a form's products with vectors, (size, k), from the factors of each quantity."""
        width = next(iter(factors.values())).shape[1]
        found = np.zeros((self.size, width), dtype=object)
        for key, values in factors.items():
            found[self.blocks[key[:2]]] += dot(self.rows[key].T, values)
        return found

    def apply(self, form: Form, vectors: np.ndarray) -> np.ndarray:
        """Multiply the form's matrix with vectors (size, k)."""
        if not form.parts:
            return np.zeros_like(vectors)
        return self.collect(form.times(self.quantities(vectors)))

    def matrix(self, form: Form) -> np.ndarray:
        """Compute the form's matrix in double precision."""
        rows = {key: to_float(table) for key, table in self.rows.items()}
        found = np.zeros((self.size, self.size))
        for (a, b), factors in form.parts.items():
            part = rows[a].T @ (to_float(factors)[:, None] * rows[b])
            found[self.blocks[a[:2]], self.blocks[b[:2]]] += part
        return found


@dataclass(frozen=True)
class Energies:
    """Forms of mass, stiffness at rest, spin (per speed squared), gyroscopic terms (per speed), damper."""

    mass: Form
    still: Form
    spin: Form
    gyroscopic: Form
    damper: Form


def energies(numbers: Numbers) -> Energies:
    """Build the forms of a scene."""
    return _Builder(numbers).build()


class _Builder:
    def __init__(self, numbers: Numbers) -> None:
        self.n, mesh = numbers, numbers.mesh
        self.points = len(mesh.places)
        self.weights = mesh.weights
        self.last = self.points - 1
        self.planes = range(numbers.scene.physics.planes)
        self.shears, self.stretches = numbers.scene.physics.shear, numbers.scene.physics.stretch
        cos, sin = mp.cos(numbers.bending_angle), mp.sin(numbers.bending_angle)
        self.d, self.normal = (cos, -sin), (sin, cos)  # components of e1, e2 on b2 and on b3
        self.C, self.S = mp.cos(numbers.precone), mp.sin(numbers.precone)
        self.forms = [Form(self.points) for _ in range(5)]
        self.mass, self.still, self.spin, self.gyroscopic, self.damper = self.forms

    def build(self) -> Energies:
        self._translation()
        self._rotary()
        self._elastic()
        self._tension()
        self._springs()
        self._tip()
        if len(self.planes) == 2:
            self._twisting()
        for i in self.planes:
            self.damper.add_at(self.last, self.u(i), self.u(i), mpf(1))
        return Energies(*self.forms)

    # kinematic quantities

    def u(self, i: int, order: int = 0) -> list[tuple[str, int, int]]:
        """Return the quantities that add up to a deflection, or to a slope of the beam's axis."""
        return [(kind, i, order) for kind in ("b", "s")[: 1 + self.shears]]

    def over(self, values: np.ndarray) -> np.ndarray:
        """Multiply values along the beam with the weights of the integral."""
        return times(fixed(values), self.weights)

    # terms

    def _translation(self) -> None:
        """Add the forms of all mass on the axis: mass per length and point masses."""
        masses = self.over(self.n.mass)
        for at, mass in self.n.point_masses():
            masses[at] += fixed([mass])[0]
        self._moving(masses, self.u, [("e", 0, 0)] if self.stretches else [])

    def _moving(self, masses: np.ndarray, u: Side, stretch: list[Quantity]) -> None:
        """Add the forms of mass that moves with deflections u(i) and stretch."""
        self._pair(masses, u, u)
        self._with_stretch(masses, u, stretch)
        self._stretching(masses, stretch)

    def _rotary(self) -> None:
        if not self.n.scene.physics.rotary_inertia:
            return
        R = self.n.tensor("rotary_inertia", self.n.root_mass * self.n.length**2)
        assert R is not None
        spins = self._spin_of([[-R[i][j] for j in (0, 1)] for i in (0, 1)])
        for i in self.planes:
            for j in self.planes:
                self.mass.add([("b", i, 1)], [("b", j, 1)], self.over(R[i][j]))
                self.spin.add([("b", i, 1)], [("b", j, 1)], self.over(spins[i][j]))

    def _spin_of(self, B: list[list]) -> list[list]:
        """Compute C^2 (n (B n)^T + (B n) n^T)/2 - S^2 B, of numbers or values at points."""
        n = self.normal
        Bn = [B[i][0] * n[0] + B[i][1] * n[1] for i in (0, 1)]
        return [
            [self.C**2 * (n[i] * Bn[j] + n[j] * Bn[i]) / 2 - self.S**2 * B[i][j] for j in (0, 1)]
            for i in (0, 1)
        ]

    def _elastic(self) -> None:
        stiffness = self.n.root_stiffness
        bending = self.n.tensor("bending_stiffness", stiffness)
        shear = self.n.tensor("shear_stiffness", stiffness / self.n.length**2) if self.shears else None
        assert bending is not None
        for i in self.planes:
            for j in self.planes:
                self.still.add([("b", i, 2)], [("b", j, 2)], self.over(bending[i][j]))
                if shear is not None:
                    self.still.add([("s", i, 1)], [("s", j, 1)], self.over(shear[i][j]))
        if self.stretches:
            axial = self.n.along("axial_stiffness", stiffness / self.n.length**2)
            assert axial is not None
            self.still.add([("e", 0, 1)], [("e", 0, 1)], self.over(axial))

    def _tension(self) -> None:
        """Add the stiffness by the tension C^2 N_B - C cos(phi) r N_A of all mass outboard."""
        mesh = self.n.mesh
        at = fixed(mesh.places)
        masses = fixed(self.n.mass)
        N_A, N_B = mesh.outboard(masses), mesh.outboard(times(masses, at))
        bodies = [(point, mass, to_mpf(at[point])) for point, mass in self.n.point_masses()]
        if tip := self.n.tip():
            bodies.append((self.last, tip["mass"], 1 + tip["offset"]))
        segments = np.array(mesh.segments)
        for point, mass, x in bodies:
            inboard = segments <= segments[point]
            N_A[inboard] += fixed([mass])[0]
            N_B[inboard] += fixed([mass * x])[0]
        tension = _scaled(N_B, self.C**2) - _scaled(N_A, self.C * self.n.inward)
        for i in self.planes:
            self.spin.add(self.u(i, 1), self.u(i, 1), times(tension, self.weights))

    def _springs(self) -> None:
        for i in self.planes:
            if (spring := self.n.root_spring(i)) is not None:
                self.still.add_at(0, [("b", i, 1)], [("b", i, 1)], spring)
        for point, plane, stiffness in self.n.point_springs():
            self.still.add_at(point, self.u(plane), self.u(plane), stiffness)

    def _tip(self) -> None:
        tip = self.n.tip()
        if tip is None:
            return
        m, eps = tip["mass"], tip["offset"]
        self._moving_tip(m, eps)
        angle = self.n.twist[-1:]
        one = np.array([mpf(1)], dtype=object)
        inertia = _first(turned(tip["normal"] * one, tip["across"] * one, angle))
        B = _first(turned((tip["across"] - tip["axial"]) * one, (tip["normal"] - tip["axial"]) * one, angle))
        spins = self._spin_of(B)
        pull = m * eps * (self.C**2 * (1 + eps) - self.C * self.n.inward)
        for i in self.planes:
            self.spin.add_at(self.last, [("b", i, 1)], [("b", i, 1)], pull)
            for j in self.planes:
                self.mass.add_at(self.last, [("b", i, 1)], [("b", j, 1)], inertia[i][j])
                self.spin.add_at(self.last, [("b", i, 1)], [("b", j, 1)], spins[i][j])
        if len(self.planes) == 2:
            along = (tip["normal"] + tip["across"] - tip["axial"]) / 2
            self.gyroscopic.add_at(self.last, [("b", 0, 1)], [("b", 1, 1)], 2 * self.S * along)
            self.gyroscopic.add_at(self.last, [("b", 1, 1)], [("b", 0, 1)], -2 * self.S * along)

    def _moving_tip(self, mass: mpf, offset: mpf) -> None:
        """Add the mass of the tip body, with the deflection u + eps u_b' of its centre of gravity."""
        one = np.zeros(self.points, dtype=object)
        one[self.last] = fixed([mass])[0]
        parts = [(mpf(1), self.u), (offset, lambda i: [("b", i, 1)])]
        stretch = [("e", 0, 0)] if self.stretches else []
        for a, left in parts:
            for b, right in parts:
                self._pair(_scaled(one, a * b), left, right)
            self._with_stretch(_scaled(one, a), left, stretch)
        self._stretching(one, stretch)

    def _pair(self, masses: np.ndarray, left: Side, right: Side) -> None:
        """Add mass with deflections: inertia, spin softening and Coriolis coupling of planes."""
        d, n, S = self.d, self.normal, self.S
        for i in self.planes:
            self.mass.add(left(i), right(i), masses)
            for j in self.planes:
                self.spin.add(left(i), right(j), -_scaled(masses, d[i] * d[j] + S**2 * n[i] * n[j]))
        if len(self.planes) == 2:
            self.gyroscopic.add(left(0), right(1), _scaled(masses, 2 * S))
            self.gyroscopic.add(left(1), right(0), _scaled(masses, -2 * S))

    def _stretching(self, masses: np.ndarray, stretch: list[Quantity]) -> None:
        """Add mass with stretch: inertia and spin softening."""
        self.mass.add(stretch, stretch, masses)
        self.spin.add(stretch, stretch, -_scaled(masses, self.C**2))

    def _with_stretch(self, masses: np.ndarray, u: Side, stretch: list[Quantity]) -> None:
        """Add the coupling of deflections with stretch, by the Coriolis force and by precone."""
        for i in self.planes:
            self.gyroscopic.add(u(i), stretch, _scaled(masses, -2 * self.d[i] * self.C))
            self.gyroscopic.add(stretch, u(i), _scaled(masses, 2 * self.d[i] * self.C))
            self.spin.add(u(i), stretch, _scaled(masses, self.S * self.C * self.normal[i]))
            self.spin.add(stretch, u(i), _scaled(masses, self.S * self.C * self.normal[i]))

    def _twisting(self) -> None:
        """Add H(x) = -d B n + int_x^L d R n dx, times C^2 (phi_1' phi_2'' - phi_1'' phi_2') / 2."""
        d, n, H = self.d, self.normal, np.zeros(self.points, dtype=object)
        if self.n.scene.physics.rotary_inertia:
            R = self.n.tensor("rotary_inertia", self.n.root_mass * self.n.length**2)
            assert R is not None
            H = self.n.mesh.outboard(fixed(sum(d[i] * R[i][j] * n[j] for i in (0, 1) for j in (0, 1))))
        if tip := self.n.tip():
            one = np.array([mpf(1)], dtype=object)
            first, second = ((tip[name] - tip["axial"]) * one for name in ("across", "normal"))
            B = _first(turned(first, second, self.n.twist[-1:]))
            H = H - fixed([sum(d[i] * B[i][j] * n[j] for i in (0, 1) for j in (0, 1))])[0]
        factors = times(_scaled(H, self.C**2 / 2), self.weights)
        for left, right in ((0, 1), (1, 0)):
            sign = 1 if left == 0 else -1
            self.spin.add([("b", left, 1)], [("b", right, 2)], sign * factors)
            self.spin.add([("b", left, 2)], [("b", right, 1)], -sign * factors)


def _scaled(values: np.ndarray, factor: mpf) -> np.ndarray:
    return times(values, fixed([factor])[0])


def _first(tensor: list[list[np.ndarray]]) -> list[list[mpf]]:
    return [[each[0] for each in row] for row in tensor]
