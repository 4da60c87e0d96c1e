"""A transient, motion of a beam in time: its request and its result."""

from __future__ import annotations

import pathlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.integrate import OdeSolver

from beamdyn._version import __version__
from beamdyn.common.checks import InvalidValue, real, real_array
from beamdyn.common.pickling import FieldsOnly
from beamdyn.common.results import Provenance
from beamdyn.equations.directions import check_direction, modelled_directions
from beamdyn.modal.choice import DiscretizationChoice, ensure_size
from beamdyn.modal.modal_basis import SPEED_SAMPLES, ModalBasis
from beamdyn.modal.model import Model
from beamdyn.model_error.choice import warn_of_peak
from beamdyn.model_error.left_out_effects import LeftOutEffects, StatesModelError
from beamdyn.scene.motion import Motion
from beamdyn.scene.scene import Scene
from beamdyn.scene.validity import warn_of_deflection, warn_of_left_out, warn_of_road
from beamdyn.transient.elastica_system import ElasticaSystem
from beamdyn.transient.initial_state import initial_state
from beamdyn.transient.integration import integrate
from beamdyn.transient.left_out_of_transient import left_out_of_transient
from beamdyn.transient.limits import check_growth, check_motion
from beamdyn.transient.missed_tolerance import warn_of_missed_modes, warn_of_missed_steps
from beamdyn.transient.model_of_basis import choose_for_basis
from beamdyn.transient.root_strain import RootStrain
from beamdyn.transient.scipy_integrators import integrate_by_solve_ivp
from beamdyn.transient.step_size import TooManySteps, follow_steps
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.trajectory import SAMPLES, Path, Size, Trajectory, largest_on

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LIMIT_DIFFERENCE = 0.3  # from the refined run, over the largest deflection, that still bounds the error
_STRAIN_MARGIN = 3.0  # error of the root strain over its distance from the refined run
_TIMES_COMPARED = 20_000  # times at which two runs are compared; at most twice as many
_COMPUTED = "refined", "with_more_modes", "mode_error"  # what a copy with further warnings keeps
_MOST_WORK = 5e7  # steps times squared size of a run (some seconds) beyond which "auto" adds no more modes
_SLOW_WORK = 5e6  # the same if the last modes added have reduced the truncation error by less than _FAST
_FAST = 4.0
_TIGHT = 1e-5  # tolerance below which, if the modes miss it, this one is tried as well


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
        magnitude of the error of a vector, as `largest`, `peak` and `mode_error` are magnitudes.
    largest : float
        Largest |tip deflection| of the run [m].
    warnings : tuple of str
        Limitations of the result.
    provenance : Provenance
        How the result was computed.

    Notes
    -----
    The modal truncation error is `mode_error`, which takes a second motion at its first use.
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

    @property
    def scene(self) -> Scene:
        """Scene."""
        return self.request.scene

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
        """Estimated modal truncation error of the tip deflection [m]: twice its distance from `refined`.

        Unless `refined` has been computed, its modes are integrated in the steps of this run if they do.

        The factor of two covers the error of `refined` itself: on random runs it was less than half of the
        distance (benchmark of the coverage of transients).  Infinite if there is no larger model that fits
        into memory, or if the distance is so large that the error of `refined` is unknown.
        """
        if self.with_more_modes is None:
            return np.inf
        difference = self._distance(*self.with_more_modes)
        return np.inf if difference > _LIMIT_DIFFERENCE * self.largest else 2 * difference

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """What the effects left out would change in the largest deflection: changes of shape ()."""
        return left_out_of_transient(self)

    @property
    def relative_mode_error(self) -> float:
        """`mode_error` over the largest deflection; 0 for a beam that does not move."""
        return self.mode_error / self.largest if self.largest else 0.0

    def with_warnings(self, more: tuple[str, ...]) -> Transient:
        """Copy with further warnings, which keeps the refined run if it has been computed."""
        copy = replace(self, warnings=(*self.warnings, *more))
        computed = {name: self.__dict__[name] for name in _COMPUTED if name in self.__dict__}
        copy.__dict__.update(computed)
        return copy

    def distance_from(self, other: Transient) -> float:
        """Largest difference of the tip deflection from that of another run of the same scene [m]."""
        return self._distance(other.system, other.path)

    def _distance(self, system: ModalSystem | ElasticaSystem, path: Path) -> float:
        """Largest difference of the tip deflection from that of another motion of the same scene [m]."""
        (t, q, _), (other_t, other_q, _) = self.path.samples, path.samples
        if not np.array_equal(t, other_t):
            some = slice(None, None, 1 + len(t) // _TIMES_COMPARED)
            q, other_q = q[some], path.at(t[some])[0]
        return float(magnitude_of(self.system.deflections(q) - system.deflections(other_q)).max())

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
        return _STRAIN_MARGIN * difference + self._root_strain.time_error(self.path, self.time_error)

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
        from beamdyn.output.plots import plot_transient

        names = modelled_directions(self.scene)
        return plot_transient(self.t, np.array([self.tip, self.tip_across][: len(names)]), ax, names)

    def export(
        self, path: str | pathlib.Path, start: float, end: float, frames: int = 200, force: bool = False
    ) -> None:
        """Write the deflected beam from start to end [s] as a time series for ParaView."""
        from beamdyn.output.export import write_series

        _check_window(start, end, self.path)
        x = np.linspace(0, self.scene.beam.length, 41)
        t = np.linspace(start, end, frames)
        write_series(path, x, t, self.shape(x, t), force=force, across=self.shape(x, t, 1))


def magnitude_of(deflections: np.ndarray) -> np.ndarray:
    """Magnitude (...) of deflections in each direction (..., 1 or 2)."""
    return np.hypot.reduce(np.abs(np.moveaxis(deflections, -1, 0)))


def in_direction(deflections: np.ndarray, direction: int) -> np.ndarray:
    """Deflection (...) in a direction, from those in each (..., 1 or 2); 0 where that is not modelled."""
    if direction >= deflections.shape[-1]:
        return np.zeros(deflections.shape[:-1])
    return deflections[..., direction]


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
        equations = model.modal_equations(self.basis)
        if isinstance(self.initial, str):
            return ModalSystem.from_rest(equations, self.motion, self.t_end)
        return ModalSystem(equations, self.motion)

    def run_refined(self) -> Transient | None:
        """Integrate by Gauss collocation with more modes; None if there is no larger model or no solution."""
        request = self._refined()
        try:
            return request and request.run()
        except (ArithmeticError, TooManySteps):  # it grows without bound, or is too long, with more modes
            return None

    def follow_with_more_modes(self, path: Trajectory) -> tuple[ModalSystem | ElasticaSystem, Path] | None:
        """Integrate with the modes of `run_refined` in the steps of a path: equations and motion; or None.

        Two runs in the same steps differ by the modes of one of them; neither needs an error of its own.
        Where the steps are too long for what the further modes do, those of `run_refined` are taken.
        """
        request = self._refined()
        if request is None:
            return None
        system = request._system(request.model)
        assert isinstance(system, ModalSystem)
        try:
            finer, error = follow_steps(path, system, initial_state(request.initial, system), self.tolerance)
        except (ArithmeticError, TooManySteps):
            return None
        largest = float(magnitude_of(system.deflections(finer.samples[1])).max())
        if not error <= self.tolerance * largest < np.inf:
            run = self.run_refined()
            return run and (run.system, run.path)
        return system, finer

    def _refined(self) -> TransientRequest | None:
        """Request with more modes, or a finer discretization where the basis has all modes; None if none."""
        base = replace(self, method="auto", t_eval=None)
        return base._with_finer_discretization() if self.basis.modes is None else base._with_more_modes()

    def run_smallest_basis(self) -> Transient:
        """Integrate with the smallest basis that meets the tolerance, else with the best that is known."""
        run = replace(self, method="auto", t_eval=None)._search()
        if run.relative_mode_error > self.tolerance and self.tolerance < _TIGHT:
            # Accurate steps leave less work for modes: with coarser ones the whole error may be smaller.
            coarse = replace(self, method="auto", t_eval=None, tolerance=_TIGHT)._search()
            run = min(run, coarse, key=lambda run: run.time_error + run.mode_error)
        missed = tuple(warn_of_missed_modes(run.relative_mode_error, self.tolerance, str(run.request.basis)))
        as_requested = self.method == "auto" and self.t_eval is None
        run = run if as_requested else replace(self, basis=run.request.basis).run()
        return run.with_warnings(missed) if missed else run

    def _search(self) -> Transient:
        """Add modes until the truncation error meets the tolerance, or takes too much work."""
        run = self.run()
        if run.mode_error > self.tolerance * run.largest and run.refined is not None:
            # A sudden motion excites many modes: as many modes at rest may then be the better basis.
            at_rest = replace(run.request, basis=ModalBasis(run.system.equations.modes)).run()
            run = at_rest if at_rest.distance_from(run.refined) < run.distance_from(run.refined) else run
        return _add_modes(run, self.tolerance)

    def _with_more_modes(self) -> TransientRequest | None:
        """Request with more modes, by "ritz" if the discretization has too few functions; or None."""
        basis = self.basis.refined()
        if basis is None or basis.modes is None or self.basis.modes is None:
            return None
        initial = self._pad_initial(self.basis.modes, basis.modes)
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
        name = self.method if isinstance(self.method, str) else self.method.__name__
        path = integrate_by_solve_ivp(system, y0, self.t_end, self.method, self.tolerance, self.options)
        return path, np.nan, name

    def _pad_initial(self, modes: int, more: int) -> str | np.ndarray:
        """Extend the initial coordinates and velocities to more modes by zeros."""
        if isinstance(self.initial, str):
            return self.initial
        parts = np.reshape(self.initial, (-1, modes))
        return np.hstack([parts, np.zeros((len(parts), more - modes))]).ravel()


def _add_modes(run: Transient, tolerance: float) -> Transient:
    """Refine a run until its truncation error meets the tolerance, while that is known and takes seconds."""
    before = np.inf
    while run.mode_error > tolerance * run.largest and (finer := run.refined) is not None:
        most = _MOST_WORK if run.mode_error * _FAST < before else _SLOW_WORK
        if _work(finer) > most or finer.with_more_modes is None:
            break
        run, before = finer, run.mode_error
    return run


def _work(run: Transient) -> float:
    """Steps times squared number of coordinates, to which the time of a run is roughly proportional."""
    return len(run.path.samples[0]) / SAMPLES * run.system.size**2


def _warnings(scene: Scene, t_end: float, largest: float) -> Iterator[str]:
    yield from warn_of_left_out(scene)
    yield from warn_of_peak(scene, largest)
    if not scene.physics.large_deflection:
        yield from warn_of_deflection(np.array([largest]), scene.beam.length)
    if scene.motion is not None:
        road = scene.motion.at(np.linspace(0, t_end, SPEED_SAMPLES)).carrier_acceleration[:, 1]
        yield from warn_of_road(np.array([np.abs(road).max()]))
