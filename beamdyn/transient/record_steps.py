"""Steps for a motion that is given by many samples: several samples to a step, where the tolerance allows.

Such a motion is smooth between samples only, and Gauss collocation needs coefficients that are smooth over a
step.  So each coefficient is replaced, over each step, by the polynomial of degree s - 1 nearest to it in the
mean square, with s stages.  What this leaves out is orthogonal to all polynomials of that degree, and the
response of a mode over a step is nearly one: at the ends of the steps its work all but vanishes.  Between
them it shows in the deflection, where the error estimate sees it (`record_error`).
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, fields, replace
from functools import cached_property
from itertools import pairwise
from typing import Protocol

import numpy as np
from numpy.polynomial import legendre

from beamdyn.equations.root_motion import RootMotion
from beamdyn.scene.motion import Motion
from beamdyn.transient.gauss import (
    BLOCK,
    StepMaps,
    Tableau,
    advance,
    components,
    interpolate,
    interpolate_each,
    project,
    solve_steps,
    tableau,
)
from beamdyn.transient.system import ModalSystem

_STRETCHES = 16  # of a run, each with steps as long as the motion in it allows
_FEWEST_PIECES = 16  # between samples: fewer are integrated one after the other
_MOST_STEPS_IN_PIECE = 16  # on average: with more, the pieces are better integrated one after the other
_PIECES_AT_ONCE = 4096  # in the steps of a block, whose matrices fit into memory
_SLACK = 1e-6  # of a step, by which rounding may exceed it
_MANY_PIECES, _IN_EACH = 4, 5  # in a step, and nodes or stages in each, with which a quarter is as exact


class StepCounter(Protocol):
    """Choice of the number of equal steps: see `beamdyn.transient.step_size.StepSize`."""

    def count_steps(self, system: ModalSystem, start: float, end: float) -> int:
        """Number of equal steps from start to end [s]."""
        ...


def is_record(system: ModalSystem, t_end: float, step_size: StepCounter) -> bool:
    """Whether a motion has breakpoints about as dense as the steps, as one given by samples has."""
    pieces = len(smooth_piece_ends(system.motion, t_end)) - 1
    few = _MOST_STEPS_IN_PIECE * pieces
    return pieces >= _FEWEST_PIECES and step_size.count_steps(system, 0.0, t_end) <= few


def smooth_piece_ends(motion: Motion, t_end: float) -> np.ndarray:
    """The ends of the pieces on which a motion is smooth, 0 and `t_end` included [s]."""
    breakpoints = np.array(motion.breakpoints)
    return np.concatenate([[0.0], breakpoints[(breakpoints > 0) & (breakpoints < t_end)], [t_end]])


@dataclass(frozen=True)
class RecordSteps:
    """Steps of unequal length, and the pieces in them on which the motion is smooth.

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
        """Choose steps about as long as the step size allows, which end at samples or divide a piece."""
        stretches = np.linspace(0.0, t_end, _STRETCHES + 1)
        counts = [step_size.count_steps(system, a, b) for a, b in pairwise(stretches)]
        wanted = np.concatenate([[0], np.cumsum(counts)])  # number of steps up to a time
        ends = smooth_piece_ends(system.motion, t_end)
        pieces = _divide(ends, np.ceil(np.diff(np.interp(ends, stretches, wanted)) - _SLACK))
        first = _group(np.interp(pieces, stretches, wanted).tolist())
        return cls(
            pieces[first], np.diff(pieces[[*first, -1]]), pieces[:-1], np.diff(pieces), np.array(first)
        )

    def __len__(self) -> int:
        return len(self.start)

    @cached_property
    def counts(self) -> np.ndarray:
        """Number of pieces of each step, shape (N,)."""
        return np.diff([*self.first, len(self.piece_start)])

    def select(self, which: np.ndarray) -> RecordSteps:
        """Some of the steps, by their indices."""
        counts = self.counts[which]
        first = np.cumsum(counts) - counts
        pieces = np.repeat(self.first[which] - first, counts) + np.arange(counts.sum())
        return RecordSteps(
            self.start[which], self.h[which], self.piece_start[pieces], self.piece_width[pieces], first
        )

    def pieces(self) -> RecordSteps:
        """The pieces as steps of their own."""
        index = np.arange(len(self.piece_start))
        return RecordSteps(self.piece_start, self.piece_width, self.piece_start, self.piece_width, index)

    def root(self, system: ModalSystem, table: Tableau) -> RootMotion:
        """Motion of the root at the nodes of the steps, each quantity by its nearest polynomial: (N, s)."""
        within = tableau(self.nodes_in_piece(len(table.c)))
        root = system.root(self.piece_start[:, None] + self.piece_width[:, None] * within.c)
        if len(self.piece_start) == len(self):
            return root  # without a sample inside, a polynomial through the nodes is the nearest
        weights, values = self._projection(within, table), (getattr(root, f.name) for f in fields(RootMotion))
        return RootMotion(*(np.add.reduceat((v[:, None] @ weights)[:, 0], self.first) for v in values))

    def nodes_in_piece(self, count: int) -> int:
        """Number of nodes or stages in each piece that are as exact as `count` of them in a step."""
        return min(count, _IN_EACH) if self.counts.min() >= _MANY_PIECES else count

    def _projection(self, within: Tableau, table: Tableau) -> np.ndarray:
        """Weights of the values at the r nodes of a piece in those of its step's polynomial: (P, r, s)."""
        s, owner = len(table.c), np.repeat(np.arange(len(self)), self.counts)
        share = self.piece_width / self.h[owner]
        offset = (self.piece_start - self.start[owner]) / self.h[owner]
        inside = legendre.legvander(2 * (offset[:, None] + share[:, None] * within.c) - 1, s - 1)
        at_nodes = legendre.legvander(2 * table.c - 1, s - 1) * (2 * np.arange(s) + 1)
        return share[:, None, None] * within.b[:, None] * (inside @ at_nodes.T)


