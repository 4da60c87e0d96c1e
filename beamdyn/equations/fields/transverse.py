"""Fields that deflect the beam transversely, and the terms that each pair of them has in common.

The deflection is u2 = sum d_i v_i in the plane of rotation and u3 = sum n_i v_i out of it, over the fields
v_i, each of which bends or shears the beam in one of two directions e1, e2 fixed to the root:

    e1 = c b2 + s b3,  e2 = -s b2 + c b3,  so that  d = (c, -s),  n = (s, c),

with c, s the cosine and sine of the bending angle.  Two fields thus share the mass, the tension, and what
rotation does to the mass; bending also turns the sections and the tip body, shear does not.

A body with the centrifugal inertia B (of sections -R, with R their rotary inertia) and the tilt
u' = (u2', u3') has the centrifugal potential energy omega^2/2 u3' (B u')_3: a body slender along the beam,
B > 0, is held in the plane of rotation; a section, -R < 0, is turned out of it.  And as no section is free to
twist, bending in both planes turns them about the beam by int (u2' u3'' - u3' u2'')/2, on which their product
of inertia works.  Derivation: docs/conventions.md and tests/invariants/test_two_planes_derivation.py.

**Precone** eta turns the beam out of the plane of rotation.  With C, S = cos eta, sin eta the axis of
rotation is S b1 + C b3: tension has C^2, spin softening d_i d_j + S^2 n_i n_j, that energy C^2, beside
-S^2 u'^T B u', and there are Coriolis forces between the two directions and a load by rotation along b3.
Derivation: tests/invariants/test_precone_derivation.py.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from beamdyn.equations import explanations as why
from beamdyn.equations.discretization import RootConditions, Space, Spaces
from beamdyn.equations.explanations import Explanation
from beamdyn.equations.fields.field import Deflection, Field, FieldEquations, Load, Term
from beamdyn.equations.mass import axial_tension, first_moment_by_mass, load_by_mass, product_at_lumps
from beamdyn.equations.root_motion import Quantity
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.mount import Mount, aligned_cos_sin, exact_cos_sin
from beamdyn.scene.profile import ONE, Profile
from beamdyn.scene.scene import Scene
from beamdyn.scene.sections import centrifugal_inertia, section_tensor, tilting_inertia

_NO_BODY, _NOTHING = TipMass(0.0), ONE.scaled(0.0)


@dataclass(frozen=True)
class Trial:
    """Trial functions of a transverse field of a scene, and what is evaluated of them at the tip.

    Symbols are those of docs/conventions.md.

    Parameters
    ----------
    field : TransverseField
        The field.
    scene : Scene
        The scene.
    spaces : Spaces
        Function spaces on the beam.
    """

    field: TransverseField
    scene: Scene
    spaces: Spaces

    @property
    def direction(self) -> int:
        """0 for deflection along e1, 1 along e2."""
        return self.field.direction

    @property
    def rotates(self) -> bool:
        """Whether the sections turn with the slope of the deflection."""
        return self.field.rotates

    @cached_property
    def conditions(self) -> RootConditions:
        """Conditions at the root."""
        return self.field.conditions(self.scene.mount)

    @cached_property
    def space(self) -> Space:
        """Trial functions."""
        return self.spaces.functions(self.conditions)

    @cached_property
    def beam(self) -> Beam:
        """The beam, with the modelled properties."""
        return self.scene.modelled_beam

    @cached_property
    def tip(self) -> TipMass:
        """Rigid body at the tip."""
        return self.beam.tip or _NO_BODY

    @cached_property
    def rotation(self) -> np.ndarray:
        """Rotation D of the section at the tip per coordinate [1/m], shape (n,)."""
        slope = self.space.end(1) / self.beam.length
        return slope if self.rotates else np.zeros_like(slope)

    @cached_property
    def centre(self) -> np.ndarray:
        """Deflection t of the tip body's centre of gravity per coordinate, shape (n,)."""
        return self.space.end(0) + self.tip.offset * self.rotation

    def tilting_load(self, direction: int) -> np.ndarray:
        """Moment of inertia (n,) that tilts the sections, as the beam's end turns towards a direction."""
        body = tilting_inertia(self.tip, self.beam.tip_twist)[self.direction, direction] * self.rotation
        inertia = section_tensor(self.beam, "rotary_inertia").get((self.direction, direction))
        if inertia is None or not self.rotates:
            return body
        return body + self.space.load(inertia, 1)

    @cached_property
    def first_moment(self) -> np.ndarray:
        """Load under a transverse acceleration that is proportional to x [kg m], shape (n,)."""
        reach = self.beam.length + self.tip.offset
        return first_moment_by_mass(self.beam, self.space) + self.tip.mass * reach * self.centre

    def toppling_load(self, n: tuple[float, float]) -> np.ndarray:
        """Centrifugal inertia (n,) that tilts the sections [kg m], as rotation presses to the direction n."""
        body = centrifugal_inertia(self.tip, self.beam.tip_twist)[self.direction] @ np.array(n)
        load = body * self.rotation
        if not self.rotates:
            return load
        for (i, j), inertia in section_tensor(self.beam, "rotary_inertia").items():
            if i == self.direction:
                load = load - n[j] * self.space.load(inertia, 1)
        return load

    @cached_property
    def Q(self) -> np.ndarray:
        """Load under a unit angular acceleration in the direction of the field [kg m], shape (n,)."""
        return self.first_moment + self.tilting_load(self.direction)

    @cached_property
    def Q_across(self) -> np.ndarray:
        """The same in the other direction, towards which oblique sections are tilted."""
        return self.tilting_load(1 - self.direction)

    @cached_property
    def P(self) -> np.ndarray:
        """Load under a unit root acceleration in the direction of the field [kg], shape (n,)."""
        return load_by_mass(self.beam, self.space) + self.tip.mass * self.centre


