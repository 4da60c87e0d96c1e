"""Tables of results: for reading, with the digits that the error supports, and for CSV files in full."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from rich.console import Group
from rich.text import Text

from beamdyn.common.edge.file_words import as_in_files
from beamdyn.common.edge.tables import set_apart, table
from beamdyn.common.results.digits import supported, supported_or_range
from beamdyn.common.results.statements import OUTSIDE, of_kind, said_in
from beamdyn.equations.directions import (
    first_drawn,
    modelled_directions,
    words_of_directions,
)
from beamdyn.modes.model_error.left_out_effects import where_worst

if TYPE_CHECKING:
    from beamdyn.common.results.display_units import ShownUnit
    from beamdyn.common.results.result import Result
    from beamdyn.modes.critical import CriticalPoint
    from beamdyn.modes.locus import Locus
    from beamdyn.modes.model_error.left_out_effects import LeftOutEffects
    from beamdyn.modes.modes import Modes
    from beamdyn.modes.setting_angles import SettingAngleLimits
    from beamdyn.scene.scene import Scene
    from beamdyn.steady.crossings import Crossing, Crossings
    from beamdyn.steady.response import SteadyResponse
    from beamdyn.transient.sweep import Sweep
    from beamdyn.transient.transient import Transient

_MOST_ROWS = 16  # of a printed table, besides peaks and changes of status
Cell: TypeAlias = "str | Text"  # of a table
_ROUNDING = 1e-9  # relative: a model error below it is not told from rounding
_WIDTH = 119  # of a table's columns, so that none is cut at 120
_CRITICAL_DIGITS = 12  # most digits of a critical speed
_FEW = 4  # modes of a locus whose frequencies have all digits
_DIGITS, _DIGITS_OF_MANY = 10, 7  # most digits of a frequency of few modes, and of more


def modes_table(result: Modes) -> Group:
    """Table of natural modes, and what the model leaves out; digits beyond the model error are dimmed."""
    rows = []
    size = np.abs(result.eigenvalue) * result.error  # absolute error of the eigenvalues
    model_error = result.model_error
    for i, status in enumerate(result.status):
        frequency = supported_or_range(result.frequency[i], size[i] / (2 * np.pi)).replace("none", "-")
        frequency = set_apart(frequency, model_error[i] * abs(result.frequency[i]))
        growth = "0" if result.growth_rate[i] == 0 else supported(result.growth_rate[i], size[i])
        shares = _share_cells(result.scene, result.plane_share[i])
        errors = f"{result.error[i]:.0e}", _model_error_cell(result.left_out_effects, i)
        rows.append((str(i + 1), frequency, *errors, growth, *shares, str(status)))
    title = f"Natural modes at {_speed_unit(result).say(result.speed, 10)}, by {result.provenance.method}"
    heads = (
        "mode",
        "frequency [Hz]",
        "relative error",
        "model error",
        "growth rate [1/s]",
        *_share_heads(result.scene),
        "status",
    )
    shown = table(title, heads, rows, (len(heads) - 1,))
    return Group(shown, _model_line(result, result.left_out_effects.sentence()))


def _model_line(result: Result, sentence: str) -> Text:
    """The line on the model below a table."""
    return Text(as_in_files(said_in(result.display_units, sentence)))


def _speed_unit(result: Result) -> ShownUnit:
    """Unit in which the speeds of a result are shown."""
    return result.display_units.speed_unit()


def _model_error_cell(effects: LeftOutEffects, mode: int) -> str:
    """Relative model error of a mode with one digit; with a question mark where the beam lacks data."""
    return _say_model_error(float(effects.total[mode]), effects.lack_data)


def _say_model_error(size: float, lacks_data: bool) -> str:
    more = " + ?" if lacks_data else ""
    return "not known" if math.isnan(size) else f"{size if size >= _ROUNDING else 0.0:.0e}{more}"


def _share_heads(scene: Scene) -> list[str]:
    """Head of the column of the shares of a plane; none where one plane is modelled."""
    words = words_of_directions(scene)
    return [f"share of {words[first_drawn(scene)]}"] if words else []


def _share_cells(scene: Scene, share: np.ndarray) -> list[str]:
    """Share of a mode's energy in the direction that `_share_heads` names."""
    return [] if scene.physics.planes == 1 else [f"{share[first_drawn(scene)]:.3f}"]


