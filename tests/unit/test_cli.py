"""The command line: exit codes, messages, files."""

import csv
import json
import subprocess
import sys
from pathlib import Path

import meshio
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beamdyn.analyses.values import parse_speeds
from beamdyn.cli import BAD_INPUT, DONE, NO_ANSWER
from beamdyn.common.words import lower_bound, supported, supported_or_range, upper_bound
from tests.unit.toml_scenes import without_camber

ROOT = Path(__file__).parents[2]
SCENE = str(ROOT / "examples" / "tyre_harvester.toml")
BLADE = str(ROOT / "examples" / "blade.toml")


def test_modes_prints_the_published_frequency_without_noise(run, tmp_path):
    code, out, err = run("modes", without_camber(SCENE, tmp_path), "--speed", "50 rad/s")
    assert (code, err) == (DONE, "")
    assert "61.96301891" in out and "stable" in out


def test_speed_comes_from_the_motion_if_not_given(run):
    assert "at 1500 rpm" in run("modes", BLADE)[1]  # in the unit of the file
    assert "at 0 rad/s" in run("modes", SCENE)[1]


def test_negative_speed_is_the_same_as_positive(run):
    assert "61.96301891" in run("modes", SCENE, "--speed", "-50 rad/s")[1]


def test_fem_prints_fewer_digits_than_ritz(run):
    out = run("modes", SCENE, "--discretization", "fem", "--modes", "1")[1]
    assert "65.230456" in out and "65.2304564" not in out


def test_unstable_has_no_answer_and_says_which_mode_and_where(run):
    code, out, err = run("modes", SCENE, "--speed", "170 rad/s")
    assert code == NO_ANSWER
    assert "divergence" in out
    for part in ("170 rad/s", "mode 1", "divergence", "159.818"):
        assert part in err


def test_a_speed_beyond_any_beam_is_refused(run):
    code, _, err = run("modes", SCENE, "--speed", "1e300 rad/s")
    assert code == BAD_INPUT and "speed" in err and "at most" in err


def test_locus_past_the_critical_speed_is_an_answer(run):
    code, out, err = run("locus", SCENE, "--speeds", "0:200:301 rad/s", "--modes", "2")
    assert code == DONE
    assert "of 301 speeds" in out and "divergence, +309" in out
    assert "unstable at 160 rad/s" in err


def test_critical(run):
    assert "159.818332659 rad/s" in run("critical", SCENE)[1]
    assert "no critical speed" in run("critical", BLADE)[1]


@pytest.mark.slow
def test_critical_says_why_there_is_none_or_how_far_it_was_looked(run, tmp_path):
    assert "no critical speed: the rotation stiffens the beam" in run("critical", BLADE)[1]
    scene = tmp_path / "inboard.toml"
    body = '[beam.tip]\nmass = "1 g"\noffset = "-0.000001 mm"\n\n[mount]'
    text = Path(SCENE).read_text().replace("[mount]", body)
    scene.write_text(text.replace('radius = "215 mm"', 'radius = "0 mm"'))
    code, out, err = run("critical", scene)
    assert code == NO_ANSWER
    assert "no critical speed found; there is certainly none below" in out
    assert "a critical speed exists (the rotation topples the tip body" in err


def test_limits(run):
    code, out, err = run("limits", SCENE, "--top-speed", "400 rad/s")
    assert code == DONE
    assert "88.35984" in out and "88.5342" in out
    assert "linear theory" in err


def test_no_limits_is_no_answer(run):
    code, _, err = run("limits", BLADE, "--top-speed", "100 rad/s")
    assert code == NO_ANSWER and "no first limit" in err


def test_modes_writes_files(run, tmp_path):
    names = {option: tmp_path / f"{option}{suffix}" for option, suffix in FILES.items()}
    code, _, _ = run("modes", SCENE, *(x for o, path in names.items() for x in (f"--{o}", path)))
    assert code == DONE
    written = json.loads(names["json"].read_text())
    assert written["frequency"][0] == pytest.approx(65.23045644, rel=1e-9)
    assert "provenance" in written
    rows = read_csv(names["csv"])
    assert [float(row["frequency_Hz"]) for row in rows] == written["frequency"]
    assert names["plot"].read_bytes().startswith(b"\x89PNG")
    assert len(meshio.read(names["shapes"]).point_data) == 3


