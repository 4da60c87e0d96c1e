"""Descriptions of an interactive program: its documents (kinds of TOML file) and their screens."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from beamdyn.common.app.courses import BackAndForth, Course
from beamdyn.common.app.folded_parts import FoldedPart
from beamdyn.common.app.form_entries import Entries, entries_of
from beamdyn.common.app.lists import Lists
from beamdyn.common.curves import sweep_figure
from beamdyn.common.drawing.chart import Chart
from beamdyn.common.drawing.sheet import Rows
from beamdyn.common.drawing.sketch import Sketcher
from beamdyn.common.edge.config import parse
from beamdyn.common.edge.inputs import Input

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
        Tables in, names of the results out; it may raise `ConfigError`.
    example : str
        A sweep to begin with, such as "stop.speed=10:30:9 km/h".
    results : str
        Names of results to begin with, separated by commas.
    run : callable
        Tables, text of the sweep and names of results in; a sweep out.
    draw : callable
        The sweep in, its figure out.
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
        What it is.
    marks : tuple of str
        What its whole numbers from 0 on are.
    step : float
        Between places that are drawn when it is moved by hand.
    seconds : float
        How long it takes to play from one end to the other [s].
    course : callable
        Its last place and these seconds in, how it is played out: back and forth, or from the start again.
    """

    label: str
    marks: tuple[str, ...]
    step: float = 0.05
    seconds: float = 2.5
    course: Callable[[float, float], Course] = BackAndForth


@dataclass(frozen=True)
class Drag:
    """A slider below a field of the form, which writes into the field.

    Parameters
    ----------
    path : str
        The field's input.
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
        What it is.
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
        What it is.
    at : tuple of float
        Where it is drawn, (x, y) [m].
    moved : callable
        A new place (x, y) [m] in; values by the path of their input out, in SI: a number, or a pair for
        a point.
    scale : float
        Units of the drawing in a metre: 1000 where it is in mm.
    step : float
        How far an arrow key moves it [m].
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
class Screen:
    """A screen: a form, and pure functions that solve its tables and show the answer.

    Parameters
    ----------
    name : str
        On its tab.
    purpose : str
        What it is for, in a sentence.
    sections : tuple of str
        Tables whose inputs stand on its form; "" for inputs outside any table.
    needs : tuple of str
        Tables, or inputs outside any, that the answer depends on.
    solve : callable
        Tables in, answer out.
    tables : callable
        The answer as tables and sentences.
    draw : callable
        Answer and place of the slider in; the figure for files out.
    notes : callable
        Warnings and refusals of an answer, a sentence each.
    rows : callable
        Rows of the answer's CSV file.
    slider : Slider, optional
        For the drawing.
    sweeps : Sweeps, optional
        Its sweeps.
    drags : tuple of Drag
        Sliders in its form.
    more : tuple of FoldedPart
        Drawings and tables that fold out; made when they are wanted.
    handles : callable
        Answer and place of the slider in; points of the first drawing that can be moved out.
    drawings : callable
        Answer and place of the slider in; rows of drawings out. None on a screen of charts.
    coarser : callable
        Tables in, those of a question out whose drawing is the same and that is answered sooner: solved while
        a point is moved.
    lists : Lists, optional
        Lists of named things that stand above its form.
    headline : callable
        Answer in; the two to four results that matter most out, each in a few words.
    quick_headline : callable, optional
        The same while something is held, without what takes time; the headline if not given.
    effort : str
        What makes an answer take long, and what shortens it, in a sentence.
    charts : callable, optional
        Answer and place of the slider in; charts out, which are shown below the drawings.
    branches : callable
        Answer in; out, by their names, the same answer with each of several solutions drawn, the usual one
        first, among which the page lets one choose. None where there is one.
    sketch : callable
        Entries of its form in; rows of drawings out that show what its symbols mean, for the kinds that are
        chosen there.
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
    headline: Callable[[Any], Sequence[KeyResult]] = lambda _: ()
    quick_headline: Callable[[Any], Sequence[KeyResult]] | None = None
    effort: str = ""
    charts: Callable[[Any, float], Sequence[Chart]] | None = None
    branches: Callable[[Any], Mapping[str, Any]] = lambda _: {}
    sketch: Sketcher = lambda _: ()

    @property
    def last(self) -> float:
        """Place of the slider at its end."""
        return len(self.slider.marks) - 1.0 if self.slider is not None else 0.0


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
        Entries in, the descriptions of the inputs out, each path once.
    check : callable
        Parses the text of a file; it takes the text and its name, and raises `ConfigError`.
    screens : tuple of Screen
        In the order in which results are handed on.
    aside : mapping
        Initial entries that are not part of the file, such as options of a command.
    in_fields : callable
        The tables of a file as the form has them, each value at the path of its input.
    headings : mapping
        Words above the tables of the form; those of a table's name where there are none.
    idle : callable
        Entries in, paths of inputs out that mean nothing beside them: shown only where something is given.
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
        """Entries for the text of a file, which the parser of the commands accepts.

        Raises
        ------
        ConfigError
            If it does not.
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
