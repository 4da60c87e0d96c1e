"""Sentences of the core in the terms of files, commands and forms; a module without slow imports."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

from beamdyn.common.words import Named, Part, Setting, Words, worded

_HEADING: ContextVar[Callable[[str], str] | None] = ContextVar("heading", default=None)


def in_files(text: str, units: Any = None) -> str:
    """A text in the terms of files and commands, and with its speeds in a display unit, if units are given.

    `Physics(shear=True)` becomes "[physics] shear = true", on a form "Physics: shear = true".
    """
    return worded(text, lambda part: word(part, units))


def word(part: Part, units: Any = None) -> str:
    """A part of a text in the terms of files, or of the form that asks."""
    if isinstance(part, Setting) and (heading := _HEADING.get()) is not None:
        return part.on_form(heading(part.table))
    if isinstance(part, Named):
        return part.elsewhere
    return str(part) if units is None else part.in_units(units)


def say(error: Exception) -> str:
    """The message of an error in the terms of files and commands."""
    composed, (first, *_) = getattr(error, "worded", None), (*error.args, "")
    if composed is not None:
        return composed(word)
    return in_files(first) if isinstance(first, Words) else str(error)


@contextmanager
def on_form(heading: Callable[[str], str]) -> Iterator[None]:
    """Within it, settings are called as a form does that has them under these headings of tables."""
    before = _HEADING.set(heading)
    try:
        yield
    finally:
        _HEADING.reset(before)
