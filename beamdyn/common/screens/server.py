"""Web server of an interactive program on this computer, which accepts requests of its own page only.

A foreign web page can reach a server on this computer through the user's browser in three ways.  Its host
name may be made to point to 127.0.0.1 ("DNS rebinding"), which shows in the header Host of the request.  It
may open a websocket or send a form, which shows in the header Origin.  It may contain a picture or a link,
which shows in the header Sec-Fetch-Site.  All three headers are checked here; starlette's
`TrustedHostMiddleware` checks only Host, and its earlier versions accept no address in brackets.  The web
framework NiceGUI would make a page for every path and method; all but the expected ones are refused here.

The header Content-Security-Policy forbids the page to load data from other servers, or to send data there.
NiceGUI needs three exceptions: the page starts with an embedded script ('unsafe-inline'), Vue compiles
templates and NiceGUI runs the program's own code ('unsafe-eval'), and elements contain styles
('unsafe-inline').  Therefore texts of users are shown only as plain text or escaped HTML.
"""

from __future__ import annotations

import re
import socket
from collections.abc import Awaitable, Callable
from ipaddress import ip_address

from nicegui import app, ui
from starlette.datastructures import Headers
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from beamdyn.common.edge.console import quiet
from beamdyn.common.screens import HOME
from beamdyn.common.screens.page import add_style_and_scripts, open_page
from beamdyn.common.screens.processes import Processes, RunsTasks, Share
from beamdyn.common.screens.screens import Program

_THIS_COMPUTER = ("127.0.0.1", "[::1]", "localhost")
_HOST = re.compile(r"(\[[0-9a-f:.]+\]|[a-z0-9._-]+)(:[0-9]+)?")
_POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline' 'unsafe-eval'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; font-src 'self' data:; connect-src 'self'{sockets}; object-src 'none'; "
    "base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
)
_GUARDS = (
    (b"x-frame-options", b"DENY"),
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
)


class RequestGuard:
    """ASGI middleware that refuses requests to foreign host names, and requests from other pages.

    Parameters
    ----------
    app : callable
        The ASGI application.
    host : str
        Address or name on which the program listens.  Requests may be addressed to it and to 127.0.0.1, [::1]
        and localhost.  If the program listens on all addresses, they may be addressed to any numerical
        address and to the name of the computer, but not to other names, which a foreign page would have.
    """

    def __init__(self, app: ASGIApp, host: str) -> None:
        self.app = app
        self.any_address = host == "" or (_is_address(host) and ip_address(host).is_unspecified)
        own = socket.gethostname() if self.any_address else f"[{host}]" if ":" in host else host
        self.names = tuple(dict.fromkeys((*_THIS_COMPUTER, own.lower())))

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it with a sentence and status 403 or 404."""
        if scope["type"] not in ("http", "websocket"):
            return await self.app(scope, receive, send)
        headers, path, is_page = Headers(scope=scope), scope["path"], scope["type"] == "http"
        refusal = self.refusal(headers.getlist("host"), headers.getlist("origin"))
        # A websocket always has the header Origin, but browsers differ in the value of Sec-Fetch-Site.
        sites = headers.getlist("sec-fetch-site") if is_page else []
        if not refusal and any(site not in ("same-origin", "none") for site in sites):
            refusal = (
                "This program answers to its own page alone, not to links and pictures of other sites. "
                "To follow a link, put the cursor into the browser's address bar and press Enter."
            )
        send = _guarded(send, "" if refusal else headers["host"])
        known = path == "/favicon.ico" or path.startswith(("/_nicegui/", "/_nicegui_ws/"))
        if not refusal and (known or (is_page and path == "/" and scope["method"] == "GET")):
            await self.app(scope, receive, send)
        elif is_page:
            sentence = refusal or "There is no such page; the program's only page is at /."
            await PlainTextResponse(f"{sentence}\n", 403 if refusal else 404)(scope, receive, send)
        else:
            # A websocket that is closed before it is accepted gets the status 403.
            await send({"type": "websocket.close", "code": 1008})

    def refusal(self, hosts: list[str], origins: list[str]) -> str:
        """Return the reason why a request with these headers is refused; empty if it is accepted."""
        host = hosts[0].lower() if len(hosts) == 1 else ""
        match = _HOST.fullmatch(host)
        is_other_address = match and self.any_address and _is_address(match[1].strip("[]"))
        if match is None or not (match[1] in self.names or is_other_address):
            *others, last = self.names
            asked = host or "a request that names none"
            return (
                f"This program answers to {', '.join(others)} and {last}, not to {asked}. "
                "To serve it under another name, start it with --host NAME."
            )
        if any(origin.lower().partition("://")[2] != host for origin in origins):
            return f"This program answers to its own page alone, not to {origins[0]}."
        return ""


def _is_address(name: str) -> bool:
    try:
        ip_address(name)
    except ValueError:
        return False
    return True


def _guarded(send: Send, host: str) -> Send:
    """Wrap `send` to add headers: what the page may load, and that no other page may embed it.

    Parameters
    ----------
    send : callable
        The `send` of the request.
    host : str
        Host name of the request; the policy lists its websockets, as not every browser includes them in
        'self'.
    """
    sockets = f" ws://{host} wss://{host}" if host else ""
    policy = (b"content-security-policy", _POLICY.format(sockets=sockets).encode("latin-1"))

    async def send_guarded(message: Message) -> None:
        if message["type"] == "http.response.start":
            message["headers"] = [*message.get("headers", ()), *_GUARDS, policy]
        await send(message)

    return send_guarded


def root_of(program: Program, solver: Callable[[], RunsTasks]) -> Callable[[], Awaitable[None]]:
    """Return the function that builds the page for a client; `solver` makes what computes for one page."""

    async def root() -> None:
        await open_page(program, solver())

    return root


def serve(program: Callable[[], Program], host: str, port: int, browser: bool) -> None:
    """Serve an interactive program until interrupted.

    Parameters
    ----------
    program : callable
        Importable function that makes the program, here and in each worker process.  It is called only after
        all checks have passed.
    host : str
        Address to listen on.
    port : int
        Port, from 1 to 65535.
    browser : bool
        Whether to open the browser.

    Raises
    ------
    ValueError
        If the address is unknown or cannot be used, for example because the port is in use.
    """
    _check_free(host, port)
    made, processes = program(), Processes(program)
    app.add_middleware(RequestGuard, host=host)
    add_style_and_scripts(made)
    # No loading bar at the top, as it has no name for screen readers; the page shows "Computing".
    app.config.quasar_config["loadingBar"]["skipHijack"] = True
    app.on_startup(processes.start)
    app.on_shutdown(processes.close)
    with quiet():
        ui.run(
            root_of(made, lambda: Share(processes)),
            host=host,
            port=port,
            title=made.title,
            language="en-US",
            show=browser,
            reload=False,
            tailwind=False,  # the CSS framework Tailwind would scan the page after each change
            # No compression: it would delay each message, and gains little within one computer.
            ws_per_message_deflate=False,
            reconnect_timeout=30.0,
        )


def _check_free(host: str, port: int) -> None:
    """Raise an error for an address that is blank, unknown or in use, before the server tries to start."""
    remedy = f"give an address or a name of this computer, such as {HOME}, or leave --host out"
    if not host.strip():
        raise ValueError(f'--host = "{host}": it is blank; {remedy}')
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    except (OSError, UnicodeError):  # UnicodeError: a part of the name is empty or too long
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
