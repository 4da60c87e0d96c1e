"""Energy that the brakes absorb in a stop, and the temperature rise that it causes."""

from __future__ import annotations

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, not_negative, numbers, positive
from beamdyn.common.inputs.checks import refuse


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
        Speed before and after the stop [m/s].
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
        If a value is out of bounds, the final speed is not below the initial one, or the radius is missing.

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
    Standard: all energy stays in the drum, which has the same temperature everywhere.

    Examples
    --------
    >>> drum.temperature_rise(energy=100e3, drum_mass=5.0)  # K
    40.0
    """
    part = not_negative("share", share)
    refuse(np.asarray(part) > 1, "share", part, "", "give a fraction of the energy, from 0 to 1")
    heated = positive("drum_mass", drum_mass, "kg") * positive("specific_heat", specific_heat, "J/(kg K)")
    return not_negative("energy", energy, "J") * part / heated
