"""Targets of an inverse design: a required value of a result, a limit, or the best."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from beamdyn.common.inputs import checks
from beamdyn.common.results.statements import Speeds
from beamdyn.common.words import Words
from beamdyn.scene.validity import check_speeds
from beamdyn.studies.beside_data.single_numbers import say_value
from beamdyn.studies.questions import KINDS, OPTIONS, Kind
from beamdyn.studies.study import check_window

_FAR = 5.0  # magnitude of the logarithm of result over required value, above which it is compressed
_NONE = 100.0  # logarithm that represents a missing result


class Asked(NamedTuple):
    """Question for a study, whose result one or several targets need."""

    what: str
    speed: float | None
    window: tuple[float, float] | None


@dataclass(frozen=True)
class Target:
    """Target for a result of a design: a value, a limit, or to be the largest or smallest.

    Exactly one of `equals`, `at_least`, `at_most` and `best` is given.

    Parameters
    ----------
    what : str
        Name of the result, as for `study`: "frequencies" [Hz], "critical_speed" or "crossings" [rad/s],
        "amplitude" or "peak" [m], "strain", or "power" [W].
    equals : float, optional
        Required value [unit of the result].
    at_least, at_most : float, optional
        Limit of the result [same unit].
    best : {"largest", "smallest"}, optional
        The result is to be the largest or the smallest of all designs within the limits.
    speed : float, optional
        Speed of the result, or top speed of crossings [rad/s]; by default as for `study`, and for a crossing
        twice the required value.
    mode : int
        Number of the mode of a frequency or crossing, from 1.
    line : str
        Excitation line that the mode of a crossing meets, as `study` names it, such as "road -" or
        "road - (parametric)".
    window : tuple of float, optional
        Time window of a peak [s], as for `study`.

    Examples
    --------
    >>> print(bd.Target("frequencies", equals=62.0, speed=50.0).says)
    frequency of mode 1 at 50 rad/s = 62 Hz
    """

    what: str
    equals: float | None = None
    at_least: float | None = None
    at_most: float | None = None
    best: Literal["largest", "smallest"] | None = None
    speed: float | None = None
    mode: int = 1
    line: str = ""
    window: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        checks.one_of("what", self.what, tuple(KINDS))
        given = {name: getattr(self, name) for name in ("equals", "at_least", "at_most", "best")}
        given = {name: value for name, value in given.items() if value is not None}
        if len(given) != 1:
            bound = "give one of equals, at_least, at_most and best"
            raise checks.InvalidValue("target", ", ".join(given) or None, bound)
        if self.best is None:
            name, value = next(iter(given.items()))
            checks.positive(name, value, self.kind.unit)
        else:
            checks.one_of("best", self.best, ("largest", "smallest"))
        checks.check_used(self.what, OPTIONS, speed=self.speed, window=self.window)
        checks.count("mode", self.mode)
        if self.speed is not None:
            check_speeds(checks.real("speed", self.speed, "rad/s"), "speed")
        if self.window is not None:
            check_window(self.window)
        checks.kind("line", self.line, str)
        if (self.what == "crossings") != bool(self.line):
            bound = "crossings need the excitation line that a mode meets, and no other result has one"
            raise checks.InvalidValue("line", self.line, bound, 'give crossings one, such as "road -"')

    @property
    def kind(self) -> Kind:
        """Kind of the result, from `KINDS`."""
        return KINDS[self.what]

    @property
    def asked(self) -> Asked:
        """Question for a study; crossings are searched up to twice the required speed."""
        wanted = self.equals or self.at_least or self.at_most
        top = 2 * wanted if wanted and self.what == "crossings" and self.speed is None else self.speed
        return Asked(self.what, top, self.window)

    @property
    def has_modes(self) -> bool:
        """Whether the result belongs to a mode."""
        return "modes" in self.kind.options

    @property
    def is_limit(self) -> bool:
        """Whether the target is a limit, upper or lower."""
        return self.at_least is not None or self.at_most is not None

    def place(self, labels: tuple[str, ...]) -> int | None:
        """Return the index of the target's number within a result; None if the result has no such number."""
        if self.what != "crossings":
            return self.mode - 1 if self.has_modes else 0
        wanted = f"mode {self.mode}, {self.line}"
        return next((k for k, label in enumerate(labels) if label in (wanted, f"{wanted} (forced)")), None)

    def excess(self, value: np.ndarray) -> np.ndarray:
        """Compute the logarithm of the ratio of results to the required value or limit.

        For an upper limit its sign is reversed, so that it is positive if a limit is kept.  For a result that
        is to be the largest or smallest, it is larger the better the result is.  As results of beams are
        nearly powers of the numbers, these logarithms are nearly linear in the logarithms of the numbers.
        """
        wanted = self.equals or self.at_least or self.at_most or 1.0
        sign = -1.0 if self.at_most is not None or self.best == "smallest" else 1.0
        with np.errstate(divide="ignore"):
            found = sign * np.log(value / wanted)
        found = np.clip(np.where(np.isnan(found), -_NONE, found), -_NONE, _NONE)
        return found if self.best is not None else _compressed(found)

    def missed(self, excess: np.ndarray) -> np.ndarray:
        """Compute the distance from the target from the logarithms of `excess`; 0 if the target is met.

        For a result that is to be the largest or smallest it is 0, or 5 if there is no result.
        """
        if self.best is not None:
            return np.where(excess <= -_NONE, _FAR, 0.0)
        return np.maximum(-excess, 0.0) if self.is_limit else np.abs(excess)

    @property
    def name(self) -> Words:
        """Description of the result, such as "frequency of mode 1 at" a speed."""
        of = f" of mode {self.mode}" if self.has_modes else ""
        of += f" with {self.line}" if self.line else ""
        is_at = self.speed is not None and self.kind.has_speed
        return Words(self.kind.word, of, *((" at ", Speeds(self.speed or 0.0)) if is_at else ()))

    @property
    def says(self) -> Words:
        """Description of the target: the result with its required value, limit or "largest"."""
        if self.best is not None:
            return Words(self.name, f" {self.best}")
        words = {"=": self.equals, "at least": self.at_least, "at most": self.at_most}
        word, value = next((word, value) for word, value in words.items() if value is not None)
        return Words(self.name, f" {word} ", self.amount(value))

    def amount(self, value: float) -> str:
        """Format a value of the result with its unit."""
        return say_number(value, self.kind.unit)


def _compressed(excess: np.ndarray) -> np.ndarray:
    """Compress large logarithms, so that one target does not outweigh others; their order is unchanged."""
    beyond = np.maximum(np.abs(excess) - _FAR, 0.0)
    return np.clip(excess, -_FAR, _FAR) + np.sign(excess) * np.log1p(beyond)


def say_number(value: float, unit: str) -> str:
    """Format a value with six digits and its unit; output media, such as files, may use another unit."""
    return Speeds(value) if unit == "rad/s" else say_value(value, unit, 6)
