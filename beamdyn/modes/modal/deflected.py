"""Eigensolver of a beam that vibrates about the equilibrium to which rotation bends it."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from beamdyn.equations.elastica import Elastica
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.modes.modal.eigen import Solver
from beamdyn.modes.modal.eigensolver import Eigen, Eigensolver
from beamdyn.modes.modal.equilibrium import Branch, SteadyLoad, find_bent, follow_to


class DeflectedSolver(Eigensolver):
    """Eigensolver about the equilibrium at each speed.

    Parameters
    ----------
    elastica : Elastica
        Equations of motion.
    branch : {"straight", "bent"}
        Equilibria that are meant: those that follow from rest, or those beside them.
    """

    def __init__(self, elastica: Elastica, branch: Branch) -> None:
        self.elastica = elastica
        self.branch: Branch = branch
        self.pencil = elastica.linear.steady()  # about the straight beam
        self._straight = Solver(self.pencil)
        self._found: dict[float, np.ndarray] = {}
        self._solved: dict[tuple[float, int], Eigen] = {}

    @property
    def conservative(self) -> bool:
        """False: a bent beam in the plane of rotation is gyroscopic."""
        return False

    @cached_property
    def lowest_at_rest(self) -> float:
        """Lowest squared angular frequency at rest [rad2/s2], plus `pencil.shift`."""
        return self._straight.lowest_at_rest

    @cached_property
    def load(self) -> SteadyLoad:
        """Problem of the equilibria."""
        return SteadyLoad(self.elastica, self.lowest_at_rest)

    @property
    def softening(self) -> float:
        """Largest loss of stiffness of the straight beam per squared speed, as of `Solver`."""
        return self._straight.softening

    @property
    def critical_speed(self) -> float:
        """Lowest speed at which the straight beam buckles [rad/s]; inf where rotation bends it instead."""
        return np.inf if self.load.transverse else self._straight.critical_speed

    @property
    def critical_rounding(self) -> float:
        """Estimated relative rounding error of the critical speed."""
        return self._straight.critical_rounding

    def solve(self, speeds: np.ndarray, count: int) -> Eigen:
        """Compute the `count` lowest modes at each speed [rad/s], once each: as `Solver.solve`.

        Raises
        ------
        NoEquilibrium
            An ArithmeticError: if the branch of equilibria does not reach a speed.
        """
        missing = np.array([v for v in np.unique(speeds) if (v, count) not in self._solved])
        for v, equations in zip(missing.tolist(), self.equations(missing), strict=True):
            self._solved[v, count] = Solver(equations.steady()).solve(np.array([v]), count)
        each = [self._solved[v, count] for v in speeds.tolist()]
        return Eigen(
            *(
                np.concatenate([getattr(e, name) for e in each])
                for name in ("eigenvalue", "vector", "rounding")
            )
        )

    def solve_static(self, speeds: np.ndarray, outputs: np.ndarray) -> np.ndarray:
        """Compute linear functions of the coordinates in equilibrium: as `Solver.solve_static`."""
        return self.equilibria(speeds) @ outputs.T

    def equations(self, speeds: np.ndarray) -> list[Equations]:
        """Equations linear about the equilibrium at each speed."""
        return [self.elastica.at(q).linearized() for q in self.equilibria(speeds)]

    def tips(self, speeds: np.ndarray) -> np.ndarray:
        """Deflection of the tip along e in equilibrium [m], shape (S, 1)."""
        return self.elastica.tip(self.equilibria(speeds))[:, 1:]

    def equilibria(self, speeds: np.ndarray) -> np.ndarray:
        """Coordinates (S, n) in equilibrium at each speed, each computed once."""
        missing = np.array([v for v in np.unique(np.abs(speeds)) if v not in self._found])
        if len(missing):
            start = self._start(missing)
            self._found.update(
                zip(missing.tolist(), follow_to(self.load, missing, self._found[start], start), strict=True)
            )
        return np.array([self._found[abs(v)] for v in speeds])

    def _start(self, missing: np.ndarray) -> float:
        """A speed near those that are missing at which the equilibrium is known."""
        if not self._found:
            fastest = float(missing[-1])
            self._found |= (
                {0.0: np.zeros(self.size)}
                if self.branch == "straight"
                else {fastest: find_bent(self.load, fastest)}
            )
        known = np.array(list(self._found))
        return float(known[np.abs(known - missing[0]).argmin()])
