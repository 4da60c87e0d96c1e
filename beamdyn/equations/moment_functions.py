"""Trial functions defined by their bending moments, for beams of many segments.

At a kink or jump of the beam's properties, as at each station of a table, the curvature has a kink or jump,
but the bending moment M is smooth.  Trial functions with the curvature

    w'' = M(x) / EI(x)

thus need no more functions for a hundred segments than for one.  Two kinds of moments are used: polynomials
over the whole beam, and the moments due to inertia and tension of a beam that vibrates in the shapes w that
the polynomials cause,

    int_x^1 int_s^1 rho A w,  int_x^1 N w',

as in a step of inverse iteration.  Moments of the second kind have the small kinks of M, which polynomials
cannot represent.  For deflection by shear and for stretch, the slope is a force divided by a stiffness.
Pretwisted sections bend in both directions under a moment in one: curvatures are moments times entries of the
sections' compliance.

At a point mass the moment has a kink, and the shear force a jump: each part of the beam between point masses
has its own polynomials; the moments are continuous between parts.

The quotients of moment and stiffness are interpolated by polynomials on cells.  The functions are thus
piecewise polynomials with exact integrals, and the eigenvalues are upper bounds, as in every Rayleigh-Ritz
method.

In shapes of arrays, n counts functions, m independent ones, k Gauss points or positions, and c cells.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache, partial
from typing import TypeAlias

import numpy as np
from scipy.linalg.lapack import dgeqp3, dorgqr

from beamdyn.common.numerics import legendre_series, legendre_values
from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.equations.discretization import (
    ArcQuadrature,
    Cells,
    RootConditions,
    SampledSpace,
    SampledSpaces,
    Sampler,
)
from beamdyn.equations.mass import PiecewisePolynomials, axial_tension
from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import Profile, merge_breakpoints
from beamdyn.scene.sections import Tensor, inertia_about_shear_centre, section_tensor, weight_degree

NODES = 12  # number of nodes on each cell, through which quotients of moment and stiffness are interpolated
# Size of an interpolant's last coefficients, divided by its largest coefficient, below which the interpolant
# counts as exact on a cell; the error of eigenvalues is proportional to the square of this ratio.
_RESOLVED = 1e-7
_ROUNDING = 10 * float(np.finfo(float).eps)  # relative rounding error of a sum of polynomials
_PHASE = 7.0  # largest phase change [rad] of the highest polynomial within a cell
_SHORTEST = 1e-10  # length of the shortest cell that is still halved, as a fraction of the beam's length
_BLOCK = 32  # number of columns that LAPACK processes as a block
# Norm of the component of a function that is orthogonal to the other functions, below which it is left out.
_DEPENDENT = 1e-9

Values: TypeAlias = "dict[tuple[int, int], np.ndarray]"  # entries of a tensor, by pairs of directions
# Order of the derivative of the displacement that each stiffness resists.
_ORDERS = {"bending_stiffness": 2, "shear_stiffness": 1, "axial_stiffness": 1}
_ORDERS |= {"torsion_stiffness": 1, "warping_stiffness": 2}
_TURNING = ("torsion_stiffness", "warping_stiffness")  # stiffnesses that resist twist
_SCALAR = ("axial_stiffness", *_TURNING)  # stiffnesses without a direction
# For each stiffness: the displacements whose inertial forces cause the internal force that this stiffness
# resists; each displacement is named by the stiffness that resists it.
_COUPLED = {
    "bending_stiffness": ("bending_stiffness", "shear_stiffness"),
    "shear_stiffness": ("bending_stiffness", "shear_stiffness"),
    **{name: (name,) for name in _SCALAR},
}


@dataclass(frozen=True)
class MomentSpaces(FieldsOnly, SampledSpaces):
    """Function spaces on a beam, with functions defined by bending moments and other internal forces.

    Parameters
    ----------
    beam : Beam
        The beam, with the modelled properties.
    forces : int
        Number of forces or moments in each direction; with point masses, each part of the beam between them
        has this number times the square root of its fraction of the length.
    coarse : int
        Number of forces that the coarser discretization has.
    """

    beam: Beam
    forces: int
    coarse: int = 0

    def functions(self, conditions: RootConditions) -> MomentSpace:
        """Build trial functions that satisfy conditions at the root."""
        return _build_space(self, conditions)

    @property
    def across(self) -> int:
        """Number of functions across the width of a plate, without the constant one."""
        return self.forces

    @property
    def fewer_across(self) -> int:
        """Number of functions across the width of a plate in the coarser basis."""
        return self.coarse

    def shares_functions(self, other: MomentSpaces) -> bool:
        """Whether other spaces have an equal beam and equal sizes, on all of which the functions depend."""
        return self == other

    @cached_property
    def polynomials(self) -> PiecewisePolynomials:
        """Polynomials on each part of the beam between point masses."""
        return PiecewisePolynomials(merge_breakpoints(np.concatenate([[0.0], self.beam.points, [1.0]])))

    @cached_property
    def cells(self) -> np.ndarray:
        """Ends x/L of cells, each so short that an interpolating polynomial represents all functions on it.

        These functions are the entries of the sections' compliances, and the polynomial of highest degree.
        """
        phases, ends = self.polynomials.phases, np.array(self.beam.breakpoints)
        halved = _halve(ends, lambda left, right: phases(left, right, self.forces) > _PHASE)
        return _halve(halved, self._are_unresolved)

    def _are_unresolved(self, left: np.ndarray, right: np.ndarray) -> np.ndarray:
        """Mark the cells on which some entry of a compliance is not represented by its interpolant."""
        at_nodes, unresolved = Sampler(left, right, NODES), np.zeros(len(left), dtype=bool)
        for tensor in self._stiffnesses.values():
            values = {entry: at_nodes(profile).reshape(-1, NODES) for entry, profile in tensor.items()}
            for (i, j), entry in invert(values).items():
                if i > j:
                    continue
                largest = float(np.abs(tensor[i, i].end_values()).max())
                rounding = _ROUNDING * largest / np.abs(values[i, i]).min(axis=1)
                # Legendre series of the interpolating polynomials.
                series = np.abs(entry @ legendre_series(NODES).T)
                least = np.maximum(_RESOLVED, rounding) * series.max(axis=1)
                unresolved |= ~(series[:, -2:].max(axis=1) <= least)
        return unresolved

    @cached_property
    def _stiffnesses(self) -> dict[str, Tensor]:
        """Stiffness tensors of the sections, by name."""
        tensors = {name: stiffness_tensor(self.beam, name) for name in _ORDERS}
        return {name: tensor for name, tensor in tensors.items() if tensor}

    @cached_property
    def nodes(self) -> ArcQuadrature:
        """Gauss points of all cells, at which quotients of force and stiffness are interpolated."""
        return ArcQuadrature(Cells(self.cells, NODES))

    @cached_property
    def at_nodes(self) -> Sampler:
        """Sampler of the beam's properties at the nodes."""
        return Sampler.on_cells(self.nodes.cells)

    @cached_property
    def compliance(self) -> dict[str, Values]:
        """Inverse of each stiffness tensor of the sections at the nodes, by the name of the stiffness."""
        return {
            name: invert({entry: self.at_nodes(profile) for entry, profile in tensor.items()})
            for name, tensor in self._stiffnesses.items()
        }

    def inertia_and_pull(self, stiffness: str) -> tuple[np.ndarray, np.ndarray]:
        """Return mass per length and tension per squared speed at the nodes.

        If `stiffness` is that against torsion or warping, return the polar rotary inertia per length, and the
        tension times the squared polar radius of gyration, instead.
        """
        mass, tension = self.at_nodes(self.beam.mass_per_length), self.at_nodes(axial_tension(self.beam)[1])
        if stiffness not in _TURNING:
            return mass, tension
        tensor = inertia_about_shear_centre(self.beam)
        polar = self.at_nodes(tensor[0, 0]) + self.at_nodes(tensor[1, 1])
        return polar, tension * polar / mass

    @cached_property
    def quadrature(self) -> ArcQuadrature:
        """Gauss rule that integrates products of the functions with properties exactly."""
        return ArcQuadrature(Cells(self.cells, NODES + 2 + weight_degree(self.beam) // 2))

    @cached_property
    def at_points(self) -> Sampler:
        """Sampler of the beam's properties at the points of `quadrature`."""
        return Sampler.on_cells(self.quadrature.cells)


def _halve(ends: np.ndarray, are_coarse: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> np.ndarray:
    """Halve cells with given ends until `are_coarse(left, right)` marks none that can be halved."""
    fine, (left, right) = [], (ends[:-1], ends[1:])
    while left.size:
        coarse = are_coarse(left, right) & (right - left > _SHORTEST)
        fine.append(left[~coarse])
        left, right = left[coarse], right[coarse]
        middle = (left + right) / 2
        left, right = np.concatenate([left, middle]), np.concatenate([middle, right])
    return np.append(np.sort(np.concatenate(fine)), ends[-1])


@lru_cache(maxsize=16)  # cached, as several fields of a scene use the same functions
def _build_space(spaces: MomentSpaces, conditions: RootConditions) -> MomentSpace:
    return MomentSpace(spaces, conditions)


# Compliance of sections ---------------------------------------------------------------------------


def stiffness_tensor(beam: Beam, name: str) -> Tensor:
    """Return a section stiffness as a tensor along e1, e2: profiles by pair of indices, 0 for e1, 1 for e2.

    A scalar stiffness has the entry (0, 0) only; for a stiffness that the beam lacks, the result is empty.
    """
    if name in _SCALAR:
        stiffness = getattr(beam, name)
        return {} if stiffness is None else {(0, 0): stiffness}
    return section_tensor(beam, name)


def invert(values: Values) -> Values:
    """Invert a tensor of the sections at all points; its entries are given by pairs of directions."""
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


@cache
def _interpolation(points: int) -> np.ndarray:
    """Compute the interpolation matrix from nodes to Gauss points: shape (points, nodes)."""
    return legendre_values(points, NODES - 1) @ legendre_series(NODES)


# Forces -------------------------------------------------------------------------------------------


@lru_cache(maxsize=8)  # cached, as pretwisted sections bend in both directions under the same moments
def _build_forces(
    spaces: MomentSpaces, stiffness: str, derivatives: int, direction: int
) -> tuple[np.ndarray, np.ndarray | None]:
    """Compute n forces or moments in one direction at the N nodes, and mark those of the coarser basis.

    The forces are internal forces of the kind that `stiffness` resists; their `derivatives`-th derivative is
    a load per length.  The first ones are polynomials.  The others are due to inertia and tension of a beam
    that is displaced as these polynomials deform it.  The marks (n,) are True for forces that the coarser
    basis also has; they are None if the coarser basis has different forces.
    """
    beam, parts, causes = spaces.beam, spaces.polynomials, []
    # Causes of forces: the stiffness that resists a displacement, the order of the displacement's derivative,
    # and the weight that multiplies the derivative.
    mass, tension = spaces.inertia_and_pull(stiffness)
    for name in _COUPLED[stiffness]:
        if name in spaces.compliance:
            causes += [(name, 0, mass), (name, 1, tension)]
    rotary = section_tensor(beam, "rotary_inertia").get((direction, direction))
    if rotary is not None and stiffness == "bending_stiffness":
        causes.append((stiffness, 1, spaces.at_nodes(rotary)))
    first, others = _share(parts.counts(spaces.forces), len(causes))
    fewer, lower = _share(parts.counts(spaces.coarse), len(causes))
    contained = partial(parts.contained, continuous=derivatives == 2)
    P = _polynomials(spaces, tuple(others), derivatives == 2)
    causing, displaced = P[contained(others, first)], {}
    for name in {name for name, _, _ in causes}:
        values = [causing * spaces.compliance[name][direction, direction]]
        for _ in range(_ORDERS[name]):
            values.insert(0, spaces.nodes.integrate(values[0])[:, :-1])
        displaced[name] = values
    caused = []
    for name, order, weight in causes:
        force = weight * displaced[name][order]
        for _ in range(derivatives - order):  # integrate from each node to the tip
            integral = spaces.nodes.integrate(force)
            force = integral[:, -1:] - integral[:, :-1]
        caused.append(force)
    if not all(m <= n for m, n in zip([*fewer, *lower], [*first, *others], strict=True)):
        return np.concatenate([P, *caused]), None
    of_coarse = [contained(others, lower), *[contained(first, fewer)] * len(causes)]
    return np.concatenate([P, *caused]), np.concatenate(of_coarse)


@lru_cache(maxsize=4)  # cached, as all directions share the same polynomials
def _polynomials(spaces: MomentSpaces, counts: tuple[int, ...], continuous: bool) -> np.ndarray:
    """Evaluate polynomials in x/L at the nodes of numerical integration: shape (polynomials, nodes).

    Part k of the beam, between neighbouring point masses or ends, has `counts[k]` polynomials.  If they are
    continuous from part to part, the piecewise linear ones are included in any case.
    """
    return spaces.polynomials(spaces.nodes.xi, counts, continuous)


def _share(counts: Sequence[int], causes: int) -> tuple[list[int], list[int]]:
    """Return, for each part of the beam, the number of causing polynomials and the number of all polynomials.

    Each of the `causes`, such as inertia, adds one force for each causing polynomial; with all polynomials,
    the forces on a part add up to its number in `counts`.  The split only affects the space that the trial
    functions span; the error of that space is estimated with fewer functions.
    """
    causing = [count // (1 + causes) for count in counts]
    return causing, [count - causes * n for count, n in zip(counts, causing, strict=True)]


# Functions ----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class MomentSpace(SampledSpace):
    """Trial functions whose highest derivative is a force divided by a stiffness.

    The highest derivatives are orthonormal, weighted by the stiffness in their direction.  If the root can
    rotate, the first function is the rigid rotation about the root.

    Parameters
    ----------
    spaces : MomentSpaces
        Beam and number of forces.
    conditions : RootConditions
        Boundary conditions at the root, with the stiffness and its direction.
    """

    spaces: MomentSpaces
    conditions: RootConditions

    def weights(self, weight: Profile) -> np.ndarray:
        """Multiply the weights of the Gauss rule by a property of the beam."""
        return self.rule * self.spaces.at_points(weight)

    @property
    def _turns(self) -> bool:
        return self.conditions.held < self.conditions.derivatives

    @cached_property
    def _quotients(self) -> tuple[int, np.ndarray]:
        """Number of quotients of the coarser basis, and orthonormal quotients (rows) of force and stiffness.

        The first quotients, whose number is returned, span the coarser discretization; 0 if none do.
        """
        stiffness, direction = self.conditions.stiffness, self.conditions.direction
        compliance = self.spaces.compliance[stiffness]
        forces_against = self.spaces, stiffness, self.conditions.derivatives
        others = [other for other in (0, 1) if (direction, other) in compliance]
        forces, of_coarse = zip(*(_build_forces(*forces_against, other) for other in others), strict=True)
        parts = zip(others, forces, strict=True)
        quotients = np.concatenate([compliance[direction, other] * part for other, part in parts])
        own = stiffness_tensor(self.spaces.beam, stiffness)[direction, direction]
        weight = self.spaces.nodes.weights * self.spaces.at_nodes(own)
        if any(mask is None for mask in of_coarse):
            coarse = 0
            functions = orthonormalize(quotients.T, weight)
        else:
            coarse, functions = _orthonormalize_nested(quotients.T, np.concatenate(of_coarse), weight)
        on_cells = functions.T.reshape(-1, len(self.spaces.cells) - 1, NODES)
        at_points = on_cells @ _interpolation(self.spaces.quadrature.cells.points).T
        return coarse, at_points.reshape(len(on_cells), -1)

    @property
    def coarse(self) -> np.ndarray | None:
        """Indices of functions that span the coarser discretization (the first ones); None if none do."""
        return np.arange(self._turns + self._quotients[0]) if self._quotients[0] else None

    @cached_property
    def _derivatives(self) -> list[np.ndarray]:
        """Functions and derivatives at the Gauss points and (but for the highest derivative) at the tip."""
        rows = [self._quotients[1]]
        for _order in reversed(range(self.conditions.derivatives)):
            rows.insert(0, self.spaces.quadrature.integrate(rows[0][:, : len(self.rule)]))
        if not self._turns:
            return rows
        xi = np.append(self.points, 1.0)
        rigid = [xi, np.ones_like(xi), np.zeros_like(self.points)]
        return [np.concatenate([r[None], row]) for r, row in zip(rigid, rows, strict=True)]

    @cached_property
    def samples(self) -> list[np.ndarray]:
        """Values of the functions and of each derivative at the Gauss points, (functions, points) each."""
        return [values[:, : len(self.rule)] for values in self._derivatives]

    def end(self, order: int) -> np.ndarray:
        """Evaluate the `order`-th derivatives of the functions at the tip."""
        if order < self.conditions.derivatives:
            return self._derivatives[order][:, -1]
        return self.evaluate(np.ones(1), order)[:, 0]

    def evaluate(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Evaluate the `order`-th derivatives of the functions at k positions xi: (functions, k)."""
        xi, quadrature = np.asarray(xi, dtype=float), self.spaces.quadrature
        if order == self.conditions.derivatives:
            return self.samples[order] @ quadrature.interpolate_to(xi).T
        values = self.samples[order + 1] @ quadrature.integrate_to(xi).T
        if self._turns and order == 1:
            values[0] = 1.0  # the rigid rotation has a slope at the root, too
        return values


def _orthonormalize_nested(
    columns: np.ndarray, of_coarse: np.ndarray, weight: np.ndarray
) -> tuple[int, np.ndarray]:
    """Orthonormalize columns; the first vectors, whose number is returned, span the marked columns."""
    root = np.sqrt(weight)[:, None]
    first, rest = _span(_unit(columns[:, of_coarse] * root)), _unit(columns[:, ~of_coarse] * root)
    for _ in range(2):  # repeated, as the first subtraction leaves a rounding error
        rest = rest - first @ (first.T @ rest)
    return first.shape[1], np.concatenate([first, _span(rest)], axis=1) / root


def orthonormalize(columns: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Compute an orthonormal basis of columns, in products weighted by `weight`, accurate to rounding."""
    root = np.sqrt(weight)[:, None]
    return _span(_unit(columns * root)) / root


def _unit(columns: np.ndarray) -> np.ndarray:
    """Divide columns by their norms, and omit columns that are 0."""
    norm = np.linalg.norm(columns, axis=0)
    return columns[:, norm > 0] / norm[norm > 0]


def _span(columns: np.ndarray) -> np.ndarray:
    """Compute an orthonormal basis of columns of norm 1 or less, accurate to rounding."""
    n = columns.shape[1]
    reflectors, _, tau, _, _ = dgeqp3(columns, lwork=_BLOCK * (n + 1) + 2 * n)
    rank = int((np.abs(np.diag(reflectors)) > _DEPENDENT).sum())
    return dorgqr(reflectors[:, :rank], tau[:rank], lwork=_BLOCK * max(rank, 1))[0]
