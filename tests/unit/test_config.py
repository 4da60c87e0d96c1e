"""Scenes in TOML: what they mean, and one clear message for every mistake."""

import copy
import math
import pickle
from pathlib import Path
from typing import Annotated

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial import Polynomial

from beamdyn.app.inputs import inputs_of
from beamdyn.common.app.form_entries import entries_of, tables_of, toml_of
from beamdyn.common.edge.inputs import Quantity, Section, describe
from beamdyn.common.edge.units import quantity
from beamdyn.config import ConfigError, SceneInput, load_scene, parse_scene, scene_from_dict
from beamdyn.scene.beam import Beam, PointMass, TipMass
from beamdyn.scene.motion import RoadWave, RollingWheel, SampledRotation, SpinUp, SteadyRotation
from beamdyn.scene.mount import Mount
from beamdyn.scene.physics import Physics
from beamdyn.scene.profile import Table
from beamdyn.scene.scene import Scene

EXAMPLES = Path(__file__).parents[2] / "examples"

HARVESTER = {
    "beam": {
        "length": "50 mm",
        "width": "10 mm",
        "thickness": "0.2 mm",
        "youngs_modulus": "200 GPa",
        "density": "7850 kg/m3",
    },
    "mount": {"radius": "215 mm"},
}
BY_STIFFNESS = {
    "beam": {"length": "50 mm", "mass_per_length": "15.7 g/m", "bending_stiffness": "1.3e-3 N m2"},
    "mount": {"radius": "215 mm"},
}

SPIN_UP = {"kind": "spin_up", "speed": "55 rad/s", "duration": "10 s"}
SAMPLED = {"kind": "sampled", "times": ["0 s", "1 s"], "speeds": ["0 rpm", "525 rpm"]}
ROLLING = {"kind": "rolling", "rolling_radius": "300 mm", "rotation": SPIN_UP}


def changed(path, value, scene=HARVESTER):
    """A copy of a scene with one key set, or deleted where the value is None."""
    scene = copy.deepcopy(scene)
    *tables, key = path.split(".")
    inner = scene
    for table in tables:
        inner = inner.setdefault(table, {})
    inner.pop(key, None)
    if value is not None:
        inner[key] = value
    return scene


def mistakes(data):
    with pytest.raises(ConfigError) as refusal:
        scene_from_dict(data)
    return refusal.value.mistakes


def only_mistake(data):
    (mistake,) = mistakes(data)
    return mistake


# What a scene means ---------------------------------------------------------------------------------


SCENES = sorted(path for path in EXAMPLES.glob("*.toml") if "[beam]" in path.read_text())


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_examples_load(path):
    assert isinstance(load_scene(path), Scene)


def test_published_scene():
    beam = Beam.rectangular(length=0.05, width=0.01, thickness=0.0002, youngs_modulus=200e9, density=7850.0)
    assert load_scene(EXAMPLES / "tyre_harvester.toml") == Scene(beam, Mount(radius=0.215))


def test_defaults_are_those_of_the_core():
    scene = scene_from_dict(HARVESTER)
    assert scene == Scene(scene.beam, Mount(0.215))


def test_tapered_blade():
    scene = load_scene(EXAMPLES / "blade.toml")
    x = np.linspace(0, 1, 9)
    width, thickness = 0.060 - 0.020 * x, 0.006 - 0.004 * x + 0.001 * x**2
    np.testing.assert_allclose(scene.beam.mass_per_length(x), 2700 * width * thickness, rtol=1e-13)
    np.testing.assert_allclose(scene.beam.bending_stiffness(x), 70e9 * width * thickness**3 / 12, rtol=1e-13)
    assert scene.mount == Mount(0.1, math.pi, math.pi / 2)
    assert scene.motion == SteadyRotation(50 * math.pi)


def test_jump_and_tip_body():
    scene = load_scene(EXAMPLES / "patched.toml")
    assert scene.beam.breakpoints == (0.0, 0.4, 1.0)
    before, after = scene.beam.bending_stiffness(np.array([0.4 - 1e-9, 0.4]))
    assert before / after == pytest.approx(8, rel=1e-12)
    assert scene.beam.tip == TipMass(0.002, offset=0.003, inertia=2e-8, axial_inertia=2e-8)
    assert (scene.damping_ratio, scene.gravity, scene.physics) == (0.01, 9.81, Physics())


