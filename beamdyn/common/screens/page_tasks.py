"""Tasks of a page that any process can run (results, sweeps, files, reports); causes of missing results."""

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
from beamdyn.common.edge.rendering import csv_text, drawing, html, picture, png, svg, svg_in_haste
from beamdyn.common.inputs.checks import reason_of
from beamdyn.common.results.one_line import few_digits
from beamdyn.common.screens import form_entries
from beamdyn.common.screens.open_document import OpenDocument, Outcome, ShownAnswer
from beamdyn.common.screens.processes import TakesTooLong
from beamdyn.common.screens.screens import Document, Screen

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Swept = InputSweep | str  # a sweep, or the reason why there is none
# Sweeps that are shown: name of the screen, title and result of each.
Shown = Sequence[tuple[str, str, InputSweep]]
# Largest number of fields that a user is assumed to change by hand between two results; if more have changed,
# a file was opened.
_FEW = 3


# Tasks: functions of a `Document` (kind of file), a `Screen` and further arguments, for any process ------


def solve(
    document: Document, screen: Screen, entries: form_entries.Entries, drawn: ShownAnswer | None = None
) -> Outcome:
    """Compute a screen's result for field texts; return the result, or error messages by field.

    A preliminary result for the same texts, `drawn`, is completed.
    """
    return _opened(document, entries).attempt(screen, drawn=drawn)


def solve_for_drawing(
    document: Document, screen: Screen, entries: form_entries.Entries, narrow: bool = False
) -> Outcome:
    """Compute only what the drawing needs, without tables and notes; or return error messages by field.

    If the screen has a picture, a quickly drawn one is returned with the result.
    """
    found = _opened(document, entries).attempt(screen, for_drawing=True)
    if screen.picture is None or not isinstance(found, ShownAnswer) or found.is_whole:
        return found
    with few_digits() if found.is_rough else nullcontext():
        return replace(found, picture=picture_part(document, screen, found.answer, narrow, svg_in_haste))


def sweep(
    document: Document, screen: Screen, entries: form_entries.Entries, text: str, results: str
) -> Swept:
    """Compute results over a varied input; return the sweep, or the reason why there is none.

    `text` names the input and its values, `results` are the names of the results, separated by commas.
    """
    work = _opened(document, entries)
    assert screen.sweeps is not None
    try:
        return screen.sweeps.run(form_entries.tables_of(work.needed(screen), work.inputs), text, results)
    except (ValueError, ArithmeticError, NoAnswer) as error:
        return reason_of(error)


def find(document: Document, screen: Screen, entries: form_entries.Entries, sought: str, so_that: str) -> str:
    """Answer an inverse question (see `Backwards`) as HTML, or with a sentence on errors in the question."""
    work = _opened(document, entries)
    assert screen.backwards is not None
    try:
        return screen.backwards.find(
            form_entries.tables_of(work.needed(screen), work.inputs), sought, so_that
        )
    except (ValueError, ArithmeticError, NoAnswer) as error:
        return f'<p class="mistake">{escape(reason_of(error))}</p>'


def folded(document: Document, screen: Screen, answer: Any, number: int) -> str:
    """Return the foldable part `number` (an index of `Screen.more`) of a result as HTML."""
    return screen.more[number].on_page(answer)


def picture_part(
    document: Document, screen: Screen, answer: Any, narrow: bool, write: Callable[[Figure], str] = svg
) -> str:
    """Return the picture of a result as HTML, for a narrow or a wide page."""
    draw = screen.picture
    assert draw is not None
    return picture(drawing(lambda: draw(answer, narrow), write), f"{screen.name}: picture of the result")


def rows_file(document: Document, screen: Screen, answer: Any) -> str:
    """Return the numbers of a result as a CSV file; for a beam, the model error is computed, too."""
    return csv_text(screen.rows(answer))


def drawing_file(document: Document, screen: Screen, answer: Any, place: float, kind: str) -> bytes:
    """Return the drawing of a result at the slider's position `place`, as an "svg" or "png" file."""
    return png(screen.draw(answer, place)) if kind == "png" else drawn(screen, answer, place).encode()


