"""What files, commands, drawings and reports show of a mechanism: friction, what opens, units, JSON."""

from __future__ import annotations

import cmath
import csv
import json
import math
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

from beamdyn._version import __version__
from beamdyn.common.edge.exit_codes import NoAnswer
from beamdyn.common.results.one_line import rounded_up
from brakes.answers.caliper import CALIPER, MECHANISM
from brakes.calipers import NAMED
from brakes.cli import main
from brakes.config.mechanism import load_mechanism, parse_mechanism

EXAMPLES = Path("examples/calipers")
CLAMP = (EXAMPLES / "toggle-clamp.toml").read_text()
SIDE_PULL = (EXAMPLES / "own-caliper.toml").read_text()
RADIUS, RUBS = 'radius = "8 mm"\n', "friction = 0.5\n"
THREE = "364.27", "241.44", "723.52"  # N: without friction, squeezing, releasing

BLOCK_BRAKE = """
title = "block brake"
bodies = ["lever", "drum"]
pin = [{ name = "fulcrum", body = "lever", at = ["0 mm", "0 mm"] },
       { name = "axle", body = "drum", at = ["250 mm", "-200 mm"] }]

[[contact]]
name = "block"
body = "lever"
other = "drum"
at = ["250 mm", "-50 mm"]
normal = [0, 1]
friction = 0.4

[[force]]
name = "hand"
body = "lever"
at = ["600 mm", "0 mm"]
direction = [0, -1]
magnitude = "500 N"

[[moment]]
name = "torque"
body = "drum"

[run]
driver = "torque"
"""


def in_both_pins(more: str) -> str:
    """The toggle clamp with further keys in its pins."""
    for line in ('at = "A"  ', 'at = "B"\n'):
        assert CLAMP.count(line) == 1
    return CLAMP.replace('at = "A"  ', f'{more}at = "A"  ').replace('at = "B"\n', f'{more}at = "B"\n')


def write(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "m.toml"
    path.write_text(text)
    return path


def run(capsys, *arguments) -> tuple[int, str, str]:
    code = main(["caliper", *map(str, arguments)])
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def read(path: Path) -> list[list[str]]:
    return [*csv.reader(path.read_text().splitlines())]


# Friction -----------------------------------------------------------------------------------------


def test_a_command_shows_the_three_forces(capsys, tmp_path):
    files = {key: tmp_path / f"t.{key}" for key in ("json", "csv", "report")}
    files["report"] = tmp_path / "t.html"
    options = [part for key, path in files.items() for part in (f"--{key}", path)]
    code, out, _ = run(capsys, write(tmp_path, in_both_pins(RADIUS + RUBS)), *options)
    assert code == 0
    assert all(number in out and number in files["report"].read_text() for number in THREE)
    found = json.loads(files["json"].read_text())
    forces = [
        found["amplitudes"]["work"],
        *(found["friction"][way]["amplitudes"]["work"] for way in ("squeezing", "releasing")),
    ]
    assert [f"{force:.2f}" for force in forces] == [*THREE]
    rows = read(files["csv"])
    assert [f"{float(number):.2f}" for number in rows[1][-3:]] == [*THREE]
    assert rows[0][-2:] == ["work, squeezing [N]", "work, releasing [N]"]


def test_a_drawing_shows_the_three_forces(tmp_path):
    answer = MECHANISM.solve(parse_mechanism(in_both_pins(RADIUS + RUBS)))
    title = answer.figure(0.0).axes[0].get_title()
    assert "work: 364.3 N without friction, 241.4 N squeezing, 723.5 N releasing" in title
    legend = [text.get_text() for text in answer.figure().axes[1].get_legend().get_texts()]
    assert {"work", "work, squeezing", "work, releasing"} <= {*legend}
    titles = [ax.get_title() for ax in answer.free_bodies().axes]
    headings = dict.fromkeys(title.splitlines()[0].partition(", ")[2] for title in titles)
    assert [*headings] == ["without friction", "squeezing", "releasing"]


def test_friction_of_the_run_is_that_of_every_pin_without_its_own():
    each = MECHANISM.solve(parse_mechanism(in_both_pins(RADIUS + RUBS)))
    all_ = MECHANISM.solve(parse_mechanism(in_both_pins(RADIUS).replace("[run]", "[run]\nfriction = 0.5")))
    own = MECHANISM.solve(
        parse_mechanism(in_both_pins(RADIUS + RUBS).replace("[run]", "[run]\nfriction = 0.9"))
    )
    loads = [answer.friction.drawn.squeeze.amplitudes["work"] for answer in (each, all_, own)]
    assert loads[0] == loads[1] == loads[2]


def test_friction_is_swept_and_its_forces_are_results():
    tables = MECHANISM.open(str(EXAMPLES / "toggle-clamp.toml"))[0]
    tables = {
        **tables,
        "pin": [{**pin, "radius": "8 mm"} for pin in tables["pin"]],
        "run": {"driver": "hand", "friction": 0},
    }
    made, _ = MECHANISM.sweep(tables, "clamp", ["run.friction=0:0.5:3"], "work,work_squeezing,work_releasing")
    without, squeezing, releasing = made.found
    assert (without == without[0]).all() and np.isnan(squeezing[0])
    assert f"{squeezing[-1]:.2f}" == THREE[1] and f"{releasing[-1]:.2f}" == THREE[2]
    assert made.error.max() < 1e-12


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (in_both_pins(RADIUS + RUBS).partition("[run]")[0], ["run.driver", "friction of A and B"]),
        (CLAMP.replace("[run]", "[run]\nfriction = 0.5"), ["run.friction = 0.5", "pin 'A'", "no radius"]),
        (BLOCK_BRAKE.replace("friction = 0.4", "friction = 0").replace('driver = "torque"', "friction = 0.2"),
         ["run.friction", "radius"]),
        (CLAMP.replace('travel = "14 mm"', "#"), ["run.travel", "travel of the driver, or leave out driver"]),
        (CLAMP.replace("[run]", "[run]\nfriction = 70"), ["run.friction", "at most 10"]),
    ],
)  # fmt: skip
def test_friction_that_cannot_act_is_refused(capsys, tmp_path, text, words):
    code, _, err = run(capsys, write(tmp_path, text))
    assert code == 2 and all(word in err for word in words), err


