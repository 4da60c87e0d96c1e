"""The command on calipers and planar mechanisms."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from beamdyn.common.edge.outputs import NO_FILES, Flag, Outputs
from beamdyn.common.edge.program import examples
from beamdyn.common.edge.varying import NO_SPREAD, NOTHING_VARIED, SpreadOptions, VaryOptions
from brakes.cli.answering import What, app, run_command


@app.command(
    usage="Usage: brakes caliper [OPTIONS] MECHANISM",
    help_epilogue=examples(
        "brakes caliper v-brake --plot v_brake.png",
        'brakes caliper dual-pivot --vary "dimensions.side_pivot.x=22:32:3 mm"',
        "brakes caliper examples/calipers/toggle-clamp.toml --free-bodies bodies.png",
    ),
)
def caliper(
    mechanism: Annotated[str, Parameter(name="MECHANISM", show_default=False)] = "",
    /,
    *,
    free_bodies: Path | None = None,
    animation: Path | None = None,
    varying: VaryOptions = NOTHING_VARIED,
    spreading: SpreadOptions = NO_SPREAD,
    what: What = None,
    list_: Annotated[Flag, Parameter(name="--list")] = False,
    outputs: Outputs = NO_FILES,
) -> None:
    """Forces, travels and mechanical advantage of a caliper, or of any planar mechanism.

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
    varying
        Inputs that are varied, e.g. --vary "clearance=1:2:11 mm" --vary "dimensions.pad.y=-55:-45:11 mm".
    spreading
        Inputs that have a tolerance, e.g. --spread "clearance=+-0.1 mm": ranges of results.
    what
        Results with --vary or --spread, separated by commas, such as "finger_travel,right_advantage"; a
        wrong name lists all.
    list_
        List the named calipers and their dimensions; needs no MECHANISM.
    outputs
        Files to write.
    """
    from beamdyn.common.edge.tables import show
    from beamdyn.common.results.pictures import save_figure
    from brakes.answers.caliper import MECHANISM, names_table
    from brakes.calipers import NAMED

    if list_:
        files = {"plot": outputs.plot, "json": outputs.json, "csv": outputs.csv, "report": outputs.report}
        files |= {"free-bodies": free_bodies, "animation": animation}
        _check_alone(mechanism, **files, **varying.options, **spreading.options, what=what)
        show(names_table(name) for name in NAMED)
        return
    further = {
        "free-bodies": (free_bodies, lambda a, path: save_figure(a.free_bodies(), path, outputs.force)),
        "animation": (animation, lambda a, path: a.animate(path, outputs.force)),
    }
    run_command(MECHANISM, "caliper", mechanism, varying, spreading, what, outputs, further)


def _check_alone(mechanism: str, **options: object) -> None:
    """Refuse what is given beside --list."""
    given = {"MECHANISM": mechanism or None} | {f"--{name}": value for name, value in options.items()}
    for name, value in given.items():
        if value is not None:
            text = ", ".join(map(str, value)) if isinstance(value, tuple) else value
            raise ValueError(
                f"{name} = {text}: --list shows the named calipers alone; leave one of the two out"
            )