@dataclass(frozen=True)
class Pair:
    """Integrals of products of two transverse fields, which may be the same.

    Parameters
    ----------
    rows, columns : Trial
        The trial functions.
    """

    rows: Trial
    columns: Trial

    @property
    def directions(self) -> tuple[int, int]:
        """Directions of the two."""
        return self.rows.direction, self.columns.direction

    @property
    def rotate(self) -> bool:
        """Whether both turn the sections."""
        return self.rows.rotates and self.columns.rotates

    def integrate(self, weight: Profile, *orders: int) -> np.ndarray:
        """Integrate over x the weight times derivatives by x of the given order, or orders, of both."""
        first, last = orders[0], orders[-1]
        length = self.rows.beam.length
        if self.rows is self.columns and first == last:
            matrix = self.rows.space.gram(weight, first)
        else:
            conditions = self.rows.conditions, self.columns.conditions
            matrix = self.rows.spaces.product(weight, *conditions, (first, last))
        return matrix * length if first + last == 0 else matrix / length ** (first + last - 1)

    @cached_property
    def translation(self) -> np.ndarray:
        """Mass of the centres of gravity of sections, point masses and tip body [kg]."""
        rows, columns = self.rows, self.columns
        lumps = product_at_lumps(rows.beam, rows.space, columns.space)
        by_mass = self.integrate(rows.beam.mass_per_length, 0) + lumps
        return by_mass + rows.tip.mass * np.outer(rows.centre, columns.centre)

    @cached_property
    def tilts(self) -> np.ndarray:
        """Products of the rotations D at the tip [1/m2]."""
        return np.outer(self.rows.rotation, self.columns.rotation)


