"""Beam in space on a rotating carrier: its equations of motion, also linearized about any state.

Coordinates and elastic energy are taken from the displacement fields of the straight beam (bending in two
directions, shear, stretch, torsion); the trial functions of the fields give the strains here.  The inertial
forces due to the root's motion are exact.  The gyroscopic matrix follows from them: let p be the generalized
inertial force due to a unit angular acceleration, and E the derivative of p with respect to the coordinates;
the gyroscopic matrix per speed is E - E^T.

With the prebend angle b and the sweep angle a of a curved beam, the local axes are the root's axes rotated by
b about the third axis, then by -a about the second, so that the unloaded beam points along
(cos a cos b, cos a sin b, sin a).  The curvature is

    k1 = b' sin a,   k2 = -a',   k3 = b' cos a.

In shapes of arrays, n counts coordinates, m those in a reduced model, N Gauss points along the beam, and k
given positions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.polynomial import legendre

from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.equations.assembly import damping_terms
from beamdyn.equations.beam_in_space import bent_beam
from beamdyn.equations.beam_in_space.finite_rotations import (
    CONJUGATE,
    UNIT,
    product,
    quaternions_by_vectors,
    turn,
    turn_law,
    turn_tensors,
)
from beamdyn.equations.beam_in_space.moving_beam import Carrier, MovingBeam
from beamdyn.equations.beam_in_space.station_forces import BeamStations, Masses, StationForces
from beamdyn.equations.beam_in_space.tip_forces import TipForces, forces_at_tip
from beamdyn.equations.discretization import (
    CLAMPED,
    FIXED,
    ArcQuadrature,
    Discretization,
    RootConditions,
    Sampler,
)
from beamdyn.equations.equations_of_motion import Equations, Shape, SteadyPencil
from beamdyn.equations.fields.bending_shear_stretch import Bending, SecondBending, SecondShear, Shear
from beamdyn.equations.fields.field import Deflection, Load, Term
from beamdyn.equations.ritz import Ritz
from beamdyn.equations.root_motion import Quantity, RootMotion, root_motion
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.motion.base import MotionSample
from beamdyn.scene.mount import aligned_cos_sin, exact_cos_sin
from beamdyn.scene.profile import ONE
from beamdyn.scene.scene import Scene
from beamdyn.scene.section_matrices import split_mass
from beamdyn.scene.sections import offset_components

_AXES = np.eye(3)
_KEPT = 4  # number of recently computed states of the beam that are cached
# Signs of the `STRAINS`: -1 if a positive displacement of the field rotates sections about a negative axis.
_SIGNS = 1.0, 1.0, 1.0, -1.0, -1.0, 1.0
# Words for the two directions of deflection, which end the names of a bent beam's deflections.
_DIRECTIONS = "in the direction of bending", "across"
_ROOT: tuple[Quantity, ...] = "root_axial", "root_transverse", "root_across"
# Quantities of root motion that load the beam.
QUANTITIES: tuple[Quantity, ...] = "speed_squared", "acceleration", *_ROOT


def _strains_of_fields(scene: Scene) -> dict[str, tuple[int, int, RootConditions]]:
    """Find each displacement field's strain: index in `STRAINS`, derivative order, and root conditions."""
    mount, warps = scene.mount, scene.modelled_beam.warping_stiffness is not None
    root, resists = (CLAMPED, "warping_stiffness") if warps else (FIXED, "torsion_stiffness")
    return {
        "bending": (5, 2, Bending().conditions(mount)),
        "second bending": (4, 2, SecondBending().conditions(mount)),
        "shear": (1, 1, Shear().conditions(mount)),
        "second shear": (2, 1, SecondShear().conditions(mount)),
        "stretch": (0, 1, FIXED._replace(stiffness="axial_stiffness")),
        "torsion": (3, 1, root._replace(stiffness=resists)),
    }


