"""Proofs that no design within the bounds meets the targets, or comes nearer to them than the best one.

Two arguments hold for all designs, computed or not, within the stated errors of the computed ones. (1) If a
number increases a result (`beamdyn.studies.designing.quotients`), all smaller values are excluded if the
result is too low, and all larger ones if it is too high.  (2) The results of similar designs
(`beamdyn.studies.similar`) all differ by one factor, which is known without solving.

In shapes of arrays, p counts unknowns (numbers to be found).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from beamdyn.common.inputs.described import Designs
from beamdyn.common.results.statements import joined
from beamdyn.common.words import Words
from beamdyn.scene.numbers import with_numbers
from beamdyn.scene.physics import Physics
from beamdyn.studies.designing.quotients import QUOTIENTS, is_bare, is_clamped, ways
from beamdyn.studies.designing.search import Search
from beamdyn.studies.designing.target import Target, say_number
from beamdyn.studies.similar import POWERS, SimilarDesigns, differ_in_numbers_only

_SURE = 2.0  # smallest ratio of miss to error of a result, for a proof to be based on the miss
_EXACT = 1e-10  # relative tolerance within which bounds and targets count as met
_AT = 1e-13  # distance from a bound, as a fraction of the range, below which a design is at the bound
_VERBS = {1: "raises", -1: "lowers", 0: "does not change"}


class _RuledOut(NamedTuple):
    """Box of designs between two corners, in all of which the result of a target is too low, or too high."""

    low: np.ndarray
    high: np.ndarray
    target: int
    is_too_low: bool


class _Limits(NamedTuple):
    """Range of the factor by which results of a design differ from those of the design that was found.

    `least` and `most` are the logarithms of its smallest and largest value; `says` names what limits it: the
    bounds, or a target.
    """

    says: str
    least: float
    most: float


@dataclass(frozen=True)
class Proofs:
    """Proofs about all designs within the bounds, based on the designs that a search has computed.

    Parameters
    ----------
    search : Search
        The search.
    x : ndarray, shape (p,)
        Design that was found, as fractions of the ranges.
    """

    search: Search
    x: np.ndarray

    @cached_property
    def no_nearer(self) -> str:
        """Reason why no design comes nearer to any target that the design misses; empty if not proven."""
        excess, met = self.search.excess(self.x[None])[0], self.search.met(self.x[None])[0]
        value, error = (each[0] for each in self.search.known(self.x[None]))
        missed = np.flatnonzero(~met).tolist()
        for k in missed:
            is_known = not np.isnan(value[k]) and np.isfinite(error[k])
            if not is_known or (helps := self._helps(k, excess[k])) is None:
                return ""
            if not np.where(helps > 0, self.x >= 1 - _AT, (self.x <= _AT) | (helps == 0)).all():
                return ""
        return joined("; ", dict.fromkeys(map(self._argument, missed))) if missed else ""

    @cached_property
    def none(self) -> str:
        """Reason why no design meets all targets; empty if not proven."""
        if self.search.met(self.x[None]).all():
            return ""
        parts = [*self._ruled_out()]
        return next(
            (said for j in range(len(self.x)) for said in self._covered(parts, j)), self._one_factor()
        )

    # By numbers that increase or decrease a result --------------------------------------------------

    @property
    def _names(self) -> list[str]:
        return [each.name for each in self.search.ranges.inputs]

    @cached_property
    def _ways(self) -> list[np.ndarray | None]:
        """How the result of each target changes with each number: it rises (1), falls (-1), or does not (0).

        For each target an array (p,); None if it is not known.
        """
        search = self.search
        corners = [with_numbers(search.scene, each) for each in Designs(search.ranges.inputs).extremes()]
        known = {what: [ways(corner, what) for corner in corners] for what in QUOTIENTS}
        return [_common(known[t.what], self._names) if _is_quotient(t) else None for t in search.targets]

    def _is_too_low(self, k: int, excess: float) -> bool:
        """Return whether a result that misses target k is too low (otherwise it is too high)."""
        return bool(excess < 0) == (self.search.targets[k].at_most is None)

    def _helps(self, k: int, excess: float) -> np.ndarray | None:
        """Return the sign (p,) of the change of each number that brings the result nearer to target k.

        None if it is not known.
        """
        ways = self._ways[k]
        return ways if ways is None or self._is_too_low(k, excess) else -ways

    def _argument(self, k: int) -> str:
        """State how the numbers change the result of target k."""
        ways, what = self._ways[k], self.search.targets[k].what
        assert ways is not None
        told = (f"{name} {_VERBS[way]}" for name, way in zip(self._names, ways.tolist(), strict=True))
        return f"{' and '.join(told)} {QUOTIENTS[what]}"

    def _ruled_out(self) -> Iterator[_RuledOut]:
        """Yield boxes of designs of which none is nearer to a target than the computed design in one corner.

        That computed design misses the target by more than twice the error of its result.
        """
        designs = self.search.designs
        (value, error), missed = self.search.known(designs), self.search.missed(designs)
        sure, excess = np.isfinite(value) & (missed > _SURE * error), self.search.excess(designs)
        for i, k in np.argwhere(sure).tolist():
            if (helps := self._helps(k, excess[i, k])) is not None:
                low, high = np.where(helps < 0, designs[i], 0.0), np.where(helps > 0, designs[i], 1.0)
                yield _RuledOut(low, high, k, self._is_too_low(k, excess[i, k]))

    def _covered(self, parts: Sequence[_RuledOut], j: int) -> Iterator[str]:
        """Yield reasons why no design meets all targets: one box, or two touching boxes, contain all designs.

        Two boxes touch at a value of number j.
        """
        others = np.arange(len(self.x)) != j
        wide = [each for each in parts if not ((each.low > _AT) | (each.high < 1 - _AT))[others].any()]
        below = max(
            (each for each in wide if each.low[j] <= _AT), key=lambda each: each.high[j], default=None
        )
        above = min(
            (each for each in wide if each.high[j] >= 1 - _AT), key=lambda each: each.low[j], default=None
        )
        if below and below.high[j] >= 1 - _AT:
            yield self._says(below, " for all designs")
        elif below and above and below.high[j] >= above.low[j]:
            ends = self._at(j, below.high), self._at(j, above.low)
            says = (self._says(*each) for each in ((below, " up to ", ends[0]), (above, " from ", ends[1])))
            yield joined("; ", says)

    def _at(self, j: int, shares: np.ndarray) -> Words:
        """Format the value of number j of a design given as fractions of the ranges."""
        value = float(self.search.ranges.values(shares)[j])
        return Words(f"{self._names[j]} = ", say_number(value, self.search.ranges.inputs[j].unit))

    def _says(self, part: _RuledOut, *where: str) -> Words:
        name, word = self.search.targets[part.target].name, "low" if part.is_too_low else "high"
        return Words(self._argument(part.target), ", so that the ", name, f" is too {word}", *where)

    # By similarity ----------------------------------------------------------------------------------

    def _one_factor(self) -> str:
        """State why no factor common to the design's results meets all targets; empty if one may."""
        # There is such a factor if only the length varies, and factors of the sections' properties.
        scene, names = self.search.scene, {*self._names}
        alone = names <= POWERS.keys() and is_bare(scene.beam) and is_clamped(scene)
        if not (alone and scene.physics == Physics() and differ_in_numbers_only(scene, names)):
            return ""
        limits = [self._in_the_bounds(), *self._by_targets()]
        least, most = max(limits, key=lambda each: each.least), min(limits, key=lambda each: each.most)
        if least.least <= most.most:
            return ""
        said = "all designs are similar: their results differ by one common factor, and "
        apart = f" is {100 * np.expm1(least.least - most.most):.3g} % above the largest by "
        return Words(f"{said}the least factor by ", least.says, apart, most.says)

    def _in_the_bounds(self) -> _Limits:
        """Return the range of the factor from the results of `x` to those of any design in the bounds."""
        ranges = self.search.ranges
        corners = [*Designs(ranges.inputs).extremes()]
        columns = {name: np.array([each[name] for each in corners]) for name in self._names}
        own = dict(zip(self._names, ranges.values(self.x).tolist(), strict=True))
        factors = -np.log(SimilarDesigns(self.search.scene, own, columns).time)
        return _Limits("the bounds", float(factors.min()) - _EXACT, float(factors.max()) + _EXACT)

    def _by_targets(self) -> Iterator[_Limits]:
        """Yield the range of factors with which the results meet each target, within the results' errors."""
        value, error = (each[0] for each in self.search.known(self.x[None]))
        for target, own, of_own in zip(self.search.targets, value.tolist(), error.tolist(), strict=True):
            # Frequencies at rest of similar designs differ only by the factor.  Critical speeds do so only if
            # the length is fixed, as they depend on the ratio of radius to length.
            scales = target.what == "frequencies" or "beam.length" not in self._names
            if _is_quotient(target) and scales and 0 < own < np.inf and np.isfinite(of_own):
                at_least, at_most = target.equals or target.at_least or 0.0, target.equals or target.at_most
                margin = _SURE * of_own + _EXACT
                least = np.log(at_least / own) - margin if at_least else -np.inf
                yield _Limits(target.says, least, np.log(at_most / own) + margin if at_most else np.inf)


def _is_quotient(target: Target) -> bool:
    """Return whether a target is a value or a limit of a result that is an extremum or mean of quotients."""
    return target.what in QUOTIENTS and not target.speed and target.best is None


def _common(known: Sequence[dict[str, int]], names: Sequence[str]) -> np.ndarray | None:
    """Return the sign with which each number changes a result, common to several scenes.

    `known` has the signs of each scene by name.  A number without effect in some scenes has the sign of the
    other scenes.  None is returned if signs are opposite, or if one is not known.
    """
    if not all(name in each for each in known for name in names):
        return None
    found = np.array([[each[name] for name in names] for each in known])
    opposite = (found.min(axis=0) < 0) & (found.max(axis=0) > 0)
    return None if opposite.any() else np.sign(found.sum(axis=0))
