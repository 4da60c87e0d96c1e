"""The screen of natural frequencies over speed, with excitation lines and the critical speed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from rich.console import RenderableType

from beamdyn import critical_point, frequency_locus, resonance_speeds
from beamdyn.analyses.results.cautions import critical_label, notes_of, warnings_of
from beamdyn.app.scene_form import COARSE, coarser, read
from beamdyn.app.scene_screen import brief, scene_screen, tables_with_choice
from beamdyn.app.sweeps import frequency_outputs, sweeps_of
from beamdyn.common.drawing.shapes import Chart, ChartAxis, ChartBand, ChartCurve, ChartMark, ChartPoints
from beamdyn.common.edge.console import table
from beamdyn.common.plots.axes_and_lines import note_below
from beamdyn.common.plots.campbell import Curves, plot_campbell, top_of
from beamdyn.common.plots.plots import mark_critical
from beamdyn.common.results.one_line import known_digits, number
from beamdyn.common.results.pictures import new_figure
from beamdyn.common.screens.screen_parts import KeyResult
from beamdyn.modes.critical import CriticalPoint
from beamdyn.modes.locus import Locus
from beamdyn.scene.motion.base import Line
from beamdyn.scene.scene import Scene
from beamdyn.steady.crossings import Crossings, label_crossing
from beamdyn.steady.periodic_system import distinct_lines, excitation_lines, periodic_system
from beamdyn.studies.campbell.line_crossings import Margin, margins_at_rated

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CrossingPoint = tuple[float, float, str]  # speed [rad/s], frequency [Hz], mode and line that cross
_SPEEDS, _FEW_SPEEDS = 121, 31  # number of speeds, in a full and in a preliminary result
_ROUGH = 1e-3  # tolerance of a preliminary result
_NOT_MARKED = "resonance speeds are not marked: they and the frequencies were computed with different effects"


@dataclass(frozen=True)
class Frequencies:
    """Result of the frequency screen.

    Parameters
    ----------
    locus : Locus
        Natural frequencies over speed.
    crossings : Crossings, optional
        Speeds at which the motion excites the modes; None without a motion, or if they are unknown.
    critical : CriticalPoint or None
        Critical speed of buckling; None under a load at the tip that may cause flutter instead.
    refused : str
        The reason why there are no crossings, if the excitation lines of the motion are unknown.
    lines : tuple of Line
        Excitation lines: the multiples of the speed with which the motion excites the beam.
    crossing_points : tuple of (float, float, str)
        Speed [rad/s] and frequency [Hz] of each crossing, with the names of mode and line.
    margins : tuple of Margin
        Distances of the modes from the nearest excitation line at the final speed of the motion.
    """

    locus: Locus
    crossings: Crossings | None
    critical: CriticalPoint | None
    refused: str
    lines: tuple[Line, ...] = ()
    crossing_points: tuple[CrossingPoint, ...] = ()
    margins: tuple[Margin, ...] = ()

    @property
    def critical_speed(self) -> float:
        """Return the critical speed [rad/s]; inf if there is none, or it is unknown."""
        return np.inf if self.critical is None else self.critical.speed

    @property
    def have_same_physics(self) -> bool:
        """Return whether crossings and frequencies were computed with the same physical effects."""
        return self.crossings is None or self.crossings.scene.physics == self.locus.scene.physics


def solve(tables: Mapping[str, Any]) -> Frequencies:
    """Compute frequencies over speed, critical speed, and speeds at which the motion excites a mode.

    If the tables contain `COARSE`, the result is preliminary: it has few speeds, between which the crossings
    are interpolated.
    """
    scene, top, modes = read(tables)
    coarse = COARSE in tables
    count = _FEW_SPEEDS if coarse else _SPEEDS
    accuracy: dict[str, Any] = {"tolerance": _ROUGH} if coarse else {}
    own = motion_speed(scene)
    speeds = np.union1d(np.linspace(0.0, top, count), [own] if own is not None and own < top else [])
    locus = frequency_locus(scene, speeds, modes, **accuracy)
    critical = None if scene.may_flutter_by_load else critical_point(scene, **accuracy)
    motion, crossings = scene.motion, None
    if motion is None:
        return Frequencies(locus, None, critical, "")
    try:
        if coarse:
            system = periodic_system(locus.model.equations, motion, locus.speeds[-1:])
            lines = tuple(distinct_lines(excitation_lines(system, motion, 1)[0]))
            points = tuple(_crossing_points(locus, lines))
        else:
            crossings = resonance_speeds(scene, top, modes)
            lines = crossings.lines
            names = (label_crossing(c.line, c.kind, c.mode, c.second_mode) for c in crossings)
            points = tuple((c.speed, c.frequency, name) for c, name in zip(crossings, names, strict=True))
    except ValueError as error:
        return Frequencies(locus, None, critical, f"no excitation lines: {error}")
    return Frequencies(locus, crossings, critical, "", lines, points, _margins(locus, lines))


def motion_speed(scene: Scene) -> float | None:
    """Return the final speed of the motion [rad/s]; None if the speed does not settle, or is 0."""
    speed = None if scene.motion is None else abs(scene.motion.final_speed)
    return speed if speed is not None and 0 < speed < np.inf else None


def _crossing_points(locus: Locus, lines: Sequence[Line]) -> Iterator[CrossingPoint]:
    """Yield the crossings of excitation lines and modes, by linear interpolation between speeds."""
    names = locus.names()
    for line in lines:
        apart = locus.frequency - line.multiple * locus.speeds[:, None] / (2 * np.pi)
        for s, mode in np.argwhere(apart[:-1] * apart[1:] < 0).tolist():
            share = apart[s, mode] / (apart[s, mode] - apart[s + 1, mode])
            speed = float(locus.speeds[s] + share * (locus.speeds[s + 1] - locus.speeds[s]))
            yield speed, line.multiple * speed / (2 * np.pi), f"{names[mode]}, {line.name}"


def _margins(locus: Locus, lines: Sequence[Line]) -> tuple[Margin, ...]:
    """Return the distances of the modes from the nearest excitation lines at the final speed.

    The result is empty if the computed speeds do not reach the final speed, or no lines are known.
    """
    speed = motion_speed(locus.scene)
    if speed is None or speed > locus.speeds[-1] or not lines:
        return ()
    return tuple(margins_at_rated("", locus.names(), locus, lines, speed))


def chart(answer: Frequencies, _: float = 0.0) -> Sequence[Chart]:
    """Make the chart of frequencies over speed: excitation lines, crossings, margins and critical speed."""
    locus, lines, same = answer.locus, answer.lines, answer.have_same_physics
    speed, last = locus.display_units.speed_unit(), float(locus.speeds[-1])
    top = top_of(locus.frequency.T, max((line.multiple for line in lines), default=0.0) * last / (2 * np.pi))
    curves = []
    for name, frequency in zip(locus.names(), locus.frequency.T, strict=True):
        least = np.nanmin(frequency, initial=np.inf)
        above = f" (above: from {least:.4g} Hz)" if top < least < np.inf else ""
        curves.append(ChartCurve(f"{name}{above}", speed.of(locus.speeds), frequency))
    for line in lines:  # each line is drawn up to the edge of the chart
        end = min(last, 2 * np.pi * top / line.multiple) if line.multiple > 0 else last
        ends = np.array([0.0, end])
        curves.append(ChartCurve(line.name, speed.of(ends), line.multiple * ends / (2 * np.pi), True, True))

    def placed(at: float, frequency: float, words: str) -> CrossingPoint:
        return speed.of(at), frequency, f"{words}\n{speed.say(at, 5)}, {known_digits(frequency):.5g} Hz"

    met = [placed(*point) for point in answer.crossing_points]
    near = [placed(m.speed, m.frequency, f"{m.name}: {describe_margin(m)}") for m in answer.margins]
    each = [ChartPoints("resonance", met), ChartPoints("margin at the motion's speed", near, "reaction")]
    critical, motion = answer.critical_speed, motion_speed(locus.scene)
    marks = []
    if answer.critical is not None and 0 <= critical <= last:
        words = f"{critical_label(answer.critical)} {speed.say(critical, 5)}"
        marks.append(ChartMark(speed.of(critical), words))
    if motion is not None and motion <= last:
        words = f"speed of the motion {speed.say(motion, 5)}"
        marks.append(ChartMark(speed.of(motion), words, at_foot=True))
    past = [ChartBand(speed.of(critical), speed.of(last), "past the critical speed")]
    size = 10.0 ** np.floor(np.log10(top)) / 10  # the axis ends at a number with two significant digits
    return [
        Chart(
            "Natural frequencies over speed",
            ChartAxis("angular speed", speed.name, low=0.0, high=speed.of(last)),
            ChartAxis("frequency", "Hz", low=0.0, high=float(f"{np.ceil(top / size) * size:.2g}")),
            curves,
            [points for points in each if same and points.at],
            marks,
            past if critical < last else [],
        )
    ]


def describe_margin(margin: Margin) -> str:
    """Describe a margin: the distance between the natural frequency and the nearest excitation line."""
    if not margin.margin:
        return f"{margin.line.name} meets its frequency"
    where = "above" if margin.margin > 0 else "below"
    return f"{margin.line.name} is {100 * abs(margin.margin):.3g} % {where} its frequency"


def headline(answer: Frequencies) -> Iterator[KeyResult]:
    """Yield the first frequency at several speeds, the critical speed, and the top speed's margin from it."""
    first, top, critical = answer.locus.frequency[:, 0], float(answer.locus.speeds[-1]), answer.critical
    unit = answer.locus.display_units.speed_unit()
    for words, frequency in (("first frequency at rest", first[0]), (f"at {brief(top, unit)}", first[-1])):
        yield KeyResult(words, number(frequency, "Hz") if np.isfinite(frequency) else "diverges")
    for margin in answer.margins[:1]:
        yield KeyResult(f"at the motion's speed, {brief(margin.speed, unit)}", number(margin.frequency, "Hz"))
    if critical is None:
        return
    if np.isfinite(critical.speed):
        yield KeyResult("critical speed", brief(critical.speed, unit))
        if answer.margins:
            return
        margin = f"{100 * (1 - top / critical.speed):.3g} %" if top < critical.speed else "none: past it"
        yield KeyResult("margin of the top speed", margin)
    else:
        bound = critical.none_below
        below = f" below {brief(bound, unit)}" if np.isfinite(bound) else ""
        yield KeyResult("critical speed", f"none{below}")


