"""Scenes that tests and benchmarks share."""

from __future__ import annotations

import math
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.published import load

HARVESTER = bd.Scene(
    bd.Beam.rectangular(length=0.05, width=0.01, thickness=0.0002, youngs_modulus=200e9, density=7850.0),
    bd.Mount(radius=0.215),
)


def rolling_harvester(speed: float | bd.SpinUp) -> bd.Scene:
    """Make the harvester of Lee and Yoo (2019) in a wheel on the wavy road, at or up to a speed [rad/s]."""
    road = bd.RoadWave(wavelength=0.3, velocity_amplitude=0.01)
    return replace(HARVESTER, motion=bd.RollingWheel(rolling_radius=0.3, speed=speed, road=road))


ROLLING = rolling_harvester(bd.SpinUp(55.0, duration=10.0))  # scene of Table 3
STEADY_ROLLING = rolling_harvester(55.0)
STEADY_ROLLING_IN_GRAVITY = replace(STEADY_ROLLING, gravity=9.81)
# A short spin-up, with which a sweep takes little time.
SHORT_SPIN_UP = rolling_harvester(bd.SpinUp(55.0, duration=0.2))
AFTER_SHORT_SPIN_UP = (0.3, 0.5)  # time window of the largest deflection after `SHORT_SPIN_UP` [s]
BLADE_SPIN_UP = bd.Scene(
    bd.Beam.from_stiffness(10.0, 1.2, 1.4e4, axial_stiffness=2.8e7),
    bd.Mount(0.0, math.pi),
    bd.SpinUp(6.0, duration=15.0),
)


def steel_strip(
    slenderness: float = 100.0,
    length: float = 1.0,
    hub: float = 0.0,
    setting: float = math.pi,
    bending: float = 0.0,
    tip: float = 0.0,
) -> bd.Scene:
    """Make a steel strip ten thicknesses wide; hub radius in lengths, tip body in beam masses."""
    thickness = length / slenderness
    body = bd.TipMass(tip * 7850 * 10 * thickness**2 * length) if tip else None
    beam = bd.Beam.rectangular(length, 10 * thickness, thickness, 200e9, 7850.0, body)
    return bd.Scene(beam, bd.Mount(hub * length, setting, bending))


def time_unit(beam: bd.Beam) -> float:
    """Compute the unit of time sqrt(rho A L^4 / EI) [s], with values at the root."""
    root = np.zeros(1)
    return float(beam.length**2 * np.sqrt(beam.mass_per_length(root) / beam.bending_stiffness(root))[0])


def of_case(case: dict[str, Any]) -> bd.Scene:
    """Make the scene of a nondimensional case of the published or generated tables."""
    alpha, delta = case.get("alpha"), case["delta"]
    beam = bd.Beam.from_stiffness(
        length=1.0,
        mass_per_length=Polynomial(case["mass"]),
        bending_stiffness=Polynomial(case["stiffness"]),
        axial_stiffness=None if alpha is None else alpha**2,
        tip=bd.TipMass(**case["tip"]) if "tip" in case else None,
    )
    angle = 0.0 if delta < 0 else math.pi
    mount = bd.Mount(abs(delta), angle, math.radians(case["bending_angle_deg"]))
    return bd.Scene(beam, mount, physics=bd.Physics(stretch=case["model"] == "coupled"))


def published_cases() -> list[dict[str, Any]]:
    """Load cases printed in the literature, with the digits of the published file."""
    return load("rotating_beams")["case"]


def generated_cases() -> list[dict[str, Any]]:
    """Load cases of the power-series reference, with 20 digits."""
    path = Path(__file__).parent / "data" / "rotating_beams_more.toml"
    return tomllib.loads(path.read_text())["case"]
