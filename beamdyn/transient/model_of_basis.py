"""The discretized scene from which a modal basis is taken."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from beamdyn.modes.modal.discretization_choice import DiscretizationChoice, choose_model
from beamdyn.modes.modal.modal_basis import ModalBasis
from beamdyn.modes.modal.model import Model
from beamdyn.scene.scene import Scene


def choose_for_basis(
    scene: Scene, discretization: DiscretizationChoice, basis: ModalBasis, target: float
) -> Model:
    """Choose the smallest model that gives the modes of a basis.

    The basis has modes without damping.  In a scene with two planes, shear, rotary inertia or springs those
    are what the choice rests on: damped ones take far longer to find in large models, and where shear has no
    mass of its own, some do not exist.

    Parameters
    ----------
    scene, discretization, target
        As for `choose_model`.
    basis : ModalBasis
        The modal basis.

    Returns
    -------
    Model
    """
    speeds, modes = np.array(basis.speeds), basis.modes or 1
    if scene.physics.large_deflection:  # the modes are those of the straight beam
        straight = replace(scene, physics=replace(scene.physics, large_deflection=False, branch="straight"))
        return choose_for_basis(straight, discretization, basis, target).of(scene)
    plain = replace(scene, physics=replace(scene.physics, stretch=False)).is_slender_beam_in_one_plane
    if plain or not scene.is_damped:
        return choose_model(scene, discretization, speeds, modes, target)
    return choose_model(scene.undamped, discretization, speeds, modes, target).of(scene)