def assemble_beam_in_space(scene: Scene, discretization: Discretization, linear: Equations) -> RotatingBeam:
    """Assemble a scene's equations for large deflection in space, from those of the straight beam."""
    beam = scene.modelled_beam
    quadrature, spaces = ArcQuadrature(discretization.cells(beam)), discretization.spaces(beam)
    stations, xi, n = BeamStations(quadrature, beam.length, beam.lumps[0]), quadrature.xi, linear.size
    functions, known = np.zeros((n, 6, len(xi))), _strains_of_fields(scene)
    hinges, slopes = np.zeros((n, 3)), np.zeros((n, stations.sections))
    for name, place in linear.blocks.items():
        component, order, conditions = known[name]
        of_field, of_coordinates = spaces.functions(conditions), linear.shapes[name].matrix.T
        strains = of_coordinates @ of_field.evaluate(xi, order) / beam.length**order
        functions[place, component] = _SIGNS[component] * strains
        if order == 2:  # a field of bending, whose functions may rotate the root
            sections = np.array([0.0, *xi, 1.0])
            at_root, *turned = (of_coordinates @ of_field.evaluate(sections, 1)).T / beam.length
            hinges[place, component - 3] = _SIGNS[component] * at_root
            slopes[place] += (_SIGNS[component] > 0) * np.array(turned).T
    if beam.matrices is None:
        # Functions of bending also stretch the axis, so that the line of centres of tension keeps its length.
        offset, across = _tension(beam, xi)
        functions[:, 0] += offset * functions[:, 5] - across * functions[:, 4]
    curvature, kinks = curve_of_axis(beam, quadrature)
    initial, masses = np.concatenate([np.zeros_like(curvature), curvature]), _masses(scene, stations)
    law = linear.matrices[0]["unity"], linear.matrices[1].get("unity", np.zeros((n, n)))
    ends = kinks, None if np.isinf(scene.mount.root_stiffnesses).all() else hinges, slopes
    model = bent_beam.BeamInSpace(stations, masses, initial, functions, *law, *_fibres(beam, xi), *ends)
    (c, s), (cosine, sine) = aligned_cos_sin(scene.mount.bending_angle), exact_cos_sin(scene.mount.precone)
    axis, load = -np.array([sine, cosine * s, cosine * c]), forces_at_tip(scene, model.at(np.zeros(n)))
    rotating = RotatingBeam(model, linear, axis, load)
    if beam.matrices is not None:
        rotating = _with_law(rotating, scene, discretization)
    elif not (initial.any() or kinks[:, 1:].any()):  # the axis is straight, as in the linear equations
        return rotating
    return _with_damping(rotating, scene) if scene.is_damped else rotating


def _with_law(rotating: RotatingBeam, scene: Scene, discretization: Discretization) -> RotatingBeam:
    """Replace a beam's stiffness by that of its 6 x 6 section matrices, and its damping by 0."""
    beam, model, linear = scene.modelled_beam, rotating.beam, rotating.linear
    assert beam.matrices is not None
    xi = model.stations.quadrature.xi
    law = turn_law(_turned_sections(beam, xi)[..., :-1], beam.matrices.at("stiffness", xi))
    if isinstance(discretization, Ritz) and not discretization.on_each_segment:
        size = discretization.functions
        blocks = {name: slice(k * size, (k + 1) * size) for k, name in enumerate(linear.blocks)}
        shapes = {name: Shape(name, np.eye(size)) for name in blocks}
        linear = replace(linear, blocks=blocks, loads=(), shapes=shapes, sections=(), coarse=None)
        components = [_strains_of_fields(scene)[name][0] for name in linear.blocks]
        strains = _strains_by_forces(model, law, size)[components]
        model = replace(model, functions=strains.reshape(linear.size, *law.shape[1:]), slopes=None)
    K = bent_beam.elastic_stiffness(model.stations, model.functions, law)
    linear = replace(linear, terms=(*terms_of_blocks(linear, "stiffness", K, 0),))
    return replace(rotating, beam=replace(model, stiffness=K, damping=np.zeros_like(K)), linear=linear)


