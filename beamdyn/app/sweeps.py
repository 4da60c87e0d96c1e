"""Sweeps on the beam's screens: any input against frequencies, critical speed, and the steady response."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any, TypeVar

import numpy as np
from matplotlib.figure import Figure

from beamdyn import critical_point, natural_modes, resonance_speeds, steady_response
from beamdyn.app.inputs import inputs_of, read
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
from beamdyn.common.inputs.designs import check_designs
from beamdyn.common.plots.axes_and_lines import note_below
from beamdyn.common.plots.curves import sweep_figure
from beamdyn.common.screens.form_entries import entries_of
from beamdyn.common.screens.screens import Sweeps
from beamdyn.modes.critical import CriticalPoint
from beamdyn.modes.model_error.left_out_effects import LARGE_MODEL_ERROR
from beamdyn.modes.modes import Modes
from beamdyn.results.cautions import warnings_of
from beamdyn.scene.scene import Scene

Kept = TypeVar("Kept")
_COARSE, _FINE, _ROUNDS = 121, 41, 3  # speeds at first, about the largest amplitude, and refinements of these


@dataclass(frozen=True)
class SweepCase:
    """A case of a sweep: a scene with top speed and number of modes; answers are computed when wanted.

    Parameters
    ----------
    scene : Scene
        The scene.
    top : float
        Top speed [rad/s].
    modes : int
        Number of modes.
    """

    scene: Scene
    top: float
    modes: int
    answers: list[Any] = field(default_factory=list, compare=False)

    def _keep(self, answer: Kept) -> Kept:
        self.answers.append(answer)
        return answer

    @cached_property
    def at_rest(self) -> Modes:
        """The modes at rest."""
        return self._keep(natural_modes(self.scene, 0.0, self.modes))

    @cached_property
    def at_top(self) -> Modes:
        """The modes at the top speed."""
        return self._keep(natural_modes(self.scene, self.top, self.modes))

    @cached_property
    def critical(self) -> CriticalPoint:
        """The critical speed."""
        return self._keep(critical_point(self.scene))

    @cached_property
    def crossings(self) -> np.ndarray:
        """Speeds at which the motion excites a mode [rad/s]."""
        if self.scene.motion is None:
            return np.array([])
        found = self._keep(resonance_speeds(self.scene, self.top, self.modes))
        return np.array([crossing.speed for crossing in found])

    @property
    def first_resonance(self) -> float:
        """The lowest resonance speed [rad/s]; inf if there is none."""
        return float(self.crossings.min(initial=np.inf))

    def amplitudes(self, speeds: np.ndarray) -> np.ndarray:
        """Steady amplitudes [m]; nan where there is none."""
        if self.scene.motion is None:
            raise _no_motion()
        return steady_response(self.scene, speeds, self.modes).amplitude

    @cached_property
    def amplitude(self) -> float:
        """Steady amplitude at the top speed [m]."""
        return self._amplitude_at(self.top)

    def _amplitude_at(self, speed: float) -> float:
        if self.scene.motion is None:
            raise _no_motion()
        found = self._keep(steady_response(self.scene, np.array([speed]), self.modes))
        return float(found.amplitude[0])

    @cached_property
    def peak(self) -> tuple[float, float]:
        """Speed [rad/s] and size [m] of the largest steady amplitude up to the top speed.

        Raises
        ------
        ValueError
            If the beam is not damped: then the amplitude at a resonance has no bound.
        """
        if not self.scene.is_damped and len(self.crossings):
            bound = "without damping the amplitude at a resonance has no bound"
            advice = "give a ratio, e.g. 0.01, or sweep the amplitude at the top speed"
            raise InvalidValue("model.damping_ratio", 0.0, bound, advice)
        speeds = np.union1d(np.linspace(self.top / _COARSE, self.top, _COARSE), self.crossings)
        for _ in range(_ROUNDS):
            best = self._largest(speeds)
            low, high = speeds[max(best - 1, 0)], speeds[min(best + 1, len(speeds) - 1)]
            speeds = np.union1d(np.linspace(low, high, _FINE), speeds[best])
        best = self._largest(speeds)
        return float(speeds[best]), self._amplitude_at(float(speeds[best]))

    def _largest(self, speeds: np.ndarray) -> int:
        amplitudes = self.amplitudes(speeds)
        if np.isnan(amplitudes).all():
            raise ValueError("at no speed up to the top speed is there a steady response")
        return int(np.nanargmax(amplitudes))

    @cached_property
    def model_error(self) -> float:
        """Largest model error of the answers that were asked for; nan where it is not known."""
        errors = [float(np.max(answer.model_error, initial=0.0)) for answer in self.answers]
        return float(np.max(errors, initial=0.0))


def _no_motion() -> MissingValue:
    return MissingValue("motion.kind", None, "choose the motion that excites the beam")


def frequency_outputs(modes: int) -> list[Output]:
    """Frequencies at the top speed and at rest, critical speed, first resonance."""
    frequencies = [
        Output(f"frequency_{i + 1}{where}", f"frequency {i + 1}", partial(_frequency, i, share), "Hz")
        for where, share in (("", 1.0), ("_at_rest", 0.0))
        for i in range(modes)
    ]
    return [
        *frequencies,
        Output("critical_speed", "critical speed", lambda case: case.critical.speed, "rad/s"),
        Output("first_resonance", "lowest speed of resonance", lambda case: case.first_resonance, "rad/s"),
    ]


def _frequency(mode: int, share: float, case: SweepCase) -> float:
    """A natural frequency at a share of the top speed [Hz]; nan where the mode diverges."""
    return float((case.at_top if share else case.at_rest).frequency[mode])


def steady_outputs(_: int) -> list[Output]:
    """The steady amplitude at the top speed, and the largest one up to there."""
    return [
        Output(
            "amplitude",
            "amplitude at top speed",
            lambda case: case.amplitude,
            "mm",
            1e-3,
        ),
        Output("largest_amplitude", "largest amplitude", lambda case: case.peak[1], "mm", 1e-3),
        Output("speed_of_largest", "its speed", lambda case: case.peak[0], "rad/s"),
    ]


def sweeps_of(outputs: Any, example: str, results: str) -> Sweeps:
    """The sweeps of a screen whose outputs follow from the number of modes."""

    def run(tables: Mapping[str, Any], text: str, names: str) -> InputSweep:
        axis = parse_axis(numbers(inputs_of(entries_of(tables, ()))), text, "sweep")
        check_designs(designs_of([axis]), MOST_ONE_BY_ONE, "sweep")
        wanted = [*chosen(outputs(_modes(tables)), names, "results"), _MODEL_ERROR]
        cases: list[SweepCase] = []

        def case_of(design: Mapping[str, Any]) -> SweepCase:
            cases.append(SweepCase(*read(design)))
            return cases[-1]

        swept = one_by_one(tables, [axis], wanted, lambda task: solve_cases(task, wanted, case_of))
        return replace(swept, warnings=(*swept.warnings, *_warn_of_model(cases), *_say_choices(cases)))

    return Sweeps(partial(_names, outputs), example, results, run, _draw)


def _draw(swept: InputSweep) -> Figure:
    """The sweep with its warnings below it, as a picture may be used without the page."""
    return note_below(sweep_figure(swept), swept.warnings)


_MODEL_ERROR = Output("model_error", "largest model error", lambda case: case.model_error, "%", 0.01)


def _warn_of_model(cases: Sequence[SweepCase]) -> Iterator[str]:
    """Yield the warnings of the case with the largest model error, and of the first where it is not known."""
    errors = [case.model_error for case in cases]
    large = [case for case, error in zip(cases, errors, strict=True) if error > LARGE_MODEL_ERROR]
    unknown = [case for case, error in zip(cases, errors, strict=True) if np.isnan(error)]
    if large:
        where = f"at {len(large)} of {len(cases)} values the model error exceeds 1 %; where it is largest: "
        yield from _warnings_of_case(max(large, key=lambda case: case.model_error), where)
    if unknown:
        where = f"at {len(unknown)} of {len(cases)} values the model error is not known; at the first: "
        yield from _warnings_of_case(unknown[0], where)


def _say_choices(cases: Sequence[SweepCase]) -> Iterator[str]:
    """Yield at how many values which effects were added, where the physics was chosen."""
    choices = [[a.physics_choice for a in case.answers if a.physics_choice is not None] for case in cases]
    if not any(choices):
        return
    added = Counter(
        name for chosen in choices for name in {e.name for c in chosen for e in c.effects if e.included}
    )
    each = [f"{name} at {count} of {len(cases)} values" for name, count in added.items()]
    yield f'physics "auto" added {", ".join(each) or "nothing"}'


def _warnings_of_case(case: SweepCase, where: str) -> Iterator[str]:
    said = "; ".join(dict.fromkeys(said for answer in case.answers for said in warnings_of(answer)))
    yield f"{where}{said or 'of a mode that does not vibrate, for instance'}."


def _names(outputs: Any, tables: Mapping[str, Any]) -> Sequence[str]:
    return [output.name for output in outputs(_modes(tables))]


def _modes(tables: Mapping[str, Any]) -> int:
    """Number of modes in the form."""
    return read(tables)[2]
