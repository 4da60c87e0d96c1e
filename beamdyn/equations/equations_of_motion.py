"""The equations of motion, as a list of terms.

M q'' + C q' + K q = f for the coordinates q of all fields.  Each matrix is a sum of terms
``factor * quantity(t) * matrix`` with a quantity of the root's motion: batches over speeds, harmonic balance
and the omission of terms all read this one list.

Derivation and conventions: docs/conventions.md.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.linalg

from beamdyn.equations.damping import modal_damping
from beamdyn.equations.directions import check_direction
from beamdyn.equations.discretization import Discretization, Space, Spaces
from beamdyn.equations.fields import FIELDS
from beamdyn.equations.fields.field import Deflection, Load, Term
from beamdyn.equations.root_motion import Quantity, RootMotion, root_motion
from beamdyn.scene.motion import MotionSample
from beamdyn.scene.mount import Mount
from beamdyn.scene.scene import Scene


@dataclass(frozen=True)
class SteadyPencil:
    """Equations at steady speed omega: M q'' + (C + omega G) q' + (K0 + omega^2 K2) q = omega^2 f2.

    Parameters
    ----------
    M, C, G, K0, K2 : ndarray, shape (n, n)
        Mass, damping, gyroscopic matrix per speed, stiffness at rest, stiffness per squared speed.
    f2 : ndarray, shape (n,)
        Static load per squared speed.
    shift : float
        Squared first angular frequency of the beam with a clamped root [1/s2]; 0 if the root is clamped.
        K0 + shift M is positive definite.
    planes : int
        Number of directions in which the beam bends, 1 or 2; with 2, rounding by cancelling entries is
        counted.
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
        """Extract the equations of some coordinates, which others do not affect."""
        M, C, G, K0, K2 = (
            A[coordinates[:, None], coordinates] for A in (self.M, self.C, self.G, self.K0, self.K2)
        )
        return SteadyPencil(M, C, G, K0, K2, self.f2[coordinates], self.shift, self.planes)

    def undamped(self) -> SteadyPencil:
        """The same without damping and gyroscopic coupling."""
        return replace(self, C=np.zeros_like(self.C), G=np.zeros_like(self.G))

    @cached_property
    def conservative(self) -> bool:
        """Whether there is neither damping nor gyroscopic coupling."""
        return not (self.C.any() or self.G.any())


@dataclass(frozen=True)
class Shape:
    """Coordinates of a field as a linear function of those of the equations.

    Parameters
    ----------
    block : str
        Name of the block of coordinates: the field's own before a reduction.
    matrix : ndarray, shape (m, n)
        Coefficients of the m functions of the discretization per coordinate of the block.
    """

    block: str
    matrix: np.ndarray


