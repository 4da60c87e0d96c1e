"""Load of a brake: actuating force, largest pressure or torque; and the force of a wheel cylinder."""

from __future__ import annotations

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, not_negative, positive

UNITS = {"force": "N", "peak_pressure": "Pa", "torque": "N m"}


def take_load(**given: Numbers | None) -> tuple[str, Numbers]:
    """Return name and checked value of the given load: force, peak_pressure or torque.

    Raises
    ------
    ValueError
        If not exactly one load is given, or the load is not positive.
    """
    present = {name: value for name, value in given.items() if value is not None}
    if len(present) != 1:
        got = " and ".join(present) or "none"
        raise ValueError(f"give exactly one of {', '.join(given)}; got {got}")
    name, value = next(iter(present.items()))
    return name, positive(name, value, UNITS[name])


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
