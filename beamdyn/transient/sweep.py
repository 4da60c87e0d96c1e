"""Many transients: a peak for each speed, in parallel, resumable, and the same to the bit however run."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, Future, as_completed
from dataclasses import dataclass, field, replace
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy

from beamdyn._version import __version__
from beamdyn.common.checks import ascending, count, positive, real, within
from beamdyn.common.parallel.store import Store, fingerprint
from beamdyn.common.parallel.workers import Workers, one_blas_thread
from beamdyn.common.results import Provenance, Result
from beamdyn.equations.operators import Discretization
from beamdyn.modal.modal_basis import FEWEST, Kept, range_of_speed
from beamdyn.scene.motion import check_picklable
from beamdyn.scene.scene import Scene
from beamdyn.spectrum.modes import LARGE_DEFLECTION
from beamdyn.transient.chunks import DONE, Case, Request, solve
from beamdyn.transient.simulate import Task, Transient
from beamdyn.transient.step_size import TOLERANCES

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_KIND = "beamdyn sweep"
_VERSIONS = (__version__, np.__version__, scipy.__version__)  # whose bits are stored
_GRAVITY = 9.81  # past this acceleration [m/s2] a wheel leaves the road

Progress = Callable[[int, int], object]


class SweepInterrupted(RuntimeError):
    """The executor broke before all cases were done.

    Parameters
    ----------
    done, total : int
        Cases that were done, and all cases.
    stored : bool
        Whether those that were done are in a store.
    """

    def __init__(self, done: int, total: int, stored: bool) -> None:
        super().__init__(done, total, stored)
        self.done, self.total, self.stored = done, total, stored

    def __str__(self) -> str:
        if self.stored:
            hint = "stored; the same call with a working executor resumes"
        else:
            hint = "done, but not kept: give a store= and the same call resumes"
        return f"the executor broke with {self.done} of {self.total} cases {hint}"


@dataclass(frozen=True)
class Sweep(Result):
    """Peaks of transients over speed.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Final speeds of the motion [rad/s].
    peaks : ndarray, shape (S,)
        Largest tip deflection, either way, in the window [m]; nan where there is none.
    largest : ndarray, shape (S,)
        Largest tip deflection of the run [m]: of the samples, eight or more in each step.
    time_error : ndarray, shape (S,)
        Estimated error of the tip deflection by the steps in time [m].
    mode_error : float
        Estimated error by the modes left out, relative to the largest deflection: the largest of three
        of the speeds.
    status : tuple of str, length S
        "done", or "failed" and why.
    window : tuple of float
        Beginning and end of the window [s].
    t_end : float
        End of each run [s].
    warnings : tuple of str
        What limits the answer.
    provenance : Provenance
        How it was found.
    """

    speeds: np.ndarray
    peaks: np.ndarray
    largest: np.ndarray
    time_error: np.ndarray
    mode_error: float
    status: tuple[str, ...]
    window: tuple[float, float]
    t_end: float
    warnings: tuple[str, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the peaks over speed, as in Fig. 6 of Lee and Yoo (2019)."""
        from beamdyn.output.plots import plot_sweep

        return plot_sweep(self.speeds, self.peaks, ax)


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
    discretization: str | Discretization = "ritz",
    chunk: int = 40,
) -> Sweep:
    """Peak of the tip deflection in a window of time, from rest, for each final speed of the motion.

    The cases are split into chunks of neighbouring speeds, whose transients advance together.  The
    split follows from the request alone: workers, executors, order and resumption change no bit.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is taken to each speed by `with_speed`.
    speeds : sequence of float
        Speeds [rad/s], ascending, below the critical one.
    window : tuple of float
        Beginning and end of the window [s].
    t_end : float, optional
        End of each run [s]; the window's end if not given.
    modes : int or "auto"
        Number of modes of each field at rest.  "auto" keeps modes at the slowest and at the fastest speed, as
        few as leave no more than the tolerance out at three of the speeds.
    tolerance : float
        Error in time that is aimed at, and with ``modes="auto"`` also the error by the modes left out, each
        relative to the largest deflection of a case.
    workers : int
        Processes of our own; 1 computes in this one.
    executor : concurrent.futures.Executor, optional
        Computes in place of our workers, such as that of ``dask.distributed.Client.get_executor()``.
    store : str or Path, optional
        Directory that keeps each finished chunk; a sweep that finds chunks there computes only the others.
    progress : callable, optional
        Called with the number of cases that are done and of all: at the start, and after each chunk.
    discretization : {"ritz", "fem"} or Discretization
        Where the modes come from.
    chunk : int
        Cases in a chunk: a part of the request, on which the last digits depend.

    Returns
    -------
    Sweep

    Raises
    ------
    ValueError
        Before any long work, if an argument is out of its range, a speed passes the critical one, the
        store is foreign or cannot be written, or the motion cannot be stored or sent to workers.
    SweepInterrupted
        If the executor breaks; what is finished is in the store.
    """
    began = perf_counter()
    cases = tuple(ascending("speeds", speeds).tolist())
    request = _request(scene, window, t_end, tolerance, discretization)
    workers, chunk = count("workers", workers), count("chunk", chunk)
    if executor is not None and workers > 1:
        raise ValueError(f"workers = {workers} and an executor are given: give one of them")
    kept = None if modes == "auto" else Kept(count("modes", modes))
    _check_speeds(request := replace(request, kept=kept or _fewest(request, cases)), cases)
    if store is not None or executor is not None or workers > 1:
        _check_sendable(request, importable=workers > 1)
    tried = _tried(request, cases, Task.run) if kept else _agreed(request, cases)
    request = replace(request, kept=max((each.task.kept for each in tried), key=lambda kept: kept.modes or 0))
    run = _Run(request, _chunks(cases, chunk), None if store is None else Store(store, _KIND), progress)
    run.collect(executor, workers)
    method = f"Gauss collocation in batches of {chunk}, {request.kept} of {request.model().discretization}"
    provenance = Provenance(__version__, method, "", perf_counter() - began)
    return _result(request, np.array(cases), run.cases(), _left_out(tried), provenance)


