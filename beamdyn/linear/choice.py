"""The discretized scene that a linear model at one speed rests on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, count, real
from beamdyn.linear.excitations import Excitation
from beamdyn.linear.model_at_speed import ModelAtSpeed
from beamdyn.modes.modal.discretization_choice import (
    DiscretizationChoice,
    check_discretization,
    choose_model,
    most_modes,
)
from beamdyn.modes.modal.model import Model
from beamdyn.modes.model_error.effect_choice import choose_physics
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.scene.validity import check_speeds

_MODES = 5  # by which the physics and the functions are chosen, where all functions are kept
_STRAIGHT = "linear models are those about the straight beam"


def check_linear(scene: Scene, speed: float, modes: int | None) -> tuple[Scene, float]:
    """The scene with its physics chosen, and the speed [rad/s].

    Raises
    ------
    InvalidValue
        If the scene is none or has a large deflection, or the speed or the modes are out of range.
    """
    check_scene(scene)
    speed = real("speed", speed, "rad/s")
    check_speeds(speed, "speed")
    if modes is not None:
        count("modes", modes, remedy="or None, which keeps all functions")
    scene = choose_physics(scene, [speed], modes or _MODES, straight=_STRAIGHT)
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
    scene: Scene, speed: float, modes: int | None, discretization: DiscretizationChoice
) -> ModelAtSpeed:
    """The linear equations of a scene in as many modes; functions are chosen for modes without damping.

    Raises
    ------
    InvalidValue
        If a discretization that is given has too few functions for the modes.
    """
    if modes is None and not isinstance(discretization, str):
        check_discretization(discretization)
        return ModelAtSpeed(Model(scene, discretization), speed, None)
    chosen = choose_model(scene.undamped, discretization, np.array([speed]), modes or _MODES)
    return ModelAtSpeed(chosen.of(scene), speed, modes)


def model_of_few_modes(
    scene: Scene, speed: float, few: int, discretization: DiscretizationChoice
) -> ModelAtSpeed:
    """The same in a few modes that nobody asked for: in fewer where a given discretization has no more."""
    return model_at_speed(scene, speed, most_modes(scene, discretization, few), discretization)
