"""Sensitivities: which number of a scene matters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

import beamdyn as bd
from beamdyn.analyses.analysis import Answer, analysis
from beamdyn.analyses.options import Count, Discretization, Order, Text
from beamdyn.analyses.values import final_speed, parse_positive, parse_speed

if TYPE_CHECKING:
    from beamdyn.scene.scene import Scene
    from beamdyn.studies.sensitivities.result import Sensitivities

Kind = Literal["frequencies", "critical_speed", "crossings"]
_OPTIONS = {  # options on which each answer depends
    "frequencies": ("speed", "modes", "tolerance"),
    "critical_speed": ("tolerance",),
    "crossings": ("speed", "modes", "order"),
}


@analysis(
    "beamdyn sensitivities examples/tyre_harvester.toml --inputs beam.thickness",
    "beamdyn sensitivities examples/tyre_harvester.toml --what critical_speed",
    moving=lambda options: options["what"] == "crossings",
)
def sensitivities(
    scene: Scene,
    *,
    what: Kind = "frequencies",
    speed: Text | None = None,
    modes: Count | None = None,
    order: Order | None = None,
    inputs: Annotated[tuple[str, ...], Parameter(negative="", show_default=False)] = (),
    discretization: Discretization = "ritz",
    tolerance: float | None = None,
) -> Answer:
    """Derivatives of frequencies, of the critical speed or of resonance speeds by the numbers of the scene.

    Parameters
    ----------
    what
        frequencies; critical_speed, at which the beam buckles; or crossings, the speeds at which
        modes meet lines of the excitation.
    speed
        Speed of frequencies with its unit, top speed of crossings; default: the final speed of the
        scene's motion, or 0 without one.
    modes
        Number of modes of frequencies and crossings, from the lowest; default: 3.
    order
        Of crossings, as of resonances: 1, the default: resonances with the load; more: also
        combination resonances by the periodic coefficients.
    inputs
        Numbers by their names in the file, such as beam.thickness, or speed, the option once for
        each; all if not given.
    tolerance
        Largest relative error of a frequency or critical speed: the cheapest discretization that
        meets it is chosen; 1e-11 if not given.
    """
    from beamdyn.common.edge.wording import of_file
    from beamdyn.common.inputs.checks import check_used

    check_used(what, _OPTIONS, speed=speed, modes=modes, order=order, tolerance=tolerance)
    named, count = inputs or None, 3 if modes is None else modes
    with of_file({}):
        if what == "frequencies":
            at = final_speed(scene) if speed is None else parse_speed("--speed", speed, scene)
            result = bd.frequency_sensitivities(scene, at, count, named, discretization, tolerance)
        elif what == "critical_speed":
            result = bd.critical_speed_sensitivities(scene, named, discretization, tolerance)
        else:
            top = final_speed(scene)
            top = top if speed is None else parse_positive("--speed", speed, "rad/s", scene)
            result = bd.crossing_sensitivities(scene, top, count, named, order or 1, discretization)
    return Answer(result, _refusal(result))


def _refusal(result: Sensitivities) -> str:
    """Which of the answers has no derivative, because it is none; empty if each has."""
    import numpy as np

    lost = [name for name, known in zip(result.answers, np.isfinite(result.value), strict=True) if not known]
    return f"{' and '.join(lost)}: no such frequency, and no derivative of it" if lost else ""
