"""Over real HTTP: the interactive programs answer to their own names alone, in no other page's frame.

A page from elsewhere reaches a server on this computer through the browser: under a name of its own that
points to 127.0.0.1 ("DNS rebinding", which the Host gives away), or by a websocket (which the Origin does).
"""

import http.client
import os
import socket
from importlib.util import find_spec

import pytest

from beamdyn.common.app.server import MISSING
from tests.app.serving import PATIENCE, free_port, start, stop

pytestmark = pytest.mark.skipif(find_spec("nicegui") is None, reason=MISSING)

SOCKET = "/_nicegui_ws/socket.io/?EIO=4&transport="
UPGRADE = {
    "Connection": "Upgrade",
    "Upgrade": "websocket",
    "Sec-WebSocket-Version": "13",
    "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
}
OWN = ("127.0.0.1", "localhost", "LOCALHOST", "[::1]")
FOREIGN = (
    *("evil.example", "127.0.0.1.evil.example", "evil.example:127.0.0.1", "localhost.evil.example"),
    *("10.0.0.5", "[::2]", "localhost@evil.example", "evil.example#localhost", "", "[", "localhost:x"),
)


def ask(port, path="/", method="GET", **headers):
    """Status, headers and body of the answer to a request to 127.0.0.1; `host` without a port gets it."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE)
    connection.putrequest(method, path, skip_host=True)
    for name, value in headers.items():
        connection.putheader(name.replace("_", "-"), value)
    connection.endheaders()
    answer = connection.getresponse()
    body = b"" if answer.status == 101 else answer.read()
    connection.close()
    return answer.status, answer.headers, body.decode(errors="replace")


@pytest.fixture(scope="module")
def port():
    chosen = free_port()
    process = start(chosen, "beamdyn")
    yield chosen
    stop(process)


@pytest.mark.parametrize("name", OWN)
def test_own_names_are_answered(port, name):
    status, _, body = ask(port, Host=f"{name}:{port}")
    assert status == 200 and "Rotating beam" in body


@pytest.mark.parametrize("name", FOREIGN)
@pytest.mark.parametrize("path", ["/", f"{SOCKET}polling"])
def test_foreign_host_is_refused(port, path, name):
    status, _, body = ask(port, path, Host=f"{name}:{port}" if name.isascii() and ":" not in name else name)
    assert status in (400, 403) and "Rotating beam" not in body and '"sid"' not in body


def test_refusal_says_what_to_do(port):
    status, _, body = ask(port, Host="lab-pc")
    assert status == 403
    assert body == (
        "This program answers to 127.0.0.1, [::1] and localhost, not to lab-pc. "
        "To serve it under another name, start it with --host NAME.\n"
    )


def test_websocket_opens_for_the_own_page(port):
    own = f"127.0.0.1:{port}"
    assert ask(port, f"{SOCKET}websocket", Host=own, Origin=f"http://{own}", **UPGRADE)[0] == 101


@pytest.mark.parametrize(
    ("host", "origin"),
    [
        ("127.0.0.1:{port}", "http://evil.example"),
        ("127.0.0.1:{port}", "http://evil.example:{port}"),
        ("127.0.0.1:{port}", "http://127.0.0.1:1"),  # another program on this computer
        ("127.0.0.1:{port}", "http://localhost:{port}"),  # of that name the page is another one, too
        ("127.0.0.1:{port}", "null"),  # a frame that its page has shut in
        ("evil.example:{port}", "http://evil.example:{port}"),
    ],
)
@pytest.mark.parametrize(
    ("method", "path", "more"),
    [("GET", f"{SOCKET}websocket", UPGRADE), ("GET", f"{SOCKET}polling", {}), ("POST", "/", {})],
)
def test_foreign_origin_is_refused(port, host, origin, method, path, more):
    headers = {"Host": host.format(port=port), "Origin": origin.format(port=port), **more}
    status, answered, body = ask(port, path, method, **headers)
    assert status == 403 and '"sid"' not in body
    assert "Access-Control-Allow-Origin" not in answered


@pytest.mark.parametrize("path", ["/", "/no-such-page", f"{SOCKET}polling"])
@pytest.mark.parametrize("name", ["127.0.0.1", "evil.example"])
def test_no_other_page_frames_it(port, path, name):
    _, headers, _ = ask(port, path, Host=f"{name}:{port}")
    assert headers["X-Frame-Options"] == "DENY"
    assert "frame-ancestors 'none'" in policy_of(headers)


def policy_of(headers):
    """The rules of an answer's only Content-Security-Policy."""
    (policy,) = headers.get_all("Content-Security-Policy")
    return policy.split("; ")


@pytest.mark.parametrize("path", ["/", "/no-such-page"])
def test_page_loads_nothing_from_elsewhere_and_sends_nothing_there(port, path):
    _, headers, _ = ask(port, path, Host=f"localhost:{port}")
    rules = policy_of(headers)
    assert {"default-src 'self'", "object-src 'none'", "base-uri 'none'", "form-action 'self'"} <= {*rules}
    (connect,) = [rule for rule in rules if rule.startswith("connect-src")]
    assert connect.split() == ["connect-src", "'self'", f"ws://localhost:{port}", f"wss://localhost:{port}"]
    words = {word for rule in rules for word in rule.split()[1:]}
    allowed = {"'self'", "'none'", "'unsafe-inline'", "'unsafe-eval'", "data:", "blob:"}
    assert words - allowed == {f"ws://localhost:{port}", f"wss://localhost:{port}"}
    assert headers["X-Content-Type-Options"] == "nosniff"


def test_name_that_is_asked_for_is_answered():
    name, chosen = "localhost", free_port()
    process = start(chosen, "brakes", "--host", name)
    try:
        assert ask(chosen, Host=f"{name}:{chosen}")[0] == 200
        assert ask(chosen, Host=f"evil.example:{chosen}")[0] == 403
    finally:
        stop(process)


@pytest.mark.skipif(os.name == "nt", reason="Windows serves no wildcard address on 127.0.0.1")
def test_served_to_others_it_answers_to_addresses_and_to_this_computers_name():
    chosen = free_port()
    process = start(chosen, "brakes", "--host", "0.0.0.0")
    try:
        for name in ("127.0.0.1", "192.0.2.7", "[2001:db8::7]", socket.gethostname()):
            assert ask(chosen, Host=f"{name}:{chosen}")[0] == 200, name
        assert ask(chosen, Host=f"evil.example:{chosen}")[0] == 403
    finally:
        stop(process)
