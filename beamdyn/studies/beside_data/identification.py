"""Result of an identification: numbers with intervals, and which of them the data do not determine."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from beamdyn.common.inputs.checks import NoModelAnswer
from beamdyn.common.results.one_line import counted, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import plain
from beamdyn.common.results.statements import joined
from beamdyn.common.words import InputName, Words, percent
from beamdyn.scene.numbers import with_numbers
from beamdyn.scene.scene import Scene, SceneResult
from beamdyn.studies.beside_data.frequency_comparison import NOTHING, FrequencyComparison
from beamdyn.studies.beside_data.separability import NotSeparable
from beamdyn.studies.beside_data.single_numbers import say_value

_DIGITS = 4  # number of significant digits of numbers in a line of text


@dataclass(frozen=True)
class Identification(SceneResult):
    """Numbers of a scene, identified from measured natural frequencies by bounded least squares.

    Parameters
    ----------
    names, units : tuple of str, shape (p,)
        Names of the numbers in scene files, and their SI units.
    given, value : ndarray, shape (p,)
        Values in the scene, and identified values [unit]; nan if the data do not determine the number, inf
        for a clamped root.
    low, high : ndarray, shape (p,)
        Ends of the 95 % confidence interval [unit], within the bounds of the number; nan if not known.
    covariance : ndarray, shape (p, p)
        Covariance of the values [unit times unit]; nan if not known.
    correlation : ndarray, shape (p, p)
        Correlation of the numbers; for springs, of their compliances.
    not_separable : tuple of NotSeparable
        Numbers that the data do not determine separately, and measurements that would.
    comparison : FrequencyComparison
        Comparison of the data with the identified scene.
    standardized : ndarray, shape (N,)
        Deviation of each value over its uncertainty or, if none is given, over the uncertainty estimated from
        all deviations; nan if the scene has no such mode.
    scatter : float
        Root mean square relative deviation; the divisor is the number of remaining degrees of freedom.
    outliers : tuple of str
        Values with deviations so large that chance causes one in fewer than 1 % of data sets; they are kept.
    solves : int
        Number of scenes whose eigenproblems were solved, each at all speeds.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        How the result was computed.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> data = bd.MeasuredFrequencies([58.707, 367.91], uncertainty=0.05)  # of 0.18 mm
    >>> found = bd.identify(bd.Scene(strip), data, free={"beam.thickness": None})
    >>> bool(abs(found.value[0] - 0.18e-3) < 1e-7)
    True
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    given: np.ndarray
    value: np.ndarray
    low: np.ndarray
    high: np.ndarray
    covariance: np.ndarray
    correlation: np.ndarray
    not_separable: tuple[NotSeparable, ...]
    comparison: FrequencyComparison
    standardized: np.ndarray
    scatter: float
    outliers: tuple[str, ...]
    solves: int

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        for name, value, unit in zip(self.names, self.value, self.units, strict=True):
            said = "undetermined" if np.isnan(value) else say_value(value, unit, _DIGITS, self.display_units)
            yield Words(InputName(name), " ", said)
        yield f"scatter {percent(self.scatter)}" if self.scatter > NOTHING else "no scatter"
        yield warned(self.warnings)

    @property
    def scene_found(self) -> Scene:
        """Scene with the identified numbers.

        Raises
        ------
        ValueError
            If the data do not determine all numbers.
        """
        if np.isnan(self.value).any():
            lost = ", ".join(
                name for name, value in zip(self.names, self.value, strict=True) if np.isnan(value)
            )
            raise NoModelAnswer(f"the data do not determine {lost}: keep one of them fixed, or measure more")
        return with_numbers(self.scene, dict(zip(self.names, self.value.tolist(), strict=True)))

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain numbers, lists and strings, with sentences."""
        return super().to_dict() | {"sentences": plain(self.sentences())}

    def sentences(self) -> tuple[str, ...]:
        """Return sentences on numbers that the data do not determine, on the residual, and on outliers."""
        return tuple(self._sentences())

    def _sentences(self) -> Iterator[str]:
        for each in self.not_separable:
            many = len(each.names) > 1
            said = "cannot be told apart by these data" if many else "is not determined by these data"
            more = joined(" or ", each.measurements) if each.measurements else "to keep one of them fixed"
            yield Words(joined(" and ", map(InputName, each.names)), f" {said}. What would help: ", more, ".")
        left_out = float(np.nan_to_num(self.comparison.model_error / self.comparison.computed).max())
        up_to = f"neglected effects would change the frequencies by up to {percent(left_out)}"
        more = f"; {up_to}." if left_out > NOTHING else "."
        remain = f"The deviations that remain are {percent(self.scatter)} of the frequencies"
        yield (remain if self.scatter > NOTHING else "No deviations remain") + more
        yield from (f"Outlier, but not omitted: {each}." for each in self.outliers)
        for k in np.flatnonzero(self.comparison.mode == 0):
            yield f"{self.comparison.label[k]}: the model has no such mode; it was not used."

    def says(self, k: int) -> Words:
        """Format number k with its interval."""
        said = partial(say_value, unit=self.units[k], units=self.display_units)
        ends = joined(" to ", map(said, (self.low[k], self.high[k])))
        return Words(InputName(self.names[k]), " = ", said(self.value[k]), " (", ends, ")")

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the frequencies of the identified scene over speed, and the measured ones as points."""
        return self.comparison.plot(ax)

    @property
    def degrees_of_freedom(self) -> int:
        """Number of paired frequencies minus the number of identified numbers."""
        return int(np.isfinite(self.standardized).sum()) - len(self.names)

    def counted(self) -> str:
        """State how many numbers follow from how many frequencies: "3 numbers from 15 frequencies"."""
        values = counted(int(np.isfinite(self.standardized).sum()), "frequency", "frequencies")
        return f"{counted(len(self.names), 'number')} from {values}"
