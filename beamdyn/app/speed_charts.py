"""The chart of natural frequencies over speed, with lines of excitation, crossings and margins."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from beamdyn.common.drawing.chart import Chart, ChartAxis, ChartBand, ChartCurve, ChartMark, ChartPoints
from beamdyn.common.results.display_units import DisplayUnits
from beamdyn.modes.locus import Locus
from beamdyn.scene.motion import Line
from beamdyn.studies.campbell.crossings import Margin

CrossingPoint = tuple[float, float, str]  # speed [rad/s], frequency [Hz], what crosses
_HEADROOM = 1.08  # height of the chart over the highest frequency
_MOST_ABOVE = 2.0  # highest frequency shown, over that of the fastest line at the top speed


def frequency_chart(
    locus: Locus,
    lines: Sequence[Line],
    crossing_points: Sequence[CrossingPoint],
    margins: Sequence[Margin],
    critical: tuple[float, str],
    motion_speed: float | None,
) -> Chart:
    """Natural frequencies over speed with lines of excitation, where they meet, margins and critical speed.

    Parameters
    ----------
    locus : Locus
        Frequencies.
    lines : sequence of Line
        Lines of excitation.
    crossing_points : sequence of (speed, frequency, words)
        Where lines meet frequencies.
    margins : sequence of Margin
        Distances of modes from the nearest line at the speed of the motion.
    critical : (float, str)
        Critical speed [rad/s], inf if there is none, and what to call it.
    motion_speed : float, optional
        Speed at which the motion settles [rad/s].
    """
    units, last = locus.display_units, float(locus.speeds[-1])
    speed = units.speed_unit()
    top = _top(locus.frequency, [line.multiple * last / (2 * np.pi) for line in lines])
    modes = [
        ChartCurve(_name(i, frequency, top), speed.of(locus.speeds), frequency)
        for i, frequency in enumerate(locus.frequency.T, 1)
    ]
    excited = [_line(line, last, top, units) for line in lines]
    met = [(speed.of(v), f, f"{words}\n{speed.say(v, 5)}, {f:.5g} Hz") for v, f, words in crossing_points]
    points = [ChartPoints("resonance", met)] if met else []
    near = [*_margins(margins, units)]
    points += [ChartPoints("margin at the motion's speed", near, "reaction")] if near else []
    return Chart(
        "Natural frequencies over speed",
        ChartAxis("angular speed", speed.name, low=0.0, high=speed.of(last)),
        ChartAxis("frequency", "Hz", low=0.0, high=_round_up(top)),
        [*modes, *excited],
        points,
        [*_marks(critical, motion_speed, last, units)],
        [ChartBand(speed.of(critical[0]), speed.of(last), "past the critical speed")]
        if critical[0] < last
        else [],
    )


def _name(mode: int, frequency: np.ndarray, top: float) -> str:
    """Name of a mode; with its least frequency if that lies above the chart."""
    least = np.nanmin(frequency, initial=np.inf)
    return f"mode {mode} (above: from {least:.4g} Hz)" if top < least < np.inf else f"mode {mode}"


def _line(line: Line, last: float, top: float, units: DisplayUnits) -> ChartCurve:
    """A line up to where it leaves the chart."""
    end = min(last, 2 * np.pi * top / line.multiple) if line.multiple > 0 else last
    ends = np.array([0.0, end])
    return ChartCurve(line.name, units.speed_unit().of(ends), line.multiple * ends / (2 * np.pi), True, True)


def _top(frequency: np.ndarray, ends: Sequence[float]) -> float:
    """Highest frequency shown: of the modes that are not far above all lines, or of the lowest mode."""
    known = [float(np.nanmax(f)) for f in frequency.T if np.isfinite(f).any()]
    fastest = max(ends, default=0.0)
    near = [f for f in known if not fastest or f <= _MOST_ABOVE * fastest]
    return _HEADROOM * (max(near) if near else min(known, default=fastest)) or 1.0


def _round_up(value: float) -> float:
    """The next larger number of two digits."""
    size = 10.0 ** np.floor(np.log10(value)) / 10
    return float(f"{np.ceil(value / size) * size:.2g}")


def _margins(margins: Sequence[Margin], units: DisplayUnits) -> Iterator[CrossingPoint]:
    speed = units.speed_unit()
    for margin in margins:
        where = f"{speed.say(margin.speed, 5)}, {margin.frequency:.5g} Hz"
        said = f"{margin.name}: {describe_margin(margin)}\n{where}"
        yield speed.of(margin.speed), margin.frequency, said


def describe_margin(margin: Margin) -> str:
    """A margin in words: how far the nearest line is from the natural frequency."""
    if not margin.margin:
        return f"{margin.line.name} meets it"
    where = "above" if margin.margin > 0 else "below"
    return f"{margin.line.name} is {100 * abs(margin.margin):.3g} % {where} it"


def _marks(
    critical: tuple[float, str], motion_speed: float | None, last: float, units: DisplayUnits
) -> Iterator[ChartMark]:
    speed = units.speed_unit()
    at, words = critical
    if 0 <= at <= last:
        yield ChartMark(speed.of(at), f"{words} {speed.say(at, 5)}")
    if motion_speed is not None and 0 < motion_speed <= last:
        yield ChartMark(
            speed.of(motion_speed), f"speed of the motion {speed.say(motion_speed, 5)}", at_foot=True
        )
