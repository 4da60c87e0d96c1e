"""The cheapest model that answers a question with a given accuracy, and the error that it leaves."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beamdyn.equations.equations_of_motion import Equations, equations
from beamdyn.equations.operators import Discretization, assemble
from beamdyn.equations.ritz import MOST_FUNCTIONS, Ritz
from beamdyn.modal.eigen import Eigen, Solver
from beamdyn.modal.modal_basis import Kept, ModalEquations, reduced
from beamdyn.scene.scene import Scene

TARGET = 1e-11  # relative error aimed at by the defaults: two digits beyond the promised 1e-9
TOLERANCES = 1e-14, 0.1  # the least and the largest that can be asked for
_FEM_TARGET = 1e-7
_UNRESOLVED = 0.3  # error from which two bases tell nothing of a third
_SLOW = 1e-10  # distance of two bases from which the error may exceed it
_LEAST = 9  # functions: fewer differ from their coarser companion by one, which a mode may have no use for


@dataclass(frozen=True)
class Model:
    """A scene in one discretization.

    Parameters
    ----------
    scene : Scene
        The scene.
    discretization : Discretization
        Its discretization.
    """

    scene: Scene
    discretization: Discretization

    @cached_property
    def equations(self) -> Equations:
        """The equations of motion."""
        return equations(self.scene, assemble(self.scene.beam, self.discretization, self.scene.stretch))

    @cached_property
    def solver(self) -> Solver:
        """The eigenproblem at steady speed."""
        return Solver(self.equations.steady())

    def modal(self, kept: Kept | int) -> ModalEquations:
        """The equations in the coordinates of the modes that are kept; of so many modes at rest."""
        return reduced(self.equations, Kept(kept) if isinstance(kept, int) else kept)

    @cached_property
    def coarser(self) -> Model:
        """The model that this one is compared with."""
        return Model(self.scene, self.discretization.coarser())


@dataclass(frozen=True)
class Estimated:
    """Modes over a batch of speeds, with the error of their eigenvalues.

    Parameters
    ----------
    model, coarse : Model
        The model that was solved, and the one that it was compared with.
    eigen : Eigen
        Modes of `model`.
    error : ndarray, shape (S, k)
        Estimated relative error of the eigenvalues: distance of the two models and rounding.
    """

    model: Model
    coarse: Model
    eigen: Eigen
    error: np.ndarray


def estimated(model: Model, speeds: np.ndarray, modes: int, extra: int = 0) -> Estimated:
    """Solve a model and its coarser companion; `extra` modes are solved but not compared."""
    coarse = model.coarser
    fine = model.solver.solve(speeds, min(modes + extra, model.solver.size))
    s = fine.eigenvalue[:, :modes]
    distance = s - coarse.solver.eigenvalues(speeds, modes)
    order = model.discretization.order
    if order is not None:  # Richardson: the two meshes know the leading term of the error
        s = s + distance / (2**order - 1)
        fine = Eigen(np.concatenate([s, fine.eigenvalue[:, modes:]], axis=1), fine.vector, fine.rounding)
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.abs(distance) / np.abs(s)
        left = relative / 3 if order is not None else _with_margin(distance, s, model.solver.rest)
        error = left + fine.rounding[:, :modes] + model.discretization.rounding
    return Estimated(model, coarse, fine, np.where(error < _UNRESOLVED, error, np.inf))  # nan, too


def _with_margin(distance: np.ndarray, s: np.ndarray, rest: float) -> np.ndarray:
    """Relative error of Ritz eigenvalues s (S, k) by their distance from those of a smaller basis.

    The next functions mostly bring less than the last did, but for staircases of even and odd ones, and
    modes whose distance is small by accident: measured on random scenes, where they converge slowly.
    `rest` is the lowest squared frequency at rest: where s vanishes, a distance is small against that.
    """
    own = np.abs(distance) / np.abs(s)
    of_squares = np.abs(distance * (s - distance / 2)) / np.maximum(np.abs(s) ** 2, rest)
    largest = of_squares.max(axis=1, keepdims=True)
    return np.where(largest > _SLOW, np.maximum(3 * own, 0.3 * largest), own)


def solved(
    scene: Scene,
    discretization: str | Discretization,
    speeds: np.ndarray,
    modes: int,
    tolerance: float | None = None,
    extra: int = 0,
) -> Estimated:
    """Modes by the cheapest model that keeps the tolerance at every speed; None is the promise of 1e-9.

    The parameters are those of `choose` and `estimated`.
    """
    if tolerance is None:
        return estimated(choose(scene, discretization, speeds, modes), speeds, modes, extra)
    found = estimated(
        choose(scene, discretization, speeds, modes, tolerance, cheapest=True), speeds, modes, extra
    )
    while isinstance(discretization, str) and not _reached(found, tolerance):
        if (finer := found.model.discretization.finer()) is None:
            break
        found = estimated(Model(scene, finer), speeds, modes, extra)
    return found


def _reached(found: Estimated, target: float) -> bool:
    """Whether the error is below the target, or within rounding."""
    modes = found.error.shape[1]
    return bool((found.error <= np.maximum(target, 3 * found.eigen.rounding[:, :modes])).all())


def missed(error: float, tolerance: float) -> Iterator[str]:
    """What to say of a tolerance that is not kept."""
    if error > tolerance:
        yield (
            f"tolerance = {tolerance:g} is not reached: the estimated relative error is {error:.1g}, "
            "and the model is the largest that helps"
        )


def choose(
    scene: Scene,
    discretization: str | Discretization,
    speeds: np.ndarray,
    modes: int,
    target: float = TARGET,
    cheapest: bool = False,
) -> Model:
    """The smallest model whose estimated error is below the target at the slowest and fastest speed.

    Parameters
    ----------
    scene : Scene
        The scene.
    discretization : {"ritz", "fem"} or Discretization
        The kind of model, or the very one.
    speeds : ndarray
        Speeds at which it will be used [rad/s].
    modes : int
        Modes that are wanted.
    target : float
        Relative error of their eigenvalues that is aimed at; finite elements stop at 1e-7.
    cheapest : bool
        Begin with the very smallest model, and not with one that is mostly enough for the default target.

    Returns
    -------
    Model

    Raises
    ------
    ValueError
        If the discretization is unknown or has no room for so many modes.
    """
    if not isinstance(discretization, str):
        return Model(scene, _roomy(discretization, modes))
    ends = np.unique(np.abs(speeds))[[0, -1]] if len(speeds) > 1 else speeds
    target = target if discretization == "ritz" else max(target, _FEM_TARGET)
    model = None
    for candidate in _ladder(discretization, scene, modes, target, cheapest):
        model = Model(scene, candidate)
        if _reached(estimated(model, ends, modes), target):
            break
    assert model is not None
    return model


def _predicted(modes: int, tolerance: float) -> int:
    """Functions that mostly keep a tolerance: found by `benchmarks/tradeoff.py` on random scenes."""
    return int(np.ceil(4 + 1.3 * modes - np.log10(tolerance)))


def _ladder(
    discretization: str, scene: Scene, modes: int, target: float, cheapest: bool
) -> Iterator[Discretization]:
    """Discretizations of one kind from the smallest worth trying."""
    segments = len(scene.beam.breakpoints) - 1
    if discretization == "ritz":
        least = _LEAST if segments == 1 and cheapest else 5
        wanted = _predicted(modes, target) if cheapest else 10 + 2 * modes
        start = max(least, -(-wanted // segments))
        first: Discretization = Ritz(min(start, MOST_FUNCTIONS))
    elif discretization == "fem":
        from beamdyn.equations.fem import Fem  # loads scikit-fem, which Ritz has no need of

        first = Fem(max(4 if cheapest else 80, 2 * segments, 4 * modes))
    else:
        raise ValueError(
            f"discretization = {discretization!r}: give 'ritz', 'fem', a beamdyn.Ritz or a beamdyn.Fem"
        )
    while not first.fits(modes) and (finer := first.finer()) is not None:
        first = finer
    step: Discretization | None = _roomy(first, modes)
    while step is not None:
        yield step
        step = step.finer()


def roomy(discretization: str | Discretization, modes: int) -> str | Discretization:
    """The discretization, or one of our choice if it has no room for so many modes."""
    fits = isinstance(discretization, str) or discretization.fits(modes)
    return discretization if fits else "ritz"


def _roomy(discretization: Discretization, modes: int) -> Discretization:
    if not discretization.fits(modes):
        raise ValueError(
            f"modes = {modes} with {discretization}: its coarser companion, which estimates the error, "
            "has too few functions; ask for fewer modes"
        )
    return discretization
