"""Work-precision diagrams of natural frequencies: error over computing time for bases and elements."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from math import inf
from typing import Any, Literal

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.numerics import assign
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.words import percent
from beamdyn.equations.discretization import Discretization
from beamdyn.equations.effects import LARGE_DEFLECTION, STRETCH
from beamdyn.equations.fem import Fem
from beamdyn.equations.ritz import Ritz
from beamdyn.modes.bounds import frequency_bounds
from beamdyn.modes.locus import frequency_locus
from beamdyn.modes.modal.discretization_choice import count_segments
from beamdyn.modes.modal.error_estimate import EstimatedModes, solve_with_error
from beamdyn.modes.modal.model import Model, bends
from beamdyn.modes.model_error.added_effects import list_effects
from beamdyn.modes.modes import natural_modes
from beamdyn.scene.scene import Scene
from beamdyn.studies.tradeoffs.measurements import (
    Diagram,
    Family,
    TimedCase,
    at_speeds,
    measure_families,
    number_of,
)

Mesh = Literal["graded", "uniform"]

_LEGENDRE = (*range(1, 13), 14, 16, 18, 20, 24, 28, 32, 40)
_MOST_ACROSS = 14  # largest number of functions on a segment, if there also are functions across the width
_EIGENFUNCTIONS = (1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 28, 40, 56, 80)
_ELEMENTS = (2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 28, 40, 56, 80)
_TOLERANCES = tuple(10.0**-k for k in range(1, 13))
_REFERENCES = (40, 80, 160)  # numbers of functions of the reference, on all segments together, tried in turn
# Number of functions of the reference along the beam if there also are functions across the width: only one
# is tried, as the error then never reaches `_RESOLVED`.
_REFERENCE_ACROSS = (60,)
_RESOLVED = 1e-10  # relative error below which a reference is accurate enough


@one_blas_thread()  # with small matrices, further threads only slow each other down
def frequency_diagram(scene: Scene, speeds: np.ndarray, modes: int = 3, budget: float = 10.0) -> Diagram:
    """Measure error against computing time of the natural frequencies at one or several speeds.

    The time of a basis is the time for matrices and eigenvalues; extrapolated finite elements are solved
    twice, the second time with half the elements; for ``tolerance=`` it is the time of the whole call, which
    also chooses the basis and estimates the error.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.
    speeds : ndarray, shape (S,)
        Speeds [rad/s], ascending.
    modes : int
        Number of the lowest modes.
    budget : float
        Time for all measurements [s].

    Returns
    -------
    Diagram

    Raises
    ------
    ArithmeticError
        If the reference is not within the guaranteed bounds.
    """
    exact = solve_reference(scene, speeds, modes)
    true = sizes_of_eigenvalues(exact.eigen.eigenvalue)

    def error(eigenvalues: np.ndarray) -> float:
        with np.errstate(divide="ignore", invalid="ignore"):
            return float(np.abs(sizes_of_eigenvalues(eigenvalues) / true - 1).max())

    measurements, skipped = measure_families(
        list(_families(scene, speeds, modes)), error, resolved := float(exact.error.max()), budget
    )
    reference = f"{exact.model.discretization}; {_compare_with_bounds(exact, float(speeds[-1]), modes)}"
    title = f"{number_of(modes, 'frequency', 'frequencies')} {at_speeds(speeds)}"
    error_of = "the frequency with the largest relative error"
    return Diagram.make(title, error_of, reference, resolved, measurements, skipped)


def sizes_of_eigenvalues(eigenvalues: np.ndarray) -> np.ndarray:
    """Compute magnitudes of eigenvalues in ascending order, (speeds, modes)."""
    return np.sort(np.abs(eigenvalues), axis=-1)


def solve_reference(scene: Scene, speeds: np.ndarray, modes: int) -> EstimatedModes:
    """Compute reference modes with as many Ritz functions as resolve them."""
    *coarser, finest = _REFERENCE_ACROSS if scene.models_width else _REFERENCES
    segments = count_segments(scene)
    for functions in coarser:
        solution = _solve_by_ritz(scene, speeds, modes, functions // segments)
        if solution.error.max() <= _RESOLVED:
            return solution
    return _solve_by_ritz(scene, speeds, modes, finest // segments)


def _solve_by_ritz(scene: Scene, speeds: np.ndarray, modes: int, functions: int) -> EstimatedModes:
    """Compute modes and their errors with a number of Ritz functions on each segment.

    The number is increased until the coarser basis, which gives the errors, has all modes, too.
    """
    return solve_with_error(Model(scene, Ritz(max(functions, 12, 5 * modes // 4 + 3))), speeds, modes)


def _compare_with_bounds(exact: EstimatedModes, speed: float, modes: int) -> str:
    """Compare the reference with the guaranteed bounds at a speed, and describe the outcome."""
    try:
        bounds = frequency_bounds(exact.model.scene, speed, modes)
    except ValueError:  # bounds are not available with stretch or damping
        return "the guaranteed bounds do not cover this model"
    squared = np.sort(-np.real(exact.eigen.eigenvalue[-1] ** 2))
    slack = 2 * exact.error.max() * np.abs(squared)
    below, above = squared < bounds.lower_squared - slack, squared > bounds.upper_squared + slack
    if below.any() or above.any():
        raise ArithmeticError(f"the reference at {speed:g} rad/s is not within the guaranteed bounds")
    if np.isnan(bounds.width).any():
        return f"within the guaranteed bounds at {speed:.6g} rad/s, as far as there are bounds"
    return f"within the guaranteed bounds at {speed:.6g} rad/s, which are {bounds.width.max():.0e} apart"


def _families(scene: Scene, speeds: np.ndarray, modes: int) -> Iterator[Family]:
    """Yield all families to measure: Ritz bases, finite elements, and the basis chosen for a tolerance."""
    segments, bases = count_segments(scene), {"legendre": _LEGENDRE, "eigenfunctions": _EIGENFUNCTIONS}
    for basis, sizes in bases.items():
        yield Family(f"Ritz, {basis}", _basis_settings(scene, speeds, modes, basis, sizes, segments))
    meshes: tuple[Mesh, ...] = ("graded", "uniform")
    for mesh in meshes:
        yield from _fem_pair(scene, speeds, modes, mesh, segments)
    # With stretch, modes may cross: a tracked locus then differs from the lowest modes.
    if not scene.physics.stretch:
        cases = (TimedCase(f"tolerance={t:.0e}", t, _full_call(scene, speeds, modes, t)) for t in _TOLERANCES)
        yield Family("tolerance=", tuple(cases))


def _basis_settings(
    scene: Scene, speeds: np.ndarray, modes: int, basis: Any, sizes: Sequence[int], segments: int
) -> tuple[TimedCase, ...]:
    """Make a case for each size of a Ritz basis; for Legendre functions it is the number per segment."""
    per_segment = segments if basis == "legendre" else 1
    each = "functions a segment" if per_segment > 1 else "functions"
    least, most = -(-modes // per_segment), _MOST_ACROSS if scene.models_width else inf
    return tuple(
        TimedCase(f"{n} {each}", n, _solve(scene, Ritz(n, basis), speeds, modes))
        for n in sizes
        if least <= n <= most
    )


def _fem_pair(scene: Scene, speeds: np.ndarray, modes: int, mesh: Mesh, segments: int) -> Iterator[Family]:
    """Yield two families of finite elements: without and with extrapolation."""
    for name, solve, share in (("", _solve, 1), (", extrapolated", _extrapolate, 2)):
        least = max(segments, -(-modes // 2), 2) * share
        cases = (
            TimedCase(f"{n} elements", n, solve(scene, Fem(n, mesh), speeds, modes))
            for n in _ELEMENTS
            if n >= least
        )
        yield Family(f"elements, {mesh}{name}", tuple(cases))


def _solve(
    scene: Scene, discretization: Discretization, speeds: np.ndarray, modes: int
) -> Callable[[float], Any]:
    """Return a function that computes the eigenvalues with a discretization."""
    return lambda deadline: Model(scene, discretization).solver.eigenvalues(speeds, modes)


def _extrapolate(
    scene: Scene, discretization: Discretization, speeds: np.ndarray, modes: int
) -> Callable[[float], Any]:
    """Return a function that computes eigenvalues by Richardson extrapolation from half the elements."""
    fine, coarse = (_solve(scene, d, speeds, modes) for d in (discretization, discretization.coarser()))
    gain = 2 ** (discretization.order or 4) - 1

    def run(deadline: float) -> np.ndarray:
        s = fine(deadline)
        return s + (s - coarse(deadline)) / gain

    return run


def _full_call(scene: Scene, speeds: np.ndarray, modes: int, tolerance: float) -> Callable[[float], Any]:
    """Return a function that calls `natural_modes` or `frequency_locus` with a tolerance."""
    if len(speeds) == 1:
        return lambda deadline: natural_modes(scene, speeds[0], modes, tolerance=tolerance).eigenvalue[None]
    return lambda deadline: frequency_locus(scene, speeds, modes, tolerance=tolerance).eigenvalue


# Error against time, including the model error ----------------------------------------------------


AS_GIVEN, ALL = "as given", "all of these"
_FUNCTIONS = (1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20)
_NOTHING = 1e-10  # relative change of the frequencies below which an effect is left out of the comparison
# Fraction of the model error below which more physics must reduce it to count as an improvement.
_BETTER = 0.5
_COMPARED = (STRETCH.name,)  # effects that are modelled only for comparison with papers


@dataclass(frozen=True)
class Choice:
    """One choice of physics, solved with numerical errors far below the model error.

    Parameters
    ----------
    name : str
        Names of the added effects.
    scene : Scene
        The scene with these effects.
    solution : EstimatedModes
        Modes of the scene at the speed.
    """

    name: str
    scene: Scene
    solution: EstimatedModes

    @property
    def frequency(self) -> np.ndarray:
        """Magnitudes of the eigenvalues [1/s], in ascending order."""
        return sizes_of_eigenvalues(self.solution.eigen.eigenvalue)[0]


@one_blas_thread()
def physics_diagram(scene: Scene, speed: float, modes: int = 3, budget: float = 10.0) -> Diagram:
    """Measure error, including the model error, against computing time of the natural frequencies.

    The reference has the largest set of effects that can be combined: those of straight beams, or large
    deflection and rotary inertia, whichever changes the frequencies more.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.
    speed : float
        Speed [rad/s].
    modes : int
        Number of the lowest modes of the given scene.
    budget : float
        Time for all measurements [s].

    Returns
    -------
    Diagram
    """
    given = _solve_choice(AS_GIVEN, scene, speed, modes)
    choices, skipped = _list_choices(scene, speed, modes, given)
    title = f"physics: {number_of(modes, 'frequency', 'frequencies')} at {speed:.6g} rad/s"
    what = "the frequency with the largest relative error, including the model error"
    if not choices:
        return Diagram.make(title, what, "", 0.0, (), skipped or ("no effect that can be added changes it",))
    full = choices[-1]
    true = pick(full.frequency, given.frequency[:modes])
    speeds, segments = np.array([speed]), count_segments(scene)
    families = [
        Family(
            c.name, _basis_settings(c.scene, speeds, _count(c.scene, modes), "legendre", _FUNCTIONS, segments)
        )
        for c in (given, *choices)
    ]
    resolved = float(full.solution.error.max())

    def error(found: np.ndarray) -> float:
        return float(np.abs(pick(sizes_of_eigenvalues(found)[0], true) / true - 1).max())

    measurements, left_out = measure_families(families, error, resolved, budget)
    of_model = float(np.abs(given.frequency[:modes] / true - 1).max())
    if min((m.error for m in measurements), default=inf) > _BETTER * of_model:
        said = f"{_names(choices)}: the budget does not suffice for enough functions; physics {AS_GIVEN} has "
        left_out = [f"{said}an error of {percent(of_model)} with any number of functions", *left_out]
    reference = f"{full.solution.model.discretization} with {_names(choices)}"
    return Diagram.make(title, what, reference, resolved, measurements, [*skipped, *left_out])


def pick(found: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Return the frequencies nearest to the requested ones, each used once."""
    return found[assign(np.abs(np.log(wanted[:, None] / found[None, :])))]


