"""Sensitivities of frequencies, of the critical speed and of resonance speeds to the numbers of a scene.

The eigenproblem is perturbed to first order (`perturbation`): no eigenvalues are differenced.  Errors are
estimated as those of frequencies are, by the same derivatives of the coarser model.
"""

from __future__ import annotations

from collections.abc import Sequence
from time import perf_counter

import numpy as np

from beamdyn._version import __version__
from beamdyn.common.inputs.checks import InvalidValue, NoModelAnswer
from beamdyn.common.results.announced import unannounced
from beamdyn.common.results.result import Provenance
from beamdyn.equations.equations_of_motion import SteadyPencil
from beamdyn.modes.critical import critical_point
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.modal.model import Model
from beamdyn.modes.modes import Modes, natural_modes
from beamdyn.scene.scene import Scene
from beamdyn.steady.crossings import Crossing, label_crossing
from beamdyn.steady.resonance import resonance_speeds
from beamdyn.studies.sensitivities.changes import (
    Changes,
    PencilChange,
    PerturbedModes,
    changes_of,
    critical_derivative,
    critical_vector,
    steady_pencils,
)
from beamdyn.studies.sensitivities.result import SceneNumber, Sensitivities, check_names, numbers_of

SPEED = "speed"
_SAME = 1e-6  # relative distance of eigenvalues below which modes cross
_HZ = 1 / (2 * np.pi)


def frequency_sensitivities(
    scene: Scene,
    speed: float = 0.0,
    modes: int = 3,
    inputs: Sequence[str] | None = None,
    discretization: DiscretizationChoice = "ritz",
    tolerance: float | None = None,
) -> Sensitivities:
    """Compute the derivatives of natural frequencies by the numbers of a scene, and by the speed.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.
    speed : float
        Speed [rad/s].
    modes : int
        Number of modes.
    inputs : sequence of str, optional
        Numbers by their names in scene files, such as "beam.thickness"; all, and "speed", if not given.
    discretization, tolerance
        As for `natural_modes`.

    Returns
    -------
    Sensitivities
        Of frequencies [Hz].

    Raises
    ------
    ValueError
        If an argument is out of its range, a name is unknown, or large deflection is modelled.

    References
    ----------
    Lancaster (1966), Lambda-Matrices and Vibrating Systems.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> found = bd.frequency_sensitivities(bd.Scene(strip), modes=1, inputs=["beam.length", "beam.thickness"])
    >>> found.relative[:, 0].round(6)  # f ~ h / L^2
    array([-2.,  1.])
    """
    start = perf_counter()
    with_speed, names = _split_speed(inputs)
    with unannounced():
        found = natural_modes(scene, speed, modes, discretization, tolerance)
    model = _linear(found.model)
    numbers = numbers_of(model.scene, names)
    changes = changes_of(model, numbers)
    fine, coarse = _modes_of(model, found.speed, modes)
    derivative, error = _frequency_derivatives(fine, coarse, changes)
    if with_speed:
        numbers = (*numbers, SceneNumber(SPEED, "rad/s", found.speed, 0.0))
        by_speed, its_error = _speed_derivatives(fine, coarse, found)
        derivative, error = np.vstack([derivative, by_speed]), np.vstack([error, its_error])
    lost, words = _without_derivative(found)
    error += np.where(lost, 0.0, found.error) * np.abs(derivative)  # as derivatives are over the frequency
    derivative[:, lost], error[:, lost] = np.nan, np.inf
    return Sensitivities(
        answers=tuple(f"mode {k}" for k in range(1, modes + 1)),
        unit="Hz",
        value=found.frequency,
        inputs=numbers,
        derivative=derivative,
        error=error,
        warnings=(*found.warnings, *words, *changes.refusals),
        provenance=_provenance(model, start),
        scene=model.scene,
    )


