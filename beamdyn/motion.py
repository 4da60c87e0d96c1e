"""Motions of the carrier: its angle, speed and acceleration, and the acceleration of its centre.

A rotation turns about a fixed centre; a rolling wheel also travels, as far as its rotation says.
Angles are not reduced to one turn: a double holds 1e8 rad to 1.5e-8 rad, and phases that follow from
the angle (of the road, of gravity) to no more.  At a jump, values are those after it.
"""

from __future__ import annotations

import math
import pickle
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal, Self, get_args

import numpy as np

from beamdyn.common.checks import kind, positive, real, real_array

if TYPE_CHECKING:  # scipy.interpolate is slow to import, and only tables need it
    from scipy.interpolate import PPoly

_ROUNDING = 1e-12  # a time past the end by less, relative to the end, is its rounding
_CHECKS = 1000  # times at which functions are compared with their derivatives
_STEP = 1e-7  # of the finite differences, relative to the interval
_ZOOMS = 3  # into a step that does not fit, before it is called a jump
_MISFIT = 1e-6  # allowed, relative to the largest derivative

Turning = tuple[np.ndarray, np.ndarray, np.ndarray]  # angle, speed, acceleration


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


@dataclass(frozen=True)
class Line:
    """A frequency excited at steady speed, as seen on the rotating carrier.

    Parameters
    ----------
    name : str
        What excites it.
    multiple : float
        The frequency as a multiple of the speed.
    """

    name: str
    multiple: float


class Motion(ABC):
    """What a motion answers, with what holds unless it says otherwise.

    Motions are hashable and, unless made from functions, picklable.
    """

    @abstractmethod
    def at(self, t: np.ndarray) -> MotionSample:
        """The motion at times t [s], of any shape."""

    @abstractmethod
    def with_speed(self, speed: float) -> Self:
        """The same motion at another final speed [rad/s]."""

    @property
    @abstractmethod
    def final_speed(self) -> float:
        """Speed at the end [rad/s]; nan if not known."""

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Times after 0 at which the motion or one of its derivatives jumps [s]."""
        return ()

    @property
    def settled(self) -> float:
        """Time from which the speed is constant [s], inf if never."""
        return math.inf

    @property
    def end(self) -> float:
        """Time up to which the motion is defined [s], inf if for ever."""
        return math.inf

    @property
    def lines(self) -> tuple[Line, ...]:
        """Frequencies that the translation excites at steady speed; gravity's is not among them."""
        return ()

    @property
    def road_multiple(self) -> float | None:
        """Phase of the road per angle of rotation, None if there is no road."""
        return None

    @property
    def picklable(self) -> bool:
        """Whether it can be stored and sent to other processes."""
        try:
            pickle.dumps(self)
        except Exception:  # which one depends on what the functions hold
            return False
        return True

    def road_acceleration(self, speed: float) -> float:
        """Largest acceleration by the road at a steady speed [m/s2]."""
        return 0.0

    def steady_acceleration(
        self, speed: np.ndarray | float, rotation: np.ndarray | float, road: np.ndarray | float
    ) -> np.ndarray:
        """Acceleration of the carrier's centre at steady speed, as a function of two phases.

        Parameters
        ----------
        speed : ndarray
            Speed [rad/s].
        rotation, road : ndarray
            Angle theta of the carrier [rad], and phase chi of the road [rad]: `road_multiple` theta
            plus any constant.

        Returns
        -------
        ndarray, shape (..., 3)
            Along n1, n2, n3 [m/s2], over the shape that the arguments broadcast to.
        """
        return np.zeros((*np.broadcast_shapes(*map(np.shape, (speed, rotation, road))), 3))


# Rotations ----------------------------------------------------------------------------------------


class Rotation(Motion):
    """Rotation about a fixed centre: a subclass gives `turning`, `final_speed` and `with_speed`."""

    @abstractmethod
    def turning(self, t: np.ndarray) -> Turning:
        """Angle [rad], speed [rad/s] and acceleration [rad/s2] at times t [s]."""

    def at(self, t: np.ndarray) -> MotionSample:
        """The motion at times t [s], of any shape."""
        t = _within(t, self.end)
        return MotionSample(*self.turning(t), np.zeros((*t.shape, 3)))


