"""How the place of a slider follows from the time that it has been played."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol


class Course(Protocol):
    """How the place of a slider follows from the time that it has been played [s]."""

    @property
    def seconds(self) -> float:
        """How long it takes from one end to the other [s]."""
        ...

    def place(self, elapsed: float) -> float:
        """The place after a time [s]."""
        ...

    def elapsed(self, place: float) -> float:
        """A time at which it is at a place [s]."""
        ...


@dataclass(frozen=True)
class BackAndForth:
    """From 0 to the last place and back again, slowly at both ends; each way takes so many seconds."""

    last: float
    seconds: float = 2.5

    def place(self, elapsed: float) -> float:
        """The place after a time [s]."""
        return self.last * (1 - math.cos(math.pi * elapsed / self.seconds)) / 2

    def elapsed(self, place: float) -> float:
        """When it is at a place on its way there [s]."""
        if place >= self.last:
            return self.seconds
        return self.seconds / math.pi * math.acos(1 - 2 * max(place, 0.0) / self.last)


@dataclass(frozen=True)
class Onward:
    """From 0 to the last place at one pace, then from 0 again; each time it takes so many seconds."""

    last: float
    seconds: float = 10.0

    def place(self, elapsed: float) -> float:
        """The place after a time [s]."""
        return self.last * (elapsed / self.seconds % 1.0)

    def elapsed(self, place: float) -> float:
        """When it is at a place [s]."""
        return self.seconds * place / self.last
