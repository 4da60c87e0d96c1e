"""Sweep over speeds: largest deflections in transients, computed in parallel, resumable, reproducible."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import takewhile
from pathlib import Path
from threading import Event
from time import perf_counter
from typing import Any, ClassVar

import numpy as np
import scipy

from beamdyn._version import __version__
from beamdyn.common.inputs import checks
from beamdyn.common.parallel.tasks import Progress, RunInterrupted, Task, TaskRunner
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.plots.plots import plot_sweep
from beamdyn.common.results.one_line import counted, error_at_most, states, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import NO_ANSWER, TOLERANCE, Statement, announced, unannounced
from beamdyn.common.words import supported
from beamdyn.equations.effects import modelled_directions
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.modal.model import SPEED_SAMPLES, given_basis
from beamdyn.modes.model_error.effect_choice import choose_for_motion, warn_of_peak
from beamdyn.modes.model_error.left_out_changes import LOADED, nothing_known
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, StatesModelError
from beamdyn.scene.motion.base import check_picklable
from beamdyn.scene.scene import Scene, SceneResult, check_scene
from beamdyn.scene.validity import list_speeds, warn_of_deflection, warn_of_left_out, warn_of_road
from beamdyn.transient.chunks import DONE, CaseResult, SweepRequest, solve_chunk
from beamdyn.transient.left_out_of_transient import left_out_of_transient
from beamdyn.transient.simulate import (
    end_speeds,
    first_basis,
    largest_mode_error,
    list_samples,
    run_samples,
    simulate,
    with_basis_of,
)
from beamdyn.transient.step_size import TOLERANCES
from beamdyn.transient.transient import Transient, warn_of_missed_modes

_DIGITS = 4  # largest number of significant digits in the one-line summary
_KIND = "beamdyn sweep"
# Versions that affect the last bits of stored results.
_VERSIONS = (__version__, np.__version__, scipy.__version__)


class SweepInterrupted(RunInterrupted):
    """Raised when the executor fails before all cases are computed.

    Examples
    --------
    >>> stopped = bd.SweepInterrupted(done=3, total=10, stored=True)
    >>> stopped.done, stopped.total
    (3, 10)
    """

    parts = "cases"


@dataclass(frozen=True)
class Sweep(SceneResult, StatesModelError):
    """Largest tip deflections in transients, over the final speed.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Final speeds of the motion [rad/s].
    peaks : ndarray, shape (S,)
        Largest |tip deflection| in the window [m], also between steps; nan where the case failed.
    largest : ndarray, shape (S,)
        Largest |tip deflection| of the whole run [m], also between steps; nan where the case failed.
    time_error : ndarray, shape (S,)
        Estimated time-integration error of the tip deflection [m], which applies to `peaks` and `largest`.
    peaks_by_direction : ndarray, shape (S, 1) or (S, 2)
        Largest |tip deflection| in the window [m] in the direction of bending at the root and, where two
        planes are modelled, perpendicular to it; `peaks` and `largest` then are magnitudes of a vector.
    mode_error : float
        Estimated modal truncation error, relative to the largest deflection: the largest of five sampled
        speeds.  It is an error of `peaks` and `largest` too.
    status : tuple of str, length S
        "done", or "failed: " and the reason.
    window : tuple of float
        Beginning and end of the window [s].
    t_end : float
        End of each run [s].
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        How the result was computed.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> wheel = bd.RollingWheel(0.3, bd.SpinUp(55.0, duration=1.0), bd.RoadWave(0.3, velocity_amplitude=0.01))
    >>> found = bd.sweep(bd.Scene(strip, bd.Mount(0.215), wheel), [40.0, 50.0], window=(1.0, 1.5), modes=2)
    >>> found.status
    ('done', 'done')
    """

    speeds: np.ndarray
    peaks: np.ndarray
    largest: np.ndarray
    time_error: np.ndarray
    peaks_by_direction: np.ndarray
    mode_error: float
    status: tuple[str, ...]
    window: tuple[float, float]
    t_end: float

    judged_by_solving: ClassVar[bool] = True
    # Arguments with which the model error repeats a case; None in a result that was loaded from a file.
    request: ClassVar[SweepRequest | None] = None

    def headline(self) -> Iterator[str]:
        """Yield speeds, the largest peak and its error for a one-line summary; see `Result.headline`."""
        yield f"{counted(len(self.speeds), 'speed')}, {self.say_speed(self.speeds)}"
        if np.isfinite(self.peaks).any():
            at = int(np.nanargmax(self.peaks))
            peak, error, unit = self.peaks[at], self.peak_error[at], self.display_units.length_unit()
            shown = supported(unit.of(peak), unit.of(error), _DIGITS)
            yield f"peak {shown} {unit.name} at {self.say_speed(self.speeds[at])}"
            yield error_at_most(error / peak) if peak else ""
        yield from (states(self.status, ("done",)), warned(self.warnings))

    @property
    def peak_error(self) -> np.ndarray:
        """Estimated error of `peaks` and `largest` [m] by time integration and modal truncation, by speed."""
        with np.errstate(invalid="ignore"):
            of_modes = np.where(self.largest == 0, 0.0, self.mode_error * self.largest)
        return self.time_error + of_modes

    @property
    def left_out_speeds(self) -> np.ndarray:
        """Speed of the largest peak [rad/s], for which the model error is computed; empty if all failed."""
        return self.speeds[[np.nanargmax(self.peaks)]] if np.isfinite(self.peaks).any() else np.empty(0)

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """Relative changes (1,) of the largest peak by each neglected effect, from repeating its run."""
        if not len(self.left_out_speeds) or self.scene.motion is None:
            return nothing_known(self.scene)
        if self.scene.tip_load.acts:
            return nothing_known(self.scene, LOADED, self.left_out_speeds.shape)
        speed = float(self.left_out_speeds[0])
        if self.request is not None:
            case = self.request.transient_request(speed)
            found = case.solve()
        else:
            motion = self.scene.motion.with_speed(speed)
            with unannounced():  # the field `warnings` already contains the warnings of the repeated run
                run = simulate(replace(self.scene, motion=motion), self.t_end)
            case, found = run.request, run.solution
        return left_out_of_transient(case, found, self.window).at(np.newaxis)

    def is_warned(self, tolerance: float) -> np.ndarray:
        """Return for each speed whether a warning applies, given the tolerance of the runs."""
        if any(warn_of_missed_modes(self.mode_error, tolerance, "")):
            return np.ones(len(self.speeds), dtype=bool)
        return np.array([any(_warnings(self._at(i), tolerance)) for i in range(len(self.speeds))])

    def _at(self, i: int) -> Sweep:
        """Select one case as a sweep with a single speed."""
        names = "speeds", "peaks", "largest", "time_error", "status"
        return replace(self, **{name: getattr(self, name)[i : i + 1] for name in names})

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the peaks over speed, as in Fig. 6 of Lee and Yoo (2019)."""
        names = modelled_directions(self.scene)
        if len(names) == 1:
            return plot_sweep(self.speeds, self.peaks, ax, units=self.display_units)
        rows = np.vstack([self.peaks, self.peaks_by_direction.T])
        return plot_sweep(self.speeds, rows, ax, ("magnitude", *names), self.display_units)


