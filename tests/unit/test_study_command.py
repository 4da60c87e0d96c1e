"""The command of studies: what it shows, writes and refuses."""

import csv
from pathlib import Path

import pytest

import beamdyn as bd
from beamdyn.cli import main
from beamdyn.common.inputs.described import MOST_DESIGNS
from tests.unit.toml_scenes import STRIP_TOML

EXAMPLES = Path(__file__).parents[2] / "examples"
TOML = STRIP_TOML + '[mount]\nradius = "0.2 m"\n'


def test_the_command_writes_what_it_shows(tmp_path, finished):
    (tmp_path / "scene.toml").write_text(TOML)
    files = {kind: tmp_path / f"study.{kind}" for kind in ("csv", "json", "png")}
    arguments = ["study", str(tmp_path / "scene.toml"), "--vary", "thickness=0.2:0.3:2 mm", "--vary"]
    arguments += [
        "speed=0:30:2 rad/s",
        "--csv",
        files["csv"],
        "--json",
        files["json"],
        "--plot",
        files["png"],
    ]
    assert "beam.thickness [mm]" in finished(main([str(each) for each in arguments]), 0).out
    study = bd.load(files["json"])
    head, *rows = csv.reader(files["csv"].read_text().splitlines())
    assert head[:3] == ["beam_thickness_mm", "speed_rad_per_s", "frequency_Hz_1"]
    assert len(rows) == 4 and [float(cell) for cell in rows[3][:3]] == [0.3, 30.0, study.value[1, 1, 0]]
    assert files["png"].stat().st_size > 1000


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--vary", "beam.thickness=0.1:0.2:3 kg"], "mass"),
        (["--vary", "beam.thickness=0.1:0.2:3"], "give a unit"),
        (["--vary", "thickness=0.1:0.2:3 mm", "--vary", "beam.thickness=0.1:0.2:3 mm"], "given twice"),
        (["--vary", "beam.thickness=:3 mm"], "start:stop:count"),
        (["--vary", "thickness=0.1:0.2:3 mm", "--vary", "speed=0:1:2 rad/s", "--together"], "3 and 2 values"),
        (["--vary", "thickness=0.1:0.2:2000 mm", "--vary", "radius=0:1:2000 m"], "at most 1000000 designs"),
        (["--sweep", "thickness=0.1:0.2:3 mm"], "Did you mean --vary?"),
        ([], "give --vary"),
    ],
)
def test_the_command_refuses_in_a_sentence(options, said, tmp_path, finished):
    (tmp_path / "scene.toml").write_text(TOML)
    error = finished(main(["study", str(tmp_path / "scene.toml"), *options]), 2).err
    assert said in error and error.count("\n") == 1


def run(arguments, tmp_path, capsys, scene=TOML):
    (tmp_path / "scene.toml").write_text(scene)
    code = main(["study", str(tmp_path / "scene.toml"), *arguments])
    found = capsys.readouterr()
    return code, " ".join(found.out.split()), found.err


def test_warnings_show_inputs_as_they_were_given(tmp_path, capsys):
    vary = ["--vary", "setting_angle=0:180:4 deg", "--vary", "thickness=0.1,0.4 mm", "--modes", "1"]
    code, _, err = run([*vary, "--speed", "955 rpm"], tmp_path, capsys)
    assert code == 0 and " rad" not in err and " m " not in err
    assert "at mount.setting_angle = 60 deg, beam.thickness = 0.1 mm" in err
    vary = ["--vary", "speed=200,3000 rpm", "--vary", "thickness=0.2,0.3 mm", "--what", "amplitude"]
    code, _, err = run(vary, tmp_path, capsys, TOML + MOTION)
    assert "at beam.thickness = 0.2 mm: past the critical speed at 1 speed, 3000 rpm" in err


def test_a_refusal_shows_an_input_in_the_unit_given(tmp_path, capsys):
    code, _, err = run(["--vary", "thickness=5:20:3 mm"], tmp_path, capsys)
    assert code == 2 and "beam.thickness = 20 mm" in err and "10 mm" in err


MOTION = """
[motion]
kind = "rolling"
rolling_radius = "300 mm"
rotation = { kind = "spin_up", speed = "30 rad/s", duration = "1 s" }
road = { wavelength = "300 mm", velocity_amplitude = "10 mm/s" }
"""


def test_numbers_of_the_motion_are_varied(tmp_path, capsys):
    vary = ["--vary", "wavelength=200,300 mm", "--what", "amplitude"]
    code, out, _ = run(vary, tmp_path, capsys, TOML + MOTION)
    assert code == 0 and "motion.road.wavelength [mm]" in out
    code, _, err = run(vary, tmp_path, capsys)
    assert code == 2 and "unknown name 'wavelength'" in err


@pytest.mark.parametrize("what", ["critical_speed", "crossings"])
def test_a_speed_that_is_sought_is_not_varied(what, tmp_path, capsys):
    code, _, err = run(
        ["--vary", "speed=20,50 rad/s", "--what", what, "--speed", "9 rad/s"], tmp_path, capsys, TOML + MOTION
    )
    assert code == 2 and "is itself a speed that is sought" in err and "vary other inputs" in err


def test_no_model_error_is_stated_of_no_answer(tmp_path, capsys):
    vary = ["--vary", "speed=300,400 rad/s", "--what", "amplitude"]
    _, out, err = run(vary, tmp_path, capsys, TOML + MOTION)
    assert "not estimated, as no design has an answer" in out and "of 0 designs" not in out
    assert "there is no answer at any of 2 designs: past the critical speed" in err


def test_a_store_without_a_name_is_refused(tmp_path, capsys, monkeypatch):
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    code, _, err = run(["--vary", "speed=0:9:2 rad/s", "--store", ""], tmp_path, capsys)
    assert code == 2 and "--store" in err and "the name is empty" in err and err.count("\n") == 1
    assert not [*(tmp_path / "here").iterdir()]


def test_help_and_python_have_one_limit(finished):
    assert "a million designs" in " ".join(finished(main(["study", "--help"]), 0).out.split())
    assert MOST_DESIGNS == 10**6


def test_the_command_refuses_an_unknown_input(tmp_path, capsys):
    (tmp_path / "scene.toml").write_text(TOML)
    assert main(["study", str(tmp_path / "scene.toml"), "--vary", "beam.thicknes=1:2:3 mm"]) == 2
    assert "beam.thickness" in capsys.readouterr().err


def test_lengths_are_in_the_unit_of_their_head(finished):
    """An amplitude of 0.26 mm; that of a beam of which the change by an effect is not known is shown, too."""
    given = ["study", str(EXAMPLES / "rolling_harvester.toml"), "--vary", "beam.thickness=0.2:0.3:2 mm"]
    printed = finished(main([*given, "--what", "amplitude"]), 0).out
    assert "steady amplitude [mm]" in printed and "0.26187" in printed
    given = ["study", str(EXAMPLES / "bimorph.toml"), "--vary", "harvester.resistance=100:200:2 kohm"]
    assert "0.2127" in finished(main([*given, "--what", "amplitude"]), 0).out
