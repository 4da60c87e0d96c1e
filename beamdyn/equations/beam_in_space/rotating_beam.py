"""The beam in space on a rotating carrier: its equations of motion, also linearized about any state.

The coordinates and the elastic energy are those of the fields of the straight beam (bending in two
directions, shear, stretch, torsion), whose functions are here those of the strains.  What the root's motion
does to the masses is exact.  The Coriolis forces need no derivation of their own: with the generalized
inertial force p by a unit angular acceleration, which is the angular momentum per coordinate, and E its
derivative by the coordinates, the gyroscopic matrix per speed is E - E^T.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.equations.assembly import damping_terms
from beamdyn.equations.beam_in_space import bent_beam
from beamdyn.equations.beam_in_space.axis_of_beam import curve_of_axis
from beamdyn.equations.beam_in_space.finite_rotations import turn, turn_law, turn_tensors
from beamdyn.equations.beam_in_space.moving_beam import Carrier, MovingBeam
from beamdyn.equations.beam_in_space.station_forces import BeamStations, Masses
from beamdyn.equations.beam_in_space.tip_forces import TipForces, forces_at_tip
from beamdyn.equations.discretization import CLAMPED, FIXED, ArcQuadrature, Discretization, RootConditions
from beamdyn.equations.equations_of_motion import Equations, Shape, SteadyPencil
from beamdyn.equations.fields.bending_shear_stretch import Bending, SecondBending, SecondShear, Shear
from beamdyn.equations.fields.field import Deflection, Load, Term
from beamdyn.equations.ritz import Ritz
from beamdyn.equations.root_motion import Quantity, RootMotion, root_motion
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.motion import MotionSample
from beamdyn.scene.mount import aligned_cos_sin, exact_cos_sin
from beamdyn.scene.scene import Scene
from beamdyn.scene.section_matrices import split_mass
from beamdyn.scene.sections import offset_components

_AXES = np.eye(3)
_KEPT = 4  # number of states of the beam that are cached
_HINGES = "curvature", "second curvature"  # strains of the fields whose functions turn the root
# Directions of the deflection in the names of a bent beam's blocks.
_DIRECTIONS = "in the direction of bending", "across"
_ROOT: tuple[Quantity, ...] = "root_axial", "root_transverse", "root_across"


class _Strain(NamedTuple):
    """The strain that a field causes: name, order of derivative by x, conditions at the root, and sign."""

    name: str
    order: int
    conditions: RootConditions
    sign: float = 1.0


def _strains_of_fields(scene: Scene) -> dict[str, _Strain]:
    """Find the strain that each field causes; a sign of -1 where it turns sections about a negative axis."""
    mount, warps = scene.mount, scene.modelled_beam.warping_stiffness is not None
    torsion = CLAMPED if warps else FIXED
    resists = "warping_stiffness" if warps else "torsion_stiffness"
    return {
        "bending": _Strain("curvature", 2, Bending().conditions(mount)),
        "second bending": _Strain("second curvature", 2, SecondBending().conditions(mount), -1.0),
        "shear": _Strain("shear", 1, Shear().conditions(mount)),
        "second shear": _Strain("second shear", 1, SecondShear().conditions(mount)),
        "stretch": _Strain("stretch", 1, FIXED._replace(stiffness="axial_stiffness")),
        "torsion": _Strain("twist rate", 1, torsion._replace(stiffness=resists), -1.0),
    }


def axis_of_rotation(scene: Scene) -> np.ndarray:
    """Compute the axis (3,) of positive rotation of the carrier along e1, e2, e3."""
    (c, s), (cosine, sine) = aligned_cos_sin(scene.mount.bending_angle), exact_cos_sin(scene.mount.precone)
    return -np.array([sine, cosine * s, cosine * c])


def assemble_beam_in_space(scene: Scene, discretization: Discretization, linear: Equations) -> RotatingBeam:
    """Assemble the equations of a scene for large deflection in space, over those of the straight beam."""
    beam = scene.modelled_beam
    quadrature, spaces = ArcQuadrature(discretization.cells(beam)), discretization.spaces(beam)
    stations, length = BeamStations(quadrature, beam.length, beam.lumps[0]), beam.length
    functions = np.zeros((linear.size, 6, len(quadrature.xi)))
    known, slopes = _strains_of_fields(scene), np.zeros((linear.size, stations.sections + 1))
    hinges = np.zeros((linear.size, 3))
    for name, place in linear.blocks.items():
        strain = known[name]
        of_field = spaces.functions(strain.conditions)
        along = of_field.evaluate(quadrature.xi, strain.order)
        functions[place, bent_beam.STRAINS.index(strain.name)] = strain.sign * along / length**strain.order
        if strain.name in _HINGES:
            turn_of_root = of_field.evaluate(np.zeros(1), 1)[:, 0] / length
            hinges[place, bent_beam.STRAINS.index(strain.name) - 3] = strain.sign * turn_of_root
        if strain.name == "curvature":
            slopes[place] = of_field.evaluate(np.concatenate([[0.0], quadrature.xi, [1.0]]), 1) / length
    if beam.matrices is None:
        # Stretch is added to bending, so that the lines through the centres of tension keep their lengths.
        offset, across = _tension(beam, quadrature.xi)
        functions[:, 0] += offset * functions[:, 5] - across * functions[:, 4]
    curvature, kinks = curve_of_axis(beam, quadrature)
    nothing = np.zeros((linear.size, linear.size))
    model = bent_beam.BeamInSpace(
        stations,
        _masses(scene, stations),
        np.concatenate([np.zeros((3, len(quadrature.xi))), curvature]),
        functions,
        linear.matrices[0]["unity"],
        linear.matrices[1].get("unity", nothing),
        *_fibres(beam, quadrature.xi),
        kinks,
        None if np.isinf(scene.mount.root_stiffnesses).all() else hinges,
        slopes[:, 1:],
    )
    load = forces_at_tip(scene, model.at(np.zeros(linear.size)))
    rotating = RotatingBeam(model, linear, axis_of_rotation(scene), load)
    return rotating if beam.matrices is None else _with_law(rotating, scene, discretization)


def _with_law(rotating: RotatingBeam, scene: Scene, discretization: Discretization) -> RotatingBeam:
    """Replace stiffness and modal damping of the beam by those of its 6 x 6 section matrices."""
    beam, model, linear = scene.modelled_beam, rotating.beam, rotating.linear
    assert beam.matrices is not None
    xi = model.stations.quadrature.xi
    law = turn_law(_turned_sections(beam, xi)[..., :-1], beam.matrices.at("stiffness", xi))
    if isinstance(discretization, Ritz) and not discretization.on_each_segment:
        linear = _with_blocks_of(linear, discretization.functions)
        strains = [bent_beam.STRAINS.index(_strains_of_fields(scene)[name].name) for name in linear.blocks]
        model = replace(model, functions=_strains_by_forces(model, law, discretization.functions)[strains])
        model = replace(model, functions=model.functions.reshape(linear.size, *law.shape[1:]), slopes=None)
    K = bent_beam.elastic_stiffness(model.stations, model.functions, law)
    terms, none = [*terms_of_blocks(linear, "stiffness", K, 0)], np.zeros_like(K)
    undamped = replace(
        rotating,
        beam=replace(model, stiffness=K, damping=none),
        linear=replace(linear, terms=(*terms,)),
    )
    if not scene.is_damped:
        return undamped
    terms += damping_terms(undamped.about_straight, scene)
    damped = replace(linear, terms=(*terms,))
    damping = damped.matrices[1]["unity"]
    return replace(undamped, beam=replace(undamped.beam, damping=damping), linear=damped)


def _with_blocks_of(linear: Equations, size: int) -> Equations:
    """Return equations without terms and loads, whose blocks have the same names and a given size each."""
    blocks = {name: slice(k * size, (k + 1) * size) for k, name in enumerate(linear.blocks)}
    shapes = {name: Shape(name, np.eye(size)) for name in blocks}
    return replace(linear, blocks=blocks, terms=(), loads=(), shapes=shapes, sections=(), coarse=None)


def _strains_by_forces(model: bent_beam.BeamInSpace, law: np.ndarray, count: int) -> np.ndarray:
    """Compute the strains (6, n, 6, N) by each of six forces and moments that varies as one of n polynomials.

    The polynomials, over the whole beam, are components in space, which are smooth; components in the axes of
    the sections turn with the axis of the beam.
    """
    xi, unloaded = model.stations.quadrature.xi, model.at(np.zeros(model.size)).rotations[..., :-1]
    back = np.zeros_like(law)
    back[:3, :3] = back[3:, 3:] = unloaded.swapaxes(0, 1)
    compliance = np.linalg.inv(np.moveaxis(law, 2, 0)) @ np.moveaxis(back, 2, 0)
    each = legendre.legvander(2 * xi - 1, count - 1).T
    return each[:, None] * np.moveaxis(compliance, 0, 2).swapaxes(0, 1)[:, None]


def terms_of_blocks(
    equations: Equations, name: str, matrix: np.ndarray, order: int, quantity: Quantity = "unity"
) -> Iterator[Term]:
    """Split a matrix (n, n) into terms of the equations of motion, one for each pair of blocks."""
    for row, i in equations.blocks.items():
        for column, j in equations.blocks.items():
            if matrix[i, j].any():
                yield Term(name, row, column, order, matrix[i, j], quantity)


def _masses(scene: Scene, stations: BeamStations) -> Masses:
    """Gather the masses of a scene's beam at stations: of sections, of the tip body, and point masses."""
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
    """Evaluate mass per length (N,), centres (3, N) and inertia (3, 3, N) in the axes of sections, at xi."""
    if beam.matrices is not None:
        return split_mass(beam.matrices.at("mass", xi))
    none = np.zeros_like(xi)
    given = beam.rotary_inertia, beam.second_rotary_inertia, beam.mass_offset
    first, second, across = (none if each is None else each(xi) for each in given)
    inertia = np.stack([first + second, second, first])[:, None] * _AXES[..., None]
    return beam.mass_per_length(xi), np.stack([none, none, across]), inertia


