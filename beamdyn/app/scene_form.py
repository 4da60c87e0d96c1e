"""The form of the beam's screens: the tables of a scene file, and the options of commands."""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Mapping, Sequence
from typing import Annotated, Any, get_args

from pydantic import BaseModel, Field, create_model

from beamdyn import natural_modes
from beamdyn.common.edge.config import validated
from beamdyn.common.edge.inputs import Input, Quantity, Section, WholeNumber, describe
from beamdyn.common.edge.units import unit_as_written
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.results.columns import known_unit
from beamdyn.common.screens.screen_parts import Drag, Preset
from beamdyn.files.scene_inputs import MatricesInput, RectangularInput, SceneInput, StiffnessInput
from beamdyn.files.scenes import scene_from_dict
from beamdyn.modes.model_error.effect_choice import plain_physics
from beamdyn.scene.scene import Scene

# Tables of a scene file that the form of every screen shows, in this order.
SCENE_TABLES = ("beam", "harvester", "mount", "motion", "model", "damping", "tip_load", "physics")
TABLES = ("options", *SCENE_TABLES)
DRAGS = (
    Drag("mount.setting_angle", 0.0, 180.0, 1.0, "deg"),
    Drag("mount.radius", 0.0, 500.0, 5.0, "mm"),
    Drag("beam.thickness", 0.1, 1.0, 0.01, "mm"),
)
# Young's modulus, density and Poisson's ratio at room temperature; actual values may differ by some percent.
_MATERIALS = {
    "steel": ("200 GPa", "7850 kg/m3", "0.3"),
    "stainless steel": ("193 GPa", "7900 kg/m3", "0.29"),
    "aluminium": ("70 GPa", "2700 kg/m3", "0.33"),
    "titanium alloy": ("114 GPa", "4430 kg/m3", "0.34"),
    "brass": ("105 GPa", "8500 kg/m3", "0.34"),
    "beryllium copper": ("130 GPa", "8250 kg/m3", "0.3"),
}
_OF_MATERIAL = "beam.youngs_modulus", "beam.density", "beam.poissons_ratio"
_DIRECTIONS = {"inward, to the axis": "0 deg", "along the rim": "90 deg", "outward": "180 deg"}
PRESETS = (
    Preset(
        "beam",
        "material",
        {name: dict(zip(_OF_MATERIAL, each, strict=True)) for name, each in _MATERIALS.items()},
    ),
    Preset(
        "mount",
        "the beam points",
        {name: {"mount.setting_angle": angle} for name, angle in _DIRECTIONS.items()},
    ),
)
# Advice on computations that take long.
EFFORT = "It takes longer at higher speeds, with more modes, and if the beam varies much along its length."
# Inputs that are lists of tables, with their meanings.
_LISTS = {
    "beam.point_mass": 'point masses, each such as { position = "20 mm", mass = "1 g" }',
    "beam.point_spring": 'springs along the beam, each such as { position = "20 mm", stiffness = "10 N/m" }',
}
COARSE = "coarse"  # name of a table that requests a preliminary result, with simple physics
_USUAL_SPEED = "rad/s"
_FASTEST = 10  # highest accepted speed, as a multiple of the first natural angular frequency at rest


class OptionsInput(Section):
    """[options]: speed range and number of modes, which are options on the command line."""

    top_speed: Annotated[
        float, Quantity("rad/s", symbol="omega", meaning="top speed", above=0, remedy='e.g. "150 rad/s"')
    ]
    modes: Annotated[float, WholeNumber(symbol="n", meaning="how many modes", least=1, most=8)]


class OperationInput(Section):
    """[operation]: one speed, which is an option on the command line."""

    speed: Annotated[
        float,
        Quantity("rad/s", symbol="omega", meaning="speed of rotation", least=0, remedy='e.g. "55 rad/s"'),
    ]


class TradeInput(Section):
    """[trade]: the requested number of correct digits."""

    digits: Annotated[float, WholeNumber(symbol="n", meaning="digits to keep", least=1, most=10)]


class RunInput(Section):
    """[run]: how long a transient is, and the window in which its peak is sought."""

    end: Annotated[float, Quantity("s", meaning="end of the run", above=0, remedy='e.g. "12 s"')]
    window_start: Annotated[float, Quantity("s", meaning="start of the window for the peak", least=0)] = 0.0
    window_end: Annotated[
        float | None,
        Quantity("s", meaning="end of the window for the peak; default: end of the run", above=0),
    ] = None


# Tables of the form that are not part of a scene file.
ASIDE: dict[str, type[Section]] = {
    "options": OptionsInput,
    "operation": OperationInput,
    "trade": TradeInput,
    "run": RunInput,
}


class _NoKind(Section):
    """A table whose kind the user has not chosen yet."""

    kind: Annotated[str, Field(description="kind of motion")]


