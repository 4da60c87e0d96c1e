"""The beam: length, properties along the beam, point masses, and a rigid body at the tip."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from beamdyn.common.inputs.checks import kind, positive, set_fields, size
from beamdyn.common.results.one_line import OneLine, counted, number, spanned
from beamdyn.common.results.snapshots import ADDED_LATER, FieldsOnly
from beamdyn.scene import input_checks
from beamdyn.scene.harvester import Electrodes
from beamdyn.scene.input_checks import warn_of_material, warn_of_stiffness, warn_of_twist
from beamdyn.scene.points import PointMass, PointSpring, TipMass, direction_of
from beamdyn.scene.profile import Profile, Property, as_profile, check_positive, merge_breakpoints, to_profile
from beamdyn.scene.rectangle import Rectangle
from beamdyn.scene.section_matrices import SectionMatrices

_STRAIGHT = 1e-9  # twist, sweep or prebend [rad] up to which a beam counts as untwisted or straight


@dataclass(frozen=True)
class Beam(FieldsOnly, OneLine):
    """A beam, held at its root: straight, or curved by its sweep and prebend.

    Build it by `rectangular`, `from_stiffness` or `from_matrices`.

    `Physics` determines which of the properties a model uses.

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
        Stiffness for bending in the second direction of the section, perpendicular to the first ("across")
        [N m2]; it may be the smaller of the two.
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
        The rectangular section that the properties were derived from (`rectangular`); else None.
        Its `width`, `thickness`, `youngs_modulus`, `density` and `poissons_ratio` are as given to
        `rectangular`.
    torsion_stiffness, warping_stiffness : Profile, optional
        Stiffness against torsion G J [N m2], and against warping E Cw [N m4], over x/L; those of a
        rectangular section follow from its sides.
    sweep, prebend : Profile, optional
        Angles by which the axis of the unloaded beam leaves its direction at the root [rad] over x/L, x along
        the axis: its direction is (cos a cos b, cos a sin b, sin a) with the sweep a and the prebend b, by
        components along the beam at its root, in the direction of bending, and perpendicular to both.
    mass_offset, tension_offset : Profile, optional
        Distance of the sections' centre of mass, and of their centre of tension, from their shear centre in
        the second direction of the section [m], of either sign, over x/L.  The shear centres lie on the axis
        of the beam.
    matrices : SectionMatrices, optional
        The 6 x 6 matrices of stiffness and mass from which `from_matrices` took the properties; None for
        other beams.
    electrodes : electrodes, optional
        Electrodes of piezoelectric layers, which `Harvester.on` puts on a beam with their mass and stiffness.

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
        if self.tip is not None:
            kind("tip", self.tip, TipMass, "TipMass(mass) makes one")
        input_checks.check_together(self)
        input_checks.check_points(self, "point_masses", PointMass)
        input_checks.check_points(self, "point_springs", PointSpring)
        if self.electrodes is not None:
            kind("electrodes", self.electrodes, Electrodes, "Harvester.on puts them on a beam")
        if self.section is not None:
            kind("section", self.section, Rectangle, "Beam.rectangular makes one")
            made = self.section.properties.items()
            if not all(input_checks.alike(getattr(self, name), profile) for name, profile in made):
                set_fields(self, section=None)  # a property that was replaced does not follow from it
        if self.has_offsets:  # offsets exclude a rectangular section, whose centres coincide
            set_fields(self, section=None)
        along = (name for name in (*_REQUIRED, *OPTIONAL_PROPERTIES) if name != "outer_fibre")
        input_checks.check_matrices(self, [name for name in along if name in PROPERTY_UNITS])
        input_checks.check_axis(self)

    @cached_property
    def has_offsets(self) -> bool:
        """Whether a centre of mass or of tension, of the sections or of the tip body, lies off the axis."""
        given = (getattr(self, name) for name in OFFSETS)
        beside = any(each is not None and input_checks.first_place(each) is not None for each in given)
        return beside or bool(self.tip and self.tip.offset_across)

    @property
    def strip(self) -> Rectangle | None:
        """The rectangular section, with piezoelectric layers if any, for plate models; None without one."""
        return self.section if self.electrodes is None else self.electrodes.laminate

    def with_section(self, section: Rectangle) -> Beam:
        """Return the beam with another rectangular section, and the properties derived from that."""
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
            2.5e-5 in x/L: narrower features need breakpoints at both ends, or a Table.
        twist : float, Polynomial, Table or callable, optional
            Angle by which the section is turned [rad], added to the bending angle of the mount.
        poissons_ratio : float, optional
            Poisson's ratio, above -1 and at most 0.5; needed for the shear stiffness, which is
            kappa G A with kappa = 10 (1 + nu) / (12 + 11 nu): Cowper (1966), Journal of Applied Mechanics 33,
            335-340.
        point_masses : sequence of PointMass
            Point masses along the beam; those at one place add up.
        point_springs : sequence of PointSpring
            Springs that hold points of the beam to the carrier; those at one place add up.
        sweep, prebend : float, Polynomial, Table or callable, optional
            Angles by which the axis leaves its direction at the root [rad], over the fraction x/L of its
            length: the prebend in the plane of bending, the sweep out of it.  A jump is a kink of the axis.

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
        angles = _along({"breakpoints": breakpoints, "twist": twist, "sweep": sweep, "prebend": prebend})
        warn_of_twist(angles.get("twist"))
        made = {**angles, **section.properties, "section": section}
        return cls(length, tip=tip, point_masses=point_masses, point_springs=point_springs, **made)

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
            2.5e-5 in x/L: narrower features need breakpoints at both ends, or a Table.
        second_bending_stiffness : float, Polynomial, Table or callable, optional
            E I for bending in the second direction of the section, perpendicular to the first [N m2]; without
            it the beam bends in one plane only.
        twist : float, Polynomial, Table or callable, optional
            Angle by which the section is turned [rad], added to the bending angle of the mount.
        shear_stiffness, second_shear_stiffness : float, Polynomial, Table or callable, optional
            kappa G A [N] for bending in either direction; the second is equal to the first if not given.
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
            Stiffness E Cw [N m4] against warping of the section, which a clamped root then prevents.
        sweep, prebend : float, Polynomial, Table or callable, optional
            Angles by which the axis leaves its direction at the root [rad], over the fraction x/L of its
            length: the prebend in the plane of bending, the sweep out of it.  A jump is a kink of the axis.
        mass_offset, tension_offset : float, Polynomial, Table or callable, optional
            Distance of the centre of mass, and of the centre of tension, from the shear centre in the second
            direction of the section [m], of either sign; 0 if not given.  They couple bending and torsion,
            and need `torsion_stiffness`.  Bending stiffnesses are about the centre of tension.

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
        given = {**locals()}  # all arguments of this method, by name
        if second_shear_stiffness is None:
            given["second_shear_stiffness"] = shear_stiffness
        length, made = size("length", length, "m"), _along(given)
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
            length: the prebend in the plane of bending, the sweep out of it.  A jump is a kink of the axis.

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
        angles = _along({"breakpoints": breakpoints, "twist": twist, "sweep": sweep, "prebend": prebend})
        warn_of_twist(angles.get("twist"))
        made = {**angles, **matrices.properties, "matrices": matrices, "length": size("length", length, "m")}
        return cls(tip=tip, point_masses=point_masses, point_springs=point_springs, **made)

    def headline(self) -> Iterator[str]:
        """Yield length, mass per length and bending stiffness from root to tip, and bodies, as text."""
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
    def _hash(self) -> int:  # the hash is cached: a beam has many properties, and caches need its hash often
        return hash(tuple(getattr(self, f.name) for f in fields(self) if f.compare))

    @cached_property
    def breakpoints(self) -> tuple[float, ...]:
        """Fractions x/L of jumps and kinks of properties, of point masses and springs, and of both ends."""
        names = (name for name in (*_REQUIRED, *OPTIONAL_PROPERTIES) if name != "outer_fibre")
        profiles = (getattr(self, name) for name in names)
        ends = {b for p in profiles if p is not None for b in p.breakpoints}
        return merge_breakpoints(np.concatenate([[*ends], self.points]))

    @cached_property
    def lumps(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the positions x/L of the nonzero point masses, and the masses [kg]."""
        heavy = [(lump.position, lump.mass) for lump in self.point_masses if lump.mass]
        position, mass = np.array(heavy, dtype=float).reshape(-1, 2).T
        return np.minimum(position / self.length, 1.0), mass

    def springs(self, direction: int) -> tuple[np.ndarray, np.ndarray]:
        """Return x/L and stiffnesses [N/m] of springs in the direction of bending (0) or across it (1)."""
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
        """Whether a twist is given that may turn a section by more than 1e-9 rad."""
        return self.twist is not None and bool(np.abs(self.twist.series).sum(axis=0).max() > _STRAIGHT)

    @cached_property
    def is_curved(self) -> bool:
        """Whether sweep or prebend make the axis of the unloaded beam curved or kinked."""
        angles = (angle for angle in (self.sweep, self.prebend) if angle is not None)
        return any(bool(np.abs(angle.series).max() > _STRAIGHT) for angle in angles)

    @property
    def root_twist(self) -> float:
        """Angle by which the twist turns the section at the root [rad]."""
        return 0.0 if self.twist is None else float(self.twist.end_values()[0][0])

    @cached_property
    def tip_twist(self) -> float:
        """Angle by which the twist turns the section at the tip [rad]."""
        return 0.0 if self.twist is None else float(self.twist.end_values()[1][-1])

    @property
    def tip_tension_offset(self) -> float:
        """Distance from shear to tension centre at the tip, in the section's second direction [m]."""
        return 0.0 if self.tension_offset is None else float(self.tension_offset.end_values()[1][-1])


PROPERTY_UNITS = {  # units of all properties that vary along a beam, except angles
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

# Units of the angles along a beam, which may have any sign.
ANGLE_UNITS = {"twist": "rad", "sweep": "rad", "prebend": "rad"}
OFFSETS = input_checks.OFFSETS
OF_ANY_SIGN = (*ANGLE_UNITS, *OFFSETS)
_REQUIRED = ("mass_per_length", "bending_stiffness")
OPTIONAL_PROPERTIES = tuple(
    f.name for f in fields(Beam) if f.name in PROPERTY_UNITS | ANGLE_UNITS and f.name not in _REQUIRED
)


def _along(given: Mapping[str, Any]) -> dict[str, Any]:
    """Convert the given arguments that vary along a beam to profiles with the beam's breakpoints."""
    return {
        name: (to_profile if name in OF_ANY_SIGN else as_profile)(name, given[name], given["breakpoints"])
        for name in (*_REQUIRED, *OPTIONAL_PROPERTIES)
        if given.get(name) is not None or (name in _REQUIRED and name in given)
    }
