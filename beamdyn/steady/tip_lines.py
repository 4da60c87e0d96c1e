"""Lines of the tip's deflection by harmonic balance, with as many harmonics as each speed needs."""

from __future__ import annotations

import numpy as np

from beamdyn.scene.motion import Motion
from beamdyn.steady.harmonic_balance import solve_harmonic_balance
from beamdyn.steady.periodic_system import Pair, PeriodicSystem, generate_harmonics

_MOST_INTERACTIONS = 5  # interactions with the periodic coefficients, for the response
_MOST_UNKNOWNS = 2**17  # unknowns that are solved for at once: they fit the processor's cache
_ROUNDING = 1e-15  # relative error where no harmonic is neglected


def solve_parts(
    parts: list[tuple[PeriodicSystem, np.ndarray]],
    tips: np.ndarray,
    interactions: int | None,
    tolerance: float,
) -> tuple[list[Pair], np.ndarray, np.ndarray]:
    """Solve parts of the equations that no term couples, and add up their tip deflections.

    Parameters
    ----------
    parts : list of (PeriodicSystem, ndarray)
        Equations at S speeds, each with its coordinates.
    tips : ndarray, shape (S, d, n)
        Tip deflection per coordinate in d directions.
    interactions : int, optional
        Number of interactions with the periodic coefficients; as many as the tolerance needs if not given.
    tolerance : float
        Truncation error of the harmonics aimed at, relative to the sum of all lines.

    Returns
    -------
    harmonics : list of pair, length H
    deflections : ndarray of complex, shape (S, d, H)
    error : ndarray, shape (S,)
        Estimated truncation error, relative to the sum of all lines.
    """
    solved = [_solve_harmonics(part, tips[..., places], interactions, tolerance) for part, places in parts]
    index = {h: i for i, h in enumerate(dict.fromkeys(h for harmonics, *_ in solved for h in harmonics))}
    c = np.zeros((*tips.shape[:2], len(index)), dtype=complex)
    for harmonics, of_part, _ in solved:
        c[..., [index[h] for h in harmonics]] += of_part
    return list(index), c, np.max([error for *_, error in solved], axis=0)


def _solve_harmonics(
    system: PeriodicSystem, tips: np.ndarray, interactions: int | None, tolerance: float
) -> tuple[list[Pair], np.ndarray, np.ndarray]:
    """Harmonics (H), tip deflections (S, d, H), errors (S); each speed with the harmonics it needs."""
    S, d = tips.shape[:2]
    if not system.load_harmonics:
        return [], np.zeros((S, d, 0), dtype=complex), np.full(S, _ROUNDING)
    most = _MOST_INTERACTIONS if interactions is None else interactions
    levels = generate_harmonics(system.load_harmonics, system.coupling, most + 1)
    complete, levels = len(levels) <= most + 1, levels[: most + 1]
    harmonics, sizes = [h for level in levels for h in level], np.cumsum([0, *map(len, levels)])
    c, error = np.zeros((S, d, sizes[-1]), dtype=complex), np.full(S, np.inf)
    first, kept = min(3 if interactions is None else most + 1, len(levels)), slice(0)
    for used in range(first - 1, len(levels) + 1):
        kept, exact = slice(sizes[used]), complete and used == len(levels)
        unconverged = np.flatnonzero(~(error <= tolerance))
        for part in _split(unconverged, system.size * sizes[used]):
            finer = _solve_tip(system[part], tips[part], harmonics[kept])
            if used >= first:  # the level before serves only to estimate the error
                error[part] = _ROUNDING if exact else _distance(finer, c[part, :, kept])
            c[part, :, kept] = finer
        if (error <= tolerance).all():
            break
    return harmonics[kept], c[..., kept], error


def _split(rows: np.ndarray, unknowns: int) -> list[np.ndarray]:
    """Split indices of speeds, with `unknowns` each, into parts that fit into the cache."""
    return [p for p in np.array_split(rows, 1 + len(rows) * unknowns // _MOST_UNKNOWNS) if len(p)]


def _solve_tip(system: PeriodicSystem, tips: np.ndarray, harmonics: list[Pair]) -> np.ndarray:
    """Tip deflections (S, d, H) in some harmonics."""
    if not harmonics:
        return np.zeros((*tips.shape[:2], 0), dtype=complex)
    return np.einsum("shn,sdn->sdh", solve_harmonic_balance(system, harmonics), tips)


def _distance(finer: np.ndarray, coarser: np.ndarray) -> np.ndarray:
    """Sum over the lines of the differences (S,) of two deflections (S, d, H), over that of the finer."""
    total = sizes_of(finer).sum(axis=1)
    return sizes_of(finer - coarser).sum(axis=1) / np.where(total == 0, 1, total)


def sizes_of(c: np.ndarray) -> np.ndarray:
    """Largest magnitudes (S, H) of vectors Re(c exp(i phi)) over phi: the longer semi-axes of ellipses."""
    along, across = along_bending(c), 1j * across_bending(c)
    return (np.abs(along + across) + np.abs(along - across)) / 2  # radii of circles in either sense


def along_bending(c: np.ndarray) -> np.ndarray:
    """Component (S, H) of vectors (S, d, H) in the direction of bending."""
    return c[:, 0]


def across_bending(c: np.ndarray) -> np.ndarray:
    """Component (S, H) of vectors (S, d, H) in the direction across; 0 where one plane is modelled."""
    return c[:, 1:].sum(axis=1)


def combine_pairs(c: np.ndarray, harmonics: list[Pair], motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """Combine each pair h, -h into the line of positive frequency.

    Parameters
    ----------
    c : ndarray of complex, shape (..., H)
        Amplitudes of the harmonics.
    harmonics : list of pair, length H
        The harmonics; with each, its opposite.
    motion : Motion
        The motion, whose `road_multiple` orders them by frequency.

    Returns
    -------
    harmonics : ndarray of int, shape (l, 2)
    amplitudes : ndarray of complex, shape (..., l)
    """
    kappa = motion.road_multiple or 0.0
    forward = [i for i, h in enumerate(harmonics) if (h[0] + h[1] * kappa, h) >= (0.0, (0, 0))]
    harmonic = np.array([harmonics[i] for i in forward], dtype=int).reshape(-1, 2)
    return harmonic, c[..., forward] * np.where(harmonic.any(axis=1), 2.0, 1.0)


def add_static(
    line: np.ndarray, harmonics: np.ndarray, static: np.ndarray, directions: int
) -> tuple[np.ndarray, np.ndarray]:
    """Add the deflection in equilibrium to the static line.

    Parameters
    ----------
    line : ndarray of complex, shape (S, d, l)
        Amplitudes of the lines.
    harmonics : ndarray of int, shape (l, 2)
        Harmonic of each line.
    static : ndarray, shape (S, d)
        Deflection in equilibrium [m].
    directions : int
        Number of directions to keep, those of the modelled planes.

    Returns
    -------
    total : ndarray of complex, shape (S, directions, l)
    share : ndarray, shape (S,)
        Sum of the sizes of all lines before over that after, at most 1: what a relative error shrinks by.
    """
    total = line[:, :directions].copy()
    total[..., ~harmonics.any(axis=1)] += static[:, :directions, None]
    before, after = (sizes_of(each).sum(axis=1) for each in (line, total))
    return total, np.minimum(before / np.where(after == 0, 1.0, after), 1.0)
