"""The report on a design: inputs, results, drawings and warnings in one HTML file that needs no other."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from importlib.metadata import PackageNotFoundError, version

from beamdyn.common.app.session import Work
from beamdyn.common.app.shown import STYLE, drawn, further, html, picture


def report_of(work: Work, title: str) -> str:
    """A report on a document: what is shown of each screen that has an answer to the entries."""
    parts = []
    for screen in work.document.screens:
        if not work.stale(screen):
            answer = work.answered[screen.name].answer
            drawing = picture(drawn(screen, answer, 1.0), screen.name)
            tables = html(screen.report(answer)) + further(screen, answer)
            parts.append((screen.name, screen.notes(answer), tables, drawing))
    return report_page(title, work.text(), parts)


def report_page(title: str, inputs: str, parts: Iterable[tuple[str, Sequence[str], str, str]]) -> str:
    """A report that needs no other file.

    Parameters
    ----------
    title : str
        Of the report.
    inputs : str
        The design as TOML.
    parts : iterable of (name, warnings, tables, drawing)
        Of each screen; tables are HTML, drawings are elements as `picture` makes them.
    """
    body = "".join(
        f"<h2>{escape(name)}</h2>{''.join(f'<p><strong>Warning:</strong> {escape(w)}</p>' for w in said)}"
        f"{drawing}{tables}"
        for name, said, tables, drawing in parts
    )
    page = (
        "body { font-family: sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; } "
        "pre { background: #f4f4f4; padding: 1rem; overflow-x: auto; }"
    )
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        f'<meta name="viewport" content="width=device-width"><style>{page}{STYLE}</style></head>'
        f'<body class="shown"><h1>{escape(title)}</h1>{body}<h2>Inputs</h2><pre>{escape(inputs)}</pre>'
        f"<p>beamdyn {escape(_version())}</p></body></html>\n"
    )


def _version() -> str:
    try:
        return version("beamdyn")
    except PackageNotFoundError:
        return "not installed, run from its source"
