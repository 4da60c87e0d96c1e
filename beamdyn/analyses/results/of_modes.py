"""Natural modes, critical speeds, equilibria, terms and the rotor, as tables and as columns of files."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TypeAlias

import numpy as np
from rich.console import Group
from rich.text import Text

import beamdyn as bd
from beamdyn.common.edge.console import set_apart, table, table_of
from beamdyn.common.edge.file_words import in_files
from beamdyn.common.edge.views import View
from beamdyn.common.results.columns import Column, Columns, columns_of_rows, evenly_spread
from beamdyn.common.results.result import Result
from beamdyn.common.results.statements import OUTSIDE, of_kind
from beamdyn.common.words import lower_bound, supported, supported_or_range, upper_bound
from beamdyn.equations.effects import first_drawn, words_of_directions
from beamdyn.modes.modal.model import BENDING
from beamdyn.modes.model_error.left_out_effects import where_worst

Cell: TypeAlias = "str | Text"  # type of a table cell: plain or styled text
# Largest number of evenly spaced rows of a printed table; rows of peaks and changes of status are added.
_MOST_ROWS = 16
_ROUNDING = 1e-9  # relative model error below which it counts as a rounding error
_CRITICAL_DIGITS = 12  # largest number of digits of a critical speed
_FEW = (
    4  # largest number of modes with which a table over speed shows frequencies with up to `_DIGITS` digits
)
# Largest number of digits of a frequency in a table over speed: with at most `_FEW` modes, and with more.
_DIGITS, _DIGITS_OF_MANY = 10, 7
_AXES = "b1", "b2", "b3"  # axes along the beam at rest, in the bending direction, and across


# Parts that tables of several kinds share -------------------------------------------------------------


def said_of_model(result: Result, sentence: str) -> str:
    """Reword a sentence on the model of a result: with input names as in files, and the result's units."""
    return in_files(sentence, result.display_units)


def said_over_speeds(result: bd.Locus | bd.SteadyResponse | bd.Sweep, what: str = "") -> str:
    """Return the sentence below a table over speeds: the largest changes that neglected effects may cause.

    `what` is a noun for several values at one speed, such as "mode"; empty if there is one value.
    """
    effects, speeds = result.left_out_effects, result.left_out_speeds
    return said_of_model(result, effects.sentence(what, where_worst(effects, speeds), speeds))


def between_speeds(result: bd.Locus | bd.SteadyResponse | bd.Sweep, error: np.ndarray) -> np.ndarray:
    """Interpolate model errors at a few speeds to all speeds; outside their range, use the nearest value."""
    known = result.left_out_speeds
    return np.interp(result.speeds, known, error) if len(known) else np.full(len(result.speeds), np.nan)


def rows_worth_showing(status: np.ndarray, *more: np.ndarray) -> np.ndarray:
    """Return indices of rows to print: evenly spaced rows, given rows, and both sides of status changes."""
    spread = evenly_spread(len(status), _MOST_ROWS)
    changed = status[1:] != status[:-1]
    change = np.flatnonzero(changed if status.ndim == 1 else changed.any(axis=1))[:_MOST_ROWS]
    return np.unique(np.concatenate([spread, *(each[:_MOST_ROWS] for each in more), change, change + 1]))


def selection_note(shown: np.ndarray, every: np.ndarray) -> str:
    """Return the note on how many of all speeds (`every`) a table has rows for; empty if for all."""
    few = len(shown) < len(every)
    return f" ({len(shown)} of {len(every)} speeds; CSV and JSON have all)" if few else ""


def csv_directions(scene: bd.Scene) -> tuple[str, ...]:
    """Return names of the two directions for column headings; empty if only one direction is modelled."""
    return ("bending", "across") if scene.physics.planes == 2 else ()


# Modes ------------------------------------------------------------------------------------------------


