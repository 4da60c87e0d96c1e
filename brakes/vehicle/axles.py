"""A vehicle with two axles, and a truck: axle loads, braking ratios at which it slips, locks or pitches over.

Let R be the braking force of all wheels along the ground, and W = M g cos(beta) the vehicle's force normal to
it. The braking ratio is tau = R / W. With the centre of gravity at the height h, a behind the front axle and
b before the rear axle, a + b = L, moments about the points where the tyres touch the ground give

    loads over W: (b + tau h) / L in front and (a - tau h) / L at the rear, if the front axle leads,
                  (b - tau h) / L in front and (a + tau h) / L at the rear, if the rear axle leads.

The wheels have no mass. The leading axle is the axle at the front of the motion, or the lower axle at rest
on a slope, where tau = tan(beta). So the same formulas cover stops and parking.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, keep_checked
from beamdyn.common.inputs.checks import one_of, refuse
from beamdyn.common.inputs.described import Described
from brakes.common.locking import LEAST_MARGIN

Axle = Literal["front", "rear"]
Braked = Literal["front", "rear", "both"]
ROUNDING = np.finfo(float).eps
ACUTE: Any = {"above": -np.pi / 2, "below": np.pi / 2}  # bounds of an acute angle of either sign [rad]


@dataclass(frozen=True)
class Vehicle:
    """Mass and centre of gravity of a vehicle with two axles; every value may be an array, one per design.

    Parameters
    ----------
    mass : float or ndarray
        Mass M with load or rider [kg].
    cg_behind_front : float or ndarray
        Distance a of the centre of gravity behind the front axle [m].
    cg_height : float or ndarray
        Height h of the centre of gravity above the ground [m].
    wheelbase : float or ndarray
        Distance L between the axles [m].

    Raises
    ------
    ValueError
        If a value is not positive, or the centre of gravity is not between the axles.

    References
    ----------
    Standard: moments about the points where the tyres stand.

    Examples
    --------
    >>> bicycle = vehicle.Vehicle(80.0, cg_behind_front=0.62, cg_height=1.10, wheelbase=1.02)
    >>> round(bicycle.pitching_ratio("front"), 6)  # it pitches over the front wheel at 0.56 g
    0.563636
    """

    mass: Annotated[Numbers, Described("kg", "M", "mass with load or rider", above=0)]
    cg_behind_front: Annotated[
        Numbers, Described("m", "a", "centre of gravity, behind the front axle", above=0)
    ]
    cg_height: Annotated[Numbers, Described("m", "h", "centre of gravity, above the ground", above=0)]
    wheelbase: Annotated[Numbers, Described("m", "L", "distance of the axles", above=0)]

    def __post_init__(self) -> None:
        keep_checked(self)
        a, L = np.asarray(self.cg_behind_front), np.asarray(self.wheelbase)
        bound = "it is behind the rear axle, at {other} = {limit}"
        late = a >= L * (1 - LEAST_MARGIN)
        refuse(late, "cg_behind_front", a, "m", bound, limit=self.wheelbase, other="wheelbase")

    def arm(self, axle: Axle) -> Numbers:
        """Return the distance [m] of the centre of gravity from the other axle.

        The load of `axle` at rest on level ground is proportional to this distance.
        """
        return self.wheelbase - self.cg_behind_front if axle == "front" else self.cg_behind_front

    def load_share(self, axle: Axle, ratio: Numbers, leading: Axle) -> Numbers:
        """Compute the load of an axle over that of both, at a braking ratio; negative past pitching over.

        Parameters
        ----------
        axle : {"front", "rear"}
            The axle.
        ratio : float or ndarray
            Braking ratio tau, the braking force over the load of both axles.
        leading : {"front", "rear"}
            The axle that leads in the motion, or is the lower one at rest.
        """
        moved = ratio * self.cg_height
        return (self.arm(axle) + (moved if axle == leading else -moved)) / self.wheelbase

    def pitching_ratio(self, leading: Axle) -> Numbers:
        """Compute the braking ratio at which the vehicle pitches over: the axle that does not lead lifts."""
        return self.arm(other(leading)) / self.cg_height

    def locking_ratio(self, axle: Axle, friction: Numbers, share: Numbers, leading: Axle) -> Numbers:
        """Compute the braking ratio tau at which an axle with a share of the force locks; inf if it does not.

        Parameters
        ----------
        axle, leading : {"front", "rear"}
            As for `load_share`.
        friction : float or ndarray
            Friction mu of the tyres.
        share : float or ndarray
            Fraction of the braking force at this axle, 0 to 1; the axle locks where share * tau is mu times
            its `load_share`.
        """
        sense = 1 if axle == leading else -1
        left = share * self.wheelbase - sense * friction * self.cg_height
        locks = (np.asarray(share) > LEAST_MARGIN) & (left > LEAST_MARGIN * self.wheelbase)
        return np.where(locks, friction * self.arm(axle) / np.where(locks, left, 1.0), np.inf)[()]

    def slipping_ratio(self, friction: Numbers, braked: Braked, leading: Axle) -> Numbers:
        """Compute the largest braking ratio by grip, with all braked wheels at the limit of their friction.

        Parameters
        ----------
        friction : float or ndarray
            Friction mu of the tyres.
        braked : {"front", "rear", "both"}
            The axles whose wheels are braked.
        leading : {"front", "rear"}
            As for `load_share`.
        """
        one_of("braked", braked, ("front", "rear", "both"))
        alone = 1.0 + 0.0 * friction
        return alone * friction if braked == "both" else self.locking_ratio(braked, friction, alone, leading)

    @property
    def overturning_slopes(self) -> tuple[Numbers, Numbers]:
        """Slopes [rad] at which the vehicle overturns: over the front axle (negative), over the rear axle."""
        return -np.arctan(self.pitching_ratio("front")), np.arctan(self.pitching_ratio("rear"))


def other(axle: Axle) -> Axle:
    """Return the name of the other axle: "rear" for "front", and vice versa."""
    return "rear" if axle == "front" else "front"


# A truck with its load ---------------------------------------------------------------------------------


@dataclass(frozen=True)
class Truck:
    """A truck and its load; x from the front axle towards the rear, y up from the front wheels' centre.

    Every value may be an array, one entry per design.

    Parameters
    ----------
    empty_mass : float or ndarray
        Mass of the empty truck [kg].
    empty_cg : tuple
        Centre of gravity (x, y) of the empty truck [m].
    load_mass : float or ndarray
        Mass of the load [kg], which may be 0.
    load_cg : tuple
        Centre of gravity (x, y) of the load [m]; a load on the fork has x < 0.
    front_wheel_radius : float or ndarray
        Radius r1 of the front wheels [m].
    wheelbase : float or ndarray
        Distance L between the axles [m].

    Raises
    ------
    ValueError
        If a mass or length is not positive, or the centre of gravity, of the truck alone or with its
        load, is not between the axles and above the ground.

    References
    ----------
    Yoo et al. (1997), section 2.

    Examples
    --------
    >>> truck = vehicle.Truck(
    ...     5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89
    ... )
    >>> float(truck.mass)  # kg, with its load
    9450.0
    """

    empty_mass: Annotated[Numbers, Described("kg", "m", "mass of the empty truck", above=0)]
    empty_cg: tuple[
        Annotated[Numbers, Described("m", "x", "the empty truck's centre of gravity, behind the front axle")],
        Annotated[Numbers, Described("m", "y", "the empty truck's centre of gravity, above the front axle")],
    ]
    load_mass: Annotated[Numbers, Described("kg", "m_L", "mass of the load", least=0, default=0.0)]
    load_cg: tuple[
        Annotated[
            Numbers, Described("m", "x_L", "the load's centre, behind the front axle: negative", default=0.0)
        ],
        Annotated[Numbers, Described("m", "y_L", "the load's centre, above the front axle", default=0.0)],
    ]
    front_wheel_radius: Annotated[Numbers, Described("m", "r1", "radius of the front wheels", above=0)]
    wheelbase: Annotated[Numbers, Described("m", "L", "distance of the axles", above=0)]

    def __post_init__(self) -> None:
        keep_checked(self)
        self._check("the empty truck's centre of gravity", *self.empty_cg, "check {other}")
        self._check("the centre of gravity with the load", *self.cg, "take less load, or nearer the axle")

    def _check(self, name: str, x: Numbers, y: Numbers, remedy: str) -> None:
        x, y, least = np.asarray(x), np.asarray(y), LEAST_MARGIN * np.asarray(self.wheelbase)
        ahead = "it is ahead of the front wheel: the truck tips over it"
        refuse(x <= least, f"x of {name}", x, "m", ahead, remedy, other="empty_cg")
        behind = "it is behind the rear wheel, at wheelbase = {limit}"
        late, length = x >= self.wheelbase - least, self.wheelbase
        refuse(late, f"x of {name}", x, "m", behind, remedy, limit=length, other="empty_cg")
        low = "it is below the ground (-front_wheel_radius)"
        refuse(y + self.front_wheel_radius <= least, f"y of {name}", y, "m", low, remedy, other="empty_cg")

    @property
    def mass(self) -> Numbers:
        """Mass of the truck with its load [kg]."""
        return self.empty_mass + self.load_mass

    @property
    def cg(self) -> tuple[Numbers, Numbers]:
        """Centre of gravity (x, y) of the truck with its load [m]."""
        m, ml = self.empty_mass, self.load_mass
        x, y = ((m * e + ml * w) / (m + ml) for e, w in zip(self.empty_cg, self.load_cg, strict=True))
        return x, y

    @property
    def sizes_of_coordinates(self) -> Numbers:
        """Sum of the lengths in the lever arms of weight and friction [m], which scales rounding errors."""
        m, ml = self.empty_mass, self.load_mass
        empty, load = (np.abs(x) + np.abs(y) for x, y in (self.empty_cg, self.load_cg))
        return (m * empty + ml * load) / (m + ml) + self.front_wheel_radius + self.wheelbase

    @property
    def vehicle(self) -> Vehicle:
        """The truck with its load, reduced to two axles and a centre of gravity."""
        x, y = self.cg
        return Vehicle(self.mass, x, y + self.front_wheel_radius, self.wheelbase)

    @property
    def overturning_slopes(self) -> tuple[Numbers, Numbers]:
        """Slopes [rad] at which the truck overturns: over the front axle (negative), over the rear axle."""
        return self.vehicle.overturning_slopes
