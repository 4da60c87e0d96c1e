"""Blades of wind turbines from the published tables of stations: scenes and reference blades."""

from __future__ import annotations

import math

import numpy as np

from beamdyn.reproduce.blades import blade_scene, stations
from benchmarks.cases.reference.twisted_beam import Blade
from benchmarks.cases.reference.twisted_beam.blade import Function

__all__ = ["NAMES", "blade_scene", "reference_blade", "stations"]

NAMES = ("iea_15", "nrel_5", "bmodes_test01")


def reference_blade(name: str, twisted: bool = True) -> tuple[Blade, float]:
    """Return a blade for `reference.twisted_beam`, in units of root properties, and the unit of time [s]."""
    data = stations(name)
    x, length = data["stations"], data["length"]
    mass, stiffness = data["mass_per_length"][0], data["flap_stiffness"][0]

    def along(values: np.ndarray) -> Function:
        return lambda xi: np.interp(xi, x, values)

    blade = Blade(
        mass=along(data["mass_per_length"] / mass),
        stiffness=(along(data["flap_stiffness"] / stiffness), along(data["edge_stiffness"] / stiffness)),
        twist=along(np.radians(-data["twist_deg"]) * twisted),
        hub=data["hub_radius"] / length,
        bending_angle=math.pi / 2,
        breakpoints=x[1:-1].tolist(),
    )
    return blade, length**2 * math.sqrt(mass / stiffness)
