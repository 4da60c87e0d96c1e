"""Worker processes that compute results, so that the server stays responsive and can stop computations."""

from __future__ import annotations

import asyncio
import gc
import os
import pickle
import signal
import sys
from asyncio import subprocess
from collections import deque
from collections.abc import Callable, Mapping
from concurrent.futures import BrokenExecutor
from contextlib import suppress
from contextvars import copy_context
from functools import cache, partial
from threading import Thread
from time import sleep
from types import FrameType
from typing import Any, Protocol

from beamdyn.common.parallel.workers import serve
from beamdyn.common.screens.screens import Document, Program, Screen

LONGEST = 120.0  # time limit of a computation [s]
MEMORY = 800  # memory that a computation may use in addition to an idle process [MB]
_MOST = max(3, (os.cpu_count() or 1) + 1)  # largest number of processes, so that one stays free for others
_NICE = 5  # niceness of the processes: the server and the browser have higher priority
_HEEDS = 0.3  # time that an interrupted process has to stop its task, before it is terminated [s]
_AGAIN = 0.03  # interval of repeated interrupts [s]: a process ignores them during imports
_SOON_FREE = (
    0.05  # time for which the next task waits for an interrupted process before it uses another one [s]
)
_SPARE = 0.5  # running time of a task after which an idle process is started for other tasks [s]
_SERVE = "from beamdyn.common.screens.processes import serve_tasks; serve_tasks({caller})"
_IMPORTING = "<frozen importlib._bootstrap>"  # file name of Python's code that imports modules
_ONE_THREAD = dict.fromkeys(("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"), "1")

Task = Callable[..., Any]  # called as task(document, screen, *rest), with a `Document` and one of its screens


class TakesTooLong(Exception):
    """Raised when a computation takes more time or memory than allowed."""


class RunsTasks(Protocol):
    """Interface of objects that run tasks: `Processes`, or a `Share` of them for one page."""

    def submit(self, task: Task, document: Document, screen: Screen, *rest: Any) -> asyncio.Future[Any]:
        """Start ``task(document, screen, *rest)``; cancelling the future stops the task."""
        ...


