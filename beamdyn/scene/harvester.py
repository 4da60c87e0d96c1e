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

z = (h + t)/2 is the distance of the middle of a layer from that of the beam, z_n that of the neutral axis, to
which one layer on one side moves it.  A voltage on one layer also stretches the beam, by e b v/(E A), which
adds to its capacitance: the axial force is that of the loads alone.  Series and parallel as in Erturk and
Inman (2009), Smart Materials and Structures 18, 025009; unimorph: own derivation, docs/harvester.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal, NamedTuple, get_args

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, one_of, real, refuse, set_fields
from beamdyn.common.inputs.described import Described, descriptions
from beamdyn.common.results.read_only import FieldsOnly
from beamdyn.common.words import Words
from beamdyn.scene.names_elsewhere import RECTANGULAR
from beamdyn.scene.profile import Profile

Connection = Literal["series", "parallel", "unimorph"]
_STRAINED, _STRESSED = ("e31", "c11e", "eps33s"), ("d31", "s11e", "eps33t")
_SETS = _STRAINED, _STRESSED
_EVEN = 1e-9  # change of a side along the layers, over it, that is rounding
_SHORT: Any = {"least": 0, "infinite": "open circuit", "remedy": "0 is a short circuit, inf an open one"}


class Material(NamedTuple):
    """Constants of a layer strained along one direction: c11E [Pa], e31 [C/m2] and eps33S [F/m]."""

    stiffness: float
    coupling: float
    permittivity: float


