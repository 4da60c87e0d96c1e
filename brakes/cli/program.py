"""The program ``brakes``."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from importlib.metadata import version

from cyclopts import App

from beamdyn.common.edge import program

app = App(
    name="brakes",
    version=lambda: version("beamdyn"),
    help="""Statics of brake mechanisms: bicycle calipers, drum brakes, a forklift's duo-servo brake.

Inputs are TOML files with units; `brakes COMMAND --help` lists the options of a command.""",
    help_epilogue=program.EXIT_CODES,
    help_format="markdown",
    suppress_keyboard_interrupt=False,
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; see `beamdyn.common.edge.program.run`."""
    return program.run(app, arguments)


def warn(warnings: Iterable[str]) -> None:
    """Print warnings on standard error."""
    program.warn("brakes", warnings)
