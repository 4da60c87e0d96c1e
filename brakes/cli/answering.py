"""The program `brakes`, and what every command on a brake does: read, solve, write files, print, warn."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import App, Parameter

from beamdyn._version import __version__
from beamdyn.common.edge import exit_codes
from beamdyn.common.edge.exit_codes import NoAnswer
from beamdyn.common.edge.outputs import Outputs, write
from beamdyn.common.edge.progress import at_work
from beamdyn.common.edge.tables import show
from beamdyn.common.edge.varying import OPTION, SPREAD, SpreadOptions, VaryOptions

if TYPE_CHECKING:
    from brakes.answers.base import Answer, BrakeType


# The program ``brakes`` ----------------------------------------------------------------------------------


app = App(
    name="brakes",
    version=lambda: version("beamdyn"),
    help="""Statics of brakes: calipers, drums, bands, discs, cones, blocks, a forklift's brake, vehicles.

Inputs are TOML files with units; `brakes COMMAND --help` lists the options of a command.""",
    help_epilogue=exit_codes.EXIT_CODES,
    help_format="markdown",
    suppress_keyboard_interrupt=False,
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; see `beamdyn.common.edge.exit_codes.run`."""
    return exit_codes.run(app, arguments)


What = Annotated[str | None, Parameter(name="--what")]
Files = Mapping[str, tuple[Path | None, Callable[["Answer", Path], object]]]


def run_command(
    brake: BrakeType[Any],
    command: str,
    file: str,
    varying: VaryOptions,
    spreading: SpreadOptions,
    what: str | None,
    outputs: Outputs,
    further: Files | None = None,
    **options: object,
) -> None:
    """Answer a file, write the files asked for and print the answer.

    Parameters
    ----------
    brake : BrakeType
        What the file describes.
    command : str
        Name of the command.
    file : str
        The file.
    varying : VaryOptions
        Inputs that are varied.
    spreading : SpreadOptions
        Inputs that have a tolerance.
    what : str, optional
        Names of the results of these.
    outputs : Outputs
        Files to write.
    further : mapping, optional
        Further options that name a file: the file, if given, and what writes it.
    **options
        Options of the command that the HTML report repeats.

    Raises
    ------
    NoAnswer
        If the model has no answer; what there is has been shown.
    ValueError
        For bad input.
    """
    from beamdyn.common.edge.html_report import Question, Report
    from beamdyn.common.edge.views import picture_of, rows_of, tables_of

    written = {option: path for option, (path, _) in (further or {}).items()}
    outputs.check(file, **written)
    tables, text = brake.open(file)
    given = varying.options | spreading.options
    question = Question.of(f"brakes {command}", file, text, **options, **given, what=what)
    spreading.check(varying)
    many = OPTION if varying.vary else SPREAD if spreading.spread else ""
    for option, path in written.items():
        if many and path is not None:
            raise ValueError(f"--{option} = {path}: it is of one design; leave {many} out")
    if not spreading.spread:
        varying.check()
    if not many and what is not None:
        raise ValueError(f"--what goes with --vary or {SPREAD}: without them, all results are shown")
    if many:
        made, warnings, none = _answer_many(brake, tables, file, varying, spreading, what)
        said, more = warnings, ()
    else:
        made = brake.answer(tables, file)
        warnings, none = made.warnings, "; ".join(made.refusals)
        said, more = [*made.refusals, *warnings], _folded(brake, made) if outputs.report else ()
    shown = [tables_of(made)]
    write(made, outputs, rows_of(made), picture_of(made), Report(question, shown, said, more))
    for path, save in (further or {}).values():
        if path is not None:
            save(made, path)
    show(shown)
    exit_codes.warn("brakes", warnings)
    if none:
        raise NoAnswer(none)


def _folded(brake: BrakeType[Any], answer: Answer) -> Sequence[tuple[str, Callable[[], str]]]:
    """Titles of the further drawings of an answer, and what makes them for a report."""
    from beamdyn.common.screens.screens import FoldedPart

    folded = (FoldedPart.of_drawings(*each) for each in brake.more.items())
    return [(part.title, partial(part.in_report, answer)) for part in folded]


def _answer_many(
    brake: BrakeType[Any],
    tables: Mapping[str, Any],
    file: str,
    varying: VaryOptions,
    spreading: SpreadOptions,
    what: str | None,
) -> tuple[Any, Sequence[str], str]:
    """A sweep, or a spread over tolerances of inputs; warnings, and that none has an answer if so."""
    import numpy as np

    from brakes.answers.spread import spread_of_brake

    with at_work("designs") as progress:
        run = varying.runner("brakes study", (__version__, np.__version__), progress)
        if spreading.spread:
            how = spreading.samples, spreading.seed, run
            made = spread_of_brake(brake, tables, file, spreading.spread, what, *how)
            answered, warnings = not (made.scatter.no_answer == 1).all(), made.warnings
            none = f"none of {made.designs} random designs has an answer"
        else:
            made, warnings = brake.sweep(tables, file, varying.vary, what, combine=varying.combine, run=run)
            answered = any(np.isfinite(values).any() for values in made.found)
            none = f"at none of {made.designs.count} values is there an answer"
    return made, warnings, "" if answered else none
