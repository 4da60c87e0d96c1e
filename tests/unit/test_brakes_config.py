"""Drum brakes and forklifts in TOML: what they mean, one clear message for every mistake, sweeps."""

from __future__ import annotations

import copy
import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from beamdyn.common.edge import input_sweep, varied_inputs
from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.input_sweep import Output, chosen
from beamdyn.common.edge.inputs import describe, in_degrees
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.inputs.described import with_parts
from brakes import drum, forklift
from brakes.answers.drum import BRAKE
from brakes.answers.forklift import FORKLIFT as TYPE
from brakes.answers.forklift import solve_stages
from brakes.cli import main
from brakes.config.drum import DrumInput, drum_from_dict, load_drum
from brakes.config.forklift import ForkliftInput, forklift_from_dict, load_forklift
from brakes.config.mechanism import mechanism_from_dict
from brakes.reproduce.forklift_as_printed import answer_as_printed

EXAMPLES = Path(__file__).parents[2] / "examples"
DRUM = tomllib.loads((EXAMPLES / "drum.toml").read_text())
FORKLIFT = tomllib.loads((EXAMPLES / "forklift.toml").read_text())
LEVERS = {
    "drum_radius": "158.75 mm",
    "a1": "128 mm",
    "a2": "113 mm",
    "b1": "122 mm",
    "b2": "122 mm",
    "alpha1": "19.7 deg",
    "alpha2": "19.7 deg",
    "gamma": "9.7 deg",
}


def changed(data: dict[str, Any], **keys: Any) -> dict[str, Any]:
    """A copy with keys set, or deleted where the value is None; "__" separates table and key."""
    data = copy.deepcopy(data)
    for path, value in keys.items():
        *tables, key = path.split("__")
        inner = data
        for table in tables:
            inner = inner.setdefault(table, {})
        inner.pop(key, None)
        if value is not None:
            inner[key] = value
    return data


def mistakes(build, data: dict[str, Any]) -> tuple[str, ...]:
    with pytest.raises(ConfigError) as refusal:
        build(data)
    return refusal.value.mistakes


# Drum -------------------------------------------------------------------------------------------------


def shoe(b: float) -> drum.Shoe:
    """Built by hand."""
    return drum.Shoe(0.138, 0.05, (np.radians(30.0), np.radians(110.0)), (b, -0.110), 0.115)


def test_the_example_is_the_brake_of_the_paper() -> None:
    example = load_drum(EXAMPLES / "drum.toml")
    found = example.solve()
    by_hand = drum.brake_torque(drum.simplex(shoe(0.020), shoe(0.025)), friction=0.35, force=1000.0)
    assert found.torque == pytest.approx(by_hand.torque, rel=1e-14)
    assert example.shoe.pressure_zero == "pivot"  # the paper has "axis"
    paper = drum_from_dict(changed(DRUM, shoe__pressure_zero="axis")).solve()
    assert paper.torque == pytest.approx(268.285616128, rel=1e-11)  # the facts' corrected table


def test_the_second_shoe_has_the_rest_from_the_first() -> None:
    other = drum_from_dict(changed(DRUM, shoe__force_arm="120 mm")).core.shoes[1]
    assert other.force_arm == 0.12 and other.pivot == (0.025, -0.11)


@pytest.mark.parametrize(
    "assembly, leading", [("simplex", (True, False)), ("duplex", (True, True)), ("single", (True,))]
)
def test_assemblies(assembly: str, leading: tuple[bool, ...]) -> None:
    data = changed(DRUM, brake__assembly=assembly, second_shoe=None)
    assert drum_from_dict(data).core.leading == leading


def test_reverse_swaps_the_shoes() -> None:
    data = changed(DRUM, second_shoe=None)
    forward, reverse = (
        drum_from_dict(changed(data, brake__direction=d)).solve() for d in ("forward", "reverse")
    )
    assert [s.leading for s in reverse.shoes] == [False, True]
    assert forward.shoes[0].torque == reverse.shoes[1].torque


def test_a_wheel_cylinder_presses_by_its_area() -> None:
    data = changed(DRUM, load={"cylinder_bore": "20 mm", "line_pressure": "40 bar"})
    assert drum_from_dict(data).solve().force == pytest.approx(np.pi * 0.01**2 * 4e6, rel=1e-14)


