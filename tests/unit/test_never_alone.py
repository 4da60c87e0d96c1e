"""A number of linear theory about a beam that rotation bends is never without a word on it."""

import csv
import io
import pickle
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.analyses.results.cautions import critical_label, labels_of, notes_of, warnings_of
from beamdyn.app.frequency_screen import FREQUENCIES
from beamdyn.common.edge.file_words import in_files, say
from beamdyn.common.edge.rendering import csv_text, html
from beamdyn.common.edge.views import rows_of
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.results.snapshots import decode, encode
from beamdyn.common.words import Named, Setting, Words
from beamdyn.scene.validity import warn_of_static_deflection
from beamdyn.studies.tradeoffs.measurements import Diagram
from beamdyn.studies.tradeoffs.tradeoff import tradeoff

EXAMPLE = bd.load_scene(Path(__file__).parents[2] / "examples" / "harvester_45deg.toml")
FLAT = replace(EXAMPLE.beam.section, poissons_ratio=0.0)  # sections do not camber: what matters is deflection
SCENE = replace(EXAMPLE, beam=EXAMPLE.beam.with_section(FLAT))
BENT = replace(SCENE, physics=bd.Physics(large_deflection=True))
INWARD = replace(SCENE, mount=replace(SCENE.mount, setting_angle=0.0))
ANALYSES = {
    "modes": lambda scene: bd.natural_modes(scene, 100.0, 1),
    "locus": lambda scene: bd.frequency_locus(scene, [0.0, 100.0], 1),
    "critical speed": bd.critical_speed,
    "resonances": lambda scene: bd.resonance_speeds(replace(scene, gravity=9.81, motion=WHEEL), 100.0, 1),
    "loads": lambda scene: bd.static_loads(scene, 100.0),
    "steady": lambda scene: bd.steady_response(replace(scene, motion=WHEEL), [100.0], 1),
}
WHEEL = bd.RollingWheel(
    rolling_radius=0.3,
    speed=bd.SpinUp(100.0, duration=1.0),
    road=bd.RoadWave(wavelength=0.3, velocity_amplitude=0.001),
)


@pytest.mark.parametrize("name", ANALYSES)
def test_python_warns_once_where_the_number_is_asked_for(name):
    with pytest.warns(bd.OutsideLinearTheory, match="outside linear theory.*auto") as said:
        ANALYSES[name](SCENE)
    (one,) = [w for w in said if w.category is bd.OutsideLinearTheory]
    assert one.filename == __file__


def test_analyses_of_the_plain_beam_warn_without_the_remedy_that_is_none_there():
    auto = replace(SCENE, physics="auto")
    analyse: Any
    for analyse in (bd.frequency_bounds, bd.setting_angle_limits):
        with pytest.warns(bd.OutsideLinearTheory) as said:
            analyse(auto, 100.0)
        assert len(said) == 1
        assert "auto" not in str(said[0].message)
        assert said[0].filename == __file__


def test_trade_off_says_how_far_the_model_is_off(monkeypatch):
    monkeypatch.setattr("beamdyn.studies.tradeoffs.tradeoff.physics_diagram", _nothing)
    monkeypatch.setattr("beamdyn.studies.tradeoffs.tradeoff.frequency_diagram", _nothing)
    with pytest.warns(bd.OutsideLinearTheory):
        result = tradeoff(SCENE, 100.0, 1, budget=1.0)
    assert any("the model error, 9.1 %, exceeds 1 %" in said for said in result.warnings)
    assert len(notes_of(result)) == 2


def _nothing(*given):
    return Diagram.make("nothing", "", "", 0.0, ())


def test_static_deflection_is_said_with_its_range_and_its_largest():
    speeds = np.array([50.0, 100.0, 150.0])
    (said,) = warn_of_static_deflection(np.array([0.05, -0.2, 79.0]), 1.0, speeds)
    assert said.startswith("from 100 rad/s on the rotation bends the tip by up to 79 lengths, at 150 rad/s")
    (said,) = warn_of_static_deflection(np.array([0.05, -0.2, np.nan]), 1.0, speeds)
    assert said.startswith("at 100 rad/s the rotation bends the tip by 0.2 of the length")


