"""Scenes of Lee and Yoo (2019), Table 1, and names of the sources of values."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from beamdyn.published import load
from beamdyn.scene.beam import Beam
from beamdyn.scene.motion import RoadWave, RollingWheel, SpinUp
from beamdyn.scene.mount import Mount
from beamdyn.scene.scene import Scene

PAPER, OWN = "paper", "independent (5)"  # sources of the values compared with; (5) is a note
BENDS = "large deflection (9)"  # why a beam that bends by any angle differs from the paper's
TOP = 150.0  # highest speed [rad/s]: the end of Fig. 6; Fig. 8 and 9 do not say where they end


def published_scene() -> Scene:
    """Scene of Lee and Yoo (2019), Table 1, without its motion."""
    inputs = _input()
    names = ("length", "width", "thickness", "youngs_modulus", "density")
    return Scene(Beam.rectangular(**{name: inputs[name] for name in names}), Mount(inputs["radius"]))


def rolling_scene() -> Scene:
    """Published scene on a wheel that spins up and rolls over the wavy road: Table 3, Fig. 5 to 7."""
    inputs, paper = _input(), load("lee_yoo_2019")
    road = RoadWave(inputs["road_wavelength"], inputs["road_velocity_amplitude"])
    spin_up = SpinUp(paper["largest_deflection"]["speed"]["value"], paper["scene"]["duration"]["value"])
    return replace(published_scene(), motion=RollingWheel(inputs["rolling_radius"], spin_up, road))


def _input() -> dict[str, Any]:
    """Values of Table 1, in SI units."""
    return {name: entry["value"] for name, entry in load("lee_yoo_2019")["input"].items()}


def decimals(value: float) -> int:
    """Number of decimals of a value as Python prints it."""
    return len(np.format_float_positional(value).partition(".")[2])
