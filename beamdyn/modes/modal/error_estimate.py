"""Error estimates of eigenvalues by comparison with those of a coarser model.

In shapes of arrays, S counts speeds, and k modes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from beamdyn.accuracy.refinement import BASES_OF_FIELDS, BASES_OF_PLATES, ROUNDING_OF_TWO, SLOW_BASES
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.equations.discretization import Discretization
from beamdyn.modes.modal.eigenproblem import Eigen, Eigensolver, explained
from beamdyn.modes.modal.model import Model
from beamdyn.modes.modal.solvers import eigenvalues_over_speeds, solve_over_speeds, solver_of
from beamdyn.scene.scene import Scene
from beamdyn.scene.validity import refuse_vanishing_frequency

UNRESOLVED = 0.3  # relative error above which a comparison of two models gives no estimate
# Ratio of the difference between successive meshes to the previous difference: the smallest that is used, for
# an order of convergence above 2; the one assumed if it is unknown; the largest for which an error is
# estimated.
LEAST_RATIO, _UNKNOWN, _FALLING = 0.2, 0.5, 0.8
# Largest ratio of the numbers of unknowns of a mesh and of the next finer one for which the finer mesh counts
# as refined everywhere, so that their difference shows the order of convergence (1/2 if all elements are
# halved).
_HALVED = 0.7
_VANISHED = 1e-9  # squared frequency, over the lowest without a load at the tip, that is 0 within rounding
_OF_ENTRIES = 3 * np.finfo(float).eps  # three standard deviations of the rounding error of entries
# Ratio of the difference between the two coarser meshes to the smallest stated error, as the difference
# between the two finer ones may be small by chance.
_LEAST_OF_BEFORE = 64.0
# Largest ratio of the differences between successive meshes that a higher mode takes over from a lower one.
# It does so because a steep change of properties slows the convergence of both.
_SHARED = 0.75
# Ratio of the difference of two meshes to their rounding errors, below which it may be rounding alone.
_OF_NOISE = 4.0
# How the error of a mode follows from its distance to the coarser basis.  The first two numbers are the
# fractions of its own distance, and of the largest distance of all modes, that count as error; the third is
# the relative distance above which margins for slow convergence are added.  There are such numbers for a beam
# with one segment, for one with several (whose functions converge at different rates), and for irregular
# convergence.
REGULAR, _ON_SEGMENTS, _IRREGULAR = (1.0, 0.01, 1e-10), (3.0, 0.05, 1e-12), (2.0, 0.3, 1e-10)
# Number of functions across plates up to which the margin `BASES_OF_PLATES` was measured (with more
# functions, convergence slows down), and the fraction of the largest distance of all modes that counts as
# error.
_ACROSS_MEASURED, _OTHERS_OF_PLATES = 12, 0.01
# Fraction of the lowest squared frequency at rest above which a squared frequency's error is relative to
# itself.
_ABOVE = 0.99
_FEW = 1e-9  # relative difference of two bases above which one field may have too few functions


Parts: TypeAlias = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class EstimatedModes:
    """Modes for a batch of speeds, with estimated errors of their eigenvalues.

    Parameters
    ----------
    model : Model
        The model of the modes.
    eigen : Eigen
        Modes of `model`.
    error : ndarray, shape (speeds, modes)
        Estimated relative error of the eigenvalues: truncation and rounding error; inf where unresolved,
        where the coarser model has no such mode, and where it has no fewer functions than the model.
    """

    model: Model
    eigen: Eigen
    error: np.ndarray

    def meet(self, tolerance: float) -> bool:
        """Return whether each error is below the tolerance or at the level of rounding.

        A value that is 0 within rounding, as at the critical speed, has no relative error that more functions
        could reduce.
        """
        level = 3 * self.eigen.rounding[:, : self.error.shape[1]]
        return bool((self.error <= np.where(level < UNRESOLVED, np.maximum(tolerance, level), np.inf)).all())


def solve_with_error(model: Model, speeds: np.ndarray, modes: int, extra: int = 0) -> EstimatedModes:
    """Solve a model, and estimate the errors of its eigenvalues by comparison with the coarser model.

    Parameters
    ----------
    model : Model
        The model.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].
    modes : int
        Number of modes with an estimated error.
    extra : int
        Number of further modes, without an estimated error.

    Returns
    -------
    EstimatedModes

    Raises
    ------
    InvalidValue
        If the model has fewer functions than modes.
    """
    if model.solver.size < modes:  # functions of the basis "moments" may be linearly dependent
        bound = f"{model.discretization} has {model.solver.size} functions for this beam"
        raise InvalidValue("modes", modes, bound, "ask for fewer")
    scene, mount = model.scene, model.scene.mount
    fine = solve_over_speeds(model.solver, speeds, min(modes + extra, model.solver.size))
    if fine.eigenvalue.shape[1] < modes:  # beside the others, the mass of some modes is within rounding
        lowest = (np.abs(fine.eigenvalue) ** 2).min(initial=np.inf)
        if scene.tip_load.acts and lowest < _VANISHED * model.solver.lowest_at_rest:
            refuse_vanishing_frequency(scene)
        with explained():
            raise np.linalg.LinAlgError
    coarse = eigenvalues_over_speeds(model.coarse_solver, speeds, modes)
    compared = coarse.shape[1]  # the coarser basis may have fewer linearly independent functions
    s = fine.eigenvalue[:, :compared]
    squared, of_coarse = s**2, coarse**2
    distance = squared - of_coarse
    order = model.discretization.order
    if order is not None:  # Richardson extrapolation removes the leading term of the error
        # If one value is 0 within rounding, the distance counts as 0.
        within_rounding = (fine.eigenvalue[:, :compared] == 0) | (coarse == 0)
        squared = squared + np.where(within_rounding | np.isnan(coarse), 0.0, distance / (2**order - 1))
        extrapolated = np.concatenate([_root(squared, s), fine.eigenvalue[:, compared:]], axis=1)
        fine = Eigen(extrapolated, fine.vector, fine.rounding)
    with np.errstate(divide="ignore", invalid="ignore"):
        half, size = np.abs(distance) / 2, np.abs(squared)
        if order is not None:
            before = of_coarse - _coarsest_squares(model, speeds, compared)
            truncation = _mesh_error(model, fine, squared, distance, before)
            truncation = truncation + _error_across(model, speeds, s**2)
        else:
            truncation = _basis_error(model, fine, half, size)
        rounding = ROUNDING_OF_TWO.factor * fine.rounding[:, :compared] + model.discretization.rounding
        error = truncation + rounding
        resolved = (half / size < UNRESOLVED) & (error < UNRESOLVED)  # this is False for nan, too
    # A root without a spring may turn freely: at rest or, if it lies on the axis of rotation, at any speed.
    # A frequency within rounding of 0 is then taken as 0.
    if not s.all():
        free = 0.0 in mount.root_stiffnesses[: scene.physics.planes]
        neutral = (s == 0) & (free & ((speeds == 0) | (mount.radius == 0)))[:, None]
        resolved, error = resolved | neutral, np.where(neutral, 0.0, error)
    if not resolved.all():
        resolved &= ~_may_be_passed(squared, distance, resolved)
    resolved &= model.exceeds_coarser
    stated = np.full((len(speeds), modes), np.inf)
    stated[:, :compared] = np.where(resolved, error, np.inf)
    return EstimatedModes(model, fine, stated)


def _mesh_error(
    model: Model, fine: Eigen, squared: np.ndarray, distance: np.ndarray, before: np.ndarray
) -> np.ndarray:
    """Estimate relative truncation errors of extrapolated squared eigenvalues, by comparison of meshes."""
    compared = squared.shape[1]
    noise = (fine.rounding[:, :compared] + model.discretization.rounding) * np.abs(squared)
    shapes = fine.vector[:, :, :compared].swapaxes(1, 2)
    noise += rounding_of_entries(model.solver.pencil.K0, shapes, shapes)  # short elements have large entries
    least = LEAST_RATIO if len(model.scene.modelled_beam.breakpoints) == 2 else _UNKNOWN
    left = extrapolation_error(distance, before, noise, least)
    truncation = (left + noise) / (2 * np.abs(squared))
    # Elements usually resolve lower modes better, so no mode is given a smaller error than a lower mode.  A
    # squared frequency below the lowest one at rest has a large relative error only because it is small: its
    # error counts relative to the lowest one at rest.
    size = np.abs(squared) / model.solver.lowest_at_rest
    known = (size > 0) & np.isfinite(truncation)
    of_lower = np.where(known, truncation * np.minimum(size, 1.0), 0.0)
    return np.maximum(truncation, np.maximum.accumulate(of_lower, axis=1))


def rounding_of_entries(matrix: np.ndarray, left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Estimate the rounding error of left^T matrix right, from independent ones of the matrix's entries.

    `left` and `right` have the shape (..., n) for a matrix (n, n).
    """
    left, matrix, right = (np.abs(each) ** 2 for each in (left, matrix, right))
    return _OF_ENTRIES * np.sqrt((left * (right @ matrix.T)).sum(axis=-1))


