"""Descriptions of an interactive program: its documents (kinds of TOML file) and their screens."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from beamdyn.common.drawing.layout import Paper, Rows, lay_out
from beamdyn.common.drawing.on_axes import figure_of
from beamdyn.common.drawing.shapes import Chart
from beamdyn.common.drawing.sketch import Sketcher
from beamdyn.common.drawing.svg import element
from beamdyn.common.edge.config import ConfigError, parse
from beamdyn.common.edge.inputs import Input
from beamdyn.common.edge.rendering import drawing, picture
from beamdyn.common.plots.curves import sweep_figure
from beamdyn.common.screens.form_entries import Entries, entries_of
from beamdyn.common.screens.lists import Lists
from beamdyn.common.screens.screen_parts import Drag, Handle, KeyResult, Preset, Slider

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
class Backwards:
    """The inverse questions that a screen offers: which value of an input gives a result a wanted value.

    Parameters
    ----------
    units : callable
        ``units(tables)``: units of the results, by their names; it may raise `ConfigError`.
    input, result : str
        Path of the input and name of the result that are chosen at first.
    find : callable
        ``find(tables, sought, so_that)``: what is found, in HTML; `sought` names the input, `so_that` says
        what is wanted.
    """

    units: Callable[[Mapping[str, Any]], Mapping[str, str]]
    input: str
    result: str
    find: Callable[[Mapping[str, Any], str, str], str]


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
        """Make the part that shows the drawings of ``rows(answer)``."""

        def on_page(answer: Any) -> str:
            drawn = rows(answer)
            paper = Paper.of_squares(drawn)
            return element(lay_out(drawn, paper), paper)

        def in_report(answer: Any) -> str:
            drawn = rows(answer)
            return picture(drawing(lambda: figure_of(drawn, Paper.of_squares(drawn))), title)

        return cls(title, on_page, in_report)


class FollowingFile(NamedTuple):
    """A file that can be made from an answer.

    Parameters
    ----------
    words : str
        Label of its button.
    text : callable
        ``text(answer)``: the text of the file.
    """

    words: str
    text: Callable[[Any], str]


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
    backwards : Backwards, optional
        Its inverse questions.
    drags : tuple of Drag
        Sliders in its form.
    presets : tuple of Preset
        Lists in its form that fill in several fields, such as a material.
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
        The most important results without those that take time, for use while a handle or slider is held;
        `headline` if not given.
    effort : str
        What makes an answer take long, and what shortens it, in a sentence.
    charts : callable, optional
        ``charts(answer, place)``: charts below the drawings.
    picture : callable, optional
        ``picture(answer, narrow)``: the figure that stands above the tables, for a narrow page or a wide one;
        made in another process.
    branches : callable
        ``branches(answer)``: where there are several solutions, the answer with each of them drawn, by name,
        the usual one first; empty where there is one.
    follows : FollowingFile, optional
        A file that follows from an answer, which a button opens as another document.
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
    backwards: Backwards | None = None
    drags: tuple[Drag, ...] = ()
    presets: tuple[Preset, ...] = ()
    more: tuple[FoldedPart, ...] = ()
    handles: Callable[[Any, float], Sequence[Handle]] = lambda *_: ()
    drawings: Callable[[Any, float], Rows] = lambda *_: ()
    coarser: Callable[[Mapping[str, Any]], Mapping[str, Any]] = lambda tables: tables
    lists: Lists | None = None
    headline: Callable[[Any], Iterable[KeyResult]] = lambda _: ()
    quick_headline: Callable[[Any], Iterable[KeyResult]] | None = None
    effort: str = ""
    charts: Callable[[Any, float], Sequence[Chart]] | None = None
    picture: Callable[[Any, bool], Figure] | None = None
    branches: Callable[[Any], Mapping[str, Any]] = lambda _: {}
    follows: FollowingFile | None = None
    sketch: Sketcher = lambda _: ()

    @property
    def last(self) -> float:
        """The largest position of the slider; 0 without one."""
        return self.slider.last if self.slider is not None else 0.0


@dataclass(frozen=True)
class Document:
    """A kind of TOML file, and the screens for it.

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
    read : callable
        ``read(text, name)``: the tables of a file; raises `ConfigError`.
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
    read: Callable[[str, str], dict[str, Any]] = parse
    in_fields: Callable[[dict[str, Any]], dict[str, Any]] = lambda tables: tables
    headings: Mapping[str, str] = field(default_factory=dict)
    idle: Callable[[Mapping[str, str]], Iterable[str]] = lambda _: ()

    def opened(self, text: str, source: str) -> Entries:
        """Return the entries for the text of a file.

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
        tables = self.in_fields(self.read(text, source))
        return entries_of(tables, self.inputs(entries_of(tables, ()))) | dict(self.aside)

    def accepts(self, text: str) -> bool:
        """Whether the text of a file can be opened as this document."""
        with suppress(ConfigError):
            return bool(self.opened(text, ""))
        return False

    @property
    def beside(self) -> set[str]:
        """Tables that are not in the file."""
        return {path.partition(".")[0] for path in self.aside}

    @cached_property
    def base_entries(self) -> Entries:
        """Entries of the base design, which is shown first."""
        return self.opened(self.base, self.name)


@dataclass(frozen=True)
class Program:
    """An interactive program: its name, title, and documents."""

    name: str
    title: str
    documents: tuple[Document, ...]
