"""Base class of motions, and checks of their input."""

from __future__ import annotations

import math
import pickle
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from beamdyn.common.inputs.checks import MOST, real_array
from beamdyn.common.results.one_line import OneLine
from beamdyn.common.words import Words
from beamdyn.scene.names_elsewhere import REPEATING, ROLLING_WHEEL

# Time after the end of a motion, relative to the end time, up to which it counts as the end.
_ROUNDING = 1e-12

Kinematics = tuple[np.ndarray, np.ndarray, np.ndarray]  # angle, speed and angular acceleration


@dataclass(frozen=True, eq=False)
class MotionSample:
    """Motion of the carrier at some times; all arrays have the shape of the times.

    Parameters
    ----------
    angle, speed, acceleration : ndarray
        Angle theta about -n3 [rad], n3 being the axis of rotation; speed omega = theta' [rad/s]; acceleration
        omega' [rad/s2].
    carrier_acceleration : ndarray, shape (..., 3)
        Acceleration of the centre of the carrier along the fixed directions n1, n2, n3 [m/s2].

    Examples
    --------
    >>> sample = bd.SteadyRotation(50.0).at(np.array([0.0, 0.1]))
    >>> sample.angle, sample.carrier_acceleration.shape
    (array([0., 5.]), (2, 3))
    """

    angle: np.ndarray
    speed: np.ndarray
    acceleration: np.ndarray
    carrier_acceleration: np.ndarray

    @classmethod
    def steady(cls, speed: np.ndarray | float) -> MotionSample:
        """Return samples of rotations at constant speeds [rad/s] about a fixed centre, at angle 0."""
        speed = np.asarray(speed, dtype=float)
        zero = np.zeros(speed.shape)
        return cls(zero, speed, zero, np.zeros((*speed.shape, 3)))


@dataclass(frozen=True)
class Line:
    """An excitation line: a frequency excited at steady speed, as seen on the rotating carrier.

    Parameters
    ----------
    name : str
        Source of the excitation.
    multiple : float
        The frequency as a multiple of the speed, a ratio.

    Examples
    --------
    >>> wheel = bd.RollingWheel(0.3, 55.0, bd.RoadWave(0.3, velocity_amplitude=0.01))
    >>> [(line.name, round(line.multiple, 3)) for line in wheel.lines]
    [('road +', 7.283), ('road -', 5.283)]
    """

    name: str
    multiple: float


