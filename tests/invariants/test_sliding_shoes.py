"""Sliding shoes: contact on one side only, equilibrium by quadrature, and the only solution."""

from dataclasses import astuple, replace
from itertools import pairwise

import numpy as np
import pytest
from mpmath import mp, mpf

from brakes import machines

R, WIDTH, B, C, A = 0.138, 0.05, 0.02, 0.11, 0.115
BRAKE = machines.Sliding(R, WIDTH, np.radians(30.0), np.radians(130.0), B, C, A, shoes="single")


def solved(brake, friction, *, reverse=False):
    found = machines.solve_brake(brake, friction=friction, force=1000.0, reverse=reverse)
    return found, found.linings[0], float(brake.zero(np.asarray(friction), not reverse))


def quadrature(brake, delta):
    """Angles and weights over the lining, on both sides of where the pressure begins or ends."""
    inside = (x for x in (delta, delta + np.pi) if brake.lining_start < x < brake.lining_end)
    ends = sorted((brake.lining_start, *inside, brake.lining_end))
    x, w = np.polynomial.legendre.leggauss(30)
    parts = [((low + high) / 2 + (high - low) / 2 * x, (high - low) / 2 * w) for low, high in pairwise(ends)]
    return np.concatenate([at for at, _ in parts]), np.concatenate([w for _, w in parts])


@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize("psi", [-0.2, 0.0, 0.3])
@pytest.mark.parametrize("friction", [0.05, 0.2, 0.35])
def test_the_free_body_of_a_shoe_is_in_equilibrium(friction, psi, reverse):
    """Pressure, friction, force and abutment, point by point, with the pressure's own integral."""
    brake = replace(BRAKE, abutment_angle=psi)
    found, lining, delta = solved(brake, friction, reverse=reverse)
    alpha, weight = quadrature(brake, delta)
    p = float(lining.peak_pressure) * brake.pressure_on(0, alpha, friction, reverse) * WIDTH * R * weight
    s = 1.0 if reverse else -1.0
    out = np.stack([np.sin(alpha), -np.cos(alpha)])
    along = np.stack([np.cos(alpha), np.sin(alpha)])
    on_shoe = -p * out + s * friction * p * along
    at = R * out
    abutment = float(lining.reactions["abutment"]) * np.array([np.cos(psi), np.sin(psi)])
    force = on_shoe.sum(axis=1) + np.array([1000.0, 0.0]) + abutment
    np.testing.assert_allclose(force / 1000.0, 0, atol=1e-12)
    moment = (at[0] * on_shoe[1] - at[1] * on_shoe[0]).sum() - A * 1000.0 + B * abutment[1] + C * abutment[0]
    assert abs(moment) < 1e-12 * 1000.0 * (A + C)
    assert found.torque == pytest.approx(friction * p.sum() * R, rel=1e-12)


@pytest.mark.parametrize("reverse", [False, True])
def test_pressure_and_gap_exclude_each_other(reverse):
    """The pressure is nowhere negative; where it is zero the lining has moved away from the drum."""
    for friction in (0.1, 0.35):
        _, _, delta = solved(BRAKE, friction, reverse=reverse)
        alpha = np.linspace(BRAKE.lining_start, BRAKE.lining_end, 1001)
        pressure, moved = BRAKE.pressure_on(0, alpha, friction, reverse), np.sin(alpha - delta)
        assert (pressure >= 0).all()
        assert ((pressure > 0) == (moved > 0)).all()
    assert (pressure == 0).any() == reverse  # the trailing shoe lifts


def test_a_lining_in_full_contact_is_a_linear_problem():
    """p = X sin + Y cos and the abutment's force from three equations, without a search."""
    found, lining, delta = solved(BRAKE, 0.35)
    alpha, weight = quadrature(BRAKE, delta)
    out, along = np.stack([np.sin(alpha), -np.cos(alpha)]), np.stack([np.cos(alpha), np.sin(alpha)])
    columns = []
    for shape in (np.sin(alpha), np.cos(alpha)):
        each = (-out - 0.35 * along) * shape * WIDTH * R * weight
        columns.append([*each.sum(axis=1), R * (out[0] * each[1] - out[1] * each[0]).sum()])
    columns.append([1.0, 0.0, C])
    x, y, abutment = np.linalg.solve(np.array(columns).T, [-1000.0, 0.0, A * 1000.0])
    assert abutment == pytest.approx(lining.reactions["abutment"], rel=1e-11)
    assert np.arctan2(-y, x) == pytest.approx(delta, abs=1e-12)
    assert 0.35 * R * WIDTH * R * weight @ (x * np.sin(alpha) + y * np.cos(alpha)) == pytest.approx(
        found.torque
    )


