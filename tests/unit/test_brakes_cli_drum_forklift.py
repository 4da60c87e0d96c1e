"""`brakes drum` and `brakes forklift`: exit codes, what is printed, files."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
from pathlib import Path

import pytest

from beamdyn.common.edge.exit_codes import BAD_INPUT, DONE, NO_ANSWER
from brakes.cli import main

ROOT = Path(__file__).parents[2]
DRUM, FORKLIFT = ROOT / "examples" / "drum.toml", ROOT / "examples" / "forklift.toml"


@pytest.fixture
def run(capsys):
    def run(*arguments: object) -> tuple[int, str, str]:
        code = main([str(a) for a in arguments])
        return code, *capsys.readouterr()

    return run


@pytest.fixture
def edited(tmp_path: Path):
    """A copy of a file with a text replaced."""

    def edited(path: Path, old: str, new: str) -> Path:
        text = path.read_text()
        assert old in text
        copy = tmp_path / path.name
        copy.write_text(text.replace(old, new, 1))
        return copy

    return edited


def table(path: Path) -> list[list[str]]:
    """Rows of a CSV file."""
    return [*csv.reader(path.read_text().splitlines())]


def cells(out: str, words: str) -> list[str]:
    """Numbers of the row of a table that begins with words."""
    (line,) = (line for line in out.splitlines() if line.strip().startswith(words + "  "))
    return line.strip().removeprefix(words).split()


# Drum -------------------------------------------------------------------------------------------------


TORQUE = 262.9622041772  # N m, by Shigley's integrals: see tests/literature/test_drum.py


def test_drum_prints_the_corrected_torques(run, edited) -> None:
    """By Shigley's integrals; with the paper's pressure the last row of the facts' corrected table."""
    code, out, err = run("drum", DRUM)
    assert (code, err) == (DONE, "")
    assert cells(out, "torque of the brake")[0] == "262.96"
    assert cells(out, "torque")[:2] == ["176.73", "86.233"]
    assert "shoe 1, leading" in out and "shoe 2, trailing" in out
    code, out, err = run("drum", edited(DRUM, '"pivot"', '"axis"'))
    assert cells(out, "torque of the brake")[0] == "268.29"
    assert cells(out, "torque")[:2] == ["179.05", "89.231"]
    assert cells(out, "effective arm of the friction")[:2] == ["148.72", "148.72"]


def test_a_brake_that_locks_is_an_answer_of_its_own(run, edited) -> None:
    code, out, err = run("drum", edited(DRUM, "friction = 0.35", "friction = 1.2"))
    assert code == NO_ANSWER
    assert "locked: friction 1.2 is at or past self-locking, 0.9988" in err
    assert cells(out, "torque of the brake")[0] == "-"


@pytest.mark.parametrize(
    "old, new, parts",
    [
        ("110 deg", "20 deg", ['lining_end = "20 deg"', "empty"]),
        ("1000 N", "1000 m", ["load.force", "length"]),
        ('force = "1000 N"', 'torque = "0 N m"', ["load.torque", "greater than 0"]),
        ("[shoe]", "[shoo]", ["shoo", "did you mean shoe?", "shoe: missing"]),
    ],
)
def test_bad_drums(run, edited, old: str, new: str, parts: list[str]) -> None:
    code, out, err = run("drum", edited(DRUM, old, new))
    assert (code, out) == (BAD_INPUT, "")
    assert [part for part in ["brakes: ", "drum.toml", *parts] if part not in err] == []


def test_files_of_a_drum(run, tmp_path: Path) -> None:
    plot, sheet, result = tmp_path / "d.png", tmp_path / "d.csv", tmp_path / "d.json"
    assert run("drum", DRUM, "--plot", plot, "--csv", sheet, "--json", result)[0] == DONE
    assert plot.read_bytes().startswith(b"\x89PNG")
    rows = {name: float(value) for name, value, _ in table(sheet)[1:]}
    saved = json.loads(result.read_text())
    assert rows["torque"] == saved["torque"] == pytest.approx(TORQUE, rel=1e-11)
    assert rows["torque_2"] == saved["shoes"][1]["torque"]
    assert rows["peak_pressure"] == pytest.approx(saved["peak_pressure"] / 1e6, rel=1e-15)


def test_a_file_is_not_overwritten_unasked(run, tmp_path: Path) -> None:
    path = tmp_path / "d.json"
    path.write_text("mine")
    code, out, err = run("drum", DRUM, "--json", path)
    assert (code, out, path.read_text()) == (BAD_INPUT, "", "mine") and "--force" in err
    assert run("drum", DRUM, "--json", path, "--force")[0] == DONE


def test_a_picture_of_a_locked_brake(run, edited, tmp_path: Path) -> None:
    locked = edited(DRUM, "friction = 0.35", "friction = 1.2")
    assert run("drum", locked, "--plot", tmp_path / "d.svg")[0] == NO_ANSWER
    assert "<svg" in (tmp_path / "d.svg").read_text()


