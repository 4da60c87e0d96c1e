"""The command `beamdyn loads`: three analyses, their files, options that do not go together."""

from __future__ import annotations

import csv
import json
import re
import shlex
from pathlib import Path

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.cli import BAD_INPUT, DONE, NO_ANSWER, main

EXAMPLES = Path(__file__).parents[2] / "examples"
ROLLING, PATCHED = str(EXAMPLES / "rolling_harvester.toml"), str(EXAMPLES / "patched.toml")


@pytest.fixture
def run(capsys):
    def called(*arguments):
        code = main(["loads", *map(str, arguments)])
        out, err = capsys.readouterr()
        return code, out, err

    return called


def test_equilibrium_is_printed_and_written(run, tmp_path):
    files = [tmp_path / f"loads.{kind}" for kind in ("json", "csv", "png")]
    code, out, _ = run(
        PATCHED, "--speed", "50 rad/s", "--json", files[0], "--csv", files[1], "--plot", files[2]
    )
    assert code == DONE
    expected = bd.static_loads(bd.load_scene(PATCHED), 50.0)
    assert "24-" in out and "24+" in out  # both sides of the patch's end
    assert f"{expected.moment[0, 0, 0]:.6g}"[:7] in out
    back = bd.load(files[0])
    assert back.moment == pytest.approx(expected.moment, rel=1e-12)
    assert json.loads(files[0].read_text())["moment_error"]
    rows = [*csv.DictReader(files[1].read_text().splitlines())]
    assert len(rows) == len(expected.x)
    assert float(rows[0]["moment_N_m"]) == expected.moment[0, 0, 0]
    assert float(rows[0]["error_of_moment_N_m"]) == expected.moment_error[0, 0, 0]
    assert files[2].stat().st_size > 1000


def test_loads_without_strains_say_what_these_need(run, tmp_path):
    """The section of a beam by its stiffness has no points."""
    (tmp_path / "blade.toml").write_text(
        '[beam]\nlength = "20 m"\nmass_per_length = "100 kg/m"\nbending_stiffness = "1e8 N m2"\n'
        '[mount]\nradius = "1 m"\nsetting_angle = "180 deg"\n'
    )
    code, out, _ = run(tmp_path / "blade.toml", "--speed", "30 rpm", "--at", "0 m")
    said = "No strains: give the beam an outer_fibre, or points of the section."
    assert code == DONE and said in " ".join(out.split())
    assert "No strains" not in run(PATCHED, "--speed", "50 rad/s")[1]


def test_transient_within_a_window_with_cycles(run):
    pytest.importorskip("rainflow", reason="cycle counts are the extra fatigue")
    options = ("--t-end", "0.3 s", "--modes", "2", "--window", "0.1:0.3 s", "--at", "0, 20 mm")
    code, out, _ = run(ROLLING, *options, "--cycles", "strain")
    assert code == DONE
    transient = bd.transient_loads(bd.simulate(bd.load_scene(ROLLING), 0.3, 2), at=[0.0, 0.02])
    largest = transient.largest("moment", start=0.1, end=0.3)
    assert f"at {largest.case:.6g} s" in out
    assert "Cycles of strain at 0 mm, 0.1 to 0.3 s" in out


def test_cycles_without_the_package_that_counts_are_refused_at_once(run, monkeypatch):
    monkeypatch.setattr("beamdyn.analyses.about_loads.find_spec", lambda name: None)
    code, _, err = run(ROLLING, "--t-end", "1e9 s", "--cycles", "strain")
    assert code == BAD_INPUT
    assert "beamdyn[fatigue]" in err


@pytest.mark.parametrize("how", [("--t-end", "0.2 s"), ("--speeds", "1:9:3 rad/s")])
@pytest.mark.parametrize(
    ("example", "options", "said"),
    [
        ("harvester_oblique.toml", (), "loads along the span of a beam with large deflection"),
        ("rolling_harvester.toml", ("--at", "1 m"), "--at = "),
    ],
)
def test_what_loads_cannot_have_is_refused_before_the_motion_is_computed(
    run, monkeypatch, example, options, said, how
):
    for long in ("simulate", "steady_response"):
        monkeypatch.setattr(bd, long, lambda *_, **__: pytest.fail("computed in vain"))
    code, _, err = run(EXAMPLES / example, *how, *options)
    assert code == BAD_INPUT and said in err


def test_steady_response_over_speed(run, tmp_path):
    path = tmp_path / "steady.csv"
    code, out, _ = run(
        ROLLING, "--speeds", "30, 40 rad/s", "--modes", "2", "--points", "-0.1:0, 0.05:1 mm", "--at", "0 mm",
        "--csv", path,
    )  # fmt: skip
    assert code == DONE
    assert "where the bending moment is largest" in out
    rows = [*csv.DictReader(path.read_text().splitlines())]
    assert [float(row["speed_rad_per_s"]) for row in rows] == [30.0, 40.0]
    assert np.isfinite([float(row["strain_2"]) for row in rows]).all()


