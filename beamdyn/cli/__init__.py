"""The command ``beamdyn``."""

from beamdyn.analyses.values import parse_speeds
from beamdyn.cli.program import command_line, main
from beamdyn.common.edge.program import BAD_INPUT, DONE, INTERRUPTED, NO_ANSWER

__all__ = ["BAD_INPUT", "DONE", "INTERRUPTED", "NO_ANSWER", "command_line", "main", "parse_speeds"]
