"""Motions with translation: a wheel that rolls over a wavy road, and any motion given by a function."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from beamdyn.common.inputs.checks import function, kind, moderate, positive, refuse, set_fields, size
from beamdyn.common.inputs.described import Described
from beamdyn.scene.motion.base import (
    Line,
    Motion,
    MotionSample,
    as_breakpoints,
    check_consistent,
    check_times,
)
from beamdyn.scene.motion.rotations import Rotation, TurningMotion

_MOST_WAVES = 1e12  # most road waves per turn; with more, the road's phase has few correct digits


@dataclass(frozen=True)
class RoadWave:
    """A sinusoidal road, given by its height or by the vertical velocity of the wheel on it.

    Parameters
    ----------
    wavelength : float
        Wavelength lambda [m].
    velocity_amplitude : float, optional
        Amplitude C [m/s] of the vertical velocity C sin(2 pi x / lambda) at the distance x travelled, the
        same at any speed: Lee and Yoo (2019), eq. (3), who call it an amplitude of the road.
    height : float, optional
        Amplitude A of the road's height, A sin(2 pi x / lambda) [m].

    Raises
    ------
    ValueError
        If the wavelength is not positive, or none or both of the amplitudes are given.

    References
    ----------
    Lee and Yoo (2019), eq. (3).

    Examples
    --------
    >>> road = bd.RoadWave(wavelength=0.3, height=0.002)  # m
    >>> round(road.wavenumber, 4)  # rad/m
    20.944
    """

    wavelength: Annotated[float, Described("m", "lambda", "wavelength of the road", above=0)]
    velocity_amplitude: Annotated[
        float | None, Described("m/s", "C", "amplitude of the wheel's vertical velocity; or give height")
    ] = None
    height: Annotated[
        float | None, Described("m", "A", "amplitude of the road's height; or give velocity_amplitude")
    ] = None

    def __post_init__(self) -> None:
        set_fields(self, wavelength=size("wavelength", self.wavelength, "m"))
        amplitudes = {"velocity_amplitude": (self.velocity_amplitude, "m/s"), "height": (self.height, "m")}
        amplitudes = {name: value for name, value in amplitudes.items() if value[0] is not None}
        if len(amplitudes) != 1:
            both = " and ".join(
                f"{name} = {' '.join(repr(v).split())}" for name, (v, _) in amplitudes.items()
            )
            raise ValueError(
                f"{both or 'neither velocity_amplitude nor height'} given: give exactly one, "
                "velocity_amplitude [m/s] of the wheel or height [m] of the road"
            )
        for name, (value, unit) in amplitudes.items():
            set_fields(self, **{name: moderate(name, value, unit)})

    @property
    def wavenumber(self) -> float:
        """Wavenumber of the road: phase per distance travelled [rad/m]."""
        return 2 * math.pi / self.wavelength

    def acceleration(
        self, phase: np.ndarray, velocity: np.ndarray, acceleration: np.ndarray | float = 0.0
    ) -> np.ndarray:
        """Compute the vertical acceleration of a wheel on the road [m/s2].

        Parameters
        ----------
        phase : ndarray
            Distance travelled times `wavenumber` [rad].
        velocity, acceleration : ndarray
            Velocity [m/s] and acceleration [m/s2] along the road.
        """
        k = self.wavenumber
        if self.velocity_amplitude is not None:
            return self.velocity_amplitude * k * velocity * np.cos(phase)
        assert self.height is not None
        return self.height * k * (acceleration * np.cos(phase) - k * velocity**2 * np.sin(phase))

    def largest_acceleration(self, velocity: float) -> float:
        """Compute the amplitude of the vertical acceleration at a constant velocity along the road [m/s2]."""
        peak = 0.0 if self.velocity_amplitude is not None else math.pi / 2
        return abs(float(self.acceleration(np.array(peak), np.array(velocity))))


@dataclass(frozen=True)
class RollingWheel(TurningMotion):
    """A wheel that rolls without slip along n1, on a flat or a wavy road.

    Parameters
    ----------
    rolling_radius : float
        Distance R travelled per angle turned [m]; the centre moves with R omega along n1.
    speed : float or Rotation
        Constant speed [rad/s], or rotation of the wheel.
    road : RoadWave, optional
        Road that moves the centre vertically, along n2, at the phase 2 pi R theta / lambda; flat if not
        given.

    Raises
    ------
    ValueError
        If the radius is not positive, or the speed is neither a number nor a rotation.

    References
    ----------
    Lee and Yoo (2019), section 2: a wheel that rolls without slip on a wave whose height it follows.

    Examples
    --------
    >>> road = bd.RoadWave(wavelength=0.3, velocity_amplitude=0.01)
    >>> motion = bd.RollingWheel(rolling_radius=0.3, speed=55.0, road=road)
    >>> round(motion.road_multiple, 6)  # the road's frequency over the speed: 2 pi R / lambda
    6.283185
    """

    rolling_radius: Annotated[float, Described("m", "R", "distance travelled per angle turned", above=0)]
    speed: Annotated[float | Rotation, Described(key="rotation")]
    road: RoadWave | None = None

    turned_by: ClassVar[str] = "speed"

    def __post_init__(self) -> None:
        set_fields(self, rolling_radius=size("rolling_radius", self.rolling_radius, "m"))
        self.keep_rotation()
        if self.road is not None:
            kind("road", self.road, RoadWave, "road = RoadWave(wavelength=0.3, height=0.001)")
            bound = "a wheel of this radius would pass more than 1e12 waves a turn"
            past = self.rolling_radius * self.road.wavenumber > _MOST_WAVES
            refuse(past, "road.wavelength", self.road.wavelength, "m", bound, "give m")

    @property
    def rotation(self) -> Rotation:
        """Rotation of the wheel, without its translation."""
        return self.turning

    @property
    def road_multiple(self) -> float | None:
        """Number of waves of the road per turn, 2 pi rolling_radius / wavelength; None if flat."""
        return None if self.road is None else self.rolling_radius * self.road.wavenumber

    @property
    def rates(self) -> tuple[float, ...]:
        """Rate of rotation and, on a wavy road, rate of the road's phase [rad/s]: see `Motion.rates`."""
        rates, waves = self.rotation.rates, self.road_multiple
        return rates if waves is None else (*rates, waves * rates[0])

    @property
    def lines(self) -> tuple[Line, ...]:
        """Excitation lines of the road; rotation splits the road's frequency into two."""
        if (kappa := self.road_multiple) is None:
            return ()
        return Line("road +", kappa + 1), Line("road -", abs(kappa - 1))

    def at(self, t: np.ndarray) -> MotionSample:
        """Sample the motion at times t [s], of any shape."""
        sample, R = self.rotation.at(t), self.rolling_radius
        sample.carrier_acceleration[..., 0] = R * sample.acceleration
        if self.road is not None:
            phase = self.road.wavenumber * R * sample.angle
            vertical = self.road.acceleration(phase, R * sample.speed, R * sample.acceleration)
            sample.carrier_acceleration[..., 1] = vertical
        return sample

    def road_acceleration(self, speed: float) -> float:
        """Compute the wheel's largest acceleration by the road at steady speed [m/s2]; 0 without road."""
        return 0.0 if self.road is None else self.road.largest_acceleration(self.rolling_radius * speed)

    def steady_acceleration(
        self, speed: np.ndarray | float, rotation: np.ndarray | float, road: np.ndarray | float
    ) -> np.ndarray:
        """Compute the centre's acceleration at steady speed [m/s2]: see `Motion.steady_acceleration`."""
        total = super().steady_acceleration(speed, rotation, road)
        if self.road is not None:
            velocity = self.rolling_radius * np.asarray(speed, dtype=float)
            total[..., 1] = self.road.acceleration(np.asarray(road, dtype=float), velocity)
        return total


