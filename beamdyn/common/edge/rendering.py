"""Conversion of figures to SVG and PNG, of tables to HTML, and of rows to CSV, as text or bytes."""

from __future__ import annotations

import base64
import csv
import io
import re
import warnings
from collections.abc import Callable, Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from rich.console import Group
from rich.table import Table
from rich.text import Text

from beamdyn.common.inputs.checks import reason_of

_T = TypeVar("_T")
_RAISED = str.maketrans("-0123456789", "\u207b\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079")
_SENTENCE = 36  # number of characters above which the text of a table cell is styled as a sentence
# Characters in a row above which a table takes the full width of a page, and of a wide screen.
_WIDE, _WIDEST = 75, 112
_LONG = 12  # number of rows from which a table continues in a second column where there is room
_BROAD = 2.0  # ratio of width to height of a picture above which it takes the whole width of a page
_BAR = "\u2588"  # letter of which a bar in a cell consists
_BETWEEN = 1.5  # width of the gap between two columns, in letters

_FEW_DECADES = 1e2  # ratio of the limits of a logarithmic axis above which minor ticks can be omitted
_MOST_KEPT = 50  # largest number of pictures whose axes' positions, or frames, are stored
_PLACES: dict[tuple[object, ...], list[Bbox]] = {}  # positions of axes, by size and labels of their picture
# SVG, without its end tag, of frames (see `svg_in_haste`) that were drawn twice; "" for those drawn once.
_FRAMES: dict[tuple[object, ...], str] = {}
_START = re.compile(r"<svg[^>]*>")  # tag before the elements of an SVG

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.transforms import Bbox
    from rich.console import RenderableType


def svg(figure: Figure) -> str:
    """Return a figure as the text of an SVG file; equal figures give equal texts."""
    return png(figure, "svg").decode()


def png(figure: Figure, kind: str = "png") -> bytes:
    """Return a figure as the bytes of a PNG file, or of another format."""
    from matplotlib import rc_context

    file = io.BytesIO()
    _write_powers_plainly(figure)
    metadata = {"Date": None} if kind == "svg" else {}
    with rc_context({"svg.hashsalt": "beamdyn"}), np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # layout engines warn if the figure has too little space
        figure.savefig(file, format=kind, dpi=150, metadata=metadata)
    return file.getvalue()


def _write_powers_plainly(figure: Figure) -> None:
    """Write powers of ten at logarithmic axes as plain text: typesetting would take a third of the time."""
    from matplotlib.ticker import LogFormatterSciNotation

    class Powers(LogFormatterSciNotation):
        def __call__(self, x: float, pos: int | None = None) -> str:
            return _POWER.sub(_in_letters, super().__call__(x, pos))

    for axis in (axis for ax in figure.axes for axis in (ax.xaxis, ax.yaxis)):
        if isinstance(axis.get_major_formatter(), LogFormatterSciNotation):
            axis.set_major_formatter(Powers())
        if isinstance(axis.get_minor_formatter(), LogFormatterSciNotation):
            axis.set_minor_formatter(Powers())


def in_haste(figure: Figure) -> Figure:
    """Prepare a figure for fast drawing: reuse the positions of axes, and omit most minor ticks.

    The axes get the positions that they had in the last picture with the same labels and size.  Logarithmic
    axes over more than two decades have no minor ticks.
    """
    for axis in (axis for ax in figure.axes for axis in (ax.xaxis, ax.yaxis)):
        low, high = axis.get_view_interval()
        if axis.get_scale() == "log" and high > _FEW_DECADES * low:
            axis.minorticks_off()
    labels = tuple((ax.get_xlabel(), ax.get_ylabel(), ax.get_title()) for ax in figure.axes)
    places = _kept(_PLACES, (*figure.get_size_inches(), *labels), lambda: _laid_out(figure))
    figure.set_layout_engine(None)  # matplotlib's default: no layout engine
    for ax, place in zip(figure.axes, places, strict=True):
        ax.set_position(place, which="original")
    return figure


def _kept(store: dict[tuple[object, ...], _T], known: tuple[object, ...], make: Callable[[], _T]) -> _T:
    """Return what `store` has under the key `known`; if nothing, store what `make` returns, and return it."""
    if known not in store:
        if len(store) >= _MOST_KEPT:
            store.clear()
        store[known] = make()
    return store[known]


