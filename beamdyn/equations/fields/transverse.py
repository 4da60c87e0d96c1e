"""Displacement fields that deflect the beam transversely, and the terms that each pair of them shares.

The deflection is u2 = sum d_i v_i in the plane of rotation and u3 = sum n_i v_i out of it, over the fields
v_i, each of which bends or shears the beam in one of two directions e1, e2 fixed to the root:

    e1 = c b2 + s b3,  e2 = -s b2 + c b3,  so that  d = (c, -s),  n = (s, c),

with c, s the cosine and sine of the bending angle.  Two fields are thus coupled by mass, tension and the
inertial forces of rotation; bending also rotates the sections and the tip body, shear does not.

A body with the centrifugal inertia B (of sections -R, with R their rotary inertia) and the tilt u' = (u2',
u3') has the centrifugal potential energy omega^2/2 u3' (B u')_3: a body slender along the beam, B > 0, is
kept in the plane of rotation; a section, -R < 0, is rotated out of it.  As sections are not free to twist,
bending in both planes rotates them about the beam by int (u2' u3'' - u3' u2'')/2, on which the moment of
their product of inertia does work.  Derivation: docs/conventions.md and
tests/invariants/test_two_planes_derivation.py.

**Precone** eta inclines the beam to the plane of rotation.  With C, S = cos eta, sin eta the axis of
rotation is S b1 + C b3: tension has the factor C^2, spin softening d_i d_j + S^2 n_i n_j, the energy above
C^2, plus -S^2 u'^T B u'; Coriolis forces couple the two directions, and rotation causes a load along b3.
Derivation: tests/invariants/test_precone_derivation.py.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from beamdyn.equations import explanations as why
from beamdyn.equations.discretization import RootConditions, Space, Spaces
from beamdyn.equations.explanations import Explanation
from beamdyn.equations.fields.field import Deflection, Field, FieldEquations, Load, Term
from beamdyn.equations.mass import axial_tension, loads_by_mass, product_at_lumps
from beamdyn.equations.root_motion import Quantity
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.mount import Mount, aligned_cos_sin, exact_cos_sin
from beamdyn.scene.profile import ONE, Profile
from beamdyn.scene.scene import Scene
from beamdyn.scene.sections import TipInertia, section_tensor, tip_inertia

_NO_BODY, _NOTHING = TipMass(0.0), ONE.scaled(0.0)
_NO_INERTIA = tip_inertia(_NO_BODY, 0.0)
_EULER = "Euler coupling of planes"
_QUARTER_TURN = np.array([[0.0, 1.0], [-1.0, 0.0]])
_ROOT_ACCELERATIONS: tuple[Quantity, Quantity] = "root_transverse", "root_across"


@dataclass(frozen=True, eq=False)
class Trial:
    """Trial functions of a transverse field of a scene, with values at the tip.

    Symbols are those of docs/conventions.md.

    Parameters
    ----------
    field : TransverseField
        The field.
    scene : Scene
        The scene.
    spaces : Spaces
        Function spaces on the beam.
    beam : Beam
        The beam, with the modelled properties.
    tip : TipMass
        Rigid body at the tip, of mass 0 if there is none.
    inertia : TipInertia
        Moments of inertia of the body against tilts.
    conditions : RootConditions
        Boundary conditions at the root.
    space : Space
        The n trial functions.
    rotation : ndarray, shape (n,)
        Rotation D of the tip section per unit of each coordinate [1/m].
    centre : ndarray, shape (n,)
        Deflection t of the tip body's centre of gravity per unit of each coordinate.
    """

    field: TransverseField
    scene: Scene
    spaces: Spaces
    beam: Beam
    tip: TipMass
    inertia: TipInertia
    conditions: RootConditions
    space: Space
    rotation: np.ndarray
    centre: np.ndarray

    @classmethod
    def of(cls, field: TransverseField, scene: Scene, spaces: Spaces) -> Trial:
        """Build the trial functions of a field over function spaces."""
        beam, conditions = scene.modelled_beam, field.conditions(scene.mount)
        tip, inertia, space = _NO_BODY, _NO_INERTIA, spaces.functions(conditions)
        if beam.tip is not None:
            tip = beam.tip.about(beam.tip_tension_offset)
            inertia = tip_inertia(tip, beam.tip_twist)
        slope = space.end(1) / beam.length
        rotation = slope if field.rotates else np.zeros_like(slope)
        centre = space.end(0) + tip.offset * rotation
        return cls(field, scene, spaces, beam, tip, inertia, conditions, space, rotation, centre)

    def loads(self) -> tuple[Deflection, list[Load]]:
        """Build the deflection with its loads under unit accelerations, and the equations' load terms."""
        beam, tip, space, i, name = self.beam, self.tip, self.space, self.field.direction, self.field.name
        (d, n), (cosine, sine) = plane_components(self.scene), exact_cos_sin(self.scene.mount.precone)
        sections = section_tensor(beam, "rotary_inertia") if self.field.rotates else {}
        P, moment = loads_by_mass(beam, space)
        of_body = tip.mass * self.centre
        # Angular accelerations tilt sections and tip body in either direction.
        tilted = np.outer(self.inertia.tilting[i], self.rotation)
        for k in (k for k in range(2) if (i, k) in sections):
            tilted[k] += space.load(sections[i, k], 1)
        P, moment = P + of_body, moment + (beam.length + tip.offset) * of_body
        Q, Q_across = moment + tilted[i], tilted[1 - i]
        loads = [Load("angular acceleration", name, Q, "acceleration", cosine * d[i])]
        if np.count_nonzero(Q_across):
            loads.append(Load("angular acceleration", name, Q_across, "acceleration", cosine * d[1 - i]))
        if sine:
            pressed = (self.inertia.centrifugal[i] @ np.array(n)) * self.rotation
            for (p, q), inertia in sections.items():
                if p == i:
                    pressed = pressed - n[q] * space.load(inertia, 1)
            pressed = n[i] * moment + pressed
            if pressed.any():
                loads.append(Load("centrifugal bending", name, pressed, "speed_squared", -sine * cosine))
        loads.append(Load("root acceleration", name, P, _ROOT_ACCELERATIONS[i], -1.0))
        return Deflection(space, P, Q, Q_across, i), loads


