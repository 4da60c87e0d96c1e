"""Commands about motion in time and resonance: tables, files, messages."""

import csv
import json
import os
import re
import signal
import subprocess
import sys
import time
from functools import partial
from importlib.util import find_spec
from pathlib import Path

import meshio
import numpy as np
import pytest

from beamdyn import load_scene
from beamdyn.analyses.about_motion import Interrupted, _progress
from beamdyn.analyses.results.of_motion import peaks
from beamdyn.analyses.values import parse_window
from beamdyn.cli import BAD_INPUT, DONE, INTERRUPTED, NO_ANSWER
from tests.unit.toml_scenes import without_camber

ROOT = Path(__file__).parents[2]
SCENE = str(ROOT / "examples" / "rolling_harvester.toml")
STILL = str(ROOT / "examples" / "tyre_harvester.toml")
BLADE = str(ROOT / "examples" / "blade.toml")
QUICK = ("--t-end", "0.5 s", "--modes", "2")
OF_SWEEP = "--speeds", "50, 55 rad/s", "--window", "0.1:0.2 s", "--modes", "1"
SWEEP = ("sweep", SCENE, *OF_SWEEP)


@pytest.fixture
def edited(tmp_path):
    """A copy of the scene in which texts are replaced."""

    def edited(**replaced):
        text = Path(SCENE).read_text()
        for line in replaced.values():
            key = line.partition(" =")[0]
            text, count = re.subn(rf"^{key} = .*$", line, text, flags=re.MULTILINE)
            assert count
        path = tmp_path / "edited.toml"
        path.write_text(text)
        return path

    return edited


def read_csv(path):
    return list(csv.DictReader(path.read_text().splitlines()))


def test_modes_are_those_at_the_final_speed_of_the_motion(run):
    assert "at 55 rad/s" in run("modes", SCENE)[1]


# simulate -----------------------------------------------------------------------------------------


def test_simulate_prints_table_3(run, tmp_path):
    scene = without_camber(SCENE, tmp_path)
    code, out, err = run("simulate", scene, "--t-end", "30 s", "--window", "20:30 s")
    assert (code, err) == (DONE, "")
    for part in ("1.9425", "29.65", "2.0731", "8.67", "steps", "20 to 30 s", "time-integration error"):
        assert part in out
    assert "warning" not in out


def test_digits_that_the_modes_left_out_spoil_are_not_printed(run):
    out = run("simulate", SCENE, "--t-end", "30 s", "--window", "20:30 s", "--modes", "5")[1]
    assert "1.9 " in out and "1.94" not in out and "modal truncation error 0.006 mm" in out


def test_simulate_writes_files(run, tmp_path, monkeypatch):
    monkeypatch.setattr("beamdyn.analyses.about_motion._FRAMES", 7)
    names = ("j.json", "c.csv", "p.png", "s.xdmf", "a.gif")
    j, c, p, s, a = (tmp_path / name for name in names)
    files = ("--json", j, "--csv", c, "--plot", p, "--series", s, "--animation", a)
    assert run("simulate", SCENE, *QUICK, *files)[0] == DONE
    written, rows = json.loads(j.read_text()), read_csv(c)
    tips = [float(row["tip_deflection_mm"]) for row in rows]  # in the unit of the file
    assert tips == [1e3 * tip for tip in written["tip"]]
    assert rows[0]["time_s"] == "0.0" and written["t"][-1] == 0.5
    assert p.read_bytes().startswith(b"\x89PNG") and a.read_bytes().startswith(b"GIF89a")
    assert meshio.xdmf.TimeSeriesReader(s).num_steps == 7


@pytest.mark.parametrize(
    "options",
    [
        ("--method", "DOP853"),
        pytest.param(("--discretization", "fem"), marks=pytest.mark.slow),
        pytest.param(("--method", "Radau"), marks=pytest.mark.slow),
    ],
)
def test_other_integrators_and_elements_agree(run, options):
    ours, other = (run("simulate", SCENE, *QUICK, *o)[1] for o in ((), options))
    values = [float(re.search(r"whole run +(\S+)", out)[1]) for out in (ours, other)]
    assert values[0] == pytest.approx(values[1], rel=2e-3)
    assert ("not estimated" in other) == ("--method" in options)


