"""The numbers of a scene that an answer may depend on, with their values and the steps to take of them."""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from beamdyn.common.checks import InvalidValue
from beamdyn.common.described import descriptions
from beamdyn.scene.beam import PROPERTY_UNITS, Beam, TipMass
from beamdyn.scene.damping import Damping
from beamdyn.scene.mount import Mount
from beamdyn.scene.profile import Profile, as_profile, mean
from beamdyn.scene.rectangle import Rectangle, rectangle_of
from beamdyn.scene.scene import Scene
from beamdyn.studies.inputs import SCALE
from beamdyn.studies.listed_numbers import POINTS

_TOUCHING = 1e-6  # distance over the length at which a point stands beside another
_STEP = 0.01  # of a value, or of the size of its kind
_NEAR = 0.8  # similarity of a mistyped name: all begin alike


@dataclass(frozen=True)
class SceneNumber:
    """A number of a scene.

    Parameters
    ----------
    name : str
        Its name in scene files, such as "beam.thickness"; "beam.scale.mass_per_length" is a factor of a
        property that varies along the beam.
    unit : str
        Its SI unit.
    value : float
        Its value [unit].
    step : float
        Largest change within which the equations are evaluated for a derivative [unit].
    least : float
        Smallest value that it may have [unit].

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> number = bd.frequency_sensitivities(bd.Scene(strip), modes=1, inputs=["beam.density"]).inputs[0]
    >>> number.name, number.value
    ('beam.density', 7850.0)
    """

    name: str
    unit: str
    value: float
    step: float
    least: float = -math.inf


def check_names(inputs: object) -> tuple[str, ...] | None:
    """The names of numbers as they were given to an analysis; None for all."""
    if inputs is None:
        return None
    good = isinstance(inputs, list | tuple) and inputs and all(isinstance(name, str) for name in inputs)
    if not good:
        raise InvalidValue("inputs", inputs, 'give names in a list, such as ["beam.thickness"]')
    assert isinstance(inputs, list | tuple)
    return tuple(dict.fromkeys(inputs))


def numbers_of(scene: Scene, names: Sequence[str] | None = None) -> tuple[SceneNumber, ...]:
    """The numbers of a scene, all or those that are named.

    Raises
    ------
    InvalidValue
        If a name is none of theirs.
    """
    found = {each.name: each for each in _all(scene)}
    if names is None:
        return tuple(found.values())
    for name in names:
        if name == "speed":
            bound = "a critical or resonance speed is an answer, and no input"
            raise InvalidValue("inputs", name, bound, "leave it out")
        if name not in found:
            near = difflib.get_close_matches(str(name), found, n=1, cutoff=_NEAR)
            remedy = f"give {near[0] if near else ', '.join(found)}"
            raise InvalidValue("inputs", name, "it is no number of this scene", remedy)
    return tuple(found[name] for name in names)


def _all(scene: Scene) -> Iterator[SceneNumber]:
    yield _relative("beam.length", "m", scene.beam.length)
    yield from _of_section(scene)
    yield from _of_twist(scene.modelled_beam)
    yield from _of_tip(scene.beam)
    yield from _of_points(scene.beam)
    yield from _of_mount(scene)
    yield from _of_damping(scene)


def _relative(name: str, unit: str, value: float) -> SceneNumber:
    return SceneNumber(name, unit, value, _STEP * abs(value), 0.0)


def _of_section(scene: Scene) -> Iterator[SceneNumber]:
    """Sides and material of a rectangular section; else properties, or factors of those that vary."""
    section = rectangle_of(scene.beam)
    if section is not None and isinstance(section.width, float):
        sides = {name: as_profile(name, getattr(section, name)) for name in ("width", "thickness")}
        if all(map(_is_constant, sides.values())):
            yield from (_relative(f"beam.{name}", "m", _at_root(side)) for name, side in sides.items())
            yield from _of_material(scene, section)
            return
    yield from _of_properties(scene)


def _of_material(scene: Scene, section: Rectangle) -> Iterator[SceneNumber]:
    yield _relative("beam.youngs_modulus", "Pa", section.youngs_modulus)
    yield _relative("beam.density", "kg/m3", section.density)
    if scene.physics.shear and section.poissons_ratio is not None:
        yield SceneNumber("beam.poissons_ratio", "", section.poissons_ratio, _STEP)