def make_tables(answer: Frequencies) -> Sequence[RenderableType]:
    """Make tables of crossings and frequencies, each with a note on the chosen physical effects."""
    parts = [] if answer.crossings is None else tables_with_choice(answer.crossings)
    if answer.margins:
        at = answer.locus.display_units.speed_unit().say(answer.margins[0].speed)
        rows = [(m.name, f"{m.frequency:.5g}", describe_margin(m)) for m in answer.margins]
        heads = "mode", "frequency [Hz]", "nearest line of excitation"
        parts.append(table(f"Margins at the speed of the motion, {at}", heads, rows, (0, 2)))
    return [*parts, *tables_with_choice(answer.locus)]


def draw(answer: Frequencies, _: float = 0.0) -> Figure:
    """Draw the Campbell diagram; without a motion, only the natural frequencies over speed."""
    figure = new_figure(9.0, 5.4)
    ax, units = figure.subplots(), answer.locus.display_units
    if answer.crossings is None:
        answer.locus.plot(ax)
    elif answer.have_same_physics:
        answer.crossings.plot(ax)
    else:  # crossings and frequencies were computed with different physical effects
        lines = {line.name: line.multiple for line in answer.crossings.lines}
        curves = Curves(answer.locus.speeds, answer.locus.frequency, answer.locus.names())
        plot_campbell([curves], lines, {}, ax, units.speed_unit().name)
    if answer.critical is not None:
        mark_critical(ax, answer.critical.speed, critical_label(answer.critical), units)
    return note_below(figure, notes_of(answer.locus))


def warnings(answer: Frequencies) -> Sequence[str]:
    """Return the warnings of all parts of the result, and the reason if there are no crossings."""
    refused = [answer.refused] if answer.refused else []
    found = [*refused, *warnings_of(answer.locus)]
    if answer.crossings is not None:
        found += [f"resonance speeds: {said}" for said in warnings_of(answer.crossings)]
        found += [] if answer.have_same_physics else [_NOT_MARKED]
    if answer.critical is not None and answer.critical.speed <= answer.locus.speeds[-1]:
        found += [f"critical speed: {said}" for said in warnings_of(answer.critical)]
    return found


FREQUENCIES = scene_screen(
    "Frequencies",
    "Natural frequencies over the speed of rotation, and the speeds at which the motion excites them.",
    solve,
    result=lambda answer: answer.locus,
    tables=make_tables,
    draw=draw,
    notes=warnings,
    sweeps=sweeps_of(frequency_outputs, "mount.setting_angle=0:180:31 deg", "frequency_1"),
    headline=headline,
    coarser=coarser,
    charts=chart,
)