@pytest.mark.parametrize("stations", [[0, 0.5, 1.0], ["0 m", "2.5 cm", "50 mm"], [0, "25 mm", 1]])
def test_stations_are_fractions_or_lengths(stations):
    table = {"stations": stations, "values": ["0.3 mm", "0.2 mm", "0.2 mm"]}
    wanted = Beam.rectangular(0.05, 0.01, Table((0, 0.5, 1), (3e-4, 2e-4, 2e-4)), 200e9, 7850)
    assert scene_from_dict(changed("beam.thickness", table)).beam == wanted


@pytest.mark.parametrize("place", [0.4, "20 mm"])
def test_breakpoints_are_fractions_or_lengths(place):
    assert scene_from_dict(changed("beam.breakpoints", [place])).beam.breakpoints == (0, 0.4, 1)


def test_beam_by_stiffness():
    data = changed("beam.axial_stiffness", {"polynomial": ["400 kN", "-100 kN"]}, BY_STIFFNESS)
    scene = scene_from_dict(changed("physics.stretch", True, changed("beam.outer_fibre", "0.1 mm", data)))
    assert scene.beam.mass_per_length(np.array([0.3])) == pytest.approx(0.0157)
    assert scene.beam.axial_stiffness(np.array([1.0])) == pytest.approx(300e3)
    assert scene.physics == Physics(stretch=True)


def test_every_input_of_the_tip_arrives():
    tip = {"mass": "1 g", "offset": "-1 mm", "inertia": "3 g mm2"}
    tip |= {"transverse_inertia": "2 g mm2", "axial_inertia": "4 g mm2"}
    assert scene_from_dict(changed("beam.tip", tip)).beam.tip == TipMass(1e-3, -1e-3, 3e-9, 2e-9, 4e-9)


@pytest.mark.parametrize("scene", [HARVESTER, BY_STIFFNESS])
def test_point_masses_are_read(scene):
    given = [{"position": "50 mm", "mass": "1 g"}, {"position": "0.02 m", "mass": "0 kg"}]
    beam = scene_from_dict(changed("beam.point_mass", given, scene)).beam
    assert beam.point_masses == (PointMass(0.05, 1e-3), PointMass(0.02, 0.0))


def test_point_masses_are_written_back():
    """As the form keeps them, and writes them to a file."""
    given = [{"position": "50 mm", "mass": "1 g"}, {"position": "0.02 m", "mass": "2 g"}]
    tables = changed("beam.point_mass", given)
    inputs = inputs_of(entries_of(tables, ()))
    back = tables_of(entries_of(tables, inputs), inputs)
    assert back["beam"]["point_mass"] == given
    assert "[[beam.point_mass]]" in toml_of(back)
    assert parse_scene(toml_of(back)) == scene_from_dict(tables)


def test_physics_of_a_rectangular_beam():
    data = changed("beam.twist", "10 deg", changed("beam.poissons_ratio", 0.3))
    data["physics"] = {"planes": 2, "shear": True, "rotary_inertia": True}
    scene = scene_from_dict(data)
    wanted = {"twist": math.radians(10), "poissons_ratio": 0.3}
    assert scene.beam == Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, **wanted)
    assert scene.physics == Physics(planes=2, shear=True, rotary_inertia=True)


@pytest.mark.parametrize(
    ("twist", "wanted"),
    [
        ("-12 deg", math.radians(-12)),
        ({"polynomial": ["0.1 rad", "-12 deg"]}, Polynomial([0.1, math.radians(-12)])),
        ({"stations": [0, "25 mm", 1], "values": ["5 deg", "0 rad", "-5 deg"]},
         Table((0, 0.5, 1), (math.radians(5), 0.0, math.radians(-5)))),
    ],
)  # fmt: skip
def test_twist_has_any_sign(twist, wanted):
    given = scene_from_dict(changed("beam.twist", twist)).beam.twist
    x = np.linspace(0, 1, 11)
    wanted = Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, twist=wanted).twist
    np.testing.assert_allclose(given(x), wanted(x), rtol=1e-15, atol=1e-16)  # degrees convert in decimal


def test_every_property_of_a_stiffness_arrives():
    values = {"axial_stiffness": "5 MN", "outer_fibre": "0.1 mm", "second_bending_stiffness": "4e-3 N m2"}
    values |= {"twist": "0.5 rad", "shear_stiffness": "1 kN", "second_shear_stiffness": "2 kN"}
    values |= {"rotary_inertia": "1 g mm", "second_rotary_inertia": "2 g mm"}
    data = copy.deepcopy(BY_STIFFNESS)
    data["beam"] |= values
    wanted = {"axial_stiffness": 5e6, "outer_fibre": 1e-4, "second_bending_stiffness": 4e-3, "twist": 0.5}
    wanted |= {"shear_stiffness": 1e3, "second_shear_stiffness": 2e3}
    wanted |= {"rotary_inertia": 1e-6, "second_rotary_inertia": 2e-6}
    assert scene_from_dict(data).beam == Beam.from_stiffness(0.05, 0.0157, 1.3e-3, **wanted)


