"""Mean squares of responses to random inputs, by partial fractions of the transfer function.

With H(s) = d + sum r_k / (s - p_k), on the imaginary axis

    |H|^2 = |d|^2 + 2 Re sum c_k / (s - p_k),    c_k = r_k conj(H)(p_k),

where conj(H)(s) = conj(d) + sum conj(r_j) / (-s - conj(p_j)).  So the integral of |H|^2 S over a piece on
which S is analytic is that of S, and those of S / (f - mu_k), mu_k = p_k / (2 pi i).  If mu_k is near
the piece [a, b],

    int S / (f - mu) df = S(mu) log((b - mu) / (a - mu)) + int (S(f) - S(mu)) / (f - mu) df,

whose last integrand is smooth: resonances, however sharp, are integrated in closed form.  The mean square by
white noise is half its density times the sum of the c_k.

Size of the parametric term that linear models leave out: accelerations along the beam vary its stiffness.

A random acceleration a along the beam varies the squared frequency of a mode by the fraction xi = kappa a,
kappa = |phi K_GA phi| / omega^2 for its shape phi of unit mass.  For an oscillator of the damping ratio zeta,

    q'' + 2 zeta omega q' + omega^2 (1 + xi) q = w,

the equations of the second moments give, with xi and w of a wide band, the ratio of variances with and
without xi

    1 / (1 - x),    x = omega G(2 f) / (8 zeta),

with the one-sided density G of xi at twice the natural frequency (stochastic averaging: Roberts and Spanos
(1986), International Journal of Non-Linear Mechanics 21, 111-134).  At x = 1 the mean square grows without
limit.  For a narrow band, or if xi depends on w, the result is an order of magnitude.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.linear.free_motion import FreeMotion
from beamdyn.linear.inputs_outputs import BaseMotion, Excitation, Observation, StrainAtRoot
from beamdyn.linear.model_at_speed import HarmonicDrive, ModelAtSpeed
from beamdyn.linear.spectra import PowerSpectrum, SpectrumPiece
from beamdyn.scene.scene import Scene

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(16)
# Distance of a pole from a piece of the spectrum, divided by the piece's length, below which the pole is
# integrated separately.
_NEAR = 1.5
_UNDAMPED = 1e-12  # ratio of a pole's decay rate to its size below which the decay counts as rounding


@dataclass(frozen=True)
class PartialFractions:
    """A transfer function as partial fractions, H(s) = d + sum r_k / (s - p_k).

    Parameters
    ----------
    direct : complex
        Direct term d.
    residues, poles : ndarray of complex, shape (m,)
        Residues r_k, and poles p_k [1/s] in the left half-plane.
    """

    direct: complex
    residues: np.ndarray
    poles: np.ndarray

    def __call__(self, s: np.ndarray) -> np.ndarray:
        """Evaluate the transfer function at complex frequencies s [1/s]."""
        return self.direct + (self.residues / (np.asarray(s)[..., None] - self.poles)).sum(axis=-1)

    @property
    def of_square(self) -> np.ndarray:
        """Coefficients of the m poles in the partial fractions of the squared magnitude |H|^2."""
        between = -self.poles[:, None] - np.conj(self.poles)
        return self.residues * (np.conj(self.direct) + (np.conj(self.residues) / between).sum(axis=1))

    def through_filter(self, delay: float) -> PartialFractions:
        """Return the partial fractions of the transfer function divided by 1 + s delay, with a delay [s]."""
        pole = -1 / delay
        passed = self.residues / (1 + self.poles * delay)
        residue = complex(self(np.array(pole)) / delay)
        return PartialFractions(0.0, np.append(passed, residue), np.append(self.poles, pole))

    def mean_square(self, spectrum: PowerSpectrum, shift: float = 0.0) -> float:
        """Integrate a one-sided density S(f) times |H(f + shift)|^2 over f [Hz]; H: transfer function."""
        integrals = pole_integrals(spectrum, self.poles / (2j * np.pi) - shift)
        of_poles = (self.of_square / (2j * np.pi)) @ integrals.by_pole
        return abs(self.direct) ** 2 * integrals.whole + 2 * float(np.real(of_poles))

    def mean_square_of_white(self, density: float) -> float:
        """Compute the mean square for a constant one-sided density at all frequencies.

        The direct term is left out, as it would make the mean square infinite.
        """
        proper = PartialFractions(0.0, self.residues, self.poles)
        return density / 2 * float(np.real(proper.of_square.sum()))


@dataclass(frozen=True)
class PoleIntegrals:
    """Integrals over frequency f of a density S times a weight g, undivided and divided by each f - mu_k.

    Parameters
    ----------
    whole : float
        Integral of g S over the spectrum.
    by_pole : ndarray of complex, shape (m,)
        Integrals of g S / (f - mu_k).
    """

    whole: float
    by_pole: np.ndarray


def pole_integrals(
    spectrum: PowerSpectrum, mu: np.ndarray, shift: float = 0.0, order: int = 0
) -> PoleIntegrals:
    """Integrate a density times the weight (2 pi (f + shift))^order, undivided and divided by each f - mu_k.

    Parameters
    ----------
    spectrum : PowerSpectrum
        The density.
    mu : ndarray of complex, shape (m,)
        Poles [Hz], none of them real.
    shift : float
        Frequency of the response minus that of the input [Hz].
    order : int
        0 for mean squares of the response, 2 for mean squares of its rate.
    """

    def weighted(piece: SpectrumPiece, f: np.ndarray) -> np.ndarray:
        return piece(f) * (2 * np.pi * (f + shift)) ** order

    whole, by_pole = 0.0, np.zeros(len(mu), dtype=complex)
    for piece in spectrum.pieces():
        start, end = piece.divided()
        half = (end - start) / 2
        f, w = (start + end) / 2 + half * _POINTS, half * _WEIGHTS
        S = weighted(piece, f)
        near = np.abs(mu - np.clip(np.real(mu), start, end)) < _NEAR * 2 * half
        # The density at each pole that is near.  A pole far from all parts of the piece is replaced by the
        # end of the piece, as a power law may overflow there.
        at_pole = near * weighted(piece, np.where(near.any(axis=0), mu, piece.end))
        smooth = (S[..., None] - at_pole[:, None]) / (f[..., None] - mu)
        whole += float((w * S).sum())
        by_pole += np.einsum("pf,pfm->m", w, smooth)
        by_pole += (at_pole * np.log((end - mu) / (start - mu))).sum(axis=0)
    return PoleIntegrals(whole, by_pole)


def check_damped(scene: Scene) -> None:
    """Refuse a scene without damping, because the mean square of its response grows without limit."""
    if not scene.is_damped:
        raise _undamped(scene)


def _undamped(scene: Scene) -> InvalidValue:
    bound = "a mode is not damped, and its mean square grows without limit"
    return InvalidValue("damping_ratio", scene.damping_ratio, bound, "such as 0.01")


def damped_motion(model: ModelAtSpeed) -> FreeMotion:
    """Compute the free motion of a model in which every mode decays.

    Raises
    ------
    InvalidValue
        If a mode is not damped, as its mean square is not finite.
    """
    inverse = model.free_motion.inverse_poles
    if (np.real(inverse) > -_UNDAMPED * np.abs(inverse)).any():
        raise _undamped(model.scene)
    return model.free_motion


def residues(free: FreeMotion, load: np.ndarray) -> np.ndarray:
    """Compute residues of the coordinates' response to a load at the finite poles (columns)."""
    poles = free.finite_poles
    finite = slice(0, len(poles))
    return -poles * free.shapes[:, finite] * free.shares(load[:, None])[finite, 0]