@dataclass(frozen=True)
class SteadyRotation(Rotation):
    """Rotation at constant speed about a fixed centre.

    Parameters
    ----------
    speed : float
        Speed [rad/s].
    """

    speed: float

    def __post_init__(self) -> None:
        _keep(self, speed=real("speed", self.speed, "rad/s"))

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

    speed: float
    duration: float
    law: Law = "smooth"

    def __post_init__(self) -> None:
        _choice("law", self.law, Law)
        remedy = "for a constant speed from the start give SteadyRotation(speed)"
        duration = positive("duration", self.duration, "s", remedy)
        _keep(self, speed=real("speed", self.speed, "rad/s"), duration=duration)

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

    times: Sequence[float]
    speeds: Sequence[float]
    interpolation: Interpolation = "cubic"

    def __post_init__(self) -> None:
        _choice("interpolation", self.interpolation, Interpolation)
        times, speeds = _table(self.times, self.speeds)
        _keep(self, times=tuple(times.tolist()), speeds=tuple(speeds.tolist()))

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
    late = np.diff(t) <= 0
    if late.any():
        k = int(late.argmax())
        raise ValueError(f"times: {t[k]:g} is followed by {t[k + 1]:g} s; sort the table, drop repeats")
    if t[0] != 0:
        raise ValueError(f"times begin at {t[0]:g} s; a motion begins at t = 0: subtract {t[0]:g} s from all")
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
                raise ValueError(f"{name} = {getattr(self, name)!r}: give a function of the time")
        t_end, scale = positive("t_end", self.t_end, "s"), real("scale", self.scale)
        _keep(self, t_end=t_end, scale=scale, breakpoints=_breakpoints(self.breakpoints))
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


# Translations -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class RoadWave:
    """A sine along the road, given by its height or by the vertical velocity of the wheel on it.

    Parameters
    ----------
    wavelength : float
        Wavelength lambda [m].
    velocity_amplitude : float, optional
        Amplitude C of the vertical velocity, C sin(2 pi x / lambda) at the distance x travelled [m/s].
        Lee and Yoo (2019), (3), where it is called an amplitude of the road; the same at any speed.
    height : float, optional
        Amplitude A of the road's height, A sin(2 pi x / lambda) [m].

    Raises
    ------
    ValueError
        If the wavelength is not positive, or not exactly one of the amplitudes is given.
    """

    wavelength: float
    velocity_amplitude: float | None = None
    height: float | None = None

    def __post_init__(self) -> None:
        _keep(self, wavelength=positive("wavelength", self.wavelength, "m"))
        given = {"velocity_amplitude": (self.velocity_amplitude, "m/s"), "height": (self.height, "m")}
        given = {name: value for name, value in given.items() if value[0] is not None}
        if len(given) != 1:
            found = " and ".join(f"{name} = {value!r}" for name, (value, _) in given.items())
            raise ValueError(
                f"{found or 'neither velocity_amplitude nor height'} given: give exactly one, "
                "velocity_amplitude [m/s] of the wheel or height [m] of the road"
            )
        for name, (value, unit) in given.items():
            _keep(self, **{name: real(name, value, unit)})

    @property
    def wavenumber(self) -> float:
        """Phase per distance travelled [rad/m]."""
        return 2 * math.pi / self.wavelength

    def acceleration(
        self, phase: np.ndarray, velocity: np.ndarray, acceleration: np.ndarray | float = 0.0
    ) -> np.ndarray:
        """Vertical acceleration [m/s2] of a wheel on it.

        Parameters
        ----------
        phase : ndarray
            Distance travelled times `wavenumber` [rad].
        velocity, acceleration : ndarray
            Of the travel along the road [m/s], [m/s2].
        """
        k = self.wavenumber
        if self.velocity_amplitude is not None:
            return self.velocity_amplitude * k * velocity * np.cos(phase)
        assert self.height is not None
        return self.height * k * (acceleration * np.cos(phase) - k * velocity**2 * np.sin(phase))

    def largest_acceleration(self, velocity: float) -> float:
        """Amplitude of the vertical acceleration at a constant velocity along the road [m/s2]."""
        peak = 0.0 if self.velocity_amplitude is not None else math.pi / 2
        return abs(float(self.acceleration(np.array(peak), np.array(velocity))))


