"""Offsets of mass and tension centres from the axis: coupling of torsion with bending, and loads.

The axis of the beam is the line of the sections' shear centres.  The centre of mass is at c from the axis,
the centre of tension (about which the section bends) at t; both have components along e1 and e2.  If a
section tilts by p = (v', w') and twists by theta (from e2 to e1), its point y is displaced, to second order,
by

    u - p.y - theta p.K y,    w + theta K y - theta^2 y/2 - p (p.y)/2,    K = (0, 1; -1, 0),

u being the displacement of the axis along the beam, w that across it.  The line of centres of tension keeps
its length, so that u' = t.p' - p.p/2 - theta t.K p', and w' = p + p (t.p').  The section also twists by
-(v' w'' - v'' w')/2, integrated from the root, as in every beam that bends in two directions.

In the frame of the root a point at r has the acceleration g + r'' + 2 omega B r' + omega' B r - omega^2 P r,
with B = -[a x] and P = 1 - a a^T, a being the axis of rotation and g the acceleration of the root.  The terms
are the work of this acceleration, for a mass at c, on these displacements.  Second moments about the axis are
part of the inertia tensors (`beamdyn.scene.sections`, `TipMass.about`).  Two effects are neglected, which
change frequencies by about the square of c/L: products of tilt, twist and these second moments; and Coriolis
and Euler forces of a tilt, which displaces the mass along the beam.  In the inertia of tilting, the line of
centres of tension is straight.  Derivation: docs/conventions.md and tests/invariants/test_offsets.py.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache, reduce
from itertools import chain, combinations, combinations_with_replacement, product
from typing import Any, NamedTuple

import numpy as np

from beamdyn.equations import explanations as why
from beamdyn.equations.discretization import RootConditions, Spaces
from beamdyn.equations.explanations import Condition, Explanation
from beamdyn.equations.fields.field import Load, Term
from beamdyn.equations.fields.transverse import Pair, Trial, axis_in_section
from beamdyn.equations.mass import axial_tension
from beamdyn.equations.root_motion import Quantity
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.mount import aligned_cos_sin, exact_cos_sin
from beamdyn.scene.profile import ONE, Profile
from beamdyn.scene.scene import Scene
from beamdyn.scene.sections import offset_components

NAMES: dict[tuple[Quantity, int], str] = {
    ("unity", 2): "mass of offsets",
    ("speed", 1): "Coriolis coupling of offsets",
    ("acceleration", 0): "Euler coupling of offsets",
    ("speed_squared", 0): "rotation of offsets",
    ("root_axial", 0): "tension by root acceleration of offsets",
    ("root_transverse", 0): "root acceleration of offsets",
    ("root_across", 0): "root acceleration of offsets",
}
NAMES_OF_LOADS: dict[Quantity, str] = {
    "acceleration": "angular acceleration on offsets",
    "speed_squared": "rotation on offsets",
    "root_axial": "axial root acceleration on offsets",
    "root_transverse": "root acceleration on offsets",
    "root_across": "root acceleration on offsets",
}
_BESIDE = Condition(lambda s: s.scene.beam.has_offsets, "the centres of mass and tension are on the axis")
_ROTATES_ALONG = Condition(
    lambda s: bool(s.scene.mount.precone) or s.scene.physics.stretch,
    "no precone, and stretch is not modelled",
)
EXPLANATIONS: Mapping[str, Explanation] = {
    "mass of offsets": Explanation("m c (w'' + θ'')", "the centre of mass lies beside the axis", (_BESIDE,)),
    "Coriolis coupling of offsets": Explanation(
        "2 ω sin(η) m c (w' + θ')", "masses move beside the axis", (_BESIDE, why.TURNS, _ROTATES_ALONG)
    ),
    "Euler coupling of offsets": Explanation(
        "ω' x m c (u'^2 + θ^2)", "the speed varies", (_BESIDE, why.ACCELERATES)
    ),
    "rotation of offsets": Explanation(
        "ω² (NB t w'' + m x c w') θ", "rotation pulls at centres beside the axis", (_BESIDE, why.TURNS)
    ),
    "tension by root acceleration of offsets": Explanation(
        "-aO1 (NA t w'' + m c w') θ", why.say_tension, (_BESIDE, why.TENSIONED)
    ),
    "root acceleration of offsets": Explanation(
        "m c (aO2 + aO3) (u'^2 + θ^2)", why.say_static_load, (_BESIDE, why.LOADED)
    ),
    "angular acceleration on offsets": Explanation(
        "ω' m (c + x c θ)", "the speed varies", (_BESIDE, why.ACCELERATES)
    ),
    "rotation on offsets": Explanation(
        "ω² (m c + NB t u'')", "rotation pulls at centres beside the axis", (_BESIDE, why.TURNS)
    ),
    "axial root acceleration on offsets": Explanation(
        "-aO1 (m c u' + NA t u'')", why.say_tension, (_BESIDE, why.TENSIONED)
    ),
    "root acceleration on offsets": Explanation(
        "-(aO2 + aO3) m c θ", why.say_static_load, (_BESIDE, why.LOADED)
    ),
}


# Index of the first component of c (mass centre), and of t (tension centre), in arrays with both.
_C, _T = 0, 2
_TURN = 2  # index of the twist due to torsion, after the two tilts towards e1 and e2


@dataclass(frozen=True, eq=False)
class SectionMotion:
    """Motion of the sections that a field describes: a displacement of the axis or a rotation.

    Parameters
    ----------
    field : str
        Name of the field.
    conditions : RootConditions
        Boundary conditions of the field's functions at the root.
    at_tip : ndarray, shape (n,)
        Motion of the tip body's reference point on the axis, per unit of each coordinate.
    along : int or None
        Direction of the displacement: 0, 1, 2 for b1, e1, e2; None for a rotation.
    rotation : int or None
        0, 1 for a tilt towards e1, e2, and 2 for a twist; None for a displacement.
    """

    field: str
    conditions: RootConditions
    at_tip: np.ndarray
    along: int | None = None
    rotation: int | None = None

    @property
    def order(self) -> int:
        """Order of the x derivative from functions to the motion: 1 for a tilt, 0 otherwise."""
        return int(self.rotation in (0, 1))

    @cached_property
    def on_axis(self) -> np.ndarray:
        """Displacement of the axis along b1, e1, e2 by a unit motion: shape (3,)."""
        return np.zeros(3) if self.along is None else np.eye(3)[self.along]

    @cached_property
    def beside(self) -> np.ndarray:
        """Displacement of the mass centre relative to the axis along b1, e1, e2 by a unit motion: (3, 4).

        The columns are its parts per unit of each component of the offsets c and t: c1, c2, t1, t2.
        """
        moved = np.zeros((3, 4))
        # The displacement is K c: offset c of the mass centre, rotated by 90 degrees in the section.
        if self.rotation == _TURN:
            moved[1, _C + 1], moved[2, _C] = 1.0, -1.0
        elif self.rotation is not None:
            moved[0, _C + self.rotation], moved[0, _T + self.rotation] = -1.0, 1.0
        return moved


def _second_order(rows: SectionMotion, columns: SectionMotion) -> np.ndarray:
    """Compute d2 u/(dr ds) of the mass centre's displacement u for two rotations r and s: shape (3, 4).

    The axes of the result are those of `SectionMotion.beside`: directions, and components of the offsets.
    """
    i, j, moved = rows.rotation, columns.rotation, np.zeros((3, 4))
    assert i is not None and j is not None, "both are rotations"
    if i == j == _TURN:
        moved[1, _C] = moved[2, _C + 1] = -1.0
    elif _TURN in (i, j):  # the displacement along the beam is -theta p.K c, as in the module's docstring
        tilt = min(i, j)
        moved[0, _C + 1 - tilt] = 2.0 * tilt - 1.0
    else:
        moved[1 + i, _C + j] -= 0.5
        moved[1 + j, _C + i] -= 0.5
    return moved


# Properties of the beam ---------------------------------------------------------------------------


@lru_cache(maxsize=256)
def _moment(beam: Beam, component: int, power: int) -> Profile | None:
    """Compute mass per length times an offset and a power of x [kg, kg m]; None if the result is 0.

    The offset is one of the four components of c and t, the positions of the centres of mass and tension.
    """
    offset = offset_components(beam)[component]
    first = offset and beam.mass_per_length * offset
    return first and first.times_fraction().scaled(beam.length) if power else first


@lru_cache(maxsize=64)
def _pulled(beam: Beam) -> list[list[Profile | None]]:
    """Compute N_A and N_B of `axial_tension` times each offset of the tension centre [kg m, kg m2]."""
    return [[t and outboard * t for t in offset_components(beam)[_T:]] for outboard in axial_tension(beam)]


class _CoupledMatrix(NamedTuple):
    """Matrix that couples two fields.

    The equations of the field `rows` contain the matrix, those of `columns` its transpose times `mirrored`.
    """

    rows: str
    columns: str
    quantity: Quantity
    order: int
    matrix: np.ndarray
    mirrored: float = 1.0

    def placed(self) -> Iterator[tuple[tuple[str, str, Quantity, int], np.ndarray]]:
        """Yield the matrix and, unless `mirrored` is 0, its transpose times `mirrored`.

        With each comes a key: field of the rows, field of the columns, quantity and order of the term.
        """
        yield (self.rows, self.columns, self.quantity, self.order), self.matrix
        if self.mirrored:
            place = self.columns, self.rows, self.quantity, self.order
            yield place, self.mirrored * self.matrix.T


@dataclass(frozen=True, eq=False)
class Offsets:
    """Terms and loads due to offsets of a scene's section centres, over function spaces.

    Parameters
    ----------
    scene : Scene
        The scene.
    spaces : Spaces
        Function spaces on the beam.
    turn : SectionMotion
        Twist of the sections by torsion.
    trials : sequence of Trial
        Fields that deflect the beam.
    stretched : sequence of SectionMotion
        Displacement along the beam; empty unless stretch is modelled.
    """

    scene: Scene
    spaces: Spaces
    turn: SectionMotion
    trials: Sequence[Trial]
    stretched: Sequence[SectionMotion] = ()
    _known: dict[tuple[Any, ...], np.ndarray] = field(default_factory=dict, repr=False)

    @cached_property
    def tilting(self) -> list[Trial]:
        """Fields that tilt the sections, by bending."""
        return [trial for trial in self.trials if trial.field.rotates]

    @cached_property
    def motions(self) -> list[SectionMotion]:
        """All motions of the sections: displacements, tilts and twist."""
        moved = [
            SectionMotion(t.field.name, t.conditions, t.centre, along=1 + t.field.direction)
            for t in self.trials
        ]
        tilts = [
            SectionMotion(t.field.name, t.conditions, t.rotation, rotation=t.field.direction)
            for t in self.tilting
        ]
        return [*self.stretched, *moved, *tilts, self.turn]

    @cached_property
    def frame(self) -> tuple[np.ndarray, np.ndarray]:
        """Matrices B of Coriolis and Euler accelerations and P of centrifugal ones, in axes b1, e1, e2."""
        a = np.array([exact_cos_sin(self.scene.mount.precone)[1], *axis_in_section(self.scene)])
        return -np.cross(a, np.eye(3)).T, np.eye(3) - np.outer(a, a)

    @cached_property
    def accelerations(self) -> list[tuple[Quantity, np.ndarray, int]]:
        """Accelerations of the axis per unit of each quantity of root motion: quantity, vector and power.

        The acceleration at x is the vector times x to this power, 0 or 1.
        """
        (B, P), (along, first, second) = self.frame, np.eye(3)
        return [
            ("root_axial", along, 0),
            ("root_transverse", first, 0),
            ("root_across", second, 0),
            ("acceleration", B[:, 0], 1),
            ("speed_squared", -P[:, 0], 1),
        ]

    @cached_property
    def _parametric(self) -> list[tuple[Quantity, np.ndarray, int]]:
        """Accelerations of the axis, as in `accelerations`, that change the stiffness.

        In steady rotation without gravity, if the beam points inward or outward, only those along the beam
        are returned, as the others are 0.
        """
        scene = self.scene
        steady = scene.motion is None or scene.motion.is_uniform
        if steady and not scene.gravity and not aligned_cos_sin(scene.mount.setting_angle)[1]:
            return [each for each in self.accelerations if each[0] in ("root_axial", "speed_squared")]
        return self.accelerations

    @cached_property
    def _beside_axis(self) -> list[tuple[Quantity, np.ndarray]]:
        """Accelerations of the mass centre relative to the axis per component of the offsets: (3, 4) each."""
        (B, P), none = self.frame, np.zeros((3, 2))
        return [
            ("acceleration", np.hstack([B[:, 1:], none])),
            ("speed_squared", np.hstack([-P[:, 1:], none])),
        ]

    # Moments of the mass, and their integrals --------------------------------------------------------

    @cached_property
    def _tip(self) -> tuple[TipMass, np.ndarray]:
        """Tip body, with offsets (4,) [m] of its mass centre and of the tension centre at the tip."""
        beam = self.scene.modelled_beam
        tip, twist = beam.tip or TipMass(0.0), beam.tip_twist
        of_tension = [
            0.0 if t is None else float(t.end_values()[1][-1]) for t in offset_components(beam)[_T:]
        ]
        of_mass = tip.offset_across * np.array([-np.sin(twist), np.cos(twist)])
        return tip, np.array([*of_mass, *of_tension])

    def _of_tip(self, coefficients: np.ndarray, power: int) -> float:
        """Compute the tip mass times x^power times the sum of coefficients (4,) times the offsets."""
        (tip, components), length = self._tip, self.scene.beam.length
        if not tip.mass:
            return 0.0
        return float(tip.mass * (length + tip.offset) ** power * (coefficients @ components))

    def _of_sections(self, coefficients: np.ndarray, power: int) -> Iterator[tuple[float, Profile]]:
        """Yield each nonzero coefficient and the mass per length times its offset component times x^power.

        The four coefficients belong to the components of the mass and tension centres.
        """
        beam = self.scene.modelled_beam
        for component, value in enumerate(coefficients.tolist()):
            if value and (moment := _moment(beam, component, power)) is not None:
                yield value, moment

    def _outboard(self, coefficients: np.ndarray, power: int) -> Profile | None:
        """Integrate mass times x^power times a linear function of offsets beyond each section; None if 0.

        The four coefficients of this function multiply the offsets c1, c2, t1, t2.
        """
        of_tip, length = self._of_tip(coefficients, power), self.scene.beam.length
        parts = [moment.scaled(value * length) for value, moment in self._of_sections(coefficients, power)]
        outboard = [part.outboard_integral() for part in parts] + [ONE.scaled(of_tip)] * bool(of_tip)
        return reduce(Profile.__add__, outboard) if outboard else None

    def _integrate(
        self, rows: SectionMotion, columns: SectionMotion, coefficients: np.ndarray, power: int
    ) -> np.ndarray | None:
        """Integrate the product of two motions, mass, x^power and a linear function of offsets; None if 0.

        The four coefficients multiply the components of the mass and tension centres.
        """
        orders = rows.order, columns.order
        found = [
            value * self._along(moment, rows.conditions, columns.conditions, orders)
            for value, moment in self._of_sections(coefficients, power)
        ]
        if of_tip := self._of_tip(coefficients, power):
            found.append(of_tip * np.outer(rows.at_tip, columns.at_tip))
        return sum(found[1:], found[0]) if found else None

    def _along(
        self, weight: Profile, rows: RootConditions, columns: RootConditions, orders: tuple[int, int]
    ) -> np.ndarray:
        """Integrate a weight times derivatives of two sets of functions along x; integrals are cached."""
        key = weight, rows, columns, orders
        if key not in self._known:
            scale = self.scene.beam.length ** (1 - sum(orders))
            self._known[key] = self.spaces.product(weight, rows, columns, orders) * scale
        return self._known[key]

    # Terms --------------------------------------------------------------------------------------------

    def terms(self) -> Iterator[Term]:
        """Yield all terms due to offsets; terms of the same name and the same fields are summed."""
        sums: dict[tuple[str, str, Quantity, int], np.ndarray] = {}
        parts = self._moved, self._carried, self._drawn_in, self._sheared, self._turned, self._tightened
        for part in chain.from_iterable(each() for each in parts):
            for place, matrix in part.placed():
                sums[place] = matrix if place not in sums else sums[place] + matrix
        for (rows, columns, quantity, order), matrix in sums.items():
            yield Term(NAMES[quantity, order], rows, columns, order, matrix, quantity)

    def _moved(self) -> Iterator[_CoupledMatrix]:
        """Yield inertia, Coriolis, Euler and centrifugal matrices for first-order motions of mass centres."""
        B, P = self.frame
        kinds: list[tuple[np.ndarray, float, list[tuple[Quantity, int, float]]]] = [
            (np.eye(3), 1.0, [("unity", 2, 1.0)]),
            (B, -1.0, [("speed", 1, 2.0), ("acceleration", 0, 1.0)]),
            (-P, 1.0, [("speed_squared", 0, 1.0)]),
        ]
        on_axis = np.array([motion.on_axis for motion in self.motions])
        beside = np.array([motion.beside for motion in self.motions])
        for matrix, mirrored, uses in kinds:
            one_way = np.einsum("ai,ij,bjc->abc", on_axis, matrix, beside)
            moved = one_way + mirrored * one_way.swapaxes(0, 1)
            for a, b in zip(*np.nonzero(np.triu(moved.any(axis=2), 1)), strict=True):
                rows, columns = self.motions[a], self.motions[b]
                if mirrored < 0 and rows.order + columns.order:
                    continue  # Coriolis and Euler forces of a tilt are neglected
                if (found := self._integrate(rows, columns, moved[a, b], 0)) is not None:
                    for quantity, order, factor in uses:
                        yield _CoupledMatrix(
                            rows.field, columns.field, quantity, order, factor * found, mirrored
                        )

    def _carried(self) -> Iterator[_CoupledMatrix]:
        """Yield matrices for the work of the axis' acceleration on second-order motions of mass centres."""
        rotations = [motion for motion in self.motions if motion.rotation is not None]
        for rows, columns in combinations_with_replacement(rotations, 2):
            for quantity, vector, power in self._parametric:
                moved = vector @ _second_order(rows, columns)
                if (found := self._integrate(rows, columns, moved, power)) is not None:
                    mirrored = 0.0 if rows is columns else 1.0
                    yield _CoupledMatrix(rows.field, columns.field, quantity, 0, found, mirrored)

    def _drawn_in(self) -> Iterator[_CoupledMatrix]:
        """Yield matrices for the work of the axial force when motion shortens the line of tension centres."""
        for quantity, vector, power in self._parametric:
            pulled = _pulled(self.scene.modelled_beam)[power]
            for trial in self.trials if vector[0] else ():
                i, tilts = trial.field.direction, trial.field.rotates
                if (moment := pulled[1 - i]) is not None:
                    factor = float(vector[0] if tilts == (i == 0) else -vector[0])
                    orders = (0, 2) if tilts else (1, 1)
                    matrix = self._along(moment, self.turn.conditions, trial.conditions, orders)
                    yield _CoupledMatrix(self.turn.field, trial.field.name, quantity, 0, factor * matrix)

    def _sheared(self) -> Iterator[_CoupledMatrix]:
        """Yield matrices for the work of transverse forces on slopes due to offsets of tension centres."""
        for quantity, vector, power in self._parametric:
            pulled = _pulled(self.scene.modelled_beam)[power]
            for rows, columns in product(self.tilting, repeat=2):
                force, moment = float(vector[1 + rows.field.direction]), pulled[columns.field.direction]
                if force and moment is not None:
                    matrix = self._along(moment, rows.conditions, columns.conditions, (1, 2))
                    yield _CoupledMatrix(rows.field.name, columns.field.name, quantity, 0, force * matrix)

    def _turned(self) -> Iterator[_CoupledMatrix]:
        """Yield matrices for the work of the twisting moment on the twist due to bending along e1 and e2."""
        for pair in (Pair.of(*each) for each in combinations(self.tilting, 2)):
            for quantity, vector, power in self._parametric:
                if (moment := self._outboard(vector @ self.turn.beside, power)) is not None:
                    names = pair.rows.field.name, pair.columns.field.name
                    yield _CoupledMatrix(*names, quantity, 0, -pair.twist_by_bending(moment) / 2)

    def _tightened(self) -> Iterator[_CoupledMatrix]:
        """Yield the stiffness matrices of the axial force that accelerated masses off the axis cause.

        Like any axial force, this force does work on the slope of the beam.
        """
        ahead = self._tip[0].offset
        parametric = [quantity for quantity, _, _ in self._parametric]
        for quantity, matrix in self._beside_axis:
            if quantity not in parametric or (force := self._outboard(matrix[0], 0)) is None:
                continue
            at_tip = self._of_tip(matrix[0], 0)
            for rows, columns in combinations_with_replacement(self.trials, 2):
                if rows.field.direction == columns.field.direction:
                    along = self._along(force, rows.conditions, columns.conditions, (1, 1))
                    matrix = -along - ahead * at_tip * np.outer(rows.rotation, columns.rotation)
                    mirrored = 0.0 if rows is columns else 1.0
                    yield _CoupledMatrix(rows.field.name, columns.field.name, quantity, 0, matrix, mirrored)

    # Loads --------------------------------------------------------------------------------------------

    def loads(self) -> Iterator[Load]:
        """Yield the loads due to accelerations of the axis, and of mass centres relative to the axis."""
        sums: dict[tuple[str, Quantity], np.ndarray] = {}
        for motion in self.motions:
            for quantity, coefficients, power in self._accelerated(motion):
                if not coefficients.any():
                    continue
                work = self._of_tip(coefficients, power) * motion.at_tip
                for value, moment in self._of_sections(coefficients, power):
                    work = work + value * self._load(moment, motion.conditions, motion.order)
                place = motion.field, quantity
                sums[place] = sums.get(place, 0.0) - work
        for quantity, vector, power in self.accelerations:
            for trial in self.tilting if vector[0] else ():
                if (moment := _pulled(self.scene.modelled_beam)[power][trial.field.direction]) is not None:
                    place = trial.field.name, quantity
                    work = vector[0] * self._load(moment, trial.conditions, 2)
                    sums[place] = sums.get(place, 0.0) - work
        for (name, quantity), vector in sums.items():
            if vector.any():
                yield Load(NAMES_OF_LOADS[quantity], name, vector, quantity)

    def _accelerated(self, motion: SectionMotion) -> Iterator[tuple[Quantity, np.ndarray, int]]:
        """Yield the work of each quantity of root motion on a unit motion: quantity, coefficients, power.

        The work is mass times x^power times the sum of four coefficients times the offsets c1, c2, t1, t2.
        The work of the axial force, which acts at the centre of tension, is a separate load.
        """
        of_mass = motion.beside * np.array([1.0, 1.0, 0.0, 0.0])
        for quantity, vector, power in self.accelerations:
            yield quantity, vector @ of_mass, power
        for quantity, matrix in self._beside_axis:
            yield quantity, motion.on_axis @ matrix, 0

    def _load(self, weight: Profile, conditions: RootConditions, order: int) -> np.ndarray:
        """Integrate a weight times the `order`-th x derivative of n functions with these conditions: (n,)."""
        return self.spaces.functions(conditions).load(weight, order) * self.scene.beam.length ** (1 - order)
