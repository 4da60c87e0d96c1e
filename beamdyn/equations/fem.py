"""Finite elements by scikit-fem: cubic Hermite elements for deflection, quadratic ones for stretch.

In shapes of arrays, n and m count functions, and k positions.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any, Literal

import numpy as np
from skfem import Basis, BilinearForm, ElementLineHermite, ElementLineP2, LinearForm, Mesh, MeshLine

from beamdyn.common.inputs.checks import count, one_of, refuse, set_fields
from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.equations.discretization import HINGED, Cells, RootConditions
from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import Profile
from beamdyn.scene.sections import weight_degree

_ACROSS = 8  # number of functions across the width of a plate
MOST_ELEMENTS = 1000  # largest accepted number of elements
# Largest number of elements that `finer` chooses: where more are needed, Ritz functions are more efficient.
MOST_REFINED = 100
# Shortest segment, as a fraction of the length: on shorter ones rounding leaves no correct digit.
_SHORTEST = 1e-5 * (1 - 1e-9)
_POINTS = 5  # number of Gauss points on each element, enough for cosine and sine of the slope
_GRADING = 3.0  # the element size grows from the root to the tip by the factor 1 + 2 _GRADING
# Elements by the order of derivatives in the energy: 2 for bending deflection, 1 for stretch.
_ELEMENTS = {2: ElementLineHermite, 1: ElementLineP2}


@dataclass(frozen=True)
class Fem:
    """Finite-element discretization of a beam by Euler-Bernoulli elements.

    Parameters
    ----------
    elements : int
        Number of elements, from 2 to 1000; a node stands at each breakpoint of the beam.
    mesh : {"graded", "uniform"}
        Graded elements shrink towards the root, where a fast outward beam has a boundary layer.
    on_each : int
        Smallest number of elements on each segment between breakpoints; the coarser mesh has half of it.

    References
    ----------
    Standard: cubic Hermite elements, extrapolated after Richardson (1911).

    Examples
    --------
    >>> scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0))
    >>> modes = bd.natural_modes(scene, modes=1, discretization=bd.Fem(elements=20))
    >>> round(2 * np.pi * float(modes.frequency[0]), 6)  # 1.8751...^2
    3.516015
    """

    elements: int = 80
    mesh: Literal["graded", "uniform"] = "graded"
    on_each: int = 2

    def __post_init__(self) -> None:
        remedy = "discretization='ritz' needs far fewer"
        set_fields(self, elements=count("elements", self.elements, 2, MOST_ELEMENTS, remedy))
        one_of("mesh", self.mesh, ("graded", "uniform"))
        set_fields(self, on_each=count("on_each", self.on_each, 1, MOST_ELEMENTS, remedy))

    def __repr__(self) -> str:
        on_each = "" if self.on_each == 2 else f", on_each={self.on_each}"
        return f"Fem(elements={self.elements}, mesh={self.mesh!r}{on_each})"

    def __str__(self) -> str:
        mesh = "" if self.mesh == "graded" else " on a uniform mesh"
        least = "" if self.on_each == 2 else f", at least {self.on_each} on each segment"
        return f"{self.elements} finite elements{mesh}{least}"

    @property
    def order(self) -> int:
        """Order of convergence of eigenvalues, as a power of the element length."""
        return 4

    @property
    def converges_regularly(self) -> bool:
        """True: refinement reduces the eigenvalue error steadily, as a power of the element length."""
        return True

    @property
    def rounding(self) -> float:
        """Relative rounding error of eigenvalues, in proportion to the cubed number of elements."""
        return 4 * float(np.finfo(float).eps) * self.elements**3

    def nodes(self, beam: Beam) -> np.ndarray:
        """Compute the positions x/L of nodes; segments have elements in proportion to their length."""
        ends = _meshable(np.array(beam.breakpoints))
        g = 0.0 if self.mesh == "uniform" else _GRADING
        # The mesh is uniform over s, with x/L = (s + g s^2) / (1 + g): with g = 3, elements at the root are
        # seven times shorter than at the tip.
        over_s = (np.sqrt(1 + 4 * g * (1 + g) * ends) - 1) / (2 * g) if g else ends
        counts = _distribute(self.elements, np.diff(over_s), self.on_each)
        parts = [np.linspace(a, b, n + 1)[:-1] for (a, b), n in zip(pairwise(over_s), counts, strict=True)]
        steps = np.concatenate([*parts, over_s[-1:]])
        nodes = (steps + g * steps**2) / (1 + g)
        for end in ends:  # rounding must not leave a tiny segment next to a breakpoint
            nodes[np.abs(nodes - end).argmin()] = end
        return nodes

    def spaces(self, beam: Beam) -> FemSpaces:
        """Build the function spaces on a beam."""
        order = 6 + min(8, weight_degree(beam))
        return FemSpaces(self.nodes(beam), order)

    def cells(self, beam: Beam) -> Cells:
        """Return the elements as integration cells of the beam."""
        return Cells(self.nodes(beam), _POINTS)

    def coarser(self) -> Fem:
        """Return a mesh of half as many elements."""
        return replace(self, elements=max(2, self.elements // 2), on_each=max(1, self.on_each // 2))

    def finer(self) -> Fem | None:
        """Return a mesh with a quarter more elements, up to 100; None at 100 or more."""
        if self.elements >= MOST_REFINED:
            return None
        return replace(self, elements=min(MOST_REFINED, 5 * self.elements // 4))

    def fits(self, modes: int) -> bool:
        """Return whether even the coarser mesh has enough functions for a number of modes."""
        return 2 * self.coarser().elements >= modes


def _meshable(ends: np.ndarray) -> np.ndarray:
    """Return the ends x/L of segments; raise an error if one is so short that rounding spoils elements."""
    lengths = np.diff(ends)
    bound = "a segment between breakpoints must be at least 1e-5 of the length for finite elements"
    remedy = "replace it by a jump of the section, or take discretization='ritz'"
    refuse(lengths < _SHORTEST, "breakpoints: difference of x/L", lengths, "", bound, remedy)
    return ends


def _distribute(total: int, lengths: np.ndarray, least: int) -> np.ndarray:
    """Distribute a number of elements over segments by their length, with at least `least` on each.

    Short segments are refined too: each has at least half of the mean number of elements, unless that makes
    its elements more than ten times shorter than the mean, where rounding errors prevail.
    """
    part = lengths / lengths.sum()
    share = np.minimum(np.maximum(part, 0.5 / len(part)), 10 * part)
    counts = np.maximum(least, np.floor(total * share / share.sum()).astype(int))
    while counts.sum() < total:
        counts[np.argmax(lengths / counts)] += 1
    return counts


@dataclass(frozen=True)
class FemSpaces(FieldsOnly):
    """Function spaces on one finite-element mesh with one quadrature rule.

    Parameters
    ----------
    nodes : ndarray, shape (n + 1,)
        Positions x/L of the nodes of n elements.
    order : int
        Polynomial degree that the quadrature integrates exactly.
    """

    nodes: np.ndarray
    order: int

    @cached_property
    def mesh(self) -> Mesh:
        """scikit-fem's mesh of elements over x/L."""
        return MeshLine(self.nodes)

    def functions(self, conditions: RootConditions) -> FemSpace:
        """Build trial functions that satisfy conditions at the root."""
        return FemSpace(self, RootConditions(conditions.held, conditions.derivatives))

    def product(
        self, weight: Profile, rows: RootConditions, columns: RootConditions, orders: tuple[int, int] = (0, 0)
    ) -> np.ndarray:
        """Integrate a weight times derivatives of two functions over x/L, for all pairs of functions.

        The rows of the result are functions with the root conditions `rows`, its columns are functions with
        the root conditions `columns`; `orders` are the orders of the two derivatives.
        """
        return _integrate(self.functions(rows), self.functions(columns), weight, orders)

    @property
    def across(self) -> int:
        """Number of functions across the width of a plate, without the constant one."""
        return _ACROSS

    @property
    def fewer_across(self) -> int:
        """Number of functions across the width in the coarser model: the same, as only meshes are coarser."""
        return _ACROSS

    def shares_functions(self, other: FemSpaces) -> bool:
        """Return whether other finite-element spaces have the same nodes."""
        return np.array_equal(self.nodes, other.nodes)