def locus_table(result: Locus) -> Group:
    """Table of a locus at some of its speeds: frequencies, or growth rates of unstable modes.

    Below it stands what the model leaves out; digits beyond the model error are dimmed, and the largest one
    stands beside them where that takes no further table.
    """
    size, shown = np.abs(result.eigenvalue) * result.error, _select_speeds(result)
    beyond = model_error_at(result, shown) * np.abs(result.frequency[shown])
    modes = {
        f"mode {mode + 1} [Hz]": [
            _locus_cell(result, size, s, mode, error) for s, error in zip(shown, beyond[:, mode], strict=True)
        ]
        for mode in range(result.frequency.shape[1])
    }
    speeds = {_speed_head(result): _speed_cells(result, result.speeds[shown])}
    quality = {
        "largest error": [f"{result.error[s].max():.0e}" for s in shown],
        "tracking": [f"{result.confidence[s].min():.2f}" for s in shown],
    }
    title = (
        f"Natural frequencies{_direction_note(result.scene)}, by {result.provenance.method}"
        f"{_selection_note(shown, result.speeds)}"
    )
    width, of_model = (
        _WIDTH - _column_width(*speeds.items()),
        {"model error": _model_error_cells(result, shown)},
    )
    packed = _blocks(modes | quality, width)
    wider = _blocks(modes | of_model | quality, width)
    blocks = [speeds | block for block in (packed if len(wider) > len(packed) else wider)]
    tables = (zip(*block.values(), strict=True) for block in blocks)
    titles = (title, *["The same speeds, further columns"] * (len(blocks) - 1))
    made = (table(t, [*b], rows, ()) for t, b, rows in zip(titles, blocks, tables, strict=True))
    return Group(*made, _left_out_over_speeds(result, "mode"))


def _model_error_cells(result: Locus, indices: np.ndarray) -> list[str]:
    """Largest relative model error of the modes that vibrate, at speeds of some indices, with one digit."""
    error, lacks = model_error_at(result, indices), result.left_out_effects.lack_data
    vibrating = np.isin(result.status[indices], ("stable", "neutral"))
    each = (known[counts] for known, counts in zip(error, vibrating, strict=True))
    return [_say_model_error(float(sizes.max()), lacks) if len(sizes) else "-" for sizes in each]


def _left_out_over_speeds(result: Locus | SteadyResponse | Sweep, what: str = "") -> Text:
    """The line on the model below a table over speeds, with the place of each effect."""
    effects, speeds = result.left_out_effects, result.left_out_speeds
    return _model_line(result, effects.sentence(what, where_worst(effects, speeds), speeds))


def model_error_at(result: Locus, indices: np.ndarray) -> np.ndarray:
    """Model error (k, m) at speeds of some indices, linear between those where it is computed."""
    each = (between_speeds(result, error)[indices] for error in result.model_error.T)
    return np.stack([*each], axis=1)


def between_speeds(result: Locus | SteadyResponse | Sweep, error: np.ndarray) -> np.ndarray:
    """Model errors (S,) at all speeds, from those (k,) where they are computed; the nearest outside these."""
    known = result.left_out_speeds
    return np.interp(result.speeds, known, error) if len(known) else np.full(len(result.speeds), np.nan)


def _blocks(columns: Mapping[str, Sequence[Cell]], width: int) -> list[dict[str, Sequence[Cell]]]:
    """Pack columns, in their order, into as few tables of at most a width as will do."""
    blocks, left = [], -1
    for column in columns.items():
        left -= _column_width(column)
        if left < 0:
            blocks.append({})
            left = width - _column_width(column)
        blocks[-1] |= [column]
    return blocks


def _column_width(column: tuple[str, Sequence[Cell]]) -> int:
    """Width of a column with its padding and the gap after it."""
    return max(map(len, (column[0], *column[1]))) + 3


def _select_speeds(result: Locus) -> np.ndarray:
    """Select indices of speeds to print: evenly spread, and before and after each change of status."""
    count = len(result.speeds)
    spread = np.linspace(0, count - 1, min(count, _MOST_ROWS)).round().astype(int)
    change = np.flatnonzero((result.status[1:] != result.status[:-1]).any(axis=1))[:_MOST_ROWS]
    return np.unique(np.concatenate([spread, change, change + 1]))


