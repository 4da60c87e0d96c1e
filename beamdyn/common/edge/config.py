"""Reading of TOML files with units into objects of the package, whose numbers are floats in SI units.

All mistakes of a file are reported in one message.  The keys that a table of a file may have follow from the
fields of a dataclass of the package, so that no input is described twice.
"""

from __future__ import annotations

import difflib
import math
import operator
import re
import tomllib
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property, reduce
from inspect import Parameter, signature
from os import PathLike
from types import NoneType
from typing import Annotated, Any, ClassVar, Literal, TypeVar, get_args, get_origin, get_type_hints

import numpy as np
from pydantic import (
    BaseModel,
    BeforeValidator,
    Discriminator,
    Field,
    Tag,
    ValidationError,
    create_model,
    model_validator,
)
from pydantic_core import ErrorDetails

from beamdyn.common.edge.file_words import say
from beamdyn.common.edge.inputs import (
    Input,
    Quantity,
    Section,
    describe,
    in_millimetres,
    of_file,
    path_of,
    wholes_of,
    without_indices,
)
from beamdyn.common.edge.units import InvalidInput, quantity, show, unit_as_written
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.inputs.described import Described, description, kinds_of
from beamdyn.common.results.files import as_path
from beamdyn.common.words import Part, worded

Model = TypeVar("Model", bound=BaseModel)


class ConfigError(ValueError):
    """Raised for a TOML file with mistakes; the message lists all of them.

    Parameters
    ----------
    source : str
        Name of the file, or another description of where the text is from.
    mistakes : sequence of str
        One sentence each: the key's path, the value, what is wrong and the remedy.
    paths : sequence of str
        For each mistake the path of the input that it is about, empty for none; all empty if not given.

    Examples
    --------
    >>> try:
    ...     bd.load_scene("examples/no_such_file.toml")
    ... except bd.ConfigError as mistakes:
    ...     print("refused")
    refused
    """

    def __init__(self, source: str, mistakes: Sequence[str], paths: Sequence[str] = ()) -> None:
        self.source, self.mistakes = source, tuple(mistakes)
        self.paths = tuple(paths) or ("",) * len(self.mistakes)
        one = len(mistakes) == 1
        head = f"{source}: " if one else f"{source}: {len(mistakes)} mistakes\n  "
        super().__init__(head + "\n  ".join(mistakes))

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return type(self), (self.source, self.mistakes, self.paths)


class MissingValue(InvalidValue):
    """Raised for a missing value that is required; the message names the field and what to give."""

    def worded(self, word: Callable[[Part], str]) -> str:
        """Return the message; the function `word` formats each of its parts for Python, files or forms."""
        return f"{self.field}: missing; {worded(self.bound, word)}"


class CoreSection(Section):
    """A table of a file that describes an object of the package.

    The object is made when the table is validated, so that an error raised by it is a mistake of the table.
    """

    @cached_property
    def core(self) -> Any:
        """Make the object of the package that the table describes."""
        raise NotImplementedError

    @model_validator(mode="after")
    def _core_accepts(self) -> CoreSection:
        with np.errstate(all="ignore"):  # numpy's warnings do not help a user who mistyped an exponent
            self.core  # noqa: B018
        return self


def read(path: str | PathLike[str]) -> str:
    """Read the text of a file.

    Raises
    ------
    InvalidValue
        If `path` is neither text nor a path.
    ConfigError
        If the file cannot be read; the message says why.
    """
    file = as_path("path", path, "a TOML file")
    try:
        # Some editors put a byte order mark at the start of the text; it is skipped.
        return file.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise ConfigError(str(path), ["there is no such file; check the name and the folder"]) from None
    except OSError as error:
        raise ConfigError(str(path), [f"it cannot be read ({error.strerror}); give a TOML file"]) from None
    except ValueError:  # the content is not UTF-8, or no file can have this name
        raise ConfigError(str(path), ["it is not text in UTF-8; give a TOML file"]) from None


