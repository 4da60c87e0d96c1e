"""Results as rows of CSV files, in full, with their heads; each with its model error."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from beamdyn.common.results.columns import Column, Columns, columns_of_rows
from beamdyn.results.tables.results import largest_by_direction, model_error_at

if TYPE_CHECKING:
    from beamdyn.modes.locus import Locus
    from beamdyn.modes.modes import Modes
    from beamdyn.scene.scene import Scene
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


def modes_csv(result: Modes) -> Columns:
    """Frequency, errors, growth rate and status of each mode; of two planes the share of each."""
    count = len(result.frequency)
    return Columns(
        Column("mode", np.arange(1, count + 1)),
        Column("speed", [result.speed] * count, "rad/s"),
        Column("frequency", result.frequency, "Hz"),
        Column("relative_error", result.error),
        Column("model_error", result.model_error),
        Column("growth_rate", result.growth_rate, "1/s"),
        Column("status", result.status),
        *(Column(name, share) for name, share in _shares(result).items()),
    )


def _shares(result: Modes | Locus) -> dict[str, np.ndarray]:
    """Shares of the two directions of bending by name; none where one plane is modelled."""
    each = enumerate(_directions_of_csv(result.scene))
    return {f"share_{direction}": result.plane_share[..., k] for k, direction in each}


def locus_csv(result: Locus) -> Columns:
    """Frequency, errors, growth rate, status, confidence, shares of planes of each mode, a row a speed."""
    of_modes = {
        ("frequency", "Hz"): result.frequency,
        ("relative_error", ""): result.error,
        ("model_error", ""): model_error_at(result, np.arange(len(result.speeds))),
        ("growth_rate", "1/s"): result.growth_rate,
        ("status", ""): result.status,
        ("confidence", ""): result.confidence,
        **{(name, ""): share for name, share in _shares(result).items()},
    }
    each = (
        Column(name, values, unit, mode)
        for (name, unit), of_all in of_modes.items()
        for mode, values in enumerate(of_all.T, 1)
    )
    return Columns(Column("speed", result.speeds, "rad/s"), *each)


def transient_csv(run: Transient) -> Columns:
    """Tip deflection over time, in both directions where two are modelled, and the largest's model error."""
    names = [f"tip_deflection_{direction}" for direction in _directions_of_csv(run.scene)]
    tips = zip(names or ["tip_deflection"], (run.tip, run.tip_across), strict=False)
    error = np.full(len(run.t), float(f"{float(run.model_error):.2g}"))
    return Columns(
        Column("time", run.t, "s"),
        *(Column(name, tip, "m") for name, tip in tips),
        Column("model_error_of_largest", error),
    )


def sweep_csv(result: Sweep) -> Columns:
    """Largest deflection, where two directions are modelled also in each, and its errors."""
    each = zip(_directions_of_csv(result.scene), result.peaks_by_direction.T, strict=False)
    return Columns(
        Column("speed", result.speeds, "rad/s"),
        Column("largest_deflection", result.peaks, "m"),
        *(Column(f"largest_{direction}", peaks, "m") for direction, peaks in each),
        Column("time_error", result.time_error, "m"),
        Column("mode_error", result.peak_error - result.time_error, "m"),
        Column(_WHERE_COMPUTED, _model_error_of(result)),
    )


def crossings_csv(result: Crossings) -> Columns:
    """Resonance speeds, one row each, with the plane of each mode where two are modelled."""
    directions = _directions_of_csv(result.scene)
    shares = [f"{mode}share_{direction}" for mode in ("", "second_") for direction in directions]
    rows = []
    for c, model_error in zip(result, np.atleast_1d(result.model_error).tolist(), strict=False):
        second = "" if c.second_mode is None else c.second_mode
        values = *c.plane_share, *(c.second_plane_share or ("", ""))
        row = c.speed, c.error, model_error, c.frequency, c.line.name, c.line.multiple, c.mode, second, c.kind
        rows.append((*row, *values[: len(shares)]))
    first = ("speed", "rad/s"), "relative_error", "model_error", ("frequency", "Hz")
    return columns_of_rows((*first, "line", "multiple", "mode", "second_mode", "kind", *shares), rows)


def steady_csv(result: SteadyResponse) -> Columns:
    """Steady amplitude, also by direction where two are modelled, growth rate, errors, status over speed."""
    each = zip(_directions_of_csv(result.scene), largest_by_direction(result), strict=True)
    return Columns(
        Column("speed", result.speeds, "rad/s"),
        Column("amplitude", result.amplitude, "m"),
        *(Column(f"largest_{direction}", size, "m") for direction, size in each),
        Column("sum_of_lines", result.bound, "m"),
        Column("relative_error", result.error),
        Column(_WHERE_COMPUTED, _model_error_of(result)),
        Column("growth_rate", result.growth_rate, "1/s"),
        Column("growth_rate_error", result.growth_rate_error, "1/s"),
        Column("status", result.status),
    )
