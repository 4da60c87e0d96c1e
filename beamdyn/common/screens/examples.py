"""The example files that are part of the packages."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path
from textwrap import shorten

from beamdyn.common.screens.screens import Document, Program

_LONGEST = 110  # largest number of characters in the title of an example
_SENTENCE = re.compile(r"\.\s+(?=[A-Z])")  # pattern of the end of a sentence
_CLAUSE = re.compile(r"[;:,] ")


@dataclass(frozen=True)
class Example:
    """An example file of a program.

    Parameters
    ----------
    name : str
        Name of the file, without its suffix.
    title : str
        Description of the example in one sentence.
    document : Document
        The document (kind of file) that can open the example.
    text : str
        Content of the file.
    """

    name: str
    title: str
    document: Document
    text: str


# Examples that each program can open, by name of the program.  They are kept here, since finding out which
# files a program can open takes a second.
_KNOWN: dict[str, tuple[Example, ...]] = {}


def examples_of(program: Program) -> tuple[Example, ...]:
    """Return the examples that a program can open, in alphabetical order of their file names."""
    if program.name not in _KNOWN:
        _KNOWN[program.name] = tuple(_accepted(program))
    return _KNOWN[program.name]


def examples_folder() -> Path:
    """Return the folder of examples in the installed package; if it has none, that of the source tree."""
    packed = Path(__file__).with_name("shipped_examples")
    return packed if packed.is_dir() else Path(__file__).parents[3] / "examples"


def _accepted(program: Program) -> Iterator[Example]:
    """Yield the TOML files that the program can open, each with the first `Document` that accepts it."""
    folder = examples_folder()
    found = [file for place in (folder, folder / "calipers") for file in place.glob("*.toml")]
    for file in sorted(found, key=lambda file: file.name):
        text, name = file.read_text(encoding="utf-8"), file.name.removesuffix(".toml")
        for document in program.documents:
            if document.accepts(text):
                yield Example(name, _title(text, name), document, text)
                break


def _title(text: str, name: str) -> str:
    """Return the first sentence of the comment at the start of a file, shortened if it is long.

    Without such a comment, return the name of the file.
    """
    lines = takewhile(lambda line: line.startswith("#"), text.splitlines())
    words = _SENTENCE.split(" ".join(line.lstrip("# ") for line in lines))[0]
    if len(words) > _LONGEST:
        ends = [end for found in _CLAUSE.finditer(words) if (end := found.start()) <= _LONGEST]
        words = words[: ends[-1]] if ends else shorten(words, _LONGEST, placeholder=" ...")
    return words.rstrip(" .:") or name
