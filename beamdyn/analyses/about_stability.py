"""Stability of periodic motion: Floquet multipliers of a scene, and stability charts over two inputs."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from cyclopts import Parameter

import beamdyn as bd
from beamdyn.analyses.about_designs import inputs_of, unit_given
from beamdyn.analyses.analysis import Answer, analysis
from beamdyn.analyses.options import Discretization, ModeCount
from beamdyn.analyses.results.of_stability import chart_table
from beamdyn.analyses.values import in_unit_of
from beamdyn.common.edge.command_options import OPTION, Folder
from beamdyn.common.edge.command_options import Workers as _Workers
from beamdyn.common.edge.varied_inputs import parse_axis
from beamdyn.common.results.columns import evenly_spread
from beamdyn.scene.numbers import SPEED, number_at

_FREQUENCY = "motion.frequency"
_AMPLITUDES = "motion.fluctuation", "motion.along_n1", "motion.along_n2", "motion.along_n3"
# Initial options of the screens: frequencies and amplitudes around a region of instability.
_TONGUE = "--vary", "motion.frequency=118:130:61 Hz", "--vary", "motion.fluctuation=0:0.2:41"
_FEW = 7  # number of values of each input in a preliminary chart
_VALUES = 41  # number of pulsation amplitudes in a chart, if the user gives no values

Varied = Annotated[
    tuple[str, ...],
    Parameter(
        help='An input and its values, NAME=start:stop:count unit, such as "motion.frequency=100:150:51 Hz"; '
        "give the option twice. Names are those of the file, or speed. Default: the pulsation frequency, "
        "from 80 to 120 % of its value, and the amplitude, from 0 to twice its value.",
        negative="",
        consume_multiple=False,
        show_default=False,
    ),
]
Workers = Annotated[_Workers, Parameter(help="Number of processes; the result is the same for any number.")]
Store = Annotated[Folder, Parameter(help="Folder for finished results; the same command resumes from them.")]


@analysis(
    "beamdyn floquet examples/pulsating_wheel.toml", about_scene="The scene, in a motion that repeats itself."
)
def floquet(
    scene: bd.Scene, *, modes: ModeCount = 3, discretization: Discretization = "ritz"
) -> bd.FloquetMultipliers:
    """Stability of a periodic motion: Floquet multipliers of free vibration over one period."""
    return bd.floquet_multipliers(scene, modes, discretization)


def _chart_sooner(
    scene: bd.Scene, *, vary: tuple[str, ...], discretization: Discretization, **_: Any
) -> Answer:
    """Compute a stability chart with one mode and few values, as a preliminary result."""
    scene, inputs, units = _varied(scene, vary)
    few = {path: values[evenly_spread(len(values), _FEW)] for path, values in inputs.items()}
    result = bd.stability_chart(scene, few, 1, discretization)
    return Answer(result, tables=[chart_table(result, units)])


@analysis(
    "beamdyn stability-chart examples/pulsating_wheel.toml",
    screen="Stability chart",
    sooner=_chart_sooner,
    opens_with=_TONGUE,
    about_scene="The scene, in a motion that repeats itself.",
)
def stability_chart(
    scene: bd.Scene,
    *,
    vary: Varied = (),
    modes: ModeCount = 3,
    discretization: Discretization = "ritz",
    workers: Workers = 1,
    store: Store = None,
) -> Answer:
    """Stability chart of a periodic motion: where free vibration grows, over two inputs of the scene."""
    scene, inputs, units = _varied(scene, vary)
    result = bd.stability_chart(scene, inputs, modes, discretization, workers, store)
    return Answer(result, tables=[chart_table(result, units)])


@analysis(
    "beamdyn stability-limits examples/pulsating_wheel.toml --modes 1",
    screen="Stability limits",
    sooner=_chart_sooner,
    opens_with=(*_TONGUE, "--modes", "1"),
    about_scene="The scene, in a motion that repeats itself.",
)
def stability_limits(
    scene: bd.Scene,
    *,
    vary: Varied = (),
    modes: ModeCount = 3,
    discretization: Discretization = "ritz",
    workers: Workers = 1,
    store: Store = None,
) -> bd.StabilityLimits:
    """Stability limits of a periodic motion, followed as curves over two inputs of the scene."""
    scene, inputs, _ = _varied(scene, vary)
    return bd.stability_limits(scene, inputs, modes, discretization, workers, store)


def _varied(
    scene: bd.Scene, vary: tuple[str, ...]
) -> tuple[bd.Scene, dict[str, np.ndarray], dict[str, tuple[str, float]]]:
    """Read the two varied inputs of a stability chart.

    Return the scene, set to display results in the unit of the speed if this is varied; the values of each
    input, by its path [SI units]; and the unit in which each was given, with its size in SI units.
    """
    if not vary:
        return scene, _about(scene), {}
    if len(vary) != 2:
        raise ValueError(f'{OPTION}: a chart is over two inputs; give two, such as "speed=50:60:21 rad/s"')
    varied = (text.partition("=") for text in vary)
    scene = in_unit_of(scene, *(values for key, _, values in varied if key.strip() == SPEED))
    axes = [parse_axis(inputs_of(scene), text, OPTION) for text in vary]
    inputs = {axis.input.path: axis.values for axis in axes}
    if len(inputs) < 2:
        raise ValueError(f"{OPTION}: {axes[0].input.path} is given twice; give two inputs")
    return scene, inputs, {axis.input.path: unit_given(axis) for axis in axes if axis.unit}


def _about(scene: bd.Scene) -> dict[str, np.ndarray]:
    """Choose values around the pulsation frequency and amplitude of the scene."""
    numbers = {path: number_at(scene, path) for path in (_FREQUENCY, *_AMPLITUDES)}
    there = [path for path in _AMPLITUDES if numbers[path]]
    frequency = numbers[_FREQUENCY]
    if not frequency or not there:
        raise ValueError(f'give {OPTION} twice, such as "speed=50:60:21 rad/s": the motion does not pulsate')
    largest = 2 * (numbers[there[0]] or 0.0)
    amplitudes = np.linspace(min(largest, 0.0), max(largest, 0.0), _VALUES)
    return {_FREQUENCY: frequency * np.linspace(0.8, 1.2, 2 * _VALUES - 1), there[0]: amplitudes}
