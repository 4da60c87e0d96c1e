"""Files with units: TOML in, core objects out, all mistakes in one message."""

from __future__ import annotations

import difflib
import re
import tomllib
from collections.abc import Mapping, Sequence
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from pydantic import BaseModel, ValidationError, model_validator
from pydantic_core import ErrorDetails

from beamdyn.common.edge.inputs import Section, describe
from beamdyn.common.edge.units import show

Model = TypeVar("Model", bound=BaseModel)


class ConfigError(ValueError):
    """A file that does not describe what it should.

    Parameters
    ----------
    source : str
        Name of the file, or what stands for it.
    mistakes : sequence of str
        One sentence each: the key's path, the value, what is wrong and the remedy.
    """

    def __init__(self, source: str, mistakes: Sequence[str]) -> None:
        self.source, self.mistakes = source, tuple(mistakes)
        one = len(mistakes) == 1
        head = f"{source}: " if one else f"{source}: {len(mistakes)} mistakes\n  "
        super().__init__(head + "\n  ".join(mistakes))

    def __reduce__(self) -> tuple[type, tuple[str, tuple[str, ...]]]:
        return type(self), (self.source, self.mistakes)


class CoreSection(Section):
    """A table that stands for a core object; what the core refuses is a mistake in the table."""

    @cached_property
    def core(self) -> Any:
        """The core object."""
        raise NotImplementedError

    @model_validator(mode="after")
    def _core_accepts(self) -> CoreSection:
        with np.errstate(all="ignore"):  # a warning of numpy would be no answer to a mistyped exponent
            self.core  # noqa: B018
        return self


def read(path: str | PathLike[str]) -> str:
    """Text of a file.

    Raises
    ------
    ConfigError
        If it cannot be read; the message says why.
    """
    try:
        return Path(path).read_text(encoding="utf-8")
    except FileNotFoundError:
        raise ConfigError(str(path), ["there is no such file; check the name and the folder"]) from None
    except OSError as error:
        raise ConfigError(str(path), [f"it cannot be read ({error.strerror}); give a TOML file"]) from None
    except ValueError:  # not UTF-8, or a name that no file can have
        raise ConfigError(str(path), ["it is not text in UTF-8; give a TOML file"]) from None


def parse(text: str, source: str) -> dict[str, Any]:
    """Tables of TOML text.

    Raises
    ------
    ConfigError
        If it is not TOML.
    """
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        remedy = 'a quantity stands in quotes: length = "50 mm"'
        raise ConfigError(source, [f"not valid TOML: {error}; {remedy}"]) from None


def validated(model: type[Model], data: Mapping[str, Any], source: str) -> Model:
    """The model that tables describe.

    Parameters
    ----------
    model : type of BaseModel
        What they should describe.
    data : mapping
        Tables, as tomllib reads them.
    source : str
        Name of their origin, for messages.

    Raises
    ------
    ConfigError
        If they do not describe it; the message lists all mistakes.
    """
    try:
        return model.model_validate(dict(data))
    except ValidationError as error:
        mistakes = [_sentence(model, e) for e in error.errors(include_url=False)]
        raise ConfigError(source, list(dict.fromkeys(mistakes))) from None


_WORDS = {
    "bool_type": "give true or false",
    "dict_type": "give a table",
    "list_type": "give a list in brackets",
    "model_type": "give a table with keys",
    "too_short": "give at least one value",
}


def _sentence(model: type[BaseModel], error: ErrorDetails) -> str:
    """What is wrong in one place: path, value, remedy."""
    path, value = _path(error["loc"]), show(error["input"])
    match error["type"]:
        case "missing":
            return f"{path}: missing; {_how_to_give(model, path)}"
        case "extra_forbidden":
            path = f"{_path(error['loc'][:-1])}.{error['loc'][-1]}".removeprefix(
                "."
            )  # whatever it begins with
            return f"{path}: unknown key; {_nearest(model, path)}"
        case "value_error":
            reason = str(error.get("ctx", {}).get("error"))
            return f"{path} = {reason}" if reason.startswith(value) else f"{path or 'model'}: {reason}"
        case "kind":
            return f"{path}.kind = {show(error['input']['kind'])}: {error['msg']}"
        case "literal_error":
            return f"{path} = {value}: give {error.get('ctx', {}).get('expected')}"
    return f"{path} = {value}: {_WORDS.get(error['type'], error['msg'])}"


def _path(loc: tuple[int | str, ...]) -> str:
    """The place as a TOML path; tags of alternatives, in angle brackets, are no keys."""
    parts = [f"[{p}]" if isinstance(p, int) else f".{p}" for p in loc if not str(p).startswith("<")]
    return "".join(parts).removeprefix(".")


def _how_to_give(model: type[BaseModel], path: str) -> str:
    inputs, path = describe(model), _without_indices(path)
    if any(i.path.startswith(f"{path}.") for i in inputs):
        return f"give a table [{path}]"
    return next((f"give the {i.help}" for i in inputs if i.path == path), "give as many values as stations")


def _nearest(model: type[BaseModel], path: str) -> str:
    """The known key that resembles an unknown one most, or all that are known."""
    parent, _, key = _without_indices(path).rpartition(".")
    prefix = parent and f"{parent}."
    known = [
        i.path.removeprefix(prefix).partition(".")[0] for i in describe(model) if i.path.startswith(prefix)
    ]
    known = list(dict.fromkeys(known)) or ["polynomial", "stations", "values"]
    if key in known and (kinds := _kinds_with(model, parent, key)):
        return f"it goes with kind = {' or '.join(kinds)}"
    near = difflib.get_close_matches(key, known, n=1)
    return f"did you mean {near[0]}?" if near else f"known are {', '.join(known)}"


def _without_indices(path: str) -> str:
    """The path of an item of a list as descriptions have it."""
    return re.sub(r"\[\d+\]", "", path)


def _kinds_with(model: type[BaseModel], table: str, key: str) -> list[str]:
    """The kinds of a table that has alternatives, in quotes, of those that know a key."""
    kinds = (i for i in describe(model) if i.path == f"{table}.kind")
    return [show(i.choices[0]) for i in kinds if key in i.section.model_fields]
