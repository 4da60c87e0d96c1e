"""Changes of a transient's largest deflection by physical effects that its model neglects.

If an effect hardly changes the lowest natural frequencies and their phases at the end of the run, the change
of the deflection is estimated from the change of the first frequency; otherwise the run is repeated with the
effect.  A run with large deflection takes far longer: it is repeated only if it is short; otherwise the
change is estimated from the static deflection and the backbone curve (frequency over amplitude).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, NoModelAnswer, reason_of
from beamdyn.equations.effects import LARGE_DEFLECTION
from beamdyn.modes.backbone import SMALL, FreeVibration
from beamdyn.modes.modal.discretization_choice import ensure_size
from beamdyn.modes.modal.model import Model, find_speed_range
from beamdyn.modes.model_error.left_out_changes import (
    LOADED,
    SolvedValues,
    left_out_by_solving,
    left_out_of_modes,
    nothing_known,
    without_large_deflection,
)
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects
from beamdyn.modes.repeated import BY_FREQUENCY
from beamdyn.scene.scene import Scene
from beamdyn.transient.problem import Solution, TransientProblem

_MODES = 2  # number of lowest modes whose frequency changes decide whether an effect matters
# Smallest relative change of a frequency, and smallest change of its phase at the end [rad], that matter.
_SHIFT, _PHASE = 1e-4, 1e-2
_SHORT_RUN = 2000  # number of samples up to which a run is repeated with large deflection
_BY_BACKBONE = (
    "roughly estimated from the static deflection and the backbone curve: "
    "where vibration is a large part of the deflection, it may be wrong in size or sign"
)


def left_out_of_transient(
    problem: TransientProblem, found: Solution, window: tuple[float, float] | None = None
) -> LeftOutEffects:
    """Compute the change of a run's largest deflection, in a window [s] or overall, by neglected effects."""
    if problem.scene.tip_load.acts:
        return nothing_known(problem.scene, LOADED)
    largest, samples = _peak(found, window), len(found.path.samples[0])
    speed = find_speed_range(problem.motion, problem.t_end)[-1]
    straight = without_large_deflection(problem.model)
    shifts = _shifts_of_frequencies(straight, speed, problem.t_end)
    without = SolvedValues(np.array(largest))
    if straight is not problem.model:  # compare with a run of the straight, linear beam
        without = _run_again(problem, straight.scene, window)

    def solve(scene: Scene, name: str) -> SolvedValues:
        if scene == straight.scene:
            return without
        if (shift := shifts.get(name)) is not None:
            return SolvedValues(without.values * (1 + shift) ** -2, without.reason, BY_FREQUENCY)
        if name == LARGE_DEFLECTION.name and samples > _SHORT_RUN:
            return _estimate_bent(problem, largest, scene, speed)
        return _run_again(problem, scene, window)

    return left_out_by_solving(problem.scene, solve)


def _peak(found: Solution, window: tuple[float, float] | None) -> float:
    """Find the largest deflection [m] in a run, or in a window of it."""
    return found.largest if window is None else found.peak(*window)


def _shifts_of_frequencies(model: Model, speed: float, t_end: float) -> dict[str, float]:
    """Compute relative changes of the first frequency by those effects that hardly change the motion.

    These change neither the lowest two frequencies nor their phases at `t_end` [s] noticeably.
    """
    s = model.solver.solve(np.array([speed]), min(_MODES, model.solver.size)).eigenvalue
    omega, changes = np.abs(s).max(), left_out_of_modes(model, np.array([speed]), s).changes
    largest = {name: np.abs(each).max() for name, each in changes.items() if name != LARGE_DEFLECTION.name}
    small = (n for n, size in largest.items() if size <= _SHIFT and size * omega * t_end <= _PHASE)
    return {name: float(changes[name][0, 0]) for name in small}


def _estimate_bent(problem: TransientProblem, largest: float, scene: Scene, speed: float) -> SolvedValues:
    """Estimate the largest deflection of a nonlinear model, from static equilibrium and backbone curve.

    The static part is the equilibrium deflection at the largest speed.  The vibration changes in proportion
    to the first mode's compliance: by -2 times the relative change of its frequency.
    """
    bent, straight = (Model(each, problem.model.discretization) for each in (scene, problem.scene))
    try:
        k = FreeVibration.of(bent, speed, 1).coefficient(SMALL)
        static = float(np.abs(bent.static_tips(np.array([speed]))).max())
    except (ArithmeticError, InvalidValue) as error:
        return SolvedValues(np.array(np.nan), reason_of(error))
    linear = float(np.abs(straight.static_tips(np.array([speed]))).max())
    varying = max(largest - linear, 0.0)
    amplitude = largest if linear < varying else varying
    stiffer = 2 * k * (amplitude / scene.beam.length) ** 2
    share = min(linear / largest, 1.0) if largest else 0.0
    ratio = share * (static / linear if linear else 1.0) + (1 - share) * (1 - stiffer)
    return SolvedValues(np.array(largest * ratio), "", _BY_BACKBONE)


def _run_again(problem: TransientProblem, scene: Scene, window: tuple[float, float] | None) -> SolvedValues:
    """Compute the largest deflection in a run of another scene with the same number of modes."""
    if not isinstance(problem.initial, str):
        return SolvedValues(np.array(np.nan), "the given initial coordinates belong to this model only")
    modes = problem.basis.modes
    discretization = (
        problem.discretization if modes is None else ensure_size(scene, problem.discretization, modes)
    )
    again = replace(problem, scene=scene, discretization=discretization, method="auto", t_eval=None)
    try:
        return SolvedValues(np.array(_peak(again.solve(), window)))
    except (ArithmeticError, InvalidValue, NoModelAnswer, np.linalg.LinAlgError) as error:
        return SolvedValues(np.array(np.nan), reason_of(error))
