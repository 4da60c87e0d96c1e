"""Status of brakes that slide or are self-locking, and the sentence that explains it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers
from beamdyn.common.results.columns import Meaning
from beamdyn.common.results.result import Result

# Relative distance from self-locking within which a brake without an equilibrium counts as locked
_NEAR = 1e-9
LEAST_MARGIN = 5e-13  # relative margin, such as that to self-locking, that counts as zero


class SlidesOrLocks(Result):
    """Base of results of brakes that slide, or are self-locking if the friction is large enough."""

    grips: ClassVar[str] = "brake"  # name of the part that locks, for messages

    friction: Numbers
    locking_friction: Numbers
    locked: Numbers

    @property
    def status(self) -> Any:
        """Status ``"slides"`` or ``"locked"``; an array for many cases."""
        return np.where(self.locked, "locked", "slides")[()]

    @property
    def message(self) -> str:
        """One sentence stating whether the brake slides or locks, and why."""
        locked = np.asarray(self.locked)
        if not locked.any():
            past = np.asarray(self.friction) > np.asarray(self.locking_friction) * (1 + _NEAR)
            if not past.any():
                return "slides: the friction is below self-locking"
            least = float(np.min(np.broadcast_to(self.locking_friction, past.shape)[past]))
            return f"slides, but locks in a range of lower friction, from {least:.4g} on"
        where = "" if locked.all() else f" in {int(locked.sum())} of {locked.size} cases"
        mu, least = (np.broadcast_to(x, locked.shape)[locked] for x in (self.friction, self.locking_friction))
        return _say_locked(self.grips, mu, least, where)

    def messages_of_locked(self, count: int) -> dict[int, str]:
        """Return the message of each case that locks, by its index; `count` is the number of all cases."""
        given = self.friction, self.locking_friction, self.locked
        mu, least, locked = (np.broadcast_to(x, (count,)) for x in given)
        return {i: _say_locked(self.grips, mu[i], least[i]) for i in np.flatnonzero(locked).tolist()}


@dataclass(frozen=True, kw_only=True)
class RubbingResult(SlidesOrLocks):
    """Base of results of whole brakes whose linings rub; arrays have one entry per case.

    Attributes
    ----------
    friction : ndarray
        Coefficient of friction.
    torque, peak_pressure : ndarray
        Torque of the brake [N m], largest pressure on any lining [Pa]; nan where the brake locks.
    c_star, c_star_slope : ndarray
        Brake factor torque / (force * radius), and its derivative with respect to the friction.
    locking_friction, margin, locked : ndarray
        Friction at self-locking; the margin 1 - friction / locking_friction; whether the brake locks.
    """

    friction: Numbers
    torque: Annotated[Numbers, Meaning("N m", "torque of the brake")]
    peak_pressure: Annotated[Numbers, Meaning("Pa", "largest pressure on a lining", "MPa")]
    c_star: Annotated[Numbers, Meaning("", "brake factor C* = torque / (force * radius)")]
    c_star_slope: Annotated[Numbers, Meaning("", "dC*/dmu")]
    locking_friction: Annotated[Numbers, Meaning("", "friction at self-locking")]
    margin: Annotated[Numbers, Meaning("", "margin to self-locking, 1 - mu / locking mu")]
    locked: Numbers


def _say_locked(grips: str, friction: np.ndarray, locking: np.ndarray, where: str = "") -> str:
    """Compose the message of cases that lock, with the ranges of friction and of locking friction."""
    mu, least = (
        " to ".join(dict.fromkeys(f"{float(end(values)):.4g}" for end in (np.min, np.max)))
        for values in (friction, locking)
    )
    if np.all(friction < locking * (1 - _NEAR)):
        slides = f"the {grips} is not in equilibrium, and slides off its abutment"
        return f"no equilibrium{where}: at friction {mu} {slides}"
    return (
        f"locked{where}: friction {mu} is at or past self-locking, {least}; "
        f"the {grips} grips by itself, and its torque does not follow from what presses it"
    )
