"""A truck with a load on its fork, whose front wheels are braked."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, keep_checked
from beamdyn.common.inputs.checks import refuse
from beamdyn.common.inputs.described import Described
from brakes.common.locking import LEAST_MARGIN
from brakes.vehicle.axles import Vehicle


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
