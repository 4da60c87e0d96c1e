"""The program ``beamdyn app``: natural frequencies and steady response of one beam over speed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from rich.console import RenderableType

from beamdyn import critical_speed, frequency_locus, resonance_speeds, steady_response
from beamdyn.app.inputs import inputs_of, read
from beamdyn.app.sweeps import frequency_outputs, steady_outputs, sweeps_of
from beamdyn.common.app.screens import Document, Drag, Program, Screen
from beamdyn.common.edge.config import MissingValue
from beamdyn.config import parse_scene
from beamdyn.output.plots import mark_critical
from beamdyn.result_tables import crossings_table, locus_table, steady_table
from beamdyn.spectrum.modes import Locus
from beamdyn.steady.resonance import Crossings
from beamdyn.steady.response import SteadyResponse

_SPEEDS = 121
# Screens ------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Spectrum:
    """Natural frequencies over speed, what excites them, and where the beam buckles."""

    locus: Locus
    crossings: Crossings | None
    critical: float
    refused: str


def solve_spectrum(tables: Mapping[str, Any]) -> Spectrum:
    """The locus, and where the scene's motion excites a mode."""
    scene, top, modes = read(tables)
    found = frequency_locus(scene, np.linspace(0.0, top, _SPEEDS), modes)
    crossings, refused = None, ""
    if scene.motion is not None:
        try:
            crossings = resonance_speeds(scene, top, modes)
        except ValueError as error:
            refused = f"no excitation lines: {error}"
    return Spectrum(found, crossings, critical_speed(scene), refused)


def report_spectrum(found: Spectrum) -> Sequence[RenderableType]:
    """Crossings and frequencies."""
    crossings = [] if found.crossings is None else [crossings_table(found.crossings)]
    return [*crossings, locus_table(found.locus)]


def draw_spectrum(found: Spectrum, _: float = 0.0) -> Figure:
    """Campbell's diagram; without motion the locus alone."""
    figure = Figure(figsize=(9.0, 5.4), layout="constrained")
    ax = figure.subplots()
    (found.locus if found.crossings is None else found.crossings).plot(ax)
    mark_critical(ax, found.critical)
    return figure


def notes_spectrum(found: Spectrum) -> Sequence[str]:
    """Warnings."""
    crossings = () if found.crossings is None else found.crossings.warnings
    return [*([found.refused] if found.refused else []), *found.locus.warnings, *crossings]


def rows_spectrum(found: Spectrum) -> Iterable[Sequence[object]]:
    """Frequencies over speed."""
    yield "speed_rad_per_s", *(f"frequency_Hz_{i}" for i in range(1, found.locus.frequency.shape[1] + 1))
    for speed, row in zip(found.locus.speeds.tolist(), found.locus.frequency.tolist(), strict=True):
        yield speed, *row


def solve_steady(tables: Mapping[str, Any]) -> SteadyResponse:
    """The steady response over speed."""
    scene, top, modes = read(tables)
    if scene.motion is None:
        raise MissingValue("motion.kind", None, "choose the motion that excites the beam")
    return steady_response(scene, np.linspace(top / _SPEEDS, top, 2 * _SPEEDS), modes)


def draw_steady(found: SteadyResponse, _: float = 0.0) -> Figure:
    """The resonance curve."""
    figure = Figure(figsize=(9.0, 5.4), layout="constrained")
    found.plot(figure.subplots())
    return figure


def rows_steady(found: SteadyResponse) -> Iterable[Sequence[object]]:
    """Amplitudes over speed."""
    yield "speed_rad_per_s", "amplitude_m", "bound_m", "status"
    columns = (found.speeds, found.amplitude, found.bound, found.status)
    yield from zip(*(column.tolist() for column in columns), strict=True)


_SECTIONS = ("asked", "mount", "beam", "motion", "model")
_DRAGS = (
    Drag("mount.setting_angle", 0.0, 180.0, 1.0, "deg"),
    Drag("mount.radius", 0.0, 500.0, 5.0, "mm"),
    Drag("beam.thickness", 0.1, 1.0, 0.01, "mm"),
)
LOCUS = Screen(
    "Frequencies",
    "Natural frequencies over the speed of rotation, and the speeds at which the motion excites them.",
    _SECTIONS,
    _SECTIONS,
    solve_spectrum,
    report_spectrum,
    draw_spectrum,
    notes_spectrum,
    rows_spectrum,
    sweeps=sweeps_of(frequency_outputs, "mount.setting_angle=0:180:31 deg", "frequency_1"),
    drags=_DRAGS,
)
STEADY = Screen(
    "Steady response",
    "Largest deflection of the tip over speed, when what the start set in motion has died away.",
    _SECTIONS,
    _SECTIONS,
    solve_steady,
    lambda found: [steady_table(found)],
    draw_steady,
    lambda found: found.warnings,
    rows_steady,
    sweeps=sweeps_of(steady_outputs, "beam.thickness=0.2:0.3:21 mm", "amplitude"),
    drags=_DRAGS,
)
SCENE = Document(
    "scene",
    (files("beamdyn.app") / "scene.toml").read_text(encoding="utf-8"),
    inputs_of,
    parse_scene,
    (LOCUS, STEADY),
    aside={"asked.top_speed": "150 rad/s", "asked.modes": "2"},
)
BEAMDYN = Program("beamdyn", "Rotating beam", (SCENE,))
