"""Guaranteed bounds of blades with planes that the twist or the mount couples: never violated, narrow."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.linalg import eigh

import beamdyn as bd
from beamdyn.modes.bounds import _nondimensional, frequency_bounds
from beamdyn.modes.flexibility import bound_flexibility
from beamdyn.modes.residual_bound import CoupledEnclosure
from beamdyn.modes.ritz_part import twist_degree
from benchmarks.cases.blades import blade_scene
from benchmarks.cases.random_stations import random_station_scene
from benchmarks.cases.reference.resolved import Known, known_frequencies

_RATED = {"iea_15": 7.56, "nrel_5": 12.1, "bmodes_test01": 60.0}  # rpm, of the turbines
_BODY = bd.TipMass(0.5, 0.1, 0.03, 0.05, 0.04)  # with moments that differ


def _random_blade(seed: int) -> tuple[bd.Scene, float]:
    """A blade of up to 8 stations with strong twist, half with jumps, some inward or with a tip body."""
    rng = np.random.default_rng(seed)
    inner = np.sort(rng.uniform(0.05, 0.95, rng.integers(0, 7)))
    places = np.sort([0.0, 1.0, *inner, *(inner[::4] if rng.random() < 0.5 else ())])
    distinct = np.unique(places)

    def table(low: float, high: float) -> bd.Table:
        return bd.Table(places.tolist(), np.exp(rng.uniform(low, high, len(places))).tolist())

    twist = bd.Table(distinct.tolist(), np.cumsum(rng.uniform(-0.4, 0.4, len(distinct))).tolist())
    tip = bd.TipMass(10 ** rng.uniform(-2, 0), rng.uniform(-0.1, 0.2), *rng.uniform(0.02, 0.04, 3))
    beam = bd.Beam.from_stiffness(
        1.0,
        table(-1, 0),
        table(-2, 0),
        second_bending_stiffness=table(-1, 3),
        twist=twist,
        tip=tip if rng.random() < 0.4 else None,
    )
    mount = bd.Mount(rng.uniform(0, 2), float(rng.choice([0.0, np.pi])), rng.uniform(-2, 2))
    return bd.Scene(beam, mount, physics=bd.Physics(planes=2)), float(rng.uniform(0, 6))


@cache
def _known(seed: int) -> Known:
    return known_frequencies(*_random_blade(seed), 3)


def _squares(known: Known) -> np.ndarray:
    return -np.real(known.eigenvalue**2)


def _assert_between(lower: np.ndarray, upper: np.ndarray, known: Known) -> None:
    """The second method's squares lie between bounds, or as near to them as it is uncertain (1e-13)."""
    squares = _squares(known)[: len(lower)]
    slack = 2 * known.uncertainty[: len(lower)] * np.abs(squares)
    assert (np.isnan(lower) | (lower - slack <= squares)).all()
    assert (squares <= upper + slack).all()


def _split(scene: bd.Scene, speed: float, moments: int) -> tuple[CoupledEnclosure, float]:
    scaled, time = _nondimensional(scene)
    assert scaled.beam.second_bending_stiffness is not None
    first = bound_flexibility(scaled.beam.bending_stiffness)
    second = bound_flexibility(scaled.beam.second_bending_stiffness)
    assert first is not None and second is not None
    return CoupledEnclosure(scaled, moments, speed * time, (first, second)), time


@pytest.mark.parametrize("seed", [s if s < 8 else pytest.param(s, marks=pytest.mark.slow) for s in range(50)])
def test_bounds_of_random_twisted_blades_enclose_the_second_method(seed: int) -> None:
    scene, speed = _random_blade(seed)
    found = frequency_bounds(scene, speed, 3)
    _assert_between(found.lower_squared, found.upper_squared, _known(seed))
    size = np.abs(_squares(_known(seed))) + speed**2  # which the squared frequency is the difference of
    assert (found.upper_squared - found.lower_squared < 1e-6 * size).all()


@pytest.mark.parametrize("moments", [3, 5, 8])
@pytest.mark.parametrize("seed", range(12))
def test_bounds_of_few_moments_are_wide_but_hold(seed: int, moments: int) -> None:
    split, time = _split(*_random_blade(seed), moments)
    lower, upper = (found / time**2 for found in split.bounds(3))
    _assert_between(lower, upper, _known(seed))


def test_bounds_of_few_moments_are_not_all_missing() -> None:
    lower = np.array([_split(*_random_blade(seed), 5)[0].bounds(3)[0] for seed in range(12)])
    assert np.isfinite(lower[:, 0]).sum() >= 6


@pytest.mark.parametrize("share", [0.0, 1.0])
@pytest.mark.parametrize("name", _RATED)
def test_bounds_of_the_public_blades_are_present_and_narrow(name: str, share: float) -> None:
    scene, speed = blade_scene(name), share * _RATED[name] * math.pi / 30
    found, modes = frequency_bounds(scene, speed, 6), bd.natural_modes(scene, speed, 6)
    assert (found.width < 1e-8).all()  # the allowance for rounding is 2e-9
    assert not found.warnings
    assert (found.lower <= modes.frequency * (1 + 2 * modes.error)).all()
    assert (modes.frequency * (1 - 2 * modes.error) <= found.upper).all()


