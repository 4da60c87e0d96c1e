"""The command that starts the interactive program."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from brakes.cli.program import app


@app.command(name="app")
def interactive(
    *,
    port: int = 8081,
    host: str = "127.0.0.1",
    browser: Annotated[bool, Parameter(negative="--no-browser")] = True,
) -> None:
    """The interactive program: forklift, drum brake and caliper in the browser. Ctrl-C ends it.

    Parameters
    ----------
    port
        Port to serve on.
    host
        Address to serve on; only this computer can reach the usual one.
    browser
        Open the browser.
    """
    from beamdyn.common.app.server import serve

    serve(_program, host, port, browser)


def _program():
    from brakes.app.program import BRAKES

    return BRAKES
