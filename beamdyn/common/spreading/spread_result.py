"""The result of a spread: ranges of answers over the tolerances of inputs."""

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

_DIGITS, _MOST_DIGITS = 4, 10  # digits in the headline, at least and at most
_APART = 3.0  # number of standard errors by which two indices are told apart


@dataclass(frozen=True)
class Spread(Result):
    """Ranges of k answers over the tolerances of d inputs.

    All errors of statistics are standard errors, from 16 blocks of samples that were drawn independently: the
    truth lies within 2.1 of them in 95 of 100 cases.

    Parameters
    ----------
    what : str
        The question.
    answers, units : tuple of str, length k
        Name of each answer, such as "mode 1", and its unit.
    inputs : tuple of SpreadInput, length d
        Each with its `name`, `unit`, `nominal` value, `distribution` and the `text` of its tolerance.
    nominal : ndarray, shape (k,)
        Answers of the nominal design [`units`].
    error : ndarray, shape (k,)
        Largest estimated relative error of an answer over the nominal design, those for slopes and the random
        ones; `worst` has its own.
    first_order : FirstOrderRange
        What the derivatives at the nominal design say: `smallest`, `largest`, `mean`, `deviation`, `share` of
        each input in the variance; `slope`, `slope_error`.
    worst : WorstCases
        `smallest` and `largest` answers within all tolerances, with their errors, the inputs at which they
        are found (`smallest_at`, `largest_at`), and whether they were `searched`, so that there may be worse.
    trends : ndarray of str, shape (d, k)
        How each answer changes with each input, as far as n pairs of random designs show: "rises", "falls",
        "rises and falls", "does not change"; "no answer" where the answer is not known.
    scatter : Scatter
        Statistics of random designs: `mean`, standard `deviation` and `percentile` (1, 5, 50, 95, 99 %) over
        those that have an answer, each with its error; and the share of designs that have `no_answer`.
    indices : SobolIndices
        Sobol' indices: shares of the variance by each input alone (`first`), and with what it does together
        with others (`total`), and their errors.
    states : tuple of dict, length k
        Share of random designs in each state, such as "stable" or "divergence".
    samples, seed : int
        Number n of designs in each of the 2 + d random samples, and the seed that they follow from.
    sampled_inputs : ndarray, shape (2 n, d)
        Random designs, of which the statistics are [SI units of the inputs].
    sampled_answers : ndarray, shape (2 n, k)
        Their answers [`units`]; not finite where there is none.
    warnings : tuple of str
        Warnings about the answers.
    provenance : Provenance
        How it was found.

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
        """Yield range and most important input of the first answer, parts of a one-line summary.

        See `Result.headline`.
        """
        k = next((k for k, share in enumerate(self.scatter.no_answer) if share < 1), 0)
        first, unit, names = self.first_order, f" {self.units[k]}".rstrip(), self.matters_most(k)
        error = first.error[k] + np.nan_to_num(self.error[k], posinf=np.inf) * abs(self.nominal[k])
        ends = first.smallest[k], first.largest[k]
        low, high = (supported(end, error, _digits_of(*ends)) for end in ends)
        yield f"{self.answers[k]} of {counted(self.designs, 'design')}: {low} to {high}{unit} first order"
        if names and len(self.inputs) > 1:
            yield f"{' and '.join(names)} matter{'s' * (len(names) == 1)} most"
        yield warned(self.warnings)

    @property
    def designs(self) -> int:
        """Number of random designs that were answered: (2 + d) n."""
        return (2 + len(self.inputs)) * self.samples

    def matters_most(self, answer: int = 0) -> tuple[str, ...]:
        """Return the input that contributes most to the variance of an answer, by its total index.

        Several where their indices are not told apart by three standard errors; none where there are no
        indices.
        """
        total, error = self.indices.total[:, answer], self.indices.total_error[:, answer]
        if not np.isfinite(total).all():
            return ()
        top = int(total.argmax())
        near = total[top] - total <= _APART * np.hypot(error, error[top])
        near[top] = True
        order = np.argsort(-total, kind="stable")
        return tuple(self.inputs[i].name for i in order if near[i])

    def design(self, row: int) -> dict[str, float]:
        """Return the inputs of a random design by name, in SI: a row of `sampled_inputs`."""
        values = self.sampled_inputs[row].tolist()
        return {each.name: value for each, value in zip(self.inputs, values, strict=True)}

    def plot(self, ax: Axes | None = None, answer: int = 0) -> Axes:
        """Draw how an answer scatters: its random designs, percentiles, first order and worst cases."""
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
        """Draw the shares of the variance of each answer that come from each input, with their errors."""
        found, names = self.indices, [each.name for each in self.inputs]
        return draw_indices(names, self.answers, found.total, found.total_error, found.first, ax)


def _digits_of(low: float, high: float) -> int:
    """Return the number of digits that tell both ends of a range apart, to some percent of the range."""
    with np.errstate(divide="ignore", invalid="ignore"):
        needed = 2 + np.log10(np.divide(max(abs(low), abs(high)), high - low))
    return int(np.clip(needed, _DIGITS, _MOST_DIGITS)) if np.isfinite(needed) else _DIGITS


# Pictures of spreads ------------------------------------------------------------------------------


_BINS = 24
_MOST_PANELS = 4  # largest number of answers that a figure shows
# Distance of a histogram's ends beyond the 5 % and 95 % points, over the distance of these two points.
_REACH = 1.0


def draw_scatter(
    values: np.ndarray, label: str, marks: Sequence[tuple[str, str, str, Sequence[float]]], ax: Axes | None
) -> Axes:
    """Draw a histogram of an answer, with marks.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Answers of random designs; those that are not finite count, but are not drawn.
    label : str
        Label of the axis.
    marks : sequence of (label, style, colour, places)
        Vertical lines at places.
    ax : Axes, optional
        Where to draw; new axes if not given.
    """
    ax, drawn = (ax or new_axes(height=4.0)), values[np.isfinite(values)]
    ax.set_xlabel(label)
    ax.set_ylabel("random designs [%]")
    low, high = _seen(drawn)
    if drawn.size:
        weights = np.full(len(drawn), 100 / len(values))
        some = "" if low <= drawn.min() and drawn.max() <= high else ", some beyond the picture"
        within = (max(low, drawn.min()), min(high, drawn.max()))
        ax.hist(drawn, _BINS, range=within, weights=weights, color=COLOURS[5], label=f"random designs{some}")
    for name, style, colour, places in marks:
        shown = [place for place in places if low <= place <= high]
        beyond = ", beyond the picture" if len(shown) < np.isfinite(places).sum() else ""
        for i, place in enumerate(shown or [np.nan]):
            label = "" if i else f"{name}{beyond}"
            ax.axvline(place, linestyle=style, color=colour, linewidth=1.4, label=label)
    ax.legend(fontsize=9, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return ax


def _seen(drawn: np.ndarray) -> tuple[float, float]:
    """Return the ends of a histogram of answers, so that a few outliers do not hide the rest."""
    if not drawn.size:
        return -np.inf, np.inf
    low, high = np.percentile(drawn, [5, 95])
    return low - _REACH * (high - low), high + _REACH * (high - low)


def draw_indices(
    inputs: Sequence[str],
    answers: Sequence[str],
    total: np.ndarray,
    error: np.ndarray,
    first: np.ndarray,
    ax: Axes | None,
) -> Axes:
    """Draw total indices as bars with their standard errors, those of first order as diamonds.

    Parameters
    ----------
    inputs, answers : sequence of str
        The d inputs and k answers; of many answers the first are drawn.
    total, error, first : ndarray, shape (d, k)
        Indices and the errors of the total ones; those that are not finite are left out.
    ax : Axes, optional
        Where to draw; new axes if not given.
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
    """Draw how the first answers of a `Spread` scatter, a panel each, and below them which inputs matter."""
    panels = min(len(spread.answers), _MOST_PANELS)
    below = 1.2 + 0.35 * len(spread.inputs)
    figure = new_figure(7.5, 2.4 * panels + below)
    axes = figure.subplots(panels + 1, 1, height_ratios=[2.4] * panels + [below])
    for answer in range(panels):
        spread.plot(axes[answer], answer)
    spread.plot_indices(axes[-1])
    return figure
