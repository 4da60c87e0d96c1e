"""Temperatures of a brake in repeated stops, and the fading of its lining.

A stop converts kinetic energy, and the work of a driving load, to heat of a mass with the heat capacity
C = m c. It has one temperature T and cools between the stops only. With the torque M(T) at a constant
actuating force, an angle dq of rotation heats it by C dT = M dq. So energy alone decides how hot a stop ends:
for the moment of inertia J, its angular speed w before the stop, the torque L of the load, and the angle q of
rotation,

    T1 = T0 + (J w^2 / 2 + L (q + q0)) / C,    q = C int dT / M(T) from T0 to T1,

with the angle q0 that the brake turns before its torque acts.
Without a load this is explicit. With a load, T1 is the fixed point of an increasing function of T1:
the iteration from T0 rises and is bounded by the least fixed point, the one that the stop reaches first. A
fixed point exists if the torque stays above the load on the way: T1 - L q / C then increases, and T1 is
bracketed.
If the torque of the lining fades to that of the load before the energy is absorbed, the brake never stops the
load. Between stops T - T_a falls by exp(-h t / C), with the temperature T_a of the surroundings, the heat
flow h per kelvin, and the time t. Without a load each stop heats by J w^2 / (2 C): the temperatures of the
stops follow an affine map, which contracts by exp(-h t / C) and so has one limit.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Annotated, Any

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, keep_checked, not_negative
from beamdyn.common.inputs.checks import function, kind, refuse, set_fields
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.columns import Meaning
from beamdyn.common.results.one_line import spanned, warned
from beamdyn.common.results.result import Result
from brakes.common.limits import EDGE
from brakes.common.locking import LEAST_MARGIN

_NODES = 20  # nodes of the quadrature between two temperatures of the curve
_FEWER = 12  # nodes of the coarser quadrature that estimates the error of the finer one
# A bracket is divided into _PARTS intervals for at most _MOST_AT_ONCE cases, else halved.
_PARTS, _MOST_AT_ONCE = 16, 1000
_EPS = np.finfo(float).eps


@dataclass(frozen=True)
class FrictionCurve(Described):
    """Description of a curve of friction over temperature; in files it is a list of rows."""


@dataclass(frozen=True)
class Duty:
    """The repeated stops of a brake and the mass that they heat; numbers may be arrays, one entry per case.

    Parameters
    ----------
    inertia : float or ndarray
        Moment of inertia J of all that one brake stops, about its axis [kg m2]; for a vehicle, the
        brake's share of the mass times the square of the wheel's radius.
    speed : float or ndarray
        Speed w before each stop [rad/s].
    heated_mass : float or ndarray
        Mass m that one brake warms [kg].
    specific_heat : float or ndarray
        Specific heat c of that mass [J/(kg K)]; by default that of cast iron, about 500.
    load_torque : float or ndarray
        Torque L that drives the brake on, such as that of a slope or of a hanging load [N m].
    free_angle : float or ndarray
        Angle q0 that the brake turns in each stop before its torque acts [rad].
    stops : float or ndarray
        Number of stops, a whole number.
    interval : float or ndarray
        Time t from the end of a stop to the start of the next [s].
    cooling : float or ndarray
        Heat flow to the surroundings between stops, over the temperature difference, h [W/K].
    surroundings : float or ndarray
        Temperature of the surroundings, and of the brake before the first stop [K].
    friction_curve : array_like, shape (n, 2), optional
        Temperatures [K] that increase, and the friction of the lining at each, with straight lines between;
        if not given, the friction is the same at all temperatures.
    most_pv : float or ndarray, optional
        Largest product of pressure and rubbing speed [W/m2]; not checked if not given.

    Raises
    ------
    ValueError
        If a value is out of bounds, the number of stops is not whole, or the curve does not increase or
        begins above the surroundings.

    Examples
    --------
    >>> duty = drum.Duty(inertia=20.0, speed=50.0, heated_mass=5.0)
    >>> float(duty.rise_of_a_stop)  # K: J w^2 / (2 m c)
    10.0
    """

    inertia: Annotated[Numbers, Described("kg m2", "J", "moment of inertia that one brake stops", above=0)]
    speed: Annotated[Numbers, Described("rad/s", "omega", "speed before each stop", above=0)]
    heated_mass: Annotated[Numbers, Described("kg", "m", "mass that one brake warms", above=0)]
    specific_heat: Annotated[Numbers, Described("J/kg/K", "c", "specific heat of that mass", above=0)] = 500.0
    load_torque: Annotated[
        Numbers, Described("N m", "L", "driving torque, of a slope or a hanging load", least=0)
    ] = 0.0
    free_angle: Annotated[
        Numbers, Described("rad", "", "rotation in each stop before the torque acts", least=0)
    ] = 0.0
    stops: Annotated[Numbers, Described("", "n", "number of stops", least=1, most=1000, whole=True)] = 1.0
    interval: Annotated[Numbers, Described("s", "t", "time from the end of a stop to the next", least=0)] = (
        0.0
    )
    cooling: Annotated[
        Numbers, Described("W/K", "h", "heat flow to the surroundings between stops, per kelvin", least=0)
    ] = 0.0
    surroundings: Annotated[
        Numbers, Described("K", "T_a", "temperature of surroundings, and of brake before first stop", above=0)
    ] = 293.15
    friction_curve: Annotated[
        list[list[float]] | None,
        FrictionCurve("", "mu(T)", "rows of temperature and friction of the lining", least=0),
    ] = None
    most_pv: Annotated[
        Numbers | None,
        Described("W/m2", "", "largest pressure times rubbing speed; not checked if not given", above=0),
    ] = None

    def __post_init__(self) -> None:
        keep_checked(self)
        if self.friction_curve is not None:
            curve = np.asarray(self.friction_curve)
            self._check(curve)
            # Tuples make instances comparable; arrays do not.
            set_fields(self, friction_curve=tuple(map(tuple, curve.tolist())))

    def _check(self, curve: np.ndarray) -> None:
        if curve.ndim != 2 or curve.shape[1] != 2 or len(curve) < 2:
            raise ValueError("friction_curve: give two or more rows of temperature and friction")
        if not np.all(np.diff(curve[:, 0]) > 0):
            raise ValueError("friction_curve: the temperatures must increase from row to row")
        bound = "it is below the first temperature of friction_curve, {limit}"
        first = curve[0, 0]
        early = np.asarray(self.surroundings) < first * (1 - LEAST_MARGIN)
        refuse(early, "surroundings", self.surroundings, "K", bound, "begin the curve there", limit=first)

    @property
    def capacity(self) -> Numbers:
        """Heat capacity C of the mass that one brake heats [J/K]."""
        return self.heated_mass * self.specific_heat

    @property
    def rise_of_a_stop(self) -> Numbers:
        """Temperature rise of one stop by the kinetic energy, and by the load before the torque acts [K]."""
        energy = self.inertia * np.square(self.speed) / 2 + self.load_torque * self.free_angle
        return energy / self.capacity

    @property
    def kept(self) -> Numbers:
        """Fraction of the temperature rise above the surroundings that remains at the next stop."""
        return np.exp(-np.asarray(self.cooling) * self.interval / self.capacity)


@dataclass(frozen=True)
class Fade(Result):
    """Temperatures, friction and angles of repeated stops; arrays have the axes (stop, case).

    Attributes
    ----------
    duty : Duty
        The stops, and the mass that they heat.
    status : str or ndarray of str
        ``"stops"``; ``"never stops"`` where the lining fades to the torque of the load, within 5e-13;
        ``"too hot"`` past the last temperature of the curve: the numbers from that stop on are nan.
    start, end : ndarray
        Temperature before and after each stop [K].
    end_friction : ndarray
        Friction at the end of each stop.
    angle : ndarray
        Angle that the brake turns in each stop [rad].
    heat : ndarray
        Heat of each stop [J].
    hottest, first_angle, last_angle, first_friction, last_friction, energy : ndarray
        Largest rise above the surroundings [K], angles of the first and last stop [rad], friction at the
        start of the first and at the end of the last, heat of the last [J], of each case.
    settled : ndarray
        Temperature rise above the surroundings at the end of a stop after very many stops [K]; inf without
        cooling, nan with a load.
    pv : ndarray
        Largest pressure times rubbing speed, at the start of the first stop [W/m2].
    error : ndarray
        Estimate of the relative error of the angles: rounding, and a quadrature of fewer nodes; both grow as
        the torque falls to that of the load.

    Examples
    --------
    >>> duty = drum.Duty(20.0, 50.0, 5.0, stops=3, friction_curve=[[293.15, 0.4], [333.15, 0.3]])
    >>> found = drum.repeat_stops(duty, 0.4, lambda friction: 1000.0 * friction)
    >>> found.angle.round(3)  # rad: each stop is longer
    array([64.539, 68.993, 74.108])
    """

    duty: Duty
    status: Any
    start: Numbers
    end: Numbers
    end_friction: Numbers
    angle: Numbers
    heat: Numbers
    hottest: Annotated[Numbers, Meaning("K", "hottest, above the surroundings")]
    first_angle: Annotated[Numbers, Meaning("rad", "angle of the first stop")]
    last_angle: Annotated[Numbers, Meaning("rad", "angle of the last stop")]
    first_friction: Annotated[Numbers, Meaning("", "friction at the start of the first stop")]
    last_friction: Annotated[Numbers, Meaning("", "friction at the end of the last stop")]
    energy: Annotated[Numbers, Meaning("J", "heat of the last stop")]
    settled: Annotated[
        Numbers, Meaning("K", "rise above the surroundings after very many stops, without load torque")
    ]
    pv: Annotated[
        Numbers, Meaning("W/m2", "largest pressure times rubbing speed, before the first stop", "MW/m2")
    ]
    error: Annotated[Numbers, Meaning("", "estimate of the relative error of the angles")]

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"hottest {spanned(self.hottest, 'K')} above the surroundings"
        yield warned(self.warnings)

    @property
    def refusals(self) -> tuple[str, ...]:
        """Reasons why a stop has no result: it does not end, or gets hotter than the friction curve."""
        if np.ndim(self.status) == 0:
            return tuple(self.messages_of_cases(1).values())
        found = [(status, words) for status, words in _WORDS.items() if np.any(self.status == status)]
        return tuple(f"{words} (cases: {np.sum(self.status == status)})" for status, words in found)

    def messages_of_cases(self, count: int) -> dict[int, str]:
        """Return which stop has no result, and why, by index of the case; `count` counts all cases."""
        status, stops = (np.broadcast_to(x, (count,)) for x in (self.status, self.duty.stops))
        ended = np.isfinite(self.end).reshape(len(self.end), -1)
        first = np.broadcast_to(1 + ended.argmin(axis=0), (count,))
        return {
            i: (f"stop {first[i]} of {stops[i]:g}: " if stops[i] > 1 else "") + _WORDS[status[i]]
            for i in np.flatnonzero(status != "stops").tolist()
        }

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentence on a product of pressure and rubbing speed above its limit; empty if none is."""
        return warn_of_pv(self.pv, self.duty.most_pv)


