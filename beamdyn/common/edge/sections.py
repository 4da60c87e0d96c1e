"""Tables of a file made from core classes whose fields are described: no input is described twice."""

from __future__ import annotations

import operator
from collections.abc import Mapping
from functools import cached_property, reduce
from inspect import signature
from types import NoneType
from typing import Annotated, Any, ClassVar, Literal, get_args, get_origin, get_type_hints

from pydantic import Discriminator, Field, Tag, create_model

from beamdyn.common.described import Described
from beamdyn.common.edge.config import CoreSection
from beamdyn.common.edge.inputs import Quantity


class MadeSection(CoreSection):
    """A table made from a core class: its keys are the arguments of the class."""

    made: ClassVar[type]
    arguments: ClassVar[Mapping[str, str]]  # by key

    @cached_property
    def core(self) -> Any:
        """The core object."""
        given = {self.arguments[key]: value for key, value in self if key in self.arguments}
        return self.made(**{n: v.core if isinstance(v, CoreSection) else v for n, v in given.items()})


def section_of(made: type, kind: str = "", tables: Mapping[type, Any] | None = None) -> type[MadeSection]:
    """Make the table of a core class.

    Parameters
    ----------
    made : type
        A dataclass; its fields are annotated with `Described`, or are dataclasses of such fields.
    kind : str
        Value of the key ``kind`` that tells the table from its alternatives; there is none if empty.
    tables : mapping, optional
        By class of a field: what its table may be, where that does not follow from the class.

    Returns
    -------
    type of MadeSection
    """
    hints, defaults = get_type_hints(made, include_extras=True), signature(made).parameters
    fields: dict[str, Any] = {}
    if kind:
        fields["kind"] = (Annotated[Literal[kind], Field(description="kind of motion")], kind)
    arguments = {_description(hints[name]).key or name: name for name in defaults}
    for key, name in arguments.items():
        default = defaults[name].default
        required = default is defaults[name].empty or _description(hints[name]).required
        fields[key] = (_annotation(hints[name], tables or {}), ... if required else default)
    section = create_model(f"{made.__name__}Input", __base__=MadeSection, __doc__=made.__doc__, **fields)
    section.made, section.arguments = made, arguments
    return section


def one_of_kinds(sections: Mapping[str, type[MadeSection]]) -> Any:
    """The annotation of a table with alternatives, told apart by the key ``kind``; default: the first."""
    usual, *_ = sections
    tagged = (Annotated[section, Tag(f"<{kind}>")] for kind, section in sections.items())

    def tag(given: Any) -> str:
        return f"<{given.get('kind', usual)}>" if isinstance(given, dict) else f"<{usual}>"

    *others, last = map(repr, sections)
    return Annotated[
        reduce(operator.or_, tagged), Discriminator(tag, "kind", f"give {', '.join(others)} or {last}")
    ]


def _description(hint: Any) -> Described:
    return hint.__metadata__[0] if get_origin(hint) is Annotated else Described()


def _annotation(hint: Any, tables: Mapping[type, Any]) -> Any:
    """The annotation for pydantic that corresponds to one of the core."""
    inner = get_args(hint)[0] if get_origin(hint) is Annotated else hint
    parts = [part for part in get_args(inner) or (inner,) if part is not NoneType]
    read: Any
    if known := [tables[part] for part in parts if part in tables]:
        read = known[0]
    elif get_origin(inner) is Literal:
        read = Annotated[inner, Field(description=_description(hint).meaning)]
    elif get_origin(hint) is Annotated:
        read = Annotated[float, Quantity(**vars(_description(hint)))]
    elif get_origin(parts[0]) is Annotated:
        read = list[_annotation(parts[0], tables)]
    elif hasattr(parts[0], "__dataclass_fields__"):
        read = section_of(parts[0], tables=tables)
    else:
        raise TypeError(f"{hint} is not described: give Annotated[{hint}, Described(...)]")
    return read | None if NoneType in get_args(inner) else read