@dataclass(frozen=True)
class FemSpace(FieldsOnly):
    """Finite-element functions that satisfy boundary conditions at the root.

    For a hinged root, one function is the rigid rotation x/L of the beam, instead of bending of the first
    element: its curvature is exactly 0, so that no rounding error can exceed the stiffness of a soft spring.

    Parameters
    ----------
    spaces : FemSpaces
        Mesh and quadrature.
    conditions : RootConditions
        Boundary conditions; each derivative that vanishes at the root fixes one degree of freedom.
    """

    spaces: FemSpaces
    conditions: RootConditions

    @cached_property
    def basis(self) -> Basis:
        """scikit-fem's basis: mesh, element and quadrature."""
        # Each basis needs a new element, because ElementLineHermite caches the matrix of its first mesh.
        return Basis(self.spaces.mesh, _ELEMENTS[self.conditions.derivatives](), intorder=self.spaces.order)

    @property
    def free(self) -> np.ndarray:
        """Indices of the degrees of freedom that are not fixed at the root."""
        root = np.asarray(self.basis.nodal_dofs)[: self.conditions.held, 0]
        return np.setdiff1d(np.arange(self.basis.N), root)

    @property
    def size(self) -> int:
        """Number n of trial functions."""
        return self.basis.N - self.conditions.held

    @property
    def turns(self) -> bool:
        """Whether the first trial function is a rotation of the beam about its root."""
        return self.conditions == HINGED

    @cached_property
    def points(self) -> np.ndarray:
        """Quadrature points x/L on each element."""
        return np.asarray(self.basis.global_coordinates())[0]

    @property
    def coarse(self) -> None:
        """None: functions of a coarser mesh are linear combinations of these functions, not a subset."""
        return None

    def weights(self, weight: Profile) -> np.ndarray:
        """Evaluate a property of the beam at the quadrature points, as the weight of integrals."""
        return weight(self.points)

    def gram(self, weight: Profile, order: int) -> np.ndarray:
        """Integrate a weight times the `order`-th derivatives of all pairs of functions."""
        return _integrate(self, self, weight, (order, order))

    def load(self, weight: Profile, order: int = 0) -> np.ndarray:
        """Integrate a weight times the `order`-th derivative of each function."""
        return self.integrate(self.weights(weight), order)

    def integrate(self, values: np.ndarray, order: int) -> np.ndarray:
        """Integrate values at the quadrature points times the `order`-th derivative of each function."""
        vector = _LOADS[order].assemble(self.basis, weight=values)[self.free]
        if self.turns:
            vector[0] = (self.basis.dx * values * _turn(self.points, order)).sum()
        return vector

    def end(self, order: int) -> np.ndarray:
        """Evaluate the `order`-th derivatives of the functions at the tip."""
        return self.evaluate(np.array([1.0]), order)[:, 0]

    def evaluate(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Evaluate the `order`-th derivatives of the functions at k positions xi: (functions, k)."""
        x = np.asarray(xi, dtype=float)[None, :]
        mesh, element, mapping = self.basis.mesh, self.basis.elem, self.basis.mapping
        cells = mesh.element_finder(mapping=mapping)(*x)
        local = mapping.invF(x[:, :, None], tind=cells)
        values = np.zeros((self.basis.N, x.size))
        for k in range(self.basis.Nbfun):
            field = element.gbasis(mapping, local, k, tind=cells)[0]
            derivative: Any = field if order == 0 else (field.grad, field.hess)[order - 1]
            values[self.basis.element_dofs[k, cells], np.arange(x.size)] = np.reshape(derivative, x.size)
        kept = values[self.free]
        if self.turns:
            kept[0] = _turn(x[0], order)
        return kept


def _turn(xi: np.ndarray, order: int) -> np.ndarray:
    """Evaluate the `order`-th derivative at xi of x/L, the rigid rotation about the root."""
    return (xi, np.ones_like(xi), np.zeros_like(xi))[order]


def _integrate(rows: FemSpace, columns: FemSpace, weight: Profile, orders: tuple[int, int]) -> np.ndarray:
    """Integrate over x/L a weight times derivatives of two functions, one of `rows` and one of `columns`.

    The result is a matrix over all pairs of functions; `orders` are the orders of the two derivatives.
    """
    values = rows.weights(weight)
    assembled = _PRODUCTS[orders].assemble(columns.basis, rows.basis, weight=values)
    matrix = assembled.toarray()[np.ix_(rows.free, columns.free)]
    if rows.turns:
        matrix[0] = columns.integrate(values * _turn(rows.points, orders[0]), orders[1])
    if columns.turns:
        matrix[:, 0] = rows.integrate(values * _turn(columns.points, orders[1]), orders[0])
    return matrix


# Weak forms: scikit-fem calls them, and has no type annotations for their arguments.


def _derivative(u: Any, order: int) -> Any:
    if order == 0:
        return u
    return u.grad[0] if order == 1 else u.hess[0][0]


# Weak forms of products of two derivatives, by the orders of derivatives for rows and columns; scikit-fem
# passes the function of the columns first.
_PRODUCTS = {
    (a, b): BilinearForm(lambda u, v, w, a=a, b=b: w.weight * _derivative(u, b) * _derivative(v, a))
    for a in range(3)
    for b in range(3)
}
_LOADS = tuple(LinearForm(lambda v, w, a=a: w.weight * _derivative(v, a)) for a in range(3))
