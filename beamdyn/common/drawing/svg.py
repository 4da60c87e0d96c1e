"""Drawings as SVG, without scripts; their colours follow the reader's preference for light or dark."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape
from typing import Any
from zlib import crc32

import numpy as np

from beamdyn.common.drawing.layout import Fit, Layout, Rule, Text
from beamdyn.common.drawing.shapes import Arrow, Disc, DrawnShape, Outline, Symbol
from beamdyn.common.drawing.sheet import Paper, Rows, lay_out
from beamdyn.common.drawing.style import AREA, INKS, PAPER, ink
from beamdyn.common.drawing.text_width import FAMILY, SUBSCRIPT, line_width, symbol_width

_HEAD, _HALF = 9.0, 3.3  # length and half width of an arrow's head [pt]
_DARK = "@media (prefers-color-scheme: dark)"
_HALO = 2.6  # width of the ground's colour around letters [pt]


def svg_of(rows: Rows, paper: Paper | None = None) -> str:
    """Drawings as the text of an SVG file, whose colours follow the reader's preference for light or dark.

    Parameters
    ----------
    rows : sequence of sequences of Drawing
        What stands beside one another, row by row.
    paper : Paper, optional
        Its size; by what is drawn if not given.

    Returns
    -------
    str
        It begins with an XML declaration.  Its root has role, title and description, and an id from its
        content; points that can be moved have ids, too.
    """
    paper = paper or Paper.of(rows)
    return as_file(element(lay_out(rows, paper), paper))


def as_file(made: str) -> str:
    """The text of a file with an SVG element, with colours of its own."""
    style = f"<style>{page_colours('.machine')}{_DARK}{{{page_colours('.machine', dark=True)}}}</style>"
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{made.replace("<desc", f"{style}<desc", 1)}\n'


def element(layouts: Sequence[Layout], paper: Paper) -> str:
    """Layouts as an SVG element, in colours of the page: see `page_colours`."""
    body = "".join(part for layout in layouts for part in _parts(layout))
    name = f"d{crc32(body.encode()):08x}"
    grips = "".join(_grip(name, *point, layouts[0].fit) for point in layouts[0].drawing.points.items())
    said = layouts[0].drawing
    title = said.title.replace("\n", "; ") or said.words or "Drawing"
    described = ". ".join(dict.fromkeys(filter(None, (layout.drawing.words for layout in layouts))))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" id="{name}" class="machine" role="img" '
        f'aria-labelledby="{name}-t {name}-d" viewBox="0 0 {paper.width:g} {paper.height:g}" '
        f'width="{paper.width:g}" height="{paper.height:g}" font-family="{escape(FAMILY)}">'
        f'<title id="{name}-t">{escape(title)}</title><desc id="{name}-d">{escape(described)}</desc>'
        f'<rect width="100%" height="100%" fill="{_paint("paper", "area")}"/>{body}{grips}</svg>'
    )


def _grip(name: str, point: str, at: Any, fit: Fit) -> str:
    """An invisible circle around a point that can be moved."""
    x, y = fit.to_paper(at)
    known = f"{name}-{'-'.join(point.split())}"
    return f'<circle id="{escape(known)}" class="grip" cx="{x:.4f}" cy="{y:.4f}" r="7" fill="none"/>'


def page_colours(selector: str, dark: bool = False) -> str:
    """Style rules that set the colours of the drawings in the elements of a CSS selector."""
    inks = {"paper": PAPER} | INKS
    values = [(role, (i.dark_line, i.dark_area) if dark else (i.line, i.area)) for role, i in inks.items()]
    variables = "".join(f"--{role}:{line};--{role}-area:{area};" for role, (line, area) in values)
    return f"{selector}{{{variables}}}"


def _paint(role: str, part: str = "line") -> str:
    """A role's colour, as a variable of the page or file; where that is not set, the one on light ground."""
    colours = PAPER if role == "paper" else ink(role)
    return f"var(--{role}{'-area' if part == 'area' else ''},{getattr(colours, part)})"


def _parts(layout: Layout) -> Iterator[str]:
    left, top, right, bottom = layout.frame
    clip = f"c{crc32(repr((layout.frame, layout.fit)).encode()):08x}"
    yield (
        f'<clipPath id="{clip}"><rect x="{left:g}" y="{top:g}" width="{right - left:g}" '
        f'height="{bottom - top:g}"/></clipPath><g clip-path="url(#{clip})">'
    )
    for shape in layout.drawing.shapes:
        yield _SHAPES[type(shape)](shape, layout.fit)
    yield "</g>"
    yield from map(_rule, layout.rules)
    yield (
        f'<g stroke="{_paint("paper", "area")}" stroke-width="{_HALO}" stroke-linejoin="round" '
        'paint-order="stroke" xml:space="preserve">'
    )
    for text in layout.texts:
        yield from _text(text)
    yield "</g>"


def _line(shape: Outline | Disc) -> str:
    """Attributes of a line and its area."""
    area = f'{_paint(shape.role, "area")}" fill-opacity="{AREA}' if shape.filled else "none"
    dash = f' stroke-dasharray="{" ".join(f"{d:g}" for d in shape.dash)}"' if shape.dash else ""
    stroke = f' stroke="{_paint(shape.role)}" stroke-width="{shape.width:g}"{dash}' if shape.width else ""
    return f' fill="{area}"{stroke}'


