"""The inward beam of Lee and Yoo (2019): all its numbers beside computed ones, with notes on differences.

The paper's equations are linear about the straight beam. Its numbers stand beside those of the linear model
and of an inextensible beam that bends by any angle.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from scipy.optimize import brentq

import beamdyn as bd
from beamdyn.analyses.results.of_motion import sweep_peaks
from beamdyn.common.results.comparison import Comparison
from beamdyn.common.results.published import values_alone
from beamdyn.modes.modal.model import Model
from beamdyn.published import load

PAPER = load("lee_yoo_2019")
VALUES = values_alone(PAPER)
KNOWN = VALUES["reference"]
SPEED: float = VALUES["largest_deflection"]["speed"]
WINDOW: tuple[float, float] = tuple(VALUES["scene"]["window"])
TOP = 150.0  # highest speed [rad/s], the end of Fig. 6; the ends of Fig. 8 and 9 are not stated
MM = 1e3  # millimetres in a metre

# Names of the sources of values; numbers in parentheses refer to notes.
_PAPER, _ANSYS, _RECURDYN, _OWN = "paper", "ANSYS (4)", "RecurDyn (4)", "independent (5)"
_BENDS = "large deflection (9)"  # reason of differences due to large deflection, which the paper neglects
_METHODS = (("Ritz", "ritz"), ("FE", "fem"))
_MODELS = (("Ritz", "ritz", "bending"), ("FE", "fem", "bending"), ("with stretch", "ritz", "stretch"))
_MODES = 5  # number of modes of the published simulation
_FIGURE_6 = np.linspace(0, TOP, 151)  # speeds of Fig. 6 [rad/s]
_DAMPING = 0.01  # damping ratio with which free vibration decays before 20 s
_ROUNDING = 1e-12  # relative error of a setting-angle limit for a given number of modes: rounding alone
_JUDGED = (100.0, 400.0)  # speeds at which Fig. 8 and 9 are checked [rad/s]: one of Table 2, and a higher one


def inward_scene(setting_angle: float = 0.0, **physics: Any) -> bd.Scene:
    """Build the beam of Table 1 at a setting angle [deg], with effects of `Physics` by their names."""
    given = VALUES["input"]
    names = ("length", "width", "thickness", "youngs_modulus", "density")
    beam = bd.Beam.rectangular(**{name: given[name] for name in names})
    mount = bd.Mount(given["radius"], float(np.radians(setting_angle)))
    return bd.Scene(beam, mount, physics=bd.Physics(**physics))


def rolling_scene(**physics: Any) -> bd.Scene:
    """Build the beam on a wheel that spins up and rolls over the wavy road: Table 3, Fig. 5 to 7."""
    given = VALUES["input"]
    road = bd.RoadWave(given["road_wavelength"], given["road_velocity_amplitude"])
    motion = bd.RollingWheel(given["rolling_radius"], bd.SpinUp(SPEED, VALUES["scene"]["duration"]), road)
    return replace(inward_scene(**physics), motion=motion)


def _compare(what: str, ours: Iterable[Any], *known: tuple) -> Iterator[Comparison]:
    """Compare a computed value and its error, `ours`, with each of the `known` values.

    A known value is a tuple: source, value and, optionally, number of decimals and the reason for a
    difference that is expected.  By default the decimals are those with which Python prints the value.
    """
    number, error = map(float, ours)
    for source, value, *more in known:
        decimals: Any = more[0] if more else len(np.format_float_positional(value).partition(".")[2])
        published = tuple(value) if isinstance(value, list) else value
        yield Comparison(what, source, published, number, error, decimals, *more[1:])


# Frequencies and setting angles -------------------------------------------------------------------------


def _first_frequency(scene: bd.Scene, speed: float, discretization: str = "ritz") -> tuple[float, float]:
    """Compute the first frequency and its estimated error [Hz]."""
    modes = bd.natural_modes(scene, speed, 1, discretization)
    return float(modes.frequency[0]), float(modes.error[0]) * float(modes.frequency[0])


def first_frequencies() -> Iterator[Comparison]:
    """Compare first frequencies [Hz] by Ritz, by FE and with stretch, at three speeds, with Table 2."""
    for row, exact in zip(PAPER["first_frequency"], KNOWN["first_frequency"], strict=True):
        speed, proposed, ansys = (row[name]["value"] for name in ("speed", "proposed", "ansys"))
        decimals = row["proposed"]["decimals"], row["ansys"]["decimals"]
        for name, method, model in _MODELS:
            yield from _compare(
                f"{speed:g} rad/s, {name}",
                _first_frequency(inward_scene(stretch=model == "stretch"), speed, method),
                (_PAPER, proposed, decimals[0], "" if speed else "unexplained (1)"),
                (_ANSYS, ansys, decimals[1]),
                (_OWN, exact[model]),
            )


def limits_of_setting_angle() -> Iterator[Comparison]:
    """Compare with Section 3.3: the two setting-angle limits [deg].

    The second limit is computed for bases of several sizes at an infinite top speed, then converged for
    several finite top speeds.
    """
    printed, scene = VALUES["setting_angle_limits"], inward_scene()
    for name, method in _METHODS:
        limits = bd.setting_angle_limits(scene, TOP, method)
        ours, known = np.degrees((limits.first, limits.error)), KNOWN["first_setting_angle_limit"]
        yield from _compare(f"first limit, {name}", ours, (_PAPER, printed["first"], 2), (_OWN, known))
    by_modes = PAPER["reference"]["second_setting_angle_limit_of_modes"]
    for modes, value in zip(by_modes["modes"], by_modes["value"], strict=True):
        limit = np.degrees(bd.setting_angle_limits(scene, np.inf, bd.Ritz(modes, "eigenfunctions")).second)
        paper = [(_PAPER, printed["second"], 2)] if modes == _MODES else []
        what = f"second limit of {modes} modes"
        yield from _compare(what, (limit, limit * _ROUNDING), *paper, (_OWN, value))
    by_top = PAPER["reference"]["second_setting_angle_limit"]
    known = [(entry["top_speed"]["value"], (_OWN, entry["value"])) for entry in by_top]
    for top, row in [(TOP, (_PAPER, printed["second"], 2, "top speed (2)")), *known]:
        limits = bd.setting_angle_limits(scene, top)
        ours = np.degrees((limits.second, limits.error))
        yield from _compare(f"second limit, to {top:g} rad/s", ours, row)


def buckling_speed() -> Iterator[Comparison]:
    """Compare the buckling speed [rad/s] with an independent reference, as the paper prints none."""
    for name, method in _METHODS:
        point = bd.critical_point(inward_scene(), method)
        ours = point.speed, point.error * point.speed
        yield from _compare(f"critical speed, {name}", ours, (_OWN, KNOWN["critical_speed"]))


# Motion in time ---------------------------------------------------------------------------------------


@cache
def run(modes: int = _MODES, discretization: str = "ritz", *, large_deflection: bool = False) -> bd.Transient:
    """Simulate the spin-up of Table 3; with large deflection less accurately, as it takes far longer."""
    scene, tolerance = rolling_scene(large_deflection=large_deflection), 1e-5 if large_deflection else 1e-6
    return bd.simulate(scene, VALUES["scene"]["t_end"], modes, tolerance, discretization=discretization)


def _peak(found: bd.Transient) -> tuple[float, float]:
    """Find the largest tip deflection in the window of Table 3, and its error [mm]."""
    return MM * found.peak(*WINDOW), MM * found.time_error


def _of_table_3(reason: str = "") -> tuple:
    """Return the paper's deflection and that of RecurDyn [mm], as rows for `_compare`."""
    printed = PAPER["largest_deflection"]
    paper, other = (MM * printed[name]["value"] for name in ("proposed", "recurdyn"))
    return (_PAPER, paper, 2, reason), (_RECURDYN, other, 2, "unexplained (6)")


