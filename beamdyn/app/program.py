"""The program ``beamdyn app``: natural frequencies and steady response of one beam over speed."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import Annotated, Any

import numpy as np
from matplotlib.figure import Figure
from rich.console import RenderableType

from beamdyn import critical_speed, frequency_locus, resonance_speeds, steady_response
from beamdyn.common.app.documents import Document, Drag, Program, Screen
from beamdyn.common.config import validated
from beamdyn.common.inputs import Input, Quantity, Section, describe
from beamdyn.config import (
    RectangularInput,
    RollingInput,
    SampledInput,
    SceneInput,
    SpinUpInput,
    SteadyInput,
    StiffnessInput,
    parse_scene,
    scene_from_dict,
)
from beamdyn.plots import mark_critical
from beamdyn.report import crossings_table, locus_table, steady_table
from beamdyn.resonance import Crossings
from beamdyn.scene import Scene
from beamdyn.spectrum import Locus
from beamdyn.steady import SteadyResponse

_SPEEDS = 121
_MOTIONS: dict[str, type[Section]] = {
    "steady": SteadyInput,
    "spin_up": SpinUpInput,
    "sampled": SampledInput,
    "rolling": RollingInput,
}


class Modes(Quantity):
    """A number of modes: a whole number."""

    def convert(self, given: object) -> float:
        """The number."""
        value = super().convert(given)
        if value != int(value):
            raise ValueError(f"{given}: give a whole number")
        return value


class AskedInput(Section):
    """What is asked of a scene: on the command line these are options."""

    top_speed: Annotated[
        float, Quantity("rad/s", symbol="omega", meaning="top speed", above=0, remedy='e.g. "150 rad/s"')
    ]
    modes: Annotated[float, Modes(symbol="n", meaning="how many modes", least=1, most=8)]


# Inputs -------------------------------------------------------------------------------------------------


def inputs_of(entries: Mapping[str, str]) -> list[Input]:
    """Inputs of the alternatives that entries choose: the beam's kind and the motion's."""
    sections = {_beam(entries), _motion(entries, "motion"), _motion(entries, "motion.rotation")}
    others = {RectangularInput, StiffnessInput, *_MOTIONS.values()} - sections
    found: dict[str, Input] = {}
    for entry in (*describe(AskedInput, "asked."), *describe(SceneInput)):
        if not _hidden(entry, entries, others):
            found.setdefault(entry.path, entry)
    kinds = tuple(_MOTIONS)
    for path, choices in (("motion.kind", kinds), ("motion.rotation.kind", kinds[:3])):
        if path in found:
            found[path] = dataclasses.replace(found[path], choices=choices, required=False, default=None)
    return [*found.values()]


def _hidden(entry: Input, entries: Mapping[str, str], others: set[Any]) -> bool:
    if entry.path == "motion.kind":
        return False
    rolls = _motion(entries, "motion") is RollingInput
    if entry.path.startswith(("motion.rotation.", "motion.road.")) and not rolls:
        return True
    if entry.path == "motion.rotation.kind":
        return False
    of_rotation = entry.path.startswith("motion.rotation.")
    own = _motion(entries, "motion.rotation" if of_rotation else "motion")
    if entry.section in _MOTIONS.values():
        return entry.section is not own
    return entry.section in others


def _beam(entries: Mapping[str, str]) -> type[Section]:
    given = {path.split(".")[1] for path, text in entries.items() if path.startswith("beam.") and text}
    own = set(StiffnessInput.model_fields) - set(RectangularInput.model_fields)
    return StiffnessInput if given & own else RectangularInput


def _motion(entries: Mapping[str, str], table: str) -> type[Section] | None:
    kind = entries.get(f"{table}.kind", "")
    moves = any(text for path, text in entries.items() if path.startswith(f"{table}."))
    return _MOTIONS.get(kind or ("steady" if moves else ""))


# Screens ------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Spectrum:
    """Natural frequencies over speed, what excites them, and where the beam buckles."""

    locus: Locus
    crossings: Crossings | None
    critical: float
    refused: str


def _read(tables: Mapping[str, Any]) -> tuple[Scene, float, int]:
    rest = {name: table for name, table in tables.items() if name != "asked"}
    asked = validated(_Asked, {"asked": tables.get("asked", {})}, "asked").asked
    return scene_from_dict(rest), asked.top_speed, int(asked.modes)


class _Asked(Section):
    asked: AskedInput


def solve_spectrum(tables: Mapping[str, Any]) -> Spectrum:
    """The locus, and where the scene's motion excites a mode."""
    scene, top, modes = _read(tables)
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
    scene, top, modes = _read(tables)
    if scene.motion is None:
        raise ValueError("motion.kind: missing; choose the motion that excites the beam")
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
