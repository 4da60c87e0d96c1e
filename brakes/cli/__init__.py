"""The command ``brakes``.  What is heavy is imported by the commands that need it."""

from brakes.cli import caliper, drum, forklift, published  # noqa: F401  (they add their commands to the app)
from brakes.cli.program import app, main

__all__ = ["app", "main"]
