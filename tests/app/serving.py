"""An interactive program as a process of its own, and what that process listens to."""

import ipaddress
import os
import shutil
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CHROMIUM = shutil.which("chromium")
NO_PLAYWRIGHT = "the browser is driven by playwright: pip install 'beamdyn[browser]'"
IN_BROWSER = [
    pytest.mark.browser,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium; on Debian: apt-get install chromium"),
]
_LISTENS = "0A"  # state of a socket in /proc/net/tcp
PATIENCE = 240  # with anything that a program does, on a machine that does much else [s]


def free_port():
    with socket.socket() as trial:
        trial.bind(("127.0.0.1", 0))
        return trial.getsockname()[1]


def start(port, program="brakes", *options, folder=ROOT):
    """The program as a process of its own, when it answers."""
    command = [sys.executable, "-m", program, "app", "--no-browser", "--port", str(port), *options]
    # With pytest's variables NiceGUI would think that it is tested from within.
    clean = {key: value for key, value in os.environ.items() if not key.startswith(("PYTEST", "NICEGUI"))}
    clean["PYTHONPATH"] = str(ROOT)
    process = subprocess.Popen(
        command, cwd=folder, env=clean, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline and process.poll() is None:
        with socket.socket() as trial:
            if trial.connect_ex(("127.0.0.1", port)) == 0:
                return process
        time.sleep(0.1)
    process.kill()
    raise AssertionError(f"the program does not answer; it ended with {process.wait(PATIENCE)}")


def stop(process):
    process.terminate()
    process.wait(PATIENCE)


def listens_to(process):
    """Addresses and ports that a process listens to; of Linux only."""
    own = set()
    for entry in Path(f"/proc/{process.pid}/fd").iterdir():
        try:
            own.add(os.readlink(entry))
        except FileNotFoundError:  # closed meanwhile
            continue
    found = set()
    for kind in ("tcp", "tcp6"):
        lines = Path(f"/proc/{process.pid}/net/{kind}").read_text().splitlines()[1:]
        for fields in map(str.split, lines):
            if fields[3] == _LISTENS and f"socket:[{fields[9]}]" in own:
                address, port = fields[1].split(":")
                found.add((_address(address), int(port, 16)))
    return found


def _address(text):
    """An address as /proc has it: words of four bytes, each in the order of this processor."""
    words = [bytes.fromhex(text[i : i + 8]) for i in range(0, len(text), 8)]
    if sys.byteorder == "little":
        words = [word[::-1] for word in words]
    return str(ipaddress.ip_address(b"".join(words)))
