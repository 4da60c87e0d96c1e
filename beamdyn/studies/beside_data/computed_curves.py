"""Computed curves of a scene at the times, speeds, positions or frequencies of measured curves."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.results.statements import unannounced
from beamdyn.equations.effects import modelled_directions
from beamdyn.linear.frequency_response import FrequencyResponse, frequency_response
from beamdyn.loads.static_loads import StaticLoads, static_loads
from beamdyn.loads.transient_loads import transient_loads
from beamdyn.modes.modes import natural_modes
from beamdyn.scene.measured_curves import MeasuredHistory, MeasuredLoads, MeasuredPeaks, MeasuredResponse
from beamdyn.scene.scene import Scene
from beamdyn.transient.simulate import Transient, simulate
from beamdyn.transient.sweep import Sweep, sweep

_DELAYS = 33  # number of trial delays, evenly spaced between the limits
_COMPARED = 4000  # largest number of instants at which histories are compared to find the delay
_ROUNDING = 1e-9  # fraction of the length by which a position may be beyond the tip because of rounding
_SHARP = 1e-9  # accuracy of a delay, relative to the period of the first mode
# A curve counts as inverted if the opposite sign reduces the sum of squares to at most this fraction.
_TURNED = 0.25
_LOADS = {
    "moment": ("moment", 0),
    "moment across": ("moment", 1),
    "axial": ("force", 0),
    "shear": ("force", 1),
    "shear across": ("force", 2),
}


@dataclass(frozen=True)
class ComputedCurves:
    """Computed curves as columns, their errors (which broadcast), their units, and the result they belong to.

    `speed` is the speed of the computation [rad/s], nan for curves over time or speed; `delay` [s] and
    `phase` [rad] are as in `CurveComparison`.
    """

    value: np.ndarray
    error: np.ndarray
    unit: tuple[str, ...]
    result: StaticLoads | FrequencyResponse | Transient | Sweep
    speed: float = np.nan
    delay: float = 0.0
    phase: float = np.nan


# Loads and responses ------------------------------------------------------------------------------


def computed_loads(scene: Scene, data: MeasuredLoads) -> ComputedCurves:
    """Compute loads at the measured positions, in equilibrium at the speed of the data."""
    speed = _speed(scene, data)
    check_positions(scene, "position", data.position)
    with unannounced():
        found = static_loads(scene, speed, np.minimum(data.position, scene.beam.length))
    places = [_LOADS[name] for name in data.names]
    for name, (quantity, k) in zip(data.names, places, strict=True):
        _check_modelled(name, k < found.values(quantity).shape[2])
    value, error = (
        np.array([of(quantity)[0, :, k] for quantity, k in places]).T for of in (found.values, found.error_of)
    )
    return ComputedCurves(value, error, tuple(data.units[name] for name in data.names), found, speed)


def check_positions(scene: Scene, name: str, positions: np.ndarray) -> None:
    """Raise an error for data at positions beyond the beam."""
    length = scene.beam.length
    beyond = (positions < 0) | (positions > length * (1 + _ROUNDING))
    if beyond.any():
        bound = f"the beam reaches from 0 to its length, {length:g} m"
        raise InvalidValue(name, float(positions[beyond][0]), bound, "measure from the root", "m")


def _speed(scene: Scene, data: MeasuredLoads | MeasuredResponse) -> float:
    """Return the speed of the data [rad/s], or the scene's final speed if the data have none."""
    return scene.final_speed if data.speed is None else data.speed


def _check_modelled(name: str, modelled: bool) -> None:
    """Raise an error for a quantity of the second plane of bending if the scene models one plane."""
    if not modelled:
        bound = "the scene bends in one plane"
        raise InvalidValue("names", name, bound, "give physics.planes = 2, or leave the column out")


def computed_response(scene: Scene, data: MeasuredResponse) -> ComputedCurves:
    """Compute the frequency response of a scene at the measured frequencies."""
    speed = _speed(scene, data)
    with unannounced():
        found = frequency_response(scene, speed, data.frequency, data.input, data.output)
    value = found.response
    if value.shape[1] != 1:
        bound = "a rotating beam responds to this input at two frequencies"
        raise InvalidValue(
            "input", data.input, bound, "give bending, across, n3 or a force that turns with the beam"
        )
    phase = np.nan
    if data.phase is None:
        value = np.abs(value)
    else:
        largest = int(data.magnitude.argmax())
        phase = float(np.angle(data.columns[largest, 0] * value[largest, 0].conj()))
    return ComputedCurves(value, found.error, (found.unit,), found, speed, phase=phase)


# Time histories, and their largest values ---------------------------------------------------------


def computed_peaks(scene: Scene, data: MeasuredPeaks) -> ComputedCurves:
    """Compute the largest deflections in the measured time window, by a transient from rest to each speed."""
    with unannounced():
        found = sweep(scene, data.speed, (data.window[0], data.window[1]))
    return ComputedCurves(found.peaks[:, None], found.peak_error[:, None], ("m",), found)


