"""Figures 4 to 9 of Lee and Yoo (2019), drawn from numbers that this package computes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import beamdyn as bd
from beamdyn.common.plots.plots import mark_points, plot_loci_by_angle, plot_locus
from beamdyn.common.results.pictures import COLOURS
from beamdyn.reproduce import inward_beam

_OUTSIDE = "(left and middle: linear equations, outside their range)"


def pictures(fig_6_sweep: bd.Sweep) -> dict[str, Callable[[], Axes | Figure]]:
    """Return the functions that draw the figures, by the names of the files."""
    return {
        "fig_4": _fig_4,
        "fig_5": _fig_5,
        "fig_6": lambda: _fig_6(fig_6_sweep),
        "fig_7": _fig_7,
        "fig_8": _fig_8,
        "fig_9": _fig_9,
    }


def _axes(title: str) -> Axes:
    """Make the axes of a figure with a single plot."""
    ax = Figure(figsize=(7.5, 4.8), layout="constrained").subplots()
    ax.set_title(title)
    return ax


def _fig_4() -> Axes:
    """Draw the first frequency over speed, with the values of ANSYS."""
    ax, scene = _axes("Fig. 4: first natural frequency, setting angle 0"), inward_beam.inward_scene()
    critical = bd.critical_point(scene).speed
    # Speeds are closely spaced where the frequency falls to 0.
    speeds = critical * np.sin(np.linspace(0, np.pi / 2 - 1e-3, 301))
    ax.set_xlim(-4, 204)
    plot_locus(speeds, bd.frequency_locus(scene, speeds, 1).frequency, ax, ["ours (Ritz)"], critical)
    known, ansys = (
        [row[key]["value"] for row in inward_beam.PAPER["first_frequency"]] for key in ("speed", "ansys")
    )
    mark_points(ax, known, ansys, "ANSYS, in the paper")
    return ax


def _fig_5() -> Axes:
    """Draw the tip deflection over time."""
    title = f"Fig. 5: tip deflection, spin-up to {inward_beam.SPEED:g} rad/s"
    ax, (time, line) = inward_beam.run().plot(_axes(title)), inward_beam.passage()
    ax.axvline(time, color="0.3", linestyle="--", linewidth=1, label=f"passage through {line:.2f} rad/s")
    ax.axvspan(*inward_beam.WINDOW, color="0.93", zorder=0, label="window of Table 3")
    ax.set_ylim(top=3.2)
    ax.legend(fontsize=10, loc="upper left")
    return ax


def _fig_6(result: bd.Sweep) -> Axes:
    """Draw the largest deflection over speed, with the steady amplitude."""
    ax = result.plot(_axes("Fig. 6: largest tip deflection over speed"))
    ax.lines[0].set_label("undamped transient, 20 to 30 s")
    speeds = np.linspace(1, inward_beam.TOP, 1000)
    steady = inward_beam.MM * bd.steady_response(inward_beam.rolling_scene(), speeds, 3).amplitude
    ax.plot(speeds, steady, color=COLOURS[1], linewidth=1.2, label="steady amplitude")
    ax.set_ylim(0, 1.1 * inward_beam.MM * float(result.peaks.max()))
    ax.legend(fontsize=10, loc="upper right")
    return ax


def _fig_7() -> Axes:
    """Draw the first natural frequency and the two excited frequencies over speed."""
    found = inward_beam.crossings()
    ax = found.plot(_axes("Fig. 7: first natural frequency and excited frequencies"))
    for c in found:
        if c.kind == "forced":
            label, at = f"{c.speed:.2f} rad/s", (c.speed, c.frequency)
            ax.annotate(label, at, (13, 3), textcoords="offset points", fontsize=9)
    return ax


def _fig_8() -> Figure:
    """Draw the first frequency over speed on either side of the first setting-angle limit."""
    angles, near = inward_beam.PAPER["figures"]["fig_8"]["setting_angle"], np.linspace(0, 17, 171)
    figure, left, right = _three_panels(angles, inward_beam.TOP, "Fig. 8", "the first setting-angle limit")
    _draw(left, angles, np.linspace(0, inward_beam.TOP, 301), "over speed")
    first = _first_frequencies(angles, near)
    plot_loci_by_angle(near, (first - first[:, :1]) * 1e6, angles, right)
    right.set(ylim=(-0.5, 0.5), ylabel="change from rest [µHz]")
    right.set_title("near rest: one falls, the other first rises")
    return figure


def _fig_9() -> Figure:
    """Draw the first frequency over speed on either side of the second setting-angle limit."""
    angles = inward_beam.PAPER["figures"]["fig_9"]["setting_angle"]
    figure, left, right = _three_panels(angles, 400.0, "Fig. 9", "the paper's second limit")
    five = "five clamped-free modes: one curve turns down, one rises"
    _draw(left, angles, np.linspace(0, 12000.0, 501), five, bd.Ritz(5, "eigenfunctions"))
    _draw(right, angles, np.linspace(0, 5000.0, 501), "converged: both turn down")
    return figure


def _three_panels(angles: Sequence[float], top: float, name: str, limit: str) -> tuple[Figure, Axes, Axes]:
    """Make Fig. 8 or 9 with the third panel (large deflection) drawn; return also the other two axes."""
    figure = Figure(figsize=(16, 4.8), layout="constrained")
    left, right, bent = figure.subplots(1, 3)
    figure.suptitle(f"{name}: first natural frequency on either side of {limit} {_OUTSIDE}")
    _draw(bent, angles, np.linspace(0, top, 41), "what a beam that bends does: both rise", bends=True)
    return figure, left, right


def _draw(
    ax: Axes, angles: Sequence[float], speeds: np.ndarray, title: str, *method: Any, bends: bool = False
) -> None:
    """Draw the first frequency over speeds [rad/s] at setting angles [deg], one line each."""
    plot_loci_by_angle(speeds, _first_frequencies(angles, speeds, *method, bends=bends), angles, ax)
    ax.set_title(title)


def _first_frequencies(
    angles: Sequence[float],
    speeds: np.ndarray,
    discretization: str | bd.Ritz = "ritz",
    *,
    bends: bool = False,
) -> np.ndarray:
    """Compute the first frequency [Hz] at setting angles [deg] over speeds [rad/s]: (angles, speeds)."""
    scenes = [inward_beam.inward_scene(angle, large_deflection=bends) for angle in angles]
    tolerance = 1e-4 if bends else None
    loci = [bd.frequency_locus(scene, speeds, 1, discretization, tolerance) for scene in scenes]
    return np.array([locus.frequency[:, 0] for locus in loci])
