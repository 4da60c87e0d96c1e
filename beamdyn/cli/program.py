"""The program ``beamdyn``."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING

from cyclopts import App

from beamdyn._version import __version__
from beamdyn.common.edge import program
from beamdyn.common.edge.outputs import Outputs, write

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import RenderableType

    from beamdyn.common.edge.html_report import Question
    from beamdyn.common.results import Result

app = App(
    name="beamdyn",
    version=__version__,
    help="""Vibration of rotating cantilevers: natural frequencies, buckling, motion in time, resonance.

A scene is a TOML file with units; `beamdyn COMMAND --help` lists the options of a command.""",
    help_epilogue=program.EXIT_CODES,
    help_format="markdown",
    suppress_keyboard_interrupt=False,
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; see `beamdyn.common.edge.program.run`."""
    return program.run(app, arguments)


def warn(warnings: Iterable[str]) -> None:
    """Print warnings on standard error."""
    program.warn("beamdyn", warnings)


def deliver(
    result: Result,
    outputs: Outputs,
    question: Question,
    tables: Sequence[RenderableType],
    rows: Iterable[Sequence[object]] = (),
    draw: Callable[[], Figure] | None = None,
    warnings: Sequence[str] = (),
    refusal: str = "",
) -> None:
    """Write the requested files, then print the result of a command and its warnings.

    Parameters
    ----------
    result, outputs, rows, draw
        As for `beamdyn.common.edge.outputs.write`.
    question : Question
        The command and its input, for the report.
    tables : sequence of rich renderables
        The result for people.
    warnings : sequence of str
        Warnings.
    refusal : str
        Why the model has no answer; empty if it has one.

    Raises
    ------
    NoAnswer
        With the refusal, after everything has been written.
    """
    from beamdyn.cautions import describe_choice, noted
    from beamdyn.common.columns import in_display_units
    from beamdyn.common.edge.html_report import Report
    from beamdyn.common.edge.tables import show

    draw = None if draw is None else noted(draw, result)
    refusals = [refusal] if refusal else []
    tables = [*tables, *describe_choice(result)]
    rows = in_display_units(rows, result.display_units)
    # The files of a long computation do not depend on who reads the tables.
    write(result, outputs, rows, draw, Report(question, tables, [*warnings, *refusals]))
    show(tables)
    warn(warnings)
    if refusal:
        raise program.NoAnswer(refusal)
