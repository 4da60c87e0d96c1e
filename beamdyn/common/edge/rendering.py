"""Figures as SVG and PNG, tables as HTML, rows as CSV, returned as text or bytes."""

from __future__ import annotations

import base64
import csv
import io
import warnings
from collections.abc import Callable, Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group
from rich.table import Table
from rich.text import Text

from beamdyn.common.inputs.checks import reason_of

_SENTENCE = 36  # letters from which on the words of a cell are a sentence
_WIDE = 75  # letters in a row from which on a table takes the whole width of a page

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import RenderableType


def svg(figure: Figure) -> str:
    """A figure as the text of an SVG file; the same figure gives the same text."""
    return png(figure, "svg").decode()


def png(figure: Figure, kind: str = "png") -> bytes:
    """A figure as a PNG file, or as one of another kind."""
    from matplotlib import rc_context

    file = io.BytesIO()
    metadata = {"Date": None} if kind == "svg" else {}
    with rc_context({"svg.hashsalt": "beamdyn"}), np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # layouts warn where they have too little room
        figure.savefig(file, format=kind, dpi=150, metadata=metadata)
    return file.getvalue()


def drawing(draw: Callable[[], Figure]) -> str:
    """The SVG of a drawing, or a sentence if it cannot be drawn (numbers too large)."""
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)
            return svg(draw())
    except (ValueError, ArithmeticError) as error:
        return f"There is no drawing: {reason_of(error)}"


def picture(text: str, words: str) -> str:
    """An SVG as an HTML image, which runs no scripts; a sentence in its place as a paragraph.

    Parameters
    ----------
    text : str
        The SVG.
    words : str
        Description for screen readers.
    """
    if not text.startswith("<?xml"):
        return f"<p>{escape(text)}</p>"
    return f'<img class="drawing" alt="{escape(words)}" src="{data_url(text)}">'


def data_url(text: str) -> str:
    """An SVG as a data URL."""
    return f"data:image/svg+xml;base64,{base64.b64encode(text.encode()).decode()}"


def html(parts: Iterable[RenderableType], most: int | None = None) -> str:
    """Tables and sentences, as the commands print them, in HTML.

    If a table has more than `most` rows, the first and last ones are shown, and how many are not.
    """
    made = []
    for part in parts:
        if isinstance(part, Group):
            wide = ' class="wide"' if _width(part) > _WIDE else ""
            made.append(f"<section{wide}>{html(part.renderables, most)}</section>")
        elif isinstance(part, Table):
            made.append(_table(part, most))
        elif isinstance(part, Text) and part.style == "bold":
            made.append(f"<h3>{escape(part.plain)}</h3>")
        else:
            made.append(f"<p>{escape(str(part))}</p>" if str(part) else "")
    return "\n".join(made)


def _width(part: object) -> int:
    """Letters in the longest cells of a row of a table, or of the widest one of a group; else 0."""
    if isinstance(part, Group):
        return max(map(_width, part.renderables), default=0)
    columns = part.columns if isinstance(part, Table) else ()
    return sum(max(map(len, map(str, (column.header, *column.cells)))) for column in columns)


def _table(made: Table, most: int | None) -> str:
    """A table; of one with too many rows the first and last ones, and how many are not shown."""
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
    """A cell in HTML; dimmed digits of a number stand at its end."""
    if not isinstance(cell, Text) or not cell.spans:
        return escape(str(cell))
    start = cell.spans[0].start
    return f'{escape(cell.plain[:start])}<span class="beyond">{escape(cell.plain[start:])}</span>'


def _row(cells: Sequence[str], words: Sequence[bool], tag: str) -> str:
    """A row; words of a sentence are not set one below the other."""
    kinds = (
        ("words sentence" if len(cell) > _SENTENCE else "words") if w else "number"
        for cell, w in zip(cells, words, strict=True)
    )
    made = (f'<{tag} class="{kind}">{cell}</{tag}>' for cell, kind in zip(cells, kinds, strict=True))
    return f"<tr>{''.join(made)}</tr>"


def csv_text(rows: Iterable[Sequence[object]], delimiter: str = ",") -> str:
    """Rows as the text of a CSV file."""
    file = io.StringIO()
    csv.writer(file, delimiter=delimiter, lineterminator="\n").writerows(rows)
    return file.getvalue()


STYLE = """
.drawing { width: 100%; height: auto; background: white; }
.scrolls { overflow-x: auto; }
.shown h3 { font-size: 1rem; font-weight: 600; margin: 0.8rem 0 0.2rem; line-height: 1.4; }
.shown table { border-collapse: collapse; font-size: 0.875rem; }
.shown th { border-bottom: 1px solid #555; font-weight: 600; }
.shown td, .shown th { padding: 0.1rem 0.8rem 0.1rem 0; vertical-align: top; }
.shown .number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.shown .beyond { color: #767676; }
.shown .words { text-align: left; }
.shown tbody tr:nth-child(even) { background: #f4f4f4; }
"""
