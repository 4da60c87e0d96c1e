"""The equations of a scene in modal coordinates, following its motion."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from beamdyn.equations.equations_of_motion import Equations, RootMotion
from beamdyn.scene.motion import Motion
from beamdyn.transient.weakly_modulated import Modulation


@dataclass(frozen=True)
class ModalSystem:
    """q'' + C q' + K(t) q = f(t) of a scene in modal coordinates, at arrays of times.

    Parameters
    ----------
    equations : Equations
        Equations in coordinates of unit mass.
    motion : Motion
        The motion that they follow.
    """

    equations: Equations
    motion: Motion

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return self.equations.size

    @cached_property
    def parts(self) -> dict[int, dict[str, np.ndarray]]:
        """For each order, the sum of the matrices that one quantity of the motion multiplies."""
        parts: dict[int, dict[str, np.ndarray]] = {0: {}, 1: {}}
        for term in self.equations.terms:
            if term.order < 2:
                whole = parts[term.order].setdefault(term.quantity, np.zeros((self.size, self.size)))
                whole[self.equations.fields[term.rows], self.equations.fields[term.columns]] += (
                    term.factor * term.matrix
                )
        return parts

    def root(self, t: np.ndarray) -> RootMotion:
        """Motion of the root at times t [s]."""
        return self.equations.root(self.motion.at(t))

    def coefficients(self, t: np.ndarray) -> tuple[np.ndarray | None, np.ndarray, np.ndarray]:
        """C (None if zero), K and f at times t."""
        root = self.root(np.asarray(t, dtype=float))
        C = _sum(self.parts[1], root) if self.parts[1] else None
        return C, _sum(self.parts[0], root), self.equations.load(root)

    def modulation(self, start: float, end: float) -> Modulation | None:
        """The equations from start to end [s] as constant ones that the root's acceleration modulates.

        None where the speed changes.
        """
        if self.motion.settled > start:
            return None
        root = self.root(np.linspace(start, end, 257)[1:-1])
        mean = RootMotion(*(np.asarray(getattr(root, f.name).mean()) for f in fields(RootMotion)))
        loads = {f.quantity: np.zeros(self.size) for f in self.equations.loads}
        for load in self.equations.loads:
            loads[load.quantity][self.equations.fields[load.rows]] += load.factor * load.vector

        def scalars(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            now = self.root(t)
            g = [getattr(now, quantity) for quantity in loads]
            return now.root_axial - mean.root_axial, np.stack(g, axis=-1)

        return Modulation(
            C=_sum(self.parts[1], mean) if self.parts[1] else None,
            K=_sum(self.parts[0], mean),
            G=self.parts[0].get("root_axial", np.zeros((self.size, self.size))),
            P=np.array(list(loads.values())),
            scalars=scalars,
        )

    def rhs(self, t: float, y: np.ndarray) -> np.ndarray:
        """Y' for y = (q, q'), as `solve_ivp` asks for it."""
        C, K, f = self.coefficients(np.asarray(t))
        q, v = np.split(y, 2)
        return np.concatenate([v, f - K @ q - (0 if C is None else C @ v)])

    def jacobian(self, t: float, y: np.ndarray) -> np.ndarray:
        """Derivative of y' with respect to y: exact, as the system is linear."""
        C, K, _ = self.coefficients(np.asarray(t))
        n = self.size
        J = np.zeros((2 * n, 2 * n))
        J[:n, n:], J[n:, :n] = np.eye(n), -K
        if C is not None:
            J[n:, n:] = -C
        return J


def _sum(parts: dict[str, np.ndarray], root: RootMotion) -> np.ndarray:
    """Sum of quantity times matrix, over the shape of the root's motion."""
    total = np.zeros((*root.unity.shape, *next(iter(parts.values())).shape))
    for quantity, matrix in parts.items():
        total += getattr(root, quantity)[..., None, None] * matrix
    return total
