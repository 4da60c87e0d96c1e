"""Tables of files, made from classes of the core, which take SI floats: no input is described twice."""

from __future__ import annotations

import operator
from collections.abc import Callable, Collection, Mapping
from functools import cached_property, reduce
from inspect import Parameter, signature
from types import NoneType
from typing import Annotated, Any, ClassVar, Literal, TypeVar, get_args, get_origin, get_type_hints

from pydantic import BeforeValidator, Discriminator, Field, Tag, create_model

from beamdyn.common.edge.config import CoreSection
from beamdyn.common.edge.inputs import Quantity
from beamdyn.common.edge.units import InvalidInput
from beamdyn.common.edge.wording import of_file
from beamdyn.common.inputs.described import Described, description, kinds_of


class MadeSection(CoreSection):
    """A table made from a core class; its keys follow from the arguments of the class."""

    made: ClassVar[type]
    key_of: ClassVar[Mapping[str, str]]  # keys by argument; "tip[0]" and "tip[1]" are those of a pair

    @property
    def given(self) -> dict[str, Any]:
        """Return the arguments of the core class."""
        given: dict[str, Any] = {}
        for name, key in self.key_of.items():
            value, (argument, pair, _) = getattr(self, key), name.partition("[")
            value = value.core if isinstance(value, CoreSection) else value
            value = tuple(value) if isinstance(value, list) else value
            given[argument] = (*given.get(argument, ()), value) if pair else value
        return given

    @cached_property
    def core(self) -> Any:
        """Make the core object."""
        with of_file(self.key_of):
            return self.made(**self.given)


Base = TypeVar("Base", bound=MadeSection)


def section_of(
    made: type, kind: str = "", tables: Mapping[type, Any] | None = None, base: type[Base] = MadeSection
) -> type[Base]:
    """Make the class of a table of a file, from a core class whose objects the table describes.

    Parameters
    ----------
    made : type
        A dataclass; its fields are annotated with `Described`, or are dataclasses of such fields.
    kind : str
        Value of the key ``kind`` that tells the table from its alternatives; there is none if empty.
    tables : mapping, optional
        How to read fields where that does not follow from their annotation: by the class of a field, an
        annotation for pydantic; by the class of a description, the class of the `Quantity` to use.
    base : type of MadeSection
        Base class, which may have further keys.

    Returns
    -------
    type of MadeSection
    """
    fields: dict[str, Any] = fields_of(made, tables)
    if kind:
        fields = {"kind": (Annotated[Literal[kind], Field(description="kind of motion")], kind)} | fields
    section = create_model(f"{made.__name__}Input", __base__=base, __doc__=made.__doc__, **fields)
    section.made, section.key_of = made, {name: _key(name, hint) for name, hint in _arguments(made).items()}
    return section


def fields_of(
    made: Callable[..., Any], tables: Mapping[type, Any] | None = None, leave_out: Collection[str] = ()
) -> dict[str, Any]:
    """Return annotations and defaults, by key, for the table of a core class or function.

    Parameters
    ----------
    made, tables
        As for `section_of`.
    leave_out : collection of str
        Arguments that have no key.

    Raises
    ------
    TypeError
        If an argument is not described.
    """
    defaults = signature(made).parameters
    fields: dict[str, Any] = {}
    for name, hint in _arguments(made).items():
        if name in leave_out:
            continue
        described = description(hint) or Described()
        default = defaults[name].default if name in defaults else Parameter.empty
        default = default if described.default is None else described.default
        required = described.required or default is Parameter.empty
        fields[_key(name, hint)] = (_annotation(hint, tables or {}), ... if required else default)
    return fields


def one_of_kinds(sections: Mapping[str, type[MadeSection]]) -> Any:
    """Return the annotation of a table with alternatives, told apart by ``kind``; by default the first."""
    usual, *_ = sections
    tagged = (Annotated[section, Tag(f"<{kind}>")] for kind, section in sections.items())

    def tag(given: Any) -> str:
        return f"<{given.get('kind', usual)}>" if isinstance(given, dict) else f"<{usual}>"

    *others, last = map(repr, sections)
    return Annotated[
        reduce(operator.or_, tagged), Discriminator(tag, "kind", f"give {', '.join(others)} or {last}")
    ]


def _arguments(made: Callable[..., Any]) -> dict[str, Any]:
    """Return annotations by argument; a pair whose numbers are described apart has two, such as "tip[0]"."""
    hints, arguments = get_type_hints(made, include_extras=True), {}
    for name in signature(made).parameters:
        parts = get_args(hints.get(name))
        if get_origin(hints.get(name)) is tuple and Ellipsis not in parts and _is_described(parts[0]):
            arguments |= {f"{name}[{place}]": part for place, part in enumerate(parts)}
        elif name in hints:
            arguments[name] = hints[name]
    return arguments


def _key(name: str, hint: Any) -> str:
    """Return the key of an argument: "tip_x" and "tip_y" for a pair "tip", unless described otherwise."""
    described = description(hint)
    return described.key if described and described.key else name.replace("[0]", "_x").replace("[1]", "_y")


def _refuse_truth(given: object) -> object:
    """Refuse a truth value, which would otherwise pass for the number that equals it."""
    if isinstance(given, bool):
        raise InvalidInput("", given, "give a number")
    return given


def _is_described(hint: Any) -> bool:
    return get_origin(hint) is Annotated


def _annotation(hint: Any, tables: Mapping[type, Any]) -> Any:
    """Return the annotation for pydantic that corresponds to an annotation of the core's classes."""
    kinds, described = kinds_of(hint), description(hint)
    kind, parts = kinds[0], get_args(kinds[0])
    read: Any
    if known := [tables[each] for each in kinds if each in tables]:
        read = known[0]
    elif parts and _is_described(parts[0]):
        read = list[_annotation(parts[0], tables)]
    elif described is None and hasattr(kind, "__dataclass_fields__"):
        read = section_of(kind, tables=tables)
    elif described is None:
        raise TypeError(f"{hint} is not described: give Annotated[{hint}, Described(...)]")
    elif kind in (str, bool) or get_origin(kind) is Literal:
        read = Annotated[kind, Field(description=described.meaning)]
        read = Annotated[read, BeforeValidator(_refuse_truth)] if 1 in parts else read
    elif parts and parts[0] is str:
        number = None if Ellipsis in parts else len(parts)
        read = Annotated[
            list[str], Field(description=described.meaning, min_length=number, max_length=number)
        ]
    else:
        quantity = tables.get(type(described), Quantity)
        read = Annotated[float if kind is Any else kind, quantity(**vars(described))]
    return read | None if NoneType in kinds else read