class Processes:
    """Worker processes of one program, which belong to the event loop in which they are first used.

    Each process runs one task at a time; other tasks wait in a queue.  A cancelled task is interrupted; if it
    does not stop, or takes too long, its process is terminated and replaced.  The first process starts when
    `start` is called, further processes start when all are busy.  All of them end when the calling process
    ends, for whatever reason.

    Parameters
    ----------
    make : callable
        Function that makes the program; it must be importable, since each process calls it.
    longest : float
        Time limit of a task [s].
    most : int
        Largest number of processes.
    """

    def __init__(self, make: Callable[[], Program], longest: float = LONGEST, most: int = _MOST) -> None:
        self.make, self.longest, self.most = make, longest, most
        self._idle: list[_Worker] = []
        self._all: set[_Worker] = set()
        self._waiting: deque[asyncio.Future[_Worker]] = deque()
        self._starts: set[asyncio.Task[None]] = set()
        self._interrupted: set[asyncio.Task[None]] = set()
        self._count = 0  # number of processes, including those that are being started

    @property
    def ids(self) -> set[int]:
        """Return the ids of the present processes in the operating system."""
        return {worker.process.pid for worker in self._all}

    def submit(self, task: Task, document: Document, screen: Screen, *rest: Any) -> asyncio.Future[Any]:
        """Start ``task(document, screen, *rest)``; cancelling the future stops the task.

        Parameters
        ----------
        task : callable
            An importable function.
        document, screen : Document, Screen
            A kind of input file of the program, and one of its screens.
        *rest
            Further arguments, which can be pickled.

        Returns
        -------
        asyncio.Future
            Future of the result.  It raises the errors of the task, `TakesTooLong`, or `BrokenExecutor` if
            the process has died.
        """
        wanted = pickle.dumps((_do, (self.make, task, document.name, screen.name, *rest), {}))
        return asyncio.ensure_future(self._run(wanted))

    def start(self) -> None:
        """Start a process in advance, as a start takes a second; do nothing if there are enough."""
        if self._count < self.most:
            self._count += 1
            start = asyncio.ensure_future(self._start())
            self._starts.add(start)
            start.add_done_callback(self._starts.discard)

    async def close(self) -> None:
        """Terminate all processes; no new ones are started."""
        self.most = 0
        under_way = self._starts | self._interrupted
        for task in under_way:
            task.cancel()
        await asyncio.gather(*under_way, return_exceptions=True)
        for worker in [*self._all]:
            await self._end(worker)

    async def _start(self) -> None:
        try:
            worker = await _Worker.started()
        except OSError as error:
            self._count -= 1
            return self._fail(str(error))
        self._all.add(worker)
        try:
            await worker.ask(pickle.dumps((_prepare, (self.make, MEMORY), {})))
        except (EOFError, OSError):
            await self._end(worker)
            return self._fail("it ended while it started")
        except asyncio.CancelledError:
            await self._end(worker)
            raise
        self._free(worker)

    def _fail(self, why: str) -> None:
        """Let all waiting tasks fail, as no process can be started."""
        while self._waiting:
            if not (place := self._waiting.popleft()).done():
                place.set_exception(BrokenExecutor(f"no process can be started to compute the result: {why}"))

    async def _run(self, wanted: bytes) -> Any:
        worker = await self._idle_worker()
        keep_one_idle = asyncio.get_running_loop().call_later(
            _SPARE, lambda: None if self._idle else self.start()
        )
        asked = asyncio.ensure_future(worker.ask(wanted))
        try:
            async with asyncio.timeout(self.longest):
                answer = await asyncio.shield(asked)
        except asyncio.CancelledError:
            self._interrupted.add(task := asyncio.ensure_future(self._interrupt(worker, asked)))
            task.add_done_callback(self._interrupted.discard)
            raise
        except BaseException as error:
            asked.cancel()
            await self._replace(worker)
            if isinstance(error, TimeoutError):
                raise TakesTooLong(f"it takes more than {self.longest:g} s") from None
            if isinstance(error, EOFError | OSError):
                raise BrokenExecutor("the process that computed the result died: out of memory?") from None
            raise
        finally:
            keep_one_idle.cancel()
        self._free(worker)
        done, result = pickle.loads(answer)
        if done:
            return result
        if isinstance(result, MemoryError):
            raise TakesTooLong(f"it takes more than {MEMORY} MB of memory")
        raise result

    async def _interrupt(self, worker: _Worker, asked: asyncio.Future[bytes]) -> None:
        """Interrupt the task of a process, and make the process free; terminate it if the task goes on."""
        try:
            async with asyncio.timeout(_HEEDS):
                while not asked.done():
                    worker.interrupt()
                    await asyncio.wait([asked], timeout=_AGAIN)
                await asked
        except (TimeoutError, EOFError, OSError):
            asked.cancel()
            await self._replace(worker)
        except asyncio.CancelledError:
            asked.cancel()
            await self._end(worker)
            raise
        else:
            self._free(worker)

    async def _replace(self, worker: _Worker) -> None:
        await self._end(worker)
        self.start()

    async def _idle_worker(self) -> _Worker:
        """Return an idle process; if there is none, start one, and return the first that becomes free.

        A process that has just been interrupted will soon be free, and has already imported the necessary
        modules.
        """
        if self._interrupted:
            await asyncio.wait(self._interrupted, timeout=_SOON_FREE, return_when=asyncio.FIRST_COMPLETED)
        while self._idle:
            worker = self._idle.pop()
            if worker.process.returncode is None:
                return worker
            await self._end(worker)
        self.start()
        self._waiting.append(place := asyncio.get_running_loop().create_future())
        try:
            return await place
        except asyncio.CancelledError:
            # If the task was cancelled just when it got a process, the process is free for another task.
            if place.done() and not place.cancelled():
                self._free(place.result())
            raise

    def _free(self, worker: _Worker) -> None:
        while self._waiting:
            if not (place := self._waiting.popleft()).done():
                return place.set_result(worker)
        self._idle.append(worker)

    async def _end(self, worker: _Worker) -> None:
        if worker in self._all:
            self._all.remove(worker)
            self._count -= 1
        with suppress(ProcessLookupError):
            worker.process.kill()
        await worker.process.wait()


class Share:
    """The processes as one page may use them: never all, so that one is left for other pages.

    Parameters
    ----------
    solver : RunsTasks
        The processes.
    most : int
        Number of tasks of the page that may run at a time; others wait in a queue.
    """

    def __init__(self, solver: RunsTasks, most: int = _MOST - 1) -> None:
        self._solver, self._room = solver, asyncio.Semaphore(most)

    def submit(self, task: Task, document: Document, screen: Screen, *rest: Any) -> asyncio.Future[Any]:
        """Start ``task(document, screen, *rest)``, or queue it; cancelling the future stops the task."""

        async def run() -> Any:
            async with self._room:
                return await self._solver.submit(task, document, screen, *rest)

        return asyncio.ensure_future(run())


