"""Are mutated files and wrong calls answered or refused in a sentence?  Run: python -m benchmarks.fuzzing

All cases run in one process, to detect state that one case leaves for the next. A mutated file is given to a
command, wrong arguments to a public function. Anything except an answer or an error message of the program
is a failure: a traceback, another package's message, a warning of numpy, more than 20 s of computing.
"""

from __future__ import annotations

import argparse
import faulthandler
import io
import linecache
import os
import resource
import signal
import sys
import tempfile
import time
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from random import Random
from types import FrameType
from typing import Any

# More threads do not speed up small matrices.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("MPLBACKEND", "agg")

import beamdyn.cli
import brakes.cli
from beamdyn.common.edge.exit_codes import BAD_INPUT, DONE, NO_ANSWER
from benchmarks.cases.mutations import mutate
from benchmarks.cases.wrong_calls import Call, draw_wrong_call, right_calls, wrong_values
from benchmarks.rows import Row, show

ROOT = Path(__file__).parents[1]
SEED, CASES = 13, 2000
LIMIT = 20.0  # limit of the processor time of one case [s], in which other programs do not count
_HUNG = 300.0  # time [s] after which a case that waits, or cannot be interrupted, ends the run
_MEMORY = 8 << 30  # largest memory [bytes]; a case that needs more fails
_OURS = tuple(f"{ROOT / package}{os.sep}" for package in ("beamdyn", "brakes"))
_REFUSALS = (ValueError, TypeError, ArithmeticError)

# Commands on a file of each kind; the file's name comes after the first word.
_SCENE = (
    "modes --speed 20rad/s --modes 2 --tolerance 1e-3",
    "modes --modes 2 --discretization fem --tolerance 1e-3",
    "locus --speeds 0:50:5rad/s --modes 2 --tolerance 1e-3 --csv out.csv",
    "critical --json out.json",
    "limits --top-speed 200rad/s",
    "terms --json out.json",
    "resonances --top-speed 60rad/s --modes 1",
    "steady --speeds 1:60:5rad/s --modes 2 --json out.json",
    "simulate --t-end 50ms --modes 2 --tolerance 1e-3 --csv out.csv",
    "sweep --speeds 1,20rad/s --window 0:50ms --modes 2 --tolerance 1e-3",
)
_BLADE = (*_SCENE[1:3], "terms --json out.json")  # no motions: those of 48 segments exceed the limit
_CALIPER = ("caliper --json out.json", "caliper --csv out.csv", "caliper --free-bodies out.svg", "caliper")
_DRUM = ("drum --json out.json", "drum --csv out.csv", "drum --vary friction=0.1:0.5:3")
_FORKLIFT = ("forklift --json out.json", "forklift --csv out.csv", "forklift --vary speed=10:30:3km/h")


@dataclass(frozen=True)
class Kind:
    """Files of one kind, and the commands that read them."""

    main: Callable[[Sequence[str]], int]
    files: tuple[Path, ...]
    commands: tuple[str, ...]


def kinds() -> tuple[Kind, ...]:
    """List the examples by kind."""
    folder = ROOT / "examples"
    special = {folder / "drum.toml": _DRUM, folder / "forklift.toml": _FORKLIFT}
    blade = folder / "twisted_blade.toml"
    scenes = tuple(path for path in sorted(folder.glob("*.toml")) if path not in (*special, blade))
    return (
        Kind(beamdyn.cli.main, scenes, _SCENE),
        Kind(brakes.cli.main, tuple(sorted((folder / "calipers").glob("*.toml"))), _CALIPER),
        *(Kind(brakes.cli.main, (path,), commands) for path, commands in special.items()),
        Kind(beamdyn.cli.main, (blade,), _BLADE),
    )


@dataclass(frozen=True)
class Outcome:
    """Outcome of a case.

    Parameters
    ----------
    case : str
        Command or call.
    verdict : str
        "answered", "refused", or the kind of failure.
    detail : str
        Text of the answer or of the error.
    seconds : float
        Processor time [s].
    """

    case: str
    verdict: str
    detail: str
    seconds: float

    @property
    def failed(self) -> bool:
        """Whether the case has neither an answer nor an error message of the program."""
        return self.verdict not in ("answered", "refused")


# One case -----------------------------------------------------------------------------------------------


class TookTooLongError(BaseException):
    """Raised if a case takes too long; the programs do not catch it."""


@contextmanager
def _time_limit(seconds: float) -> Iterator[None]:
    """Raise `TookTooLongError` after a processor time [s], when Python regains control."""

    def end(_: int, frame: FrameType | None) -> None:
        where = f"{frame.f_code.co_filename}:{frame.f_lineno}" if frame else ""
        raise TookTooLongError(f"after {seconds:g} s at {where}")

    before = signal.signal(signal.SIGPROF, end)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def watch(case: str, run: Callable[[], tuple[str, str]], limit: float = LIMIT) -> Outcome:
    """Return the outcome of a case: its answer, or how it fails."""
    start = time.process_time()
    with _foreign_warnings() as warned:
        try:
            with _time_limit(limit):
                verdict, detail = run()
        except TookTooLongError as error:
            verdict, detail = "too long", str(error)
        except _REFUSALS as error:
            ours = str(error) and _is_ours(error)
            verdict, detail = "refused" if ours else "foreign message", _where(error)
        except Warning as error:
            verdict, detail = "warning", _where(error)
        except (Exception, SystemExit) as error:
            verdict, detail = "traceback", _where(error)
    if warned and verdict in ("answered", "refused"):
        verdict, detail = "warning", warned[0]
    return Outcome(case, verdict, detail, time.process_time() - start)


