"""Arrows of forces to one scale, for free-body diagrams."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes

_HALO = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.8}


@dataclass(frozen=True)
class ForceArrows:
    """Arrows of forces on one drawing, to one scale.

    Parameters
    ----------
    ax : Axes
        Where to draw, in metres.
    scale : float
        Length of an arrow per force [m/N].
    """

    ax: Axes
    scale: float

    def draw(
        self, at: Any, vector: np.ndarray, label: str, colour: str, *, ends_here: bool = False, ha: str = ""
    ) -> None:
        """Draw a force with its name at the free end of the arrow.

        Parameters
        ----------
        at : array of two floats
            Where the force acts [m].
        vector : ndarray, shape (2,)
            The force [N].
        label : str
            Name.
        colour : str
            Colour.
        ends_here : bool
            Whether the arrow ends at `at`, as for a force that pushes, rather than starts there.
        ha : str
            Horizontal alignment of the name, if not by the arrow's direction.
        """
        start = np.asarray(at, dtype=float)
        end = start + self.scale * np.asarray(vector)
        if ends_here:
            start, end = 2 * start - end, start
        style = {"arrowstyle": "-|>", "color": colour, "linewidth": 2.0, "shrinkA": 0, "shrinkB": 0}
        self.ax.annotate("", xy=tuple(end), xytext=tuple(start), arrowprops=style, zorder=6)
        free, along = (start, start - end) if ends_here else (end, end - start)
        unit = along / (np.hypot(*along) or 1.0)
        self.ax.annotate(
            label,
            tuple(free),
            tuple(9 * unit),
            textcoords="offset points",
            color=colour,
            fontsize=9.5,
            ha=ha or ("center" if abs(unit[0]) < 0.5 else ("left" if unit[0] > 0 else "right")),
            va="center" if abs(unit[1]) < 0.5 else ("bottom" if unit[1] > 0 else "top"),
            bbox=_HALO,
            zorder=7,
        )
        self.ax.update_datalim([start, end, free + 0.15 * along])

    def add_scale_bar(self, largest: float, place: tuple[float, float] = (0.03, 0.03)) -> None:
        """Draw the length of a round force below the largest [N], at a place in fractions of the axes."""
        size = 10.0 ** np.floor(np.log10(largest / 2))
        size *= max(f for f in (1, 2, 5) if f * size <= largest / 1.5)
        name = f"{size / 1e3:g} kN" if size >= 1e3 else f"{size:g} N"
        x, y = self.ax.transData.inverted().transform(self.ax.transAxes.transform(place))
        self.ax.plot([x, x + self.scale * size], [y, y], color="0.2", linewidth=2.5, zorder=7)
        self.ax.annotate(name, (x, y), (0, 5), textcoords="offset points", fontsize=9, color="0.2")


def force_label(symbol: str, vector: np.ndarray) -> str:
    """Label of a force: its symbol and size, such as "$N_1$ 3.44 kN"."""
    size = float(np.hypot(*vector))
    return f"${symbol}$ {size / 1e3:.3g} kN" if size >= 1e3 else f"${symbol}$ {size:.3g} N"


def finish_drawing(ax: Axes, title: str) -> None:
    """Give axes equal scales, no ticks, and a title."""
    ax.set_aspect("equal")
    ax.autoscale_view()
    ax.margins(0.06)
    ax.set_axis_off()
    ax.set_title(title, fontsize=11)
