"""The linear equations of a scene at one steady speed, in modes at that speed and their residual flexibility.

The coordinates are those of the lowest modes at the speed, without damping and gyroscopic coupling, or of all
trial functions of the discretization.  The modes that are left out follow a slow excitation without delay.
Their static deflection, the residual flexibility, is the deflection of all functions minus that of the
retained modes (Craig and Kurdila, Fundamentals of Structural Dynamics (2006), section 11.4).

In shapes of arrays, n counts retained coordinates, and N all trial functions.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import linear_sum_assignment

from beamdyn.accuracy.refinement import LINEAR_MESHES, THREE_DISCRETIZATIONS, error_of_finest
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.common.words import Named, Setting, Words
from beamdyn.equations.circuit import BENDS, strain_of
from beamdyn.equations.discretization import Discretization
from beamdyn.equations.equations_of_motion import Equations, SteadyPencil
from beamdyn.equations.fields.transverse import plane_components
from beamdyn.equations.root_moment import RootMoment, StaticLoad, root_moment, static_moment
from beamdyn.equations.root_motion import Quantity, RootMotion, root_motion
from beamdyn.linear.free_motion import FreeMotion, free_motion
from beamdyn.linear.inputs_outputs import (
    AccelerationAt,
    Accelerations,
    DeflectionAt,
    Excitation,
    HarvestedCurrent,
    LayerStrain,
    Observation,
    OfLayers,
    StrainAtRoot,
)
from beamdyn.modes.modal.error_estimate import rounding_of_entries
from beamdyn.modes.modal.model import ModalBasis, Model, reduce_to_modes
from beamdyn.scene.motion.base import MotionSample
from beamdyn.scene.mount import exact_cos_sin
from beamdyn.scene.scene import Scene

_LAYERS = Words(Named("Harvester.on puts them on", "a table [harvester] puts them on"))


@dataclass(frozen=True)
class HarmonicDrive:
    """Load of an excitation at one harmonic of the rotation, and its further effects, per unit of the input.

    Parameters
    ----------
    load : ndarray, shape (n,)
        Right-hand side of the equations.
    residual : ndarray, shape (N,)
        Static deflection beyond that of the retained coordinates, over all functions.
    accelerations : dict of str to complex
        Accelerations of the root.
    force : tuple of (float, int), optional
        Position x/L and direction of a unit force.
    """

    load: np.ndarray
    residual: np.ndarray
    accelerations: Accelerations
    force: tuple[float, int] | None


@dataclass(frozen=True)
class Row:
    """An output as a linear function of coordinates, velocities and accelerations.

    Parameters
    ----------
    position, velocity, acceleration : ndarray, shape (n,)
        Output per unit of the coordinates and of their time derivatives.
    """

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray


@dataclass(frozen=True)
class ModelAtSpeed(FieldsOnly):
    """Linear equations M q'' + C q' + K q = f of a scene at one steady speed.

    Parameters
    ----------
    model : Model
        The discretized scene.
    speed : float
        Speed [rad/s].
    modes : int or None
        Number of modes of each set of coupled fields; None for all functions.
    """

    model: Model
    speed: float
    modes: int | None

    @property
    def scene(self) -> Scene:
        """The scene of the model."""
        return self.model.scene

    @property
    def discretization(self) -> Discretization:
        """The discretization of the beam."""
        return self.model.discretization

    @cached_property
    def equations(self) -> Equations:
        """Equations in the retained coordinates, including the charge of a harvester's circuit."""
        return self._mechanical.with_charge()

    @cached_property
    def _mechanical(self) -> Equations:
        """Equations in the retained coordinates, without the circuit of a harvester."""
        if self.modes is None:
            return self.model.equations
        return reduce_to_modes(self.model.equations, ModalBasis(self.modes, (self.speed,)))

    @cached_property
    def pencil(self) -> SteadyPencil:
        """Matrices in the retained coordinates, as polynomials of the speed."""
        return self.equations.steady()

    @property
    def M(self) -> np.ndarray:
        """Mass matrix at this speed."""
        return self.pencil.M

    @cached_property
    def C(self) -> np.ndarray:
        """Sum of damping and gyroscopic matrices at this speed."""
        return self.pencil.C + self.speed * self.pencil.G

    @cached_property
    def K(self) -> np.ndarray:
        """Stiffness matrix at this speed."""
        return self.pencil.K0 + self.speed**2 * self.pencil.K2

    @cached_property
    def shapes(self) -> np.ndarray:
        """Matrix that gives the coordinates of all trial functions from the retained coordinates."""
        full, kept = self.model.equations, self.equations
        shapes = np.zeros((full.size, kept.size))
        for name, shape in kept.shapes.items():
            shapes[full.blocks[name], kept.blocks[shape.block]] = shape.matrix
        if kept.voltage is not None and (circuit := self._mechanical.circuit) is not None:
            for name, bent in circuit.bent.items():  # the voltage also deflects the modes left out
                shapes[full.blocks[name]] += np.outer(bent, kept.voltage.row)
        return shapes

    @cached_property
    def free_motion(self) -> FreeMotion:
        """Poles and shapes of the model's free motion."""
        return free_motion(self.M, self.C, self.K)

    @cached_property
    def inverse_mechanical_poles(self) -> np.ndarray:
        """Inverse poles [s] of free motion, without the circuit of a harvester."""
        if self.equations.voltage is None:
            return self.free_motion.inverse_poles
        own = self.mechanical
        return free_motion(*(A[own, own] for A in (self.M, self.C, self.K))).inverse_poles

    @property
    def mechanical(self) -> slice:
        """Slice of the coordinates of the beam: all but the last one if that is the charge of a circuit."""
        return slice(0, self._mechanical.size)

    # Inputs -----------------------------------------------------------------------------------------

    def drives(self, excitation: Excitation) -> dict[int, HarmonicDrive]:
        """Compute the loads of an excitation, by harmonic of the rotation."""
        accelerations = excitation.accelerations(self.scene.mount, self.speed)
        return {h: self._drive(given, excitation) for h, given in accelerations.items()}

    def _drive(self, accelerations: Accelerations, excitation: Excitation) -> HarmonicDrive:
        full = self.model.equations
        force = excitation.force(self.scene.beam)
        load: np.ndarray = np.zeros(full.size, dtype=complex)
        for quantity, value in accelerations.items():
            load += value * full.vectors.get(quantity, np.zeros(full.size))
        if force is not None:
            self._check_direction("input", force[1])
            load += full.deflection(np.array(force[:1]), direction=force[1])[:, 0]
        load = load if np.imag(load).any() else np.real(load)
        if not load.any():
            bound = "no load: it acts along the beam, or in a direction in which the beam is rigid"
            raise InvalidValue("input", excitation.label, bound, "model both planes, or turn the beam")
        return HarmonicDrive(self.shapes.T @ load, self._residual(load), accelerations, force)

    def _residual(self, load: np.ndarray) -> np.ndarray:
        """Compute the static deflection under a load with all functions, minus that with retained ones."""
        if self.modes is None:
            return np.zeros_like(load)
        of_all = np.linalg.solve(self.full_stiffness, load)
        return of_all - self.shapes @ np.linalg.solve(self.K, self.shapes.T @ load)

    @cached_property
    def full_stiffness(self) -> np.ndarray:
        """Stiffness matrix of all trial functions at this speed."""
        pencil = self.model.equations.steady()
        return pencil.K0 + self.speed**2 * pencil.K2

    def _check_direction(self, name: str, direction: int) -> None:
        bound = "a beam modelled in one plane is rigid across its direction of bending"
        remedy = Words("give ", Setting("physics", planes=2))
        if direction >= self.equations.planes:
            raise InvalidValue(name, "across", bound, remedy)

    # Outputs ----------------------------------------------------------------------------------------

    def row(self, observation: Observation) -> Row:
        """Express an output in the retained coordinates."""
        zero = np.zeros(self.equations.size)
        if isinstance(observation, OfLayers):
            _, order, of_kept = self._of_layers(observation)
            return Row(*(of_kept if order == k else zero for k in range(3)))
        if isinstance(observation, DeflectionAt):
            if self.equations.voltage is None or isinstance(observation, AccelerationAt):
                return self._row_at(observation, self.equations)
            return Row(self._row_at(observation, self.model.equations).position @ self.shapes, zero, zero)
        moment, factor = self._moment, self._per_moment(observation)
        position, velocity = (self._at_speed(rows, zero) for rows in (moment.position, moment.velocity))
        return Row(factor * position, factor * velocity, zero)

    def residual(self, observation: Observation, drive: HarmonicDrive) -> np.ndarray:
        """Compute the output due to the static deflection of modes left out: shape (3,).

        The values are per unit of the input, and of its first and second time derivative.
        """
        if isinstance(observation, OfLayers):
            row, order, _ = self._of_layers(observation)
            return np.eye(3)[order] * (row @ drive.residual)
        if isinstance(observation, DeflectionAt):
            row = self._row_at(observation, self.model.equations)
            added = np.array([x @ drive.residual for x in (row.position, row.velocity, row.acceleration)])
            if isinstance(observation, AccelerationAt):
                name = ("root_transverse", "root_across")[observation.place(self.scene.beam)[1]]
                added = added + np.array([drive.accelerations.get(name, 0.0), 0.0, 0.0])
            return added
        kept = np.linalg.solve(self.K, drive.load)
        load = StaticLoad(drive.accelerations, drive.force, drive.residual + self.shapes @ kept)
        total = static_moment(self.scene, self.discretization, self.model.equations, self._root, load)
        by_kept = self._at_speed(self._moment.position, np.zeros_like(kept)) @ kept
        return np.array([self._per_moment(observation) * (total - by_kept), 0.0, 0.0])

    def _of_layers(self, observation: OfLayers) -> tuple[np.ndarray, int, np.ndarray]:
        """Express an output of piezoelectric layers by all trial functions, and by the retained coordinates.

        Return the row for all functions, the order of the time derivative to which both rows apply, and the
        row for retained coordinates.  Where the circuit has a coordinate, the row for all functions applies
        only to deflections beyond the retained coordinates.
        """
        beam, full = self.scene.beam, self.model.equations
        if (electrodes := beam.electrodes) is None:
            raise InvalidValue(
                "output", observation.label, "the beam carries no piezoelectric layers", _LAYERS
            )
        bends, row = full.deflections[BENDS], np.zeros(full.size)
        if isinstance(observation, LayerStrain):
            place = np.array([observation.place(electrodes, beam.length)])
            row[full.blocks[BENDS]] = strain_of(beam, bends, place)[:, 0]
            return row, 0, row @ self.shapes
        found, voltage = observation.rows(electrodes, beam.length), self.equations.voltage
        for name, theta in self.model.coupling.items():
            row[full.blocks[name]] = found.factor * theta
        if voltage is None:
            return row, found.order, row @ self.shapes
        per_volt = 1 / electrodes.resistance if isinstance(observation, HarvestedCurrent) else 1.0
        return row, found.order, per_volt * voltage.row

    def _row_at(self, observation: DeflectionAt, equations: Equations) -> Row:
        xi, direction = observation.place(self.scene.beam)
        self._check_direction("output", direction)
        directions, at = range(equations.planes), np.array([xi])
        each = equations.tips if xi == 1 else [equations.deflection(at, 0, i)[:, 0] for i in directions]
        zero = np.zeros(equations.size)
        if not isinstance(observation, AccelerationAt):
            return Row(each[direction], zero, zero)
        pull, turn = self._carried(direction)
        position = sum((p * w for p, w in zip(pull, each, strict=False)), zero)
        return Row(position, sum((t * w for t, w in zip(turn, each, strict=False)), zero), each[direction])

    def _carried(self, direction: int) -> tuple[np.ndarray, np.ndarray]:
        """Compute the acceleration in one direction per unit of the deflections and velocities in both.

        Both results have the shape (2,).  Rotation adds -omega^2 (d_i d_j + S^2 n_i n_j) of the deflection,
        and 2 omega S of the velocity in the other direction, with S the sine of the precone, and d and n the
        components of the two directions in the plane of rotation and normal to it.
        """
        (d, n), (_, sine) = plane_components(self.scene), exact_cos_sin(self.scene.mount.precone)
        pull = -(self.speed**2) * (d[direction] * np.array(d) + sine**2 * n[direction] * np.array(n))
        turn = np.zeros(2)
        turn[1 - direction] = 2 * self.speed * sine * (1 if direction == 0 else -1)
        return pull, turn

    @cached_property
    def _moment(self) -> RootMoment:
        return root_moment(self.scene, self.discretization, self.equations)

    def _per_moment(self, observation: Observation) -> float:
        return observation.per_moment(self.scene) if isinstance(observation, StrainAtRoot) else 1.0

    def _at_speed(self, by_quantity: Mapping[Quantity, np.ndarray], zero: np.ndarray) -> np.ndarray:
        """Sum the rows of all quantities of root motion, each times its value at the speed, plus `zero`."""
        root, total = self._root, zero
        for quantity, row in by_quantity.items():
            total = total + float(getattr(root, quantity)) * row
        return total

    @cached_property
    def _root(self) -> RootMotion:
        return root_motion(self.scene.mount, MotionSample.steady(self.speed))


