"""Collect the chunks of a sweep: from a store, from this process, or from an executor that may break."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor, Future, as_completed
from typing import Any

import numpy as np
import scipy

from beamdyn._version import __version__
from beamdyn.common.parallel.store import Store, fingerprint
from beamdyn.common.parallel.workers import Workers
from beamdyn.common.records import DamagedRecord
from beamdyn.scene.validity import list_range
from beamdyn.transient.chunks import CaseResult, SweepRequest, solve_chunk

VERSIONS = (__version__, np.__version__, scipy.__version__)  # of the programs on which the stored bits depend

Progress = Callable[[int, int], object]


class SweepInterrupted(RuntimeError):
    """Raised when the executor breaks before all cases are done.

    Parameters
    ----------
    done, total : int
        Number of cases that are done, and of all.
    stored : bool
        Whether the finished cases are in a store.
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


class ChunkCollector:
    """Collector of the chunks of a sweep, computed or read from a store.

    Parameters
    ----------
    request : SweepRequest
        The request that all cases share.
    chunks : list of tuple of float
        Speeds of each chunk [rad/s].
    store : Store, optional
        Directory of the finished chunks.
    progress : callable, optional
        Called with the number of finished cases and of all.

    Attributes
    ----------
    warnings : list of str
        Records of the store that are damaged, and why.
    """

    def __init__(
        self,
        request: SweepRequest,
        chunks: list[tuple[float, ...]],
        store: Store | None,
        progress: Progress | None,
    ) -> None:
        self.request, self.chunks, self.store, self.progress = request, chunks, store, progress
        self.finished: dict[int, list[CaseResult]] = {}
        self.futures: dict[Future[Any], int] = {}
        self.warnings: list[str] = []
        if store is not None:
            self.keys = [fingerprint(VERSIONS, request, speeds) for speeds in chunks]
            for k in range(len(chunks)):
                self._look_up(store, k)

    def _look_up(self, store: Store, k: int) -> None:
        """Take chunk k from the store if it is there, whole; warn of a damaged record."""
        try:
            record = store.read(self.keys[k])
        except DamagedRecord as error:
            speeds = list_range(np.array(self.chunks[k]))
            file = store.file(self.keys[k])
            self.warnings.append(f"{file}: {error}; the cases at {speeds} were computed again")
            return
        if record is not None:
            self.finished[k] = [CaseResult(*case) for case in record["cases"]]

    @property
    def missing(self) -> list[int]:
        """Indices of the chunks still to compute, highest speeds first: they take longest."""
        return [k for k in reversed(range(len(self.chunks))) if k not in self.finished]

    def cases(self) -> list[CaseResult]:
        """Results of all cases, by ascending speed."""
        return [case for k in range(len(self.chunks)) for case in self.finished[k]]

    def collect(self, executor: Executor | None, workers: int) -> None:
        """Compute the missing chunks by an executor, or by `workers` processes of our own.

        Raises
        ------
        SweepInterrupted
            If the executor breaks.
        """
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
                self._record(k, solve_chunk(self.request, self.chunks[k]))
                self._report()

    def _submit(self, executor: Executor, missing: list[int]) -> None:
        """Compute chunks by an executor; after an error record the finished ones and cancel the rest."""
        try:
            for k in missing:
                future = self._call_executor(executor.submit, _return_errors, self.request, self.chunks[k])
                self.futures[future] = k
            for future in as_completed(list(self.futures)):
                cases = self._call_executor(future.result)
                self._record(self.futures.pop(future), cases)
                self._report()
        finally:
            self._cancel_pending()

    def _call_executor(self, action: Callable[..., Any], *args: Any) -> Any:
        """Call the executor; an error that it raises is its own, because tasks return theirs."""
        try:
            return action(*args)
        except Exception as error:
            self._cancel_pending()
            raise SweepInterrupted(*self._count_cases(), stored=self.store is not None) from error

    def _cancel_pending(self) -> None:
        """Cancel chunks that have not begun, and record those that have finished meanwhile."""
        for future in self.futures:
            future.cancel()
        while self.futures:
            future, k = self.futures.popitem()
            if (
                future.done()
                and not future.cancelled()
                and isinstance(future.exception() or future.result(), list)
            ):
                self._record(k, future.result())

    def _record(self, k: int, cases: list[CaseResult] | Exception) -> None:
        """Store the cases of chunk k, or raise the error of its task."""
        if isinstance(cases, Exception):
            raise cases
        if self.store is not None:
            self.store.write(
                self.keys[k], {"speeds": self.chunks[k], "fields": CaseResult._fields, "cases": cases}
            )
        self.finished[k] = cases

    def _count_cases(self) -> tuple[int, int]:
        """Number of cases that are done, and of all."""
        return sum(len(self.chunks[k]) for k in self.finished), sum(map(len, self.chunks))

    def _report(self) -> None:
        if self.progress is not None:
            self.progress(*self._count_cases())


def _return_errors(request: SweepRequest, speeds: tuple[float, ...]) -> list[CaseResult] | Exception:
    """Solve a chunk and return its error, if any, so that errors raised are the executor's own."""
    try:
        return solve_chunk(request, speeds)
    except Exception as error:
        return error