@dataclass(frozen=True)
class RollingWheel(Motion):
    """A wheel that rolls along n1, on a flat or a wavy road.

    Parameters
    ----------
    rolling_radius : float
        Distance R travelled per angle turned [m]; the centre moves with R omega along n1.
    speed : float or Rotation
        Constant speed [rad/s], or how the wheel turns.
    road : RoadWave, optional
        Moves the centre along n2; its phase is that of the distance travelled, 2 pi R theta / lambda.

    Raises
    ------
    ValueError
        If the radius is not positive, or the speed is neither a number nor a rotation.
    """

    rolling_radius: float
    speed: float | Rotation
    road: RoadWave | None = None

    def __post_init__(self) -> None:
        _keep(self, rolling_radius=positive("rolling_radius", self.rolling_radius, "m"))
        if not isinstance(self.speed, Rotation):
            remedy = "or a rotation, such as SpinUp(speed, duration)"
            _keep(self, speed=SteadyRotation(real("speed", self.speed, "rad/s", remedy)))
        if self.road is not None:
            kind("road", self.road, RoadWave, "road = RoadWave(wavelength=0.3, height=0.001)")

    @property
    def rotation(self) -> Rotation:
        """How the wheel turns."""
        assert isinstance(self.speed, Rotation)
        return self.speed

    @property
    def final_speed(self) -> float:
        """Speed at the end [rad/s]."""
        return self.rotation.final_speed

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Times at which a derivative of the rotation jumps [s]."""
        return tuple(self.rotation.breakpoints)

    @property
    def settled(self) -> float:
        """Time from which the speed is constant [s], inf if never."""
        return self.rotation.settled

    @property
    def end(self) -> float:
        """Time up to which the rotation is defined [s], inf if for ever."""
        return self.rotation.end

    @property
    def road_multiple(self) -> float | None:
        """Waves of the road per turn, 2 pi R / lambda; None on a flat road."""
        return None if self.road is None else self.rolling_radius * self.road.wavenumber

    @property
    def lines(self) -> tuple[Line, ...]:
        """The road's frequency, split by the rotation."""
        if (kappa := self.road_multiple) is None:
            return ()
        return Line("road +", kappa + 1), Line("road -", abs(kappa - 1))

    def at(self, t: np.ndarray) -> MotionSample:
        """The motion at times t [s], of any shape."""
        sample, R = self.rotation.at(t), self.rolling_radius
        sample.carrier_acceleration[..., 0] = R * sample.acceleration
        if self.road is not None:
            phase = self.road.wavenumber * R * sample.angle
            vertical = self.road.acceleration(phase, R * sample.speed, R * sample.acceleration)
            sample.carrier_acceleration[..., 1] = vertical
        return sample

    def with_speed(self, speed: float) -> RollingWheel:
        """The same wheel at another final speed [rad/s]."""
        return replace(self, speed=self.rotation.with_speed(speed))

    def road_acceleration(self, speed: float) -> float:
        """Largest acceleration by the road at a steady speed [m/s2]; past g the wheel leaves the road."""
        return 0.0 if self.road is None else self.road.largest_acceleration(self.rolling_radius * speed)

    def steady_acceleration(
        self, speed: np.ndarray | float, rotation: np.ndarray | float, road: np.ndarray | float
    ) -> np.ndarray:
        """Acceleration of the centre at steady speed: see `Motion.steady_acceleration`."""
        total = super().steady_acceleration(speed, rotation, road)
        if self.road is not None:
            velocity = self.rolling_radius * np.asarray(speed, dtype=float)
            total[..., 1] = self.road.acceleration(np.asarray(road, dtype=float), velocity)
        return total


