"""Motions of the carrier: its angle, speed and acceleration, and the acceleration of its centre."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from beamdyn.common.checks import real


@dataclass(frozen=True)
class MotionSample:
    """The carrier's motion at given times; all arrays share the shape of the times.

    Parameters
    ----------
    angle, speed, acceleration : ndarray
        Angle theta [rad] turned about -n3, its rate omega [rad/s] and omega' [rad/s2].
    carrier_acceleration : ndarray, shape (..., 3)
        Acceleration of the centre of the carrier along the fixed directions n1, n2, n3 [m/s2].
    """

    angle: np.ndarray
    speed: np.ndarray
    acceleration: np.ndarray
    carrier_acceleration: np.ndarray

    @classmethod
    def steady(cls, speed: np.ndarray | float) -> MotionSample:
        """Rotation at constant speed about a fixed centre, one entry per speed."""
        speed = np.asarray(speed, dtype=float)
        zero = np.zeros(speed.shape)
        return cls(zero, speed, zero, np.zeros((*speed.shape, 3)))


class Motion(Protocol):
    """What a motion answers."""

    def at(self, t: np.ndarray) -> MotionSample:
        """The motion at times t [s]."""
        ...

    def with_speed(self, speed: float) -> Motion:
        """The same motion at another speed [rad/s]."""
        ...


@dataclass(frozen=True)
class SteadyRotation:
    """Rotation at constant speed about a fixed centre.

    Parameters
    ----------
    speed : float
        Speed [rad/s].
    """

    speed: float

    def __post_init__(self) -> None:
        real("speed", self.speed, "rad/s")

    def at(self, t: np.ndarray) -> MotionSample:
        """The motion at times t [s]."""
        t = np.asarray(t, dtype=float)
        zero = np.zeros(t.shape)
        return MotionSample(self.speed * t, zero + self.speed, zero, np.zeros((*t.shape, 3)))

    def with_speed(self, speed: float) -> SteadyRotation:
        """The same motion at another speed [rad/s]."""
        return SteadyRotation(speed)
