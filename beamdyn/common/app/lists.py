"""Lists of a document that a form of fixed fields cannot show: named things, added and removed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

Entries = dict[str, str]


@dataclass(frozen=True)
class Cell:
    """A value of a listed thing.

    Parameters
    ----------
    key : str
        Its name within the thing.
    label : str
        In words.
    text : str
        What stands in it.
    options : tuple of str
        What can be chosen; anything can be typed where there is none.
    hint : str
        What it is, with its unit.
    usual : str
        What holds where it is empty.
    """

    key: str
    label: str
    text: str
    options: tuple[str, ...] = ()
    hint: str = ""
    usual: str = ""


@dataclass(frozen=True)
class Item:
    """A listed thing: path of its entry, and its number in it if the entry is a list; name, and values."""

    path: str
    number: int | None
    name: str
    cells: tuple[Cell, ...]

    @property
    def id(self) -> str:
        """It and no other."""
        return self.path if self.number is None else f"{self.path}.{self.number}"


@dataclass(frozen=True)
class ListGroup:
    """Things of one sort: heading, what they are, items, and kinds that can be added, in words."""

    heading: str
    about: str
    items: tuple[Item, ...]
    kinds: Mapping[str, str]


def gone_with(item: Item, before: Sequence[ListGroup], after: Sequence[ListGroup]) -> list[str]:
    """Names of what has been removed along with an item that it names."""

    def names(groups: Sequence[ListGroup]) -> Counter[str]:
        return Counter(one.name for group in groups for one in group.items)

    return [*(names(before) - names(after) - Counter([item.name])).elements()]


@dataclass(frozen=True)
class Lists:
    """What a screen shows as lists.

    Parameters
    ----------
    covers : callable
        Whether the input of a path is shown in the lists, not in the form.
    groups : callable
        Entries in, groups out.
    put : callable
        Entries, item, key of its cell and text in; entries out.
    add : callable
        Entries and kind in; entries with one more out.
    remove : callable
        Entries and item in; entries without it, and without what names it, out.
    advice : callable
        Entries in; what is still missing out, a sentence each.
    empty : callable
        Entries in; those to start from nothing out.
    """

    covers: Callable[[str], bool]
    groups: Callable[[Mapping[str, str]], Sequence[ListGroup]]
    put: Callable[[Mapping[str, str], Item, str, str], Entries]
    add: Callable[[Mapping[str, str], str], Entries]
    remove: Callable[[Mapping[str, str], Item], Entries]
    advice: Callable[[Mapping[str, str]], Sequence[str]]
    empty: Callable[[Mapping[str, str]], Entries]