def _chunks(speeds: tuple[float, ...], size: int) -> list[tuple[float, ...]]:
    return [speeds[k : k + size] for k in range(0, len(speeds), size)]


# Requests -----------------------------------------------------------------------------------------


def _request(
    scene: Scene,
    window: tuple[float, float],
    t_end: float | None,
    tolerance: float,
    discretization: str | Discretization,
) -> Request:
    if scene.motion is None:
        raise ValueError("scene.motion is None: a sweep needs a motion, such as SpinUp(50.0, duration=10.0)")
    if not isinstance(window, tuple | list) or len(window) != 2:
        raise ValueError(f"window = {window!r}: give its beginning and its end [s], such as (20.0, 30.0)")
    start, end = real("window[0]", window[0], "s"), real("window[1]", window[1], "s")
    last = end if t_end is None else positive("t_end", t_end, "s")
    if not 0 <= start < end <= last:
        raise ValueError(
            f"window = {start:g} ... {end:g} s: it must begin before it ends, "
            f"and lie in the run, 0 ... {last:g} s"
        )
    return Request(scene, (start, end), last, within("tolerance", tolerance, *TOLERANCES), discretization)


def _check_speeds(request: Request, speeds: tuple[float, ...]) -> None:
    """Refuse a case that passes the critical speed, or a motion that does not last to the end."""
    model, t = request.model(), np.linspace(0, request.t_end, 2001)
    critical = model.solver.critical_speed
    fastest = np.array([np.abs(motion.at(t).speed).max() for motion in request.motions(speeds)])
    if (fastest >= critical).any():
        past = np.array(speeds)[fastest >= critical]
        raise ValueError(
            f"speeds: {len(past)} of {len(speeds)} ({_range(past)}) pass the critical speed "
            f"{critical:.6g} rad/s, where the beam buckles and linear theory has no answer; leave them out"
        )


