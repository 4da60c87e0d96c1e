"""Plots of arrays on matplotlib axes; nothing is shown, and pyplot is imported only to make new axes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from beamdyn.common.plots import axes_and_lines
from beamdyn.common.results.columns import SI_UNITS, DisplayUnits
from beamdyn.common.results.pictures import COLOURS, Axes, add_legend
from beamdyn.common.results.pictures import save_figure as save_figure  # for other modules to import

_MOST_THICK = 2000  # number of samples above which a curve over time is drawn thin


# Plots over rotational speed ---------------------------------------------------------------------------


def plot_locus(
    speeds: np.ndarray,
    frequency: np.ndarray,
    ax: Axes | None = None,
    labels: Sequence[str] | None = None,
    critical_speed: float | None = None,
    units: DisplayUnits = SI_UNITS,
    quantity: str = "natural frequency [Hz]",
) -> Axes:
    """Draw natural frequencies over speed, one line per mode.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Angular speeds [rad/s].
    frequency : ndarray, shape (S, m)
        Frequencies [Hz]; nan where a mode does not oscillate, which leaves a gap.
    ax : Axes, optional
        Axes to draw on; new axes if not given.
    labels : sequence of str, length m, optional
        Names of the modes in the legend; "mode 1" and so on if not given.
    critical_speed : float, optional
        Speed [rad/s] to mark, as `mark_critical` does.
    units : DisplayUnits, optional
        Units of the axes; the arrays are SI.
    quantity : str, optional
        Label of the vertical axis: the quantity drawn, with its unit.

    Returns
    -------
    Axes
    """
    frequency, speeds = np.asarray(frequency), units.speed_unit().of(np.asarray(speeds))
    ax = axes_and_lines.set_up_axes(ax, axes_and_lines.speed_label(units), quantity)
    axes_and_lines.draw_lines(ax, speeds, frequency.T, labels or _number_modes(frequency.shape[1]))
    # Limits are set even if all values are nan.
    ax.update_datalim([(speeds[0], 0), (speeds[-1], 0)], updatey=False)
    return add_legend(ax) if critical_speed is None else mark_critical(ax, critical_speed, units=units)


def plot_growth(
    speeds: np.ndarray,
    growth_rate: np.ndarray,
    ax: Axes | None = None,
    labels: Sequence[str] | None = None,
    critical_speed: float | None = None,
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw growth rates of modes over speed, one line per mode, in the colours of `plot_locus`.

    Frequencies do not show whether a mode grows: above the critical speed, draw this plot below the
    frequencies.

    Parameters
    ----------
    speeds, ax, labels, critical_speed, units
        As for `plot_locus`.
    growth_rate : ndarray, shape (S, m)
        Growth rates [1/s]: positive where a mode is unstable, negative where it is damped.

    Returns
    -------
    Axes
    """
    return plot_locus(speeds, growth_rate, ax, labels, critical_speed, units, "growth rate [1/s]")


def plot_loci_by_angle(
    speeds: np.ndarray,
    frequency: np.ndarray,
    angles_deg: Sequence[float] | np.ndarray,
    ax: Axes | None = None,
) -> Axes:
    """Draw the frequency of one mode over speed, one line per setting angle of the beam.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Angular speeds [rad/s].
    frequency : ndarray, shape (k, S)
        Frequency [Hz] at each setting angle; nan leaves a gap.
    angles_deg : sequence of float, length k
        Setting angles [degrees].
    ax : Axes, optional
        Axes to draw on; new axes if not given.

    Returns
    -------
    Axes
    """
    labels = [f"setting angle {angle:.10g}°" for angle in angles_deg]
    return plot_locus(speeds, np.asarray(frequency).T, ax, labels)


def mark_critical(
    ax: Axes, speed: float, label: str = "critical speed", units: DisplayUnits = SI_UNITS
) -> Axes:
    """Mark a critical speed by a vertical line, and shade the speeds above it.

    Parameters
    ----------
    ax : Axes
        Axes with angular speed on x; their limits are not changed.
    speed : float
        Critical speed [rad/s]; one outside the limits, such as inf, is not drawn.
    label : str
        Name of the critical speed.
    units : DisplayUnits, optional
        Units of the axes; `speed` is SI.

    Returns
    -------
    Axes
    """
    left, right = ax.get_xlim()
    unit = units.speed_unit()
    at = unit.of(speed)
    if left <= at < right:
        ax.axvline(at, color="0.3", linestyle="--", linewidth=1, label=f"{label} {unit.say(speed, 5)}")
        ax.axvspan(at, right, color="0.93", zorder=0)
        ax.set_xlim(left, right)
    return add_legend(ax)


