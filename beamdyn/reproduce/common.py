"""What the sections share: the published scene, the names of sources."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from beamdyn.published import load
from beamdyn.scene.beam import Beam
from beamdyn.scene.motion import RoadWave, RollingWheel, SpinUp
from beamdyn.scene.mount import Mount
from beamdyn.scene.scene import Scene

PAPER, OWN = "paper", "independent (5)"
TOP = 150.0  # rad/s: Fig. 6 ends here; Fig. 8 and 9 do not say where they end


def published_scene() -> Scene:
    """The scene of Lee and Yoo (2019), Table 1, without its motion."""
    given = _input()
    names = ("length", "width", "thickness", "youngs_modulus", "density")
    return Scene(Beam.rectangular(**{name: given[name] for name in names}), Mount(given["radius"]))


def rolling_scene() -> Scene:
    """The same on a wheel that spins up and rolls over the wavy road: Table 3, Fig. 5 to 7."""
    given, paper = _input(), load("lee_yoo_2019")
    road = RoadWave(given["road_wavelength"], given["road_velocity_amplitude"])
    spin_up = SpinUp(paper["largest_deflection"]["speed"]["value"], paper["scene"]["duration"]["value"])
    return replace(published_scene(), motion=RollingWheel(given["rolling_radius"], spin_up, road))


def _input() -> dict[str, Any]:
    return {name: entry["value"] for name, entry in load("lee_yoo_2019")["input"].items()}


def decimals(value: float) -> int:
    """Decimals with which a value is written."""
    return len(np.format_float_positional(value).partition(".")[2])
