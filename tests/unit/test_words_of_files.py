"""What files and commands accept as people write it, and what they say of what they refuse."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.cli import main
from beamdyn.common.edge.units import InvalidInput, quantity
from beamdyn.common.words import amount

ROLLING = "examples/rolling_harvester.toml"
STRIP = Path("examples/tyre_harvester.toml").read_text()


def refusal(finished, tmp_path: Path, scene: str, *arguments: str) -> str:
    """What a command says of a scene that it refuses."""
    path = tmp_path / "scene.toml"
    path.write_text(scene)
    return " ".join(finished(main([arguments[0], str(path), *arguments[1:]]), 2).err.split())


@pytest.mark.parametrize(
    "text", ["\u221250 mm", "-50\u00a0mm", "-50\u202fmm", "\uff0d\uff15\uff10 mm", "\u201350 mm"]
)
def test_minus_signs_spaces_and_digits_of_printed_pages_are_read(text: str):
    assert quantity(text, "m") == -0.05


@pytest.mark.parametrize(
    ("text", "name"),
    [("5\u041e mm", "CYRILLIC CAPITAL LETTER O (U+041E)"), ("50\u200bmm", "ZERO WIDTH SPACE (U+200B)")],
)
def test_a_character_that_looks_like_another_is_named(text: str, name: str):
    with pytest.raises(InvalidInput, match="it has the character") as refused:
        quantity(text, "m")
    assert name in str(refused.value)


def test_a_missing_file_of_stations_or_records_is_named_with_its_key_and_folder(finished, tmp_path):
    said = refusal(finished, tmp_path, STRIP.replace("[beam]", '[beam]\nstations = "nope.csv"'), "modes")
    assert f'beam.stations = "nope.csv": there is no such file in the folder {tmp_path}' in said
    motion = '\n[motion]\nkind = "recorded_rotation"\nfile = "nope.csv"\n'
    if "[motion]" not in STRIP:
        said = refusal(finished, tmp_path, STRIP + motion, "modes")
        assert 'motion.file = "nope.csv"' in said


def test_a_thick_section_is_sent_to_keys_of_the_file(finished, tmp_path):
    said = refusal(finished, tmp_path, STRIP.replace('"0.2 mm"', '"20 mm"'), "modes")
    assert "Beam." not in said and "mass_per_length and bending_stiffness in [beam]" in said


def test_stations_in_lengths_are_offered_where_fractions_are_wanted(finished, tmp_path):
    table = '{ stations = ["0 mm", "40 mm"], values = ["0.2 mm", "0.1 mm"] }'
    said = refusal(finished, tmp_path, STRIP.replace('"0.2 mm"', table), "modes")
    assert (
        "must be the tip, at 1 or the beam's length; give fractions x/L, or lengths with their unit" in said
    )
    said = refusal(finished, tmp_path, STRIP.replace("[beam]", '[beam]\nbreakpoints = ["60 mm"]'), "modes")
    assert "give fractions x/L between 0 and 1, ends excluded, or lengths with their unit" in said


def test_odd_characters_among_varied_values_are_read_or_named(finished, tmp_path):
    said = refusal(finished, tmp_path, STRIP, "study", "--vary", "beam.length=4\u041e:50:2 mm")
    assert "it has the character CYRILLIC CAPITAL LETTER O (U+041E)" in said
    assert (
        main(["study", "examples/tyre_harvester.toml", "--vary", "beam.length=\uff14\uff10,50\u00a0mm"]) == 0
    )


@pytest.mark.parametrize("values", ["nan:0.05:3 m", "0.05,nan m", "0.05:inf:3 m"])
def test_numbers_that_are_not_finite_are_named_in_studies(finished, tmp_path, values: str):
    said = refusal(finished, tmp_path, STRIP, "study", "--vary", f"beam.length={values}")
    assert f"{'inf' if 'inf' in values else 'nan'} is not a finite number" in said


def test_a_motion_that_excites_nothing_is_refused_in_words(finished, tmp_path):
    steady = '\n[motion]\nkind = "steady"\nspeed = "50 rad/s"\n'
    said = refusal(finished, tmp_path, STRIP + steady, "random", "--road", "C", "--speed", "10 rad/s")
    assert (
        "[motion]: a road needs the rolling radius of a wheel" in said
        and "(" not in said.split("[motion]")[1]
    )


def test_the_speed_of_a_wheel_may_be_that_of_the_vehicle(finished, tmp_path):
    """59.4 km/h is 55 rad/s on a radius of 300 mm."""
    text = Path(ROLLING).read_text()
    assert text.count('"55 rad/s"') == 1
    path = tmp_path / "rolling.toml"
    path.write_text(text.replace('"55 rad/s"', '"59.4 km/h"'))
    assert bd.load_scene(path).motion.final_speed == pytest.approx(55.0, rel=1e-15)
    assert "at 55 rad/s" in finished(main(["modes", ROLLING, "--speed", "59.4 km/h"]), 0).out
    csv = tmp_path / "locus.csv"
    assert main(["locus", ROLLING, "--speeds", "0:59.4:2 km/h", "--csv", str(csv)]) == 0
    assert np.loadtxt(csv, delimiter=",", skiprows=1, usecols=0) == pytest.approx([0.0, 55.0], rel=1e-15)
    assert main(["modes", "examples/tyre_harvester.toml", "--speed", "60 km/h"]) == 2


def test_one_per_rev_line_can_be_asked_for(capsys):
    assert main(["campbell", "examples/blade.toml", "--top-speed", "100 rad/s", "--per-rev", "2P"]) == 0
    said = capsys.readouterr().out
    assert " 2P " in said and " 1P " not in said


@pytest.mark.parametrize(
    ("command", "more"),
    [("resonances", ()), ("campbell", ("--operating", "20:59.4 km/h", "--rated", "50 km/h"))],
)
def test_the_top_speed_of_a_wheel_may_be_that_of_the_vehicle(finished, command: str, more: tuple[str, ...]):
    assert "up to 55 rad/s" in finished(main([command, ROLLING, "--top-speed", "59.4 km/h", *more]), 0).out
    assert main([command, "examples/blade.toml", "--top-speed", "60 km/h"]) == 2


def test_lengths_from_ten_metres_on_are_in_metres():
    assert [amount(each).elsewhere for each in (0.05, 9.99, 31.6)] == ["50 mm", "9990 mm", "31.6 m"]
    assert amount(0.5, -12.0).elsewhere == "(0.5, -12) m"
