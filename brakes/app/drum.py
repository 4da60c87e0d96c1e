"""The drum brake's screen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.figure import Figure
from rich.console import RenderableType

from beamdyn.common.app.screens import Document, Screen, Sweeps
from beamdyn.common.edge.inputs import describe
from brakes.answers.tables import drum_outputs, drum_tables, outputs_csv
from brakes.app.bases import base
from brakes.app.handles import of_drum
from brakes.config.drum import DrumInput, drum_from_dict, parse_drum
from brakes.config.sweeps import InputSweep, chosen, parse_axis, replaced, sweep
from brakes.drawings.drum import brake_figure
from brakes.drum import BrakeResult


def solve(tables: Mapping[str, Any]) -> BrakeResult:
    """Forces in the brake."""
    return drum_from_dict(tables).solve()


def report(found: BrakeResult) -> Sequence[RenderableType]:
    """The brake as a whole, and shoe by shoe."""
    return [drum_tables(found)]


def draw(found: BrakeResult, _: float = 0.0) -> Figure:
    """Free bodies, pressures and factors."""
    return brake_figure(found)


def notes(found: BrakeResult) -> Sequence[str]:
    """Why there is no answer, if it locks."""
    return (found.message,) if found.locked else ()


def run_sweep(tables: Mapping[str, Any], text: str, results: str) -> InputSweep:
    """A sweep of one input."""
    design = drum_from_dict(tables)
    axes = [parse_axis(design, text, "sweep")]
    wanted = chosen(drum_outputs(len(design.core.shoes)), results, "results")
    return sweep(axes, wanted, replaced(design, axes).solve())


_TABLES = ("brake", "shoe", "second_shoe", "load")
DRUM = Document(
    "drum",
    base("drum"),
    lambda _: describe(DrumInput),
    parse_drum,
    (
        Screen(
            "Drum brake",
            "A brake with shoes on fixed pins: torque, pressure, pin reactions, and when it locks itself.",
            _TABLES,
            _TABLES,
            solve,
            report,
            draw,
            notes,
            lambda found: outputs_csv(drum_outputs(len(found.shoes)), value=found),
            handles=lambda found, _: of_drum(found),
            sweeps=Sweeps(
                lambda _: [output.name for output in drum_outputs()],
                "brake.friction=0.1:0.6:26",
                "torque,c_star",
                run_sweep,
            ),
        ),
    ),
)
