"""HTML reports: inputs, results, drawings and warnings in one self-contained file."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING

from beamdyn._version import __version__
from beamdyn.common.edge.rendering import STYLE, drawing, html, picture

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import RenderableType

_STYLE = """
body { font-family: sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
pre { background: #f4f4f4; padding: 1rem; white-space: pre-wrap; overflow-wrap: anywhere; }
.warning { border-left: 4px solid #E69F00; padding-left: 0.5rem; }
"""


@dataclass(frozen=True)
class Question:
    """A command with its options and its input file, as shown in a report.

    Parameters
    ----------
    title : str
        Command and file.
    inputs : str
        The command with its options in a comment, above the text of its file: valid TOML as a whole.
    """

    title: str
    inputs: str

    @classmethod
    def of(cls, command: str, file: object, text: str, **options: object) -> Question:
        """Make the record of a command: its words, its options and the text of its input file.

        Options that are None, False or an empty tuple are left out.
        """
        words = [*command.split(), str(file)]
        for name, value in options.items():
            option = f"--{name.replace('_', '-')}"
            for given in value if isinstance(value, tuple) else (value,):
                if given is not None and given is not False:
                    words += [option] if given is True else [option, str(given)]
        # The command is written as one line, so that it can be a comment.
        line = "".join(c if c.isprintable() else " " for c in shlex.join(words))
        return cls(f"{command}: {file}", f"# {line}\n\n{text}")


@dataclass(frozen=True)
class Report:
    """Contents of a command's HTML report, except for the main drawing.

    Parameters
    ----------
    question : Question
        The command and its input.
    tables : sequence of rich renderables
        Tables and sentences, as printed on the console.
    warnings : sequence of str
        Warnings, and reasons for missing results.
    more : sequence of (title, callable)
        Further sections; each callable returns the section's content as HTML.
    """

    question: Question
    tables: Sequence[RenderableType]
    warnings: Sequence[str] = ()
    more: Sequence[tuple[str, Callable[[], str]]] = ()

    def page(self, draw: Callable[[], Figure] | None) -> str:
        """Return the report as HTML, with the main drawing unless `draw` is None."""
        tables = html(self.tables) + further(self.more)
        title = self.question.title
        made = "" if draw is None else picture(drawing(draw), title)
        return report_page(title, self.question.inputs, [("Results", self.warnings, tables, made)])


def further(parts: Iterable[tuple[str, Callable[[], str]]]) -> str:
    """Return further sections as HTML, each below its title."""
    return "\n".join(f"<h3>{escape(title)}</h3>{make()}" for title, make in parts)


def report_page(title: str, inputs: str, parts: Iterable[tuple[str, Sequence[str], str, str]]) -> str:
    """Return a report as a self-contained HTML page.

    Parameters
    ----------
    title : str
        Title of the report.
    inputs : str
        The input file as TOML text.
    parts : iterable of (name, warnings, tables, drawing)
        Content for each screen; tables are HTML, drawings are elements as `picture` makes them.
    """
    warning = '<p class="warning"><strong>Warning:</strong> {}</p>'
    body = "".join(
        f"<h2>{escape(name)}</h2>"
        f"{''.join(warning.format(escape(said)) for said in dict.fromkeys(warnings))}{made}{tables}"
        for name, warnings, tables, made in parts
    )
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        f'<meta name="viewport" content="width=device-width"><style>{_STYLE}{STYLE}</style></head>'
        f'<body class="shown"><h1>{escape(title)}</h1>{body}<h2>Inputs</h2><pre>{escape(inputs)}</pre>'
        f"<p>beamdyn {escape(__version__)}</p></body></html>\n"
    )
