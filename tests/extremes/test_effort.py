"""Numbers that would take hours or fill the memory are refused by name, in files, forms and commands."""

import re
import time
import tomllib
from pathlib import Path

import pytest

import beamdyn.cli
import brakes.cli
from beamdyn.app.program import SCENE
from beamdyn.common.drawing.layout import heading
from beamdyn.common.edge.config import ConfigError
from beamdyn.common.screens.open_document import OpenDocument
from brakes.answers.caliper import CALIPER
from brakes.answers.drum import BRAKE as DRUM
from brakes.app.bases import base
from brakes.config.mechanism import parse_mechanism

ROOT = Path(__file__).parents[2]
HARVESTER, ROLLING = "examples/tyre_harvester.toml", "examples/rolling_harvester.toml"
OVER_SPEEDS = [screen for screen in SCENE.screens if screen.name in ("Frequencies", "Steady response")]
SECONDS = 5  # a refusal takes milliseconds; hours or gigabytes would follow


@pytest.fixture(autouse=True)
def soon():
    start = time.process_time()  # which other work on the machine does not lengthen
    yield
    assert time.process_time() - start < SECONDS


@pytest.mark.parametrize("program", OVER_SPEEDS, ids=lambda screen: screen.name)
@pytest.mark.parametrize("speed", ["1e9 rad/s", "1e300 rad/s", "4200 rad/s"])
def test_top_speed_of_a_screen(program, speed):
    work = OpenDocument(SCENE)
    work.put("options.top_speed", speed)
    assert not work.solve(program)
    (path, (said,)), *others = work.mistakes[program.name].items()
    assert path == "options.top_speed" and not others
    assert "10 times the first natural frequency at rest" in said and "at most 4098.55 rad/s" in said


@pytest.mark.parametrize("screen", OVER_SPEEDS, ids=lambda screen: screen.name)
def test_top_speed_just_below_its_limit(screen):
    work = OpenDocument(SCENE)
    work.put("options.top_speed", "4098 rad/s")
    assert work.solve(screen)


@pytest.mark.parametrize("points", ["100000000", "2001", "1", "2.5"])
def test_positions_of_a_stroke(points):
    with pytest.raises(ValueError, match=rf"run\.points = {re.escape(points)}: "):
        CALIPER.read(tomllib.loads(f'caliper = "eebrake"\nrun.points = {points}'), "file")


def test_bounds_of_positions_stand_in_the_help():
    (points,) = [entry for entry in CALIPER.inputs({"caliper": "eebrake"}) if entry.path == "run.points"]
    assert points.help == "positions of the stroke, a whole number, at least 2, at most 2000"


def test_pads_with_too_many_wears():
    with pytest.raises(ValueError, match=r"run\.wear = .*: give at most 100 values"):
        CALIPER.read({"caliper": "eebrake", "run": {"wear": ["1 mm"] * 101}}, "file")


TWO = ["face_width=10:20:1000 mm", "force=1:2:1000 kN"]


def test_cases_of_two_inputs_at_once():
    tables = tomllib.loads((ROOT / "examples/drum.toml").read_text())
    with pytest.raises(ValueError, match=r"--vary = .1000 x 1000 values.: at most 100000 designs are solved"):
        DRUM.sweep(tables, "file", TWO)


def test_cases_one_by_one():
    with pytest.raises(ValueError, match=r"--vary = .2001 values.: at most 2000 designs are solved"):
        CALIPER.sweep({"caliper": "eebrake"}, "file", ["clearance=1:2:2001 mm"])


@pytest.mark.parametrize("screen", OVER_SPEEDS, ids=lambda screen: screen.name)
def test_cases_of_a_screen(screen):
    tables = {"options": {"top_speed": "150 rad/s", "modes": 2}, **tomllib.loads(SCENE.base)}
    with pytest.raises(ValueError, match=r"sweep = .2001 values.: at most 2000 designs are solved"):
        screen.sweeps.run(tables, "mount.radius=1:2:2001 m", screen.sweeps.results)


@pytest.mark.parametrize(
    ("command", "refused"),
    [
        (f"modes {HARVESTER} --modes 101", "--modes"),
        (f"modes {HARVESTER} --modes 1000000 --discretization fem", "--modes"),
        (f"locus {HARVESTER} --modes 101 --speeds 0,50rad/s", "--modes"),
        (f"locus {HARVESTER} --speeds 0:150:10001rad/s", "--speeds"),
        (f"simulate {ROLLING} --t-end 1s --modes 101", "--modes"),
        (f"sweep {ROLLING} --speeds 0,50rad/s --window 0:1s --modes 101", "--modes"),
        (f"sweep {ROLLING} --speeds 0,50rad/s --window 0:1s --workers 129", "--workers"),
        (f"sweep {ROLLING} --speeds 0:50:10001rad/s --window 0:1s", "--speeds"),
        (f"steady {ROLLING} --speeds 0,50rad/s --modes 101", "--modes"),
        (f"steady {ROLLING} --speeds 1:50:10001rad/s", "--speeds"),
        (f"resonances {ROLLING} --top-speed 150rad/s --modes 101", "--modes"),
        (f"resonances {ROLLING} --top-speed 150rad/s --order 6", "--order"),
        (f"tradeoff {ROLLING} --modes 101", "--modes"),
    ],
)
def test_options_of_commands(command, refused, finished, monkeypatch):
    monkeypatch.chdir(ROOT)
    said = finished(beamdyn.cli.main(command.split()), 2).err
    assert said.count("\n") == 1 and refused in said and re.search(r"at most \d+|from 1 to 10000\b", said)


def test_sweep_of_a_command_on_brakes(capsys, monkeypatch):
    monkeypatch.chdir(ROOT)
    options = ["--vary", TWO[0], "--vary", TWO[1]]
    assert brakes.cli.main(["drum", "examples/drum.toml", *options]) == 2
    assert "at most 100000 designs" in capsys.readouterr().err


def test_long_word_of_a_title_is_cut_soon():  # not in a time that grows as the square of its length
    (line,) = heading("x" * 40_000, 400.0, 300.0).lines
    assert line.endswith("x…")


@pytest.mark.parametrize("text", ["toggle clamp (Hibbeler 6-80)", '"handle"', '"A"', "C = ["])
def test_texts_that_are_drawn_are_short(text):
    quoted = text.replace(text.strip('" =['), "x" * 201)
    tables = base("mechanism").replace(text, quoted)
    with pytest.raises(ConfigError, match="give at most 200 characters"):
        parse_mechanism(tables)
    parse_mechanism(base("mechanism").replace("toggle clamp (Hibbeler 6-80)", "x" * 200))
