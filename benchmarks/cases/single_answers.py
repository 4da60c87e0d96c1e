"""Published single values beside ours: slopes, limits, a spin-up, growth, branches."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import pi
from typing import Any

import numpy as np

import beamdyn as bd
from beamdyn.common.results.comparison import Comparison
from beamdyn.modes.modal.model import Model
from beamdyn.published import load
from beamdyn.transient.system import ModalSystem
from benchmarks.cases.elastica import harvester_at, published
from benchmarks.cases.scenes import BLADE_SPIN_UP, HARVESTER, time_unit

FAR = 1e7  # hub radius, over the length, that stands for an infinite one
_STEPS = 1.6 * 0.5 ** np.arange(5)  # squared speeds (nondimensional) at which differences are taken
_UNIFORM = bd.Beam.from_stiffness(1.0, 1.0, 1.0)
_FULL_TURN = 2 * pi
_ROUNDING = 1e-13  # relative rounding error of some thousand steps


def _row(what: str, printed: float, ours: float, error: float, decimals: int) -> Comparison:
    return Comparison(what, "computed", printed, ours, abs(error), decimals)


# Rotating beams -----------------------------------------------------------------------------------


def slopes() -> Iterator[Comparison]:
    """Compare Southwell's slopes: growth of the squared frequency with the squared speed, at rest."""
    known = load("rotating_beams")["southwell"]
    for delta in (0.0, 1.0):
        ours, error = _slopes_at_rest(delta)
        for i, flap in enumerate(known["flap"]):
            printed = flap + delta * known["hub"][i]
            what = f"slope of the squared flap frequency at rest, hub radius {delta:g}, mode {i + 1}"
            yield _row(what, printed, ours[i], error[i], 8)


def _slopes_at_rest(delta: float) -> tuple[np.ndarray, np.ndarray]:
    """Extrapolate difference quotients at decreasing squared speeds to rest; error: the last change."""
    scene = bd.Scene(_UNIFORM, bd.Mount(delta, pi, pi / 2))
    rest, *turning = (_squares(scene, speed) for speed in (0.0, *np.sqrt(_STEPS)))
    rounding = 2e-13 * rest / _STEPS[-1]
    rows = [(found - rest) / step for found, step in zip(turning, _STEPS, strict=True)]
    for order in range(1, len(_STEPS)):
        gain, coarse = 2**order, rows[-1]
        rows = [(gain * fine - rough) / (gain - 1) for rough, fine in pairwise(rows)]
    return rows[0], np.abs(rows[0] - coarse) + rounding


def _squares(scene: bd.Scene, speed: float) -> np.ndarray:
    return np.abs(bd.natural_modes(scene, speed, 3).eigenvalue) ** 2


def limit_of_the_critical_speed() -> Comparison:
    """Compare the squared critical speed times radius of an inward uniform beam, far from the axis."""
    printed = load("rotating_beams")["critical_limit"]["gamma_squared_times_radius"]
    point = bd.critical_point(bd.Scene(_UNIFORM, bd.Mount(FAR, 0.0)))
    ours = point.speed**2 * FAR
    what = f"squared critical speed times hub radius, inward, at a radius of {FAR:.0e}"
    return _row(what, printed, ours, 2 * point.error * ours, 4)


def spin_up() -> Comparison:
    """Compare the largest deflection [m] of the blade of Kane, Ryan and Banerjee and of Simo and Vu-Quoc."""
    run = bd.simulate(BLADE_SPIN_UP, 20.0, modes=8)
    printed = load("rotating_beams")["spin_up"]["largest_deflection"]["value"]
    error = run.time_error + run.mode_error * run.largest
    return _row("spin-up: largest deflection [m], 8 modes", printed, run.largest, error, 5)


