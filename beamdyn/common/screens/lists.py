"""Descriptions of lists of named items in an input file, for which a form has no fixed number of fields."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

Entries = dict[str, str]


@dataclass(frozen=True)
class Cell:
    """A value of an item, with the options among which it can be chosen.

    Parameters
    ----------
    key : str
        Key of the value within the item.
    label : str
        Name of the value in words.
    text : str
        The value, as typed.
    options : tuple of str
        Options to choose from; if there are none, any text can be typed.
    hint : str
        Description of the value, with its unit.
    usual : str
        Default for an empty field, in words.
    """

    key: str
    label: str
    text: str
    options: tuple[str, ...] = ()
    hint: str = ""
    usual: str = ""


@dataclass(frozen=True)
class Item:
    """An item of a list, such as a part of a mechanism.

    Parameters
    ----------
    path : str
        Path of the input that holds the item.
    number : int, optional
        Index of the item in this input, if the input is a list.
    name : str
        Name of the item.
    cells : tuple of Cell
        Values of the item.
    """

    path: str
    number: int | None
    name: str
    cells: tuple[Cell, ...]

    @property
    def id(self) -> str:
        """Return the identifier of the item among all items."""
        return self.path if self.number is None else f"{self.path}.{self.number}"


@dataclass(frozen=True)
class ListGroup:
    """A group of items of the same kind.

    Parameters
    ----------
    heading : str
        Heading of the group.
    about : str
        Description of the group in one sentence.
    items : tuple of Item
        The items.
    kinds : mapping
        Kinds of items that can be added, with their names; empty if the group is fixed.
    """

    heading: str
    about: str
    items: tuple[Item, ...]
    kinds: Mapping[str, str]


def gone_with(item: Item, before: Sequence[ListGroup], after: Sequence[ListGroup]) -> list[str]:
    """Return the names of the other items that were removed because they refer to the removed `item`."""

    def names(groups: Sequence[ListGroup]) -> Counter[str]:
        return Counter(one.name for group in groups for one in group.items)

    return [*(names(before) - names(after) - Counter([item.name])).elements()]


@dataclass(frozen=True)
class Lists:
    """The lists of a screen, as functions of the texts of all fields.

    Parameters
    ----------
    covers : callable
        ``covers(path)`` returns whether an input is shown in the lists, not in the form.
    groups : callable
        ``groups(entries)`` returns the groups of items.
    put : callable
        ``put(entries, item, key, text)`` returns the field texts with a changed value of an item.
    add : callable
        ``add(entries, kind)`` returns the field texts with one more item.
    remove : callable
        ``remove(entries, item)`` returns the field texts without an item and the items that refer to it.
    advice : callable
        ``advice(entries)`` returns a sentence on each missing item.
    empty : callable
        ``empty(entries)`` returns the field texts of a new design.
    """

    covers: Callable[[str], bool]
    groups: Callable[[Mapping[str, str]], Sequence[ListGroup]]
    put: Callable[[Mapping[str, str], Item, str, str], Entries]
    add: Callable[[Mapping[str, str], str], Entries]
    remove: Callable[[Mapping[str, str], Item], Entries]
    advice: Callable[[Mapping[str, str]], Sequence[str]]
    empty: Callable[[Mapping[str, str]], Entries]
