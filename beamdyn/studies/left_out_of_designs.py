"""What the effects left out would change in the answers of designs, from the analysis of each."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from beamdyn.common.announced import unannounced
from beamdyn.model_error.left_out_effects import LeftOutEffects
from beamdyn.scene.numbers import SPEED
from beamdyn.scene.scene import Scene
from beamdyn.spectrum.critical import critical_point
from beamdyn.spectrum.modes import natural_modes
from beamdyn.steady.resonance import resonance_speeds
from beamdyn.steady.response import steady_response
from beamdyn.studies.crossings import crossing_key
from beamdyn.studies.questions import OF_RESPONSES, StudyQuestion
from beamdyn.transient.sweep import sweep


def left_out_of_design(
    question: StudyQuestion, scene: Scene, design: Mapping[str, float]
) -> LeftOutEffects | None:
    """What the effects left out would change in the answer of a design.

    Parameters
    ----------
    question : StudyQuestion
        What is asked.
    scene : Scene
        The scene of the design.
    design : mapping of str to float
        Its inputs.

    Returns
    -------
    LeftOutEffects or None
        Relative changes (m,) of its m numbers; None if it has no answer.
    """
    speed = design.get(SPEED, question.speed)
    try:
        with unannounced():  # the study has warned
            return _EFFECTS[question.what](question, scene, speed)
    except (ValueError, ArithmeticError):
        return None


def _of_frequencies(question: StudyQuestion, scene: Scene, speed: float) -> LeftOutEffects:
    how = question.discretization, question.tolerance
    return natural_modes(scene, speed, question.modes, *how).left_out_effects


def _of_critical_speed(question: StudyQuestion, scene: Scene, speed: float) -> LeftOutEffects:
    found = critical_point(scene, question.discretization, question.tolerance)
    return found.left_out_effects.at(np.newaxis)


def _of_crossings(question: StudyQuestion, scene: Scene, top: float) -> LeftOutEffects:
    """Those of the lowest crossing of each mode with each line."""
    found = resonance_speeds(scene, top, question.modes, discretization=question.discretization)
    keys = [crossing_key(each) for each in found]
    effects, places = found.left_out_effects, [_index(keys, each.key) for each in question.resonances]

    def sorted_by(change: np.ndarray) -> np.ndarray:
        return np.array([np.nan if i is None else change[i] for i in places])

    changes = {name: sorted_by(change) for name, change in effects.changes.items()}
    return replace(effects, changes=changes, shape=(len(places),))


def _index(keys: Sequence[Any], key: Any) -> int | None:
    return keys.index(key) if key in keys else None


def _of_responses(analysis: Callable[..., Any], question: StudyQuestion, scene: Scene, speed: float) -> Any:
    options: dict[str, Any] = {"tolerance": question.tolerance or OF_RESPONSES}
    if analysis is sweep:
        options["window"] = question.window
    found = analysis(scene, [speed], discretization=question.discretization, **options)
    return found.left_out_effects


_EFFECTS: dict[str, Callable[[StudyQuestion, Scene, float], LeftOutEffects]] = {
    "frequencies": _of_frequencies,
    "critical_speed": _of_critical_speed,
    "crossings": _of_crossings,
    "amplitude": partial(_of_responses, steady_response),
    "peak": partial(_of_responses, sweep),
}


def join_effects(each: Sequence[LeftOutEffects | None], numbers: int) -> LeftOutEffects:
    """The effects of p designs with m numbers each as one, of shape (p, m); nan where one has none."""
    known = [effects for effects in each if effects is not None]
    names = dict.fromkeys(name for effects in known for name in effects.changes)
    nothing = np.full(numbers, np.nan)

    def of(effects: LeftOutEffects | None, name: str) -> np.ndarray:
        if effects is None:
            return nothing
        return np.broadcast_to(effects.changes.get(name, 0.0), (numbers,))

    return LeftOutEffects(
        changes={name: np.array([of(effects, name) for effects in each]) for name in names},
        not_known={name: why for effects in reversed(known) for name, why in effects.not_known.items()},
        assumed={name: why for effects in known for name, why in effects.assumed.items()},
        not_modelled=known[0].not_modelled if known else (),
        reasons={name: why for effects in known for name, why in effects.reasons.items()},
        shape=(len(each), numbers),
    )
