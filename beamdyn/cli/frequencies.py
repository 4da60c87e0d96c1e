"""Commands on natural frequencies: at one speed, over speed, and where the beam buckles."""

from __future__ import annotations

from functools import partial
from math import isinf
from pathlib import Path
from typing import TYPE_CHECKING

from beamdyn.cli.program import app, deliver
from beamdyn.cli.values import (
    Discretization,
    ModeCount,
    PhysicsOption,
    SceneFile,
    Text,
    load_with,
    parse_positive,
    parse_speeds,
    speed_or_final,
    unit_of_speed,
)
from beamdyn.common.edge.outputs import NO_FILES, Flag, Outputs, on_axes
from beamdyn.common.edge.program import examples
from beamdyn.common.statements import GROWING, OUTSIDE, of_kind

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from beamdyn.spectrum.locus import Locus
    from beamdyn.spectrum.modes import Modes


_GROWING = "divergence", "flutter"  # states of modes


@app.command(help_epilogue=examples('beamdyn modes examples/tyre_harvester.toml --speed "50 rad/s"'))
def modes(
    scene: SceneFile,
    /,
    *,
    speed: Text | None = None,
    modes: ModeCount = 3,
    discretization: Discretization = "ritz",
    tolerance: float | None = None,
    shapes: Path | None = None,
    physics: PhysicsOption = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Natural frequencies at one speed, with their errors and stability.

    Parameters
    ----------
    scene
        The scene.
    speed
        Speed with its unit, e.g. "50 rad/s" or "525 rpm"; default: the final speed of the scene's motion,
        or 0 without one.
    modes
        Number of modes, from the lowest.
    discretization
        ritz: assumed modes; fem: finite elements. They are independent, so that each checks the other.
    tolerance
        Largest relative error of a frequency: the cheapest discretization that meets it is chosen; 1e-11
        if not given.
    shapes
        Write the mode shapes into this file for ParaView: .vtu or .vtk.
    physics
        auto: add the effects whose size exceeds the tolerance, in place of the physics of the scene.
    outputs
        Output files.
    """
    from beamdyn import natural_modes
    from beamdyn.cautions import warnings_of
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.results import modes_table
    from beamdyn.tables.rows import modes_csv

    outputs.check(scene, shapes=shapes)
    loaded = load_with(scene, physics, speed)
    question = Question.on_file(
        "beamdyn modes",
        scene,
        speed=speed,
        modes=modes,
        discretization=discretization,
        tolerance=tolerance,
        physics=physics,
    )
    result = natural_modes(loaded, speed_or_final(loaded, speed), modes, discretization, tolerance)
    if shapes is not None:
        _write_shapes(result, shapes, outputs.force)
    warnings = warnings_of(result, tolerance, without=GROWING)
    refusal = _unstable(result)
    tables, rows, draw = [modes_table(result)], modes_csv(result), on_axes(result.plot)
    deliver(result, outputs, question, tables, rows, draw, warnings, refusal)


@app.command(
    help_epilogue=examples(
        'beamdyn locus examples/tyre_harvester.toml --speeds "0:150:31 rad/s"',
    )
)
def locus(
    scene: SceneFile,
    /,
    *,
    speeds: Text,
    modes: ModeCount = 3,
    discretization: Discretization = "ritz",
    tolerance: float | None = None,
    physics: PhysicsOption = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Natural frequencies over speed; each mode is tracked through crossings.

    Parameters
    ----------
    scene
        The scene.
    speeds
        Speeds with their unit: start:stop:count, e.g. "0:150:301 rad/s", or a list, e.g. "0, 50, 100 rad/s".
    modes
        Number of modes, from the lowest.
    discretization
        ritz: assumed modes; fem: finite elements. They are independent, so that each checks the other.
    tolerance
        Largest relative error of a frequency: the cheapest discretization that meets it is chosen; 1e-11
        if not given.
    physics
        auto: add the effects whose size exceeds the tolerance, in place of the physics of the scene.
    outputs
        Output files.
    """
    from beamdyn import frequency_locus
    from beamdyn.cautions import warnings_of
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.results import locus_table
    from beamdyn.tables.rows import locus_csv

    outputs.check(scene)
    loaded = load_with(scene, physics, speeds)
    given = parse_speeds(speeds, loaded)
    question = Question.on_file(
        "beamdyn locus",
        scene,
        speeds=speeds,
        modes=modes,
        discretization=discretization,
        tolerance=tolerance,
        physics=physics,
    )
    result = frequency_locus(loaded, given, modes, discretization, tolerance)
    tables, rows, draw = [locus_table(result)], locus_csv(result), on_axes(partial(_draw_locus, result))
    deliver(result, outputs, question, tables, rows, draw, warnings_of(result, tolerance), _never(result))


@app.command(help_epilogue=examples("beamdyn critical examples/tyre_harvester.toml"))
def critical(
    scene: SceneFile,
    /,
    *,
    discretization: Discretization = "ritz",
    physics: PhysicsOption = None,
    json: Path | None = None,
    report: Path | None = None,
    force: Flag = False,
) -> None:
    """Critical speed, at which the rotating beam buckles; or why there is none, or up to which speed.

    Parameters
    ----------
    scene
        The scene.
    discretization
        ritz: assumed modes; fem: finite elements. They are independent, so that each checks the other.
    physics
        auto: add the effects whose size exceeds the tolerance, in place of the physics of the scene.
    json
        Write the result with its error estimate and provenance into this file.
    report
        Write inputs, result and warnings into this file, which needs no other: .html.
    force
        Overwrite files that exist.
    """
    from beamdyn import critical_point
    from beamdyn.cautions import warnings_of
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.results import critical_answer

    outputs = Outputs(json=json, report=report, force=force)
    outputs.check(scene)
    result = critical_point(load_with(scene, physics), discretization)
    question = Question.on_file("beamdyn critical", scene, discretization=discretization, physics=physics)
    # With an infinite error there is one, perhaps, but it was not found or not resolved.
    refusal = "; ".join(result.warnings) if isinf(result.error) else ""
    warnings = [] if refusal else warnings_of(result)
    deliver(result, outputs, question, [critical_answer(result)], warnings=warnings, refusal=refusal)


@app.command(
    help_epilogue=examples(
        'beamdyn limits examples/tyre_harvester.toml --top-speed "400 rad/s"',
    )
)
def limits(
    scene: SceneFile,
    /,
    *,
    top_speed: Text,
    discretization: Discretization = "ritz",
    physics: PhysicsOption = None,
    json: Path | None = None,
    report: Path | None = None,
    force: Flag = False,
) -> None:
    """Setting angles that separate a first frequency that falls with speed from one that rises.

    Parameters
    ----------
    scene
        The scene; its own setting angle is not used.
    top_speed
        Speed up to which the frequency must rise for the second limit, with its unit, e.g. "400 rad/s".
    discretization
        ritz: assumed modes; fem: finite elements. They are independent, so that each checks the other.
    physics
        auto: the plain beam; the limits belong to linear theory, and nothing is added.
    json
        Write the result with its error estimate and provenance into this file.
    report
        Write inputs, result and warnings into this file, which needs no other: .html.
    force
        Overwrite files that exist.
    """
    from math import isnan

    from beamdyn import setting_angle_limits
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.results import limits_table

    outputs = Outputs(json=json, report=report, force=force)
    outputs.check(scene)
    top = parse_positive("--top-speed", top_speed, "rad/s")
    result = setting_angle_limits(load_with(scene, physics), top, discretization)
    result = result.in_units(speed=unit_of_speed(top_speed))
    question = Question.on_file(
        "beamdyn limits", scene, top_speed=top_speed, discretization=discretization, physics=physics
    )
    if isnan(result.first) or isnan(result.second):
        deliver(result, outputs, question, [], refusal=result.warnings[0])
    deliver(result, outputs, question, [limits_table(result)], warnings=result.warnings)


@app.command(help_epilogue=examples("beamdyn terms examples/rolling_harvester.toml"))
def terms(
    scene: SceneFile,
    /,
    *,
    physics: PhysicsOption = None,
    json: Path | None = None,
    report: Path | None = None,
    force: Flag = False,
) -> None:
    """Terms of the equations of motion: which of them the scene has, and why.

    Parameters
    ----------
    scene
        The scene.
    physics
        auto: add the effects whose size exceeds the tolerance, in place of the physics of the scene.
    json
        Write the list into this file.
    report
        Write inputs and the list into this file, which needs no other: .html.
    force
        Overwrite files that exist.
    """
    from beamdyn.common.edge.html_report import Question
    from beamdyn.equations.terms import terms
    from beamdyn.tables.single_answers import terms_table

    outputs = Outputs(json=json, report=report, force=force)
    outputs.check(scene)
    result = terms(load_with(scene, physics))
    question = Question.on_file("beamdyn terms", scene, physics=physics)
    deliver(result, outputs, question, [terms_table(result)])


def _draw_locus(result: Locus, ax: Axes) -> None:
    from beamdyn import critical_point
    from beamdyn.cautions import critical_label
    from beamdyn.output.plots import mark_critical

    critical = critical_point(result.scene)
    mark_critical(result.plot(ax), critical.speed, critical_label(critical), result.display_units)


def _write_shapes(result: Modes, path: Path, force: bool) -> None:
    import numpy as np

    from beamdyn.cautions import labels_of
    from beamdyn.output.export import write_shapes

    x = np.linspace(0, result.scene.beam.length, 101)
    write_shapes(path, x, np.real(result.shape(x)), labels_of(result), force=force)


def _never(result: Locus) -> str:
    """That the beam is stable at none of the speeds; empty if it is at one."""
    import numpy as np

    unstable = np.isin(result.status, _GROWING).any(axis=1)
    return f"at none of {len(result.speeds)} speeds is the beam stable" if unstable.all() else ""


def _unstable(result: Modes) -> str:
    """The sentence that names the unstable modes and the critical speed; empty if all are stable."""
    from beamdyn import critical_point

    unstable = [i for i, status in enumerate(result.status) if status in _GROWING]
    if not unstable:
        return ""
    which = ", ".join(f"mode {i + 1} ({result.status[i]}, {result.growth_rate[i]:.4g} 1/s)" for i in unstable)
    critical = critical_point(result.scene)
    said = f"; the critical speed is {critical.speed:.6g} rad/s" if critical.speed <= result.speed else ""
    straight = ", were the beam straight" if of_kind(critical.warnings, OUTSIDE) else ""
    return f"unstable at {result.speed:g} rad/s: {which}{said}{straight}"
