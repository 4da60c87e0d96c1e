"""Conversion of this package's dataclasses to JSON values and back; read-only arrays; hashes of data.

An object made again from JSON values equals the original to the last bit.  Numbers, strings, statements,
arrays, containers, dataclasses and named tuples of this package can be converted.  Anything else (a function,
an object of another package's class) is not stored; the object made again has a `LeftOut` in its place.
"""

from __future__ import annotations

import base64
import dataclasses
import hashlib
import pickle
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from itertools import chain
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

import numpy as np

from beamdyn.common.words import Words


class FieldsOnly:
    """Base of dataclasses that are pickled with their fields only, without cached properties."""

    def __reduce__(self) -> tuple[type, tuple[Any, ...]]:
        fields = dataclasses.fields(self)  # pyright: ignore[reportArgumentType]  (subclasses are dataclasses)
        return type(self), tuple(getattr(self, f.name) for f in fields)


def make_read_only(value: Any) -> Any:
    """Return a read-only view of an array, or of each array in a container; return other values unchanged.

    In a dataclass, arrays in public fields are replaced by read-only views.
    """
    if isinstance(value, np.ndarray):
        view = value.view()
        view.setflags(write=False)
        return view
    if type(value) is tuple and any(map(_may_hold_arrays, value)):
        return tuple(map(make_read_only, value))
    if type(value) is dict:
        return {key: make_read_only(item) for key, item in value.items()}
    for name in _public_fields(type(value)):
        held = getattr(value, name)
        # The arrays of a nested result are read-only already.
        if not isinstance(held, ReadOnlyArrays) and (viewed := make_read_only(held)) is not held:
            object.__setattr__(value, name, viewed)
    return value


@cache
def _public_fields(kind: type) -> tuple[str, ...]:
    """List the names of the public fields of a dataclass, keyword-only ones last; empty for other classes."""
    every = dataclasses.fields(kind) if dataclasses.is_dataclass(kind) else ()
    return tuple(f.name for f in sorted(every, key=lambda f: f.kw_only is True) if f.repr)


def _may_hold_arrays(value: Any) -> bool:
    return isinstance(value, np.ndarray | tuple | dict) or dataclasses.is_dataclass(value)


class ReadOnlyArrays:
    """Base of frozen dataclasses whose public fields hold read-only arrays.

    The fields are read-only views, so that arrays that other objects share stay writable.
    """

    __post_init__ = make_read_only

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        make_read_only(self)


# JSON values ----------------------------------------------------------------------------------------


def plain(value: Any) -> Any:
    """Convert a value to JSON types; complex numbers become pairs; inf and nan stay."""
    if isinstance(value, np.ndarray):
        value = np.stack([value.real, value.imag], axis=-1) if np.iscomplexobj(value) else value
        return value.tolist()
    if isinstance(value, np.generic):
        return plain(value.item())
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {name: plain(getattr(value, name)) for name in _public_fields(type(value))}
    if isinstance(value, tuple | list):
        return [plain(v) for v in value]
    if isinstance(value, dict):
        return {str(key): plain(v) for key, v in value.items()}
    if isinstance(value, complex):
        return [value.real, value.imag]
    return value


