"""Steps in time from a tolerance: how long they must be, the error that they leave, and the path."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Protocol

import numpy as np

from beamdyn.scene.motion import Motion
from beamdyn.transient.gauss import Piece, interior, propagate, step_maps, tableau
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.weakly_modulated import propagate_modulated

STAGES = 8
TOLERANCES = (1e-12, 0.1)  # smaller ones are lost in rounding
SAMPLES = 8  # of the response in each step, where the caller gives no times
_RADIANS = 3.84  # turned by the fastest motion in a step, for an error of 1e-5: measured
_LOOSEST = 0.01  # error of a mode, over its size, at which it is still followed
_PARTS = 4  # of a stretch of changing speed, each with its own step
_BETWEEN = np.array([0.1, 0.4, 0.6, 0.9])  # fractions of a step at which the interpolation errs most
_LOST = 0.05  # error of phase in a step [rad] from which a mode is not followed
_MOST_STEPS = 3_000_000
_CHECKS = 48  # steps at which the local error is measured
_GOLDEN = 0.6180339887498949  # spreads them so that no rhythm of the motion is missed
_COMPARED = 257  # times at which equations are held against those at the start
_ROUNDING = 1e-13  # of forces in balance, over the largest
_AT_ROUNDING = 1e-9  # error over the largest deflection from which finer steps may gain nothing
_NOISE = 1e-14  # of a step, over the sum of its terms
_CANDIDATES = 12  # maxima that are refined: sampled ones differ by less than 1e-3 from the true


# Paths --------------------------------------------------------------------------------------------


class Path(Protocol):
    """Coordinates over time, wherever they come from."""

    @property
    def start(self) -> float:
        """Its beginning [s]."""
        ...

    @property
    def end(self) -> float:
        """Its end [s]."""
        ...

    @property
    def samples(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Times (k,), coordinates and velocities (k, n) that show the motion: several in each step."""
        ...

    def at(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates and velocities at times t [s]: shapes (len(t), n)."""
        ...


@dataclass(frozen=True)
class Trajectory:
    """A trajectory: pieces of equal steps, one after the other."""

    pieces: tuple[Piece, ...]

    @property
    def start(self) -> float:
        """Its beginning [s]."""
        return self.pieces[0].start

    @property
    def end(self) -> float:
        """Its end [s]."""
        return self.pieces[-1].end

    @property
    def samples(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Times, coordinates and velocities that show the motion: several in each step."""
        return self._samples

    @cached_property
    def _samples(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        n = self.pieces[0].acceleration.shape[2]
        last = self.pieces[-1].state[-1:]
        end = np.array([self.end]), last[:, 1 : n + 1], last[:, n + 1 :]
        parts = [*(p.samples(SAMPLES) for p in self.pieces), end]
        t, q, v = (np.concatenate(each) for each in zip(*parts, strict=True))
        return t, q, v

    def at(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates and velocities at times t."""
        n = self.pieces[0].acceleration.shape[2]
        q, v = np.empty((len(t), n)), np.empty((len(t), n))
        place = np.searchsorted([p.start for p in self.pieces[1:]], t, side="right")
        for k in np.unique(place):
            here = place == k
            q[here], v[here] = self.pieces[k].at(t[here])
        return q, v


def largest_deflection(tip: np.ndarray, path: Path, start: float, end: float) -> float:
    """Largest tip deflection of a path, either way, from start to end [m].

    Sample, then close in on the highest maxima.
    """
    times, q, _ = path.samples
    inside = (times >= start) & (times <= end)
    size = np.abs(tip_deflection(tip, q[inside]))
    ends = np.array([start, end])
    t = np.concatenate([times[inside][_highest(size)], ends])
    reach = np.diff(times).max()
    for _ in range(4):  # each round samples 17 times as finely
        near = np.clip(t[:, None] + np.linspace(-reach, reach, 35), start, end)
        size = np.abs(tip_deflection(tip, path.at(near.ravel())[0])).reshape(near.shape)
        t, reach = near[np.arange(len(t)), size.argmax(axis=1)], reach / 17
    return float(size.max())


def _highest(size: np.ndarray) -> np.ndarray:
    """Samples beside the highest maxima, by the vertices of parabolas through three samples."""
    if len(size) < 3:
        return np.arange(len(size))
    size = size / max(size.max(), 1e-300)  # of any size, without overflow
    left, middle, right = size[:-2], size[1:-1], size[2:]
    bend = np.maximum(2 * middle - left - right, 1e-300)
    summit = (middle >= left) & (middle >= right)
    height = np.where(summit, middle + (right - left) ** 2 / (8 * bend), middle)
    return 1 + np.argsort(height)[-_CANDIDATES:]


def tip_deflection(tip: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Tip deflection of coordinates q of shape (n, m), of which bending comes first."""
    return q[:, : len(tip)] @ tip


# Resolution and error -----------------------------------------------------------------------------


def integrate(
    tip: np.ndarray, system: ModalSystem, y0: np.ndarray, t_end: float, tolerance: float
) -> tuple[Trajectory, float, str]:
    """Integrate with steps from the tolerance; again, finer, if the measured error asks for it.

    Parameters
    ----------
    tip : ndarray, shape (m,)
        Tip deflection of the bending modes.
    system : ModalSystem
        The equations.
    y0 : ndarray, shape (2 n,)
        Coordinates and velocities at time 0.
    t_end : float
        End [s].
    tolerance : float
        Error aimed at, relative to the largest deflection.

    Returns
    -------
    path : Trajectory
    error : float
        Estimated error of the tip deflection [m].
    name : str
        What was done, for the provenance.
    """
    edges, resolution = smooth_stretches(system.motion, t_end), Resolution.of(tolerance)
    if stays(system, y0, t_end):
        path = _propagate(system, edges, [1] * (len(edges) - 1), y0, tolerance)
        return path, 0.0, "no steps: it stays as it begins"
    last = np.inf
    while True:
        steps = [resolution.steps(system, a, b) for a, b in pairwise(edges)]
        check_steps(sum(steps), t_end)
        path = _propagate(system, edges, steps, y0, tolerance)
        error = time_error(tip, system, [_checks(p) for p in path.pieces])
        largest = max(float(np.abs(tip_deflection(tip, p.state[:, 1:])).max()) for p in path.pieces)
        at_rounding = last / 2 < error.total < _AT_ROUNDING * largest
        if error.total <= tolerance * largest or at_rounding or resolution.exhausted:
            return path, error.total, f"Gauss collocation of order {2 * STAGES}, {sum(steps)} steps"
        resolution, last = resolution.finer(error, tolerance * largest), error.total


def stays(system: ModalSystem, y0: np.ndarray, t_end: float) -> bool:
    """Whether nothing moves: equations that do not change, begun in equilibrium."""
    if system.motion.settled > 0:
        return False
    _, K, f = system.coefficients(np.linspace(0, t_end, _COMPARED))
    q, v = np.split(y0, 2)
    size = np.abs(K[0]) @ np.abs(q) + np.abs(f[0])
    balanced = not v.any() and (np.abs(f[0] - K[0] @ q) <= _ROUNDING * size.max()).all()
    return balanced and bool((K[0] == K).all() and (f == f[0]).all())


@dataclass(frozen=True)
class Resolution:
    """How long the steps are: the fastest motion that must be resolved turns by so much in each.

    Parameters
    ----------
    radians : float
        Angle turned in a step [rad].
    modes : int
        Number of the lowest modes that are resolved; the free vibration of higher ones, which the
        motion hardly excites, may lose its phase.
    """

    radians: float
    modes: int = 1

    @classmethod
    def of(cls, tolerance: float) -> Resolution:
        """The one that leaves about this error, relative to the largest deflection: measured."""
        return cls(_RADIANS * (tolerance / 1e-5) ** (1 / (2 * STAGES)))

    def steps(self, system: ModalSystem, start: float, end: float) -> int:
        """Steps of a stretch of the motion."""
        t = np.linspace(start, end, 9)
        speed = np.abs(system.motion.at(t).speed).max()
        lines = [line.multiple * speed for line in system.motion.lines]
        _, K, _ = system.coefficients(t)
        own = np.sqrt(np.sort(np.abs(np.linalg.eigvals(K)), axis=1)[:, self.modes - 1].max())
        fastest = max(own, speed * (system.equations.gravity != 0), *lines, 0.0)
        return max(1, int(np.ceil((end - start) * fastest / self.radians)))

    def finer(self, error: TimeError, bound: float) -> Resolution:
        """The one to try next if the error exceeds its bound [m]."""
        from_here_up = np.cumsum((error.modes * error.lost)[::-1])[::-1]
        needed = int((from_here_up > bound / 4).sum())  # the modes above add up to little
        if needed > self.modes:  # the highest need not be followed more closely than its size asks for
            share = min(bound / 4 / from_here_up[needed - 1], _LOOSEST)
            return Resolution(max(self.radians, Resolution.of(share).radians), needed)
        shrink = max(0.3, 0.9 * (bound / error.total) ** (1 / (2 * STAGES)))
        return Resolution(self.radians * shrink, self.modes)

    @property
    def exhausted(self) -> bool:
        """Whether shorter steps gain nothing but rounding."""
        return self.radians < _RADIANS / 50


def check_steps(steps: int, t_end: float) -> None:
    """Refuse a run that would not fit into memory."""
    if steps > _MOST_STEPS:
        raise ValueError(
            f"t_end = {t_end:g} s takes {steps} steps in time; at most {_MOST_STEPS} are kept: "
            "give an earlier end or a larger tolerance, or ask for the steady response"
        )


def smooth_stretches(motion: Motion, t_end: float) -> np.ndarray:
    """Ends of stretches: breakpoints of the motion, and parts of those in which the speed changes."""
    inner = [b for b in motion.breakpoints if 0 < b < t_end]
    parts = []
    for a, b in pairwise([0.0, *inner, t_end]):
        changing = np.ptp(motion.at(np.linspace(a, b, 9)[1:-1]).speed) > 0
        parts.append(np.linspace(a, b, (_PARTS if changing else 1) + 1)[:-1])
    return np.concatenate([*parts, [t_end]])


def _propagate(
    system: ModalSystem, edges: np.ndarray, steps: Sequence[int], y0: np.ndarray, tolerance: float
) -> Trajectory:
    pieces, n = [], system.size
    for (a, b), many in zip(pairwise(edges), steps, strict=True):
        pieces.append(_piece(system, a, b, many, y0[:n], y0[n:], 0.1 * tolerance))
        y0 = pieces[-1].state[-1, 1:]
    return Trajectory(tuple(pieces))


def _piece(
    system: ModalSystem, a: float, b: float, steps: int, q: np.ndarray, v: np.ndarray, accuracy: float
) -> Piece:
    """One stretch: by the series for a weakly modulated system where it is one, else step by step."""
    modulation = system.modulation(a, b)
    if modulation is not None:
        piece = propagate_modulated(modulation, a, b, steps, q, v, STAGES, accuracy)
        if piece is not None:
            return piece
    return propagate(system, a, b, steps, q, v, STAGES)


@dataclass(frozen=True)
class Checks:
    """Steps of a piece at which the local error is measured.

    Parameters
    ----------
    starts : ndarray, shape (k,)
        Their beginnings [s].
    h : float
        Their length [s].
    steps : int
        How many steps of the piece they stand for.
    state : ndarray, shape (k, 2 n + 1)
        Augmented states at their beginnings.
    reached : ndarray, shape (k, 2 n)
        Coordinates and velocities at their ends, as computed.
    """

    starts: np.ndarray
    h: float
    steps: int
    state: np.ndarray
    reached: np.ndarray


def checked_steps(steps: int) -> np.ndarray:
    """Which steps of a piece are checked."""
    if steps <= _CHECKS:
        return np.arange(steps)
    return np.unique((steps * (_GOLDEN * np.arange(_CHECKS) % 1)).astype(int))


def _checks(piece: Piece) -> Checks:
    steps = len(piece.acceleration)
    chosen = checked_steps(steps)
    return Checks(
        piece.start + piece.h * chosen, piece.h, steps, piece.state[chosen], piece.state[chosen + 1, 1:]
    )


@dataclass(frozen=True)
class TimeError:
    """Estimated error of a tip deflection by the steps in time.

    Parameters
    ----------
    modes : ndarray, shape (m,)
        Contributions of the modes [m].
    between : float
        Error of interpolation between the ends of steps [m].
    lost : ndarray of bool, shape (m,)
        Whether the steps are too long to follow a mode's free vibration.
    """

    modes: np.ndarray
    between: float
    lost: np.ndarray

    @property
    def total(self) -> float:
        """All of it, with a margin [m]."""
        return 1.5 * (float(self.modes.sum()) + self.between)


def time_error(tip: np.ndarray, system: ModalSystem, checks: Sequence[Checks]) -> TimeError:
    """Error of the tip deflection: some steps of each piece are held against steps with two more stages.

    Gauss collocation keeps amplitudes and errs in phase.  A mode's local errors therefore add up
    coherently until its phase is lost, after 2 / delta steps with an error delta of phase a step;
    what a mode that the steps do not resolve has by then is all of its free vibration, and no more.

    Parameters
    ----------
    tip : ndarray, shape (m,)
        Tip deflection of the bending modes.
    system : ModalSystem
        The equations.
    checks : sequence of Checks
        Checked steps of each piece.

    Returns
    -------
    TimeError
    """
    total, between, lost = np.zeros(len(tip)), 0.0, np.zeros(len(tip), dtype=bool)
    for check in checks:
        own, finer = (step_maps(system, check.starts, check.h, tableau(STAGES + more)) for more in (0, 2))
        local = _local_errors(system, own.step, finer.step, check, len(tip))
        delta = _lost_phase(system, finer.step - own.step, len(tip))
        total += np.minimum(check.steps, 2 / np.maximum(delta, 1e-30)) * local
        lost |= delta > _LOST
        accelerations = [(maps.stages @ check.state[:, None, :, None])[..., 0] for maps in (own, finer)]
        inside = [interior(check.h, check.state, a, _BETWEEN)[0] for a in accelerations]
        between = max(between, float(np.abs((inside[0] - inside[1])[..., : len(tip)] @ tip).max()))
    return TimeError(total * np.abs(tip), between, lost)


def _local_errors(
    system: ModalSystem, own: np.ndarray, exact: np.ndarray, check: Checks, modes: int
) -> np.ndarray:
    """Mean local error of each mode as an amplitude: the method's, and that of steps only nearly its own."""
    n = system.size
    left = np.einsum("kij,kj->ki", own, check.state) - check.reached
    size = np.einsum("kij,kj->ki", np.abs(own), np.abs(check.state))
    left[np.abs(left) <= _NOISE * size] = 0  # rounding, which does not add up
    error = np.abs(np.einsum("kij,kj->ki", exact - own, check.state)) + np.abs(left)
    return np.hypot(error[:, :modes], error[:, n : n + modes] / _frequency(system, modes)).mean(axis=0)


def _lost_phase(system: ModalSystem, difference: np.ndarray, modes: int) -> np.ndarray:
    """Largest error of phase in a step of each mode [rad], from the difference of the maps of steps."""
    n, k = system.size, np.arange(modes)
    by_velocity = np.abs(difference[:, k, 1 + n + k]) * _frequency(system, modes)
    return np.maximum(np.abs(difference[:, k, 1 + k]), by_velocity).max(axis=0)


def _frequency(system: ModalSystem, modes: int) -> np.ndarray:
    _, K, _ = system.coefficients(np.zeros(()))
    return np.sqrt(np.abs(np.diag(K)))[:modes]
