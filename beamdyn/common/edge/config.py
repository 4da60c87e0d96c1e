"""Reading of TOML files with units into objects of the core, which takes SI floats.

All mistakes of a file are reported in one message.
"""

from __future__ import annotations

import difflib
import math
import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property
from os import PathLike
from typing import Any, TypeVar

import numpy as np
from pydantic import BaseModel, ValidationError, model_validator
from pydantic_core import ErrorDetails

from beamdyn.common.edge.file_words import say
from beamdyn.common.edge.inputs import Input, Section, describe
from beamdyn.common.edge.units import InvalidInput, quantity, show, unit_as_written
from beamdyn.common.edge.wording import in_millimetres
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.results.files import as_path
from beamdyn.common.words import Part, worded

Model = TypeVar("Model", bound=BaseModel)


class ConfigError(ValueError):
    """Raised for a TOML file with mistakes; the message lists all of them.

    Parameters
    ----------
    source : str
        Name of the file, or of another origin of the text.
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
    """Raised for a value that must be given and is not; the message names field and bound."""

    def worded(self, word: Callable[[Part], str]) -> str:
        """Return the message, each part of it worded by `word`."""
        return f"{self.field}: missing; {worded(self.bound, word)}"


class CoreSection(Section):
    """A table of a file from which an object of the package is made; what that refuses is a mistake in it."""

    @cached_property
    def core(self) -> Any:
        """Make the core object."""
        raise NotImplementedError

    @model_validator(mode="after")
    def _core_accepts(self) -> CoreSection:
        with np.errstate(all="ignore"):  # numpy's warnings would not help a person who mistyped an exponent
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
        # With or without the byte order mark that some editors prepend.
        return file.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise ConfigError(str(path), ["there is no such file; check the name and the folder"]) from None
    except OSError as error:
        raise ConfigError(str(path), [f"it cannot be read ({error.strerror}); give a TOML file"]) from None
    except ValueError:  # the content is not UTF-8, or the name is none that a file can have
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
        Tables, as tomllib reads them.
    source : str
        Name of their origin, for messages.

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
_LONGEST_KEY = 60  # length of the longest key that a message shows whole
_WORDS = {
    "bool_type": "give true or false",
    "dict_type": "give a table",
    "list_type": "give a list in brackets",
    "model_type": "give a table with keys",
}


def _mistake(model: type[BaseModel], error: ErrorDetails) -> tuple[str, str]:
    """Write one mistake as a sentence, and return the path of the input that it is about."""
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
    """Say which table to give, with its required keys if it is of one kind; "" if no table is missing."""
    keys = [each for each in known if each.path.startswith(f"{path}.")]
    needed = [each.name for each in keys if each.required and each.path == f"{path}.{each.name}"]
    of_one_kind = needed and len({each.section for each in keys}) == 1
    with_keys = f" with {', '.join(needed)}" if of_one_kind else ""
    return f"give a table [{path}]{with_keys}" if keys else ""


def _refusal(model: type[BaseModel], place: str, path: str, reason: Any, given: Any) -> tuple[str, str]:
    """Write a refusal by the core with the file's keys and value; return sentence and path of the input."""
    if isinstance(reason, InvalidInput) and not reason.field:
        return say(replace(reason, field=place)), path
    if key := path_of(reason, [entry.path for entry in describe(model)], path):
        inner = _place_in(reason.field, key).removeprefix(path).lstrip(".")
        return said_of(reason, f"{place}.{inner}".lstrip("."), _found(given, inner)), key
    said = say(in_millimetres(reason) if isinstance(reason, InvalidValue) else reason)
    return f"{place}: {said}" if place else said, path


def _place_in(field: str, key: str) -> str:
    """Return the path of an input, with the end of a core field's name that it lacks: ".values[1]"."""
    parts = (field.removeprefix(name) for name in _wholes(field) if f".{key}".endswith(f".{name}"))
    if (part := next(parts, None)) is not None:
        return key + part
    return key.removesuffix(_without_indices(field)) + field


