"""Run commands: convert errors to messages and exit codes."""

from __future__ import annotations

import signal
import sys
import threading
import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from io import TextIOWrapper
from typing import Any, Literal

from cyclopts import App, CycloptsError

from beamdyn.common.edge.console import Terminal, at_work, quiet, spell_output
from beamdyn.common.edge.file_words import TYPED, check_names, in_files, say_mistake
from beamdyn.common.results.statements import OutsideLinearTheory

DONE, NO_ANSWER, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130

EXIT_CODES = (
    "Exit codes: 0 done; 1 the model has no answer (the message says why and where); "
    "2 bad input; 130 interrupted."
)


_EXAMPLES = "{}, in the folder of the source:"
Shell = Literal["bash", "zsh", "fish"]


def examples(*lines: str) -> str:
    """Return the end of a command's help: examples that can be typed as they are, and exit codes."""
    head = _EXAMPLES.format("Example" if len(lines) == 1 else "Examples")
    return "\n\n".join([head, *(f"`{line}`" for line in lines), EXIT_CODES])


class NoAnswer(Exception):
    """Raised when the model has no solution; the message says why, and for which input."""


class Interrupted(Exception):
    """Raised on Ctrl-C or SIGTERM; the message says what has been done, and how to resume."""


def add_completion(app: App) -> None:
    """Add the command `completion`, which sets up completion by the Tab key, to a command line.

    Parameters
    ----------
    app : App
        The command line.
    """
    name = app.name[0]

    @app.command(help_epilogue=examples(f"{name} completion bash"))
    def completion(shell: Shell, /) -> None:
        """Print the script by which a shell completes commands and options at the Tab key.

        Save it as a file in ~/.local/share/bash-completion/completions (bash), in a folder of fpath (zsh) or
        in ~/.config/fish/completions (fish).

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
        Words as on the command line, without the program's name; by default those in `sys.argv`.

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
        # Imported here, since the import loads numpy, which is not needed to show help.
        from beamdyn.common.edge.refusal_words import as_typed, is_no_answer

        if isinstance(error, NoAnswer) or is_no_answer(error):
            return _complain(name, f"no answer: {as_typed(error)}", NO_ANSWER)
        return _complain(name, as_typed(error), BAD_INPUT)
    return DONE


@contextmanager
def _terminated_as_interrupted() -> Iterator[None]:
    """In this context, let SIGTERM (a request to terminate, as from a scheduler) act like Ctrl-C."""
    # Python lets only the main thread set signal handlers.
    if threading.current_thread() is not threading.main_thread():
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
    """In this context, print each `UserWarning` as a plain sentence, without file and line number."""
    usual = warnings.showwarning

    def show(message: Warning | str, category: type[Warning], *place: Any) -> None:
        if category is UserWarning:
            # The text itself keeps its wording for files.
            warn(name, [message.args[0] if isinstance(message, UserWarning) else str(message)])
        else:  # a warning from another package, which only developers need
            usual(message, category, *place)

    with warnings.catch_warnings():
        warnings.simplefilter("default", UserWarning)  # shown whatever warning filters the user has set
        # Not shown here: the command prints these warnings, which its result stores.
        warnings.simplefilter("ignore", OutsideLinearTheory)
        warnings.showwarning = show
        yield


def _complain(name: str, sentence: str, code: int) -> int:
    """Print an error message of the program `name` on standard error, if possible; return the exit code."""
    if sys.stderr is not None:
        with suppress(OSError), quiet():
            print(f"{name}: {sentence}", file=sys.stderr, flush=True)
    return code


def warn(name: str, sentences: Iterable[str]) -> None:
    """Print a program's warnings on standard error."""
    for warning in sentences:
        _complain(name, f"warning: {in_files(warning)}", DONE)