# Errors of the poles of a linear model ------------------------------------------------------------


_UNRESOLVED = 0.01  # relative error of a pole beyond which it may be paired with the pole of another mode
# The error of a pole is estimated from three models: a fine, a coarse and a coarser one. The distance between
# the poles of the coarse and the coarser model is used only if it is below _STEADY, relative to the pole. The
# distance between the fine and the coarse model is assumed to be at least _LEAST_RATIO times that distance,
# as several fields, segments or elements do not converge as steadily as one.
_STEADY, _LEAST_RATIO = 0.01, 0.2
_ROUNDING = 4 * float(np.finfo(float).eps)  # relative rounding error of the matrices


def pole_errors(model: ModelAtSpeed) -> np.ndarray:
    """Estimate the relative errors of the poles of a model, in the order of `FreeMotion.poles`.

    The error has two parts.  Modes that are left out change a pole through damping and gyroscopic terms: this
    part is its distance from the corresponding pole of a model with all functions.  The error of the
    discretization is estimated by comparing the latter pole with those of two coarser discretizations.

    An infinite pole, of a coordinate without mass, has the error nan.  A pole with an error beyond 1 % is
    unresolved, and has the error inf; the first unresolved pole above a resolved one makes all poles of
    larger magnitude unresolved, too.
    """
    kept, fine, coarse = model.free_motion, model.model, model.model.coarser
    whole, *coarser = (
        ModelAtSpeed(each, model.speed, None).free_motion for each in (fine, coarse, coarse.coarser)
    )
    poles = kept.finite_poles
    truncation, nearest = _distance(poles, whole.finite_poles)
    apart, partners = _distance(nearest, coarser[0].finite_poles)
    before, _ = _distance(partners, coarser[1].finite_poles)
    before = np.where(before < _STEADY * np.abs(poles), np.minimum(before, apart / _LEAST_RATIO), np.nan)
    rounding = (kept.rounding + whole.rounding) * np.abs(poles)
    with np.errstate(divide="ignore", invalid="ignore"):
        error = (truncation + error_of_finest(THREE_DISCRETIZATIONS, apart, before)) / np.abs(poles)
        resolved = (truncation + LINEAR_MESHES.factor * apart) / np.abs(poles) < _UNRESOLVED
    error += rounding + _ROUNDING + LINEAR_MESHES.factor * model.discretization.rounding
    error += _rounding_of_stiffness(model)
    resolved &= (error < _UNRESOLVED) & fine.exceeds_coarser
    # Poles ascend: those above the first unresolved one may be paired with poles of other modes.
    ended = np.maximum.accumulate(~resolved & np.maximum.accumulate(resolved))
    found = np.full(len(kept.poles), np.nan)
    found[: len(poles)] = np.where(resolved & ~ended, error, np.inf)
    return found


