"""A root that springs let turn: like a piece of the beam, infinitely short and soft, that bends to an arc.

The point s of the arc, from 0 to 1, has turned by the vector s f, the root by f.  As of a beam with the
curvature f, its rotation R, and the rotation W that a change of f adds, follow from

    R' = R skew(f),   W' = R df,

so that the root turns to its direction by the shortest rotation, whichever axis is named first.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beamdyn.common.numerics import gauss_rule
from beamdyn.common.results.read_only import FieldsOnly
from beamdyn.equations.beam_in_space.finite_rotations import (
    cross,
    quaternions_by_vectors,
    rotation_matrices,
    turn,
)
from beamdyn.equations.discretization import integrals_between_points

_POINTS = 12  # of the Gauss rule on the arc: turns by half a circle are exact to rounding
_PLACES, _WEIGHTS = (gauss_rule(_POINTS)[0] + 1) / 2, gauss_rule(_POINTS)[1] / 2
_BEFORE = integrals_between_points(_POINTS) / 2


@dataclass(frozen=True)
class TurnedRoot(FieldsOnly):
    """A root that has turned, at one set of coordinates or several.

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
        """Vector f (..., 3) by which the root has turned."""
        return self.q @ self.hinges

    @property
    def quaternion(self) -> np.ndarray:
        """Unit quaternion (..., 4) of the turn."""
        return quaternions_by_vectors(self._vector)

    @cached_property
    def _along(self) -> np.ndarray:
        """Rotations (..., 3, 3, p) of the points of the arc."""
        turned = quaternions_by_vectors(self._vector[..., None, :] * _PLACES[:, None])
        along = rotation_matrices(turned.reshape(-1, _POINTS, 4))
        return along.reshape(*self._vector.shape[:-1], 3, 3, _POINTS)

    @cached_property
    def _changes(self) -> np.ndarray:
        """Turning of the root by the components of the vector, in columns (..., 3, 3)."""
        return self._along @ _WEIGHTS

    def turning(self, rates: np.ndarray) -> np.ndarray:
        """Turning rate (..., 3) by rates (..., n)."""
        return np.einsum("...ab,...b->...a", self._changes, rates @ self.hinges)

    def acceleration(self, rates: np.ndarray) -> np.ndarray:
        """Angular acceleration (..., 3) at constant rates (..., n)."""
        turning = turn(self._along, (rates @ self.hinges)[..., None])
        return cross(turning @ _BEFORE.T, turning) @ _WEIGHTS

    def work(self, moment: np.ndarray) -> np.ndarray:
        """Work (..., n) of a moment (..., 3) per coordinate."""
        return np.einsum("...ba,...b->...a", self._changes, moment) @ self.hinges.T

    def work_change(self, moment: np.ndarray) -> np.ndarray:
        """Derivative (n, n) of the work of a moment (3,) by the coordinates."""
        under = cross(moment[:, None], (self._along @ _BEFORE.T).swapaxes(0, 1))
        return self.hinges @ np.einsum("aip,jap,p->ij", self._along, under, _WEIGHTS) @ self.hinges.T
