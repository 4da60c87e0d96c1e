"""Drum brakes of several shoes: simplex (one leads, one trails), duplex (all lead), or any other set."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, not_negative, numbers, positive, together
from beamdyn.common.inputs.checks import flag, kind, refuse, set_fields, several
from beamdyn.common.results.meanings import Meaning
from beamdyn.common.results.one_line import error_at_most, spanned
from brakes.drum.shoe import Shoe, ShoeResult, SlidesOrLocks, integrals, solve_shoe


@dataclass(frozen=True)
class DrumBrake:
    """Shoes of one drum, each pressed by the same force.

    Parameters
    ----------
    shoes : tuple of Shoe
        The shoes, each described as if it lay on the +x side.
    leading : tuple of bool
        Which of them lead when the drum turns forward.

    Raises
    ------
    ValueError
        If there is no shoe, the tuples differ in length, or the drum radii differ.

    Examples
    --------
    >>> lining = np.radians((30, 110))
    >>> shoe = drum.Shoe(0.138, 0.05, lining, pivot=(0.02, -0.11), force_arm=0.115)
    >>> drum.DrumBrake((shoe, shoe), leading=(True, False)).leading
    (True, False)
    """

    shoes: tuple[Shoe, ...]
    leading: tuple[bool, ...]

    def __post_init__(self) -> None:
        flags = enumerate(several("leading", self.leading, object))
        leading = tuple(flag(f"leading[{k}]", each) for k, each in flags)
        set_fields(self, shoes=several("shoes", self.shoes, Shoe), leading=leading)
        if not self.shoes or len(self.shoes) != len(self.leading):
            raise ValueError(
                f"{len(self.shoes)} shoes and {len(self.leading)} entries of leading: give one entry a shoe, "
                "at least one shoe"
            )
        radii = [shoe.drum_radius for shoe in self.shoes]
        if any(not np.all(np.asarray(radius) == radii[0]) for radius in radii):
            raise ValueError("drum_radius differs between the shoes: they share one drum; give one radius")


def simplex(leading: Shoe, trailing: Shoe | None = None) -> DrumBrake:
    """Assemble a leading and a trailing shoe; the same shoe twice unless a second is given.

    Examples
    --------
    >>> lining = np.radians((30, 110))
    >>> shoe = drum.Shoe(0.138, 0.05, lining, pivot=(0.02, -0.11), force_arm=0.115)
    >>> drum.simplex(shoe).leading  # one leads, one trails
    (True, False)
    """
    kind("leading", leading, Shoe)
    kind("trailing", trailing, Shoe | None)
    return DrumBrake((leading, trailing or leading), (True, False))


def duplex(first: Shoe, second: Shoe | None = None) -> DrumBrake:
    """Assemble two shoes that lead forward and trail in reverse; the same twice unless a second is given.

    Examples
    --------
    >>> lining = np.radians((30, 110))
    >>> shoe = drum.Shoe(0.138, 0.05, lining, pivot=(0.02, -0.11), force_arm=0.115)
    >>> drum.duplex(shoe).leading  # both lead
    (True, True)
    """
    kind("first", first, Shoe)
    kind("second", second, Shoe | None)
    return DrumBrake((first, second or first), (True, True))


@dataclass(frozen=True)
class BrakeResult(SlidesOrLocks):
    """Forces in a brake.

    Attributes
    ----------
    brake : DrumBrake
        The brake.
    reverse : bool
        Whether the drum turns backward.
    shoes : tuple of ShoeResult
        The shoes, in the brake's order.
    force, torque : ndarray
        Actuating force on each shoe [N], torque of the brake [N m]; nan where it locks.
    peak_pressure : ndarray
        Largest pressure on any lining [Pa].
    c_star, c_star_slope : ndarray
        Sum of the shoe factors, torque / (force radius), and its derivative with respect to the friction.
    locking_friction, margin, locked : ndarray
        Values of the shoe that locks first.

    Examples
    --------
    >>> lining = np.radians((30, 110))
    >>> shoe = drum.Shoe(0.138, 0.05, lining, pivot=(0.02, -0.11), force_arm=0.115)
    >>> found = drum.brake_torque(drum.simplex(shoe), friction=0.35, force=1000.0)
    >>> found.shoes[0].leading, found.shoes[1].leading
    (True, False)
    """

    brake: DrumBrake
    reverse: bool
    shoes: tuple[ShoeResult, ...]
    friction: Numbers
    force: Annotated[Numbers, Meaning("N", "force on each shoe")]
    torque: Annotated[Numbers, Meaning("N m", "torque of the brake")]
    peak_pressure: Annotated[Numbers, Meaning("Pa", "largest pressure on a lining", "MPa")]
    c_star: Annotated[Numbers, Meaning("", "brake factor C* = torque / (force radius)")]
    c_star_slope: Annotated[Numbers, Meaning("", "dC*/dmu")]
    locking_friction: Annotated[Numbers, Meaning("", "friction at self-locking")]
    margin: Annotated[Numbers, Meaning("", "margin to self-locking, 1 - mu / locking mu")]
    locked: Numbers

    def headline(self) -> Iterator[str]:
        """The result in one line; see `Result.headline`."""
        yield f"{len(self.shoes)} shoes, torque {spanned(self.torque, 'N m')}"
        yield f"C* {spanned(self.c_star)}"
        yield error_at_most(self.error)
        yield "locked" if np.any(self.locked) else "slides"

    @property
    def error(self) -> Numbers:
        """Bound of the relative error of torque, force, pressure and C*: the sum of those of the shoes."""
        return sum(shoe.error for shoe in self.shoes)


def brake_torque(
    brake: DrumBrake,
    *,
    friction: Numbers,
    force: Numbers | None = None,
    peak_pressure: Numbers | None = None,
    torque: Numbers | None = None,
    reverse: bool = False,
) -> BrakeResult:
    """Compute the forces in a brake whose shoes are pressed by the same force.

    Parameters
    ----------
    brake : DrumBrake
        The brake.
    friction : float or ndarray
        Coefficient of friction.
    force, peak_pressure, torque : float or ndarray, optional
        Exactly one of: force on each shoe [N], largest pressure on any lining [Pa], torque [N m].
    reverse : bool
        Whether the drum turns backward: leading shoes trail, and trailing shoes lead.

    Returns
    -------
    BrakeResult
        Complete result.

    Raises
    ------
    ValueError
        As for `shoe_torque`.

    References
    ----------
    As `shoe_torque`, for each shoe.

    Examples
    --------
    >>> lining = np.radians((30, 110))
    >>> shoe = drum.Shoe(0.138, 0.05, lining, pivot=(0.02, -0.11), force_arm=0.115)
    >>> found = drum.brake_torque(drum.simplex(shoe), friction=0.35, force=1000.0)
    >>> bool(found.torque == sum(each.torque for each in found.shoes))
    True
    """
    kind("brake", brake, DrumBrake)
    reverse = flag("reverse", reverse)
    name, value = _take_only({"force": force, "peak_pressure": peak_pressure, "torque": torque})
    value = positive(name, value, {"force": "N", "peak_pressure": "Pa", "torque": "N m"}[name])
    mu = not_negative("friction", friction)
    shapes = {f"shoes[{k}]": integrals(shoe).n for k, shoe in enumerate(brake.shoes)}
    together(friction=mu, **{name: value}, **shapes)
    sides = [*zip(brake.shoes, (leads is not reverse for leads in brake.leading), strict=True)]
    at_unit_force = [solve_shoe(shoe, mu, leads, 1.0) for shoe, leads in sides]
    if name == "torque":
        refuse(np.asarray(mu) == 0, "friction", mu, "", "without friction there is no torque")
        bound = "a shoe locks: no torque can be demanded of the brake"
        locked = _over(np.logical_or, [shoe.locked for shoe in at_unit_force])
        refuse(locked, "friction", mu, "", bound, "give a force to see which one, or less friction")
        value = value / sum(shoe.torque for shoe in at_unit_force)
    elif name == "peak_pressure":  # the shoe with the largest pressure at a force limits the force
        value = value / _over(np.maximum, [shoe.peak_pressure for shoe in at_unit_force])
    shoes = tuple(solve_shoe(shoe, mu, leads, value) for shoe, leads in sides)
    limit = _over(np.minimum, [shoe.locking_friction for shoe in shoes])
    return BrakeResult(
        brake=brake,
        reverse=reverse,
        shoes=shoes,
        friction=mu,
        force=shoes[0].force,
        torque=sum(shoe.torque for shoe in shoes),
        peak_pressure=_over(np.maximum, [shoe.peak_pressure for shoe in shoes]),
        c_star=sum(shoe.c_star for shoe in shoes),
        c_star_slope=sum(shoe.c_star_slope for shoe in shoes),
        locking_friction=limit,
        margin=1 - mu / limit,
        locked=_over(np.logical_or, [shoe.locked for shoe in shoes]),
    )


def shoe_torque(
    shoe: Shoe,
    *,
    friction: Numbers,
    force: Numbers | None = None,
    peak_pressure: Numbers | None = None,
    torque: Numbers | None = None,
    leading: bool = True,
) -> ShoeResult:
    """Compute all forces on a shoe from its actuating force, its peak pressure or its torque.

    Parameters
    ----------
    shoe : Shoe
        The shoe.
    friction : float or ndarray
        Coefficient of friction mu.
    force, peak_pressure, torque : float or ndarray, optional
        Exactly one of: actuating force P [N], largest pressure on the lining [Pa], torque [N m].
    leading : bool
        Whether the drum's surface moves towards the pin on this shoe.

    Returns
    -------
    ShoeResult
        Complete result; arrays broadcast over all inputs.

    Raises
    ------
    ValueError
        If not exactly one of the three is given, a value is out of bounds, or a torque is demanded
        with friction 0, or at or past self-locking.

    Notes
    -----
    With s = -1 for the leading shoe, +1 for the trailing, A = width r, and the integrals K, S, C of
    sin, sin^2, sin cos over the arc: P (a + c) = A p0 (n + s mu d), n = c S - b C,
    d = r K - b S - c C; torque = mu A p0 r K.

    References
    ----------
    Budynas and Nisbett, Shigley's Mechanical Engineering Design, section 16-2: pressure as the sine of the
    angle from the pin. Vardanyan et al. (2019) count it from another line: `Shoe.pressure_zero`.

    Examples
    --------
    >>> lining = np.radians((30, 110))
    >>> shoe = drum.Shoe(0.138, 0.05, lining, pivot=(0.02, -0.11), force_arm=0.115)
    >>> round(float(drum.shoe_torque(shoe, force=1000.0, friction=0.35, leading=True).torque), 2)  # N m
    176.73
    """
    kind("shoe", shoe, Shoe)
    brake = DrumBrake((shoe,), (flag("leading", leading),))
    found = brake_torque(brake, friction=friction, force=force, peak_pressure=peak_pressure, torque=torque)
    return found.shoes[0]


def _take_only(given: dict[str, Any]) -> tuple[str, Any]:
    """Name and value of the one input that is given; a ValueError unless it is exactly one."""
    present = {name: value for name, value in given.items() if value is not None}
    if len(present) != 1:
        got = " and ".join(present) or "none"
        raise ValueError(f"give exactly one of {', '.join(given)}; got {got}")
    return next(iter(present.items()))


def _over(function: np.ufunc, values: Sequence[Numbers]) -> Numbers:
    """The least, the largest, or whether any, of the shoes' values in each case."""
    return function.reduce(np.broadcast_arrays(*values))[()]


