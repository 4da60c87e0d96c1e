"""What is computed for a page, as functions of a document and a screen that run in any process."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from beamdyn.common.edge.input_sweep import InputSweep
from beamdyn.common.edge.program import NoAnswer
from beamdyn.common.edge.rendering import csv_text, drawing, picture, png
from beamdyn.common.inputs.checks import reason_of
from beamdyn.common.screens.document_report import drawn, report_of
from beamdyn.common.screens.form_entries import Entries, tables_of
from beamdyn.common.screens.open_document import Answered, OpenDocument
from beamdyn.common.screens.screens import Document, Screen

Outcome = Answered | Mapping[str, list[str]]  # an answer, or what is wrong, by field
Swept = InputSweep | str  # a sweep, or why there is none


def solve(document: Document, screen: Screen, entries: Entries) -> Outcome:
    """The whole answer to these entries, also what takes time; or what is wrong, by field."""
    return _opened(document, entries).attempt(screen).solve()


def glance(document: Document, screen: Screen, entries: Entries) -> Outcome:
    """The answer as far as the drawing needs it, without tables and notes; or what is wrong, by field."""
    return _opened(document, entries).attempt(screen).glance()


def sweep(document: Document, screen: Screen, entries: Entries, text: str, results: str) -> Swept:
    """A sweep of one of these entries, or why there is none."""
    work = _opened(document, entries)
    assert screen.sweeps is not None
    try:
        return screen.sweeps.run(tables_of(work.needed(screen), work.inputs), text, results)
    except (ValueError, ArithmeticError, NoAnswer) as error:
        return reason_of(error)


# Parts and files that are made from an answer, and would hold up the pages --------------------------------


def folded(document: Document, screen: Screen, answer: Any, number: int) -> str:
    """One of the parts of an answer that fold out, in HTML."""
    return screen.more[number].on_page(answer)


def rows_file(document: Document, screen: Screen, answer: Any) -> str:
    """The numbers of an answer as a CSV file; for a beam they include the model error, which takes time."""
    return csv_text(screen.rows(answer))


def drawing_file(document: Document, screen: Screen, answer: Any, place: float, kind: str) -> bytes:
    """The drawing of an answer as a file, "svg" or "png"."""
    if kind == "png":
        return png(screen.draw(answer, place))
    return drawn(screen, answer, place).encode()


def sweep_file(document: Document, screen: Screen, swept: InputSweep, kind: str) -> bytes:
    """The picture of a sweep as a file, "svg" or "png"."""
    assert screen.sweeps is not None
    draw = screen.sweeps.draw
    return png(draw(swept)) if kind == "png" else drawing(lambda: draw(swept)).encode()


def sweep_picture(document: Document, screen: Screen, swept: InputSweep, words: str) -> str:
    """The picture of a sweep in HTML."""
    return picture(sweep_file(document, screen, swept, "svg").decode(), words)


Shown = Sequence[tuple[str, str, InputSweep]]  # sweeps that are shown: the screen's name, a title, the sweep


def report(
    document: Document,
    screen: Screen,
    entries: Entries,
    answered: Mapping[str, Answered],
    title: str,
    sweeps: Shown,
) -> str:
    """The HTML report on a document with these answers, by the names of their screens."""
    work = _opened(document, entries)
    work.answered = dict(answered)
    by_name = {screen.name: screen for screen in document.screens}
    pictures = [(said, sweep_picture(document, by_name[name], swept, said)) for name, said, swept in sweeps]
    return report_of(work, title, pictures)


def _opened(document: Document, entries: Entries) -> OpenDocument:
    work = OpenDocument(document)
    work.entries = entries
    return work
