"""Worker processes: tasks, errors, death, interruption."""

import os
import signal
import subprocess
import sys
import time
from concurrent.futures import CancelledError, as_completed
from pathlib import Path

import pytest
from threadpoolctl import threadpool_info

from beamdyn.common.parallel.workers import WorkerDied, Workers, one_blas_thread

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix")


def logged(log, name, seconds):
    """A task that leaves a line in a log when it begins."""
    with open(log, "a") as file:
        file.write(f"{name} {os.getpid()}\n")
    time.sleep(seconds)
    return name


def held(log, name, go):
    """A task that leaves a line in a log when it begins, and ends when a file is there."""
    logged(log, name, 0.0)
    wait_for(Path(go).exists)
    return name


def begun(log):
    return [line.split() for line in Path(log).read_text().splitlines()] if Path(log).exists() else []


def wait_for(condition, seconds=60.0):
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.01)
    assert condition()


def gone(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return True
    return False


def fail(message):
    raise ZeroDivisionError(message)


def talk():
    print("this must not mix with the answers")
    return "said"


def end_process():
    os._exit(7)


def test_results_errors_and_prints():
    with Workers(1) as pool:
        assert pool.submit(os.getpid).result() != os.getpid()
        assert pool.submit(talk).result() == "said"
        with pytest.raises(ZeroDivisionError, match="by me"):
            pool.submit(fail, "by me").result()
        assert pool.submit(divmod, 7, 2).result() == (3, 1)


def test_only_the_task_in_flight_runs_again(tmp_path, caplog):
    log, go = tmp_path / "log", tmp_path / "go"
    with Workers(2) as pool:
        futures = [pool.submit(held, log, str(k), go) for k in range(6)]
        wait_for(lambda: len(begun(log)) == 2)  # no other begins before these may end
        name, pid = begun(log)[-1]
        os.kill(int(pid), signal.SIGKILL)
        go.touch()
        assert sorted(f.result() for f in as_completed(futures)) == list("012345")
    names = [n for n, _ in begun(log)]
    assert {n for n in names if names.count(n) > 1} == {name}
    assert len(names) == 7
    assert "its task runs again" in caplog.text


def test_a_task_that_ends_its_process_is_given_up():
    with Workers(1) as pool, pytest.raises(WorkerDied, match="exit code 7"):
        pool.submit(end_process).result()


def test_an_error_ends_the_processes_at_once(tmp_path):
    log = tmp_path / "log"
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt), Workers(2) as pool:
        futures = [pool.submit(logged, log, str(k), 60.0) for k in range(4)]
        wait_for(lambda: len(begun(log)) == 2)
        raise KeyboardInterrupt
    assert time.monotonic() - start < 10
    assert all(gone(int(pid)) for _, pid in begun(log))
    for future in futures:
        with pytest.raises(CancelledError):
            future.result()


KILLED = """
import os, signal, time
from beamdyn.common.parallel.workers import Workers

pool = Workers(1)
pool.submit(int).result()  # the process is there
pool.submit(time.sleep, 1.0)
time.sleep(0.3)
os.kill(os.getpid(), signal.SIGKILL)
"""


def test_a_process_whose_caller_is_killed_ends_without_a_word():
    """Nobody waits for its answer: a traceback would come after the prompt of the shell."""
    run = subprocess.run([sys.executable, "-c", KILLED], capture_output=True, text=True, timeout=60)
    assert run.returncode == -signal.SIGKILL
    assert run.stderr == ""


def test_blas_has_one_thread_until_the_last_leaves():
    before = [lib["num_threads"] for lib in threadpool_info()]
    with one_blas_thread():
        with one_blas_thread():
            pass
        assert {lib["num_threads"] for lib in threadpool_info()} <= {1}
    assert [lib["num_threads"] for lib in threadpool_info()] == before
