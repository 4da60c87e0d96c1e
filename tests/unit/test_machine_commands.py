"""`brakes band` and the other brakes pressed by one force: exit codes, sentences, sweeps, spreads."""

import re
from pathlib import Path

import pytest

from beamdyn.common.edge.exit_codes import BAD_INPUT, DONE, NO_ANSWER
from brakes.answers import STANDARD
from brakes.cli import main

BRAKES = sorted({*STANDARD} - {"vehicle"})
EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture
def answer(tmp_path, capsys):
    """Run a command on its example with a text replaced."""

    def answer(name, old="", new="", *options):
        text = (EXAMPLES / f"{name}.toml").read_text(encoding="utf-8")
        assert old in text
        path = tmp_path / f"{name}.toml"
        path.write_text(text.replace(old, new, 1), encoding="utf-8")
        return main([name, str(path), *options]), *capsys.readouterr()

    return answer


def test_a_band_that_locks_is_refused_in_one_sentence_without_a_number(answer):
    code, out, err = answer("band", "friction = 0.2", "friction = 0.5")
    assert code == NO_ANSWER
    assert "locked: friction 0.5 is at or past self-locking, 0.331; the band grips by itself" in err
    (row,) = (line for line in out.splitlines() if "torque of the brake" in line)
    assert row.split()[4:] == ["-", "N", "m"]
    assert "At this force" not in out


@pytest.mark.parametrize(
    ("name", "old", "new", "parts"),
    [
        (
            "band",
            '"25 mm"',
            '"100 mm"',
            ["band.second_arm", '"100 mm"', "below first_arm", "loosen", "exchange"],
        ),
        ("band", '"240 deg"', '"400 deg"', ["band.wrap", "at most 360 deg"]),
        ("band", 'force = "200 N"', 'torque = "0 N m"', ["load.torque", "greater than 0"]),
        ("disc", '"120 mm"', '"80 mm"', ["disc.outer_radius", "empty", "inner_radius"]),
        ("disc", '"floating"', '"fixed"', ["disc.guide_loss", "has no slide", "leave it out"]),
        ("plates", "faces = 4", "faces = 2.5", ["plates.faces", "whole number"]),
        ("plates", "faces = 4", "faces = 4000000000", ["plates.faces", "at most 1000"]),
        ("cone", '"60 mm"', '"0 mm"', ["cone.width", "greater than 0"]),
        ("block", '"40 deg"', '"120 deg"', ["block.block_angle", "would lift", "below", "shorten"]),
    ],
)
def test_bad_input_names_key_value_bound_and_remedy(answer, name, old, new, parts):
    code, out, err = answer(name, old, new)
    assert (code, out) == (BAD_INPUT, "")
    assert [part for part in parts if part not in err] == []


@pytest.mark.parametrize(
    ("name", "friction"), [("band", 0.31), ("drum", 0.95)]
)  # they lock at 0.331 and 0.999
def test_a_torque_just_below_self_locking_is_answered(name, friction, tmp_path, capsys):
    text = (EXAMPLES / f"{name}.toml").read_text(encoding="utf-8")
    for old, new in ((r"friction = [\d.]+", f"friction = {friction}"), ("force = .*", 'torque = "300 N m"')):
        text, count = re.subn(f"(?m)^{old}", new, text)
        assert count == 1
    (path := tmp_path / "brake.toml").write_text(text, encoding="utf-8")
    assert main([name, str(path)]) == DONE
    out, err = capsys.readouterr()
    assert (
        re.search(r"friction -\+10 %: \d[\d.]* N m \(-[\d.]+ %\), locks", " ".join(out.split())) and not err
    )


def test_a_torque_of_a_brake_that_locks_cannot_be_demanded(answer):
    code, _, err = answer("band", 'force = "200 N"', 'torque = "100 N m"', "--vary", "friction=0.5:0.6:2")
    assert code in (BAD_INPUT, NO_ANSWER) and "the brake locks: no torque can be demanded of it" in err


@pytest.mark.parametrize("name", BRAKES)
def test_every_standard_brake_sweeps_spreads_and_states_what_it_hangs_on(answer, name):
    code, out, err = answer(name)
    assert (code, err) == (DONE, "")
    assert "At this force, torque" in out and "friction -+10 %" in out
    assert answer(name, "", "", "--vary", "friction=0.1:0.2:3", "--what", "torque,c_star")[0] == DONE
    spread = ("--spread", "friction=+-5%", "--samples", "128", "--what", "torque")
    assert answer(name, "", "", *spread)[0] == DONE


@pytest.mark.parametrize(
    ("name", "friction"), [("band", "0.2"), ("block", "0.4"), ("drum", "0.35"), ("sliding", "0.35")]
)
def test_without_friction_no_torque_hangs_on_the_rotation(answer, name, friction):
    """Both torques are 0, whose ratio was a warning of numpy."""
    code, out, err = answer(name, f"friction = {friction}", "friction = 0")
    assert (code, err) == (DONE, "")
    assert "friction -+10 %: 0 N m, 0 N m" in out and "reverse" not in out


