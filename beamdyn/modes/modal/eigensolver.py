"""Interface of eigensolvers of the equations at steady speed, and the modes that they find."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from beamdyn.equations.equations_of_motion import SteadyPencil


@dataclass(frozen=True)
class Eigen:
    """The k lowest modes at each of S speeds.

    Parameters
    ----------
    eigenvalue : ndarray, shape (S, k)
        Eigenvalues s of q = v exp(s t) [1/s]: of each conjugate pair the one with Im s > 0, of each real
        pair the larger.
    vector : ndarray, shape (S, n, k)
        Mass-normalised eigenvectors v; real if the equations are conservative.
    rounding : ndarray, shape (S, k)
        Estimated relative rounding error of |s|.
    """

    eigenvalue: np.ndarray
    vector: np.ndarray
    rounding: np.ndarray


class Eigensolver(Protocol):
    """Eigensolver of the equations at any steady speed.

    Attributes
    ----------
    pencil : SteadyPencil
        Equations at steady speed.
    """

    pencil: SteadyPencil

    @property
    def size(self) -> int:
        """Number n of coordinates and modes."""
        return len(self.pencil.M)

    @property
    def conservative(self) -> bool:
        """Whether the equations have neither damping nor gyroscopic terms: then modes are real."""
        return self.pencil.conservative

    @cached_property
    def lowest_at_rest(self) -> float:
        """Lowest squared angular frequency at rest [rad2/s2], plus `pencil.shift`."""
        ...

    @property
    def softening(self) -> float:
        """Largest loss of stiffness per squared speed, relative to that at rest [s2]; 0 within rounding."""
        ...

    @property
    def critical_speed(self) -> float:
        """Lowest speed at which the stiffness is singular [rad/s]; inf if there is none."""
        return self.softening**-0.5 if self.softening else np.inf

    @property
    def critical_rounding(self) -> float:
        """Estimated relative rounding error of the critical speed."""
        ...

    def solve(self, speeds: np.ndarray, count: int) -> Eigen:
        """Compute the `count` lowest modes at each speed [rad/s].

        Raises
        ------
        LinAlgError
            A ValueError: if stiffness and mass span more digits than double precision has.
        """
        ...

    def eigenvalues(self, speeds: np.ndarray, count: int) -> np.ndarray:
        """Compute the eigenvalues of the `count` lowest modes at each speed [rad/s], shape (S, count)."""
        return self.solve(speeds, count).eigenvalue

    def solve_static(self, speeds: np.ndarray, outputs: np.ndarray) -> np.ndarray:
        """Compute linear functions of the coordinates in static equilibrium under the rotation.

        Parameters
        ----------
        speeds : ndarray, shape (S,)
            Speeds [rad/s].
        outputs : ndarray, shape (d, n)
            The functions per coordinate, such as the tip deflections.

        Returns
        -------
        ndarray, shape (S, d)
            nan from the critical speed on.
        """
        ...
