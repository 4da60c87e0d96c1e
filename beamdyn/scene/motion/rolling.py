"""Motions that also travel: a wheel that rolls over a wavy road, and the user's own."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from beamdyn.common.checks import kind, positive, real
from beamdyn.common.described import Described
from beamdyn.scene.motion.base import Line, Motion, MotionSample, as_breakpoints, keep, within
from beamdyn.scene.motion.checks import check_consistent
from beamdyn.scene.motion.rotations import Rotation, SteadyRotation


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

    wavelength: Annotated[float, Described("m", "lambda", "wavelength of the road", above=0)]
    velocity_amplitude: Annotated[
        float | None, Described("m/s", "C", "amplitude of the wheel's vertical velocity; or height")
    ] = None
    height: Annotated[
        float | None, Described("m", "A", "amplitude of the road's height; or velocity_amplitude")
    ] = None

    def __post_init__(self) -> None:
        keep(self, wavelength=positive("wavelength", self.wavelength, "m"))
        given = {"velocity_amplitude": (self.velocity_amplitude, "m/s"), "height": (self.height, "m")}
        given = {name: value for name, value in given.items() if value[0] is not None}
        if len(given) != 1:
            found = " and ".join(f"{name} = {value!r}" for name, (value, _) in given.items())
            raise ValueError(
                f"{found or 'neither velocity_amplitude nor height'} given: give exactly one, "
                "velocity_amplitude [m/s] of the wheel or height [m] of the road"
            )
        for name, (value, unit) in given.items():
            keep(self, **{name: real(name, value, unit)})

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

    rolling_radius: Annotated[float, Described("m", "R", "distance travelled per angle turned", above=0)]
    speed: Annotated[float | Rotation, Described(key="rotation")]
    road: RoadWave | None = None

    def __post_init__(self) -> None:
        keep(self, rolling_radius=positive("rolling_radius", self.rolling_radius, "m"))
        if not isinstance(self.speed, Rotation):
            remedy = "or a rotation, such as SpinUp(speed, duration)"
            keep(self, speed=SteadyRotation(real("speed", self.speed, "rad/s", remedy)))
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
        keep(self, breakpoints=as_breakpoints(self.breakpoints))
        if self.t_end != math.inf:
            keep(self, t_end=positive("t_end", self.t_end, "s"))
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
        t = within(t, self.t_end)
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
