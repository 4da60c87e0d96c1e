"""Analyses at steady speed: modes, loci, the critical speed, and the setting angles of changing character."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import eigh
from scipy.optimize import brentq

from beamdyn import __version__
from beamdyn.common.checks import ascending, count, positive, real
from beamdyn.eigen import Solver
from beamdyn.equations import SteadyPencil
from beamdyn.estimate import TARGET, Estimated, Model, choose, estimated
from beamdyn.operators import Discretization, tension
from beamdyn.results import Provenance, Result
from beamdyn.scene import Scene
from beamdyn.tracking import track

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LARGE_STRAIN = 0.01
_LARGE_DEFLECTION = 0.1  # of the length: the limit of linear theory
_CANDIDATES = 2  # modes above the wanted ones that tracking may exchange with them


# Modes at one speed -------------------------------------------------------------------------------


@dataclass(frozen=True)
class Modes(Result):
    """Natural modes at one speed, the lowest first.

    Parameters
    ----------
    speed : float
        Speed [rad/s].
    frequency : ndarray, shape (m,)
        Frequency [Hz]; nan where a mode is unstable or does not oscillate.
    error : ndarray, shape (m,)
        Estimated relative error of the frequency, or of the growth rate where there is none.
    growth_rate : ndarray, shape (m,)
        Growth rate [1/s]: positive for an unstable mode, negative for a damped one.
    status : ndarray of str, shape (m,)
        "stable", "divergence", "flutter" or "overdamped".
    eigenvalue : ndarray of complex, shape (m,)
        s in exp(s t) [1/s].
    tip : ndarray, shape (m,)
        Tip deflection of the mass-normalised modes [kg^-1/2], positive.
    load : ndarray, shape (m,)
        Modal load under a unit root acceleration, P in modal coordinates [kg^1/2].
    angular_load : ndarray, shape (m,)
        Modal load under a unit angular acceleration, Q in modal coordinates [kg^1/2 m].
    static_deflection : float
        Static tip deflection under the rotation [m]; nan past the critical speed.
    axial_strain : float
        Largest static axial strain: uncertainty of a model without stretch; nan if it is unknown.
    warnings : tuple of str
        What limits the answer.
    provenance : Provenance
        How it was found.
    """

    speed: float
    frequency: np.ndarray
    error: np.ndarray
    growth_rate: np.ndarray
    status: np.ndarray
    eigenvalue: np.ndarray
    tip: np.ndarray
    load: np.ndarray
    angular_load: np.ndarray
    static_deflection: float
    axial_strain: float
    warnings: tuple[str, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)
    vectors: np.ndarray = field(repr=False)
    model: Model = field(repr=False)

    def shape(self, x: np.ndarray | Sequence[float]) -> np.ndarray:
        """Deflection of the mass-normalised modes at positions x [m] along the beam: shape (m, len(x))."""
        xi = np.asarray(x, dtype=float) / self.scene.beam.length
        if xi.size and not (xi.min() >= 0 and xi.max() <= 1 + 1e-12):
            raise ValueError(f"x: positions run from 0 to the length {self.scene.beam.length:g} m")
        bending = self.model.equations.operators.bending
        return self.vectors[: len(bending.P)].T @ bending.space.evaluate(np.minimum(xi, 1.0))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the mode shapes."""
        from beamdyn.plots import plot_shapes

        x = np.linspace(0, self.scene.beam.length, 201)
        return plot_shapes(x, self.shape(x).real, self.labels(), ax)

    def labels(self) -> list[str]:
        """One line of text for each mode."""
        return [_label(i, f, g) for i, (f, g) in enumerate(zip(self.frequency, self.growth_rate, strict=True), 1)]


def _label(i: int, frequency: float, growth: float) -> str:
    return f"mode {i}: {growth:.4g} 1/s" if np.isnan(frequency) else f"mode {i}: {frequency:.5g} Hz"


