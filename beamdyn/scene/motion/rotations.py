"""Rotations about a fixed centre."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Literal, get_args

import numpy as np

from beamdyn.common.checks import InvalidValue, one_of, positive, real, real_array, refuse
from beamdyn.common.described import Described
from beamdyn.scene.motion.base import (
    Motion,
    MotionSample,
    Turning,
    as_breakpoints,
    keep,
    within,
)
from beamdyn.scene.motion.checks import check_consistent

if TYPE_CHECKING:  # scipy.interpolate is slow to import, and only tables need it
    from scipy.interpolate import PPoly


class Rotation(Motion):
    """Rotation about a fixed centre: a subclass gives `turning`, `final_speed` and `with_speed`."""

    @abstractmethod
    def turning(self, t: np.ndarray) -> Turning:
        """Angle [rad], speed [rad/s] and acceleration [rad/s2] at times t [s]."""

    def at(self, t: np.ndarray) -> MotionSample:
        """The motion at times t [s], of any shape."""
        t = within(t, self.end)
        return MotionSample(*self.turning(t), np.zeros((*t.shape, 3)))


@dataclass(frozen=True)
class SteadyRotation(Rotation):
    """Rotation at constant speed about a fixed centre.

    Parameters
    ----------
    speed : float
        Speed [rad/s].
    """

    speed: Annotated[float, Described("rad/s", "omega", "angular speed of the carrier")]

    def __post_init__(self) -> None:
        keep(self, speed=real("speed", self.speed, "rad/s"))

    @property
    def final_speed(self) -> float:
        """The speed [rad/s]."""
        return self.speed

    @property
    def settled(self) -> float:
        """0 s: the speed is constant."""
        return 0.0

    def turning(self, t: np.ndarray) -> Turning:
        """Angle [rad], speed [rad/s] and acceleration [rad/s2] at times t [s]."""
        return self.speed * t, np.full(t.shape, self.speed), np.zeros(t.shape)

    def with_speed(self, speed: float) -> SteadyRotation:
        """Rotation at another speed [rad/s]."""
        return SteadyRotation(speed)


Law = Literal["smooth", "linear"]


@dataclass(frozen=True)
class SpinUp(Rotation):
    """From rest at t = 0 to a constant speed about a fixed centre.

    Parameters
    ----------
    speed : float
        Final speed [rad/s].
    duration : float
        Time T that it takes [s].
    law : "smooth" or "linear"
        Speed over x = t/T: final speed times x - sin(2 pi x)/(2 pi), or times x.

    Raises
    ------
    ValueError
        If the duration is not positive or there is no such law.
    """

    speed: Annotated[float, Described("rad/s", "omega_s", "angular speed of the carrier")]
    duration: Annotated[float, Described("s", "T", "time that the spin-up takes", above=0)]
    law: Annotated[Law, Described(meaning="law of the spin-up")] = "smooth"

    def __post_init__(self) -> None:
        one_of("law", self.law, get_args(Law))
        remedy = "for a constant speed from the start give SteadyRotation(speed)"
        duration = positive("duration", self.duration, "s", remedy)
        keep(self, speed=real("speed", self.speed, "rad/s"), duration=duration)

    @property
    def final_speed(self) -> float:
        """The speed after the spin-up [rad/s]."""
        return self.speed

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """The end of the spin-up [s]."""
        return (self.duration,)

    @property
    def settled(self) -> float:
        """The end of the spin-up [s]."""
        return self.duration

    def turning(self, t: np.ndarray) -> Turning:
        """Angle [rad], speed [rad/s] and acceleration [rad/s2] at times t [s]."""
        angle, speed, slope = _LAWS[self.law](np.clip(t / self.duration, 0.0, 1.0))
        # Constant time is counted from the end of the spin-up: the angle continues to the last digit.
        angle = self.speed * (self.duration * angle + np.maximum(t - self.duration, 0.0))
        slope = np.where((t >= 0) & (t < self.duration), slope, 0.0)
        return angle, self.speed * speed, self.speed / self.duration * slope

    def with_speed(self, speed: float) -> SpinUp:
        """A spin-up to another speed [rad/s] in the same time."""
        return replace(self, speed=speed)


def _smooth(x: np.ndarray) -> Turning:
    """Speed x - sin(2 pi x)/(2 pi) with its integral and derivative, on 0 <= x <= 1."""
    sine = np.sin(np.pi * x) / np.pi
    # x^2/2 - sin(pi x)^2/(2 pi^2), as a product: the difference would lose all digits at small x.
    integral = _minus_sine(np.pi * x) / np.pi * (x + sine) / 2
    return integral, _minus_sine(2 * np.pi * x) / (2 * np.pi), 2 * (np.pi * sine) ** 2


def _linear(x: np.ndarray) -> Turning:
    """Speed x with its integral and derivative."""
    return x**2 / 2, x, np.ones_like(x)


_LAWS: dict[str, Callable[[np.ndarray], Turning]] = {"smooth": _smooth, "linear": _linear}


def _minus_sine(y: np.ndarray) -> np.ndarray:
    """Difference y - sin(y) for y >= 0, by its Taylor series where the difference would cancel."""
    difference = y - np.sin(y)
    if y.size and y.min() >= 1:
        return difference
    small = np.minimum(y, 1.0)
    series = np.ones_like(small)
    for n in range(18, 2, -2):
        series = 1 - small**2 / (n * (n + 1)) * series
    return np.where(y < 1, small**3 / 6 * series, difference)


Interpolation = Literal["cubic", "pchip"]


@dataclass(frozen=True)
class SampledRotation(Rotation):
    """Rotation about a fixed centre by a table of speeds.

    The angle is the exact integral of the interpolated speed, the acceleration its derivative.

    Parameters
    ----------
    times : sequence of float
        Times [s], ascending from 0.
    speeds : sequence of float
        Speeds at these times [rad/s].
    interpolation : "cubic" or "pchip"
        A cubic spline, for smooth data, or monotone cubics, which do not overshoot at corners.

    Raises
    ------
    ValueError
        If the times do not ascend from 0, or there are not as many speeds as times.
    """

    times: Sequence[Annotated[float, Described("s", "t", "times of the table, from 0")]]
    speeds: Sequence[Annotated[float, Described("rad/s", "omega", "speeds at these times")]]
    interpolation: Annotated[
        Interpolation, Described(meaning="cubic spline, or cubics that do not overshoot")
    ] = "cubic"

    def __post_init__(self) -> None:
        one_of("interpolation", self.interpolation, get_args(Interpolation))
        times, speeds = _table(self.times, self.speeds)
        keep(self, times=tuple(times.tolist()), speeds=tuple(speeds.tolist()))

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return type(self), (self.times, self.speeds, self.interpolation)  # without the splines

    @property
    def final_speed(self) -> float:
        """The last speed of the table [rad/s]."""
        return self.speeds[-1]

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Times of the table between its ends [s]: there the pieces of the interpolation meet."""
        return tuple(self.times[1:-1])

    @property
    def settled(self) -> float:
        """Where the last speeds of the table are the same and not splined: their first time [s]; else inf."""
        same = np.cumprod(np.equal(self.speeds, self.final_speed)[::-1]).sum()
        constant = same == len(self.times) or (same > 1 and self.interpolation == "pchip")
        return self.times[-same] if constant else math.inf

    @property
    def end(self) -> float:
        """The last time of the table [s]."""
        return self.times[-1]

    def turning(self, t: np.ndarray) -> Turning:
        """Angle [rad], speed [rad/s] and acceleration [rad/s2] at times t [s]."""
        angle, speed, acceleration = self._splines
        return angle(t), speed(t), acceleration(t)

    @cached_property
    def _splines(self) -> tuple[PPoly, PPoly, PPoly]:
        from scipy.interpolate import CubicSpline, PchipInterpolator

        interpolate = CubicSpline if self.interpolation == "cubic" else PchipInterpolator
        speed = interpolate(self.times, self.speeds)
        return speed.antiderivative(), speed, speed.derivative()

    def with_speed(self, speed: float) -> SampledRotation:
        """The table with all speeds in proportion, so that it ends at another speed [rad/s]."""
        _check_scalable(self.final_speed)
        return replace(self, speeds=[v / self.final_speed * speed for v in self.speeds])