@pytest.mark.parametrize(
    ("options", "code", "said"),
    [
        (("--speed", "5 rad/s", "--t-end", "1 s"), BAD_INPUT, "give one of them"),
        (("--cycles", "strain"), BAD_INPUT, "--cycles belongs to a transient"),
        (("--speeds", "5 rad/s", "--angle", "90 deg"), BAD_INPUT, "--angle belongs to the equilibrium"),
        (("--at", "80 mm"), BAD_INPUT, "stations must lie from the root"),
        (("--at", "10"), BAD_INPUT, "one unit at their end"),
        (("--points", "0.3:0 mm"), BAD_INPUT, "--points = 0.3 mm: it lies outside the section"),
        (("--points", "0.3 mm"), BAD_INPUT, "-0.1:0, 0.1:0 mm"),
        (("--speed", "500 rad/s"), NO_ANSWER, "no stable equilibrium at 500 rad/s"),
        (("--speeds", "500 rad/s", "--modes", "2"), NO_ANSWER, "no steady response at this speed"),
    ],
)
def test_mistakes(run, options, code, said):
    found, _, err = run(ROLLING, *options)
    assert found == code
    assert said in " ".join(err.split())


def test_stresses_of_a_beam_of_stiffnesses(run, tmp_path):
    options = ("--speed", "1 rad/s", "--points", "1:0 mm", "--json", to := tmp_path / "loads.json")
    assert run(beam := EXAMPLES / "bir.toml", *options, "--youngs-modulus", "70 GPa")[0] == DONE
    loads = bd.load(to)
    np.testing.assert_allclose(loads.stress, 70e9 * loads.strain, rtol=1e-14)
    assert run(beam, "--youngs-modulus", "-70 GPa")[0] == BAD_INPUT


@pytest.mark.slow
def test_the_largest_strain_on_a_rough_road_as_the_page_prints_it(monkeypatch, finished):
    page = (EXAMPLES.parent / "docs" / "loads.md").read_text(encoding="utf-8")
    command, printed = re.findall(
        r"^## On a rough road.*?^```sh\n(.*?)^```.*?^```text\n(.*?)^```", page, re.DOTALL | re.MULTILINE
    )[0]
    monkeypatch.chdir(EXAMPLES.parent)
    out = [line.rstrip() for line in finished(main(shlex.split(command)[1:]), DONE).out.splitlines()]
    assert out == printed.splitlines()


def test_random_loads_by_too_few_modes_say_so(tmp_path, finished):
    """The first mode alone, above whose resonance the input begins: no digit of its loads is sure."""
    (tmp_path / "psd.csv").write_text("f [Hz], psd [m2/s4/Hz]\n400, 1e9\n700, 1e9\n")
    options = ("--psd", str(tmp_path / "psd.csv"), "--speed", "50 rad/s", "--at", "0 mm", "--modes", "1")
    out, err = finished(main(["random-loads", str(EXAMPLES / "harvester_on_road.toml"), *options]), DONE)
    assert "0 ± " in out and "with 1 mode the estimated error of the bending moment is" in err


def test_random_loads_are_written(tmp_path, capsys, finished):
    files = [tmp_path / f"random.{kind}" for kind in ("json", "csv", "png")]
    options = ["--road", "B", "--velocity", "60 km/h", "--highest", "10 1/m", "--at", "0, 50 mm"]
    named = [
        word
        for kind, file in zip(("json", "csv", "plot"), files, strict=True)
        for word in (f"--{kind}", file)
    ]
    scene = str(EXAMPLES / "harvester_on_road.toml")
    assert main([*map(str, ["random-loads", scene, *options, "--modes", "2", *named])]) == DONE
    back = bd.load(files[0])
    rows = [*csv.DictReader(files[1].read_text().splitlines())]
    assert float(rows[1]["rms_moment_N_m"]) == back.rms("moment")[1, 0]
    assert float(rows[0]["largest_strain_1"]) == back.strain[0, 0, 0]
    assert files[2].stat().st_size > 10_000
    capsys.readouterr()
    assert (
        "--at = 1 m" in finished(main(["random-loads", scene, "--road", "B", "--at", "1 m"]), BAD_INPUT).err
    )
    assert "--psd, --road, --roughness: give one" in finished(main(["random-loads", scene]), BAD_INPUT).err


@pytest.mark.parametrize(
    "example, needing", [("iea_15_blade", "prebend and matrices"), ("swept_blade", "sweep")]
)
def test_loads_of_a_beam_that_needs_large_deflection_say_what_needs_it(example, needing, finished):
    said = finished(main(["loads", str(EXAMPLES / f"{example}.toml"), "--speed", "5 rpm"]), BAD_INPUT).err
    assert "[physics] large_deflection = true: " in said
    assert f"leave large_deflection out, and describe the beam without {needing}\n" in said


def test_an_angle_that_may_be_in_degrees_is_written_with_the_unit_in_a_file(tmp_path, finished):
    text = (EXAMPLES / "swept_blade.toml").read_text()
    (tmp_path / "blade.toml").write_text(re.sub("(?m)^sweep = .*", 'sweep = "400 rad"', text))
    said = finished(main(["loads", str(tmp_path / "blade.toml"), "--speed", "5 rpm"]), BAD_INPUT).err
    assert "is it in degrees? give it the unit deg" in said and "math.radians" not in said


@pytest.mark.parametrize(
    "line, said", [('twist = "1000 deg"', "twist reaches"), ('setting_angle = "4 rad"', "setting_angle =")]
)
def test_a_large_angle_in_a_file_is_warned_of_in_degrees(line, said, tmp_path, finished):
    key = line.partition(" ")[0]
    text = (EXAMPLES / "tyre_harvester.toml").read_text()
    text = (
        re.sub("(?m)^setting_angle = .*", line, text)
        if key in text
        else text.replace("[beam]", f"[beam]\n{line}")
    )
    (tmp_path / "scene.toml").write_text(text)
    warned = finished(main(["draw", str(tmp_path / "scene.toml")]), 0).err
    assert f"{said} {1000 if key == 'twist' else 229.2} deg, more than half a turn" in warned
    assert "rad" not in warned
