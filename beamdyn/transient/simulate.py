"""Simulation of a transient, and the smallest modal basis with which it, or a whole sweep, meets a tolerance.

For a sweep, the numbers of modes that some sampled speeds need are determined.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from beamdyn.accuracy.refinement import refine
from beamdyn.common.inputs.checks import InvalidValue, ascending, positive, within
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.results.statements import announced
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.modal.model import FEWEST_MODES, ModalBasis, find_speed_range, given_basis
from beamdyn.modes.model_error.effect_choice import bend_for_peak, choose_for_motion
from beamdyn.modes.repeated import repeatable
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.transient.chunks import SweepRequest
from beamdyn.transient.step_size import TOLERANCES
from beamdyn.transient.trajectory import SAMPLES
from beamdyn.transient.transient import Transient, TransientRequest, warn_of_missed_modes

if TYPE_CHECKING:
    from scipy.integrate import OdeSolver

# "auto" adds further modes if the computing work of the run with them, its number of steps times its squared
# number of coordinates, is at most this number, which takes some seconds.
_MOST_WORK = 5e7
# The same limit if the modes that were added last divided the truncation error by less than _FAST.
_SLOW_WORK = 5e6
_FAST = 4.0
# One mode is added, instead of several, to at most the first number of modes if the truncation error is at
# most the second number times the tolerance.
_FEW_MODES, _NEARLY = 4, 30.0
_TIGHT = 1e-5  # tolerance that is tried too, if no basis meets a smaller requested tolerance


def run_smallest_basis(request: TransientRequest) -> Transient:
    """Integrate with the smallest basis that meets the tolerance, or else with the best basis found.

    The search starts with the modal basis of the request.
    """
    tolerance = request.tolerance
    run = _search(replace(request, method="auto", t_eval=None))
    if run.mode_error > tolerance and tolerance < _TIGHT:
        # A coarser time integration leaves computing work for more modes, which may reduce the total error.
        coarse = _search(replace(request, method="auto", t_eval=None, tolerance=_TIGHT))
        run = min(run, coarse, key=lambda each: each.time_error + each.mode_error * each.largest)
    missed = tuple(warn_of_missed_modes(run.mode_error, tolerance, str(run.request.basis)))
    as_requested = request.method == "auto" and request.t_eval is None
    run = run if as_requested else replace(request, basis=run.request.basis).run()
    return run.with_warnings(missed) if missed else run


def _search(request: TransientRequest) -> Transient:
    """Add modes until the truncation error meets the tolerance, or until the next run takes too much work."""
    run, tolerance = request.run(), request.tolerance
    if run.mode_error > tolerance and (finer := run.with_more_modes) is not None:
        # A sudden motion excites many modes: the same number of modes of the beam at rest may then be better.
        at_rest = replace(run.request, basis=ModalBasis(run.system.equations.modes)).run()
        if at_rest.distance_from_path(*finer) < run.distance_from_path(*finer):
            run = _refine_better(at_rest, run, tolerance)

    def larger(found: tuple[Transient, float]) -> tuple[Transient, float] | None:
        run, before = found
        few = (run.request.basis.modes or np.inf) <= _FEW_MODES  # with so few modes, one more may suffice
        nearly = few and run.mode_error <= _NEARLY * tolerance
        more = run.request.run_with_one_more() if nearly else run.refined
        most = _MOST_WORK if run.mode_error * _FAST < before else _SLOW_WORK
        if more is None or len(more.path.samples[0]) / SAMPLES * more.system.size**2 > most:
            return None
        return None if more.with_more_modes is None else (more, run.mode_error)

    return refine((run, np.inf), larger, lambda found: not found[0].mode_error > tolerance)[0]


def _refine_better(at_rest: Transient, at_speeds: Transient, tolerance: float) -> Transient:
    """Return the run with modes at rest if it nearly meets the tolerance, else the better refined run.

    Both runs are refined before their comparison, as few modes show little about convergence.
    """
    if at_rest.mode_error <= _NEARLY * tolerance:
        return at_rest
    refined = [run for run in (at_rest.refined, at_speeds.refined) if run is not None]
    return min(refined, key=lambda run: run.mode_error, default=at_rest)


# Bases for sweeps -----------------------------------------------------------------------------------


def first_basis(request: SweepRequest, speeds: tuple[float, ...]) -> ModalBasis:
    """Choose the first modal basis: modes at the slowest and at the fastest speed of all cases."""
    return ModalBasis(FEWEST_MODES, tuple(end_speeds(request, speeds).tolist()))


def end_speeds(request: SweepRequest, speeds: tuple[float, ...]) -> np.ndarray:
    """Return the slowest and the fastest speed of all cases [rad/s]; one speed if they are equal."""
    ends = [
        find_speed_range(motion, request.t_end) for motion in map(request.motion, (speeds[0], speeds[-1]))
    ]
    return np.unique([ends[0][0], ends[1][-1]])


def list_samples(speeds: tuple[float, ...]) -> list[float]:
    """List speeds [rad/s] at which `mode_error` is estimated: lowest above 0, highest, and some between."""
    slowest = min(1, len(speeds) - 1) if speeds[0] == 0 else 0
    return sorted({speeds[max(slowest, k * (len(speeds) - 1) // 4)] for k in range(5)})


@one_blas_thread()
def run_samples(request: SweepRequest, speeds: tuple[float, ...]) -> list[Transient]:
    """Run sampled cases with enough modes; each search starts with one mode fewer than the last case has.

    If some cases use modes at their speeds and others modes at rest, all are run with one kind: modes at rest
    if these meet the tolerance with fewer coordinates, else modes at the speeds if these meet it, else the
    kind with the smaller error.
    """
    samples, basis = [], request.basis
    for speed in list_samples(speeds):
        samples.append(run_smallest_basis(replace(request, basis=basis).transient_request(speed)))
        needed = samples[-1].request.basis
        if needed.is_at_rest == basis.is_at_rest:
            basis = replace(basis, modes=max(FEWEST_MODES, (needed.modes or 0) - 1))
    if len({run.request.basis.is_at_rest for run in samples}) == 1:
        return samples
    most, tried, found = _most_modes(samples), [], list_samples(speeds)
    for each in (ModalBasis(most), replace(request.basis, modes=most)):
        runs, trial = [], replace(request, basis=each)
        for speed, run in zip(found, samples, strict=True):
            asked = replace(run.request, basis=trial.basis_at(speed), tolerance=request.tolerance)
            same = (run.request.basis, run.request.tolerance) == (asked.basis, asked.tolerance)
            runs.append(run if same else asked.run())
        tried.append(runs)
        if largest_mode_error(runs) <= request.tolerance:
            break
    return min(tried, key=largest_mode_error)


def with_basis_of(request: SweepRequest, speeds: tuple[float, ...], runs: list[Transient]) -> SweepRequest:
    """Return the request with the modal bases that its sampled cases need."""
    at_rest = runs[0].request.basis.is_at_rest
    basis = ModalBasis(_most_modes(runs), (0.0,) if at_rest else request.basis.speeds)
    modes = [run.request.basis.modes or 0 for run in runs]
    return replace(request, basis=basis, modes_at=tuple(zip(list_samples(speeds), modes, strict=True)))


def _most_modes(runs: Sequence[Transient]) -> int:
    """Return the largest number of modes of some runs."""
    return max(run.request.basis.modes or 0 for run in runs)


def largest_mode_error(runs: Iterable[Transient]) -> float:
    """Return the runs' largest modal truncation error, relative to each run's largest deflection."""
    return max((run.mode_error for run in runs), default=0.0)


# Simulation --------------------------------------------------------------------------------------------


@announced
@repeatable
@one_blas_thread()  # with small matrices, further threads only slow each other down
def simulate(
    scene: Scene,
    t_end: float,
    modes: int | str | None = "auto",
    tolerance: float = 1e-5,
    method: str | type[OdeSolver] = "auto",
    discretization: DiscretizationChoice = "ritz",
    initial: str | np.ndarray = "rest",
    t_eval: np.ndarray | Sequence[float] | None = None,
    **options: Any,
) -> Transient:
    """Integrate the motion of the beam from time 0 to `t_end` in modal coordinates.

    Parameters
    ----------
    scene : Scene
        The scene, with a motion.
    t_end : float
        End of the run [s].
    modes : int, "auto" or None
        Number of modes at rest of each uncoupled displacement (such as bending in each plane).  "auto" takes
        modes at the slowest and at the fastest speed: the smallest modal basis whose truncation error meets
        the tolerance.  The search stops earlier, with a warning, if the next basis would take minutes: if the
        number of steps times the squared number of coordinates exceeds 5e7, or 5e6 if the last added modes
        reduced the error by less than a factor of four.  None keeps all functions of the discretization.
    tolerance : float
        Target of the time-integration error, and with ``modes="auto"`` also of the modal truncation error,
        each relative to the largest tip deflection.  An error that exceeds it is named in `warnings`.  If no
        affordable basis meets a tolerance below 1e-5, the run with tolerance 1e-5 is returned if its total
        error is smaller.
    method : {"auto", "RK45", "DOP853", "Radau", "BDF", "LSODA", ...} or OdeSolver
        "auto": Gauss collocation with a step size from the tolerance; or any method of `solve_ivp`.
    discretization : {"ritz", "fem"} or Discretization
        Discretization from which the modes are computed.
    initial : {"rest", "equilibrium"} or ndarray, shape (2 m,)
        "rest": undeflected, without velocity; "equilibrium": in static equilibrium with the loads at time
        0; or coordinates and velocities.
    t_eval : sequence of float, optional
        Times of the result [s]; by default eight per step.
    **options
        Options of a method of `solve_ivp`, such as max_step; rtol is `tolerance` by default, and atol a
        tenth of it, times the largest magnitude of each coordinate.

    Returns
    -------
    Transient

    Raises
    ------
    ValueError
        If an argument is out of its range, the motion passes the critical speed, or the run takes more
        steps than fit into memory (three million, fewer with more than five coordinates).
    TypeError
        If there are options without a method of `solve_ivp` that takes them.
    ArithmeticError
        If the motion grows without bound.

    References
    ----------
    Lee and Yoo (2019), eq. (14), corrected; integrated as Hairer, Lubich and Wanner (2006), Geometric
    Numerical Integration, sections II.1.3 and IV.2.1.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> wheel = bd.RollingWheel(0.3, bd.SpinUp(55.0, duration=1.0), bd.RoadWave(0.3, velocity_amplitude=0.01))
    >>> run = bd.simulate(bd.Scene(strip, bd.Mount(radius=0.215), wheel), t_end=2.0, modes=2)
    >>> round(1e3 * run.peak(1.0, 2.0), 1)  # mm
    0.8
    """
    check_scene(scene)
    if not (isinstance(method, str) and method == "auto"):
        from beamdyn.transient.scipy_integrators import check_method

        check_method(method)
    t_end, tolerance = positive("t_end", t_end, "s"), within("tolerance", tolerance, *TOLERANCES)
    if scene.motion is None:
        raise InvalidValue("scene.motion", None, "a transient needs a motion", "such as SteadyRotation(50.0)")
    if method == "auto" and options:
        raise TypeError(
            f"simulate has no option {' or '.join(options)}; options such as max_step belong to a method of "
            'solve_ivp, such as method="RK45"'
        )
    times = None if t_eval is None else ascending("t_eval", t_eval)
    if times is not None and (times[0] < 0 or times[-1] > t_end):
        within_run = f"times must lie in the run, 0 ... {t_end:g} s"
        raise ValueError(f"t_eval = {times[0]:g} ... {times[-1]:g} s: {within_run}")
    basis = ModalBasis(None) if modes is None else given_basis(modes)
    if basis is None and not isinstance(initial, str):
        raise ValueError('initial is an array: give the number of its modes, not modes = "auto"')
    speeds = find_speed_range(scene.motion, t_end)
    smallest = basis or ModalBasis(FEWEST_MODES, speeds)
    scene = choose_for_motion(scene, np.array(speeds), basis and basis.modes, tolerance)
    request = TransientRequest(
        scene, t_end, tolerance, method, discretization, initial, times, options, smallest
    )
    run = request.run() if basis else run_smallest_basis(request)
    if (bent := bend_for_peak(scene, run.largest)) is None:
        return run
    request = replace(request, scene=bent)
    return request.run() if basis else run_smallest_basis(request)
