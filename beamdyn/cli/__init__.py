"""The command ``beamdyn``.  What is heavy is imported by the commands that need it."""

from beamdyn.analyses.values import parse_speeds
from beamdyn.cli import campbell_diagram, decks, interactive, published  # noqa: F401  (they add their commands)
from beamdyn.cli.program import app, main
from beamdyn.common.edge.program import BAD_INPUT, DONE, INTERRUPTED, NO_ANSWER, add_completion

__all__ = ["BAD_INPUT", "DONE", "INTERRUPTED", "NO_ANSWER", "app", "main", "parse_speeds"]

add_completion(app)
