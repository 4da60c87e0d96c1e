"""Objects as values of JSON's types: for reading, and to make them again, equal to the bit.

Numbers, strings, statements, arrays, containers, dataclasses and named tuples of this package are data.
Anything else (a function, an object of another package's class) is left out; in the object that is made
again, a `LeftOut` takes its place.
"""

from __future__ import annotations

import base64
import dataclasses
from collections.abc import Iterator
from importlib import import_module
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from beamdyn.common.words import Words


def plain(value: Any) -> Any:
    """Convert a value to JSON's types; complex numbers become pairs, and numbers that are not finite stay."""
    if isinstance(value, np.ndarray):
        value = np.stack([value.real, value.imag], axis=-1) if np.iscomplexobj(value) else value
        return value.tolist()
    if isinstance(value, np.generic):
        return plain(value.item())
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {f.name: plain(getattr(value, f.name)) for f in dataclasses.fields(value) if f.repr}
    if isinstance(value, tuple | list):
        return [plain(v) for v in value]
    if isinstance(value, dict):
        return {str(key): plain(v) for key, v in value.items()}
    if isinstance(value, complex):
        return [value.real, value.imag]
    return value


def nullified(value: Any) -> Any:
    """Replace numbers that are not finite, which JSON does not have, by null."""
    if isinstance(value, dict):
        return {key: nullified(v) for key, v in value.items()}
    if isinstance(value, list):
        return [nullified(v) for v in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value


_ADDED = "added"
ADDED_LATER = {_ADDED: True}  # metadata of a field that earlier files lack, for which its default holds
_PACKAGES = ("beamdyn", "brakes")  # packages whose classes may be named in a file


class LeftOut:
    """Placeholder of a part of an object that its file does not hold; using it raises a ValueError.

    Parameters
    ----------
    what : str
        The part.
    """

    def __init__(self, what: str) -> None:
        self.what = what

    def __repr__(self) -> str:
        return f"<left out: {self.what}>"

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__") or name == "what":  # attributes that Python itself looks for
            raise AttributeError(name)
        self()

    def __call__(self, *arguments: object, **options: object) -> Any:
        """Raise the ValueError that names the part that the file does not hold."""
        raise ValueError(
            f"the file does not hold {self.what}, which cannot be saved; compute the result again to use it"
        )


def encode(value: Any) -> Any:
    """Represent an object by values of JSON's types.

    Parameters
    ----------
    value : object
        None, number, string, array, slice, container, or dataclass or named tuple of this package.

    Returns
    -------
    object
        The value itself, or a dictionary with one key that names its type.
    """
    if isinstance(value, np.generic):
        return encode(value.item())
    if isinstance(value, Words):
        return {"words": [_name(type(value)), *map(encode, value.arguments())]}
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, float):
        return value if np.isfinite(value) else {"float": str(value)}
    if isinstance(value, np.ndarray) and value.dtype.kind in "biufcU":
        return {"array": [value.dtype.str, list(value.shape), base64.b64encode(value.tobytes()).decode()]}
    if isinstance(value, complex | slice):
        return {type(value).__name__: [encode(part) for part in _PARTS[type(value)](value)]}
    kind: Any = type(value)
    if _is_known(kind):
        return {"object": [_name(kind), {name: encode(getattr(value, name)) for name in _fields(kind)}]}
    if isinstance(value, tuple | list):
        return {"list" if isinstance(value, list) else "tuple": [encode(item) for item in value]}
    if isinstance(value, dict) and all(isinstance(key, str) for key in value):
        return {"dict": {key: encode(item) for key, item in value.items()}}
    name = getattr(value, "__qualname__", "") or type(value).__qualname__
    return {"left out": f"{name} of {getattr(value, '__module__', None) or type(value).__module__}"}


_PARTS: dict[type, Any] = {complex: lambda z: (z.real, z.imag), slice: lambda s: (s.start, s.stop, s.step)}


def decode(value: Any) -> Any:
    """Make the object that `encode` represented.

    Raises
    ------
    ValueError
        If `value` names a class that this version does not have, or that has other fields.
    """
    if not isinstance(value, dict):
        return value
    ((kind, content),) = value.items()
    return _DECODERS[kind](content)


def _decode_object(content: list[Any]) -> Any:
    """Make an object with its fields as they were, without the checks of its construction."""
    name, values = content
    kind = _find_class(name)
    optional = _defaults(kind)
    if not {*values} <= {*_fields(kind)} <= {*values, *optional}:
        raise ValueError(f"in this version {kind.__name__} has other fields")
    if issubclass(kind, tuple):
        return kind(*(decode(values[name]) for name in _fields(kind)))
    made = object.__new__(kind)
    for key, item in (optional | {key: decode(item) for key, item in values.items()}).items():
        object.__setattr__(made, key, item)
    return made


_DECODERS: dict[str, Any] = {
    "float": float,
    "complex": lambda parts: complex(*map(decode, parts)),
    "slice": lambda parts: slice(*map(decode, parts)),
    "array": lambda it: np.frombuffer(base64.b64decode(it[2]), dtype=it[0]).reshape(it[1]).copy(),
    "tuple": lambda items: tuple(map(decode, items)),
    "list": lambda items: [*map(decode, items)],
    "dict": lambda items: {key: decode(item) for key, item in items.items()},
    "object": _decode_object,
    "words": lambda it: _find_class(it[0])(*decode(it[1]), **decode(it[2])),
    "left out": LeftOut,
}


def _is_known(kind: type) -> bool:
    has_fields = dataclasses.is_dataclass(kind) or hasattr(kind, "_fields") or issubclass(kind, Words)
    return has_fields and kind.__module__.partition(".")[0] in _PACKAGES


def _fields(kind: Any) -> tuple[str, ...]:
    named: tuple[str, ...] | None = getattr(kind, "_fields", None)
    return tuple(f.name for f in dataclasses.fields(kind)) if named is None else named


def _defaults(kind: Any) -> dict[str, Any]:
    """Return the fields of a dataclass that a file of an earlier version may lack, with their defaults."""
    every = dataclasses.fields(kind) if dataclasses.is_dataclass(kind) else ()
    given = (f for f in every if f.default is not dataclasses.MISSING)
    return {f.name: f.default for f in given if not f.compare or _ADDED in f.metadata}


def _name(kind: type) -> str:
    return f"{kind.__module__}:{kind.__qualname__}"


def _find_class(name: str) -> Any:
    """Return the class of a name; if its module has moved, search the package for the class."""
    module, _, kind = name.partition(":")
    package = module.partition(".")[0]
    for place in chain((module,), _modules_that_define(kind, package)) if package in _PACKAGES else ():
        try:
            found = getattr(import_module(place), kind)
        except (ImportError, AttributeError):
            continue
        if isinstance(found, type) and _is_known(found):
            return found
    raise ValueError(f"this version has no class {kind} in {module}")


def _modules_that_define(kind: str, package: str) -> Iterator[str]:
    """Yield the modules of a package whose source defines a class of a name."""
    folder = Path(__file__).parents[3] / package
    for file in sorted(folder.rglob("*.py")):
        if f"\nclass {kind}(" in (text := file.read_text(encoding="utf-8")) or f"\nclass {kind}:" in text:
            yield ".".join(file.relative_to(folder.parent).with_suffix("").parts)
