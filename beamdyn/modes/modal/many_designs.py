"""Modes of many designs of one beam in a common basis, by batched eigenproblems.

The designs differ in their matrices and in speed.  They have no gyroscopic coupling; damping, if any, is the
same ratio for all modes at rest.  The errors are estimated as `beamdyn.modes.modal.error_estimate` does for a
single design.

Critical speeds and resonances need no search over speed: with B = m^2 M - K2,

    K0 v = speed^2 B v

holds where the stiffness is singular (m = 0) or a frequency is m times the speed.  As K0 is positive
definite, exactly j frequencies lie below the line m speed at speeds above the j-th lowest root (Sylvester's
law of inertia).  There the j-th mode, counted at that speed, meets the line, and it does so at most once.

In shapes of arrays, N counts designs, S speeds of each, n coordinates, k modes, L multiples of the speed, and
d outputs.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beamdyn.common.numerics import solve_lower
from beamdyn.equations.equations_of_motion import BACKWARD
from beamdyn.modes.modal.diagonal_stiffness import (
    LEAST_STIFFNESS,
    inverse_squares,
    rounding_of_matrices,
    solve_diagonal,
)
from beamdyn.modes.modal.eigenproblem import explained
from beamdyn.modes.modal.error_estimate import REGULAR, Parts, error_of_assumed_modes
from beamdyn.modes.modal.quadratic_eigenproblem import select_lowest

_EPS = float(np.finfo(float).eps)
_MOST_SPEEDS = 1000  # largest number of speeds of each design solved together, which limits the memory


@dataclass(frozen=True)
class PencilStack:
    """Matrices of the equations of N designs: M q'' + (K0 + speed^2 K2) q = 0.

    Parameters
    ----------
    K0 : ndarray, shape (coordinates, coordinates) or (N, coordinates, coordinates)
        Stiffness at rest, common to all designs or one for each.
    M, K2 : ndarray, shape (N, coordinates, coordinates)
        Mass, and stiffness divided by the squared speed, of each design.
    """

    K0: np.ndarray
    M: np.ndarray
    K2: np.ndarray

    def part(self, coordinates: np.ndarray) -> PencilStack:
        """Extract the matrices of a subset of the coordinates."""
        places = ..., *np.ix_(coordinates, coordinates)
        return PencilStack(self.K0[places], self.M[places], self.K2[places])


@dataclass(frozen=True)
class ManyModes:
    """Lowest k modes of N designs at S speeds each.

    Parameters
    ----------
    eigenvalue : ndarray of complex, shape (N, S, k)
        Eigenvalue s of exp(s t) [1/s]: imaginary, or positive where the beam diverges; complex if damped.
    error, rounding : ndarray, shape (N, S, k)
        Estimated relative error of the frequency, inf if unresolved; and the rounding part of it.
    static : ndarray, shape (N, S)
        Magnitude of the static displacement; nan at and above the critical speed.
    """

    eigenvalue: np.ndarray
    error: np.ndarray
    rounding: np.ndarray
    static: np.ndarray

    def meet(self, target: float) -> np.ndarray:
        """Return which designs have all errors below a target or at the level of rounding."""
        return np.all(self.error <= np.maximum(target, 3 * self.rounding), axis=(1, 2))


class StackedSolver:
    """Eigensolver for many designs, in coordinates in which each stiffness is diagonal at every speed.

    The method is the same as in `beamdyn.modes.modal.eigenproblem.Solver`, which solves one design.

    Parameters
    ----------
    stack : PencilStack
        The matrices.
    """

    def __init__(self, stack: PencilStack) -> None:
        self.stack, K0, one = stack, stack.K0, np.eye(stack.K0.shape[-1])
        with explained():
            L = np.linalg.cholesky(K0)
            one = np.broadcast_to(one, K0.shape)
            inverse = solve_lower(L, one) if K0.ndim == 2 else np.linalg.solve(L, one)
            turning = inverse @ stack.K2 @ np.swapaxes(inverse, -1, -2)
            self.growth, turned = np.linalg.eigh((turning + np.swapaxes(turning, -1, -2)) / 2)
        self.basis = np.swapaxes(inverse, -1, -2) @ turned
        mass = np.swapaxes(self.basis, 1, 2) @ stack.M @ self.basis
        self.mass = (mass + np.swapaxes(mass, -1, -2)) / 2

    @cached_property
    def lowest_at_rest(self) -> np.ndarray:
        """Lowest squared angular frequency at rest of each design."""
        return 1 / np.linalg.eigvalsh(self.mass)[:, -1]

    def solve(self, speeds: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Compute squared frequencies of designs at their speeds (designs, speeds), and rounding errors."""
        design, spin = _rows(speeds)
        terms = 1 + spin * np.abs(self.growth)[design]
        stiffness = 1 + spin * self.growth[design]
        with explained():
            lowest = self.lowest_at_rest[design]
            squared, z, rounding = solve_diagonal(self.mass[design], stiffness, count, lowest)
        size = np.abs(self.basis[design] @ z)
        rounding = rounding + rounding_of_matrices(terms, squared, z, size, np.abs(self.stack.M)[design])
        return squared, np.where(squared == 0, np.inf, rounding)

    def squares(self, speeds: np.ndarray, count: int) -> np.ndarray:
        """Compute squared frequencies of designs at speeds (designs, speeds), without rounding errors."""
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

    def damped(self, speeds: np.ndarray, ratio: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Compute eigenvalues and rounding errors; each design has one damping ratio of all modes at rest."""
        design, spin = _rows(speeds)
        # Unit of time in which frequencies are of order 1.
        time = np.sqrt(1 / self.lowest_at_rest)[design, None, None]
        stiffness = (1 + spin * self.growth[design])[:, :, None]
        n = stiffness.shape[1]
        # The square root of the mass matrix, as damping matrix, gives each mode the ratio 1/2, because the
        # stiffness at rest is the unit matrix.
        value, vector = np.linalg.eigh(self.mass)
        root = (vector * np.sqrt(np.maximum(value, 0.0))[:, None, :]) @ np.swapaxes(vector, 1, 2)
        B = np.zeros((len(design), 2 * n, 2 * n))
        B[:, :n, :n] = -2 * ratio[design, None, None] * root[design] / (time * stiffness)
        B[:, :n, n:] = -self.mass[design] / (time**2 * stiffness)
        B[:, n:, :n] = np.eye(n)
        with explained():
            inverse = np.linalg.eigvals(B) * time[:, :, 0]
        s = np.array([select_lowest(each, np.empty((0, 2 * n)), count)[0] for each in inverse])
        terms = (1 + spin * np.abs(self.growth)[design]).max(axis=1) / np.abs(stiffness[:, :, 0]).min(axis=1)
        return s, 8 * _EPS * (np.abs(s) * np.abs(inverse).max(axis=1)[:, None] + terms[:, None])

    def meeting(self, multiples: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Compute inverse squared speeds (designs, multiples, modes) at which lines meet frequencies.

        A line is a multiple of the speed.  For the multiple 0, the stiffness is singular.  Modes are in
        ascending order; a value that is not positive means that the mode meets the line at no speed.  The
        second result is the rounding error of the values.
        """
        n = self.growth.shape[1]
        matrices = multiples[:, None, None] ** 2 * self.mass[:, None]
        matrices[..., np.arange(n), np.arange(n)] -= self.growth[:, None]
        with explained():
            inverse = np.linalg.eigvalsh(matrices)
        rounding = 2 * BACKWARD * np.abs(inverse).max(axis=2, keepdims=True)
        return inverse[..., : -count - 1 : -1], rounding

    def static(self, speeds: np.ndarray, load: np.ndarray, outputs: np.ndarray) -> np.ndarray:
        """Compute magnitudes (designs, speeds) of static outputs, by each design's load per squared speed."""
        of_load = np.einsum("nik,ni->nk", self.basis, load)
        spin = speeds[:, :, None] ** 2
        stiffness = 1 + spin * self.growth[:, None, :]
        with np.errstate(divide="ignore", invalid="ignore"):
            compliance = of_load[:, None, :] * spin / stiffness
        tips = np.einsum("dk,nki,nsi->nsd", outputs, self.basis, compliance)
        return np.where(stiffness.min(axis=2) > 0, np.sqrt((tips**2).sum(axis=2)), np.nan)


@dataclass(frozen=True)
class Estimate:
    """Parameters of the error estimate for a basis.

    Parameters
    ----------
    is_slender : bool
        Whether the designs are slender, clamped beams that bend in one plane.
    parts : tuple of float
        How the basis converges: see `parts_of_distances`.
    rounding : float
        Ratio of rounding errors to those of a slender clamped beam in one plane.
    """

    is_slender: bool = True
    parts: Parts = REGULAR
    rounding: float = 1.0


def solve_many(
    stack: PencilStack,
    coarse: PencilStack,
    speeds: np.ndarray,
    count: int,
    load: np.ndarray,
    outputs: np.ndarray,
    ratio: np.ndarray | None = None,
    estimate: Estimate = Estimate(),
) -> ManyModes:
    """Compute the modes of the designs in a stack, and estimate the errors by a coarser basis.

    Parameters
    ----------
    stack, coarse : PencilStack
        Matrices of N designs, in a basis and in a coarser one.
    speeds : ndarray, shape (N, speeds)
        Speeds of each design [rad/s].
    count : int
        Number k of modes.
    load : ndarray, shape (N, coordinates)
        Static load per squared speed.
    outputs : ndarray, shape (outputs, coordinates)
        Coefficients of the components of the requested static displacement, such as that of the tip.
    ratio : ndarray, shape (N,), optional
        Damping ratio of the modes at rest; undamped if not given.
    estimate : Estimate
        How the errors are estimated.

    Returns
    -------
    ManyModes
    """
    fine, coarser = StackedSolver(stack), StackedSolver(coarse)
    parts = np.split(speeds, range(_MOST_SPEEDS, speeds.shape[1], _MOST_SPEEDS), axis=1)
    solved = [_solve_at(fine, coarser, part, count, ratio, estimate) for part in parts]
    of_all = (np.concatenate(values, axis=1) for values in zip(*solved, strict=True))
    return ManyModes(*of_all, static=fine.static(speeds, load, outputs))


def _solve_at(
    fine: StackedSolver,
    coarser: StackedSolver,
    speeds: np.ndarray,
    count: int,
    ratio: np.ndarray | None,
    estimate: Estimate,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Compute eigenvalues, their errors and rounding errors: k modes of N designs at S speeds, (N, S, k)."""
    if ratio is None:
        squared, rounding = fine.solve(speeds, count)
        squared, distance = -squared, coarser.squares(speeds, count) - squared
        # The eigenvalues s are imaginary if the beam vibrates: s^2 = -w^2.
        s = np.sqrt(np.abs(squared)) * np.where(squared < 0, 1j, 1.0)
    else:
        s, rounding = fine.damped(speeds, ratio, count)
        squared = s**2
        distance = squared - coarser.damped(speeds, ratio, count)[0] ** 2
    rounding = estimate.rounding * rounding
    lowest = np.repeat(fine.lowest_at_rest, speeds.shape[1])
    kind = estimate.is_slender, estimate.parts
    error = error_of_assumed_modes(squared, distance, rounding, lowest, *kind)
    shape = *speeds.shape, count
    return s.reshape(shape), error.reshape(shape), rounding.reshape(shape)


def speeds_of_meeting(
    stack: PencilStack,
    coarse: PencilStack,
    multiples: np.ndarray,
    count: int,
    top: np.ndarray,
    estimate: Estimate = Estimate(),
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Find the speeds at which modes meet lines, or (multiple 0) at which the stiffness is singular.

    Parameters
    ----------
    stack, coarse, estimate
        As for `solve_many`.
    multiples : ndarray, shape (L,)
        Multiples of the speed.
    count : int
        Number k of modes.
    top : ndarray, shape (N,)
        Largest speed of the search [rad/s]; inf without a limit.

    Returns
    -------
    speed : ndarray, shape (N, L, modes)
        Speeds [rad/s]; inf if a mode does not meet the line up to the largest speed.
    error, rounding : ndarray, shape (N, L, modes)
        Estimated relative error of the speed, inf if there is no speed or it is unresolved; and the rounding
        part of it.
    """
    inverse, rounding = StackedSolver(stack).meeting(multiples, count)
    coarser, _ = StackedSolver(coarse).meeting(multiples, count)
    exists = inverse > np.maximum(rounding, top[:, None, None] ** -2.0)
    squared = 1 / np.where(exists, inverse, 1.0)
    of_coarser = 1 / np.where(
        coarser > 0, coarser, np.where(exists, inverse / 2, 1.0)
    )  # unresolved if no mode of the coarser basis meets the line
    distance = np.where(exists, of_coarser - squared, 0.0)
    relative = estimate.rounding * rounding * squared / 2
    of_rows, off, sure = (values.reshape(-1, count) for values in (-squared, distance, relative))
    kind = estimate.is_slender, estimate.parts
    error = error_of_assumed_modes(of_rows, off, sure, squared[..., 0].ravel(), *kind).reshape(squared.shape)
    return np.where(exists, np.sqrt(squared), np.inf), np.where(exists, error, np.inf), relative


def _rows(speeds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """List the design index and the squared speed of each problem: a design at a speed."""
    return np.repeat(np.arange(len(speeds)), speeds.shape[1]), speeds.reshape(-1, 1) ** 2