def largest_deflections() -> Iterator[Comparison]:
    """Compare the largest tip deflection [mm] in 20 to 30 s, by 1 to 6 modes and FE, with Table 3."""
    exact = KNOWN["largest_deflection"]
    known = dict(zip(exact["modes"], exact["in_window"], strict=True))
    for modes, name, method in [*((n, "Ritz", "ritz") for n in range(1, 7)), (_MODES, "FE", "fem")]:
        printed = _of_table_3("too few modes (7)" if modes < 3 else "")[: 1 + (modes == _MODES)]
        what = f"{modes} mode{'s' * (modes > 1)}, {name}"
        yield from _compare(what, _peak(run(modes, method)), *printed, (_OWN, MM * known[modes], 6))


def largest_deflections_of_bent_beam() -> Iterator[Comparison]:
    """Compare the largest tip deflection [mm] in 20 to 30 s, with large deflection, with Table 3."""
    exact = KNOWN["largest_deflection_elastica"]
    for modes, known in zip(exact["modes"], exact["in_window"], strict=True):
        printed = _of_table_3(_BENDS) if modes == _MODES else ()
        ours = _peak(run(modes, large_deflection=True))
        yield from _compare(f"{modes} modes, bent beam", ours, *printed, (_OWN, MM * known, 5))


