"""Inputs that a study varies, by the names of scene files, and the scene of one design."""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import fields, replace
from typing import Any

from beamdyn.common.checks import InvalidValue, positive, real_array
from beamdyn.common.described import descriptions
from beamdyn.common.designs import VariedInput
from beamdyn.scene.beam import PROPERTY_UNITS, Beam, TipMass
from beamdyn.scene.mount import Mount
from beamdyn.scene.profile import as_profile, to_profile
from beamdyn.scene.rectangle import rectangle_of
from beamdyn.scene.scene import Scene
from beamdyn.studies.listed_numbers import check_listed, unit_of_listed, with_damping, with_points
from beamdyn.studies.motion_numbers import all_motion_names, check_motion, unit_of_motion_number, with_motion

SPEED = "speed"
SCALE = "beam.scale."  # before the names of properties that are multiplied, whatever they are along the beam
_OF_RECTANGLE = {
    "width": "m",
    "thickness": "m",
    "youngs_modulus": "Pa",
    "density": "kg/m3",
    "poissons_ratio": "",
}
# Powers of the sides of a section in its properties, whatever its form.
_LINEAR = ("mass_per_length", "axial_stiffness", "shear_stiffness", "second_shear_stiffness")
_OF_FIRST = ("bending_stiffness", "rotary_inertia")
_OF_SECOND = ("second_bending_stiffness", "second_rotary_inertia")
SECTION_POWERS = {
    "thickness": {
        "outer_fibre": 1,
        **dict.fromkeys((*_LINEAR, *_OF_SECOND), 1),
        **dict.fromkeys(_OF_FIRST, 3),
    },
    "width": {**dict.fromkeys((*_LINEAR, *_OF_FIRST), 1), **dict.fromkeys(_OF_SECOND, 3)},
}
_OF_BEAM = {"length": "m", "twist": "rad"}
_UNITS: dict[str, str] = {
    **{f"beam.{name}": unit for name, unit in (_OF_BEAM | _OF_RECTANGLE | PROPERTY_UNITS).items()},
    **{SCALE + name: "" for name in (*SECTION_POWERS, *PROPERTY_UNITS)},
    **{f"beam.tip.{name}": found.unit for name, found in descriptions(TipMass).items()},
    **{f"mount.{name}": found.unit for name, found in descriptions(Mount).items()},
    "model.damping_ratio": "",
    "model.gravity": "m/s2",
    SPEED: "rad/s",
}
NAMES = tuple(_UNITS)


def unit_of(name: str) -> str:
    """SI unit of an input."""
    units = _UNITS.get(name), unit_of_listed(name), unit_of_motion_number(name)
    return next(unit for unit in units if unit is not None)


def is_input(name: str) -> bool:
    """Whether a name is that of an input, be it one in a list, such as "beam.point_mass[0].mass"."""
    listed, of_motion = unit_of_listed(name), unit_of_motion_number(name)
    return name in _UNITS or listed is not None or of_motion is not None


def check_name(argument: str, name: object) -> str:
    """The name of an input, that of an argument of names; refused if there is no such input."""
    if not isinstance(name, str):
        bound = "the name of an input is a string"
        raise InvalidValue(argument, name, bound, 'give one such as "beam.thickness"')
    if not is_input(name):
        known = *NAMES, *all_motion_names()
        near = difflib.get_close_matches(name, known, n=1)
        raise InvalidValue(argument, name, "unknown input", f"give {near[0] if near else ', '.join(known)}")
    return name


def check_inputs(vary: Mapping[str, Any]) -> tuple[VariedInput, ...]:
    """The inputs of a study with their values as arrays.

    Raises
    ------
    InvalidValue
        If there are none, an input is unknown, or its values are no finite numbers.
    """
    remedy = 'give a dictionary, such as {"beam.thickness": [1e-4, 2e-4], "speed": [0.0, 50.0]}'
    if not isinstance(vary, Mapping) or not vary:
        raise InvalidValue("vary", vary, "it names no input", remedy)
    return tuple(_check_input(name, values) for name, values in vary.items())


def _check_input(given: object, values: Any) -> VariedInput:
    name = check_name("vary", given)
    array = real_array(name, values)
    if not array.size:
        raise InvalidValue(name, values, "it is empty; give at least one value")
    return VariedInput(name, unit_of(name), array)


