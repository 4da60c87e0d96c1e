"""Time steps for a motion given by samples: a step spans several samples if the tolerance allows.

Such a motion is smooth only between samples, but Gauss collocation needs coefficients that are smooth over a
step.  So each coefficient is replaced, over each step, by the polynomial of degree s - 1 nearest to it in the
mean square, where s is the number of stages.  The remainder is orthogonal to all polynomials of that degree.
As the response of a mode over a step is nearly such a polynomial, the remainder hardly changes the state at
the ends of the steps.  Its effect on the deflection between step ends is part of the error estimate
(`time_error`).

In shapes of arrays, N counts steps, and s nodes in each.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import cached_property, partial
from itertools import pairwise
from typing import Protocol

import numpy as np
from numpy.polynomial import legendre

from beamdyn.equations.root_motion import RootMotion
from beamdyn.scene.motion.base import Motion
from beamdyn.transient import gauss
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.weakly_modulated import propagate_modulated

# Number of stretches of a run; each stretch has one step size, which suits the motion in it.
_STRETCHES = 16
# Smallest number of sample intervals of a run for steps across samples; fewer are integrated one by one.
_FEWEST_PIECES = 16
# Mean number of steps per sample interval above which sample intervals are integrated one after the other.
_MOST_STEPS_IN_PIECE = 16
_PIECES_AT_ONCE = 4096  # number of sample intervals solved as one batch, whose matrices fit into memory
_SLACK = 1e-6  # fraction of a step by which rounding may lengthen it
# Largest and smallest number of equal steps whose maps are expanded about one mean motion of the root.
_EQUAL_STEPS, _FEWEST_EQUAL = 1024, 128
_SAME_LENGTH = 1e-6  # fraction of a step by which lengths and ends of equal steps may differ
# If all steps have at least the first number of pieces (sample intervals), the second number of nodes or
# stages in each piece suffices.
_MANY_PIECES, _IN_EACH = 4, 5


class StepCounter(Protocol):
    """Protocol: count equal steps in a time interval; see `beamdyn.transient.step_size.StepSize`."""

    def count_steps(self, system: ModalSystem, start: float, end: float) -> int:
        """Count the equal steps from start to end [s]."""
        ...


def is_record(system: ModalSystem, t_end: float, step_size: StepCounter) -> bool:
    """Return whether a motion has breakpoints about as dense as the time steps, as a sampled motion does."""
    pieces = len(smooth_piece_ends(system.motion, t_end)) - 1
    few = _MOST_STEPS_IN_PIECE * pieces
    return pieces >= _FEWEST_PIECES and step_size.count_steps(system, 0.0, t_end) <= few


def smooth_piece_ends(motion: Motion, t_end: float) -> np.ndarray:
    """List the ends [s] of the intervals on which a motion is smooth, including 0 and `t_end`."""
    breakpoints = np.array(motion.breakpoints)
    return np.concatenate([[0.0], breakpoints[(breakpoints > 0) & (breakpoints < t_end)], [t_end]])


@dataclass(frozen=True)
class RecordSteps:
    """Time steps of unequal length, and the pieces (smooth intervals of the motion) in each step.

    Parameters
    ----------
    start, h : ndarray, shape (N,)
        Beginnings and lengths of the steps [s].
    piece_start, piece_width : ndarray, shape (P,)
        Beginnings and lengths of the pieces [s], step by step.
    first : ndarray of int, shape (N,)
        Index of the first piece of each step.
    """

    start: np.ndarray
    h: np.ndarray
    piece_start: np.ndarray
    piece_width: np.ndarray
    first: np.ndarray

    @classmethod
    def choose(cls, system: ModalSystem, t_end: float, step_size: StepCounter) -> RecordSteps:
        """Choose steps about as long as `step_size` allows, which end at samples or divide a piece evenly."""
        wanted, ends = _wanted_steps(system, t_end, step_size), smooth_piece_ends(system.motion, t_end)
        # Number of steps in each piece.
        parts = np.maximum(1, np.ceil(np.diff(wanted(ends)) - _SLACK).astype(int))
        index = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
        inside = np.repeat(ends[:-1], parts) + index * np.repeat(np.diff(ends) / parts, parts)
        pieces = np.append(inside, ends[-1])
        few = wanted(np.array(t_end)) * _MANY_PIECES > len(pieces) - 1 and _are_same(np.diff(pieces)).all()
        first = [*range(len(pieces) - 1)] if few else _group(wanted(pieces).tolist())
        return cls(
            pieces[first], np.diff(pieces[[*first, -1]]), pieces[:-1], np.diff(pieces), np.array(first)
        )

    def __len__(self) -> int:
        return len(self.start)

    @cached_property
    def counts(self) -> np.ndarray:
        """Number of pieces of each step."""
        return np.diff([*self.first, len(self.piece_start)])

    @cached_property
    def blocks(self) -> list[slice]:
        """Divide the steps into blocks solved as one batch each: equal steps of one piece, or other steps."""
        single = self.counts == 1
        cuts = np.flatnonzero(~(_are_same(self.h) & single[1:] & single[:-1])) + 1
        runs = [(a, b) for a, b in pairwise([0, *cuts.tolist(), len(self)]) if b - a >= _FEWEST_EQUAL]
        ends = sorted({0, len(self), *(end for a, b in runs for end in (*range(a, b, _EQUAL_STEPS), b))})
        return [slice(a, b) for a, b in pairwise(ends)]

    def are_equal(self, block: slice) -> bool:
        """Return whether the steps of a block have one piece each, equal lengths, and evenly spaced ends."""
        ends = np.append(self.start[block], self.start[block.stop - 1] + self.h[block.stop - 1])
        grid = np.linspace(ends[0], ends[-1], len(ends))
        # Neighbouring lengths may differ little, but the differences add up over the block.
        off = np.abs(ends - grid).max()
        return bool(off <= _SAME_LENGTH * (grid[1] - grid[0]) and (self.counts[block] == 1).all())

    def select(self, which: np.ndarray) -> RecordSteps:
        """Return the steps with the given indices."""
        counts = self.counts[which]
        first = np.cumsum(counts) - counts
        pieces = np.repeat(self.first[which] - first, counts) + np.arange(counts.sum())
        return RecordSteps(
            self.start[which], self.h[which], self.piece_start[pieces], self.piece_width[pieces], first
        )

    def pieces(self) -> RecordSteps:
        """Return the pieces as separate steps."""
        index = np.arange(len(self.piece_start))
        return RecordSteps(self.piece_start, self.piece_width, self.piece_start, self.piece_width, index)

    def root(self, system: ModalSystem, table: gauss.Tableau) -> RootMotion:
        """Compute the root's motion at the nodes of all steps.

        In each step the motion is replaced by the nearest polynomial, by least squares.
        """
        within = gauss.tableau(self.nodes_in_piece(len(table.c)))
        root = system.root(self.piece_start[:, None] + self.piece_width[:, None] * within.c)
        if len(self.piece_start) == len(self):
            return root  # without a sample inside the step, the polynomial through the nodes is the nearest
        s, owner = len(table.c), np.repeat(np.arange(len(self)), self.counts)
        share = self.piece_width / self.h[owner]
        offset = (self.piece_start - self.start[owner]) / self.h[owner]
        inside = legendre.legvander(2 * (offset[:, None] + share[:, None] * within.c) - 1, s - 1)
        at_nodes = legendre.legvander(2 * table.c - 1, s - 1) * (2 * np.arange(s) + 1)
        # Weights with which values at a piece's nodes contribute to the values at the nodes of its step.
        weights = share[:, None, None] * within.b[:, None] * (inside @ at_nodes.T)
        values = (getattr(root, f.name) for f in fields(RootMotion))
        return RootMotion(*(np.add.reduceat((v[:, None] @ weights)[:, 0], self.first) for v in values))

    def nodes_in_piece(self, count: int) -> int:
        """Choose the number of nodes (or stages) in each piece of a step; a step of one piece needs `count`.

        A piece is an interval between two samples of the motion.  If every step has several pieces, fewer
        nodes in each are as accurate.
        """
        return min(count, _IN_EACH) if self.counts.min() >= _MANY_PIECES else count


def _wanted_steps(
    system: ModalSystem, t_end: float, step_size: StepCounter
) -> Callable[[np.ndarray], np.ndarray]:
    """Build the function that computes the number of steps that a step size requires from 0 to a time [s]."""
    times = np.linspace(0.0, t_end, _STRETCHES + 1)
    counts = [step_size.count_steps(system, a, b) for a, b in pairwise(times)]
    return partial(np.interp, xp=times, fp=np.concatenate([[0], np.cumsum(counts)]))


def most_steps_in_piece(system: ModalSystem, t_end: float, step_size: StepCounter) -> float:
    """Find the largest number of steps between two neighbouring samples that a step size requires."""
    wanted = _wanted_steps(system, t_end, step_size)
    return float(np.diff(wanted(smooth_piece_ends(system.motion, t_end))).max())


def _are_same(lengths: np.ndarray) -> np.ndarray:
    """Return whether each length equals the next one; the result has one entry less than `lengths`."""
    return np.abs(np.diff(lengths)) <= _SAME_LENGTH * lengths[:-1]


def _group(place: list[float]) -> list[int]:
    """Group neighbouring pieces into steps; return the index of the first piece of each step.

    The ends of the pieces are given in `place`, in units of the wanted step size.  A step has at most the
    length 1 in these units, but at least one piece.
    """
    first = [0]
    while True:
        end = bisect_right(place, place[first[-1]] + 1 + _SLACK) - 1
        if (end := max(end, first[-1] + 1)) >= len(place) - 1:
            return first
        first.append(end)


def maps_of_record(system: ModalSystem, steps: RecordSteps, stages: int) -> gauss.StepMaps:
    """Solve the collocation equations of all steps, scaled to unit length; return the unscaled maps."""
    table, n, h = gauss.tableau(stages), system.size, steps.h[:, None, None]
    C, K, f = system.assemble(steps.root(system, table))
    C = None if C is None else C * h[..., None]
    maps = gauss.solve_steps(C, K * h[..., None] ** 2, f * h**2, 1.0, table)
    step, acceleration = maps.step.copy(), maps.acceleration / h[..., None] ** 2
    step[:, n:] /= h
    step[:, :, n + 1 :] *= h
    acceleration[..., n + 1 :] *= h[..., None]
    return gauss.StepMaps(step, acceleration)


@dataclass(frozen=True)
class RecordSegment:
    """Segment of a trajectory, computed in unequal steps.

    Parameters
    ----------
    steps : RecordSteps
        The N steps.
    state : ndarray, shape (N + 1, 2 n + 1)
        Augmented states (1, q, v) at the ends of the steps.
    acceleration : ndarray, shape (N, s, n)
        Accelerations at the nodes of each step.
    """

    steps: RecordSteps
    state: np.ndarray
    acceleration: np.ndarray

    @property
    def start(self) -> float:
        """Time at the beginning of the segment [s]."""
        return float(self.steps.start[0])

    @property
    def end(self) -> float:
        """Time at the end of the segment [s]."""
        return float(self.steps.start[-1] + self.steps.h[-1])

    def projected(self, outputs: np.ndarray) -> RecordSegment:
        """Replace the n coordinates by d linear functions of them with coefficients `outputs` (d, n)."""
        return replace(
            self,
            state=gauss.project(self.state, outputs),
            acceleration=gauss.components(self.acceleration, outputs),
        )

    def samples(self, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Sample times, displacements, velocities at the beginnings of `count` equal parts of each step."""
        theta, h = np.arange(count) / count, self.steps.h[:, None, None]
        q, v = gauss.interpolate(h, self.state[:-1], self.acceleration, theta)
        t = self.steps.start[:, None] + self.steps.h[:, None] * theta
        return t.ravel(), q.reshape(t.size, -1), v.reshape(t.size, -1)

    def at(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Interpolate displacement and velocity at times t [s]: shape (len(t), n)."""
        t = np.asarray(t, dtype=float)
        k = np.maximum(np.searchsorted(self.steps.start, t, side="right") - 1, 0)
        h, start = self.steps.h[k], self.steps.start[k]
        return gauss.interpolate_each(h, self.state[k], self.acceleration[k], (t - start) / h)


def propagate_record(
    system: ModalSystem, steps: RecordSteps, q0: np.ndarray, v0: np.ndarray, stages: int, accuracy: float
) -> RecordSegment:
    """Integrate over unequal steps by Gauss collocation.

    Many successive steps of equal length, with no sample of the motion inside a step, form a block.  Their
    maps are expanded in a series about the mean motion of the block.  For other steps, the equations of each
    step are solved.

    Parameters
    ----------
    system : ModalSystem
        The equations.
    steps : RecordSteps
        The steps.
    q0, v0 : ndarray, shape (n,)
        Coordinates and velocities at the beginning.
    stages : int
        Stages of each step.
    accuracy : float
        Largest allowed relative error by truncating these series.

    Returns
    -------
    RecordSegment
    """
    state, acceleration = gauss.allocate_steps(len(steps), stages, q0, v0)
    for block in steps.blocks:
        ends = slice(block.start, block.stop + 1)
        if not _expand(system, steps, block, state[ends], acceleration[block], accuracy):
            _solve(system, steps, block, state[ends], acceleration[block])
    return RecordSegment(steps, state, acceleration)


def _expand(
    system: ModalSystem,
    steps: RecordSteps,
    block: slice,
    state: np.ndarray,
    acceleration: np.ndarray,
    accuracy: float,
) -> bool:
    """Compute states and accelerations in a block of equal steps, in place, by maps from a series.

    Return False, without a result, if the steps are few or unequal, or the equations vary too much for the
    series.
    """
    count, n = block.stop - block.start, system.size
    if count < _FEWEST_EQUAL or not steps.are_equal(block):
        return False
    start, end = float(steps.start[block.start]), float(steps.start[block.stop - 1] + steps.h[block.stop - 1])
    modulated, share = system.about_mean(start, end), accuracy * count / len(steps)
    if modulated is None:
        return False
    q, v = state[0, 1 : n + 1], state[0, n + 1 :]
    found = propagate_modulated(modulated, start, end, count, q, v, acceleration.shape[1], share)
    if found is None:
        return False
    state[:], acceleration[:] = found.state, found.acceleration
    return True


def _solve(
    system: ModalSystem, steps: RecordSteps, block: slice, state: np.ndarray, acceleration: np.ndarray
) -> None:
    """Compute the states in a block of steps, solving the collocation equations of each step."""
    size = max(1, min(gauss.BLOCK, _PIECES_AT_ONCE // int(steps.counts[block].max())))
    for first in range(0, len(acceleration), size):
        part = np.arange(first, min(first + size, len(acceleration)))
        maps = maps_of_record(system, steps.select(block.start + part), acceleration.shape[1])
        gauss.advance(maps.step, state[first : part[-1] + 2])
        acceleration[part] = (maps.acceleration @ state[part, None, :, None])[..., 0]
