"""Wind turbine blades from published tables of stations: scenes, and comparisons of frequencies."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

import beamdyn as bd
from beamdyn.common.results.comparison import Comparison
from beamdyn.files.decks.bmodes import convert_offsets
from beamdyn.published import load
from beamdyn.reproduce.entries import PrintedValue, compare_modes


def stations(name: str) -> dict[str, Any]:
    """Load a blade: length, hub radius [m], arrays of x/L, mass [kg/m], stiffnesses [N m2], twist [deg]."""
    given = load(f"blade_{name}")
    arrays = {key: np.array(value) for key, value in given.items() if isinstance(value, list)}
    arrays["mass_per_length"] = arrays["mass_per_length"] * given["mass_factor"]
    return given | arrays


def blade_scene(name: str, physics: bd.Physics | None = None, twisted: bool = True) -> bd.Scene:
    """Build the scene of a blade on its hub: outward, with flap out of the plane of rotation at twist 0."""
    data = stations(name)

    def along(values: np.ndarray) -> bd.Table:
        return bd.Table(data["stations"].tolist(), values.tolist())

    beam = bd.Beam.from_stiffness(
        data["length"],
        along(data["mass_per_length"]),
        along(data["flap_stiffness"]),
        second_bending_stiffness=along(data["edge_stiffness"]),
        # The signs are explained in docs/decks.md.
        twist=along(np.radians(-data["twist_deg"])) if twisted else None,
    )
    mount = bd.Mount(data["hub_radius"], math.pi, math.pi / 2)
    return bd.Scene(beam, mount, physics=physics or bd.Physics(planes=2))


def whole_blade_scene(name: str, by_elements: bool = False) -> bd.Scene:
    """Build the blade with torsion and offsets, by stations or, if `by_elements`, by BModes' elements.

    Each element of BModes has the properties of the section at its middle, but the twist varies along it.
    """
    data, plain = stations(name), blade_scene(name)
    x, ends = data["stations"], data["element_ends"]
    centres = data["mass_offset"], data["shear_offset"], data["tension_offset"]
    given = {
        "mass_per_length": data["mass_per_length"],
        "bending_stiffness": data["flap_stiffness"],
        "rotary_inertia": data["flap_inertia"],
        "second_rotary_inertia": data["edge_inertia"],
        "torsion_stiffness": data["torsion_stiffness"],
    }

    def along(values: np.ndarray) -> bd.Table:
        if not by_elements:
            return bd.Table(x.tolist(), values.tolist())
        in_the_middle = np.interp((ends[:-1] + ends[1:]) / 2, x, values)
        return bd.Table(np.repeat(ends, 2)[1:-1].tolist(), np.repeat(in_the_middle, 2).tolist())

    given |= convert_offsets(data["edge_stiffness"], data["axial_stiffness"], *centres)
    sections: dict[str, Any] = {name: along(values) for name, values in given.items()}
    beam = bd.Beam.from_stiffness(data["length"], **sections, twist=plain.beam.twist)
    return bd.Scene(beam, plain.mount, physics=bd.Physics(planes=2, torsion=True))


def _compare_blades(key: str, discretization: str = "ritz") -> Iterator[tuple[str, PrintedValue]]:
    """Compare published frequencies [Hz] of blades with computed ones: yield blade name, comparison.

    `key` is the name of the published frequencies in the data of each blade.
    """
    for row in load("blades")["blade"]:
        if printed := row.get(key):
            whole = key == "frequency_printed_by_bmodes"
            plain = blade_scene(row["name"], twisted=key != "frequency_without_twist")
            scene = whole_blade_scene(row["name"], by_elements=True) if whole else plain
            modes = bd.natural_modes(scene, row["speed_rpm"] * math.pi / 30, len(printed), discretization)
            for entry in compare_modes(f"{row['speed_rpm']:g} rpm", printed, modes.frequency, modes.error):
                yield row["name"], entry


def entries_of_blades(discretization: str) -> Iterator[tuple[str, PrintedValue]]:
    """Compare published frequencies [Hz] of all blades with computed ones; yield blade title, comparison."""
    for key in ("frequency", "frequency_without_twist"):
        for name, entry in _compare_blades(key, discretization):
            yield stations(name)["title"], entry


def printed_by_bmodes() -> Iterator[Comparison]:
    """Compare the frequencies [Hz] computed for BModes' test blade with those that BModes prints."""
    for _, entry in _compare_blades("frequency_printed_by_bmodes"):
        what, decimals = f"{entry.where}, mode {entry.mode}", len(entry.printed.partition(".")[2])
        numbers = float(entry.printed), entry.ours, entry.error, decimals
        yield Comparison(what, "BModes 3", *numbers, "no rotary inertia (10)")


def notes() -> list[str]:
    """Return notes on the printed frequencies; their numbers continue those of Lee and Yoo's notes."""
    return load("blades")["notes"]