def parse(text: str, source: str) -> dict[str, Any]:
    """Parse TOML text into tables.

    Raises
    ------
    ConfigError
        If the text is not TOML.
    """
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise ConfigError(
            source, ["its lists or tables are nested too deeply; give a file of tables"]
        ) from None
    except tomllib.TOMLDecodeError as error:
        remedy = (
            "give each key and each [table] once, true and false in lower case, and a quantity in quotes: "
            'length = "50 mm"'
        )
        raise ConfigError(source, [f"not valid TOML: {error}; {remedy}"]) from None
    except ValueError:
        raise ConfigError(source, ["a number has thousands of digits; give at most 17"]) from None


def validated(model: type[Model], data: Mapping[str, Any], source: str) -> Model:
    """Make an instance of a pydantic model from tables of a file.

    Parameters
    ----------
    model : type of BaseModel
        The model.
    data : mapping
        Tables of the file, as tomllib returns them.
    source : str
        Name of the file, for messages.

    Raises
    ------
    ConfigError
        If the tables do not fit the model; the message lists all mistakes.
    """
    try:
        return model.model_validate(dict(data))
    except ValidationError as error:
        mistakes = dict(_mistake(model, each) for each in error.errors(include_url=False))
        raise ConfigError(source, [*mistakes], [*mistakes.values()]) from None


_MOST_KEYS = 24  # largest number of known keys that a message lists
_LONGEST_KEY = 60  # length of the longest key that a message shows in full
_WORDS = {
    "bool_type": "give true or false",
    "dict_type": "give a table",
    "list_type": "give a list in brackets",
    "model_type": "give a table with keys",
}


def _mistake(model: type[BaseModel], error: ErrorDetails) -> tuple[str, str]:
    """Return the sentence about one mistake, and the path of the input with the mistake."""
    loc, context, given = error["loc"], error.get("ctx", {}), error["input"]
    place, path = _path(loc), _path(loc, indices=False)
    match error["type"]:
        case "missing":
            known = describe(model)
            how = next(
                (f"give the {i.help.removeprefix('the ')}" for i in known if i.path == path),
                "give as many values as stations",
            )
            how = _missing_table(path, known) or how
            return str(MissingValue(place, None, how)), path
        case "extra_forbidden":
            return _unknown(model, loc), path
        case "value_error":
            return _refusal(model, place, path, context.get("error"), given)
        case "kind":
            return str(InvalidInput(f"{place}.kind", given["kind"], error["msg"])), f"{path}.kind"
        case "literal_error":
            bound = f"give {context.get('expected')}"
        case "too_long":
            bound = f"give at most {context['max_length']} values"
        case "string_too_long":
            bound = f"give at most {context['max_length']} characters"
        case "too_short":
            least = context["min_length"]
            bound = f"give at least {'one value' if least == 1 else f'{least} values'}"
        case _:
            bound = _WORDS.get(error["type"], error["msg"])
    return str(InvalidInput(place, given, bound)), path


def _missing_table(path: str, known: Sequence[Input]) -> str:
    """Name the missing table with its required keys; return "" if no table is missing."""
    keys = [each for each in known if each.path.startswith(f"{path}.")]
    needed = [each.name for each in keys if each.required and each.path == f"{path}.{each.name}"]
    of_one_kind = needed and len({each.section for each in keys}) == 1
    with_keys = f" with {', '.join(needed)}" if of_one_kind else ""
    return f"give a table [{path}]{with_keys}" if keys else ""


def _refusal(model: type[BaseModel], place: str, path: str, reason: Any, given: Any) -> tuple[str, str]:
    """Return the sentence on an invalid value, with key and value of the file, and the path of the input.

    `place` and `path` are the path of the value with and without list indices, `reason` is the error that the
    check raised, and `given` the value in the file.
    """
    if isinstance(reason, InvalidInput) and not reason.field:
        return say(replace(reason, field=place)), path
    if key := path_of(reason, [entry.path for entry in describe(model)], path):
        inner = _place_in(reason.field, key).removeprefix(path).lstrip(".")
        return said_of(reason, f"{place}.{inner}".lstrip("."), _found(given, inner)), key
    said = say(in_millimetres(reason) if isinstance(reason, InvalidValue) else reason)
    return f"{place}: {said}" if place else said, path


