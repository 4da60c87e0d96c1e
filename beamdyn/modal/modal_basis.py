"""Fewer coordinates: the lowest modes of the beam at rest, or at the speeds between which it turns.

Modes at rest are what the papers keep; under rotation they converge slowly.  Modes at the slowest and at
the fastest speed of a motion together hold the frequencies at both, and nearly those between.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from beamdyn.equations.equations_of_motion import Equations, SteadyPencil
from beamdyn.equations.operators import Space
from beamdyn.modal.eigen import Solver
from beamdyn.scene.motion import Motion

FEWEST = 2  # modes that are tried first where none are asked for
SAMPLED_TIMES = 2001  # at which the speed of a motion is looked at
_MOST_MODES = 60  # past them the fastest modes take all the time
_DEPENDENT = 1e-10  # share of a shape that is new, below which it is left out


@dataclass(frozen=True)
class Kept:
    """Modes that span the coordinates of a reduced model.

    Parameters
    ----------
    modes : int or None
        How many at each speed, of each field; None keeps all functions of the discretization.
    speeds : tuple of float
        Speeds at which they are modes [rad/s].
    """

    modes: int | None
    speeds: tuple[float, ...] = (0.0,)

    def __str__(self) -> str:
        if self.modes is None:
            return "all modes"
        if self.speeds == (0.0,):
            return f"{self.modes} modes"
        return f"{self.modes} modes at {' and at '.join(f'{v:.4g}' for v in self.speeds)} rad/s"

    def more(self) -> Kept | None:
        """Half as many modes more, at least two; None past those that can take part."""
        assert self.modes is not None
        more = self.modes + max(2, self.modes // 2)
        return replace(self, modes=more) if more <= _MOST_MODES else None


def range_of_speed(motion: Motion, t_end: float) -> tuple[float, ...]:
    """The slowest and the fastest speed until a time, either way; one if it is steady [rad/s]."""
    speed = np.abs(motion.at(np.linspace(0, t_end, SAMPLED_TIMES)).speed)
    return tuple(np.unique([speed.min(), speed.max()]).tolist())


@dataclass(frozen=True)
class ModalEquations:
    """Equations in modal coordinates of unit mass; the deflection comes first.

    Parameters
    ----------
    equations : Equations
        The reduced equations.
    vectors : ndarray, shape (n, m)
        Mass-normalised bending shapes in the functions of `space`, tip positive.
    space : Space
        The functions.
    """

    equations: Equations
    vectors: np.ndarray
    space: Space

    @cached_property
    def tip(self) -> np.ndarray:
        """Tip deflection of the modes [kg^-1/2], shape (m,)."""
        return self.vectors.T @ self.space.end(0)

    def shape(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Derivatives of the modes with respect to x/L at fractions xi of the length: shape (m, len(xi))."""
        return self.vectors.T @ self.space.evaluate(np.asarray(xi, dtype=float), order)


def reduced(whole: Equations, kept: Kept) -> ModalEquations:
    """Equations in the coordinates of the modes that are kept."""
    pencil, bending = whole.steady(), whole.operators.bending
    modes = kept.modes or whole.size
    vectors = {name: span(pencil.block(place), modes, kept.speeds) for name, place in whole.fields.items()}
    vectors["bending"] *= np.sign(bending.space.end(0) @ vectors["bending"])
    return ModalEquations(whole.reduced(vectors), vectors["bending"], bending.space)


def span(pencil: SteadyPencil, modes: int, speeds: Sequence[float]) -> np.ndarray:
    """Orthonormal shapes that span the lowest modes of a conservative pencil at some speeds.

    Parameters
    ----------
    pencil : SteadyPencil
        Of size n.
    modes : int
        How many modes at the last speed; at each of the others no more than two and half as many, as
        higher modes hardly change with speed.
    speeds : sequence of float
        Speeds [rad/s].

    Returns
    -------
    ndarray, shape (n, m)
        With unit mass and a diagonal stiffness at rest; m is smaller than the number of modes where
        those of different speeds depend on each other.
    """
    found = Solver(pencil).solve(np.asarray(speeds, dtype=float), min(modes, len(pencil.M))).vector
    if tuple(speeds) == (0.0,):
        return found[0]
    L = np.linalg.cholesky(pencil.M)
    all_shapes = np.concatenate([*found[:-1, :, : 2 + modes // 2], found[-1]], axis=1)
    directions, size, _ = np.linalg.svd(L.T @ all_shapes, full_matrices=False)
    kept = np.linalg.solve(L.T, directions[:, size > _DEPENDENT * size[0]])
    return kept @ np.linalg.eigh(kept.T @ pencil.K0 @ kept)[1]
