"""Motion of the beam's root: the functions of time that multiply the terms of the equations."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np

from beamdyn.scene.motion.base import MotionSample
from beamdyn.scene.mount import Mount, aligned_cos_sin, exact_cos_sin

Quantity = Literal[
    "unity", "speed", "acceleration", "speed_squared", "root_axial", "root_transverse", "root_across"
]
_UNIT_SPEED = MotionSample.steady(1.0)  # motion of a carrier that rotates at 1 rad/s
CONSTANT_AT_STEADY_SPEED: tuple[Quantity, ...] = ("unity", "speed", "acceleration", "speed_squared")


@dataclass(frozen=True, eq=False)
class RootMotion:
    """Quantities of the root's motion that multiply terms of the equations, as arrays over time.

    Parameters
    ----------
    unity : ndarray
        1, the factor of constant terms.
    speed, acceleration, speed_squared : ndarray
        omega [rad/s], omega' [rad/s2] and omega^2 [rad2/s2].
    root_axial : ndarray
        Acceleration a_O1 of the root along the beam, minus gravity [m/s2].
    root_transverse : ndarray
        Acceleration c a_O2 + s a_O3 of the root in the direction of bending, minus gravity [m/s2]; c and s
        are the cosine and sine of the bending angle.
    root_across : ndarray
        Acceleration c a_O3 - s a_O2 of the root perpendicular to the beam and to the direction of bending,
        minus gravity [m/s2].

    Directions are the axes of the beam, which the precone inclines.
    """

    unity: np.ndarray
    speed: np.ndarray
    acceleration: np.ndarray
    speed_squared: np.ndarray
    root_axial: np.ndarray
    root_transverse: np.ndarray
    root_across: np.ndarray


def root_motion(mount: Mount, sample: MotionSample, gravity: float = 0.0) -> RootMotion:
    """Compute the motion of the beam's root from the motion of the carrier.

    Parameters
    ----------
    mount : Mount
        Radius r, setting angle phi, bending angle psi and precone eta.
    sample : MotionSample
        Motion of the carrier.
    gravity : float
        Gravitational acceleration along -n2 [m/s2].

    Returns
    -------
    RootMotion
    """
    cphi, sphi = exact_cos_sin(mount.setting_angle)
    cpsi, spsi = aligned_cos_sin(mount.bending_angle)
    r, omega = mount.radius, sample.speed
    v1, v2, v3 = (sample.carrier_acceleration[..., k] for k in range(3))
    v2 = v2 + gravity
    cos, sin = np.cos(sample.angle), np.sin(sample.angle)
    radial = omega**2 * r + v1 * cos - v2 * sin
    tangential = v1 * sin + v2 * cos + sample.acceleration * r
    a1 = cphi * radial - sphi * tangential
    a2 = sphi * radial + cphi * tangential
    a3 = v3
    if mount.precone:
        c, s = exact_cos_sin(mount.precone)
        a1, a3 = c * a1 + s * v3, c * v3 - s * a1
    return RootMotion(
        unity=np.ones_like(omega),
        speed=omega,
        acceleration=sample.acceleration,
        speed_squared=omega**2,
        root_axial=a1,
        root_transverse=cpsi * a2 + spsi * a3,
        root_across=cpsi * a3 - spsi * a2,
    )


@lru_cache(maxsize=64)
def root_at_unit_speed(mount: Mount) -> RootMotion:
    """Compute the motion of the root while the carrier rotates at 1 rad/s about a fixed centre."""
    return root_motion(mount, _UNIT_SPEED)
