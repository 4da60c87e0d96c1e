"""Assumed modes by bending moments, for beams of many segments.

Where properties have a kink or a jump, at each station of a table, the curvature of a beam has one, too;
its bending moment M is smooth.  Trial functions with the curvature

    w'' = M(x) / EI(x)

thus need no more functions for a hundred segments than for one.  The moments are polynomials over the whole
beam, and those that inertia and tension cause where the first of these functions vibrate,

    int_x^1 int_s^1 rho A w,  int_x^1 N w',

which have the small roughness of M that polynomials lack: as one step of inverse iteration would.  Of a
deflection by shear and of a stretch, it is the slope that is a force over a stiffness.  Twisted sections bend
in both directions under a moment in one: curvatures are products with entries of their compliance.

At a point mass the moment has a kink, and the shear force a jump: polynomials are those on each part of the
beam between point masses, of moments such that they are continuous.

The quotients are interpolated by polynomials on cells.  The functions are thus piecewise polynomials, of
which integrals are exact, and eigenvalues are upper bounds as those of other assumed modes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache, partial
from typing import TypeAlias

import numpy as np
import scipy.linalg
from numpy.polynomial import legendre

from beamdyn.common.legendre import gauss_points_on, gauss_rule, legendre_series
from beamdyn.common.pickling import FieldsOnly
from beamdyn.equations.arc_quadrature import ArcQuadrature, Cells
from beamdyn.equations.centrifugal_tension import axial_tension
from beamdyn.equations.discretization import RootConditions
from beamdyn.equations.piecewise_polynomials import PiecewisePolynomials
from beamdyn.equations.sampled_space import SampledSpace, Sampler, product_of
from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import Profile, merge_breakpoints
from beamdyn.scene.sections import Tensor, section_tensor, weight_degree

NODES = 16  # on each cell, through which the quotients are interpolated
_RESOLVED = 1e-9  # last coefficients of an interpolant over the largest; eigenvalues depend on their square
_ROUNDING = 10 * float(np.finfo(float).eps)  # of a sum of polynomials
_PHASE = 12.0  # largest change of phase of the highest polynomial within a cell [rad]
_SHORTEST = 1e-10  # cell that is halved, as x/L
_DEPENDENT = 1e-9  # part of a function that the others lack, below which it is left out

Values: TypeAlias = "dict[tuple[int, int], np.ndarray]"  # entries of a tensor, by directions
# Order of the derivative of a displacement that each stiffness resists.
_ORDERS = {"bending_stiffness": 2, "shear_stiffness": 1, "axial_stiffness": 1}
# Stiffnesses against displacements that cause forces in the functions for each.
_COUPLED = {
    "bending_stiffness": ("bending_stiffness", "shear_stiffness"),
    "shear_stiffness": ("bending_stiffness", "shear_stiffness"),
    "axial_stiffness": ("axial_stiffness",),
}


@dataclass(frozen=True)
class MomentSpaces(FieldsOnly):
    """Function spaces of moments, and of other forces, on a beam.

    Parameters
    ----------
    beam : Beam
        The beam, with the modelled properties.
    forces : int
        Number of forces or moments in each direction; with point masses, by the square root of its share of
        the length on each part between them.
    """

    beam: Beam
    forces: int

    def functions(self, conditions: RootConditions) -> MomentSpace:
        """Trial functions that satisfy conditions at the root."""
        return _build_space(self, conditions)

    def product(
        self, weight: Profile, rows: RootConditions, columns: RootConditions, orders: tuple[int, int] = (0, 0)
    ) -> np.ndarray:
        """Integrate the weight times derivatives of functions i of `rows` and j of `columns`."""
        return product_of(self.functions(rows), self.functions(columns), weight, orders)

    @cached_property
    def polynomials(self) -> PiecewisePolynomials:
        """Polynomials on the parts of the beam between point masses."""
        return PiecewisePolynomials(merge_breakpoints(np.concatenate([[0.0], self.beam.lumps[0], [1.0]])))

    @cached_property
    def cells(self) -> np.ndarray:
        """Ends of cells on which every compliance and the highest polynomial are resolved, as x/L."""
        ends = np.array(self.beam.breakpoints)
        while (coarse := self._are_coarse(ends)).any():
            ends = np.sort(np.concatenate([ends, (ends[:-1] + ends[1:])[coarse] / 2]))
        return ends

    def _are_coarse(self, ends: np.ndarray) -> np.ndarray:
        """Whether each cell is to be halved."""
        coarse = self.polynomials.phases(ends, self.forces) > _PHASE
        xi = gauss_points_on(ends, NODES)
        for name in _ORDERS:
            values = {entry: p(xi) for entry, p in stiffness_tensor(self.beam, name).items()}
            for (i, _), entry in invert(values).items():
                coarse |= ~_are_resolved(entry, _rounding_of(values[i, i]))
        return coarse & (np.diff(ends) > _SHORTEST)

    @cached_property
    def nodes(self) -> ArcQuadrature:
        """Points of all cells through which quotients are interpolated."""
        return ArcQuadrature(Cells(self.cells, NODES))

    @cached_property
    def at_nodes(self) -> Sampler:
        """Values of properties at the nodes."""
        return Sampler(self.nodes.xi)

    def compliance(self, stiffness: str) -> Values:
        """Inverse of a stiffness of the sections at the nodes."""
        tensor = stiffness_tensor(self.beam, stiffness)
        return invert({entry: self.at_nodes(profile) for entry, profile in tensor.items()})

    def displacements(self, forces: np.ndarray, stiffness: str, direction: int) -> list[np.ndarray]:
        """Displacements by forces (n, N) at the nodes against a stiffness, and their slopes: each (n, N)."""
        compliance = self.compliance(stiffness)[direction, direction]
        derivatives = [forces * compliance]
        for _ in range(_ORDERS[stiffness]):
            derivatives.insert(0, self.nodes.integrate(derivatives[0])[:, :-1])
        return derivatives[:2]

    @cached_property
    def quadrature(self) -> ArcQuadrature:
        """Gauss rule that integrates products of the functions with properties exactly."""
        return ArcQuadrature(Cells(self.cells, NODES + 3 + weight_degree(self.beam) // 2))

    @cached_property
    def at_points(self) -> Sampler:
        """Values of properties at the points of that rule."""
        return Sampler(self.quadrature.xi)


@lru_cache(maxsize=16)  # fields of a scene, and pairs of them, ask for the same functions
def _build_space(spaces: MomentSpaces, conditions: RootConditions) -> MomentSpace:
    return MomentSpace(spaces, conditions)


# Compliance of sections ---------------------------------------------------------------------------


def stiffness_tensor(beam: Beam, name: str) -> Tensor:
    """A stiffness of the sections in the directions e1, e2; that against stretch has one entry."""
    if name == "axial_stiffness":
        return {} if beam.axial_stiffness is None else {(0, 0): beam.axial_stiffness}
    return section_tensor(beam, name)


def invert(values: Values) -> Values:
    """Entries of the inverse of a tensor of sections, by directions."""
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


def _rounding_of(values: np.ndarray) -> np.ndarray:
    """Relative rounding error (c,) of a stiffness (c, nodes), whose terms may be as large as its largest."""
    return _ROUNDING * np.abs(values).max() / np.abs(values).min(axis=1)


def _are_resolved(values: np.ndarray, rounding: np.ndarray) -> np.ndarray:
    """Whether interpolants through the nodes of each cell resolve functions with these values (c, nodes)."""
    series = np.abs(values @ legendre_series(NODES).T)
    return series[:, -2:].max(axis=1) <= np.maximum(_RESOLVED, rounding) * series.max(axis=1)


@cache
def _interpolation(points: int) -> np.ndarray:
    """Values at Gauss points of the interpolants through fewer: shape (points, nodes)."""
    return legendre.legvander(gauss_rule(points)[0], NODES - 1) @ legendre_series(NODES)


# Functions ----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class MomentSpace(SampledSpace):
    """Trial functions with a highest derivative that is a force over a stiffness.

    Their highest derivatives are orthonormal with the stiffness in their direction as weight; a rotation
    about the root stands before them where the root turns.

    Parameters
    ----------
    spaces : MomentSpaces
        Beam and number of forces.
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

    def weights(self, weight: Profile) -> np.ndarray:
        """Multiply the weights of the rule by a property."""
        return self.rule * self.spaces.at_points(weight)

    @property
    def _turns(self) -> bool:
        return self.conditions.held < self.conditions.derivatives

    @cached_property
    def _quotients(self) -> np.ndarray:
        """Orthonormal quotients of forces and stiffness at the points, shape (m, k)."""
        stiffness, direction = self.conditions.stiffness, self.conditions.direction
        compliance = self.spaces.compliance(stiffness)
        quotients = np.array(
            [
                compliance[direction, other] * self._forces(other)
                for other in (0, 1)
                if (direction, other) in compliance
            ]
        )
        ordered = quotients.swapaxes(0, 1).reshape(-1, quotients.shape[-1])
        own = stiffness_tensor(self.spaces.beam, stiffness)[direction, direction]
        weight = self.spaces.nodes.weights * self.spaces.at_nodes(own)
        on_cells = _orthonormalize(ordered.T, weight).T.reshape(-1, len(self.spaces.cells) - 1, NODES)
        at_points = on_cells @ _interpolation(self.spaces.quadrature.cells.points).T
        return at_points.reshape(len(on_cells), -1)

    def _forces(self, direction: int) -> np.ndarray:
        """Forces or moments in a direction at the nodes: shape (n, N).

        Polynomials, and what displacements by the first of them cause by inertia and by tension.
        """
        spaces, causes = self.spaces, [*self._causes(direction)]
        of_moments = self.conditions.derivatives == 2
        counts = spaces.polynomials.counts(spaces.forces)
        first = [count // (1 + len(causes)) for count in counts]
        others = [count - len(causes) * n for count, n in zip(counts, first, strict=True)]
        polynomials = partial(spaces.polynomials, spaces.nodes.xi, continuous=of_moments)
        caused = (
            _integrate_from_tip(
                spaces.nodes,
                weight * spaces.displacements(polynomials(first), name, direction)[order],
                self.conditions.derivatives - order,
            )
            for name, order, weight in causes
        )
        return np.concatenate([polynomials(others), *caused])

    def _causes(self, direction: int) -> Iterator[tuple[str, int, np.ndarray]]:
        """Yield of loads: the stiffness against the displacement, the derivative of that, and its weight."""
        beam, at_nodes = self.spaces.beam, self.spaces.at_nodes
        mass, tension = at_nodes(beam.mass_per_length), at_nodes(axial_tension(beam)[1])
        rotary = section_tensor(beam, "rotary_inertia").get((direction, direction))
        for name in _COUPLED[self.conditions.stiffness]:
            if stiffness_tensor(beam, name):
                yield name, 0, mass
                yield name, 1, tension
        if rotary is not None and self.conditions.stiffness == "bending_stiffness":
            yield "bending_stiffness", 1, at_nodes(rotary)

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


def _integrate_from_tip(nodes: ArcQuadrature, values: np.ndarray, times: int) -> np.ndarray:
    """Integrate repeatedly from each node to the tip: values and result have shape (n, N)."""
    for _ in range(times):
        integral = nodes.integrate(values)
        values = integral[:, -1:] - integral[:, :-1]
    return values


def _orthonormalize(columns: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Orthonormal basis (k, m) of the span of columns (k, n), with a weight (k,), but for rounding."""
    root = np.sqrt(weight)[:, None]
    scaled = columns * root
    norm = np.linalg.norm(scaled, axis=0)
    unit = scaled[:, norm > 0] / norm[norm > 0]
    Q, R, _ = scipy.linalg.qr(unit, mode="economic", pivoting=True)
    return Q[:, np.abs(np.diag(R)) > _DEPENDENT] / root
