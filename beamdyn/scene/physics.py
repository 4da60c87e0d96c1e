"""What a model includes beyond the slender beam that bends in one plane."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from beamdyn.common.inputs.checks import InvalidValue, count, flag, one_of, set_fields
from beamdyn.common.inputs.described import Described


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
    plate : bool
        Torsion and camber of a thin rectangular section (Kirchhoff plate), which a clamped root hinders.
    stretch : bool
        Axial stretch and its Coriolis coupling with bending (Yoo and Shin), for comparison.
    large_deflection : bool
        Slopes of any size (the inextensible elastica): the beam vibrates about the equilibrium to which
        rotation bends it.  It bends in the plane of rotation or out of it, and with rotary inertia alone of
        the other effects.
    branch : {"straight", "bent"}
        With large deflection, the equilibria that are meant: those that follow from rest as the speed rises,
        or those that stand beside them at high speed, bent to the other side.

    Raises
    ------
    ValueError
        If `planes` is neither 1 nor 2, another value is no truth value, or large deflection cannot be
        combined with another effect.

    References
    ----------
    Yoo and Shin (1998), stretch; Timoshenko (1921), shear, with tension after Engesser; others: own
    derivation: docs/conventions.md.

    Examples
    --------
    >>> wire = bd.Beam.rectangular(0.05, 0.0004, 0.0002, 200e9, 7850.0)
    >>> both = bd.Scene(wire, physics=bd.Physics(planes=2))
    >>> bd.natural_modes(both, modes=4).plane_share[:, 0].round(3)  # 1: along the thickness, 0: across
    array([1., 0., 1., 0.])
    """

    planes: Annotated[
        Literal[1, 2], Described(meaning="directions of bending: that of the bending angle, or both")
    ] = 1
    shear: Annotated[bool, Described(meaning="shear deformation")] = False
    rotary_inertia: Annotated[bool, Described(meaning="rotary inertia of the sections")] = False
    plate: Annotated[bool, Described(meaning="torsion and camber of a thin rectangular section")] = False
    stretch: Annotated[bool, Described(meaning="stretch of the beam and its Coriolis coupling")] = False

    large_deflection: Annotated[bool, Described(meaning="slopes of any size: the elastica")] = False
    branch: Annotated[
        Literal["straight", "bent"],
        Described(meaning="equilibria of large deflection: those reached from rest, or those beside them"),
    ] = "straight"

    def __post_init__(self) -> None:
        set_fields(self, planes=count("physics.planes", self.planes, most=2))
        for name in ("shear", "rotary_inertia", "plate", "stretch", "large_deflection"):
            set_fields(self, **{name: flag(f"physics.{name}", getattr(self, name))})
        one_of("physics.branch", self.branch, ("straight", "bent"))
        if self.large_deflection:
            self._check_combination()

    def _check_combination(self) -> None:
        """Refuse what the elastica is not combined with."""
        for name, plain in (("planes", 1), ("shear", False), ("plate", False), ("stretch", False)):
            if (given := getattr(self, name)) != plain:
                bound = "it cannot be combined with large_deflection"
                raise InvalidValue(f"physics.{name}", given, bound, "leave one of the two out")


@dataclass(frozen=True, repr=False)
class AutomaticPhysics(Physics):
    """Physics that each analysis chooses; what does not choose reads it as the plain beam."""

    def __repr__(self) -> str:
        return repr(AUTO_NAME)


AUTO_NAME = "auto"
AUTO = AutomaticPhysics()
