"""Statistics of loads along the span under a random input: mean squares, rates and expected extremes.

A stationary Gaussian process with mean 0, the mean square s^2 of its values and the mean square r^2 of its
time derivative crosses 0 upwards nu = r / (2 pi s) times per second (Rice).  In the duration T it has about
N = 2 nu T extremes, maxima and minima together.  If these are independent, the expected magnitude of the
largest one is

    s (sqrt(2 ln N) + 0.5772 / sqrt(2 ln N))

(Davenport (1964), Proceedings of the Institution of Civil Engineers 28, 187-196), and with the probability p
no extreme exceeds s sqrt(2 ln(N / -ln p)).

The rows of `beamdyn.loads.load_rows` give the loads L = d u + P q + V q' as linear functions of the
coordinates q, their rates q', and the input u, which acts at once on the part of the beam outboard of a
station.  With the residues q_k of the coordinates at the poles p_k, the transfer functions from u to L are
H(s) = d + sum (P + p_k V) q_k / (s - p_k).

An input with the frequency f and a fixed direction acts on a rotating beam through two harmonics: with the
transfer functions H+ at the frequency f + n, and H- at f - n, where n is the frequency of rotation.  At the
angle theta of rotation, which is 0 at the time 0, the mean square is

    int (|H+|^2 + |H-|^2) S df + 2 Re exp(2 i theta) int H+ conj(H-) S df,

with the spectral density S of the input.  The mean over a turn is the first integral; the largest value in a
turn is the first integral plus twice the magnitude of the second one.

In shapes of arrays, S counts stations, K outputs at each, m poles, n coordinates, and F frequencies.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from beamdyn.equations.root_motion import Quantity, root_motion
from beamdyn.linear.convergence import Refined, evaluate_accurately, model_of_few_modes
from beamdyn.linear.inputs_outputs import BaseMotion, Excitation
from beamdyn.linear.mean_square import damped_motion, pole_integrals, residues
from beamdyn.linear.model_at_speed import HarmonicDrive, ModelAtSpeed
from beamdyn.linear.spectra import PowerSpectrum, highest_frequency
from beamdyn.linear.transfer import check_stable
from beamdyn.loads.load_rows import LoadRows, per_force, span_rows
from beamdyn.loads.stations import SpanStations, StationOutputs
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.scene.motion.base import MotionSample
from beamdyn.scene.scene import Scene

_TURN = 2 * np.pi
_EPSILON = 2.0**-48  # relative rounding error of each term of a mean square
_FIRST_MODES = 4  # number of modes of a first, coarse model, used only for the magnitudes of the outputs
# Tolerance of the rms of time derivatives, divided by the tolerance of the other statistics.  It may be
# loose, since only the logarithm of time derivatives enters the results, in peak factors.
_OF_RATES = 1e3
_LEAST = math.e  # smallest number of crossings for which the peak factor is evaluated


@dataclass(frozen=True)
class LoadFractions:
    """Transfer functions H(s) = d + sum r_k / (s - p_k) of outputs at stations, at one harmonic of rotation.

    Parameters
    ----------
    shift : float
        Frequency of the response minus that of the input [Hz].
    direct : ndarray of complex, shape (S, K)
        Direct terms d of K outputs at S stations.
    residues : ndarray of complex, shape (S, K, m)
        Residues r_k of the outputs.
    poles : ndarray of complex, shape (m,)
        Poles p_k [1/s], in the left half-plane.
    """

    shift: float
    direct: np.ndarray
    residues: np.ndarray
    poles: np.ndarray

    def at(self, s: np.ndarray) -> np.ndarray:
        """Evaluate the transfer functions at complex frequencies s [1/s]: (stations, outputs, s)."""
        return self.direct[..., None] + self.residues @ (1 / (s - self.poles[:, None]))

    def mean_square(self, spectrum: PowerSpectrum, order: int = 0) -> np.ndarray:
        """Compute the mean square of each output (order 0) or of its time derivative (order 2).

        The order is the power of the angular frequency by which the spectral density is multiplied.
        """
        by_pole, constant = self._parts(spectrum, order)
        return constant + 2 * np.real(by_pole).sum(axis=-1)

    def rounding(self, spectrum: PowerSpectrum, order: int = 0) -> np.ndarray:
        """Compute the rounding errors of `mean_square`, whose terms may cancel."""
        by_pole, constant = self._parts(spectrum, order)
        return _EPSILON * (constant + 2 * np.abs(by_pole).sum(axis=-1))

    def _parts(self, spectrum: PowerSpectrum, order: int) -> tuple[np.ndarray, np.ndarray]:
        """Compute the parts of the mean square: terms (S, K, m), and a constant (S, K).

        The mean square is the constant plus twice the real part of the sum of the terms over the m poles.
        """
        between = 1 / (-self.poles - np.conj(self.poles)[:, None])
        conjugate = np.conj(self.direct)[..., None] + np.conj(self.residues) @ between
        integrals = pole_integrals(spectrum, self._mu, self.shift, order)
        by_pole = self.residues * conjugate * (integrals.by_pole / (2j * np.pi))
        return by_pole, np.abs(self.direct) ** 2 * integrals.whole

    def together_with(self, other: LoadFractions, spectrum: PowerSpectrum) -> np.ndarray:
        """Integrate the input's spectral density times H conj(H') over frequency: (stations, outputs).

        H are these transfer functions, H' those of `other`.
        """
        mu, conjugate = self._mu, np.conj(other._mu)
        r, d = self.residues / (2j * np.pi), self.direct
        other_r, other_d = np.conj(other.residues / (2j * np.pi)), np.conj(other.direct)
        between = 1 / (mu - conjugate[:, None])
        at_own = r * (other_d[..., None] + other_r @ between)
        at_other = other_r * (d[..., None] - r @ between.T)
        of_own, of_other = (pole_integrals(spectrum, each) for each in (mu, conjugate))
        return d * other_d * of_own.whole + at_own @ of_own.by_pole + at_other @ of_other.by_pole

    @property
    def _mu(self) -> np.ndarray:
        """Poles as complex frequencies of the input [Hz]: p_k / (2 pi i), minus the shift."""
        return self.poles / (2j * np.pi) - self.shift


@dataclass(frozen=True)
class LinearLoads:
    """Loads at stations in a linear model: transfer functions from an excitation, and steady loads.

    Parameters
    ----------
    model : ModelAtSpeed
        Linear model at a steady speed.
    stations : SpanStations
        The stations, S of them.
    outputs : StationOutputs
        The K outputs at each station.
    """

    model: ModelAtSpeed
    stations: SpanStations
    outputs: StationOutputs

    def fractions(self, excitation: Excitation) -> tuple[LoadFractions, ...]:
        """Compute the transfer functions from an excitation, one for each harmonic of the rotation.

        Raises
        ------
        InvalidValue
            If the excitation does not load the beam, or a mode is not damped.
        """
        free = damped_motion(self.model)
        position, velocity = self._at_speed
        found = []
        for harmonic, drive in self.model.drives(excitation).items():
            q = residues(free, drive.load)
            seen = position @ q + (velocity @ q) * free.finite_poles
            shift = harmonic * self.model.speed / _TURN
            found.append(LoadFractions(shift, self._direct(drive), seen, free.finite_poles))
        return (*found,)

    def _direct(self, drive: HarmonicDrive) -> np.ndarray:
        """Compute the direct terms d of the outputs at stations, which follow the input without delay.

        An acceleration of the root acts through the inertia of the beam.  A force acts directly, and through
        the inertia of the beam that it accelerates.
        """
        rows, by_force = self._rows
        total = _sum(drive.accelerations, rows.load, np.zeros(rows.shape))
        if drive.force is None:
            return total
        (at, direction), planes = drive.force, self.model.equations.planes
        xi, inboard = self.stations.xi, self.stations.inboard
        outboard = (xi < at) | (inboard & (xi == at))
        # Loads due to a unit force on the part outboard of each station.
        loads = np.zeros((len(xi), self.outputs.matrix.shape[2]))
        loads[:, 1 + direction] = outboard
        loads[:, 1 + planes + direction] = outboard * (at - xi) * self.model.scene.beam.length
        return total + by_force @ drive.load + np.einsum("spk,sk->sp", self.outputs.matrix, loads)

    def steady(self) -> tuple[np.ndarray, np.ndarray]:
        """Compute the outputs in steady rotation, and the amplitudes of their variation due to gravity.

        Returns
        -------
        constant, amplitude : ndarray, shape (stations, outputs)
            Outputs; at rest, gravity is included in the constant outputs, at the angle of rotation 0.
        """
        (rows, _), model, vectors = self._rows, self.model, self.model.equations.vectors
        position, velocity = self._at_speed
        zero, unloaded = np.zeros(rows.shape), np.zeros(model.equations.size)
        static = np.linalg.solve(model.K, _sum(self._values(vectors), vectors, unloaded))
        constant, amplitude = position @ static + _sum(self._values(rows.load), rows.load, zero), zero
        accelerations = BaseMotion("n2").accelerations(model.scene.mount, model.speed)
        for harmonic, given in accelerations.items() if model.scene.gravity else ():
            s = 1j * harmonic * model.speed
            q = np.linalg.solve(s**2 * model.M + s * model.C + model.K, _sum(given, vectors, unloaded))
            moved = position @ q + s * (velocity @ q)
            output = model.scene.gravity * (_sum(given, rows.load, zero) + moved)
            if harmonic:
                amplitude = amplitude + np.abs(output)
            else:
                constant = constant + np.real(output)
        return constant, amplitude

    @cached_property
    def _rows(self) -> tuple[LoadRows, np.ndarray]:
        """Outputs as linear functions of coordinates and velocities, and outputs per unit generalized force.

        The equations of motion were used to eliminate the accelerations.
        """
        model, n = self.model, self.model.equations.size
        rows = span_rows(model.scene, model.discretization, model.equations, self.stations)
        acceleration = rows.acceleration.get("unity", np.zeros((*rows.shape, n)))
        by_force = np.einsum("spk,skn->spn", self.outputs.matrix, per_force(model.M, acceleration))
        return rows.in_motion(model.equations).through(self.outputs.matrix), by_force

    @cached_property
    def _at_speed(self) -> tuple[np.ndarray, np.ndarray]:
        """Outputs at each station in steady rotation: per unit of each coordinate, and of each velocity."""
        rows, _ = self._rows
        zero = np.zeros((*rows.shape, self.model.equations.size))
        position, velocity = (_sum(self._values(row), row, zero) for row in (rows.position, rows.velocity))
        return position, velocity

    def _values(self, by_quantity: Mapping[Quantity, np.ndarray]) -> dict[Quantity, np.ndarray]:
        """Evaluate the quantities of the root's motion named by the keys, for steady rotation."""
        root = root_motion(self.model.scene.mount, MotionSample.steady(self.model.speed))
        return {name: getattr(root, name) for name in by_quantity}


