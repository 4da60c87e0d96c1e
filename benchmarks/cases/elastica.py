"""Beams with large deflection: published cases as scenes, and our cases for `reference.elastica`."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any, Literal

import beamdyn as bd
from beamdyn.published import load
from benchmarks.cases.reference.of_elastica import SceneAnswer, answer, bent_answer
from benchmarks.cases.reference.twisted_beam.cases import piecewise
from benchmarks.cases.scenes import HARVESTER

Branch = Literal["straight", "bent"]

# Published ------------------------------------------------------------------------------------------


def published() -> dict[str, Any]:
    """Load the published tables of beams with large deflection (frequencies, pitchforks, folds)."""
    return load("elastica")


def scene_of(row: dict[str, Any]) -> bd.Scene:
    """Make the scene of a published nondimensional case; the speed gamma is taken in rad/s."""
    angles = (math.radians(row[name]) for name in ("setting_angle_deg", "bending_angle_deg"))
    beam, physics = bd.Beam.from_stiffness(1.0, 1.0, 1.0), _physics(branch=row["branch"])
    return bd.Scene(beam, bd.Mount(row["radius"], *angles), physics=physics)


def harvester_at(setting_angle_deg: float, branch: Branch = "straight") -> bd.Scene:
    """Make the harvester of Lee and Yoo (2019) at a setting angle."""
    mount = replace(HARVESTER.mount, setting_angle=math.radians(setting_angle_deg))
    return replace(HARVESTER, mount=mount, physics=_physics(branch=branch))


def _physics(rotary_inertia: bool = False, branch: Branch = "straight") -> bd.Physics:
    return bd.Physics(rotary_inertia=rotary_inertia, large_deflection=True, branch=branch)


# Our own --------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Case:
    """A scene at a speed; properties are lists of polynomial coefficients in x/L, one for each piece.

    Parameters
    ----------
    speed
        Speed [rad/s], equal to gamma because length, and mass and stiffness at the root, are 1.
    radius, setting, bending
        Radius and angles [deg] of the mount.
    beam
        Arguments of `Beam.from_stiffness`.
    tip
        Arguments of `TipMass`.
    bent_to
        0 for the branch of equilibria from rest; 1 or -1 for the other branch, bent to this side.
    """

    name: str
    speed: float
    radius: float
    setting: float
    bending: float = 0.0
    beam: dict[str, Any] = field(default_factory=dict)
    tip: dict[str, float] = field(default_factory=dict)
    spring: float = math.inf
    bent_to: int = 0

    @property
    def scene(self) -> bd.Scene:
        given = {"length": 1.0, "mass_per_length": [1.0], "bending_stiffness": [1.0]} | self.beam
        stops = given.get("breakpoints", ())
        for name in ("mass_per_length", "bending_stiffness", "rotary_inertia"):
            if name in given:
                given[name] = piecewise(given[name], stops)
        beam = bd.Beam.from_stiffness(**given, tip=bd.TipMass(**self.tip) if self.tip else None)
        mount = bd.Mount(self.radius, math.radians(self.setting), math.radians(self.bending), self.spring)
        return bd.Scene(beam, mount, physics=_physics("rotary_inertia" in given, self.branch))

    @property
    def branch(self) -> Branch:
        return "bent" if self.bent_to else "straight"


@cache
def reference_answer(number: int) -> SceneAnswer:
    """Solve the case at an index of `CASES` by collocation (`reference.elastica`)."""
    case = CASES[number]
    if case.bent_to:
        return bent_answer(case.scene, case.speed, case.bent_to)
    return answer(case.scene, case.speed)


TAPER = {"mass_per_length": [1.0, -0.5], "bending_stiffness": [1.0, -0.7]}
CURVED_TAPER = {"mass_per_length": [1.0, 0.3, -0.7], "bending_stiffness": [1.0, -1.2, 0.6, -0.1]}
WEDGE = {"mass_per_length": [1.0, -0.8], "bending_stiffness": [1.0, -2.4, 1.92, -0.512]}
ROTARY = {"rotary_inertia": [0.004]}
TAPERED_ROTARY = {"rotary_inertia": [0.006, -0.004]}
JUMP = {
    "breakpoints": (0.4,),
    "mass_per_length": [[1.0], [0.6, -0.2]],
    "bending_stiffness": [[1.0], [0.5, -0.2]],
}
TWO_JUMPS = {
    "breakpoints": (0.15, 0.625),
    "mass_per_length": [[1.0], [0.7], [0.4, 0.1]],
    "bending_stiffness": [[1.0, 0.5], [0.6], [0.3]],
    "rotary_inertia": [[0.004], [0.002, 0.001], [0.001]],
}
STEEL = {"length": 0.4, "mass_per_length": [0.157], "bending_stiffness": [0.45, -0.2]}
BODY = {"mass": 0.4, "offset": 0.06, "inertia": 0.012, "transverse_inertia": 0.02, "axial_inertia": 0.017}
FLAT_BODY = {
    "mass": 0.25,
    "offset": -0.03,
    "inertia": 0.003,
    "transverse_inertia": 0.024,
    "axial_inertia": 0.026,
}
LONG_BODY = {
    "mass": 0.3,
    "offset": 0.15,
    "inertia": 0.03,
    "transverse_inertia": 0.031,
    "axial_inertia": 0.002,
}
OUT = 90.0

CASES = [
    Case("tangential, trailing", 1.0, 2.0, 90),
    Case("tangential, leading", 3.0, 1.0, -90),
    Case("tangential, bent to +b2 only by sign", 2.0, 1.5, 90, 180),
    Case("hub of radius 0", 4.0, 0.0, 0),
    Case("outward, straight: nothing bends", 5.0, 0.5, 180),
    Case("taper at 60 deg", 1.2, 2.0, 60, beam=TAPER),
    Case("curved taper at 120 deg, fast", 4.0, 1.0, 120, beam=CURVED_TAPER),
    Case("wedge at 45 deg", 0.6, 3.0, 45, beam=WEDGE),
    Case("jump at 75 deg", 1.3, 2.5, 75, beam=JUMP),
    Case("two jumps, rotary inertia, 80 deg, fast", 2.5, 2.0, 80, beam=TWO_JUMPS),
    Case("rotary inertia, trailing", 2.0, 1.5, 90, beam=ROTARY),
    Case("tapered rotary inertia at 30 deg", 0.9, 3.0, 30, beam=TAPER | TAPERED_ROTARY),
    Case("body, trailing", 1.0, 1.5, 90, tip=BODY),
    Case("body beyond the tip, 150 deg, fast", 3.0, 1.5, 150, tip=LONG_BODY),
    Case("body inboard of the tip, taper, -60 deg", 0.9, 2.0, -60, beam=TAPER, tip=FLAT_BODY),
    Case("spring, trailing", 1.0, 1.5, 90, spring=3.0),
    Case("soft spring and body, 100 deg", 2.0, 1.0, 100, tip=BODY, spring=0.5),
    Case("all at once, 70 deg", 1.1, 1.7, 70, beam=TWO_JUMPS, tip=LONG_BODY, spring=8.0),
    Case("metres and kilogrammes", 9.0, 0.3, 110, beam=STEEL, tip={"mass": 0.02, "offset": 0.01}),
    Case("tip turned beyond a quarter turn", 4.5, 3.0, 70, beam=TAPER),
    Case("inward, bent", 1.45, 4.3, 0, bent_to=1),
    Case("inward, bent, taper and body", 1.2, 3.0, 0, beam=TAPER, tip=BODY, bent_to=1),
    Case("inward at 5 deg, beside the branch from rest", 1.8, 4.3, 5, bent_to=1),
    Case("inward, bent out", 2.0, 3.0, 0, OUT, bent_to=1),
    Case("inward, bent out, rotary inertia", 2.4, 3.0, 0, OUT, TAPER | TAPERED_ROTARY, bent_to=1),
    Case("inward, bent out, body", 1.45, 3.0, 0, OUT, tip=LONG_BODY, bent_to=1),
    Case("inward, bent out to the other axis, flat body", 1.6, 3.0, 0, -OUT, JUMP, FLAT_BODY, bent_to=1),
    Case("inward at 40 deg, bent out, spring", 1.3, 3.0, 40, OUT, TWO_JUMPS, BODY, 6.0, bent_to=1),
    Case("outward, out of the plane, all at once", 4.0, 0.5, 180, OUT, TWO_JUMPS, LONG_BODY, 5.0),
]
