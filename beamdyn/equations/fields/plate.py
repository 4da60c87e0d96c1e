"""The strip as a plate: its sections twist and camber, as far as the clamped root lets them.

The deflection of a thin rectangular section of width b and thickness t is

    w(x, y) = sum_k u_k(x) p_k(eta),    eta = 2 y/b,    p_k = (2 k + 1)^(1/2) P_k (Legendre),

with bending u_0, the mean over the width, torsion (odd k) and camber (even k from 2).  The strain energy of
a Kirchhoff plate of the stiffness D per width, with D b = E I/(1 - nu^2), is

    1/2 int int D [w_xx^2 + w_yy^2 + 2 nu w_xx w_yy + 2 (1 - nu) c w_xy^2] dy dx.

The factor c = 3 J/(b t^3) makes torsion that of a rectangle of finite width, whose constant J is
Saint-Venant's.  Of the odd part w_xx^2 has the factor g, and 2 nu w_xx w_yy its root, by which the warping
constant of the section is less than that of a thin one; in thick sections nu is a smaller ratio
(`Rectangle`), and torsion also has the rotary inertia of the thickness.  Rotation at the speed omega about
the unit vector a adds

    omega^2/2 int int [T w_x^2 + N_y w_y^2 - (1 - a1^2) rho t w^2] dy dx,
    N_y = rho t (1 - a2^2) (b^2/4 - y^2)/2,

where omega^2 T is the tension by rotation per width, and a1, a2 are the components of a in the directions
of bending and of the width (with precone, its cosine times the sine and the cosine of the bending angle).
N_y pulls the width apart, which stiffens torsion (propeller moment).  Where a1 a2 is not zero, rotation
also twists the strip, by the load -omega^2 a1 a2 rho t y per area, less what the inertia of the thickness
resists.  In a tapered strip the functions of torsion are p_k(2 y/b(L)), which lets it bend smoothly where
the width has a kink or jumps; of the even ones d/dx at constant y is d/dx - eta (b'/b) d/d eta.

Bodies at the tip and along the beam, springs and accelerations of the root act on the mean over the width;
a tip body also turns with the mean twist there.  Derivation: docs/conventions.md and
tests/invariants/test_plates.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.polynomial import legendre

from beamdyn.common.numerics import gauss_rule
from beamdyn.equations import explanations as why
from beamdyn.equations.discretization import CLAMPED, RootConditions, Space, Spaces
from beamdyn.equations.explanations import Condition, Explanation
from beamdyn.equations.fields.bending_and_shear import Bending
from beamdyn.equations.fields.field import Field, FieldEquations, Load, Term
from beamdyn.equations.fields.offset_names import EXPLANATIONS
from beamdyn.equations.fields.section_torsion import assemble_section_torsion
from beamdyn.equations.fields.stretch import STRETCHED, Stretch
from beamdyn.equations.fields.transverse import TransverseField, axis_in_section
from beamdyn.equations.mass import axial_tension
from beamdyn.equations.root_motion import Quantity
from beamdyn.scene.mount import aligned_cos_sin, exact_cos_sin
from beamdyn.scene.profile import ONE, Profile, combine
from beamdyn.scene.rectangle import Rectangle
from beamdyn.scene.scene import Scene

_HELD = CLAMPED._replace(stiffness="bending_stiffness", direction=0)  # at the root, as bending is
_SOME_RATIO = 0.3  # Poisson's ratio where none is given, for a list of all terms
_ORDERS = (0, 0), (0, 1), (0, 2), (1, 0), (2, 0), (1, 1)  # of the derivatives along and across
_ZERO = 1e-12  # of averages over the width, relative to the largest: symmetry makes smaller ones 0

_IS_TWISTED = Condition(lambda s: s.scene.modelled_beam.twist is not None, "the beam is not twisted")
_IS_OBLIQUE = Condition(
    lambda s: _IS_TWISTED.is_met(s) or min(map(abs, aligned_cos_sin(s.scene.mount.bending_angle))) != 0,
    "the strip stands along or across the plane of rotation",
)


class Derivative(NamedTuple):
    """A part of a derivative of the deflection: a factor times a derivative of u_k times a function of eta.

    Parameters
    ----------
    factor : Profile
        Factor along the beam.
    order : int
        Order of the derivative of u_k by x.
    across : ndarray, shape (k, q)
        Functions of eta, for each k, at the Gauss points across.
    """

    factor: Profile
    order: int
    across: np.ndarray


class WidthFunctions:
    """Functions across the width of a strip, and derivatives of the deflection by them, as sums of parts.

    Parameters
    ----------
    section : Rectangle
        The section.
    length : float
        Length of the beam [m].
    field : str
        Name of the field.
    numbers : sequence of int
        Numbers k of its functions across.
    conditions : RootConditions
        Conditions at the root of its functions along.
    points : int
        Number of Gauss points across.
    """

    def __init__(
        self,
        section: Rectangle,
        length: float,
        field: str,
        numbers: Sequence[int],
        conditions: RootConditions,
        points: int,
    ) -> None:
        self.field, self.conditions = field, conditions
        eta, _ = gauss_rule(points)
        self.tip, (p, dp, ddp) = _polynomials(tuple(numbers), points)
        half = _inverse(section.width).scaled(2.0)  # d eta/dy
        self.parts = {  # of the deflection and its derivatives
            "w": [Derivative(ONE, 0, p)],
            "w_y": [Derivative(half, 0, dp)],
            "w_yy": [Derivative(half * half, 0, ddp)],
            "w_x": [Derivative(ONE, 1, p)],
            "w_xx": [Derivative(ONE, 2, p)],
            "w_xy": [Derivative(half, 1, dp)],
        }
        if min(numbers) % 2 and not _is_uniform(section.width):
            self.parts = _parts_over_fixed_width(section.width, tuple(numbers), eta)
        elif section.width.degree:  # d/dx at constant y
            slope, change = _relative_slopes(section.width, length)
            stretched, turned = eta * dp, dp + eta * ddp
            self.parts["w_x"].append(Derivative(slope.scaled(-1.0), 0, stretched))
            self.parts["w_xx"] += [
                Derivative(slope.scaled(-2.0), 1, stretched),
                Derivative(change.scaled(-1.0), 0, stretched),
                Derivative(slope * slope, 0, eta * turned),
            ]
            self.parts["w_xy"].append(Derivative((half * slope).scaled(-1.0), 0, turned))


@lru_cache(maxsize=64)
def _polynomials(numbers: tuple[int, ...], points: int) -> tuple[np.ndarray, list[np.ndarray]]:
    """Values of functions across at eta = 1, and their derivatives of orders 0 to 2 at Gauss points."""
    edge, series = np.sqrt(2 * np.array(numbers) + 1), np.eye(max(numbers) + 1)[:, [*numbers]]
    eta, _ = gauss_rule(points)
    return edge, [edge[:, None] * legendre.legval(eta, legendre.legder(series, order)) for order in range(3)]


def _is_uniform(width: Profile) -> bool:
    """Whether a width is the same all along."""
    return not width.degree and len(width.breakpoints) == 2


def over_tip(width: Profile) -> Profile:
    """The width over that at the tip."""
    return width.scaled(1 / float(width.end_values()[1][-1]))


def _parts_over_fixed_width(
    width: Profile, numbers: tuple[int, ...], eta: np.ndarray
) -> dict[str, list[Derivative]]:
    """Derivatives of p_k(2 y/b(L)) u_k, by powers of 2 y/b and of the width over that at the tip."""
    r, dy = over_tip(width), 2 / float(width.end_values()[1][-1])
    series = (np.sqrt(2 * k + 1) * legendre.leg2poly(np.eye(k + 1)[k]) for k in numbers)
    coefficients = np.array([np.pad(c, (0, max(numbers) + 1 - len(c))) for c in series])
    powers = [ONE]
    while len(powers) <= max(numbers):
        powers.append(powers[-1] * r)

    def of(along: int, across: int) -> list[Derivative]:
        """Parts of the derivative of an order along and one across."""
        return [
            Derivative(
                powers[m - across].scaled(math.perm(m, across) * dy**across),
                along,
                coefficients[:, [m]] * eta ** (m - across),
            )
            for m in range(across, max(numbers) + 1)
            if coefficients[:, m].any()
        ]

    return {"w" + ("_" + "x" * i + "y" * j if i + j else ""): of(i, j) for i, j in _ORDERS}


@lru_cache(maxsize=64)
def _inverse(b: Profile) -> Profile:
    """One over the width [1/m]."""
    return combine(lambda width: 1 / width[None], b)[0]


@lru_cache(maxsize=64)
def _relative_slopes(b: Profile, length: float) -> tuple[Profile, Profile]:
    """Relative slope b'/b of the width [1/m] and its derivative [1/m2], over x/L."""
    first, second = b.derivative(), b.derivative().derivative()
    beta, change = combine(lambda b, d, dd: np.stack([d / b, dd / b - (d / b) ** 2]), b, first, second)
    return beta.scaled(1 / length), change.scaled(1 / length**2)


