"""Steady response over speed, by harmonic balance in the two phases of the excitation."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from beamdyn._version import __version__
from beamdyn.common.checks import ascending, count, positive
from beamdyn.common.pickling import FieldsOnly
from beamdyn.common.results import Provenance, Result, plain
from beamdyn.modal.choice import DiscretizationChoice, choose_model, ensure_size
from beamdyn.modal.modal_basis import FEWEST_MODES, ModalBasis, given_basis
from beamdyn.modal.model import Model
from beamdyn.scene.motion import Line, Motion
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.scene.validity import check_speeds, list_range, warn_of_deflection, warn_of_road
from beamdyn.steady.excitation_phases import check_steady_state, name_line, periodic_system
from beamdyn.steady.harmonic_balance import (
    Pair,
    PeriodicSystem,
    generate_harmonics,
    largest_over_phases,
    solve_harmonic_balance,
)
from beamdyn.steady.stability import growth_rate

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MOST_INTERACTIONS = 5  # with the periodic coefficients, for the response
_MOST_HARMONICS = 20  # interactions that may be asked for: half a minute
_MOST_ENTRIES = 10**7  # of the matrices that are solved at once: 80 MB
_HIGHEST_SPEED = 0.99  # of the modal basis, over the critical speed
_MOST_MODES = 13  # of "auto", at each of two speeds
_ROUNDING = 1e-15  # relative error where no harmonic is neglected


@dataclass(frozen=True)
class SteadyResponse(Result):
    """Steady response over speed, after the free vibration from the start has decayed.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Speeds [rad/s].
    amplitude : ndarray, shape (S,)
        Largest |tip deflection| over both phases [m]; nan where there is no steady response.
    bound : ndarray, shape (S,)
        Sum of the amplitudes of all lines, the static one included [m].
    stable : ndarray of bool, shape (S,)
        Whether free vibration decays, or without damping stays bounded.
    status : ndarray of str, shape (S,)
        "stable", "parametric instability" or "past the critical speed".
    growth_rate : ndarray, shape (S,)
        Largest growth rate of free vibration [1/s].
    growth_rate_error : ndarray, shape (S,)
        Estimated error [1/s]: for resonant modes by the harmonics left out and between the phases tried; for
        others the second-order shift by the periodic coefficients.
    error : ndarray, shape (S,)
        Estimated truncation error of the harmonics, relative to the bound.
    lines : tuple of Line, length l
        The lines of the response.
    line_frequency : ndarray, shape (S, l)
        Frequencies of the lines [Hz].
    line_amplitude : ndarray of complex, shape (S, l)
        Complex tip deflection a of each line [m]: the tip's is the sum of Re(a exp(i (j theta + k chi))).
    harmonics : ndarray of int, shape (l, 2)
        j and k of each line.
    warnings : tuple of str
        Limitations of the result.
    provenance : Provenance
        How the result was computed.

    Notes
    -----
    The modal truncation error is `mode_error`, which takes a second solution at its first use.
    """

    speeds: np.ndarray
    amplitude: np.ndarray
    bound: np.ndarray
    stable: np.ndarray
    status: np.ndarray
    growth_rate: np.ndarray
    growth_rate_error: np.ndarray
    error: np.ndarray
    lines: tuple[Line, ...]
    line_frequency: np.ndarray
    line_amplitude: np.ndarray
    harmonics: np.ndarray
    warnings: tuple[str, ...]
    provenance: Provenance
    request: ResponseRequest = field(repr=False)

    @property
    def scene(self) -> Scene:
        """Scene."""
        return self.request.scene

    @cached_property
    def refined(self) -> SteadyResponse | None:
        """Response with 1.5 times as many modes, at least two more; None if there is no larger model."""
        return self.request.run_refined()

    @cached_property
    def mode_error(self) -> np.ndarray:
        """Estimated modal truncation error, relative to the bound, (S,): twice the distance from `refined`.

        Infinite where only one of the two has a steady response, or if there is no larger model.
        """
        if self.refined is None:
            return np.full(len(self.speeds), np.inf)
        with np.errstate(invalid="ignore", divide="ignore"):
            difference = 2 * np.abs(self.refined.amplitude - self.amplitude) / self.bound
        neither = np.isnan(self.amplitude) & np.isnan(self.refined.amplitude)
        return np.where(
            neither | (self.refined.amplitude == self.amplitude), 0.0, np.nan_to_num(difference, nan=np.inf)
        )

    def to_dict(self) -> dict[str, Any]:
        """The result as plain numbers, lists and strings, `mode_error` included."""
        return {**super().to_dict(), "mode_error": plain(self.mode_error)}

    def tip(self, rotation: np.ndarray, road: np.ndarray | float = 0.0) -> np.ndarray:
        """Tip deflection [m] at the phases theta and chi [rad] of shape (...): shape (S, ...)."""
        rotation, road = np.broadcast_arrays(rotation, road)
        phase = np.tensordot(self.harmonics, np.stack([rotation, road]), axes=1)
        return np.real(np.tensordot(self.line_amplitude, np.exp(1j * phase), axes=1))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the resonance curve."""
        from beamdyn.output.plots import plot_response

        return plot_response(self.speeds, self.amplitude, self.bound, ax)