def _laid_out(figure: Figure) -> list[Bbox]:
    """Lay out a figure, and return the positions of its axes."""
    figure.draw_without_rendering()
    return [ax.get_position(original=True).frozen() for ax in figure.axes]


def svg_in_haste(figure: Figure) -> str:
    """Return a figure as SVG, drawn fast: prepared by `in_haste`, with the frames of earlier pictures.

    The frame of axes is what lies below their curves: background, ticks, grid and labels.  Drawing it takes
    half of the time of a picture, and it often stays the same while an input varies.  The frames of axes that
    matplotlib places beside others, such as a colour bar, are not reused.
    """
    in_haste(figure)
    framed = [ax for ax in figure.axes if ax.axison and ax.get_axes_locator() is None]
    frames = [figure.patch, *(part for ax in framed for part in (ax.patch, ax.xaxis, ax.yaxis))]
    known = (*figure.get_size_inches(), *map(_shown, framed))
    if known not in _FRAMES:  # frames that change with each picture are not drawn separately
        _kept(_FRAMES, known, str)
        return svg(figure)
    _FRAMES[known] = start = _FRAMES[known] or _only(figure, frames)
    for part in frames:
        part.set_visible(False)
    return start + _START.split(svg(figure), maxsplit=1)[1]


def _shown(ax: Axes) -> tuple[object, ...]:
    """Return the position, limits, texts and style of axes, which determine their frame."""
    shown = [*ax.get_position().bounds, *ax.get_facecolor()]
    for axis in (ax.xaxis, ax.yaxis):
        shown.append(str(axis.get_tick_params()))
        ticks = axis.get_majorticklocs().tolist()
        shown += [axis.get_label_text(), axis.get_scale(), *axis.get_view_interval(), *ticks]
        shown += axis.get_major_formatter().format_ticks(ticks)
    return tuple(shown)


def _only(figure: Figure, parts: Sequence[Artist]) -> str:
    """Return some parts of a figure and of its axes as SVG, without the end tag of the SVG."""
    kept = {*parts, *figure.axes}
    found = (part for whole in (figure, *figure.axes) for part in whole.get_children())
    others = [part for part in found if part not in kept and part.get_visible()]
    for part in others:
        part.set_visible(False)
    made = svg(figure)
    for part in others:
        part.set_visible(True)
    return made.rpartition("</svg>")[0]


_POWER = re.compile(r"\$\\mathdefault\{(.*?)10\^\{(-?\d+)\}\}\$")


def _in_letters(power: re.Match[str]) -> str:
    factor = power[1].replace(r"\times", "\u00d7")
    return f"{factor}10{power[2].translate(_RAISED)}"


def drawing(draw: Callable[[], Figure], write: Callable[[Figure], str] = svg) -> str:
    """Return the SVG of a figure; or a sentence if numbers are too large to be drawn.

    Parameters
    ----------
    draw : callable
        Draws the figure.
    write : callable
        Function that returns the figure as SVG, such as `svg_in_haste`.
    """
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)
            return write(draw())
    except (ValueError, ArithmeticError) as error:
        return f"There is no drawing: {reason_of(error)}"


def picture(text: str, words: str) -> str:
    """Return an SVG as an HTML image, which runs no scripts; a sentence in place of an SVG as a paragraph.

    Parameters
    ----------
    text : str
        The SVG.
    words : str
        Description for screen readers.
    """
    if not text.startswith("<?xml"):
        return f"<p>{escape(text)}</p>"
    size = re.search(r'viewBox="0 0 ([\d.]+) ([\d.]+)"', text)
    broad = " broad" if size and float(size[1]) > _BROAD * float(size[2]) else ""
    return f'<img class="drawing{broad}" alt="{escape(words)}" src="{data_url(text)}">'


def data_url(text: str) -> str:
    """Return the text of an SVG file as a data URL, which embeds the image in a page."""
    return f"data:image/svg+xml;base64,{base64.b64encode(text.encode()).decode()}"


def html(parts: Iterable[RenderableType], most: int | None = None) -> str:
    """Return tables and sentences of a command as HTML.

    Each table with its title and notes is an HTML section.  Of a table with more than `most` rows, only the
    first and the last rows are shown, with the number of omitted rows.
    """
    made = []
    for part in parts:
        if isinstance(part, Group) and sum(isinstance(each, Group) for each in part.renderables) > 1:
            made.append(html(part.renderables, most))
        elif isinstance(part, Group):
            made.append(f'<section class="{_size(part)}">{html(part.renderables, most)}</section>')
        elif isinstance(part, Table):
            made.append(_table(part, most))
        elif isinstance(part, Text) and part.style == "bold":
            made.append(f"<h3>{escape(part.plain)}</h3>")
        else:
            made.append(f"<p>{escape(str(part))}</p>" if str(part) else "")
    return "\n".join(made)


