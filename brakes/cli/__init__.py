"""The command ``brakes``.  What is heavy is imported by the commands that need it."""

from brakes.cli import (  # noqa: F401  (they add their commands to the app)
    caliper,
    drum,
    forklift,
    interactive,
    published,
)
from brakes.cli.program import app, main

__all__ = ["app", "main"]
