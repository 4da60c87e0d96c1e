"""The HTML report on the document that is open in an interactive program."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from datetime import datetime
from functools import partial
from html import escape

from beamdyn.common.edge.html_report import further, report_page
from beamdyn.common.edge.inputs import Input
from beamdyn.common.edge.rendering import drawing, html, picture
from beamdyn.common.screens.input_words import NOT_GIVEN, default_words, help_of, label, table_of
from beamdyn.common.screens.open_document import OpenDocument
from beamdyn.common.screens.screens import Screen

_Part = tuple[str, Sequence[str], str, str]


def drawn(screen: Screen, answer: object, place: float) -> str:
    """The drawing of an answer, at a position of the slider, as SVG; a sentence if it cannot be drawn."""
    return drawing(lambda: screen.draw(answer, place))


def report_of(
    work: OpenDocument, title: str, sweeps: Iterable[tuple[str, str]] = (), now: datetime | None = None
) -> str:
    """The HTML report on a document.

    Parameters
    ----------
    work : OpenDocument
        The document; in the report are tables and drawing of each screen whose answer is up to date, and
        every input, with its default where none is given.
    title : str
        Above it.
    sweeps : iterable of (title, picture)
        Sweeps that are shown, as HTML.
    now : datetime, optional
        Date of the report; now if not given.
    """
    parts = [*_answers(work), *((name, (), "", made) for name, made in sweeps)]
    when = (now or datetime.now().astimezone()).strftime("%Y-%m-%d %H:%M %Z").strip()
    inputs = ("Every input", (), f"<p>{escape(when)}</p>{inputs_html(work)}", "")
    return report_page(title, work.file(), [*parts, inputs])


def _answers(work: OpenDocument) -> Iterator[_Part]:
    for screen in work.document.screens:
        if not work.stale(screen):
            answered = work.answered[screen.name]
            answer = answered.answer
            made = picture(drawn(screen, answer, screen.last), screen.name)
            more = further((part.title, partial(part.in_report, answer)) for part in screen.more)
            yield screen.name, answered.notes, html(answered.tables) + more, made


def inputs_html(work: OpenDocument) -> str:
    """A table of every input in HTML: name and symbol, value, whether it was given, and meaning."""
    idle = work.idle
    shown = [entry for entry in work.inputs if entry.path not in idle]
    rows = "".join(_input_row(entry, work.entries.get(entry.path, "").strip()) for entry in shown)
    heads = "".join(f'<th class="words">{head}</th>' for head in ("input", "value", "", "meaning"))
    head = f"<thead><tr>{heads}</tr></thead>"
    return f'<div class="scrolls" tabindex="0"><table>{head}<tbody>{rows}</tbody></table></div>'


def _input_row(entry: Input, text: str) -> str:
    default, table = default_words(entry), table_of(entry.path).replace("_", " ")
    state = "given" if text else "" if default == NOT_GIVEN else "default"
    cells = (f"{table}: {label(entry)}" if table else label(entry), text or default, state, help_of(entry))
    return "<tr>" + "".join(f'<td class="words">{escape(cell)}</td>' for cell in cells) + "</tr>"