def test_a_block_brake_needs_no_travel(capsys, tmp_path):
    """mu r N with N = P arm / (block -+ mu offset); the drum, seen by the lever, turns either way."""
    lever = {
        way: 500 * 0.6 / (0.25 - sign * 0.4 * 0.05) for way, sign in (("squeezing", 1), ("releasing", -1))
    }
    code, out, err = run(capsys, write(tmp_path, BLOCK_BRAKE))
    assert (code, err) == (0, "")
    assert f"{0.4 * 0.15 * lever['squeezing']:.5g}" in out
    assert f"{-0.4 * 0.15 * lever['releasing']:.5g}" in out


def test_a_brake_that_jams_ends_with_1(capsys, tmp_path):
    """At mu = block / offset = 5 the friction presses the block on as hard as its reaction lifts it."""
    text, made = BLOCK_BRAKE.replace("friction = 0.4", "friction = 5.1"), tmp_path / "a.json"
    code, out, err = run(capsys, write(tmp_path, text), "--json", made)
    assert code == 1 and "squeezing: self-locking" in err and "no size of 'torque'" in err
    assert "not determined" in out and "none" not in out
    assert json.loads(made.read_text())["refusals"][0].startswith("squeezing: self-locking")


def test_friction_without_one_motion_is_an_answer_that_says_so(capsys, tmp_path):
    text = (
        in_both_pins(RADIUS + RUBS)
        .replace('travel = "14 mm"', "#")
        .replace(
            "\n[[force]]                   # no magnitude",
            '\n[[pin]]\nname = "stop"\nbody = "arm"\nat = "E"\n[[force]]                   # no magnitude',
        )
        .replace('name = "work"', 'name = "work"\nmagnitude = "1 N"')
    )
    text = text.replace('[[pin]]\nname = "stop"', '[[contact]]\nname = "stop"\nnormal = [0, 1]')
    code, _, err = run(capsys, write(tmp_path, text))
    assert code == 1 and "friction needs mobility 1; here the mobility is 0" in err


# Calipers of parts --------------------------------------------------------------------------------


def own_friction(caliper: str) -> str:
    for bolt in ("right_bolt", "left_bolt"):
        caliper = caliper.replace(f'at = "{bolt}"', f'at = "{bolt}"\nradius = "4 mm"\nfriction = 0.15')
    return caliper


def test_a_caliper_of_parts_keeps_the_friction_of_its_pins():
    """The file's own friction gives what [run] friction gives with the usual radius of 4 mm."""
    of_run = MECHANISM.solve(parse_mechanism(SIDE_PULL)).friction
    own = MECHANISM.solve(parse_mechanism(own_friction(SIDE_PULL.replace("friction = 0.15", "")))).friction
    assert own.squeezing_tension == pytest.approx(of_run.squeezing_tension, rel=1e-13)
    assert own.releasing_tension == pytest.approx(of_run.releasing_tension, rel=1e-13)
    assert own.releasing_tension < own.tension == 160.0 < own.squeezing_tension


