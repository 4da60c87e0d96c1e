"""Tasks of a page that run in any process: answers, sweeps, files, reports; and why there is no answer."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import BrokenExecutor
from datetime import datetime
from functools import partial
from html import escape
from typing import Any

from beamdyn.common.edge.exit_codes import NoAnswer
from beamdyn.common.edge.html_report import further, report_page
from beamdyn.common.edge.input_sweep import InputSweep
from beamdyn.common.edge.rendering import csv_text, drawing, html, picture, png
from beamdyn.common.edge.tables import FittedTable
from beamdyn.common.inputs.checks import reason_of
from beamdyn.common.screens import form_entries
from beamdyn.common.screens.open_document import OpenDocument, Outcome, ShownAnswer
from beamdyn.common.screens.processes import TakesTooLong
from beamdyn.common.screens.screens import Document, Screen

Swept = InputSweep | str  # a sweep, or why there is none
Shown = Sequence[tuple[str, str, InputSweep]]  # sweeps that are shown: the screen's name, a title, the sweep
_FEW = 3  # fields that are changed by hand between two answers; a file that is opened changes more


# Tasks: functions of a document, a screen, and what else is needed, which run in any process ---------------


def solve(document: Document, screen: Screen, entries: form_entries.Entries) -> Outcome:
    """The whole answer to these entries, also what takes time; or what is wrong, by field."""
    return _opened(document, entries).attempt(screen)


def solve_for_drawing(document: Document, screen: Screen, entries: form_entries.Entries) -> Outcome:
    """The answer as far as the drawing needs it, without tables and notes; or what is wrong, by field."""
    return _opened(document, entries).attempt(screen, for_drawing=True)


def sweep(
    document: Document, screen: Screen, entries: form_entries.Entries, text: str, results: str
) -> Swept:
    """A sweep of one of these entries, or why there is none."""
    work = _opened(document, entries)
    assert screen.sweeps is not None
    try:
        return screen.sweeps.run(form_entries.tables_of(work.needed(screen), work.inputs), text, results)
    except (ValueError, ArithmeticError, NoAnswer) as error:
        return reason_of(error)


def find(document: Document, screen: Screen, entries: form_entries.Entries, sought: str, so_that: str) -> str:
    """The answer to a question backwards on these entries in HTML, or what is wrong with the question."""
    work = _opened(document, entries)
    assert screen.backwards is not None
    try:
        return screen.backwards.find(
            form_entries.tables_of(work.needed(screen), work.inputs), sought, so_that
        )
    except (ValueError, ArithmeticError, NoAnswer) as error:
        return f'<p class="mistake">{escape(reason_of(error))}</p>'


def folded(document: Document, screen: Screen, answer: Any, number: int) -> str:
    """One of the parts of an answer that fold out, in HTML."""
    return screen.more[number].on_page(answer)


def picture_part(document: Document, screen: Screen, answer: Any, narrow: bool) -> str:
    """The picture of an answer in HTML, for a narrow page or a wide one."""
    draw = screen.picture
    assert draw is not None
    return picture(drawing(lambda: draw(answer, narrow)), f"{screen.name}: picture of the result")


def rows_file(document: Document, screen: Screen, answer: Any) -> str:
    """The numbers of an answer as a CSV file; for a beam they include the model error, which takes time."""
    return csv_text(screen.rows(answer))


def drawing_file(document: Document, screen: Screen, answer: Any, place: float, kind: str) -> bytes:
    """The drawing of an answer as a file, "svg" or "png"."""
    return png(screen.draw(answer, place)) if kind == "png" else drawn(screen, answer, place).encode()


def sweep_file(document: Document, screen: Screen, swept: InputSweep, kind: str) -> bytes:
    """The picture of a sweep as a file, "svg" or "png"."""
    assert screen.sweeps is not None
    draw = screen.sweeps.draw
    return png(draw(swept)) if kind == "png" else drawing(lambda: draw(swept)).encode()


def report(
    document: Document,
    screen: Screen,
    entries: form_entries.Entries,
    answered: Mapping[str, ShownAnswer],
    title: str,
    sweeps: Shown,
) -> str:
    """The HTML report on a document with these answers, by the names of their screens."""
    work = _opened(document, entries)
    work.answered = dict(answered)
    by_name = {screen.name: screen for screen in document.screens}
    files = [(said, sweep_file(document, by_name[name], swept, "svg")) for name, said, swept in sweeps]
    return report_of(work, title, [(said, picture(file.decode(), said)) for said, file in files])


def _opened(document: Document, entries: form_entries.Entries) -> OpenDocument:
    work = OpenDocument(document)
    work.entries = entries
    return work


# Reports --------------------------------------------------------------------------------------------------


def drawn(screen: Screen, answer: object, place: float) -> str:
    """The drawing of an answer, at a position of the slider, as SVG; a sentence if it cannot be drawn."""
    return drawing(lambda: screen.draw(answer, place))


def report_of(work: OpenDocument, title: str, sweeps: Iterable[tuple[str, str]] = ()) -> str:
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
    """
    parts: list[tuple[str, Sequence[str], str, str]] = []
    for screen in work.document.screens:
        if not work.stale(screen):
            answered = work.answered[screen.name]
            made = picture(drawn(screen, answered.answer, screen.last), screen.name)
            more = further((part.title, partial(part.in_report, answered.answer)) for part in screen.more)
            parts.append((screen.name, answered.notes, html(answered.tables) + more, made))
    parts += [(name, (), "", made) for name, made in sweeps]
    when = datetime.now().astimezone().strftime("%Y-%m-%d %H:%M %Z").strip()
    parts.append(("Every input", (), f"<p>{escape(when)}</p>{inputs_html(work)}", ""))
    return report_page(title, work.file(), parts)


