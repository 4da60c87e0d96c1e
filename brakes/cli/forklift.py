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
    from beamdyn.common.edge.input_sweep import InputSweep
    from brakes.config.forklift import ForkliftAnswer, ForkliftInput, StageName

ForkliftFile = Annotated[Path, Parameter(name="FORKLIFT.toml")]
StageChoice = Literal["vehicle", "kinematics", "forces", "all"]
ModelChoice = Literal["corrected", "as_printed", "both"]

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
    model: ModelChoice | None = None,
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
    model
        Of the vehicle, in place of that in the file; both: side by side.
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
    asked = Question.on_file("brakes forklift", file, stage=stage, model=model, sweep=sweep, result=result)
    stages = design.stages if stage == "all" else (stage,)
    if sweep:
        swept, cases = _swept(design, stages, model, sweep, result)
        show_sweep(swept, outputs, asked, warnings := (*cases.warnings, *cases.refusals))
        warn(warnings)
        return
    if result is not None:
        raise ValueError("--result goes with --sweep: without one, all results are shown")
    found = _answers(design, stages, model)
    warnings = [*dict.fromkeys(w for answer in found.values() for w in answer.warnings)]
    refusals = [*dict.fromkeys(sentence for answer in found.values() for sentence in answer.refusals)]
    show(tables := _tables(found))
    _write(found, stages, outputs, Report(asked, tables, [*warnings, *refusals]))
    warn(warnings)
    if refusals:
        raise NoAnswer("; ".join(refusals))


def _answers(
    design: ForkliftInput, stages: tuple[StageName, ...], model: ModelChoice | None
) -> dict[str, ForkliftAnswer]:
    """The answer of each model, by its name."""
    if model != "both":
        return {"value": design.solve(stages, model).followed()}
    return {
        "corrected": design.solve(stages, "corrected").followed(),
        "as_printed": design.solve(stages, "as_printed").followed(),
    }


def _swept(
    design: ForkliftInput,
    stages: tuple[StageName, ...],
    model: ModelChoice | None,
    texts: Sweeps,
    names: Results,
) -> tuple[InputSweep, ForkliftAnswer]:
    from beamdyn.common.edge.input_sweep import chosen
    from brakes.answers.tables import forklift_outputs

    if model == "both":
        raise ValueError("--model both does not go with --sweep: sweep each model by itself")
    wanted = chosen(forklift_outputs(stages), names or ",".join(_SWEPT[s] for s in stages))
    return run_sweep(design, texts, wanted, lambda d: d.solve(stages, model))


def _tables(found: dict[str, ForkliftAnswer]) -> list[RenderableType]:
    from brakes.answers.tables import forces_table, kinematics_tables, vehicle_table

    answers, tables = [*found.values()], []
    first = answers[0]
    stops = [answer.stop for answer in answers if answer.stop is not None]
    if stops:
        tables.append(vehicle_table(stops))
    if first.motion is not None and first.kinematics is not None:
        tables.append(kinematics_tables(first.motion, first.kinematics))
    if first.forces is not None:
        differ = first.torque_from == "the stop"
        heads = [name.replace("_", " ") for name in found]
        tables.append(forces_table(answers if differ else answers[:1], heads))
    return tables


def _write(
    found: dict[str, ForkliftAnswer], stages: tuple[StageName, ...], files: Outputs, report: Report
) -> None:
    from brakes.answers.tables import forklift_outputs, outputs_csv
    from brakes.config.forklift import Models
    from brakes.drawings.forklift import answer_figure

    answers = [*found.values()]
    first = answers[0]
    rows = outputs_csv(forklift_outputs(stages), **found)
    write(
        first if len(answers) == 1 else Models(*answers),
        files,
        rows,
        lambda: answer_figure(first.stop, first.kinematics, first.forces),
        report,
    )