def _with_damping(rotating: RotatingBeam, scene: Scene) -> RotatingBeam:
    """Replace a beam's damping by the damping computed for the unloaded beam with its curved axis."""
    kept = (t for t in rotating.linear.terms if (t.order, t.quantity) != (1, "unity"))
    undamped = replace(rotating, linear=replace(rotating.linear, terms=(*kept,)))
    linear, damping = undamped.linear, damping_terms(undamped.about_straight, scene)
    linear = replace(linear, terms=(*linear.terms, *damping))
    none = np.zeros_like(rotating.beam.stiffness)
    damped = replace(rotating.beam, damping=linear.matrices[1].get("unity", none))
    return replace(undamped, beam=damped, linear=linear)


def _strains_by_forces(model: bent_beam.BeamInSpace, law: np.ndarray, count: int) -> np.ndarray:
    """Compute strains (6, n, 6, points) due to six forces and moments that vary along x as n polynomials.

    The first axis counts forces and moments, the second the polynomials, and the third the strains.  The
    polynomials describe components in the axes at the root, which are smooth over the beam; components in
    section axes rotate with the axis of the beam.
    """
    xi, unloaded = model.stations.quadrature.xi, model.at(np.zeros(model.size)).rotations[..., :-1]
    compliance = np.linalg.inv(np.moveaxis(law, 2, 0)).reshape(-1, 6, 2, 3)
    of_each = np.einsum("jaxb,cbj->xcaj", compliance, unloaded).reshape(law.shape)
    return of_each[:, None] * legendre.legvander(2 * xi - 1, count - 1).T[:, None]


def terms_of_blocks(
    equations: Equations, name: str, matrix: np.ndarray, order: int, quantity: Quantity = "unity"
) -> Iterator[Term]:
    """Split a matrix into terms of the equations of motion, one for each pair of coordinate blocks."""
    for row, i in equations.blocks.items():
        for column, j in equations.blocks.items():
            if matrix[i, j].any():
                yield Term(name, row, column, order, matrix[i, j], quantity)


def _masses(scene: Scene, stations: BeamStations) -> Masses:
    """Collect the masses of a scene's beam at stations: of sections, of the tip body, and point masses."""
    beam, tip, xi = scene.modelled_beam, scene.beam.tip or TipMass(0.0), stations.quadrature.xi
    weights = stations.quadrature.weights * beam.length
    m, centre, inertia = _masses_of_sections(beam, xi)
    body = np.diag([tip.axial_inertia, tip.inertia_about_bending_direction, tip.inertia])
    inertia = np.concatenate([weights * inertia, body[..., None]], axis=2)
    centre = np.column_stack([centre, [tip.offset, 0.0, tip.offset_across]])
    axes = _turned_sections(beam, xi)
    mass = np.concatenate([weights * m, [tip.mass], beam.lumps[1]])
    return Masses(mass, turn(axes, centre), turn_tensors(axes, inertia))


