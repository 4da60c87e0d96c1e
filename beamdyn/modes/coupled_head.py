"""Trial functions in two planes that the twist or the mount couples, with residuals that are known exactly.

As in `beamdyn.modes.head`, but the curvature is a vector and the stiffness D(x) a tensor that the twist
beta(x) turns.  On cells the curvatures *in the axes of the section* are polynomials, so that the energy and
the moments D p need no cosine of the twist.  Only the curvatures along the fixed directions e1, e2 do, and
moments in the axes of the section.  There cosine and sine stand for polynomials of such a degree that the
beam for which they are exact has a stiffness within (1 -+ `misfit`) D(x): see `twist_degree`.

Directions: an array (n, 2, N) has components along e1, e2 or, where it says so, in the axes of the section.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import legendre

from beamdyn.common.legendre import gauss_rule, legendre_series
from beamdyn.equations.mass import axial_tension
from beamdyn.equations.moment_functions import NODES, MomentSpaces, orthonormalize
from beamdyn.equations.quadrature import ArcQuadrature, Cells
from beamdyn.modes.flexibility import bound_on_cells
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.profile import ONE, Profile

MOST_MOMENTS = 100  # in each direction: two seconds of a core
_LARGEST_TURN = 0.25  # of a section from the middle of its cell [rad]
_MISFIT = 1e-14  # relative, of the stiffness of the beam whose twist has polynomials for cosine and sine
_MOST_DEGREE = 40  # of these polynomials in the twist


@dataclass(frozen=True)
class CoupledHead:
    """Trial functions on a clamped beam in two planes, orthonormal in energy but for interpolation.

    Curvatures are those of smooth bending moments in either direction.

    Parameters
    ----------
    beam : Beam
        A nondimensional beam with a second bending stiffness.
    moments : int
        Number of moments in each direction.
    flexibility : tuple of Profile
        Upper bounds of 1/EI in the first direction of the sections and in the second.
    """

    beam: Beam
    moments: int
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
        """Ends of the cells, on which compliance and twist are resolved, as x/L."""
        ends = MomentSpaces(self.beam, self.moments).cells
        while (coarse := self._turns(ends) > _LARGEST_TURN).any():
            ends = np.sort(np.concatenate([ends, (ends[:-1] + ends[1:])[coarse] / 2]))
        return ends

    def _turns(self, ends: np.ndarray) -> np.ndarray:
        """Bounds of the angles by which sections are turned from the mean of their cell, shape (c,)."""
        varying = tuple((0.0, *row[1:]) for row in self._twist.split(ends.tolist()).coefficients)
        return bound_on_cells(Profile(self._twist.split(ends.tolist()).breakpoints, varying), ends)

    @cached_property
    def compliance(self) -> np.ndarray:
        """Upper bounds of 1/EI in either direction on the cells, shape (2, c)."""
        return np.array([bound_on_cells(p, self.ends) for p in self.flexibility])

    @cached_property
    def ratios(self) -> np.ndarray:
        """Upper bounds of ratios of two stiffnesses in a cell, in the directions i and j: shape (2, 2)."""
        largest = np.array([bound_on_cells(p, self.ends) for p in self.stiffnesses])
        return (largest[:, None] * self.compliance).max(axis=-1)

    @cached_property
    def _turning(self) -> tuple[int, float]:
        return twist_degree(float(self._turns(self.ends).max()), float(self.ratios.max()))

    @property
    def misfit(self) -> float:
        """Relative distance of the stiffness from that of the beam of which integrals are exact."""
        return self._turning[1]

    @cached_property
    def _nodes(self) -> ArcQuadrature:
        """Points through which curvatures are interpolated."""
        return ArcQuadrature(Cells(self.ends, NODES))

    @cached_property
    def quadrature(self) -> ArcQuadrature:
        """Gauss rule for products of two moments, in the axes of the section."""
        turns = 2 * self._turning[0] * self._twist.degree
        of_loads = self.beam.mass_per_length.degree + 4 + turns
        of_stiffness = max(p.degree for p in self.stiffnesses)
        return ArcQuadrature(Cells(self.ends, NODES - 1 + max(of_loads, of_stiffness) + 1))

    def at(self, profile: Profile, rule: ArcQuadrature) -> np.ndarray:
        """Values of a property at the points of a rule on the cells, shape (N,)."""
        return profile.split(self.ends.tolist()).at_points(rule.cells.points).ravel()

    def _both_at(self, rule: ArcQuadrature) -> np.ndarray:
        """Stiffnesses in the two directions at the points of a rule, shape (2, N)."""
        return np.array([self.at(p, rule) for p in self.stiffnesses])

    def _turned(self, values: np.ndarray, rule: ArcQuadrature, sign: int) -> np.ndarray:
        """Turn components (n, 2, N) into the axes of the section (sign -1), or from there (1)."""
        beta = self.at(self._twist, rule)
        c, s = np.cos(beta), sign * np.sin(beta)
        first, second = values[:, 0], values[:, 1]
        return np.stack([c * first - s * second, s * first + c * second], axis=1)

    # Functions ------------------------------------------------------------------------------------

    @cached_property
    def curvature(self) -> np.ndarray:
        """Curvatures in the axes of the section at the points, shape (n, 2, N)."""
        given = self._quotients(self._all_moments)
        stacked = given.reshape(len(given), -1)
        weight = (self._nodes.weights * self._both_at(self._nodes)).ravel()
        series = orthonormalize(stacked.T, weight).T.reshape(-1, 2, len(self.ends) - 1, NODES)
        series = series @ legendre_series(NODES).T
        t, _ = gauss_rule(self.quadrature.cells.points)
        return (series @ legendre.legvander(t, NODES - 1).T).reshape(len(series), 2, -1)

    @property
    def _all_moments(self) -> np.ndarray:
        """Bending moments along e1, e2 at the nodes (m, 2, N): polynomials, and what the first ones cause.

        That is by inertia and by tension, where the beam vibrates as the first ones bend it.
        """
        first = self.moments // 3
        count = self.moments - 2 * first
        P = legendre.legvander(2 * self._nodes.xi - 1, count - 1).T
        polynomials = np.einsum("ij,kx->kijx", np.eye(2), P).reshape(2 * count, 2, -1)
        nodes, few = self._nodes, polynomials[: 2 * first]
        slope = nodes.integrate(self._turned(self._quotients(few), nodes, 1))[..., :-1]
        mass, tension = (self.at(p, nodes) for p in (self.beam.mass_per_length, axial_tension(self.beam)[1]))
        inertia = mass * nodes.integrate(slope)[..., :-1]
        caused = (_from_tip(nodes, _from_tip(nodes, inertia)), _from_tip(nodes, tension * slope))
        return np.concatenate([polynomials, *caused])

    def _quotients(self, moments: np.ndarray) -> np.ndarray:
        """Curvatures in the axes of the section at the nodes by moments along e1, e2."""
        return self._turned(moments, self._nodes, -1) / self._both_at(self._nodes)

    @cached_property
    def slope(self) -> np.ndarray:
        """Slopes along e1, e2 at the points, and at the tip: shape (n, 2, N + 1)."""
        return self.quadrature.integrate(self._bending)

    @cached_property
    def deflection(self) -> np.ndarray:
        """Deflections along e1, e2 at the points, and at the tip: shape (n, 2, N + 1)."""
        return self.quadrature.integrate(self.slope[..., :-1])

    @property
    def _tip(self) -> TipMass:
        return self.beam.tip or TipMass(0.0)

    @cached_property
    def _centre(self) -> np.ndarray:
        """Deflections of the centre of mass of the tip body, shape (n, 2)."""
        return self.deflection[..., -1] + self._tip.offset * self.slope[..., -1]

    # Forms and loads ------------------------------------------------------------------------------

    @cached_property
    def _loads(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Properties N_B, N_A and the mass, at the points."""
        n_a, n_b = axial_tension(self.beam)
        tension_b, tension_a = self.at(n_b, self.quadrature), self.at(n_a, self.quadrature)
        return tension_b, tension_a, self.at(self.beam.mass_per_length, self.quadrature)

    @cached_property
    def stiffness(self) -> np.ndarray:
        """Energies of pairs of functions, shape (n, n): 1 but for interpolation and rounding."""
        return self._gram(self.curvature, self._both_at(self.quadrature))

    def _gram(self, values: np.ndarray, weight: np.ndarray) -> np.ndarray:
        """Integrate products of values (n, ..., N) with a weight (..., N)."""
        flat = values.reshape(len(values), -1)
        scale = np.broadcast_to(self.quadrature.weights * weight, values.shape[1:]).reshape(-1)
        return (flat * scale) @ flat.T

    def forms(self, direction: np.ndarray) -> np.ndarray:
        """The forms of the tensions N_B, N_A, the mass, and the mass along a direction (2,): (4, n, n)."""
        tension_b, tension_a, mass = self._loads
        slope, along = self.slope[..., :-1], direction @ self.deflection
        inertia = self._gram(self.deflection[..., :-1], mass) + self._tip.mass * self._centre @ self._centre.T
        centre = self._centre @ direction
        softening = self._gram(along[..., :-1], mass) + self._tip.mass * np.outer(centre, centre)
        return np.array([self._gram(slope, tension_b), self._gram(slope, tension_a), inertia, softening])

    @cached_property
    def _bending(self) -> np.ndarray:
        """Curvatures along e1, e2 at the points, shape (n, 2, N)."""
        return self._turned(self.curvature, self.quadrature, 1)

    @cached_property
    def twisting(self) -> np.ndarray:
        """The form of twisting by inertia, int (v' w'' - v'' w'), shape (n, n)."""
        across = np.stack([-self._bending[:, 1], self._bending[:, 0]], axis=1)
        form = -np.tensordot(self.slope[..., :-1] * self.quadrature.weights, across, ((1, 2), (1, 2)))
        return (form + form.T) / 2

    @cached_property
    def twisting_size(self) -> float:
        """Norm of slopes times norm of curvatures, of all functions together."""
        sizes = (np.sqrt(np.trace(self._gram(u, np.ones(1)))) for u in (self.slope[..., :-1], self._bending))
        return float(math.prod(sizes))

    @property
    def tip_slope(self) -> np.ndarray:
        """Slopes at the tip, shape (n, 2)."""
        return self.slope[..., -1]

    def moments_of(
        self, tension: np.ndarray, inertia: np.ndarray, tilt: np.ndarray, twisting: float = 0.0
    ) -> np.ndarray:
        """Bending moments in the axes of the section that loads of the functions cause, shape (n, 2, N).

        Loads are parts of the tensions N_B, N_A (2,), a tensor (2, 2) times the mass, another times the slope
        at the tip, and a part of the twisting by inertia.
        """
        tension_b, tension_a, mass = self._loads
        rule = self.quadrature
        shear = _from_tip(rule, mass * (inertia @ self.deflection[..., :-1]))
        shear += (tension[0] * tension_b + tension[1] * tension_a) * self.slope[..., :-1]
        arm = 1 - rule.xi + self._tip.offset
        at_tip = self._tip.mass * (self._centre @ inertia)[..., None] * arm
        fixed = _from_tip(rule, shear) + at_tip + (self.tip_slope @ tilt)[..., None]
        turned = self.tip_slope[..., None] / 2 - self.slope[..., :-1]
        fixed += twisting * np.stack([turned[:, 1], -turned[:, 0]], axis=1)
        return self._turned(fixed, rule, -1)

    def unbalanced(self, moments: np.ndarray, answer: np.ndarray) -> np.ndarray:
        """Moments (n, 2, N) less those of curvatures that the functions combine, by columns (n, n)."""
        own = self._both_at(self.quadrature) * self.curvature
        return moments - np.tensordot(answer, own, 1)

    def residuals(self, unbalanced: np.ndarray) -> np.ndarray:
        """Integrate products of moments (m, 2, N) with the bounds of the compliance."""
        return self._gram(unbalanced, np.repeat(self.compliance, self.quadrature.cells.points, axis=1))


def _from_tip(rule: ArcQuadrature, values: np.ndarray) -> np.ndarray:
    """Integrate from each point to the tip: shape (..., N); small values there keep their digits."""
    inwards = ArcQuadrature(Cells(-rule.cells.ends[::-1], rule.cells.points))
    return inwards.integrate(values[..., ::-1])[..., -2::-1]


def twist_degree(turn: float, ratio: float) -> tuple[int, float]:
    """Degree in the twist of polynomials for its cosine and sine, and how far they change a stiffness.

    Of an angle of at most `turn` from the middle of its range, interpolation in Chebyshev's points has an
    error of at most e = turn^(m+1) / (2^m (m+1)!) in each.  The matrix that turns curvatures is then
    R (1 + E) with |E| <= 2 e, and D becomes R (1 + E)^-T diag (1 + E)^-1 R^T.  In the norm of the energy
    E grows at most by the root of the ratio of the stiffnesses: a relative misfit of 5 sqrt(ratio) e.
    """
    for degree in range(_MOST_DEGREE):
        error = turn ** (degree + 1) / (2**degree * math.factorial(degree + 1))
        if (misfit := 5 * math.sqrt(ratio) * error) <= _MISFIT:
            return degree, misfit
    return _MOST_DEGREE, np.inf
