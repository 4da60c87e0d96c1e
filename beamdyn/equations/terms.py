"""List of the terms of the equations of motion: which are present in a scene, and why."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import reduce
from time import perf_counter

import numpy as np

from beamdyn.common.results.one_line import counted
from beamdyn.common.results.result import Provenance, Result
from beamdyn.equations.assembly import assemble_equations
from beamdyn.equations.effects import OmittedEffect, list_left_out
from beamdyn.equations.explanations import Explanation, SampledScene
from beamdyn.equations.fields import FIELDS
from beamdyn.equations.fields.field import Load, Term
from beamdyn.equations.ritz import Ritz
from beamdyn.scene.motion.base import Line
from beamdyn.scene.scene import Scene, check_scene

_BASIS = Ritz(3)  # any small basis, as the list of terms does not depend on the basis


@dataclass(frozen=True)
class Entry:
    """Term of the equations of motion, and why it is present in a scene or absent.

    Parameters
    ----------
    name : str
        Name of the term.
    symbol : str
        The term as written in docs/conventions.md, for one plane of bending.
    fields : tuple of str
        The fields whose equations contain the term.
    quantity : str
        The quantity of the root's motion that multiplies the term.
    largest : float
        Largest absolute value of the coefficient over the motion [SI units]; 0 if the term is absent.
    present : bool
        Whether the term is present in the scene.
    reason : str
        Why the term is present or absent.
    """

    name: str
    symbol: str
    fields: tuple[str, ...]
    quantity: str
    largest: float
    present: bool
    reason: str


@dataclass(frozen=True)
class Terms(Result):
    """Terms of the equations of motion, present or absent in a scene; iterable, prints as a table.

    Parameters
    ----------
    entries : tuple of Entry
        All terms of the fields that are modelled.
    left_out : tuple of OmittedEffect
        Effects that the model neglects, by name and reason.
    lines : tuple of Line
        Frequencies that translation and gravity excite, as multiples of the speed.
    provenance : Provenance
        Program version, discretization and computing time.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> found = bd.terms(bd.Scene(strip, bd.Mount(radius=0.215), bd.SteadyRotation(50.0)))
    >>> [entry.name for entry in found.entries][:3]
    ['mass', 'bending stiffness', 'root spring']
    """

    entries: tuple[Entry, ...]
    left_out: tuple[OmittedEffect, ...]
    lines: tuple[Line, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)

    def headline(self) -> Iterator[str]:
        """Yield the parts of the one-line summary of the terms; see `Result.headline`."""
        yield f"{len(self.present)} of {counted(len(self), 'term')} present"
        yield f"{counted(len(self.left_out), 'effect')} left out"
        yield counted(len(self.lines), "line")

    def __iter__(self) -> Iterator[Entry]:
        return iter(self.entries)

    def __len__(self) -> int:
        return len(self.entries)

    def __getitem__(self, name: str) -> Entry:
        found = {entry.name: entry for entry in self.entries}
        if name not in found:
            raise KeyError(f"{name!r} is no term of this model; its terms are {', '.join(found)}")
        return found[name]

    @property
    def present(self) -> tuple[str, ...]:
        """Names of the terms that are present in the scene."""
        return tuple(entry.name for entry in self if entry.present)

    def rows(self) -> list[tuple[str, str, str, str, str]]:
        """List the rows of the table: presence, name, symbol, largest coefficient, reason."""
        return [
            ("in" if e.present else "-", e.name, e.symbol, f"{e.largest:.4g}" if e.present else "", e.reason)
            for e in self
        ]

    def excited(self) -> str:
        """Describe in a sentence the lines: excited frequencies, as multiples of the speed."""
        names = ", ".join(f"{line.name} at {line.multiple:.6g} times the speed" for line in self.lines)
        return f"Lines: {names or 'none'}."

    def __str__(self) -> str:
        rows = [("", "term", "symbol", "largest", "reason"), *self.rows()]
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        cells = [[c.ljust(w) for c, w in zip(row, widths, strict=True)] for row in rows]
        left_out = [f"Left out: {effect.name}: {effect.reason}." for effect in self.left_out]
        return "\n".join(["  ".join(row).rstrip() for row in cells] + [self.excited(), *left_out])


def terms(scene: Scene) -> Terms:
    """List every term of the equations of motion, whether it is present in a scene, and why.

    A term is present if it is assembled and its coefficient does not vanish throughout the motion.

    Parameters
    ----------
    scene : Scene
        The scene; without a motion, steady rotation at 1 rad/s is assumed.  For physics "auto", the terms are
        those of the plain Euler-Bernoulli beam; the neglected effects are then described as ones that an
        analysis adds where they matter.

    Returns
    -------
    Terms

    References
    ----------
    Lee and Yoo (2019), eqs. (13) and (14), corrected; section Equations of docs/conventions.md.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> found = bd.terms(bd.Scene(strip, bd.Mount(radius=0.215), bd.SteadyRotation(50.0)))
    >>> len(found.present) > 0
    True
    """
    start = perf_counter()
    check_scene(scene)
    straight = scene.straightened
    sampled, assembled = SampledScene(scene), _terms_by_name(straight)
    modelled = (field for field in FIELDS if field.is_modelled(straight))
    complete = reduce(lambda scene, field: field.complete(scene), modelled, straight)
    terms = _terms_by_name(complete)
    entries = [_describe(every, assembled.get(name, []), sampled) for name, every in terms.items()]
    if scene.physics.large_deflection:
        entries.append(_ANY_SLOPE)
    lines = scene.motion.lines if scene.motion is not None else ()
    gravity = (Line("gravity", 1.0),) if scene.gravity else ()
    provenance = Provenance.since(start, str(_BASIS))
    return Terms(tuple(entries), (*list_left_out(scene),), (*lines, *gravity), provenance, scene)


def _terms_by_name(scene: Scene) -> dict[str, list[Term | Load]]:
    """Group the terms and loads of a scene by name; a name may occur in the equations of several fields."""
    equations, found = assemble_equations(scene, _BASIS), {}
    for term in (*equations.terms, *equations.loads):
        found.setdefault(term.name, []).append(term)
    return found


def _describe(every: list[Term | Load], assembled: list[Term | Load], scene: SampledScene) -> Entry:
    """Make the entry for all terms of one name.

    `every` has the terms and loads of this name that exist in general, `assembled` those of the scene.
    """
    sizes = [float(np.abs(term.coefficient(scene.root)).max()) for term in assembled]
    largest, name = max(sizes, default=0.0), every[0].name
    explanation = _EXPLANATIONS.get(name, Explanation(name, "it is assembled"))
    return Entry(
        name=name,
        symbol=explanation.symbol,
        fields=tuple(dict.fromkeys(term.rows for term in assembled)),
        quantity=" and ".join(dict.fromkeys(_QUANTITY[term.quantity] for term in every)),
        largest=largest,
        present=bool(largest),
        reason=explanation.sentence(scene, present=bool(largest)),
    )


_MODELLED = "slopes of any size are modelled; the other terms are listed as for a straight beam"
_ANY_SLOPE = Entry("large deflection", "cos θ, sin θ", ("bending",), "1", 1.0, True, _MODELLED)
_EXPLANATIONS = {name: text for field in FIELDS for name, text in field.explanations.items()}

_QUANTITY = {
    "unity": "1",
    "speed": "speed [rad/s]",
    "acceleration": "angular acceleration [rad/s2]",
    "speed_squared": "speed squared [rad2/s2]",
    "root_axial": "root acceleration along the beam [m/s2]",
    "root_transverse": "root acceleration in the direction of bending [m/s2]",
    "root_across": "root acceleration across the direction of bending [m/s2]",
}
