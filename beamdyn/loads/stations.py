"""Stations along the span, at which loads are asked for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, as_floats, real_array, refuse
from beamdyn.scene.beam import Beam

Positions: TypeAlias = "float | Sequence[float] | np.ndarray"

_EVENLY = 21  # stations by default, besides both sides of each jump
_MOST = 1001
_SAME = 1e-12  # distance over the length at which a position is that of a breakpoint: as breakpoints merge
_BESIDE = 2e-12  # distance over the length at which the properties beside a jump are read


@dataclass(frozen=True)
class SpanStations:
    """Cross-sections at which the beam is cut.

    Parameters
    ----------
    xi : ndarray, shape (S,)
        Positions x/L, ascending; one that is given twice stands for the two sides of a jump.
    inboard : ndarray of bool, shape (S,)
        Whether the cut is just inboard of the position, so that what stands there belongs to the part
        outboard; else it is just outboard.
    """

    xi: np.ndarray
    inboard: np.ndarray

    @property
    def beside(self) -> np.ndarray:
        """Positions x/L (S,) at which the section on the side of the cut is read."""
        return np.clip(self.xi + np.where(self.inboard, -_BESIDE, _BESIDE), 0.0, 1.0)


def stations_at(beam: Beam, at: Positions | None) -> SpanStations:
    """Stations at positions [m], or by default evenly along the beam and on both sides of each jump.

    A position that is given twice stands for both sides, the inboard one first; alone it stands for the
    outboard side, at the tip for the inboard one.
    """
    ends = np.array(beam.breakpoints)
    if at is None:
        xi = np.unique(np.concatenate([_snapped(np.linspace(0, 1, _EVENLY), ends), ends]))
        xi = np.sort(np.concatenate([xi, ends[1:-1]]))
    else:
        xi = _snapped(_checked(at, beam.length) / beam.length, ends)
    twice = np.append(xi[1:] == xi[:-1], False)
    return SpanStations(xi, twice | (xi == 1))


def _checked(at: Positions, length: float) -> np.ndarray:
    """Positions [m] that ascend along the beam, each at most twice."""
    array = as_floats(at)
    x = real_array("at", array.reshape(1) if array is not None and not array.ndim else at)
    if not 1 <= len(x) <= _MOST:
        raise InvalidValue("at", at, f"give 1 to {_MOST} positions along the beam", unit="m")
    outside = (x < 0) | (x > length * (1 + _SAME))
    refuse(outside, "at", x, "m", "stations lie from the root, 0, to the tip, {limit}", limit=length)
    refuse(np.diff(x, prepend=0.0) < 0, "at", x, "m", "positions must ascend", "sort them")
    again = np.zeros(len(x), dtype=bool)
    again[2:] = x[2:] == x[:-2]
    refuse(
        again, "at", x, "m", "a position stands for one side, or twice for both sides of it", "give it twice"
    )
    return x


def _snapped(xi: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Positions, those within rounding of a breakpoint exactly at it."""
    nearest = ends[np.abs(xi[:, None] - ends).argmin(axis=1)]
    return np.where(np.abs(xi - nearest) <= _SAME, nearest, xi)
