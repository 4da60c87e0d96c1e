"""Starting an interactive program in a new process, and the addresses that the process listens to."""

import asyncio
import ipaddress
import os
import sys
from pathlib import Path

import pytest

from benchmarks.served import CHROMIUM, PATIENCE, ROOT, free_port, start, stop

__all__ = ["CHROMIUM", "PATIENCE", "ROOT", "free_port", "start", "stop"]
NO_PLAYWRIGHT = "the browser is driven by playwright: pip install 'beamdyn[browser]'"
IN_BROWSER = [
    pytest.mark.browser,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium; on Debian: apt-get install chromium"),
]
_LISTENS = "0A"  # state of a socket in /proc/net/tcp


async def wait_for(condition):
    """Wait until a condition holds; fail if it does not in time."""
    async with asyncio.timeout(PATIENCE):
        while not condition():
            await asyncio.sleep(0.01)


def listens_to(process):
    """Return addresses and ports that a process listens to; on Linux only."""
    own = set()
    for entry in Path(f"/proc/{process.pid}/fd").iterdir():
        try:
            own.add(os.readlink(entry))
        except FileNotFoundError:  # the file was closed meanwhile
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
    """Decode an address as /proc has it: words of four bytes, each in the order of this processor."""
    words = [bytes.fromhex(text[i : i + 8]) for i in range(0, len(text), 8)]
    if sys.byteorder == "little":
        words = [word[::-1] for word in words]
    return str(ipaddress.ip_address(b"".join(words)))
