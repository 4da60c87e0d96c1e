"""The command of studies: an answer over all combinations of inputs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from beamdyn.cli.program import app, deliver
from beamdyn.cli.values import (
    Discretization,
    ModeCount,
    PhysicsOption,
    SceneFile,
    Text,
    Workers,
    load_with,
    speed_or_final,
)
from beamdyn.common.edge.outputs import NO_FILES, Outputs, on_axes

if TYPE_CHECKING:
    from beamdyn.common.edge.input_sweep import Axis
    from beamdyn.common.edge.inputs import Input

Varied = Annotated[tuple[str, ...], Parameter(name="--vary", allow_leading_hyphen=True, negative=())]
_MOST = 1_000_000  # designs
_OPTION = "--vary"


@app.command
def study(
    scene: SceneFile,
    /,
    *,
    vary: Varied,
    what: Literal["frequencies", "critical_speed", "amplitude"] = "frequencies",
    speed: Text | None = None,
    modes: ModeCount = 3,
    together: Annotated[bool, Parameter(negative="")] = False,
    discretization: Discretization = "ritz",
    tolerance: float | None = None,
    workers: Workers = 1,
    physics: PhysicsOption = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Frequencies, critical speeds or amplitudes over all combinations of inputs of the scene.

    For example: beamdyn study scene.toml --vary "beam.thickness=0.1:0.4:31 mm" --vary "speed=0:100:11 rad/s"

    Parameters
    ----------
    scene
        The scene.
    vary
        An input and its values, name=start:stop:count and a unit: "beam.thickness=0.1:0.4:31 mm". Names are
        those of the file, or "speed"; give the option once for each input.
    what
        frequencies, with their errors; critical_speed, at which the beam buckles; or amplitude, of the tip in
        steady motion.
    speed
        Speed of frequencies and amplitudes with its unit, where it is not varied; default: the final speed of
        the scene's motion, or 0 without one.
    modes
        Number of frequencies, from the lowest.
    together
        Take the first values of all inputs, then the second, in place of all combinations.
    discretization
        ritz: assumed modes; fem: finite elements. They are independent, so that each checks the other.
    tolerance
        Largest relative error of a frequency: the cheapest discretization that meets it is chosen.
    workers
        Number of processes; the answer is the same for any.
    physics
        auto: add the effects whose size exceeds the tolerance, in place of the physics of the scene.
    outputs
        Output files.
    """
    from beamdyn import study
    from beamdyn.cautions import warnings_of
    from beamdyn.common.edge.html_report import Question
    from beamdyn.common.edge.input_sweep import check_cases, parse_axis
    from beamdyn.common.edge.tables import progress_bar
    from beamdyn.common.edge.wording import of_file
    from beamdyn.tables.studies import study_csv, study_table

    outputs.check(scene)
    known = _inputs()
    axes = [parse_axis(known, text, _OPTION) for text in vary]
    check_cases(axes if not together else axes[:1], _MOST, _OPTION)
    loaded = load_with(scene, physics)
    options = {"modes": modes, "discretization": discretization, "tolerance": tolerance, "workers": workers}
    question = Question.on_file(
        "beamdyn study", scene, vary=", ".join(vary), what=what, speed=speed, **options, physics=physics
    )
    with progress_bar("designs") as progress, of_file({}):
        result = study(
            loaded,
            {axis.input.path: axis.values for axis in axes},
            what,
            speed=speed_or_final(loaded, speed),
            modes=modes,
            combine="zip" if together else "product",
            discretization=discretization,
            tolerance=tolerance,
            workers=workers,
            progress=progress,
        )
    units = {axis.input.path: _unit_of(axis) for axis in axes if axis.unit}
    tables, rows = [study_table(result, units)], study_csv(result)
    deliver(result, outputs, question, tables, rows, on_axes(result.plot), warnings_of(result, tolerance))


def _inputs() -> list[Input]:
    """The inputs of scene files that a study varies, each once, and the speed."""
    from beamdyn.common.edge.input_sweep import numbers
    from beamdyn.common.edge.inputs import Input, Quantity, describe
    from beamdyn.config import SceneInput
    from beamdyn.studies.inputs import NAMES, SPEED

    by_path = {entry.path: entry for entry in numbers(describe(SceneInput)) if entry.path in NAMES}
    of_speed = Quantity("rad/s", "omega", "speed")
    return [*by_path.values(), Input(SPEED, SceneInput, float, of_speed, (), False, None)]


def _unit_of(axis: Axis) -> tuple[str, float]:
    """The unit in which the values of an input were given, and that unit in SI."""
    place = abs(axis.given).argmax()
    return axis.unit, float(axis.values[place] / axis.given[place])
