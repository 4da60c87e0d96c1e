"""Tasks of a long computation: run here, in workers or by an executor, few at a time, and kept in a store."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from contextlib import nullcontext
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

from beamdyn.common.checks import InvalidValue, count, function
from beamdyn.common.parallel.store import Store, fingerprint
from beamdyn.common.parallel.workers import Workers, one_blas_thread
from beamdyn.common.records import DamagedRecord
from beamdyn.common.snapshots import decode, encode

Progress = Callable[[int, int], object]
Solve = Callable[[Any], Any]
_IN_FLIGHT = 256  # tasks that an executor has at a time: enough for its workers, few for the memory
_PER_WORKER = 3  # the same for each worker of our own


class StudyInterrupted(RuntimeError):
    """Raised when the executor breaks before all designs are done.

    Parameters
    ----------
    done, total : int
        Number of designs that are done, and of all.
    stored : bool
        Whether those that are done are in a store.
    """

    def __init__(self, done: int, total: int, stored: bool) -> None:
        super().__init__(done, total, stored)
        self.done, self.total, self.stored = done, total, stored

    def __str__(self) -> str:
        hint = "stored; the same call with a working executor resumes"
        if not self.stored:
            hint = "done, but not kept: give a store= and the same call resumes"
        return f"the executor broke with {self.done} of {self.total} designs {hint}"


@dataclass(frozen=True)
class Task:
    """A part of a computation.

    Parameters
    ----------
    make : callable
        Makes what is to be solved; it is made when its turn comes.
    size : int
        Number of its designs.
    place : object
        Where its result belongs.
    """

    make: Callable[[], Any]
    size: int
    place: Any


@dataclass
class TaskRunner:
    """Runs tasks, and keeps their results in a store.

    Parameters
    ----------
    workers : int
        Number of processes; 1 is this one.
    executor : Executor, optional
        Any of `concurrent.futures`, in place of workers.
    store : str or Path, optional
        Folder in which results are kept; those found there are not computed again.
    kind : str
        What the store holds.
    versions : tuple of str
        Of the programs on which the bits of a result depend.
    progress : callable, optional
        Called as progress(done, total) with the numbers of designs.

    Attributes
    ----------
    warnings : list of str
        Records of the store that are damaged, and were computed again.

    Raises
    ------
    InvalidValue
        If an argument is none of these.
    """

    workers: int = 1
    executor: Executor | None = None
    store: str | PathLike[str] | None = None
    kind: str = "study"
    versions: tuple[str, ...] = ()
    progress: Progress | None = None
    warnings: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        if self.executor is not None and not hasattr(self.executor, "submit"):
            raise InvalidValue("executor", self.executor, "give an Executor, as in concurrent.futures")
        self.workers = count("workers", self.workers)
        if self.executor is not None and self.workers > 1:
            raise InvalidValue("workers", self.workers, "an executor is given too", "give one of them")
        if self.store is not None and not isinstance(self.store, str | PathLike):
            raise InvalidValue("store", self.store, "give the name of a folder")
        if self.progress is not None:
            function("progress", self.progress, "it takes the numbers of finished designs and of all")
        self._total = self._done = 0

    def run(self, solve: Solve, tasks: Sequence[Task], keep: Callable[[Any, Any], None]) -> None:
        """Solve the tasks; `keep` takes the place and the result of each, in the order in which they end.

        Parameters
        ----------
        solve : callable
            Takes what a task makes; with workers or an executor a function of a module.  What it returns
            with a store is data: see `beamdyn.common.snapshots`.
        tasks : sequence of Task
            The tasks.
        keep : callable
            Takes the place of a task and its result.

        Raises
        ------
        StudyInterrupted
            If the executor breaks.
        """
        self._total, self._done = sum(task.size for task in tasks), 0
        store = None if self.store is None else Store(Path(self.store), self.kind)
        kept = _Kept(store, self.versions, solve, self.warnings)
        pending = self._missing(kept, tasks, keep)
        alone = self.executor is None and (self.workers == 1 or len(tasks) == 1)
        if alone:
            for task, made, key in pending:
                self._finish(kept, task, key, _solve(solve, made), keep)
            return
        pool = nullcontext(self.executor) if self.executor else Workers(min(self.workers, len(tasks)))
        most = _IN_FLIGHT if self.executor else _PER_WORKER * self.workers
        with pool as executor:
            assert executor is not None
            self._run_by(executor, most, solve, kept, pending, keep)

    def _missing(
        self, kept: _Kept, tasks: Sequence[Task], keep: Callable[[Any, Any], None]
    ) -> Iterator[tuple[Task, Any, str]]:
        """Yield the tasks that are not in the store, made when they are wanted; keep those that are."""
        self._report(0)
        for task in tasks:
            made = task.make()
            key = kept.key(made)
            found = kept.read(key)
            if found is None:
                yield task, made, key
            else:
                keep(task.place, found)
                self._report(task.size)

    def _run_by(
        self,
        executor: Executor,
        most: int,
        solve: Solve,
        kept: _Kept,
        pending: Iterator[tuple[Task, Any, str]],
        keep: Callable[[Any, Any], None],
    ) -> None:
        """Have at most so many tasks in flight."""
        flying: dict[Future[Any], tuple[Task, str]] = {}
        try:
            while True:
                while len(flying) < most and (following := next(pending, None)) is not None:
                    task, made, key = following
                    flying[self._ask(executor.submit, _returning_errors, solve, made)] = task, key
                if not flying:
                    return
                for future in wait(flying, return_when=FIRST_COMPLETED).done:
                    result = self._ask(future.result)
                    self._finish(kept, *flying.pop(future), result, keep)
        finally:
            for future in flying:
                future.cancel()

    def _ask(self, action: Callable[..., Any], *arguments: Any) -> Any:
        """Call the executor; an error that it raises is its own, because tasks return theirs."""
        try:
            return action(*arguments)
        except Exception as error:
            raise StudyInterrupted(self._done, self._total, self.store is not None) from error

    def _finish(
        self, kept: _Kept, task: Task, key: str, result: Any, keep: Callable[[Any, Any], None]
    ) -> None:
        """Keep the result of a task, or raise the error that it returned."""
        if isinstance(result, Exception):
            raise result
        kept.write(key, result)
        keep(task.place, result)
        self._report(task.size)

    def _report(self, more: int) -> None:
        self._done += more
        if self.progress is not None:
            self.progress(self._done, self._total)


@dataclass(frozen=True)
class _Kept:
    """Results of tasks in a store, if there is one."""

    store: Store | None
    versions: tuple[str, ...]
    solve: Solve
    warnings: list[str]

    def key(self, made: Any) -> str:
        """What names the result of a task: a hash of the versions, of the function and of the task."""
        return "" if self.store is None else fingerprint(self.versions, self.solve, made)

    def read(self, key: str) -> Any:
        """The result; None if there is none that is whole."""
        if self.store is None:
            return None
        try:
            record = self.store.read(key)
        except DamagedRecord as error:
            self.warnings.append(f"{self.store.file(key)}: {error}; its designs were computed again")
            return None
        return None if record is None else decode(record["result"])

    def write(self, key: str, result: Any) -> None:
        if self.store is not None:
            self.store.write(key, {"result": encode(result)})


def _solve(solve: Solve, made: Any) -> Any:
    with one_blas_thread():
        return solve(made)


def _returning_errors(solve: Solve, made: Any) -> Any:
    """Solve a task and return its error, if any, so that errors raised are the executor's own."""
    try:
        return _solve(solve, made)
    except Exception as error:
        return error
