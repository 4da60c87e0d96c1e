"""Commands on the steady state: speeds of resonance, and the response over speed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from beamdyn.cli.program import app, warn
from beamdyn.cli.values import (
    BasisSize,
    Discretization,
    SceneFile,
    Text,
    parse_positive,
    parse_speeds,
)
from beamdyn.common.edge.outputs import NO_FILES, Outputs, on_axes, write
from beamdyn.common.edge.program import NoAnswer

if TYPE_CHECKING:
    from beamdyn.steady.resonance import Crossings
    from beamdyn.steady.response import SteadyResponse


@app.command
def resonances(
    scene: SceneFile,
    /,
    *,
    top_speed: Text,
    modes: int = 3,
    order: int = 1,
    discretization: Discretization = "ritz",
    outputs: Outputs = NO_FILES,
) -> None:
    """Speeds at which what the scene excites meets a natural frequency.

    Parameters
    ----------
    scene
        The scene; its motion and gravity give the frequencies that are excited.
    top_speed
        Speed up to which is searched, with its unit, e.g. "150 rad/s".
    modes
        How many modes.
    order
        1: what the load excites; more: also the combinations made by the stiffness that turns.
    discretization
        Assumed modes or finite elements: each checks the other.
    outputs
        Files to write.
    """
    from beamdyn import load_scene, resonance_speeds
    from beamdyn.common.edge.html_report import Question, Report
    from beamdyn.common.edge.tables import show
    from beamdyn.result_tables import crossings_table

    outputs.check()
    top = parse_positive("--top-speed", top_speed, "rad/s")
    asked = Question.on_file(
        "beamdyn resonances",
        scene,
        top_speed=top_speed,
        modes=modes,
        order=order,
        discretization=discretization,
    )
    found = resonance_speeds(load_scene(scene), top, modes, order, discretization)
    show(tables := [crossings_table(found)])
    report = Report(asked, tables, found.warnings)
    write(found, outputs, _crossings_csv(found), on_axes(found.plot), report)
    warn(found.warnings)


@app.command
def steady(
    scene: SceneFile,
    /,
    *,
    speeds: Text,
    modes: BasisSize = "auto",
    tolerance: float = 1e-5,
    discretization: Discretization = "ritz",
    outputs: Outputs = NO_FILES,
) -> None:
    """Steady response over speed: what is left when the start has died away.

    Parameters
    ----------
    scene
        The scene.
    speeds
        With their unit: start:stop:count, e.g. "1:150:1000 rad/s", or a list, e.g. "50, 55 rad/s".
    modes
        How many modes at rest; auto: as few as leave no more than the tolerance out.
    tolerance
        Largest error by neglected harmonics, relative to the sum of the lines.
    discretization
        Assumed modes or finite elements: each checks the other.
    outputs
        Files to write.
    """
    from beamdyn import load_scene, steady_response
    from beamdyn.common.edge.html_report import Question, Report
    from beamdyn.common.edge.tables import show
    from beamdyn.result_tables import steady_table

    outputs.check()
    given = parse_speeds(speeds)
    asked = Question.on_file(
        "beamdyn steady",
        scene,
        speeds=speeds,
        modes=modes,
        tolerance=tolerance,
        discretization=discretization,
    )
    found = steady_response(
        load_scene(scene), given, modes, tolerance=tolerance, discretization=discretization
    )
    none = f"at none of {len(given)} speeds is there a steady response: {found.status[0]}"
    refusal = [] if found.stable.any() else [none]
    show(tables := [steady_table(found)])
    report = Report(asked, tables, [*found.warnings, *refusal])
    write(found, outputs, _steady_csv(found), on_axes(found.plot), report)
    warn(found.warnings)
    if refusal:
        raise NoAnswer(none)


def _crossings_csv(found: Crossings) -> Iterator[Sequence[object]]:
    yield (
        "speed_rad_per_s",
        "relative_error",
        "frequency_Hz",
        "line",
        "multiple",
        "mode",
        "second_mode",
        "kind",
    )
    for c in found:
        second = "" if c.second_mode is None else c.second_mode
        yield c.speed, c.error, c.frequency, c.line.name, c.line.multiple, c.mode, second, c.kind


def _steady_csv(found: SteadyResponse) -> Iterator[Sequence[object]]:
    yield "speed_rad_per_s", "amplitude_m", "sum_of_lines_m", "relative_error", "growth_rate_per_s", "status"
    columns = found.speeds, found.amplitude, found.bound, found.error, found.growth_rate, found.status
    yield from zip(*(column.tolist() for column in columns), strict=True)
