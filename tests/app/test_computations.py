"""Computations of a page: what follows what, and what is said while it takes long."""

import asyncio

import pytest

pytest.importorskip("nicegui", reason="the interactive program needs NiceGUI")
from beamdyn.common.screens.computations import LatestComputation


class Started:
    """Computations that end when they are told to, by their names."""

    def __init__(self):
        self.futures, self.shown = {}, []
        self.way = LatestComputation(self.settle, self.shown.append)

    def settle(self, future, last):
        self.shown.append((future.result(), last))

    def start(self, name):
        self.futures[name] = asyncio.get_running_loop().create_future()
        return self.futures[name]

    def want(self, *names):
        self.way.want(*(lambda name=name: self.start(name) for name in names))

    async def end(self, name):
        self.futures[name].set_result(name)
        for _ in range(5):
            await asyncio.sleep(0)


def test_a_drawing_is_shown_before_its_tables_and_both_give_way_to_what_is_newer(monkeypatch):
    monkeypatch.setattr("nicegui.background_tasks.create", asyncio.ensure_future)

    async def body():
        made = Started()
        made.want("drawing 1", "tables 1")
        await made.end("drawing 1")
        made.want("drawing 2", "tables 2")
        await made.end("tables 1")
        await made.end("drawing 2")
        await made.end("tables 2")
        assert made.shown == [
            ("drawing 1", False),
            ("tables 1", False),
            ("drawing 2", False),
            ("tables 2", True),
        ]
        assert not made.way.busy

    asyncio.run(body())


def test_time_taken_and_left_is_said_after_a_second():
    way = LatestComputation(lambda *_: None, lambda _: None)
    way.usual, way.waited = 5.2, 0.9
    assert way.words == ""
    way.waited = 2.0
    assert way.words == "2 s, about 3 s left"
    way.waited = 6.0
    assert way.words == "6 s"
