"""Plots of energy harvesting: power, voltage and strain over speed, and power over load resistance."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from beamdyn.common.plots.axes_and_lines import draw_lines, new_axes, panels, set_up_axes, speed_label
from beamdyn.common.results.columns import DisplayUnits
from beamdyn.common.results.pictures import COLOURS, Axes, add_legend

_KM_PER_HOUR = 3.6  # factor from m/s to km/h
_HEIGHT, _WIDTH, _ABOVE = 2.8, 4.2, 1.2  # size of a panel, and height of the legend at the top [inch]
_NARROWEST = 3.0  # least width of a panel if several are side by side [inch]


@dataclass(frozen=True)
class HarvestPanel:
    """Curves of one quantity over rotational speed.

    Parameters
    ----------
    label : str
        Name of the quantity, with its unit.
    curves : mapping of str to ndarray, shape (S,)
        Values of each curve, by name of the curve; nan leaves a gap.
    limit : float
        Limit that the values should not exceed; inf if there is none.
    """

    label: str
    curves: Mapping[str, np.ndarray]
    limit: float = np.inf


def panel_size(count: int, width: float | None = None) -> tuple[float, float]:
    """Return width and height of a picture with a given number of panels [inch]."""
    whole = width or _WIDTH * count
    return whole, _ABOVE + _HEIGHT * -(-count // _columns(whole))


def _columns(width: float) -> int:
    """Return how many panels fit side by side into a picture of a given width [inch]."""
    return max(int(width / _NARROWEST), 1)


def plot_harvest_panels(
    speeds: np.ndarray, shown: Sequence[HarvestPanel], resonances: np.ndarray, radius: float,
    units: DisplayUnits, ax: Axes | None = None,
) -> Axes:  # fmt: skip
    """Draw panels over speed, as many in a row as fit; curves with the same name have the same colour.

    The other arguments are as for `plot_harvest`.
    """
    ax = ax or new_axes(*panel_size(len(shown)))
    columns, named = _columns(ax.bbox.width / ax.figure.dpi), {}
    ax, places = panels(len(shown), ax, columns)
    for k, (place, panel) in enumerate(zip(places, shown, strict=True)):
        plot_harvest(speeds, panel, resonances, radius if k < columns else 0.0, units, place)
        named |= {label: each for each, label in zip(*place.get_legend_handles_labels(), strict=True)}
        if (legend := place.get_legend()) is not None:
            legend.remove()
        if k + columns < len(shown):
            place.set_xlabel("")
    ax.figure.legend(named.values(), named.keys(), loc="outside upper left", fontsize=10, ncols=columns)
    return ax


def plot_harvest(
    speeds: np.ndarray,
    panel: HarvestPanel,
    resonances: np.ndarray,
    radius: float,
    units: DisplayUnits,
    ax: Axes | None = None,
) -> Axes:
    """Draw curves over speed with a logarithmic scale, their limit, and the speeds of resonance.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Angular speeds [rad/s].
    panel : HarvestPanel
        The curves.
    resonances : ndarray, shape (r,)
        Rotational speeds of resonance [rad/s].
    radius : float
        Radius of a rolling wheel [m]: a second axis at the top then shows the velocity; 0 if there is no
        wheel.
    units : DisplayUnits
        Units of the axes; the arrays are SI.
    ax : Axes, optional
        Axes to draw on; new axes if not given.

    Returns
    -------
    Axes
    """
    speed = units.speed_unit()
    ax = set_up_axes(ax, speed_label(units), panel.label)
    drawn = [np.where(np.asarray(each) > 0, each, np.nan) for each in panel.curves.values()]
    draw_lines(ax, speed.of(np.asarray(speeds)), drawn, [*panel.curves])
    for k, at in enumerate(speed.of(np.asarray(resonances))):
        label = "" if k else "resonance of the circuit without its load"
        ax.axvline(at, color="0.6", linestyle=":", linewidth=1.0, label=label)
    if np.isfinite(panel.limit):
        ax.axhline(panel.limit, color=COLOURS[1], linestyle="--", linewidth=1.2, label="limit of the layers")
    if any((each > 0).any() for each in drawn):
        ax.set_yscale("log")
    if radius:
        each = _KM_PER_HOUR * radius / speed.per_si  # velocity in km/h for one unit of the speed axis
        both_ways = lambda v: np.asarray(v) * each, lambda v: np.asarray(v) / each
        above = ax.secondary_xaxis("top", functions=both_ways)
        above.set_xlabel("velocity of the vehicle [km/h]", fontsize=12)
    return add_legend(ax)


def plot_resistances(
    resistances: np.ndarray, power: np.ndarray, best: float, label: str, ax: Axes | None = None
) -> Axes:
    """Draw power [W] over load resistance [ohm] on logarithmic axes; mark `best`, and name it `label`."""
    ax = set_up_axes(ax, "load resistance [ohm]", "mean power [W]")
    ax.plot(resistances, power, color=COLOURS[0], linewidth=1.8, marker=".", label="tried")
    ax.plot(best, power.max(), "o", color=COLOURS[1], label=label)
    ax.set_xscale("log")
    ax.set_yscale("log")
    return add_legend(ax)