def _error_across(model: Model, speeds: np.ndarray, squared: np.ndarray) -> np.ndarray | float:
    """Estimate the relative error due to the number of functions across a strip; 0 for other beams."""
    if not model.scene.models_width:
        return 0.0
    kept = np.ones(model.equations.size, dtype=bool)
    # The coordinates of the last function across the width are the last ones of a block.
    for name, functions in model.equations.sections:
        end = model.equations.blocks[name].stop
        kept[end - functions.of_each : end] = False
    fewer = solver_of(model.equations, np.flatnonzero(kept)).eigenvalues(speeds, squared.shape[1])
    return BASES_OF_PLATES.factor * np.abs(squared - fewer**2) / (2 * np.abs(squared))


def _basis_error(model: Model, fine: Eigen, half: np.ndarray, size: np.ndarray) -> np.ndarray:
    """Estimate the relative truncation error of a model by `_ritz_error`, with the model's parameters."""
    # The Rayleigh quotient of the first mode, with the matrices at rest, is an upper bound of the lowest
    # squared frequency at rest.
    stiffness, mass = model.solver.energies_at_rest(fine.vector[:, :, 0])
    bound = (stiffness / mass).min() + model.equations.shift
    # The error of a squared frequency below the lowest one at rest is relative to the latter.  The lowest one
    # at rest need not be computed unless a squared frequency below its bound has the largest relative
    # distance.
    if is_needed := size.min() < _ABOVE * bound:
        relative, below = half / size, size < bound
        of_below, of_others = (np.where(each, relative, 0.0).max(axis=1) for each in (below, ~below))
        is_needed = not (of_below <= of_others).all()
    lowest = np.asarray(model.solver.lowest_at_rest if is_needed else 0.0)
    is_slender = model.scene.is_slender_beam_in_one_plane
    margin = SLOW_BASES.factor if is_slender or model.lacks_two else BASES_OF_FIELDS.factor
    parts = parts_of_distances(model.scene, model.discretization)
    return _ritz_error(half, size, lowest, margin, parts)


