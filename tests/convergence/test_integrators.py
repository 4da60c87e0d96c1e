"""Order, invariants and error control of the integrators."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import beamdyn as bd
from beamdyn.transient.gauss import propagate, tableau
from benchmarks.cases.oscillators import Oscillator


class Mathieu:
    """q'' + C q' + (K + E cos 3 t) q = f cos 2 t, two coupled coordinates: periodic coefficients."""

    size = 2
    K = np.array([[4.0, 0.5], [0.5, 9.0]])
    E = np.array([[0.4, -0.3], [-0.3, 0.8]])
    C = np.array([[0.02, 0.3], [-0.3, 0.05]])  # damping and gyroscopic coupling
    f = np.array([1.0, -0.5])

    def coefficients(self, t):
        t = np.asarray(t)[..., None, None]
        K = self.K + self.E * np.cos(3 * t)
        return self.C + 0 * K, K, self.f * np.cos(2 * t[..., 0])


class SpinUp(Mathieu):
    """Stiffness that grows smoothly from one level to another, as in a spin-up; no damping."""

    def coefficients(self, t):
        t = np.asarray(t)[..., None, None]
        K = self.K + self.E * np.tanh(t - 2)
        return None, K, self.f / np.cosh(t[..., 0] - 2)


class Constant(Mathieu):
    def coefficients(self, t):
        t = np.asarray(t)[..., None, None]
        return None, self.K + 0 * t, self.f + 0 * t[..., 0]


def rhs(system):
    def y_dot(t, y):
        C, K, f = system.coefficients(np.asarray(t))
        q, v = np.split(y, 2)
        return np.concatenate([v, f - K @ q - (0 if C is None else C @ v)])

    return y_dot


Q0, V0 = np.array([1.0, 0.2]), np.array([0.0, -0.4])


def reference(system, t_end: float) -> np.ndarray:
    y0 = np.concatenate([Q0, V0])
    return solve_ivp(rhs(system), (0, t_end), y0, "DOP853", rtol=1e-13, atol=1e-14).y[:, -1]


@pytest.mark.parametrize("system", [Mathieu(), SpinUp()], ids=["periodic", "spin-up"])
@pytest.mark.parametrize("stages, counts", [(1, (400, 800)), (2, (40, 80)), (3, (20, 40)), (4, (12, 24))])
def test_order_is_twice_the_stages(system, stages: int, counts: tuple[int, int]) -> None:
    exact = reference(system, 4.0)
    errors = [
        np.abs(propagate(system, 0.0, 4.0, n, Q0, V0, stages).state[-1, 1:] - exact).max() for n in counts
    ]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2 * stages, abs=0.35)


def test_eight_stages_reach_rounding_error_at_four_radians_a_step() -> None:
    exact = reference(SpinUp(), 4.0)
    found = propagate(SpinUp(), 0.0, 4.0, 6, Q0, V0, 8).state[-1, 1:]
    np.testing.assert_allclose(found, exact, atol=1e-11)


def test_dense_output_between_steps() -> None:
    path = propagate(Mathieu(), 0.0, 4.0, 10, Q0, V0, 8)
    t = np.linspace(0, 4, 37)
    y0 = np.concatenate([Q0, V0])
    exact = solve_ivp(rhs(Mathieu()), (0, 4), y0, "DOP853", rtol=1e-13, atol=1e-14, t_eval=t).y
    q, v = path.at(t)
    np.testing.assert_allclose(np.concatenate([q.T, v.T]), exact, atol=1e-8)
    times, q, _ = path.samples(4)
    np.testing.assert_allclose(q, path.at(times)[0], atol=1e-13)


def test_tableau_is_that_of_gauss() -> None:
    """Two stages: the textbook's coefficients (Hairer, Lubich, Wanner, table II.1.1)."""
    r = np.sqrt(3) / 6
    np.testing.assert_allclose(tableau(2).A, [[1 / 4, 1 / 4 - r], [1 / 4 + r, 1 / 4]], atol=1e-15)
    np.testing.assert_allclose(tableau(2).b, [1 / 2, 1 / 2], atol=1e-15)
    np.testing.assert_allclose(tableau(2).c, [1 / 2 - r, 1 / 2 + r], atol=1e-15)


@pytest.mark.parametrize("stages", [1, 4, 8])
def test_energy_is_conserved_at_any_step_size(stages: int) -> None:
    K = Constant.K

    def energy(y):
        q, v = y[..., 1:3], y[..., 3:]
        return (v**2).sum(-1) / 2 + np.einsum("...i,ij,...j->...", q, K, q) / 2 - q @ Constant.f

    for steps in (2000, 50):
        states = propagate(Constant(), 0.0, 2000.0, steps, Q0, V0, stages).state
        np.testing.assert_allclose(energy(states), energy(states[0]), rtol=1e-11)


@pytest.mark.slow
def test_energy_over_a_hundred_thousand_periods() -> None:
    """Ten steps a period; the benchmark runs a million periods."""
    periods = 100_000
    piece = propagate(Oscillator(), 0, 2 * np.pi * periods, 10 * periods, np.ones(1), np.zeros(1), 4)
    energy = (piece.state[:, 1:] ** 2).sum(axis=1)
    assert np.abs(energy - 1).max() < 1e-10


def test_solve_ivp_runs_it_with_events_and_output_times() -> None:
    system, t = Mathieu(), np.linspace(0, 4, 41)
    y0 = np.concatenate([Q0, V0])

    def crossing(t, y):
        return y[0]

    options = {"t_eval": t, "events": crossing, "rtol": 1e-10, "atol": 1e-12, "dense_output": True}
    ours = solve_ivp(rhs(system), (0, 4), y0, bd.GaussCollocation, system=system, **options)
    theirs = solve_ivp(rhs(system), (0, 4), y0, "DOP853", **options)
    assert ours.success and len(ours.t) == 41
    np.testing.assert_allclose(ours.y, theirs.y, atol=1e-8)
    np.testing.assert_allclose(ours.t_events[0], theirs.t_events[0], atol=1e-8)
    np.testing.assert_allclose(ours.sol(1.234), theirs.sol(1.234), atol=1e-7)


@pytest.mark.parametrize("rtol", [1e-4, 1e-7, 1e-10])
def test_error_follows_the_tolerance(rtol: float) -> None:
    y0, exact = np.concatenate([Q0, V0]), reference(Mathieu(), 30.0)
    solved = solve_ivp(
        rhs(Mathieu()), (0, 30), y0, bd.GaussCollocation, system=Mathieu(), rtol=rtol, atol=rtol, stages=4
    )
    assert np.abs(solved.y[:, -1] - exact).max() < 30 * rtol * np.abs(solved.y).max()


def test_backward_in_time_is_refused() -> None:
    with pytest.raises(ValueError, match="forward only"):
        solve_ivp(rhs(Mathieu()), (1, 0), np.zeros(4), bd.GaussCollocation, system=Mathieu())