@dataclass(frozen=True)
class Strip:
    """A strip, and integrals over its area.

    Parameters
    ----------
    scene : Scene
        The scene, whose beam has a rectangular section.
    spaces : Spaces
        Function spaces along the beam.
    """

    scene: Scene
    spaces: Spaces

    @property
    def section(self) -> Rectangle:
        """The section."""
        assert self.scene.beam.section is not None, "a scene of a plate has a section"
        return self.scene.beam.section

    @property
    def points(self) -> int:
        """Number of Gauss points across, which integrate products of two functions and a parabola."""
        return self.spaces.across + 3

    @property
    def rotary_inertia(self) -> Profile:
        """Rotary inertia of the thickness per length [kg m], with which sections that twist turn."""
        t = self.section.thickness
        return (self.scene.beam.mass_per_length * t * t).scaled(1 / 12)

    def functions(self, field: Field, numbers: Sequence[int], conditions: RootConditions) -> WidthFunctions:
        """Functions of some numbers across, of a field."""
        return WidthFunctions(
            self.section, self.scene.beam.length, field.name, numbers, conditions, self.points
        )

    def integrate(
        self,
        weight: Profile,
        rows: tuple[WidthFunctions, str],
        columns: tuple[WidthFunctions, str],
        across: np.ndarray | float = 1.0,
    ) -> np.ndarray:
        """Integrate over x a weight times the mean over the width of two derivatives and a factor across.

        Each derivative is given by its deflection and its name, such as "w_xx".
        """
        (first, a), (second, b) = rows, columns
        _, of_points = gauss_rule(self.points)
        L, total = self.scene.beam.length, 0.0
        for p in first.parts[a]:
            for q in second.parts[b]:
                averages = (p.across * (of_points / 2 * across)) @ q.across.T
                scale = np.abs(p.across).max(initial=0.0) * np.abs(q.across).max(initial=0.0)
                averages[np.abs(averages) <= _ZERO * scale] = 0.0
                if averages.any():
                    of_x = weight * (p.factor * q.factor), first.conditions, second.conditions
                    along = self.spaces.product(*of_x, (p.order, q.order)) * L ** (1 - p.order - q.order)
                    of_both = averages[:, None, :, None] * along[:, None, :]
                    total = total + of_both.reshape(averages.shape[0] * along.shape[0], -1)
        return np.atleast_2d(total)

    def load(
        self,
        weight: Profile,
        rows: tuple[WidthFunctions, str],
        along: Space,
        across: np.ndarray | float = 1.0,
    ) -> np.ndarray:
        """Integrate over x a weight times the mean over the width of a derivative and a factor across."""
        _, of_points = gauss_rule(self.points)
        functions, name = rows
        L, total = self.scene.beam.length, 0.0
        for p in functions.parts[name]:
            means = p.across @ (of_points / 2 * across)
            total = total + np.kron(means, along.load((weight * p.factor).scaled(L)))
        return np.atleast_1d(total)

    def stiffness(self, rows: WidthFunctions, columns: WidthFunctions, warping: Profile = ONE) -> np.ndarray:
        """Stiffness of the plate [N/m], with a factor of its bending along the beam by warping."""
        section, EI = self.section, self.scene.beam.bending_stiffness
        D, bend = EI * section.camber_stiffening, self.integrate
        cross = D * _root(warping) * section.camber_ratio
        GJ = (EI * section.torsion_factor).scaled(2 / (1 + (section.poissons_ratio or 0.0)))
        return (
            bend(D * warping, (rows, "w_xx"), (columns, "w_xx"))
            + bend(D, (rows, "w_yy"), (columns, "w_yy"))
            + bend(cross, (rows, "w_xx"), (columns, "w_yy"))
            + bend(cross, (rows, "w_yy"), (columns, "w_xx"))
            + bend(GJ, (rows, "w_xy"), (columns, "w_xy"))
        )


