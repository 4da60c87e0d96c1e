"""Rotations about a fixed centre: steady, spin-up, tabulated, or given by functions."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal, Self, get_args

import numpy as np

from beamdyn.common.inputs import checks
from beamdyn.common.inputs.described import Described
from beamdyn.scene.motion import base

if TYPE_CHECKING:  # scipy.interpolate is slow to import, and only tables need it
    from scipy.interpolate import PPoly


class Rotation(base.Motion):
    """Base class of rotations about a fixed centre.

    Examples
    --------
    >>> isinstance(bd.SpinUp(55.0, duration=10.0), bd.Rotation)
    True
    """

    @abstractmethod
    def kinematics(self, t: np.ndarray) -> base.Kinematics:
        """Compute angle [rad], speed [rad/s] and acceleration [rad/s2] at times t [s]."""

    def at(self, t: np.ndarray) -> base.MotionSample:
        """Sample the motion at times t [s], of any shape."""
        t = base.check_times(t, self.end)
        return base.MotionSample(*self.kinematics(t), np.zeros((*t.shape, 3)))


@dataclass(frozen=True)
class TurningMotion(base.Motion):
    """Base class of motions with a moving centre; a field holds the carrier's `Rotation`.

    Examples
    --------
    >>> bd.ShakenCarrier(frequency=5.0, along_n1=2.0, rotation=bd.SteadyRotation(50.0)).turning.final_speed
    50.0
    """

    turned_by: ClassVar[str] = "rotation"  # name of the field that holds the rotation

    def keep_rotation(self) -> None:
        """Check the field with the rotation; replace a speed [rad/s] in it by a steady rotation."""
        given = getattr(self, self.turned_by)
        if not isinstance(given, Rotation):
            speed = checks.real(
                self.turned_by, given, "rad/s", "or a rotation, such as SpinUp(speed, duration)"
            )
            checks.set_fields(self, **{self.turned_by: SteadyRotation(speed)})

    @property
    def turning(self) -> Rotation:
        """Rotation of the carrier."""
        return getattr(self, self.turned_by)

    @property
    def final_speed(self) -> float:
        """Speed at the end of the rotation [rad/s]."""
        return self.turning.final_speed

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Times at which the rotation or one of its derivatives jumps [s]."""
        return tuple(self.turning.breakpoints)

    @property
    def steady_start(self) -> float:
        """Time from which the speed is constant [s], inf if never."""
        return self.turning.steady_start

    @property
    def end(self) -> float:
        """Time up to which the rotation is defined [s]; inf if it has no end."""
        return self.turning.end

    def with_speed(self, speed: float) -> Self:
        """Copy the motion with another final speed [rad/s]; all else stays the same."""
        return replace(self, **{self.turned_by: self.turning.with_speed(speed)})


@dataclass(frozen=True)
class SteadyRotation(Rotation):
    """Rotation at constant speed about a fixed centre.

    Parameters
    ----------
    speed : float
        Speed [rad/s].

    Examples
    --------
    >>> motion = bd.SteadyRotation(50.0)  # rad/s
    >>> float(motion.at(np.array([0.1])).angle[0])  # rad
    5.0
    """

    is_uniform: ClassVar[bool] = True
    speed: Annotated[float, Described("rad/s", "omega", "angular speed of the carrier")]

    def __post_init__(self) -> None:
        checks.set_fields(self, speed=checks.moderate("speed", self.speed, "rad/s"))

    @property
    def final_speed(self) -> float:
        """Constant speed of the rotation [rad/s]."""
        return self.speed

    @property
    def steady_start(self) -> float:
        """Time from which the speed is constant: 0 s."""
        return 0.0

    @property
    def rates(self) -> tuple[float, ...]:
        """Rate of the rotation, which is its speed [rad/s]: see `Motion.rates`."""
        return (self.speed,)

    def kinematics(self, t: np.ndarray) -> base.Kinematics:
        """Compute angle [rad], speed [rad/s] and acceleration [rad/s2] at times t [s]."""
        return self.speed * t, np.full(t.shape, self.speed), np.zeros(t.shape)

    def with_speed(self, speed: float) -> SteadyRotation:
        """Copy the rotation with another speed [rad/s]."""
        return SteadyRotation(speed)