def _divide(ends: np.ndarray, parts: np.ndarray) -> np.ndarray:
    """Divide each piece into a number of equal parts, at least one: all ends."""
    parts = np.maximum(1, parts.astype(int))
    index = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
    return np.append(np.repeat(ends[:-1], parts) + index * np.repeat(np.diff(ends) / parts, parts), ends[-1])


def _group(place: list[float]) -> list[int]:
    """Group consecutive pieces that end at the given places into steps of length 1 or less: their first."""
    first = [0]
    while True:
        end = bisect_right(place, place[first[-1]] + 1 + _SLACK) - 1
        if (end := max(end, first[-1] + 1)) >= len(place) - 1:
            return first
        first.append(end)


def maps_of_record(system: ModalSystem, steps: RecordSteps, stages: int) -> StepMaps:
    """Solve the collocation equations of all steps, in the time of each, and transform back to seconds."""
    table, n, h = tableau(stages), system.size, steps.h[:, None, None]
    C, K, f = system.assemble(steps.root(system, table))
    C = None if C is None else C * h[..., None]
    maps = solve_steps(C, K * h[..., None] ** 2, f * h**2, 1.0, table)
    step, acceleration = maps.step.copy(), maps.acceleration / h[..., None] ** 2
    step[:, n:] /= h
    step[:, :, n + 1 :] *= h
    acceleration[..., n + 1 :] *= h[..., None]
    return StepMaps(step, acceleration)


@dataclass(frozen=True)
class RecordSegment:
    """Segment of a trajectory in unequal steps.

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
        """Beginning [s]."""
        return float(self.steps.start[0])

    @property
    def end(self) -> float:
        """End [s]."""
        return float(self.steps.start[-1] + self.steps.h[-1])

    def projected(self, outputs: np.ndarray) -> RecordSegment:
        """Segment of linear functions of the coordinates, given per unit of each: (d, n)."""
        return replace(
            self, state=project(self.state, outputs), acceleration=components(self.acceleration, outputs)
        )

    def samples(self, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Sample times, displacements and velocities at `count` equal parts of each step, without its end."""
        theta, h = np.arange(count) / count, self.steps.h[:, None, None]
        q, v = interpolate(h, self.state[:-1], self.acceleration, theta)
        t = self.steps.start[:, None] + self.steps.h[:, None] * theta
        return t.ravel(), q.reshape(t.size, -1), v.reshape(t.size, -1)

    def at(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Interpolate displacement and velocity at times t [s]: shape (len(t), n)."""
        t = np.asarray(t, dtype=float)
        k = np.maximum(np.searchsorted(self.steps.start, t, side="right") - 1, 0)
        h, start = self.steps.h[k], self.steps.start[k]
        return interpolate_each(h, self.state[k], self.acceleration[k], (t - start) / h)


def propagate_record(
    system: ModalSystem, steps: RecordSteps, q0: np.ndarray, v0: np.ndarray, stages: int
) -> RecordSegment:
    """Integrate over unequal steps by Gauss collocation, from coordinates q0 and velocities v0."""
    N, n = len(steps), system.size
    state, acceleration = np.empty((N + 1, 2 * n + 1)), np.empty((N, stages, n))
    state[:, 0], state[0, 1 : n + 1], state[0, n + 1 :] = 1, q0, v0
    size = max(1, min(BLOCK, _PIECES_AT_ONCE // int(steps.counts.max())))
    for first in range(0, N, size):
        block = np.arange(first, min(first + size, N))
        maps = maps_of_record(system, steps.select(block), stages)
        advance(maps.step, state[first : block[-1] + 2])
        acceleration[block] = (maps.acceleration @ state[block, None, :, None])[..., 0]
    return RecordSegment(steps, state, acceleration)
