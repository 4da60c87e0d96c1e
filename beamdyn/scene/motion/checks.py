"""Whether a motion is consistent in itself, and whether it can be sent elsewhere."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from beamdyn.scene.motion.base import Motion

_CHECKS = 1000  # times at which functions are compared with their derivatives
_STEP = 1e-7  # of the finite differences, relative to the interval
_ZOOMS = 3  # into a step that does not fit, before it is called a jump
_MISFIT = 1e-6  # allowed, relative to the largest derivative


def check_picklable(motion: Motion) -> None:
    """Refuse a motion that cannot be sent to other processes or stored.

    Raises
    ------
    ValueError
        With advice.
    """
    if not motion.picklable:
        raise ValueError(
            f"motion: a {type(motion).__name__} of functions that cannot be pickled (such as lambdas) can be "
            "neither stored nor sent to workers; define them with def at the top of a module, "
            "or run in this process without a store"
        )


def check_consistent(motion: Motion, t_end: float) -> None:
    """Refuse a motion whose speed is not the derivative of its angle, or likewise its acceleration.

    Parameters
    ----------
    motion : Motion
        The motion; near its `breakpoints` its derivatives are not checked.
    t_end : float
        Time up to which it is checked [s].

    Raises
    ------
    ValueError
        With the time and the misfit.
    """
    h = _STEP * t_end
    t = _check_times(t_end, motion.breakpoints, h)
    sample = motion.at(t + h * np.arange(-2, 3)[:, None])
    angle, speed, acceleration = sample.angle, sample.speed, sample.acceleration
    for name, values in {"angle": angle, "speed": speed, "acceleration": acceleration}.items():
        _check_finite(name, t, values[2])
    _check_finite("carrier_acceleration", t, sample.carrier_acceleration[2].sum(axis=-1))
    _check_derivative("angle", "speed", "rad/s", t, h, angle, speed[2])
    _check_derivative("speed", "acceleration", "rad/s2", t, h, speed, acceleration[2])
    _check_continuous(motion, "angle", "rad", "speed", t)
    _check_continuous(motion, "speed", "rad/s", "acceleration", t)


def _check_times(t_end: float, breakpoints: Sequence[float], h: float) -> np.ndarray:
    """Times all over the interval and on both sides of each breakpoint, none within 2 h of one."""
    # Irregular, so that no periodic function is met at its zeros only.
    k = np.arange(_CHECKS)
    t = 2 * h + (t_end - 4 * h) * (k + k * math.e % 1) / _CHECKS
    for jump in breakpoints:
        sides = [side for side in (jump - 3 * h, jump + 3 * h) if 2 * h <= side <= t_end - 2 * h]
        t = np.union1d(t[abs(t - jump) > 2.5 * h], sides)
    return t


def _check_finite(name: str, t: np.ndarray, values: np.ndarray) -> None:
    bad = ~np.isfinite(values)
    if bad.any():
        raise ValueError(f"{name} = {values[bad][0]} at t = {t[bad][0]:.6g} s: it must be finite up to t_end")


def _check_derivative(
    lower: str, upper: str, unit: str, t: np.ndarray, h: float, f: np.ndarray, given: np.ndarray
) -> None:
    """Compare a function with the finite differences of another over a five-point stencil."""
    coarse = (f[3] - f[1]) / (2 * h)
    fine = (8 * (f[3] - f[1]) - (f[4] - f[0])) / (12 * h)
    rounding = 16 * np.finfo(float).eps * abs(f).max() / h
    allowed = abs(fine - coarse) + _MISFIT * max(abs(given).max(), abs(fine).max()) + rounding
    misfit = abs(given - fine)
    k = int((misfit - allowed).argmax())
    if misfit[k] > allowed[k]:
        raise ValueError(
            f"{upper} is not the derivative of {lower} at t = {t[k]:.6g} s: {given[k]:.6g} {unit} where "
            f"differences give {fine[k]:.6g}, a misfit of {misfit[k]:.3g}; correct one of them"
        )


def _check_continuous(motion: Motion, name: str, unit: str, slope: str, t: np.ndarray) -> None:
    """Refuse a function that jumps where its derivative does not say so."""
    misfit = 0.0
    for _ in range(_ZOOMS):
        sample = motion.at(t)
        excess, misfit, k = _worst_step(t, getattr(sample, name), getattr(sample, slope))
        if excess <= 0:
            return
        t = np.linspace(t[k], t[k + 1], _CHECKS)  # a steep rise, resolved there, is no jump
    raise ValueError(
        f"{slope} is not the derivative of {name} at t = {t[0]:.6g} s, where {name} jumps by "
        f"{misfit:.3g} {unit}; let {name} continue"
    )


def _worst_step(t: np.ndarray, f: np.ndarray, g: np.ndarray) -> tuple[float, float, int]:
    """Step of f that differs most from the integral of g: excess over what is allowed, misfit, place."""
    step = np.diff(t)
    misfit = abs(np.diff(f) - step * (g[1:] + g[:-1]) / 2)
    # Where g is monotone, the trapezoidal rule is off by half of this at most.
    allowed = step * abs(np.diff(g)).max() + 16 * np.finfo(float).eps * (abs(f).max() + t[-1] * abs(g).max())
    k = int((misfit - allowed).argmax())
    return float(misfit[k] - allowed[k]), float(misfit[k]), k
