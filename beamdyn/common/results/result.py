"""Base of all results: data with a provenance, which show and save themselves."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any, ClassVar

from beamdyn.common.results.display_units import DisplayUnits, InDisplayUnits
from beamdyn.common.results.one_line import OneLine, brief, shortened, warned
from beamdyn.common.results.pictures import labelled
from beamdyn.common.results.read_only import ReadOnlyArrays
from beamdyn.common.results.saved import Saved, load
from beamdyn.common.results.shown_by import MEDIA
from beamdyn.common.results.snapshots import plain

if TYPE_CHECKING:
    from pandas import DataFrame


Units = DisplayUnits | Mapping[str, str] | None
_MOST_PARTS = 6  # most parts of a headline that nobody wrote


class Shown(OneLine, InDisplayUnits):
    """Base of dataclasses that show themselves; their `plot`, if they have one, is given their label.

    The tables are those in the views of the package of the class, which stand at the edge.
    """

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        if "plot" in vars(cls):
            cls.plot = labelled(vars(cls)["plot"])  # pyright: ignore[reportAttributeAccessIssue]

    def headline(self) -> Iterable[str]:
        """What the result says in one line: its main numbers with units, their error, and what is amiss.

        Of a class that says nothing else, the first public fields, and how many warnings there are.
        """
        names = [f.name for f in dataclasses.fields(self) if f.repr]  # pyright: ignore[reportArgumentType]
        names = [name for name in names if name not in ("provenance", "warnings", "message")]
        for name in names[:_MOST_PARTS]:
            value = getattr(self, name)
            text = type(value).__name__ if dataclasses.is_dataclass(value) else brief(value)
            yield f"{name}={shortened(text, 30)}"
        yield warned(getattr(self, "warnings", ()))

    @property
    def plot_label(self) -> str:
        """Name of the result in a picture of several: the label of its scene."""
        return getattr(getattr(self, "scene", None), "label", "")

    def without_waiting(self) -> Any:
        """A copy without the parts that would have to be computed first; see `_repr_html_`."""
        return self

    def to_table(self, units: Units = None) -> str:
        """The table that the command prints, as text.

        Parameters
        ----------
        units : dict, optional
            Units in which it is shown, such as {"speed": "rpm", "length": "mm"}; see `in_units`.
        """
        return _views().text_of(_shown_in(self, units))

    def to_pandas(self, units: Units = None) -> DataFrame:
        """The columns of the CSV file as a data frame of pandas, indexed by what they are given over.

        Its ``attrs`` hold the class, the label, the warnings and the provenance of the result.

        Parameters
        ----------
        units : dict, optional
            Units of columns, such as {"speed": "rpm", "length": "mm"}; see `in_units`.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        return _views().frame_of(_shown_in(self, units))

    def _repr_html_(self) -> str:
        """Table and picture for notebooks, without what takes long and was not asked for."""
        return _views().html_of(self.without_waiting())


def _views() -> Any:
    """How results are shown: what the package has named, found when it is needed."""
    return import_module(MEDIA[-1])


def _shown_in(result: Shown, units: Units) -> Shown:
    return result if units is None else result.in_units(**vars(DisplayUnits.of(units)))


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
