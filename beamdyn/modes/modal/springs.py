"""Eigenproblems of a beam on root springs, whose stiffness at rest may be singular or nearly so.

The eigensolver then adds a multiple of the mass, the shift, to the stiffness, and subtracts it from the
squared frequencies.  This module handles the cases in which that loses digits.

In shapes of arrays, S counts speeds, n coordinates, k modes, and r rigid rotations.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg

from beamdyn.common.numerics import solve_lower
from beamdyn.equations.equations_of_motion import BACKWARD, ROUNDING_SIZE, SteadyPencil

_EPS = np.finfo(float).eps
_LOW = 0.1  # ratio of squared frequency to shift below which subtracting the shift would lose digits
_GRADED = 1e-6  # smallest eigenvalue of a well-conditioned stiffness that is scaled to unit diagonal
# Smallest eigenvalue of a stiffness at rest, scaled to unit diagonal, that has correct digits.
_GRADED_AT_REST = 1e-12
# Ratio of a rotation's damping rate to the clamped beam's frequency below which the rotation is undamped.
_UNDAMPED = 1e-6
# Ratio of the smallest squared speed that is tried to the squared speed at which rotation affects the
# stiffness.
_SMALLEST_TRIAL = 1e-12
# Ratio of the real or imaginary part of an eigenvalue to its magnitude, below which the part counts as 0:
# rounding splits a double root by the square root of the rounding error.
SPLIT_ROOT = 1e-8
# Ratio of a squared frequency to the squared speed below which the beam turns freely, within rounding.
_NEUTRAL = 1e-12
# Ratio of a squared frequency to its rounding error below which the frequency is 0.  Free rotations reach
# 1.3: at a limit of 1 the processor would determine whether they are neutral.
_ZERO_MARGIN = 8.0


def remove_shift(
    pencil: SteadyPencil, speeds: np.ndarray, squared: np.ndarray, v: np.ndarray, rounding: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Subtract the shift from squared frequencies; for low frequencies, use the Rayleigh quotient.

    The error of the quotient is the square of the vector's error, and no digits cancel.

    Parameters
    ----------
    pencil : SteadyPencil
        Conservative equations.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].
    squared : ndarray, shape (S, modes)
        Squared frequencies plus the shift [rad2/s2].
    v : ndarray, shape (S, coordinates, modes)
        Mass-normalised modes.
    rounding : ndarray, shape (S, modes)
        Relative rounding error of `squared`.

    Returns
    -------
    squared : ndarray, shape (S, modes)
        Squared frequencies [rad2/s2]; 0 if they are not clearly larger than their rounding error.
    rounding : ndarray, shape (S, modes)
        Relative rounding error of the frequencies.
    """
    spin = speeds[:, None, None] ** 2
    K = pencil.K0 + spin * pencil.K2
    # For a rotation about the root, K2 is a small difference of tension and spin softening, each as large as
    # M.
    size = np.abs(pencil.K0) + spin * (np.abs(pencil.K2) + np.abs(pencil.M))
    quotient = np.einsum("snk,snk->sk", v, K @ v)
    count = max(1.0, len(K[0]) / ROUNDING_SIZE)
    lost = count * BACKWARD * np.einsum("snk,snk->sk", np.abs(v), size @ np.abs(v))
    # The quotient has the square of the vector's error, which is magnified by the condition number of the
    # shifted stiffness at rest (scaled to unit diagonal): large with many elements.
    shifted = pencil.K0 + pencil.shift * pencil.M
    scale = 1 / np.sqrt(np.diag(shifted))
    values = np.linalg.eigvalsh(scale[:, None] * shifted * scale)
    condition = float(values[-1] / max(values[0], _EPS))
    lost += pencil.shift * (count * BACKWARD + _EPS * condition) ** 2
    difference = squared - pencil.shift
    low = np.abs(difference) < _LOW * pencil.shift
    removed = np.where(low, np.where(np.abs(quotient) > _ZERO_MARGIN * lost, quotient, 0.0), difference)
    nonzero = np.where(removed == 0, 1.0, np.abs(removed))
    return removed, np.where(low, lost / nonzero, rounding * np.abs(squared) / nonzero)