@dataclass(frozen=True)
class Equations:
    """Equations of motion of a scene in one discretization, or in modal coordinates.

    Parameters
    ----------
    blocks : dict of str to slice
        Slice of q that holds the coordinates of each field; after a reduction, of each set of fields that
        are coupled, under the name of the first of them.
    terms : tuple of Term
        Terms of the left-hand side.
    loads : tuple of Load
        Terms of the right-hand side.
    mount : Mount
        Mount of the beam on the carrier.
    gravity : float
        Gravitational acceleration [m/s2].
    shapes : dict of str to Shape
        Coordinates of each field by those of the equations.
    deflections : dict of str to Deflection
        Functions and loads of each field that deflects the beam.
    shift : float
        As for `SteadyPencil`.
    coarse : ndarray or None
        Indices of the coordinates whose functions span those of the coarser discretization; None where no
        few do, and after a reduction.
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

    @cached_property
    def size(self) -> int:
        """Number n of coordinates."""
        return max(place.stop for place in self.blocks.values())

    @property
    def modes(self) -> int:
        """Largest number of coordinates of a block."""
        return max(place.stop - place.start for place in self.blocks.values())

    @cached_property
    def planes(self) -> int:
        """Number of directions in which the beam is deflected: 1 or 2."""
        return 1 + max(deflection.direction for deflection in self.deflections.values())

    # Deflection of the beam by the coordinates ----------------------------------------------------

    def deflection(self, xi: np.ndarray, order: int = 0, direction: int = 0) -> np.ndarray:
        """Derivatives with respect to x/L of the deflection per coordinate, at xi (k,): shape (n, k).

        The direction is 0 for that of the bending angle, 1 for that across.
        """
        xi = np.asarray(xi, dtype=float)
        return self._over_coordinates(lambda d: d.space.evaluate(xi, order), direction, xi.shape)

    @cached_property
    def tip(self) -> np.ndarray:
        """Tip deflection per coordinate in the direction of bending, shape (n,)."""
        return self._over_coordinates(lambda d: d.space.end(0), 0)

    @cached_property
    def tip_across(self) -> np.ndarray:
        """Tip deflection per coordinate in the direction across, shape (n,)."""
        return self._over_coordinates(lambda d: d.space.end(0), 1)

    @property
    def tips(self) -> np.ndarray:
        """Tip deflection per coordinate in each direction in which the beam bends, shape (1 or 2, n)."""
        return np.array([self.tip, self.tip_across][: self.planes])

    def P(self, direction: int) -> np.ndarray:
        """Load under a unit root acceleration in a direction of bending [kg], shape (n,)."""
        return self._over_coordinates(lambda d: d.P, direction)

    def Q(self, direction: int) -> np.ndarray:
        """Load under a unit angular acceleration in the plane of a direction [kg m], shape (n,).

        Oblique sections and an oblique tip body are also tilted towards the other direction.
        """
        of_direction = self._over_coordinates(lambda d: d.Q, direction)
        return of_direction + self._over_coordinates(lambda d: d.Q_across, 1 - direction)

    def _over_coordinates(
        self, quantity: Callable[[Deflection], np.ndarray], direction: int, shape: tuple[int, ...] = ()
    ) -> np.ndarray:
        """Gather a quantity of the functions over all coordinates; 0 for fields without that direction."""
        check_direction(direction)
        values = np.zeros((self.size, *shape))
        for name, deflection in self.deflections.items():
            if deflection.direction == direction:
                of_field = self.shapes[name]
                values[self.blocks[of_field.block]] += of_field.matrix.T @ quantity(deflection)
        return values

    # Matrices and loads as functions of the root's motion -------------------------------------------

    @cached_property
    def matrices(self) -> tuple[dict[Quantity, np.ndarray], ...]:
        """Sums of the matrices of each quantity, for the time derivatives of orders 0, 1, 2 of q."""
        sums: tuple[dict[Quantity, np.ndarray], ...] = ({}, {}, {})
        for term in self.terms:
            total = sums[term.order].setdefault(term.quantity, np.zeros((self.size, self.size)))
            total[self.blocks[term.rows], self.blocks[term.columns]] += term.factor * term.matrix
        return sums

    @cached_property
    def vectors(self) -> dict[Quantity, np.ndarray]:
        """Sums of the load vectors of each quantity."""
        sums: dict[Quantity, np.ndarray] = {}
        for load in self.loads:
            total = sums.setdefault(load.quantity, np.zeros(self.size))
            total[self.blocks[load.rows]] += load.factor * load.vector
        return sums

    def root(self, sample: MotionSample) -> RootMotion:
        """Compute the motion of the root from that of the carrier."""
        return root_motion(self.mount, sample, self.gravity)

    def matrix(self, order: int, root: RootMotion) -> np.ndarray:
        """Matrix of the `order`-th time derivative of q: shape (..., n, n) for quantities of shape (...)."""
        return _sum_over_quantities(self.matrices[order], root, (self.size, self.size))

    def load(self, root: RootMotion) -> np.ndarray:
        """Right-hand side: shape (..., n) for quantities of shape (...)."""
        return _sum_over_quantities(self.vectors, root, (self.size,))

    def steady(self) -> SteadyPencil:
        """Equations at steady speed, as polynomials of it; about a fixed centre and without gravity."""
        return self._steady

    @cached_property
    def _steady(self) -> SteadyPencil:
        rotating = root_motion(self.mount, MotionSample.steady(1.0))
        (K0, K2), (C, G), (M, _) = (self._at_rest_and_turning(order, rotating) for order in range(3))
        return SteadyPencil(M, C, G, K0, K2, self.load(rotating), self.shift, self.planes)

    def _at_rest_and_turning(self, order: int, root: RootMotion) -> tuple[np.ndarray, np.ndarray]:
        """The constant part of a matrix, and what motion of the root adds to it."""
        moving: dict[Quantity, np.ndarray] = dict(self.matrices[order])
        constant = moving.pop("unity", None)
        shape = self.size, self.size
        return np.zeros(shape) if constant is None else constant, _sum_over_quantities(moving, root, shape)

    @cached_property
    def coupled(self) -> tuple[tuple[str, ...], ...]:
        """Sets of blocks that mass or stiffness couples, at steady speed or by an acceleration."""
        return self._connected(t for t in self.terms if t.order != 1 and t.quantity != "acceleration")

    @cached_property
    def connected(self) -> tuple[tuple[str, ...], ...]:
        """Sets of blocks that any term couples."""
        return self._connected(self.terms)

    def _connected(self, terms: Iterable[Term]) -> tuple[tuple[str, ...], ...]:
        set_of = {name: {name} for name in self.blocks}
        for term in terms:
            joined = set_of[term.rows] | set_of[term.columns]
            set_of.update(dict.fromkeys(joined, joined))
        sets = {min(joined, key=self._start): joined for joined in set_of.values()}
        return tuple(tuple(sorted(sets[first], key=self._start)) for first in sorted(sets, key=self._start))

    def _start(self, name: str) -> int:
        return self.blocks[name].start

    def places(self, names: Iterable[str]) -> np.ndarray:
        """Indices of the coordinates of some blocks."""
        return np.concatenate([np.arange(self.blocks[n].start, self.blocks[n].stop) for n in names])

    # Reduction to fewer coordinates -----------------------------------------------------------------

    def reduced(self, bases: Mapping[tuple[str, ...], np.ndarray]) -> Equations:
        """Transform the equations to other coordinates: for each set of blocks, q = basis @ q_reduced.

        Parameters
        ----------
        bases : mapping of tuple of str to ndarray, shape (n, m)
            Basis of each set of blocks, in columns: its modes at rest, for instance.

        Returns
        -------
        Equations
        """
        basis = {name: shape for names, V in bases.items() for name, shape in self._split(names, V)}
        terms = (
            replace(
                t,
                rows=basis[t.rows].block,
                columns=basis[t.columns].block,
                matrix=basis[t.rows].matrix.T @ t.matrix @ basis[t.columns].matrix,
            )
            for t in self.terms
        )
        loads = (
            replace(f, rows=basis[f.rows].block, vector=basis[f.rows].matrix.T @ f.vector) for f in self.loads
        )
        shapes = {
            name: Shape(basis[of_field.block].block, of_field.matrix @ basis[of_field.block].matrix)
            for name, of_field in self.shapes.items()
        }
        return replace(
            self,
            blocks=_place_blocks({names[0]: V.shape[1] for names, V in bases.items()}),
            terms=tuple(terms),
            loads=tuple(loads),
            shapes=shapes,
            coarse=None,
        )

    def _split(self, names: tuple[str, ...], basis: np.ndarray) -> Iterator[tuple[str, Shape]]:
        """Yield the rows of a basis of several blocks that belong to each."""
        ends = np.cumsum([self.blocks[name].stop - self.blocks[name].start for name in names])
        for name, rows in zip(names, np.split(basis, ends[:-1]), strict=True):
            yield name, Shape(names[0], rows)


def _sum_over_quantities(
    coefficients: Mapping[Quantity, np.ndarray], root: RootMotion, shape: tuple[int, ...]
) -> np.ndarray:
    """Sum each quantity times its matrix or vector of the given shape, at all times of the root's motion."""
    total = np.zeros((*root.unity.shape, *shape))
    for quantity, coefficient in coefficients.items():
        values = getattr(root, quantity)
        total += values.reshape(*values.shape, *(1 for _ in shape)) * coefficient
    return total