@pytest.mark.parametrize(
    "key, given, name", [("torque", "300 N m", "torque"), ("peak_pressure", "0.4 MPa", "peak_pressure")]
)
def test_other_demands_are_met(key: str, given: str, name: str) -> None:
    found = drum_from_dict(changed(DRUM, load={key: given})).solve()
    assert getattr(found, name) == pytest.approx({"torque": 300.0, "peak_pressure": 4e5}[key], rel=1e-13)


def test_the_textbooks_line_of_no_pressure() -> None:
    found = drum_from_dict(changed(DRUM, shoe__pressure_zero="pivot")).core.shoes
    assert all(s.pressure_zero == "pivot" for s in found)


@pytest.mark.parametrize(
    "keys, parts",
    [
        ({"shoe__lining_end": "20 deg"}, ["shoe", 'lining_end = "20 deg"', "empty", "lining_start"]),
        ({"shoe__lining_start": "5 deg"}, ['lining_start = "5 deg"', "overlaps the pin, at 10.3048 deg"]),
        ({"shoe__lining_end": "200 deg"}, ['lining_end = "200 deg"', "leaves the drum"]),
        ({"shoe__lining_start": "30"}, ["shoe.lining_start", "give a unit"]),
        ({"shoe__lining_start": "30 mm"}, ["shoe.lining_start", "length", "angle"]),
        ({"shoe__pivot_depth": "-110 mm"}, ["shoe.pivot_depth", "greater than 0"]),
        ({"shoe__force_arm": "-120 mm"}, ["force_arm", "above the pin"]),
        ({"shoe__pressure_zero": "pin"}, ["shoe.pressure_zero", "'axis'", "'pivot'"]),
        ({"brake__friction": "0.35"}, ["brake.friction", "without a unit or quotes"]),
        ({"brake__friction": -0.1}, ["brake.friction = -0.1", "at least 0"]),
        ({"brake__friction": 35}, ["brake.friction = 35", "at most 10", "35 % is 0.35"]),
        ({"brake__assembly": "duo"}, ["brake.assembly", "'simplex'"]),
        ({"brake__assembly": "single"}, ["second_shoe", "leave it out"]),
        ({"second_shoe__pivot_offset": "120 mm"}, ["second_shoe", "overlaps the pin"]),
        ({"second_shoe__drum_radius": "1 m"}, ["second_shoe.drum_radius", "unknown key"]),
        ({"load__torque": "300 N m"}, ["load", "give one of", "got force and torque"]),
        ({"load": {"cylinder_bore": "20 mm"}}, ["load", "got cylinder_bore"]),
        ({"load": {}}, ["load", "got none"]),
        ({"load__force": "1000 Pa"}, ["load.force", "pressure", "force is wanted"]),
        ({"load": None}, ["load: missing", "[load]"]),
        ({"shoe__lining_strat": "30 deg"}, ["lining_strat", "did you mean lining_start?"]),
    ],
)
def test_one_mistake_in_a_drum_brake(keys: dict[str, Any], parts: list[str]) -> None:
    (found,) = mistakes(drum_from_dict, changed(DRUM, **keys))
    assert [part for part in parts if part not in found] == []


def test_all_mistakes_at_once() -> None:
    keys = {"shoe__drum_radius": "-1 mm", "shoe__face_width": None, "brake__friction": "x", "lode": 1}
    found = mistakes(drum_from_dict, changed(DRUM, **keys))
    places = [m.split(":")[0].split(" =")[0] for m in found]
    assert sorted(places) == ["brake.friction", "lode", "shoe.drum_radius", "shoe.face_width"]


def test_a_torque_demanded_of_a_brake_that_locks_is_refused() -> None:
    design = drum_from_dict(changed(DRUM, load={"torque": "300 N m"}, brake__friction=1.2))
    with pytest.raises(ValueError, match=r"friction = 1\.2: a shoe locks"):
        design.solve()


# Forklift ---------------------------------------------------------------------------------------------


def test_the_example_is_the_truck_of_the_paper() -> None:
    found = solve_stages(load_forklift(EXAMPLES / "forklift.toml"))
    assert found.stop is not None and found.motion is not None and found.forces is not None
    assert found.stop.acceleration == pytest.approx(-1.5715, abs=5e-5)  # the facts
    assert found.motion.geometry == forklift.BENDIX_12_5
    assert found.forces.torque == found.stop.torque_per_brake and found.torque_from == "the stop"


