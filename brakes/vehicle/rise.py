"""To rest by a force that rises linearly, while the slope pulls.

With the pull p = g sin(beta) and the full braking force over the mass, r, the speed after the rise time t2 is
V + (p - r / 2) t2. Yoo et al. (1997) let the deceleration rise from 0 instead, as if the slope pulled no more
than the brakes hold while their force rises: on a steep slope their distance is shorter.
Uphill p is negative.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers


def coast(speed: Numbers, pull: Numbers, time: Numbers) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Way [m], time [s] and speed [m/s] at the end of a time in which only the slope acts, or at rest before.

    Parameters
    ----------
    speed : float or ndarray
        Speed before [m/s].
    pull : float or ndarray
        Pull of the slope over the mass [m/s2]; negative uphill.
    time : float or ndarray
        The time [s].
    """
    V, p, t = np.broadcast_arrays(speed, pull, time)
    with np.errstate(divide="ignore"):
        t = np.minimum(t, np.where(p < 0, V / np.abs(p), np.inf))
    return V * t + p * t**2 / 2, t, np.maximum(V + p * t, 0.0)


def to_rest(
    speed: Numbers, pull: Numbers, rate: Numbers, rise_time: Numbers, stops: Any
) -> tuple[np.ndarray, np.ndarray]:
    """Way [m] and time [s] to rest where it stops, else inf: the pull acts while the force rises.

    Parameters
    ----------
    speed : float or ndarray
        Speed before [m/s].
    pull, rate : float or ndarray
        Pull of the slope, and full braking force, over the mass [m/s2].
    rise_time : float or ndarray
        Time in which the force rises linearly [s].
    stops : bool or ndarray
        Whether the force exceeds the pull.
    """
    V, p, r, t2, stops = np.broadcast_arrays(speed, pull, rate, rise_time, stops)
    after = V + (p - r / 2) * t2
    slowing = np.where(stops, r - p, 1.0)
    full_time, full_way = t2 + after / slowing, V * t2 + (p / 2 - r / 6) * t2**2 + after**2 / (2 * slowing)
    with np.errstate(divide="ignore", invalid="ignore"):
        rising = t2 / r * (p + np.sqrt(p**2 + 2 * r * V / t2))  # V + p t - r t^2 / (2 t2) = 0
        rising_way = V * rising + p * rising**2 / 2 - r * rising**3 / (6 * t2)
    in_rise = after < 0
    way, time = np.where(in_rise, rising_way, full_way), np.where(in_rise, rising, full_time)
    return np.where(stops, way, np.inf), np.where(stops, time, np.inf)
