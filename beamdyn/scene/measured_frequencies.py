"""Measured or independently computed natural frequencies over speed, and mode shapes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, as_floats, kind, real_array, set_fields, several
from beamdyn.common.results.snapshots import ReadOnlyArrays

Numbers = float | Sequence[float] | Sequence[Sequence[float]] | np.ndarray


@dataclass(frozen=True)
class MeasuredFrequencies(ReadOnlyArrays):
    """Natural frequencies at some speeds, from a laboratory or another program.

    Parameters
    ----------
    frequency : array-like, shape (S, m) or (m,)
        Frequencies [Hz], one row for each speed, in any order; nan where none was found.
    speeds : array-like, shape (S,)
        Speeds [rad/s].
    uncertainty : float or array-like, broadcast to (S, m)
        Standard uncertainties [Hz]; nan where they are not known.
    rounding : float or array-like, broadcast to (S, m)
        Half a unit of the last digit that was written down [Hz].
    labels : sequence of str, shape (m,)
        Names of the columns, such as "flap 1"; "frequency 1" and so on if not given.
    positions : array-like, shape (P,), optional
        Positions along the beam [m] at which shapes were found.
    shapes : array-like, shape (m, P), optional
        Deflection of each mode at the positions, at any scale.
    source : str
        Where the values come from, such as the name of a file.
    speed_unit : str
        Unit in which the speeds were written, such as "rpm"; empty if none was.

    Raises
    ------
    ValueError
        If shapes do not fit, a frequency or an uncertainty is not above zero, or there is no frequency.

    Examples
    --------
    >>> bd.MeasuredFrequencies([62.1, 389.0, 1090.0], uncertainty=0.5).count
    3
    """

    frequency: Any
    speeds: Any = (0.0,)
    uncertainty: Any = np.nan
    rounding: Any = 0.0
    labels: Sequence[str] = ()
    positions: Any = None
    shapes: Any = None
    source: str = ""
    speed_unit: str = ""

    def __post_init__(self) -> None:
        speeds, frequency = real_array("speeds", self.speeds), table_of("frequency", self.frequency)
        if len(frequency) != len(speeds):
            bound = f"there are {len(frequency)} rows for {len(speeds)} speeds"
            raise InvalidValue("frequency", frequency, bound, "give a row of frequencies for each speed")
        if not np.isfinite(frequency).any():
            raise InvalidValue("frequency", frequency, "there is none that is finite", "give one at least")
        _refuse_below("frequency", frequency, frequency <= 0, "above 0", "Hz")
        for name in ("source", "speed_unit"):
            kind(name, getattr(self, name), str)
        names = several("labels", self.labels, str, "give names in a list") or tuple(
            f"frequency {k}" for k in range(1, frequency.shape[1] + 1)
        )
        if len(names) != frequency.shape[1]:
            bound = f"there are {len(names)} for {frequency.shape[1]} columns of frequencies"
            raise InvalidValue("labels", names, bound, "give one for each column")
        set_fields(self, speeds=speeds, frequency=frequency, labels=names)
        set_doubts(self, frequency, "Hz")
        self._check_shapes()
        super().__post_init__()

    def _check_shapes(self) -> None:
        """Store the mode shapes as arrays; refuse shapes that do not fit the frequencies and positions."""
        if self.positions is None and self.shapes is None:
            return
        if self.positions is None or self.shapes is None:
            raise InvalidValue("shapes", self.shapes, "they need positions", "give positions and shapes")
        positions, shapes = real_array("positions", self.positions), table_of("shapes", self.shapes)
        if shapes.shape != (self.frequency.shape[1], len(positions)) or not np.isfinite(shapes).all():
            bound = f"they must be {self.frequency.shape[1]} modes at {len(positions)} positions"
            raise InvalidValue("shapes", shapes, bound, "give each mode a finite number at each position")
        set_fields(self, positions=positions, shapes=shapes)

    @property
    def count(self) -> int:
        """Number of measured frequencies, without those that are nan."""
        return int(np.isfinite(self.frequency).sum())

    @property
    def allowance(self) -> np.ndarray:
        """Tolerance of each value [Hz]: half a unit of the last digit plus twice the uncertainty."""
        return self.rounding + 2 * np.nan_to_num(self.uncertainty)


def table_of(name: str, values: Any) -> np.ndarray:
    """Convert rows of numbers, some of which may be nan, to an array of floats."""
    array = as_floats(values)
    if array is None or array.ndim > 2 or not array.size or np.isinf(array).any():
        raise InvalidValue(name, values, "it must be a table of numbers", "give rows of equal lengths")
    return np.atleast_2d(array).astype(float)


def set_doubts(data: Any, like: np.ndarray, unit: str) -> None:
    """Check `uncertainty` and `rounding` of data, and set both to arrays of the shape of the values."""
    spread = {name: _spread(name, getattr(data, name), like) for name in ("uncertainty", "rounding")}
    _refuse_below("uncertainty", spread["uncertainty"], spread["uncertainty"] <= 0, "above 0", unit)
    _refuse_below("rounding", spread["rounding"], ~(spread["rounding"] >= 0), "0 or more", unit)
    set_fields(data, **spread)


def _spread(name: str, values: Any, like: np.ndarray) -> np.ndarray:
    array = as_floats(values)
    try:
        assert array is not None
        return np.array(np.broadcast_to(array, like.shape), dtype=float)
    except (AssertionError, ValueError):
        bound = f"it does not suit values of shape {like.shape}"
        raise InvalidValue(name, values, bound, "give one number, or one for each value") from None


def _refuse_below(name: str, values: np.ndarray, bad: np.ndarray, bound: str, unit: str) -> None:
    if bad.any():
        raise InvalidValue(name, float(values[bad][0]), f"it must be {bound}", "", unit)
