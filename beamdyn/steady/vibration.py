"""Equations of vibration at steady speeds, their solution by spectral lines, and stability.

A straight beam has the same equations at all speeds.  With large deflection, the beam vibrates about the
equilibrium to which rotation bends it: its equations at each speed are linear about the equilibrium there, in
the modes of small vibration about it.  The lines of the tip's deflection have as many harmonics as each speed
needs.

In shapes of arrays, S counts speeds, n coordinates, d directions, and H harmonics.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from beamdyn.common.numerics import longer_semi_axis
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice, choose_model
from beamdyn.modes.modal.eigenproblem import Solver
from beamdyn.modes.modal.equilibrium import NoEquilibrium
from beamdyn.modes.modal.model import ModalBasis, Model, reduce_to_modes
from beamdyn.scene.motion.base import Motion
from beamdyn.scene.scene import Scene
from beamdyn.steady.harmonic_balance import solve_harmonic_balance
from beamdyn.steady.periodic_system import (
    Pair,
    PeriodicSystem,
    generate_harmonics,
    periodic_system,
    split_uncoupled,
)
from beamdyn.steady.stability import TONGUE_ORDER, fastest_growth

UNSTABLE = "parametric instability"
_TURNING, _PAST = "turns freely about the root", "past the critical speed"
_MISSING, _UNSTABLE_MEAN = "no equilibrium", "unstable equilibrium"
WITHOUT_STABLE_MEAN = _PAST, _TURNING, _MISSING, _UNSTABLE_MEAN
# Largest number of interactions in the response, if the user gives none.  In an interaction, harmonics of the
# response are multiplied by the periodic coefficients, which gives further harmonics.
_MOST_INTERACTIONS = 5
_MOST_UNKNOWNS = 2**17  # number of unknowns solved at once: they fit the processor's cache
# Order of the axes at the tip: direction of bending, direction across, direction along the beam.
_ACROSS_THEN_ALONG = [1, 2, 0]
_ROUNDING = 1e-15  # relative error that is stated if no harmonic is neglected
_NO_FREQUENCY = 1e-8  # frequency, relative to a clamped beam's, below which it counts as 0


@dataclass(frozen=True)
class Vibration:
    """Equations of vibration of a beam at S speeds.

    Parameters
    ----------
    parts : list of (PeriodicSystem, ndarray)
        Equations that no term couples, each with the indices of its coordinates.
    tips : ndarray, shape (S, d, coordinates)
        Deflection of the tip per coordinate, in each of d directions.
    static : ndarray, shape (S, d)
        Deflection of the tip in the equilibrium about which the beam vibrates [m].
    without_rate : ndarray of bool, shape (S,)
        Whether the growth rate is undefined at each speed.
    lost : dict of str to ndarray of bool, shape (S,)
        For each status (the key), whether it is the reason why the beam has no stable mean position to
        vibrate about; if several apply, the first counts.
    """

    parts: list[tuple[PeriodicSystem, np.ndarray]]
    tips: np.ndarray
    static: np.ndarray
    without_rate: np.ndarray
    lost: dict[str, np.ndarray]

    def stability(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Compute growth rate of free motion [1/s], its error, status, and whether the status is uncertain.

        Each is an array (S,).  The status is uncertain where the growth rate is smaller than its error.
        """
        rate, error = np.full((2, len(self.static)), np.nan)
        if (known := ~self.without_rate).any():
            rate[known], error[known] = fastest_growth([part[known] for part, _ in self.parts])
        status = np.where(rate > 0, UNSTABLE, "stable")
        status = np.select([*self.lost.values()], [*self.lost], status)
        return rate, error, status, (np.abs(rate) < error) & ~np.isin(status, [*self.lost])

    def contains_resonances(self, chosen: np.ndarray, modes: int) -> bool:
        """Return whether at chosen speeds no mode above the `modes` lowest of each part can be unstable.

        Where two modes resonate, their frequencies add up to that of a product of periodic coefficients.
        Coordinates beyond these modes span modes at other speeds, and have higher frequencies than any mode.
        """
        for part in (part[chosen] for part, _ in self.parts):
            if not part.coupling:
                continue
            largest = np.abs(part.rates @ np.array([*part.coupling]).T).max(axis=1)
            K, _, M = part.mean
            squared = np.sort(np.real(np.linalg.eigvals(np.linalg.solve(M, K))))[:, :modes]
            if (squared[:, -1] < (TONGUE_ORDER * largest) ** 2).any():
                return False
        return True