def _masses_of_sections(beam: Beam, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Evaluate mass per length, mass centres (3, points) and inertia (3, 3, points), in section axes."""
    if beam.matrices is not None:
        return split_mass(beam.matrices.at("mass", xi))
    none = np.zeros_like(xi)
    given = beam.rotary_inertia, beam.second_rotary_inertia, beam.mass_offset
    first, second, across = (none if each is None else each(xi) for each in given)
    inertia = np.stack([first + second, second, first])[:, None] * _AXES[..., None]
    return beam.mass_per_length(xi), np.stack([none, none, across]), inertia


def _tension(beam: Beam, xi: np.ndarray) -> np.ndarray:
    """Evaluate offsets of tension centres [m] along e2, the direction of bending, and e3 (rows), at x/L."""
    if beam.matrices is not None:
        K = beam.matrices.at("stiffness", xi)
        return np.stack([-K[0, 5], K[0, 4]]) / K[0, 0]
    return np.stack([np.zeros_like(xi) if c is None else c(xi) for c in offset_components(beam)[2:]])


def _fibres(beam: Beam, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Evaluate the mean squared distance of fibres from the axis [m2] and the pretwist at xi = x/L.

    The distribution of stiffness about the centre of tension is assumed to equal that of mass about the
    centre of mass; without torsion it has no effect.
    """
    twist = np.zeros_like(xi) if beam.twist is None else beam.twist.derivative()(xi) / beam.length
    if beam.torsion_stiffness is None:
        return np.zeros_like(xi), twist
    assert beam.rotary_inertia is not None and beam.second_rotary_inertia is not None
    polar = beam.rotary_inertia(xi) + beam.second_rotary_inertia(xi)
    return polar / beam.mass_per_length(xi) + (_tension(beam, xi) ** 2).sum(axis=0), twist


def _turned_sections(beam: Beam, xi: np.ndarray) -> np.ndarray:
    """Compute the section axes (3, 3, points) of the unloaded, pretwisted beam at xi and at the tip."""
    twist = np.zeros(len(xi) + 1) if beam.twist is None else np.append(beam.twist(xi), beam.tip_twist)
    axes = np.zeros((3, 3, len(twist)))
    axes[0, 0] = 1.0
    axes[1:, 1:] = [[np.cos(twist), -np.sin(twist)], [np.sin(twist), np.cos(twist)]]
    return axes


@dataclass(frozen=True)
class RotatingBeam(FieldsOnly):
    """Equations of motion of a beam in space on a rotating carrier.

    Parameters
    ----------
    beam : BeamInSpace
        The beam.
    linear : Equations
        Equations of the straight beam in the same coordinates, one block for each displacement field; this
        beam has the same functions, elastic stiffness and damping.
    axis : ndarray, shape (3,)
        Components along e1, e2, e3 of the axis of the carrier's positive rotation.
    load : TipForces or None
        Load at the tip.
    """

    beam: bent_beam.BeamInSpace
    linear: Equations
    axis: np.ndarray
    load: TipForces | None = None

    @cached_property
    def turning(self) -> dict[Quantity, float]:
        """Quantities of the root's motion in steady rotation, divided by the squared speed."""
        root = root_motion(self.linear.mount, MotionSample.steady(1.0))
        return {name: float(getattr(root, name)) for name in QUANTITIES}

    @property
    def straight(self) -> BentState:
        """State of the beam without deflection and without a load at its tip."""
        return (replace(self, load=None) if self.load else self).at(np.zeros(self.beam.size))

    @cached_property
    def about_straight(self) -> Equations:
        """Equations of small motions about the straight beam, without a load at its tip."""
        return self.straight.linearized()

    def reduced(self, modal: Equations) -> RotatingBeam:
        """Return the beam in the modal coordinates to which its linearized equations were reduced."""
        return replace(self, beam=self.beam.reduced(self.basis_of(modal)), linear=modal)

    def basis_of(self, modal: Equations) -> np.ndarray:
        """Compute the basis of a reduced model, in columns, expressed in the coordinates of the beam.

        The model is reduced from equations that are linearized about a state.
        """
        basis = np.zeros((self.beam.size, modal.size))
        for name, place in self.linear.blocks.items():
            # Named with its direction, a shape is in the beam's coordinates; else that of the block is.
            shape = modal.shapes.get(f"{name}, {_DIRECTIONS[0]}", modal.shapes[name])
            basis[place, modal.blocks[shape.block]] = shape.matrix
        return basis

    def nearest(self, other: RotatingBeam, q: np.ndarray) -> np.ndarray:
        """Find coordinates whose strains are nearest to those of the beam `other` at its coordinates q."""
        own, rule = self.beam, self.beam.stations.quadrature
        between = other.beam.stations.quadrature.interpolate_to(rule.xi)
        strains = np.tensordot(q, other.beam.functions, 1) @ between.T * np.sqrt(rule.weights)
        matrix = (own.functions * np.sqrt(rule.weights)).reshape(own.size, -1)
        if own.hinges is not None and other.beam.hinges is not None:
            matrix, strains = np.c_[matrix, own.hinges], np.r_[strains.ravel(), q @ other.beam.hinges]
        return np.linalg.lstsq(matrix.T, strains.ravel())[0]

    def at(self, q: np.ndarray) -> BentState:
        """Return the state of the beam with coordinates q; recent states are cached."""
        return self._states(q.tobytes(), q.shape)

    @cached_property
    def _states(self) -> Callable[[bytes, tuple[int, ...]], BentState]:
        return lru_cache(_KEPT)(lambda q, n: BentState(self, self.beam.at(np.frombuffer(q).reshape(n))))

    def curvature(self, q: np.ndarray, xi: np.ndarray) -> np.ndarray:
        """Compute the curvature [1/m] in the direction of bending, at coordinates q and at xi = x/L."""
        return q @ self.beam.functions[:, -1] @ self.beam.stations.quadrature.interpolate_to(xi).T

    def tip_angle(self, q: np.ndarray) -> float:
        """Compute the angle between the tip section's axis and e1 [rad]; signed for bending in one plane."""
        if self.beam.is_planar:
            return float(q @ self.beam.angles[:, -1])
        along = self.beam.at(q).rotations[:, 0, -1]
        return float(np.arctan2(np.hypot(along[1], along[2]), along[0]))


@dataclass(frozen=True)
class BentState(FieldsOnly):
    """State of a deformed beam on a rotating carrier, at given coordinates.

    Parameters
    ----------
    of : RotatingBeam
        Equations of motion.
    bent : BentBeam
        The beam deformed by the coordinates.
    """

    of: RotatingBeam
    bent: bent_beam.BentBeam

    def under(self, values: Mapping[Quantity, float]) -> bent_beam.Work:
        """Compute the virtual work of inertial forces for given quantities of root motion (cached).

        If `values` has a number for "unity", this number times the tip load acts in place of inertial forces.
        Signs are as on the left-hand side of the equations of motion.
        """
        key = tuple(values.items())
        if key not in self._known:
            self._known[key] = self.bent.under(self._forces(values))
        return self._known[key]

    @cached_property
    def _known(self) -> dict[tuple[tuple[Quantity, float], ...], bent_beam.Work]:
        # A dictionary, since a function with a cache would refer to this state and so keep its arrays in
        # memory.
        return {}

    def _forces(self, values: Mapping[Quantity, float]) -> StationForces:
        """Compute the forces at the stations for given quantities of root motion: the inertial forces.

        If `values` has a number for "unity", return minus this number times the tip load instead.
        """
        if "unity" in values:
            assert self.of.load is not None
            return self.of.load.on(self.bent, -values["unity"])
        root = np.array([values.get(quantity, 0.0) for quantity in _ROOT])
        turning = values.get("speed_squared", 0.0), values.get("acceleration", 0.0)
        return self.bent.masses.carried(self.of.axis, *turning, root)

    def work(self, rates: np.ndarray, accelerations: np.ndarray, root: RootMotion) -> np.ndarray:
        """Compute residuals of the equations of motion; `rates` and `accelerations` have the shape of q."""
        carrier = Carrier.of_root(self.of.axis, root)
        return MovingBeam(self.bent, rates, carrier, self.of.load).residual(accelerations)

    @cached_property
    def gyroscopic(self) -> np.ndarray:
        """Gyroscopic matrix at this state, divided by the speed."""
        euler = self.under({"acceleration": 1.0}).change
        return euler - euler.T

    def steady(self) -> SteadyPencil:
        """Return the equations of small motions at steady speed; `f2` is the centrifugal load."""
        linear, (force, K2) = self.of.linear, self.under(self.of.turning)
        K0 = linear.matrices[0]["unity"] + (self.under({"unity": 1.0}).change if self.of.load else 0.0)
        C = linear.matrices[1].get("unity", np.zeros_like(K0))
        return SteadyPencil(self.bent.mass, C, self.gyroscopic, K0, K2, -force, linear.shift, linear.planes)

    def linearized(self) -> Equations:
        """Return the equations of small motions about this state.

        One of the loads is minus the elastic force of the state.  In equilibrium the loads add up to 0.
        """
        linear = self.of.linear
        terms = [
            *terms_of_blocks(linear, "mass", self.bent.mass, 2),
            *terms_of_blocks(linear, "Coriolis coupling", self.gyroscopic, 1, "speed"),
            *(t for t in linear.terms if t.quantity == "unity" and t.order < 2),
        ]
        loads = [*self._loads("elastic force", self.of.beam.stiffness @ self.bent.q, "unity")]
        for quantity in QUANTITIES if self.of.load is None else ("unity", *QUANTITIES):
            cause = "the load at the tip" if quantity == "unity" else quantity
            work, change = self.under({quantity: 1.0})
            terms += terms_of_blocks(linear, f"stiffness by {cause}", change, 0, quantity)
            loads += self._loads(f"load by {cause}", work, quantity)
        shapes, deflections = {}, {}
        for name, place in linear.blocks.items():
            for direction in range(linear.planes):
                own = linear.deflections.get(name)
                key = name if own and own.direction == direction else f"{name}, {_DIRECTIONS[direction]}"
                deflections[key] = self._deflection(place, direction)
                shapes[key] = Shape(name, np.eye(place.stop - place.start))
        shapes, given = linear.shapes | shapes, {"terms": (*terms,), "loads": (*loads,)}
        return replace(linear, deflections=deflections, shapes=shapes, coarse=None, **given)

    def _loads(self, name: str, vector: np.ndarray, quantity: Quantity) -> Iterator[Load]:
        """Split a left-hand-side force into loads on the right-hand side, one for each coordinate block."""
        for row, i in self.of.linear.blocks.items():
            yield Load(name, row, vector[i], quantity, -1.0)

    def _deflection(self, place: slice, direction: int) -> Deflection:
        """Build the deflection in one direction due to one block of coordinates, with its inertial loads."""
        axis = np.array([-_AXES[2], _AXES[1]][direction])
        by_root = self.under({_ROOT[1 + direction]: 1.0}).work[place]
        by_turning = -self.bent.work(self.bent.masses.carried(axis, acceleration=1.0).force)[place]
        functions = DeflectedFunctions(self.bent, place, direction)
        return Deflection(functions, by_root, by_turning, np.zeros_like(by_root), direction)


@dataclass(frozen=True)
class DeflectedFunctions(FieldsOnly):
    """Changes of a bent beam's deflection in one direction per unit coordinate, as functions of x/L.

    Parameters
    ----------
    bent : BentBeam
        The bent beam.
    place : slice
        Slice of the coordinates of one block.
    direction : int
        0 for the direction of bending at the root, 1 for the perpendicular direction.
    """

    bent: bent_beam.BentBeam
    place: slice
    direction: int

    @property
    def size(self) -> int:
        """Number of functions: one for each coordinate of the block."""
        return self.place.stop - self.place.start

    def end(self, order: int) -> np.ndarray:
        """Evaluate the functions or their slopes at the tip; see `evaluate`."""
        at_tip = self.bent.tip_motions[self.place, 1 + self.direction]
        return self.evaluate(np.ones(1), order)[:, 0] if order else at_tip

    def evaluate(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Evaluate functions (order 0) or their derivatives with respect to x/L (order 1), in rows, at xi."""
        if order > 1:
            raise ValueError("only deflection and slope, order 0 and 1, are known for a deflected beam")
        stations = self.bent.beam.stations
        moving = self.bent.displacement_rates[self.place, 1 + self.direction]
        rule = stations.quadrature.interpolate_to if order else stations.quadrature.integrate_to
        return stations.length * moving @ rule(xi).T


_STRAIGHT = ONE.scaled(0.0)


def curve_of_axis(beam: Beam, quadrature: ArcQuadrature) -> tuple[np.ndarray, np.ndarray]:
    """Compute the axis' curvature (3, N) [1/m] at N Gauss points, and its kinks.

    The kinks (cells, 4) are unit quaternions of the axis' rotation at the beginning of each cell.
    """
    cells, sweep, prebend = quadrature.cells, beam.sweep or _STRAIGHT, beam.prebend or _STRAIGHT
    at_points = Sampler.on_cells(cells)
    a = at_points(sweep)
    swept, bent = (at_points(angle.derivative()) / beam.length for angle in (sweep, prebend))
    curvature = np.stack([bent * np.sin(a), -swept, bent * np.cos(a)])
    # Angles just inside both ends of each cell, as properties may jump between cells.
    a, b = (np.stack(angle.split(tuple(cells.ends)).end_values())[..., None] for angle in (sweep, prebend))
    begin, end = product(quaternions_by_vectors(b * [0, 0, 1]), quaternions_by_vectors(a * [0, -1, 0]))
    return curvature, product(np.concatenate([UNIT[None], end[:-1]]) * CONJUGATE, begin)