def test_a_caliper_shows_the_tension_of_its_cable_three_times(capsys):
    code, out, _ = run(capsys, EXAMPLES / "own-caliper.toml")
    found = MECHANISM.solve(load_mechanism(EXAMPLES / "own-caliper.toml"))
    assert code == 0
    text = " ".join(out.split())
    assert (
        f"cable 160 N without friction, {found.friction.squeezing_tension:.5g} N squeezing, "
        f"{found.friction.releasing_tension:.5g} N releasing" in text
    )
    assert "160 N without friction" in found.figure().axes[0].get_title()


# What opens ---------------------------------------------------------------------------------------


def test_a_contact_that_would_have_to_pull_ends_with_1(capsys, tmp_path):
    upward = BLOCK_BRAKE.replace("direction = [0, -1]", "direction = [0, 1]")
    path = tmp_path / "found.json"
    code, out, err = run(capsys, write(tmp_path, upward), "--json", path)
    assert code == 1 and "contact 'block' would have to pull with 1200 N" in err
    assert "block" in out
    found = json.loads(path.read_text())
    assert (found["status"], found["open_or_slack"]) == ("contact opens", ["block"])


def test_a_cable_that_would_have_to_push_ends_with_1(capsys, tmp_path):
    text = CLAMP.replace("[[bar]]", "[[cable]]").replace(
        'body = "handle"\nat = "C"\nto = "D"', 'bodies = ["handle", "ground"]\npoints = ["C", "D"]'
    )
    code, _, _ = run(capsys, write(tmp_path, text))
    assert code == 0  # it pulls as drawn
    code, _, err = run(capsys, write(tmp_path, text.replace('"-90 deg"', '"90 deg"')))
    assert code == 1 and "cable 'CD' would have to push" in err


def test_a_roller_that_opens_ends_with_1(capsys, tmp_path):
    text = 'caliper = "dual-pivot"\n[dimensions]\nside_pivot = ["27 mm", "80 mm"]\n[run]\ntravel = "1 mm"\n'
    code, _, err = run(capsys, write(tmp_path, text))
    assert code == 1 and "contact 'roller' would have to pull" in err


# Units --------------------------------------------------------------------------------------------


def test_newtons_and_newton_metres_have_axes_of_their_own(tmp_path):
    text = BLOCK_BRAKE.replace("[[contact]]", "[[slot]]").replace("normal = [0, 1]", "along = [1, 0]")
    text = text.replace("friction = 0.4", "friction = 0").replace("[run]", '[run]\ntravel = "1 deg"')
    figure = MECHANISM.solve(parse_mechanism(text)).figure()
    labels = [ax.get_ylabel().replace("\n", " ") for ax in figure.axes[1:]]
    assert labels == ["force of the load [N]", "moment of the load [N m]"]
    curves = [
        [line.get_label() for line in ax.get_lines() if line.get_label()[0] != "_"] for ax in figure.axes[1:]
    ]
    assert curves == [["hand"], ["torque"]]
    assert [ax.get_xlabel() for ax in figure.axes[1:]] == ["", "travel of torque [deg]"]


def test_a_couple_in_a_caliper_is_not_drawn_among_its_forces():
    """Kept in step by a lock that is there all along, and a cable on one side: the lock carries a couple."""
    text = SIDE_PULL.replace('centring = ["springs"]', "centring = []").replace(
        'at = "right_pad"', 'at = ["10 mm", "-40 mm"]'
    )
    figure = MECHANISM.solve(parse_mechanism(text.replace("friction = 0.15", ""))).figure()
    labels = [ax.get_ylabel().replace("\n", " ") for ax in figure.axes[3:]]
    assert labels == ["force of the joint [N]", "couple of the joint [N m]"]
    forces, couples = ({line.get_label() for line in ax.get_lines()} for ax in figure.axes[3:])
    assert "springs" in couples and "springs" not in forces