def test_modes_of_a_strip_are_written_as_surfaces(run, tmp_path):
    scene = tmp_path / "strip.toml"
    scene.write_text(f"{Path(SCENE).read_text()}\n[physics]\ntorsion = true\ncamber = true\n")
    files = {option: tmp_path / f"{option}{suffix}" for option, suffix in FILES.items()}
    code, out, _ = run("modes", scene, *(x for o, path in files.items() for x in (f"--{o}", path)))
    assert code == DONE and "torsion" in out
    assert [row["kind"] for row in read_csv(files["csv"])] == ["bending", "bending", "torsion"]
    assert json.loads(files["json"].read_text())["kind"] == ["bending", "bending", "torsion"]
    mesh = meshio.read(files["shapes"])
    assert np.ptp(mesh.points, axis=0) == pytest.approx([0.05, 0.01, 0.0])
    assert [name.endswith("torsion") for name in mesh.point_data] == [False, False, True]


FILES = {"json": ".json", "csv": ".csv", "plot": ".png", "shapes": ".vtu"}


def read_csv(path):
    return list(csv.DictReader(path.read_text().splitlines()))


TWISTED = """
[beam]
length = "600 mm"
stations = [
  ["x [mm]", "width [mm]", "thickness [mm]", "twist [deg]"],
  [0, 60, 12, 0],
  [300, 60, 12, 30],
  [600, 40, 8, 40],
]
youngs_modulus = "210 GPa"
density = "7850 kg/m3"
[mount]
radius = "100 mm"
[physics]
planes = 2
"""


def test_two_planes_are_told_apart(run, tmp_path):
    scene, found = tmp_path / "twisted.toml", tmp_path / "found.csv"
    scene.write_text(TWISTED)
    code, out, _ = run("modes", scene, "--modes", "2", "--csv", found)
    assert code == DONE and "share of flap" in out
    shares = [(float(r["share_bending"]), float(r["share_across"])) for r in read_csv(found)]
    assert shares[0][0] > 0.9 and shares[1][1] > 0.5  # flat first, then mainly on edge
    np.testing.assert_allclose(np.sum(shares, axis=1), 1, rtol=1e-12)
    code, _, _ = run("locus", scene, "--speeds", "0, 50 rad/s", "--modes", "2", "--csv", found, "--force")
    assert code == DONE
    at_rest = read_csv(found)[0]
    np.testing.assert_allclose(
        [float(at_rest[f"share_across_{mode}"]) for mode in (1, 2)], [pair[1] for pair in shares], rtol=1e-6
    )  # two orders of Ritz, 1e-9 apart
    code, _, _ = run("modes", SCENE, "--modes", "1", "--csv", found, "--force")
    assert code == DONE and "share_across" not in read_csv(found)[0]


def test_locus_writes_files(run, tmp_path):
    j, c, p = (tmp_path / name for name in ("l.json", "l.csv", "l.svg"))
    arguments = ("locus", SCENE, "--speeds", "0:200:11 rad/s", "--json", j, "--csv", c, "--plot", p)
    assert run(*arguments)[0] == DONE
    rows = read_csv(c)
    written = json.loads(j.read_text())
    assert [float(row["speed_rad_per_s"]) for row in rows] == written["speeds"]
    assert rows[-1]["frequency_Hz_1"] == "nan" and rows[-1]["status_1"] == "divergence"
    assert written["frequency"][-1][0] is None
    assert "<svg" in p.read_text()


@pytest.mark.parametrize("option", sorted(FILES))
def test_file_that_exists_is_kept_without_force(run, tmp_path, option):
    path = tmp_path / f"there{FILES[option]}"
    path.write_text("precious")
    code, out, err = run("modes", SCENE, f"--{option}", path)
    assert (code, out) == (BAD_INPUT, "")
    assert str(path) in err and "--force" in err
    assert path.read_text() == "precious"
    assert run("modes", SCENE, f"--{option}", path, "--force")[0] == DONE
    assert path.read_bytes() != b"precious"