def steady_response(
    scene: Scene,
    speeds: np.ndarray | Sequence[float],
    modes: int | str = "auto",
    harmonics: int | None = None,
    tolerance: float = 1e-5,
    discretization: DiscretizationChoice = "ritz",
) -> SteadyResponse:
    """Compute the steady response at given speeds by harmonic balance in the phases of rotation and road.

    The speeds are solved as one batch in the coordinates of a few modes of the beam.  The two phases are
    treated as independent, whether or not their rates are commensurate: the amplitude is the largest in
    time if they are not, and the largest over time and over the phase between road and rotation if they
    are.  Stability is decided by the exponents of free motion over the same phases: see
    `beamdyn.steady.stability`.

    Parameters
    ----------
    scene : Scene
        The scene.
    speeds : sequence of float
        Speeds [rad/s], ascending.
    modes : int or "auto"
        Number of modes at rest of each field.  "auto" takes modes at the slowest and at the fastest
        speed: the smallest modal basis whose truncation error meets the tolerance.
    harmonics : int, optional
        Number of interactions with the periodic stiffness whose lines are kept: 0 keeps the lines of the
        load, 1 also those that their product with the stiffness adds, and so on.  If not given, as many
        as the tolerance needs, up to 5.
    tolerance : float
        Truncation error of the harmonics aimed at, and with ``modes="auto"`` also the modal
        truncation error, each relative to the bound.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.

    Returns
    -------
    SteadyResponse

    Raises
    ------
    ValueError
        If an argument is out of its range, or the motion's steady state is not known.
    """
    check_scene(scene)
    speeds = ascending("speeds", speeds)
    check_speeds(speeds)
    basis = given_basis(modes)
    steps = None if harmonics is None else count("harmonics", harmonics, least=0, most=_MOST_HARMONICS)
    tolerance = positive("tolerance", tolerance)
    smallest = basis or ModalBasis(FEWEST_MODES)
    request = ResponseRequest(scene, speeds, smallest, steps, tolerance, discretization)
    return request.run() if basis else request.run_smallest_basis()


@dataclass(frozen=True)
class ResponseRequest(FieldsOnly):
    """Checked arguments of `steady_response`, with the modal basis in place of the number of modes."""

    scene: Scene
    speeds: np.ndarray
    basis: ModalBasis
    harmonics: int | None
    tolerance: float
    discretization: DiscretizationChoice

    def run(self) -> SteadyResponse:
        """Solve with the modal basis of the request."""
        start = perf_counter()
        scene, speeds, model = self.scene, self.speeds, self.model
        equations = model.modal_equations(self.basis)
        system = periodic_system(equations, scene.motion, speeds)
        rate, rate_error = growth_rate(system)
        status = _status(rate, speeds, model.solver.critical_speed)
        used, c, error = _solve_harmonics(system, equations.tip, self.harmonics, self.tolerance)
        undecided = (np.abs(rate) < rate_error) & (status != "past the critical speed")
        stable = (status == "stable") & np.isfinite(c).all(axis=1)
        c[~stable], error[~stable] = np.nan, np.nan
        amplitude = np.full(len(speeds), np.nan)
        motion = check_steady_state(scene.motion)
        harmonic, line = _combine_pairs(c, used, motion)
        amplitude[stable] = largest_over_phases(line[stable], harmonic)
        road = np.array([motion.road_acceleration(v) for v in speeds])
        return SteadyResponse(
            speeds=speeds,
            amplitude=amplitude,
            bound=np.abs(line).sum(axis=1),
            stable=stable,
            status=status,
            growth_rate=rate,
            growth_rate_error=rate_error,
            error=error,
            lines=tuple(name_line(motion, h) for h in map(tuple, harmonic.tolist())),
            line_frequency=np.abs(system.rates @ harmonic.T) / (2 * np.pi),
            line_amplitude=line,
            harmonics=harmonic,
            warnings=tuple(
                _warnings(scene, speeds, status, amplitude, error, self.tolerance, road, undecided)
            ),
            provenance=Provenance(
                __version__,
                f"{model.discretization}, {self.basis}, {len(used)} harmonics",
                "without the harmonics of the last interaction",
                perf_counter() - start,
            ),
            request=self,
        )

    def run_refined(self) -> SteadyResponse | None:
        """Solve with more modes; None if there is no larger model."""
        basis = self.basis.refined()
        if basis is None or basis.modes is None:
            return None
        discretization = ensure_size(self.scene, self.discretization, basis.modes)
        return replace(self, basis=basis, discretization=discretization).run()

    def run_smallest_basis(self) -> SteadyResponse:
        """Solve with the smallest basis whose truncation error meets the tolerance, or the largest tried."""
        speed = np.minimum(np.abs(self.speeds), _HIGHEST_SPEED * self.model.solver.critical_speed)
        ends = tuple(np.unique([speed.min(), speed.max()]).tolist())
        response = replace(self, basis=ModalBasis(FEWEST_MODES, ends)).run()
        while (response.mode_error > self.tolerance).any():
            if (response.request.basis.modes or 0) >= _MOST_MODES or response.refined is None:
                break
            response = response.refined
        return response

    @cached_property
    def model(self) -> Model:
        """The discretized scene, chosen for the number of modes and the speeds."""
        return choose_model(self.scene, self.discretization, self.speeds, self.basis.modes or 1)


