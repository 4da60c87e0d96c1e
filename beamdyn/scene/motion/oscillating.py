"""Motions that oscillate: a speed that fluctuates, a shaken carrier, and recorded accelerations."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal, get_args

import numpy as np

from beamdyn.common.inputs.checks import (
    MOST,
    InvalidValue,
    moderate,
    one_of,
    real_array,
    refuse,
    set_fields,
    size,
)
from beamdyn.common.inputs.described import Described
from beamdyn.scene.motion.base import Kinematics, MotionSample, check_times
from beamdyn.scene.motion.rotations import Rotation, TurningMotion

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

_NEVER_STEADY = "pulsates, so that it has no steady state; simulate this motion, or compute its stability"
_AXES = ("along_n1", "along_n2", "along_n3")


@dataclass(frozen=True)
class PulsatingRotation(Rotation):
    """Rotation about a fixed centre whose speed fluctuates: omega (1 + e cos(2 pi f t)).

    Parameters
    ----------
    speed : float
        Mean speed omega [rad/s].
    fluctuation : float
        Amplitude e of the speed, relative to the mean speed.
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
    fluctuation: Annotated[float, Described("", "e", "amplitude of the speed, relative to its mean")]
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

    Without rotation and at setting angle 0, the beam lies along n1.  Shaking along n1 then makes its axial
    load pulsate, and shaking along n2 or n3 bends it.

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


# Records of an acceleration --------------------------------------------------------------------------

_GAP = 1.5  # ratio of an interval to the usual interval above which samples count as missing
_AXES_OF_RECORDS = ("along_n1", "along_n2", "along_n3")

BetweenSamples = Literal["linear", "cubic"]


@dataclass(frozen=True)
class SampledTranslation(TurningMotion):
    """Motion of a rotating carrier whose centre has a recorded acceleration.

    An accelerometer at rest shows gravity: subtract gravity from the record, and give it as gravity of the
    scene if the beam is to feel it.

    Parameters
    ----------
    times : sequence of float
        Times [s], ascending from 0 at even intervals.
    along_n1, along_n2, along_n3 : sequence of float
        Accelerations at these times along the fixed directions n1, n2 and n3 [m/s2]; 0 where none are given.
    rotation : float or Rotation
        Constant speed [rad/s], or rotation of the carrier.
    interpolation : "linear" or "cubic"
        Straight lines between samples, or a cubic spline, for records of many samples a period.

    Raises
    ------
    ValueError
        If the times do not ascend from 0, samples are missing between two of them, a value is not finite, or
        the numbers of times and accelerations differ.

    Examples
    --------
    >>> t = np.linspace(0, 0.1, 101)
    >>> motion = bd.SampledTranslation(t, along_n2=50.0 * np.sin(100 * t))  # m/s2
    >>> motion.at(np.array([0.05])).carrier_acceleration.shape
    (1, 3)
    """

    times: Sequence[Annotated[float, Described("s", "t", "times of the record, from 0, evenly spaced")]]
    along_n1: Sequence[Annotated[float, Described("m/s2", "a_1", "accelerations along n1")]] = ()
    along_n2: Sequence[Annotated[float, Described("m/s2", "a_2", "accelerations along n2")]] = ()
    along_n3: Sequence[Annotated[float, Described("m/s2", "a_3", "accelerations along n3")]] = ()
    rotation: Annotated[float | Rotation, Described(key="rotation")] = 0.0
    interpolation: Annotated[
        BetweenSamples, Described(meaning="straight lines between samples, or a cubic spline")
    ] = "linear"

    no_steady_state: ClassVar[str] = "has no steady state; simulate it"

    def __post_init__(self) -> None:
        one_of("interpolation", self.interpolation, get_args(BetweenSamples))
        times = check_record_times("times", self.times)
        set_fields(self, times=tuple(times.tolist()))
        for name in _AXES_OF_RECORDS:
            set_fields(self, **{name: _check_samples(name, getattr(self, name), len(times))})
        if not any(getattr(self, name) for name in _AXES_OF_RECORDS):
            bound, remedy = "no direction has an acceleration", "give one at least, such as along_n2"
            raise InvalidValue(", ".join(_AXES_OF_RECORDS), (), bound, remedy)
        self.keep_rotation()

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        given = (getattr(self, name) for name in ("times", *_AXES_OF_RECORDS, "rotation", "interpolation"))
        return type(self), tuple(given)  # the cached splines are not pickled

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Inner times of the record and breakpoints of the rotation [s]."""
        return tuple(np.union1d(self.times[1:-1], self.turning.breakpoints).tolist())

    @property
    def end(self) -> float:
        """Last time of the record, or end of the rotation if that is earlier [s]."""
        return min(self.times[-1], self.turning.end)

    def at(self, t: np.ndarray) -> MotionSample:
        """Sample the motion at times t [s], of any shape."""
        t = check_times(t, self.end)
        sample = self.turning.at(t)
        for axis, name in enumerate(_AXES_OF_RECORDS):
            if given := getattr(self, name):
                between = self._splines[name](t) if self._splines else np.interp(t, self.times, given)
                sample.carrier_acceleration[..., axis] = between
        return sample

    @cached_property
    def _splines(self) -> dict[str, CubicSpline]:
        """Cubic splines through the record, by axis; empty for linear interpolation."""
        if self.interpolation == "linear":
            return {}
        from scipy.interpolate import CubicSpline

        return {
            name: CubicSpline(self.times, given)
            for name in _AXES_OF_RECORDS
            if (given := getattr(self, name))
        }


def check_record_times(name: str, given: Sequence[float] | np.ndarray) -> np.ndarray:
    """Check the times of a record, and return them as an array.

    Raises
    ------
    InvalidValue
        If there are fewer than two, they do not ascend from 0, or an interval is longer than the others.
    """
    times = real_array(name, given)
    if len(times) < 2:
        raise InvalidValue(name, given, "a record has at least two samples")
    intervals = np.diff(times)
    bound, remedy = "it follows {limit}", "sort the record, drop repeats"
    refuse(intervals <= 0, name, times[1:], "s", bound, remedy, limit=times[:-1])
    refuse(times[0] != 0, name, times[0], "s", "a motion begins at t = 0", f"subtract {times[0]:g} s")
    usual = float(np.median(intervals))
    bound = f"samples are missing after {{limit}}: other intervals are {usual:.6g} s"
    remedy = "fill the gap, or cut the record there"
    refuse(intervals > _GAP * usual, name, times[1:], "s", bound, remedy, limit=times[:-1])
    return times


def _check_samples(name: str, given: Sequence[float], count: int) -> tuple[float, ...]:
    """Check recorded accelerations: one for each time, or none at all."""
    samples = real_array(name, given)
    if len(samples) not in (0, count):
        bound = f"{len(samples)} accelerations at {count} times"
        raise InvalidValue(name, tuple(samples[:3].tolist()), bound, "give one for each time")
    refuse(np.abs(samples) > MOST, name, samples, "m/s2", "give at most {limit} either way", limit=MOST)
    return tuple(samples.tolist())
