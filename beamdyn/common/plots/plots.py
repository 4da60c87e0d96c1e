"""Plots of arrays on matplotlib Axes; nothing is shown, and pyplot is loaded only to make new axes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogFormatterSciNotation, ScalarFormatter

from beamdyn.common.results.display_units import SI_UNITS, DisplayUnits
from beamdyn.common.results.pictures import COLOURS, DASHES, add_legend
from beamdyn.common.results.pictures import save_figure as save_figure  # exported with the plots

_MARKERS = "osD^vXP"
_MOST_THICK = 2000  # samples above which a line over time is drawn thin


def plot_locus(
    speeds: np.ndarray,
    frequency: np.ndarray,
    ax: Axes | None = None,
    labels: Sequence[str] | None = None,
    critical_speed: float | None = None,
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw natural frequencies over speed, one line a mode.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Angular speeds [rad/s].
    frequency : ndarray, shape (S, m)
        Frequencies [Hz]; nan, where a mode does not oscillate, leaves a gap.
    ax : Axes, optional
        Where to draw; new axes if not given.
    labels : sequence of str, length m, optional
        For the legend; "mode 1" and so on if not given.
    critical_speed : float, optional
        Speed [rad/s] to mark, as `mark_critical` does.
    units : DisplayUnits, optional
        Units of the axes; the arrays are SI.

    Returns
    -------
    Axes
    """
    return _plot_over_speed(speeds, frequency, "natural frequency [Hz]", ax, labels, critical_speed, units)