def vibration_of(model: Model, basis: ModalBasis, motion: Motion | None, speeds: np.ndarray) -> Vibration:
    """Build the equations of vibration of a model in a modal basis.

    Parameters
    ----------
    model : Model
        The discretized scene, of a straight beam or with large deflection.
    basis : ModalBasis
        The modal basis; about equilibria, only its number of modes is used, at each speed.
    motion : Motion or None
        The motion; None for rotation about a fixed centre.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].

    Returns
    -------
    Vibration
    """
    if model.scene.physics.large_deflection:
        return _about_equilibria(model, basis, motion, speeds)
    equations = model.modal_equations(basis)
    tips = np.broadcast_to(equations.tips, (len(speeds), *equations.tips.shape))
    free = np.zeros(len(speeds), dtype=bool)
    if shift := model.equations.shift:  # not 0 if the root is not clamped: the beam may turn freely
        lowest = np.abs(Solver(model.equations.steady().undamped()).eigenvalues(speeds, 1)[:, 0])
        free = lowest < _NO_FREQUENCY * np.sqrt(shift)
    return Vibration(
        parts=split_uncoupled(periodic_system(equations, motion, speeds), equations),
        tips=tips,
        static=np.zeros(tips.shape[:2]),
        without_rate=free,
        lost={_TURNING: free, _PAST: np.asarray(np.abs(speeds) >= model.solver.critical_speed)},
    )


# Vibration about equilibria -----------------------------------------------------------------------


def _about_equilibria(
    model: Model, basis: ModalBasis, motion: Motion | None, speeds: np.ndarray
) -> Vibration:
    """Build the equations of vibration about the equilibrium at each speed.

    At speeds without an equilibrium, the equations about the straight beam take their place; the results at
    these speeds are discarded.

    The directions of the tip are: of bending, across, and along the axis of the beam at the root.
    """
    q, bent = find_equilibria(model, speeds), model.bent
    missing = np.asarray(np.isnan(q).any(axis=1))
    q = np.where(missing[:, None], 0.0, q)
    equations, tips = [], []
    for speed, at in zip(np.abs(speeds).tolist(), q, strict=True):
        state = bent.at(at)
        equations.append(reduce_to_modes(state.linearized(), replace(basis, speeds=(speed,))))
        tips.append((bent.basis_of(equations[-1]).T @ state.bent.tip_motions[:, _ACROSS_THEN_ALONG]).T)
    parts = split_uncoupled(periodic_system(equations, motion, speeds), equations[0])
    rate = np.zeros(len(missing))  # growth rate without the periodic coefficients
    if (known := ~missing).any():
        rate[known] = fastest_growth([replace(part[known], varying=()) for part, _ in parts])[0]
    return Vibration(
        parts=parts,
        tips=np.array(tips),
        static=np.where(missing[:, None], np.nan, bent.beam.at(q).tip - bent.beam.at(0 * q).tip)[
            :, _ACROSS_THEN_ALONG
        ],
        without_rate=missing,
        lost={_MISSING: missing, _UNSTABLE_MEAN: np.asarray(rate > 0)},
    )


def find_equilibria(model: Model, speeds: np.ndarray) -> np.ndarray:
    """Find the coordinates in equilibrium at each speed, in rows; nan where the scene's branch has none.

    The branch that begins at rest is followed to higher speeds; the other branch is followed to lower speeds,
    from the fastest speed at which it exists.  The search ends where the branch ends.
    """
    solver = model.deflected
    try:
        return solver.equilibria(speeds)
    except NoEquilibrium:
        pass
    q, reached = np.full((len(speeds), solver.size), np.nan), False
    order = np.argsort(np.abs(speeds), kind="stable")
    for k in order if solver.branch == "straight" else order[::-1]:
        try:
            q[k] = solver.equilibria(speeds[[k]])[0]
            reached = True
        except NoEquilibrium:
            if reached:
                break
    return q


