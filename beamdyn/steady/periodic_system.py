"""Linear equations with coefficients periodic in two phases, as harmonics, and their derivation from a scene.

    M q'' + C(theta, chi) q' + K(theta, chi) q = f(theta, chi),   theta' = nu_1,  chi' = nu_2

The harmonic (j, k) is the part that varies as exp(i (j theta + k chi)).  The coefficients are trigonometric
polynomials, so that an FFT of a few samples gives their harmonics exactly.  At steady speed the phases are
the angle theta of rotation and chi = kappa theta + const of the road, with `road_multiple` kappa.

In shapes of arrays, S counts speeds, n coordinates, H harmonics, and N samples of a phase.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beamdyn.common.words import Words
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.scene.motion.base import Line, Motion, MotionSample
from beamdyn.scene.motion.rotations import SteadyRotation
from beamdyn.scene.names_elsewhere import ROLLING_WHEEL

Pair = tuple[int, int]  # harmonic (j, k): j of rotation, k of the road

_EPS = np.finfo(float).eps
# Attributes that a motion must have for its steady state to be known.
_STEADY_STATE = ("lines", "road_multiple", "road_acceleration", "steady_acceleration")
_GRIDS = (8, 16, 32, 64)  # numbers of samples of each phase, tried in turn until the harmonics are resolved
_SAME_LINE = 1e-9  # relative difference below which two lines have the same frequency


@dataclass(frozen=True)
class PeriodicSystem:
    """Equations with coefficients periodic in two phases, as harmonics, for S pairs of phase rates.

    A spectrum has the shape (S, samples, samples): the harmonic (j, k) is at [:, j, k], as in numpy's FFT.

    Parameters
    ----------
    rates : ndarray, shape (S, 2)
        Rates nu_1, nu_2 of the phases [rad/s].
    mean : ndarray, shape (3, S, coordinates, coordinates)
        Constant parts of the matrices K, C and M, in this order.
    varying : tuple of (int, ndarray, ndarray)
        Periodic parts: the order of the derivative (0 for K, 1 for C), a spectrum, its S matrices.
    loads : tuple of (ndarray, ndarray)
        Terms of the load: a spectrum, its vectors (S, coordinates).
    """

    rates: np.ndarray
    mean: np.ndarray
    varying: tuple[tuple[int, np.ndarray, np.ndarray], ...]
    loads: tuple[tuple[np.ndarray, np.ndarray], ...]

    def __getitem__(self, chosen: np.ndarray | slice) -> PeriodicSystem:
        """Select the equations at the chosen pairs of phase rates."""
        return PeriodicSystem(
            self.rates[chosen],
            self.mean[:, chosen],
            tuple((order, spectrum[chosen], matrix[chosen]) for order, spectrum, matrix in self.varying),
            tuple((spectrum[chosen], vector[chosen]) for spectrum, vector in self.loads),
        )

    def part(self, coordinates: np.ndarray) -> PeriodicSystem:
        """Extract the equations of some coordinates, which no term couples with others."""
        rows = coordinates[:, None]
        varying = ((order, spectrum, A[:, rows, coordinates]) for order, spectrum, A in self.varying)
        loads = ((spectrum, vector[:, coordinates]) for spectrum, vector in self.loads)
        return PeriodicSystem(
            self.rates,
            self.mean[..., rows, coordinates],
            tuple(term for term in varying if term[2].any()),
            tuple(load for load in loads if load[1].any()),
        )

    @property
    def size(self) -> int:
        """Number of coordinates n."""
        return self.mean.shape[-1]

    @cached_property
    def without_stiffness(self) -> np.ndarray:
        """Whether each coordinate has no stiffness, so that only its rate acts, as with a circuit's flux."""
        stiff = self.mean[0].any(axis=(0, 1))
        for order, _, matrix in self.varying:
            stiff = stiff | (matrix.any(axis=(0, 1)) & (order == 0))
        return ~stiff

    def is_free(self, harmonics: np.ndarray) -> np.ndarray:
        """Mark harmonics of frequency 0 of coordinates without stiffness: shape (S, harmonics, coordinates).

        These static parts of the response are arbitrary, and are set to 0.
        """
        return (self.rates @ harmonics.T == 0)[..., None] & self.without_stiffness

    @property
    def load_harmonics(self) -> set[Pair]:
        """Harmonics (j, k) of the load."""
        return set().union(*(list_harmonics(spectrum) for spectrum, _ in self.loads))

    @property
    def coupling(self) -> set[Pair]:
        """Harmonics (j, k) of the periodic coefficients."""
        return set().union(*(list_harmonics(spectrum) for _, spectrum, _ in self.varying))