def partial_fractions(
    model: ModelAtSpeed, drive: HarmonicDrive, observation: Observation
) -> PartialFractions:
    """Expand the transfer function from one load to one output in partial fractions.

    The contribution of modes left out to an acceleration, s^2 times their static deflection, is not included.

    Raises
    ------
    InvalidValue
        If a mode is not damped, as its mean square is not finite.
    """
    free, own = damped_motion(model), model.mechanical
    q, poles = residues(free, drive.load), free.finite_poles
    pushed = np.linalg.solve(model.M[own, own], drive.load[own])
    row, extra = model.row(observation), model.residual(observation, drive)
    seen = row.position @ q + poles * (row.velocity @ q) + poles**2 * (row.acceleration @ q)
    fractions = PartialFractions(complex(row.acceleration[own] @ pushed + extra[0]), seen, poles)
    delay = model.scene.damping.stiffness_factor
    filtered = isinstance(observation, StrainAtRoot) and delay
    return fractions.through_filter(delay) if filtered else fractions


# Size of the parametric term that linear models leave out -----------------------------------------


_LARGE = 0.01  # relative change of the response by a neglected effect, above which a warning is given


@dataclass(frozen=True)
class ParametricTerm:
    """Size of the parametric term that linear models leave out: stiffness varied by axial acceleration.

    Parameters
    ----------
    stiffness_variation : float
        Root mean square of the random variation of the squared lowest frequency, relative to it.
    by_gravity : float
        Relative amplitude of the variation of the squared lowest frequency due to gravity as the beam turns.
    rms_change : float
        Estimated relative change of the root mean square of the lowest mode by the random variation; inf
        where it would grow without limit.

    References
    ----------
    Roberts and Spanos (1986), International Journal of Non-Linear Mechanics 21, 111-134.

    Examples
    --------
    >>> scene = bd.load_scene("examples/harvester_on_road.toml")
    >>> found = bd.random_response(scene, 83.3, bd.RoadRoughness("C", highest=10.0))
    >>> found.parametric.stiffness_variation < 0.1
    True
    """

    stiffness_variation: float
    by_gravity: float
    rms_change: float

    def warnings(self) -> Iterator[str]:
        """Yield a warning for each neglected variation of stiffness that is not small."""
        if self.rms_change > _LARGE:
            size = "without limit" if math.isinf(self.rms_change) else f"by some {self.rms_change:.0%}"
            yield f"the parametric term that is left out would raise the root mean square {size}"
        if self.by_gravity > _LARGE:
            yield (
                f"gravity along the beam varies the lowest squared frequency by {self.by_gravity:.1%} "
                "within a turn; the linear model leaves this out"
            )


