"""Assumed modes by moments: the same limits where properties have kinks, jumps and twist."""

from __future__ import annotations

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.scene.profile import to_profile
from benchmarks.cases.random_stations import random_station_scene
from benchmarks.cases.reference.resolved import known_frequencies

STATIONS = [0.0, 0.1, 0.15, 0.3, 0.3, 0.45, 0.6, 0.8, 0.95, 1.0]
VALUES = np.array([3.0, 2.5, 1.0, 1.2, 0.7, 0.8, 0.4, 0.3, 0.1, 0.05])


def table(values: np.ndarray) -> bd.Table:
    return bd.Table(STATIONS, values.tolist())


BEAM = bd.Beam.from_stiffness(
    2.0,
    table(VALUES**0.5),
    table(VALUES),
    second_bending_stiffness=table(5 * VALUES**0.7),
    axial_stiffness=table(3e3 * VALUES),
    shear_stiffness=table(1e3 * VALUES),
    rotary_inertia=table(2e-3 * VALUES),
    second_rotary_inertia=table(5e-3 * VALUES),
    twist=bd.Table([0.0, 0.3, 1.0], [0.4, 0.3, -0.1]),
    tip=bd.TipMass(0.1, 0.05, 1e-3),
)
MOUNT = bd.Mount(0.3, math.pi, math.pi / 2)
PLAIN = bd.Scene(replace(BEAM, twist=None), MOUNT)
TURNING = bd.Scene(
    replace(BEAM, twist=None, torsion_stiffness=to_profile("torsion_stiffness", table(VALUES / 50))),
    MOUNT,
    physics=bd.Physics(torsion=True),
)
SCENES = {
    "one plane": PLAIN,
    "in the plane, inward": replace(PLAIN, mount=bd.Mount(0.3, 0.0, 0.0)),
    "on a spring": replace(PLAIN, mount=bd.Mount(0.3, math.pi, 0.0, root_stiffness=2.0)),
    "shear and rotary inertia": replace(PLAIN, physics=bd.Physics(shear=True, rotary_inertia=True)),
    "stretch": replace(PLAIN, physics=bd.Physics(stretch=True), mount=bd.Mount(0.3, math.pi, 0.0)),
    "torsion": TURNING,
    "twisted": bd.Scene(BEAM, MOUNT, physics=bd.Physics(planes=2)),
    "twisted, all": bd.Scene(BEAM, MOUNT, physics=bd.Physics(planes=2, shear=True, rotary_inertia=True)),
}


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES.keys())
def test_limits_are_those_of_functions_on_each_segment(scene: bd.Scene) -> None:
    functions = 70 if scene.physics.torsion else 60  # bending and torsion share the modes
    expected = bd.natural_modes(scene, 0.8, 4, bd.Ritz(12))
    found = bd.natural_modes(scene, 0.8, 4, bd.Ritz(functions, "moments"))
    difference = np.abs(found.eigenvalue / expected.eigenvalue - 1)
    assert (difference <= found.error + expected.error).all(), (difference, found.error, expected.error)
    assert found.error.max() < 1e-9
    np.testing.assert_allclose(found.tip, expected.tip, rtol=1e-6, atol=1e-6)  # modes err by the root


@pytest.mark.slow
@pytest.mark.parametrize("number", [1, 7, 17, 19])
def test_stated_errors_of_random_stations(number: int) -> None:
    scene, speed = random_station_scene(np.random.default_rng([16, number]))
    known = known_frequencies(scene, speed, 3)
    for tolerance in (1e-3, 1e-6, None):
        found = bd.natural_modes(scene, speed, 3, tolerance=tolerance)
        assert "moments" in found.provenance.method
        true = np.abs(found.eigenvalue / known.eigenvalue - 1)
        assert (true <= found.error + known.uncertainty).all(), (tolerance, true, found.error)


def test_stated_errors_of_a_fast_blade_of_steps_at_loose_tolerance() -> None:
    """At nine times its first frequency at rest; with 12 functions, the stated error was 0.6 of the true."""
    rng, stations = np.random.default_rng(62), np.repeat(np.linspace(0, 1, 19), 2)[1:-1]

    def falling(decades: float) -> bd.Table:
        rough = np.exp(0.5 * rng.standard_normal(len(stations)))
        return bd.Table(stations.tolist(), (10 ** (-decades * stations) * rough).tolist())

    mass, stiffness = (falling(rng.uniform(0, most)) for most in (3.0, 8.0))
    scene = bd.Scene(bd.Beam.from_stiffness(1.0, mass, stiffness), bd.Mount(0.2, math.pi, math.pi / 2))
    speed = 9 * float(np.abs(bd.natural_modes(scene, modes=1).eigenvalue[0]))
    known = known_frequencies(scene, speed, 3)
    found = bd.natural_modes(scene, speed, 3, tolerance=0.1)
    assert "moments" in found.provenance.method
    true = np.abs(found.eigenvalue / known.eigenvalue - 1)
    assert (true <= found.error + known.uncertainty).all(), (true, found.error)


@pytest.mark.parametrize("scene", [SCENES["one plane"], SCENES["twisted"]], ids=["one plane", "twisted"])
def test_eigenvalues_are_upper_bounds(scene: bd.Scene) -> None:
    best = bd.natural_modes(scene, 0.8, 4, bd.Ritz(60, "moments"))
    for functions in (8, 12, 20):
        found = bd.natural_modes(scene, 0.8, 4, bd.Ritz(functions, "moments"))
        assert (found.frequency > best.frequency * (1 - 1e-13)).all()  # rounding


def test_smoothing_by_inertia_and_tension() -> None:
    """Polynomials alone would leave 1e-8 even with 60 moments."""
    found = bd.natural_modes(PLAIN, 0.8, 3, bd.Ritz(24, "moments"))
    expected = bd.natural_modes(PLAIN, 0.8, 3, bd.Ritz(12))
    np.testing.assert_allclose(found.frequency, expected.frequency, rtol=1e-9)  # measured: some 1e-11


def test_smoothing_of_torques_by_polar_inertia() -> None:
    """Polynomials alone, or torques by the mass, would leave 6e-7 in torsion."""
    found = bd.natural_modes(TURNING, 0.8, 3, bd.Ritz(24, "moments"))
    expected = bd.natural_modes(TURNING, 0.8, 3, bd.Ritz(12))
    np.testing.assert_allclose(found.frequency, expected.frequency, rtol=1e-7)  # measured: 2e-8


def test_stiffness_that_falls_by_eight_decades() -> None:
    """Cells are halved until they resolve 1/EI: one segment is as good as a stiffness of many."""
    beam = bd.Beam.from_stiffness(1.0, 1.0, Polynomial([1.0, -1.0 + 1e-8]))
    scene = bd.Scene(beam, bd.Mount(0.0, math.pi, math.pi / 2))
    found = bd.natural_modes(scene, 3.0, 3, bd.Ritz(40, "moments"))
    known = known_frequencies(scene, 3.0, 3)
    true = np.abs(found.eigenvalue / known.eigenvalue - 1)
    assert (true <= found.error + known.uncertainty).all() and found.error.max() < 1e-9


def test_modes_are_pickled_with_their_functions() -> None:
    modes = bd.natural_modes(PLAIN, 0.8, 2, bd.Ritz(20, "moments"))
    again = pickle.loads(pickle.dumps(modes))
    x = np.linspace(0, 2.0, 7)
    np.testing.assert_array_equal(again.shape(x), modes.shape(x))
