"""Convergence of the assumed modes."""

from __future__ import annotations

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.equations.assembly import assemble_equations
from benchmarks.cases.uniform_blade import UNIFORM_BLADE, computed_eigenvalues, exact_eigenvalues


@pytest.mark.parametrize("gamma", [0, 12])
def test_no_digit_is_lost_as_the_basis_grows(gamma: int) -> None:
    expected = exact_eigenvalues(gamma)
    for functions in (20, 30, 50, 80, 120, 160, 200):
        np.testing.assert_allclose(computed_eigenvalues(gamma, bd.Ritz(functions)), expected, rtol=1e-12)


def test_legendre_converges_faster_than_any_power() -> None:
    expected = exact_eigenvalues(12)[0]
    errors = [computed_eigenvalues(12, bd.Ritz(n), 1)[0] / expected - 1 for n in (6, 8, 10, 12)]
    orders = np.diff(np.log(errors)) / np.diff(np.log([6, 8, 10, 12]))
    assert (np.diff(orders) < 0).all() and orders[-1] < -15


def test_eigenfunctions_converge_like_the_fifth_power() -> None:
    expected = exact_eigenvalues(12)[0]
    sizes = np.array([20, 40, 80])
    errors = [computed_eigenvalues(12, bd.Ritz(int(n), "eigenfunctions"), 1)[0] / expected - 1 for n in sizes]
    slope = np.polyfit(np.log(sizes), np.log(errors), 1)[0]
    assert -5.5 < slope < -4.5


def test_eigenfunctions_are_stable_to_number_150() -> None:
    """Each is its own mode at rest: the Rayleigh quotients are the fourth powers of the wave numbers."""
    pencil = assemble_equations(UNIFORM_BLADE, bd.Ritz(150, "eigenfunctions")).steady()
    b = np.sqrt(np.sqrt(np.diag(pencil.K0) / np.diag(pencil.M)))
    np.testing.assert_allclose(
        b[9:], np.pi * (np.arange(10, 151) - 0.5), rtol=1e-12
    )  # cosh b is inf to rounding
    np.testing.assert_allclose(b[:5] ** 2, exact_eigenvalues(0), rtol=1e-12)


@pytest.mark.parametrize("basis", ["legendre", "eigenfunctions"])
def test_frequencies_do_not_rise_as_the_basis_grows(basis: str) -> None:
    """Frequencies of a larger Ritz space are not higher (Courant-Fischer)."""
    found = [computed_eigenvalues(12, bd.Ritz(n, basis), 3) for n in (8, 12, 16, 24)]  # pyright: ignore[reportArgumentType]
    assert (np.diff(found, axis=0) < 1e-12 * np.array(found[0])).all()
