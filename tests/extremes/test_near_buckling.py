"""Just past buckling, rounding moves the bent equilibrium far: its stated error says so."""

from __future__ import annotations

from dataclasses import replace

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


def _equilibrium(beyond: float, basis: bd.Ritz) -> bd.Equilibrium:
    """Compute the bent equilibrium at a squared speed that exceeds the critical one by a relative amount."""
    critical = bd.equilibrium_branches(SCENE, 170.0).critical_speed
    return bd.equilibrium(SCENE, critical * (1 + beyond) ** 0.5, "bent", basis)
