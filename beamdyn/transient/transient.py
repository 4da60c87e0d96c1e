"""A transient, motion of a beam in time: its request and its result."""

from __future__ import annotations

import pathlib
from collections.abc import Iterator, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from functools import cached_property
from time import perf_counter
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from beamdyn._version import __version__
from beamdyn.accuracy.margins import MODES_OF_MOMENTS
from beamdyn.common.inputs.checks import InvalidValue, real, real_array
from beamdyn.common.results.one_line import error_at_most, number, warned
from beamdyn.common.results.pickling import FieldsOnly
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import Statement
from beamdyn.equations.effects import check_direction, modelled_directions
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice, ensure_size
from beamdyn.modes.modal.modal_basis import SPEED_SAMPLES, ModalBasis
from beamdyn.modes.modal.model import Model
from beamdyn.modes.model_error.effect_choice import warn_of_peak
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, StatesModelError
from beamdyn.scene.motion import Motion
from beamdyn.scene.scene import Scene
from beamdyn.scene.validity import warn_of_deflection, warn_of_left_out, warn_of_road
from beamdyn.transient.along_path import distance_along_path
from beamdyn.transient.elastica_system import ElasticaSystem
from beamdyn.transient.initial_state import initial_state, padded
from beamdyn.transient.integration import integrate
from beamdyn.transient.left_out_of_transient import left_out_of_transient
from beamdyn.transient.limits import check_growth, check_motion
from beamdyn.transient.missed_tolerance import warn_of_missed_steps
from beamdyn.transient.model_of_basis import choose_for_basis
from beamdyn.transient.root_strain import RootStrain
from beamdyn.transient.step_size import TooManySteps, follow_steps
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.tip_deflection import in_direction, magnitude_of, sample_tip
from beamdyn.transient.trajectory import Path, Size, Trajectory, largest_on

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from scipy.integrate import OdeSolver

