"""Wording of messages and of typing mistakes in terms of files and options, without slow imports."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from itertools import pairwise
from typing import Any, Literal, get_args, get_origin

from cyclopts import (
    App,
    CoercionError,
    CycloptsError,
    RepeatArgumentError,
    UnknownOptionError,
    UnusedCliTokensError,
)

from beamdyn.common.words import InputName, Named, Part, Setting, Words, worded

TYPED: ContextVar[tuple[App, Sequence[str]] | None] = ContextVar("typed", default=None)

# Command lines with mistakes ---------------------------------------------------------------------------


# Synonyms that people type for options, and the real names of these options.
_OTHER_NAMES = {"--sweep": "--vary", "--result": "--what"}
_KINDS: dict[Any, str] = {float: "a number", int: "a whole number", bool: "a value of a switch"}


def say_mistake(app: App, error: CycloptsError, given: Sequence[str]) -> str:
    """Return what is wrong in a command line, and how to get help.

    Parameters
    ----------
    app : App
        The program.
    error : CycloptsError
        The error that the command-line parser raised.
    given : sequence of str
        The words after the program's name.
    """
    command = [word for word in given[:1] if word in set(app.resolved_commands())]
    if "-" in given:
        said = "A dash names no file: give a name, such as /dev/stdin or /dev/stdout where the system has it."
    elif isinstance(error, UnknownOptionError):
        said = _with_meant_option(error, given)
    elif isinstance(error, RepeatArgumentError) and error.token:
        said = f"{error.token.keyword} is given twice; give it once, with all values where it takes several."
    elif isinstance(error, UnusedCliTokensError) and error.unused_tokens:
        said = _say_too_many(error.unused_tokens, given)
    elif isinstance(error, CoercionError) and error.target_type in _KINDS and error.token and not error.msg:
        # The error lacks the value typed for a flag in the oldest supported cyclopts: `given` has it.
        option = error.token.keyword
        joined = next((text.partition("=")[2] for text in given if text.startswith(f"{option}=")), "")
        wanted = _KINDS[error.target_type]
        said = f'Invalid value for {option}: "{error.token.value or joined}" is not {wanted}.'
    else:
        said = f"{error}"
    return f"{said} See {' '.join([app.name[0], *command])} --help."


def check_names(given: Sequence[str]) -> None:
    """Raise an error for an empty file name, which would mean the current folder."""
    if any(not word.strip() and not before.startswith("-") for before, word in pairwise(given)):
        raise ValueError('one of the names is empty (""); give the name of a file')


def _say_too_many(words: Sequence[str], given: Sequence[str]) -> str:
    """Return a sentence on words that belong to no option, such as "mm" of the unquoted value 50 mm."""
    first = next((i for i, word in enumerate(given) if word == words[0]), 0)
    option, value = given[first - 2 : first] if first > 1 else ("", "")
    example = f' as in {option} "{value} {words[0]}"' if option.startswith("--") and "=" not in option else ""
    said = " ".join(words)
    return f"One word too many: {said}; leave it out, or put a value with spaces into quotes{example}."


def _with_meant_option(error: UnknownOptionError, given: Sequence[str]) -> str:
    """Describe an unknown option; suggest one with the same meaning, else one that takes the typed value."""
    option = (error.token.keyword or error.token.value).partition("=")[0]
    if any(_OTHER_NAMES.get(option) == argument.name for argument in error.argument_collection):
        return f"Unknown option: {option}. Did you mean {_OTHER_NAMES[option]}?"
    words = [word for text in given for word in text.split("=", 1)]
    value = "".join(words[words.index(option) + 1 :][:1]) if option in words else ""
    for argument in error.argument_collection:
        if get_origin(argument.hint) is Literal and value in get_args(argument.hint):
            return f"Unknown option: {option}. Did you mean {argument.name}?"
    return f"{error}"


_HEADING: ContextVar[Callable[[str], str] | None] = ContextVar("heading", default=None)


def in_files(text: str, units: Any = None) -> str:
    """Rewrite a message in terms of files and options; convert speeds to a display unit if units are given.

    `Physics(shear=True)` becomes "[physics] shear = true", on a form "Physics: shear = true".
    """
    return worded(text, lambda part: word(part, units))


def word(part: Part, units: Any = None) -> str:
    """Rewrite a part of a message in terms of files or, within the context `on_form`, of forms."""
    if isinstance(part, Setting) and (heading := _HEADING.get()) is not None:
        return part.on_form(heading(part.table))
    if isinstance(part, InputName) and _HEADING.get() is not None:
        return part.on_form
    if isinstance(part, Named):
        return part.elsewhere
    return str(part) if units is None else in_files(part.in_units(units))


def say(error: Exception) -> str:
    """Return the message of an error in terms of files and options."""
    composed, (first, *_) = getattr(error, "worded", None), (*error.args, "")
    if composed is not None:
        return composed(word)
    return in_files(first) if isinstance(first, Words) else str(error)


@contextmanager
def on_form(heading: Callable[[str], str]) -> Iterator[None]:
    """In this context, reword messages for a form; ``heading(table)`` is a table's heading in the form."""
    before = _HEADING.set(heading)
    try:
        yield
    finally:
        _HEADING.reset(before)
