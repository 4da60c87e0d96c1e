"""Pictures of stability: multipliers in the complex plane, and charts over two numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from beamdyn.common.inputs.designs import VariedInput
from beamdyn.common.plots.axes_and_lines import set_up_axes
from beamdyn.common.results.pictures import COLOURS, add_legend

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SIGNS = {1.0: "Krein sign +", -1.0: "Krein sign -", 0.0: "multipliers"}
_FEW = 0.6  # size of a mark of an undecided point [points]


def plot_multipliers(
    multipliers: np.ndarray, error: np.ndarray, sign: np.ndarray, ax: Axes | None = None
) -> Axes:
    """Draw multipliers (m,) in the complex plane, by their sign, with the unit circle."""
    ax = set_up_axes(ax, "real part of the multiplier", "imaginary part")
    angle = np.linspace(0, 2 * np.pi, 361)
    ax.plot(np.cos(angle), np.sin(angle), color="0.5", linewidth=1.0, label="unit circle")
    for colour, (value, name) in zip(COLOURS, _SIGNS.items(), strict=False):
        some = sign == value
        if some.any():
            at = multipliers[some]
            ax.errorbar(
                np.real(at),
                np.imag(at),
                error[some],
                error[some],
                fmt="o",
                color=colour,
                label=name,
                capsize=2,
            )
    ax.set_aspect("equal")
    return add_legend(ax)


def plot_stability_chart(
    inputs: Sequence[VariedInput], rate: np.ndarray, undecided: np.ndarray, ax: Axes | None = None
) -> Axes:
    """Draw growth rates (A, B) over two inputs; nan, where motion is stable, stays white.

    Parameters
    ----------
    inputs : sequence of VariedInput
        The inputs, with A and B values.
    rate : ndarray, shape (A, B)
        Growth rates [1/s].
    undecided : ndarray of bool, shape (A, B)
        Points to mark.
    ax : Axes, optional
        Where to draw; new axes if not given.
    """
    ax = set_up_axes(ax, *(each.label for each in inputs))
    first, second = (each.values for each in inputs)
    if np.isfinite(rate).any():
        shown = ax.pcolormesh(first, second, rate.T, cmap="viridis_r", shading="nearest", rasterized=True)
        ax.figure.colorbar(shown, ax=ax, label="growth rate [1/s]")
    if undecided.any():
        a, b = np.nonzero(undecided)
        ax.plot(
            first[a], second[b], "o", markersize=_FEW, color=COLOURS[1], label=f"undecided, {len(a)} points"
        )
        add_legend(ax)
    return ax
