"""The beam: its length, its properties along it, point masses, and a rigid body at its tip."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, kind, positive, refuse, set_fields, several, size
from beamdyn.common.results.one_line import OneLine, counted, number, spanned
from beamdyn.common.results.read_only import FieldsOnly
from beamdyn.common.results.snapshots import ADDED_LATER
from beamdyn.scene.doubts import warn_of_material, warn_of_stiffness, warn_of_twist
from beamdyn.scene.harvester import Electrodes
from beamdyn.scene.names_elsewhere import GIVE_IT, GIVE_OR_COMPUTE
from beamdyn.scene.points import PointMass, PointSpring, TipMass, direction_of
from beamdyn.scene.profile import Profile, Property, as_profile, check_positive, merge_breakpoints, to_profile
from beamdyn.scene.rectangle import Rectangle
from beamdyn.scene.section_matrices import SectionMatrices

_ROUNDING = 1e-12  # rounding of a position over the length: the distance at which breakpoints merge
_TURNS_BACK = np.pi / 2  # kink [rad] of the axis by which it runs back
_GIVE_RADIANS = "is it in degrees? give math.radians(...)"
_STRAIGHT = 1e-9  # twist [rad] below which a beam is not twisted: it changes nothing by more than 1e-18


@dataclass(frozen=True)
class Beam(FieldsOnly, OneLine):
    """A beam, held at its root: straight, or curved by its sweep and prebend.

    Build it by `rectangular`, `from_stiffness` or `from_matrices`.

    Which of its properties a model reads is said by `Physics`.

    Parameters
    ----------
    length : float
        Length L [m].
    mass_per_length : Profile
        Mass per length rho A [kg/m] over x/L.
    bending_stiffness : Profile
        Bending stiffness E I [N m2] over x/L.
    axial_stiffness : Profile, optional
        Axial stiffness E A [N] over x/L: needed for the stretch and for axial strain.
    outer_fibre : Profile, optional
        Distance of the outer fibre from the neutral axis [m] over x/L: needed for bending strain.
    tip : TipMass, optional
        Rigid body at the tip.
    second_bending_stiffness : Profile, optional
        Bending stiffness in the direction of the section across [N m2]; it may be the smaller of the two.
    twist : Profile, optional
        Angle by which the section is turned about the beam [rad] over x/L, added to the bending angle.
    shear_stiffness, second_shear_stiffness : Profile, optional
        Shear stiffness kappa G A [N] over x/L, for bending in either direction of the section.
    rotary_inertia, second_rotary_inertia : Profile, optional
        Rotary inertia of the section per length, rho I [kg m] over x/L, for bending in either direction,
        about the centre of mass.
    point_masses : sequence of PointMass
        Point masses along the beam; those at one place add up.
    point_springs : sequence of PointSpring
        Springs that hold points of the beam to the carrier; those at one place add up.
    section : rectangle, optional
        The rectangular section that the properties follow from, by `rectangular`; None where they do not.
        Its `width`, `thickness`, `youngs_modulus`, `density` and `poissons_ratio` are as given there.
    torsion_stiffness, warping_stiffness : Profile, optional
        Stiffness against torsion G J [N m2], and against warping E Cw [N m4], over x/L; those of a
        rectangular section follow from its sides.
    sweep, prebend : Profile, optional
        Angles by which the axis of the unloaded beam leaves its direction at the root [rad] over x/L, x along
        the axis: it points along (cos a cos b, cos a sin b, sin a), in the axes along the beam at its root,
        in the direction of bending and across, with the sweep a and the prebend b.
    mass_offset, tension_offset : Profile, optional
        Distance of the sections' centre of mass, and of their centre of tension, from their shear centre in
        the direction across [m], of either sign, over x/L.  The shear centres are the axis of the beam.
    matrices : SectionMatrices, optional
        The 6 x 6 matrices of stiffness and mass that the properties follow from, by `from_matrices`; None
        where they do not.  The properties are then entries of their diagonals.
    electrodes : electrodes, optional
        Those of piezoelectric layers, which `Harvester.on` puts on a beam with their mass and stiffness.

    References
    ----------
    Standard: Euler and Bernoulli; shear of rectangles by Cowper (1966), Journal of Applied Mechanics 33, 335.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(
    ...     length=0.05, width=0.01, thickness=0.0002, youngs_modulus=200e9, density=7850.0
    ... )
    >>> f"{strip.bending_stiffness(0.5):.3e} N m2"
    '1.333e-03 N m2'
    """

    length: float
    mass_per_length: Profile
    bending_stiffness: Profile
    axial_stiffness: Profile | None = None
    outer_fibre: Profile | None = None
    tip: TipMass | None = None
    second_bending_stiffness: Profile | None = None
    twist: Profile | None = None
    shear_stiffness: Profile | None = None
    second_shear_stiffness: Profile | None = None
    rotary_inertia: Profile | None = None
    second_rotary_inertia: Profile | None = None
    point_masses: Sequence[PointMass] = ()
    point_springs: Sequence[PointSpring] = ()
    section: Rectangle | None = field(default=None, repr=False, compare=False)
    torsion_stiffness: Profile | None = field(default=None, metadata=ADDED_LATER)
    warping_stiffness: Profile | None = field(default=None, metadata=ADDED_LATER)
    sweep: Profile | None = field(default=None, metadata=ADDED_LATER)
    prebend: Profile | None = field(default=None, metadata=ADDED_LATER)
    mass_offset: Profile | None = field(default=None, metadata=ADDED_LATER)
    tension_offset: Profile | None = field(default=None, metadata=ADDED_LATER)
    matrices: SectionMatrices | None = field(default=None, repr=False, metadata=ADDED_LATER)
    electrodes: Electrodes | None = field(default=None, repr=False, metadata=ADDED_LATER)

    def __post_init__(self) -> None:
        set_fields(self, length=positive("length", self.length, "m"))
        given = (name for name in OPTIONAL_PROPERTIES if getattr(self, name) is not None)
        for name in (*_REQUIRED, *given):
            kind(name, getattr(self, name), Profile, "Beam.from_stiffness makes one")
            if name not in OF_ANY_SIGN:
                check_positive(name, getattr(self, name))
        if self.twist is not None and self.second_bending_stiffness is None:
            bound, other = "it turns two directions of bending, and needs {other}", "second_bending_stiffness"
            said: dict[str, Any] = {"other": other, "where": " at the tip"}
            raise InvalidValue("twist", self.tip_twist, bound, GIVE_OR_COMPUTE, "rad", **said)
        if self.warping_stiffness is not None and self.torsion_stiffness is None:
            bound, remedy = "warping needs {other} as well", "give both, or neither"
            value = float(self.warping_stiffness(np.zeros(1))[0])
            raise InvalidValue(
                "warping_stiffness",
                value,
                bound,
                remedy,
                "N m4",
                other="torsion_stiffness",
                where=" at the root",
            )
        if self.tip is not None:
            kind("tip", self.tip, TipMass, "TipMass(mass) makes one")
        self._check_offsets()
        if self.tip is not None and self.length + self.tip.offset < 0:
            bound, remedy = "it puts the body behind the root", "give an offset above {limit}"
            raise InvalidValue("tip.offset", self.tip.offset, bound, remedy, "m", -self.length)
        for name, wanted in (("point_masses", PointMass), ("point_springs", PointSpring)):
            set_fields(self, **{name: _check_points(name, getattr(self, name), wanted, self.length)})
        if self.electrodes is not None:
            kind("electrodes", self.electrodes, Electrodes, "Harvester.on puts them on a beam")
        if self.section is not None:
            kind("section", self.section, Rectangle, "Beam.rectangular makes one")
            if not all(_alike(getattr(self, name), made) for name, made in self.section.properties.items()):
                set_fields(self, section=None)  # a property was replaced
        if self.has_offsets:  # a rectangle has its centres in one point
            set_fields(self, section=None)
        self._check_matrices()
        self._check_axis()

    def _check_matrices(self) -> None:
        """Refuse properties other than those of the 6 x 6 matrices that the sections have."""
        if self.matrices is None:
            return
        kind("matrices", self.matrices, SectionMatrices, "SectionMatrices.at_stations makes them")
        made = self.matrices.properties
        for name in (*_REQUIRED, *OPTIONAL_PROPERTIES):
            said = name in PROPERTY_UNITS and name != "outer_fibre"
            if said and not _alike(getattr(self, name), made.get(name)):
                bound = "the 6 x 6 matrices of the sections say it"
                raise InvalidValue(name, "another", bound, "change the matrices")

    def _check_axis(self) -> None:
        """Refuse an axis that turns back on itself at a kink."""
        for name in ("sweep", "prebend"):
            angle = getattr(self, name)
            if angle is None:
                continue
            left, right = angle.end_values()
            turned = np.abs(left - np.append(0.0, right[:-1]))
            if turned.max() >= _TURNS_BACK:
                k = int(turned.argmax())
                where = f" turns by {turned[k]:.4g} rad at x/L = {angle.breakpoints[k]:.4g}"
                bound = "the axis turns back on itself: a kink must be below {limit}"
                raise InvalidValue(
                    name, float(left[k]), bound, _GIVE_RADIANS, "rad", _TURNS_BACK, where=where
                )

    def _check_offsets(self) -> None:
        """Refuse offsets of a beam that lacks the stiffness against the torsion that they cause."""
        if self.torsion_stiffness is not None:
            return
        bound = "forces beside the shear centre twist the beam, which needs {other}"
        said: dict[str, Any] = {"other": "torsion_stiffness"}
        for name in OFFSETS:
            if (given := getattr(self, name)) is not None and (place := _first_place(given)) is not None:
                value, where = float(given(np.array(place))), f" at x/L = {place:.3f}"
                raise InvalidValue(name, value, bound, GIVE_IT, "m", where=where, **said)
        if self.tip is not None and self.tip.offset_across:
            raise InvalidValue("tip.offset_across", self.tip.offset_across, bound, GIVE_IT, "m", **said)

    @cached_property
    def has_offsets(self) -> bool:
        """Whether a centre of mass or of tension lies beside the axis, of the sections or of the tip body."""
        given = (getattr(self, name) for name in OFFSETS)
        beside = any(each is not None and _first_place(each) is not None for each in given)
        return beside or bool(self.tip and self.tip.offset_across)

    def with_section(self, section: Rectangle) -> Beam:
        """The beam with another rectangular section, and the properties that follow from it."""
        section.check_thickness(self.length)
        warn_of_material(section.youngs_modulus, section.density)
        return replace(self, section=section, **section.properties)

    @classmethod
    def rectangular(
        cls,
        length: float,
        width: Property,
        thickness: Property,
        youngs_modulus: float,
        density: float,
        tip: TipMass | None = None,
        breakpoints: Sequence[float] = (),
        twist: Property | None = None,
        poissons_ratio: float | None = None,
        point_masses: Sequence[PointMass] = (),
        point_springs: Sequence[PointSpring] = (),
        sweep: Property | None = None,
        prebend: Property | None = None,
    ) -> Beam:
        """Build a beam of rectangular section that bends in the direction of its thickness.

        The second direction of bending is that of its width.

        Parameters
        ----------
        length : float
            Length [m].
        width, thickness : float, Polynomial, Table or callable
            Sides of the section [m]; those that vary are functions of the fraction x/L.
        youngs_modulus : float
            Young's modulus [Pa].
        density : float
            Density [kg/m3].
        tip : TipMass, optional
            Rigid body at the tip.
        breakpoints : sequence of float
            Fractions x/L where the section jumps or has a kink.  A callable is sampled at intervals of
            2.5e-5: what is narrower is seen only between breakpoints, or in a Table.
        twist : float, Polynomial, Table or callable, optional
            Angle by which the section is turned [rad], added to the bending angle of the mount.
        poissons_ratio : float, optional
            Poisson's ratio, above -1 and at most 0.5; without it there is no shear stiffness.  That is
            kappa G A with kappa = 10 (1 + nu) / (12 + 11 nu): Cowper (1966), Journal of Applied Mechanics 33,
            335-340.
        point_masses : sequence of PointMass
            Point masses along the beam; those at one place add up.
        point_springs : sequence of PointSpring
            Springs that hold points of the beam to the carrier; those at one place add up.
        sweep, prebend : float, Polynomial, Table or callable, optional
            Angles by which the axis leaves its direction at the root [rad], over the fraction x/L of its
            length: towards the direction across, and in the plane of bending.  A jump is a kink of the axis.

        Returns
        -------
        Beam

        Raises
        ------
        ValueError
            If a dimension is not positive and finite, or the thickness exceeds the width or the length.

        Warns
        -----
        UserWarning
            If waves along the beam would run at less than 100 or more than 20 000 m/s: a mistake of units;
            or if the twist seems to be in degrees: beyond one turn, or half a turn with at most two decimals.
        """
        length = size("length", length, "m")
        b, h = to_profile("width", width, breakpoints), to_profile("thickness", thickness, breakpoints)
        section = Rectangle(b, h, youngs_modulus, density, poissons_ratio)
        section.check_thickness(length)
        warn_of_material(section.youngs_modulus, section.density)
        angles = {"twist": twist, "sweep": sweep, "prebend": prebend}
        turned = {n: to_profile(n, a, breakpoints) for n, a in angles.items() if a is not None}
        warn_of_twist(turned.get("twist"))
        return cls(
            length=length,
            tip=tip,
            point_masses=point_masses,
            point_springs=point_springs,
            section=section,
            **turned,
            **section.properties,
        )

    @classmethod
    def from_stiffness(
        cls,
        length: float,
        mass_per_length: Property,
        bending_stiffness: Property,
        axial_stiffness: Property | None = None,
        outer_fibre: Property | None = None,
        tip: TipMass | None = None,
        breakpoints: Sequence[float] = (),
        second_bending_stiffness: Property | None = None,
        twist: Property | None = None,
        shear_stiffness: Property | None = None,
        second_shear_stiffness: Property | None = None,
        rotary_inertia: Property | None = None,
        second_rotary_inertia: Property | None = None,
        point_masses: Sequence[PointMass] = (),
        point_springs: Sequence[PointSpring] = (),
        torsion_stiffness: Property | None = None,
        warping_stiffness: Property | None = None,
        sweep: Property | None = None,
        prebend: Property | None = None,
        mass_offset: Property | None = None,
        tension_offset: Property | None = None,
    ) -> Beam:
        """Build a beam of any section from its stiffness and mass.

        Parameters
        ----------
        length : float
            Length [m].
        mass_per_length : float, Polynomial, Table or callable
            Mass per length [kg/m]; those that vary are functions of the fraction x/L.
        bending_stiffness : float, Polynomial, Table or callable
            E I [N m2].
        axial_stiffness : float, Polynomial, Table or callable, optional
            E A [N]; without it there is no stretch and no axial strain.
        outer_fibre : float, Polynomial, Table or callable, optional
            Distance of the outer fibre from the neutral axis [m]; without it there is no bending strain.
        tip : TipMass, optional
            Rigid body at the tip.
        breakpoints : sequence of float
            Fractions x/L where a property jumps or has a kink.  A callable is sampled at intervals of
            2.5e-5: what is narrower is seen only between breakpoints, or in a Table.
        second_bending_stiffness : float, Polynomial, Table or callable, optional
            E I for bending in the direction of the section across [N m2]; without it there is one plane.
        twist : float, Polynomial, Table or callable, optional
            Angle by which the section is turned [rad], added to the bending angle of the mount.
        shear_stiffness, second_shear_stiffness : float, Polynomial, Table or callable, optional
            kappa G A [N] for bending in either direction; without the second it is as the first.
        rotary_inertia, second_rotary_inertia : float, Polynomial, Table or callable, optional
            rho I [kg m], rotary inertia of the section per length for bending in either direction, about the
            centre of mass.
        point_masses : sequence of PointMass
            Point masses along the beam; those at one place add up.
        point_springs : sequence of PointSpring
            Springs that hold points of the beam to the carrier; those at one place add up.
        torsion_stiffness : float, Polynomial, Table or callable, optional
            G J [N m2]; torsion also needs both rotary inertias.
        warping_stiffness : float, Polynomial, Table or callable, optional
            E Cw [N m4], against warping of the section, which the root then holds.
        sweep, prebend : float, Polynomial, Table or callable, optional
            Angles by which the axis leaves its direction at the root [rad], over the fraction x/L of its
            length: towards the direction across, and in the plane of bending.  A jump is a kink of the axis.
        mass_offset, tension_offset : float, Polynomial, Table or callable, optional
            Distance of the centre of mass, and of that of tension, from the shear centre in the direction
            across [m], of either sign; 0 without it.  Torsion reads them, and they need its stiffness.
            Bending stiffnesses are about the centre of tension.

        Returns
        -------
        Beam

        Raises
        ------
        ValueError
            If a property is not positive, finite and smooth between breakpoints.

        Warns
        -----
        UserWarning
            If the properties do not fit together: waves along the beam would run at more than 20 000 m/s, or
            the section's radius of gyration would exceed the outer fibre or the length; or if the twist seems
            to be in degrees: beyond one turn, or half a turn with at most two decimals.
        """
        other = shear_stiffness if second_shear_stiffness is None else second_shear_stiffness
        given: dict[str, Any] = {
            "mass_per_length": mass_per_length,
            "bending_stiffness": bending_stiffness,
            "axial_stiffness": axial_stiffness,
            "outer_fibre": outer_fibre,
            "second_bending_stiffness": second_bending_stiffness,
            "twist": twist,
            "shear_stiffness": shear_stiffness,
            "second_shear_stiffness": other,
            "rotary_inertia": rotary_inertia,
            "second_rotary_inertia": second_rotary_inertia,
            "torsion_stiffness": torsion_stiffness,
            "warping_stiffness": warping_stiffness,
            "sweep": sweep,
            "prebend": prebend,
            "mass_offset": mass_offset,
            "tension_offset": tension_offset,
        }
        length = size("length", length, "m")
        given = {name: value for name, value in given.items() if value is not None or name in _REQUIRED}
        made: dict[str, Any] = {
            name: (to_profile if name in OF_ANY_SIGN else as_profile)(name, value, breakpoints)
            for name, value in given.items()
        }
        beam = cls(length, tip=tip, point_masses=point_masses, point_springs=point_springs, **made)
        bending, axial = beam.bending_stiffness, beam.axial_stiffness
        warn_of_stiffness(length, beam.mass_per_length, bending, axial, beam.outer_fibre)
        warn_of_twist(beam.twist)
        return beam

    @classmethod
    def from_matrices(
        cls,
        length: float,
        matrices: SectionMatrices,
        tip: TipMass | None = None,
        breakpoints: Sequence[float] = (),
        twist: Property | None = None,
        point_masses: Sequence[PointMass] = (),
        point_springs: Sequence[PointSpring] = (),
        sweep: Property | None = None,
        prebend: Property | None = None,
    ) -> Beam:
        """Build a beam of sections with 6 x 6 matrices of stiffness and mass, which may couple all strains.

        Parameters
        ----------
        length : float
            Length of the axis [m].
        matrices : SectionMatrices
            The matrices, in the axes of the sections.
        tip : TipMass, optional
            Rigid body at the tip.
        breakpoints : sequence of float
            Fractions x/L where an angle jumps or has a kink.
        twist : float, Polynomial, Table or callable, optional
            Angle by which the sections are turned [rad] over x/L, added to the bending angle of the mount.
        point_masses : sequence of PointMass
            Point masses along the beam; those at one place add up.
        point_springs : sequence of PointSpring
            Springs that hold points of the beam to the carrier; those at one place add up.
        sweep, prebend : float, Polynomial, Table or callable, optional
            Angles by which the axis leaves its direction at the root [rad], over the fraction x/L of its
            length: towards the direction across, and in the plane of bending.  A jump is a kink of the axis.

        Returns
        -------
        Beam

        Raises
        ------
        ValueError
            If the axis turns back on itself, or an angle is not smooth between breakpoints.

        Warns
        -----
        UserWarning
            If the twist seems to be in degrees: beyond one turn, or half a turn with at most two decimals.
        """
        kind("matrices", matrices, SectionMatrices, "SectionMatrices.at_stations makes them")
        angles = {"twist": twist, "sweep": sweep, "prebend": prebend}
        given = {name: angle for name, angle in angles.items() if angle is not None}
        made: dict[str, Any] = {name: to_profile(name, angle, breakpoints) for name, angle in given.items()}
        warn_of_twist(made.get("twist"))
        made |= matrices.properties | {"length": size("length", length, "m"), "matrices": matrices}
        return cls(tip=tip, point_masses=point_masses, point_springs=point_springs, **made)

    def headline(self) -> Iterator[str]:
        """Length, mass per length and bending stiffness from root to tip, and the bodies on the beam."""
        yield number(self.length, "m")
        for name, unit, letters in (("mass_per_length", "kg/m", ""), ("bending_stiffness", "N m2", "EI ")):
            yield letters + spanned(getattr(self, name)(np.linspace(0, 1, 11)), unit)
        yield f"twist to {number(np.degrees(self.tip_twist), 'deg')}" if self.twist is not None else ""
        yield "curved axis" if self.is_curved else ""
        yield f"tip mass {number(self.tip.mass, 'kg')}" if self.tip is not None else ""
        yield counted(len(self.point_masses), "point mass", "point masses") if self.point_masses else ""
        yield counted(len(self.point_springs), "spring") if self.point_springs else ""

    def __hash__(self) -> int:
        return self._hash

    @cached_property
    def _hash(self) -> int:  # hashed once: it has many properties, and caches ask often
        return hash(tuple(getattr(self, f.name) for f in fields(self) if f.compare))

    @cached_property
    def breakpoints(self) -> tuple[float, ...]:
        """Fractions x/L where a property may jump or have a kink, or a mass stands, with the ends 0 and 1."""
        names = (name for name in (*_REQUIRED, *OPTIONAL_PROPERTIES) if name != "outer_fibre")
        profiles = (getattr(self, name) for name in names)
        ends = {b for p in profiles if p is not None for b in p.breakpoints}
        return merge_breakpoints(np.concatenate([[*ends], self.points]))

    @cached_property
    def lumps(self) -> tuple[np.ndarray, np.ndarray]:
        """Positions x/L (k,) of the point masses that are not 0, and the masses (k,) [kg]."""
        heavy = [(lump.position, lump.mass) for lump in self.point_masses if lump.mass]
        position, mass = np.array(heavy, dtype=float).reshape(-1, 2).T
        return np.minimum(position / self.length, 1.0), mass

    def springs(self, direction: int) -> tuple[np.ndarray, np.ndarray]:
        """Positions x/L (k,) of the point springs in a direction, 0 or 1, and the stiffnesses (k,) [N/m]."""
        if not self.point_springs:
            return np.empty(0), np.empty(0)
        found = [s for s in self.point_springs if s.stiffness and direction_of(s.direction) == direction]
        position, stiffness = np.array([(s.position, s.stiffness) for s in found]).reshape(-1, 2).T
        return np.minimum(position / self.length, 1.0), stiffness

    @property
    def points(self) -> np.ndarray:
        """Positions x/L of point masses and point springs, at which the shear force jumps."""
        return np.concatenate([self.lumps[0], self.springs(0)[0], self.springs(1)[0]])

    @cached_property
    def is_twisted(self) -> bool:
        """Whether a twist is given that turns any section by more than rounding, 1e-9 rad."""
        return self.twist is not None and bool(np.abs(self.twist.series).sum(axis=0).max() > _STRAIGHT)

    @cached_property
    def is_curved(self) -> bool:
        """Whether a sweep or a prebend is given by which the axis is not straight."""
        angles = (angle for angle in (self.sweep, self.prebend) if angle is not None)
        return any(bool(np.abs(angle.series).max() > _STRAIGHT) for angle in angles)

    @property
    def root_twist(self) -> float:
        """Angle by which the section at the root is turned [rad]."""
        return 0.0 if self.twist is None else float(self.twist.end_values()[0][0])

    @cached_property
    def tip_twist(self) -> float:
        """Angle by which the section at the tip is turned [rad]."""
        return 0.0 if self.twist is None else float(self.twist.end_values()[1][-1])

    @property
    def tip_tension_offset(self) -> float:
        """Distance of the centre of tension at the tip from the shear centre, in the direction across [m]."""
        return 0.0 if self.tension_offset is None else float(self.tension_offset.end_values()[1][-1])


def _alike(given: Profile | None, made: Profile | None) -> bool:
    """Whether a property is that of a section, perhaps on more segments."""
    return given == made or (
        given is not None and made is not None and given == made.split(given.breakpoints)
    )


PROPERTY_UNITS = {  # all that varies along a beam, but for its twist
    "mass_per_length": "kg/m",
    "bending_stiffness": "N m2",
    "second_bending_stiffness": "N m2",
    "axial_stiffness": "N",
    "shear_stiffness": "N",
    "second_shear_stiffness": "N",
    "rotary_inertia": "kg m",
    "second_rotary_inertia": "kg m",
    "torsion_stiffness": "N m2",
    "warping_stiffness": "N m4",
    "mass_offset": "m",
    "tension_offset": "m",
    "outer_fibre": "m",
}

ANGLE_UNITS = {"twist": "rad", "sweep": "rad", "prebend": "rad"}  # of what may have any sign
OFFSETS = ("mass_offset", "tension_offset")  # from the shear centre
OF_ANY_SIGN = (*ANGLE_UNITS, *OFFSETS)
_REQUIRED = ("mass_per_length", "bending_stiffness")
OPTIONAL_PROPERTIES = tuple(
    f.name for f in fields(Beam) if f.name in PROPERTY_UNITS | ANGLE_UNITS and f.name not in _REQUIRED
)


def _first_place(profile: Profile) -> float | None:
    """The first place x/L of the ends and middles of segments at which a property is not 0; None if none."""
    ends = np.array(profile.breakpoints)
    left, right = profile.end_values()
    at = np.column_stack([ends[:-1], (ends[:-1] + ends[1:]) / 2, ends[1:]]).ravel()
    values = np.column_stack([left, profile((ends[:-1] + ends[1:]) / 2), right]).ravel()
    return float(at[np.flatnonzero(values)[0]]) if values.any() else None


_MADE = {PointMass: "PointMass(position, mass)", PointSpring: "PointSpring(position, stiffness)"}
_BEYOND = {PointMass: "a body beyond the tip is a TipMass", PointSpring: "hold the tip itself"}


def _check_points(name: str, given: object, wanted: type, length: float) -> tuple[Any, ...]:
    """Point masses or springs as a tuple; refuse what is none, and one beyond the tip."""
    points = several(name, given, wanted, f"{_MADE[wanted]} makes one")
    for k, point in enumerate(points):
        beyond, field = point.position > length * (1 + _ROUNDING), f"{name}[{k}].position"
        bound = "it must be at most {limit}, the length"
        refuse(beyond, field, point.position, "m", bound, _BEYOND[wanted], limit=length)
    return points