def _wholes(field: str) -> Iterator[str]:
    """Yield a field and the wholes it is part of: "width.values[1]", "width.values" and "width"."""
    yield field
    if (cut := max(field.rfind("."), field.rfind("["))) > 0:
        yield from _wholes(field[:cut])


def _found(given: Any, place: str) -> Any:
    """Return the entry at a place of a table, such as "width.values[1]"; None if there is nothing."""
    for key, index in re.findall(r"([^.\[\]]+)|\[(\d+)\]", place):
        try:
            given = given[int(index) if index else key]
        except (KeyError, IndexError, TypeError):
            return None
    return given


@contextmanager
def in_words_of_file(model: type[BaseModel], tables: Mapping[str, Any], source: str) -> Iterator[None]:
    """Reword refusals by the core of values that a file gives: with the key, and the value as written.

    Raises
    ------
    ConfigError
        In place of an `InvalidValue` about one of the inputs of a model; others are raised as they are.
    """
    try:
        yield
    except InvalidValue as error:
        if not (key := path_of(error, [entry.path for entry in describe(model)])):
            raise
        raise ConfigError(source, [said_of(error, key, _found(tables, key))], [key]) from None


def said_of(refusal: InvalidValue, place: str, given: Any) -> str:
    """Write a refusal by the core, with the place in a file and the value as the file has it."""
    kind = type(refusal) if isinstance(refusal, InvalidInput | MissingValue) else InvalidInput
    said: dict[str, Any] = vars(refusal if given is not None else in_millimetres(refusal)) | {"field": place}
    return say(_as_written(kind(**said), given))


def _as_written(refusal: InvalidValue, given: Any) -> InvalidValue:
    """Return the refusal with the value as the file writes it, and the limit in the same unit."""
    value, unit = refusal.value, refusal.unit
    if isinstance(given, list) and isinstance(value, tuple | list):
        return replace(refusal, value=given)
    if not isinstance(given, str) or not isinstance(value, float):
        return refusal
    try:
        if not math.isclose(abs(quantity(given, unit)), abs(value), rel_tol=1e-9):
            return refusal  # the refusal is about another number, which was computed from the one in the file
    except InvalidInput:  # other units, such as a length that stands for a fraction
        return replace(refusal, value=given)
    return replace(refusal.in_unit(*unit_as_written(given, unit)), value=given)


def _without_indices(field: str) -> str:
    """Return a field without indices, as inputs are described: "point_mass.mass" for "point_mass[0].mass"."""
    return re.sub(r"\[\d+\]", "", field)


def path_of(error: Exception, paths: Iterable[str], table: str = "") -> str:
    """Return the path of the input that an error of the core is about; empty if there is no single one.

    Parameters
    ----------
    error : Exception
        The error; only an `InvalidValue` names its argument.
    paths : iterable of str
        Paths of inputs.
    table : str
        Path of the table in which the input is looked for.
    """
    field = error.field if isinstance(error, InvalidValue) else ""
    paths = list(paths)
    names = (*_wholes(field), _without_indices(field))
    return next(filter(None, (_path_ending(name, paths, table) for name in names)), "")


def _path_ending(field: str, paths: list[str], table: str) -> str:
    """Return the only path within a table that ends with a field; empty if there are none or several."""
    exact = f"{table}.{field}".lstrip(".")
    ends = {path for path in paths if field and f".{path}".endswith(f".{field}")}
    inside = {path for path in ends if path.startswith(table and f"{table}.")}
    return exact if exact in inside else inside.pop() if len(inside) == 1 else ""


def _path(loc: Iterable[int | str], indices: bool = True) -> str:
    """Return a TOML path; pydantic's tags of alternatives, in angle brackets, are left out."""
    keys = (part for part in loc if not str(part).startswith("<"))
    parts = [f".{key}" if isinstance(key, str) else f"[{key}]" * indices for key in keys]
    return "".join(parts).removeprefix(".")


def _unknown(model: type[BaseModel], loc: tuple[int | str, ...]) -> str:
    """Describe an unknown key: where it belongs, or the nearest known key, or all known ones."""
    table, key, known = _path(loc[:-1], indices=False), str(loc[-1]), describe(model)
    prefix = table and f"{table}."  # empty at the top level, so that every key begins with it
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
