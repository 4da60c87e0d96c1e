"""Stopping distance of a vehicle with one rim brake, limited by grip and by pitching over."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, kind, not_negative, one_of, positive
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.one_line import number
from beamdyn.common.results.result import Result
from brakes.planar.part import check_inputs

# Limits of braking a two-wheeled vehicle at one wheel: grip of the tyre, and pitching over ----------


GRAVITY = 9.80665  # standard acceleration of gravity [m/s2]
EQUAL = 1e-9  # relative difference of two values that counts as rounding
TyreFriction = Annotated[float, Described("", "mu_t", "friction of the tyre on the road", above=0, most=2)]
Wheelbase = Annotated[float, Described("m", "L", "distance of the axles", above=0)]
Height = Annotated[float, Described("m", "h", "height of the centre of gravity, with rider", above=0)]
_BEHIND = Described("m", "x", "centre of gravity, with rider, behind the front axle", above=0)
Behind = Annotated[float, _BEHIND]


@dataclass(frozen=True)
class Stance:
    """Centre of gravity, wheelbase and tyre friction of a two-wheeled vehicle, with the wheel that is braked.

    The defaults are those of a usual upright bicycle with its rider.

    Parameters
    ----------
    braked_wheel : {"front", "rear"}
        The wheel with the brake.
    tyre_friction : float
        Coefficient of friction between the braked wheel's tyre and the road.
    wheelbase : float
        Distance between the axles [m].
    cg_height : float
        Height of the centre of gravity above the road, with rider [m].
    cg_behind_front : float
        Horizontal distance of the centre of gravity behind the front axle [m].

    Raises
    ------
    ValueError
        If a value is out of its bounds, or the centre of gravity is behind the rear axle.

    References
    ----------
    Standard: moments about the front wheel's contact.

    Examples
    --------
    >>> stance = calipers.Stance(cg_height=1.1, cg_behind_front=0.6)
    >>> round(stance.pitch_limit(lift=1.0), 2)  # m/s2: g 0.6 / 1.1
    5.35
    """

    braked_wheel: Annotated[Literal["front", "rear"], Described(meaning="wheel with the brake")] = "front"
    tyre_friction: TyreFriction = 0.8
    wheelbase: Wheelbase = 1.02
    cg_height: Height = 1.1
    cg_behind_front: Behind = 0.62

    def __post_init__(self) -> None:
        check_inputs(self)
        one_of("braked_wheel", self.braked_wheel, ("front", "rear"))
        if self.cg_behind_front >= self.wheelbase * (1 - EQUAL):
            bound = "it is behind the rear axle, at {other} = {limit}"
            given = {"unit": "m", "limit": self.wheelbase, "other": "wheelbase"}
            raise InvalidValue("cg_behind_front", self.cg_behind_front, bound, **given)

    def pitch_limit(self, lift: float) -> float:
        """Compute the deceleration at which the rear wheel lifts [m/s2].

        Parameters
        ----------
        lift : float
            Factor (M h + J / R) / (M h) by which the wheels' inertia increases the moment that lifts the
            wheel. M is the mass, h the height of the centre of gravity, J the moment of inertia of all
            wheels, and R their radius.
        """
        return GRAVITY * self.cg_behind_front / (self.cg_height * lift)

    def grip_limit(self, lift: float, inertia: float) -> float:
        """Compute the deceleration at which the braked tyre slips [m/s2]; inf if it never does.

        Parameters
        ----------
        lift : float
            As for `pitch_limit`.
        inertia : float
            Factor (M + J / R^2) / M by which the wheels' inertia increases the mass, with the symbols of
            `pitch_limit`.
        """
        mu, length, x = self.tyre_friction, self.wheelbase, self.cg_behind_front
        moved = mu * self.cg_height * lift
        if self.braked_wheel == "rear":
            return mu * GRAVITY * x / (inertia * length + moved)
        holds = inertia * length - moved  # not positive if the vehicle pitches over before the tyre slips
        return mu * GRAVITY * (length - x) / holds if holds > 0 else math.inf


_RTOL, _ATOL = 1e-12, 1e-12  # relative, and absolute [m], tolerance of the integration
_USUAL = Stance()
_WHEEL_INERTIA = Described("kg m2", "J", "moment of inertia of all wheels", least=0)


@dataclass(frozen=True)
class StoppingDistance(Result):
    """A vehicle's stop by the two pads on one rim.

    Parameters
    ----------
    distance : float
        Stopping distance [m]; inf where the brake does not stop the vehicle.
    energy : float
        Energy that the pads absorb [J].
    deceleration : float
        Mean deceleration over the distance [m/s2].
    grip_limit, pitch_limit : float
        Decelerations at which the braked tyre slips (inf if it never does), and at which the rear wheel lifts
        [m/s2].
    pad_limit : float
        Force on each pad at the lower of these two limits [N], which is not exceeded.
    limited_by : {"brake", "grip", "pitching over"}
        What limits the deceleration.
    status : {"stops", "does not stop"}
        Whether the vehicle stops.
    message : str
        The status as a sentence, with the limit of the deceleration if that is not the brake.

    Examples
    --------
    >>> found = calipers.stop(mass=80.0, speed=30 / 3.6, pad_force=224.0, friction=0.4)
    >>> found.status, round(found.energy)  # J
    ('stops', 2778)
    """

    field_units: ClassVar[dict[str, str]] = {
        "m": "distance",
        "J": "energy",
        "m/s2": "deceleration grip_limit pitch_limit",
        "N": "pad_limit",
    }

    distance: float
    energy: float
    deceleration: float
    grip_limit: float
    pitch_limit: float
    pad_limit: float
    limited_by: str
    status: str
    message: str

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"{number(self.distance, 'm')} at {number(self.deceleration, 'm/s2')}"
        yield f"limited by {self.limited_by}"
        yield self.status


def stop(
    mass: Annotated[float, Described("kg", "M", "mass, wheels included", above=0)],
    speed: Annotated[float, Described("m/s", "v", "speed", least=0)],
    pad_force: float | Callable[[float], float],
    friction: Annotated[float, Described("", "mu", "friction of pads and rim", above=0, most=2)],
    wheel_inertia: Annotated[float, _WHEEL_INERTIA] = 0.0,
    tyre_radius: Annotated[float, Described("m", "R", "rolling radius", above=0)] | None = None,
    rim_radius: Annotated[float, Described("m", "r", "radius at the pads", above=0)] | None = None,
    stance: Stance = _USUAL,
) -> StoppingDistance:
    """Compute a stop on level ground by the pads on one rim, within the limits of grip and pitching over.

    With the force F on each of two pads, E = (M + J / R^2) v^2 / 2 = integral of 2 mu F (r / R) ds over the
    stopping distance. For constant F, no inertia and r = R this is M v^2 = 4 mu F L, with
    the stopping distance L (as on the eeBrake page).
    The rider does not squeeze harder than grip and pitching over allow.

    Parameters
    ----------
    mass : float
        Mass M of vehicle and rider, wheels included [kg].
    speed : float
        Speed v at which the pads begin to press [m/s].
    pad_force : float or callable
        Force F of each pad on the rim [N], constant or as a function of the distance s [m].
    friction : float
        Coefficient of friction mu between pads and rim.
    wheel_inertia : float
        Moment of inertia J of all wheels about their axles [kg m2].
    tyre_radius : float, optional
        Rolling radius R of the wheels [m]; needed if `wheel_inertia` or `rim_radius` is given.
    rim_radius : float, optional
        Radius r at which the pads press [m]; if not given, that of the tyre, as on the eeBrake page.
    stance : Stance
        The braked wheel, its grip, and the centre of gravity; by default those of a usual bicycle.

    Returns
    -------
    StoppingDistance

    Raises
    ------
    ValueError
        If a value is out of its bounds, or the tyre's radius is missing.

    References
    ----------
    Energy (standard): M v^2 = 4 mu F L at a constant force F of each pad; limits of grip and pitching as in
    `Stance`.

    Examples
    --------
    >>> found = calipers.stop(mass=80.0, speed=30 / 3.6, pad_force=224.0, friction=0.4)
    >>> round(found.distance, 2)  # m: M v^2 / (4 mu F)
    15.5
    """
    kind("stance", stance, Stance)
    mass, speed = positive("mass", mass, "kg"), not_negative("speed", speed, "m/s")
    tyre = None if tyre_radius is None else positive("tyre_radius", tyre_radius, "m")
    inertia = mass + _equivalent_mass(not_negative("wheel_inertia", wheel_inertia, "kg m2"), tyre)
    energy = inertia * speed**2 / 2
    factor = 2 * positive("friction", friction) * _radius_ratio(rim_radius, tyre)
    lift = 1 + (inertia / mass - 1) * (tyre or 0.0) / stance.cg_height
    grip, pitch = stance.grip_limit(lift, inertia / mass), stance.pitch_limit(lift)
    most = min(grip, pitch) * inertia / factor
    if callable(pad_force):
        path = (
            _integrated(energy, factor, lambda s: min(float(pad_force(s)), most)) if energy else np.zeros(1)
        )
        distance = float(path[-1])
        peak = max(float(pad_force(s)) for s in path if s < math.inf) if energy else 0.0
    else:
        peak = not_negative("pad_force", pad_force, "N")  # largest pad force, without limits by the road
        distance = energy / (factor * min(peak, most)) if peak else math.inf
    limit = "grip" if grip < pitch * (1 - EQUAL) else "pitching over"
    limited_by = "brake" if peak <= most * (1 + EQUAL) else limit
    stops = distance < math.inf
    deceleration = speed**2 / (2 * distance) if stops and distance else 0.0
    status = "stops" if stops else "does not stop"
    message = _WORDS[status].format(distance=distance)
    if limited_by != "brake":
        slips = f"the {stance.braked_wheel} tyre slips" if limited_by == "grip" else "the rear wheel lifts"
        at = f"{min(grip, pitch) / GRAVITY:.3g} g, {most:.4g} N on each pad"
        message = f"{message}; limited by {limited_by}: {slips} at {at}"
    return StoppingDistance(distance, energy, deceleration, grip, pitch, most, limited_by, status, message)


_WORDS = {
    "stops": "stops in {distance:.6g} m",
    "does not stop": "does not stop: the pads do not press long enough",
}


def _equivalent_mass(inertia: float, tyre_radius: float | None) -> float:
    if not inertia:
        return 0.0
    if tyre_radius is None:
        raise ValueError("wheel_inertia needs tyre_radius, the rolling radius of the wheels in m")
    return inertia / tyre_radius**2


def _radius_ratio(rim_radius: float | None, tyre_radius: float | None) -> float:
    if rim_radius is None:
        return 1.0
    if tyre_radius is None:
        raise ValueError("rim_radius needs tyre_radius, the rolling radius of the wheels in m")
    rim = positive("rim_radius", rim_radius, "m")
    if rim > tyre_radius * (1 + EQUAL):
        bound = "it must not exceed {other} = {limit}"
        raise InvalidValue("rim_radius", rim, bound, unit="m", limit=tyre_radius, other="tyre_radius")
    return rim / tyre_radius


def _integrated(energy: float, factor: float, force: Callable[[float], float]) -> np.ndarray:
    """Compute the distances [m] at which the brake has absorbed energies E from 0 to `energy` [J].

    The pad force F = ``force(s)`` [N] depends on the distance s, and the braking force is `factor` times F.
    The function integrates ds/dE = 1/(factor F(s)). The last distance is inf if F falls to zero before the
    brake has absorbed all of the energy.
    """
    from scipy.integrate import solve_ivp

    if not force(0.0) > 0:
        raise ValueError(f"pad_force at s = 0 is {force(0.0):g} N: begin where the pads begin to press")

    def rate(_: float, s: np.ndarray) -> np.ndarray:
        pressing = force(float(s[0]))
        return np.array([1 / (factor * pressing) if pressing > 0 else np.nan])

    solution = solve_ivp(rate, (0.0, energy), np.zeros(1), method="DOP853", rtol=_RTOL, atol=_ATOL)
    return solution.y[0] if solution.success else np.append(solution.y[0], np.inf)