@dataclass(frozen=True)
class MeanModes:
    """Undamped modes of the mean equations, normalized to unit mass.

    Parameters
    ----------
    squared : ndarray, shape (rates, coordinates)
        Squared frequencies [rad2/s2].
    shapes : ndarray, shape (rates, coordinates, coordinates)
        Modes, in columns.
    """

    squared: np.ndarray
    shapes: np.ndarray

    @classmethod
    def of_system(cls, system: PeriodicSystem) -> MeanModes:
        """Compute the modes at S pairs of phase rates; raise a LinAlgError if the mass matrix is singular."""
        K, _, M = system.mean
        inverse = np.linalg.inv(np.linalg.cholesky(M))
        squared, vectors = np.linalg.eigh(inverse @ K @ np.swapaxes(inverse, 1, 2))
        return cls(squared, np.swapaxes(inverse, 1, 2) @ vectors)

    def transform(self, matrix: np.ndarray) -> np.ndarray:
        """Transform matrices (S, n, n) of S pairs of phase rates to modal coordinates: shape (n, n, S)."""
        return np.ascontiguousarray(np.moveaxis(np.swapaxes(self.shapes, 1, 2) @ matrix @ self.shapes, 0, 2))


def _fourier_coefficients(samples: np.ndarray) -> np.ndarray:
    """Compute harmonics (S, N, N) of functions sampled at N x N pairs of phases; set rounding errors to 0."""
    if (samples == samples[:, :1, :1]).all():
        constant = np.zeros(samples.shape, dtype=complex)
        constant[:, 0, 0] = samples[:, 0, 0]
        return constant
    spectrum = np.fft.fft2(samples) / (samples.shape[-1] * samples.shape[-2])
    return np.where(np.abs(spectrum) > 64 * _EPS * np.abs(samples).max(initial=0.0), spectrum, 0)


