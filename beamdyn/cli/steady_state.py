"""Commands on the steady state: speeds of resonance, and the response over speed."""

from __future__ import annotations

from typing import Any

from beamdyn.cli.program import app, deliver
from beamdyn.cli.values import (
    BasisSize,
    Discretization,
    ModeCount,
    Order,
    PhysicsOption,
    SceneFile,
    Text,
    load_with,
    parse_positive,
    parse_speeds,
)
from beamdyn.common.edge.outputs import NO_FILES, Outputs, on_axes
from beamdyn.common.edge.program import examples


@app.command(
    help_epilogue=examples(
        'beamdyn resonances examples/rolling_harvester.toml --top-speed "150 rad/s"',
    )
)
def resonances(
    scene: SceneFile,
    /,
    *,
    top_speed: Text,
    modes: ModeCount = 3,
    order: Order = 1,
    discretization: Discretization = "ritz",
    physics: PhysicsOption = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Speeds of resonance, at which a frequency that the scene excites meets a natural frequency.

    Parameters
    ----------
    scene
        The scene; its motion and gravity give the frequencies that are excited.
    top_speed
        Largest speed to search, with its unit, e.g. "150 rad/s".
    modes
        Number of modes, from the lowest.
    order
        1: resonances with the load; more: also combination resonances by the periodic coefficients.
    discretization
        ritz: assumed modes; fem: finite elements. They are independent, so that each checks the other.
    physics
        auto: add the effects whose size exceeds the tolerance, in place of the physics of the scene.
    outputs
        Output files.
    """
    from beamdyn import resonance_speeds
    from beamdyn.cautions import warnings_of
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.results import crossings_table
    from beamdyn.tables.rows import crossings_csv

    outputs.check(scene)
    loaded = load_with(scene, physics, top_speed)
    top = parse_positive("--top-speed", top_speed, "rad/s", loaded)
    options = {"modes": modes, "order": order, "discretization": discretization}
    question = Question.on_file("beamdyn resonances", scene, top_speed=top_speed, **options, physics=physics)
    result = resonance_speeds(loaded, top, modes, order, discretization)
    tables, rows, draw = [crossings_table(result)], crossings_csv(result), on_axes(result.plot)
    deliver(result, outputs, question, tables, rows, draw, warnings_of(result))


@app.command(
    help_epilogue=examples(
        'beamdyn steady examples/rolling_harvester.toml --speeds "1:150:30 rad/s"',
    )
)
def steady(
    scene: SceneFile,
    /,
    *,
    speeds: Text,
    modes: BasisSize = "auto",
    tolerance: float = 1e-5,
    discretization: Discretization = "ritz",
    physics: PhysicsOption = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Steady response over speed, after the transient of the start has decayed.

    Parameters
    ----------
    scene
        The scene.
    speeds
        Speeds with their unit: start:stop:count, e.g. "1:150:1000 rad/s", or a list, e.g. "50, 55 rad/s".
    modes
        Size of the modal basis; auto: the smallest whose modal truncation error meets the tolerance.
    tolerance
        Largest error by the harmonics left out, relative to the sum of all lines.
    discretization
        ritz: assumed modes; fem: finite elements. They are independent, so that each checks the other.
    physics
        auto: add the effects whose size exceeds the tolerance, in place of the physics of the scene.
    outputs
        Output files.
    """
    from beamdyn import steady_response
    from beamdyn.cautions import warnings_of
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.results import steady_table
    from beamdyn.tables.rows import steady_csv

    outputs.check(scene)
    loaded = load_with(scene, physics, speeds)
    given = parse_speeds(speeds, loaded)
    options: dict[str, Any] = {"modes": modes, "tolerance": tolerance, "discretization": discretization}
    question = Question.on_file("beamdyn steady", scene, speeds=speeds, **options, physics=physics)
    result = steady_response(loaded, given, **options)
    none = f"at none of {len(given)} speeds is there a steady response: {result.status[0]}"
    refusal = "" if result.stable.any() else none
    tables, rows, draw = [steady_table(result)], steady_csv(result), on_axes(result.plot)
    deliver(result, outputs, question, tables, rows, draw, warnings_of(result), refusal)
