"""Transmission of the force from the pedal to the brakes: a hydraulic line, or a cable.

Each has a gain, the force on a brake's actuator over the force behind the pedal, and a stroke: lost travel,
elastic deformation under load, and the travel that moves the actuators.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, keep_checked
from beamdyn.common.inputs.described import Described


@dataclass(frozen=True)
class HydraulicLine:
    """Master cylinder, line and wheel cylinders; every value may be an array, one entry per design.

    Parameters
    ----------
    master_bore, cylinder_bore : float or ndarray
        Bores of the master cylinder and of the wheel cylinders [m].
    pistons : float or ndarray
        Number of pistons of all wheel cylinders on the line.
    piston_travel : float or ndarray
        Travel of each wheel cylinder's piston until the linings press [m].
    lost_travel : float or ndarray
        Travel of the master cylinder's piston before pressure builds up [m].
    compliance : float or ndarray
        Volume that hoses, fluid and brakes take up, divided by the pressure [m3/Pa].
    most_pressure : float or ndarray, optional
        Largest pressure that the cylinders bear [Pa]; not checked if not given.

    Raises
    ------
    ValueError
        If a value is out of bounds.

    Examples
    --------
    >>> line = chain.HydraulicLine(master_bore=0.02222, cylinder_bore=0.03175)
    >>> round(line.gain, 4)
    2.0417
    """

    master_bore: Annotated[Numbers, Described("m", "d_m", "bore of the master cylinder", above=0)]
    cylinder_bore: Annotated[Numbers, Described("m", "d_w", "bore of the wheel cylinders", above=0)]
    pistons: Annotated[Numbers, Described("", "n", "pistons of all wheel cylinders", least=1, whole=True)] = (
        4.0
    )
    piston_travel: Annotated[
        Numbers, Described("m", "s_w", "travel of each piston until the linings press", least=0)
    ] = 0.0
    lost_travel: Annotated[
        Numbers, Described("m", "s_0", "travel of the master cylinder's piston before it presses", least=0)
    ] = 0.0
    compliance: Annotated[
        Numbers, Described("m3/Pa", "k_V", "volume that the line takes up, over the pressure", least=0)
    ] = 0.0
    most_pressure: Annotated[
        Numbers | None,
        Described("Pa", "", "largest pressure of the cylinders; not checked if not given", above=0),
    ] = None

    def __post_init__(self) -> None:
        keep_checked(self)

    @property
    def gain(self) -> Numbers:
        """Force on a wheel cylinder's piston over the force on the master cylinder's piston."""
        return (self.cylinder_bore / self.master_bore) ** 2

    @property
    def limit(self) -> Numbers:
        """Largest allowed force on the master cylinder's piston [N]; inf if no largest pressure is given."""
        return np.inf if self.most_pressure is None else self.most_pressure * self._area

    def pressure(self, force: Numbers) -> Numbers:
        """Compute the line's pressure [Pa] at a force on the master cylinder's piston [N]."""
        return force / self._area

    def stroke(self, force: Numbers) -> Numbers:
        """Compute the travel of the master cylinder's piston [m] at a force on it [N]."""
        taken = (
            self.pistons * self.piston_travel * self.gain
            + self.compliance * self.pressure(force) / self._area
        )
        return self.lost_travel + taken

    @property
    def _area(self) -> Numbers:
        return np.pi / 4 * np.square(self.master_bore)


@dataclass(frozen=True)
class BrakeCable:
    """A cable or linkage; every value may be an array, one entry per design.

    Parameters
    ----------
    cable_gain : float or ndarray
        Force on the actuator of each brake over the force in the cable behind the lever, without losses.
    efficiency : float or ndarray
        Fraction of the force that reaches the actuators in spite of friction, above 0 up to 1.
    actuator_travel : float or ndarray
        Travel of each actuator until the linings press [m].
    brakes : float or ndarray
        Number of actuators that the cable pulls, through an equalizer.
    lost_travel : float or ndarray
        Slack of the cable [m].
    stretch : float or ndarray
        Stretch of the cable over its force [m/N].

    Raises
    ------
    ValueError
        If a value is out of bounds.

    Examples
    --------
    >>> chain.BrakeCable(cable_gain=4.0, efficiency=0.8).gain
    3.2
    """

    cable_gain: Annotated[
        Numbers, Described("", "i_c", "force on each brake's actuator / force in the cable", above=0)
    ]
    efficiency: Annotated[
        Numbers,
        Described("", "eta", "share of the force that is not lost", above=0, most=1, remedy="80 % is 0.8"),
    ] = 1.0
    actuator_travel: Annotated[
        Numbers, Described("m", "s_w", "travel of each actuator until the linings press", least=0)
    ] = 0.0
    brakes: Annotated[
        Numbers, Described("", "n", "actuators that the cable pulls at", least=1, whole=True)
    ] = 2.0
    lost_travel: Annotated[Numbers, Described("m", "s_0", "slack of the cable", least=0)] = 0.0
    stretch: Annotated[Numbers, Described("m/N", "", "travel by stretch, over the force", least=0)] = 0.0

    limit = np.inf

    def __post_init__(self) -> None:
        keep_checked(self)

    @property
    def gain(self) -> Numbers:
        """Force on each actuator over the force in the cable behind the lever, with losses."""
        return self.cable_gain * self.efficiency

    def pressure(self, force: Numbers) -> Numbers:
        """Return the pressure [Pa]: nan, as a cable has no fluid."""
        return force * np.nan

    def stroke(self, force: Numbers) -> Numbers:
        """Compute the travel of the cable [m] at a force in it [N]: slack, stretch, and actuators' motion."""
        moved = self.brakes * self.cable_gain * self.actuator_travel
        return self.lost_travel + self.stretch * force + moved
