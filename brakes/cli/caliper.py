"""The command for calipers and planar mechanisms."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from beamdyn.common.edge.outputs import NO_FILES, Flag, Outputs, write
from beamdyn.common.edge.program import NoAnswer
from brakes.cli.program import app, warn
from brakes.cli.sweeps import Results, Sweeps, axes_of, show_sweep

if TYPE_CHECKING:
    from beamdyn.common.edge.input_sweep import InputSweep


@app.command
def caliper(
    mechanism: str = "",
    /,
    *,
    free_bodies: Path | None = None,
    animation: Path | None = None,
    sweep: Sweeps = (),
    result: Results = None,
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
    sweep
        An input and its values: KEY=start:stop:count unit, e.g. "clearance=1:2:11 mm" or
        "dimensions.pad.y=-55:-45:11 mm"; twice for two inputs.
    result
        Results of a sweep, separated by commas, such as "finger_travel,right_advantage"; a wrong name
        lists all.
    list_
        List the named calipers and their dimensions instead.
    outputs
        Files to write.
    """
    from beamdyn.common.edge.html_report import Question, Report
    from beamdyn.common.edge.tables import console, show
    from beamdyn.common.pictures import save_figure
    from brakes.answers import caliper as caliper_answers
    from brakes.config.mechanism import mechanism_from_dict

    if list_:
        caliper_answers.write_names(console())
        return
    outputs.check(**{"free-bodies": free_bodies, "animation": animation})
    design, text = caliper_answers.design_of(mechanism)
    asked = Question.of("brakes caliper", mechanism, text, sweep=sweep, result=result)
    if sweep:
        swept = _swept(design, mechanism, sweep, result)
        show_sweep(swept, outputs, asked, swept.warnings)
        warn(swept.warnings)
        return
    if result is not None:
        raise ValueError("--result goes with --sweep: without one, all results are shown")
    answer = caliper_answers.answer_to(mechanism_from_dict(design, mechanism))
    refusal = [] if answer.status == "determined" else [answer.message]
    show(tables := answer.tables())
    more = [("Free bodies", answer.free_bodies)]
    report = Report(asked, tables, [*refusal, *answer.warnings], more)
    write(answer, outputs, answer.rows(), answer.figure, report)
    if free_bodies is not None:
        save_figure(answer.free_bodies(), free_bodies, outputs.force)
    if animation is not None:
        answer.animate(animation, outputs.force)
    warn(answer.warnings)
    if refusal:
        raise NoAnswer(answer.message)


def _swept(design: Mapping[str, Any], source: str, texts: Sweeps, names: Results) -> InputSweep:
    from beamdyn.common.edge.input_sweep import chosen, numbers, one_by_one, parse_axis
    from brakes.answers.caliper_sweeps import outputs_of, solve
    from brakes.config.mechanism_inputs import inputs_of_tables

    known = outputs_of(design, source)
    inputs = numbers(inputs_of_tables(design))
    axes = axes_of(texts, lambda text: parse_axis(inputs, text))
    return one_by_one(design, axes, chosen(known, names or known[0].name), solve)
