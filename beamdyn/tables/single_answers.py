"""Answers of few numbers as tables for reading and as rows of CSV files."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from rich.console import Group
from rich.text import Text

from beamdyn.common.digits import supported
from beamdyn.common.edge.file_words import as_in_files
from beamdyn.common.edge.tables import table
from beamdyn.tables.loads import CSV_UNITS

if TYPE_CHECKING:
    from beamdyn.equations.terms import Terms
    from beamdyn.loads.cycles import LoadCycles
    from beamdyn.spectrum.backbone import Backbone
    from beamdyn.spectrum.bounds import FrequencyBounds
    from beamdyn.spectrum.critical import CriticalPoint
    from beamdyn.spectrum.setting_angles import SettingAngleLimits


def critical_csv(result: CriticalPoint) -> Iterator[Sequence[object]]:
    """Critical speed, its error, and the speed below which there is none."""
    yield "speed_rad_per_s", "relative_error", "none_below_rad_per_s", "reason"
    yield result.speed, result.error, result.none_below, result.reason


def limits_csv(result: SettingAngleLimits) -> Iterator[Sequence[object]]:
    """Both limits with their error and the top speed of the second."""
    yield "limit", "angle_rad", "error_rad", "top_speed_rad_per_s"
    for name, angle in zip(("first", "second"), result, strict=True):
        yield name, angle, result.error, result.top_speed


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


def bounds_csv(result: FrequencyBounds) -> Iterator[Sequence[object]]:
    """Bounds of each frequency, one row a mode."""
    yield "mode", "speed_rad_per_s", "lower_Hz", "upper_Hz", "relative_width"
    columns = result.lower, result.upper, result.width
    for mode, row in enumerate(zip(*(column.tolist() for column in columns), strict=True), 1):
        yield mode, result.speed, *row


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


def backbone_csv(result: Backbone) -> Iterator[Sequence[object]]:
    """Frequency of small vibration and coefficient, with its error."""
    yield "speed_rad_per_s", "mode", "frequency_Hz", "coefficient", "error"
    yield result.speed, result.mode, result.frequency, result.coefficient, result.error


def terms_table(result: Terms) -> Group:
    """All terms, which of them are there and why, and what the model leaves out."""
    heads = "", "term", "symbol", "largest", "reason"
    shown = table("Terms of the equations of motion", heads, result.rows(), (0, 1, 2, 4))
    left_out = [as_in_files(f"Left out: {effect.name}: {effect.reason}.") for effect in result.left_out]
    return Group(shown, *map(Text, (result.excited(), *left_out)))


def terms_csv(result: Terms) -> Iterator[Sequence[object]]:
    """One row a term."""
    yield "term", "symbol", "fields", "quantity", "present", "largest", "reason"
    for each in result:
        fields = " ".join(each.fields)
        yield each.name, each.symbol, fields, each.quantity, each.present, each.largest, each.reason


def cycles_csv(result: LoadCycles) -> Iterator[Sequence[object]]:
    """Range, mean and count of each cycle."""
    unit = CSV_UNITS[result.quantity]
    yield f"range_of_{result.quantity}{unit}", f"mean{unit}", "cycles"
    columns = result.ranges, result.means, result.counts
    yield from zip(*(column.tolist() for column in columns), strict=True)