@pytest.mark.parametrize("key", ["root_stiffness", "second_root_stiffness"])
@pytest.mark.parametrize(
    ("given", "wanted"), [("2 kN m/rad", 2e3), ("0 N m/rad", 0), ("inf", math.inf), (math.inf, math.inf)]
)
def test_root_springs(key, given, wanted):
    assert scene_from_dict(changed(f"mount.{key}", given)).mount == Mount(0.215, **{key: wanted})


# A table of stations --------------------------------------------------------------------------------

ROWS = [
    ["x/L", "mass_per_length [kg/m]", "twist [deg]", "bending_stiffness [kN m2]",
     "second_bending_stiffness [N m2]"],
    [0, 3, 13.3, 5.0, 9e3],
    [0.25, 2, -1e-1, 4.0, 8e3],
    [0.25, 2, 2, 2, 7e3],
    [1.0, 1, 0, 1.5, 2e3],
]  # fmt: skip
BY_STATIONS = {"beam": {"length": "8 m", "stations": ROWS}, "mount": {"radius": "1 m"}}


def with_rows(place, value):
    """The scene with one cell, or one whole row, changed."""
    scene = copy.deepcopy(BY_STATIONS)
    inner = scene["beam"]["stations"]
    for index in place[:-1]:
        inner = inner[index]
    inner[place[-1]] = value
    return scene


def test_stations_are_columns():
    """The same as a table for each property."""
    apart = {"length": "8 m"}
    for c, head in enumerate(ROWS[0][1:], 1):
        name, _, unit = head.rstrip("]").partition(" [")
        values = [f"{row[c]} {unit}" for row in ROWS[1:]]
        apart[name] = {"stations": [row[0] for row in ROWS[1:]], "values": values}
    wanted = scene_from_dict(BY_STATIONS | {"beam": apart}).beam
    assert scene_from_dict(BY_STATIONS).beam == wanted
    assert wanted.twist(np.array([0.25 - 1e-12]))[0] == pytest.approx(math.radians(-0.1), rel=1e-9)


def test_stations_in_metres_or_millimetres():
    for unit, scale in (("m", 8), ("mm", 8000)):
        rows = [[f"x [{unit}]", *ROWS[0][1:]], *([scale * row[0], *row[1:]] for row in ROWS[1:])]
        scene = scene_from_dict(changed("beam.stations", rows, BY_STATIONS))
        assert scene.beam == scene_from_dict(BY_STATIONS).beam


def test_stations_beside_other_keys():
    rows = [["thickness [mm]", "x/L"], [0.2, 0], [0.1, 1]]
    scene = scene_from_dict(changed("beam.stations", rows, changed("beam.thickness", None)))
    table = Table((0, 1), (2e-4, 1e-4))
    assert scene.beam == Beam.rectangular(0.05, 0.01, table, 200e9, 7850.0)


@pytest.mark.parametrize(
    ("place", "value", "message"),
    [
        ((), "blade.csv", ' = "blade.csv": give a row of heads, ["x/L", "twist [deg]"], then rows of numb'),
        ((), ROWS[:1], ' = [["x/L", "mass_per_length [kg/m]"'),
        ((2,), 5, "[2] = 5: give a row in brackets"),
        ((2,), [0.25, 1], "[2] = [0.25, 1]: 2 cells under 5 heads"),
        ((0, 2), "twist", '[0][2] = "twist": give "twist [deg]"'),
        ((0, 2), "twist [m]", '[0][2] = "twist [m]": give "twist [deg]"'),
        ((0, 2), "Twist [deg]", '[0][2] = "Twist [deg]": unknown column; did you mean twist?'),
        ((0, 2), 5, "[0][2] = 5: unknown column; known are x/L, x, twist, width, thickness, mass"),
        ((0, 0), "x/L [m]", '[0][0] = "x/L [m]": give it without a unit, "x/L"'),
        ((0, 0), "x", '[0][0] = "x": give "x [mm]"'),
        ((0, 2), "x [m]", '[0] = ["x/L", "mass_per_length [kg/m]"'),
        ((0, 2), "mass_per_length [g/m]", '[0][2] = "mass_per_length [g/m]": a second column of this name'),
        ((2, 1), "2 kg/m", '[2][1] = "2 kg/m": give a finite number, in kg/m'),
        ((2, 1), True, "[2][1] = true: give a finite number, in kg/m"),
        ((2, 1), math.nan, "[2][1] = nan: give a finite number, in kg/m"),
        ((2, 1), -1, "[2][1] = -1: it must be greater than 0 kg/m"),
        ((2, 0), "a", '[2][0] = "a": give a finite number'),
        ((4, 0), 0.9, "[4][0] = 0.9: the last station must be 1, the tip; give fractions x/L"),
        ((3, 0), 0.2, "[3][0] = 0.2: it follows 0.25; stations must ascend"),
        ((3, 0), 0, "[3][0] = 0: it follows 0.25; stations must ascend"),
        ((2, 1), 1e60, " = 1e+60: give sizes from 1e-50 to 1e+50 in SI units"),
    ],
)  # fmt: skip
def test_mistake_in_stations(place, value, message):
    data = with_rows(place, value) if place else changed("beam.stations", value, BY_STATIONS)
    assert only_mistake(data).startswith(f"beam.stations{message}")