_LIMIT_DIFFERENCE = 0.3  # from the refined run, over the largest deflection, that still bounds the error
_TIMES_COMPARED = 20_000  # times at which two runs are compared; at most twice as many
_MOTIONS_WITH_MORE_MODES = frozenset({"refined", "with_more_modes"})
_OF_TIME_ERROR = 0.1  # of the path, that is part of a distance found along it
_COMPUTED = *_MOTIONS_WITH_MORE_MODES, "mode_error"  # what a copy with further warnings keeps


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
        Tip deflection [m] in the direction across; zeros where one plane is modelled.
    coordinates, velocities : ndarray, shape (n, m)
        Modal coordinates [kg^1/2 m] and their rates.
    time_error : float
        Largest estimated time-integration error of the tip deflection [m]; nan for the methods
        of `solve_ivp`, which only bound the error of each step.  Where two planes are modelled, this is the
        magnitude of the error of a vector, as `largest` and `peak` are magnitudes.
    largest : float
        Largest |tip deflection| of the run [m].
    warnings : tuple of str
        Limitations of the result.
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
    system: ModalSystem | ElasticaSystem = field(repr=False)
    path: Path = field(repr=False)
    request: TransientRequest = field(repr=False)

    judged_by_solving: ClassVar[bool] = True

    def headline(self) -> Iterator[str]:
        """What it says in one line; see `Result.headline`."""
        error = f"time {error_at_most(self.time_error / (self.largest or 1.0))}"
        yield from (f"{number(self.path.end, 's')}: up to {self.say_length(self.largest)}", error)
        yield warned(self.warnings)

    @property
    def scene(self) -> Scene:
        """Scene."""
        return self.request.scene

    def without_waiting(self) -> Transient:
        """A copy to be shown at once, without model and modal truncation errors that are not computed yet."""
        vars(shown := copy(super().without_waiting())).setdefault("mode_error", np.inf)
        return shown

    @cached_property
    def refined(self) -> Transient | None:
        """Run with 1.5 times as many modes, at least two more; None if there is no larger model."""
        return self.request.run_refined()

    @cached_property
    def with_more_modes(self) -> tuple[ModalSystem | ElasticaSystem, Path] | None:
        """Equations and motion with the modes of `refined`, where possible in the steps of this run.

        None if there is no larger model.
        """
        linear = isinstance(self.system, ModalSystem) and "refined" not in self.__dict__
        if linear and isinstance(self.path, Trajectory) and self.path.in_equal_steps and self.time_error > 0:
            return self.request.follow_with_more_modes(self.path)
        return self.refined and (self.refined.system, self.refined.path)

    @cached_property
    def mode_error(self) -> float:
        """Estimated modal truncation error, over the largest deflection: twice the distance from `refined`.

        Unless `refined` has been computed, the distance is found along the path of this run, or else its
        modes are integrated in the steps of this run, where these ways do.

        The factor of two covers the error of `refined` itself: on random runs it was less than half of the
        distance (benchmark of the coverage of transients).  Infinite if there is no larger model that fits
        into memory, or if the distance is so large that the error of `refined` is unknown.
        """
        difference = self._distance_along_path()
        if difference is not None:
            difference += _OF_TIME_ERROR * self.time_error
        else:
            if self.with_more_modes is None:
                return np.inf
            difference = self.distance_from_path(*self.with_more_modes)
        if difference > _LIMIT_DIFFERENCE * self.largest:
            return np.inf
        return 2 * difference / self.largest if self.largest else 0.0

    def _distance_along_path(self) -> float | None:
        """Distance from `refined` [m], found along the path; None where that takes a motion of its own."""
        system, path = self.system, self.path
        if not (isinstance(system, ModalSystem) and isinstance(path, Trajectory)) or self.time_error == 0:
            return None
        if not _MOTIONS_WITH_MORE_MODES.isdisjoint(self.__dict__):
            return None
        return self.request.distance_with_more_modes(path, system)

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """What the effects left out would change in the largest deflection: changes of shape ()."""
        return left_out_of_transient(self)

    @property
    def relative_mode_error(self) -> float:
        """The same as `mode_error`."""
        return self.mode_error

    def with_warnings(self, more: tuple[str, ...]) -> Transient:
        """Copy with further warnings, which keeps the refined run if it has been computed."""
        copy = replace(self, warnings=(*self.warnings, *more))
        computed = {name: self.__dict__[name] for name in _COMPUTED if name in self.__dict__}
        copy.__dict__.update(computed)
        return copy

    def distance_from(self, other: Transient) -> float:
        """Largest difference of the tip deflection from that of another run of the same scene [m]."""
        return self.distance_from_path(other.system, other.path)

    def distance_from_path(self, system: ModalSystem | ElasticaSystem, path: Path) -> float:
        """Largest difference of the tip deflection from that of another motion of the same scene [m]."""
        t, q, _ = self.path.samples
        own = self.system.deflections(q)
        other_t, other = sample_tip(system, path)
        if not np.array_equal(t, other_t):
            some = slice(None, None, 1 + len(t) // _TIMES_COMPARED)
            own, other = own[some], system.deflections(path.at(t[some])[0])
        return float(magnitude_of(own - other).max())

    def to_dict(self) -> dict[str, Any]:
        """The result as plain numbers, lists and strings, `mode_error` included."""
        return {**super().to_dict(), "mode_error": self.mode_error}

    def at(self, t: np.ndarray | Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
        """Interpolate modal coordinates and velocities at times t [s] of the run: shapes (len(t), m).

        Raises
        ------
        ValueError
            If a time is no finite number, or lies outside the run.
        """
        return self.path.at(self._times_in_run(t))

    def _times_in_run(self, t: np.ndarray | Sequence[float] | float) -> np.ndarray:
        """Times as an array of shape (T,); a ValueError if one is not finite or lies outside the run."""
        t = real_array("t", t if np.iterable(t) else [t])  # pyright: ignore[reportArgumentType]
        if t.size and not (t.min() >= self.path.start and t.max() <= self.path.end * (1 + 1e-12)):
            raise ValueError(f"t: times must lie in the run, from {self.path.start:g} to {self.path.end:g} s")
        return t

    def shape(
        self, x: np.ndarray | Sequence[float], t: np.ndarray | Sequence[float], direction: int = 0
    ) -> np.ndarray:
        """Deflection [m] at positions x [m] and times t [s]: shape (len(t), len(x)).

        The direction is 0 for that of bending at the root, 1 for that across, in which a beam of one plane
        is rigid.
        """
        xi = np.asarray(x) / self.scene.beam.length
        return self.system.shape(self.at(t)[0], xi, direction)

    def root_strain(self, t: np.ndarray | Sequence[float]) -> np.ndarray:
        """Bending strain of the outer fibre at the root at times t [s]: shape (len(t),).

        It is found from the bending moment of the loads and the inertia along the whole beam, see
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
        """Estimated error of `root_strain`: three times its distance from `refined`, plus that of time.

        After a sudden load the modes contribute to the strain as k^-3, so that all those left out together
        are up to 2.2 times those that `refined` adds.  As for `mode_error`, it is infinite if there is no
        larger model, or if the distance is too large; as for `time_error`, it is nan for the methods of
        `solve_ivp`.
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
        if isinstance(self.system, ElasticaSystem):
            bound = "the root strain of a beam with large deflection is not computed"
            remedy = "leave large_deflection out where the deflection is small"
            raise InvalidValue("physics.large_deflection", True, bound, remedy)
        return RootStrain.of_scene(self.scene, self.request.model.discretization, self.system)

    def deflection(self, t: np.ndarray | Sequence[float], direction: int = 0) -> np.ndarray:
        """Tip deflection [m] at times t [s]: shape (len(t),); the direction as for `shape`."""
        return self.shape([self.scene.beam.length], t, direction)[:, 0]

    def energy(self, t: np.ndarray | Sequence[float]) -> np.ndarray:
        """Energy of the vibration [J] at times t [s]: q' q' / 2 + q K q / 2 - f q; constant if K, f are.

        With large deflection, kinetic energy relative to the rotating axes, elastic energy and the
        potential of the centrifugal forces and of the root's acceleration: constant, without damping, if
        the speed and that acceleration are.
        """
        t = self._times_in_run(t)
        return self.system.energy(t, *self.path.at(t))

    def peak(self, start: float, end: float, direction: int | None = None) -> float:
        """Largest |tip deflection| [m] from `start` to `end` [s], also between samples.

        Where two planes are modelled, it is the magnitude of a vector, or of its component in a direction:
        0 is that of bending at the root, 1 that across.
        """
        _check_window(start, end, self.path)
        return largest_on(self._size(direction), self.path, start, end)

    def _size(self, direction: int | None) -> Size:
        """Magnitude of the tip's deflection by the coordinates, or of its component in a direction."""
        if direction is None:
            return lambda q: magnitude_of(self.system.deflections(q))
        chosen = check_direction(direction)
        return lambda q: np.abs(in_direction(self.system.deflections(q), chosen))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the tip deflection over time."""
        from beamdyn.common.plots.plots import plot_transient

        names = modelled_directions(self.scene)
        tips = np.array([self.tip, self.tip_across][: len(names)])
        return plot_transient(self.t, tips, ax, names, self.display_units)

    def export(
        self, path: str | pathlib.Path, start: float, end: float, frames: int = 200, force: bool = False
    ) -> None:
        """Write the deflected beam from start to end [s] as a time series for ParaView."""
        from beamdyn.common.plots.export import write_series

        _check_window(start, end, self.path)
        x = np.linspace(0, self.scene.beam.length, 41)
        t = np.linspace(start, end, frames)
        write_series(path, x, t, self.shape(x, t), force=force, across=self.shape(x, t, 1))


def _check_window(start: float, end: float, path: Path) -> None:
    start, end = real("start", start, "s"), real("end", end, "s")
    if not path.start <= start < end <= path.end * (1 + 1e-12):
        raise ValueError(
            f"window = {start:g} ... {end:g} s: it must lie in the run, {path.start:g} ... {path.end:g} s"
        )


# Requests ------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class TransientRequest(FieldsOnly):
    """Checked arguments of `simulate`, with the modal basis in place of the number of modes."""

    scene: Scene
    t_end: float
    tolerance: float
    method: str | type[OdeSolver]
    discretization: DiscretizationChoice
    initial: str | np.ndarray
    t_eval: np.ndarray | None
    options: dict[str, Any]
    basis: ModalBasis

    def run(self) -> Transient:
        """Integrate with the modal basis of the request."""
        start = perf_counter()
        motion, t_end = self.motion, self.t_end
        model = self.model
        check_motion(motion, t_end, model)
        system = self._system(model)
        path, error, name = self._integrate(system, initial_state(self.initial, system))
        t, q, v = path.samples
        largest = largest_on(lambda q: magnitude_of(system.deflections(q)), path, path.start, path.end)
        check_growth(self.scene, largest)
        if self.t_eval is not None:
            t = self.t_eval
            q, v = path.at(t)
        tips = system.deflections(q)
        return Transient(
            t=t,
            tip=in_direction(tips, 0),
            tip_across=in_direction(tips, 1),
            coordinates=q,
            velocities=v,
            time_error=error,
            largest=largest,
            warnings=(
                *_warnings(self.scene, t_end, largest),
                *warn_of_missed_steps(error / largest if largest else 0.0, self.tolerance),
            ),
            provenance=Provenance(
                __version__, f"{name}, {self.basis} of {model.discretization}", "", perf_counter() - start
            ),
            system=system,
            path=path,
            request=self,
        )

    def _system(self, model: Model) -> ModalSystem | ElasticaSystem:
        """Equations of the run, without the coordinates that stay at rest."""
        if self.scene.physics.large_deflection:
            return ElasticaSystem.of_model(model, self.basis, self.motion)
        return self._modal_system(model)

    def _modal_system(self, model: Model) -> ModalSystem:
        """Equations of a run of a straight beam, without the coordinates that stay at rest."""
        equations = model.modal_equations(self.basis)
        if isinstance(self.initial, str):
            return ModalSystem.from_rest(equations, self.motion, self.t_end)
        return ModalSystem(equations, self.motion)

    def run_refined(self) -> Transient | None:
        """Integrate by Gauss collocation with more modes; None if there is no larger model or no solution."""
        return self._run_or_none(self._refined())

    def run_with_one_more(self) -> Transient | None:
        """Integrate with one more mode; None if there is no larger model or no solution."""
        basis = None if self.basis.modes is None else self.basis.with_one_more()
        return self._run_or_none(basis and self._with_basis(basis))

    @staticmethod
    def _run_or_none(request: TransientRequest | None) -> Transient | None:
        try:
            return request and request.run()
        except (ArithmeticError, TooManySteps):  # it grows without bound, or is too long, with more modes
            return None

    def follow_with_more_modes(self, path: Trajectory) -> tuple[ModalSystem | ElasticaSystem, Path] | None:
        """Integrate with the modes of `run_refined` in the steps of a path: equations and motion; or None.

        Two runs in the same steps differ by the modes of one of them; neither needs an error of its own.
        Where the steps are too long for what the further modes do, those of `run_refined` are taken.
        """
        request = self._refined_of_same_functions()
        if request is None:
            return None
        system = request._modal_system(request.model)
        try:
            finer, error = follow_steps(path, system, initial_state(request.initial, system), self.tolerance)
        except (ArithmeticError, TooManySteps):
            return None
        largest = float(magnitude_of(sample_tip(system, finer)[1]).max())
        if not error <= self.tolerance * largest < np.inf:
            run = self.run_refined()
            return run and (run.system, run.path)
        return system, finer

    def distance_with_more_modes(self, path: Trajectory, own: ModalSystem) -> float | None:
        """Distance of the tip from that with the modes of `run_refined` [m], found along a path; or None."""
        request = self._refined_of_same_functions()
        if request is None:
            return None
        system = request._modal_system(request.model)
        states = (initial_state(each.initial, s) for each, s in ((self, own), (request, system)))
        return distance_along_path(path, own, system, *states)

    def _refined_of_same_functions(self) -> TransientRequest | None:
        """As `_refined`, of the functions of this request if these suffice: no choice takes time."""
        request = self._refined()
        if request is None or request.basis.modes is None:
            return request
        own = self.model.discretization
        same = ensure_size(self.scene, own, request.basis.modes) is own
        return replace(request, discretization=own) if same else request

    def _refined(self) -> TransientRequest | None:
        """Request with more modes, or a finer discretization where the basis has all modes; None if none."""
        base = replace(self, method="auto", t_eval=None)
        return base._with_finer_discretization() if self.basis.modes is None else base._with_more_modes()

    def _with_more_modes(self) -> TransientRequest | None:
        """Request with more modes, by "ritz" if the discretization has too few functions; or None."""
        basis = self.basis.refined()
        return basis and self._with_basis(basis)

    def _with_basis(self, basis: ModalBasis) -> TransientRequest:
        """Request with a larger basis, by "ritz" if the discretization has too few functions."""
        assert basis.modes is not None and self.basis.modes is not None
        initial = padded(self.initial, self.basis.modes, basis.modes)
        discretization = ensure_size(self.scene, self.discretization, basis.modes)
        return replace(self, basis=basis, discretization=discretization, initial=initial)

    def _with_finer_discretization(self) -> TransientRequest | None:
        """Request with all functions of the next finer discretization; None if there is none."""
        finer = self.model.discretization.finer()
        return None if finer is None else replace(self, discretization=finer)

    @property
    def motion(self) -> Motion:
        """Motion of the scene."""
        assert self.scene.motion is not None
        return self.scene.motion

    @cached_property
    def model(self) -> Model:
        """The discretized scene, chosen for the modal basis and the tolerance."""
        return choose_for_basis(self.scene, self.discretization, self.basis, 1e-3 * self.tolerance)

    def _integrate(self, system: ModalSystem | ElasticaSystem, y0: np.ndarray) -> tuple[Path, float, str]:
        """Integrate: the path, its time-integration error [m], and the integrator's name."""
        if self.method == "auto":
            return integrate(system, y0, self.t_end, self.tolerance)
        from beamdyn.transient.scipy_integrators import integrate_by_solve_ivp

        name = self.method if isinstance(self.method, str) else self.method.__name__
        path = integrate_by_solve_ivp(system, y0, self.t_end, self.method, self.tolerance, self.options)
        return path, np.nan, name


def _warnings(scene: Scene, t_end: float, largest: float) -> Iterator[Statement]:
    yield from warn_of_left_out(scene)
    yield from warn_of_peak(scene, largest)
    if not scene.physics.large_deflection:
        yield from warn_of_deflection(np.array([largest]), scene.beam.length)
    if scene.motion is not None:
        road = scene.motion.at(np.linspace(0, t_end, SPEED_SAMPLES)).carrier_acceleration[:, 1]
        yield from warn_of_road(np.array([np.abs(road).max()]))