class TransverseField(Field):
    """Deflection of the beam in one of two directions."""

    direction: ClassVar[int]
    rotates: ClassVar[bool]
    partners: ClassVar[tuple[TransverseField, ...]]  # the fields before this one, the first of all first
    explanations: ClassVar[Mapping[str, Explanation]] = {
        "mass": Explanation("M22 q2''", why.say_mass),
        "rotary inertia of sections": Explanation("R22 q2''", "rotary inertia is modelled"),
        "centrifugal stiffening": Explanation("ω² KGB q2", "the carrier turns", (why.TURNS,)),
        "spin softening": Explanation("-ω² c² S22 q2", why.say_softening, (why.TURNS, why.SOFTENED)),
        "spin of the tip body": Explanation(
            "ω² s² (Je - J1) D Dᵀ q2",
            "the tip body tilts out of the plane of rotation",
            (why.TIP_BODY, why.TIP_INERTIA, why.TILTED, why.TURNS),
        ),
        "spin of sections": Explanation(
            "-ω² s² R22 q2", "sections tilt out of the plane of rotation", (why.TILTED, why.TURNS)
        ),
        "twisting by inertia": Explanation(
            "ω² H (u2' u3'' - u3' u2'')/2",
            "bending in both planes turns sections with a product of inertia",
            (why.OBLIQUE, why.TURNS),
        ),
        "tension by root acceleration": Explanation("-aO1 KGA q2", why.say_tension, (why.TENSIONED,)),
        "point springs": Explanation("k t tᵀ q2", "springs hold points of the beam", (why.ON_POINTS,)),
        "damping": Explanation("C q2'", "the beam is damped", (why.DAMPED,)),
        "angular acceleration": Explanation("ω' c Q2", "the speed varies", (why.ACCELERATES, why.IN_PLANE)),
        "root acceleration": Explanation("-(c aO2 + s aO3) P2", why.say_static_load, (why.LOADED,)),
        "Coriolis coupling of planes": Explanation(
            "2 ω sin(η) S23 q3'",
            "the precone has rotation about the beam",
            (why.TURNS, why.PRECONED, why.BOTH),
        ),
        "Euler coupling of planes": Explanation(
            "ω' sin(η) S23 q3",
            "the precone has rotation about the beam, and the speed varies",
            (why.ACCELERATES, why.PRECONED, why.BOTH),
        ),
        "centrifugal bending": Explanation(
            "-ω² s sin(η) cos(η) Q2",
            "rotation presses a beam with precone to the plane of rotation",
            (why.TURNS, why.PRECONED, why.OUT_OF_PLANE),
        ),
    }

    def conditions(self, mount: Mount) -> RootConditions:
        """Conditions at the root."""
        raise NotImplementedError

    def own_stiffness(self, pair: Pair) -> Iterator[Term]:
        """Yield the terms of the elastic stiffness of this field with another, or with itself."""
        raise NotImplementedError

    def assemble(self, scene: Scene, spaces: Spaces) -> FieldEquations:
        """Assemble eq. (14) of Lee and Yoo (2019), corrected, with tip body, and what goes beyond them."""
        own = Trial(self, scene, spaces)
        terms = [*self._terms_with(Pair(own, own))]
        for partner in self.partners:
            if partner.is_modelled(scene):
                pair = Pair(Trial(partner, scene, spaces), own)
                above, skew = [*self._terms_with(pair)], [*_coriolis(pair)]
                terms += [*above, *map(_transposed, above), *skew, *map(_transposed_skew, skew)]
        deflection = Deflection(own.space, own.P, own.Q, own.Q_across, self.direction)
        turning = own.conditions.held == 1 and self.rotates
        return FieldEquations(own.space, (*terms,), (*_loads(own),), deflection, turning)

    def _terms_with(self, pair: Pair) -> Iterator[Term]:
        yield from _mass(pair)
        yield from self.own_stiffness(pair)
        yield from _springs(pair)
        yield from _tension(pair)
        yield from _spin(pair)
        yield from _euler_of_turned(pair)


def term_of(
    name: str, pair: Pair, matrix: np.ndarray, quantity: Quantity = "unity", factor: float = 1.0
) -> Term:
    """Term of the stiffness of a pair of fields."""
    return Term(name, pair.rows.field.name, pair.columns.field.name, 0, matrix, quantity, factor)


def _transposed(term: Term) -> Term:
    return Term(term.name, term.columns, term.rows, term.order, term.matrix.T, term.quantity, term.factor)


def _transposed_skew(term: Term) -> Term:
    return replace(_transposed(term), factor=-term.factor)


