"""Mean squares of responses to random inputs, by partial fractions of the transfer function.

With H(s) = d + sum r_k / (s - p_k), on the imaginary axis

    |H|^2 = |d|^2 + 2 Re sum c_k / (s - p_k),    c_k = r_k conj(H)(p_k),

where conj(H)(s) = conj(d) + sum conj(r_j) / (-s - conj(p_j)).  So the integral of |H|^2 S over a piece on
which S is analytic is that of S, and those of S / (f - mu_k), mu_k = p_k / (2 pi i).  Where mu_k is near,

    int S / (f - mu) df = S(mu) log((b - mu) / (a - mu)) + int (S(f) - S(mu)) / (f - mu) df,

whose last integrand is smooth: resonances, however sharp, are integrated in closed form.  The mean square by
white noise is half its density times the sum of the c_k.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from beamdyn.common.checks import InvalidValue
from beamdyn.linear_models.model_at_speed import HarmonicDrive, ModelAtSpeed
from beamdyn.linear_models.observations import Observation, StrainAtRoot
from beamdyn.linear_models.spectra import PowerSpectrum

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_NEAR = 1.5  # distance of a pole from a piece, over its length, below which it is integrated apart
_UNDAMPED = 1e-12  # decay rate of a pole over its size, that is rounding


@dataclass(frozen=True)
class PartialFractions:
    """A transfer function H(s) = d + sum r_k / (s - p_k).

    Parameters
    ----------
    direct : complex
        d.
    residues, poles : ndarray of complex, shape (m,)
        r_k, and p_k [1/s], in the left half-plane.
    """

    direct: complex
    residues: np.ndarray
    poles: np.ndarray

    def __call__(self, s: np.ndarray) -> np.ndarray:
        """Evaluate at s [1/s]."""
        return self.direct + (self.residues / (np.asarray(s)[..., None] - self.poles)).sum(axis=-1)

    @property
    def of_square(self) -> np.ndarray:
        """Coefficients c_k (m,) of |H|^2."""
        between = -self.poles[:, None] - np.conj(self.poles)
        return self.residues * (np.conj(self.direct) + (np.conj(self.residues) / between).sum(axis=1))

    def through_filter(self, delay: float) -> PartialFractions:
        """The same divided by 1 + s delay."""
        pole = -1 / delay
        passed = self.residues / (1 + self.poles * delay)
        residue = complex(self(np.array(pole)) / delay)
        return PartialFractions(0.0, np.append(passed, residue), np.append(self.poles, pole))

    def mean_square(self, spectrum: PowerSpectrum, shift: float = 0.0) -> float:
        """Integral over f of a one-sided density times |H|^2 at f plus a shift [Hz]."""
        mu, c = self.poles / (2j * np.pi) - shift, self.of_square / (2j * np.pi)
        total = 0.0
        for piece in (part for whole in spectrum.pieces() for part in whole.divided()):
            half = (piece.end - piece.start) / 2
            f = (piece.start + piece.end) / 2 + half * _POINTS
            S, w = piece(f), half * _WEIGHTS
            gap = np.abs(mu - np.clip(mu.real, piece.start, piece.end))
            near = gap < _NEAR * 2 * half
            total += abs(self.direct) ** 2 * float(w @ S)
            total += 2 * float(np.real(((w * S) @ (1 / (f[:, None] - mu[~near]))) @ c[~near]))
            at_pole = piece(mu[near])
            smooth = w @ ((S[:, None] - at_pole) / (f[:, None] - mu[near]))
            closed = at_pole * np.log((piece.end - mu[near]) / (piece.start - mu[near]))
            total += 2 * float(np.real((smooth + closed) @ c[near]))
        return total

    def mean_square_of_white(self, density: float) -> float:
        """Mean square by white noise of a one-sided density at all frequencies, without d."""
        proper = PartialFractions(0.0, self.residues, self.poles)
        return density / 2 * float(np.real(proper.of_square.sum()))


def partial_fractions(
    model: ModelAtSpeed, drive: HarmonicDrive, observation: Observation
) -> PartialFractions:
    """Expand the transfer function of one drive.

    What an acceleration gains by the modes left out, s^2 times their static deflection, is not in it.

    Raises
    ------
    InvalidValue
        If a mode is not damped: its mean square is not finite.
    """
    M, C, K, n = model.M, model.C, model.K, model.equations.size
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
    poles, vectors = scipy.linalg.eig(A)
    if (poles.real > -_UNDAMPED * np.abs(poles)).any():
        bound = "a mode is not damped, and its mean square grows without limit"
        raise InvalidValue("damping_ratio", model.scene.damping_ratio, bound, "such as 0.01")
    pushed = np.linalg.solve(M, drive.load)
    shares = np.linalg.solve(vectors, np.concatenate([np.zeros(n), pushed]))
    row, extra = model.row(observation), model.residual(observation, drive)
    q = vectors[:n] * shares
    residues = row.position @ q + poles * (row.velocity @ q) + poles**2 * (row.acceleration @ q)
    fractions = PartialFractions(complex(row.acceleration @ pushed + extra[0]), residues, poles)
    delay = model.scene.damping.stiffness_factor
    filtered = isinstance(observation, StrainAtRoot) and delay
    return fractions.through_filter(delay) if filtered else fractions
