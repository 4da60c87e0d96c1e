"""The list of terms: what is in a scene, and why."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from functools import reduce

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.cli import DONE, main
from beamdyn.equations.assembly import assemble_equations
from beamdyn.equations.explanations import SampledScene
from beamdyn.equations.fields import FIELDS
from benchmarks.cases.scenes import BLADE_SPIN_UP, HARVESTER, ROLLING

TIP = bd.TipMass(0.001, inertia=1e-6, axial_inertia=4e-7)
COUPLED = replace(BLADE_SPIN_UP, physics=bd.Physics(stretch=True), damping_ratio=0.01)


STRIP = bd.Beam.rectangular(0.05, 0.01, 0.002, 200e9, 7850.0, TIP, twist=0.3, poissons_ratio=0.3)
STRAIGHT = replace(STRIP, twist=None, tip=None)
ALL = bd.Physics(planes=2, shear=True, rotary_inertia=True, stretch=True)


def in_two_planes(beam: bd.Beam = STRIP, bending: float = 0.4, **physics: bool) -> bd.Scene:
    return bd.Scene(beam, bd.Mount(0.2, 0.3, bending), physics=bd.Physics(planes=2, **physics))


def turned(setting: float = 0.0, bending: float = 0.0) -> bd.Scene:
    return replace(HARVESTER, mount=bd.Mount(0.215, setting, bending))


def turned_up(bending: float, planes: int = 2, **physics: bool) -> bd.Scene:
    mount = bd.Mount(0.2, math.pi, bending, precone=0.3)
    return bd.Scene(STRIP, mount, physics=bd.Physics(planes=planes, **physics))


HINGED_IN_ONE = replace(in_two_planes(), mount=bd.Mount(0.2, 0.3, 0.4, second_root_stiffness=0.0))
EXPLANATIONS = {name: text for field in FIELDS for name, text in field.explanations.items()}

BLADE_BESIDE = bd.Scene(
    bd.Beam.from_stiffness(
        1.0, 2.0, 30.0, 1e5, second_bending_stiffness=70.0, twist=0.2, torsion_stiffness=9.0,
        rotary_inertia=1e-4, second_rotary_inertia=4e-3, mass_offset=0.03, tension_offset=0.01,
        tip=bd.TipMass(1.0, inertia=1.0, transverse_inertia=0.8, axial_inertia=0.5),
    ),
    bd.Mount(0.3, math.pi, math.pi / 2),
    physics=bd.Physics(planes=2, torsion=True),
)  # fmt: skip
PRECONED = bd.Mount(0.3, math.pi, 1.0, precone=0.3)
SCENES = {
    "harvester": HARVESTER,
    "rolling": ROLLING,
    "at rest": replace(HARVESTER, motion=bd.SteadyRotation(0.0)),
    "gravity": replace(HARVESTER, gravity=9.81),
    "outward": turned(math.pi),
    "tangential": turned(math.pi / 2),
    "nearly tangential": turned(math.pi / 2 - 1e-12),
    "oblique": turned(0.3, 0.4),
    "flapwise": turned(bending=math.pi / 2),
    "tip body": replace(turned(bending=0.4), beam=replace(HARVESTER.beam, tip=TIP)),
    "spin-up": BLADE_SPIN_UP,
    "coupled": COUPLED,
    "two planes": in_two_planes(),
    "two planes, straight": in_two_planes(STRAIGHT, 0.0, rotary_inertia=True),
    "two planes, straight, oblique": in_two_planes(STRAIGHT, rotary_inertia=True),
    "two planes, straight tip body": in_two_planes(replace(STRIP, twist=None), math.pi / 2),
    "shear": replace(in_two_planes(shear=True), physics=bd.Physics(shear=True, rotary_inertia=True)),
    "all": replace(COUPLED, beam=STRIP, physics=ALL),
    "precone": turned_up(1.0),
    "precone, in the plane": turned_up(0.0, planes=1),
    "precone, flapwise": turned_up(math.pi / 2, planes=1, stretch=True),
    "precone, spin-up": replace(
        turned_up(0.4, stretch=True, rotary_inertia=True), motion=BLADE_SPIN_UP.motion
    ),
    "offsets": replace(BLADE_BESIDE, motion=bd.SteadyRotation(3.0)),
    "offsets, all": replace(BLADE_BESIDE, motion=BLADE_SPIN_UP.motion, mount=PRECONED, gravity=9.81),
    "offsets, one plane": replace(
        BLADE_BESIDE, physics=bd.Physics(torsion=True), mount=bd.Mount(0.3, math.pi, 1.0)
    ),
    "offsets, stretch": replace(BLADE_BESIDE, physics=bd.Physics(planes=2, torsion=True, stretch=True)),
    "on a spring": replace(HARVESTER, mount=bd.Mount(0.2, root_stiffness=0.1)),
    "on a hinge": replace(HARVESTER, mount=bd.Mount(0.2, root_stiffness=0.0)),
    "the other plane on a spring": replace(HARVESTER, mount=bd.Mount(0.2, second_root_stiffness=0.1)),
}


@pytest.mark.parametrize("name", SCENES)
def test_reasons_agree_with_what_is_assembled(name: str) -> None:
    """A term is there if and only if all that it is said to need is there."""
    sampled = SampledScene(SCENES[name])
    for entry in bd.terms(SCENES[name]):
        assert entry.present == all(c.is_met(sampled) for c in EXPLANATIONS[entry.name].conditions), entry
        assert entry.reason and entry.reason != "its coefficient is zero"


def test_every_term_of_the_equations_has_a_meaning() -> None:
    complete = reduce(lambda scene, field: field.complete(scene), FIELDS, SCENES["all"])
    both = [assemble_equations(scene, bd.Ritz(3)) for scene in (complete, SCENES["offsets, all"])]
    names = {term.name for each in both for term in (*each.terms, *each.loads)}
    assert names == set(EXPLANATIONS)


@pytest.mark.parametrize(
    "scene, name, words",
    [
        (HARVESTER, "root acceleration", "the beam is radial, so no static load"),
        (HARVESTER, "damping", "no damping"),
        (HARVESTER, "spin of the tip body", "no tip body"),
        (SCENES["on a hinge"], "root spring", "the root is a hinge: it turns freely"),
        (HARVESTER, "root spring", "the root is clamped"),
        (SCENES["two planes"], "root spring", "the root is clamped"),
        (HINGED_IN_ONE, "root spring", "clamped in one plane, hinged in the other"),
        (SCENES["two planes, straight"], "twisting by inertia", "no product of inertia"),
        (HARVESTER, "angular acceleration", "constant speed"),
        (turned(bending=math.pi / 2), "spin softening", "bending angle is 90 deg"),
        (turned(math.pi / 2), "tension by root acceleration", "setting angle is 90 deg"),
        (BLADE_SPIN_UP, "tension by root acceleration", "on the axis"),
        (SCENES["at rest"], "centrifugal stiffening", "does not turn"),
    ],
)
def test_what_is_left_out(scene: bd.Scene, name: str, words: str) -> None:
    entry = bd.terms(scene)[name]
    assert not entry.present and entry.largest == 0 and words in entry.reason


def test_what_physics_is_left_out() -> None:
    def names(scene: bd.Scene) -> list[str]:
        return [effect.name for effect in bd.terms(scene).left_out]

    switched = [
        "second plane of bending",
        "twist",
        "shear deformation",
        "rotary inertia of sections",
        "camber of sections",
        "stretch",
    ]
    excluded, never = ["large deflection", "torsion"], ["offsets of sections", "contact"]
    assert names(SCENES["all"]) == ["camber of sections", *excluded, *never]  # a twisted beam has no camber
    plain = replace(HARVESTER, beam=STRIP)
    assert names(plain) == [*switched, *excluded, *never]
    assert "twist" not in names(HARVESTER)
    plate = replace(HARVESTER, beam=STRAIGHT, physics=bd.Physics(camber=True, torsion=True))
    assert not {"camber of sections", "torsion"} & {*names(plate)}
    by_stiffness = replace(HARVESTER, beam=bd.Beam.from_stiffness(1.0, 1.0, 1.0))
    reasons = {effect.name: effect.reason for effect in bd.terms(by_stiffness).left_out}
    assert "with shear_stiffness or poissons_ratio" in reasons["shear deformation"]
    assert "with" not in {effect.name: effect.reason for effect in bd.terms(plain).left_out}["stretch"]


def test_a_term_of_several_fields_is_one_entry() -> None:
    entry = bd.terms(SCENES["all"])["mass"]
    assert entry.fields == ("bending", "second bending", "shear", "second shear")
    with pytest.raises(KeyError, match="no term of this model; its terms are mass"):
        bd.terms(HARVESTER)["stretch mass"]


def test_translation_makes_the_tension_parametric() -> None:
    steady, rolling = (bd.terms(s)["tension by root acceleration"] for s in (HARVESTER, ROLLING))
    assert steady.present and "no parametric tension" in steady.reason
    assert rolling.present and "translation" in rolling.reason


def test_a_setting_angle_brings_a_static_load() -> None:
    entry = bd.terms(turned(0.3))["root acceleration"]
    assert entry.present and "rotation" in entry.reason
    assert entry.largest == pytest.approx(0.215 * math.sin(0.3))


def test_largest_coefficients_are_those_of_the_motion() -> None:
    found = bd.terms(ROLLING)
    assert found["centrifugal stiffening"].largest == pytest.approx(55.0**2)
    assert found["angular acceleration"].largest == pytest.approx(11.0, rel=1e-3)  # 2 omega_s / T


def test_lines() -> None:
    heavy = bd.terms(replace(ROLLING, gravity=9.81))
    assert [line.name for line in heavy.lines] == ["road +", "road -", "gravity"]
    assert bd.terms(HARVESTER).lines == ()


def test_a_motion_of_the_users_own() -> None:
    motion = bd.UserMotion(lambda t: bd.SteadyRotation(5.0).at(t))
    assert "angular acceleration" not in bd.terms(replace(HARVESTER, motion=motion)).present


def test_table_and_dictionary() -> None:
    found = bd.terms(COUPLED)
    assert len(found) == len(list(found)) == 23
    assert all(entry.name in str(found) for entry in found)
    assert json.loads(json.dumps(found.to_dict()))["entries"][0]["name"] == "mass"
    assert np.isfinite([entry.largest for entry in found]).all()


def test_command(finished, tmp_path) -> None:
    path = tmp_path / "terms.json"
    out = finished(main(["terms", "examples/rolling_harvester.toml", "--json", str(path)]), DONE).out
    assert "centrifugal stiffening" in out and "road + at 7.28319" in out
    written = json.loads(path.read_text())
    assert len(written["entries"]) == 12 and written["left_out"][0]["name"] == "second plane of bending"
