"""Files of cases with two planes of bending, twist, shear and rotary inertia, and their scenes."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

import beamdyn as bd
from beamdyn.published import load
from beamdyn.scene.beam import OPTIONAL_PROPERTIES
from benchmarks.cases.reference.twisted_beam.cases import piecewise

_DATA = Path(__file__).parent / "data"
_PROPERTIES = ("mass_per_length", "bending_stiffness", *OPTIONAL_PROPERTIES)


def models() -> dict[str, Any]:
    """Load the rows of the models: tables `case`, `carnegie` and `blade`."""
    return load("twisted_beams") | load("blades")


def second_method_cases() -> list[dict[str, Any]]:
    """Load twenty cases solved by collocation (`benchmarks.cases.reference.twisted_beam`), to 12 digits."""
    return tomllib.loads((_DATA / "second_method.toml").read_text(encoding="utf-8"))["case"]


def scene_of(case: dict[str, Any]) -> bd.Scene:
    """Make the scene of a case with unit length, mass and stiffness: the speed gamma is in rad/s."""
    stops = case.get("breakpoints", ())
    tip = bd.TipMass(**case["tip"]) if "tip" in case else None
    properties = {name: piecewise(case[name], stops) for name in _PROPERTIES if name in case}
    beam = bd.Beam.from_stiffness(1.0, **properties, tip=tip, breakpoints=stops)
    angles = (math.radians(case[name]) for name in ("setting_angle_deg", "bending_angle_deg"))
    mount = bd.Mount(case["radius"], *angles, *case.get("root_stiffness", ()))
    shear, rotary = "shear_stiffness" in case, "rotary_inertia" in case
    return bd.Scene(beam, mount, physics=bd.Physics(case["planes"], shear=shear, rotary_inertia=rotary))


def carnegie_scene() -> bd.Scene:
    """Make Carnegie's twisted blade at rest, without shear and rotary inertia."""
    keys = ("length", "width", "thickness", "youngs_modulus", "density")
    given = models()["carnegie"]
    twist = np.polynomial.Polynomial([0.0, math.radians(given["twist_deg"])])
    beam = bd.Beam.rectangular(**{key: given[key] for key in keys}, twist=twist)
    return bd.Scene(beam, bd.Mount(0.0, math.pi), physics=bd.Physics(planes=2))