def test_model_error_is_among_the_warnings_of_files():
    modes = bd.natural_modes(SCENE, 100.0, 1)
    assert any("the model error, 9.1 %, exceeds 1 %" in said for said in modes.to_dict()["warnings"])


@pytest.mark.parametrize("scene", [BENT, INWARD], ids=["bent", "inward"])
@pytest.mark.parametrize("name", ["modes", "locus", "critical speed"])
def test_python_is_silent_within_the_theory(name, scene):
    with warnings.catch_warnings():
        warnings.simplefilter("error", bd.OutsideLinearTheory)
        ANALYSES[name](scene)


def test_picture_names_and_rows_state_the_model_error():
    modes, bent = bd.natural_modes(SCENE, 100.0, 1), bd.natural_modes(BENT, 100.0, 1)
    said = " ".join(notes_of(modes))
    assert "outside linear theory" in said and "+9.1 %" in said
    assert notes_of(bent) == ["with large deflection"]
    assert labels_of(modes) == ["mode 1: 55.62 Hz, model error 9.1 %"]
    assert labels_of(bent) == bent.labels()
    (row,) = csv.DictReader(io.StringIO(csv_text(rows_of(modes))))
    assert float(row["model_error"]) == modes.model_error[0]
    assert "Physics(" not in " ".join(warnings_of(modes))


def test_python_terms_become_keys_of_files():
    shear, locus = Setting("physics", shear=True, branch="bent"), Named("locus()", "beamdyn locus")
    said = Words(shear, "; ", locus, " finds")
    assert said == "Physics(shear=True, branch='bent'); locus() finds"
    assert in_files(said) == '[physics] shear = true, branch = "bent"; beamdyn locus finds'
    refused = InvalidValue("beam", 1.0, "it is stiff", Words("try ", shear))
    assert say(refused) == 'beam = 1: it is stiff; try [physics] shear = true, branch = "bent"'
    assert pickle.loads(pickle.dumps(said)).parts == decode(encode(said)).parts == said.parts


def test_critical_speed_of_a_bent_beam_is_called_what_it_is():
    point = bd.critical_point(SCENE)
    assert "were the beam straight" in critical_label(point)
    assert critical_label(bd.critical_point(INWARD)) == "critical speed"
    assert any("left out, is unknown" in said for said in warnings_of(point))


def test_branch_without_large_deflection_is_said_to_be_left_out():
    modes = bd.natural_modes(replace(SCENE, physics=bd.Physics(branch="bent")), 1.0, 1)
    assert any("large_deflection is off" in said for said in modes.warnings)


def test_screen_of_frequencies_warns_dims_and_notes():
    tables = {
        "beam": {
            "length": "50 mm", "width": "10 mm", "thickness": "0.2 mm",
            "youngs_modulus": "200 GPa", "density": "7850 kg/m3", "poissons_ratio": 0.0,
        },
        "mount": {"radius": "215 mm", "setting_angle": "45 deg"},
        "options": {"top_speed": "100 rad/s", "modes": 1.0},
    }  # fmt: skip
    answer = FREQUENCIES.solve(tables)
    page = html(FREQUENCIES.tables(answer))
    assert "left out at 100 rad/s: large deflection +9.1 %" in page
    assert 'class="beyond"' in page
    assert any("+9.1 %" in said for said in FREQUENCIES.notes(answer))
    assert "+9.1 %" in FREQUENCIES.draw(answer, 0.0).get_supxlabel().replace("\n", " ")
    chosen = FREQUENCIES.solve(tables | {"physics": {"auto": True}})
    assert "large deflection (9" in html(FREQUENCIES.tables(chosen))
    assert FREQUENCIES.draw(chosen, 0.0).get_supxlabel() == "with large deflection"
    rows = FREQUENCIES.sweeps.run(tables, "mount.setting_angle=0:45:2 deg", "frequency_1")
    assert rows.results == ("frequency_1", "model_error")
    assert rows.found[1][1] == pytest.approx(9.05, abs=0.1)
    assert "+9.1 %" in rows.warnings[0]
    assert np.isfinite(rows.found[0]).all()
