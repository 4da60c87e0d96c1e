"""The commands of ``beamdyn``; each imports only its own module, and listing them imports none."""

from __future__ import annotations

import ast
import sys
from collections.abc import Sequence
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from cyclopts import App

from beamdyn._version import __version__
from beamdyn.analyses import COMMANDS, analyses
from beamdyn.common.edge import exit_codes
from beamdyn.common.screens.app_command import add_command

if TYPE_CHECKING:
    from beamdyn.common.screens.screens import Program

# Commands that are not analyses of a scene: module that adds each command, and function that it runs.
_OTHERS = {
    "campbell": ("campbell_diagram", "campbell"),
    "import": ("decks", "import_deck"),
    "reproduce": ("reproduce_command", "reproduce"),
}
_SCREENS = "The interactive program in the browser: frequencies, rotor, mode shapes, responses of a beam."


def make_program() -> Program:
    """Import and return the interactive program, when it is needed."""
    from beamdyn.app.program import BEAMDYN

    return BEAMDYN


@cache
def command_line(command: str = "", *, listed: bool = False) -> App:
    """Make the command line with one command or all; if `listed`, only with names and help."""
    app = App(
        name="beamdyn",
        version=__version__,
        help="""Vibration of rotating cantilevers: natural frequencies, buckling, motion in time, resonance.

A scene is a TOML file with units; `beamdyn COMMAND --help` lists the options of a command.""",
        help_epilogue=exit_codes.EXIT_CODES,
        help_format="markdown",
        suppress_keyboard_interrupt=False,
    )
    for name in [command] if command else [*COMMANDS, *_OTHERS]:
        if listed:
            app.command(App(name=name, help=_question(name)))
        elif name in COMMANDS:
            each = analyses((name,))[name]
            app.command(each.command(), name=name, help_epilogue=exit_codes.examples(*each.examples))
        else:
            module, function = _OTHERS[name]
            made = vars(import_module(f"beamdyn.cli.{module}"))
            app.command(made[function], name=name, help_epilogue=exit_codes.examples(made["EXAMPLE"]))
    if not command:
        add_command(app, make_program, port=8080, about=_SCREENS)
        exit_codes.add_completion(app)
    return app


def _question(command: str) -> str:
    """Return the first line of a command's function docstring, read from source without imports."""
    if command in COMMANDS:
        file, function = f"analyses/{COMMANDS[command]}.py", command.replace("-", "_")
    else:
        file, function = f"cli/{_OTHERS[command][0]}.py", _OTHERS[command][1]
    return _first_lines(Path(__file__).parents[1] / file)[function]


@cache
def _first_lines(file: Path) -> dict[str, str]:
    """Return the first lines of the docstrings of a module's functions, by name of the function."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    functions = (node for node in tree.body if isinstance(node, ast.FunctionDef))
    return {each.name: (ast.get_docstring(each) or "").partition("\n")[0] for each in functions}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; see `beamdyn.common.edge.exit_codes.run`."""
    given = sys.argv[1:] if arguments is None else [*arguments]
    command = next((word for word in given if not word.startswith("-")), "")
    if command in COMMANDS or command in _OTHERS:
        return exit_codes.run(command_line(command), given)
    return exit_codes.run(command_line(listed=command != "completion"), given)
