"""Objects at a point of the beam: a body and a load at the tip, point masses, point springs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Annotated, Final, Literal, get_args

from beamdyn.common.inputs import checks
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.snapshots import ADDED_LATER

Direction = Literal["bending", "across"]
ALONG_BENDING: Final = "bending"
ACROSS: Final = "across"


def direction_of(direction: str) -> int:
    """Convert "bending" (direction of the bending angle) to the index 0, and "across" to 1."""
    return 1 if direction == ACROSS else 0


# Objects at a point of the beam ---------------------------------------------------------------------


@dataclass(frozen=True)
class TipMass:
    """A rigid body at the tip of the beam.

    Parameters
    ----------
    mass : float
        Mass [kg].
    offset : float
        Distance of the centre of gravity beyond the end of the beam [m]; negative is inboard.
    inertia : float
        Moment of inertia about the axis of bending through the centre of gravity [kg m2].
    transverse_inertia : float, optional
        Moment of inertia about the direction in which the beam bends [kg m2]; `inertia` if not given,
        as for a body slender along the beam.
    axial_inertia : float
        Moment of inertia about the direction of the beam axis, through the centre of gravity [kg m2].
    offset_across : float
        Distance of the centre of gravity from the beam axis, in the second direction of the section at the
        tip [m]; a beam with it needs a stiffness against torsion.

    Raises
    ------
    ValueError
        If a value is not finite, the mass or an inertia is negative, or one moment of inertia exceeds the
        sum of the other two.

    References
    ----------
    Standard: a rigid body; own derivation: docs/conventions.md, section Equations.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, tip=bd.TipMass(mass=0.004))
    >>> round(float(bd.natural_modes(bd.Scene(strip), modes=1).frequency[0]), 3)  # Hz
    13.917
    """

    mass: Annotated[float, Described("kg", "m_t", "mass", least=0)]
    offset: Annotated[
        float, Described("m", "e", "distance of its centre of gravity beyond the end of the beam")
    ] = 0.0
    inertia: Annotated[
        float, Described("kg m2", "J_n", "moment of inertia about the axis of bending", least=0)
    ] = 0.0
    transverse_inertia: Annotated[
        float | None,
        Described("kg m2", "J_e", "moment of inertia about the bending direction, default: inertia", least=0),
    ] = None
    axial_inertia: Annotated[
        float, Described("kg m2", "J_1", "moment of inertia about the beam axis", least=0)
    ] = 0.0
    offset_across: Annotated[
        float,
        Described(
            "m", "e_2", "distance of its centre of gravity from the axis, across the direction of bending"
        ),
    ] = field(default=0.0, metadata=ADDED_LATER)

    def __post_init__(self) -> None:
        mass, offset = checks.amount("tip.mass", self.mass, "kg"), checks.real("tip.offset", self.offset, "m")
        checks.set_fields(self, mass=mass, offset=offset)
        checks.set_fields(self, offset_across=checks.real("tip.offset_across", self.offset_across, "m"))
        required = ("inertia", "axial_inertia")
        given = () if self.transverse_inertia is None else ("transverse_inertia",)
        for name in (*required, *given):
            checks.set_fields(self, **{name: checks.amount(f"tip.{name}", getattr(self, name), "kg m2")})
        # Refuse a moment of inertia beyond the sum of the other two, which no rigid body has.
        moments = {
            "inertia": self.inertia,
            "transverse_inertia": self.inertia_about_bending_direction,
            "axial_inertia": self.axial_inertia,
        }
        largest = max(moments, key=lambda name: moments[name])
        value = moments.pop(largest)
        bound = f"in a rigid body it is at most the sum of the other two, {' + '.join(moments)} = {{limit}}"
        total = sum(moments.values())
        bad = value > total * (1 + 1e-12)
        checks.refuse(bad, f"tip.{largest}", value, "kg m2", bound, "check all three", limit=total)

    @property
    def inertia_about_bending_direction(self) -> float:
        """Moment of inertia about the direction of bending [kg m2]: `transverse_inertia` or its default."""
        return self.inertia if self.transverse_inertia is None else self.transverse_inertia

    def about(self, across: float) -> TipMass:
        """Return the body with inertias about an axis shifted by `across` [m], in the second direction."""
        if self.offset_across == across:
            return self
        more = self.mass * (self.offset_across - across) ** 2
        of_bending = self.inertia_about_bending_direction + more
        return replace(self, transverse_inertia=of_bending, axial_inertia=self.axial_inertia + more)


@dataclass(frozen=True)
class PointMass:
    """A mass at a point of the beam, on its axis: without moments of inertia of its own.

    Parameters
    ----------
    position : float
        Distance from the root along the beam [m], above 0 and at most the length: a mass at the tip counts
        as a `TipMass` without offset and inertia.
    mass : float
        Mass [kg].

    Raises
    ------
    ValueError
        If a value is not finite, the position is not positive, or the mass is negative.

    Examples
    --------
    >>> magnet = bd.PointMass(position=0.03, mass=0.001)
    >>> beam = bd.Beam.from_stiffness(0.05, 0.0157, 1.33e-3, point_masses=[magnet])
    >>> beam.point_masses[0].mass
    0.001
    """

    position: Annotated[
        float, Described("m", "x_k", "distance from the root along the beam, at most its length", above=0)
    ]
    mass: Annotated[float, Described("kg", "m_k", "mass", least=0)]

    def __post_init__(self) -> None:
        remedy = "it is the distance from the root, where a mass would not move"
        position = checks.positive("point_mass.position", self.position, "m", remedy)
        checks.set_fields(self, position=position, mass=checks.amount("point_mass.mass", self.mass, "kg"))


@dataclass(frozen=True)
class PointSpring:
    """A spring that holds a point of the beam to the carrier, with which it turns.

    Parameters
    ----------
    position : float
        Distance from the root along the beam [m], above 0 and at most the length.
    stiffness : float
        Force per deflection [N/m], up to 1e9 times EI/L^3 of the beam.
    direction : {"bending", "across"}
        "bending": the direction of the bending angle; "across": perpendicular to it, where a second plane is
        modelled.

    Raises
    ------
    ValueError
        If a value is not finite, the position is not positive, the stiffness is negative, or the direction
        is unknown.

    Examples
    --------
    >>> stop = bd.PointSpring(position=0.05, stiffness=100.0)
    >>> beam = bd.Beam.from_stiffness(0.05, 0.0157, 1.33e-3, point_springs=[stop])
    >>> beam.point_springs[0].stiffness  # N/m
    100.0
    """

    position: Annotated[
        float, Described("m", "x_k", "distance from the root along the beam, at most its length", above=0)
    ]
    stiffness: Annotated[float, Described("N/m", "k_k", "force per deflection", least=0)]
    direction: Annotated[Direction, Described(meaning="direction of the deflection that it resists")] = (
        ALONG_BENDING
    )

    def __post_init__(self) -> None:
        checks.one_of("point_spring.direction", self.direction, get_args(Direction))
        remedy = "it is the distance from the root, where a spring would not be deflected"
        position = checks.positive("point_spring.position", self.position, "m", remedy)
        stiffness = checks.amount("point_spring.stiffness", self.stiffness, "N/m")
        checks.set_fields(self, position=position, stiffness=stiffness)


_NOTHING = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class TipLoad:
    """A constant force and a moment at the end of the beam, dead or following the tip.

    Parameters
    ----------
    force : sequence of 3 floats
        Force [N] along b1, b2, b3: along the beam at its root, perpendicular to it in the plane of
        rotation, and along the axis of rotation.
    moment : sequence of 3 floats
        Moment about b1, b2, b3 [N m].
    follows : bool
        Whether the load turns with the section at the tip, from the directions that it has on the unloaded
        beam; else it turns with the carrier alone (a dead load).

    Raises
    ------
    ValueError
        If a value is not finite, or a force or moment has other than three components.

    References
    ----------
    Beck (1952), Zeitschrift fuer angewandte Mathematik und Physik 3, 225-228: a load that follows the tip.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> bent = bd.Physics(large_deflection=True)
    >>> scene = bd.Scene(strip, physics=bent, tip_load=bd.TipLoad(force=(0.0, 1.0, 0.0)))
    >>> bd.equilibrium(scene, speed=0.0).tip[:2].round(5)  # m, along the beam and across
    array([0.04262, 0.02375])
    """

    force: Sequence[
        Annotated[float, Described("N", "F", "force at the tip along b1, b2, b3, for large deflection")]
    ] = _NOTHING
    moment: Sequence[Annotated[float, Described("N m", "M", "moment at the tip about b1, b2, b3")]] = _NOTHING
    follows: Annotated[bool, Described(meaning="whether the load turns with the section at the tip")] = False

    def __post_init__(self) -> None:
        for name, unit in (("force", "N"), ("moment", "N m")):
            of, given = f"tip_load.{name}", checks.real_array(f"tip_load.{name}", getattr(self, name))
            if len(given) != 3:
                raise checks.InvalidValue(
                    of, getattr(self, name), "give its three components along b1, b2, b3"
                )
            checks.set_fields(
                self,
                **{name: tuple(checks.moderate(f"{of}[{k}]", each, unit) for k, each in enumerate(given))},
            )
        checks.flag("tip_load.follows", self.follows)

    @property
    def acts(self) -> bool:
        """Whether the load is not zero."""
        return any((*self.force, *self.moment))


NO_LOAD = TipLoad()
