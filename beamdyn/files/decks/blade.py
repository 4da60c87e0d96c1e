"""What every deck says of a blade, in the words of this package, whatever program wrote it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from beamdyn.files.decks.stations import Stations


@dataclass(frozen=True)
class IgnoredProperty:
    """Something of a deck that the scene does not have.

    Parameters
    ----------
    name : str
        Its name in the deck.
    low, high : float
        Its smallest and largest value [unit].
    unit : str
        Unit, as the deck has it.
    reason : str
        Why it is left out, or how to have it all the same.

    Examples
    --------
    >>> left_out = bd.IgnoredProperty("torsional stiffness", 1e5, 5e9, "N m2", "no torsion is modelled")
    >>> left_out.sentence()
    'torsional stiffness (100000 to 5e+09 N m2): no torsion is modelled'
    """

    name: str
    low: float
    high: float
    unit: str
    reason: str

    @property
    def values(self) -> str:
        """The value or the range of values, with the unit."""
        ends = dict.fromkeys(f"{value:.6g}" for value in (self.low, self.high))
        return f"{' to '.join(ends)} {self.unit}".rstrip()

    def sentence(self) -> str:
        """Name, values and reason."""
        return f"{self.name} ({self.values}): {self.reason}"


@dataclass(frozen=True)
class Blade:
    """A blade as its deck describes it.

    Parameters
    ----------
    kind : str
        What the deck is.
    title : str
        What the deck says it is of; it may be empty.
    sources : tuple of Path
        The files that were read, the one that was asked for first.
    length, hub_radius : float
        Length of the blade and distance of its root from the axis of rotation [m].
    stations : ndarray, shape (n,)
        Positions x/L.
    columns : dict of ndarray, shape (n,)
        Properties by the name that `Beam.from_stiffness` has for them, in SI units, but twist in degrees.
    tip : dict of float
        Arguments of `TipMass`.
    pitch : float
        Angle by which the whole blade is turned towards feather [deg].
    precone : float
        Angle by which the blade leaves the plane of rotation, positive downwind [deg].
    speed : float
        Speed of rotation that the deck states [rpm]; 0 for none.
    damping : float
        Damping ratio that all modes of the deck have; 0 for none or several.
    polynomials : dict of ndarray, shape (5,)
        Coefficients of x/L to the powers 2 to 6 of the deck's mode shapes, by mode, such as "flap 1".
    ignored : tuple of IgnoredProperty
        What of the deck is not in this blade.
    doubts : tuple of str
        What the deck's own program would read otherwise.
    """

    kind: str
    title: str
    sources: tuple[Path, ...]
    length: float
    hub_radius: float
    stations: np.ndarray
    columns: dict[str, np.ndarray]
    tip: dict[str, float] = field(default_factory=dict)
    pitch: float = 0.0
    precone: float = 0.0
    speed: float = 0.0
    damping: float = 0.0
    polynomials: dict[str, np.ndarray] = field(default_factory=dict)
    ignored: tuple[IgnoredProperty, ...] = ()
    doubts: tuple[str, ...] = ()


def ignore(name: str, values: float | Sequence[float] | np.ndarray, unit: str, reason: str) -> tuple:
    """What is ignored of some values: nothing where all are zero."""
    array = np.atleast_1d(np.asarray(values, dtype=float))
    if not array.any():
        return ()
    return (IgnoredProperty(name, float(array.min()), float(array.max()), unit, reason),)


def ignore_columns(
    table: Stations, used: Sequence[str], reasons: Mapping[str, str]
) -> tuple[IgnoredProperty, ...]:
    """The columns of a table that the scene does not have; `used` are the others."""
    return tuple(
        entry
        for name, values in table.columns.items()
        if name not in used
        for entry in ignore(
            name, values, table.units[name].replace("?", "").strip("-"), reasons.get(name, "unknown column")
        )
    )
