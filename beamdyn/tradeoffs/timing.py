"""Runs cases within a budget of time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf, isnan
from time import perf_counter, process_time
from typing import Any

from numpy.linalg import LinAlgError

from beamdyn.tradeoffs.measurements import Measurement

RUNS = 7  # the shortest counts: what else the machine does can only add
_ENOUGH = 0.4  # share of a case's time that its repetitions may take


@dataclass(frozen=True)
class Case:
    """One setting of a family.

    Parameters
    ----------
    setting : str
        In words.
    size : float
        The number that is varied.
    run : callable
        Computes the answer; it is given the time of the clock [s] at which it may give up by a
        TimeoutError that says where.
    """

    setting: str
    size: float
    run: Callable[[float], Any]


@dataclass(frozen=True)
class Family:
    """Cases of one method, the cheapest first.

    Parameters
    ----------
    name : str
        The method.
    cases : tuple of Case
        Its settings.
    """

    name: str
    cases: tuple[Case, ...]


def measured(
    families: Sequence[Family], error: Callable[[Any], float], resolved: float, budget: float
) -> tuple[list[Measurement], list[str]]:
    """Measure all cases of all families, each family with an equal share of what is left of the budget.

    Parameters
    ----------
    families : sequence of Family
        What is measured.
    error : callable
        Relative error of an answer.
    resolved : float
        The least error that can be told from zero.
    budget : float
        Time for all [s].

    Returns
    -------
    list of Measurement
        What was measured.
    list of str
        What was not, and why.
    """
    end = perf_counter() + budget
    found: list[Measurement] = []
    skipped: list[str] = []
    for i, family in enumerate(families):
        share = max(0.0, (end - perf_counter()) / (len(families) - i))
        own, why = _of_family(family, error, resolved, share)
        found += own
        skipped += [f"{family.name}: {why}"] if why else []
    return found, skipped


def _of_family(
    family: Family, error: Callable[[Any], float], resolved: float, share: float
) -> tuple[list[Measurement], str]:
    """What was measured of a family, and why not the rest."""
    start, last = perf_counter(), 0.0
    found: list[Measurement] = []
    for case in family.cases:
        left = share - (perf_counter() - start)
        if left < last:
            return found, f"left out from {case.setting} on, its {share:.2g} s being used up"
        try:
            answer, last, shortest = _shortest(case, left, _ENOUGH * share / len(family.cases))
        except TimeoutError as stop:
            return found, f"{case.setting} given up after {left:.2g} s {stop}, and the rest left out"
        except (ArithmeticError, LinAlgError) as failure:
            return found, f"{case.setting} failed ({failure}), and the rest left out"
        e = error(answer)
        counted = inf if isnan(e) else max(e, resolved)
        found.append(Measurement(family.name, case.setting, case.size, counted, shortest))
    return found, ""


def _shortest(case: Case, left: float, spare: float) -> tuple[Any, float, float]:
    """The answer, the time that the first run took, and the shortest processor time of some runs [s].

    Processor time, because in it other programs hardly show; all runs in one thread.
    """
    start = perf_counter()
    times: list[float] = []
    answer, first = None, 0.0
    while not times or (len(times) < RUNS and perf_counter() - start < spare):
        began = process_time()
        answer = case.run(start + left)
        times.append(process_time() - began)
        first = first or perf_counter() - start
    return answer, first, min(times)


def what_is_left(budget: float, start: float) -> float:
    """What a reference that was begun at `start` leaves of a budget [s], at least half of it."""
    return max(budget / 2, budget - (perf_counter() - start))
