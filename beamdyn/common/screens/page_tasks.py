"""Tasks of a page that run in any process: answers, sweeps, files, reports; and reasons for no answer."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import BrokenExecutor
from contextlib import nullcontext
from dataclasses import replace
from datetime import datetime
from functools import partial
from html import escape
from typing import TYPE_CHECKING, Any

from beamdyn.common.edge.console import FittedTable
from beamdyn.common.edge.exit_codes import NoAnswer
from beamdyn.common.edge.html_report import further, report_page
from beamdyn.common.edge.input_sweep import InputSweep
from beamdyn.common.edge.rendering import csv_text, drawing, html, in_haste, picture, png
from beamdyn.common.inputs.checks import reason_of
from beamdyn.common.results.one_line import few_digits
from beamdyn.common.screens import form_entries
from beamdyn.common.screens.open_document import OpenDocument, Outcome, ShownAnswer
from beamdyn.common.screens.processes import TakesTooLong
from beamdyn.common.screens.screens import Document, Screen

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Swept = InputSweep | str  # a sweep, or why there is none
# Sweeps that are shown, each with its screen's name and a title.
Shown = Sequence[tuple[str, str, InputSweep]]
# Largest number of fields that people change by hand between two answers; if more have changed, a file was
# opened.
_FEW = 3


# Tasks: functions of a document, a screen, and further arguments, which run in any process
# ----------------------


def solve(
    document: Document, screen: Screen, entries: form_entries.Entries, drawn: ShownAnswer | None = None
) -> Outcome:
    """Solve entries for a screen; return the answer, or mistakes by field.

    An answer to the entries that was solved for the drawing alone, `drawn`, is completed.
    """
    return _opened(document, entries).attempt(screen, drawn=drawn)


def solve_for_drawing(
    document: Document, screen: Screen, entries: form_entries.Entries, narrow: bool = False
) -> Outcome:
    """Solve entries as far as the drawing needs it, without tables and notes; or return mistakes by field.

    Where the screen has a picture that other processes make, it comes with the answer, drawn fast.
    """
    found = _opened(document, entries).attempt(screen, for_drawing=True)
    if screen.picture is None or not isinstance(found, ShownAnswer) or found.is_whole:
        return found
    with few_digits() if found.is_rough else nullcontext():
        return replace(found, picture=_picture(screen, found.answer, narrow, in_haste))


def sweep(
    document: Document, screen: Screen, entries: form_entries.Entries, text: str, results: str
) -> Swept:
    """Sweep one of the entries; return the sweep, or why there is none."""
    work = _opened(document, entries)
    assert screen.sweeps is not None
    try:
        return screen.sweeps.run(form_entries.tables_of(work.needed(screen), work.inputs), text, results)
    except (ValueError, ArithmeticError, NoAnswer) as error:
        return reason_of(error)


def find(document: Document, screen: Screen, entries: form_entries.Entries, sought: str, so_that: str) -> str:
    """Answer an inverse question (see `Backwards`) as HTML; or word what is wrong with the question."""
    work = _opened(document, entries)
    assert screen.backwards is not None
    try:
        return screen.backwards.find(
            form_entries.tables_of(work.needed(screen), work.inputs), sought, so_that
        )
    except (ValueError, ArithmeticError, NoAnswer) as error:
        return f'<p class="mistake">{escape(reason_of(error))}</p>'


def folded(document: Document, screen: Screen, answer: Any, number: int) -> str:
    """Make a part of an answer that folds out, in HTML."""
    return screen.more[number].on_page(answer)


def picture_part(document: Document, screen: Screen, answer: Any, narrow: bool) -> str:
    """Return the picture of an answer in HTML, for a narrow page or a wide one."""
    return _picture(screen, answer, narrow)


def _picture(screen: Screen, answer: Any, narrow: bool, *finish: Callable[[Figure], Figure]) -> str:
    draw = screen.picture
    assert draw is not None
    return picture(drawing(lambda: draw(answer, narrow), *finish), f"{screen.name}: picture of the result")


def rows_file(document: Document, screen: Screen, answer: Any) -> str:
    """Write the numbers of an answer as a CSV file; for a beam this computes the model error, too."""
    return csv_text(screen.rows(answer))


def drawing_file(document: Document, screen: Screen, answer: Any, place: float, kind: str) -> bytes:
    """Write the drawing of an answer as a file, "svg" or "png"."""
    return png(screen.draw(answer, place)) if kind == "png" else drawn(screen, answer, place).encode()


def sweep_file(document: Document, screen: Screen, swept: InputSweep, kind: str) -> bytes:
    """Draw the picture of a sweep as a file, "svg" or "png"."""
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
    """Write the HTML report on a document, from answers by the names of their screens."""
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
    """Draw an answer, at a position of the slider, as SVG; a sentence if it cannot be drawn."""
    return drawing(lambda: screen.draw(answer, place))


def report_of(work: OpenDocument, title: str, sweeps: Iterable[tuple[str, str]] = ()) -> str:
    """Write the HTML report on a document.

    Parameters
    ----------
    work : OpenDocument
        The document; in the report are tables and drawing of each screen whose answer is up to date, and
        every input, with its default where none is given.
    title : str
        Title of the report.
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
    """Write an HTML table of all inputs: name and symbol, value, whether it was given, and meaning."""
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
    """Return the outcome of a finished computation; if it has none, sentences by field that say why.

    If the process died or took too long, the inputs that have changed since the last answer are named.
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
    """Return the paths of entries changed since a screen's last answer; empty if there is none."""
    if (before := work.answered.get(screen.name)) is None:
        return []
    now = work.needed(screen)
    return [path for path in {**before.entries, **now} if before.entries.get(path) != now.get(path)]


def at_fault(work: OpenDocument, screen: Screen) -> dict[str, list[str]]:
    """Return the mistakes on a screen, by the path of the field at fault.

    A mistake about no single field stands at all fields that have changed since the last answer.  So do
    mistakes at unchanged fields if few have changed: a longer beam may cause the refusal of a top speed.
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
    """Return the text that an entry had when the screen's last answer was computed."""
    return work.answered[screen.name].entries.get(path) or "empty"
