"""Stated errors of frequencies with two planes, twist, shear, rotary inertia and springs cover the true ones.

The reference is collocation of the differential equations, which shares nothing with the package; its own
uncertainty, 2e-14 in most scenes, is allowed.  `benchmarks.stated_physics_errors` has 3000 scenes.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.sparse.linalg import ArpackNoConvergence

import beamdyn as bd
from beamdyn.modes.modal import large_parts
from benchmarks.cases.random_physics import random_still_scene
from benchmarks.cases.reference.resolved import known_frequencies
from benchmarks.stated_physics_errors import Answer, answer, cases, measure

SEED = 20  # of no run that an estimate was fitted to
OUTWARD = math.pi


def solve_and_compare(
    scene: bd.Scene, speed: float, tolerance: float | None = None, by: str = "ritz"
) -> Answer:
    found = answer(0, scene, speed, by, tolerance, known_frequencies(scene, speed, 5))
    assert not found.refusal and max(found.known) < 1e-11
    return found


@pytest.mark.parametrize("number", [0, 1, 3, 4, 5])
def test_random_scenes(number: int) -> None:
    for found in measure(number, SEED, "ritz", (1e-3, 1e-6)):
        assert not found.refusal
        assert found.covered.all(), (found.true, found.stated)
        assert np.max(found.stated) <= found.tolerance


def test_random_scenes_have_every_effect() -> None:
    scenes = [random_still_scene(np.random.default_rng([SEED, number])) for number in range(60)]
    assert {(s.physics.planes, s.physics.shear, s.physics.rotary_inertia) for s in scenes} == {
        (planes, shear, rotary) for planes in (1, 2) for shear in (False, True) for rotary in (False, True)
    }
    springs = [k for s in scenes for k in s.mount.root_stiffnesses]
    assert 0 in springs and math.inf in springs and any(0 < k < math.inf for k in springs)
    assert any(s.beam.tip for s in scenes) and any(len(s.beam.breakpoints) > 2 for s in scenes)
    assert any(s.beam.twist is not None and s.beam.twist.degree > 0 for s in scenes)


def twisted(ratio: float, springs: tuple[float, float] = (math.inf, math.inf)) -> bd.Scene:
    beam = bd.Beam.from_stiffness(
        1.0,
        Polynomial([1.0, -0.3]),
        Polynomial([1.0, -0.5]),
        second_bending_stiffness=ratio,
        twist=Polynomial([0.5, 0.4]),
        shear_stiffness=3e4,
        rotary_inertia=1e-5,
        second_rotary_inertia=1e-5 * ratio,
    )
    mount = bd.Mount(0.2, OUTWARD, 0.7, *springs)
    return bd.Scene(beam, mount, physics=bd.Physics(planes=2, shear=True, rotary_inertia=True))


@pytest.mark.parametrize("springs", [(math.inf, math.inf), (math.inf, 2.0)], ids=["clamped", "spring"])
@pytest.mark.parametrize("ratio", [1e2, 1e4])
@pytest.mark.parametrize("functions", [20, 34, 70])  # 70: more coordinates than are solved densely
def test_rounding_where_twist_leaves_little_of_a_stiff_plane(
    functions: int, ratio: float, springs: tuple[float, float]
) -> None:
    """Entries of the stiffness are as large as that of the stiff plane: 1e-12 is lost at a ratio of 1e4."""
    scene = twisted(ratio, springs)
    known = known_frequencies(scene, 5.0, 5)
    found = bd.natural_modes(scene, 5.0, 5, bd.Ritz(functions))
    true = np.abs(found.eigenvalue / known.eigenvalue - 1)
    assert (true <= found.error + known.uncertainty).all(), (true, found.error)
    assert found.error.max() < 1e-9


def test_an_iteration_that_does_not_converge_is_replaced(monkeypatch: pytest.MonkeyPatch) -> None:
    """As it happens with older versions of the library, in scenes that differ from version to version."""

    def fail(*_: object, **__: object) -> None:
        raise ArpackNoConvergence("No convergence", np.empty(0), np.empty(0))

    scene = twisted(30.0, (math.inf, math.inf))
    iterated = bd.natural_modes(scene, 5.0, 5, bd.Ritz(70))
    monkeypatch.setattr(large_parts, "eigsh", fail)
    dense = bd.natural_modes(scene, 5.0, 5, bd.Ritz(70))
    assert (dense.eigenvalue != iterated.eigenvalue).any()
    np.testing.assert_allclose(dense.eigenvalue, iterated.eigenvalue, rtol=1e-11)  # both errors


def test_a_hinge_at_rest_has_no_frequency() -> None:
    """It turns freely: no digits are stated of the rounding error that its frequency is."""
    found = solve_and_compare(twisted(30.0, (0.0, math.inf)), 0.0)
    assert found.covered.all() and found.true[0] == 0.0


@pytest.mark.slow
def test_finite_elements() -> None:
    found = solve_and_compare(twisted(30.0), 5.0, 1e-4, "fem")
    assert found.covered.all() and max(found.stated) <= 1e-4


def test_what_is_not_covered_is_seen() -> None:
    found = Answer(
        0, None, 0.0, stated=(1e-9, 1e-9, np.inf), true=(2e-9, 2e-9, np.inf), known=(0.0, 2e-9, 0.0)
    )
    np.testing.assert_array_equal(found.covered, [False, True, True])
    nothing = Answer(0, None, 0.0, stated=(np.nan, 1.0), true=(1e-9, np.nan), known=(0.0, 0.0))
    assert not nothing.covered.any()


def test_a_saved_run_goes_on(tmp_path: Path) -> None:
    path = tmp_path / "answers.jsonl"
    scenes = cases(SEED, tolerances=(1e-2,))
    first = scenes.resume(path, [7], workers=1)
    both = scenes.resume(path, [7, 13], workers=1)
    assert both[0] == first[0] and [a.number for a in both] == [7, 13] and scenes.load(path) == both
