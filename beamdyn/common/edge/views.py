"""Display of results: tables and a picture for notebooks, data frames for pandas, and text."""

from __future__ import annotations

import base64
import dataclasses
import io
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from html import escape
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np
from rich.console import Console, RenderableType

from beamdyn.common.edge.console import table, table_of
from beamdyn.common.edge.rendering import html, png
from beamdyn.common.inputs.checks import reason_of
from beamdyn.common.inputs.described import descriptions
from beamdyn.common.results.columns import Columns, meanings
from beamdyn.common.results.one_line import brief, spanned
from beamdyn.common.results.pictures import figure_of
from beamdyn.common.results.result import Result, plain
from beamdyn.common.results.shown_by import SHOWN_BY

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame

_MOST_ROWS = 30  # largest number of rows of a table in a notebook
_WIDTH = 120  # width of a table as text, in characters
_NOT_SHOWN = ("provenance", "warnings")
_DEEPEST = 1  # largest nesting depth of objects in a result whose fields are shown

Rows = Iterable[Sequence[object]]  # rows of a table, the first with headings; `Columns` is such an iterable


@dataclass(frozen=True)
class View:
    """How results of a class are shown; functions that are not given are replaced by defaults.

    Parameters
    ----------
    tables : callable, optional
        ``tables(result)`` returns tables and sentences for the console; by default, one table of all columns.
    rows : callable, optional
        ``rows(result)`` returns columns, or beside `tables` the rows of the CSV file, headings first.
    index : int
        Number of columns, from the left, that are the index of a data frame.
    figure : callable, optional
        ``figure(result)`` draws the picture of a result, and returns the figure.
    """

    tables: Callable[[Any], RenderableType] | None = None
    rows: Callable[[Any], Rows] | None = None
    index: int = 0
    figure: Callable[[Any], Figure] | None = None


def view_of(result: Result) -> View:
    """Return the `View` for a result's class, or for its nearest base class that has one."""
    for kind in type(result).__mro__:
        package, room, *_ = f"{kind.__module__}.".split(".")
        place = SHOWN_BY.get(f"{package}.{room}", SHOWN_BY.get(package))
        found = import_module(place).VIEWS.get(kind.__name__) if place else None
        if found is not None:
            return found
    return View()


def tables_of(result: Result) -> RenderableType:
    """Return the tables and sentences of a result, as its command prints them."""
    view = view_of(result)
    if view.tables is not None:
        return view.tables(result)
    title = (type(result).__doc__ or type(result).__name__).partition("\n")[0].rstrip(".:;")
    rows = None if view.rows is None else view.rows(result)
    if isinstance(rows, Columns):
        return table_of(rows, result.display_units, rows.title or title)
    fields = [(name.replace("_", " "), _cell(each), unit) for name, each, unit in _named_fields(result)]
    return table(title, ("", "value", "unit"), fields, (0, 1, 2))


def rows_of(result: Result) -> Rows:
    """Return the rows of a result's CSV file, headings first, in display units."""
    made = view_of(result).rows
    rows = _fields_rows(result) if made is None else made(result)
    return rows.in_units(result.display_units) if isinstance(rows, Columns) else rows


def picture_of(result: Result) -> Callable[[], Figure] | None:
    """Return a function that draws a result by its `View`, else by its method `plot`; None without both."""
    made = view_of(result).figure
    if made is not None:
        return lambda: made(result)
    plot = getattr(result, "plot", None)
    return None if plot is None else lambda: figure_of(plot)


# Text and data frames -------------------------------------------------------------------------------


def text_of(result: Result) -> str:
    """Return the tables of a result as text."""
    page = Console(file=io.StringIO(), width=_WIDTH, markup=False, highlight=False, emoji=False)
    with page.capture() as captured:
        page.print(tables_of(result))
    return "\n".join(line.rstrip() for line in captured.get().splitlines()).strip("\n")


def frame_of(result: Result) -> DataFrame:
    """Return the rows of a result's CSV file as a pandas data frame.

    Raises
    ------
    ImportError
        If pandas is not installed.
    """
    try:
        from pandas import DataFrame
    except ImportError:
        raise ImportError("to_pandas needs pandas: pip install 'beamdyn[pandas]'") from None
    heads, *rows = rows_of(result)
    names = [str(head) for head in heads]
    frame = DataFrame(rows, columns=names)  # pyright: ignore[reportArgumentType]  (a list of names)
    index = view_of(result).index
    frame = frame.set_index(names[:index]) if index else frame
    frame.attrs = {"result": type(result).__name__, "label": result.plot_label}
    for name in ("warnings", "provenance"):
        frame.attrs[name] = plain(getattr(result, name, None))
    return frame


# Notebooks ------------------------------------------------------------------------------------------

