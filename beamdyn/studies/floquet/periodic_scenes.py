"""Scenes in periodic motion, and their equations in modes at rest, which scenes share if possible."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from beamdyn.common.inputs.checks import count
from beamdyn.common.inputs.described import Designs, VariedInput
from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.equations.effects import LARGE_DEFLECTION
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice, choose_model
from beamdyn.modes.modal.model import Model, find_speed_range
from beamdyn.modes.model_error.effect_choice import choose_physics
from beamdyn.scene.numbers import SPEED, with_numbers
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.scene.validity import refuse_large_deflection
from beamdyn.studies.floquet.monodromy import (
    MOST_TURNS,
    Monodromy,
    meet_again,
    monodromy,
    period_of,
    rates_of,
)

_STRAIGHT = "stability in periodic motion is computed only for the straight beam"


@dataclass(frozen=True)
class PeriodicScenes(FieldsOnly):
    """Scenes in periodic motion that differ from a given scene in some of its numbers.

    Parameters
    ----------
    scene : Scene
        The scene.
    modes : int
        Number of modes at rest of each uncoupled displacement, such as bending in each plane.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.
    """

    scene: Scene
    modes: int
    discretization: DiscretizationChoice
    _models: dict[Any, tuple[Model, Equations]] = field(default_factory=dict, repr=False, compare=False)

    def at(self, values: Mapping[str, float]) -> Scene:
        """Return the scene with other values of the numbers; a new speed also changes the motion."""
        scene = with_numbers(self.scene, values)
        if SPEED not in values or scene.motion is None:
            return scene
        return replace(scene, motion=scene.motion.with_speed(values[SPEED]))

    def monodromy(self, values: Mapping[str, float]) -> Monodromy:
        """Integrate the monodromy matrix of the scene with other values of the numbers."""
        scene = self.at(values)
        return monodromy(scene, period_of(scene), self.equations(scene))

    def equations(self, scene: Scene) -> Equations:
        """Return the equations of a scene in modes at rest."""
        return replace(self.modal(scene)[1], mount=scene.mount, gravity=scene.gravity)

    @property
    def size(self) -> int:
        """Number of entries of a state: modal displacements and velocities, and the voltage of a circuit."""
        equations = self.modal(self.scene)[1]
        return 2 * equations.size - (equations.voltage is not None)

    def modal(self, scene: Scene) -> tuple[Model, Equations]:
        """Return model and equations in modes at rest.

        Scenes that differ only in the motion of the root share them.
        """
        still = replace(scene.mount, radius=0.0, setting_angle=0.0, precone=0.0)
        key = scene.beam, still, scene.mount.precone, scene.physics, scene.damping_ratio, scene.damping
        if key not in self._models:
            model = choose_model(scene, self.discretization, speeds_of(scene), self.modes)
            self._models[key] = model, model.modal_equations(self.modes)
        return self._models[key]


def speeds_of(scene: Scene) -> np.ndarray:
    """Return the slowest and the fastest speed of a scene's periodic motion [rad/s]."""
    period = period_of(scene).time if meet_again(scene) else 2 * np.pi / rates_of(scene)[0] * MOST_TURNS
    assert scene.motion is not None
    return np.array(find_speed_range(scene.motion, period))


def check_periodic(
    scene: Scene, modes: int, discretization: DiscretizationChoice, inputs: Sequence[VariedInput] = ()
) -> PeriodicScenes:
    """Check the arguments of a stability analysis in periodic motion, and choose the physics if "auto".

    If inputs are varied, the physics is that of the extreme scene that needs the most effects.

    Raises
    ------
    InvalidValue
        If an argument is out of its range, the motion is not periodic, or large deflection is modelled.
    """
    check_scene(scene)
    refuse_large_deflection(scene, _STRAIGHT)
    modes = count("modes", modes)
    if scene.chooses_physics:
        extremes = Designs(inputs).extremes() if inputs else [{}]
        each = PeriodicScenes(scene, modes, discretization)
        most = max([_choose_physics(each.at(numbers), modes) for numbers in extremes], key=_needs)
        scene = replace(scene, physics=most.physics, physics_choice=most.physics_choice)
    return PeriodicScenes(scene, modes, discretization)


def _needs(scene: Scene) -> tuple[int, float]:
    """Return a sort key for choices of physics: number of effects, then model error."""
    choice = scene.physics_choice
    return (0, 0.0) if choice is None else (len(choice.included), choice.model_error)


def _choose_physics(scene: Scene, modes: int) -> Scene:
    return choose_physics(scene, speeds_of(scene), modes, barred={LARGE_DEFLECTION.name: _STRAIGHT})
