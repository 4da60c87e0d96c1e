"""Scenes in periodic motion, and their equations in modes at rest, of which many scenes share one set."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, count
from beamdyn.common.inputs.designs import Designs, VariedInput
from beamdyn.common.results.read_only import FieldsOnly
from beamdyn.equations.effects import LARGE_DEFLECTION
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice, choose_model
from beamdyn.modes.modal.modal_basis import find_speed_range
from beamdyn.modes.modal.model import Model
from beamdyn.modes.model_error.effect_choice import choose_physics
from beamdyn.scene.numbers import SPEED, with_numbers
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.studies.floquet.monodromy import Monodromy, monodromy
from beamdyn.studies.floquet.period import period_of

_STRAIGHT = "stability in periodic motion is that of the straight beam"


@dataclass(frozen=True)
class PeriodicScenes(FieldsOnly):
    """Scenes that differ in some numbers from one in periodic motion.

    Parameters
    ----------
    scene : Scene
        The scene.
    modes : int
        Number of modes at rest of each field.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.
    """

    scene: Scene
    modes: int
    discretization: DiscretizationChoice
    _models: dict[Any, tuple[Model, Equations]] = field(default_factory=dict, repr=False, compare=False)

    def at(self, values: Mapping[str, float]) -> Scene:
        """The scene with other numbers, and in motion at another speed if that is one of them."""
        scene = with_numbers(self.scene, values)
        if SPEED not in values or scene.motion is None:
            return scene
        return replace(scene, motion=scene.motion.with_speed(values[SPEED]))

    def monodromy(self, values: Mapping[str, float]) -> Monodromy:
        """The monodromy matrix of the scene with other numbers."""
        scene = self.at(values)
        period = period_of(scene)
        _, equations = self.modal(scene)
        return monodromy(scene, period, replace(equations, mount=scene.mount, gravity=scene.gravity))

    @property
    def size(self) -> int:
        """Number 2 n of entries of a state."""
        return 2 * self.modal(self.scene)[1].size

    def modal(self, scene: Scene) -> tuple[Model, Equations]:
        """Model and equations in modes at rest of a scene, or of one that differs in how its root moves."""
        still = replace(scene.mount, radius=0.0, setting_angle=0.0)
        key = scene.beam, still, scene.physics, scene.damping_ratio, scene.damping
        if key not in self._models:
            model = choose_model(scene, self.discretization, speeds_of(scene), self.modes)
            self._models[key] = model, model.modal_equations(self.modes)
        return self._models[key]


def speeds_of(scene: Scene) -> np.ndarray:
    """The slowest and the fastest speed of a periodic motion [rad/s]."""
    period = period_of(scene)
    assert scene.motion is not None
    return np.array(find_speed_range(scene.motion, period.time))


def check_periodic(
    scene: Scene, modes: int, discretization: DiscretizationChoice, inputs: Sequence[VariedInput] = ()
) -> PeriodicScenes:
    """Check the arguments of an analysis of stability in periodic motion, and choose the physics if "auto".

    Of scenes over some inputs it is that of the extreme one which needs the most effects.

    Raises
    ------
    InvalidValue
        If an argument is out of its range, the motion is not periodic, or large deflection is modelled.
    """
    check_scene(scene)
    modes = count("modes", modes)
    if scene.chooses_physics:
        extremes = Designs(inputs).extremes() if inputs else [{}]
        each = PeriodicScenes(scene, modes, discretization)
        chosen = [_choose_physics(each.at(numbers), modes) for numbers in extremes]
        most = max(chosen, key=_needs)
        scene = replace(scene, physics=most.physics, physics_choice=most.physics_choice)
    if scene.physics.large_deflection:
        raise InvalidValue("physics.large_deflection", True, _STRAIGHT, "leave it out")
    return PeriodicScenes(scene, modes, discretization)


def _needs(scene: Scene) -> tuple[int, float]:
    """Key that orders chosen physics: the number of effects included, then what is still left out."""
    choice = scene.physics_choice
    return (0, 0.0) if choice is None else (len(choice.included), choice.model_error)


def _choose_physics(scene: Scene, modes: int) -> Scene:
    return choose_physics(scene, speeds_of(scene), modes, barred={LARGE_DEFLECTION.name: _STRAIGHT})
