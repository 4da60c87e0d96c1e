"""The commands of `brakes`.  Slow imports are inside the commands that need them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from beamdyn.common.edge.exit_codes import NoAnswer, examples
from beamdyn.common.edge.outputs import NO_FILES, Flag, Outputs, check_folder
from beamdyn.common.edge.tables import console, show
from beamdyn.common.edge.varying import SomeFolder
from beamdyn.common.results.pictures import save_figure
from beamdyn.common.screens.app_command import add_command
from brakes.answers import STANDARD
from brakes.cli.answering import ONE_DESIGN, Asked, app, run_command

if TYPE_CHECKING:
    from beamdyn.common.screens.screens import Program
    from brakes.answers.base import BrakeType

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

    With friction, forces without it, squeezing and releasing. Says which bodies are loose, which reactions
    statics does not determine and which contacts open, and then ends with code 1.

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
        What is asked of many designs.
    list_
        List the named calipers and their dimensions; needs no MECHANISM.
    outputs
        Files to write.
    """
    from brakes.answers.caliper import names_tables

    if list_:
        files = vars(outputs) | {"free-bodies": free_bodies, "animation": animation, "force": None}
        options = files | asked.options
        given = {"MECHANISM": mechanism} | {f"--{name}": value for name, value in options.items()}
        for name, value in given.items():
            if value:
                text = ", ".join(map(str, value)) if isinstance(value, tuple) else value
                says = "--list shows the named calipers alone; leave one of the two out"
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

    With friction, forces without it, squeezing and releasing. Says which bodies are loose, which reactions
    statics does not determine and which contacts open, and then ends with code 1.

    Parameters
    ----------
    file
        The mechanism, part by part, or a caliper; `brakes keys mechanism` lists all keys.
    free_bodies
        Draw the free-body diagram of every body into this file: .png, .svg or .pdf.
    animation
        Write an animation of the stroke: .gif.
    asked
        What is asked of many designs.
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
        The truck, the stop, and one of its brakes; `brakes keys forklift` lists all keys.
    stage
        What to show; what comes before it is computed where it is needed.
    asked
        What is asked of many designs.
    outputs
        Files to write.
    """
    from brakes.answers.forklift import FORKLIFT, TYPES

    brake = FORKLIFT if stage == "all" else TYPES[stage]
    run_command(brake, "forklift", str(file), asked, outputs, stage=stage)


@app.command(help_epilogue=examples("brakes keys disc"))
def keys(brake: Annotated[str, Parameter(name="COMMAND")], /) -> None:
    """List the tables and keys of a file from which to begin: meaning, unit, bounds and default of each.

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
    about = 'A quantity is text with a unit, "50 mm"; a number without a unit and true or false stand bare.'
    show([*keys_tables(found.inputs({}), found.optional), f"{found.together} {about}".lstrip()])


@app.command(help_epilogue=examples("brakes reproduce --output pictures"))
def reproduce(*, output: SomeFolder = Path("brakes-reproduce")) -> None:
    """Published numbers of brakes beside ours, what the papers' errors cost, and the pictures.

    Parameters
    ----------
    output
        Folder for the pictures; it is made in the current one if needed, and its pictures are replaced.
    """
    from brakes.reproduce import compare_all

    check_folder("output", output)
    screen = console()
    screen.print(f"Pictures go into the folder {output} (--output names another).\n")
    checked = compare_all(screen, output)
    unexpected = sum(not verdict.as_expected for verdict in checked)
    if unexpected:
        raise NoAnswer(f"{unexpected} of {len(checked)} verdicts are not as expected; see the tables")
    screen.print(
        f"\nAll {len(checked)} verdicts are as expected: agreement, but for what is explained above."
    )


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
    def answer_file(
        file: BrakeFile,
        /,
        *,
        asked: Asked = ONE_DESIGN,
        outputs: Outputs = NO_FILES,
    ) -> None:
        """Answer a file.

        Parameters
        ----------
        file
            The TOML file that describes the brake; `brakes keys` lists its keys.
        asked
            What is asked of many designs.
        outputs
            Files to write.
        """
        run_command(load(), name, str(file), asked, outputs)


for _name, (_help, _load) in STANDARD.items():
    add_standard(_name, _help, _load)
