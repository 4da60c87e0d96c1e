"""Results as rows of CSV files, in full, with their heads; each with its model error."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from beamdyn.tables.results import largest_by_direction, model_error_at

if TYPE_CHECKING:
    from beamdyn.scene.scene import Scene
    from beamdyn.spectrum.locus import Locus
    from beamdyn.spectrum.modes import Modes
    from beamdyn.steady.crossings import Crossings
    from beamdyn.steady.response import SteadyResponse
    from beamdyn.transient.sweep import Sweep
    from beamdyn.transient.transient import Transient

_WHERE_COMPUTED = "model_error_where_computed"


def _model_error_of(result: SteadyResponse | Sweep) -> np.ndarray:
    """Model error at each speed (S,); nan where it is not computed."""
    at = np.isin(result.speeds, result.left_out_speeds)
    found = np.full(len(result.speeds), np.nan)
    found[at] = result.model_error if at.any() else np.nan
    return found


def _directions_of_csv(scene: Scene) -> tuple[str, ...]:
    """What heads say of the two directions, at any bending angle; nothing where one plane is modelled."""
    return ("bending", "across") if scene.physics.planes == 2 else ()


def modes_csv(result: Modes) -> Iterator[Sequence[object]]:
    """Frequency, errors, growth rate and status of each mode; of two planes the share of each."""
    names, shares = _share_columns(result)
    errors = "relative_error", "model_error"
    yield "mode", "speed_rad_per_s", "frequency_Hz", *errors, "growth_rate_per_s", "status", *names
    error = result.error, result.model_error
    columns = result.frequency, *error, result.growth_rate, result.status, *shares
    for mode, row in enumerate(zip(*(column.tolist() for column in columns), strict=True), 1):
        yield mode, result.speed, *row


def _share_columns(result: Modes | Locus) -> tuple[list[str], list[np.ndarray]]:
    """Names and values of the shares of the two directions of bending; none where one plane is modelled."""
    names = [f"share_{direction}" for direction in _directions_of_csv(result.scene)]
    return names, [result.plane_share[..., direction] for direction in range(len(names))]


def locus_csv(result: Locus) -> Iterator[Sequence[object]]:
    """Frequency, errors, growth rate, status, confidence, shares of planes of each mode, a row a speed."""
    names = ("frequency_Hz", "relative_error", "model_error", "growth_rate_per_s", "status", "confidence")
    errors = result.error, model_error_at(result, np.arange(len(result.speeds)))
    columns = [result.frequency, *errors, result.growth_rate, result.status, result.confidence]
    further, shares = _share_columns(result)
    names, columns = (*names, *further), [*columns, *shares]
    numbers = range(1, result.frequency.shape[1] + 1)
    yield "speed_rad_per_s", *(f"{name}_{mode}" for name in names for mode in numbers)
    for speed, *rows in zip(result.speeds.tolist(), *(column.tolist() for column in columns), strict=True):
        yield speed, *(value for row in rows for value in row)


def transient_csv(run: Transient) -> Iterator[Sequence[object]]:
    """Tip deflection over time, in both directions where two are modelled, and the largest's model error."""
    names = [f"tip_deflection_{direction}_m" for direction in _directions_of_csv(run.scene)]
    yield "time_s", *(names or ["tip_deflection_m"]), "model_error_of_largest"
    error = np.full(len(run.t), float(f"{float(run.model_error):.2g}"))
    columns = run.t, *(run.tip, run.tip_across)[: run.scene.physics.planes], error
    yield from zip(*(column.tolist() for column in columns), strict=True)


def sweep_csv(result: Sweep) -> Iterator[Sequence[object]]:
    """Largest deflection, where two directions are modelled also in each, and its errors."""
    names = [f"largest_{direction}_m" for direction in _directions_of_csv(result.scene)]
    yield "speed_rad_per_s", "largest_deflection_m", *names, "time_error_m", "mode_error_m", _WHERE_COMPUTED
    each = result.peaks_by_direction.T if names else ()
    errors = result.time_error, result.peak_error - result.time_error, _model_error_of(result)
    columns = result.speeds, result.peaks, *each, *errors
    yield from zip(*(column.tolist() for column in columns), strict=True)


def crossings_csv(result: Crossings) -> Iterator[Sequence[object]]:
    """Resonance speeds, one row each, with the plane of each mode where two are modelled."""
    first = "speed_rad_per_s", "relative_error", "model_error", "frequency_Hz"
    directions = _directions_of_csv(result.scene)
    shares = [f"{mode}share_{direction}" for mode in ("", "second_") for direction in directions]
    yield *first, "line", "multiple", "mode", "second_mode", "kind", *shares
    for c, model_error in zip(result, np.atleast_1d(result.model_error).tolist(), strict=False):
        second = "" if c.second_mode is None else c.second_mode
        values = *c.plane_share, *(c.second_plane_share or ("", ""))
        row = c.speed, c.error, model_error, c.frequency, c.line.name, c.line.multiple, c.mode, second, c.kind
        yield *row, *values[: len(shares)]


def steady_csv(result: SteadyResponse) -> Iterator[Sequence[object]]:
    """Steady amplitude, also by direction where two are modelled, growth rate, errors, status over speed."""
    growth = "growth_rate_per_s", "growth_rate_error_per_s"
    by_direction = largest_by_direction(result)
    largest = [f"largest_{direction}_m" for direction in _directions_of_csv(result.scene)]
    heads = "amplitude_m", *largest, "sum_of_lines_m"
    yield "speed_rad_per_s", *heads, "relative_error", _WHERE_COMPUTED, *growth, "status"
    errors = result.error, _model_error_of(result)
    sizes = result.speeds, result.amplitude, *by_direction, result.bound, *errors
    columns = *sizes, result.growth_rate, result.growth_rate_error, result.status
    yield from zip(*(column.tolist() for column in columns), strict=True)
