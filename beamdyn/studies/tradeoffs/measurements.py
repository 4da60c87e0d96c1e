"""Measurements of error and computing time: Pareto front, cost of a digit, and the measuring procedure."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import groupby
from math import inf, isfinite, isnan, nan
from statistics import median
from time import perf_counter, process_time
from typing import Any

import numpy as np
from numpy.linalg import LinAlgError

from beamdyn.common.inputs.checks import reason_of
from beamdyn.common.plots.curves import plot_work_precision
from beamdyn.common.results.one_line import counted, number
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Result
from beamdyn.common.results.snapshots import ADDED_LATER

_MOST_DIGITS = 14  # largest number of digits in `cost_per_digit`; double precision has 16


@dataclass(frozen=True)
class Measurement:
    """Error and computing time of one setting.

    Parameters
    ----------
    family : str
        Name of a basis, an element type or an integrator.
    setting : str
        Setting within the family, in words.
    size : float
        Varied number: functions, elements, modes, harmonics or a tolerance.
    error : float
        Relative error of the result; inf if the result is not a number.
    time : float
        Shortest processor time of several runs, in one thread [s].
    scatter : float
        Distance of the median of the runs' times from the shortest [s]; a tenth of the time of a single run.
    """

    family: str
    setting: str
    size: float
    error: float
    time: float
    scatter: float = field(default=0.0, metadata=ADDED_LATER)

    def ties_with(self, other: Measurement) -> bool:
        """Return whether the times of two measurements differ by at most twice the larger scatter."""
        return abs(self.time - other.time) <= _TIE * max(self.scatter, other.scatter)


@dataclass(frozen=True)
class Digit:
    """Cheapest measurement with a number of correct digits.

    Parameters
    ----------
    error : float
        Largest allowed relative error.
    family, setting : str
        Family and setting of the cheapest measurement within this error.
    time : float
        Time of this measurement [s].
    ratio : float
        Ratio of this time to the time for one digit less; nan for the first digit.
    ties : tuple of str
        Other settings within this error whose times differ by at most twice the scatter.
    """

    error: float
    family: str
    setting: str
    time: float
    ratio: float
    ties: tuple[str, ...] = field(default=(), metadata=ADDED_LATER)

    @property
    def advice(self) -> str:
        """Family and setting of the cheapest measurement."""
        return f"{self.family}, {self.setting}"


def number_of(number: int, one: str, many: str) -> str:
    """Format a number with its noun, in the singular or plural."""
    return f"{number} {one if number == 1 else many}"


def at_speeds(speeds: np.ndarray) -> str:
    """Say how many speeds [rad/s] there are, and the last of them: "at 3 speeds to 100 rad/s"."""
    many = f"{len(speeds)} speeds to " if len(speeds) > 1 else ""
    return f"at {many}{speeds[-1]:.6g} rad/s"


def pareto_front(measurements: Sequence[Measurement]) -> tuple[Measurement, ...]:
    """Find the Pareto front: the measurements with smaller errors than all faster ones.

    Parameters
    ----------
    measurements : sequence of Measurement
        Measurements in any order; those without a finite error are never in the front.

    Returns
    -------
    tuple of Measurement
        The front, the fastest first.
    """
    front, best, best_time = [], inf, nan
    for m in sorted(measurements, key=lambda m: (m.time, m.error)):
        if isfinite(m.error) and (m.error < best or (m.error, m.time) == (best, best_time)):
            front.append(m)
            best, best_time = m.error, m.time
    return tuple(front)


def cost_per_digit(measurements: Sequence[Measurement]) -> tuple[Digit, ...]:
    """Find the cheapest measurements with errors of at most 1e-1, 1e-2, ..., down to the smallest reached."""
    digits: list[Digit] = []
    for k in range(1, _MOST_DIGITS + 1):
        candidates = [m for m in measurements if m.error <= 10.0**-k]
        if not candidates:
            break
        m = min(candidates, key=lambda m: m.time)
        ratio = m.time / digits[-1].time if digits else nan
        equal = (c for c in candidates if c is not m and c.ties_with(m))
        ties = tuple(f"{c.family}, {c.setting}" for c in sorted(equal, key=lambda c: c.time))
        digits.append(Digit(10.0**-k, m.family, m.setting, m.time, ratio, ties))
    return tuple(digits)


@dataclass(frozen=True)
class Diagram(Result):
    """Work-precision diagram: error against computing time of all settings that compute the same result.

    Parameters
    ----------
    title : str
        Computed quantity.
    error_of : str
        Quantity whose error is measured, and what the error is relative to.
    reference : str
        Reference result, and how it was checked.
    resolved : float
        Relative error of the reference: no measured error is reported below it.
    measurements : tuple of Measurement
        All measurements, by family, the cheapest first.
    front : tuple of Measurement
        Pareto front, the fastest first.
    per_digit : tuple of Digit
        Cheapest measurement for each number of digits.
    skipped : tuple of str
        Settings that were not measured, and why.
    """

    title: str
    error_of: str
    reference: str
    resolved: float
    measurements: tuple[Measurement, ...]
    front: tuple[Measurement, ...]
    per_digit: tuple[Digit, ...]
    skipped: tuple[str, ...]

    def headline(self) -> Iterator[str]:
        """Yield title, number of measurements and resolved digits, for the one-line summary.

        See `Result.headline`.
        """
        yield self.title
        yield f"{counted(len(self.measurements), 'measurement')}, {len(self.front)} in the Pareto front"
        yield f"reference to {number(self.resolved)}"

    @classmethod
    def make(
        cls,
        title: str,
        error_of: str,
        reference: str,
        resolved: float,
        measurements: Sequence[Measurement],
        skipped: Sequence[str] = (),
    ) -> Diagram:
        """Build a diagram from measurements, with the Pareto front and the cost per digit."""
        front, per_digit = pareto_front(measurements), cost_per_digit(measurements)
        return cls(
            title, error_of, reference, resolved, tuple(measurements), front, per_digit, tuple(skipped)
        )

    @property
    def summary(self) -> str:
        """Describe the Pareto front in one line: families and settings by ascending time."""
        parts = []
        for family, members in groupby(self.front, key=lambda m: m.family):
            settings = [m.setting for m in members]
            parts.append(f"{family} ({' to '.join(dict.fromkeys([settings[0], settings[-1]]))})")
        return ", then ".join(parts)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw error against time, one line per family, and the Pareto front."""
        lines: dict[str, list[tuple[float, float]]] = {}
        for m in self.measurements:
            lines.setdefault(m.family, []).append((m.time, m.error))
        front = np.array([(m.time, m.error) for m in self.front]).reshape(-1, 2)
        return plot_work_precision({name: np.array(p) for name, p in lines.items()}, front, self.title, ax)


