"""The report on a document that is worked on, and the drawing of an answer as it has it."""

from __future__ import annotations

from functools import partial

from beamdyn.common.app.open_document import OpenDocument
from beamdyn.common.app.screens import Screen
from beamdyn.common.edge.html_report import further, report_page
from beamdyn.common.edge.rendering import drawing, html, picture


def drawn(screen: Screen, answer: object, place: float) -> str:
    """The SVG of an answer with the slider at a place, or the sentence why there is none."""
    return drawing(lambda: screen.draw(answer, place))


def report_of(work: OpenDocument, title: str) -> str:
    """A report on a document: what is shown of each screen that has an answer to the entries."""
    parts = []
    for screen in work.document.screens:
        if not work.stale(screen):
            answer = work.answered[screen.name].answer
            made = picture(drawn(screen, answer, screen.last), screen.name)
            more = further((name, partial(draw, answer)) for name, draw in screen.more)
            parts.append((screen.name, screen.notes(answer), html(screen.tables(answer)) + more, made))
    asked = "".join(f"# {path} = {work.entries[path]}\n" for path in work.document.aside)
    return report_page(title, "\n".join(filter(None, (asked, work.text()))), parts)
