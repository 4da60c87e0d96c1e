"""What the effects left out would change in an answer, by solving again with each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from beamdyn.common.checks import InvalidValue
from beamdyn.equations.left_out import list_left_out
from beamdyn.model_error.effects import LARGE_DEFLECTION, list_effects
from beamdyn.model_error.large_deflection import OBLIQUE, TWO_PLANES, comparable
from beamdyn.model_error.left_out_effects import LeftOutEffects
from beamdyn.scene.scene import Scene

Solve: TypeAlias = Callable[[Scene], tuple[np.ndarray, str]]  # values, nan where there is none, and why

STRAIGHT = "as of the straight beam"


def left_out_by_solving(scene: Scene, solve: Solve, about_large: str = "") -> LeftOutEffects:
    """Find what each effect that a scene leaves out changes in values, by solving with it.

    Effects that large deflection is not combined with are judged on the straight beam where the scene has it.

    Parameters
    ----------
    scene : Scene
        The scene.
    solve : callable
        Solves a scene: its values, nan where there is none, and why there is none.
    about_large : str
        What the values with large deflection rest on; empty if on nothing.

    Returns
    -------
    LeftOutEffects
        Relative changes, of the shape of the values.
    """
    bent = scene.physics.large_deflection
    base = replace(scene, physics=replace(scene.physics, large_deflection=False, branch="straight"))
    additions, not_known, not_modelled = list_effects(base)
    assumed = {added.name: added.assumed for added in additions if added.assumed}
    changes, without = {}, solve(base)
    if bent:
        assumed = {a.name: ", ".join(filter(None, [a.assumed, STRAIGHT])) for a in additions}
    else:
        changes[LARGE_DEFLECTION], reason = _change_by_large_deflection(base, without, solve)
        not_known |= {LARGE_DEFLECTION: reason} if reason else {}
        assumed |= {LARGE_DEFLECTION: about_large} if about_large and not reason else {}
    for added in additions:
        changes[added.name], reason = _change(without, solve(added.scene))
        not_known |= {added.name: reason} if reason else {}
    reasons = {effect.name: effect.reason for effect in list_left_out(base)}
    return LeftOutEffects(changes, not_known, assumed, not_modelled, reasons)


def _change(without: tuple[np.ndarray, str], within: tuple[np.ndarray, str]) -> tuple[np.ndarray, str]:
    """Relative change of values, nan where it is not known, and why."""
    with np.errstate(divide="ignore", invalid="ignore"):
        change = np.where(within[0] == without[0], 0.0, within[0] / without[0] - 1)
    change = np.where(np.isfinite(change), change, np.nan)
    return change, (without[1] or within[1]) if np.isnan(change).any() else ""


def _change_by_large_deflection(
    scene: Scene, without: tuple[np.ndarray, str], solve: Solve
) -> tuple[np.ndarray, str]:
    unknown = np.full(np.shape(without[0]), np.nan)
    if scene.physics.planes == 2:
        return unknown, TWO_PLANES
    try:
        straight, bent = comparable(scene)
    except InvalidValue as error:
        return unknown, OBLIQUE if "bending_angle" in str(error) else str(error)
    return _change(without if straight.physics == scene.physics else solve(straight), solve(bent))