@pytest.mark.parametrize("seed", [1, 2, 20])  # also stiffnesses that fall by seven decades
def test_bounds_of_blades_of_many_stations_are_narrow_and_hold(seed: int) -> None:
    scene, speed = random_station_scene(np.random.default_rng(seed))
    x = np.linspace(0, 1, 9)
    twist = bd.Beam.from_stiffness(
        1, 1, 1, second_bending_stiffness=1, twist=bd.Table(x.tolist(), (0.4 * (1 - x) ** 2).tolist())
    ).twist
    scene = replace(scene, beam=replace(scene.beam, twist=twist), physics=bd.Physics(planes=2))
    found, modes = frequency_bounds(scene, speed, 4), bd.natural_modes(scene, speed, 4)
    assert (found.width < 1e-7).all()
    assert (found.lower <= modes.frequency * (1 + 2 * modes.error)).all()
    assert (modes.frequency * (1 - 2 * modes.error) <= found.upper).all()


@pytest.mark.parametrize("moments", [3, 6])
@pytest.mark.parametrize("seed", range(6))
def test_forms_on_the_neglected_functions_stay_below_their_bounds(seed: int, moments: int) -> None:
    """The tail of a small head within a large one: what the traces allow, and not much less."""
    scene, speed = _random_blade(seed)
    beam = replace(scene.beam, tip=_BODY)
    small, large = (_split(replace(scene, beam=beam), speed, n)[0] for n in (moments, 30))
    K = large.stiffness
    tail = _complement(small, large)
    forms = [*large.forms[:3], large.part.slope[..., -1] @ large.part.slope[..., -1].T]
    traces = [np.trace(np.linalg.solve(tail.T @ K @ tail, tail.T @ form @ tail)) for form in forms]
    assert (traces <= small.tails).all()
    assert traces[2] > 0.9 * small.tails[2]  # deflections: the large head has nearly all of it
    twisting = eigh(tail.T @ large.forms[6] @ tail, tail.T @ K @ tail, eigvals_only=True)
    assert np.abs(twisting).max() <= small._twisting_tail


def _complement(small: CoupledEnclosure, large: CoupledEnclosure) -> np.ndarray:
    """Combinations of the large head's functions that are orthogonal in energy to the small head."""
    rule, stiffnesses = large.part.quadrature, large.part._both_at(large.part.quadrature)
    there = np.array(
        [[small.part.quadrature.interpolate_to(rule.xi) @ row for row in c] for c in small.part.curvature]
    )
    products = np.einsum("ikx,kx,jkx->ij", large.part.curvature, rule.weights * stiffnesses, there)
    return np.linalg.qr(products, mode="complete")[0][:, products.shape[1] :]


@pytest.mark.parametrize("speed", [0.0, 3.0, 8.0])
def test_twisting_by_inertia_of_a_tip_body_is_bounded(speed: float) -> None:
    beam = bd.Beam.from_stiffness(
        1.0, 1.0, 1.0, second_bending_stiffness=4.0, twist=Polynomial([0.2, 0.7]), tip=_BODY
    )
    scene = bd.Scene(beam, bd.Mount(0.3, np.pi, 0.4), physics=bd.Physics(planes=2))
    found = frequency_bounds(scene, speed, 4)
    assert (found.width < 1e-8).all()
    _assert_between(found.lower_squared, found.upper_squared, known_frequencies(scene, speed, 4))


def test_an_oblique_bending_angle_couples_planes_without_twist() -> None:
    beam = bd.Beam.rectangular(1.0, 0.1, 0.03, 70e9, 2700.0, bd.TipMass(0.5, 0.02, 2e-3, 1.5e-3, 1e-3))
    scene = bd.Scene(beam, bd.Mount(0.3, np.pi, 0.3), physics=bd.Physics(planes=2))
    found = frequency_bounds(scene, 150.0, 4)
    assert (found.width < 1e-8).all()
    _assert_between(found.lower_squared, found.upper_squared, known_frequencies(scene, 150.0, 4))


def test_the_coupled_theorem_agrees_with_that_of_planes_apart() -> None:
    scene, speed = blade_scene("nrel_5", twisted=False), 1.3
    apart = frequency_bounds(scene, speed, 4)
    split, time = _split(scene, speed, 24)
    lower, upper = (found / time**2 for found in split.bounds(4))
    assert (lower <= apart.upper_squared).all() and (apart.lower_squared <= upper).all()
    assert (upper - lower < 1e-7 * upper).all()


def test_an_unstable_mode_of_a_twisted_inward_blade_has_bounds_of_its_square() -> None:
    beam = bd.Beam.from_stiffness(1.0, 1.0, 1.0, second_bending_stiffness=9.0, twist=Polynomial([0.0, 0.5]))
    scene = bd.Scene(beam, bd.Mount(4.3, 0.0, 0.0), physics=bd.Physics(planes=2))
    found = frequency_bounds(scene, 1.6, 3)
    assert found.lower_squared[0] <= found.upper_squared[0] < 0
    assert np.isnan(found.lower[0]) and "unstable" in found.warnings[0]
    _assert_between(found.lower_squared, found.upper_squared, known_frequencies(scene, 1.6, 3))


@pytest.mark.parametrize("turn", [1e-3, 0.05, 0.25])
def test_polynomials_for_the_twist_err_by_less_than_stated(turn: float) -> None:
    """With two degrees fewer than are taken, so that rounding, 2e-15, does not hide it."""
    degree, misfit = twist_degree(turn, 1.0)
    assert misfit <= 1e-14
    fewer = degree - 2
    error = turn ** (fewer + 1) / (2**fewer * math.factorial(fewer + 1))
    nodes = turn * np.cos(np.pi * (np.arange(fewer + 1) + 0.5) / (fewer + 1))
    t = np.linspace(-turn, turn, 401)
    for f in (np.cos, np.sin):
        interpolant = np.polynomial.Chebyshev.fit(nodes, f(0.7 + nodes), fewer, domain=[-turn, turn])
        assert np.abs(interpolant(t) - f(0.7 + t)).max() <= error + 2e-15
