"""Identification of numbers of a scene from measured natural frequencies.

In shapes of arrays, N counts residuals, and p unknowns (numbers to be identified).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from time import perf_counter
from typing import Any

import numpy as np
from scipy import special  # scipy.stats has these functions too, but its import takes long

from beamdyn.common.inputs.checks import InvalidValue, NoModelAnswer, count, kind
from beamdyn.common.results.one_line import counted, number, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Provenance, plain
from beamdyn.common.results.statements import INPUT, LIMITS, Speeds, Statement, joined
from beamdyn.common.words import InputName, Words, percent
from beamdyn.scene.measured_frequencies import MeasuredFrequencies
from beamdyn.scene.numbers import with_numbers
from beamdyn.scene.scene import Scene, SceneResult, check_scene
from beamdyn.studies.beside_data.compare import beside, doubts_of_unit, measured_rows
from beamdyn.studies.beside_data.fit import Fitted, Fitting, fit
from beamdyn.studies.beside_data.free_numbers import Bounds, FreeNumber, free_numbers
from beamdyn.studies.beside_data.frequency_comparison import NOTHING, FrequencyComparison
from beamdyn.studies.beside_data.pairing import NO_MODE
from beamdyn.studies.beside_data.separability import FINEST, Information, NotSeparable, not_separable
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


# The search --------------------------------------------------------------------------------------------


MOST_SOLVES = 40  # largest number of scenes whose modes are computed, per unknown number
_LEVEL = 0.95
_CHANCE = 0.01  # probability of reporting an outlier in data without outliers
# A fit counts as poor if its sum of squares exceeds this quantile: it is repeated from further starts, and a
# warning is given.
_LIKELY = 0.999
_NOTHING = 1e-20  # sum of squared relative deviations below which data count as exact


def identify(
    scene: Scene, data: MeasuredFrequencies, free: Mapping[str, Bounds | None], starts: int = 4, seed: int = 0
) -> Identification:
    """Identify numbers of a scene from measured natural frequencies, by bounded least squares.

    If all frequencies deviate by the ratio of two units, a warning says so, as in `bd.compare`.  Deviations
    are divided by the uncertainties of the data.  If these are not given, they are divided by the
    frequencies, and the uncertainty is estimated from the deviations.  At most 40 scenes are solved for each
    number.

    Parameters
    ----------
    scene : Scene
        The scene, with which the search starts; its motion is not used.
    data : MeasuredFrequencies
        The measured frequencies, at least as many as there are unknown numbers.
    free : mapping of str to pair of float or None
        The unknown numbers by their names in scene files, such as "beam.thickness", each with its smallest
        and largest value [SI], or None for typical bounds.
    starts : int
        Largest number of starts: from the scene's numbers, or from random ones that fit the data better.
    seed : int
        Seed of the random starts.

    Returns
    -------
    Identification

    Raises
    ------
    ValueError
        If a name or a bound is wrong, there are more unknowns than data, or large deflection is modelled.

    References
    ----------
    Bounded least squares: Branch, Coleman and Li (1999); derivatives: Lancaster (1966), section 7.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> data = bd.MeasuredFrequencies([62.0, 390.0, 1095.0], uncertainty=0.3)
    >>> found = bd.identify(bd.Scene(strip), data, free={"mount.root_stiffness": None})
    >>> bool(found.low[0] < found.value[0] < found.high[0])
    True
    """
    start = perf_counter()
    check_scene(scene)
    kind("data", data, MeasuredFrequencies, "read a file by bd.read_measurements")
    numbers = free_numbers(scene, free)
    if data.count < len(numbers):
        measured = counted(data.count, "frequency", "frequencies")
        bound = f"there are {counted(len(numbers), 'unknown')} for {measured}"
        raise InvalidValue("free", ", ".join(free), bound, "free fewer, or measure more")
    known = bool(np.isfinite(data.uncertainty[np.isfinite(data.frequency)]).all())
    fitting = Fitting(scene, data, numbers, data.uncertainty if known else data.frequency)
    enough = _likely_sum(max(data.count - len(numbers), 1)) if known else _NOTHING
    most = MOST_SOLVES * len(numbers)
    found = fit(fitting, count("starts", starts), count("seed", seed, 0), most, enough)
    doubts = tuple(doubts_of_unit(measured_rows(scene, data)))
    paired = int((found.pairs != NO_MODE).sum())
    if paired < len(numbers):
        bound = f"only {paired} of {data.count} frequencies are near modes; unknown numbers: {len(numbers)}"
        remedy = "begin with a scene that is nearer to the data, or give other bounds"
        raise InvalidValue("free", ", ".join(free), bound, "; ".join((*doubts, remedy)))
    return _Told(found, known, doubts).result(start)


def _likely_sum(freedom: int) -> float:
    """Return the 99.9 % quantile of the sum of squares of `freedom` standard normal variables."""
    return float(2 * special.gammaincinv(freedom / 2, _LIKELY))


@dataclass(frozen=True)
class _Told:
    """Statistics derived from a finished fit: intervals, covariances, outliers and warnings.

    `known` states whether the data have uncertainties; `doubts` are statements about a possibly wrong unit.
    """

    fit: Fitted
    known: bool
    doubts: tuple[Statement, ...]

    @property
    def _fitting(self) -> Fitting:
        return self.fit.modes.fitting

    @property
    def _numbers(self) -> tuple[FreeNumber, ...]:
        return self._fitting.numbers

    @cached_property
    def _residual(self) -> np.ndarray:
        return self.fit.modes.residual(self.fit.pairs)

    @property
    def _freedom(self) -> int:
        """Degrees of freedom: number of residuals minus number of fitted numbers."""
        return len(self._residual) - len(self._numbers)

    @cached_property
    def _measured(self) -> np.ndarray:
        return self._fitting.data.frequency[self.fit.pairs != NO_MODE]

    @cached_property
    def _deviation(self) -> float:
        """Standard deviation of the residuals: 1 if uncertainties are given.

        The result is nan if neither uncertainties nor deviations determine it.
        """
        if self.known:
            return 1.0
        return float(np.sqrt(self.fit.cost / self._freedom)) if self._freedom > 0 else np.nan

    @cached_property
    def _uncertainty(self) -> np.ndarray:
        """Standard deviation of each residual, at least that by the relative uncertainty 1e-6 (`FINEST`)."""
        least = FINEST * self._measured / self._fitting.weight[self.fit.pairs != NO_MODE]
        return np.maximum(np.nan_to_num(self._deviation), least)

    @cached_property
    def _information(self) -> Information:
        return Information(self.fit.modes.derivative(self.fit.pairs) / self._uncertainty[:, None])

    @cached_property
    def _values(self) -> np.ndarray:
        each = [n.value(x) for n, x in zip(self._numbers, self.fit.modes.x.tolist(), strict=True)]
        return np.where(self._information.told, each, np.nan)

    @cached_property
    def _intervals(self) -> np.ndarray:
        """Ends (numbers, 2) of the confidence intervals.

        They are centred on the unbounded optimum, even if a bound limits a number.
        """
        quantile = special.ndtri(0.5 + _LEVEL / 2)
        if not self.known:
            quantile = special.stdtrit(self._freedom, 0.5 + _LEVEL / 2) if self._freedom > 0 else np.nan
        middle = self.fit.modes.x + self._information.step(self._residual / self._uncertainty)
        half = quantile * np.sqrt(np.diag(self._information.covariance))
        low, high = self._fitting.limits
        ends = np.clip([middle - half, middle + half], low, high).T
        each = [
            sorted(n.value(x) for x in pair) for n, pair in zip(self._numbers, ends.tolist(), strict=True)
        ]
        sure = self._information.told & np.isfinite(half)
        return np.where(sure[:, None], np.array(each), np.nan)

    @cached_property
    def _covariances(self) -> tuple[np.ndarray, np.ndarray]:
        """Covariance and correlation matrices of the numbers."""
        C = self._information.covariance
        sizes = np.sqrt(np.diag(C))
        x = self.fit.modes.x
        slope = np.array(
            [-n.scale / v**2 if n.is_compliance else n.scale for n, v in zip(self._numbers, x, strict=True)]
        )
        sure = self._information.told & np.isfinite(self._values) & np.isfinite(self._deviation)
        both = np.outer(sure, sure)
        return np.where(both, C * np.outer(slope, slope), np.nan), C / np.outer(sizes, sizes)

    @cached_property
    def _standardized(self) -> np.ndarray:
        """Residuals divided by their standard deviations after the fit.

        These are sqrt(1 - leverage) times the standard deviations of the data.
        """
        spread = np.sqrt(np.maximum(1 - self._information.leverage, FINEST))
        return self._residual / (self._uncertainty * spread)

    @property
    def _poorness(self) -> float:
        """Root mean square of the residuals; about 1 if the uncertainties of the data are right."""
        return float(np.sqrt(self.fit.cost / max(self._freedom, 1)))

    @property
    def _is_poor(self) -> bool:
        """Whether the deviations are too large for the uncertainties of the data."""
        freedom = self._freedom
        return self.known and freedom > 0 and self.fit.cost > _likely_sum(freedom)

    def _outliers(self) -> Iterator[str]:
        """Yield a sentence about each measured value whose deviation is too large to be due to chance."""
        size, freedom = np.abs(self._standardized), self._freedom
        chance = _CHANCE / max(len(size), 1) / 2
        limit = -special.ndtri(chance)
        if not self.known or self._is_poor:  # compare each value with the scatter of the others
            size = np.abs(self._standardized) / (self._poorness if self.known else 1.0)
            if freedom < 2:
                return
            rest = np.maximum(freedom - size**2, FINEST)
            size, limit = size * np.sqrt((freedom - 1) / rest), -special.stdtrit(freedom - 1, chance)
        rows, columns = np.nonzero(self.fit.pairs != NO_MODE)
        data = self._fitting.data
        for k in np.flatnonzero(size > limit):
            name, value = data.labels[columns[k]], number(self._measured[k], "Hz")
            yield Words(
                f"{name} at ", Speeds(data.speeds[rows[k]]), f", {value}, by {size[k]:.1f} uncertainties"
            )

    def _warnings(self) -> Iterator[str]:
        if self._is_poor:
            said = f"deviations are {self._poorness:.2g} times the uncertainties of the data"
            yield Statement(
                f"{said}: the scene does not fit the data, and the intervals do not include this misfit",
                kind=LIMITS,
            )
        if not self.known and self._freedom <= 0:
            said = "there are as many unknowns as data: no interval follows; give uncertainties or more data"
            yield Statement(said, kind=INPUT)
        for number_, x, low, high in zip(self._numbers, self.fit.modes.x, *self._fitting.limits, strict=True):
            if not low * (1 + 1e-6) + 1e-9 < x < high * (1 - 1e-6) and not (
                number_.is_compliance and x <= 2 * low
            ):
                said = f"{number_.path} is at a bound of its range: give wider bounds, or free another number"
                yield Statement(said, kind=LIMITS)

    def result(self, start: float) -> Identification:
        """Build the result of the fit, whose computation started at a time of `perf_counter` [s]."""
        fitting, information = self._fitting, self._information
        comparison = beside(fitting.scene_at(self.fit.modes.x), fitting.data)
        covariance, correlation = self._covariances
        standardized = np.full(len(comparison.label), np.nan)
        has_mode = (self.fit.pairs != NO_MODE)[np.isfinite(fitting.data.frequency)]
        standardized[has_mode] = self._standardized
        relative = self._residual * fitting.weight[self.fit.pairs != NO_MODE] / self._measured
        low, high = self._intervals.T
        provenance = comparison.provenance
        return Identification(
            names=tuple(n.path for n in self._numbers),
            units=tuple(n.unit for n in self._numbers),
            given=np.array([n.given for n in self._numbers]),
            value=self._values,
            low=low,
            high=high,
            covariance=covariance,
            correlation=correlation,
            not_separable=not_separable(self.fit.modes, information.lost),
            comparison=comparison,
            standardized=standardized,
            scatter=float(np.sqrt((relative**2).sum() / max(self._freedom, 1))),
            outliers=tuple(self._outliers()),
            solves=fitting.solved[0],
            warnings=(*self.doubts, *self._warnings(), *comparison.warnings),
            provenance=Provenance.since(start, provenance.method, provenance.compared_with),
            scene=fitting.scene,
        )
