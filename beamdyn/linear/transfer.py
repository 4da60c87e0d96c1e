"""Transfer functions of a linear model at a steady speed, and whether its free motion decays."""

from __future__ import annotations

import numpy as np

from beamdyn.common.inputs.checks import BeyondModel
from beamdyn.linear.excitations import Excitation
from beamdyn.linear.model_at_speed import HarmonicDrive, ModelAtSpeed
from beamdyn.linear.observations import Observation, StrainAtRoot

_GROWING = 1e-6  # growth rate over the size of a pole, beyond rounding
_STILL = 1e-6  # size of a pole over that of an elastic mode, that is 0: its square is so within rounding
_PLANES = 2  # in each the beam may turn freely, with two poles at 0
_AT_ONCE = 2_000_000  # entries of the matrices that are solved at once


def transfer(
    model: ModelAtSpeed, excitation: Excitation, observation: Observation, frequencies: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Transfer function at frequencies of the excitation [Hz] (F,), for each harmonic of the rotation.

    Returns
    -------
    harmonics : ndarray of int, shape (k,)
        The harmonics h.
    response : ndarray of complex, shape (F, k)
        Response at the frequency f + h n, with n turns per second; inf where the equations are singular.
    """
    drives = model.drives(excitation)
    each = [
        respond(model, drive, observation, 2j * np.pi * frequencies + 1j * h * model.speed)
        for h, drive in drives.items()
    ]
    return np.array([*drives]), np.column_stack(each)


def respond(model: ModelAtSpeed, drive: HarmonicDrive, observation: Observation, s: np.ndarray) -> np.ndarray:
    """Transfer function of one drive at complex frequencies s [1/s] (F,): shape (F,)."""
    row, extra = model.row(observation), model.residual(observation, drive)
    size = model.equations.size
    step = max(1, _AT_ONCE // size**2)
    q = np.concatenate([_solve(model, drive.load, s[k : k + step]) for k in range(0, len(s), step)])
    by_kept = q @ row.position + s * (q @ row.velocity) + s**2 * (q @ row.acceleration)
    total = by_kept + extra[0] + s * extra[1] + s**2 * extra[2]
    if isinstance(observation, StrainAtRoot):  # the moment of a material that damps is E I (k + beta k')
        total = total / (1 + s * model.scene.damping.stiffness_factor)
    return total


def _solve(model: ModelAtSpeed, load: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Coordinates (F, n) per unit of the input; inf where the equations are singular."""
    A = s[:, None, None] ** 2 * model.M + s[:, None, None] * model.C + model.K
    try:
        return np.linalg.solve(A, np.broadcast_to(load, (len(s), len(load)))[..., None])[..., 0]
    except np.linalg.LinAlgError:
        if len(s) == 1:
            return np.full((1, len(load)), np.inf + 0j)
        return np.concatenate([_solve(model, load, each[None]) for each in s])


def check_stable(model: ModelAtSpeed) -> None:
    """Refuse a speed at which free motion grows, or the beam turns freely about its root.

    Raises
    ------
    BeyondModel
        With the speed.
    """
    free, speed = model.free_motion, model.speed
    inverse = free.inverse_poles
    elastic = np.abs(inverse[min(2 * _PLANES, len(inverse) - 1)])
    if elastic < _STILL * np.abs(inverse[0]):
        bound, remedy = (
            "the beam turns freely about its root, or is at its critical speed",
            "change the speed, or give root_stiffness",
        )
        raise BeyondModel("speed", speed, bound, remedy, "rad/s")
    growing = np.real(inverse) > _GROWING * np.abs(inverse) + free.rounding
    if growing.any():
        growth = np.real(1 / inverse[growing]).max()
        bound = f"free motion grows at {growth:.3g} 1/s: the speed is past the critical speed"
        raise BeyondModel("speed", speed, bound, "lower the speed", "rad/s")
