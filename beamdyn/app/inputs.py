"""What the beam's screens ask for: a scene, and what is asked of it."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Annotated, Any

from beamdyn.common.edge.config import validated
from beamdyn.common.edge.inputs import Input, Quantity, Section, describe
from beamdyn.common.edge.units import InvalidInput
from beamdyn.config import (
    RectangularInput,
    RollingInput,
    SampledInput,
    SceneInput,
    SpinUpInput,
    SteadyInput,
    StiffnessInput,
    scene_from_dict,
)
from beamdyn.scene.scene import Scene

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
            raise InvalidInput("", given, "give a whole number")
        return value


class AskedInput(Section):
    """What is asked of a scene: on the command line these are options."""

    top_speed: Annotated[
        float, Quantity("rad/s", symbol="omega", meaning="top speed", above=0, remedy='e.g. "150 rad/s"')
    ]
    modes: Annotated[float, Modes(symbol="n", meaning="how many modes", least=1, most=8)]


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


def read(tables: Mapping[str, Any]) -> tuple[Scene, float, int]:
    """The scene, the top speed [rad/s] and the number of modes; raises `ConfigError`."""
    rest = {name: table for name, table in tables.items() if name != "asked"}
    asked = validated(_Asked, {"asked": tables.get("asked", {})}, "asked").asked
    return scene_from_dict(rest), asked.top_speed, int(asked.modes)


class _Asked(Section):
    asked: AskedInput
