"""The program ``brakes app``: screens and documents (input files with screens) of each type of brake."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from beamdyn.common.edge.config import ConfigError, parse
from beamdyn.common.edge.console import table
from beamdyn.common.edge.input_sweep import InputSweep
from beamdyn.common.edge.rendering import drawing, html, picture
from beamdyn.common.edge.units import show
from beamdyn.common.edge.views import tables_of
from beamdyn.common.results.pictures import figure_of
from beamdyn.common.screens.screens import Backwards, Document, FoldedPart, Program, Screen, Sweeps
from brakes.answers import STANDARD, caliper, forklift
from brakes.answers.base import BrakeType
from brakes.answers.finding import find_in_file
from brakes.answers.forklift import ForkliftAnswer, stage_outputs
from brakes.answers.tables import list_outputs
from brakes.app.bases import base
from brakes.app.mechanism_lists import LISTS
from brakes.config.mechanism import CaliperInput, MechanismInput, parse_mechanism
from brakes.reproduce.forklift_as_printed import answer_as_printed

HEADINGS = {
    "": "What it is",
    "stop": "Road and stop",
    "levers": "Levers, without a geometry",
    "run": "Stroke and hand",
    "caliper": "Cable and pads",
}


def make_document(
    brake: BrakeType[Any], screens: tuple[Screen, ...] = (), check: Callable[[str, str], object] | None = None
) -> Document:
    """Make a document of a type of brake, which opens with the example file that has the brake's name.

    Parameters
    ----------
    brake : BrakeType
        Type of brake whose file is the document.
    screens : tuple of Screen
        Screens of the document; by default the screen of the type of brake.
    check : callable, optional
        ``check(text, name)`` raises `ConfigError` if a file is not for this document; by default it
        is checked as by the commands.
    """

    def accept(text: str, source: str) -> object:
        return brake.read(parse(text, source), source)

    return Document(
        brake.name,
        base(brake.name),
        lambda entries: brake.inputs(_nest(entries)),
        check or accept,
        screens or (make_screen(brake),),
        headings=HEADINGS,
        idle=brake.idle,
    )


def _nest(entries: Mapping[str, str]) -> dict[str, Any]:
    """Convert the entries of a form, by "table.key", to nested tables."""
    tables: dict[str, Any] = {}
    for path, text in entries.items():
        table, dot, key = path.partition(".")
        if dot:
            tables.setdefault(table, {})[key] = text
        else:
            tables[table] = text
    return tables


def make_screen(brake: BrakeType[Any], *more: FoldedPart) -> Screen:
    """Make the screen of a type of brake; `more` are further parts of the screen that fold out."""
    return Screen(
        brake.title,
        brake.purpose,
        brake.sections,
        brake.needs,
        lambda tables: brake.answer(tables, brake.name),
        lambda answer: answer.tables(),
        lambda answer, place: answer.figure(place),
        lambda answer: (*answer.refusals, *answer.warnings),
        lambda answer: answer.rows(),
        slider=brake.slider,
        sweeps=make_sweeps(brake),
        backwards=_make_backwards(brake),
        more=(*(FoldedPart.of_drawings(*each) for each in brake.more.items()), *more),
        handles=lambda answer, place: answer.handles(place),
        drawings=lambda answer, place: answer.drawings(place),
        charts=lambda answer, place: answer.charts(place),
        coarser=brake.coarser,
        headline=lambda answer: [*brake.headline(answer)],
        sketch=brake.sketch,
        branches=lambda answer: answer.branches(),
        effort="The solution takes longer with more positions of the stroke and more joints with friction.",
    )


def make_sweeps(brake: BrakeType[Any]) -> Sweeps:
    """Make the screen's sweeps of a type of brake: any output over one input."""

    def names(tables: Mapping[str, Any]) -> list[str]:
        return [output.name for output in brake.outputs(brake.read(tables, brake.name))]

    def run(tables: Mapping[str, Any], text: str, results: str) -> InputSweep:
        return brake.sweep(tables, brake.name, [text], results, ("sweep", "results"))[0]

    return Sweeps(names, brake.example_sweep, brake.sweep_results, run)


def _make_backwards(brake: BrakeType[Any]) -> Backwards:
    """Make the screen's inverse questions: the value of any input that gives a wanted value of an output."""

    def units(tables: Mapping[str, Any]) -> dict[str, str]:
        return {output.name: output.unit for output in brake.outputs(brake.read(tables, brake.name))}

    def find(tables: Mapping[str, Any], sought: str, so_that: str) -> str:
        found = find_in_file(brake, tables, brake.name, sought, so_that)
        drawn = picture(drawing(lambda: figure_of(found.plot)), found.message)
        return html([*found.refusals, *found.warnings, tables_of(found)]) + drawn

    results = [*(name for _, name in brake.key_results), *brake.sweep_results.split(",")]
    return Backwards(units, brake.example_sweep.partition("=")[0], results[0], find)


# The forklift: vehicle, kinematics and internal forces; later screens use results of earlier ones --------


def _as_printed(answer: ForkliftAnswer) -> str:
    """Make an HTML table that compares the results with those by the paper's equations of the stop.

    The equations are used as printed, with their errors.
    """
    printed = answer_as_printed(answer.design, answer.stages) or answer
    rows = list_outputs(stage_outputs(answer.stages), [answer, printed])
    return html([table("", ("", "corrected", "as printed", "unit"), rows, (0, 3))])


_PAPER = FoldedPart("As the paper prints", _as_printed, _as_printed)
VEHICLE = make_screen(forklift.TYPES["vehicle"], _PAPER)
KINEMATICS = make_screen(forklift.TYPES["kinematics"])
FORCES = make_screen(forklift.TYPES["forces"], _PAPER)
FORKLIFT = make_document(forklift.FORKLIFT, (VEHICLE, KINEMATICS, FORCES))


# Calipers, given by name with their dimensions, and mechanisms, given by bodies and joints -----------------


def check_caliper(text: str, source: str) -> CaliperInput:
    """Parse the file of a named caliper; raises `ConfigError` if it describes another mechanism."""
    design = parse_mechanism(text, source)
    if not isinstance(design, CaliperInput):
        raise ConfigError(source, ["caliper: missing; a mechanism of bodies has a screen of its own"])
    return design


def check_mechanism(text: str, source: str) -> MechanismInput:
    """Parse the file of a mechanism given by its bodies and joints.

    Raises
    ------
    ConfigError
        If the file names a caliper, or a point has a name that the form's paths cannot hold.
    """
    design = parse_mechanism(text, source)
    if not isinstance(design, MechanismInput):
        raise ConfigError(source, ["caliper: it is a named caliper, which has a screen of its own"])
    if dotted := [name for name in design.points if "." in name]:
        raise ConfigError(
            source, [f"points: {show(dotted[0])} has a dot; give the point another name, e.g. with a dash"]
        )
    return design


CALIPER = make_document(caliper.CALIPER, check=check_caliper)
MECHANISM = make_document(
    caliper.MECHANISM, (replace(make_screen(caliper.MECHANISM), lists=LISTS),), check=check_mechanism
)


_STANDARD = (make_document(load()) for _, load in STANDARD.values())
BRAKES = Program("brakes", "Brakes", (FORKLIFT, *_STANDARD, CALIPER, MECHANISM))
