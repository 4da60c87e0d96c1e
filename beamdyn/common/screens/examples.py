"""The examples that come with the packages."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path
from textwrap import shorten

from beamdyn.common.screens.screens import Document, Program

_LONGEST = 110  # largest number of characters of a title
_SENTENCE = re.compile(r"\.\s+(?=[A-Z])")  # end of a sentence
_CLAUSE = re.compile(r"[;:,] ")


@dataclass(frozen=True)
class Example:
    """An example that comes with a program.

    Parameters
    ----------
    name : str
        Name of its file, without the suffix.
    title : str
        Description in a sentence.
    document : Document
        The document that can open it.
    text : str
        Content of its file.
    """

    name: str
    title: str
    document: Document
    text: str


_KNOWN: dict[str, tuple[Example, ...]] = {}  # checked examples by program, kept as the check takes a second


def examples_of(program: Program) -> tuple[Example, ...]:
    """Return the examples that one of a program's documents accepts, by name."""
    if program.name not in _KNOWN:
        _KNOWN[program.name] = tuple(_accepted(program))
    return _KNOWN[program.name]


def examples_folder() -> Path:
    """Return the folder of examples of the installed package, or of the source tree around it."""
    packed = Path(__file__).with_name("shipped_examples")
    return packed if packed.is_dir() else Path(__file__).parents[3] / "examples"


def _accepted(program: Program) -> Iterator[Example]:
    """Yield the TOML files that a document of the program accepts."""
    folder = examples_folder()
    found = [file for place in (folder, folder / "calipers") for file in place.glob("*.toml")]
    for file in sorted(found, key=lambda file: file.name):
        text, name = file.read_text(encoding="utf-8"), file.name.removesuffix(".toml")
        for document in program.documents:
            if document.accepts(text):
                yield Example(name, _title(text, name), document, text)
                break


def _title(text: str, name: str) -> str:
    """Return the first sentence of a file's comment at its head, shortened to whole clauses; or its name."""
    lines = takewhile(lambda line: line.startswith("#"), text.splitlines())
    words = _SENTENCE.split(" ".join(line.lstrip("# ") for line in lines))[0]
    if len(words) > _LONGEST:
        ends = [end for found in _CLAUSE.finditer(words) if (end := found.start()) <= _LONGEST]
        words = words[: ends[-1]] if ends else shorten(words, _LONGEST, placeholder=" ...")
    return words.rstrip(" .:") or name
