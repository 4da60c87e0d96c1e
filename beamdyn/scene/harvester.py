"""Piezoelectric layers on a rectangular beam, and the resistance that their electrodes feed.

The layers are polarised through their thickness and strained along the beam (the 31 mode), with the stress
T = c S - e E and the electric displacement D = e S + eps E of one strain S and one field E, so that

    c = c11E,  e = e31,  eps = eps33S,    or    c = 1/s11E,  e = d31/s11E,  eps = eps33T - d31^2/s11E.

A layer at the distance z from the neutral axis has the strain -z w'', and between electrodes from x1 to x2 a
voltage v bends the beam by a constant moment in between.  Integrated over the section, with M the bending
moment, and q the charge per length:

    M = EI w'' - theta v,    q = theta w'' + C v.

=========  =====================  ==========================
 layers     theta [N m/V]          C [F/m]
=========  =====================  ==========================
 series     e b z                  eps b/(2 t)
 parallel   2 e b z                2 eps b/t
 unimorph   e b (z - z_n)          eps b/t + (e b)^2/(E A)
=========  =====================  ==========================

b is the width, h the thickness of the beam, t that of a layer; z = (h + t)/2 is the distance of the middle of
a layer from the middle of the beam, and z_n the distance of the neutral axis from the middle of the beam,
which is not 0 if only one side has a layer.  As no axial force resists, a voltage on such a layer also
stretches the beam, by the strain e b v/(E A); this adds to the capacitance.  The rows "series" and "parallel"
follow Erturk and Inman (2009), Smart Materials and Structures 18, 025009; "unimorph": own derivation,
docs/harvester.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, Literal, get_args

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, one_of, real, refuse, set_fields
from beamdyn.common.inputs.described import Described, descriptions
from beamdyn.common.results.snapshots import ADDED_LATER, FieldsOnly
from beamdyn.common.words import Words
from beamdyn.scene.names_elsewhere import RECTANGULAR
from beamdyn.scene.profile import ONE, Profile
from beamdyn.scene.rectangle import Coupled, Laminate, Material, Rectangle, composite, couple, laminate

Connection = Literal["series", "parallel", "unimorph"]
_STRAINED, _STRESSED = ("e31", "c11e", "eps33s"), ("d31", "s11e", "eps33t")
_SETS = _STRAINED, _STRESSED
_EVEN = 1e-9  # relative change of width or thickness under the layers below which they count as constant
_SHORT: Any = {"least": 0, "infinite": "open circuit", "remedy": "0 is a short circuit, inf an open one"}


@dataclass(frozen=True)
class Harvester(FieldsOnly):
    """Piezoelectric layers with electrodes over a part of a rectangular beam, and their load.

    The method `on` puts the layers on a beam.

    Parameters
    ----------
    thickness : float
        Thickness t of a layer [m]; its width is that of the beam.
    density : float
        Density of the layers [kg/m3].
    connection : {"series", "parallel", "unimorph"}
        Layers on both sides, connected in series or in parallel, or one layer on one side ("unimorph").
    e31, c11e, eps33s : float, optional
        Piezoelectric stress constant [C/m2], of either sign, modulus at constant field [Pa] and permittivity
        at constant strain [F/m], of a layer that is free across and through its thickness: the reduced
        constants of a beam, d31/s11E, 1/s11E and eps33T - d31^2/s11E.  Entries of a data sheet's stiffness
        matrix differ, because they are for a layer whose strain in both directions is prevented: of PZT-5A
        c11E is twice as large, and e31 half as large.  Near its clamp a wide strip cannot strain across,
        which is modelled if `poissons_ratio` is given.
    d31, s11e, eps33t : float, optional
        In their place the strain constant [m/V], compliance at constant field [1/Pa] and permittivity at
        constant stress [F/m], as data sheets have them.
    start, end : float
        Where layers and electrodes begin and end [m from the root]; an infinite end is the tip.
    resistance : float
        Load resistance R [ohm]: 0 is a short circuit, inf an open one.
    strain_limit : float
        Largest strain that a layer bears; inf where none is known.
    poissons_ratio : float, optional
        Poisson's ratio of the layers, -s12E/s11E; needed to model camber.  A clamp hinders camber, which
        increases stiffness and coupling near the clamp.

    Raises
    ------
    ValueError
        If a value is out of its range, a material is not given by one of the two sets of three constants, or
        has more coupling than its permittivity allows.

    References
    ----------
    Erturk and Inman (2009), Smart Materials and Structures 18, 025009; docs/harvester.md.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> layers = bd.Harvester(0.0002, 7750.0, d31=-171e-12, s11e=1 / 61e9, eps33t=15.33e-9, resistance=1e5)
    >>> short = bd.natural_modes(bd.Scene(layers.on(strip)), modes=1)
    >>> round(float(short.frequency[0]), 2)  # Hz, short-circuited
    113.02
    """

    thickness: Annotated[float, Described("m", "t", "thickness of a layer", above=0)]
    density: Annotated[float, Described("kg/m3", "rho_p", "density of the layers", above=0)]
    connection: Annotated[
        Connection, Described("", "", "layers on both sides in series or parallel, or on one: unimorph")
    ] = "series"
    e31: Annotated[float | None, Described("C/m2", "e31", "piezoelectric stress constant")] = None
    c11e: Annotated[float | None, Described("Pa", "c11E", "modulus at constant field", above=0)] = None
    eps33s: Annotated[
        float | None, Described("F/m", "eps33S", "permittivity at constant strain", above=0)
    ] = None
    d31: Annotated[float | None, Described("m/V", "d31", "piezoelectric strain constant")] = None
    s11e: Annotated[float | None, Described("1/Pa", "s11E", "compliance at constant field", above=0)] = None
    eps33t: Annotated[
        float | None, Described("F/m", "eps33T", "permittivity at constant stress", above=0)
    ] = None
    start: Annotated[float, Described("m", "x1", "where the layers begin", least=0)] = 0.0
    end: Annotated[
        float, Described("m", "x2", "where the layers end; else at the tip", above=0, infinite="the tip")
    ] = math.inf
    resistance: Annotated[float, Described("ohm", "R", "load resistance", **_SHORT)] = 0.0
    strain_limit: Annotated[
        float, Described("", "S_max", "largest strain of a layer", above=0, infinite="none")
    ] = math.inf
    poissons_ratio: Annotated[
        float | None,
        Described("", "nu_p", "Poisson's ratio of the layers, -s12E/s11E, for camber", above=-1, most=0.5),
    ] = None

    def __post_init__(self) -> None:
        one_of("harvester.connection", self.connection, get_args(Connection))
        for name, described in descriptions(Harvester).items():
            given = getattr(self, name)
            is_infinite = bool(described.infinite) and isinstance(given, float) and given == math.inf
            is_left_out = given is None and name in (*_STRAINED, *_STRESSED, "poissons_ratio")
            if not (name == "connection" or is_infinite or is_left_out):
                set_fields(self, **{name: described.check(f"harvester.{name}", given)})
        self._check_material()
        bad, bound = self.start >= self.end, "the layers must begin before their end at {limit}"
        refuse(bad, "harvester.start", self.start, "m", bound, "are the two swapped?", limit=self.end)

    def _check_material(self) -> None:
        """Refuse material constants that are not one complete set of three, or physically impossible."""
        strained, stressed = ([n for n in names if getattr(self, n) is not None] for names in _SETS)
        if (strained, stressed) not in (([*_STRAINED], []), ([], [*_STRESSED])):
            missing = [n for n in (_STRAINED if strained else _STRESSED) if getattr(self, n) is None]
            name = missing[0] if missing else stressed[0]
            bound = "the material is given by e31, c11e and eps33s, or by d31, s11e and eps33t"
            remedy = f"given are {', '.join(strained + stressed) or 'none of them'}"
            raise InvalidValue(f"harvester.{name}", getattr(self, name), bound, remedy)
        material = self.material
        if material.permittivity <= 0:
            bound = "it must be above {limit}, d31^2/s11e: no material has more coupling"
            limit = material.coupling * (self.d31 or 0.0)
            raise InvalidValue("harvester.eps33t", self.eps33t, bound, "check the constants", "F/m", limit)
        nu = self.poissons_ratio
        if nu is not None and material.held_across(nu).permittivity <= 0:
            bound = "without strain in its plane permittivity would be 0 or less: no material couples so much"
            raise InvalidValue("harvester.poissons_ratio", nu, bound, "check the constants")

    @property
    def material(self) -> Material:
        """Constants of the layers' material for strain along the beam and a field through the thickness."""
        if self.e31 is not None and self.c11e is not None and self.eps33s is not None:
            return Material(self.c11e, self.e31, self.eps33s)
        assert self.d31 is not None and self.s11e is not None and self.eps33t is not None, "one set is given"
        return Material(1 / self.s11e, self.d31 / self.s11e, self.eps33t - self.d31**2 / self.s11e)

    def on(self, beam: Any) -> Any:
        """Return a copy of a beam with the layers' mass, stiffness (short-circuited) and electrodes added.

        Raises
        ------
        ValueError
            If `beam` is no `Beam`, has no rectangular section, is twisted, carries layers already, or ends
            before these layers do, or if its section varies under them.
        """
        span, (b, h) = self._span_on(beam), self._sides_on(beam)
        modulus, density = beam.section.youngs_modulus, beam.section.density
        material, t = self.material, self.thickness
        sides = 1 if self.connection == "unimorph" else 2
        elastic = composite(modulus, material.stiffness, h, t, sides)
        heavy = composite(density, self.density, h, t, sides)
        fibre = max(h / 2 + t - elastic.centre, elastic.centre - h / 2)
        of_bare = {
            "mass_per_length": heavy.area - density * h,
            "axial_stiffness": elastic.area - modulus * h,
            "bending_stiffness": elastic.second - modulus * h**3 / 12,
            "rotary_inertia": heavy.second - density * h**3 / 12,
            "second_bending_stiffness": (elastic.area - modulus * h) * b**2 / 12,
            "second_rotary_inertia": (heavy.area - density * h) * b**2 / 12,
            "outer_fibre": (max(fibre, h / 2 + elastic.centre) - h / 2) / b,
        }
        made = {name: _added(getattr(beam, name), span, b * step) for name, step in of_bare.items()}
        free = couple(self.connection, b, t, (h + t) / 2 - elastic.centre, material, elastic.area)
        strip, flat = self._as_plate(beam.section, span, (b, h), elastic.second)
        electrodes = Electrodes(self, beam, span, free.moment, free.capacitance, fibre, strip, flat)
        return replace(beam, **made, electrodes=electrodes)

    def _as_plate(
        self, bare: Rectangle, span: tuple[float, float], sides: tuple[float, float], stiffness: float
    ) -> tuple[Laminate, Coupled | None]:
        """Return the strip with layers as a plate, and the electrodes' constants for flat cross-sections.

        The constants are the bending moment per voltage and the capacitance per length of a strip whose
        cross-sections cannot curve.  If Poisson's ratio of the strip or of the layers is not known, the plate
        has none, and None replaces the constants.  `span` is that of the layers in x/L, `sides` are the width
        and thickness of the bare strip [m], `stiffness` is the bending stiffness per width of the beam with
        layers [N m].
        """
        (b, h), t, nu = sides, self.thickness, self.poissons_ratio
        count = 1 if self.connection == "unimorph" else 2
        known = None if nu is None else bare.poissons_ratio
        thicker = _added(bare.thickness, span, count * t)
        strip = Laminate(bare.width, thicker, bare.youngs_modulus, bare.density, known)
        if nu is None or known is None:
            return strip, None
        ratio, stiffer, both = laminate(bare, self.material, nu, (h, t, count), stiffness)
        along, free = _added(bare.ratio, span, ratio - known), _added(ONE, span, stiffer - 1)
        across, arm = self.material.held_across(nu), (h + t) / 2 - both.centre
        flat = couple(self.connection, b, t, arm, across, both.area / 2)
        return replace(strip, along=along, free=free), flat

    def _span_on(self, beam: Any) -> tuple[float, float]:
        """Find where the layers begin and end, as x/L; refuse a beam that cannot carry them."""
        if not hasattr(beam, "electrodes"):
            raise InvalidValue("beam", beam, "layers stand on a Beam", Words(RECTANGULAR, " makes one"))
        if beam.electrodes is not None:
            bound = "the beam carries layers already, which these would overlap"
            raise InvalidValue("harvester.start", self.start, bound, "put one set on the bare beam", "m")
        if beam.section is None or beam.section.factors:
            bound = "they need a beam with the properties of its rectangular section"
            raise InvalidValue("harvester", "layers", bound, Words(RECTANGULAR, " makes one"))
        if beam.is_twisted:
            raise InvalidValue("twist", beam.tip_twist, "a twisted beam carries no layers", "omit one", "rad")
        end, bound = beam.length if math.isinf(self.end) else self.end, "the beam ends at {limit}"
        beyond = real("harvester.end", end) > beam.length * (1 + _EVEN)
        refuse(beyond, "harvester.end", end, "m", bound, "end the layers on it", limit=beam.length)
        beyond = self.start >= end
        refuse(beyond, "harvester.start", self.start, "m", bound, "begin on it", limit=beam.length)
        return self.start / beam.length, min(end / beam.length, 1.0)

    def _sides_on(self, beam: Any) -> tuple[float, float]:
        """Find the beam's width and thickness under the layers [m]; refuse sides that vary there."""
        found, (first, last) = [], self._span_on(beam)
        inside = np.linspace(first, last, 259)[1:-1]
        for name in ("width", "thickness"):
            side = getattr(beam.section, name)(inside)
            if np.ptp(side) > _EVEN * side[0]:
                bound = f"it must be constant under the layers, and is {side[0]:.6g} m where they begin"
                remedy = f"give the layers a shorter span, or a beam of constant {name} there"
                raise InvalidValue(name, float(side[-1]), bound, remedy, "m")
            found.append(float(side[0]))
        return found[0], found[1]


