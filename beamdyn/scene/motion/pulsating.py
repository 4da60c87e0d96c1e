"""Pulsating motions: a speed that fluctuates about its mean, and a shaken carrier that turns."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated, ClassVar

import numpy as np

from beamdyn.common.inputs.checks import moderate, set_fields, size
from beamdyn.common.inputs.described import Described
from beamdyn.scene.motion.base import Kinematics, MotionSample
from beamdyn.scene.motion.rotations import Rotation, TurningMotion

_NEVER_STEADY = "pulsates, and has no steady state; simulate it, ask for its stability"
_AXES = ("along_n1", "along_n2", "along_n3")


@dataclass(frozen=True)
class PulsatingRotation(Rotation):
    """Rotation about a fixed centre whose speed fluctuates: omega (1 + e cos(2 pi f t)).

    Parameters
    ----------
    speed : float
        Mean speed omega [rad/s].
    fluctuation : float
        Amplitude e of the speed, over its mean.
    frequency : float
        Frequency f of the fluctuation [Hz].

    Raises
    ------
    ValueError
        If the frequency is not positive, or a number is not finite.

    Examples
    --------
    >>> motion = bd.PulsatingRotation(50.0, fluctuation=0.1, frequency=20.0)
    >>> np.round(motion.at(np.array([0.0, 0.025])).speed, 6)  # rad/s
    array([55., 45.])
    """

    speed: Annotated[float, Described("rad/s", "omega", "mean angular speed of the carrier")]
    fluctuation: Annotated[float, Described("", "e", "amplitude of the speed, over its mean")]
    frequency: Annotated[float, Described("Hz", "f", "frequency of the fluctuation", above=0)]

    no_steady_state: ClassVar[str] = _NEVER_STEADY

    def __post_init__(self) -> None:
        set_fields(self, speed=moderate("speed", self.speed, "rad/s"))
        set_fields(self, fluctuation=moderate("fluctuation", self.fluctuation))
        set_fields(self, frequency=size("frequency", self.frequency, "Hz"))

    @property
    def final_speed(self) -> float:
        """Mean speed of the rotation [rad/s]."""
        return self.speed

    @property
    def rates(self) -> tuple[float, ...]:
        """Mean speed, and angular frequency of the fluctuation [rad/s]: see `Motion.rates`."""
        return self.speed, 2 * math.pi * self.frequency

    def kinematics(self, t: np.ndarray) -> Kinematics:
        """Compute angle [rad], speed [rad/s] and acceleration [rad/s2] at times t [s]."""
        rate, swing = 2 * math.pi * self.frequency, self.speed * self.fluctuation
        cos, sin = np.cos(rate * t), np.sin(rate * t)
        return self.speed * t + swing / rate * sin, self.speed + swing * cos, -swing * rate * sin

    def with_speed(self, speed: float) -> PulsatingRotation:
        """Copy the rotation with another mean speed [rad/s] and the same relative fluctuation."""
        return replace(self, speed=speed)


@dataclass(frozen=True)
class ShakenCarrier(TurningMotion):
    """A carrier that turns while its centre is shaken: accelerations a cos(2 pi f t) along fixed directions.

    Without rotation and at setting angle 0, the beam lies along n1: along it the shaking pulsates the axial
    load, across it, along n2 or n3, it bends the beam.

    Parameters
    ----------
    frequency : float
        Frequency f [Hz].
    along_n1, along_n2, along_n3 : float
        Amplitudes a of the acceleration along n1, n2 and n3 [m/s2].
    rotation : float or Rotation
        Constant speed [rad/s], or rotation of the carrier.

    Raises
    ------
    ValueError
        If the frequency is not positive, a number is not finite, or no direction is shaken.

    Examples
    --------
    >>> motion = bd.ShakenCarrier(frequency=20.0, along_n1=50.0)
    >>> np.round(motion.at(np.array([0.0, 0.025])).carrier_acceleration[:, 0], 6)  # m/s2
    array([ 50., -50.])
    """

    frequency: Annotated[float, Described("Hz", "f", "frequency of the shaking", above=0)]
    along_n1: Annotated[float, Described("m/s2", "a_1", "amplitude of the acceleration along n1")] = 0.0
    along_n2: Annotated[float, Described("m/s2", "a_2", "amplitude of the acceleration along n2")] = 0.0
    along_n3: Annotated[float, Described("m/s2", "a_3", "amplitude of the acceleration along n3")] = 0.0
    rotation: Annotated[float | Rotation, Described(key="rotation")] = 0.0

    no_steady_state: ClassVar[str] = _NEVER_STEADY

    def __post_init__(self) -> None:
        set_fields(self, frequency=size("frequency", self.frequency, "Hz"))
        for name in _AXES:
            set_fields(self, **{name: moderate(name, getattr(self, name), "m/s2")})
        self.keep_rotation()

    @property
    def rates(self) -> tuple[float, ...]:
        """Rates of the rotation, and angular frequency of the shaking [rad/s]: see `Motion.rates`."""
        return *self.turning.rates, 2 * math.pi * self.frequency

    def at(self, t: np.ndarray) -> MotionSample:
        """Sample the motion at times t [s], of any shape."""
        sample, cos = self.turning.at(t), np.cos(2 * math.pi * self.frequency * np.asarray(t))
        for axis, name in enumerate(_AXES):
            sample.carrier_acceleration[..., axis] = getattr(self, name) * cos
        return sample
