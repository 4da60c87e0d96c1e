"""Work-precision of the steady response: number of harmonics, and number of modes."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

import numpy as np

from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.scene.scene import Scene
from beamdyn.steady.response import SteadyResponse, steady_response
from beamdyn.studies.tradeoffs.measurements import Diagram
from beamdyn.studies.tradeoffs.timing import Family, Setting, measure_families, remaining_budget

_HARMONICS = tuple(range(6))
_ALL_HARMONICS = 6  # of the reference
_MODES = tuple(range(1, 9))
_ALL_MODES = 12  # of the reference
_PHASES = 24  # samples of each phase, at which tip deflections are compared
_ERROR_OF = "the tip deflection, largest over phases and speeds, over the sum of the lines"
_EPS = float(np.finfo(float).eps)


@one_blas_thread()
def harmonics_diagram(scene: Scene, speeds: np.ndarray, modes: int = 3, budget: float = 5.0) -> Diagram:
    """Measure error against time of the steady response over the number of interactions.

    Parameters
    ----------
    scene : Scene
        The scene, with a motion whose steady state is known.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].
    modes : int
        Number of modes.
    budget : float
        Time for all measurements [s].

    Returns
    -------
    Diagram
    """
    return _diagram(
        "harmonics",
        speeds,
        lambda h: steady_response(scene, speeds, modes, harmonics=h),
        _HARMONICS,
        _ALL_HARMONICS,
        budget,
    )


@one_blas_thread()
def steady_modes_diagram(scene: Scene, speeds: np.ndarray, budget: float = 5.0) -> Diagram:
    """Measure error against time of the steady response over the number of modes.

    Parameters
    ----------
    scene : Scene
        The scene, with a motion whose steady state is known.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].
    budget : float
        Time for all measurements [s].

    Returns
    -------
    Diagram
    """
    return _diagram(
        "modes", speeds, lambda m: steady_response(scene, speeds, m, harmonics=2), _MODES, _ALL_MODES, budget
    )


def _diagram(
    what: str,
    speeds: np.ndarray,
    run: Callable[[int], SteadyResponse],
    sizes: tuple[int, ...],
    most: int,
    budget: float,
) -> Diagram:
    """Measure responses of several `sizes` against a reference, that of size `most`."""
    start = perf_counter()
    exact = run(most)
    title = f"steady response at {len(speeds)} speeds to {speeds[-1]:.6g} rad/s, number of {what}"
    if not np.nanmax(exact.bound, initial=0.0):
        return Diagram.make(title, _ERROR_OF, f"{what}={most}", 0.0, (), ("no load excites the beam",))
    cases = tuple(Setting(f"{what}={n}", n, lambda deadline, n=n: run(n)) for n in sizes)
    resolved = 10 * _EPS if what == "modes" else float(np.nanmax(exact.error, initial=10 * _EPS))
    left = remaining_budget(budget, start)
    measurements, skipped = measure_families([Family(what, cases)], _error(exact), resolved, left)
    if not exact.stable.all():
        skipped.append(f"{(~exact.stable).sum()} of {len(speeds)} speeds, which have no steady response")
    return Diagram.make(title, _ERROR_OF, f"{what}={most}", resolved, measurements, skipped)


def _error(exact: SteadyResponse) -> Callable[[SteadyResponse], float]:
    """Error measure: largest difference of the tip over the phases, over the bound, where both are stable."""
    phase = 2 * np.pi * np.arange(_PHASES) / _PHASES
    rotation, road = np.meshgrid(phase, phase)
    true = [exact.tip(rotation, road, direction) for direction in (0, 1)]

    def error(response: SteadyResponse) -> float:
        both = exact.stable & response.stable & (exact.bound > 0)
        along, across = (response.tip(rotation, road, i) - tip for i, tip in enumerate(true))
        difference = np.hypot(along, across).max(axis=(1, 2))
        return float((difference[both] / exact.bound[both]).max(initial=0.0))

    return error