def _locus_cell(result: Locus, size: np.ndarray, s: int, mode: int, model_error: float) -> Cell:
    """Frequency of a mode at speed s, or its status and growth rate.

    The absolute errors are `size` [rad/s] and that of the model [Hz].
    """
    if result.status[s, mode] not in ("stable", "neutral"):
        return f"{result.status[s, mode]}, {result.growth_rate[s, mode]:+.3g} 1/s"
    digits = _DIGITS if result.frequency.shape[1] <= _FEW else _DIGITS_OF_MANY
    frequency = supported_or_range(result.frequency[s, mode], size[s, mode] / (2 * np.pi), digits)
    cells = set_apart(frequency, model_error), *_direction_cells(result.scene, result.plane_share[s, mode])
    return Text(" ").join(map(_as_text, cells))


def _as_text(cell: Cell) -> Text:
    return cell if isinstance(cell, Text) else Text(cell)


def _direction_cells(scene: Scene, share: np.ndarray) -> list[str]:
    """Letter of the direction in which a mode mostly bends; none where one plane is modelled."""
    return [word[0] for word in words_of_directions(scene)[int(share.argmax()) :][:1]]


def _direction_note(scene: Scene) -> str:
    """What the letters beside frequencies mean; empty where one plane is modelled."""
    words = words_of_directions(scene)
    note = "; ".join(f"{word[0]}: mostly {word}" for word in words)
    return f" ({note})" if words else ""


def limits_table(result: SettingAngleLimits) -> Group:
    """Table of setting-angle limits."""
    degrees = [supported(float(np.degrees(limit)), float(np.degrees(result.error))) for limit in result]
    meaning = (
        "below it the first frequency falls with speed; above it, it rises from rest",
        "below it the first frequency falls before the top speed; above it, it rises",
    )
    top = _speed_unit(result).say(result.top_speed, 10)
    title = f"Setting-angle limits up to {top}, by {result.provenance.method}"
    rows = zip(("first", "second"), degrees, meaning, strict=True)
    return table(title, ("limit", "angle [deg]", ""), rows, (0, 2))


def critical_answer(result: CriticalPoint) -> Group:
    """The sentence on the critical speed, or how far it was looked where none was found, and on the model."""
    return Group(_describe_critical(result), _model_line(result, result.left_out_effects.sentence("")))


def _describe_critical(result: CriticalPoint) -> Text:
    unit = _speed_unit(result)
    if not math.isinf(result.speed):
        if not result.speed:
            return Text(
                f"critical speed: 0 {unit.name}; the beam is unstable at every speed: {result.reason}"
            )
        speed = unit.of(result.speed)
        value = supported_or_range(speed, result.error * speed, _CRITICAL_DIGITS)
        shown = set_apart(value, float(result.model_error) * speed)
        straight = of_kind(result.warnings, OUTSIDE)
        which = "a straight beam would buckle" if straight else "the beam buckles"
        return Text.assemble("critical speed: ", shown, f" {unit.name}; above it {which}: {result.reason}")
    if math.isinf(result.none_below):
        return Text(f"no critical speed: {as_in_files(result.reason)}")
    bound = unit.say(result.none_below, 4)
    if not result.error:
        return Text(f"no critical speed below {bound}: {result.reason}")
    return Text(f"no critical speed found; there is certainly none below {bound}")


# Motion in time and resonance -------------------------------------------------------------------------

_MODEL_DIGITS = 6  # most digits of a deflection, which the modal truncation error allows
_ASSUMED_ERROR = 5e-4  # relative error assumed for the digits of a deflection whose error is not estimated


def transient_table(run: Transient, window: tuple[float, float] | None = None) -> Group:
    """Table of a transient: its largest deflections and errors, and what the model leaves out."""
    start, end = run.path.start, run.path.end
    windows = {"whole run": (start, end)}
    if window is not None:
        windows[f"{window[0]:g} to {window[1]:g} s"] = window
    rows = [
        (f"{name}{which}", *_peak_cells(run, *bounds, direction))
        for name, bounds in windows.items()
        for which, direction in _directions(run.scene)
    ]
    shown = table(
        f"Largest tip deflection in {end:g} s, by {run.provenance.method}",
        ("", f"tip deflection [{_length_unit(run).name}]", "over the length", "at [s]"),
        rows,
    )
    left_out = _model_line(run, run.left_out_effects.sentence("", "of the largest deflection"))
    return Group(shown, Text(_describe_errors(run)), left_out)


def _directions(scene: Scene) -> list[tuple[str, int | None]]:
    """What is said of a deflection, its magnitude and where there are two its components, and which it is."""
    names = modelled_directions(scene)
    return [("", None), *((f", {name}", i) for i, name in enumerate(names) if len(names) > 1)]


