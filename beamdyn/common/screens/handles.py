"""Handles of a drawing: their positions in the picture, and the field texts that follow from moving them."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any
from zlib import crc32

import numpy as np

from beamdyn.common.drawing.layout import WIDTH, Layout, Paper, Rows, lay_out
from beamdyn.common.drawing.svg import element
from beamdyn.common.edge.inputs import Input
from beamdyn.common.edge.toml_text import toml_value
from beamdyn.common.edge.units import quantity
from beamdyn.common.inputs.checks import reason_of
from beamdyn.common.screens.form_entries import Entries, tables_of, units_for, usual_unit
from beamdyn.common.screens.panels import with_ghost
from beamdyn.common.screens.screen_parts import Handle
from beamdyn.common.screens.screens import Screen

Place = tuple[float, float]
_NARROW = 400.0  # width of a drawing on a narrow page [pt]
_ANGLE = math.radians(0.1)  # increment to which angles are rounded [rad]


# Positions in the picture -------------------------------------------------------------------------------


@dataclass(frozen=True)
class Viewport:
    """Position of the first drawing within a picture; converts points between the two.

    Parameters
    ----------
    paper : Paper
        Size of the sheet with all drawings of the picture.
    layout : Layout
        Layout of the first drawing.
    """

    paper: Paper
    layout: Layout

    def place(self, point: Place) -> Place:
        """Convert a point of the drawing to a position: fractions of the picture from its top left corner."""
        x, y = self.layout.fit.to_paper(point) / self._size
        return float(x), float(y)

    def point(self, place: Place) -> Place:
        """Convert a position in the picture to the point of the drawing at this position."""
        x, y = self.layout.fit.from_paper(np.multiply(place, self._size))
        return float(x), float(y)

    @property
    def _size(self) -> tuple[float, float]:
        return self.paper.width, self.paper.height


@dataclass(frozen=True)
class Sheet:
    """A drawing and its handles (points that the user can drag).

    Parameters
    ----------
    said : str
        The reason why there is no drawing; empty if there is one.
    handles : tuple of Handle
        The points of the drawing that the user can drag.
    view : Viewport, optional
        Viewport of the first drawing; None if there is no drawing.
    ratio : float
        Width of the drawing divided by its height.
    element : str
        The drawing as an SVG element with the colours of the page.
    """

    said: str
    handles: tuple[Handle, ...] = ()
    view: Viewport | None = None
    ratio: float = 1.0
    element: str = ""

    @property
    def name(self) -> str:
        """Return the name of the picture: a checksum of its content."""
        return f"p{crc32((self.element or self.said).encode()):08x}"

    def place(self, handle: Handle) -> Place:
        """Return the position of a handle in the picture."""
        assert self.view is not None
        x, y = handle.at
        return self.view.place((handle.scale * x, handle.scale * y))


def draw_sheet(
    screen: Screen,
    answer: Any,
    progress: float,
    view: Viewport | None = None,
    other: Rows = (),
    name: str = "",
    narrow: bool = False,
) -> Sheet:
    """Draw a result, with its handles.

    Parameters
    ----------
    screen : Screen
        The screen that shows the result.
    answer : object
        The result.
    progress : float
        Position of the slider above the drawing, from 0 to `Screen.last`.
    view : Viewport, optional
        Viewport to keep, so that the picture does not shift while a handle moves.
    other : sequence of sequences of Drawing
        Drawings of another design, which are drawn behind those of the result.
    name : str
        Name of the other design.
    narrow : bool
        Whether the page is narrow; drawings are then placed below one another.
    """
    rows = screen.drawings(answer, progress)
    if not rows:
        return Sheet("")
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)
            marks = len(screen.slider.marks) if screen.slider is not None and view is None else 0
            if marks:  # give the first drawing room for what it shows at every mark of the slider
                corners = [screen.drawings(answer, float(mark))[0][0].extent() for mark in range(marks)]
                rows = _with_first(rows, room=np.vstack(corners))
            rows = with_ghost(rows, other, name) if other else rows
            rows = [[drawing] for row in rows for drawing in row] if narrow else rows
            handles = tuple(screen.handles(answer, progress))
            points = {handle.label: np.multiply(handle.scale, handle.at) for handle in handles}
            rows = _with_first(rows, points=points)
            held = view if view is not None and len(view.paper.heights) == len(rows) else None
            paper = Paper.of(rows, _NARROW if narrow else WIDTH) if held is None else held.paper
            layouts = lay_out(rows, paper, None if held is None else held.layout)
            shown = Viewport(paper, layouts[0])
            return Sheet("", handles, shown, paper.width / paper.height, element(layouts, paper))
    except (ValueError, ArithmeticError) as error:
        return Sheet(f"There is no drawing: {reason_of(error)}")


def _with_first(rows: Rows, **changes: Any) -> Rows:
    """Return rows of drawings in which the first drawing has the given `changes` of its fields."""
    (first, *others), *more = rows
    return [[replace(first, **changes), *others], *more]


# Field texts that follow from moving a handle ------------------------------------------------------------


def changed_texts(
    handle: Handle, target: Place, entries: Mapping[str, str], inputs: Sequence[Input]
) -> Entries:
    """Return the texts of the fields that change when a handle is moved, by path of the input.

    Parameters
    ----------
    handle : Handle
        The handle.
    target : tuple of float
        New position of the handle (x, y) [m].
    entries : mapping
        Texts of the fields; the new texts keep the units.
    inputs : sequence of Input
        Descriptions of the fields.
    """
    texts = _texts(handle, target, entries, inputs)
    return {path: text for path, text in texts.items() if text != entries.get(path, "")}


def describe_place(handle: Handle, entries: Mapping[str, str], inputs: Sequence[Input]) -> str:
    """Describe the position of a handle by the names and values of the fields that it sets."""
    texts = _texts(handle, handle.at, entries, inputs)
    return ", ".join(f"{path.rpartition('.')[2].replace('_', ' ')} {text}" for path, text in texts.items())


def _texts(handle: Handle, target: Place, entries: Mapping[str, str], inputs: Sequence[Input]) -> Entries:
    """Return the texts of the fields that a handle sets; unchanged parts of the old texts are kept."""
    known, texts = {entry.path: entry for entry in inputs}, {}
    for path, value in handle.moved(*target).items():
        if path in known:  # the handles of an outdated drawing may set inputs that no longer exist
            text, unit = entries.get(path, ""), known[path].quantity.unit
            if isinstance(value, tuple):
                pairs = zip(value, _coordinates(text, known[path]), strict=True)
                texts[path] = toml_value([_number(v, t, unit, handle.grain) for v, t in pairs])
            else:
                texts[path] = _number(value, text, unit, handle.grain)
    return texts


def _coordinates(text: str, entry: Input) -> Sequence[str]:
    """Return the texts of both coordinates of a point from the text of its field.

    If the field is empty, return the default coordinates; if its text is not a point, return empty texts.
    """
    if not text.strip() and isinstance(entry.default, tuple):
        return [f"{1e3 * value:.6g} mm" for value in entry.default]
    values = tables_of({"point": text}, ()).get("point")
    return [str(part) for part in values] if isinstance(values, list) and len(values) == 2 else ["", ""]


def _number(value: float, text: str, unit: str, grain: float) -> str:
    """Return a quantity in the unit of the old text, rounded to the increment `grain`.

    If the old text differs from the value by half an increment or less, it is returned.
    """
    grain = grain if unit == "m" else _ANGLE
    try:
        if abs(quantity(text, unit) - value) <= grain / 2:
            return text
    except ValueError:
        pass
    by_length = sorted(units_for(unit), key=len, reverse=True)
    shown = next((u for u in by_length if text.rstrip().endswith(u)), usual_unit(unit))
    size = quantity(f"1 {shown}", unit)
    decimals = max(0, -math.floor(math.log10(grain / size) + 1e-9))
    return f"{round(value / size, decimals) + 0.0:.{decimals}f} {shown}"
