"""Changes by the effects that a model neglects: of frequencies, critical speeds, or any result.

Most changes of frequencies and critical speeds are estimated from the model's modes.  Changes by large
deflection, and changes of all other results, are computed by solving again.

Modes of the real body that the model lacks are listed too, up to its highest mode.  A model in one plane,
without torsion, camber and stretch, lacks the modes of the other direction, of torsion, of camber and of
stretch.  They are computed if the beam has the data; those of the other direction with shear and rotary
inertia, if there are data.

In shapes of arrays, S counts speeds, n coordinates, m and k modes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from typing import NamedTuple, TypeAlias

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, reason_of
from beamdyn.common.numerics import assign
from beamdyn.common.words import Setting, Words
from beamdyn.equations.assembly import assemble_over
from beamdyn.equations.effects import (
    CAMBER,
    LARGE_DEFLECTION,
    ROTARY_INERTIA,
    SECOND_PLANE,
    SHEAR,
    STRETCH,
    TORSION,
    Effect,
    add_effects,
    list_left_out,
    words_of_directions,
)
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.modes.modal.model import BENDING, Model, bends, kinds_of_modes
from beamdyn.modes.modal.solvers import solver_of_pencil
from beamdyn.modes.model_error import added_effects
from beamdyn.modes.model_error.added_effects import Addition, add_effect, can_add, clamp_spaces, list_effects
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, UnlistedMode
from beamdyn.scene.physics import Physics
from beamdyn.scene.scene import Scene

# Reasons why the change by large deflection is not known; those in `_REFUSED` are listed by the name of the
# field in the error that is raised if large deflection is added.
_TWO_PLANES = "not estimated for two planes, where modes may cross"
_OF_BENDING = "its effect is computed only for bending modes"
_HINGED = "a beam on a hinge has no unique equilibrium from which it could bend"
_REFUSED = {
    "mount.bending_angle": "its effect is computed only if the mount's bending angle is a multiple of 90 deg",
    "mount.precone": "its effect is computed only without precone",
    "physics.large_deflection": "its effect is computed here only for one plane of bending",
}
EXCLUDED = _TWO_PLANES, _HINGED, *_REFUSED.values()
_NO_CRITICAL_SPEED = "the rotation bends the beam at every speed: it does not buckle"
_BENT = Setting("physics", large_deflection=True, branch="bent")
_BUCKLED = Words("the straight beam is unstable: ", _BENT, " bends it")
_NOT_FOUND = "the equilibrium was not found"
_LOST = "no single mode with the effect corresponds to a mode without it"
_UNSTABLE = "estimated for the straight beam, which is unstable"
_STRAIGHT = "as of the straight beam"
_STILL = "estimated for the straight beam, which does not deflect"
LOADED = "estimated for the straight beam, which has no load at its tip"
# Number of modes with the effect, per mode without it, among which the corresponding mode is searched.
_AMONG = 4
_REAL = 1e-8  # ratio of growth rate to frequency below which the growth rate is a rounding error
_ROUNDING = 1e-13  # relative difference between solutions of equations that an effect does not change

Change: TypeAlias = Callable[[Addition], np.ndarray]


# Frequencies --------------------------------------------------------------------------------------


def left_out_of_modes(model: Model, speeds: np.ndarray, eigenvalue: np.ndarray) -> LeftOutEffects:
    """Estimate how much the effects that a model neglects change the frequencies at some speeds.

    Parameters
    ----------
    model : Model
        The model.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].
    eigenvalue : ndarray of complex, shape (S, modes)
        Eigenvalues of the modes [1/s].

    Returns
    -------
    LeftOutEffects
        Relative changes (S, modes), nan for a mode that does not vibrate or is unstable, with or without the
        effect.
    """
    modes = eigenvalue.shape[1]
    if model.scene.tip_load.acts:
        return nothing_known(model.scene, LOADED, eigenvalue.shape)
    base = added_effects.BaseEquations.of(without_large_deflection(model), modes)
    references, reversals = [base.modes(*at) for at in zip(speeds.tolist(), eigenvalue, strict=True)], {}

    def change(added: Addition) -> np.ndarray:
        near, of_near = base.suited_to(added.scene, modes), references
        if near is not base:
            of_near = [near.modes(*at) for at in zip(speeds.tolist(), eigenvalue, strict=True)]
        equations, each = near.extend(added.scene), zip(speeds.tolist(), of_near, strict=True)
        s = np.array([s for s, _ in of_near])
        shifted = np.array([_shifted(equations, w, s, near.embed(equations, v)) for w, (s, v) in each])
        reversals[added.name] = _say_reversal(s, shifted)
        with np.errstate(divide="ignore", invalid="ignore"):
            known = vibrate(s) & vibrate(shifted)
            return np.where(known, np.imag(shifted) / np.imag(s) - 1, np.nan)

    bent, reason = None, ""
    if not model.scene.physics.large_deflection:
        kinds = kinds_of_modes(base.equations, np.array([v for _, v in references]))
        of_bending = np.ones(eigenvalue.shape, bool) if kinds is None else kinds == BENDING
        bent, reason = _large_deflection_change(model, speeds, eigenvalue, of_bending)
        bent = np.where(vibrate(eigenvalue), bent, np.nan)
    found = _gather(model.scene, base.scene, change, bent, reason, eigenvalue.shape)
    judged_on = np.array([vibrate(s) for s, _ in references])
    reversals = {name: why for name, why in reversals.items() if why}
    not_known = reversals | found.not_known
    for some, why in ((judged_on, _LOST), (vibrate(eigenvalue) & ~judged_on, _UNSTABLE)):
        lost = {name: why for name, change in found.changes.items() if np.isnan(change[some]).any()}
        not_known = lost | not_known
    return replace(found, not_known=not_known, reversals=reversals)


def vibrate(s: np.ndarray) -> np.ndarray:
    """Return whether modes have a frequency, and a growth rate that is 0 within rounding."""
    return (np.imag(s) > 0) & (np.real(s) <= _REAL * np.abs(s))


def _diverge(s: np.ndarray) -> np.ndarray:
    """Return whether modes grow without oscillation."""
    return (np.imag(s) == 0) & (np.real(s) > 0)


def _shifted(equations: Equations, speed: float, s: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Estimate eigenvalues with an effect, of modes s, v (columns) that vibrate or diverge without it."""
    known = vibrate(s) | _diverge(s)
    shifted = np.full(len(s), np.nan, dtype=complex)
    shifted[known] = added_effects.shift_eigenvalues(equations.steady(), speed, s[known], v[:, known])
    lost = known & np.isnan(shifted)
    if lost.any():  # inverse iteration may converge to a neighbouring mode
        shifted[lost] = added_effects.match_modes(equations, speed, v[:, lost], _AMONG * len(s))
    # The one with Im s > 0 of each conjugate pair is listed.
    return np.where(np.imag(shifted) < 0, shifted.conj(), shifted)


