"""The screen of natural frequencies over speed, their lines of excitation, and the critical speed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from rich.console import RenderableType

from beamdyn import critical_point, frequency_locus, resonance_speeds
from beamdyn.app.headlines import of_locus
from beamdyn.app.inputs import read
from beamdyn.app.scene_screen import scene_screen, tables_with_choice
from beamdyn.app.speed_charts import CrossingPoint, describe_margin, frequency_chart
from beamdyn.app.sweeps import frequency_outputs, sweeps_of
from beamdyn.common.drawing.chart import Chart
from beamdyn.common.edge.tables import table
from beamdyn.common.plots.axes_and_lines import note_below
from beamdyn.common.plots.campbell import Curves, plot_campbell
from beamdyn.common.plots.plots import mark_critical
from beamdyn.modes.critical import CriticalPoint
from beamdyn.modes.locus import Locus
from beamdyn.modes.model_error.effect_choice import plain_physics
from beamdyn.results.cautions import critical_label, notes_of, warnings_of
from beamdyn.scene.motion import Line
from beamdyn.scene.scene import Scene
from beamdyn.steady.crossings import Crossings, label_crossing
from beamdyn.steady.excitation_phases import distinct_lines, excitation_lines, periodic_system
from beamdyn.studies.campbell.crossings import Margin, margins_at_rated

_SPEEDS, _FEW_SPEEDS = 121, 31  # number of speeds in full, and while something is dragged
_COARSE, _ROUGH = "coarse", 1e-3  # a table that asks for a coarse solution, and its tolerance
_NOT_MARKED = "the resonance speeds are of other physics than the frequencies, and not marked in the drawing"


@dataclass(frozen=True)
class Frequencies:
    """The answer that the screen shows.

    Parameters
    ----------
    locus : Locus
        Frequencies over speed.
    crossings : Crossings, optional
        Speeds at which the motion excites them; None without a motion, or where that is not known.
    critical : CriticalPoint
        Critical speed.
    refused : str
        Why there are no crossings, if the motion has none that are known.
    lines : tuple of Line
        Lines that excite the beam.
    crossing_points : tuple of (float, float, str)
        Speed [rad/s] and frequency [Hz] of each crossing, and what crosses.
    margins : tuple of Margin
        Distances of the modes from the nearest line at the speed at which the motion settles.
    """

    locus: Locus
    crossings: Crossings | None
    critical: CriticalPoint
    refused: str
    lines: tuple[Line, ...] = ()
    crossing_points: tuple[CrossingPoint, ...] = ()
    margins: tuple[Margin, ...] = ()

    @property
    def have_same_physics(self) -> bool:
        """Whether the crossings are those of the frequencies."""
        return self.crossings is None or self.crossings.scene.physics == self.locus.scene.physics


def solve(tables: Mapping[str, Any]) -> Frequencies:
    """The locus, and where the scene's motion excites a mode."""
    scene, top, modes = read({name: table for name, table in tables.items() if name != _COARSE})
    if _COARSE in tables:
        return _solve_coarsely(scene, top, modes)
    locus = frequency_locus(scene, _speeds(scene, top, _SPEEDS), modes)
    critical = critical_point(scene)
    if scene.motion is None:
        return Frequencies(locus, None, critical, "")
    try:
        crossings = resonance_speeds(scene, top, modes)
    except ValueError as error:
        return Frequencies(locus, None, critical, f"no excitation lines: {error}")
    return Frequencies(
        locus,
        crossings,
        critical,
        "",
        crossings.lines,
        tuple(
            (c.speed, c.frequency, label_crossing(c.line, c.kind, c.mode, c.second_mode)) for c in crossings
        ),
        _margins(locus, crossings.lines),
    )


def coarser(tables: Mapping[str, Any]) -> Mapping[str, Any]:
    """Tables of a coarser solution, with fewer speeds and digits, for the drawing."""
    return {**tables, _COARSE: {}}


def _solve_coarsely(scene: Scene, top: float, modes: int) -> Frequencies:
    """The locus at few speeds, and where lines meet it between them."""
    scene = plain_physics(scene)
    locus = frequency_locus(scene, _speeds(scene, top, _FEW_SPEEDS), modes, tolerance=_ROUGH)
    critical = critical_point(scene, tolerance=_ROUGH)
    try:
        lines = _lines_of(locus)
    except ValueError as error:
        return Frequencies(locus, None, critical, str(error))
    return Frequencies(
        locus, None, critical, "", lines, tuple(_crossing_points(locus, lines)), _margins(locus, lines)
    )


def _speeds(scene: Scene, top: float, count: int) -> np.ndarray:
    """Speeds up to the top, that of the motion among them."""
    own = motion_speed(scene)
    return np.union1d(np.linspace(0.0, top, count), [own] if own is not None and own < top else [])


