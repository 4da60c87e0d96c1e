"""Commands about natural frequencies: at one speed, over speed, where they vanish."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from beamdyn.cli.program import app, warn
from beamdyn.cli.values import Discretization, SceneFile, Text, asked_speed, parse_positive, parse_speeds
from beamdyn.common.edge.outputs import NO_FILES, Flag, Outputs, on_axes, write
from beamdyn.common.edge.program import NoAnswer

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from beamdyn.spectrum.modes import Locus, Modes


@app.command
def modes(
    scene: SceneFile,
    /,
    *,
    speed: Text | None = None,
    modes: int = 3,
    discretization: Discretization = "ritz",
    tolerance: float | None = None,
    shapes: Path | None = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Natural frequencies, errors and stability at one speed.

    Parameters
    ----------
    scene
        The scene.
    speed
        With its unit, e.g. "50 rad/s" or "525 rpm"; if not given, that of the scene's motion, or rest.
    modes
        How many modes.
    discretization
        Assumed modes or finite elements: each checks the other.
    tolerance
        Relative error that is allowed: the cheapest model that keeps it is chosen.
    shapes
        Write the mode shapes into this file for ParaView: .vtu or .vtk.
    outputs
        Files to write.
    """
    from beamdyn import load_scene, natural_modes
    from beamdyn.common.edge.html_report import Question, Report
    from beamdyn.common.edge.tables import show
    from beamdyn.result_tables import modes_table

    outputs.check(shapes=shapes)
    loaded = load_scene(scene)
    asked = Question.on_file(
        "beamdyn modes", scene, speed=speed, modes=modes, discretization=discretization, tolerance=tolerance
    )
    found = natural_modes(loaded, asked_speed(loaded, speed), modes, discretization, tolerance)
    warnings, refusal = [w for w in found.warnings if not w.startswith("unstable")], _unstable(found)
    show(tables := [modes_table(found)])
    report = Report(asked, tables, [*warnings, *refusal])
    write(found, outputs, _modes_csv(found), on_axes(found.plot), report)
    if shapes is not None:
        _write_shapes(found, shapes, outputs.force)
    warn(warnings)
    if refusal:
        raise NoAnswer(refusal[0])