# Measurement of error and time of settings within a time budget -----------------------------------


RUNS = 7  # number of runs of a setting; the shortest counts, as other processes can only add time
_REPEATS = 0.4  # fraction of a setting's part of the budget that is used for repetitions
# Fraction of the budget for repeating settings in alternation, and the largest ratio of a setting's time to
# the shortest time for which the setting takes part in these repetitions.
_AGAIN, _NEAR = 0.2, 1.3
# Multiple of the scatter within which two times count as equal; relative scatter assumed for a single run.
_TIE, _SCATTER_OF_ONE = 2.0, 0.1


@dataclass(frozen=True)
class TimedCase:
    """One setting of a family, with the function that computes its result.

    Parameters
    ----------
    name : str
        Name, in words.
    size : float
        Varied number.
    run : callable
        Function that computes the result; its argument is the deadline on the clock `perf_counter` [s], after
        which it may raise a TimeoutError that states how far it got.
    """

    name: str
    size: float
    run: Callable[[float], Any]


@dataclass(frozen=True)
class Family:
    """Settings of one basis, element type or integrator, the cheapest first.

    Parameters
    ----------
    name : str
        Name.
    settings : tuple of TimedCase
        Settings.
    """

    name: str
    settings: tuple[TimedCase, ...]


def measure_families(
    families: Sequence[Family], error: Callable[[Any], float], resolved: float, budget: float
) -> tuple[list[Measurement], list[str]]:
    """Measure all settings of all families; each family gets an equal part of the remaining budget.

    Parameters
    ----------
    families : sequence of Family
        Families to measure.
    error : callable
        Function that computes the relative error of a result.
    resolved : float
        Lower bound of the errors: the error of the reference.
    budget : float
        Time for all measurements [s].

    Returns
    -------
    list of Measurement
        Measurements, one per measured setting.
    list of str
        Sentences about the settings that were omitted, with the reason.
    """
    end = perf_counter() + budget
    timed: list[_Timed] = []
    skipped: list[str] = []
    for i, family in enumerate(families):
        share = max(0.0, (end - perf_counter()) / (len(families) - i))
        measured, reason = _measure_family(family, error, resolved, share)
        timed += measured
        skipped += [f"{family.name}: {reason}"] if reason else []
    _repeat_in_turns(timed, perf_counter() + _AGAIN * budget)
    return [each.measurement() for each in timed], skipped


