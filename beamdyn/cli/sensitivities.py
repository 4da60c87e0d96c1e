"""The command of sensitivities: which number of a scene matters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from beamdyn.cli.program import app, deliver
from beamdyn.cli.values import (
    Discretization,
    ModeCount,
    Order,
    PhysicsOption,
    SceneFile,
    Text,
    load_moving,
    load_with,
    parse_positive,
    speed_or_final,
)
from beamdyn.common.edge.outputs import NO_FILES, Outputs, on_axes
from beamdyn.common.edge.program import examples

if TYPE_CHECKING:
    from beamdyn.scene.scene import Scene
    from beamdyn.sensitivities.result import Sensitivities

Answer = Literal["frequencies", "critical_speed", "crossings"]
_OPTIONS = {  # on which each answer depends
    "frequencies": ("speed", "modes", "tolerance"),
    "critical_speed": ("tolerance",),
    "crossings": ("speed", "modes", "order"),
}


@app.command(
    help_epilogue=examples(
        "beamdyn sensitivities examples/tyre_harvester.toml --inputs beam.thickness",
        "beamdyn sensitivities examples/tyre_harvester.toml --what critical_speed",
    )
)
def sensitivities(
    scene: SceneFile,
    /,
    *,
    what: Answer = "frequencies",
    speed: Text | None = None,
    modes: ModeCount | None = None,
    order: Order | None = None,
    inputs: Annotated[tuple[str, ...], Parameter(negative="", show_default=False)] = (),
    discretization: Discretization = "ritz",
    tolerance: float | None = None,
    physics: PhysicsOption = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Derivatives of frequencies, of the critical speed or of resonance speeds by the numbers of the scene.

    Parameters
    ----------
    scene
        The scene.
    what
        frequencies; critical_speed, at which the beam buckles; or crossings, the speeds at which modes meet
        lines of the excitation.
    speed
        Speed of frequencies with its unit, top speed of crossings; default: the final speed of the scene's
        motion, or 0 without one.
    modes
        Number of modes of frequencies and crossings, from the lowest; default: 3.
    order
        Of crossings, as of resonances: 1, the default: resonances with the load; more: also combination
        resonances by the periodic coefficients.
    inputs
        Numbers by their names in the file, such as beam.thickness, or speed, the option once for each; all if
        not given.
    discretization
        ritz: assumed modes; fem: finite elements. They are independent, so that each checks the other.
    tolerance
        Largest relative error of a frequency or critical speed: the cheapest discretization that meets it is
        chosen; 1e-11 if not given.
    physics
        auto: add the effects whose size exceeds the tolerance, in place of the physics of the scene.
    outputs
        Output files.
    """
    from beamdyn.common.checks import check_used
    from beamdyn.common.edge.html_report import Question
    from beamdyn.common.edge.wording import of_file
    from beamdyn.tables.sensitivities import sensitivities_csv, sensitivities_table

    outputs.check(scene)
    check_used(what, _OPTIONS, speed=speed, modes=modes, order=order, tolerance=tolerance)
    asked = {
        "what": what,
        "speed": speed,
        "modes": modes,
        "order": order,
        "inputs": ", ".join(inputs) or None,
    }
    options = {"discretization": discretization, "tolerance": tolerance, "physics": physics}
    question = Question.on_file("beamdyn sensitivities", scene, **asked, **options)
    loaded = load_moving(scene, physics) if what == "crossings" else load_with(scene, physics)
    with of_file({}):
        number, highest = 3 if modes is None else modes, 1 if order is None else order
        result = _solve(loaded, what, speed, number, highest, inputs or None, discretization, tolerance)
    tables, rows = [sensitivities_table(result)], sensitivities_csv(result)
    draw, refusal = on_axes(result.plot), _refusal(result)
    deliver(result, outputs, question, tables, rows, draw, result.warnings, refusal)


def _refusal(result: Sensitivities) -> str:
    """Which of the answers has no derivative, because it is none; empty if each has."""
    import numpy as np

    lost = [name for name, known in zip(result.answers, np.isfinite(result.value), strict=True) if not known]
    return f"{' and '.join(lost)}: no such frequency, and no derivative of it" if lost else ""


def _solve(
    scene: Scene,
    what: Answer,
    speed: str | None,
    modes: int,
    order: int,
    inputs: tuple[str, ...] | None,
    discretization: Discretization,
    tolerance: float | None,
) -> Sensitivities:
    from beamdyn import critical_speed_sensitivities, crossing_sensitivities, frequency_sensitivities

    if what == "frequencies":
        at = speed_or_final(scene, speed)
        return frequency_sensitivities(scene, at, modes, inputs, discretization, tolerance)
    if what == "critical_speed":
        return critical_speed_sensitivities(scene, inputs, discretization, tolerance)
    top = speed_or_final(scene, None) if speed is None else parse_positive("--speed", speed, "rad/s", scene)
    return crossing_sensitivities(scene, top, modes, inputs, order, discretization)
