"""Motion of a vehicle on a slope while it coasts, and to rest under a braking force that rises linearly.

With the slope's pull p = g sin(beta), negative uphill, and the full braking force per mass r, the speed
changes in the rise time t2 from V to V + (p - r / 2) t2. Yoo et al. (1997) let the deceleration rise from 0
instead, as if the brakes balanced the slope's pull from the start: on a steep slope their distance is
shorter.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers


def coast(speed: Numbers, pull: Numbers, time: Numbers) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Compute distance [m], time [s] and speed [m/s] after coasting on a slope for a time, or to rest.

    Parameters
    ----------
    speed : float or ndarray
        Speed at the start [m/s].
    pull : float or ndarray
        Component of gravity along the slope [m/s2]; negative uphill.
    time : float or ndarray
        Largest duration of the coasting [s]; it ends earlier at rest.
    """
    V, p, t = np.broadcast_arrays(speed, pull, time)
    with np.errstate(divide="ignore"):
        t = np.minimum(t, np.where(p < 0, V / np.abs(p), np.inf))
    return V * t + p * t**2 / 2, t, np.maximum(V + p * t, 0.0)


def to_rest(
    speed: Numbers, pull: Numbers, rate: Numbers, rise_time: Numbers, stops: Any
) -> tuple[np.ndarray, np.ndarray]:
    """Compute distance [m] and time [s] to rest, inf if the force is too small; the slope pulls throughout.

    Parameters
    ----------
    speed : float or ndarray
        Speed at the start [m/s].
    pull, rate : float or ndarray
        Component of gravity along the slope, and full braking force per mass [m/s2].
    rise_time : float or ndarray
        Time in which the braking force rises linearly [s].
    stops : bool or ndarray
        Whether the full force exceeds the pull.
    """
    V, p, r, t2, stops = np.broadcast_arrays(speed, pull, rate, rise_time, stops)
    after = V + (p - r / 2) * t2
    slowing = np.where(stops, r - p, 1.0)
    full_time, full_way = t2 + after / slowing, V * t2 + (p / 2 - r / 6) * t2**2 + after**2 / (2 * slowing)
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(p**2 + 2 * r * V / t2)  # of V + p t - r t^2 / (2 t2) = 0; no sum below cancels
        rising = np.where(p < 0, 2 * V / (root - p), t2 / r * (p + root))
        rising_way = V * rising + p * rising**2 / 2 - r * rising**3 / (6 * t2)
    in_rise = after < 0
    way, time = np.where(in_rise, rising_way, full_way), np.where(in_rise, rising, full_time)
    return np.where(stops, way, np.inf), np.where(stops, time, np.inf)
