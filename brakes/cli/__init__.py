"""The command ``brakes``.  What is heavy is imported by the commands that need it."""

from beamdyn.common.edge.program import add_completion
from brakes.answers import STANDARD
from brakes.cli import caliper, forklift, interactive, published  # noqa: F401  (they add their commands)
from brakes.cli.answering import add_command, app, main

__all__ = ["app", "main"]

for _name, _help in STANDARD.items():
    add_command(app, _name, _help)
add_completion(app)