def test_a_property_is_given_once():
    said = only_mistake(changed("beam.twist", "5 deg", BY_STATIONS))
    assert said.endswith(": twist is a key of its own, too; give it once")


@pytest.mark.parametrize("motion", [{"speed": "525 rpm"}, {"speed": "525 rpm", "kind": "steady"}])
def test_steady_motion(motion):
    assert scene_from_dict(changed("motion", motion)).motion == SteadyRotation(quantity("525 rpm", "rad/s"))


def motion_of(**keys):
    return scene_from_dict(changed("motion", keys)).motion


def test_published_rolling_scene():
    strip = load_scene(EXAMPLES / "tyre_harvester.toml")
    motion = RollingWheel(0.3, SpinUp(55.0, 10.0, "smooth"), RoadWave(0.3, velocity_amplitude=0.01))
    assert load_scene(EXAMPLES / "rolling_harvester.toml") == Scene(strip.beam, strip.mount, motion)


def test_spin_up():
    given = {"kind": "spin_up", "speed": "55 rad/s", "duration": "1 min"}
    assert motion_of(**given) == SpinUp(55.0, 60.0)
    assert motion_of(**given, law="linear") == SpinUp(55.0, 60.0, "linear")


def test_table_of_speeds():
    given = {"kind": "sampled", "times": ["0 s", "500 ms"], "speeds": ["0 rad/s", "55 rad/s"]}
    assert motion_of(**given) == SampledRotation((0, 0.5), (0, 55))
    assert motion_of(**given, interpolation="pchip").interpolation == "pchip"


def test_rolling():
    rotation = {"kind": "sampled", "times": ["0 s", "1 s"], "speeds": ["0 rad/s", "5 rad/s"]}
    road = {"wavelength": "1 m", "height": "2 mm"}
    given = {"kind": "rolling", "rolling_radius": "30 cm"}
    assert motion_of(**given, rotation={"speed": "5 rad/s"}) == RollingWheel(0.3, 5.0)
    wheel = RollingWheel(0.3, SampledRotation((0, 1), (0, 5)), RoadWave(1.0, height=0.002))
    assert motion_of(**given, rotation=rotation, road=road) == wheel