@dataclass(frozen=True)
class UserMotion(Motion):
    """Any motion, as a function of time.

    Made from a lambda it is not `picklable`: workers and stores need a function defined in a module.
    Nothing is known of its steady state: it can be simulated, no more.

    Parameters
    ----------
    function : callable
        Takes an array of times [s], returns a `MotionSample`.
    breakpoints : tuple of float
        Times at which the motion or one of its derivatives jumps [s].
    t_end : float
        Time up to which it is defined [s]; if finite, the motion is checked up to there at once.

    Raises
    ------
    ValueError
        If the function does not return the motion at all times, or speed and acceleration are not
        the derivatives of angle and speed.
    """

    function: Callable[[np.ndarray], MotionSample]
    breakpoints: tuple[float, ...] = ()  # pyright: ignore[reportIncompatibleMethodOverride, reportIncompatibleVariableOverride, reportAssignmentType]
    t_end: float = math.inf

    def __post_init__(self) -> None:
        if not callable(self.function):
            raise ValueError(f"function = {self.function!r}: give a function that returns a MotionSample")
        _keep(self, breakpoints=_breakpoints(self.breakpoints))
        if self.t_end != math.inf:
            _keep(self, t_end=positive("t_end", self.t_end, "s"))
            check_consistent(self, self.t_end)

    @property
    def final_speed(self) -> float:
        """Speed at `t_end` [rad/s]; nan if that is not given."""
        return float(self.at(np.array(self.t_end)).speed) if self.t_end < math.inf else math.nan

    @property
    def end(self) -> float:
        """Time up to which the motion is defined [s], inf if for ever."""
        return self.t_end

    def at(self, t: np.ndarray) -> MotionSample:
        """The motion at times t [s], of any shape."""
        t = _within(t, self.t_end)
        sample = self.function(t)
        if not isinstance(sample, MotionSample):
            raise ValueError(f"function(t) returned a {type(sample).__name__}: let it return a MotionSample")
        shapes = {"angle": t.shape, "speed": t.shape, "acceleration": t.shape}
        for name, shape in (shapes | {"carrier_acceleration": (*t.shape, 3)}).items():
            if np.shape(getattr(sample, name)) != shape:
                found = np.shape(getattr(sample, name))
                raise ValueError(
                    f"function(t): {name} has shape {found}; make it {shape}, as t {t.shape} asks"
                )
        return sample

    def with_speed(self, speed: float) -> UserMotion:
        """Refused: a function of time says nothing about other speeds."""
        raise ValueError(
            f"with_speed({speed:g}): a UserMotion has one speed only; make one for each speed, "
            "or use RollingWheel with a rotation"
        )

    def steady_acceleration(
        self, speed: np.ndarray | float, rotation: np.ndarray | float, road: np.ndarray | float
    ) -> np.ndarray:
        """Refused: a function of time says nothing about a steady state."""
        raise ValueError("a UserMotion has no known steady state; simulate it, or use RollingWheel")


# Checks -------------------------------------------------------------------------------------------


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


def _within(t: np.ndarray, end: float) -> np.ndarray:
    """Times as an array, if none is past the end of the motion or, where it has one, before 0."""
    t = np.asarray(t, dtype=float)
    if end == math.inf or not t.size:
        return t
    slack = _ROUNDING * end
    if t.max() > end + slack:
        raise ValueError(
            f"t = {t.max():.9g} s: the motion ends at {end:.9g} s; give t_end = {end:.9g} or less, "
            "or define the motion for longer"
        )
    if t.min() < -slack:
        raise ValueError(f"t = {t.min():.9g} s: the motion begins at 0; give times of 0 or more")
    return t


def _breakpoints(given: Sequence[float]) -> tuple[float, ...]:
    return tuple(np.unique(real_array("breakpoints", given)).tolist())


def _choice(name: str, given: object, choices: object) -> None:
    if given not in get_args(choices):
        raise ValueError(f"{name} = {given!r}: give {' or '.join(map(repr, get_args(choices)))}")


def _keep(instance: object, **values: object) -> None:
    """Set fields of a frozen dataclass, while it is made."""
    for name, value in values.items():
        object.__setattr__(instance, name, value)