@app.command
def locus(
    scene: SceneFile,
    /,
    *,
    speeds: Text,
    modes: int = 3,
    discretization: Discretization = "ritz",
    tolerance: float | None = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Natural frequencies over speed, each mode followed through crossings.

    Parameters
    ----------
    scene
        The scene.
    speeds
        With their unit: start:stop:count, e.g. "0:150:301 rad/s", or a list, e.g. "0, 50, 100 rad/s".
    modes
        How many modes.
    discretization
        Assumed modes or finite elements: each checks the other.
    tolerance
        Relative error that is allowed: the cheapest model that keeps it is chosen.
    outputs
        Files to write.
    """
    from beamdyn import frequency_locus, load_scene
    from beamdyn.common.edge.html_report import Question, Report
    from beamdyn.common.edge.tables import show
    from beamdyn.result_tables import locus_table

    outputs.check()
    given = parse_speeds(speeds)
    asked = Question.on_file(
        "beamdyn locus", scene, speeds=speeds, modes=modes, discretization=discretization, tolerance=tolerance
    )
    found = frequency_locus(load_scene(scene), given, modes, discretization, tolerance)
    show(tables := [locus_table(found)])
    report = Report(asked, tables, found.warnings)
    write(found, outputs, _locus_csv(found), on_axes(partial(_draw_locus, found)), report)
    warn(found.warnings)


@app.command
def critical(
    scene: SceneFile,
    /,
    *,
    discretization: Discretization = "ritz",
    json: Path | None = None,
    force: Flag = False,
) -> None:
    """Speed at which the rotating beam buckles.

    Parameters
    ----------
    scene
        The scene.
    discretization
        Assumed modes or finite elements: each checks the other.
    json
        Write the result with its error estimate and provenance into this file.
    force
        Overwrite a file that exists.
    """
    from beamdyn import critical_point, load_scene
    from beamdyn.common.digits import supported
    from beamdyn.common.edge.tables import console

    outputs = Outputs(json=json, force=force)
    outputs.check()
    found = critical_point(load_scene(scene), discretization)
    value = supported(found.speed, found.error * found.speed, 12)
    stiff = "no critical speed: at no speed does the beam buckle"
    console().print(stiff if value == "inf" else f"critical speed: {value} rad/s; above it the beam buckles")
    write(found, outputs)


@app.command
def limits(
    scene: SceneFile,
    /,
    *,
    top_speed: Text,
    discretization: Discretization = "ritz",
    json: Path | None = None,
    force: Flag = False,
) -> None:
    """Setting angles at which the first frequency stops falling, and starts rising, with speed.

    Parameters
    ----------
    scene
        The scene; its own setting angle is not used.
    top_speed
        Speed up to which the second limit holds, with its unit, e.g. "400 rad/s".
    discretization
        Assumed modes or finite elements: each checks the other.
    json
        Write the result with its error estimate and provenance into this file.
    force
        Overwrite a file that exists.
    """
    from math import isnan

    from beamdyn import load_scene, setting_angle_limits
    from beamdyn.common.edge.tables import console
    from beamdyn.result_tables import limits_table

    outputs = Outputs(json=json, force=force)
    outputs.check()
    asked = parse_positive("--top-speed", top_speed, "rad/s")
    found = setting_angle_limits(load_scene(scene), asked, discretization)
    write(found, outputs)
    if isnan(found.first) or isnan(found.second):
        raise NoAnswer(found.warnings[0])
    console().print(limits_table(found))
    warn(found.warnings)


@app.command
def terms(scene: SceneFile, /, *, json: Path | None = None, force: Flag = False) -> None:
    """Terms of the equations of motion: which are in the scene, and why.

    Parameters
    ----------
    scene
        The scene.
    json
        Write the list into this file.
    force
        Overwrite a file that exists.
    """
    from beamdyn import load_scene
    from beamdyn.common.edge.tables import console, table
    from beamdyn.equations.terms import terms

    outputs = Outputs(json=json, force=force)
    outputs.check()
    found = terms(load_scene(scene))
    heads = ("", "term", "symbol", "largest", "reason")
    console().print(table("Terms of the equations of motion", heads, found.rows(), (0, 1, 2, 4)))
    console().print(found.excited())
    write(found, outputs)


def _draw_locus(found: Locus, ax: Axes) -> None:
    from beamdyn import critical_speed
    from beamdyn.output.plots import mark_critical

    mark_critical(found.plot(ax), critical_speed(found.scene))


def _write_shapes(found: Modes, path: Path, force: bool) -> None:
    import numpy as np

    from beamdyn.output.export import write_shapes

    x = np.linspace(0, found.scene.beam.length, 101)
    write_shapes(path, x, np.real(found.shape(x)), found.labels(), force=force)


def _modes_csv(found: Modes) -> Iterator[Sequence[object]]:
    yield "mode", "speed_rad_per_s", "frequency_Hz", "relative_error", "growth_rate_per_s", "status"
    columns = found.frequency, found.error, found.growth_rate, found.status
    for mode, row in enumerate(zip(*(column.tolist() for column in columns), strict=True), 1):
        yield mode, found.speed, *row


def _locus_csv(found: Locus) -> Iterator[Sequence[object]]:
    names = ("frequency_Hz", "relative_error", "growth_rate_per_s", "status", "confidence")
    columns = found.frequency, found.error, found.growth_rate, found.status, found.confidence
    numbers = range(1, found.frequency.shape[1] + 1)
    yield "speed_rad_per_s", *(f"{name}_{mode}" for name in names for mode in numbers)
    for speed, *rows in zip(found.speeds.tolist(), *(column.tolist() for column in columns), strict=True):
        yield speed, *(value for row in rows for value in row)


def _unstable(found: Modes) -> list[str]:
    """The sentence that says which mode grows, and from what speed on the beam does; none if none grows."""
    from beamdyn import critical_speed

    grows = [i for i, status in enumerate(found.status) if status in ("divergence", "flutter")]
    if not grows:
        return []
    which = ", ".join(f"mode {i + 1} ({found.status[i]}, {found.growth_rate[i]:.4g} 1/s)" for i in grows)
    critical = critical_speed(found.scene)
    where = f"; the critical speed is {critical:.6g} rad/s" if critical <= found.speed else ""
    return [f"unstable at {found.speed:g} rad/s: {which}{where}"]
