"""The program ``beamdyn``."""

from __future__ import annotations

from collections.abc import Sequence

from cyclopts import App

from beamdyn._version import __version__
from beamdyn.analyses import ANALYSES
from beamdyn.common.edge import program

app = App(
    name="beamdyn",
    version=__version__,
    help="""Vibration of rotating cantilevers: natural frequencies, buckling, motion in time, resonance.

A scene is a TOML file with units; `beamdyn COMMAND --help` lists the options of a command.""",
    help_epilogue=program.EXIT_CODES,
    help_format="markdown",
    suppress_keyboard_interrupt=False,
)


for each in ANALYSES.values():
    app.command(each.command(), name=each.name, help_epilogue=program.examples(*each.examples))


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; see `beamdyn.common.edge.program.run`."""
    return program.run(app, arguments)
