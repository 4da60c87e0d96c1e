"""An interactive program in a separate process, and a browser that shows it."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
CHROMIUM = shutil.which("chromium")
NO_BROWSER = "a browser is driven by playwright and Debian's chromium: pip install 'beamdyn[browser]'"
PATIENCE = 240  # time limit of any action of a program on a busy machine [s]


def free_port() -> int:
    """Return a free network port."""
    with socket.socket() as trial:
        trial.bind(("127.0.0.1", 0))
        return int(trial.getsockname()[1])


def start(port: int, program: str = "brakes", *options: str, folder: Path = ROOT) -> subprocess.Popen[bytes]:
    """Start the program as a separate process, and wait until it answers."""
    command = [sys.executable, "-m", program, "app", "--no-browser", "--port", str(port), *options]
    # With pytest's environment variables set, NiceGUI would run in its test mode.
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


def stop(process: subprocess.Popen[bytes]) -> float:
    """End a program by SIGTERM; return the time until it has ended [s]."""
    begin = time.perf_counter()
    process.terminate()
    process.wait(PATIENCE)
    return time.perf_counter() - begin


@contextmanager
def browser() -> Iterator[Any]:
    """Start a headless browser, and yield it.

    Raises
    ------
    SystemExit
        If no browser is installed.
    """
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        raise SystemExit(NO_BROWSER) from None
    if CHROMIUM is None:
        raise SystemExit(NO_BROWSER)
    with sync_playwright() as playwright:
        made = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield made
        made.close()


def open_page(context: Any, port: int) -> Any:
    """Open a page of the program on a port, and wait for its first drawing."""
    page = context.new_page()
    page.set_default_timeout(1e3 * PATIENCE)
    page.set_default_navigation_timeout(1e3 * PATIENCE)
    page.goto(f"http://127.0.0.1:{port}/")
    page.wait_for_function("window.did_handshake")
    up_to_date(page)
    return page


def go(page: Any, screen: str) -> None:
    """Open a screen of the page, and wait for its answer."""
    page.get_by_role("tab", name=screen).first.click()
    page.wait_for_function(
        "name => document.querySelector('[role=tab][aria-selected=true]')?.innerText.startsWith(name)",
        arg=screen,
    )
    up_to_date(page)


def up_to_date(page: Any) -> None:
    """Wait until the visible screen shows that its answer is up to date."""
    page.get_by_text("Up to date.").locator("visible=true").first.wait_for()