# Colours are inherited from the page, light or dark; the picture has its own white background.
_STYLE = """
.beamdyn-result { overflow-x: auto; }
.beamdyn-result h3 { font-size: 1em; font-weight: 600; margin: 0.8em 0 0.3em; }
.beamdyn-result p { margin: 0.3em 0; }
.beamdyn-result table { border-collapse: collapse; font-size: 0.9em; margin: 0; }
.beamdyn-result th { border-bottom: 1px solid currentColor; font-weight: 600; vertical-align: bottom; }
.beamdyn-result td, .beamdyn-result th { padding: 0.15em 1em 0.15em 0; background: none; color: inherit; }
.beamdyn-result tbody tr:nth-child(even) { background: rgba(128, 128, 128, 0.12); }
.beamdyn-result .number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.beamdyn-result .words { text-align: left; }
.beamdyn-result .beyond { opacity: 0.6; }
.beamdyn-result .warning { border-left: 4px solid #E69F00; padding-left: 0.5em; }
.beamdyn-result img { display: block; max-width: 100%; width: 45em; height: auto; margin: 0.6em 0; }
"""


def html_of(result: Result) -> str:
    """Return one-line summary, warnings, tables and picture of a result as self-contained HTML.

    The picture is embedded as an image, so that its names cannot clash with others on the page, and no
    scripts run.
    """
    said = "".join(f'<p class="warning">{escape(str(each))}</p>' for each in getattr(result, "warnings", ()))
    shown, name = html([tables_of(result)], _MOST_ROWS), escape(repr(result))
    try:
        draw = picture_of(result)
        content = "" if draw is None else base64.b64encode(png(draw())).decode()
        image = content and f'<img alt="{name}" src="data:image/png;base64,{content}">'
    # The picture cannot be drawn: numbers are too large, or none is finite.
    except (ValueError, ArithmeticError, LookupError) as error:
        image = f"<p>{escape(f'There is no picture: {reason_of(error)}')}</p>"
    return (
        f'<div class="beamdyn-result"><style>{_STYLE}</style>\n'
        f"<p><strong>{name}</strong></p>{said}\n{shown}\n{image}</div>"
    )


# Results without a `View` ----------------------------------------------------------------------------


def _fields_rows(result: Result) -> Iterator[Sequence[object]]:
    """Yield names, values and units of the public fields; arrays are listed entry by entry."""
    yield "name", "value", "unit"
    for name, value, unit in _named_fields(result):
        if not isinstance(value, np.ndarray) or not value.size:
            yield name, plain(value), unit
        elif value.size == 1:
            yield name, plain(np.ravel(value)[0]), unit
        else:
            for place, entry in np.ndenumerate(value):
                yield f"{name}[{','.join(map(str, place))}]", plain(entry), unit


def _named_fields(result: Any, depth: int = 0) -> Iterator[tuple[str, Any, str]]:
    """Yield name, value and unit of each public field with numbers or texts, also in arrays or mappings.

    Fields of nested results and other objects follow.  Inputs, which have a `Described` in their annotation,
    are left out.
    """
    stated = (vars(base).get("field_units", {}) for base in reversed(type(result).__mro__))
    units = {name: unit for each in stated for unit, names in each.items() for name in names.split()}
    units |= {name: stated.unit for name, stated in meanings(type(result)).items()}
    for each in dataclasses.fields(result):
        if each.repr and each.name not in _NOT_SHOWN:
            for name, value in _parts(each.name, getattr(result, each.name)):
                if isinstance(value, bool | int | float | str | np.generic | np.ndarray):
                    yield name, value, units.get(each.name, "")
                elif depth < _DEEPEST and dataclasses.is_dataclass(value) and not descriptions(type(value)):
                    within = _named_fields(value, depth + 1)
                    yield from ((f"{name}, {inner}", item, unit) for inner, item, unit in within)


def _parts(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    """Yield a value, or each value of a mapping or of a sequence of objects, with its name."""
    if isinstance(value, dict):
        yield from ((f"{name}, {key}", item) for key, item in value.items())
    elif isinstance(value, tuple | list):
        yield from ((f"{name}[{k}]", item) for k, item in enumerate(value))
    else:
        yield name, value


def _cell(value: Any) -> str:
    if isinstance(value, np.ndarray) and 1 < value.size <= 6 and value.dtype.kind in "iuf":
        return ", ".join(f"{number:.6g}" for number in value.ravel().tolist())
    if isinstance(value, np.ndarray) and value.size > 1 and value.dtype.kind in "iuf":
        return f"{spanned(value)}, {' x '.join(map(str, value.shape))} values"
    if isinstance(value, bool | np.bool_):
        return "yes" if value else "no"
    return value if isinstance(value, str) else brief(value)
