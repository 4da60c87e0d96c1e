"""Near buckling, rounding moves the equilibrium far: its stated error says so."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from benchmarks.cases.scenes import HARVESTER

SCENE = replace(HARVESTER, physics=bd.Physics(large_deflection=True))


@pytest.mark.parametrize("functions", [14, 18, 22])
@pytest.mark.parametrize("beyond", [1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12])
def test_the_error_of_an_equilibrium_just_past_buckling_is_covered(functions: int, beyond: float) -> None:
    # The tip's deflection is as the root of the load beyond buckling: w = C d^(1/2) (1 - a d + ...).
    basis = bd.Ritz(functions)
    far = {d: abs(_equilibrium(d, basis).tip[1]) / d**0.5 for d in (1e-5, 1e-4)}
    slope = (far[1e-4] - far[1e-5]) / 9e-5
    expected = (far[1e-5] + slope * (beyond - 1e-5)) * beyond**0.5
    near = _equilibrium(beyond, basis)
    assert abs(abs(near.tip[1]) - expected) <= near.error
    assert near.error < 0.01 * abs(near.tip[1])


def test_the_error_of_an_equilibrium_next_to_buckling_under_a_tip_load_is_covered() -> None:
    # All these bases resolve the shape: their results differ by rounding alone.
    beam = HARVESTER.beam
    euler = np.pi**2 * float(beam.bending_stiffness(0.0)) / (2 * beam.length) ** 2
    load = bd.TipLoad(force=(-euler * (1 - 1e-7), 1e-9 * euler, 0.0))
    scene = replace(SCENE, mount=bd.Mount(radius=0.2, setting_angle=np.pi), tip_load=load)
    found = [bd.equilibrium(scene, 0.0, discretization=bd.Ritz(n)) for n in (12, 14, 16, 18, 20, 22, 24)]
    tips = np.array([each.tip[1] for each in found])
    assert np.ptp(tips) <= min(each.error for each in found) < 1e-8 * np.abs(tips).min()


def _equilibrium(beyond: float, basis: bd.Ritz) -> bd.Equilibrium:
    """Compute the bent equilibrium at a squared speed that exceeds the critical one by a relative amount."""
    critical = bd.equilibrium_branches(SCENE, 170.0).critical_speed
    return bd.equilibrium(SCENE, critical * (1 + beyond) ** 0.5, "bent", basis)
