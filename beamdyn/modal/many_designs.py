"""Modes of many designs of one beam, in one basis, by batched eigenproblems.

The designs differ in the mass, in the stiffness by rotation, and in speed; their stiffness at rest is the
same.  They are slender beams, clamped, in one plane, so that modes are real; the errors are those that
`beamdyn.modal.error_estimate` states of a single one.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beamdyn.common.triangular import solve_lower
from beamdyn.modal.eigen import (
    LEAST_STIFFNESS,
    explained,
    inverse_squares,
    rounding_of_matrices,
    solve_diagonal,
)
from beamdyn.modal.error_estimate import error_of_assumed_modes

_MOST_SPEEDS = 1000  # of each design at once, which bounds the memory


@dataclass(frozen=True)
class PencilStack:
    """Matrices of N designs: M q'' + (K0 + speed^2 K2) q = 0.

    Parameters
    ----------
    K0 : ndarray, shape (n, n)
        Stiffness at rest of all designs.
    M, K2 : ndarray, shape (N, n, n)
        Mass, and stiffness per squared speed, of each.
    """

    K0: np.ndarray
    M: np.ndarray
    K2: np.ndarray

    def part(self, coordinates: np.ndarray) -> PencilStack:
        """The same over some of the coordinates."""
        places = np.ix_(coordinates, coordinates)
        return PencilStack(self.K0[places], self.M[:, *places], self.K2[:, *places])


@dataclass(frozen=True)
class ManyModes:
    """The k lowest modes of N designs at S speeds each.

    Parameters
    ----------
    squared : ndarray, shape (N, S, k)
        Squared angular frequencies [rad2/s2], negative where the beam diverges.
    error, rounding : ndarray, shape (N, S, k)
        Estimated relative error of the frequency, inf where unresolved; and the part of rounding in it.
    static : ndarray, shape (N, S)
        Displacement in a direction under a static load per squared speed; nan from the critical speed on.
    """

    squared: np.ndarray
    error: np.ndarray
    rounding: np.ndarray
    static: np.ndarray

    def meet(self, target: float) -> np.ndarray:
        """Which designs (N,) have all errors below a target or at the level of rounding."""
        return np.all(self.error <= np.maximum(target, 3 * self.rounding), axis=(1, 2))


class StackedSolver:
    """Eigensolver of a stack, in coordinates in which the stiffness of each is diagonal at every speed.

    It does for each design what `beamdyn.modal.eigen.Solver` does for one.

    Parameters
    ----------
    stack : PencilStack
        The matrices.
    """

    def __init__(self, stack: PencilStack) -> None:
        self.stack = stack
        with explained():
            inverse = solve_lower(np.linalg.cholesky(stack.K0), np.eye(len(stack.K0)))
        with explained():
            self.growth, turned = np.linalg.eigh(_symmetric(inverse @ stack.K2 @ inverse.T))
        self.basis = inverse.T @ turned
        self.mass = _symmetric(np.swapaxes(self.basis, 1, 2) @ stack.M @ self.basis)

    @cached_property
    def lowest_at_rest(self) -> np.ndarray:
        """Lowest squared frequency at rest of each design (N,)."""
        return 1 / np.linalg.eigvalsh(self.mass)[:, -1]

    def solve(self, speeds: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Squared frequencies (N S, k) at the speeds (N, S) of the designs, and their rounding errors."""
        design, spin = _rows(speeds)
        terms = 1 + spin * np.abs(self.growth)[design]
        stiffness = 1 + spin * self.growth[design]
        with explained():
            found = solve_diagonal(self.mass[design], stiffness, count, self.lowest_at_rest[design])
        squared, z, rounding = found
        size = np.abs(self.basis[design] @ z)
        rounding = rounding + rounding_of_matrices(terms, squared, z, size, np.abs(self.stack.M)[design])
        return squared, np.where(squared == 0, np.inf, rounding)

    def squares(self, speeds: np.ndarray, count: int) -> np.ndarray:
        """Squared frequencies (N S, k) alone."""
        design, spin = _rows(speeds)
        stiffness = 1 + spin * self.growth[design]
        stiff = stiffness.min(axis=1) >= LEAST_STIFFNESS
        squared = np.empty((len(stiff), count))
        with explained():
            squared[stiff] = 1 / inverse_squares(self.mass[design[stiff]], stiffness[stiff], count)
            if not stiff.all():
                soft = design[~stiff]
                lowest = self.lowest_at_rest[soft]
                squared[~stiff] = solve_diagonal(self.mass[soft], stiffness[~stiff], count, lowest)[0]
        return squared

    def static(self, speeds: np.ndarray, load: np.ndarray, output: np.ndarray) -> np.ndarray:
        """Static value (N, S) of an output (n,) under loads (N, n) per squared speed."""
        per_mode = np.einsum("nik,ni->nk", self.basis, load) * (output @ self.basis)
        spin = speeds[:, :, None] ** 2
        stiffness = 1 + spin * self.growth[:, None, :]
        with np.errstate(divide="ignore", invalid="ignore"):
            value = (per_mode[:, None, :] * spin / stiffness).sum(axis=2)
        return np.where(stiffness.min(axis=2) > 0, value, np.nan)


def solve_many(
    stack: PencilStack,
    coarse: np.ndarray,
    speeds: np.ndarray,
    count: int,
    load: np.ndarray,
    output: np.ndarray,
) -> ManyModes:
    """Solve the designs of a stack, and estimate the errors by a coarser basis.

    Parameters
    ----------
    stack : PencilStack
        Matrices of N designs.
    coarse : ndarray of int
        Coordinates whose functions span those of the coarser basis.
    speeds : ndarray, shape (N, S)
        Speeds of each design [rad/s].
    count : int
        Number k of modes.
    load : ndarray, shape (N, n)
        Static load per squared speed.
    output : ndarray, shape (n,)
        Direction in which the static displacement is wanted, such as that of the tip.

    Returns
    -------
    ManyModes
    """
    fine, coarser = StackedSolver(stack), StackedSolver(stack.part(coarse))
    parts = np.split(speeds, range(_MOST_SPEEDS, speeds.shape[1], _MOST_SPEEDS), axis=1)
    solved = [_solve_at(fine, coarser, part, count) for part in parts]
    of_rows = (np.concatenate(values, axis=1) for values in zip(*solved, strict=True))
    return ManyModes(*of_rows, static=fine.static(speeds, load, output))


def _solve_at(
    fine: StackedSolver, coarser: StackedSolver, speeds: np.ndarray, count: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Squared frequencies, their errors and the part of rounding in these, (N, S, k), at speeds (N, S)."""
    squared, rounding = fine.solve(speeds, count)
    distance = squared - coarser.squares(speeds, count)
    lowest = np.repeat(fine.lowest_at_rest, speeds.shape[1])
    # The eigenvalues s are imaginary where the beam vibrates: s^2 = -w^2.
    error = error_of_assumed_modes(-squared, -distance, rounding, lowest)
    shape = *speeds.shape, count
    return squared.reshape(shape), error.reshape(shape), rounding.reshape(shape)


def _rows(speeds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Design (N S,) and squared speed (N S, 1) of each problem."""
    return np.repeat(np.arange(len(speeds)), speeds.shape[1]), speeds.reshape(-1, 1) ** 2


def _symmetric(A: np.ndarray) -> np.ndarray:
    return (A + np.swapaxes(A, -1, -2)) / 2
