"""The report on a document of an interactive program."""

import pickle
import re
import tomllib
from datetime import datetime
from html import unescape

import pytest

from beamdyn import __version__
from beamdyn.app.program import BEAMDYN
from beamdyn.common.edge.rendering import html
from beamdyn.common.screens import page_tasks
from beamdyn.common.screens.form_entries import NOT_GIVEN, default_words, label
from beamdyn.common.screens.open_document import OpenDocument
from beamdyn.common.screens.page_tasks import report_of
from brakes.app.program import BRAKES, CALIPER

DRUM = next(document for document in BRAKES.documents if document.name == "drum")
DOCUMENTS = [*BRAKES.documents, *BEAMDYN.documents]


def solved(document):
    work = OpenDocument(document)
    for screen in document.screens:
        assert work.solve(screen), work.mistakes
    return work


def inputs(page):
    text = re.findall(r"<pre>(.*?)</pre>", page, re.DOTALL)[-1]  # after the scene that a deck makes
    return tomllib.loads(unescape(text))


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda d: d.name)
def test_report_has_inputs_results_drawings_and_version(document):
    work = solved(document)
    page = report_of(work, "Mine")
    more = [part for screen in document.screens for part in screen.more]
    assert all(f"<h3>{part.title}</h3>" in page for part in more)
    drawings = len(document.screens) + sum(part.title == "Free bodies" for part in more)
    assert page.count("data:image/svg+xml;base64,") == drawings
    assert inputs(page) == tomllib.loads(work.text()) == tomllib.loads(document.base)
    assert page.count("<pre>") == (2 if document.name == "deck" else 1)
    assert f"beamdyn {__version__}" in page
    assert all(f"# {path} = {text}" in page for path, text in document.aside.items())
    for screen in document.screens:
        assert f"<h2>{screen.name}</h2>" in page
        assert html(work.answered[screen.name].tables) in page
        notes = work.answered[screen.name].notes  # in the words of the form
        assert all(f"Warning:</strong> {note}" in unescape(page) for note in notes)


def test_report_has_a_warning_once():
    """The forklift's lining enters the drum: a warning of kinematics and of forces, but once each."""
    work = solved(BRAKES.documents[0])
    page = report_of(work, "Mine")
    for part in page.split("<h2>")[1:]:
        said = re.findall(r"Warning:</strong> (.*?)</p>", part)
        assert len(said) == len(set(said))
    assert page.count("the lining enters the drum by") >= 1


def test_refused_answer_is_reported_with_its_reason():
    work = OpenDocument(DRUM)
    work.put("brake.friction", "1.2")
    assert work.solve(DRUM.screens[0])
    assert "Warning:</strong> locked: friction 1.2" in report_of(work, "Mine")


def test_free_bodies_are_in_the_report_of_a_caliper():
    page = report_of(solved(CALIPER), "Mine")
    assert "<h3>Free bodies</h3>" in page and 'alt="Free bodies"' in page


def test_answer_that_is_stale_is_left_out():
    work = solved(CALIPER)
    work.put("run.finger", "much")
    assert not work.solve(CALIPER.screens[0])
    page = report_of(work, "Mine")
    assert f"<h2>{CALIPER.screens[0].name}</h2>" not in page and inputs(page)["run"]["finger"] == "much"


def test_report_has_title_date_every_input_and_the_sweeps_that_are_shown():
    """What the page asks for: made of the answers alone, in a process that holds nothing of the page."""
    work = solved(DRUM)
    (screen,) = DRUM.screens
    swept = page_tasks.sweep(DRUM, screen, work.entries, "brake.friction=0.2:0.4:5", "torque")
    shown = [(screen.name, "Sweep of friction", swept)]
    sent = pickle.loads(pickle.dumps((work.entries, work.answered, "My drum", shown)))
    page = unescape(page_tasks.report(DRUM, screen, *sent))
    assert "<h1>My drum</h1>" in page and "<h2>Sweep of friction</h2>" in page
    assert re.search(rf"<p>{datetime.now().year}-\d\d-\d\d \d\d:\d\d", page)
    table = page.partition("<h2>Every input</h2>")[2]
    inputs = DRUM.inputs(work.entries)
    for entry in inputs:
        assert label(entry) in table, entry.path
        default = default_words(entry)
        assert (work.entries.get(entry.path, "").strip() or default) in table, entry.path
    given = [bool(work.entries.get(entry.path, "").strip()) for entry in inputs]
    usual = [default_words(entry) != NOT_GIVEN for entry in inputs]
    assert table.count(">given<") == sum(given)
    assert table.count(">default<") == sum(u and not g for g, u in zip(given, usual, strict=True))
    assert page.count("data:image/svg+xml;base64,") == 2