def _place_blocks(sizes: Mapping[str, int]) -> dict[str, slice]:
    """Assign consecutive slices to the coordinates of the fields."""
    blocks, start = {}, 0
    for name, size in sizes.items():
        blocks[name] = slice(start, start := start + size)
    return blocks


def _join(spaces: Sequence[Space]) -> np.ndarray | None:
    """Indices of the functions of the coarser discretization among those of successive spaces."""
    starts = np.cumsum([0] + [space.size for space in spaces])
    coarse = [space.coarse for space in spaces]
    if any(places is None for places in coarse):
        return None
    return np.concatenate([start + places for start, places in zip(starts, coarse, strict=False)])


def assemble_equations(scene: Scene, discretization: Discretization) -> Equations:
    """Assemble the equations of motion of a scene in a discretization: see `assemble_over`."""
    return assemble_over(scene, discretization.spaces(scene.modelled_beam))


def assemble_over(scene: Scene, spaces: Spaces) -> Equations:
    """Assemble the equations of motion of a scene over function spaces, field by field.

    Parameters
    ----------
    scene : Scene
        Beam, mount, damping and gravity.
    spaces : Spaces
        Function spaces on the beam.

    Returns
    -------
    Equations
        Without the terms whose factor or matrix is zero in the scene.
    """
    fields = {f.name: f.assemble(scene, spaces) for f in FIELDS if f.is_modelled(scene)}
    equations = Equations(
        blocks=_place_blocks({name: field.space.size for name, field in fields.items()}),
        terms=tuple(t for field in fields.values() for t in field.terms if t.factor and t.matrix.any()),
        loads=tuple(f for field in fields.values() for f in field.loads if f.factor),
        mount=scene.mount,
        gravity=scene.gravity,
        shapes={name: Shape(name, np.eye(field.space.size)) for name, field in fields.items()},
        deflections={name: f.deflection for name, f in fields.items() if f.deflection is not None},
        coarse=_join([field.space for field in fields.values()]),
    )
    if turning := [name for name, field in fields.items() if field.turns_at_root]:
        equations = replace(equations, shift=_find_lowest_clamped(equations, turning))
    if not scene.is_damped:
        return equations
    return replace(equations, terms=(*equations.terms, *_damping(equations, scene)))


