"""Result of an inverse design: numbers, results of the design, and missed targets."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from beamdyn.common.plots.curves import plot_bars
from beamdyn.common.results.one_line import counted, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import plain
from beamdyn.common.results.statements import joined
from beamdyn.common.words import InputName, Words
from beamdyn.scene.numbers import with_numbers
from beamdyn.scene.scene import Scene, SceneResult
from beamdyn.studies.designing.target import Target, say_number


@dataclass(frozen=True)
class FoundDesign(SceneResult):
    """Numbers of a scene whose results meet the targets, or come nearest to them; computed by `design`.

    Parameters
    ----------
    names, units : tuple of str, shape (p,)
        Names of the numbers in scene files, and their SI units.
    given, value : ndarray, shape (p,)
        Values in the scene, and values in the design [unit].  A value in the scene is 0 if the scene lacks
        the number, and nan if it varies along the beam.
    low, high : ndarray, shape (p,)
        Bounds of the numbers [unit].
    targets : tuple of Target, shape (m,)
        The targets.
    reached : ndarray, shape (m,)
        Results of the design [unit of each]; nan if there is none.
    error : ndarray, shape (m,)
        Estimated relative errors of these results.
    met : ndarray of bool, shape (m,)
        Whether each target is met, within 1e-10 or the error of the result; a target "best" is met if there
        is a result.
    derivative : ndarray, shape (m, p)
        Derivative of each result with respect to each number [unit / unit of the number]; finite difference.
    limited_by : tuple of str
        Bounds and limits that the design reaches, in words.
    only_one_way : bool
        Whether the results that miss their targets rise or fall monotonically with each number over all
        computed designs, and the design is at the bounds nearest to the targets.  This does not prove that no
        other design within the bounds is nearer: results may have extrema between computed designs.
    proof : str
        Proof that no design within the bounds comes nearer to any missed target; empty unless there is a
        proof for each of them.
    why_none : str
        Proof that no design within the bounds meets all targets, within the errors of the results; empty
        without a proof.
    solves : int
        Number of designs computed, at most 60.
    warnings : tuple of str
        Warnings about the results of the design.
    provenance : Provenance
        How the result was computed.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> free = {"beam.thickness": (0.1e-3, 0.2e-3)}
    >>> found = bd.design(bd.Scene(strip), free, [bd.Target("frequencies", equals=80.0)])
    >>> found.found, found.limited_by
    (False, ('beam.thickness is at its largest value',))
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    given: np.ndarray
    value: np.ndarray
    low: np.ndarray
    high: np.ndarray
    targets: tuple[Target, ...]
    reached: np.ndarray
    error: np.ndarray
    met: np.ndarray
    derivative: np.ndarray
    limited_by: tuple[str, ...]
    only_one_way: bool
    proof: str
    why_none: str
    solves: int

    def headline(self) -> Iterator[str]:
        """Yield whether a design was found, and its numbers, for the one-line summary.

        See `Result.headline`.
        """
        yield "found" if self.found else "none found, the nearest"
        for name, value, unit in self._numbers:
            yield Words(InputName(name), " ", say_number(value, unit))
        yield from (counted(self.solves, "solve"), warned(self.warnings))

    @property
    def found(self) -> bool:
        """Whether the design meets all targets."""
        return bool(self.met.all())

    @property
    def scene_found(self) -> Scene:
        """Scene with the numbers of the design."""
        return with_numbers(self.scene, dict(zip(self.names, self.value.tolist(), strict=True)))

    @property
    def relative(self) -> np.ndarray:
        """Relative change of m results over that of p numbers, shape (m, p).

        It is 3 if a result is proportional to the cube of a number.
        """
        return self.derivative * self.value / self.reached[:, None]

    @property
    def without_effect(self) -> tuple[str, ...]:
        """Names of the numbers that change no result, according to the derivatives at this design."""
        return tuple(
            name
            for name, each in zip(self.names, self.derivative.T, strict=True)
            if (each == 0).all()  # derivatives within rounding were set to 0 earlier
        )

    @property
    def _numbers(self) -> Iterator[tuple[str, float, str]]:
        return zip(self.names, self.value.tolist(), self.units, strict=True)

    def sentences(self) -> tuple[str, ...]:
        """Return sentences about missed targets, and about the bounds and limits that the design reaches."""
        return tuple(self._sentences())

    def _sentences(self) -> Iterator[str]:
        missed = [k for k, met in enumerate(self.met) if not met]
        if missed:
            numbers = joined(
                ", ", (Words(InputName(n), " = ", say_number(v, u)) for n, v, u in self._numbers)
            )
            said = (Words(self.targets[k].says, f" (there {self._reached(k)})") for k in missed)
            sure = bool(self.proof)
            none = "No design in the bounds has " if sure else "No design was found that has "
            nearest = "; the nearest is " if sure else "; the nearest found is "
            beside = "" if sure or len(missed) == len(self.met) else " together with all other targets"
            yield Words(none, joined(" and ", said), beside, nearest, numbers, ".")
            if self.proof:
                yield f"It is proven that no other design comes nearer: {self.proof}."
            elif self.why_none:
                yield Words("It is proven that no design meets all targets: ", self.why_none, ".")
            elif self.only_one_way:
                said = "which suggests, but does not prove, that no other design comes nearer"
                yield f"These answers {self._ways()} over all designs computed, {said}."
        if self.without_effect:
            many = len(self.without_effect) > 1
            names = joined(" and ", map(InputName, self.without_effect))
            targets = " and ".join(dict.fromkeys(each.name for each in self.targets))
            yield Words(names, f" {'have' if many else 'has'} no effect on {targets}.")
        if self.limited_by:
            yield Words("Limited by: ", joined("; ", self.limited_by), ".")

    def _ways(self) -> str:
        """State that the results depend monotonically on each number, or not at all."""
        still = len(self.without_effect)
        if still == len(self.names):
            return "are the same"
        return f"rise or fall with each {'other ' if still else ''}number"

    def _reached(self, k: int) -> str:
        value = float(self.reached[k])
        if np.isinf(value):
            return (
                "it does not buckle" if self.targets[k].what == "critical_speed" else "beyond the top speed"
            )
        return "no answer" if np.isnan(value) else self.targets[k].amount(value)

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain numbers, lists and strings, with its sentences under "sentences"."""
        return super().to_dict() | {"found": self.found, "sentences": plain(self.sentences())}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the relative change of each result over that of each number, the most important on top."""
        labels = [each.name for each in self.targets]
        names = [InputName(each).on_form for each in self.names]
        return plot_bars(names, self.relative.T, labels, "relative change over that of the number", ax)