def sweep_file(document: Document, screen: Screen, swept: InputSweep, kind: str) -> bytes:
    """Return the picture of a sweep as an "svg" or "png" file."""
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
    """Return the HTML report on a design.

    `answered` has the results to include, by name of the screen; `sweeps` are the sweeps to include.
    """
    work = _opened(document, entries)
    work.answered = dict(answered)
    by_name = {screen.name: screen for screen in document.screens}
    files = [(said, sweep_file(document, by_name[name], swept, "svg")) for name, said, swept in sweeps]
    return report_of(work, title, [(said, picture(file.decode(), said)) for said, file in files])


def _opened(document: Document, entries: form_entries.Entries) -> OpenDocument:
    work = OpenDocument(document)
    work.entries = entries
    return work


# HTML report on a design ----------------------------------------------------------------------------------


def drawn(screen: Screen, answer: object, place: float) -> str:
    """Return the drawing of a result at a position of the slider as SVG; a sentence if it cannot be drawn."""
    return drawing(lambda: screen.draw(answer, place))


def report_of(work: OpenDocument, title: str, sweeps: Iterable[tuple[str, str]] = ()) -> str:
    """Return the HTML report on a design.

    Parameters
    ----------
    work : OpenDocument
        The open input file.  The report contains tables and drawing of each screen whose result is up to
        date, and all inputs, with defaults for those that are not given.
    title : str
        Title of the report.
    sweeps : iterable of (title, picture)
        The sweeps that are shown, as HTML.
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
    """Return an HTML table of all inputs: name and symbol, value, whether it was given, and meaning."""
    made, idle = FittedTable(("input", "value", "", "meaning"), (0, 1, 2, 3)), work.idle
    for entry in work.inputs:
        if entry.path not in idle:
            text, default = work.entries.get(entry.path, "").strip(), form_entries.default_words(entry)
            table = form_entries.table_of(entry.path).replace("_", " ")
            state = "given" if text else "" if default == form_entries.NOT_GIVEN else "default"
            name = f"{table}: {form_entries.label(entry)}" if table else form_entries.label(entry)
            made.add_row(name, text or default, state, form_entries.help_of(entry))
    return html([made])


# Causes of missing results ------------------------------------------------------------------------------


def outcome_of(future: asyncio.Future[Outcome], work: OpenDocument, screen: Screen) -> Outcome:
    """Return the result of a finished computation; if it failed, sentences on the cause, by field.

    If the process died or took too long, the sentences name the inputs that have changed since the last
    result.
    """
    if future.cancelled():
        return {"": ["Cancelled. The computation starts again when an input changes."]}
    error = future.exception()
    if error is None:
        return future.result()
    if not isinstance(error, TakesTooLong | BrokenExecutor):
        return {"": [f"There is no answer, for a reason that the program does not know: {error!r}"]}
    since = {
        path: [f"this input has changed since the last answer; it was {_before(work, screen, path)}"]
        for path in changed(work, screen)
    }
    return {"": [f"Given up: {error}. {screen.effort}".rstrip()]} | since


def changed(work: OpenDocument, screen: Screen) -> list[str]:
    """Return the paths of inputs that have changed since a screen's last result; empty if there is none."""
    if (before := work.answered.get(screen.name)) is None:
        return []
    now = work.needed(screen)
    return [path for path in {**before.entries, **now} if before.entries.get(path) != now.get(path)]


def at_fault(work: OpenDocument, screen: Screen) -> dict[str, list[str]]:
    """Return the error messages on a screen, by path of the field that caused the error.

    An error without a single field is shown at all fields that have changed since the last result.  So are
    errors at unchanged fields if only few fields have changed: for example, a longer beam may make the
    unchanged top speed invalid.
    """
    mistakes = dict(work.mistakes.get(screen.name, {}))
    since = changed(work, screen)
    if "" in mistakes:
        return dict.fromkeys(since, mistakes[""]) | mistakes
    if not 0 < len(since) <= _FEW or not mistakes or {*since} & {*mistakes}:
        return mistakes
    causes = {path: f"the cause is {path}, changed from {_before(work, screen, path)}" for path in since}
    sentences = [said for each in mistakes.values() for said in each]
    return {path: [f"{said}; {cause}: change either" for said in sentences] for path, cause in causes.items()}


def _before(work: OpenDocument, screen: Screen, path: str) -> str:
    """Return the text that a field had when the screen's last result was computed."""
    return work.answered[screen.name].entries.get(path) or "empty"
