"""Blades of wind turbines from the tables of stations in `data/blades`: scenes and reference blades."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

import beamdyn as bd
from benchmarks.cases.reference.twisted_beam import Blade
from benchmarks.cases.reference.twisted_beam.blade import Function

_FOLDER = Path(__file__).parent / "data" / "blades"
NAMES = ("iea_15", "nrel_5", "bmodes_test01")


def stations(name: str) -> dict[str, Any]:
    """Length and hub radius [m], and arrays: stations x/L, mass [kg/m], stiffnesses [N m2], twist [deg]."""
    given = tomllib.loads((_FOLDER / f"{name}.toml").read_text(encoding="utf-8"))
    arrays = {key: np.array(value) for key, value in given.items() if isinstance(value, list)}
    arrays["mass_per_length"] = arrays["mass_per_length"] * given["mass_factor"]
    return given | arrays


def blade_scene(name: str, physics: bd.Physics = bd.Physics(planes=2), twisted: bool = True) -> bd.Scene:  # noqa: B008
    """The blade on its hub: it points outward and, where the twist is 0, the flap bends out of the plane."""
    data = stations(name)

    def along(values: np.ndarray) -> bd.Table:
        return bd.Table(data["stations"].tolist(), values.tolist())

    beam = bd.Beam.from_stiffness(
        data["length"],
        along(data["mass_per_length"]),
        along(data["flap_stiffness"]),
        second_bending_stiffness=along(data["edge_stiffness"]),
        twist=along(np.radians(-data["twist_deg"])) if twisted else None,  # docs/decks.md has the signs
    )
    return bd.Scene(beam, bd.Mount(data["hub_radius"], math.pi, math.pi / 2), physics=physics)


def reference_blade(name: str, twisted: bool = True) -> tuple[Blade, float]:
    """The blade for the second method, over mass and stiffness of its root, and its unit of time [s]."""
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