def _find_lowest_clamped(equations: Equations, turning: list[str]) -> float:
    """Find the lowest squared angular frequency of the beam with a clamped root [1/s2]."""
    pencil = equations.steady()
    clamped = np.delete(np.arange(equations.size), [equations.blocks[name].start for name in turning])
    K, M = (A[np.ix_(clamped, clamped)] for A in (pencil.K0, pencil.M))
    return float(1 / scipy.linalg.eigh(M, K, eigvals_only=True)[-1])


def _damping(equations: Equations, scene: Scene) -> Iterator[Term]:
    """Yield the terms of all that damps a scene."""
    names = {field.name: field.damping_name for field in FIELDS}
    damping = scene.damping
    if scene.damping_ratio or any(damping.ratios):
        yield from _damping_of_modes(equations, scene, names)
    factors = {2: damping.mass_factor, 0: damping.stiffness_factor}
    for term in equations.terms:
        if term.quantity == "unity" and factors.get(term.order):
            name, factor = names[term.rows], factors[term.order] * term.factor
            yield replace(term, name=name, order=1, factor=factor)
    if damping.tip_damper:
        yield from _tip_damper(equations, damping.tip_damper, names)


def _damping_of_modes(equations: Equations, scene: Scene, names: Mapping[str, str]) -> Iterator[Term]:
    """Yield the terms that give modes at rest their damping ratio: all of them one, or each its own."""
    pencil, sets = equations.steady(), equations.coupled
    parts = [pencil.part(equations.places(fields)) for fields in sets]
    ranks = _ranks(parts) if scene.damping.ratios else [None] * len(parts)
    of_modes = np.array(scene.damping.ratios_of(equations.size))
    for fields, part, rank in zip(sets, parts, ranks, strict=True):
        C = modal_damping(part.M, part.K0, part.shift, None if rank is None else of_modes[rank])
        ends = np.cumsum([equations.blocks[name].stop - equations.blocks[name].start for name in fields])[:-1]
        for row, blocks in zip(fields, np.split(C, ends), strict=True):
            for column, block in zip(fields, np.split(blocks, ends, axis=1), strict=True):
                yield Term(names[row], row, column, 1, block, factor=scene.damping_ratio or 1.0)


def _ranks(parts: Sequence[SteadyPencil]) -> list[np.ndarray]:
    """Place of each mode at rest of each set among those of all, in order of frequency, from 0."""
    compliance = [
        scipy.linalg.eigh(part.M, part.K0 + part.shift * part.M, eigvals_only=True)[::-1] for part in parts
    ]
    rank = np.argsort(np.argsort(-np.concatenate(compliance), kind="stable"))
    return np.split(rank, np.cumsum([len(each) for each in compliance])[:-1])


def _tip_damper(equations: Equations, damper: float, names: Mapping[str, str]) -> Iterator[Term]:
    """Yield the terms of a damper at the tip, against the whole deflection in each direction."""
    tips = {name: (d.direction, d.space.end(0)) for name, d in equations.deflections.items()}
    for row, (direction, tip) in tips.items():
        for column, (other, tip_of_other) in tips.items():
            if direction == other:
                yield Term(names[row], row, column, 1, np.outer(tip, tip_of_other), factor=damper)
