"""What is given for a second plane of bending is named where one plane is modelled: results, and once."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.equations.assembly import assemble_equations
from benchmarks.cases.scenes import ROLLING

STRIP = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, bd.TipMass(0.001, 0.0, 1e-6), twist=0.3)
TWISTED = replace(ROLLING, beam=STRIP)
SPRING = replace(ROLLING, mount=replace(ROLLING.mount, second_root_stiffness=5.0))

ANALYSES: dict[str, Callable[[bd.Scene], Any]] = {
    "modes": lambda scene: bd.natural_modes(scene, 5.0, 1),
    "locus": lambda scene: bd.frequency_locus(scene, [0.0, 5.0], 1),
    "transient": lambda scene: bd.simulate(scene, 0.1, 2),
    "sweep": lambda scene: bd.sweep(scene, [5.0], (0.05, 0.1), modes=1),
    "resonances": lambda scene: bd.resonance_speeds(scene, 5.0, 1),
    "steady": lambda scene: bd.steady_response(scene, [5.0], 1),
}


@pytest.mark.parametrize("analysis", ANALYSES)
@pytest.mark.parametrize(("name", "scene"), [("twist", TWISTED), ("second_root_stiffness", SPRING)])
def test_results_name_what_one_plane_leaves_out(analysis: str, name: str, scene: bd.Scene) -> None:
    said = f"{name} is given, but physics.planes is 1: it is left out; Physics(planes=2) models it"
    assert ANALYSES[analysis](scene).warnings.count(said) == 1


def test_nothing_is_said_where_nothing_is_left_out() -> None:
    for scene in (ROLLING, replace(TWISTED, physics=bd.Physics(planes=2))):
        assert not any("planes" in text for text in bd.natural_modes(scene, 5.0, 1).warnings)


# Directions ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("direction", [5, -1, None])
def test_a_third_direction_is_refused(direction: Any) -> None:
    run, steady = bd.simulate(ROLLING, 0.1, 2), bd.steady_response(ROLLING, [5.0], 1)
    calls = [
        lambda: bd.natural_modes(ROLLING, 5.0, 1).shape([0.05], direction),
        lambda: run.shape([0.05], [0.05], direction),
        lambda: run.deflection([0.05], direction),
        lambda: run.peak(0.0, 0.1, direction),
        lambda: steady.tip(0.0, 0.0, direction),
        lambda: steady.largest_tip(direction),
    ]
    for k, call in enumerate(calls):
        if k != 3 or direction is not None:  # None is the peak of the magnitude
            with pytest.raises(ValueError, match=r"direction = .*give 0 for the direction of bending"):
                call()


# Loads and shares of the planes -------------------------------------------------------------------


@pytest.mark.parametrize("twist", [None, 0.3])
@pytest.mark.parametrize("psi", [0.0, 0.4, math.pi / 2])
def test_angular_loads_add_up_to_that_of_the_equations(psi: float, twist: float | None) -> None:
    """Oblique sections and an oblique body are tilted across the plane in which the carrier accelerates."""
    body = bd.TipMass(0.001, 0.002, inertia=1e-6, transverse_inertia=3e-7, axial_inertia=9e-7)
    beam = bd.Beam.rectangular(0.05, 0.01, 0.002, 200e9, 7850.0, body, twist=twist, poissons_ratio=0.3)
    physics = bd.Physics(planes=2, shear=True, rotary_inertia=True)
    equations = assemble_equations(bd.Scene(beam, bd.Mount(0.2, 0.3, psi), physics=physics), bd.Ritz(4))
    total = math.cos(psi) * equations.Q(0) - math.sin(psi) * equations.Q(1)
    expected = equations.vectors["acceleration"]
    np.testing.assert_allclose(total, expected, rtol=1e-13, atol=1e-14 * np.abs(expected).max())  # rounding


def test_shares_of_the_planes_add_up_beside_a_stretch() -> None:
    """The Coriolis coupling gives every mode some stretch, which is of neither plane."""
    scene = replace(TWISTED, physics=bd.Physics(planes=2, stretch=True))
    share = bd.natural_modes(scene, 2000.0, 3).plane_share
    np.testing.assert_allclose(share.sum(axis=1), 1.0, rtol=1e-14)


def test_provenance_tells_meshes_apart() -> None:
    assert repr(bd.Fem(20)) == "Fem(elements=20, mesh='graded')"
    assert str(bd.Fem(20)) == "20 finite elements"
    assert str(bd.Fem(20, "uniform", 1)) == "20 finite elements on a uniform mesh, at least 1 on each segment"
    assert str(bd.Fem(20)) != str(replace(bd.Fem(20), on_each=3))
