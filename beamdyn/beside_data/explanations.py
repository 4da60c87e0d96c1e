"""Which number of a scene, changed alone, would explain what was measured."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from beamdyn.beside_data.fit import Fitting, fit_from
from beamdyn.beside_data.free_numbers import SPRINGS, FreeNumber, free_numbers
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.words import amount
from beamdyn.measured.frequencies import MeasuredFrequencies
from beamdyn.scene.numbers import SCALE
from beamdyn.scene.scene import Scene

_WITHIN = {  # numbers that may be wrong, and by which factors they are at most
    "beam.length": (0.8, 1.25),
    "beam.thickness": (0.5, 2.0),
    "beam.width": (0.5, 2.0),
    "beam.youngs_modulus": (0.4, 2.5),
    "beam.density": (0.4, 2.5),
    "beam.bending_stiffness": (0.2, 5.0),
    "beam.mass_per_length": (0.2, 5.0),
    "mount.radius": (0.5, 2.0),
}
_HEAVIEST = 2.0  # largest body at the tip over the mass of the beam
_SOLVES = 25  # of one number
_MATTERS = 1e-3  # least relative change of a frequency by a whole change of a number
_TIE = 3  # decimals of remaining deviations that are told apart
_SLACK = 1e-6  # by which a deviation may pass its bound


@dataclass(frozen=True)
class Explanation:
    """A number of a scene that, changed alone, comes nearest to the data.

    Parameters
    ----------
    name : str
        Its name in scene files, such as "beam.thickness".
    unit : str
        Its SI unit.
    given : float
        Its value in the scene [unit]; inf of a clamped root.
    value : float
        The value that comes nearest to the data [unit].
    remaining : float
        Largest deviation that it leaves, over the computed frequency.
    explains : bool
        Whether all deviations are then within the uncertainty of the data and what the model leaves out.

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


def explain(scene: Scene, data: MeasuredFrequencies, bound: np.ndarray) -> tuple[Explanation, ...]:
    """Fit each number alone to all data; those that explain them first, and of them those that leave least.

    Parameters
    ----------
    scene : Scene
        The scene.
    data : MeasuredFrequencies
        The measured frequencies.
    bound : ndarray, shape (N,)
        By how much each value may deviate [Hz]; nan where the scene has no such mode.
    """
    allowed = np.full(data.frequency.shape, np.nan)
    allowed[np.isfinite(data.frequency)] = bound
    frequency = np.where(np.isfinite(allowed), data.frequency, np.nan)
    if not np.isfinite(frequency).any():
        return ()
    paired = replace(data, frequency=frequency)
    tried = (_explanation(scene, paired, number, allowed) for number in _numbers(scene))
    found = [each for each in tried if each is not None]
    return tuple(sorted(found, key=lambda each: (not each.explains, round(each.remaining, _TIE))))


def _numbers(scene: Scene) -> list[FreeNumber]:
    """The numbers of a scene that may be wrong, a spring at the root first, with physical bounds."""
    found = []
    for path in (*SPRINGS, *_WITHIN, "beam.tip.mass", *(SCALE + n for n in ("bending_stiffness", "mass_per_length"))):
        try:
            (number,) = free_numbers(scene, {path: None})
        except InvalidValue:  # none of this scene
            continue
        found.append(replace(number, bounds=_physical(scene, number)))
    return found


def _physical(scene: Scene, number: FreeNumber) -> tuple[float, float]:
    if number.path in SPRINGS:
        return number.bounds
    if number.path == "beam.tip.mass":
        return 0.0, max(_HEAVIEST * number.scale, 2 * number.given)
    low, high = _WITHIN.get(number.path, _WITHIN.get(f"beam.{number.path.removeprefix(SCALE)}", (0.5, 2.0)))
    return low * number.given, high * number.given


def _explanation(
    scene: Scene, data: MeasuredFrequencies, number: FreeNumber, allowed: np.ndarray
) -> Explanation | None:
    """What a number alone explains; None where it hardly changes a frequency, or leaves its bounds."""
    fitting = Fitting(scene, data, (number,), np.maximum(allowed, _SLACK * np.nan_to_num(data.frequency, nan=1.0)))
    start = fitting.at(np.array([number.first]))
    pairs = start.pairs()
    slope = np.abs(start.derivative(pairs)[:, 0] * fitting.weight[pairs >= 0] / data.frequency[pairs >= 0])
    if slope.max(initial=0.0) < _MATTERS:
        return None
    found = fit_from(fitting, start.x.tolist(), _SOLVES)
    x, residual = float(found.modes.x[0]), found.modes.residual(found.pairs)
    off = np.abs(residual * fitting.weight[found.pairs >= 0] / data.frequency[found.pairs >= 0])
    explains = bool((np.abs(residual) <= 1 + _SLACK).all()) and found.rank[0] == int(np.isnan(data.frequency).sum())
    return Explanation(number.path, number.unit, number.given, number.value(x), float(off.max()), explains)


def say_value(value: float, unit: str) -> str:
    """A value with three digits and its unit; lengths and angles as each medium has them."""
    if math.isinf(value):
        return "clamped"
    return amount(value, unit=unit, digits=3) if unit in ("m", "rad") else f"{value:.3g} {unit}".rstrip()
