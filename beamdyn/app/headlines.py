"""The most important results, which stand first on the beam's screens."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from beamdyn.common.results.display_units import ShownUnit
from beamdyn.common.results.one_line import number
from beamdyn.common.screens.screens import KeyResult
from beamdyn.modes.critical import CriticalPoint
from beamdyn.modes.locus import Locus
from beamdyn.modes.model_error.left_out_effects import say_size
from beamdyn.modes.modes import Modes
from beamdyn.scene.validity import LARGE_DEFLECTION
from beamdyn.steady.response import SteadyResponse


def of_locus(locus: Locus, critical: CriticalPoint) -> Iterator[KeyResult]:
    """First frequency at both ends of the speeds, the critical speed, and its margin."""
    first, speeds = locus.frequency[:, 0], locus.speeds
    unit = locus.display_units.speed_unit()
    yield KeyResult("first frequency at rest", _said(first[0], "Hz"))
    yield KeyResult(f"at {_in(unit, speeds[-1])}", _said(first[-1], "Hz"))
    if np.isfinite(critical.speed):
        yield KeyResult("critical speed", _in(unit, critical.speed))
        yield KeyResult("margin of the top speed", _margin(float(speeds[-1]), critical.speed))
    else:
        bound = critical.none_below
        below = f" below {_in(unit, bound)}" if np.isfinite(bound) else ""
        yield KeyResult("critical speed", f"none{below}")


def of_steady(response: SteadyResponse) -> Iterator[KeyResult]:
    """The largest deflection of the tip, whether it is past linear theory, and its speed."""
    amplitude = np.asarray(response.amplitude)
    if not np.isfinite(amplitude).any():
        yield KeyResult("largest deflection of the tip", "no steady state")
        return
    at = int(np.nanargmax(np.where(np.isfinite(amplitude), amplitude, np.nan)))
    past = amplitude[at] > LARGE_DEFLECTION * response.scene.beam.length
    units, beyond = response.display_units, ", past linear theory" if past else ""
    yield KeyResult(f"largest deflection of the tip{beyond}", _in(units.length_unit(), amplitude[at]))
    yield KeyResult("at the speed", _in(units.speed_unit(), response.speeds[at]))


def of_numbers(modes: Modes) -> Iterator[KeyResult]:
    """The first frequency, and the largest numerical error of all modes."""
    yield KeyResult("first frequency", _said(modes.frequency[0], "Hz"))
    yield KeyResult("numerical error at most", f"{float(np.max(modes.error)):.0e}")


def of_modes(modes: Modes) -> Iterator[KeyResult]:
    """The numbers of `of_numbers`, and the largest model error, which takes longer than the modes."""
    yield from of_numbers(modes)
    if np.isfinite(modes.model_error).any():
        yield KeyResult("model error at most", say_size(float(np.nanmax(modes.model_error))))


def of_peak(peak: float, at: float, unit: ShownUnit) -> Iterator[KeyResult]:
    """The largest deflection of the tip [m], shown in a unit, and its time [s]."""
    yield KeyResult("largest deflection of the tip", _in(unit, peak))
    yield KeyResult("at the time", number(at, "s"))


def of_trade(modes: Modes, time: float, cheapest: str) -> Iterator[KeyResult]:
    """The cheapest model measured, in words; the time that the chosen one takes [s], and its errors."""
    yield KeyResult("cheapest, physics included", cheapest)
    yield KeyResult("time of the chosen model", number(1e3 * time, "ms"))
    yield from [*of_modes(modes)][1:]


def _in(unit: ShownUnit, value: float) -> str:
    """A value in SI, as text in the unit shown."""
    return number(unit.of(value), unit.name)


def _said(frequency: float, unit: str) -> str:
    return number(frequency, unit) if np.isfinite(frequency) else "diverges"


def _margin(top: float, critical: float) -> str:
    return f"{100 * (1 - top / critical):.3g} %" if top < critical else "none: past it"
