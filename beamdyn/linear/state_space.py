"""The linear model at a steady speed as a state space, for scipy.signal and programs of control."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.results.announced import announce
from beamdyn.linear.choice import check_linear, model_at_speed, with_forces
from beamdyn.linear.excitations import Excitation
from beamdyn.linear.matrices import list_inputs, listed, steady_drive, warn_of_model
from beamdyn.linear.model_at_speed import HarmonicDrive, ModelAtSpeed
from beamdyn.linear.observations import Observation, StrainAtRoot, as_observation
from beamdyn.linear.pole_errors import pole_errors
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.scene.scene import Scene

if TYPE_CHECKING:
    from scipy.signal import StateSpace

_MODES = 6  # by default
_MASSLESS = 1e-12  # smallest eigenvalue of the mass, over the largest, that is told from 0


def state_space(
    scene: Scene,
    speed: float,
    inputs: Sequence[Excitation | str] | None = None,
    outputs: Sequence[Observation | str] = ("tip",),
    modes: int | None = _MODES,
    discretization: DiscretizationChoice = "ritz",
) -> StateSpace:
    """Give the small motions at a steady speed as x' = A x + B u, y = C x + D u.

    The states x are the coordinates of `matrices` with the same arguments, then their rates.  D holds what
    the modes left out follow without delay, their residual flexibility, so that the response to a constant
    input is that of the whole discretization: Craig and Kurdila, Fundamentals of Structural Dynamics (2006),
    section 11.4.  The static deflection by the rotation itself is not in it.

    Parameters
    ----------
    scene : Scene
        The scene; its motion and gravity are not used.
    speed : float
        Speed [rad/s].
    inputs : sequence of BaseMotion, PointForce or str, optional
        As for `matrices`.
    outputs : sequence of DeflectionAt, AccelerationAt, MomentAtRoot, StrainAtRoot or str
        As for `frequency_response`.
    modes : int or None
        Number of modes at this speed of each set of coupled fields; None keeps all functions.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.

    Returns
    -------
    scipy.signal.StateSpace
        With one more attribute, `error`, shape (2 n,): the estimated relative error of each pole, in
        ascending order of magnitude, as that of `matrices`.  A system that is made of it has none.

    Raises
    ------
    ValueError
        If an argument is out of its range, an input is periodic at this speed, or a kept coordinate has no
        mass.

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
    from scipy.signal import StateSpace  # here, because it is slow to import

    scene, speed = check_linear(scene, speed, modes)
    excitations = list_inputs(inputs, scene)
    model = model_at_speed(with_forces(scene, excitations), speed, modes, discretization)
    announce((*warn_of_model(model),), "")
    drives = [steady_drive(model, each) for each in excitations]
    observed = [as_observation(f"outputs[{k}]", each) for k, each in enumerate(listed("outputs", outputs))]
    _refuse_delayed_strain(scene, observed)
    M, n = _with_mass(model), model.equations.size
    loads = np.column_stack([drive.load for drive in drives])
    of_state, of_load = np.linalg.solve(M, -np.hstack([model.K, model.C])), np.linalg.solve(M, loads)
    A = np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), of_state])
    B = np.vstack([np.zeros_like(of_load), of_load])
    rows = [model.row(each) for each in observed]
    C = np.array([np.concatenate([r.position, r.velocity]) + r.acceleration @ of_state for r in rows])
    correction = [[_correction(model, each, drive) for drive in drives] for each in observed]
    system = StateSpace(A, B, C, np.array([r.acceleration @ of_load for r in rows]) + correction)
    vars(system)["error"] = pole_errors(model)
    return system


def _refuse_delayed_strain(scene: Scene, observed: Sequence[Observation]) -> None:
    """Refuse the strain of a material that damps: it follows the moment with a delay, a further state."""
    factor = scene.damping.stiffness_factor
    if factor and any(isinstance(each, StrainAtRoot) for each in observed):
        bound = "the strain of a material that damps is not a function of the moment alone"
        raise InvalidValue("damping.stiffness_factor", factor, bound, "ask frequency_response for it", "s")


def _correction(model: ModelAtSpeed, observation: Observation, drive: HarmonicDrive) -> float:
    """What an output gains by the static deflection of what is left out, and by the base itself."""
    return float(np.real(model.residual(observation, drive)[0]))


def _with_mass(model: ModelAtSpeed) -> np.ndarray:
    """The mass; refused if a coordinate has none, as bending and shear without rotary inertia."""
    values = np.linalg.eigvalsh(model.M)
    if values[0] < _MASSLESS * values[-1]:
        bound = "some functions have no mass of their own, and no rates as states"
        raise InvalidValue("modes", model.modes, bound, "give a number of modes")
    return model.M
