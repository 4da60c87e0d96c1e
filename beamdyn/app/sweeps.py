"""Parameter sweeps of the beam's screens: frequencies, critical speed and steady response over any input."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial
from typing import Any, TypeVar

import numpy as np
from matplotlib.figure import Figure

from beamdyn import critical_point, natural_modes, resonance_speeds, steady_response
from beamdyn.analyses.results.cautions import warnings_of
from beamdyn.app.scene_form import inputs_of, read
from beamdyn.common.edge.config import MissingValue
from beamdyn.common.edge.input_sweep import (
    MOST_ONE_BY_ONE,
    InputSweep,
    Output,
    chosen,
    one_by_one,
    solve_cases,
)
from beamdyn.common.edge.varied_inputs import designs_of, numbers, parse_axis
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.inputs.described import check_designs
from beamdyn.common.plots.axes_and_lines import note_below
from beamdyn.common.plots.curves import sweep_figure
from beamdyn.common.screens.form_entries import entries_of
from beamdyn.common.screens.screens import Sweeps
from beamdyn.modes.model_error.left_out_effects import LARGE_MODEL_ERROR
from beamdyn.scene.scene import Scene
from beamdyn.steady.response import SteadyResponse

Kept = TypeVar("Kept")
# Initial number of speeds, number of speeds near the largest amplitude, and number of refinements there.
_COARSE, _FINE, _ROUNDS = 121, 41, 3


class SweepCase:
    """A scene of a sweep, with top speed and number of modes; results are computed when needed.

    Parameters
    ----------
    scene : Scene
        The scene.
    top : float
        Top speed [rad/s].
    modes : int
        Number of modes.
    """

    def __init__(self, scene: Scene, top: float, modes: int) -> None:
        self.scene, self.top, self.modes = scene, top, modes
        self.answers: dict[tuple[Any, ...], Any] = {}  # computed results, by function and arguments

    def ask(self, function: Callable[..., Kept], *given: Any) -> Kept:
        """Return a function's result for the scene, which is computed only once."""
        asked = function, *given
        if asked not in self.answers:
            self.answers[asked] = function(self.scene, *given)
        return self.answers[asked]

    def crossings(self) -> np.ndarray:
        """Return the speeds at which the motion excites a mode [rad/s]."""
        if self.scene.motion is None:
            return np.array([])
        return np.array([found.speed for found in self.ask(resonance_speeds, self.top, self.modes)])

    def amplitude(self, speed: float) -> float:
        """Compute the steady-state amplitude at a speed [m]; nan if there is none."""
        return float(self.ask(_steady_response, (speed,), self.modes).amplitude[0])

    @cached_property
    def peak(self) -> tuple[float, float]:
        """Return speed [rad/s] and value [m] of the largest steady-state amplitude up to the top speed.

        Raises
        ------
        ValueError
            If the beam is undamped: the amplitude at a resonance is then unbounded.
        """
        crossings, best = self.crossings(), 0
        if not self.scene.is_damped and len(crossings):
            bound = "without damping the amplitude at a resonance has no bound"
            advice = "give a damping ratio, e.g. 0.01, or sweep the amplitude at the top speed"
            raise InvalidValue("model.damping_ratio", 0.0, bound, advice)
        speeds = np.union1d(np.linspace(self.top / _COARSE, self.top, _COARSE), crossings)
        for finer in range(_ROUNDS + 1):
            if finer:
                low, high = speeds[max(best - 1, 0)], speeds[min(best + 1, len(speeds) - 1)]
                speeds = np.union1d(np.linspace(low, high, _FINE), speeds[best])
            amplitudes = _steady_response(self.scene, speeds, self.modes).amplitude
            if np.isnan(amplitudes).all():
                raise ValueError("there is no steady response at any speed up to the top speed")
            best = int(np.nanargmax(amplitudes))
        return float(speeds[best]), self.amplitude(float(speeds[best]))

    @cached_property
    def model_error(self) -> float:
        """Return the largest model error of the computed results; nan if unknown."""
        errors = [float(np.max(answer.model_error, initial=0.0)) for answer in self.answers.values()]
        return float(np.max(errors, initial=0.0))


def _steady_response(scene: Scene, speeds: Sequence[float] | np.ndarray, modes: int) -> SteadyResponse:
    if scene.motion is None:
        raise MissingValue("motion.kind", None, "choose the motion that excites the beam")
    return steady_response(scene, speeds, modes)


