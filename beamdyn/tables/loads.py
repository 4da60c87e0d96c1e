"""Tables and CSV rows of loads along the span."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from rich.console import Group
from rich.text import Text

from beamdyn.common.digits import supported
from beamdyn.common.edge.tables import table
from beamdyn.equations.directions import words_of_directions

if TYPE_CHECKING:
    from beamdyn.loads.cycles import LoadCycles
    from beamdyn.loads.span_loads import LargestLoad, SpanLoads
    from beamdyn.loads.static_loads import StaticLoads
    from beamdyn.loads.steady_loads import SteadyLoads
    from beamdyn.loads.transient_loads import TransientLoads

_MOST_DIGITS = 7
_CLASSES = 10  # of ranges of cycles
_SCALES = {"strain": (1e6, "1e-6"), "stress": (1e-6, "MPa"), "force": (1.0, "N"), "moment": (1.0, "N m")}


def static_loads_table(result: StaticLoads) -> Group:
    """Loads along the span at each speed."""
    made = (
        _table(result, f"Loads in equilibrium at {speed:.10g} rad/s, by {result.provenance.method}", case)
        for case, speed in enumerate(result.speeds.tolist())
    )
    return Group(*made, *_largest_lines(result))


def steady_loads_table(result: SteadyLoads) -> Group:
    """Largest magnitudes along the span at the speed at which they are largest."""
    case = int(np.nanargmax(result.moment.max(axis=(1, 2)))) if result.response.stable.any() else 0
    at = f"at {result.speeds[case]:.10g} rad/s, where the bending moment is largest"
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
    columns: dict[str, list[str]] = {"position [mm]": _positions(result)}
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


def _positions(result: SpanLoads) -> list[str]:
    """Positions [mm]; those with two sides with the side."""
    x = result.x
    twice = np.isin(np.arange(len(x)), np.flatnonzero(np.diff(x) == 0)) | np.isin(
        np.arange(len(x)), 1 + np.flatnonzero(np.diff(x) == 0)
    )
    sides = ["-" if inboard else "+" for inboard in result.inboard]
    return [f"{1e3 * at:.6g}{side if two else ''}" for at, side, two in zip(x, sides, twice, strict=True)]


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
    return [Text(_say_largest(result, result.largest(name, **given))) for name in reversed(known)]


def _say_largest(result: SpanLoads, found: LargestLoad) -> str:
    scale, unit = _SCALES[found.quantity]
    value = supported(scale * found.value, scale * found.error, _MOST_DIGITS)
    what = result.components(found.quantity)[found.component]
    case = f"{found.case:.6g} {result.case.partition('[')[2].rstrip(']')}"
    return f"Largest {found.quantity} ({what}): {value} {unit}, at {1e3 * found.x:.6g} mm, at {case}."


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
    title = f"Cycles of {cycles.quantity} at {1e3 * cycles.x:.6g} mm, {cycles.start:g} to {cycles.end:g} s"
    return table(title, (f"range [{unit}]", "cycles"), rows[::-1], ())


# CSV ----------------------------------------------------------------------------------------------

_CSV_UNITS = {"force": "_N", "moment": "_N_m", "curvature": "_per_m", "strain": "", "stress": "_Pa"}


def loads_csv(result: SpanLoads) -> Iterator[Sequence[object]]:
    """A row a case and station: the place, all loads, strains and stresses, and their errors."""
    heads = [head for name in _CSV_UNITS for head in _csv_heads(result, name)]
    first = result.case.replace(" [", "_").rstrip("]").replace("/", "_per_")
    yield first, "position_m", "side", *heads, *(f"error_of_{head}" for head in heads)
    values = np.concatenate([result.values(name) for name in _CSV_UNITS], axis=-1)
    errors = np.concatenate([result.error_of(name) for name in _CSV_UNITS], axis=-1)
    errors = np.broadcast_to(errors, values.shape)
    sides = ["inboard" if inboard else "outboard" for inboard in result.inboard]
    for case, of_case, error in zip(result.cases.tolist(), values, errors, strict=True):
        for x, side, row, more in zip(
            result.x.tolist(), sides, of_case.tolist(), error.tolist(), strict=True
        ):
            yield case, x, side, *row, *more


def _csv_heads(result: SpanLoads, quantity: str) -> list[str]:
    unit = _CSV_UNITS[quantity]
    if quantity in ("strain", "stress"):
        return [f"{quantity}_{k + 1}{unit}" for k in range(result.points.shape[1])]
    both = result.scene.physics.planes == 2
    words = ("_first", "_second") if quantity == "curvature" else ("_bending", "_across")
    ends = words if both else ("",)
    if quantity == "force":
        return [f"axial_force{unit}", *(f"shear_force{end}{unit}" for end in ends)]
    return [f"{quantity}{end}{unit}" for end in ends]
