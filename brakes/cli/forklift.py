"""The command on a forklift's brakes."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from beamdyn.common.edge.outputs import NO_FILES, Outputs
from beamdyn.common.edge.program import examples
from beamdyn.common.edge.varying import NO_SPREAD, NOTHING_VARIED, SpreadOptions, VaryOptions
from brakes.cli.answering import What, app, run_command

ForkliftFile = Annotated[Path, Parameter(name="FORKLIFT.toml")]
StageChoice = Literal["vehicle", "kinematics", "forces", "all"]


@app.command(
    help_epilogue=examples(
        "brakes forklift examples/forklift.toml --plot forklift.png",
        'brakes forklift examples/forklift.toml --vary "stop.speed=10:30:3 km/h"',
    )
)
def forklift(
    file: ForkliftFile,
    /,
    *,
    stage: StageChoice = "all",
    varying: VaryOptions = NOTHING_VARIED,
    spreading: SpreadOptions = NO_SPREAD,
    what: What = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Stopping distance of a forklift, motion of its duo-servo shoes, and the force on every part.

    Parameters
    ----------
    file
        The truck, the stop, and one of its brakes.
    stage
        What to show; what comes before it is computed where it is needed.
    varying
        Inputs that are varied, e.g. --vary "stop.speed=10:30:9 km/h".
    spreading
        Inputs that have a tolerance, e.g. --spread "stop.friction=+-10%": ranges of results.
    what
        Results with --vary or --spread, separated by commas, such as "distance,A"; the file of --csv
        without them lists all names.
    outputs
        Files to write.
    """
    from brakes.answers.forklift import FORKLIFT, TYPES

    brake = FORKLIFT if stage == "all" else TYPES[stage]
    run_command(brake, "forklift", str(file), varying, spreading, what, outputs, stage=stage)
