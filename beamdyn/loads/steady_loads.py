"""Loads along the span in steady response, over the phases of rotation and road.

In shapes of arrays, C counts speeds, S stations, K outputs at each, k components of a quantity, n
coordinates, and l spectral lines.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar

import numpy as np

from beamdyn.common.inputs.checks import kind, one_of
from beamdyn.common.results.pictures import Axes
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.loads import span_loads
from beamdyn.loads.load_rows import LoadRows, span_rows
from beamdyn.loads.stations import (
    UNITS,
    Positions,
    SectionPoints,
    SpanStations,
    StationOutputs,
    mode_error,
    with_neighbours,
)
from beamdyn.modes.repeated import repeatable
from beamdyn.scene.motion.base import Line
from beamdyn.steady import periodic_system
from beamdyn.steady.harmonic_balance import convolution_matrix, solve_harmonic_balance
from beamdyn.steady.largest_over_phases import largest_over_phases
from beamdyn.steady.response import SteadyResponse
from beamdyn.steady.vibration import combine_pairs, vibration_of

_BATCH = 2000  # number of sums of spectral lines whose largest values are computed at once
# Amplitude of a spectral line of the tip deflection, relative to the sum of all, below which it is left out.
_NEGLIGIBLE = 1e-12


@dataclass(frozen=True)
class SteadyLoads(span_loads.SpanLoads):
    """Loads along the span in steady response at C speeds: largest magnitudes over all phases.

    The fields are those of `SpanLoads`, and the following; values are nan where there is no steady
    response.

    Parameters
    ----------
    speeds : ndarray, shape (C,)
        Speeds [rad/s].
    harmonics : ndarray of int, shape (l, 2)
        Each line's multiples j of the phase of rotation and k of the phase of the road.
    lines : tuple of Line, length l
        Spectral lines of the loads, named by their excitation; the static line is the mean.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> wheel = bd.RollingWheel(0.3, 55.0, bd.RoadWave(0.3, velocity_amplitude=0.01))
    >>> response = bd.steady_response(bd.Scene(strip, bd.Mount(radius=0.215), wheel), [55.0], modes=3)
    >>> loads = bd.steady_loads(response, at=[0.0, 0.025])
    >>> bool(loads.moment[0, 0, 0] > loads.moment[0, 1, 0])  # largest at the root
    True
    """

    speeds: np.ndarray
    harmonics: np.ndarray
    lines: tuple[Line, ...]
    response: SteadyResponse = field(repr=False)
    outputs: StationOutputs = field(repr=False)

    case: ClassVar[span_loads.LoadCase] = span_loads.SPEEDS

    def line_amplitude(self, quantity: str) -> np.ndarray:
        """Return complex amplitudes a of a quantity's spectral lines: (speeds, stations, components, lines).

        The quantity is the sum of Re(a exp(i (j theta + k chi))), as in `SteadyResponse`.
        """
        one_of("quantity", quantity, (*UNITS,))
        return self._amplitudes[:, :, self.outputs.places[quantity]]

    def mean(self, quantity: str) -> np.ndarray:
        """Compute the mean of a quantity over the phases: (speeds, stations, components)."""
        static = ~self.harmonics.any(axis=1)
        return np.real(self.line_amplitude(quantity)[..., static]).sum(axis=-1)

    def at_phases(
        self, quantity: str, rotation: np.ndarray | float, road: np.ndarray | float = 0.0
    ) -> np.ndarray:
        """Evaluate a quantity at phases of rotation and road [rad]: (speeds, stations, components, ...)."""
        angle, wave = np.broadcast_arrays(rotation, road)
        phase = np.tensordot(self.harmonics, np.stack([angle, wave]), axes=1)
        return np.real(np.tensordot(self.line_amplitude(quantity), np.exp(1j * phase), axes=1))

    def plot(self, ax: Axes | None = None, quantity: str = "moment") -> Axes:
        """Plot the largest magnitude of a quantity over all speeds along the span."""

        def largest(name: str) -> np.ndarray:
            return np.nanmax(self.values(name), axis=0, keepdims=True)

        return self.draw(ax, quantity, largest, f"largest {span_loads.with_unit(quantity)} over all speeds")

    @cached_property
    def _amplitudes(self) -> np.ndarray:
        """Amplitudes (C, S, K, l) of the l spectral lines of K outputs at S stations and C speeds."""
        stations = SpanStations(self.x / self.scene.beam.length, self.inboard)
        return lines_of_response(self.response, stations, self.outputs).amplitude


@repeatable
def steady_loads(
    response: SteadyResponse,
    at: Positions | None = None,
    points: SectionPoints | None = None,
    youngs_modulus: float | None = None,
) -> SteadyLoads:
    """Compute the loads along the span in steady response, from external forces and inertia.

    Parameters
    ----------
    response : SteadyResponse
        The response over speed, of `steady_response`.
    at, points, youngs_modulus
        As for `static_loads`.

    Returns
    -------
    SteadyLoads

    Raises
    ------
    ValueError
        If an argument is out of its range, a point lies outside the section, or the response is one of large
        deflection.

    References
    ----------
    As `static_loads`, with inertia (d'Alembert, standard); neglected modes respond statically: Craig and
    Kurdila (2006), Fundamentals of Structural Dynamics, section 11.4.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> wheel = bd.RollingWheel(0.3, 55.0, bd.RoadWave(0.3, velocity_amplitude=0.01))
    >>> response = bd.steady_response(bd.Scene(strip, bd.Mount(radius=0.215), wheel), [55.0], modes=3)
    >>> bd.steady_loads(response, at=[0.0]).x
    array([0.])
    """
    kind("response", response, SteadyResponse, "steady_response makes one")
    scene, refined = response.scene, response.refined
    asked = span_loads.AskedLoads.of(scene, at, points, youngs_modulus)
    lines = lines_of_response(response, asked.stations, asked.outputs)
    error = np.full(lines.largest.shape, np.inf)
    if refined is not None:
        everywhere = with_neighbours(asked.stations)
        rough, fine = (lines_of_response(each, everywhere) for each in (response, refined))
        along_span = np.abs(rough.amplitude).sum(axis=-1).max(axis=1)
        where = asked.stations, asked.outputs, response.request.basis, scene.beam.length
        error = mode_error(rough.distance_from(fine), along_span, *where) + lines.of_harmonics
    motion, method = periodic_system.check_steady_state(scene.motion), response.provenance.method
    compared_with = "" if refined is None else refined.provenance.method
    return SteadyLoads(
        **asked.result(lines.largest, error, response.warnings, method, compared_with),
        speeds=response.speeds,
        harmonics=lines.harmonics,
        lines=tuple(periodic_system.name_line(motion, (int(j), int(k))) for j, k in lines.harmonics),
        response=response,
        outputs=asked.outputs,
    )


# Computation of the lines of the loads ------------------------------------------------------------


@dataclass(frozen=True)
class LoadLines:
    """Outputs at stations as sums of spectral lines Re(a exp(i (j theta + k chi))).

    The phases are theta of the rotation and chi of the road.

    Parameters
    ----------
    harmonics : ndarray of int, shape (lines, 2)
        Harmonic (j, k) of each line; of two opposite harmonics, the one of positive frequency.
    amplitude : ndarray of complex, shape (C, S, K, lines)
        Amplitudes a at C speeds, S stations, of K outputs; nan where there is no steady response.
    of_harmonics : ndarray, shape (C, S, K)
        Estimated error due to neglected harmonics.
    """

    harmonics: np.ndarray
    amplitude: np.ndarray
    of_harmonics: np.ndarray

    @cached_property
    def largest(self) -> np.ndarray:
        """Compute the largest magnitudes over all phases: (speeds, stations, outputs)."""
        flat = self.amplitude.reshape(-1, 1, len(self.harmonics))
        found, known = np.full(len(flat), np.nan), np.flatnonzero(np.isfinite(flat).all(axis=(1, 2)))
        for some in np.array_split(known, 1 + len(known) // _BATCH):
            found[some] = largest_over_phases(flat[some], self.harmonics)
        return found.reshape(self.amplitude.shape[:-1])

    def distance_from(self, other: LoadLines) -> np.ndarray:
        """Sum the differences of all lines' amplitudes from those of another solution, output by output.

        The sum is inf where only one of the two has a steady response.
        """
        names = [*dict.fromkeys([*map(tuple, self.harmonics), *map(tuple, other.harmonics)])]
        difference = np.abs(self._over(names) - other._over(names)).sum(axis=-1)
        known = [np.isfinite(each.amplitude).all(axis=-1) for each in (self, other)]
        return np.where(known[0] ^ known[1], np.inf, difference)

    def _over(self, names: list[tuple[int, ...]]) -> np.ndarray:
        """Return the amplitudes of the lines of given harmonics; missing lines are 0."""
        found = np.zeros((*self.amplitude.shape[:-1], len(names)), dtype=complex)
        found[..., [names.index(tuple(h)) for h in self.harmonics]] = self.amplitude
        return found


def lines_of_response(
    response: SteadyResponse, stations: SpanStations, outputs: StationOutputs | None = None
) -> LoadLines:
    """Compute the spectral lines (complex amplitudes) of loads in a steady response.

    Parameters
    ----------
    response : SteadyResponse
        The response at C speeds, of a straight beam.
    stations : SpanStations
        The S stations.
    outputs : StationOutputs, optional
        The K outputs at each station; forces and moments if not given.

    Returns
    -------
    LoadLines
    """
    request, speeds = response.request, response.speeds
    model, motion = request.model, periodic_system.check_steady_state(request.scene.motion)
    equations = model.modal_equations(request.basis)
    rows = span_rows(model.scene, model.discretization, equations, stations).in_motion(equations)
    rows = rows if outputs is None else rows.through(outputs.matrix)
    pairs, q, truncated = _solve(response, equations)
    rates = speeds[:, None] * np.array([1.0, motion.road_multiple or 0.0])
    used = dict.fromkeys([*rows.load, *rows.position, *rows.velocity])
    spectra = periodic_system.expand_quantities(equations, used, motion, speeds)
    # Harmonics in the loads: those of the coordinates, of the root's motion, and of products of both.
    reached = set(pairs) | {(0, 0)}
    for quantity in rows.load:
        reached |= periodic_system.list_harmonics(spectra[quantity])
    for quantity in (*rows.position, *rows.velocity):
        reached |= {
            (a + j, b + k) for a, b in periodic_system.list_harmonics(spectra[quantity]) for j, k in pairs
        }
    union = sorted(reached)
    fine, rough = (_expand(rows, spectra, union, pairs, rates, each) for each in (q, truncated))
    fine[~response.stable] = np.nan
    return LoadLines(*combine_pairs(fine, union, motion), np.abs(fine - rough).sum(axis=-1))


def _solve(
    response: SteadyResponse, equations: Equations
) -> tuple[list[periodic_system.Pair], np.ndarray, np.ndarray]:
    """Solve for the coordinates at the harmonics of the response and at those coupled to them.

    Periodic coefficients couple the harmonics of the response to further ones.  Harmonics that move the tip
    by no more than rounding error at any speed are left out.

    Returns the harmonics and the complex amplitudes (speeds, harmonics, coordinates), first with, then
    without the further harmonics.
    """
    request = response.request
    vibration = vibration_of(request.model, request.basis, request.scene.motion, response.speeds)
    size = np.abs(response.line_amplitude) + np.abs(response.line_amplitude_across)
    matter = (np.nan_to_num(size) > _NEGLIGIBLE * np.nan_to_num(response.bound)[:, None]).any(axis=0)
    both = ((sign * int(j), sign * int(k)) for j, k in response.harmonics[matter] for sign in (1, -1))
    coupling = set().union(*(system.coupling for system, _ in vibration.parts))
    levels = periodic_system.generate_harmonics(dict.fromkeys(both), coupling, 1)
    pairs = [h for level in levels for h in level]
    fewer = pairs if len(levels) == 1 else [h for level in levels[:-1] for h in level]
    q = np.zeros((2, len(response.speeds), len(pairs), equations.size), dtype=complex)
    stable = np.flatnonzero(response.stable)
    for system, places in vibration.parts if pairs else ():
        for each, kept in zip(q, (pairs, fewer), strict=True):
            of_part = np.ix_(stable, np.arange(len(kept)), places)
            each[of_part] = solve_harmonic_balance(system[stable], kept)
    return pairs, q[0], q[1]


def _expand(
    rows: LoadRows,
    spectra: dict[str, np.ndarray],
    union: list[periodic_system.Pair],
    pairs: list[periodic_system.Pair],
    rates: np.ndarray,
    q: np.ndarray,
) -> np.ndarray:
    """Compute complex amplitudes (C, S, K, U) of K outputs at C speeds and S stations, at U harmonics.

    `union` lists the U harmonics, `pairs` those of the coordinates' amplitudes `q`, `spectra` has the
    amplitudes of the root's motion, and `rates` the rates of the phases of rotation and road [rad/s].
    """
    everywhere = np.zeros((len(rates), len(union), q.shape[-1]), dtype=complex)
    everywhere[:, [union.index(h) for h in pairs]] = q
    velocity = 1j * (rates @ np.array(union).T)[..., None] * everywhere
    total = np.zeros((len(rates), *rows.shape, len(union)), dtype=complex)
    static = union.index((0, 0))
    for quantity, load in rows.load.items():
        total += np.einsum("cu,sk->csku", convolution_matrix(spectra[quantity], union)[:, :, static], load)
    for by_quantity, state in ((rows.position, everywhere), (rows.velocity, velocity)):
        for quantity, row in by_quantity.items():
            product = convolution_matrix(spectra[quantity], union) @ state
            total += np.einsum("cun,skn->csku", product, row, optimize=True)
    return total
