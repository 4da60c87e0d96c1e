"""Trial functions whose residuals are known exactly, for the theorem of `beamdyn.modes.split`.

Their curvatures are piecewise polynomials on cells: polynomials on each segment of a beam of few segments,
bending moments over the stiffness on a beam of many or where it almost vanishes.  So are all moments that
their loads cause; products of these with the properties are integrated exactly.  In the energy a the
functions are orthonormal, whatever the stiffness, so that rounding has the size of the eigenvalues and not of
the largest stiffness over the least.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import qr, solve_triangular

from beamdyn.common.legendre import gauss_rule, legendre_series
from beamdyn.equations.discretization import CLAMPED
from beamdyn.equations.mass import axial_tension
from beamdyn.equations.moment_functions import NODES
from beamdyn.equations.quadrature import ArcQuadrature, Cells
from beamdyn.equations.ritz import MOST_FUNCTIONS, Ritz
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.profile import Profile

_FEW_SEGMENTS = 6  # on more, moments over the whole beam need fewer functions than polynomials on each
_SAMPLES = 32  # of the stiffness on a segment, which decide about the basis only
_STEEP = 300.0  # ratio of two of them, beyond which cells have to be graded
_MOST_IN_ALL = 500  # functions on all segments together: an eigenproblem of a tenth of a second

_CONDITIONS = CLAMPED._replace(stiffness="bending_stiffness")


def most_functions(beam: Beam) -> int:
    """Largest number of functions of a head: on each segment, or of moments in all."""
    most = MOST_FUNCTIONS - _extra_degrees(beam)
    return most if _bends_by_moments(beam) else min(most, _MOST_IN_ALL // segments_with_functions(beam))


def segments_with_functions(beam: Beam) -> int:
    """Number of segments that have functions of their own."""
    return 1 if _bends_by_moments(beam) else len(beam.breakpoints) - 1


def basis(beam: Beam, functions: int) -> Ritz:
    """The assumed modes of a head with a number of functions, on each segment where these have their own."""
    return Ritz(functions, "moments" if _bends_by_moments(beam) else "legendre")


def _bends_by_moments(beam: Beam) -> bool:
    """Whether polynomial curvatures do badly: on many segments, or where the stiffness almost vanishes."""
    if len(beam.breakpoints) - 1 > _FEW_SEGMENTS:
        return True
    stiffness = beam.bending_stiffness.at_points(_SAMPLES)
    return bool((stiffness.max(axis=1) > _STEEP * stiffness.min(axis=1)).any())


def _extra_degrees(beam: Beam) -> int:
    """Degrees by which moments, of loads or of the curvature, exceed the polynomials of the curvature."""
    return max(beam.mass_per_length.degree + 4, beam.bending_stiffness.degree)


@dataclass(frozen=True)
class Head:
    """Trial functions on a clamped beam, orthonormal in energy, and the moments that their loads cause.

    Forms and loads are, in this order, those of the tension N_B per squared speed, of the tension N_A per
    acceleration of the root, of the mass with point masses and tip body, and of the slope at the tip.

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

    @cached_property
    def quadrature(self) -> ArcQuadrature:
        """Gauss rule for products of two moments of the highest degree, and of less with properties."""
        return ArcQuadrature(Cells(self.ends, self._degree + _extra_degrees(self.beam) + 1))

    @property
    def _degree(self) -> int:
        """Degree of the curvatures."""
        return (self.functions if self._ritz.on_each_segment else NODES) - 1

    @cached_property
    def curvature(self) -> np.ndarray:
        """Curvatures at the points, shape (n, N)."""
        given = self._ritz.spaces(self.beam).functions(_CONDITIONS).samples[2]
        on_cells = given.reshape(len(given), len(self.ends) - 1, -1)
        series = on_cells @ legendre_series(on_cells.shape[-1])[: self._degree + 1].T
        root = np.sqrt(self.quadrature.weights * self.at_points(self.beam.bending_stiffness))
        (factor,) = qr((self._sum(series) * root).T, mode="r")
        columns = series.reshape(len(series), -1)
        return self._sum(solve_triangular(factor[: len(series)], columns, trans="T").reshape(series.shape))

    def _sum(self, series: np.ndarray) -> np.ndarray:
        """Values at the points (n, N) of Legendre series on each cell (n, c, degree + 1)."""
        t, _ = gauss_rule(self.quadrature.cells.points)
        return (series @ legendre.legvander(t, self._degree).T).reshape(len(series), -1)

    def at_points(self, profile: Profile) -> np.ndarray:
        """Values of a property at the points, shape (N,)."""
        return profile.split(self.ends.tolist()).at_points(self.quadrature.cells.points).ravel()

    @cached_property
    def slope(self) -> np.ndarray:
        """Slopes at the points, and at the tip: shape (n, N + 1)."""
        return self.quadrature.integrate(self.curvature)

    @cached_property
    def deflection(self) -> np.ndarray:
        """Deflections at the points, and at the tip: shape (n, N + 1)."""
        return self.quadrature.integrate(self.slope[:, :-1])

    @property
    def _tip(self) -> TipMass:
        return self.beam.tip or TipMass(0.0)

    @cached_property
    def _centre(self) -> np.ndarray:
        """Deflections of the centre of mass of the tip body, shape (n,)."""
        return self.deflection[:, -1] + self._tip.offset * self.slope[:, -1]

    @cached_property
    def _at_lumps(self) -> np.ndarray:
        """Deflections of the point masses, shape (n, k)."""
        return self.slope[:, :-1] @ self.quadrature.integrate_to(self.beam.lumps[0]).T

    @cached_property
    def _loads(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Properties N_B, N_A and the mass, at the points."""
        n_a, n_b = axial_tension(self.beam)
        return self.at_points(n_b), self.at_points(n_a), self.at_points(self.beam.mass_per_length)

    @cached_property
    def stiffness(self) -> np.ndarray:
        """Energies of pairs of functions, shape (n, n): 1 but for rounding."""
        return self._gram(self.curvature, self.at_points(self.beam.bending_stiffness))

    @cached_property
    def forms(self) -> np.ndarray:
        """The forms as matrices, shape (4, n, n)."""
        tension_b, tension_a, mass = self._loads
        slope, tip, centre = self.slope[:, :-1], self.slope[:, -1], self._centre
        inertia = self._gram(self.deflection[:, :-1], mass) + self._tip.mass * np.outer(centre, centre)
        inertia += (self._at_lumps * self.beam.lumps[1]) @ self._at_lumps.T
        by_tension = (self._gram(slope, tension) for tension in (tension_b, tension_a))
        return np.array([*by_tension, inertia, np.outer(tip, tip)])

    def _gram(self, values: np.ndarray, weight: np.ndarray) -> np.ndarray:
        return (values * (self.quadrature.weights * weight)) @ values.T

    @cached_property
    def moments(self) -> np.ndarray:
        """Bending moments at the points that the loads of each function cause, shape (4, n, N)."""
        tension_b, tension_a, mass = self._loads
        slope = self.slope[:, :-1]
        inertia = self._from_tip(self._from_tip(mass * self.deflection[:, :-1]))
        arm, (xi, lumped) = 1 - self.quadrature.xi + self._tip.offset, self.beam.lumps
        inertia += (self._at_lumps * lumped) @ np.maximum(xi[:, None] - self.quadrature.xi, 0.0)
        return np.array(
            [
                self._from_tip(tension_b * slope),
                self._from_tip(tension_a * slope),
                inertia + self._tip.mass * np.outer(self._centre, arm),
                np.broadcast_to(self.slope[:, -1:], slope.shape),
            ]
        )

    def _from_tip(self, values: np.ndarray) -> np.ndarray:
        """Integrate from each point to the tip: shape (n, N); small values there keep their digits."""
        return self._inwards.integrate(values[:, ::-1])[:, -2::-1]

    @cached_property
    def _inwards(self) -> ArcQuadrature:
        return ArcQuadrature(Cells(-self.ends[::-1], self.quadrature.cells.points))

    def residuals(self, compliance: np.ndarray) -> np.ndarray:
        """Integrate products of moments that the head does not balance, with a compliance of each cell (c,).

        For the load j of the function i the moment is F_ji - EI p, where the curvature p of the head is the
        best answer if the functions are orthonormal: shape (4, n, 4, n).
        """
        own = self.at_points(self.beam.bending_stiffness) * self.curvature
        left = (self.moments - self.forms @ own).reshape(-1, own.shape[1])
        weight = self.quadrature.weights * np.repeat(compliance, self.quadrature.cells.points)
        return ((left * weight) @ left.T).reshape(4, len(own), 4, len(own))
