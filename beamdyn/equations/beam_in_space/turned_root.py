"""Rotation of a root on springs, modelled as an infinitely short and soft piece of beam bent to an arc.

At s along the arc, from 0 to 1, the piece has turned by the vector s f, and the root by f.  The rotation R,
and the rotation W that a change of f adds, are those of a beam with the curvature f,

    R' = R skew(f),   W' = R df,

so that the root turns to its direction by the shortest rotation, whatever the order of the axes.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beamdyn.common.numerics import gauss_rule
from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.equations.beam_in_space import finite_rotations
from beamdyn.equations.discretization import integrals_between_points

_POINTS = 12  # Gauss points on the arc: rotations by half a circle are exact to rounding
_PLACES, _WEIGHTS = (gauss_rule(_POINTS)[0] + 1) / 2, gauss_rule(_POINTS)[1] / 2
_BEFORE = integrals_between_points(_POINTS) / 2


@dataclass(frozen=True)
class TurnedRoot(FieldsOnly):
    """Rotation of a root on springs, at one set of coordinates or several.

    Parameters
    ----------
    hinges : ndarray, shape (n, 3)
        Vector of the turn per coordinate [rad].
    q : ndarray, shape (..., n)
        Coordinates.
    """

    hinges: np.ndarray
    q: np.ndarray

    @cached_property
    def _vector(self) -> np.ndarray:
        """Rotation vector f (..., 3) of the root [rad]."""
        return self.q @ self.hinges

    @property
    def quaternion(self) -> np.ndarray:
        """Unit quaternion (..., 4) of the root's rotation."""
        return finite_rotations.quaternions_by_vectors(self._vector)

    @cached_property
    def _along(self) -> np.ndarray:
        """Rotation matrices (..., 3, 3, p) of the points of the arc."""
        turned = finite_rotations.quaternions_by_vectors(self._vector[..., None, :] * _PLACES[:, None])
        along = finite_rotations.rotation_matrices(turned.reshape(-1, _POINTS, 4))
        return along.reshape(*self._vector.shape[:-1], 3, 3, _POINTS)

    @cached_property
    def _changes(self) -> np.ndarray:
        """Derivatives (..., 3, 3) of the root's rotation by the components of the vector f, in columns."""
        return self._along @ _WEIGHTS

    def turning(self, rates: np.ndarray) -> np.ndarray:
        """Compute the angular velocity of the root (..., 3) [rad/s] at rates (..., n) of the coordinates."""
        return np.einsum("...ab,...b->...a", self._changes, rates @ self.hinges)

    def acceleration(self, rates: np.ndarray) -> np.ndarray:
        """Compute the angular acceleration of the root (..., 3) [rad/s2] at constant rates (..., n)."""
        turning = finite_rotations.turn(self._along, (rates @ self.hinges)[..., None])
        return finite_rotations.cross(turning @ _BEFORE.T, turning) @ _WEIGHTS

    def work(self, moment: np.ndarray) -> np.ndarray:
        """Compute the virtual work (..., n) of a moment on the root (..., 3), per coordinate."""
        return np.einsum("...ba,...b->...a", self._changes, moment) @ self.hinges.T

    def work_change(self, moment: np.ndarray) -> np.ndarray:
        """Compute the derivative (n, n) of a root moment's (3,) virtual work by the coordinates."""
        under = finite_rotations.cross(moment[:, None], (self._along @ _BEFORE.T).swapaxes(0, 1))
        return self.hinges @ np.einsum("aip,jap,p->ij", self._along, under, _WEIGHTS) @ self.hinges.T
