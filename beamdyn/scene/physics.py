"""What a model includes beyond the slender beam that bends in one plane."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from beamdyn.common.checks import count, flag, set_fields
from beamdyn.common.described import Described


@dataclass(frozen=True)
class Physics:
    """Effects that a model includes; what is off costs nothing.

    Parameters
    ----------
    planes : int
        1: the beam bends in the direction of the bending angle only, the other being rigid.  2: it bends in
        both directions of its section, which the twist turns along the beam.
    shear : bool
        Shear deformation (Timoshenko): sections stay plane but need not be normal to the axis.
    rotary_inertia : bool
        Rotary inertia of the sections (Rayleigh).
    stretch : bool
        Axial stretch and its Coriolis coupling with bending (Yoo and Shin), for comparison.

    Raises
    ------
    ValueError
        If `planes` is neither 1 nor 2, or another value is no truth value.
    """

    planes: Annotated[
        Literal[1, 2], Described(meaning="directions of bending: that of the bending angle, or both")
    ] = 1
    shear: Annotated[bool, Described(meaning="shear deformation")] = False
    rotary_inertia: Annotated[bool, Described(meaning="rotary inertia of the sections")] = False
    stretch: Annotated[bool, Described(meaning="stretch of the beam and its Coriolis coupling")] = False

    def __post_init__(self) -> None:
        set_fields(self, planes=count("physics.planes", self.planes, most=2))
        for name in ("shear", "rotary_inertia", "stretch"):
            set_fields(self, **{name: flag(f"physics.{name}", getattr(self, name))})
