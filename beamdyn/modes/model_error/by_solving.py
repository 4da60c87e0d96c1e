"""What the effects left out would change in an answer, by solving again with each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple, TypeAlias

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.equations.effects import LARGE_DEFLECTION, list_left_out
from beamdyn.modes.model_error.additions import list_effects
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects
from beamdyn.modes.model_error.of_modes import REFUSED, TWO_PLANES, comparable
from beamdyn.scene.scene import Scene

STRAIGHT = "as of the straight beam"
_ROUNDING = 1e-13  # relative difference of two solutions of equations that an effect does not change


class SolvedValues(NamedTuple):
    """Values that an effect may change, nan where there is none; why there is none; what they rest on."""

    values: np.ndarray
    reason: str = ""
    assumed: str = ""


Solve: TypeAlias = Callable[
    [Scene, str], SolvedValues
]  # of a scene with the effect of a name more, or with ""


def left_out_by_solving(scene: Scene, solve: Solve) -> LeftOutEffects:
    """Find what each effect that a scene leaves out changes in values, by solving with it.

    Effects that large deflection is not combined with are judged on the straight beam where the scene has it.

    Parameters
    ----------
    scene : Scene
        The scene.
    solve : callable
        Solves a scene.

    Returns
    -------
    LeftOutEffects
        Relative changes, of the shape of the values.
    """
    straight = replace(scene.physics, large_deflection=False, branch="straight")
    base = replace(scene, physics=straight)
    additions, not_known, not_modelled = list_effects(base)
    without, found, assumed = solve(base, ""), {}, {}
    if not scene.physics.large_deflection:
        found[LARGE_DEFLECTION.name] = _with_large_deflection(base, without, solve)
    for added in additions:
        found[added.name] = _change(without, solve(added.scene, added.name))
        judged_on = STRAIGHT if scene.physics.large_deflection else ""
        assumed[added.name] = ", ".join(filter(None, [added.assumed, judged_on]))
    notes = {n: ", ".join(filter(None, [assumed.get(n), each.assumed])) for n, each in found.items()}
    return LeftOutEffects(
        changes={name: each.values for name, each in found.items()},
        not_known=not_known | {name: each.reason for name, each in found.items() if each.reason},
        assumed={name: note for name, note in notes.items() if note},
        not_modelled=not_modelled,
        reasons={effect.name: effect.reason for effect in list_left_out(scene)},
        shape=np.shape(without.values),
    )


def _change(without: SolvedValues, within: SolvedValues) -> SolvedValues:
    """Relative change of values, nan where it is not known."""
    with np.errstate(divide="ignore", invalid="ignore"):
        change = np.where(within.values == without.values, 0.0, within.values / without.values - 1)
    change = np.where(np.abs(change) < _ROUNDING, 0.0, change)
    unknown = ~np.isfinite(change)
    reason = (without.reason or within.reason or "there is nothing to compare") if unknown.any() else ""
    return SolvedValues(np.where(unknown, np.nan, change), reason, within.assumed)


def _with_large_deflection(scene: Scene, without: SolvedValues, solve: Solve) -> SolvedValues:
    unknown = np.full(np.shape(without.values), np.nan)
    if scene.physics.planes == 2:
        return SolvedValues(unknown, TWO_PLANES)
    try:
        straight, bent = comparable(scene)
    except InvalidValue as error:
        return SolvedValues(unknown, REFUSED.get(error.field, str(error)))
    without = without if straight.physics == scene.physics else solve(straight, "")
    return _change(without, solve(bent, LARGE_DEFLECTION.name))
