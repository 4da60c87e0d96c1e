"""Serving an interactive program on this computer."""

from __future__ import annotations

import socket
from collections.abc import Awaitable, Callable

from nicegui import app, ui

from beamdyn.common.edge.progress import quiet
from beamdyn.common.screens import HOME
from beamdyn.common.screens.page import add_style_and_scripts, open_page
from beamdyn.common.screens.processes import Processes, RunsTasks, Share
from beamdyn.common.screens.request_guard import RequestGuard
from beamdyn.common.screens.screens import Program


def root_of(program: Program, solver: RunsTasks) -> Callable[[], Awaitable[None]]:
    """The function that builds the page for a client."""

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
        If the address is unknown or cannot be listened on, as where the port is taken.
    """
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
    remedy = f"give an address or a name of this computer, such as {HOME}, or leave --host out"
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
        remedy = "give another --port" if host == HOME else "give another --port, or leave --host out"
        raise ValueError(
            f"--host = {host}, --port = {port}: cannot listen there ({error.strerror}); {remedy}"
        ) from None
