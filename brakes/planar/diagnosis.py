"""Sentences that say what is loose, undetermined or out of reach."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from brakes.planar.linear import rank_tolerance
from brakes.planar.system import System

_STILL = 1e-8  # relative motion that counts as rounding


class AssemblyError(ValueError):
    """The joints of a mechanism cannot be brought together.

    Examples
    --------
    >>> issubclass(planar.AssemblyError, ValueError)
    True
    """


class OppositeTravelError(ValueError):
    """A travel that should grow with the driver falls."""


class OutOfReachError(ValueError):
    """A driver does not reach a value: it turns back before it.

    Parameters
    ----------
    reason : str
        What is not reached, and where it ends.
    remedy : str
        What to do.

    Examples
    --------
    >>> issubclass(planar.OutOfReachError, ValueError)
    True
    """

    def __init__(self, reason: str, remedy: str) -> None:
        super().__init__(reason, remedy)
        self.reason, self.remedy = reason, remedy

    def __str__(self) -> str:
        return f"{self.reason}; {self.remedy}"


def moving_bodies(motions: np.ndarray) -> np.ndarray:
    """Which bodies move in motions of shape (3 n, k): shape (n,)."""
    size = np.linalg.norm(motions.reshape(len(motions) // 3, 3, motions.shape[1]), axis=(1, 2))
    return size > _STILL * max(size.max(initial=0.0), 1e-300)


def names_of_moving(system: System, motions: np.ndarray) -> tuple[str, ...]:
    """Names of the bodies that move in motions of shape (3 n, k)."""
    return tuple(name for name, moves in zip(system.bodies, moving_bodies(motions), strict=False) if moves)


def describe(system: System, y: np.ndarray, motions: np.ndarray) -> str:
    """Describe motions (3 n, k) in words; bodies without relative motion are named together."""
    twists = _twists(system, y, motions)
    groups: list[tuple[list[str], np.ndarray]] = []
    for name, twist, moves in zip(system.bodies, twists, moving_bodies(motions), strict=False):
        if moves:
            _join(groups, name, twist)
    return ", ".join(f"{join_names(names)} {_motion(system, names, twist)}" for names, twist in groups)


def explain_mobility(system: System, y: np.ndarray, free: np.ndarray) -> str:
    """Explain why a mechanism with free motions (3 n, k), k other than 1, has no stroke."""
    k = free.shape[1]
    if not k:
        return "the mechanism does not move: mobility 0; a stroke needs 1: remove a joint"
    return (
        f"the mechanism has mobility {k}; a stroke needs 1: {describe(system, y, free)}; "
        f"add {k - 1} joint{'s' if k > 2 else ''} (a rotation lock, a bar, a contact)"
    )


def describe_loose(system: System, y: np.ndarray, motions: np.ndarray) -> str:
    """Describe what is loose, and the remedy."""
    return f"{describe(system, y, motions)}; add a joint, or give a load that moves it an unknown amplitude"


def describe_near_toggle(system: System, y: np.ndarray, motions: np.ndarray, margin: float) -> str:
    """Say that rounding decides what holds a mechanism, by which margin, and the remedy."""
    return (
        "too near a toggle position to decide whether the loads are in balance: "
        f"{describe(system, y, motions)} there, which only forces beyond all bounds could stop "
        f"(smallest singular value {margin:.1g}, at least {rank_tolerance(system.rounding):.1g} is needed); "
        "draw it further from that position, or give a load that moves it an unknown amplitude"
    )


def check_moves(system: System, driver: str, rates: np.ndarray) -> None:
    """Refuse a driver whose velocity, per unit of the mechanism's motion, cannot be told from zero."""
    margin, least = np.abs(rates).min(), rank_tolerance(system.rounding)
    if margin < least:
        raise ValueError(
            f"driver {driver!r} stands still while the mechanism moves, or is too near a toggle position to "
            f"decide (velocity {margin:.1g} of the mechanism's, at least {least:.1g} is needed): "
            "choose another driver, or draw the mechanism further from that position"
        )


def describe_self_stress(names: tuple[str, ...]) -> str:
    """Say what equilibrium does not determine, and the remedy."""
    return (
        f"statically indeterminate: equilibrium alone does not give {join_names(names)}; "
        "remove a joint among them, or give a load of unknown amplitude its magnitude"
    )


def join_names(names: Iterable[str]) -> str:
    """Names as a list in a sentence."""
    *most, last = names
    return f"{', '.join(most)} and {last}" if most else last


def _twists(system: System, y: np.ndarray, motions: np.ndarray) -> np.ndarray:
    """Twist of each body: velocity (complex) of its point at the origin, and angular velocity, (n, 2, k)."""
    parts = motions.reshape(len(motions) // 3, 3, motions.shape[1])
    pose = y.reshape(-1, 3)
    centre = system.centre[:-1] + pose[:, 0] + 1j * pose[:, 1]
    rate = parts[:, 2] / system.radius[:-1, None]
    return np.stack((parts[:, 0] + 1j * parts[:, 1] - 1j * rate * centre[:, None], rate), axis=1)


def _join(groups: list[tuple[list[str], np.ndarray]], name: str, twist: np.ndarray) -> None:
    """Add a body to the group that has its twist, or to a new one."""
    for names, other in groups:
        if np.abs(twist - other).max() < 1e-7 * np.abs(other).max():
            names.append(name)
            return
    groups.append(([name], twist))


def _motion(system: System, names: list[str], twist: np.ndarray) -> str:
    """Describe the motions (2, k) of a group; a single one has a centre or a direction."""
    real = np.stack((twist[0].real, twist[0].imag, twist[1].real))
    left, size, _ = np.linalg.svd(real, full_matrices=False)
    ways = int((size > 1e-7 * size[0]).sum())
    one, together = len(names) == 1, "" if len(names) == 1 else " together"
    if ways > 1:
        return f"{'moves' if one else 'move'}{together} in {ways} independent ways"
    vx, vy, rate = left[:, 0]
    if abs(rate) < 1e-7:
        vx, vy = np.array((vx, vy)) * np.sign(vx if abs(vx) > 1e-9 else vy)
        x, y = (round(float(v), 9) + 0.0 for v in (vx, vy))
        return f"{'slides' if one else 'slide'}{together} along ({x:.3g}, {y:.3g})"
    centre = system.origin + system.length * (1j * (vx + 1j * vy) / rate)
    x, y = (0.0 if abs(v) < 1e-9 * system.length else v for v in (centre.real, centre.imag))
    return f"{'turns' if one else 'turn'}{together} about ({x:.6g}, {y:.6g}) m"
