"""Sentences of the core in the words of the command that was typed: options for names of arguments."""

from __future__ import annotations

import re
from collections.abc import Sequence
from contextvars import ContextVar
from itertools import chain, pairwise

from cyclopts import App, CycloptsError

from beamdyn.common.edge.file_words import as_in_files

TYPED: ContextVar[tuple[App, Sequence[str]] | None] = ContextVar("typed", default=None)

_ROLLING = 'a table [motion] with kind = "rolling"'
# What the core calls a thing, and what a command and its file do; the first is a regular expression.
_PHRASES = {
    r"^combine = 'zip'": "--together",
    r"^psd\.(\w+) = ": r"--psd, \1 = ",
    r"^scene\.motion = None": "[motion]: missing",
    r"^scene\.motion = '\w+'": "[motion]",
    r"^damping_ratio = ": "[model] damping_ratio = ",
    r"^road\.lowest = ": "lowest spatial frequency of a road = ",
    r"\broad\.highest = ": "--highest = ",
    r"; swap the two\?$": "; give a higher one",
    r"^operating\[[01]\] = ": "--operating = ",
    r"\bPointForce\(position=None, direction='bending'\)": '"force@tip"',
    r"\bPointForce\(position=None, direction='across'\)": '"force@tip across"',
    r"\bPointForce\(position=([\d.e-]+), direction='bending'\)": r'"force@\1 m"',
    r"\bPointForce\(position=([\d.e-]+), direction='across'\)": r'"force@\1 m across"',
    r"^position = (.*); the tip is where no position is given": r"position after @ = \1; @tip is the tip",
    r"\bleave points out\b": "leave --points out",
    r"; pass numpy\.unique\([\w.]+\)": "; give each once, in ascending order",
    r"\bBaseMotion\(direction='(\w+)'\)": r'"\1"',
    r", a BaseMotion\(direction\) or a PointForce\(position\)": ' or "force@20 mm"',
    r", a DeflectionAt\(position\) or an AccelerationAt\(position\)": ' or "deflection@20 mm"',
    r"\b(?:a )?RollingWheel(?:\(radius, speed\))?": _ROLLING,
    r"\bor None, which keeps all functions": "or auto",
    r"\bbd\.(\w+)": r"beamdyn \1",
    r"\bphysics\.(\w+ = )": r"[physics] \1",
}
_ARGUMENT = re.compile(r"^([a-z_]+)(?= = |: )")
_QUOTED = re.compile(r"^(--[\w-]+ = )'([^'\"]*)'")


def as_typed(sentence: str) -> str:
    """A message of the core, with the options of the command that is run in place of its arguments.

    "tolerance = 5: give ..." becomes "--tolerance = 5: give ..." where the command has that option.
    """
    said = as_in_files(sentence)
    for phrase, words in _PHRASES.items():
        said = re.sub(phrase, words, said)
    named = _ARGUMENT.match(said)
    if named is not None and (option := f"--{named[1].replace('_', '-')}") in _options():
        said = option + said[named.end() :]
    return _QUOTED.sub(r'\1"\2"', said)


def as_given(error: Exception) -> str:
    """The message of a refusal, its number in the unit in which the option that gave it was typed."""
    from beamdyn.common.edge.wording import in_unit_of
    from beamdyn.common.inputs.checks import InvalidValue  # here, for the time that it takes to import

    if not isinstance(error, InvalidValue) or not error.unit:
        return str(error)
    text = _text_of(f"--{error.field.replace('_', '-')}")
    return str(in_unit_of(error, text) if text else error)


def _text_of(option: str) -> str:
    """The text that was typed for an option; empty if there is none."""
    typed = TYPED.get()
    arguments = [] if typed is None else [str(each) for each in typed[1]]
    after = (text for name, text in pairwise(arguments) if name == option)
    joined = (each.partition("=")[2] for each in arguments if each.startswith(f"{option}="))
    return next(chain(after, joined), "")


def _options() -> set[str]:
    """The options of the command that is run; none outside one."""
    if (typed := TYPED.get()) is None:
        return set()
    app, arguments = typed
    try:
        _, apps, _ = app.parse_commands(arguments)
        return {name for each in apps[-1].assemble_argument_collection() for name in each.names}
    except (CycloptsError, ValueError):
        return set()
