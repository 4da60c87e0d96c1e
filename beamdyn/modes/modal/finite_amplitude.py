"""Free vibration of small but finite amplitude, of a beam of any deflection about its equilibrium.

A free vibration x = eps w + eps^2 z of an undamped beam, w = Re(v exp(i tau)) a mode, has the angular
frequency omega + eps^2 omega_2 (Lindstedt and Poincare).  The forces that are even in w give the steady part
and the second harmonic z, the odd ones omega_2 by the condition that they do no work on the mode.  All forces
are those of the full equations at a small eps, from two of which the limit eps = 0 follows.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beamdyn.equations.elastica import DeflectedState
from beamdyn.equations.root_motion import RootMotion, root_motion
from beamdyn.modes.modal.deflected import DeflectedSolver
from beamdyn.modes.modal.model import Model
from beamdyn.scene.motion import MotionSample

SMALL = 0.02  # amplitude of the tip over the length, and half of it
_SAMPLES = 16  # of a period: harmonics up to the seventh are apart
_RESONANT = 1e-3  # of the dynamic stiffness's condition, below which a second harmonic is a mode


@dataclass(frozen=True)
class FreeVibration:
    """Vibration of a mode about an equilibrium.

    Parameters
    ----------
    state : DeflectedState
        The equilibrium.
    speed, omega : float
        Speed, and angular frequency of the mode [rad/s].
    vector : ndarray of complex, shape (n,)
        The mode, for which the tip moves by the length of the beam.
    """

    state: DeflectedState
    speed: float
    omega: float
    vector: np.ndarray

    @classmethod
    def of(cls, model: Model, speed: float, mode: int) -> FreeVibration:
        """Mode of a number about the equilibrium of a model."""
        solver = model.solver
        assert isinstance(solver, DeflectedSolver)
        found = solver.solve(np.array([speed]), mode)
        state = solver.elastica.at(solver.equilibria(np.array([speed]))[0])
        v = found.vector[0][:, mode - 1].astype(complex)
        angles, tip = state.elastica.angles, state.elastica.points.tip
        along, across = tip(-state.sin * angles) @ v, tip(state.cos * angles) @ v
        size = (abs(across + 1j * along) + abs(across - 1j * along)) / 2
        return cls(state, speed, float(found.eigenvalue[0, mode - 1].imag), v * state.elastica.length / size)

    def coefficient(self, small: float) -> float:
        """Relative change of the frequency over the squared relative amplitude, extrapolated to none."""
        rough, fine = (self._shift(eps) for eps in (small, small / 2))
        return (4 * fine - rough) / (3 * self.omega)

    def warnings(self) -> list[str]:
        """Say where the second harmonic is near a mode, which then vibrates too."""
        values = np.abs(np.linalg.eigvals(np.linalg.solve(self._dynamic(0), self._dynamic(2))))
        near = values.min() < _RESONANT * 3  # 3: of the mode itself, |1 - 2^2|
        return ["twice the frequency is near that of another mode: the two exchange energy"] if near else []

    def _dynamic(self, harmonic: int) -> np.ndarray:
        """Dynamic stiffness (n, n) at a multiple of the frequency."""
        state, w = self.state, harmonic * self.omega
        return self._stiffness + 1j * w * self.speed * state.gyroscopic - w**2 * state.mass

    @property
    def _stiffness(self) -> np.ndarray:
        pencil = self.state.linearized().steady()
        return pencil.K0 + self.speed**2 * pencil.K2

    def _shift(self, eps: float) -> float:
        """Change of the angular frequency over eps^2 [rad/s]."""
        v, state = self.vector, self.state
        even = (self._forces({1: eps * v}) + self._forces({1: -eps * v})) / (2 * eps**2)
        z = {h: -np.linalg.solve(self._dynamic(h), _harmonic(even, h)) for h in (0, 2)}
        z = {h: eps**2 * x for h, x in z.items()}
        odd = (self._forces({1: eps * v} | z) - self._forces({1: -eps * v} | z)) / (2 * eps**3)
        slope = 2 * self.omega * state.mass - 1j * self.speed * state.gyroscopic
        return float(np.real(v.conj() @ _harmonic(odd, 1)) / np.real(v.conj() @ slope @ v))

    def _forces(self, harmonics: dict[int, np.ndarray]) -> np.ndarray:
        """Residual (_SAMPLES, n) over a period of a motion with given harmonics about the equilibrium."""
        phase = 2 * np.pi * np.arange(_SAMPLES) / _SAMPLES
        waves = {h: np.exp(1j * h * phase)[:, None] * x for h, x in harmonics.items()}
        q, rate, acceleration = (
            np.real(np.sum([(1j * h * self.omega) ** k * wave for h, wave in waves.items()], axis=0))
            for k in range(3)
        )
        elastica = self.state.elastica
        return elastica.at(self.state.q + q).work(rate, acceleration, self._root)

    @property
    def _root(self) -> RootMotion:
        sample = MotionSample.steady(np.full(_SAMPLES, self.speed))
        return root_motion(self.state.elastica.linear.mount, sample)


def _harmonic(samples: np.ndarray, harmonic: int) -> np.ndarray:
    """Complex amplitude (n,) of a harmonic of samples (_SAMPLES, n) over a period."""
    return np.fft.fft(samples, axis=0)[harmonic] * (2 if harmonic else 1) / _SAMPLES
