"""Transients: integrators over their tolerance, and the number of modes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from time import perf_counter
from typing import Any

import numpy as np

from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.equations.discretization import Discretization
from beamdyn.modal.choice import choose_model
from beamdyn.modal.modal_basis import ModalBasis, find_speed_range
from beamdyn.scene.scene import Scene
from beamdyn.tradeoffs.measurements import Diagram, counted
from beamdyn.tradeoffs.timing import Family, Setting, measure_families, remaining_budget
from beamdyn.transient.simulate import Transient, TransientRequest, simulate

OURS = "Gauss collocation"
STOCK = ("RK45", "DOP853", "Radau", "BDF", "LSODA")
_TOLERANCES = tuple(10.0**-k for k in range(1, 11))
_STOCK_TOLERANCES = tuple(10.0**-k for k in range(2, 10))
_TIGHTEST = 1e-11
_SECOND = 1e-11  # rtol of the second route
_PART = 0.05  # of the run that the second route follows
_SECOND_SHARE = 0.15  # of the budget
_INSTANTS = 20_001
AT_REST, AT_ENDS = "modes at rest", "modes at the slowest and the fastest speed"
_MODES = tuple(range(1, 11))
_MODES_AT_ENDS = (1, 2, 3, 4, 6)
_ALL_MODES = 8  # at each of two speeds
_MODES_TOLERANCE = 1e-7
_ERROR_OF = f"the tip deflection, largest at {_INSTANTS} times, over the largest deflection"
_TIGHT = f"{OURS} with a tolerance of {_TIGHTEST:g}"
_STILL = "nothing moves the beam"


@one_blas_thread()
def integrators_diagram(scene: Scene, t_end: float, modes: int = 3, budget: float = 30.0) -> Diagram:
    """Error against time of our integrator and the stock ones, over their tolerances.

    All integrate the same equations, in the same modes of the same basis, through `simulate`, whose
    right-hand side serves any scene: one written by hand for a scene would speed the stock methods up.

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
    title = f"transient of {t_end:g} s, {counted(modes, 'mode', 'modes')}"
    exact = simulate(scene, t_end, modes, _TIGHTEST, discretization=basis)
    if not exact.largest:
        return Diagram.of(title, _ERROR_OF, _TIGHT, 0.0, (), (_STILL,))
    second = _second_route(scene, exact, modes, basis, _SECOND_SHARE * budget)
    families = list(_integrators(scene, t_end, modes, basis))
    left = remaining_budget(budget, start)
    error, resolved = _tip_error(exact, t_end), _relative(exact.time_error, exact.largest)
    measurements, skipped = measure_families(families, error, resolved, left)
    return Diagram.of(title, _ERROR_OF, f"{_TIGHT}; {second}", resolved, measurements, skipped)


@one_blas_thread()
def transient_modes_diagram(scene: Scene, t_end: float, budget: float = 5.0) -> Diagram:
    """Error against time of a transient over the number of modes: at rest, or at two speeds.

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
        cases = (Setting(f"modes={m}", m, lambda deadline, m=m: run(ModalBasis(m, speeds))) for m in sizes)
        return Family(name, tuple(cases))

    title = f"transient of {t_end:g} s, number of modes"
    exact = run(ModalBasis(_ALL_MODES, ends))
    reference = f"{exact.request.basis}, all with a time-integration tolerance of {_MODES_TOLERANCE:g}"
    if not exact.largest:
        return Diagram.of(title, _ERROR_OF, reference, 0.0, (), (_STILL,))
    resolved = _relative(exact.time_error, exact.largest)
    families = [family(AT_REST, (0.0,), _MODES), family(AT_ENDS, ends, _MODES_AT_ENDS)]
    measurements, skipped = measure_families(
        families, _tip_error(exact, t_end), resolved, remaining_budget(budget, start)
    )
    return Diagram.of(title, _ERROR_OF, reference, resolved, measurements, skipped)


def _tip_error(exact: Transient, t_end: float) -> Callable[[Transient], float]:
    """Largest difference of the tip deflection at common times, relative to the largest deflection."""
    t = np.linspace(0, t_end, _INSTANTS)
    true = exact.deflection(t)
    return lambda run: _relative(float(np.abs(run.deflection(t) - true).max()), exact.largest)


def _relative(difference: float, largest: float) -> float:
    return difference / largest if largest else difference


def _second_route(scene: Scene, exact: Transient, modes: int, basis: Discretization, limit: float) -> str:
    """How far DOP853 at a tight tolerance is from the reference on the first part of the run."""
    end = _PART * exact.path.end
    options = {"discretization": basis, "events": _until(perf_counter() + limit)}
    try:
        other = simulate(scene, end, modes, _SECOND, "DOP853", **options)
    except TimeoutError:
        return f"no second route: DOP853 took more than {limit:.2g} s for the first {end:.3g} s"
    t = np.linspace(0, end, 1001)
    away = np.abs(other.deflection(t) - exact.deflection(t)).max()
    return (
        f"DOP853 with rtol {_SECOND:g} differs by {_relative(float(away), other.largest):.1e} to {end:.3g} s"
    )


def _integrators(scene: Scene, t_end: float, modes: int, basis: Discretization) -> Iterator[Family]:
    def ours(tolerance: float) -> Callable[[float], Any]:
        return lambda deadline: simulate(scene, t_end, modes, tolerance, discretization=basis)

    def stock(method: str, rtol: float) -> Callable[[float], Any]:
        def run(deadline: float) -> Transient:
            with np.errstate(over="ignore", invalid="ignore"):  # some diverge: that is their error
                options = {"discretization": basis, "events": _until(deadline)}
                return simulate(scene, t_end, modes, rtol, method, **options)

        return run

    yield Family(OURS, tuple(Setting(f"tolerance={t:.0e}", t, ours(t)) for t in _TOLERANCES))
    for method in STOCK:
        cases = (Setting(f"rtol={t:.0e}", t, stock(method, t)) for t in _STOCK_TOLERANCES)
        yield Family(f"solve_ivp {method}", tuple(cases))


def _until(deadline: float) -> Callable[[float, np.ndarray], float]:
    """An event that never comes, but gives up after each step that ends past the deadline."""

    def event(t: float, y: np.ndarray) -> float:
        if perf_counter() > deadline:
            raise TimeoutError(f"at t = {t:.3g} s")
        return 1.0

    return event