class Motion(OneLine, ABC):
    """Base class of motions of the carrier; the defaults suit a smooth motion without end or road.

    In order to add a motion, write a subclass in a module of its own:

    1. It is a frozen dataclass: it is hashed, and pickled unless it is made from functions.  Its fields are
       ``Annotated[float, Described(unit, symbol, meaning, bounds)]``, from which its table in files and its
       form are made; `__post_init__` checks them.
    2. `at` takes times of any shape and returns angle, speed, acceleration and the carrier's acceleration;
       each is the derivative of the previous one.  A rotation about a fixed centre derives from `Rotation`.
    3. `with_speed` copies it with another final speed: sweeps and loci over speed need no more.
    4. `breakpoints` lists the times at which it or a derivative jumps: steps in time end there.
       `steady_start` is the time from which the speed is constant, `end` the last time.
    5. A translation that lasts at steady speed gives `lines`, `road_multiple`, `road_acceleration` and
       `steady_acceleration`, on which the steady response and the resonance speeds rest.
    6. A motion that repeats itself gives `rates`, on which its stability rests.
    7. To be available in files and forms, it must be listed in `KINDS` of `beamdyn.scene.motion.kinds`.

    Examples
    --------
    >>> isinstance(bd.SteadyRotation(50.0), bd.Motion)
    True
    """

    no_steady_state: ClassVar[str] = ""  # reason for no steady state, with a remedy; empty otherwise
    is_uniform: ClassVar[bool] = False  # whether it is a rotation at constant speed about a fixed centre

    @abstractmethod
    def at(self, t: np.ndarray) -> MotionSample:
        """Sample the motion at times t [s], of any shape."""

    @abstractmethod
    def with_speed(self, speed: float) -> Self:
        """Copy the motion with another final speed [rad/s]."""

    @property
    @abstractmethod
    def final_speed(self) -> float:
        """Speed at the end of the motion [rad/s]; nan if not known."""

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Times after 0 at which the motion or one of its derivatives jumps [s]."""
        return ()

    @property
    def steady_start(self) -> float:
        """Time from which the speed is constant [s], inf if never."""
        return math.inf

    @property
    def end(self) -> float:
        """Time up to which the motion is defined [s]; inf if it has no end."""
        return math.inf

    @property
    def lines(self) -> tuple[Line, ...]:
        """Excitation lines of the translation at steady speed, without the line of gravity."""
        return ()

    @property
    def road_multiple(self) -> float | None:
        """Number of waves of the road per turn of the wheel; None without a road."""
        return None

    @property
    def rates(self) -> tuple[float, ...]:
        """Rates [rad/s] of the phases in which the motion is periodic, the rate of rotation first.

        Raises
        ------
        ValueError
            If the motion does not repeat itself.
        """
        kind = type(self).__name__
        raise ValueError(Words(f"motion: a {kind} does not repeat itself; simulate it, or use ", REPEATING))

    @property
    def picklable(self) -> bool:
        """Whether the motion can be pickled, which stores and other processes require."""
        try:
            pickle.dumps(self)
        except Exception:  # the type of the exception depends on the user's functions
            return False
        return True

    def road_acceleration(self, speed: float) -> float:
        """Compute the wheel's largest acceleration by the road at steady speed [m/s2]; 0 without road."""
        return 0.0

    def steady_acceleration(
        self, speed: np.ndarray | float, rotation: np.ndarray | float, road: np.ndarray | float
    ) -> np.ndarray:
        """Compute the acceleration of the carrier's centre at steady speed, at phases of rotation and road.

        Parameters
        ----------
        speed : ndarray
            Speed [rad/s].
        rotation, road : ndarray
            Angle theta of the carrier [rad], and phase chi of the road [rad], `road_multiple` times theta
            plus any constant.

        Returns
        -------
        ndarray, shape (..., 3)
            Components along n1, n2, n3 [m/s2]; the leading shape is that of the broadcast arguments.

        Raises
        ------
        ValueError
            If the motion has no known steady state.
        """
        if why := self.no_steady_state:
            raise ValueError(Words(f"a {type(self).__name__} {why}, or use ", ROLLING_WHEEL))
        return np.zeros((*np.broadcast_shapes(*map(np.shape, (speed, rotation, road))), 3))


def check_times(t: np.ndarray, end: float) -> np.ndarray:
    """Convert times [s] to an array; refuse times beyond the end of a motion by a ValueError."""
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


def as_breakpoints(times: Sequence[float]) -> tuple[float, ...]:
    """Sort breakpoints [s] in ascending order, without repeats."""
    return tuple(np.unique(real_array("breakpoints", times)).tolist())


# Checks of consistency of a motion's functions ------------------------------------------------------


_SAMPLES = 1000  # number of times at which functions are compared with their derivatives
_STEP = 1e-7  # step of the finite differences, relative to the interval
# Number of refinements of a step over which a function differs from the integral of its derivative, before
# the step is reported as a jump.
_ZOOMS = 3
_MISFIT = 1e-6  # allowed error of a given derivative, relative to its largest value


def check_picklable(motion: Motion) -> None:
    """Raise a ValueError for a motion that cannot be sent to other processes or stored.

    Raises
    ------
    ValueError
        If the motion cannot be pickled.
    """
    if not motion.picklable:
        raise ValueError(
            f"motion: a {type(motion).__name__} of functions that cannot be pickled (such as lambdas) can be "
            "neither stored nor sent to workers; define them with def at the top of a module, "
            "or run in this process without a store"
        )