def modes_columns(result: bd.Modes) -> Columns:
    """Make columns of the modes: frequency, errors, growth rate, status, and how each deforms the beam."""
    # `size` is the absolute error of each eigenvalue [rad/s], and so of the growth rate [1/s].
    size, rate = np.abs(result.eigenvalue) * result.error, result.growth_rate
    count, effects = len(size), result.left_out_effects
    model_errors = [_say_model_error(float(each), effects.lack_data) for each in effects.total]
    beyond = result.model_error * np.abs(result.frequency)
    at = result.display_units.speed_unit().say(result.speed, 10)
    return Columns(
        Column("mode", range(1, count + 1)),
        Column("speed", [result.speed] * count, "rad/s", words=None),
        Column("frequency", result.frequency, "Hz", "", size / (2 * np.pi), beyond, _say_frequency),
        Column("relative_error", result.error, form=".0e"),
        Column("model_error", result.model_error, cells=model_errors),
        Column("growth_rate", rate, "1/s", error=np.where(rate == 0, 0.0, size)),
        Column("status", result.status),
        *_kinds(result),
        title=f"Natural modes at {at}{_circuit(result)}, by {result.provenance.method}",
        note=said_of_model(result, effects.sentence()),
    )


def _circuit(result: bd.Modes | bd.Locus) -> str:
    """Return words on whether the modes of a harvester are for open or short circuit; "" for other beams."""
    electrodes = result.scene.beam.electrodes
    if electrodes is None:
        return ""
    return (
        " with an open circuit" if math.isinf(electrodes.resistance) else " with the layers short-circuited"
    )


def _say_frequency(frequency: float, error: float) -> str:
    return supported_or_range(frequency, error).replace("none", "-")


def _kinds(result: bd.Modes) -> Iterator[Column]:
    """Yield columns of each mode's energy fractions in two planes of bending, and of the kind of each mode.

    Tables show only one of the two fractions.
    """
    drawn, words = first_drawn(result.scene), words_of_directions(result.scene)
    for k, direction in enumerate(csv_directions(result.scene)):
        shown = f"share of {words[k]}" if k == drawn else None
        yield Column(f"share_{direction}", result.plane_share[:, k], form=".3f", words=shown)
    if result.kinds is not None:
        yield Column("kind", result.kinds, words="" if (result.kinds != BENDING).any() else None)


def _say_model_error(size: float, lacks_data: bool) -> str:
    """Format a relative model error with one digit; with "+ ?" if data of the beam are missing."""
    more = " + ?" if lacks_data else ""
    return "not known" if math.isnan(size) else f"{size if size >= _ROUNDING else 0.0:.0e}{more}"


def locus_table(result: bd.Locus) -> Group:
    """Make a table at some speeds of natural frequencies, or of growth rates of unstable modes.

    If two planes are modelled, a letter after each frequency denotes the plane of bending, or another
    dominant kind of deformation such as torsion.
    """
    size, shown = np.abs(result.eigenvalue) * result.error, rows_worth_showing(result.status)
    model_errors, lacks = model_error_at(result, shown), result.left_out_effects.lack_data
    beyond = model_errors * np.abs(result.frequency[shown])
    vibrating = np.isin(result.status[shown], ("stable", "neutral"))
    known = [errors[counts] for errors, counts in zip(model_errors, vibrating, strict=True)]
    modes = (
        [_locus_cell(result, size, s, mode, error) for s, error in zip(shown, beyond[:, mode], strict=True)]
        for mode in range(result.frequency.shape[1])
    )
    others = (kind for kind in map(str, np.unique(result.kind)) if kind != BENDING)
    words = *words_of_directions(result.scene), *others
    letters = "; ".join(f"{word[0]}: mostly {word}" for word in words)
    title = (
        f"Natural frequencies{letters and f' ({letters})'}{_circuit(result)}, by {result.provenance.method}"
        f"{selection_note(shown, result.speeds)}"
    )
    columns = Columns(
        Column("speed", result.speeds[shown], "rad/s", form=".8g"),
        *(Column("mode", (), "Hz", number, cells=cells) for number, cells in enumerate(modes, 1)),
        Column("model_error", (), cells=[_say_largest(each, lacks) for each in known]),
        Column("largest_error", result.error[shown].max(axis=1), form=".0e"),
        Column("tracking", result.confidence[shown].min(axis=1), form=".2f"),
        title=title,
        note=said_over_speeds(result, "mode"),
    )
    return table_of(columns, result.display_units)