def _mass(pair: Pair) -> Iterator[Term]:
    names, (i, j) = (pair.rows.field.name, pair.columns.field.name), pair.directions
    inertia = tilting_inertia(pair.rows.tip, pair.rows.beam.tip_twist)[i, j]
    tilted = inertia * pair.tilts
    yield Term("mass", *names, 2, pair.translation + tilted if i == j else tilted)
    sections = section_tensor(pair.rows.beam, "rotary_inertia").get((i, j))
    if pair.rotate and sections is not None:
        yield Term("rotary inertia of sections", *names, 2, pair.integrate(sections, 1))


def _springs(pair: Pair) -> Iterator[Term]:
    """Stiffness of springs along the beam, against the whole deflection."""
    if pair.rows.direction != pair.columns.direction:
        return
    xi, stiffness = pair.rows.beam.springs(pair.rows.direction)
    if stiffness.size:
        matrix = (pair.rows.space.evaluate(xi) * stiffness) @ pair.columns.space.evaluate(xi).T
        yield term_of("point springs", pair, matrix)


def _tension(pair: Pair) -> Iterator[Term]:
    """Stiffness by tension, which acts on the slope of the whole deflection (Engesser)."""
    if pair.rows.direction != pair.columns.direction:
        return
    tip, (n_a, n_b) = pair.rows.tip, axial_tension(pair.rows.beam)
    reach = pair.rows.beam.length + tip.offset
    KGB = pair.integrate(n_b, 1) + tip.mass * reach * tip.offset * pair.tilts
    KGA = pair.integrate(n_a, 1) + tip.mass * tip.offset * pair.tilts
    cosine, _ = exact_cos_sin(pair.rows.scene.mount.precone)
    yield term_of("centrifugal stiffening", pair, KGB, "speed_squared", cosine**2)
    yield term_of("tension by root acceleration", pair, KGA, "root_axial", -1.0)


def _spin(pair: Pair) -> Iterator[Term]:
    """Work of rotation on masses that move in the plane of rotation, or tilt out of it."""
    d, n = plane_components(pair.rows.scene)
    cone = exact_cos_sin(pair.rows.scene.mount.precone)
    i, j = pair.directions
    if softening := d[i] * d[j] + cone[1] ** 2 * n[i] * n[j]:
        yield term_of("spin softening", pair, pair.translation, "speed_squared", -softening)
    if not pair.rotate:
        return
    beam = pair.rows.beam
    body = centrifugal_inertia(pair.rows.tip, beam.tip_twist)
    for p, q, factor in _tilting_factors(i, j, n, cone):
        yield term_of("spin of the tip body", pair, body[p, q] * pair.tilts, "speed_squared", factor)
        sections = section_tensor(beam, "rotary_inertia").get((p, q))
        if sections is not None:
            matrix = pair.integrate(sections, 1)
            yield term_of("spin of sections", pair, matrix, "speed_squared", -factor)
    if i != j:
        product = ONE.scaled(-float(np.array(d) @ body @ np.array(n)))
        for (p, q), inertia in section_tensor(beam, "rotary_inertia").items():
            product = product + inertia.scaled(d[p] * n[q] * beam.length).outboard_integral()
        if product != _NOTHING:
            matrix = _twist_by_bending(pair, product)
            yield term_of("twisting by inertia", pair, matrix, "speed_squared", cone[0] ** 2 / 2)


def plane_components(scene: Scene) -> tuple[tuple[float, float], tuple[float, float]]:
    """Components d on b2 and n on b3 of the directions e1, e2."""
    c, s = aligned_cos_sin(scene.mount.bending_angle)
    return (c, -s), (s, c)


def _tilting_factors(
    i: int, j: int, n: tuple[float, float], cone: tuple[float, float]
) -> Iterator[tuple[int, int, float]]:
    """Coefficients of B_pq in the matrix of the spin for fields in directions i, j: p, q, factor != 0.

    It is that of C^2 u3' (B u')_3 - S^2 u'^T B u', with the cosine and sine C, S of the precone.
    """
    B = np.zeros((2, 2))
    for q in range(2):
        B[q, j] += cone[0] ** 2 * n[i] * n[q] / 2
        B[q, i] += cone[0] ** 2 * n[j] * n[q] / 2
    B[i, j] -= cone[1] ** 2
    for p, q in ((0, 0), (1, 1), (0, 1)):
        factor = B[p, q] if p == q else B[0, 1] + B[1, 0]
        if factor:
            yield p, q, float(factor)