def _tension(beam: Beam, xi: np.ndarray) -> np.ndarray:
    """Evaluate offsets (2, N) of centres of tension [m] in the direction of bending and across, at xi."""
    if beam.matrices is not None:
        K = beam.matrices.at("stiffness", xi)
        return np.stack([-K[0, 5], K[0, 4]]) / K[0, 0]
    return np.stack([np.zeros_like(xi) if c is None else c(xi) for c in offset_components(beam)[2:]])


def _fibres(beam: Beam, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Evaluate the mean square distance (N,) of fibres from the axis, and the pretwist (N,), at xi.

    The distribution of stiffness about the centre of tension is taken to be that of mass about the centre of
    mass; without torsion it does not matter.
    """
    twist = np.zeros_like(xi) if beam.twist is None else beam.twist.derivative()(xi) / beam.length
    if beam.torsion_stiffness is None:
        return np.zeros_like(xi), twist
    assert beam.rotary_inertia is not None and beam.second_rotary_inertia is not None
    polar = beam.rotary_inertia(xi) + beam.second_rotary_inertia(xi)
    beside = (_tension(beam, xi) ** 2).sum(axis=0)
    return polar / beam.mass_per_length(xi) + beside, twist


def _turned_sections(beam: Beam, xi: np.ndarray) -> np.ndarray:
    """Compute the axes (3, 3, N + 1) of unloaded sections at xi (N,) and at the tip, turned by the twist."""
    twist = np.zeros(len(xi) + 1) if beam.twist is None else np.append(beam.twist(xi), beam.tip_twist)
    axes = np.zeros((3, 3, len(twist)))
    axes[0, 0] = 1.0
    axes[1:, 1:] = [[np.cos(twist), -np.sin(twist)], [np.sin(twist), np.cos(twist)]]
    return axes


@dataclass(frozen=True)
class RotatingBeam(FieldsOnly):
    """Equations of motion of a beam in space on a carrier.

    Parameters
    ----------
    beam : BeamInSpace
        The beam.
    linear : Equations
        Equations of the same coordinates by the fields of the straight beam, each of which is a block: their
        functions, elastic stiffness and damping are those of this beam.
    axis : ndarray, shape (3,)
        Axis of positive rotation of the carrier along e1, e2, e3.
    load : TipForces or None
        Load at the tip.
    """

    beam: bent_beam.BeamInSpace
    linear: Equations
    axis: np.ndarray
    load: TipForces | None = None

    @property
    def quantities(self) -> tuple[Quantity, ...]:
        """Quantities of the root's motion that load the beam, such as its acceleration along an axis."""
        return "speed_squared", "acceleration", *_ROOT

    @property
    def length(self) -> float:
        """Length of the beam [m]."""
        return self.beam.length

    @property
    def size(self) -> int:
        """Number n of coordinates."""
        return self.beam.size

    @property
    def angles(self) -> np.ndarray:
        """Measure of changes of the shape per coordinate, shape (n, k): see `BeamInSpace.angles`."""
        return self.beam.angles

    @property
    def stiffness(self) -> np.ndarray:
        """Elastic stiffness matrix, shape (n, n)."""
        return self.beam.stiffness

    @cached_property
    def turning(self) -> dict[Quantity, float]:
        """Quantities of the root's motion per squared speed of steady rotation, but for those that are 0."""
        root = root_motion(self.linear.mount, MotionSample.steady(1.0))
        values = ((quantity, float(getattr(root, quantity))) for quantity in self.quantities)
        return {quantity: value for quantity, value in values if value}

    @cached_property
    def about_straight(self) -> Equations:
        """Equations of small motions about the straight beam, without a load at its tip."""
        return self.straight.linearized()

    @cached_property
    def straight(self) -> BentState:
        """State of the straight beam, without a load at its tip."""
        unloaded = self if self.load is None else replace(self, load=None)
        return unloaded.at(np.zeros(self.size))

    def reduced(self, modal: Equations) -> RotatingBeam:
        """Return the beam in the coordinates to which equations about the straight beam were reduced."""
        return replace(self, beam=self.beam.reduced(self.basis_of(modal)), linear=modal)

    def basis_of(self, modal: Equations) -> np.ndarray:
        """Compute the basis (n, m) of a reduced model in the coordinates of the beam."""
        basis = np.zeros((self.size, modal.size))
        for name, place in self.linear.blocks.items():
            shape = modal.shapes[name if name in modal.shapes else f"{name}, {_DIRECTIONS[0]}"]
            basis[place, modal.blocks[shape.block]] = shape.matrix
        return basis

    def nearest(self, other: RotatingBeam, q: np.ndarray) -> np.ndarray:
        """Find the coordinates (n,) whose strains are nearest to another discretization's at q."""
        own, rule = self.beam, self.beam.stations.quadrature
        between = other.beam.stations.quadrature.interpolate_to(rule.xi)
        strains = np.tensordot(q, other.beam.functions, 1) @ between.T * np.sqrt(rule.weights)
        matrix = (own.functions * np.sqrt(rule.weights)).reshape(self.size, -1)
        if own.hinges is not None and other.beam.hinges is not None:
            matrix, strains = np.c_[matrix, own.hinges], np.r_[strains.ravel(), q @ other.beam.hinges]
        return np.linalg.lstsq(matrix.T, strains.ravel())[0]

    def at(self, q: np.ndarray) -> BentState:
        """Return the state of the beam at coordinates q (..., n); recent states are cached."""
        key = q.tobytes()
        if key not in self._kept:
            if len(self._kept) >= _KEPT:
                del self._kept[next(iter(self._kept))]
            self._kept[key] = BentState(self, self.beam.at(q.copy()))
        return self._kept[key]

    @cached_property
    def _kept(self) -> dict[bytes, BentState]:
        return {}

    def tip(self, q: np.ndarray) -> np.ndarray:
        """Compute the position (..., 3) of the tip along e1, e2, e3 [m] at coordinates q (..., n)."""
        return self.beam.at(q).tip

    def curvature(self, q: np.ndarray, xi: np.ndarray) -> np.ndarray:
        """Compute the curvature (..., k) [1/m] in the direction of bending, at q (..., n) and xi (k,)."""
        own = self.beam.functions[:, bent_beam.STRAINS.index("curvature")]
        return q @ own @ self.beam.stations.quadrature.interpolate_to(xi).T

    def tip_angle(self, q: np.ndarray) -> float:
        """Compute the angle of the tip from e1 [rad] at q (n,); it is signed for one plane only."""
        if self.beam.is_planar:
            return float(q @ self.angles[:, -1])
        along = self.beam.at(q).rotations[:, 0, -1]
        return float(np.arctan2(np.hypot(along[1], along[2]), along[0]))


@dataclass(frozen=True)
class BentState(FieldsOnly):
    """A deformed beam on a rotating carrier, at given coordinates.

    Parameters
    ----------
    of : RotatingBeam
        Equations of motion.
    bent : BentBeam
        The beam at the coordinates.
    """

    of: RotatingBeam
    bent: bent_beam.BentBeam

    def positions(self, xi: np.ndarray) -> np.ndarray:
        """Compute the positions (k, 3) along e1, e2, e3 [m] at x/L = xi of shape (k,)."""
        weights = self.of.length * self.of.beam.stations.quadrature.integrate_to(xi)
        return weights @ self.bent.tangents.T

    def under(self, values: Mapping[Quantity, float]) -> bent_beam.ForcedBeam:
        """Load the beam with the inertial forces under given values of the root's quantities (cached)."""
        key = tuple(values.items())
        if key not in self._known:
            root = np.array([values.get(quantity, 0.0) for quantity in _ROOT])
            turning = values.get("speed_squared", 0.0), values.get("acceleration", 0.0)
            self._known[key] = self.bent.under(self.bent.masses.carried(self.of.axis, *turning, root))
        return self._known[key]

    @cached_property
    def _known(self) -> dict[tuple[tuple[Quantity, float], ...], bent_beam.ForcedBeam]:
        return {}

    @cached_property
    def _loaded(self) -> bent_beam.ForcedBeam | None:
        """The beam with the load at its tip."""
        return None if self.of.load is None else self.bent.under(self.of.load.on(self.bent))

    @property
    def force_at_rest(self) -> np.ndarray:
        """Generalized elastic force, less that of the load at the tip (n,)."""
        elastic = self.of.stiffness @ self.q
        return elastic if self._loaded is None else elastic - self._loaded.work

    @property
    def stiffness_at_rest(self) -> np.ndarray:
        """Derivative (n, n) of `force_at_rest`; not symmetric where the load has no potential."""
        return self.of.stiffness if self._loaded is None else self.of.stiffness - self._loaded.work_change

    def inertia(self, values: Mapping[Quantity, float]) -> np.ndarray:
        """Compute the generalized inertial force (n,) under given values of the root's quantities."""
        return self.under(values).work

    def inertia_change(self, values: Mapping[Quantity, float]) -> np.ndarray:
        """Compute the derivative (n, n) of the generalized inertial force by the coordinates."""
        return self.under(values).work_change

    def inertia_of(self, quantity: Quantity) -> np.ndarray:
        """Compute the generalized inertial force (n,) per unit of one quantity of the root's motion."""
        return self.inertia({quantity: 1.0})

    def stiffness_of(self, quantity: Quantity) -> np.ndarray:
        """Compute the derivative (n, n) by the coordinates of the inertial force per unit of one quantity."""
        return self.inertia_change({quantity: 1.0})

    def work(self, rates: np.ndarray, accelerations: np.ndarray, root: RootMotion) -> np.ndarray:
        """Compute the residual (..., n) of the equations of motion; the arguments have the shape of q."""
        carrier = Carrier.of_root(self.of.axis, root)
        return MovingBeam(self.bent, rates, carrier, self.of.load).residual(accelerations)

    @property
    def q(self) -> np.ndarray:
        """Coordinates of this state, shape (..., n)."""
        return self.bent.q

    @property
    def mass(self) -> np.ndarray:
        """Mass matrix at this state, shape (n, n)."""
        return self.bent.mass

    @cached_property
    def gyroscopic(self) -> np.ndarray:
        """Gyroscopic matrix per speed at this state, shape (n, n)."""
        euler = self.stiffness_of("acceleration")
        return euler - euler.T

    def steady(self) -> SteadyPencil:
        """Return the equations of small motions at steady speed, as those of `linearized` are there."""
        linear, none = self.of.linear, np.zeros((self.of.size, self.of.size))
        K0, C = (of_order.get("unity", none) for of_order in linear.matrices[:2])
        K0 = K0 if self._loaded is None else K0 - self._loaded.work_change
        K2, f2 = self.inertia_change(self.of.turning), -self.force_at_rest - self.inertia(self.of.turning)
        return SteadyPencil(self.bent.mass, C, self.gyroscopic, K0, K2, f2, linear.shift, linear.planes)

    def linearized(self) -> Equations:
        """Return the equations of small motions about this state, whose elastic force is among the loads."""
        linear = self.of.linear
        terms = [
            *terms_of_blocks(linear, "mass", self.bent.mass, 2),
            *terms_of_blocks(linear, "Coriolis coupling", self.gyroscopic, 1, "speed"),
            *(t for t in linear.terms if t.quantity == "unity" and t.order < 2),
        ]
        if self._loaded is not None:
            terms += terms_of_blocks(linear, "stiffness by the load at the tip", -self._loaded.work_change, 0)
        loads = [*self._loads("elastic force", self.force_at_rest, "unity")]
        for quantity in self.of.quantities:
            change = self.stiffness_of(quantity)
            terms += terms_of_blocks(linear, f"stiffness by {quantity}", change, 0, quantity)
            loads += self._loads(f"load by {quantity}", self.inertia_of(quantity), quantity)
        shapes, deflections = {}, {}
        for name, place in linear.blocks.items():
            for direction in range(linear.planes):
                own = linear.deflections.get(name)
                key = name if own and own.direction == direction else f"{name}, {_DIRECTIONS[direction]}"
                deflections[key] = self._deflection(place, direction)
                shapes[key] = Shape(name, np.eye(place.stop - place.start))
        shapes |= {name: shape for name, shape in linear.shapes.items() if name not in shapes}
        return replace(
            linear, terms=(*terms,), loads=(*loads,), deflections=deflections, shapes=shapes, coarse=None
        )

    def _loads(self, name: str, vector: np.ndarray, quantity: Quantity) -> Iterator[Load]:
        """Split a force of the left-hand side (n,) into loads of the right-hand side, one for each block."""
        for row, i in self.of.linear.blocks.items():
            yield Load(name, row, vector[i], quantity, -1.0)

    def _deflection(self, place: slice, direction: int) -> Deflection:
        """Build the deflection in a direction by the coordinates of one block, with its inertial loads."""
        masses, axis = self.bent.masses, np.array([-_AXES[2], _AXES[1]][direction])
        by_root = self.bent.work(masses.translated(_AXES[1 + direction]).force)
        by_turning = -self.bent.work(masses.euler(axis).force)
        none = np.zeros(place.stop - place.start)
        functions = DeflectedFunctions(self.bent, place, direction)
        return Deflection(functions, by_root[place], by_turning[place], none, direction)


@dataclass(frozen=True)
class DeflectedFunctions(FieldsOnly):
    """Changes of a bent beam's deflection in one direction per coordinate, as functions of x/L.

    Parameters
    ----------
    bent : BentBeam
        The bent beam.
    place : slice
        Coordinates of a block.
    direction : int
        0 for the direction of bending at the root, 1 for that across.
    """

    bent: bent_beam.BentBeam
    place: slice
    direction: int

    @property
    def size(self) -> int:
        """Number of functions, one for each coordinate of the block."""
        return self.place.stop - self.place.start

    def end(self, order: int) -> np.ndarray:
        """Evaluate the `order`-th derivatives at the tip."""
        return self.evaluate(np.ones(1), order)[:, 0]

    def evaluate(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Evaluate the functions (order 0) or their slopes by x/L (order 1) at xi (k,): shape (n, k)."""
        stations = self.bent.beam.stations
        moving = self.bent.displacement_rates[self.place, 1 + self.direction] * stations.length
        if order == 0:
            return moving @ stations.quadrature.integrate_to(xi).T
        if order == 1:
            return moving @ stations.quadrature.interpolate_to(xi).T
        raise ValueError("only the deflection and its slope follow a deflected beam")
