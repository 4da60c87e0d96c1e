"""The caliper's screen: a named caliper with its dimensions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from beamdyn.common.app.screens import Document, Screen, Slider, Sweeps
from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.input_sweep import InputSweep, chosen, numbers, one_by_one, parse_axis
from beamdyn.common.edge.inputs import Input
from brakes.answers import caliper_sweeps
from brakes.answers.caliper import Answer, CaliperAnswer, answer_to
from brakes.app.bases import base
from brakes.app.handles import of_caliper
from brakes.config.mechanism import CaliperInput, mechanism_from_dict, parse_mechanism
from brakes.config.mechanism_inputs import caliper_inputs, inputs_of_tables
from brakes.config.wording import in_range
from brakes.drawings.caliper import draw_caliper
from brakes.drawings.mechanism_stroke import plot_advantage, plot_pad_ratio, plot_reactions


def inputs_of(entries: Mapping[str, str]) -> list[Input]:
    """Inputs of the caliper that is named; those without dimensions where there is no such name."""
    return caliper_inputs(entries.get("caliper", ""))


def check(text: str, source: str) -> object:
    """Parse a file as the commands do.

    Raises
    ------
    ConfigError
        If it does not describe a named caliper.
    """
    given = parse_mechanism(text, source)
    if not isinstance(given, CaliperInput):
        raise ConfigError(source, ["caliper: missing; a mechanism of parts has a screen of its own"])
    return given


def solve(tables: Mapping[str, Any]) -> Any:
    """The caliper over its stroke, or the mechanism where the tables do not name a caliper.

    Raises
    ------
    ConfigError
        If the tables do not describe one.
    NoAnswer
        If it cannot be assembled or does not reach the end of its stroke.
    """
    with in_range():
        return answer_to(mechanism_from_dict(tables))


def draw(found: CaliperAnswer, progress: float = 1.0) -> Figure:
    """The caliper at a part of its stroke, from 0 to 1, and its curves over the stroke."""
    run = found.run
    place = float(np.interp(progress, (0.0, 1.0), run.cable[[0, -1]]))
    figure = Figure(figsize=(11.5, 7.6))  # laid out by hand: matplotlib's own way takes twice as long
    cells = figure.add_gridspec(
        3, 2, width_ratios=(1.25, 1), height_ratios=(1, 1, 1.6), wspace=0.2, hspace=0.08,
        left=0.065, right=0.985, bottom=0.075, top=0.94,
    )  # fmt: skip
    closed = found.closed if progress >= 1 else found.caliper.equilibrium(place, run.finger_force)
    ax = draw_caliper(found.caliper, closed, figure.add_subplot(cells[:, 0]))
    ax.set_title(
        f"{1e3 * place:.3g} mm of cable, {run.finger_force:g} N on the lever; grey: open", fontsize=11
    )
    curves = [figure.add_subplot(cells[row, 1]) for row in range(3)]
    plot_advantage(run.cable, run.advantage, curves[0])
    plot_pad_ratio(run.cable, run.pad_ratio, curves[1])
    plot_reactions(run.cable, run.magnitudes, curves[2])
    for axes in curves[:2]:
        axes.set_xlabel("")
        axes.tick_params(labelbottom=False)
    for axes in curves:
        axes.axvline(1e3 * place, color="0.4", linewidth=1, linestyle=":")
    return figure


def notes(found: Answer) -> Sequence[str]:
    """Warnings, and why there is no answer."""
    refused = () if found.status == "determined" else (found.message,)
    return (*refused, *found.warnings)


def run_sweep(tables: Mapping[str, Any], text: str, results: str) -> InputSweep:
    """A sweep of one input of a caliper or mechanism."""
    axis = parse_axis(numbers(inputs_of_tables(tables)), text, "sweep")
    wanted = chosen(caliper_sweeps.outputs_of(tables), results, "results")
    return one_by_one(tables, [axis], wanted, caliper_sweeps.solve)


def sweeps_of(example: str, results: str) -> Sweeps:
    """The sweeps of calipers and mechanisms."""
    return Sweeps(
        lambda tables: [o.name for o in caliper_sweeps.outputs_of(tables)], example, results, run_sweep
    )


_PARTS = ("caliper", "title", "dimensions", "run", "stop")
CALIPER = Document(
    "caliper",
    base("caliper"),
    inputs_of,
    check,
    (
        Screen(
            "Caliper",
            "A bicycle's caliper over its stroke: travels, forces, and the reaction of every joint.",
            ("", "run", "dimensions", "stop"),
            _PARTS,
            lambda tables: solve({"caliper": ""} | dict(tables)),
            lambda found: found.tables(),
            draw,
            notes,
            lambda found: found.rows(),
            sweeps=sweeps_of("dimensions.clearance=1:2:21 mm", "finger_travel"),
            more=(("Free bodies", lambda found: found.free_bodies()),),
            handles=lambda found, _: of_caliper(found.given),
            slider=Slider("stroke", ("open", "closed"), step=0.1),
        ),
    ),
)