@dataclass(frozen=True)
class Pair:
    """Integrals of products of the functions of two transverse fields, which may be the same field.

    Parameters
    ----------
    rows, columns : Trial
        The trial functions.
    directions : tuple of int
        Directions in which the two fields deflect the beam.
    rotate : bool
        Whether both fields rotate the sections.
    """

    rows: Trial
    columns: Trial
    directions: tuple[int, int]
    rotate: bool

    @classmethod
    def of(cls, rows: Trial, columns: Trial) -> Pair:
        """Pair the trial functions of two fields."""
        directions = rows.field.direction, columns.field.direction
        return cls(rows, columns, directions, rows.field.rotates and columns.field.rotates)

    def term(
        self, name: str, matrix: np.ndarray, quantity: Quantity = "unity", factor: float = 1.0, order: int = 0
    ) -> Term:
        """Build a term of the first field's equations that multiplies the second field's coordinates."""
        return Term(name, self.rows.field.name, self.columns.field.name, order, matrix, quantity, factor)

    def integrate(self, weight: Profile, *orders: int) -> np.ndarray:
        """Integrate over x a weight times x-derivatives of both fields; give one common order, or two."""
        first, last = orders[0], orders[-1]
        length = self.rows.beam.length
        if self.rows is self.columns and first == last:
            matrix = self.rows.space.gram(weight, first)
        else:
            conditions = self.rows.conditions, self.columns.conditions
            matrix = self.rows.spaces.product(weight, *conditions, (first, last))
        return matrix * length if first + last == 0 else matrix / length ** (first + last - 1)

    def twist_by_bending(self, inertia: Profile) -> np.ndarray:
        """Integrate inertia (v' w'' - v'' w') for two fields, v along e1 and w along e2, in either order."""
        matrix = self.integrate(inertia, 1, 2) - self.integrate(inertia, 2, 1)
        return matrix if self.directions == (0, 1) else -matrix

    @cached_property
    def tilts(self) -> np.ndarray:
        """Products of the two fields' rotations D at the tip [1/m2]: shape (functions, functions)."""
        return np.outer(self.rows.rotation, self.columns.rotation)

    def with_tilts(self, matrix: np.ndarray, factor: float) -> np.ndarray:
        """Add a factor times the products of rotations at the tip to a matrix."""
        return matrix + factor * self.tilts if factor else matrix

    @cached_property
    def translation(self) -> np.ndarray:
        """Mass matrix [kg] of sections, point masses and tip body for the motion of their mass centres."""
        rows, columns = self.rows, self.columns
        by_mass = self.integrate(rows.beam.mass_per_length, 0)
        if rows.beam.point_masses:
            by_mass = by_mass + product_at_lumps(rows.beam, rows.space, columns.space)
        return by_mass + rows.tip.mass * np.outer(rows.centre, columns.centre) if rows.tip.mass else by_mass


