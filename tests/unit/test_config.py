"""Scenes in TOML: what they mean, and how their inputs are described."""

import copy
import math
from pathlib import Path
from typing import Annotated

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from beamdyn.app.scene_form import inputs_of
from beamdyn.common.edge.inputs import Quantity, Section, describe
from beamdyn.common.edge.toml_columns import read_columns
from beamdyn.common.edge.toml_text import toml_of
from beamdyn.common.edge.units import InvalidInput, quantity
from beamdyn.common.screens.form_entries import entries_of, tables_of
from beamdyn.files.scene_inputs import ENTRIES, PLACES, SceneInput
from beamdyn.files.scenes import load_scene, parse_scene, scene_from_dict
from beamdyn.scene.beam import Beam, PointMass, TipMass
from beamdyn.scene.motion.rolling import RoadWave, RollingWheel
from beamdyn.scene.motion.rotations import SampledRotation, SpinUp, SteadyRotation
from beamdyn.scene.mount import Mount
from beamdyn.scene.physics import Physics
from beamdyn.scene.profile import Table
from beamdyn.scene.scene import Scene
from tests.unit.toml_scenes import (
    BY_STIFFNESS,
    HARVESTER,
    changed,
    only_mistake,
)

EXAMPLES = Path(__file__).parents[2] / "examples"

# What a scene means ---------------------------------------------------------------------------------


SCENES = sorted(path for path in EXAMPLES.glob("*.toml") if "[beam]" in path.read_text())


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_examples_load(path):
    assert isinstance(load_scene(path), Scene)


def test_published_scene():
    beam = Beam.rectangular(0.05, 0.01, 0.0002, youngs_modulus=200e9, density=7850.0, poissons_ratio=0.3)
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
        ((), "blade.csv", ' = "blade.csv": give a row of headings, ["x/L", "twist [deg]"], then rows of num'),
        ((), ROWS[:1], ' = [["x/L", "mass_per_length [kg/m]"'),
        ((2,), 5, "[2] = 5: give a row in brackets"),
        ((2,), [0.25, 1], "[2] = [0.25, 1]: 2 cells under 5 headings"),
        ((0, 2), "twist", '[0][2] = "twist": give "twist [deg]"'),
        ((0, 2), "twist [m]", '[0][2] = "twist [m]": give "twist [deg]"'),
        ((0, 2), "Twist [deg]", '[0][2] = "Twist [deg]": unknown column; did you mean twist?'),
        ((0, 2), 5, "[0][2] = 5: unknown column; known are x/L, x, twist, sweep, prebend, width, thick"),
        ((0, 0), "x/L [m]", '[0][0] = "x/L [m]": give it without a unit, "x/L"'),
        ((0, 0), "x", '[0][0] = "x": give "x [mm]"'),
        ((0, 2), "x [m]", '[0] = ["x/L", "mass_per_length [kg/m]"'),
        ((0, 2), "mass_per_length [g/m]", '[0][2] = "mass_per_length [g/m]": a second column of this name'),
        ((2, 1), "2 kg/m", '[2][1] = "2 kg/m": give a finite number, in kg/m'),
        ((2, 1), True, "[2][1] = true: give a finite number, in kg/m"),
        ((2, 1), math.nan, "[2][1] = nan: give a finite number, in kg/m"),
        ((2, 1), -1, "[2][1] = -1: it must be greater than 0 kg/m"),
        ((2, 0), "a", '[2][0] = "a": give a finite number'),
        ((4, 0), 0.9, "[4][0] = 0.9: the last station must be the tip, at 1 or the beam's length; give"),
        ((3, 0), 0.2, "[3][0] = 0.2: it follows 0.25; stations must ascend"),
        ((3, 0), 0, "[3][0] = 0: it follows 0.25; stations must ascend"),
        ((2, 1), 1e60, " = 1e+60: give sizes from 1e-50 to 1e+50 in SI units"),
    ],
)  # fmt: skip
def test_mistake_in_stations(place, value, message):
    data = with_rows(place, value) if place else changed("beam.stations", value, BY_STATIONS)
    assert only_mistake(data).startswith(f"beam.stations{message}")


@pytest.mark.parametrize(
    ("column", "remedy"), [("K61", "did you mean K16?"), ("K67", "known are x/L, x, ")]
)  # digits in another order are a slip, other digits another entry
def test_an_unknown_entry_of_matrices(column, remedy):
    rows = [["x/L", f"{column} [N m]"], [0, 1.0], [1, 1.0]]
    with pytest.raises(InvalidInput) as refusal:
        read_columns("matrices", rows, PLACES | ENTRIES)
    assert f"unknown column; {remedy}" in str(refusal.value)


def test_a_property_is_given_once():
    said = only_mistake(changed("beam.twist", "5 deg", BY_STATIONS))
    assert said.endswith(": twist is both a column and a key; give it once")


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
    assert kinds == [
        ("steady",),
        ("spin_up",),
        ("pulsating",),
        ("sampled",),
        ("rolling",),
        ("shaken",),
        ("sampled_translation",),
    ]