def _say_reversal(s: np.ndarray, shifted: np.ndarray) -> str:
    """State that an effect makes a vibrating mode diverge or a diverging one vibrate, or return "" if not.

    The eigenvalues are `s` without the effect, and `shifted` with it.
    """
    if (vibrate(s) & _diverge(shifted)).any():
        return "with it a mode diverges that vibrates here"
    return "with it a mode vibrates that diverges here" if (_diverge(s) & vibrate(shifted)).any() else ""


def _large_deflection_change(
    model: Model, speeds: np.ndarray, eigenvalue: np.ndarray, of_bending: np.ndarray
) -> tuple[np.ndarray, str]:
    """Compute changes of frequencies by large deflection, nan if unknown, and why they are unknown.

    Effects that exclude large deflection are omitted from both beams compared: the change is then accurate to
    first order, and unknown for modes other than bending.  Modes of a beam in one plane keep their order.
    The change is 0 at rest, and if the straight beam is in equilibrium.
    """
    if not bends(model):
        unstable = (np.real(eigenvalue) > 0).any(axis=1, keepdims=True) & (speeds != 0)[:, None]
        change = np.where(unstable, np.nan, np.zeros(eigenvalue.shape))
        return change, _BUCKLED if unstable.any() else ""
    unknown = np.where((speeds == 0)[:, None], 0.0, np.full(eigenvalue.shape, np.nan))
    if model.scene.physics.planes == 2:
        return unknown, _TWO_PLANES
    try:
        straight, bent = (Model(scene, model.discretization) for scene in _comparable(model.scene))
    except InvalidValue as refusal:
        return unknown, _REFUSED.get(refusal.field, _HINGED)
    # The solver continues the equilibria through all speeds on one branch, and caches them.  If the branch
    # does not reach all speeds, none is cached, and each is searched separately.
    with suppress(ArithmeticError, np.linalg.LinAlgError):
        bent.solver.solve_static(speeds, np.empty((0, bent.solver.size)))
    change, reasons = unknown, dict.fromkeys([] if of_bending.all() else [_OF_BENDING])
    for k, (speed, own) in enumerate(zip(speeds.tolist(), of_bending, strict=True)):
        change[k, own], reason = _bent_change_at(straight, bent, speed, eigenvalue[k, own])
        reasons |= {reason: None} if reason else {}
    return change, next(iter(reasons), "")


