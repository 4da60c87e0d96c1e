"""Base class of brakes whose linings are pressed by one force, and the solution of their forces.

The pressure on a lining is its largest value times a known shape, so that torque and actuating force are
proportional to that value. A brake computes both at 1 Pa; this module scales them to the given load.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import reduce
from types import MappingProxyType
from typing import Annotated, Any, ClassVar

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, keep_checked, not_negative, together
from beamdyn.common.inputs.checks import flag, kind, one_of, refuse
from beamdyn.common.results.columns import Meaning
from beamdyn.common.results.one_line import error_at_most, spanned
from brakes.common.loads import take_load
from brakes.common.locking import LEAST_MARGIN, RubbingResult

_EPS = np.finfo(float).eps
# Imaginary part of the friction for complex-step derivatives, which lose no digits by cancellation.
_STEP = 1e-30
_ROUNDINGS = 16.0  # number of rounding errors that add up in a lining's force


@dataclass(frozen=True)
class Lining:
    """Torque and forces of a lining at a largest pressure of 1 Pa, for a given friction.

    Parameters
    ----------
    torque : float or ndarray
        Friction torque of the lining [N m].
    force : float or ndarray
        Actuating force that this pressure needs [N]; the lining locks if it is zero or negative.
    size : float or ndarray
        Sum of the absolute values of the terms of `force` [N], which bounds its rounding error.
    locks_at : float or ndarray
        Friction coefficient at which the lining locks; inf if it never does.
    reactions : mapping of str to float or ndarray
        Forces [N] by name, as listed in the brake's `reactions`.
    share : float or ndarray
        Fraction of the actuating force that reaches this lining.
    """

    torque: Numbers
    force: Numbers
    size: Numbers
    locks_at: Numbers = np.inf
    reactions: Mapping[str, Numbers] = field(default_factory=lambda: MappingProxyType({}))
    share: Numbers = 1.0


class Machine(ABC):
    """Base of brakes whose linings are pressed by one force: frozen dataclasses of the brake's inputs.

    A subclass has a field for each input, overrides the class attributes below, and defines `linings`. If
    several pressure laws are possible, it has a field `pressure_law`, the name of one of its `laws`.

    Attributes
    ----------
    grips : str
        Name in messages of the part that locks, such as "band".
    reactions : mapping of str to Meaning
        Meaning of the forces on a lining's parts.
    laws : mapping of str to str
        Description of each pressure law, by its name; empty if there is only one.
    place : Meaning
        Coordinate along the lining over which the pressure is plotted.

    Examples
    --------
    >>> band = machines.Band(0.2, 0.05, wrap=3.9, force_arm=0.5, first_arm=0.1)
    >>> band.reference_radius  # m
    0.2
    """

    grips: ClassVar[str] = "brake"
    reactions: ClassVar[Mapping[str, Meaning]] = MappingProxyType({})
    laws: ClassVar[Mapping[str, str]] = MappingProxyType({})
    place: ClassVar[Meaning]

    def __post_init__(self) -> None:
        if self.laws:
            one_of("pressure_law", self.law, tuple(self.laws))
        keep_checked(self)
        self.check()

    @property
    def law(self) -> str:
        """Name of the chosen pressure law; empty if the brake has only one."""
        return getattr(self, "pressure_law", "")

    @abstractmethod
    def check(self) -> None:
        """Raise ValueError if inputs contradict each other; bounds of each input are already checked."""

    @abstractmethod
    def linings(self, friction: Numbers, reverse: bool) -> Mapping[str, Lining]:
        """Compute torque and forces of each lining at a largest pressure of 1 Pa, by name.

        The friction may be complex, for complex-step derivatives: an implementation has no branches that
        depend on it, and takes no absolute value of it.
        """

    @property
    @abstractmethod
    def reference_radius(self) -> Numbers:
        """Radius of the brake factor C* = torque / (force * radius) [m]."""

    @property
    def rubbing_radius(self) -> Numbers:
        """Radius [m] that, times the largest pressure, gives the largest product of pressure and radius."""
        return self.reference_radius

    @abstractmethod
    def reach(self) -> tuple[Numbers, Numbers]:
        """Return the least and the largest coordinate of a lining, in the SI unit of `place`."""

    @abstractmethod
    def pressure(self, at: Numbers, friction: Numbers) -> Numbers:
        """Compute the pressure at coordinates along a lining, divided by its largest value."""

    def pressure_on(self, index: int, at: Numbers, friction: Numbers, reverse: bool) -> Numbers:
        """Compute `pressure` for one of the linings by its index; subclasses may distinguish them."""
        return self.pressure(at, friction)

    def remarks(self, friction: Numbers, reverse: bool) -> Sequence[str]:
        """Return sentences of advice to the designer, for a friction and forward or reverse rotation."""
        return ()

    def with_law(self, law: str) -> Machine:
        """Copy the brake with another pressure law; raises ValueError where that is impossible."""
        return replace(self, pressure_law=law)  # type: ignore[type-var]


@dataclass(frozen=True)
class LiningResult:
    """Torque, largest pressure and forces of a lining; nan where the brake locks.

    Attributes
    ----------
    name : str
        Name of the lining.
    torque, peak_pressure : ndarray
        Torque [N m], largest pressure [Pa].
    reactions : dict of str to ndarray
        Forces [N] by name, as listed in the brake's `reactions`.

    Examples
    --------
    >>> band = machines.Band(0.2, 0.05, wrap=3.9, force_arm=0.5, first_arm=0.1)
    >>> [*machines.solve_brake(band, friction=0.25, force=100.0).linings[0].reactions]
    ['first', 'second', 'fulcrum', 'bearing']
    """

    name: str
    torque: Annotated[Numbers, Meaning("N m", "torque")]
    peak_pressure: Annotated[Numbers, Meaning("Pa", "largest pressure", "MPa")]
    reactions: dict[str, Numbers]


@dataclass(frozen=True)
class MachineResult(RubbingResult):
    """Forces in a brake whose linings are pressed by one force.

    At or past self-locking the formulas do not hold: force, torque, pressure and factors are then nan,
    `locked` is true, and `message` says so.

    Attributes
    ----------
    brake : Machine
        The brake.
    reverse : bool
        Whether the brake turns backward.
    friction : ndarray
        Coefficient of friction.
    force, torque, peak_pressure : ndarray
        Actuating force [N], torque [N m], largest pressure on any lining [Pa].
    c_star, c_star_slope : ndarray
        Brake factor torque / (force * radius), and its derivative with respect to the friction.
    radius : ndarray
        Radius that the brake factor refers to [m].
    locking_friction, margin : ndarray
        Friction at which the brake locks, inf if it never does; 1 - friction / locking friction.
    locked : ndarray of bool
        Whether the friction is at or past self-locking, up to a relative margin of 5e-13 or to rounding.
    error : ndarray
        Bound of the relative rounding error of torque, force and pressure, which grows as 1 / margin.
    linings : tuple of LiningResult
        Results of each lining.

    Examples
    --------
    >>> band = machines.Band(0.2, 0.05, wrap=3.9, force_arm=0.5, first_arm=0.1)
    >>> found = machines.solve_brake(band, friction=0.25, force=100.0)
    >>> bool(found.locked), found.linings[0].name
    (False, 'band')
    """

    brake: Machine
    reverse: bool
    force: Annotated[Numbers, Meaning("N", "actuating force")]
    radius: Annotated[Numbers, Meaning("m", "radius that C* refers to", "mm")]
    error: Annotated[Numbers, Meaning("", "bound of the relative error")]
    linings: tuple[LiningResult, ...]

    @property
    def grips(self) -> str:  # type: ignore[override]
        """Name in messages of the part that locks."""
        return self.brake.grips

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"{type(self.brake).__name__}, torque {spanned(self.torque, 'N m')}"
        yield f"C* {spanned(self.c_star)}"
        yield error_at_most(self.error)
        yield "locked" if np.any(self.locked) else "slides"


def solve_brake(
    brake: Machine,
    *,
    friction: Numbers,
    force: Numbers | None = None,
    peak_pressure: Numbers | None = None,
    torque: Numbers | None = None,
    reverse: bool = False,
) -> MachineResult:
    """Compute the forces in a brake from its actuating force, its largest pressure or its torque.

    Parameters
    ----------
    brake : Machine
        The brake: band, disc, cone, plates or block.
    friction : float or ndarray
        Coefficient of friction.
    force, peak_pressure, torque : float or ndarray, optional
        Exactly one of: actuating force [N], largest pressure on any lining [Pa], torque [N m].
    reverse : bool
        Whether the brake turns backward.

    Returns
    -------
    MachineResult
        Complete result; arrays broadcast over all inputs.

    Raises
    ------
    ValueError
        If not exactly one of the three is given, a value is out of bounds, or a torque is demanded
        with friction 0, or at or past self-locking.

    References
    ----------
    Standard: force and torque of each lining are proportional to its largest pressure; see the brake's class.

    Examples
    --------
    >>> band = machines.Band(0.2, 0.05, wrap=3.9, force_arm=0.5, first_arm=0.1)
    >>> round(float(machines.solve_brake(band, friction=0.25, force=100.0).torque), 2)  # N m
    165.12
    """
    kind("brake", brake, Machine)
    reverse = flag("reverse", reverse)
    name, value = take_load(force=force, peak_pressure=peak_pressure, torque=torque)
    mu = not_negative("friction", friction)
    linings = brake.linings(np.asarray(mu), reverse)
    together(friction=mu, **{name: value}, brake=sum(each.force + each.share for each in linings.values()))
    locked = reduce(np.logical_or, (_locks(each) for each in linings.values()))
    gain, slope = _torque_per_force(brake, mu, reverse, locked)
    pressures = {key: each.share / np.where(locked, np.nan, each.force) for key, each in linings.items()}
    if name == "torque":
        refuse(np.asarray(mu) == 0, "friction", mu, "", "without friction there is no torque", "give a force")
        bound = "the brake locks: no torque can be demanded of it"
        refuse(locked, "friction", mu, "", bound, "give a force, or less friction")
    made = {"force": 1.0, "torque": gain, "peak_pressure": reduce(np.maximum, pressures.values())}[name]
    limit = reduce(np.minimum, (each.locks_at for each in linings.values()))
    radius = brake.reference_radius
    load, mu, limit, gain, slope, radius, locked = np.broadcast_arrays(
        value / made, mu, limit, gain, slope, radius, locked
    )
    parts = tuple(_pressed(key, linings[key], load * p) for key, p in pressures.items())
    worst = reduce(np.maximum, (linings[key].size * p for key, p in pressures.items()))
    return MachineResult(
        brake=brake,
        reverse=reverse,
        friction=mu[()],
        force=load[()],
        torque=(load * gain)[()],
        peak_pressure=reduce(np.maximum, (part.peak_pressure for part in parts)),
        c_star=(gain / radius)[()],
        c_star_slope=(slope / radius)[()],
        radius=radius[()],
        locking_friction=limit[()],
        margin=(1 - np.divide(mu, limit, out=np.full(limit.shape, np.inf), where=limit > 0))[()],
        locked=locked[()],
        error=_ROUNDINGS * _EPS * worst,
        linings=parts,
    )


def _locks(lining: Lining) -> Numbers:
    """Return for each case whether a lining locks, or is within rounding of locking."""
    return lining.force <= max(LEAST_MARGIN, _ROUNDINGS * _EPS) * lining.size


def _torque_per_force(brake: Machine, mu: Numbers, reverse: bool, locked: Numbers) -> tuple[Any, Any]:
    """Compute torque per actuating force and its slope over friction [m]; nan if the brake locks."""
    stepped = brake.linings(np.asarray(mu) + 1j * _STEP, reverse).values()
    gain = sum(each.share * each.torque / np.where(locked, 1.0, each.force) for each in stepped)
    # Without friction the result would be only rounding error of the complex step.
    torque = np.where(np.asarray(mu) == 0, 0.0, gain.real)
    return np.where(locked, np.nan, torque), np.where(locked, np.nan, gain.imag / _STEP)


def _pressed(name: str, lining: Lining, pressure: Numbers) -> LiningResult:
    """Scale a lining's torque and forces to its largest pressure [Pa]."""
    forces = {each: value * pressure for each, value in lining.reactions.items()}
    return LiningResult(name, (lining.torque * pressure)[()], pressure[()], forces)
