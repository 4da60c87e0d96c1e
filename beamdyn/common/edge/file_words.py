"""Sentences of the core in the terms of files and commands; a module without slow imports."""

from __future__ import annotations

import re

_COMMANDS = {"equilibrium_branches": "beamdyn branches", "frequency_locus": "beamdyn locus"}
_PHYSICS = re.compile(r"Physics\((.*?)\)")


def as_in_files(sentence: str) -> str:
    """A sentence of the core, written in Python's terms, in the terms of files and commands.

    "Physics(shear=True)" becomes "[physics] shear = true", and a function the command that does the same.
    """
    for function, command in _COMMANDS.items():
        sentence = sentence.replace(function, command)
    return _PHYSICS.sub(lambda call: f"[physics] {_as_keys(call[1])}", sentence)


def _as_keys(arguments: str) -> str:
    """Keyword arguments as keys of TOML."""
    return re.sub(r"=(\S)", r" = \1", arguments).replace("True", "true").replace("'", '"')