def steady_amplitudes() -> Iterator[Comparison]:
    """Compare the steady amplitude [mm] at the speed of Table 3; the paper prints none."""
    exact, (paper, _) = KNOWN["steady_response"], _of_table_3("ring-down (8)")
    response = bd.steady_response(rolling_scene(), [SPEED], _MODES)
    largest, lines = MM * response.amplitude[0], MM * response.bound[0]
    error, deflection = response.error[0] * lines, MM * exact["largest_deflection"]
    yield from _compare("steady amplitude, undamped", (largest, error), paper, (_OWN, deflection, 6))
    yield from _compare("sum of the lines", (lines, error), (_OWN, MM * exact["line_sum"], 6))
    damped = replace(rolling_scene(), damping_ratio=_DAMPING)
    tail = bd.simulate(damped, VALUES["scene"]["t_end"], _MODES, 1e-6)
    steady = float(MM * bd.steady_response(damped, [SPEED], _MODES).amplitude[0])
    other = "harmonic balance (8)", steady, 4
    yield from _compare("damped transient in 20 to 30 s", _peak(tail), other)


def crossings(discretization: str = "ritz", gravity: float = 0.0) -> bd.Crossings:
    """Find the speeds [rad/s] at which an excitation frequency equals the first natural one (Fig. 7)."""
    scene = replace(rolling_scene(), gravity=gravity)
    return bd.resonance_speeds(scene, TOP, 1, discretization=discretization)


def resonances() -> Iterator[Comparison]:
    """Compare the speeds [rad/s] of `crossings` with those in Fig. 7 of the paper."""
    further, forced = KNOWN["further_resonance_speeds"], KNOWN["resonance_speeds"]
    for name, method in _METHODS:
        yield from _by_kind(crossings(method), "forced", forced, name)
        yield from _by_kind(crossings(method), "parametric", further["parametric"], name)
    weighed = _by_kind(crossings(gravity=9.81), "forced", [*forced, further["gravity"]], "gravity")
    yield [*weighed][-1]


def _by_kind(found: bd.Crossings, kind: str, known: list[float], name: str) -> Iterator[Comparison]:
    """Compare the crossings of one kind of excitation with known ones [rad/s]."""
    for c, value in zip([c for c in found if c.kind == kind], known, strict=True):
        yield from _compare(f"{kind} {c.line.name}, {name}", (c.speed, c.error * c.speed), (_OWN, value))


def run_sweep(
    progress: Callable[[int, int], object] | None = None, speeds: np.ndarray = _FIGURE_6
) -> bd.Sweep:
    """Compute Fig. 6: the largest deflection in 20 to 30 s over speed."""
    workers = min(2, os.cpu_count() or 1)
    return bd.sweep(rolling_scene(), speeds, WINDOW, modes=_MODES, workers=workers, progress=progress)


def sweep_peak_comparisons(result: bd.Sweep) -> Iterator[Comparison]:
    """Compare the peaks of Fig. 6: their number, and their speeds [rad/s] with the crossings of Fig. 7."""
    indices, count = sweep_peaks(result), PAPER["figures"]["fig_6"]["peaks"]
    yield from _compare("number of peaks", (len(indices), 0.0), (_PAPER, count, 0))
    half = np.diff(result.speeds).max() / 2
    for i, (index, value) in enumerate(zip(indices, KNOWN["resonance_speeds"], strict=False), 1):
        yield from _compare(f"speed of peak {i}", (result.speeds[index], half), (_OWN, value, 4))


# Large deflection: a beam that bends by any angle ---------------------------------------------------------


def first_frequencies_of_bent_beam() -> Iterator[Comparison]:
    """Compare the first frequencies [Hz] with large deflection with linear ones, for Fig. 8 and 9."""
    rows: list[tuple[float, float, Any]] = [
        (figure["setting_angle"][1], speed, None)
        for figure in (PAPER["figures"]["fig_8"], PAPER["figures"]["fig_9"])
        for speed in _JUDGED
    ]
    for row in load("elastica")["harvester"]:
        rows.append((row["setting_angle_deg"], row["speed"], (_OWN, float(row["frequency"]))))
    for angle, speed, known in rows:
        linear = known or ("paper's model", _first_frequency(inward_scene(angle), speed)[0], 2, _BENDS)
        ours = _first_frequency(inward_scene(angle, large_deflection=True), speed)
        yield from _compare(f"{angle:g} deg, {speed:g} rad/s", ours, linear)


