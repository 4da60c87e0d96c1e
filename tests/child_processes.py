"""Processes that a process has started (Linux)."""

import contextlib
from pathlib import Path

import pytest

by_proc = pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="finds the workers in /proc")


def children(pid):
    """Its children, but for that by which multiprocessing tidies up, which outlives a pool."""
    found = []
    for task in Path(f"/proc/{pid}/task").glob("*/children"):
        with contextlib.suppress(FileNotFoundError):  # a thread that has just ended
            found += [int(child) for child in task.read_text().split()]
    return [child for child in found if "resource_tracker" not in command_of(child)]


def command_of(pid):
    """Its command line; empty if it has ended."""
    try:
        return Path(f"/proc/{pid}/cmdline").read_text()
    except (FileNotFoundError, ProcessLookupError):
        return ""
