"""Resonance speeds: where the lines of the excitation meet natural frequencies."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations_with_replacement
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from beamdyn._version import __version__
from beamdyn.common.checks import count, positive
from beamdyn.common.results import Provenance, Result
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.modal.choice import DiscretizationChoice, choose_model
from beamdyn.modal.eigen import Solver
from beamdyn.modal.error_estimate import solve_with_error
from beamdyn.modal.model import Model
from beamdyn.modal.tracking import track
from beamdyn.scene.motion import Line, Motion
from beamdyn.scene.scene import Scene
from beamdyn.steady.excitation_phases import check_steady_state, name_line, periodic_system
from beamdyn.steady.harmonic_balance import list_reached

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_NODES = 400  # speeds at which roots are bracketed; extrema between them are refined
_TIGHT = 4 * np.finfo(float).eps


@dataclass(frozen=True)
class Crossing:
    """A speed at which a line meets a natural frequency.

    Parameters
    ----------
    line : Line
        The line.
    mode : int
        The mode, numbered at rest from 1.
    speed : float
        Speed [rad/s].
    frequency : float
        Natural frequency of the mode [Hz].
    kind : {"forced", "parametric"}
        "forced": natural frequency = line.  "parametric": twice the natural frequency, or the sum of
        that of `mode` and of `second_mode`, = line; the periodic stiffness makes the beam unstable.
    error : float
        Estimated relative error of the speed.
    second_mode : int or None
        The other mode of a combination.
    """

    line: Line
    mode: int
    speed: float
    frequency: float
    kind: str
    error: float
    second_mode: int | None = None


@dataclass(frozen=True)
class Crossings(Result, Sequence[Crossing]):
    """Crossings by ascending speed: a sequence.

    Parameters
    ----------
    crossings : tuple of Crossing
        The crossings.
    lines : tuple of Line
        The lines that force the beam.
    speeds : ndarray, shape (S,)
        Speeds of the locus [rad/s], up to the top speed or the critical one.
    frequency : ndarray, shape (S, m)
        Natural frequencies [Hz], numbered at rest.
    warnings : tuple of str
        What limits the answer.
    provenance : Provenance
        How it was found.
    """

    crossings: tuple[Crossing, ...]
    lines: tuple[Line, ...]
    speeds: np.ndarray
    frequency: np.ndarray
    warnings: tuple[str, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)

    def __getitem__(self, index):  # pyright: ignore[reportIncompatibleMethodOverride]
        return self.crossings[index]

    def __len__(self) -> int:
        return len(self.crossings)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw natural frequencies and lines over speed, the crossings marked: Campbell's diagram."""
        from beamdyn.output.plots import plot_campbell

        lines = {line.name: line.multiple for line in self.lines}
        marked = {
            kind: [(c.speed, c.frequency) for c in self if c.kind == kind]
            for kind in ("forced", "parametric")
        }
        return plot_campbell(self.speeds, self.frequency, lines, marked, ax)


def resonance_speeds(
    scene: Scene,
    top_speed: float,
    modes: int = 3,
    order: int = 1,
    discretization: DiscretizationChoice = "ritz",
) -> Crossings:
    """Speeds at which the lines that the scene forces meet natural frequencies.

    The roots of lambda_i(omega) - multiple omega, and of lambda_i + lambda_j - multiple omega, are
    bracketed on the continuous loci and refined to rounding; extrema between the brackets are sought,
    so that two roots close together are both found.  Damping is left out.

    Parameters
    ----------
    scene : Scene
        The scene; its motion gives the lines, and gravity adds that of the rotation.
    top_speed : float
        Top speed [rad/s]; above the critical speed none are sought.
    modes : int
        How many modes.
    order : int
        1: the lines of the load, and 2 lambda_i = a line of the stiffness.  n: also the lines that the
        load makes with the stiffness in n - 1 interactions, and lambda_i + lambda_j = sums and
        differences of up to n lines of the stiffness.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.

    Returns
    -------
    Crossings

    Raises
    ------
    ValueError
        If an argument is out of its range, or the motion's steady state is not known.
    """
    start = perf_counter()
    top = positive("top_speed", top_speed, "rad/s")
    modes, order = count("modes", modes), count("order", order)
    scene = replace(scene, damping_ratio=0.0)
    model = choose_model(scene, discretization, np.array([0.0, top]), modes)
    critical = model.solver.critical_speed
    locus = _Loci(model, min(top, critical), modes)
    forced, parametric = _lines(model.equations, scene.motion, top, order)
    wanted = [("forced", line, (i,)) for line in forced for i in range(modes)]
    pairs = [p for p in combinations_with_replacement(range(modes), 2) if order > 1 or p[0] == p[1]]
    wanted += [("parametric", line, pair) for line in parametric for pair in pairs]
    crossings = [c for kind, line, places in wanted for c in locus.crossings(kind, line, places)]
    names = str(model.discretization), str(model.coarser.discretization)
    return Crossings(
        crossings=tuple(sorted(crossings, key=lambda c: c.speed)),
        lines=tuple(forced),
        speeds=locus.speeds,
        frequency=np.take_along_axis(locus.values, locus.order, axis=1) / (2 * np.pi),
        warnings=() if top < critical else (f"searched up to the critical speed, {critical:.6g} rad/s",),
        provenance=Provenance(__version__, *names, perf_counter() - start),
        scene=scene,
    )


