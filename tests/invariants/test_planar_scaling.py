"""The same mechanism in other units, elsewhere and turned gives the same answer."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from benchmarks.cases import mechanisms as ee
from brakes.planar import GROUND, Contact, Mechanism, solve, stroke

EPS = np.finfo(float).eps
LENGTHS = {"mm": 1.0, "micrometres": 1e-6, "kilometres": 1e6, "light": 1e15}
VALUES = np.linspace(0.0, 3.5e-3, 5)


def moved(part, length=1.0, angle=0.0, shift=0j, force=1.0):
    """A joint or load, all its points turned, stretched and shifted, its magnitude multiplied."""

    def place(p):
        z = complex(*p) * length * np.exp(1j * angle) + shift
        return z.real, z.imag

    changes = {key: place(getattr(part, key)) for key in ("at", "to") if hasattr(part, key)}
    for key in ("direction", "normal"):
        if hasattr(part, key):
            z = complex(*getattr(part, key)) * np.exp(1j * angle)
            changes[key] = z.real, z.imag
    if getattr(part, "magnitude", None) is not None:
        changes["magnitude"] = part.magnitude * force
    return dataclasses.replace(part, **changes)


def elsewhere(mechanism: Mechanism, **how) -> Mechanism:
    return Mechanism(
        mechanism.bodies,
        tuple(moved(j, **how) for j in mechanism.joints),
        tuple(moved(load, **how) for load in mechanism.loads),
    )


def sizes(answer) -> np.ndarray:
    return np.array([*answer.magnitudes.values(), *answer.amplitudes.values()])


REFERENCE = sizes(solve(ee.eebrake()))


@pytest.mark.parametrize("length", [1e-6, 1e-3, 1e6, 1e12])
@pytest.mark.parametrize("force", [1e-9, 1.0, 1e9])
def test_units(length: float, force: float):
    answer = solve(elsewhere(ee.eebrake(), length=length, force=force))
    assert answer.status == "determined"
    # Some ten roundings of the coordinates, times the condition number of the equations (below 100).
    assert np.allclose(sizes(answer), REFERENCE * force, rtol=1000 * EPS, atol=0.0)


@pytest.mark.parametrize("angle", [0.3, math.pi / 2, 2.0, -3.0])
@pytest.mark.parametrize("distance", [0.0, 1.0, 1e3, 1e6])
def test_rotation_and_translation(angle: float, distance: float):
    brake = elsewhere(ee.eebrake(), angle=angle, shift=distance * np.exp(1j))
    answer = solve(brake)
    rounding = EPS * (1 + distance / 0.06)  # of the coordinates themselves, over the size of the brake
    assert np.allclose(sizes(answer), REFERENCE, rtol=1000 * rounding, atol=0.0)
    turned = np.exp(1j * angle) * (solve(ee.eebrake()).reactions["pivot R"] @ (1, 1j))
    assert answer.reactions["pivot R"] @ (1, 1j) == pytest.approx(turned, rel=1000 * rounding)


@pytest.mark.parametrize("how", [{"length": 1e-6}, {"length": 1e6}, {"angle": 2.0}, {"shift": 1e3 + 2e3j}])
def test_stroke(how: dict):
    length = how.get("length", 1.0)
    rounding = EPS * (1 + abs(how.get("shift", 0j)) / 0.06)
    here = stroke(ee.eebrake(), "cable", VALUES)
    there = stroke(elsewhere(ee.eebrake(), **how), "cable", VALUES * length)
    for name in ("pad R", "pad L"):
        assert np.allclose(
            there.travel[name], here.travel[name] * length, rtol=0, atol=1000 * rounding * length * 0.06
        )
        assert np.allclose(there.ratio[name], here.ratio[name], rtol=1000 * rounding, atol=0.0)


@pytest.mark.parametrize(
    "how", [{"length": 1e-6}, {"length": 1e6}, {"angle": 1.0}, {"shift": 1e3j}, {"force": 1e-9}]
)
def test_the_diagnosis_is_the_same(how: dict):
    rims = (
        Contact("rim R", "R", GROUND, ee.PAD_R, (1, 0)),
        Contact("rim L", "L", GROUND, ee.PAD_L, (-1, 0)),
    )
    rigid = solve(elsewhere(ee.eebrake(1.0, 0.0, 0.0, (*ee.JOINTS, *rims)), **how))
    assert rigid.status == "undetermined"
    assert rigid.indeterminacy == 1
    without = solve(elsewhere(ee.eebrake(joints=[j for j in ee.JOINTS if j.name != "S"]), **how))
    assert (without.status, without.loose) == ("no equilibrium", ("R",))