@lru_cache(maxsize=64)
def _root(factor: Profile) -> Profile:
    """Square root of a property."""
    return combine(lambda values: np.sqrt(values)[None], factor)[0]


@dataclass(frozen=True)
class StackedSpace:
    """The functions along the beam, once for each function across.

    Parameters
    ----------
    along : Space
        Functions along the beam.
    numbers : tuple of int
        Numbers k of the functions across.
    fewer : int
        How many of them the coarser discretization has.
    stretch : Profile
        Half the local width over that by which y is divided in the functions across.
    """

    along: Space
    numbers: tuple[int, ...]
    fewer: int
    stretch: Profile = ONE

    @property
    def size(self) -> int:
        """Number of coordinates; those of the first function across come first."""
        return self.along.size * len(self.numbers)

    @property
    def of_each(self) -> int:
        """Number of coordinates of each function across."""
        return self.along.size

    @property
    def corner(self) -> np.ndarray:
        """Deflection at the corner eta = 1 of the tip (n,)."""
        return np.kron(np.sqrt(2 * np.array(self.numbers) + 1), self.along.end(0))

    def evaluate(self, xi: np.ndarray, eta: np.ndarray) -> np.ndarray:
        """Evaluate the deflections at x/L (k,) along and 2 y/b (l,) across: shape (n, k, l)."""
        numbers = np.array(self.numbers)
        places = np.multiply.outer(self.stretch(xi), eta)
        across = legendre.legvander(places, numbers.max())[:, :, numbers] * np.sqrt(2 * numbers + 1)
        values = self.along.evaluate(xi)[:, :, None] * np.moveaxis(across, 2, 0)[:, None]
        return values.reshape(self.size, len(xi), len(eta))

    def curvature_across(self, xi: np.ndarray) -> np.ndarray:
        """Evaluate the second derivatives by eta at x/L (k,), as means over the width: shape (n, k).

        Those of even Legendre polynomials have the mean k(k + 1)/2, the slope at an edge.
        """
        numbers = np.array(self.numbers)
        means = np.where(numbers % 2, 0, numbers * (numbers + 1) / 2) * np.sqrt(2 * numbers + 1)
        return np.kron(means[:, None], self.along.evaluate(xi))

    @property
    def coarse(self) -> np.ndarray | None:
        """Indices of the coordinates of the coarser discretization; None where it has others."""
        kept = self.along.coarse
        if kept is None:
            return None
        return (self.along.size * np.arange(self.fewer)[:, None] + kept).ravel()


