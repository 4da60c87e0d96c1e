"""The command that starts the interactive program."""

from __future__ import annotations

from typing import TYPE_CHECKING

from beamdyn.cli.program import app
from beamdyn.common.screens.server import add_command

if TYPE_CHECKING:
    from beamdyn.common.screens.screens import Program


def make_program() -> Program:
    """The program, imported when it is wanted."""
    from beamdyn.app.program import BEAMDYN

    return BEAMDYN


add_command(
    app,
    make_program,
    port=8080,
    about="The interactive program in the browser: frequencies, rotor, mode shapes, responses of a beam.",
)