def frequency_outputs(modes: int) -> list[Output]:
    """List the results on frequencies: at top speed and at rest, critical speed, lowest resonance speed."""
    frequencies = [
        Output(f"frequency_{i + 1}{at}", f"frequency {i + 1}", partial(_frequency, i, share), "Hz")
        for at, share in (("", 1.0), ("_at_rest", 0.0))
        for i in range(modes)
    ]
    first = "lowest speed of resonance"
    return [
        *frequencies,
        Output("critical_speed", "critical speed", lambda case: case.ask(critical_point).speed, "rad/s"),
        Output("first_resonance", first, lambda case: case.crossings().min(initial=np.inf), "rad/s"),
    ]


def _frequency(mode: int, share: float, case: SweepCase) -> float:
    """Compute a natural frequency [Hz] at the fraction `share` of the top speed; nan if the mode diverges."""
    return float(case.ask(natural_modes, share * case.top, case.modes).frequency[mode])


def steady_outputs(_: int) -> list[Output]:
    """List the results on steady motion: amplitude at the top speed, and largest amplitude up to it."""
    return [
        Output("amplitude", "amplitude at top speed", lambda case: case.amplitude(case.top), "mm", 1e-3),
        Output("largest_amplitude", "largest amplitude", lambda case: case.peak[1], "mm", 1e-3),
        Output("speed_of_largest", "its speed", lambda case: case.peak[0], "rad/s"),
    ]


_MODEL_ERROR = Output("model_error", "largest model error", lambda case: case.model_error, "%", 0.01)


def sweeps_of(outputs: Callable[[int], list[Output]], example: str, results: str) -> Sweeps:
    """Make the sweeps that a screen offers.

    ``outputs(modes)`` lists the results for the number of modes in the form; `example` is the initial text
    for the varied input, `results` that for the names of the results.
    """

    def names(tables: Mapping[str, Any]) -> Sequence[str]:
        return [output.name for output in outputs(read(tables)[2])]

    def run(tables: Mapping[str, Any], text: str, names: str) -> InputSweep:
        axis = parse_axis(numbers(inputs_of(entries_of(tables, ()))), text, "sweep")
        check_designs(designs_of([axis]), MOST_ONE_BY_ONE, "sweep")
        wanted = [*chosen(outputs(read(tables)[2]), names, "results"), _MODEL_ERROR]
        cases: list[SweepCase] = []

        def case_of(design: Mapping[str, Any]) -> SweepCase:
            cases.append(SweepCase(*read(design)))
            return cases[-1]

        swept = one_by_one(tables, [axis], wanted, lambda task: solve_cases(task, wanted, case_of))
        return replace(swept, warnings=(*swept.warnings, *_warn_of_model(cases), *_say_choices(cases)))

    def draw(swept: InputSweep) -> Figure:
        # The picture contains the warnings, as it may be used without the page.
        return note_below(sweep_figure(swept), swept.warnings)

    return Sweeps(names, example, results, run, draw)


def _warn_of_model(cases: Sequence[SweepCase]) -> Iterator[str]:
    """Yield up to two sentences on the model errors of the cases, each with the warnings of one case.

    One is on the model errors above 1 %, with the warnings of the case that has the largest; the other is on
    unknown model errors, with the warnings of the first case that has one.
    """
    large = [case for case in cases if case.model_error > LARGE_MODEL_ERROR]
    unknown = [case for case in cases if np.isnan(case.model_error)]
    for some, what in (
        (large, "the model error exceeds 1 %; where it is largest"),
        (unknown, "the model error is not known; at the first of these"),
    ):
        if some:
            first = max(some, key=lambda case: case.model_error) if some is large else some[0]
            said = dict.fromkeys(said for answer in first.answers.values() for said in warnings_of(answer))
            warned = "; ".join(said) or "for instance, a mode does not vibrate"
            yield f"at {len(some)} of {len(cases)} values {what}: {warned}."


def _say_choices(cases: Sequence[SweepCase]) -> Iterator[str]:
    """Yield a sentence on each automatically added effect: at how many values of the input it was added."""
    choices = [
        [a.physics_choice for a in case.answers.values() if a.physics_choice is not None] for case in cases
    ]
    if not any(choices):
        return
    added = Counter(
        name for chosen in choices for name in {e.name for c in chosen for e in c.effects if e.included}
    )
    each = [f"{name} at {count} of {len(cases)} values" for name, count in added.items()]
    yield f'physics "auto" added {", ".join(each) or "nothing"}'
