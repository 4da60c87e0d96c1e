"""The program `brakes` and its commands: they read, solve, write files, print, and warn.

Slow imports are inside the commands that need them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import App, Parameter

from beamdyn._version import __version__
from beamdyn.common.edge import exit_codes
from beamdyn.common.edge.command_options import (
    NO_FILES,
    NO_SPREAD,
    NOTHING_VARIED,
    OPTION,
    SPREAD,
    Flag,
    Outputs,
    SomeFolder,
    SpreadOptions,
    VaryOptions,
    given_options,
    write,
)
from beamdyn.common.edge.console import at_work, show
from beamdyn.common.edge.exit_codes import NoAnswer, examples
from beamdyn.common.edge.reports import report_verdicts
from beamdyn.common.results.pictures import save_figure
from beamdyn.common.screens.app_command import add_command
from brakes.answers import STANDARD

if TYPE_CHECKING:
    from beamdyn.common.screens.screens import Program
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
        The result that the input shall give, such as "torque = 300 N m"; with a wrong name,
        all names are listed.
    """

    find: Annotated[str | None, Parameter(show_default=False)] = None
    so_that: Annotated[str | None, Parameter(show_default=False)] = None

    def check(self, **others: object) -> None:
        """Refuse --find or --so-that alone, and --find together with options on many designs."""
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
        Results to show with --vary or --spread, separated by commas; the --csv file of a run without these
        options lists the names of all results.
    """

    varying: VaryOptions = NOTHING_VARIED
    spreading: SpreadOptions = NO_SPREAD
    finding: FindOptions = field(default_factory=FindOptions)
    what: Annotated[str | None, Parameter(show_default=False)] = None

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
    """Solve the design of a file, write the files that are asked for, and print the results.

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
        Further files to write, by the name of the option: the file's path, if the option is given, and the
        function that writes it.
    **options
        Options of the command that the HTML report repeats.

    Raises
    ------
    NoAnswer
        If the model has no answer; it is raised after the available results have been shown.
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
    question = Question.of(f"brakes {command}", file, text, **options, **given_options(asked))
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
    """Return the title of each additional drawing of the results, with a function that makes its HTML."""
    from beamdyn.common.screens.screens import FoldedPart

    folded = (FoldedPart.of_drawings(*each) for each in brake.more.items())
    return [(part.title, partial(part.in_report, answer)) for part in folded]


def _answer_many(
    brake: BrakeType[Any], tables: Mapping[str, Any], file: str, asked: Asked
) -> tuple[Any, Sequence[str], str]:
    """Solve a sweep, a spread or an inverse question.

    Return the result, the warnings, and the reason why there is no answer ("" if there is one).
    """
    import numpy as np

    from beamdyn.common.parallel.tasks import TaskRunner
    from brakes.answers.finding import find_in_file, spread_of_brake

    if asked.finding.find and asked.finding.so_that:
        made = find_in_file(brake, tables, file, asked.finding.find, asked.finding.so_that)
        return made, made.warnings, "".join(made.refusals)
    varying, spreading = asked.varying, asked.spreading
    with at_work("designs") as progress:
        versions = __version__, np.__version__
        run = TaskRunner(varying.workers, None, varying.store, "brakes study", versions, progress)
        if spreading.spread:
            how = spreading.samples, spreading.seed, run
            made = spread_of_brake(brake, tables, file, spreading.spread, asked.what, *how)
            answered, warnings = not (made.scatter.no_answer == 1).all(), made.warnings
            none = f"none of {made.designs} random designs has an answer"
        else:
            how = {"combine": varying.combine, "run": run}
            made, warnings = brake.sweep(tables, file, varying.vary, asked.what, **how)
            answered = any(np.isfinite(values).any() for values in made.found)
            none = f"there is no answer for any of {made.designs.count} designs"
    return made, warnings, "" if answered else none


# Commands --------------------------------------------------------------------------------------------

