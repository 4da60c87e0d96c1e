"""Sentences of the core in the terms of files and commands; a module without slow imports."""

from __future__ import annotations

import re

_COMMANDS = {"equilibrium_branches": "beamdyn branches", "frequency_locus": "beamdyn locus"}
_BEAM = {
    "Beam.from_stiffness": "mass_per_length and bending_stiffness in [beam]",
    "Beam.rectangular": "width and thickness in [beam]",
    "the last station must be 1, the tip": "the last station must be the tip, at 1 or the beam's length",
}
_FRACTIONS = re.compile(r"give fractions x/L( between 0 and 1, ends excluded)?")
_PHYSICS = re.compile(r"Physics\((.*?)\)")


def as_in_files(sentence: str) -> str:
    """A sentence of the core, written in Python's terms, in the terms of files and commands.

    "Physics(shear=True)" becomes "[physics] shear = true", a function the command that does the same, and
    what makes a beam the keys that do.
    """
    for function, command in (_COMMANDS | _BEAM).items():
        sentence = sentence.replace(function, command)
    sentence = _FRACTIONS.sub(r"give fractions x/L\1, or lengths with their unit", sentence)
    return _PHYSICS.sub(lambda call: f"[physics] {_as_keys(call[1])}", sentence)


def _as_keys(arguments: str) -> str:
    """Keyword arguments as keys of TOML."""
    return re.sub(r"=(\S)", r" = \1", arguments).replace("True", "true").replace("'", '"')
