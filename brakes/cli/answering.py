"""The program `brakes`, and what every command on a brake does: read, solve, write files, print, warn."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import App, Parameter

from beamdyn.common.edge import program
from beamdyn.common.edge.outputs import NO_FILES, Outputs, write
from beamdyn.common.edge.program import NoAnswer, examples
from beamdyn.common.edge.varying import NO_SPREAD, NOTHING_VARIED, SpreadOptions, VaryOptions
from beamdyn.common.edge.varying import OPTION as VARY
from beamdyn.common.edge.varying import SPREAD as OPTION

if TYPE_CHECKING:
    from beamdyn.common.edge.html_report import Question
    from brakes.answers.base import Answer, BrakeType


# The program ``brakes`` ----------------------------------------------------------------------------------


app = App(
    name="brakes",
    version=lambda: version("beamdyn"),
    help="""Statics of brake mechanisms: bicycle calipers, drum brakes, a forklift's duo-servo brake.

Inputs are TOML files with units; `brakes COMMAND --help` lists the options of a command.""",
    help_epilogue=program.EXIT_CODES,
    help_format="markdown",
    suppress_keyboard_interrupt=False,
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; see `beamdyn.common.edge.program.run`."""
    return program.run(app, arguments)


def warn(warnings: Iterable[str]) -> None:
    """Print warnings on standard error."""
    program.warn("brakes", warnings)


BrakeFile = Annotated[Path, Parameter(name="BRAKE.toml")]
What = Annotated[str | None, Parameter(name="--what")]
Files = Mapping[str, tuple[Path | None, Callable[["Answer", Path], object]]]


def add_command(app: App, name: str, help: str) -> None:
    """Give the command line a command on a type of brake that needs no options of its own.

    Parameters
    ----------
    app : App
        The command line.
    name : str
        Of the command and of the module in `brakes.answers`.
    help : str
        What it shows.
    """
    plain = f"brakes {name} examples/{name}.toml"

    @app.command(name=name, help=help, help_epilogue=examples(plain, f"{plain} --plot {name}.png"))
    def answer_file(
        file: BrakeFile,
        /,
        *,
        varying: VaryOptions = NOTHING_VARIED,
        spreading: SpreadOptions = NO_SPREAD,
        what: What = None,
        outputs: Outputs = NO_FILES,
    ) -> None:
        """Answer a file.

        Parameters
        ----------
        file
            The TOML file that describes the brake.
        varying
            Inputs that are varied, e.g. --vary "friction=0.1:0.6:11" --vary "shoe.lining_end=50:120:15 deg".
        spreading
            Inputs that have a tolerance, e.g. --spread "friction=+-10%": ranges of results.
        what
            Results with --vary or --spread, separated by commas, such as "torque,pin_1"; the file of --csv
            without them lists all names.
        outputs
            Files to write.
        """
        brake = import_module(f"brakes.answers.{name}").BRAKE
        run_command(brake, name, str(file), varying, spreading, what, outputs)


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
    from beamdyn.common.edge.tables import show

    written = {option: path for option, (path, _) in (further or {}).items()}
    outputs.check(file, **written)
    tables, text = brake.open(file)
    given = varying.options | spreading.options
    question = Question.of(f"brakes {command}", file, text, **options, **given, what=what)
    spreading.check(varying)
    _check_of_one(varying, spreading, written)
    if spreading.spread:
        _answer_spread(brake, tables, question, (file, varying, spreading, what), outputs)
        return
    varying.check()
    if varying.vary:
        _answer_many(brake, tables, question, (file, varying, what), outputs)
        return
    if what is not None:
        raise ValueError(f"--what goes with --vary or {OPTION}: without them, all results are shown")
    answer = brake.answer(tables, file)
    shown = answer.tables()
    more = [(part.title, partial(part.in_report, answer)) for part in brake.more]
    report = Report(question, shown, [*answer.refusals, *answer.warnings], more)
    write(answer, outputs, answer.rows(), answer.figure, report)
    for path, save in (further or {}).values():
        if path is not None:
            save(answer, path)
    show(shown)
    warn(answer.warnings)
    if answer.refusals:
        raise NoAnswer("; ".join(answer.refusals))


def _check_of_one(varying: VaryOptions, spreading: SpreadOptions, files: Mapping[str, Path | None]) -> None:
    """Refuse files that show one design where there are many."""
    many = VARY if varying.vary else OPTION if spreading.spread else ""
    for option, path in files.items():
        if many and path is not None:
            raise ValueError(f"--{option} = {path}: it is of one design; leave {many} out")


def _answer_many(
    brake: BrakeType[Any],
    tables: Mapping[str, Any],
    question: Question,
    request: tuple[str, VaryOptions, str | None],
    outputs: Outputs,
) -> None:
    import numpy as np

    from beamdyn._version import __version__
    from beamdyn.common.edge.html_report import Report
    from beamdyn.common.edge.input_sweep import sweep_csv
    from beamdyn.common.edge.progress import at_work
    from beamdyn.common.edge.tables import show
    from beamdyn.common.plots.curves import sweep_figure
    from brakes.answers.tables import sweep_table

    file, varying, what = request
    with at_work("designs") as progress:
        run = varying.runner("brakes study", (__version__, np.__version__), progress)
        made, warnings = brake.sweep(tables, file, varying.vary, what, combine=varying.combine, run=run)
    shown = [sweep_table(made)]
    report = Report(question, shown, warnings)
    write(made, outputs, sweep_csv(made), lambda: sweep_figure(made), report)
    show(shown)
    warn(warnings)
    if not any(np.isfinite(values).any() for values in made.found):
        raise NoAnswer(f"at none of {made.designs.count} values is there an answer")


def _answer_spread(
    brake: BrakeType[Any],
    tables: Mapping[str, Any],
    question: Question,
    request: tuple[str, VaryOptions, SpreadOptions, str | None],
    outputs: Outputs,
) -> None:
    import numpy as np

    from beamdyn._version import __version__
    from beamdyn.common.edge.html_report import Report
    from beamdyn.common.edge.progress import at_work
    from beamdyn.common.edge.spread_tables import spread_csv, spread_table
    from beamdyn.common.edge.tables import show
    from beamdyn.common.spreading.result import spread_figure
    from brakes.answers.spread import spread_of_brake

    file, varying, spreading, what = request
    with at_work("designs") as progress:
        run = varying.runner("brakes study", (__version__, np.__version__), progress)
        how = spreading.samples, spreading.seed, run
        made = spread_of_brake(brake, tables, file, spreading.spread, what, *how)
    shown = [spread_table(made)]
    report = Report(question, shown, made.warnings)
    write(made, outputs, spread_csv(made), lambda: spread_figure(made), report)
    show(shown)
    warn(made.warnings)
    if (made.scatter.no_answer == 1).all():
        raise NoAnswer(f"none of {made.designs} random designs has an answer")
