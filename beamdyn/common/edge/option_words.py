"""Messages in the words of the command that was typed: refusals of the core, and mistakes in typing it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from contextvars import ContextVar
from itertools import chain, pairwise
from typing import Literal, get_args, get_origin

from cyclopts import App, CoercionError, CycloptsError, UnknownOptionError, UnusedCliTokensError

from beamdyn.common.edge.file_words import as_in_files

# Refusals by the core --------------------------------------------------------------------------------


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


# Command lines that cannot be understood -------------------------------------------------------------


_OTHER_NAMES = {"--sweep": "--vary", "--result": "--what"}  # names under which options are looked for
_KINDS = {"float": "is not a number", "int": "is not a whole number", "bool": "is no value of a switch"}
_CONVERSION = re.compile(r'unable to convert "(.*)" into (\w+)')
_QUOTED_OPTION = re.compile(r'"(--?[\w-]+)"')  # as the oldest version of cyclopts that we admit writes them


def say_mistake(app: App, error: CycloptsError, given: Sequence[str]) -> str:
    """Say in a sentence what cannot be understood, and where help is.

    Parameters
    ----------
    app : App
        The program.
    error : CycloptsError
        Why its command line cannot be understood.
    given : sequence of str
        The words after the program's name.
    """
    command = [word for word in given[:1] if word in set(app.resolved_commands())]
    if "-" in given:
        said = "A dash names no file: give a name, such as /dev/stdin or /dev/stdout where the system has it."
    elif isinstance(error, UnknownOptionError):
        said = _with_meant_option(error, given)
    elif isinstance(error, UnusedCliTokensError) and error.unused_tokens:
        said = _say_too_many(error.unused_tokens, given)
    elif isinstance(error, CoercionError):  # the oldest cyclopts that we admit omits what a switch is given
        start = f"{error.token.keyword}=" if error.token else "="
        joined = next((text.removeprefix(start) for text in given if text.startswith(start)), "")
        said = _CONVERSION.sub(
            lambda found: f'"{found[1] or joined}" {_KINDS.get(found[2], "is none")}', f"{error}"
        )
    else:
        said = f"{error}"
    said = _QUOTED_OPTION.sub(r"\1", said)
    return f"{said} See {' '.join([app.name[0], *command])} --help."


def check_names(given: Sequence[str]) -> None:
    """Refuse an empty word in place of a file's name, which would be the current folder."""
    if any(not word.strip() and not before.startswith("-") for before, word in pairwise(given)):
        raise ValueError('one of the names is empty (""); give the name of a file')


def _say_too_many(words: Sequence[str], given: Sequence[str]) -> str:
    """Say which words belong to no option, most often a unit that the shell has parted from its number."""
    first = next((i for i, word in enumerate(given) if word == words[0]), 0)
    option, value = given[first - 2 : first] if first > 1 else ("", "")
    example = f' as in {option} "{value} {words[0]}"' if option.startswith("--") and "=" not in option else ""
    said = " ".join(words)
    return f"One word too many: {said}; leave it out, or put a value with spaces into quotes{example}."


def _with_meant_option(error: UnknownOptionError, given: Sequence[str]) -> str:
    """Say that an option is unknown, and which is meant: by a known other name, or by the value given."""
    option = (error.token.keyword or error.token.value).partition("=")[0]
    if any(_OTHER_NAMES.get(option) == argument.name for argument in error.argument_collection):
        return f"Unknown option: {option}. Did you mean {_OTHER_NAMES[option]}?"
    words = [word for text in given for word in text.split("=", 1)]
    value = "".join(words[words.index(option) + 1 :][:1]) if option in words else ""
    for argument in error.argument_collection:
        if get_origin(argument.hint) is Literal and value in get_args(argument.hint):
            return f"Unknown option: {option}. Did you mean {argument.name}?"
    return f"{error}"
