"""The paper's Tables 2-7 by its own way: `stop` as printed, and `internal_forces` of the fitted brake.

Inputs come from ``brakes/published/yoo_1997.toml``. Tables 2-4 need what the paper does not say: the arm
y_cg - r1, g = 9.806 and a factor 0.97 on the slope's pull; one of their 45 numbers does not fit.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from brakes.arrays import Numbers
from brakes.forklift.duo_servo import BENDIX_12_5
from brakes.forklift.forces import InternalForces, internal_forces
from brakes.forklift.vehicle import Stop, Truck, stop
from brakes.published import load

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
    stops = _stops(paper)
    found = {
        ("table_2", "distance"): stops["table_2"].distance,
        ("table_3", "distance"): stops["table_3"].distance,
        ("table_3", "acceleration"): stops["table_3"].acceleration,
        ("table_4", "distance"): stops["table_4"].distance,
        ("table_4", "torque"): stops["table_4"].torque_per_brake,
    }
    for name, varied in (("table_5", "torque"), ("table_6", "piston_force"), ("table_7", "clearance")):
        forces = _forces(paper, varied, _column(paper, name, varied))
        found |= {(name, quantity): getattr(forces, quantity) for quantity in ("A", "B", "Q", "P_L")}
    return found


def _stops(paper: dict[str, Any]) -> dict[str, Stop]:
    """The stops of Tables 2-4."""
    over = {
        "table_2": ("friction", "speed"),
        "table_3": ("slope", "load_mass"),
        "table_4": ("empty_mass", "front_wheel_radius"),
    }
    return {
        name: _stop(
            paper,
            **{rows: _column(paper, name, rows)[:, None], columns: _column(paper, name, columns)},
        )
        for name, (rows, columns) in over.items()
    }


def _stop(paper: dict[str, Any], **varied: Numbers) -> Stop:
    base = {name: entry["value"] for name, entry in paper["input"].items()}
    case = base | varied
    return stop(
        Truck(**{name: case[name] for name in _TRUCK}),
        **{name: case[name] for name in _ROAD},
        speed=case["speed"] / 3.6,  # printed in km/h
        model="as_printed",
        distance="printed",
        factor=paper["reproduction"]["factor"]["value"],
        g=paper["reproduction"]["gravity"]["value"],
    )


def _forces(paper: dict[str, Any], varied: str, values: np.ndarray) -> InternalForces:
    base = {name: paper["input"][name]["value"] for name in _BRAKE}
    return internal_forces(BENDIX_12_5, **(base | {varied: values}))


def _column(paper: dict[str, Any], name: str, key: str) -> np.ndarray:
    return np.array(paper[name][key]["value"])
