"""The command of studies: what it shows, writes and refuses."""

import csv

import pytest

import beamdyn as bd
from beamdyn.cli import main

TOML = """
[beam]
length = "50 mm"
width = "10 mm"
thickness = "0.2 mm"
youngs_modulus = "200 GPa"
density = "7850 kg/m3"

[mount]
radius = "0.2 m"
"""


def test_the_command_writes_what_it_shows(tmp_path, capsys):
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
    assert main([str(each) for each in arguments]) == 0
    assert "beam.thickness [mm]" in capsys.readouterr().out
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
def test_the_command_refuses_in_a_sentence(options, said, tmp_path, capsys):
    (tmp_path / "scene.toml").write_text(TOML)
    assert main(["study", str(tmp_path / "scene.toml"), *options]) == 2
    error = capsys.readouterr().err
    assert said in error and error.count("\n") == 1


def test_the_command_refuses_an_unknown_input(tmp_path, capsys):
    (tmp_path / "scene.toml").write_text(TOML)
    assert main(["study", str(tmp_path / "scene.toml"), "--vary", "beam.thicknes=1:2:3 mm"]) == 2
    assert "beam.thickness" in capsys.readouterr().err
