"""The geometrically exact beam in space, and its equations of motion linearized about any deformed state.

The unknowns are the strains along the axis, six functions of x/L: stretch g1, shears g2, g3 between section
and tangent, twist rate k1 and curvatures k2, k3, in the axes of the section.  With the rotation R of the
sections and the position r of the axis,

    R' = R skew(k),   r' = R (e1 + g),

the six strains are independent of each other, and the elastic energy is a quadratic form of the coordinates.
Twist makes helices of the fibres off the axis, which shortens the beam (trapeze effect): with the mean strain
e of the fibres, their mean squared distance i^2 from the axis, and the pretwist t of the unloaded sections
relative to the axes of the strains,

    g1 = e - i^2/2 ((k1 + t)^2 - (k1_0 + t)^2).

A small change of the coordinates rotates the sections by W and displaces the axis by X,

    W' = R dk,   X' = W x r' + R dg,

all with components in the axes e1, e2, e3 at the root, here called space-fixed.  With n and m the resultants
of the forces F and moments M that act beyond a point, virtual work is int [R'm . dk + R'n . dg], and its
derivative, at fixed forces, is

    int [W_i' . (m x W_j) + R g_i . (n x W_j) + W_i . (X_j' x n) + R'n . g_ij].

References: Hodges (1990), International Journal of Solids and Structures 26, 1253-1273 (strains, intrinsic
equations); Simo and Vu-Quoc (1986), Computer Methods in Applied Mechanics and Engineering 58, 79-116.

Arrays over N + 1 + k stations have the N Gauss points of the strains, the tip and the k point masses: see
`station_forces`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.numerics import gauss_rule
from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.equations.beam_in_space.finite_rotations import UNIT, cross, integrate_curvature, turn
from beamdyn.equations.beam_in_space.station_forces import BeamStations, Masses, MassesInSpace, StationForces
from beamdyn.equations.discretization import ArcQuadrature, Cells

# Weights of a Gauss rule on the arc that models a sprung root: exact to rounding for rotations up to pi.
_ON_ARC = gauss_rule(12)[1] / 2
STRAINS = "stretch", "shear", "second shear", "twist rate", "second curvature", "curvature"


@dataclass(frozen=True)
class BeamInSpace(FieldsOnly):
    """Beam, clamped or hinged at the root, with arbitrarily large bending, twist, shear and stretch.

    The axes at the root are e1 along the beam, e2 in the direction of bending and e3 perpendicular to both.

    Parameters
    ----------
    stations : BeamStations
        Points along the beam; N of them are Gauss points.
    masses : Masses
        Masses at the stations.
    initial : ndarray, shape (6, N)
        Strains of the unloaded beam, in the order of `STRAINS`; curvatures in 1/m.
    functions : ndarray, shape (coordinates, 6, N)
        Strains per unit of each coordinate.
    stiffness, damping : ndarray, shape (coordinates, coordinates)
        Elastic stiffness and damping of the coordinates.
    fibres : ndarray, shape (N,)
        Mean squared distance i^2 of the fibres from the axis [m2]; 0 neglects the shortening due to twist.
    pretwist : ndarray, shape (N,)
        Pretwist t of the unloaded sections relative to the axes of the strains [1/m].
    kinks : ndarray, shape (cells, 4)
        Unit quaternions of the axes' rotation at the beginning of each cell of the quadrature; needed if the
        beam's axis has kinks, or does not begin along e1.
    hinges : ndarray, shape (coordinates, 3), optional
        Rotation vector of the root per unit of each coordinate [rad]; None if the root is clamped.
    slopes : ndarray, shape (coordinates, sections), optional
        Bending slopes at the Gauss points and the tip per unit of each coordinate, more exact than integrals
        of the curvature over Gauss points; None if not known.
    """

    stations: BeamStations
    masses: Masses
    initial: np.ndarray
    functions: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    fibres: np.ndarray
    pretwist: np.ndarray
    kinks: np.ndarray
    hinges: np.ndarray | None = None
    slopes: np.ndarray | None = None

    @property
    def size(self) -> int:
        """Number n of coordinates."""
        return len(self.functions)

    @cached_property
    def flat_functions(self) -> np.ndarray:
        """Strains per unit of each coordinate (row), flattened over components and Gauss points."""
        return self.functions.reshape(self.size, -1)

    def strained(self, q: np.ndarray) -> np.ndarray:
        """Compute the changes of strain (..., 6, points) from the unloaded beam, at coordinates q."""
        return (q @ self.flat_functions).reshape(*q.shape[:-1], *self.initial.shape)

    @cached_property
    def angles(self) -> np.ndarray:
        """Integrals of the strains from the root per unit of each coordinate, which measure shape changes.

        The columns are the components of strain that are not 0, at each Gauss point and at the tip; of a beam
        that bends in one plane, they are its slopes, if these are known.
        """
        if self.is_planar and self.slopes is not None:
            return self.slopes
        used, turned = self.functions.any(axis=(0, 2)), self.stations.to_sections(self.functions)
        if self.hinges is not None:
            turned[:, 3:] += self.hinges[..., None]
        return turned[:, used].reshape(self.size, -1)

    @cached_property
    def shears(self) -> bool:
        """Whether the model has shear, or the axis changes its length by stretch or twist."""
        return bool(self.functions[:, :3].any() or self.shortens)

    @cached_property
    def shortens(self) -> bool:
        """Whether twist shortens the beam (the trapeze effect)."""
        return bool(self.fibres.any() and self.functions[:, 3].any())

    def reduced(self, basis: np.ndarray) -> BeamInSpace:
        """Transform the beam to other coordinates, q = basis @ q_reduced (a column for each new one)."""
        given = {name: getattr(self, name) for name in ("functions", "hinges", "slopes")}
        rows = {k: np.tensordot(basis.T, values, 1) for k, values in given.items() if values is not None}
        K, C = (basis.T @ matrix @ basis for matrix in (self.stiffness, self.damping))
        return replace(self, stiffness=K, damping=C, **rows)

    @cached_property
    def is_planar(self) -> bool:
        """Whether the beam is straight and inextensible, and bends in the plane of e1 and e2 only."""
        return not (self.initial.any() or self.kinks[:, 1:].any() or self.functions[:, :-1].any())

    @cached_property
    def arc(self) -> BeamInSpace:
        """Sprung root, modelled as an infinitely short and soft piece of beam that is bent to an arc.

        With its length taken as 1, its curvature is the rotation vector of the root.  This makes the root's
        rotation independent of the order of axes.  Its elastic energy is part of that of the beam.
        """
        none = np.zeros_like(_ON_ARC)
        stations = BeamStations(ArcQuadrature(Cells(np.array([0.0, 1.0]), len(none))), 1.0, none[:0])
        functions = np.zeros((self.size, 6, len(none)))
        functions[:, 3:] = np.asarray(self.hinges)[..., None]
        law = self.stiffness, self.damping
        return BeamInSpace(stations, self.masses, 0 * functions[0], functions, *law, none, none, UNIT[None])

    def at(self, q: np.ndarray) -> BentBeam:
        """Return the beam deformed by coordinates q."""
        return BentInPlane(self, q) if self.is_planar else BentBeam(self, q)


def elastic_stiffness(stations: BeamStations, functions: np.ndarray, law: np.ndarray) -> np.ndarray:
    """Compute the elastic stiffness matrix (n, n) for strains (n, 6, N) and section stiffnesses (6, 6, N).

    Raises
    ------
    InvalidValue
        If a section's stiffness matrix is not positive definite: the section would deform without a force.
    """
    least = np.linalg.eigvalsh(np.moveaxis(law, 2, 0))[:, 0]
    if (least <= 0).any():
        k, bound = int(least.argmin()), "it must be positive, or the section deforms without a force"
        where, remedy = f" at x/L = {stations.quadrature.xi[k]:.3g}", "check its 6 x 6 matrix"
        raise InvalidValue("least eigenvalue of the section", float(least[k]), bound, remedy, where=where)
    stress = np.einsum("abj,nbj->naj", law * stations.quadrature.weights * stations.length, functions)
    return _product(functions, stress)


class Work(NamedTuple):
    """Virtual work (n,) of forces per unit of each coordinate, and its derivatives `change` (n, n)."""

    work: np.ndarray
    change: np.ndarray


@dataclass(frozen=True)
class BentBeam(FieldsOnly):
    """Beam deformed by given coordinates.

    All properties except the matrices can be computed for several sets of coordinates at once.

    Parameters
    ----------
    beam : BeamInSpace
        The beam.
    q : ndarray, shape (..., coordinates)
        Coordinates.
    """

    beam: BeamInSpace
    q: np.ndarray

    @cached_property
    def strains(self) -> np.ndarray:
        """Strains of the deformed beam (..., 6, points), in the order of `STRAINS`."""
        return self.beam.initial + self.beam.strained(self.q)

    @property
    def _shortening(self) -> np.ndarray:
        """Derivative of axial stretch with respect to twist rate at each Gauss point (trapeze effect)."""
        return -self.beam.fibres * (self.strains[..., 3, :] + self.beam.pretwist)

    @cached_property
    def rotations(self) -> np.ndarray:
        """Rotation matrices (..., 3, 3, points), section axes as columns, at Gauss points and tip."""
        beam, stations = self.beam, self.beam.stations
        curvature = stations.length * self.strains[..., 3:, :]
        turned = integrate_curvature(stations.quadrature.cells, curvature, beam.kinks)
        if beam.hinges is None:
            return turned
        return np.einsum("...ab,...bcj->...acj", self._root.rotations[..., -1], turned)

    @cached_property
    def _within(self) -> np.ndarray:
        """Rotation matrices (..., 3, 3, points) of the sections at the Gauss points, without the tip."""
        return self.rotations[..., :-1]

    @cached_property
    def tangents(self) -> np.ndarray:
        """Derivative r' (..., 3, points) of the axis' position with respect to arc length."""
        if not (self.beam.shears or self.beam.initial[:3].any()):
            return self._within[..., :, 0, :]
        extended, beam, twist = self.strains[..., :3, :].copy(), self.beam, self.strains[..., 3, :]
        both = twist + beam.initial[3] + 2 * beam.pretwist
        extended[..., 0, :] += 1 - beam.fibres / 2 * both * (twist - beam.initial[3])
        return turn(self._within, extended)

    @cached_property
    def positions(self) -> np.ndarray:
        """Positions (..., 3, stations) of the axis at the stations [m]."""
        return self.beam.stations.to_all(self.tangents)

    @property
    def tip(self) -> np.ndarray:
        """Position (..., 3) of the tip [m]."""
        return self.positions[..., self.beam.stations.sections - 1]

    @cached_property
    def masses(self) -> MassesInSpace:
        """Masses of the beam at their positions on the deformed beam."""
        return self.beam.masses.turned(self.rotations, self.positions)

    def strain_rates(self, rates: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Compute time derivatives of stretch and shears, and of curvatures, from `rates` of coordinates.

        Both have the shape (..., 3, points), with components along the axes at the root.
        """
        stretch, bending = np.split(self.beam.strained(rates), 2, axis=-2)
        if self.beam.shears:
            stretch[..., 0, :] += self._shortening * bending[..., 0, :]
            stretch = turn(self._within, stretch)
        return stretch, turn(self._within, bending)

    def shortening_rate(self, rates: np.ndarray) -> np.ndarray:
        """Compute the part of the stretch's second time derivative due to squared twist rates.

        Its shape is (..., 3, points), with components along the axes at the root (trapeze effect).
        """
        twist_rate = rates @ self.beam.functions[:, 3]
        return -(self.beam.fibres * twist_rate**2)[..., None, :] * self._within[..., 0, :]

    # Rotation of the sprung root -------------------------------------------------------------------------

    @cached_property
    def _root(self) -> BentBeam:
        """Deformed piece of beam that models the root's spring, up to the root: see `BeamInSpace.arc`."""
        return self.beam.arc.at(self.q)

    @cached_property
    def _mean_of_arc(self) -> np.ndarray:
        """Mean rotation matrix (..., 3, 3) along the arc that models the root's spring.

        It turns the rate of the root's rotation vector into the root's angular velocity.
        """
        return self._root._within @ _ON_ARC

    def turning_rate(self, rates: np.ndarray, bending: np.ndarray) -> np.ndarray:
        """Compute angular velocities (..., 3, sections) of the sections.

        `rates` are the rates of the coordinates, `bending` (..., 3, points) the rates of the curvatures.
        """
        turning, hinges = self.beam.stations.to_sections(bending), self.beam.hinges
        return turning if hinges is None else turning + self._mean_of_arc @ (rates @ hinges)[..., None]

    def turning_of_root(self, rates: np.ndarray) -> np.ndarray | float:
        """Compute the angular acceleration (..., 3, 1) of the root for constant rates of the coordinates."""
        if self.beam.hinges is None:
            return 0.0
        bending = self._root.strain_rates(rates)[1]
        return (cross(self._root.turning_rate(rates, bending)[..., :-1], bending) @ _ON_ARC)[..., None]

    # Derivatives of the motion with respect to the coordinates --------------------------------------------

    @cached_property
    def _strained(self) -> tuple[np.ndarray, np.ndarray]:
        """Changes of stretch and shears, and of twist rate and curvatures, per unit of each coordinate.

        Both arrays have the shape (n, 3, points), with components in space-fixed axes.
        """
        return self.strain_rates(np.eye(self.beam.size))

    @cached_property
    def _turned(self) -> np.ndarray:
        """Rotation vectors (n, 3, sections) of sections per unit of each coordinate, in space-fixed axes."""
        return self.turning_rate(np.eye(self.beam.size), self._strained[1])

    @cached_property
    def displacement_rates(self) -> np.ndarray:
        """Derivatives along the axis of its displacement per unit of each coordinate: (n, 3, points)."""
        rates = cross(self._turned[..., :-1], self.tangents)
        return rates + self._strained[0] if self.beam.shears else rates

    @cached_property
    def motions(self) -> np.ndarray:
        """Displacements and rotations of all stations per unit of each coordinate: (n, 6, stations)."""
        stations = self.beam.stations
        motions = np.zeros((self.beam.size, 6, stations.count))
        motions[:, :3] = stations.to_all(self.displacement_rates)
        motions[:, 3:, : stations.sections] = self._turned
        return motions

    @property
    def tip_motions(self) -> np.ndarray:
        """Displacements of the tip per unit of each coordinate: (n, 3)."""
        return self.motions[:, :3, self.beam.stations.sections - 1]

    # Virtual work of forces at the stations -----------------------------------------------------------

    def under(self, forces: StationForces) -> Work:
        """Compute the virtual work of forces at the stations, and its change per unit of each coordinate."""
        resultants = self._resultants(forces.force)
        change = self._change_by(*resultants) + self._of_stations(forces.tangent)
        return Work(self._work_of(*resultants), change)

    def work(self, force: np.ndarray) -> np.ndarray:
        """Compute the virtual work per unit of each coordinate of forces (..., 6, stations)."""
        return self._work_of(*self._resultants(force))

    def _resultants(self, force: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Compute resultants n and moments m of all forces beyond each point, and the moment at the root.

        n and m (..., 3, points) are multiplied by the Gauss weights; the root moment has the shape (..., 3).
        """
        stations = self.beam.stations
        n = stations.from_all(force[..., :3, :])
        moments = force[..., 3:, : stations.sections].copy()
        moments[..., :-1] += cross(self.tangents, n)
        return n, stations.from_sections(moments), moments.sum(axis=-1)

    def _work_of(self, n: np.ndarray, m: np.ndarray, at_root: np.ndarray) -> np.ndarray:
        """Compute the virtual work of resultant forces and moments per unit of each coordinate: (..., n).

        `n`, `m` and the moment at the root are what `_resultants` returns.
        """
        beam, functions, back = self.beam, self.beam.flat_functions, self._within.swapaxes(-3, -2)
        stress = turn(back, m)
        if beam.shears:
            stress = np.concatenate([turn(back, n), stress], axis=-2)
            stress[..., 3, :] += self._shortening * stress[..., 0, :]
        flat = stress.reshape(*m.shape[:-2], -1)
        work = flat @ functions[:, functions.shape[1] - flat.shape[-1] :].T
        if beam.hinges is None:
            return work
        return work + (at_root[..., None, :] @ self._mean_of_arc)[..., 0, :] @ beam.hinges.T

    def _change_by(self, n: np.ndarray, m: np.ndarray, at_root: np.ndarray) -> np.ndarray:
        """Compute the derivatives (n, n) of virtual work with respect to coordinates, for constant forces.

        The forces and moments are what `_resultants` returns.
        """
        beam, W = self.beam, self._turned[..., :-1]
        change = self._change_by_moments(m) + _product(W, cross(self.displacement_rates, n))
        if beam.shears:
            change += _product(self._strained[0], cross(n, W))
        if beam.shortens:
            twist, along = beam.functions[:, 3], (self._within[:, 0] * n).sum(axis=0)
            change -= _product(twist * (beam.fibres * along), twist)
        if beam.hinges is not None:
            change += self._root._change_by_moments(at_root[:, None] * _ON_ARC)
        return change

    def _change_by_moments(self, m: np.ndarray) -> np.ndarray:
        """Compute the part of `_change_by` due to moments (3, points), which work on section rotations."""
        return _product(self._strained[1], cross(m, self._turned[..., :-1]))

    def _of_stations(self, matrices: np.ndarray) -> np.ndarray:
        """Transform matrices (6, 6, stations) of the stations to one matrix of the coordinates."""
        acting = np.flatnonzero(matrices.any(axis=(1, 2)) | matrices.any(axis=(0, 2)))
        motions = self.motions[:, acting]
        return _product(motions, np.einsum("abj,nbj->naj", matrices[np.ix_(acting, acting)], motions))

    @cached_property
    def mass(self) -> np.ndarray:
        """Mass matrix of the coordinates."""
        return self._of_stations(self.masses.matrix)


class BentInPlane(BentBeam):
    """Deformed beam that bends only in the plane of e1 and e2, where rotations about e3 simply add up."""

    @cached_property
    def rotations(self) -> np.ndarray:
        """Rotation matrices (..., 3, 3, points), section axes as columns, at Gauss points and tip."""
        angle = self.q @ self.beam.angles
        axes = np.zeros((*angle.shape[:-1], 3, 3, angle.shape[-1]))
        axes[..., 0, 0, :] = axes[..., 1, 1, :] = np.cos(angle)
        axes[..., 1, 0, :], axes[..., 2, 2, :] = np.sin(angle), 1.0
        axes[..., 0, 1, :] = -axes[..., 1, 0, :]
        return axes

    @cached_property
    def _turned(self) -> np.ndarray:
        """Rotation vectors (n, 3, sections) of sections per unit of each coordinate, in space-fixed axes."""
        return self.beam.angles[:, None] * np.array([0.0, 0.0, 1.0])[:, None]

    def _change_by(self, n: np.ndarray, m: np.ndarray, at_root: np.ndarray) -> np.ndarray:
        """Compute the derivatives (n, n) of virtual work with respect to coordinates, for constant forces."""
        angles, along = self.beam.angles[:, :-1], (self.tangents[:2] * n[:2]).sum(axis=0)
        return (angles * -along) @ angles.T


def _product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Compute the inner products of all pairs of n vectors (n, ...), summed over components and points."""
    return a.reshape(len(a), -1) @ b.reshape(len(b), -1).T