def test_there_is_one_solution_where_the_weight_changes_sign():
    """R over a thousand zeros of the pressure, of random brakes: one change of sign, as the proof says."""
    rng = np.random.default_rng(5)
    for _ in range(60):
        start = rng.uniform(0.1, 1.2)
        brake = machines.Sliding(R, WIDTH, start, start + rng.uniform(0.6, 1.8), rng.uniform(-0.04, 0.05),
                                 rng.uniform(0.08, 0.13), A, rng.uniform(-0.5, 0.5))  # fmt: skip
        mu, s = rng.uniform(0, 0.8), rng.choice([-1.0, 1.0])
        zeros = np.linspace(brake.lining_start - np.pi + 1e-3, brake.lining_end - 1e-3, 1001)
        values = brake._residual(zeros, mu, s)
        held = brake._weight(brake.lining_start, mu, s) * brake._weight(brake.lining_end, mu, s) < 0
        if held:
            assert (values[:-1] * values[1:] < 0).sum() == 1
        assert np.isfinite(brake.zero(np.asarray(mu), s < 0)) == held


def test_it_locks_where_it_says():
    brake = replace(BRAKE, shoes="single")
    limit = float(machines.solve_brake(brake, friction=0.1, force=1.0).locking_friction)
    for part, locks in ((1 - 1e-6, False), (1 + 1e-6, True)):
        found = machines.solve_brake(brake, friction=part * limit, force=1.0)
        assert bool(found.locked) == locks
        assert ("grips by itself" in found.message) == locks


LOCKS_IN_A_NARROW_RANGE = [  # reverse; start and end of the lining, b, c, a, psi
    (False, 0.853934, 2.973241, 0.042646, 0.045508, 0.137521, -0.626664),
    (False, 0.387507, 2.955646, 0.076578, 0.139486, 0.057178, -0.772506),
    (False, 0.772714, 2.447902, 0.051472, 0.101145, 0.047625, 0.054963),
    (True, 0.979541, 2.681742, 0.104316, 0.056825, 0.066554, -0.659346),
]


@pytest.mark.parametrize(("reverse", *"defghi"), LOCKS_IN_A_NARROW_RANGE)
def test_frictions_that_lock_are_found_in_a_narrow_range(reverse, d, e, f, g, h, i):
    """By quadrature: up to the limit the lining's moment holds the shoe back, or nothing holds it."""
    brake = machines.Sliding(R, WIDTH, d, e, f, g, h, i, shoes="single")
    limit = float(machines.solve_brake(brake, friction=0.0, force=1.0, reverse=reverse).locking_friction)
    assert np.isfinite(limit)

    def moment(mu):
        delta = brake.zero(np.asarray(mu), not reverse)
        if np.isnan(delta):
            return np.nan
        (alpha, weight), s = quadrature(brake, float(delta)), 1.0 if reverse else -1.0
        out, along = np.stack([np.sin(alpha), -np.cos(alpha)]), np.stack([np.cos(alpha), np.sin(alpha)])
        on_shoe = (s * mu * along - out) * np.maximum(np.sin(alpha - float(delta)), 0.0) * weight
        x, y = R * out - np.array([[f], [-g]])
        return (x * on_shoe[1] - y * on_shoe[0]).sum()

    assert moment(limit * (1 + 1e-6)) < 0
    assert not any(moment(part * limit) <= 0 for part in np.linspace(0.0, 1 - 1e-6, 300))
    for part, locks in ((1 - 1e-6, False), (1 + 1e-6, True)):
        found = machines.solve_brake(brake, friction=part * limit, force=1.0, reverse=reverse)
        assert ("grips by itself" in found.message) == locks


def test_a_brake_that_slides_past_a_range_in_which_it_locks_says_so():
    brake = machines.Sliding(R, WIDTH, *LOCKS_IN_A_NARROW_RANGE[3][1:], shoes="single")
    found = machines.solve_brake(brake, friction=0.3, force=1.0, reverse=True)
    assert not found.locked
    assert found.message == "slides, but locks in a range of lower friction, from 0.1119 on"


def test_a_shoe_that_locks_without_friction_has_no_margin():
    """Its abutment's force passes beside the shoe: a force on it would have to pull."""
    brake = machines.Sliding(R, WIDTH, 0.6496, 2.7344, 0.10497, 0.045629, 0.101114, -0.6722, shoes="single")
    for friction in (0.0, 0.3):
        found = machines.solve_brake(brake, friction=friction, force=1.0)
        assert (found.locked, found.locking_friction, found.margin) == (True, 0.0, -np.inf)