def test_each_row_of_forces_has_its_unit(capsys, tmp_path):
    path = tmp_path / "t.csv"
    _, out, _ = run(capsys, write(tmp_path, BLOCK_BRAKE), "--csv", path)
    head, *rows = read(path)
    assert head == ["force_of", "x_N", "y_N", "size", "squeezing", "releasing", "unit"]
    assert {row[0]: row[-1] for row in rows} == {
        "fulcrum": "N", "axle": "N", "block": "N", "hand": "N", "torque": "N m",
    }  # fmt: skip
    assert any(line.split()[0] == "torque" and "N m" in line for line in out.splitlines() if line.strip())
    block = next(row for row in rows if row[0] == "block")
    assert float(block[3]) == pytest.approx(500 * 0.6 / 0.25, rel=1e-14)


# Help ---------------------------------------------------------------------------------------------


def test_help_names_the_argument_and_the_calipers(capsys):
    code, out, _ = run(capsys, "--help")
    assert code == 0 and "Usage: brakes caliper [OPTIONS] MECHANISM" in out
    assert "[ARGS]" not in out and "()" not in out
    assert all(name in out.replace("\n", " ") for name in NAMED)


# JSON ---------------------------------------------------------------------------------------------


COMMANDS = {
    "mechanism": ["caliper", EXAMPLES / "toggle-clamp.toml"],
    "caliper": ["caliper", "v-brake"],
    "friction": ["caliper", "examples/block_brake.toml"],
    "drum": ["drum", "examples/drum.toml"],
    "forklift": ["forklift", "examples/forklift.toml"],
    "vehicle": ["forklift", "examples/forklift.toml", "--stage", "vehicle"],
    "kinematics": ["forklift", "examples/forklift.toml", "--stage", "kinematics"],
    "sweep": ["drum", "examples/drum.toml", "--vary", "friction=0.1:0.3:3"],
    "sweep of a caliper": ["caliper", "v-brake", "--vary", "dimensions.lever_ratio=2:3:2"],
}


@pytest.mark.parametrize("command", COMMANDS.values(), ids=COMMANDS)
def test_json_says_from_what_and_how_well_it_was_computed(tmp_path, command):
    path = tmp_path / "found.json"
    assert main([*map(str, command), "--json", str(path)]) == 0
    found = json.loads(path.read_text())
    made = found["provenance"]
    assert made["version"] == __version__
    assert made["method"] and made["compared_with"] and made["wall_time"] > 0
    errors = found["error"] if isinstance(found["error"], list) else [found["error"]]
    assert all(0 <= error < 1e-11 for error in errors)
    given = found["design"] if "design" in found else found["inputs"]
    assert isinstance(given, dict) and given


def test_inputs_in_json_are_in_si():
    answer = MECHANISM.solve(load_mechanism(EXAMPLES / "toggle-clamp.toml"))
    given = answer.to_dict()["inputs"]
    assert given["points"]["grip"] == [0.08, 0.012]
    assert given["run"]["travel"] == 0.014
    assert math.isclose(math.hypot(*given["force"][0]["direction"]), 1.0)


# Where it ends ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "tables, said",
    [
        (
            {"run": {"travel": "30 mm"}},
            "driver 'cable' cannot reach 30 mm: it turns back at 21.6949 mm (toggle position); "
            "give a smaller travel, or move points",
        ),
        (
            {"dimensions": {"clearance": "30 mm"}},
            "the travel of right pad and left pad cannot reach 30 mm: it is 12.8918 mm where it or the "
            "driver 'cable' turns back, at 21.6949 mm; give a smaller clearance, or move points",
        ),
        (
            {"dimensions": {"pad": ["12.5 mm", "46 mm"]}},
            "the cable opens the pads: move pads, pivots or the ends of the cable",
        ),
    ],
    ids=["travel", "clearance", "opens"],
)
def test_what_a_caliper_does_not_reach_is_said_as_its_file_and_form_have_it(tables, said):
    with pytest.raises((NoAnswer, ValueError)) as refused:
        CALIPER.answer({"caliper": "dual-pivot"} | tables, "test")
    assert str(refused.value) == said


@pytest.mark.parametrize("moved", [0.0, 1e-12, 1e-9, 1e-6])
def test_places_are_said_in_the_units_of_the_drawing(moved: float):
    tables, rng = tomllib.loads(CLAMP), np.random.default_rng(1)
    tables["points"]["B"] = ["20 mm", "20 mm"]
    for name, point in tables["points"].items():
        near = (float(given.removesuffix(" mm")) + moved * rng.uniform(-1, 1) for given in point)
        tables["points"][name] = [f"{x!r} mm" for x in near]
    answer = MECHANISM.answer(tables, "test")
    assert "handle turns about (20, 20) mm" in answer.refusals[0]
    assert "turns about (20, 20) mm" in str(answer.tables()[-1])
    assert not answer.warnings  # the work stands still all the time: no toggle position


