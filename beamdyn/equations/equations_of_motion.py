"""The equations of motion, as a list of terms.

M q'' + C q' + K q = f for the coordinates q of all fields.  Each matrix is a sum of terms
``factor * quantity(t) * matrix`` with a quantity of the root's motion: batches over speeds, harmonic balance
and the omission of terms all read this one list.

Derivation and conventions: docs/conventions.md.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from beamdyn.equations.discretization import Discretization, Spaces
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
    """

    M: np.ndarray
    C: np.ndarray
    G: np.ndarray
    K0: np.ndarray
    K2: np.ndarray
    f2: np.ndarray

    def block(self, place: slice) -> SteadyPencil:
        """Extract the equations of one field, without damping and gyroscopic coupling."""
        M, K0, K2 = (A[place, place] for A in (self.M, self.K0, self.K2))
        return SteadyPencil(M, np.zeros_like(M), np.zeros_like(M), K0, K2, self.f2[place])

    @property
    def conservative(self) -> bool:
        """Whether there is neither damping nor gyroscopic coupling."""
        return not (self.C.any() or self.G.any())


@dataclass(frozen=True)
class Equations:
    """Equations of motion of a scene in one discretization, or in modal coordinates.

    Parameters
    ----------
    blocks : dict of str to slice
        Slice of q that holds the coordinates of each field.
    terms : tuple of Term
        Terms of the left-hand side.
    loads : tuple of Load
        Terms of the right-hand side.
    mount : Mount
        Mount of the beam on the carrier.
    gravity : float
        Gravitational acceleration [m/s2].
    shapes : dict of str to ndarray, shape (m, n)
        Shapes of the n coordinates of each field, in columns, as coefficients of the m functions of the
        discretization; the identity before a reduction.
    deflections : dict of str to Deflection
        Functions and loads of each field that deflects the beam.
    """

    blocks: dict[str, slice]
    terms: tuple[Term, ...]
    loads: tuple[Load, ...]
    mount: Mount
    gravity: float
    shapes: dict[str, np.ndarray]
    deflections: dict[str, Deflection]

    @property
    def size(self) -> int:
        """Number n of coordinates."""
        return max(place.stop for place in self.blocks.values())

    @property
    def modes(self) -> int:
        """Largest number of coordinates of a field."""
        return max(place.stop - place.start for place in self.blocks.values())

    # Deflection of the beam by the coordinates ----------------------------------------------------

    def deflection(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Derivatives with respect to x/L of the deflection per coordinate, at xi (k,): shape (n, k)."""
        xi = np.asarray(xi, dtype=float)
        return self._over_coordinates(lambda d: d.space.evaluate(xi, order), xi.shape)

    @cached_property
    def tip(self) -> np.ndarray:
        """Tip deflection per coordinate, shape (n,)."""
        return self._over_coordinates(lambda d: d.space.end(0))

    @property
    def P(self) -> np.ndarray:
        """Load under a unit root acceleration in the direction of bending [kg], shape (n,)."""
        return self._over_coordinates(lambda d: d.P)

    @property
    def Q(self) -> np.ndarray:
        """Load under a unit angular acceleration [kg m], shape (n,)."""
        return self._over_coordinates(lambda d: d.Q)

    def _over_coordinates(
        self, quantity: Callable[[Deflection], np.ndarray], shape: tuple[int, ...] = ()
    ) -> np.ndarray:
        """Gather a quantity of the functions over all coordinates; 0 for fields that do not deflect."""
        values = np.zeros((self.size, *shape))
        for name, deflection in self.deflections.items():
            values[self.blocks[name]] = self.shapes[name].T @ quantity(deflection)
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
        rest, rotating = (root_motion(self.mount, MotionSample.steady(speed)) for speed in (0.0, 1.0))
        C = self.matrix(1, rest)
        # The difference from the far larger stiffness at rest would lose digits.
        varying: dict[Quantity, np.ndarray] = {
            name: K for name, K in self.matrices[0].items() if name != "unity"
        }
        return SteadyPencil(
            M=self.matrix(2, rest),
            C=C,
            G=self.matrix(1, rotating) - C,
            K0=self.matrix(0, rest),
            K2=_sum_over_quantities(varying, rotating, (self.size, self.size)),
            f2=self.load(rotating),
        )

    # Reduction to fewer coordinates -----------------------------------------------------------------

    def reduced(self, shapes: Mapping[str, np.ndarray]) -> Equations:
        """Transform the equations to other coordinates: for each field, q = shapes[field] @ q_reduced.

        Parameters
        ----------
        shapes : mapping of str to ndarray, shape (n, m)
            Basis of each field, in columns: its modes at rest, for instance.

        Returns
        -------
        Equations
        """
        terms = (replace(t, matrix=shapes[t.rows].T @ t.matrix @ shapes[t.columns]) for t in self.terms)
        loads = (replace(f, vector=shapes[f.rows].T @ f.vector) for f in self.loads)
        return replace(
            self,
            blocks=_place_blocks({name: shapes[name].shape[1] for name in self.blocks}),
            terms=tuple(terms),
            loads=tuple(loads),
            shapes={name: self.shapes[name] @ shapes[name] for name in self.blocks},
        )


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


def assemble_equations(scene: Scene, discretization: Discretization) -> Equations:
    """Assemble the equations of motion of a scene in a discretization: see `assemble_over`."""
    return assemble_over(scene, discretization.spaces(scene.beam))


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
    return Equations(
        blocks=_place_blocks({name: field.size for name, field in fields.items()}),
        terms=tuple(t for field in fields.values() for t in field.terms if t.factor and t.matrix.any()),
        loads=tuple(f for field in fields.values() for f in field.loads if f.factor),
        mount=scene.mount,
        gravity=scene.gravity,
        shapes={name: np.eye(field.size) for name, field in fields.items()},
        deflections={name: f.deflection for name, f in fields.items() if f.deflection is not None},
    )