@dataclass(frozen=True)
class Harvester(FieldsOnly):
    """Piezoelectric layers with electrodes over a part of a rectangular beam, and their load.

    `on` puts them on a beam.

    Parameters
    ----------
    thickness : float
        Thickness t of a layer [m]; its width is that of the beam.
    density : float
        Density of the layers [kg/m3].
    connection : {"series", "parallel", "unimorph"}
        A layer on either side, connected in series or in parallel, or one layer.
    e31, c11e, eps33s : float, optional
        Piezoelectric stress constant [C/m2], of either sign, modulus at constant field [Pa] and permittivity
        at constant strain [F/m], of a layer that is free across: the reduced constants of a beam.
    d31, s11e, eps33t : float, optional
        In their place the strain constant [m/V], compliance at constant field [1/Pa] and permittivity at
        constant stress [F/m].
    start, end : float
        Where layers and electrodes begin and end [m from the root]; an infinite end is the tip.
    resistance : float
        Load resistance R [ohm]: 0 is a short circuit, inf an open one.
    strain_limit : float
        Largest strain that a layer bears; inf where none is known.

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
        Connection, Described("", "", "a layer on either side in series or parallel, or one: unimorph")
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

    def __post_init__(self) -> None:
        one_of("harvester.connection", self.connection, get_args(Connection))
        for name, described in descriptions(Harvester).items():
            given = getattr(self, name)
            is_infinite = bool(described.infinite) and isinstance(given, float) and given == math.inf
            is_left_out = given is None and name in (*_STRAINED, *_STRESSED)
            if not (name == "connection" or is_infinite or is_left_out):
                set_fields(self, **{name: described.check(f"harvester.{name}", given)})
        self._check_material()
        bad, bound = self.start >= self.end, "the layers must begin before their end at {limit}"
        refuse(bad, "harvester.start", self.start, "m", bound, "are the two swapped?", limit=self.end)

    def _check_material(self) -> None:
        """Refuse constants that are not one set of three, or that no material has."""
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
            raise InvalidValue("harvester.eps33t", self.eps33t, bound, "check all three", "F/m", limit)

    @property
    def material(self) -> Material:
        """The constants of one strain and one field."""
        if self.e31 is not None and self.c11e is not None and self.eps33s is not None:
            return Material(self.c11e, self.e31, self.eps33s)
        assert self.d31 is not None and self.s11e is not None and self.eps33t is not None, "one set is given"
        return Material(1 / self.s11e, self.d31 / self.s11e, self.eps33t - self.d31**2 / self.s11e)

    def on(self, beam: Any) -> Any:
        """Put the layers on a beam: a `Beam` with their mass, stiffness (short-circuited) and electrodes.

        Raises
        ------
        ValueError
            If the beam has no rectangular section, is twisted, carries layers already or ends before them, or
            its section varies under them.
        """
        span, (b, h) = self._span_on(beam), self._sides_on(beam)
        modulus, density = beam.section.youngs_modulus, beam.section.density
        material, t = self.material, self.thickness
        sides = 1 if self.connection == "unimorph" else 2
        elastic = _composite(modulus, material.stiffness, h, t, sides)
        heavy = _composite(density, self.density, h, t, sides)
        fibre = max(h / 2 + t - elastic.centre, elastic.centre - h / 2)
        outer = max(fibre, h / 2 + elastic.centre)
        of_bare = {
            "mass_per_length": heavy.area - density * h,
            "axial_stiffness": elastic.area - modulus * h,
            "bending_stiffness": elastic.second - modulus * h**3 / 12,
            "rotary_inertia": heavy.second - density * h**3 / 12,
            "second_bending_stiffness": (elastic.area - modulus * h) * b**2 / 12,
            "second_rotary_inertia": (heavy.area - density * h) * b**2 / 12,
            "outer_fibre": (outer - h / 2) / b,
        }
        made = {name: _added(getattr(beam, name), span, b * step) for name, step in of_bare.items()}
        arm = b * material.coupling * ((h + t) / 2 - elastic.centre)
        of_layer = b * material.permittivity / t
        coupling, capacitance = {
            "series": (arm, of_layer / 2),
            "parallel": (2 * arm, 2 * of_layer),
            "unimorph": (arm, of_layer + b * material.coupling**2 / elastic.area),
        }[self.connection]
        return replace(beam, **made, electrodes=Electrodes(self, beam, span, coupling, capacitance, fibre))

    def _span_on(self, beam: Any) -> tuple[float, float]:
        """Begin and end as x/L; refused where the beam cannot carry the layers."""
        if beam.electrodes is not None:
            bound = "the beam carries layers already, which these would overlap"
            raise InvalidValue("harvester.start", self.start, bound, "put one set on the bare beam", "m")
        if beam.section is None:
            remedy = Words(RECTANGULAR, " makes one")
            raise InvalidValue("harvester", "layers", "they need a beam of rectangular section", remedy)
        if beam.is_twisted:
            raise InvalidValue("twist", beam.tip_twist, "a twisted beam carries no layers", unit="rad")
        end, bound = beam.length if math.isinf(self.end) else self.end, "the beam ends at {limit}"
        beyond = real("harvester.end", end) > beam.length * (1 + _EVEN)
        refuse(beyond, "harvester.end", end, "m", bound, "end the layers on it", limit=beam.length)
        beyond = self.start >= end
        refuse(beyond, "harvester.start", self.start, "m", bound, "begin on it", limit=beam.length)
        return self.start / beam.length, min(end / beam.length, 1.0)

    def _sides_on(self, beam: Any) -> tuple[float, float]:
        """Width and thickness under the layers [m]; refused where they vary."""
        found, (first, last) = [], self._span_on(beam)
        inside = np.linspace(first, last, 259)[1:-1]
        for name in ("width", "thickness"):
            side = getattr(beam.section, name)(inside)
            if np.ptp(side) > _EVEN * side[0]:
                bound = "under the layers it must be constant"
                raise InvalidValue(name, float(side[-1]), bound, f"{side[0]:.6g} m where they begin", "m")
            found.append(float(side[0]))
        return found[0], found[1]


@dataclass(frozen=True)
class Electrodes(FieldsOnly):
    """Electrodes of layers on a beam, by what its equations read.

    Parameters
    ----------
    harvester : Harvester
        The layers.
    bare : Beam
        The beam without them.
    span : tuple of float
        Where they begin and end, as x/L.
    coupling : float
        theta, bending moment per voltage [N m/V].
    capacitance_per_length : float
        C [F/m], at constant curvature.
    fibre : float
        Distance of the outer face of a layer from the neutral axis [m].
    """

    harvester: Harvester
    bare: Any
    span: tuple[float, float]
    coupling: float
    capacitance_per_length: float
    fibre: float

    @property
    def resistance(self) -> float:
        """Load resistance [ohm]."""
        return self.harvester.resistance

    @property
    def is_loaded(self) -> bool:
        """Whether a current flows through a resistance: the circuit is neither short nor open."""
        return 0 < self.resistance < math.inf

    def inside(self, fraction: np.ndarray | float) -> Any:
        """Places x/L at fractions of the layers' length, within them by more than rounding."""
        first, last = self.span
        return first + (last - first) * (_EVEN + (1 - 2 * _EVEN) * fraction)

    def capacitance(self, length: float) -> float:
        """Capacitance [F] of the electrodes on a beam of a length [m], at constant curvature."""
        return self.capacitance_per_length * (self.span[1] - self.span[0]) * length


class _Composite(NamedTuple):
    """Integrals of a property over the thickness: its sum, centre, and second moment about that."""

    area: float
    centre: float
    second: float


def _composite(inner: float, layer: float, h: float, t: float, sides: int) -> _Composite:
    """Integrals for a strip of thickness h between layers of thickness t on one side or both."""
    z, area = (h + t) / 2, inner * h + sides * layer * t
    centre = layer * t * z / area if sides == 1 else 0.0
    second = inner * h**3 / 12 + sides * layer * t * (t**2 / 12 + z**2)
    return _Composite(area, centre, second - area * centre**2)


def _added(profile: Profile, span: tuple[float, float], step: float) -> Profile:
    """A property with a constant added over a span of x/L."""
    return profile.stepped(np.array(span), np.array([-step, step]))
