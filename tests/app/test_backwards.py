"""Questions backwards on the screens of `brakes app`: those of `--find`, with its answers."""

import asyncio

import pytest
from nicegui import ui
from nicegui.testing.user_interaction import UserInteraction

from beamdyn.common.screens.form_entries import tables_of
from beamdyn.common.screens.open_document import OpenDocument
from beamdyn.common.screens.page_tasks import find
from beamdyn.common.screens.screens import Program
from brakes.answers.drum import BRAKE
from brakes.answers.finding import find_in_file
from brakes.app.program import BRAKES
from tests.app.serving import PATIENCE

DOCUMENTS = {document.name: document for document in BRAKES.documents}
DRUM = DOCUMENTS["drum"]
SO_THAT = "torque = 300 N m"


def element(user, label):
    (found,) = [e for e in user.client.elements.values() if e.props.get("label") == label]
    return found


def written(user, words):
    """Whether words are written on the page, also beside a picture."""
    return any(words in e.props.get("innerHTML", "") for e in user.client.elements.values())


@pytest.mark.parametrize("document", BRAKES.documents, ids=lambda document: document.name)
def test_every_screen_offers_its_first_input_and_result(document):
    work = OpenDocument(document)
    for screen in document.screens:
        offered = screen.backwards
        units = offered.units(tables_of(work.needed(screen), work.inputs))
        assert offered.result in units
        assert offered.input in {entry.path.removesuffix(".x") for entry in work.inputs} | {"points.C.x"}


def test_task_gives_the_answer_of_the_command_as_html():
    work = OpenDocument(DRUM)
    made = find(DRUM, DRUM.screens[0], dict(work.entries), "brake.friction", SO_THAT)
    same = find_in_file(BRAKE, tables_of(work.entries, work.inputs), "drum", "brake.friction", SO_THAT)
    assert f"<p>{same.message}</p>" in made
    assert "<table>" in made and "<img " in made


def test_what_is_wrong_with_a_question_is_said_as_by_the_command():
    entries = OpenDocument(DRUM).entries
    made = find(DRUM, DRUM.screens[0], entries, "brake.friction", "torque = 300 <b>")
    assert made.startswith('<p class="mistake">--so-that') and "<b>" not in made


def test_question_on_the_page_goes_grey_when_the_design_changes(simulate, fields):
    async def body(client):
        user = await client()
        page = fields(user)
        with user.client:
            element(user, "Find an input").set_value(True)
            element(user, "input that is sought").set_value("brake.friction")
            element(user, "so that the result").set_value("torque")
            element(user, "is").set_value("300")  # in the unit that stands behind it
        assert element(user, "is").props["suffix"] == "N m"
        (button,) = [
            e for e in user.client.elements.values() if isinstance(e, ui.button) and e.text == "Find"
        ]
        UserInteraction(user, {button}, None).click()
        async with asyncio.timeout(PATIENCE):
            while not written(user, "torque = 300 N m at brake.friction = 0.386911"):
                await asyncio.sleep(0.1)
        assert page.greyed() == 0
        page.enter("brake.friction", "0.3")
        assert page.greyed() == 1
        page.enter("brake.friction", "0.35")
        assert page.greyed() == 0

    simulate(Program("drum", "Drum", (DRUM,)), body)
