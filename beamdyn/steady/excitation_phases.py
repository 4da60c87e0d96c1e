"""The equations of motion at steady speed, as functions of the two phases of the excitation.

They are the angle theta of rotation and the phase chi = kappa theta + const of the road.
"""

from __future__ import annotations

import numpy as np

from beamdyn.equations.equations_of_motion import Equations
from beamdyn.scene.motion import Line, Motion, MotionSample, SteadyRotation
from beamdyn.steady.harmonic_balance import Pair, PeriodicSystem, fourier_coefficients, is_resolved

_STEADY_STATE = ("lines", "road_multiple", "road_acceleration", "steady_acceleration")  # of a motion
_GRIDS = (8, 16, 32, 64)  # samples of each phase: the coefficients are trigonometric polynomials


def periodic_system(equations: Equations, motion: Motion | None, speeds: np.ndarray) -> PeriodicSystem:
    """Expand the equations of motion at steady speeds in harmonics of the two phases.

    Parameters
    ----------
    equations : Equations
        The equations.
    motion : Motion or None
        What knows its `steady_acceleration` and `road_multiple`; None for rotation about a fixed centre.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].

    Returns
    -------
    PeriodicSystem

    Raises
    ------
    ValueError
        If nothing is known of the motion's steady state, or it is not smooth in the phases.
    """
    motion = check_steady_state(motion)
    spectra = _expand_quantities(equations, motion, speeds)
    mean = np.zeros((3, len(speeds), equations.size, equations.size))
    varying = []
    for order, matrices in enumerate(equations.matrices):
        for quantity, matrix in matrices.items():
            mean[order] += np.real(spectra[quantity][:, :1, :1]) * matrix
            if (periodic := _without_mean(spectra[quantity])).any():
                varying.append((order, periodic, matrix))
    loads = tuple((spectra[quantity], vector) for quantity, vector in equations.vectors.items())
    rates = speeds[:, None] * np.array([1.0, motion.road_multiple or 0.0])
    return PeriodicSystem(rates, mean, tuple(varying), loads)


def check_steady_state(motion: Motion | None) -> Motion:
    """The motion, or a ValueError if its steady state is not known; None is rotation about a fixed centre."""
    motion = SteadyRotation(0.0) if motion is None else motion
    missing = [n for n in _STEADY_STATE if not hasattr(motion, n)]
    if missing:
        raise ValueError(
            f"motion: {type(motion).__name__} has no {', '.join(missing)}, so that its steady state is not "
            "known; simulate it, or use RollingWheel or SteadyRotation"
        )
    return motion


def _expand_quantities(equations: Equations, motion: Motion, speeds: np.ndarray) -> dict[str, np.ndarray]:
    """Harmonics (S, N, N) of every quantity of the root's motion that the equations use."""
    used = {part.quantity for part in (*equations.terms, *equations.loads)}
    for N in _GRIDS:
        phase = 2 * np.pi * np.arange(N) / N
        angle, road, omega = np.broadcast_arrays(phase[:, None], phase, speeds[:, None, None])
        carrier = motion.steady_acceleration(omega, angle, road)
        root = equations.root(MotionSample(angle, omega, np.zeros(omega.shape), carrier))
        spectra = {name: fourier_coefficients(getattr(root, name)) for name in used}
        if all(map(is_resolved, spectra.values())):
            return spectra
    raise ValueError(
        f"motion: its steady acceleration has more than {_GRIDS[-1] // 4} harmonics; "
        "smooth it, or simulate it"
    )


def _without_mean(spectrum: np.ndarray) -> np.ndarray:
    spectrum = spectrum.copy()
    spectrum[:, 0, 0] = 0
    return spectrum


def name_line(motion: Motion, harmonic: Pair) -> Line:
    """The line of a harmonic, by the motion's own name where it has one."""
    multiple = abs(harmonic[0] + harmonic[1] * (motion.road_multiple or 0.0))
    for line in motion.lines:
        if abs(line.multiple - multiple) <= 1e-12 * (1 + multiple):
            return line
    j, k = harmonic if harmonic[::-1] >= (0, 0) else (-harmonic[0], -harmonic[1])
    parts = (
        f"{abs(n) if abs(n) > 1 else ''} {name}".strip() for n, name in ((k, "road"), (j, "rotation")) if n
    )
    return Line((" - " if j * k < 0 else " + ").join(parts) or "static", multiple)
