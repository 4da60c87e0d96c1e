"""Shoes at the limits: tiny and full arcs, friction near locking, and a hundred thousand at once."""

from __future__ import annotations

import numpy as np
import pytest

from brakes import drum


def shoe(a1, a2, b=0.02, zero="axis"):
    return drum.Shoe(0.138, 0.05, (a1, a2), (b, -0.11), 0.115, zero)


@pytest.mark.parametrize("arc", [1e-2, 1e-4, 1e-6])
def test_short_lining_tends_to_a_point(arc):
    """One force at the middle: P (a + c) = N (n + s mu d), arms of a point; the arc adds its square."""
    m, b, c, mu, r = 1.2, 0.02, 0.11, 0.35, 0.138
    found = drum.shoe_torque(shoe(m - arc / 2, m + arc / 2), force=1e3, friction=mu)
    n, d = c * np.sin(m) - b * np.cos(m), r - b * np.sin(m) - c * np.cos(m)
    torque = mu * 1e3 * 0.225 * r / (n - mu * d)
    assert found.torque == pytest.approx(torque, rel=max(arc**2, 1e-9))


@pytest.mark.parametrize("zero, b", [("axis", 0.0), ("pivot", 0.02), ("pivot", -0.05)])
def test_full_half_circle(zero, b):
    """The whole half beyond the pin line: K = 2, S = pi/2, C = 0 in the axes of the pressure."""
    pin = np.arctan2(b, 0.11)
    found = drum.shoe_torque(shoe(pin, pin + np.pi, b, zero), force=1e3, friction=0.3)
    far = np.hypot(b, 0.11)
    torque = 0.3 * 1e3 * 0.225 * 0.138 * 2 / (far * np.pi / 2 - 0.3 * 0.138 * 2)
    assert found.torque == pytest.approx(torque, rel=1e-13)
    assert found.effective_arm == pytest.approx(0.138 * 4 / np.pi, rel=1e-13)


def test_factor_grows_like_a_pole_towards_locking():
    limit = drum.shoe_torque(shoe(0.5, 1.9), force=1.0, friction=0.1).locking_friction
    margin = 10.0 ** -np.arange(3, 11)
    c_star = drum.shoe_torque(shoe(0.5, 1.9), force=1.0, friction=limit * (1 - margin)).c_star
    order = np.polyfit(np.log(margin), np.log(c_star), 1)[0]
    assert order == pytest.approx(-1, abs=1e-3)


def test_a_hundred_thousand_designs_slide_or_lock():
    rng = np.random.default_rng(20190)
    n = 100_000
    radius = rng.uniform(0.05, 0.4, n)
    pin, far = rng.uniform(-0.8, 0.8, n), radius * rng.uniform(0.3, 0.95, n)
    start = np.maximum(pin, 0) + rng.uniform(0.01, 0.8, n)
    end = np.minimum(start + rng.uniform(0.1, 2.2, n), np.pi + np.minimum(pin, 0) - 0.01)
    many = drum.Shoe(radius, 0.05, (start, end), (far * np.sin(pin), -far * np.cos(pin)), 0.8 * radius)
    for leading in (True, False):
        found = drum.shoe_torque(many, force=1e3, friction=rng.uniform(0.0, 3.0, n), leading=leading)
        slides = ~found.locked
        assert (found.torque[slides] >= 0).all() and np.isnan(found.torque[found.locked]).all()
        reaction = np.linalg.norm(found.pin_reaction[slides], axis=-1)
        assert (found.closure[slides] <= 1e-12 * np.maximum(1, reaction / 1e3)).all()
        assert slides.sum() > 0 if leading else slides.mean() > 0.9
