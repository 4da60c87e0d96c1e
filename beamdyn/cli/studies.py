"""The command of studies: an answer over all combinations of inputs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Literal

from beamdyn.cli.program import app, deliver
from beamdyn.cli.spreads import answer_spread
from beamdyn.cli.values import (
    Discretization,
    ModeCount,
    PhysicsOption,
    SceneFile,
    Text,
    load_with,
    naming_option,
    parse_window,
    speed_or_final,
)
from beamdyn.common.edge.outputs import NO_FILES, Outputs, on_axes
from beamdyn.common.edge.program import examples
from beamdyn.common.edge.spread_options import NO_SPREAD, SpreadOptions
from beamdyn.common.edge.varying import NOTHING_VARIED, OPTION, VaryOptions
from beamdyn.common.statements import InputValue, Words

if TYPE_CHECKING:
    from beamdyn.common.edge.inputs import Input
    from beamdyn.common.edge.varied_inputs import Axis
    from beamdyn.scene.scene import Scene
    from beamdyn.studies.result import Study

_FACTOR = "factor of a property along the beam"


@app.command(
    help_epilogue=examples(
        'beamdyn study examples/tyre_harvester.toml --vary "beam.thickness=0.1:0.4:7 mm"',
        'beamdyn study examples/tyre_harvester.toml --spread "beam.thickness=+-2%"',
    )
)
def study(
    scene: SceneFile,
    /,
    *,
    varying: VaryOptions = NOTHING_VARIED,
    spreading: SpreadOptions = NO_SPREAD,
    what: Literal["frequencies", "critical_speed", "crossings", "amplitude", "peak"] = "frequencies",
    speed: Text | None = None,
    modes: ModeCount | None = None,
    window: Text | None = None,
    discretization: Discretization = "ritz",
    tolerance: float | None = None,
    physics: PhysicsOption = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Frequencies, critical or resonance speeds, amplitudes or peaks over all combinations of inputs.

    Or their ranges over tolerances, and the input that matters most. At most a million designs are answered.

    Parameters
    ----------
    scene
        The scene.
    varying
        Inputs that are varied. Names are those of the file; "speed"; or factors of properties as they are
        along the beam, such as "beam.scale.bending_stiffness=0.9:1.1:5".
    spreading
        Inputs that have a tolerance, in place of those that are varied.
    what
        frequencies, with their errors; critical_speed, at which the beam buckles; crossings, the speeds at
        which modes meet lines of the excitation; amplitude, of the tip in steady motion; or peak, its largest
        deflection in a window of time.
    speed
        Speed of frequencies, amplitudes and peaks with its unit, where it is not varied; top speed of
        crossings. Default: the final speed of the scene's motion, or 0 without one.
    modes
        Number of modes of frequencies and crossings, from the lowest; default: 3. Amplitudes and peaks take
        as many as they need.
    window
        Beginning and end of the window of time of peaks; default: 20:30 s.
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
    from beamdyn import study
    from beamdyn.cautions import warnings_of
    from beamdyn.common.designs import MOST_DESIGNS, check_designs
    from beamdyn.common.edge.html_report import Question
    from beamdyn.common.edge.progress import at_work
    from beamdyn.common.edge.varied_inputs import designs_of, parse_axis
    from beamdyn.common.edge.wording import of_file
    from beamdyn.tables.studies import study_csv, study_table

    outputs.check(scene)
    spreading.check(varying)
    if not varying.vary and not spreading.spread:
        raise ValueError(f'give {OPTION} "name=start:stop:count unit", such as "speed=0:100:11 rad/s"')
    loaded = load_with(scene, physics, speed, *_speeds_of(varying))
    known = _inputs(loaded)
    axes = [parse_axis(known, text, OPTION, MOST_DESIGNS) for text in varying.vary]
    check_designs(designs_of(axes, varying.combine), option=OPTION)
    options: dict[str, Any] = {"modes": modes, "discretization": discretization, "tolerance": tolerance}
    asked = varying.options | spreading.options | {"what": what, "speed": speed, "window": window} | options
    question = Question.on_file("beamdyn study", scene, **asked, physics=physics)
    options["window"] = None if window is None else parse_window(window)
    options["speed"] = _speed_of(loaded, what, speed, axes)
    as_given = _refused_as_given(axes, speed=speed, window=window)
    if spreading.spread:
        how = options | {"what": what, "workers": varying.workers, "store": varying.store}
        with as_given:
            answer_spread(loaded, known, spreading, outputs, question, how)
        return
    with at_work("designs") as progress, of_file({}), as_given:
        result = study(
            loaded,
            {axis.input.path: axis.values for axis in axes},
            what,
            **options,
            combine=varying.combine,
            workers=varying.workers,
            store=varying.store,
            progress=progress,
        )
    units = {axis.input.path: _unit_of(axis) for axis in axes if axis.unit}
    tables, rows = [study_table(result, units)], study_csv(result)
    warnings = warnings_of(result, tolerance, word=partial(_as_given, axes))
    refusal = _refusal(result)
    deliver(result, outputs, question, tables, rows, on_axes(result.plot), warnings, refusal)


# Values as they were given ------------------------------------------------------------------------


def _speed_of(scene: Scene, what: str, speed: str | None, axes: Sequence[Axis]) -> float | None:
    """The speed of the option [rad/s], or that of the scene where one is needed; else None."""
    from beamdyn.scene.numbers import SPEED
    from beamdyn.studies.questions import KINDS

    varied = any(axis.input.path == SPEED for axis in axes)
    needed = "speed" in KINDS[what].options and not varied
    return speed_or_final(scene, speed) if needed or speed is not None else None


def _speeds_of(varying: VaryOptions) -> Iterator[str]:
    """Yield the speeds that are varied, of which the unit is that of the answer."""
    for text in varying.vary:
        key, _, values = text.partition("=")
        if key.strip() == "speed":
            yield values


def _as_given(axes: Sequence[Axis], part: Words) -> str | None:
    """An input of a design as it was given: rounded, it would not be found again; None of other parts."""
    for axis in axes:
        if axis.unit and isinstance(part, InputValue) and part.name == axis.input.path:
            return f"{part.name} = {axis.given[abs(axis.values - part.value).argmin()]:.6g} {axis.unit}"
    return None


@contextmanager
def _refused_as_given(axes: Sequence[Axis], **options: str | None) -> Iterator[None]:
    """Within it, a refusal of an option shows its text, one of an input its value and bound as given."""
    from beamdyn.common.checks import InvalidValue

    try:
        with ExitStack() as named:
            for name, text in options.items():
                if text is not None:
                    named.enter_context(naming_option(name, f"--{name}", text))
            yield
    except InvalidValue as error:
        axis = next((axis for axis in axes if axis.input.path == error.field and axis.unit), None)
        if axis is None or not isinstance(error.value, float):
            raise
        unit, si = _unit_of(axis)
        limit = None if error.limit is None else error.limit / si
        raise replace(error, value=error.value / si, limit=limit, unit=unit, cases=None) from None


def _refusal(result: Study) -> str:
    """Why no design has an answer; empty if one has."""
    import numpy as np

    from beamdyn.studies.answers import NO_ANSWERS

    if result.answered.any():
        return ""
    states = ", ".join(np.unique(result.status[np.isin(result.status, NO_ANSWERS)]).tolist())
    return f"at none of {result.designs.count} designs is there an answer: {states}"


def _inputs(scene: Scene) -> list[Input]:
    """The numbers of a scene that a study varies, as files describe them, and the speed."""
    from beamdyn.common.edge.inputs import Input, Quantity, describe
    from beamdyn.common.edge.varied_inputs import numbers
    from beamdyn.config.scene_inputs import SceneInput
    from beamdyn.scene.numbers import SCALE, paths_of, unit_of

    class ByWholeName(Input):
        """An input that the last part of its name alone does not mean: a factor, or one in a list."""

        @property
        def name(self) -> str:
            return self.path.removeprefix("beam.")

    def described(path: str) -> Input:
        quantity = Quantity(unit_of(path) or "", "", _FACTOR if path.startswith(SCALE) else path)
        return ByWholeName(path, SceneInput, float, quantity, (), False, None)

    known = {entry.path: entry for entry in numbers(describe(SceneInput))}
    return [known.get(path) or described(path) for path in paths_of(scene)]


def _unit_of(axis: Axis) -> tuple[str, float]:
    """The unit in which the values of an input were given, and that unit in SI."""
    place = abs(axis.given).argmax()
    return axis.unit, float(axis.values[place] / axis.given[place])
