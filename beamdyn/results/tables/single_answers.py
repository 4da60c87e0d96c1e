"""Answers of few numbers as tables for reading and as rows of CSV files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.console import Group
from rich.text import Text

from beamdyn.common.edge.file_words import as_in_files
from beamdyn.common.edge.tables import table
from beamdyn.common.results.columns import Column, Columns, columns_of_rows
from beamdyn.common.results.digits import supported
from beamdyn.loads.stations import UNITS

if TYPE_CHECKING:
    from beamdyn.equations.terms import Terms
    from beamdyn.loads.cycles import LoadCycles
    from beamdyn.modes.backbone import Backbone
    from beamdyn.modes.bounds import FrequencyBounds
    from beamdyn.modes.critical import CriticalPoint
    from beamdyn.modes.setting_angles import SettingAngleLimits


def critical_csv(result: CriticalPoint) -> Columns:
    """Critical speed, its error, and the speed below which there is none."""
    heads = ("speed", "rad/s"), "relative_error", ("none_below", "rad/s"), "reason"
    return columns_of_rows(heads, [(result.speed, result.error, result.none_below, result.reason)])


def limits_csv(result: SettingAngleLimits) -> Columns:
    """Both limits with their error and the top speed of the second."""
    names = zip(("first", "second"), result, strict=True)
    rows = ((name, angle, result.error, result.top_speed) for name, angle in names)
    return columns_of_rows(("limit", ("angle", "rad"), ("error", "rad"), ("top_speed", "rad/s")), rows)


def bounds_table(result: FrequencyBounds) -> Group:
    """Lower and upper bound of each frequency, and how they are guaranteed."""
    unit = result.display_units.speed_unit()
    each = zip(result.lower, result.upper, result.width, strict=True)
    rows = [
        (str(mode), f"{low:.10g}", f"{high:.10g}", f"{width:.0e}")
        for mode, (low, high, width) in enumerate(each, 1)
    ]
    title = f"Guaranteed bounds at {result.speed * unit.per_si:.10g} {unit.name}, of the model"
    heads = "mode", "at least [Hz]", "at most [Hz]", "relative width"
    return Group(table(title, heads, rows, ()), Text(f"{result.how[:1].upper()}{result.how[1:]}."))


def bounds_csv(result: FrequencyBounds) -> Columns:
    """Bounds of each frequency, one row a mode."""
    return Columns(
        Column("mode", range(1, len(result.lower) + 1)),
        Column("speed", [result.speed] * len(result.lower), "rad/s"),
        Column("lower", result.lower, "Hz"),
        Column("upper", result.upper, "Hz"),
        Column("relative_width", result.width),
    )


def backbone_table(result: Backbone) -> Group:
    """Frequency of small vibration, and how it changes with the amplitude."""
    unit = result.display_units.speed_unit()
    coefficient = supported(result.coefficient, result.error, 8)
    rows = [
        ("frequency f0 of small vibration", f"{result.frequency:.8g} Hz"),
        ("coefficient k", coefficient),
        ("at an amplitude of 10 % of the length", f"{100 * 0.01 * result.coefficient:+.3g} %"),
    ]
    title = f"Backbone of mode {result.mode} at {result.speed * unit.per_si:.10g} {unit.name}"
    note = "f = f0 (1 + k (a/L)^2), to first order; a is the amplitude of the tip, L the length."
    return Group(table(title, ("", ""), rows, (0,)), Text(note))


def backbone_csv(result: Backbone) -> Columns:
    """Frequency of small vibration and coefficient, with its error."""
    heads = ("speed", "rad/s"), "mode", ("frequency", "Hz"), "coefficient", "error"
    row = result.speed, result.mode, result.frequency, result.coefficient, result.error
    return columns_of_rows(heads, [row])


def terms_table(result: Terms) -> Group:
    """All terms, which of them are there and why, and what the model leaves out."""
    heads = "", "term", "symbol", "largest", "reason"
    shown = table("Terms of the equations of motion", heads, result.rows(), (0, 1, 2, 4))
    left_out = [as_in_files(f"Left out: {effect.name}: {effect.reason}.") for effect in result.left_out]
    return Group(shown, *map(Text, (result.excited(), *left_out)))


def terms_csv(result: Terms) -> Columns:
    """One row a term."""
    rows = (
        (t.name, t.symbol, " ".join(t.fields), t.quantity, t.present, t.largest, t.reason) for t in result
    )
    return columns_of_rows(("term", "symbol", "fields", "quantity", "present", "largest", "reason"), rows)


def cycles_csv(result: LoadCycles) -> Columns:
    """Range, mean and count of each cycle."""
    unit = UNITS[result.quantity]
    return Columns(
        Column(f"range_of_{result.quantity}", result.ranges, unit),
        Column("mean", result.means, unit),
        Column("cycles", result.counts),
    )
