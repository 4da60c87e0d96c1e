"""List of the terms of the equations of motion: which are present in a scene, and why."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import reduce
from time import perf_counter

import numpy as np

from beamdyn._version import __version__
from beamdyn.common.results import Provenance, Result
from beamdyn.equations.equations_of_motion import assemble_equations
from beamdyn.equations.explanations import Explanation, SampledScene
from beamdyn.equations.fields import FIELDS
from beamdyn.equations.fields.field import Load, Term
from beamdyn.equations.ritz import Ritz
from beamdyn.scene.motion import Line
from beamdyn.scene.scene import Scene, check_scene

_BASIS = Ritz(3)  # the list of terms does not depend on the basis


@dataclass(frozen=True)
class Entry:
    """One term of the equations.

    Parameters
    ----------
    name : str
        Name of the term.
    symbol : str
        The term as written in docs/conventions.md.
    quantity : str
        The quantity of the root's motion that multiplies it.
    largest : float
        Largest absolute value of its coefficient over the motion [SI units]; 0 if it is absent.
    present : bool
        Whether the term is present in the scene.
    reason : str
        Why the term is present or absent.
    """

    name: str
    symbol: str
    quantity: str
    largest: float
    present: bool
    reason: str


@dataclass(frozen=True)
class Terms(Result):
    """Terms of the equations of motion, present or absent in a scene; iterable, and prints as a table.

    Parameters
    ----------
    entries : tuple of Entry
        All terms of all fields.
    lines : tuple of Line
        Frequencies that translation and gravity excite, as multiples of the speed.
    provenance : Provenance
        Program version, discretization and computing time.
    """

    entries: tuple[Entry, ...]
    lines: tuple[Line, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)

    def __iter__(self) -> Iterator[Entry]:
        return iter(self.entries)

    def __len__(self) -> int:
        return len(self.entries)

    def __getitem__(self, name: str) -> Entry:
        return next(entry for entry in self.entries if entry.name == name)

    @property
    def present(self) -> tuple[str, ...]:
        """Names of the terms that are present in the scene."""
        return tuple(entry.name for entry in self if entry.present)

    def rows(self) -> list[tuple[str, str, str, str, str]]:
        """Rows of the table: presence, name, symbol, largest coefficient, reason."""
        return [
            ("in" if e.present else "-", e.name, e.symbol, f"{e.largest:.4g}" if e.present else "", e.reason)
            for e in self
        ]

    def excited(self) -> str:
        """Describe the excitation lines in a sentence."""
        names = ", ".join(f"{line.name} at {line.multiple:.6g} times the speed" for line in self.lines)
        return f"Lines: {names or 'none'}."

    def __str__(self) -> str:
        rows = [("", "term", "symbol", "largest", "reason"), *self.rows()]
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        cells = [[c.ljust(w) for c, w in zip(row, widths, strict=True)] for row in rows]
        return "\n".join(["  ".join(row).rstrip() for row in cells] + [self.excited()])


def terms(scene: Scene) -> Terms:
    """List every term of the equations of motion, whether it is present in a scene, and why.

    A term is present if it is assembled and its coefficient does not vanish throughout the motion.

    Parameters
    ----------
    scene : Scene
        The scene; without a motion, steady rotation at 1 rad/s is assumed.

    Returns
    -------
    Terms
    """
    start = perf_counter()
    check_scene(scene)
    sampled, assembled = SampledScene(scene), {term.name: term for term in _list_terms(scene)}
    complete = reduce(lambda scene, field: field.complete(scene), FIELDS, scene)
    entries = tuple(_describe(t, assembled.get(t.name), sampled) for t in _list_terms(complete))
    lines = scene.motion.lines if scene.motion is not None else ()
    gravity = (Line("gravity", 1.0),) if scene.gravity else ()
    provenance = Provenance(__version__, str(_BASIS), "", perf_counter() - start)
    return Terms(entries, (*lines, *gravity), provenance, scene)


def _list_terms(scene: Scene) -> tuple[Term | Load, ...]:
    equations = assemble_equations(scene, _BASIS)
    return (*equations.terms, *equations.loads)


def _describe(term: Term | Load, assembled: Term | Load | None, scene: SampledScene) -> Entry:
    """Describe a term, given as it is assembled for the scene; None if it is not."""
    largest = 0.0 if assembled is None else float(np.abs(assembled.coefficient(scene.root)).max())
    explanation = _EXPLANATIONS.get(term.name, Explanation(term.name, "it is assembled"))
    sentence = explanation.sentence(scene, present=bool(largest))
    return Entry(term.name, explanation.symbol, _QUANTITY[term.quantity], largest, bool(largest), sentence)


_EXPLANATIONS = {name: text for field in FIELDS for name, text in field.explanations.items()}

_QUANTITY = {
    "unity": "1",
    "speed": "speed [rad/s]",
    "acceleration": "angular acceleration [rad/s2]",
    "speed_squared": "speed squared [rad2/s2]",
    "root_axial": "root acceleration along the beam [m/s2]",
    "root_transverse": "root acceleration in the direction of bending [m/s2]",
}