Law = Literal["smooth", "linear"]


@dataclass(frozen=True)
class SpinUp(Rotation):
    """Rotation about a fixed centre that spins up from rest at t = 0 to a constant speed.

    Parameters
    ----------
    speed : float
        Final speed [rad/s].
    duration : float
        Duration T of the spin-up [s].
    law : "smooth" or "linear"
        Speed relative to the final speed, at x = t/T: x - sin(2 pi x)/(2 pi) if "smooth", x if "linear".

    Raises
    ------
    ValueError
        If the duration is not positive, the speed is not finite, or the law is unknown.

    References
    ----------
    Kane, Ryan and Banerjee (1987), the smooth law; the others: standard.

    Examples
    --------
    >>> motion = bd.SpinUp(55.0, duration=10.0)
    >>> np.round(motion.at(np.array([0.0, 5.0, 10.0])).speed, 2)  # rad/s
    array([ 0. , 27.5, 55. ])
    """

    speed: Annotated[float, Described("rad/s", "omega_s", "angular speed of the carrier")]
    duration: Annotated[float, Described("s", "T", "time that the spin-up takes", above=0)]
    law: Annotated[Law, Described(meaning="law of the spin-up")] = "smooth"

    def __post_init__(self) -> None:
        checks.one_of("law", self.law, get_args(Law))
        remedy = "for a constant speed from the start give SteadyRotation(speed)"
        duration = checks.size("duration", self.duration, "s", remedy)
        checks.set_fields(self, speed=checks.moderate("speed", self.speed, "rad/s"), duration=duration)

    @property
    def final_speed(self) -> float:
        """Constant speed after the spin-up [rad/s]."""
        return self.speed

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Time at which the spin-up ends [s]."""
        return (self.duration,)

    @property
    def steady_start(self) -> float:
        """Time at which the spin-up ends [s]."""
        return self.duration

    def kinematics(self, t: np.ndarray) -> base.Kinematics:
        """Compute angle [rad], speed [rad/s] and acceleration [rad/s2] at times t [s]."""
        x = np.clip(t / self.duration, 0.0, 1.0)
        # If all times are after the spin-up, its law is evaluated only once, at its end.
        after_its_end = x.ndim and x.size and x.min() == 1
        angle, speed, acceleration = _LAWS[self.law](np.ones(1) if after_its_end else x)
        # Time at constant speed counts from the spin-up's end: the angle is continuous to the last digit.
        angle = self.speed * (self.duration * angle + np.maximum(t - self.duration, 0.0))
        acceleration = np.where((t >= 0) & (t < self.duration), acceleration, 0.0)
        return angle, np.broadcast_to(self.speed * speed, t.shape), self.speed / self.duration * acceleration

    def with_speed(self, speed: float) -> SpinUp:
        """Copy the spin-up with another final speed [rad/s] and the same duration."""
        return replace(self, speed=speed)


def _smooth(x: np.ndarray) -> base.Kinematics:
    """Compute the integral, value and derivative of the speed x - sin(2 pi x)/(2 pi), for 0 <= x <= 1."""
    y, sine = np.pi * x, np.sin(np.pi * x)
    # x^2/2 - sin(pi x)^2/(2 pi^2) as a product, because the difference cancels at small x.
    integral = _angle_minus_sine(y, sine) * (y + sine) / (2 * np.pi**2)
    return integral, _angle_minus_sine(2 * y, np.sin(2 * y)) / (2 * np.pi), 2 * sine**2


def _linear(x: np.ndarray) -> base.Kinematics:
    """Compute the integral, value and derivative of a speed that is linear in x."""
    return x**2 / 2, x, np.ones_like(x)


_LAWS: dict[str, Callable[[np.ndarray], base.Kinematics]] = {"smooth": _smooth, "linear": _linear}


def _angle_minus_sine(y: np.ndarray, sine: np.ndarray) -> np.ndarray:
    """Compute y - sin(y) for y >= 0 from y and its sine; by a Taylor series for y < 1, where these cancel."""
    y = np.asarray(y)
    difference = np.asarray(y - sine)
    below = y < 1
    if below.any():
        small = y[below]
        square, series = small**2, np.zeros_like(small)
        for n in range(8, -1, -1):
            series *= square
            series += (-1) ** n / math.factorial(2 * n + 3)
        difference[below] = square * small * series
    return difference


Interpolation = Literal["cubic", "pchip"]


@dataclass(frozen=True)
class SampledRotation(Rotation):
    """Rotation about a fixed centre with a tabulated speed.

    The angle is the exact integral of the interpolated speed, the acceleration its derivative.

    Parameters
    ----------
    times : sequence of float
        Times [s], ascending from 0.
    speeds : sequence of float
        Speeds at these times [rad/s].
    interpolation : "cubic" or "pchip"
        Cubic spline, for smooth data, or monotone cubics, which do not overshoot at corners.

    Raises
    ------
    ValueError
        If the times do not ascend from 0, a value is not finite, or the numbers of times and speeds differ.

    Examples
    --------
    >>> motion = bd.SampledRotation([0.0, 1.0, 2.0], [0.0, 30.0, 40.0], interpolation="pchip")
    >>> np.round(motion.at(np.array([1.0, 2.0])).speed, 6)
    array([30., 40.])
    """

    times: Sequence[Annotated[float, Described("s", "t", "times of the table, from 0")]]
    speeds: Sequence[Annotated[float, Described("rad/s", "omega", "speeds at these times")]]
    interpolation: Annotated[
        Interpolation, Described(meaning="cubic spline, or cubics that do not overshoot")
    ] = "cubic"

    def __post_init__(self) -> None:
        checks.one_of("interpolation", self.interpolation, get_args(Interpolation))
        t, v = checks.real_array("times", self.times), checks.real_array("speeds", self.speeds)
        if len(t) != len(v) or len(t) < 2:
            raise ValueError(f"times, speeds: {len(t)} times and {len(v)} speeds; give as many, at least two")
        bound, remedy = "it follows {limit}", "sort the table, drop repeats"
        checks.refuse(np.diff(t) <= 0, "times", t[1:], "s", bound, remedy, limit=t[:-1])
        checks.refuse(
            t[0] != 0, "times", t[0], "s", "a motion begins at t = 0", f"subtract {t[0]:g} s from all"
        )
        checks.set_fields(self, times=tuple(t.tolist()), speeds=tuple(v.tolist()))

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return type(self), (self.times, self.speeds, self.interpolation)  # the cached splines are not pickled

    @property
    def final_speed(self) -> float:
        """Last speed of the table [rad/s]."""
        return self.speeds[-1]

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Inner times of the table [s], where the pieces of the interpolation meet."""
        return tuple(self.times[1:-1])

    @property
    def steady_start(self) -> float:
        """Time from which the interpolated speed is constant [s]; inf if never, as splines oscillate."""
        # Number of equal speeds at the end of the table.
        equal = np.cumprod(np.equal(self.speeds, self.final_speed)[::-1]).sum()
        constant = equal == len(self.times) or (equal > 1 and self.interpolation == "pchip")
        return self.times[-equal] if constant else math.inf

    @property
    def end(self) -> float:
        """Last time of the table [s]."""
        return self.times[-1]

    def kinematics(self, t: np.ndarray) -> base.Kinematics:
        """Compute angle [rad], speed [rad/s] and acceleration [rad/s2] at times t [s]."""
        angle, speed, acceleration = self._splines
        return angle(t), speed(t), acceleration(t)

    @cached_property
    def _splines(self) -> tuple[PPoly, PPoly, PPoly]:
        from scipy.interpolate import CubicSpline, PchipInterpolator

        interpolate = CubicSpline if self.interpolation == "cubic" else PchipInterpolator
        speed = interpolate(self.times, self.speeds)
        return speed.antiderivative(), speed, speed.derivative()

    def with_speed(self, speed: float) -> SampledRotation:
        """Copy the rotation with all speeds scaled so that the last is another speed [rad/s]."""
        _check_scalable(self.final_speed)
        return replace(self, speeds=[v / self.final_speed * speed for v in self.speeds])


