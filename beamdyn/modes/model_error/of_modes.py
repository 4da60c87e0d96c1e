"""What the effects that a model leaves out would change in its frequencies and its critical speed.

Large deflection is solved, the others are estimated.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from beamdyn.common.assignment import assign
from beamdyn.common.inputs.checks import InvalidValue, reason_of
from beamdyn.equations.effects import LARGE_DEFLECTION, list_left_out
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.modes.modal.model import Model
from beamdyn.modes.modal.static_load import bends
from beamdyn.modes.model_error.additions import Addition, list_effects
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects
from beamdyn.modes.model_error.reference_modes import (
    BaseEquations,
    buckling_mode,
    match_modes,
    shift_critical_speed,
    shift_eigenvalues,
)
from beamdyn.scene.physics import Physics
from beamdyn.scene.scene import Scene

NO_CRITICAL_SPEED = "the rotation bends the beam at every speed: it does not buckle"
_BUCKLED = "the straight beam is unstable: Physics(large_deflection=True, branch='bent') bends it"
TWO_PLANES = "it is solved in one plane of bending"
HINGED = "a beam on a hinge has no one equilibrium from which it could bend"
OBLIQUE = "it is solved where the bending angle is a multiple of 90 deg"
PRECONED = "it is solved without precone"
REFUSED = {"mount.bending_angle": OBLIQUE, "mount.precone": PRECONED}
EXCLUDED = TWO_PLANES, HINGED, OBLIQUE, PRECONED  # why it cannot be added
_NOT_FOUND = "the equilibrium was not found"
_EXTRA_MODES = 2  # higher ones with which the wanted may exchange their order


def large_deflection_change(
    model: Model, speeds: np.ndarray, eigenvalue: np.ndarray
) -> tuple[np.ndarray, str]:
    """Find what large deflection changes in the frequencies at some speeds.

    What it cannot be combined with is left out of both beams that are compared: the change is then to first
    order.  Modes of a beam in one plane keep their order.

    Parameters
    ----------
    model : Model
        The linear model.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].
    eigenvalue : ndarray of complex, shape (S, m)
        Its eigenvalues [1/s].

    Returns
    -------
    change : ndarray, shape (S, m)
        Relative change of each frequency: 0 if the straight beam is in equilibrium, nan if it is not known.
    reason : str
        Why it is not known; empty if it is.
    """
    if not bends(model):
        unstable = (np.real(eigenvalue) > 0).any(axis=1, keepdims=True) & (speeds != 0)[:, None]
        change = np.where(unstable, np.nan, np.zeros(eigenvalue.shape))
        return change, _BUCKLED if unstable.any() else ""
    if model.scene.physics.planes == 2:
        return np.where((speeds == 0)[:, None], 0.0, np.full(eigenvalue.shape, np.nan)), TWO_PLANES
    try:
        straight, bent = (Model(scene, model.discretization) for scene in comparable(model.scene))
    except InvalidValue as refusal:
        reason = REFUSED.get(refusal.field, HINGED)
        return np.where((speeds == 0)[:, None], 0.0, np.full(eigenvalue.shape, np.nan)), reason
    _follow_branch(bent, speeds)
    each = [_change_at(straight, bent, *at) for at in zip(speeds.tolist(), eigenvalue, strict=True)]
    reasons = dict.fromkeys(reason for _, reason in each if reason)
    return np.array([change for change, _ in each]), next(iter(reasons), "")


def _transverse(model: Model) -> np.ndarray:
    """Coordinates of the fields that deflect the beam transversely."""
    return model.equations.places(model.equations.deflections)


def comparable(scene: Scene) -> tuple[Scene, Scene]:
    """The scene without and with large deflection, both without what that cannot be combined with."""
    kept = Physics(rotary_inertia=scene.physics.rotary_inertia)
    straight = replace(scene, physics=kept)
    return straight, replace(straight, physics=replace(kept, large_deflection=True))


def _follow_branch(bent: Model, speeds: np.ndarray) -> None:
    """Have the solver find the equilibria at all speeds along one branch; it keeps them.

    Where the branch does not reach all speeds, none is kept, and each is sought by itself.
    """
    with suppress(ArithmeticError, np.linalg.LinAlgError):
        bent.solver.solve_static(speeds, np.empty((0, bent.solver.size)))


def _change_at(straight: Model, bent: Model, speed: float, eigenvalue: np.ndarray) -> tuple[np.ndarray, str]:
    """Relative changes (m,) at one speed, and why they are not known."""
    if not speed:
        return np.zeros(len(eigenvalue)), ""
    count, speeds = min(len(eigenvalue) + _EXTRA_MODES, straight.solver.size), np.array([speed])
    without = straight.solver.solve(speeds, count).eigenvalue[0]
    order = assign(np.abs(eigenvalue[:, None] - without[None, :]))
    try:
        within = bent.solver.solve(speeds, count).eigenvalue[0]
    except ArithmeticError as error:
        return np.full(len(eigenvalue), np.nan), reason_of(error)
    except np.linalg.LinAlgError:  # a hinge, on which the beam has no single equilibrium at rest
        return np.full(len(eigenvalue), np.nan), _NOT_FOUND
    with np.errstate(divide="ignore", invalid="ignore"):
        change = np.imag(within[order]) / np.imag(without[order]) - 1
    return np.where(np.imag(within[order]) > 0, change, np.nan), ""


_LOST = "it turns a mode into others"
_UNSTABLE = "it is judged on the straight beam, which is unstable"
_STRAIGHT = "as of the straight beam"
_AMONG = 4  # modes with the effect for each one without, among which that is sought
_REAL = 1e-8  # growth rate relative to the frequency, that is rounding

Embedding: TypeAlias = Callable[[np.ndarray], np.ndarray]  # of vectors in the coordinates with an effect
Change: TypeAlias = Callable[[Equations, Embedding], np.ndarray]


def left_out_of_modes(model: Model, speeds: np.ndarray, eigenvalue: np.ndarray) -> LeftOutEffects:
    """Estimate what the effects that a model leaves out would change in frequencies at some speeds.

    Parameters
    ----------
    model : Model
        The model.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].
    eigenvalue : ndarray of complex, shape (S, m)
        Eigenvalues of the modes [1/s].

    Returns
    -------
    LeftOutEffects
        Relative changes (S, m), nan for a mode that does not vibrate or is unstable, without the effect or
        with it.
    """
    simple = BaseEquations.of(without_large_deflection(model), eigenvalue.shape[1])
    found_modes = [simple.modes(*at) for at in zip(speeds.tolist(), eigenvalue, strict=True)]

    def change(equations: Equations, embed: Embedding) -> np.ndarray:
        each = zip(speeds.tolist(), found_modes, strict=True)
        return np.array([_change_of_frequencies(equations, speed, s, embed(v)) for speed, (s, v) in each])

    def bent() -> tuple[np.ndarray, str]:
        changes, reason = large_deflection_change(model, speeds, eigenvalue)
        return np.where(vibrate(eigenvalue), changes, np.nan), reason

    bending = None if model.scene.physics.large_deflection else bent
    found = _gather(model.scene, simple, change, bending, eigenvalue.shape)
    judged_on = np.array([vibrate(s) for s, _ in found_modes])
    found = _say_not_known(found, judged_on, _LOST)
    return _say_not_known(found, vibrate(eigenvalue) & ~judged_on, _UNSTABLE)


def _say_not_known(effects: LeftOutEffects, modes: np.ndarray, why: str) -> LeftOutEffects:
    """Name the effects that have no estimate at a mode of a selection (S, m), and why."""
    lost = {name: why for name, change in effects.changes.items() if np.isnan(change[modes]).any()}
    return replace(effects, not_known=lost | effects.not_known)


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
    simple = BaseEquations.of(without_large_deflection(model), 1)
    pencil = simple.pencil()
    v = buckling_mode(pencil, critical)
    known = shift_critical_speed(pencil, critical, v)  # in the spaces of the effects

    def change(equations: Equations, embed: Embedding) -> np.ndarray:
        return np.array(shift_critical_speed(equations.steady(), known, embed(v)) / known - 1)

    def bent() -> tuple[np.ndarray, str]:
        does = bends(model)  # if not, the straight beam is an equilibrium until it buckles
        return np.array(np.nan if does else 0.0), NO_CRITICAL_SPEED if does else ""

    return _gather(model.scene, simple, change, None if model.scene.physics.large_deflection else bent)


def nothing_known(scene: Scene) -> LeftOutEffects:
    """The effects that a scene leaves out, where there is no value that they could change."""
    additions, not_known, not_modelled = list_effects(replace(scene, physics=_straight(scene.physics)))
    names = [] if scene.physics.large_deflection else [LARGE_DEFLECTION.name]
    unchanged = {name: np.array(np.nan) for name in (*names, *(added.name for added in additions))}
    return LeftOutEffects(unchanged, not_known, {}, not_modelled, _reasons(scene))


def _gather(
    scene: Scene,
    simple: BaseEquations,
    change: Change,
    bent: Callable[[], tuple[np.ndarray, str]] | None,
    shape: tuple[int, ...] = (),
) -> LeftOutEffects:
    """All effects that a scene leaves out on values of a shape: by the equations of each; and by bending."""
    additions, not_known, not_modelled = list_effects(simple.scene)
    changes = {}
    if bent is not None:
        changes[LARGE_DEFLECTION.name], reason = bent()
        not_known |= {LARGE_DEFLECTION.name: reason} if reason else {}
    for addition in additions:
        changes[addition.name] = _change_by(simple, addition, change)
    assumed = {addition.name: addition.assumed for addition in additions if addition.assumed}
    if bent is None:
        assumed = {name: ", ".join(filter(None, [assumed.get(name), _STRAIGHT])) for name in changes}
    return LeftOutEffects(changes, not_known, assumed, not_modelled, _reasons(scene), shape)


def without_large_deflection(model: Model) -> Model:
    """The model of the straight beam, for which the other effects are estimated."""
    if not model.scene.physics.large_deflection:
        return model
    return Model(replace(model.scene, physics=_straight(model.scene.physics)), model.discretization)


def _straight(physics: Physics) -> Physics:
    return replace(physics, large_deflection=False, branch="straight")


def _change_by(simple: BaseEquations, addition: Addition, change: Change) -> np.ndarray:
    equations = simple.extend(addition.scene)
    return change(equations, lambda v: simple.embed(equations, v))


def _reasons(scene: Scene) -> dict[str, str]:
    """Assumption of the model in place of each effect, and how to include the effect, by name."""
    return {effect.name: effect.reason for effect in list_left_out(scene)}


def _change_of_frequencies(equations: Equations, speed: float, s: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Relative changes (m,) of the frequencies of modes s (m,), v (n, m) by equations with an effect."""
    known = vibrate(s)
    shifted = np.full(len(s), np.nan, dtype=complex)
    shifted[known] = shift_eigenvalues(equations.steady(), speed, s[known], v[:, known])
    lost = known & np.isnan(shifted)
    if lost.any():  # a step of inverse iteration may lead to a neighbour
        shifted[lost] = match_modes(equations, speed, v[:, lost], _AMONG * len(s))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(vibrate(shifted), np.imag(shifted) / np.imag(s) - 1, np.nan)


def vibrate(s: np.ndarray) -> np.ndarray:
    """Whether modes have a frequency, and do not grow but by rounding."""
    return (np.imag(s) > 0) & (np.real(s) <= _REAL * np.abs(s))