def _table(times: Sequence[float], speeds: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    """Times and speeds of a table, checked."""
    t, v = real_array("times", times), real_array("speeds", speeds)
    if len(t) != len(v) or len(t) < 2:
        raise ValueError(f"times, speeds: {len(t)} times and {len(v)} speeds; give as many, at least two")
    refuse(
        np.diff(t) <= 0,
        "times",
        t[1:],
        "s",
        "it follows {limit}",
        "sort the table, drop repeats",
        limit=t[:-1],
    )
    refuse(t[0] != 0, "times", t[0], "s", "a motion begins at t = 0", f"subtract {t[0]:g} s from all")
    return t, v


def _check_scalable(final_speed: float) -> None:
    if final_speed == 0:
        raise ValueError(
            "with_speed: this motion ends at rest, so that no factor leads to another final speed; "
            "make a motion for each speed"
        )


@dataclass(frozen=True)
class RotationFunction(Rotation):
    """Rotation about a fixed centre by functions of time, checked once against each other.

    Made from a lambda it is not `picklable`: workers and stores need functions defined in a module.

    Parameters
    ----------
    angle, speed, acceleration : callable
        Functions of an array of times [s]: angle [rad], its derivative [rad/s], and the next [rad/s2].
    t_end : float
        Time up to which they are checked and the motion is defined [s].
    breakpoints : tuple of float
        Times at which one of them, or a derivative, jumps or has a kink [s].
    scale : float
        Factor on all three.

    Raises
    ------
    ValueError
        If a function is not vectorised or finite, or is not the derivative of the one before.
    """

    angle: Callable[[np.ndarray], np.ndarray | float]
    speed: Callable[[np.ndarray], np.ndarray | float]
    acceleration: Callable[[np.ndarray], np.ndarray | float]
    t_end: float
    breakpoints: tuple[float, ...] = ()  # pyright: ignore[reportIncompatibleMethodOverride, reportIncompatibleVariableOverride, reportAssignmentType]
    scale: float = 1.0

    def __post_init__(self) -> None:
        for name in ("angle", "speed", "acceleration"):
            if not callable(getattr(self, name)):
                raise InvalidValue(name, getattr(self, name), "give a function of the time")
        t_end, scale = positive("t_end", self.t_end, "s"), real("scale", self.scale)
        keep(self, t_end=t_end, scale=scale, breakpoints=as_breakpoints(self.breakpoints))
        check_consistent(self, t_end)

    @property
    def final_speed(self) -> float:
        """The speed at `t_end` [rad/s]."""
        return float(self.turning(np.array(self.t_end))[1])

    @property
    def end(self) -> float:
        """Time up to which the motion was checked [s]."""
        return self.t_end

    def turning(self, t: np.ndarray) -> Turning:
        """Angle [rad], speed [rad/s] and acceleration [rad/s2] at times t [s]."""
        named = ("angle", self.angle), ("speed", self.speed), ("acceleration", self.acceleration)
        angle, speed, acceleration = (self.scale * _evaluate(name, f, t) for name, f in named)
        return angle, speed, acceleration

    def with_speed(self, speed: float) -> RotationFunction:
        """The motion with angle, speed and acceleration in proportion, to end at another speed [rad/s]."""
        _check_scalable(self.final_speed)
        return replace(self, scale=self.scale * real("speed", speed, "rad/s") / self.final_speed)


def _evaluate(name: str, function: Callable, t: np.ndarray) -> np.ndarray:
    """Values of a user's function; a constant stands for an array of them."""
    try:
        values = np.asarray(function(t), dtype=float)
    except Exception as error:  # whatever a user's function may raise
        raise ValueError(f"{name}: the function failed on an array of times ({error}); use numpy") from error
    if values.shape not in ((), t.shape):
        raise ValueError(
            f"{name}: the function returned shape {values.shape} for times of shape {t.shape}; "
            "it must be vectorised: take and return arrays of one shape"
        )
    return values + np.zeros(t.shape)
