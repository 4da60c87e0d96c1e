"""The steady response over speed, by harmonic balance in the two phases of the excitation."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from beamdyn._version import __version__
from beamdyn.common.checks import ascending, count, positive
from beamdyn.common.results import Provenance, Result, plain
from beamdyn.equations.operators import Discretization
from beamdyn.modal.error_estimate import Model, choose, roomy
from beamdyn.modal.modal_basis import FEWEST, Kept
from beamdyn.scene.motion import Line, Motion
from beamdyn.scene.scene import Scene
from beamdyn.spectrum.modes import LARGE_DEFLECTION
from beamdyn.steady.excitation_phases import excited_line, known_steady, torus_system
from beamdyn.steady.harmonic_balance import Pair, TorusSystem, balance, growth, largest, reach

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_GRAVITY = 9.81  # past this acceleration [m/s2] a wheel leaves the road
_INTERACTIONS = 2  # with the turning coefficients, kept for the stability
_MOST = 5  # interactions kept for the response, at most
_ENTRIES = 10**7  # of the matrices solved at once
_BELOW = 0.99  # of the critical speed: where the fastest modes are taken at most
_MOST_MODES = 13  # at each of two speeds, that "auto" tries
_EXACT = 1e-15  # error where no harmonic is neglected


@dataclass(frozen=True)
class SteadyResponse(Result):
    """Steady response over speed, when all that the start set in motion has died away.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Speeds [rad/s].
    amplitude : ndarray, shape (S,)
        Largest |tip deflection| over both free phases [m]; nan where there is no steady response.
    bound : ndarray, shape (S,)
        Sum of the amplitudes of all lines, the static one included [m].
    stable : ndarray of bool, shape (S,)
        Whether free motion dies away, or without damping stays bounded.
    status : ndarray of str, shape (S,)
        "stable", "parametric instability" or "past the critical speed".
    growth_rate : ndarray, shape (S,)
        Largest rate of growth of free motion [1/s].
    error : ndarray, shape (S,)
        Estimated error by the neglected harmonics, relative to the bound.
    lines : tuple of Line, length l
        The lines of the response.
    line_frequency : ndarray, shape (S, l)
        Their frequencies [Hz].
    line_amplitude : ndarray of complex, shape (S, l)
        Tip deflection of each line [m]: the sum of Re(a exp(i (j theta + k chi))) is that of the tip.
    harmonics : ndarray of int, shape (l, 2)
        j and k of each line.
    warnings : tuple of str
        What limits the answer.
    provenance : Provenance
        How it was found.

    Notes
    -----
    The error by the modes left out is `mode_error`, which takes a second solution when first asked for.
    """

    speeds: np.ndarray
    amplitude: np.ndarray
    bound: np.ndarray
    stable: np.ndarray
    status: np.ndarray
    growth_rate: np.ndarray
    error: np.ndarray
    lines: tuple[Line, ...]
    line_frequency: np.ndarray
    line_amplitude: np.ndarray
    harmonics: np.ndarray
    warnings: tuple[str, ...]
    provenance: Provenance
    task: Task = field(repr=False)

    @property
    def scene(self) -> Scene:
        """The scene."""
        return self.task.scene

    @cached_property
    def richer(self) -> SteadyResponse | None:
        """The same with half as many modes more, at least two; None if there is no richer model."""
        return self.task.richer()

    @cached_property
    def mode_error(self) -> np.ndarray:
        """Estimated error by the modes left out, relative to the bound: twice what `richer` adds, (S,).

        Infinite where only one of the two has a steady response, or if there is no richer model.
        """
        if self.richer is None:
            return np.full(len(self.speeds), np.inf)
        with np.errstate(invalid="ignore", divide="ignore"):
            added = 2 * np.abs(self.richer.amplitude - self.amplitude) / self.bound
        neither = np.isnan(self.amplitude) & np.isnan(self.richer.amplitude)
        return np.where(
            neither | (self.richer.amplitude == self.amplitude), 0.0, np.nan_to_num(added, nan=np.inf)
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
    discretization: str | Discretization = "ritz",
) -> SteadyResponse:
    """Steady response at given speeds by harmonic balance in the phases of rotation and road.

    The speeds are solved as one batch in the coordinates of a few modes of the beam.  The two
    phases count as free, whether or not their rates are commensurate: the amplitude is the largest
    that the response reaches in time if they are not, and the largest over the phase between road
    and rotation if they are.  Stability is decided by the exponents of free motion on the same torus
    of phases: see `beamdyn.steady.harmonic_balance.growth`.

    Parameters
    ----------
    scene : Scene
        The scene.
    speeds : sequence of float
        Speeds [rad/s], ascending.
    modes : int or "auto"
        How many modes of the beam at rest.  "auto" keeps modes at the slowest and at the fastest speed, as
        few as leave no more than the tolerance out.
    harmonics : int, optional
        Interactions of the response with the turning stiffness that are kept: 0 keeps the lines of
        the load, 1 also those that the stiffness makes of them, and so on.  As many as the tolerance
        asks for, up to 5, if not given.
    tolerance : float
        Largest estimated error by neglected harmonics, and with ``modes="auto"`` by neglected modes,
        each relative to the bound.
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
    speeds = ascending("speeds", speeds)
    kept = None if modes == "auto" else Kept(count("modes", modes))
    steps = None if harmonics is None else count("harmonics", harmonics, least=0)
    task = Task(scene, speeds, kept or Kept(FEWEST), steps, positive("tolerance", tolerance), discretization)
    return task.run() if kept else task.cheapest()


