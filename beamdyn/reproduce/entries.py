"""Printed values compared with those of this package, errata with their proofs, and summaries by source."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from decimal import Decimal

from beamdyn.common.words import supported


@dataclass(frozen=True)
class PrintedValue:
    """A printed value and this package's value; for misprints also a value by an independent method.

    Parameters
    ----------
    where : str
        Row of the table, such as its speed.
    mode : int
        Number of the mode, from 1.
    printed : str
        The printed value with all its digits.
    ours, error : float
        Value computed by this package, and its estimated absolute error.
    exact : str
        For a misprint, the value by a method that is independent of this package; else empty.
    bounds : tuple of float, optional
        For a misprint, guaranteed lower and upper bounds, for scenes that have such bounds.
    """

    where: str
    mode: int
    printed: str
    ours: float
    error: float
    exact: str = ""
    bounds: tuple[float, float] | None = None

    @property
    def rounding(self) -> float:
        """Half a unit of the last printed digit."""
        return half_unit(self.printed)

    @property
    def in_print(self) -> bool:
        """Whether the computed value rounds to the printed digits, regardless of its error."""
        return abs(self.ours - float(self.printed)) <= self.rounding

    @property
    def agrees(self) -> bool:
        """Whether the computed value differs from the printed one by at most rounding plus its error."""
        return abs(self.ours - float(self.printed)) <= self.rounding + self.error

    @property
    def is_erratum(self) -> bool:
        """Whether a misprint is proven: `ours` is `exact` within errors, and bounds exclude `printed`."""
        if not self.exact:
            return False
        printed, exact, slack = float(self.printed), float(self.exact), half_unit(self.exact)
        if abs(self.ours - exact) > self.error + slack or abs(printed - exact) <= self.rounding:
            return False
        low, high = self.bounds or (exact, exact)
        excluded = low > printed + self.rounding or high < printed - self.rounding
        return excluded and low - slack <= exact <= high + slack

    @property
    def off_by(self) -> float:
        """Deviation of the printed value from `exact`, or else from `ours`, in units of its last digit."""
        return (float(self.printed) - float(self.exact or self.ours)) / (2 * self.rounding)

    @property
    def as_expected(self) -> bool:
        """Whether the printed and the computed value agree, or a claimed misprint is proven."""
        return self.is_erratum if self.exact else self.agrees

    @property
    def relative_deviation(self) -> float:
        """Magnitude of the deviation of `ours` from the printed value, relative to the printed value."""
        return abs(self.ours / float(self.printed) - 1)

    def cells(self) -> list[str]:
        """List the cells of the value's row in the table of errata, without the source."""
        low, high = self.bounds or (0.0, 0.0)
        enclosed = f"{(high - low) / float(self.exact):.0e}" if self.bounds else "no theorem"
        off = f"{self.off_by:+.2g}" if abs(self.off_by) < 100 else f"{self.off_by:+.0f}"
        numbers = (self.printed, supported(self.ours, self.error), self.exact, enclosed)
        return [self.where, str(self.mode), *numbers, off]


def half_unit(text: str) -> float:
    """Compute half a unit of the last digit of a printed number."""
    exponent = Decimal(text).as_tuple().exponent
    assert isinstance(exponent, int), f"{text} is a finite number"
    return 0.5 * 10.0**exponent


def compare_modes(
    where: str, printed: Iterable[object], ours: Iterable[float], errors: Iterable[float]
) -> list[PrintedValue]:
    """Compare the printed values of a row, one for each mode, with computed ones of given relative errors."""
    rows = enumerate(zip(map(str, printed), map(float, ours), map(float, errors), strict=False), 1)
    return [PrintedValue(where, mode, text, value, error * abs(value)) for mode, (text, value, error) in rows]


@dataclass(frozen=True)
class Summary:
    """Summary of the comparison of all values of one source with one discretization.

    Parameters
    ----------
    source, discretization : str
        Source of the printed values, and discretization of the computed ones.
    values : int
        Number of values.
    printed : float
        Largest relative rounding of the printed values: half a unit of the last digit.
    deviation, error : float
        Largest relative deviation, without errata, and largest estimated relative error of computed values.
    outside : int
        Number of values that deviate by more than rounding and error together, and are no proven errata.
    errata, last_digits : int
        Number of values that are proven to be wrong in print, and number of these that are wrong in the last
        digit only, by less than one unit.
    in_print : bool
        Whether all other values agree in all printed digits, regardless of errors.
    """

    source: str
    discretization: str
    values: int
    printed: float
    deviation: float
    error: float
    outside: int
    errata: int = 0
    last_digits: int = 0
    in_print: bool = False

    @property
    def as_expected(self) -> bool:
        """Whether all printed values agree with the computed ones, or are proven misprints."""
        return not self.outside

    @property
    def verdict(self) -> str:
        """Verdict for the table: whether all values agree, or how many do not."""
        if self.outside:
            return f"differs: {self.outside} value(s)"
        if not self.errata:
            return "agrees in all printed digits" if self.in_print else "agrees within error"
        more, last = self.errata - self.last_digits, self.last_digits
        parts = f"{more} {'erratum' if more == 1 else 'errata'}", f"{last} last digit{'s' * (last != 1)}"
        return "agrees but " + ", ".join(part for part in parts if not part.startswith("0 "))

    def cells(self) -> list[str]:
        """List the cells of the row in the table of summaries."""
        numbers = (f"{x:.1e}" for x in (self.printed, self.deviation, self.error))
        return [self.source, self.discretization, str(self.values), *numbers, self.verdict]


def summarize_entries(source: str, discretization: str, entries: Sequence[PrintedValue]) -> Summary:
    """Summarize the comparison of all values of a source."""
    right = [entry for entry in entries if not entry.is_erratum]
    return Summary(
        source,
        discretization,
        values=len(entries),
        printed=max(entry.rounding / float(entry.printed) for entry in entries),
        deviation=max((entry.relative_deviation for entry in right), default=0.0),
        error=max(entry.error / abs(entry.ours) for entry in entries),
        outside=sum(not entry.as_expected for entry in entries),
        errata=len(entries) - len(right),
        last_digits=sum(entry.is_erratum and abs(entry.off_by) < 1 for entry in entries),
        in_print=all(entry.in_print for entry in right),
    )
