"""Numbers of a scene by their paths in scene files, such as "mount.radius" or "beam.point_mass[0].mass".

Studies, spreads, sensitivities, commands and screens get, set, list and describe numbers by this module.
"""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import fields, is_dataclass, replace
from functools import cache
from typing import Any, get_type_hints

from beamdyn.common.inputs.checks import InvalidValue, positive
from beamdyn.common.inputs.described import description, kinds_of, part_at, with_parts
from beamdyn.scene.beam import ANGLE_UNITS, OF_ANY_SIGN, OFFSETS, PROPERTY_UNITS, Beam, TipMass
from beamdyn.scene.harvester import Harvester
from beamdyn.scene.motion.base import Motion
from beamdyn.scene.motion.kinds import KINDS
from beamdyn.scene.mount import Damping, Mount
from beamdyn.scene.points import PointMass, PointSpring
from beamdyn.scene.profile import Profile, as_profile, to_profile
from beamdyn.scene.rectangle import SECTION_UNITS, SIDES
from beamdyn.scene.scene import Scene

SPEED = "speed"  # key of the speed at which the scene is analysed; it is not part of the scene
# Prefix of factors that multiply a property of the beam, which may vary along the beam.
SCALE = "beam.scale."
_HARVESTER = "harvester."  # prefix of the numbers of piezoelectric layers
# Prefixes of numbers that belong to the beam with layers; other numbers belong to the beam without layers.
_ON_ANY_BEAM = "beam.tip.", "beam.point_mass[", "beam.point_spring["
_POINTS = {"point_mass": PointMass, "point_spring": PointSpring}
# `_SIDE_POWERS` has the exponents of the sides of a section, of any shape, in its properties: 1 for both in
# `_LINEAR`, 3 for the thickness in `_OF_FIRST` (torsional stiffness: of thin sections), 3 for the width in
# `_OF_SECOND`.
_LINEAR = ("mass_per_length", "axial_stiffness", "shear_stiffness", "second_shear_stiffness")
_OF_FIRST = ("bending_stiffness", "rotary_inertia", "torsion_stiffness")
_OF_SECOND = ("second_bending_stiffness", "second_rotary_inertia")
_SIDE_POWERS = {
    "thickness": {"outer_fibre": 1, "warping_stiffness": 3}
    | dict.fromkeys((*_LINEAR, *_OF_SECOND), 1)
    | dict.fromkeys(_OF_FIRST, 3),
    "width": {"warping_stiffness": 3}
    | dict.fromkeys((*_LINEAR, *_OF_FIRST, *OFFSETS), 1)
    | dict.fromkeys(_OF_SECOND, 3),
}


# List of all numbers ------------------------------------------------------------------------------


@cache
def units() -> dict[str, str]:
    """Return the SI units of all numbers of scenes, by path, with "[]" for the index of a list member."""
    of_beam = {"length": "m"} | SECTION_UNITS | PROPERTY_UNITS | ANGLE_UNITS
    found = {f"beam.{name}": unit for name, unit in of_beam.items()}
    found |= {SCALE + name: "" for name in (*SIDES, *PROPERTY_UNITS)} | dict(_numbers(TipMass, "beam.tip"))
    # Reversed, so that the position of a point mass or spring is listed after its other numbers.
    for name, kind in _POINTS.items():
        found |= dict(reversed([*_numbers(kind, f"beam.{name}[]")]))
    found |= dict(_numbers(Mount, "mount"))
    found |= {"model.damping_ratio": "", "model.gravity": "m/s2", "damping.ratios[]": ""}
    found |= {"tip_load.force[]": "N", "tip_load.moment[]": "N m"}
    found |= dict(_numbers(Damping, "damping"))
    found |= dict(_numbers(Harvester, "harvester"))
    found |= {path: unit for kind in KINDS.values() for path, unit in _numbers(kind, "motion")}
    return found | {SPEED: "rad/s"}


def unit_of(path: str) -> str | None:
    """Return the SI unit of the number at a path; None if no scene has such a number."""
    return units().get(re.sub(r"\[\d+\]", "[]", path))


def is_of_motion(path: str) -> bool:
    """Return whether a path names a number of the motion."""
    return path.startswith("motion.")


def is_speed(path: str) -> bool:
    """Return whether a path is "speed", or a speed of the motion, in place of which "speed" must be given."""
    return path == SPEED or (is_of_motion(path) and path.endswith(f".{SPEED}"))


def _is_of_a_part(path: str) -> bool:
    """Return whether a path names a number of the optional motion or harvester of a scene."""
    return is_of_motion(path) or path.startswith(_HARVESTER)


def paths_of(scene: Scene) -> list[str]:
    """List the paths of all numbers that a scene can have; of lists and of the motion, only existing ones."""
    return [path for each in units() for path in _in_lists_of(scene, each) if _is_there(scene, path)]


