"""Choice of the physics for a critical speed."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, Protocol, TypeVar

import numpy as np

from beamdyn.equations.effects import LARGE_DEFLECTION
from beamdyn.equations.ritz import Ritz
from beamdyn.modes.modal.model import Model
from beamdyn.modes.modal.static_load import bends
from beamdyn.modes.model_error.additions import list_effects
from beamdyn.modes.model_error.effect_choice import PHYSICS_TOLERANCE, EffectSizes, choose_by
from beamdyn.scene.scene import Scene
from beamdyn.scene.validity import warn_of_left_out

_FUNCTIONS = 5  # of a model of which only the loads are read


class _CriticalAnswer(Protocol):
    """What is read of a critical point."""

    @property
    def speed(self) -> float: ...

    @property
    def error(self) -> float: ...

    @property
    def model(self) -> Model | None: ...

    @property
    def warnings(self) -> tuple[str, ...]: ...


Found = TypeVar("Found", bound=_CriticalAnswer)

_UNRESOLVED = "its critical speed is not resolved"


def find_with_chosen_physics(scene: Scene, find: Callable[[Scene], Found], tolerance: float | None) -> Found:
    """Find a critical point with the effects that change it by more than the tolerance.

    Each effect is judged by the critical speed that is found with it: a second plane may buckle where the
    first does not.

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
    CriticalPoint
        With the warnings of the choice.
    """
    chosen = _choose(scene, find, PHYSICS_TOLERANCE if tolerance is None else tolerance)
    point: Any = find(chosen)
    return replace(point, scene=chosen, warnings=(*point.warnings, *warn_of_left_out(chosen)))


def _choose(scene: Scene, find: Callable[[Scene], _CriticalAnswer], tolerance: float) -> Scene:
    """The scene with the effects that change the critical speed."""

    def judge(candidate: Scene) -> EffectSizes:
        known = find(candidate)
        additions, not_known, _ = list_effects(candidate)
        sizes = {added.name: _change(known, find(added.scene)) for added in additions}
        assumed = {added.name: f"it is estimated {added.assumed}" for added in additions if added.assumed}
        # Where rotation bends the beam from rest on, it does not buckle.
        sizes[LARGE_DEFLECTION.name] = math.inf if bends(Model(candidate, Ritz(_FUNCTIONS))) else 0.0
        unresolved = {name: _UNRESOLVED for name, size in sizes.items() if math.isnan(size)}
        return EffectSizes(sizes | dict.fromkeys(not_known, math.nan), unresolved | assumed | not_known)

    def count(candidate: Scene) -> int:
        found = find(candidate).model
        return 1 if found is None else found.solver.size

    return choose_by(scene, judge, count, tolerance, np.array([]))


def _change(without: _CriticalAnswer, within: _CriticalAnswer) -> float:
    """Relative change of a critical speed; inf if one of the two is there, nan if that was not resolved."""
    if math.isinf(without.error) or math.isinf(within.error):
        return math.nan
    if without.speed == within.speed:
        return 0.0
    return abs(within.speed / without.speed - 1) if without.speed and without.speed < math.inf else math.inf
