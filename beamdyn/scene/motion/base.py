"""What every motion answers, and checks of its input."""

from __future__ import annotations

import math
import pickle
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from beamdyn.common.checks import real_array

_ROUNDING = 1e-12  # a time past the end by less, relative to the end, is its rounding

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


def within(t: np.ndarray, end: float) -> np.ndarray:
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


def as_breakpoints(given: Sequence[float]) -> tuple[float, ...]:
    """Breakpoints [s] in ascending order, each once."""
    return tuple(np.unique(real_array("breakpoints", given)).tolist())


def keep(instance: object, **values: object) -> None:
    """Set fields of a frozen dataclass, while it is made."""
    for name, value in values.items():
        object.__setattr__(instance, name, value)
