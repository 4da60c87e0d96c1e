"""Pictures of answers over inputs: curves over one input, lines of equal value over two, a panel each."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from beamdyn.common.plots.axes_and_lines import new_axes, panels, set_up_axes
from beamdyn.common.plots.placed_labels import PlacedLabels
from beamdyn.common.results.pictures import COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MOST_THIRD = 3  # values of a third input that have a panel
_COLUMNS = 3  # panels in a row
_LEVELS = 8  # lines of equal value, at most
_DECADES = 1.5  # decades of values from which on lines of equal value ascend by ratios
_LOGARITHMIC = 10.0  # largest over smallest value of an input at equal ratios, from which on its axis is so
_DIGITS = 4
_FEW = 40  # values of an input whose points are marked on a curve
_SMOOTHED, _APART = 1.0, 0.02  # places over which an edge is smoothed; its least distance from one
_SAME = 1e-9  # relative difference of values that rounding makes: no lines are drawn between them
_RARE = 0.04  # share of the values, smallest and largest, that lines of equal value are not chosen by
_LETTERS = 10.0  # of a title in an inch
_NARROWEST, _WIDE = 2.2, 100.0  # least width of a map, and one that has room for all [inch]
_HATCHED: dict[str, Any] = {"facecolor": "0.93", "edgecolor": "0.72", "hatch": "////", "linewidth": 0}
_PALE = (0.0, 0.42)  # part of the colours between the lines, so that texts on them are read
_MEETS = "#A0303A"  # colour of lines that the answer meets, such as those of an excitation


@dataclass(frozen=True)
class MapInput:
    """An input of a picture.

    Parameters
    ----------
    name : str
        Its name.
    unit : str
        Unit in which it is shown.
    values : ndarray, shape (n,)
        Its values [unit].
    present : float, optional
        Its value in the present design [unit].
    """

    name: str
    unit: str
    values: np.ndarray
    present: float | None = None

    @property
    def label(self) -> str:
        """Name and unit."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name

    def at(self, i: int) -> str:
        """Its value i in words."""
        return f"{self.name} = {self.values[i]:.{_DIGITS}g} {self.unit}".rstrip()

    @property
    def is_logarithmic(self) -> bool:
        """Whether its values are at equal ratios, over a decade at least."""
        ends = np.sort(self.values)[[0, -1]]
        if not (ends[0] > 0 and ends[1] >= _LOGARITHMIC * ends[0] and len(self.values) > 2):
            return False
        return bool(np.ptp(np.diff(np.log(np.sort(self.values)))) < 1e-6 * np.log(ends[1] / ends[0]))


@dataclass(frozen=True)
class MapAnswer:
    """An answer over inputs.

    Parameters
    ----------
    title : str
        What it is, with its unit.
    value : ndarray, shape (n1, ..., nd)
        Its values; not finite where there is none.
    reason : ndarray of str, shape (n1, ..., nd)
        Why there is none.
    meets : mapping of str to ndarray, shape (n1, ..., nd)
        Values by name, such as frequencies of an excitation, which are marked where the answer meets them.
    """

    title: str
    value: np.ndarray
    reason: np.ndarray
    meets: Mapping[str, np.ndarray] = field(default_factory=dict)


