"""Responses at a speed say of the rotation what natural modes there say: strain, static deflection."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.cli import main
from beamdyn.common.results.statements import unannounced

STRIP = bd.Beam.rectangular(0.05, 0.01, 2e-4, 2e11, 7850.0)
OUTWARD = bd.Scene(STRIP, bd.Mount(0.215, np.pi), damping_ratio=0.02)
ASKEW = bd.Scene(STRIP, bd.Mount(0.215, np.pi / 4), damping_ratio=0.02)
SKEWED = Path(__file__).parents[2] / "examples" / "harvester_45deg.toml"
SHAKEN = bd.PowerSpectrum([1.0, 5000.0], [0.1, 0.1])
ASK = {
    "frequency_response": lambda scene, speed: bd.frequency_response(scene, speed, [10.0, 20.0], modes=2),
    "random_response": lambda scene, speed: bd.random_response(scene, speed, SHAKEN, modes=2),
    "matrices": lambda scene, speed: bd.matrices(scene, speed, modes=2),
    "random_loads": lambda scene, speed: bd.random_loads(scene, speed, SHAKEN, at=[0.0], modes=2),
}


@pytest.mark.parametrize("ask", ASK)
@pytest.mark.parametrize(
    ("scene", "speed", "said"),
    [(OUTWARD, 2e4, "static axial strain reaches"), (ASKEW, 70.0, "the rotation bends the tip by")],
)
@pytest.mark.filterwarnings("ignore::beamdyn.OutsideLinearTheory")
def test_the_rotation_is_warned_of_as_by_modes(ask, scene, speed, said):
    (of_modes,) = (each for each in bd.natural_modes(scene, speed).warnings if said in each)
    assert of_modes in ASK[ask](scene, speed).warnings


def test_matrices_past_the_critical_speed_are_said_to_be_unstable_as_modes_are():
    scene = replace(ASKEW, mount=bd.Mount(0.215, np.pi / 8))
    with unannounced():
        found, full = bd.matrices(scene, 300.0, modes=2), bd.matrices(scene, 300.0, discretization="fem")
        of_modes = bd.natural_modes(scene, 300.0).warnings
    assert [said.replace("poles", "growth_rate") for said in found.warnings] == [*of_modes]
    assert full.warnings == found.warnings
    assert found.to_dict()["warnings"] == [*found.warnings, *found.model_warnings()]


def test_a_hinge_at_rest_is_not_unstable():
    hinged = replace(OUTWARD, mount=bd.Mount(0.215, np.pi, root_stiffness=0.0))
    assert bd.matrices(hinged, 0.0).warnings == ()


def test_the_command_warns_as_the_result_does(capsys):
    assert main(["matrices", str(SKEWED), "--speed", "100 rad/s", "--modes", "2"]) == 0
    assert "outside linear theory" in capsys.readouterr().err


@pytest.mark.parametrize("ask", [*ASK, "state_space"])
def test_python_warns_without_a_remedy_that_is_none_of_linear_models(ask):
    analyse = ASK.get(ask, lambda scene, speed: bd.state_space(scene, speed, modes=2))
    with pytest.warns(bd.OutsideLinearTheory) as said:
        analyse(ASKEW, 70.0)
    (one,) = said
    assert "auto" not in str(one.message)
    assert one.filename == __file__


@pytest.mark.filterwarnings("error::beamdyn.OutsideLinearTheory")
@pytest.mark.parametrize("ask", ASK)
def test_nothing_is_said_of_a_slow_rotation(ask):
    said = " ".join(ASK[ask](OUTWARD, 10.0).warnings)
    assert "strain reaches" not in said and "bends the tip" not in said