BAD = {
    "missing file": (("modes", "nowhere.toml"), ("nowhere.toml", "no such file", "check")),
    "folder": (("modes", str(ROOT)), ("cannot be read", "TOML")),
    "not TOML": (("modes", str(ROOT / "LICENSE")), ("LICENSE", "not valid TOML")),
    "bare speed": (("modes", SCENE, "--speed", "50"), ("--speed", '"50"', "50 rad/s")),
    "wrong unit": (("modes", SCENE, "--speed", "50 kg"), ("--speed", '"50 kg"', "give")),
    "hertz": (("modes", SCENE, "--speed", "5 Hz"), ("--speed", "300 rpm")),
    "no modes": (("modes", SCENE, "--modes", "0"), ("modes = 0", "1 or more")),
    "too many modes": (("modes", SCENE, "--modes", "500"), ("--modes", "at most 100")),
    "modes not a number": (("modes", SCENE, "--modes", "x"), ("--modes", '"x"', "whole number")),
    "method": (("modes", SCENE, "--discretization", "bem"), ("--discretization", "bem", "ritz")),
    "option": (("modes", SCENE, "--sped", "5"), ("--sped", "--speed")),
    "command": (("mods",), ("mods", "modes")),
    "no scene": (("modes",), ("SCENE.toml",)),
    "two scenes": (("modes", SCENE, SCENE), ("tyre_harvester",)),
    "no speeds": (("locus", SCENE), ("--speeds",)),
    "empty speeds": (("locus", SCENE, "--speeds", ""), ("--speeds", "empty", "rad/s")),
    "unit only": (("locus", SCENE, "--speeds", " rad/s"), ("--speeds", "not a number")),
    "unsorted": (("locus", SCENE, "--speeds", "0, 50, 20 rad/s"), ("--speeds", "ascend", "0, 20, 50 rad/s")),
    "duplicate": (("locus", SCENE, "--speeds", "0, 50, 50 rad/s"), ("--speeds", "50", "repeats")),
    "bare speeds": (("locus", SCENE, "--speeds", "0:50:5"), ("0:50:5", "unit", "rad/s")),
    "two units": (("locus", SCENE, "--speeds", "0 rad/s, 9 rpm"), ("0 rad/s", "one unit")),
    "no count": (("locus", SCENE, "--speeds", "0:50 rad/s"), ("0:50 rad/s", "start:stop:count")),
    "count of 0": (("locus", SCENE, "--speeds", "0:50:0 rad/s"), ("count", "'0'", "whole number")),
    "falling": (("locus", SCENE, "--speeds", "50:0:5 rad/s"), ("50:0:5", "start must be below stop")),
    "infinite": (("locus", SCENE, "--speeds", "0, inf rad/s"), ("inf", "not a number")),
    "wrong speeds": (("locus", SCENE, "--speeds", "0:5:5 m/s"), ("--speeds", "velocity")),
    "top speed": (("limits", SCENE, "--top-speed", "0 rad/s"), ("--top-speed", "greater than 0")),
    "bare top speed": (("limits", SCENE, "--top-speed", "9"), ("--top-speed", "9 rad/s")),
    "suffix": (("modes", SCENE, "--plot", "x.jpg"), ("--plot", "x.jpg", ".png")),
    "shape suffix": (("modes", SCENE, "--shapes", "x.stl"), ("--shapes", "x.stl", ".vtu")),
    "table as a workbook": (("modes", SCENE, "--csv", "x.xlsx"), ("--csv", "x.xlsx", ".csv, .tsv, .txt")),
    "result as a table": (("modes", SCENE, "--json", "x.csv"), ("--json", "x.csv", "one of .json, .txt")),
    "no folder": (("critical", SCENE, "--json", "no/where.json"), ("--json", "create it")),
    "folder as file": (("modes", SCENE, "--json", str(ROOT)), ("--json", "folder")),
    "one file twice": (("modes", SCENE, "--json", "x", "--csv", "x"), ("--json", "--csv", "own file")),
    "file as folder": (("reproduce", "--output", SCENE), ("--output", "folder")),
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


def test_mistakes_in_a_scene_are_all_listed(run, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(Path(SCENE).read_text().replace('"0.2 mm"', '"0.2 kg"').replace('"50 mm"', '"-50 mm"'))
    code, _, err = run("modes", path)
    assert code == BAD_INPUT
    assert "beam.thickness" in err and "beam.length" in err and "Traceback" not in err


def test_the_process_exits_with_the_code_and_no_traceback():
    command = [sys.executable, "-m", "beamdyn", "modes", "nowhere.toml"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout) == (BAD_INPUT, "")
    assert "Traceback" not in done.stderr


def test_help_loads_nothing_heavy():
    code = "import sys; from beamdyn.cli import main; main(['--help']); print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    loaded = set(done.stdout.split())
    assert loaded & {"numpy", "scipy", "matplotlib", "pydantic", "pint", "skfem", "meshio"} == set()


def test_a_file_in_common_units_is_answered_without_what_reads_uncommon_ones():
    code = (
        "import sys; from beamdyn.cli import main; main(['modes', 'examples/harvester_45deg.toml']); "
        "print(*sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    loaded = set(done.stdout.split())
    assert "numpy" in loaded
    assert loaded & {"pint", "matplotlib", "skfem", "scipy.special", "scipy.optimize"} == set()


@pytest.mark.parametrize("command", ["modes", "locus", "critical", "limits", "reproduce"])
def test_help_describes_every_option(run, command):
    code, out, _ = run(command, "--help")
    assert code == DONE and "Exit codes" in out


def test_speeds():
    assert parse_speeds("0:150:4 rad/s").tolist() == [0, 50, 100, 150]
    assert parse_speeds("0, 50,1e2 rad/s").tolist() == [0, 50, 100]
    assert parse_speeds("7 rad/s").tolist() == [7]
    np.testing.assert_allclose(parse_speeds("60:120:2rpm"), [2 * np.pi, 4 * np.pi])


@given(st.text(max_size=20))
def test_any_text_is_speeds_or_a_message(text):
    try:
        speeds = parse_speeds(text)
    except ValueError as error:
        assert "--speeds" in str(error)
    else:
        assert np.isfinite(speeds).all() and (np.diff(speeds) > 0).all()


SUPPORTED = [
    (65.23045644, 1.3e-6, "65.23046"),
    (65.23045644, 0.6, "7e+01"),
    (65.23045644, 1e-15, "65.23045644"),
    (0.0, 0.0, "0"),
    (1e-9, 4e-8, "0 ± 4e-08"),
    (-148.8221, 0.01, "-148.8"),
    (123456.0, 900.0, "1.2e+05"),
    (1.5e-7, 1e-9, "1.5e-07"),
    (np.nan, 0.0, "none"),
    (np.inf, 0.0, "inf"),
    (1.0, np.inf, "unresolved"),
    (8.89e6, 5.2e5, "8.9e+06 ± 5e+05"),
    (-8.3, 0.9, "-8.3 ± 0.9"),
    (4.1e-12, 2e-12, "4e-12 ± 2e-12"),
]


@pytest.mark.parametrize(("value", "error", "text"), SUPPORTED)
def test_supported(value, error, text):
    assert supported(value, error) == text


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (0.14939, 0.006, "0.149 ± 0.006"),
        (65.23045644, 0.6, "65.2 ± 0.6"),
        (65.23045644, 1.3e-6, "65.23046"),
        (1.0, np.inf, "unresolved"),
        (1e-9, 4e-8, "0 ± 4e-08"),
    ],
)
def test_a_single_digit_stands_with_its_error(value, error, text):
    assert supported_or_range(value, error) == text


@given(st.floats(1e-12, 1e12), st.floats(1e-15, 0.49))
def test_a_number_with_its_error_is_rounded_by_less(value, relative):
    number, _, error = supported_or_range(value, value * relative).partition(" ± ")
    if error:
        assert abs(float(number) - value) <= value * relative
        assert float(error) == pytest.approx(value * relative, rel=0.5)


@given(st.floats(-1e12, 1e12))
def test_a_bound_is_rounded_so_that_it_remains_one(value):
    assert float(lower_bound(value)) <= value <= float(upper_bound(value))


@given(st.floats(1e-12, 1e12), st.floats(1e-15, 0.4))
def test_the_last_digit_printed_is_supported(value, relative):
    text = supported(value, value * relative)
    if "±" not in text:
        mantissa, _, exponent = text.partition("e")
        unit = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
        assert unit / 2 >= value * relative * (1 - 1e-9)
        assert abs(float(text) - value) <= unit / 2 * (1 + 1e-9) + 1e-15 * value


def test_a_table_named_tsv_is_separated_by_tabs(run, tmp_path):
    for name in ("m.csv", "m.tsv"):
        assert run("modes", SCENE, "--csv", tmp_path / name)[0] == DONE
    commas, tabs = ((tmp_path / name).read_text() for name in ("m.csv", "m.tsv"))
    assert tabs.startswith("mode\tspeed_rad_per_s\t") and "," not in tabs
    assert [*csv.reader(tabs.splitlines(), delimiter="\t")] == [*csv.reader(commas.splitlines())]
