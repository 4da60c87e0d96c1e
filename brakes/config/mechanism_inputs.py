"""Descriptions of the inputs of calipers and mechanisms for forms and sweeps; named designs as TOML."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from beamdyn.common.described import descriptions
from beamdyn.common.edge.inputs import Input, Quantity, describe
from beamdyn.common.edge.units import show
from brakes.calipers import NAMED
from brakes.config.caliper import CaliperInput, PointQuantity, named
from brakes.config.mechanism import SECTIONS, CompleteMechanismInput
from brakes.planar import JOINTS, LOADS, Part
from brakes.planar.points import Point as Coordinates


def _keys(part: type[Part]) -> str:
    """The kind of part, and its required and optional keys, as help text."""
    fields, keys = SECTIONS[part.key()].model_fields, {True: [], False: []}
    for key, described in descriptions(part).items():
        otherwise = described.meaning.partition("; ")[2]  # such as "the ground if not given"
        keys[fields[key].is_required()].append(f"{key} ({otherwise})" if otherwise else key)
    return f"{part.label}: {'; '.join(', '.join(some) for some in (keys[True], keys[False]) if some)}"


PARTS = {part.key(): _keys(part) for part in (*JOINTS, *LOADS)}
_TABLES = ("points", *PARTS)


def caliper_inputs(name: str) -> list[Input]:
    """Inputs of the caliper of a name; those without dimensions where there is no such name."""
    return describe(type(named(name)) if name in NAMED else CaliperInput)


def mechanism_inputs(points: Iterable[str]) -> list[Input]:
    """Inputs of a mechanism: one for each of its points, one for each list of parts."""
    rest = {
        entry.path: entry for entry in describe(CompleteMechanismInput) if _table(entry.path) not in _TABLES
    }
    place = PointQuantity("m", meaning="point in the drawing")
    return [
        rest.pop("title"),
        rest.pop("bodies"),
        *(_input(f"points.{name}", Coordinates, place, required=True) for name in points),
        *(_input(part, list[dict], Quantity(meaning=words)) for part, words in PARTS.items()),
        *rest.values(),
    ]


def _table(path: str) -> str:
    return path.partition(".")[0]


def _input(path: str, kind: Any, description: Quantity, required: bool = False) -> Input:
    return Input(path, CompleteMechanismInput, kind, description, (), required, None if required else [])


def inputs_of_tables(tables: Mapping[str, Any]) -> list[Input]:
    """Inputs of the caliper or mechanism that the tables of a file describe."""
    name, points = tables.get("caliper"), tables.get("points")
    if isinstance(name, str):
        return caliper_inputs(name)
    return mechanism_inputs(points if isinstance(points, dict) else ())


def idle_inputs(entries: Mapping[str, str]) -> list[str]:
    """Paths of inputs of a caliper alone, where the entries of a form, by path, are of a plain mechanism."""
    if any(text.strip() for path, text in entries.items() if _table(path) == "caliper"):
        return []
    stops = [path for path in entries if _table(path) == "stop"]
    stops = [] if any(entries[path].strip() for path in stops) else stops
    return ["run.finger", "run.wear", *stops]


def named_text(name: str) -> str:
    """TOML text of a named caliper with all its dimensions."""
    given = named(name)
    inputs = [entry for entry in caliper_inputs(name) if entry.path.startswith("dimensions.")]
    lines = [f"{entry.name} = {_shown(entry)}" for entry in inputs]
    return "\n".join([f"caliper = {show(given.caliper)}", "", "[dimensions]", *lines]) + "\n"


def _shown(entry: Input) -> str:
    """A dimension as a file gives it, lengths in mm."""
    value: Any = entry.default
    if isinstance(value, tuple):
        return f"[{', '.join(_length(part) for part in value)}]"
    return _length(value) if entry.quantity.unit == "m" else show(value)


def _length(metres: float) -> str:
    return f'"{1e3 * metres:.12g} mm"'
