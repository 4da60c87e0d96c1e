"""Options of the chart component of the page: hover text, zoom, and saving as a picture."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import count
from typing import Any

import numpy as np

from beamdyn.common.drawing.shapes import Chart, ChartAxis, ChartCurve
from beamdyn.common.drawing.strokes import INKS

_DIGITS = 5  # significant digits of values, and of x positions relative to the range of x
_MOST_DIGITS = 10  # most digits of the values of a curve that varies little
_WIDE = 0.15  # fraction of the axis below which a band is too narrow for its text
# Colours of curves, used in turn.
_COLOURS = ("normal", "friction", "reaction", "chart-4", "chart-5", "chart-6")
# Colours used by charts but not by drawings: on a light background, and on a dark one.
_MORE = {"chart-4": "#a3527f", "chart-5": "#806000", "chart-6": "#6a35c9"}
_MORE_DARK = {"chart-4": "#e59ac2", "chart-5": "#f5d76e", "chart-6": "#a98bff"}
# Pairs (a, b) by which the chart component rounds tick steps: a step of s times a power of ten, 1 <= s < 10,
# becomes a times this power, for the first pair with s < b.
_STEPS = ((1, 1.5), (2, 2.5), (3, 4.0), (5, 7.0), (10, math.inf))
_POWERS = "(x) => (x >= 1e-3 && x < 1e5) ? String(x) : x.toExponential(0).replace('+', '')"
_FEW = 8  # largest number of decades of an axis for which minor ticks are drawn
_NAMED, _PALE = 12, 11  # font sizes of names and of numbers [px]
_WIDE_CHART = 700  # least width of a wide chart [px]
# Characters in a row of the legend, for a narrow chart and for a wide chart.
_LETTERS, _LETTERS_WIDE = 52, 100
_SAVE_SIGN = "path://M4.7,22.9L29.3,45.5L54.7,23.4M4.6,43.6L4.6,58L53.8,58L53.8,43.6M29.2,45.1L29.2,0"
_DASHES = ("dashed", "dotted", [10, 3, 2, 3], [2, 6])  # dash patterns of a compared design's curves


def thinned(x: np.ndarray, y: np.ndarray, most: int) -> tuple[np.ndarray, np.ndarray]:
    """Reduce a curve to at most `most` points without losing its end points and local extremes.

    Parameters
    ----------
    x, y : ndarray, shape (n,)
        Points of the curve, with ascending x.
    most : int
        Largest number of points to keep.
    """
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if len(x) <= most:
        return x, y
    width = -(-len(x) // (most // 2 - 1))
    parts = np.pad(np.where(np.isfinite(y), y, np.nan), (0, -len(x) % width), constant_values=np.nan)
    parts = parts.reshape(-1, width)
    first = width * np.arange(len(parts))
    low = first + np.where(np.isnan(parts), np.inf, parts).argmin(axis=1)
    high = first + np.where(np.isnan(parts), -np.inf, parts).argmax(axis=1)
    kept = np.unique([0, *low, *high, len(x) - 1])
    return x[kept], y[kept]


def chart_colours(selector: str, dark: bool = False) -> str:
    """Return CSS rules that set those colours of charts that drawings do not use.

    The rules are for the elements of a CSS `selector`, on a light or a `dark` background.
    """
    values = _MORE_DARK if dark else _MORE
    return f"{selector}{{{''.join(f'--{role}:{colour};' for role, colour in values.items())}}}"


def options_of(chart: Chart) -> dict[str, Any]:
    """Make the options of the chart component that show a chart.

    Colours follow the theme of the page.  Texts are never interpreted as HTML or as scripts.
    """
    # Number of characters in the legend.
    needed = sum(len(each.name) + 8 for each in (*chart.curves, *chart.points))
    narrow, wide = (
        {"bottom": 50 + 18 * min(math.ceil(needed / letters), 6)} for letters in (_LETTERS, _LETTERS_WIDE)
    )
    no_dot = {"itemStyle": {"opacity": 0}}  # hides dots in the legend unless the curve has markers
    lines = ({"name": curve.name} | ({} if curve.points else no_dot) for curve in chart.curves)
    return {
        "animation": False,
        "textStyle": {"color": _paint("text"), "fontFamily": "inherit"},
        "grid": {"left": 64, "right": 28, "top": 58} | narrow,
        "media": [
            {"query": {"minWidth": _WIDE_CHART}, "option": {"grid": wide}},
            {"option": {"grid": narrow}},
        ],
        "legend": {
            "bottom": 0,
            "itemWidth": 30,
            "itemHeight": 10,
            "textStyle": _letters(_NAMED),
            "inactiveColor": _paint("ghost"),
            "data": [*lines, *({"name": each.name} for each in chart.points)],
        },
        "tooltip": {  # values of all curves at the pointer's x; if x is logarithmic, of one point
            "trigger": "item" if chart.x.logarithmic else "axis",
            "renderMode": "richText",  # texts are not interpreted as HTML, so that names appear as they are
            "confine": True,
            "order": "seriesDesc",
            "textStyle": _letters(_NAMED),
            "backgroundColor": _paint("paper", area=True),
            "borderColor": _paint("axis"),
        },
        "toolbox": _toolbox(chart.title),
        "dataZoom": [
            {
                "type": "inside",
                "zoomOnMouseWheel": "ctrl",
                "moveOnMouseMove": "ctrl",
                "moveOnMouseWheel": False,
                "preventDefaultMouseMove": False,
                "filterMode": "none",
            }
        ],
        "xAxis": _axis(chart.x, [curve.x for curve in chart.curves], False) | _pointed(chart),
        "yAxis": _axis(chart.y, [curve.y for curve in chart.curves], True),
        "series": [*_series(chart)],
    }


def _paint(role: str, area: bool = False) -> str:
    """Return a colour role as a CSS variable of the page; its default for other pages is the light colour."""
    if role in _MORE:
        return f"var(--{role},{_MORE[role]})"
    ink = INKS[role]
    return f"var(--{role}{'-area' if area else ''},{ink.area if area else ink.line})"


def _letters(size: int) -> dict[str, Any]:
    """Return the style of text with a given font size [px]."""
    return {"color": _paint("text"), "fontSize": size}


# Axes, legend and tools -------------------------------------------------------------------------------


def _axis(axis: ChartAxis, values: Sequence[Any], upright: bool) -> dict[str, Any]:
    """Make the options of an axis; the y axis is `upright`.

    A logarithmic axis, whose limits follow from the `values` on it if none are given, has labels at powers of
    ten unless they overlap.
    """
    line = {"lineStyle": {"color": _paint("axis")}}
    label: dict[str, Any] = _letters(_PALE) | {"hideOverlap": True}
    tick: dict[str, Any] = {"show": True} | line
    if axis.logarithmic:
        low, high = _decades(axis, values)
        powers = [10.0**n for n in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)]
        label |= {":formatter": _POWERS, "customValues": powers}
        tick["customValues"] = powers
        minor = len(powers) < _FEW
    else:
        low, high, minor = axis.low, axis.high, False
        label["showMaxLabel"] = low is None or high is None or _is_tick(low, high)
    aside = {"align": "left", "padding": [0, 0, 0, -56]} if upright else {}
    return {
        "type": "log" if axis.logarithmic else "value",
        "name": axis.title,
        "nameLocation": "end" if upright else "middle",
        "nameGap": 12 if upright else 28,
        "nameTextStyle": _letters(_NAMED) | aside,
        "axisLabel": label,
        "axisLine": {"show": True, "onZero": False} | line,
        "axisTick": tick,
        "splitLine": {"show": True, "lineStyle": {"color": _paint("ghost"), "width": 0.6}},
        "minorTick": {"show": minor},
        "scale": upright,
        "min": low,
        "max": high,
    }


def _pointed(chart: Chart) -> dict[str, Any]:
    """Make the options of the line at the pointer, and of the text there with quantities and units."""
    heading = f"{chart.x.name} {{value}} {chart.x.unit}".rstrip() + f"\n{chart.y.title}"
    line = {"color": _paint("axis")}
    return {"axisPointer": {"label": {"show": False, "formatter": heading}, "lineStyle": line}}


def _is_tick(low: float, high: float) -> bool:
    """Return whether the upper limit of an axis is a multiple of the component's tick step."""
    step = (high - low) / 5
    if not step > 0:
        return True
    power = 10.0 ** math.floor(math.log10(step))
    part = high / power / next(nice for nice, below in _STEPS if step / power < below)
    return bool(abs(part - round(part)) < 1e-6)