def _status(rate: np.ndarray, speeds: np.ndarray, critical: float) -> np.ndarray:
    """Status at each speed."""
    status = np.where(rate > 0, "parametric instability", "stable")
    return np.where(np.abs(speeds) >= critical, "past the critical speed", status)


def _solve_harmonics(
    system: PeriodicSystem, tip: np.ndarray, steps: int | None, tolerance: float
) -> tuple[list[Pair], np.ndarray, np.ndarray]:
    """Harmonics (H), tip deflections (S, H) and errors (S); each speed solved with as many as it needs."""
    if not system.load_harmonics:
        return [], np.zeros((len(system.rates), 0), dtype=complex), np.full(len(system.rates), _ROUNDING)
    most = _MOST_INTERACTIONS if steps is None else steps
    levels = generate_harmonics(system.load_harmonics, system.coupling, most + 1)
    complete, levels = len(levels) <= most + 1, levels[: most + 1]
    sizes = np.cumsum([len(level) for level in levels])
    c = np.zeros((len(system.rates), sizes[-1]), dtype=complex)
    error = np.full(len(c), np.inf)
    for used in range(min(3 if steps is None else most + 1, len(levels)), len(levels) + 1):
        exact = complete and used == len(levels)
        unconverged = np.flatnonzero(~(error <= tolerance))
        for part in _split_by_memory(unconverged, system.size * sizes[used - 1]):
            c[part, : sizes[used - 1]], error[part] = _solve_tip(system[part], tip, levels[:used])
            error[part] = _ROUNDING if exact else error[part]
    return [h for level in levels for h in level], c, error


def _split_by_memory(unconverged: np.ndarray, size: int) -> list[np.ndarray]:
    """Split indices of speeds into parts whose matrices fit into memory."""
    return [p for p in np.array_split(unconverged, 1 + len(unconverged) * size**2 // _MOST_ENTRIES) if len(p)]


def _solve_tip(
    system: PeriodicSystem, tip: np.ndarray, levels: list[list[Pair]]
) -> tuple[np.ndarray, np.ndarray]:
    """Tip deflections (S, H), and their distance from those without the last level, over their sum."""
    c, truncated = (q @ tip for q in solve_harmonic_balance(system, levels))
    total = np.abs(c).sum(axis=1)
    return c, np.abs(c - truncated).sum(axis=1) / np.where(total == 0, 1, total)


def _combine_pairs(c: np.ndarray, harmonics: list[Pair], motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """Combine each pair h, -h into the line of positive frequency: harmonics (l, 2), amplitudes (S, l)."""
    kappa = motion.road_multiple or 0.0
    forward = [i for i, h in enumerate(harmonics) if (h[0] + h[1] * kappa, h) >= (0.0, (0, 0))]
    harmonic = np.array([harmonics[i] for i in forward], dtype=int).reshape(-1, 2)
    return harmonic, c[:, forward] * np.where(harmonic.any(axis=1), 2.0, 1.0)


def _warnings(
    scene: Scene,
    speeds: np.ndarray,
    status: np.ndarray,
    amplitude: np.ndarray,
    error: np.ndarray,
    tolerance: float,
    road: np.ndarray,
    undecided: np.ndarray,
) -> Iterator[str]:
    for name in ("parametric instability", "past the critical speed"):
        if (at := speeds[status == name]).size:
            yield f"{name} at {len(at)} speed(s), {list_range(at)}: no steady response"
    if (at := speeds[amplitude == 0]).size:
        yield (
            f"nothing excites the beam at {list_range(at)}, so that it does not move: "
            "that takes gravity, or a wavy road and a speed other than 0"
        )
    yield from warn_of_deflection(amplitude, scene.beam.length, speeds)
    yield from warn_of_road(road, speeds)
    if (at := speeds[error > tolerance]).size:
        yield f"the harmonics are not resolved to {tolerance:g} at {list_range(at)}; see error"
    if (at := speeds[undecided]).size:
        yield f"stability is not decided at {list_range(at)}: growth_rate is within growth_rate_error"