def warn_of_pv(pv: Numbers, most: Numbers | None) -> tuple[str, ...]:
    """Compose a warning of pressure times rubbing speed [W/m2] above its limit; empty if no case is above."""
    if most is None or not np.any(above := np.greater(pv, np.multiply(most, 1 + EDGE))):
        return ()
    highest, least = (
        float(end(np.broadcast_to(x, above.shape)[above])) / 1e6 for end, x in ((np.max, pv), (np.min, most))
    )
    said = f"pressure times rubbing speed of the linings reaches {highest:.4g} MW/m2"
    return (f"{said}, above most_pv = {least:.4g} MW/m2",)


_WORDS = {
    "never stops": "the brake has no more torque than load_torque or a slope, at once or by fading: it never "
    "stops",
    "too hot": "the brake gets hotter than the last temperature of friction_curve: extend the curve",
}
TorqueAt = Callable[[Numbers], Numbers]


def repeat_stops(duty: Duty, friction: Numbers, torque_at: TorqueAt, pv: Numbers = np.nan) -> Fade:
    """Compute repeated stops of a brake at a constant actuating force.

    Parameters
    ----------
    duty : Duty
        The stops, and the mass that they heat.
    friction : float or ndarray
        Coefficient of friction, used if `duty` has no friction curve.
    torque_at : callable
        Torque [N m] at a friction of shape (..., cases); it increases with the friction, and is nan where the
        brake locks.
    pv : float or ndarray, optional
        Largest pressure times rubbing radius, times the speed before a stop [W/m2].

    Returns
    -------
    Fade
        Complete result. A stop that does not end is a status, not an error.

    Raises
    ------
    ValueError
        If an argument is of the wrong kind, the friction is negative, or the brake locks at a friction of the
        curve.

    References
    ----------
    Standard: conservation of energy, as in the docstring of the module.

    Examples
    --------
    >>> duty = drum.Duty(inertia=20.0, speed=50.0, heated_mass=5.0, stops=2)
    >>> float(drum.repeat_stops(duty, 0.4, lambda friction: 1000.0 * friction).hottest)  # K
    20.0
    """
    kind("duty", duty, Duty)
    function("torque_at", torque_at)
    path = _Warming(duty, not_negative("friction", friction), torque_at)
    above, stops = path.cases, []  # temperature above the surroundings
    status = np.full(above.shape, "stops", dtype="U11")
    for k in range(int(np.max(duty.stops))):
        start = duty.surroundings + above
        rise, how = _rise_in_stop(path, start)
        status = np.where((status == "stops") & (k < np.asarray(duty.stops)), how, status)
        stops.append((above, rise, path.angle(start, rise), path.angle(start, rise, _FEWER)))
        above = (above + rise) * duty.kept
    above, rise, angle, rougher = (np.stack(each) for each in zip(*stops, strict=True))
    begun, ended = duty.surroundings + above, duty.surroundings + (above + rise)
    last = path.friction(ended)
    count = np.broadcast_to(duty.stops, status.shape).astype(int)

    def at_last(each: np.ndarray) -> np.ndarray:
        """Return the value of the last stop of each case."""
        return np.take_along_axis(each, count[None] - 1, axis=0)[0]

    heat, kept = duty.capacity * rise, np.asarray(duty.kept)
    angle, rougher = angle + duty.free_angle, rougher + duty.free_angle
    # The load multiplies errors of a stop's heat: as the torque falls to its torque, a stop becomes endless.
    torque = path.torque(last)
    rounding = 8 * _EPS * (1 + heat / (angle * torque))
    error = (rounding + np.abs(rougher / angle - 1)) * torque / (torque - duty.load_torque)
    with np.errstate(divide="ignore"):
        settled = np.where(np.asarray(duty.load_torque) > 0, np.nan, duty.rise_of_a_stop / (1 - kept))
    return Fade(
        duty=duty,
        status=status[()],
        start=begun,
        end=ended,
        end_friction=last,
        angle=angle,
        heat=heat,
        hottest=at_last(np.maximum.accumulate(above + rise))[()],
        first_angle=angle[0],
        last_angle=at_last(angle),
        first_friction=path.friction(begun[0]),
        last_friction=at_last(last),
        energy=at_last(heat),
        settled=(settled + path.cases)[()],
        pv=(pv + path.cases)[()],
        error=at_last(np.maximum.accumulate(error))[()],
    )