def _twist_by_bending(pair: Pair, inertia: Profile) -> np.ndarray:
    """Integrate inertia (v' w'' - v'' w') for fields v along e1 and w along e2, or the other way round."""
    matrix = pair.integrate(inertia, 1, 2) - pair.integrate(inertia, 2, 1)
    return matrix if pair.directions == (0, 1) else -matrix


# What the part of the rotation about the beam adds, in both directions ----------------------------


def _coriolis(pair: Pair) -> Iterator[Term]:
    """Skew coupling of the directions, by Coriolis and Euler forces."""
    _, sine = exact_cos_sin(pair.rows.scene.mount.precone)
    i, j = pair.directions
    if not sine or i == j:
        return
    mass = pair.translation + _moment_along(pair.rows.tip) * pair.tilts
    across = sine if i == 0 else -sine
    yield _of_planes("Coriolis", pair, 1, mass, "speed", 2 * across)
    yield _of_planes("Euler", pair, 0, mass, "acceleration", across)


def _euler_of_turned(pair: Pair) -> Iterator[Term]:
    """Work of Euler forces on sections and tip body that bending tilts and turns about the beam."""
    _, sine = exact_cos_sin(pair.rows.scene.mount.precone)
    if not sine or not pair.rotate or pair.rows.scene.physics.planes == 1:
        return
    (i, j), beam, tip = pair.directions, pair.rows.beam, pair.rows.tip
    body = _quarter_turned(centrifugal_inertia(tip, beam.tip_twist))
    yield _of_planes("Euler", pair, 0, body[i, j] * pair.tilts, "acceleration", -sine)
    polar = ONE.scaled(tip.axial_inertia)
    for (p, q), rotary in section_tensor(beam, "rotary_inertia").items():
        factor = sine * _quarter_turned(_unit_entry(p, q))[i, j]
        yield _of_planes("Euler", pair, 0, pair.integrate(rotary, 1), "acceleration", factor)
        if p == q:
            polar = polar + rotary.scaled(beam.length).outboard_integral()
    if i != j:
        yield _of_planes("Euler", pair, 0, _twist_by_bending(pair, polar), "acceleration", -sine / 2)


def _of_planes(
    force: str, pair: Pair, order: int, matrix: np.ndarray, quantity: Quantity, factor: float
) -> Term:
    rows, columns = pair.rows.field.name, pair.columns.field.name
    return Term(f"{force} coupling of planes", rows, columns, order, matrix, quantity, factor)


def _moment_along(tip: TipMass) -> float:
    """Second moment of mass of the tip body along the beam [kg m2]: no matter how it is turned about it."""
    return (tip.inertia + tip.inertia_about_bending_direction - tip.axial_inertia) / 2


def _quarter_turned(B: np.ndarray) -> np.ndarray:
    """The symmetric part of B T (2, 2) with a quarter turn T about the beam."""
    turned = B @ np.array([[0.0, 1.0], [-1.0, 0.0]])
    return (turned + turned.T) / 2


def _unit_entry(p: int, q: int) -> np.ndarray:
    matrix = np.zeros((2, 2))
    matrix[p, q] = 1.0
    return matrix


def _loads(trial: Trial) -> Iterator[Load]:
    name, (d, n) = trial.field.name, plane_components(trial.scene)
    cosine, sine = exact_cos_sin(trial.scene.mount.precone)
    i = trial.direction
    yield Load("angular acceleration", name, trial.Q, "acceleration", cosine * d[i])
    if trial.Q_across.any():
        yield Load("angular acceleration", name, trial.Q_across, "acceleration", cosine * d[1 - i])
    if sine:
        pressed = n[i] * trial.first_moment + trial.toppling_load(n)
        if pressed.any():
            yield Load("centrifugal bending", name, pressed, "speed_squared", -sine * cosine)
    transverse: tuple[Quantity, Quantity] = "root_transverse", "root_across"
    yield Load("root acceleration", name, trial.P, transverse[i], -1.0)