def test_shoes_that_nothing_holds_divide_by_nothing():
    friction = np.linspace(0.05, 4.0, 159)
    with np.errstate(divide="raise", invalid="raise", over="raise"):
        found = machines.solve_brake(replace(BRAKE, shoes="duplex"), friction=friction, force=1.0)
    assert (found.locked == (friction > found.locking_friction)).all()


def test_a_shoe_that_nothing_holds_does_not_lock():
    """Across the abutment's force, int p (cos t - s mu sin t) = 0 needs a sign that changes on the lining.

    A trailing shoe is held up to -cot of the lining's end; a leading one from 30 to 60 deg between the two
    cotangents of its ends.
    """
    trailing, last = replace(BRAKE, shoes="single"), -1 / np.tan(BRAKE.lining_end)
    leading = replace(trailing, lining_start=np.radians(30), lining_end=np.radians(60))
    for brake, reverse, friction, held in (
        (trailing, True, 0.99 * last, True),
        (trailing, True, 1.01 * last, False),
        (leading, False, 0.35, False),
        (leading, False, 0.6, True),
    ):
        found = machines.solve_brake(brake, friction=friction, force=1.0, reverse=reverse)
        assert bool(np.isfinite(found.torque)) == held
        assert found.message.startswith("slides" if held else "no equilibrium: at friction")
        assert found.margin > 0


@pytest.mark.parametrize("reverse", [False, True])
def test_the_slope_of_the_factor_counts_how_the_contact_moves(reverse):
    step = 1e-5
    low, high = (solved(BRAKE, 0.3 + k * step, reverse=reverse)[0].c_star for k in (-1, 1))
    slope = solved(BRAKE, 0.3, reverse=reverse)[0].c_star_slope
    assert slope == pytest.approx((high - low) / (2 * step), rel=1e-8)  # of differences over 2e-5


NARROW = [  # friction, reverse, and a brake whose lining touches over less than two degrees
    (0.0, False, (0.08090664019526993, 0.05, 1.5503827467931042, 2.412281946117673, 0.016863753392712327,
                  0.08042285765427175, 0.023690748802092685, -0.07382937373221032)),
    (0.21641088562300448, True, (0.029446373639641053, 0.05, 1.7552918943108704, 2.1237175304213567,
                  -0.009139652256614431, 0.019002329989908244, 0.012571205782743428, -0.12149107534957426)),
    (0.6762929344232588, True, (0.22830717408064638, 0.05, 2.015956783023399, 2.2157659391861944,
                  0.08558061657577996, 0.13015118069125273, 0.06025739428446586, -0.1297779432939148)),
]  # fmt: skip


@pytest.mark.parametrize(("friction", "reverse", "given"), NARROW)
def test_the_stated_error_covers_that_of_a_narrow_contact(friction, reverse, given):
    """Against 30 digits: on the last degree of a lining, integrals that are differences lost ten digits."""
    brake = machines.Sliding(*given, shoes="single")
    found, lining, start = solved(brake, friction, reverse=reverse)
    with mp.workdps(30):
        r, width, first, last, b, c, a, psi = map(mpf, astuple(brake)[:8])
        mu = mpf(friction) * (1 if reverse else -1)

        def contact(delta):
            return max(first, delta), min(last, delta + mp.pi)

        def sums(delta):
            """Force along x, force along y, and the moment about the abutment, of the lining on the shoe."""
            S, C, K = (
                mp.quad(lambda x, f=f: mp.sin(x - delta) * f(x), contact(delta))
                for f in (mp.sin, mp.cos, lambda x: 1)
            )
            return mu * C - S, C + mu * S, c * S - b * C + mu * (r * K - b * S - c * C)

        def along_the_abutment(delta):
            x, y, moment = sums(delta)
            return mp.cos(psi) * y - mp.sin(psi) * (x + moment / (a + c))

        delta = mp.findroot(along_the_abutment, (start, start + 1e-9), tol=1e-40)
        low, high = contact(delta)
        peak = max(mp.sin(low - delta), mp.sin(high - delta))
        pressure = 1000 * (a + c) / sums(delta)[2] * peak / (width * r)
        assert 0.001 < high - low < 0.02
        assert abs(lining.peak_pressure / pressure - 1) < found.error < 1e-8
