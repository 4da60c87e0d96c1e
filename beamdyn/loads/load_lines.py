"""Lines of loads along the span in steady response: harmonics of the phases of rotation and road."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beamdyn.equations.equations_of_motion import Equations
from beamdyn.loads.load_rows import LoadRows, span_rows
from beamdyn.loads.section_points import StationOutputs
from beamdyn.loads.stations import SpanStations
from beamdyn.steady.excitation_phases import check_steady_state, expand_quantities
from beamdyn.steady.harmonic_balance import convolution_matrix, solve_harmonic_balance
from beamdyn.steady.largest_over_phases import largest_over_phases
from beamdyn.steady.periodic_system import Pair, generate_harmonics, list_harmonics
from beamdyn.steady.response import SteadyResponse
from beamdyn.steady.tip_lines import combine_pairs
from beamdyn.steady.vibration import Vibration, vibration_of

_BATCH = 2000  # sums of lines whose largest values are sought at once
_NEGLIGIBLE = 1e-12  # size of a line of the tip, over the sum of all, below which it is left out


@dataclass(frozen=True)
class LoadLines:
    """Outputs at stations as sums of lines Re(a exp(i (j theta + k chi))).

    Parameters
    ----------
    harmonics : ndarray of int, shape (l, 2)
        j and k of each line; of a harmonic and its opposite, the one of positive frequency.
    amplitude : ndarray of complex, shape (C, S, K, l)
        Amplitudes a at C speeds, S stations, of K outputs; nan where there is no steady response.
    of_harmonics : ndarray, shape (C, S, K)
        Estimated error by the harmonics left out.
    """

    harmonics: np.ndarray
    amplitude: np.ndarray
    of_harmonics: np.ndarray

    @cached_property
    def largest(self) -> np.ndarray:
        """Largest magnitudes over both phases: shape (C, S, K)."""
        flat = self.amplitude.reshape(-1, 1, len(self.harmonics))
        found, known = np.full(len(flat), np.nan), np.flatnonzero(np.isfinite(flat).all(axis=(1, 2)))
        for some in np.array_split(known, 1 + len(known) // _BATCH):
            found[some] = largest_over_phases(flat[some], self.harmonics)
        return found.reshape(self.amplitude.shape[:-1])

    def distance_from(self, other: LoadLines) -> np.ndarray:
        """Sum over the lines of the distances of the amplitudes from those of another solution (C, S, K).

        Infinite where one of the two alone has a steady response.
        """
        names = [*dict.fromkeys([*map(tuple, self.harmonics), *map(tuple, other.harmonics)])]
        difference = np.abs(self._over(names) - other._over(names)).sum(axis=-1)
        known = [np.isfinite(each.amplitude).all(axis=-1) for each in (self, other)]
        return np.where(known[0] ^ known[1], np.inf, difference)

    def _over(self, names: list[tuple[int, ...]]) -> np.ndarray:
        """Amplitudes over the lines of these names, 0 for those that are missing."""
        found = np.zeros((*self.amplitude.shape[:-1], len(names)), dtype=complex)
        found[..., [names.index(tuple(h)) for h in self.harmonics]] = self.amplitude
        return found


def lines_of_response(
    response: SteadyResponse, stations: SpanStations, outputs: StationOutputs | None = None
) -> LoadLines:
    """Find the lines of loads in a steady response.

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
    model, motion = request.model, check_steady_state(request.scene.motion)
    equations = model.modal_equations(request.basis)
    rows = span_rows(model.scene, model.discretization, equations, stations).in_motion(equations)
    rows = rows if outputs is None else rows.through(outputs.matrix)
    vibration = vibration_of(model, request.basis, motion, speeds)
    pairs, q, truncated = _solve(vibration, equations, response)
    rates = speeds[:, None] * np.array([1.0, motion.road_multiple or 0.0])
    used = dict.fromkeys([*rows.load, *rows.position, *rows.velocity])
    spectra = expand_quantities(equations, used, motion, speeds)
    union = _harmonics_of_loads(rows, spectra, pairs)
    fine, rough = (_expand(rows, spectra, union, pairs, rates, each) for each in (q, truncated))
    fine[~response.stable] = np.nan
    return LoadLines(*combine_pairs(fine, union, motion), np.abs(fine - rough).sum(axis=-1))


def _solve(
    vibration: Vibration, equations: Equations, response: SteadyResponse
) -> tuple[list[Pair], np.ndarray, np.ndarray]:
    """Solve for the coordinates with the harmonics of one interaction more than in the response.

    Returns
    -------
    harmonics : list of pair, length H
    coordinates, truncated : ndarray of complex, shape (C, H, n)
        With all harmonics, and without those of the further interaction, to estimate the error.
    """
    coupling = set().union(*(system.coupling for system, _ in vibration.parts))
    levels = generate_harmonics(_harmonics_that_matter(response), coupling, 1)
    pairs = [h for level in levels for h in level]
    fewer = pairs if len(levels) == 1 else [h for level in levels[:-1] for h in level]
    q = np.zeros((2, len(response.speeds), len(pairs), equations.size), dtype=complex)
    stable = np.flatnonzero(response.stable)
    for system, places in vibration.parts if pairs else ():
        for each, kept in zip(q, (pairs, fewer), strict=True):
            of_part = np.ix_(stable, np.arange(len(kept)), places)
            each[of_part] = solve_harmonic_balance(system[stable], kept)
    return pairs, q[0], q[1]


def _harmonics_that_matter(response: SteadyResponse) -> list[Pair]:
    """Harmonics of the response, and their opposites, without those within rounding error at all speeds."""
    size = np.abs(response.line_amplitude) + np.abs(response.line_amplitude_across)
    matter = (np.nan_to_num(size) > _NEGLIGIBLE * np.nan_to_num(response.bound)[:, None]).any(axis=0)
    both = ((sign * int(j), sign * int(k)) for j, k in response.harmonics[matter] for sign in (1, -1))
    return [*dict.fromkeys(both)]


def _harmonics_of_loads(rows: LoadRows, spectra: dict[str, np.ndarray], pairs: list[Pair]) -> list[Pair]:
    """Harmonics of the loads: those of the coordinates, of the root's motion, and of their products."""
    found = set(pairs) | {(0, 0)}
    for quantity in rows.load:
        found |= list_harmonics(spectra[quantity])
    for quantity in (*rows.position, *rows.velocity):
        found |= set(_sums(list_harmonics(spectra[quantity]), pairs))
    return sorted(found)


def _sums(first: set[Pair], second: list[Pair]) -> Iterator[Pair]:
    return ((a + j, b + k) for a, b in first for j, k in second)


def _expand(
    rows: LoadRows,
    spectra: dict[str, np.ndarray],
    union: list[Pair],
    pairs: list[Pair],
    rates: np.ndarray,
    q: np.ndarray,
) -> np.ndarray:
    """Complex harmonics (C, S, K, U) of the outputs; the U harmonics include those of the coordinates."""
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
