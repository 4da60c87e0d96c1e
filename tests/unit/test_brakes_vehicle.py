"""`brakes vehicle`, and `brakes forklift` with a pedal: what is printed, exit codes, and bad input."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from beamdyn.common.edge.exit_codes import BAD_INPUT, DONE, NO_ANSWER
from brakes import vehicle
from brakes.cli import main

EXAMPLES = Path(__file__).parents[2] / "examples"
PEDAL = """
[pedal]
ratio = 5
force = "450 N"
booster = 3
travel = "150 mm"

[line]
master_bore = "22.22 mm"
cylinder_bore = "31.75 mm"
piston_travel = "0.5 mm"
compliance = "0.05 cm3/bar"
most_pressure = "18 MPa"

[drums]
drum_mass = "18 kg"
lining_area = "500 cm2"
"""
LINE = '[line]\nmaster_bore = "20 mm"\ncylinder_bore = "20 mm"'
BARE = '[vehicle]\nmass = "1 kg"\ncg_behind_front = "1 m"\ncg_height = "1 m"\nwheelbase = "2 m"'


@pytest.fixture
def run(capsys, tmp_path):
    """Run a command on a text with some of it replaced."""

    def run(name: str, text: str, *replaced: tuple[str, str]) -> tuple[int, str, str]:
        for old, new in replaced:
            assert old in text
            text = text.replace(old, new, 1)
        file = tmp_path / "brake.toml"
        file.write_text(text)
        code = main([name, str(file)])
        return code, *capsys.readouterr()

    return run


@pytest.fixture
def forklift():
    text = (EXAMPLES / "forklift.toml").read_text()
    return text.replace('piston_force = "11650 N"', "lining_friction = 0.390283458") + PEDAL


@pytest.fixture
def truck():
    return (EXAMPLES / "vehicle.toml").read_text()


def row(out: str, words: str) -> list[str]:
    (line,) = (line for line in out.splitlines() if line.strip().startswith(words + "  "))
    return line.strip().removeprefix(words).split()


def test_a_forklift_is_braked_from_its_pedal(run, forklift):
    code, out, _ = run("forklift", forklift)
    assert code == DONE and "the road limits" in out
    assert row(out, "force on the pedal at which the wheels just lock")[0] == "380.40"
    assert row(out, "... into the drums")[0] == "57386"
    assert row(out, "acceleration, wheels locked")[0] == "-1.5715"


def test_a_forklift_whose_brakes_are_too_weak_has_no_answer(run, forklift):
    code, out, err = run("forklift", forklift, ("booster = 3", "booster = 1"))
    assert code == NO_ANSWER and "the brake limits" in out
    assert row(out, "acceleration, wheels rolling")[0] == "1.1462"
    assert "the brakes hold less than the slope pulls" in err


def test_both_directions_of_parking(run, truck):
    code, out, _ = run("vehicle", truck)
    assert code == DONE
    assert row(out, "slips past")[:2] == ["41.272", "25.607"]
    assert row(out, "tips over the lower axle past")[0] == "15.245"
    code, _, err = run("vehicle", truck, ('slope = "15 %"', 'slope = "28 %"'))
    assert code == NO_ANSWER
    assert "front axle downhill: rolls on slopes above 14.6061 deg: on the given 15.6422 deg it rolls" in err
    assert "rear axle downhill: rolls on slopes above 14.6061 deg: on the given 15.6422 deg it rolls" in err


def test_force_at_the_lever_holds_on_its_slope(run, truck):
    """The force that is found, given again: the slope is the largest, which is too near to decide."""
    _, out, _ = run("vehicle", truck, ('force = "250 N"', 'force = "200 N"'))
    found = row(out, "force on the lever that holds")[0]
    code, _, err = run("vehicle", truck, ('force = "250 N"', f'force = "{float(found) * 1.001:.9g} N"'))
    assert code == DONE and not err
    code, _, err = run("vehicle", truck, ('force = "250 N"', f'force = "{float(found) * 0.999:.9g} N"'))
    assert code == NO_ANSWER and "it rolls" in err


def test_what_cannot_be_had_says_why(run, truck):
    _, out, _ = run(
        "vehicle", truck, ('travel = "300 mm"', 'travel = "200 mm"'), ('slope = "15 %"', 'slope = "30 %"')
    )
    said = " ".join(out.split())
    assert "front downhill: none: the vehicle tips over its lower axle, whatever the friction" in said
    assert "none: the pedal reaches the end of its travel" in said or "ratio of the lever" in said


def test_the_bicycle_pitches_over(run):
    text = (EXAMPLES / "bicycle.toml").read_text()
    code, out, _ = run("vehicle", text, ("front_share = 0.7", "front_share = 1"))
    assert code == DONE
    assert row(out, "pitches over, g")[0] == "0.5636"
    assert row(out, "ends the hardest braking") == ["pitching", "over", "front"]


def test_files_have_all_numbers(tmp_path, capsys):
    sheet = tmp_path / "vehicle.csv"
    assert main(["vehicle", str(EXAMPLES / "vehicle.toml"), "--csv", str(sheet)]) == DONE
    found = {name: value for name, value, *_ in csv.reader(sheet.read_text().splitlines())}
    assert float(found["slipping_slope_rear"]) == pytest.approx(25.6072006, abs=1e-6)
    capsys.readouterr()


@pytest.mark.parametrize(
    "old, new, parts",
    [
        ('travel = "150 mm"', 'travel = "100 mm"', ('pedal.travel = "100 mm"', "needs a travel of 132.6")),
        ("18 MPa", "16 MPa", ('line.most_pressure = "16 MPa"', "gives 17.4")),
        ("booster = 3", "booster = 0.5", ("pedal.booster", "at least 1")),
        ("ratio = 5", "ratio = 0", ("pedal.ratio", "greater than 0")),
        ("lining_friction = 0.390283458", 'piston_force = "9 kN"', ("give lining_friction alone",)),
        ("[line]", "[levers]", ("levers",)),
    ],
)
def test_bad_input_of_a_pedal_is_a_sentence(run, forklift, old, new, parts):
    code, out, err = run("forklift", forklift, (old, new))
    assert code == BAD_INPUT and not out.strip()
    assert [part for part in parts if part not in err] == []


def test_a_brake_that_locks_has_no_answer_alone_and_in_a_sweep(run, forklift, tmp_path, capsys):
    locks = ("lining_friction = 0.390283458", "lining_friction = 1.3")
    code, out, err = run("forklift", forklift, locks)
    assert (code, out.strip()) == (NO_ANSWER, "") and "forces.lining_friction = 1.3: locked" in err
    path = tmp_path / "truck.toml"
    path.write_text(forklift)
    assert main(["forklift", str(path), "--vary", "forces.lining_friction=0.3:1.3:3", "--what", "A"]) == DONE
    assert "the brake locks by itself" in capsys.readouterr().out


@pytest.mark.parametrize(
    "old, new, part",
    [
        ('slope = "15 %"', 'slope = "46 deg"', "at most 45 deg"),
        ('slope = "15 %"', 'slope = "-5 deg"', "at least 0, at most 45 deg"),
        ("front_share = 1 ", "front_share = 60 ", "60 % is 0.6"),
        ("[brakes]\nc_star = 4.6", "# none\n#", "go together"),
        ("\n[cable]\n", f"\n{LINE}\n[cable]\n", "do not go together"),
        ("\n[cable]\n", "\n[cable]\nbrakes = 1.5\n", "cable.brakes = 1.5: it must be a whole number"),
        ("\n[brakes]\n", "\n[brakes]\nnumber = 1.5\n", "brakes.number = 1.5: it must be a whole number"),
        ("[road]", f"{BARE}\n[road]", "either [truck]"),
        ('travel = "300 mm"', 'travel = "100 mm"', "needs a travel of 192 mm"),
    ],
)
def test_bad_input_of_a_vehicle_is_a_sentence(run, truck, old, new, part):
    if old.startswith("[brakes]"):
        truck, old, new = truck[: truck.index("\n[brakes]")], "[road]", "[road]"
    code, out, err = run("vehicle", truck, (old, new))
    assert code == BAD_INPUT and not out.strip()
    assert part in err


def test_a_vehicle_that_is_braked_uphill_alone_slips_and_never_tips():
    bicycle = vehicle.Vehicle(80.0, cg_behind_front=0.62, cg_height=1.10, wheelbase=1.02)
    found = vehicle.hold(bicycle, vehicle.Road(np.radians(40.0), 2.0), "rear", "front")
    assert (found.status, found.limited_by, found.tipping_slope) == ("slips", "slips", np.inf)
    ratio = 2.0 * 0.62 / (1.02 + 2.0 * 1.10)  # of a vehicle that slides on its rear wheel, by moments
    load = 80.0 * 9.806 * np.cos(np.radians(40.0)) * (0.62 - 1.10 * ratio) / 1.02
    assert found.rear_load == pytest.approx(load, rel=1e-12)  # ten operations
    steep = np.arctan(0.53)  # it would lift at 0.62 / 1.10
    needed = vehicle.friction_to_hold(bicycle, steep, "rear", "front")
    assert "even a friction of 2" in needed.message


def test_a_dragging_brake_tips_a_vehicle_on_a_slope_that_is_steep_enough():
    """The brake's force is the same on each slope; what presses the wheels falls with its cosine."""
    bicycle = vehicle.Vehicle(80.0, cg_behind_front=0.62, cg_height=1.10, wheelbase=1.02)
    roads = vehicle.Road(np.radians([25.0, 28.0, 40.0]), 2.0)
    found = vehicle.hold(bicycle, roads, "both", "front", 0.45 * 80.0 * 9.806)
    assert found.status.tolist() == ["holds", "rolls", "tips"]
    assert np.isnan([found.front_load, found.rear_load]).tolist() == [[False, False, True]] * 2


