"""The values that a scene has for the inputs of studies: tolerances are about them."""

from __future__ import annotations

import math

from beamdyn.common.checks import InvalidValue
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.profile import Profile, as_profile
from beamdyn.scene.rectangle import rectangle_of
from beamdyn.scene.scene import Scene
from beamdyn.studies.inputs import SCALE, SPEED
from beamdyn.studies.listed_numbers import listed_value, unit_of_listed
from beamdyn.studies.motion_numbers import motion_value, unit_of_motion_number

_SECTION = ("width", "thickness", "youngs_modulus", "density", "poissons_ratio")


def nominal_value(scene: Scene, name: str, speed: float) -> float:
    """The value of an input in a scene, in SI.

    Parameters
    ----------
    scene : Scene
        The scene.
    name : str
        A name of `beamdyn.studies.inputs.NAMES`.
    speed : float
        That of the input "speed" [rad/s].

    Raises
    ------
    InvalidValue
        If the scene has no such number, or it varies along the beam, or is infinite.
    """
    if name == SPEED:
        return speed
    if name.startswith(SCALE):
        return 1.0
    table, _, key = name.partition(".")
    if unit_of_listed(name) is not None:
        value = listed_value(scene, name)
    elif unit_of_motion_number(name) is not None:
        value = motion_value(scene, name)
    else:
        value = _of_beam(scene.beam, name, key) if table == "beam" else _attribute(scene, table, key)
    if value is None:
        raise InvalidValue("spread", name, "the scene has no such number", "give it one, or leave it out")
    if not math.isfinite(value):
        raise InvalidValue("spread", name, f"the scene's value is {value:g}", "give it a finite one first")
    return float(value)


def _attribute(scene: Scene, table: str, key: str) -> float | None:
    return getattr(scene.mount if table == "mount" else scene, key)


def _of_beam(beam: Beam, name: str, key: str) -> float | None:
    if key.startswith("tip."):
        return getattr(beam.tip or TipMass(0.0), key.removeprefix("tip."))
    if key == "length":
        return beam.length
    if key not in _SECTION:
        return _constant(name, getattr(beam, key))
    section = rectangle_of(beam)
    if section is None:
        bound = "the properties of the beam are not those of a rectangular section"
        raise InvalidValue("spread", name, bound, "give a spread of beam.bending_stiffness or the like")
    side = getattr(section, key)
    return side if side is None or isinstance(side, float) else _constant(name, as_profile(key, side))


def _constant(name: str, profile: Profile | None) -> float | None:
    if profile is None:
        return None
    if profile.degree or len({*map(tuple, profile.coefficients)}) > 1:
        factor = name.replace("beam.", SCALE, 1)
        bound = "it varies along the beam"
        raise InvalidValue("spread", name, bound, f"give a spread of {factor}, which multiplies it")
    return float(profile.end_values()[0][0])
