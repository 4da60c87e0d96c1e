"""Measured errors and times, the Pareto front among them, and the cost of a digit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from math import inf, isfinite, nan
from typing import TYPE_CHECKING

import numpy as np

from beamdyn.common.results import Result

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MOST_DIGITS = 14


@dataclass(frozen=True)
class Measurement:
    """One way to the answer.

    Parameters
    ----------
    family : str
        The method: a basis, a kind of element, an integrator.
    setting : str
        Its setting, in words.
    size : float
        The number that is varied: functions, elements, modes, harmonics or a tolerance.
    error : float
        Relative error of the answer; inf if it is not a number.
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
    """The cheapest way to a number of digits.

    Parameters
    ----------
    error : float
        Largest error that is allowed.
    family, setting : str
        The cheapest measurement that keeps it.
    time : float
        Its time [s].
    ratio : float
        Its time over that of one digit less; nan for the first.
    """

    error: float
    family: str
    setting: str
    time: float
    ratio: float


def counted(number: int, one: str, many: str) -> str:
    """A number of things, in words."""
    return f"{number} {one if number == 1 else many}"


def pareto_front(measurements: Sequence[Measurement]) -> tuple[Measurement, ...]:
    """The measurements that none beats: none is as good in error and in time and better in one of them.

    Parameters
    ----------
    measurements : sequence of Measurement
        In any order; those without a finite error are never in the front.

    Returns
    -------
    tuple of Measurement
        The quickest first.
    """
    front, best, when = [], inf, nan
    for m in sorted(measurements, key=lambda m: (m.time, m.error)):
        if isfinite(m.error) and (m.error < best or (m.error, m.time) == (best, when)):
            front.append(m)
            best, when = m.error, m.time
    return tuple(front)


def cost_per_digit(measurements: Sequence[Measurement]) -> tuple[Digit, ...]:
    """The shortest time for errors of at most 1e-1, 1e-2, ..., as far as they are reached."""
    digits: list[Digit] = []
    for k in range(1, _MOST_DIGITS + 1):
        good = [m for m in measurements if m.error <= 10.0**-k]
        if not good:
            break
        m = min(good, key=lambda m: m.time)
        ratio = m.time / digits[-1].time if digits else nan
        digits.append(Digit(10.0**-k, m.family, m.setting, m.time, ratio))
    return tuple(digits)


@dataclass(frozen=True)
class Diagram(Result):
    """A work-precision diagram: error against time of every way to one answer.

    Parameters
    ----------
    title : str
        What is computed.
    error_of : str
        What the error is of, and relative to what.
    reference : str
        The answer that the others are compared with, and how it was checked.
    resolved : float
        Relative error of the reference: smaller errors are counted as this large.
    measurements : tuple of Measurement
        Family by family, the cheapest first.
    front : tuple of Measurement
        The Pareto front, the quickest first.
    per_digit : tuple of Digit
        What each digit costs.
    skipped : tuple of str
        What was not measured, and why.
    """

    title: str
    error_of: str
    reference: str
    resolved: float
    measurements: tuple[Measurement, ...]
    front: tuple[Measurement, ...]
    per_digit: tuple[Digit, ...]
    skipped: tuple[str, ...]

    @classmethod
    def of(
        cls,
        title: str,
        error_of: str,
        reference: str,
        resolved: float,
        measurements: Sequence[Measurement],
        skipped: Sequence[str] = (),
    ) -> Diagram:
        """The diagram with its front and its cost per digit."""
        front, per_digit = pareto_front(measurements), cost_per_digit(measurements)
        return cls(
            title, error_of, reference, resolved, tuple(measurements), front, per_digit, tuple(skipped)
        )

    @property
    def summary(self) -> str:
        """The front in a line: its families and settings in the order of their times."""
        parts = []
        for family, members in groupby(self.front, key=lambda m: m.family):
            settings = [m.setting for m in members]
            parts.append(f"{family} ({' to '.join(dict.fromkeys([settings[0], settings[-1]]))})")
        return ", then ".join(parts)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw error against time, a line a family, and the front."""
        from beamdyn.output.plots import plot_work_precision

        lines: dict[str, list[tuple[float, float]]] = {}
        for m in self.measurements:
            lines.setdefault(m.family, []).append((m.time, m.error))
        front = np.array([(m.time, m.error) for m in self.front]).reshape(-1, 2)
        return plot_work_precision({name: np.array(p) for name, p in lines.items()}, front, self.title, ax)
