"""The command that starts the interactive program."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cyclopts import App

from beamdyn.common.screens.app_command import add_command

if TYPE_CHECKING:
    from beamdyn.common.screens.screens import Program

_ABOUT = "The interactive program in the browser: frequencies, rotor, mode shapes, responses of a beam."


def make_program() -> Program:
    """The program, imported when it is wanted."""
    from beamdyn.app.program import BEAMDYN

    return BEAMDYN


def add(app: App) -> None:
    """Give a program's command line the command `app`."""
    add_command(app, make_program, port=8080, about=_ABOUT)