def _sum(
    values: Mapping[Quantity, Any], by_quantity: Mapping[Quantity, np.ndarray], zero: np.ndarray
) -> np.ndarray:
    """Sum the arrays of the quantities of the root's motion, each times its value, and `zero`."""
    return sum((value * by_quantity[name] for name, value in values.items() if name in by_quantity), zero)


def largest_in_turn(fractions: Sequence[LoadFractions], spectrum: PowerSpectrum) -> np.ndarray:
    """Compute the mean square of each output at the angle of rotation at which it is largest."""
    total = sum(each.mean_square(spectrum) for each in fractions)
    if len(fractions) == 1:
        return np.asarray(total)
    forward, backward = sorted(fractions, key=lambda each: -each.shift)
    return total + 2 * np.abs(forward.together_with(backward, spectrum))


# Results of the statistics --------------------------------------------------------------------------


@dataclass(frozen=True)
class RandomStatistics:
    """Statistics of K outputs at S stations; K counts the components of all load quantities together.

    Parameters
    ----------
    mean : ndarray, shape (S, K)
        Constant part, due to the steady rotation [unit of the output].
    gravity : ndarray, shape (S, K)
        Amplitude of the variation due to gravity during a turn [same unit].
    rms : ndarray, shape (S, K)
        Root mean square of the random part, averaged over time and over the angle of rotation [same unit].
    rms_in_turn : ndarray, shape (S, K)
        Root mean square of the random part at the angle of rotation at which it is largest [same unit].
    rate_rms : ndarray, shape (S, K)
        Root mean square of the time derivative of the random part [same unit / s].

    References
    ----------
    Rice (1944), Mathematical analysis of random noise; Davenport (1964), Proceedings of the Institution of
    Civil Engineers 28, 187-196.

    Examples
    --------
    >>> scene = bd.load_scene("examples/harvester_on_road.toml")
    >>> found = bd.random_loads(scene, 83.3, bd.RoadRoughness("C", highest=10.0), at=[0.0])
    >>> type(found.statistics).__name__
    'RandomStatistics'
    """

    mean: np.ndarray
    gravity: np.ndarray
    rms: np.ndarray
    rms_in_turn: np.ndarray
    rate_rms: np.ndarray

    @property
    def crossings(self) -> np.ndarray:
        """Rate of upward zero crossings of each output's random part [1/s]; 0 where there is none."""
        moving = self.rms > 0
        return np.where(moving, self.rate_rms, 0.0) / (_TURN * np.where(moving, self.rms, 1.0))

    def largest(self, factor: Callable[[np.ndarray], np.ndarray], duration: float) -> np.ndarray:
        """Compute the expected largest magnitudes in a duration [s].

        `factor` computes peak factors (largest value divided by rms value) from numbers of zero crossings.
        """
        count = np.maximum(2 * self.crossings * duration, _LEAST)
        return np.abs(self.mean) + self.gravity + factor(count) * self.rms_in_turn


