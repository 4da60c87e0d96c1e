"""Published frequencies in CSV files beside their scenes: verdicts as of `reproduce`, and the right pairs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import beamdyn as bd
from beamdyn import published
from beamdyn.published import load
from beamdyn.reproduce.inward_beam import first_frequencies, largest_deflections
from beamdyn.reproduce.printed_tables import cases, entries_of_case
from beamdyn.studies.beside_data.compare import beside
from beamdyn.studies.beside_data.computed_curves import computed_history

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_tables_of_the_inward_beam_have_the_verdicts_of_reproduce():
    scene = bd.load_scene(EXAMPLES / "tyre_harvester.toml")
    rows = [each for each in first_frequencies() if each.decimals == 3 and isinstance(each.published, float)]
    for name, source in (("", "ANSYS"), ("_proposed", "paper")):
        found = beside(scene, bd.read_measurements(EXAMPLES / f"lee_yoo_table_2{name}.csv"))
        known = [each for each in rows if source.lower() in each.source.lower()]
        for value, verdict in zip(found.measured.tolist(), found.verdict, strict=True):
            agreeing = {each.agrees for each in known if each.published == value}
            assert agreeing == {verdict == "agrees"}, (source, value)


def test_the_peak_of_the_inward_beam_has_the_verdicts_of_reproduce():
    scene = bd.load_scene(EXAMPLES / "rolling_harvester.toml")
    rows = [each for each in largest_deflections() if each.what == "5 modes, Ritz"]
    for name, source in (("", "RecurDyn"), ("_proposed", "paper")):
        found = bd.compare(scene, bd.read_measurements(EXAMPLES / f"lee_yoo_table_3{name}.csv"))
        (known,) = (each for each in rows if source in each.source)
        np.testing.assert_allclose(1e3 * found.peak, known.published, rtol=1e-12)  # the same digits
        assert found.agrees == known.agrees
        assert found.agrees == bool(found.in_digits.all())


@pytest.mark.parametrize(
    ("paper", "file", "scene"),
    [
        ("bir_2009", "bir_2009", "bir"),
        ("bir_2010", "bir_2010", "bir_tip"),
        ("hamza_cherif_houmat_2004", "hamza_flap", "bir"),
    ],
)
def test_tables_in_rad_per_s_have_the_verdicts_of_reproduce(paper, file, scene):
    found = beside(bd.load_scene(EXAMPLES / f"{scene}.toml"), bd.read_measurements(EXAMPLES / f"{file}.csv"))
    flap = [case for case in cases(paper) if "alpha" not in case]  # the others are of the chord
    entries = [entry for case in flap for entry in entries_of_case(case, "ritz")]
    assert [verdict == "agrees" for verdict in found.verdict] == [entry.agrees for entry in entries]
    assert "outside" in found.verdict  # a print that errs is found


def test_a_run_of_another_integrator_agrees_to_the_digits_of_its_file():
    data = bd.read_measurements(EXAMPLES / "resonance_radau.csv")
    found = computed_history(bd.load_scene(EXAMPLES / "rolling_harvester.toml"), data)
    assert found.delay == 0.0
    off = np.abs(found.value - data.columns)
    assert (off <= data.allowance + found.error).all()
    exact = load("lee_yoo_2019")["reference"]["largest_deflection"]["whole_run"]["value"]
    np.testing.assert_allclose(np.abs(data.columns).max(), exact, rtol=1e-4)  # five digits, between samples


def test_the_measured_blade_is_paired_with_its_flap_and_torsional_modes():
    data = bd.read_measurements(EXAMPLES / "epps.csv")
    paper = published.load("epps_chandra_1996")
    for row, found in zip(paper["measured"], data.frequency, strict=True):
        np.testing.assert_array_equal(found[:3], [float(text) for text in row["frequency"]])
    scene = bd.load_scene(EXAMPLES / "epps.toml")
    found = beside(scene, data)
    flaps = [1, 2, 3, 1, 2, 3, 1, 2, 3, 4, 0, 5]
    assert found.mode.tolist() == flaps
    fastest = bd.MeasuredFrequencies(data.frequency[2:], data.speeds[2:], labels=data.labels)
    twisting = beside(replace(scene, physics=bd.Physics(torsion=True)), fastest)
    assert twisting.mode.tolist() == [1, 2, 3, 4, 5, 6]
    # What another program makes of it deviates as much: GXBeam's test takes 10 % or 1 Hz.
    off = np.abs(twisting.measured - twisting.computed)
    assert (off <= np.maximum(0.1 * twisting.measured, 1.0)).all()


def test_shells_of_the_strip_are_paired_past_their_torsional_mode():
    scene = bd.load_scene(EXAMPLES / "tyre_harvester.toml")
    found = beside(scene, bd.read_measurements(EXAMPLES / "strip_shells.csv"))
    assert found.mode.tolist() == [1, 2, 0, 3] * 2
    plate = replace(scene, physics=bd.Physics(torsion=True, camber=True))
    found = beside(plate, bd.read_measurements(EXAMPLES / "strip_shells.csv"))
    assert found.mode.tolist() == [1, 2, 3, 4] * 2
    # Shells of one mesh: 0.25 % in bending, as the first order of their convergence at the clamp leaves.
    np.testing.assert_allclose(found.deviation, 0.0, atol=5e-3)