def _lines(
    equations: Equations, motion: Motion | None, speed: float, order: int
) -> tuple[list[Line], list[Line]]:
    """Lines of the load, and of the stiffness, up to an order."""
    system = periodic_system(equations, motion, np.array([speed]))
    known = check_steady_state(motion)
    forced = list_reached(system.forced, system.coupling, order - 1)
    parametric = list_reached([(0, 0)], system.coupling, order)
    return tuple(
        _distinct(name_line(known, h) for level in levels for h in level) for levels in (forced, parametric)
    )  # pyright: ignore[reportReturnType]


def _distinct(lines: Iterable[Line]) -> list[Line]:
    """One line of each frequency, without the static one, ascending."""
    kept: dict[float, Line] = {}
    for line in lines:
        if line.multiple > 1e-12:
            kept.setdefault(round(line.multiple, 12), line)
    return [kept[multiple] for multiple in sorted(kept)]


class _Loci:
    """Natural frequencies as continuous functions of speed: in ascending order they have kinks, no jumps.

    Parameters
    ----------
    model : Model
        The discretized scene.
    top : float
        Top speed [rad/s].
    modes : int
        How many modes.
    """

    def __init__(self, model: Model, top: float, modes: int) -> None:
        self.model, self.modes = model, modes
        self.solver: Solver = model.solver
        self.speeds = np.linspace(0, top, _NODES + 1)
        self.values = self.frequencies(self.speeds)
        vectors = self.solver.solve(self.speeds, modes).vector
        self.order, _ = track(vectors, self.solver.pencil.M)

    def frequencies(self, speeds: np.ndarray) -> np.ndarray:
        """Angular frequencies [rad/s], ascending: shape (S, m)."""
        return np.abs(np.imag(self.solver.eigenvalues(speeds, self.modes)))

    def crossings(self, kind: str, line: Line, places: tuple[int, ...]) -> Iterator[Crossing]:
        """Crossings of one line with the sum of the frequencies at one or two places."""

        def miss(speed: float) -> float:
            return float(self.frequencies(np.array([speed]))[0, places].sum()) - line.multiple * speed

        misses = self.values[:, places].sum(axis=1) - line.multiple * self.speeds
        for a, b in _brackets(miss, self.speeds, misses):
            speed = brentq(miss, a, b, xtol=_TIGHT * b, rtol=_TIGHT)  # pyright: ignore[reportArgumentType]
            yield self._crossing(kind, line, places, float(speed), (miss(b) - miss(a)) / (b - a))

    def _crossing(
        self, kind: str, line: Line, places: tuple[int, ...], speed: float, slope: float
    ) -> Crossing:
        solution = solve_with_error(self.model, np.array([speed]), self.modes)
        own = self.frequencies(np.array([speed]))[0]
        wrong = np.abs(np.abs(solution.eigen.eigenvalue[0]) - own) + solution.error[0] * own
        node = int(np.searchsorted(self.speeds, speed)) - 1
        numbers = [int(np.flatnonzero(self.order[node] == place)[0]) + 1 for place in places]
        return Crossing(
            line=line,
            mode=min(numbers),
            speed=speed,
            frequency=float(own[places[0]] / (2 * np.pi)),
            kind=kind,
            error=float(wrong[list(places)].sum() / abs(slope * speed)) + _TIGHT,
            second_mode=max(numbers) if len(set(numbers)) > 1 else None,
        )


def _brackets(miss: Callable[[float], float], x: np.ndarray, y: np.ndarray) -> Iterator[tuple[float, float]]:
    """Intervals in which a function changes its sign, also where it only dips between two nodes."""
    for k in range(len(x) - 1):
        if y[k] * y[k + 1] < 0 or (y[k + 1] == 0 and y[k] != 0):
            yield float(x[k]), float(x[k + 1])
    size = np.abs(y)
    dips = (
        (size[1:-1] < size[:-2]) & (size[1:-1] <= size[2:]) & (y[1:-1] * y[:-2] > 0) & (y[1:-1] * y[2:] > 0)
    )
    for k in np.flatnonzero(dips) + 1:
        a, b, sign = float(x[k - 1]), float(x[k + 1]), np.sign(y[k])
        least = minimize_scalar(lambda v, s=sign: s * miss(v), bounds=(a, b), method="bounded")
        if least.fun < 0:
            yield from ((a, float(least.x)), (float(least.x), b))
