"""Write drawings as SVG without scripts; colours follow the reader's choice of a light or dark theme."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape
from typing import Any
from zlib import crc32

import numpy as np

from beamdyn.common.drawing import strokes
from beamdyn.common.drawing.layout import Fit, Layout, Paper, Rows, lay_out
from beamdyn.common.drawing.text_width import FAMILY, SUBSCRIPT, line_width, symbol_width

_DARK = "@media (prefers-color-scheme: dark)"


def svg_of(rows: Rows, paper: Paper | None = None) -> str:
    """Return drawings as the text of an SVG file; colours follow the reader's light or dark theme.

    Parameters
    ----------
    rows : sequence of sequences of Drawing
        Rows of drawings; those of a row are side by side.
    paper : Paper, optional
        Size of the picture; if not given, it is chosen from the proportions of the drawings.

    Returns
    -------
    str
        The text, which begins with an XML declaration.  Its root element has role, title and description, and
        an id computed from the content; points that the user can drag have ids, too.
    """
    paper = paper or Paper.of(rows)
    return as_file(element(lay_out(rows, paper), paper))


def as_file(made: str) -> str:
    """Return the text of an SVG file from an SVG element, with the colours that the element uses."""
    style = f"<style>{page_colours('.machine')}{_DARK}{{{page_colours('.machine', dark=True)}}}</style>"
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{made.replace("<desc", f"{style}<desc", 1)}\n'


def element(layouts: Sequence[Layout], paper: Paper) -> str:
    """Return layouts as an SVG element that uses the colours of the web page: see `page_colours`."""
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
        f'<rect width="100%" height="100%" fill="{_paint(strokes.GROUND)}"/>{body}{grips}</svg>'
    )


def _grip(name: str, point: str, at: Any, fit: Fit) -> str:
    """Return an invisible SVG circle around a point that the user can drag."""
    x, y = fit.to_paper(at)
    known = f"{name}-{'-'.join(point.split())}"
    return f'<circle id="{escape(known)}" class="grip" cx="{x:.4f}" cy="{y:.4f}" r="7" fill="none"/>'


def page_colours(selector: str, dark: bool = False) -> str:
    """Return CSS rules that set the colours of all drawings below a CSS selector.

    The colours are those for a light background, or for a `dark` one.
    """
    inks = strokes.INKS.items()
    values = [(role, (i.dark_line, i.dark_area) if dark else (i.line, i.area)) for role, i in inks]
    variables = "".join(f"--{role}:{line};--{role}-area:{area};" for role, (line, area) in values)
    return f"{selector}{{{variables}}}"


def _paint(name: str) -> str:
    """Return a colour as a CSS variable, with the colour for light background as default."""
    return f"var(--{name},{strokes.colour(name)})"


def _parts(layout: Layout) -> Iterator[str]:
    left, top, right, bottom = layout.frame
    clip = f"c{crc32(repr((layout.frame, layout.fit)).encode()):08x}"
    yield (
        f'<clipPath id="{clip}"><rect x="{left:g}" y="{top:g}" width="{right - left:g}" '
        f'height="{bottom - top:g}"/></clipPath><g clip-path="url(#{clip})">'
    )
    yield from map(_stroke, strokes.strokes_of(layout))
    yield (
        f'</g><g stroke="{_paint(strokes.GROUND)}" stroke-width="{strokes.HALO}" stroke-linejoin="round" '
        'paint-order="stroke" xml:space="preserve">'
    )
    for text in layout.texts:
        yield from map(_letters, strokes.letters_of(text))
    yield "</g>"


def _stroke(stroke: strokes.Stroke) -> str:
    if isinstance(stroke, strokes.Circle):
        x, y = stroke.centre
        return f'<circle cx="{x:.2f}" cy="{y:.2f}" r="{stroke.radius:.2f}"{_pen(stroke.pen)}/>'
    end = "Z" if stroke.closed else ""
    way = "".join(f"M{_pairs(run)}{end}" for run in stroke.runs)
    return f'<path d="{way}"{_pen(stroke.pen)} stroke-linejoin="round"/>'


def _pen(pen: strokes.Pen) -> str:
    """Return the SVG attributes of a line and of its filled area."""
    opacity = f' fill-opacity="{pen.opacity}"' if pen.fill and pen.opacity < 1 else ""
    dash = f' stroke-dasharray="{" ".join(f"{d:g}" for d in pen.dash)}"' if pen.dash else ""
    line = f' stroke="{_paint(pen.line)}" stroke-width="{pen.width:g}"{dash}' if pen.line else ""
    return f' fill="{_paint(pen.fill) if pen.fill else "none"}"{opacity}{line}'


def _pairs(points: np.ndarray) -> str:
    return " ".join(f"{x:.2f},{y:.2f}" for x, y in points.tolist())


def _letters(line: strokes.Letters) -> str:
    """Return a line of text as SVG, stretched to its computed width, as the reader's font may differ."""
    symbol, words = line.symbol, line.words
    gap = " " if symbol and words else ""
    width = (symbol_width(symbol) + line_width(f"{gap}{words}")) * line.size
    return (
        f'<text x="{line.middle - width / 2:.2f}" y="{line.baseline:.2f}" font-size="{line.size:g}" '
        f'textLength="{width:.2f}" lengthAdjust="spacingAndGlyphs" fill="{_paint(line.colour)}">'
        f"{_symbol(symbol, line.size) if symbol else ''}{gap}{escape(words)}</text>"
    )


def _symbol(symbol: str, letters: float) -> str:
    letter, _, index = symbol.partition("_")
    drop, small = 0.2 * letters, SUBSCRIPT * letters
    back = f'<tspan dy="{-drop:g}">&#8203;</tspan>' if index else ""
    lowered = f'<tspan dy="{drop:g}" font-size="{small:g}">{escape(index)}</tspan>{back}' if index else ""
    return f'<tspan font-style="italic">{escape(letter)}</tspan>{lowered}'
