"""Loads along the span, as tables and as columns of CSV files."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from rich.console import Group
from rich.text import Text

import beamdyn as bd
from beamdyn.common.edge.console import table_of
from beamdyn.common.edge.views import View
from beamdyn.common.results.columns import SI_UNITS, Column, Columns
from beamdyn.common.results.statements import said_in
from beamdyn.common.words import supported
from beamdyn.equations.effects import words_of_directions
from beamdyn.loads.span_loads import REMEDIES
from beamdyn.loads.stations import SHOWN, UNITS

if TYPE_CHECKING:
    from beamdyn.loads.transient_loads import EquivalentRange, TransientLoads

_MOST_DIGITS = 7
_DIGITS_EXPECTED = 3  # significant digits of expected loads, which are statistical estimates
_CLASSES = 10  # number of classes into which load cycles are divided by range
_QUANTITIES = "strain", "stress", "force", "moment"  # quantities in the order of tables


def static_loads_table(result: bd.StaticLoads) -> Group:
    """Make a table of the loads along the span for each speed."""
    unit = result.display_units.speed_unit()
    made = (
        _table(result, f"Loads in equilibrium at {unit.say(speed, 10)}, by {result.provenance.method}", case)
        for case, speed in enumerate(result.speeds.tolist())
    )
    return Group(*made, *_largest_lines(result))


def steady_loads_table(result: bd.SteadyLoads) -> Group:
    """Make a table of the largest load magnitudes along the span, at the speed with the largest moment."""
    stable = result.response.stable.any()
    case = int(np.nanargmax(result.moment.max(axis=(1, 2)))) if stable else 0
    speed = result.display_units.speed_unit().say(result.speeds[case], 10)
    at = f"at {speed}, where the bending moment is largest"
    title = f"Largest magnitudes in steady response {at}, by {result.provenance.method}"
    return Group(_table(result, title, case), *(_largest_lines(result) if stable else []))


def transient_loads_table(result: TransientLoads, window: tuple[float, float] | None = None) -> Group:
    """Make a table of the largest loads along the span, in a time window or the whole simulation."""
    start, end = window or (result.run.path.start, result.run.path.end)
    title = f"Loads of largest magnitude from {start:g} to {end:g} s, by {result.provenance.method}"
    peaks = result.path.outputs.split(result.path.peaks(start, end)[0])
    return Group(_table(result, title, None, peaks), *_largest_lines(result, start=start, end=end))


def _table(
    result: bd.SpanLoads, title: str, case: int | None, values: Mapping[str, np.ndarray] | None = None
) -> Group:
    """Make a table with a row per station: axial and shear forces, moments, largest strain and stress.

    The loads are `values` if given, otherwise those of the case (speed) with the index `case`.
    """
    columns = [_positions(result)]
    for name in _QUANTITIES:
        found = result.values(name)[case] if values is None else values[name]
        error = result.error_of(name) if case is None else result.error_of(name)[case]
        if name not in ("strain", "stress"):
            heads = _heads(result, name)
            columns += (_load(name, head, found[:, k], error[:, k]) for k, head in enumerate(heads))
        elif found.shape[1] and np.isfinite(found).any():
            # Strain and stress at that point of the cross-section where they are largest.
            k = np.nan_to_num(np.abs(found), nan=-1.0).argmax(axis=1)[:, None]
            at_largest = (np.take_along_axis(each, k, 1)[:, 0] for each in (found, error))
            columns.append(_load(name, name, *at_largest))
    return table_of(Columns(*columns, title=title), result.display_units)


def _supported(value: float, error: float) -> str:
    return supported(value, error, _MOST_DIGITS)


def _load(quantity: str, head: str, values: np.ndarray, errors: np.ndarray, form: Any = _supported) -> Column:
    """Make a table column of a load in the unit in which tables show the `quantity`, such as MPa for stress.

    `values` and `errors` are in SI units; ``form(value, error)`` formats a value.
    """
    scale, unit = SHOWN[quantity]
    return Column(head, scale * values, unit, error=scale * errors, form=form)


def _heads(result: bd.SpanLoads, quantity: str) -> list[str]:
    """Return the headings of columns of forces or moments, one for each direction of bending."""
    words = [f"{word} ".lstrip() for word in words_of_directions(result.scene) or ("",)]
    if quantity == "moment":
        return [f"{word}moment" for word in words]
    return ["axial force", *(f"{word}shear" for word in words)]


def _positions(result: bd.SpanLoads) -> Column:
    """Make the column of positions; at jumps of the loads, "-" or "+" denotes the side."""
    x, unit = result.x, result.display_units.length_unit()
    jumps = np.flatnonzero(np.diff(x) == 0)
    twice = np.isin(np.arange(len(x)), [*jumps, *(jumps + 1)])
    sides = ["-" if inboard else "+" for inboard in result.inboard]
    cells = [f"{unit.of(at):.6g}{side if two else ''}" for at, side, two in zip(x, sides, twice, strict=True)]
    return Column("position", x, "m", cells=cells)


def _largest_lines(result: Any, **window: float) -> list[Text]:
    """Format the largest value of each quantity that was computed."""
    return _lines(result, lambda name: _say_largest(result, result.largest(name, **window)))


def _lines(result: bd.SpanLoads, say: Callable[[str], str]) -> list[Text]:
    """Return a sentence ``say(quantity)`` for each computed quantity.

    If the strains are unknown, a further sentence says which data of the beam they need.
    """
    known = [name for name in _QUANTITIES if np.isfinite(result.values(name)).any()]
    lacking = [] if "strain" in known else [f"No strains: {REMEDIES['strain']}."]
    return [*map(Text, (*map(say, reversed(known)), *lacking))]


def _say_largest(result: bd.SpanLoads, found: bd.LargestLoad) -> str:
    (scale, unit), case, units = SHOWN[found.quantity], result.case, result.display_units
    value = supported(scale * found.value, scale * found.error, _MOST_DIGITS)
    is_speed = case.name == "speed"
    in_case = units.speed_unit().say(found.case) if is_speed else f"{found.case:.6g} {case.unit}"
    what, place = _say_component(result, found), units.length_unit().say(found.x)
    return f"Largest {found.quantity} ({what}): {value} {unit}, at {place}, at {in_case}."


def _say_component(result: bd.SpanLoads, found: bd.LargestLoad) -> str:
    """Describe the direction of a force or moment, or the point of the section of a strain or stress."""
    named = result.components(found.quantity)[found.component]
    if found.quantity not in ("strain", "stress"):
        return f"shear, {named}" if found.quantity == "force" and found.component else named
    y, z = 1e3 * result.points[result.station_of(found), found.component]
    second = f", {z:.6g} mm along the second" if result.scene.physics.planes == 2 or z else ""
    return f"{named} of the section, {y:.6g} mm from its centre along the first direction{second}"


def random_loads_table(result: bd.RandomLoads) -> Group:
    """Make a table of root mean squares and largest expected loads along the span."""
    units, at, columns = result.display_units, np.arange(len(result.x)), [_positions(result)]
    for name in ("moment", "strain", "stress"):
        values = result.values(name)[0]
        if not np.isfinite(values).any():
            continue
        if name == "moment":
            shown = [(np.full(len(values), k), head) for k, head in enumerate(_heads(result, name))]
        else:  # strains and stresses at that point of the cross-section where they are largest
            shown = [(np.nan_to_num(values, nan=-1.0).argmax(axis=1), name)]
        for k, head in shown:
            rms, error = (each(name)[at, k] for each in (result.rms, result.rms_error))
            most, wrong = (each(name)[0][at, k] for each in (result.values, result.error_of))
            columns.append(_load(name, f"{head}\nrms", rms, error))
            columns.append(_load(name, f"{head}\nlargest", most, wrong, _expected))
    title = (
        f"Largest magnitudes expected in {result.duration:g} s by random {result.input} "
        f"at {units.speed_unit().say(result.speed)}, by {said_in(units, result.provenance.method)}"
    )
    lines = _lines(result, lambda name: _say_expected(result, result.largest(name)))
    return Group(table_of(Columns(*columns, title=title), units), *lines, Text(_ESTIMATE))


_ESTIMATE = (
    "Estimates for a Gaussian input, rather too high: positive and negative peaks count as independent, the "
    "root mean square is that at the angle of rotation at which it is largest, and the constant part, "
    "gravity and the random part are added."
)


def _expected(value: float, error: float = 0.0) -> str:
    """Format a statistical number with three digits, or as "0 ± error"; without a positive exponent."""
    text = supported(value, error, _DIGITS_EXPECTED)
    return f"{float(text):.0f}" if "e+" in text and "±" not in text else text


def _say_expected(result: bd.RandomLoads, found: bd.LargestLoad) -> str:
    """Format a quantity's largest expected value, constant part, part by gravity, rms and 99 % quantile."""
    name, (scale, unit) = found.quantity, SHOWN[found.quantity]
    place = result.station_of(found), found.component
    value = _expected(scale * found.value, scale * found.error)
    mean, gravity, rms, quantile = (
        _expected(scale * float(np.abs(each(name)[place])))
        for each in (result.mean, result.gravity, result.rms, result.quantile)
    )
    what, where = _say_component(result, found), result.display_units.length_unit().say(found.x)
    rate = _expected(float(result.crossings(name)[place]))
    return (
        f"Largest {name} expected ({what}): {value} {unit}, at {where}; constant {mean}, gravity {gravity}, "
        f"rms {rms}, crosses 0 upwards {rate} times a second; with 99 % probability below {quantile}."
    )


