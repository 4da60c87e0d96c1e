"""Motion in time and resonance of Lee and Yoo: Table 3, Fig. 5, 6 and 7."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import brentq

from beamdyn.common.results.comparison import Comparison
from beamdyn.common.results.pictures import COLOURS
from beamdyn.published import load
from beamdyn.reproduce.common import BENDS, OWN, PAPER, TOP, decimals, rolling_scene
from beamdyn.results.of_motion import sweep_peaks
from beamdyn.scene.physics import Physics
from beamdyn.scene.scene import Scene
from beamdyn.steady.crossings import Crossings
from beamdyn.steady.resonance import resonance_speeds
from beamdyn.steady.response import steady_response
from beamdyn.transient.simulate import simulate
from beamdyn.transient.sweep import Sweep, sweep
from beamdyn.transient.transient import Transient

_MODES = 5  # of the published run
_TOLERANCE = 1e-6  # of the time integration
_BENT_TOLERANCE = 1e-5  # of the same with large deflection, which takes far longer
_SPEEDS = np.linspace(0, TOP, 151)  # of Fig. 6
_DAMPING = 0.01  # damping ratio with which the ring-down decays before 20 s
_MM = 1e3  # millimetres in a metre


def largest_deflections() -> Iterator[Comparison]:
    """Compare with Table 3: the largest tip deflection [mm] in 20 to 30 s, by 1 to 6 modes and by FE."""
    paper = load("lee_yoo_2019")
    printed, exact = paper["largest_deflection"], paper["reference"]["largest_deflection"]
    known = dict(zip(exact["modes"], exact["in_window"]["value"], strict=True))
    for modes, name, discretization in [*((n, "Ritz", "ritz") for n in range(1, 7)), (_MODES, "FE", "fem")]:
        run = _published_run(modes, discretization)
        what = f"{modes} mode{'s' * (modes > 1)}, {name}"
        ours, error = _MM * run.peak(*_window()), _MM * run.time_error
        few = "too few modes (7)" if modes < 3 else ""
        yield Comparison(what, PAPER, _MM * printed["proposed"]["value"], ours, error, 2, few)
        if modes == _MODES:
            recurdyn = _MM * printed["recurdyn"]["value"]
            yield Comparison(what, "RecurDyn (4)", recurdyn, ours, error, 2, "unexplained (6)")
        yield Comparison(what, OWN, _MM * known[modes], ours, error, 6)


def largest_deflections_of_bent_beam() -> Iterator[Comparison]:
    """Compare with Table 3: the largest tip deflection [mm] in 20 to 30 s with large deflection."""
    paper = load("lee_yoo_2019")
    printed, exact = paper["largest_deflection"], paper["reference"]["largest_deflection_elastica"]
    for modes, known in zip(exact["modes"], exact["in_window"]["value"], strict=True):
        run, what = _bent_run(modes), f"{modes} modes, bent beam"
        ours, error = _MM * run.peak(*_window()), _MM * run.time_error
        if modes == _MODES:
            yield Comparison(what, PAPER, _MM * printed["proposed"]["value"], ours, error, 2, BENDS)
            recurdyn = _MM * printed["recurdyn"]["value"]
            yield Comparison(what, "RecurDyn (4)", recurdyn, ours, error, 2, "unexplained (6)")
        yield Comparison(what, OWN, _MM * known, ours, error, 5)


def resonances() -> Iterator[Comparison]:
    """Compare with Fig. 7: speeds [rad/s] at which an excited frequency equals the first natural one."""
    reference = load("lee_yoo_2019")["reference"]
    further = reference["further_resonance_speeds"]
    forced, parametric = reference["resonance_speeds"]["value"], further["parametric"]["value"]
    for name, discretization in (("Ritz", "ritz"), ("FE", "fem")):
        crossings = _crossings(rolling_scene(), discretization)
        yield from _crossing_rows(crossings, "forced", forced, name)
        yield from _crossing_rows(crossings, "parametric", parametric, name)
    heavy = _crossings(replace(rolling_scene(), gravity=9.81))
    yield from _crossing_rows(heavy, "forced", [*forced, further["gravity"]["value"]], "gravity")


def _crossing_rows(crossings: Crossings, kind: str, values: list[float], name: str) -> Iterator[Comparison]:
    """Compare the crossings of a kind with reference values [rad/s]."""
    ours = [c for c in crossings if c.kind == kind]
    for c, value in zip(ours, values, strict=True):
        if name != "gravity" or value == values[-1]:
            what = f"{kind} {c.line.name}, {name}"
            yield Comparison(what, OWN, value, c.speed, c.error * c.speed, decimals(value))


def run_sweep(progress: Callable[[int, int], object] | None = None, speeds: np.ndarray = _SPEEDS) -> Sweep:
    """Compute Fig. 6: the largest deflection in 20 to 30 s over speed."""
    workers = min(2, os.cpu_count() or 1)
    return sweep(rolling_scene(), speeds, _window(), modes=_MODES, workers=workers, progress=progress)


def sweep_peak_comparisons(result: Sweep) -> Iterator[Comparison]:
    """Compare the peaks of Fig. 6: their number, and their speeds [rad/s] with the crossings of Fig. 7."""
    paper, indices = load("lee_yoo_2019"), sweep_peaks(result)
    count = paper["figures"]["fig_6"]["peaks"]
    yield Comparison("number of peaks", PAPER, count, len(indices), 0.0, 0)
    forced, half = paper["reference"]["resonance_speeds"]["value"], float(np.diff(result.speeds).max()) / 2
    for i, (index, value) in enumerate(zip(indices, forced, strict=False), 1):
        yield Comparison(f"speed of peak {i}", OWN, value, float(result.speeds[index]), half, 4)


def steady_amplitudes() -> Iterator[Comparison]:
    """Compare the steady amplitude [mm] at the speed of Table 3; the paper prints none."""
    paper = load("lee_yoo_2019")
    exact, printed = paper["reference"]["steady_response"], paper["largest_deflection"]["proposed"]
    response = steady_response(rolling_scene(), [_speed()], _MODES)
    largest, bound = float(_MM * response.amplitude[0]), float(_MM * response.bound[0])
    error = float(response.error[0]) * bound
    what = "steady amplitude, undamped"
    yield Comparison(what, PAPER, _MM * printed["value"], largest, error, 2, "ring-down (8)")
    yield Comparison(what, OWN, _MM * exact["largest_deflection"]["value"], largest, error, 6)
    yield Comparison("sum of the lines", OWN, _MM * exact["line_sum"]["value"], bound, error, 6)
    damped = replace(rolling_scene(), damping_ratio=_DAMPING)
    tail = simulate(damped, _t_end(), _MODES, _TOLERANCE)
    steady = float(_MM * steady_response(damped, [_speed()], _MODES).amplitude[0])
    ours, error = _MM * tail.peak(*_window()), _MM * tail.time_error
    yield Comparison("damped transient in 20 to 30 s", "harmonic balance (8)", steady, ours, error, 4)


def notes() -> Iterator[str]:
    """Notes on the tables."""
    run = _published_run()
    passage, line = _passage()
    start, end = _window()
    steady = _MM * float(steady_response(rolling_scene(), [_speed()], _MODES).amplitude[0])
    peak = _MM * run.peak(start, end)
    low, high = (
        _MM * v for v in load("lee_yoo_2019")["reference"]["largest_deflection_exudyn"]["in_window"]["value"]
    )
    yield (
        "(6) By another program, whose settings are not known. The response is sensitive to them: Exudyn, "
        f"whose integrator damps, gives {low:.2f} to {high:.2f} mm."
    )
    yield "(7) Three modes and more give the digits of the paper; one and two do not."
    yield (
        f"(8) The {peak:.2f} mm of Table 3 are ring-down: on its way to {_speed():g} rad/s the wheel passes "
        f"the resonance at {line:.2f} rad/s at {passage:.2f} s, and without damping the vibration excited "
        f"there remains. The steady amplitude at {_speed():g} rad/s is {steady:.2f} mm, {peak / steady:.1f} "
        f"times less; with a damping ratio of {_DAMPING:g} the transient decays to it."
    )


def _passage() -> tuple[float, float]:
    """Time [s] at which the spin-up passes the first resonance, and its speed [rad/s]."""
    scene = rolling_scene()
    first = next(c.speed for c in _crossings(scene) if c.kind == "forced")
    motion = scene.motion
    assert motion is not None
    time = brentq(lambda t: float(motion.at(np.array([t])).speed[0]) - first, 0.0, motion.steady_start)
    return float(time), first  # pyright: ignore[reportArgumentType]  (brentq returns a float)


def fig_5() -> Figure:
    """Draw the tip deflection over time."""
    figure = Figure(figsize=(7.5, 4.8), layout="constrained")
    ax = _published_run().plot(figure.subplots())
    passage, line = _passage()
    ax.axvline(passage, color="0.3", linestyle="--", linewidth=1, label=f"passage through {line:.2f} rad/s")
    ax.axvspan(*_window(), color="0.93", zorder=0, label="window of Table 3")
    ax.set_ylim(top=3.2)
    ax.legend(fontsize=10, loc="upper left")
    ax.set_title(f"Fig. 5: tip deflection, spin-up to {_speed():g} rad/s")
    return figure


def fig_6(result: Sweep) -> Figure:
    """Draw the largest deflection over speed, with the steady amplitude."""
    figure = Figure(figsize=(7.5, 4.8), layout="constrained")
    ax = result.plot(figure.subplots())
    ax.lines[0].set_label("undamped transient, 20 to 30 s")
    speeds = np.linspace(1, TOP, 1000)
    steady = _MM * steady_response(rolling_scene(), speeds, 3).amplitude
    ax.plot(speeds, steady, color=COLOURS[1], linewidth=1.2, label="steady amplitude")
    ax.set_ylim(0, 1.1 * _MM * float(result.peaks.max()))
    ax.legend(fontsize=10, loc="upper right")
    ax.set_title("Fig. 6: largest tip deflection over speed")
    return figure


def fig_7() -> Figure:
    """Draw the first natural frequency and the two excited frequencies over speed."""
    figure = Figure(figsize=(7.5, 4.8), layout="constrained")
    crossings = _crossings(rolling_scene())
    ax = crossings.plot(figure.subplots())
    for c in crossings:
        if c.kind == "forced":
            label, at = f"{c.speed:.2f} rad/s", (c.speed, c.frequency)
            ax.annotate(label, at, (13, 3), textcoords="offset points", fontsize=9)
    ax.set_title("Fig. 7: first natural frequency and excited frequencies")
    return figure


def _crossings(scene: Scene, discretization: str = "ritz") -> Crossings:
    return resonance_speeds(scene, TOP, 1, discretization=discretization)


def _published_run(modes: int = _MODES, discretization: str = "ritz") -> Transient:
    return simulate(rolling_scene(), _t_end(), modes, _TOLERANCE, discretization=discretization)


@cache
def _bent_run(modes: int) -> Transient:
    """The published run with large deflection."""
    scene = replace(rolling_scene(), physics=Physics(large_deflection=True))
    return simulate(scene, _t_end(), modes, _BENT_TOLERANCE)


def _window() -> tuple[float, float]:
    start, end = load("lee_yoo_2019")["scene"]["window"]["value"]
    return start, end


def _t_end() -> float:
    return load("lee_yoo_2019")["scene"]["t_end"]["value"]


def _speed() -> float:
    return load("lee_yoo_2019")["largest_deflection"]["speed"]["value"]
