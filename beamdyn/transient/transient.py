"""Transients: the motion of a beam in time, as the result of `simulate`."""

from __future__ import annotations

import pathlib
from collections.abc import Iterator, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from time import perf_counter
from typing import Any, ClassVar

import numpy as np

from beamdyn.accuracy.refinement import MODES_OF_MOMENTS
from beamdyn.common.inputs.checks import InvalidValue, real, real_array
from beamdyn.common.plots.export import write_series
from beamdyn.common.plots.plots import plot_transient
from beamdyn.common.results.one_line import error_at_most, number, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import TOLERANCE, Statement
from beamdyn.common.words import Words
from beamdyn.equations.discretization import Discretization
from beamdyn.equations.effects import modelled_directions
from beamdyn.equations.root_moment import RootMoment, root_moment, strain_per_moment
from beamdyn.modes.modal.model import SPEED_SAMPLES
from beamdyn.modes.model_error.effect_choice import warn_of_peak
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, StatesModelError
from beamdyn.modes.model_error.sharp_bending import warn_of_sharp_bending
from beamdyn.scene.names_elsewhere import GIVE_IT
from beamdyn.scene.physics import how_without_large_deflection
from beamdyn.scene.scene import Scene
from beamdyn.scene.validity import warn_of_deflection, warn_of_left_out, warn_of_road
from beamdyn.transient.beam_in_space_system import AnySystem, BeamInSpaceSystem
from beamdyn.transient.left_out_of_transient import left_out_of_transient
from beamdyn.transient.problem import Solution, TransientProblem, unless_unbounded
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.time_error import estimate_time_error
from beamdyn.transient.trajectory import Path, Trajectory, in_direction, magnitude_of, sample_tip

# Largest distance from the refined run, over the largest deflection, that still gives an estimate of the
# error.
_LIMIT_DIFFERENCE = 0.3
_TIMES_COMPARED = 20_000  # largest number of times at which two runs are compared
_MOTIONS_WITH_MORE_MODES = frozenset({"refined", "with_more_modes"})
# The modal truncation error is estimated along the computed motion of a run, and inherits the error of this
# motion: this fraction of the run's time-integration error is added to the estimate.
_OF_TIME_ERROR = 0.1
# Computed attributes that are kept in a copy with further warnings.
_COMPUTED = *_MOTIONS_WITH_MORE_MODES, "mode_error"


