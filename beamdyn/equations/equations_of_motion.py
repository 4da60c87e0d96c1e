"""The equations of motion of a scene, as a list of terms.

M q'' + C q' + K q = f for the coordinates q of all fields.  Each matrix is a sum of terms ``factor *
quantity(t) * matrix`` with a quantity of the root's motion: analyses at many speeds, harmonic balance and the
omission of terms all use this one list.

Derivation and conventions: docs/conventions.md.

In shapes of arrays, n counts coordinates, k positions along the beam, and l across it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from beamdyn.common.inputs.checks import real_array
from beamdyn.common.numerics import solve_lower
from beamdyn.common.results.snapshots import ADDED_LATER
from beamdyn.equations.circuit import BLOCK, Circuit, Voltage, charge_terms, flux_terms
from beamdyn.equations.effects import check_direction
from beamdyn.equations.fields.field import Deflection, Load, SectionFunctions, Term
from beamdyn.equations.root_motion import Quantity, RootMotion, root_at_unit_speed, root_motion
from beamdyn.scene.motion.base import MotionSample
from beamdyn.scene.mount import Mount

# `BACKWARD` and `ROUNDING_SIZE` are fitted to the rounding errors of 720 frequencies of random scenes, which
# benchmarks/stated_frequency_errors.py computes.  As rows and columns of the matrices have very different
# sizes, the errors are smaller than the norms of the matrices suggest.
BACKWARD = 8 * np.finfo(float).eps  # backward error of the stiffness, relative to the sum of its terms
# Number of functions above which rounding errors grow in proportion to the number of functions.
ROUNDING_SIZE = 40


@dataclass(frozen=True, eq=False)
class SteadyPencil:
    """Equations at steady speed omega: M q'' + (C + omega G) q' + (K0 + omega^2 K2) q = omega^2 f2.

    Parameters
    ----------
    M, C, G, K0, K2 : ndarray, shape (n, n)
        Mass, damping, gyroscopic matrix divided by speed, stiffness at rest, stiffness divided by squared
        speed.
    f2 : ndarray, shape (n,)
        Static load divided by the squared speed.
    shift : float
        Squared first angular frequency of the beam with a clamped root [1/s2], if the root is not clamped:
        K0 may then be singular, but K0 + shift M is positive definite.  0 if the root is clamped.
    planes : int
        Number of directions in which the beam bends, 1 or 2; with 2, stated errors include rounding errors of
        matrix entries that cancel.
    """

    M: np.ndarray
    C: np.ndarray
    G: np.ndarray
    K0: np.ndarray
    K2: np.ndarray
    f2: np.ndarray
    shift: float = 0.0
    planes: int = 1

    def part(self, coordinates: np.ndarray) -> SteadyPencil:
        """Extract the equations of some coordinates (ascending) that are not coupled to any others."""
        first, end = int(coordinates[0]), int(coordinates[-1]) + 1
        own = np.ix_(coordinates, coordinates)
        if end - first == len(coordinates):  # copying a contiguous block is faster
            own = slice(first, end), slice(first, end)
        M, C, G, K0, K2 = (A[own].copy() for A in (self.M, self.C, self.G, self.K0, self.K2))
        return SteadyPencil(M, C, G, K0, K2, self.f2[coordinates], self.shift, self.planes)

    def undamped(self) -> SteadyPencil:
        """Return the equations without damping and gyroscopic coupling."""
        return replace(self, C=np.zeros_like(self.C), G=np.zeros_like(self.G))

    @cached_property
    def conservative(self) -> bool:
        """Whether the equations have neither damping nor gyroscopic coupling."""
        return not (np.count_nonzero(self.C) or np.count_nonzero(self.G))


@dataclass(frozen=True, eq=False)
class Shape:
    """Coordinates of a field as a linear function of the coordinates of the equations of motion.

    Parameters
    ----------
    block : str
        Name of the block of coordinates: the field's own block, unless the equations are reduced.
    matrix : ndarray, shape (m, coordinates)
        Coefficients of the m functions of the discretization per unit of each coordinate of the block.
    """

    block: str
    matrix: np.ndarray


@dataclass(frozen=True, eq=False)
class Equations:
    """Equations of motion of a scene in the coordinates of one discretization, or in modal coordinates.

    Parameters
    ----------
    blocks : dict of str to slice
        Slice of q with the coordinates of each displacement field; after a reduction, of each set of coupled
        fields, under the name of the first field.
    terms : tuple of Term
        Terms of the left-hand side.
    loads : tuple of Load
        Terms of the right-hand side.
    mount : Mount
        Mount of the beam on the carrier.
    gravity : float
        Gravitational acceleration [m/s2].
    shapes : dict of str to Shape
        Coordinates of each field as functions of those of the equations.
    deflections : dict of str to Deflection
        Functions and loads of each field that deflects the beam.
    shift : float
        Squared first angular frequency with a clamped root [1/s2]; 0 if the root is clamped: see
        `SteadyPencil`.
    coarse : ndarray or None
        Indices of the coordinates whose functions span those of the coarser discretization; None if no subset
        does, and after a reduction.
    sections : tuple of (str, SectionFunctions)
        Names of the fields that deform the sections of a strip, and their functions.
    circuit : Circuit or None
        Circuit of a harvester with a load resistance, if it has no coordinate in the equations yet.
    voltage : Voltage or None
        Voltage of a harvester whose circuit has a coordinate in the equations.
    """

    blocks: dict[str, slice]
    terms: tuple[Term, ...]
    loads: tuple[Load, ...]
    mount: Mount
    gravity: float
    shapes: dict[str, Shape]
    deflections: dict[str, Deflection]
    shift: float = 0.0
    coarse: np.ndarray | None = None
    sections: tuple[tuple[str, SectionFunctions], ...] = field(default=(), metadata=ADDED_LATER)
    circuit: Circuit | None = field(default=None, metadata=ADDED_LATER)
    voltage: Voltage | None = field(default=None, metadata=ADDED_LATER)

    @cached_property
    def size(self) -> int:
        """Number n of coordinates."""
        return max(place.stop for place in self.blocks.values())

    @property
    def modes(self) -> int:
        """Number of coordinates of the largest block."""
        return max(place.stop - place.start for place in self.blocks.values())

    @cached_property
    def planes(self) -> int:
        """Number of directions in which the beam is deflected: 1 or 2."""
        return 1 + max(deflection.direction for deflection in self.deflections.values())

    # Deflection of the beam as a function of the coordinates ---------------------------------------

    def deflection(self, xi: np.ndarray, order: int = 0, direction: int = 0) -> np.ndarray:
        """Evaluate the deflection per unit of each coordinate, or its `order`-th derivative: shape (n, k).

        Derivatives are with respect to xi = x/L, at k positions xi.  Direction 0 is that of the bending
        angle, direction 1 is perpendicular to it.
        """
        check_direction(direction)
        xi = np.asarray(xi, dtype=float)
        return self._over_coordinates(lambda d: d.space.evaluate(xi, order), direction, xi.shape)

    def surface(self, xi: np.ndarray, eta: np.ndarray) -> np.ndarray:
        """Evaluate a strip's deflection in the direction of bending per unit of each coordinate: (n, k, l).

        The points are xi = x/L (k,) along and eta = 2 y/b (l,) across the width b.
        A ValueError is raised if an eta lies outside the strip.
        """
        eta = real_array("eta", eta)
        if eta.size and np.abs(eta).max() > 1:
            raise ValueError("eta: positions across the width must be from -1 to 1, the edges of the strip")
        values = np.repeat(self.deflection(xi)[:, :, None], len(eta), axis=2)
        for name, functions in self.sections:
            of_field = self.shapes[name]
            values[self.blocks[of_field.block]] += np.tensordot(
                of_field.matrix.T, functions.evaluate(xi, eta), 1
            )
        return values

    def curvature_across(self, xi: np.ndarray) -> np.ndarray:
        """Evaluate second derivatives across the width, per unit of each coordinate: shape (n, k).

        The derivatives of the deflection are with respect to eta = 2 y/b, and averaged over the width b, at k
        positions xi = x/L.
        """
        values = np.zeros((self.size, len(xi)))
        for name, functions in self.sections:
            of_field = self.shapes[name]
            values[self.blocks[of_field.block]] += of_field.matrix.T @ functions.curvature_across(xi)
        return values

    def momentum(self, vectors: np.ndarray) -> np.ndarray:
        """Multiply vectors in columns by the mass matrix, block by block."""
        total = np.zeros_like(vectors)
        for term in (t for t in self.terms if t.order == 2 and t.quantity == "unity"):
            moved = vectors[..., self.blocks[term.columns], :]
            total[..., self.blocks[term.rows], :] += term.factor * (term.matrix @ moved)
        return total

    @property
    def corner(self) -> np.ndarray:
        """Deflection of the tip's corner 2 y/width = 1 per unit of each coordinate, shape (n,).

        If the width is unknown, it is the twist of the tip [rad].
        """
        values = self.tip * all(functions.of_strip for _, functions in self.sections)
        for name, functions in self.sections:
            of_field = self.shapes[name]
            values[self.blocks[of_field.block]] += of_field.matrix.T @ functions.corner
        return values

    @cached_property
    def tip(self) -> np.ndarray:
        """Tip deflection in the direction of bending per unit of each coordinate, shape (n,)."""
        return self.tips[0]

    @cached_property
    def tips(self) -> np.ndarray:
        """Tip deflection per unit of each coordinate: (planes, n), a row for each direction of bending."""
        return np.array([self._over_coordinates(lambda d: d.space.end(0), k) for k in range(self.planes)])

    def P(self, direction: int) -> np.ndarray:
        """Compute the load on each coordinate under a unit acceleration of the root in a direction [kg]."""
        return self._over_coordinates(lambda d: d.P, direction)

    def Q(self, direction: int) -> np.ndarray:
        """Compute the load on each coordinate under a unit angular acceleration of the root [kg m].

        The root turns in the plane of the beam's axis and the given direction of bending.  If the sections or
        the tip body have a product of inertia, the load acts in the other direction, too.
        """
        of_direction = self._over_coordinates(lambda d: d.Q, direction)
        return of_direction + self._over_coordinates(lambda d: d.Q_across, 1 - direction)

    def _over_coordinates(
        self, quantity: Callable[[Deflection], np.ndarray], direction: int, shape: tuple[int, ...] = ()
    ) -> np.ndarray:
        """Transform a quantity of the trial functions that deflect in one direction to the coordinates.

        Coordinates that do not deflect the beam in this direction get the value 0.
        """
        values = np.zeros((self.size, *shape))
        for name, deflection in self.deflections.items():
            if deflection.direction == direction:
                of_field = self.shapes[name]
                values[self.blocks[of_field.block]] += of_field.matrix.T @ quantity(deflection)
        return values

    # Matrices and loads as functions of the root's motion -------------------------------------------

    @cached_property
    def matrices(self) -> tuple[dict[Quantity, np.ndarray], ...]:
        """Matrices of q, of q' and of q'': in each of the three mappings, by quantity of the root's motion.

        Each matrix is the sum of all terms that the quantity multiplies.
        """
        sums: tuple[dict[Quantity, np.ndarray], ...] = ({}, {}, {})
        for term in self.terms:
            total = sums[term.order].setdefault(term.quantity, np.zeros((self.size, self.size)))
            total[self.blocks[term.rows], self.blocks[term.columns]] += term.factor * term.matrix
        return sums

    @cached_property
    def vectors(self) -> dict[Quantity, np.ndarray]:
        """Load vectors, by the quantity of the root's motion that multiplies each: sums over all loads."""
        sums: dict[Quantity, np.ndarray] = {}
        for load in self.loads:
            total = sums.setdefault(load.quantity, np.zeros(self.size))
            total[self.blocks[load.rows]] += load.factor * load.vector
        return sums

    def root(self, sample: MotionSample) -> RootMotion:
        """Compute the motion of the root from the motion of the carrier."""
        return root_motion(self.mount, sample, self.gravity)

    def matrix(self, order: int, root: RootMotion) -> np.ndarray:
        """Compute the matrix of the `order`-th time derivative of q at all times of the root's motion."""
        return _sum_over_quantities(self.matrices[order], root, (self.size, self.size))

    def load(self, root: RootMotion) -> np.ndarray:
        """Compute the right-hand side of the equations at all times of the root's motion."""
        return _sum_over_quantities(self.vectors, root, (self.size,))

    def steady(self) -> SteadyPencil:
        """Return the equations at constant speed, with coefficients that are polynomials in the speed.

        The centre of the carrier is fixed, and there is no gravity.
        """
        return self._steady

    @cached_property
    def _steady(self) -> SteadyPencil:
        rotating, nothing = root_at_unit_speed(self.mount), np.zeros((self.size, self.size))
        K0, C, M = (of_order.get("unity", nothing) for of_order in self.matrices)
        K2, G = (
            sum((float(getattr(rotating, q)) * A for q, A in of_order.items() if q != "unity"), nothing)
            for of_order in self.matrices[:2]
        )
        loads = (float(getattr(rotating, q)) * f for q, f in self.vectors.items())
        return SteadyPencil(M, C, G, K0, K2, sum(loads, np.zeros(self.size)), self.shift, self.planes)

    @cached_property
    def separate(self) -> tuple[SteadyPencil, ...]:
        """Equations at steady speed, one for each set of coupled blocks in `connected`."""
        sizes = {name: place.stop - place.start for name, place in self.blocks.items()}
        parts = []
        for names in self.connected:
            own = place_blocks({name: sizes[name] for name in names})
            terms = tuple(term for term in self.terms if term.rows in own)
            loads = tuple(load for load in self.loads if load.rows in own)
            parts.append(replace(self, blocks=own, terms=terms, loads=loads).steady())
        return tuple(parts)

    @cached_property
    def coupled(self) -> tuple[tuple[str, ...], ...]:
        """Sets of blocks coupled by mass or stiffness; terms with angular acceleration are not considered."""
        terms = (t for t in self.terms if t.order != 1 and t.quantity != "acceleration")
        return replace(self, terms=tuple(terms)).connected

    @cached_property
    def connected(self) -> tuple[tuple[str, ...], ...]:
        """Sets of coordinate blocks that are coupled by any term."""
        set_of = {name: {name} for name in self.blocks}
        for term in self.terms:
            if term.columns not in set_of[term.rows]:
                joined = set_of[term.rows] | set_of[term.columns]
                set_of.update(dict.fromkeys(joined, joined))
        ordered = (tuple(each for each in self.blocks if each in set_of[name]) for name in self.blocks)
        return tuple(dict.fromkeys(ordered))

    @property
    def deflecting(self) -> list[str]:
        """Names of the blocks that deflect the straight beam, before a reduction."""
        return [name for name in self.deflections if name in self.blocks]

    def places(self, names: Iterable[str]) -> np.ndarray:
        """List the indices of the coordinates of the named blocks."""
        return np.concatenate([np.arange(self.blocks[n].start, self.blocks[n].stop) for n in names])

    # Reduction to fewer coordinates -----------------------------------------------------------------

    def reduced(self, bases: Mapping[tuple[str, ...], np.ndarray]) -> Equations:
        """Transform the equations to fewer coordinates: for each set of blocks, q = basis @ q_reduced.

        Parameters
        ----------
        bases : mapping of tuple of str to ndarray, shape (coordinates, fewer)
            Basis of each set of blocks, in columns: its modes at rest, for instance.

        Returns
        -------
        Equations
        """
        basis: dict[str, Shape] = {}
        for names, V in bases.items():
            ends = np.cumsum([self.blocks[name].stop - self.blocks[name].start for name in names])
            rows = zip(names, np.split(V, ends[:-1]), strict=True)
            basis |= {name: Shape(names[0], of_block) for name, of_block in rows}
        terms = []
        for t in self.terms:
            rows, columns = basis[t.rows], basis[t.columns]
            matrix = rows.matrix.T @ t.matrix @ columns.matrix
            terms.append(replace(t, rows=rows.block, columns=columns.block, matrix=matrix))
        loads = [
            replace(f, rows=basis[f.rows].block, vector=basis[f.rows].matrix.T @ f.vector) for f in self.loads
        ]
        shapes = {
            name: Shape(basis[of_field.block].block, of_field.matrix @ basis[of_field.block].matrix)
            for name, of_field in self.shapes.items()
        }
        circuit = self.circuit
        if circuit is not None:
            of_sets = (V.T @ circuit.coupling[self.places(names)] for names, V in bases.items())
            circuit = replace(circuit, coupling=np.concatenate([*of_sets]))
        voltage = self.voltage
        if voltage is not None:
            of_sets = (V.T @ voltage.row[self.places(names)] for names, V in bases.items())
            voltage = replace(voltage, row=np.concatenate([*of_sets]))
        return replace(
            self,
            blocks=place_blocks({names[0]: V.shape[1] for names, V in bases.items()}),
            terms=tuple(terms),
            loads=tuple(loads),
            shapes=shapes,
            coarse=None,
            circuit=circuit,
            voltage=voltage,
        )

    def of_unit_stiffness(self) -> Equations:
        """Transform each field's coordinates so that its stiffness at rest, plus the shift, is the identity.

        Short elements make the stiffness ill-conditioned: the elastic forces of smooth deflections are small
        differences of large numbers.
        """
        K = self.matrices[0]["unity"] + self.shift * self.matrices[2]["unity"]
        return self.reduced({(name,): _unit_basis(K[place, place]) for name, place in self.blocks.items()})

    # Circuit of a harvester -------------------------------------------------------------------------

    def with_flux(self) -> Equations:
        """Add the coordinate of the harvester's circuit, if any, as a flux: with mass, but no stiffness."""
        return self if self.circuit is None else self._with(*flux_terms(self.circuit, self._coupled_blocks))

    def with_charge(self) -> Equations:
        """Add the coordinate of the harvester's circuit, if any, as a charge: with stiffness, but no mass."""
        if self.circuit is None:
            return self
        return self._with(*charge_terms(self.circuit, self._coupled_blocks))

    @property
    def _coupled_blocks(self) -> dict[str, np.ndarray]:
        assert self.circuit is not None
        return {name: self.circuit.coupling[place] for name, place in self.blocks.items()}

    def _with(self, terms: Iterable[Term], voltage: Voltage) -> Equations:
        blocks = self.blocks | {BLOCK: slice(self.size, self.size + 1)}
        kept = tuple(term for term in terms if term.matrix.any() or term.order == 2)
        return replace(
            self, blocks=blocks, terms=(*self.terms, *kept), coarse=None, circuit=None, voltage=voltage
        )


def _unit_basis(K: np.ndarray) -> np.ndarray:
    """Compute a basis B, in columns, in which a positive definite stiffness K is the identity, B^T K B."""
    return solve_lower(np.linalg.cholesky(K), np.eye(len(K))).T


def _sum_over_quantities(
    coefficients: Mapping[Quantity, np.ndarray], root: RootMotion, shape: tuple[int, ...]
) -> np.ndarray:
    """Sum each quantity times its matrix or vector of a given shape, at all times of root motion."""
    total = np.zeros((*root.unity.shape, *shape))
    for quantity, coefficient in coefficients.items():
        values = getattr(root, quantity)
        total += values.reshape(*values.shape, *(1 for _ in shape)) * coefficient
    return total


def place_blocks(sizes: Mapping[str, int]) -> dict[str, slice]:
    """Assign consecutive slices of coordinates to the fields, given their numbers of coordinates."""
    blocks, start = {}, 0
    for name, size in sizes.items():
        blocks[name] = slice(start, start := start + size)
    return blocks