def time_of_peak(
    run: Transient, start: float, end: float, direction: int | None = None
) -> tuple[float, float]:
    """Time of the largest tip deflection in a window, and its uncertainty, the sampling interval [s].

    The direction is as for `Transient.peak`.
    """
    inside = np.flatnonzero((run.t >= start) & (run.t <= end))
    if len(inside) < 2:
        return (start + end) / 2, (end - start) / 2
    size = np.hypot(run.tip, run.tip_across) if direction is None else (run.tip, run.tip_across)[direction]
    index = inside[np.abs(size[inside]).argmax()]
    return float(run.t[index]), float(np.diff(run.t[inside]).max())


def _peak_cells(run: Transient, start: float, end: float, direction: int | None) -> tuple[Text, Text, str]:
    """Largest tip deflection in a window, over the length, and its time [s]."""
    size, length = run.peak(start, end, direction), run.scene.beam.length
    error = _ASSUMED_ERROR * size if math.isnan(run.time_error) else run.time_error
    error += run.mode_error * run.largest if math.isfinite(run.mode_error) else 0.0
    beyond = float(run.model_error) * size
    deflection, ratio = (
        set_apart(supported(size * f, error * f, _MODEL_DIGITS), beyond * f)
        for f in (_length_unit(run).per_si, 1 / length)
    )
    return deflection, ratio, supported(*time_of_peak(run, start, end, direction)) if size else "-"


def _describe_errors(run: Transient) -> str:
    """Describe the time-integration error and the modal truncation error in words."""
    known, unit = math.isfinite(run.mode_error), _length_unit(run)
    size = unit.say(run.mode_error * run.largest, 1) if known else "unknown"
    modes = f"modal truncation error {size}"
    if math.isnan(run.time_error):
        return (
            "The time-integration error is not estimated: this integrator bounds that of single steps only. "
            f"Estimated {modes}."
        )
    return f"Estimated time-integration error {unit.say(run.time_error, 1)}, {modes}."


def crossings_table(result: Crossings) -> Group:
    """Table of resonance speeds, with the plane of each mode where two are modelled."""
    unit = _speed_unit(result)
    rows = [
        (
            set_apart(supported(unit.of(c.speed), c.error * unit.of(c.speed)), beyond * unit.of(c.speed)),
            f"{c.line.name}: {c.line.multiple:.6g} times the speed",
            str(c.mode) if c.second_mode is None else f"{c.mode} and {c.second_mode}",
            *_plane_cells(result, c),
            set_apart(supported(c.frequency, c.error * c.frequency), beyond * c.frequency),
            c.kind,
        )
        for c, beyond in zip(result, np.atleast_1d(result.model_error).tolist(), strict=False)
    ]
    number = f"{len(rows) or 'No'} resonance speed{'s' * (len(rows) != 1)}"
    title = f"{number}, by {result.provenance.method}. {said_in(result.display_units, result.extent)}"
    plane = [f"{', '.join(words)} [%]"] if (words := words_of_directions(result.scene)) else []
    heads = (_speed_head(result), "line", "mode", *plane, "frequency [Hz]", "kind")
    shown = table(title, heads, rows, (1, len(heads) - 1))
    return Group(
        shown, _model_line(result, result.left_out_effects.sentence("resonance" if len(rows) > 1 else ""))
    )


def _plane_cells(result: Crossings, crossing: Crossing) -> Iterator[str]:
    """Share of the energy of each mode in the two directions, where two are modelled."""
    if result.scene.physics.planes == 2:
        shares = [s for s in (crossing.plane_share, crossing.second_plane_share) if s is not None]
        yield " and ".join(f"{100 * bending:.0f}, {100 * across:.0f}" for bending, across in shares)


def steady_table(result: SteadyResponse) -> Group:
    """Table of a steady response at some of its speeds, the peaks included."""
    with np.errstate(divide="ignore"):
        peaks_at = peaks(np.log(result.amplitude), np.log(3))
    shown = _select_response_speeds(result.status, peaks_at)
    error = result.error * result.bound
    names, by_direction = words_of_directions(result.scene), largest_by_direction(result)
    sizes = result.amplitude, *by_direction, result.bound
    beyond = between_speeds(result, result.model_error)
    cells = [_length_cells(result, values, error, beyond) for values in sizes]
    columns = [_speed_cells(result, result.speeds), *cells, _status_cells(result.status, peaks_at)]
    title = f"Steady response, by harmonic balance with {result.provenance.method}"
    sizes = _length_heads(result, ("largest tip deflection", *names, "sum of the lines"))
    heads = (_speed_head(result), *sizes, "status")
    made = table(
        title + _selection_note(shown, result.speeds), heads, _rows(columns, shown), (len(heads) - 1,)
    )
    return Group(made, _left_out_over_speeds(result))


