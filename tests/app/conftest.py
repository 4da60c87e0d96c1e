"""Fixtures of tests of the interactive programs: a simulated client without a server, or a real browser.

Tests that need NiceGUI are skipped where it is missing; the screens themselves are pure functions, whose
tests run anyway.
"""

import asyncio

import pytest

from tests.app.serving import CHROMIUM, NO_PLAYWRIGHT, PATIENCE, free_port, start, stop

NO_NICEGUI = "the interactive program needs NiceGUI: pip install 'beamdyn[app]'"


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector):
    """Skip a module that imports NiceGUI where it is not installed."""
    report = yield
    if report.failed and "No module named 'nicegui'" in str(report.longrepr):
        report.outcome, report.longrepr = "skipped", (str(collector.path), 0, f"Skipped: {NO_NICEGUI}")
    return report


@pytest.fixture
def simulate(monkeypatch, tmp_path):
    """Run an async function with a maker of clients of a program: `simulate(program, body)`."""
    pytest.importorskip("nicegui", reason=NO_NICEGUI)
    monkeypatch.setenv("NICEGUI_STORAGE_PATH", str(tmp_path))
    # On a slow machine, too, only tables that a test slows down come after their drawing.
    monkeypatch.setattr("beamdyn.common.screens.screen_view._MUCH", 0.15)

    def run(program, body, solver=None):
        from nicegui.testing.user_simulation import user_simulation

        from beamdyn.common.screens.server import root_of

        async def main():
            async with user_simulation(root=root_of(program, lambda: solver or AtOnce())) as first:
                await body(clients(first))

        asyncio.run(main())

    return run


class AtOnce:
    """Solver that computes answers at once, in place of `Processes`."""

    def submit(self, task, *given):
        made = asyncio.get_running_loop().create_future()
        try:
            made.set_result(task(*given))
        except Exception as error:
            made.set_exception(error)
        return made


class InThread:
    """Solver that computes answers beside the page's event loop."""

    def submit(self, task, *given):
        return asyncio.ensure_future(asyncio.to_thread(task, *given))


def clients(first):
    """Yield a function that opens the page for a further client at each call."""
    import re

    import httpx
    from nicegui import core
    from nicegui.testing import User

    made = []

    async def another(stored=None):
        """A client whose browser holds a text."""
        transport = httpx.ASGITransport(core.app)
        user = User(httpx.AsyncClient(transport=transport, base_url="http://test")) if made else first
        made.append(user)
        user.javascript_rules[re.compile(r".*recallPage")] = lambda _: stored
        await user.open("/")
        while not any(element.tag == "q-tabs" for element in user.client.elements.values()):
            await asyncio.sleep(0.005)  # the page is made when its client has connected
        return user

    return another


class Fields:
    """Actions of a simulated client on the fields of a page, and what it sees there."""

    def __init__(self, user):
        self.user = user

    def field(self, path):
        """Return the field of an input, on the first screen that has it."""
        found = [e for e in self.user.client.elements.values() if e.props.get("data-path") == path]
        return found[0]

    def enter(self, path, text):
        with self.user.client:
            self.field(path).set_value(text)

    def leave(self, path, text):
        """Type into a field whose text counts when the field is left, as for lists."""
        field = self.field(path)
        with self.user.client:
            field.set_value(text)
            for listener in list(field._event_listeners.values()):
                if listener.type == "blur":
                    field._handle_event({"listener_id": listener.id, "args": {}})

    def go(self, name):
        """Bring a screen to the front."""
        bar = next(e for e in self.user.client.elements.values() if e.tag == "q-tabs")
        with self.user.client:
            bar.set_value(name)

    def text(self):
        """Return all text on the page, except in drawings."""
        elements = self.user.client.elements.values()
        words = [getattr(e, "text", None) or e.props.get("innerHTML", "") for e in elements]
        return "\n".join(str(w) for w in words if w and "<img" not in str(w))

    def tabs(self):
        return [e.props["label"] for e in self.user.client.elements.values() if e.tag == "q-tab"]

    def greyed(self):
        return sum("greyed" in e.classes for e in self.user.client.elements.values())


@pytest.fixture
def fields():
    return Fields


# In a real browser --------------------------------------------------------------------------------------


@pytest.fixture(scope="session")
def address():
    """Return a function that serves the program of a name in a new process, and returns its address."""
    pytest.importorskip("nicegui", reason=NO_NICEGUI)
    made = {}

    def of(program):
        if program not in made:
            port = free_port()
            made[program] = port, start(port, program)
        return f"http://127.0.0.1:{made[program][0]}/"

    yield of
    for _, process in made.values():
        stop(process)


# Until the browser is closed no other event loop can run, such as that of `simulate`.
@pytest.fixture(scope="module")
def browser():
    sync_api = pytest.importorskip("playwright.sync_api", reason=NO_PLAYWRIGHT)
    with sync_api.sync_playwright() as playwright:
        made = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield made
        made.close()


@pytest.fixture
def opened(browser, address):
    """Return a function that opens the page of a program, on which no script may fail."""
    yield from opening(browser, address)


@pytest.fixture(scope="module")
def shared(browser, address):
    """Return such a function for pages that several tests use."""
    yield from opening(browser, address)


def opening(browser, address):
    contexts, failures = [], []

    def open_page(program="brakes", at="", width=1280):
        context = browser.new_context(viewport={"width": width, "height": 900})
        contexts.append(context)
        page = context.new_page()
        page.on("pageerror", lambda error: failures.append(str(error)))
        page.on("dialog", lambda dialog: failures.append(f"a dialog: {dialog.message}"))
        page.set_default_timeout(1e3 * PATIENCE)
        page.set_default_navigation_timeout(1e3 * PATIENCE)
        page.goto(at or address(program))
        # Text typed before the page is connected would be lost.
        page.wait_for_function("window.did_handshake")
        page.wait_for_selector(".board:visible, .chart:visible")
        return page

    yield open_page
    for context in contexts:
        context.close()
    assert failures == []


@pytest.fixture
def page(opened):
    """Open the page of `brakes app`."""
    return opened()
