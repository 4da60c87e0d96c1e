"""The program: its exit codes, and what it says when something is wrong."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence

from cyclopts import App, CycloptsError

from beamdyn import __version__

DONE, NO_ANSWER, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130

app = App(
    name="beamdyn",
    version=__version__,
    help="""Vibration of rotating cantilevers: natural frequencies, buckling, motion in time, resonance.

A scene is a TOML file with units; `beamdyn COMMAND --help` lists the options of a command.""",
    help_epilogue="Exit codes: 0 done; 1 the model has no answer (the message says which mode and where); "
    "2 bad input; 130 interrupted.",
    help_format="markdown",
    suppress_keyboard_interrupt=False,
)


class NoAnswer(Exception):
    """The model has no answer; the message says which mode and where."""


class Interrupted(Exception):
    """Ctrl-C; the message says what is done and how to go on."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : sequence of str, optional
        As on the command line, without the program's name; those of the process if not given.

    Returns
    -------
    int
        Exit code: 0 done, 1 the model has no answer, 2 bad input, 130 interrupted.
    """
    given = sys.argv[1:] if arguments is None else list(arguments)
    try:
        app(given, exit_on_error=False, print_error=False, result_action="return_value")
    except (NoAnswer, ArithmeticError) as error:
        return _complain("no answer: ", error, NO_ANSWER)
    except MemoryError as error:
        return _complain(
            "not enough memory: ", f"{error}; ask for a shorter run or for fewer modes", BAD_INPUT
        )
    except Interrupted as error:
        return _complain("interrupted: ", error, INTERRUPTED)
    except KeyboardInterrupt:
        return _complain("interrupted", "", INTERRUPTED)
    except CycloptsError as error:
        return _complain("", f"{error} See beamdyn --help.", BAD_INPUT)
    except (ValueError, OSError) as error:
        return _refused(error)
    return DONE


def _refused(error: Exception) -> int:
    """Tell bad input from an eigenproblem that numpy, by a kind of ValueError, gives up."""
    from numpy.linalg import LinAlgError

    if isinstance(error, LinAlgError):
        return _complain(
            "no answer: ", f"{error}; check the size of the speed and of each property", NO_ANSWER
        )
    return _complain("", error, BAD_INPUT)


def _complain(prefix: str, error: object, code: int) -> int:
    print(f"beamdyn: {prefix}{error}", file=sys.stderr)
    return code


def warn(warnings: Iterable[str]) -> None:
    """Print warnings on standard error."""
    for warning in warnings:
        print(f"beamdyn: warning: {warning}", file=sys.stderr)
