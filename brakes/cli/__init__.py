"""The command ``brakes``."""

from beamdyn.common.edge.exit_codes import add_completion
from brakes.cli import commands  # noqa: F401  (it adds the commands)
from brakes.cli.commands import app, main

__all__ = ["app", "main"]

add_completion(app)