def _fewest(request: Request, speeds: tuple[float, ...]) -> Kept:
    """The fewest modes that are tried, at the slowest and at the fastest speed of all cases."""
    ends = [range_of_speed(motion, request.t_end) for motion in request.motions((speeds[0], speeds[-1]))]
    return Kept(FEWEST, tuple(np.unique([ends[0][0], ends[1][-1]]).tolist()))


@one_blas_thread()
def _tried(request: Request, speeds: tuple[float, ...], run: Callable[[Task], Transient]) -> list[Transient]:
    """Runs at the fastest speed, in the middle, and halfway between: they tell what the modes leave out."""
    some = sorted({speeds[k * (len(speeds) - 1) // 4] for k in (2, 3, 4)})
    return [run(request.task(motion)) for motion in request.motions(some)]


def _agreed(request: Request, speeds: tuple[float, ...]) -> list[Transient]:
    """The cheapest of these runs; if their families of modes differ, all in that which leaves out least."""
    tried = _tried(request, speeds, Task.cheapest)
    families = {each.task.kept.speeds for each in tried}
    if len(families) == 1:
        return tried
    most = max(each.task.kept.modes or 0 for each in tried)
    alike = (replace(request, kept=Kept(most, family)) for family in sorted(families))
    return min((_tried(each, speeds, Task.run) for each in alike), key=_left_out)


def _left_out(tried: Sequence[Transient]) -> float:
    """Largest estimated error of some runs by the modes left out, over their largest deflection."""
    return max((each.mode_error / each.largest for each in tried if each.largest), default=0.0)


def _check_sendable(request: Request, importable: bool) -> None:
    """Refuse what cannot be stored or sent to workers; to our own only what they can import."""
    assert request.scene.motion is not None
    check_picklable(request.scene.motion)
    try:
        sent = pickle.dumps(request)
    except Exception as error:  # which one depends on the object
        raise ValueError(f"the scene can be neither stored nor sent to workers: {error}") from None
    if importable and b"__main__" in sent:
        raise ValueError(
            "motion: it uses functions or classes defined in the script itself (__main__), which workers "
            "cannot import; define them in a module of their own, or give workers=1"
        )


# Running ------------------------------------------------------------------------------------------


class _Run:
    """The chunks of a sweep and what is known of them.

    Parameters
    ----------
    request : Request
        What is asked.
    chunks : list of tuple of float
        Speeds of each chunk [rad/s].
    store : Store, optional
        Where finished chunks are kept.
    progress : callable, optional
        Called with the number of cases done and of all.
    """

    def __init__(
        self,
        request: Request,
        chunks: list[tuple[float, ...]],
        store: Store | None,
        progress: Progress | None,
    ) -> None:
        self.request, self.chunks, self.store, self.progress = request, chunks, store, progress
        self.known: dict[int, list[Case]] = {}
        self.futures: dict[Future[Any], int] = {}
        if store is not None:
            self.keys = [fingerprint(_VERSIONS, request, speeds) for speeds in chunks]
            stored = ((k, store.read(key)) for k, key in enumerate(self.keys))
            self.known = {k: [Case(*c) for c in record["cases"]] for k, record in stored if record}

    @property
    def missing(self) -> list[int]:
        """Chunks still to compute, those of high speeds first: they take longest."""
        return [k for k in reversed(range(len(self.chunks))) if k not in self.known]

    def cases(self) -> list[Case]:
        """All cases by ascending speed."""
        return [case for k in range(len(self.chunks)) for case in self.known[k]]

    def collect(self, executor: Executor | None, workers: int) -> None:
        """Compute what is missing."""
        self._report()
        missing = self.missing
        workers = min(workers, len(missing))
        if executor is not None:
            self._submit(executor, missing)
        elif workers > 1:
            with Workers(workers) as pool:
                self._submit(pool, missing)
        else:
            for k in missing:
                self._keep(k, solve(self.request, self.chunks[k]))
                self._report()

    def _submit(self, executor: Executor, missing: list[int]) -> None:
        """Compute chunks by an executor; at an error keep what is finished and cancel the rest."""
        try:
            for k in missing:
                future = self._ask(executor.submit, _attempt, self.request, self.chunks[k])
                self.futures[future] = k
            for future in as_completed(list(self.futures)):
                found = self._ask(future.result)
                self._keep(self.futures.pop(future), found)
                self._report()
        finally:
            self._settle()

    def _ask(self, action: Callable[..., Any], *args: Any) -> Any:
        """What the executor answers: tasks return their errors, so that one that is raised is its own."""
        try:
            return action(*args)
        except Exception as error:
            self._settle()
            raise SweepInterrupted(*self._count(), stored=self.store is not None) from error

    def _settle(self) -> None:
        """Cancel what has not begun; keep what has finished meanwhile."""
        for future in self.futures:
            future.cancel()
        while self.futures:
            future, k = self.futures.popitem()
            if (
                future.done()
                and not future.cancelled()
                and isinstance(future.exception() or future.result(), list)
            ):
                self._keep(k, future.result())

    def _keep(self, k: int, found: list[Case] | Exception) -> None:
        if isinstance(found, Exception):
            raise found
        if self.store is not None:
            self.store.write(self.keys[k], {"speeds": self.chunks[k], "fields": Case._fields, "cases": found})
        self.known[k] = found

    def _count(self) -> tuple[int, int]:
        """Cases that are done, and all."""
        return sum(len(self.chunks[k]) for k in self.known), sum(map(len, self.chunks))

    def _report(self) -> None:
        if self.progress is not None:
            self.progress(*self._count())


def _attempt(request: Request, speeds: tuple[float, ...]) -> list[Case] | Exception:
    """Solve a chunk; return its error, for what an executor raises is its own."""
    try:
        return solve(request, speeds)
    except Exception as error:
        return error


# Results ------------------------------------------------------------------------------------------


def _result(
    request: Request, speeds: np.ndarray, cases: Sequence[Case], mode_error: float, provenance: Provenance
) -> Sweep:
    peaks, largest, time_error, status = zip(*cases, strict=True)
    found = Sweep(
        speeds=speeds,
        peaks=np.array(peaks),
        largest=np.array(largest),
        time_error=np.array(time_error),
        mode_error=mode_error,
        status=status,
        window=request.window,
        t_end=request.t_end,
        warnings=(),
        provenance=provenance,
        scene=request.scene,
    )
    return replace(found, warnings=tuple(_warnings(found, request.tolerance)))


def _warnings(found: Sweep, tolerance: float) -> Iterator[str]:
    speeds, motion, length = found.speeds, found.scene.motion, found.scene.beam.length
    if (at := speeds[np.array([s != DONE for s in found.status])]).size:
        yield f"{len(at)} of {len(speeds)} cases failed, at {_range(at)}: see status"
    if (at := speeds[found.largest > LARGE_DEFLECTION * length]).size:
        yield f"the tip deflects by more than 0.1 of the length at {_range(at)}: outside linear theory"
    road = np.array([0.0 if motion is None else motion.road_acceleration(v) for v in speeds])
    if (at := speeds[road > _GRAVITY]).size:
        yield (
            f"the road accelerates the wheel by up to {road.max():.4g} m/s2, past gravity, at {_range(at)}: "
            "the wheel leaves the road; was a velocity given as a height?"
        )
    if (at := speeds[found.time_error > tolerance * found.largest]).size:
        yield f"the steps in time do not reach the tolerance {tolerance:g} at {_range(at)}; see time_error"


def _range(speeds: np.ndarray) -> str:
    ends = [f"{speed:.6g}" for speed in (speeds.min(), speeds.max())]
    return " to ".join(dict.fromkeys(ends)) + " rad/s"
