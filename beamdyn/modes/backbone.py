"""Backbone curve: frequency over amplitude, to first order, for a beam about its equilibrium.

A free vibration x = eps w + eps^2 z of an undamped beam, w = Re(v exp(i tau)) a mode, has the angular
frequency omega + eps^2 omega_2 (Lindstedt and Poincare).  The forces that are even in w give z, which has a
constant part and a second harmonic; the odd forces give omega_2, by the condition that they do no work on the
mode.  All forces are those of the full equations at small amplitudes, and results at two amplitudes give the
limit eps = 0.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from time import perf_counter

import numpy as np

from beamdyn.accuracy.refinement import THREE_DISCRETIZATIONS, error_of_finest
from beamdyn.common.inputs.checks import InvalidValue, count, real
from beamdyn.common.numerics import longer_semi_axis
from beamdyn.common.results.one_line import error_at_most, number, warned
from beamdyn.equations.beam_in_space.rotating_beam import BentState
from beamdyn.equations.root_motion import root_motion
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice, solve_to_tolerance
from beamdyn.modes.modal.model import Model
from beamdyn.modes.model_error.effect_choice import plain_physics
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, StatesModelError
from beamdyn.modes.modes import provenance_of
from beamdyn.modes.repeated import left_out_of_frequencies
from beamdyn.scene.motion.base import MotionSample
from beamdyn.scene.scene import Scene, SceneResult, check_scene
from beamdyn.scene.validity import check_speeds, refuse_tip_load


@dataclass(frozen=True)
class Backbone(SceneResult, StatesModelError):
    """Frequency of a free vibration over its amplitude a, to first order: f = f0 (1 + k (a/L)^2).

    `error` is the error of the coefficient k.  `left_out` contains the estimated relative change of the
    frequency f0 by each neglected physical effect, `model_error` the magnitude of the sum of these changes;
    both are computed at first use.

    Parameters
    ----------
    speed : float
        Speed [rad/s].
    mode : int
        Number of the mode, from 1.
    frequency : float
        Frequency f0 of small vibration [Hz].
    coefficient : float
        Nondimensional coefficient k; a is the longer semi-axis of the tip's path, L the length [m].
    error : float
        Estimated absolute error of the nondimensional coefficient.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        Program version, discretization and computing time.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> curve = bd.backbone(bd.Scene(strip, physics=bd.Physics(large_deflection=True)))
    >>> round(curve.coefficient, 4)
    0.0194
    """

    speed: float
    mode: int
    frequency: float
    coefficient: float
    error: float

    def headline(self) -> Iterator[str]:
        """Yield the parts of the one-line summary of the backbone; see `Result.headline`."""
        yield f"mode {self.mode} at {self.say_speed(self.speed)}: {number(self.frequency, 'Hz')}"
        yield f"coefficient {number(self.coefficient)}"
        yield from (error_at_most(self.error), warned(self.warnings))

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """Changes of the small-vibration frequency by each neglected effect, of shape ()."""
        effects = left_out_of_frequencies(self.scene, self.speed, self.mode)
        return replace(effects, unlisted=()).at(self.mode - 1)

    def at(self, amplitude: np.ndarray | float) -> np.ndarray:
        """Compute the frequency [Hz] for given amplitudes of the tip [m]."""
        return self.frequency * (1 + self.coefficient * (np.asarray(amplitude) / self.scene.beam.length) ** 2)


def backbone(
    scene: Scene,
    speed: float = 0.0,
    mode: int = 1,
    discretization: DiscretizationChoice = "ritz",
    tolerance: float | None = None,
) -> Backbone:
    """Compute how the frequency of a mode depends on its amplitude, to first order.

    Parameters
    ----------
    scene : Scene
        The scene; its motion, gravity and damping are not used.  Large deflection is modelled in any case.
    speed : float
        Speed [rad/s].
    mode : int
        Number of the mode, from 1.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.
    tolerance : float, optional
        As for `natural_modes`, for the frequency of small vibration; the error of the coefficient is stated
        separately.

    Returns
    -------
    Backbone

    Raises
    ------
    NoEquilibrium
        If the beam has no equilibrium at this speed (an ArithmeticError).
    ValueError
        If the mode does not oscillate about the equilibrium.

    References
    ----------
    Method of Lindstedt and Poincare (standard): Nayfeh and Mook (1979), Nonlinear Oscillations, chapter 2.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> curve = bd.backbone(bd.Scene(strip, physics=bd.Physics(large_deflection=True)))
    >>> round(curve.frequency, 3), round(float(curve.at(0.005)), 3)  # Hz, small and at 5 mm
    (65.23, 65.243)
    """
    start = perf_counter()
    check_scene(scene)
    refuse_tip_load(scene)
    speeds, mode = np.array([real("speed", speed, "rad/s")]), count("mode", mode)
    check_speeds(speeds, "speed")
    scene = plain_physics(scene.undamped).with_large_deflection()
    solution = solve_to_tolerance(scene, discretization, speeds, mode, tolerance)
    s = solution.eigen.eigenvalue[0, mode - 1]
    if not (s.imag > 0 and s.real <= 0):
        bound = f"this mode does not oscillate about the equilibrium at {speeds[0]:g} rad/s"
        raise InvalidValue("mode", mode, bound, 'another speed or Physics(branch="bent")')
    found = FreeVibration.of(solution.model, float(speeds[0]), mode)
    k, coarse, coarsest = found.coefficient(SMALL / 2), *_coarser_coefficients(solution.model, speeds, mode)
    is_compared = solution.model.coarser.solver.size < solution.model.solver.size and np.isfinite(coarse)
    before = coarse - coarsest if abs(k - coarse) < _STEADY * abs(k) else np.nan
    of_basis = float(error_of_finest(THREE_DISCRETIZATIONS, k - coarse, before, _ROUNDED * abs(k)))
    return Backbone(
        speed=float(speeds[0]),
        mode=mode,
        frequency=float(s.imag / (2 * np.pi)),
        coefficient=k,
        error=_OF_AMPLITUDE * abs(k - found.coefficient(SMALL)) + (of_basis if is_compared else np.inf),
        warnings=tuple(found.warnings()),
        provenance=provenance_of(solution, start),
        scene=scene,
    )


def _coarser_coefficients(model: Model, speeds: np.ndarray, mode: int) -> tuple[float, float]:
    """Compute the coefficient with the two coarser models; nan if a model has no such mode or equilibrium."""
    found = [np.nan, np.nan]
    for k, coarser in enumerate((model.coarser, model.coarser.coarser)):
        with suppress(ArithmeticError, np.linalg.LinAlgError):
            if coarser.solver.size >= mode:
                found[k] = FreeVibration.of(coarser, float(speeds[0]), mode).coefficient(SMALL / 2)
    return found[0], found[1]


# Ratio of the tip amplitude to the length.  The frequency change is computed at half this amplitude, and the
# error of the result from the difference to the change at the full amplitude.
SMALL = 0.02
# Safety factor: ratio of the stated error of the coefficient to the difference between its values at two
# amplitudes, which may be due to rounding alone.
_OF_AMPLITUDE = 2.0
# Relative difference of the coefficients of two bases below which their convergence counts as steady.
_STEADY = 1e-3
# Relative difference of coefficients that rounding may cause: rounding errors are divided by eps^2.
_ROUNDED = 1e-7
_SAMPLES = 16  # number of samples per period, which separate harmonics up to the seventh
# Relative size of the dynamic stiffness at twice the frequency, below which the second harmonic is resonant
# with another mode.
_RESONANT = 1e-3


@dataclass(frozen=True)
class FreeVibration:
    """Free vibration of a beam in one mode about an equilibrium.

    Parameters
    ----------
    state : BentState
        Equilibrium about which the beam vibrates.
    speed, omega : float
        Speed, and angular frequency of the mode [rad/s].
    vector : ndarray of complex, shape (n,)
        The mode, scaled so that the tip moves by the length of the beam.
    """

    state: BentState
    speed: float
    omega: float
    vector: np.ndarray

    @classmethod
    def of(cls, model: Model, speed: float, mode: int) -> FreeVibration:
        """Find the mode with a given number about the equilibrium of a model."""
        solver = model.deflected
        found = solver.solve(np.array([speed]), mode)
        state = solver.elastica.at(solver.equilibria(np.array([speed]))[0])
        v = found.vector[0][:, mode - 1].astype(complex)
        size = longer_semi_axis(state.bent.tip_motions.T @ v)
        frequency = float(found.eigenvalue[0, mode - 1].imag)
        return cls(state, speed, frequency, v * state.of.beam.stations.length / size)

    def coefficient(self, small: float) -> float:
        """Compute the relative frequency change divided by (amplitude / length)^2, for amplitudes towards 0.

        It is extrapolated from the relative amplitudes `small` and half of that.
        """
        rough, fine = (self._shift(eps) for eps in (small, small / 2))
        return (4 * fine - rough) / (3 * self.omega)

    def warnings(self) -> list[str]:
        """List a warning if the second harmonic is close to a natural frequency, and so excites a mode."""
        values = np.abs(np.linalg.eigvals(np.linalg.solve(self._dynamic(0), self._dynamic(2))))
        near = values.min() < _RESONANT * 3  # the vibrating mode has the value |1 - 2^2| = 3
        return ["twice the frequency is near that of another mode: the modes exchange energy"] if near else []

    def _dynamic(self, harmonic: int) -> np.ndarray:
        """Compute the dynamic stiffness matrix at a multiple of the frequency."""
        state, w, pencil = self.state, harmonic * self.omega, self.state.linearized().steady()
        K = pencil.K0 + self.speed**2 * pencil.K2
        return K + 1j * w * self.speed * state.gyroscopic - w**2 * state.bent.mass

    def _shift(self, eps: float) -> float:
        """Compute the change of the angular frequency, divided by eps^2 [rad/s], at a small amplitude eps."""
        v, state = self.vector, self.state
        even = (self._forces({1: eps * v}) + self._forces({1: -eps * v})) / (2 * eps**2)
        z = {h: -np.linalg.solve(self._dynamic(h), _harmonic(even, h)) for h in (0, 2)}
        z = {h: eps**2 * x for h, x in z.items()}
        odd = (self._forces({1: eps * v} | z) - self._forces({1: -eps * v} | z)) / (2 * eps**3)
        slope = 2 * self.omega * state.bent.mass - 1j * self.speed * state.gyroscopic
        return float(np.real(v.conj() @ _harmonic(odd, 1)) / np.real(v.conj() @ slope @ v))

    def _forces(self, harmonics: dict[int, np.ndarray]) -> np.ndarray:
        """Compute the residual of the equations at samples over one period, for given harmonics of q.

        The shape is (_SAMPLES, n), with n coordinates.
        """
        phase = 2 * np.pi * np.arange(_SAMPLES) / _SAMPLES
        waves = {h: np.exp(1j * h * phase)[:, None] * x for h, x in harmonics.items()}
        q, rate, acceleration = (
            np.real(np.sum([(1j * h * self.omega) ** k * wave for h, wave in waves.items()], axis=0))
            for k in range(3)
        )
        elastica, sample = self.state.of, MotionSample.steady(np.full(_SAMPLES, self.speed))
        root = root_motion(elastica.linear.mount, sample)
        return elastica.at(self.state.bent.q + q).work(rate, acceleration, root)


def _harmonic(samples: np.ndarray, harmonic: int) -> np.ndarray:
    """Compute the complex amplitude (n,) of a harmonic from samples of n coordinates over a period."""
    return np.fft.fft(samples, axis=0)[harmonic] * (2 if harmonic else 1) / _SAMPLES
