"""Both discretizations against published rotating beams and the power-series reference."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import beamdyn as bd
from benchmarks.cases.scenes import generated_cases, of_case, published_cases

RITZ, FEM = 1e-9, 1e-6  # promised relative errors of the defaults
BOUNDS = {"ritz": RITZ, "fem": FEM}

published = pytest.mark.parametrize("case", published_cases(), ids=lambda c: c["name"])
methods = pytest.mark.parametrize("discretization", ["ritz", "fem"])


def by_both(cases: list[dict[str, Any]], every: int) -> list[Any]:
    """All cases by assumed modes; by elements each, but the `every`-th marked as slow."""
    return [
        pytest.param(case, method, id=f"{case['name']}-{method}", marks=[pytest.mark.slow] if slow else [])
        for k, case in enumerate(cases)
        for method, slow in (("ritz", False), ("fem", bool(k % every)))
    ]


def solve(case: dict[str, Any], modes: int, discretization: str) -> bd.Modes:
    return bd.natural_modes(of_case(case), case["gamma"], modes, discretization)


@methods
@published
def test_published(case: dict[str, Any], discretization: str) -> None:
    expected = np.array(case["frequency"])
    found = solve(case, len(expected), discretization)
    np.testing.assert_allclose(2 * np.pi * found.frequency, expected, rtol=BOUNDS[discretization])


@pytest.mark.parametrize(("case", "discretization"), by_both(generated_cases(), 4))
def test_generated_and_its_error(case: dict[str, Any], discretization: str) -> None:
    squared = np.array([float(text) for text in case["lambda_squared"]])
    found = solve(case, len(squared), discretization)
    np.testing.assert_array_equal(np.isnan(found.frequency), squared < 0)
    true = np.abs((found.eigenvalue**2).real / -squared - 1) / 2
    assert (true < BOUNDS[discretization]).all()
    assert (true <= found.error).all()


@pytest.mark.parametrize("discretization", ["ritz", "fem"])
def test_critical_speeds(discretization: str) -> None:
    from beamdyn.published import load

    for case in load("rotating_beams")["critical"]:
        speed = bd.critical_speed(of_case(case | {"model": "bending"}), discretization)
        np.testing.assert_allclose(speed, case["gamma"], rtol=BOUNDS[discretization])
