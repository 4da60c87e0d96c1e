"""Motion in time: transients of a scene."""

from __future__ import annotations

import pathlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.integrate import OdeSolver, solve_ivp

from beamdyn._version import __version__
from beamdyn.common.checks import ascending, count, positive, real, within
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.results import Provenance, Result
from beamdyn.equations.operators import Discretization
from beamdyn.modal.error_estimate import Model, choose, roomy
from beamdyn.modal.modal_basis import FEWEST, SAMPLED_TIMES, Kept, ModalEquations, range_of_speed
from beamdyn.scene.motion import Motion
from beamdyn.scene.scene import Scene
from beamdyn.spectrum.modes import LARGE_DEFLECTION
from beamdyn.transient.gauss import GaussCollocation
from beamdyn.transient.step_size import (
    SAMPLES,
    TOLERANCES,
    Path,
    integrate,
    largest_deflection,
    tip_deflection,
)
from beamdyn.transient.system import ModalSystem

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_STOCK = ("RK23", "RK45", "DOP853", "Radau", "BDF", "LSODA")
_GRAVITY = 9.81
_UNBOUNDED = 1000.0  # deflection over the length, past which no digit means anything
_UNRESOLVED = 0.3  # what a richer run may add, over the largest deflection, to tell an error
_COMPARED = 20_000  # times at which runs are compared, at most twice as many


