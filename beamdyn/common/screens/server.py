"""Serving an interactive program on this computer."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import TYPE_CHECKING, Annotated

from cyclopts import App, Parameter

from beamdyn.common.edge.program import examples

if TYPE_CHECKING:
    from beamdyn.common.screens.processes import RunsTasks
    from beamdyn.common.screens.screens import Program

MISSING = "the interactive program needs NiceGUI: pip install 'beamdyn[app]'"
_HOME = "127.0.0.1"


def add_command(app: App, program: Callable[[], Program], port: int, about: str) -> None:
    """Give a program's command line the command `app`.

    Parameters
    ----------
    app : App
        The command line.
    program : callable
        Makes the interactive program; it is called when it is known that it can be shown.
    port : int
        Port, if no other is asked for.
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
        host: str = _HOME,
        browser: Annotated[bool, Parameter(negative="--no-browser")] = True,
    ) -> None:
        """Serve the interactive program.

        Parameters
        ----------
        port
            Port to serve on.
        host
            Address or name to serve on; only this computer can reach the usual one. Requests to other
            names are refused.
        browser
            Open the browser.
        """
        serve(program, host, port, browser)


def root_of(program: Program, solver: RunsTasks) -> Callable[[], Awaitable[None]]:
    """The function that builds the page for a client."""
    from beamdyn.common.screens.page import open_page
    from beamdyn.common.screens.processes import Share

    async def root() -> None:
        await open_page(program, Share(solver))

    return root


def serve(program: Callable[[], Program], host: str, port: int, browser: bool) -> None:
    """Serve until interrupted.

    Parameters
    ----------
    program : callable
        Makes the program, here and in each process that makes answers: a function of a module.  It is called
        when it is known that it can be shown.
    host : str
        Address to listen on.
    port : int
        Port, from 1 to 65535.
    browser : bool
        Open the browser.

    Raises
    ------
    ValueError
        If NiceGUI is missing, or the port is none or taken.
    """
    if not 1 <= port <= 65535:
        raise ValueError(f"--port = {port}: give a port from 1 to 65535")
    try:
        from nicegui import app, ui
    except ImportError:
        raise ValueError(MISSING) from None
    from beamdyn.common.edge.progress import quiet
    from beamdyn.common.screens.page import add_style_and_scripts
    from beamdyn.common.screens.processes import Processes
    from beamdyn.common.screens.request_guard import RequestGuard

    _check_free(host, port)
    made, processes = program(), Processes(program)
    app.add_middleware(RequestGuard, host=host)
    add_style_and_scripts(made)
    app.config.quasar_config["loadingBar"]["skipHijack"] = True  # the bar has no name; "Computing" is said
    app.on_startup(processes.start)
    app.on_shutdown(processes.close)
    with quiet():
        ui.run(
            root_of(made, processes),
            host=host,
            port=port,
            title=made.title,
            language="en-US",
            show=browser,
            reload=False,
            tailwind=False,  # it looks through the page after each change
            ws_per_message_deflate=False,  # each message would wait for it, on a way that is short
            reconnect_timeout=30.0,
        )


def _check_free(host: str, port: int) -> None:
    """Refuse an address that is blank or unknown, or cannot be listened on, before the server tries."""
    import socket

    remedy = f"give an address or a name of this computer, such as {_HOME}, or leave --host out"
    if not host.strip():
        raise ValueError(f'--host = "{host}": it is blank; {remedy}')
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    except (OSError, UnicodeError):  # the latter of labels that are empty or too long
        raise ValueError(f'--host = "{host}": no address is known for it; {remedy}') from None
    try:
        with socket.socket(family, socket.SOCK_STREAM) as trial:
            trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            trial.bind(address)
    except OSError as error:
        remedy = "give another --port" if host == _HOME else "give another --port, or leave --host out"
        raise ValueError(
            f"--host = {host}, --port = {port}: cannot listen there ({error.strerror}); {remedy}"
        ) from None