def _size(part: Group) -> str:
    """Return the CSS classes for the largest table of a group, such as "wide long"."""
    letters, rows = _width(part), _rows(part)
    sizes = {"wide": letters > _WIDE, "widest": letters > _WIDEST, "long": rows >= _LONG}
    return " ".join(name for name, applies in sizes.items() if applies)


def _rows(part: object) -> int:
    """Return the number of rows of a table, or of the longest table of a group; 0 for other objects."""
    if isinstance(part, Group):
        return max(map(_rows, part.renderables), default=0)
    return part.row_count if isinstance(part, Table) else 0


def _width(part: object) -> float:
    """Return the width in letters of a table, or of the widest table of a group; 0 for other objects.

    Headings count as broken into one line for each word.
    """
    if isinstance(part, Group):
        return max(map(_width, part.renderables), default=0.0)
    columns = part.columns if isinstance(part, Table) else ()
    letters = sum(
        max(map(len, (*str(each.header).split(), *map(str, each.cells))), default=0) for each in columns
    )
    return letters + _BETWEEN * len(columns)


def _table(made: Table, most: int | None) -> str:
    """Return a table as HTML; of too many rows, the first and last ones, with the number of omitted rows."""
    words = [column.justify == "left" for column in made.columns]
    cells = zip(*(column.cells for column in made.columns), strict=True)
    rows = [_row([_cell(cell) for cell in row], words, "td") for row in cells]
    head = _row([escape(str(column.header)) for column in made.columns], words, "th")
    if most is not None and len(rows) > most:
        said = f"... {len(rows) - most} of {len(rows)} rows are not shown"
        between = f'<tr><td class="words" colspan="{len(words)}">{said}</td></tr>'
        tail = most // 2
        rows = [*rows[: most - tail], between, *rows[-tail:]]
    return (
        f'<div class="scrolls" tabindex="0"><table><thead>{head}</thead>'
        f"<tbody>{''.join(rows)}</tbody></table></div>"
    )


def _cell(cell: object) -> str:
    """Return a table cell as HTML; digits of a number that are smaller than its error are dimmed."""
    if not isinstance(cell, Text) or not cell.spans:
        return escape(str(cell))
    start = cell.spans[0].start
    return f'{escape(cell.plain[:start])}<span class="beyond">{escape(cell.plain[start:])}</span>'


def _row(cells: Sequence[str], words: Sequence[bool], tag: str) -> str:
    """Write a table row in HTML, with cells of the `tag` td or th.

    `words` says which cells hold words: long ones may wrap.  Other cells hold numbers.
    """

    def kind(cell: str) -> str:
        return "words sentence" if len(cell) > _SENTENCE else "words bar" if cell[:1] == _BAR else "words"

    kinds = (kind(cell) if w else "number" for cell, w in zip(cells, words, strict=True))
    made = (f'<{tag} class="{kind}">{cell}</{tag}>' for cell, kind in zip(cells, kinds, strict=True))
    return f"<tr>{''.join(made)}</tr>"


def csv_text(rows: Iterable[Sequence[object]], delimiter: str = ",") -> str:
    """Return rows as the text of a CSV file."""
    file = io.StringIO()
    csv.writer(file, delimiter=delimiter, lineterminator="\n").writerows(rows)
    return file.getvalue()


STYLE = """
.drawing { width: 100%; height: auto; background: white; }
.scrolls { overflow-x: auto; }
.shown h3 { font-size: 1rem; font-weight: 600; margin: 0.8rem 0 0.2rem; line-height: 1.4; }
.shown table { border-collapse: collapse; font-size: 0.875rem; }
.shown th { border-bottom: 1px solid #555; font-weight: 600; }
.shown td, .shown th { padding: 0.1rem 0.6rem 0.1rem 0; vertical-align: top; }
.shown .number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.shown .beyond { color: #767676; }
.shown .words { text-align: left; }
.shown tbody tr:nth-child(even) { background: #f4f4f4; }
"""
