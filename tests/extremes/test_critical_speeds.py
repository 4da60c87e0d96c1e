"""Critical speeds where they are hard to see: high up, by a short bend at the tip, or not there at all.

The references are power series in mpmath (`exact_critical_speed`), which share nothing with beamdyn, and the
sign of the stiffness by rotation in a basis of 120 functions.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.modal.model import Model
from beamdyn.spectrum.bounds import bound_critical_speed
from beamdyn.spectrum.buckling import decide_buckling
from benchmarks.cases.random_scenes import random_beam
from benchmarks.cases.reference.of_scene import exact_critical_speed
from benchmarks.cases.scenes import HARVESTER, steel_strip

TOPPLING = bd.Scene(
    bd.Beam.from_stiffness(
        1.0, 1.0, 1.0, tip=bd.TipMass(0.00713906, -0.00949844, 0.000923927, 0.00080495, 0.000375134)
    )
)
TANGENTIAL = replace(HARVESTER, mount=replace(HARVESTER.mount, setting_angle=math.radians(89.9)))
# By exact_critical_speed, which takes 16 s for the first.
HIGH = {
    "toppling tip body": (TOPPLING, 1489.55707427074),
    "nearly tangential": (TANGENTIAL, 22131.6785767335),
}
TOLERANCES = [None, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6]


def test_the_reference_of_the_nearly_tangential_harvester() -> None:
    assert float(exact_critical_speed(TANGENTIAL, digits=15)) == pytest.approx(
        HIGH["nearly tangential"][1], rel=1e-14
    )


@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("name", HIGH)
def test_a_high_critical_speed_is_found_within_its_error(name: str, tolerance: float | None) -> None:
    scene, expected = HIGH[name]
    point = bd.critical_point(scene, tolerance=tolerance)
    assert abs(point.speed / expected - 1) <= point.error <= (tolerance or 1e-9)
    assert point.none_below == point.speed and not point.warnings


@pytest.mark.parametrize("tolerance", [None, 1e-1, 1e-2, 1e-3])
@pytest.mark.parametrize("name", HIGH)
def test_finite_elements_find_it_too(name: str, tolerance: float | None) -> None:
    scene, expected = HIGH[name]
    point = bd.critical_point(scene, "fem", tolerance)
    assert abs(point.speed / expected - 1) <= point.error
    assert point.error <= (tolerance or 1e-6) or point.warnings


def mounted_at_random(rng: np.random.Generator) -> bd.Scene:
    """Any direction, half of them nearly tangential; the root up to ten lengths from the axis."""
    beam = random_beam(rng)
    nearly_tangential = np.pi / 2 + 10 ** rng.uniform(-4, -0.5) * rng.choice([-1, 1])
    return bd.Scene(
        beam,
        bd.Mount(
            radius=beam.length * rng.choice([0.0, rng.uniform(0, 10), 10 ** rng.uniform(-2, 1)]),
            setting_angle=rng.choice([nearly_tangential, rng.uniform(-np.pi, np.pi)]),
            bending_angle=rng.choice([0.0, np.pi / 2, rng.uniform(-np.pi, np.pi)]),
        ),
    )


# Some of the seeds to 400 with a critical speed that a basis of ten functions does not see or understates.
HARD = (40, 149, 169, 225, 244, 326, 369)


def assert_within_errors(seed: int, discretization: str, tolerances: Sequence[float]) -> None:
    scene = mounted_at_random(np.random.default_rng(seed))
    solver = Model(scene, bd.Ritz(140)).solver
    for tolerance in tolerances:
        point = bd.critical_point(scene, discretization, tolerance)
        assert abs(point.speed / solver.critical_speed - 1) <= point.error + solver.critical_rounding
        assert point.error <= tolerance or point.warnings


@pytest.mark.parametrize("seed", HARD)
def test_errors_cover_the_true_ones(seed: int) -> None:
    assert_within_errors(seed, "ritz", [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6])


@pytest.mark.parametrize("seed", HARD)
def test_errors_of_finite_elements_cover_the_true_ones(seed: int) -> None:
    assert_within_errors(seed, "fem", [1e-1, 1e-3])


def test_the_argument_agrees_with_the_sign_in_a_large_basis() -> None:
    rng = np.random.default_rng(6)
    verdicts = []
    for _ in range(60):
        scene = mounted_at_random(rng)
        verdict = decide_buckling(scene).exists
        assert verdict == np.isfinite(Model(scene, bd.Ritz(120)).solver.critical_speed), scene
        verdicts.append(verdict)
    assert 10 < sum(verdicts) < 50


@pytest.mark.parametrize(
    "scene",
    [
        steel_strip(),
        steel_strip(hub=3.0),
        steel_strip(hub=3.0, bending=1.0),
        steel_strip(hub=1.0, setting=math.pi / 2),
        steel_strip(hub=0.4, setting=0.0, bending=math.pi / 2),
        steel_strip(tip=1e6),
        replace(HARVESTER, beam=replace(HARVESTER.beam, tip=bd.TipMass(0.01, 0.002, 1e-7)), mount=bd.Mount()),
    ],
)
def test_none_is_an_argument(scene: bd.Scene) -> None:
    for discretization in ("ritz", "fem", bd.Ritz(5)):
        point = bd.critical_point(scene, discretization)
        assert (point.speed, point.error, point.none_below, point.warnings) == (math.inf, 0.0, math.inf, ())
        assert "stiffens" in point.reason


def test_a_tip_body_behind_the_end_topples_and_one_before_it_does_not() -> None:
    """A point mass inboard by any distance makes the tip unstable, whatever the stiffness."""
    for offset, exists in ((-1e-6, True), (0.0, False), (1e-6, False)):
        beam = replace(HARVESTER.beam, tip=bd.TipMass(0.01, offset))
        assert decide_buckling(bd.Scene(beam)).exists is exists


def test_none_found_is_warned_of_with_how_far_it_was_looked() -> None:
    tip = bd.TipMass(1e-3, -1e-7)  # topples in a layer too thin for any basis
    scene = bd.Scene(replace(HARVESTER.beam, tip=tip))
    with pytest.warns(UserWarning, match=r"a critical speed exists \(.*topples.*certainly none below"):
        assert math.isinf(bd.critical_speed(scene))
    point = bd.critical_point(scene)
    assert 1e3 < point.none_below < 1e7 and math.isinf(point.error)


def test_a_given_basis_that_sees_none_says_so() -> None:
    point = bd.critical_point(TOPPLING, bd.Ritz(8))
    assert math.isinf(point.speed) and "Ritz(functions=8" in point.warnings[0]
    assert 100 < point.none_below < HIGH["toppling tip body"][1]


def test_guaranteed_bound_is_below_the_critical_speed_and_close() -> None:
    rng = np.random.default_rng(7)
    for _ in range(20):
        scene = mounted_at_random(rng)
        exact = Model(scene, bd.Ritz(100)).solver
        bound = bound_critical_speed(scene)
        assert 0 < bound <= exact.critical_speed * (1 + exact.critical_rounding)
    assert 0.999 < bound_critical_speed(TANGENTIAL) / HIGH["nearly tangential"][1] < 1


def test_stretch_has_a_critical_speed_of_its_own() -> None:
    """K_S - omega^2 M11 of a uniform rod is singular at pi/2 sqrt(EA / rho A) / L."""
    point = bd.critical_point(replace(steel_strip(hub=1.0), physics=bd.Physics(stretch=True)))
    assert point.speed == pytest.approx(math.pi / 2 * math.sqrt(200e9 / 7850), rel=1e-12)
    assert "softens the stretch" in point.reason and not point.warnings


def test_bending_is_found_below_the_critical_speed_of_stretch() -> None:
    """A basis that resolves the stretch sees no bending that buckles, at a seventh of its speed."""
    for tolerance in (None, 1e-2):
        point = bd.critical_point(replace(TANGENTIAL, physics=bd.Physics(stretch=True)), tolerance=tolerance)
        assert abs(point.speed / HIGH["nearly tangential"][1] - 1) <= point.error <= (tolerance or 1e-9)
        assert "softens the beam" in point.reason
