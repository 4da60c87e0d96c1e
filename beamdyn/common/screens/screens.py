"""Descriptions of an interactive program: its documents (kinds of TOML file) and their screens."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from beamdyn.common.drawing.chart import Chart
from beamdyn.common.drawing.on_axes import figure_of
from beamdyn.common.drawing.sheet import Paper, Rows, lay_out
from beamdyn.common.drawing.sketch import Sketcher
from beamdyn.common.drawing.svg import element
from beamdyn.common.edge.config import parse
from beamdyn.common.edge.inputs import Input
from beamdyn.common.edge.rendering import drawing, picture
from beamdyn.common.plots.curves import sweep_figure
from beamdyn.common.screens.form_entries import Entries, entries_of
from beamdyn.common.screens.lists import Lists

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import RenderableType

    from beamdyn.common.edge.input_sweep import InputSweep


@dataclass(frozen=True)
class Sweeps:
    """The sweeps that a screen offers: any input against any result.

    Parameters
    ----------
    names : callable
        ``names(tables)``: names of the results; it may raise `ConfigError`.
    example : str
        The sweep that is shown at first, such as "stop.speed=10:30:9 km/h".
    results : str
        Names of the results chosen at first, separated by commas.
    run : callable
        ``run(tables, text, names)``: the sweep that a text describes, of the results with these names.
    draw : callable
        ``draw(sweep)``: its figure.
    """

    names: Callable[[Mapping[str, Any]], Sequence[str]]
    example: str
    results: str
    run: Callable[[Mapping[str, Any], str, str], InputSweep]
    draw: Callable[[InputSweep], Figure] = sweep_figure


@dataclass(frozen=True)
class Slider:
    """A slider above the drawing, which changes the drawing only.

    Parameters
    ----------
    label : str
        Name of the quantity that it sets.
    marks : tuple of str
        Labels of its positions 0, 1, ...
    step : float
        Step between positions when it is moved by hand.
    seconds : float
        Time to play it from one end to the other [s].
    onward : bool
        Whether it is played at a constant rate, and from 0 again after the end; else back and forth, slowly
        at both ends.
    """

    label: str
    marks: tuple[str, ...]
    step: float = 0.05
    seconds: float = 2.5
    onward: bool = False

    @property
    def last(self) -> float:
        """Position at its end."""
        return len(self.marks) - 1.0

    def place(self, elapsed: float) -> float:
        """Position when it has been played for a time [s]."""
        if self.onward:
            return self.last * (elapsed / self.seconds % 1.0)
        return self.last * (1 - math.cos(math.pi * elapsed / self.seconds)) / 2

    def elapsed(self, place: float) -> float:
        """Time at which it is at a position when it is played, on its way there [s]."""
        if self.onward:
            return self.seconds * place / self.last
        if place >= self.last:
            return self.seconds
        return self.seconds / math.pi * math.acos(1 - 2 * max(place, 0.0) / self.last)


@dataclass(frozen=True)
class Drag:
    """A slider below a field of the form, which writes into the field.

    Parameters
    ----------
    path : str
        Path of the field's input.
    low, high, step : float
        Its range and step, in `unit`.
    unit : str
        Unit in which it writes.
    """

    path: str
    low: float
    high: float
    step: float
    unit: str


class KeyResult(NamedTuple):
    """A result that stands first on a screen, such as ("stopping distance", "13.4 m").

    Parameters
    ----------
    words : str
        Name of the result.
    value : str
        The number with its unit, or a word.
    """

    words: str
    value: str


@dataclass(frozen=True)
class Handle:
    """A draggable point of a drawing, which writes into fields of the form.

    Parameters
    ----------
    label : str
        Name of the point.
    at : tuple of float
        Its place (x, y) [m].
    moved : callable
        ``moved(x, y)``: values in SI for a new place [m], by the path of their input: a number, or a pair for
        a point.
    scale : float
        Units of the drawing in a metre: 1000 where it is in mm.
    step : float
        Distance by which an arrow key moves it [m].
    grain : float
        Step to which a length is rounded [m].
    """

    label: str
    at: tuple[float, float]
    moved: Callable[[float, float], Mapping[str, float | tuple[float, float]]]
    scale: float = 1.0
    step: float = 5e-4
    grain: float = 1e-4


@dataclass(frozen=True)
class FoldedPart:
    """A further drawing or table of a screen, which folds out below its numbers, and is made only then.

    Parameters
    ----------
    title : str
        Title of the part.
    on_page, in_report : callable
        ``on_page(answer)``: the part in HTML, in the colours of the page; ``in_report(answer)``: for a page
        that has no colours of its own.
    """

    title: str
    on_page: Callable[[Any], str]
    in_report: Callable[[Any], str]

    @classmethod
    def of_drawings(cls, title: str, rows: Callable[[Any], Rows]) -> FoldedPart:
        """Make one of ``rows(answer)``: rows of drawings."""

        def on_page(answer: Any) -> str:
            drawn = rows(answer)
            paper = Paper.of_squares(drawn)
            return element(lay_out(drawn, paper), paper)

        def in_report(answer: Any) -> str:
            drawn = rows(answer)
            return picture(drawing(lambda: figure_of(drawn, Paper.of_squares(drawn))), title)

        return cls(title, on_page, in_report)


@dataclass(frozen=True)
class Screen:
    """A screen: a form, and pure functions that solve its tables and show the answer.

    Parameters
    ----------
    name : str
        Name on its tab.
    purpose : str
        Purpose, in a sentence.
    sections : tuple of str
        Tables whose inputs stand on its form; "" for inputs outside any table.
    needs : tuple of str
        Tables, or inputs outside any, that the answer depends on.
    solve : callable
        ``solve(tables)``: the answer.
    tables : callable
        ``tables(answer)``: tables and sentences on the answer.
    draw : callable
        ``draw(answer, place)``: the figure for files, with the slider at a position.
    notes : callable
        ``notes(answer)``: warnings and refusals, a sentence each.
    rows : callable
        ``rows(answer)``: rows of the CSV file.
    slider : Slider, optional
        The slider above the drawing.
    sweeps : Sweeps, optional
        Its sweeps.
    drags : tuple of Drag
        Sliders in its form.
    more : tuple of FoldedPart
        Drawings and tables that fold out; made when they are wanted.
    handles : callable
        ``handles(answer, place)``: points of the first drawing that can be moved.
    drawings : callable
        ``drawings(answer, place)``: rows of drawings; empty on a screen of charts.
    coarser : callable
        ``coarser(tables)``: tables with the same drawing that are solved sooner, for use while a point is
        moved.
    lists : Lists, optional
        Lists of named items above its form.
    headline : callable
        ``headline(answer)``: the two to four most important results, each in a few words.
    quick_headline : callable, optional
        The results without those that take time, for use while something is held; `headline` if not given.
    effort : str
        What makes an answer take long, and what shortens it, in a sentence.
    charts : callable, optional
        ``charts(answer, place)``: charts below the drawings.
    branches : callable
        ``branches(answer)``: where there are several solutions, the answer with each of them drawn, by name,
        the usual one first; empty where there is one.
    sketch : callable
        ``sketch(entries)``: rows of drawings that show what the symbols of the form mean, for the kinds that
        are chosen there.
    """

    name: str
    purpose: str
    sections: tuple[str, ...]
    needs: tuple[str, ...]
    solve: Callable[[Mapping[str, Any]], Any]
    tables: Callable[[Any], Sequence[RenderableType]]
    draw: Callable[[Any, float], Figure]
    notes: Callable[[Any], Sequence[str]]
    rows: Callable[[Any], Iterable[Sequence[object]]]
    slider: Slider | None = None
    sweeps: Sweeps | None = None
    drags: tuple[Drag, ...] = ()
    more: tuple[FoldedPart, ...] = ()
    handles: Callable[[Any, float], Sequence[Handle]] = lambda *_: ()
    drawings: Callable[[Any, float], Rows] = lambda *_: ()
    coarser: Callable[[Mapping[str, Any]], Mapping[str, Any]] = lambda tables: tables
    lists: Lists | None = None
    headline: Callable[[Any], Iterable[KeyResult]] = lambda _: ()
    quick_headline: Callable[[Any], Iterable[KeyResult]] | None = None
    effort: str = ""
    charts: Callable[[Any, float], Sequence[Chart]] | None = None
    branches: Callable[[Any], Mapping[str, Any]] = lambda _: {}
    sketch: Sketcher = lambda _: ()

    @property
    def last(self) -> float:
        """Position of the slider at its end."""
        return self.slider.last if self.slider is not None else 0.0


@dataclass(frozen=True)
class Document:
    """A kind of TOML file, and the screens on it.

    Parameters
    ----------
    name : str
        The file's usual name, without its suffix.
    base : str
        Text of the file that is shown on opening.
    inputs : callable
        ``inputs(entries)``: descriptions of the inputs, each path once.
    check : callable
        ``check(text, name)``: parse the text of a file, raising `ConfigError`.
    screens : tuple of Screen
        Screens, each of which may use results of those before it.
    aside : mapping
        Initial entries that are not part of the file, such as options of a command.
    in_fields : callable
        ``in_fields(tables)``: tables of a file with each value at the path of its input on the form.
    headings : mapping
        Headings of tables of the form; the name of a table where there is none.
    idle : callable
        ``idle(entries)``: paths of inputs that have no effect beside these entries; they are shown only if
        something is given for them.
    """

    name: str
    base: str
    inputs: Callable[[Mapping[str, str]], list[Input]]
    check: Callable[[str, str], Any]
    screens: tuple[Screen, ...]
    aside: Mapping[str, str] = field(default_factory=dict)
    in_fields: Callable[[dict[str, Any]], dict[str, Any]] = lambda tables: tables
    headings: Mapping[str, str] = field(default_factory=dict)
    idle: Callable[[Mapping[str, str]], Iterable[str]] = lambda _: ()

    def opened(self, text: str, source: str) -> Entries:
        """Entries for the text of a file.

        Parameters
        ----------
        text : str
            The text.
        source : str
            Name of the file, for messages.

        Raises
        ------
        ConfigError
            If the parser of the commands does not accept it.
        """
        self.check(text, source)
        tables = self.in_fields(parse(text, source))
        return entries_of(tables, self.inputs(entries_of(tables, ()))) | dict(self.aside)

    @property
    def beside(self) -> set[str]:
        """Tables that are not in the file."""
        return {path.partition(".")[0] for path in self.aside}

    @cached_property
    def base_entries(self) -> Entries:
        """Entries on opening."""
        return self.opened(self.base, self.name)


@dataclass(frozen=True)
class Program:
    """An interactive program: its name, title, and documents."""

    name: str
    title: str
    documents: tuple[Document, ...]
