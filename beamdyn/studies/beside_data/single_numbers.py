"""Explanations of deviations: single numbers of a scene that would explain them if changed alone."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.results.columns import SI_UNITS, DisplayUnits
from beamdyn.common.words import Named, amount, percent
from beamdyn.scene.measured_frequencies import MeasuredFrequencies
from beamdyn.scene.numbers import SCALE
from beamdyn.scene.scene import Scene
from beamdyn.studies.beside_data.fit import Fitting, fit_from
from beamdyn.studies.beside_data.free_numbers import SPRINGS, FreeNumber, free_numbers

_WITHIN = {  # numbers that may be wrong, and the least and largest ratio of the true value to the given one
    "beam.length": (0.8, 1.25),
    "beam.thickness": (0.5, 2.0),
    "beam.width": (0.5, 2.0),
    "beam.youngs_modulus": (0.4, 2.5),
    "beam.density": (0.4, 2.5),
    "beam.bending_stiffness": (0.2, 5.0),
    "beam.mass_per_length": (0.2, 5.0),
    "mount.radius": (0.5, 2.0),
}
_HEAVIEST = 2.0  # largest mass of a tip body, over that of the beam
_SOLVES = 25  # largest number of scenes whose modes are computed for the fit of one number
_TOLERANCE = 1e-7  # relative change of a number below which its fit ends
# A number explains nothing if a change by its full size would change all frequencies by less than this
# fraction.
_MATTERS = 1e-3
_DIGITS = 3  # number of significant digits of values in sentences
# Number of digits before the decimal point up to which a rounded value is written without an exponent.
_WHOLE = 6
_USUAL = {"Pa": ("GPa", 1e-9), "kg": ("g", 1e3)}
_NOTHING = 1e-5  # remaining relative deviation that is described as none
_TIE = 3  # number of decimals to which remaining deviations are compared
_SLACK = 1e-6  # relative amount by which a deviation may exceed the allowed one


@dataclass(frozen=True)
class OneNumberFit:
    """Number of a scene, with the value that, changed alone, fits the data best.

    Parameters
    ----------
    name : str
        Name of the number in scene files, such as "beam.thickness".
    unit : str
        SI unit of the number.
    given : float
        Value in the scene [unit]; inf for a clamped root.
    value : float
        Value that fits the data best [unit].
    remaining : float
        Largest remaining deviation, relative to the computed frequency.
    explains : bool
        Whether all deviations are then within the data's uncertainty and the model error.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> found = bd.compare(bd.Scene(strip), bd.MeasuredFrequencies([60.0], rounding=0.05))
    >>> [each.name for each in found.explanations if each.explains][:2]
    ['mount.root_stiffness', 'beam.length']
    """

    name: str
    unit: str
    given: float
    value: float
    remaining: float
    explains: bool

    @property
    def left(self) -> str:
        """Describe the largest deviation from the data that remains with this value of the number."""
        return percent(self.remaining) if self.remaining > _NOTHING else "nothing"


def explain(scene: Scene, data: MeasuredFrequencies, bound: np.ndarray) -> tuple[OneNumberFit, ...]:
    """Fit each number alone to all data; return the fits that explain the data first, then the others.

    In both groups the fits are in order of their remaining deviation.

    Parameters
    ----------
    scene : Scene
        The scene.
    data : MeasuredFrequencies
        The measured frequencies.
    bound : ndarray, shape (N,)
        Allowed deviation of each value [Hz]; nan if the scene has no such mode.
    """
    allowed = np.full(data.frequency.shape, np.nan)
    allowed[np.isfinite(data.frequency)] = bound
    frequency = np.where(np.isfinite(allowed), data.frequency, np.nan)
    if not np.isfinite(frequency).any():
        return ()
    paired = replace(data, frequency=frequency)
    tried = (_explanation(scene, paired, free, allowed) for free in _numbers(scene))
    found = [each for each in tried if each is not None]
    return tuple(sorted(found, key=lambda each: (not each.explains, round(each.remaining, _TIE))))


def _numbers(scene: Scene) -> list[FreeNumber]:
    """Return the numbers of a scene that may be wrong, with physical bounds; a root spring comes first."""
    found = []
    for path in (
        *SPRINGS,
        *_WITHIN,
        "beam.tip.mass",
        *(SCALE + n for n in ("bending_stiffness", "mass_per_length")),
    ):
        try:
            (free,) = free_numbers(scene, {path: None})
        except InvalidValue:  # the scene has no such number
            continue
        low, high = _physical(free)
        if low < high:  # false for a radius of 0, which keeps the root on the axis
            found.append(replace(free, bounds=(low, high)))
    return found


def _physical(free: FreeNumber) -> tuple[float, float]:
    if free.path in SPRINGS:
        return free.bounds
    if free.path == "beam.tip.mass":
        return 0.0, max(_HEAVIEST * free.scale, 2 * free.given)
    low, high = _WITHIN.get(free.path, _WITHIN.get(f"beam.{free.path.removeprefix(SCALE)}", (0.5, 2.0)))
    return low * free.given, high * free.given


def _explanation(
    scene: Scene, data: MeasuredFrequencies, free: FreeNumber, allowed: np.ndarray
) -> OneNumberFit | None:
    """Fit one number, within its bounds, to all data; return None if it hardly changes frequencies."""
    weight = np.maximum(allowed, _SLACK * np.nan_to_num(data.frequency, nan=1.0))
    fitting = Fitting(scene, data, (free,), weight, _TOLERANCE)
    start = fitting.at(np.array([free.first]))
    pairs = start.pairs()
    slope = np.abs(start.derivative(pairs)[:, 0] * fitting.weight[pairs >= 0] / data.frequency[pairs >= 0])
    if slope.max(initial=0.0) < _MATTERS:
        return None
    found = fit_from(fitting, start.x.tolist(), _SOLVES)
    x, residual = float(found.modes.x[0]), found.modes.residual(found.pairs)
    off = np.abs(residual * fitting.weight[found.pairs >= 0] / data.frequency[found.pairs >= 0])
    explains = bool((np.abs(residual) <= 1 + _SLACK).all()) and found.rank[0] == int(
        np.isnan(data.frequency).sum()
    )
    return OneNumberFit(free.path, free.unit, free.given, free.value(x), float(off.max()), explains)


def say_value(value: float, unit: str, digits: int = _DIGITS, units: DisplayUnits = SI_UNITS) -> str:
    """Format a value with a number of significant digits and its unit, in the units of each output medium.

    Python prints SI units, files mm, GPa and g; lengths have the unit of the scene, if it has one.
    """
    if math.isinf(value):
        return "clamped"
    rounded = float(f"{value:.{digits}g}")
    if unit == "m" and units.length:
        own = units.length_unit()
        return Named(f"{rounded:.{digits}g} m", f"{own.of(value):.{digits}g} {own.name}")
    if unit in ("m", "rad"):
        return amount(rounded, unit=unit)
    usual, size = _USUAL.get(unit, (unit, 1.0))
    shown = max(digits, _WHOLE)
    said = (f"{each:.{shown}g} {name}".rstrip() for each, name in ((rounded, unit), (rounded * size, usual)))
    return Named(*said)