class TransverseField(Field):
    """Deflection of the beam in one of two directions."""

    direction: ClassVar[int]
    rotates: ClassVar[bool]
    # Transverse fields that precede this one in `FIELDS`, in the same order.
    partners: ClassVar[tuple[TransverseField, ...]]
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
            "precone gives the rotation a component about the beam",
            (why.TURNS, why.PRECONED, why.BOTH),
        ),
        "Euler coupling of planes": Explanation(
            "ω' sin(η) S23 q3",
            "precone gives the rotation a component about the beam, and the speed varies",
            (why.ACCELERATES, why.PRECONED, why.BOTH),
        ),
        "centrifugal bending": Explanation(
            "-ω² s sin(η) cos(η) Q2",
            "rotation pulls a beam with precone towards the plane of rotation",
            (why.TURNS, why.PRECONED, why.OUT_OF_PLANE),
        ),
    }

    def conditions(self, mount: Mount) -> RootConditions:
        """Return the boundary conditions at the root."""
        raise NotImplementedError

    def own_stiffness(self, pair: Pair) -> Iterator[Term]:
        """Yield the elastic stiffness terms that couple this field with another field, or act on itself."""
        raise NotImplementedError

    def assemble(self, scene: Scene, spaces: Spaces) -> FieldEquations:
        """Assemble eq. (14) of Lee and Yoo (2019), corrected, with the tip body and further effects."""
        own = Trial.of(self, scene, spaces)
        terms = [*_terms(Pair.of(own, own))]
        for partner in self.partners:
            if partner.is_modelled(scene):
                pair = Pair.of(Trial.of(partner, scene, spaces), own)
                for sign, above in ((1.0, [*_terms(pair)]), (-1.0, [*_coriolis(pair)])):
                    terms += above
                    for t in above:
                        below = t.name, t.columns, t.rows, t.order, t.matrix.T, t.quantity
                        terms.append(Term(*below, sign * t.factor))
        deflection, loads = own.loads()
        turning = own.conditions.held == 1 and self.rotates
        return FieldEquations(own.space, (*terms,), (*loads,), deflection, turning)


def plane_components(scene: Scene) -> tuple[tuple[float, float], tuple[float, float]]:
    """Compute the components of both bending directions e1 and e2 along b2, then along b3."""
    c, s = aligned_cos_sin(scene.mount.bending_angle)
    return (c, -s), (s, c)


def axis_in_section(scene: Scene) -> tuple[float, float]:
    """Compute the rotation axis' components along the direction of bending at the root and across it."""
    (c, s), (cosine, _) = aligned_cos_sin(scene.mount.bending_angle), exact_cos_sin(scene.mount.precone)
    return cosine * s, cosine * c


def _terms(pair: Pair) -> Iterator[Term]:
    """Yield mass and stiffness terms: elastic, of springs, and due to tension and rotation."""
    rows, columns, (i, j) = pair.rows, pair.columns, pair.directions
    scene, beam, tip, sections = rows.scene, rows.beam, rows.tip, section_tensor(rows.beam, "rotary_inertia")
    cosine, sine = exact_cos_sin(scene.mount.precone)
    mass = pair.translation if i == j else np.zeros_like(pair.tilts)
    yield pair.term("mass", pair.with_tilts(mass, rows.inertia.tilting[i, j]), order=2)
    if pair.rotate and (i, j) in sections:
        yield pair.term("rotary inertia of sections", pair.integrate(sections[i, j], 1), order=2)
    yield from columns.field.own_stiffness(pair)
    if i == j:
        if beam.point_springs:
            xi, springs = beam.springs(i)
            held = (rows.space.evaluate(xi) * springs) @ columns.space.evaluate(xi).T
            yield pair.term("point springs", held)
        # Tension acts on the slope of the total deflection, shear included (Engesser).
        (n_a, n_b), reach = axial_tension(beam), beam.length + tip.offset
        KGB = pair.with_tilts(pair.integrate(n_b, 1), tip.mass * reach * tip.offset)
        KGA = pair.with_tilts(pair.integrate(n_a, 1), tip.mass * tip.offset)
        yield pair.term("centrifugal stiffening", KGB, "speed_squared", cosine**2)
        yield pair.term("tension by root acceleration", KGA, "root_axial", -1.0)
    yield from _spin(pair, cosine, sine)
    if sine and pair.rotate and scene.physics.planes == 2:
        yield from _euler_of_turned(pair, sine)