def expected_factor(count: np.ndarray) -> np.ndarray:
    """Compute the mean peak factor (largest value over rms value) in a number of zero crossings."""
    root = np.sqrt(2 * np.log(count))
    return root + np.euler_gamma / root


def safe_factor(count: np.ndarray, probability: float) -> np.ndarray:
    """Compute a quantile of the peak factor (largest value over rms value) in a number of zero crossings.

    The largest value does not exceed the quantile times the rms value with the given probability.
    """
    return np.sqrt(2 * np.log(np.maximum(count / -math.log(probability), 1.0)))


@dataclass(frozen=True)
class InputAndOutputs:
    """A random input, and the outputs along the span whose statistics are requested."""

    drive: Excitation
    spectrum: PowerSpectrum
    stations: SpanStations
    outputs: StationOutputs

    def fractions(self, model: ModelAtSpeed) -> tuple[LoadFractions, ...]:
        """Compute transfer functions from the input to the outputs, one for each harmonic of rotation."""
        return LinearLoads(model, self.stations, self.outputs).fractions(self.drive)

    def statistics(self, model: ModelAtSpeed) -> np.ndarray:
        """Compute the five fields of `RandomStatistics` for K outputs at S stations: shape (5, S, K)."""
        check_stable(model)
        fractions, spectrum = self.fractions(model), self.spectrum
        mean, gravity = LinearLoads(model, self.stations, self.outputs).steady()
        squares = [sum(each.mean_square(spectrum, order) for each in fractions) for order in (0, 2)]
        most = largest_in_turn(fractions, spectrum)
        # Mean squares may be negative due to rounding.
        rms, rate, in_turn = (np.sqrt(np.maximum(square, 0.0)) for square in (*squares, most))
        return np.stack([mean, gravity, rms, in_turn, rate])

    def refine(
        self,
        loaded: Scene,
        speed: float,
        modes: int | str,
        tolerance: float,
        discretization: DiscretizationChoice,
    ) -> Refined:
        """Compute `statistics` and errors (nan if unknown), with as many modes as the tolerance needs."""
        few = self.statistics(model_of_few_modes(loaded, speed, _FIRST_MODES, discretization))
        # Largest value along the span, shape (5, 1, K).
        size = np.nan_to_num(np.abs(few)).max(axis=1, keepdims=True)
        size = np.where(size > 0, size, 1.0) * np.array([1, 1, 1, 1, _OF_RATES])[:, None, None]

        def relative(model: ModelAtSpeed) -> np.ndarray:
            return np.nan_to_num(self.statistics(model)) / size

        top = _TURN * highest_frequency(self.spectrum) + abs(speed)
        refined = evaluate_accurately(loaded, speed, top, modes, tolerance, discretization, relative, 0)
        size = size * np.where(np.isnan(few), np.nan, 1.0)
        value = refined.value * size
        rounding = _rounding(self.fractions(refined.model), RandomStatistics(*value), self.spectrum)
        return replace(refined, value=value, error=refined.error * size + rounding)