def _say_largest(model_errors: np.ndarray, lacks_data: bool) -> str:
    return _say_model_error(float(model_errors.max()), lacks_data) if len(model_errors) else "-"


def model_error_at(result: bd.Locus, indices: np.ndarray) -> np.ndarray:
    """Return model errors of m modes at k speeds with given indices, by interpolation: shape (k, m)."""
    each = (between_speeds(result, error)[indices] for error in result.model_error.T)
    return np.stack([*each], axis=1)


def _locus_cell(result: bd.Locus, size: np.ndarray, s: int, mode: int, model_error: float) -> Cell:
    """Format the frequency of a mode at the speed with index s; of an unstable mode, status and growth rate.

    `size` (speeds, modes) is the absolute error of the eigenvalues [rad/s].  Digits smaller than the model
    error [Hz] are dimmed.
    """
    if result.status[s, mode] not in ("stable", "neutral"):
        return f"{result.status[s, mode]}, {result.growth_rate[s, mode]:+.3g} 1/s"
    digits = _DIGITS if result.frequency.shape[1] <= _FEW else _DIGITS_OF_MANY
    frequency = supported_or_range(result.frequency[s, mode], size[s, mode] / (2 * np.pi), digits)
    words = words_of_directions(result.scene)[int(result.plane_share[s, mode].argmax()) :][:1]
    kind = str(result.kind[s, mode])
    told = words if kind == BENDING else (kind,)
    return Text(" ").join((set_apart(frequency, model_error), *(Text(word[0]) for word in told)))


def locus_csv(result: bd.Locus) -> Columns:
    """Make columns of frequency, errors, growth rate, status, confidence and kind of each mode over speed."""
    of_modes = {
        ("frequency", "Hz"): result.frequency,
        ("relative_error", ""): result.error,
        ("model_error", ""): model_error_at(result, np.arange(len(result.speeds))),
        ("growth_rate", "1/s"): result.growth_rate,
        ("status", ""): result.status,
        ("confidence", ""): result.confidence,
        **{
            (f"share_{direction}", ""): result.plane_share[..., k]
            for k, direction in enumerate(csv_directions(result.scene))
        },
    }
    if result.kinds is not None:
        of_modes["kind", ""] = result.kinds
    each = (
        Column(name, values, unit, mode)
        for (name, unit), of_all in of_modes.items()
        for mode, values in enumerate(of_all.T, 1)
    )
    return Columns(Column("speed", result.speeds, "rad/s"), *each)


# Critical speeds, limits, bounds ------------------------------------------------------------------------


def critical_answer(result: bd.CriticalPoint) -> Group:
    """Make sentences on the critical speed, or the speed below which there is none, and neglected effects."""
    unit = result.display_units.speed_unit()
    if math.isinf(result.none_below) and math.isinf(result.speed):
        said = Text(f"no critical speed: {in_files(result.reason)}")
    elif math.isinf(result.speed):
        bound = unit.say(result.none_below, 4)
        if result.error and not result.of_bent_beam:
            said = Text(f"no critical speed found; there is certainly none below {bound}")
        else:
            below = "found up to" if result.error else "below"
            said = Text(f"no critical speed {below} {bound}: {result.reason}")
    elif not result.speed:
        where = "at rest already" if result.of_bent_beam else "at every speed"
        said = Text(f"critical speed: 0 {unit.name}; the beam is unstable {where}: {result.reason}")
    else:
        speed = unit.of(result.speed)
        value = supported_or_range(speed, result.error * speed, _CRITICAL_DIGITS)
        shown = set_apart(value, float(result.model_error) * speed)
        straight = of_kind(result.warnings, OUTSIDE)
        which = "a straight beam would buckle" if straight else "the beam buckles"
        said = Text.assemble("critical speed: ", shown, f" {unit.name}; above it {which}: {result.reason}")
    return Group(said, Text(said_of_model(result, result.left_out_effects.sentence(""))))


def critical_csv(result: bd.CriticalPoint) -> Columns:
    """Make columns of the critical speed, its error, and the speed below which there is none."""
    heads = ("speed", "rad/s"), "relative_error", ("none_below", "rad/s"), "reason"
    return columns_of_rows(heads, [(result.speed, result.error, result.none_below, result.reason)])


