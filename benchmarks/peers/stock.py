"""scipy's solve_ivp: Table 3's transient in three modes, with hand-written right-hand side and Jacobian."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import scipy
from scipy.integrate import solve_ivp

from benchmarks.cases.table_3 import handwritten, modal_system
from benchmarks.peers import measure
from benchmarks.peers.measure import Point, peak, shortest
from benchmarks.peers.ours import largest_deflection

NAME = "solve_ivp"
BETTER = "any equations, linear or not, given as a function; stops at events"
TARGET = None
MODES = 3
SETTINGS = (("LSODA", 1e-6), ("Radau", 1e-5), ("DOP853", 1e-4))  # method and relative tolerance
SAMPLES = 50_000  # number of samples in the window


def version() -> str | None:
    return f"scipy {scipy.__version__}"


def points() -> Iterator[Point]:
    system = modal_system(MODES)
    rhs, jacobian = handwritten(system)
    t = np.linspace(*measure.WINDOW, SAMPLES)
    for method, rtol in SETTINGS:
        extra = {} if method == "DOP853" else {"jac": jacobian}
        time, solution = shortest(
            lambda method=method, rtol=rtol, extra=extra: solve_ivp(
                *(rhs, (0, measure.T_END), np.zeros(2 * MODES), method, t),
                **(extra | {"rtol": rtol, "atol": 1e-4 * rtol}),
            ),
            1,
        )
        error = abs(peak(t, system.tip @ solution.y[:MODES]) / largest_deflection() - 1)
        yield Point(measure.ROLLING, NAME, f"{method}, rtol {rtol:g}, {MODES} modes", time, error)
