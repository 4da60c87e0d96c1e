"""The command that starts the interactive program."""

from __future__ import annotations

from typing import TYPE_CHECKING

from beamdyn.common.screens.server import add_command
from brakes.cli.answering import app

if TYPE_CHECKING:
    from beamdyn.common.screens.screens import Program


def make_program() -> Program:
    """The program, imported when it is wanted."""
    from brakes.app.program import BRAKES

    return BRAKES


add_command(
    app,
    make_program,
    port=8081,
    about="The interactive program in the browser: forklift, drum brake, calipers, any mechanism.",
)
