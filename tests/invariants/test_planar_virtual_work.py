"""Virtual work of random mechanisms, whose motion is computed by complex steps of formulas of its own."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.cases.mechanisms import KINDS, LOADS, random_mechanism, virtual_work, worst_virtual_work
from brakes.planar import Force, Mechanism, solve
from brakes.planar.system import Rows, System

BOUND = 1e-9  # that of the project; rounding over the smallest singular value admitted, 0.01, is below 1e-12
RIGHT = System.rows


@pytest.mark.parametrize("number", [100, pytest.param(300, marks=pytest.mark.slow)])
def test_virtual_work_of_random_mechanisms(number: int):
    worst, moved = worst_virtual_work(number)
    assert (worst < BOUND).all()
    assert moved > number / 6


def wrong_sign(kind: str):
    """Rows whose action on the last of their bodies has the wrong sign, for joints or loads of one kind."""

    def rows(system: System, y: np.ndarray) -> Rows:
        right = RIGHT(system, y)
        force, couple, gradient = (array.copy() for array in right[1:])
        named = {**system.joints, **{name: slice(row, row + 1) for name, row in system.loads.items()}}
        for name, own in named.items():
            if name.split()[0] == kind:
                for row in range(own.start, own.stop):
                    acts = gradient[0, row].reshape(-1, 3).any(axis=1)
                    last = int(np.flatnonzero(acts)[-1])
                    gradient[:, row, 3 * last : 3 * last + 3] *= -1
                    force[:, row, last] *= -1
        return Rows(right.value, force, couple, gradient)

    return rows


@pytest.mark.parametrize("kind", KINDS + LOADS)
def test_a_wrong_sign_in_any_kind_of_joint_or_load_is_seen(kind: str, monkeypatch: pytest.MonkeyPatch):
    rng = np.random.default_rng(1)
    mechanism = next(m for m in iter(lambda: random_mechanism(rng), None) if _has(m, kind))
    assert max(virtual_work(mechanism, solve(mechanism))) < BOUND
    monkeypatch.setattr(System, "rows", wrong_sign(kind))
    assert not max(virtual_work(mechanism, solve(mechanism))) < 1e-3


def wrong_ground(system: System, y: np.ndarray) -> Rows:
    """Rows of joints whose action on the ground has the wrong sign."""
    right = RIGHT(system, y)
    force = right.force.copy()
    force[:, : system.constraints, -1] *= -1
    return right._replace(force=force)


def test_without_mobility_the_closure_on_the_ground_is_checked(monkeypatch: pytest.MonkeyPatch):
    rng = np.random.default_rng(2)
    some = [random_mechanism(rng) for _ in range(150)]
    rigid = [m for m in some if solve(m).mobility == 0 and any(isinstance(load, Force) for load in m.loads)]
    assert max(solve(m).virtual_work for m in rigid) < 1e-13  # rounding over the least singular value, 0.01
    assert {type(j).__name__ for m in rigid for j in m.joints} == set(KINDS)
    monkeypatch.setattr(System, "rows", wrong_ground)
    assert min(solve(m).virtual_work for m in rigid) > 1e-3


def _has(mechanism: Mechanism, kind: str) -> bool:
    return any(part.name.split()[0] == kind for part in mechanism.parts)