def plot_growth(
    speeds: np.ndarray,
    growth_rate: np.ndarray,
    ax: Axes | None = None,
    labels: Sequence[str] | None = None,
    critical_speed: float | None = None,
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw growth rates over speed, one line a mode, in the colours of `plot_locus`.

    Frequencies say nothing of a mode that grows: this belongs below a locus that passes the critical speed.

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
    return _plot_over_speed(speeds, growth_rate, "growth rate [1/s]", ax, labels, critical_speed, units)


def plot_loci_by_angle(
    speeds: np.ndarray,
    frequency: np.ndarray,
    angles_deg: Sequence[float] | np.ndarray,
    ax: Axes | None = None,
) -> Axes:
    """Draw one frequency over speed, one line a setting angle.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Angular speeds [rad/s].
    frequency : ndarray, shape (k, S)
        Frequency [Hz] at each setting angle; nan leaves a gap.
    angles_deg : sequence of float, length k
        Setting angles [degrees].
    ax : Axes, optional
        Where to draw; new axes if not given.

    Returns
    -------
    Axes
    """
    labels = [f"setting angle {angle:.10g}°" for angle in angles_deg]
    return _plot_over_speed(
        speeds, np.asarray(frequency).T, "natural frequency [Hz]", ax, labels, None, SI_UNITS
    )


def plot_shapes(
    x: np.ndarray,
    shapes: np.ndarray,
    labels: Sequence[str],
    ax: Axes | None = None,
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw mode shapes, each over its own largest deflection.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Positions along the beam [m].
    shapes : ndarray, shape (m, n)
        Deflections of the modes, real, in any unit.
    labels : sequence of str, length m
        For the legend.
    ax : Axes, optional
        Where to draw; new axes if not given.
    units : DisplayUnits, optional
        Units of the axes; the arrays are SI.

    Returns
    -------
    Axes
    """
    largest = np.abs(shapes).max(axis=1, keepdims=True)
    scaled = shapes / np.where(largest == 0, 1.0, largest)
    ax = set_up_shapes(ax, units)
    _draw_lines(ax, units.length_unit("m").of(x), scaled, labels)
    return add_legend(ax)


def plot_response(
    speeds: np.ndarray,
    amplitude: np.ndarray,
    bound: np.ndarray | None = None,
    ax: Axes | None = None,
    by_direction: Mapping[str, np.ndarray] | None = None,
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw a resonance curve with a logarithmic scale of deflection.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Angular speeds [rad/s].
    amplitude : ndarray, shape (S,)
        Largest tip deflection [m]; nan leaves a gap.
    bound : ndarray, shape (S,), optional
        Sum of the amplitudes of all lines [m].
    ax : Axes, optional
        Where to draw; new axes if not given.
    by_direction : mapping of str to ndarray, shape (S,), optional
        Largest tip deflections in single directions [m].
    units : DisplayUnits, optional
        Units of the axes; the arrays are SI.

    Returns
    -------
    Axes
    """
    speed, length = units.speed_unit(), units.length_unit()
    ax = set_up_axes(ax, speed_label(units), f"largest tip deflection [{length.name}]")
    rows = {"largest over both phases": np.asarray(amplitude)}
    if bound is not None:
        rows["sum of the lines"] = np.asarray(bound)
    rows |= by_direction or {}
    drawn = (length.of(np.where(row > 0, row, np.nan)) for row in rows.values())
    _draw_lines(ax, speed.of(np.asarray(speeds)), drawn, list(rows))
    for line in ax.lines[1:]:
        line.set(linestyle="--", linewidth=1.2)  # mostly on top of the other
    if (np.asarray(amplitude) > 0).any():
        ax.set_yscale("log")
    return add_legend(ax)


def plot_transient(
    t: np.ndarray,
    tip: np.ndarray,
    ax: Axes | None = None,
    labels: Sequence[str] = ("",),
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw the tip deflection over time, one line a direction.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Times [s].
    tip : ndarray, shape (n,) or (d, n)
        Tip deflection [m], or that in each of d directions.
    ax : Axes, optional
        Where to draw; new axes if not given.
    labels : sequence of str, length d
        For the legend, which one line needs none of.
    units : DisplayUnits, optional
        Units of the axes; the arrays are SI.

    Returns
    -------
    Axes
    """
    ax = set_up_axes(ax, "time [s]", f"tip deflection [{units.length_unit().name}]")
    for colour, row, label in zip(COLOURS, np.atleast_2d(tip), labels, strict=False):
        width = 0.8 if len(t) > _MOST_THICK else 1.8
        ax.plot(t, units.length_unit().of(row), color=colour, linewidth=width, label=label)
    ax.margins(x=0)
    return add_legend(ax) if len(labels) > 1 else ax


def plot_sweep(
    speeds: np.ndarray,
    peaks: np.ndarray,
    ax: Axes | None = None,
    labels: Sequence[str] = ("peak",),
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw the peaks of transients over speed, one line each.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Angular speeds [rad/s].
    peaks : ndarray, shape (S,) or (d, S)
        Largest tip deflections [m]; nan leaves a gap.
    ax : Axes, optional
        Where to draw; new axes if not given.
    labels : sequence of str, length d
        For the legend, which one line needs none of.
    units : DisplayUnits, optional
        Units of the axes; the arrays are SI.

    Returns
    -------
    Axes
    """
    speed, length = units.speed_unit(), units.length_unit()
    ax = set_up_axes(ax, speed_label(units), f"peak of the tip deflection [{length.name}]")
    _draw_lines(ax, speed.of(np.asarray(speeds)), length.of(np.atleast_2d(peaks)), labels)
    ax.set_ylim(bottom=0)
    return add_legend(ax) if len(labels) > 1 else ax


def plot_work_precision(
    families: Mapping[str, np.ndarray],
    front: np.ndarray,
    title: str = "",
    ax: Axes | None = None,
) -> Axes:
    """Draw error against time, one line a family, and the Pareto front as a broad band below them.

    Parameters
    ----------
    families : mapping of str to ndarray, shape (n, 2)
        Times [s] and relative errors; an error above 1, not a digit being right, is drawn as 1.
    front : ndarray, shape (k, 2)
        Times and errors of the Pareto-optimal measurements.
    title : str
        Above the axes.
    ax : Axes, optional
        Where to draw; new axes if not given.

    Returns
    -------
    Axes
    """
    ax = set_up_axes(ax, "time [s]", "relative error")
    ax.set(xscale="log", yscale="log")
    ax.set_title(title, fontsize=11)
    ax.tick_params(which="minor", labelsize=8)
    ax.xaxis.set_minor_formatter(LogFormatterSciNotation(minor_thresholds=(1.15, 0.3)))
    ax.plot(*_clip(front).T, color="0.85", linewidth=9, solid_capstyle="round", label="Pareto front")
    for i, (name, points) in enumerate(families.items()):
        marker = _MARKERS[i % len(_MARKERS)]
        ax.plot(
            *_clip(points).T,
            marker=marker,
            markersize=4,
            linewidth=1.2,
            label=name,
            **_line_style(i),
        )
    return add_legend(ax)


def _clip(points: np.ndarray) -> np.ndarray:
    """Drop points without a positive error, which a logarithmic axis cannot show, and clip errors to 1."""
    return np.minimum(points[points[:, 1] > 0], [np.inf, 1.0])


def panels(count: int, ax: Axes | None = None) -> tuple[Axes, list[Axes]]:
    """Replace axes by several that share their place, two in a row.

    Parameters
    ----------
    count : int
        How many.
    ax : Axes, optional
        Whose place they take; that of a new figure if not given.

    Returns
    -------
    Axes
        Those whose place is taken.
    list of Axes
        The new ones, in reading order.
    """
    columns = min(2, count)
    rows = -(-count // columns)
    if ax is None:
        from matplotlib import pyplot

        ax = pyplot.subplots(figsize=(6.5 * columns, 4.5 * rows), layout="constrained")[1]
    place, figure = ax.get_subplotspec(), ax.get_figure()
    if place is None or figure is None:
        raise ValueError("ax: give axes made by subplots: their place is divided")
    ax.set_axis_off()
    grid = place.subgridspec(rows, columns)
    return ax, [figure.add_subplot(grid[divmod(i, columns)]) for i in range(count)]


def mark_points(
    ax: Axes, x: np.ndarray | Sequence[float], y: np.ndarray | Sequence[float], label: str
) -> Axes:
    """Lay points, such as published ones, over a picture.

    Parameters
    ----------
    ax : Axes
        Where to draw.
    x, y : array_like, shape (n,)
        The points, in the units of the axes.
    label : str
        For the legend: where they come from.

    Returns
    -------
    Axes
    """
    ax.plot(x, y, "o", color="black", markerfacecolor="white", markersize=7, zorder=3, label=label)
    return add_legend(ax)


def mark_critical(
    ax: Axes, speed: float, label: str = "critical speed", units: DisplayUnits = SI_UNITS
) -> Axes:
    """Mark a critical speed by a line, and shade what lies past it.

    Parameters
    ----------
    ax : Axes
        With angular speed on x; its limits stay.
    speed : float
        Critical speed [rad/s]; one outside the limits, such as inf, is not drawn.
    label : str
        What to call it.
    units : DisplayUnits, optional
        Units of the axes; the arrays are SI.

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


def _plot_over_speed(
    speeds: np.ndarray,
    values: np.ndarray,
    quantity: str,
    ax: Axes | None,
    labels: Sequence[str] | None,
    critical_speed: float | None,
    units: DisplayUnits,
) -> Axes:
    values = np.asarray(values)
    speeds = units.speed_unit().of(np.asarray(speeds))
    ax = set_up_axes(ax, speed_label(units), quantity)
    _draw_lines(ax, speeds, values.T, labels or number_modes(values.shape[1]))
    ax.update_datalim([(speeds[0], 0), (speeds[-1], 0)], updatey=False)  # also where every mode is nan
    return add_legend(ax) if critical_speed is None else mark_critical(ax, critical_speed, units=units)


def number_modes(count: int) -> list[str]:
    """Names of modes for the legend."""
    return [f"mode {i}" for i in range(1, count + 1)]


def set_up_shapes(ax: Axes | None, units: DisplayUnits = SI_UNITS) -> Axes:
    """Label the axes for mode shapes, each over its largest deflection, and draw the beam at rest."""
    ax = set_up_axes(ax, position_label(units), "deflection / its largest value")
    ax.axhline(0, color="0.4", linewidth=0.8)
    return ax


def speed_label(units: DisplayUnits) -> str:
    """Name of an axis of speeds."""
    return f"angular speed [{units.speed_unit().name}]"


def position_label(units: DisplayUnits) -> str:
    """Name of an axis of positions along the beam."""
    return f"position along the beam [{units.length_unit('m').name}]"


def set_up_axes(ax: Axes | None, xlabel: str, ylabel: str) -> Axes:
    """Label the axes, new ones if none are given, with a grid and plain numbers."""
    ax = new_axes() if ax is None else ax
    ax.set_xlabel(xlabel, fontsize=12)
    ax.set_ylabel(ylabel, fontsize=12)
    ax.tick_params(labelsize=11)
    for axis in (ax.xaxis, ax.yaxis):
        if isinstance(
            formatter := axis.get_major_formatter(), ScalarFormatter
        ):  # not of axes drawn on before
            formatter.set_useOffset(False)
    ax.margins(x=0.02)
    ax.grid(color="0.85", linewidth=0.7)
    ax.set_axisbelow(True)
    return ax


def new_axes() -> Axes:
    """Axes of a new figure, which matplotlib keeps to show it."""
    from matplotlib import pyplot

    return pyplot.subplots(figsize=(7.5, 4.8), layout="constrained")[1]


def _draw_lines(ax: Axes, x: np.ndarray, rows: Iterable[np.ndarray], labels: Sequence[str]) -> None:
    for i, (y, label) in enumerate(zip(rows, labels, strict=True)):
        (line,) = ax.plot(x, y, label=label, linewidth=1.8, **_line_style(i))
        if (isolated := is_isolated(y)).any():
            line.set(marker=".", markevery=isolated)


def _line_style(i: int) -> dict[str, Any]:
    """Colour and dashes of line i; the dashes change when the colours are used up."""
    cycle, colour = divmod(i, len(COLOURS))
    return {"color": COLOURS[colour], "linestyle": DASHES[cycle % len(DASHES)]}


def is_isolated(y: np.ndarray) -> np.ndarray:
    """Whether each value lies between gaps: a line does not show it, so that it needs a marker."""
    known = np.pad(np.isfinite(y), 1)
    return known[1:-1] & ~known[:-2] & ~known[2:]