@announced
def sweep(
    scene: Scene,
    speeds: np.ndarray | Sequence[float],
    window: tuple[float, float] = (20.0, 30.0),
    t_end: float | None = None,
    modes: int | str = "auto",
    tolerance: float = 1e-5,
    workers: int = 1,
    executor: Executor | None = None,
    store: str | Path | None = None,
    progress: Progress | None = None,
    discretization: DiscretizationChoice = "ritz",
    chunk: int = 10,
) -> Sweep:
    """Compute the largest |tip deflection| in a time window, from rest, for each final speed of the motion.

    Each case has its own time steps, so that its result is bitwise the same for any number of workers,
    executor, order, interruption and chunk size.

    With ``modes="auto"`` a case uses as many modes as its neighbours among the sampled cases need.  So its
    result depends, within `time_error` and `mode_error`, on which other speeds are requested.

    Parameters
    ----------
    scene : Scene
        The scene; the method `with_speed` of its motion builds the motion for each speed.
    speeds : sequence of float
        Speeds [rad/s], ascending, below the critical one.
    window : tuple of float
        Beginning and end of the window [s].
    t_end : float, optional
        End of each run [s]; the window's end if not given.
    modes : int or "auto"
        Number of modes at rest of each uncoupled displacement (such as bending in each plane).  "auto" takes
        modes at the slowest and at the fastest speed of each case: the fewest whose truncation error,
        estimated at five of the speeds, meets the tolerance.
    tolerance : float
        Target of the time-integration error, and with ``modes="auto"`` also of the modal truncation error,
        each relative to the largest deflection of a case.
    workers : int
        Number of processes that solve cases, including the calling one.
    executor : concurrent.futures.Executor, optional
        Executor in place of the worker processes, such as that of ``dask.distributed.Client.get_executor()``.
    store : str or Path, optional
        Directory in which finished chunks are saved; chunks found there are not computed again.
    progress : callable, optional
        Called with the number of finished cases and of all, at the start and after each chunk, computed or
        found in the store.
    discretization : {"ritz", "fem"} or Discretization
        Discretization from which the modes are computed.
    chunk : int
        Number of cases that a worker computes and the store saves together.

    Returns
    -------
    Sweep

    Raises
    ------
    ValueError
        Before any long computation, if an argument is out of its range, a speed passes the critical one, the
        store belongs to another sweep or cannot be written, or the motion cannot be stored or sent to
        workers.
    SweepInterrupted
        If the executor fails; finished chunks are in the store.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> wheel = bd.RollingWheel(0.3, bd.SpinUp(55.0, duration=1.0), bd.RoadWave(0.3, velocity_amplitude=0.01))
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215), wheel)
    >>> bd.sweep(scene, [40.0, 50.0], window=(1.0, 1.5), modes=2).peaks.shape
    (2,)
    """
    start = perf_counter()
    check_scene(scene)
    cases = tuple(checks.ascending("speeds", speeds).tolist())
    request = _check_request(scene, window, t_end, tolerance, discretization)
    chunk = checks.count("chunk", chunk)
    runner = TaskRunner(workers, executor, store, _KIND, _VERSIONS, progress, SweepInterrupted)
    basis = given_basis(modes)
    scene = choose_for_motion(scene, end_speeds(request, cases), basis and basis.modes, request.tolerance)
    # The record of the choice of physics contains computing times, which must not change keys of the store.
    request = replace(request, scene=replace(scene, physics_choice=None))
    _check_speeds(request := replace(request, basis=basis or first_basis(request, cases)), cases)
    if store is not None or executor is not None or runner.workers > 1:
        _check_sendable(request, importable=runner.workers > 1)
    runner.open_store()
    with runner.prepared(_solve, -(-len(cases) // chunk)):
        samples = None if basis else run_samples(request, cases)
        if samples is not None:
            request = with_basis_of(request, cases, samples)
        if executor is None and runner.workers == 1:
            mode_error = _find_mode_error(request, cases, samples, Event())
            found = _solve_cases(request, cases, chunk, runner)
        else:
            with _beside(_find_mode_error, request, cases, samples) as beside:
                found = _solve_cases(request, cases, chunk, runner)
            mode_error = beside.result()
    method = f"Gauss collocation, {request.basis_name} of {request.model.discretization}"
    provenance = Provenance.since(start, method)
    peaks, largest, time_error, status, by_direction = zip(*found, strict=True)
    result = Sweep(
        speeds=np.array(cases),
        peaks=np.array(peaks),
        largest=np.array(largest),
        time_error=np.array(time_error),
        peaks_by_direction=np.array(by_direction),
        mode_error=mode_error,
        status=status,
        window=request.window,
        t_end=request.t_end,
        warnings=(),
        provenance=provenance,
        scene=scene,
    )
    missed = () if basis else warn_of_missed_modes(mode_error, request.tolerance, request.basis_name)
    found = replace(result, warnings=(*_warnings(result, request.tolerance), *missed, *runner.warnings))
    vars(found)["request"] = replace(request, scene=scene)
    return found


@dataclass(frozen=True)
class _Chunk:
    """Chunk of cases, given by speeds [rad/s], that a worker computes and the store saves together."""

    request: SweepRequest
    speeds: tuple[float, ...]


def _solve(chunk: _Chunk) -> list[CaseResult]:
    """Solve a chunk; worker processes and executors call this function."""
    return solve_chunk(chunk.request, chunk.speeds)


def _solve_cases(
    request: SweepRequest, speeds: tuple[float, ...], size: int, runner: TaskRunner
) -> list[CaseResult]:
    """Solve all cases, starting with the fastest speeds, as these take longest."""
    found: dict[int, list[CaseResult]] = {}
    parts = [speeds[k : k + size] for k in range(0, len(speeds), size)]
    tasks = [Task(partial(_Chunk, request, part), len(part), k) for k, part in enumerate(parts)]
    runner.run(_solve, tasks[::-1], found.__setitem__)
    return [case for k in range(len(parts)) for case in found[k]]


# Checks of the request ---------------------------------------------------------------------------


def _check_request(
    scene: Scene,
    window: tuple[float, float],
    t_end: float | None,
    tolerance: float,
    discretization: DiscretizationChoice,
) -> SweepRequest:
    """Check the arguments that all cases share."""
    if scene.motion is None:
        remedy = "such as SpinUp(50.0, duration=10.0)"
        raise checks.InvalidValue("scene.motion", None, "a sweep needs a motion", remedy)
    ends = checks.as_floats(window)
    if ends is None or ends.shape != (2,):
        bound = "give its beginning and its end [s], two finite numbers such as (20.0, 30.0)"
        raise checks.InvalidValue("window", window, bound)
    start, end = (checks.real(f"window[{k}]", value, "s") for k, value in enumerate(ends.tolist()))
    last = end if t_end is None else checks.positive("t_end", t_end, "s")
    if not 0 <= start < end <= last:
        raise ValueError(
            f"window = {start:g} ... {end:g} s: it must begin before it ends, "
            f"and lie in the run, 0 ... {last:g} s"
        )
    tolerance = checks.within("tolerance", tolerance, *TOLERANCES)
    return SweepRequest(scene, (start, end), last, tolerance, discretization)


def _check_speeds(request: SweepRequest, speeds: tuple[float, ...]) -> None:
    """Raise a ValueError if a case passes the critical speed, or if a motion ends before `t_end`."""
    model, t = request.model, np.linspace(0, request.t_end, SPEED_SAMPLES)
    critical = np.inf if request.scene.physics.large_deflection else model.solver.critical_speed
    fastest = np.array([np.abs(motion.at(t).speed).max() for motion in map(request.motion, speeds)])
    if (past := fastest >= critical).any():
        where = list_speeds(np.array(speeds), past)
        raise checks.NoModelAnswer(
            f"speeds: {past.sum()} of {len(speeds)} ({where}) pass the critical speed "
            f"{critical:.6g} rad/s, where the beam buckles and linear theory does not hold; leave them out"
        )


@contextmanager
def _beside(function: Callable[..., float], *given: Any) -> Iterator[Future[float]]:
    """Run a function in a thread while the body of a `with` runs; yield the future of its result.

    The last argument of the function is an event.  An error in the body, such as an interrupt, sets it: the
    result is no longer needed.  The end of the body does not wait for the function.
    """
    thread, unwanted = ThreadPoolExecutor(1), Event()
    try:
        yield thread.submit(function, *given, unwanted)
    except BaseException:
        unwanted.set()
        raise
    finally:
        thread.shutdown(wait=False, cancel_futures=True)


@one_blas_thread()
def _find_mode_error(
    request: SweepRequest, speeds: tuple[float, ...], samples: Sequence[Transient] | None, unwanted: Event
) -> float:
    """Compute the modal truncation error of `samples`, else of new runs, until `unwanted` is set."""
    while_wanted = partial(takewhile, lambda _: not unwanted.is_set())
    runs = samples or (request.transient_request(speed).run() for speed in while_wanted(list_samples(speeds)))
    return largest_mode_error(while_wanted(runs))


def _check_sendable(request: SweepRequest, importable: bool) -> None:
    """Raise a ValueError if a scene cannot be pickled, or if worker processes cannot import its classes."""
    assert request.scene.motion is not None
    check_picklable(request.scene.motion)
    try:
        pickled = pickle.dumps(request)
    except Exception as error:  # the exception class depends on the object that cannot be pickled
        raise ValueError(f"the scene can be neither stored nor sent to workers: {error}") from None
    if importable and b"__main__" in pickled:
        raise ValueError(
            "motion: it uses functions or classes defined in the script itself (__main__), which workers "
            "cannot import; define them in a module of their own, or give workers=1"
        )


def _warnings(sweep: Sweep, tolerance: float) -> Iterator[Statement]:
    """Yield warnings about the peaks, with the cases and speeds affected."""
    speeds, motion = sweep.speeds, sweep.scene.motion
    yield from warn_of_left_out(sweep.scene)
    yield from warn_of_peak(sweep.scene, float(np.nanmax(sweep.largest, initial=0.0)))
    if (failed := np.array([s != DONE for s in sweep.status])).any():
        begin = f"{failed.sum()} of {len(speeds)} cases failed, at "
        yield Statement(begin, list_speeds(speeds, failed), ": see status", kind=NO_ANSWER)
    if not sweep.scene.physics.large_deflection:
        yield from warn_of_deflection(sweep.largest, sweep.scene.beam.length, speeds)
    if motion is not None:
        yield from warn_of_road(np.array([motion.road_acceleration(v) for v in speeds]), speeds)
    if (missed := sweep.time_error > tolerance * sweep.largest).any():
        where = list_speeds(speeds, missed)
        begin = f"the time-integration error exceeds the tolerance {tolerance:g} at "
        yield Statement(begin, where, kind=TOLERANCE, quantity="time-integration error", limit=tolerance)
