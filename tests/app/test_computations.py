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

    def want(self, name, **how):
        self.way.want(lambda: self.start(name), **how)

    async def end(self, name):
        self.futures[name].set_result(name)
        for _ in range(5):
            await asyncio.sleep(0)


def test_what_waits_gives_way_to_what_is_newer(monkeypatch):
    monkeypatch.setattr("nicegui.background_tasks.create", asyncio.ensure_future)

    async def body():
        made = Started()
        for name in ("first", "second", "third"):
            made.want(name)
        await made.end("first")
        await made.end("third")
        assert made.shown == [("first", False), ("third", True)] and [*made.futures] == ["first", "third"]
        assert not made.way.busy

    asyncio.run(body())


def test_what_gives_way_is_ended_at_once_when_something_newer_is_wanted(monkeypatch):
    monkeypatch.setattr("nicegui.background_tasks.create", asyncio.ensure_future)

    async def body():
        made = Started()
        made.want("long", gives_way=True)
        await asyncio.sleep(0)
        made.want("newer")
        for _ in range(5):
            await asyncio.sleep(0)
        assert made.futures["long"].cancelled() and "newer" in made.futures
        made.want("newest")
        await asyncio.sleep(0)
        assert not made.futures["newer"].cancelled()
        await made.end("newer")
        await made.end("newest")
        assert made.shown == [("newer", False), ("newest", True)]

    asyncio.run(body())


def test_time_taken_and_left_is_said_after_a_second():
    way = LatestComputation(lambda *_: None, lambda _: None)
    way.usual, way.waited = 5.2, 0.9
    assert way.words == ""
    way.waited = 2.0
    assert way.words == "2 s, about 3 s left"
    way.waited = 6.0
    assert way.words == "6 s"
