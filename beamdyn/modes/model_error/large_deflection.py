"""What large deflection would change, which is solved and not estimated."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

import numpy as np

from beamdyn.common.assignment import assign
from beamdyn.common.inputs.checks import InvalidValue, reason_of
from beamdyn.modes.modal.model import Model
from beamdyn.modes.modal.static_load import bends
from beamdyn.scene.physics import Physics
from beamdyn.scene.scene import Scene

NO_CRITICAL_SPEED = "the rotation bends the beam at every speed: it does not buckle"
_BUCKLED = "the straight beam is unstable: Physics(large_deflection=True, branch='bent') bends it"
TWO_PLANES = "it is solved in one plane of bending"
HINGED = "a beam on a hinge has no one equilibrium from which it could bend"
OBLIQUE = "it is solved where the bending angle is a multiple of 90 deg"
PRECONED = "it is solved without precone"
REFUSED = {"mount.bending_angle": OBLIQUE, "mount.precone": PRECONED}
EXCLUDED = TWO_PLANES, HINGED, OBLIQUE, PRECONED  # why it cannot be added
_NOT_FOUND = "the equilibrium was not found"
_EXTRA_MODES = 2  # higher ones with which the wanted may exchange their order


def large_deflection_change(
    model: Model, speeds: np.ndarray, eigenvalue: np.ndarray
) -> tuple[np.ndarray, str]:
    """Find what large deflection changes in the frequencies at some speeds.

    What it cannot be combined with is left out of both beams that are compared: the change is then to first
    order.  Modes of a beam in one plane keep their order.

    Parameters
    ----------
    model : Model
        The linear model.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].
    eigenvalue : ndarray of complex, shape (S, m)
        Its eigenvalues [1/s].

    Returns
    -------
    change : ndarray, shape (S, m)
        Relative change of each frequency: 0 if the straight beam is in equilibrium, nan if it is not known.
    reason : str
        Why it is not known; empty if it is.
    """
    if not bends(model):
        unstable = (np.real(eigenvalue) > 0).any(axis=1, keepdims=True) & (speeds != 0)[:, None]
        change = np.where(unstable, np.nan, np.zeros(eigenvalue.shape))
        return change, _BUCKLED if unstable.any() else ""
    if model.scene.physics.planes == 2:
        return np.where((speeds == 0)[:, None], 0.0, np.full(eigenvalue.shape, np.nan)), TWO_PLANES
    try:
        straight, bent = (Model(scene, model.discretization) for scene in comparable(model.scene))
    except InvalidValue as refusal:
        reason = REFUSED.get(refusal.field, HINGED)
        return np.where((speeds == 0)[:, None], 0.0, np.full(eigenvalue.shape, np.nan)), reason
    _follow_branch(bent, speeds)
    each = [_change_at(straight, bent, *at) for at in zip(speeds.tolist(), eigenvalue, strict=True)]
    reasons = dict.fromkeys(reason for _, reason in each if reason)
    return np.array([change for change, _ in each]), next(iter(reasons), "")


def _transverse(model: Model) -> np.ndarray:
    """Coordinates of the fields that deflect the beam transversely."""
    return model.equations.places(model.equations.deflections)


def comparable(scene: Scene) -> tuple[Scene, Scene]:
    """The scene without and with large deflection, both without what that cannot be combined with."""
    kept = Physics(rotary_inertia=scene.physics.rotary_inertia)
    straight = replace(scene, physics=kept)
    return straight, replace(straight, physics=replace(kept, large_deflection=True))


def _follow_branch(bent: Model, speeds: np.ndarray) -> None:
    """Have the solver find the equilibria at all speeds along one branch; it keeps them.

    Where the branch does not reach all speeds, none is kept, and each is sought by itself.
    """
    with suppress(ArithmeticError, np.linalg.LinAlgError):
        bent.solver.solve_static(speeds, np.empty((0, bent.solver.size)))


def _change_at(straight: Model, bent: Model, speed: float, eigenvalue: np.ndarray) -> tuple[np.ndarray, str]:
    """Relative changes (m,) at one speed, and why they are not known."""
    if not speed:
        return np.zeros(len(eigenvalue)), ""
    count, speeds = min(len(eigenvalue) + _EXTRA_MODES, straight.solver.size), np.array([speed])
    without = straight.solver.solve(speeds, count).eigenvalue[0]
    order = assign(np.abs(eigenvalue[:, None] - without[None, :]))
    try:
        within = bent.solver.solve(speeds, count).eigenvalue[0]
    except ArithmeticError as error:
        return np.full(len(eigenvalue), np.nan), reason_of(error)
    except np.linalg.LinAlgError:  # a hinge, on which the beam has no single equilibrium at rest
        return np.full(len(eigenvalue), np.nan), _NOT_FOUND
    with np.errstate(divide="ignore", invalid="ignore"):
        change = np.imag(within[order]) / np.imag(without[order]) - 1
    return np.where(np.imag(within[order]) > 0, change, np.nan), ""
