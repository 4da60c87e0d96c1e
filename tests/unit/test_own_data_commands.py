"""The commands on own data: files, refusals, exit codes, and the scene that is written."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.cli.commands import main
from beamdyn.common.edge.config import ConfigError
from beamdyn.files.scenes import load_scene, parse_scene, with_numbers_in_file
from beamdyn.scene.numbers import with_numbers
from tests.unit.toml_scenes import STRIP_TOML

EXAMPLES = Path(__file__).parents[2] / "examples"
SCENE = str(EXAMPLES / "tyre_harvester.toml")
MEASURED = ("--measured", "62.1, 389, 1090 Hz")


def test_three_frequencies_and_no_manual(finished):
    said = " ".join(finished(main(["compare", SCENE, *MEASURED]), 0).out.split())
    assert "389 Hz is 4.8 % below 408.792 Hz, outside what the model leaves out (1.1 %)" in said
    assert "beam.thickness = 0.19 mm" in said
    assert "beam.youngs_modulus = 181 GPa" in said


def test_a_file_is_shown_in_its_own_unit_of_speed_and_written_in_all_forms(tmp_path, capsys):
    data = tmp_path / "measured.csv"
    data.write_text("speed [rpm], frequency 1 [Hz]\n0, 65.23\n477.4648, 61.963\n")
    names = {kind: tmp_path / f"out.{kind}" for kind in ("json", "csv", "html", "png")}
    options = zip(("--json", "--csv", "--report", "--plot"), map(str, names.values()), strict=True)
    assert main(["compare", SCENE, str(data), *(word for pair in options for word in pair)]) == 0
    assert "speed [rpm]" in capsys.readouterr().out
    written = json.loads(names["json"].read_text())
    expected = bd.compare(bd.load_scene(SCENE), bd.read_measurements(data))
    assert written["verdict"] == list(expected.verdict)
    assert written["sentences"]
    assert names["csv"].read_text().count("\n") == 3
    assert "agrees" in names["html"].read_text()
    assert names["png"].stat().st_size > 1000


def test_the_scene_found_is_written_with_its_source_and_its_comments(tmp_path, capsys):
    to = tmp_path / "found.toml"
    assert main(["identify", SCENE, "--free", "mount.root_stiffness", *MEASURED, "--write", str(to)]) == 0
    text, found = to.read_text(), bd.load_scene(to)
    assert text.startswith("# Found by beamdyn")
    assert "tyre_harvester.toml" in text
    assert "# in the plane of rotation" in text
    told = bd.identify(
        bd.load_scene(SCENE),
        bd.MeasuredFrequencies([62.1, 389.0, 1090.0]),
        {"mount.root_stiffness": None},
    )
    np.testing.assert_allclose(found.mount.root_stiffness, told.value[0], rtol=1e-9)  # ten digits are written


def test_what_is_not_told_is_refused_after_it_is_shown(finished):
    said = finished(main(["identify", SCENE, "--free", "youngs_modulus, density", *MEASURED]), 1)
    assert "cannot be told apart by these data" in said.out
    assert "the data do not determine beam.youngs_modulus and beam.density" in said.err


def test_frequencies_and_uncertainties_may_be_in_radians_a_second(tmp_path):
    written = {}
    for name, given in {
        "Hz": ("62.500000, 390.000000 Hz", "0.5 Hz"),
        "rad": ("392.699082, 2450.442270 rad/s", "3.14159265 rad/s"),
    }.items():
        to = tmp_path / f"{name}.json"
        words = ["--measured", given[0], "--uncertainty", given[1], "--json", str(to)]
        assert main(["compare", SCENE, *words]) == 0
        written[name] = json.loads(to.read_text())
    for what in ("measured", "allowance"):  # to the digits that are written above
        np.testing.assert_allclose(written["rad"][what], written["Hz"][what], rtol=1e-5)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("compare", SCENE), "give either a file"),
        (("compare", SCENE, str(EXAMPLES / "epps.csv"), *MEASURED), "give either a file"),
        (("compare", SCENE, "--measured", "62.1, 389"), "one unit at their end"),
        (("compare", SCENE, *MEASURED, "--uncertainty", "1 mm"), "--uncertainty"),
        (("compare", SCENE, *MEASURED, "--uncertainty", "x %"), 'give e.g. "0.5 Hz" or "1 %"'),
        (("compare", SCENE, *MEASURED, "--speeds", "0, 50 rad/s"), "give one speed with --measured"),
        (("identify", SCENE, *MEASURED, "--free", "thicknes"), "did you mean thickness"),
        (("identify", SCENE, *MEASURED, "--free", "beam.thickness=1 mm"), "give two bounds and a unit"),
        (("identify", SCENE, *MEASURED, "--free", ","), "give the unknown numbers"),
        (
            ("identify", SCENE, *MEASURED, "--free", "motion.rotation.speed"),
            "a speed is given by the data",
        ),
        (("identify", SCENE, *MEASURED, "--free", "speed=1:2 rpm"), "a speed is given by the data"),
        (
            ("identify", SCENE, *MEASURED, "--free", "motion.duration"),
            '--free = "motion.duration": it is no number',
        ),
        (
            ("design", SCENE, "--free", "motion.speed", "--so-that", "frequency 1 = 62 Hz"),
            "is no number of a scene",
        ),
    ],
)
def test_mistakes_are_refused(words, said, finished):
    assert said in " ".join(finished(main(words), 2).err.split())


def test_numbers_are_put_into_the_text_of_a_scene(tmp_path):
    values = {"beam.thickness": 0.19e-3, "beam.tip.mass": 2e-5, "mount.root_stiffness": np.inf}
    changed = with_numbers_in_file(SCENE, values, tmp_path / "found.toml", ["found"])
    scene = parse_scene(changed)
    assert scene.beam.tip is not None
    np.testing.assert_allclose([scene.beam.tip.mass, scene.mount.root_stiffness], [2e-5, np.inf], rtol=1e-9)
    assert changed.count("thickness") == 1
    assert "# of steel" in changed


ROWS = """
stations = [
  ["x/L", "width [mm]"],
  [0, 10],
  [1, 8]
]
"""
WHEEL = """
[motion]
kind = "rolling"
rolling_radius = "0.3 m"
rotation = { speed = "20 m/s" }
road = { wavelength = "0.3 m", height = "1 mm" }
"""


@pytest.mark.parametrize(
    ("more", "path", "value"),
    [
        ('tip = { mass = "1 g" }\n[mount]\nradius = "0.2 m"\n', "beam.tip.mass", 2e-3),
        ('tip.mass = "1 g"\n[mount]\nradius = "0.2 m"\n', "beam.tip.mass", 2e-3),
        ('[mount]\nradius = "0.2 m"\n[[beam.point_mass]]\nposition = "20 mm"\nmass = "1 g"\n',
         "mount.setting_angle", 0.5),
        ('[mount]\nradius = "0.2 m"\n[[beam.point_mass]]\nposition = "20 mm"\nmass = "1 g"\n',
         "beam.point_mass[0].mass", 2e-3),
        ('[mount]\nradius = "0.2 m"\n' + WHEEL, "motion.road.height", 2e-3),
        ('"poissons_ratio" = 0.3\n[mount]\nradius = "0.2 m"\n', "beam.poissons_ratio", 0.25),
    ],
)  # fmt: skip
def test_numbers_are_put_into_a_scene_in_any_notation(more, path, value, tmp_path):
    (tmp_path / "scene.toml").write_text(STRIP_TOML + more)
    changed = with_numbers_in_file(tmp_path / "scene.toml", {path: value}, tmp_path / "found.toml")
    assert parse_scene(changed) == with_numbers(parse_scene(STRIP_TOML + more), {path: value})


def test_rows_of_a_table_are_no_heads(tmp_path):
    text = STRIP_TOML.replace('width = "10 mm"', ROWS) + '[mount]\nradius = "0.2 m"\n'
    (tmp_path / "scene.toml").write_text(text)
    changed = with_numbers_in_file(tmp_path / "scene.toml", {"beam.density": 8e3}, tmp_path / "found.toml")
    assert parse_scene(changed) == with_numbers(parse_scene(text), {"beam.density": 8e3})


def test_files_that_a_scene_names_are_found_from_another_folder(tmp_path):
    blade = EXAMPLES / "blade_of_stations.toml"
    (found := tmp_path / "found.toml").write_text(with_numbers_in_file(blade, {"mount.radius": 2.0}, found))
    assert load_scene(found) == with_numbers(load_scene(blade), {"mount.radius": 2.0})


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("beam.scale.mass_per_length", 1.1),  # no key
        ("beam.bending_stiffness", 2e-3),  # beside the sides of a section
        ("tip_load.force[0]", 1.5),  # of a list that is not there
        ("motion.rolling_radius", 0.31),  # from which the speed in the file follows
    ],
)
def test_numbers_that_a_file_cannot_state_are_refused(path, value, tmp_path):
    text = f'{STRIP_TOML}[mount]\nradius = "0.2 m"\n{WHEEL}'
    (tmp_path / "scene.toml").write_text(text)
    with pytest.raises(ConfigError, match=f"{re.escape(path)} = {value}.* cannot state this beside"):
        with_numbers_in_file(tmp_path / "scene.toml", {path: value}, tmp_path / "found.toml")


@pytest.mark.parametrize(
    "command", [["identify", "--measured", "1 Hz"], ["design", "--so-that", "frequency = 1 Hz"]]
)
def test_a_number_that_the_file_cannot_state_is_refused_before_it_is_found(
    command, tmp_path, monkeypatch, finished
):
    blade, to = str(EXAMPLES / "twisted_blade.toml"), str(tmp_path / "found.toml")
    monkeypatch.setattr(bd, command[0], None)
    ask = [command[0], blade, *command[1:], "--free", "mass_per_length=100:200 kg/m", "--write", to]
    assert "cannot state this beside its other keys" in finished(main(ask), 2).err


def test_what_is_not_told_is_shown_and_saved_but_no_scene_is_written(tmp_path, finished):
    to, found = tmp_path / "scene.toml", tmp_path / "found.json"
    ask = ["identify", SCENE, "--free", "youngs_modulus, density", *MEASURED]
    said = finished(main([*ask, "--write", str(to), "--json", str(found)]), 1)
    assert "cannot be told apart by these data" in said.out
    assert "the data do not determine beam.youngs_modulus and beam.density" in said.err
    assert found.exists() and not to.exists()
