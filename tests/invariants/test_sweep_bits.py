"""A sweep is the same to the bit: whatever computes it, in whatever order, interrupted or not."""

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from importlib.util import find_spec
from multiprocessing import get_context
from pathlib import Path

import pytest

import beamdyn as bd
from beamdyn.transient.transient import TransientRequest
from benchmarks.cases.scenes import AFTER_SHORT_SPIN_UP as WINDOW
from benchmarks.cases.scenes import SHORT_SPIN_UP as SCENE
from tests.child_processes import by_proc, children

ROOT = Path(__file__).parents[2]
SPEEDS = [0.0, 20.0, 40.0, 53.0, 55.0, 69.8, 90.0, 100.0, 120.0, 130.0, 149.0, 150.0]
unix = pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix")


def run(**options):
    return bd.sweep(SCENE, SPEEDS, WINDOW, chunk=2, **options)


def bits(found):
    return (
        [a.tobytes() for a in (found.peaks, found.largest, found.time_error)],
        found.mode_error,
        found.status,
    )


def chunks(store):
    """When each chunk was stored."""
    return {p.name: p.stat().st_mtime_ns for p in store.glob("*.json") if p.name != "store.json"}


@pytest.fixture(scope="module")
def undisturbed():
    return bits(run())


class Backwards(Executor):
    """Does the last task first, when all are there."""

    def __init__(self, count):
        self.tasks, self.count = [], count

    def submit(self, fn, /, *args, **kwargs):
        self.tasks.append((future := Future(), fn, args))
        if len(self.tasks) == self.count:
            for future_, fn_, args_ in reversed(self.tasks):
                future_.set_result(fn_(*args_))
        return future


class Breaking(Executor):
    """Breaks after some tasks."""

    def __init__(self, good):
        self.good = good

    def submit(self, fn, /, *args, **kwargs):
        future = Future()
        self.good -= 1
        if self.good < 0:
            future.set_exception(BrokenExecutor("gone"))
        else:
            future.set_result(fn(*args))
        return future


def test_workers(undisturbed):
    assert bits(run(workers=2)) == undisturbed


def test_threads(undisturbed):
    with ThreadPoolExecutor(3) as executor:
        assert bits(run(executor=executor)) == undisturbed


@pytest.mark.slow
def test_processes_of_the_standard_library(undisturbed):
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as executor:
        assert bits(run(executor=executor)) == undisturbed


