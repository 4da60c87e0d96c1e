"""Frequency and random responses and state spaces by two methods.  Run: python -m benchmarks.responses

The scene is a steel beam of 50 mm with a tip body, damped in three ways, at 50 rad/s up to 2000 Hz.  Compared
are 60 finite elements with direct complex solutions of the same matrices, assumed modes with these elements,
mean squares with quadrature of the density, and the state space in `scipy.signal.lsim` with `simulate`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

import beamdyn as bd
from benchmarks.rows import Row, best_time, show

SPEED, FREQUENCIES, ELEMENTS = 50.0, np.geomspace(1.0, 2000.0, 120), bd.Fem(60)
STEP, SAMPLES = 2.5e-3, 41


def damped_scene() -> bd.Scene:
    """Make the damped scene on which all methods are compared."""
    tip = bd.TipMass(1e-4, offset=1e-3, inertia=1e-10)
    beam = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, tip)
    damping = bd.Damping(tip_damper=1e-3, stiffness_factor=1e-6)
    return bd.Scene(beam, bd.Mount(0.215, np.pi, 0.7), damping_ratio=0.01, damping=damping)


def compare() -> Iterator[Row]:
    """Yield deviations, relative to the largest value, beside the bounds used in the tests."""
    scene = damped_scene()
    elements = bd.frequency_response(scene, SPEED, FREQUENCIES, discretization=ELEMENTS)
    direct = _solve_directly(scene)
    few = bd.frequency_response(scene, SPEED, FREQUENCIES, modes=20, discretization=ELEMENTS)
    yield "60 elements: response over direct solves", _say(elements.response[:, 0], direct), "1e-8"
    yield "... with 20 modes and static correction", _say(few.response[:, 0], direct), "1e-8"
    for output in ("tip", "root strain"):
        ritz, fem = (
            bd.frequency_response(scene, SPEED, FREQUENCIES, "bending", output, discretization=d)
            for d in ("ritz", ELEMENTS)
        )
        yield f"assumed modes over 60 elements: {output}", _say(ritz.response, fem.response), "1e-5"
    taken = best_time(lambda: bd.frequency_response(scene, SPEED, FREQUENCIES), runs=3)
    yield f"{len(FREQUENCIES)} frequencies by assumed modes [ms]", f"{1e3 * taken:.0f}", "-"
    yield "mean square over quadrature of the density", f"{_quadrature(scene):.0e}", "1e-9"
    yield "state space by lsim over simulate", f"{_in_time(scene):.0e}", "1e-6"


def _say(found: np.ndarray, exact: np.ndarray) -> str:
    return f"{np.abs(found - exact).max() / np.abs(exact).max():.0e}"


def _solve_directly(scene: bd.Scene) -> np.ndarray:
    M = bd.matrices(scene, SPEED, discretization=ELEMENTS)
    tip, C = M.deflection([scene.beam.length])[0], M.damping + M.gyroscopic
    w = 2 * np.pi * FREQUENCIES[:, None, None]
    q = np.linalg.solve(M.stiffness + 1j * w * C - w**2 * M.mass, M.input_matrix[:, :1])
    return q[..., 0] @ tip


def _quadrature(scene: bd.Scene) -> float:
    """Compute the relative deviation of a mean square from Gauss quadrature of the density."""
    psd = bd.PowerSpectrum([5.0, 40.0, 150.0], [1.0, 3.0, 0.2])
    found = bd.random_response(scene, SPEED, psd, modes=4)
    resonance = float(bd.natural_modes(scene, SPEED, 1).frequency[0])
    dense = resonance + np.linspace(-1, 1, 41) ** 3 * 60
    ends = np.union1d(psd.frequencies, dense[(dense > 5) & (dense < 150)])
    nodes, weights = np.polynomial.legendre.leggauss(20)
    half = np.diff(ends)[:, None] / 2
    f = (ends[:-1, None] + half + half * nodes).ravel()
    density = bd.random_response(scene, SPEED, psd, frequencies=f, modes=4).psd
    return abs(found.rms**2 / float((half * weights).ravel() @ density) - 1)


def _in_time(scene: bd.Scene) -> float:
    """Compute the largest deviation of lsim from simulate, over the largest deflection."""
    from scipy.signal import lsim

    steps = np.random.default_rng(1).normal(size=SAMPLES)
    a = np.cumsum(steps) * 0.1
    t = STEP * np.arange(SAMPLES)
    motion = bd.SampledTranslation(t.tolist(), along_n3=a.tolist(), rotation=SPEED)
    few = bd.Ritz(5)
    moved = replace(scene, motion=motion, mount=bd.Mount(0.215, np.pi, np.pi / 2))
    run = bd.simulate(moved, t[-1], None, tolerance=1e-8, discretization=few, t_eval=t)
    system = bd.state_space(moved, SPEED, ["n3"], modes=None, discretization=few)
    _, y, _ = lsim(system, a, t)
    return float(np.abs(np.ravel(y) - run.tip).max() / run.largest)


PARTS = (compare,)


if __name__ == "__main__":
    show("responses", *PARTS)