def _decades(axis: ChartAxis, values: Sequence[Any]) -> tuple[float, float]:
    """Return the limits of a logarithmic axis: the given ones, else whole decades around the values."""
    known = np.concatenate([np.asarray(each, dtype=float).ravel() for each in values] or [np.empty(0)])
    known = np.log10(known[np.isfinite(known) & (known > 0)])
    known = known if len(known) else np.zeros(1)
    low = axis.low or 10.0 ** math.floor(known.min())
    high = axis.high or 10.0 ** math.ceil(known.max())
    return low, max(high, 10 * low)


def _toolbox(title: str) -> dict[str, Any]:
    """Make the buttons above a chart: zoom, reset, and saving as a file named after the title."""
    name = "-".join("".join(c if c.isalnum() else " " for c in title.lower()).split())
    return {
        "show": True,
        "right": 12,
        "top": 0,
        "iconStyle": {"borderColor": _paint("dimension")},
        "emphasis": {"iconStyle": {"borderColor": _paint("normal"), "textFill": _paint("text")}},
        "feature": {
            "dataZoom": {"title": {"zoom": "zoom: draw a box", "back": "zoom back"}, "filterMode": "none"},
            "restore": {"title": "all of it"},
            "mySave": {"title": "save as picture", "name": name or "chart", "icon": _SAVE_SIGN},
        },
    }