def mark_points(
    ax: Axes, x: np.ndarray | Sequence[float], y: np.ndarray | Sequence[float], label: str
) -> Axes:
    """Draw points, such as published ones, on axes that already show curves.

    Parameters
    ----------
    ax : Axes
        Axes to draw on.
    x, y : array_like, shape (n,)
        The points, in the units of the axes.
    label : str
        Entry in the legend, for example the source of the points.

    Returns
    -------
    Axes
    """
    ax.plot(x, y, "o", color="black", markerfacecolor="white", markersize=7, zorder=3, label=label)
    return add_legend(ax)


def plot_locus_by_plane(
    speeds: np.ndarray,
    frequency: np.ndarray,
    kinds: np.ndarray,
    words: Sequence[str],
    ax: Axes | None = None,
    labels: Sequence[str] | None = None,
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw natural frequencies over speed, with dashes that show the main motion of each mode.

    Parameters
    ----------
    speeds, frequency, ax, labels, units
        As for `beamdyn.common.plots.plots.plot_locus`.
    kinds : ndarray of int, shape (speeds, modes)
        Index of the main motion of each mode, in `words` and in `axes_and_lines.MOTION_DASHES`.
    words : sequence of str
        The motions in words, for the legend: two directions of bending, and others such as torsion.

    Returns
    -------
    Axes
    """
    speeds = units.speed_unit().of(np.asarray(speeds))
    ax = axes_and_lines.set_up_axes(ax, axes_and_lines.speed_label(units), "natural frequency [Hz]")
    names = labels or _number_modes(np.shape(frequency)[1])
    for i, (y, of_mode, label) in enumerate(zip(np.transpose(frequency), kinds.T, names, strict=True)):
        axes_and_lines.draw_by_plane(ax, speeds, y, of_mode, axes_and_lines.style_by_plane(i))
        axes_and_lines.name_colour(ax, label, i)
    ax.update_datalim([(speeds[0], 0), (speeds[-1], 0)], updatey=False)
    return axes_and_lines.name_planes(ax, [f"mostly {word}" for word in words], kinds)


def plot_response(
    speeds: np.ndarray,
    amplitude: np.ndarray,
    bound: np.ndarray | None = None,
    ax: Axes | None = None,
    by_direction: Mapping[str, np.ndarray] | None = None,
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw a resonance curve: tip deflection on a logarithmic scale over speed.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Angular speeds [rad/s].
    amplitude : ndarray, shape (S,)
        Largest tip deflection [m]; nan leaves a gap.
    bound : ndarray, shape (S,), optional
        Sum of the amplitudes of all excitation frequencies [m].
    ax : Axes, optional
        Axes to draw on; new axes if not given.
    by_direction : mapping of str to ndarray, shape (S,), optional
        Largest tip deflections in single directions [m].
    units : DisplayUnits, optional
        Units of the axes; the arrays are SI.

    Returns
    -------
    Axes
    """
    speed, length = units.speed_unit(), units.length_unit()
    label = f"largest tip deflection [{length.name}]"
    ax = axes_and_lines.set_up_axes(ax, axes_and_lines.speed_label(units), label)
    bounds = {} if bound is None else {"sum of the lines": bound}
    rows = {"largest over both phases": amplitude, **bounds, **(by_direction or {})}
    drawn = (length.of(np.where(np.asarray(row) > 0, row, np.nan)) for row in rows.values())
    axes_and_lines.draw_lines(ax, speed.of(np.asarray(speeds)), drawn, list(rows))
    for line in ax.lines[1:]:
        line.set(linestyle="--", linewidth=1.2)  # drawn thin, as it mostly lies on top of the first curve
    if (np.asarray(amplitude) > 0).any():
        ax.set_yscale("log")
    return add_legend(ax)


def plot_sweep(
    speeds: np.ndarray,
    peaks: np.ndarray,
    ax: Axes | None = None,
    labels: Sequence[str] = ("peak",),
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw the largest tip deflections of transient simulations over speed, in one line or several.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Angular speeds [rad/s].
    peaks : ndarray, shape (S,) or (d, S)
        Largest tip deflections [m] of one line, or of d lines; nan leaves a gap.
    ax : Axes, optional
        Axes to draw on; new axes if not given.
    labels : sequence of str, length d
        Names of the lines in the legend; a single line needs none.
    units : DisplayUnits, optional
        Units of the axes; the arrays are SI.

    Returns
    -------
    Axes
    """
    speed, length = units.speed_unit(), units.length_unit()
    label = f"peak of the tip deflection [{length.name}]"
    ax = axes_and_lines.set_up_axes(ax, axes_and_lines.speed_label(units), label)
    axes_and_lines.draw_lines(ax, speed.of(np.asarray(speeds)), length.of(np.atleast_2d(peaks)), labels)
    ax.set_ylim(bottom=0)
    return add_legend(ax) if len(labels) > 1 else ax


def plot_branches(
    branches: Sequence[tuple[str, np.ndarray, np.ndarray, np.ndarray]],
    ax: Axes | None = None,
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw branches of equilibria over speed: solid where they are stable, dashed where they are unstable.

    Parameters
    ----------
    branches : sequence of tuple
        For each branch: name, speeds (k,) [rad/s], tip deflections divided by the length (k,), and whether
        each point is stable (k,).
    ax : Axes, optional
        Axes to draw on; new axes if not given.
    units : DisplayUnits, optional
        Units of the axes; the arrays are SI.

    Returns
    -------
    Axes
    """
    ax = axes_and_lines.new_axes() if ax is None else ax
    for colour, (name, speeds, tip, stable) in zip(COLOURS, branches, strict=False):
        lost = ~stable  # unstable points and their neighbours, so that dashed and solid lines meet
        around = lost | np.r_[False, lost[:-1]] | np.r_[lost[1:], False]
        for where, style, word in ((stable, "-", "stable"), (around, "--", "unstable")):
            if where.any():
                x, y = units.speed_unit().of(speeds), np.where(where, tip, np.nan)
                ax.plot(x, y, style, color=colour, label=f"{name}, {word}")
    ax.set(xlabel=axes_and_lines.speed_label(units), ylabel="tip deflection over the length")
    ax.legend()
    return ax


# Plots over time and frequency -------------------------------------------------------------------------


def plot_transient(
    t: np.ndarray,
    tip: np.ndarray,
    ax: Axes | None = None,
    labels: Sequence[str] = ("",),
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw the tip deflection over time, one line per direction.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Times [s].
    tip : ndarray, shape (n,) or (d, n)
        Tip deflection [m]; one row for each of d directions if there are several.
    ax : Axes, optional
        Axes to draw on; new axes if not given.
    labels : sequence of str, length d
        Names of the lines in the legend; a single line needs none.
    units : DisplayUnits, optional
        Units of the axes; the arrays are SI.

    Returns
    -------
    Axes
    """
    ax = axes_and_lines.set_up_axes(ax, "time [s]", f"tip deflection [{units.length_unit().name}]")
    for colour, row, label in zip(COLOURS, np.atleast_2d(tip), labels, strict=False):
        width = 0.8 if len(t) > _MOST_THICK else 1.8
        ax.plot(t, units.length_unit().of(row), color=colour, linewidth=width, label=label)
    ax.margins(x=0)
    return add_legend(ax) if len(labels) > 1 else ax


def plot_frequency_response(
    curves: Sequence[tuple[np.ndarray, np.ndarray]],
    ylabel: str,
    labels: Sequence[str],
    ax: Axes | None = None,
) -> Axes:
    """Draw amplitudes or spectral densities over frequency on logarithmic axes.

    Parameters
    ----------
    curves : sequence of (ndarray, ndarray), each of shape (F,)
        Frequencies [Hz] and values of each curve; the frequency 0 is not drawn.
    ylabel : str
        Label of the vertical axis.
    labels : sequence of str, one per curve
        Names of the curves in the legend; a curve with an empty name has no entry.
    ax : Axes, optional
        Axes to draw on; new axes if not given.
    """
    ax = axes_and_lines.set_up_axes(ax, "frequency [Hz]", ylabel)
    for (frequencies, size), label in zip(curves, labels, strict=True):
        drawn = frequencies > 0
        ax.loglog(frequencies[drawn], size[drawn], label=label or None)
    return add_legend(ax) if any(labels) else ax


def _number_modes(count: int) -> list[str]:
    """Return the names "mode 1", "mode 2" and so on, for the legend."""
    return [f"mode {i}" for i in range(1, count + 1)]