def check_path(argument: str, path: object) -> str:
    """Return the path of a number given by an argument; refuse a path that no scene has."""
    if not isinstance(path, str):
        bound = "the name of an input is a string"
        raise InvalidValue(argument, path, bound, 'give one such as "beam.thickness"')
    if unit_of(path) is None:
        known = [name.replace("[]", "[0]") for name in units()]
        near = [SPEED] if is_speed(path) else difflib.get_close_matches(path, known, n=1) or known
        raise InvalidValue(argument, path, "unknown input", f"give {', '.join(near)}")
    return path


def _numbers(made: type, path: str) -> Iterator[tuple[str, str]]:
    """Yield path and unit of each number, except speeds, in a class's fields and in objects in its fields.

    Each path starts with `path`.
    """
    if not is_dataclass(made):
        return
    hints = get_type_hints(made, include_extras=True)
    for each in fields(made):
        found, parts = description(hints[each.name]), [*_parts(hints[each.name])]
        key = (found and found.key) or each.name
        for part in parts:
            yield from _numbers(part, f"{path}.{key}")
        if not parts and found is not None and float in kinds_of(hints[each.name]) and key != SPEED:
            yield f"{path}.{key}", found.unit


def _parts(hint: Any) -> Iterator[type]:
    """Yield the classes in a field's type hint whose fields are numbers of a scene."""
    for kind in kinds_of(hint):
        if isinstance(kind, type) and issubclass(kind, Motion):
            yield from (each for each in KINDS.values() if issubclass(each, kind))
        elif isinstance(kind, type) and is_dataclass(kind):
            yield kind


def _in_lists_of(scene: Scene, path: str) -> list[str]:
    """Expand a path with "[]" to the paths of each member of that list in the scene."""
    table, is_listed, _ = path.partition("[]")
    many = len(part_at(scene, _in_scene(table))) if is_listed else 1
    return [path.replace("[]", f"[{k}]") for k in range(many)]


def _is_there(scene: Scene, path: str) -> bool:
    return not _is_of_a_part(path) or number_at(scene, path) is not None


# Getting and setting ------------------------------------------------------------------------------


def _in_scene(path: str) -> str:
    """Translate the path of a number in scene files to its attribute path in a `Scene`."""
    table, _, key = path.partition(".")
    if table == "model":
        return key
    if table == "beam" and key in SECTION_UNITS:
        return f"beam.section.{key}"
    return re.sub(r"^beam\.point_(mass|spring)\b", lambda found: _POINT_LISTS[found[1]], path)


_POINT_LISTS = {"mass": "beam.point_masses", "spring": "beam.point_springs"}


def number_at(scene: Scene, path: str) -> float | None:
    """Get the number of a path in a scene: None if the scene lacks it, nan if it varies along the beam."""
    if path.startswith(SCALE):
        return None if _why_no_factor(scene.beam, path.removeprefix(SCALE)) else 1.0
    if path.startswith("beam.tip.") and scene.beam.tip is None:
        return part_at(TipMass(0.0), path.removeprefix("beam.tip."))
    value = part_at(*_holder(scene, path))
    if isinstance(value, Profile):
        is_constant = value.degree == 0 and len({*map(tuple, value.coefficients)}) == 1
        return float(value.end_values()[0][0]) if is_constant else math.nan
    return value if isinstance(value, float) else None


def _holder(scene: Scene, path: str) -> tuple[Any, str]:
    """Find the object (scene, layers or bare beam) that has a number, and the number's attribute path."""
    electrodes = scene.beam.electrodes
    if path.startswith(_HARVESTER):
        return electrodes and electrodes.harvester, path.removeprefix(_HARVESTER)
    if electrodes is not None and path.startswith("beam.") and not path.startswith(_ON_ANY_BEAM):
        return electrodes.bare, _in_scene(path).removeprefix("beam.")
    return scene, _in_scene(path)


def with_numbers(scene: Scene, values: Mapping[str, float]) -> Scene:
    """Return the scene with some numbers replaced, rebuilt by the constructors that validate input.

    Parameters
    ----------
    scene : Scene
        The scene.
    values : mapping of str to float
        Numbers by path, in SI units; the speed, if given, is not used.

    Raises
    ------
    InvalidValue
        If a value is out of its range, or the scene has no such number: no such member of a list, another
        motion, or no rectangular section although a side or the material of a section is given.
    """
    of_beam = {path.removeprefix("beam."): float(v) for path, v in values.items() if path.startswith("beam.")}
    of_layers = {
        path.removeprefix(_HARVESTER): float(v) for path, v in values.items() if path.startswith(_HARVESTER)
    }
    others = {
        _in_scene(path): float(value)
        for path, value in values.items()
        if path != SPEED and not path.startswith(("beam.", _HARVESTER))
    }
    for path in values:
        if path.startswith(SCALE) and (why := _why_no_factor(scene.beam, path.removeprefix(SCALE))):
            raise InvalidValue(path, values[path], *why)
        if ("[" not in path and not _is_of_a_part(path)) or number_at(scene, path) is not None:
            continue
        alike = [
            each
            for each in paths_of(scene)
            if ("[" in each, _is_of_a_part(each)) == ("[" in path, _is_of_a_part(path))
        ]
        whose, otherwise = "scene", "give the scene one"
        if is_of_motion(path):
            whose, otherwise = "scene's motion", "give the scene a motion that has it"
        remedy = f"give one of {', '.join(alike)}" if alike else otherwise
        raise InvalidValue("vary", path, f"the {whose} has no such number", remedy)
    with _naming_paths(values):
        beam: dict[str, Any] = {}
        if of_beam or of_layers:
            beam = {"beam": _layered(scene.beam, of_beam, of_layers)}
        return with_parts(scene, others | beam)


