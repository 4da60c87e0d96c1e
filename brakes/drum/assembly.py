"""Drum brakes of several shoes: simplex (one leading, one trailing), duplex (two leading), or any others."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Annotated, ClassVar, Literal

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, not_negative, together
from beamdyn.common.inputs.checks import flag, kind, refuse, set_fields, several
from beamdyn.common.results.columns import Meaning
from beamdyn.common.results.one_line import counted, error_at_most, spanned
from brakes.common.loads import take_load
from brakes.common.locking import RubbingResult
from brakes.drum.shoe import Shoe, ShoeResult, integrals, solve_shoe


@dataclass(frozen=True)
class DrumBrake:
    """A drum brake: the shoes of one drum, all pressed by the same force.

    Parameters
    ----------
    shoes : tuple of Shoe
        The shoes, each described as if it lay on the +x side.
    leading : tuple of bool
        Whether each shoe leads when the drum turns forward.

    Raises
    ------
    ValueError
        If there is no shoe, the tuples differ in length, or the drum radii or the laws of pressure differ.

    Examples
    --------
    >>> lining = np.radians((30, 110))
    >>> shoe = drum.Shoe(0.138, 0.05, lining, pivot=(0.02, -0.11), force_arm=0.115)
    >>> drum.DrumBrake((shoe, shoe), leading=(True, False)).leading
    (True, False)
    """

    shoes: tuple[Shoe, ...]
    leading: tuple[bool, ...]

    laws: ClassVar[Mapping[str, str]] = MappingProxyType(
        {"wear": "sinusoidal pressure (wear)", "pressure": "uniform pressure"}
    )

    def __post_init__(self) -> None:
        flags = enumerate(several("leading", self.leading, object))
        leading = tuple(flag(f"leading[{k}]", each) for k, each in flags)
        set_fields(self, shoes=several("shoes", self.shoes, Shoe), leading=leading)
        if not self.shoes or len(self.shoes) != len(self.leading):
            raise ValueError(
                f"number of shoes: {len(self.shoes)}, of entries of leading: {len(self.leading)}; give one "
                "entry per shoe, and at least one shoe"
            )
        radii = [shoe.drum_radius for shoe in self.shoes]
        if any(not np.all(np.asarray(radius) == radii[0]) for radius in radii):
            raise ValueError("drum_radius differs between the shoes: they share one drum; give one radius")
        if len({shoe.pressure_law for shoe in self.shoes}) > 1:
            raise ValueError("pressure_law differs between the shoes; give one law")

    @property
    def law(self) -> str:
        """Name of the pressure law, the same for all shoes."""
        return self.shoes[0].pressure_law

    @property
    def rubbing_radius(self) -> Numbers:
        """Radius of the drum, at which the linings rub [m]."""
        return self.shoes[0].drum_radius

    def with_law(self, law: Literal["wear", "pressure"]) -> DrumBrake:
        """Copy the brake with another pressure law."""
        return replace(self, shoes=tuple(replace(shoe, pressure_law=law) for shoe in self.shoes))


def simplex(leading: Shoe, trailing: Shoe | None = None) -> DrumBrake:
    """Assemble a simplex brake of a leading and a trailing shoe; both are equal unless two are given.

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
    """Assemble a duplex brake of two shoes that lead forward; both are equal unless two are given.

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
class BrakeResult(RubbingResult):
    """Forces in a drum brake.

    Attributes
    ----------
    brake : DrumBrake
        The brake.
    reverse : bool
        Whether the drum turns backward.
    shoes : tuple of ShoeResult
        Results of the shoes, in the brake's order.
    force, torque : ndarray
        Actuating force on each shoe [N], torque of the brake [N m]; nan where the brake locks.
    peak_pressure : ndarray
        Largest pressure on any lining [Pa].
    c_star, c_star_slope : ndarray
        Sum of the shoe factors, torque / (force * radius), and its derivative with respect to the friction.
    locking_friction, margin, locked : ndarray
        Of the shoe that locks first: locking friction, margin 1 - friction / locking friction, and whether
        the shoe locks.

    Examples
    --------
    >>> lining = np.radians((30, 110))
    >>> shoe = drum.Shoe(0.138, 0.05, lining, pivot=(0.02, -0.11), force_arm=0.115)
    >>> found = drum.brake_torque(drum.simplex(shoe), friction=0.35, force=1000.0)
    >>> found.shoes[0].leading, found.shoes[1].leading
    (True, False)
    """

    grips = "shoe"

    brake: DrumBrake
    reverse: bool
    shoes: tuple[ShoeResult, ...]
    force: Annotated[Numbers, Meaning("N", "force on each shoe")]

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"{counted(len(self.shoes), 'shoe')}, torque {spanned(self.torque, 'N m')}"
        yield f"C* {spanned(self.c_star)}"
        yield error_at_most(self.error)
        yield "locked" if np.any(self.locked) else "slides"

    @property
    def error(self) -> Numbers:
        """Bound of the relative error of torque, force, pressure and C*: the sum of the shoes' bounds."""
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
    """Compute the forces in a drum brake whose shoes are pressed by the same force.

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
    name, value = take_load(force=force, peak_pressure=peak_pressure, torque=torque)
    mu = not_negative("friction", friction)
    shapes = {f"shoes[{k}]": integrals(shoe).n for k, shoe in enumerate(brake.shoes)}
    together(friction=mu, **{name: value}, **shapes)
    sides = [*zip(brake.shoes, (leads is not reverse for leads in brake.leading), strict=True)]
    at_unit_force = [solve_shoe(shoe, mu, leads, 1.0) for shoe, leads in sides]
    if name == "torque":
        refuse(np.asarray(mu) == 0, "friction", mu, "", "without friction there is no torque", "give a force")
        bound = "a shoe locks: no torque can be demanded of the brake"
        locked = _over(np.logical_or, [shoe.locked for shoe in at_unit_force])
        refuse(locked, "friction", mu, "", bound, "give a force to see which shoe locks, or less friction")
        value = value / sum(shoe.torque for shoe in at_unit_force)
    elif name == "peak_pressure":  # the shoe with the largest pressure limits the common force
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
    Angles are measured from the line where the pressure vanishes, and (b, -c) is the pin in axes turned to
    this line. The pressure is p0 times the sine of the angle. With s = -1 for the leading shoe, +1 for the
    trailing, A = width r, and the integrals K, S, C of sin, sin^2, sin cos over the arc, the moment of P
    about the pin is A p0 (n + s mu d), n = c S - b C, d = r K - b S - c C, and the torque is mu A p0 r K. A
    uniform pressure is p0, with the integrals of 1, sin, cos.

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


def _over(function: np.ufunc, values: Sequence[Numbers]) -> Numbers:
    """Reduce the shoes' values in each case by a function such as minimum, maximum or logical or."""
    return function.reduce(np.broadcast_arrays(*values))[()]