def critical_speed_sensitivities(
    scene: Scene,
    inputs: Sequence[str] | None = None,
    discretization: DiscretizationChoice = "ritz",
    tolerance: float | None = None,
) -> Sensitivities:
    """Compute the derivatives of the critical speed by the numbers of a scene.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.
    inputs : sequence of str, optional
        Numbers by their names in scene files; all if not given.
    discretization, tolerance
        As for `critical_point`.

    Returns
    -------
    Sensitivities
        Of one answer [rad/s].

    Raises
    ------
    ValueError
        If an argument is wrong, or there is no critical speed, or none is known.

    References
    ----------
    Lancaster (1966), Lambda-Matrices and Vibrating Systems.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215))
    >>> bd.critical_speed_sensitivities(scene, inputs=["beam.thickness"]).relative.round(6)  # proportional
    array([[1.]])
    """
    start, names = perf_counter(), check_names(inputs)
    with unannounced():
        found = critical_point(scene, discretization, tolerance)
    if found.model is None or not (0 < found.speed < np.inf and np.isfinite(found.error)):
        raise NoModelAnswer(f"there is no critical speed to change: {found.reason}")
    model = _linear(found.model)
    numbers = numbers_of(model.scene, names)
    changes = changes_of(model, numbers)
    pencils, speeds = _pencils(model), (model.solver.critical_speed, model.coarse_solver.critical_speed)
    fine, coarse = (
        _critical_derivatives(pencil, speed, of)
        for pencil, speed, of in zip(pencils, speeds, changes.of, strict=True)
    )
    missed = np.abs(_critical_derivatives(pencils[0], speeds[0], changes.missed))
    return Sensitivities(
        answers=("critical speed",),
        unit="rad/s",
        value=np.array([found.speed]),
        inputs=numbers,
        derivative=fine,
        error=np.abs(fine - coarse) + missed + changes.rounding[:, None] * found.speed,
        warnings=(*found.warnings, *changes.refusals),
        provenance=_provenance(model, start),
        scene=model.scene,
    )


def crossing_sensitivities(
    scene: Scene,
    top_speed: float,
    modes: int = 3,
    inputs: Sequence[str] | None = None,
    order: int = 1,
    discretization: DiscretizationChoice = "ritz",
) -> Sensitivities:
    """Compute the derivatives of resonance speeds by the numbers of a scene; its motion is not varied.

    Parameters
    ----------
    scene : Scene
        The scene; its motion defines the lines.
    top_speed : float
        Top speed [rad/s].
    modes
        As for `resonance_speeds`.
    inputs : sequence of str, optional
        Numbers by their names in scene files; all if not given.
    order, discretization
        As for `resonance_speeds`.

    Returns
    -------
    Sensitivities
        Of the speed of each crossing [rad/s], in their order.

    Raises
    ------
    ValueError
        If an argument is wrong, or large deflection is modelled.

    References
    ----------
    Lancaster (1966), Lambda-Matrices and Vibrating Systems, along the line of the excitation
    (own).

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> wheel = bd.RollingWheel(0.3, 55.0, bd.RoadWave(0.3, velocity_amplitude=0.01))
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215), wheel)
    >>> bd.crossing_sensitivities(scene, 75.0, modes=1, inputs=["beam.thickness"]).relative.round(6)
    array([[1., 1.]])
    """
    start, names = perf_counter(), check_names(inputs)
    with unannounced():
        crossings = resonance_speeds(scene, top_speed, modes, order, discretization)
    scene = crossings.scene.undamped
    model = _resolved(scene, top_speed, modes + 1, discretization)
    numbers = numbers_of(scene, names)
    changes = changes_of(model, numbers)
    rates = [_crossing_derivatives(model, changes, crossing, modes) for crossing in crossings]
    derivative, error = (np.array([r[i] for r in rates]).reshape(len(rates), len(numbers)).T for i in (0, 1))
    return Sensitivities(
        answers=tuple(_name(crossing) for crossing in crossings),
        unit="rad/s",
        value=np.array([crossing.speed for crossing in crossings]),
        inputs=numbers,
        derivative=derivative,
        error=error,
        warnings=(*crossings.warnings, *changes.refusals),
        provenance=_provenance(model, start),
        scene=scene,
    )


# Frequencies --------------------------------------------------------------------------------------


def _split_speed(inputs: Sequence[str] | None) -> tuple[bool, Sequence[str] | None]:
    """Whether the speed is one of the inputs, and the others."""
    names = check_names(inputs)
    if names is None:
        return True, None
    return SPEED in names, [name for name in names if name != SPEED]


def _linear(model: Model) -> Model:
    """The model, unless its deflections may be large."""
    if model.scene.physics.large_deflection:
        bound = "sensitivities are those of the linear equations"
        raise InvalidValue("physics.large_deflection", True, bound, "leave it out, or use bd.study")
    return model


def _modes_of(model: Model, speed: float, modes: int) -> tuple[PerturbedModes, PerturbedModes]:
    """Modes of a model and of its coarser one."""
    fine, coarse = (
        PerturbedModes.of(pencil, speed, found.eigenvalue[0], found.vector[0])
        for pencil, solver in zip(_pencils(model), (model.solver, model.coarse_solver), strict=True)
        for found in [solver.solve(np.array([speed]), modes)]
    )
    return fine, coarse


def _pencils(model: Model) -> tuple[SteadyPencil, SteadyPencil]:
    return steady_pencils(model, model.equations.coarse)


