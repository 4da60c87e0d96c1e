"""What slides, or locks by itself: its status, and the sentence on what locks."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers
from beamdyn.common.results.result import Result

_NEAR = 1e-9  # relative distance from self-locking within which a brake without an equilibrium locks
LEAST_MARGIN = 5e-13  # relative margin, such as that to self-locking, that cannot be told from none


class SlidesOrLocks(Result):
    """Base of results of brakes that slide, or lock by themselves if the friction is large enough."""

    grips: ClassVar[str] = "brake"  # what it is that locks

    friction: Numbers
    locking_friction: Numbers
    locked: Numbers

    @property
    def status(self) -> Any:
        """``"slides"`` or ``"locked"``; an array of these for many cases."""
        return np.where(self.locked, "locked", "slides")[()]

    @property
    def message(self) -> str:
        """Meaning of the status, in one sentence."""
        locked = np.asarray(self.locked)
        if not locked.any():
            return "slides: the friction is below self-locking"
        where = "" if locked.all() else f" in {int(locked.sum())} of {locked.size} cases"
        mu, least = (np.broadcast_to(x, locked.shape)[locked] for x in (self.friction, self.locking_friction))
        return _say_locked(self.grips, mu, least, where)

    def messages_of_locked(self, count: int) -> dict[int, str]:
        """The message of each case that locks, of as many cases, by its row."""
        given = self.friction, self.locking_friction, self.locked
        mu, least, locked = (np.broadcast_to(x, (count,)) for x in given)
        return {i: _say_locked(self.grips, mu[i], least[i]) for i in np.flatnonzero(locked).tolist()}


def _say_locked(grips: str, friction: np.ndarray, locking: np.ndarray, where: str = "") -> str:
    """Say that it locks, with the ranges of their friction and of that at which they do."""
    mu, least = (
        " to ".join(dict.fromkeys(f"{float(end(values)):.4g}" for end in (np.min, np.max)))
        for values in (friction, locking)
    )
    if np.all(friction < locking * (1 - _NEAR)):
        slides = f"nothing holds the {grips}, which slides off its abutment"
        return f"no equilibrium{where}: at friction {mu} {slides}"
    return (
        f"locked{where}: friction {mu} is at or past self-locking, {least}; "
        f"the {grips} grips by itself, and its torque does not follow from what presses it"
    )
