"""The HTML report on the document that is open in an interactive program."""

from __future__ import annotations

from functools import partial

from beamdyn.common.app.open_document import OpenDocument
from beamdyn.common.app.screens import Screen
from beamdyn.common.edge.html_report import further, report_page
from beamdyn.common.edge.rendering import drawing, html, picture


def drawn(screen: Screen, answer: object, place: float) -> str:
    """The drawing of an answer, at a position of the slider, as SVG; a sentence if it cannot be drawn."""
    return drawing(lambda: screen.draw(answer, place))


def report_of(work: OpenDocument, title: str) -> str:
    """The HTML report on a document: tables and drawing of each screen whose answer is up to date."""
    parts = []
    for screen in work.document.screens:
        if not work.stale(screen):
            answered = work.answered[screen.name]
            answer = answered.answer
            made = picture(drawn(screen, answer, screen.last), screen.name)
            more = further((name, partial(draw, answer)) for name, draw in screen.more)
            parts.append((screen.name, answered.notes, html(answered.tables) + more, made))
    options = "".join(f"# {path} = {work.entries[path]}\n" for path in work.document.aside)
    return report_page(title, "\n".join(filter(None, (options, work.text()))), parts)
