"""Checks that a motion is consistent with its derivatives, and that it can be pickled."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from beamdyn.common.inputs.checks import MOST
from beamdyn.scene.motion.base import Motion

_SAMPLES = 1000  # times at which functions are compared with their derivatives
_STEP = 1e-7  # of the finite differences, relative to the interval
_ZOOMS = 3  # refinements of a step with a misfit before it is reported as a jump
_MISFIT = 1e-6  # allowed misfit, relative to the largest derivative


def check_picklable(motion: Motion) -> None:
    """Raise a ValueError for a motion that cannot be sent to other processes or stored.

    Raises
    ------
    ValueError
        If the motion cannot be pickled.
    """
    if not motion.picklable:
        raise ValueError(
            f"motion: a {type(motion).__name__} of functions that cannot be pickled (such as lambdas) can be "
            "neither stored nor sent to workers; define them with def at the top of a module, "
            "or run in this process without a store"
        )


def check_consistent(motion: Motion, t_end: float) -> None:
    """Check that a motion's speed and acceleration are the derivatives of its angle and speed.

    Parameters
    ----------
    motion : Motion
        The motion; near its `breakpoints` the derivatives are not checked.
    t_end : float
        Time up to which the motion is checked [s].

    Raises
    ------
    ValueError
        If a value is not finite, or a derivative is wrong: with the time and the misfit.
    """
    h = _STEP * t_end
    t = _choose_times(t_end, motion.breakpoints, h)
    sample = motion.at(t + h * np.arange(-2, 3)[:, None])
    angle, speed, acceleration = sample.angle, sample.speed, sample.acceleration
    for name, values in {"angle": angle, "speed": speed, "acceleration": acceleration}.items():
        _check_finite(name, t, values[2])
    _check_finite("carrier_acceleration", t, sample.carrier_acceleration[2].sum(axis=-1))
    _check_derivative("angle", "speed", "rad/s", t, h, angle, speed[2])
    _check_derivative("speed", "acceleration", "rad/s2", t, h, speed, acceleration[2])
    _check_continuous(motion, "angle", "rad", "speed", t)
    _check_continuous(motion, "speed", "rad/s", "acceleration", t)


def _choose_times(t_end: float, breakpoints: Sequence[float], h: float) -> np.ndarray:
    """Choose times over the whole interval and on both sides of each breakpoint, none within 2 h of one."""
    # Irregular, so that no periodic function is sampled at its zeros only.
    k = np.arange(_SAMPLES)
    t = 2 * h + (t_end - 4 * h) * (k + k * math.e % 1) / _SAMPLES
    for jump in breakpoints:
        sides = [side for side in (jump - 3 * h, jump + 3 * h) if 2 * h <= side <= t_end - 2 * h]
        t = np.union1d(t[abs(t - jump) > 2.5 * h], sides)
    return t


def _check_finite(name: str, t: np.ndarray, values: np.ndarray) -> None:
    bad = ~(np.abs(values) <= MOST)
    if bad.any():
        raise ValueError(
            f"{name} = {values[bad][0]} at t = {t[bad][0]:.6g} s: it must be finite up to t_end, "
            f"and at most {MOST:g}"
        )


def _check_derivative(
    name: str, derivative_name: str, unit: str, t: np.ndarray, h: float, f: np.ndarray, df: np.ndarray
) -> None:
    """Compare a derivative `df` at times t with the finite differences of `f` on five points t + k h."""
    coarse = (f[3] - f[1]) / (2 * h)
    fine = (8 * (f[3] - f[1]) - (f[4] - f[0])) / (12 * h)
    rounding = 16 * np.finfo(float).eps * abs(f).max() / h
    allowed = abs(fine - coarse) + _MISFIT * max(abs(df).max(), abs(fine).max()) + rounding
    misfit = abs(df - fine)
    k = int((misfit - allowed).argmax())
    if misfit[k] > allowed[k]:
        raise ValueError(
            f"{derivative_name} is not the derivative of {name} at t = {t[k]:.6g} s: {df[k]:.6g} {unit} "
            f"where differences give {fine[k]:.6g}, a misfit of {misfit[k]:.3g}; correct one of them"
        )


def _check_continuous(motion: Motion, name: str, unit: str, derivative_name: str, t: np.ndarray) -> None:
    """Check that a function has no jump, which finite differences between the times do not see."""
    misfit = 0.0
    for _ in range(_ZOOMS):
        sample = motion.at(t)
        excess, misfit, k = _find_worst_step(t, getattr(sample, name), getattr(sample, derivative_name))
        if excess <= 0:
            return
        t = np.linspace(t[k], t[k + 1], _SAMPLES)  # a steep rise turns out continuous when resolved
    raise ValueError(
        f"{derivative_name} is not the derivative of {name} at t = {t[0]:.6g} s, where {name} jumps by "
        f"{misfit:.3g} {unit}; let {name} continue"
    )


def _find_worst_step(t: np.ndarray, f: np.ndarray, df: np.ndarray) -> tuple[float, float, int]:
    """Find the step of f that differs most from the integral of df: excess of the misfit, misfit, index."""
    step = np.diff(t)
    misfit = abs(np.diff(f) - step * (df[1:] + df[:-1]) / 2)
    # Where df is monotone, the error of the trapezoidal rule is at most half of this.
    rounding = 16 * np.finfo(float).eps * (abs(f).max() + t[-1] * abs(df).max())
    allowed = step * abs(np.diff(df)).max() + rounding
    k = int((misfit - allowed).argmax())
    return float(misfit[k] - allowed[k]), float(misfit[k]), k
