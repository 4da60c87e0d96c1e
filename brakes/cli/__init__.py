"""The command ``brakes``.  What is heavy is imported by the commands that need it."""

from brakes.cli.program import app, main

__all__ = ["app", "main"]