@pytest.mark.parametrize("option", ["--vary", "--find", "--spread"])
def test_a_curve_is_no_number_that_varies(answer, option):
    """It was said to have no value in the file, or too few rows."""
    values = {"--vary": "=0.3,0.4", "--find": "", "--spread": "=+-5%"}[option]
    wanted = ("--so-that", "torque=600 N m") if option == "--find" else ()
    code, _, err = answer("disc", "", "", option, f"heat.friction_curve{values}", *wanted)
    assert code == BAD_INPUT and "unknown name 'heat.friction_curve'" in err


def test_the_doubt_of_a_drum_is_that_of_two_more_runs(answer):
    """230.541 and 298.001 N m: recomputed at 0.315 and 0.385, by a second program."""
    _, out, _ = answer("drum")
    assert "230.54 N m (-12.3 %), 298.00 N m (+13.3 %)" in " ".join(out.split())


def test_the_doubt_of_a_stop_is_that_of_two_more_runs(answer):
    """The line on 10 % of friction, which is also said of stops, slopes and calipers."""
    given = "friction = 0.7"
    said = " ".join(answer("forklift")[1].split())
    low, high = (
        re.findall(r"Stopping distance (\S+) m;", " ".join(answer("forklift", given, changed)[1].split()))[0]
        for changed in ("friction = 0.63", "friction = 0.77")
    )
    assert re.search(rf"on the road -\+10 %: {low} m \(\+.* %\), {high} m \(-", said)


@pytest.mark.parametrize(
    ("name", "words", "dimmed"),
    [
        ("drum", "torque of the brake", "62.96"),  # 13 % of 263 N m
        ("drum", "force on each shoe", ""),  # it is given
        ("band", "friction at self-locking", ""),  # of the geometry alone
        ("cone", "torque of the brake", ""),  # it is given
        ("cone", "actuating force", "416.9"),
        ("disc", "radius that C* refers to", "0.00"),  # by the law of the pressure
    ],
)
def test_digits_that_friction_or_law_of_the_pressure_change_are_dimmed(name, words, dimmed):
    brake = STANDARD[name][1]()
    tables, _ = brake.open(str(EXAMPLES / f"{name}.toml"))
    shown = brake.answer(tables, name).tables()[0].renderables[1]
    rows = dict(zip(*([*column.cells] for column in shown.columns[:2]), strict=True))
    cell = rows[words]
    assert (cell.plain[cell.spans[-1].start :] if getattr(cell, "spans", ()) else "") == dimmed


def test_reverse_turns_leading_into_trailing(answer):
    _, out, _ = answer("band", '"forward"', '"reverse"')
    assert "reverse" in out and "never" in out


HEAT = """
[heat]
inertia = "25 kg m2"
speed = "700 rpm"
heated_mass = "5 kg"
stops = 3
friction_curve = [["20 degC", 0.2], ["60 degC", 0.15]]
"""


@pytest.mark.parametrize(
    ("changed", "code", "said"),
    [
        (('["60 degC", 0.15]', '["200 degC", 0.12]'), DONE, ""),
        (
            ("stops = 3", "stops = 3"),  # 27 K a stop, from 20 degC: past 60 degC in the second
            NO_ANSWER,
            "stop 2 of 3: the brake gets hotter than the last temperature of friction_curve",
        ),
        (("stops = 3", 'load_torque = "700 N m"'), NO_ANSWER, "no more torque than load_torque or a slope"),
        (
            ('"20 degC", 0.2', '"20 degC", 0.19'),
            NO_ANSWER,
            "the curve in [heat] begins at friction 0.19, [brake] has 0.2",
        ),
        (
            ('["20 degC", 0.2]', '["20 degC"]'),
            BAD_INPUT,
            'heat.friction_curve = [["20 degC"], ["60 degC", 0.15]]',
        ),
        (('"20 degC", 0.2', '"30 degC", 0.2'), BAD_INPUT, "below the first temperature of friction_curve"),
    ],
)
def test_heat_of_stops(answer, changed, code, said):
    found, out, err = answer("band", 'force = "200 N"', 'force = "200 N"' + HEAT.replace(*changed))
    assert found == code and said in " ".join(err.split())
    if code == DONE:
        assert "hottest, above the surroundings" in out and "Stop by stop" in out


@pytest.mark.parametrize(
    "options",
    [
        ("--vary", "heat.heated_mass=5,50 kg", "--what", "hottest"),
        ("--find", "heat.heated_mass=5:50:9 kg", "--so-that", "hottest = 20 K"),
    ],
)
def test_a_design_that_gets_too_hot_says_so(options, tmp_path, finished):
    file = tmp_path / "band.toml"
    text = (EXAMPLES / "band.toml").read_text()
    file.write_text(text.replace('force = "200 N"', 'force = "200 N"' + HEAT))
    said = " ".join(finished(main(["band", str(file), *options]), DONE).out.split())
    assert " of 3: the brake gets hotter than the last temperature" in said
