"""The equations of motion at steady speed, as functions of the two phases of the excitation.

The phases are the angle theta of rotation and chi = kappa theta + const of the road, where kappa is the
motion's `road_multiple`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from beamdyn.equations.equations_of_motion import Equations
from beamdyn.scene.motion import Line, Motion, MotionSample, SteadyRotation
from beamdyn.steady.periodic_system import (
    Pair,
    PeriodicSystem,
    fourier_coefficients,
    generate_harmonics,
    is_resolved,
)

_STEADY_STATE = ("lines", "road_multiple", "road_acceleration", "steady_acceleration")  # of a motion
_GRIDS = (8, 16, 32, 64)  # numbers of samples of each phase, tried in turn


def periodic_system(equations: Equations, motion: Motion | None, speeds: np.ndarray) -> PeriodicSystem:
    """Expand the equations of motion at steady speeds in harmonics of the two phases.

    Parameters
    ----------
    equations : Equations
        The equations of motion.
    motion : Motion or None
        A motion with `steady_acceleration` and `road_multiple`; None for rotation about a fixed centre.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].

    Returns
    -------
    PeriodicSystem

    Raises
    ------
    ValueError
        If the motion's steady state is not known, or is not smooth in the phases.
    """
    return periodic_system_of_each([equations] * len(speeds), motion, speeds)


def periodic_system_of_each(
    equations: Sequence[Equations], motion: Motion | None, speeds: np.ndarray
) -> PeriodicSystem:
    """Expand equations that differ from speed to speed, such as those about equilibria.

    Parameters
    ----------
    equations : sequence of Equations, length S
        The equations at each speed, with the same terms.
    motion, speeds
        As for `periodic_system`.

    Returns
    -------
    PeriodicSystem

    Raises
    ------
    ValueError
        If the motion's steady state is not known, or is not smooth in the phases.
    """
    motion, first = check_steady_state(motion), equations[0]
    used = {part.quantity for part in (*first.terms, *first.loads)}
    spectra = expand_quantities(first, used, motion, speeds)
    mean = np.zeros((3, len(speeds), first.size, first.size))
    varying = []
    for order in range(3):
        for quantity in first.matrices[order]:
            matrices = _stack([each.matrices[order][quantity] for each in equations])
            mean[order] += np.real(spectra[quantity][:, :1, :1]) * matrices
            if (periodic := _without_mean(spectra[quantity])).any():
                varying.append((order, periodic, matrices))
    vectors = {name: _stack([each.vectors[name] for each in equations]) for name in first.vectors}
    loads = tuple((spectra[quantity], vector) for quantity, vector in vectors.items())
    rates = speeds[:, None] * np.array([1.0, motion.road_multiple or 0.0])
    return PeriodicSystem(rates, mean, tuple(varying), loads)


def _stack(arrays: list[np.ndarray]) -> np.ndarray:
    """Stack the arrays of all speeds; a view if they are one and the same array."""
    if all(array is arrays[0] for array in arrays):
        return np.broadcast_to(arrays[0], (len(arrays), *arrays[0].shape))
    return np.array(arrays)


def split_uncoupled(system: PeriodicSystem, equations: Equations) -> list[tuple[PeriodicSystem, np.ndarray]]:
    """Split the equations into parts that no term couples, such as two planes, each with its coordinates."""
    places = [equations.places(names) for names in equations.connected]
    return [(system.part(each), each) for each in places]


def check_steady_state(motion: Motion | None) -> Motion:
    """Return the motion, or rotation about a fixed centre for None.

    Raises
    ------
    ValueError
        If the steady state of the motion is not known.
    """
    motion = SteadyRotation(0.0) if motion is None else motion
    missing = [n for n in _STEADY_STATE if not hasattr(motion, n)]
    if missing:
        raise ValueError(
            f"motion: {type(motion).__name__} has no {', '.join(missing)}, so that its steady state is not "
            "known; simulate it, or use RollingWheel or SteadyRotation"
        )
    return motion


def expand_quantities(
    equations: Equations, used: Iterable[str], motion: Motion, speeds: np.ndarray
) -> dict[str, np.ndarray]:
    """Expand quantities of the root's motion at steady speeds in harmonics of the two phases.

    Parameters
    ----------
    equations : Equations
        The equations of motion, which know mount and gravity.
    used : iterable of str
        Names of the quantities: fields of `RootMotion`.
    motion : Motion
        A motion with `steady_acceleration`.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].

    Returns
    -------
    dict of str to ndarray of complex, shape (S, N, N)
        Spectra, as `PeriodicSystem` has them.

    Raises
    ------
    ValueError
        If the motion is not smooth in the phases.
    """
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
    """Spectrum with its constant part set to 0."""
    spectrum = spectrum.copy()
    spectrum[:, 0, 0] = 0
    return spectrum


def name_line(motion: Motion, harmonic: Pair) -> Line:
    """Line of a harmonic (j, k), with the motion's name for it or else one such as "2 road - rotation"."""
    multiple = abs(harmonic[0] + harmonic[1] * (motion.road_multiple or 0.0))
    for line in motion.lines:
        if abs(line.multiple - multiple) <= 1e-12 * (1 + multiple):
            return line
    j, k = harmonic if harmonic[::-1] >= (0, 0) else (-harmonic[0], -harmonic[1])
    parts = (
        f"{abs(n) if abs(n) > 1 else ''} {name}".strip() for n, name in ((k, "road"), (j, "rotation")) if n
    )
    return Line((" - " if j * k < 0 else " + ").join(parts) or "static", multiple)


def excitation_lines(
    system: PeriodicSystem, motion: Motion | None, order: int
) -> tuple[list[Line], list[Line]]:
    """List the lines of the load and of the stiffness, up to an order.

    Parameters
    ----------
    system : PeriodicSystem
        The equations.
    motion : Motion or None
        The motion, which names the lines.
    order : int
        1: lines of the load and of the stiffness; n: also those of up to n - 1 interactions.

    Returns
    -------
    forced, parametric : list of Line
        Ascending in frequency.
    """
    motion = check_steady_state(motion)

    def generate_lines(start: Iterable[Pair], interactions: int) -> list[Line]:
        levels = generate_harmonics(start, system.coupling, interactions)
        return distinct_lines(name_line(motion, h) for level in levels for h in level)

    return generate_lines(system.load_harmonics, order - 1), generate_lines([(0, 0)], order)


def distinct_lines(lines: Iterable[Line]) -> list[Line]:
    """One line of each frequency, ascending, without the static one."""
    distinct: dict[float, Line] = {}
    for line in lines:
        if line.multiple > 1e-12:
            distinct.setdefault(round(line.multiple, 12), line)
    return [distinct[multiple] for multiple in sorted(distinct)]