def growth_factors() -> Iterator[Comparison]:
    """Compare the largest Floquet multipliers at a speed that varies with about twice the first frequency."""
    for case in load("rotating_beams")["parametric"]:
        for modes, printed in zip(case["modes"], case["spectral_radius"], strict=True):
            what = f"growth over a period of a varying speed, {case['name']}, {modes} mode{'s'[: modes > 1]}"
            ours, coarse = growth_factor(case, modes), growth_factor(case, modes, 16, 1e-10)
            yield _row(what, printed, ours, abs(ours - coarse) + _ROUNDING, 9)


def growth_factor(case: dict[str, Any], modes: int, functions: int = 20, tolerance: float = 1e-12) -> float:
    """Compute the spectral radius of the monodromy matrix, in coordinates of modes at rest."""
    from scipy.integrate import solve_ivp

    nu, delta = case["nu"], case["delta"]
    mount = bd.Mount(abs(delta), 0.0 if delta < 0 else pi, np.radians(case["bending_angle_deg"]))
    equations = Model(bd.Scene(_UNIFORM, mount), bd.Ritz(functions)).modal_equations(modes)
    system = ModalSystem(equations, _varying_speed(case["gamma"], case["depth"], nu))

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        q, v = y.reshape(2, modes, -1)
        return np.concatenate([v, -system.coefficients(np.array(t))[1] @ q]).ravel()

    start = np.eye(2 * modes).ravel()
    period = _FULL_TURN / nu
    end = solve_ivp(rate, (0.0, period), start, "DOP853", rtol=tolerance, atol=tolerance / 10).y[:, -1]
    return float(np.abs(np.linalg.eigvals(end.reshape(2 * modes, 2 * modes))).max())


def _varying_speed(gamma: float, depth: float, nu: float) -> bd.RotationFunction:
    """Make a rotation with the speed gamma (1 + depth cos(nu t))."""
    return bd.RotationFunction(
        angle=lambda t: gamma * (t + depth / nu * np.sin(nu * t)),
        speed=lambda t: gamma * (1 + depth * np.cos(nu * t)),
        acceleration=lambda t: -gamma * depth * nu * np.sin(nu * t),
        t_end=_FULL_TURN / nu,
    )


# Beams that bend far ------------------------------------------------------------------------------


def branches() -> Iterator[Comparison]:
    """Compare the harvester's bent equilibria: frequencies [Hz], first speed, and one at rest."""
    known, unit = published(), time_unit(HARVESTER.beam)
    for row in known["harvester"]:
        where = f"harvester at {row['setting_angle_deg']:g} deg, {row['speed']:g} rad/s, first frequency [Hz]"
        yield _frequency(where, row["frequency"], harvester_at(row["setting_angle_deg"]), row["speed"])
    critical = bd.critical_point(harvester_at(0.0))
    ours = critical.speed * unit
    printed = float(known["pitchfork"]["gamma"])
    yield _row("harvester, inward: critical speed, gamma", printed, ours, critical.error * ours, 6)
    least = known["least_frequency"]
    where = f"harvester at 5 deg, {least['speed']} rad/s, its least first frequency [Hz]"
    yield _frequency(where, least["frequency"], harvester_at(5.0), float(least["speed"]))
    yield from _beside(known["beside"][0], unit)


def _beside(row: dict[str, Any], unit: float) -> Iterator[Comparison]:
    scene = harvester_at(row["setting_angle_deg"], "bent")
    where = f"harvester at 5 deg, {row['speed']:g} rad/s, the other stable equilibrium"
    yield _frequency(f"{where}, lambda", row["frequency"], scene, row["speed"], _FULL_TURN * unit)
    found, length = bd.equilibrium(scene, row["speed"]), scene.beam.length
    for axis, text, value in zip(("along", "across"), row["tip"], found.tip, strict=False):
        what = f"{where}, tip {axis} over the length"
        yield _row(what, float(text), float(value) / length, found.error / length, 3)


def _frequency(what: str, text: str, scene: bd.Scene, speed: float, unit: float = 1.0) -> Comparison:
    modes = bd.natural_modes(scene, speed, 1)
    ours, decimals = unit * float(modes.frequency[0]), len(text.partition(".")[2])
    return _row(what, float(text), ours, float(modes.error[0]) * ours, decimals)
