"""Entries that a tab of the browser holds over a reload: restored once, and never replaced before."""

import asyncio
import json

import pytest

from beamdyn.app.program import SCENE
from beamdyn.common.screens.open_document import OpenDocument
from brakes.app.program import BRAKES
from tests.app.conftest import InThread
from tests.app.serving import PATIENCE

VEHICLE = BRAKES.documents[0]


def design(**changed):
    return json.dumps({"front": "Vehicle", "designs": {VEHICLE.name: VEHICLE.base_entries | changed}})


@pytest.fixture
def storage(monkeypatch):
    """What pages ask their browsers to read and to store, in order."""
    client = pytest.importorskip("nicegui").Client
    asked, run = [], client.run_javascript

    def record(self, code, **more):
        if "recallPage" in code or "rememberPage" in code:
            asked.append(code)
        return run(self, code, **more)

    monkeypatch.setattr(client, "run_javascript", record)
    return asked


async def recalled(storage):
    """Wait until a page has read what its browser holds, and stored it."""
    async with asyncio.timeout(PATIENCE):
        while not any("rememberPage" in code for code in storage):
            await asyncio.sleep(0.01)


def test_stored_design_is_read_before_anything_is_stored(simulate, storage):
    async def body(client):
        user = await client(design(**{"stop.speed": "25 km/h"}))
        await recalled(storage)
        assert "recallPage" in storage[0]
        assert all("25 km/h" in code for code in storage[1:])
        made = user.client.elements.values()
        assert "25 km/h" in [e.value for e in made if e.props.get("data-path") == "stop.speed"]

    simulate(BRAKES, body, InThread())  # the first answer comes late


@pytest.mark.parametrize("stored", [None, design()], ids=["nothing", "the same design"])
def test_form_that_shows_the_stored_design_is_not_made_anew(simulate, storage, monkeypatch, stored):
    page = pytest.importorskip("beamdyn.common.screens.page")
    made = []
    monkeypatch.setattr(page.Page, "_rebuild", lambda *given: made.append(given))

    async def body(client):
        await client(stored)
        await recalled(storage)

    simulate(BRAKES, body)
    assert made == []


def test_entry_typed_before_the_stored_design_came_remains():
    work = OpenDocument(VEHICLE)
    work.put("stop.speed", "31 km/h")
    stored = VEHICLE.base_entries | {"stop.speed": "25 km/h", "stop.friction": "0.5", "of.another": "1"}
    assert work.recall(stored)
    assert work.entries == VEHICLE.base_entries | {"stop.speed": "31 km/h", "stop.friction": "0.5"}
    assert not work.recall(stored)


def test_text_typed_before_anything_was_stored_is_restored(simulate, storage):
    async def body(client):
        user = await client(json.dumps({"typed": {VEHICLE.name: {"stop.speed": "26"}}}))
        await recalled(storage)
        made = user.client.elements.values()
        assert "26 km/h" in [e.value for e in made if e.props.get("data-path") == "stop.speed"]

    simulate(BRAKES, body)


def test_file_keeps_the_fields_that_commands_take_as_options():
    work = OpenDocument(SCENE)
    options = {"operation.speed": "60 rad/s", "run.window_end": "9 s", "options.modes": "3"}
    for path, text in options.items():
        work.put(path, text)
    saved = work.file()
    assert SCENE.check(saved, "as a command reads it") == SCENE.check(work.text(), "without them")
    another = OpenDocument(SCENE)
    another.put("trade.digits", "5")  # which the file has as well
    another.open(saved, "saved.toml")
    assert another.entries == work.entries
    another.put("operation.speed", "70 rad/s")
    another.open(SCENE.base, "scene.toml")  # which says nothing of them
    assert another.entries["operation.speed"] == "70 rad/s"
