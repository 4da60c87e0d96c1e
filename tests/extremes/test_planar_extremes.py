"""Toggles met exactly, and parts of very different size."""

from __future__ import annotations

import math

import numpy as np
import pytest

from brakes.planar import (
    GROUND,
    Bar,
    Force,
    Mechanism,
    Moment,
    Pin,
    RotationLock,
    Slot,
    solve,
    solve_with_friction,
    stroke,
)


@pytest.mark.parametrize("angle", [0.0, 1e-12, 1e-9, 1e-8])
def test_a_toggle_met_exactly_or_nearly_is_undecided_but_never_a_number(angle: float):
    """Crank and rod in line, the slider pushed: the crank's moment cannot be 0 / 0, the slider is held."""
    mechanism = Mechanism(
        ("crank", "slider"),
        (
            Pin("A", "crank", GROUND, (0, 0)),
            Bar("rod", "crank", "slider", (0.1, 0.1 * angle), (0.4, 0)),
            Slot("guide", "slider", GROUND, (0.4, 0), along=(1, 0)),
            RotationLock("upright", "slider", GROUND),
        ),
        (Moment("turn", "crank", 1.0), Force("push", "slider", (0.4, 0), (1, 0))),
    )
    answer = solve(mechanism)
    assert answer.status == "near a toggle"  # at it, no push on the slider holds a moment on the crank
    assert "too near a toggle position to decide" in answer.message and "crank turns" in answer.message
    assert "at least 1e-07 is needed" in answer.message and "draw it further from" in answer.message
    assert answer.loose == ("crank",)
    with pytest.raises(ValueError, match="too near a toggle position to decide"):
        solve_with_friction(mechanism, "turn")
    with pytest.raises(ValueError, match="or is too near a toggle position to decide"):
        stroke(mechanism, "push", [0.0, 0.01])
    assert np.isnan(answer.amplitudes["push"])
    held = Mechanism(
        mechanism.bodies,
        mechanism.joints,
        (Moment("turn", "crank"), Force("push", "slider", (0.4, 0), (1, 0), 5.0)),
    )
    answer = solve(held)
    assert answer.status == "determined"
    moment = 5.0 * 0.1 * (1 + 0.1 / 0.3) * angle  # of the push on the crank, to first order in the angle
    assert answer.amplitudes["turn"] == pytest.approx(moment, rel=1e-6, abs=1e-15)
    assert answer.magnitudes["rod"] == pytest.approx(5.0, rel=1e-14)


@pytest.mark.parametrize("beyond", [0.0, math.pi])
def test_a_crank_near_a_dead_centre_is_solved_or_undecided(beyond: float):
    """Undecided up to some angle, determined from there on; 3e-7 rad beside one there was no equilibrium."""
    found = []
    for angle in (1e-12, 1e-9, 1e-8, 1e-7, 3e-7, 1e-6, 1e-5, 1e-3):
        x, y = 0.1 * math.cos(beyond + angle), 0.1 * math.sin(beyond + angle)
        pin = (x + math.sqrt(0.09 - y * y), 0.0)
        joints = (
            Pin("O", "crank", GROUND, (0, 0)),
            Pin("A", "crank", "rod", (x, y)),
            Pin("B", "rod", "slider", pin),
            Slot("guide", "slider", GROUND, pin, along=(1, 0)),
            RotationLock("upright", "slider", GROUND),
        )
        loads = (Moment("turn", "crank", 10.0), Force("push", "slider", pin, (-1, 0)))
        found.append(solve(Mechanism(("crank", "rod", "slider"), joints, loads)).status)
    assert found == sorted(found, reverse=True)
    assert set(found) == {"near a toggle", "determined"}


@pytest.mark.parametrize("offset", [1e-2, 1e-4, 1e-6])
def test_near_a_toggle_the_force_grows_as_it_must(offset: float):
    """Two equal bars almost in line, pressed at the knee: each carries F / (2 sin)."""
    clamp = Mechanism(
        ("one", "two"),
        (
            Pin("left", "one", GROUND, (-1, 0)),
            Pin("knee", "one", "two", (0, offset)),
            Pin("right", "two", GROUND, (1, 0)),
        ),
        (Force("press", "one", (0, offset), (0, -1), 1.0),),
    )
    answer = solve(clamp)
    expected = math.hypot(1.0, offset) / (2 * offset)
    assert answer.magnitudes["right"] == pytest.approx(
        expected, rel=1e-14 / offset
    )  # the slope's own rounding
    assert bool(answer.warnings) == (offset < 2e-6)


@pytest.mark.parametrize("size", [1e-6, 1e-3, 1e3])
def test_a_small_part_on_a_large_one(size: float):
    """A balance of size x on the tip of a beam of 1 m."""
    tip = (1.0, 0.0)
    parts = Mechanism(
        ("beam", "balance"),
        (
            Pin("foot", "beam", GROUND, (0, 0)),
            RotationLock("fixed", "beam", GROUND),
            Pin("tip", "balance", "beam", tip),
        ),
        (
            Force("near", "balance", (1.0 + size, 0.0), (0, -1), 3.0),
            Force("far", "balance", (1.0 - 3 * size, 0.0), (0, -1)),
        ),
    )
    answer = solve(parts)
    assert answer.status == "determined"
    # The input's coordinates, 1 + x, have a rounding of 1e-16 / x.
    assert answer.amplitudes["far"] == pytest.approx(1.0, rel=1e-14 * max(1.0, 1 / size))
    assert answer.magnitudes["fixed"] == pytest.approx(4.0, rel=1e-14 * max(1.0, size, 1 / size))


def test_a_chain_of_many_bodies():
    """Thirty bars end to end, hung between two points: mobility 28, in balance where a funicular is drawn."""
    n = 30
    x = np.linspace(-1, 1, n + 1)
    y = x**2  # equal weights at equal distances: a parabola
    names = tuple(f"bar {k}" for k in range(n))
    owners = (GROUND, *names, GROUND)
    pins = tuple(Pin(f"pin {k}", owners[k], owners[k + 1], (x[k], y[k])) for k in range(n + 1))
    weights = tuple(Force(f"weight {k}", names[k], (x[k], y[k]), (0, -1), 1.0) for k in range(1, n))
    answer = solve(Mechanism(names, pins, weights))
    assert answer.mobility == n - 2
    assert answer.status == "loose"
    horizontal = n / 4  # w / (y'') with w = n / 2 per metre and y'' = 2
    assert np.abs(answer.reactions["pin 7"][0]) == pytest.approx(horizontal, rel=1e-11)
