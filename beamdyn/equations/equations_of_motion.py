"""The equations of motion, as a list of terms.

M q'' + C q' + K q = f for the coordinates of all fields.  Each matrix is a sum of terms
``factor * quantity(t) * matrix``, where the quantity is one of a few of the root's motion, so that
batches over speeds, harmonic balance and the dropping of terms all read the same list.

Derivation and conventions: docs/conventions.md.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from beamdyn.equations.discretization import Discretization
from beamdyn.equations.fields import FIELDS
from beamdyn.equations.fields.field import Deflection, Load, Term
from beamdyn.equations.root_motion import Quantity, RootMotion, root_motion
from beamdyn.scene.motion import MotionSample
from beamdyn.scene.mount import Mount
from beamdyn.scene.scene import Scene


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
    """Equations of motion of a scene in one discretization, or in modal coordinates.

    Parameters
    ----------
    blocks : dict of str to slice
        Places of the fields' coordinates in q.
    terms : tuple of Term
        Left-hand side.
    loads : tuple of Load
        Right-hand side.
    mount : Mount
        How the beam is mounted.
    gravity : float
        Gravity [m/s2].
    deflections : dict of str to Deflection
        How the coordinates of the fields that move the beam transversely deflect it.
    """

    blocks: dict[str, slice]
    terms: tuple[Term, ...]
    loads: tuple[Load, ...]
    mount: Mount
    gravity: float
    deflections: dict[str, Deflection]

    @property
    def size(self) -> int:
        """Number n of coordinates."""
        return max(place.stop for place in self.blocks.values())

    @property
    def modes(self) -> int:
        """Largest number of coordinates of a field."""
        return max(place.stop - place.start for place in self.blocks.values())

    # The beam's shape in the coordinates ----------------------------------------------------------

    def deflection(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Derivatives with respect to x/L of the deflection by unit coordinates at xi (k,): shape (n, k)."""
        xi = np.asarray(xi, dtype=float)
        return self._over_coordinates(lambda d: d.evaluate(xi, order), xi.shape)

    @cached_property
    def tip(self) -> np.ndarray:
        """Tip deflection by unit coordinates, shape (n,)."""
        return self._over_coordinates(lambda d: d.tip)

    @property
    def P(self) -> np.ndarray:
        """Load under a unit root acceleration in the direction of bending [kg], shape (n,)."""
        return self._over_coordinates(lambda d: d.P)

    @property
    def Q(self) -> np.ndarray:
        """Load under a unit angular acceleration [kg m], shape (n,)."""
        return self._over_coordinates(lambda d: d.Q)

    def _over_coordinates(
        self, part: Callable[[Deflection], np.ndarray], shape: tuple[int, ...] = ()
    ) -> np.ndarray:
        """A part of the deflections over all coordinates, 0 for the fields that do not deflect."""
        total = np.zeros((self.size, *shape))
        for name, deflection in self.deflections.items():
            total[self.blocks[name]] = part(deflection)
        return total

    # Matrices and loads over the root's motion -----------------------------------------------------

    @cached_property
    def matrices(self) -> tuple[dict[Quantity, np.ndarray], ...]:
        """For each order 0, 1, 2 of the derivative, the sum of the matrices that one quantity multiplies."""
        sums: tuple[dict[Quantity, np.ndarray], ...] = ({}, {}, {})
        for term in self.terms:
            total = sums[term.order].setdefault(term.quantity, np.zeros((self.size, self.size)))
            total[self.blocks[term.rows], self.blocks[term.columns]] += term.factor * term.matrix
        return sums

    @cached_property
    def vectors(self) -> dict[Quantity, np.ndarray]:
        """The sum of the load vectors that one quantity multiplies."""
        sums: dict[Quantity, np.ndarray] = {}
        for load in self.loads:
            total = sums.setdefault(load.quantity, np.zeros(self.size))
            total[self.blocks[load.rows]] += load.factor * load.vector
        return sums

    def root(self, sample: MotionSample) -> RootMotion:
        """Motion of the root from that of the carrier."""
        return root_motion(self.mount, sample, self.gravity)

    def matrix(self, order: int, root: RootMotion) -> np.ndarray:
        """Sum of the terms of one order: shape (..., n, n) over the shape of `root`."""
        return _sum_over_quantities(self.matrices[order], root, (self.size, self.size))

    def load(self, root: RootMotion) -> np.ndarray:
        """Right-hand side: shape (..., n) over the shape of `root`."""
        return _sum_over_quantities(self.vectors, root, (self.size,))

    def steady(self) -> SteadyPencil:
        """The equations as a pencil in the speed, about a fixed centre and without gravity."""
        rest, turning = (root_motion(self.mount, MotionSample.steady(speed)) for speed in (0.0, 1.0))
        C = self.matrix(1, rest)
        # The stiffness per squared speed is summed apart from the far larger stiffness at rest.
        moving: dict[Quantity, np.ndarray] = {
            name: K for name, K in self.matrices[0].items() if name != "unity"
        }
        return SteadyPencil(
            M=self.matrix(2, rest),
            C=C,
            G=self.matrix(1, turning) - C,
            K0=self.matrix(0, rest),
            K2=_sum_over_quantities(moving, turning, (self.size, self.size)),
            f2=self.load(turning),
        )

    # Fewer coordinates ----------------------------------------------------------------------------

    def reduced(self, shapes: Mapping[str, np.ndarray]) -> Equations:
        """The equations in other coordinates: for each field, q = shapes[field] @ q_reduced.

        Parameters
        ----------
        shapes : mapping of str to ndarray, shape (n, m)
            The shapes of each field: its modes at rest, for instance.

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
            deflections={name: d.reduced(shapes[name]) for name, d in self.deflections.items()},
        )


def _sum_over_quantities(
    parts: Mapping[Quantity, np.ndarray], root: RootMotion, shape: tuple[int, ...]
) -> np.ndarray:
    """Sum of quantity times matrix or vector, over the shape of the root's motion."""
    total = np.zeros((*root.unity.shape, *shape))
    for quantity, part in parts.items():
        values = getattr(root, quantity)
        total += values.reshape(*values.shape, *(1 for _ in shape)) * part
    return total


def _place_blocks(sizes: Mapping[str, int]) -> dict[str, slice]:
    """Consecutive places for the coordinates of the fields."""
    blocks, start = {}, 0
    for name, size in sizes.items():
        blocks[name] = slice(start, start := start + size)
    return blocks


def assemble_equations(scene: Scene, discretization: Discretization) -> Equations:
    """Assemble the equations of motion of a scene, field by field.

    Parameters
    ----------
    scene : Scene
        Beam, mount, damping and gravity.
    discretization : Discretization
        Ritz functions or finite elements.

    Returns
    -------
    Equations
        Terms whose factor or matrix is zero in the scene are left out.
    """
    spaces = discretization.spaces(scene.beam)
    parts = {f.name: f.assemble(scene, spaces) for f in FIELDS if f.is_modelled(scene)}
    return Equations(
        blocks=_place_blocks({name: part.size for name, part in parts.items()}),
        terms=tuple(t for part in parts.values() for t in part.terms if t.factor and t.matrix.any()),
        loads=tuple(f for part in parts.values() for f in part.loads if f.factor),
        mount=scene.mount,
        gravity=scene.gravity,
        deflections={name: part.deflection for name, part in parts.items() if part.deflection is not None},
    )