def hand_where_the_arm_stands_still() -> float:
    """Travel of the hand [mm] at which B, C and D are in line, so that the handle turns about B."""
    a, d, arm, handle, bar = -40j, 40 + 54.64101615137754j, 40.0, abs(20 + 20j), 40.0
    base = abs(d - a)
    lean = math.acos((arm**2 + base**2 - (handle + bar) ** 2) / (2 * arm * base))
    b = a + arm * cmath.exp(1j * (cmath.phase(d - a) + lean))
    turn = (d - b) / abs(d - b) / cmath.exp(0.25j * math.pi)
    return 12.0 - (b + (80 + 12j) * turn).imag


@pytest.mark.parametrize("moved", [0.0, 1e-12, 1e-9, 1e-6])
def test_toggles_are_said_in_the_units_of_the_drawing_wherever_rounding_puts_its_points(moved: float):
    """Once, for the work, which turns back; within half of the last digit that is printed."""
    tables = tomllib.loads(CLAMP)
    tables["points"]["C"] = [f"{20 + moved!r} mm", f"{20 - moved!r} mm"]
    tables["run"] |= {"travel": "-20 mm"}
    answer = MECHANISM.answer(tables, "test")
    (toggle,) = answer.motion.toggles
    assert 1e3 * toggle.value == pytest.approx(hand_where_the_arm_stands_still(), abs=1e-5)
    (warning,) = answer.warnings
    found = re.match(r"toggle position of 'work' at driver value (\S+) mm: ", warning)
    assert found and float(found[1]) == pytest.approx(hand_where_the_arm_stands_still(), abs=6e-5)


def test_a_driver_that_turns_is_said_in_degrees():
    tables = tomllib.loads(CLAMP)
    tables["moment"] = [{"name": "turn", "body": "arm", "magnitude": "0 N m"}]
    tables["run"] = {"driver": "turn", "travel": "200 deg"}
    with pytest.raises(NoAnswer, match=r"'turn' cannot reach 200 deg: it turns back at [-\d.]+ deg "):
        MECHANISM.answer(tables, "test")


# What stands in its drawing -----------------------------------------------------------------------------


@pytest.mark.parametrize("place", [0.0, 1.0])
def test_the_force_of_a_bar_to_the_ground_is_said_once(place):
    ((drawing,),) = MECHANISM.answer(tomllib.loads(CLAMP), "test").drawings(place)
    texts = [label.text for label in drawing.labels]
    assert sum(text.startswith("CD ") for text in texts) == 1
    (arrow,) = [shape for shape in drawing.shapes if getattr(shape, "name", "") == "CD"]
    np.testing.assert_allclose(
        arrow.foot, (40, 54.64101615), rtol=1e-9
    )  # D, beyond which it does not cover CD
    assert arrow.tip[1] > arrow.foot[1]


def test_the_reaction_of_a_bar_that_is_pressed_comes_from_beyond_its_end():
    tables = tomllib.loads(CLAMP)
    tables["force"][0]["direction"] = "90 deg"
    ((drawing,),) = MECHANISM.answer(tables, "test").drawings(0.0)
    (arrow,) = [shape for shape in drawing.shapes if getattr(shape, "name", "") == "CD"]
    np.testing.assert_allclose(arrow.tip, (40, 54.64101615), rtol=1e-9)
    assert arrow.foot[1] > arrow.tip[1]


def test_no_label_of_a_caliper_stands_twice():
    for name in NAMED:
        ((drawing,),) = CALIPER.answer({"caliper": name}, "test").drawings(1.0)
        texts = [label.text for label in drawing.labels]
        assert len(set(texts)) == len(texts), texts


def test_a_body_with_two_pins_at_one_place_is_drawn():
    """So it is while a mechanism is built: another pin first stands where the last one does."""
    pins = [{"name": name, "body": "arm", "at": "A"} for name in ("first", "second")]
    tables = {"bodies": ["arm"], "points": {"A": ["0 mm", "0 mm"]}, "pin": pins}
    ((drawing,),) = MECHANISM.answer(tables, "test").drawings(0.0)
    assert sum(getattr(shape, "kind", "") == "pin" for shape in drawing.shapes) == 2


def test_what_is_printed_states_the_error_of_the_forces():
    answer = MECHANISM.answer({"caliper": "v-brake"}, "test")
    assert 0 < answer.error < 1e-12
    assert f"Error of the forces: {rounded_up(answer.error)} of the largest" in str(answer.tables()[-1])
