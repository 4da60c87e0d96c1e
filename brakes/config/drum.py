"""Drum brakes in TOML: the tables [brake], [shoe], [load] and, where it differs, [second_shoe]."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from os import PathLike
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from beamdyn.common.checks import InvalidValue
from beamdyn.common.edge.config import CoreSection, parse, read, validated
from beamdyn.common.edge.inputs import Quantity, Section
from beamdyn.common.edge.wording import in_range, of_file
from brakes.drum import (
    BrakeResult,
    DrumBrake,
    Shoe,
    brake_torque,
    duplex,
    simplex,
    wheel_cylinder_force,
)

__all__ = ["DrumInput", "drum_from_dict", "load_drum", "parse_drum"]


def load_drum(path: str | PathLike[str]) -> DrumInput:
    """Read a drum brake from a TOML file.

    Parameters
    ----------
    path : str or path-like
        The file.

    Returns
    -------
    DrumInput
        Its ``core`` is the brake, its ``solve()`` the answer.

    Raises
    ------
    ConfigError
        If there is no such file or it does not describe a drum brake; the message lists all mistakes.
    """
    return parse_drum(read(path), str(path))


def parse_drum(text: str, source: str = "drum brake") -> DrumInput:
    """Read a drum brake from TOML text; see `load_drum`."""
    return drum_from_dict(parse(text, source), source)


def drum_from_dict(data: Mapping[str, Any], source: str = "drum brake") -> DrumInput:
    """A drum brake from the tables of a TOML file; see `load_drum`."""
    return validated(DrumInput, data, source)


FaceWidth = Annotated[
    float, Quantity("m", symbol="w", meaning="width of the lining along the drum's axis", above=0)
]
LiningStart = Annotated[
    float,
    Quantity("rad", symbol="alpha1", meaning="start of the lining, from straight down, where the pin is"),
]
LiningEnd = Annotated[
    float, Quantity("rad", symbol="alpha2", meaning="end of the lining, from straight down")
]
PivotOffset = Annotated[
    float,
    Quantity("m", symbol="b", meaning="distance of the pin from the brake's line of symmetry, to its shoe"),
]
PivotDepth = Annotated[
    float, Quantity("m", symbol="c", meaning="depth of the pin below the drum's centre", above=0)
]
ForceArm = Annotated[
    float, Quantity("m", symbol="a", meaning="height of the actuating force above the drum's centre")
]
PressureZero = Annotated[
    Literal["axis", "pivot"],
    Field(description="line where the pressure vanishes: straight down (axis), or through the pin (pivot)"),
]

_KEYS = {
    "lining[0]": "lining_start",
    "lining[1]": "lining_end",
    "pivot[0]": "pivot_offset",
    "pivot[1]": "pivot_depth",
}


class ShoeInput(CoreSection):
    """[shoe]: a shoe on a fixed pin, described as if it lay on the right of the drum's centre."""

    drum_radius: Annotated[float, Quantity("m", symbol="r", meaning="inner radius of the drum", above=0)]
    face_width: FaceWidth
    lining_start: LiningStart
    lining_end: LiningEnd
    pivot_offset: PivotOffset
    pivot_depth: PivotDepth
    force_arm: ForceArm
    pressure_zero: PressureZero = Shoe.pressure_zero

    @cached_property
    def core(self) -> Shoe:
        """The shoe."""
        with of_file(_KEYS):
            return Shoe(
                self.drum_radius,
                self.face_width,
                (self.lining_start, self.lining_end),
                (self.pivot_offset, -self.pivot_depth),
                self.force_arm,
                self.pressure_zero,
            )


