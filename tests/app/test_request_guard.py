"""Over real HTTP: the interactive programs answer to their own names alone, in no other page's frame.

A page from elsewhere reaches a server on this computer through the browser: under a name of its own that
points to 127.0.0.1 ("DNS rebinding", which the Host gives away), or by a websocket (which the Origin does).
"""

import http.client
import os
import socket
from importlib.util import find_spec
from pathlib import Path

import pytest

from beamdyn.common.screens.app_command import MISSING
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


@pytest.mark.parametrize(("method", "path"), [("GET", "/"), ("GET", "/x.png"), ("POST", "/"), ("HEAD", "/")])
@pytest.mark.parametrize("site", ["cross-site", "same-site"])
def test_requests_that_other_sites_cause_are_refused(port, site, method, path):
    status, _, body = ask(port, path, method, Host=f"127.0.0.1:{port}", Sec_Fetch_Site=site)
    assert status == 403 and (method == "HEAD" or "press Enter" in body)


@pytest.mark.parametrize("site", ["none", "same-origin"])
def test_the_address_bar_and_the_own_page_are_answered(port, site):
    assert ask(port, Host=f"127.0.0.1:{port}", Sec_Fetch_Site=site)[0] == 200


@pytest.mark.parametrize(
    ("method", "path"), [("GET", "/x"), ("GET", "/_nicegui"), ("POST", "/"), ("HEAD", "/")]
)
def test_what_is_not_the_page_is_not_answered_by_it(port, method, path):
    status, _, body = ask(port, path, method, Host=f"127.0.0.1:{port}")
    assert status == 404 and "<" not in body


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="memory is read from /proc")
def test_pages_that_never_connect_take_no_memory():
    chosen = free_port()
    process = start(chosen, "beamdyn")
    try:
        own = {"Host": f"127.0.0.1:{chosen}"}
        ask(chosen, **own)
        before = resident(process)
        for _ in range(1000):
            ask(chosen, **own, Sec_Fetch_Site="cross-site")
        assert resident(process) - before < 5
        for _ in range(200):
            ask(chosen, **own)
        assert resident(process) - before < 50
    finally:
        stop(process)


def resident(process):
    """Memory of a process [MB]."""
    lines = Path(f"/proc/{process.pid}/status").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("VmRSS")) / 1024
