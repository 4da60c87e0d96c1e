"""Undo and redo: the states of a design, one after another."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from time import monotonic

from beamdyn.common.screens.form_entries import Entries

_MOST = 200  # states that are kept
_TOGETHER = 1.0  # time within which changes of the same fields are one step [s]


@dataclass
class History:
    """The states that a design has had, and which of them is shown.

    Parameters
    ----------
    first : mapping
        The entries at first.
    """

    first: Entries
    _states: list[Entries] = field(init=False)
    _place: int = field(init=False, default=0)
    _changed: frozenset[str] = field(init=False, default=frozenset())
    _when: float = field(init=False, default=-1.0)

    def __post_init__(self) -> None:
        self._states = [dict(self.first)]

    def record(self, entries: Mapping[str, str], now: float | None = None) -> None:
        """Add a state, if it differs from the one shown; states after that are forgotten.

        Changes of the same fields in quick succession, as of a field that is typed into, are one step.

        Parameters
        ----------
        entries : mapping
            The state.
        now : float, optional
            Time of the change [s]; now if not given.
        """
        changed = differing(self._states[self._place], entries)
        if not changed:
            return
        when = monotonic() if now is None else now
        if changed == self._changed and when - self._when < _TOGETHER:
            del self._states[self._place :]
            self._place -= 1
            if not differing(self._states[self._place], entries):
                return
        self._changed, self._when = changed, when
        self._states[self._place + 1 :] = [dict(entries)]
        self._states = self._states[-_MOST:]
        self._place = len(self._states) - 1

    def part(self) -> None:
        """Make the next change a step of its own, however soon it comes."""
        self._changed = frozenset()

    def go(self, steps: int) -> Entries | None:
        """Go so many steps forward, or back if negative; return that state, None if there is none."""
        if not 0 <= self._place + steps < len(self._states):
            return None
        self._place += steps
        self.part()
        return dict(self._states[self._place])

    @property
    def can_undo(self) -> bool:
        """Whether there is a state before."""
        return self._place > 0

    @property
    def can_redo(self) -> bool:
        """Whether there is a state after."""
        return self._place + 1 < len(self._states)


def differing(one: Mapping[str, str], other: Mapping[str, str]) -> frozenset[str]:
    """Paths of the entries that differ; an empty entry counts as one that is missing."""
    return frozenset(path for path in {*one, *other} if one.get(path, "") != other.get(path, ""))
