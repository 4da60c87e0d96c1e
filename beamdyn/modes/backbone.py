"""Frequency over amplitude, to first order, of a beam of any deflection about its equilibrium."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from time import perf_counter

import numpy as np

from beamdyn._version import __version__
from beamdyn.common.inputs.checks import InvalidValue, count, real
from beamdyn.common.results.one_line import error_at_most, number, warned
from beamdyn.common.results.result import Provenance, Result
from beamdyn.modes.modal.choice import DiscretizationChoice, solve_to_tolerance
from beamdyn.modes.modal.finite_amplitude import SMALL, FreeVibration
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.scene.validity import check_speeds


@dataclass(frozen=True)
class Backbone(Result):
    """Frequency of a free vibration over its amplitude a, to first order: f = f0 (1 + k (a/L)^2).

    Parameters
    ----------
    speed : float
        Speed [rad/s].
    mode : int
        Number of the mode, from 1.
    frequency : float
        Frequency f0 of small vibration [Hz].
    coefficient : float
        The nondimensional coefficient k; a is the longer semi-axis of the path of the tip, L the length [m].
    error : float
        Estimated absolute error of the coefficient, which is nondimensional as that is.
    warnings : tuple of str
        What limits the answer.
    provenance : Provenance
        How it was found.

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
    warnings: tuple[str, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)

    def headline(self) -> Iterator[str]:
        """What it says in one line; see `Result.headline`."""
        yield f"mode {self.mode} at {self.say_speed(self.speed)}: {number(self.frequency, 'Hz')}"
        yield from (
            f"coefficient {number(self.coefficient)}",
            error_at_most(self.error),
            warned(self.warnings),
        )

    def at(self, amplitude: np.ndarray | float) -> np.ndarray:
        """Frequency [Hz] at amplitudes of the tip [m]."""
        return self.frequency * (1 + self.coefficient * (np.asarray(amplitude) / self.scene.beam.length) ** 2)


def backbone(
    scene: Scene, speed: float = 0.0, mode: int = 1, discretization: DiscretizationChoice = "ritz"
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

    Returns
    -------
    Backbone

    Raises
    ------
    NoEquilibrium
        An ArithmeticError: if the beam has no equilibrium at this speed.
    ValueError
        If the mode does not vibrate about the equilibrium.

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
    speeds, mode = np.array([real("speed", speed, "rad/s")]), count("mode", mode)
    check_speeds(speeds, "speed")
    scene = replace(scene.undamped, physics=replace(scene.physics, large_deflection=True))
    solution = solve_to_tolerance(scene, discretization, speeds, mode)
    s = solution.eigen.eigenvalue[0, mode - 1]
    if not (s.imag > 0 and s.real <= 0):
        bound = f"it does not vibrate about the equilibrium at {speeds[0]:g} rad/s"
        raise InvalidValue("mode", mode, bound, 'another speed or Physics(branch="bent")')
    found = [FreeVibration.of(model, float(speeds[0]), mode) for model in (solution.model, solution.coarse)]
    k, coarse = (each.coefficient(SMALL / 2) for each in found)
    names = str(solution.model.discretization), str(solution.coarse.discretization)
    return Backbone(
        speed=float(speeds[0]),
        mode=mode,
        frequency=float(s.imag / (2 * np.pi)),
        coefficient=k,
        error=abs(k - coarse) + abs(k - found[0].coefficient(SMALL)),
        warnings=tuple(found[0].warnings()),
        provenance=Provenance(__version__, *names, perf_counter() - start),
        scene=scene,
    )