def _names(choices: list[Choice]) -> str:
    return choices[0].name if len(choices) == 1 else " and ".join(c.name for c in choices[:-1])


# Choices ------------------------------------------------------------------------------------------


def _list_choices(
    scene: Scene, speed: float, modes: int, given: Choice
) -> tuple[list[Choice], tuple[str, ...]]:
    """List choices of physics: effects one by one, then together; and why other effects are left out."""
    additions, missing, _ = list_effects(scene)
    scenes = {a.name: a.scene for a in additions if a.name not in _COMPARED}
    not_known = [f"{name}: {why}" for name, why in missing.items() if name not in _COMPARED]
    if not scene.physics.large_deflection and speed and bends(Model(scene, Ritz(12))):
        try:
            scenes[LARGE_DEFLECTION.name] = _with(scene, large_deflection=True)
        except InvalidValue as error:
            not_known.append(f"{LARGE_DEFLECTION.name}: {error}")

    def change(choice: Choice) -> float:
        """Compute the largest relative change of the frequencies by a choice of physics."""
        wanted = given.frequency[:modes]
        return float(np.abs(pick(choice.frequency, wanted) / wanted - 1).max())

    solved = [_solve_choice(name, added, speed, modes) for name, added in scenes.items()]
    alone = [c for c in solved if change(c) > _NOTHING]
    if not alone:
        return [], tuple(not_known)
    bent = [c for c in alone if c.name == LARGE_DEFLECTION.name]
    straight = [c for c in alone if c.name != LARGE_DEFLECTION.name]
    with_bent = [*bent, *(c for c in straight if _combined(scene, [*bent, c]) is not None)] if bent else []
    kept = max(with_bent, straight, key=lambda s: max(map(change, s), default=0.0))
    apart = [f"{c.name}: it cannot be combined with the others" for c in alone if c not in kept]
    together = _combined(scene, kept)
    assert together is not None
    everything = [_solve_choice(ALL, together, speed, modes)] if len(kept) > 1 else []
    return [*kept, *everything], (*not_known, *apart)


def _combined(scene: Scene, choices: list[Choice]) -> Scene | None:
    """Return the scene with all effects of several choices; None if no beam has the data for all."""
    added = {}
    for choice in choices:
        added |= {k: v for k, v in vars(choice.scene.physics).items() if v != getattr(scene.physics, k)}
    for beam in (scene.beam, *(c.scene.beam for c in choices)):
        with suppress(InvalidValue):
            return _with(replace(scene, beam=beam), **added)
    return None


def _with(scene: Scene, **physics: object) -> Scene:
    return replace(scene, physics=replace(scene.physics, **physics))  # pyright: ignore[reportArgumentType]


def _solve_choice(name: str, scene: Scene, speed: float, modes: int) -> Choice:
    return Choice(name, scene, solve_reference(scene, np.array([speed]), _count(scene, modes)))


def _count(scene: Scene, modes: int) -> int:
    """Return the number of lowest modes to compute in order to include the requested ones.

    Modes of a second plane of bending may be between them.
    """
    return 2 * modes + 2 if scene.physics.planes == 2 else modes