def choose_vibrating(
    scene: Scene, discretization: DiscretizationChoice, speeds: np.ndarray, modes: int
) -> Model:
    """Choose a model for those speeds at which the beam has an equilibrium: see `choose_model`.

    The choice is by undamped modes, of which the modal basis consists: damped ones of large models take
    minutes.
    """
    undamped = scene.undamped
    try:
        return choose_model(undamped, discretization, speeds, modes).of(scene)
    except NoEquilibrium:
        pass
    from_rest = replace(undamped, physics=replace(scene.physics, branch="straight"))
    rough = choose_model(from_rest, discretization, np.zeros(1), modes).of(scene)
    found = speeds[np.isfinite(find_equilibria(rough, speeds)).all(axis=1)]
    return choose_model(undamped, discretization, found, modes).of(scene) if found.size else rough


# Lines of the tip deflection ------------------------------------------------------------------------


def solve_parts(
    parts: list[tuple[PeriodicSystem, np.ndarray]],
    tips: np.ndarray,
    interactions: int | None,
    tolerance: float,
) -> tuple[list[Pair], np.ndarray, np.ndarray]:
    """Solve uncoupled parts of the equations, and add their tip deflections.

    Parameters
    ----------
    parts : list of (PeriodicSystem, ndarray)
        Equations at S speeds, each with the indices of its coordinates.
    tips : ndarray, shape (S, d, coordinates)
        Tip deflection per coordinate in d directions.
    interactions : int, optional
        Number of interactions with the periodic coefficients; as many as the tolerance needs if not given.
    tolerance : float
        Target of the truncation error of the harmonics, relative to the sum of all lines.

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
    """Compute the harmonics of d tip deflections at S speeds, with as many as each speed needs.

    Return H harmonics, their amplitudes (S, d, H), and relative errors (S,).
    """
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
        count = 1 + len(unconverged) * system.size * sizes[used] // _MOST_UNKNOWNS
        for part in np.array_split(unconverged, count):
            if not len(part):
                continue
            finer = np.zeros((len(part), d, sizes[used]), dtype=complex)
            if used:
                q = solve_harmonic_balance(system[part], harmonics[kept])
                finer = np.einsum("shn,sdn->sdh", q, tips[part])
            if used >= first:  # fewer interactions than `first` serve only to estimate the error
                total = sizes_of(finer).sum(axis=1)
                distance = sizes_of(finer - c[part, :, kept]).sum(axis=1) / np.where(total == 0, 1, total)
                error[part] = _ROUNDING if exact else distance
            c[part, :, kept] = finer
        if (error <= tolerance).all():
            break
    return harmonics[kept], c[..., kept], error


def sizes_of(c: np.ndarray) -> np.ndarray:
    """Compute the largest magnitude over phi of each vector Re(c exp(i phi)).

    Axis 1 of c has the components of the vectors; the result lacks this axis.
    """
    return longer_semi_axis(np.moveaxis(c, 1, 0))


def combine_pairs(c: np.ndarray, harmonics: list[Pair], motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """Combine the amplitudes of each pair of harmonics h, -h into one line of positive frequency.

    Parameters
    ----------
    c : ndarray of complex, shape (..., H)
        Amplitudes of the harmonics.
    harmonics : list of pair, length H
        The harmonics (j, k), which include the opposite (-j, -k) of each.
    motion : Motion
        The motion; its `road_multiple` gives the sign of each harmonic's frequency.

    Returns
    -------
    harmonics : ndarray of int, shape (lines, 2)
    amplitudes : ndarray of complex, shape (..., lines)
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
    line : ndarray of complex, shape (S, directions, lines)
        Amplitudes of the lines.
    harmonics : ndarray of int, shape (lines, 2)
        Harmonic of each line.
    static : ndarray, shape (S, directions)
        Deflection in equilibrium [m].
    directions : int
        Number of directions to keep: one for each modelled plane of bending.

    Returns
    -------
    total : ndarray of complex, shape (S, directions, lines)
    share : ndarray, shape (S,)
        Factor for errors relative to the sum of the lines: sum of all lines' magnitudes without the
        deflection in equilibrium, divided by the sum with it; at most 1.
    """
    total = line[:, :directions].copy()
    total[..., ~harmonics.any(axis=1)] += static[:, :directions, None]
    before, after = (sizes_of(each).sum(axis=1) for each in (line, total))
    return total, np.minimum(before / np.where(after == 0, 1.0, after), 1.0)
