"""Transfer functions of a linear model at a steady speed, and a check that its free motion decays.

For many frequencies, a transfer function is evaluated as a sum over a model's free motions, which is fast.

Each free motion adds one term, divided by 1 - s t_k, with its inverse pole t_k = 1/p_k: see
`beamdyn.linear.free_motion`.  The lowest poles belong to the largest t_k, which are the accurate ones;
coordinates without mass have t_k = 0.

In shapes of arrays, F counts frequencies, k harmonics, and n coordinates.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from beamdyn.common.inputs.checks import BeyondModel
from beamdyn.linear.inputs_outputs import Excitation, Observation, StrainAtRoot
from beamdyn.linear.model_at_speed import HarmonicDrive, ModelAtSpeed
from beamdyn.modes.modal.error_estimate import rounding_of_entries

_EPS = np.finfo(float).eps
_TERMS_AT_ONCE = 1_000_000  # number of terms of the sum that are kept in memory at once


@dataclass(frozen=True)
class ModalSum:
    """Transfer function (sum_k (w_k0 + w_k1 s + w_k2 s^2)/(1 - s t_k) + d_0 + d_1 s + d_2 s^2)/(1 + s delay).

    Parameters
    ----------
    inverse_poles : ndarray of complex, shape (m,)
        Inverse poles t_k [s].
    weights : ndarray of complex, shape (m, 3)
        Weights w_kj of the terms.
    direct : ndarray of complex, shape (3,)
        Coefficients d_j of the direct part.
    delay : float
        Delay of the strain in a material with damping [s].
    """

    inverse_poles: np.ndarray
    weights: np.ndarray
    direct: np.ndarray
    delay: float

    @property
    def poles(self) -> np.ndarray:
        """Finite poles [1/s] of the transfer function."""
        return 1 / self.inverse_poles[self.inverse_poles != 0]

    def __call__(self, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Evaluate the transfer function and its derivative at complex frequencies s [1/s]."""
        step = max(1, _TERMS_AT_ONCE // len(self.inverse_poles))
        values, slopes = [], []
        for part in np.split(s, range(step, len(s), step)):
            terms = 1 / (1 - part[:, None] * self.inverse_poles)
            w, dw = terms @ self.weights + self.direct, (terms**2 * self.inverse_poles) @ self.weights
            values.append(w[:, 0] + part * (w[:, 1] + part * w[:, 2]))
            inner = dw[:, 0] + part * (dw[:, 1] + part * dw[:, 2])
            slopes.append(inner + w[:, 1] + 2 * part * w[:, 2])
        value, slope, filtered = np.concatenate(values), np.concatenate(slopes), 1 + s * self.delay
        return value / filtered, (slope - value * self.delay / filtered) / filtered


def modal_sums(
    model: ModelAtSpeed, drives: Mapping[int, HarmonicDrive], observation: Observation
) -> dict[int, ModalSum]:
    """Expand the transfer function of each drive as a sum over poles, by harmonic of the rotation."""
    free = model.free_motion
    shares = free.shares(np.column_stack([drive.load for drive in drives.values()]))
    row = model.row(observation)
    seen = np.column_stack([r @ free.shapes for r in (row.position, row.velocity, row.acceleration)])
    delay = model.scene.damping.stiffness_factor if isinstance(observation, StrainAtRoot) else 0.0
    return {
        h: ModalSum(free.inverse_poles, seen * share[:, None], model.residual(observation, drive), delay)
        for (h, drive), share in zip(drives.items(), shares.T, strict=True)
    }


def rounding_errors(
    model: ModelAtSpeed, excitation: Excitation, observation: Observation, frequencies: np.ndarray
) -> np.ndarray:
    """Estimate the rounding errors of a transfer function, which resonance magnifies: shape (F, k).

    Relative errors of the entries of mass and stiffness matrix change the response by the work of their
    forces on the response to a load that is 1 where the output is observed.  For the parameters see
    `transfer`.
    """
    free, row, shapes = model.free_motion, model.row(observation), model.shapes
    if len(frequencies) > (step := max(1, _TERMS_AT_ONCE // len(shapes))):
        parts = np.split(frequencies, range(step, len(frequencies), step))
        return np.concatenate([rounding_errors(model, excitation, observation, part) for part in parts])
    of_loads, full = free.shares(np.eye(len(free.shapes))), model.model.equations.steady()
    K = model.full_stiffness
    found = []
    for h, drive in model.drives(excitation).items():
        s = 2j * np.pi * frequencies[:, None] + 1j * h * model.speed
        distance = 1 - s * free.inverse_poles
        terms = 1 / np.where(distance == 0, _EPS, distance)  # at a pole within rounding, without damping
        q = terms * (of_loads @ drive.load) @ free.shapes.T @ shapes.T
        seen = (r @ free.shapes for r in (row.position, row.velocity, row.acceleration))
        weights = sum(s**power * each for power, each in enumerate(seen))
        answer = terms * weights @ of_loads @ shapes.T
        found.append(
            rounding_of_entries(K, answer, q) + np.abs(s[:, 0]) ** 2 * rounding_of_entries(full.M, answer, q)
        )
    return np.column_stack(found)


# Solution by the equations, and stability ----------------------------------------------------------


_GROWING = 1e-6  # ratio of growth rate to magnitude of a pole above which the growth exceeds rounding
# Ratio of a pole to that of an elastic mode, below which it counts as 0: its square is 0 within rounding.
_STILL = 1e-6
_PLANES = 2  # number of planes in which the beam may rotate freely about its root, with two poles at 0 each
_AT_ONCE = 2_000_000  # number of matrix entries in memory when equations are solved at many frequencies


def transfer(
    model: ModelAtSpeed, excitation: Excitation, observation: Observation, frequencies: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Compute the transfer function at excitation frequencies [Hz] (F,), for each harmonic of rotation.

    Returns
    -------
    harmonics : ndarray of int, shape (k,)
        Harmonics h of the rotation.
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
    """Compute the response to one harmonic drive at complex frequencies s [1/s]."""
    row, extra = model.row(observation), model.residual(observation, drive)
    step = max(1, _AT_ONCE // model.equations.size**2)
    q = np.concatenate([_solve(model, drive.load, s[k : k + step]) for k in range(0, len(s), step)])
    by_kept = q @ row.position + s * (q @ row.velocity) + s**2 * (q @ row.acceleration)
    total = by_kept + extra[0] + s * extra[1] + s**2 * extra[2]
    if isinstance(observation, StrainAtRoot):
        # With damping beta of the material, a curvature k has the moment E I (k + beta k').
        total = total / (1 + s * model.scene.damping.stiffness_factor)
    return total


def _solve(model: ModelAtSpeed, load: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Solve the equations of motion for the coordinates per unit input at each s; inf where singular."""
    A = s[:, None, None] ** 2 * model.M + s[:, None, None] * model.C + model.K
    try:
        return np.linalg.solve(A, np.broadcast_to(load, (len(s), len(load)))[..., None])[..., 0]
    except np.linalg.LinAlgError:
        if len(s) == 1:
            return np.full((1, len(load)), np.inf + 0j)
        return np.concatenate([_solve(model, load, each[None]) for each in s])


def check_stable(model: ModelAtSpeed) -> None:
    """Refuse a speed at which free motion grows, or the beam rotates freely about its root.

    Raises
    ------
    BeyondModel
        If free motion does not decay; the message names the speed.
    """
    free, speed = model.free_motion, model.speed
    inverse, mechanical = free.inverse_poles, model.inverse_mechanical_poles
    elastic = np.abs(mechanical[min(2 * _PLANES, len(mechanical) - 1)])
    if elastic < _STILL * np.abs(mechanical[0]) or np.isinf(inverse).any():
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
