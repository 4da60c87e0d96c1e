"""Finite elements: cubic Hermite deflection and quadratic stretch, through scikit-fem."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, Literal

import numpy as np
from skfem import Basis, BilinearForm, ElementLineHermite, ElementLineP2, LinearForm, Mesh, MeshLine

from beamdyn.common.checks import count
from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import Profile

MOST_ELEMENTS = 1000
_ENOUGH = 100
_GRADING = 3.0
# Continuous values and slopes, or values, by the number of derivatives that vanish at the root.
_ELEMENTS = {2: ElementLineHermite, 1: ElementLineP2}


@dataclass(frozen=True)
class Fem:
    """Euler-Bernoulli beam elements.

    Parameters
    ----------
    elements : int
        Number of elements, from 2 to 1000; a node stands at each breakpoint of the beam.
    mesh : {"graded", "uniform"}
        Whether elements shrink towards the root, where a fast outward beam has a boundary layer.
    """

    elements: int = 80
    mesh: Literal["graded", "uniform"] = "graded"

    def __post_init__(self) -> None:
        if count("elements", self.elements, least=2) > MOST_ELEMENTS:
            raise ValueError(
                f"elements = {self.elements}: at most {MOST_ELEMENTS}; discretization='ritz' needs far fewer"
            )
        if self.mesh not in ("graded", "uniform"):
            raise ValueError(f"mesh = {self.mesh!r}: give 'graded' or 'uniform'")

    @property
    def order(self) -> int:
        """Eigenvalues converge with the fourth power of the element length."""
        return 4

    @property
    def rounding(self) -> float:
        """Grows with the third power of the number of elements (2e-10 seen with 100)."""
        return 4 * float(np.finfo(float).eps) * self.elements**3

    def nodes(self, beam: Beam) -> np.ndarray:
        """Nodes x/L: elements shared out among the segments by length, at least one each."""
        edges = np.array(beam.breakpoints)
        steps = _subdivide(edges if self.mesh == "uniform" else _ungrade(edges), self.elements)
        nodes = steps if self.mesh == "uniform" else _grade(steps)
        for edge in edges:  # rounding must not leave a sliver beside a breakpoint
            nodes[np.abs(nodes - edge).argmin()] = edge
        return nodes

    def spaces(self, beam: Beam) -> FemSpaces:
        """The function spaces on a beam."""
        order = 6 + min(8, max(beam.mass_per_length.degree + 2, beam.bending_stiffness.degree))
        return FemSpaces(MeshLine(self.nodes(beam)), order)

    def coarser(self) -> Fem:
        """Half as many elements."""
        return replace(self, elements=max(2, self.elements // 2))

    def finer(self) -> Fem | None:
        """A quarter as many again, up to 100 elements: past them Ritz functions are the better tool."""
        if self.elements >= _ENOUGH:
            return None
        return replace(self, elements=min(_ENOUGH, 5 * self.elements // 4))

    def fits(self, modes: int) -> bool:
        """Whether the coarser mesh has functions enough for so many modes."""
        return 2 * self.coarser().elements >= modes


def _grade(s: np.ndarray) -> np.ndarray:
    """Positions of equal steps s in a mesh that is seven times as fine at the root as at the tip."""
    return (s + _GRADING * s**2) / (1 + _GRADING)


def _ungrade(xi: np.ndarray) -> np.ndarray:
    """Inverse of `_grade`."""
    return (np.sqrt(1 + 4 * _GRADING * (1 + _GRADING) * xi) - 1) / (2 * _GRADING)


def _subdivide(edges: np.ndarray, elements: int) -> np.ndarray:
    """Equal steps on each segment, as many as its share."""
    shares = _share(elements, np.diff(edges))
    parts = [np.linspace(a, b, n + 1)[:-1] for (a, b), n in zip(pairwise(edges), shares, strict=True)]
    return np.concatenate([*parts, edges[-1:]])


def _share(total: int, lengths: np.ndarray) -> np.ndarray:
    """Share elements among segments in proportion to their length, at least one each."""
    shares = np.maximum(1, np.floor(total * lengths / lengths.sum()).astype(int))
    while shares.sum() < total:
        shares[np.argmax(lengths / shares)] += 1
    return shares


@dataclass(frozen=True)
class FemSpaces:
    """The spaces of one mesh, over one quadrature rule.

    Parameters
    ----------
    mesh : skfem.Mesh
        Nodes x/L.
    order : int
        Polynomial degree that the quadrature integrates exactly.
    """

    mesh: Mesh
    order: int

    def functions(self, held: int) -> FemSpace:
        """Functions whose derivatives 0 ... held - 1 vanish at the root: 2 clamped, 1 fixed."""
        # a new element for each basis: ElementLineHermite keeps the matrix of the first mesh it meets
        return FemSpace(Basis(self.mesh, _ELEMENTS[held](), intorder=self.order), held)

    def product(self, weight: Profile, rows: int, columns: int) -> np.ndarray:
        """Integrals of weight times function i of ``functions(rows)`` and j of ``functions(columns)``."""
        first, second = self.functions(rows), self.functions(columns)
        matrix = _product.assemble(second.basis, first.basis, weight=first.weights(weight))
        return matrix.toarray()[np.ix_(first.free, second.free)]


@dataclass(frozen=True)
class FemSpace:
    """Functions of a mesh without those that the root holds.

    Parameters
    ----------
    basis : skfem.Basis
        Mesh, element and quadrature.
    held : int
        Number of degrees of freedom held at the root: deflection and slope, or the stretch.
    """

    basis: Basis
    held: int

    @property
    def free(self) -> np.ndarray:
        """Degrees of freedom that the root leaves free."""
        root = np.asarray(self.basis.nodal_dofs)[: self.held, 0]
        return np.setdiff1d(np.arange(self.basis.N), root)

    @property
    def size(self) -> int:
        """Number of functions."""
        return self.basis.N - self.held

    def weights(self, weight: Profile) -> np.ndarray:
        """A property at the quadrature points."""
        return weight(np.asarray(self.basis.global_coordinates())[0])

    def gram(self, weight: Profile, order: int) -> np.ndarray:
        """Integrals of weight times derivatives of functions i and j."""
        matrix = _GRAMS[order].assemble(self.basis, weight=self.weights(weight))
        return matrix.toarray()[np.ix_(self.free, self.free)]

    def load(self, weight: Profile) -> np.ndarray:
        """Integrals of weight times function i."""
        return _load.assemble(self.basis, weight=self.weights(weight))[self.free]

    def end(self, order: int) -> np.ndarray:
        """Derivatives at the tip."""
        return self.evaluate(np.array([1.0]), order)[:, 0]

    def evaluate(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Derivatives at xi."""
        x = np.asarray(xi, dtype=float)[None, :]
        mesh, element, mapping = self.basis.mesh, self.basis.elem, self.basis.mapping
        cells = mesh.element_finder(mapping=mapping)(*x)
        local = mapping.invF(x[:, :, None], tind=cells)
        values = np.zeros((self.basis.N, x.size))
        for k in range(self.basis.Nbfun):
            field = element.gbasis(mapping, local, k, tind=cells)[0]
            derivative: Any = field if order == 0 else (field.grad, field.hess)[order - 1]
            values[self.basis.element_dofs[k, cells], np.arange(x.size)] = np.reshape(derivative, x.size)
        return values[self.free]


# Weak forms; u and v are scikit-fem's fields, whose types its forms leave open


@BilinearForm
def _product(u: Any, v: Any, w: Any) -> Any:
    return w.weight * u * v


@BilinearForm
def _slopes(u: Any, v: Any, w: Any) -> Any:
    return w.weight * u.grad[0] * v.grad[0]


@BilinearForm
def _curvatures(u: Any, v: Any, w: Any) -> Any:
    return w.weight * u.hess[0][0] * v.hess[0][0]


@LinearForm
def _load(v: Any, w: Any) -> Any:
    return w.weight * v


_GRAMS = (_product, _slopes, _curvatures)
