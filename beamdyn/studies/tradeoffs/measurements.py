"""Measured errors and times, their Pareto front, and the cost per digit."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from math import inf, isfinite, nan
from typing import TYPE_CHECKING

import numpy as np

from beamdyn.common.results.one_line import counted, number
from beamdyn.common.results.result import Result

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MOST_DIGITS = 14  # of `cost_per_digit`; double precision has 16


@dataclass(frozen=True)
class Measurement:
    """Error and time of one setting.

    Parameters
    ----------
    family : str
        A basis, a kind of element, an integrator.
    setting : str
        Setting of the family, in words.
    size : float
        Varied number: functions, elements, modes, harmonics or a tolerance.
    error : float
        Relative error of the result; inf where the result is not a number.
    time : float
        Shortest processor time of several runs, in one thread [s].
    """

    family: str
    setting: str
    size: float
    error: float
    time: float


@dataclass(frozen=True)
class Digit:
    """Cheapest measurement with a number of correct digits.

    Parameters
    ----------
    error : float
        Largest allowed error.
    family, setting : str
        Family and setting of the cheapest measurement within this error.
    time : float
        Time of this measurement [s].
    ratio : float
        Ratio of the time to that of one digit less; nan for the first digit.
    """

    error: float
    family: str
    setting: str
    time: float
    ratio: float


def number_of(number: int, one: str, many: str) -> str:
    """Number with its noun, in the singular or the plural."""
    return f"{number} {one if number == 1 else many}"


def pareto_front(measurements: Sequence[Measurement]) -> tuple[Measurement, ...]:
    """Find the Pareto front: the measurements than which none is better in error or time and as good in both.

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
        digits.append(Digit(10.0**-k, m.family, m.setting, m.time, ratio))
    return tuple(digits)


@dataclass(frozen=True)
class Diagram(Result):
    """Work-precision diagram: error against time of all settings that compute the same result.

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
        """What it says in one line; see `Result.headline`."""
        yield self.title
        yield f"{counted(len(self.measurements), 'measurement')}, {len(self.front)} in front"
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
        """Make a diagram, with its front and cost per digit."""
        front, per_digit = pareto_front(measurements), cost_per_digit(measurements)
        return cls(
            title, error_of, reference, resolved, tuple(measurements), front, per_digit, tuple(skipped)
        )

    @property
    def summary(self) -> str:
        """Front as one line of text: families and settings by ascending time."""
        parts = []
        for family, members in groupby(self.front, key=lambda m: m.family):
            settings = [m.setting for m in members]
            parts.append(f"{family} ({' to '.join(dict.fromkeys([settings[0], settings[-1]]))})")
        return ", then ".join(parts)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw error against time, one line per family, and the front."""
        from beamdyn.common.plots.curves import plot_work_precision

        lines: dict[str, list[tuple[float, float]]] = {}
        for m in self.measurements:
            lines.setdefault(m.family, []).append((m.time, m.error))
        front = np.array([(m.time, m.error) for m in self.front]).reshape(-1, 2)
        return plot_work_precision({name: np.array(p) for name, p in lines.items()}, front, self.title, ax)
