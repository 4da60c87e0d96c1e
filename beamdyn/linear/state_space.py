"""State-space form of small motions at a steady speed, for control and simulation by scipy.signal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from scipy.signal import StateSpace, lti

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.results.statements import announce
from beamdyn.linear.convergence import check_linear, model_at_speed, with_forces
from beamdyn.linear.inputs_outputs import Excitation, Observation, StrainAtRoot, as_observation
from beamdyn.linear.matrices import MOST_JUDGED, list_inputs, listed, steady_drive, warn_of_model
from beamdyn.linear.model_at_speed import ModelAtSpeed, pole_errors
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects
from beamdyn.modes.repeated import left_out_of_frequencies
from beamdyn.scene.scene import Scene

_MODES = 6  # number of modes by default
_MASSLESS = 1e-12  # smallest nonzero eigenvalue of the mass matrix, relative to the largest


class StateSpaceWithErrors(StateSpace, lti):  # pyright: ignore[reportIncompatibleMethodOverride]
    """A `scipy.signal.StateSpace` with error estimates; systems that scipy derives from it have none.

    Attributes
    ----------
    scene : Scene
        The scene.
    speed : float
        Speed [rad/s].
    error : ndarray, shape (2 n,)
        Estimated relative error of each pole, in ascending order of magnitude: see `Matrices`.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, poissons_ratio=0.3)
    >>> system = bd.state_space(bd.Scene(strip, bd.Mount(radius=0.215)), 50.0, inputs=["bending"], modes=2)
    >>> bool(0.01 < system.model_error[0] < 0.03)  # the section is clamped, and its camber hindered
    True
    """

    scene: Scene
    speed: float
    error: np.ndarray

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """Relative changes of the lowest natural frequencies by neglected effects: see `Matrices`."""
        return left_out_of_frequencies(self.scene, self.speed, min(len(self.A) // 2, MOST_JUDGED))

    @property
    def left_out(self) -> Mapping[str, np.ndarray]:
        """Relative change of the lowest natural frequencies by each effect left out of the model."""
        return self.left_out_effects.changes

    @property
    def model_error(self) -> np.ndarray:
        """Magnitude of the sum of all changes in `left_out`; nan where one of the changes is not known."""
        return self.left_out_effects.total


def state_space(
    scene: Scene,
    speed: float,
    inputs: Sequence[Excitation | str] | None = None,
    outputs: Sequence[Observation | str] = ("tip",),
    modes: int | None = _MODES,
    discretization: DiscretizationChoice = "ritz",
    tolerance: float | None = None,
) -> StateSpaceWithErrors:
    """Compute the small motions at a steady speed as x' = A x + B u, y = C x + D u.

    The states x are the coordinates of `matrices` with the same arguments, then their rates.  D contains
    the residual flexibility, by which modes left out follow without delay, so that the response to a constant
    input is that of the whole discretization: Craig and Kurdila, Fundamentals of Structural Dynamics (2006),
    section 11.4.  The static deflection due to the rotation itself is not included.

    Parameters
    ----------
    scene : Scene
        The scene; its motion and gravity are not used.
    speed : float
        Speed [rad/s].
    inputs : sequence of BaseMotion, PointForce or str, optional
        As for `matrices`.
    outputs : sequence of DeflectionAt, AccelerationAt, MomentAtRoot, StrainAtRoot or str
        As for `frequency_response`, including those of a harvester.
    modes : int or None
        Number of modes at this speed of each set of coupled fields; None keeps all functions.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.
    tolerance : float, optional
        As for `matrices`.

    Returns
    -------
    scipy.signal.StateSpace
        With `error`, shape (2 n,), the estimated relative error of each pole in ascending order of magnitude;
        `model_error` and `left_out` are those of `matrices`.  A system derived from it has none of these.

    Raises
    ------
    ValueError
        If an argument is out of its range, an input in a fixed direction acts on the rotating beam, so that
        the matrix B would vary, or a retained coordinate has no mass.

    References
    ----------
    Craig and Kurdila (2006), Fundamentals of Structural Dynamics, section 11.4.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215))
    >>> system = bd.state_space(scene, 50.0, inputs=["bending"], outputs=["tip"], modes=2)
    >>> system.A.shape, system.C.shape
    ((4, 4), (1, 4))
    """
    scene, speed = check_linear(scene, speed, modes)
    excitations = list_inputs(inputs, scene)
    model = model_at_speed(with_forces(scene, excitations), speed, modes, discretization, tolerance)
    announce((*warn_of_model(model),), "")
    drives = [steady_drive(model, each) for each in excitations]
    observed = [as_observation(f"outputs[{k}]", each) for k, each in enumerate(listed("outputs", outputs))]
    _refuse_delayed_strain(scene, observed)
    loads = np.column_stack([drive.load for drive in drives])
    rates, n = _rates(model, loads), model.equations.size
    of_state, of_load = rates.acceleration
    m = of_state.shape[1] - n  # number of velocities among the states
    A, B = (np.vstack([velocity, acceleration]) for velocity, acceleration in zip(*rates, strict=True))
    rows = [model.row(each) for each in observed]
    C = np.array([np.concatenate([r.position, r.velocity[:m]]) + r.acceleration[:m] @ of_state for r in rows])
    correction = [[float(np.real(model.residual(each, drive)[0])) for drive in drives] for each in observed]
    D = np.array([r.acceleration[:m] @ of_load for r in rows]) + correction
    system: Any = StateSpaceWithErrors(A, B, C, D)  # pyright: ignore[reportAbstractUsage]
    system.scene, system.speed, system.error = scene, speed, pole_errors(model)
    return system


def _refuse_delayed_strain(scene: Scene, observed: Sequence[Observation]) -> None:
    """Refuse strain as output of a damped material: its delay behind the moment needs a further state."""
    factor = scene.damping.stiffness_factor
    if factor and any(isinstance(each, StrainAtRoot) for each in observed):
        bound = "the strain of a material that damps is not a function of the moment alone"
        raise InvalidValue("damping.stiffness_factor", factor, bound, "use frequency_response for it", "s")


class _Rates(NamedTuple):
    """Velocities of all coordinates, and accelerations of those with mass.

    Each is a pair of matrices: per unit of the states, and per unit of the inputs.
    """

    velocity: tuple[np.ndarray, np.ndarray]
    acceleration: tuple[np.ndarray, np.ndarray]


def _rates(model: ModelAtSpeed, loads: np.ndarray) -> _Rates:
    """Compute velocities and accelerations per unit of each state and of each input.

    `loads` has the load of a unit of each input in its columns.  The charge of a circuit has no mass: its
    rate follows from the equations, and is not a state.
    """
    n = model.equations.size
    m = model.mechanical.stop
    M = model.M[:m, :m]
    values = np.linalg.eigvalsh(M)
    if values[0] < _MASSLESS * values[-1]:
        bound = "some coordinates have no mass, so that their rates cannot be states"
        raise InvalidValue("modes", model.modes, bound, "give a number of modes")
    of_state = np.linalg.solve(M, -np.hstack([model.K[:m], model.C[:m, :m]]))
    of_load = np.linalg.solve(M, loads[:m])
    resistance = model.C[m:, m:]
    flow = np.linalg.solve(resistance, -model.K[m:]), np.linalg.solve(resistance, loads[m:])
    by_state = np.block([[np.zeros((m, n)), np.eye(m)], [flow[0], np.zeros((n - m, m))]])
    return _Rates((by_state, np.vstack([np.zeros_like(of_load), flow[1]])), (of_state, of_load))