def limits_columns(result: bd.SettingAngleLimits) -> Columns:
    """Make columns of both limits of the setting angle with their error, and of the top speed."""
    top = result.display_units.speed_unit().say(result.top_speed, 10)
    return Columns(
        Column("limit", ("first", "second")),
        Column("angle", [*result], "rad", error=np.full(2, result.error)),
        Column("error", [result.error] * 2, "rad", words=None),
        Column("top_speed", [result.top_speed] * 2, "rad/s", words=None),
        title=f"Setting-angle limits up to {top}, by {result.provenance.method}",
        note="Below the first limit the first frequency falls with speed from rest on; between the "
        "limits it rises first, then falls before the top speed; above the second it rises up to that speed.",
    )


def bounds_columns(result: bd.FrequencyBounds) -> Columns:
    """Make columns of the lower and upper bound of each frequency; a note says why they are guaranteed."""
    count = len(result.lower)
    return Columns(
        Column("mode", range(1, count + 1)),
        Column("speed", [result.speed] * count, "rad/s", words=None),
        Column("lower", result.lower, "Hz", form=lower_bound, words="at least"),
        Column("upper", result.upper, "Hz", form=upper_bound, words="at most"),
        Column("relative_width", result.width, form=".0e"),
        title=f"Guaranteed bounds of the model at {result.display_units.speed_unit().say(result.speed, 10)}",
        note=f"{result.how[:1].upper()}{result.how[1:]}.",
    )


def backbone_table(result: bd.Backbone) -> Group:
    """Make a table of the frequency of small vibration, and of its change with the amplitude."""
    rows = [
        ("frequency f0 of small vibration", f"{result.frequency:.8g} Hz"),
        ("coefficient k", supported(result.coefficient, result.error, 8)),
        ("at an amplitude of 10 % of the length", f"{100 * 0.01 * result.coefficient:+.3g} %"),
    ]
    title = f"Backbone of mode {result.mode} at {result.display_units.speed_unit().say(result.speed, 10)}"
    note = "f = f0 (1 + k (a/L)^2), to first order; a is the amplitude of the tip, L the length."
    return Group(table(title, ("", ""), rows), Text(note))


def backbone_csv(result: bd.Backbone) -> Columns:
    """Make columns of the frequency of small vibration, and of its amplitude coefficient with error."""
    heads = ("speed", "rad/s"), "mode", ("frequency", "Hz"), "coefficient", "error"
    row = result.speed, result.mode, result.frequency, result.coefficient, result.error
    return columns_of_rows(heads, [row])


# Equilibria ---------------------------------------------------------------------------------------------


def equilibrium_table(result: bd.Equilibrium) -> Group:
    """Make a table of position and slope of the tip, and of the stability of the equilibrium."""
    length, unit = result.scene.beam.length, result.display_units.length_unit()
    rows = [
        (f"tip along {axis}", supported(unit.of(x), unit.of(result.error)), f"{x / length:.4f}")
        for axis, x in zip(_AXES, result.tip.tolist(), strict=True)
    ]
    slope, error = np.degrees([result.tip_angle, result.error / length]).tolist()
    rows.append(("slope at the tip [deg]", supported(slope, error), ""))
    rows.append(("stable", "yes" if result.stable else f"no: grows at {result.growth_rate:.4g} 1/s", ""))
    speed = result.display_units.speed_unit().say(result.speed, 10)
    title = f"Equilibrium at {speed} ({result.branch} branch), by {result.provenance.method}"
    return table(title, ("", f"[{unit.name}]", "over the length"), rows)


def equilibrium_csv(result: bd.Equilibrium) -> Columns:
    """Make columns of the position of the tip, stability and growth rate."""
    heads = ("speed", "rad/s"), "branch", *((f"tip_{axis}", "m") for axis in _AXES)
    row = result.speed, result.branch, *result.tip.tolist(), result.stable, result.growth_rate
    return columns_of_rows((*heads, "stable", ("growth_rate", "1/s")), [row])


