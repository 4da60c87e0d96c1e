"""Sensitivities of frequencies, critical speed and resonance speeds to the numbers of a scene.

Derivatives follow from first-order perturbation of the eigenproblem: no eigenvalues are differenced.  Errors
are estimated as for frequencies, from the same derivatives of the coarser model.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from time import perf_counter
from typing import Any

import numpy as np

from beamdyn.common.inputs.checks import NoModelAnswer
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import unannounced
from beamdyn.common.words import Named
from beamdyn.modes.critical import critical_point
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.modal.model import Model
from beamdyn.modes.modes import Modes, natural_modes
from beamdyn.modes.repeated import repeatable
from beamdyn.scene.numbers import SPEED
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.scene.validity import refuse_large_deflection
from beamdyn.steady.crossings import Crossing, label_crossing
from beamdyn.steady.resonance import resonance_speeds
from beamdyn.studies.sensitivities import sensitivity_result
from beamdyn.studies.sensitivities.changes import (
    EPSILON,
    Changes,
    PencilChange,
    PerturbedModes,
    changes_of,
    critical_derivative,
    critical_vector,
    steady_pencils,
)
from beamdyn.studies.sensitivities.sensitivity_result import Sensitivities

_SAME = 1e-6  # relative distance below which eigenvalues are equal, so that modes cross
_HZ = 1 / (2 * np.pi)


@repeatable
def frequency_sensitivities(
    scene: Scene,
    speed: float = 0.0,
    modes: int = 3,
    inputs: Sequence[str] | None = None,
    discretization: DiscretizationChoice = "ritz",
    tolerance: float | None = None,
) -> Sensitivities:
    """Compute derivatives of natural frequencies with respect to the numbers of a scene and to the speed.

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
        Derivatives of frequencies [Hz].

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
    start, names = perf_counter(), sensitivity_result.check_names(inputs)
    _check_linear(scene)
    with unannounced():
        found = natural_modes(scene, speed, modes, discretization, tolerance)
    model = found.model
    _check_linear(model.scene)
    numbers = sensitivity_result.numbers_of(model.scene, names and [name for name in names if name != SPEED])
    changes = changes_of(model, numbers)
    fine, _ = both = _modes_of(model, found.speed, modes)
    derivative, error = _compared(changes, lambda k, dP: both[k].derivatives(dP), fine.scales(), np.imag, _HZ)
    if names is None or SPEED in names:
        numbers = (*numbers, sensitivity_result.SceneNumber(SPEED, "rad/s", found.speed, 0.0))
        rate, other = (np.imag(each.speed_derivatives()) * _HZ for each in both)
        with np.errstate(invalid="ignore"):  # the frequency is 0 if a mode does not vibrate
            rounding = EPSILON * fine.scales() * _HZ / (found.speed or np.inf)
        derivative = np.vstack([derivative, rate])
        error = np.vstack([error, np.abs(rate - other) + rounding])
    lost, words = _without_derivative(found)
    # The derivative is proportional to the frequency, and so also has the frequency's relative error.
    error += np.where(lost, 0.0, found.error) * np.abs(derivative)
    derivative[:, lost], error[:, lost] = np.nan, np.inf
    answers = tuple(f"mode {k}" for k in range(1, modes + 1))
    return Sensitivities(
        answers=answers,
        unit="Hz",
        value=found.frequency,
        inputs=numbers,
        derivative=derivative,
        error=error,
        warnings=(*found.warnings, *words, *changes.refusals),
        provenance=_since(start, model),
        scene=model.scene,
        speed=found.speed,
    )


