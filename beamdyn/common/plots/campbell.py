"""Campbell diagrams from arrays: natural frequencies and excitation lines over speed, with crossings."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import isotonic_regression

from beamdyn.common.plots.axes_and_lines import MOTION_DASHES, draw_by_plane, set_up_axes, style_by_plane
from beamdyn.common.results.columns import DisplayUnits
from beamdyn.common.results.pictures import COLOURS, Axes

_MOST_ABOVE = 2.0  # highest frequency shown, as a multiple of the highest excitation frequency
_HEADROOM = 1.06  # height of the axes, as a multiple of the highest frequency shown
_MOST_HIDDEN = 2  # largest number of modes above the visible frequencies that the legend names
_APART = 0.042  # least distance of two labels, as a fraction of the axes' height
_LONGEST = 36  # characters of a legend entry, above which the legend has two columns
# Distance of two labels with the same text, as a fraction of the axes' height, below which one is omitted.
_SAME = 0.03
_GREY, _DARK = "0.45", "0.1"  # colours of the lines 1P, 2P, ... and of other excitation lines
_PER_REV = re.compile(r"\d+P")  # pattern of names such as 1P and 2P, multiples of the speed
_OPEN: dict[str, Any] = {"color": "black", "markerfacecolor": "white", "markersize": 6}
_MARKS: tuple[dict[str, Any], ...] = _OPEN | {"marker": "o"}, _OPEN | {"marker": "s"}
_INSIDE: tuple[dict[str, Any], ...] = (
    {"marker": "o", "color": "black", "markerfacecolor": "black", "markersize": 6},
    {"marker": "o", "color": "0.5", "markerfacecolor": "white", "markersize": 4.5},
)


@dataclass(frozen=True)
class Curves:
    """Natural frequencies of one scene (beam and its mount) over rotational speed.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Angular speeds [rad/s].
    frequency : ndarray, shape (S, m)
        Frequencies [Hz]; nan leaves a gap.
    names : tuple of str, length m
        Names of the modes.
    label : str
        Label of the scene in the legend.
    kinds : ndarray of int, shape (S, m), optional
        Index of the main motion of a mode at each speed, in `words` and in `axes_and_lines.MOTION_DASHES`.
    words : tuple of str
        The motions in words, for the legend: "flap", "edge", "torsion".
    """

    speeds: np.ndarray
    frequency: np.ndarray
    names: tuple[str, ...]
    label: str = ""
    kinds: np.ndarray | None = None
    words: tuple[str, ...] = ()


@dataclass(frozen=True)
class _CurveName:
    text: str
    y: float
    colour: str


def plot_campbell(
    scenes: Sequence[Curves],
    lines: Mapping[str, float],
    crossings: Mapping[str, Sequence[tuple[float, float]]],
    ax: Axes | None = None,
    unit: str = "rad/s",
    rated: float | None = None,
    operating: tuple[float, float] | None = None,
) -> Axes:
    """Draw natural frequencies, excitation lines and their crossings over speed: Campbell's diagram.

    Curves of modes and excitation lines have their names at the edge of the axes.  Modes far above all
    excitation lines are omitted.

    Parameters
    ----------
    scenes : sequence of Curves
        One scene, whose modes have different colours; or several scenes, one colour for each.
    lines : mapping of str to float
        Excitation lines: their frequencies as multiples of the speed.
    crossings : mapping of str to sequence of (float, float)
        Speed [rad/s] and natural frequency [Hz] of each crossing, by a text for the legend; crossings with
        different texts get different markers.
    ax : Axes, optional
        Axes to draw on; new axes if not given.
    unit : {"rad/s", "rpm", "deg/s"}
        Unit of the axis of speeds.
    rated : float, optional
        Rated speed [rad/s], marked by a line.
    operating : (float, float), optional
        Operating range [rad/s], which is shaded; the first entry of `crossings` must then contain the
        crossings within this range.

    Returns
    -------
    Axes
    """
    factor = DisplayUnits(unit).speed_unit().per_si
    ax = set_up_axes(ax, f"{'rotor speed' if unit == 'rpm' else 'angular speed'} [{unit}]", "frequency [Hz]")
    first, last = scenes[0].speeds[[0, -1]]
    fastest = max(lines.values(), default=0.0) * last / (2 * np.pi)
    top = top_of((of_mode for curves in scenes for of_mode in curves.frequency.T), fastest)
    ax.set(xlim=(factor * first, factor * last), ylim=(0, top))
    at_right, rows = _draw_lines(ax, factor, lines, np.array([first, last]), top)
    _name_at_right(ax, [*at_right, *_draw_modes(ax, factor, scenes, top)], top)
    if operating is not None:
        low, high = (factor * speed for speed in operating)
        text = f"operating range {low:.4g} to {high:.4g} {unit}"
        ax.axvspan(low, high, color="0.93", zorder=0, label=text)
    if rated is not None:
        text = f"rated speed {factor * rated:.4g} {unit}"
        ax.axvline(factor * rated, color="0.2", linewidth=1.1, linestyle=(0, (6, 3)), zorder=1.6, label=text)
    marks = _MARKS if operating is None else _INSIDE
    for mark, (kind, points) in zip(marks, crossings.items(), strict=False):
        if shown := [(factor * speed, frequency) for speed, frequency in points if frequency <= top]:
            ax.plot(*zip(*shown, strict=True), linestyle="none", label=kind, zorder=3, **mark)
    _name_hidden(ax, scenes, top)
    if len(scenes) == 1 and scenes[0].label:
        ax.set_title(scenes[0].label, fontsize=12, pad=6 + 12 * rows)
    handles, labels = ax.get_legend_handles_labels()
    if labels:  # the legend is placed below the axes, where it covers no curve
        columns = 3 if max(map(len, labels)) <= _LONGEST else 2
        from matplotlib.transforms import ScaledTranslation

        # The offset is in inches, to leave space for the label of the x axis.
        below = ax.transAxes + ScaledTranslation(0, -0.55, ax.figure.dpi_scale_trans)
        place: dict[str, Any] = {"loc": "upper center", "bbox_to_anchor": (0.5, 0), "bbox_transform": below}
        ax.legend(handles, labels, fontsize=9.5, ncols=columns, frameon=False, borderaxespad=0, **place)
    return ax


def top_of(frequencies: Iterable[np.ndarray], fastest: float) -> float:
    """Return the upper limit of the frequency axis [Hz], a little above the highest mode that is shown.

    Parameters
    ----------
    frequencies : iterable of ndarray
        The frequencies of each mode [Hz].
    fastest : float
        Highest excitation frequency [Hz]. Modes up to twice of it are shown, but at least the lowest mode; if
        it is 0, all modes.
    """
    highest = [float(np.nanmax(each)) for each in frequencies if np.isfinite(each).any()]
    near = [each for each in highest if not fastest or each <= _MOST_ABOVE * fastest]
    return _HEADROOM * max(near, default=min(highest, default=fastest)) or 1.0


def _draw_lines(
    ax: Axes, factor: float, lines: Mapping[str, float], ends: np.ndarray, top: float
) -> tuple[list[_CurveName], int]:
    """Draw the excitation lines, and label those that leave the axes through their upper edge.

    Return the labels for the right edge, and the number of rows of labels above the axes.  `factor` converts
    speeds from rad/s to the unit of the x axis; `ends` are the first and the last speed [rad/s].
    """
    at_right, above = [], []
    for name, multiple in lines.items():
        per_rev = _PER_REV.fullmatch(name)
        colour, dashes = (_GREY, "-") if per_rev else (_DARK, "-.")
        y = multiple * ends / (2 * np.pi)
        ax.plot(factor * ends, y, dashes, color=colour, linewidth=0.9 if per_rev else 1.2, zorder=1.5)
        if y[1] <= top:
            at_right.append(_CurveName(name, y[1], colour))
        else:
            above.append((name, colour, 2 * np.pi * top / multiple))
    right: list[float] = []  # right end of the last label in each row
    for name, colour, speed in sorted(above, key=lambda line: line[2]):
        half = 0.006 * (len(name) + 1) * (ends[1] - ends[0])
        row = next((r for r, end in enumerate(right) if speed - half > end), len(right))
        right[row : row + 1] = [speed + half]
        place = {"xytext": (0, 3 + 11 * row), "textcoords": "offset points", "ha": "center", "va": "bottom"}
        at = factor * speed, 1.0
        ax.annotate(name, at, xycoords=("data", "axes fraction"), fontsize=9, color=colour, **place)
    return at_right, len(right)


def _draw_modes(ax: Axes, factor: float, scenes: Sequence[Curves], top: float) -> Iterator[_CurveName]:
    """Draw the curves of the modes, and yield their labels for the right edge of the axes.

    A curve that ends before the right edge is labelled at its start.  `factor` converts speeds from rad/s to
    the unit of the x axis; `top` is the upper limit of the frequency axis [Hz].
    """
    for k, curves in enumerate(scenes):
        kinds = np.zeros(curves.frequency.shape, int) if curves.kinds is None else curves.kinds
        x = factor * curves.speeds
        for i, (y, motion, name) in enumerate(zip(curves.frequency.T, kinds.T, curves.names, strict=True)):
            style = style_by_plane(i if len(scenes) == 1 else k)
            draw_by_plane(ax, x, y, motion, style)
            if np.isfinite(y[-1]) and y[-1] <= top:
                # The main motion at the highest speed is named if it is another one than at the lowest.
                more = f" ({curves.words[motion[-1]]})" if motion[0] != motion[-1] else ""
                yield _CurveName(name + more, float(y[-1]), style["color"])
            elif (shown := np.flatnonzero(np.isfinite(y) & (y <= top))).size:
                place = {"xytext": (4, 3), "textcoords": "offset points", "color": style["color"]}
                from matplotlib.patheffects import withStroke

                halo = [withStroke(linewidth=3, foreground="white")]
                ax.annotate(name, (x[shown[0]], y[shown[0]]), fontsize=9, path_effects=halo, **place)
        if len(scenes) > 1:
            ax.plot([], [], color=COLOURS[k % len(COLOURS)], linewidth=3, label=curves.label)
    shown = {
        curves.words[kind]: kind
        for curves in scenes
        if curves.kinds is not None
        for kind in np.unique(curves.kinds[curves.frequency <= top])
    }
    for word, kind in shown.items():
        ax.plot([], [], linestyle=MOTION_DASHES[kind], color="0.3", linewidth=1.8, label=f"mostly {word}")


def _name_hidden(ax: Axes, scenes: Sequence[Curves], top: float) -> None:
    """Name modes above the visible range in the legend; for one scene, with their lowest frequency."""
    hidden = {
        name: np.nanmin(y)
        for curves in scenes
        for name, y in zip(curves.names, curves.frequency.T, strict=True)
        if np.isfinite(y).any() and np.nanmin(y) > top
    }
    if hidden:
        named = [f"{name} ({f:.4g} Hz)" if len(scenes) == 1 else name for name, f in hidden.items()]
        shown, more = named[:_MOST_HIDDEN], ", ..." * (len(named) > _MOST_HIDDEN)
        ax.plot([], [], " ", label=f"above: {', '.join(shown)}{more}")


def _name_at_right(ax: Axes, labels: Sequence[_CurveName], top: float) -> None:
    """Label curves beside their right ends; leader lines connect labels that were moved apart.

    Labels with the same text at curves that end close together are replaced by one grey label.
    """
    merged: list[_CurveName] = []
    for label in labels:
        same = [i for i, m in enumerate(merged) if m.text == label.text and abs(m.y - label.y) < _SAME * top]
        if same:
            merged[same[0]] = _CurveName(label.text, (merged[same[0]].y + label.y) / 2, "0.2")
        else:
            merged.append(label)
    merged.sort(key=lambda label: label.y)
    for label, height in zip(merged, _spread([label.y / top for label in merged]), strict=True):
        moved = abs(height - label.y / top) > 0.004
        leader = {"arrowstyle": "-", "color": label.colour, "linewidth": 0.6, "shrinkA": 0, "shrinkB": 0}
        ax.annotate(
            label.text, (1.0, label.y / top), xytext=(1.025, height), xycoords="axes fraction",
            textcoords="axes fraction", fontsize=9, color=label.colour, va="center",
            arrowprops=leader if moved else None, annotation_clip=False,
        )  # fmt: skip


def _spread(heights: Sequence[float]) -> list[float]:
    """Move ascending heights of labels as little as possible, so that the labels do not overlap.

    Subtract from each height its index times the least distance: these values must not descend.  The closest
    non-descending values are those of isotonic regression.
    """
    least = _APART * np.arange(len(heights))
    return (isotonic_regression(np.asarray(heights) - least).x + least).tolist()