def inputs_html(work: OpenDocument) -> str:
    """A table of every input in HTML: name and symbol, value, whether it was given, and meaning."""
    made, idle = FittedTable(("input", "value", "", "meaning"), (0, 1, 2, 3)), work.idle
    for entry in work.inputs:
        if entry.path not in idle:
            text, default = work.entries.get(entry.path, "").strip(), form_entries.default_words(entry)
            table = form_entries.table_of(entry.path).replace("_", " ")
            state = "given" if text else "" if default == form_entries.NOT_GIVEN else "default"
            name = f"{table}: {form_entries.label(entry)}" if table else form_entries.label(entry)
            made.add_row(name, text or default, state, form_entries.help_of(entry))
    return html([made])


# Why there is no answer -----------------------------------------------------------------------------------


def outcome_of(future: asyncio.Future[Outcome], work: OpenDocument, screen: Screen) -> Outcome:
    """The outcome of a computation that is done; if it was ended: why, and what had changed.

    That is said at the fields of the inputs that have changed since the last answer.
    """
    if future.cancelled():
        return {"": ["Cancelled. The next change of an input is computed again."]}
    error = future.exception()
    if error is None:
        return future.result()
    if not isinstance(error, TakesTooLong | BrokenExecutor):
        return {"": [f"There is no answer, for a reason that the program does not know: {error!r}"]}
    since = {
        path: [f"since the last answer this has changed; it was {_before(work, screen, path)}"]
        for path in changed(work, screen)
    }
    return {"": [f"Given up: {error}. {screen.effort}".rstrip()]} | since


def changed(work: OpenDocument, screen: Screen) -> list[str]:
    """Paths of the entries that have changed since the last answer of a screen; none where there is none."""
    if (before := work.answered.get(screen.name)) is None:
        return []
    now = work.needed(screen)
    return [path for path in {**before.entries, **now} if before.entries.get(path) != now.get(path)]


def at_fault(work: OpenDocument, screen: Screen) -> dict[str, list[str]]:
    """Mistakes on a screen, by the path of the field at fault.

    What is about no single field is about all that have changed since the last answer.  So is what is about
    others than these, if they are few: a top speed is refused since the beam has been made longer.
    """
    mistakes = dict(work.mistakes.get(screen.name, {}))
    since = changed(work, screen)
    if "" in mistakes:
        return dict.fromkeys(since, mistakes[""]) | mistakes
    if not 0 < len(since) <= _FEW or not mistakes or {*since} & {*mistakes}:
        return mistakes
    causes = {path: f"that comes from {path}, which was {_before(work, screen, path)}" for path in since}
    sentences = [said for each in mistakes.values() for said in each]
    return {path: [f"{said}; {cause}: change either" for said in sentences] for path, cause in causes.items()}


def _before(work: OpenDocument, screen: Screen, path: str) -> str:
    """The text of an entry at the last answer."""
    return work.answered[screen.name].entries.get(path) or "empty"