# Curves, points and marks -----------------------------------------------------------------------------


def _series(chart: Chart) -> Iterator[dict[str, Any]]:
    """Yield the series of a chart: the data of curves, points, marks and bands.

    Marks, bands and cursor are in the first series, so that a moving cursor changes only this series.
    """
    yield marks_of(chart)
    dashes = count()
    for i, (curve, role) in enumerate(zip(chart.curves, _roles(chart), strict=True)):
        dashed = curve.dashed or i >= len(_COLOURS)
        kind = _DASHES[next(dashes) % len(_DASHES) if curve.pale else 0] if dashed else "solid"
        width = 1.2 if curve.pale else 2
        yield _line(curve) | {
            "id": f"curve {i}",
            "itemStyle": {"color": _paint(role)},
            "lineStyle": {"color": _paint(role), "width": width, "type": kind},
        }
    for each in chart.points:
        known = [(x, y, words) for x, y, words in each.at if math.isfinite(x) and math.isfinite(y)]
        ring = {"color": _paint("paper", area=True), "borderColor": _paint(each.role), "borderWidth": 1.8}
        yield {
            "id": f"points {each.name}",
            "name": each.name,
            "type": "scatter",
            "data": [{"value": [_place(x), _short(y)], "name": words} for x, y, words in known],
            "symbolSize": 9,
            "z": 5,
            "itemStyle": ring,
            "tooltip": {"trigger": "item", "formatter": "{b}"},
            "emphasis": {"disabled": True},
        }


def _roles(chart: Chart) -> list[str]:
    """Return the colour role of each curve of a chart."""
    return ["ground" if n is None else _COLOURS[n % len(_COLOURS)] for n in chart.colour_numbers]


