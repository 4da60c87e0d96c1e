"""Accuracy and speed of natural frequencies and their limits.  Run: python -m benchmarks.frequencies

The results are compared with the power series, published tables and the published harvester.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from tempfile import TemporaryDirectory
from time import process_time

import numpy as np
from threadpoolctl import threadpool_limits

import beamdyn as bd
from benchmarks.cases.scenes import HARVESTER, generated_cases, of_case, published_cases
from benchmarks.cases.uniform_blade import computed_eigenvalues, exact_eigenvalues
from benchmarks.peers import pybmodes
from benchmarks.peers.ours import BLADE_SCENE
from benchmarks.rows import Row, best_time, show, time_text

_CALLS = 50  # number of calls (of milliseconds each), of which the shortest counts
_FIRST_CALL = """
import beamdyn as bd
bd.natural_modes(bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0), bd.Mount(0.0)), 1.0)
"""


def compare_with_tables() -> Iterator[Row]:
    """Compare all published and generated rotating beams, by both discretizations."""
    for discretization, bound in (("ritz", "1e-9"), ("fem", "1e-6")):
        worst, covered, values = 0.0, 0, 0
        for case in generated_cases():
            squared = np.array([float(text) for text in case["lambda_squared"]])
            modes = bd.natural_modes(of_case(case), case["gamma"], len(squared), discretization)
            true = np.abs(np.abs(modes.eigenvalue) / np.sqrt(np.abs(squared)) - 1)
            worst, values = max(worst, float(true.max())), values + len(true)
            covered += int((true <= modes.error).sum())
        name = f"{values} values of the power series, {discretization}"
        yield f"{name}: worst relative error", f"{worst:.1e}", bound
        yield (
            f"... of which the stated error covers the true one, {discretization}",
            str(covered),
            str(values),
        )
        worst = max(float(find_deviation(case, discretization).max()) for case in published_cases())
        name = f"published tables (9 to 13 digits), {discretization}"
        yield f"{name}: worst relative deviation", f"{worst:.1e}", bound


def find_deviation(case: dict, discretization: str) -> np.ndarray:
    """Compute relative deviations from the printed digits of a published case."""
    expected = np.array(case["frequency"])
    modes = bd.natural_modes(of_case(case), case["gamma"], len(expected), discretization)
    return np.abs(2 * np.pi * modes.frequency / expected - 1)


def compare_published_scene() -> Iterator[Row]:
    """Compare frequencies, buckling speed and setting-angle limits of the tyre harvester."""
    for speed, ansys in ((0.0, 65.230), (50.0, 61.963), (100.0, 50.907)):
        f = bd.natural_modes(HARVESTER, speed, 1).frequency[0]
        yield f"Table 2 at {speed:g} rad/s [Hz]", f"{f:.8f}", f"ANSYS {ansys:.3f} +- 0.001"
    yield "buckling speed [rad/s]", f"{bd.critical_speed(HARVESTER):.9f}", "159.818332659"
    first, second = np.degrees(list(bd.setting_angle_limits(HARVESTER, 400.0)))
    yield "first setting-angle limit [deg]", f"{first:.5f}", "88.35985"
    yield "second, converged at 400 rad/s [deg]", f"{second:.4f}", "88.5343"
    five = bd.setting_angle_limits(HARVESTER, np.inf, bd.Ritz(5, "eigenfunctions")).second
    yield "second, five eigenfunctions [deg]", f"{np.degrees(five):.4f}", "89.6267"


def check_many_functions() -> Iterator[Row]:
    """Yield the largest error for increasing numbers of trial functions: no digit may be lost."""
    for gamma in (0, 12):
        expected, worst = exact_eigenvalues(gamma), 0.0
        for n in (20, 40, 80, 120, 160, 200):
            worst = max(worst, float(np.abs(computed_eigenvalues(gamma, bd.Ritz(n)) / expected - 1).max()))
        yield f"five lowest, 20...200 functions, gamma {gamma}: worst error", f"{worst:.1e}", "1e-12"


def time_locus() -> Iterator[Row]:
    """Yield time and error of frequencies over 1000 speeds, and the time of the command's help."""
    speeds = np.linspace(0, 150, 1000)
    locus = bd.frequency_locus(HARVESTER, speeds, 3)
    time = best_time(lambda: bd.frequency_locus(HARVESTER, speeds, 3))
    yield "locus of 1000 speeds, 3 modes [s]", f"{time:.3f}", "0.05"
    exact = bd.frequency_locus(HARVESTER, speeds, 3, bd.Ritz(40))
    yield (
        "... its largest relative error",
        f"{np.abs(locus.frequency / exact.frequency - 1).max():.1e}",
        "1e-10",
    )
    help_time = best_time(
        lambda: subprocess.run([sys.executable, "-m", "beamdyn", "--help"], capture_output=True)
    )
    yield "beamdyn --help [s]", f"{help_time:.2f}", "0.5"


def time_one_call() -> Iterator[Row]:
    """Yield times of one call for a uniform blade, of pyBModes with 5 elements, and of the first call."""
    scenes = (
        replace(BLADE_SCENE, beam=replace(BLADE_SCENE.beam, length=1 + 1e-13 * k)) for k in range(_CALLS)
    )
    built, speed = iter([*scenes]), 6.0
    with threadpool_limits(1):
        call = partial(bd.natural_modes, speed=speed, modes=1, tolerance=1e-3)
        ours = best_time(lambda: call(next(built)), _CALLS, process_time)
    said, what = "not installed", f"one call, tolerance 1e-3, over {pybmodes.NAME} with 5 elements"
    if pybmodes.version() is not None:
        with threadpool_limits(1), pybmodes.model(pybmodes.deck(5, speed), pybmodes.SECTIONS) as blade:
            theirs = best_time(lambda: blade.run(n_modes=1, check_model=False), _CALLS, process_time)
        said = f"{ours / theirs:.2f}"
    yield f"uniform blade: {what}", f"{said} ({time_text(ours)})", "0.5"
    ratio = time_process(_FIRST_CALL) / time_process("import scipy.linalg")
    yield "import and first call over `import scipy.linalg`", f"{ratio:.2f}", "1.5"


def time_process(script: str) -> float:
    """Measure the shortest processor time [s] of fresh processes that run a script.

    Bytecode is cached between processes, as for an installed package.
    """

    def taken() -> float:
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime

    with TemporaryDirectory() as folder:
        kept = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
        environment = {**kept, "PYTHONPYCACHEPREFIX": folder}
        run = partial(subprocess.run, [sys.executable, "-c", script], check=True, env=environment)
        return best_time(run, 5, taken)


PARTS = compare_with_tables, compare_published_scene, check_many_functions, time_locus, time_one_call


if __name__ == "__main__":
    show("frequencies", *PARTS)
