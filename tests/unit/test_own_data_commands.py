"""The commands on own data: files, refusals, exit codes, and the scene that is written."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.cli.commands import main
from beamdyn.files.scenes import parse_scene, with_numbers_in_text

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


def test_numbers_are_put_into_the_text_of_a_scene():
    text = Path(SCENE).read_text()
    values = {"beam.thickness": 0.19e-3, "beam.tip.mass": 2e-5, "mount.root_stiffness": np.inf}
    changed = with_numbers_in_text(text, values, ["found"])
    scene = parse_scene(changed)
    assert scene.beam.tip is not None
    np.testing.assert_allclose([scene.beam.tip.mass, scene.mount.root_stiffness], [2e-5, np.inf], rtol=1e-9)
    assert changed.count("thickness") == 1
    assert "# of steel" in changed
    with pytest.raises(ValueError, match="no line of the file holds this number alone"):
        with_numbers_in_text(text, {"beam.point_mass[0].mass": 1.0})