@dataclass(frozen=True)
class Transient(Result):
    """Motion of a beam in time.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Times [s].
    tip : ndarray, shape (n,)
        Tip deflection [m].
    coordinates, velocities : ndarray, shape (n, m)
        Modal coordinates [kg^1/2 m] and their rates.
    time_error : float
        Estimated largest error of the tip deflection by the steps in time [m]; nan for the stock
        methods of `solve_ivp`, which only bound the error of each step.
    largest : float
        Largest tip deflection of the run, either way [m].
    warnings : tuple of str
        What limits the answer.
    provenance : Provenance
        How it was found.

    Notes
    -----
    The error by the modes left out is `mode_error`, which takes a second run when first asked for.
    """

    t: np.ndarray
    tip: np.ndarray
    coordinates: np.ndarray
    velocities: np.ndarray
    time_error: float
    largest: float
    warnings: tuple[str, ...]
    provenance: Provenance
    modal: ModalEquations = field(repr=False)
    system: ModalSystem = field(repr=False)
    path: Path = field(repr=False)
    task: Task = field(repr=False)

    @property
    def scene(self) -> Scene:
        """The scene."""
        return self.task.scene

    @cached_property
    def richer(self) -> Transient | None:
        """The same run with half as many modes more, at least two; None if there is no richer model."""
        return self.task.richer()

    @cached_property
    def mode_error(self) -> float:
        """Estimated largest error of the tip deflection by the modes left out [m]: twice what `richer` adds.

        What that one leaves out in turn is less than half of what it adds: measured on random runs by
        `benchmarks/coverage_transients.py`.  Infinite if there is no richer model, or one so far away that
        the two tell nothing of a third.
        """
        if self.richer is None:
            return np.inf
        added = self.away_from(self.richer)
        return np.inf if added > _UNRESOLVED * self.largest else 2 * added

    def away_from(self, other: Transient) -> float:
        """Largest difference of the tip deflection from that of another run of the same scene [m]."""
        t, q, _ = (x[:: 1 + len(x) // _COMPARED] for x in self.path.samples)
        return float(np.abs(tip_deflection(self.modal.tip, q) - other.deflection(t)).max())

    def to_dict(self) -> dict[str, Any]:
        """The result as plain numbers, lists and strings, `mode_error` included."""
        return {**super().to_dict(), "mode_error": self.mode_error}

    def at(self, t: np.ndarray | Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
        """Modal coordinates and velocities at any times t [s] of the run: shapes (len(t), m)."""
        t = np.atleast_1d(np.asarray(t, dtype=float))
        if t.size and not (t.min() >= self.path.start and t.max() <= self.path.end * (1 + 1e-12)):
            raise ValueError(f"t: times must lie in the run, from {self.path.start:g} to {self.path.end:g} s")
        return self.path.at(t)

    def shape(self, x: np.ndarray | Sequence[float], t: np.ndarray | Sequence[float]) -> np.ndarray:
        """Deflection [m] at positions x [m] and times t [s]: shape (len(t), len(x))."""
        return self._bending(t) @ self.modal.shape(np.asarray(x) / self.scene.beam.length)

    def root_strain(self, t: np.ndarray | Sequence[float]) -> np.ndarray:
        """Bending strain of the outer fibre at the root at times t [s]."""
        beam = self.scene.beam
        if beam.outer_fibre is None:
            raise ValueError("root_strain needs outer_fibre: give it to Beam.from_stiffness")
        root = np.zeros(1)
        curvature = self._bending(t) @ self.modal.shape(root, order=2)[:, 0] / beam.length**2
        return curvature * beam.outer_fibre(root)[0]

    def _bending(self, t: np.ndarray | Sequence[float]) -> np.ndarray:
        return self.at(t)[0][:, : self.modal.vectors.shape[1]]

    def deflection(self, t: np.ndarray | Sequence[float]) -> np.ndarray:
        """Tip deflection [m] at times t [s]."""
        return self.shape([self.scene.beam.length], t)[:, 0]

    def energy(self, t: np.ndarray | Sequence[float]) -> np.ndarray:
        """Energy of the vibration at times t [s]: q' q' / 2 + q K q / 2 [J]; constant at steady speed."""
        t = np.atleast_1d(np.asarray(t, dtype=float))
        q, v = self.at(t)
        _, K, f = self.system.coefficients(t)
        return (v**2).sum(axis=1) / 2 + np.einsum("ti,tij,tj->t", q, K, q) / 2 - (f * q).sum(axis=1)

    def peak(self, start: float, end: float) -> float:
        """Largest tip deflection, either way, from `start` to `end` [s], also between samples [m]."""
        _check_window(start, end, self.path)
        return largest_deflection(self.modal.tip, self.path, start, end)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the tip deflection over time."""
        from beamdyn.output.plots import plot_transient

        return plot_transient(self.t, self.tip, ax)

    def export(
        self, path: str | pathlib.Path, start: float, end: float, frames: int = 200, force: bool = False
    ) -> None:
        """Write the deflected beam from start to end [s] as a time series that opens in ParaView."""
        from beamdyn.output.export import write_series

        _check_window(start, end, self.path)
        x = np.linspace(0, self.scene.beam.length, 41)
        t = np.linspace(start, end, frames)
        write_series(path, x, t, self.shape(x, t), force=force)


def _check_window(start: float, end: float, path: Path) -> None:
    start, end = real("start", start, "s"), real("end", end, "s")
    if not path.start <= start < end <= path.end * (1 + 1e-12):
        raise ValueError(
            f"window = {start:g} ... {end:g} s: it must lie in the run, {path.start:g} ... {path.end:g} s"
        )


# Simulation ---------------------------------------------------------------------------------------


@one_blas_thread()  # the matrices are small: more threads only wait for each other
def simulate(
    scene: Scene,
    t_end: float,
    modes: int | str | None = "auto",
    tolerance: float = 1e-5,
    method: str | type[OdeSolver] = "auto",
    discretization: str | Discretization = "ritz",
    initial: str | np.ndarray = "rest",
    t_eval: np.ndarray | Sequence[float] | None = None,
    **options: Any,
) -> Transient:
    """Motion of the beam from time 0 to `t_end`, in modal coordinates of the beam at rest.

    Parameters
    ----------
    scene : Scene
        The scene, with a motion.
    t_end : float
        End of the run [s].
    modes : int, "auto" or None
        Number of modes at rest that are kept of each field.  "auto" keeps modes at the slowest and at the
        fastest speed, as few as leave no more than the tolerance out; None keeps all functions of the
        discretization.
    tolerance : float
        Error in time that is aimed at, and with ``modes="auto"`` also the error by the modes left out,
        each relative to the largest tip deflection.
    method : {"auto", "RK45", "DOP853", "Radau", "BDF", "LSODA", ...} or OdeSolver
        Our Gauss collocation with a step from the tolerance, or any method of `solve_ivp`.
    discretization : {"ritz", "fem"} or Discretization
        Where the modes come from.
    initial : {"rest", "equilibrium"} or ndarray, shape (2 m,)
        Undeflected at rest, in static equilibrium with the loads at time 0, or coordinates and velocities.
    t_eval : sequence of float, optional
        Times of the result [s]; by default eight in each step.
    **options
        For a method of `solve_ivp`: max_step and so on; rtol is `tolerance` by default, and atol a
        tenth of it, relative to the size of each coordinate.

    Returns
    -------
    Transient

    Raises
    ------
    ValueError
        If an argument is out of its range, or the motion passes the critical speed.
    ArithmeticError
        If the motion grows without bound.
    """
    t_end, tolerance = positive("t_end", t_end, "s"), within("tolerance", tolerance, *TOLERANCES)
    if scene.motion is None:
        raise ValueError("scene.motion is None: a transient needs a motion, such as SteadyRotation(50.0)")
    times = None if t_eval is None else _times(t_eval, t_end)
    kept = None if modes == "auto" else Kept(None if modes is None else count("modes", modes))
    if kept is None and not isinstance(initial, str):
        raise ValueError('initial is an array: give the number of its modes, not modes = "auto"')
    fewest = kept or Kept(FEWEST, range_of_speed(scene.motion, t_end))
    task = Task(scene, t_end, tolerance, method, discretization, initial, times, options, fewest)
    return task.run() if kept else task.cheapest()


@dataclass(frozen=True)
class Task:
    """What is asked of a run: see `simulate`."""

    scene: Scene
    t_end: float
    tolerance: float
    method: str | type[OdeSolver]
    discretization: str | Discretization
    initial: str | np.ndarray
    t_eval: np.ndarray | None
    options: dict[str, Any]
    kept: Kept

    def run(self) -> Transient:
        """The run."""
        began = perf_counter()
        motion, t_end = self.motion, self.t_end
        model = self._model
        _check_motion(motion, t_end, model)
        modal = model.modal(self.kept)
        system = ModalSystem(modal.equations, motion)
        path, error, name = self._integrated(modal, system, _initial(self.initial, system))
        t, q, v = path.samples
        largest = largest_deflection(modal.tip, path, path.start, path.end)
        _check_growth(self.scene, largest)
        if self.t_eval is not None:
            t = self.t_eval
            q, v = path.at(t)
        return Transient(
            t=t,
            tip=tip_deflection(modal.tip, q),
            coordinates=q,
            velocities=v,
            time_error=error,
            largest=largest,
            warnings=tuple(_warnings(self.scene, t_end, largest)),
            provenance=Provenance(
                __version__, f"{name}, {self.kept} of {model.discretization}", "", perf_counter() - began
            ),
            modal=modal,
            system=system,
            path=path,
            task=self,
        )

    def richer(self) -> Transient | None:
        """The run by our integrator with more modes; None if there is no richer model or answer."""
        own = replace(self, method="auto", t_eval=None)
        task = own._finer() if self.kept.modes is None else own._more(self.kept.modes)
        try:
            return task and task.run()
        except ArithmeticError:  # with more modes the motion grows without bound
            return None

    def cheapest(self) -> Transient:
        """The run with the fewest modes that keeps the tolerance, or else with the most."""
        run = replace(self, method="auto", t_eval=None).run()
        if run.mode_error > self.tolerance * run.largest and run.richer is not None:
            # What a sudden motion sets swinging are many modes; they are as good at rest, and fewer.
            rest = replace(run.task, kept=Kept(run.modal.vectors.shape[1])).run()
            run = rest if rest.away_from(run.richer) < run.away_from(run.richer) else run
        while run.mode_error > self.tolerance * run.largest and run.richer is not None:
            run = run.richer
        plain = self.method == "auto" and self.t_eval is None
        return run if plain else replace(self, kept=run.task.kept).run()

    def _more(self, modes: int) -> Task | None:
        """More modes, in a basis of our choice where the given one is too small."""
        kept = self.kept.more()
        if kept is None or kept.modes is None:
            return None
        initial = self._padded(modes, kept.modes)
        return replace(
            self, kept=kept, discretization=roomy(self.discretization, kept.modes), initial=initial
        )

    def _finer(self) -> Task | None:
        """All functions of the next finer discretization."""
        finer = self._model.discretization.finer()
        return None if finer is None else replace(self, discretization=finer)

    @property
    def motion(self) -> Motion:
        """The scene's motion."""
        assert self.scene.motion is not None
        return self.scene.motion

    @property
    def _model(self) -> Model:
        wanted, target = self.kept.modes or 1, 1e-3 * self.tolerance
        return choose(self.scene, self.discretization, np.array(self.kept.speeds), wanted, target)

    def _integrated(
        self, modal: ModalEquations, system: ModalSystem, y0: np.ndarray
    ) -> tuple[Path, float, str]:
        """The path, its error by the steps in time [m], and what was done."""
        if self.method == "auto":
            return integrate(modal.tip, system, y0, self.t_end, self.tolerance)
        absolute = _absolute(modal, system, y0, self.t_end, self.tolerance)
        options = {"rtol": self.tolerance, "atol": absolute, **self.options}
        name = self.method if isinstance(self.method, str) else self.method.__name__
        return _stock(system, y0, self.t_end, self.method, options), np.nan, name

    def _padded(self, modes: int, more: int) -> str | np.ndarray:
        """Initial coordinates and velocities of more modes: those added are at rest."""
        if isinstance(self.initial, str):
            return self.initial
        parts = np.reshape(self.initial, (-1, modes))
        return np.hstack([parts, np.zeros((len(parts), more - modes))]).ravel()


def _times(t_eval: np.ndarray | Sequence[float], t_end: float) -> np.ndarray:
    t = ascending("t_eval", t_eval)
    if t[0] < 0 or t[-1] > t_end:
        raise ValueError(f"t_eval = {t[0]:g} ... {t[-1]:g} s: times must lie in the run, 0 ... {t_end:g} s")
    return t


def _check_motion(motion: Motion, t_end: float, model: Model) -> None:
    """Refuse a motion that ends early or passes the critical speed, before any long work."""
    t = np.linspace(0, t_end, SAMPLED_TIMES)
    speed = np.abs(motion.at(t).speed)
    critical = model.solver.critical_speed
    if speed.max() >= critical:
        k = int((speed >= critical).argmax())
        raise ValueError(
            f"the motion reaches {speed[k]:.6g} rad/s at t = {t[k]:.4g} s, past the critical speed "
            f"{critical:.6g} rad/s: the beam buckles and linear theory has no answer; lower the speed"
        )


def _check_growth(scene: Scene, largest: float) -> None:
    """Refuse a motion that has grown without bound, whose error no estimate tells."""
    length = scene.beam.length
    if not largest <= _UNBOUNDED * length:
        raise ArithmeticError(
            f"the motion grows without bound, to {largest / length:.1g} times the length: the beam's weight "
            "buckles it, or turning sets it swinging, and linear theory has no answer; lower gravity or the "
            "speed, or end the run earlier"
        )


def _initial(initial: str | np.ndarray, system: ModalSystem) -> np.ndarray:
    n = system.size
    if isinstance(initial, str):
        if initial == "rest":
            return np.zeros(2 * n)
        if initial == "equilibrium":
            _, K, f = system.coefficients(np.zeros(()))
            return np.concatenate([np.linalg.solve(K, f), np.zeros(n)])
        raise ValueError(f"initial = {initial!r}: give 'rest', 'equilibrium' or an array")
    y0 = np.asarray(initial, dtype=float)
    if y0.shape != (2 * n,) or not np.isfinite(y0).all():
        raise ValueError(
            f"initial: give {2 * n} finite numbers, coordinates then velocities; shape {y0.shape}"
        )
    return y0


def _warnings(scene: Scene, t_end: float, largest: float) -> Iterator[str]:
    motion, length = scene.motion, scene.beam.length
    if largest > LARGE_DEFLECTION * length:
        yield f"the tip moves by {largest / length:.2g} of the length: past 0.1 it is outside linear theory"
    road = (
        np.abs(motion.at(np.linspace(0, t_end, SAMPLED_TIMES)).carrier_acceleration[:, 1]).max()
        if motion
        else 0.0
    )
    if road > _GRAVITY:
        yield (
            f"the road accelerates the wheel by {road:.3g} m/s2, more than gravity: it would leave the road; "
            "was a velocity amplitude given as a height?"
        )


# Stock integrators --------------------------------------------------------------------------------


def _absolute(
    modal: ModalEquations, system: ModalSystem, y0: np.ndarray, t_end: float, tolerance: float
) -> np.ndarray:
    """Absolute tolerances of the coordinates and velocities, from a quick run of ours."""
    path, _, _ = integrate(modal.tip, system, y0, t_end, 1e-2)
    sizes = [np.abs(x).max(axis=0) for x in path.samples[1:]]
    return 0.1 * tolerance * np.concatenate(sizes) + 1e-300


@dataclass(frozen=True)
class _StockTrajectory:
    """A solution of `solve_ivp` in the form of a path."""

    solution: Any
    times: np.ndarray

    @property
    def start(self) -> float:
        return float(self.times[0])

    @property
    def end(self) -> float:
        return float(self.times[-1])

    @property
    def samples(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return self.times, *self.at(self.times)

    def at(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        q, v = np.split(self.solution(t), 2)
        return q.T, v.T


def _stock(system: ModalSystem, y0: np.ndarray, t_end: float, method: Any, options: dict[str, Any]) -> Any:
    if isinstance(method, str) and method not in _STOCK:
        raise ValueError(f"method = {method!r}: give 'auto', {', '.join(map(repr, _STOCK))} or an OdeSolver")
    if isinstance(method, type) and issubclass(method, GaussCollocation):
        options = {"system": system, **options}
    elif method in ("Radau", "BDF", "LSODA"):
        options = {"jac": system.jacobian, **options}
    solved = solve_ivp(system.rhs, (0.0, t_end), y0, method=method, dense_output=True, **options)
    if not solved.success:
        raise ArithmeticError(f"solve_ivp stopped at t = {solved.t[-1]:g} s: {solved.message}")
    steps = [np.linspace(a, b, SAMPLES + 1)[:-1] for a, b in pairwise(solved.t)]
    return _StockTrajectory(solved.sol, np.concatenate([*steps, [t_end]]))
