"""The caliper's screen: a named caliper with its dimensions, or a mechanism from a file."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from rich.console import Console, RenderableType
from rich.text import Text

from beamdyn.common.app.documents import Document, Screen, Slider
from beamdyn.common.config import ConfigError
from beamdyn.common.inputs import Input, describe
from beamdyn.common.program import NoAnswer
from brakes.app.bases import base
from brakes.calipers import NAMED, Caliper
from brakes.cli.caliper_answers import CaliperAnswer
from brakes.config.mechanism import CaliperInput, mechanism_from_dict, named, parse_mechanism
from brakes.config.wording import in_range
from brakes.drawings.caliper import draw_caliper
from brakes.drawings.mechanism_stroke import plot_advantage, plot_pad_ratio, plot_reactions
from brakes.planar import AssemblyError, OutOfReachError


def inputs_of(entries: Mapping[str, str]) -> list[Input]:
    """Inputs of the caliper that is named; those without dimensions where there is no such name."""
    name = entries.get("caliper", "")
    return describe(type(named(name)) if name in NAMED else CaliperInput)


def check(text: str, source: str) -> object:
    """Parse a file as the commands do; those that describe a mechanism part by part have no form.

    Raises
    ------
    ConfigError
        If it does not describe a named caliper.
    """
    given = parse_mechanism(text, source)
    if not isinstance(given, CaliperInput):
        raise ConfigError(
            source,
            [
                "it describes a mechanism part by part, which has no form; show it by "
                "`brakes caliper FILE.toml`, or open a file with caliper = NAME"
            ],
        )
    return given


def solve(tables: Mapping[str, Any]) -> CaliperAnswer:
    """The caliper over its stroke.

    Raises
    ------
    ConfigError
        If the tables do not describe a named caliper.
    NoAnswer
        If it cannot be assembled or does not reach the end of its stroke.
    """
    named_one = {"caliper": ""} | dict(tables)
    given = mechanism_from_dict(named_one)
    core = given.core
    assert isinstance(core, Caliper)
    try:
        with in_range():
            return CaliperAnswer.of(core, given)
    except (AssemblyError, OutOfReachError) as error:
        raise NoAnswer(str(error)) from None


class _Kept(Console):
    """A console that keeps what is printed."""

    def __init__(self) -> None:
        super().__init__(file=io.StringIO())
        self.kept: list[Any] = []

    def print(self, *objects: Any, **_: Any) -> None:
        self.kept += [Text(part) if isinstance(part, str) else part for part in objects]


def report(found: CaliperAnswer) -> Sequence[RenderableType]:
    """The tables and sentences that the command prints."""
    screen = _Kept()
    found.show(screen)
    return screen.kept


def draw(found: CaliperAnswer, progress: float = 1.0) -> Figure:
    """The caliper at a part of its stroke, from 0 to 1, and its curves over the stroke."""
    run = found.run
    place = float(np.interp(progress, (0.0, 1.0), run.cable[[0, -1]]))
    figure = Figure(figsize=(11.5, 7.6), layout="constrained")
    halves: Any = figure.subfigures(1, 2, width_ratios=(1.25, 1))
    closed = found.closed if progress >= 1 else found.caliper.equilibrium(place, run.finger_force)
    ax = draw_caliper(found.caliper, closed, halves[0].subplots())
    ax.set_title(
        f"{1e3 * place:.3g} mm of cable, {run.finger_force:g} N on the lever; grey: open", fontsize=11
    )
    curves = halves[1].subplots(3, 1, sharex=True, height_ratios=(1, 1, 1.6))
    plot_advantage(run.cable, run.advantage, curves[0])
    plot_pad_ratio(run.cable, run.pad_ratio, curves[1])
    plot_reactions(run.cable, run.magnitudes, curves[2])
    for axes in curves[:2]:
        axes.set_xlabel("")
    for axes in curves:
        axes.axvline(1e3 * place, color="0.4", linewidth=1, linestyle=":")
    return figure


def notes(found: CaliperAnswer) -> Sequence[str]:
    """Warnings, and why there is no answer."""
    refused = () if found.status == "determined" else (found.message,)
    return (*refused, *found.warnings)


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
            solve,
            report,
            draw,
            notes,
            lambda found: found.rows(),
            slider=Slider("stroke", ("open", "closed"), step=0.1),
        ),
    ),
)
