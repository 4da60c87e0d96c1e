"""The command for calipers and planar mechanisms."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from beamdyn.common.outputs import NO_FILES, Flag, Outputs, write
from beamdyn.common.program import NoAnswer
from brakes.cli.program import app, warn


@app.command
def caliper(
    mechanism: str = "",
    /,
    *,
    free_bodies: Path | None = None,
    animation: Path | None = None,
    list_: Annotated[Flag, Parameter(name="--list")] = False,
    outputs: Outputs = NO_FILES,
) -> None:
    """Forces, travels and mechanical advantage of a caliper, or of any planar mechanism.

    Says which bodies are loose and which reactions statics does not determine, and then ends with code 1.

    Parameters
    ----------
    mechanism
        A TOML file, or the name of a caliper with its usual dimensions.
    free_bodies
        Draw the free-body diagram of every body into this file: .png, .svg or .pdf.
    animation
        Write an animation of the stroke: .gif.
    list_
        List the named calipers and their dimensions instead.
    outputs
        Files to write.
    """
    from beamdyn.common.pictures import save_figure
    from beamdyn.common.tables import console
    from brakes.cli import caliper_answers

    if list_:
        caliper_answers.write_names(console())
        return
    outputs.check(**{"free-bodies": free_bodies, "animation": animation})
    answer = caliper_answers.answer_of(mechanism)
    answer.show(console())
    write(answer, outputs, answer.rows())
    if outputs.plot is not None:
        save_figure(answer.figure(), outputs.plot, outputs.force)
    if free_bodies is not None:
        save_figure(answer.free_bodies(), free_bodies, outputs.force)
    if animation is not None:
        answer.animate(animation, outputs.force)
    warn(answer.warnings)
    if answer.status != "determined":
        raise NoAnswer(answer.message)