@repeatable
def critical_speed_sensitivities(
    scene: Scene,
    inputs: Sequence[str] | None = None,
    discretization: DiscretizationChoice = "ritz",
    tolerance: float | None = None,
) -> Sensitivities:
    """Compute the derivatives of the critical speed with respect to the numbers of a scene.

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
        Derivatives of the critical speed [rad/s].

    Raises
    ------
    ValueError
        If an argument is wrong, or if there is no critical speed or it is not known.

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
    start, names = perf_counter(), sensitivity_result.check_names(inputs)
    _check_linear(scene)
    with unannounced():
        found = critical_point(scene, discretization, tolerance)
    if found.model is None or not (0 < found.speed < np.inf and np.isfinite(found.error)):
        raise NoModelAnswer(f"there is no critical speed to change: {found.reason}")
    model = found.model
    _check_linear(model.scene)
    numbers = sensitivity_result.numbers_of(model.scene, names)
    changes = changes_of(model, numbers, damped=False)
    speeds = model.solver.critical_speed, model.coarse_solver.critical_speed
    each = [(P, at, critical_vector(P, at)) for P, at in zip(steady_pencils(model), speeds, strict=True)]
    derivative, error = _compared(changes, lambda k, dP: critical_derivative(*each[k], dP), found.speed)
    return Sensitivities(
        answers=("critical speed",),
        unit="rad/s",
        value=np.array([found.speed]),
        inputs=numbers,
        derivative=derivative,
        error=error,
        warnings=(*found.warnings, *changes.refusals),
        provenance=_since(start, model),
        scene=model.scene,
    )


@repeatable
def crossing_sensitivities(
    scene: Scene,
    top_speed: float,
    modes: int = 3,
    inputs: Sequence[str] | None = None,
    order: int = 1,
    discretization: DiscretizationChoice = "ritz",
    tolerance: float | None = None,
) -> Sensitivities:
    """Compute derivatives of resonance speeds with respect to numbers of a scene but not of its motion.

    Parameters
    ----------
    scene : Scene
        The scene; its motion defines the excitation lines.
    top_speed : float
        Top speed [rad/s].
    modes
        As for `resonance_speeds`.
    inputs : sequence of str, optional
        Numbers by their names in scene files; all if not given.
    order, discretization, tolerance
        As for `resonance_speeds`.

    Returns
    -------
    Sensitivities
        Derivatives of the speed of each crossing [rad/s], in the order of `resonance_speeds`.

    Raises
    ------
    ValueError
        If an argument is wrong, or large deflection is modelled.

    References
    ----------
    Lancaster (1966), Lambda-Matrices and Vibrating Systems; for the speed at which a frequency stays on an
    excitation line: own derivation.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> wheel = bd.RollingWheel(0.3, 55.0, bd.RoadWave(0.3, velocity_amplitude=0.01))
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215), wheel)
    >>> bd.crossing_sensitivities(scene, 75.0, modes=1, inputs=["beam.thickness"]).relative.round(6)
    array([[1., 1.]])
    """
    start, names = perf_counter(), sensitivity_result.check_names(inputs)
    _check_linear(scene)
    with unannounced():
        crossings = resonance_speeds(scene, top_speed, modes, order, discretization, tolerance)
        scene = crossings.scene.undamped
        _check_linear(scene)
        model = natural_modes(scene, top_speed, modes + 1, discretization, tolerance).model
    numbers = sensitivity_result.numbers_of(scene, names)
    changes = changes_of(model, numbers)
    none = np.zeros((len(numbers), 0))
    columns = [(none, none), *(_crossing_derivatives(model, changes, c, modes) for c in crossings)]
    derivative, error = (np.hstack(parts) for parts in zip(*columns, strict=True))
    return Sensitivities(
        answers=tuple(label_crossing(c.line, c.kind, c.mode, c.second_mode) for c in crossings),
        unit="rad/s",
        value=np.array([c.speed for c in crossings]),
        inputs=numbers,
        derivative=derivative,
        error=error,
        warnings=(*crossings.warnings, *changes.refusals),
        provenance=_since(start, model),
        scene=scene,
    )


def _since(start: float, model: Model) -> Provenance:
    """Describe the computation of sensitivities with a model, started at a time of `perf_counter` [s]."""
    return Provenance.since(start, str(model.discretization), str(model.coarser.discretization))


# Frequencies --------------------------------------------------------------------------------------


def _check_linear(scene: Scene) -> None:
    """Refuse large deflection: before anything is computed, and again where physics "auto" has chosen it."""
    check_scene(scene)
    bound = "sensitivities are computed for linear equations only"
    refuse_large_deflection(scene, bound, ", or use ", Named("bd.study", "beamdyn study"))


def _modes_of(model: Model, speed: float, modes: int) -> tuple[PerturbedModes, PerturbedModes]:
    """Compute the modes of a model and of its coarser model."""
    fine, coarse = (
        PerturbedModes.of(pencil, speed, found.eigenvalue[0], found.vector[0])
        for pencil, solver in zip(steady_pencils(model), (model.solver, model.coarse_solver), strict=True)
        for found in [solver.solve(np.array([speed]), modes)]
    )
    return fine, coarse


def _compared(
    changes: Changes,
    rate: Callable[[int, PencilChange], Any],
    scale: np.ndarray | float,
    part: Callable[[np.ndarray], np.ndarray] = np.real,
    unit: float = 1.0,
) -> tuple[np.ndarray, np.ndarray]:
    """Compute derivatives (n, k) of k results with respect to n numbers, and their estimated errors.

    The errors are estimated from the differences between a model and its coarser one.

    Parameters
    ----------
    changes : Changes
        Derivatives of the matrices with respect to n numbers.
    rate : callable
        Function of k and a `PencilChange` that computes the derivatives of the results from those of the
        matrices; k is 0 for the model, and 1 for its coarser model.
    scale : ndarray, shape (k,), or float
        Change of the results per relative change of the matrices.
    part : callable
        Function that extracts the real result from a complex derivative, such as its imaginary part.
    unit : float
        Factor that converts derivatives of angular frequencies to those in the unit of the results.
    """
    shape, of_models = (len(changes.rounding), np.size(scale)), (*enumerate(changes.of), (0, changes.missed))
    fine, coarse, missed = (
        np.array([rate(k, change) for change in each]).reshape(shape) for k, each in of_models
    )
    found, other = part(fine) * unit, part(coarse) * unit
    return found, np.abs(found - other) + np.abs(missed) * unit + changes.rounding[:, None] * scale * unit


def _without_derivative(found: Modes) -> tuple[np.ndarray, list[str]]:
    """Return which modes have no derivative, with sentences that explain why."""
    s, words = found.eigenvalue, []
    apart = np.abs(s[:, None] - s) + np.diag(np.full(len(s), np.inf))
    crossing = (apart <= _SAME * np.abs(s)).any(axis=1) if len(s) > 1 else np.zeros(len(s), dtype=bool)
    if crossing.any():
        numbers = ", ".join(str(k + 1) for k in np.flatnonzero(crossing))
        words.append(f"modes {numbers} have the same frequency: at a crossing of modes none has a derivative")
    silent = ~np.isfinite(found.frequency) | (s == 0)
    if silent.any():
        numbers = ", ".join(str(k + 1) for k in np.flatnonzero(silent))
        words.append(f"mode {numbers}: without vibration there is no frequency, and no derivative")
    return crossing | silent, words


def _crossing_derivatives(
    model: Model, changes: Changes, crossing: Crossing, modes: int
) -> tuple[np.ndarray, np.ndarray]:
    """Compute derivatives (n, 1) of the speed of a crossing with respect to n numbers, and their errors.

    At a crossing, a line m omega meets the sum of the angular frequencies lambda of one mode or two modes:
    d omega = -sum d lambda / (sum d lambda / d omega - m).
    """
    both = _modes_of(model, crossing.speed, modes)
    sums = [_sums(np.imag(each.eigenvalue), crossing) for each in both]
    slopes = [
        np.imag(m.speed_derivatives()) @ n - crossing.line.multiple for m, n in zip(both, sums, strict=True)
    ]
    return _compared(
        changes, lambda k, dP: -(np.imag(both[k].derivatives(dP)) @ sums[k]) / slopes[k], crossing.speed
    )


def _sums(angular: np.ndarray, crossing: Crossing) -> np.ndarray:
    """Count the occurrences of each mode in the sum of frequencies that the line meets."""
    first = 2 * np.pi * crossing.frequency
    sums = np.zeros(len(angular))
    sums[np.abs(angular - first).argmin()] += 1
    if crossing.kind == "parametric":
        second = crossing.line.multiple * crossing.speed - first
        sums[np.abs(angular - second).argmin()] += 1
    return sums