@contextmanager
def _naming_paths(values: Mapping[str, float]) -> Iterator[None]:
    """Within this context, error messages name the number's path, not the constructor's argument."""
    try:
        yield
    except InvalidValue as error:
        path = next((path for path in values if path.endswith(f".{error.field}")), error.field)
        raise replace(error, field=path) from None


def _layered(beam: Beam, values: Mapping[str, float], of_layers: Mapping[str, float]) -> Beam:
    """Replace numbers of a beam, and put its piezoelectric layers, if any, on the new beam."""
    if beam.electrodes is None:
        return _beam_with(beam, values)
    harvester = replace(beam.electrodes.harvester, **of_layers)
    carried = {name: getattr(beam, name) for name in ("tip", "point_masses", "point_springs")}
    return harvester.on(_beam_with(replace(beam.electrodes.bare, **carried), values))


def _beam_with(beam: Beam, values: Mapping[str, float]) -> Beam:
    """Replace numbers of a beam, then multiply the properties that have a scale factor."""
    section = {name: value for name, value in values.items() if name in SECTION_UNITS}
    own: dict[str, Any] = {
        _in_scene(f"beam.{name}").removeprefix("beam."): _as_property(name, value)
        for name, value in values.items()
        if name not in section and not name.startswith("scale.")
    }
    _check_section(beam, section, values)
    if beam.tip is None and any(name.startswith("tip.") for name in own):
        beam = replace(beam, tip=TipMass(0.0))
    beam = with_parts(beam, own)
    if section and beam.section is not None:
        beam = beam.with_section(replace(beam.section, **section))
    for name, value in values.items():
        if name.startswith("scale."):
            beam = _scaled(beam, name.removeprefix("scale."), value)
    return beam


def _as_property(name: str, value: float) -> float | Profile:
    if name in OF_ANY_SIGN:
        return to_profile(name, value)
    return as_profile(name, value) if name in PROPERTY_UNITS else value


def _check_section(beam: Beam, section: Mapping[str, float], values: Mapping[str, float]) -> None:
    """Refuse a section's sides or material, given with derived properties or for a beam without section."""
    if not section:
        return
    name, value = next(iter(section.items()))
    if other := next((name for name in values if name in PROPERTY_UNITS), None):
        bound = f"beam.{other} follows from the section, and cannot be given together with its numbers"
        remedy = f"leave one of them out, or give {SCALE}{other}, which multiplies it"
        raise InvalidValue(f"beam.{name}", value, bound, remedy)
    if beam.section is None:
        bound = "the properties of the beam are not those of a rectangular section"
        raise InvalidValue(f"beam.{name}", value, bound, "vary beam.bending_stiffness or the like")


def _why_no_factor(beam: Beam, name: str) -> tuple[str, str] | None:
    """Return why a property of a beam, or a side, takes no factor, and a remedy; None if it takes one."""
    if beam.matrices is not None:
        return "the beam's properties follow from its 6 x 6 section matrices", "change the matrices instead"
    if name in PROPERTY_UNITS and getattr(beam, name) is None:
        return "the beam has no such property", "give it one"
    if name in PROPERTY_UNITS and beam.electrodes is not None:
        remedy = "vary beam.density, beam.youngs_modulus or a side"
        return "layers need a beam with the properties of its rectangular section", remedy
    return None


def _scaled(beam: Beam, name: str, factor: float) -> Beam:
    """Multiply a property of the beam, or, if `name` is a side, stretch its sections in that direction."""
    factor = positive(SCALE + name, factor)
    if beam.section is not None and name in (*SIDES, *beam.section.properties):
        section = beam.section.scaled(name, factor)
        return replace(beam, section=section, **section.properties)
    powers = _SIDE_POWERS.get(name, {name: 1})
    there = {each: getattr(beam, each) for each in powers if getattr(beam, each) is not None}
    return replace(beam, **{each: profile.scaled(factor ** powers[each]) for each, profile in there.items()})
