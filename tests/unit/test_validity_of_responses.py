"""Responses at a speed say of the rotation what natural modes there say: strain, static deflection."""

from __future__ import annotations

import numpy as np
import pytest

import beamdyn as bd

STRIP = bd.Beam.rectangular(0.05, 0.01, 2e-4, 2e11, 7850.0)
OUTWARD = bd.Scene(STRIP, bd.Mount(0.215, np.pi), damping_ratio=0.02)
ASKEW = bd.Scene(STRIP, bd.Mount(0.215, np.pi / 4), damping_ratio=0.02)
SHAKEN = bd.PowerSpectrum([1.0, 5000.0], [0.1, 0.1])
ASK = {
    "frequency_response": lambda scene, speed: bd.frequency_response(scene, speed, [10.0, 20.0], modes=2),
    "random_response": lambda scene, speed: bd.random_response(scene, speed, SHAKEN, modes=2),
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


@pytest.mark.parametrize("ask", ASK)
def test_nothing_is_said_of_a_slow_rotation(ask):
    said = " ".join(ASK[ask](OUTWARD, 10.0).warnings)
    assert "strain reaches" not in said and "bends the tip" not in said