def extrapolation_error(
    distance: np.ndarray, before: np.ndarray, noise: np.ndarray, least: float = LEAST_RATIO
) -> np.ndarray:
    """Estimate the error that remains after Richardson extrapolation, from differences of three meshes.

    Each mesh has twice the elements of the next.  If elements resolve the mode, each difference is a
    sixteenth of the previous one; if they are longer than a boundary layer or span a steep change, it
    decreases less.

    Parameters
    ----------
    distance, before : ndarray, shape (..., modes)
        Difference of the results of the two finest meshes, and of the second and third; nan if not known.
    noise : ndarray, shape (..., modes)
        Rounding error of the differences.
    least : float
        Smallest ratio of the two differences that is used; larger if segments converge at different rates.

    Returns
    -------
    ndarray, shape (..., modes)
        Estimated error; inf if the differences do not decrease.
    """
    size = np.abs(distance)
    ratio = np.maximum(np.nan_to_num(size / (np.abs(before) + noise), nan=_UNKNOWN), least)
    of_lower = np.where(size <= _OF_NOISE * noise, least, np.minimum(ratio, _SHARED))
    ratio = np.maximum(ratio, np.maximum.accumulate(of_lower, axis=-1))
    left = np.where(ratio < _FALLING, ratio / (1 - np.minimum(ratio, _FALLING)), np.inf)
    left = np.where(size <= _OF_NOISE * noise, size, size * np.where(size > 0, left, 0.0))
    return np.maximum(left, np.nan_to_num(np.abs(before)) / _LEAST_OF_BEFORE)


def is_halved(mesh: Eigensolver, finer: Eigensolver) -> bool:
    """Return whether a mesh is about half as fine as another; short segments, not refined, may prevent it."""
    return mesh.size <= _HALVED * finer.size


def _coarsest_squares(model: Model, speeds: np.ndarray, count: int) -> np.ndarray:
    """Compute squared eigenvalues (S, count) with a quarter of the elements; nan if that is not possible."""
    coarsest = model.coarser.coarser
    if not is_halved(coarsest.solver, model.coarser.solver):
        return np.full((len(speeds), count), np.nan)
    found = eigenvalues_over_speeds(coarsest.solver, speeds, min(count, coarsest.solver.size)) ** 2
    lacking = np.full((len(speeds), count - found.shape[1]), np.nan)
    return np.concatenate([found, lacking], axis=1)


