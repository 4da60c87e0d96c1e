"""Comparison of published values with computed ones: deviation, bound and verdict."""

from __future__ import annotations

from dataclasses import dataclass

from beamdyn.common.words import supported


class Verdict:
    """Base of verdicts on whether a published number and the computed one agree within expected errors."""

    reason: str

    @property
    def agrees(self) -> bool:
        """Return whether the two numbers agree."""
        raise NotImplementedError

    @property
    def as_expected(self) -> bool:
        """Return whether the two numbers agree, or differ for a known reason."""
        return self.agrees != bool(self.reason)

    @property
    def verdict(self) -> str:
        """Return the verdict for tables: "agrees", or "differs" with the reason."""
        if self.agrees:
            return "agrees" if not self.reason else "agrees, which is unexpected"
        return f"differs: {self.reason or 'unexpected'}"


@dataclass(frozen=True)
class Comparison(Verdict):
    """A published value, the computed value, and their errors.

    Parameters
    ----------
    what : str
        Name of the value.
    source : str
        Publication from which the value is taken.
    published : float or pair of floats
        The published value, or both ends of a published interval.
    ours : float
        The computed value.
    error : float
        Estimated absolute error of the computed value.
    decimals : int
        Number of decimals printed in the publication.
    reason : str
        Known reason for a difference; empty if the values should agree.
    """

    what: str
    source: str
    published: float | tuple[float, float]
    ours: float
    error: float
    decimals: int
    reason: str = ""

    @property
    def deviation(self) -> float:
        """Return computed minus published value; for an interval, minus its nearest point."""
        ends = self.published if isinstance(self.published, tuple) else (self.published,) * 2
        return self.ours - min(max(self.ours, ends[0]), ends[1])

    @property
    def bound(self) -> float:
        """Return the largest allowed deviation: rounding of the published value plus computing error."""
        rounding = 0.0 if isinstance(self.published, tuple) else 0.5 * 10.0**-self.decimals
        return rounding + self.error

    @property
    def agrees(self) -> bool:
        """Return whether the deviation is within the bound."""
        return abs(self.deviation) <= self.bound

    def cells(self) -> list[str]:
        """Return the cells of the comparison's row in a table."""
        ends = self.published if isinstance(self.published, tuple) else (self.published,)
        deviation = supported(self.deviation, self.error, 2)
        if len(ends) > 1 and self.deviation == 0:
            deviation = "inside"
        elif self.deviation > 0 and "±" not in deviation:
            deviation = f"+{deviation}"
        return [
            self.what,
            self.source,
            " to ".join(f"{end:.{self.decimals}f}" for end in ends),
            supported(self.ours, self.error, 12) if self.error else f"{self.ours:.{self.decimals}f}",
            deviation,
            self.verdict,
        ]