@dataclass(frozen=True)
class UserMotion(Motion):
    """A motion given by a user's function of time.

    A lambda is not `picklable`: workers and stores need a function defined in a module.  The motion has no
    known steady state, so that it can be simulated only.

    Parameters
    ----------
    function : callable
        Function of an array of times [s] that returns a `MotionSample`.
    breakpoints : tuple of float
        Times at which the motion or one of its derivatives jumps [s].
    t_end : float
        Time up to which the motion is defined [s]; if finite, the motion is checked at construction.

    Raises
    ------
    ValueError
        If the function does not return a `MotionSample` of the right shapes, or speed and acceleration
        are not the derivatives of angle and speed.

    Examples
    --------
    >>> def steady(t):
    ...     zero = np.zeros_like(t)
    ...     return bd.MotionSample(5.0 * t, 5.0 + zero, zero, np.zeros((*t.shape, 3)))
    >>> float(bd.UserMotion(steady, t_end=1.0).at(np.array([0.5])).angle[0])
    2.5
    """

    function: Callable[[np.ndarray], MotionSample]
    breakpoints: tuple[float, ...] = ()  # pyright: ignore[reportIncompatibleMethodOverride, reportIncompatibleVariableOverride, reportAssignmentType]
    t_end: float = math.inf

    no_steady_state: ClassVar[str] = "has no known steady state; simulate it"

    def __post_init__(self) -> None:
        function("function", self.function, "it takes an array of times [s] and returns a MotionSample")
        set_fields(self, breakpoints=as_breakpoints(self.breakpoints))
        if not (isinstance(self.t_end, float) and self.t_end == math.inf):
            set_fields(self, t_end=positive("t_end", self.t_end, "s"))
            check_consistent(self, self.t_end)

    @property
    def final_speed(self) -> float:
        """Speed at `t_end` [rad/s]; nan if `t_end` is not given."""
        return float(self.at(np.array(self.t_end)).speed) if self.t_end < math.inf else math.nan

    @property
    def end(self) -> float:
        """Time up to which the motion is defined [s]; inf if it has no end."""
        return self.t_end

    def at(self, t: np.ndarray) -> MotionSample:
        """Sample the motion at times t [s], of any shape."""
        t = check_times(t, self.t_end)
        try:
            sample = self.function(t)
        except Exception as error:  # whatever a user's function may raise
            raise ValueError(f"function: it failed on an array of times ({error}); use numpy") from error
        if not isinstance(sample, MotionSample):
            raise ValueError(f"function(t) returned a {type(sample).__name__}: let it return a MotionSample")
        shapes = {"angle": t.shape, "speed": t.shape, "acceleration": t.shape}
        for name, shape in (shapes | {"carrier_acceleration": (*t.shape, 3)}).items():
            if np.shape(getattr(sample, name)) != shape:
                wrong = np.shape(getattr(sample, name))
                raise ValueError(
                    f"function(t): {name} has shape {wrong}; for times t of shape {t.shape} return {shape}"
                )
        return sample

    def with_speed(self, speed: float) -> UserMotion:
        """Raise a ValueError, because the speed of a function of time cannot be changed."""
        raise ValueError(
            f"with_speed({speed:g}): a UserMotion has one speed only; make one for each speed, "
            "or use RollingWheel with a rotation"
        )