BrakeFile = Annotated[Path, Parameter(name="BRAKE.toml")]
ForkliftFile = Annotated[Path, Parameter(name="FORKLIFT.toml")]
StageChoice = Literal["vehicle", "kinematics", "forces", "all"]


@app.command(
    usage="Usage: brakes caliper [OPTIONS] MECHANISM",
    help_epilogue=examples(
        "brakes caliper v-brake --plot v_brake.png",
        'brakes caliper dual-pivot --vary "dimensions.side_pivot.x=22:32:3 mm"',
        "brakes caliper examples/calipers/eebrake.toml --free-bodies bodies.png",
    ),
)
def caliper(
    mechanism: Annotated[str, Parameter(name="MECHANISM", show_default=False)] = "",
    /,
    *,
    free_bodies: Path | None = None,
    animation: Path | None = None,
    asked: Asked = ONE_DESIGN,
    list_: Annotated[Flag, Parameter(name="--list")] = False,
    outputs: Outputs = NO_FILES,
) -> None:
    """Forces, travels and mechanical advantage of a caliper.

    With friction, there are three sets of forces: without friction, while squeezing, and while releasing. The
    command says which bodies are loose, which reactions statics does not determine and which contacts open,
    and then ends with code 1.

    Parameters
    ----------
    mechanism
        A TOML file, or a caliper with its usual dimensions: eebrake, single-pivot, dual-pivot, centre-pull,
        cantilever or v-brake.
    free_bodies
        Draw the free-body diagram of every body into this file: .png, .svg or .pdf.
    animation
        Write an animation of the stroke: .gif.
    asked
        Options that ask about many designs: variations, tolerances, or an inverse question.
    list_
        List the named calipers and their dimensions; needs no MECHANISM.
    outputs
        Files to write.
    """
    from brakes.answers.caliper import names_tables

    if list_:
        files = vars(outputs) | {"free-bodies": free_bodies, "animation": animation, "force": None}
        options = files | given_options(asked)
        given = {"MECHANISM": mechanism} | {f"--{name}": value for name, value in options.items()}
        for name, value in given.items():
            if value:
                text = ", ".join(map(str, value)) if isinstance(value, tuple) else value
                says = f"--list only lists the named calipers; leave out --list or {name}"
                raise ValueError(f"{name} = {text}: {says}")
        show(names_tables())
        return
    _run_planar("caliper", mechanism, free_bodies, animation, asked, outputs)


@app.command(
    help_epilogue=examples(
        "brakes mechanism examples/block_brake.toml",
        "brakes mechanism examples/calipers/toggle-clamp.toml --free-bodies bodies.png",
    )
)
def mechanism(
    file: Annotated[Path, Parameter(name="MECHANISM.toml")],
    /,
    *,
    free_bodies: Path | None = None,
    animation: Path | None = None,
    asked: Asked = ONE_DESIGN,
    outputs: Outputs = NO_FILES,
) -> None:
    """Every force in a planar mechanism of bodies, joints and loads, as drawn and over a stroke.

    With friction, there are three sets of forces: without friction, while squeezing, and while releasing. The
    command says which bodies are loose, which reactions statics does not determine and which contacts open,
    and then ends with code 1.

    Parameters
    ----------
    file
        TOML file that describes a mechanism by its bodies, joints and loads, or a caliper; `brakes keys
        mechanism` lists all keys.
    free_bodies
        Draw the free-body diagram of every body into this file: .png, .svg or .pdf.
    animation
        Write an animation of the stroke: .gif.
    asked
        Options that ask about many designs: variations, tolerances, or an inverse question.
    outputs
        Files to write.
    """
    _run_planar("mechanism", str(file), free_bodies, animation, asked, outputs)


def _run_planar(
    command: str, name: str, free_bodies: Path | None, animation: Path | None, asked: Asked, outputs: Outputs
) -> None:
    """Solve a caliper or a mechanism, with options for free-body diagrams and an animation."""
    from brakes.answers.caliper import MECHANISM

    further = {
        "free-bodies": (free_bodies, lambda a, path: save_figure(a.free_bodies(), path, outputs.force)),
        "animation": (animation, lambda a, path: a.animate(path, outputs.force)),
    }
    run_command(MECHANISM, command, name, asked, outputs, further)


