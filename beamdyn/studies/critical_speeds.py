"""Critical speeds of designs that differ in numbers only: by batched eigenproblems, without a search."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from beamdyn.common.pickling import FieldsOnly
from beamdyn.equations.discretization import Discretization
from beamdyn.equations.mass import moments_about_root
from beamdyn.modal.choice import DiscretizationChoice
from beamdyn.modal.many_designs import speeds_of_meeting
from beamdyn.studies.answers import Caution, DesignAnswers, caution_where
from beamdyn.studies.frequencies import cautions_of_error
from beamdyn.studies.refinement import BasisAnswers, Refinement
from beamdyn.studies.similar import SimilarDesigns

BUCKLES, DOES_NOT_BUCKLE, NOT_FOUND = "buckles", "does not buckle", "not found"
_SIZED_FOR = 5  # modes that suit the first basis, as for a single design
_TO_HALF = 4  # steps from a basis to one of about half its size
_ROUNDING = 64 * float(np.finfo(float).eps)  # of a sum, relative to its terms
_BENT = "rotation bends the beam at every speed, so that it does not buckle as a straight one does"


@dataclass(frozen=True)
class SimilarCriticalSpeeds(FieldsOnly):
    """The critical speeds of similar designs.

    Parameters
    ----------
    designs : SimilarDesigns
        N designs.
    discretization, tolerance
        As for `critical_point`.
    single : callable
        Answers the designs of some rows one by one: where no argument and no basis decides.
    """

    designs: SimilarDesigns
    discretization: DiscretizationChoice
    tolerance: float | None
    single: Callable[[np.ndarray], DesignAnswers]

    def answers(self) -> DesignAnswers:
        """The answers of the designs, with what limits them."""
        shape = self.designs.count, 1, 1
        value, error, status = np.full(shape, np.inf), np.zeros(shape), np.full(shape, DOES_NOT_BUCKLE)
        sought = np.flatnonzero(~self._stiffened)
        speed, relative, met = self._search(sought)
        found, left = sought[met], sought[~met]
        value[found, 0, 0], error[found, 0, 0], status[found] = speed[met], relative[met], BUCKLES
        cautions = [*self._cautions(value, error, found)]
        if left.size:
            alone = self.single(left)
            status = status.astype(np.promote_types(status.dtype, alone.status.dtype))
            value[left], error[left], status[left] = alone.value, alone.error, alone.status
            cautions += alone.cautions
        return DesignAnswers(value, error, status, tuple(cautions), "Ritz, batched")

    def _search(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Critical speeds, errors and whether these meet the target, (R,), of designs of some rows."""
        refinement = Refinement(self.designs.reference, _SIZED_FOR, self.discretization, self.tolerance)
        if not isinstance(self.discretization, str):
            refinement = replace(refinement, modes=1)

        def solve(batch: np.ndarray, basis: Discretization) -> BasisAnswers:
            return self._solve_batch(rows[batch], basis, refinement.target_of(basis))

        found, _ = refinement.solve(len(rows), 1, solve)
        if not found:
            return np.empty(len(rows)), np.empty(len(rows)), np.zeros(len(rows), dtype=bool)
        speed, error, met = found
        return speed, error, met == 1.0

    def _solve_batch(self, rows: np.ndarray, basis: Discretization, target: float) -> BasisAnswers:
        """Compare a basis with one of about half its size, as for a single design."""
        designs, half = self.designs, basis
        for _ in range(_TO_HALF):
            half = half.coarser()
        weights = designs.weights(rows)
        stack, coarse = (designs.family(each).stack(weights) for each in (basis, half))
        top = np.full(len(rows), np.inf)
        found = speeds_of_meeting(stack, coarse, np.zeros(1), 1, top, designs.estimate(basis))
        speed, error, rounding = (values[:, 0, 0] for values in found)
        met = np.isfinite(speed) & (error <= np.maximum(target, 3 * rounding))
        # Where a basis softens at no speed, a single call decides whether there is one.
        return BasisAnswers((speed / designs.time[rows], error, met.astype(float)), met | np.isinf(speed))

    @property
    def _stiffened(self) -> np.ndarray:
        """Whether an argument says that rotation stiffens a design against every deflection, (N,)."""
        designs, two = self.designs, self.designs.reference.physics.planes == 2
        with_inertia = [designs.tip[name] != 0 for name in ("transverse_inertia", "axial_inertia")]
        if designs.reference.beam.point_masses:
            return np.zeros(designs.count, dtype=bool)  # single calls know
        tilting = designs.tip["transverse_inertia"] - designs.tip["axial_inertia"]
        if not two:
            return _is_stiffened(designs, designs.in_plane, tilting)
        apart = ~np.any(with_inertia, axis=0)  # else the twist turns the body
        return apart & np.all(
            [_is_stiffened(designs, np.array(c2), np.array(0.0)) for c2 in (0.0, 1.0)], axis=0
        )

    def _cautions(self, value: np.ndarray, error: np.ndarray, found: np.ndarray) -> Iterator[Caution]:
        """Yield what `critical_point` warns of."""
        yield from cautions_of_error(error, self.tolerance)
        bent = np.zeros((len(value), 1), dtype=bool)
        bent[found] = (self.designs.across[found] != 0).any(axis=1)[:, None]
        yield from caution_where(bent, "f", 0.0, f": {_BENT}: the answer is outside linear theory")


def _is_stiffened(designs: SimilarDesigns, cos2: np.ndarray, tilting: np.ndarray) -> np.ndarray:
    """Whether the form F of `beamdyn.spectrum.buckling` is positive without a look at its string, (N,).

    Parameters
    ----------
    designs : SimilarDesigns
        N designs.
    cos2 : ndarray
        Squared cosine of the angle of bending from the plane of rotation.
    tilting : ndarray
        J_e - J_1 of the tip body [kg m2].
    """
    L, a, sin2 = designs.reference.beam.length, designs.axial, 1 - cos2
    m, eps = designs.tip["mass"], designs.tip["offset"]
    mass, first, _ = moments_about_root(designs.reference.beam)
    moment, tilt = m * eps, sin2 * tilting
    at_root = _sum(first, m * L, moment, -a * (mass + m))
    at_tip = _sum(m * L, moment, -m * a)
    toppling = _sum(tilt, moment * L, -moment * a, moment * sin2 * eps)
    reach = moment * (L + eps - a)
    determinant = _sum(
        *(tilt * v for v in (sin2 * L, eps, -a)), *(reach * v for v in (sin2 * L, sin2 * eps, -a))
    )
    upright = (at_root >= 0) & (at_tip >= 0) & (toppling >= 0) & ~((toppling == 0) & (cos2 * moment != 0))
    return upright & ((cos2 == 0) | (a <= 0) & ((toppling == 0) | (determinant >= 0)))


def _sum(*terms: np.ndarray | float) -> np.ndarray:
    """Add terms; 0 where the sum is within their rounding errors."""
    total, size = np.asarray(sum(terms)), np.asarray(sum(map(np.abs, terms)))
    return np.where(np.abs(total) > _ROUNDING * size, total, 0.0)