class SectionField(Field):
    """Deformation of the sections of a strip: torsion, which is odd across, or camber, which is even."""

    first: ClassVar[int]  # number k of the first function across; the others follow in steps of two

    def complete(self, scene: Scene) -> Scene:
        """Include the field, of a flat strip with a Poisson's ratio, if its section is rectangular."""
        section = scene.beam.section
        if section is None:
            return scene
        given = replace(section, poissons_ratio=section.poissons_ratio or _SOME_RATIO)
        beam = replace(scene.beam, twist=None).with_section(given)
        return replace(scene, beam=beam, physics=replace(scene.physics, **{self.name: True}))

    def numbers(self, count: int) -> range:
        """Numbers k of the functions of this field among `count` functions beyond the mean."""
        return range(self.first, count + 1, 2)

    def assemble(self, scene: Scene, spaces: Spaces) -> FieldEquations:
        """Assemble the energy of the plate, with what couples it to bending."""
        strip = Strip(scene, spaces)
        numbers = tuple(self.numbers(spaces.across))
        fewer, is_odd = len(self.numbers(spaces.fewer_across)), self.first % 2
        stretch = over_tip(strip.section.width) if is_odd else ONE
        space = StackedSpace(spaces.functions(_HELD), numbers, fewer, stretch)
        if not numbers:
            return FieldEquations(space, (), ())
        own = strip.functions(self, numbers, _HELD)
        terms = [*self._terms(strip, own, own), *self._of_body(strip, own, space.along)]
        coupling = [t for t in self._coupling(strip, own) if t.matrix.any()]
        mirrored = [replace(t, rows=t.columns, columns=t.rows, matrix=t.matrix.T) for t in coupling]
        loads = (*self._loads(strip, own, space.along),)
        return FieldEquations(space, (*terms, *coupling, *mirrored), loads, sections=space)

    def _terms(self, strip: Strip, rows: WidthFunctions, columns: WidthFunctions) -> Iterator[Term]:
        scene, names = strip.scene, (rows.field, columns.field)
        beam, c1, c2 = scene.beam, *axis_in_section(scene)
        mass, (n_a, n_b) = beam.mass_per_length, axial_tension(beam)
        eta, _ = gauss_rule(strip.points)

        def stiffness(
            name: str, matrix: np.ndarray, quantity: Quantity = "unity", factor: float = 1.0
        ) -> Term:
            return Term(f"{name} of {self.name}", *names, 0, matrix, quantity, factor)

        inertia = strip.integrate(mass, (rows, "w"), (columns, "w"))
        yield Term(f"mass of {self.name}", *names, 2, inertia)
        yield stiffness("stiffness", strip.stiffness(rows, columns, self.warping(strip.section)))
        slopes = (rows, "w_x"), (columns, "w_x")
        cosine, _ = exact_cos_sin(scene.mount.precone)
        yield stiffness("centrifugal stiffening", strip.integrate(n_b, *slopes), "speed_squared", cosine**2)
        yield stiffness("tension by root acceleration", strip.integrate(n_a, *slopes), "root_axial", -1.0)
        yield stiffness("spin softening", inertia, "speed_squared", -(1 - c1**2))
        if c2**2 != 1:
            pull, slopes = mass * strip.section.width * strip.section.width, ((rows, "w_y"), (columns, "w_y"))
            matrix = strip.integrate(pull.scaled(1 / 8), *slopes, 1 - eta**2)
            yield stiffness("pull across", matrix, "speed_squared", 1 - c2**2)

    def warping(self, section: Rectangle) -> Profile:
        """Factor of the stiffness of the plate along the beam."""
        return ONE

    def _coupling(self, strip: Strip, own: WidthFunctions) -> Iterator[Term]:
        """Yield the terms with bending in the equations of bending; none of deflections odd across."""
        return iter(())

    def _of_body(self, strip: Strip, own: WidthFunctions, along: Space) -> Iterator[Term]:
        """Yield what a body at the tip adds; none where the mean over the width does not twist."""
        return iter(())

    def _loads(self, strip: Strip, own: WidthFunctions, along: Space) -> Iterator[Load]:
        """Yield the loads; none by what acts on the mean over the width."""
        return iter(())


