"""The command that measures error against time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from beamdyn.cli.program import app, deliver
from beamdyn.cli.values import ModeCount, SceneFile, Text, parse_positive, parse_speed
from beamdyn.common.edge.outputs import NO_FILES, Outputs, on_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from rich.console import Group

    from beamdyn.tradeoffs import Diagram, Tradeoff


@app.command
def tradeoff(
    scene: SceneFile,
    /,
    *,
    speed: Text | None = None,
    modes: ModeCount = 3,
    t_end: Text | None = None,
    budget: Text = "60 s",
    outputs: Outputs = NO_FILES,
) -> None:
    """Error against computing time of bases, elements, physics, integrators, numbers of modes and harmonics.

    Parameters
    ----------
    scene
        The scene; transients and the steady response are measured if it has a motion.
    speed
        Speed with its unit, e.g. "50 rad/s" or "525 rpm"; default: the final speed of the scene's motion,
        or 0 without one.
    modes
        Number of modes, from the lowest.
    t_end
        End of the transients with its unit, e.g. "2 s"; default: a hundred periods of the first mode after
        the spin-up, or from rest if the spin-up is long.
    budget
        Approximate computing time, e.g. "60 s"; measurements that do not fit are left out and listed.
    outputs
        Output files.
    """
    from beamdyn import load_scene
    from beamdyn.common.edge.html_report import Question
    from beamdyn.common.edge.tables import progress_bar
    from beamdyn.tradeoffs import tradeoff

    outputs.check(scene)
    given = None if speed is None else parse_speed("--speed", speed)
    end = None if t_end is None else parse_positive("--t-end", t_end, "s")
    limit = parse_positive("--budget", budget, "s")
    loaded = load_scene(scene)
    question = Question.on_file(
        "beamdyn tradeoff", scene, speed=speed, modes=modes, t_end=t_end, budget=budget
    )
    with progress_bar("measuring") as progress:
        result = tradeoff(loaded, given, modes, end, limit, progress)
    tables, rows, draw = (
        [_table(diagram) for diagram in result.diagrams],
        _csv(result),
        on_axes(lambda ax: _draw(result, ax)),
    )
    deliver(result, outputs, question, tables, rows, draw, result.warnings)


def _table(diagram: Diagram) -> Group:
    """Cost of each digit, the Pareto front, and the reference of the errors."""
    from rich.console import Group
    from rich.text import Text as Line

    from beamdyn.common.edge.tables import table

    rows = [
        (f"{d.error:.0e}", d.family, d.setting, f"{1e3 * d.time:.3g}", "" if i == 0 else f"{d.ratio:.2f}")
        for i, d in enumerate(diagram.per_digit)
    ]
    heads = ("error", "cheapest", "setting", "time [ms]", "over the digit before")
    return Group(
        table(diagram.title[:1].upper() + diagram.title[1:], heads, rows, (1, 2)),
        Line(f"Pareto front: {diagram.summary}."),
        Line(f"Error: of {diagram.error_of}."),
        Line(f"Reference: {diagram.reference}; errors below {diagram.resolved:.0e} count as that."),
        *(Line(f"Left out: {sentence}.") for sentence in diagram.skipped),
        Line(),
    )


def _csv(result: Tradeoff) -> Iterator[Sequence[object]]:
    yield "diagram", "family", "setting", "size", "relative_error", "time_s", "in_front"
    for diagram in result.diagrams:
        for m in diagram.measurements:
            yield diagram.title, m.family, m.setting, m.size, m.error, m.time, m in diagram.front


def _draw(result: Tradeoff, ax: Axes) -> None:
    rows, figure = -(-len(result.diagrams) // 2), ax.figure
    size: Any = figure
    size.set_size_inches(6.5 * min(2, len(result.diagrams)), 4.5 * rows)
    result.plot(ax)