def map_size(
    inputs: Sequence[MapInput], answers: Sequence[MapAnswer], width: float | None = None
) -> tuple[float, float]:
    """Width and height of the picture that `plot_maps` makes, of a width if one is given, in inches."""
    count, columns = _grid(inputs, answers, width or _WIDE)
    usual = 7.5 if columns == 1 else 4.2 * columns
    return width or usual, 0.6 + (2.6 if len(_varied(inputs)) < 2 else 3.2) * -(-count // columns)


def plot_maps(inputs: Sequence[MapInput], answers: Sequence[MapAnswer], ax: Axes | None = None) -> Axes:
    """Draw answers over inputs, a panel each.

    Over one input an answer is a curve.  Over two it is drawn by lines of equal value, labelled; of a third
    input some values have panels of their own; of further ones, and of those that have one value, the title
    says the first.  Where there is no answer the panel is hatched, and says why.

    Parameters
    ----------
    inputs : sequence of MapInput
        The d inputs, one of them that belongs to each axis of the answers.
    answers : sequence of MapAnswer
        The answers; those without any value are named in a panel of its own.
    ax : Axes, optional
        Whose place is taken; that of a new figure if not given.

    Returns
    -------
    Axes
        The panel where it is one, else those whose place is taken.
    """
    over = _varied(inputs)
    shown = [*_panels(inputs, answers)]
    if ax is None:
        ax = new_axes(*map_size(inputs, answers))
    inches = ax.bbox.width / ax.figure.dpi
    count, columns = _grid(inputs, answers, inches)
    whole, each = (ax, [ax]) if count == 1 else panels(count, ax, columns)
    for k, (panel, (title, value, reason, meets)) in enumerate(zip(each, shown, strict=True)):
        draw = _draw_map if len(over) > 1 else _draw_curve
        draw(panel, [inputs[i] for i in over[:2]], value, reason, meets)
        letters = max(int(_LETTERS * inches / columns), 12)
        rows = (row for line in title.splitlines() for row in textwrap.wrap(line, letters))
        panel.set_title("\n".join(rows), fontsize=10)
        if k + columns < count:
            panel.set_xlabel("")
        if len(over) > 1 and k % columns:
            panel.set_ylabel("")
    return whole


# Panels ----------------------------------------------------------------------------------------------


def _varied(inputs: Sequence[MapInput]) -> list[int]:
    """Which inputs have several values; the first one where none has."""
    return [i for i, each in enumerate(inputs) if len(each.values) > 1] or [0]


def _grid(inputs: Sequence[MapInput], answers: Sequence[MapAnswer], inches: float) -> tuple[int, int]:
    """How many panels there are, and how many in a row of a width."""
    count, over = len([*_panels(inputs, answers)]), _varied(inputs)
    if len(over) < 2:
        return count, 1
    columns = len(_thirds(inputs[over[2]])) if len(over) > 2 else min(count, _COLUMNS)
    return count, max(min(columns, int(inches / _NARROWEST)), 1)


def _thirds(given: MapInput) -> list[int]:
    """Which values of a third input have a panel."""
    count = len(given.values)
    return np.unique(np.linspace(0, count - 1, min(count, _MOST_THIRD)).round().astype(int)).tolist()


_Panel = tuple[str, np.ndarray, np.ndarray, dict[str, np.ndarray]]


def _panels(inputs: Sequence[MapInput], answers: Sequence[MapAnswer]) -> Iterator[_Panel]:
    """Yield title, values, reasons and lines of each panel, over the first one or two varied inputs."""
    over = _varied(inputs)
    thirds = _thirds(inputs[over[2]]) if len(over) > 2 else [0]
    known = [each for each in answers if np.isfinite(each.value).any()] or answers[:1]
    for answer, third in product(known, thirds):
        place: list[Any] = [0] * len(inputs)
        for i in over[:2]:
            place[i] = slice(None)
        if len(over) > 2:
            place[over[2]] = third
        fixed = [each.at(place[i]) for i, each in enumerate(inputs) if i not in over[:2]]
        at = tuple(place)
        meets = {name: np.broadcast_to(each, answer.value.shape)[at] for name, each in answer.meets.items()}
        yield "\n".join([answer.title, ", ".join(fixed)]).strip(), answer.value[at], answer.reason[at], meets


def _set_up(ax: Axes, inputs: Sequence[MapInput], ylabel: str = "") -> None:
    """Labels and scales of axes over inputs."""
    set_up_axes(ax, inputs[0].label, ylabel or inputs[-1].label)
    for given, scaled in zip(inputs, (ax.set_xscale, ax.set_yscale), strict=False):
        if given.is_logarithmic:
            scaled("log")
    for axis in (ax.xaxis, ax.yaxis):
        axis.label.set_fontsize(10)
    ax.tick_params(labelsize=9)
    ax.grid(visible=False)


# Over two inputs -------------------------------------------------------------------------------------


def _draw_map(
    ax: Axes,
    inputs: Sequence[MapInput],
    value: np.ndarray,
    reason: np.ndarray,
    meets: Mapping[str, np.ndarray],
) -> None:
    """Draw lines of equal value over two inputs, on hatched ground."""
    _set_up(ax, inputs)
    orders = [np.argsort(each.values, kind="stable") for each in inputs]
    x, y = (each.values[order] for each, order in zip(inputs, orders, strict=True))
    sort = np.ix_(*orders)
    z, why = np.where(np.isfinite(value), value, np.nan)[sort].T, reason[sort].T
    labels = PlacedLabels(ax)
    ax.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
    _mark_present(ax, labels, *(each.present for each in inputs))
    lacking = ~np.isfinite(z)
    if lacking.any():
        _hatch(ax, x, y, lacking)
        _name_regions(ax, labels, x, y, lacking, why)
    for name, other in meets.items():
        _draw_meeting(ax, labels, x, y, z - other[sort].T, name)
    _draw_levels(ax, labels, x, y, z)


def _draw_levels(ax: Axes, labels: PlacedLabels, x: np.ndarray, y: np.ndarray, z: np.ndarray) -> None:
    """Draw lines of equal value with their labels, and pale colours between them."""
    from matplotlib import colormaps, colors

    known = z[np.isfinite(z)]
    if not known.size:
        return
    low, high = float(known.min()), float(known.max())
    if high - low <= _SAME * max(abs(low), abs(high)):
        middle = np.array([[(x[0] + x[-1]) / 2, (y[0] + y[-1]) / 2]])
        labels.add(f"{(low + high) / 2:.{_DIGITS}g} wherever there is an answer", middle)
        return
    levels = levels_of(known)
    pale = colors.ListedColormap(colormaps["YlGnBu"](np.linspace(*_PALE, 64)))
    bounds = np.union1d(levels, [np.nextafter(low, -np.inf), np.nextafter(high, np.inf)])
    ax.contourf(x, y, _extended(z), bounds, cmap=pale, zorder=1)  # up to the edge of what is hatched
    drawn = ax.contour(x, y, z, levels, colors="0.25", linewidths=1.0, zorder=2)
    for level, paths in zip(levels.tolist(), drawn.allsegs, strict=True):
        _label_path(labels, f"{level:.{_DIGITS}g}", paths, color="0.1")


def _extended(z: np.ndarray) -> np.ndarray:
    """Values with those of the nearest place where there is none."""
    _, (rows, columns) = _nearest_outside(~np.isfinite(z))
    return z[rows, columns]


def _nearest_outside(region: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distances (ny, nx) from the nearest places outside a region, and their indices (2, ny, nx)."""
    from scipy.ndimage import distance_transform_edt

    distances, indices = distance_transform_edt(region, return_indices=True)
    return np.asarray(distances), np.asarray(indices)


def levels_of(known: np.ndarray) -> np.ndarray:
    """Round values between the smallest and the largest: at equal steps, or 1, 2, 5, 10 over decades."""
    from matplotlib.ticker import MaxNLocator

    low, high = np.quantile(known, (_RARE, 1 - _RARE)).tolist()  # those of a few may be far off
    if low > 0 and high > 10**_DECADES * low:
        decades = np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1)
        steps = (1.0, 2.0, 5.0) if len(decades) < _LEVELS else (1.0,)
        ticks = np.ravel([[step * 10.0**n for step in steps] for n in decades])
    else:
        ticks = MaxNLocator(_LEVELS, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
    return ticks[(ticks > known.min()) & (ticks < known.max())]


def _label_path(labels: PlacedLabels, text: str, paths: Sequence[np.ndarray], **style: Any) -> None:
    """Label the longest of some paths, near its middle if there is room."""
    if paths:
        points = np.asarray(max(paths, key=len))
        from_middle = np.abs(np.arange(len(points)) - (len(points) - 1) / 2)
        labels.add(text, points[np.argsort(from_middle, kind="stable")], **style)


def _draw_meeting(
    ax: Axes, labels: PlacedLabels, x: np.ndarray, y: np.ndarray, distance: np.ndarray, name: str
) -> None:
    """Draw the line on which a distance (ny, nx) is zero, with its name."""
    known = distance[np.isfinite(distance)]
    if known.size and known.min() < 0 < known.max():
        drawn = ax.contour(x, y, distance, [0.0], colors=_MEETS, linestyles="--", linewidths=1.8, zorder=3)
        _label_path(labels, name, drawn.allsegs[0], color=_MEETS)


def _hatch(ax: Axes, x: np.ndarray, y: np.ndarray, lacking: np.ndarray) -> None:
    """Hatch where there is no answer, up to a smooth line between the places with and without one."""
    from scipy.ndimage import gaussian_filter

    share = gaussian_filter(lacking.astype(float), _SMOOTHED)
    side = np.where(lacking, np.maximum(share, 0.5 + _APART), np.minimum(share, 0.5 - _APART))
    drawn = ax.contourf(
        x, y, side, [0.5, 2.0], colors=_HATCHED["facecolor"], hatches=[_HATCHED["hatch"]], zorder=1.5
    )
    drawn.set(edgecolor=_HATCHED["edgecolor"], linewidth=0)


def _name_regions(
    ax: Axes, labels: PlacedLabels, x: np.ndarray, y: np.ndarray, lacking: np.ndarray, why: np.ndarray
) -> None:
    """Name each region without an answer in its middle."""
    for name in np.unique(why[lacking]).tolist():
        region = lacking & (why == name)
        depth = _nearest_outside(np.pad(region, 1))[0][1:-1, 1:-1]
        deepest = np.argsort(-depth[region], kind="stable")
        rows, columns = (each[deepest] for each in np.nonzero(region))
        labels.add(name, np.stack([x[columns], y[rows]], axis=1), color="0.25", style="italic")


def _mark_present(ax: Axes, labels: PlacedLabels, x: float | None, y: float | None) -> None:
    """Mark the present design, if it lies within the axes."""
    if x is None or y is None:
        return
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    if left <= x <= right and bottom <= y <= top:
        ax.plot(x, y, "o", color="black", markerfacecolor="white", markersize=7, zorder=7, clip_on=False)
        labels.add("present design", np.array([[x, y]]), beside=True)


# Over one input --------------------------------------------------------------------------------------


def _draw_curve(
    ax: Axes,
    inputs: Sequence[MapInput],
    value: np.ndarray,
    reason: np.ndarray,
    meets: Mapping[str, np.ndarray],
) -> None:
    """Draw an answer over one input, hatched where there is none."""
    given = inputs[0]
    order = np.argsort(given.values, kind="stable")
    x, y, why = given.values[order], np.where(np.isfinite(value), value, np.nan)[order], reason[order]
    _set_up(ax, inputs, " ")
    labels = PlacedLabels(ax)
    ax.plot(x, y, color=COLOURS[0], linewidth=1.8, marker="." if len(x) <= _FEW else "")
    if len(x) > 1:
        ax.set_xlim(x[0], x[-1])
    known = y[np.isfinite(y)]
    room = 0.06 * (np.ptp(known) or np.abs(known).max(initial=0.0) or 1.0) if known.size else 1.0
    ends = (known.min() - room, known.max() + room) if known.size else (0.0, 1.0)
    ax.set_ylim(*ends)
    ax.grid(visible=True, color="0.9", linewidth=0.7)
    if given.present is not None and x[0] <= given.present <= x[-1]:
        ax.axvline(given.present, color="0.35", linewidth=1.0, linestyle=":")
        heights = np.linspace(*ends, 12)[1:-1]
        labels.add("present design", np.stack([np.full(10, given.present), heights], axis=1))
    _hatch_spans(ax, labels, x, y, why)
    for name, other in meets.items():
        line = np.broadcast_to(other, value.shape)[order]
        ax.plot(x, line, color=_MEETS, linewidth=1.2, linestyle="--", scalex=False, scaley=False)
        inside = (line > ends[0]) & (line < ends[1])
        if inside.any():
            labels.add(name, np.stack([x, line], axis=1)[inside][::-1], color=_MEETS)


def _hatch_spans(ax: Axes, labels: PlacedLabels, x: np.ndarray, y: np.ndarray, why: np.ndarray) -> None:
    """Hatch and name the parts of an axis where a curve has no value."""
    between = np.concatenate([x[:1], (x[1:] + x[:-1]) / 2, x[-1:]])
    names = np.where(np.isfinite(y), "", why)
    starts = np.flatnonzero(np.concatenate([[True], names[1:] != names[:-1]]))
    (low, high), said = ax.get_ylim(), set()
    for start, stop in zip(starts, [*starts[1:], len(x)], strict=True):
        name = str(names[start])
        if not name:
            continue
        left, right = between[start], between[stop]
        ax.axvspan(left, right, zorder=0.5, **_HATCHED)
        if name not in said:
            heights = low + (high - low) * np.array([0.5, 0.7, 0.3, 0.9, 0.1])
            places = np.stack([np.full(5, (left + right) / 2), heights], axis=1)
            labels.add(name, places, color="0.25", style="italic")
            said.add(name)