def nullified(value: Any) -> Any:
    """Replace numbers that are not finite, which JSON does not have, by None."""
    if isinstance(value, dict):
        return {key: nullified(v) for key, v in value.items()}
    if isinstance(value, list):
        return [nullified(v) for v in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value


_ADDED = "added"
ADDED_LATER = {_ADDED: True}  # metadata of fields that older files lack; loading sets them to their defaults
# Packages whose classes a saved file may name.  In objects of these classes, `fingerprint` ignores the fields
# that do not affect equality.
_PACKAGES = ("beamdyn", "brakes")


class LeftOut:
    """Placeholder for a part of a loaded object that the file does not hold; its use raises a ValueError.

    Parameters
    ----------
    what : str
        Name of the missing part.
    """

    def __init__(self, what: str) -> None:
        self.what = what

    def __repr__(self) -> str:
        return f"<left out: {self.what}>"

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__") or name == "what":  # names that Python itself looks up
            raise AttributeError(name)
        self()

    def __call__(self, *arguments: object, **options: object) -> Any:
        """Raise the ValueError that names the missing part."""
        raise ValueError(
            f"the file does not hold {self.what}, which cannot be saved; compute the result again to use it"
        )


def encode(value: Any) -> Any:
    """Convert an object to JSON values, from which `decode` can make an equal object.

    Parameters
    ----------
    value : object
        None, a number, string, array, slice or container, or a dataclass or named tuple of this package.

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
    """Make an object again from the JSON values that `encode` returned.

    Raises
    ------
    ValueError
        If `value` names a class that this version does not have, or whose fields differ.
    """
    if not isinstance(value, dict):
        return value
    ((kind, content),) = value.items()
    return _DECODERS[kind](content)


def _decode_object(content: list[Any]) -> Any:
    """Make an object with its stored fields, without the checks of its constructor."""
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
    """Return the fields, with their defaults, that files of earlier versions may lack."""
    every = dataclasses.fields(kind) if dataclasses.is_dataclass(kind) else ()
    given = (f for f in every if f.default is not dataclasses.MISSING)
    return {f.name: f.default for f in given if not f.compare or _ADDED in f.metadata}


def _name(kind: type) -> str:
    return f"{kind.__module__}:{kind.__qualname__}"


def _find_class(name: str) -> Any:
    """Return the class with a given name; if its module has moved, search the package for the class."""
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
    """Yield the modules of a package whose source code defines a class of a given name."""
    folder = Path(__file__).parents[3] / package
    for file in sorted(folder.rglob("*.py")):
        if f"\nclass {kind}(" in (text := file.read_text(encoding="utf-8")) or f"\nclass {kind}:" in text:
            yield ".".join(file.relative_to(folder.parent).with_suffix("").parts)


# Hashes of data --------------------------------------------------------------------------------------


def fingerprint(*values: object) -> str:
    """Compute a hash of values, the same in every process, and different if a single bit differs.

    Parameters
    ----------
    *values : object
        Values to hash.  Numbers, strings, arrays, containers and dataclasses of them are hashed by content,
        functions by name and code, anything else by its pickle.  Fields of this package's dataclasses that do
        not affect equality, such as a label, are ignored; other functions and variables that a function uses
        are hashed by name only.

    Returns
    -------
    str
        32 hexadecimal digits.

    Raises
    ------
    ValueError
        If a value cannot be pickled.
    """
    digest = hashlib.sha256()
    for piece in _pieces(values):
        digest.update(len(piece).to_bytes(8, "big") + piece)
    return digest.hexdigest()[:32]


def _pieces(value: Any) -> Iterator[bytes]:
    """Yield a value as bytes, which differ for different values."""
    value = value.item() if isinstance(value, np.generic) else value
    yield f"{type(value).__module__}.{type(value).__qualname__}".encode()
    if isinstance(value, float):
        yield value.hex().encode()
    elif value is None or isinstance(value, int | str | bytes):
        yield repr(value).encode()
    elif isinstance(value, np.ndarray) and value.dtype != object:
        yield f"{value.dtype.str} {value.shape}".encode()
        yield value.tobytes()
    elif isinstance(value, FunctionType):
        yield f"{value.__module__}.{value.__qualname__}".encode()
        yield from _code(value.__code__)
        yield from _pieces((value.__defaults__, value.__kwdefaults__))
    else:
        parts = _parts(value)
        yield str(len(parts)).encode()
        for part in parts:
            yield from _pieces(part)


def _parts(value: Any) -> list[Any]:
    """Return the items of a container; for any other value, its pickle."""
    if isinstance(value, list | tuple):
        return list(value)
    if isinstance(value, dict):
        return [*value, *value.values()]
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        ours = type(value).__module__.partition(".")[0] in _PACKAGES
        return [getattr(value, f.name) for f in dataclasses.fields(value) if f.compare or not ours]
    try:
        return [pickle.dumps(value, protocol=4)]
    except Exception as error:  # the class of the exception depends on the object
        raise ValueError(f"{value!r} cannot be stored: it cannot be pickled ({error})") from None


def _code(code: CodeType) -> Iterator[bytes]:
    """Yield the code of a function as bytes, which do not depend on its position in the source file."""
    yield code.co_code
    yield repr(code.co_names).encode()
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _code(constant)
        else:
            yield repr(sorted(map(repr, constant)) if isinstance(constant, frozenset) else constant).encode()