def limits_of_bent_beam() -> Iterator[Comparison]:
    """Compare with Section 3.3: the setting-angle limits [deg] with large deflection."""
    printed = VALUES["setting_angle_limits"]
    yield from _compare("first limit, at rest", _bent_limit(0.0), (_PAPER, printed["first"], 2))
    second = _PAPER, printed["second"], 2, _BENDS
    yield from _compare(f"second limit, to {TOP:g} rad/s", _bent_limit(TOP), second)


@cache
def _bent_limit(speed: float) -> tuple[float, float]:
    """Find the setting angle [deg], with error, at which the first frequency's slope over speed changes sign.

    The slope is a difference over a small step of speed, extrapolated to step 0.
    """

    def change(angle: float, step: float) -> float:
        # The frequencies are accurate to 1e-13.
        solver = Model(inward_scene(angle, large_deflection=True), bd.Ritz(16)).solver
        around = np.array([speed - step, speed + step]) if speed else np.array([0.0, step])
        before, after = np.abs(solver.eigenvalues(around, 1)[:, 0]) ** 2
        return after - before

    between = (2.0, 6.0) if speed else (80.0, 89.9)  # angles [deg] between which the slope changes its sign
    near, far = (float(brentq(change, *between, (step,), 1e-11)) for step in (0.5, 1.0))  # pyright: ignore
    return near + (near - far) / 3, abs(near - far) / 30


# Sections of the report, and notes ------------------------------------------------------------------------


def sections(fig_6_sweep: bd.Sweep) -> dict[str, list[Comparison]]:
    """Collect all comparisons, by the titles of their tables."""
    found = {
        "Table 2: first natural frequency, beam pointing inward [Hz]": first_frequencies(),
        "Table 3: largest tip deflection in 20 to 30 s [mm]": largest_deflections(),
        "Table 3, continued: steady amplitude at the same speed [mm]": steady_amplitudes(),
        "Fig. 6: peaks over speed [rad/s]": sweep_peak_comparisons(fig_6_sweep),
        "Fig. 7: speeds of resonance [rad/s]": resonances(),
        "Section 3.3: limits of the setting angle [deg]": limits_of_setting_angle(),
        "Section 4: speed of buckling, beam pointing inward [rad/s]": buckling_speed(),
        "Table 3 with large deflection: largest tip deflection in 20 to 30 s [mm]": (
            largest_deflections_of_bent_beam()
        ),
        "Fig. 8 and 9 with large deflection: first natural frequency [Hz]": first_frequencies_of_bent_beam(),
        "Section 3.3 with large deflection: limits of the setting angle [deg]": limits_of_bent_beam(),
    }
    return {title: [*rows] for title, rows in found.items()}


def passage() -> tuple[float, float]:
    """Find the time [s] at which the spin-up passes the first resonance, and the speed [rad/s] then."""
    motion = rolling_scene().motion
    assert motion is not None
    first = next(c.speed for c in crossings() if c.kind == "forced")
    time = brentq(lambda t: float(motion.at(np.array([t])).speed[0]) - first, 0.0, motion.steady_start)
    return float(time), first  # pyright: ignore[reportArgumentType]  (brentq returns a float)


def notes() -> list[str]:
    """Return the notes on the tables, ordered by their numbers (1), (2) and so on."""
    (time, line), (peak, _) = passage(), _peak(run())
    steady = MM * float(bd.steady_response(rolling_scene(), [SPEED], _MODES).amplitude[0])
    angle, bends = VALUES["setting_angle_limits"]["first"][1], {"large_deflection": True}
    rest, turning = (_first_frequency(inward_scene(angle, **bends), speed)[0] for speed in (0.0, _JUDGED[0]))
    numbers = {
        "rest": _first_frequency(inward_scene(), 0.0)[0],
        "bent": bd.setting_angle_limits(inward_scene(), 400.0).static_deflection,
        "exudyn": [MM * value for value in KNOWN["largest_deflection_exudyn"]["in_window"]],
        "peak": peak,
        "speed": SPEED,
        "line": line,
        "time": time,
        "steady": steady,
        "times": peak / steady,
        "damping": _DAMPING,
        "limit": angle,
        "rise": turning - rest,
        "judged": _JUDGED[0],
        "second": _bent_limit(TOP)[0],
        "top": TOP,
    }
    return [note.format(**numbers) for note in PAPER["notes"]]