@dataclass(frozen=True)
class Task:
    """What is asked: see `steady_response`."""

    scene: Scene
    speeds: np.ndarray
    kept: Kept
    harmonics: int | None
    tolerance: float
    discretization: str | Discretization

    def run(self) -> SteadyResponse:
        """The response."""
        start = perf_counter()
        scene, speeds, model = self.scene, self.speeds, self._model
        modal = model.modal(self.kept)
        system = torus_system(modal.equations, scene.motion, speeds)
        rate, status = _stability(system, speeds, model.solver.critical_speed)
        tip = modal.shape(np.ones(1))[:, 0]
        used, c, error = _tip_harmonics(system, tip, self.harmonics, self.tolerance)
        stable = (status == "stable") & np.isfinite(c).all(axis=1)
        c[~stable], error[~stable] = np.nan, np.nan
        amplitude = np.full(len(speeds), np.nan)
        motion = known_steady(scene.motion)
        harmonic, line = _lines_of(c, used, motion)
        amplitude[stable] = largest(line[stable], harmonic)
        road = np.array([motion.road_acceleration(v) for v in speeds])
        return SteadyResponse(
            speeds=speeds,
            amplitude=amplitude,
            bound=np.abs(line).sum(axis=1),
            stable=stable,
            status=status,
            growth_rate=rate,
            error=error,
            lines=tuple(excited_line(motion, h) for h in map(tuple, harmonic.tolist())),
            line_frequency=np.abs(system.rates @ harmonic.T) / (2 * np.pi),
            line_amplitude=line,
            harmonics=harmonic,
            warnings=tuple(_warnings(scene, speeds, status, amplitude, error, self.tolerance, road)),
            provenance=Provenance(
                __version__,
                f"{model.discretization}, {self.kept}, {len(used)} harmonics",
                "without the harmonics of the last interaction",
                perf_counter() - start,
            ),
            task=self,
        )

    def richer(self) -> SteadyResponse | None:
        """The response with more modes; None if there is no richer model."""
        kept = self.kept.more()
        if kept is None or kept.modes is None:
            return None
        return replace(self, kept=kept, discretization=roomy(self.discretization, kept.modes)).run()

    def cheapest(self) -> SteadyResponse:
        """The response with the fewest modes that keeps the tolerance, or else with the most tried."""
        speed = np.minimum(np.abs(self.speeds), _BELOW * self._model.solver.critical_speed)
        ends = tuple(np.unique([speed.min(), speed.max()]).tolist())
        found = replace(self, kept=Kept(FEWEST, ends)).run()
        while (found.mode_error > self.tolerance).any() and (found.task.kept.modes or 0) < _MOST_MODES:
            if found.richer is None:
                break
            found = found.richer
        return found

    @property
    def _model(self) -> Model:
        return choose(self.scene, self.discretization, self.speeds, self.kept.modes or 1)