def check_consistent(motion: Motion, t_end: float) -> None:
    """Check that a motion's speed and acceleration are the derivatives of its angle and speed.

    Parameters
    ----------
    motion : Motion
        The motion; near its `breakpoints` the derivatives are not checked.
    t_end : float
        Time up to which the motion is checked [s].

    Raises
    ------
    ValueError
        If a value is not finite, or a derivative is wrong: with the time and the misfit.
    """
    h = _STEP * t_end
    t = _choose_times(t_end, motion.breakpoints, h)
    sample = motion.at(t + h * np.arange(-2, 3)[:, None])
    angle, speed, acceleration = sample.angle, sample.speed, sample.acceleration
    for name, values in {"angle": angle, "speed": speed, "acceleration": acceleration}.items():
        _check_finite(name, t, values[2])
    _check_finite("carrier_acceleration", t, sample.carrier_acceleration[2].sum(axis=-1))
    _check_derivative("angle", "speed", "rad/s", t, h, angle, speed[2])
    _check_derivative("speed", "acceleration", "rad/s2", t, h, speed, acceleration[2])
    _check_continuous(motion, "angle", "rad", "speed", t)
    _check_continuous(motion, "speed", "rad/s", "acceleration", t)


def _choose_times(t_end: float, breakpoints: Sequence[float], h: float) -> np.ndarray:
    """Choose times over the interval and near breakpoints, but none within 2 h [s] of a breakpoint."""
    # The times are irregular, so that a periodic function is not sampled only at its zeros.
    k = np.arange(_SAMPLES)
    t = 2 * h + (t_end - 4 * h) * (k + k * math.e % 1) / _SAMPLES
    for jump in breakpoints:
        sides = [side for side in (jump - 3 * h, jump + 3 * h) if 2 * h <= side <= t_end - 2 * h]
        t = np.union1d(t[abs(t - jump) > 2.5 * h], sides)
    return t


def _check_finite(name: str, t: np.ndarray, values: np.ndarray) -> None:
    bad = ~(np.abs(values) <= MOST)
    if bad.any():
        raise ValueError(
            f"{name} = {values[bad][0]} at t = {t[bad][0]:.6g} s: it must be finite up to t_end, "
            f"and at most {MOST:g}"
        )


def _check_derivative(
    name: str, derivative_name: str, unit: str, t: np.ndarray, h: float, f: np.ndarray, df: np.ndarray
) -> None:
    """Compare a derivative `df` at times t with finite differences of `f` at five points t + k h, step h."""
    coarse = (f[3] - f[1]) / (2 * h)
    fine = (8 * (f[3] - f[1]) - (f[4] - f[0])) / (12 * h)
    rounding = 16 * np.finfo(float).eps * abs(f).max() / h
    allowed = abs(fine - coarse) + _MISFIT * max(abs(df).max(), abs(fine).max()) + rounding
    misfit = abs(df - fine)
    k = int((misfit - allowed).argmax())
    if misfit[k] > allowed[k]:
        raise ValueError(
            f"{derivative_name} is not the derivative of {name} at t = {t[k]:.6g} s: {df[k]:.6g} {unit} "
            f"where differences give {fine[k]:.6g}, a misfit of {misfit[k]:.3g}; correct one of them"
        )


def _check_continuous(motion: Motion, name: str, unit: str, derivative_name: str, t: np.ndarray) -> None:
    """Check that a function has no jump between the times at which finite differences are taken."""
    misfit = 0.0
    for _ in range(_ZOOMS):
        sample = motion.at(t)
        excess, misfit, k = _find_worst_step(t, getattr(sample, name), getattr(sample, derivative_name))
        if excess <= 0:
            return
        t = np.linspace(t[k], t[k + 1], _SAMPLES)  # smaller steps show a steep rise as continuous
    raise ValueError(
        f"{derivative_name} is not the derivative of {name} at t = {t[0]:.6g} s, where {name} jumps by "
        f"{misfit:.3g} {unit}; give a continuous {name}"
    )


def _find_worst_step(t: np.ndarray, f: np.ndarray, df: np.ndarray) -> tuple[float, float, int]:
    """Find the step of f that differs most from the integral of df, its supposed derivative.

    Returns the misfit minus the allowed misfit, the misfit, and the index of the step.
    """
    step = np.diff(t)
    misfit = abs(np.diff(f) - step * (df[1:] + df[:-1]) / 2)
    rounding = 16 * np.finfo(float).eps * (abs(f).max() + t[-1] * abs(df).max())
    # If df is monotone, the error of the trapezoidal rule is at most half of the first term.
    allowed = step * abs(np.diff(df)).max() + rounding
    k = int((misfit - allowed).argmax())
    return float(misfit[k] - allowed[k]), float(misfit[k]), k