def _of_properties(scene: Scene) -> Iterator[SceneNumber]:
    """The properties that are modelled: axial stiffness is for stretch alone, outer fibres for strains."""
    unused = {"outer_fibre"} if scene.physics.stretch else {"outer_fibre", "axial_stiffness"}
    for name, unit in PROPERTY_UNITS.items():
        profile = getattr(scene.modelled_beam, name)
        if profile is not None and name not in unused:
            if _is_constant(profile):
                yield _relative(f"beam.{name}", unit, _at_root(profile))
            else:
                yield _relative(f"{SCALE}{name}", "", 1.0)


def _of_twist(beam: Beam) -> Iterator[SceneNumber]:
    if beam.twist is not None and _is_constant(beam.twist):
        yield SceneNumber("beam.twist", "rad", _at_root(beam.twist), _STEP)


def _is_constant(profile: Profile) -> bool:
    return profile.degree == 0 and len({*map(tuple, profile.coefficients)}) == 1


def _at_root(profile: Profile) -> float:
    return float(profile.end_values()[0][0])


def _of_tip(beam: Beam) -> Iterator[SceneNumber]:
    """Numbers of the tip body; its steps are of the beam's size where they are small."""
    if beam.tip is None:
        return
    L, mass = beam.length, mean(beam.mass_per_length) * beam.length
    sizes = {"kg": mass, "m": L, "kg m2": mass * L**2}
    for name, found in descriptions(TipMass).items():
        if (value := getattr(beam.tip, name)) is not None:
            least = 0.0 if found.unit != "m" else -math.inf
            step = _STEP * max(abs(value), sizes[found.unit])
            yield SceneNumber(f"beam.tip.{name}", found.unit, value, step, least)


def _of_mount(scene: Scene) -> Iterator[SceneNumber]:
    for name, found in descriptions(Mount).items():
        value = getattr(scene.mount, name)
        if found.unit == "rad":
            if name != "precone" or value:
                yield SceneNumber(f"mount.{name}", "rad", value, _STEP)
        elif name == "radius":
            yield SceneNumber("mount.radius", "m", value, _STEP * max(value, scene.beam.length), 0.0)
        elif math.isfinite(value) and (name == "root_stiffness" or scene.physics.planes == 2):
            beam = scene.beam
            bending = mean(beam.bending_stiffness) / beam.length  # the scale of a soft spring, and of a hinge
            yield SceneNumber(f"mount.{name}", found.unit, value, _STEP * max(value, bending), 0.0)


def _of_points(beam: Beam) -> Iterator[SceneNumber]:
    """Masses and springs along the beam; their places where nothing else changes along the beam there."""
    sizes = {
        "mass": mean(beam.mass_per_length) * beam.length,
        "stiffness": mean(beam.bending_stiffness) / beam.length**3,
    }
    for kind, field in POINTS.items():
        for k, point in enumerate(getattr(beam, field)):
            name, amount = f"beam.{kind}[{k}]", "mass" if kind == "point_mass" else "stiffness"
            value, unit = getattr(point, amount), descriptions(type(point))[amount].unit
            yield SceneNumber(f"{name}.{amount}", unit, value, _STEP * max(value, sizes[amount]), 0.0)
            if room := _room_of(beam, field, k):
                yield SceneNumber(f"{name}.position", "m", point.position, room, 0.0)


def _room_of(beam: Beam, field: str, k: int) -> float:
    """How far a point may move along the beam for a derivative [m]; 0 where it stands beside another."""
    points = getattr(beam, field)
    others = replace(beam, **{field: [*points[:k], *points[k + 1 :]]}).breakpoints
    apart = min(abs(points[k].position - xi * beam.length) for xi in others)
    return min(_STEP / 10 * beam.length, apart / 3) if apart > _TOUCHING * beam.length else 0.0


def _of_damping(scene: Scene) -> Iterator[SceneNumber]:
    if scene.damping_ratio:
        yield _relative("model.damping_ratio", "", scene.damping_ratio)
    for k, ratio in enumerate(scene.damping.ratios):
        if ratio:
            yield _relative(f"damping.ratios[{k}]", "", ratio)
    for name in ("mass_factor", "stiffness_factor", "tip_damper"):
        if value := getattr(scene.damping, name):
            yield _relative(f"damping.{name}", descriptions(Damping)[name].unit, value)
