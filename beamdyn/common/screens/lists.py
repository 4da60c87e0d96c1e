"""Descriptions of lists of named items in a document, which a form of fixed fields cannot show."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

Entries = dict[str, str]


@dataclass(frozen=True)
class Cell:
    """A value of an item, with the values that it can be chosen from.

    Parameters
    ----------
    key : str
        Its key within the item.
    label : str
        The key in words.
    text : str
        The value, as typed.
    options : tuple of str
        Values that can be chosen; if there are none, any text can be typed.
    hint : str
        Description, with the unit.
    usual : str
        The default that holds while the cell is empty, in words.
    """

    key: str
    label: str
    text: str
    options: tuple[str, ...] = ()
    hint: str = ""
    usual: str = ""


@dataclass(frozen=True)
class Item:
    """An item of a list.

    Parameters
    ----------
    path : str
        Path of its entry.
    number : int, optional
        Index in that entry, if it is a list.
    name : str
        Name of the item.
    cells : tuple of Cell
        Its values.
    """

    path: str
    number: int | None
    name: str
    cells: tuple[Cell, ...]

    @property
    def id(self) -> str:
        """Identifier of the item among all items."""
        return self.path if self.number is None else f"{self.path}.{self.number}"


@dataclass(frozen=True)
class ListGroup:
    """A group of items of one sort.

    Parameters
    ----------
    heading : str
        Heading of the group.
    about : str
        Description, in a sentence.
    items : tuple of Item
        The items.
    kinds : mapping
        Kinds of items that can be added, and what they are called; none if the group is fixed.
    """

    heading: str
    about: str
    items: tuple[Item, ...]
    kinds: Mapping[str, str]


def gone_with(item: Item, before: Sequence[ListGroup], after: Sequence[ListGroup]) -> list[str]:
    """Return the names of items that went with a removed one, as they refer to it."""

    def names(groups: Sequence[ListGroup]) -> Counter[str]:
        return Counter(one.name for group in groups for one in group.items)

    return [*(names(before) - names(after) - Counter([item.name])).elements()]


@dataclass(frozen=True)
class Lists:
    """The lists of a screen, as functions of the document's entries.

    Parameters
    ----------
    covers : callable
        ``covers(path)``: whether an input is shown in the lists, not in the form.
    groups : callable
        ``groups(entries)``: the groups of items.
    put : callable
        ``put(entries, item, key, text)``: entries with another text in a cell.
    add : callable
        ``add(entries, kind)``: entries with one more item.
    remove : callable
        ``remove(entries, item)``: entries without an item, and without the items that refer to it.
    advice : callable
        ``advice(entries)``: what is still missing, a sentence each.
    empty : callable
        ``empty(entries)``: entries of a new design.
    """

    covers: Callable[[str], bool]
    groups: Callable[[Mapping[str, str]], Sequence[ListGroup]]
    put: Callable[[Mapping[str, str], Item, str, str], Entries]
    add: Callable[[Mapping[str, str], str], Entries]
    remove: Callable[[Mapping[str, str], Item], Entries]
    advice: Callable[[Mapping[str, str]], Sequence[str]]
    empty: Callable[[Mapping[str, str]], Entries]