def largest_by_direction(result: SteadyResponse) -> list[np.ndarray]:
    """Largest tip deflection in the direction of bending and across, where both are modelled."""
    return [result.largest_tip(direction) for direction in range(len(words_of_directions(result.scene)))]


def sweep_table(result: Sweep) -> Group:
    """Table of a sweep at some of its speeds, the peaks included."""
    peaks_at = sweep_peaks(result)
    shown = _select_response_speeds(np.array(result.status), peaks_at)
    words, drawn = words_of_directions(result.scene), sweep_lines(result)
    beyond = between_speeds(result, result.model_error)
    sizes = [_length_cells(result, values, result.peak_error, beyond) for values in drawn.values()]
    columns = [_speed_cells(result, result.speeds), *sizes, _status_cells(result.status, peaks_at)]
    start, end = result.window
    title = f"Largest tip deflection in {start:g} to {end:g} s, by {result.provenance.method}"
    heads = (_speed_head(result), *_length_heads(result, ("largest tip deflection", *words)), "status")
    rows = _rows(columns, shown)
    made = table(title + _selection_note(shown, result.speeds), heads, rows, (len(heads) - 1,))
    return Group(made, _left_out_over_speeds(result))


def sweep_lines(result: Sweep) -> dict[str, np.ndarray]:
    """Largest tip deflections of a sweep, and where there are two directions those in each, by name."""
    each = zip(modelled_directions(result.scene), result.peaks_by_direction.T, strict=True)
    lines = {"largest tip deflection": result.peaks}
    return lines | (dict(each) if result.scene.physics.planes == 2 else {})


def sweep_peaks(result: Sweep) -> np.ndarray:
    """Find the indices of the peaks of a sweep, more prominent than a quarter of its largest deflection."""
    return peaks(result.peaks, 0.25 * np.nanmax(result.peaks, initial=0.0))


def _length_unit(result: Result) -> ShownUnit:
    """Unit in which the deflections of a result are shown."""
    return result.display_units.length_unit()


def _speed_head(result: Result) -> str:
    return f"speed [{_speed_unit(result).name}]"


def _speed_cells(result: Result, speeds: np.ndarray) -> list[str]:
    return [f"{speed:.8g}" for speed in _speed_unit(result).of(speeds)]


def _length_heads(result: Result, names: Iterable[str]) -> list[str]:
    return [f"{name} [{_length_unit(result).name}]" for name in names]


def _length_cells(
    result: Result, values: np.ndarray, error: np.ndarray, model_error: np.ndarray
) -> list[Text]:
    """Deflections [m], digits beyond the model error (relative) dimmed."""
    unit = _length_unit(result)
    each = zip(unit.of(values).tolist(), unit.of(error).tolist(), model_error.tolist(), strict=True)
    return [set_apart(supported(v, e, _MODEL_DIGITS), beyond * abs(v)) for v, e, beyond in each]


def _status_cells(status: Iterable[str], peaks_at: np.ndarray) -> list[str]:
    high = set(peaks_at.tolist())
    return [f"{s}, peak" if i in high else str(s) for i, s in enumerate(status)]


def _rows(columns: Sequence[Sequence[Cell]], shown: np.ndarray) -> Iterator[list[Cell]]:
    return ([column[s] for column in columns] for s in shown)


def _select_response_speeds(status: np.ndarray, peaks_at: np.ndarray) -> np.ndarray:
    """Select indices of speeds to print: evenly spread, the peaks, and at changes of status."""
    spread = np.linspace(0, len(status) - 1, min(len(status), _MOST_ROWS)).round().astype(int)
    change = np.flatnonzero(status[1:] != status[:-1])[:_MOST_ROWS]
    return np.unique(np.concatenate([spread, peaks_at[:_MOST_ROWS], change, change + 1]))


def peaks(values: np.ndarray, prominence: float) -> np.ndarray:
    """Find the indices of local maxima of at least a prominence; values that are not finite are skipped."""
    from scipy.signal import find_peaks

    known = np.flatnonzero(np.isfinite(values))
    return known[find_peaks(values[known], prominence=prominence)[0]]


def _selection_note(shown: np.ndarray, all_: np.ndarray) -> str:
    if len(shown) == len(all_):
        return ""
    return f" ({len(shown)} of {len(all_)} speeds; CSV and JSON have all)"