class _Worker:
    """A process that reads pickled tasks from standard input and writes results to standard output."""

    def __init__(self, process: subprocess.Process) -> None:
        assert process.stdin is not None and process.stdout is not None
        self.process, self._tasks, self._answers = process, process.stdin, process.stdout

    @classmethod
    async def started(cls) -> _Worker:
        path = os.pathsep.join(p or os.getcwd() for p in sys.path)
        environment = {**os.environ, **_ONE_THREAD, "PYTHONPATH": path}
        given = [sys.executable, "-P", "-c", _SERVE.format(caller=os.getpid())]
        pipe = subprocess.PIPE
        return cls(await asyncio.create_subprocess_exec(*given, stdin=pipe, stdout=pipe, env=environment))

    async def ask(self, task: bytes) -> bytes:
        """Return the pickled result of a task; raise `EOFError` or `OSError` if the process dies."""
        self._tasks.write(len(task).to_bytes(8, "big") + task)
        await self._tasks.drain()
        return await self._answers.readexactly(int.from_bytes(await self._answers.readexactly(8), "big"))

    def interrupt(self) -> None:
        """Interrupt the task of the process; raise `OSError` if the signal cannot be sent."""
        if not hasattr(signal, "SIGUSR1"):  # Windows has no such signal
            raise OSError
        self.process.send_signal(signal.SIGUSR1)


# Code that runs in a worker process -----------------------------------------------------------------------


class _NoLongerWanted(BaseException):
    """Raised within a cancelled task; a BaseException, which the task's `except Exception` does not catch."""


class _Interrupts:
    """Handles interrupts of tasks; ignores interrupts between tasks and during an import.

    A module whose import is interrupted would stay half imported, and later tasks would fail.
    """

    _at_task = False

    def listen(self) -> None:
        """Install the handler of the signal that `_Worker.interrupt` sends."""
        if hasattr(signal, "SIGUSR1"):
            signal.signal(signal.SIGUSR1, self._come)

    def _come(self, _: int, frame: FrameType | None) -> None:
        if self._at_task and not _imports(frame):
            self._at_task = False
            raise _NoLongerWanted

    def run(self, task: Callable[[], Any]) -> Any:
        """Run a task and return its result; None if it is interrupted, as the result is then not needed.

        The task has its own copy of context variables, such as the one of `few_digits`, so that its settings
        do not affect later tasks.
        """
        try:
            self._at_task = True
            result = copy_context().run(task)
            self._at_task = False
        except _NoLongerWanted:
            return None
        finally:
            self._at_task = False
        return result


def _imports(frame: FrameType | None) -> bool:
    """Return whether a module is being imported in a stack frame or in one of its callers."""
    while frame is not None and frame.f_code.co_filename != _IMPORTING:
        frame = frame.f_back
    return frame is not None


_INTERRUPTS = _Interrupts()


def serve_tasks(caller: int) -> None:
    """Run tasks that arrive on standard input; end when the calling process ends, even within a task."""

    def end_with_caller() -> None:  # in a thread: a running task does not notice the end of standard input
        while os.name == "nt" or os.getppid() == caller:  # on Windows the parent's id never changes
            sleep(1.0)
        os._exit(1)

    _INTERRUPTS.listen()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the calling process handles Ctrl-C
    if hasattr(os, "nice"):
        os.nice(_NICE)
    Thread(target=end_with_caller, daemon=True).start()
    serve()


def _prepare(make: Callable[[], Program], memory: int) -> None:
    """Import the program; then limit the memory of this process to `memory` [MB] more than now.

    What has been imported is left out of garbage collection, which would take 0.1 s.  Beyond the limit
    Python raises `MemoryError`. Systems that cannot limit memory have no limit.
    """
    _screens(make)
    gc.freeze()
    try:
        import resource  # this module does not exist on Windows

        with open("/proc/self/statm") as file:
            data = int(file.read().split()[5]) * resource.getpagesize()
    except (ImportError, OSError):
        return
    limit = data + memory * 2**20
    resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))


def _do(make: Callable[[], Program], task: Task, document: str, screen: str, *rest: Any) -> Any:
    """Run a task for a `Document` (a kind of file) and one of its screens, both given by name."""
    return _INTERRUPTS.run(partial(task, *_screens(make)[document, screen], *rest))


@cache
def _screens(make: Callable[[], Program]) -> Mapping[tuple[str, str], tuple[Document, Screen]]:
    return {(d.name, s.name): (d, s) for d in make().documents for s in d.screens}
