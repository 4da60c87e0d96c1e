"""What the commands share: sweeps of any input, and the files that are written."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from beamdyn.common.edge.outputs import Outputs, write

if TYPE_CHECKING:
    from pydantic import BaseModel

    from beamdyn.common.edge.html_report import Question
    from beamdyn.common.edge.input_sweep import Axis, InputSweep, Output

Sweeps = Annotated[tuple[str, ...], Parameter(name="--sweep", negative="", consume_multiple=False)]
Results = Annotated[str | None, Parameter(name="--result")]


def run_sweep(
    design: BaseModel,
    texts: Sequence[str],
    outputs: Sequence[Output],
    solve: Callable[[Any], Any],
) -> tuple[InputSweep, Any]:
    """A sweep over one or two inputs, and the answer with arrays that it is from."""
    from brakes.config.sweeps import parse_axis, replaced, sweep

    axes = axes_of(texts, lambda text: parse_axis(design, text))
    answer = solve(replaced(design, axes))
    return sweep(axes, outputs, answer), answer


def axes_of(texts: Sequence[str], parse: Callable[[str], Axis]) -> list[Axis]:
    """One or two different inputs with their values."""
    axes = [parse(text) for text in texts]
    if len(axes) > 2 or len({axis.input.path for axis in axes}) < len(axes):
        raise ValueError(f"--sweep is given {len(axes)} times: give it once, or twice for two inputs")
    return axes


def show_sweep(found: InputSweep, files: Outputs, question: Question, warnings: Sequence[str]) -> None:
    """Print a sweep and write its files."""
    from beamdyn.common.curves import sweep_figure
    from beamdyn.common.edge.html_report import Report
    from beamdyn.common.edge.input_sweep import sweep_csv
    from beamdyn.common.edge.tables import show
    from brakes.answers.tables import sweep_table

    show(tables := [sweep_table(found)])
    report = Report(question, tables, warnings)
    write(found, files, sweep_csv(found), lambda: sweep_figure(found), report)