def _place_in(field: str, key: str) -> str:
    """Return the path `key` of an input, extended by the further part of `field`, such as ".values[1]"."""
    parts = (field.removeprefix(name) for name in wholes_of(field) if f".{key}".endswith(f".{name}"))
    if (part := next(parts, None)) is not None:
        return key + part
    return key.removesuffix(without_indices(field)) + field


def _found(given: Any, place: str) -> Any:
    """Return the entry of nested tables at a path such as "width.values[1]"; None if there is none."""
    for key, index in re.findall(r"([^.\[\]]+)|\[(\d+)\]", place):
        try:
            given = given[int(index) if index else key]
        except (KeyError, IndexError, TypeError):
            return None
    return given


@contextmanager
def in_words_of_file(model: type[BaseModel], tables: Mapping[str, Any], source: str) -> Iterator[None]:
    """In this context, reword errors about a file's values: with the key, and the value as written.

    Raises
    ------
    ConfigError
        In place of an `InvalidValue` about an input of the model; other errors are raised unchanged.
    """
    try:
        yield
    except InvalidValue as error:
        if not (key := path_of(error, [entry.path for entry in describe(model)])):
            raise
        raise ConfigError(source, [said_of(error, key, _found(tables, key))], [key]) from None


def said_of(refusal: InvalidValue, place: str, given: Any) -> str:
    """Return the message on an invalid value, with its path in the file and the value as written there."""
    kind = type(refusal) if isinstance(refusal, InvalidInput | MissingValue) else InvalidInput
    said: dict[str, Any] = vars(refusal if given is not None else in_millimetres(refusal)) | {"field": place}
    return say(_as_written(kind(**said), given))


def _as_written(refusal: InvalidValue, given: Any) -> InvalidValue:
    """Return the error with the value as written in the file, and with the limit in the same unit."""
    value, unit = refusal.value, refusal.unit
    if isinstance(given, list) and isinstance(value, tuple | list):
        return replace(refusal, value=given)
    if not isinstance(given, str) or not isinstance(value, float):
        return refusal
    try:
        if not math.isclose(abs(quantity(given, unit)), abs(value), rel_tol=1e-9):
            return refusal  # the error is about a number computed from the one in the file
    except InvalidInput:  # the units differ, for example where a file gives a length in place of a fraction
        return replace(refusal, value=given)
    return replace(refusal.in_unit(*unit_as_written(given, unit)), value=given)


def _path(loc: Iterable[int | str], indices: bool = True) -> str:
    """Return the path of a key in TOML, without pydantic's labels in <>, and with list `indices` or not."""
    keys = (part for part in loc if not str(part).startswith("<"))
    parts = [f".{key}" if isinstance(key, str) else f"[{key}]" * indices for key in keys]
    return "".join(parts).removeprefix(".")


def _unknown(model: type[BaseModel], loc: tuple[int | str, ...]) -> str:
    """Describe an unknown key; name the table or kind that has it, else a similar key, else all keys."""
    table, key, known = _path(loc[:-1], indices=False), str(loc[-1]), describe(model)
    prefix = table and f"{table}."  # empty at the top level, so that every path begins with it
    inside = [i.path.removeprefix(prefix).partition(".")[0] for i in known if i.path.startswith(prefix)]
    names = [*dict.fromkeys(inside)] or ["polynomial", "stations", "values"]
    kinds = [show(i.choices[0]) for i in known if i.path == f"{table}.kind" and key in i.section.model_fields]
    tables = {i.path.rpartition(".")[0] for i in known if i.name == key} - {""}
    if key in names and kinds:
        remedy = f"it goes with kind = {' or '.join(kinds)}"
    elif len(tables) == 1:
        remedy = f"it belongs in the table [{tables.pop()}]"
    elif near := difflib.get_close_matches(key, names, n=1):
        remedy = f"did you mean {near[0]}?"
    else:
        more = [f"{len(names) - _MOST_KEYS} more"] if len(names) > _MOST_KEYS + 1 else []
        remedy = f"known are {', '.join([*names[:_MOST_KEYS], *more])}"
    shown = key if key.isprintable() and len(key) <= _LONGEST_KEY else show(key)
    return f"{f'{_path(loc[:-1])}.{shown}'.removeprefix('.')}: unknown key; {remedy}"