def test_order(undisturbed):
    assert bits(run(executor=Backwards(len(SPEEDS) // 2))) == undisturbed


def test_a_store_is_read_back(undisturbed, tmp_path):
    assert bits(run(store=tmp_path / "s")) == undisturbed
    before = chunks(tmp_path / "s")
    assert bits(run(store=tmp_path / "s", executor=Breaking(0))) == undisturbed  # never asked
    assert chunks(tmp_path / "s") == before


def test_another_request_is_another_answer(tmp_path):
    run(store=tmp_path / "s")
    bd.sweep(SCENE, SPEEDS, WINDOW, chunk=2, store=tmp_path / "s", tolerance=1e-4)
    assert len(chunks(tmp_path / "s")) == 12


def test_a_broken_executor_is_named_and_the_same_call_resumes(undisturbed, tmp_path):
    store = tmp_path / "s"
    with pytest.raises(bd.SweepInterrupted, match="4 of 12 cases stored; the same call") as caught:
        run(store=store, executor=Breaking(2))
    assert (caught.value.done, caught.value.total) == (4, 12)
    assert isinstance(caught.value.__cause__, BrokenExecutor)
    before = chunks(store)
    assert len(before) == 2
    assert bits(run(store=store)) == undisturbed
    assert before.items() <= chunks(store).items()  # not computed twice


def test_without_a_store_the_error_says_so():
    with pytest.raises(bd.SweepInterrupted, match="give a store="):
        run(executor=Breaking(1))


@pytest.mark.parametrize("chunk", [1, 5, 12])
def test_chunks(undisturbed, chunk):
    assert bits(bd.sweep(SCENE, SPEEDS, WINDOW, chunk=chunk)) == undisturbed


def test_an_error_of_a_case_is_not_one_of_the_executor(monkeypatch):
    monkeypatch.setattr("beamdyn.transient.chunks._solve", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError), ThreadPoolExecutor(1) as executor:
        run(executor=executor)


def test_ctrl_c_keeps_what_is_finished(undisturbed, tmp_path):
    def interrupt(done, total):
        if done >= 4:
            raise KeyboardInterrupt

    start, others = time.monotonic(), children(os.getpid())
    with pytest.raises(KeyboardInterrupt):
        run(workers=2, store=tmp_path / "s", progress=interrupt)
    assert time.monotonic() - start < 10
    before = chunks(tmp_path / "s")
    assert 2 <= len(before) < 6
    assert children(os.getpid()) == others  # no process is left
    assert bits(run(store=tmp_path / "s")) == undisturbed
    assert before.items() <= chunks(tmp_path / "s").items()


def test_samples_of_an_interrupted_sweep_are_given_up(monkeypatch):
    """The motion that is under way ends, and no other begins: its thread and its hold on BLAS go with it."""
    begun, go_on, integrate = [], threading.Event(), TransientRequest.run

    def held(request):
        begun.append(threading.current_thread())
        assert go_on.wait(60)
        return integrate(request)

    def interrupt(done, total):
        while not begun:
            time.sleep(0.01)
        raise KeyboardInterrupt

    monkeypatch.setattr(TransientRequest, "run", held)
    with pytest.raises(KeyboardInterrupt), ThreadPoolExecutor(1) as executor:
        run(modes=2, executor=executor, progress=interrupt)
    go_on.set()
    begun[0].join(60)
    assert len(begun) == 1 and not begun[0].is_alive()


def test_one_process_samples_in_the_thread_that_ctrl_c_reaches(monkeypatch):
    threads, integrate = [], TransientRequest.run

    def noted(request):
        threads.append(threading.current_thread())
        return integrate(request)

    monkeypatch.setattr(TransientRequest, "run", noted)
    run(modes=2)
    assert {*threads} == {threading.current_thread()}


@by_proc
def test_a_worker_is_killed(undisturbed, tmp_path, caplog):
    killed, others = [], children(os.getpid())

    def kill(done, total):
        if done >= 2 and not killed:
            killed.append(max(set(children(os.getpid())) - set(others)))
            os.kill(killed[0], signal.SIGKILL)

    assert bits(run(workers=2, store=tmp_path / "s", progress=kill)) == undisturbed
    assert killed
    assert len([r for r in caplog.records if "its task runs again" in r.message]) <= 1
    assert len(chunks(tmp_path / "s")) == 6


PROGRAM = """
import sys
from tests.invariants.test_sweep_bits import run
run(workers=2, store=sys.argv[1], progress=lambda done, total: print(done, flush=True))
"""


def started(program, *arguments):
    return subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(program), *map(str, arguments)],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        text=True,
    )


@unix
@pytest.mark.slow
def test_the_whole_program_is_killed(undisturbed, tmp_path):
    with started(PROGRAM, tmp_path / "s") as program:
        for line in program.stdout:
            if int(line) >= 4:
                workers = children(program.pid)
                program.kill()
                break
    before = chunks(tmp_path / "s")
    assert 2 <= len(before) <= 6
    assert bits(run(workers=2, store=tmp_path / "s")) == undisturbed
    assert before.items() <= chunks(tmp_path / "s").items()
    end = time.monotonic() + 10
    while any(Path(f"/proc/{pid}").exists() for pid in workers) and time.monotonic() < end:
        time.sleep(0.05)
    assert not [pid for pid in workers if Path(f"/proc/{pid}").exists()]


DASK = """
import os, signal, sys
from dask.distributed import Client, LocalCluster
from tests.invariants.test_sweep_bits import bits, run

def main():
    killed = []
    cluster = LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with cluster, Client(cluster) as client:
        pids = list(client.run(os.getpid).values())
        def kill(done, total):
            if done >= 2 and not killed:
                killed.append(pids[0])
                os.kill(pids[0], signal.SIGKILL)
        found = run(executor=client.get_executor(), store=sys.argv[1], progress=kill)
    print("killed", len(killed), bits(found) == bits(run()))

if __name__ == "__main__":
    main()
"""


@unix
@pytest.mark.slow
@pytest.mark.skipif(find_spec("distributed") is None, reason="dask.distributed is not installed (extra dask)")
def test_a_dask_worker_is_killed(tmp_path):
    (tmp_path / "program.py").write_text(DASK)
    done = subprocess.run(
        [sys.executable, tmp_path / "program.py", tmp_path / "s"],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert "killed 1 True" in done.stdout, done.stderr
    assert len(chunks(tmp_path / "s")) == 6