def part_free_turns(pencil: SteadyPencil, squared: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Separate modes of frequency 0 by the stiffness that rotation gives them, the softest first.

    At rest, every combination of two such rigid rotations is a mode, so that rounding would determine the
    result.

    Parameters
    ----------
    pencil : SteadyPencil
        Conservative equations.
    squared : ndarray, shape (speeds, modes)
        Squared frequencies.
    v : ndarray, shape (speeds, coordinates, modes)
        Mass-normalised modes; those of the result are too.
    """
    parted = v.copy()
    for s in np.flatnonzero((squared == 0).sum(axis=1) > 1):
        turns = v[s][:, squared[s] == 0]
        parted[s][:, squared[s] == 0] = turns @ np.linalg.eigh(turns.T @ pencil.K2 @ turns)[1]
    return parted


def find_free_turns(
    pencil: SteadyPencil, eigenvalue: np.ndarray, v: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Select the modes (columns) on which no stiffness acts, with the rates at which damping slows them.

    Parameters
    ----------
    pencil : SteadyPencil
        Equations with damping or gyroscopic terms; the latter do no work on a mode.
    eigenvalue : ndarray, shape (k,)
        Eigenvalues of the lowest modes without damping and gyroscopic terms [1/s].
    v : ndarray, shape (coordinates, k)
        Mass-normalised vectors of the lowest modes.

    Returns
    -------
    turns : ndarray, shape (coordinates, r)
        The selected modes.
    rates : ndarray, shape (r,)
        Rate at which each slows down [1/s]; 0 if that is within rounding.
    """
    turns = v[:, eigenvalue == 0]
    rates = np.abs(np.einsum("nk,nk->k", turns, pencil.C @ turns))
    return turns, np.where(rates < _UNDAMPED * np.sqrt(pencil.shift), 0.0, rates)


def other_eigenvalues(inverse: np.ndarray, rates: np.ndarray) -> np.ndarray:
    """List the indices of the eigenvalues 1/`inverse` that do not belong to free rotations of given rates.

    Each rotation has the eigenvalue 0, double if it is undamped, where rounding splits it by the square root
    of the rounding error; else it has one more, which is real and near minus its rate.
    """
    order = np.argsort(np.abs(inverse), kind="stable")
    others = order[: len(order) - len(rates) - int((rates == 0).sum())]
    for rate in rates[rates > 0]:
        s = 1 / inverse[others]
        apart = np.where(np.abs(s.imag) < SPLIT_ROOT * np.abs(s), np.abs(s + rate), np.inf)
        if np.isfinite(apart).any():
            others = np.delete(others, apart.argmin())
    return np.sort(others)


def insert_free_turns(
    turns: np.ndarray, s: np.ndarray, v: np.ndarray, rounding: np.ndarray, count: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Insert rigid rotations (columns) with eigenvalue 0 into the lowest modes, after those that diverge."""
    growing = int(((np.imag(s) == 0) & (np.real(s) > 0)).sum())
    zeros, unknown = np.zeros(turns.shape[1]), np.full(turns.shape[1], np.inf)
    return (
        np.insert(s, [growing], zeros)[:count],
        np.hstack([v[:, :growing], turns, v[:, growing:]])[:, :count],
        np.insert(rounding, [growing], unknown)[:count],
    )


def softening_of_graded(pencil: SteadyPencil) -> tuple[float, float] | None:
    """Compute softening as `softening_on_springs` does, for a stiffness with entries of very different sizes.

    The entries of springs may be far smaller than others and still be accurate, as in a Ritz basis, whose
    other functions do not rotate the root.

    Returns
    -------
    tuple of float, or None
        Softening and rounding; None if the stiffness at rest, scaled to unit diagonal, is singular to
        rounding.
    """
    diagonal = np.diag(pencil.K0)
    if diagonal.min() <= 0:
        return None
    scale = 1 / np.sqrt(diagonal)
    K0, K2, size = (
        scale[:, None] * A * scale for A in (pencil.K0, pencil.K2, np.abs(pencil.K2) + np.abs(pencil.M))
    )
    values = np.linalg.eigvalsh(K0)
    if values[0] < _GRADED_AT_REST * values[-1]:
        return None
    losses, vectors = scipy.linalg.eigh(-K2, K0)
    loss, v = float(losses[-1]), np.abs(vectors[:, -1])
    lost = 2 * BACKWARD * float(v @ size @ v + np.abs(losses).max())
    lost += _EPS * float(values[-1] / values[0]) * loss
    return (loss, lost / loss) if loss > lost else (0.0, np.inf)


def softening_on_springs(mass: np.ndarray, growth: np.ndarray, shift: float) -> tuple[float, float]:
    """Compute 1/speed^2 at which the stiffness I - shift mass + speed^2 diag(growth) is singular.

    The stiffness's lowest eigenvalue is a concave function of the squared speed: once positive, it vanishes
    at most once.  If rotation softens a free rigid rotation about the root at every speed, the result is
    infinite.

    Parameters
    ----------
    mass : ndarray, shape (n, n)
        Mass matrix.
    growth : ndarray, shape (n,)
        Diagonal of the stiffness, divided by the squared speed.
    shift : float
        Multiple of the mass matrix.

    Returns
    -------
    softening : float
        Inverse of the squared critical speed [s2]; 0 if there is none.
    rounding : float
        Relative rounding error of the softening; inf if it is 0.
    """
    at_rest, spin = np.eye(len(growth)) - shift * mass, np.diag(growth)
    squared = 1 / np.abs(growth).max()
    while squared > _SMALLEST_TRIAL / np.abs(growth).max():
        stiffness = at_rest + squared * spin
        values = np.linalg.eigvalsh(stiffness)
        lowest = float(values[0])
        if lowest > len(growth) * _EPS * values[-1]:  # positive definite beyond rounding
            loss = float(scipy.linalg.eigh(-spin, stiffness, eigvals_only=True)[-1])
            lost = 2 * BACKWARD * float(np.abs(growth).max()) / lowest
            if loss <= lost:
                return 0.0, np.inf
            return loss / (1 + squared * loss), lost / loss + 2 * BACKWARD / lowest
        squared /= 4
    turn = np.linalg.eigh(at_rest)[1][:, 0]
    softened = turn @ spin @ turn < -len(growth) * _EPS * np.abs(growth).max()
    return (np.inf, 0.0) if softened else (0.0, np.inf)


def factor_graded(pencil: SteadyPencil, speed: float) -> tuple[np.ndarray, float] | None:
    """Compute coordinates in which the stiffness at a speed, without the shift, is the identity.

    Returns
    -------
    tuple, or None
        The coordinates in columns (n, n), and the condition number of the stiffness scaled to unit diagonal;
        None if the stiffness is not positive definite beyond rounding.
    """
    K = pencil.K0 + speed**2 * pencil.K2
    diagonal = np.diag(K)
    if diagonal.min() <= 0:
        return None
    scale = 1 / np.sqrt(diagonal)
    unit = scale[:, None] * K * scale
    values = np.linalg.eigvalsh(unit)
    if values[0] < _GRADED:
        return None
    L = np.linalg.cholesky(unit)
    return scale[:, None] * solve_lower(L, np.eye(len(K))).T, float(values[-1] / values[0])


def solve_definite(pencil: SteadyPencil, speed: float) -> np.ndarray:
    """Solve static equilibrium at a speed; nan if the stiffness is not positive definite beyond rounding."""
    if not speed:
        return np.zeros(len(pencil.K0))
    K = pencil.K0 + speed**2 * pencil.K2
    try:
        np.linalg.cholesky(K - _NEUTRAL * speed**2 * pencil.M)
        return scipy.linalg.cho_solve(scipy.linalg.cho_factor(K), speed**2 * pencil.f2)
    except np.linalg.LinAlgError:
        return np.full(len(K), np.nan)