def test_a_bicycle_stops_down_its_slope(run):
    text = (EXAMPLES / "bicycle.toml").read_text()
    code, out, _ = run("vehicle", text)
    assert code == DONE and "A stop down the slope" in out
    assert "no wheel locks" in out and "front wheels locked" in out  # front and rear axle leading
    code, out, err = run("vehicle", text, ('brake_force = "250 N"', 'brake_force = "70 N"'))
    assert code == NO_ANSWER and "downhill: does not stop: the slope pulls as much as the brakes hold" in err
    assert row(out, "stopping distance, from the driver's reaction")[0] == "never"
    code, out, _ = run("vehicle", text, ('brake_force = "250 N"', ""))
    ratio = row(out, "braking force over the force normal to the road")
    assert ratio == row(out, "hardest braking with these shares, g")[:2]


def test_a_sweep_counts_the_stops_that_do_not_end(capsys):
    file = str(EXAMPLES / "bicycle.toml")
    assert main(["vehicle", file, "--vary", "road.friction=0.1:1:4"]) == DONE
    assert "front axle downhill: 1 of 4 cases do not stop" in capsys.readouterr().err


def test_a_truck_is_stopped_by_its_lever(run, truck):
    """The lever of the front wheels gives 4.6 0.15875 6400 N on each of two, at 0.4 m."""
    code, out, _ = run("vehicle", truck, ("[lever]", '[stop]\nspeed = "10 km/h"\n[lever]'))
    assert code == DONE
    assert row(out, "braking force of the front wheels")[1] == "23368"
    assert row(out, "braking force of the rear wheels")[:2] == ["0", "0"]
    assert "Lever, force of 250 N: ISO 6292:2020, 4.5.4, allows 300 N for a hand: kept." in " ".join(
        out.split()
    )


