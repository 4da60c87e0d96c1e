"""What the effects left out would change in a steady response."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from beamdyn.modal.choice import ensure_size
from beamdyn.model_error.by_solving import left_out_by_solving
from beamdyn.model_error.left_out_effects import LeftOutEffects
from beamdyn.scene.scene import Scene

if TYPE_CHECKING:
    from beamdyn.steady.response import ResponseRequest

_MOST_JUDGED = 4  # speeds beside that of the largest amplitude
_LINEAR = "vibration about the equilibrium being linear"


def left_out_of_response(request: ResponseRequest, speeds: np.ndarray) -> LeftOutEffects:
    """Find what each effect changes in the amplitude at speeds [rad/s] (k,), by solving with it there."""
    some = replace(request, speeds=speeds)

    def solve(scene: Scene) -> tuple[np.ndarray, str]:
        response = _with_scene(some, scene).run()
        lost = [status for status in response.status.tolist() if status != "stable"]
        return response.amplitude, lost[0] if lost else ""

    return left_out_by_solving(request.scene, solve, _LINEAR)


def _with_scene(request: ResponseRequest, scene: Scene) -> ResponseRequest:
    """The request for another scene, with as many modes, or of another kind those that suit it."""
    modes = request.basis.modes or 1
    changed = replace(request, scene=scene, discretization=ensure_size(scene, request.discretization, modes))
    if scene.physics.large_deflection == request.scene.physics.large_deflection:
        return changed
    basis = changed.smallest_basis()
    return replace(changed, basis=replace(basis, modes=max(modes, basis.modes or 1)))


def choose_judged(amplitude: np.ndarray) -> np.ndarray:
    """Indices of the speeds to judge: that of the largest amplitude, and a few evenly spread."""
    known = np.flatnonzero(np.isfinite(amplitude))
    if not len(known):
        return known
    spread = np.linspace(0, len(known) - 1, min(len(known), _MOST_JUDGED)).round().astype(int)
    return np.union1d(known[spread], known[np.argmax(amplitude[known])])