def error_of_assumed_modes(
    squared: np.ndarray,
    distance: np.ndarray,
    rounding: np.ndarray,
    lowest_at_rest: np.ndarray,
    is_slender: bool = True,
    parts: Parts = REGULAR,
) -> np.ndarray:
    """Estimate errors of assumed modes without a hinge, as `solve_with_error` does.

    Parameters
    ----------
    squared : ndarray, shape (S, modes)
        Squares of the eigenvalues.
    distance : ndarray, shape (S, modes)
        Differences between the squares and those of the coarser basis.
    rounding : ndarray, shape (S, modes)
        Relative error of the eigenvalues by rounding.
    lowest_at_rest : ndarray, shape (S,)
        Lowest squared frequency at rest of each problem.
    is_slender : bool
        Whether the beams are slender and clamped, and bend in one plane.
    parts : tuple of float
        How the basis converges: see `parts_of_distances`.

    Returns
    -------
    ndarray, shape (S, modes)
        Estimated relative error; inf where unresolved.
    """
    margin = SLOW_BASES.factor if is_slender else BASES_OF_FIELDS.factor
    with np.errstate(divide="ignore", invalid="ignore"):
        half, size = np.abs(distance) / 2, np.abs(squared)
        error = _ritz_error(half, size, lowest_at_rest, margin, parts) + ROUNDING_OF_TWO.factor * rounding
        resolved = (half / size < UNRESOLVED) & (error < UNRESOLVED)
    if not resolved.all():
        resolved &= ~_may_be_passed(squared, distance, resolved)
    return np.where(resolved, error, np.inf)


def parts_of_distances(scene: Scene, discretization: Discretization) -> Parts:
    """Choose the three numbers by which distances between bases count as errors: see `REGULAR`."""
    if not discretization.converges_regularly:
        return _IRREGULAR
    if scene.models_width:
        across = discretization.spaces(scene.modelled_beam).across
        return BASES_OF_PLATES.factor * max(1.0, across / _ACROSS_MEASURED), _OTHERS_OF_PLATES, np.inf
    return REGULAR if len(scene.modelled_beam.breakpoints) == 2 else _ON_SEGMENTS


def _root(squared: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Compute the eigenvalues with the given squares that are nearest to s.

    The squares are smooth functions of speed and basis size, and real if the equations are conservative; the
    eigenvalues themselves change from imaginary to real where a square passes zero.
    """
    root = np.sqrt(squared)
    return np.where(np.real(root * s.conj()) < 0, -root, root)


def _may_be_passed(squared: np.ndarray, distance: np.ndarray, resolved: np.ndarray) -> np.ndarray:
    """Return for each mode and speed whether an unresolved higher mode may have a lower exact frequency."""
    reach = np.where(resolved, np.inf, -np.real(squared) - np.abs(distance))
    lowest = np.minimum.accumulate(reach[:, ::-1], axis=1)[:, ::-1]
    return -np.real(squared) > lowest


def _ritz_error(
    half: np.ndarray, size: np.ndarray, lowest: np.ndarray, of_few: float, parts: Parts
) -> np.ndarray:
    """Estimate the relative truncation error of Ritz eigenvalues from the squares of a smaller basis.

    Half of each distance, the sizes of the squares and the error have shape (speeds, modes); the lowest
    squared frequency at rest is one number, or one for each speed.  Usually further functions change an
    eigenvalue by less than the last ones did.  Exceptions are modes that only every other function changes,
    and modes whose distance is small by chance.  If convergence is slow, a mode's distance is therefore
    multiplied by a margin that was determined on random scenes, and its error is at least a tenth of the
    margin times the largest distance of any mode, relative to the larger square of the two modes.  The margin
    is `of_few` if one field may have too few functions.  If an eigenvalue vanishes, its error is relative to
    the lowest squared frequency at rest.
    """
    scale = np.maximum(np.maximum(size[:, :, None], size[:, None, :]), lowest[..., None, None])
    largest = (half[:, None, :] / scale).max(axis=2)
    relative = half / size
    margin = np.where(largest > _FEW, of_few, SLOW_BASES.factor)
    own, others, limit = parts
    is_slow = largest > limit
    of_largest = np.where(is_slow, margin / 10, others) * largest
    return np.maximum(np.where(is_slow, own * margin, own) * relative, of_largest)
