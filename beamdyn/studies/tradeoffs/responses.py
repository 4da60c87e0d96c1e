"""Work-precision diagrams of transients, over integrators and modes, and of the steady response."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from time import perf_counter
from typing import Any

import numpy as np

from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.equations.discretization import Discretization
from beamdyn.modes.modal.discretization_choice import choose_model
from beamdyn.modes.modal.model import ModalBasis, find_speed_range
from beamdyn.scene.scene import Scene
from beamdyn.steady.response import SteadyResponse, steady_response
from beamdyn.studies.tradeoffs.measurements import (
    Diagram,
    Family,
    TimedCase,
    at_speeds,
    measure_families,
    number_of,
    remaining_budget,
)
from beamdyn.transient.simulate import simulate
from beamdyn.transient.transient import Transient, TransientRequest

OURS = "Gauss collocation"
STOCK = ("RK45", "DOP853", "Radau", "BDF", "LSODA")
_TOLERANCES = tuple(10.0**-k for k in range(1, 11))
_STOCK_TOLERANCES = tuple(10.0**-k for k in range(2, 10))
_TIGHTEST = 1e-11  # tolerance of the reference
_CHECK_RTOL = 1e-11  # relative tolerance of DOP853, which checks the reference
_CHECKED_PART = 0.05  # fraction of the reference's run, from its start, that is compared with DOP853
_CHECK_SHARE = 0.15  # largest fraction of the budget for the comparison with DOP853
_INSTANTS = 20_001  # number of times at which tip deflections are compared
AT_REST, AT_ENDS = "modes at rest", "modes at the slowest and the fastest speed"
_MODES = tuple(range(1, 11))
_MODES_AT_ENDS = (1, 2, 3, 4, 6)
_ALL_MODES = 8  # number of modes of the reference at the slowest speed, and at the fastest
_MODES_TOLERANCE = 1e-7
_ERROR_OF = f"the tip deflection: the largest at {_INSTANTS} times, relative to the largest deflection"
_TIGHT = f"{OURS} with a tolerance of {_TIGHTEST:g}"
_STILL = "nothing moves the beam"


@one_blas_thread()
def integrators_diagram(scene: Scene, t_end: float, modes: int = 3, budget: float = 30.0) -> Diagram:
    """Measure error against time of Gauss collocation and the methods of `solve_ivp`, over tolerances.

    All integrate the same modal equations through `simulate`, with a general right-hand side.  The methods of
    `solve_ivp` would be faster with a right-hand side written for a particular scene.

    Parameters
    ----------
    scene : Scene
        The scene, with a motion.
    t_end : float
        End of the run [s].
    modes : int
        Number of modes.
    budget : float
        Time for all measurements [s].

    Returns
    -------
    Diagram
    """
    start = perf_counter()
    basis = choose_model(scene, "ritz", np.zeros(1), modes).discretization
    title = f"transient of {t_end:g} s, {number_of(modes, 'mode', 'modes')}"
    exact = simulate(scene, t_end, modes, _TIGHTEST, discretization=basis)
    if not exact.largest:
        return Diagram.make(title, _ERROR_OF, _TIGHT, 0.0, (), (_STILL,))
    check = _check_by_dop853(scene, exact, modes, basis, _CHECK_SHARE * budget)
    families = list(_integrators(scene, t_end, modes, basis))
    left = remaining_budget(budget, start)
    error, resolved = _tip_error(exact, t_end), _relative(exact.time_error, exact.largest)
    measurements, skipped = measure_families(families, error, resolved, left)
    return Diagram.make(title, _ERROR_OF, f"{_TIGHT}; {check}", resolved, measurements, skipped)


@one_blas_thread()
def transient_modes_diagram(scene: Scene, t_end: float, budget: float = 5.0) -> Diagram:
    """Measure error against computing time of a transient, for increasing numbers of modes.

    One curve uses modes at rest, the other modes at the slowest and at the fastest speed of the run.

    Parameters
    ----------
    scene : Scene
        The scene, with a motion.
    t_end : float
        End of the run [s].
    budget : float
        Time for all measurements [s].

    Returns
    -------
    Diagram
    """
    start = perf_counter()
    assert scene.motion is not None
    functions = choose_model(scene, "ritz", np.zeros(1), 2 * _ALL_MODES).discretization
    ends = find_speed_range(scene.motion, t_end)

    def run(modal: ModalBasis) -> Transient:
        request = TransientRequest(scene, t_end, _MODES_TOLERANCE, "auto", functions, "rest", None, {}, modal)
        return request.run()

    def family(name: str, speeds: tuple[float, ...], sizes: Sequence[int]) -> Family:
        cases = (TimedCase(f"modes={m}", m, lambda deadline, m=m: run(ModalBasis(m, speeds))) for m in sizes)
        return Family(name, tuple(cases))

    title = f"transient of {t_end:g} s, number of modes"
    exact = run(ModalBasis(_ALL_MODES, ends))
    reference = f"{exact.request.basis}, all with a time-integration tolerance of {_MODES_TOLERANCE:g}"
    if not exact.largest:
        return Diagram.make(title, _ERROR_OF, reference, 0.0, (), (_STILL,))
    resolved = _relative(exact.time_error, exact.largest)
    families = [family(AT_REST, (0.0,), _MODES), family(AT_ENDS, ends, _MODES_AT_ENDS)]
    measurements, skipped = measure_families(
        families, _tip_error(exact, t_end), resolved, remaining_budget(budget, start)
    )
    return Diagram.make(title, _ERROR_OF, reference, resolved, measurements, skipped)


def _tip_error(exact: Transient, t_end: float) -> Callable[[Transient], float]:
    """Return a function that computes the error of a run, relative to the largest tip deflection.

    It is the largest difference between tip deflections of the run and of the reference at common times.
    """
    t = np.linspace(0, t_end, _INSTANTS)
    true = exact.deflection(t)
    return lambda run: _relative(float(np.abs(run.deflection(t) - true).max()), exact.largest)


def _relative(difference: float, largest: float) -> float:
    """Divide a difference by the largest deflection, unless that is 0."""
    return difference / largest if largest else difference


def _check_by_dop853(scene: Scene, exact: Transient, modes: int, basis: Discretization, limit: float) -> str:
    """Compare the reference with DOP853 on the first part of the run, and describe the outcome."""
    end = _CHECKED_PART * exact.path.end
    options = {"discretization": basis, "events": _stop_after(perf_counter() + limit)}
    try:
        other = simulate(scene, end, modes, _CHECK_RTOL, "DOP853", **options)
    except TimeoutError:
        return f"not checked by DOP853, which took more than {limit:.2g} s for the first {end:.3g} s"
    t = np.linspace(0, end, 1001)
    difference = np.abs(other.deflection(t) - exact.deflection(t)).max()
    differs = _relative(float(difference), other.largest)
    return f"DOP853 with rtol {_CHECK_RTOL:g} differs by {differs:.1e} up to {end:.3g} s"


def _integrators(scene: Scene, t_end: float, modes: int, basis: Discretization) -> Iterator[Family]:
    """Yield the families of integrators, over their tolerances."""

    def ours(tolerance: float) -> Callable[[float], Any]:
        return lambda deadline: simulate(scene, t_end, modes, tolerance, discretization=basis)

    def stock(method: str, rtol: float) -> Callable[[float], Any]:
        def run(deadline: float) -> Transient:
            # Divergence is measured as an error, so no warning is needed.
            with np.errstate(over="ignore", invalid="ignore"):
                options = {"discretization": basis, "events": _stop_after(deadline)}
                return simulate(scene, t_end, modes, rtol, method, **options)

        return run

    yield Family(OURS, tuple(TimedCase(f"tolerance={t:.0e}", t, ours(t)) for t in _TOLERANCES))
    for method in STOCK:
        cases = (TimedCase(f"rtol={t:.0e}", t, stock(method, t)) for t in _STOCK_TOLERANCES)
        yield Family(f"solve_ivp {method}", tuple(cases))


def _stop_after(deadline: float) -> Callable[[float, np.ndarray], float]:
    """Build an event for `solve_ivp` that never occurs, but raises TimeoutError after a deadline."""

    def event(t: float, y: np.ndarray) -> float:
        if perf_counter() > deadline:
            raise TimeoutError(f"at t = {t:.3g} s")
        return 1.0

    return event


# Work-precision of the steady response ------------------------------------------------------------


_HARMONICS = tuple(range(6))
_ALL_HARMONICS = 6  # number of harmonics of the reference
_STEADY_MODES = tuple(range(1, 9))
_ALL_STEADY_MODES = 12  # number of modes of the reference
_PHASES = 24  # number of values of each phase angle at which tip deflections are compared
_ERROR_OF_STEADY = "the tip deflection: the largest over phases and speeds, relative to the sum of the lines"
_EPS = float(np.finfo(float).eps)


@one_blas_thread()
def harmonics_diagram(scene: Scene, speeds: np.ndarray, modes: int = 3, budget: float = 5.0) -> Diagram:
    """Measure error against time of the steady response over the number `harmonics` of `steady_response`.

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
    solve = partial(steady_response, scene, speeds, modes)
    return _diagram("harmonics", speeds, solve, _HARMONICS, _ALL_HARMONICS, budget)


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
    solve = partial(steady_response, scene, speeds, harmonics=2)
    return _diagram("modes", speeds, solve, _STEADY_MODES, _ALL_STEADY_MODES, budget)


