"""Running a command: exit codes and messages of failure."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from contextlib import suppress
from io import TextIOWrapper

from cyclopts import App, CycloptsError

DONE, NO_ANSWER, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130

EXIT_CODES = (
    "Exit codes: 0 done; 1 the model has no answer (the message says why and where); "
    "2 bad input; 130 interrupted."
)


class NoAnswer(Exception):
    """The model has no answer; the message says which part and where."""


class Interrupted(Exception):
    """Ctrl-C; the message says what is done and how to go on."""


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
    if sys.stdout is None:
        return _complain(name, "the standard output is closed; direct it to a file or a device", BAD_INPUT)
    try:
        _call(app, given)
    except (NoAnswer, ArithmeticError) as error:
        return _complain(name, f"no answer: {error}", NO_ANSWER)
    except MemoryError as error:
        return _complain(
            name, f"not enough memory: {error}; ask for a shorter run or for fewer modes", BAD_INPUT
        )
    except Interrupted as error:
        return _complain(name, f"interrupted: {error}", INTERRUPTED)
    except KeyboardInterrupt as error:
        return _complain(name, f"interrupted: {error}".removesuffix(": "), INTERRUPTED)
    except CycloptsError as error:
        return _complain(name, f"{error} See {name} --help.", BAD_INPUT)
    except (ValueError, OSError) as error:
        return _refused(name, error)
    return DONE


def _call(app: App, arguments: Sequence[str]) -> None:
    from beamdyn.common.edge.tables import Screen, spell_output

    if isinstance(sys.stdout, TextIOWrapper):
        spell_output(sys.stdout)
    app(arguments, console=Screen(), exit_on_error=False, print_error=False, result_action="return_value")


def _refused(name: str, error: Exception) -> int:
    """Exit code of a ValueError: bad input, or no answer if a linear system is singular."""
    from numpy.linalg import LinAlgError

    if isinstance(error, LinAlgError):
        return _complain(name, f"no answer: {error}; check the size of each value", NO_ANSWER)
    return _complain(name, f"{error}", BAD_INPUT)


def _complain(name: str, sentence: str, code: int) -> int:
    _say(f"{name}: {sentence}")
    return code


def warn(name: str, warnings: Iterable[str]) -> None:
    """Print a program's warnings on standard error."""
    for warning in warnings:
        _say(f"{name}: warning: {warning}")


def _say(sentence: str) -> None:
    """Print on standard error, if it can be written."""
    if sys.stderr is not None:
        with suppress(OSError):
            print(sentence, file=sys.stderr, flush=True)