# Load cycles --------------------------------------------------------------------------------------------


def cycles_table(cycles: bd.LoadCycles) -> Group:
    """Make a table of the number of load cycles in classes of equal width up to the largest range."""
    scale, unit = SHOWN[cycles.quantity]
    edges = np.linspace(0, scale * float(cycles.ranges.max(initial=0.0)) or 1.0, _CLASSES + 1)
    counts, _ = np.histogram(scale * cycles.ranges, edges, weights=cycles.counts)
    place = cycles.display_units.length_unit().say(cycles.x)
    columns = Columns(
        Column("range", (), unit, cells=[f"{low:.4g} to {high:.4g}" for low, high in pairwise(edges)][::-1]),
        Column("cycles", counts[::-1], form="g"),
        title=f"Cycles of {cycles.quantity} at {place}, {cycles.start:g} to {cycles.end:g} s",
    )
    return table_of(columns, cycles.display_units)


def equivalents_table(equivalents: Sequence[EquivalentRange]) -> Group:
    """Make a table of damage-equivalent ranges of equal cycles, for each Woehler (S-N) exponent."""
    quantity, number = equivalents[0].quantity, equivalents[0].cycles
    scale, unit = SHOWN[quantity]
    ranges, errors = scale * np.array([(each.range, each.error) for each in equivalents]).T
    columns = Columns(
        Column("Woehler exponent", [each.exponent for each in equivalents], form="g"),
        Column(f"range of {quantity}", ranges, unit, error=errors, form=_supported),
        title=f"Damage-equivalent ranges (number of equal cycles: {number:g})",
    )
    return table_of(columns, SI_UNITS)


