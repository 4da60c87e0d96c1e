"""Base classes of all types of brakes, from which their commands, screens and HTML reports are made."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from time import perf_counter
from types import MappingProxyType
from typing import Any, ClassVar, Generic, TypeVar

import numpy as np
from pydantic import BaseModel
from rich.console import RenderableType

from beamdyn.common.drawing.layout import Rows
from beamdyn.common.drawing.shapes import Chart
from beamdyn.common.edge.config import in_words_of_file, parse, read, said_of, validated
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
from beamdyn.common.edge.inputs import Input, describe, path_of
from beamdyn.common.edge.varied_inputs import MOST_AT_ONCE, Axis, designs_of, parse_axis
from beamdyn.common.inputs.array_checks import solve_possible
from beamdyn.common.inputs.described import Designs, VariedInput, check_designs, with_parts
from beamdyn.common.parallel.tasks import TaskRunner
from beamdyn.common.results.one_line import counted, error_at_most
from beamdyn.common.results.pictures import Figure
from beamdyn.common.results.result import Provenance, Result, plain
from beamdyn.common.screens.screen_parts import Handle, KeyResult, Slider
from brakes.answers.tables import format_number

FileModel = TypeVar("FileModel", bound=BaseModel)


@dataclass(frozen=True)
class Answer(Result, ABC):
    """Base of answers: the results for one design of a brake, as a frozen dataclass; see `BrakeType`.

    Attributes
    ----------
    design : BaseModel
        The design that the file describes, in SI.
    provenance : Provenance, optional
        Version, method, meaning of the error, and computing time; `BrakeType.answer` adds it.
    """

    design: BaseModel
    provenance: Provenance | None = field(default=None, kw_only=True)

    def headline(self) -> Iterator[str]:
        """Yield the parts of the answer's one-line summary; see `Result.headline`.

        They are the summaries of its results, the error, and the number of `refusals`, if there are any.
        """
        parts = (getattr(self, each.name) for each in fields(self))
        said = (line for part in parts if isinstance(part, Result) for line in part.headline())
        yield from dict.fromkeys((*said, error_at_most(self.error)))
        yield counted(len(self.refusals), "refusal") if self.refusals else ""

    @property
    @abstractmethod
    def error(self) -> Any:
        """Relative error of the numbers, as `BrakeType.error_from` defines it; nan if there is none."""

    @property
    def warnings(self) -> Sequence[str]:
        """Reasons to doubt the results, one sentence each."""
        return ()

    @property
    def refusals(self) -> Sequence[str]:
        """Reasons why the model has no result, such as a brake that locks, one sentence each."""
        return ()

    def refusals_of_cases(self, count: int) -> dict[int, str]:
        """Return the reasons why designs have no result, one sentence each, by the index of the design.

        `count` is the number of all designs.
        """
        return {}

    def loadable(self) -> Result | None:
        """Return the `Result` that can be saved to a file, if all results are in one object; else None."""
        return None

    @abstractmethod
    def tables(self) -> list[RenderableType]:
        """Make the tables and sentences for console, screen and HTML report."""

    @abstractmethod
    def rows(self) -> Iterable[Sequence[object]]:
        """Make the rows of the CSV file, the headings first."""

    @abstractmethod
    def values(self) -> dict[str, Any]:
        """Convert the results to plain numbers, lists and strings."""

    def to_dict(self) -> dict[str, Any]:
        """Convert results, refusals, inputs, error and provenance to plain numbers, lists and strings."""
        made = {"refusals": self.refusals, "inputs": self.design.model_dump()}
        made |= {"error": self.error, "provenance": self.provenance}
        return self.values() | {key: plain(value) for key, value in made.items()}

    @abstractmethod
    def figure(self, place: float | None = None) -> Figure:
        """Draw the figure of the results.

        Parameters
        ----------
        place : float, optional
            Position of the screen's slider; if not given, the figure is drawn as the command and the HTML
            report show it.
        """

    def drawings(self, place: float) -> Rows:
        """Make the drawings of the machine, row by row, for a position of the slider; by default none."""
        return ()

    def charts(self, place: float) -> Sequence[Chart]:
        """Make the charts that the figure has next to drawings, for a slider position; by default none."""
        return ()

    def branches(self) -> Mapping[str, Answer]:
        """Return copies of this answer, each of which draws a different one of several solutions, by name.

        An answer with only one solution returns an empty mapping.
        """
        return {}

    def handles(self, place: float) -> Sequence[Handle]:
        """Make the handles (points to drag) of the first drawing, for a position of the slider."""
        return ()


@dataclass(frozen=True)
class BrakeSweep(InputSweep):
    """Results of a brake over values of its inputs.

    Attributes
    ----------
    design : dict
        The design that is varied, as plain numbers, lists and strings in SI.
    error : ndarray, shape (n1, ..., nd)
        Relative error of each design, as in `Answer.error`.
    provenance : Provenance, optional
        Version, method, meaning of the error, and computing time, as in `Answer`.
    """

    design: dict[str, Any] = field(default_factory=dict)
    error: np.ndarray = field(default_factory=lambda: np.array([]))
    provenance: Provenance | None = None


@dataclass(frozen=True)
class SweepRequest:
    """A request for the results of many designs, made by varying inputs of one design.

    Parameters
    ----------
    design : BaseModel
        The design whose inputs vary.
    tables : mapping
        Tables of the design's file.
    axes : sequence of Axis
        The varied inputs, with their values.
    combine : {"product", "zip"}
        "product": every combination of values; "zip": the first values of all inputs, then the second, ...
    run : TaskRunner, optional
        Runs the tasks with designs that are solved one by one; by default in this process.
    """

    design: Any
    tables: Mapping[str, Any]
    axes: Sequence[Axis]
    combine: str
    run: TaskRunner | None


class BrakeType(ABC, Generic[FileModel]):
    """Base of types of brakes, which read and solve a TOML file and define the results to show.

    Command, screen and HTML report use only this class and `Answer`. To add a type of brake ``name``:

    1. Put its mechanics into a package of its own, ``brakes/name``, and add that to the layers in
       ``pyproject.toml``: SI floats or arrays in, a frozen `Result` out, no reading, printing or drawing.
    2. Describe each input once: with `Described` in the annotation of a field of a core class, from which
       `section_of` makes the file's table, or with `Quantity` in a `Section` if there is no such class.
       ``brakes/config/name.py`` has the `Section` with a field for each table.  The form, the inputs that
       can be swept, and the messages about mistakes are made from it; `keep_checked` checks the core's
       fields.
    3. Draw the result in ``brakes/drawings/name.py``: the machine as a `Drawing`, curves as a `Chart`.
    4. In ``brakes/answers/name.py``, derive from `Answer` and from `BrakeType`, set the attributes below and
       write `solve` and `outputs`; the answer's `values` go into JSON, with inputs, `error` and provenance.
       If the mechanics takes arrays, derive from `ArrayBrakeType`, which solves all designs of a sweep at
       once; else from `TableBrakeType`, which solves them one by one. Make an instance named ``BRAKE`` at the
       end of the module.
    5. `solve` raises ValueError for bad input. A design without an answer is not an exception: `solve`
       returns an `Answer` whose `refusals` say why, so that its tables are still shown; a command then
       ends with exit code 1. `NoAnswer` is raised only if nothing can be shown.
    6. An `Output` takes its number, in SI, from the `Answer`, as an array if the design has arrays.
       `take_fields` makes outputs of those fields of a result whose `Meaning` gives words and unit.
    7. ``examples/name.toml``, or ``brakes/app/bases/name.toml``, is the example that the screen opens with.
    8. Add a line to `brakes.answers.STANDARD`, which adds the command and the screen.

    Attributes
    ----------
    name : str
        Name of its command, and of its example file without the suffix.
    title : str
        Title of its screen.
    purpose : str
        Purpose of its screen, in one sentence.
    method : str
        Method of solution, as a phrase.
    error_from : str
        Meaning of an answer's error, as a phrase.
    sections : tuple of str
        Tables of its form; "" for inputs outside of any table.
    needs : tuple of str
        Tables, or inputs outside of any table, on which the answer depends.
    example_sweep : str
        Sweep that its screen shows first, such as "brake.friction=0.1:0.6:26".
    sweep_results : str
        Results of a sweep if the user names none, separated by commas.
    slider : Slider, optional
        Slider on which the drawings depend.
    more : mapping of str to callable
        Further drawings, which fold out on the screen: ``more[title](answer)`` gives rows of them.
    most_cases : int
        Largest number of designs in a sweep.
    together : str
        One sentence on which tables or keys must be given together in the file; "" if that is evident.
    key_results : tuple of (words, name)
        Outputs at the top of the screen: their words there, and their names.
    sketches : callable
        Makes drawings that explain the symbols of the input form, whatever its entries are.
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
    sketches: Callable[[], Rows] = staticmethod(tuple)

    def headline(self, answer: Answer) -> Iterator[KeyResult]:
        """Yield the results at the top of the screen: the key results, or else the first outputs."""
        outputs = {output.name: output for output in self.outputs(answer.design)}  # type: ignore[arg-type]
        for words, name in self.key_results or self._first(answer, outputs):
            value = float(outputs[name].shown(answer))
            if not math.isnan(value):
                unit = outputs[name].unit if math.isfinite(value) else ""
                yield KeyResult(words, f"{format_number(value)} {unit}".rstrip())

    def _first(self, answer: Answer, outputs: Mapping[str, Output]) -> Sequence[tuple[str, str]]:
        """Return words and names of the results at the top of the screen if the type has no key results."""
        return [(output.words, name) for name, output in [*outputs.items()][:2]]

    @abstractmethod
    def read(self, tables: Mapping[str, Any], source: str) -> FileModel:
        """Read the design that tables describe; raises `ConfigError` with all mistakes."""

    def coarser(self, tables: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return the tables of a simplified design that has the same drawing and is solved faster."""
        return tables

    def sketch(self, entries: Mapping[str, str]) -> Rows:
        """Make drawings that explain the symbols of the input form, for the entries given in it."""
        return self.sketches()

    @abstractmethod
    def solve(self, design: FileModel) -> Answer:
        """Solve a design; raises ValueError for bad input, `NoAnswer` if nothing can be shown."""

    @abstractmethod
    def outputs(self, design: FileModel) -> Sequence[Output]:
        """Describe the numbers that result from a design, which users can name and sweeps can show."""

    @abstractmethod
    def inputs(self, tables: Mapping[str, Any]) -> list[Input]:
        """Return the inputs that the form shows for the given tables, which may be incomplete."""

    @property
    def optional(self) -> Collection[str]:
        """Names of the file's tables that may be left out."""
        return ()

    def idle(self, entries: Mapping[str, str]) -> Iterable[str]:
        """Return the paths of inputs that have no effect with the given entries; see `Document`."""
        return ()

    @abstractmethod
    def sweep_inputs(self, design: FileModel, tables: Mapping[str, Any]) -> Sequence[Input]:
        """Describe the inputs of a design that are numbers, which a sweep can vary."""

    @abstractmethod
    def sweep_cases(self, asked: SweepRequest, outputs: Sequence[Output]) -> tuple[InputSweep, Sequence[str]]:
        """Solve the requested designs of a sweep; return their results, and warnings."""

    def answer(self, tables: Mapping[str, Any], source: str) -> Answer:
        """Read and solve the design that tables describe, and add the provenance to the answer.

        It raises the errors of `read` and `solve`.
        """
        start, design = perf_counter(), self.read(tables, source)
        with in_words_of_file(type(design), tables, source):
            answer = self.solve(design)
        return replace(answer, provenance=self._provenance(start))

    def _provenance(self, start: float) -> Provenance:
        return Provenance.since(start, self.method, self.error_from)

    def open(self, name: str) -> tuple[Mapping[str, Any], str]:
        """Read tables and text of a file; raises `ConfigError` if it cannot be read or is not TOML."""
        text = read(name)
        return parse(text, name), text

    def default_results(self, design: FileModel) -> str:
        """Return the names of the results of a sweep if the user names none, separated by commas."""
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
        """Solve all designs that result from varying inputs.

        Parameters
        ----------
        tables : mapping
            Tables of the design's file.
        source : str
            Origin of the tables, for messages.
        texts : sequence of str
            Inputs and their values, such as "stop.speed=10:30:9 km/h".
        results : str, optional
            Names of outputs, separated by commas; by default `default_results`.
        options : pair of str
            Names of the options that give inputs and results, for messages.
        combine : {"product", "zip"}
            "product": every combination of values; "zip": the first values of all inputs, then the second,
            ...
        run : TaskRunner, optional
            Runs the tasks with designs that are solved one by one; by default in this process.

        Returns
        -------
        sweep : BrakeSweep
            The results of all designs.
        warnings : sequence of str
            Which designs have no result and why, and other remarks.

        Raises
        ------
        ValueError
            If an input or a result is not known, an input is given twice, or there are too many designs.
        NoAnswer
            If no design has a result.
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
        # The last of the results is the error, which the sweep keeps in a separate field.
        given |= {key: given[key][:-1] for key in ("results", "result_units", "found")}
        more = {"design": plain(design.model_dump()), "provenance": self._provenance(start)}
        return BrakeSweep(**given, **more, error=made.found[-1]), warnings


ERROR = Output("error", "relative error", lambda answer: answer.error)


class ArrayBrakeType(BrakeType[FileModel]):
    """Base of types of brakes whose mechanics takes arrays: all designs of a sweep are solved at once.

    Attributes
    ----------
    model : type
        Pydantic model of the file.
    """

    model: type[FileModel]
    most_cases = MOST_AT_ONCE

    def read(self, tables: Mapping[str, Any], source: str) -> FileModel:
        """Read the design that tables describe."""
        return validated(self.model, tables, source)

    def inputs(self, tables: Mapping[str, Any]) -> list[Input]:
        """Return the inputs of the form: all inputs that the `model` of the file describes."""
        return describe(self.model)

    @property
    def optional(self) -> Collection[str]:
        """Names of the file's tables that may be left out."""
        return [name for name, field in self.model.model_fields.items() if not field.is_required()]

    def sweep_inputs(self, design: FileModel, tables: Mapping[str, Any]) -> Sequence[Input]:
        """Describe inputs in the design's tables: numbers, and choices, which sweeps refuse by a message."""
        there = [entry for entry in describe(type(design)) if getattr(design, entry.path.partition(".")[0])]
        single = [each for each in there if not each.quantity.is_list]
        return [each for each in single if each.quantity.unit or each.quantity.symbol or each.choices]

    def sweep_cases(self, asked: SweepRequest, outputs: Sequence[Output]) -> tuple[InputSweep, Sequence[str]]:
        """Solve all requested designs at once, as one design whose numbers are arrays."""
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
    """Base of types of brakes whose mechanics takes one design at a time: a sweep solves them in turn."""

    def sweep_cases(self, asked: SweepRequest, outputs: Sequence[Output]) -> tuple[InputSweep, Sequence[str]]:
        """Solve the requested designs one by one; results are nan where the model has none."""
        made = one_by_one(asked.tables, asked.axes, outputs, self.solve_task, asked.combine, asked.run)
        return made, made.warnings

    def solve_task(self, task: CaseTask) -> SolvedCases:
        """Compute the results of the designs of a task, in this process or in a worker process."""

        def solve_determined(tables: Mapping[str, Any]) -> Answer:
            answer = self.solve(self.read(tables, self.name))
            if answer.refusals:
                raise NoAnswer("; ".join(answer.refusals))
            return answer

        outputs = self.outputs(self.read(task.tables, self.name))
        return solve_cases(task, [*outputs, ERROR], solve_determined)
