"""The screen of natural frequencies over speed, what excites them, and where the beam buckles."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from rich.console import RenderableType

from beamdyn import critical_point, frequency_locus, resonance_speeds
from beamdyn.app.inputs import DRAGS, TABLES, read
from beamdyn.app.sweeps import frequency_outputs, sweeps_of
from beamdyn.cautions import critical_label, describe_choice, notes_of, warnings_of
from beamdyn.common.app.screens import Screen
from beamdyn.output.campbell import Curves, plot_campbell
from beamdyn.output.notes import note_below
from beamdyn.output.plots import mark_critical
from beamdyn.spectrum.critical import CriticalPoint
from beamdyn.spectrum.locus import Locus
from beamdyn.steady.resonance import Crossings
from beamdyn.tables.results import crossings_table, locus_table
from beamdyn.tables.rows import locus_csv

_SPEEDS = 121
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
    """

    locus: Locus
    crossings: Crossings | None
    critical: CriticalPoint
    refused: str

    @property
    def have_same_physics(self) -> bool:
        """Whether the crossings are those of the frequencies."""
        return self.crossings is None or self.crossings.scene.physics == self.locus.scene.physics


def solve(tables: Mapping[str, Any]) -> Frequencies:
    """The locus, and where the scene's motion excites a mode."""
    scene, top, modes = read(tables)
    locus = frequency_locus(scene, np.linspace(0.0, top, _SPEEDS), modes)
    crossings, refused = None, ""
    if scene.motion is not None:
        try:
            crossings = resonance_speeds(scene, top, modes)
        except ValueError as error:
            refused = f"no excitation lines: {error}"
    return Frequencies(locus, crossings, critical_point(scene), refused)


def make_tables(answer: Frequencies) -> Sequence[RenderableType]:
    """Crossings and frequencies, each with the physics that was chosen for it."""
    parts: list[RenderableType] = [locus_table(answer.locus), *describe_choice(answer.locus)]
    if answer.crossings is not None:
        parts = [crossings_table(answer.crossings), *describe_choice(answer.crossings), *parts]
    return parts


def draw(answer: Frequencies, _: float = 0.0) -> Figure:
    """Campbell's diagram; without motion the locus alone."""
    figure = Figure(figsize=(9.0, 5.4), layout="constrained")
    ax = figure.subplots()
    if answer.crossings is None:
        answer.locus.plot(ax)
    elif answer.have_same_physics:
        answer.crossings.plot(ax)
    else:  # crossings of other frequencies than these
        lines = {line.name: line.multiple for line in answer.crossings.lines}
        names = tuple(f"mode {i}" for i in range(1, answer.locus.frequency.shape[1] + 1))
        curves = Curves(answer.locus.speeds, answer.locus.frequency, names)
        plot_campbell([curves], lines, {}, ax)
    mark_critical(ax, answer.critical.speed, critical_label(answer.critical))
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


def rows(answer: Frequencies) -> Iterable[Sequence[object]]:
    """Rows of the CSV file."""
    return locus_csv(answer.locus)


FREQUENCIES = Screen(
    "Frequencies",
    "Natural frequencies over the speed of rotation, and the speeds at which the motion excites them.",
    TABLES,
    TABLES,
    solve,
    make_tables,
    draw,
    warnings,
    rows,
    sweeps=sweeps_of(frequency_outputs, "mount.setting_angle=0:180:31 deg", "frequency_1"),
    drags=DRAGS,
)
