"""The command on drum brakes."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from beamdyn.common.edge.outputs import NO_FILES, Outputs, write
from beamdyn.common.edge.program import NoAnswer
from brakes.cli.program import app, warn
from brakes.cli.sweeps import Results, Sweeps, run_sweep, show_sweep

DrumFile = Annotated[Path, Parameter(name="DRUM.toml")]
_SWEPT = "torque,c_star,peak_pressure"


@app.command
def drum(
    file: DrumFile, /, *, sweep: Sweeps = (), result: Results = None, outputs: Outputs = NO_FILES
) -> None:
    """Torque, forces, shoe factors and self-locking of a drum brake with pivoted shoes.

    Parameters
    ----------
    file
        The brake.
    sweep
        An input and its values: KEY=start:stop:count unit, e.g. "shoe.lining_end=50:120:15 deg" or
        "friction=0.1:0.6:11"; twice for two inputs.
    result
        Results of a sweep, separated by commas, such as "torque,pin_1"; the file of --csv without a
        sweep lists all names.
    outputs
        Files to write.
    """
    from beamdyn.common.edge.html_report import Question, Report
    from beamdyn.common.edge.input_sweep import chosen
    from beamdyn.common.edge.tables import show
    from brakes.answers.tables import drum_outputs, drum_tables, outputs_csv
    from brakes.config.drum import load_drum
    from brakes.drawings.drum import brake_figure

    outputs.check()
    design = load_drum(file)
    asked = Question.on_file("brakes drum", file, sweep=sweep, result=result)
    known = drum_outputs(len(design.core.shoes))
    wanted = chosen(known, result or _SWEPT)
    if sweep:
        swept, cases = run_sweep(design, sweep, wanted, lambda d: d.solve())
        warnings = [cases.message] if cases.locked.any() else []
        show_sweep(swept, outputs, asked, warnings)
        warn(warnings)
        return
    if result is not None:
        raise ValueError("--result goes with --sweep: without one, all results are shown")
    found = design.solve()
    refusal = [found.message] if found.locked else []
    show(tables := [drum_tables(found)])
    report = Report(asked, tables, refusal)
    write(found, outputs, outputs_csv(known, value=found), lambda: brake_figure(found), report)
    if refusal:
        raise NoAnswer(found.message)
