"""Modes of kinds that a model lacks, as the body has them below the model's highest listed mode.

A beam that bends in one plane, and neither twists nor cambers nor stretches, has no modes of the other
direction, of torsion, of camber and of stretch.  They are found where the beam has the data; those of the
other direction with shear and the rotary inertia of sections, as far as there are data of these.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.equations.assembly import assemble_over
from beamdyn.equations.discretization import Spaces
from beamdyn.equations.effects import (
    CAMBER,
    ROTARY_INERTIA,
    SECOND_PLANE,
    SHEAR,
    STRETCH,
    TORSION,
    Effect,
    add_effects,
    words_of_directions,
)
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.modes.modal.model import Model
from beamdyn.modes.modal.uncoupled import solver_of_pencil
from beamdyn.modes.model_error.additions import Addition, add_effect, can_add
from beamdyn.modes.model_error.left_out_changes import left_out_of_modes, without_large_deflection
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, UnlistedMode
from beamdyn.modes.model_error.reference_modes import clamp_spaces
from beamdyn.scene.scene import Scene

# Effects that add modes, and beginnings of the names of fields in which these modes move most.
_ADDED = {SECOND_PLANE: "second", TORSION: "torsion", CAMBER: "camber", STRETCH: "stretch"}
_REFINING = (SHEAR, ROTARY_INERTIA)
# Factor of the highest listed frequency up to which further modes are named: their frequencies are known to 3
# %.
_MARGIN = 1.03
_EXTRA = 2  # modes computed beyond the number listed


def left_out_with_modes(model: Model, speeds: np.ndarray, eigenvalue: np.ndarray) -> LeftOutEffects:
    """List the changes of frequencies by effects left out at some speeds, and modes that a model lacks.

    The parameters are those of `left_out_of_modes`.
    """
    found = left_out_of_modes(model, speeds, eigenvalue)
    return replace(found, unlisted=tuple(find_unlisted(model, speeds, eigenvalue)))


def find_unlisted(model: Model, speeds: np.ndarray, eigenvalue: np.ndarray) -> Iterator[UnlistedMode]:
    """Yield the modes that a model lacks below the highest that it lists at some speed.

    A margin of 3 % above the highest allows for the accuracy of these modes.  The eigenvalues (S, m)
    are those listed at the speeds (S,) [rad/s].
    """
    highest = _MARGIN * np.abs(eigenvalue).max(axis=1, initial=0.0)
    scene = without_large_deflection(model).scene
    for effect, fields in _ADDED.items():
        if effect.is_in(scene) or (added := _add(scene, effect)) is None:
            continue
        extended, count = added.scene, eigenvalue.shape[1] + _EXTRA
        if effect is SECOND_PLANE:
            extended = _refined(extended)
        spaces = _spaces(extended, model, count)
        own = _own_frequencies(assemble_over(extended, spaces), fields, speeds, count)
        for k, omega in enumerate(np.where(own <= highest[:, None], own, np.nan).T):
            if np.isfinite(omega).any():
                kind, frequency = _kind(effect, extended), omega / (2 * np.pi)
                yield UnlistedMode(kind, k + 1, effect.name, frequency, added.assumed)


def _add(scene: Scene, effect: Effect) -> Addition | None:
    """Add an effect to a scene, and torsion together with camber; None if the effect cannot be added."""
    try:
        added = add_effect(scene, TORSION if effect is CAMBER and not TORSION.is_in(scene) else effect)
        extended = add_effects(added.scene, [effect])
    except InvalidValue:
        return None
    return replace(added, effect=effect, scene=extended)


def _refined(scene: Scene) -> Scene:
    """Return the scene with shear and rotary inertia, as far as its beam has the data."""
    for effect in _REFINING:
        if not effect.is_in(scene) and can_add(scene, effect):
            scene = add_effect(scene, effect).scene
    return scene


def _spaces(scene: Scene, model: Model, modes: int) -> Spaces:
    """Build function spaces for modes of a scene with an effect that a model lacks."""
    if scene.models_width:
        return clamp_spaces(scene, modes)
    return model.discretization.spaces(scene.beam)


def _own_frequencies(equations: Equations, fields: str, speeds: np.ndarray, count: int) -> np.ndarray:
    """Compute angular frequencies (S, k), ascending, of modes that move most in fields of given names.

    Gyroscopic coupling with other fields is left out, as it changes these modes little.
    """
    own = {name for name in equations.blocks if name.startswith(fields)}
    names = [name for together in equations.coupled if own.intersection(together) for name in together]
    pencil, count = equations.steady().part(equations.places(names)), 2 * count
    solver = solver_of_pencil(pencil)
    found = solver.solve(speeds, min(count, solver.size))
    sizes = [equations.blocks[name].stop - equations.blocks[name].start for name in names]
    is_own = np.repeat([name in own for name in names], sizes)
    energy = np.real(found.vector.conj() * (pencil.M @ found.vector))
    moves_own = energy[:, is_own].sum(axis=1) > energy[:, ~is_own].sum(axis=1)
    omega = np.imag(found.eigenvalue)
    return np.sort(np.where(moves_own & (omega > 0), omega, np.inf), axis=1)


def _kind(effect: Effect, scene: Scene) -> str:
    """Name the kind of the modes that an effect adds."""
    return words_of_directions(scene)[1] if effect is SECOND_PLANE else effect.switch