def _explanations(name: str) -> dict[str, Explanation]:
    """Explanations of the terms that torsion and camber share."""
    return {
        f"mass of {name}": Explanation("Mkk qk''", "the strip is a plate"),
        f"stiffness of {name}": Explanation("Kk qk", "the strip is a plate"),
        f"centrifugal stiffening of {name}": Explanation("ω² KGBk qk", "the carrier turns", (why.TURNS,)),
        f"tension by root acceleration of {name}": Explanation(
            "-aO1 KGAk qk", why.say_tension, (why.TENSIONED,)
        ),
        f"pull across of {name}": Explanation(
            "ω² KNk qk", "rotation pulls the width apart", (why.TURNS, why.TILTED)
        ),
        f"spin softening of {name}": Explanation(
            "-ω² c² Mkk qk", why.say_softening, (why.TURNS, why.SOFTENED)
        ),
        f"damping of {name}": Explanation("C qk'", "the beam is damped", (why.DAMPED,)),
    }


class Torsion(SectionField):
    """Torsion of a strip: the deflections that are odd across its width."""

    name = "torsion"
    partners: ClassVar[tuple[TransverseField, ...]] = Stretch.partners
    requires: ClassVar[Mapping[str, object]] = {"torsion": True}
    damping_name = "damping of torsion"
    first = 1
    explanations: ClassVar[Mapping[str, Explanation]] = {
        **_explanations("torsion"),
        "rotary inertia of torsion": Explanation("Rkk qk''", "sections turn"),
        "spin of sections of torsion": Explanation("ω² (c² - s²) Rkk qk", "the carrier turns", (why.TURNS,)),
        "mass of the tip body in torsion": Explanation(
            "Jp r rᵀ qk''", "a body at the tip turns", (why.TIP_BODY,)
        ),
        "spin of the tip body in torsion": Explanation(
            "-ω² (c² - s²) (J1 - J2) r rᵀ qk", "a body at the tip turns", (why.TIP_BODY, why.TURNS)
        ),
        "twisting by rotation": Explanation(
            "-ω² c s Qk", "rotation turns the strip into its plane", (why.TURNS, _IS_OBLIQUE)
        ),
        "untwisting by tension": Explanation(
            "ω² NB r² β' θ'", "tension pulls straight the fibres of a twisted beam", (why.TURNS, _IS_TWISTED)
        ),
        **EXPLANATIONS,
    }

    def assemble(self, scene: Scene, spaces: Spaces) -> FieldEquations:
        """Assemble torsion of a strip; of another section by its constants."""
        if scene.beam.section is None:
            deflecting = [field for field in self.partners if field.is_modelled(scene)]
            stretched = STRETCHED if Stretch().is_modelled(scene) else None
            return assemble_section_torsion(scene, spaces, deflecting, stretched)
        return super().assemble(scene, spaces)

    def warping(self, section: Rectangle) -> Profile:
        """Warping constant of the section over that of a thin one."""
        return section.warping_factor

    def _terms(self, strip: Strip, rows: WidthFunctions, columns: WidthFunctions) -> Iterator[Term]:
        yield from super()._terms(strip, rows, columns)
        (c1, c2), name = axis_in_section(strip.scene), self.name
        tilt = strip.integrate(strip.rotary_inertia, (rows, "w_y"), (columns, "w_y"))
        yield Term("rotary inertia of torsion", name, name, 2, tilt)
        yield Term("spin of sections of torsion", name, name, 0, tilt, "speed_squared", c2**2 - c1**2)

    def _of_body(self, strip: Strip, own: WidthFunctions, along: Space) -> Iterator[Term]:
        tip = strip.scene.beam.tip
        if tip is None:
            return
        width = float(strip.section.width(np.ones(1))[0])
        turn = np.kron(own.tip * 2 / width, along.end(0))  # mean twist of the section at the tip
        turns, (c1, c2) = np.outer(turn, turn), axis_in_section(strip.scene)
        yield Term("mass of the tip body in torsion", self.name, self.name, 2, tip.axial_inertia * turns)
        spin = (tip.inertia_about_bending_direction - tip.inertia) * turns
        yield Term(
            "spin of the tip body in torsion", self.name, self.name, 0, spin, "speed_squared", c1**2 - c2**2
        )

    def _loads(self, strip: Strip, own: WidthFunctions, along: Space) -> Iterator[Load]:
        c1, c2 = axis_in_section(strip.scene)
        if not c1 * c2:
            return
        eta, _ = gauss_rule(strip.points)
        lever = (strip.scene.beam.mass_per_length * strip.section.width).scaled(1 / 2)
        vector = strip.load(lever, (own, "w"), along, eta)
        vector = vector - strip.load(strip.rotary_inertia, (own, "w_y"), along)  # as the thickness turns
        yield Load("twisting by rotation", self.name, vector, "speed_squared", -c1 * c2)


class Camber(SectionField):
    """Camber of a strip: the deflections that are even across its width, but for their mean."""

    name = "camber"
    requires: ClassVar[Mapping[str, object]] = {"camber": True}
    damping_name = "damping of camber"
    first = 2
    explanations: ClassVar[Mapping[str, Explanation]] = _explanations("camber")

    def _coupling(self, strip: Strip, own: WidthFunctions) -> Iterator[Term]:
        bending = Bending()
        mean = strip.functions(bending, (0,), bending.conditions(strip.scene.mount))
        return super()._terms(strip, mean, own)
