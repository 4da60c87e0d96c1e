"""How many modes a linear model needs, and the error of what is computed with it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from beamdyn.accuracy.refinement import LINEAR_MESHES, LINEAR_MODES, refine
from beamdyn.common.inputs.checks import InvalidValue, count, real, within
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
from beamdyn.modes.modal.model import Model
from beamdyn.modes.model_error.effect_choice import NOTHING_BARRED, choose_physics
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.scene.validity import check_speeds

_MODES = 5  # modes by which physics and functions are chosen, where all functions are kept
_STRAIGHT = "linear models are those about the straight beam"
_OR_ALL = Named("or None, which keeps all functions", "or auto")


def check_linear(
    scene: Scene, speed: float, modes: int | None, barred: Mapping[str, str] = NOTHING_BARRED
) -> tuple[Scene, float]:
    """The scene with its physics chosen, without effects that are barred, and the speed [rad/s].

    Raises
    ------
    InvalidValue
        If the scene is none or has a large deflection, or the speed or the modes are out of range.
    """
    check_scene(scene)
    speed = real("speed", speed, "rad/s")
    check_speeds(speed, "speed")
    if modes is not None:
        count("modes", modes, remedy=_OR_ALL)
    scene = choose_physics(
        scene, [speed], modes or _MODES, barred={LARGE_DEFLECTION.name: _STRAIGHT} | dict(barred)
    )
    if scene.physics.large_deflection:
        remedy = "leave large_deflection out"
        raise InvalidValue("physics.large_deflection", True, _STRAIGHT, remedy)
    return scene, speed


def with_forces(scene: Scene, inputs: Sequence[Excitation]) -> Scene:
    """The scene with breakpoints of the beam where forces act within the span, and the shear force jumps."""
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
    """The linear equations of a scene in as many modes; functions are chosen for modes without damping.

    The tolerance is that of `natural_modes`.

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
    """Make the model of a few modes that nobody asked for: of fewer if the discretization has no more."""
    return model_at_speed(scene, speed, most_modes(scene, discretization, few), discretization, tolerance)


# How many modes are needed ------------------------------------------------------------------------


Evaluation = Callable[[ModelAtSpeed], np.ndarray]
# A value by a model, and by the one with twice as many modes, if there is one.
_Doubled: TypeAlias = tuple[ModelAtSpeed, np.ndarray, ModelAtSpeed | None, np.ndarray | None]

_FIRST = 4  # modes of the first basis of "auto"
_ACCURATE = 8  # modes for which its functions are chosen by default, at least
_MOST = 40  # most modes of the last refinement
_OF_FREQUENCIES = 0.01  # error of frequencies over that of a response, which a resonance magnifies
_DEFAULT = 1.001 * DEFAULT_TARGET  # target up to which models are the default ones: no last digit decides
_FINER = 1e-3  # of the target, where the response has not met its tolerance
_MASSLESS = 1e-12  # smallest eigenvalue of the mass, over the largest, that is told from 0
_ROUNDING = 1e-12  # rounding error, over the largest value


@dataclass(frozen=True)
class Refined:
    """A value with its error, of the model with enough modes.

    Parameters
    ----------
    model : ModelAtSpeed
        The model.
    larger : ModelAtSpeed or None
        The one with more modes, or all functions; None if the model has them all, or there is none.
    value, error : ndarray
        The value and its estimated error, of one shape.
    truncation : float
        Largest error by the modes left out.
    discretization : ndarray
        The part of the error that is of the discretization.
    method, compared_with : str
        The model, and those that the error was estimated by.
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
    """Evaluate with all functions where they are few, else with as many modes as the tolerance needs.

    Parameters
    ----------
    scene, speed, discretization
        As for `model_at_speed`.
    top : float
        Highest angular frequency at which the beam answers [rad/s], which the functions resolve.
    modes : int, "auto" or None
        Number of modes; "auto": all functions up to `most`, else the fewest modes with which the error meets
        the tolerance; None: all functions.
    tolerance : float
        Error aimed at by "auto", relative to the largest value.
    evaluate : callable
        The value by a model.
    most : int
        Number of functions up to which all are kept.
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
    """The model with functions for modes up to an angular frequency [rad/s], to a target, within limits."""
    tolerance = target if target > _DEFAULT else None

    def of_modes(modes: int) -> tuple[int, ModelAtSpeed]:
        return modes, model_of_few_modes(scene, speed, modes, discretization, tolerance)

    def of_more(found: tuple[int, ModelAtSpeed]) -> tuple[int, ModelAtSpeed] | None:
        largest = not isinstance(discretization, str) or found[0] >= _MOST
        return None if largest else of_modes(min(_MOST, 2 * found[0]))

    first = of_modes(_ACCURATE if tolerance is None else _FIRST)
    return refine(first, of_more, lambda found: np.sqrt(np.abs(found[1].K).max()) > top)[1]