@pytest.mark.slow
def test_outside_linear_theory_is_said_as_by_other_commands(run, edited):
    scene = edited(amplitude='velocity_amplitude = "10 m/s"', duration='duration = "0.2 s"')
    code, out, err = run("simulate", scene, *QUICK)
    assert code == DONE
    assert "warning" not in out
    assert "outside linear theory" in err and "leaves the road" in err


# resonances, steady -------------------------------------------------------------------------------


def test_resonances(run, tmp_path):
    j, c, p = (tmp_path / name for name in ("r.json", "r.csv", "r.svg"))
    code, out, err = run(
        "resonances", without_camber(SCENE, tmp_path), "--top-speed", "150 rad/s",
        "--json", j, "--csv", c, "--plot", p,
    )  # fmt: skip
    assert (code, err) == (DONE, "")
    for part in ("53.08584183", "69.80240337", "forced", "92.044267", "parametric"):
        assert part in out
    speeds = [float(row["speed_rad_per_s"]) for row in read_csv(c)]
    assert speeds == [crossing["speed"] for crossing in json.loads(j.read_text())["crossings"]]
    assert "<svg" in p.read_text()


def test_no_resonance_is_an_answer(run):
    code, out, _ = run("resonances", STILL, "--top-speed", "100 rad/s")
    assert code == DONE and "No resonance speeds" in out


def test_resonances_say_where_the_search_ended(run):
    assert "159.818" in run("resonances", SCENE, "--top-speed", "200 rad/s")[2]


def test_steady(run, tmp_path):
    c, p = tmp_path / "s.csv", tmp_path / "s.png"
    code, out, _ = run("steady", SCENE, "--speeds", "50:60:101 rad/s", "--csv", c, "--plot", p)
    assert code == DONE
    assert re.search(r"53\.1 .*stable, peak", out) and "of 101 speeds" in out
    at_55 = next(row for row in read_csv(c) if abs(float(row["speed_rad_per_s"]) - 55) < 1e-9)
    assert float(at_55["amplitude_mm"]) == pytest.approx(0.2619, rel=1e-3)
    assert p.read_bytes().startswith(b"\x89PNG")


def test_inside_a_tongue_there_is_no_steady_response(run):
    code, out, err = run("steady", SCENE, "--speeds", "111.3564 rad/s")
    assert code == NO_ANSWER
    assert "parametric instability" in out and "no answer" in err


# sweep --------------------------------------------------------------------------------------------


def test_sweep_is_stored_and_resumed(run, tmp_path):
    store, c, p = tmp_path / "store", tmp_path / "s.csv", tmp_path / "s.png"
    sweep = "sweep", without_camber(SCENE, tmp_path), *OF_SWEEP
    code, out, err = run(*sweep, "--store", store, "--csv", c, "--plot", p)
    assert (code, err) == (DONE, "")
    assert "0.1 to 0.2 s" in out
    assert [float(row["speed_rad_per_s"]) for row in read_csv(c)] == [50.0, 55.0]
    stored = {path.name: path.stat().st_mtime_ns for path in store.iterdir() if path.name != "store.json"}
    assert stored
    assert run(*sweep, "--store", store)[1] == out
    assert stored.items() <= {path.name: path.stat().st_mtime_ns for path in store.iterdir()}.items()
    assert p.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("ending", "workers"),
    [(signal.SIGINT, 1), pytest.param(signal.SIGTERM, 1, marks=pytest.mark.slow), (signal.SIGTERM, 2)],
)
def test_interrupted_sweep_says_how_to_go_on(tmp_path, ending, workers):
    store = tmp_path / "store"
    speeds = ("--speeds", "0:150:1501 rad/s", "--window", "0.1:0.3 s", "--modes", "2")  # many short chunks
    command = [sys.executable, "-m", "beamdyn", "sweep", SCENE, *speeds, "--store", str(store)]
    command += ["--workers", str(workers)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    heed = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)  # in the background, too
    with subprocess.Popen(
        command, env=environment, stderr=subprocess.PIPE, text=True, preexec_fn=heed
    ) as process:
        deadline = time.monotonic() + 60
        while len(list(store.glob("*.json"))) < 2 and time.monotonic() < deadline:
            time.sleep(0.01)
        process.send_signal(ending)
        err = process.communicate(timeout=60)[1]
    assert process.returncode == INTERRUPTED
    assert "of 1501 speeds are stored in" in err and "the same command goes on" in err
    assert "Traceback" not in err


