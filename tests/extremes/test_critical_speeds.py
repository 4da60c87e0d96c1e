"""Critical speeds where they are hard to see: high up, by a short bend at the tip, or not there at all.

The references are power series in mpmath (`exact_critical_speed`), which share nothing with beamdyn, and the
sign of the stiffness by rotation in a basis of 120 functions.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import beamdyn as bd
from beamdyn.common.results.statements import INPUT, OUTSIDE, kind_of
from beamdyn.modes.bounds import bound_critical_speed
from beamdyn.modes.buckling import decide_buckling
from beamdyn.modes.modal.model import Model
from benchmarks.cases.random_scenes import random_beam
from benchmarks.cases.reference.of_scene import exact_critical_speed
from benchmarks.cases.scenes import HARVESTER, steel_strip

POLYNOMIAL = np.polynomial.Polynomial

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
    assert point.none_below == point.speed
    bent = 1 if name == "nearly tangential" else 0  # by the rotation, long before: nothing else is doubtful
    assert [kind_of(said) == OUTSIDE for said in point.warnings] == bent * [True]


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


def doubts(point: bd.CriticalPoint) -> list[str]:
    """Warnings of a critical speed, but for those of what is given and not modelled."""
    return [said for said in point.warnings if kind_of(said) != INPUT]


def assert_within_errors(seed: int, discretization: str, tolerances: Sequence[float]) -> None:
    scene = mounted_at_random(np.random.default_rng(seed))
    solver = Model(scene, bd.Ritz(140)).solver
    for tolerance in tolerances:
        point = bd.critical_point(scene, discretization, tolerance)
        assert abs(point.speed / solver.critical_speed - 1) <= point.error + solver.critical_rounding
        assert point.error <= tolerance or point.warnings


@pytest.mark.parametrize("seed", [s if s != 149 else pytest.param(s, marks=pytest.mark.slow) for s in HARD])
def test_errors_cover_the_true_ones(seed: int) -> None:
    assert_within_errors(seed, "ritz", [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6])


@pytest.mark.parametrize("seed", HARD)
def test_errors_of_finite_elements_cover_the_true_ones(seed: int) -> None:
    assert_within_errors(seed, "fem", [1e-1, 1e-3])


@pytest.mark.parametrize("number", [20, pytest.param(60, marks=pytest.mark.slow)])
def test_the_argument_agrees_with_the_sign_in_a_large_basis(number: int) -> None:
    rng = np.random.default_rng(6)
    verdicts = []
    for _ in range(number):
        scene = mounted_at_random(rng)
        verdict = decide_buckling(scene).exists
        assert verdict == np.isfinite(Model(scene, bd.Ritz(120)).solver.critical_speed), scene
        verdicts.append(verdict)
    assert number / 6 < sum(verdicts) < number * 5 / 6


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


@pytest.mark.slow
def test_none_found_is_warned_of_with_how_far_it_was_looked() -> None:
    tip = bd.TipMass(1e-3, -1e-9)  # topples in a layer too thin for any basis
    scene = bd.Scene(replace(HARVESTER.beam, tip=tip))
    with pytest.warns(UserWarning, match=r"a critical speed exists \(.*topples.*certainly none below"):
        assert math.isinf(bd.critical_speed(scene))
    point = bd.critical_point(scene)
    assert 1e3 < point.none_below < 1e7 and math.isinf(point.error)


def test_a_given_basis_that_sees_none_says_so() -> None:
    point = bd.critical_point(TOPPLING, bd.Ritz(8))
    assert math.isinf(point.speed) and "with 8 Legendre functions" in point.warnings[0]
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


# Two planes, shear, rotary inertia, springs ---------------------------------------------------------

BODY = bd.TipMass(0.1, 0.05, 1e-3)
SECTION = bd.Beam.from_stiffness(
    1.0,
    POLYNOMIAL([1.0, -0.3]),
    POLYNOMIAL([1.0, -0.8]),
    second_bending_stiffness=POLYNOMIAL([4.0, -3.2]),
    rotary_inertia=1e-3,
    second_rotary_inertia=4e-3,
    shear_stiffness=300.0,
)
TWISTED = replace(
    SECTION, twist=bd.Beam.rectangular(1, 0.1, 0.01, 7e10, 2700, twist=POLYNOMIAL([0.1, 0.5])).twist
)
OUTWARD, INWARD = bd.Mount(1.0, math.pi, 0.4), bd.Mount(1.0, 0.0, 0.4)
INERTIA = {"rotary_inertia": True}


@pytest.mark.parametrize("physics", [bd.Physics(2), bd.Physics(shear=True), bd.Physics(2, shear=True)])
@pytest.mark.parametrize("springs", [(math.inf, math.inf), (0.3, 2.0), (2.0, 1e-6)])
@pytest.mark.parametrize("beam", [SECTION, TWISTED, replace(SECTION, tip=BODY)], ids=["", "twisted", "tip"])
def test_the_argument_agrees_beyond_slender_beams(beam, springs, physics) -> None:
    """Neither twist, shear nor springs change whether there is one: inward there is, outward not."""
    for mount in (OUTWARD, INWARD):
        scene = bd.Scene(beam, bd.Mount(1.0, mount.setting_angle, 0.4, *springs), physics=physics)
        found = bd.critical_point(scene)
        inward = mount is INWARD
        assert not doubts(found)
        assert math.isfinite(found.speed) is inward and found.error < 1e-9
        assert math.isfinite(Model(scene, bd.Ritz(24)).solver.critical_speed) is inward


@pytest.mark.parametrize("springs", [(1.0, math.inf), (1e-4, 1e-4), (1e-8, 3.0), (100.0, 1e3)])
@pytest.mark.parametrize("mount", [INWARD, bd.Mount(0.5, 0.0), bd.Mount(0.2, 1.0, 1.5)])
def test_critical_speed_on_springs_is_where_the_lowest_eigenvalue_vanishes(springs, mount) -> None:
    """Of K0 + omega^2 K2, both with the unit diagonal of K0; with k = 1e-8 it keeps half of its digits."""
    physics = bd.Physics(planes=2, shear=True)
    scene = bd.Scene(
        TWISTED, bd.Mount(mount.radius, mount.setting_angle, mount.bending_angle, *springs), physics=physics
    )
    model = Model(scene, bd.Ritz(20))
    pencil, speed = model.solver.pencil, model.solver.critical_speed
    scale = 1 / np.sqrt(np.diag(pencil.K0))

    def lowest(v: float) -> float:
        return float(np.linalg.eigvalsh(scale[:, None] * (pencil.K0 + v**2 * pencil.K2) * scale)[0])

    assert lowest(speed * (1 - 1e-3)) > 0 > lowest(speed * (1 + 1e-3))
    root = brentq(lowest, speed * (1 - 1e-3), speed * (1 + 1e-3), xtol=1e-12 * speed, rtol=1e-12)
    assert speed == pytest.approx(root, rel=1e-7)


@pytest.mark.parametrize("stiffness", [1e-12, 1e-6, 1e-3, 1.0])
def test_a_turn_in_the_plane_about_the_axis_is_not_softened(stiffness: float) -> None:
    """The stiffness by rotation of that turn is a difference that vanishes but for rounding."""
    scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0), bd.Mount(root_stiffness=stiffness))
    assert math.isinf(Model(scene, bd.Ritz(20)).solver.critical_speed)
    assert math.isinf(bd.critical_point(scene).none_below)


@pytest.mark.parametrize("stiffness", [1e-3, 1e-6, 1e-10, 1e-13])
@pytest.mark.parametrize("elements", ["fem", bd.Fem(20)])
def test_errors_of_elements_on_soft_springs_cover_the_true_ones(stiffness: float, elements: Any) -> None:
    """What rounding leaves of the integrals of elements is as large as the springs."""
    scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0), bd.Mount(1.0, root_stiffness=stiffness))
    exact, found = bd.critical_point(scene), bd.critical_point(scene, elements)
    # A straight turn in the plane is softened by a S_1 = 1/2; bending adds terms of the order of k.
    assert exact.speed == pytest.approx(math.sqrt(2 * stiffness), rel=stiffness + 1e-12)
    assert not math.isnan(found.speed)
    if math.isfinite(found.error):
        assert abs(found.speed / exact.speed - 1) <= found.error + exact.error
    else:
        assert found.warnings and isinstance(elements, bd.Fem)


@pytest.mark.parametrize("physics", [bd.Physics(), bd.Physics(2), bd.Physics(2, True, True)])
def test_an_inward_beam_on_a_hinge_is_unstable_at_every_speed(physics: bd.Physics) -> None:
    scene = bd.Scene(TWISTED, bd.Mount(0.3, 0.0, 0.0, 0.0), physics=physics)
    point = bd.critical_point(scene)
    assert (point.speed, point.error, point.none_below) == (0.0, 0.0, 0.0) and "hinge" in point.reason
    assert bd.natural_modes(scene, 1e-3, 1, bd.Ritz(20)).status[0] == "divergence"


@pytest.mark.parametrize("bending", [0.0, math.pi / 2])
@pytest.mark.parametrize("radius", [0.0, 0.7])
def test_an_outward_beam_on_a_hinge_has_no_critical_speed(radius: float, bending: float) -> None:
    scene = bd.Scene(TWISTED, bd.Mount(radius, math.pi, bending, 0.0, 0.0), physics=bd.Physics(planes=2))
    point = bd.critical_point(scene)
    assert math.isinf(point.none_below) and ("but a turn" in point.reason) is (radius == 0)


SLENDER_STEEL = bd.Beam.rectangular(1.0, 0.05, 0.01, 210e9, 7850.0, poissons_ratio=0.3)


@pytest.mark.parametrize("springs", [(math.inf, math.inf), (500.0, math.inf), (0.0, math.inf)])
@pytest.mark.parametrize(
    "physics", [bd.Physics(2, **INERTIA), bd.Physics(2, True, True), bd.Physics(1, True, True)]
)
@pytest.mark.parametrize("twisted", [False, True])
def test_rotary_inertia_buckles_no_ordinary_blade(twisted: bool, physics: bd.Physics, springs) -> None:
    """The bound is beyond what stretches steel by 1 %: rho omega^2 L^2 / (2 E) without hub."""
    twist = TWISTED.twist if twisted else None
    mount = bd.Mount(0.2, math.pi, math.pi / 2, *springs)
    point = bd.critical_point(bd.Scene(replace(SLENDER_STEEL, twist=twist), mount, physics=physics))
    assert math.isinf(point.speed) and point.error == 0 and not doubts(point)
    assert "rotary inertia" in point.reason
    assert math.sqrt(2 * 0.01 * 210e9 / 7850) < point.none_below < math.inf


def test_rotary_inertia_in_the_plane_of_rotation_changes_nothing() -> None:
    """No section tilts out of the plane, and its own spin does not soften it."""
    for mount in (bd.Mount(1.0, math.pi), bd.Mount(1.0, 0.0)):
        slender, thick = (
            bd.critical_point(bd.Scene(SECTION, mount, physics=physics))
            for physics in (bd.Physics(), bd.Physics(rotary_inertia=True))
        )
        assert thick.speed == pytest.approx(slender.speed, rel=1e-12) and thick.reason == slender.reason


def thick_at_random(rng: np.random.Generator) -> bd.Scene:
    """A short outward beam with all of the inertias, on clamp, spring or hinge."""
    h, q = rng.uniform(0.05, 0.3), rng.uniform(0.3, 6)
    body = bd.TipMass(
        rng.uniform(0, 0.2), rng.uniform(0, 0.1), *(rng.uniform(0.01, 0.019, 3) * 10 ** rng.uniform(-3, 0))
    )
    beam = bd.Beam.from_stiffness(
        1.0,
        POLYNOMIAL([1.0, -0.3]),
        POLYNOMIAL([1.0, -0.8]),
        second_bending_stiffness=POLYNOMIAL([q, -0.8 * q]),
        rotary_inertia=h**2 * rng.uniform(0.1, 1),
        second_rotary_inertia=h**2 * q,
        shear_stiffness=1 / h**2,
        twist=POLYNOMIAL(rng.uniform(-1, 1, 2)) if rng.random() < 0.5 else None,
        tip=body if rng.random() < 0.5 else None,
    )
    springs = (rng.choice([math.inf, 0.0, 10 ** rng.uniform(-2, 2)]) for _ in range(2))
    mount = bd.Mount(rng.uniform(0, 2), math.pi, rng.choice([0, math.pi / 2, rng.uniform(-3, 3)]), *springs)
    physics = bd.Physics(int(rng.integers(1, 3)), bool(rng.random() < 0.5), rotary_inertia=True)
    return bd.Scene(beam, mount, physics=physics)


def test_nothing_topples_below_the_bound() -> None:
    """A basis of 60 functions has its critical speed above the exact one, and so above the bound."""
    rng, closest = np.random.default_rng(1), math.inf
    for _ in range(40):
        scene = thick_at_random(rng)
        critical, decided = Model(scene, bd.Ritz(60)).solver.critical_speed, decide_buckling(scene)
        bound = math.inf if decided.exists is False else decided.none_below
        assert bound <= critical
        closest = min(closest, critical / bound if 0 < bound < math.inf else math.inf)
    assert closest < 5  # the bounds are not empty


@pytest.mark.slow
def test_none_below_of_two_planes_apart_is_the_lower_of_both() -> None:
    tip = bd.TipMass(1e-3, -1e-9)  # topples in a layer too thin for any basis
    beam = replace(HARVESTER.beam, tip=tip)
    both, *single = (
        bd.critical_point(bd.Scene(beam, bd.Mount(bending_angle=psi), physics=bd.Physics(planes)))
        for psi, planes in ((0.0, 2), (0.0, 1))
    )
    assert math.isinf(both.error) and both.none_below == single[0].none_below > 1e3


@pytest.mark.parametrize(
    "inertia, mass, chain, rtol",
    [(0.3, 1.0, 5.2674, 1e-5), (1.0, 1.0, 1.7893, 3e-5), (0.05, 1e-3, 7.0411, 1e-4)],
)
def test_heavy_sections_topple_a_long_bend(inertia: float, mass: float, chain: float, rtol: float) -> None:
    """A slender rod with discs buckles at a strain of 1e-5; values by a chain of up to 80 rigid bodies.

    The tolerance is the chain's: half a unit of its last digit, or its distance from its limit.
    """
    beam = bd.Beam.from_stiffness(1.0, mass, 1.0, rotary_inertia=inertia)
    scene = bd.Scene(beam, bd.Mount(0.0, np.pi, np.pi / 2), physics=bd.Physics(rotary_inertia=True))
    point = bd.critical_point(scene)
    assert point.speed == pytest.approx(chain, rel=rtol) and point.error < 1e-9
    below, above = (bd.natural_modes(scene, factor * point.speed, 1).status[0] for factor in (0.999, 1.001))
    assert (below, above) == ("stable", "divergence")