def natural_modes(
    scene: Scene, speed: float = 0.0, modes: int = 3, method: str | Discretization = "ritz"
) -> Modes:
    """Natural modes at a steady speed, about a fixed centre.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.
    speed : float
        Speed [rad/s].
    modes : int
        How many.
    method : {"ritz", "fem"} or Discretization
        Assumed modes or finite elements, as large as needed; or a `Ritz` or `Fem` of given size.

    Returns
    -------
    Modes

    Raises
    ------
    ValueError
        If an argument is out of its range.
    """
    start = perf_counter()
    speeds, modes = np.array([real("speed", speed, "rad/s")]), count("modes", modes)
    found = estimated(choose(scene, method, speeds, modes), speeds, modes)
    s, vectors = found.eigen.eigenvalue[0], _tip_positive(found.model, found.eigen.vector[0])
    bending = found.model.equations.operators.bending
    part = vectors[: len(bending.P)]
    status = _status(s)
    deflection, strain = _static(found.model, speeds)
    return Modes(
        speed=float(speed),
        frequency=_frequency(s, status),
        error=found.error[0],
        growth_rate=s.real + 0.0,
        status=status,
        eigenvalue=s,
        tip=(bending.space.end(0) @ part).real,
        load=_real_if_close(bending.P @ part),
        angular_load=_real_if_close(bending.Q @ part),
        static_deflection=float(deflection[0]),
        axial_strain=float(strain[0]),
        warnings=tuple(_warnings(scene, speeds, deflection, strain, found.error, status[None])),
        provenance=_provenance(found, start),
        scene=scene,
        vectors=vectors,
        model=found.model,
    )


def _tip_positive(model: Model, vectors: np.ndarray) -> np.ndarray:
    """Turn the phase of each vector so that its tip deflection is real and positive."""
    bending = model.equations.operators.bending
    tip = bending.space.end(0) @ vectors[: len(bending.P)]
    phase = np.where(tip == 0, 1.0, tip / np.abs(np.where(tip == 0, 1.0, tip)))
    return vectors / phase


def _real_if_close(values: np.ndarray) -> np.ndarray:
    return values.real if np.iscomplexobj(values) else values


def _status(s: np.ndarray) -> np.ndarray:
    growing, turning = s.real > 0, s.imag != 0
    names = ["flutter", "divergence", "stable"]
    return np.select([growing & turning, growing, turning], names, np.where(s == 0, "divergence", "overdamped"))


def _frequency(s: np.ndarray, status: np.ndarray) -> np.ndarray:
    return np.where(status == "stable", s.imag / (2 * np.pi), np.nan)


