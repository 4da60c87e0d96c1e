"""The program `brakes`, and what each of its commands does: read, solve, write files, print, and warn."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
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
from beamdyn.common.edge.varying import NO_SPREAD, NOTHING_VARIED, OPTION, SPREAD, SpreadOptions, VaryOptions

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
    """Run the command line, and return the exit code; see `beamdyn.common.edge.exit_codes.run`."""
    return exit_codes.run(app, arguments)


@Parameter(name="*")
@dataclass(frozen=True)
class FindOptions:
    """Options of an inverse question, for the value of an input that gives a wanted result.

    Parameters
    ----------
    find : str, optional
        An input whose values are sought, such as "brake.friction", from a tenth to ten times its value in the
        file; or, with bounds and a number of samples, between these: "brake.friction=0.1:0.6:51"; for whole
        numbers, each one between the bounds is tried.
    so_that : str, optional
        The result that the input shall give, such as "torque = 300 N m"; a wrong name lists all.
    """

    find: Annotated[str | None, Parameter(show_default=False)] = None
    so_that: Annotated[str | None, Parameter(show_default=False)] = None

    @property
    def options(self) -> dict[str, object]:
        """The options that are given, by name, for the head of a report."""
        return {"find": self.find, "so_that": self.so_that}

    def check(self, **others: object) -> None:
        """Refuse one of the two options without the other, and --find beside options on many designs."""
        if (self.find is None) != (self.so_that is None):
            raise ValueError(
                "--find and --so-that go together: the input that is sought, and what it is to give"
            )
        for name, given in others.items():
            if self.find is not None and given:
                raise ValueError(f"--{name} does not go with --find: give one of them")


@Parameter(name="*")
@dataclass(frozen=True)
class Asked:
    """Options that ask about many designs: variations, tolerances, or an inverse question.

    Parameters
    ----------
    varying : VaryOptions
        Inputs that are varied.
    spreading : SpreadOptions
        Inputs that have a tolerance.
    finding : FindOptions
        The input that is sought.
    what : str, optional
        Results with --vary or --spread, separated by commas; the file of --csv without them lists all names.
    """

    varying: VaryOptions = NOTHING_VARIED
    spreading: SpreadOptions = NO_SPREAD
    finding: FindOptions = field(default_factory=FindOptions)
    what: Annotated[str | None, Parameter(show_default=False)] = None

    @property
    def options(self) -> dict[str, object]:
        """The options that are given, by name, for the head of a report."""
        return self.varying.options | self.spreading.options | self.finding.options | {"what": self.what}

    @property
    def many(self) -> str:
        """Name of the option that asks about many designs; "" if the question is about one design."""
        given = {OPTION: self.varying.vary, SPREAD: self.spreading.spread, "--find": self.finding.find}
        return next((option for option, value in given.items() if value), "")

    def check(self) -> None:
        """Refuse options that do not go together, or that have no effect."""
        self.finding.check(vary=self.varying.vary, spread=self.spreading.spread, what=self.what)
        self.spreading.check(self.varying)
        if not self.spreading.spread:
            self.varying.check()
        if not self.many and self.what is not None:
            raise ValueError(f"--what goes with --vary or {SPREAD}: without them, all results are shown")


ONE_DESIGN = Asked()
Files = Mapping[str, tuple[Path | None, Callable[["Answer", Path], object]]]


def run_command(
    brake: BrakeType[Any],
    command: str,
    file: str,
    asked: Asked,
    outputs: Outputs,
    further: Files | None = None,
    **options: object,
) -> None:
    """Solve the design of a file, write the files that are asked for, and print the answer.

    Parameters
    ----------
    brake : BrakeType
        Type of the brake that the file describes.
    command : str
        Name of the command.
    file : str
        Path of the file with the design.
    asked : Asked
        Options that ask about many designs.
    outputs : Outputs
        Files to write.
    further : mapping, optional
        Further options that name a file to write: its path, if given, and the function that writes it.
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
    if not tables:
        raise ValueError(f"{file}: it has no tables yet; `brakes keys {command}` lists them with their keys")
    question = Question.of(f"brakes {command}", file, text, **options, **asked.options)
    asked.check()
    for option, path in written.items():
        if asked.many and path is not None:
            raise ValueError(f"--{option} = {path}: it shows one design; leave {asked.many} out")
    if asked.many:
        made, warnings, none = _answer_many(brake, tables, file, asked)
        said, more = [*[none] * bool(none), *warnings], ()
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
    """Return title and HTML of each further drawing of an answer, for a report."""
    from beamdyn.common.screens.screens import FoldedPart

    folded = (FoldedPart.of_drawings(*each) for each in brake.more.items())
    return [(part.title, partial(part.in_report, answer)) for part in folded]


def _answer_many(
    brake: BrakeType[Any], tables: Mapping[str, Any], file: str, asked: Asked
) -> tuple[Any, Sequence[str], str]:
    """Solve a sweep, a spread or an inverse question; return the result, warnings, and a refusal or ""."""
    import numpy as np

    from brakes.answers.finding import find_in_file
    from brakes.answers.spread import spread_of_brake

    if asked.finding.find and asked.finding.so_that:
        made = find_in_file(brake, tables, file, asked.finding.find, asked.finding.so_that)
        return made, made.warnings, "".join(made.refusals)
    varying, spreading = asked.varying, asked.spreading
    with at_work("designs") as progress:
        run = varying.runner("brakes study", (__version__, np.__version__), progress)
        if spreading.spread:
            how = spreading.samples, spreading.seed, run
            made = spread_of_brake(brake, tables, file, spreading.spread, asked.what, *how)
            answered, warnings = not (made.scatter.no_answer == 1).all(), made.warnings
            none = f"none of {made.designs} random designs has an answer"
        else:
            how = {"combine": varying.combine, "run": run}
            made, warnings = brake.sweep(tables, file, varying.vary, asked.what, **how)
            answered = any(np.isfinite(values).any() for values in made.found)
            none = f"at none of {made.designs.count} values is there an answer"
    return made, warnings, "" if answered else none