def wheel_cylinder_force(bore: Numbers, line_pressure: Numbers) -> Numbers:
    """Compute the force [N] of a wheel cylinder's piston from its bore [m] and the line pressure [Pa].

    References
    ----------
    Standard: pressure times area.

    Examples
    --------
    >>> round(float(drum.wheel_cylinder_force(bore=0.02, line_pressure=5e6)), 1)  # N: p pi d^2 / 4
    1570.8
    """
    return np.pi / 4 * positive("bore", bore, "m") ** 2 * not_negative("line_pressure", line_pressure, "Pa")


def stop_energy(
    mass: Numbers,
    speed: Numbers,
    final_speed: Numbers = 0.0,
    *,
    descent: Numbers = 0.0,
    inertia: Numbers = 0.0,
    rolling_radius: Numbers | None = None,
    g: float = 9.806,
) -> Numbers:
    """Compute the energy that the brakes absorb in a stop [J].

    Parameters
    ----------
    mass : float or ndarray
        Mass of the vehicle [kg].
    speed, final_speed : float or ndarray
        Speed before and after [m/s].
    descent : float or ndarray
        Height lost during the stop [m]; negative uphill.
    inertia : float or ndarray
        Moment of inertia of the wheels and all that turns with them [kg m2]; needs `rolling_radius`.
    rolling_radius : float or ndarray, optional
        Radius of the wheels [m].
    g : float
        Gravity [m/s2].

    Returns
    -------
    float or ndarray
        Energy [J].

    Raises
    ------
    ValueError
        If a value is out of bounds, the final speed is not below the first, or the radius is missing.

    References
    ----------
    Standard: kinetic and potential energy.

    Examples
    --------
    >>> drum.stop_energy(mass=1000.0, speed=20.0)  # J: m v^2 / 2
    200000.0
    """
    m, v1 = positive("mass", mass, "kg"), positive("speed", speed, "m/s")
    v2 = numbers("final_speed", final_speed)
    refuse((np.asarray(v2) < 0) | (v2 >= v1), "final_speed", v2, "m/s", "give 0 or more, below speed")
    rotating = not_negative("inertia", inertia, "kg m2")
    if np.any(rotating) and rolling_radius is None:
        raise ValueError("inertia is given without rolling_radius: give the wheels' radius in m")
    rolling = 1.0 if rolling_radius is None else positive("rolling_radius", rolling_radius, "m")
    kinetic = (m + rotating / rolling**2) * (v1**2 - v2**2) / 2
    return kinetic + m * not_negative("g", g, "m/s2") * numbers("descent", descent, "m")


def temperature_rise(
    energy: Numbers, drum_mass: Numbers, specific_heat: Numbers = 500.0, share: Numbers = 1.0
) -> Numbers:
    """Compute the mean temperature rise of a drum in one stop [K], without loss of heat.

    Parameters
    ----------
    energy : float or ndarray
        Energy of the stop [J].
    drum_mass : float or ndarray
        Total mass of the drums that share the energy [kg].
    specific_heat : float or ndarray
        Specific heat of the drums [J/(kg K)]; 500 for cast iron.
    share : float or ndarray
        Fraction of the energy that goes into the drums, from 0 to 1.

    Returns
    -------
    float or ndarray
        Temperature rise [K].

    Raises
    ------
    ValueError
        If a value is out of bounds.

    References
    ----------
    Standard: all energy stays in the drum, of one temperature.

    Examples
    --------
    >>> drum.temperature_rise(energy=100e3, drum_mass=5.0)  # K
    40.0
    """
    part = not_negative("share", share)
    refuse(np.asarray(part) > 1, "share", part, "", "give a fraction of the energy, from 0 to 1")
    heated = positive("drum_mass", drum_mass, "kg") * positive("specific_heat", specific_heat, "J/(kg K)")
    return not_negative("energy", energy, "J") * part / heated
