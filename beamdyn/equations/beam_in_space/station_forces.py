"""Stations of a beam: the points at which masses are placed and forces act.

The stations are N Gauss points along the beam, its tip, and k point masses.  Motions of a station are (X, W):
the displacement of the beam's axis and the rotation of its section, in axes at the root.  The corresponding
forces (F, M) are the force and the moment about the beam's axis.  Arrays have 6 components, then the
N + 1 + k stations; point masses have no rotation, so that it is set to 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.equations.beam_in_space.finite_rotations import cross, skew, turn, turn_tensors
from beamdyn.equations.discretization import ArcQuadrature

ZERO = np.zeros(3)  # zero vector, for a force, moment or motion that is absent


@dataclass(frozen=True)
class BeamStations(FieldsOnly):
    """Integrals along a beam from the root to its stations, and the transposed operations.

    Parameters
    ----------
    quadrature : ArcQuadrature
        Gauss rule along the beam, of N points.
    length : float
        Length of the beam [m].
    lumps : ndarray, shape (k,)
        Positions x/L of the point masses.
    """

    quadrature: ArcQuadrature
    length: float
    lumps: np.ndarray

    @property
    def sections(self) -> int:
        """Number N + 1 of stations with a rotation: Gauss points and tip."""
        return len(self.quadrature.xi) + 1

    @property
    def count(self) -> int:
        """Number N + 1 + k of all stations: Gauss points, tip and point masses."""
        return self.sections + len(self.lumps)

    def to_places(self, xi: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Integrate values per length at the Gauss points from the root to k positions x/L = xi: (..., k)."""
        return self.length * values @ self.quadrature.integrate_to(xi).T

    @cached_property
    def _to_lumps(self) -> np.ndarray:
        """Weights (point masses, Gauss points) of the integrals from the root to the point masses."""
        return self.quadrature.integrate_to(self.lumps)

    def to_sections(self, values: np.ndarray) -> np.ndarray:
        """Integrate values per length at the Gauss points from the root to each of them and to the tip."""
        return self.length * self.quadrature.integrate(values)

    def to_all(self, values: np.ndarray) -> np.ndarray:
        """Integrate values per length at the Gauss points from the root to all stations: (..., stations)."""
        to_sections = self.to_sections(values)
        if not self.lumps.size:
            return to_sections
        return np.concatenate([to_sections, self.length * values @ self._to_lumps.T], axis=-1)

    def of_all(self, of_sections: np.ndarray) -> np.ndarray:
        """Append zeros for the point masses to values at Gauss points and tip: shape (..., stations)."""
        none = np.zeros((*of_sections.shape[:-1], len(self.lumps)))
        return np.concatenate([of_sections, none], axis=-1) if self.lumps.size else of_sections

    def from_sections(self, forces: np.ndarray) -> np.ndarray:
        """Apply the transpose of `to_sections`: sum the forces at sections beyond each Gauss point."""
        return self.length * self.quadrature.transposed(forces)

    def from_all(self, forces: np.ndarray) -> np.ndarray:
        """Apply the transpose of `to_all`: sum the forces (..., stations) beyond each Gauss point."""
        total = self.from_sections(forces[..., : self.sections])
        if self.lumps.size:
            total += self.length * forces[..., self.sections :] @ self._to_lumps
        return total


@dataclass(frozen=True)
class Masses:
    """Masses at the stations of a beam, described in the section axes of the unloaded beam.

    Parameters
    ----------
    mass : ndarray, shape (stations,)
        Masses [kg].
    centre : ndarray, shape (3, sections)
        Vectors from the axis to the centres of mass [m].
    inertia : ndarray, shape (3, 3, sections)
        Inertia tensors about the centres of mass [kg m2].
    """

    mass: np.ndarray
    centre: np.ndarray
    inertia: np.ndarray

    def turned(self, R: np.ndarray, positions: np.ndarray) -> MassesInSpace:
        """Move the masses to positions (..., 3, stations) of the axis, with the sections rotated by R."""
        levers = np.zeros_like(positions)
        levers[..., : self.centre.shape[1]] = turn(R, self.centre)
        inertia = np.zeros((*R.shape[:-1], len(self.mass)))
        if self.inertia.any():
            inertia[..., : R.shape[-1]] = turn_tensors(R, self.inertia)
        return MassesInSpace(self.mass, positions + levers, levers, inertia)


class StationForces(NamedTuple):
    """Forces at the stations, linear in a small motion: (F, M) = force + tangent (X, W).

    Parameters
    ----------
    force : ndarray, shape (6, stations)
        Forces [N] and moments [N m].
    tangent : ndarray, shape (6, 6, stations)
        Derivatives of forces and moments with respect to displacements and rotations of the stations.
    """

    force: np.ndarray
    tangent: np.ndarray


@dataclass(frozen=True)
class MassesInSpace:
    """Masses m on a deformed beam: mass centre c = axis + lever, inertia tensor I about the centre.

    Inertial forces are here mass times acceleration, and inertial moments the rate of angular momentum: the
    sign is that of the left-hand side of the equations of motion.

    Parameters
    ----------
    mass : ndarray, shape (stations,)
        Masses [kg].
    centre, lever : ndarray, shape (3, stations)
        Vectors to the centres of mass from the root, and from the beam's axis [m].
    inertia : ndarray, shape (3, 3, stations)
        Inertia tensors [kg m2].
    """

    mass: np.ndarray
    centre: np.ndarray
    lever: np.ndarray
    inertia: np.ndarray

    @property
    def matrix(self) -> np.ndarray:
        """Compute the mass matrices (6, 6, stations) of the stations."""
        matrix = self._of_centre(np.eye(3))
        matrix[3:, 3:] += self.inertia
        return matrix

    def carried(
        self, axis: np.ndarray, speed_squared: float = 0.0, acceleration: float = 0.0, root: np.ndarray = ZERO
    ) -> StationForces:
        """Compute the inertial forces on masses whose carrier rotates about an axis (3,) and moves the root.

        With B v = speed_squared axis x v + acceleration v, a mass has the acceleration B (axis x c) plus that
        of the root (3,), and the angular momentum I axis about its centre has the rate B (I axis).
        """
        about = skew(axis)
        B = speed_squared * about + acceleration * np.eye(3)
        F, tangent = self.mass * (B @ about @ self.centre + root[:, None]), self._of_centre(B @ about)
        M = np.zeros_like(F)
        if self.inertia.any():
            momentum = axis @ self.inertia
            M += B @ momentum
            tangent[3:, 3:] += np.tensordot(B, about.T @ self.inertia - skew(momentum), 1)
        if self.lever.any():
            M += cross(self.lever, F)
            tangent[3:, 3:] += np.einsum("abj,bcj->acj", skew(F), skew(self.lever))
        return StationForces(np.concatenate([F, M]), tangent)

    def _of_centre(self, A: np.ndarray) -> np.ndarray:
        """Build matrices (6, 6, stations) from small motions to forces and moments about the beam's axis.

        The force is the mass times A times the displacement X + W x lever of the mass centre.
        """
        matrix = np.zeros((6, 6, len(self.mass)))
        matrix[:3, :3] = A[..., None] * self.mass
        if self.lever.any():
            matrix[:3, 3:] = -np.einsum("abj,bcj->acj", matrix[:3, :3], skew(self.lever))
            matrix[3:] = np.einsum("abj,bcj->acj", skew(self.lever), matrix[:3])
        return matrix