@np.errstate(divide="ignore", invalid="ignore")  # a brake without torque turns by an infinite angle
def _rise_in_stop(path: _Warming, start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Compute the temperature rise of a stop [K], nan if it does not end, and the status of the stop."""
    duty, load = path.duty, np.asarray(path.duty.load_torque)
    weak = load * (1 + LEAST_MARGIN)  # largest torque that is too near the load's torque to stop it
    low = duty.rise_of_a_stop + 0 * start
    most = low / np.maximum(1 - load / path.least(start), _EPS)
    high = np.where(np.isfinite(path.last), path.last - start, most)

    def over(rise: np.ndarray) -> np.ndarray:
        """Return whether, up to a rise [K], the stop ends or the torque fades to the load's torque."""
        return path.stopped(start, rise) | (path.least(start, start + rise) <= weak)

    # Only a stop with a friction curve can be too hot. Without a curve the stop ends at `high`, but rounding
    # may make over(high) false.
    hot = np.isfinite(path.last) & ((low > high) | ~over(high))
    high = np.where(hot | over(low), low, high)
    parts = _PARTS if start.size <= _MOST_AT_ONCE else 2
    while np.any(high - low > 2 * _EPS * high):
        grid = np.linspace(low, high, parts + 1)
        grid[-1] = high  # numpy's linspace may round the last point
        ended = np.concatenate([over(grid[1:-1]), np.full((1, *start.shape), True)])
        first = ended.argmax(axis=0)[None]
        low, high = (np.take_along_axis(grid, k, axis=0)[0] for k in (first, first + 1))
    faded = ~hot & (path.least(start, start + high) <= weak)
    status = np.select([~np.isfinite(start), hot, faded], ["stops", "too hot", "never stops"], "stops")
    return np.where(status == "stops", high, np.nan), status


@cache
def _gauss(nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Return nodes and weights of Gauss-Legendre quadrature."""
    return np.polynomial.legendre.leggauss(nodes)


class _Warming:
    """Friction and torque of a brake as functions of temperature, and the angle of rotation of a stop."""

    def __init__(self, duty: Duty, friction: Numbers, torque_at: TorqueAt) -> None:
        self.duty, self.given, self.torque_at = duty, friction, torque_at
        curve = duty.friction_curve
        self.knots = None if curve is None else np.asarray(curve)
        self.last = np.inf if self.knots is None else self.knots[-1, 0] * (1 + LEAST_MARGIN)
        if self.knots is not None:
            values = self.knots[:, 1]
            locks = np.isnan(self.torque(self._along(values)))
            first = values[locks.argmax(axis=0)]
            refuse(locks.any(axis=0), "friction_curve", first, "", "at this friction the brake locks")

    @cached_property
    def cases(self) -> np.ndarray:
        """Zeros with the shape of the cases, to broadcast with."""
        given = [x for name, x in vars(self.duty).items() if x is not None and name != "friction_curve"]
        return 0 * sum(given, np.asarray(self.given)) + 0 * self.constant

    @cached_property
    def constant(self) -> np.ndarray:
        """Torque [N m] at the given friction, which is that at all temperatures if there is no curve."""
        return self.torque(self.given)

    def _along(self, values: np.ndarray) -> np.ndarray:
        """Broadcast values over the cases, along a new first axis."""
        return values.reshape(-1, *(1,) * self.cases.ndim) + 0 * self.cases

    def torque(self, friction: Numbers) -> np.ndarray:
        """Compute the torque [N m] at coefficients of friction; nan where the friction is nan."""
        known = np.isfinite(friction)
        return np.where(known, self.torque_at(np.where(known, friction, 0.0)), np.nan)

    def friction(self, temperature: Numbers) -> Numbers:
        """Compute the coefficient of friction at temperatures [K]."""
        if self.knots is None:
            return self.given + 0 * np.asarray(temperature)
        # 0 times the temperature is added to keep nan.
        return np.interp(temperature, *self.knots.T) + 0 * np.asarray(temperature)

    def least(self, start: Numbers, end: Numbers | None = None) -> np.ndarray:
        """Compute the least torque [N m] between two temperatures.

        It occurs at one of them, or at a row of the friction curve.
        """
        if self.knots is None:
            return self.constant + 0 * np.asarray(start if end is None else start + np.asarray(end))
        found = [self.friction(each) for each in ((start,) if end is None else (start, end))]
        if end is not None:
            found += [np.where((start < at) & (at < end), mu, found[0]) for at, mu in self.knots]
        return self.torque(np.min(np.broadcast_arrays(*found), axis=0))

    def angle(self, start: Numbers, rise: Numbers, nodes: int = _NODES) -> np.ndarray:
        """Compute the angle [rad] in which a stop warms the brake from a temperature by a rise [K].

        It is the integral of heat capacity over torque.
        """
        if self.knots is None:
            return self.duty.capacity * rise / self.least(start)
        x, weights = _gauss(nodes)
        bounds = [0.0 * rise, *(np.clip(at - start, 0.0, rise) for at, _ in self.knots[1:-1]), rise]
        low, high = np.stack(bounds[:-1]), np.stack(bounds[1:])
        half, middle = (high - low) / 2, (high + low) / 2
        each = x.reshape(-1, *(1,) * half.ndim)  # axes: nodes, parts of the curve, cases
        slowness = 1 / self.torque(self.friction(start + (middle + half * each)))
        return self.duty.capacity * (np.tensordot(weights, slowness, 1) * half).sum(axis=0)

    def stopped(self, start: Numbers, rise: Numbers) -> np.ndarray:
        """Return whether the heat of a temperature rise [K] is at least the energy of the whole stop."""
        driven = self.duty.load_torque * self.angle(start, rise) / self.duty.capacity
        return rise * (1 + 4 * _EPS) >= self.duty.rise_of_a_stop + driven