# Mistakes -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        ("beam.thickness", 0.2, 'beam.thickness = 0.2: give a unit, e.g. "0.2 m" or "0.2 mm"'),
        (
            "beam.thickness",
            "0.2 kg",
            'beam.thickness = "0.2 kg": a unit of mass where length is wanted; give e.g. "0.2 mm"',
        ),
        ("beam.thickness", "0 mm", 'beam.thickness = "0 mm": it must be greater than 0 m'),
        ("beam.thickness", None, "beam.thickness: missing; give the thickness"),
        ("beam.thickness", [1], "beam.thickness = [1]: give a number with a unit, { polynomial"),
        (
            "beam.thickness",
            {"poly": ["1 mm"]},
            'beam.thickness = { poly = ["1 mm"] }: give a number with a unit',
        ),
        ("beam.thickness", {"polynomial": []}, "beam.thickness.polynomial = []: give at least one value"),
        ("beam.thickness", {"polynomial": "1 mm"}, 'beam.thickness.polynomial = "1 mm": give a list'),
        ("beam.thickness", {"polynomial": ["1 mm", 2]}, "beam.thickness.polynomial[1] = 2: give a unit"),
        (
            "beam.thickness",
            {"polynomial": ["1 mm", "-2 mm"]},
            "beam.thickness = -0.001 at x/L = 1.000: it must be pos",
        ),
        ("beam.thickness", {"values": ["1 mm"]}, "beam.thickness.stations: missing; give as many"),
        (
            "beam.thickness",
            {"stations": [0, 1], "values": ["1 mm", "-1 mm"]},
            'beam.thickness.values[1] = "-1 mm": it must be greater than 0 m',
        ),
        (
            "beam.thickness",
            {"stations": [0, 0.5], "values": ["1 mm"] * 2},
            "beam.thickness.stations[1] = 0.5: the last station must be 1, the tip",
        ),
        (
            "beam.thickness",
            {"stations": [0, 1], "values": ["1 mm"] * 3},
            "beam.thickness.stations = [0, 1]: 2 stations and 3 values",
        ),
        (
            "beam.thickness",
            {"stations": [0, "1 kg"], "values": ["1 mm"] * 2},
            'beam.thickness.stations[1] = "1 kg": a un',
        ),
        ("beam.thickness", "20 mm", 'beam.thickness = "20 mm": it exceeds width = 10 mm, but the beam bends'),
        ("beam.thickness", "60 mm", 'beam.thickness = "60 mm": it exceeds length = 50 mm'),
        ("beam.thicknes", "0.2 mm", "beam.thicknes: unknown key; did you mean thickness?"),
        ("beam.colour", "red", "beam.colour: unknown key; known are length, tip, breakpoints, stations"),
        ("beam.<b>", "red", "beam.<b>: unknown key"),
        (
            "beam.bending_stiffness",
            "1 N m2",
            "beam: width, thickness, youngs_modulus, density and bending_stiffness do",
        ),
        ("beam.breakpoints", 0.4, "beam.breakpoints = 0.4: give a list"),
        ("beam.breakpoints", [1.4], "beam.breakpoints = [1.4]: give fractions x/L between 0 and 1"),
        ("beam.breakpoints", [True], "beam.breakpoints[0] = true: give a finite number"),
        ("beam.breakpoints", [10**400], "beam.breakpoints[0] = 1000"),
        ("beam.tip", "1 g", 'beam.tip = "1 g": give a table'),
        ("beam.tip", {}, "beam.tip.mass: missing; give the mass [kg], at least 0"),
        ("beam.tip", {"mass": "-1 g"}, 'beam.tip.mass = "-1 g": it must be at least 0 g'),
        (
            "beam.tip",
            {"mass": "1 g", "inertia": "nan kg m2"},
            'beam.tip.inertia = "nan kg m2": not a finite number',
        ),
        (
            "beam.tip",
            {"mass": "1 g", "axial_inertia": "1 g mm2"},
            'beam.tip.axial_inertia = "1 g mm2": in a rigid body it is at most the sum of the other two',
        ),
        (
            "beam.tip",
            {"mass": "1 g", "offset": "-60 mm"},
            'beam.tip.offset = "-60 mm": it puts the body behind the root; give an offset above -50 mm',
        ),
        (
            "beam.point_mass",
            {"position": "1 mm", "mass": "1 g"},
            'beam.point_mass = { position = "1 mm", mass = "1 g" }: give a table [[beam.point_mass]] in two',
        ),
        (
            "beam.point_mass",
            [{"position": 0.4, "mass": "1 g"}],
            'beam.point_mass[0].position = 0.4: give a unit, e.g. "0.4 m" or "0.4 mm"',
        ),
        (
            "beam.point_mass",
            [{"position": "20 mm", "mass": "1 g"}, {"position": "60 mm", "mass": "1 g"}],
            'beam.point_mass[1].position = "60 mm": it must be at most 50 mm, the length; a body beyond the',
        ),
        (
            "beam.point_mass",
            [{"position": "0 mm", "mass": "1 g"}],
            'beam.point_mass[0].position = "0 mm": it must be greater than 0 mm',
        ),
        (
            "beam.point_mass",
            [{"position": "1 mm", "mass": "-1 g"}],
            'beam.point_mass[0].mass = "-1 g": it must be at least 0 g',
        ),
        ("beam", None, "beam: missing; give a table [beam]"),
        ("beam", "50 mm", 'beam = "50 mm": give a table'),
        ("mount", None, "mount: missing; give a table [mount]"),
        (
            "mount.radius",
            "-215 mm",
            'mount.radius = "-215 mm": it must be at least 0 mm; for a beam that points outward',
        ),
        (
            "mount.setting_angle",
            88.36,
            'mount.setting_angle = 88.36: give a unit, e.g. "88.36 rad" or "88.36 deg"',
        ),
        (
            "mount.setting_angle",
            "88.36 rad",
            'mount.setting_angle = "88.36 rad": it must be at least -6.28319, at most',
        ),
        (
            "mount.setting_angle",
            "500 deg",
            'mount.setting_angle = "500 deg": it must be at least -360, at most 360 deg; that is one turn',
        ),
        (
            "beam.thickness",
            {"stations": ["0 mm", "25 mm"], "values": ["1 mm"] * 2},
            'beam.thickness.stations[1] = "25 mm": the last station must be 1, the tip',
        ),
        (
            "beam.thickness",
            {"stations": [0, "30 mm", "20 mm", 1], "values": ["1 mm"] * 4},
            'beam.thickness.stations[2] = "20 mm": it follows 0.6; stations must ascend',
        ),
        ("mount.radius_", "1 m", "mount.radius_: unknown key; did you mean radius?"),
        (
            "motion",
            {"kind": "steady"},
            "motion.speed: missing; give the angular speed of the carrier [rad/s]",
        ),
        (
            "motion",
            {"kind": "odd", "speed": "1 rpm"},
            "motion.kind = \"odd\": give 'steady', 'spin_up', 'sampled', 'rolling' or 'sampled_translation'",
        ),
        ("motion", {"kind": [1]}, "motion.kind = [1]: give 'steady'"),
        ("motion", 55, "motion = 55: give a table"),
        ("motion", {"kind": "spin_up", "speed": "1 rpm"}, "motion.duration: missing; give the time that"),
        ("motion", SPIN_UP | {"duration": 10}, 'motion.duration = 10: give a unit, e.g. "10 s"'),
        ("motion", SPIN_UP | {"duration": "-1 s"}, 'motion.duration = "-1 s": it must be greater than 0 s'),
        ("motion", SPIN_UP | {"law": "odd"}, "motion.law = \"odd\": give 'smooth' or 'linear'"),
        (
            "motion",
            SPIN_UP | {"kind": "steady"},
            'motion.duration: unknown key; it goes with kind = "spin_up"',
        ),
        ("motion", {"road": {}, "speed": "1 rpm"}, 'motion.road: unknown key; it goes with kind = "rolling"'),
        ("motion", SAMPLED | {"times": ["0 s", "1 m"]}, 'motion.times[1] = "1 m": a unit of length where'),
        ("motion", SAMPLED | {"times": "0 s"}, 'motion.times = "0 s": give a list'),
        ("motion", SAMPLED | {"times": ["1 s", "0 s"]}, "motion.times = 0 s: it follows 1 s; sort"),
        ("motion", SAMPLED | {"speeds": ["1 rpm"]}, "motion: times, speeds: 2 times and 1 speeds"),
        (
            "motion",
            ROLLING | {"speed": "1 rpm"},
            'motion.speed: unknown key; it goes with kind = "steady" or',
        ),
        ("motion", ROLLING | {"rolling_radius": "0 m"}, 'motion.rolling_radius = "0 m": it must be greater'),
        (
            "motion",
            {"kind": "rolling", "rolling_radius": "1 m"},
            "motion.rotation: missing; give a table [motion.rotation]",
        ),
        ("motion", ROLLING | {"rotation": ROLLING}, "motion.rotation.kind = \"rolling\": give 'steady', 's"),
        (
            "motion",
            ROLLING | {"road": {}},
            "motion.road.wavelength: missing; give the wavelength of the road",
        ),
        ("motion", ROLLING | {"road": {"wavelength": "-1 m"}}, 'motion.road.wavelength = "-1 m": it must be'),
        (
            "motion",
            ROLLING | {"road": {"wavelength": "1 m"}},
            "motion.road: neither velocity_amplitude nor height given: give exactly one",
        ),
        (
            "motion",
            ROLLING | {"road": {"wavelength": "1 m", "height": "1 mm", "velocity_amplitude": "1 m/s"}},
            "motion.road: velocity_amplitude = 1.0 and height = 0.001 given: give exactly one",
        ),
        (
            "motion",
            ROLLING | {"road": {"wavelength": "1 m", "height": "1 m/s"}},
            'motion.road.height = "1 m/s": a unit of velocity where length is wanted',
        ),
        (
            "motion",
            {"speed": "5 Hz"},
            'motion.speed = "5 Hz": ambiguous for an angular speed; give "300 rpm"',
        ),
        ("model.damping_ratio", 1, "model.damping_ratio = 1: it must be at least 0, below 1; 1 % is 0.01"),
        ("model.damping_ratio", "1 %", 'model.damping_ratio = "1 %": give a finite number, without a unit'),
        ("model.damping_ratio", math.nan, "model.damping_ratio = nan: give a finite number"),
        ("model.gravity", 9.81, 'model.gravity = 9.81: give a unit, e.g. "9.81 m/s2"'),
        ("model.stretch", True, "model.stretch: unknown key; it belongs in the table [physics]"),
        ("model.tip", {}, "model.tip: unknown key; known are damping_ratio, gravity"),
        ("physics.stretch", 1, "physics.stretch = 1: give true or false"),
        ("physics.planes", 3, "physics.planes = 3: give 1 or 2"),
        ("physics.planes", "2", 'physics.planes = "2": give 1 or 2'),
        ("physics.planes", True, "physics.planes = true: give a number"),
        ("physics.shear", True, "physics.shear = true: it needs shear_stiffness; give beam.poissons_ratio"),
        (
            "mount.root_stiffness",
            "-5 kN m/rad",
            'mount.root_stiffness = "-5 kN m/rad": it must be at least 0 kN m/rad; 0 is a hinge; left out,',
        ),
        ("mount.root_stiffness", math.nan, "mount.root_stiffness = nan: not a finite number; give e.g."),
        ("mount.root_stiffness", -math.inf, "mount.root_stiffness = -inf: not a finite number; give e.g."),
        (
            "mount.second_root_stiffness",
            "5 N m",
            'mount.second_root_stiffness = "5 N m": a unit of moment where stiffness against rotation is',
        ),
        ("beam.poissons_ratio", 0.6, "beam.poissons_ratio = 0.6: it must be greater than -1, at most 0.5"),
        ("beam.twist", 10, 'beam.twist = 10: give a unit, e.g. "10 rad" or "10 deg"'),
        ("beam.twist", {"polynomial": ["0 deg", 5]}, "beam.twist.polynomial[1] = 5: give a unit, e.g."),
        ("modle", {}, "modle: unknown key; did you mean model?"),
        (" ", 1, " : unknown key; known are beam, mount, motion, model, damping, physics"),
    ],
)
def test_mistake_names_key_value_and_remedy(path, value, message):
    assert only_mistake(changed(path, value)).startswith(message)


