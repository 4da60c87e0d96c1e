"""Worker processes: an executor that replaces processes that die."""

from __future__ import annotations

import logging
import os
import pickle
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, CancelledError, Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from functools import cache
from typing import Any, BinaryIO

from threadpoolctl import ThreadpoolController

ATTEMPTS = 3  # number of processes that a task may kill before it counts as failed
_SERVE = (
    "import signal; signal.signal(signal.SIGINT, signal.SIG_IGN); "  # the calling process handles Ctrl-C
    "from beamdyn.common.parallel.workers import serve; serve()"
)
_log = logging.getLogger(__name__)


class WorkerDied(BrokenExecutor):
    """Raised when a task has killed every process that ran it."""


class Workers(ThreadPoolExecutor):
    """An executor of worker processes: each of its threads controls one process, and replaces it if it dies.

    Only the task that the dead process was running is run again.  The processes are new interpreters, which
    is safe if the caller has threads.  Unlike processes of `multiprocessing` they do not import the caller's
    script, which therefore needs no ``if __name__ == "__main__"``.  The functions that they run must be
    importable: functions defined in the script itself are not.  The processes end when the caller ends, for
    whatever reason.

    Parameters
    ----------
    count : int
        Number of processes.
    """

    def __init__(self, count: int) -> None:
        super().__init__(count, thread_name_prefix="beamdyn-worker")
        self.count = count
        self._own = threading.local()
        self._processes: list[_Process] = []
        self._lock = threading.Lock()
        self._stopped = False

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Submit the call fn(*args, **kwargs), to be run in a worker process."""
        return super().submit(self._run, pickle.dumps((fn, args, kwargs)))

    def stop(self) -> None:
        """Kill all worker processes and drop all tasks."""
        with self._lock:
            self._stopped = True
            for process in self._processes:
                process.kill()
        self.shutdown(wait=False, cancel_futures=True)

    def __exit__(self, kind: type[BaseException] | None, *rest: Any) -> None:
        if kind is not None:
            self.stop()
        super().__exit__(kind, *rest)
        for process in self._processes:
            process.close()

    def _run(self, task: bytes) -> Any:
        code = 0
        for _ in range(ATTEMPTS):
            process = self._process()
            try:
                return process.run(task)
            except (EOFError, BrokenPipeError):
                code = process.close()
                self._own.process = None
                if not self._stopped:
                    died = "worker process %d died (exit code %d): its task runs again"
                    _log.warning(died, process.pid, code)
        raise WorkerDied(f"a task ended {ATTEMPTS} worker processes (exit code {code}): out of memory?")

    def _process(self) -> _Process:
        """Return the worker process of this thread, which is started when first needed."""
        with self._lock:
            if self._stopped:
                raise CancelledError
            if getattr(self._own, "process", None) is None:
                self._own.process = _Process()
                self._processes.append(self._own.process)
            return self._own.process


class _Process:
    """A process that reads pickled tasks from its standard input, and writes results to its output."""

    def __init__(self) -> None:
        path = os.pathsep.join(p or os.getcwd() for p in sys.path)
        command, env = [sys.executable, "-P", "-c", _SERVE], os.environ | {"PYTHONPATH": path}
        self._popen = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=env)
        assert self._popen.stdin is not None and self._popen.stdout is not None
        self._tasks, self._answers = self._popen.stdin, self._popen.stdout
        self.pid, self.kill = self._popen.pid, self._popen.kill

    def run(self, task: bytes) -> Any:
        """Run a task and return its result; raise EOFError or BrokenPipeError if the process has died."""
        _send(self._tasks, task)
        done, result = pickle.loads(_receive(self._answers))
        if not done:
            raise result
        return result

    def close(self) -> int:
        """End the worker process, and return its exit code."""
        for stream in (self._tasks, self._answers):
            with suppress(BrokenPipeError):  # raised if the process has died before it received the last data
                stream.close()
        return self._popen.wait()


def serve() -> None:
    """Run tasks that arrive on standard input, until it is closed or the results are no longer read."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # standard output is redirected, so that texts printed by a task do not mix with results
    while True:
        try:
            task = _receive(sys.stdin.buffer)
            _send(answers, _answer(task))
        except EOFError:
            return
        except BrokenPipeError:  # the calling process was killed
            os._exit(0)  # ends the process without another attempt to write buffered data


def _answer(task: bytes) -> bytes:
    try:
        function, args, kwargs = pickle.loads(task)
        return pickle.dumps((True, function(*args, **kwargs)))
    except Exception as error:
        try:
            return pickle.dumps((False, error))
        except Exception:  # the error object itself cannot be pickled
            return pickle.dumps((False, RuntimeError(repr(error))))


def _send(stream: BinaryIO | Any, message: bytes) -> None:
    stream.write(len(message).to_bytes(8, "big") + message)
    stream.flush()


def _receive(stream: BinaryIO | Any) -> bytes:
    head = stream.read(8)
    size = int.from_bytes(head, "big")
    message = stream.read(size) if len(head) == 8 else b""
    if len(head) < 8 or len(message) < size:
        raise EOFError
    return message


# Threads of BLAS ----------------------------------------------------------------------------------


# Finds the loaded libraries that start threads; cached, as the search takes milliseconds.
_find_libraries = cache(ThreadpoolController)
_blas_lock = threading.Lock()
_blas_users = 0
_blas_limits: Any = None


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Limit BLAS to one thread in this context; if several threads enter it, until the last thread leaves."""
    global _blas_users, _blas_limits
    with _blas_lock:
        _blas_users += 1
        if _blas_users == 1:
            _blas_limits = _find_libraries().limit(limits=1)
    try:
        yield
    finally:
        with _blas_lock:
            _blas_users -= 1
            if _blas_users == 0:
                _blas_limits.restore_original_limits()
