"""The paper's Tables 2-7 by its own way, the same by the corrected mechanics, and what each error costs.

Inputs come from ``brakes/published/yoo_1997.toml``. Tables 2-4 need what the paper does not say: the arm
y_cg - r1, g = 9.806 and a factor 0.97 on the slope's pull; one of their 45 numbers does not fit.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from beamdyn.common.array_checks import Numbers
from brakes.forklift.duo_servo import BENDIX_12_5
from brakes.forklift.forces import InternalForces, internal_forces
from brakes.forklift.vehicle import Stop, Truck, stop
from brakes.published import load
from brakes.published.errata import Erratum

_TRUCK = ("empty_mass", "empty_cg", "load_mass", "load_cg", "front_wheel_radius", "wheelbase")
_ROAD = ("slope", "friction", "reaction_time", "rise_time")
_BRAKE = ("torque", "piston_force", "clearance")


def tables() -> dict[tuple[str, str], np.ndarray]:
    """Our numbers for the printed ones, by table and quantity, e.g. ``("table_4", "torque")``, in SI units.

    Returns
    -------
    dict of ndarray
        Shapes (3, 3) for Tables 2-4, (3,) for Tables 5-7, rows and columns as printed.
    """
    paper = load("yoo_1997")
    found = _vehicle(_stops(paper, _printed(paper)))
    for name, varied in (("table_5", "torque"), ("table_6", "piston_force"), ("table_7", "clearance")):
        forces = _forces(paper, varied, _column(paper, name, varied))
        found |= {(name, quantity): getattr(forces, quantity) for quantity in ("A", "B", "Q", "P_L")}
    return found


def corrected_tables() -> dict[tuple[str, str], np.ndarray]:
    """Tables 2-4 by the corrected mechanics, in SI units; the distance is inf where the truck never stops."""
    paper = load("yoo_1997")
    return _vehicle(_stops(paper, _corrected(paper)))


def base_stop(corrected: bool = True, **varied: Numbers) -> Stop:
    """The stop at the paper's base case, or with some of its inputs varied.

    Parameters
    ----------
    corrected : bool
        Whether by the corrected mechanics, or as printed.
    **varied : float or ndarray
        Inputs of the paper's Table 1, in its units: the speed in km/h.
    """
    paper = load("yoo_1997")
    return _stop(paper, (_corrected if corrected else _printed)(paper), **varied)


def errata() -> tuple[Erratum, ...]:
    """The paper's errors, each with its consequence at the base case computed."""
    entries = load("yoo_1997")["erratum"]
    return tuple(Erratum(**known, **_CONSEQUENCES.get(known["name"], dict)()) for known in entries)


def _printed(paper: dict[str, Any]) -> dict[str, Any]:
    """What reproduces Tables 2-4."""
    given = {name: paper["reproduction"][name]["value"] for name in ("factor", "gravity")}
    return {"model": "as_printed", "distance": "printed", "factor": given["factor"], "g": given["gravity"]}


def _corrected(paper: dict[str, Any]) -> dict[str, Any]:
    return {"model": "corrected", "distance": "exact", "g": paper["reproduction"]["gravity"]["value"]}


def _vehicle(stops: dict[str, Stop]) -> dict[tuple[str, str], np.ndarray]:
    return {
        ("table_2", "distance"): stops["table_2"].distance,
        ("table_3", "distance"): stops["table_3"].distance,
        ("table_3", "acceleration"): stops["table_3"].acceleration,
        ("table_4", "distance"): stops["table_4"].distance,
        ("table_4", "torque"): stops["table_4"].torque_per_brake,
    }


def _stops(paper: dict[str, Any], how: dict[str, Any]) -> dict[str, Stop]:
    """The stops of Tables 2-4."""
    over = {
        "table_2": ("friction", "speed"),
        "table_3": ("slope", "load_mass"),
        "table_4": ("empty_mass", "front_wheel_radius"),
    }
    return {
        name: _stop(
            paper,
            how,
            **{rows: _column(paper, name, rows)[:, None], columns: _column(paper, name, columns)},
        )
        for name, (rows, columns) in over.items()
    }


def _stop(paper: dict[str, Any], how: dict[str, Any], **varied: Numbers) -> Stop:
    base = {name: entry["value"] for name, entry in paper["input"].items()}
    case = base | varied
    return stop(
        Truck(**{name: case[name] for name in _TRUCK}),
        **{name: case[name] for name in _ROAD},
        speed=case["speed"] / 3.6,  # printed in km/h
        **how,
    )


def _forces(paper: dict[str, Any], varied: str, values: np.ndarray) -> InternalForces:
    base = {name: paper["input"][name]["value"] for name in _BRAKE}
    return internal_forces(BENDIX_12_5, **(base | {varied: values}))


def _column(paper: dict[str, Any], name: str, key: str) -> np.ndarray:
    return np.array(paper[name][key]["value"])


# Consequences ---------------------------------------------------------------------------------------


def _entry(quantity: str, unit: str, printed: Numbers, right: Numbers) -> dict[str, Any]:
    return {"quantity": quantity, "unit": unit, "printed_value": float(printed), "right_value": float(right)}


def _torque_without_reaction() -> dict[str, Any]:
    """By moments about the axle without the brake torque: the arm is y_cg."""
    right = base_stop()
    t, mu = right.truck, right.friction
    y, r1 = t.cg[1], t.front_wheel_radius
    ratio = (t.wheelbase + mu * (y + r1)) / (t.wheelbase + mu * y)
    return _entry("torque of one brake", "N m", right.torque_per_brake * ratio, right.torque_per_brake)


def _twice() -> dict[str, Any]:
    printed, right = base_stop(corrected=False), base_stop()
    return _entry("torque of one brake", "N m", printed.torque_per_brake, right.torque_per_brake)


def _factor() -> dict[str, Any]:
    paper = load("yoo_1997")
    factor = paper["reproduction"]["factor"]["value"]
    with_factor = _stop(paper, _corrected(paper) | {"factor": factor})
    return _entry("acceleration", "m/s2", with_factor.acceleration, base_stop().acceleration)


def _unladen() -> dict[str, Any]:
    paper = load("yoo_1997")
    printed, right = (_stop(paper, how(paper), load_mass=0.0) for how in (_printed, _corrected))
    return _entry("acceleration unladen", "m/s2", printed.acceleration, right.acceleration)


def _speed_lost() -> dict[str, Any]:
    paper = load("yoo_1997")
    printed = _stop(paper, _corrected(paper) | {"distance": "printed"})
    return _entry("distance by the corrected acceleration", "m", printed.distance, base_stop().distance)


def _axle() -> dict[str, Any]:
    torque = base_stop().torque_per_brake
    return _entry("torque of one brake", "N m", 2 * torque, torque)


_CONSEQUENCES: dict[str, Callable[[], dict[str, Any]]] = {
    "body_moment": _torque_without_reaction,
    "twice": _twice,
    "factor": _factor,
    "unladen": _unladen,
    "speed_lost": _speed_lost,
    "axle": _axle,
}
