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
from beamdyn.common.app.screens import Screen
from beamdyn.output.plots import mark_critical
from beamdyn.result_tables import crossings_table, locus_csv, locus_table, where_worst
from beamdyn.spectrum.modes import Locus
from beamdyn.steady.resonance import Crossings

_SPEEDS = 121


@dataclass(frozen=True)
class Frequencies:
    """The answer that the screen shows.

    Parameters
    ----------
    locus : Locus
        Frequencies over speed.
    crossings : Crossings, optional
        Speeds at which the motion excites them; None without a motion, or where that is not known.
    critical : float
        Critical speed [rad/s].
    refused : str
        Why there are no crossings, if the motion has none that are known.
    """

    locus: Locus
    crossings: Crossings | None
    critical: float
    refused: str


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
    return Frequencies(locus, crossings, critical_point(scene).speed, refused)


def make_tables(answer: Frequencies) -> Sequence[RenderableType]:
    """Crossings and frequencies."""
    crossings = [] if answer.crossings is None else [crossings_table(answer.crossings)]
    return [*crossings, locus_table(answer.locus)]


def draw(answer: Frequencies, _: float = 0.0) -> Figure:
    """Campbell's diagram; without motion the locus alone."""
    figure = Figure(figsize=(9.0, 5.4), layout="constrained")
    ax = figure.subplots()
    (answer.locus if answer.crossings is None else answer.crossings).plot(ax)
    mark_critical(ax, answer.critical)
    return figure


def warnings(answer: Frequencies) -> Sequence[str]:
    """Warnings of both, and why there are no crossings."""
    crossings = () if answer.crossings is None else answer.crossings.warnings
    left_out = answer.locus.left_out_effects.warnings(where=where_worst(answer.locus))
    refused = [answer.refused] if answer.refused else []
    return [*refused, *answer.locus.warnings, *left_out, *crossings]


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
