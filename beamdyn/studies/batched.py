"""Frequencies and critical speeds of many similar designs, by batched eigenproblems.

Designs are solved together in bases of increasing size; each design in the smallest basis that would be
chosen if it were solved alone.

In shapes of arrays, N counts designs, R designs solved together, S speeds, and k modes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from beamdyn.accuracy.refinement import refine
from beamdyn.common.results.statements import GROWING, NO_ANSWER, OUTSIDE, TOLERANCE, Statement, after
from beamdyn.equations.discretization import Discretization
from beamdyn.equations.mass import moments_about_root
from beamdyn.equations.ritz import Ritz
from beamdyn.modes.modal.discretization_choice import (
    DEFAULT_TARGET,
    DiscretizationChoice,
    list_models,
    warn_of_missed_tolerance,
    within_reach,
)
from beamdyn.modes.modal.many_designs import PencilStack, solve_many, speeds_of_meeting
from beamdyn.scene.scene import Scene
from beamdyn.scene.validity import LARGE_DEFLECTION, LARGE_STRAIN, warn_of_static_deflection, warn_of_strain
from beamdyn.studies.answers import REFUSED, Caution, DesignAnswers, caution_where
from beamdyn.studies.similar import PencilFamily, SimilarDesigns

# Relative error to be reached for beams with a tip body: bases that suffice for a larger error miss modes
# with thin boundary layers.
_WITH_TIP_BODY = 1e-7
# Largest number of matrix entries solved in one batch, so that they fit into the processor's cache.
_ENTRIES = 300_000


@dataclass(frozen=True)
class BasisAnswers:
    """Results of R designs in one basis, and whether they are accurate enough.

    Parameters
    ----------
    arrays : tuple of ndarray, shape (R, ...)
        The results.
    met : ndarray of bool, shape (R,)
        Whether each design's errors meet the target, or are rounding errors.
    """

    arrays: tuple[np.ndarray, ...]
    met: np.ndarray


# Function that solves the designs with given indices in a basis.
Solve = Callable[[np.ndarray, Discretization], BasisAnswers]


@dataclass(frozen=True)
class Refinement:
    """Sequence of bases in which designs are solved until the results are accurate enough.

    Parameters
    ----------
    reference : Scene
        Reference scene of the designs.
    modes : int
        Number of modes.
    discretization : {"ritz"} or Ritz
        As for `natural_modes`.
    tolerance : float, optional
        As for `natural_modes`.
    """

    reference: Scene
    modes: int
    discretization: DiscretizationChoice
    tolerance: float | None

    def bases(self) -> Iterator[Discretization]:
        """Return the bases to try, by increasing number of functions."""
        cheapest = self.tolerance is not None and self.reference.beam.tip is None
        models = list_models(self.reference, self.discretization, self.modes, self._target, cheapest)
        return (model.discretization for model in models)

    @property
    def _target(self) -> float:
        """Relative error to be reached; with a tip body, small enough to resolve its boundary layer."""
        target = DEFAULT_TARGET if self.tolerance is None else self.tolerance
        return target if self.reference.beam.tip is None else min(target, _WITH_TIP_BODY)

    def target_of(self, basis: Discretization) -> float:
        """Return the largest relative error with which the results in a basis are accepted.

        It is the target, but at least 1e-10 for bases of moment functions, whose estimated errors are too
        large.
        """
        return within_reach(basis, self._target)

    @property
    def can_be_batched(self) -> bool:
        """Whether all designs can be solved in the same basis functions."""
        return self.discretization == "ritz" or isinstance(self.discretization, Ritz)

    def solve(self, count: int, speeds: int, solve: Solve) -> tuple[list[np.ndarray], int]:
        """Solve designs at several speeds each, in larger and larger bases until all meet the target.

        Returns
        -------
        answers : list of ndarray, shape (designs, ...)
            Results of each design in the last basis that gives any; nan if none does.
        functions : int
            Largest number of basis functions that was used.
        """
        bases, answers, functions = self.bases(), list[np.ndarray](), 0

        def solve_finer(pending: np.ndarray) -> np.ndarray | None:
            """Solve the designs with the indices `pending`, which are not accurate yet, in the next basis.

            Return the indices of the designs that still miss the target; None if there is no further basis.
            """
            nonlocal answers, functions
            if (basis := next(bases, None)) is None:
                return None
            unmet = [np.empty(0, dtype=int)]
            most = max(1, _ENTRIES // (_size(basis) ** 2 * speeds))
            for batch in np.split(pending, range(most, len(pending), most)):
                for part, found in _solve_or_halve(solve, batch, basis):
                    answers = answers or [
                        np.full((count, *a.shape[1:]), np.nan, dtype=a.dtype) for a in found.arrays
                    ]
                    for kept, array in zip(answers, found.arrays, strict=True):
                        kept[part] = array
                    functions = max(functions, _size(basis))
                    unmet.append(part[~found.met])
            return np.concatenate(unmet)

        refine(np.arange(count), solve_finer, lambda pending: not pending.size)
        return answers, functions


def _solve_or_halve(
    solve: Solve, batch: np.ndarray, basis: Discretization
) -> Iterator[tuple[np.ndarray, BasisAnswers]]:
    """Solve a batch of designs; yield parts of the batch and their results.

    Designs whose matrices are singular by rounding are omitted; they are found by halving batches.
    """
    try:
        yield batch, solve(batch, basis)
    except np.linalg.LinAlgError:
        if len(batch) > 1:
            for half in np.array_split(batch, 2):
                yield from _solve_or_halve(solve, half, basis)


def _size(basis: Discretization) -> int:
    assert isinstance(basis, Ritz)
    return basis.functions


# Natural frequencies ------------------------------------------------------------------------------


_LARGE_ERROR = 1e-6  # estimated relative error above which a warning says that a frequency is not resolved


@dataclass(frozen=True)
class SolvedDesigns:
    """Frequencies of R designs at S speeds each, with their errors.

    Parameters
    ----------
    eigenvalue : ndarray of complex, shape (R, S, results)
        Exponent s of the motion exp(s t) [1/s]; nan where there is none.
    error : ndarray, shape (R, S, results)
        Estimated relative error of the frequencies.
    deflection : ndarray, shape (R, S)
        Magnitude of the static tip deflection by rotation, over the length; nan at and above the critical
        speed.
    functions : int
        Largest number of basis functions that was used.
    """

    eigenvalue: np.ndarray
    error: np.ndarray
    deflection: np.ndarray
    functions: int


def solve_frequencies(
    designs: SimilarDesigns, refinement: Refinement, speeds: np.ndarray, ratio: np.ndarray | None = None
) -> SolvedDesigns:
    """Compute the eigenvalues of similar designs, each in the smallest basis it would get if solved alone.

    Parameters
    ----------
    designs : SimilarDesigns
        N designs.
    refinement : Refinement
        The bases, and the number of modes.
    speeds : ndarray, shape (N, speeds)
        Speeds of each design [rad/s].
    ratio : ndarray, shape (N,), optional
        Damping ratio of each design; undamped if not given.
    """

    def solve(rows: np.ndarray, basis: Discretization) -> BasisAnswers:
        stack, coarse, family, weights = stacks_of(designs, rows, basis)
        damped = None if ratio is None else ratio[rows]
        load = np.einsum("rt,tdn,rd->rn", weights, family.loads, designs.across[rows], optimize=True)
        at, estimate = speeds[rows] * designs.time[rows, None], designs.estimate(basis)
        found = solve_many(stack, coarse, at, refinement.modes, load, family.tips, damped, estimate)
        target = np.maximum(refinement.target_of(basis), 3 * found.rounding)
        met = np.all(found.error <= target, axis=(1, 2))
        deflection = found.static / designs.reference.beam.length
        return BasisAnswers((found.eigenvalue, found.error, deflection), met)

    found, functions = refinement.solve(len(speeds), speeds.shape[1], solve)
    shape = (*speeds.shape, refinement.modes)
    nothing = np.full(shape, np.nan, dtype=complex), np.full(shape, np.nan), np.full(speeds.shape, np.nan)
    eigenvalue, error, deflection = found or nothing
    error = np.where(np.isnan(eigenvalue), np.inf, error)
    return SolvedDesigns(eigenvalue / designs.time[:, None, None], error, deflection, functions)


def frequencies_of(
    designs: SimilarDesigns, refinement: Refinement, speeds: np.ndarray, ratio: np.ndarray | None
) -> DesignAnswers:
    """Compute the frequencies of similar designs, with statuses and warnings.

    For the parameters see `solve_frequencies`.
    """
    found = solve_frequencies(designs, refinement, speeds, ratio)
    s = found.eigenvalue
    growing, oscillating, none = np.real(s) > 0, np.imag(s) != 0, np.isnan(s)
    words = [REFUSED, "flutter", "divergence", "stable", "neutral"]
    status = np.select([none, growing & oscillating, growing, oscillating, s == 0], words, "overdamped")
    frequency = np.where(np.isin(status, ("stable", "neutral")), np.imag(s) / (2 * np.pi), np.nan)
    method = f"Ritz, at most {found.functions} functions, batched"
    cautions = (
        *_cautions_of_theory(designs, speeds, found.deflection, status),
        *cautions_of_refused(status),
        *cautions_of_error(found.error, refinement.tolerance),
    )
    return DesignAnswers(frequency, found.error, status, cautions, method)


def _cautions_of_theory(
    designs: SimilarDesigns, speeds: np.ndarray, deflection: np.ndarray, status: np.ndarray
) -> Iterator[Caution]:
    """Yield warnings about designs beyond linear theory, for the same reasons as `natural_modes` does."""
    unstable = np.isin(status, ("divergence", "flutter")).any(axis=2)
    diverges = Statement(": the beam diverges; see status", kind=GROWING)
    yield from caution_where(unstable, "a", 0.0, diverges)
    strain = designs.strains(speeds)
    large, bent = strain > LARGE_STRAIN, deflection > LARGE_DEFLECTION
    if large.any():
        said = after(": ", next(warn_of_strain(float(np.nanmax(strain)))))
        yield from caution_where(large, "b", strain, said)
    if bent.any():
        at = np.unravel_index(np.nanargmax(deflection), bent.shape)
        said = next(warn_of_static_deflection(deflection[at][None], 1.0, speeds[at][None]))
        yield from caution_where(bent, "c", deflection, after(": ", said))


def cautions_of_refused(status: np.ndarray) -> Iterable[Caution]:
    """Yield a warning about the designs that have no result because of rounding errors.

    These designs have "refused" in their `status`.  Nothing is yielded if all designs have a result.
    """
    said = Statement(" there is no answer: rounding of the matrices leaves no correct digit", kind=NO_ANSWER)
    return caution_where((status == REFUSED).any(axis=2), "d", 0.0, said)


def cautions_of_error(error: np.ndarray, tolerance: float | None) -> Iterator[Caution]:
    """Yield a warning about errors above the tolerance, or above 1e-6 if none is given."""
    worst, limit = error.max(axis=2), _LARGE_ERROR if tolerance is None else tolerance
    said: str = Statement(f" the estimated relative error is above {limit:g}: see error", kind=TOLERANCE)
    if tolerance is not None and worst.max() > tolerance:
        said = after(": ", next(warn_of_missed_tolerance(float(worst.max()), tolerance)))
    yield from caution_where(worst > limit, "e", worst, said)


def stacks_of(
    designs: SimilarDesigns, rows: np.ndarray, basis: Discretization
) -> tuple[PencilStack, PencilStack, PencilFamily, np.ndarray]:
    """Interpolate the matrices of the designs `rows` in a basis and in its coarser basis.

    Return both, the `PencilFamily` of the basis, and the weights by which its matrices are interpolated.
    """
    family, weights = designs.family(basis), designs.weights(rows)
    stack = family.stack(weights)
    if family.coarse is not None:
        return stack, stack.part(family.coarse), family, weights
    return stack, designs.family(basis.coarser()).stack(weights), family, weights


# Critical speeds ----------------------------------------------------------------------------------


BUCKLES, DOES_NOT_BUCKLE, NOT_FOUND = "buckles", "does not buckle", "not found"
_SIZED_FOR = 5  # number of modes for which the first basis is chosen, as for one design
_TO_HALF = 4  # number of steps to coarser bases, from a basis to one of about half its size
_ROUNDING = 64 * float(np.finfo(float).eps)  # rounding error of a sum, relative to the sizes of its terms
_BENT = "rotation bends the beam at every speed, so that it does not buckle as a straight one does"


def critical_speeds_of(
    designs: SimilarDesigns, refinement: Refinement, single: Callable[[np.ndarray], DesignAnswers]
) -> DesignAnswers:
    """Compute the critical speeds of similar designs, with statuses and warnings.

    Parameters
    ----------
    designs : SimilarDesigns
        N designs.
    refinement : Refinement
        The bases; its number of modes is not used.
    single : callable
        Function that solves the designs with given indices one by one.  It is called for those designs for
        which neither a proof nor the solution in a common basis decides whether they buckle.
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
    """Compute critical speeds of the designs `rows` [rad/s], and their relative errors.

    The third array states whether each error meets the target.  Each basis is compared with a basis of about
    half the size, as for a single design.
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
        # Designs that do not buckle in this basis are not solved in larger bases, but by `single`.
        return BasisAnswers((speed / time, error, met.astype(float)), met | np.isinf(speed))

    speed, error, met = refinement.solve(len(rows), 1, solve)[0] or [np.full(len(rows), np.nan)] * 3
    return speed, error, met == 1.0


def _stiffened(designs: SimilarDesigns) -> np.ndarray:
    """Mark the designs (N,) for which it is proven that rotation stiffens them against every deflection."""
    two = designs.reference.physics.planes == 2
    with_inertia = [designs.tip[name] != 0 for name in ("transverse_inertia", "axial_inertia")]
    if designs.reference.beam.point_masses:
        # There is no proof for beams with point masses: `single` decides whether they buckle.
        return np.zeros(designs.count, dtype=bool)
    tilting = designs.tip["transverse_inertia"] - designs.tip["axial_inertia"]
    if not two:
        return _is_stiffened(designs, designs.in_plane, tilting)
    # With two planes of bending, the proof covers only tip bodies without moments of inertia.
    apart = ~np.any(with_inertia, axis=0)
    return apart & np.all([_is_stiffened(designs, np.array(c2), np.array(0.0)) for c2 in (0.0, 1.0)], axis=0)


def _is_stiffened(designs: SimilarDesigns, cos2: np.ndarray, tilting: np.ndarray) -> np.ndarray:
    """Mark the designs (N,) for which the form F of `beamdyn.modes.buckling` is surely positive.

    Rotation then stiffens the beam against every deflection, so that it does not buckle.

    Parameters
    ----------
    designs : SimilarDesigns
        N designs.
    cos2 : ndarray
        Squared cosine of the angle between the bending direction and the plane of rotation.
    tilting : ndarray
        Transverse minus axial moment of inertia of the tip body [kg m2].
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
    """Add terms; return 0 if the sum is within their rounding errors."""
    total, size = np.asarray(sum(terms)), np.asarray(sum(map(np.abs, terms)))
    return np.where(np.abs(total) > _ROUNDING * size, total, 0.0)
