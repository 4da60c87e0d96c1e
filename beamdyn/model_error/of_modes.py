"""What the effects that a model leaves out would change in its frequencies and its critical speed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from beamdyn.equations.equations_of_motion import SteadyPencil
from beamdyn.equations.left_out import list_left_out
from beamdyn.model_error.effects import LARGE_DEFLECTION, Addition, list_effects
from beamdyn.model_error.known_modes import Simple
from beamdyn.model_error.large_deflection import NO_CRITICAL_SPEED, bends, large_deflection_change
from beamdyn.model_error.left_out_effects import LeftOutEffects
from beamdyn.model_error.pencils import buckling_mode, shift_critical_speed, shift_eigenvalue
from beamdyn.modal.model import Model
from beamdyn.scene.scene import Scene


def left_out_of_modes(model: Model, speed: float, eigenvalue: np.ndarray) -> LeftOutEffects:
    """Estimate what the effects that a model leaves out would change in frequencies at a speed.

    Parameters
    ----------
    model : Model
        The model.
    speed : float
        Speed [rad/s].
    eigenvalue : ndarray of complex, shape (m,)
        Eigenvalues of the modes [1/s].

    Returns
    -------
    LeftOutEffects
        Relative changes (m,), nan for a mode that does not vibrate or is unstable, without the effect or
        with it.
    """
    simple = Simple.of(model, len(eigenvalue))
    s, v = simple.modes(speed, eigenvalue)

    def change(pencil: SteadyPencil, embed: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
        pairs = zip(s, embed(v).T, strict=True)
        return np.array([_change_of_frequency(pencil, speed, *pair) for pair in pairs])

    def bent() -> tuple[np.ndarray, str]:
        found, reason = large_deflection_change(model, speed, eigenvalue)
        return np.where([_vibrates(one) for one in s], found, np.nan), reason

    return _gather(simple, change, bent)


def left_out_of_critical_speed(model: Model, critical: float) -> LeftOutEffects:
    """Estimate what the effects that a model leaves out would change in its critical speed.

    Parameters
    ----------
    model : Model
        The model.
    critical : float
        Critical speed [rad/s], finite and not 0.

    Returns
    -------
    LeftOutEffects
        Relative changes, of shape ().
    """
    simple = Simple.of(model, 1)
    pencil = simple.pencil()
    v = buckling_mode(pencil, critical)
    known = shift_critical_speed(pencil, critical, v)  # in the spaces of the effects

    def change(pencil: SteadyPencil, embed: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
        return np.array(shift_critical_speed(pencil, known, embed(v)) / known - 1)

    def bent() -> tuple[np.ndarray, str]:
        does = bends(model, critical)  # if not, the straight beam is an equilibrium until it buckles
        return np.array(np.nan if does else 0.0), NO_CRITICAL_SPEED if does else ""

    return _gather(simple, change, bent)


Change = Callable[[SteadyPencil, Callable[[np.ndarray], np.ndarray]], np.ndarray]


def _gather(simple: Simple, change: Change, bent: Callable[[], tuple[np.ndarray, str]]) -> LeftOutEffects:
    """All effects: of each that can be added, the change by its equations; and that by large deflection."""
    additions, not_known, not_modelled = list_effects(simple.scene)
    changes = {}
    if leaves_out_large_deflection(simple.scene):
        changes[LARGE_DEFLECTION], reason = bent()
        not_known |= {LARGE_DEFLECTION: reason} if reason else {}
    for addition in additions:
        changes[addition.name] = _change_by(simple, addition, change)
    assumed = {addition.name: addition.assumed for addition in additions if addition.assumed}
    return LeftOutEffects(changes, not_known, assumed, not_modelled, _ways(simple.scene))


def leaves_out_large_deflection(scene: Scene) -> bool:
    """Whether a scene leaves large deflection out."""
    return any(effect.name == LARGE_DEFLECTION for effect in list_left_out(scene))


def _change_by(simple: Simple, addition: Addition, change: Change) -> np.ndarray:
    equations = simple.extend(addition.scene)
    return change(equations.steady(), lambda v: simple.embed(equations, v))


def _ways(scene: Scene) -> dict[str, str]:
    """How a model includes each effect."""
    values = {effect.name: (effect.physics, effect.physics == "planes") for effect in list_left_out(scene)}
    return {
        name: f"Physics({field}={2 if planes else True}) models it"
        for name, (field, planes) in values.items()
        if field
    }


def _change_of_frequency(pencil: SteadyPencil, speed: float, s: complex, v: np.ndarray) -> float:
    if not _vibrates(s):
        return np.nan
    shifted = shift_eigenvalue(pencil, speed, s, v)
    return float(shifted.imag / s.imag - 1) if _vibrates(shifted) else np.nan


def _vibrates(s: complex) -> bool:
    """Whether a mode has a frequency, and does not grow but by rounding."""
    return bool(np.isfinite(s)) and s.imag > 0 and s.real <= 1e-8 * abs(s)