def _bent_change_at(
    straight: Model, bent: Model, speed: float, eigenvalue: np.ndarray
) -> tuple[np.ndarray, str]:
    """Compute relative changes by large deflection at one speed, and why some are unknown."""
    if not speed:
        return np.zeros(len(eigenvalue)), ""
    count = min(len(eigenvalue) + added_effects.EXTRA_MODES, straight.solver.size)
    speeds = np.array([speed])
    without = straight.solver.solve(speeds, count).eigenvalue[0]
    order = assign(np.abs(eigenvalue[:, None] - without[None, :]))
    try:
        within = bent.solver.solve(speeds, count).eigenvalue[0]
    except (ArithmeticError, np.linalg.LinAlgError) as error:  # a hinged beam has no unique equilibrium
        unknown = np.full(len(eigenvalue), np.nan)
        return unknown, _NOT_FOUND if isinstance(error, np.linalg.LinAlgError) else reason_of(error)
    with np.errstate(divide="ignore", invalid="ignore"):
        change = np.imag(within[order]) / np.imag(without[order]) - 1
    return np.where(np.imag(within[order]) > 0, change, np.nan), ""


def _comparable(scene: Scene) -> tuple[Scene, Scene]:
    """Return the scene without and with large deflection, both without effects that exclude it."""
    kept = Physics(rotary_inertia=scene.physics.rotary_inertia)
    straight = replace(scene, physics=kept)
    return straight, replace(straight, physics=replace(kept, large_deflection=True))


# Critical speeds ----------------------------------------------------------------------------------