@dataclass(frozen=True)
class _Timed:
    """Setting of a family, with the error of its result and the processor times of its runs [s]."""

    family: str
    setting: TimedCase
    error: float
    times: list[float]

    def measurement(self) -> Measurement:
        """Return the measurement of the setting: the shortest time, with the scatter."""
        time = min(self.times)
        scatter = median(self.times) - time if len(self.times) > 1 else _SCATTER_OF_ONE * time
        return Measurement(self.family, self.setting.name, self.setting.size, self.error, time, scatter)


def _repeat_in_turns(timed: Sequence[_Timed], end: float) -> None:
    """Repeat, in alternation until a time [s], the settings that may be the cheapest for a number of digits.

    As the speed of a computer drifts, settings that are timed long after each other cannot be compared.
    """
    limits = [10.0**-k for k in range(1, _MOST_DIGITS + 1)]
    cheapest = {e: min((min(t.times) for t in timed if t.error <= e), default=nan) for e in limits}
    near = [t for t in timed if any(t.error <= e and min(t.times) <= _NEAR * cheapest[e] for e in limits)]
    for _ in range(RUNS if len(near) > 1 else 0):
        for each in near:
            if perf_counter() + min(each.times) > end:
                return
            cpu_start = process_time()
            each.setting.run(inf)
            each.times.append(process_time() - cpu_start)


def _measure_family(
    family: Family, error: Callable[[Any], float], resolved: float, share: float
) -> tuple[list[_Timed], str]:
    """Measure the settings of a family; return them with their times, and why the others were omitted.

    Whether the next setting fits in the budget is estimated from the processor time of the last one: with
    elapsed time, an interruption by other processes would end the family too early.
    """
    start, last = perf_counter(), 0.0
    timed: list[_Timed] = []
    for setting in family.settings:
        rest = share - (perf_counter() - start)
        if rest < last:
            return timed, f"left out from {setting.name} on, as its share of {share:.2g} s is used up"
        try:
            result, times = _time_runs(setting, rest, _REPEATS * share / len(family.settings))
        except TimeoutError as stop:
            return timed, f"{setting.name} given up after {rest:.2g} s {stop}, and further settings left out"
        except (ArithmeticError, LinAlgError) as failure:
            return timed, f"{setting.name} failed ({reason_of(failure)}), and further settings left out"
        relative_error, last = error(result), min(times)
        bounded = inf if isnan(relative_error) else max(relative_error, resolved)
        timed.append(_Timed(family.name, setting, bounded, times))
    return timed, ""


def _time_runs(setting: TimedCase, rest: float, spare: float) -> tuple[Any, list[float]]:
    """Run a setting up to seven times; return its result and the processor times of the runs [s].

    Further runs start until the time `spare` [s] is used up; all runs are to end within the time `rest` [s].
    Other processes hardly affect the processor time; all runs use one thread.
    """
    start = perf_counter()
    times: list[float] = []
    result = None
    while not times or (len(times) < RUNS and perf_counter() - start < spare):
        cpu_start = process_time()
        result = setting.run(start + rest)
        times.append(process_time() - cpu_start)
    return result, times


def remaining_budget(budget: float, start: float) -> float:
    """Return the budget [s] left after a reference that began at `start` [s]; at least half the budget."""
    return max(budget / 2, budget - (perf_counter() - start))
