"""Pivoted shoes against quadrature of the traction over the lining, and laws that any shoe obeys."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial.legendre import leggauss

from brakes import drum

NODES, WEIGHTS = leggauss(40)

FRACTION = st.floats(0.0, 1.0)


@st.composite
def shoes(draw):
    """Any admissible shoe: pin on either side of the axis, any arc beyond it."""
    radius = draw(st.floats(0.02, 0.6))
    far, pin = radius * draw(st.floats(0.2, 1.5)), draw(st.floats(-1.0, 1.0))
    zero = draw(st.sampled_from(["axis", "pivot"]))
    phase = pin if zero == "pivot" else 0.0
    start, end = max(pin, phase), np.pi + min(pin, phase)
    a1 = start + 0.6 * draw(FRACTION) * (end - start)
    a2 = a1 + (0.1 + 0.9 * draw(FRACTION)) * (end - a1)
    arm = -far * np.cos(pin) + radius * draw(st.floats(0.2, 2.0))
    pivot = (far * np.sin(pin), -far * np.cos(pin))
    return drum.Shoe(radius, draw(st.floats(0.01, 0.2)), (a1, a2), pivot, arm, zero)


def integrated(shoe: drum.Shoe, found: drum.ShoeResult) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Normal and friction resultant, moment about the pin and the centre, from p0 by quadrature."""
    a1, a2 = shoe.lining
    alpha = (a1 + a2) / 2 + (a2 - a1) / 2 * NODES
    force = found.pressure(alpha) * shoe.face_width * shoe.drum_radius * (a2 - a1) / 2 * WEIGHTS
    outward = np.array([np.sin(alpha), -np.cos(alpha)])
    upward = np.array([np.cos(alpha), np.sin(alpha)])  # from the pin's end to the other
    normal, friction = -force * outward, (-1 if found.leading else 1) * found.friction * force * upward
    place = shoe.drum_radius * outward
    arm = place - np.array(shoe.pivot)[:, None]

    def moment(arms, forces):
        return float((arms[0] * forces[1] - arms[1] * forces[0]).sum())

    total = normal + friction
    return normal.sum(axis=1), friction.sum(axis=1), moment(arm, total), moment(place, total)


@given(shoes(), st.floats(0.0, 0.99), st.booleans())
def test_resultants_torque_and_pin_moment_by_quadrature(shoe, part, leading):
    """1e-9, relative to the sum of the sizes of what is integrated."""
    limit = drum.shoe_torque(shoe, force=1.0, friction=0.1, leading=leading).locking_friction
    friction = part * min(limit, 1.5)
    found = drum.shoe_torque(shoe, force=1000.0, friction=friction, leading=leading)
    normal, tangential, about_pin, about_centre = integrated(shoe, found)
    scale = np.linalg.norm(normal)
    np.testing.assert_allclose(found.normal, normal, rtol=0, atol=1e-9 * scale)
    np.testing.assert_allclose(found.tangential, tangential, rtol=0, atol=1e-9 * scale)
    sense = -1 if leading else 1
    assert abs(sense * found.torque - about_centre) <= 1e-9 * scale * shoe.drum_radius
    assert abs(about_pin - 1000.0 * shoe.moment_arm) <= 1e-9 * (scale + 1000.0) * shoe.drum_radius


@given(shoes(), st.floats(0.01, 0.9), st.booleans())
def test_forces_balance(shoe, part, leading):
    limit = drum.shoe_torque(shoe, force=1.0, friction=0.1, leading=leading).locking_friction
    found = drum.shoe_torque(shoe, force=500.0, friction=part * min(limit, 2.0), leading=leading)
    total = found.normal + found.tangential + found.pin_reaction + [500.0, 0.0]
    assert np.abs(total).max() <= 1e-12 * np.linalg.norm(found.normal)
    assert found.closure <= 1e-11 * max(
        1.0, np.linalg.norm(found.normal) / 500.0 * shoe.drum_radius / shoe.moment_arm
    )


@given(shoes(), st.floats(0.05, 1.0))
def test_arm_is_never_less_than_the_radius_and_friction_is_mu_times_normal(shoe, friction):
    found = drum.shoe_torque(shoe, force=1.0, friction=friction, leading=False)
    if found.locked:
        found = drum.shoe_torque(shoe, force=1.0, friction=friction)
    assert found.effective_arm >= shoe.drum_radius * (1 - 1e-12)
    sizes = np.linalg.norm(found.tangential), np.linalg.norm(found.normal)
    assert sizes[0] == pytest.approx(friction * sizes[1], rel=1e-12)
    assert found.torque == pytest.approx(sizes[0] * found.effective_arm, rel=1e-12)


@given(shoes(), st.floats(0.01, 0.9), st.booleans())
def test_slope_of_the_shoe_factor(shoe, part, leading):
    """Against a difference quotient of fourth order; its error is about h^4, its rounding 1e-16/h."""
    limit = min(drum.shoe_torque(shoe, force=1.0, friction=0.1, leading=leading).locking_friction, 1.0)
    mu, h = part * limit, 1e-3 * part * (1 - part) * limit
    at = drum.shoe_torque(shoe, force=1.0, friction=mu + h * np.array([-2, -1, 1, 2]), leading=leading).c_star
    slope = (at[0] - 8 * at[1] + 8 * at[2] - at[3]) / (12 * h)
    found = drum.shoe_torque(shoe, force=1.0, friction=mu, leading=leading)
    assert found.c_star_slope == pytest.approx(slope, rel=1e-8)
    assert found.c_star == pytest.approx(found.torque / shoe.drum_radius, rel=1e-12)


