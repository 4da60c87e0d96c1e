"""Resonance speeds: speeds at which a line of the excitation equals a natural frequency."""

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
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.scene.validity import check_speeds
from beamdyn.steady.excitation_phases import check_steady_state, name_line, periodic_system
from beamdyn.steady.harmonic_balance import Pair, generate_harmonics

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_HIGHEST_ORDER = 20  # that may be asked for: ten seconds
_NODES = 400  # intervals of speed in which roots are bracketed
_ROUNDING = 4 * np.finfo(float).eps


@dataclass(frozen=True)
class Crossing:
    """Speed at which a line of the excitation equals a natural frequency.

    Parameters
    ----------
    line : Line
        Line of the excitation.
    mode : int
        Number of the mode, from 1, in the order at rest.
    speed : float
        Speed [rad/s].
    frequency : float
        Natural frequency of the mode [Hz].
    kind : {"forced", "parametric"}
        "forced": natural frequency = line.  "parametric": twice the natural frequency, or the sum of the
        frequencies of `mode` and `second_mode`, = line; the periodic stiffness makes the beam unstable.
    error : float
        Estimated relative error of the speed.
    second_mode : int or None
        Number of the other mode of a combination resonance.
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
    """Sequence of crossings, by ascending speed.

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
    order : int
        Highest order of the lines that were sought.
    left_out : int
        Number of crossings of the next order, which are weaker; those of still higher order are not counted.
    warnings : tuple of str
        Limitations of the result, and why there is no crossing.
    provenance : Provenance
        How the result was computed.
    """

    crossings: tuple[Crossing, ...]
    lines: tuple[Line, ...]
    speeds: np.ndarray
    frequency: np.ndarray
    order: int
    left_out: int
    warnings: tuple[str, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)

    def __getitem__(self, index):  # pyright: ignore[reportIncompatibleMethodOverride]
        return self.crossings[index]

    def __len__(self) -> int:
        return len(self.crossings)

    @property
    def extent(self) -> str:
        """What was sought, and what is left out, as a sentence."""
        sought = f"Sought to order {self.order} up to {self.speeds[-1]:.6g} rad/s"
        if not self.left_out:
            return f"{sought}; there are none of order {self.order + 1}."
        crossings = f"{self.left_out} crossing{'s' * (self.left_out != 1)} of order {self.order + 1}"
        return f"{sought}; {crossings}, and those of higher order, are weaker and left out."

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the Campbell diagram: natural frequencies and lines over speed, with the crossings marked."""
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
    """Find the speeds at which lines of the excitation equal natural frequencies.

    The roots of lambda_i(omega) - multiple omega, and of lambda_i + lambda_j - multiple omega, are
    bracketed on the continuous loci and refined to rounding error; minima of the distance between the
    brackets are sought too, so that two close roots are both found.  Damping is neglected.

    Parameters
    ----------
    scene : Scene
        The scene; its motion defines the lines, and gravity adds the line of the rotation.
    top_speed : float
        Top speed [rad/s]; the search ends at the critical speed.
    modes : int
        Number of modes.
    order : int
        1: the lines of the load, and 2 lambda_i = a line of the stiffness.  n: also the lines that up to
        n - 1 interactions of the load with the periodic stiffness add, and lambda_i + lambda_j = sums
        and differences of up to n lines of the stiffness.  The crossings of order n + 1 are counted.
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
    check_scene(scene)
    top = positive("top_speed", top_speed, "rad/s")
    check_speeds(top, "top_speed")
    modes, order = count("modes", modes), count("order", order, most=_HIGHEST_ORDER)
    scene = replace(scene, damping_ratio=0.0)
    model = choose_model(scene, discretization, np.array([0.0, top]), modes)
    critical = model.solver.critical_speed
    locus = _Loci(model, min(top, critical), modes)
    here, next_order = (_excitation_lines(model.equations, scene.motion, top, n) for n in (order, order + 1))
    sought = dict.fromkeys(_list_resonances(*here, modes, order))  # a set that keeps their order
    crossings = [c for resonance in sought for c in locus.crossings(*resonance)]
    further = [each for each in _list_resonances(*next_order, modes, order + 1) if each not in sought]
    left_out = sum(locus.count_crossings(line, indices) for _, line, indices in further)
    names = str(model.discretization), str(model.coarser.discretization)
    return Crossings(
        crossings=tuple(sorted(crossings, key=lambda c: c.speed)),
        lines=tuple(here[0]),
        speeds=locus.speeds,
        frequency=np.take_along_axis(locus.values, locus.order, axis=1) / (2 * np.pi),
        order=order,
        left_out=left_out,
        warnings=tuple(_warnings(scene, here, len(crossings), order, top, critical)),
        provenance=Provenance(__version__, *names, perf_counter() - start),
        scene=scene,
    )


def _excitation_lines(
    equations: Equations, motion: Motion | None, speed: float, order: int
) -> tuple[list[Line], list[Line]]:
    """Lines of the load and of the stiffness at a speed [rad/s], up to an order."""
    system = periodic_system(equations, motion, np.array([speed]))
    motion = check_steady_state(motion)

    def generate_lines(start: Iterable[Pair], interactions: int) -> list[Line]:
        levels = generate_harmonics(start, system.coupling, interactions)
        return _distinct(name_line(motion, h) for level in levels for h in level)

    return generate_lines(system.load_harmonics, order - 1), generate_lines([(0, 0)], order)


def _list_resonances(
    forced: list[Line], parametric: list[Line], modes: int, order: int
) -> list[tuple[str, Line, tuple[int, ...]]]:
    """Kinds, lines and indices of the modes of the resonances up to an order."""
    pairs = [p for p in combinations_with_replacement(range(modes), 2) if order > 1 or p[0] == p[1]]
    by_load = [("forced", line, (i,)) for line in forced for i in range(modes)]
    return [*by_load, *(("parametric", line, pair) for line in parametric for pair in pairs)]


def _warnings(
    scene: Scene,
    lines: tuple[list[Line], list[Line]],
    found: int,
    order: int,
    top: float,
    critical: float,
) -> Iterator[str]:
    if top >= critical:
        yield f"searched up to the critical speed, {critical:.6g} rad/s"
    names = ", ".join(dict.fromkeys(line.name for kind in lines for line in kind))
    if not names:
        motion = "has no motion" if scene.motion is None else f"has a {type(scene.motion).__name__}"
        yield (
            f"nothing varies in time at steady speed: the scene {motion} and gravity = {scene.gravity:g}; "
            "a RollingWheel with a road, or gravity, excites the beam"
        )
    elif not found:
        yield f"no mode meets a line of order {order} up to {min(top, critical):.6g} rad/s; lines: {names}"


def _distinct(lines: Iterable[Line]) -> list[Line]:
    """One line of each frequency, ascending, without the static one."""
    distinct: dict[float, Line] = {}
    for line in lines:
        if line.multiple > 1e-12:
            distinct.setdefault(round(line.multiple, 12), line)
    return [distinct[multiple] for multiple in sorted(distinct)]


class _Loci:
    """Natural frequencies over speed, in ascending order: continuous, with kinks where they cross.

    Parameters
    ----------
    model : Model
        The discretized scene.
    top : float
        Top speed [rad/s].
    modes : int
        Number of modes.
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

    def crossings(self, kind: str, line: Line, indices: tuple[int, ...]) -> Iterator[Crossing]:
        """Find the crossings of a line with a natural frequency, or with the sum of two, given by indices."""

        def detuning(speed: float) -> float:
            return float(self.frequencies(np.array([speed]))[0, indices].sum()) - line.multiple * speed

        for a, b in _bracket(detuning, self.speeds, self._detunings(line, indices)):
            speed = brentq(detuning, a, b, xtol=_ROUNDING * b, rtol=_ROUNDING)  # pyright: ignore[reportArgumentType]
            yield self._crossing(kind, line, indices, float(speed), (detuning(b) - detuning(a)) / (b - a))

    def count_crossings(self, line: Line, indices: tuple[int, ...]) -> int:
        """Count the crossings of a line by the changes of sign over the speeds of the locus."""
        return int(np.count_nonzero(np.diff(self._detunings(line, indices) > 0)))

    def _detunings(self, line: Line, indices: tuple[int, ...]) -> np.ndarray:
        """Distance of a frequency, or of the sum of two, from a line [rad/s], at the speeds of the locus."""
        return self.values[:, indices].sum(axis=1) - line.multiple * self.speeds

    def _crossing(
        self, kind: str, line: Line, indices: tuple[int, ...], speed: float, slope: float
    ) -> Crossing:
        """Crossing at a root `speed`; the detuning's slope turns errors of frequency into speed."""
        solution = solve_with_error(self.model, np.array([speed]), self.modes)
        omega = self.frequencies(np.array([speed]))[0]
        error = np.abs(np.abs(solution.eigen.eigenvalue[0]) - omega) + solution.error[0] * omega
        node = int(np.searchsorted(self.speeds, speed)) - 1
        numbers = [int(np.flatnonzero(self.order[node] == index)[0]) + 1 for index in indices]
        return Crossing(
            line=line,
            mode=min(numbers),
            speed=speed,
            frequency=float(omega[indices[0]] / (2 * np.pi)),
            kind=kind,
            error=float(error[list(indices)].sum() / abs(slope * speed)) + _ROUNDING,
            second_mode=max(numbers) if len(set(numbers)) > 1 else None,
        )


def _bracket(f: Callable[[float], float], x: np.ndarray, y: np.ndarray) -> Iterator[tuple[float, float]]:
    """Bracket the roots of a function f with values y at x, also pairs of roots between two nodes."""
    for k in range(len(x) - 1):
        if y[k] * y[k + 1] < 0 or (y[k + 1] == 0 and y[k] != 0):
            yield float(x[k]), float(x[k + 1])
    size = np.abs(y)
    dips = (
        (size[1:-1] < size[:-2]) & (size[1:-1] <= size[2:]) & (y[1:-1] * y[:-2] > 0) & (y[1:-1] * y[2:] > 0)
    )
    for k in np.flatnonzero(dips) + 1:
        a, b, sign = float(x[k - 1]), float(x[k + 1]), np.sign(y[k])
        minimum = minimize_scalar(lambda v, s=sign: s * f(v), bounds=(a, b), method="bounded")
        if minimum.fun < 0:
            yield from ((a, float(minimum.x)), (float(minimum.x), b))
