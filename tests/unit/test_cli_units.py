"""Units of frequencies and densities on the command line and in its files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from beamdyn.analyses.about_linear_models import parse_frequencies, read_spectrum
from beamdyn.cli import BAD_INPUT, main
from beamdyn.common.edge.config import ConfigError
from brakes.cli import main as brakes

TYRE = Path(__file__).parents[2] / "examples" / "tyre_harvester.toml"
G = 9.80665  # m/s2


def spectrum(tmp_path, unit, wanted="m2/s4/Hz"):
    path = tmp_path / "psd.csv"
    path.write_text(f"f [Hz], psd [{unit}]\n1, 1\n50, 2\n")
    return read_spectrum(path, wanted)


@pytest.mark.parametrize(
    ("unit", "size"),
    [
        ("m2/s4/Hz", 1.0),
        ("(m/s2)2/Hz", 1.0),
        ("(m/s^2)^2/Hz", 1.0),
        ("(m/s**2)**2/Hz", 1.0),
        ("g2/Hz", G**2),
        ("g^2/Hz", G**2),
        ("g**2 / Hz", G**2),
    ],
)
def test_densities_of_accelerations(tmp_path, unit, size):
    np.testing.assert_allclose(spectrum(tmp_path, unit).values, [size, 2 * size], rtol=1e-14)


def test_densities_of_forces(tmp_path):
    np.testing.assert_allclose(spectrum(tmp_path, "kN2/Hz", "N2/Hz").values, [1e6, 2e6], rtol=1e-14)


@pytest.mark.parametrize(
    ("unit", "wanted"), [("g2/Hz", "N2/Hz"), ("g/Hz", "m2/s4/Hz"), ("kg2/Hz", "m2/s4/Hz")]
)
def test_other_densities_are_refused(tmp_path, unit, wanted):
    with pytest.raises(ConfigError, match="expected a unit like"):
        spectrum(tmp_path, unit, wanted)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("1:1000:200", 'give a unit of frequency at its end, e.g. "1:1000:200 Hz"'),
        ("50, 60", 'e.g. "50, 60 Hz"'),
        ("", 'e.g. "1:1000:400 Hz"'),
        ("1:10:3 m", "a unit of length where frequency is wanted"),
        ("1:10 Hz", "give start:stop:count or a list"),
    ],
)
def test_frequencies_that_are_refused(text, said):
    with pytest.raises(ValueError) as refusal:
        parse_frequencies(text)
    assert said in str(refusal.value) and "--frequencies" in str(refusal.value)


@pytest.mark.parametrize(
    ("text", "hertz"), [("50,60Hz", [50, 60]), ("1:100:3Hz", [1, 10, 100]), ("0.05, 1 kHz", [50, 1000])]
)
def test_frequencies(text, hertz):
    np.testing.assert_allclose(parse_frequencies(text), hertz, rtol=1e-14)


# Numbers out of range, in the unit in which they were given ----------------------------------------------


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["modes", TYRE, "--speed", "1e60 rpm"], "--speed = 1e+60 rpm: give at most 9.5493e+50 rpm"),
        (["modes", TYRE, "--speed=-1e60 rpm"], "--speed = -1e+60 rpm: give at most 9.5493e+50 rpm"),
        (["locus", TYRE, "--speeds", "0:1e60:2 rpm"], "--speeds = 1e+60 rpm"),
        (
            ["response", TYRE, "--speed", "1 rpm", "--frequencies", "1:1e20:2 kHz"],
            "--frequencies = 1e+20 kHz: give at most 1e+09 kHz",
        ),
        (
            ["study", TYRE, "--spread", "beam.density=+-12 g/cm3"],
            "beam.density = -4.15 g/cm3, which +-12 g/cm3 reaches",
        ),
    ],
)
def test_what_is_out_of_range_is_said_in_the_unit_of_its_option(options, said, finished):
    assert said in " ".join(finished(main([str(each) for each in options]), BAD_INPUT).err.split())


def test_the_spread_of_a_brake_is_refused_in_the_unit_of_its_tolerance(capsys):
    assert brakes(["caliper", "dual-pivot", "--spread", "run.finger=+-500 kgf"]) == BAD_INPUT
    assert "run.finger = -495.921 kgf, which +-500 kgf reaches" in " ".join(capsys.readouterr().err.split())


def test_the_bounds_of_an_angle_that_a_spread_passes_are_in_degrees(capsys):
    vehicle = TYRE.with_name("vehicle.toml")
    assert brakes(["vehicle", str(vehicle), "--spread", "road.slope=1 deg to 50 deg"]) == BAD_INPUT
    said = " ".join(capsys.readouterr().err.split())
    assert "reaches: it must be at least 0, at most 45 deg; give a smaller spread" in said


def test_a_size_below_all_bounds_is_told_the_bound_in_its_unit(tmp_path, capsys):
    small = TYRE.read_text("utf-8").replace('"50 mm"', '"1e-60 mm"')
    (tmp_path / "small.toml").write_text(small)
    assert main(["modes", str(tmp_path / "small.toml")]) == BAD_INPUT
    assert 'beam.length = "1e-60 mm": give a size of 1e-47 mm or more' in capsys.readouterr().err


def test_a_cell_longer_than_any_number_is_refused_by_its_line(tmp_path):
    """It was a traceback."""
    (tmp_path / "long.csv").write_text("f [Hz], psd [m2/s4/Hz]\n1, 1\n" + "5" * 200_000 + ", 1\n")
    with pytest.raises(ConfigError, match=r"line 3: a cell has more than \d+ characters"):
        read_spectrum(tmp_path / "long.csv", "m2/s4/Hz")
