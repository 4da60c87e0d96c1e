"""Modal bases: the lowest modes of the beam at rest, or at the slowest and fastest speed of a motion.

The papers use modes at rest, which converge slowly under rotation.  Modes at the slowest and the fastest
speed together reproduce the frequencies at both, and nearly those between.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from beamdyn.common.inputs.checks import count
from beamdyn.equations.equations_of_motion import Equations, SteadyPencil
from beamdyn.modes.modal.eigenproblem import Solver
from beamdyn.scene.motion import Motion

FEWEST_MODES = 2  # number of modes of the first basis where no number is given
SPEED_SAMPLES = 2001  # number of times at which a motion's slowest and fastest speed are sought
_MOST_MODES = 60  # largest number of modes: with more, the fastest modes need too small steps
_MASSLESS = 1e-14  # ratio of a mass pivot to the largest that is 0 within rounding
_DEPENDENT = 1e-10  # relative singular value below which shapes are linearly dependent


@dataclass(frozen=True)
class ModalBasis:
    """Modes that span the coordinates of a reduced model.

    Parameters
    ----------
    modes : int or None
        Number of modes at each speed of each set of coupled fields; None for all modes of the discretization.
    speeds : tuple of float
        Speeds of the modes [rad/s].
    """

    modes: int | None
    speeds: tuple[float, ...] = (0.0,)

    def __str__(self) -> str:
        if self.modes is None:
            return "all modes"
        if self.is_at_rest:
            return f"{self.modes} modes"
        return f"{self.modes} modes at {' and at '.join(f'{v:.4g}' for v in self.speeds)} rad/s"

    @property
    def is_at_rest(self) -> bool:
        """Whether all modes of the basis are modes at rest."""
        return self.speeds == (0.0,)

    def refined(self) -> ModalBasis | None:
        """Enlarge the basis by half as many modes, at least two; None if that exceeds the limit."""
        assert self.modes is not None
        modes = self.modes + max(2, self.modes // 2)
        return replace(self, modes=modes) if modes <= _MOST_MODES else None

    def with_one_more(self) -> ModalBasis | None:
        """Enlarge the basis by one mode; None if that exceeds the limit."""
        assert self.modes is not None
        return replace(self, modes=self.modes + 1) if self.modes < _MOST_MODES else None


def given_basis(modes: int | str) -> ModalBasis | None:
    """Build a basis of a number of modes at rest; None for "auto", which leaves it to the tolerance."""
    auto = isinstance(modes, str) and modes == "auto"
    return None if auto else ModalBasis(count("modes", modes, remedy='or "auto"'))


def find_speed_range(motion: Motion, t_end: float) -> tuple[float, ...]:
    """Find the smallest and largest |speed| [rad/s] until `t_end` [s]; one value if it is constant."""
    speed = np.abs(motion.at(np.linspace(0, t_end, SPEED_SAMPLES)).speed)
    return tuple(np.unique([speed.min(), speed.max()]).tolist())


def reduce_to_modes(equations: Equations, basis: ModalBasis) -> Equations:
    """Transform the equations to modal coordinates of unit mass, signed for a positive tip deflection."""
    pencil, count = equations.steady(), basis.modes or equations.size
    bases = {}
    for names in equations.coupled:
        places = equations.places(names)
        shapes = span_modes(pencil.part(places).undamped(), count, basis.speeds)
        tips = equations.tips[:, places] @ shapes
        larger = np.take_along_axis(tips, np.abs(tips).argmax(axis=0)[None], axis=0)[0]
        bases[names] = shapes * np.where(larger < 0, -1.0, 1.0)
    reduced = equations.reduced(bases)
    return reduced if equations.circuit is None else _with_residual(equations, reduced, basis.speeds[-1])


def _with_residual(equations: Equations, reduced: Equations, speed: float) -> Equations:
    """Add the residual flexibility of the modes left out, at a speed [rad/s], to the capacitance."""
    circuit, kept = equations.circuit, reduced.circuit
    assert circuit is not None and kept is not None
    stiffness = [p.K0 + speed**2 * p.K2 for p in (each.steady() for each in (equations, reduced))]
    by_modes = np.linalg.solve(stiffness[1], kept.coupling)
    bent = np.linalg.solve(stiffness[0], circuit.coupling)
    bent = {
        name: bent[equations.blocks[name]] - shape.matrix @ by_modes[reduced.blocks[shape.block]]
        for name, shape in reduced.shapes.items()
    }
    more = sum(circuit.coupling[equations.blocks[name]] @ g for name, g in bent.items())
    capacitance = circuit.capacitance + float(more)
    return replace(reduced, circuit=replace(kept, capacitance=capacitance, bent=bent))


def span_modes(pencil: SteadyPencil, modes: int, speeds: Sequence[float]) -> np.ndarray:
    """Compute mass-normalised shapes that span the lowest conservative modes at given speeds.

    Parameters
    ----------
    pencil : SteadyPencil
        Conservative equations of size n.
    modes : int
        Number of modes at the last speed; at each other speed 2 + modes // 2, because higher modes
        hardly change with speed.
    speeds : sequence of float
        Speeds [rad/s].

    Returns
    -------
    ndarray, shape (n, m)
        Shapes in columns, with unit mass and a diagonal stiffness at rest; m is smaller than the total
        number of modes if those of different speeds are linearly dependent.
    """
    vectors = Solver(pencil).solve(np.asarray(speeds, dtype=float), min(modes, len(pencil.M))).vector
    if tuple(speeds) == (0.0,):
        return vectors[0]
    all_shapes = np.concatenate([*vectors[:-1, :, : 2 + modes // 2], vectors[-1]], axis=1)
    independent = _orthonormal(pencil.M, all_shapes)
    return independent @ np.linalg.eigh(independent.T @ pencil.K0 @ independent)[1]


def _orthonormal(M: np.ndarray, shapes: np.ndarray) -> np.ndarray:
    """Combine shapes in columns to linearly independent ones, orthonormal in the mass."""
    with suppress(np.linalg.LinAlgError):
        L = np.linalg.cholesky(M)
        pivots = np.diag(L) ** 2
        if pivots.min() >= _MASSLESS * pivots.max():
            directions, size, _ = np.linalg.svd(L.T @ shapes, full_matrices=False)
            return np.linalg.solve(L.T, directions[:, size > _DEPENDENT * size[0]])
    # The mass is singular, as that of bending and shear without rotary inertia: it does not tell how much of
    # a deflection is shear, only combinations of the given shapes do.
    values, vectors = np.linalg.eigh(M)
    root = np.sqrt(np.maximum(values, 0))[:, None] * vectors.T
    _, size, weights = np.linalg.svd(root @ shapes, full_matrices=False)
    known = size > _DEPENDENT * size[0]
    combined = shapes @ (weights[known].T / size[known])
    L = np.linalg.cholesky(combined.T @ M @ combined)  # removes the rounding of nearly dependent shapes
    return np.linalg.solve(L, combined.T).T
