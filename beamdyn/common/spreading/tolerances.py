"""Distributions of inputs, and the tolerances from which they are made: "+-2%", "+1% -2%", "sd 1%"."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, kind, positive, real, set_fields

_N = r"((?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)"
_BOTH = re.compile(rf"(?:\+-|\+/-|±)\s*{_N}\s*(.*)")
_SIDES = re.compile(rf"([-+])\s*{_N}\s*(.*?)[,\s]*([-+])\s*{_N}\s*(.*)")
_SIDE = re.compile(rf"([-+])\s*{_N}\s*([^-+]*)")
_RANGE = re.compile(rf"([-+]?){_N}\s*(.*?)\s+to\s+([-+]?){_N}\s*(.*)")
_DEVIATION = re.compile(rf"sd\s*{_N}\s*(.*)")
_FORMS = 'give "+-2%", "+1% -2%", "0.9 to 1.1" with a unit, or "sd 1%"'

_PREFIXES = {"G": 1e9, "M": 1e6, "k": 1e3, "c": 1e-2, "m": 1e-3, "u": 1e-6}  # factors of unit prefixes

# A function that converts a number and a unit, as written, to SI; it raises `InvalidValue` for a wrong unit.
Convert: TypeAlias = "Callable[[str, str], float]"


@dataclass(frozen=True)
class Uniform:
    """A uniform distribution: all values between two ends are equally likely.

    Parameters
    ----------
    low, high : float
        Smallest and largest value [SI unit of the input].
    text : str
        The tolerance as the user wrote it, for tables.

    Examples
    --------
    >>> radius = bd.Uniform(low=0.213, high=0.217)
    >>> round(radius.mean, 6)
    0.215
    """

    low: float
    high: float
    text: str = field(default="", compare=False)

    def __post_init__(self) -> None:
        set_fields(self, low=real("low", self.low), high=real("high", self.high))
        kind("text", self.text, str)
        if not self.low < self.high:
            raise InvalidValue("high", self.high, "it must be above low = {limit}", limit=self.low)

    @property
    def ends(self) -> tuple[float, float]:
        """Return the smallest and the largest value in a worst case."""
        return self.low, self.high

    reach = ends  # smallest and largest value of a sample

    @property
    def mean(self) -> float:
        """Return the mean value."""
        return (self.low + self.high) / 2

    @property
    def deviation(self) -> float:
        """Return the standard deviation."""
        return (self.high - self.low) / math.sqrt(12)

    def at(self, share: np.ndarray) -> np.ndarray:
        """Return the quantiles at given fractions: the values below which these fractions lie."""
        return self.low + (self.high - self.low) * share


@dataclass(frozen=True)
class Normal:
    """A normal distribution; values beyond five standard deviations are not used.

    Only 6 in ten million values are beyond five standard deviations.  Worst cases use the range of three
    standard deviations on either side.

    Parameters
    ----------
    mean, deviation : float
        Mean value and standard deviation [SI unit of the input].
    text : str
        The tolerance as the user wrote it, for tables.

    Examples
    --------
    >>> thickness = bd.Normal(mean=0.2e-3, deviation=2e-6)
    >>> thickness.mean
    0.0002
    """

    mean: float
    deviation: float
    text: str = field(default="", compare=False)

    _ENDS = 3.0
    _REACH = 5.0

    def __post_init__(self) -> None:
        set_fields(self, mean=real("mean", self.mean), deviation=positive("deviation", self.deviation))
        kind("text", self.text, str)

    @property
    def ends(self) -> tuple[float, float]:
        """Return the smallest and the largest value in a worst case: three standard deviations either way."""
        return self._about(self._ENDS)

    @property
    def reach(self) -> tuple[float, float]:
        """Return the smallest and the largest value of a sample: five standard deviations either way."""
        return self._about(self._REACH)

    def _about(self, times: float) -> tuple[float, float]:
        return self.mean - times * self.deviation, self.mean + times * self.deviation

    def at(self, share: np.ndarray) -> np.ndarray:
        """Return the quantiles at given fractions: the values below which these fractions lie."""
        from scipy.special import ndtr, ndtri

        beyond = ndtr(-self._REACH)
        return self.mean + self.deviation * ndtri(beyond + (1 - 2 * beyond) * share)


Distribution: TypeAlias = "Uniform | Normal"


@dataclass(frozen=True)
class SpreadInput:
    """An input and its tolerance.

    Parameters
    ----------
    name : str
        Path of the input in files, such as "beam.thickness".
    unit : str
        SI unit of the input.
    nominal : float
        Nominal value of the input [unit].
    distribution : Uniform or Normal
        Probability distribution of the input [unit].

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> given = bd.spread(bd.Scene(strip), {"beam.thickness": "+-2%"}, modes=1, samples=128).inputs[0]
    >>> given.name, given.nominal
    ('beam.thickness', 0.0002)
    """

    name: str
    unit: str
    nominal: float
    distribution: Distribution

    @property
    def text(self) -> str:
        """Return the tolerance as the user wrote it."""
        return self.distribution.text or _as_text(self.distribution, self.unit)


def parse_tolerance(name: str, text: str, nominal: float, unit: str, convert: Convert) -> Distribution:
    """Make the distribution of an input from the text of its tolerance.

    Parameters
    ----------
    name : str
        Name of the input.
    nominal : float
        Nominal value of the input [unit].
    unit : str
        SI unit of the input.
    text : str
        The tolerance: "+-2%" of the nominal value, "+-0.01 mm", "+1% -2%", "+1%" or "0.19 mm to 0.21 mm" for
        a uniform distribution; "sd 1%" for a normal distribution with this standard deviation.
    convert : callable
        Function that converts a number and a unit, as written, to SI.

    Raises
    ------
    InvalidValue
        If the text has none of these forms, a percentage refers to a nominal value of 0, or the nominal value
        is outside the tolerance.
    """
    given = " ".join(text.split())

    def size(number: str, written: str) -> float:
        return _relative(name, text, number, nominal, unit) if written == "%" else convert(number, written)

    if found := _DEVIATION.fullmatch(given):
        return Normal(nominal, _wide(name, text, size(found[1], found[2])), given)
    if found := _BOTH.fullmatch(given):
        width = size(found[1], found[2])
        low, high = nominal - width, nominal + width
    elif found := _RANGE.fullmatch(given):
        low, high = _ends(name, text, nominal, unit, found, convert)
    elif found := _SIDE.fullmatch(given):
        end = nominal + float(f"{found[1]}1") * size(found[2], found[3])
        low, high = min(end, nominal), max(end, nominal)
    elif found := _SIDES.fullmatch(given):
        low, high = _sided(name, text, nominal, found, size)
    else:
        raise InvalidValue(name, text, "it is no tolerance", _FORMS)
    _wide(name, text, high - low)
    return Uniform(low, high, given)


def _relative(name: str, text: str, number: str, nominal: float, unit: str) -> float:
    if not nominal:
        remedy = f"give it in {unit}" if unit else "give a plain number, such as +-0.1"
        raise InvalidValue(name, text, "the value is 0, and so is every percentage of it", remedy)
    return float(number) / 100 * abs(nominal)


def _wide(name: str, text: str, width: float) -> float:
    if not width > 0:
        raise InvalidValue(name, text, "it is no range: both ends are the same", "leave the input out")
    return width


def _sided(
    name: str, text: str, nominal: float, found: re.Match[str], size: Callable[[str, str], float]
) -> tuple[float, float]:
    """Return both ends for a text such as "+1% -2%"; a missing unit is that of the other end."""
    first, one, unit, second, other, last = found.groups()
    if first == second:
        raise InvalidValue(name, text, f"both sides have the sign {first}", 'give one of each: "+1% -2%"')
    sides = {first: size(one, unit or last), second: size(other, last or unit)}
    return nominal - sides["-"], nominal + sides["+"]


def _ends(
    name: str, text: str, nominal: float, unit: str, found: re.Match[str], convert: Convert
) -> tuple[float, float]:
    """Return both ends for a text such as "0.19 mm to 0.21 mm"; a missing unit is that of the other end."""
    sign, one, first, last_sign, other, last = found.groups()
    if "%" in (first, last):
        raise InvalidValue(name, text, "the ends must be values, not %", 'give percentages as "+1% -2%"')
    low, high = (
        (-1.0 if minus == "-" else 1.0) * convert(number, written)
        for minus, number, written in ((sign, one, first or last), (last_sign, other, last or first))
    )
    if low >= high:
        raise InvalidValue(name, text, "it must ascend", "give the smaller end first")
    rounding = 1e-12 * (abs(low) + abs(high))
    if not low - rounding <= nominal <= high + rounding:
        bound = "the range does not contain the nominal value, {limit}"
        raise InvalidValue(name, text, bound, "widen it, or change the value", unit, nominal)
    return low, high


def check_holds(given: SpreadInput) -> None:
    """Raise an error if the nominal value is outside the tolerance."""
    low, high = given.distribution.ends
    if not low <= given.nominal <= high:
        bound = "the tolerance does not contain the nominal value, {limit}"
        remedy = "widen it, or change the value"
        raise InvalidValue(given.name, given.distribution, bound, remedy, given.unit, given.nominal)


def _as_text(given: Distribution, unit: str) -> str:
    if isinstance(given, Normal):
        return f"mean {given.mean:.6g} {unit}, sd {given.deviation:.4g} {unit}".replace(" ,", ",").strip()
    return f"{given.low:.6g} to {given.high:.6g} {unit}".strip()


def without_unit(text: str, written: str, unit: str) -> str:
    """Return advice for a tolerance `text` whose numbers must not have a unit, but have the unit `written`.

    If `written` is `unit` with a prefix, the advice is the text with its numbers converted to `unit`.
    """
    factor = _PREFIXES.get(written.removesuffix(unit)) if unit and written.endswith(unit) else None
    if factor is None:
        return f"give numbers without a unit{f', in {unit}' if unit else ''}"
    pattern = rf"((?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)(?:\s*{re.escape(written)}(?!\w)|(?![\d.]|\s*%))"
    return f'give "{re.sub(pattern, lambda found: f"{float(found[1]) * factor:g}", text)}"'
