"""Rewording of error messages, whose values are in SI units, in terms of the command that was typed."""

from __future__ import annotations

from dataclasses import is_dataclass, replace
from itertools import chain, pairwise

from cyclopts import CycloptsError
from numpy.linalg import LinAlgError

from beamdyn.common.edge.file_words import TYPED, say, word
from beamdyn.common.edge.inputs import in_unit_of
from beamdyn.common.edge.units import InvalidInput, last_quantity
from beamdyn.common.inputs.checks import InvalidValue, NoModelAnswer, reason_of

# Options whose name differs from the argument of the package that they set.
_ELSEWHERE = {
    "combine": "--together",
    "psd.values": "--psd, values",
    "psd.frequencies": "--psd, frequencies",
    "scene.motion": "[motion]",
    "damping_ratio": "[model] damping_ratio",
    "road.lowest": "lowest spatial frequency of a road",
    "road.highest": "--highest",
    "operating[0]": "--operating",
    "operating[1]": "--operating",
    "position": "position after @",
    "exponent": "--woehler",
    "t_end": "--window",
}
_PHYSICS = "physics."
_USUAL = {"rad": "1 deg"}  # by SI unit: a text with the unit of messages about values that were not typed


def is_no_answer(error: Exception) -> bool:
    """Return whether an error means that the model has no solution, as for a singular linear system."""
    return isinstance(error, ArithmeticError | NoModelAnswer | LinAlgError)


def as_typed(error: Exception) -> str:
    """Return an error message with the typed options and keys, and numbers in the typed units.

    "tolerance = 5: give ..." becomes "--tolerance = 5: give ..." if the command has this option.
    """
    if isinstance(error, LinAlgError):
        return f"{error}; check the size of each value"
    if not isinstance(error, InvalidValue):
        return reason_of(error) if isinstance(error, ArithmeticError) else say(error)
    name = _name(error.field)
    text = _text_of(name)
    named = replace(error, field=name, other=_name(error.other))
    if error.field == "combine" or (error.field == "scene.motion" and error.value):
        return f"{name}: {named.advice(word)}"  # omits the value, which differs from the typed one
    if error.field == "scene.motion":
        return f"{name}: missing: {named.advice(word)}"
    if isinstance(error.value, float) and error.unit:
        named = in_unit_of(named, text or _USUAL.get(error.unit, ""))
    elif text and _says_more(text, error.value):
        named = replace(named, value=text)
    written = isinstance(named.value, bool) or (name.startswith("-") and isinstance(named.value, str))
    return say(InvalidInput(**vars(named)) if written else named)


def _says_more(text: str, value: object) -> bool:
    """Return whether a typed text says more than the value read from it: a unit, or an object's name."""
    if isinstance(value, float | int):
        return text == last_quantity(text) != f"{value:g}"
    return isinstance(value, tuple) or is_dataclass(value)


def _name(field: str) -> str:
    """Return the option or key of the running command that sets an argument of the package."""
    option = f"--{field.replace('_', '-')}"
    if field.startswith(_PHYSICS):
        return f"[physics] {field.removeprefix(_PHYSICS)}"
    return option if option in _options() else _ELSEWHERE.get(field, field)


def _text_of(name: str) -> str:
    """Return the text typed for an option or a varied input; empty if there is none."""
    typed = TYPED.get()
    arguments = [] if typed is None else [str(each) for each in typed[1]]
    after = (text for before, text in pairwise(arguments) if before == name)
    parts = (each.partition("=") for each in arguments)  # keys may be abbreviated if unambiguous
    joined = (text for key, _, text in parts if text and f".{name}".endswith(f".{key.strip()}"))
    return next(chain(after, joined), "")


def _options() -> set[str]:
    """Return the options of the running command; empty outside a command."""
    if (typed := TYPED.get()) is None:
        return set()
    app, arguments = typed
    try:
        _, apps, _ = app.parse_commands(arguments)
        return {name for each in apps[-1].assemble_argument_collection() for name in each.names}
    except (CycloptsError, ValueError):
        return set()