def test_a_row_of_a_locked_brake_says_why(run) -> None:
    _, out, err = run("drum", DRUM, "--vary", "friction=0.3:1.5:5", "--what", "torque")
    assert "no answer, because" in out and out.count("the shoe grips by itself") == 2
    assert "friction 1.2 is at or past" in out and "friction 1.5 is at or past" in out
    assert "locked in 2 of 5 cases: friction 1.2 to 1.5 is at or past self-locking, 0.9988" in err
    _, out, _ = run("drum", DRUM, "--vary", "friction=0.3:1.5:5", "--what", "margin")
    assert "no answer, because" not in out  # the margin is there


def test_sweep_of_a_drum(run, tmp_path: Path) -> None:
    path, plot = tmp_path / "s.csv", tmp_path / "s.png"
    options = ("--vary", "friction=0.35:1.2:2", "--what", "torque,pin_1", "--csv", path, "--plot", plot)
    code, out, err = run("drum", DRUM, *options)
    assert code == DONE and "locked in 1 of 2 cases" in err
    rows = table(path)
    assert rows[0] == ["friction", "torque_N_m", "pin_1_N", "no_answer"]
    assert float(rows[1][1]) == pytest.approx(TORQUE, rel=1e-11) and rows[2][1] == "nan"
    assert rows[1][3] == "" and rows[2][3].startswith("locked: friction 1.2 is at or past")
    assert plot.exists() and "262.96" in out


@pytest.mark.parametrize(
    "options, part",
    [
        (("--what", "torque"), "--what goes with --vary"),
        (("--vary", "friction=0.1:0.5:3", "--what", "trque"), "did you mean torque"),
        (("--vary", "friction=0.1:0.5:3", "--vary", "brake.friction=0.1:0.5:3"), "given twice"),
        (("--swep", "x"), "--help"),
        (("--sweep", "friction=0.1:0.5:3"), "Did you mean --vary?"),
        (("--vary", "friction=0.1:0.5:3", "--result", "torque"), "Did you mean --what?"),
        (("--together",), "--together goes with --vary"),
        (("--vary", "friction=0.1:0.5:3", "--vary", "load.force=1:2:2 kN", "--together"), "3 and 2 values"),
    ],
)
def test_bad_options(run, options: tuple[str, ...], part: str) -> None:
    code, out, err = run("drum", DRUM, *options)
    assert (code, out) == (BAD_INPUT, "") and part in err


def test_two_sweeps_have_a_row_a_case(run, tmp_path: Path) -> None:
    path = tmp_path / "s.csv"
    sweeps = ("--vary", "friction=0.2:0.4:3", "--vary", "load.force=1:2:2 kN")
    assert run("drum", DRUM, *sweeps, "--csv", path)[0] == DONE
    rows = [[float(x) for x in row[:3]] for row in table(path)[1:]]
    assert [row[:2] for row in rows] == [[mu, P] for mu in (0.2, pytest.approx(0.3), 0.4) for P in (1.0, 2.0)]
    assert rows[3][2] == pytest.approx(2 * rows[2][2], rel=1e-13)  # torque grows with the force


def test_workers_and_a_store_change_no_bit(run, tmp_path: Path) -> None:
    asked = ("caliper", "dual-pivot", "--vary", "finger=10:40:20 N", "--what", "right_pad_force")
    alone, shared, resumed = (tmp_path / f"{name}.csv" for name in ("alone", "shared", "resumed"))
    store = ("--store", tmp_path / "store")
    assert run(*asked, "--csv", alone)[0] == DONE
    assert run(*asked, "--csv", shared, "--workers", "2", *store)[0] == DONE
    assert run(*asked, "--csv", resumed, *store)[0] == DONE
    assert len([*(tmp_path / "store").iterdir()]) == 3  # two parts, and what tells that it is a store
    assert alone.read_text() == shared.read_text() == resumed.read_text()


def test_values_taken_together(run, tmp_path: Path) -> None:
    path = tmp_path / "s.csv"
    inputs = ("--vary", "friction=0.2:0.4:3", "--vary", "load.force=1:3:3 kN", "--together")
    assert run("drum", DRUM, *inputs, "--csv", path)[0] == DONE
    rows = [[float(x) for x in row[:2]] for row in table(path)[1:]]
    assert rows == [[0.2, 1.0], [pytest.approx(0.3), 2.0], [0.4, 3.0]]


# Forklift -----------------------------------------------------------------------------------------------


def test_forklift_prints_all_stages(run) -> None:
    code, out, err = run("forklift", FORKLIFT)
    assert code == DONE
    assert cells(out, "stopping distance, from the driver's reaction")[0] == "13.425"
    assert cells(out, "stage 1: turn of each shoe")[0] == "5.2317"
    assert cells(out, "stage 2: turn of drum and shoes")[0] == "9.7083"
    assert "23 of 23" in out and "the torque is from the stop" in out
    assert err.count("enters the drum by 1.55 mm near 26 deg") == 1


