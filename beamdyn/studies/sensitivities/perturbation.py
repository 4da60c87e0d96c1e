"""First-order change of eigenvalues and critical speeds, from the derivatives of the equations' matrices.

With P(s) = s^2 M + s (C + omega G) + K0 + omega^2 K2 and P v = 0, w^T P = 0, a change dP of P changes the
eigenvalue by ds = -w^T dP v / (w^T (2 s M + C + omega G) v)  (Lancaster, Lambda-Matrices and Vibrating
Systems, 1966, section 7).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
import scipy.linalg

from beamdyn.equations.equations_of_motion import SteadyPencil


@dataclass(frozen=True)
class PencilChange:
    """Derivatives of the matrices of a `SteadyPencil`, each of shape (n, n)."""

    M: np.ndarray
    C: np.ndarray
    G: np.ndarray
    K0: np.ndarray
    K2: np.ndarray

    @classmethod
    def of(cls, pencils: Sequence[SteadyPencil], weights: np.ndarray) -> PencilChange:
        """The weighted sum of some equations."""
        return cls(*(_sum(weights, [getattr(p, f.name) for p in pencils]) for f in fields(cls)))

    def at(self, s: complex, speed: float) -> np.ndarray:
        """The derivative of P(s) at a speed [rad/s]."""
        return s**2 * self.M + s * (self.C + speed * self.G) + self.stiffness(speed)

    def stiffness(self, speed: float) -> np.ndarray:
        """The derivative of the stiffness at a speed [rad/s]."""
        return self.K0 + speed**2 * self.K2


def _sum(weights: np.ndarray, matrices: list[np.ndarray]) -> np.ndarray:
    return np.tensordot(weights, np.array(matrices), axes=1)


@dataclass(frozen=True)
class PerturbedModes:
    """Modes at a speed, with what their eigenvalues' derivatives need.

    Parameters
    ----------
    pencil : SteadyPencil
        The equations.
    speed : float
        Speed [rad/s].
    eigenvalue : ndarray, shape (k,)
        Eigenvalues s [1/s].
    right, left : ndarray, shape (n, k)
        Eigenvectors v and w.
    """

    pencil: SteadyPencil
    speed: float
    eigenvalue: np.ndarray
    right: np.ndarray
    left: np.ndarray

    @classmethod
    def of(
        cls, pencil: SteadyPencil, speed: float, eigenvalue: np.ndarray, right: np.ndarray
    ) -> PerturbedModes:
        """Add the left eigenvectors to modes."""
        left = [_left(pencil, speed, s, v) for s, v in zip(eigenvalue, right.T, strict=True)]
        return cls(pencil, speed, eigenvalue, right, np.array(left).T)

    def derivatives(self, change: PencilChange) -> np.ndarray:
        """Derivatives of the eigenvalues where the matrices change, shape (k,)."""
        return np.array(
            [
                self._quotient(k, change.at(s, self.speed)) if s else _NONE
                for k, s in enumerate(self.eigenvalue)
            ]
        )

    def speed_derivatives(self) -> np.ndarray:
        """Derivatives of the eigenvalues with respect to the speed, shape (k,)."""
        p = self.pencil
        changes = (s * p.G + 2 * self.speed * p.K2 for s in self.eigenvalue)
        return np.array(
            [self._quotient(k, dP) if self.eigenvalue[k] else _NONE for k, dP in enumerate(changes)]
        )

    def scales(self) -> np.ndarray:
        """What P(s) would change the eigenvalues by if all its entries had one sign, shape (k,).

        Rounding errors are relative to this.
        """
        p = self.pencil
        whole = np.abs(p.K0) + self.speed**2 * np.abs(p.K2)
        sums = [
            np.abs(self.left[:, k]) @ (whole + abs(s) ** 2 * np.abs(p.M)) @ np.abs(self.right[:, k])
            for k, s in enumerate(self.eigenvalue)
        ]
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.array(sums) / np.abs([self._slope(k) for k in range(len(self.eigenvalue))])

    def _quotient(self, k: int, dP: np.ndarray) -> complex:
        return -complex(self.left[:, k] @ dP @ self.right[:, k]) / self._slope(k)

    def _slope(self, k: int) -> complex:
        """The derivative of P(s) by s between both eigenvectors."""
        p = self.pencil
        dP = 2 * self.eigenvalue[k] * p.M + p.C + self.speed * p.G
        return complex(self.left[:, k] @ dP @ self.right[:, k])


_NONE = complex(np.nan, np.nan)  # a double eigenvalue 0 moves by the root of a change


def _left(pencil: SteadyPencil, speed: float, s: complex, v: np.ndarray) -> np.ndarray:
    """The left eigenvector of an eigenvalue.

    Without gyroscopic terms all matrices are symmetric; without damping P(s)^T is the conjugate of P(s).
    """
    if not (speed * pencil.G).any():
        return v
    if not pencil.C.any():
        return v.conj()
    P = s**2 * pencil.M + s * (pencil.C + speed * pencil.G) + pencil.K0 + speed**2 * pencil.K2
    scale = np.sqrt(np.diag(pencil.K0) + abs(s) ** 2 * np.diag(pencil.M))  # a hinge has no stiffness
    return scipy.linalg.svd(P.T / np.outer(scale, scale))[2][-1].conj() / scale


def critical_vector(pencil: SteadyPencil, speed: float) -> np.ndarray:
    """The shape in which the beam buckles at its critical speed, shape (n,)."""
    return scipy.linalg.eigh(pencil.K0 + speed**2 * pencil.K2, pencil.K0, subset_by_index=[0, 0])[1][:, 0]


def critical_derivative(pencil: SteadyPencil, speed: float, v: np.ndarray, change: PencilChange) -> float:
    """Derivative of the critical speed where the matrices change."""
    return float(-(v @ change.stiffness(speed) @ v) / (2 * speed * (v @ pencil.K2 @ v)))
