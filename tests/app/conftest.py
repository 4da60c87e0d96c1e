"""The interactive programs need NiceGUI; a client is simulated within the test, without a server."""

import asyncio

import pytest

pytest.importorskip("nicegui", reason="the interactive program needs NiceGUI: pip install 'beamdyn[app]'")


@pytest.fixture
def simulate(monkeypatch, tmp_path):
    """Run an async function with a maker of clients of a program: `simulate(program, body)`."""
    monkeypatch.setenv("NICEGUI_STORAGE_PATH", str(tmp_path))

    def run(program, body):
        from nicegui.testing.user_simulation import user_simulation

        from beamdyn.common.app.server import root_of

        async def main():
            async with user_simulation(root=root_of(program)) as first:
                await body(clients(first))

        asyncio.run(main())

    return run


def clients(first):
    """A function that gives a further client at each call, its page open."""
    import re

    import httpx
    from nicegui import core
    from nicegui.testing import User

    made = []

    async def another():
        transport = httpx.ASGITransport(core.app)
        user = User(httpx.AsyncClient(transport=transport, base_url="http://test")) if made else first
        made.append(user)
        user.javascript_rules[re.compile(r".*sessionStorage\.getItem")] = lambda _: None
        await user.open("/")
        return user

    return another


class Fields:
    """What a simulated client does to the fields of a page and sees on it."""

    def __init__(self, user):
        self.user = user

    def field(self, path):
        """The field of an input, on the first screen that has it."""
        found = [e for e in self.user.client.elements.values() if e.props.get("data-path") == path]
        return found[0]

    def enter(self, path, text):
        with self.user.client:
            self.field(path).set_value(text)

    def go(self, name):
        """Bring a screen to the front."""
        bar = next(e for e in self.user.client.elements.values() if e.tag == "q-tabs")
        with self.user.client:
            bar.set_value(name)

    def text(self):
        """All that is written on the page, drawings left out."""
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
