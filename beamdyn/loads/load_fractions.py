"""Transfer functions from a random input to loads along the span, by partial fractions.

The rows of `beamdyn.loads.load_rows` give the loads by the state, and by the input itself, which acts on the
part outboard of a cut at once: L = d u + P q + V q'.  With the residues q_k of the coordinates at the poles
p_k, H(s) = d + sum (P + p_k V) q_k / (s - p_k).

An input of a fixed direction acts on a turning beam by two harmonics, H+ at f + n and H- at f - n.  At the
angle theta of rotation, which is 0 at the time 0, the mean square is

    int (|H+|^2 + |H-|^2) S df + 2 Re exp(2 i theta) int H+ conj(H-) S df,

whose mean over a turn is the first integral, and whose largest value has the second one's magnitude.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beamdyn.equations.root_motion import root_motion
from beamdyn.linear.inputs_outputs import BaseMotion, Excitation
from beamdyn.linear.mean_square import damped_motion, pole_integrals, residues
from beamdyn.linear.model_at_speed import HarmonicDrive, ModelAtSpeed
from beamdyn.linear.spectra import PowerSpectrum
from beamdyn.loads.load_rows import LoadRows, span_rows
from beamdyn.loads.section_points import StationOutputs
from beamdyn.loads.stations import SpanStations
from beamdyn.scene.motion import MotionSample

_TURN = 2 * np.pi
_EPSILON = 2.0**-48  # rounding of a term, some units of the last digit


@dataclass(frozen=True)
class LoadFractions:
    """Transfer functions H(s) = d + sum r_k / (s - p_k) of outputs at stations, at one harmonic.

    Parameters
    ----------
    shift : float
        Frequency of the response less that of the input [Hz].
    direct : ndarray of complex, shape (S, K)
        d of K outputs at S stations.
    residues : ndarray of complex, shape (S, K, m)
        r_k.
    poles : ndarray of complex, shape (m,)
        p_k [1/s], in the left half-plane.
    """

    shift: float
    direct: np.ndarray
    residues: np.ndarray
    poles: np.ndarray

    def at(self, s: np.ndarray) -> np.ndarray:
        """Evaluate at s [1/s] (F,): shape (S, K, F)."""
        return self.direct[..., None] + self.residues @ (1 / (s - self.poles[:, None]))

    def mean_square(self, spectrum: PowerSpectrum, order: int = 0) -> np.ndarray:
        """Mean square (S, K) of the outputs, or with the order 2 of their rates."""
        by_pole, constant = self._parts(spectrum, order)
        return constant + 2 * np.real(by_pole).sum(axis=-1)

    def rounding(self, spectrum: PowerSpectrum, order: int = 0) -> np.ndarray:
        """Rounding error of `mean_square` (S, K), whose parts may cancel."""
        by_pole, constant = self._parts(spectrum, order)
        return _EPSILON * (constant + 2 * np.abs(by_pole).sum(axis=-1))

    def _parts(self, spectrum: PowerSpectrum, order: int) -> tuple[np.ndarray, np.ndarray]:
        """Terms of the mean square by pole (S, K, m), whose real parts count twice, and its constant term."""
        between = 1 / (-self.poles - np.conj(self.poles)[:, None])
        conjugate = np.conj(self.direct)[..., None] + np.conj(self.residues) @ between
        integrals = pole_integrals(spectrum, self._mu, self.shift, order)
        by_pole = self.residues * conjugate * (integrals.by_pole / (2j * np.pi))
        return by_pole, np.abs(self.direct) ** 2 * integrals.whole

    def together_with(self, other: LoadFractions, spectrum: PowerSpectrum) -> np.ndarray:
        """Integral of H conj(H') S over the frequency of the input, with H' of `other`: shape (S, K)."""
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
        """Poles over the frequency of the input [Hz], shape (m,)."""
        return self.poles / (2j * np.pi) - self.shift


@dataclass(frozen=True)
class LinearLoads:
    """Loads at stations of a linear model: transfer functions from an excitation, and steady loads.

    Parameters
    ----------
    model : ModelAtSpeed
        The model.
    stations : SpanStations
        The stations, S of them.
    outputs : StationOutputs
        The K outputs at each.
    """

    model: ModelAtSpeed
    stations: SpanStations
    outputs: StationOutputs

    def fractions(self, excitation: Excitation) -> tuple[LoadFractions, ...]:
        """Transfer functions from an excitation, one for each harmonic of the rotation.

        Raises
        ------
        InvalidValue
            If the excitation does not load the beam, or a mode is not damped.
        """
        rows, inertia = self._rows
        free = damped_motion(self.model)
        position, velocity = self._at_speed(rows)
        found = []
        for harmonic, drive in self.model.drives(excitation).items():
            q = residues(free, drive.load)
            seen = position @ q + (velocity @ q) * free.poles
            shift = harmonic * self.model.speed / _TURN
            found.append(LoadFractions(shift, self._direct(rows, inertia, drive), seen, free.poles))
        return (*found,)

    def steady(self) -> tuple[np.ndarray, np.ndarray]:
        """Outputs of steady rotation, and amplitudes of their variation by gravity within a turn.

        Returns
        -------
        constant, amplitude : ndarray, shape (S, K)
            At rest gravity counts in the constant outputs, as at the angle of rotation 0.
        """
        rows, _ = self._rows
        root = root_motion(self.model.scene.mount, MotionSample.steady(self.model.speed))
        vectors, position = self.model.equations.vectors, self._at_speed(rows)[0]
        f = sum((getattr(root, name) * vector for name, vector in vectors.items()), np.zeros(self._size))
        constant = position @ np.linalg.solve(self.model.K, f)
        constant = constant + sum(getattr(root, name) * load for name, load in rows.load.items())
        by_harmonic = dict(self._of_gravity(rows))
        return constant + np.real(by_harmonic.pop(0, 0.0)), sum(
            map(np.abs, by_harmonic.values()), np.zeros_like(constant)
        )

    def _of_gravity(self, rows: LoadRows) -> list[tuple[int, np.ndarray]]:
        """Outputs (S, K) of gravity at each harmonic of the rotation."""
        model, vectors = self.model, self.model.equations.vectors
        position, velocity = self._at_speed(rows)
        found = []
        accelerations = BaseMotion("n2").accelerations(model.scene.mount, model.speed)
        for harmonic, given in accelerations.items() if model.scene.gravity else ():
            s = 1j * harmonic * model.speed
            f = sum((a * vectors[name] for name, a in given.items() if name in vectors), np.zeros(self._size))
            q = np.linalg.solve(s**2 * model.M + s * model.C + model.K, f)
            direct = sum((a * rows.load[name] for name, a in given.items() if name in rows.load), 0.0)
            found.append((harmonic, model.scene.gravity * (direct + position @ q + s * (velocity @ q))))
        return found

    @property
    def _size(self) -> int:
        return self.model.equations.size

    @cached_property
    def _rows(self) -> tuple[LoadRows, np.ndarray]:
        """Rows without accelerations, and the outputs (S, K, n) of a unit force on each coordinate."""
        model = self.model
        rows = span_rows(model.scene, model.discretization, model.equations, self.stations)
        acceleration = rows.acceleration.get("unity", np.zeros((*rows.shape, self._size)))
        flat = np.linalg.solve(model.M.T, acceleration.reshape(-1, self._size).T).T
        by_force = np.einsum("spk,skn->spn", self.outputs.matrix, flat.reshape(acceleration.shape))
        return rows.in_motion(model.equations).through(self.outputs.matrix), by_force

    def _at_speed(self, rows: LoadRows) -> tuple[np.ndarray, np.ndarray]:
        """Outputs (S, K, n) by coordinates and velocities, in steady rotation."""
        root = root_motion(self.model.scene.mount, MotionSample.steady(self.model.speed))
        zero = np.zeros((*rows.shape, self._size))
        both = rows.position.items(), rows.velocity.items()
        position, velocity = (sum((getattr(root, name) * row for name, row in each), zero) for each in both)
        return position, velocity

    def _direct(self, rows: LoadRows, by_force: np.ndarray, drive: HarmonicDrive) -> np.ndarray:
        """Outputs (S, K) of a unit input itself, with the accelerations that it causes."""
        given = drive.accelerations.items()
        total = sum((a * rows.load[name] for name, a in given if name in rows.load), np.zeros(rows.shape))
        if drive.force is None:
            return np.asarray(total)
        return total + by_force @ drive.load + self._of_point_force(*drive.force)

    def _of_point_force(self, at: float, direction: int) -> np.ndarray:
        """Outputs (S, K) of a unit force at x/L on the parts outboard of it alone."""
        xi, inboard, planes = self.stations.xi, self.stations.inboard, self.model.equations.planes
        outboard = (xi < at) | (inboard & (xi == at))
        loads = np.zeros((len(xi), 1 + 2 * planes))
        loads[:, 1 + direction] = outboard
        loads[:, 1 + planes + direction] = outboard * (at - xi) * self.model.scene.beam.length
        return np.einsum("spk,sk->sp", self.outputs.matrix, loads)


def largest_in_turn(fractions: Sequence[LoadFractions], spectrum: PowerSpectrum) -> np.ndarray:
    """Mean square (S, K) at the angle of rotation at which it is largest."""
    total = sum(each.mean_square(spectrum) for each in fractions)
    if len(fractions) == 1:
        return np.asarray(total)
    forward, backward = sorted(fractions, key=lambda each: -each.shift)
    return total + 2 * np.abs(forward.together_with(backward, spectrum))
