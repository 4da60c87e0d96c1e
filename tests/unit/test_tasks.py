"""Tasks: who solves them, in which order they are taken, and what the runner keeps."""

import os
import sys
import time

import pytest

from beamdyn.common.parallel.tasks import Task, TaskRunner

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="processes of Unix")


def who(seconds: float) -> int:
    """The process that solves a task of some duration."""
    time.sleep(seconds)
    return os.getpid()


def solvers(workers: int, seconds: list[float]) -> dict[int, int]:
    """The process that has solved each task, by the task's place."""
    found: dict[int, int] = {}
    tasks = [Task(lambda s=s: s, 1, k) for k, s in enumerate(seconds)]
    runner = TaskRunner(workers)
    with runner.prepared(who, len(tasks)):
        runner.run(who, tasks, found.__setitem__)
    return found


def test_the_caller_solves_beside_one_process_fewer_than_there_are_workers() -> None:
    found = solvers(2, [0.05] * 40)
    assert sorted(found) == list(range(40))
    others = set(found.values()) - {os.getpid()}
    assert len(others) == 1 and os.getpid() in found.values()


def test_tasks_that_wait_for_a_busy_worker_are_taken_back() -> None:
    """The second waits behind the first, when the caller is done with the third."""
    found = solvers(2, [4.0, 0.0, 2.0])
    assert found[0] != os.getpid()
    assert found[1] == found[2] == os.getpid()


def test_one_worker_is_the_caller() -> None:
    assert set(solvers(1, [0.0] * 3).values()) == {os.getpid()}
