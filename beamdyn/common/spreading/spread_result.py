"""Result of an analysis of tolerances: ranges of results over the tolerances of inputs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from beamdyn.common.results.one_line import counted, warned
from beamdyn.common.results.pictures import COLOURS, Axes, Figure, new_axes, new_figure
from beamdyn.common.results.result import Provenance, Result
from beamdyn.common.spreading.first_order import FirstOrderRange
from beamdyn.common.spreading.statistics import Scatter, SobolIndices
from beamdyn.common.spreading.tolerances import SpreadInput
from beamdyn.common.spreading.worst_case import WorstCases
from beamdyn.common.words import supported

_DIGITS, _MOST_DIGITS = 4, 10  # smallest and largest number of digits in the one-line summary
_APART = 3.0  # difference of two indices, in standard errors, from which they count as different


@dataclass(frozen=True)
class Spread(Result):
    """Ranges of k results over the tolerances of d inputs.

    All errors of statistics are standard errors, from 16 independent blocks of samples: the true value is
    within 2.1 standard errors in 95 of 100 cases.

    Parameters
    ----------
    what : str
        Name of the requested results.
    answers, units : tuple of str, length k
        Name of each result, such as "mode 1", and its unit.
    inputs : tuple of SpreadInput, length d
        Inputs, each with `name`, `unit`, `nominal` value, `distribution` and `text` of the tolerance.
    nominal : ndarray, shape (k,)
        Results of the nominal design [`units`].
    error : ndarray, shape (k,)
        Largest estimated relative error of each result over the nominal design, the designs for derivatives,
        and the random designs; `worst` has its own errors.
    first_order : FirstOrderRange
        Estimates from the derivatives at the nominal design: `smallest`, `largest`, `mean`, `deviation`,
        `share` of each input in the variance; `slope`, `slope_error`.
    worst : WorstCases
        `smallest` and `largest` results within all tolerances, with their errors, the inputs of these designs
        (`smallest_at`, `largest_at`), and whether a search found them (`searched`), so that worse designs may
        exist.
    trends : ndarray of str, shape (d, k)
        How each result changes with each input in n pairs of random designs: "rises", "falls", "rises and
        falls", "does not change"; "no answer" if the result is missing.
    scatter : Scatter
        Statistics of random designs: `mean`, standard `deviation` and `percentile` (1, 5, 50, 95, 99 %) of
        the existing results, each with its error; and the fraction of designs without a result, `no_answer`.
    indices : SobolIndices
        Sobol' indices: fraction of the variance due to each input alone (`first`), and including its
        interactions with other inputs (`total`), and their errors.
    states : tuple of dict, length k
        Fraction of random designs in each state, such as "stable" or "divergence".
    samples, seed : int
        Number n of designs in each of the 2 + d random samples, and the seed of the random numbers.
    sampled_inputs : ndarray, shape (2 n, d)
        Random designs on which the statistics are based [SI units of the inputs].
    sampled_answers : ndarray, shape (2 n, k)
        Results of the random designs [`units`]; not finite where there is none.
    warnings : tuple of str
        Warnings about the results.
    provenance : Provenance
        Version, method and computing time.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> tolerances = {"beam.thickness": "+-2%", "beam.density": "+-1%"}
    >>> bd.spread(bd.Scene(strip), tolerances, modes=1, samples=128).matters_most(0)
    ('beam.thickness',)
    """

    what: str
    answers: tuple[str, ...]
    units: tuple[str, ...]
    inputs: tuple[SpreadInput, ...]
    nominal: np.ndarray
    error: np.ndarray
    first_order: FirstOrderRange
    worst: WorstCases
    trends: np.ndarray
    scatter: Scatter
    indices: SobolIndices
    states: tuple[dict[str, float], ...]
    samples: int
    seed: int
    sampled_inputs: np.ndarray
    sampled_answers: np.ndarray
    warnings: tuple[str, ...]
    provenance: Provenance

    def headline(self) -> Iterator[str]:
        """Yield range and most influential input of the first result, for the one-line summary.

        See `Result.headline`.
        """
        k = next((k for k, share in enumerate(self.scatter.no_answer) if share < 1), 0)
        first, unit, names = self.first_order, f" {self.units[k]}".rstrip(), self.matters_most(k)
        error = first.error[k] + np.nan_to_num(self.error[k], posinf=np.inf) * abs(self.nominal[k])
        ends = first.smallest[k], first.largest[k]
        low, high = (supported(end, error, _digits_of(*ends)) for end in ends)
        yield f"{self.answers[k]} of {counted(self.designs, 'design')}: first order {low} to {high}{unit}"
        if names and len(self.inputs) > 1:
            yield f"{' and '.join(names)} matter{'s' * (len(names) == 1)} most"
        yield warned(self.warnings)

    @property
    def designs(self) -> int:
        """Return the number of random designs that were computed: (2 + d) n, for d inputs and n samples."""
        return (2 + len(self.inputs)) * self.samples

    def matters_most(self, answer: int = 0) -> tuple[str, ...]:
        """Return the input with the largest total Sobol' index for the result with index `answer`.

        Return several inputs if their indices differ by less than three standard errors; none if there are no
        indices.
        """
        total, error = self.indices.total[:, answer], self.indices.total_error[:, answer]
        if not np.isfinite(total).all():
            return ()
        top = int(total.argmax())
        near = total[top] - total <= _APART * np.hypot(error, error[top])
        near[top] = True
        return tuple(self.inputs[i].name for i in np.argsort(-total, kind="stable") if near[i])

    def design(self, row: int) -> dict[str, float]:
        """Return the inputs of a random design, by name, in SI units: a row of `sampled_inputs`."""
        values = self.sampled_inputs[row].tolist()
        return {each.name: value for each, value in zip(self.inputs, values, strict=True)}

    def plot(self, ax: Axes | None = None, answer: int = 0) -> Axes:
        """Draw the scatter of result `answer`: histogram, percentiles, first-order range and worst cases."""
        first, worst, unit = self.first_order, self.worst, self.units[answer]
        marks = (
            ("5 % and 95 %", "--", COLOURS[0], self.scatter.percentile[[1, 3], answer].tolist()),
            ("first order", ":", COLOURS[1], (first.smallest[answer], first.largest[answer])),
            ("worst cases", "-", COLOURS[1], (worst.smallest[answer], worst.largest[answer])),
            ("nominal", "-", "black", (self.nominal[answer],)),
        )
        label = f"{self.answers[answer]} [{unit}]" if unit else self.answers[answer]
        return draw_scatter(self.sampled_answers[:, answer], label, marks, ax)

    def plot_indices(self, ax: Axes | None = None) -> Axes:
        """Draw the contribution of each input to the variance of each result, with error bars."""
        found, names = self.indices, [each.name for each in self.inputs]
        return draw_indices(names, self.answers, found.total, found.total_error, found.first, ax)


def _digits_of(low: float, high: float) -> int:
    """Return the number of significant digits that shows the ends of a range to some percent of its width."""
    with np.errstate(divide="ignore", invalid="ignore"):
        needed = 2 + np.log10(np.divide(max(abs(low), abs(high)), high - low))
    return int(np.clip(needed, _DIGITS, _MOST_DIGITS)) if np.isfinite(needed) else _DIGITS


# Pictures of scatter and variance -----------------------------------------------------------------


_BINS = 24
_ROUNDING = 1e-12  # relative scatter up to which results count as one number
_AROUND = 1e-3  # relative width of the picture on either side of this number
_MOST_PANELS = 4  # largest number of results that a figure shows
# Distance of the limits of a histogram from the 5 % and 95 % percentiles, divided by the distance between the
# percentiles.
_REACH = 1.0


def draw_scatter(
    values: np.ndarray, label: str, marks: Sequence[tuple[str, str, str, Sequence[float]]], ax: Axes | None
) -> Axes:
    """Draw a histogram of a result, with vertical marks.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Results of random designs; those that are not finite are counted, but not drawn.
    label : str
        Label of the axis.
    marks : sequence of (label, style, colour, places)
        Vertical lines at the positions `places`.
    ax : Axes, optional
        Axes to draw on; new axes if not given.
    """
    ax, drawn = (ax or new_axes(height=4.0)), values[np.isfinite(values)]
    ax.set_xlabel(label)
    ax.set_ylabel("random designs [%]")
    low, high = _seen(drawn)
    if drawn.size:
        weights = np.full(len(drawn), 100 / len(values))
        some = "" if low <= drawn.min() and drawn.max() <= high else ", some beyond the picture"
        start, end = max(low, drawn.min()), min(high, drawn.max())
        # Of an odd number of bins, the middle one has the number that all results are.
        bins, within = (_BINS + 1, (low, high)) if _is_one_number(start, end) else (_BINS, (start, end))
        ax.hist(drawn, bins, range=within, weights=weights, color=COLOURS[5], label=f"random designs{some}")
    for name, style, colour, places in marks:
        shown = [place for place in places if low <= place <= high]
        beyond = ", beyond the picture" if len(shown) < np.isfinite(places).sum() else ""
        for i, place in enumerate(shown or [np.nan]):
            label = "" if i else f"{name}{beyond}"
            ax.axvline(place, linestyle=style, color=colour, linewidth=1.4, label=label)
    ax.legend(fontsize=9, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return ax


def _seen(drawn: np.ndarray) -> tuple[float, float]:
    """Return the limits of a histogram, which exclude a few outliers."""
    if not drawn.size:
        return -np.inf, np.inf
    low, high = np.percentile(drawn, [5, 95])
    reach = _AROUND * abs(high) if _is_one_number(low, high) else _REACH * (high - low)
    return low - reach, high + reach


def _is_one_number(low: float, high: float) -> bool:
    """Return whether two results differ by no more than rounding, between which a histogram has no bins."""
    return high - low <= _ROUNDING * abs(high)


def draw_indices(
    inputs: Sequence[str],
    answers: Sequence[str],
    total: np.ndarray,
    error: np.ndarray,
    first: np.ndarray,
    ax: Axes | None,
) -> Axes:
    """Draw total Sobol' indices as bars with standard errors, first-order indices as diamonds.

    Parameters
    ----------
    inputs, answers : sequence of str
        Names of the d inputs and k results; of many results, the first ones are drawn.
    total, error, first : ndarray, shape (d, k)
        Total indices, their errors, and first-order indices; values that are not finite are omitted.
    ax : Axes, optional
        Axes to draw on; new axes if not given.
    """
    ax, shown = (ax or new_axes(height=4.0)), min(len(answers), len(COLOURS))
    height, rows = 0.8 / shown, np.arange(len(inputs))[::-1]
    if not np.isfinite(total).any():
        ax.text(0.5, 0.5, "no shares: see the warnings", ha="center", va="center", transform=ax.transAxes)
        ax.set_axis_off()
        return ax
    error = np.where(np.isfinite(error), error, 0.0)
    for k in range(shown):
        places = rows + (shown / 2 - k - 0.5) * height
        bars = np.nan_to_num(total[:, k])
        ax.barh(places, bars, height, xerr=error[:, k], color=COLOURS[k], label=answers[k], capsize=2)
        mark = "by the input alone" if k == shown - 1 else ""
        ax.plot(first[:, k], places, "d", color="white", markeredgecolor="0.2", markersize=4, label=mark)
    ax.set_yticks(rows, inputs)
    ax.set_xlabel("share of the variance (total index)")
    ax.grid(color="0.9", linewidth=0.8, axis="x")
    ax.set_axisbelow(True)
    ax.legend(fontsize=9, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return ax


def spread_figure(spread: Any) -> Figure:
    """Draw the scatter of the first results of a `Spread`, and below it the influence of the inputs."""
    panels = min(len(spread.answers), _MOST_PANELS)
    below = 1.2 + 0.35 * len(spread.inputs)
    figure = new_figure(7.5, 2.4 * panels + below)
    axes = figure.subplots(panels + 1, 1, height_ratios=[2.4] * panels + [below])
    for answer in range(panels):
        spread.plot(axes[answer], answer)
    spread.plot_indices(axes[-1])
    return figure