# Tables that follow from dataclasses of the package -------------------------------------------------


class MadeSection(CoreSection):
    """A table that describes an object of the package; its keys follow from the arguments of the class."""

    made: ClassVar[type]
    key_of: ClassVar[Mapping[str, str]]  # key of each argument; a pair `tip` has two: "tip[0]" and "tip[1]"

    @property
    def given(self) -> dict[str, Any]:
        """Return the values of the table as arguments, by name, for the class that it describes."""
        given: dict[str, Any] = {}
        for name, key in self.key_of.items():
            value, (argument, pair, _) = getattr(self, key), name.partition("[")
            value = value.core if isinstance(value, CoreSection) else value
            value = tuple(value) if isinstance(value, list) else value
            given[argument] = (*given.get(argument, ()), value) if pair else value
        return given

    @cached_property
    def core(self) -> Any:
        """Make the object of the package that the table describes."""
        with of_file(self.key_of):
            return self.made(**self.given)


Base = TypeVar("Base", bound=MadeSection)


def section_of(
    made: type, kind: str = "", tables: Mapping[type, Any] | None = None, base: type[Base] = MadeSection
) -> type[Base]:
    """Make the pydantic class of a file's table from a dataclass whose objects the table describes.

    Parameters
    ----------
    made : type
        A dataclass; its fields are annotated with `Described`, or are dataclasses of such fields.
    kind : str
        Value of the key ``kind``, by which alternatives of a table differ; if empty, there is no such key.
    tables : mapping, optional
        For fields whose own annotation does not suffice: the annotation for pydantic, by class of the field;
        or a class derived from `Quantity`, by class of the field's description.
    base : type of MadeSection
        Base class of the new class; its fields are keys, too.

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
    """Return the keys of a file's table, with annotations and defaults, from a dataclass or function.

    Parameters
    ----------
    made, tables
        As for `section_of`.
    leave_out : collection of str
        Names of arguments that files cannot give.

    Raises
    ------
    TypeError
        If an argument has no `Described` in its annotation.
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
    """Return the annotation of a table whose alternatives differ in ``kind``; the first is the default."""
    usual, *_ = sections
    tagged = (Annotated[section, Tag(f"<{kind}>")] for kind, section in sections.items())

    def tag(given: Any) -> str:
        return f"<{given.get('kind', usual)}>" if isinstance(given, dict) else f"<{usual}>"

    *others, last = map(repr, sections)
    return Annotated[
        reduce(operator.or_, tagged), Discriminator(tag, "kind", f"give {', '.join(others)} or {last}")
    ]


def _arguments(made: Callable[..., Any]) -> dict[str, Any]:
    """Return the annotation of each argument; "tip[0]" and "tip[1]" for a pair with two descriptions."""
    hints, arguments = get_type_hints(made, include_extras=True), {}
    for name in signature(made).parameters:
        parts = get_args(hints.get(name))
        if get_origin(hints.get(name)) is tuple and Ellipsis not in parts and _is_described(parts[0]):
            arguments |= {f"{name}[{place}]": part for place, part in enumerate(parts)}
        elif name in hints:
            arguments[name] = hints[name]
    return arguments


def _key(name: str, hint: Any) -> str:
    """Return the key of an argument in files: as in its `Described`, else its name ("tip_x" for "tip[0]")."""
    described = description(hint)
    return described.key if described and described.key else name.replace("[0]", "_x").replace("[1]", "_y")


def _refuse_truth(given: object) -> object:
    """Refuse True and False, which pydantic would otherwise read as the numbers 1 and 0."""
    if isinstance(given, bool):
        raise InvalidInput("", given, "give a number")
    return given


def _is_described(hint: Any) -> bool:
    return get_origin(hint) is Annotated


def _annotation(hint: Any, tables: Mapping[type, Any]) -> Any:
    """Return the annotation for pydantic that corresponds to the annotation of a dataclass field."""
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
