"""Fixtures that several modules of unit tests use."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from beamdyn.cli import main


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Callable[..., tuple[int, str, str]]:
    """Return a function that runs a command of beamdyn in this process: exit code, output and messages."""

    def run(*arguments: object) -> tuple[int, str, str]:
        code = main([str(a) for a in arguments])
        return code, *capsys.readouterr()

    return run
