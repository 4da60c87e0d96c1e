"""The cheapest model that answers a question with a given accuracy."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeAlias

import numpy as np

from beamdyn.equations.discretization import Discretization
from beamdyn.equations.ritz import MOST_FUNCTIONS, Ritz
from beamdyn.modal.error_estimate import EstimatedModes, solve_with_error
from beamdyn.modal.model import Model
from beamdyn.scene.scene import Scene

DEFAULT_TARGET = 1e-11  # relative error aimed at by the defaults: two digits beyond the promised 1e-9
TOLERANCES = 1e-14, 0.1  # the least and the largest that can be asked for
_FEM_TARGET = 1e-7
_FEWEST_FUNCTIONS = 9  # fewer differ from their coarser companion by one, which a mode may have no use for

DiscretizationChoice: TypeAlias = "str | Discretization"  # "ritz", "fem", or one of given size


def solve_to_tolerance(
    scene: Scene,
    discretization: DiscretizationChoice,
    speeds: np.ndarray,
    modes: int,
    tolerance: float | None = None,
    extra: int = 0,
) -> EstimatedModes:
    """Solve the cheapest model that meets the tolerance at every speed; None is the promise of 1e-9.

    The parameters are those of `choose_model` and `solve_with_error`.
    """
    if tolerance is None:
        return solve_with_error(choose_model(scene, discretization, speeds, modes), speeds, modes, extra)
    model = choose_model(scene, discretization, speeds, modes, tolerance, cheapest=True)
    result = solve_with_error(model, speeds, modes, extra)
    while isinstance(discretization, str) and not result.meet(tolerance):
        if (finer := result.model.discretization.finer()) is None:
            break
        result = solve_with_error(Model(scene, finer), speeds, modes, extra)
    return result


def warn_of_missed_tolerance(error: float, tolerance: float) -> Iterator[str]:
    """The warning for an estimated error above the tolerance, if it is."""
    if error > tolerance:
        yield (
            f"tolerance = {tolerance:g} is not reached: the estimated relative error is {error:.1g}, "
            "and the model is the largest that helps"
        )


def choose_model(
    scene: Scene,
    discretization: DiscretizationChoice,
    speeds: np.ndarray,
    modes: int,
    target: float = DEFAULT_TARGET,
    cheapest: bool = False,
) -> Model:
    """Find the smallest model whose estimated error is below a target at the slowest and fastest speed.

    Parameters
    ----------
    scene : Scene
        The scene.
    discretization : {"ritz", "fem"} or Discretization
        The kind of discretization, or the very one.
    speeds : ndarray
        Speeds at which the model will be used [rad/s].
    modes : int
        Number of modes.
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
        If the discretization is unknown or has too few functions for the modes.
    """
    if not isinstance(discretization, str):
        return Model(scene, _check_room(discretization, modes))
    ends = np.unique(np.abs(speeds))[[0, -1]] if len(speeds) > 1 else speeds
    target = target if discretization == "ritz" else max(target, _FEM_TARGET)
    model = None
    for candidate in _refinements(discretization, scene, modes, target, cheapest):
        model = Model(scene, candidate)
        if solve_with_error(model, ends, modes).meet(target):
            break
    assert model is not None
    return model


def _refinements(
    name: str, scene: Scene, modes: int, target: float, cheapest: bool
) -> Iterator[Discretization]:
    """Discretizations of one kind, from the smallest worth trying on."""
    if name not in _FIRST_TRIED:
        raise ValueError(
            f"discretization = {name!r}: give {', '.join(map(repr, _FIRST_TRIED))}, "
            "a beamdyn.Ritz or a beamdyn.Fem"
        )
    first = _FIRST_TRIED[name](len(scene.beam.breakpoints) - 1, modes, target, cheapest)
    while not first.fits(modes) and (finer := first.finer()) is not None:
        first = finer
    step: Discretization | None = _check_room(first, modes)
    while step is not None:
        yield step
        step = step.finer()


def _first_ritz(segments: int, modes: int, target: float, cheapest: bool) -> Discretization:
    """The basis that mostly meets the target: the formula is from `benchmarks` on random scenes."""
    least = _FEWEST_FUNCTIONS if segments == 1 and cheapest else 5
    wanted = int(np.ceil(4 + 1.3 * modes - np.log10(target))) if cheapest else 10 + 2 * modes
    return Ritz(min(max(least, -(-wanted // segments)), MOST_FUNCTIONS))


def _first_fem(segments: int, modes: int, target: float, cheapest: bool) -> Discretization:
    from beamdyn.equations.fem import Fem  # loads scikit-fem, which Ritz has no need of

    return Fem(max(4 if cheapest else 80, 2 * segments, 4 * modes))


# The discretizations that are known by name: where to begin for a number of segments and modes.
_FIRST_TRIED: dict[str, Callable[[int, int, float, bool], Discretization]] = {
    "ritz": _first_ritz,
    "fem": _first_fem,
}


def with_room(discretization: DiscretizationChoice, modes: int) -> DiscretizationChoice:
    """The discretization, or "ritz" if it has too few functions for the modes."""
    fits = isinstance(discretization, str) or discretization.fits(modes)
    return discretization if fits else "ritz"


def _check_room(discretization: Discretization, modes: int) -> Discretization:
    if not discretization.fits(modes):
        raise ValueError(
            f"modes = {modes} with {discretization}: its coarser companion, which estimates the error, "
            "has too few functions; ask for fewer modes"
        )
    return discretization