def _diagram(
    what: str,
    speeds: np.ndarray,
    run: Callable[[int], SteadyResponse],
    sizes: tuple[int, ...],
    most: int,
    budget: float,
) -> Diagram:
    """Measure steady responses of several `sizes` against a reference of size `most`."""
    start = perf_counter()
    exact = run(most)
    title = f"steady response {at_speeds(speeds)}, number of {what}"
    if not np.nanmax(exact.bound, initial=0.0):
        return Diagram.make(title, _ERROR_OF_STEADY, f"{what}={most}", 0.0, (), ("no load excites the beam",))
    cases = tuple(TimedCase(f"{what}={n}", n, lambda deadline, n=n: run(n)) for n in sizes)
    resolved = 10 * _EPS if what == "modes" else float(np.nanmax(exact.error, initial=10 * _EPS))
    left = remaining_budget(budget, start)
    # Largest difference of tip deflections over all phases, relative to the bound of the deflection.
    phase = 2 * np.pi * np.arange(_PHASES) / _PHASES
    rotation, road = np.meshgrid(phase, phase)
    true = [exact.tip(rotation, road, direction) for direction in (0, 1)]

    def error(response: SteadyResponse) -> float:
        both = exact.stable & response.stable & (exact.bound > 0)
        along, across = (response.tip(rotation, road, i) - tip for i, tip in enumerate(true))
        difference = np.hypot(along, across).max(axis=(1, 2))
        return float((difference[both] / exact.bound[both]).max(initial=0.0))

    measurements, skipped = measure_families([Family(what, cases)], error, resolved, left)
    if not exact.stable.all():
        of_all = number_of(len(speeds), "speed", "speeds")
        skipped.append(f"{(~exact.stable).sum()} of {of_all} without a steady response")
    return Diagram.make(title, _ERROR_OF_STEADY, f"{what}={most}", resolved, measurements, skipped)
