"""Scenes in TOML: text with units in, core objects out, all mistakes in one message."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cached_property
from os import PathLike
from typing import Annotated, Any, Literal

from numpy.polynomial import Polynomial
from pydantic import BeforeValidator, Discriminator, Field, GetCoreSchemaHandler, Tag
from pydantic_core import CoreSchema, core_schema

from beamdyn.common.edge.config import ConfigError, CoreSection, parse, read, validated
from beamdyn.common.edge.inputs import Quantity, Section
from beamdyn.common.edge.units import quantity
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.motion import RoadWave, RollingWheel, SampledRotation, SpinUp, SteadyRotation
from beamdyn.scene.mount import Mount
from beamdyn.scene.profile import Table
from beamdyn.scene.scene import Scene

__all__ = ["ConfigError", "SceneInput", "load_scene", "parse_scene", "scene_from_dict"]


def load_scene(path: str | PathLike[str]) -> Scene:
    """Read a scene from a TOML file.

    Parameters
    ----------
    path : str or path-like
        The file.

    Returns
    -------
    Scene

    Raises
    ------
    ConfigError
        If there is no such file or it does not describe a scene; the message lists all mistakes.
    """
    return parse_scene(read(path), str(path))


def parse_scene(text: str, source: str = "scene") -> Scene:
    """Read a scene from TOML text.

    Parameters
    ----------
    text : str
        The text.
    source : str
        Name of its origin, for messages.

    Raises
    ------
    ConfigError
        If it does not describe a scene; the message lists all mistakes.
    """
    return scene_from_dict(parse(text, source), source)


def scene_from_dict(data: Mapping[str, Any], source: str = "scene") -> Scene:
    """A scene from the tables of a TOML file.

    Parameters
    ----------
    data : mapping
        Tables "beam" and "mount", and where wanted "motion" and "model", as tomllib reads them.
    source : str
        Name of its origin, for messages.

    Raises
    ------
    ConfigError
        If it does not describe a scene; the message lists all mistakes.
    """
    return validated(SceneInput, data, source).core


# Kinds of values ----------------------------------------------------------------------------------


Along = float | Polynomial | Table  # a property along the beam


class Metres(float):
    """A position given as a length, which becomes a fraction when the length of the beam is known."""


class Position(Quantity):
    """A position along the beam: a bare fraction x/L or a length with its unit."""

    def convert(self, given: object) -> float:
        """A fraction, or `Metres`."""
        return Metres(quantity(given, "m")) if isinstance(given, str) else super().convert(given)


_STATION = Position(meaning="position along the beam, as a fraction x/L or a length")
_BREAKPOINT = Position(meaning="places where a property jumps or has a kink, as fractions x/L or lengths")


class Varying(Quantity):
    """A quantity that is constant, a polynomial in x/L or a table over stations."""

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        constant = core_schema.no_info_plain_validator_function(self.parse)
        coefficient = core_schema.no_info_plain_validator_function(self.convert)
        station = core_schema.no_info_plain_validator_function(_STATION.parse)
        return core_schema.tagged_union_schema(
            {
                "<constant>": constant,
                "<polynomial>": _table(_polynomial, polynomial=coefficient),
                "<table>": _table(_stations, stations=station, values=constant),
            },
            discriminator=_kind_of_variation,
            custom_error_type="variation",
            custom_error_message="give a number with a unit, { polynomial = [...] } in powers of x/L, "
            "or { stations = [...], values = [...] }",
        )


def _table(build: Any, **lists: CoreSchema) -> CoreSchema:
    """Schema of an inline table of lists, from which something is built."""
    fields = {
        name: core_schema.typed_dict_field(core_schema.list_schema(item, strict=True, min_length=1))
        for name, item in lists.items()
    }
    table = core_schema.typed_dict_schema(fields, extra_behavior="forbid")
    return core_schema.no_info_after_validator_function(build, table)


def _polynomial(given: dict[str, list[float]]) -> Polynomial:
    return Polynomial(given["polynomial"])


def _stations(given: dict[str, list[float]]) -> Table:
    return Table(tuple(given["stations"]), tuple(given["values"]))


def _kind_of_variation(given: Any) -> str | None:
    if not isinstance(given, dict):
        return None if isinstance(given, list) else "<constant>"
    kinds = {"<polynomial>": {"polynomial"}, "<table>": {"stations", "values"}}
    return next((kind for kind, keys in kinds.items() if keys & given.keys()), None)


# Tables of the file -------------------------------------------------------------------------------


class TipInput(CoreSection):
    """[beam.tip]: a rigid body at the tip."""

    mass: Annotated[float, Quantity("kg", symbol="m_t", meaning="mass", least=0)]
    offset: Annotated[
        float,
        Quantity("m", symbol="e", meaning="distance of its centre of gravity beyond the end of the beam"),
    ] = TipMass.offset
    inertia: Annotated[
        float, Quantity("kg m2", symbol="J_n", meaning="moment of inertia about the axis of bending", least=0)
    ] = TipMass.inertia
    transverse_inertia: (
        Annotated[
            float,
            Quantity(
                "kg m2",
                symbol="J_e",
                meaning="moment of inertia about the direction of bending; else inertia",
                least=0,
            ),
        ]
        | None
    ) = TipMass.transverse_inertia
    axial_inertia: Annotated[
        float, Quantity("kg m2", symbol="J_1", meaning="moment of inertia about the beam axis", least=0)
    ] = TipMass.axial_inertia

    @cached_property
    def core(self) -> TipMass:
        """The tip body."""
        return TipMass(**dict(self))


class _BeamInput(CoreSection):
    length: Annotated[float, Quantity("m", symbol="L", meaning="length", above=0)]
    tip: TipInput | None = None
    breakpoints: list[Annotated[float, _BREAKPOINT]] = []  # noqa: RUF012  (pydantic copies it)

    def _arguments(self) -> dict[str, Any]:
        """What the constructors of `Beam` take."""
        given = {name: _to_fractions(value, self.length) for name, value in self if value is not None}
        return given | {"tip": self.tip and self.tip.core}


class RectangularInput(_BeamInput):
    """[beam]: a beam of rectangular section."""

    width: Annotated[Along, Varying("m", symbol="b", meaning="width of the section", above=0)]
    thickness: Annotated[
        Along, Varying("m", symbol="h", meaning="thickness, in the direction of bending", above=0)
    ]
    youngs_modulus: Annotated[float, Quantity("Pa", symbol="E", meaning="Young's modulus", above=0)]
    density: Annotated[float, Quantity("kg/m3", symbol="rho", meaning="density", above=0)]

    @cached_property
    def core(self) -> Beam:
        """The beam."""
        return Beam.rectangular(**self._arguments())


class StiffnessInput(_BeamInput):
    """[beam]: a beam of any section, by its stiffness."""

    mass_per_length: Annotated[Along, Varying("kg/m", symbol="rho A", meaning="mass per length", above=0)]
    bending_stiffness: Annotated[Along, Varying("N m2", symbol="E I", meaning="bending stiffness", above=0)]
    axial_stiffness: (
        Annotated[Along, Varying("N", symbol="E A", meaning="axial stiffness, for stretch", above=0)] | None
    ) = None
    outer_fibre: (
        Annotated[
            Along,
            Varying(
                "m",
                symbol="c",
                meaning="distance of the outer fibre from the neutral axis, for strain",
                above=0,
            ),
        ]
        | None
    ) = None

    @cached_property
    def core(self) -> Beam:
        """The beam."""
        return Beam.from_stiffness(**self._arguments())


def _to_fractions(given: Any, length: float) -> Any:
    """The same with positions in metres turned into fractions of the length."""
    if isinstance(given, Table):
        return Table(_to_fractions(given.stations, length), given.values)
    if isinstance(given, list | tuple):
        # Rounded, or 20 mm of 50 mm would lie beside the fraction 0.4, with a sliver between them.
        return tuple(round(x / length, 14) if isinstance(x, Metres) else x for x in given)
    return given


def _own(section: type[Section]) -> list[str]:
    return [name for name in section.model_fields if name not in _BeamInput.model_fields]


def _kind_of_beam(given: Any) -> str:
    keys = given.keys() if isinstance(given, dict) else set()
    return "<stiffness>" if keys & set(_own(StiffnessInput)) else "<rectangular>"


def _one_kind_of_beam(given: Any) -> Any:
    keys = given.keys() if isinstance(given, dict) else set()
    section, stiffness = ([k for k in _own(kind) if k in keys] for kind in (RectangularInput, StiffnessInput))
    if section and stiffness:
        raise ValueError(
            f"{', '.join(section)} and {', '.join(stiffness)} do not go together; describe the beam "
            f"either by {', '.join(_own(RectangularInput))} or by {', '.join(_own(StiffnessInput))}"
        )
    return given


BeamInput = Annotated[
    Annotated[RectangularInput, Tag("<rectangular>")] | Annotated[StiffnessInput, Tag("<stiffness>")],
    Discriminator(_kind_of_beam),
    BeforeValidator(_one_kind_of_beam),
]


class MountInput(CoreSection):
    """[mount]: how the root of the beam is fixed to the carrier."""

    radius: Annotated[
        float,
        Quantity(
            "m",
            symbol="r",
            meaning="distance of the root from the axis of rotation",
            least=0,
            remedy='for a beam that points outward give setting_angle = "180 deg"',
        ),
    ]
    setting_angle: Annotated[
        float,
        Quantity(
            "rad",
            symbol="phi",
            meaning="direction of the beam: 0 inward, 90 deg tangential, 180 deg outward",
            least=-2 * math.pi,
            most=2 * math.pi,
            remedy="that is one turn either way",
        ),
    ] = Mount.setting_angle
    bending_angle: Annotated[
        float,
        Quantity(
            "rad",
            symbol="psi",
            meaning="angle between the direction of bending and the plane of rotation",
            least=-2 * math.pi,
            most=2 * math.pi,
            remedy="that is one turn either way",
        ),
    ] = Mount.bending_angle

    @cached_property
    def core(self) -> Mount:
        """The mount."""
        return Mount(**dict(self))


class SteadyInput(CoreSection):
    """[motion] of kind "steady": rotation at constant speed about a fixed centre."""

    kind: Annotated[Literal["steady"], Field(description="kind of motion")] = "steady"
    speed: Annotated[float, Quantity("rad/s", symbol="omega", meaning="angular speed of the carrier")]

    @cached_property
    def core(self) -> SteadyRotation:
        """The motion."""
        return SteadyRotation(self.speed)


class SpinUpInput(CoreSection):
    """[motion] of kind "spin_up": from rest to a constant speed about a fixed centre."""

    kind: Annotated[Literal["spin_up"], Field(description="kind of motion")]
    speed: Annotated[float, Quantity("rad/s", symbol="omega_s", meaning="angular speed of the carrier")]
    duration: Annotated[float, Quantity("s", symbol="T", meaning="time that the spin-up takes", above=0)]
    law: Annotated[Literal["smooth", "linear"], Field(description="law of the spin-up")] = SpinUp.law

    @cached_property
    def core(self) -> SpinUp:
        """The motion."""
        return SpinUp(self.speed, self.duration, self.law)


class SampledInput(CoreSection):
    """[motion] of kind "sampled": a table of speeds, about a fixed centre."""

    kind: Annotated[Literal["sampled"], Field(description="kind of motion")]
    times: list[Annotated[float, Quantity("s", symbol="t", meaning="times of the table, from 0")]]
    speeds: list[Annotated[float, Quantity("rad/s", symbol="omega", meaning="speeds at these times")]]
    interpolation: Annotated[
        Literal["cubic", "pchip"], Field(description="cubic spline, or cubics that do not overshoot")
    ] = SampledRotation.interpolation

    @cached_property
    def core(self) -> SampledRotation:
        """The motion."""
        return SampledRotation(self.times, self.speeds, self.interpolation)


class RoadInput(CoreSection):
    """[motion.road]: a wavy road, by its height or by the velocity that it gives the wheel."""

    wavelength: Annotated[float, Quantity("m", symbol="lambda", meaning="wavelength of the road", above=0)]
    velocity_amplitude: (
        Annotated[
            float,
            Quantity("m/s", symbol="C", meaning="amplitude of the wheel's vertical velocity; or height"),
        ]
        | None
    ) = RoadWave.velocity_amplitude
    height: (
        Annotated[
            float,
            Quantity("m", symbol="A", meaning="amplitude of the road's height; or velocity_amplitude"),
        ]
        | None
    ) = RoadWave.height

    @cached_property
    def core(self) -> RoadWave:
        """The road."""
        return RoadWave(**dict(self))


def _kind_of_motion(given: Any) -> str:
    return f"<{given.get('kind', 'steady')}>" if isinstance(given, dict) else "<steady>"


RotationInput = Annotated[
    Annotated[SteadyInput, Tag("<steady>")]
    | Annotated[SpinUpInput, Tag("<spin_up>")]
    | Annotated[SampledInput, Tag("<sampled>")],
    Discriminator(_kind_of_motion, "kind", "give 'steady', 'spin_up' or 'sampled'"),
]


class RollingInput(CoreSection):
    """[motion] of kind "rolling": a wheel that rolls, on a flat or a wavy road."""

    kind: Annotated[Literal["rolling"], Field(description="kind of motion")]
    rolling_radius: Annotated[
        float, Quantity("m", symbol="R", meaning="distance travelled per angle turned", above=0)
    ]
    rotation: RotationInput
    road: RoadInput | None = None

    @cached_property
    def core(self) -> RollingWheel:
        """The motion."""
        return RollingWheel(self.rolling_radius, self.rotation.core, self.road and self.road.core)


MotionInput = Annotated[
    Annotated[SteadyInput, Tag("<steady>")]
    | Annotated[SpinUpInput, Tag("<spin_up>")]
    | Annotated[SampledInput, Tag("<sampled>")]
    | Annotated[RollingInput, Tag("<rolling>")],
    Discriminator(_kind_of_motion, "kind", "give 'steady', 'spin_up', 'sampled' or 'rolling'"),
]


class ModelInput(Section):
    """[model]: what the model includes."""

    damping_ratio: Annotated[
        float,
        Quantity(
            symbol="zeta", meaning="modal damping ratio of every mode", least=0, below=1, remedy="1 % is 0.01"
        ),
    ] = Scene.damping_ratio
    gravity: Annotated[float, Quantity("m/s2", symbol="g", meaning="gravity")] = Scene.gravity
    stretch: Annotated[bool, Field(description="keep the stretch of the beam and its Coriolis coupling")] = (
        Scene.stretch
    )


class SceneInput(CoreSection):
    """A scene: the tables [beam], [mount], and where wanted [motion] and [model]."""

    beam: BeamInput
    mount: MountInput
    motion: MotionInput | None = None
    model: ModelInput = ModelInput()

    @cached_property
    def core(self) -> Scene:
        """The scene."""
        return Scene(self.beam.core, self.mount.core, self.motion and self.motion.core, **dict(self.model))
