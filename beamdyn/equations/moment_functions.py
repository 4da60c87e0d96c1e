"""Assumed modes by bending moments: polynomials over the whole beam, divided by its stiffness.

At a station where properties have a kink or a jump, the curvature of a beam has one, too; its bending moment
is smooth.  Trial functions with the curvature

    w'' = P(x/L) / EI(x)

for Legendre polynomials P over the whole beam thus need no more functions for a hundred segments than for
one.  Of a deflection by shear and of a stretch, it is the slope that is a force over a stiffness.  Twisted
sections bend in both directions under a moment in one: the curvature in each direction is a product with
entries of their compliance.

The quotients are interpolated by polynomials on cells.  The functions are thus piecewise polynomials, of
which integrals are exact, and eigenvalues are upper bounds as those of other assumed modes.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property, lru_cache

import numpy as np
from numpy.polynomial import legendre

from beamdyn.common.legendre import gauss_points_on, gauss_rule, legendre_series
from beamdyn.common.pickling import FieldsOnly
from beamdyn.equations.arc_quadrature import ArcQuadrature, Cells
from beamdyn.equations.discretization import RootConditions
from beamdyn.equations.sampled_space import SampledSpace, product_of
from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import Profile
from beamdyn.scene.sections import Tensor, section_tensor, weight_degree

_NODES = 16  # on each cell, through which the quotients are interpolated
_RESOLVED = 1e-9  # last coefficients of an interpolant over the largest; eigenvalues depend on their square
_PHASE = 12.0  # largest change of phase of the highest polynomial within a cell [rad]
_SHORTEST = 1e-10  # cell that is halved, as x/L
_DEPENDENT = 1e-9  # part of a function that those before it lack, below which it is left out

_STIFFNESSES = ("bending_stiffness", "shear_stiffness", "axial_stiffness")


@dataclass(frozen=True)
class MomentSpaces(FieldsOnly):
    """Function spaces of moments, and of other forces, on a beam.

    Parameters
    ----------
    beam : Beam
        The beam, with the modelled properties.
    polynomials : int
        Number of polynomials over the beam.
    """

    beam: Beam
    polynomials: int

    def functions(self, conditions: RootConditions) -> MomentSpace:
        """Trial functions that satisfy conditions at the root."""
        return _build_space(self, conditions)

    def product(
        self, weight: Profile, rows: RootConditions, columns: RootConditions, orders: tuple[int, int] = (0, 0)
    ) -> np.ndarray:
        """Integrate the weight times derivatives of functions i of `rows` and j of `columns`."""
        return product_of(self.functions(rows), self.functions(columns), weight, orders)

    @cached_property
    def cells(self) -> np.ndarray:
        """Ends of cells on which every compliance and the highest polynomial are resolved, as x/L."""
        ends = np.array(self.beam.breakpoints)
        while (coarse := self._are_coarse(ends)).any():
            ends = np.sort(np.concatenate([ends, (ends[:-1] + ends[1:])[coarse] / 2]))
        return ends

    def _are_coarse(self, ends: np.ndarray) -> np.ndarray:
        """Whether each cell is to be halved."""
        coarse = np.diff(np.arccos(1 - 2 * ends)) * self.polynomials > _PHASE
        xi = gauss_points_on(ends, _NODES)
        for name in _STIFFNESSES:
            for entry in invert(stiffness_tensor(self.beam, name), xi).values():
                coarse |= ~_are_resolved(entry)
        return coarse & (np.diff(ends) > _SHORTEST)

    @cached_property
    def quadrature(self) -> ArcQuadrature:
        """Gauss rule that integrates products of the functions with properties exactly."""
        return ArcQuadrature(Cells(self.cells, _NODES + 3 + weight_degree(self.beam) // 2))


@lru_cache(maxsize=16)  # fields of a scene, and pairs of them, ask for the same functions
def _build_space(spaces: MomentSpaces, conditions: RootConditions) -> MomentSpace:
    return MomentSpace(spaces, conditions)


# Compliance of sections ---------------------------------------------------------------------------


def stiffness_tensor(beam: Beam, name: str) -> Tensor:
    """A stiffness of the sections in the directions e1, e2; that against stretch has one entry."""
    if name == "axial_stiffness":
        return {} if beam.axial_stiffness is None else {(0, 0): beam.axial_stiffness}
    return section_tensor(beam, name)


def invert(tensor: Tensor, xi: np.ndarray) -> dict[tuple[int, int], np.ndarray]:
    """Entries at xi of the inverse of a tensor of sections, by directions."""
    values = {entry: profile(xi) for entry, profile in tensor.items()}
    if (0, 1) not in values:
        return {entry: 1 / value for entry, value in values.items()}
    determinant = values[0, 0] * values[1, 1] - values[0, 1] ** 2
    oblique = -values[0, 1] / determinant
    return {
        (0, 0): values[1, 1] / determinant,
        (0, 1): oblique,
        (1, 0): oblique,
        (1, 1): values[0, 0] / determinant,
    }


def _are_resolved(values: np.ndarray) -> np.ndarray:
    """Whether interpolants through the nodes of each cell resolve functions with these values (c, nodes)."""
    series = np.abs(values @ legendre_series(_NODES).T)
    return series[:, -2:].max(axis=1) <= _RESOLVED * series.max(axis=1)


@cache
def _interpolation(points: int) -> np.ndarray:
    """Values at Gauss points of the interpolants through fewer: shape (points, nodes)."""
    return legendre.legvander(gauss_rule(points)[0], _NODES - 1) @ legendre_series(_NODES)


# Functions ----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class MomentSpace(SampledSpace):
    """Trial functions with a highest derivative that is a polynomial over a stiffness.

    Their highest derivatives are orthonormal with the stiffness in their direction as weight; a rotation
    about the root stands before them where the root turns.

    Parameters
    ----------
    spaces : MomentSpaces
        Beam and number of polynomials.
    conditions : RootConditions
        Conditions at the root, with the stiffness and its direction.
    """

    spaces: MomentSpaces
    conditions: RootConditions

    @property
    def points(self) -> np.ndarray:
        """Points of the Gauss rule on [0, 1], shape (k,)."""
        return self.spaces.quadrature.xi

    @property
    def rule(self) -> np.ndarray:
        """Weights of the Gauss rule, shape (k,)."""
        return self.spaces.quadrature.weights

    @property
    def _turns(self) -> bool:
        return self.conditions.held < self.conditions.derivatives

    @cached_property
    def _quotients(self) -> np.ndarray:
        """Orthonormal quotients of polynomials and stiffness at the points, shape (m, k)."""
        tensor = stiffness_tensor(self.spaces.beam, self.conditions.stiffness)
        direction, xi = self.conditions.direction, gauss_points_on(self.spaces.cells, _NODES)
        entries = [c for (i, _), c in invert(tensor, xi).items() if i == direction]
        polynomials = legendre.legvander(2 * xi - 1, self.spaces.polynomials - 1)
        at_nodes = polynomials[..., None] * np.stack(entries, axis=-1)[:, :, None, :]
        to_points = _interpolation(self.spaces.quadrature.cells.points)
        at_points = to_points @ at_nodes.reshape(*xi.shape, -1)
        weight = self.weights(tensor[direction, direction])
        return _orthonormalize(at_points.reshape(len(weight), -1), weight).T

    @cached_property
    def _derivatives(self) -> list[np.ndarray]:
        """Values and derivatives at the points, and at the tip but of the highest derivative: (n, k + 1)."""
        rows = [self._quotients]
        for _order in reversed(range(self.conditions.derivatives)):
            rows.insert(0, self.spaces.quadrature.integrate(rows[0][:, : len(self.rule)]))
        if not self._turns:
            return rows
        xi = np.append(self.points, 1.0)
        rigid = [xi, np.ones_like(xi), np.zeros_like(self.points)]
        return [np.concatenate([r[None], row]) for r, row in zip(rigid, rows, strict=True)]

    @cached_property
    def samples(self) -> list[np.ndarray]:
        """Values of the functions and of each derivative at the points."""
        return [values[:, : len(self.rule)] for values in self._derivatives]

    def end(self, order: int) -> np.ndarray:
        """Evaluate the `order`-th derivatives at the tip."""
        if order < self.conditions.derivatives:
            return self._derivatives[order][:, -1]
        return self.evaluate(np.ones(1), order)[:, 0]

    def evaluate(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Evaluate the `order`-th derivatives at xi."""
        xi, quadrature = np.asarray(xi, dtype=float), self.spaces.quadrature
        if order == self.conditions.derivatives:
            return self.samples[order] @ quadrature.interpolate_to(xi).T
        values = self.samples[order + 1] @ quadrature.integrate_to(xi).T
        if self._turns and order == 1:
            values[0] = 1.0  # the slope of the rotation is there at the root, too
        return values


def _orthonormalize(columns: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Orthonormal combinations of columns (k, n), each of the columns up to its own, with a weight (k,).

    What depends on the columns before it is left out.
    """
    root = np.sqrt(weight)[:, None]
    scaled = columns * root
    Q, R = np.linalg.qr(scaled / np.linalg.norm(scaled, axis=0))
    return Q[:, np.abs(np.diag(R)) > _DEPENDENT] / root