@dataclass(frozen=True)
class Electrodes(FieldsOnly):
    """Electrodes of piezoelectric layers on a beam, with constants of the equations of motion.

    Parameters
    ----------
    harvester : Harvester
        The layers.
    bare : Beam
        The beam without layers and electrodes.
    span : tuple of float
        Start and end of the electrodes, as x/L.
    coupling : float
        Coupling theta: bending moment per voltage [N m/V].
    capacitance_per_length : float
        Capacitance per length C [F/m], at constant curvature.
    fibre : float
        Distance of the outer face of a layer from the neutral axis [m].
    laminate : Laminate
        The strip with the layers, whose deflections may vary across the width.
    flat : Coupled or None
        Coupling and capacitance per length of sections that cannot camber; None where a Poisson's ratio is
        not known.
    across : bool
        Whether the scene models camber; if so, the constants of `flat` hold, since the effect of camber on
        coupling and capacitance is a part of the solution.
    """

    harvester: Harvester
    bare: Any
    span: tuple[float, float]
    coupling: float
    capacitance_per_length: float
    fibre: float
    laminate: Laminate | None = field(default=None, repr=False, metadata=ADDED_LATER)
    flat: Coupled | None = field(default=None, metadata=ADDED_LATER)
    across: bool = field(default=False, metadata=ADDED_LATER)

    @property
    def moment(self) -> float:
        """Bending moment per voltage [N m/V]; if camber is modelled, that of sections that cannot camber."""
        return self.flat.moment if self.across and self.flat is not None else self.coupling

    @property
    def held_flat(self) -> Electrodes:
        """The electrodes with the constants of sections that are held flat over the electrodes' length."""
        assert self.flat is not None, "both Poisson's ratios are given"
        return replace(self, coupling=self.flat.moment, capacitance_per_length=self.flat.capacitance)

    def with_ratio(self, ratio: float) -> Electrodes:
        """Return the electrodes with a Poisson's ratio for strip and layers where none is given."""
        section, layers = self.bare.section, self.harvester
        of_strip = ratio if section.poissons_ratio is None else section.poissons_ratio
        of_layers = ratio if layers.poissons_ratio is None else layers.poissons_ratio
        bare = self.bare.with_section(replace(section, poissons_ratio=of_strip))
        return replace(layers, poissons_ratio=of_layers).on(bare).electrodes

    @property
    def resistance(self) -> float:
        """Resistance of the harvester's load [ohm]."""
        return self.harvester.resistance

    @property
    def is_loaded(self) -> bool:
        """Whether a current flows through a resistance: the circuit is neither short nor open."""
        return 0 < self.resistance < math.inf

    def inside(self, fraction: np.ndarray | float) -> Any:
        """Convert fractions (0 to 1) of the layers' length to positions x/L, kept just inside their ends."""
        first, last = self.span
        return first + (last - first) * (_EVEN + (1 - 2 * _EVEN) * fraction)

    def capacitance(self, length: float) -> float:
        """Compute the capacitance [F] of the electrodes on a beam of a length [m], at constant curvature."""
        held = self.flat if self.across else None
        per_length = self.capacitance_per_length if held is None else held.capacitance
        return per_length * (self.span[1] - self.span[0]) * length


def _added(profile: Profile, span: tuple[float, float], step: float) -> Profile:
    """Add the constant `step` to a property over a span of x/L."""
    return profile.stepped(np.array(span), np.array([-step, step]))