def _spin(pair: Pair, cosine: float, sine: float) -> Iterator[Term]:
    """Yield terms of centrifugal forces on masses that move in the plane of rotation or tilt out of it.

    `cosine` and `sine` are those of the precone.
    """
    (i, j), beam, (d, n) = pair.directions, pair.rows.beam, plane_components(pair.rows.scene)
    if softening := d[i] * d[j] + sine**2 * n[i] * n[j]:
        yield pair.term("spin softening", pair.translation, "speed_squared", -softening)
    body, sections = pair.rows.inertia.centrifugal, section_tensor(beam, "rotary_inertia")
    if not (pair.rotate and (sections or beam.tip)):
        return
    # Coefficients of B_pq in the matrix of C^2 u3' (B u')_3 - S^2 u'^T B u'.
    B = [[0.0, 0.0], [0.0, 0.0]]
    for q in range(2):
        B[q][j] += cosine**2 * n[i] * n[q] / 2
        B[q][i] += cosine**2 * n[j] * n[q] / 2
    B[i][j] -= sine**2
    for p, q in ((0, 0), (1, 1), (0, 1)):
        if factor := B[p][q] if p == q else B[0][1] + B[1][0]:
            yield pair.term("spin of the tip body", body[p, q] * pair.tilts, "speed_squared", factor)
            if (p, q) in sections:
                matrix = pair.integrate(sections[p, q], 1)
                yield pair.term("spin of sections", matrix, "speed_squared", -factor)
    if i != j:
        product = ONE.scaled(-float(np.array(d) @ body @ np.array(n)))
        for (p, q), inertia in sections.items():
            product = product + inertia.scaled(d[p] * n[q] * beam.length).outboard_integral()
        if product != _NOTHING:
            matrix = pair.twist_by_bending(product)
            yield pair.term("twisting by inertia", matrix, "speed_squared", cosine**2 / 2)


# Coupling by the rotation component about the beam axis (precone) ----------------------------------


def _coriolis(pair: Pair) -> Iterator[Term]:
    """Yield the skew-symmetric coupling of both directions by Coriolis and Euler forces."""
    _, sine = exact_cos_sin(pair.rows.scene.mount.precone)
    (i, j), tip = pair.directions, pair.rows.tip
    if not sine or i == j:
        return
    # The tip body's second moment along the beam is invariant to rotations about the beam.
    along = (tip.inertia + tip.inertia_about_bending_direction - tip.axial_inertia) / 2
    mass, across = pair.translation + along * pair.tilts, sine if i == 0 else -sine
    yield pair.term("Coriolis coupling of planes", mass, "speed", 2 * across, order=1)
    yield pair.term(_EULER, mass, "acceleration", across)


def _euler_of_turned(pair: Pair, sine: float) -> Iterator[Term]:
    """Yield the terms of Euler forces on sections and tip body that tilt and turn about the beam.

    The matrix is the symmetric part of B T, with the inertia B and the rotation T by 90 degrees about the
    beam.
    """
    (i, j), beam, tip, T = pair.directions, pair.rows.beam, pair.rows.tip, _QUARTER_TURN
    turned = pair.rows.inertia.centrifugal @ T
    yield pair.term(_EULER, (turned + turned.T)[i, j] / 2 * pair.tilts, "acceleration", -sine)
    polar = ONE.scaled(tip.axial_inertia)
    for (p, q), rotary in section_tensor(beam, "rotary_inertia").items():
        factor = sine * float((i == p) * T[q, j] + (j == p) * T[q, i]) / 2
        yield pair.term(_EULER, pair.integrate(rotary, 1), "acceleration", factor)
        if p == q:
            polar = polar + rotary.scaled(beam.length).outboard_integral()
    if i != j:
        yield pair.term(_EULER, pair.twist_by_bending(polar), "acceleration", -sine / 2)
