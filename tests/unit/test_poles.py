"""Poles of the linear equations at a speed, against eigenvalues of the state matrix by scipy."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
from scipy.optimize import brentq

import beamdyn as bd

STRIP = bd.Beam.rectangular(0.05, 0.01, 2e-4, 2e11, 7850.0)
PLAIN = bd.Scene(STRIP, bd.Mount(0.215))
COUPLED = bd.Scene(
    STRIP,
    bd.Mount(0.215, np.pi, precone=0.2),
    damping=bd.Damping(stiffness_factor=1e-4),
    physics=bd.Physics(planes=2),
)
ROUNDING = 1e-9  # of eigenvalues of unsymmetric matrices whose norm is that of the highest mode


def in_order(values: np.ndarray) -> np.ndarray:
    return values[np.lexsort((values.imag, np.abs(values).round(3)))]


@pytest.mark.parametrize("scene", [PLAIN, COUPLED], ids=["plain", "coupled and damped"])
def test_poles_are_eigenvalues_of_the_state_matrix(scene):
    found = bd.matrices(scene, 50.0, modes=3)
    n, M = len(found.mass), found.mass
    of_state = np.linalg.solve(M, -np.hstack([found.stiffness, found.damping + found.gyroscopic]))
    A = np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), of_state])
    wanted = in_order(scipy.linalg.eigvals(A))
    assert found.poles.shape == (2 * n,)
    assert np.abs(in_order(found.poles) - wanted) == pytest.approx(0, abs=ROUNDING * np.abs(wanted).max())
    of_space = in_order(bd.state_space(scene, 50.0, modes=3).poles)
    assert np.abs(of_space - wanted) == pytest.approx(0, abs=ROUNDING * np.abs(wanted).max())


def test_poles_ascend_and_are_the_frequencies():
    poles = bd.matrices(PLAIN, 50.0, modes=3).poles
    assert (np.diff(np.abs(poles)) >= -1e-9 * np.abs(poles[1:])).all()
    frequencies = bd.natural_modes(PLAIN, 50.0, 3).frequency
    assert np.abs(poles.imag[::2]) / (2 * np.pi) == pytest.approx(frequencies, rel=1e-9)
    assert np.abs(poles.real) == pytest.approx(0, abs=1e-9 * np.abs(poles).max())


def test_a_beam_that_buckles_has_a_pole_to_the_right():
    critical = bd.critical_speed(PLAIN)
    below, above = (bd.matrices(PLAIN, share * critical, modes=2).poles for share in (0.99, 1.01))
    assert below.real.max() < 1e-6 * np.abs(below).max() and above.real.max() > 1.0


@pytest.mark.parametrize("kept", [3, 6, None])
@pytest.mark.parametrize("damper", [0.0, 0.02, 0.5])
def test_errors_of_poles_cover_those_of_many_more_functions(kept, damper):
    """The tip damper couples the kept modes to those left out."""
    scene = bd.Scene(STRIP, bd.Mount(0.215), damping=bd.Damping(tip_damper=damper))
    found, fine = bd.matrices(scene, 50.0, kept), bd.matrices(scene, 50.0, discretization=bd.Ritz(60)).poles
    true = np.abs(found.poles[:, None] - fine).min(axis=1) / np.abs(found.poles)
    assert (true <= found.error).all() and found.error[0] < (1e-9 if kept is None or not damper else 0.01)
    np.testing.assert_array_equal(vars(bd.state_space(scene, 50.0, modes=kept))["error"], found.error)


@pytest.mark.slow
@pytest.mark.parametrize("ends", [(0.5, 0.501), (0.387, 0.3895, 0.782)])
@pytest.mark.parametrize("elements", [100, 200])
def test_errors_of_poles_contain_the_rounding_of_short_elements(ends, elements):
    """Against roots of cos b cosh b = -1; a uniform beam is meshed as one with stations at `ends`."""
    roots = [brentq(lambda b: np.cos(b) + 1 / np.cosh(b), *at) for at in ((1, 2), (4, 5), (7, 8), (10, 11))]
    exact = np.square(roots) * (-0.01 + 1j * np.sqrt(1 - 1e-4))
    scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0, breakpoints=ends), damping_ratio=0.01)
    found = bd.matrices(scene, 0.0, discretization=bd.Fem(elements, on_each=4))
    true = np.abs(found.poles[:, None] - exact) / np.abs(exact)
    assert (true.min(axis=0) <= found.error[true.argmin(axis=0)]).all()