def cycles_csv(result: bd.LoadCycles) -> Columns:
    """Make columns of range, mean and count, one row per load cycle."""
    unit = UNITS[result.quantity]
    return Columns(
        Column(f"range_of_{result.quantity}", result.ranges, unit),
        Column("mean", result.means, unit),
        Column("cycles", result.counts),
    )


# Columns of files -------------------------------------------------------------------------------------


def loads_csv(result: bd.SpanLoads) -> Columns:
    """Make columns with one row per case and station: position, loads, strains, stresses and errors."""
    values = np.concatenate([result.values(name) for name in UNITS], axis=-1)
    errors = np.concatenate([result.error_of(name) for name in UNITS], axis=-1)
    cases, stations, _ = values.shape
    errors = np.broadcast_to(errors, values.shape)
    return Columns(
        Column(result.case[0], np.repeat(result.cases, stations), result.case[1]),
        *_places(result, cases),
        *_of_components(result, "", values.reshape(cases * stations, -1)),
        *_of_components(result, "error_of_", errors.reshape(cases * stations, -1)),
    )


def _places(result: bd.SpanLoads, times: int = 1) -> tuple[Column, Column]:
    """Make columns of each station's position and side (inboard or outboard of a jump), `times` times."""
    sides = np.where(result.inboard, "inboard", "outboard")
    return Column("position", np.tile(result.x, times), "m"), Column("side", np.tile(sides, times))


def _of_components(result: bd.SpanLoads, part: str, values: np.ndarray) -> Iterator[Column]:
    """Yield a file column for each component of each load; its name is `part` and the component's name.

    `values` has the shape (rows, components).
    """
    named = ((name, unit) for name, unit in UNITS.items() for name in _components(result, name))
    for (name, unit), column in zip(named, values.T, strict=True):
        yield Column(f"{part}{name}", column, unit)


def random_loads_csv(result: bd.RandomLoads) -> Columns:
    """Make columns with one row per station: position, and largest value, rms, mean of each component."""
    parts = {
        "largest": lambda name: result.values(name)[0],
        "error_of_largest": lambda name: result.error_of(name)[0],
        "rms": result.rms,
        "error_of_rms": result.rms_error,
        "mean": result.mean,
        "gravity": result.gravity,
        "crossings_per_s": result.crossings,
    }
    values = {part: np.concatenate([of(name) for name in UNITS], axis=-1) for part, of in parts.items()}
    each = (column for part in parts for column in _of_components(result, f"{part}_", values[part]))
    return Columns(*_places(result), *each)


def _components(result: bd.SpanLoads, quantity: str) -> list[str]:
    """Return the names of the components of a quantity in files."""
    if quantity in ("strain", "stress"):
        return [f"{quantity}_{k + 1}" for k in range(result.points.shape[1])]
    both = result.scene.physics.planes == 2
    words = ("_first", "_second") if quantity == "curvature" else ("_bending", "_across")
    ends = words if both else ("",)
    if quantity == "force":
        return ["axial_force", *(f"shear_force{end}" for end in ends)]
    return [f"{quantity}{end}" for end in ends]


VIEWS = {
    "LoadCycles": View(cycles_table, cycles_csv),
    "RandomLoads": View(random_loads_table, random_loads_csv, 2),
    "StaticLoads": View(static_loads_table, loads_csv, 3),
    "SteadyLoads": View(steady_loads_table, loads_csv, 3),
    "TransientLoads": View(transient_loads_table, loads_csv, 3),
}
