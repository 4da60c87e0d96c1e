"""Motions for which linear theory has no answer."""

from __future__ import annotations

import numpy as np

from beamdyn.common.inputs.checks import NoModelAnswer
from beamdyn.modes.modal.modal_basis import SPEED_SAMPLES
from beamdyn.modes.modal.model import Model
from beamdyn.scene.motion import Motion
from beamdyn.scene.scene import Scene

_LIMIT_DEFLECTION = 1000.0  # over the length: beyond it the motion counts as unbounded


def check_motion(motion: Motion, t_end: float, model: Model) -> None:
    """Raise a NoModelAnswer for a motion that passes the critical speed, before any long work.

    With large deflection the critical speed is no limit.
    """
    t = np.linspace(0, t_end, SPEED_SAMPLES)
    speed = np.abs(motion.at(t).speed)
    if model.scene.physics.large_deflection:
        return  # past the critical speed the beam bends on
    critical = model.solver.critical_speed
    past = (speed >= critical) & (speed > 0)
    if past.any():
        k = int(past.argmax())
        raise NoModelAnswer(
            f"the motion reaches {speed[k]:.6g} rad/s at t = {t[k]:.4g} s, past the critical speed "
            f"{critical:.6g} rad/s: the beam buckles there, and linear theory does not hold; lower the speed"
        )


def check_growth(scene: Scene, largest: float) -> None:
    """Raise an ArithmeticError for a motion that has grown without bound: its error estimates are void."""
    length = scene.beam.length
    if not largest <= _LIMIT_DEFLECTION * length:
        raise growth_without_bound(f"to {largest / length:.1g} times the length")


def growth_without_bound(how_far: str) -> ArithmeticError:
    """Say of a motion that it has no answer, as it grows so far."""
    return ArithmeticError(
        f"the motion grows without bound, {how_far}: the beam buckles under its weight, or it is "
        "parametrically unstable, and linear theory does not hold; lower gravity or the speed, or end the "
        "run earlier"
    )