def evaluate_also(refined: Refined, evaluate: Evaluation) -> Refined:
    """Another value by the models of one that is refined, with its error."""
    return _with_error(refined.model, evaluate(refined.model), refined.larger, evaluate)


def _all_of(model: ModelAtSpeed, most: int) -> ModelAtSpeed | None:
    """The model with all functions, unless they are many or some have no mass of their own."""
    whole = replace(model, modes=None)
    if whole.equations.size > most:
        return None
    return whole if _count_with_mass(whole.M) == len(whole.M) else None


def _count_with_mass(M: np.ndarray) -> int:
    """How many modes a mass matrix has: coordinates without mass, as of shear alone, add none."""
    values = np.linalg.eigvalsh(M)
    return int((values > _MASSLESS * values[-1]).sum())


def _add_modes(
    model: ModelAtSpeed, tolerance: float, discretization: DiscretizationChoice, evaluate: Evaluation
) -> Refined:
    """Add modes until the error meets the tolerance."""

    def doubled(model: ModelAtSpeed, value: np.ndarray) -> _Doubled:
        larger = _larger(model, discretization)
        return model, value, larger, None if larger is None else evaluate(larger)

    def of_more(found: _Doubled) -> _Doubled | None:
        _, _, larger, finer = found
        if larger is None or finer is None or (larger.modes or 0) >= _MOST:
            return None
        return doubled(larger, finer)

    def settles(found: _Doubled) -> bool:
        """Whether more modes change the value by at most a share of the largest."""
        _, value, _, finer = found
        share = tolerance / LINEAR_MODES.factor
        return finer is not None and bool(np.abs(finer - value).max() <= share * np.abs(finer).max())

    model, value, larger, finer = refine(doubled(model, evaluate(model)), of_more, settles)
    return _with_error(model, value, larger, evaluate, finer)


def _larger(model: ModelAtSpeed, discretization: DiscretizationChoice) -> ModelAtSpeed | None:
    """The model with twice as many modes; None if the discretization has too few."""
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
    """The value, with its distance from that of more modes and of a coarser discretization."""
    coarse = ModelAtSpeed(model.model.coarser, model.speed, model.modes)
    rounding = _ROUNDING * np.abs(
        value
    ).max() + LINEAR_MESHES.factor * model.discretization.rounding * np.abs(value)
    error = LINEAR_MESHES.factor * np.abs(evaluate(coarse) - value) + rounding
    truncation, compared = np.zeros(()), [str(coarse.discretization)]
    if model.modes is not None and larger is None:
        truncation, compared = np.asarray(np.inf), [*compared, "no larger model"]
    elif larger is not None:
        finer = evaluate(larger) if finer is None else finer
        more = "all functions" if larger.modes is None else f"{larger.modes} modes"
        truncation, compared = LINEAR_MODES.factor * np.abs(finer - value), [*compared, more]
    kept = ("all functions",) if model.modes is None else (f"{model.modes} modes at ", Speeds(model.speed))
    method = Words(f"{model.discretization}, ", *kept)
    largest = float(np.max(truncation))
    return Refined(model, larger, value, error + truncation, largest, error, method, ", ".join(compared))
