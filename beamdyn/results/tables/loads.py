"""Tables and CSV rows of loads along the span."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from rich.console import Group
from rich.text import Text

from beamdyn.common.edge.tables import table
from beamdyn.common.results.columns import Column, Columns
from beamdyn.common.results.digits import supported
from beamdyn.common.results.statements import said_in
from beamdyn.equations.directions import words_of_directions
from beamdyn.loads.span_loads import REMEDIES
from beamdyn.loads.stations import UNITS

if TYPE_CHECKING:
    from beamdyn.common.results.display_units import ShownUnit
    from beamdyn.common.results.result import Result
    from beamdyn.loads.cycles import LoadCycles
    from beamdyn.loads.random_loads import RandomLoads
    from beamdyn.loads.span_loads import LargestLoad, SpanLoads
    from beamdyn.loads.static_loads import StaticLoads
    from beamdyn.loads.steady_loads import SteadyLoads
    from beamdyn.loads.transient_loads import EquivalentRange, TransientLoads

_MOST_DIGITS = 7
_DIGITS_EXPECTED = 3  # of the largest that are expected: statistics have no more
_CLASSES = 10  # of ranges of cycles
_SCALES = {"strain": (1e6, "1e-6"), "stress": (1e-6, "MPa"), "force": (1.0, "N"), "moment": (1.0, "N m")}


def static_loads_table(result: StaticLoads) -> Group:
    """Loads along the span at each speed."""
    unit = result.display_units.speed_unit()
    made = (
        _table(result, f"Loads in equilibrium at {unit.say(speed, 10)}, by {result.provenance.method}", case)
        for case, speed in enumerate(result.speeds.tolist())
    )
    return Group(*made, *_largest_lines(result))


def steady_loads_table(result: SteadyLoads) -> Group:
    """Largest magnitudes along the span at the speed at which they are largest."""
    case = int(np.nanargmax(result.moment.max(axis=(1, 2)))) if result.response.stable.any() else 0
    speed = result.display_units.speed_unit().say(result.speeds[case], 10)
    at = f"at {speed}, where the bending moment is largest"
    title = f"Largest magnitudes in steady response {at}, by {result.provenance.method}"
    lines = _largest_lines(result) if result.response.stable.any() else []
    return Group(_table(result, title, case), *lines)


def transient_loads_table(result: TransientLoads, window: tuple[float, float] | None = None) -> Group:
    """Largest values along the span within a window, or the whole run."""
    start, end = window or (result.run.path.start, result.run.path.end)
    values, _ = result.path.peaks(start, end)
    title = f"Loads of largest magnitude from {start:g} to {end:g} s, by {result.provenance.method}"
    quantities = result.path.outputs.split(values)
    return Group(_rows_table(result, title, quantities, None), *_largest_lines(result, (start, end)))


def _table(result: SpanLoads, title: str, case: int) -> Group:
    quantities = {name: result.values(name)[case] for name in _SCALES}
    return _rows_table(result, title, quantities, case)


def _rows_table(result: SpanLoads, title: str, values: dict[str, np.ndarray], case: int | None) -> Group:
    """Rows of stations: axial and shear forces, moments, and the strain and stress that are largest there."""
    columns: dict[str, list[str]] = {f"position [{_length_unit(result).name}]": _positions(result)}
    for name, (scale, unit) in _SCALES.items():
        error = result.error_of(name) if case is None else result.error_of(name)[case]
        if name in ("strain", "stress"):
            of_points = values[name]
            if of_points.shape[1] and np.isfinite(of_points).any():
                columns[f"{name} [{unit}]"] = _largest_cells(of_points * scale, error * scale)
            continue
        for k, head in enumerate(_heads(result, name)):
            columns[f"{head} [{unit}]"] = _cells(values[name][:, k], error[:, k])
    return table(title, [*columns], [*zip(*columns.values(), strict=True)], ())


def _heads(result: SpanLoads, quantity: str) -> list[str]:
    words = words_of_directions(result.scene) or ("",)
    named = [f"{word} ".lstrip() for word in words]
    if quantity == "moment":
        return [f"{word}moment" for word in named]
    return ["axial force", *(f"{word}shear" for word in named)]


def _length_unit(result: Result) -> ShownUnit:
    return result.display_units.length_unit()


def _positions(result: SpanLoads) -> list[str]:
    """Positions; those with two sides with the side."""
    x, unit = result.x, _length_unit(result)
    twice = np.isin(np.arange(len(x)), np.flatnonzero(np.diff(x) == 0)) | np.isin(
        np.arange(len(x)), 1 + np.flatnonzero(np.diff(x) == 0)
    )
    sides = ["-" if inboard else "+" for inboard in result.inboard]
    return [f"{unit.of(at):.6g}{side if two else ''}" for at, side, two in zip(x, sides, twice, strict=True)]


def _cells(values: np.ndarray, errors: np.ndarray) -> list[str]:
    return [supported(float(v), float(e), _MOST_DIGITS) for v, e in zip(values, errors, strict=True)]


def _largest_cells(values: np.ndarray, errors: np.ndarray) -> list[str]:
    """The value of largest magnitude of the points of each station."""
    k = np.nan_to_num(np.abs(values), nan=-1.0).argmax(axis=1)[:, None]
    return _cells(np.take_along_axis(values, k, 1)[:, 0], np.take_along_axis(errors, k, 1)[:, 0])


def _largest_lines(result: SpanLoads, window: tuple[float, float] | None = None) -> list[Text]:
    """A sentence on the largest of each quantity that has values."""
    given: dict[str, Any] = {} if window is None else {"start": window[0], "end": window[1]}
    known = [name for name in _SCALES if np.isfinite(result.values(name)).any()]
    said = [Text(_say_largest(result, result.largest(name, **given))) for name in reversed(known)]
    return [*said, *_say_what_strains_need(known)]


def _say_what_strains_need(known: Sequence[str]) -> list[Text]:
    """A sentence if the section has no points at which there are strains."""
    return [] if "strain" in known else [Text(f"No strains: {REMEDIES['strain']}.")]


def _say_largest(result: SpanLoads, found: LargestLoad) -> str:
    scale, unit = _SCALES[found.quantity]
    value = supported(scale * found.value, scale * found.error, _MOST_DIGITS)
    name, unit_of_case, _ = result.case
    case = f"{found.case:.6g} {unit_of_case}"
    if name == "speed":
        case = result.display_units.speed_unit().say(found.case)
    what, place = _say_component(result, found), _length_unit(result).say(found.x)
    return f"Largest {found.quantity} ({what}): {value} {unit}, at {place}, at {case}."


def _say_component(result: SpanLoads, found: LargestLoad) -> str:
    """The direction, or the point of the section with its coordinates there."""
    named = result.components(found.quantity)[found.component]
    if found.quantity not in ("strain", "stress"):
        return f"shear, {named}" if found.quantity == "force" and found.component else named
    y, z = 1e3 * result.points[result.station_of(found), found.component]
    second = f", {z:.6g} mm along the second" if result.scene.physics.planes == 2 or z else ""
    return f"{named} of the section, {y:.6g} mm from its centre along the first direction{second}"


def random_loads_table(result: RandomLoads) -> Group:
    """Root mean squares and the largest expected along the span, and the largest of all with its parts."""
    units = result.display_units
    columns = {f"position\n[{_length_unit(result).name}]": _positions(result)}
    for name in ("moment", "strain", "stress"):
        scale, unit = _SCALES[name]
        for k, head in _columns_of_random(result, name):
            rms, error = (scale * each(name) for each in (result.rms, result.rms_error))
            most, most_error = (scale * each(name)[0] for each in (result.values, result.error_of))
            at = np.arange(len(rms))
            columns[f"{head}\nrms [{unit}]"] = _cells(rms[at, k], error[at, k])
            columns[f"{head}\nlargest [{unit}]"] = [
                _expected(*pair) for pair in zip(most[at, k], most_error[at, k], strict=True)
            ]
    title = (
        f"Largest magnitudes expected in {result.duration:g} s by random {result.input} "
        f"at {units.speed_unit().say(result.speed)}, by {said_in(units, result.provenance.method)}"
    )
    known = [name for name in _SCALES if np.isfinite(result.values(name)).any()]
    lines = [Text(_say_expected(result, result.largest(name))) for name in reversed(known)]
    lines += _say_what_strains_need(known)
    rows = [*zip(*columns.values(), strict=True)]
    return Group(table(title, [*columns], rows, ()), *lines, Text(_ESTIMATE))


_ESTIMATE = (
    "Estimates for a Gaussian input; passages of both signs count as independent, with the root mean square "
    "at the angle of rotation at which it is largest, and all parts add up: rather high."
)


def _columns_of_random(result: RandomLoads, name: str) -> list[tuple[np.ndarray, str]]:
    """Component at each station, and head, of each column: of strains the point that is largest there."""
    values = result.values(name)[0]
    if not np.isfinite(values).any():
        return []
    if name == "moment":
        return [(np.full(len(values), k), head) for k, head in enumerate(_heads(result, name))]
    return [(np.nan_to_num(values, nan=-1.0).argmax(axis=1), name)]


def _expected(value: float, error: float = 0.0) -> str:
    """A number of statistics, with three digits and no positive exponent; "0 ± error" if none is sure."""
    text = supported(value, error, _DIGITS_EXPECTED)
    return f"{float(text):.0f}" if "e+" in text and "±" not in text else text


def _say_expected(result: RandomLoads, found: LargestLoad) -> str:
    """The largest of a quantity, what it is the sum of, and what is passed in one case of a hundred."""
    name, (scale, unit) = found.quantity, _SCALES[found.quantity]
    place = result.station_of(found), found.component
    value = _expected(scale * found.value, scale * found.error)
    mean, gravity, rms, quantile = (
        _expected(scale * float(np.abs(each(name)[place])))
        for each in (result.mean, result.gravity, result.rms, result.quantile)
    )
    what, where = _say_component(result, found), _length_unit(result).say(found.x)
    rate = _expected(float(result.crossings(name)[place]))
    return (
        f"Largest {name} expected ({what}): {value} {unit}, at {where}; constant {mean}, gravity {gravity}, "
        f"rms {rms}, upwards through 0 {rate} times a second; with 99 % probability below {quantile}."
    )


def cycles_table(cycles: LoadCycles) -> Group:
    """Cycles by their range, in equal classes up to the largest."""
    scale, unit = _SCALES.get(cycles.quantity, (1.0, "1/m"))
    top = scale * float(cycles.ranges.max(initial=0.0))
    edges = np.linspace(0, top or 1.0, _CLASSES + 1)
    counts, _ = np.histogram(scale * cycles.ranges, edges, weights=cycles.counts)
    rows = [
        (f"{low:.4g} to {high:.4g}", f"{count:g}")
        for low, high, count in zip(edges[:-1], edges[1:], counts, strict=True)
    ]
    place = _length_unit(cycles).say(cycles.x)
    title = f"Cycles of {cycles.quantity} at {place}, {cycles.start:g} to {cycles.end:g} s"
    return table(title, (f"range [{unit}]", "cycles"), rows[::-1], ())


def equivalents_table(equivalents: Sequence[EquivalentRange]) -> Group:
    """Ranges of equal cycles of one quantity that do the damage of those counted, by the Woehler exponent."""
    quantity, number = equivalents[0].quantity, equivalents[0].cycles
    scale, unit = _SCALES.get(quantity, (1.0, "1/m"))
    rows = [
        (f"{each.exponent:g}", supported(scale * each.range, scale * each.error, _MOST_DIGITS))
        for each in equivalents
    ]
    title = f"Damage-equivalent ranges (number of equal cycles: {number:g})"
    return table(title, ("Woehler exponent", f"range of {quantity} [{unit}]"), rows, ())


# CSV ----------------------------------------------------------------------------------------------


def loads_csv(result: SpanLoads) -> Columns:
    """A row a case and station: the place, all loads, strains and stresses, and their errors."""
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


def _places(result: SpanLoads, times: int = 1) -> tuple[Column, Column]:
    """Position and side of each station, some times over."""
    sides = np.where(result.inboard, "inboard", "outboard")
    return Column("position", np.tile(result.x, times), "m"), Column("side", np.tile(sides, times))


def _of_components(result: SpanLoads, part: str, values: np.ndarray) -> Iterator[Column]:
    """A column for each component of all quantities, from values (rows, components)."""
    named = ((name, unit) for name, unit in UNITS.items() for name in _components(result, name))
    for (name, unit), column in zip(named, values.T, strict=True):
        yield Column(f"{part}{name}", column, unit)


def random_loads_csv(result: RandomLoads) -> Columns:
    """A row a station: the place, and of each component the largest expected and what it is made of."""
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


def _components(result: SpanLoads, quantity: str) -> list[str]:
    """Names of the components of a quantity in files."""
    if quantity in ("strain", "stress"):
        return [f"{quantity}_{k + 1}" for k in range(result.points.shape[1])]
    both = result.scene.physics.planes == 2
    words = ("_first", "_second") if quantity == "curvature" else ("_bending", "_across")
    ends = words if both else ("",)
    if quantity == "force":
        return ["axial_force", *(f"shear_force{end}" for end in ends)]
    return [f"{quantity}{end}" for end in ends]
