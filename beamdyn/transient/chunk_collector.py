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
from beamdyn.transient.chunks import CaseResult, SweepRequest, solve_chunk

VERSIONS = (__version__, np.__version__, scipy.__version__)  # whose bits are stored

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


class ChunkCollector:
    """Computes the chunks of a sweep, or reads them from a store.

    Parameters
    ----------
    request : SweepRequest
        The request.
    chunks : list of tuple of float
        Speeds of each chunk [rad/s].
    store : Store, optional
        Where finished chunks are kept.
    progress : callable, optional
        Called with the number of finished cases and of all.
    """

    def __init__(
        self,
        request: SweepRequest,
        chunks: list[tuple[float, ...]],
        store: Store | None,
        progress: Progress | None,
    ) -> None:
        self.request, self.chunks, self.store, self.progress = request, chunks, store, progress
        self.known: dict[int, list[CaseResult]] = {}
        self.futures: dict[Future[Any], int] = {}
        if store is not None:
            self.keys = [fingerprint(VERSIONS, request, speeds) for speeds in chunks]
            stored = ((k, store.read(key)) for k, key in enumerate(self.keys))
            self.known = {k: [CaseResult(*c) for c in record["cases"]] for k, record in stored if record}

    @property
    def missing(self) -> list[int]:
        """Chunks still to compute, those of high speeds first: they take longest."""
        return [k for k in reversed(range(len(self.chunks))) if k not in self.known]

    def cases(self) -> list[CaseResult]:
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
                self._keep(k, solve_chunk(self.request, self.chunks[k]))
                self._report()

    def _submit(self, executor: Executor, missing: list[int]) -> None:
        """Compute chunks by an executor; at an error keep what is finished and cancel the rest."""
        try:
            for k in missing:
                future = self._ask(executor.submit, _return_errors, self.request, self.chunks[k])
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

    def _keep(self, k: int, found: list[CaseResult] | Exception) -> None:
        if isinstance(found, Exception):
            raise found
        if self.store is not None:
            self.store.write(
                self.keys[k], {"speeds": self.chunks[k], "fields": CaseResult._fields, "cases": found}
            )
        self.known[k] = found

    def _count(self) -> tuple[int, int]:
        """Cases that are done, and all."""
        return sum(len(self.chunks[k]) for k in self.known), sum(map(len, self.chunks))

    def _report(self) -> None:
        if self.progress is not None:
            self.progress(*self._count())


def _return_errors(request: SweepRequest, speeds: tuple[float, ...]) -> list[CaseResult] | Exception:
    """Solve a chunk; return its error, for what an executor raises is its own."""
    try:
        return solve_chunk(request, speeds)
    except Exception as error:
        return error
