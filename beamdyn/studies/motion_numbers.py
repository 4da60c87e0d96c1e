"""Numbers of a scene's motion, by their names in scene files: "motion.road.wavelength", "motion.duration".

They are found from the descriptions of the motions' classes; the speed is an input of its own.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from functools import cache
from typing import Any, get_type_hints

from beamdyn.common.checks import InvalidValue
from beamdyn.common.described import description, kinds_of
from beamdyn.scene.motion import KINDS, Motion
from beamdyn.scene.scene import Scene

_MOTION = "motion"
_SPEED = "speed"


def unit_of_motion_number(name: str) -> str | None:
    """SI unit of a number of some motion; None if the name is of none."""
    return _units().get(name)


def all_motion_names() -> tuple[str, ...]:
    """Names of the numbers of all kinds of motions."""
    return tuple(_units())


def motion_names(scene: Scene) -> tuple[str, ...]:
    """Names of the numbers that the motion of a scene has."""
    return tuple(name for name in _units() if motion_value(scene, name) is not None)


def motion_value(scene: Scene, name: str) -> float | None:
    """The number of a name in a scene's motion; None if it has no such number."""
    part: Any = scene.motion
    for key in name.split(".")[1:]:
        part = getattr(part, _fields_by_key(type(part)).get(key, ""), None)
    return part if isinstance(part, float) else None


def check_motion(scene: Scene, design: Mapping[str, float]) -> None:
    """Refuse names of numbers that the motion of a scene does not have."""
    for name in design:
        if unit_of_motion_number(name) is not None and motion_value(scene, name) is None:
            known = motion_names(scene)
            remedy = f"give one of {', '.join(known)}" if known else "give the scene a motion that has it"
            raise InvalidValue("vary", name, "the scene's motion has no such number", remedy)


def with_motion(scene: Scene, design: Mapping[str, float]) -> Scene:
    """The scene with numbers of its motion replaced."""
    own = {
        name.split(".", 1)[1]: float(v)
        for name, v in design.items()
        if unit_of_motion_number(name) is not None
    }
    return replace(scene, motion=_replaced(scene.motion, own)) if own else scene


def _replaced(part: Any, given: Mapping[str, float]) -> Any:
    """A motion, or a part of one, with its numbers replaced: those of its parts begin with the part's key."""
    changed: dict[str, Any] = {}
    for key, name in _fields_by_key(type(part)).items():
        inner = {n.partition(".")[2]: v for n, v in given.items() if n.startswith(f"{key}.")}
        if key in given:
            changed[name] = given[key]
        elif inner:
            changed[name] = _replaced(getattr(part, name), inner)
    return replace(part, **changed)


# Names of the classes -----------------------------------------------------------------------------


@cache
def _units() -> dict[str, str]:
    """Units of the numbers of all kinds of motions, by name."""
    return {name: unit for kind in KINDS.values() for name, unit in _numbers(kind, _MOTION)}


def _numbers(made: type, path: str) -> Iterator[tuple[str, str]]:
    """Yield names and units of the numbers of a class and of its parts, but for speeds."""
    for key, name in _fields_by_key(made).items():
        hint = get_type_hints(made, include_extras=True)[name]
        found, parts = description(hint), [*_parts(hint)]
        for part in parts:
            yield from _numbers(part, f"{path}.{key}")
        if not parts and found is not None and float in kinds_of(hint) and key != _SPEED:
            yield f"{path}.{key}", found.unit


def _parts(hint: Any) -> Iterator[type]:
    """Yield the classes that a field may have which have numbers of their own."""
    for kind in kinds_of(hint):
        if isinstance(kind, type) and issubclass(kind, Motion):
            yield from (each for each in KINDS.values() if issubclass(each, kind))
        elif isinstance(kind, type) and is_dataclass(kind):
            yield kind


@cache
def _fields_by_key(made: type) -> dict[str, str]:
    """Names of the fields of a class by their keys in files; none of what is no dataclass."""
    if not is_dataclass(made):
        return {}
    hints = get_type_hints(made, include_extras=True)
    found = {field.name: description(hints[field.name]) for field in fields(made)}
    return {(each and each.key) or name: name for name, each in found.items()}
