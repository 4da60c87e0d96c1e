"""Pictures and reports are drawn beside the process that serves: no page waits for another's."""

import asyncio

import pytest
from matplotlib.figure import Figure

pytest.importorskip("nicegui")

from nicegui.testing.user_interaction import UserInteraction

from beamdyn.common.screens import page_tasks
from brakes.app.program import BRAKES
from tests.app.conftest import AtOnce
from tests.app.serving import wait_for

DRAWN = {page_tasks.folded, page_tasks.drawing_file, page_tasks.sweep_file, page_tasks.report}


class Holding:
    """Answers at once, but holds what is drawn until it is let go."""

    def __init__(self):
        self.held, self.done, self.drawing = [], [], False

    def submit(self, task, *given):
        if task not in DRAWN:
            return AtOnce().submit(task, *given)
        made = asyncio.get_running_loop().create_future()
        self.held.append((made, task, given))
        return made

    def let_go(self):
        held, self.held = self.held, []
        self.drawing = True
        for made, task, given in held:
            if not made.cancelled():
                made.set_result(task(*given))
                self.done.append(task)
        self.drawing = False


@pytest.fixture
def solver(monkeypatch):
    """One that holds drawings; nothing else may use matplotlib."""
    made, save = Holding(), Figure.savefig

    def saved(*given, **options):
        assert made.drawing, "drawn in the process that serves"
        return save(*given, **options)

    monkeypatch.setattr(Figure, "savefig", saved)
    return made


def press(user, words):
    """Press what is called so, a button or the entry of a menu, which says so in a part of its own."""
    made = user.client.elements.values()
    found = next(e for e in made if words in (e.props.get("aria-label"), getattr(e, "text", None)))
    it = found.parent_slot.parent if found.tag == "q-item-section" else found
    UserInteraction(user, {it}, None).click()


async def downloaded(*users):
    """What is downloaded first; the simulation gives it to the client it served last, not to who asked."""
    await wait_for(lambda: any(user.download.http_responses for user in users))
    return next(found for user in users for found in user.download.http_responses)


def test_another_tab_is_answered_while_a_report_is_made(simulate, fields, solver):
    def report_is_held():
        held = any(task is page_tasks.report for _, task, _ in solver.held)
        if not held:
            solver.let_go()  # pictures that the pages have asked for before
        return held

    async def body(another):
        first, second = await another(), await another()
        press(first, "Report as HTML")
        await wait_for(report_is_held)
        page = fields(second)
        page.enter("stop.speed", "25 km/h")
        await wait_for(lambda: "Up to date." in page.text())
        assert "16." in page.text()  # the stopping distance grows from 13.4 m to some 19
        assert page_tasks.report not in solver.done
        solver.let_go()
        found = (await downloaded(first, second)).text
        assert "<h2>Vehicle</h2>" in found and "<h2>Internal forces</h2>" in found

    simulate(BRAKES, body, solver)


def test_a_report_says_that_it_is_being_made_and_can_be_cancelled(simulate, solver):
    async def body(another):
        user = await another()
        press(user, "Report as HTML")
        spinner = next(
            each
            for each in user.client.elements.values()
            if each.props.get("aria-label") == "a file is being made"
        )
        row = spinner.parent_slot.parent
        _, said, button = row.default_slot.children
        while not any(task is page_tasks.report for _, task, _ in solver.held):
            solver.let_go()
            await asyncio.sleep(0.01)
        await wait_for(lambda: row.visible and said.text.startswith("forklift.html"))
        UserInteraction(user, {button}, None).click()
        await wait_for(lambda: not row.visible)
        assert all(made.cancelled() for made, task, _ in solver.held if task is page_tasks.report)
        assert "forklift.html was cancelled" in user.notify.messages
        assert not user.download.http_responses

    simulate(BRAKES, body, solver)


def test_files_are_drawn_beside(simulate, fields, solver):
    async def body(another):
        user = await another()
        page = fields(user)
        page.go("Drum brake")
        await wait_for(lambda: "Up to date." in page.text())
        press(user, "download Drum brake as PNG")
        await wait_for(lambda: page_tasks.drawing_file in [task for _, task, _ in solver.held])
        solver.let_go()
        assert (await downloaded(user)).content.startswith(b"\x89PNG")

    simulate(BRAKES, body, solver)