@pytest.mark.parametrize(
    ("physics", "name"),
    [
        ({"stretch": True}, "axial_stiffness"),
        ({"planes": 2}, "second_bending_stiffness"),
        ({"shear": True}, "shear_stiffness"),
        ({"rotary_inertia": True}, "rotary_inertia"),
    ],
)
def test_physics_needs_a_property(physics, name):
    said = only_mistake(changed("physics", physics, BY_STIFFNESS))
    assert said.startswith("physics.")
    assert said.endswith(f": it needs {name}; give beam.{name}")


@pytest.mark.parametrize(
    ("twist", "shown"),
    [
        ("10 deg", '"10 deg" at the tip'),
        ({"polynomial": ["5 deg", "-15 deg"]}, "-10 deg at the tip"),
        ({"stations": [0, 1], "values": ["1 rad", "30 deg"]}, "30 deg at the tip"),
    ],
)
def test_twist_needs_a_second_stiffness(twist, shown):
    said = only_mistake(changed("beam.twist", twist, BY_STIFFNESS))
    assert said.startswith(f"beam.twist = {shown}: it turns two directions of bending, and needs second_b")
    assert said.endswith("; give beam.second_bending_stiffness")


def test_all_mistakes_at_once():
    data = changed("beam.thickness", 0.2, changed("mount.radius", None, changed("beam.tip", {"mass": "1 m"})))
    assert [mistake.partition(" ")[0] for mistake in mistakes(data)] == [
        "beam.tip.mass",
        "beam.thickness",
        "mount.radius:",
    ]


