"""The command ``beamdyn``."""

from typing import Any

from beamdyn.cli.commands import command_line, main
from beamdyn.common.edge.exit_codes import BAD_INPUT, DONE, INTERRUPTED, NO_ANSWER

__all__ = ["BAD_INPUT", "DONE", "INTERRUPTED", "NO_ANSWER", "main"]


def __getattr__(name: str) -> Any:
    """Make the command line with all commands when the attribute `app` is first accessed."""
    if name != "app":
        raise AttributeError(f"module 'beamdyn.cli' has no attribute {name!r}")
    return command_line()