def test_without_a_store_nothing_is_kept():
    with (
        pytest.raises(Interrupted, match="3 of 9 speeds were done and are lost; --store"),
        _progress(9, None) as show,
    ):
        show(3, 9)
        raise KeyboardInterrupt


def test_ctrl_c_anywhere_is_no_traceback(run, monkeypatch):
    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("beamdyn.files.scenes.scene_from_dict", interrupt)
    code, out, err = run("modes", SCENE)
    assert (code, out, err) == (INTERRUPTED, "", "beamdyn: interrupted\n")


def test_a_run_that_does_not_fit_into_memory_is_no_traceback(run, monkeypatch):
    def fill(*_, **__):
        raise MemoryError("Unable to allocate 875 GiB")

    monkeypatch.setattr("beamdyn.transient.simulate.simulate", fill)
    code, out, err = run("simulate", SCENE, *QUICK)
    assert (code, out) == (BAD_INPUT, "")
    assert "not enough memory" in err and "shorter" in err


def test_a_beam_that_stays_at_rest_has_no_time_of_its_peak(run):
    assert re.search(r"whole run +0 +0 +-", run("simulate", BLADE, "--t-end", "0.1 s")[1])


# Bad input ----------------------------------------------------------------------------------------

BAD = {
    "no motion": (("simulate", STILL, *QUICK), ("motion: missing", "[motion]")),
    "end of 0": (("simulate", SCENE, "--t-end", "0 s"), ("--t-end", "greater than 0")),
    "negative end": (("simulate", SCENE, "--t-end", "-1 s"), ("--t-end", '"-1 s"', "greater than 0")),
    "bare end": (("simulate", SCENE, "--t-end", "30"), ("--t-end", '"30"', "30 s")),
    "no end": (("simulate", SCENE), ("--t-end",)),
    "too many steps": (
        ("simulate", SCENE, "--t-end", "1e9 s"),
        ("--t-end = 1e+09 s", "e+11 steps", "memory"),
    ),
    "too many steps of a sweep": (
        ("sweep", SCENE, "--speeds", "50 rad/s", "--window", "1:1e9 s"),
        ("--window = 1e+09 s", "e+11 steps", "memory"),
    ),
    "late window": (
        ("simulate", SCENE, *QUICK, "--window", "0.4:0.6 s"),
        ("--window", "0.5 s", "longer --t-end"),
    ),
    "early window": (
        ("simulate", SCENE, *QUICK, "--window", "-1:0.6 s"),
        ("--window", "-1:0.6 s", "0 or later"),
    ),
    "empty window": (
        ("simulate", SCENE, *QUICK, "--window", "0.3:0.3 s"),
        ("--window", "end after its start"),
    ),
    "one-sided window": (("simulate", SCENE, *QUICK, "--window", "0.3 s"), ("--window", "start:end")),
    "bare window": (("simulate", SCENE, *QUICK, "--window", "0.3:0.4"), ("--window", "unit")),
    "window of speeds": (("simulate", SCENE, *QUICK, "--window", "1:2 rpm"), ("--window", "time")),
    "tolerance": (("simulate", SCENE, *QUICK, "--tolerance", "0"), ("tolerance", "from 1e-12")),
    "no modes": (("simulate", SCENE, "--t-end", "1 s", "--modes", "0"), ("modes = 0", "1 or more")),
    "integrator": (("simulate", SCENE, *QUICK, "--method", "Euler"), ("--method", "Euler", "Radau")),
    "series suffix": (("simulate", SCENE, *QUICK, "--series", "x.vtu"), ("--series", ".xdmf")),
    "animation suffix": (("simulate", SCENE, *QUICK, "--animation", "x.mp4"), ("--animation", ".gif")),
    "no top speed": (("resonances", SCENE, "--top-speed", "0 rad/s"), ("--top-speed", "greater than 0")),
    "order": (("resonances", SCENE, "--top-speed", "9 rad/s", "--order", "0"), ("order = 0", "from 1 to 20")),
    "bare speeds": (("steady", SCENE, "--speeds", "1:2:3"), ("1:2:3", "unit")),
    "sweep without motion": (("sweep", STILL, *SWEEP[2:]), ("motion: missing", "[motion]")),
    "no workers": ((*SWEEP, "--workers", "0"), ("workers = 0", "1 or more")),
    "foreign store": ((*SWEEP, "--store", str(ROOT)), ("store", "something other than a beamdyn sweep")),
    "file as store": ((*SWEEP, "--store", SCENE), ("store", "is a file")),
    "no scheduler": (
        (*SWEEP, "--scheduler", "nowhere"),
        ("--scheduler", "nowhere" if find_spec("distributed") else "beamdyn[dask]"),
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input(run, case, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    arguments, parts = BAD[case]
    code, out, err = run(*arguments)
    assert (code, out) == (BAD_INPUT, "")
    assert err.startswith("beamdyn: ") and err.count("\n") == 1
    for part in parts:
        assert part in err
    assert not list(tmp_path.iterdir())


def test_a_motion_past_the_critical_speed_has_no_answer(run, edited):
    scene = edited(speed='speed = "170 rad/s"')
    code, out, err = run("simulate", scene, "--t-end", "10 s")
    assert (code, out) == (NO_ANSWER, "")
    assert "159.818" in err and "critical" in err


def test_a_sweep_past_the_critical_speed_has_no_answer(run):
    code, out, err = run("sweep", SCENE, "--speeds", "150, 170 rad/s", "--window", "9:10 s")
    assert (code, out) == (NO_ANSWER, "")
    assert all(part in err for part in ("1 of 2", "170 rad/s", "159.818"))


def test_a_table_of_speeds_that_ends_early_is_refused(run, tmp_path):
    text = Path(SCENE).read_text()
    i, j = text.index("[motion.rotation]"), text.index("[motion.road]")
    table = '[motion.rotation]\nkind = "sampled"\ntimes = ["0 s", "1 s"]\nspeeds = ["0 rad/s", "9 rad/s"]\n\n'
    path = tmp_path / "sampled.toml"
    path.write_text(text[:i] + table + text[j:])
    code, out, err = run("simulate", path, "--t-end", "2 s", "--modes", "2")
    assert (code, out) == (BAD_INPUT, "")
    assert "1 s" in err
    assert run("simulate", path, "--t-end", "1 s", "--modes", "2")[0] == DONE


@pytest.mark.parametrize(
    ("text", "window"),
    [("20:30 s", (20, 30)), ("0 : 1.5min", (0, 90)), ("1e-1:2e-1 s", (0.1, 0.2)), ("20:30 ms", (0.02, 0.03))],
)
def test_window(text, window):
    assert parse_window(text) == pytest.approx(window)


def test_peaks_stand_out():
    speeds = np.linspace(0, 10, 101)
    values = np.exp(-((speeds - 3) ** 2)) + 0.5 * np.exp(-((speeds - 7) ** 2)) + 0.01 * np.cos(20 * speeds)
    values[90] = np.nan
    np.testing.assert_allclose(speeds[peaks(values, 0.2)], [3, 7], atol=0.2)


def test_scene_of_the_tests_is_that_of_the_paper():
    assert load_scene(SCENE).motion.final_speed == 55.0