def motion_speed(scene: Scene) -> float | None:
    """Speed at which the motion settles [rad/s]; None where it does not turn, or not steadily."""
    speed = None if scene.motion is None else abs(scene.motion.final_speed)
    return speed if speed is not None and 0 < speed < np.inf else None


def _lines_of(locus: Locus) -> tuple[Line, ...]:
    """Lines of the load by the motion of the locus's scene."""
    motion = locus.scene.motion
    if motion is None:
        return ()
    system = periodic_system(locus.model.equations, motion, locus.speeds[-1:])
    return tuple(distinct_lines(excitation_lines(system, motion, 1)[0]))


def _crossing_points(locus: Locus, lines: Sequence[Line]) -> Iterator[CrossingPoint]:
    """Where lines meet the modes of a locus, taken as straight between its speeds."""
    for line in lines:
        apart = locus.frequency - line.multiple * locus.speeds[:, None] / (2 * np.pi)
        for s, mode in np.argwhere(apart[:-1] * apart[1:] < 0).tolist():
            share = apart[s, mode] / (apart[s, mode] - apart[s + 1, mode])
            speed = float(locus.speeds[s] + share * (locus.speeds[s + 1] - locus.speeds[s]))
            yield speed, line.multiple * speed / (2 * np.pi), f"mode {mode + 1}, {line.name}"


def _margins(locus: Locus, lines: Sequence[Line]) -> tuple[Margin, ...]:
    """Margins at the speed at which the motion settles, if that is on the locus."""
    speed = motion_speed(locus.scene)
    if speed is None or speed > locus.speeds[-1] or not lines:
        return ()
    names = [f"mode {i}" for i in range(1, locus.frequency.shape[1] + 1)]
    return tuple(margins_at_rated("", names, locus, lines, speed))


def chart(answer: Frequencies, _: float = 0.0) -> Sequence[Chart]:
    """Frequencies over speed, with lines, crossings, margins and the critical speed."""
    same = answer.have_same_physics
    return [
        frequency_chart(
            answer.locus,
            answer.lines,
            answer.crossing_points if same else (),
            answer.margins if same else (),
            (answer.critical.speed, critical_label(answer.critical)),
            motion_speed(answer.locus.scene),
        )
    ]


def make_tables(answer: Frequencies) -> Sequence[RenderableType]:
    """Crossings and frequencies, each with the physics that was chosen for it."""
    parts = tables_with_choice(answer.locus)
    if answer.margins:
        parts = [_margins_table(answer), *parts]
    if answer.crossings is not None:
        parts = [*tables_with_choice(answer.crossings), *parts]
    return parts


def _margins_table(answer: Frequencies) -> RenderableType:
    """Distance of the nearest line from each mode at the speed of the motion."""
    at = answer.locus.display_units.speed_unit().say(answer.margins[0].speed)
    rows = [(m.name, f"{m.frequency:.5g}", describe_margin(m)) for m in answer.margins]
    heads = "mode", "frequency [Hz]", "nearest line of excitation"
    return table(f"Margins at the speed of the motion, {at}", heads, rows, (0, 2))


def draw(answer: Frequencies, _: float = 0.0) -> Figure:
    """Campbell's diagram; without motion the locus alone."""
    figure = Figure(figsize=(9.0, 5.4), layout="constrained")
    ax, units = figure.subplots(), answer.locus.display_units
    if answer.crossings is None:
        answer.locus.plot(ax)
    elif answer.have_same_physics:
        answer.crossings.plot(ax)
    else:  # crossings of other frequencies than these
        lines = {line.name: line.multiple for line in answer.crossings.lines}
        names = tuple(f"mode {i}" for i in range(1, answer.locus.frequency.shape[1] + 1))
        curves = Curves(answer.locus.speeds, answer.locus.frequency, names)
        plot_campbell([curves], lines, {}, ax, units.speed_unit().name)
    mark_critical(ax, answer.critical.speed, critical_label(answer.critical), units)
    return note_below(figure, notes_of(answer.locus))


def warnings(answer: Frequencies) -> Sequence[str]:
    """Warnings of all, and why there are no crossings."""
    refused = [answer.refused] if answer.refused else []
    found = [*refused, *warnings_of(answer.locus)]
    if answer.crossings is not None:
        found += [f"resonance speeds: {said}" for said in warnings_of(answer.crossings)]
        found += [] if answer.have_same_physics else [_NOT_MARKED]
    if answer.critical.speed <= answer.locus.speeds[-1]:
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
    headline=lambda answer: [*of_locus(answer.locus, answer.critical)],
    coarser=coarser,
    charts=chart,
)