# The scene of a design ----------------------------------------------------------------------------


def scene_of(scene: Scene, design: Mapping[str, float]) -> Scene:
    """The scene with the inputs of a design, made by the same constructors as the scene itself.

    Parameters
    ----------
    scene : Scene
        The scene.
    design : mapping of str to float
        Values by name, in SI; that of the speed is not used.

    Raises
    ------
    InvalidValue
        If a value is out of its range, or the beam is of no rectangular section where a side or the
        material of one is given.
    """
    check_listed(scene, design)
    check_motion(scene, design)
    with _naming_inputs(design):
        of_model = _part(design, "model.")
        mount = replace(scene.mount, **_part(design, "mount."))
        changed = replace(scene, beam=_beam_of(scene.beam, design), mount=mount, **of_model)
        return with_motion(with_damping(changed, design), design)


@contextmanager
def _naming_inputs(design: Mapping[str, float]) -> Iterator[None]:
    """Within it, a refusal of an argument of a constructor names the input."""
    try:
        yield
    except InvalidValue as error:
        path = next((name for name in design if name.endswith(f".{error.field}")), error.field)
        raise replace(error, field=path) from None


def _part(design: Mapping[str, float], prefix: str) -> dict[str, Any]:
    return {name.removeprefix(prefix): float(v) for name, v in design.items() if name.startswith(prefix)}


def _beam_of(beam: Beam, design: Mapping[str, float]) -> Beam:
    """The beam with inputs replaced, and then with what is multiplied."""
    return _scaled(with_points(_replaced(beam, design), design), _part(design, SCALE))


def _replaced(beam: Beam, design: Mapping[str, float]) -> Beam:
    of_tip = _part(design, "beam.tip.")
    given = {name: v for name, v in _part(design, "beam.").items() if "." not in name}
    if of_tip:
        beam = replace(beam, tip=replace(beam.tip or TipMass(0.0), **of_tip))
    if "twist" in given:
        beam = replace(beam, twist=to_profile("twist", given.pop("twist")))
    of_section = {name: v for name, v in given.items() if name in _OF_RECTANGLE}
    of_stiffness = {name: as_profile(name, v) for name, v in given.items() if name in PROPERTY_UNITS}
    if of_section and of_stiffness:
        side, other = next(iter(of_section)), next(iter(of_stiffness))
        bound = f"beam.{other} does not go together with it, as it follows from the section"
        remedy = f"leave one of them out, or give {SCALE}{other}, which multiplies it"
        raise InvalidValue(f"beam.{side}", of_section[side], bound, remedy)
    length = {"length": given["length"]} if "length" in given else {}
    return _rectangular(beam, length | of_section) if of_section else replace(beam, **length, **of_stiffness)


def _scaled(beam: Beam, factors: Mapping[str, float]) -> Beam:
    """The beam with properties multiplied, or with sections stretched in a direction."""
    for name, factor in factors.items():
        if name in PROPERTY_UNITS and getattr(beam, name) is None:
            raise InvalidValue(SCALE + name, factor, "the beam has no such property", "give it one")
        size = positive(SCALE + name, factor)
        powers = SECTION_POWERS.get(name, {name: 1})
        there = {each: getattr(beam, each) for each in powers if getattr(beam, each) is not None}
        beam = replace(beam, **{each: p.scaled(size ** powers[each]) for each, p in there.items()})
    return beam


def _rectangular(beam: Beam, given: Mapping[str, float]) -> Beam:
    """The beam with another section or material, by `Beam.rectangular`."""
    section = rectangle_of(beam)
    if section is None:
        name = next(iter(given.keys() & _OF_RECTANGLE.keys()))
        bound = "the properties of the beam are not those of a rectangular section"
        raise InvalidValue(f"beam.{name}", given[name], bound, "vary beam.bending_stiffness or the like")
    arguments: dict[str, Any] = {field.name: getattr(section, field.name) for field in fields(section)}
    own: dict[str, Any] = {
        "length": beam.length,
        "tip": beam.tip,
        "twist": beam.twist,
        "point_masses": beam.point_masses,
        "point_springs": beam.point_springs,
        "breakpoints": beam.breakpoints[1:-1],
    }
    return Beam.rectangular(**{**own, **arguments, **given})