def _rounding_of_stiffness(model: ModelAtSpeed) -> np.ndarray:
    """Estimate the relative errors of the finite poles by rounding of the stiffness matrix's entries.

    They are large where elements are short.
    """
    free = model.free_motion
    shapes = (model.shapes @ free.shapes[:, free.inverse_poles != 0]).T
    energies = np.einsum("ki,ij,kj->k", shapes.conj(), model.model.equations.steady().M, shapes).real
    with np.errstate(divide="ignore", invalid="ignore"):
        squared = np.abs(free.finite_poles) ** 2 * energies
        return rounding_of_entries(model.full_stiffness, shapes, shapes) / (2 * squared)


def _distance(poles: np.ndarray, others: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pair each pole with a pole of another model, and return their distance [1/s] and the other pole.

    A pole without a partner has the distance inf, and is itself returned as the other pole.
    """
    apart = np.abs(poles[:, None] - others)
    scale = np.maximum(np.abs(poles), _ROUNDING * np.abs(poles).max(initial=0.0))[:, None]
    rows, partners = linear_sum_assignment(apart / np.where(scale == 0, 1.0, scale))
    distance, found = np.full(len(poles), np.inf), poles.copy()
    distance[rows], found[rows] = apart[rows, partners], others[partners]
    return distance, found