def parametric_term(
    model: ModelAtSpeed, excitation: Excitation, spectrum: PowerSpectrum | float
) -> ParametricTerm:
    """Estimate the size of the parametric term for the lowest mode.

    Parameters
    ----------
    model : ModelAtSpeed
        The linear model.
    excitation : BaseMotion or PointForce
        The excitation of the beam.
    spectrum : PowerSpectrum or float
        One-sided density of the input; a number is that of white noise.
    """
    K_GA = model.equations.matrices[0].get("root_axial")
    if K_GA is None:
        return ParametricTerm(0.0, 0.0, 0.0)
    own = model.mechanical
    squared, shapes = scipy.linalg.eigh(model.K[own, own], model.M[own, own])
    kappa = abs(shapes[:, 0] @ K_GA[own, own] @ shapes[:, 0]) / squared[0]
    of_gravity = BaseMotion("n2").accelerations(model.scene.mount, model.speed).values()
    weight = abs(model.scene.gravity) * sum(abs(given.get("root_axial", 0.0)) for given in of_gravity)
    along = {
        h: abs(given.get("root_axial", 0.0)) ** 2
        for h, given in excitation.accelerations(model.scene.mount, model.speed).items()
    }
    if not isinstance(spectrum, PowerSpectrum):
        variation, density = (math.inf if any(along.values()) else 0.0), sum(along.values()) * spectrum
    else:
        variation = kappa * math.sqrt(sum(along.values())) * spectrum.rms
        twice = 2 * math.sqrt(squared[0]) / (2 * math.pi)
        turns = model.speed / (2 * math.pi)
        density = sum(
            share * float(spectrum.at(np.array(abs(twice - h * turns)))) for h, share in along.items()
        )
    x = _excess(model, squared[0], shapes[:, 0], kappa**2 * density)
    change = math.inf if x >= 1 else 1 / math.sqrt(1 - x) - 1
    return ParametricTerm(float(variation), float(kappa * weight), change)


def _excess(model: ModelAtSpeed, squared: float, shape: np.ndarray, density: float) -> float:
    """Compute x of a mode with `squared` frequency and `shape`, for the `density` of xi (see module).

    Varying stiffness multiplies the mode's variance by 1/(1 - x).
    """
    if not density:
        return 0.0
    omega = math.sqrt(squared)
    zeta = float(shape @ model.C[model.mechanical, model.mechanical] @ shape) / (2 * omega)
    return omega * density / (8 * zeta) if zeta > 0 else math.inf
