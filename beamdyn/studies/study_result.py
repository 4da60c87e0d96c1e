"""The result of a study: an answer over combinations of inputs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from beamdyn.common.inputs.designs import Designs, VariedInput
from beamdyn.common.plots.curves import plot_over_input
from beamdyn.common.results.one_line import counted, error_at_most, spanned, warned
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import InputValue, Statement, joined
from beamdyn.common.words import Words
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, StatesModelError
from beamdyn.scene.numbers import with_numbers
from beamdyn.scene.scene import Scene
from beamdyn.studies.answers import NO_ANSWERS, REFUSED
from beamdyn.studies.one_by_one import join_effects, left_out_of_design
from beamdyn.studies.questions import StudyQuestion

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_JUDGED = 8  # designs at which the model error is computed, beside the extremes
_DIGITS = 4  # digits of a design's inputs in words
_MOST_AXES = 3  # inputs of which all extremes are combined


@dataclass(frozen=True)
class Study(StatesModelError):
    """An answer over combinations of inputs; made by `study`.

    The shape (n1, ..., nd) has an axis for each input, in order, or one for all that are taken together.
    `error` is that of the numbers; `model_error` (p, m) and `left_out`, computed when asked for, are what the
    physics left out would change at the designs of `left_out_places` (p); `left_out_at` says it of any.

    Parameters
    ----------
    what : str
        What was asked for: "frequencies", "critical_speed", "crossings", "amplitude" or "peak".
    unit : str
        Unit of the answer.
    inputs : tuple of VariedInput
        Each with its `name`, `unit` and `values` in SI.
    combine : {"product", "zip"}
        Whether the inputs are combined each with each, or taken together.
    labels : tuple of str, length m
        What the m numbers of a design are: its modes, or modes and the lines that they meet; empty where it
        has one number.
    value : ndarray, shape (n1, ..., nd, m) or (n1, ..., nd)
        Frequencies of m modes [Hz], nan where a mode does not vibrate; critical speeds [rad/s], inf where
        the beam does not buckle; resonance speeds [rad/s], nan where a mode meets a line at none up to the
        top speed; steady amplitudes or peaks [m], nan where there is none.
    error : ndarray, of the same shape
        Estimated relative error; inf where unresolved.
    status : ndarray of str, of the same shape
        Of a mode as for `natural_modes`; "buckles", "does not buckle" or "not found"; "resonates", "none up
        to the top speed" or "not excited"; of a response as for `steady_response`; of a peak "done" or
        "failed"; "refused" where there is no answer.
    warnings : tuple of str
        What limits the answer, and of how many designs.
    provenance : Provenance
        How it was found.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> found = bd.study(bd.Scene(strip), {"beam.thickness": [0.0002, 0.0004]}, modes=1)
    >>> round(float(found.value[1, 0] / found.value[0, 0]), 9)  # proportional to the thickness
    2.0
    >>> found.design(1)
    {'beam.thickness': 0.0004}
    """

    what: str
    unit: str
    inputs: tuple[VariedInput, ...]
    combine: str
    labels: tuple[str, ...]
    value: np.ndarray
    error: np.ndarray
    status: np.ndarray
    warnings: tuple[str, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)
    question: StudyQuestion = field(repr=False)

    judged_by_solving: ClassVar[bool] = True

    def headline(self) -> Iterator[str]:
        """The question, number of designs, range of the answer and error in a line; see `Result.headline`."""
        names = ", ".join(each.name for each in self.inputs)
        yield f"{self.what} of {counted(self.designs.count, 'design')} over {names}"
        yield spanned(self.value, self.unit)
        yield from (error_at_most(self.error), warned(self.warnings))

    @property
    def designs(self) -> Designs:
        """The designs."""
        return Designs(self.inputs, self.combine)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape (n1, ..., nd) of the designs."""
        return self.designs.shape

    def design(self, *place: int) -> dict[str, float]:
        """Inputs of the design at a place (i1, ..., id): values in SI, by name."""
        return self.designs.at(*place)

    def scene_at(self, *place: int) -> Scene:
        """The scene of the design at a place (i1, ..., id), for any other analysis of it."""
        return with_numbers(self.scene, self.design(*place))

    @property
    def answered(self) -> np.ndarray:
        """Which designs have an answer, shape (n1, ..., nd): also that nothing buckles or resonates.

        A design has none that is refused, or not stable at its speed, or whose critical speed is not found.
        """
        there = ~np.isin(self.status, NO_ANSWERS)
        return np.asarray(there.all(axis=-1)) if self.labels else there

    # Model error ------------------------------------------------------------------------------------

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """Changes of the answer by effects left out, at the designs of `left_out_places`: shape (p, m)."""
        return join_effects([self.left_out_at(*place) for place in self.left_out_places], self._numbers)

    @cached_property
    def left_out_places(self) -> tuple[tuple[int, ...], ...]:
        """Places of the designs at which the model error is computed: (p) tuples (i1, ..., id).

        The extremes of the inputs and others spread evenly; of amplitudes and peaks, which take long, the
        largest.
        """
        if self.question.kind.needs_motion:
            known = np.isfinite(self.value)
            at = [np.nanargmax(self.value)] if known.any() else []
        else:
            ends = [np.array([0, n - 1]) for n in self.shape[:_MOST_AXES]]
            corners = np.ravel_multi_index(
                (*np.meshgrid(*ends), *(0,) * len(self.shape[_MOST_AXES:])), self.shape
            )
            spread = np.linspace(0, self.designs.count - 1, _JUDGED).round().astype(int)
            at = np.unique([*corners.ravel(), *spread])
        return tuple(tuple(map(int, np.unravel_index(i, self.shape))) for i in at)

    def left_out_at(self, *place: int) -> LeftOutEffects | None:
        """Changes of the answer (m,) at a place by effects left out; None if it has no answer."""
        design = self.design(*place)
        return left_out_of_design(self.question, with_numbers(self.scene, design), design)

    @property
    def _numbers(self) -> int:
        return len(self.labels) or 1

    def model_warnings(self, tolerance: float | None = None) -> list[Statement]:
        """Warnings of a model error past a tolerance, or 1 %, with the design where it is largest."""
        return [*self.left_out_effects.warnings(tolerance, self.left_out_where, self._where_unknown)]

    @property
    def left_out_where(self) -> str:
        """The design of `left_out_places` at which the model error is largest, in words."""
        total = self.left_out_effects.total_of_known
        if not total.size:
            return ""
        return self._say_place(int(total.max(axis=1).argmax()))

    def _where_unknown(self, name: str) -> str:
        """The first design of `left_out_places` of which the change by an effect is not known, in words."""
        nothing = np.isnan(self.left_out_effects.changes[name]).any(axis=1)
        refused = [(self.status[place] == REFUSED).all() for place in self.left_out_places]
        unknown = np.flatnonzero(nothing & ~np.array(refused))
        if not unknown.size:
            return ""
        more = f", and at {len(unknown) - 1} more of the {len(refused)} designs judged,"
        return Words(self._say_place(int(unknown[0])), more if len(unknown) > 1 else "")

    def _say_place(self, i: int) -> Words:
        design = self.design(*self.left_out_places[i])
        each = (InputValue(one.name, design[one.name], one.unit, _DIGITS) for one in self.inputs)
        return Words("at ", joined(", ", each))

    def to_dict(self) -> dict[str, Any]:
        """The result as plain numbers, lists and strings, with its model error and what is left out."""
        return super().to_dict() | {"left_out_places": [*map(list, self.left_out_places)]}

    # Pictures ---------------------------------------------------------------------------------------

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the answers over the first input; of further inputs, curves for each value of the second.

        Crosses at the bottom stand where there is no number; inputs after the second have their first value.
        """
        first, rest = self.inputs[0], self._rest()
        title, words = f"at {', '.join(rest)}" if rest else "", f"{self._words()} [{self.unit}]"
        states = np.unique(self.status[~np.isfinite(self.value)]).tolist()
        none = f"none: {', '.join(states)}"
        return plot_over_input(
            first.values, self._curves(), self._labels(), first.label, words, ax, title, none
        )

    def _words(self) -> str:
        """The answer that a picture shows."""
        word = self.question.kind.word
        return f"{word}, {self.labels[0]}" if len(self.labels) == 1 and len(self.shape) > 1 else word

    def _curves(self) -> np.ndarray:
        """Answers over the first input, one row a curve."""
        if len(self.shape) == 1:
            return np.atleast_2d(self.value.T)
        each = self.value if self.labels else self.value[..., None]
        shown = each.reshape(*self.shape[:2], -1, each.shape[-1])[:, :, 0]
        return shown.reshape(len(shown), -1).T

    def _labels(self) -> list[str]:
        if len(self.shape) > 1:
            second = [_at(self.inputs[1], value) for value in self.inputs[1].values.tolist()]
            several = self.labels if len(self.labels) > 1 else ("",)
            return [", ".join(filter(None, (at, label))) for at in second for label in several]
        return list(self.labels) or [""]

    def _rest(self) -> list[str]:
        """The inputs that a picture shows at their first value only."""
        rest = self.inputs[2:] if self.combine == "product" else ()
        return [_at(each, float(each.values[0])) for each in rest]


def _at(given: VariedInput, value: float) -> str:
    return InputValue(given.name, value, given.unit, _DIGITS)