def test_the_files_stop_as_printed_is_the_papers_base_case() -> None:
    found = answer_as_printed(forklift_from_dict(FORKLIFT), ("vehicle", "forces"))
    assert found is not None and found.stop is not None and found.forces is not None
    assert abs(found.stop.distance - 9.557) < 5e-4 and abs(found.stop.torque_per_brake - 11000.5) < 0.05
    assert found.forces.torque == found.stop.torque_per_brake and found.torque_from == "the stop"


def test_the_papers_stop_has_no_part_where_the_torque_is_given() -> None:
    design = forklift_from_dict(changed(FORKLIFT, forces__torque="11 kN m"))
    assert answer_as_printed(design, ("kinematics", "forces")) is None


def test_a_torque_in_the_file_goes_before_that_of_the_stop() -> None:
    design = forklift_from_dict(changed(FORKLIFT, forces__torque="11 kN m"))
    for found in (solve_stages(design), solve_stages(design, ("forces",))):
        assert found.forces is not None and found.forces.torque == 11000.0
        assert found.torque_from == "the file"
    assert solve_stages(design, ("forces",)).stop is None  # not asked for


def test_without_a_torque_it_follows_from_the_lining() -> None:
    data = {"brake": FORKLIFT["brake"], "forces": FORKLIFT["forces"] | {"lining_friction": 0.4}}
    found = solve_stages(forklift_from_dict(data))
    assert found.forces is not None and found.torque_from == "the lining's friction"
    assert found.forces.lining_friction == pytest.approx(0.4, rel=1e-12)


def test_each_stage_alone() -> None:
    alone = {
        ("vehicle",): ("truck", "stop"),
        ("kinematics",): ("brake",),
    }
    for stages, tables in alone.items():
        design = forklift_from_dict({table: FORKLIFT[table] for table in tables})
        assert design.stages == stages
        solve_stages(design)
    forces = {"piston_force": "11650 N", "torque": "11000 N m"}
    assert forklift_from_dict({"levers": LEVERS, "forces": forces}).stages == ("forces",)


@pytest.mark.parametrize(
    "keys, parts",
    [
        ({"truck__load_cg_x": "-3 m"}, ["truck", "ahead of the front wheel", "less load"]),
        ({"truck__empty_cg_x": "2 m"}, ["truck", "behind the rear wheel"]),
        ({"truck__load_mass": "3500 N"}, ["truck.load_mass", "force", "mass is wanted"]),
        ({"stop__slope": "17.3 m"}, ["stop.slope", "angle"]),
        ({"stop__slope": "46 deg"}, ["stop.slope", "at least -45, at most 45 deg; no road is steeper"]),
        ({"stop__speed": "0 km/h"}, ["stop.speed", "greater than 0"]),
        ({"stop__speed": "20"}, ["stop.speed", "give a unit"]),
        ({"stop__model": "as_printed"}, ["stop.model", "unknown key"]),
        ({"stop__slope_factor": 0.97}, ["stop.slope_factor", "unknown key"]),
        ({"brake__tip_x": "200 mm"}, ["brake", "distance of tip", "inside the drum"]),
        ({"brake__adjuster_y": "122 mm"}, ["brake.adjuster_y", "below 0"]),
        ({"brake__tip": ["1 m"]}, ["brake.tip", "unknown key", "did you mean tip_"]),
        ({"levers": LEVERS}, ["[brake] and [levers]"]),
        (
            {"brake": None, "levers": LEVERS | {"b2": "120 mm"}},
            ["levers", "b1 = 0.122 m", "b2 = 0.12 m", "one line"],
        ),
        ({"truck": None}, ["[forces]", "give torque or lining_friction"]),
        ({"truck": None, "brake": None}, ["no stage is complete"]),
        ({"stop__friction": 70}, ["stop.friction = 70", "at most 2", "70 % is 0.7"]),
        ({"forces__lining_friction": 40}, ["forces.lining_friction = 40", "at most 10"]),
    ],
)
def test_one_mistake_in_a_forklift(keys: dict[str, Any], parts: list[str]) -> None:
    (found,) = mistakes(forklift_from_dict, changed(FORKLIFT, **keys))
    assert [part for part in parts if part not in found] == []


