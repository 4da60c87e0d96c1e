"""Tasks: who solves them, in which order they are taken, and what the runner keeps."""

import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from beamdyn.common.parallel.tasks import Task, TaskRunner

PATIENCE = 60.0  # with a process that starts, on a machine that does much else [s]
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="processes of Unix")


def who(_: object) -> int:
    """The process that solves a task."""
    return os.getpid()


def wait_until(true: Callable[[], bool]) -> None:
    """Wait until something is true, or for as long as there is patience."""
    deadline = time.monotonic() + PATIENCE
    while not true() and time.monotonic() < deadline:
        time.sleep(0.01)


def solvers(workers: int, parts: list[Any], solve: Callable[[Any], int] = who) -> dict[int, int]:
    """The process that has solved each task, by the task's place."""
    found: dict[int, int] = {}
    tasks = [Task(lambda part=part: part, 1, k) for k, part in enumerate(parts)]
    runner = TaskRunner(workers)
    with runner.prepared(solve, len(tasks)):
        runner.run(solve, tasks, found.__setitem__)
    return found


def wait_for_both(folder: Path) -> int:
    """The process that solves a part, when two processes have begun with one."""
    (folder / str(os.getpid())).touch()
    wait_until(lambda: len([*folder.iterdir()]) > 1)
    return os.getpid()


def test_the_caller_solves_beside_one_process_fewer_than_there_are_workers(tmp_path: Path) -> None:
    found = solvers(2, [tmp_path] * 40, wait_for_both)
    assert sorted(found) == list(range(40))
    others = set(found.values()) - {os.getpid()}
    assert len(others) == 1 and os.getpid() in found.values()


def meet(part: tuple[Path, str]) -> int:
    """The process that solves a part: the first waits for the second, the third for the first."""
    folder, name = part
    (folder / name).touch()
    awaited = {"first": "second", "third": "first"}.get(name)
    wait_until(lambda: not awaited or (folder / awaited).exists())
    return os.getpid()


def test_tasks_that_wait_for_a_busy_worker_are_taken_back(tmp_path: Path) -> None:
    """The second waits behind the first, when the caller is done with the third."""
    found = solvers(2, [(tmp_path, name) for name in ("first", "second", "third")], meet)
    assert found[0] != os.getpid()
    assert found[1] == found[2] == os.getpid()


def test_one_worker_is_the_caller() -> None:
    assert set(solvers(1, [None] * 3).values()) == {os.getpid()}
