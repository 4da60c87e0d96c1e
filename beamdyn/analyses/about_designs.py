"""Sensitivities, and studies: results over combinations of inputs, or their ranges over tolerances."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated, Any, Literal

import numpy as np
from cyclopts import Parameter

import beamdyn as bd
from beamdyn.analyses.analysis import Answer, analysis
from beamdyn.analyses.options import Count, Discretization, FrequencyTolerance, Order, Text
from beamdyn.analyses.values import in_unit_of, parse_positive, parse_speed, parse_window
from beamdyn.common.edge.command_options import NO_SPREAD, NOTHING_VARIED, OPTION, SpreadOptions, VaryOptions
from beamdyn.common.edge.console import at_work
from beamdyn.common.edge.inputs import Input, Quantity, describe
from beamdyn.common.edge.varied_inputs import Axis, designs_of, numbers, parse_axis, parse_spreads
from beamdyn.common.inputs.checks import check_used
from beamdyn.common.inputs.described import MOST_DESIGNS, check_designs
from beamdyn.common.results.columns import ShownUnit
from beamdyn.common.words import at_any
from beamdyn.files.scene_inputs import SceneInput
from beamdyn.scene.numbers import SCALE, SPEED, paths_of, unit_of
from beamdyn.studies.answers import NO_ANSWERS
from beamdyn.studies.questions import KINDS
from beamdyn.studies.spread import nominal_value

# Sensitivities ---------------------------------------------------------------------------------------


Derived = Literal["frequencies", "critical_speed", "crossings"]
_OPTIONS = {  # options that affect each kind of result
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
    scene: bd.Scene,
    *,
    what: Derived = "frequencies",
    speed: Text | None = None,
    modes: Count | None = None,
    order: Order | None = None,
    inputs: Annotated[tuple[str, ...], Parameter(negative="", show_default=False)] = (),
    discretization: Discretization = "ritz",
    tolerance: float | None = None,
) -> Answer:
    """Derivatives of frequencies, critical speed or resonance speeds with respect to a scene's inputs.

    Parameters
    ----------
    what
        frequencies; critical_speed, at which the beam buckles; or crossings, the speeds at which
        modes meet lines of the excitation.
    speed
        Speed at which frequencies are computed, or up to which crossings are searched, with its unit;
        default: the final speed of the scene's motion, or 0 without one.
    modes
        Number of modes of frequencies and crossings, from the lowest; default: 3.
    order
        Order of crossings: 1, the default: resonances excited by the load; more: also combination
        resonances caused by periodic coefficients of the equations.
    inputs
        Inputs by their names in the file, such as beam.thickness, or speed; give the option once for each
        input; default: all.
    tolerance
        Largest relative error of a frequency or critical speed: the cheapest discretization that
        meets it is chosen; if not given, 1e-11, or 1e-4 where a rectangular section cambers or twists.
    """
    check_used(what, _OPTIONS, speed=speed, modes=modes, order=order, tolerance=tolerance)
    named, count = inputs or None, 3 if modes is None else modes
    if what == "frequencies":
        at = scene.final_speed if speed is None else parse_speed("--speed", speed, scene)
        result = bd.frequency_sensitivities(scene, at, count, named, discretization, tolerance)
    elif what == "critical_speed":
        result = bd.critical_speed_sensitivities(scene, named, discretization, tolerance)
    else:
        top = scene.final_speed
        top = top if speed is None else parse_positive("--speed", speed, "rad/s", scene)
        result = bd.crossing_sensitivities(scene, top, count, named, order or 1, discretization)
    each = zip(result.answers, np.isfinite(result.value), strict=True)
    lost = " and ".join(name for name, known in each if not known)
    return Answer(result, lost and f"{lost}: no finite value, and so no derivative")


# Studies ---------------------------------------------------------------------------------------------


_FACTOR = "factor of a property along the beam"
Kind = Literal["frequencies", "critical_speed", "crossings", "amplitude", "peak", "strain", "power"]


@analysis(
    'beamdyn study examples/tyre_harvester.toml --vary "thickness=0.1:0.4:9 mm"',
    'beamdyn study examples/tyre_harvester.toml --spread "beam.thickness=+-2%"',
    screen="Map",
    opens_with=("--vary", "thickness=0.1:0.4:9 mm", "--vary", "speed=0:99:9 rad/s"),
)
def study(
    scene: bd.Scene,
    *,
    varying: VaryOptions = NOTHING_VARIED,
    spreading: SpreadOptions = NO_SPREAD,
    what: Kind = "frequencies",
    speed: Text | None = None,
    modes: Count | None = None,
    window: Text | None = None,
    discretization: Discretization = "ritz",
    tolerance: FrequencyTolerance = None,
) -> Answer:
    """Frequencies, critical or resonance speeds, amplitudes or peaks over all combinations of inputs.

    With tolerances: the ranges of these results, and the most influential input. At most a million designs
    are computed.

    Parameters
    ----------
    what
        frequencies, with their errors; critical_speed, at which the beam buckles; crossings, the
        speeds at which modes meet lines of the excitation; amplitude, of the tip in steady motion;
        peak, its largest deflection in a window of time; strain, the largest along the span in
        steady motion; or power, the mean power of a harvester.
    speed
        Speed at which frequencies and responses are computed, if it is not varied, or up to which
        crossings are searched, with its unit; default: the final speed of the scene's motion, or 0
        without one.
    modes
        Number of modes of frequencies and crossings, from the lowest; default: 3. Responses take as
        many as they need.
    window
        Beginning and end of the window of time of peaks; default: 20:30 s.
    """
    spreading.check(varying)
    if not varying.vary and not spreading.spread:
        raise ValueError(f'give {OPTION} "name=start:stop:count unit", such as "speed=0:100:11 rad/s"')
    varied = (text.partition("=") for text in varying.vary)
    scene = in_unit_of(scene, speed, *(values for key, _, values in varied if key.strip() == "speed"))
    known = inputs_of(scene)
    axes = [parse_axis(known, text, OPTION, MOST_DESIGNS) for text in varying.vary]
    check_designs(designs_of(axes, varying.combine), option=OPTION)
    how = {
        "what": what,
        "modes": modes,
        "discretization": discretization,
        "tolerance": tolerance,
        "window": None if window is None else parse_window(window),
        "speed": _speed_of(scene, what, speed, axes),
        "workers": varying.workers,
        "store": varying.store,
    }
    return _spread(scene, known, spreading, how) if spreading.spread else _study(scene, axes, varying, how)


def _study(scene: bd.Scene, axes: Sequence[Axis], varying: VaryOptions, how: dict[str, Any]) -> Answer:
    """Compute all combinations of the varied inputs, with a progress bar.

    `how` contains the other arguments of `bd.study`, by name.
    """
    inputs = {axis.input.path: axis.values for axis in axes}
    with at_work("designs") as progress:
        result = bd.study(scene, inputs, combine=varying.combine, progress=progress, **how)
    units = {axis.input.path: ShownUnit(axis.unit, 1 / unit_given(axis)[1]) for axis in axes if axis.unit}
    result = replace(result, typed_units=units)
    none = ""
    if not result.answered.any():
        states = ", ".join(np.unique(result.status[np.isin(result.status, NO_ANSWERS)]).tolist())
        none = f"there is no answer {at_any(result.designs.count, 'design')}: {states}"
    return Answer(result, none, tolerance=how["tolerance"])


def _spread(scene: bd.Scene, inputs: list[Input], spreading: SpreadOptions, how: dict[str, Any]) -> Answer:
    """Compute the ranges of the results over tolerances, with a progress bar.

    `inputs` are the inputs that may have a tolerance; `how` contains the other arguments of `bd.spread`.
    """

    def nominal(entry: Input) -> tuple[float, str]:
        return nominal_value(scene, entry.path, how["speed"] or 0.0), unit_of(entry.path) or ""

    with at_work("designs") as progress:
        given = parse_spreads(inputs, spreading.spread, nominal)
        drawn = {"samples": spreading.samples, "seed": spreading.seed, "progress": progress}
        result = bd.spread(scene, {each.name: each.distribution for each in given}, **drawn, **how)
    none = f"none of {result.designs} random designs has an answer"
    return Answer(result, none if (result.scatter.no_answer == 1).all() else "")


# Values as the user gave them ---------------------------------------------------------------------


def _speed_of(scene: bd.Scene, what: str, speed: str | None, axes: Sequence[Axis]) -> float | None:
    """Return the speed in the option [rad/s]; without the option, the final speed of the scene, or None.

    It is None if the result `what` needs no speed, or the speed is one of the varied inputs `axes`.
    """
    varied = any(axis.input.path == SPEED for axis in axes)
    needed = "speed" in KINDS[what].options and not varied
    if speed is not None:
        return parse_speed("--speed", speed, scene)
    return scene.final_speed if needed else None


def inputs_of(scene: bd.Scene) -> list[Input]:
    """Return the inputs that a study may vary, numbers of the scene file and the speed, with descriptions."""

    class ByWholeName(Input):
        """An input that has no key of its own in a scene file; its name is its path without "beam.".

        It is a factor by which a property that varies along the beam is multiplied, or one entry of a list.
        """

        @property
        def name(self) -> str:
            return self.path.removeprefix("beam.")

    def described(path: str) -> Input:
        quantity = Quantity(unit_of(path) or "", "", _FACTOR if path.startswith(SCALE) else path)
        return ByWholeName(path, SceneInput, float, quantity, (), False, None)

    known = {entry.path: entry for entry in numbers(describe(SceneInput))}
    return [known.get(path) or described(path) for path in paths_of(scene)]


def unit_given(axis: Axis) -> tuple[str, float]:
    """Return the unit in which the values of an input were given, and the size of this unit in SI units."""
    place = abs(axis.given).argmax()
    return axis.unit, float(axis.values[place] / axis.given[place])
