"""Base of all results: data with a provenance, which show and save themselves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from beamdyn.common.results.plain import plain
from beamdyn.common.results.read_only import ReadOnlyArrays
from beamdyn.common.results.saved import Saved, load
from beamdyn.common.results.shown import Shown, Units

__all__ = ["Provenance", "Result", "Units", "load", "plain"]


@dataclass(frozen=True)
class Provenance:
    """How a result was computed.

    Parameters
    ----------
    version : str
        Version of beamdyn.
    method : str
        The discretization, with its size.
    compared_with : str
        The coarser one from which the error was estimated.
    wall_time : float
        Time taken [s].
    """

    version: str
    method: str
    compared_with: str
    wall_time: float


class Result(Shown, Saved, ReadOnlyArrays):
    """Base of the frozen results: dataclasses whose public fields are the answer.

    All fields, private ones (``field(repr=False)``) too, are data: numbers, strings, arrays, containers and
    dataclasses of them.  Then a result is pickled, saved and loaded; see `beamdyn.common.results.snapshots`.

    A result is one line in a console, a table with a picture in a notebook, and a data frame for whoever asks
    for one.  A subclass gives its `headline`, its `plot` if it has a picture, and an entry in the views of
    its package (see `common.results.shown_by`) with the functions that make its table and the rows of its
    CSV file.  What it does not give is made from its fields, whose units it may state.

    Attributes
    ----------
    field_units : dict of str to str
        For each unit the names of the fields that are in it, separated by spaces.
    """

    field_units: ClassVar[dict[str, str]] = {}