def test_what_limits_a_forklift_is_said_in_its_tables(run, forklift):
    _, out, _ = run("forklift", forklift)
    said = " ".join(out.split())
    assert "the torque is from the road, on locked wheels" in said
    assert "the locked wheels use 0.3626 of their friction 0.3903" in said
    assert row(out, "pressure of the line there")[0] == "14.715"
    assert row(out, "stopping distance if the slope also pulls while the brake force rises")[0] == "15.054"
    _, out, _ = run("forklift", forklift, ("booster = 3", "booster = 2.2"))
    assert "the torque is from the pedal" in out and "sliding" not in out.partition("From the pedal")[0]
    assert "friction of the linings (the brakes limit the stop) -+10 %: " in " ".join(out.split())


def test_what_limits_a_parked_vehicle_is_said_where_its_tyres_do_not(run, truck):
    _, out, _ = run("vehicle", truck)
    said = "the vehicle rolls) 14.606 deg; friction of tyres on the road -+10 %: no change, as something"
    assert said in " ".join(out.split())


def test_a_vehicle_that_rolls_back_before_its_brakes_act_is_said(run):
    uphill = ("[stop]", '[stop]\nheading = "uphill"')
    _, _, err = run("vehicle", (EXAMPLES / "bicycle.toml").read_text(), uphill)
    assert "rolls back" not in err
    late = (uphill[0], uphill[1] + '\nreaction_time = "12 s"')
    text = (EXAMPLES / "bicycle.toml").read_text()
    _, _, err = run("vehicle", "".join(x for x in text.splitlines(True) if "reaction_time" not in x), late)
    said = "front axle leading: the vehicle stops before its brakes hold it, and rolls back"
    assert said in " ".join(err.split())


def test_a_slope_in_percent_has_its_bound_in_percent(run):
    code, _, err = run("vehicle", (EXAMPLES / "bicycle.toml").read_text(), ('"10 %"', '"120 %"'))
    assert code == BAD_INPUT and 'road.slope = "120 %": it must be at least 0, at most 100 %; no road' in err


LESS_SLOPE = ('slope = "0.3019 rad"', 'slope = "0.1 rad"')
HEAT = """
[heat]
stops = 3
surroundings = "20 degC"
friction_curve = [["20 degC", 0.39], ["40 degC", 0.3], ["200 degC", 0.2]]
"""


def test_forklift_with_a_duty_fades(run, forklift):
    code, out, _ = run("forklift", forklift + HEAT, LESS_SLOPE)
    assert code == 0
    assert "Heat at this force; number of stops: 3" in out
    assert "friction at the end of the last" in out


@pytest.mark.parametrize(
    ("replaced", "code", "said"),
    [
        (('["200 degC", 0.2]', '["45 degC", 0.29]'), 1, "the brake gets hotter than the last temperature"),
        (('["200 degC", 0.2]', '["60 degC", 0.01]'), 1, "by fading: it never stops"),
        (('[drums]\ndrum_mass = "18 kg"\nlining_area = "500 cm2"\n', ""), 2, "[heat] needs [drums]"),
    ],
)
def test_forklift_that_fades_too_far_is_said(run, forklift, replaced, code, said):
    found = run("forklift", forklift + HEAT, LESS_SLOPE, replaced)
    assert found[0] == code
    assert said in " ".join(found[2].split())
