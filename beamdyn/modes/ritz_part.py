"""Trial functions with exactly known residuals, for the theorem in `beamdyn.modes.residual_bound`.

Their curvatures are piecewise polynomials on cells: polynomials on each segment of a beam with few segments;
bending moments divided by the stiffness for many segments, or if the stiffness almost vanishes.  All moments
by their loads are piecewise polynomials, too; products of these with the properties are integrated exactly.
The functions are orthonormal in the energy a, whatever the stiffness, so that rounding errors are relative to
the eigenvalues and not to the largest stiffness.

**Two planes** that the twist or the mount couples: the curvature is a vector and the stiffness D(x) a tensor
that is rotated by the twist beta(x).  On cells the curvatures *in the axes of the section* are polynomials,
so that the energy and the moments D p contain no cosine of the twist.  Only curvatures along the fixed
directions e1, e2, and moments in the axes of the section, contain it.  Polynomials replace its cosine and
sine; they are exact for a beam whose stiffness is within (1 -+ `misfit`) D(x): see `twist_degree`.  An array
(n, 2, N) has components along e1, e2 or, where its docstring says so, in the axes of the section.

In shapes of arrays, n counts functions, N Gauss points or nodes, c cells, m moments, and k point masses.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import qr, solve_triangular

from beamdyn.common.numerics import gauss_rule, legendre_series
from beamdyn.equations.discretization import CLAMPED, ArcQuadrature, Cells
from beamdyn.equations.mass import axial_tension
from beamdyn.equations.moment_functions import NODES, MomentSpaces, orthonormalize
from beamdyn.equations.ritz import MOST_FUNCTIONS, Ritz
from beamdyn.modes.flexibility import bound_on_cells
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.profile import ONE, Profile

# Largest number of functions (bending moments) in each of two coupled directions.  With so many, the bounds
# take about two seconds.
MOST_MOMENTS = 100
# Largest number of segments with which polynomials on each segment need fewer functions than bending moments
# that are polynomials along the whole beam.
_FEW_SEGMENTS = 6
_SAMPLES = 32  # number of stiffness samples on a segment, used only for the choice of the basis
_STEEP = 300.0  # ratio of two stiffness samples above which cells must be graded
# Largest number of functions on all segments together: their eigenproblem takes a tenth of a second.
_MOST_IN_ALL = 500
_LARGEST_TURN = 0.25  # largest rotation of a section relative to the middle of its cell [rad]
_MISFIT = 1e-14  # relative error of the stiffness if polynomials replace cosine and sine of the twist
_MOST_DEGREE = 40  # highest degree, in the twist, of polynomials that replace its cosine and sine

_CONDITIONS = CLAMPED._replace(stiffness="bending_stiffness")


class RitzPart(ABC):
    """Trial functions on a clamped beam, orthonormal in elastic energy, in one plane of bending or two.

    Values at the Gauss points have the shape (functions, points) or (functions, 2, points).
    Subclasses define the nondimensional `beam`.
    """

    beam: Beam

    @cached_property
    @abstractmethod
    def ends(self) -> np.ndarray:
        """Ends of the cells on which the curvatures are polynomials, as x/L."""

    @cached_property
    @abstractmethod
    def quadrature(self) -> ArcQuadrature:
        """Gauss rule, exact for products of two moments and for properties times lower-degree polynomials."""

    @cached_property
    @abstractmethod
    def bending(self) -> np.ndarray:
        """Curvatures of the functions at the Gauss points, along fixed directions."""

    def at(self, profile: Profile, rule: ArcQuadrature | None = None) -> np.ndarray:
        """Evaluate a property at the Gauss points of `quadrature`, or of another rule on the cells."""
        points = (rule or self.quadrature).cells.points
        return profile.split(self.ends.tolist()).at_points(points).ravel()

    @property
    def tip(self) -> TipMass:
        """Rigid body at the tip of the beam."""
        return self.beam.tip or TipMass(0.0)

    @cached_property
    def slope(self) -> np.ndarray:
        """Slopes of the functions at the Gauss points and at the tip."""
        return self.quadrature.integrate(self.bending)

    @cached_property
    def deflection(self) -> np.ndarray:
        """Deflections of the functions at the Gauss points and at the tip."""
        return self.quadrature.integrate(self.slope[..., :-1])

    @cached_property
    def centre(self) -> np.ndarray:
        """Deflections of the tip body's centre of mass, for each function."""
        return self.deflection[..., -1] + self.tip.offset * self.slope[..., -1]

    @cached_property
    def loads(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Tension per squared speed, tension per root acceleration, mass per length, at the Gauss points."""
        n_a, n_b = axial_tension(self.beam)
        return self.at(n_b), self.at(n_a), self.at(self.beam.mass_per_length)

    def gram(self, values: np.ndarray, weight: np.ndarray) -> np.ndarray:
        """Integrate products of all pairs of the values (functions, ..., points) with a weight."""
        flat = values.reshape(len(values), -1)
        scale = np.broadcast_to(self.quadrature.weights * weight, values.shape[1:]).reshape(-1)
        return (flat * scale) @ flat.T

    def from_tip(self, values: np.ndarray, rule: ArcQuadrature | None = None) -> np.ndarray:
        """Integrate from each point to the tip, with small relative errors also near the tip."""
        cells = (rule or self.quadrature).cells
        inwards = ArcQuadrature(Cells(-cells.ends[::-1], cells.points))
        return inwards.integrate(values[..., ::-1])[..., -2::-1]


# One plane ----------------------------------------------------------------------------------------


def most_functions(beam: Beam) -> int:
    """Return the largest number of functions of a basis: polynomials per segment, or moments in total."""
    most = MOST_FUNCTIONS - _extra_degrees(beam)
    return most if _bends_by_moments(beam) else min(most, _MOST_IN_ALL // segments_with_functions(beam))


def segments_with_functions(beam: Beam) -> int:
    """Count the segments that have separate functions."""
    return 1 if _bends_by_moments(beam) else len(beam.breakpoints) - 1


def basis(beam: Beam, functions: int) -> Ritz:
    """Choose the basis with a number of functions: per segment, or in total for bending moments."""
    return Ritz(functions, "moments" if _bends_by_moments(beam) else "legendre")


def _bends_by_moments(beam: Beam) -> bool:
    """Return whether trial functions should be bending moments over EI, rather than polynomials.

    This is so for many segments or a strong taper.
    """
    if len(beam.breakpoints) - 1 > _FEW_SEGMENTS:
        return True
    stiffness = beam.bending_stiffness.at_points(_SAMPLES)
    return bool((stiffness.max(axis=1) > _STEEP * stiffness.min(axis=1)).any())


def _extra_degrees(beam: Beam) -> int:
    """Find the excess of the polynomial degree of moments over the degree of the curvature."""
    return max(beam.mass_per_length.degree + 4, beam.bending_stiffness.degree)


@dataclass(frozen=True)
class PlaneRitzPart(RitzPart):
    """Trial functions in one plane, with the moments that their loads cause.

    Forms and loads are, in this order: the tension N_B per squared speed, the tension N_A per
    acceleration of the root, the mass with point masses and tip body, and the slope at the tip.

    Parameters
    ----------
    beam : Beam
        A nondimensional beam.
    functions : int
        Number of functions; see `basis`.
    """

    beam: Beam
    functions: int

    @cached_property
    def _ritz(self) -> Ritz:
        return basis(self.beam, self.functions)

    @cached_property
    def ends(self) -> np.ndarray:
        """Ends of the cells on which the curvatures are polynomials, as x/L."""
        return self._ritz.cells(self.beam).ends

    @property
    def _degree(self) -> int:
        """Polynomial degree of the curvatures."""
        return (self.functions if self._ritz.on_each_segment else NODES) - 1

    @cached_property
    def quadrature(self) -> ArcQuadrature:
        """Gauss rule, exact for products of two moments and for properties times lower-degree polynomials."""
        return ArcQuadrature(Cells(self.ends, self._degree + _extra_degrees(self.beam) + 1))

    @cached_property
    def bending(self) -> np.ndarray:
        """Curvatures of the functions at the Gauss points, (functions, points)."""
        given = self._ritz.spaces(self.beam).functions(_CONDITIONS).samples[2]
        on_cells = given.reshape(len(given), len(self.ends) - 1, -1)
        series = on_cells @ legendre_series(on_cells.shape[-1])[: self._degree + 1].T
        values = legendre.legvander(gauss_rule(self.quadrature.cells.points)[0], self._degree).T
        root = np.sqrt(self.quadrature.weights * self.at(self.beam.bending_stiffness))
        (factor,) = qr(((series @ values).reshape(len(series), -1) * root).T, mode="r")
        columns = series.reshape(len(series), -1)
        orthonormal = solve_triangular(factor[: len(series)], columns, trans="T").reshape(series.shape)
        return (orthonormal @ values).reshape(len(series), -1)

    @cached_property
    def _at_lumps(self) -> np.ndarray:
        """Deflections at the point masses, (functions, point masses)."""
        return self.slope[:, :-1] @ self.quadrature.integrate_to(self.beam.lumps[0]).T

    @cached_property
    def stiffness(self) -> np.ndarray:
        """Elastic energies of pairs of functions: the unit matrix up to rounding."""
        return self.gram(self.bending, self.at(self.beam.bending_stiffness))

    @cached_property
    def forms(self) -> np.ndarray:
        """Matrices of the four forms (tension by speed, by root acceleration, mass, tip slope)."""
        tension_b, tension_a, mass = self.loads
        slope, at_tip, centre = self.slope[:, :-1], self.slope[:, -1], self.centre
        inertia = self.gram(self.deflection[:, :-1], mass) + self.tip.mass * np.outer(centre, centre)
        inertia += (self._at_lumps * self.beam.lumps[1]) @ self._at_lumps.T
        by_tension = (self.gram(slope, tension) for tension in (tension_b, tension_a))
        return np.array([*by_tension, inertia, np.outer(at_tip, at_tip)])

    @cached_property
    def moments(self) -> np.ndarray:
        """Bending moments at the Gauss points by each function's loads, in the order of `forms`.

        The shape is (4, functions, points).
        """
        tension_b, tension_a, mass = self.loads
        slope, (xi, lumped) = self.slope[:, :-1], self.beam.lumps
        inertia = self.from_tip(self.from_tip(mass * self.deflection[:, :-1]))
        inertia += (self._at_lumps * lumped) @ np.maximum(xi[:, None] - self.quadrature.xi, 0.0)
        inertia = inertia + self.tip.mass * np.outer(self.centre, 1 - self.quadrature.xi + self.tip.offset)
        by_tension = (self.from_tip(tension * slope) for tension in (tension_b, tension_a))
        return np.array([*by_tension, inertia, np.broadcast_to(self.slope[:, -1:], slope.shape)])

    def residuals(self, compliance: np.ndarray) -> np.ndarray:
        """Integrate products of unbalanced moments, with the compliance of each cell as weight.

        The unbalanced moment for the load j of the function i is the moment by this load minus EI p, where p
        is the curvature of the Ritz response to the load, by functions that are orthonormal in energy.
        """
        own = self.at(self.beam.bending_stiffness) * self.bending
        left = (self.moments - self.forms @ own).reshape(-1, own.shape[1])
        products = self.gram(left, np.repeat(compliance, self.quadrature.cells.points))
        return products.reshape(4, len(own), 4, len(own))


# Two coupled planes -------------------------------------------------------------------------------


@dataclass(frozen=True)
class CoupledRitzPart(RitzPart):
    """Trial functions in two planes, orthonormal in elastic energy up to interpolation errors.

    Curvatures are caused by smooth bending moments in either direction.

    Parameters
    ----------
    beam : Beam
        A nondimensional beam with a second bending stiffness.
    number : int
        Number of moments in each direction.
    flexibility : tuple of Profile
        Upper bounds of 1/EI in the first direction of the sections and in the second.
    """

    beam: Beam
    number: int
    flexibility: tuple[Profile, Profile]

    @cached_property
    def stiffnesses(self) -> tuple[Profile, Profile]:
        """Bending stiffness in the first direction of the sections and in the second."""
        assert self.beam.second_bending_stiffness is not None
        return self.beam.bending_stiffness, self.beam.second_bending_stiffness

    @cached_property
    def _twist(self) -> Profile:
        return ONE.scaled(0.0) if self.beam.twist is None else self.beam.twist

    # Cells and quadrature -------------------------------------------------------------------------

    @cached_property
    def ends(self) -> np.ndarray:
        """Ends x/L of the cells, which are so short that twist and compliance vary little within each."""
        ends = MomentSpaces(self.beam, self.number).cells
        while (coarse := self._turns(ends) > _LARGEST_TURN).any():
            ends = np.sort(np.concatenate([ends, (ends[:-1] + ends[1:])[coarse] / 2]))
        return ends

    def _turns(self, ends: np.ndarray) -> np.ndarray:
        """Bound the angles by which sections are rotated relative to the middle of their cell."""
        parts = self._twist.split(ends.tolist())
        varying = tuple((0.0, *row[1:]) for row in parts.coefficients)
        return bound_on_cells(Profile(parts.breakpoints, varying), ends)

    @cached_property
    def compliance(self) -> np.ndarray:
        """Upper bounds of 1/EI in either direction on the cells, (2, cells)."""
        return np.array([bound_on_cells(p, self.ends) for p in self.flexibility])

    @cached_property
    def ratios(self) -> np.ndarray:
        """Upper bounds of the ratio of stiffness i to stiffness j within a cell: shape (2, 2)."""
        largest = np.array([bound_on_cells(p, self.ends) for p in self.stiffnesses])
        return (largest[:, None] * self.compliance).max(axis=-1)

    @cached_property
    def _turning(self) -> tuple[int, float]:
        return twist_degree(float(self._turns(self.ends).max()), float(self.ratios.max()))

    @property
    def misfit(self) -> float:
        """Relative error of the stiffness when polynomials replace cosine and sine of the twist."""
        return self._turning[1]

    @cached_property
    def _nodes(self) -> ArcQuadrature:
        """Nodes at which curvatures are interpolated."""
        return ArcQuadrature(Cells(self.ends, NODES))

    @cached_property
    def quadrature(self) -> ArcQuadrature:
        """Gauss rule that is exact for products of two moments, in the axes of the section."""
        turns = 2 * self._turning[0] * self._twist.degree
        of_loads = self.beam.mass_per_length.degree + 4 + turns
        of_stiffness = max(p.degree for p in self.stiffnesses)
        return ArcQuadrature(Cells(self.ends, NODES - 1 + max(of_loads, of_stiffness) + 1))

    def _both_at(self, rule: ArcQuadrature) -> np.ndarray:
        """Evaluate both bending stiffnesses at the points of a Gauss rule, (2, points)."""
        return np.array([self.at(p, rule) for p in self.stiffnesses])

    def _turned(self, values: np.ndarray, rule: ArcQuadrature, sign: int) -> np.ndarray:
        """Transform components (n, 2, points) of n functions to section axes (sign -1), or back (1)."""
        beta = self.at(self._twist, rule)
        c, s = np.cos(beta), sign * np.sin(beta)
        first, second = values[:, 0], values[:, 1]
        return np.stack([c * first - s * second, s * first + c * second], axis=1)

    # Functions ------------------------------------------------------------------------------------

    @cached_property
    def curvature(self) -> np.ndarray:
        """Curvatures in the axes of the section at the Gauss points, (functions, 2, points)."""
        nodes = self._nodes
        moments = self._all_moments
        given = self._turned(moments, nodes, -1) / self._both_at(nodes)
        weight = (nodes.weights * self._both_at(nodes)).ravel()
        series = orthonormalize(given.reshape(len(given), -1).T, weight).T
        series = series.reshape(-1, 2, len(self.ends) - 1, NODES) @ legendre_series(NODES).T
        values = legendre.legvander(gauss_rule(self.quadrature.cells.points)[0], NODES - 1).T
        return (series @ values).reshape(len(series), 2, -1)

    @property
    def _all_moments(self) -> np.ndarray:
        """Bending moments along the fixed e1, e2 at the nodes: polynomials, and those by inertia and tension.

        The latter act in a beam that vibrates in the shapes caused by the first polynomials.
        """
        first, nodes = self.number // 3, self._nodes
        count = self.number - 2 * first
        P = legendre.legvander(2 * nodes.xi - 1, count - 1).T
        polynomials = np.einsum("ij,kx->kijx", np.eye(2), P).reshape(2 * count, 2, -1)
        curvatures = self._turned(polynomials[: 2 * first], nodes, -1) / self._both_at(nodes)
        slope = nodes.integrate(self._turned(curvatures, nodes, 1))[..., :-1]
        mass, tension = (self.at(p, nodes) for p in (self.beam.mass_per_length, axial_tension(self.beam)[1]))
        inertia = self.from_tip(mass * nodes.integrate(slope)[..., :-1], nodes)
        of_loads = self.from_tip(inertia, nodes), self.from_tip(tension * slope, nodes)
        return np.concatenate([polynomials, *of_loads])

    @cached_property
    def bending(self) -> np.ndarray:
        """Curvatures of the functions along the fixed e1, e2 at Gauss points, (functions, 2, points)."""
        return self._turned(self.curvature, self.quadrature, 1)

    # Forms and loads ------------------------------------------------------------------------------

    @cached_property
    def stiffness(self) -> np.ndarray:
        """Elastic energies of pairs of functions: the unit matrix up to small errors."""
        return self.gram(self.curvature, self._both_at(self.quadrature))

    def forms(self, direction: np.ndarray) -> np.ndarray:
        """Build the matrices of four forms: both tensions, mass, and mass moving in a `direction` (2,).

        The tensions are per squared speed and per acceleration of the root.
        """
        tension_b, tension_a, mass = self.loads
        slope, along = self.slope[..., :-1], direction @ self.deflection
        inertia = self.gram(self.deflection[..., :-1], mass) + self.tip.mass * self.centre @ self.centre.T
        centre = self.centre @ direction
        softening = self.gram(along[..., :-1], mass) + self.tip.mass * np.outer(centre, centre)
        return np.array([self.gram(slope, tension_b), self.gram(slope, tension_a), inertia, softening])

    @cached_property
    def twisting(self) -> np.ndarray:
        """Matrix of the form of twisting by inertia, int (v' w'' - v'' w') dx, v along e1 and w along e2."""
        across = np.stack([-self.bending[:, 1], self.bending[:, 0]], axis=1)
        form = -np.tensordot(self.slope[..., :-1] * self.quadrature.weights, across, ((1, 2), (1, 2)))
        return (form + form.T) / 2

    @cached_property
    def twisting_size(self) -> float:
        """Norm of all slopes times norm of all curvatures: the scale of the rounding errors of `twisting`."""
        sizes = (np.sqrt(np.trace(self.gram(u, np.ones(1)))) for u in (self.slope[..., :-1], self.bending))
        return float(math.prod(sizes))

    def unbalanced(
        self, answer: np.ndarray, tension: np.ndarray, inertia: np.ndarray, tilt: np.ndarray, twisting: float
    ) -> np.ndarray:
        """Compute bending moments by loads minus those by the Ritz response, in section axes: (n, 2, N).

        The loads are the tensions by rotation and by axial acceleration, times the two factors `tension`; the
        tensor `inertia` (2, 2) times mass and deflection; the tensor `tilt` (2, 2) times the slope at the
        tip; and the twisting by a tip body's product of inertia, times `twisting`.  Row i of `answer` (n, n)
        contains the coefficients of the response to the loads of function i.
        """
        (tension_b, tension_a, mass), rule, at_tip = self.loads, self.quadrature, self.slope[..., -1]
        shear = self.from_tip(mass * (inertia @ self.deflection[..., :-1]))
        shear += (tension[0] * tension_b + tension[1] * tension_a) * self.slope[..., :-1]
        arm = 1 - rule.xi + self.tip.offset
        of_body = self.tip.mass * (self.centre @ inertia)[..., None] * arm
        fixed = self.from_tip(shear) + of_body + (at_tip @ tilt)[..., None]
        turned = at_tip[..., None] / 2 - self.slope[..., :-1]
        fixed += twisting * np.stack([turned[:, 1], -turned[:, 0]], axis=1)
        own = self._both_at(rule) * self.curvature
        return self._turned(fixed, rule, -1) - np.tensordot(answer, own, 1)

    def residuals(self, unbalanced: np.ndarray) -> np.ndarray:
        """Integrate products of moments (n, 2, points) times upper bounds of the compliance: (n, n)."""
        return self.gram(unbalanced, np.repeat(self.compliance, self.quadrature.cells.points, axis=1))


def twist_degree(turn: float, ratio: float) -> tuple[int, float]:
    """Find the degree of polynomials for cosine and sine of the twist, and the error of the stiffness.

    For an angle of at most `turn` from the middle of its range, interpolation in Chebyshev points has an
    error of at most e = turn^(m+1) / (2^m (m+1)!) in each.  The matrix that rotates curvatures is then
    R (1 + E) with |E| <= 2 e, and the stiffness tensor D = R diag R^T becomes R (1 + E)^-T diag (1 + E)^-1
    R^T.  In the norm of the energy, E grows at most by the square root of the `ratio` of the two bending
    stiffnesses: the relative error of the stiffness is at most 5 sqrt(ratio) e.
    """
    for degree in range(_MOST_DEGREE):
        error = turn ** (degree + 1) / (2**degree * math.factorial(degree + 1))
        if (misfit := 5 * math.sqrt(ratio) * error) <= _MISFIT:
            return degree, misfit
    return _MOST_DEGREE, np.inf
