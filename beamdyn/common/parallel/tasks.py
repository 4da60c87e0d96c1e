"""Tasks of a long computation: run in this process, in worker processes or by an executor, and stored.

A store is a folder with one file per task; the file's name is a hash of what was to be computed.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field
from itertools import islice
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

from beamdyn.common.inputs.checks import InvalidValue, count, function
from beamdyn.common.parallel.workers import Workers, one_blas_thread
from beamdyn.common.results.files import ASIDE, write_text
from beamdyn.common.results.result import DamagedRecord, seal, unseal
from beamdyn.common.results.snapshots import decode, encode, fingerprint

_MARKER = "store.json"  # marker file by which a store is recognized
_RECORD = re.compile(r"[0-9a-f]{32}\.json")  # pattern of a record's file name: see `fingerprint`
_REMEDY = "name a folder that does not exist yet, or an earlier store"


class Store:
    """A folder of records; each is written in one step with a checksum, and never changed.

    Opening a store creates the folder, or checks that an existing folder is a store and can be written to.

    Parameters
    ----------
    path : str or Path
        The folder; its parent folder must exist.
    kind : str
        Kind of results; opening a store with another kind is an error.

    Raises
    ------
    ValueError
        If `path` is a file, contains anything but such a store, or cannot be written to.
    """

    def __init__(self, path: str | Path, kind: str) -> None:
        self.path, self.kind = Path(path), kind
        try:
            if self.path.exists() and not self.path.is_dir():
                raise ValueError(f"store = {str(self.path)!r} is a file; {_REMEDY}")
            self.path.mkdir(exist_ok=True)
            content = [p.name for p in self.path.iterdir() if not p.name.startswith(ASIDE)]
            if content and self._marked(content) != self.kind:
                raise ValueError(
                    f"store = {str(self.path)!r} holds something other than a {self.kind} "
                    f"({min(content)!r}, for instance); {_REMEDY}"
                )
            write_text(self.path / _MARKER, json.dumps({"kind": self.kind}))
        except OSError as error:
            reason = error.strerror or str(error)
            raise ValueError(f"store = {str(path)!r}: it cannot be written ({reason}); {_REMEDY}") from None

    def _marked(self, content: Sequence[str]) -> object:
        """Return the kind of results that the marker file of the folder names.

        If the marker file is damaged: return the kind of this store if all other files are records, else
        None.
        """
        try:
            return json.loads((self.path / _MARKER).read_bytes())["kind"]
        except (OSError, ValueError, LookupError, TypeError):
            records = [name for name in content if name != _MARKER]
            return self.kind if records and all(map(_RECORD.fullmatch, records)) else None

    def file(self, key: str) -> Path:
        """Return the path of the file that holds the record of a key."""
        return self.path / f"{key}.json"

    def read(self, key: str) -> dict[str, Any] | None:
        """Return the record of a key; None if there is none.

        Raises
        ------
        DamagedRecord
            If the record has changed since it was written.
        """
        try:
            text = self.file(key).read_bytes()
        except FileNotFoundError:
            return None
        except OSError as error:
            raise DamagedRecord(f"it cannot be read ({error.strerror})") from None
        record = unseal(text)
        if record.pop("key", None) != key:
            raise DamagedRecord("it is the record of another key: its file was renamed")
        return record

    def write(self, key: str, record: Mapping[str, Any]) -> None:
        """Write a record of JSON values under a key; floats keep all their digits."""
        write_text(self.file(key), json.dumps(seal({**record, "key": key})))


# Tasks -----------------------------------------------------------------------------------------------

Progress = Callable[[int, int], object]
Solve = Callable[[Any], Any]
Keep = Callable[[Any, Any], None]
# Most tasks submitted to an executor at once: enough to keep its workers busy without filling the memory.
_IN_FLIGHT = 256
# Most tasks submitted at once for each worker process; this process takes back some that have not begun.
_PER_WORKER = 8


class RunInterrupted(RuntimeError):
    """Raised when the executor fails before all parts of a computation are done.

    Parameters
    ----------
    done, total : int
        Number of parts that are done, and total number.
    stored : bool
        Whether the finished parts are in a store.
    """

    parts = "designs"  # word for the parts of the computation in messages

    def __init__(self, done: int, total: int, stored: bool) -> None:
        super().__init__(done, total, stored)
        self.done, self.total, self.stored = done, total, stored

    def __str__(self) -> str:
        hint = "stored; the same call with a working executor resumes"
        if not self.stored:
            hint = "done, but not kept: give a store= and the same call resumes"
        return f"the executor broke with {self.done} of {self.total} {self.parts} {hint}"


class StudyInterrupted(RunInterrupted):
    """Raised when the executor fails before all designs of a study are done.

    Examples
    --------
    >>> stopped = bd.StudyInterrupted(done=300, total=1000, stored=True)
    >>> stopped.done, stopped.total
    (300, 1000)
    """


@dataclass(frozen=True)
class Task:
    """A part of a computation: a function that makes the part's input; its size; the place of its result.

    Parameters
    ----------
    make : callable
        ``make()`` returns the input of the task; it is called just before the task is started.
    size : int
        Number of designs or cases in the task.
    place : object
        Position of the task's result among all results, such as an index.
    """

    make: Callable[[], Any]
    size: int
    place: Any


@dataclass
class TaskRunner:
    """Runs tasks in this process, in worker processes or by an executor, and stores their results.

    A result depends only on its task: it is the same to the last bit for any number of workers and any
    executor.

    Parameters
    ----------
    workers : int
        Number of processes, including this one.
    executor : Executor, optional
        An executor as in `concurrent.futures`, used in place of worker processes.
    store : str or Path, optional
        Folder in which results are stored; results that it already contains are not computed again.
    kind : str
        Kind of results in the store.
    versions : tuple of str
        Versions of the programs that affect the last bits of a result.
    progress : callable, optional
        Called as progress(done, total) with numbers of designs, at the start and after each task.
    interrupted : type
        Class of the error raised when the executor fails; its `parts` is the word for the parts, such as
        "designs".

    Attributes
    ----------
    warnings : list of str
        Sentences on damaged records of the store, which were computed again.

    Raises
    ------
    InvalidValue
        If an argument is not as described here.
    """

    workers: int = 1
    executor: Executor | None = None
    store: str | PathLike[str] | None = None
    kind: str = "study"
    versions: tuple[str, ...] = ()
    progress: Progress | None = None
    interrupted: type[RunInterrupted] = StudyInterrupted
    warnings: list[str] = field(default_factory=list)
    _opened: Store | None = field(default=None, init=False, repr=False)
    _pool: Workers | None = field(default=None, init=False, repr=False)

    def __post_init__(self) -> None:
        if self.executor is not None and not hasattr(self.executor, "submit"):
            raise InvalidValue("executor", self.executor, "give an Executor, as in concurrent.futures")
        self.workers = count("workers", self.workers)
        if self.executor is not None and self.workers > 1:
            raise InvalidValue("workers", self.workers, "an executor is given too", "give one of them")
        if self.store is not None and not isinstance(self.store, str | PathLike):
            raise InvalidValue("store", self.store, "give the name of a folder")
        if isinstance(self.store, str) and not self.store.strip():
            raise InvalidValue("store", self.store, "the name is empty", 'give a folder, such as "store"')
        if self.progress is not None:
            parts = self.interrupted.parts
            function("progress", self.progress, f"it gets the numbers of finished and of all {parts}")

    def open_store(self) -> Store | None:
        """Return the store, and open it at the first call; None if there is no store."""
        if self._opened is None and self.store is not None:
            self._opened = Store(Path(self.store), self.kind)
        return self._opened

    @contextmanager
    def prepared(self, solve: Solve, tasks: int) -> Iterator[None]:
        """In this context, start worker processes that import `solve`, while the caller prepares the tasks.

        With a store, which may already contain all results, worker processes start only when they are needed.
        """
        others = min(self.workers, tasks) - 1
        if self.executor is not None or self.store is not None or others < 1:
            yield
            return
        with Workers(others) as self._pool:
            try:
                for _ in range(others):
                    self._pool.submit(_import, solve)
                yield
            finally:
                self._pool = None

    def run(self, solve: Solve, tasks: Sequence[Task], keep: Keep) -> None:
        """Solve tasks; call `keep` with the place and the result of each task when it ends.

        Parameters
        ----------
        solve : callable
            ``solve(made)`` returns the result for the input that a task's `make` has returned.  With workers
            or an executor it must be a function of a module.  With a store, the result must be data that can
            be saved: see `beamdyn.common.results.snapshots`.
        tasks : sequence of Task
            The tasks.
        keep : callable
            Function that is called with the place of a task and its result.

        Raises
        ------
        RunInterrupted
            If the executor fails; the error has the class `interrupted`.
        """
        run = _TaskRun(self, solve, keep, sum(task.size for task in tasks))
        if self.executor is not None:
            run.through(self.executor, _IN_FLIGHT, tasks)
        elif self.workers == 1 or len(tasks) == 1:
            run.here(tasks)
        else:
            with (
                nullcontext(self._pool) if self._pool else Workers(min(self.workers, len(tasks)) - 1) as pool
            ):
                run.through(pool, _PER_WORKER * pool.count, tasks, helps=True)


class _Pending(NamedTuple):
    """A task whose result is not in the store, with its input, and the key of its result."""

    task: Task
    made: Any
    key: str


@dataclass
class _TaskRun:
    """One run of a list of tasks, and its progress."""

    runner: TaskRunner
    solve: Solve
    keep: Keep
    total: int
    done: int = 0
    flying: dict[Future[Any], _Pending] = field(default_factory=dict)

    def here(self, tasks: Sequence[Task]) -> None:
        """Solve the tasks in this process, one after another."""
        for pending in self._missing(tasks):
            self._finish(pending, _solve(self.solve, pending.made))

    def through(self, executor: Executor, most: int, tasks: Sequence[Task], helps: bool = False) -> None:
        """Solve tasks by an executor; only a limited number of tasks is submitted at a time.

        If `helps`, this process also solves some of the tasks itself.
        """
        missing = self._missing(tasks)
        try:
            while True:
                self._submit(executor, islice(missing, most - len(self.flying)))
                own = (next(missing, None) or self._take_back()) if helps else None
                if own is not None:
                    self._finish(own, _solve(self.solve, own.made))
                elif not self.flying:
                    return
                for future in wait(self.flying, None if own is None else 0.0, FIRST_COMPLETED).done:
                    result = self._ask(future.result)
                    self._finish(self.flying.pop(future), result)
        finally:
            self._land()

    def _submit(self, executor: Executor, tasks: Iterable[_Pending]) -> None:
        for pending in tasks:
            future = self._ask(executor.submit, _returning_errors, self.solve, pending.made)
            self.flying[future] = pending

    def _take_back(self) -> _Pending | None:
        """Withdraw a submitted task that has not begun; None if there is none."""
        waiting = next((future for future in reversed(self.flying) if future.cancel()), None)
        return None if waiting is None else self.flying.pop(waiting)

    def _missing(self, tasks: Sequence[Task]) -> Iterator[_Pending]:
        """Yield those tasks that are not in the store, one at a time; pass stored results to `keep`."""
        self._report()
        for task in tasks:
            made = task.make()
            stored = self.runner.store is not None
            # Results are stored under a hash of versions, function and task.
            key = fingerprint(self.runner.versions, self.solve, made) if stored else ""
            pending = _Pending(task, made, key)
            if (found := self._stored(pending.key)) is None:
                yield pending
            else:
                self.done += task.size
                self.keep(task.place, found)
                self._report()

    def _stored(self, key: str) -> Any:
        """Return the stored result of a task; None if it is missing or damaged."""
        if (store := self.runner.open_store()) is None:
            return None
        try:
            record = store.read(key)
            return None if record is None else decode(record["result"])
        except DamagedRecord as error:
            parts = self.runner.interrupted.parts
            self.runner.warnings.append(f"{store.file(key)}: {error}; its {parts} were computed again")
            return None

    def _ask(self, action: Callable[..., Any], *arguments: Any) -> Any:
        """Call the executor; if it fails, store the finished results and raise `TaskRunner.interrupted`.

        Only errors of the executor itself are raised here: errors in tasks are returned as results.
        """
        try:
            return action(*arguments)
        except Exception as error:
            self._land()
            stored = self.runner.store is not None
            raise self.runner.interrupted(self.done, self.total, stored) from error

    def _land(self) -> None:
        """Cancel the tasks that have not begun, and store the results of finished tasks."""
        for future in self.flying:
            future.cancel()
        while self.flying:
            future, pending = self.flying.popitem()
            if future.done() and not future.cancelled() and not future.exception():
                self._store(pending, future.result())

    def _finish(self, pending: _Pending, result: Any) -> None:
        """Store the result of a task and pass it to `keep`; or raise the error that the task returned."""
        if isinstance(result, Exception):
            raise result
        self._store(pending, result)
        self.keep(pending.task.place, result)
        self._report()

    def _store(self, pending: _Pending, result: Any) -> None:
        """Store a result, unless it is an error."""
        if isinstance(result, Exception):
            return
        if (store := self.runner.open_store()) is not None:
            store.write(pending.key, {"result": encode(result)})
        self.done += pending.task.size

    def _report(self) -> None:
        if self.runner.progress is not None:
            self.runner.progress(self.done, self.total)


def _import(solve: Solve) -> None:
    """Do nothing: when a process receives this call, it imports the module of `solve`."""


def _solve(solve: Solve, made: Any) -> Any:
    with one_blas_thread():
        return solve(made)


def _returning_errors(solve: Solve, made: Any) -> Any:
    """Solve a task; return its error, if any, so that a raised error must come from the executor."""
    try:
        return _solve(solve, made)
    except Exception as error:
        return error
