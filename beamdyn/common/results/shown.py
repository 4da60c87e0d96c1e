"""Results in the hand: a line in a console, a table with a picture in a notebook, a data frame."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator, Mapping
from importlib import import_module
from typing import TYPE_CHECKING, Any

from beamdyn.common.results.display_units import DisplayUnits, InDisplayUnits
from beamdyn.common.results.one_line import OneLine, brief, shortened, warned
from beamdyn.common.results.pictures import labelled
from beamdyn.common.results.shown_by import MEDIA

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
        """Parts of the line that shows a result: main numbers with units and errors, and what is amiss."""
        return _first_fields(self)

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


def _first_fields(result: Shown) -> Iterator[str]:
    """The first public fields that say something, and how many warnings there are."""
    names = [f.name for f in dataclasses.fields(result) if f.repr]  # pyright: ignore[reportArgumentType]
    names = [name for name in names if name not in ("provenance", "warnings", "message")]
    for name in names[:_MOST_PARTS]:
        value = getattr(result, name)
        text = type(value).__name__ if dataclasses.is_dataclass(value) else brief(value)
        yield f"{name}={shortened(text, 30)}"
    yield warned(getattr(result, "warnings", ()))
