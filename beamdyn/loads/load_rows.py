"""Loads at stations as linear functions of the state, from virtual work on a beam that is cut there.

With a rigid displacement w of the part outboard of a cut (`beamdyn.loads.cut_beam`), the load R that does
work on it is

    R = f[w] - m[q'', w] - g[q', w] - k[q, w],

with the loads f of the root's motion and gravity, and the forms m, g, k of mass, gyroscopic terms and
geometric stiffness: the loads and the inertia of the part outboard, and the lever arms that the deflection
gives to the centrifugal forces.  No curvature enters.  The accelerations follow from the equations of motion
of the kept coordinates, so that R contains the moment of the kept shapes and the static moment of all others,
as in the mode-acceleration method: Craig and Kurdila, Fundamentals of Structural Dynamics (2006), section
11.4.  Modal damping (C q' with C = M Phi 2 zeta Omega Phi^T M) is a load on the beam in proportion to its
mass.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.equations.discretization import Cells, Discretization
from beamdyn.equations.effects import CAMBER, LARGE_DEFLECTION
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.equations.fields import FIELDS
from beamdyn.equations.fields.bending_shear_stretch import Stretch
from beamdyn.equations.fields.field import FieldEquations
from beamdyn.equations.root_motion import Quantity, RootMotion
from beamdyn.loads.cut_beam import CutQuadrature, CutSpace, CutSpaces
from beamdyn.loads.stations import SpanStations
from beamdyn.scene.scene import Scene
from beamdyn.scene.sections import weight_degree

STRAIGHT = "loads along the span of a beam with large deflection are not computed"
_LEAVE_OUT = "leave it out; root moments have it"
_OF_TAPERED = (
    "loads along the span include camber only if the width is constant, without piezoelectric layers"
)

ByQuantity: TypeAlias = "dict[Quantity, np.ndarray]"

_FIELD_OF_DIRECTION = "bending", "second bending"
# Fields whose motion does not displace the centres of mass, if these lie on the beam's axis.
_WITHOUT_RESULTANT = "torsion", "camber"
_DAMPING = {field.damping_name for field in FIELDS}


@dataclass(frozen=True)
class LoadRows:
    """Loads at S stations, of K components each, as linear functions of the state.

    The components are the axial force, the shear force in each modelled direction, and the bending moment in
    each; the method `through` converts them to other quantities.

    Parameters
    ----------
    load : dict of str to ndarray, shape (S, K)
        Load by each quantity of the root's motion on the undeformed beam.
    position, velocity, acceleration : dict of str to ndarray, shape (S, K, coordinates)
        Load per coordinate, velocity and acceleration, by each quantity of the root's motion.
    """

    load: ByQuantity
    position: ByQuantity
    velocity: ByQuantity
    acceleration: ByQuantity

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers S of stations and K of components."""
        return next(iter(self.load.values())).shape  # pyright: ignore[reportReturnType]

    def at(self, root: RootMotion, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Evaluate K loads at each of S stations and T times, (T, S, K), from root motion, q and v (T, n)."""
        total = np.zeros((len(q), *self.shape))
        for quantity, values in self.load.items():
            total += getattr(root, quantity)[:, None, None] * values
        for rows, state in ((self.position, q), (self.velocity, v)):
            for quantity, row in rows.items():
                total += getattr(root, quantity)[:, None, None] * np.moveaxis(row @ state.T, -1, 0)
        return total

    def per_coordinate(self, root: RootMotion) -> Iterator[np.ndarray]:
        """Yield loads per unit coordinate, (S, K, coordinates), at each time of the root motion."""
        for k in range(len(root.unity)):
            parts = (float(getattr(root, name)[k]) * row for name, row in self.position.items())
            yield sum(parts, np.zeros(()))

    def each(self, change: Callable[[np.ndarray], np.ndarray]) -> LoadRows:
        """Apply a function to all arrays of the rows, and return the resulting rows."""

        def changed(part: ByQuantity) -> ByQuantity:
            return {name: change(row) for name, row in part.items()}

        return LoadRows(*map(changed, self.parts))

    @property
    def parts(self) -> tuple[ByQuantity, ByQuantity, ByQuantity, ByQuantity]:
        """Four mappings of loads: by the root's motion alone, by position, velocity and acceleration."""
        return self.load, self.position, self.velocity, self.acceleration

    def chosen(self, station: np.ndarray, component: np.ndarray) -> LoadRows:
        """Select O single loads, returned as rows of O stations with one component each."""
        return self.each(lambda row: row[station, component][:, None])

    def through(self, matrix: np.ndarray) -> LoadRows:
        """Multiply the K loads of each station by its matrix (P, K) to get P other quantities."""
        return self.each(lambda row: np.einsum("spk,sk...->sp...", matrix, row))

    def in_motion(self, equations: Equations) -> LoadRows:
        """Eliminate the accelerations from the rows by the equations of motion."""
        terms = tuple(term for term in equations.terms if term.name not in _DAMPING)
        undamped = replace(equations, terms=terms)
        K, G, M = undamped.matrices
        assert set(M) == {"unity"} and set(self.acceleration) <= {"unity"}
        S, components = self.shape
        inertia = self.acceleration.get("unity", np.zeros((S, components, equations.size)))
        A = per_force(M["unity"], inertia)
        return LoadRows(
            _subtract(self.load, {name: -(A @ f) for name, f in undamped.vectors.items()}),
            _subtract(self.position, {name: A @ matrix for name, matrix in K.items()}),
            _subtract(self.velocity, {name: A @ matrix for name, matrix in G.items()}),
            {},
        )


def per_force(mass: np.ndarray, by_acceleration: np.ndarray) -> np.ndarray:
    """Convert rows per unit acceleration of n coordinates to rows per unit force on each coordinate.

    The rows (S, K, n) give K loads at S stations.

    The charge of a circuit has no mass, and its rows are 0.
    """
    massive, rows = mass.any(axis=0), by_acceleration.reshape(-1, len(mass))
    if massive.all():
        return np.linalg.solve(mass.T, rows.T).T.reshape(by_acceleration.shape)
    found = np.zeros_like(rows)
    found[:, massive] = np.linalg.solve(mass[np.ix_(massive, massive)].T, rows[:, massive].T).T
    return found.reshape(by_acceleration.shape)


def _subtract(first: ByQuantity, second: ByQuantity) -> ByQuantity:
    """Subtract the rows of each quantity of the root's motion; missing rows count as 0."""
    names: dict[Quantity, None] = dict.fromkeys([*first, *second])
    return {name: np.asarray(first.get(name, 0.0) - second.get(name, 0.0)) for name in names}


# Assembly by virtual work -------------------------------------------------------------------------


def span_rows(
    scene: Scene, discretization: Discretization, equations: Equations, stations: SpanStations
) -> LoadRows:
    """Assemble the loads at stations in the coordinates of given equations.

    Parameters
    ----------
    scene : Scene
        The scene, of a straight beam.
    discretization : Discretization
        Discretization of the scene's equations.
    equations : Equations
        Equations of the scene in this discretization, as they are or reduced.
    stations : SpanStations
        The stations, S of them.

    Returns
    -------
    LoadRows
        With 1 + 2 d components, d being the number of planes: the axial force [N], tension positive; the
        shear forces [N] in each direction across the deflected axis; the bending moments [N m], positive if
        they bend towards positive deflection.  Forces are those of the part outboard on the part inboard.
        Where sections camber, the last is the part of the moment due to their curvature across [N m].
    """
    _refuse_uncovered(scene)
    beam = scene.modelled_beam
    cells = discretization.cells(beam)
    quadrature = CutQuadrature(stations, Cells(cells.ends, cells.points + weight_degree(beam) // 2 + 1))
    without = "" if scene.physics.stretch else "axial_stiffness"
    spaces = CutSpaces(discretization.spaces(beam), quadrature, beam.length, without)
    stretched = Stretch().complete(scene.undamped)  # the equation of axial stretch gives the axial force
    unmoved = () if beam.has_offsets else _WITHOUT_RESULTANT
    modelled = (f for f in FIELDS if f.is_modelled(stretched) and f.name not in unmoved)
    assembled = {f.name: f.assemble(stretched, spaces) for f in modelled}
    directions = _FIELD_OF_DIRECTION[: equations.planes]
    # Displacements along the beam, and across it.
    moves = [(field, False) for field in (Stretch.name, *directions)]
    parts = []
    for field, turns in (*moves, *((field, True) for field in directions)):
        space, cuts = assembled[field].space, len(stations.xi)
        assert isinstance(space, CutSpace)
        first = space.trials if turns else space.size - cuts
        parts.append(_rows_of(assembled, equations, field, slice(first, first + cuts)))
    if scene.physics.camber:
        parts.append(_camber(scene, equations, stations))
    rows = LoadRows(*map(_stack, zip(*(part.parts for part in parts), strict=True)))
    return _across_deflected_axis(rows, equations, stations, beam.length)


def _camber(scene: Scene, equations: Equations, stations: SpanStations) -> LoadRows:
    """Build rows of the moment [N m] at S stations due to camber, the curvature across the width.

    It is nu E I/(1 - nu^2) times the curvature across, with Poisson's ratio nu.
    """
    section, at = scene.beam.section, stations.beside
    assert section is not None
    held = scene.beam.bending_stiffness * section.camber_stiffening * section.camber_ratio
    across = equations.curvature_across(at) * (2 / section.width(at)) ** 2
    return LoadRows({}, {"unity": (held(at) * across).T}, {}, {})


def _rows_of(
    assembled: Mapping[str, FieldEquations], equations: Equations, field: str, moved: slice
) -> LoadRows:
    """Build rows of the work of all loads and terms on one field's virtual displacements at S stations."""
    count = moved.stop - moved.start
    load: ByQuantity = {}
    by_order: tuple[ByQuantity, ...] = ({}, {}, {})
    for each in assembled.values():
        for f in (f for f in each.loads if f.rows == field and f.factor):
            load[f.quantity] = load.get(f.quantity, np.zeros(count)) + f.factor * f.vector[moved]
        for term in (t for t in each.terms if t.rows == field and t.factor and t.columns in equations.shapes):
            shape = equations.shapes[term.columns]
            total = by_order[term.order].setdefault(term.quantity, np.zeros((count, equations.size)))
            kept = term.matrix[moved, : len(shape.matrix)] @ shape.matrix
            total[:, equations.blocks[shape.block]] -= term.factor * kept
    return LoadRows(load, *by_order)


def _stack(parts: Sequence[ByQuantity]) -> ByQuantity:
    """Stack K rows of each quantity of the root's motion along a new second axis; missing rows are 0."""
    like: ByQuantity = {name: row for part in parts for name, row in part.items()}
    return {
        name: np.stack([part.get(name, np.zeros_like(row)) for part in parts], axis=1)
        for name, row in like.items()
    }


def _across_deflected_axis(
    rows: LoadRows, equations: Equations, stations: SpanStations, length: float
) -> LoadRows:
    """Subtract the axial force's contribution by the slope of the axis from forces in fixed directions."""
    position = dict(rows.position)
    for quantity, load in rows.load.items():
        tension = load[:, 0]
        if not tension.any():
            continue
        of_quantity = position.get(quantity, np.zeros((*rows.shape, equations.size))).copy()
        for direction in range(equations.planes):
            slope = equations.deflection(stations.beside, 1, direction).T / length
            of_quantity[:, 1 + direction] -= tension[:, None] * slope
        position[quantity] = of_quantity
    return replace(rows, position=position)


def barred_of_loads(scene: Scene) -> dict[str, str]:
    """Return the names of effects with which loads along the span cannot be computed, with the reasons."""
    uncovered = {CAMBER.name: _OF_TAPERED} if _lacks_camber(scene) else {}
    return {LARGE_DEFLECTION.name: STRAIGHT} | uncovered


def _lacks_camber(scene: Scene) -> bool:
    """Return whether loads with camber cannot be computed: for a tapered width, or a layered section."""
    section = scene.beam.section
    return scene.beam.electrodes is not None or bool(section is not None and section.width.degree)


def refuse_uncovered_camber(scene: Scene) -> None:
    """Refuse camber if loads along the span cannot be computed with it."""
    if scene.physics.camber and _lacks_camber(scene):
        instead = 'physics = "auto" has chosen camber: give the physics without it'
        remedy = _LEAVE_OUT if scene.physics_choice is None else instead
        raise InvalidValue("physics.camber", True, _OF_TAPERED, remedy)


def _refuse_uncovered(scene: Scene) -> None:
    """Refuse springs along the span and damping that is not modal: the rows do not contain their forces."""
    bound = "loads along the span cannot be computed with this input"
    if scene.beam.point_springs:
        raise InvalidValue("point_springs", len(scene.beam.point_springs), bound, _LEAVE_OUT)
    for name in ("mass_factor", "stiffness_factor", "tip_damper"):
        if value := getattr(scene.damping, name):
            raise InvalidValue(f"damping.{name}", value, bound, _LEAVE_OUT)
