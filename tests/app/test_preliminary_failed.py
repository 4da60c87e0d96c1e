"""A preliminary answer whose whole one never comes, and entries that are taken back while they are solved."""

import asyncio

import pytest

pytest.importorskip("nicegui")

from beamdyn.app.program import BEAMDYN
from beamdyn.common.screens import page_tasks
from beamdyn.common.screens.processes import TakesTooLong
from brakes.app.program import BRAKES
from tests.app.conftest import AtOnce
from tests.app.test_drawn_beside import press, wait_for


class Failing(AtOnce):
    """Whole answers take too long from some time on."""

    fails = False

    def submit(self, task, *given):
        if not (self.fails and task is page_tasks.solve):
            return super().submit(task, *given)
        made = asyncio.get_running_loop().create_future()
        made.set_exception(TakesTooLong("it takes more than 120 s"))
        return made


class Delayed(AtOnce):
    """Answers come when they are let go, from some time on."""

    def __init__(self):
        self.holds, self.held = False, []

    def submit(self, task, *given):
        if not self.holds:
            return super().submit(task, *given)
        self.held.append((made := asyncio.get_running_loop().create_future(), task, given))
        return made

    def let_go(self):
        held, self.held, self.holds = self.held, [], False
        for made, task, given in held:
            if not made.cancelled():
                made.set_result(task(*given))


def test_no_file_is_made_of_a_preliminary_answer(simulate, fields):
    solver = Failing()

    async def body(another):
        user = await another()
        page = fields(user)
        page.go("Compare")
        await wait_for(lambda: "Up to date." in page.text())
        solver.fails = True
        of_both = [e for e in user.client.elements.values() if e.props.get("data-path") == "beam.length"]
        with user.client:
            of_both[-1].set_value("51 mm")  # that of the screen in front, which has been made last
        await wait_for(lambda: "Given up: it takes more than 120 s" in page.text())
        for kind in ("CSV", "SVG"):
            press(user, f"download Compare as {kind}")
        await wait_for(lambda: len(user.notify.messages) == 2)
        assert all("No file is made" in said for said in user.notify.messages)
        assert not user.download.http_responses

    simulate(BEAMDYN, body, solver)


def test_entries_that_are_taken_back_while_they_are_solved_leave_nothing_stale(simulate, fields):
    solver = Delayed()

    async def body(another):
        user = await another()
        page = fields(user)
        await wait_for(lambda: "Up to date." in page.text())
        solver.holds = True
        page.enter("stop.speed", "25 km/h")
        press(user, "Undo (Ctrl-Z)")
        solver.let_go()
        await wait_for(lambda: "Computing." not in page.text())
        assert page.field("stop.speed").value == "20 km/h"
        assert "Up to date." in page.text()

    simulate(BRAKES, body, solver)
