"""Scenes in TOML: one clear message for every mistake, and a scene or a refusal for anything else."""

import math
import pickle

import pytest
from hypothesis import given
from hypothesis import strategies as st

from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.inputs import describe
from beamdyn.files.scene_inputs import SceneInput
from beamdyn.files.scenes import load_scene, parse_scene, scene_from_dict
from beamdyn.scene.scene import Scene
from tests.unit.toml_scenes import (
    BY_STIFFNESS,
    HARVESTER,
    ROLLING,
    SAMPLED,
    SPIN_UP,
    changed,
    mistakes,
    only_mistake,
)

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
            "beam.thickness.stations[1] = 0.5: the last station must be the tip, at 1 or the",
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
            'beam.point_mass = { position = "1 mm", mass = "1 g" }: give [[beam.point_mass]] in double',
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
        ("mount", None, "mount: missing; give a table [mount] with radius"),
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
            'beam.thickness.stations[1] = "25 mm": the last station must be the tip, at 1 or',
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
            "motion.kind = \"odd\": give 'steady', 'spin_up', 'pulsating', 'sampled', 'rolling', 'shaken' "
            "or 'sampled_translation'",
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
        (
            " ",
            1,
            " : unknown key; known are beam, mount, motion, model, damping, tip_load, harvester, physics",
        ),
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
    assert said.startswith(f"beam.twist = {shown}: twist turns two directions of bending: it needs second_b")
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


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a = " + "[" * 100_000, "its lists or tables are nested too deeply"),
        ("a = " + "5" * 5000, "a number has thousands of digits"),
        ("[beam]\nlength = 1979-05-27", "beam.length = 1979-05-27: not a number with a unit"),
        ('["a\\nb"]', '"a\\nb": unknown key'),
        ('["\\u001b[31mred"]', '"\\u001b[31mred": unknown key'),
        ("[" + "x" * 100_000 + "]", '"' + "x" * 56 + "...: unknown key"),
    ],
)
def test_files_that_are_odd_are_told_so_in_plain_words(tmp_path, text, said):
    (tmp_path / "odd.toml").write_text(text, encoding="utf-8")
    with pytest.raises(ConfigError) as refused:
        load_scene(tmp_path / "odd.toml")
    assert said in str(refused.value)
    assert max(map(len, str(refused.value).splitlines())) < 500
