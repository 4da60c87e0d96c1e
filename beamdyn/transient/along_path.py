"""Estimate how much further modes change a transient, along the motion that was computed without them.

The motion q of a run, inserted in the equations of a larger model, leaves a known residual R(t).  The
difference e of both motions obeys e'' + C e' + K(t) e = R.  The run is divided into stretches, and e is
computed in the larger model's modes in each stretch: the slow ones as oscillators whose frequency follows the
stiffness, y = Im(exp(i theta) (a + int exp(-i theta) R / sqrt(w) dt)) / sqrt(w) with theta' = w and the
initial amplitude a (Liouville and Green); those too fast for the samples of the run follow the residual
quasi-statically, and vibrate freely after its jumps.  So no time step has to be solved again.  Where the
stiffness of a stretch differs from its mean, the modes are coupled: the motion of all others exerts a force
on each, which is taken from the previous iteration (pass).

In shapes of arrays, n counts coordinates of the larger model, m those in the run, N times, and k functions of
time that multiply stiffness matrices.

References
----------
Bender, Orszag, Advanced Mathematical Methods for Scientists and Engineers, 1978, section 10.1.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from beamdyn.equations.equations_of_motion import Equations
from beamdyn.equations.root_motion import Quantity, RootMotion
from beamdyn.transient.gauss import Segment
from beamdyn.transient.record_steps import RecordSegment, RecordSteps
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.time_error import size_per_coordinate
from beamdyn.transient.trajectory import SAMPLES, Trajectory, magnitude

# In a stretch, the difference between the run and a model with more coordinates is computed mode by mode.
# The first pass neglects the coupling of the modes; each later pass takes the coupling forces from the pass
# before.  This is the largest number of later passes.
_MOST_PASSES = 4
# Largest change of that difference from one pass to the next, relative to the difference, at which passes
# end.
_SETTLED = 0.1
# Number of stretches in a segment of changing speed, and in a motion given by samples.
_STRETCHES, _OF_RECORD = 8, 32
_RESOLVED = 1.9  # phase advance between samples [rad] up to which a mode is integrated in time
# Distance, as a fraction of a segment, between its ends and the outermost samples: loads may jump at the
# ends.
_INSIDE = 1e-9
# Relative distance of a run's mode shape from the larger model's functions up to which these represent it.
_CONTAINED = 1e-6
_MOST_DECAY = 30.0  # largest exponent of the decay in a stretch: larger ones overflow
# Assumed ratio of the largest sum of many random contributions to the root of the sum of their squares.
_BY_CHANCE = 3.0
# Largest ratio of the fast modes' amplitude to the whole difference of the tip deflections up to which the
# root of the sum of squares is accurate enough for adding their contributions.
_MOST_RINGING = 0.1
# Ratio of the largest deflections in the last quarter and in the first half of the motion at steady speed,
# above which the oscillator equations are not valid.
_MOST_GROWTH = 2.0


@dataclass(frozen=True)
class _Residual:
    """Residual of a motion inserted in the equations of a larger model, together with these equations.

    Parameters
    ----------
    larger : ModalSystem
        The larger model, of n coordinates.
    quantities : tuple of str
        Names of the functions of time that multiply the stiffness matrices.
    stiffness : ndarray, shape (k, n, n)
        Stiffness matrix that each of these functions multiplies.
    damping : ndarray, shape (n, n)
        Damping matrix of the larger model.
    factors : ndarray, shape (l + k m + m, n)
        Residual per unit of each of l loads, of each coordinate times each function, and of each velocity.
    embedding : ndarray, shape (n, m)
        Matrix from the coordinates of the run to those of the larger model.
    """

    larger: ModalSystem
    quantities: tuple[Quantity, ...]
    stiffness: np.ndarray
    damping: np.ndarray
    factors: np.ndarray
    embedding: np.ndarray

    @classmethod
    def of(cls, system: ModalSystem, larger: ModalSystem) -> _Residual | None:
        """Build the residual of a system's motion in a larger model.

        None if the larger model is gyroscopic, or does not contain the modes of the system.
        """
        few, many = (_shapes(each.equations) for each in (system, larger))
        stiffness, damping, _ = larger.equations.matrices
        if few.shape[0] != many.shape[0] or not set(damping) <= {"unity"}:
            return None
        X, *_ = np.linalg.lstsq(many, few, rcond=None)
        missed = np.linalg.norm(many @ X - few, axis=0) > _CONTAINED * np.linalg.norm(few, axis=0)
        if missed.any():
            return None
        n, matrices = larger.size, np.array([*stiffness.values()])
        C = damping.get("unity", np.zeros((n, n)))
        loads = np.array([*larger.equations.vectors.values()]).reshape(-1, n)
        of_motion = -np.concatenate([*(K @ X for K in matrices), C @ X], axis=1).T
        factors = np.concatenate([loads, of_motion])
        return cls(larger, tuple(stiffness), matrices, C, factors - factors @ X @ X.T, X)

    def mean_modes(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Compute squared frequencies and modes (columns) of the mean stiffness.

        The rows of `values` are samples of the functions of time that multiply the stiffness matrices.
        """
        flat = self.stiffness.reshape(len(self.stiffness), -1)
        return np.linalg.eigh((values.mean(axis=0) @ flat).reshape(self.larger.size, -1))

    def at(self, root: RootMotion, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Evaluate the residual (times, coordinates) for the motion of the root and the run's state q, v."""
        loads = [getattr(root, name)[:, None] for name in self.larger.equations.vectors]
        parts = [*loads, *(k[:, None] * q for k in self.values(root).T), v]
        return np.concatenate(parts, axis=1) @ self.factors

    def load(self, root: RootMotion) -> np.ndarray:
        """Evaluate the residual of the undeflected beam in the larger model, for the root's motion."""
        loads = np.stack([getattr(root, name) for name in self.larger.equations.vectors], axis=1)
        return loads @ self.factors[: loads.shape[1]]

    def values(self, root: RootMotion) -> np.ndarray:
        """Evaluate the functions of time that multiply the stiffness matrices: (times, functions)."""
        return np.stack([getattr(root, name) for name in self.quantities], axis=1)


def _shapes(equations: Equations) -> np.ndarray:
    """Compute the matrix from coordinates of reduced equations to those of their full discretization."""
    rows = []
    for shape in equations.shapes.values():
        rows.append(np.zeros((len(shape.matrix), equations.size)))
        rows[-1][:, equations.blocks[shape.block]] = shape.matrix
    return np.concatenate(rows)


def distance_along_path(
    path: Trajectory, system: ModalSystem, larger: ModalSystem, y0: np.ndarray, y0_of_larger: np.ndarray
) -> float | None:
    """Estimate the largest difference [m] of the tip deflections of a run and of a larger model.

    Parameters
    ----------
    path : Trajectory
        Motion of the run.
    system, larger : ModalSystem
        Equations of the run and of the larger model, which contains its modes.
    y0, y0_of_larger : ndarray, shape (2 m,) and (2 n,)
        Coordinates and velocities of the run and of the larger model at time 0.

    Returns
    -------
    float or None
        Distance [m]; None where the estimate by oscillators is not valid: gyroscopic coupling, coordinates
        that the larger model does not contain, a mode that diverges or is heavily damped, coupling of modes
        that does not settle, a motion that grows, or fast modes that vibrate with more than a tenth of the
        distance: after an abrupt start in long steps, or in a record that is rough from sample to sample.
    """
    residual, start = _Residual.of(system, larger), max(system.motion.steady_start, path.start)
    times, coordinates, _ = path.samples
    size = magnitude(coordinates[times >= start], system.tips)
    quarter = len(size) // 4
    grows = quarter > 0 and size[-quarter:].max() > _MOST_GROWTH * size[: 2 * quarter].max()
    if residual is None or grows:  # at steady speed the motion grows by parametric or other resonance
        return None
    (q0, v0), (e, rate) = np.split(y0, 2), np.split(y0_of_larger, 2)
    e, rate = e - residual.embedding @ q0, rate - residual.embedding @ v0
    largest, ringing, first = 0.0, 0.0, 0
    for segment in path.segments:
        if isinstance(segment, RecordSegment):
            ringing += _ringing_at_samples(residual, segment.steps)
        last = first + SAMPLES * len(segment.acceleration)
        t, q, v = (each[first : last + 1] for each in path.samples)
        inside = _INSIDE * (segment.end - segment.start)
        root = larger.root(np.clip(t, segment.start + inside, segment.end - inside))
        R, values, jump = residual.at(root, q, v), residual.values(root), True
        for here in _stretches(segment, residual, larger.motion.steady_start):
            found = _follow(residual, t[here], R[here], values[here], e, rate)
            if found is None:
                return None
            e, rate = found.e, found.rate
            ringing += found.ringing if jump else 0.0
            jump, largest = False, max(largest, found.largest + ringing)
        first = last
    return largest if ringing <= _MOST_RINGING * largest else None


def _ringing_at_samples(residual: _Residual, steps: RecordSteps) -> float:
    """Estimate the tip's amplitude [m] of fast modes, excited by jumps of the load's slope at samples.

    Only modes that are too fast for the run's samples count.  The contributions of all samples to a mode are
    added as random numbers are, by their squares.

    A change of the load's slope excites a mode of angular frequency w with the amplitude change / w^3.  A
    sudden jump of the load between two samples, a time h apart, looks like a slope jump / h, but excites a
    mode w h times as much as this slope would.
    """
    middle = steps.piece_start + steps.piece_width / 2
    root = residual.larger.root(middle)
    squares, modes = residual.mean_modes(residual.values(root))
    slope = np.diff(residual.load(root), axis=0) / np.diff(middle)[:, None]
    bends = np.linalg.norm(np.diff(slope, axis=0) @ modes, axis=0)
    w = np.sqrt(np.abs(squares))
    amplitude = bends / w**3 * np.maximum(1.0, w * steps.piece_width.max())
    fast = w * steps.h.max() / SAMPLES > _RESOLVED
    return _BY_CHANCE * float(size_per_coordinate(residual.larger.tips @ modes) @ (amplitude * fast))


def _stretches(segment: Segment | RecordSegment, residual: _Residual, steady_start: float) -> Iterator[slice]:
    """Yield slices of a segment's samples, one for each stretch; neighbours share their end samples."""
    steps, changing = len(segment.acceleration), segment.start < steady_start
    parts = (_OF_RECORD if isinstance(segment, RecordSegment) else _STRETCHES) if changing else 1
    decay = np.abs(residual.damping).sum(axis=0).max() / 2 * (segment.end - segment.start)
    count = min(steps, max(parts, int(np.ceil(decay / _MOST_DECAY))))
    for a, b in pairwise(np.arange(count + 1) * steps // count * SAMPLES):
        yield slice(int(a), int(b) + 1)


class _Followed(NamedTuple):
    """Difference e from the larger model in a stretch: its largest value at the tip [m], and its last value.

    `e` and `rate` are the difference and its time derivative, in coordinates, at the end of the stretch.

    `ringing` is the tip's vibration amplitude [m] in the fast modes, if the stretch begins with a load jump.
    """

    largest: float
    e: np.ndarray
    rate: np.ndarray
    ringing: float


def _follow(
    residual: _Residual, t: np.ndarray, R: np.ndarray, values: np.ndarray, e: np.ndarray, rate: np.ndarray
) -> _Followed | None:
    """Integrate the difference from the larger model over a stretch, mode by mode; None if that fails.

    It begins with coordinates e and velocities `rate`, and is driven by the residual R at times t.  The rows
    of `values` are the functions of time that multiply the stiffness matrices.
    """
    oscillators = _Oscillators.of(residual, t, values)
    if oscillators is None:
        return None
    modes, tips, force = oscillators.modes, residual.larger.tips @ oscillators.modes, R @ oscillators.modes
    start = modes.T @ e, modes.T @ rate
    y, _, _ = oscillators.respond(force, *start)
    for _ in range(_MOST_PASSES):
        before = y
        y, end, jump = oscillators.respond(force - oscillators.coupling(y), *start)
        largest = float(magnitude(y, tips).max())
        if magnitude(y - before, tips).max() <= _SETTLED * largest:
            ringing = size_per_coordinate(tips) @ jump
            return _Followed(largest, modes @ y[-1], modes @ end, float(ringing))
    return None


@dataclass(frozen=True)
class _Oscillators:
    """Modes of a stretch's mean stiffness, as oscillators with coupling forces.

    Parameters
    ----------
    t : ndarray, shape (N,)
        Times [s].
    values : ndarray, shape (N, k)
        Values of the functions of time that multiply the stiffness matrices.
    modes : ndarray, shape (n, n)
        Modes of the mean stiffness, in columns.
    coupled : ndarray, shape (k, n, n)
        Stiffness matrices transformed to these modes, without their diagonals.
    stiff : ndarray, shape (N, n)
        Stiffness of each mode [1/s^2].
    decay : ndarray, shape (n,)
        Rate of decay of each mode [1/s].
    slow : ndarray of bool, shape (n,)
        Whether the sampled times resolve the vibration of each mode.
    root, turn : ndarray, shape (N, j)
        Square roots of the resolved modes' angular frequencies, and their free vibration as complex phasors.
    """

    t: np.ndarray
    values: np.ndarray
    modes: np.ndarray
    coupled: np.ndarray
    stiff: np.ndarray
    decay: np.ndarray
    slow: np.ndarray
    root: np.ndarray
    turn: np.ndarray

    @classmethod
    def of(cls, residual: _Residual, t: np.ndarray, values: np.ndarray) -> _Oscillators | None:
        """Represent free vibration of the larger model by the modes of its mean stiffness at times t.

        None if a mode diverges or is heavily damped.
        """
        squares, modes = residual.mean_modes(values)
        matrices = modes.T @ residual.stiffness @ modes
        diagonals = np.diagonal(matrices, axis1=1, axis2=2)
        stiff, decay = values @ diagonals, ((residual.damping @ modes) * modes).sum(axis=0) / 2
        w2 = stiff - decay**2
        if squares[0] <= 0 or (w2.min(axis=0) <= decay**2).any():
            return None
        slow = np.sqrt(w2.max(axis=0)) * np.diff(t).max() <= _RESOLVED
        w = np.sqrt(w2[:, slow])
        phase = _cumulative(w, np.diff(t)[:, None])
        turn = np.exp(1j * phase - decay[slow] * (t - t[0])[:, None])
        coupled = matrices - diagonals[:, None] * np.eye(len(modes))
        return cls(t, values, modes, coupled, stiff, decay, slow, np.sqrt(w), turn)

    def coupling(self, y: np.ndarray) -> np.ndarray:
        """Compute the force on each mode by the motion y (times, modes) of the other modes."""
        each = (k[:, None] * (y @ K) for k, K in zip(self.values.T, self.coupled, strict=True))
        return sum(each, np.zeros_like(y))

    def respond(
        self, force: np.ndarray, y0: np.ndarray, v0: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Compute the motion (times, modes) from y0, v0 under forces (times, modes), and its end velocities.

        Fast modes are computed quasi-statically: the third result, a number for each mode, is the size of its
        jump from y0 at the start.
        """
        y, slow = force / self.stiff, self.slow
        end = (y[-1] - y[-2]) / (self.t[-1] - self.t[-2])
        jump = np.abs(np.where(slow, 0.0, y0 - y[0]))
        force, y0, v0 = force[:, slow], y0[slow], v0[slow]
        root, turn, decay = self.root, self.turn, self.decay[slow]
        start = (v0 + decay * y0) / root[0] + 1j * root[0] * y0
        a = turn * (start + _cumulative(force / (root * turn), np.diff(self.t)[:, None]))
        y[:, slow] = a.imag / root
        end[slow] = a[-1].real * root[-1] - decay * y[-1, slow]
        return y, end, jump


def _cumulative(values: np.ndarray, dt: np.ndarray) -> np.ndarray:
    """Integrate values from the first to each later time by trapezoids of widths dt, column by column."""
    parts = (values[1:] + values[:-1]) * (dt / 2)
    return np.concatenate([np.zeros_like(values[:1]), np.cumsum(parts, axis=0)])
