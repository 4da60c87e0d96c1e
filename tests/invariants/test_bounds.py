"""Guaranteed bounds of frequencies enclose those of the power series, in random scenes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import legendre
from scipy.linalg import eigh

import beamdyn as bd
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.modes.bounds import frequency_bounds
from beamdyn.modes.flexibility import bound_flexibility, bound_reciprocal
from beamdyn.modes.residual_bound import PlaneEnclosure
from benchmarks.cases.enclosure import (
    NondimensionalScene,
    encloses,
    random_nondimensional_scene,
    relative_width,
)
from benchmarks.cases.scenes import HARVESTER


@pytest.mark.parametrize(
    "seed", [s if s < 10 else pytest.param(s, marks=pytest.mark.slow) for s in range(60)]
)
def test_bounds_enclose_the_exact_frequencies(seed: int) -> None:
    case = random_nondimensional_scene(np.random.default_rng(seed))
    found = frequency_bounds(case.scene, case.gamma, 3)
    assert encloses(found, case.exact(3)).all()
    assert np.isfinite(found.lower_squared).all()
    assert (relative_width(found) < 1e-6).all()


def test_bounds_are_tight_for_ordinary_scenes() -> None:
    for speed in (0.0, 50.0, 100.0, 150.0):
        assert (frequency_bounds(HARVESTER, speed).width < 1e-9).all()


@pytest.mark.parametrize("functions", [4, 6, 9])
@pytest.mark.parametrize("seed", range(5))
def test_bounds_of_small_bases_are_wide_but_hold(seed: int, functions: int) -> None:
    case = random_nondimensional_scene(np.random.default_rng(seed))
    lower, upper = _split(case, functions).bounds(3)
    exact = np.array([float(z) for z in case.exact(3)])
    assert (upper > exact).all()
    assert (np.isnan(lower) | (lower < exact)).all()


@pytest.mark.parametrize("seed", range(10))
def test_eigenvalues_of_the_neglected_functions_stay_below_their_traces(seed: int) -> None:
    case = random_nondimensional_scene(np.random.default_rng(seed))
    small, large = _split(case, 5), _split(case, 60)
    K, head = large.stiffness, np.arange(len(small.stiffness))  # functions of one span have the same numbers
    assert len(small.stiffness) <= len(K)
    tail = np.linalg.qr(K[:, head], mode="complete")[0][:, len(head) :]  # K-orthogonal to the head
    for part, bound in zip(large.forms, small.tails, strict=True):
        assert eigh(tail.T @ part @ tail, tail.T @ K @ tail, eigvals_only=True)[-1] <= bound


def _split(case: NondimensionalScene, functions: int) -> PlaneEnclosure:
    flexibility = bound_flexibility(case.scene.beam.bending_stiffness)
    return PlaneEnclosure(case.scene, functions, case.gamma, flexibility)


@pytest.mark.parametrize("stiffness", [(1.0,), (1.0, -0.9), (0.7, 0.1, -0.3, 0.2)])
def test_approximate_flexibility_is_barely_above_the_exact_one(stiffness: tuple[float, ...]) -> None:
    excess = np.array(bound_reciprocal(np.array(stiffness)))
    t = np.linspace(-1, 1, 1001)
    product = legendre.legval(t, stiffness) * legendre.legval(t, excess)
    assert (product >= 1).all()
    assert product.max() < 1 + 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(1000, 1040))  # benchmarks/bounds.py draws many more
def test_bounds_enclose_the_exact_frequencies_of_more_scenes(seed: int) -> None:
    case = random_nondimensional_scene(np.random.default_rng(seed))
    assert encloses(frequency_bounds(case.scene, case.gamma, 4), case.exact(4)).all()


def test_bounds_hold_with_a_breakpoint_where_nothing_changes() -> None:
    split = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, breakpoints=(0.3, 0.55))
    parts = frequency_bounds(replace(HARVESTER, beam=split), 50.0)
    whole = frequency_bounds(HARVESTER, 50.0)
    assert (parts.lower <= whole.upper).all()
    assert (whole.lower <= parts.upper).all()
    assert (parts.width < 1e-9).all()


def test_bounds_agree_with_the_modes_of_a_stepped_beam() -> None:
    steps = bd.Table((0, 0.4, 0.4, 0.7, 1), (4e-4, 4e-4, 3e-4, 3e-4, 2e-4))
    beam = bd.Beam.rectangular(0.1, 0.01, steps, 70e9, 2700.0, tip=bd.TipMass(2e-4, 1e-3, 3e-10))
    scene = bd.Scene(beam, bd.Mount(0.1, 2.0, 0.7))
    found, modes = frequency_bounds(scene, 60.0), bd.natural_modes(scene, 60.0)
    assert (found.width < 1e-8).all()
    assert (found.lower * (1 - modes.error) <= modes.frequency).all()
    assert (modes.frequency <= found.upper * (1 + modes.error)).all()


def test_an_unstable_mode_has_bounds_of_its_square() -> None:
    found = frequency_bounds(HARVESTER, 170.0)
    assert np.isnan([found.lower[0], found.upper[0]]).all()
    assert found.lower_squared[0] <= found.upper_squared[0] < 0
    assert "mode 1: unstable" in found.warnings[0]


def test_undecided_stability_is_warned_of() -> None:
    found = frequency_bounds(HARVESTER, bd.critical_speed(HARVESTER))
    assert found.lower_squared[0] < 0 < found.upper_squared[0]
    assert np.isnan(found.lower[0])
    assert "maybe unstable, because the bounds" in found.warnings[0]


def test_a_bound_that_cannot_be_guaranteed_is_missing() -> None:
    found = frequency_bounds(HARVESTER, 1e6)
    assert np.isnan(found.lower_squared).all()
    assert "no lower bound" in found.warnings[0]


def test_too_many_modes_are_refused() -> None:
    with pytest.raises(ValueError, match="give at most 196"):
        frequency_bounds(HARVESTER, 0.0, 200)


BLADE = bd.Beam.rectangular(
    1.0, 0.1, 0.03, 70e9, 2700.0, bd.TipMass(0.5, 0.02, 2e-3, 1.5e-3, 1e-3), poissons_ratio=0.3
)
TWISTED = replace(BLADE, twist=bd.Beam.rectangular(1, 0.1, 0.03, 70e9, 2700, twist=0.2).twist)
CONED = bd.Mount(0.1, np.pi, precone=0.1)


@pytest.mark.parametrize(
    "scene, speed, field",
    [
        (replace(HARVESTER, damping_ratio=0.01), 0.0, "damping_ratio"),
        (replace(HARVESTER, physics=bd.Physics(stretch=True)), 0.0, "physics.stretch"),
        (bd.Scene(BLADE, physics=bd.Physics(shear=True)), 0.0, "physics.shear"),
        (bd.Scene(BLADE, physics=bd.Physics(rotary_inertia=True)), 0.0, "physics.rotary_inertia"),
        (bd.Scene(BLADE, bd.Mount(root_stiffness=1.0)), 0.0, "root_stiffness"),
        (
            bd.Scene(BLADE, bd.Mount(second_root_stiffness=0.0), physics=bd.Physics(2)),
            0.0,
            "second_root_stiffness",
        ),
        (bd.Scene(TWISTED, CONED, physics=bd.Physics(2)), 1.0, "precone"),
        (bd.Scene(BLADE, CONED, physics=bd.Physics(2)), 1.0, "precone"),
    ],
)
def test_what_the_theorem_does_not_cover_is_refused_by_name(
    scene: bd.Scene, speed: float, field: str
) -> None:
    with pytest.raises(InvalidValue, match="bounds") as caught:
        frequency_bounds(scene, speed)
    assert caught.value.field == field and caught.value.remedy


@pytest.mark.parametrize("quarters", [0, 1, 3])
@pytest.mark.parametrize("bending", [0.0, np.pi / 2, -np.pi])
def test_bounds_of_two_planes_apart_enclose_the_modes(bending: float, quarters: int) -> None:
    """Also with sections that are turned by quarter turns, which exchanges the planes, tip body included."""
    twist = (
        bd.Beam.rectangular(1, 0.1, 0.03, 70e9, 2700, twist=quarters * np.pi / 2).twist if quarters else None
    )
    scene = bd.Scene(replace(BLADE, twist=twist), bd.Mount(0.3, np.pi, bending), physics=bd.Physics(planes=2))
    found, modes = frequency_bounds(scene, 150.0, 6), bd.natural_modes(scene, 150.0, 6)
    assert (found.width < 1e-9).all()
    assert (found.lower * (1 - modes.error) <= modes.frequency).all()
    assert (modes.frequency <= found.upper * (1 + modes.error)).all()


def test_at_rest_no_bending_angle_couples_the_planes() -> None:
    scene = bd.Scene(BLADE, bd.Mount(bending_angle=0.3), physics=bd.Physics(planes=2))
    found, modes = frequency_bounds(scene, 0.0, 4), bd.natural_modes(scene, 0.0, 4)
    assert (found.lower * (1 - modes.error) <= modes.frequency).all()
    assert (modes.frequency <= found.upper * (1 + modes.error)).all()
