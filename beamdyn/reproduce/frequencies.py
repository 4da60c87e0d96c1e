"""Natural frequencies and setting angles of Lee and Yoo: Table 2, sections 3.3 and 4, Fig. 4, 8 and 9."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from beamdyn.common.plots.plots import mark_points, plot_loci_by_angle, plot_locus
from beamdyn.common.results.comparison import Comparison
from beamdyn.equations.ritz import Ritz
from beamdyn.modes.critical import critical_point
from beamdyn.modes.locus import frequency_locus
from beamdyn.modes.modes import natural_modes
from beamdyn.modes.setting_angles import setting_angle_limits
from beamdyn.published import load
from beamdyn.reproduce.common import OWN, PAPER, TOP, decimals, published_scene
from beamdyn.reproduce.large_deflection import draw_first_frequencies
from beamdyn.scene.physics import Physics
from beamdyn.scene.scene import Scene

_ANSYS = "ANSYS (4)"
_ROUNDING = 1e-12  # relative error of a value that a basis of given size defines exactly
_OUTSIDE = "(left and middle: linear equations, outside their range)"
_BENT = "what a beam that bends does: both rise"
_TOP_BENT = 400.0  # highest speed of that beside Fig. 9 [rad/s]


def first_frequencies() -> Iterator[Comparison]:
    """Compare with Table 2: the first frequency at three speeds, by three models of ours."""
    paper, scene = load("lee_yoo_2019"), published_scene()
    models = (
        ("Ritz", scene, "ritz"),
        ("FE", scene, "fem"),
        ("with stretch", replace(scene, physics=Physics(stretch=True)), "ritz"),
    )
    for row, exact in zip(paper["first_frequency"], paper["reference"]["first_frequency"], strict=True):
        speed = row["speed"]["value"]
        for name, model, discretization in models:
            result = natural_modes(model, speed, 1, discretization)
            ours = float(result.frequency[0])
            error = float(result.error[0]) * ours
            what = f"{speed:g} rad/s, {name}"
            for source, entry in ((PAPER, row["proposed"]), (_ANSYS, row["ansys"])):
                reason = "unexplained (1)" if source == PAPER and speed == 0 else ""
                yield Comparison(what, source, entry["value"], ours, error, entry["decimals"], reason)
            value = exact["stretch" if model.physics.stretch else "bending"]["value"]
            yield Comparison(what, OWN, value, ours, error, 8)


def limits_of_setting_angle() -> Iterator[Comparison]:
    """Compare with Section 3.3: the two setting-angle limits [deg]."""
    paper, scene = load("lee_yoo_2019"), published_scene()
    yield from _first_limit(paper, scene)
    yield from _second_limit_of_modes(paper, scene)
    yield from _second_limit(paper, scene)


def buckling_speed() -> Iterator[Comparison]:
    """Compare the speed at which the inward beam buckles with our own reference: the paper prints none."""
    entry = load("lee_yoo_2019")["reference"]["critical_speed"]
    for name, discretization in (("Ritz", "ritz"), ("FE", "fem")):
        point = critical_point(published_scene(), discretization)
        yield Comparison(
            f"critical speed, {name}", OWN, entry["value"], point.speed, point.error * point.speed, 4
        )


def _first_limit(paper: dict[str, Any], scene: Scene) -> Iterator[Comparison]:
    """Compare the first setting-angle limit."""
    printed, exact = paper["setting_angle_limits"]["first"], paper["reference"]["first_setting_angle_limit"]
    for name, discretization in (("Ritz", "ritz"), ("FE", "fem")):
        limits = setting_angle_limits(scene, TOP, discretization)
        what, ours, error = (
            f"first limit, {name}",
            float(np.degrees(limits.first)),
            float(np.degrees(limits.error)),
        )
        yield Comparison(what, PAPER, tuple(printed["value"]), ours, error, 2)
        yield Comparison(what, OWN, exact["value"], ours, error, 5)


def _second_limit_of_modes(paper: dict[str, Any], scene: Scene) -> Iterator[Comparison]:
    """Compare the second limit of bases of N eigenfunctions, without a top speed."""
    printed, exact = (
        paper["setting_angle_limits"]["second"],
        paper["reference"]["second_setting_angle_limit_of_modes"],
    )
    for modes, value in zip(exact["modes"], exact["value"], strict=True):
        limits = setting_angle_limits(scene, np.inf, Ritz(modes, "eigenfunctions"))
        what, ours = f"second limit of {modes} modes", float(np.degrees(limits.second))
        if modes == 5:
            yield Comparison(what, PAPER, tuple(printed["value"]), ours, ours * _ROUNDING, 2)
        yield Comparison(what, OWN, value, ours, ours * _ROUNDING, decimals(value))


def _second_limit(paper: dict[str, Any], scene: Scene) -> Iterator[Comparison]:
    """Compare the converged second limit for several top speeds."""
    printed = tuple(paper["setting_angle_limits"]["second"]["value"])
    exact = [(e["top_speed"]["value"], e["value"]) for e in paper["reference"]["second_setting_angle_limit"]]
    for top, value in [(TOP, None), *exact]:
        limits = setting_angle_limits(scene, top)
        what, ours = f"second limit, to {top:g} rad/s", float(np.degrees(limits.second))
        error = float(np.degrees(limits.error))
        if value is None:
            yield Comparison(what, PAPER, printed, ours, error, 2, "top speed (2)")
        else:
            yield Comparison(what, OWN, value, ours, error, decimals(value))


def notes() -> Iterator[str]:
    """Notes on the tables."""
    scene = published_scene()
    rest = natural_modes(scene, 0.0, 1)
    limits = setting_angle_limits(scene, 400.0)
    yield (
        "(1) The paper prints 65.231 Hz at rest; its own input gives "
        f"{rest.frequency[0]:.6f} Hz, as ANSYS does. The cause of the difference is unknown."
    )
    yield (
        "(2) Above the second limit the first frequency rises up to the top speed, so the limit depends on "
        "the top speed. The paper does not state it; 150 rad/s is the end of its Fig. 6. Its 89.62 to "
        "89.63 deg is what exactly five clamped-free modes give; with more modes the limit tends to 90 deg."
    )
    yield (
        "(3) The limits are results of the linear equations outside their range: at the second limit for "
        f"400 rad/s the rotation would bend the tip by {limits.static_deflection:.2g} lengths of the beam."
    )
    yield (
        "(4) As printed in the paper. (5) Computed apart from this program, not in the paper: frequencies by "
        "40-digit Rayleigh-Ritz and power series. A deviation '0 ± e' is within our estimated error e."
    )


def fig_4() -> Figure:
    """Draw the first frequency over speed, with the values of ANSYS."""
    rows = load("lee_yoo_2019")["first_frequency"]
    scene, figure = published_scene(), Figure(figsize=(7.5, 4.8), layout="constrained")
    critical = critical_point(scene).speed
    speeds = critical * np.sin(np.linspace(0, np.pi / 2 - 1e-3, 301))  # dense where the frequency falls to 0
    ax = figure.subplots()
    ax.set_xlim(-4, 204)
    plot_locus(speeds, frequency_locus(scene, speeds, 1).frequency, ax, ["ours (Ritz)"], critical)
    mark_points(
        ax, [r["speed"]["value"] for r in rows], [r["ansys"]["value"] for r in rows], "ANSYS, in the paper"
    )
    ax.set_title("Fig. 4: first natural frequency, setting angle 0")
    return figure


def fig_8() -> Figure:
    """Draw the first frequency over speed on either side of the first setting-angle limit."""
    angles = load("lee_yoo_2019")["figures"]["fig_8"]["setting_angle"]
    figure = Figure(figsize=(16, 4.8), layout="constrained")
    left, right, bent = figure.subplots(1, 3)
    speeds = np.linspace(0, TOP, 301)
    plot_loci_by_angle(speeds, _first_frequencies_by_angle(angles, speeds), angles, left)
    speeds = np.linspace(0, 17, 171)
    first = _first_frequencies_by_angle(angles, speeds)
    plot_loci_by_angle(speeds, (first - first[:, :1]) * 1e6, angles, right)
    right.set(ylim=(-0.5, 0.5), ylabel="change from rest [µHz]")
    left.set_title("over speed")
    right.set_title("near rest: one falls, the other first rises")
    draw_first_frequencies(angles, TOP, bent)
    bent.set_title(_BENT)
    figure.suptitle(
        f"Fig. 8: first natural frequency on either side of the first setting-angle limit {_OUTSIDE}"
    )
    return figure


def fig_9() -> Figure:
    """Draw the first frequency over speed on either side of the second setting-angle limit."""
    angles = load("lee_yoo_2019")["figures"]["fig_9"]["setting_angle"]
    figure = Figure(figsize=(16, 4.8), layout="constrained")
    *linear, bent = figure.subplots(1, 3)
    cases = (
        (12000.0, Ritz(5, "eigenfunctions"), "five clamped-free modes: one turns, the other rises on"),
        (5000.0, "ritz", "converged: both turn"),
    )
    for ax, (top, discretization, title) in zip(linear, cases, strict=True):
        speeds = np.linspace(0, top, 501)
        plot_loci_by_angle(speeds, _first_frequencies_by_angle(angles, speeds, discretization), angles, ax)
        ax.set_title(title)
    draw_first_frequencies(angles, _TOP_BENT, bent)
    bent.set_title(_BENT)
    figure.suptitle(f"Fig. 9: first natural frequency on either side of the paper's second limit {_OUTSIDE}")
    return figure


def _first_frequencies_by_angle(
    angles: Sequence[float], speeds: np.ndarray, discretization: str | Ritz = "ritz"
) -> np.ndarray:
    """First frequency [Hz] at setting angles [deg] over speeds [rad/s]: shape (angles, speeds)."""
    scene = published_scene()
    mounts = [replace(scene.mount, setting_angle=float(np.radians(angle))) for angle in angles]
    loci = [frequency_locus(replace(scene, mount=mount), speeds, 1, discretization) for mount in mounts]
    return np.array([locus.frequency[:, 0] for locus in loci])
