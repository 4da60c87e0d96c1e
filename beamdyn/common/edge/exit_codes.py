"""Running a command: exit codes, and messages of failure in the words of the command that was typed."""

from __future__ import annotations

import signal
import sys
import threading
import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import is_dataclass, replace
from io import TextIOWrapper
from itertools import chain, pairwise
from typing import Any, Literal

from cyclopts import App, CycloptsError
from numpy.linalg import LinAlgError

from beamdyn.common.edge.file_words import TYPED, check_names, in_files, say, say_mistake, word
from beamdyn.common.edge.progress import at_work, quiet
from beamdyn.common.edge.tables import Terminal, spell_output
from beamdyn.common.edge.units import InvalidInput, last_quantity
from beamdyn.common.edge.wording import in_unit_of
from beamdyn.common.inputs.checks import InvalidValue, NoModelAnswer, reason_of
from beamdyn.common.results.statements import OutsideLinearTheory

# What commands call arguments of the core, beyond options of the same name.
_ELSEWHERE = {
    "combine": "--together",
    "psd.values": "--psd, values",
    "psd.frequencies": "--psd, frequencies",
    "scene.motion": "[motion]",
    "damping_ratio": "[model] damping_ratio",
    "road.lowest": "lowest spatial frequency of a road",
    "road.highest": "--highest",
    "operating[0]": "--operating",
    "operating[1]": "--operating",
    "position": "position after @",
    "exponent": "--woehler",
    "t_end": "--window",
}
_PHYSICS = "physics."
_USUAL = {"rad": "1 deg"}  # in whose unit numbers are said that were not typed


def is_no_answer(error: Exception) -> bool:
    """Whether the model has no answer to what was asked, as where a linear system is singular."""
    return isinstance(error, ArithmeticError | NoModelAnswer | LinAlgError)


def as_typed(error: Exception) -> str:
    """The message of a refusal with the options and keys that were typed, its number in their unit.

    "tolerance = 5: give ..." becomes "--tolerance = 5: give ..." where the command has that option.
    """
    if isinstance(error, LinAlgError):
        return f"{error}; check the size of each value"
    if not isinstance(error, InvalidValue):
        return reason_of(error) if isinstance(error, ArithmeticError) else say(error)
    name = _name(error.field)
    text = _text_of(name)
    named = replace(error, field=name, other=_name(error.other))
    if error.field == "combine" or (error.field == "scene.motion" and error.value):
        return f"{name}: {named.advice(word)}"  # what was typed has no value of its own
    if error.field == "scene.motion":
        return f"{name}: missing: {named.advice(word)}"
    if isinstance(error.value, float) and error.unit:
        named = in_unit_of(named, text or _USUAL.get(error.unit, ""))
    elif text and _says_more(text, error.value):
        named = replace(named, value=text)
    quoted = name.startswith("-") and isinstance(named.value, str)
    return say(InvalidInput(**vars(named)) if quoted else named)


def _says_more(text: str, value: object) -> bool:
    """Whether what was typed says more than its value: a quantity with a unit, or what is made of a text."""
    if isinstance(value, float | int):
        return text == last_quantity(text) != f"{value:g}"
    return isinstance(value, tuple) or is_dataclass(value)


def _name(field: str) -> str:
    """What the command that is run calls an argument of the core."""
    option = f"--{field.replace('_', '-')}"
    if field.startswith(_PHYSICS):
        return f"[physics] {field.removeprefix(_PHYSICS)}"
    return option if option in _options() else _ELSEWHERE.get(field, field)


def _text_of(name: str) -> str:
    """The text that was typed for an option, or for an input that is varied; empty if there is none."""
    typed = TYPED.get()
    arguments = [] if typed is None else [str(each) for each in typed[1]]
    after = (text for before, text in pairwise(arguments) if before == name)
    parts = (each.partition("=") for each in arguments)  # keys are shortened as far as they are told apart
    joined = (text for key, _, text in parts if text and f".{name}".endswith(f".{key.strip()}"))
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


DONE, NO_ANSWER, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130

EXIT_CODES = (
    "Exit codes: 0 done; 1 the model has no answer (the message says why and where); "
    "2 bad input; 130 interrupted."
)


_EXAMPLES = "{}, in the folder of the source:"
Shell = Literal["bash", "zsh", "fish"]


