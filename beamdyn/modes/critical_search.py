"""Search for a critical speed with finer and finer models, each compared with a model of half its size."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from itertools import chain

import numpy as np

from beamdyn.accuracy.refinement import BASES_OF_FIELDS, BASES_OF_PLATES, SLOW_BASES, refine
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice, list_models, split_tip
from beamdyn.modes.modal.distance_across import distance_across
from beamdyn.modes.modal.equilibrium import StabilityLoss
from beamdyn.modes.modal.error_estimate import UNRESOLVED, extrapolation_error, is_halved
from beamdyn.modes.modal.model import Model
from beamdyn.scene.scene import Scene

# Number of modes for which the first basis is chosen, so that a basis of half its size usually suffices too.
_SIZED_FOR = 5
# x/L above which deflections are so large that rounding errors of short elements become visible.
_NEAR_TIP = 0.5
# Relative rounding error of a critical speed, times the cube of the shortest element's length x/L.
_OF_SHORTEST = 4 * float(np.finfo(float).eps)
# Relative rounding error of the speed at which a bent beam loses stability: its stiffness is a small sum of
# large terms.
_ROUNDING_OF_BENT = 1e-10
_TARGET_OF_BENT = 1e-5  # smallest error target of a bent beam: each model costs as much as all coarser ones
_TO_HALF = 4  # number of times that a basis is made coarser to get one of about half its size


@dataclass(frozen=True)
class FoundSpeed:
    """Critical speed found with a model, and its relative error from comparison with a coarser model.

    `speed` is in rad/s, `coarse` is the coarser model, and `rounding` the part of the error due to rounding.
    """

    model: Model
    coarse: Model
    speed: float
    error: float
    rounding: float


def models_of_critical_speed(
    scene: Scene, discretization: DiscretizationChoice, target: float, cheapest: bool
) -> Iterator[Model]:
    """Iterate over the models for the search of a critical speed, from coarse to fine: see `list_models`.

    The first model is built at once, so that a beam with too many segments is refused even if no model needs
    to be solved.  The models are chosen for the error `target`; if `cheapest`, they start with the smallest.
    """
    named = isinstance(discretization, str)
    modes, split = (_SIZED_FOR, split_tip(scene)) if named else (1, scene)
    models = list_models(split, discretization, modes, target, cheapest, split is not scene)
    return chain([next(models)], models)


def search_critical_speed(models: Iterator[Model], target: float) -> FoundSpeed:
    """Refine models until the error meets the target or the rounding error, or no finer model is left."""

    def finer(found: FoundSpeed) -> FoundSpeed | None:
        # Rounding may make the factorization of a large basis fail: the previous result is then the best.
        with suppress(np.linalg.LinAlgError, StopIteration):
            return compare_critical_speeds(next(models))
        return None

    def meets(found: FoundSpeed) -> bool:
        return bool(np.isfinite(found.speed)) and found.error <= max(target, 3 * found.rounding)

    return refine(compare_critical_speeds(next(models)), finer, meets)


def compare_critical_speeds(model: Model) -> FoundSpeed:
    """Compute the critical speed of a model, and its error from a model of about half the size.

    With slow convergence, the difference from the result of a basis with only a few functions less would be
    too small.  If the error is proportional to size^-p with p >= 1, it is at most the difference from the
    result of the basis of half the size.
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
        # Rounding errors of the integrals over the shortest element.
        noise = max(noise, _OF_SHORTEST * shortest**-3)
    fine_softening, coarse_softening = solver.softening, coarse.solver.softening
    distance = fine_softening - coarse_softening
    softening = fine_softening if order is None else fine_softening + distance / (2**order - 1)
    if not 0 < softening < np.inf:  # this is true for nan, too
        return FoundSpeed(model, coarse, np.inf, np.inf, np.inf)
    rounding = solver.critical_rounding
    noise, left = rounding + noise, abs(distance)
    if order is not None:  # extrapolation needs halved meshes, which short segments may prevent
        half = coarse.coarser.solver
        before = coarse_softening - half.softening if is_halved(half, coarse.solver) else np.nan
        left = float(extrapolation_error(*np.array([[distance], [before], [noise * softening]]))[0])
        across = distance_across(
            model, lambda fewer: np.array(fewer.solver.softening), np.array(fine_softening)
        )
        left += BASES_OF_PLATES.factor * float(across)
    error = left / (2 * softening) + noise
    # A comparison of models with the same functions does not show an error.
    resolved = error < UNRESOLVED and coarse.solver.size < solver.size
    error = float(error) if resolved else np.inf
    return FoundSpeed(model, coarse, float(softening**-0.5), error, rounding)


# Beams that rotation bends at every speed -----------------------------------------------------------


@dataclass(frozen=True)
class FoundLoss(FoundSpeed):
    """Speed at which a bent beam loses stability, with its error.

    If the beam stays stable, `speed` is the largest one that was tried; `loss` its last stable equilibrium.
    """

    loss: StabilityLoss


def search_bent(models: Iterator[Model], target: float) -> FoundLoss:
    """Refine the speed at which a beam that rotation bends loses stability, or up to which it is stable.

    If it stays stable, the error is 0 if two models in turn show this, else inf.
    """

    def finer(before: FoundLoss) -> FoundLoss | None:
        model = next(models, None)
        found = before if model is None else compare_bent(model, before)
        # If two models in turn cannot be followed, no finer one is tried.
        return None if model is None or found.loss.is_lost is before.loss.is_lost is None else found

    def meets(found: FoundLoss) -> bool:
        return found.error <= max(target, _TARGET_OF_BENT)

    return refine(compare_bent(next(models)), finer, meets)


def compare_bent(model: Model, before: FoundLoss | None = None) -> FoundLoss:
    """Find the speed at which a bent beam loses stability, and its error from a coarser model.

    The coarser model is that of the result `before`.  Without it, a slightly coarser model is solved; that
    neither loses stability then claims nothing, since both may be too coarse.
    """
    loss = model.deflected.find_loss_of_stability()
    coarse = model.compared if before is None else before.model
    of_coarse = coarse.deflected.find_loss_of_stability() if before is None else before.loss
    error = np.inf
    distance = abs(of_coarse.squared - loss.squared)
    # If the load at the tip buckles one model at rest, the relative error of speed 0 is not known.
    if loss.is_lost and of_coarse.is_lost and (loss.squared or not distance):
        error = _ROUNDING_OF_BENT + (distance and _margin(model) * distance / (2 * loss.squared))
    elif before is not None and loss.is_lost is of_coarse.is_lost is False:
        error = 0.0
    return FoundLoss(model, coarse, math.sqrt(loss.squared), error, _ROUNDING_OF_BENT, loss)


def _margin(model: Model) -> float:
    """Return the ratio of the error of a bent beam's speed to the difference from the coarser model.

    It is 1 for finite elements, of which the coarser model has half as many.
    """
    if model.discretization.order is not None:
        return 1.0
    return (SLOW_BASES if model.lacks_two else BASES_OF_FIELDS).factor
