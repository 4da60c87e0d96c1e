"""Blades of wind turbines of the published tables of stations: scenes, and comparison of frequencies."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from beamdyn.common.results.comparison import Comparison
from beamdyn.modes.modes import Modes, natural_modes
from beamdyn.published import load
from beamdyn.reproduce.entries import PrintedValue
from beamdyn.scene.beam import Beam
from beamdyn.scene.mount import Mount
from beamdyn.scene.physics import Physics
from beamdyn.scene.profile import Table
from beamdyn.scene.scene import Scene

_NOT_MODELLED = "not all is modelled (10)"
_TWO_PLANES = Physics(planes=2)


def stations(name: str) -> dict[str, Any]:
    """Length and hub radius [m], and arrays: stations x/L, mass [kg/m], stiffnesses [N m2], twist [deg]."""
    given = load(f"blade_{name}")
    arrays = {key: np.array(value) for key, value in given.items() if isinstance(value, list)}
    arrays["mass_per_length"] = arrays["mass_per_length"] * given["mass_factor"]
    return given | arrays


def blade_scene(name: str, physics: Physics = _TWO_PLANES, twisted: bool = True) -> Scene:
    """The blade on its hub: it points outward and, where the twist is 0, the flap bends out of the plane."""
    data = stations(name)

    def along(values: np.ndarray) -> Table:
        return Table(data["stations"].tolist(), values.tolist())

    beam = Beam.from_stiffness(
        data["length"],
        along(data["mass_per_length"]),
        along(data["flap_stiffness"]),
        second_bending_stiffness=along(data["edge_stiffness"]),
        twist=along(np.radians(-data["twist_deg"])) if twisted else None,  # docs/decks.md has the signs
    )
    return Scene(beam, Mount(data["hub_radius"], math.pi, math.pi / 2), physics=physics)


def entries_of_blades(discretization: str) -> Iterator[tuple[str, PrintedValue]]:
    """Compare the frequencies [Hz] of all blades, each under the title of its blade."""
    for row in load("blades")["blade"]:
        title, where = stations(row["name"])["title"], f"{row['speed_rpm']:g} rpm"
        for key, twisted in (("frequency", True), ("frequency_without_twist", False)):
            if printed := row.get(key):
                modes = _modes(row, len(printed), discretization, twisted)
                for i, text in enumerate(printed):
                    error = float(modes.error[i] * modes.frequency[i])
                    yield title, PrintedValue(where, i + 1, text, float(modes.frequency[i]), error)


def printed_by_bmodes() -> Iterator[Comparison]:
    """Compare with what BModes prints of its own blade, whose sections also twist and are offset [Hz]."""
    for row in load("blades")["blade"]:
        if printed := row.get("frequency_printed_by_bmodes"):
            modes = _modes(row, len(printed), "ritz")
            for i, text in enumerate(printed):
                ours, error = float(modes.frequency[i]), float(modes.error[i] * modes.frequency[i])
                decimals = len(text.partition(".")[2])
                what = f"{row['speed_rpm']:g} rpm, mode {i + 1}"
                yield Comparison(what, "BModes 3", float(text), ours, error, decimals, _NOT_MODELLED)


def notes() -> Iterator[str]:
    """Notes on the table of BModes."""
    yield (
        "(10) Of BModes' blade the table has mass, two bending stiffnesses and twist. BModes also has "
        "torsion, inertia and offsets of the sections: rotary inertia is worth at most 0.3 %, the rest is, "
        "by elimination, torsion, offsets and its formulation."
    )


def _modes(row: dict[str, Any], count: int, discretization: str, twisted: bool = True) -> Modes:
    scene = blade_scene(row["name"], twisted=twisted)
    return natural_modes(scene, row["speed_rpm"] * math.pi / 30, count, discretization)