@given(shoes(), st.booleans())
def test_at_locking_the_lining_presses_without_a_force(shoe, leading):
    """The force for a given pressure, by quadrature, vanishes at the locking friction."""
    limit = drum.shoe_torque(shoe, force=1.0, friction=0.1, leading=leading).locking_friction
    if not np.isfinite(limit) or limit > 1e6:
        return
    near = drum.shoe_torque(shoe, peak_pressure=1e6, friction=limit * (1 - 1e-9), leading=leading)
    _, _, about_pin, _ = integrated(shoe, near)
    pressed = np.linalg.norm(near.normal) * shoe.drum_radius * (1 + limit)
    assert 0 < about_pin / pressed < 1e-8
    past = drum.shoe_torque(shoe, force=1.0, friction=limit, leading=leading)
    assert past.locked and np.isnan(past.torque)


@given(shoes(), st.floats(0.1, 0.9), st.booleans(), st.floats(0.1, 10.0))
def test_scaling(shoe, part, leading, k):
    """Lengths times k at the same force: same factor and resultants, torque times k, pressure over k^2."""
    limit = drum.shoe_torque(shoe, force=1.0, friction=0.1, leading=leading).locking_friction
    larger = drum.Shoe(
        k * shoe.drum_radius,
        k * shoe.face_width,
        shoe.lining,
        (k * shoe.pivot[0], k * shoe.pivot[1]),
        k * shoe.force_arm,
        shoe.pressure_zero,
    )
    mu = part * min(limit, 1.0)
    one, other = (drum.shoe_torque(s, force=1.0, friction=mu, leading=leading) for s in (shoe, larger))
    assert other.c_star == pytest.approx(one.c_star, rel=1e-9)
    assert other.torque == pytest.approx(k * one.torque, rel=1e-9)
    assert other.peak_pressure == pytest.approx(one.peak_pressure / k**2, rel=1e-9)


@given(shoes(), st.floats(0.05, 0.9), st.booleans())
def test_force_pressure_and_torque_lead_back(shoe, part, leading):
    limit = drum.shoe_torque(shoe, force=1.0, friction=0.1, leading=leading).locking_friction
    mu = part * min(limit, 1.0)
    by_force = drum.shoe_torque(shoe, force=800.0, friction=mu, leading=leading)
    by_pressure = drum.shoe_torque(shoe, peak_pressure=by_force.peak_pressure, friction=mu, leading=leading)
    by_torque = drum.shoe_torque(shoe, torque=by_force.torque, friction=mu, leading=leading)
    assert by_pressure.force == pytest.approx(800.0, rel=1e-12)
    assert by_torque.force == pytest.approx(800.0, rel=1e-12)


@given(shoes(), st.booleans())
def test_pressure_peaks_at_the_peak_pressure(shoe, leading):
    found = drum.shoe_torque(shoe, peak_pressure=2e5, friction=0.01, leading=leading)
    if found.locked:
        return
    alpha = np.linspace(*shoe.lining, 20001)
    p = found.pressure(alpha)
    assert p.min() >= -1e-9 * 2e5
    assert p.max() == pytest.approx(2e5, rel=1e-7)  # a grid misses the crest by h^2/8


def test_two_references_agree_when_the_pin_is_on_the_axis():
    sizes = (0.15, 0.04, (0.3, 2.0), (0.0, -0.11), 0.12)
    found = [drum.shoe_torque(drum.Shoe(*sizes, zero), force=1.0, friction=0.3) for zero in ("axis", "pivot")]
    assert found[0].torque == pytest.approx(found[1].torque, rel=1e-14)


def test_textbook_total_is_lower_by_half_a_per_cent_to_two():
    """The published comparison for the paper's data: 0.5-2.2 %."""
    falls = []
    for arc in range(10, 90, 10):
        totals = []
        for zero in ("axis", "pivot"):
            pair = [
                drum.Shoe(0.138, 0.05, tuple(np.radians((30, 30 + arc))), (b, -0.110), 0.115, zero)
                for b in (0.020, 0.025)
            ]
            totals.append(drum.brake_torque(drum.simplex(*pair), force=1e3, friction=0.35).torque)
        falls.append(1 - totals[1] / totals[0])
    assert min(falls) > 0.0045 and max(falls) < 0.0225


def test_sum_of_equal_shoes():
    """2 mu P (a + c) r K n / (n^2 - mu^2 d^2), the closed form of the paper's (17), by its own sums."""
    a1, a2, r, b, c, a, mu = 0.5, 2.0, 0.138, 0.02, 0.11, 0.115, 0.35
    shoe = drum.Shoe(r, 0.05, (a1, a2), (b, -c), a, "axis")
    K, S = np.cos(a1) - np.cos(a2), (a2 - a1) / 2 - (np.sin(2 * a2) - np.sin(2 * a1)) / 4
    C = (np.sin(a2) ** 2 - np.sin(a1) ** 2) / 2
    n, d = c * S - b * C, r * K - b * S - c * C
    total = 2 * mu * 1e3 * (a + c) * r * K * n / (n**2 - (mu * d) ** 2)
    assert drum.brake_torque(drum.simplex(shoe), force=1e3, friction=mu).torque == pytest.approx(
        total, rel=1e-12
    )
