"""Base classes of all types of brakes, from which their commands, screens and HTML reports are made."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from time import perf_counter
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

import numpy as np
from pydantic import BaseModel
from rich.console import RenderableType

from beamdyn._version import __version__
from beamdyn.common.drawing.chart import Chart
from beamdyn.common.drawing.sheet import Rows
from beamdyn.common.edge.config import in_words_of_file, parse, path_of, read, said_of, validated
from beamdyn.common.edge.exit_codes import NoAnswer
from beamdyn.common.edge.input_sweep import (
    MOST_ONE_BY_ONE,
    CaseTask,
    InputSweep,
    Output,
    SolvedCases,
    chosen,
    one_by_one,
    solve_cases,
    swept,
)
from beamdyn.common.edge.inputs import Input, describe
from beamdyn.common.edge.varied_inputs import MOST_AT_ONCE, Axis, designs_of, parse_axis
from beamdyn.common.inputs.array_checks import solve_possible
from beamdyn.common.inputs.designs import Designs, VariedInput, check_designs, with_parts
from beamdyn.common.parallel.tasks import TaskRunner
from beamdyn.common.results.one_line import counted, error_at_most
from beamdyn.common.results.result import Provenance, Result, plain
from beamdyn.common.screens.screen_parts import Handle, KeyResult, Slider
from brakes.answers.tables import format_number

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FileModel = TypeVar("FileModel", bound=BaseModel)


@dataclass(frozen=True)
class Answer(Result, ABC):
    """The answer to one design of a brake: a frozen dataclass of results; see `BrakeType`.

    Attributes
    ----------
    design : BaseModel
        Design of the file, in SI.
    provenance : Provenance, optional
        Version, method, how the error was found, and the time taken; `BrakeType.answer` adds it.
    """

    design: BaseModel
    provenance: Provenance | None = field(default=None, kw_only=True)

    def headline(self) -> Iterator[str]:
        """Headlines of its parts, its error, and the number of refusals; see `Result.headline`."""
        parts = (getattr(self, each.name) for each in fields(self))
        said = (line for part in parts if isinstance(part, Result) for line in part.headline())
        yield from dict.fromkeys((*said, error_at_most(self.error)))
        yield counted(len(self.refusals), "refusal") if self.refusals else ""

    @property
    @abstractmethod
    def error(self) -> Any:
        """Relative error of the numbers as `BrakeType.error_from` says; nan where there is none to state."""

    @property
    def warnings(self) -> Sequence[str]:
        """Doubts although there is an answer: one sentence each."""
        return ()

    @property
    def refusals(self) -> Sequence[str]:
        """Why the model has no answer, such as a brake that locks: one sentence each, none if it has."""
        return ()

    def refusals_of_cases(self, count: int) -> dict[int, str]:
        """Why designs have no answer, by row, where `count` designs were solved together."""
        return {}

    def loadable(self) -> Result | None:
        """The result of the mechanics if the answer consists of a single one, which is saved; else None."""
        return None

    @abstractmethod
    def tables(self) -> list[RenderableType]:
        """Tables and sentences, for the console, the screen and the HTML report."""

    @abstractmethod
    def rows(self) -> Iterable[Sequence[object]]:
        """Rows of the CSV file, headings first."""

    @abstractmethod
    def values(self) -> dict[str, Any]:
        """The results as plain numbers, lists and strings."""

    def to_dict(self) -> dict[str, Any]:
        """Results, refusals, inputs, error and provenance as plain numbers, lists and strings."""
        made = {"refusals": self.refusals, "inputs": self.design.model_dump()}
        made |= {"error": self.error, "provenance": self.provenance}
        return self.values() | {key: plain(value) for key, value in made.items()}

    @abstractmethod
    def figure(self, place: float | None = None) -> Figure:
        """Draw it.

        Parameters
        ----------
        place : float, optional
            Position of the screen's slider; if not given, the picture is that of command and HTML report.
        """

    def drawings(self, place: float) -> Rows:
        """Drawings of the machine, row by row, with the slider at a position; none if it is not drawn."""
        return ()

    def charts(self, place: float) -> Sequence[Chart]:
        """Charts of the figure, besides its drawings, with the slider at a position."""
        return ()

    def branches(self) -> Mapping[str, Answer]:
        """The answer with each of its solutions drawn, by their names; none if there is only one."""
        return {}

    def handles(self, place: float) -> Sequence[Handle]:
        """Points of the first drawing that can be moved, with the slider at a position."""
        return ()


@dataclass(frozen=True)
class BrakeSweep(InputSweep):
    """Results of a brake over its inputs.

    Attributes
    ----------
    design : dict
        The design that is varied, as plain numbers, lists and strings in SI.
    error : ndarray, shape (n1, ..., nd)
        As `Answer.error`, of each design.
    provenance : Provenance, optional
        As in `Answer`.
    """

    design: dict[str, Any] = field(default_factory=dict)
    error: np.ndarray = field(default_factory=lambda: np.array([]))
    provenance: Provenance | None = None


@dataclass(frozen=True)
class SweepRequest:
    """Designs that are asked for.

    Parameters
    ----------
    design : BaseModel
        The design whose inputs are varied.
    tables : mapping
        Tables of its file.
    axes : sequence of Axis
        The inputs.
    combine : {"product", "zip"}
        Whether the inputs are combined each with each, or taken together.
    run : TaskRunner, optional
        Runs the tasks of designs that are solved one by one; by default in this process.
    """

    design: Any
    tables: Mapping[str, Any]
    axes: Sequence[Axis]
    combine: str
    run: TaskRunner | None


class BrakeType(ABC, Generic[FileModel]):
    """A type of brake: how its TOML file is read and solved, and what is shown.

    Command, screen and HTML report ask only this class and `Answer`. To add a type of brake ``name``:

    1. Its mechanics is a room of its own, ``brakes/name``, entered among the layers in ``pyproject.toml``:
       SI floats or arrays in, a frozen `Result` out, no input or output.
    2. Each input is described once: `Described` in the annotation of a field of a core class, from which
       `section_of` makes the table of the file, or `Quantity` in a `Section` where there is no such class.
       ``brakes/config/name.py`` has the `Section` with a field for each table.  The form, the inputs that
       can be swept and the messages about mistakes follow from it; `keep_checked` checks the core's fields.
    3. ``brakes/drawings/name.py`` draws the result: the machine as a `Drawing`, curves as a `Chart`.
    4. ``brakes/answers/name.py`` derives from `Answer` and from `BrakeType`, sets the attributes below and
       writes `solve` and `outputs`; the answer's `values` go into JSON, with inputs, `error` and provenance.
       Where the mechanics takes arrays derive from `ArrayBrakeType`, which sweeps all cases at once, else
       from `TableBrakeType`, which sweeps them one by one. An instance named ``BRAKE`` stands at the end of
       the module.
    5. `solve` raises ValueError for bad input. A design without an answer is no exception: `solve` returns
       an `Answer` whose `refusals` say why, so that its tables are still shown; a command then ends with
       exit code 1. Only where nothing can be shown, `NoAnswer` is raised.
    6. An `Output` takes its number, in SI, from the `Answer`; if the design has arrays, an array.  A field of
       a result that is annotated by `Meaning` says its words and unit itself: `take_fields`.
    7. ``examples/name.toml``, or ``brakes/app/bases/name.toml``, is the example with which the screen opens.
    8. A line in `brakes.answers.STANDARD` adds the command and the screen.

    Attributes
    ----------
    name : str
        Name of its command, and of its file without the suffix.
    title : str
        Title of its screen.
    purpose : str
        Purpose of its screen, in a sentence.
    method : str
        Method of solution, in a phrase.
    error_from : str
        Meaning of the error of an answer, in a phrase.
    sections : tuple of str
        Tables on its form; "" for inputs outside any table.
    needs : tuple of str
        Tables, or inputs outside any, that the answer depends on.
    example_sweep : str
        Sweep that its screen shows at first, such as "brake.friction=0.1:0.6:26".
    sweep_results : str
        Results of a sweep if none are named, separated by commas.
    slider : Slider, optional
        Slider on which its drawings depend.
    more : mapping of str to callable
        Further drawings, which fold out on its screen: ``more[title](answer)`` are rows of them.
    most_cases : int
        Largest number of designs of a sweep.
    together : str
        Which tables or keys of its file go together, in a sentence; "" if that is plain.
    key_results : tuple of (words, name)
        The outputs that stand first on its screen: how they are called there, and their names.
    """

    name: ClassVar[str]
    title: str
    purpose: str
    method: str
    error_from: str
    sections: tuple[str, ...]
    needs: tuple[str, ...]
    example_sweep: str
    sweep_results: str
    slider: Slider | None = None
    more: Mapping[str, Callable[[Any], Rows]] = MappingProxyType({})
    most_cases: int = MOST_ONE_BY_ONE
    together: str = ""
    key_results: tuple[tuple[str, str], ...] = ()

    def headline(self, answer: Answer) -> Iterator[KeyResult]:
        """The results that stand first on the screen; without key results the first outputs."""
        outputs = {output.name: output for output in self.outputs(answer.design)}  # type: ignore[arg-type]
        for words, name in self.key_results or self._first(answer, outputs):
            value = float(outputs[name].shown(answer))
            if not math.isnan(value):
                unit = outputs[name].unit if math.isfinite(value) else ""
                yield KeyResult(words, f"{format_number(value)} {unit}".rstrip())

    def _first(self, answer: Answer, outputs: Mapping[str, Output]) -> Sequence[tuple[str, str]]:
        """Words and names of the results that stand first where there are no key results."""
        return [(output.words, name) for name, output in [*outputs.items()][:2]]

    @abstractmethod
    def read(self, tables: Mapping[str, Any], source: str) -> FileModel:
        """Design that tables describe; raises `ConfigError` with all mistakes."""

    def coarser(self, tables: Mapping[str, Any]) -> Mapping[str, Any]:
        """Tables of a design that is drawn the same and solved sooner."""
        return tables

    def sketch(self, entries: Mapping[str, str]) -> Rows:
        """Drawings that show what the symbols of its form mean, for what is chosen there."""
        return ()

    @abstractmethod
    def solve(self, design: FileModel) -> Answer:
        """Answer to a design; raises ValueError for bad input, `NoAnswer` if nothing can be shown."""

    @abstractmethod
    def outputs(self, design: FileModel) -> Sequence[Output]:
        """Numbers of the answer that can be named."""

    @abstractmethod
    def inputs(self, tables: Mapping[str, Any]) -> list[Input]:
        """Inputs of the form, for tables as far as they are filled in."""

    @property
    def optional(self) -> Collection[str]:
        """Tables of the file that may be left out."""
        return ()

    def idle(self, entries: Mapping[str, str]) -> Iterable[str]:
        """Paths of inputs that have no effect beside these entries; see `Document`."""
        return ()

    @abstractmethod
    def sweep_inputs(self, design: FileModel, tables: Mapping[str, Any]) -> Sequence[Input]:
        """Numbers of a design that can be swept."""

    @abstractmethod
    def sweep_cases(self, asked: SweepRequest, outputs: Sequence[Output]) -> tuple[InputSweep, Sequence[str]]:
        """Results of the designs that are asked for, and warnings."""

    def answer(self, tables: Mapping[str, Any], source: str) -> Answer:
        """Answer to the design of tables, with its provenance; raises what `read` and `solve` raise."""
        start, design = perf_counter(), self.read(tables, source)
        with in_words_of_file(type(design), tables, source):
            answer = self.solve(design)
        return replace(answer, provenance=self._provenance(start))

    def _provenance(self, start: float) -> Provenance:
        return Provenance(__version__, self.method, self.error_from, perf_counter() - start)

    def open(self, name: str) -> tuple[Mapping[str, Any], str]:
        """Tables and text of a file; raises `ConfigError` if it cannot be read or is not TOML."""
        text = read(name)
        return parse(text, name), text

    def default_results(self, design: FileModel) -> str:
        """Results of a sweep of a design if none are named."""
        return self.sweep_results

    def sweep(
        self,
        tables: Mapping[str, Any],
        source: str,
        texts: Sequence[str],
        results: str | None = None,
        options: tuple[str, str] = ("--vary", "--what"),
        combine: str = "product",
        run: TaskRunner | None = None,
    ) -> tuple[BrakeSweep, Sequence[str]]:
        """Answer all designs that inputs make.

        Parameters
        ----------
        tables : mapping
            Tables of the design's file.
        source : str
            Their origin, for messages.
        texts : sequence of str
            Inputs and their values, such as "stop.speed=10:30:9 km/h".
        results : str, optional
            Names of outputs, separated by commas.
        options : pair of str
            Options that give inputs and results, for messages.
        combine : {"product", "zip"}
            Whether the inputs are combined each with each, or taken together.
        run : TaskRunner, optional
            Runs the tasks of designs that are solved one by one; by default in this process.

        Returns
        -------
        sweep : BrakeSweep
            The results.
        warnings : sequence of str
            Where there is no answer and why, and what else to look at.

        Raises
        ------
        ValueError
            If an input or a result is not known, an input is given twice, or there are too many designs.
        NoAnswer
            If no design has an answer.
        """
        start, design = perf_counter(), self.read(tables, source)
        wanted = chosen(
            self.outputs(design), self.default_results(design) if results is None else results, options[1]
        )
        inputs = self.sweep_inputs(design, tables)
        axes = [parse_axis(inputs, text, options[0]) for text in texts]
        check_designs(designs_of(axes, combine), self.most_cases, options[0])
        asked = SweepRequest(design, tables, axes, combine, run)
        made, warnings = self.sweep_cases(asked, [*wanted, ERROR])
        given = {entry.name: getattr(made, entry.name) for entry in fields(made)}
        given |= {key: given[key][:-1] for key in ("results", "result_units", "found")}  # without the error
        more = {"design": plain(design.model_dump()), "provenance": self._provenance(start)}
        return BrakeSweep(**given, **more, error=made.found[-1]), warnings


ERROR = Output("error", "relative error", lambda answer: answer.error)


class ArrayBrakeType(BrakeType[FileModel]):
    """A type of brake whose mechanics takes arrays: all designs of a sweep are solved at once.

    Attributes
    ----------
    model : type
        Description of its file.
    """

    model: type[FileModel]
    most_cases = MOST_AT_ONCE

    def read(self, tables: Mapping[str, Any], source: str) -> FileModel:
        """Design that tables describe."""
        return validated(self.model, tables, source)

    def inputs(self, tables: Mapping[str, Any]) -> list[Input]:
        """Inputs of the form: those of the model."""
        return describe(self.model)

    @property
    def optional(self) -> Collection[str]:
        """Tables of the model that it does not require."""
        return [name for name, field in self.model.model_fields.items() if not field.is_required()]

    def sweep_inputs(self, design: FileModel, tables: Mapping[str, Any]) -> Sequence[Input]:
        """Numbers in those tables that the design has, and choices, which are refused by their names."""
        there = [entry for entry in describe(type(design)) if getattr(design, entry.path.partition(".")[0])]
        return [each for each in there if each.quantity.unit or each.quantity.symbol or each.choices]

    def sweep_cases(self, asked: SweepRequest, outputs: Sequence[Output]) -> tuple[InputSweep, Sequence[str]]:
        """Results from one answer whose numbers are arrays."""
        designs = designs_of(asked.axes, asked.combine)
        in_si = Designs([VariedInput(a.input.path, "", a.values) for a in asked.axes], asked.combine)
        columns, paths = in_si.columns(), [entry.path for entry in describe(type(asked.design))]
        answer, rows, errors = solve_possible(
            lambda rows: self.solve(with_parts(asked.design, {name: x[rows] for name, x in columns.items()})),
            designs.count,
        )
        values = np.full((len(outputs), designs.count), np.nan)
        refused = {
            row: said_of(each, path_of(each, paths) or each.field, None) for row, each in errors.items()
        }
        if answer is None:
            made = swept(designs, outputs, [*values], (), refused)
            return made, made.warnings
        values[:, rows] = [np.broadcast_to(output.shown(answer), rows.shape) for output in outputs]
        made = swept(designs, outputs, [*values], answer.refusals, refused)
        # Reasons are given only for designs that lack one of the wanted results.
        lacking, why = np.any(np.isnan(values[:-1]), axis=0).tolist(), answer.refusals_of_cases(len(rows))
        unanswered = {int(rows[i]): said for i, said in why.items() if lacking[rows[i]]}
        made = replace(made, unanswered=tuple(sorted(unanswered.items())))
        return made, (*answer.warnings, *made.warnings)


class TableBrakeType(BrakeType[FileModel]):
    """A type of brake whose mechanics takes one design: those of a sweep are solved one by one."""

    def sweep_cases(self, asked: SweepRequest, outputs: Sequence[Output]) -> tuple[InputSweep, Sequence[str]]:
        """Results design by design; nan where there is no answer."""
        made = one_by_one(asked.tables, asked.axes, outputs, self.solve_task, asked.combine, asked.run)
        return made, made.warnings

    def solve_task(self, task: CaseTask) -> SolvedCases:
        """Solve the designs of a task, here or in a worker."""

        def solve_determined(tables: Mapping[str, Any]) -> Answer:
            answer = self.solve(self.read(tables, self.name))
            if answer.refusals:
                raise NoAnswer("; ".join(answer.refusals))
            return answer

        outputs = self.outputs(self.read(task.tables, self.name))
        return solve_cases(task, [*outputs, ERROR], solve_determined)
