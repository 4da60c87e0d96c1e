"""Table 3's transient: our method against scipy's integrators, and energy over a million periods.

Run: python -m benchmarks.transient            (some minutes: the stock integrators take most of it)
"""

from __future__ import annotations

from collections.abc import Iterator
from time import perf_counter
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

import beamdyn as bd
from beamdyn.transient.gauss import propagate
from benchmarks.cases.oscillators import Oscillator
from benchmarks.cases.scenes import ROLLING
from benchmarks.cases.table_3 import handwritten, modal_system
from benchmarks.rows import Row, best_time, show

T_END, MODES = 30.0, 5
STOCK = [  # method, rtol, and atol in modal coordinates, which are about 1e-5 kg^1/2 m
    ("Radau", 1e-6, 1.5e-12),
    ("LSODA", 5e-7, 5e-13),
    ("DOP853", 1e-4, 1.5e-10),
]


def race_stock_integrators() -> Iterator[Row]:
    """Yield times, and errors against a far more accurate run, relative to the peak deflection.

    The error of our method is measured also between time steps, those of scipy's methods only at their steps.
    """
    exact = bd.simulate(ROLLING, T_END, MODES, tolerance=1e-10)
    peak, t = exact.peak(20.0, 30.0), np.linspace(0, T_END, 30001)
    ours = best_time(lambda: bd.simulate(ROLLING, T_END, MODES, tolerance=1e-5))
    run = bd.simulate(ROLLING, T_END, MODES, tolerance=1e-5)
    error = np.abs(run.deflection(t) - exact.deflection(t)).max() / peak
    yield "ours, tolerance 1e-5: time [s]", f"{ours:.3f}", "0.1"
    yield "... largest error over the peak", f"{error:.1e}", "1e-5"
    yield "... estimated", f"{run.time_error / peak:.1e}", "above the error"
    comparable = []
    for method, rtol, atol in STOCK:
        time, stock_error, peak_of_stock = run_stock(method, rtol, atol, exact)
        if stock_error / peak >= error:
            comparable.append(time)
        yield f"solve_ivp {method}, rtol {rtol:g}: time [s]", f"{time:.1f}", ""
        yield "... largest error over the peak", f"{stock_error / peak:.1e}", ""
        yield "... its peak in 20...30 s [mm]", f"{1e3 * peak_of_stock:.6f}", "1.942558 +- 3e-5"
    yield "fastest of these with an error not below ours, over ours", f"{min(comparable) / ours:.0f}", "250"


def run_stock(method: str, rtol: float, atol: float, exact: bd.Transient) -> tuple[float, float, float]:
    """Return the time of a scipy method, its largest error [m] and its peak deflection [m]."""
    solution, time = solve_stock(method, rtol, atol)
    thin = slice(None, None, max(1, len(solution.t) // 300_000))
    t = np.linspace(0, T_END, 300_001) if solution.sol else solution.t[thin]
    y = solution.sol(t) if solution.sol else solution.y[:, thin]
    tip = y[:MODES].T @ exact.system.tip
    return time, float(np.abs(tip - exact.deflection(t)).max()), find_summit(np.abs(tip[t >= 20]))


def solve_stock(method: str, rtol: float, atol: float) -> tuple[Any, float]:
    """Return the solution of Table 3's transient by a scipy method, and the computing time [s]."""
    rhs, jacobian = handwritten(modal_system(MODES))
    extra = {"dense_output": False} if method == "DOP853" else {"jac": jacobian, "dense_output": True}
    start = perf_counter()
    solution = solve_ivp(rhs, (0, T_END), np.zeros(2 * MODES), method, rtol=rtol, atol=atol, **extra)
    return solution, perf_counter() - start


def find_summit(size: np.ndarray) -> float:
    """Find the maximum of equally spaced samples, by parabolas through each local maximum."""
    left, middle, right = size[:-2], size[1:-1], size[2:]
    top = (middle >= left) & (middle > right)
    bend = 2 * middle[top] - left[top] - right[top]
    return float((middle[top] + (right[top] - left[top]) ** 2 / (8 * bend)).max())


def time_handwritten() -> Iterator[Row]:
    """Yield the time of a call of the hand-written right-hand side, and the check of its result."""
    equations = modal_system(MODES)
    rhs, _ = handwritten(equations)
    y = np.linspace(1e-6, 2e-6, 2 * MODES)
    time = best_time(lambda: [rhs(12.3, y) for _ in range(1000)]) * 1e3
    yield "hand-written right-hand side [us a call]", f"{time:.1f}", "25"
    off = max(np.abs(rhs(t, y) / equations.rhs(t, y) - 1).max() for t in (1.2, 9.9, 12.3))
    yield "... its deviation from the equations", f"{off:.0e}", "1e-9"


def compare_table_3() -> Iterator[Row]:
    """Yield the peak of Table 3, by the number of modes and by finite elements."""
    for modes in (1, 2, 3, 4, 5, 6):
        run = bd.simulate(ROLLING, T_END, modes, tolerance=1e-6)
        yield f"largest deflection in 20...30 s, {modes} modes [mm]", f"{1e3 * run.peak(20, 30):.6f}", ""
    fem = bd.simulate(ROLLING, T_END, MODES, discretization="fem")
    yield "the same by finite elements, 5 modes [mm]", f"{1e3 * fem.peak(20, 30):.6f}", "1.942558"
    full = bd.simulate(ROLLING, T_END, modes=None, discretization=bd.Fem(20, "uniform"), tolerance=1e-4)
    yield "the same by 20 elements, not reduced [mm]", f"{1e3 * full.peak(20, 30):.6f}", "1.94246 +- 1e-4"


def measure_chosen_modes() -> Iterator[Row]:
    """Yield time and error with five modes at rest, and with the basis that `tolerance=` chooses."""
    exact = bd.simulate(ROLLING, T_END, tolerance=1e-8)
    t = np.linspace(0, T_END, 30001)
    tip = exact.deflection(t)
    for modes, tolerance in ((5, 1e-5), ("auto", 1e-3), ("auto", 1e-5)):
        run = bd.simulate(ROLLING, T_END, modes, tolerance)
        time = best_time(lambda m=modes, tol=tolerance: bd.simulate(ROLLING, T_END, m, tol))
        error = np.abs(run.deflection(t) - tip).max() / exact.largest
        stated = run.time_error / run.largest + run.mode_error
        name = f"{run.request.basis}, tolerance {tolerance:g}"
        yield f"{name}: time [s]", f"{time:.3f}", ""
        yield f"{name}: time-integration and modal truncation error", f"{error:.1e}", f"{stated:.1e} stated"
    loose, tight = (
        best_time(lambda tol=tol: bd.simulate(ROLLING, T_END, MODES, tol)) for tol in (1e-3, 1e-10)
    )
    yield "tolerance 1e-3 instead of 1e-10, 5 modes: times faster", f"{tight / loose:.0f}", "5"


def measure_energy_drift() -> Iterator[Row]:
    """Yield the energy drift of an oscillator over a million periods in ten steps each."""
    periods = 1_000_000
    segment = propagate(Oscillator(), 0, 2 * np.pi * periods, 10 * periods, np.ones(1), np.zeros(1), 8)
    drift = np.abs((segment.state[:, 1:] ** 2).sum(axis=1) - 1).max()
    yield "energy drift over 1e6 periods, 10 steps each", f"{drift:.1e}", "1e-9"


PARTS = time_handwritten, compare_table_3, measure_chosen_modes, measure_energy_drift, race_stock_integrators


if __name__ == "__main__":
    show("transients", *PARTS)
