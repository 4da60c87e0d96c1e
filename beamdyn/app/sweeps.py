"""Sweeps on the beam's screens: any input against frequencies, critical speed, and the steady response."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np

from beamdyn import critical_point, natural_modes, resonance_speeds, steady_response
from beamdyn.app.inputs import inputs_of, read
from beamdyn.common.app.form_entries import entries_of
from beamdyn.common.app.screens import Sweeps
from beamdyn.common.checks import InvalidValue
from beamdyn.common.edge.config import MissingValue
from beamdyn.common.edge.input_sweep import (
    MOST_ONE_BY_ONE,
    InputSweep,
    Output,
    check_cases,
    chosen,
    numbers,
    one_by_one,
    parse_axis,
)
from beamdyn.scene.scene import Scene

_COARSE, _FINE, _ROUNDS = 121, 41, 3  # speeds at first, speeds about the largest, how often these close in


@dataclass(frozen=True)
class SweepCase:
    """A case of a sweep: a scene, and how far and with how many modes; answers are computed when wanted.

    Parameters
    ----------
    scene : Scene
        The scene.
    top : float
        Top speed [rad/s].
    modes : int
        How many modes.
    """

    scene: Scene
    top: float
    modes: int

    @cached_property
    def crossings(self) -> np.ndarray:
        """Speeds at which the motion excites a mode [rad/s]."""
        if self.scene.motion is None:
            return np.array([])
        return np.array([crossing.speed for crossing in resonance_speeds(self.scene, self.top, self.modes)])

    @property
    def first_resonance(self) -> float:
        """The lowest of them; inf if there is none."""
        return float(self.crossings.min(initial=np.inf))

    def amplitudes(self, speeds: np.ndarray) -> np.ndarray:
        """Steady amplitudes [m]; nan where there is none."""
        if self.scene.motion is None:
            raise MissingValue("motion.kind", None, "choose the motion that excites the beam")
        return steady_response(self.scene, speeds, self.modes).amplitude

    @cached_property
    def peak(self) -> tuple[float, float]:
        """Speed [rad/s] and size [m] of the largest steady amplitude up to the top speed.

        Raises
        ------
        ValueError
            If the beam is not damped: then the amplitude at a resonance has no bound.
        """
        if self.scene.damping_ratio == 0 and len(self.crossings):
            bound = "without damping the amplitude at a resonance has no bound"
            advice = "give a ratio, e.g. 0.01, or sweep the amplitude at the top speed"
            raise InvalidValue("model.damping_ratio", 0.0, bound, advice)
        speeds = np.union1d(np.linspace(self.top / _COARSE, self.top, _COARSE), self.crossings)
        for _ in range(_ROUNDS):
            best = self._largest(speeds)
            low, high = speeds[max(best - 1, 0)], speeds[min(best + 1, len(speeds) - 1)]
            speeds = np.union1d(np.linspace(low, high, _FINE), speeds[best])
        amplitudes = self.amplitudes(speeds)
        best = int(np.nanargmax(amplitudes))
        return float(speeds[best]), float(amplitudes[best])

    def _largest(self, speeds: np.ndarray) -> int:
        amplitudes = self.amplitudes(speeds)
        if np.isnan(amplitudes).all():
            raise ValueError("at no speed up to the top speed is there a steady response")
        return int(np.nanargmax(amplitudes))


def frequency_outputs(modes: int) -> list[Output]:
    """Frequencies at the top speed and at rest, critical speed, first resonance."""
    frequencies = [
        Output(f"frequency_{i + 1}{where}", f"frequency {i + 1}", partial(_frequency, i, share), "Hz")
        for where, share in (("", 1.0), ("_at_rest", 0.0))
        for i in range(modes)
    ]
    return [
        *frequencies,
        Output("critical_speed", "critical speed", lambda case: critical_point(case.scene).speed, "rad/s"),
        Output("first_resonance", "lowest speed of resonance", lambda case: case.first_resonance, "rad/s"),
    ]


def _frequency(mode: int, share: float, case: SweepCase) -> float:
    """A natural frequency at a share of the top speed [Hz]; nan where the mode diverges."""
    return float(natural_modes(case.scene, share * case.top, case.modes).frequency[mode])


def steady_outputs(_: int) -> list[Output]:
    """The steady amplitude at the top speed, and the largest on the way there."""
    return [
        Output(
            "amplitude",
            "amplitude at top speed",
            lambda case: case.amplitudes(np.array([case.top]))[0],
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
        check_cases([axis], MOST_ONE_BY_ONE, "sweep")
        wanted = chosen(outputs(_modes(tables)), names, "results")
        return one_by_one(tables, [axis], wanted, lambda design: SweepCase(*read(design)))

    return Sweeps(partial(_names, outputs), example, results, run)


def _names(outputs: Any, tables: Mapping[str, Any]) -> Sequence[str]:
    return [output.name for output in outputs(_modes(tables))]


def _modes(tables: Mapping[str, Any]) -> int:
    """Number of modes in the form."""
    return read(tables)[2]