class SecondShoeInput(Section):
    """[second_shoe]: the inputs in which the second shoe differs from [shoe]."""

    face_width: FaceWidth | None = None
    lining_start: LiningStart | None = None
    lining_end: LiningEnd | None = None
    pivot_offset: PivotOffset | None = None
    pivot_depth: PivotDepth | None = None
    force_arm: ForceArm | None = None

    def completed_by(self, first: ShoeInput) -> Shoe:
        """The second shoe: the inputs given here, the others as on the first."""
        given = {name: value for name, value in self if value is not None}
        with of_file({}):
            return ShoeInput.model_construct(**(dict(first) | given)).core


class LoadInput(Section):
    """[load]: the force on the shoes, or the torque or pressure that the brake is to give: exactly one."""

    force: Annotated[float, Quantity("N", symbol="P", meaning="force on each shoe", above=0)] | None = None
    cylinder_bore: (
        Annotated[
            float,
            Quantity("m", symbol="d", meaning="bore of the wheel cylinder, with line_pressure", above=0),
        ]
        | None
    ) = None
    line_pressure: (
        Annotated[
            float, Quantity("Pa", symbol="p_h", meaning="pressure in the line, with cylinder_bore", above=0)
        ]
        | None
    ) = None
    torque: (
        Annotated[float, Quantity("N m", symbol="M", meaning="torque that the brake is to give", above=0)]
        | None
    ) = None
    peak_pressure: (
        Annotated[float, Quantity("Pa", symbol="p_max", meaning="largest pressure on any lining", above=0)]
        | None
    ) = None

    @model_validator(mode="after")
    def _one(self) -> LoadInput:
        given = [name for name, value in self if value is not None]
        if given not in (["force"], ["cylinder_bore", "line_pressure"], ["torque"], ["peak_pressure"]):
            raise ValueError(
                "give one of force, torque, peak_pressure, or cylinder_bore with line_pressure; "
                f"got {' and '.join(given) or 'none'}"
            )
        return self

    @property
    def given(self) -> dict[str, Any]:
        """The load as an argument of `brake_torque`."""
        if self.line_pressure is not None:
            return {"force": wheel_cylinder_force(self.cylinder_bore, self.line_pressure)}
        return {name: value for name, value in self if value is not None}


class DrumBrakeInput(Section):
    """[brake]: which shoes lead, the direction of the drum, and the friction of the linings."""

    assembly: Annotated[
        Literal["simplex", "duplex", "single"],
        Field(
            description="simplex: one shoe leads, one trails; duplex: both lead forward; "
            "single: one shoe, which leads forward"
        ),
    ]
    direction: Annotated[Literal["forward", "reverse"], Field(description="direction of the drum")] = (
        "forward"
    )
    friction: Annotated[
        float,
        Quantity(symbol="mu", meaning="friction of the linings", least=0, most=10, remedy="35 % is 0.35"),
    ]


class DrumInput(CoreSection):
    """A drum brake: the tables [brake], [shoe], [load] and, where it differs, [second_shoe]."""

    brake: DrumBrakeInput
    shoe: ShoeInput
    second_shoe: SecondShoeInput | None = None
    load: LoadInput

    @cached_property
    def core(self) -> DrumBrake:
        """The brake."""
        second = self._second()
        if self.brake.assembly == "single":
            if self.second_shoe is not None:
                raise ValueError('second_shoe does not go with assembly = "single"; leave it out')
            return DrumBrake((self.shoe.core,), (True,))
        return (simplex if self.brake.assembly == "simplex" else duplex)(self.shoe.core, second)

    def _second(self) -> Shoe | None:
        try:
            return self.second_shoe and self.second_shoe.completed_by(self.shoe)
        except InvalidValue as error:
            raise replace(error, field=f"second_shoe.{error.field}") from None

    def solve(self) -> BrakeResult:
        """Compute the forces in the brake.

        Raises
        ------
        ValueError
            As for `brakes.drum.brake_torque`.
        """
        reverse = self.brake.direction == "reverse"
        with in_range(), of_file(_KEYS):
            return brake_torque(self.core, friction=self.brake.friction, **self.load.given, reverse=reverse)