def test_the_papers_own_mechanics_is_not_an_option(run, edited) -> None:
    code, out, err = run("forklift", FORKLIFT, "--model", "as_printed")
    assert (code, out) == (BAD_INPUT, "") and "--model" in err
    code, out, err = run(
        "forklift", edited(FORKLIFT, "friction = 0.7", 'friction = 0.7\nmodel = "corrected"')
    )
    assert (code, out) == (BAD_INPUT, "") and "stop.model: unknown key" in err


@pytest.mark.parametrize("stage, there, absent", [
    ("vehicle", "Vehicle", "Kinematics"),
    ("kinematics", "Kinematics", "Vehicle"),
    ("forces", "Forces in one brake", "Kinematics"),
])  # fmt: skip
def test_a_stage_alone(run, stage: str, there: str, absent: str) -> None:
    code, out, _ = run("forklift", FORKLIFT, "--stage", stage)
    assert code == DONE and there in out and absent not in out


def test_a_truck_that_does_not_stop_is_an_answer(run, edited) -> None:
    code, out, err = run("forklift", edited(FORKLIFT, "3500 kg", "0 kg"))
    assert code == NO_ANSWER and "never stops" in err
    assert cells(out, "acceleration, wheels locked")[0] == "0.6393"
    assert "Forces in one brake" in out  # those of locked wheels


def test_a_truck_may_drive_forwards(run, edited, tmp_path: Path) -> None:
    file = edited(FORKLIFT, 'direction = "reverse"', 'direction = "forward"')
    assert run("forklift", file)[0] == BAD_INPUT  # the load pulls it over its front axle
    file.write_text(file.read_text().replace('"3500 kg"', '"0 kg"'))
    assert run("forklift", file, "--plot", tmp_path / "forward.svg")[0] == DONE


def test_a_duo_servo_brake_that_locks_is_an_answer(run, tmp_path: Path) -> None:
    text = FORKLIFT.read_text()
    path = tmp_path / "brake.toml"
    path.write_text(text[text.index("[brake]") :].replace('"11650 N"', '"11650 N"\nlining_friction = 1.3'))
    code, _, err = run("forklift", path)
    assert code == NO_ANSWER and "locked" in err


@pytest.mark.parametrize(
    "old, new, parts",
    [
        ("0.3019 rad", "70 deg", ['stop.slope = "70 deg"', "at most 45 deg"]),
        ('"reverse"', '"forward"', ["stop.slope", "overturns"]),
        ("10.6 mm", "200 mm", ['brake.clearance = "200 mm"', "larger than the drum allows"]),
        ('"-1.20 m"', '"-3 m"', ["ahead of the front wheel"]),
        ('"20 km/h"', '"20 kg"', ["stop.speed", "mass", "velocity"]),
    ],
)
def test_bad_forklifts(run, edited, old: str, new: str, parts: list[str]) -> None:
    code, out, err = run("forklift", edited(FORKLIFT, old, new))
    assert (code, out) == (BAD_INPUT, "")
    assert [part for part in parts if part not in err] == []


def test_files_of_a_forklift(run, tmp_path: Path) -> None:
    plot, sheet, result = tmp_path / "f.svg", tmp_path / "f.csv", tmp_path / "f.json"
    files = ("--plot", plot, "--csv", sheet, "--json", result)
    assert run("forklift", FORKLIFT, *files)[0] == DONE
    assert "<svg" in plot.read_text()
    rows = {name: float(value) for name, value, _ in table(sheet)[1:]}
    saved = json.loads(result.read_text())
    assert rows["distance"] == saved["stop"]["distance"] and rows["A"] == saved["forces"]["A"]
    stage = saved["kinematics"]["drum"]
    assert len(stage["travel"]["left"]) == len(stage["rank"]) == 21
    assert "mm out" in saved["kinematics"]["events"][0]["message"]


def test_sweep_of_a_forklift(run, tmp_path: Path) -> None:
    path = tmp_path / "s.csv"
    options = ("--vary", "load_mass=0:3500:3 kg", "--what", "distance", "--csv", path)
    code, out, err = run("forklift", FORKLIFT, "--stage", "vehicle", *options)
    assert code == DONE and "1 of 3 cases do not stop" in err and "never" in out
    distances = [float(row[1]) for row in table(path)[1:]]
    assert distances[0] == float("inf") and distances[2] == pytest.approx(13.425, abs=5e-4)


def test_help_names_the_exit_codes(run) -> None:
    code, out, _ = run("--help")
    assert code == DONE and "Exit codes" in out
    for command in ("drum", "forklift", "reproduce"):
        assert command in out


def test_the_command_line_loads_nothing_heavy() -> None:
    code = "import brakes.cli, sys; print(*{name.partition('.')[0] for name in sys.modules})"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60, check=True
    )
    assert not {"numpy", "scipy", "matplotlib", "pydantic", "pint"} & set(done.stdout.split())
