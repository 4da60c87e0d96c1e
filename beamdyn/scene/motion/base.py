"""Base class of motions, and checks of their input."""

from __future__ import annotations

import math
import pickle
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from beamdyn.common.inputs.checks import real_array
from beamdyn.common.results.one_line import OneLine

_ROUNDING = 1e-12  # relative to the end of a motion: times beyond it by less differ by rounding only

Kinematics = tuple[np.ndarray, np.ndarray, np.ndarray]  # angle, speed, acceleration


@dataclass(frozen=True)
class MotionSample:
    """Motion of the carrier at some times; all arrays have the shape of the times.

    Parameters
    ----------
    angle, speed, acceleration : ndarray
        Angle theta about -n3 [rad], speed omega = theta' [rad/s], acceleration omega' [rad/s2].
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
        """Sample rotations at constant speed [rad/s] about a fixed centre, at angle 0, one entry a speed."""
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
    """Base class of motions; its defaults are those of a smooth, unlimited motion without a road.

    In order to add a motion, write a subclass in a module of its own:

    1. It is a frozen dataclass: it is hashed, and pickled unless it is made from functions.  Its fields are
       ``Annotated[float, Described(unit, symbol, meaning, bounds)]``, from which its table in files and its
       form are made; `__post_init__` checks them.
    2. `at` takes times of any shape and returns angle, speed, acceleration and the carrier's acceleration;
       each is the derivative of the one before.  A rotation about a fixed centre derives from `Rotation`.
    3. `with_speed` copies it with another final speed: sweeps and loci over speed need no more.
    4. `breakpoints` lists the times at which it or a derivative jumps: steps in time end there.
       `steady_start` is the time from which the speed is constant, `end` the last time.
    5. A translation that lasts at steady speed gives `lines`, `road_multiple`, `road_acceleration` and
       `steady_acceleration`, on which the steady response and the resonance speeds rest.
    6. To be named in files and forms, it stands in `KINDS` of `beamdyn.scene.motion`.

    Examples
    --------
    >>> isinstance(bd.SteadyRotation(50.0), bd.Motion)
    True
    """

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
        """Time up to which the motion is defined [s], inf if for ever."""
        return math.inf

    @property
    def lines(self) -> tuple[Line, ...]:
        """Excitation lines of the translation at steady speed; that of gravity is not included."""
        return ()

    @property
    def road_multiple(self) -> float | None:
        """Phase of the road per angle of rotation: waves of the road per turn; None without a road."""
        return None

    @property
    def picklable(self) -> bool:
        """Whether the motion can be pickled, as stores and other processes require."""
        try:
            pickle.dumps(self)
        except Exception:  # its type depends on the user's functions
            return False
        return True

    def road_acceleration(self, speed: float) -> float:
        """Largest acceleration of the wheel by the road at a steady speed [m/s2]; 0 without a road."""
        return 0.0

    def steady_acceleration(
        self, speed: np.ndarray | float, rotation: np.ndarray | float, road: np.ndarray | float
    ) -> np.ndarray:
        """Acceleration of the carrier's centre at steady speed, at phases of the rotation and of the road.

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
        """
        return np.zeros((*np.broadcast_shapes(*map(np.shape, (speed, rotation, road))), 3))


def check_times(t: np.ndarray, end: float) -> np.ndarray:
    """Convert times [s] to an array; raise a ValueError if a motion of finite end is not defined at one."""
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
    """Convert breakpoints [s] to ascending order without repeats."""
    return tuple(np.unique(real_array("breakpoints", times)).tolist())
