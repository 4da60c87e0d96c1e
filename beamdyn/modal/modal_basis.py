"""Fewer coordinates: the lowest modes of the beam at rest, or at the speeds between which it turns.

Modes at rest are what the papers keep; under rotation they converge slowly.  Modes at the slowest and at
the fastest speed of a motion together hold the frequencies at both, and nearly those between.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from beamdyn.equations.equations_of_motion import Equations, SteadyPencil
from beamdyn.modal.eigen import Solver
from beamdyn.scene.motion import Motion

FEWEST_MODES = 2  # tried first where no number is given
SPEED_SAMPLES = 2001  # of a motion, for its slowest and fastest speed
_MOST_MODES = 60  # past them the fastest modes take all the time
_DEPENDENT = 1e-10  # independent share of a shape, below which it is left out


@dataclass(frozen=True)
class ModalBasis:
    """Modes that span the coordinates of a reduced model.

    Parameters
    ----------
    modes : int or None
        Number of modes at each speed, of each field; None keeps all functions of the discretization.
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

    def refined(self) -> ModalBasis | None:
        """Half as many modes more, at least two; None past the largest number."""
        assert self.modes is not None
        more = self.modes + max(2, self.modes // 2)
        return replace(self, modes=more) if more <= _MOST_MODES else None


def find_speed_range(motion: Motion, t_end: float) -> tuple[float, ...]:
    """The slowest and the fastest |speed| until `t_end` [s]; one value if it is steady [rad/s]."""
    speed = np.abs(motion.at(np.linspace(0, t_end, SPEED_SAMPLES)).speed)
    return tuple(np.unique([speed.min(), speed.max()]).tolist())


def reduce_to_modes(equations: Equations, basis: ModalBasis) -> Equations:
    """Equations in modal coordinates: of unit mass, deflecting ones with a positive tip."""
    pencil, count = equations.steady(), basis.modes or equations.size
    shapes = {
        name: span_modes(pencil.block(place), count, basis.speeds) for name, place in equations.blocks.items()
    }
    for name, place in equations.blocks.items():
        shapes[name] *= np.where(equations.tip[place] @ shapes[name] < 0, -1.0, 1.0)
    return equations.reduced(shapes)


def span_modes(pencil: SteadyPencil, modes: int, speeds: Sequence[float]) -> np.ndarray:
    """Orthonormal shapes that span the lowest modes of a conservative pencil at some speeds.

    Parameters
    ----------
    pencil : SteadyPencil
        Of size n.
    modes : int
        Number of modes at the last speed; at each of the others at most two and half as many, as
        higher modes hardly change with speed.
    speeds : sequence of float
        Speeds [rad/s].

    Returns
    -------
    ndarray, shape (n, m)
        With unit mass and a diagonal stiffness at rest; m is smaller than the number of modes where
        those of different speeds depend on each other.
    """
    vectors = Solver(pencil).solve(np.asarray(speeds, dtype=float), min(modes, len(pencil.M))).vector
    if tuple(speeds) == (0.0,):
        return vectors[0]
    L = np.linalg.cholesky(pencil.M)
    all_shapes = np.concatenate([*vectors[:-1, :, : 2 + modes // 2], vectors[-1]], axis=1)
    directions, size, _ = np.linalg.svd(L.T @ all_shapes, full_matrices=False)
    independent = np.linalg.solve(L.T, directions[:, size > _DEPENDENT * size[0]])
    return independent @ np.linalg.eigh(independent.T @ pencil.K0 @ independent)[1]
