"""The screen of a transient simulation: tip deflection over time, beside an animation of the beam."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from rich.console import RenderableType

from beamdyn import resonance_speeds, simulate
from beamdyn.analyses.results.cautions import describe_choice
from beamdyn.analyses.results.of_motion import time_of_peak, transient_table
from beamdyn.app.drawings import bent_beam, drawn_larger
from beamdyn.app.scene_form import COARSE, coarser, first_frequency, read_aside, read_scene
from beamdyn.app.scene_screen import brief, left_out_table, scene_screen
from beamdyn.common.drawing.layout import Rows
from beamdyn.common.drawing.shapes import Chart, ChartAxis, ChartBand, ChartCurve, ChartMark, ChartPoints
from beamdyn.common.edge.config import MissingValue
from beamdyn.common.edge.inputs import of_file
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.results.one_line import number
from beamdyn.common.screens.screen_parts import KeyResult, Slider
from beamdyn.equations.effects import modelled_directions
from beamdyn.scene.scene import Scene
from beamdyn.steady.crossings import label_crossing
from beamdyn.transient.transient import Transient

_TOLERANCE, _ROUGH = 1e-4, 1e-2  # tolerance of a full result, and of a preliminary one with few modes
_MOST_PERIODS = 20_000  # longest simulated time, in periods of the first mode at rest
_PLACES, _TIMES = 41, 201  # number of positions along the beam, and of times in the close-up
_SAMPLES = 40  # number of the largest samples near which the peak is searched
_CLOSE = 4  # length of the close-up before and after the present time, in periods of the first mode
_MOST_SENT = 2000  # number of points of a curve on the page, enough to zoom in
_MODES = 3  # number of modes whose resonances are marked; number of modes of a preliminary result


@dataclass(frozen=True)
class Playable:
    """A transient simulation to be animated, with its peak and the resonances that it passes.

    Parameters
    ----------
    run : Transient
        Result of the simulation.
    window : (float, float)
        Time window in which the peak was searched [s].
    peak, peak_at : float
        Largest magnitude of the tip deflection in the window [m], and its time [s].
    passages : tuple of (float, str)
        Times at which the speed passes a resonance speed [s], with the names of mode and excitation line.
    period : float
        Period of the first mode at rest [s].
    """

    run: Transient
    window: tuple[float, float]
    peak: float
    peak_at: float
    passages: tuple[tuple[float, str], ...]
    period: float

    def time(self, place: float) -> float:
        """Return the time [s] at a position of the slider, which is between 0 and 1."""
        return self.run.path.start + place * (self.run.path.end - self.run.path.start)

    @cached_property
    def chart(self) -> Chart:
        """Return the chart of the tip deflection over the whole simulation."""
        run, (start, end), unit = self.run, self.window, self.run.display_units.length_unit()
        tips = zip(_names(run), (run.tip, run.tip_across), strict=False)
        peak = unit.of(float(run.deflection([self.peak_at])[0]))
        said = f"peak {unit.say(self.peak, 5)} at {self.peak_at:.5g} s"
        first, last = run.path.start, run.path.end
        outside = ChartBand(first, start, "before the window"), ChartBand(end, last, "after the window")
        return Chart(
            "Tip deflection over time",
            *_axes(run, first, last),
            [ChartCurve(name, run.t, unit.of(tip), most=_MOST_SENT) for name, tip in tips],
            [ChartPoints("peak in the window", [(self.peak_at, peak, said)], "friction")],
            [ChartMark(t, words) for t, words in self.passages],
            [band for band in outside if band.high > band.low],
        )


def solve(tables: Mapping[str, Any]) -> Playable:
    """Simulate the motion from rest; find the peak and the resonances that are passed."""
    given, scene = read_aside(tables, "run"), read_scene(tables)
    if scene.motion is None:
        raise MissingValue("motion.kind", None, "choose the motion that excites the beam")
    first = first_frequency(scene)
    period = 2 * np.pi / first if first else np.inf
    start, end = given.window_start, given.end if given.window_end is None else given.window_end
    periods = f"it must be at most {{limit}}, {_MOST_PERIODS} periods of the first mode"
    for option, value, holds, bound, limit in (
        ("end", given.end, given.end <= _MOST_PERIODS * period, periods, _MOST_PERIODS * period),
        ("window_end", end, end <= given.end, "it is after the end of the run, {limit}", given.end),
        ("window_start", start, start < end, "it must be before the end of the window, {limit}", end),
    ):
        if not holds:
            raise InvalidValue(f"run.{option}", value, bound, unit="s", limit=limit)
    accuracy: dict[str, Any] = {"tolerance": _TOLERANCE}
    if COARSE in tables:
        accuracy = {"modes": _MODES, "tolerance": _ROUGH}
    with of_file({"t_end": "run.end"}):
        run = simulate(scene, given.end, **accuracy)
    at, passages = _time_of_peak(run, start, end), tuple(_passages(scene, given.end))
    return Playable(run, (start, end), run.peak(start, end), at, passages, period)


def _time_of_peak(run: Transient, start: float, end: float) -> float:
    """Find the time [s] of the largest deflection in a window, near one of its largest samples."""
    _, apart = time_of_peak(run, start, end)
    inside = np.flatnonzero((run.t >= start) & (run.t <= end))
    largest = inside[np.argsort(np.hypot(run.tip, run.tip_across)[inside])[-_SAMPLES:]]
    beside = run.t[largest][:, None] + apart * np.linspace(-1, 1, _TIMES)
    t = np.unique(np.clip(np.append(beside, (start + end) / 2), start, end))
    return float(t[np.hypot(run.deflection(t, 0), run.deflection(t, 1)).argmax()])


def _passages(scene: Scene, end: float) -> Iterator[tuple[float, str]]:
    """Yield the times at which the speed passes a resonance, with the names of mode and excitation line."""
    assert scene.motion is not None
    t = np.linspace(0.0, min(end, scene.motion.end), 4001)
    speed = np.abs(scene.motion.at(t).speed)
    try:
        found = resonance_speeds(scene, float(speed.max()), _MODES)
    except ValueError:  # the scene is at rest, or its excitation lines are unknown
        return
    for c in found:
        over = speed - c.speed
        for i in np.flatnonzero(over[:-1] * over[1:] < 0).tolist():
            words = label_crossing(c.line, c.kind, c.mode, c.second_mode)
            yield float(t[i] + over[i] / (over[i] - over[i + 1]) * (t[i + 1] - t[i])), words


# The moving beam ----------------------------------------------------------------------------------


def drawings(answer: Playable, place: float = 1.0) -> Rows:
    """Draw the beam in each direction at the time of the slider's position `place`, from 0 to 1.

    Its extremes within a period before and after are drawn in grey.
    """
    run, now = answer.run, answer.time(place)
    unit, words = run.display_units.length_unit(), modelled_directions(run.scene)
    x = np.linspace(0.0, run.scene.beam.length, _PLACES)
    larger = drawn_larger(run.largest, run.scene.beam.length)
    scale = f"deflection drawn {larger:g} times larger" if larger != 1 else "to scale"
    row = []
    for direction in range(run.scene.physics.planes):
        around = run.shape(x, _around(answer, now, 1.0), direction)
        extremes = [larger * around[i] for i in (around[:, -1].argmin(), around[:, -1].argmax())]
        shape = run.shape(x, [now], direction)[0]
        which = f", {words[direction]}" if len(words) > 1 else ""
        title, tip = f"At {now:.4g} s{which}; {scale}", unit.say(float(shape[-1]), 3)
        row.append(bent_beam(x, larger * shape, title, tip, extremes, larger * run.largest, scale))
    return [row]


def _around(answer: Playable, now: float, periods: float) -> np.ndarray:
    """Return times [s] from `periods` periods before `now` to as many after it, within the simulated time."""
    path, reach = answer.run.path, periods * answer.period
    return np.linspace(max(now - reach, path.start), min(now + reach, path.end), _TIMES)


# Charts -------------------------------------------------------------------------------------------


def charts(answer: Playable, place: float = 1.0) -> Sequence[Chart]:
    """Make charts of the tip deflection over the whole simulation and around the present time.

    The present time is that of the slider's position `place`, from 0 to 1.
    """
    run, now, unit = answer.run, answer.time(place), answer.run.display_units.length_unit()
    t = _around(answer, now, _CLOSE)
    near = [ChartCurve(name, t, unit.of(run.deflection(t, i))) for i, name in enumerate(_names(run))]
    axes = _axes(run, float(t[0]), float(t[-1]))
    return [
        replace(answer.chart, cursor=now),
        Chart("Close-up about the present time", *axes, near, cursor=now),
    ]


def _names(run: Transient) -> Sequence[str]:
    """Return the names of the curves: the directions of deflection."""
    return modelled_directions(run.scene) if run.scene.physics.planes > 1 else ("tip deflection",)


def _axes(run: Transient, start: float, end: float) -> tuple[ChartAxis, ChartAxis]:
    """Make the axes of a chart between two times [s]."""
    unit = run.display_units.length_unit()
    return ChartAxis("time", "s", low=start, high=end), ChartAxis("tip deflection", unit.name)


# Tables and files ---------------------------------------------------------------------------------


def tables(answer: Playable) -> Sequence[RenderableType]:
    """Make tables of the peaks, the resonances passed, and the neglected effects."""
    said = [f"At {t:.5g} s the speed passes a resonance: {words}." for t, words in answer.passages]
    effects = left_out_table(answer.run.left_out_effects, "largest deflection")
    return [transient_table(answer.run, answer.window), *said, *describe_choice(answer.run), effects]


def headline(answer: Playable) -> Iterator[KeyResult]:
    """Yield the peak deflection, and the time at which the speed first passes a resonance."""
    unit = answer.run.display_units.length_unit()
    yield KeyResult("largest deflection of the tip", brief(answer.peak, unit))
    yield KeyResult("at the time", number(answer.peak_at, "s"))
    for at, _ in answer.passages[:1]:
        yield KeyResult("passes a resonance at", number(at, "s"))


TRANSIENT = scene_screen(
    "Transient",
    "Motion of the beam from rest, and the deflection of its tip over time.",
    solve,
    ("run",),
    result=lambda answer: answer.run,
    tables=tables,
    slider=Slider("time", ("start", "end"), 0.001, 20.0, onward=True),
    drawings=drawings,
    charts=charts,
    headline=headline,
    coarser=coarser,
)
