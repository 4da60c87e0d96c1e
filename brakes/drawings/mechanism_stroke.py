"""Curves over the stroke of a caliper."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from beamdyn.common.pictures import COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_STYLES = ("-", "--", "-.", ":")


def plot_curves(x: np.ndarray, curves: Mapping[str, np.ndarray], ax: Axes, xlabel: str, ylabel: str) -> Axes:
    """Plot named curves over x; curves of one colour differ by their dashes."""
    for k, (name, y) in enumerate(curves.items()):
        colour, style = COLOURS[k % len(COLOURS)], _STYLES[(k // len(COLOURS) + k) % len(_STYLES)]
        ax.plot(x, y, style, color=colour, linewidth=1.9, label=name)
    ax.set(xlabel=xlabel, ylabel=ylabel)
    ax.grid(color="0.88", linewidth=0.7)
    ax.legend(fontsize="small")
    return ax


def plot_advantage(cable: np.ndarray, advantage: np.ndarray, ax: Axes) -> Axes:
    """Plot the force of each pad (S, 2) over that of the finger, over the travel of the cable (S,) [m]."""
    return plot_curves(1e3 * cable, _sides(advantage), ax, "cable travel [mm]", "pad force / finger force")


def plot_pad_ratio(cable: np.ndarray, ratio: np.ndarray, ax: Axes) -> Axes:
    """Plot the velocity of each pad (S, 2) over that of the cable, over its travel (S,) [m]."""
    return plot_curves(1e3 * cable, _sides(ratio), ax, "cable travel [mm]", "pad travel / cable travel")


def plot_reactions(cable: np.ndarray, magnitudes: Mapping[str, np.ndarray], ax: Axes) -> Axes:
    """Plot the joints' forces (S,) [N] over the travel of the cable (S,) [m]; equal ones as one curve."""
    return plot_curves(1e3 * cable, _merged(magnitudes), ax, "cable travel [mm]", "force of the joint [N]")


def _merged(curves: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Drop curves that are zero, and merge equal ones under their joined names."""
    noise = 1e-9 * max((float(np.nanmax(np.abs(y), initial=0.0)) for y in curves.values()), default=0.0)
    groups: list[tuple[list[str], np.ndarray]] = []
    for name, y in curves.items():
        equal = next((names for names, other in groups if np.allclose(y, other, rtol=0, atol=noise)), None)
        if equal is not None:
            equal.append(name)
        elif np.nanmax(np.abs(y), initial=0.0) > noise:
            groups.append(([name], y))
    return {", ".join(names): y for names, y in groups}


def _sides(pair: np.ndarray) -> dict[str, np.ndarray]:
    return {"right pad": pair[:, 0], "left pad": pair[:, 1]}
