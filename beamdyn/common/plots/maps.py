"""Plots of results over inputs: curves over one input, contour maps over two inputs.

Texts are placed each time the picture is drawn, so that they do not overlap at any size of the picture.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist

from beamdyn.common.inputs.described import VariedInput
from beamdyn.common.plots.axes_and_lines import new_axes, panels, set_up_axes
from beamdyn.common.results.columns import evenly_spread
from beamdyn.common.results.pictures import COLOURS, Axes

if TYPE_CHECKING:
    from matplotlib.text import Text

_APART_ON_PAPER = 2.0  # least distance between two texts [px]
_MOST = 80  # largest number of positions around a point that are tried for a text
_POINT = 5.0  # half the size of the marker of a point [px]
_ON_IT = np.zeros((1, 2))
# Directions, from a point, in which its text may be placed.
_WAYS = np.array([(1, 0.2), (-1, 0.2), (0, 1), (0, -1), (1, 1), (-1, 1), (1, -1), (-1, -1)])
_HALO: dict[str, Any] = {
    "boxstyle": "square,pad=0.1",
    "facecolor": "white",
    "alpha": 0.85,
    "edgecolor": "none",
}


class PlacedLabels(Artist):
    """Texts on axes, each at the first of its possible positions at which it covers no other text.

    A text near the edge is moved inwards; a text without a free position is not drawn.  Positions are chosen
    each time the picture is drawn.

    Parameters
    ----------
    ax : Axes
        The axes.
    """

    def __init__(self, ax: Axes) -> None:
        super().__init__()
        self.set_in_layout(False)  # texts lie within the axes, so that the layout reserves no space for them
        self.set_zorder(6)
        self._texts: list[tuple[Text, np.ndarray, np.ndarray]] = []
        self._points = np.empty((0, 2))
        ax.add_artist(self)

    def add(self, text: str, places: np.ndarray, beside: bool = False, **style: Any) -> None:
        """Add a text; texts that are added earlier are placed first.

        Parameters
        ----------
        text : str
            The text.
        places : ndarray, shape (places, 2)
            Possible positions of the text's centre, in the units of the axes, the best first.
        beside : bool
            Whether the text is placed beside the given positions, which are marked points that no text may
            cover.
        **style
            Properties of the text, as for `matplotlib.text.Text`.
        """
        from matplotlib.text import Text

        assert self.axes is not None
        centred: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 9, "bbox": _HALO}
        made = Text(places[0, 0], places[0, 1], text, **centred | style)
        made.set_figure(self.axes.figure)
        made.set_transform(self.axes.transData)
        places = places[:: -(-len(places) // _MOST)]
        self._texts.append((made, places, _WAYS if beside else _ON_IT))
        if beside:
            self._points = np.vstack([self._points, places])

    def get_children(self) -> list[Artist]:
        """Return the texts on the axes, for matplotlib."""
        return [text for text, *_ in self._texts]

    def draw(self, renderer: Any) -> None:
        """Place the texts, and draw them."""
        assert self.axes is not None
        frame, marked = self.axes.bbox, self.axes.transData.transform(self._points)
        ends = np.array([[frame.x0, frame.y0], [frame.x1, frame.y1]])
        taken = np.hstack([marked - _POINT, marked + _POINT])
        for text, places, ways in self._texts:
            text.set_visible(True)  # an invisible text has no size
            box = text.get_window_extent(renderer)
            half = np.array([box.width, box.height]) / 2 + _APART_ON_PAPER
            at = self.axes.transData.transform(places)[:, None] + ways * (half + _POINT)
            at = at.reshape(-1, 2)
            at = np.clip(at, ends[0] + half, np.maximum(ends[1] - half, ends[0] + half))
            boxes = np.hstack([at - half, at + half])
            free = (boxes[:, 2:] <= ends[1]).all(axis=1) & ~_overlap(boxes, taken)
            text.set_visible(bool(free.any()))
            if free.any():
                first = int(free.argmax())
                text.set_position(tuple(self.axes.transData.inverted().transform(at[first])))
                taken = np.vstack([taken, boxes[first]])
            text.draw(renderer)


def _overlap(boxes: np.ndarray, taken: np.ndarray) -> np.ndarray:
    """Return whether each of n boxes (n, 4) overlaps any of m boxes (m, 4) that are already used."""
    low, high = boxes[:, None, :2], boxes[:, None, 2:]
    each = np.all((low < taken[:, 2:]) & (taken[:, :2] < high), axis=-1)
    return np.asarray(np.any(each, axis=-1))


# Curves and contour maps -----------------------------------------------------------------------------

_MOST_THIRD = 3  # largest number of values of a third input; there is a panel for each value
_COLUMNS = 3  # largest number of panels in a row
_LEVELS = 8  # largest number of contour lines
_DECADES = 1.5  # range of values in decades, above which contour levels are at equal ratios
# If an input has values at equal ratios: least ratio of the largest to the smallest value for a log axis.
_LOGARITHMIC = 10.0
# Ratio of the largest to the smallest value from which a log axis has numbers only at powers of ten.
_MANY_DECADES = 1000.0
_DIGITS = 4
_TICKS = 6  # largest number of intervals between ticks below a map: their numbers may be long
_FEW = 40  # largest number of values of an input for which the points of a curve have markers
# The hatched region without results ends where the fraction of missing results, smoothed, is 1/2.
_SMOOTHED = 1.0  # standard deviation of the Gaussian that smooths the fraction [grid steps]
_APART = 0.02  # least distance of the fraction from 1/2 at grid points, so that the region ends between them
_SAME = 1e-9  # relative range of the values below which they count as equal: no contour lines are drawn
# Fraction of the smallest, and of the largest, values that do not influence the contour levels.
_RARE = 0.04
_LETTERS = 10.0  # characters of a title that fit into an inch
_NARROWEST, _WIDE = 2.2, 100.0  # least width of a map, and a width that is enough for all maps [inch]
_HATCHED: dict[str, Any] = {"facecolor": "0.93", "edgecolor": "0.72", "hatch": "////", "linewidth": 0}
_PALE = (0.0, 0.42)  # pale part of the colour map, on which texts can be read
_MEETS = "#A0303A"  # colour of lines that a result may cross, such as excitation lines


@dataclass(frozen=True)
class MapInput(VariedInput):
    """A varied input that is an axis of a plot, with its name and unit as shown there.

    Parameters
    ----------
    present : float, optional
        Value of the input in the present design [unit], which is marked.
    """

    present: float | None = None

    def at(self, i: int) -> str:
        """Format the input's value with index i."""
        return f"{self.name} = {self.values[i]:.{_DIGITS}g} {self.unit}".rstrip()

    @property
    def is_logarithmic(self) -> bool:
        """Return whether the values are at equal ratios and span at least a decade."""
        ends = np.sort(self.values)[[0, -1]]
        if not (ends[0] > 0 and ends[1] >= _LOGARITHMIC * ends[0] and len(self.values) > 2):
            return False
        return bool(np.ptp(np.diff(np.log(np.sort(self.values)))) < 1e-6 * np.log(ends[1] / ends[0]))