def _check_scalable(final_speed: float) -> None:
    """Raise a ValueError for a final speed of 0, which cannot be scaled to another."""
    if final_speed == 0:
        raise ValueError(
            "with_speed: this motion ends at rest, so that no factor leads to another final speed; "
            "make a motion for each speed"
        )


@dataclass(frozen=True)
class RotationFunction(Rotation):
    """Rotation about a fixed centre given by functions of time, whose consistency is checked at construction.

    Lambdas are not `picklable`: workers and stores need functions defined in a module.

    Parameters
    ----------
    angle, speed, acceleration : callable
        Functions of an array of times [s]: angle [rad], speed [rad/s] and acceleration [rad/s2].
    t_end : float
        Time up to which the functions are checked and the motion is defined [s].
    breakpoints : tuple of float
        Times at which one of the functions, or of their derivatives, jumps or has a kink [s].
    scale : float
        Factor that multiplies all three functions.

    Raises
    ------
    ValueError
        If a function is not vectorised or not finite, or the speed or the acceleration is not the
        derivative of the function before it.

    Examples
    --------
    >>> motion = bd.RotationFunction(
    ...     angle=lambda t: 5 * t**2, speed=lambda t: 10 * t, acceleration=lambda t: 10 + 0 * t, t_end=2.0
    ... )
    >>> float(motion.at(np.array([1.0])).speed[0])  # rad/s
    10.0
    """

    angle: Callable[[np.ndarray], np.ndarray | float]
    speed: Callable[[np.ndarray], np.ndarray | float]
    acceleration: Callable[[np.ndarray], np.ndarray | float]
    t_end: float
    breakpoints: tuple[float, ...] = ()  # pyright: ignore[reportIncompatibleMethodOverride, reportIncompatibleVariableOverride, reportAssignmentType]
    scale: float = 1.0

    def __post_init__(self) -> None:
        for name in ("angle", "speed", "acceleration"):
            checks.function(name, getattr(self, name), "it takes an array of times [s]")
        t_end, scale = checks.size("t_end", self.t_end, "s"), checks.moderate("scale", self.scale)
        checks.set_fields(self, t_end=t_end, scale=scale, breakpoints=base.as_breakpoints(self.breakpoints))
        base.check_consistent(self, t_end)

    @property
    def final_speed(self) -> float:
        """Speed at `t_end` [rad/s]."""
        return float(self.kinematics(np.array(self.t_end))[1])

    @property
    def end(self) -> float:
        """Time up to which the motion is defined [s]."""
        return self.t_end

    def kinematics(self, t: np.ndarray) -> base.Kinematics:
        """Compute angle [rad], speed [rad/s] and acceleration [rad/s2] at times t [s]."""
        functions = ("angle", self.angle), ("speed", self.speed), ("acceleration", self.acceleration)
        angle, speed, acceleration = (self.scale * _evaluate(name, f, t) for name, f in functions)
        return angle, speed, acceleration

    def with_speed(self, speed: float) -> RotationFunction:
        """Copy the rotation with all functions scaled so that it ends at another speed [rad/s]."""
        _check_scalable(self.final_speed)
        return replace(self, scale=self.scale * checks.real("speed", speed, "rad/s") / self.final_speed)


def _evaluate(name: str, function: Callable, t: np.ndarray) -> np.ndarray:
    """Evaluate a user's function, which may return a constant, at times t [s]."""
    try:
        with np.errstate(all="ignore"):  # `check_consistent` refuses values that are not finite
            values = np.asarray(function(t), dtype=float)
    except Exception as error:  # any exception that a user's function may raise
        raise ValueError(f"{name}: the function failed on an array of times ({error}); use numpy") from error
    if values.shape not in ((), t.shape):
        raise ValueError(
            f"{name}: the function returned shape {values.shape} for times of shape {t.shape}; "
            "it must be vectorised: take and return arrays of one shape"
        )
    return values + np.zeros(t.shape)