def _static(model: Model, speeds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Static tip deflection [m] (nan past the critical speed) and largest static axial strain."""
    solver, beam, mount = model.solver, model.scene.beam, model.scene.mount
    bending = model.equations.operators.bending
    stiffness = 1 + speeds[:, None] ** 2 * solver.growth
    with np.errstate(divide="ignore"):
        q = (solver.basis.T @ solver.pencil.f2) * speeds[:, None] ** 2 / stiffness
    tip = q @ (solver.basis[: len(bending.P)].T @ bending.space.end(0))
    deflection = np.where(stiffness.min(axis=1) > 0, tip, np.nan)
    if beam.axial_stiffness is None:
        return deflection, np.full(len(speeds), np.nan)
    n_a, n_b = tension(beam)
    xi = np.linspace(0, 1, 101)
    force = n_b(xi) - np.cos(mount.setting_angle) * mount.radius * n_a(xi)
    return deflection, np.abs(force / beam.axial_stiffness(xi)).max() * speeds**2


def _warnings(
    scene: Scene,
    speeds: np.ndarray,
    deflection: np.ndarray,
    strain: np.ndarray,
    error: np.ndarray,
    status: np.ndarray,
) -> Iterator[str]:
    unstable = np.isin(status, ("divergence", "flutter"))
    if unstable.any():
        s = int(unstable.any(axis=1).argmax())
        yield f"unstable at {speeds[s]:.6g} rad/s: {unstable[s].sum()} mode(s) grow; see growth_rate"
    if strain.max(initial=0) > _LARGE_STRAIN:
        yield f"static axial strain reaches {strain.max():.2g}: above 1 % the material model is in doubt"
    bent = np.abs(deflection) > _LARGE_DEFLECTION * scene.beam.length
    if bent.any():
        yield _bent(scene, speeds[bent][0], deflection[bent][0])
    if error.max() > 1e-6:
        yield f"estimated relative error reaches {error.max():.1g}: the model did not resolve every mode"


def _bent(scene: Scene, speed: float, deflection: float) -> str:
    return (
        f"at {speed:.6g} rad/s the rotation bends the tip by {abs(deflection) / scene.beam.length:.2g} of the "
        "length: past 0.1 the answer is outside linear theory"
    )


def _provenance(found: Estimated, start: float) -> Provenance:
    names = str(found.model.discretization), str(found.coarse.discretization)
    return Provenance(__version__, *names, wall_time=perf_counter() - start)


# Loci over speeds ---------------------------------------------------------------------------------


@dataclass(frozen=True)
class Locus(Result):
    """Modes over speeds, each followed through crossings and veerings; numbered at the first speed.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Speeds [rad/s].
    frequency : ndarray, shape (S, m)
        Frequencies [Hz]; nan where a mode is unstable or does not oscillate.
    growth_rate : ndarray, shape (S, m)
        Growth rates [1/s].
    confidence : ndarray, shape (S, m)
        How sure it is that a mode continues the one at the speed before: 1 sure, 0 a guess.
    error : ndarray, shape (S, m)
        Estimated relative error of the eigenvalues.
    status : ndarray of str, shape (S, m)
        "stable", "divergence", "flutter" or "overdamped".
    eigenvalue : ndarray of complex, shape (S, m)
        s in exp(s t) [1/s].
    static_deflection : ndarray, shape (S,)
        Static tip deflection under the rotation [m]; nan past the critical speed.
    axial_strain : ndarray, shape (S,)
        Largest static axial strain; nan if it is unknown.
    warnings : tuple of str
        What limits the answer.
    provenance : Provenance
        How it was found.
    """

    speeds: np.ndarray
    frequency: np.ndarray
    growth_rate: np.ndarray
    confidence: np.ndarray
    error: np.ndarray
    status: np.ndarray
    eigenvalue: np.ndarray
    static_deflection: np.ndarray
    axial_strain: np.ndarray
    warnings: tuple[str, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the frequencies over speed."""
        from beamdyn.plots import plot_locus

        return plot_locus(self.speeds, self.frequency, ax)


def frequency_locus(
    scene: Scene, speeds: np.ndarray | Sequence[float], modes: int = 3, method: str | Discretization = "ritz"
) -> Locus:
    """Natural frequencies over speed, all speeds in one batch.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.
    speeds : sequence of float
        Speeds [rad/s], ascending.
    modes : int
        How many modes to follow.
    method : {"ritz", "fem"} or Discretization
        As for `natural_modes`.

    Returns
    -------
    Locus

    Raises
    ------
    ValueError
        If an argument is out of its range.
    """
    start = perf_counter()
    speeds, modes = ascending("speeds", speeds), count("modes", modes)
    found = estimated(choose(scene, method, speeds, modes), speeds, modes, extra=_CANDIDATES)
    order, confidence = track(found.eigen.vector, found.model.solver.pencil.M)
    s = np.take_along_axis(found.eigen.eigenvalue, order, axis=1)[:, :modes]
    error = _tracked_error(found, order[:, :modes])
    status = _status(s)
    deflection, strain = _static(found.model, speeds)
    return Locus(
        speeds=speeds,
        frequency=_frequency(s, status),
        growth_rate=s.real + 0.0,
        confidence=confidence[:, :modes],
        error=error,
        status=status,
        eigenvalue=s,
        static_deflection=deflection,
        axial_strain=strain,
        warnings=tuple(_warnings(scene, speeds, deflection, strain, error, status)),
        provenance=_provenance(found, start),
        scene=scene,
    )


def _tracked_error(found: Estimated, order: np.ndarray) -> np.ndarray:
    """Errors in tracked order; a mode that comes from above the compared ones has the largest of its speed."""
    compared = found.error.shape[1]
    beyond = np.repeat(found.error.max(axis=1, keepdims=True), order.max(initial=0) + 1, axis=1)
    beyond[:, :compared] = found.error[:, : beyond.shape[1]]
    return np.take_along_axis(beyond, order, axis=1)


# Critical speed -----------------------------------------------------------------------------------


@dataclass(frozen=True)
class CriticalPoint(Result):
    """Where the stiffness of the rotating beam vanishes.

    Parameters
    ----------
    speed : float
        Critical speed [rad/s]; inf if there is none.
    error : float
        Its estimated relative error.
    provenance : Provenance
        How it was found.
    """

    speed: float
    error: float
    provenance: Provenance


def critical_speed(scene: Scene, method: str | Discretization = "ritz") -> float:
    """Speed at which the beam buckles dynamically [rad/s]; inf if there is none.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.
    method : {"ritz", "fem"} or Discretization
        As for `natural_modes`.

    Returns
    -------
    float
    """
    return critical_point(scene, method).speed


def critical_point(scene: Scene, method: str | Discretization = "ritz") -> CriticalPoint:
    """The critical speed with its error: the lowest speed whose stiffness K0 + omega^2 K2 is singular.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.
    method : {"ritz", "fem"} or Discretization
        As for `natural_modes`.

    Returns
    -------
    CriticalPoint
    """
    start = perf_counter()
    model = choose(scene, method, np.zeros(1), 1)
    while True:
        speed, error = _critical(model)
        finer = None if not isinstance(method, str) else model.discretization.finer()
        if finer is None or error <= max(TARGET, 3 * model.solver.critical_rounding):
            break
        model = Model(scene, finer)
    names = str(model.discretization), str(model.coarser().discretization)
    return CriticalPoint(speed, error, Provenance(__version__, *names, wall_time=perf_counter() - start))


def _critical(model: Model) -> tuple[float, float]:
    fine, coarse = model.solver.critical_speed, model.coarser().solver.critical_speed
    if np.isinf(fine):
        return fine, 0.0
    if np.isinf(coarse):
        return fine, 1.0
    order = model.discretization.order
    speed = fine if order is None else fine + (fine - coarse) / (2**order - 1)
    return float(speed), float(abs(fine - coarse) / speed + model.solver.critical_rounding + model.discretization.rounding)


# Setting angles at which the locus changes its character -----------------------------------------


@dataclass(frozen=True)
class SettingAngleLimits(Result):
    """Setting angles between which the first frequency rises and then falls with speed; unpacks as two.

    Below `first` it falls from rest on; between the two it rises and then falls below the top speed;
    above `second` it rises up to the top speed.

    Parameters
    ----------
    first, second : float
        The limits [rad]; nan where there is none.
    error : float
        Estimated error of the two [rad].
    top_speed : float
        The top speed [rad/s].
    static_deflection : float
        Static tip deflection at the second limit and the top speed, as a fraction of the length.
    warnings : tuple of str
        What limits the answer.
    provenance : Provenance
        How it was found.
    """

    first: float
    second: float
    error: float
    top_speed: float
    static_deflection: float
    warnings: tuple[str, ...]
    provenance: Provenance

    def __iter__(self) -> Iterator[float]:
        return iter((self.first, self.second))


def setting_angle_limits(
    scene: Scene, top_speed: float, method: str | Discretization = "ritz"
) -> SettingAngleLimits:
    """Setting angles at which the first frequency stops falling, and starts rising up to the top speed.

    Parameters
    ----------
    scene : Scene
        The scene; its setting angle, motion, damping and stretch are not used.
    top_speed : float
        Top speed [rad/s]; inf only with a basis of given size, as its answer is of that basis and
        not of the beam.
    method : {"ritz", "fem"} or Discretization
        As for `natural_modes`.

    Returns
    -------
    SettingAngleLimits

    Raises
    ------
    ValueError
        If the top speed is not positive, or infinite without a basis of given size.
    """
    start = perf_counter()
    if not (np.isinf(top_speed) and not isinstance(method, str)):
        remedy = "a converged limit needs a finite top speed; method=Ritz(5, 'eigenfunctions') allows inf"
        positive("top_speed", top_speed, "rad/s", remedy)
    scene = replace(scene, damping_ratio=0.0, stretch=False)
    speeds = np.array([top_speed if np.isfinite(top_speed) else 0.0])
    tangential = replace(scene, mount=replace(scene.mount, setting_angle=np.pi / 2))
    model = choose(tangential, method, speeds, 1)
    first, second = _limits(model, top_speed)
    coarse = model.coarser()
    rough = _limits(coarse, top_speed)
    bent = _bent_at(scene, second, top_speed, model)
    return SettingAngleLimits(
        first=first,
        second=second,
        error=float(np.nanmax([abs(first - rough[0]), abs(second - rough[1]), 0.0])) + 1e-14,
        top_speed=float(top_speed),
        static_deflection=bent,
        warnings=tuple(_limit_warnings(first, second, bent)),
        provenance=Provenance(
            __version__, str(model.discretization), str(coarse.discretization), perf_counter() - start
        ),
    )


def _limits(tangential: Model, top_speed: float) -> tuple[float, float]:
    """Both limits from the parts of the stiffness per squared speed, K2 = A - cos(phi) r KGA."""
    pencil, bending = tangential.solver.pencil, tangential.equations.operators.bending
    A, B = pencil.K2, tangential.scene.mount.radius * bending.KGA
    v = tangential.solver.solve(np.zeros(1), 1).vector[0, :, 0]
    first = _arccos(v @ A @ v, v @ B @ v)
    if np.isinf(top_speed):
        return first, _arccos(float(eigh(A, B, eigvals_only=True)[0]), 1.0) if B.any() else np.nan
    return first, _second_limit(pencil, A, B, first, top_speed)


def _arccos(a: float, b: float) -> float:
    return float(np.arccos(a / b)) if abs(a) <= abs(b) and b else np.nan


def _second_limit(pencil: SteadyPencil, A: np.ndarray, B: np.ndarray, first: float, top_speed: float) -> float:
    """The angle at which the slope of the first squared frequency vanishes at the top speed."""

    def slope(phi: float) -> float:
        K2 = A - np.cos(phi) * B
        v = Solver(replace(pencil, K2=K2)).solve(np.array([top_speed]), 1).vector[0, :, 0]
        return float(v @ K2 @ v)

    low = 0.0 if np.isnan(first) else first
    if slope(low) * slope(np.pi) >= 0:
        return np.nan
    return float(brentq(slope, low, np.pi, xtol=1e-15, rtol=1e-15))  # pyright: ignore[reportArgumentType]


def _bent_at(scene: Scene, phi: float, top_speed: float, model: Model) -> float:
    if np.isnan(phi) or np.isinf(top_speed):
        return np.nan
    mounted = replace(scene, mount=replace(scene.mount, setting_angle=phi))
    deflection, _ = _static(Model(mounted, model.discretization), np.array([top_speed]))
    return float(abs(deflection[0]) / scene.beam.length)


def _limit_warnings(first: float, second: float, bent: float) -> Iterator[str]:
    if np.isnan(first):
        yield "no first limit: at rest the first frequency changes the same way at every setting angle"
    if np.isnan(second):
        yield "no second limit: at the top speed the first frequency changes the same way at every setting angle"
    if not bent <= _LARGE_DEFLECTION:
        yield (
            "at such angles the rotation bends the beam past linear theory "
            f"(static tip deflection {bent:.3g} of the length at the top speed): a result of the linear equations"
        )