def list_harmonics(spectrum: np.ndarray) -> set[Pair]:
    """List the harmonics (j, k) of a spectrum (S, N, N) that differ from 0 at one or more speeds."""
    N = spectrum.shape[-1]
    index = (np.arange(N) + N // 2) % N - N // 2
    return {(int(index[a]), int(index[b])) for a, b in np.argwhere(spectrum.any(axis=0))}


def select_harmonics(spectrum: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """Select the harmonics `pairs`, (..., 2), of a spectrum; 0 where its grid does not resolve one."""
    inside = (np.abs(pairs) < spectrum.shape[-1] // 2).all(axis=-1)
    j, k = np.moveaxis(np.where(inside[..., None], pairs, 0), -1, 0)
    return np.where(inside, spectrum[:, j, k], 0)


# Choice of harmonics ------------------------------------------------------------------------------


def generate_harmonics(start: Iterable[Pair], coupling: set[Pair], interactions: int) -> list[list[Pair]]:
    """Generate the harmonics that arise by interactions with the periodic coefficients.

    Parameters
    ----------
    start : iterable of pair
        Harmonics (j, k) to start with; for each, the opposite (-j, -k) must also be given.
    coupling : set of pair
        Harmonics of the periodic coefficients.
    interactions : int
        Largest number of interactions, each of which adds a harmonic of the coefficients to the harmonics.

    Returns
    -------
    list of list of pair
        For 0, 1, ... interactions the harmonics that are not reached by fewer; the list ends early if an
        interaction adds none.
    """
    levels, seen = [sorted(start)], set(start)
    for _ in range(interactions):
        new = {(j + a, k + b) for j, k in levels[-1] for a, b in coupling} - seen
        if not new:
            break
        levels.append(sorted(new))
        seen |= new
    return levels


# Equations of a scene at steady speed ---------------------------------------------------------------


def periodic_system(
    equations: Equations | Sequence[Equations], motion: Motion | None, speeds: np.ndarray
) -> PeriodicSystem:
    """Expand the equations of motion at steady speeds in harmonics of the two phases.

    Parameters
    ----------
    equations : Equations, or sequence of them, length S
        Equations of motion for all speeds; or one set of equations for each speed, all with the same terms,
        as for vibration about the equilibrium at each speed.
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
    each = [equations] * len(speeds) if isinstance(equations, Equations) else equations
    motion, first = check_steady_state(motion), each[0]
    used = {part.quantity for part in (*first.terms, *first.loads)}
    spectra = expand_quantities(first, used, motion, speeds)
    mean = np.zeros((3, len(speeds), first.size, first.size))
    varying = []
    for order in range(3):
        for quantity in first.matrices[order]:
            matrices = _stack([e.matrices[order][quantity] for e in each])
            periodic = spectra[quantity].copy()
            mean[order] += np.real(periodic[:, :1, :1]) * matrices
            periodic[:, 0, 0] = 0
            if periodic.any():
                varying.append((order, periodic, matrices))
    vectors = {name: _stack([e.vectors[name] for e in each]) for name in first.vectors}
    loads = tuple((spectra[quantity], vector) for quantity, vector in vectors.items())
    rates = speeds[:, None] * np.array([1.0, motion.road_multiple or 0.0])
    return PeriodicSystem(rates, mean, tuple(varying), loads)


def _stack(arrays: list[np.ndarray]) -> np.ndarray:
    """Stack the arrays of all speeds; return a view if all are the same array."""
    if all(array is arrays[0] for array in arrays):
        return np.broadcast_to(arrays[0], (len(arrays), *arrays[0].shape))
    return np.array(arrays)


def split_uncoupled(system: PeriodicSystem, equations: Equations) -> list[tuple[PeriodicSystem, np.ndarray]]:
    """Split the equations into uncoupled parts, such as two planes of bending.

    Return each part with the indices of its coordinates.
    """
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
        lacking = f"{type(motion).__name__} has no {', '.join(missing)}"
        said = f"motion: {lacking}, so that its steady state is not known"
        raise ValueError(Words(said, "; simulate it, or use ", ROLLING_WHEEL, " or SteadyRotation"))
    motion.steady_acceleration(*np.zeros((3, 1)))  # refused where there is no steady state
    return motion


def expand_quantities(
    equations: Equations, used: Iterable[str], motion: Motion, speeds: np.ndarray
) -> dict[str, np.ndarray]:
    """Expand quantities of the root's motion at steady speeds in harmonics of the two phases.

    Parameters
    ----------
    equations : Equations
        The equations of motion, which contain mount and gravity.
    used : iterable of str
        Names of the quantities: fields of `RootMotion`.
    motion : Motion
        A motion with `steady_acceleration`.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].

    Returns
    -------
    dict of str to ndarray of complex, shape (S, samples, samples)
        Spectrum of each quantity, as in `PeriodicSystem`.

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
        spectra = {name: _fourier_coefficients(getattr(root, name)) for name in used}
        # The grid is fine enough if the higher half of the harmonics that it resolves is 0.
        high = np.minimum(np.arange(N), N - np.arange(N)) > N // 4
        if not any(each[:, high].any() or each[:, :, high].any() for each in spectra.values()):
            return spectra
    raise ValueError(
        f"motion: its steady acceleration has more than {_GRIDS[-1] // 4} harmonics; "
        "smooth it, or simulate it"
    )


def name_line(motion: Motion, harmonic: Pair) -> Line:
    """Return the motion's line at harmonic (j, k); without one, a line named like "2 road - rotation"."""
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
    """List the excitation lines of the periodic load and of the periodic stiffness, up to an order.

    Parameters
    ----------
    system : PeriodicSystem
        The equations.
    motion : Motion or None
        The motion, which names the lines.
    order : int
        1: the lines of the load and of the stiffness; n: also the lines that arise when these are multiplied
        by the periodic stiffness up to n - 1 times.

    Returns
    -------
    forced, parametric : list of Line
        Lines of the load, and lines of the stiffness, ascending in frequency.
    """
    motion = check_steady_state(motion)

    def generate_lines(start: Iterable[Pair], interactions: int) -> list[Line]:
        levels = generate_harmonics(start, system.coupling, interactions)
        return distinct_lines(name_line(motion, h) for level in levels for h in level)

    return generate_lines(system.load_harmonics, order - 1), generate_lines([(0, 0)], order)


def distinct_lines(lines: Iterable[Line]) -> list[Line]:
    """Select one line of each frequency, in ascending order, without the static line.

    Of lines that rounding of the inputs sets apart, the first one is kept.
    """
    distinct: list[Line] = []
    for line in lines:
        known = (abs(line.multiple - other.multiple) <= _SAME_LINE * line.multiple for other in distinct)
        if line.multiple > _SAME_LINE and not any(known):
            distinct.append(line)
    return sorted(distinct, key=lambda line: line.multiple)