def branches_table(result: bd.EquilibriumBranches) -> Group:
    """Make a table of the range of speeds of each branch, and of the speeds at which it is stable."""
    unit, rows = result.display_units.speed_unit(), []
    for branch in result.branches:
        speeds, stable = unit.of(branch.speeds), branch.stable
        ranges = (f"{some.min():.6g} to {some.max():.6g}" if len(some) else "nowhere"
                  for some in (speeds, speeds[stable]))  # fmt: skip
        turning = ", ".join(f"{speed:.8g}" for speed in unit.of(branch.turning_speeds)) or "-"
        rows.append((branch.name, *ranges, turning))
    if np.isfinite(result.critical_speed):
        rows.append(("straight beam", "", "", f"buckles at {unit.say(result.critical_speed, 10)}"))
    heads = (f"{what} [{unit.name}]" for what in ("speeds", "stable", "turns back at"))
    title = f"Branches of equilibria up to {unit.say(result.top_speed, 10)}, by {result.provenance.method}"
    return table(title, ("branch", *heads), rows, (0, 3))


def branches_csv(result: bd.EquilibriumBranches) -> Columns:
    """Make columns of speed, position of the tip and stability along each branch."""
    rows = (
        (branch.name, float(speed), *tip.tolist(), bool(stable))
        for branch in result.branches
        for speed, tip, stable in zip(branch.speeds, branch.tip, branch.stable, strict=True)
    )
    heads = "branch", ("speed", "rad/s"), *((f"tip_{axis}", "m") for axis in _AXES), "stable"
    return columns_of_rows(heads, rows)


# The scene itself ---------------------------------------------------------------------------------------


def terms_table(result: bd.Terms) -> Group:
    """Make a table of all terms of the equations: which are present and why, and neglected effects."""
    heads = "", "term", "symbol", "largest", "reason"
    shown = table("Terms of the equations of motion", heads, result.rows(), (0, 1, 2, 4))
    left_out = (f"Left out: {effect.name}: {in_files(effect.reason)}." for effect in result.left_out)
    return Group(shown, *map(Text, (result.excited(), *left_out)))


def terms_csv(result: bd.Terms) -> Columns:
    """Make columns with one row per term of the equations of motion."""
    rows = (
        (t.name, t.symbol, " ".join(t.fields), t.quantity, t.present, t.largest, t.reason) for t in result
    )
    return columns_of_rows(("term", "symbol", "fields", "quantity", "present", "largest", "reason"), rows)


def rotor_table(result: bd.RotorDrawing) -> Group:
    """Make a table of drawn lengths and angles, and of the magnification of thickness and width."""
    unit = result.display_units.length_unit()
    lengths = {"radius r of the root": result.radius, "length L of the beam": result.length}
    angles = {
        "setting angle φ, 0 is inward": result.setting_angle,
        "bending angle ψ, 0 is in the plane of rotation": result.bending_angle,
        "precone η": result.precone,
    }
    rows = [
        *((what, f"{unit.of(length):.6g}", unit.name) for what, length in lengths.items()),
        *((what, f"{np.degrees(angle):.6g}", "deg") for what, angle in angles.items()),
        ("depth of the beam drawn larger by", f"{result.magnification:g}", ""),
    ]
    return table("Rotor as drawn: undeformed, turned by 180 deg", ("", "value", "unit"), rows, (0, 2))


def rotor_csv(result: bd.RotorDrawing) -> Columns:
    """Make columns of x and y [m] along the drawn beam's outline, and of the thickness magnification."""
    rows = ((x, y, result.magnification) for x, y in result.outline.tolist())
    return columns_of_rows((("x", "m"), ("y", "m"), "depth_magnification"), rows)


VIEWS = {
    "Backbone": View(backbone_table, backbone_csv, 2),
    "CriticalPoint": View(critical_answer, critical_csv),
    "Equilibrium": View(equilibrium_table, equilibrium_csv, 1),
    "EquilibriumBranches": View(branches_table, branches_csv, 2),
    "FrequencyBounds": View(None, bounds_columns, 1),
    "Locus": View(locus_table, locus_csv, 1),
    "Modes": View(None, modes_columns, 1),
    "RotorDrawing": View(rotor_table, rotor_csv, 0, lambda result: result.figure()),
    "SettingAngleLimits": View(None, limits_columns, 1),
    "Terms": View(terms_table, terms_csv, 1),
}
