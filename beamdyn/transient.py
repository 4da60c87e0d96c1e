"""Motion in time: transients of a scene."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.integrate import OdeSolver, solve_ivp

from beamdyn import __version__
from beamdyn.common.checks import ascending, count, positive, real
from beamdyn.equations import Equations, RootMotion
from beamdyn.estimate import ModalEquations, Model, choose
from beamdyn.integrators import GaussCollocation, Piece, interior, propagate, step_maps, tableau
from beamdyn.motion import Motion
from beamdyn.operators import Discretization
from beamdyn.results import Provenance, Result
from beamdyn.scene import Scene
from beamdyn.spectrum import LARGE_DEFLECTION

if TYPE_CHECKING:
    from matplotlib.axes import Axes

STAGES = 8
_RADIANS = 3.75  # turned by the fastest motion in a step, for an error of 1e-5: measured
_PARTS = 4  # of a stretch of changing speed, each with its own step
_SAMPLES = 8  # of the response in each step, where the caller gives no times
_STOCK = ("RK23", "RK45", "DOP853", "Radau", "BDF", "LSODA")
_BETWEEN = np.array([0.25, 0.5, 0.75])  # fractions of a step at which the interpolation is measured
_LOST = 0.05  # error of phase in a step [rad] from which a mode is not followed
_CHECKS = 16  # steps at which the local error is measured
_CANDIDATES = 12  # maxima that are refined: sampled ones differ by less than 1e-3 from the true
_GRAVITY = 9.81


@dataclass(frozen=True)
class ModalSystem:
    """q'' + C q' + K(t) q = f(t) of a scene in modal coordinates, at arrays of times.

    Parameters
    ----------
    equations : Equations
        Equations in coordinates of unit mass.
    motion : Motion
        The motion that they follow.
    """

    equations: Equations
    motion: Motion

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return self.equations.size

    @cached_property
    def parts(self) -> dict[int, dict[str, np.ndarray]]:
        """For each order, the sum of the matrices that one quantity of the motion multiplies."""
        parts: dict[int, dict[str, np.ndarray]] = {0: {}, 1: {}}
        for term in self.equations.terms:
            if term.order < 2:
                whole = parts[term.order].setdefault(term.quantity, np.zeros((self.size, self.size)))
                whole[self.equations.fields[term.rows], self.equations.fields[term.columns]] += (
                    term.factor * term.matrix
                )
        return parts

    def root(self, t: np.ndarray) -> RootMotion:
        """Motion of the root at times t [s]."""
        return self.equations.root(self.motion.at(t))

    def coefficients(self, t: np.ndarray) -> tuple[np.ndarray | None, np.ndarray, np.ndarray]:
        """C (None if zero), K and f at times t."""
        root = self.root(np.asarray(t, dtype=float))
        C = _sum(self.parts[1], root) if self.parts[1] else None
        return C, _sum(self.parts[0], root), self.equations.load(root)

    def rhs(self, t: float, y: np.ndarray) -> np.ndarray:
        """Y' for y = (q, q'), as `solve_ivp` asks for it."""
        C, K, f = self.coefficients(np.asarray(t))
        q, v = np.split(y, 2)
        return np.concatenate([v, f - K @ q - (0 if C is None else C @ v)])

    def jacobian(self, t: float, y: np.ndarray) -> np.ndarray:
        """Derivative of y' with respect to y: exact, as the system is linear."""
        C, K, _ = self.coefficients(np.asarray(t))
        n = self.size
        J = np.zeros((2 * n, 2 * n))
        J[:n, n:], J[n:, :n] = np.eye(n), -K
        if C is not None:
            J[n:, n:] = -C
        return J


def _sum(parts: dict[str, np.ndarray], root: RootMotion) -> np.ndarray:
    """Sum of quantity times matrix, over the shape of the root's motion."""
    total = np.zeros((*root.unity.shape, *next(iter(parts.values())).shape))
    for quantity, matrix in parts.items():
        total += getattr(root, quantity)[..., None, None] * matrix
    return total