@dataclass(frozen=True)
class Transient(StatesModelError):
    """Motion of a beam in time, as `simulate` computes it.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Times [s].
    tip : ndarray, shape (n,)
        Tip deflection [m] in the direction of bending at the root.
    tip_across : ndarray, shape (n,)
        Tip deflection [m] perpendicular to that direction and the axis; zeros where one plane is modelled.
    coordinates, velocities : ndarray, shape (n, modes)
        Modal coordinates [kg^1/2 m] and their rates.
    time_error : float
        Largest estimated time-integration error of the tip deflection [m]; nan for the methods
        of `solve_ivp`, which only bound the error of each step.  Where two planes are modelled, this is the
        magnitude of the error of a vector, as `largest` and `peak` are magnitudes.
    largest : float
        Largest |tip deflection| of the run [m].
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        How the result was computed.

    Notes
    -----
    The modal truncation error is `mode_error`, relative to `largest` as on `Sweep`; it takes a second motion
    at its first use.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> wheel = bd.RollingWheel(0.3, bd.SpinUp(55.0, duration=1.0), bd.RoadWave(0.3, velocity_amplitude=0.01))
    >>> run = bd.simulate(bd.Scene(strip, bd.Mount(radius=0.215), wheel), t_end=2.0, modes=2)
    >>> run.time_error < 1e-5 * run.largest, run.t.shape == run.tip.shape
    (True, True)
    """

    t: np.ndarray
    tip: np.ndarray
    tip_across: np.ndarray
    coordinates: np.ndarray
    velocities: np.ndarray
    time_error: float
    largest: float
    warnings: tuple[str, ...]
    provenance: Provenance
    system: AnySystem = field(repr=False)
    path: Path = field(repr=False)
    request: TransientRequest = field(repr=False)

    judged_by_solving: ClassVar[bool] = True

    def headline(self) -> Iterator[str]:
        """Yield duration, largest deflection and errors for a one-line summary; see `Result.headline`."""
        error = f"time {error_at_most(self.time_error / (self.largest or 1.0))}"
        yield from (f"{number(self.path.end, 's')}: up to {self.say_length(self.largest)}", error)
        yield warned(self.warnings)

    @property
    def scene(self) -> Scene:
        """Scene of the transient."""
        return self.request.scene

    @property
    def solution(self) -> Solution:
        """Solution of the run: equations, path, errors and largest deflection."""
        return Solution(self.system, self.path, self.time_error, self.largest)

    def without_waiting(self) -> Transient:
        """Return a copy to show at once, without error estimates that take long and are not computed yet."""
        vars(shown := copy(super().without_waiting())).setdefault("mode_error", np.inf)
        return shown

    @cached_property
    def refined(self) -> Transient | None:
        """Run with 1.5 times as many modes, at least two more; None if there is no larger model."""
        return self.request.run_refined()

    @cached_property
    def with_more_modes(self) -> tuple[AnySystem, Path] | None:
        """Equations and motion with the modes of `refined`, in the same time steps if possible.

        The value is None if there is no larger model.
        """
        linear = isinstance(self.system, ModalSystem) and "refined" not in self.__dict__
        if linear and isinstance(self.path, Trajectory) and self.path.in_equal_steps and self.time_error > 0:
            return self.request.follow_with_more_modes(self.path)
        return self.refined and (self.refined.system, self.refined.path)

    @cached_property
    def mode_error(self) -> float:
        """Estimated modal truncation error, over the largest deflection: twice the distance from `refined`.

        Unless `refined` has been computed, the distance is estimated along the motion of this run
        (`along_path`), or the further modes are integrated in the time steps of this run, if one of these
        methods is applicable.

        The factor of two covers the error of `refined` itself: in random runs it was less than half of the
        distance (benchmark of the coverage of transients).  It is inf if there is no larger model that fits
        into memory, or if the distance is so large that the error of `refined` is unknown.
        """
        system, path, difference = self.system, self.path, None
        known = self.time_error == 0 or not _MOTIONS_WITH_MORE_MODES.isdisjoint(self.__dict__)
        if isinstance(system, ModalSystem) and isinstance(path, Trajectory) and not known:
            difference = self.request.distance_with_more_modes(path, system)
        if difference is not None:
            difference += _OF_TIME_ERROR * self.time_error
        elif self.with_more_modes is None:
            return np.inf
        else:
            difference = self.distance_from_path(*self.with_more_modes)
        if difference > _LIMIT_DIFFERENCE * self.largest:
            return np.inf
        return 2 * difference / self.largest if self.largest else 0.0

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """Relative changes of the largest deflection by each neglected effect, of shape ()."""
        return left_out_of_transient(self.request, self.solution)

    def with_warnings(self, more: tuple[str, ...]) -> Transient:
        """Return a copy with further warnings, which keeps the refined run if it has been computed."""
        copy = replace(self, warnings=(*self.warnings, *more))
        copy.__dict__.update({name: self.__dict__[name] for name in _COMPUTED if name in self.__dict__})
        return copy

    def distance_from(self, other: Transient) -> float:
        """Find the largest difference [m] of tip deflections between this and another run of the scene."""
        return self.distance_from_path(other.system, other.path)

    def distance_from_path(self, system: AnySystem, path: Path) -> float:
        """Find the largest difference of the tip deflection from another motion of the scene [m]."""
        t, q, _ = self.path.samples
        own = self.system.deflections(q)
        other_t, other = sample_tip(system, path)
        if not np.array_equal(t, other_t):
            some = slice(None, None, 1 + len(t) // _TIMES_COMPARED)
            own, other = own[some], system.deflections(path.at(t[some])[0])
        return float(magnitude_of(own - other).max())

    def to_dict(self) -> dict[str, Any]:
        """Convert the result to numbers, lists and strings, including `mode_error`."""
        return {**super().to_dict(), "mode_error": self.mode_error}

    def at(self, t: np.ndarray | Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
        """Interpolate modal coordinates and velocities at times t [s] within the run: shapes (len(t), m).

        Raises
        ------
        ValueError
            If a time is not finite, or lies outside the run.
        """
        return self.path.at(self._times_in_run(t))

    def _times_in_run(self, t: np.ndarray | Sequence[float] | float) -> np.ndarray:
        """Convert times to an array with one axis; a ValueError if one is not finite or outside the run."""
        t = real_array("t", t if np.iterable(t) else [t])  # pyright: ignore[reportArgumentType]
        if t.size and not (t.min() >= self.path.start and t.max() <= self.path.end * (1 + 1e-12)):
            raise ValueError(f"t: times must lie in the run, from {self.path.start:g} to {self.path.end:g} s")
        return t

    def shape(
        self, x: np.ndarray | Sequence[float], t: np.ndarray | Sequence[float], direction: int = 0
    ) -> np.ndarray:
        """Compute the deflection [m] at positions x [m] and times t [s]: shape (len(t), len(x)).

        Direction 0 is the bending direction at the root, 1 is perpendicular to it and to the axis: a beam
        with one plane of bending is rigid in direction 1.
        """
        xi = np.asarray(x) / self.scene.beam.length
        return self.system.shape(self.at(t)[0], xi, direction)

    def surface(
        self,
        x: np.ndarray | Sequence[float],
        eta: np.ndarray | Sequence[float],
        t: np.ndarray | Sequence[float],
    ) -> np.ndarray:
        """Compute the deflection [m] over a strip's area at times t [s]: (len(t), len(x), len(eta)).

        Positions and direction are defined as in `Modes.surface`.
        """
        xi = np.asarray(x) / self.scene.beam.length
        return self.system.surface(self.at(t)[0], xi, np.asarray(eta))

    def root_strain(self, t: np.ndarray | Sequence[float]) -> np.ndarray:
        """Compute the outer fibre's bending strain at the root at times t [s]: shape (len(t),).

        The strain follows from the bending moment of loads and inertia along the whole beam, see
        `beamdyn.equations.root_moment`; its error is `root_strain_error`.

        Raises
        ------
        ValueError
            If the beam has no outer fibre, or a time lies outside the run.
        """
        t = self._times_in_run(t)
        return self._root_strain.at(t, *self.path.at(t))

    @cached_property
    def root_strain_error(self) -> float:
        """Estimated error of `root_strain`: three times its distance from `refined`, plus the time error.

        After a sudden load, mode k contributes to the strain as k^-3, so that all neglected modes together
        contribute up to 2.2 times the contribution added by `refined`.  As for `mode_error`, it is inf if
        there is no larger model, or if the distance is too large; as for `time_error`, it is nan for the
        methods of `solve_ivp`.
        """
        if self.refined is None:
            return np.inf
        t, q, v = (x[:: 1 + len(x) // _TIMES_COMPARED] for x in self.path.samples)
        strain = self._root_strain.at(t, q, v)
        difference = float(np.abs(strain - self.refined.root_strain(t)).max())
        if difference > _LIMIT_DIFFERENCE * np.abs(strain).max():
            return np.inf
        return MODES_OF_MOMENTS.factor * difference + self._root_strain.time_error(self.path, self.time_error)

    @cached_property
    def _root_strain(self) -> RootStrain:
        """Bending strain at the root, as a function of coordinates and velocities."""
        return RootStrain.of_scene(self.scene, self.request.model.discretization, self.system)

    def deflection(self, t: np.ndarray | Sequence[float], direction: int = 0) -> np.ndarray:
        """Compute the tip deflection [m] at times t [s]: shape (len(t),); for the direction see `shape`."""
        return self.shape([self.scene.beam.length], t, direction)[:, 0]

    def energy(self, t: np.ndarray | Sequence[float]) -> np.ndarray:
        """Compute the energy of the vibration [J] at times t [s], q' q' / 2 + q K q / 2 - f q.

        With large deflection it is the sum of the kinetic energy relative to the rotating axes, the elastic
        energy, and the potential of centrifugal forces, of the root's acceleration and of a tip force of
        fixed direction.  Without damping this sum is constant if speed and root acceleration are constant; a
        tip moment, or a load that rotates with the tip, does additional work.
        """
        t = self._times_in_run(t)
        return self.system.energy(t, *self.path.at(t))

    def peak(self, start: float, end: float, direction: int | None = None) -> float:
        """Find the largest |tip deflection| [m] from `start` to `end` [s], also between samples.

        If two planes are modelled, this is the magnitude of the deflection vector, or of its component in a
        direction: 0 is the bending direction at the root, 1 is perpendicular to it and to the axis.
        """
        self._check_window(start, end)
        return self.solution.peak(start, end, direction)

    def _check_window(self, start: float, end: float) -> None:
        """Raise an error for a time window [s] that is not within the run."""
        (start, end), path = (real("start", start, "s"), real("end", end, "s")), self.path
        if not path.start <= start < end <= path.end * (1 + 1e-12):
            within = f"it must lie in the run, {path.start:g} ... {path.end:g} s"
            raise ValueError(f"window = {start:g} ... {end:g} s: {within}")

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the tip deflection over time."""
        names = modelled_directions(self.scene)
        tips = np.array([self.tip, self.tip_across][: len(names)])
        return plot_transient(self.t, tips, ax, names, self.display_units)

    def export(
        self, path: str | pathlib.Path, start: float, end: float, frames: int = 200, force: bool = False
    ) -> None:
        """Write the deflected beam over time as a mesh with a displacement field at each time, for ParaView.

        A strip that twists or cambers is written as a surface with its true width; any other beam as a ribbon
        a tenth of its length wide.

        Parameters
        ----------
        path : str or Path
            File to write, .xdmf.
        start, end : float
            First and last time [s], within the run.
        frames : int
            Number of times, evenly spread from `start` to `end`.
        force : bool
            Overwrite a file that exists.

        Raises
        ------
        ValueError
            If the times are not within the run, or the suffix is unknown.
        FileExistsError
            If the file exists and `force` is not set.
        OSError
            If it cannot be written.
        """
        self._check_window(start, end)
        t, places = np.linspace(start, end, frames), self.request.model.over_strip(41, 11)
        if places is None:
            x, width = np.linspace(0, self.scene.beam.length, 41), None
            deflection = self.shape(x, t)
        else:
            x, eta, y = places
            deflection, width = self.surface(x, eta, t), np.ptp(y, axis=1)
        write_series(path, x, t, deflection, width, force, self.shape(x, t, 1))


@dataclass(frozen=True)
class TransientRequest(TransientProblem):
    """Checked arguments of `simulate`; methods run the simulation and build the result."""

    def run(self) -> Transient:
        """Integrate the motion with the modal basis of the request, and build the result."""
        start = perf_counter()
        solution = self.solve()
        t, q, v = solution.path.samples
        if self.t_eval is not None:
            t = self.t_eval
            q, v = solution.path.at(t)
        tips = solution.system.deflections(q)
        method = f"{solution.method}, {self.basis} of {self.model.discretization}"
        return Transient(
            t=t,
            tip=in_direction(tips, 0),
            tip_across=in_direction(tips, 1),
            coordinates=q,
            velocities=v,
            time_error=solution.error,
            largest=solution.largest,
            warnings=tuple(self._warnings(solution)),
            provenance=Provenance.since(start, method),
            system=solution.system,
            path=solution.path,
            request=self,
        )

    def _warnings(self, solution: Solution) -> Iterator[Statement]:
        """Yield warnings about a solution, such as a missed tolerance."""
        scene, largest = self.scene, solution.largest
        yield from warn_of_left_out(scene)
        yield from warn_of_peak(scene, largest)
        if scene.physics.large_deflection:
            t, q, _ = solution.path.samples
            assert isinstance(solution.system, BeamInSpaceSystem)
            bending = partial(solution.system.elastica.curvature, q)
            yield from warn_of_sharp_bending(scene, bending, lambda k: f"at {t[k]:.4g} s")
        else:
            yield from warn_of_deflection(np.array([largest]), scene.beam.length)
        if self.motion.road_multiple is not None:
            road = self.motion.at(np.linspace(0, self.t_end, SPEED_SAMPLES)).carrier_acceleration[:, 1]
            yield from warn_of_road(np.array([np.abs(road).max()]))
        error = solution.error / largest if largest else 0.0
        said = f"{error:.2g} of the largest deflection, and smaller steps would only add rounding errors; "
        yield from _warn_of_missed(
            "time-integration error", error, self.tolerance, said, "give a larger tolerance"
        )

    def run_refined(self) -> Transient | None:
        """Integrate by Gauss collocation with more modes; None if there is no larger model or no solution."""
        finer = self.refined()
        return finer and unless_unbounded(finer.run)

    def run_with_one_more(self) -> Transient | None:
        """Integrate with one more mode; None if there is no larger model or no solution."""
        larger = self.with_one_more()
        return larger and unless_unbounded(larger.run)


def warn_of_missed_modes(error: float, tolerance: float, basis: str) -> Iterator[Statement]:
    """Warn if the modal truncation error, relative to the largest deflection, exceeds the tolerance.

    The error is inf if it is not known; the argument `basis` describes the modal basis in words.
    """
    size = f"{error:.2g} of the largest deflection" if np.isfinite(error) else "not known"
    more = "and more modes would take too long or too much memory; a sudden motion excites very many: "
    remedy = "give a larger tolerance, a smoother motion, or the number of modes yourself"
    yield from _warn_of_missed(
        "modal truncation error", error, tolerance, f"{size} with {basis}, {more}", remedy
    )


def _warn_of_missed(what: str, error: float, tolerance: float, said: str, remedy: str) -> Iterator[Statement]:
    """Warn if an error, relative to the largest deflection, exceeds the tolerance; `said` states its size."""
    if error > tolerance:
        yield Statement(
            f"tolerance = {tolerance:g} is not reached: the estimated {what} is {said}",
            remedy,
            kind=TOLERANCE,
            quantity=f"{what} over the largest deflection",
            value=error,
            limit=tolerance,
            remedy=remedy,
        )


# Strain and curvature at the root ----------------------------------------------------------------------

_TIMES_CHECKED = 257  # number of times at which the strain per unit of each coordinate is evaluated


@dataclass(frozen=True)
class RootStrain:
    """Bending strain of the outer fibre at the root, as a function of coordinates and velocities in a run.

    Parameters
    ----------
    system : ModalSystem
        Equations of motion of the run.
    moment : RootMoment
        Bending moment at the root.
    per_moment : float
        Strain per bending moment [1/(N m)].
    """

    system: ModalSystem
    moment: RootMoment
    per_moment: float

    @classmethod
    def of_scene(cls, scene: Scene, discretization: Discretization, system: AnySystem) -> RootStrain:
        """Build the strain for the coordinates of a scene's equations.

        A ValueError is raised for large deflection, a material that damps, or a beam without outer fibre.
        """
        if isinstance(system, BeamInSpaceSystem):
            bound = "the root strain of a beam with large deflection is not computed"
            remedy = how_without_large_deflection(scene.beam, scene.physics_choice is not None)
            raise InvalidValue("physics.large_deflection", True, bound, remedy)
        if scene.beam.outer_fibre is None:
            raise ValueError(Words("root_strain needs outer_fibre: ", GIVE_IT))
        if scene.damping.stiffness_factor:
            bound = "the strain of a material that damps is not a function of the moment alone"
            remedy = "give damping.ratios, or use frequency_response"
            factor = scene.damping.stiffness_factor
            raise InvalidValue("damping.stiffness_factor", factor, bound, remedy, "s")
        return cls(system, root_moment(scene, discretization, system.equations), strain_per_moment(scene))

    def at(self, t: np.ndarray, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Evaluate the strain at T times t [s], with n coordinates q and velocities v (T, n): shape (T,)."""
        return self.per_moment * self.moment.at(self.system.root(t), q, v)

    def time_error(self, path: Path, of_tip: float) -> float:
        """Estimate the strain's time-integration error in a run from the error of the tip deflection [m].

        The result is nan if the error of the tip deflection is not known, and 0 if the beam stays in
        equilibrium.
        """
        if of_tip == 0 or not isinstance(path, Trajectory):
            return of_tip
        root = self.system.root(np.linspace(path.start, path.end, _TIMES_CHECKED))
        rows = np.zeros((_TIMES_CHECKED, self.system.size))  # strain per unit of each coordinate
        for quantity, row in self.moment.position.items():
            rows += np.outer(getattr(root, quantity), row)
        largest = self.per_moment * rows[None, np.abs(rows).sum(axis=1).argmax()]
        return estimate_time_error(self.system, path.segments, largest).total