def left_out_of_critical_speed(model: Model, critical: float) -> LeftOutEffects:
    """Estimate how much the effects that a model neglects change its critical speed.

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
    base = added_effects.BaseEquations.of(without_large_deflection(model), 1)

    def change(added: Addition) -> np.ndarray:
        near = base.suited_to(added.scene, 1)
        pencil, equations = near.equations.steady(), near.extend(added.scene)
        v = added_effects.buckling_mode(pencil, critical)
        # Both critical speeds are computed in the function spaces that suit the effect.
        known = added_effects.shift_critical_speed(pencil, critical, v)
        shifted = added_effects.shift_critical_speed(equations.steady(), known, near.embed(equations, v))
        return np.array(shifted / known - 1)

    bent, reason = None, ""
    if not model.scene.physics.large_deflection:
        # If rotation does not bend the straight beam, it stays straight until it buckles, so that large
        # deflection does not change its critical speed.
        does = bends(model)
        bent, reason = np.array(np.nan if does else 0.0), _NO_CRITICAL_SPEED if does else ""
    return _gather(model.scene, base.scene, change, bent, reason)


def nothing_known(scene: Scene, reason: str = "", shape: tuple[int, ...] = ()) -> LeftOutEffects:
    """Return the effects that a scene neglects, with unknown changes (of a given shape) and a reason."""
    additions, not_known, not_modelled = _list_effects(scene, scene.straightened)
    names = [] if scene.physics.large_deflection else [LARGE_DEFLECTION.name]
    unchanged = {name: np.full(shape, np.nan) for name in (*names, *(added.name for added in additions))}
    not_known = dict.fromkeys(unchanged if reason else (), reason) | not_known
    return LeftOutEffects(unchanged, not_known, {}, not_modelled, _reasons(scene), shape)


def without_large_deflection(model: Model) -> Model:
    """Return the model of the straight beam, for which all effects except large deflection are estimated."""
    large = model.scene.physics.large_deflection
    return Model(model.scene.straightened, model.discretization) if large else model


def _list_effects(scene: Scene, straight: Scene) -> tuple[list[Addition], dict[str, str], tuple[str, ...]]:
    """List the effects that a scene neglects, as `list_effects` does for its straight beam.

    Effects that the scene includes although its straight beam cannot (torsion of a twisted strip) are
    omitted.
    """
    additions, not_known, not_modelled = list_effects(straight)
    left_out = {effect.name for effect in list_left_out(scene)}
    return additions, not_known, tuple(name for name in not_modelled if name in left_out)


def _reasons(scene: Scene) -> dict[str, str]:
    """State for each neglected effect what the model assumes without it, and how to include it."""
    return {effect.name: effect.reason for effect in list_left_out(scene)}


def _gather(
    scene: Scene,
    straight: Scene,
    change: Change,
    bent: np.ndarray | None,
    reason: str,
    shape: tuple[int, ...] = (),
) -> LeftOutEffects:
    """Collect the changes by all neglected effects: `change` of each, and `bent` for large deflection."""
    additions, not_known, not_modelled = _list_effects(scene, straight)
    changes = {} if bent is None else {LARGE_DEFLECTION.name: bent}
    not_known |= {LARGE_DEFLECTION.name: reason} if reason else {}
    changes |= {added.name: change(added) for added in additions}
    assumed = {added.name: added.assumed for added in additions if added.assumed}
    if bent is None:
        assumed = {name: ", ".join(filter(None, [assumed.get(name), _STRAIGHT])) for name in changes}
    return LeftOutEffects(changes, not_known, assumed, not_modelled, _reasons(scene), shape)


# Any result, by solving again with each effect --------------------------------------------------


class SolvedValues(NamedTuple):
    """Values of a result, nan where they are not known, with the reason why, and the assumptions made."""

    values: np.ndarray
    reason: str = ""
    assumed: str = ""


# Function that solves a scene with the named effect, or with "" for none.
Solve: TypeAlias = Callable[[Scene, str], SolvedValues]


def left_out_by_solving(scene: Scene, solve: Solve) -> LeftOutEffects:
    """Compute the changes of values by each effect that a scene neglects, by solving with the effect.

    If the scene has large deflection, effects that exclude it are estimated for the straight beam.

    Parameters
    ----------
    scene : Scene
        The scene.
    solve : callable
        Function that solves a scene that includes the named effect, "" for none.

    Returns
    -------
    LeftOutEffects
        Relative changes, of the shape of the values.
    """
    base = scene.straightened
    if scene.tip_load.acts:
        return nothing_known(scene, LOADED, np.shape(solve(base, "").values))
    without, found, notes = solve(base, ""), {}, {}
    if base.beam is not scene.beam and not without.values.any():
        return nothing_known(scene, _STILL, np.shape(without.values))
    additions, not_known, not_modelled = _list_effects(scene, base)
    if not scene.physics.large_deflection:
        found[LARGE_DEFLECTION.name] = _bent_values(base, without, solve)
    for added in additions:
        found[added.name] = _relative_change(without, solve(added.scene, added.name))
        notes[added.name] = [added.assumed, _STRAIGHT if scene.physics.large_deflection else ""]
    assumed = {n: ", ".join(filter(None, [*notes.get(n, ()), each.assumed])) for n, each in found.items()}
    return LeftOutEffects(
        changes={name: each.values for name, each in found.items()},
        not_known=not_known | {name: each.reason for name, each in found.items() if each.reason},
        assumed={name: note for name, note in assumed.items() if note},
        not_modelled=not_modelled,
        reasons=_reasons(scene),
        shape=np.shape(without.values),
    )


def _relative_change(without: SolvedValues, within: SolvedValues) -> SolvedValues:
    """Compute the relative change between the values of two solutions, nan where it is not known."""
    with np.errstate(divide="ignore", invalid="ignore"):
        change = np.where(within.values == without.values, 0.0, within.values / without.values - 1)
    change, unknown = np.where(np.abs(change) < _ROUNDING, 0.0, change), ~np.isfinite(change)
    reason = (without.reason or within.reason or "there is nothing to compare") if unknown.any() else ""
    return SolvedValues(np.where(unknown, np.nan, change), reason, within.assumed)


def _bent_values(scene: Scene, without: SolvedValues, solve: Solve) -> SolvedValues:
    """Compute the relative change of values by large deflection, by solving with it."""
    unknown = np.full(np.shape(without.values), np.nan)
    if scene.physics.planes == 2:
        return SolvedValues(unknown, _TWO_PLANES)
    try:
        straight, bent = _comparable(scene)
        # This raises an error if the analysis supports large deflection in one plane only.
        within = solve(bent, LARGE_DEFLECTION.name)
    except InvalidValue as error:
        return SolvedValues(unknown, _REFUSED.get(error.field, str(error)))
    without = without if straight.physics == scene.physics else solve(straight, "")
    return _relative_change(without, within)


# Modes of kinds that a model lacks -------------------------------------------------------------------

# Effects that add modes, and beginnings of the names of the fields that dominate these modes.
_ADDED = {SECOND_PLANE: "second", TORSION: "torsion", CAMBER: "camber", STRETCH: "stretch"}
# Ratio to the highest listed frequency up to which additional modes are named, as these are known to 3 %.
_MARGIN = 1.03
_EXTRA = 2  # number of modes computed beyond those listed


def left_out_with_modes(model: Model, speeds: np.ndarray, eigenvalue: np.ndarray) -> LeftOutEffects:
    """List the changes of frequencies by neglected effects at some speeds, and modes that a model lacks.

    The parameters are those of `left_out_of_modes`.
    """
    found = left_out_of_modes(model, speeds, eigenvalue)
    return replace(found, unlisted=tuple(find_unlisted(model, speeds, eigenvalue)))


def find_unlisted(model: Model, speeds: np.ndarray, eigenvalue: np.ndarray) -> Iterator[UnlistedMode]:
    """Yield modes of the real body that the model lacks, if they are below its highest listed mode.

    A mode is yielded if this holds at one speed at least.  Its frequency is known to 3 %, so that it may
    exceed that of the highest listed mode by this margin.  `eigenvalue` (speeds, modes) has the eigenvalues
    [1/s] of the listed modes at the `speeds` [rad/s].
    """
    highest = _MARGIN * np.abs(eigenvalue).max(axis=1, initial=0.0)
    scene, spaces_of = without_large_deflection(model).scene, model.discretization.spaces
    for effect, fields in _ADDED.items():
        if effect.is_in(scene) or (added := _add(scene, effect)) is None:
            continue
        extended, kind, count = added.scene, effect.switch, eigenvalue.shape[1] + _EXTRA
        if effect is SECOND_PLANE:
            extended = _refined(extended)
            kind = words_of_directions(extended)[1]
        spaces = clamp_spaces(extended, count) if extended.models_width else spaces_of(extended.beam)
        own = _own_frequencies(assemble_over(extended, spaces), fields, speeds, count)
        for k, omega in enumerate(np.where(own <= highest[:, None], own, np.nan).T):
            if np.isfinite(omega).any():
                yield UnlistedMode(kind, k + 1, effect.name, omega / (2 * np.pi), added.assumed)


def _add(scene: Scene, effect: Effect) -> Addition | None:
    """Add an effect to a scene (torsion together with camber); None if the effect cannot be added."""
    try:
        added = add_effect(scene, TORSION if effect is CAMBER and not TORSION.is_in(scene) else effect)
        extended = add_effects(added.scene, [effect])
    except InvalidValue:
        return None
    return replace(added, effect=effect, scene=extended)


def _refined(scene: Scene) -> Scene:
    """Return the scene with shear and rotary inertia, as far as its beam has the data."""
    for effect in (SHEAR, ROTARY_INERTIA):
        if not effect.is_in(scene) and can_add(scene, effect):
            scene = add_effect(scene, effect).scene
    return scene


def _own_frequencies(equations: Equations, fields: str, speeds: np.ndarray, count: int) -> np.ndarray:
    """Compute angular frequencies (speeds, modes), ascending, of modes dominated by fields of given names.

    Gyroscopic coupling with other fields is neglected, as it changes these modes little.
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
