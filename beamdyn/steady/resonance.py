"""Resonance speeds, at which an excitation line equals a natural frequency.

In shapes of arrays, S counts speeds, and m modes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement
from time import perf_counter

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, count, positive
from beamdyn.common.results import statements
from beamdyn.common.results.result import Provenance
from beamdyn.modes.modal.discretization_choice import (
    DiscretizationChoice,
    choose_model,
    model_to_tolerance,
    warn_of_missed_tolerance,
)
from beamdyn.modes.modal.eigenproblem import Eigensolver
from beamdyn.modes.modal.error_estimate import solve_with_error
from beamdyn.modes.modal.line_roots import ROUNDING, coincides, find_roots
from beamdyn.modes.modal.model import Model, plane_share
from beamdyn.modes.modal.solvers import UncoupledSolver, solve_over_speeds, track
from beamdyn.modes.model_error.effect_choice import choose_physics
from beamdyn.scene.motion.base import Line
from beamdyn.scene.names_elsewhere import WITH_WHEEL
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.scene.validity import check_speeds, refuse_tip_load, warn_of_left_out, warn_of_static_deflection
from beamdyn.steady.crossings import KINDS, Crossing, Crossings, order_by_speed
from beamdyn.steady.periodic_system import distinct_lines, excitation_lines, periodic_system

_HIGHEST_ORDER = 20  # highest accepted order of lines, whose search takes ten seconds
_NODES = 400  # number of intervals of speed in which roots are bracketed
# Number of intervals of speed for a beam with large deflection: fewer than for a straight beam, as an
# equilibrium is solved at each speed, and as the loci are smooth.
_BENT_NODES = 100
# Number of modes solved in addition to the requested ones: with speed, modes of other uncoupled parts of the
# equations may become lower than these.
_FURTHER_MODES = 2


@statements.announced
def resonance_speeds(
    scene: Scene,
    top_speed: float,
    modes: int = 3,
    order: int = 1,
    discretization: DiscretizationChoice = "ritz",
    tolerance: float | None = None,
) -> Crossings:
    """Find the speeds at which excitation lines equal natural frequencies.

    The roots of lambda_i(omega) - multiple omega, and of lambda_i + lambda_j - multiple omega, are bracketed
    on the continuous loci and refined to rounding error; in addition, minima of the distance are sought
    within intervals without a change of sign, so that two close roots are both found.  Damping is neglected.
    If no term couples two groups of modes, such as those of two planes of bending without twist, each group
    meets only the lines of its own loads and stiffness.

    Parameters
    ----------
    scene : Scene
        The scene; its motion defines the lines, and gravity adds the line of the rotation.
    top_speed : float
        Top speed [rad/s]; the search ends at the critical speed.
    modes : int
        Number of modes, the lowest ones at rest.
    order : int
        1: crossings lambda_i = a line of the load, and 2 lambda_i = a line of the stiffness.  n: also
        crossings with the lines that up to n - 1 products of the load with the periodic stiffness add, and
        lambda_i + lambda_j = sums and differences of up to n lines of the stiffness.  Crossings of order n +
        1 are only counted.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.
    tolerance : float, optional
        As for `natural_modes`, for the frequencies at rest and at the top speed.

    Returns
    -------
    Crossings

    Raises
    ------
    ValueError
        If an argument is out of its range, or the motion's steady state is not known.

    References
    ----------
    Lee and Yoo (2019), Fig. 7, the forced ones; parametric ones: Nayfeh and Mook (1979), Nonlinear
    Oscillations, chapter 5.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> wheel = bd.RollingWheel(0.3, 55.0, bd.RoadWave(0.3, velocity_amplitude=0.01))
    >>> found = bd.resonance_speeds(bd.Scene(strip, bd.Mount(radius=0.215), wheel), top_speed=150.0, modes=1)
    >>> [round(crossing.speed, 3) for crossing in found.crossings if crossing.kind == "forced"]  # rad/s
    [53.086, 69.802]
    """
    start = perf_counter()
    check_scene(scene)
    refuse_tip_load(scene)
    top = positive("top_speed", top_speed, "rad/s")
    check_speeds(top, "top_speed")
    modes, order = count("modes", modes), count("order", order, most=_HIGHEST_ORDER)
    scene = choose_physics(scene.undamped, [0.0, top], modes, tolerance)
    model = model_to_tolerance(scene, discretization, ends := np.array([0.0, top]), modes, tolerance)
    sprung = discretization == "fem" and model.equations.shift  # "fem" may not resolve root springs
    if sprung and not np.isfinite(solve_with_error(model, ends, modes).error).all():
        model = choose_model(scene, "ritz", ends, modes)
    critical = model.solver.critical_speed
    _check_stiffness(scene, critical)
    system = periodic_system(model.equations, scene.motion, np.array([min(top, critical)]))
    parts = [
        _UncoupledModes(
            loci, *(excitation_lines(system.part(loci.places), scene.motion, n) for n in (order, order + 1))
        )
        for loci in _split(model, min(top, critical), modes)
    ]
    numbers = np.argsort(np.concatenate([part.loci.numbers for part in parts]))
    tracked = np.concatenate([part.loci.tracked for part in parts], axis=1)[:, numbers]
    sought = [(part.loci, each) for part in parts for each in part.resonances(order)]
    crossings = [c for loci, each in sought for c in loci.crossings(*each)]
    names = str(model.discretization), str(model.coarser.discretization)
    forced, parametric = (distinct_lines(line for p in parts for line in p.lines[kind]) for kind in (0, 1))
    return Crossings(
        crossings=order_by_speed(crossings),
        lines=tuple(forced),
        speeds=parts[0].loci.speeds,
        frequency=tracked / (2 * np.pi),
        order=order,
        unlisted=sum(part.count_further(order, kind) for part in parts for kind in KINDS),
        may_peak=sum(part.count_further(order, "forced") for part in parts),
        warnings=(
            *(loci.describe_coincidence(*each) for loci, each in sought if loci.coincide(*each[1:])),
            *_warnings(model, discretization, (forced, parametric), crossings, order, top, critical),
            *warn_of_missed_tolerance(max((c.error for c in crossings), default=0.0), tolerance or np.inf),
        ),
        provenance=Provenance.since(start, *names),
        scene=scene,
    )


def _check_stiffness(scene: Scene, critical: float) -> None:
    """Raise an error if the critical speed is 0: the beam then turns over about its root at any speed."""
    if critical > 0:
        return
    in_plane = np.abs([np.cos(scene.mount.bending_angle), np.sin(scene.mount.bending_angle)])
    names = ("root_stiffness", "second_root_stiffness")[: scene.physics.planes]
    # The softer spring at the root; of equal springs, the one nearer the plane of rotation.
    spring, _, name = min(zip(scene.mount.root_stiffnesses, -in_plane, names, strict=False))
    bound, remedy = (
        ("the discretization does not resolve so soft a spring", 'give a stiffer one, or "ritz"')
        if spring
        else (
            "the beam is unstable at any speed, and does not vibrate",
            "give the hinge a spring, or let the beam point outward",
        )
    )
    raise InvalidValue(f"mount.{name}", spring, bound, remedy, "N m/rad")


@dataclass(frozen=True)
class _UncoupledModes:
    """Modes that are not coupled with other modes, with the lines of their loads and of their stiffness.

    Parameters
    ----------
    loci : _Loci
        Natural frequencies over speed.
    lines : pair of list of Line
        Lines of the load (forced) and of the stiffness (parametric), up to the requested order.
    more_lines : pair of list of Line
        Lines of the load and of the stiffness up to the next order.
    """

    loci: _Loci
    lines: tuple[list[Line], list[Line]]
    more_lines: tuple[list[Line], list[Line]]

    def resonances(self, order: int) -> dict[tuple[str, Line, tuple[int, ...]], None]:
        """List kind, line and mode indices of each resonance up to an order, as the keys of a dictionary."""
        return dict.fromkeys(_list_resonances(*self.lines, self.loci.modes, order))

    def count_further(self, order: int, kind: str) -> int:
        """Count the crossings, "forced" or "parametric", that the next order of lines would add."""
        sought, more = self.resonances(order), _list_resonances(*self.more_lines, self.loci.modes, order + 1)
        further = (each for each in more if each not in sought and each[0] == kind)
        return sum(self.loci.count_crossings(*each[1:]) for each in further)


def _list_resonances(
    forced: list[Line], parametric: list[Line], modes: int, order: int
) -> list[tuple[str, Line, tuple[int, ...]]]:
    """List kind, line and mode indices of each resonance up to an order.

    A "forced" resonance has the index of one mode; a "parametric" one has those of the two modes whose
    frequencies are added, which may be the same.
    """
    pairs = [p for p in combinations_with_replacement(range(modes), 2) if order > 1 or p[0] == p[1]]
    by_load = [("forced", line, (i,)) for line in forced for i in range(modes)]
    return [*by_load, *(("parametric", line, pair) for line in parametric for pair in pairs)]


def _warnings(
    model: Model,
    discretization: DiscretizationChoice,
    lines: tuple[list[Line], list[Line]],
    crossings: Sequence[Crossing],
    order: int,
    top: float,
    critical: float,
) -> Iterator[statements.Statement]:
    """Yield warnings: limits of the search, reasons for no result, and deflection beyond linear theory."""
    scene = model.scene
    if discretization == "fem" and model.discretization.order is None:
        said = "finite elements do not resolve the springs at the root; "
        said += f"{model.discretization} was used instead"
        yield statements.Statement(said, kind=statements.INPUT, quantity="discretization")
    yield from warn_of_left_out(scene)
    if top >= critical:
        yield statements.Statement(
            "searched up to the critical speed, ", statements.Speeds(critical), kind=statements.GROWING
        )
    names = ", ".join(dict.fromkeys(line.name for kind in lines for line in kind))
    if not names:
        motion = "has no motion" if scene.motion is None else f"has a {type(scene.motion).__name__}"
        said = f"nothing varies in time at steady speed: the scene {motion} and gravity = {scene.gravity:g}; "
        yield statements.Statement(said, WITH_WHEEL, kind=statements.EXCITATION, remedy=WITH_WHEEL)
    elif not crossings:
        begin, end = f"no mode meets a line of order {order} up to ", f"; lines: {names}"
        yield statements.Statement(
            begin, statements.Speeds(min(top, critical)), end, kind=statements.NO_ANSWER
        )
    if crossings and not scene.physics.large_deflection:
        speeds = np.array(sorted(c.speed for c in crossings))
        deflection = np.linalg.norm(model.static_tips(speeds), axis=1)
        yield from warn_of_static_deflection(deflection, scene.beam.length, speeds)


def _split(model: Model, top: float, modes: int) -> Iterator[_Loci]:
    """Yield the frequencies over speed of the modes lowest at rest, for each uncoupled part separately."""
    solver = model.solver
    uncoupled = isinstance(solver, UncoupledSolver)
    parts = (
        [*zip(solver.parts, solver.solvers, strict=True)] if uncoupled else [(np.arange(solver.size), solver)]
    )
    rest = [np.abs(s.eigenvalues(np.zeros(1), min(modes, s.size))[0]) for _, s in parts]
    part_of_mode = np.repeat(np.arange(len(parts)), [len(frequencies) for frequencies in rest])
    lowest = part_of_mode[np.argsort(np.concatenate(rest), kind="stable")[:modes]]
    for i, (places, of_part) in enumerate(parts):
        numbers = np.flatnonzero(lowest == i) + 1
        if len(numbers):
            yield _Loci(model, of_part, places, numbers, top)


class _Loci:
    """Natural frequencies over speed, sorted at each speed: the curves have kinks where modes cross.

    Parameters
    ----------
    model : Model
        The discretized scene.
    solver : Eigensolver
        Eigensolver of the part of the equations to which the modes belong; no term couples it with other
        parts.
    places : ndarray of int
        Indices of the solver's coordinates among those of the model.
    numbers : ndarray of int, shape (m,)
        Numbers of these modes among the modes of all parts, from 1, in the order at rest.
    top : float
        Top speed [rad/s].
    """

    def __init__(
        self, model: Model, solver: Eigensolver, places: np.ndarray, numbers: np.ndarray, top: float
    ) -> None:
        self.model, self.solver, self.places, self.numbers = model, solver, places, numbers
        self.modes = len(numbers)
        nodes = _BENT_NODES if model.scene.physics.large_deflection else _NODES
        self.speeds = np.linspace(0, top, nodes + 1)
        found = solve_over_speeds(self.solver, self.speeds, self.modes)
        self.values = np.abs(np.imag(found.eigenvalue))
        self.order, _ = track(found.vector, self.solver.pencil.M)

    @property
    def tracked(self) -> np.ndarray:
        """Angular frequencies [rad/s] of modes followed through crossings, (speeds, modes)."""
        return np.take_along_axis(self.values, self.order, axis=1)

    def frequencies(self, speeds: np.ndarray) -> np.ndarray:
        """Compute angular frequencies [rad/s] of all modes at speeds, ascending: (speeds, modes)."""
        return np.abs(np.imag(self.solver.eigenvalues(speeds, self.modes)))

    def crossings(self, kind: str, line: Line, indices: tuple[int, ...]) -> Iterator[Crossing]:
        """Yield the crossings of a line with the natural frequency, or sum of two, that `indices` select."""
        if self.coincide(line, indices):
            return

        def detuning(speed: float) -> float:
            return float(self.frequencies(np.array([speed]))[0, indices].sum()) - line.multiple * speed

        for speed, slope in find_roots(detuning, self.speeds, self._detunings(line, indices)):
            yield self._crossing(kind, line, indices, speed, slope)

    def count_crossings(self, line: Line, indices: tuple[int, ...]) -> int:
        """Count the sign changes over speed of a natural frequency, or the sum of two, minus a line."""
        if self.coincide(line, indices):
            return 0
        return int(np.count_nonzero(np.diff(self._detunings(line, indices) > 0)))

    def coincide(self, line: Line, indices: tuple[int, ...]) -> bool:
        """Return whether a line equals a natural frequency, or a sum of two, at all speeds (hinged beam)."""
        return coincides(self._detunings(line, indices), self.values[:, indices].sum(axis=1))

    def describe_coincidence(self, kind: str, line: Line, indices: tuple[int, ...]) -> str:
        """Describe in a sentence that a line equals a natural frequency at every speed."""
        modes = " and ".join(f"mode {number}" for number in sorted({int(self.numbers[i]) for i in indices}))
        return f"{modes} and the line {line.name} ({kind}) resonate at every speed, so there is no crossing"

    def _detunings(self, line: Line, indices: tuple[int, ...]) -> np.ndarray:
        """Compute a frequency, or the sum of two, minus a line [rad/s], at the speeds of the locus."""
        return self.values[:, indices].sum(axis=1) - line.multiple * self.speeds

    def _crossing(
        self, kind: str, line: Line, indices: tuple[int, ...], speed: float, slope: float
    ) -> Crossing:
        """Build the crossing at `speed`, a root of the detuning.

        The slope of the detuning over speed converts the error of the frequency to that of the speed.
        """
        omega = self.frequencies(np.array([speed]))[0]
        vectors = self.solver.solve(np.array([speed]), self.modes).vector[0]
        embedded = np.zeros((self.model.solver.size, self.modes), dtype=vectors.dtype)
        embedded[self.places] = vectors
        order = self.order[int(np.searchsorted(self.speeds, speed)) - 1].tolist()
        numbered = sorted((int(self.numbers[order.index(index)]), index) for index in set(indices))
        shares = [
            tuple(plane_share(self.model.equations, embedded[None, :, [index]])[0, 0].tolist())
            for _, index in numbered
        ]
        second = numbered[1][0] if len(numbered) > 1 else None
        return Crossing(
            line=line,
            mode=numbered[0][0],
            speed=speed,
            frequency=float(omega[indices[0]] / (2 * np.pi)),
            kind=kind,
            error=float(self._error(speed, omega[list(indices)]).sum() / abs(slope * speed)) + ROUNDING,
            second_mode=second,
            plane_share=shares[0],
            second_plane_share=None if second is None else shares[1],
        )

    def _error(self, speed: float, omega: np.ndarray) -> np.ndarray:
        """Estimate the errors of angular frequencies `omega` [rad/s] at a speed, from the complete model.

        That model has all coordinates, not only those of the requested modes.
        """
        size = self.model.solver.size
        further = 0 if len(self.places) == size else _FURTHER_MODES
        most = min(int(self.numbers[-1]) + further, size)
        solution = solve_with_error(self.model, np.array([speed]), most)
        solved = np.abs(solution.eigen.eigenvalue[0])
        same = np.abs(solved - omega[:, None]).argmin(axis=1)
        return np.abs(solved[same] - omega) + solution.error[0, same] * omega
