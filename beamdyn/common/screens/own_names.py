"""The requests that an interactive program answers: to its own names, from its own page, in no other's frame.

A web page from elsewhere reaches a server on this computer through the visitor's browser: under a name of
its own that is made to point to 127.0.0.1 ("DNS rebinding"), which shows in the request's Host; or as itself
by a websocket or a form, which shows in its Origin; or by a picture or a link, which shows in Sec-Fetch-Site.
All are checked here; starlette's `TrustedHostMiddleware` checks the first alone, and in its earlier versions
takes no address in brackets.  The toolkit would make a page for every path and method: the others end here.

What a page may load and send, its Content-Security-Policy says: nothing from elsewhere, nothing to there.
The toolkit needs three exceptions: its page starts by a script within it ('unsafe-inline'), Vue
compiles templates and NiceGUI runs the program's own code ('unsafe-eval'), and elements carry their styles
('unsafe-inline').  What users enter is therefore shown as text or in escaped HTML alone.
"""

from __future__ import annotations

import re
import socket
from collections.abc import Awaitable, Callable, MutableMapping
from ipaddress import ip_address
from typing import Any

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]

_THIS_COMPUTER = ("127.0.0.1", "[::1]", "localhost")
_HOST = re.compile(r"(\[[0-9a-f:.]+\]|[a-z0-9._-]+)(:[0-9]+)?")
_POLICY = "; ".join((
    "default-src 'self'",
    "script-src 'self' 'unsafe-inline' 'unsafe-eval'",
    "style-src 'self' 'unsafe-inline'",
    "img-src 'self' data: blob:",
    "font-src 'self' data:",
    "connect-src 'self'{sockets}",
    "object-src 'none'",
    "base-uri 'none'",
    "form-action 'self'",
    "frame-ancestors 'none'",
))  # fmt: skip
_GUARDS = (
    (b"x-frame-options", b"DENY"),
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
)


class OwnNames:
    """ASGI middleware that refuses requests to other names than the program's, and from other pages.

    Parameters
    ----------
    app : callable
        The ASGI application.
    host : str
        Address or name that the program listens on.  The program answers to it and to 127.0.0.1, [::1] and
        localhost; where it listens on all addresses, to any address and to the computer's name: a foreign
        page has a name, too, but another one.
    """

    def __init__(self, app: App, host: str) -> None:
        self.app = app
        self.any_address = host == "" or (_is_address(host) and ip_address(host).is_unspecified)
        own = socket.gethostname() if self.any_address else f"[{host}]" if ":" in host else host
        self.names = tuple(dict.fromkeys((*_THIS_COMPUTER, own.lower())))

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it with a sentence and status 403 or 404."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
        elif refusal := self.refusal(_headers(scope, b"host"), _headers(scope, b"origin")) or _foreign(scope):
            await _refuse(scope, _guarded(send), 403, refusal)
        else:
            send = _guarded(send, _headers(scope, b"host")[0])
            if _is_known(scope):
                await self.app(scope, receive, send)
            else:
                await _refuse(scope, send, 404, "There is no such page; the program's only one is at /.")

    def refusal(self, hosts: list[str], origins: list[str]) -> str:
        """Why a request with these headers is refused; empty if it is answered."""
        host = hosts[0].lower() if len(hosts) == 1 else ""
        if not self._is_own(host):
            *others, last = self.names
            asked = host or "a request that names none"
            return (
                f"This program answers to {', '.join(others)} and {last}, not to {asked}. "
                "To serve it under another name, start it with --host NAME."
            )
        if any(origin.lower().partition("://")[2] != host for origin in origins):
            return f"This program answers to its own page alone, not to {origins[0]}."
        return ""

    def _is_own(self, host: str) -> bool:
        match = _HOST.fullmatch(host)
        return match is not None and (
            match[1] in self.names or (self.any_address and _is_address(match[1].strip("[]")))
        )


def _is_address(name: str) -> bool:
    try:
        ip_address(name)
    except ValueError:
        return False
    return True


def _headers(scope: Scope, name: bytes) -> list[str]:
    """All values of a header."""
    return [value.decode("latin-1") for key, value in scope["headers"] if key == name]


def _guarded(send: Send, host: str = "") -> Send:
    """A `send` that adds headers: what the page may load, and that no other page may frame it.

    Parameters
    ----------
    send : callable
        The `send` of the request.
    host : str
        The name that was asked for; its websockets are listed in the policy, as not every browser counts them
        among 'self'.
    """
    sockets = f" ws://{host} wss://{host}" if host else ""
    policy = (b"content-security-policy", _POLICY.format(sockets=sockets).encode("latin-1"))

    async def send_guarded(message: MutableMapping[str, Any]) -> None:
        if message["type"] == "http.response.start":
            message["headers"] = [*message.get("headers", ()), *_GUARDS, policy]
        await send(message)

    return send_guarded


def _foreign(scope: Scope) -> str:
    """Why a request is refused that another site has made the browser send; empty if none has.

    A websocket says its Origin always, and browsers differ in what site they count it to.
    """
    sites = _headers(scope, b"sec-fetch-site") if scope["type"] == "http" else []
    if all(site in ("same-origin", "none") for site in sites):
        return ""
    return (
        "This program answers to its own page alone, not to links and pictures of other sites. "
        "To follow a link, put the cursor into the browser's address bar and press Enter."
    )


def _is_known(scope: Scope) -> bool:
    """Whether a request is for the page or for what belongs to it."""
    path = scope["path"]
    page = scope["type"] == "http" and path == "/" and scope["method"] == "GET"
    return page or path == "/favicon.ico" or path.startswith(("/_nicegui/", "/_nicegui_ws/"))


async def _refuse(scope: Scope, send: Send, status: int, sentence: str) -> None:
    if scope["type"] == "websocket":
        return await send({"type": "websocket.close", "code": 1008})  # before it is accepted: status 403
    headers = [(b"content-type", b"text/plain; charset=utf-8")]
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": f"{sentence}\n".encode()})
