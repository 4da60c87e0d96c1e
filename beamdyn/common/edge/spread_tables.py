"""Tables and CSV rows of results whose inputs have tolerances."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from rich.console import Group
from rich.text import Text

from beamdyn.common.edge.console import table
from beamdyn.common.edge.input_sweep import sweep_csv
from beamdyn.common.edge.views import View
from beamdyn.common.plots.curves import sweep_figure
from beamdyn.common.results.columns import Column, Columns, column_named, name_in_heads
from beamdyn.common.spreading.spread_result import Spread, spread_figure
from beamdyn.common.spreading.tolerances import Normal
from beamdyn.common.words import percent, supported

_DIGITS = 6  # largest number of significant digits of a result
# Numbers of characters: width of a table, gap between columns, and width of a pair of variance shares.
_WIDTH, _GAP, _OF_SHARES = 119, 3, 20
_HEADLINES = 6
_SIGNS = "+-."  # characters other than letters and digits that are allowed in column headings
_SMALL = 0.01  # share of the variance below which a table says only "less than"


def spread_table(result: Spread) -> Group:
    """Make a sentence on each result, and tables of ranges, scatter and shares of the variance."""
    said = [Text(headline(result, k)) for k in _told(result)[:_HEADLINES]]
    return Group(*said, _ranges(result), _scatter(result), *_inputs(result), Text(_note(result)))


def _told(result: Spread) -> list[int]:
    """Return the indices of the results that exist for at least one design."""
    return [k for k in range(len(result.answers)) if result.scatter.no_answer[k] < 1]


def headline(result: Spread, answer: int) -> str:
    """Describe a result: nominal value, worst cases, standard deviation, and the most influential input."""
    k, unit = answer, f" {result.units[answer]}".rstrip()
    (low, high), scatter, nominal = _worst(result, k), result.scatter, result.nominal[k]
    parts = [f"{result.answers[k]}: {_number(nominal, _numerical(result, k)(nominal))}{unit}"]
    worst = f"{low} to {high}{unit}"
    if scatter.no_answer[k]:
        none = f"no answer at worst (in {percent(scatter.no_answer[k])} of the random designs)"
        parts.append(f"{none}, else {worst}")
    else:
        parts.append(f"{worst} at worst")
    parts.append(f"standard deviation {_number(*_deviation(result, k))}{unit}")
    names = result.matters_most(k) if len(result.inputs) > 1 else ()
    if len(names) > 1:
        alike = f"{result.samples} samples do not show which of them matters most"
        parts.append(f"{' and '.join(names)} matter most, but {alike}")
    elif names:
        row = int(result.indices.total[:, k].argmax())
        share = _share(result.indices.total[row, k], result.indices.total_error[row, k])
        words = "" if "±" in share else f", with {share} of the variance"
        parts.append(f"{result.inputs[row].name} matters most{words}")
    return "; ".join(parts) + "."


def _numerical(result: Spread, answer: int) -> Callable[[float], float]:
    """Return the function that gives the absolute numerical error of each value of a result."""
    error = result.error[answer]
    return lambda value: abs(value) * error if error > 0 else 0.0  # not of infinite values times 0


def _deviation(result: Spread, answer: int) -> tuple[float, float]:
    """Return the standard deviation of a result, and its error due to sampling and numerical errors."""
    found, values = result.scatter, result.sampled_answers[:, answer]
    largest = np.abs(values[np.isfinite(values)]).max(initial=0.0)
    return found.deviation[answer], found.deviation_error[answer] + _numerical(result, answer)(largest)


def _worst(result: Spread, answer: int) -> tuple[str, str]:
    """Describe the worst cases of a result, with the digits that the error of each value supports."""
    found, k = result.worst, answer
    errors = np.nan_to_num([found.smallest_error[k], found.largest_error[k]], posinf=np.inf)
    return _number(found.smallest[k], errors[0]), _number(found.largest[k], errors[1])


def _number(value: float, error: float) -> str:
    return supported(value, error, _DIGITS).replace("none", "-")


def _share(value: float, error: float) -> str:
    """Format a share of the variance; "< 0.01" if the share is certainly smaller."""
    if abs(value) + 3 * error < _SMALL:
        return f"< {_SMALL:g}"
    return supported(value, error, 3).replace("none", "-")


def _heads(result: Spread) -> list[str]:
    return [
        f"{name} [{unit}]" if unit else name for name, unit in zip(result.answers, result.units, strict=True)
    ]


def _ranges(result: Spread) -> Group:
    """Make the table of nominal values, first-order ranges, worst cases, how these were found, and errors."""
    first, found, rows = result.first_order, result.worst, []
    for k, head in enumerate(_heads(result)):
        wrong = _numerical(result, k)
        nominal = _number(result.nominal[k], wrong(result.nominal[k]))
        ends = (
            _number(value, first.error[k] + wrong(value)) for value in (first.smallest[k], first.largest[k])
        )
        values, errors = (
            (found.smallest[k], found.largest[k]),
            (found.smallest_error[k], found.largest_error[k]),
        )
        at = "search" if found.searched[k] else "corner"
        at = f"{at}, or no answer" if result.scatter.no_answer[k] else at
        at = "unresolved" if np.isinf(errors).any() else at
        relative = [result.error[k], *(e / abs(v) for v, e in zip(values, errors, strict=True) if v)]
        known = [error for error in relative if not np.isnan(error)]
        largest = f"{max(known):.0e}" if known else "-"
        rows.append((head, nominal, *ends, *_worst(result, k), at, largest))
    heads = ("answer", "nominal", "first order from", "to", "worst from", "to", "worst at", "error")
    return table(f"Ranges, by {result.provenance.method}", heads, rows, (0, 6))


def _scatter(result: Spread) -> Group:
    """Make the table of mean, standard deviation and percentiles; standard errors determine the digits."""
    found, rows = result.scatter, []
    for k, head in enumerate(_heads(result)):
        pairs = [(found.percentile[i, k], found.percentile_error[i, k]) for i in (1, 2, 3)]
        none = percent(found.no_answer[k]) if found.no_answer[k] else f"0 of {2 * result.samples}"
        wrong = _numerical(result, k)
        mean, *cells = (
            _number(value, error + wrong(value))
            for value, error in [(found.mean[k], found.mean_error[k]), *pairs]
        )
        rows.append((head, mean, _number(*_deviation(result, k)), *cells, none))
    title = f"Scatter of {2 * result.samples} random designs, seed {result.seed}"
    heads = ("answer", "mean", "standard deviation", "5 %", "50 %", "95 %", "no answer")
    return table(title, heads, rows, (0,))


def _inputs(result: Spread) -> Iterator[Group]:
    """Yield tables of the inputs with tolerances and shares of the variance; wide tables are split."""
    told, found = _told(result), result.indices
    firsts = [(each.name, f"{each.nominal:.6g} {each.unit}".rstrip(), each.text) for each in result.inputs]
    names = [result.answers[k] for k in told]
    left = sum(max(map(len, column)) + _GAP for column in zip(*firsts, ("", "", "tolerance"), strict=True))
    # Number of results that fit side by side.
    beside = max(1, (_WIDTH - left) // (max(_OF_SHARES, *map(len, names), 0) + _GAP))
    for start in range(0, len(told), beside):
        rows: list[list[str]] = [[*first] for first in firsts]
        for i, row in enumerate(rows):
            for k in told[start : start + beside]:
                total = _share(found.total[i, k], found.total_error[i, k])
                row.append(f"{total} ({_share(found.first[i, k], found.first_error[i, k])})")
        heads = ("input", "value", "tolerance", *names[start : start + beside])
        yield table("Share of the variance: with interactions (alone)", heads, rows, (0, 2))


def _note(result: Spread) -> str:
    """Return the note under the tables.

    It states how many designs were computed, that numbers have only the digits that their errors support, and
    from which designs or derivatives slopes and worst cases are computed.
    """
    is_normal = any(isinstance(each.distribution, Normal) for each in result.inputs)
    normal = ", a normal one within three standard deviations" if is_normal else ""
    first, told = result.first_order, _told(result)
    exact = np.all((first.exact | ~np.isfinite(first.slope))[:, told], axis=1).tolist()
    others = [each.name for each, known in zip(result.inputs, exact, strict=True) if not known]
    slopes = f"derivatives; for {', '.join(others)}, from designs near it" if others else "derivatives"
    if others and not first.exact[:, told].any():
        slopes = "designs near it"
    said = (
        f"{result.designs} random designs, {result.worst.designs} for worst cases.",
        "Numbers have only the digits that their errors support.",
        f"First order: slopes at the nominal design, from {slopes}.",
        f"Worst cases: each input within the ends of its tolerance{normal}.",
        f"Corners (all inputs at an end) are the worst as far as {result.samples} pairs of designs show.",
    )
    return " ".join(said)


def spread_csv(result: Spread) -> Columns:
    """Make columns with one row per random design: inputs in SI units, and results."""
    columns = [
        column_named(name_in_heads(each.name.replace(".", "_"), _SIGNS), values, each.unit)
        for each, values in zip(result.inputs, result.sampled_inputs.T, strict=True)
    ]
    for name, values, unit in zip(result.answers, result.sampled_answers.T, result.units, strict=True):
        word, _, number = name.partition(" ")
        if word == "mode" and number.isdecimal():
            columns.append(Column("frequency", values, unit, number))
        else:
            columns.append(column_named(name_in_heads(name, _SIGNS), values, unit))
    return Columns(*columns)


VIEWS = {
    "InputSweep": View(None, sweep_csv, 0, sweep_figure),
    "Spread": View(spread_table, spread_csv, 0, spread_figure),
}