@dataclass(frozen=True)
class MapAnswer:
    """A result over inputs, to be drawn.

    Parameters
    ----------
    title : str
        Name of the result, with its unit.
    value : ndarray, shape (n1, ..., nd)
        Values of the result; not finite where there is none.
    reason : ndarray of str, shape (n1, ..., nd)
        The reason for each missing value.
    meets : mapping of str to ndarray, shape (n1, ..., nd)
        Comparison values by name, such as excitation frequencies; points at which the result equals them are
        marked.
    """

    title: str
    value: np.ndarray
    reason: np.ndarray
    meets: Mapping[str, np.ndarray] = field(default_factory=dict)


def map_size(
    inputs: Sequence[MapInput], answers: Sequence[MapAnswer], width: float | None = None
) -> tuple[float, float]:
    """Return width and height [inch] of the picture that `plot_maps` makes, for a given width if any."""
    count, columns = _grid(inputs, answers, width or _WIDE)
    usual = 7.5 if columns == 1 else 4.2 * columns
    return width or usual, 0.6 + (2.6 if len(_varied(inputs)) < 2 else 3.2) * -(-count // columns)


def plot_maps(inputs: Sequence[MapInput], answers: Sequence[MapAnswer], ax: Axes | None = None) -> Axes:
    """Draw results over inputs, with a panel for each result.

    Over one input a result is drawn as a curve, over two inputs by labelled contour lines.  Of a third input,
    some values have panels of their own.  All other inputs have their first value, which the title states.
    Regions without a result are hatched, and the reason is written there.

    Parameters
    ----------
    inputs : sequence of MapInput
        The d inputs, one for each axis of the arrays of results.
    answers : sequence of MapAnswer
        The results; those that lack all values are listed in a separate panel.
    ax : Axes, optional
        Axes whose area is divided into panels; axes of a new figure if not given.

    Returns
    -------
    Axes
        The panel if there is only one, else the axes that the panels replace.
    """
    over = _varied(inputs)
    shown = [*_panels(inputs, answers)]
    if ax is None:
        ax = new_axes(*map_size(inputs, answers))
    inches = ax.bbox.width / ax.figure.dpi
    count, columns = _grid(inputs, answers, inches)
    whole, each = (ax, [ax]) if count == 1 else panels(count, ax, columns)
    for k, (panel, answer) in enumerate(zip(each, shown, strict=True)):
        draw = _draw_map if len(over) > 1 else _draw_curve
        draw(panel, [inputs[i] for i in over[:2]], answer)
        letters = max(int(_LETTERS * inches / columns), 12)
        rows = (row for line in answer.title.splitlines() for row in textwrap.wrap(line, letters))
        panel.set_title("\n".join(rows), fontsize=10)
        if k + columns < count:
            panel.set_xlabel("")
        if len(over) > 1 and k % columns:
            panel.set_ylabel("")
    return whole


# Panels ----------------------------------------------------------------------------------------------


def _varied(inputs: Sequence[MapInput]) -> list[int]:
    """Return the indices of the inputs with several values; index 0 if no input has several."""
    return [i for i, each in enumerate(inputs) if len(each.values) > 1] or [0]


def _grid(inputs: Sequence[MapInput], answers: Sequence[MapAnswer], inches: float) -> tuple[int, int]:
    """Return the number of panels, and how many of them fit side by side into a given width [inch]."""
    count, over = len([*_panels(inputs, answers)]), _varied(inputs)
    if len(over) < 2:
        return count, 1
    columns = len(_thirds(inputs[over[2]])) if len(over) > 2 else min(count, _COLUMNS)
    return count, max(min(columns, int(inches / _NARROWEST)), 1)


def _thirds(given: MapInput) -> list[int]:
    """Return the indices of those values of a third input that have a panel."""
    return evenly_spread(len(given.values), _MOST_THIRD).tolist()


def _panels(inputs: Sequence[MapInput], answers: Sequence[MapAnswer]) -> Iterator[MapAnswer]:
    """Yield the part of a result that each panel shows, over one or two varied inputs."""
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
        title = "\n".join([answer.title, ", ".join(fixed)]).strip()
        yield MapAnswer(title, answer.value[at], answer.reason[at], meets)


def _set_up(ax: Axes, inputs: Sequence[MapInput], ylabel: str = "") -> None:
    """Set the labels and scales of axes whose coordinates are inputs."""
    set_up_axes(ax, inputs[0].label, ylabel or inputs[-1].label)
    for given, axis, scaled in zip(
        inputs, (ax.xaxis, ax.yaxis), (ax.set_xscale, ax.set_yscale), strict=False
    ):
        if given.is_logarithmic:
            scaled("log", subs=[2, 5] if max(given.values) < _MANY_DECADES * min(given.values) else [])
            axis.set_major_formatter("{x:g}")
            axis.set_minor_formatter("{x:g}")
    for axis in (ax.xaxis, ax.yaxis):
        axis.label.set_fontsize(10)
    ax.tick_params(which="both", labelsize=9)
    ax.grid(visible=False)


# Over two inputs -------------------------------------------------------------------------------------


def _draw_map(ax: Axes, inputs: Sequence[MapInput], answer: MapAnswer) -> None:
    """Draw contour lines over two inputs; the region without results is hatched."""
    _set_up(ax, inputs)
    if not inputs[0].is_logarithmic:
        ax.locator_params(axis="x", nbins=_TICKS)
    orders = [np.argsort(each.values, kind="stable") for each in inputs]
    x, y = (each.values[order] for each, order in zip(inputs, orders, strict=True))
    sort = np.ix_(*orders)
    z, why = np.where(np.isfinite(answer.value), answer.value, np.nan)[sort].T, answer.reason[sort].T
    labels = PlacedLabels(ax)
    ax.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
    _mark_present(ax, labels, *(each.present for each in inputs))
    lacking = ~np.isfinite(z)
    if lacking.any():
        _hatch(ax, x, y, lacking)
        _name_regions(labels, x, y, lacking, why)
    for name, other in answer.meets.items():
        _draw_meeting(ax, labels, x, y, z - other[sort].T, name)
    _draw_levels(ax, labels, x, y, z)


def _draw_levels(ax: Axes, labels: PlacedLabels, x: np.ndarray, y: np.ndarray, z: np.ndarray) -> None:
    """Draw labelled contour lines, with pale colours between them."""
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
    # Colours extend to the edge of the hatched region.
    _, (rows, columns) = _nearest_outside(~np.isfinite(z))
    ax.contourf(x, y, z[rows, columns], bounds, cmap=pale, zorder=1)
    drawn = ax.contour(x, y, z, levels, colors="0.25", linewidths=1.0, zorder=2)
    for text, paths in zip(_told_apart(levels.tolist()), drawn.allsegs, strict=True):
        _label_path(labels, text, paths, color="0.1")


def _told_apart(levels: list[float]) -> list[str]:
    """Format levels, with as many digits as it takes to tell them apart."""
    texts: list[str] = []
    for digits in range(_DIGITS, 17):
        texts = [f"{level:.{digits}g}" for level in levels]
        if len({*texts}) == len(levels):
            break
    return texts


def _nearest_outside(region: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Compute distances (ny, nx) to the nearest grid points outside a region, and their indices."""
    from scipy.ndimage import distance_transform_edt

    distances, indices = distance_transform_edt(region, return_indices=True)
    return np.asarray(distances), np.asarray(indices)


def levels_of(known: np.ndarray) -> np.ndarray:
    """Choose round contour levels for the finite values `known`: at equal steps, or at powers of ten.

    If positive values span more than 1.5 decades, levels are at powers of ten, and at 2 and 5 times these if
    few powers are in the range.
    """
    from matplotlib.ticker import MaxNLocator

    # Contour levels disregard a few values that may lie far away from all others.
    low, high = np.quantile(known, (_RARE, 1 - _RARE)).tolist()
    if low > 0 and high > 10**_DECADES * low:
        decades = np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1)
        steps = (1.0, 2.0, 5.0) if len(decades) < _LEVELS else (1.0,)
        ticks = np.ravel([[step * 10.0**n for step in steps] for n in decades])
    else:
        ticks = MaxNLocator(_LEVELS, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
    return ticks[(ticks > known.min()) & (ticks < known.max())]


def _label_path(labels: PlacedLabels, text: str, paths: Sequence[np.ndarray], **style: Any) -> None:
    """Label the longest of several pieces of a contour line, near its middle if there is space."""
    points = np.asarray(max(paths, key=len, default=()))
    if points.size:  # beside a region without answers a line may have a piece without points
        from_middle = np.abs(np.arange(len(points)) - (len(points) - 1) / 2)
        labels.add(text, points[np.argsort(from_middle, kind="stable")], **style)


def _draw_meeting(
    ax: Axes, labels: PlacedLabels, x: np.ndarray, y: np.ndarray, distance: np.ndarray, name: str
) -> None:
    """Draw and name the line on which the difference `distance` (ny, nx) of result and comparison is zero."""
    known = distance[np.isfinite(distance)]
    if known.size and known.min() < 0 < known.max():
        drawn = ax.contour(x, y, distance, [0.0], colors=_MEETS, linestyles="--", linewidths=1.8, zorder=3)
        _label_path(labels, name, drawn.allsegs[0], color=_MEETS)


def _hatch(ax: Axes, x: np.ndarray, y: np.ndarray, lacking: np.ndarray) -> None:
    """Hatch the region without results, up to a smooth line between grid points with and without a result."""
    from scipy.ndimage import gaussian_filter

    share = gaussian_filter(lacking.astype(float), _SMOOTHED)
    side = np.where(lacking, np.maximum(share, 0.5 + _APART), np.minimum(share, 0.5 - _APART))
    drawn = ax.contourf(
        x, y, side, [0.5, 2.0], colors=_HATCHED["facecolor"], hatches=[_HATCHED["hatch"]], zorder=1.5
    )
    drawn.set(edgecolor=_HATCHED["edgecolor"], linewidth=0)


def _name_regions(
    labels: PlacedLabels, x: np.ndarray, y: np.ndarray, lacking: np.ndarray, why: np.ndarray
) -> None:
    """Write the reason at the centre of each region without results."""
    for name in np.unique(why[lacking]).tolist():
        region = lacking & (why == name)
        depth = _nearest_outside(np.pad(region, 1))[0][1:-1, 1:-1]
        deepest = np.argsort(-depth[region], kind="stable")
        rows, columns = (each[deepest] for each in np.nonzero(region))
        labels.add(name, np.stack([x[columns], y[rows]], axis=1), color="0.25", style="italic")


def _mark_present(ax: Axes, labels: PlacedLabels, x: float | None, y: float | None) -> None:
    """Mark the present design if its inputs lie within the axes."""
    if x is None or y is None:
        return
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    if left <= x <= right and bottom <= y <= top:
        ax.plot(x, y, "o", color="black", markerfacecolor="white", markersize=7, zorder=7, clip_on=False)
        labels.add("present design", np.array([[x, y]]), beside=True)


# Over one input --------------------------------------------------------------------------------------


def _draw_curve(ax: Axes, inputs: Sequence[MapInput], answer: MapAnswer) -> None:
    """Draw a result over one input as a curve; intervals without a result are hatched."""
    given = inputs[0]
    order = np.argsort(given.values, kind="stable")
    x, y, why = (
        given.values[order],
        np.where(np.isfinite(answer.value), answer.value, np.nan)[order],
        answer.reason[order],
    )
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
    for name, other in answer.meets.items():
        line = other[order]
        ax.plot(x, line, color=_MEETS, linewidth=1.2, linestyle="--", scalex=False, scaley=False)
        inside = (line > ends[0]) & (line < ends[1])
        if inside.any():
            labels.add(name, np.stack([x, line], axis=1)[inside][::-1], color=_MEETS)


def _hatch_spans(ax: Axes, labels: PlacedLabels, x: np.ndarray, y: np.ndarray, why: np.ndarray) -> None:
    """Hatch the intervals in which a curve has no value, and write the reason there."""
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
