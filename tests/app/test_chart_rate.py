"""While a point is held its drawing follows at full rate, the charts beside it ten times a second."""

import asyncio

import pytest

pytest.importorskip("nicegui")

from beamdyn.common.screens import screen_view
from beamdyn.common.screens.chart_board import ChartBoard
from beamdyn.common.screens.draggable_drawing import DraggableDrawing
from brakes.app.program import BRAKES

MOVES, APART = 40, 0.02  # moves of the mouse, and the time between two [s]


@pytest.fixture
def shown(monkeypatch):
    """Numbers of drawings and of charts that have been shown."""
    count = {DraggableDrawing: 0, ChartBoard: 0}

    def counting(kind):
        show = kind.show

        def counted(self, *given):
            count[kind] += 1
            show(self, *given)

        monkeypatch.setattr(kind, "show", counted)

    for kind in count:
        counting(kind)
    return count


@pytest.mark.parametrize("much", [0.0, 1e3], ids=["drawing first", "all at once"])
def test_charts_follow_a_held_point_at_their_own_rate(simulate, fields, shown, monkeypatch, much):
    monkeypatch.setattr(screen_view, "_MUCH", much)
    now = [100.0]
    monkeypatch.setattr(screen_view, "monotonic", lambda: now[0])

    async def body(another):
        user = await another()
        fields(user).go("Drum brake")
        await asyncio.sleep(0.1)
        pin = next(e for e in user.client.elements.values() if e.props.get("aria-label") == "pin of the shoe")
        listener = next(it for it in pin._event_listeners.values() if it.type == "pointerdown")

        async def move(place, done):
            now[0] += APART
            before = shown[DraggableDrawing]
            pin._handle_event({"listener_id": listener.id, "args": [*place, done]})
            while shown[DraggableDrawing] == before:  # it may still wait for the one before
                await asyncio.sleep(0.01)

        x, y = (float(pin.style[side].rstrip("%")) / 100 for side in ("left", "top"))
        await move((x - 0.0005, y), False)
        shown.update(dict.fromkeys(shown, 0))
        for i in range(MOVES):
            await move((x + 0.0005 * i, y), False)
        assert shown[DraggableDrawing] == MOVES
        assert 0.7 * MOVES * APART / 0.1 <= shown[ChartBoard] <= MOVES * APART / 0.1
        before = shown[ChartBoard]
        await move((x, y), True)
        assert shown[ChartBoard] == before + 1  # at rest all is shown, however soon, and once

    simulate(BRAKES, body)