@contextmanager
def _foreign_warnings() -> Iterator[list[str]]:
    """Turn warnings such as numpy's into errors, and collect user warnings of other packages."""
    warned: list[str] = []

    def note(message: Warning | str, category: type[Warning], filename: str, lineno: int, *_: object) -> None:
        giver = sys._getframe(2).f_code.co_filename  # the intermediate frame belongs to the module `warnings`
        if category is not UserWarning or not giver.startswith(_OURS):
            warned.append(f"{category.__name__}: {message} ({Path(filename).name}:{lineno})")

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("always", UserWarning)
        warnings.simplefilter("ignore", DeprecationWarning)
        warnings.showwarning = note
        yield warned


def _is_ours(error: BaseException) -> bool:
    """Return whether a `raise` statement of the packages raised the error, not a failing operation."""
    last = error.__traceback__
    while last is not None and last.tb_next is not None:
        last = last.tb_next
    if last is None:
        return False
    name = last.tb_frame.f_code.co_filename
    return name.startswith(_OURS) and linecache.getline(name, last.tb_lineno).strip().startswith("raise")


def _where(error: BaseException) -> str:
    places, last = [], error.__traceback__
    while last is not None:
        places.append(f"{Path(last.tb_frame.f_code.co_filename).name}:{last.tb_lineno}")
        last = last.tb_next
    return f"{type(error).__name__}: {error} ({' > '.join(places[-3:])})"


# Files --------------------------------------------------------------------------------------------------


def check_file(number: int, seed: int = SEED) -> Outcome:
    """Return the outcome of a command on the mutated file with a number, in the current folder."""
    random = Random(f"file {seed} {number}")
    kind = random.choices(kinds(), (5, 4, 2, 2, 1))[0]
    path, command = random.choice(kind.files), random.choice(kind.commands)
    text, mutations = mutate(path.read_text(encoding="utf-8"), random)
    Path("in.toml").write_text(text, encoding="utf-8", newline="")
    name, *options = command.split()
    for old in Path().glob("out.*"):
        old.unlink()
    case = f"file {number}: {path.name}, {mutations}: {command}"
    return watch(case, lambda: _run(kind.main, [name, "in.toml", *options]))


def _run(main: Callable[[Sequence[str]], int], arguments: Sequence[str]) -> tuple[str, str]:
    """Run a command; return the verdict and the text on standard error."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        code = main(arguments)
    said = err.getvalue()
    if code not in (DONE, NO_ANSWER, BAD_INPUT) or "Traceback" in said or (code != DONE and not said):
        return f"exit code {code}", said
    if "Warning:" in said:
        return "warning", said
    return ("answered" if code == DONE else "refused"), said.strip()


# Calls --------------------------------------------------------------------------------------------------


def check_call(number: int, seed: int = SEED) -> Outcome:
    """Return the outcome of the wrong call with a number."""
    call = draw_wrong_call(right_calls(), wrong_values(), Random(f"call {seed} {number}"))
    return watch(f"call {number}: {call}", lambda: _answer(call))


def _answer(call: Call) -> tuple[str, str]:
    with redirect_stdout(io.StringIO()):
        result: Any = call.function(**call.arguments)
    return "answered", type(result).__name__


# Report -------------------------------------------------------------------------------------------------


CHECKS = {"mutated files": check_file, "wrong calls": check_call}


def check_all(check: Callable[[int, int], Outcome], cases: range, seed: int = SEED) -> list[Outcome]:
    """Return the outcomes of some cases, run in a temporary folder."""
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        try:
            os.chdir(folder)
            return [_unhung(check, number, seed) for number in cases]
        finally:
            os.chdir(before)


def _unhung(check: Callable[[int, int], Outcome], number: int, seed: int) -> Outcome:
    """Return the outcome of a case; if it hangs in a library, end the process and print the traceback."""
    faulthandler.dump_traceback_later(_HUNG, exit=True, file=sys.__stderr__)
    try:
        return check(number, seed)
    finally:
        faulthandler.cancel_dump_traceback_later()


def summarize(name: str, outcomes: Sequence[Outcome]) -> Iterator[Row]:
    """Yield counts of verdicts, the longest case, and every failure."""
    verdicts = Counter(outcome.verdict for outcome in outcomes)
    failures = [outcome for outcome in outcomes if outcome.failed]
    yield name, str(len(outcomes)), str(CASES)
    yield f"{name}: answered", str(verdicts["answered"]), ""
    yield f"{name}: refused in a sentence", str(verdicts["refused"]), ""
    yield f"{name}: tracebacks, foreign messages, warnings, too long", str(len(failures)), "0"
    yield f"{name}: longest [s]", f"{max(outcome.seconds for outcome in outcomes):.1f}", f"{LIMIT:g}"
    for outcome in failures:
        yield outcome.case, outcome.verdict, outcome.detail[-300:]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=CASES, help="mutated files, and as many wrong calls")
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("--seed", type=int, default=SEED)
    options = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    cases = range(options.first, options.first + options.cases)
    for name, check in CHECKS.items():
        outcomes = check_all(check, cases, options.seed)
        show(name, lambda name=name, outcomes=outcomes: summarize(name, outcomes))


if __name__ == "__main__":
    main()