def _line(curve: ChartCurve) -> dict[str, Any]:
    """Make the series of a curve with as many points as can be seen; an isolated point is a dot."""
    x, y = thinned(curve.x, curve.y, curve.most)
    known = np.pad(np.isfinite(y), 1)
    alone = known[1:-1] & ~known[:-2] & ~known[2:]
    span = float(np.ptp(x)) if len(x) else 0.0
    decimals = _DIGITS - math.floor(math.log10(span)) if span > 0 else 12
    digits = _digits(y[np.isfinite(y)])
    data: list[Any] = []
    for a, b, dot in zip(x.tolist(), y.tolist(), alone.tolist(), strict=True):
        pair = [round(a, decimals), _short(b, digits) if math.isfinite(b) else None]
        data.append({"value": pair, "symbol": "circle"} if dot else pair)
    dotted = curve.points or bool(alone.any())
    return {
        "name": curve.name,
        "type": "line",
        "data": data,
        "showSymbol": dotted,
        "symbol": "circle" if curve.points or not dotted else "none",
        "symbolSize": 5,
        "emphasis": {"disabled": True},
    }


def marks_of(chart: Chart) -> dict[str, Any]:
    """Make the series of marks, bands and cursor; it always exists, so that a moved cursor can replace it.

    Marks are vertical lines; a mark that belongs to a curve has the colour of this curve.
    """
    role_of = {curve.name: _paint(role) for curve, role in zip(chart.curves, _roles(chart), strict=True)}
    marks: list[dict[str, Any]] = []
    for mark in chart.marks:
        if math.isfinite(mark.at):
            place = {"position": "insideStartTop"} if mark.at_foot else {}
            colour = {"color": role_of[mark.curve]} if mark.curve in role_of else {}
            line = {"lineStyle": colour} if colour else {}
            label = {"formatter": "{b}"} | place | colour
            marks.append({"xAxis": _place(mark.at), "name": mark.text, "label": label} | line)
    if chart.cursor is not None and math.isfinite(chart.cursor):
        now = {"color": _paint("friction"), "width": 2, "type": "solid"}
        marks.append({"xAxis": _place(chart.cursor), "lineStyle": now, "label": {"show": False}})
    around = {"textBorderColor": _paint("paper", area=True), "textBorderWidth": 3}
    return {
        "id": "marks",
        "name": "marks",
        "type": "line",
        "data": [],
        "silent": True,
        "tooltip": {"show": False},
        "markLine": {
            "symbol": "none",
            "animation": False,
            "lineStyle": {"color": _paint("dimension"), "type": "dashed", "width": 1.2},
            "label": _letters(_PALE) | {"position": "insideEndTop"} | around,
            "data": marks,
        },
        "markArea": {
            "itemStyle": {"color": _paint("ground", area=True), "opacity": 0.16},
            "label": _letters(_PALE) | {"position": "insideBottom", "overflow": "break"},
            "data": [*_bands(chart)],
        },
    }


def _bands(chart: Chart) -> Iterator[list[dict[str, Any]]]:
    """Yield the ends of each band, with its text if the band is wide enough."""
    ends = [end for end in (chart.x.low, chart.x.high) if end is not None]
    ends += [float(x) for curve in chart.curves for x in np.asarray(curve.x)[[0, -1]]]
    least = _WIDE * (max(ends, default=0.0) - min(ends, default=0.0))
    for band in chart.bands:
        text = band.text if band.high - band.low > least else ""
        yield [{"xAxis": _place(band.low), "name": text}, {"xAxis": _place(band.high)}]


def _digits(y: np.ndarray) -> int:
    """Return the digits to show for a curve's values: more if they vary little, but no rounding errors."""
    span, largest = (float(np.ptp(y)), float(np.abs(y).max())) if len(y) else (0.0, 0.0)
    more = math.ceil(math.log10(largest / span)) - 1 if span > 0 else 0
    return min(_DIGITS + max(more, 0), _MOST_DIGITS)


def _place(value: float) -> float:
    """Round a position on the x axis to a precision that suffices even after zooming in."""
    return float(f"{value:.{2 * _DIGITS}g}")


def _short(value: float, digits: int = _DIGITS) -> float:
    """Round a number to the number of digits that is shown."""
    return float(f"{value:.{digits}g}")