def _rounding(
    fractions: Sequence[LoadFractions], found: RandomStatistics, spectrum: PowerSpectrum
) -> np.ndarray:
    """Estimate the rounding errors of the five fields of `RandomStatistics`: (5, S stations, K outputs)."""
    value, rate = (sum(each.rounding(spectrum, order) for each in fractions) for order in (0, 2))
    pairs = (found.rms, value), (found.rms_in_turn, 2 * value), (found.rate_rms, rate)
    none = np.zeros_like(found.mean)
    return np.stack([none, none, *(np.hypot(rms, np.sqrt(square)) - rms for rms, square in pairs)])


def error_of_largest(found: RandomStatistics, error: RandomStatistics, duration: float) -> np.ndarray:
    """Estimate errors of the expected largest magnitudes from the errors of all statistics."""
    total = found.rms + error.rms
    with np.errstate(invalid="ignore"):
        less = np.where(np.isfinite(total) & (total > 0), found.rms**2 / np.where(total > 0, total, 1.0), 0.0)
    raised = RandomStatistics(
        np.abs(found.mean) + error.mean,
        found.gravity + error.gravity,
        less,
        found.rms_in_turn + error.rms_in_turn,
        found.rate_rms + error.rate_rms,
    )
    return raised.largest(expected_factor, duration) - found.largest(expected_factor, duration)
