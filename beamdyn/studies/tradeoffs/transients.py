"""Work-precision of transients: integrators over their tolerance, and the number of modes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from time import perf_counter
from typing import Any

import numpy as np

from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.equations.discretization import Discretization
from beamdyn.modes.modal.discretization_choice import choose_model
from beamdyn.modes.modal.modal_basis import ModalBasis, find_speed_range
from beamdyn.scene.scene import Scene
from beamdyn.studies.tradeoffs.measurements import Diagram, number_of
from beamdyn.studies.tradeoffs.timing import Family, Setting, measure_families, remaining_budget
from beamdyn.transient.simulate import simulate
from beamdyn.transient.transient import Transient, TransientRequest

OURS = "Gauss collocation"
STOCK = ("RK45", "DOP853", "Radau", "BDF", "LSODA")
_TOLERANCES = tuple(10.0**-k for k in range(1, 11))
_STOCK_TOLERANCES = tuple(10.0**-k for k in range(2, 10))
_TIGHTEST = 1e-11  # tolerance of the reference
_CHECK_RTOL = 1e-11  # of DOP853, which checks the reference
_CHECKED_PART = 0.05  # of the run, from its start
_CHECK_SHARE = 0.15  # of the budget
_INSTANTS = 20_001  # times at which tip deflections are compared
AT_REST, AT_ENDS = "modes at rest", "modes at the slowest and the fastest speed"
_MODES = tuple(range(1, 11))
_MODES_AT_ENDS = (1, 2, 3, 4, 6)
_ALL_MODES = 8  # of the reference, at each of two speeds
_MODES_TOLERANCE = 1e-7
_ERROR_OF = f"the tip deflection, largest at {_INSTANTS} times, over the largest deflection"
_TIGHT = f"{OURS} with a tolerance of {_TIGHTEST:g}"
_STILL = "nothing moves the beam"


@one_blas_thread()
def integrators_diagram(scene: Scene, t_end: float, modes: int = 3, budget: float = 30.0) -> Diagram:
    """Measure error against time of Gauss collocation and the methods of `solve_ivp`, over tolerances.

    All integrate the same modal equations through `simulate`, whose right-hand side serves any scene: one
    written by hand for a scene would be faster with the methods of `solve_ivp`.

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
    """Measure error against time of a transient over the number of modes, at rest or at two speeds.

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
        return Diagram.make(title, _ERROR_OF, reference, 0.0, (), (_STILL,))
    resolved = _relative(exact.time_error, exact.largest)
    families = [family(AT_REST, (0.0,), _MODES), family(AT_ENDS, ends, _MODES_AT_ENDS)]
    measurements, skipped = measure_families(
        families, _tip_error(exact, t_end), resolved, remaining_budget(budget, start)
    )
    return Diagram.make(title, _ERROR_OF, reference, resolved, measurements, skipped)


def _tip_error(exact: Transient, t_end: float) -> Callable[[Transient], float]:
    """Error measure: largest difference of the tip deflection at common times, over the largest."""
    t = np.linspace(0, t_end, _INSTANTS)
    true = exact.deflection(t)
    return lambda run: _relative(float(np.abs(run.deflection(t) - true).max()), exact.largest)


def _relative(difference: float, largest: float) -> float:
    """Difference over the largest deflection; absolute where that is 0."""
    return difference / largest if largest else difference


def _check_by_dop853(scene: Scene, exact: Transient, modes: int, basis: Discretization, limit: float) -> str:
    """Compare the reference with DOP853 at a tight tolerance on the first part of the run, in words."""
    end = _CHECKED_PART * exact.path.end
    options = {"discretization": basis, "events": _stop_after(perf_counter() + limit)}
    try:
        other = simulate(scene, end, modes, _CHECK_RTOL, "DOP853", **options)
    except TimeoutError:
        return f"not checked by DOP853, which took more than {limit:.2g} s for the first {end:.3g} s"
    t = np.linspace(0, end, 1001)
    difference = np.abs(other.deflection(t) - exact.deflection(t)).max()
    differs = _relative(float(difference), other.largest)
    return f"DOP853 with rtol {_CHECK_RTOL:g} differs by {differs:.1e} to {end:.3g} s"


def _integrators(scene: Scene, t_end: float, modes: int, basis: Discretization) -> Iterator[Family]:
    """Families of the integrators, over their tolerances."""

    def ours(tolerance: float) -> Callable[[float], Any]:
        return lambda deadline: simulate(scene, t_end, modes, tolerance, discretization=basis)

    def stock(method: str, rtol: float) -> Callable[[float], Any]:
        def run(deadline: float) -> Transient:
            with np.errstate(over="ignore", invalid="ignore"):  # divergence is measured as error
                options = {"discretization": basis, "events": _stop_after(deadline)}
                return simulate(scene, t_end, modes, rtol, method, **options)

        return run

    yield Family(OURS, tuple(Setting(f"tolerance={t:.0e}", t, ours(t)) for t in _TOLERANCES))
    for method in STOCK:
        cases = (Setting(f"rtol={t:.0e}", t, stock(method, t)) for t in _STOCK_TOLERANCES)
        yield Family(f"solve_ivp {method}", tuple(cases))


def _stop_after(deadline: float) -> Callable[[float, np.ndarray], float]:
    """Event for `solve_ivp` that never occurs, but raises a TimeoutError once the deadline has passed."""

    def event(t: float, y: np.ndarray) -> float:
        if perf_counter() > deadline:
            raise TimeoutError(f"at t = {t:.3g} s")
        return 1.0

    return event
