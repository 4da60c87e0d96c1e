"""The command `app`, which opens an interactive program in the browser."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated

from cyclopts import App, Parameter

from beamdyn.common.edge.exit_codes import examples
from beamdyn.common.screens import HOME

if TYPE_CHECKING:
    from beamdyn.common.screens.screens import Program

MISSING = "the interactive program needs NiceGUI: pip install 'beamdyn[app]'"
_LARGEST_PORT = 65535


def add_command(app: App, program: Callable[[], Program], port: int, about: str) -> None:
    """Add the command `app`, which opens an interactive program, to the command line of a program.

    Parameters
    ----------
    app : App
        Command line of the program.
    program : callable
        Function that makes the interactive program; called only if the required packages are installed.
    port : int
        Default port of the web server.
    about : str
        What the interactive program shows, in a sentence.
    """
    usual = port

    @app.command(
        name="app",
        help=f"{about} Ctrl-C ends it.",
        help_epilogue=examples(f"{app.name[0]} app", f"{app.name[0]} app --port 8090 --no-browser"),
    )
    def interactive(
        *,
        port: int = usual,
        host: str = HOME,
        browser: Annotated[bool, Parameter(negative="--no-browser")] = True,
    ) -> None:
        """Serve the interactive program.

        Parameters
        ----------
        port
            Port to serve on.
        host
            Address or name to serve on; only this computer can reach the default address. Requests to
            other names are refused.
        browser
            Open the browser.
        """
        if not 1 <= port <= _LARGEST_PORT:
            raise ValueError(f"--port = {port}: give a port from 1 to {_LARGEST_PORT}")
        try:
            from beamdyn.common.screens.server import serve
        except ModuleNotFoundError:
            raise ValueError(MISSING) from None
        serve(program, host, port, browser)