@pytest.mark.parametrize(
    "keys, message",
    [
        (
            {"stop__slope": "44 deg", "truck__empty_cg_y": "2.5 m"},
            r"slope = 44 deg: the truck overturns .* past 38\.0238 deg",
        ),
        ({"brake__clearance": "200 mm"}, r"clearance = 0\.2 m: larger than the drum allows"),
        ({"forces__lining_friction": 1.3}, r"^lining_friction = 1\.3: the brake locks"),
    ],
)
def test_what_the_stages_refuse(keys: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        solve_stages(forklift_from_dict(changed(FORKLIFT, **keys)))


def test_a_stage_without_its_tables() -> None:
    design = forklift_from_dict({"brake": FORKLIFT["brake"]})
    with pytest.raises(ValueError, match=r"stage vehicle needs the tables \[truck\] and \[stop\]"):
        solve_stages(design, ("vehicle",))


# Descriptions, words ------------------------------------------------------------------------------------


@pytest.mark.parametrize("model", [DrumInput, ForkliftInput])
def test_every_input_is_described(model) -> None:
    inputs = describe(model)
    assert len(inputs) > 15
    for entry in inputs:
        assert entry.quantity.meaning and not entry.quantity.meaning.endswith("."), entry.path
        assert entry.choices or entry.quantity.unit or entry.quantity.symbol, entry.path


def test_angles_in_messages() -> None:
    error = InvalidValue("lining[0]", math.pi / 6, "less than {limit}", "give {unit}", "rad", -1e-3)
    assert str(error) == "lining[0] = 0.523599 rad: less than -0.001 rad; give rad"
    assert str(in_degrees(error)) == "lining[0] = 30 deg: less than -0.0572958 deg; give deg"


# Sweeps -------------------------------------------------------------------------------------------------


def parse_axis(design: Any, text: str) -> varied_inputs.Axis:
    return varied_inputs.parse_axis(BRAKE.sweep_inputs(design, {}), text)


TORQUE = Output("torque", "torque", lambda r: r.torque, "N m")
DISTANCE = Output("distance", "distance", lambda a: a.stop.distance, "m")


def test_an_axis_in_its_unit_and_in_si() -> None:
    axis = parse_axis(drum_from_dict(DRUM), "shoe.lining_end = 50:110:3 deg")
    np.testing.assert_allclose(axis.given, [50, 80, 110], rtol=1e-15)
    np.testing.assert_allclose(axis.values, np.radians([50, 80, 110]), rtol=1e-15)


@pytest.mark.parametrize(
    "key, path",
    [("friction", "brake.friction"), ("lining_end", "shoe.lining_end"), ("second_shoe.face_width",) * 2],
)
def test_short_keys_mean_the_input_that_must_be_given(key: str, path: str) -> None:
    unit = "" if key == "friction" else ("deg" if "lining" in key else "mm")
    assert parse_axis(drum_from_dict(DRUM), f"{key}=0.5:0.7:2 {unit}").input.path == path


@pytest.mark.parametrize(
    "text, parts",
    [
        ("frictoin=0:1:3", ["frictoin", "did you mean friction?"]),
        ("pressure_zero=0:1:3", ["it is a choice (pivot, axis)"]),
        ("friction=0.1:0.5", ["start:stop:count", "brake.friction=1:2:11"]),
        ("friction", ["start:stop:count"]),
        ("friction=0.1:0.5:1", ["count from 2"]),
        ("friction=0.1:0.5:1000000", ["count from 2 to 100000"]),
        ("friction=0.5:0.5:3", ["two different ends"]),
        ("friction=-0.1:0.5:3", ["-0.1", "at least 0"]),
        ("friction=0.1:0.5:3 m", ["without a unit"]),
        ("lining_end=50:80:3", ["give a unit"]),
        ("lining_end=50:80:3 mm", ["length", "angle"]),
    ],
)
def test_mistakes_in_a_sweep(text: str, parts: list[str]) -> None:
    with pytest.raises(ValueError) as refusal:
        parse_axis(drum_from_dict(DRUM), text)
    assert [part for part in ["--vary", *parts] if part not in str(refusal.value)] == []


def test_an_ambiguous_key_names_its_candidates() -> None:
    data = {
        "levers": LEVERS,
        "truck": FORKLIFT["truck"],
        "stop": FORKLIFT["stop"],
        "forces": FORKLIFT["forces"],
    }
    assert parse_axis(forklift_from_dict(data), "drum_radius=150:160:2 mm").input.path == "levers.drum_radius"
    both = parse_axis(forklift_from_dict(FORKLIFT), "drum_radius=150:160:2 mm")
    assert both.input.path == "brake.drum_radius"


def test_a_sweep_is_its_cases_one_by_one() -> None:
    design = drum_from_dict(DRUM)
    axes = [parse_axis(design, text) for text in ("lining_end=60:110:3 deg", "friction=0.2:0.5:2")]
    columns = dict(
        zip((axis.input.path for axis in axes), np.meshgrid(*(a.values for a in axes)), strict=True)
    )
    found = TORQUE.shown(with_parts(design, {path: grid.ravel() for path, grid in columns.items()}).solve())
    assert found.shape == (6,)
    for j, mu in enumerate((0.2, 0.5)):
        for i, end in enumerate((60, 85, 110)):
            one = drum_from_dict(changed(DRUM, shoe__lining_end=f"{end} deg", brake__friction=mu)).solve()
            assert found[3 * j + i] == pytest.approx(one.torque, rel=1e-13)


def test_a_sweep_of_a_chain() -> None:
    design = forklift_from_dict(FORKLIFT)
    axes = [parse_axis(design, "load_mass=0:3500:3 kg")]
    answer = solve_stages(with_parts(design, {axes[0].input.path: axes[0].values}))
    found = input_sweep.swept(varied_inputs.designs_of(axes), [DISTANCE], [DISTANCE.shown(answer)])
    assert found.found[0][0] == np.inf and found.found[0][2] == pytest.approx(13.425, abs=5e-4)
    assert answer.refusals == ("1 of 3 cases do not stop",)
    assert found.to_dict()["inputs"] == ["truck.load_mass"]


def test_results_by_name() -> None:
    assert chosen([TORQUE, DISTANCE], "distance, torque,distance") == [DISTANCE, TORQUE]
    with pytest.raises(ValueError, match="did you mean torque"):
        chosen([TORQUE, DISTANCE], "trque")


# Anything whatever --------------------------------------------------------------------------------------

NUMBERS = ["0", "-1", "1e-300", "1e300", "1e308", "nan", "1", "45", "0.1", "1e6"]
UNITS = ["m", "mm", "deg", "rad", "N", "N m", "kg", "km/h", "s", "Pa", "bar", ""]
KEYS = [(brake, data, t, k) for brake, data in ((BRAKE, DRUM), (TYPE, FORKLIFT))
        for t in data for k in data[t]]  # fmt: skip
VALUES = st.one_of(
    st.builds(lambda n, u: f"{n} {u}".strip(), st.sampled_from(NUMBERS), st.sampled_from(UNITS)),
    st.sampled_from([0, -1, 1e-300, 1e300, 0.5, True, None, [], {}, "", "simplex", "reverse"]),
)


@settings(max_examples=400, derandomize=True, deadline=None)
@given(st.sampled_from(KEYS), VALUES)
def test_any_value_anywhere_is_answered_or_refused(place, value: Any) -> None:
    """Without a warning of numpy, a crash, or an empty message."""
    brake, data, table, key = place
    given_ = copy.deepcopy(data)
    given_[table][key] = value
    try:
        brake.solve(brake.read(given_, "any"))
    except ValueError as error:
        assert str(error)


def test_a_point_beyond_every_mechanism_is_refused_by_name(tmp_path, finished) -> None:
    """It overflowed on the way: "the numbers are out of range"."""
    text = (EXAMPLES / "calipers" / "own-caliper.toml").read_text(encoding="utf-8")
    (tmp_path / "far.toml").write_text(text.replace('["6 mm", "0 mm"]', '["1e40 mm", "0 mm"]'))
    said = " ".join(finished(main(["caliper", str(tmp_path / "far.toml")]), 2).err.split())
    assert "points.right_bolt" in said and "give coordinates of at most 1e+06 m either way" in said


def test_a_caliper_with_one_pad_is_told_how_many_there_are():
    text = (EXAMPLES / "calipers" / "own-caliper.toml").read_text(encoding="utf-8")
    one = text.replace('["right pad", "left pad"]', '["right pad"]')
    with pytest.raises(ConfigError, match=r'caliper\.pads = \["right pad"\]: give at least 2 values'):
        mechanism_from_dict(tomllib.loads(one), "own.toml")
