"""The program ``beamdyn``: what is heavy is imported by the commands that need it."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from functools import cache

from cyclopts import App

from beamdyn._version import __version__
from beamdyn.analyses import COMMANDS, analyses
from beamdyn.common.edge import program


@cache
def command_line(command: str = "") -> App:
    """The program: with the command of one analysis alone, which starts sooner, or with all commands."""
    app = App(
        name="beamdyn",
        version=__version__,
        help="""Vibration of rotating cantilevers: natural frequencies, buckling, motion in time, resonance.

A scene is a TOML file with units; `beamdyn COMMAND --help` lists the options of a command.""",
        help_epilogue=program.EXIT_CODES,
        help_format="markdown",
        suppress_keyboard_interrupt=False,
    )
    alone = command in COMMANDS
    for name, each in analyses((command,) if alone else tuple(COMMANDS)).items():
        app.command(each.command(), name=name, help_epilogue=program.examples(*each.examples))
    if not alone:
        from beamdyn.cli import campbell_diagram, decks, interactive, published

        for add in (campbell_diagram.add, decks.add, interactive.add, published.add, program.add_completion):
            add(app)
    return app


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; see `beamdyn.common.edge.program.run`."""
    given = sys.argv[1:] if arguments is None else [*arguments]
    return program.run(command_line(*[name for name in given[:1] if name in COMMANDS]), given)
