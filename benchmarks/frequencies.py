"""Accuracy and speed of the beam core.  Run: python -m benchmarks.beam_core

Prints every figure that the README quotes of it, each beside its bound.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator

import numpy as np

import beamdyn as bd
from benchmarks.cases.scenes import HARVESTER, generated_cases, of_case, published_cases
from benchmarks.cases.uniform_blade import computed_eigenvalues, exact_eigenvalues
from benchmarks.rows import Row, best_time, show


def tables() -> Iterator[Row]:
    """All published and generated rotating beams, by both methods."""
    for method, bound in (("ritz", "1e-9"), ("fem", "1e-6")):
        worst, covered, values = 0.0, 0, 0
        for case in generated_cases():
            squared = np.array([float(text) for text in case["lambda_squared"]])
            found = bd.natural_modes(of_case(case), case["gamma"], len(squared), method)
            true = np.abs(np.abs(found.eigenvalue) / np.sqrt(np.abs(squared)) - 1)
            worst, values = max(worst, float(true.max())), values + len(true)
            covered += int((true <= found.error).sum())
        yield f"{values} values of the power series, {method}: worst relative error", f"{worst:.1e}", bound
        yield f"... of which the stated error covers the true one, {method}", f"{covered}", f"{values}"
        worst = max(float(deviation(case, method).max()) for case in published_cases())
        yield f"published tables (9 to 13 digits), {method}: worst relative deviation", f"{worst:.1e}", bound


def deviation(case: dict, method: str) -> np.ndarray:
    """Relative deviations from the published digits."""
    expected = np.array(case["frequency"])
    found = bd.natural_modes(of_case(case), case["gamma"], len(expected), method)
    return np.abs(2 * np.pi * found.frequency / expected - 1)


def published_scene() -> Iterator[Row]:
    """The tyre harvester."""
    for speed, ansys in ((0.0, 65.230), (50.0, 61.963), (100.0, 50.907)):
        f = bd.natural_modes(HARVESTER, speed, 1).frequency[0]
        yield f"Table 2 at {speed:g} rad/s [Hz]", f"{f:.8f}", f"ANSYS {ansys:.3f} +- 0.001"
    yield "buckling speed [rad/s]", f"{bd.critical_speed(HARVESTER):.9f}", "159.818332659"
    first, second = np.degrees(list(bd.setting_angle_limits(HARVESTER, 400.0)))
    yield "first setting-angle limit [deg]", f"{first:.5f}", "88.35985"
    yield "second, converged at 400 rad/s [deg]", f"{second:.4f}", "88.5343"
    five = bd.setting_angle_limits(HARVESTER, np.inf, bd.Ritz(5, "eigenfunctions")).second
    yield "second, five eigenfunctions [deg]", f"{np.degrees(five):.4f}", "89.6267"


def many_functions() -> Iterator[Row]:
    """Whether digits are lost as the basis grows."""
    for gamma in (0, 12):
        expected, worst = exact_eigenvalues(gamma), 0.0
        for n in (20, 40, 80, 120, 160, 200):
            worst = max(worst, float(np.abs(computed_eigenvalues(gamma, bd.Ritz(n)) / expected - 1).max()))
        yield f"five lowest, 20...200 functions, gamma {gamma}: worst error", f"{worst:.1e}", "1e-12"


def speed() -> Iterator[Row]:
    """Times after import, and of the commands."""
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


PARTS = tables, published_scene, many_functions, speed


def main() -> None:
    show("beam core", *PARTS)


if __name__ == "__main__":
    main()
