"""The command on a forklift's brakes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from beamdyn.common.edge.outputs import NO_FILES, Outputs, write
from beamdyn.common.edge.program import NoAnswer
from brakes.cli.program import app, warn
from brakes.cli.sweeps import Results, Sweeps, run_sweep, show_sweep

if TYPE_CHECKING:
    from rich.console import RenderableType

    from beamdyn.common.edge.html_report import Report
    from beamdyn.common.edge.input_sweep import Sweep
    from brakes.config.forklift import ForkliftAnswer, ForkliftInput, StageName

ForkliftFile = Annotated[Path, Parameter(name="FORKLIFT.toml")]
StageChoice = Literal["vehicle", "kinematics", "forces", "all"]

_SWEPT = {
    "vehicle": "distance,torque_per_brake",
    "kinematics": "drum_turn,left_travel,lining_penetration",
    "forces": "A,B,Q,P_L,lining_friction",
}


@app.command
def forklift(
    file: ForkliftFile,
    /,
    *,
    stage: StageChoice = "all",
    sweep: Sweeps = (),
    result: Results = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Stopping distance of a forklift, motion of its duo-servo shoes, and the force on every part.

    Parameters
    ----------
    file
        The truck, the stop, and one of its brakes.
    stage
        What to show; what comes before it is computed where it is needed.
    sweep
        An input and its values: KEY=start:stop:count unit, e.g. "stop.speed=10:30:9 km/h"; twice for
        two inputs.
    result
        Results of a sweep, separated by commas, such as "distance,A"; the file of --csv without a
        sweep lists all names.
    outputs
        Files to write.
    """
    from beamdyn.common.edge.html_report import Question, Report
    from beamdyn.common.edge.tables import show
    from brakes.config.forklift import load_forklift

    outputs.check()
    design = load_forklift(file)
    asked = Question.on_file("brakes forklift", file, stage=stage, sweep=sweep, result=result)
    stages = design.stages if stage == "all" else (stage,)
    if sweep:
        swept, cases = _swept(design, stages, sweep, result)
        show_sweep(swept, outputs, asked, warnings := (*cases.warnings, *cases.refusals))
        warn(warnings)
        return
    if result is not None:
        raise ValueError("--result goes with --sweep: without one, all results are shown")
    found = design.solve(stages).followed()
    show(tables := _tables(found))
    _write(found, stages, outputs, Report(asked, tables, [*found.warnings, *found.refusals]))
    warn(found.warnings)
    if found.refusals:
        raise NoAnswer("; ".join(found.refusals))


def _swept(
    design: ForkliftInput, stages: tuple[StageName, ...], texts: Sweeps, names: Results
) -> tuple[Sweep, ForkliftAnswer]:
    from beamdyn.common.edge.input_sweep import chosen
    from brakes.answers.tables import forklift_outputs

    wanted = chosen(forklift_outputs(stages), names or ",".join(_SWEPT[s] for s in stages))
    return run_sweep(design, texts, wanted, lambda d: d.solve(stages))


def _tables(found: ForkliftAnswer) -> list[RenderableType]:
    from brakes.answers.tables import forces_table, kinematics_tables, vehicle_table

    tables = []
    if found.stop is not None:
        tables.append(vehicle_table(found.stop))
    if found.motion is not None and found.kinematics is not None:
        tables.append(kinematics_tables(found.motion, found.kinematics))
    if found.forces is not None:
        tables.append(forces_table(found.forces, found.torque_from))
    return tables


def _write(found: ForkliftAnswer, stages: tuple[StageName, ...], files: Outputs, report: Report) -> None:
    from brakes.answers.tables import forklift_outputs, outputs_csv
    from brakes.drawings.forklift import answer_figure

    rows = outputs_csv(forklift_outputs(stages), value=found)
    write(found, files, rows, lambda: answer_figure(found.stop, found.kinematics, found.forces), report)