def _stability(system: TorusSystem, speeds: np.ndarray, critical: float) -> tuple[np.ndarray, np.ndarray]:
    """Rates of growth, and status."""
    rate = growth(system, _INTERACTIONS)
    status = np.where(rate > 0, "parametric instability", "stable")
    return rate, np.where(np.abs(speeds) >= critical, "past the critical speed", status)


def _tip_harmonics(
    system: TorusSystem, tip: np.ndarray, steps: int | None, tolerance: float
) -> tuple[list[Pair], np.ndarray, np.ndarray]:
    """Harmonics (H), their tip deflections (S, H) and errors (S); each speed has as many as it needs."""
    if not system.forced:
        return [], np.zeros((len(system.rates), 0), dtype=complex), np.full(len(system.rates), _EXACT)
    most = _MOST if steps is None else steps
    levels = reach(system.forced, system.coupling, most + 1)
    closed, levels = len(levels) <= most + 1, levels[: most + 1]
    sizes = np.cumsum([len(level) for level in levels])
    c = np.zeros((len(system.rates), sizes[-1]), dtype=complex)
    error = np.full(len(c), np.inf)
    for used in range(min(3 if steps is None else most + 1, len(levels)), len(levels) + 1):
        exact = closed and used == len(levels)
        todo = np.flatnonzero(~(error <= tolerance))
        for part in _parts(todo, system.size * sizes[used - 1]):
            c[part, : sizes[used - 1]], error[part] = _balanced(system[part], tip, levels[:used])
            error[part] = _EXACT if exact else error[part]
    kept = [h for level in levels for h in level]
    return kept, c, error


def _parts(todo: np.ndarray, size: int) -> list[np.ndarray]:
    """The speeds, in parts whose matrices fit into memory."""
    return [p for p in np.array_split(todo, 1 + len(todo) * size**2 // _ENTRIES) if len(p)]


def _balanced(
    system: TorusSystem, tip: np.ndarray, levels: list[list[Pair]]
) -> tuple[np.ndarray, np.ndarray]:
    """Tip deflections (S, H), and how far they are from those without the last level, over their sum."""
    c, shorter = (q[..., : len(tip)] @ tip for q in balance(system, levels))
    total = np.abs(c).sum(axis=1)
    return c, np.abs(c - shorter).sum(axis=1) / np.where(total == 0, 1, total)


def _lines_of(c: np.ndarray, kept: list[Pair], motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """Of each pair h, -h the one that turns forwards, shape (l, 2), with its amplitude (S, l)."""
    kappa = motion.road_multiple or 0.0
    forward = [i for i, h in enumerate(kept) if (h[0] + h[1] * kappa, h) >= (0.0, (0, 0))]
    harmonic = np.array([kept[i] for i in forward], dtype=int).reshape(-1, 2)
    return harmonic, c[:, forward] * np.where(harmonic.any(axis=1), 2.0, 1.0)


def _warnings(
    scene: Scene,
    speeds: np.ndarray,
    status: np.ndarray,
    amplitude: np.ndarray,
    error: np.ndarray,
    tolerance: float,
    road: np.ndarray,
) -> Iterator[str]:
    for name in ("parametric instability", "past the critical speed"):
        if (at := speeds[status == name]).size:
            yield f"{name} at {len(at)} speed(s), {_range(at)}: no steady response"
    if (at := speeds[amplitude > LARGE_DEFLECTION * scene.beam.length]).size:
        yield f"the tip deflects by more than 0.1 of the length at {_range(at)}: outside linear theory"
    if (at := speeds[road > _GRAVITY]).size:
        yield (
            f"the road accelerates the wheel by up to {road.max():.4g} m/s2, past gravity, at {_range(at)}: "
            "the wheel leaves the road; was a velocity given as a height?"
        )
    if (at := speeds[error > tolerance]).size:
        yield f"the harmonics are not resolved to {tolerance:g} at {_range(at)}; see error"


def _range(speeds: np.ndarray) -> str:
    ends = [f"{speed:.6g}" for speed in (speeds.min(), speeds.max())]
    return " to ".join(dict.fromkeys(ends)) + " rad/s"
