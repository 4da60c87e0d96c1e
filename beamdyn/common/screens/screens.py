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
    """The parameter sweeps that a screen offers: results over any input.

    Parameters
    ----------
    names : callable
        ``names(tables)`` returns the names of the results; it may raise `ConfigError`.
    example : str
        The varied input and its values at first, such as "stop.speed=10:30:9 km/h".
    results : str
        Names of the results chosen at first, separated by commas.
    run : callable
        ``run(tables, text, names)`` returns the named results for the varied input that a text describes.
    draw : callable
        ``draw(sweep)`` returns the figure of a sweep.
    """

    names: Callable[[Mapping[str, Any]], Sequence[str]]
    example: str
    results: str
    run: Callable[[Mapping[str, Any], str, str], InputSweep]
    draw: Callable[[InputSweep], Figure] = sweep_figure


@dataclass(frozen=True)
class Backwards:
    """The inverse questions that a screen offers: find the input for which a result has a wanted value.

    Parameters
    ----------
    units : callable
        ``units(tables)`` returns the unit of each result, by name; it may raise `ConfigError`.
    input, result : str
        Path of the input and name of the result that are selected at first.
    find : callable
        ``find(tables, sought, so_that)`` returns the values found as HTML; `sought` names the input,
        `so_that` is the condition on the result.
    """

    units: Callable[[Mapping[str, Any]], Mapping[str, str]]
    input: str
    result: str
    find: Callable[[Mapping[str, Any], str, str], str]


@dataclass(frozen=True)
class FoldedPart:
    """A further drawing or table of a screen, which is made when the user unfolds it.

    Parameters
    ----------
    title : str
        Title of the part.
    on_page, in_report : callable
        ``on_page(answer)`` returns the part as HTML with the colours of the page; ``in_report(answer)``
        returns it for a report, with fixed colours.
    """

    title: str
    on_page: Callable[[Any], str]
    in_report: Callable[[Any], str]

    @classmethod
    def of_drawings(cls, title: str, rows: Callable[[Any], Rows]) -> FoldedPart:
        """Make a part that shows the drawings that ``rows(answer)`` returns."""

        def on_page(answer: Any) -> str:
            drawn = rows(answer)
            paper = Paper.of_squares(drawn)
            return element(lay_out(drawn, paper), paper)

        def in_report(answer: Any) -> str:
            drawn = rows(answer)
            return picture(drawing(lambda: figure_of(drawn, Paper.of_squares(drawn))), title)

        return cls(title, on_page, in_report)


class FollowingFile(NamedTuple):
    """An input file of another kind that can be made from a result.

    Parameters
    ----------
    words : str
        Label of the button that makes the file.
    text : callable
        ``text(answer)`` returns the text of the file.
    """

    words: str
    text: Callable[[Any], str]


@dataclass(frozen=True)
class Screen:
    """A screen: a form, and pure functions that compute the result and show it.

    Parameters
    ----------
    name : str
        Name on the tab of the screen.
    purpose : str
        Purpose of the screen in one sentence.
    sections : tuple of str
        Tables of the file whose inputs are on the form; "" for inputs outside any table.
    needs : tuple of str
        Tables, and inputs outside any table, on which the result depends.
    solve : callable
        ``solve(tables)`` computes the result.
    tables : callable
        ``tables(answer)`` returns tables and sentences on the result.
    draw : callable
        ``draw(answer, place)`` returns the figure for files, at a position of the slider.
    notes : callable
        ``notes(answer)`` returns warnings and error messages, a sentence each.
    rows : callable
        ``rows(answer)`` returns the rows of the CSV file.
    slider : Slider, optional
        The slider above the drawing.
    sweeps : Sweeps, optional
        Parameter sweeps that the screen offers.
    backwards : Backwards, optional
        Inverse questions that the screen offers.
    drags : tuple of Drag
        Sliders in the form.
    presets : tuple of Preset
        Lists in the form whose choices fill in several fields, such as a material.
    more : tuple of FoldedPart
        Further drawings and tables, which are made when the user unfolds them.
    handles : callable
        ``handles(answer, place)`` returns the points of the first drawing that the user can drag.
    drawings : callable
        ``drawings(answer, place)`` returns rows of drawings; empty for a screen that has only charts.
    coarser : callable
        ``coarser(tables)`` returns inputs with about the same drawing that are computed faster, for use while
        the user drags a point.
    lists : Lists, optional
        Lists of named items above the form.
    headline : callable
        ``headline(answer)`` returns the two to four most important results, each in a few words.
    quick_headline : callable, optional
        Like `headline`, without results that take long to compute, for use while the user drags; `headline`
        if not given.
    effort : str
        Sentence on what makes the computation slow, and what makes it faster.
    charts : callable, optional
        ``charts(answer, place)`` returns the charts below the drawings.
    picture : callable, optional
        ``picture(answer, narrow)`` returns the figure above the tables, for a narrow or a wide page; it is
        called in another process.
    branches : callable
        ``branches(answer)`` returns, if there are several solutions, a result for each of them, by name, the
        usual one first; else an empty mapping.
    follows : FollowingFile, optional
        An input file of another kind, made from the result, which a button opens on its screens.
    sketch : callable
        ``sketch(entries)`` returns rows of drawings that explain the symbols of the form, for the options
        chosen in the form.
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
        """Return the largest position of the slider; 0 without a slider."""
        return self.slider.last if self.slider is not None else 0.0


@dataclass(frozen=True)
class Document:
    """A kind of TOML file, and the screens for it.

    Parameters
    ----------
    name : str
        Usual name of the file, without its suffix.
    base : str
        Text of the file that is shown at first.
    inputs : callable
        ``inputs(entries)`` returns the descriptions of the inputs, each path once.
    check : callable
        ``check(text, name)`` parses the text of a file; it raises `ConfigError` for an invalid file.
    screens : tuple of Screen
        Screens, each of which may use results of earlier screens.
    aside : mapping
        Initial field texts that are not part of the file, such as options of a command.
    read : callable
        ``read(text, name)`` returns the tables of a file; it raises `ConfigError` for an invalid file.
    in_fields : callable
        ``in_fields(tables)`` rearranges the tables of a file so that each value is at the path of its field.
    headings : mapping
        Headings of the form's tables, by name; by default the name of the table.
    idle : callable
        ``idle(entries)`` returns the paths of inputs without effect for these field texts; their fields are
        shown only if they contain a text.
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
        """Return the field texts for the text of a file.

        Parameters
        ----------
        text : str
            Text of the file.
        source : str
            Name of the file, for messages.

        Raises
        ------
        ConfigError
            If the file is invalid for the commands.
        """
        self.check(text, source)
        tables = self.in_fields(self.read(text, source))
        return entries_of(tables, self.inputs(entries_of(tables, ()))) | dict(self.aside)

    def accepts(self, text: str) -> bool:
        """Return whether the text is a valid file of this kind."""
        with suppress(ConfigError):
            return bool(self.opened(text, ""))
        return False

    @property
    def beside(self) -> set[str]:
        """Return the names of the tables whose inputs are not part of the file (see `aside`)."""
        return {path.partition(".")[0] for path in self.aside}

    @cached_property
    def base_entries(self) -> Entries:
        """Return the field texts of the initial design."""
        return self.opened(self.base, self.name)


@dataclass(frozen=True)
class Program:
    """An interactive program: its name, its title, and the kinds of input file with their screens."""

    name: str
    title: str
    documents: tuple[Document, ...]