@app.command(
    help_epilogue=examples(
        "brakes forklift examples/forklift.toml --plot forklift.png",
        'brakes forklift examples/forklift.toml --vary "stop.speed=10:30:3 km/h"',
        'brakes forklift examples/forklift.toml --find friction --so-that "distance=9 m"',
    )
)
def forklift(
    file: ForkliftFile,
    /,
    *,
    stage: StageChoice = "all",
    asked: Asked = ONE_DESIGN,
    outputs: Outputs = NO_FILES,
) -> None:
    """Stopping distance of a forklift, motion of its duo-servo shoes, and the force on every part.

    Parameters
    ----------
    file
        TOML file of the truck, the stop and one of the brakes; `brakes keys forklift` lists all keys.
    stage
        Stage to show; the stages before it are computed if they are needed.
    asked
        Options that ask about many designs: variations, tolerances, or an inverse question.
    outputs
        Files to write.
    """
    from brakes.answers.forklift import FORKLIFT, TYPES

    brake = FORKLIFT if stage == "all" else TYPES[stage]
    run_command(brake, "forklift", str(file), asked, outputs, stage=stage)


@app.command(help_epilogue=examples("brakes keys disc"))
def keys(brake: Annotated[str, Parameter(name="COMMAND")], /) -> None:
    """List the tables and keys of a command's file, with meaning, unit, bounds and default of each.

    Parameters
    ----------
    brake
        The command that takes the file, such as drum, disc, vehicle, forklift, caliper or mechanism.
    """
    from beamdyn.common.inputs.checks import one_of
    from brakes.answers.caliper import CALIPER, MECHANISM
    from brakes.answers.forklift import FORKLIFT
    from brakes.answers.tables import keys_tables

    others = {each.name: each for each in (FORKLIFT, CALIPER, MECHANISM)}
    one_of("COMMAND", brake, [*STANDARD, *others])
    found = others.get(brake) or STANDARD[brake][1]()
    about = 'A quantity is text with a unit, "50 mm"; numbers without a unit, true and false have no quotes.'
    show([*keys_tables(found.inputs({}), found.optional), f"{found.together} {about}".lstrip()])


@app.command(help_epilogue=examples("brakes reproduce --output pictures"))
def reproduce(*, output: SomeFolder = Path("brakes-reproduce")) -> None:
    """Published numbers of brakes beside computed ones, consequences of the papers' errors, and pictures.

    Parameters
    ----------
    output
        Folder for the pictures; it is created if it does not exist, and pictures in it are replaced.
    """
    from brakes.reproduce import compare_all

    report_verdicts(compare_all, output)


def make_program() -> Program:
    """Import and return the interactive program."""
    from brakes.app.program import BRAKES

    return BRAKES


add_command(
    app,
    make_program,
    port=8081,
    about="The interactive program in the browser: forklift, drum brake, calipers, any mechanism.",
)


def add_standard(name: str, help: str, load: Callable[[], BrakeType[Any]]) -> None:
    """Add the command of a type of brake that has no options of its own."""
    plain = f"brakes {name} examples/{name}.toml"

    @app.command(name=name, help=help, help_epilogue=examples(plain, f"{plain} --plot {name}.png"))
    def answer_file(file: BrakeFile, /, *, asked: Asked = ONE_DESIGN, outputs: Outputs = NO_FILES) -> None:
        """Solve the brake that a file describes, and print the results.

        Parameters
        ----------
        file
            The TOML file that describes the brake; `brakes keys` lists its keys.
        asked
            Options that ask about many designs: variations, tolerances, or an inverse question.
        outputs
            Files to write.
        """
        run_command(load(), name, str(file), asked, outputs)


for _name, (_help, _load) in STANDARD.items():
    add_standard(_name, _help, _load)