def computed_history(scene: Scene, data: MeasuredHistory) -> ComputedCurves:
    """Compute the motion of a scene, delayed for the best agreement with measured histories."""
    period = _period(scene, data)
    last = float(data.time[-1])
    end = math.inf if scene.motion is None else scene.motion.end
    with unannounced():
        run = simulate(scene, max(min(last + period / 2, end), last))
    curves = [*_curves(run, data.names)]

    def at(t: np.ndarray) -> np.ndarray:
        within = np.clip(t, 0.0, run.path.end)
        return np.array([curve(within) for curve, _ in curves]).T

    value, error, delay = at(data.time), np.array([each for _, each in curves]), 0.0
    off = np.sqrt(((data.value - value) ** 2).mean(axis=0))
    if not (off <= np.sqrt((data.allowance**2).mean(axis=0)) + error).all():
        ahead = min(period / 2, run.path.end - float(data.time[-1]))
        delay = _delay(at, data, (-max(ahead, 0.0), period / 2), period)
        value = at(data.time - delay)
    phase = -2 * np.pi * _main_frequency(data) * delay
    units = tuple(data.units[name] for name in data.names)
    return ComputedCurves(value, np.broadcast_to(error, value.shape), units, run, delay=delay, phase=phase)


def _period(scene: Scene, data: MeasuredHistory) -> float:
    """Return the first mode's period at rest [s], 0 for a hinge; raise an error if the history is shorter."""
    with unannounced():
        frequency = float(natural_modes(scene, 0.0, 1).frequency[0])
    period, length = 1 / frequency if frequency > 0 else 0.0, float(data.time[-1] - data.time[0])
    if length < period:
        bound = f"the history is {length:.4g} s long, shorter than a period of the first mode, {period:.4g} s"
        raise InvalidValue("time", float(data.time[-1]), bound, "give a longer one", "s")
    return period


def _curves(run: Transient, names: Sequence[str]) -> Iterator[tuple[Callable[[np.ndarray], Any], float]]:
    """Yield, for each named quantity, a function from times to values in a transient, and their error."""
    for name in names:
        k = int(name.endswith("across"))
        if name == "root strain":
            yield run.root_strain, run.root_strain_error
        elif name.startswith("root moment"):
            loads = transient_loads(run, at=[0.0])
            _check_modelled(name, k < loads.moment.shape[2])
            place = range(*loads.path.outputs.places["moment"].indices(loads.path.outputs.matrix.shape[1]))[k]
            yield partial(_at_root, loads.path.at, place), float(loads.moment_error[0, k])
        else:
            _check_modelled(name, k < len(modelled_directions(run.scene)))
            yield partial(run.deflection, direction=k), run.time_error + run.mode_error * run.largest


def _at_root(outputs: Callable[[np.ndarray], np.ndarray], place: int, t: np.ndarray) -> np.ndarray:
    return outputs(t)[:, 0, place]


def _delay(
    at: Callable[[np.ndarray], np.ndarray], data: MeasuredHistory, limits: tuple[float, float], period: float
) -> float:
    """Find the delay [s], between two limits, for which the computed curves agree best with measured ones.

    If the sum of squared differences falls below a quarter when some curves are taken with the opposite sign,
    the delay of best agreement with these signs is returned.
    """
    some = slice(None, None, 1 + len(data.time) // _COMPARED)
    t, values = data.time[some], data.value[some]
    sizes = np.abs(data.value).max(axis=0)
    sizes[sizes == 0] = 1.0

    def squares(delay: float) -> np.ndarray:
        """Compute sums of squared differences for each curve (columns): as it is, and with opposite sign."""
        curves = at(t - delay)
        return np.array([(((values - sign * curves) / sizes) ** 2).sum(axis=0) for sign in (1, -1)])

    def misfit(delay: float) -> float:
        return float(squares(delay)[0].sum())

    def misfit_of_any_sign(delay: float) -> float:
        return float(squares(delay).min(axis=0).sum())

    as_is, turned = (_least(each, limits, _SHARP * period) for each in (misfit, misfit_of_any_sign))
    return turned if misfit_of_any_sign(turned) < _TURNED * misfit(as_is) else as_is


def _least(misfit: Callable[[float], float], limits: tuple[float, float], accuracy: float) -> float:
    """Find the delay [s] between two limits with the smallest misfit: on a grid, then by bounded search."""
    tried = np.linspace(*limits, _DELAYS)
    best, step = tried[int(np.argmin([misfit(each) for each in tried]))], tried[1] - tried[0]
    between = max(best - step, tried[0]), min(best + step, tried[-1])
    options = {"xatol": accuracy}
    return float(minimize_scalar(misfit, bounds=between, method="bounded", options=options).x)  # pyright: ignore


def _main_frequency(data: MeasuredHistory) -> float:
    """Return the frequency [Hz] of the largest spectral line of the first column; 0 for a single value."""
    if len(data.time) < 2:
        return 0.0
    t = np.linspace(data.time[0], data.time[-1], len(data.time))
    values = np.interp(t, data.time, data.value[:, 0])
    lines = np.abs(np.fft.rfft(values - values.mean()))
    return float(np.fft.rfftfreq(len(t), t[1] - t[0])[lines.argmax()])
