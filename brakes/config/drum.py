"""Input files of drum brakes: [brake], [shoe], [load], [heat]; [second_shoe] if the shoes differ."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from os import PathLike
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field, create_model

from beamdyn.common.edge.config import CoreSection, MadeSection, fields_of, parse, read, section_of, validated
from beamdyn.common.edge.inputs import Section, in_range, of_file
from beamdyn.common.inputs.checks import InvalidValue
from brakes.config.load import HeatInput, LoadInput, RubbingInput
from brakes.drum import BrakeResult, DrumBrake, Shoe, brake_torque, duplex, simplex

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
        The input; its ``core`` is the brake, its ``solve()`` computes the forces.

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
    """Read a drum brake from the tables of a TOML file; see `load_drum`."""
    return validated(DrumInput, data, source)


class ShoeInput(MadeSection):
    """Table [shoe] of a file: a shoe on a fixed pin, described as if right of the drum's centre."""

    @property
    def given(self) -> dict[str, Any]:
        """The arguments of `Shoe` that this table gives; the pin is at y = -depth."""
        given = super().given
        offset, depth = given["pivot"]
        return given | {"pivot": (offset, -depth)}


_Shoe = section_of(Shoe, base=ShoeInput)
_SHOE = fields_of(Shoe, leave_out=("drum_radius", "pressure_zero", "pressure_law"))
_DIFFERENCES: dict[str, Any] = {key: (annotation | None, None) for key, (annotation, _) in _SHOE.items()}

if TYPE_CHECKING:
    _ShoeInput = ShoeInput
    _SecondShoeInput = Section
else:
    _ShoeInput = _Shoe
    _SecondShoeInput = create_model("SecondShoeInput", __base__=Section, **_DIFFERENCES)


class DrumBrakeInput(RubbingInput):
    """Table [brake] of a file: which shoes lead, direction of rotation, and friction of the linings."""

    assembly: Annotated[
        Literal["simplex", "duplex", "single"],
        Field(
            description="simplex: one shoe leads, one trails; duplex: both lead forward; "
            "single: one shoe, which leads forward"
        ),
    ]


class DrumInput(CoreSection):
    """File of a drum brake: [brake], [shoe], [load], [heat]; [second_shoe] if the shoes differ."""

    brake: DrumBrakeInput
    shoe: _ShoeInput
    second_shoe: _SecondShoeInput | None = None
    load: LoadInput
    heat: HeatInput | None = None

    @cached_property
    def core(self) -> DrumBrake:
        """The brake with the shoes of the file."""
        given = {key: value for key, value in self.second_shoe or () if value is not None}
        try:  # inputs that [second_shoe] leaves out are those of the first shoe
            second = _Shoe.model_construct(**dict(self.shoe) | given).core if self.second_shoe else None
        except InvalidValue as error:
            between = ": " if " " in error.field else "."  # a phrase is no key of the file
            raise replace(error, field=f"second_shoe{between}{error.field}") from None
        if self.brake.assembly == "single":
            if self.second_shoe is not None:
                raise ValueError('second_shoe does not go with assembly = "single"; leave it out')
            return DrumBrake((self.shoe.core,), (True,))
        return (simplex if self.brake.assembly == "simplex" else duplex)(self.shoe.core, second)

    def solve(self) -> BrakeResult:
        """Compute the forces in the brake.

        Raises
        ------
        ValueError
            As for `brakes.drum.brake_torque`.
        """
        reverse = self.brake.direction == "reverse"
        with in_range(self), of_file(_Shoe.key_of):
            return brake_torque(self.core, friction=self.brake.friction, **self.load.given, reverse=reverse)
