"""Measurement of error and time of settings within a time budget."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf, isnan
from time import perf_counter, process_time
from typing import Any

from numpy.linalg import LinAlgError

from beamdyn.common.inputs.checks import reason_of
from beamdyn.studies.tradeoffs.measurements import Measurement

RUNS = 7  # of a setting; the shortest counts, because other programs can only add time
_REPEATS = 0.4  # of a setting's share of the budget, for repetitions


@dataclass(frozen=True)
class Setting:
    """One setting of a family.

    Parameters
    ----------
    name : str
        Name, in words.
    size : float
        Varied number.
    run : callable
        Computes the result; its argument is the deadline on the clock `perf_counter` [s], past which
        it may raise a TimeoutError that says how far it came.
    """

    name: str
    size: float
    run: Callable[[float], Any]


@dataclass(frozen=True)
class Family:
    """Settings of one basis, kind of element or integrator, the cheapest first.

    Parameters
    ----------
    name : str
        Name.
    settings : tuple of Setting
        Settings.
    """

    name: str
    settings: tuple[Setting, ...]


def measure_families(
    families: Sequence[Family], error: Callable[[Any], float], resolved: float, budget: float
) -> tuple[list[Measurement], list[str]]:
    """Measure all settings of all families, each family with an equal share of the remaining budget.

    Parameters
    ----------
    families : sequence of Family
        Families to measure.
    error : callable
        Computes the relative error of a result.
    resolved : float
        Lower bound of the errors: that of the reference.
    budget : float
        Time for all measurements [s].

    Returns
    -------
    list of Measurement
        Measurements, one per measured setting.
    list of str
        Sentences on the settings that were left out, and why.
    """
    end = perf_counter() + budget
    measurements: list[Measurement] = []
    skipped: list[str] = []
    for i, family in enumerate(families):
        share = max(0.0, (end - perf_counter()) / (len(families) - i))
        measured, reason = _measure_family(family, error, resolved, share)
        measurements += measured
        skipped += [f"{family.name}: {reason}"] if reason else []
    return measurements, skipped


def _measure_family(
    family: Family, error: Callable[[Any], float], resolved: float, share: float
) -> tuple[list[Measurement], str]:
    """Measure a family: the measurements, and why the rest was left out.

    Whether the next setting still fits is told by the processor time of the last one: a moment in which
    the machine did something else would look like a slow setting, and end the family too early.
    """
    start, last = perf_counter(), 0.0
    measurements: list[Measurement] = []
    for setting in family.settings:
        rest = share - (perf_counter() - start)
        if rest < last:
            return measurements, f"left out from {setting.name} on, its {share:.2g} s being used up"
        try:
            result, last = _time_runs(setting, rest, _REPEATS * share / len(family.settings))
        except TimeoutError as stop:
            return measurements, f"{setting.name} given up after {rest:.2g} s {stop}, and the rest left out"
        except (ArithmeticError, LinAlgError) as failure:
            return measurements, f"{setting.name} failed ({reason_of(failure)}), and the rest left out"
        relative_error = error(result)
        bounded = inf if isnan(relative_error) else max(relative_error, resolved)
        measurements.append(Measurement(family.name, setting.name, setting.size, bounded, last))
    return measurements, ""


def _time_runs(setting: Setting, rest: float, spare: float) -> tuple[Any, float]:
    """Run a setting several times: the result, and the shortest processor time [s].

    Other programs hardly influence the processor time; all runs are in one thread.
    """
    start = perf_counter()
    times: list[float] = []
    result = None
    while not times or (len(times) < RUNS and perf_counter() - start < spare):
        cpu_start = process_time()
        result = setting.run(start + rest)
        times.append(process_time() - cpu_start)
    return result, min(times)


def remaining_budget(budget: float, start: float) -> float:
    """Budget [s] that remains after a reference begun at `start` [s], at least half of it."""
    return max(budget / 2, budget - (perf_counter() - start))
