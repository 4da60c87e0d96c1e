"""What the commands share: sweeps of any input, and the files that are written."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from beamdyn.common.outputs import Outputs, write

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pydantic import BaseModel

    from beamdyn.common.results import Result
    from brakes.config.sweeps import Axis, Output, Sweep

Sweeps = Annotated[tuple[str, ...], Parameter(name="--sweep", negative="", consume_multiple=False)]
Results = Annotated[str | None, Parameter(name="--result")]


def run_sweep(
    design: BaseModel,
    texts: Sequence[str],
    outputs: Sequence[Output],
    solve: Callable[[Any], Any],
) -> tuple[Sweep, Any]:
    """A sweep over one or two inputs, and the answer with arrays that it is from."""
    from brakes.config.sweeps import replaced, sweep

    axes = parse_axes(design, texts)
    answer = solve(replaced(design, axes))
    return sweep(axes, outputs, answer), answer


def parse_axes(design: BaseModel, texts: Sequence[str]) -> list[Axis]:
    """One or two different inputs with their values."""
    from brakes.config.sweeps import parse_axis

    axes = [parse_axis(design, text) for text in texts]
    if len(axes) > 2 or len({axis.input.path for axis in axes}) < len(axes):
        raise ValueError(f"--sweep is given {len(axes)} times: give it once, or twice for two inputs")
    return axes


def show_sweep(found: Sweep, files: Outputs) -> None:
    """Print a sweep and write its files."""
    from beamdyn.common.tables import console
    from brakes.drawings.curves import sweep_figure
    from brakes.report import sweep_csv, sweep_table

    console().print(sweep_table(found))
    save(found, files, sweep_csv(found), lambda: sweep_figure(found))


def save(found: Result, files: Outputs, rows: Iterable[Sequence[object]], draw: Callable[[], Figure]) -> None:
    """Write the files asked for; `draw` makes the picture."""
    write(found, files, rows)
    if files.plot is not None:
        from beamdyn.common.pictures import save_figure

        save_figure(draw(), files.plot, files.force)
