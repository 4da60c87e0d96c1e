"""Search for a critical speed with finer and finer models, each compared with one of half its size."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from itertools import chain

import numpy as np

from beamdyn.accuracy.refinement import BASES_OF_FIELDS, SLOW_BASES, refine
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice, list_models, split_tip
from beamdyn.modes.modal.equilibrium import find_loss_of_stability
from beamdyn.modes.modal.error_estimate import UNRESOLVED, extrapolation_error, is_halved
from beamdyn.modes.modal.model import Model
from beamdyn.scene.scene import Scene

# Number of modes for which the first basis is sized, so that a basis of half its size usually suffices, too.
_SIZED_FOR = 5
_NEAR_TIP = 0.5  # x/L beyond which the deflection is so large that rounding of short elements shows
# Rounding error times the cubed relative length of the shortest element.
_OF_SHORTEST = 4 * float(np.finfo(float).eps)
_ROUNDING_OF_BENT = 1e-10  # relative rounding error: the stiffness is a small sum of large terms
# Smallest error at which meshes of a bent beam aim: each mesh costs as much as all before.
_MESHES_OF_BENT = 1e-5
_TO_HALF = 4  # number of steps from a basis to one of about half its size


@dataclass(frozen=True)
class FoundSpeed:
    """Critical speed of a model [rad/s], its relative error, and the part of rounding in the error."""

    model: Model
    coarse: Model
    speed: float
    error: float
    rounding: float


def models_of_critical_speed(
    scene: Scene, discretization: DiscretizationChoice, target: float, cheapest: bool
) -> Iterator[Model]:
    """List the models in which a critical speed is sought; see `list_models`, of which the first is made now.

    So a beam with too many segments is refused, even if no model needs to be solved.
    """
    named = isinstance(discretization, str)
    modes, split = (_SIZED_FOR, split_tip(scene)) if named else (1, scene)
    models = list_models(split, discretization, modes, target, cheapest, split is not scene)
    return chain([next(models)], models)


def search_critical_speed(models: Iterator[Model], target: float) -> FoundSpeed:
    """Refine models until the error meets the target or rounding, or the models end."""

    def finer(found: FoundSpeed) -> FoundSpeed | None:
        # The factorization of a large basis may fail by rounding: the result before is then the best.
        with suppress(np.linalg.LinAlgError, StopIteration):
            return compare_critical_speeds(next(models))
        return None

    def meets(found: FoundSpeed) -> bool:
        return bool(np.isfinite(found.speed)) and found.error <= max(target, 3 * found.rounding)

    return refine(compare_critical_speeds(next(models)), finer, meets)


def compare_critical_speeds(model: Model) -> FoundSpeed:
    """Compute the critical speed of a model, with its error from a model of about half the size.

    A basis that lacks only a few functions would differ too little where convergence is slow: where the error
    falls as a power p >= 1 of the size, it is at most the distance from the basis of half the size.
    """
    discretization, solver = model.discretization, model.solver
    order, noise = discretization.order, discretization.rounding
    if order is None:
        for _ in range(_TO_HALF):
            discretization = discretization.coarser()
        coarse = Model(model.scene, discretization)
    else:
        coarse = model.coarser
        ends = discretization.cells(model.scene.modelled_beam).ends
        shortest = float(np.diff(ends)[ends[1:] > _NEAR_TIP].min())
        noise = max(noise, _OF_SHORTEST * shortest**-3)  # elements have a rounding error from their integrals
    fine_softening, coarse_softening = solver.softening, coarse.solver.softening
    distance = fine_softening - coarse_softening
    softening = fine_softening if order is None else fine_softening + distance / (2**order - 1)
    if not 0 < softening < np.inf:  # this is False for nan, too
        return FoundSpeed(model, coarse, np.inf, np.inf, np.inf)
    rounding = solver.critical_rounding
    noise, left = rounding + noise, abs(distance)
    if order is not None:  # short segments may keep a mesh from having half the elements of another
        half = coarse.coarser.solver
        before = coarse_softening - half.softening if is_halved(half, coarse.solver) else np.nan
        left = float(extrapolation_error(*np.array([[distance], [before], [noise * softening]]))[0])
    error = left / (2 * softening) + noise
    # A comparison with the same functions tells nothing.
    resolved = error < UNRESOLVED and coarse.solver.size < solver.size
    error = float(error) if resolved else np.inf
    return FoundSpeed(model, coarse, float(softening**-0.5), error, rounding)


# Beams that rotation bends --------------------------------------------------------------------------


def search_bent(models: Iterator[Model], target: float) -> tuple[FoundSpeed, bool]:
    """Refine the speed at which a beam that rotation bends loses stability; also return whether it does.

    Where it stays stable, the returned speed is the largest that was tried.
    """
    found, is_lost = compare_bent(next(models))
    if found.model.discretization.order is not None:
        target = max(target, _MESHES_OF_BENT)
    while is_lost and found.error > max(target, 3 * found.rounding) and (finer := next(models, None)):
        found, is_lost = compare_bent(finer)
    return found, is_lost


def compare_bent(model: Model) -> tuple[FoundSpeed, bool]:
    """Find the speed of loss of stability, its error by the coarser model, and whether it was found."""
    (squared, is_lost), (of_coarse, also) = (
        find_loss_of_stability(each.deflected.load) for each in (model, model.compared)
    )
    distance = abs(of_coarse - squared)
    error = _margin(model) * distance / (2 * squared) + _ROUNDING_OF_BENT if distance else _ROUNDING_OF_BENT
    error = error if is_lost and also else np.inf
    return FoundSpeed(model, model.compared, float(np.sqrt(squared)), error, _ROUNDING_OF_BENT), is_lost


def _margin(model: Model) -> float:
    """Choose the ratio of error to distance between two models; for meshes of half the elements, 1."""
    if model.discretization.order is not None:
        return 1.0
    return (SLOW_BASES if model.lacks_one else BASES_OF_FIELDS).factor
