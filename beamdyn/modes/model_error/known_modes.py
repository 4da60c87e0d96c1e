"""Modes over the function spaces in which every effect can be added to them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beamdyn.common.assignment import assign
from beamdyn.equations.discretization import Spaces
from beamdyn.equations.equations_of_motion import Equations, SteadyPencil, assemble_over
from beamdyn.modes.modal.eigen import Eigen
from beamdyn.modes.modal.eigensolver import Eigensolver
from beamdyn.modes.modal.model import Model
from beamdyn.modes.modal.uncoupled import solver_of
from beamdyn.modes.model_error.pencils import KEPT
from beamdyn.scene.scene import Scene

_MOST = 160  # coordinates of a model: an estimate of a change needs no more
_EXTRA_MODES = 2  # higher ones with which the wanted may exchange their order


@dataclass(frozen=True)
class Simple:
    """The equations of a scene, without the effects, over spaces that suit those with each effect.

    Parameters
    ----------
    scene : Scene
        The scene.
    spaces : Spaces
        Function spaces with a breakpoint wherever the beam has one.
    equations : Equations
        The equations of motion.
    """

    scene: Scene
    spaces: Spaces
    equations: Equations

    @classmethod
    def of(cls, model: Model, modes: int) -> Simple:
        """Equations over the spaces of a model, or of a coarser one that suffices for so many modes."""
        discretization, segments = model.discretization, len(model.scene.beam.breakpoints) - 1
        while model.equations.modes > _MOST and discretization.coarser() != discretization:
            if not discretization.coarser().fits(max(2, -(-modes // segments))):
                break
            discretization = discretization.coarser()
            model = Model(model.scene, discretization)
        spaces = discretization.spaces(model.scene.beam)
        if spaces.shares_functions(discretization.spaces(model.scene.modelled_beam)):
            return cls(model.scene, spaces, model.equations)
        return cls(model.scene, spaces, assemble_over(model.scene, spaces))

    def pencil(self) -> SteadyPencil:
        """The equations at steady speed."""
        return self.equations.steady()

    def extend(self, scene: Scene) -> Equations:
        """The equations of the scene with an effect, over the same spaces."""
        return assemble_over(scene, self.spaces)

    def embed(self, equations: Equations, vectors: np.ndarray) -> np.ndarray:
        """Coordinates (N, ...) of extended equations for vectors (n, ...) of these: 0 in further fields."""
        embedded = np.zeros((equations.size, *vectors.shape[1:]), dtype=vectors.dtype)
        for name, place in self.equations.blocks.items():
            embedded[equations.blocks[name]] = vectors[place]
        return embedded

    @cached_property
    def _solver(self) -> Eigensolver:
        return solver_of(self.equations)

    def modes(self, speed: float, eigenvalue: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Eigenvalues (m,) and modes (n, m) of these equations, each the nearest to one that is given."""
        count = min(len(eigenvalue) + _EXTRA_MODES, self._solver.size)
        found: Eigen = self._solver.solve(np.array([speed]), count)
        s, v = found.eigenvalue[0], found.vector[0]
        order = assign(np.abs(eigenvalue[:, None] - s[None, :]))
        return s[order], v[:, order]


def find_alike(equations: Equations, speed: float, vectors: np.ndarray, count: int) -> np.ndarray:
    """Find the modes of equations that are mostly the given ones, by solving.

    Parameters
    ----------
    equations : Equations
        Equations of motion.
    speed : float
        Speed [rad/s].
    vectors : ndarray, shape (n, m)
        Modes of other equations in these coordinates.
    count : int
        Number of modes that are solved for.

    Returns
    -------
    ndarray of complex, shape (m,)
        Eigenvalues [1/s]; nan where no mode has more than half of the given one.
    """
    M, solver = equations.steady().M, solver_of(equations)
    found: Eigen = solver.solve(np.array([speed]), min(count, solver.size))
    s, within = found.eigenvalue[0], found.vector[0]
    product = np.abs(vectors.conj().T @ M @ within) ** 2
    kept = product / np.outer(_squares(M, vectors), _squares(M, within))
    return np.where(kept.max(axis=1) > KEPT, s[kept.argmax(axis=1)], np.nan)


def _squares(M: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Squared sizes (m,) of modes (n, m) by mass."""
    return np.einsum("nm,nm->m", vectors.conj(), M @ vectors).real