def _outline(shape: Outline, fit: Fit) -> str:
    points = fit.to_paper(shape.points)
    breaks = np.flatnonzero(~np.isfinite(points).all(axis=1))
    runs = [run[np.isfinite(run).all(axis=1)] for run in np.split(points, breaks)]
    end = "Z" if shape.closed else ""
    way = "".join(f"M{_pairs(run)}{end}" for run in runs if len(run))
    return f'<path d="{way}"{_line(shape)} stroke-linejoin="round"/>' if way else ""


def _disc(shape: Disc, fit: Fit) -> str:
    (x, y), r = fit.to_paper(shape.centre), shape.radius * fit.scale
    return f'<circle cx="{x:.2f}" cy="{y:.2f}" r="{r:.2f}"{_line(shape)}/>'


def _pairs(points: np.ndarray) -> str:
    return " ".join(f"{x:.2f},{y:.2f}" for x, y in points.tolist())


def _arrow(shape: Arrow, fit: Fit) -> str:
    (foot, tip), paint = fit.to_paper([shape.foot, shape.tip]), _paint(shape.role)
    length = float(np.hypot(*(tip - foot)))
    if not 0 < length < np.inf:
        return ""
    along = (tip - foot) / length
    head = min(_HEAD, 0.6 * length)
    start = foot + head * along if shape.both else foot
    heads = _arrowhead(tip, along, head) + (_arrowhead(foot, -along, head) if shape.both else "")
    shaft = f"M{_pairs(np.array([start, tip - 0.8 * head * along]))}"
    return (
        f'<path d="{shaft}" stroke="{paint}" stroke-width="{shape.width:g}"/>'
        f'<path d="{heads}" fill="{paint}"/>'
    )


def _arrowhead(tip: np.ndarray, along: np.ndarray, head: float) -> str:
    across = _HALF * head / _HEAD * np.array([-along[1], along[0]])
    return f"M{_pairs(np.array([tip, tip - head * along + across, tip - head * along - across]))}Z"


def _pin(s: Symbol, x: float, y: float) -> str:
    return (
        f'<circle cx="{x:.2f}" cy="{y:.2f}" r="{s.size / 2:g}" fill="{_paint(s.role, "area")}" '
        f'stroke="{_paint(s.role)}" stroke-width="1.2"/>'
    )


def _dot(s: Symbol, x: float, y: float) -> str:
    return f'<circle cx="{x:.2f}" cy="{y:.2f}" r="{s.size / 2:g}" fill="{_paint(s.role)}"/>'


def _ground(s: Symbol, x: float, y: float) -> str:
    w, h = s.size / 2, 0.85 * s.size
    return f'<path d="M{x:.2f},{y:.2f} l{w:g},{h:g} h{-2 * w:g} Z" fill="{_paint(s.role)}"/>'


def _cross(s: Symbol, x: float, y: float) -> str:
    r = s.size / 2
    way = f"M{x - r:.2f},{y:.2f} h{s.size:g} M{x:.2f},{y - r:.2f} v{s.size:g}"
    return f'<path d="{way}" stroke="{_paint(s.role)}" stroke-width="1.2"/>'


def _diamond(s: Symbol, x: float, y: float) -> str:
    r = s.size / 2
    way = f"M{x:.2f},{y - r:.2f} l{r:g},{r:g} l{-r:g},{r:g} l{-r:g},{-r:g} Z"
    return f'<path d="{way}" fill="{_paint(s.role)}" stroke="{_paint("paper", "area")}"/>'


_SYMBOLS: dict[str, Any] = {"pin": _pin, "dot": _dot, "ground": _ground, "cross": _cross, "diamond": _diamond}


def _draw_symbol(shape: Symbol, fit: Fit) -> str:
    return _SYMBOLS[shape.kind](shape, *fit.to_paper(shape.at))


_SHAPES: dict[type[DrawnShape], Any] = {Outline: _outline, Disc: _disc, Symbol: _draw_symbol, Arrow: _arrow}


def _rule(rule: Rule) -> str:
    return f'<path d="M{_pairs(rule.ends)}" stroke="{_paint(rule.role)}" stroke-width="{rule.width:g}"/>'


def _text(text: Text) -> Iterator[str]:
    """The lines of a text, each drawn as wide as it was measured, whatever font there is."""
    for i, (line, y) in enumerate(zip(text.lines, text.baselines, strict=True)):
        symbol = text.symbol if i == 0 else ""
        width = symbol_width(symbol) + line_width(f" {line}" if symbol and line else line)
        content = (_symbol(symbol, text.letters) + (" " if line else "") if symbol else "") + escape(line)
        if content:
            yield (
                f'<text x="{text.centre[0] - width * text.letters / 2:.2f}" y="{y:.2f}" '
                f'font-size="{text.letters:g}" textLength="{width * text.letters:.2f}" '
                f'lengthAdjust="spacingAndGlyphs" fill="{_paint(text.role)}">{content}</text>'
            )


def _symbol(symbol: str, letters: float) -> str:
    letter, _, index = symbol.partition("_")
    drop, small = 0.2 * letters, SUBSCRIPT * letters
    back = f'<tspan dy="{-drop:g}">&#8203;</tspan>' if index else ""
    lowered = f'<tspan dy="{drop:g}" font-size="{small:g}">{escape(index)}</tspan>{back}' if index else ""
    return f'<tspan font-style="italic">{escape(letter)}</tspan>{lowered}'
