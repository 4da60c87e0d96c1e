"""Measure error and time of settings within a budget of time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf, isnan
from time import perf_counter, process_time
from typing import Any

from numpy.linalg import LinAlgError

from beamdyn.tradeoffs.measurements import Measurement

RUNS = 7  # the shortest counts: what else the machine does can only add
_ENOUGH = 0.4  # share of a setting's time that its repetitions may take


@dataclass(frozen=True)
class Setting:
    """One setting of a family.

    Parameters
    ----------
    name : str
        In words.
    size : float
        The number that is varied.
    run : callable
        Computes the answer; it is given the time of the clock [s] at which it may give up by a
        TimeoutError that says where.
    """

    name: str
    size: float
    run: Callable[[float], Any]


@dataclass(frozen=True)
class Family:
    """Settings of one method, the cheapest first.

    Parameters
    ----------
    name : str
        The method.
    settings : tuple of Setting
        Its settings.
    """

    name: str
    settings: tuple[Setting, ...]


def measure_families(
    families: Sequence[Family], error: Callable[[Any], float], resolved: float, budget: float
) -> tuple[list[Measurement], list[str]]:
    """Measure all settings of all families, each family with an equal share of the budget left.

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
        One for each setting that was measured.
    list of str
        Sentences on those left out, and why.
    """
    end = perf_counter() + budget
    measurements: list[Measurement] = []
    skipped: list[str] = []
    for i, family in enumerate(families):
        share = max(0.0, (end - perf_counter()) / (len(families) - i))
        own, why = _measure_family(family, error, resolved, share)
        measurements += own
        skipped += [f"{family.name}: {why}"] if why else []
    return measurements, skipped


def _measure_family(
    family: Family, error: Callable[[Any], float], resolved: float, share: float
) -> tuple[list[Measurement], str]:
    """Measurements of a family, and why the rest was left out."""
    start, last = perf_counter(), 0.0
    measurements: list[Measurement] = []
    for setting in family.settings:
        left = share - (perf_counter() - start)
        if left < last:
            return measurements, f"left out from {setting.name} on, its {share:.2g} s being used up"
        try:
            answer, last, shortest = _time_shortest(setting, left, _ENOUGH * share / len(family.settings))
        except TimeoutError as stop:
            return measurements, f"{setting.name} given up after {left:.2g} s {stop}, and the rest left out"
        except (ArithmeticError, LinAlgError) as failure:
            return measurements, f"{setting.name} failed ({failure}), and the rest left out"
        e = error(answer)
        bounded = inf if isnan(e) else max(e, resolved)
        measurements.append(Measurement(family.name, setting.name, setting.size, bounded, shortest))
    return measurements, ""


def _time_shortest(setting: Setting, left: float, spare: float) -> tuple[Any, float, float]:
    """The answer, the time that the first run took, and the shortest processor time of some runs [s].

    Processor time, because in it other programs hardly show; all runs in one thread.
    """
    start = perf_counter()
    times: list[float] = []
    answer, first = None, 0.0
    while not times or (len(times) < RUNS and perf_counter() - start < spare):
        began = process_time()
        answer = setting.run(start + left)
        times.append(process_time() - began)
        first = first or perf_counter() - start
    return answer, first, min(times)


def remaining_budget(budget: float, start: float) -> float:
    """Budget left [s] by a reference that was begun at `start`, at least half of it."""
    return max(budget / 2, budget - (perf_counter() - start))
