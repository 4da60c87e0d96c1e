"""The lowest modes of large gyroscopic systems, which are sought in Krylov spaces."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import ortho_group

from beamdyn.modes.modal.quadratic_eigenproblem import solve_gyroscopic

N = 320  # number of coordinates, more than are solved by full matrices


@pytest.mark.parametrize("speed", [0.0, 0.1, 3.0, 1e3, 1e5])
@pytest.mark.parametrize("partner", [0, 40], ids=["equal", "different"])
def test_lowest_modes_are_those_of_uncoupled_rotors(partner: int, speed: float) -> None:
    """Rotors on springs, which have the frequencies a and b at rest in two directions, mixed at random.

    Their squared frequencies x are the roots of x^2 - (a^2 + b^2 + 4 speed^2) x + a^2 b^2 = 0.  At high speed
    the lowest modes belong to several rotors, of which the directions `b` are far from the lowest at rest.
    """
    a = np.arange(1.0, N / 2 + 1) ** 2
    b = np.roll(a, partner)
    mixed = ortho_group.rvs(N, random_state=1)
    half = (a**2 + b**2 + 4 * speed**2) / 2
    larger = half + np.sqrt(half**2 - (a * b) ** 2) if speed else np.maximum(a, b) ** 2
    exact = np.sort(np.sqrt(np.concatenate([larger, (a * b) ** 2 / larger])))[:6]
    w = np.concatenate([a, b])  # the coordinates are scaled by 1 / w, so that the stiffness is 1
    J = np.block(
        [[np.zeros((N // 2, N // 2)), np.diag(1 / (a * b))], [np.diag(-1 / (a * b)), np.zeros((N // 2,) * 2)]]
    )
    M, C = (mixed @ A @ mixed.T for A in (np.diag(w**-2.0), 2 * speed * J))
    inverse, y = solve_gyroscopic(M, (C - C.T) / 2, np.ones(N), 6)
    s = 1 / inverse[::-1]
    # The error of 1/s is some rounding errors of the largest 1/s.
    np.testing.assert_allclose(np.abs(s), exact, rtol=1e-14 * exact[-1] / exact[0])
    q = y[:N, ::-1]
    residual = np.linalg.norm(s**2 * (M @ q) + s * (C @ q) + q, axis=0)
    assert (residual < 1e-12 * exact[-1] / exact[0] * np.linalg.norm(q, axis=0)).all()
