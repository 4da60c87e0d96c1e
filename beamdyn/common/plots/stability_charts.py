"""Plots of stability: Floquet multipliers in the complex plane, and stability charts over two inputs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from beamdyn.common.inputs.described import VariedInput
from beamdyn.common.plots.axes_and_lines import set_up_axes
from beamdyn.common.results.pictures import COLOURS, Axes, add_legend

_SIGNS = {1.0: "Krein sign +", -1.0: "Krein sign -", 0.0: "multipliers"}
_FEW = 0.6  # size of the marker of a point whose stability is undecided [pt]


def plot_multipliers(
    multipliers: np.ndarray, error: np.ndarray, sign: np.ndarray, ax: Axes | None = None
) -> Axes:
    """Draw Floquet multipliers in the complex plane, coloured by Krein sign, with the unit circle."""
    ax = set_up_axes(ax, "real part of the multiplier", "imaginary part")
    angle = np.linspace(0, 2 * np.pi, 361)
    ax.plot(np.cos(angle), np.sin(angle), color="0.5", linewidth=1.0, label="unit circle")
    for colour, (value, name) in zip(COLOURS, _SIGNS.items(), strict=False):
        some = sign == value
        if some.any():
            at = multipliers[some]
            bars = {"xerr": error[some], "yerr": error[some], "capsize": 2}
            ax.errorbar(np.real(at), np.imag(at), fmt="o", color=colour, label=name, **bars)
    ax.set_aspect("equal")
    return add_legend(ax)


def plot_exponent(rate: float, error: float, ax: Axes | None = None) -> Axes:
    """Draw the largest growth rate [1/s] with its error bar; a positive growth rate means instability."""
    ax = set_up_axes(ax, "growth rate [1/s]", "")
    ax.axvline(0.0, color="0.5", linewidth=1.0, label="limit of growth")
    ax.errorbar([rate], [0.0], xerr=[error], fmt="o", color=COLOURS[0], capsize=4, label="largest exponent")
    ax.set_yticks([])
    return add_legend(ax)


def plot_stability_chart(
    inputs: Sequence[VariedInput], rate: np.ndarray, undecided: np.ndarray, ax: Axes | None = None
) -> Axes:
    """Draw growth rates (A, B) over two inputs, with a line halfway between stable and unstable points.

    Parameters
    ----------
    inputs : sequence of VariedInput
        The two inputs, with A and B values.
    rate : ndarray, shape (A, B)
        Growth rates [1/s]; nan where the motion does not grow, which is drawn white.
    undecided : ndarray of bool, shape (A, B)
        Whether the stability of each point is undecided; these points are marked.
    ax : Axes, optional
        Axes to draw on; new axes if not given.
    """
    ax = set_up_axes(ax, *(replace(each, name=each.in_words).label for each in inputs))
    first, second = (each.values for each in inputs)
    grows = np.isfinite(rate)
    if grows.any():
        shown = ax.pcolormesh(first, second, rate.T, cmap="viridis_r", shading="nearest", rasterized=True)
        ax.figure.colorbar(shown, ax=ax, label="growth rate [1/s]")
    x, y = _limit(first, second, grows)
    ax.plot(x, y, color=COLOURS[-1], linewidth=0.8, label="limit of stability")
    if undecided.any():
        a, b = np.nonzero(undecided)
        name = f"undecided, {len(a)} points"
        ax.plot(first[a], second[b], "o", markersize=_FEW, color=COLOURS[1], label=name)
    return add_legend(ax)


def _limit(first: np.ndarray, second: np.ndarray, grows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return x and y of the line halfway between grid points where the motion grows and others.

    `first` (A,) and `second` (B,) are the coordinates of the grid points; `grows` has the shape (A, B).
    Pieces of the line are separated by nan.
    """
    from contourpy import contour_generator

    if min(grows.shape) < 2:
        return np.empty(0), np.empty(0)
    pieces = [np.asarray(each) for each in contour_generator(first, second, grows.T.astype(float)).lines(0.5)]
    points = [np.empty((0, 2)), *(each for piece in pieces for each in (piece, [[np.nan, np.nan]]))]
    x, y = np.concatenate(points).T
    return x, y
