"""Numbers of a scene that stand in lists of its file: point masses, point springs, damping ratios.

Their names have the index from 0, as refusals of files have: "beam.point_mass[0].position",
"damping.ratios[1]".
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from beamdyn.common.checks import InvalidValue
from beamdyn.common.described import descriptions
from beamdyn.scene.beam import Beam
from beamdyn.scene.points import PointMass, PointSpring
from beamdyn.scene.scene import Scene

POINTS = {"point_mass": "point_masses", "point_spring": "point_springs"}  # fields of a beam by names in files
_KINDS = {"point_mass": PointMass, "point_spring": PointSpring}
_POINT = re.compile(r"beam\.(point_mass|point_spring)\[(\d+)\]\.(\w+)")
_RATIO = re.compile(r"damping\.ratios\[(\d+)\]")


def unit_of_listed(name: str) -> str | None:
    """SI unit of a number in a list; None if the name is of none."""
    if _RATIO.fullmatch(name):
        return ""
    match = _POINT.fullmatch(name)
    found = descriptions(_KINDS[match[1]]).get(match[3]) if match else None
    return None if found is None or (found.least is None and found.above is None) else found.unit


def listed_names(scene: Scene) -> tuple[str, ...]:
    """Names of all numbers in the lists of a scene."""
    points = [
        f"beam.{kind}[{k}].{key}"
        for kind, field in POINTS.items()
        for k in range(len(getattr(scene.beam, field)))
        for key in descriptions(_KINDS[kind])
        if unit_of_listed(f"beam.{kind}[{k}].{key}") is not None
    ]
    return (*points, *(f"damping.ratios[{k}]" for k in range(len(scene.damping.ratios))))


def listed_value(scene: Scene, name: str) -> float | None:
    """The number of a name in the lists of a scene; None if they are shorter."""
    if name not in listed_names(scene):
        return None
    if match := _POINT.fullmatch(name):
        return getattr(getattr(scene.beam, POINTS[match[1]])[int(match[2])], match[3])
    return scene.damping.ratios[int(name.partition("[")[2].rstrip("]"))]


def check_listed(scene: Scene, design: Mapping[str, float]) -> None:
    """Refuse names whose index is beyond the lists of a scene."""
    known = listed_names(scene)
    for name in design:
        if unit_of_listed(name) is not None and name not in known:
            remedy = f"give one of {', '.join(known)}" if known else "give the scene one"
            raise InvalidValue("vary", name, "the scene has no such number", remedy)


def with_points(beam: Beam, design: Mapping[str, float]) -> Beam:
    """The beam with numbers of its point masses and springs replaced."""
    changed: dict[str, Any] = {}
    for name, value in design.items():
        if match := _POINT.fullmatch(name):
            field, k = POINTS[match[1]], int(match[2])
            points = list(changed.get(field, getattr(beam, field)))
            points[k] = replace(points[k], **{match[3]: float(value)})
            changed[field] = points
    return replace(beam, **changed) if changed else beam


def with_damping(scene: Scene, design: Mapping[str, float]) -> Scene:
    """The scene with numbers of its damping replaced, beside the one ratio for all modes."""
    damping, ratios = scene.damping, list(scene.damping.ratios)
    changed: dict[str, Any] = {}
    for name, value in design.items():
        if match := _RATIO.fullmatch(name):
            ratios[int(match[1])] = float(value)
            changed["ratios"] = ratios
        elif name.startswith("damping."):
            changed[name.removeprefix("damping.")] = float(value)
    return replace(scene, damping=replace(damping, **changed)) if changed else scene