def inputs_of(entries: Mapping[str, str]) -> list[Input]:
    """List the inputs for the kinds of beam and motion that the field texts choose."""
    kinds: dict[str, tuple[str, ...]] = {}

    def choose(table: str, models: Sequence[type[BaseModel]]) -> list[type[BaseModel]]:
        if table == "beam":
            given = {
                path.split(".")[1] for path, text in entries.items() if path.startswith("beam.") and text
            }
            # The column headings in the field beam.stations count as given inputs.
            given |= {*re.findall(r"\w+", entries.get("beam.stations", ""))}
            if "matrices" in given:
                return [MatricesInput]
            own = set(StiffnessInput.model_fields) - set(RectangularInput.model_fields)
            return [StiffnessInput if given & own else RectangularInput]
        by_kind = {get_args(model.model_fields["kind"].annotation)[0]: model for model in models}
        kinds[f"{table}.kind"] = tuple(by_kind)
        chosen = any(text for path, text in entries.items() if path.startswith(f"{table}."))
        # A table that has keys but no kind gets the first kind.
        usual = next(iter(by_kind)) if chosen else ""
        return [by_kind.get(entries.get(f"{table}.kind", "") or usual, _NoKind)]

    aside = [entry for table, model in ASIDE.items() for entry in describe(model, f"{table}.")]
    inputs: dict[str, Input] = {}
    for entry in (*aside, *describe(SceneInput, choose=choose)):
        whole = next((path for path in _LISTS if entry.path.startswith(f"{path}.")), "")
        if whole:  # one field for a whole list of tables
            words = Quantity(meaning=_LISTS[whole])
            inputs.setdefault(whole, Input(whole, entry.section, list[dict], words, (), False, None))
        elif entry.path in kinds:
            choices = kinds[entry.path]
            inputs[entry.path] = dataclasses.replace(entry, choices=choices, required=False, default=None)
        else:
            inputs[entry.path] = entry
    return [*inputs.values()]


def read(tables: Mapping[str, Any]) -> tuple[Scene, float, int]:
    """Read the scene, the top speed [rad/s] and the number of modes from the form's tables."""
    return _read_with_speed(tables, "options", "top_speed")


def read_at_speed(tables: Mapping[str, Any]) -> tuple[Scene, float, int]:
    """Read the scene, one speed [rad/s] and the number of modes from the form's tables."""
    return _read_with_speed(tables, "operation", "speed")


def _read_with_speed(tables: Mapping[str, Any], table: str, key: str) -> tuple[Scene, float, int]:
    """Read a scene, a speed [rad/s] and the number of modes.

    Results are shown in the unit of this speed, unless it is rad/s.  A speed whose computation would take
    minutes is an error: the faster the beam rotates, the more basis functions each mode needs.  The limit
    depends on the stiffness of the beam, not on the stiffness of the root, which may be a hinge.
    """
    speed, modes = getattr(read_aside(tables, table), key), read_aside(tables, "options").modes
    scene = read_scene(tables)
    unit = known_unit("speed", unit_as_written(tables[table][key], "rad/s")[0])
    if unit not in ("", _USUAL_SPEED):
        scene = dataclasses.replace(scene, units=scene.units.with_others({"speed": unit}))
    clamped = dataclasses.replace(scene.mount, root_stiffness=math.inf, second_root_stiffness=math.inf)
    limit = _FASTEST * first_frequency(dataclasses.replace(scene, mount=clamped))
    if speed > limit:
        of = "" if clamped == scene.mount else ", were the root clamped"
        bound = f"it must be at most {{limit}}, {_FASTEST} times the first natural frequency at rest{of}"
        raise InvalidValue(f"{table}.{key}", speed, bound, unit="rad/s", limit=limit)
    return scene, speed, int(modes)


def read_scene(tables: Mapping[str, Any]) -> Scene:
    """Read the scene from the form's tables; for a preliminary result, with few physical effects."""
    own = {name: table for name, table in tables.items() if name not in ASIDE and name != COARSE}
    return plain_physics(scene_from_dict(own)) if COARSE in tables else scene_from_dict(own)


def coarser(tables: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the tables that request a preliminary result, which is faster, for the drawing."""
    return {**tables, COARSE: {}}


def read_aside(tables: Mapping[str, Any], name: str) -> Any:
    """Read the values of a table that is not part of a scene file."""
    model = create_model("_Aside", __base__=Section, **{name: (ASIDE[name], ...)})  # pyright: ignore[reportCallIssue, reportArgumentType]
    return getattr(validated(model, {name: tables.get(name, {})}, name), name)


def first_frequency(scene: Scene) -> float:
    """Compute the first natural angular frequency at rest [rad/s], with an error of at most 1 %."""
    return 2 * math.pi * float(natural_modes(scene, 0.0, 1, tolerance=0.01).frequency[0])