def examples(*lines: str) -> str:
    """The end of a command's help: examples, which can be typed as they stand, and the exit codes."""
    head = _EXAMPLES.format("Example" if len(lines) == 1 else "Examples")
    return "\n\n".join([head, *(f"`{line}`" for line in lines), EXIT_CODES])


class NoAnswer(Exception):
    """The model has no answer; the message says why, and where."""


class Interrupted(Exception):
    """Ctrl-C or SIGTERM; the message says what is done and how to go on."""


def add_completion(app: App) -> None:
    """Give a program's command line the command `completion`.

    Parameters
    ----------
    app : App
        The command line.
    """
    name = app.name[0]

    @app.command(help_epilogue=examples(f"{name} completion bash"))
    def completion(shell: Shell, /) -> None:
        """Print the script by which a shell completes commands and options at the Tab key.

        Where it goes: ~/.local/share/bash-completion/completions (bash), a folder of fpath (zsh) or
        ~/.config/fish/completions (fish).

        Parameters
        ----------
        shell
            The shell.
        """
        print(app.generate_completion(shell=shell), end="")


def run(app: App, arguments: Sequence[str] | None = None) -> int:
    """Run a command of a program.

    Parameters
    ----------
    app : App
        The program.
    arguments : sequence of str, optional
        As on the command line, without the program's name; those of the process if not given.

    Returns
    -------
    int
        Exit code: 0 done, 1 the model has no answer, 2 bad input, 130 interrupted.
    """
    name = app.name[0]
    given = sys.argv[1:] if arguments is None else list(arguments)
    TYPED.set((app, given))
    if sys.stdout is None:
        return _complain(name, "the standard output is closed; direct it to a file or a device", BAD_INPUT)
    try:
        with _terminated_as_interrupted(), _as_sentences(name), at_work(" ".join([name, *given[:1]])):
            check_names(given)
            if isinstance(sys.stdout, TextIOWrapper):
                spell_output(sys.stdout)
            how: dict[str, Any] = {"exit_on_error": False, "print_error": False}
            app(given, console=Terminal(), result_action="return_value", **how)
    except MemoryError as error:
        return _complain(
            name, f"not enough memory: {error}; ask for a shorter run or for fewer modes", BAD_INPUT
        )
    except (Interrupted, KeyboardInterrupt) as error:
        return _complain(name, f"interrupted: {error}".removesuffix(": "), INTERRUPTED)
    except CycloptsError as error:
        return _complain(name, say_mistake(app, error, given), BAD_INPUT)
    except (NoAnswer, ArithmeticError, ValueError, OSError) as error:
        if isinstance(error, NoAnswer) or is_no_answer(error):
            return _complain(name, f"no answer: {as_typed(error)}", NO_ANSWER)
        return _complain(name, as_typed(error), BAD_INPUT)
    return DONE


@contextmanager
def _terminated_as_interrupted() -> Iterator[None]:
    """Within it, a request to terminate (SIGTERM), as of a scheduler, ends the command as Ctrl-C does."""
    if threading.current_thread() is not threading.main_thread():  # where no handler can be set
        yield
        return

    def interrupt(number: int, frame: object) -> None:
        raise KeyboardInterrupt

    usual = signal.signal(signal.SIGTERM, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, usual)


@contextmanager
def _as_sentences(name: str) -> Iterator[None]:
    """Within it, warnings of the packages are printed as sentences, without their place in the code."""
    usual = warnings.showwarning

    def show(message: Warning | str, category: type[Warning], *place: Any) -> None:
        if category is UserWarning:
            warn(name, [str(message)])
        else:  # a warning of another package, meant for developers
            usual(message, category, *place)

    with warnings.catch_warnings():
        warnings.simplefilter("default", UserWarning)  # whatever filters are set outside
        warnings.simplefilter("ignore", OutsideLinearTheory)  # a command prints the warnings of its result
        warnings.showwarning = show
        yield


def _complain(name: str, sentence: str, code: int) -> int:
    """Print a sentence on standard error, if it can be written, and return the exit code."""
    if sys.stderr is not None:
        with suppress(OSError), quiet():
            print(f"{name}: {sentence}", file=sys.stderr, flush=True)
    return code


def warn(name: str, sentences: Iterable[str]) -> None:
    """Print a program's warnings on standard error."""
    for warning in sentences:
        _complain(name, f"warning: {in_files(warning)}", DONE)
