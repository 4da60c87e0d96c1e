"""Convergence of linear models: the number of modes they need, and the errors of their results."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from beamdyn.accuracy.refinement import BASES_OF_PLATES, LINEAR_MESHES, LINEAR_MODES, refine
from beamdyn.common.inputs.checks import InvalidValue, count, real, within
from beamdyn.common.results.one_line import counted
from beamdyn.common.results.statements import Speeds
from beamdyn.common.words import Named, Words
from beamdyn.equations.effects import LARGE_DEFLECTION
from beamdyn.linear.inputs_outputs import Excitation
from beamdyn.linear.model_at_speed import ModelAtSpeed
from beamdyn.modes.modal.discretization_choice import (
    DEFAULT_TARGET,
    DiscretizationChoice,
    check_discretization,
    model_to_tolerance,
    most_modes,
)
from beamdyn.modes.modal.distance_across import distance_across
from beamdyn.modes.modal.model import Model
from beamdyn.modes.model_error.effect_choice import NOTHING_BARRED, choose_physics
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.scene.validity import check_speeds, refuse_large_deflection

_MODES = 5  # number of modes for which physics and trial functions are chosen, if all functions are kept
_STRAIGHT = "linear models describe small motions about the straight beam"
_OR_ALL = Named("or None, which keeps all functions", "or auto")


def check_linear(
    scene: Scene, speed: float, modes: int | None, barred: Mapping[str, str] = NOTHING_BARRED
) -> tuple[Scene, float]:
    """Check arguments of a linear analysis; return the scene with its physics chosen, and the speed [rad/s].

    `barred` names further effects that the choice of physics must not add, each with the reason.

    Raises
    ------
    InvalidValue
        If `scene` is not a scene, it has large deflection, or speed or modes are out of range.
    """
    check_scene(scene)
    speed = real("speed", speed, "rad/s")
    check_speeds(speed, "speed")
    if modes is not None:
        count("modes", modes, remedy=_OR_ALL)
    refuse_large_deflection(scene, _STRAIGHT)
    scene = choose_physics(
        scene, [speed], modes or _MODES, barred={LARGE_DEFLECTION.name: _STRAIGHT} | dict(barred)
    )
    return scene, speed


def with_forces(scene: Scene, inputs: Sequence[Excitation]) -> Scene:
    """Add breakpoints to the beam where point forces act within the span: the shear force jumps there."""
    found = [force[0] for each in inputs if (force := each.force(scene.beam)) is not None and force[0] < 1]
    if not found:
        return scene
    xi = np.unique(found)
    mass = scene.beam.mass_per_length.stepped(xi, np.zeros(len(xi)))
    return replace(scene, beam=replace(scene.beam, mass_per_length=mass))


def model_at_speed(
    scene: Scene,
    speed: float,
    modes: int | None,
    discretization: DiscretizationChoice,
    tolerance: float | None = None,
) -> ModelAtSpeed:
    """Build the linear model of a scene with a number of modes.

    Trial functions are chosen to resolve the modes of the undamped beam.  For the tolerance see
    `natural_modes`.

    Raises
    ------
    InvalidValue
        If a discretization that is given has too few functions for the modes.
    """
    if modes is None and not isinstance(discretization, str):
        check_discretization(discretization)
        return ModelAtSpeed(Model(scene, discretization), speed, None)
    speeds = np.array([speed])
    chosen = model_to_tolerance(scene.undamped, discretization, speeds, modes or _MODES, tolerance)
    return ModelAtSpeed(chosen.of(scene), speed, modes)


def model_of_few_modes(
    scene: Scene, speed: float, few: int, discretization: DiscretizationChoice, tolerance: float | None = None
) -> ModelAtSpeed:
    """Build the linear model with `few` modes, or fewer if a given `Discretization` cannot compute these."""
    return model_at_speed(scene, speed, most_modes(scene, discretization, few), discretization, tolerance)


# Number of modes needed --------------------------------------------------------------------------


Evaluation = Callable[[ModelAtSpeed], np.ndarray]
# A model, its value, the model with twice as many modes (None if there is none), and that model's value.
_Doubled: TypeAlias = tuple[ModelAtSpeed, np.ndarray, ModelAtSpeed | None, np.ndarray | None]

# Smallest number of modes for modes="auto"; at a loose tolerance, trial functions are first chosen for this
# number of modes.
_FIRST = 4
_ACCURATE = 8  # number of modes for which trial functions are first chosen at the default tolerance
_MOST = 40  # number of modes beyond which a model is not refined further
# Allowed error of natural frequencies, divided by that of a response: resonance magnifies errors of
# frequency.
_OF_FREQUENCIES = 0.01
# Tolerance at and below which the default models are used, with a margin for rounding.
_DEFAULT = 1.001 * DEFAULT_TARGET
# Trial functions are chosen to meet a tolerance of the natural frequencies.  That tolerance is multiplied by
# this factor each time that the error of a response exceeds its own tolerance.
_FINER = 1e-3
_MASSLESS = 1e-12  # smallest nonzero eigenvalue of the mass matrix, relative to the largest
_ROUNDING = 1e-12  # rounding error of a value relative to the largest value


@dataclass(frozen=True)
class Refined:
    """A value with its error, and the linear model from which the value was computed.

    Parameters
    ----------
    model : ModelAtSpeed
        The model.
    larger : ModelAtSpeed or None
        Model with more modes, or with all trial functions; None if `model` has all trial functions, or no
        larger model can be built.
    value, error : ndarray
        The value and its estimated error, of one shape.
    truncation : float
        Largest error due to the modes left out.
    discretization : ndarray
        Part of the error due to the discretization.
    method, compared_with : str
        Names of the model, and of the models with which it was compared to estimate the error.
    """

    model: ModelAtSpeed
    larger: ModelAtSpeed | None
    value: np.ndarray
    error: np.ndarray
    truncation: float
    discretization: np.ndarray
    method: str
    compared_with: str


def evaluate_accurately(
    scene: Scene,
    speed: float,
    top: float,
    modes: int | str | None,
    tolerance: float,
    discretization: DiscretizationChoice,
    evaluate: Evaluation,
    most: int,
) -> Refined:
    """Compute a value with all trial functions if these are few, else with as few modes as the error allows.

    Parameters
    ----------
    scene, speed, discretization
        As for `model_at_speed`.
    top : float
        Highest angular frequency at which the beam responds [rad/s]; trial functions resolve modes up to it.
    modes : int, "auto" or None
        Number of modes; "auto": all trial functions if at most `most`, else the fewest modes with which the
        error meets the tolerance; None: all trial functions.
    tolerance : float
        Target of the error for "auto", relative to the largest value.
    evaluate : callable
        Function that computes the value from a model.
    most : int
        Number of trial functions up to which all are kept.
    """
    tolerance = within("tolerance", tolerance, 1e-14, 0.1)
    if modes is None:
        model = model_at_speed(scene, speed, None, discretization)
        return _with_error(model, evaluate(model), None, evaluate)
    if not (isinstance(modes, str) and modes == "auto"):
        size = count("modes", modes, remedy=Words('or "auto", ', _OR_ALL))
        model = model_at_speed(scene, speed, size, discretization)
        larger = _all_of(model, most) or _larger(model, discretization)
        return _with_error(model, evaluate(model), larger, evaluate)

    def of_target(target: float) -> tuple[float, Refined]:
        model = _model_up_to(scene, speed, top, discretization, target)
        if (whole := _all_of(model, most)) is not None:
            return target, _with_error(whole, evaluate(whole), None, evaluate)
        few = replace(model, modes=min(_FIRST, model.modes or _FIRST))
        return target, _add_modes(few, tolerance, discretization, evaluate)

    def of_smaller_target(found: tuple[float, Refined]) -> tuple[float, Refined] | None:
        smallest = not isinstance(discretization, str) or found[0] <= _DEFAULT
        return None if smallest else of_target(_FINER * found[0])

    def meets(found: tuple[float, Refined]) -> bool:
        return bool(found[1].discretization.max() <= tolerance * np.abs(found[1].value).max())

    return refine(of_target(_OF_FREQUENCIES * tolerance), of_smaller_target, meets)[1]


def _model_up_to(
    scene: Scene, speed: float, top: float, discretization: DiscretizationChoice, target: float
) -> ModelAtSpeed:
    """Build a model that resolves the modes up to the angular frequency `top` [rad/s], but at most `_MOST`.

    A discretization given as an object is not refined for this.  Trial functions are chosen for relative
    errors of the natural frequencies up to `target`.
    """
    tolerance = target if target > _DEFAULT else None

    def of_modes(modes: int) -> tuple[int, ModelAtSpeed]:
        return modes, model_of_few_modes(scene, speed, modes, discretization, tolerance)

    def of_more(found: tuple[int, ModelAtSpeed]) -> tuple[int, ModelAtSpeed] | None:
        largest = not isinstance(discretization, str) or found[0] >= _MOST
        return None if largest else of_modes(min(_MOST, 2 * found[0]))

    first = of_modes(_ACCURATE if tolerance is None else _FIRST)
    return refine(first, of_more, lambda found: np.sqrt(np.abs(found[1].K).max()) > top)[1]


def evaluate_also(refined: Refined, evaluate: Evaluation) -> Refined:
    """Compute another quantity and its error from the models of a `Refined` value."""
    return _with_error(refined.model, evaluate(refined.model), refined.larger, evaluate)


def _all_of(model: ModelAtSpeed, most: int) -> ModelAtSpeed | None:
    """Build the model with all its trial functions, without reduction to modes.

    Return None if there are more than `most`, or some have no mass.
    """
    whole = replace(model, modes=None)
    if whole.equations.size > most:
        return None
    return whole if _count_with_mass(whole.M) == len(whole.M) else None


def _count_with_mass(M: np.ndarray) -> int:
    """Count the modes that have mass: massless coordinates, such as pure shear, add none."""
    values = np.linalg.eigvalsh(M)
    return int((values > _MASSLESS * values[-1]).sum())


def _add_modes(
    model: ModelAtSpeed, tolerance: float, discretization: DiscretizationChoice, evaluate: Evaluation
) -> Refined:
    """Double the number of modes until the error of a value meets the tolerance."""

    def doubled(model: ModelAtSpeed, value: np.ndarray) -> _Doubled:
        larger = _larger(model, discretization)
        return model, value, larger, None if larger is None else evaluate(larger)

    def of_more(found: _Doubled) -> _Doubled | None:
        _, _, larger, finer = found
        if larger is None or finer is None or (larger.modes or 0) >= _MOST:
            return None
        return doubled(larger, finer)

    def settles(found: _Doubled) -> bool:
        """Return whether twice as many modes change the value by less than the tolerance allows.

        The tolerance is divided by a margin, and is relative to the largest value.
        """
        _, value, _, finer = found
        share = tolerance / LINEAR_MODES.factor
        return finer is not None and bool(np.abs(finer - value).max() <= share * np.abs(finer).max())

    model, value, larger, finer = refine(doubled(model, evaluate(model)), of_more, settles)
    return _with_error(model, value, larger, evaluate, finer)


def _larger(model: ModelAtSpeed, discretization: DiscretizationChoice) -> ModelAtSpeed | None:
    """Build the model with twice as many modes; None if the discretization has too few trial functions."""
    assert model.modes is not None
    modes, coarser = 2 * model.modes, model.model.coarser.equations
    masses = (coarser.steady().part(coarser.places(names)).M for names in coarser.coupled)
    if all(_count_with_mass(mass) >= modes for mass in masses):
        return replace(model, modes=modes)
    if not isinstance(discretization, str):
        return None
    try:
        return model_at_speed(model.scene, model.speed, modes, discretization)
    except InvalidValue:
        return None


def _with_error(
    model: ModelAtSpeed,
    value: np.ndarray,
    larger: ModelAtSpeed | None,
    evaluate: Evaluation,
    finer: np.ndarray | None = None,
) -> Refined:
    """Estimate the error of a value from models with more modes and of a coarser discretization.

    `finer` is the value of the `larger` model; it is computed if not given.
    """
    coarse = ModelAtSpeed(model.model.coarser, model.speed, model.modes)
    rounding = _ROUNDING * np.abs(
        value
    ).max() + LINEAR_MESHES.factor * model.discretization.rounding * np.abs(value)
    error = LINEAR_MESHES.factor * np.abs(evaluate(coarse) - value) + rounding
    # The coarser mesh or basis may have as many functions across the width, so that these need a comparison
    # too.
    across = distance_across(
        model.model, lambda fewer: evaluate(ModelAtSpeed(fewer, model.speed, model.modes)), value
    )
    error = error + BASES_OF_PLATES.factor * across
    truncation, compared = np.zeros(()), [str(coarse.discretization)]
    if model.modes is not None and larger is None:
        truncation, compared = np.asarray(np.inf), [*compared, "no larger model"]
    elif larger is not None:
        finer = evaluate(larger) if finer is None else finer
        more = "all functions" if larger.modes is None else counted(larger.modes, "mode")
        truncation, compared = LINEAR_MODES.factor * np.abs(finer - value), [*compared, more]
    modes = model.modes
    kept = ("all functions",) if modes is None else (counted(modes, "mode"), " at ", Speeds(model.speed))
    method = Words(f"{model.discretization}, ", *kept)
    largest = float(np.max(truncation))
    return Refined(model, larger, value, error + truncation, largest, error, method, ", ".join(compared))