# Results ------------------------------------------------------------------------------------------


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
    """

    t: np.ndarray
    tip: np.ndarray
    coordinates: np.ndarray
    velocities: np.ndarray
    time_error: float
    largest: float
    warnings: tuple[str, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)
    modal: ModalEquations = field(repr=False)
    system: ModalSystem = field(repr=False)
    path: Trajectory = field(repr=False)

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
        from beamdyn.plots import plot_transient

        return plot_transient(self.t, self.tip, ax)

    def export(self, path: str | Path, frames: int = 200, force: bool = False) -> None:
        """Write the deflected beam over time as a time series that opens in ParaView."""
        from beamdyn.export import write_series

        x = np.linspace(0, self.scene.beam.length, 41)
        t = np.linspace(self.path.start, self.path.end, frames)
        write_series(path, x, t, self.shape(x, t), force=force)


@dataclass(frozen=True)
class Trajectory:
    """A trajectory: pieces of equal steps, one after the other."""

    pieces: tuple[Piece, ...]

    @property
    def start(self) -> float:
        """Its beginning [s]."""
        return self.pieces[0].start

    @property
    def end(self) -> float:
        """Its end [s]."""
        return self.pieces[-1].end

    @cached_property
    def samples(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Times, coordinates and velocities that show the motion: several in each step."""
        n = self.pieces[0].acceleration.shape[2]
        last = self.pieces[-1].state[-1:]
        end = np.array([self.end]), last[:, 1 : n + 1], last[:, n + 1 :]
        parts = [*(p.samples(_SAMPLES) for p in self.pieces), end]
        return tuple(np.concatenate(each) for each in zip(*parts, strict=True))  # pyright: ignore[reportReturnType]

    def at(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates and velocities at times t."""
        n = self.pieces[0].acceleration.shape[2]
        q, v = np.empty((len(t), n)), np.empty((len(t), n))
        place = np.searchsorted([p.start for p in self.pieces[1:]], t, side="right")
        for k in np.unique(place):
            here = place == k
            q[here], v[here] = self.pieces[k].at(t[here])
        return q, v


def _check_window(start: float, end: float, path: Any) -> None:
    start, end = real("start", start, "s"), real("end", end, "s")
    if not path.start <= start < end <= path.end * (1 + 1e-12):
        raise ValueError(
            f"window = {start:g} ... {end:g} s: it must lie in the run, {path.start:g} ... {path.end:g} s"
        )


def largest_deflection(tip: np.ndarray, path: Any, start: float, end: float) -> float:
    """Largest tip deflection of a path, either way, from start to end [m].

    Sample, then close in on the highest maxima.
    """
    times, q, _ = path.samples
    inside = (times >= start) & (times <= end)
    size = np.abs(_tip(tip, q[inside]))
    ends = np.array([start, end])
    t = np.concatenate([times[inside][_highest(size)], ends])
    reach = np.diff(times).max()
    for _ in range(4):  # each round samples 17 times as finely
        near = np.clip(t[:, None] + np.linspace(-reach, reach, 35), start, end)
        size = np.abs(_tip(tip, path.at(near.ravel())[0])).reshape(near.shape)
        t, reach = near[np.arange(len(t)), size.argmax(axis=1)], reach / 17
    return float(size.max())


def _highest(size: np.ndarray) -> np.ndarray:
    """Samples beside the highest maxima, by the vertices of parabolas through three samples."""
    if len(size) < 3:
        return np.arange(len(size))
    left, middle, right = size[:-2], size[1:-1], size[2:]
    bend = np.maximum(2 * middle - left - right, 1e-300)
    summit = (middle >= left) & (middle >= right)
    height = np.where(summit, middle + (right - left) ** 2 / (8 * bend), middle)
    return 1 + np.argsort(height)[-_CANDIDATES:]


# Simulation ---------------------------------------------------------------------------------------


def simulate(
    scene: Scene,
    t_end: float,
    modes: int | None = 3,
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
    modes : int or None
        Number of modes kept of each field; None keeps all functions of the discretization.
    tolerance : float
        Error in time that is aimed at, relative to the largest tip deflection ("auto" only).
    method : {"auto", "RK45", "DOP853", "Radau", "BDF", "LSODA", ...} or OdeSolver
        Our Gauss collocation with a step from the tolerance, or any method of `solve_ivp`.
    discretization : {"ritz", "fem"} or Discretization
        Where the modes come from.
    initial : {"rest", "equilibrium"} or ndarray, shape (2 m,)
        Undeflected at rest, in static equilibrium with the loads at time 0, or coordinates and velocities.
    t_eval : sequence of float, optional
        Times of the result [s]; by default eight in each step.
    **options
        For a method of `solve_ivp`: rtol, atol, max_step and so on.

    Returns
    -------
    Transient

    Raises
    ------
    ValueError
        If an argument is out of its range, or the motion passes the critical speed.
    """
    began = perf_counter()
    t_end, tolerance = positive("t_end", t_end, "s"), positive("tolerance", tolerance)
    if scene.motion is None:
        raise ValueError("scene.motion is None: a transient needs a motion, such as SteadyRotation(50.0)")
    wanted = count("modes", 1 if modes is None else modes)
    model = choose(scene, discretization, np.zeros(1), wanted, target=1e-3 * tolerance)
    _check_motion(scene.motion, t_end, model)
    modal = model.modal(model.solver.size if modes is None else modes)
    system = ModalSystem(modal.equations, scene.motion)
    y0 = _initial(initial, system)
    if method == "auto":
        path, error, name = _own(modal, system, y0, t_end, tolerance)
    else:
        path, error = _stock(system, y0, t_end, method, options), np.nan
        name = method if isinstance(method, str) else method.__name__
    t, q, v = path.samples
    largest = largest_deflection(modal.tip, path, path.start, path.end)
    if t_eval is not None:
        t = _times(t_eval, t_end)
        q, v = path.at(t)
    size = "all" if modes is None else str(modes)
    return Transient(
        t=t,
        tip=_tip(modal.tip, q),
        coordinates=q,
        velocities=v,
        time_error=float(error),
        largest=largest,
        warnings=tuple(_warnings(scene, t_end, largest)),
        provenance=Provenance(
            __version__, f"{name}, {size} modes of {model.discretization}", "", perf_counter() - began
        ),
        scene=scene,
        modal=modal,
        system=system,
        path=path,
    )


def _tip(tip: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Tip deflection of coordinates q of shape (n, m), of which bending comes first."""
    return q[:, : len(tip)] @ tip


def _times(t_eval: np.ndarray | Sequence[float], t_end: float) -> np.ndarray:
    t = ascending("t_eval", t_eval)
    if t[0] < 0 or t[-1] > t_end:
        raise ValueError(f"t_eval = {t[0]:g} ... {t[-1]:g} s: times must lie in the run, 0 ... {t_end:g} s")
    return t


def _check_motion(motion: Motion, t_end: float, model: Model) -> None:
    """Refuse a motion that ends early or passes the critical speed, before any long work."""
    t = np.linspace(0, t_end, 2001)
    speed = np.abs(motion.at(t).speed)
    critical = model.solver.critical_speed
    if speed.max() >= critical:
        k = int((speed >= critical).argmax())
        raise ValueError(
            f"the motion reaches {speed[k]:.6g} rad/s at t = {t[k]:.4g} s, past the critical speed "
            f"{critical:.6g} rad/s: the beam buckles and linear theory has no answer; lower the speed"
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
    road = np.abs(motion.at(np.linspace(0, t_end, 2001)).carrier_acceleration[:, 1]).max() if motion else 0.0
    if road > _GRAVITY:
        yield (
            f"the road accelerates the wheel by {road:.3g} m/s2, more than gravity: it would leave the road; "
            "was a velocity amplitude given as a height?"
        )


# Our integrator -----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Resolution:
    """How long the steps are: the fastest motion that must be resolved turns by so much in each.

    Parameters
    ----------
    radians : float
        Angle turned in a step [rad].
    modes : int
        Number of the lowest modes that are resolved; the free vibration of higher ones, which the
        motion hardly excites, may lose its phase.
    """

    radians: float
    modes: int = 1

    @classmethod
    def of(cls, tolerance: float) -> Resolution:
        """The one that leaves about this error, relative to the largest deflection: measured."""
        return cls(_RADIANS * (tolerance / 1e-5) ** (1 / (2 * STAGES)))

    def steps(self, system: ModalSystem, start: float, end: float) -> int:
        """Steps of a stretch of the motion."""
        t = np.linspace(start, end, 9)
        speed = np.abs(system.motion.at(t).speed).max()
        lines = [line.multiple * speed for line in system.motion.lines]
        _, K, _ = system.coefficients(t)
        own = np.sqrt(np.sort(np.abs(np.linalg.eigvals(K)), axis=1)[:, self.modes - 1].max())
        fastest = max(own, speed * (system.equations.gravity != 0), *lines, 0.0)
        return max(1, int(np.ceil((end - start) * fastest / self.radians)))

    def finer(self, error: TimeError, bound: float) -> Resolution:
        """The one to try next if the error exceeds its bound [m]."""
        from_here_up = np.cumsum((error.modes * error.lost)[::-1])[::-1]
        needed = int((from_here_up > bound / 4).sum())  # the modes above add up to little
        if needed > self.modes:
            return Resolution(self.radians, needed)
        shrink = max(0.3, 0.9 * (bound / error.total) ** (1 / (2 * STAGES)))
        return Resolution(self.radians * shrink, self.modes)

    @property
    def exhausted(self) -> bool:
        """Whether shorter steps gain nothing but rounding."""
        return self.radians < _RADIANS / 50


def _own(
    modal: ModalEquations, system: ModalSystem, y0: np.ndarray, t_end: float, tolerance: float
) -> tuple[Trajectory, float, str]:
    """Integrate with steps from the tolerance; again, finer, if the measured error asks for it."""
    edges, resolution = smooth_stretches(system.motion, t_end), Resolution.of(tolerance)
    while True:
        steps = [resolution.steps(system, a, b) for a, b in pairwise(edges)]
        path = _propagate(system, edges, steps, y0)
        error = time_error(modal.tip, system, [_checks(p) for p in path.pieces])
        bound = tolerance * max(float(np.abs(_tip(modal.tip, p.state[:, 1:])).max()) for p in path.pieces)
        if error.total <= bound or resolution.exhausted:
            return path, error.total, f"Gauss collocation of order {2 * STAGES}, {sum(steps)} steps"
        resolution = resolution.finer(error, bound)


def smooth_stretches(motion: Motion, t_end: float) -> np.ndarray:
    """Ends of stretches: breakpoints of the motion, and parts of those in which the speed changes."""
    inner = [b for b in motion.breakpoints if 0 < b < t_end]
    parts = []
    for a, b in pairwise([0.0, *inner, t_end]):
        changing = np.ptp(motion.at(np.linspace(a, b, 9)[1:-1]).speed) > 0
        parts.append(np.linspace(a, b, (_PARTS if changing else 1) + 1)[:-1])
    return np.concatenate([*parts, [t_end]])


def _propagate(system: ModalSystem, edges: np.ndarray, steps: Sequence[int], y0: np.ndarray) -> Trajectory:
    pieces, n = [], system.size
    for (a, b), many in zip(pairwise(edges), steps, strict=True):
        pieces.append(propagate(system, a, b, many, y0[:n], y0[n:], STAGES))
        y0 = pieces[-1].state[-1, 1:]
    return Trajectory(tuple(pieces))


@dataclass(frozen=True)
class Checks:
    """Steps of a piece at which the local error is measured.

    Parameters
    ----------
    starts : ndarray, shape (k,)
        Their beginnings [s].
    h : float
        Their length [s].
    steps : int
        How many steps of the piece they stand for.
    state : ndarray, shape (k, 2 n + 1)
        Augmented states at their beginnings.
    """

    starts: np.ndarray
    h: float
    steps: int
    state: np.ndarray


def checked_steps(steps: int) -> np.ndarray:
    """Which steps of a piece are checked."""
    return np.unique(np.linspace(0, steps - 1, min(steps, _CHECKS)).astype(int))


def _checks(piece: Piece) -> Checks:
    steps = len(piece.acceleration)
    chosen = checked_steps(steps)
    return Checks(piece.start + piece.h * chosen, piece.h, steps, piece.state[chosen])


@dataclass(frozen=True)
class TimeError:
    """Estimated error of a tip deflection by the steps in time.

    Parameters
    ----------
    modes : ndarray, shape (m,)
        Contributions of the modes [m].
    between : float
        Error of interpolation between the ends of steps [m].
    lost : ndarray of bool, shape (m,)
        Whether the steps are too long to follow a mode's free vibration.
    """

    modes: np.ndarray
    between: float
    lost: np.ndarray

    @property
    def total(self) -> float:
        """All of it, with a margin [m]."""
        return 1.5 * (float(self.modes.sum()) + self.between)


def time_error(tip: np.ndarray, system: ModalSystem, checks: Sequence[Checks]) -> TimeError:
    """Error of the tip deflection, from two more stages at some steps of each piece.

    Gauss collocation keeps amplitudes and errs in phase.  A mode's local errors therefore add up
    coherently until its phase is lost, after 2 / delta steps with an error delta of phase a step;
    what a mode that the steps do not resolve has by then is all of its free vibration, and no more.

    Parameters
    ----------
    tip : ndarray, shape (m,)
        Tip deflection of the bending modes.
    system : ModalSystem
        The equations.
    checks : sequence of Checks
        Checked steps of each piece.

    Returns
    -------
    TimeError
    """
    total, between, lost = np.zeros(len(tip)), 0.0, np.zeros(len(tip), dtype=bool)
    for check in checks:
        own, finer = (step_maps(system, check.starts, check.h, tableau(STAGES + more)) for more in (0, 2))
        local, delta = _local_errors(system, finer.step - own.step, check.state, len(tip))
        total += np.minimum(check.steps, 2 / np.maximum(delta, 1e-30)) * local
        lost |= delta > _LOST
        accelerations = [(maps.stages @ check.state[:, None, :, None])[..., 0] for maps in (own, finer)]
        inside = [interior(check.h, check.state, a, _BETWEEN)[0] for a in accelerations]
        between = max(between, float(np.abs((inside[0] - inside[1])[..., : len(tip)] @ tip).max()))
    return TimeError(total * np.abs(tip), between, lost)


def _local_errors(
    system: ModalSystem, difference: np.ndarray, state: np.ndarray, modes: int
) -> tuple[np.ndarray, np.ndarray]:
    """Mean local error of each mode as an amplitude, and its largest error of phase in a step."""
    n, k = system.size, np.arange(modes)
    _, K, _ = system.coefficients(np.zeros(()))
    frequency = np.sqrt(np.abs(np.diag(K)))[:modes]
    error = np.einsum("kij,kj->ki", difference, state)
    local = np.hypot(error[:, :modes], error[:, n : n + modes] / frequency).mean(axis=0)
    delta = np.maximum(np.abs(difference[:, k, 1 + k]), np.abs(difference[:, k, 1 + n + k]) * frequency)
    return local, delta.max(axis=0)


# Stock integrators --------------------------------------------------------------------------------


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

    @cached_property
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
    steps = [np.linspace(a, b, _SAMPLES + 1)[:-1] for a, b in pairwise(solved.t)]
    return _StockTrajectory(solved.sol, np.concatenate([*steps, [t_end]]))
