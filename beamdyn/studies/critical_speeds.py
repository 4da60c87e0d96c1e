"""Critical speeds of designs that differ in numbers only: by batched eigenproblems, without a search."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from beamdyn.common.results.statements import OUTSIDE, Statement
from beamdyn.equations.discretization import Discretization
from beamdyn.equations.mass import moments_about_root
from beamdyn.modes.modal.many_designs import speeds_of_meeting
from beamdyn.studies.answers import DesignAnswers, caution_where
from beamdyn.studies.frequencies import cautions_of_error
from beamdyn.studies.refinement import BasisAnswers, Refinement
from beamdyn.studies.similar import SimilarDesigns

BUCKLES, DOES_NOT_BUCKLE, NOT_FOUND = "buckles", "does not buckle", "not found"
_SIZED_FOR = 5  # modes that suit the first basis, as for a single design
_TO_HALF = 4  # steps from a basis to one of about half its size
_ROUNDING = 64 * float(np.finfo(float).eps)  # of a sum, relative to its terms
_BENT = "rotation bends the beam at every speed, so that it does not buckle as a straight one does"


def critical_speeds_of(
    designs: SimilarDesigns, refinement: Refinement, single: Callable[[np.ndarray], DesignAnswers]
) -> DesignAnswers:
    """The critical speeds of similar designs, with what limits them.

    Parameters
    ----------
    designs : SimilarDesigns
        N designs.
    refinement : Refinement
        The bases; its number of modes is not used.
    single : callable
        Answers the designs of some rows one by one: where no argument and no basis decides.
    """
    shape = designs.count, 1, 1
    value, error, status = np.full(shape, np.inf), np.zeros(shape), np.full(shape, DOES_NOT_BUCKLE)
    sought = np.flatnonzero(~_stiffened(designs))
    sized_for = _SIZED_FOR if isinstance(refinement.discretization, str) else 1
    speed, relative, met = _search(designs, replace(refinement, modes=sized_for), sought)
    found, left = sought[met], sought[~met]
    value[found, 0, 0], error[found, 0, 0], status[found] = speed[met], relative[met], BUCKLES
    bent = np.zeros((len(value), 1), dtype=bool)
    bent[found] = (designs.across[found] != 0).any(axis=1)[:, None]
    said = Statement(f": {_BENT}: the answer is {OUTSIDE}", kind=OUTSIDE)
    cautions = [*cautions_of_error(error, refinement.tolerance), *caution_where(bent, "f", 0.0, said)]
    if left.size:
        alone = single(left)
        status = status.astype(np.promote_types(status.dtype, alone.status.dtype))
        value[left], error[left], status[left] = alone.value, alone.error, alone.status
        cautions += alone.cautions
    return DesignAnswers(value, error, status, tuple(cautions), "Ritz, batched")


def _search(
    designs: SimilarDesigns, refinement: Refinement, rows: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Critical speeds, errors and whether these meet the target, (R,), of designs of some rows.

    A basis is compared with one of about half its size, as for a single design.
    """

    def solve(batch: np.ndarray, basis: Discretization) -> BasisAnswers:
        half = basis
        for _ in range(_TO_HALF):
            half = half.coarser()
        weights, time = designs.weights(rows[batch]), designs.time[rows[batch]]
        stack, coarse = (designs.family(each).stack(weights) for each in (basis, half))
        top = np.full(len(batch), np.inf)
        found = speeds_of_meeting(stack, coarse, np.zeros(1), 1, top, designs.estimate(basis))
        speed, error, rounding = (values[:, 0, 0] for values in found)
        met = np.isfinite(speed) & (error <= np.maximum(refinement.target_of(basis), 3 * rounding))
        # Where a basis softens at no speed, a single call decides whether there is one.
        return BasisAnswers((speed / time, error, met.astype(float)), met | np.isinf(speed))

    speed, error, met = refinement.solve(len(rows), 1, solve)[0] or [np.full(len(rows), np.nan)] * 3
    return speed, error, met == 1.0


def _stiffened(designs: SimilarDesigns) -> np.ndarray:
    """Whether an argument says that rotation stiffens a design against every deflection, (N,)."""
    two = designs.reference.physics.planes == 2
    with_inertia = [designs.tip[name] != 0 for name in ("transverse_inertia", "axial_inertia")]
    if designs.reference.beam.point_masses:
        return np.zeros(designs.count, dtype=bool)  # single calls know
    tilting = designs.tip["transverse_inertia"] - designs.tip["axial_inertia"]
    if not two:
        return _is_stiffened(designs, designs.in_plane, tilting)
    apart = ~np.any(with_inertia, axis=0)  # else the twist turns the body
    return apart & np.all([_is_stiffened(designs, np.array(c2), np.array(0.0)) for c2 in (0.0, 1.0)], axis=0)


def _is_stiffened(designs: SimilarDesigns, cos2: np.ndarray, tilting: np.ndarray) -> np.ndarray:
    """Whether the form F of `beamdyn.modes.buckling` is positive without a look at its string, (N,).

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
