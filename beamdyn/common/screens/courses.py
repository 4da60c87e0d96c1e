"""Position of a slider over the time for which it has been played."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol


class Course(Protocol):
    """Position of a slider over the time for which it has been played."""

    @property
    def seconds(self) -> float:
        """Time from one end to the other [s]."""
        ...

    def place(self, elapsed: float) -> float:
        """Position after a time [s]."""
        ...

    def elapsed(self, place: float) -> float:
        """A time at which it is at a position [s]."""
        ...


@dataclass(frozen=True)
class BackAndForth:
    """From 0 to the last position and back again, slowly at both ends; each way takes `seconds`."""

    last: float
    seconds: float = 2.5

    def place(self, elapsed: float) -> float:
        """The place after a time [s]."""
        return self.last * (1 - math.cos(math.pi * elapsed / self.seconds)) / 2

    def elapsed(self, place: float) -> float:
        """Time at which it is at a position on its way there [s]."""
        if place >= self.last:
            return self.seconds
        return self.seconds / math.pi * math.acos(1 - 2 * max(place, 0.0) / self.last)


@dataclass(frozen=True)
class Onward:
    """From 0 to the last position at a constant rate, then from 0 again; each time takes `seconds`."""

    last: float
    seconds: float = 10.0

    def place(self, elapsed: float) -> float:
        """The place after a time [s]."""
        return self.last * (elapsed / self.seconds % 1.0)

    def elapsed(self, place: float) -> float:
        """Time at which it is at a position [s]."""
        return self.seconds * place / self.last
