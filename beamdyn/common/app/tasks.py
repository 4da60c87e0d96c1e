"""What is computed for a page, as functions of a document and a screen that run in any process."""

from __future__ import annotations

from collections.abc import Mapping

from beamdyn.common.app.form_entries import Entries, tables_of
from beamdyn.common.app.open_document import Answered, OpenDocument
from beamdyn.common.app.screens import Document, Screen
from beamdyn.common.edge.input_sweep import InputSweep
from beamdyn.common.edge.program import NoAnswer

Outcome = Answered | Mapping[str, list[str]]  # an answer, or what is wrong, by field
Swept = InputSweep | str  # a sweep, or why there is none


def solve(document: Document, screen: Screen, entries: Entries) -> Outcome:
    """The answer to these entries, with all that takes time."""
    return _opened(document, entries).attempt(screen).solve()


def glance(document: Document, screen: Screen, entries: Entries) -> Outcome:
    """The answer as far as a drawing shows it, without tables and notes."""
    attempt = _opened(document, entries).attempt(screen)
    return attempt.glance(Answered(None, (), (), {}))


def sweep(document: Document, screen: Screen, entries: Entries, text: str, results: str) -> Swept:
    """A sweep of one of these entries."""
    work = _opened(document, entries)
    assert screen.sweeps is not None
    try:
        return screen.sweeps.run(tables_of(work.needed(screen), work.inputs), text, results)
    except (ValueError, ArithmeticError, NoAnswer) as error:
        return str(error)


def _opened(document: Document, entries: Entries) -> OpenDocument:
    work = OpenDocument(document)
    work.entries = entries
    return work
