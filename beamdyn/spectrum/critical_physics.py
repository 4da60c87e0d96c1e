"""Choice of the physics for a critical speed."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Protocol

import numpy as np

from beamdyn.equations.ritz import Ritz
from beamdyn.modal.model import Model
from beamdyn.model_error.choice import PHYSICS_TOLERANCE, Judged, choose_by
from beamdyn.model_error.effects import LARGE_DEFLECTION, list_effects
from beamdyn.model_error.large_deflection import NO_CRITICAL_SPEED, bends
from beamdyn.scene.scene import Scene

_STRAIGHT = "the critical speed is that of the straight beam"
_FUNCTIONS = 5  # of a model of which only the loads are read


class _Point(Protocol):
    """What is read of a critical point."""

    speed: float
    error: float
    model: Model | None


def choose_for_critical_speed(
    scene: Scene, find: Callable[[Scene], _Point], tolerance: float | None
) -> Scene:
    """Choose the physics by the critical speeds that are found with each effect.

    They are found, not estimated: a second plane may buckle where the first does not.

    Parameters
    ----------
    scene : Scene
        The scene.
    find : callable
        Finds the critical point of a scene with given physics.
    tolerance : float, optional
        Relative change of the speed that may be left out; 1e-3 if not given.

    Returns
    -------
    Scene
        The scene with the physics, and how it was chosen.
    """

    def judge(candidate: Scene) -> Judged:
        known = find(candidate)
        additions, not_known, _ = list_effects(candidate)
        sizes = {added.name: _change(known, find(added.scene)) for added in additions}
        assumed = {added.name: f"it is estimated {added.assumed}" for added in additions if added.assumed}
        does = bends(Model(candidate, Ritz(_FUNCTIONS)))
        sizes[LARGE_DEFLECTION] = math.nan if does else 0.0
        sizes |= dict.fromkeys(not_known, math.nan)
        bent = {LARGE_DEFLECTION: NO_CRITICAL_SPEED if does else _STRAIGHT}
        return Judged(sizes, assumed | not_known | bent)

    def count(candidate: Scene) -> int:
        found = find(candidate).model
        return 1 if found is None else found.solver.size

    tolerance = PHYSICS_TOLERANCE if tolerance is None else tolerance
    return choose_by(scene, judge, count, tolerance, np.array([]))


def _change(without: _Point, within: _Point) -> float:
    """Relative change of a critical speed; inf if one of the two is there, nan if that was not resolved."""
    if math.isinf(without.error) or math.isinf(within.error):
        return math.nan
    if without.speed == within.speed:
        return 0.0
    return abs(within.speed / without.speed - 1) if without.speed and without.speed < math.inf else math.inf