def test_mistakes_of_the_core_come_with_the_others():
    swapped = changed("beam.thickness", "20 mm", changed("mount.radius", "-1 m"))
    assert [mistake.partition(" ")[0] for mistake in mistakes(swapped)] == ["beam.thickness", "mount.radius"]


def test_message_has_one_line_a_mistake():
    error = ConfigError("a.toml", ["one", "two"])
    assert str(error) == "a.toml: 2 mistakes\n  one\n  two"
    assert str(ConfigError("a.toml", ["one"])) == "a.toml: one"
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


def test_expressions_are_not_evaluated():
    assert "not a number with a unit" in only_mistake(changed("beam.width", "__import__('os').getcwd()"))


# Files ----------------------------------------------------------------------------------------------


def test_missing_file(tmp_path):
    with pytest.raises(ConfigError, match=r"^\S*none\.toml: there is no such file; check"):
        load_scene(tmp_path / "none.toml")


def test_folder(tmp_path):
    with pytest.raises(ConfigError, match="it cannot be read"):
        load_scene(tmp_path)


def test_not_text(tmp_path):
    (tmp_path / "a.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ConfigError, match="not text in UTF-8"):
        load_scene(tmp_path / "a.toml")


def test_not_toml(tmp_path):
    (tmp_path / "a.toml").write_text("[beam]\nlength = 50 mm\n")
    with pytest.raises(ConfigError, match=r'a\.toml: not valid TOML: .*at line 2, .*length = "50 mm"'):
        load_scene(tmp_path / "a.toml")


@pytest.mark.parametrize(
    "text", ["a = " + "[" * 5000, f"[beam.density.{'.'.join('a' * 3000)}]", "a = " + "1" * 5000]
)
def test_absurd_toml(text):
    with pytest.raises(ConfigError):
        parse_scene(text)


# Anything else --------------------------------------------------------------------------------------

UNITS = st.sampled_from(
    ["mm", "m", "kg", "GPa", "kg/m3", "kg/m", "N m2", "N", "deg", "rpm", "g mm2", "m/s2", "", "x"]
)
NUMBERS = st.floats(1e-3, 1e3) | st.floats() | st.integers()
QUANTITIES = st.builds("{} {}".format, NUMBERS, UNITS)
SCALARS = st.none() | st.booleans() | NUMBERS | st.text(max_size=5) | QUANTITIES | st.dates()
KEYS = st.sampled_from(
    sorted(
        {part for found in describe(SceneInput) for part in found.path.split(".")}
        | {"polynomial", "stations", "values"}
    )
) | st.text(max_size=5)
JUNK = st.recursive(
    SCALARS,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(KEYS, inner, max_size=4),
    max_leaves=12,
)
PATHS = st.sampled_from(
    [found.path for found in describe(SceneInput)]
    + ["beam", "mount", "motion", "model", "physics", "beam.tip"]
)


def is_scene_or_refused(data):
    try:
        assert isinstance(scene_from_dict(data), Scene)
    except ConfigError as refusal:
        assert refusal.mistakes
        assert all(": " in mistake and len(mistake) < 400 for mistake in refusal.mistakes)


@given(st.dictionaries(KEYS, JUNK, max_size=5))
def test_any_dictionary_is_a_scene_or_refused(data):
    is_scene_or_refused(data)


@given(st.sampled_from([HARVESTER, BY_STIFFNESS]), PATHS, JUNK)
def test_any_value_anywhere_is_a_scene_or_refused(scene, path, value):
    is_scene_or_refused(changed(path, value, scene))


@given(st.text(alphabet="[]{}=.\"'#\n abe1_"))
def test_any_text_is_a_scene_or_refused(text):
    with pytest.raises(ConfigError):
        parse_scene(text)


# The description ------------------------------------------------------------------------------------


class Plate(Section):
    """A table as another program may have."""

    side: Annotated[float, Quantity("m", symbol="a", meaning="side", above=0, most=2)]
    friction: Annotated[float, Quantity(symbol="mu", meaning="coefficient of friction", least=0, below=1)] = (
        0.3
    )


def test_description_of_an_input():
    side, friction = describe(Plate, prefix="plate.")
    assert (side.path, side.name, side.section, side.required) == ("plate.side", "side", Plate, True)
    assert (side.quantity.symbol, side.quantity.unit) == ("a", "m")
    assert side.help == "side [m], greater than 0, at most 2"
    assert friction.help == "coefficient of friction, at least 0, below 1"
    assert (friction.required, friction.default) == (False, 0.3)


def test_model_holds_si():
    plate = Plate.model_validate({"side": "20 cm", "friction": 0})
    assert (plate.side, plate.friction) == (0.2, 0.0)
    assert isinstance(plate.friction, float)


@pytest.mark.parametrize(("side", "good"), [("0 m", False), ("1 um", True), ("2 m", True), ("2.1 m", False)])
def test_bounds(side, good):
    described = describe(Plate)[0].quantity
    if good:
        assert described.parse(side) > 0
    else:
        with pytest.raises(ValueError, match="it must be greater than 0, at most 2 m"):
            described.parse(side)


def test_every_input_of_a_scene_is_described():
    described = describe(SceneInput)
    assert all(found.quantity.meaning for found in described)
    assert {found.path for found in described} >= {
        "beam.length",
        "beam.tip.mass",
        "mount.radius",
        "motion.rotation.duration",
        "motion.road.height",
        "physics.stretch",
    }


def test_choices_are_described():
    kinds = [found.choices for found in describe(SceneInput) if found.path == "motion.kind"]
    assert kinds == [("steady",), ("spin_up",), ("sampled",), ("rolling",), ("sampled_translation",)]