def _frequency_derivatives(
    fine: PerturbedModes, coarse: PerturbedModes, changes: Changes
) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives of frequencies [Hz / unit of the number] and their errors, shape (n, k)."""
    rates = [
        np.array([np.imag(modes.derivatives(change)) * _HZ for change in changes.of[k]])
        for k, modes in enumerate((fine, coarse))
    ]
    rates.append(np.array([np.abs(fine.derivatives(change)) * _HZ for change in changes.missed]))
    shape = len(changes.of[0]), len(fine.eigenvalue)
    found, other, missed = (rate.reshape(shape) for rate in rates)
    return found, np.abs(found - other) + missed + changes.rounding[:, None] * fine.scales() * _HZ


def _speed_derivatives(
    fine: PerturbedModes, coarse: PerturbedModes, found: Modes
) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives of frequencies by the speed [Hz s/rad] and their errors, shape (k,)."""
    rate, other = (np.imag(modes.speed_derivatives()) * _HZ for modes in (fine, coarse))
    with np.errstate(invalid="ignore"):  # of a mode that does not vibrate
        of_shapes = found.error * fine.scales() * _HZ / (found.speed or np.inf)
    return rate, np.abs(rate - other) + of_shapes


def _without_derivative(found: Modes) -> tuple[np.ndarray, list[str]]:
    """Modes whose derivative there is none of, shape (k,), and why."""
    s, words = found.eigenvalue, []
    apart = np.abs(s[:, None] - s) + np.diag(np.full(len(s), np.inf))
    crossing = (apart <= _SAME * np.abs(s)).any(axis=1) if len(s) > 1 else np.zeros(len(s), dtype=bool)
    if crossing.any():
        numbers = ", ".join(str(k + 1) for k in np.flatnonzero(crossing))
        words.append(f"modes {numbers} have the same frequency: at a crossing of modes none has a derivative")
    silent = ~np.isfinite(found.frequency) | (s == 0)
    if silent.any():
        numbers = ", ".join(str(k + 1) for k in np.flatnonzero(silent))
        words.append(f"mode {numbers} does not vibrate, so that its frequency has no derivative")
    return crossing | silent, words


# Critical speed and crossings ---------------------------------------------------------------------


def _critical_derivatives(pencil: SteadyPencil, speed: float, changes: Sequence[PencilChange]) -> np.ndarray:
    """Derivatives of the critical speed of a model [rad/s / unit of the number], shape (n, 1)."""
    shape = critical_vector(pencil, speed)
    return np.array([[critical_derivative(pencil, speed, shape, change)] for change in changes])


def _resolved(scene: Scene, top: float, modes: int, discretization: DiscretizationChoice) -> Model:
    with unannounced():
        return _linear(natural_modes(scene, top, modes, discretization).model)


def _crossing_derivatives(
    model: Model, changes: Changes, crossing: Crossing, modes: int
) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives of the speed of a crossing, and their errors, shape (n,).

    A line m omega meets the sum of the angular frequencies lambda of one mode or two:
    d omega = -sum d lambda / (sum d lambda / d omega - m).
    """
    fine, coarse = _modes_of(model, crossing.speed, modes)
    found, other, missed = (
        _crossing_rates(of_model, of, crossing)
        for of_model, of in ((fine, changes.of[0]), (coarse, changes.of[1]), (fine, changes.missed))
    )
    return found, np.abs(found - other) + np.abs(missed) + changes.rounding * crossing.speed


def _crossing_rates(found: PerturbedModes, changes: Sequence[PencilChange], crossing: Crossing) -> np.ndarray:
    """Changes of the speed of a crossing where the matrices of a model change, shape (n,)."""
    sums = _sums(np.imag(found.eigenvalue), crossing)
    by_speed = np.imag(found.speed_derivatives()) @ sums
    by_number = np.array([np.imag(found.derivatives(change)) @ sums for change in changes])
    return -by_number / (by_speed - crossing.line.multiple)


def _sums(angular: np.ndarray, crossing: Crossing) -> np.ndarray:
    """How often each mode stands in the sum that the line meets, shape (k,)."""
    first = 2 * np.pi * crossing.frequency
    sums = np.zeros(len(angular))
    sums[np.abs(angular - first).argmin()] += 1
    if crossing.kind == "parametric":
        second = crossing.line.multiple * crossing.speed - first
        sums[np.abs(angular - second).argmin()] += 1
    return sums


def _name(crossing: Crossing) -> str:
    return label_crossing(crossing.line, crossing.kind, crossing.mode, crossing.second_mode)


def _provenance(model: Model, start: float) -> Provenance:
    names = str(model.discretization), str(model.coarser.discretization)
    return Provenance(__version__, *names, perf_counter() - start)
