"""Result of a study: one kind of quantity over combinations of inputs.

In shapes of arrays, m counts results of a design, and p designs whose model error is computed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from beamdyn.common.inputs.described import Designs, VariedInput
from beamdyn.common.plots.axes_and_lines import set_up_axes
from beamdyn.common.plots.curves import curves, mark_missing
from beamdyn.common.plots.maps import MapAnswer, MapInput, map_size, plot_maps
from beamdyn.common.results.columns import ShownUnit, evenly_spread
from beamdyn.common.results.one_line import counted, error_at_most, spanned, warned
from beamdyn.common.results.pictures import Axes, add_legend
from beamdyn.common.results.statements import InputValue, Statement, joined
from beamdyn.common.words import InputName, Part, Words
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, StatesModelError
from beamdyn.scene.numbers import SPEED, number_at, with_numbers
from beamdyn.scene.scene import Scene, SceneResult
from beamdyn.studies.answers import NO_ANSWERS, REFUSED
from beamdyn.studies.one_by_one import join_effects, left_out_of_design
from beamdyn.studies.questions import StudyQuestion
from beamdyn.studies.resonance_speeds import lines_of

_JUDGED = 8  # number of designs, in addition to the extremes, at which the model error is computed
_DIGITS = 4  # number of significant digits of a design's inputs in sentences
_MOST_AXES = 3  # largest number of inputs of which all extremes are combined


@dataclass(frozen=True)
class Study(SceneResult, StatesModelError):
    """Results over combinations of inputs; computed by `study`.

    The shape (n1, ..., nd) has an axis for each input, in order, or one axis for all inputs that are varied
    together. `error` is the numerical error.  `left_out` contains the estimated relative change of each
    result by each neglected physical effect, at the p designs of `left_out_places`, `model_error` (p, m) the
    magnitude of the sum of these changes; both are computed at first use.  `left_out_at` computes the changes
    for any design.

    Parameters
    ----------
    what : str
        Name of the result: "frequencies", "critical_speed", "crossings", "amplitude", "peak",
        "strain" or "power".
    unit : str
        Unit of the result.
    inputs : tuple of VariedInput
        The inputs, each with its `name`, `unit` and `values` in SI.
    combine : {"product", "zip"}
        Whether all combinations of the inputs are computed, or the inputs are varied together.
    labels : tuple of str, length m
        Names of the m numbers of a design's result: modes, or modes and the lines that they meet; empty for a
        single number.
    value : ndarray, shape (n1, ..., nd, m) or (n1, ..., nd)
        Frequencies of m modes [Hz], nan if a mode does not vibrate; critical speeds [rad/s], inf if the beam
        does not buckle; resonance speeds [rad/s], nan if a mode meets a line at no speed up to the top speed;
        steady amplitudes or peaks [m], strains or power [W], nan if there is no result.
    error : ndarray, of the same shape
        Estimated relative error; inf if unresolved.
    status : ndarray of str, of the same shape
        For a mode as in `natural_modes`; for a critical speed "buckles", "does not buckle" or "not found";
        for a resonance "resonates", "none up to the top speed" or "not excited"; for a response as in
        `steady_response`; for a peak "done" or "failed"; "refused" if there is no result.
    warnings : tuple of str
        Warnings about the validity and accuracy of the results, with the number of designs concerned.
    provenance : Provenance
        How the result was computed.
    typed_units : mapping
        Unit in which the values of an input were typed, by its name; for tables and plots.

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
    question: StudyQuestion = field(repr=False)
    typed_units: Mapping[str, ShownUnit] = field(default_factory=dict, repr=False)

    judged_by_solving: ClassVar[bool] = True

    def headline(self) -> Iterator[str]:
        """Yield question, number of designs, range of the result and error; see `Result.headline`."""
        names = joined(", ", (InputName(each.name) for each in self.inputs))
        yield Words(f"{self.what} of {counted(self.designs.count, 'design')} over ", names)
        yield spanned(self.value, self.unit)
        yield from (error_at_most(self.error), warned(self.warnings))

    @property
    def designs(self) -> Designs:
        """The designs of the study."""
        return Designs(self.inputs, self.combine)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape (n1, ..., nd) of the designs."""
        return self.designs.shape

    def design(self, *place: int) -> dict[str, float]:
        """Return the inputs of the design with indices (i1, ..., id): values in SI, by name."""
        return self.designs.at(*place)

    def scene_at(self, *place: int) -> Scene:
        """Return the scene of the design with indices (i1, ..., id), for any other analysis."""
        return with_numbers(self.scene, self.design(*place))

    @property
    def answered(self) -> np.ndarray:
        """Whether each design has a result, shape (n1, ..., nd).

        That it does not buckle, or has no resonance, is a result.  A design has no result if it is refused or
        unstable at its speed, or if its critical speed is not found.
        """
        there = ~np.isin(self.status, NO_ANSWERS)
        return np.asarray(there.all(axis=-1)) if self.labels else there

    # Model error ------------------------------------------------------------------------------------

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """Relative changes of the result by neglected effects, at designs `left_out_places` (first axis)."""
        return join_effects(
            [self.left_out_at(*place) for place in self.left_out_places], len(self.labels) or 1
        )

    @cached_property
    def left_out_places(self) -> tuple[tuple[int, ...], ...]:
        """Indices of the designs at which the model error is computed: p tuples (i1, ..., id).

        These are the extremes of the inputs and other evenly spread designs; for results that need a motion
        and take long to compute, only the design with the largest result.
        """
        if self.question.kind.needs_motion:
            at = [np.nanargmax(self.value)] if np.isfinite(self.value).any() else []
        else:
            ends = [np.array([0, n - 1]) for n in self.shape[:_MOST_AXES]]
            corners = np.ravel_multi_index(
                (*np.meshgrid(*ends), *(0,) * len(self.shape[_MOST_AXES:])), self.shape
            )
            at = np.unique([*corners.ravel(), *evenly_spread(self.designs.count, _JUDGED)])
        return tuple(tuple(map(int, np.unravel_index(i, self.shape))) for i in at)

    def left_out_at(self, *place: int) -> LeftOutEffects | None:
        """Compute changes of the result of a design by neglected effects; None if it has no result."""
        design = self.design(*place)
        return left_out_of_design(self.question, with_numbers(self.scene, design), design)

    def model_warnings(self, tolerance: float | None = None) -> list[Statement]:
        """Return warnings of a model error above a tolerance, or 1 %, with the design where it is largest."""
        return [*self.left_out_effects.warnings(tolerance, self.left_out_where, self._where_unknown)]

    @property
    def left_out_where(self) -> str:
        """Describe the design of `left_out_places` with the largest model error, by its inputs."""
        total = self.left_out_effects.total_of_known
        if not total.size:
            return ""
        return self._say_place(int(total.max(axis=1).argmax()))

    def _where_unknown(self, name: str) -> str:
        """Say at which designs of `left_out_places` the change by the neglected effect `name` is unknown.

        The text has the inputs of the first of these designs, and the number of others; "" if there is none.
        """
        nothing = np.isnan(self.left_out_effects.changes[name]).any(axis=1)
        refused = [bool(np.all(self.status[place] == REFUSED)) for place in self.left_out_places]
        unknown = np.flatnonzero(nothing & ~np.array(refused))
        if not unknown.size:
            return ""
        more = f", and at {len(unknown) - 1} more of {len(refused)} designs that were checked,"
        return Words(self._say_place(int(unknown[0])), more if len(unknown) > 1 else "")

    def _say_place(self, i: int) -> Words:
        design = self.design(*self.left_out_places[i])
        each = (InputValue(one.name, design[one.name], one.unit, _DIGITS) for one in self.inputs)
        return Words("at ", joined(", ", each))

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain numbers, lists and strings, with model error and neglected effects."""
        return super().to_dict() | {"left_out_places": [*map(list, self.left_out_places)]}

    # Plots -------------------------------------------------------------------------------------------

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw each result over one input, or as a map over two inputs with contour lines.

        The scene's values are marked.  Some values of a third input have separate maps; further inputs have
        their first value.  Areas without a result are hatched, with the reason; frequencies over speed are
        drawn with the excitation lines.  Several results over one input are drawn in one panel each of a new
        figure, or as curves in given axes.
        """
        inputs, answers = self._picture
        if ax is None or len(answers) == 1 or sum(len(each.values) > 1 for each in inputs) > 1:
            return plot_maps(inputs, answers, ax)
        return self._plot_curves(ax, *self._picture)

    def _plot_curves(self, ax: Axes, inputs: Sequence[MapInput], answers: Sequence[MapAnswer]) -> Axes:
        """Draw each result as a curve over the single varied input, in axes that may have other curves."""
        over = max(range(len(inputs)), key=lambda k: len(inputs[k].values))
        x = inputs[over].values
        order = np.argsort(x, kind="stable")
        rows = np.array([each.value.reshape(len(x))[order] for each in answers])
        unit = self.unit_shown(self.unit, "mm")
        set_up_axes(ax, inputs[over].label, f"{self.question.kind.word} [{unit.name}]")
        curves(ax, x[order], rows, self.labels)
        mark_missing(ax, "no answer")
        return add_legend(ax)

    def plot_panels(self, ax: Axes) -> Axes:
        """Draw the results as in a new figure of `plot`: in panels that divide the area of given axes."""
        return plot_maps(*self._picture, ax)

    def picture_size(self, width: float | None = None) -> tuple[float, float]:
        """Return width and height of the figure [inch], for a given width if there is one."""
        return map_size(*self._picture, width)

    @cached_property
    def _picture(self) -> tuple[list[MapInput], list[MapAnswer]]:
        """Return the inputs and results of the plot, in display units."""
        unit = self.unit_shown(self.unit, "mm")
        several = self.value if self.labels else self.value[..., None]
        status = self.status if self.labels else self.status[..., None]
        reasons = {word: _REASONS.get(word, word) for word in np.unique(status).tolist()}
        why = np.vectorize(reasons.__getitem__, otypes=[object])(status)
        meets = self._lines()
        answers = [
            MapAnswer(
                f"{', '.join(filter(None, (self.question.kind.word, label)))} [{unit.name}]",
                unit.of(several[..., k]),
                why[..., k],
                meets,
            )
            for k, label in enumerate(self.labels or ("",))
        ]
        return self._inputs(), answers

    def _inputs(self) -> list[MapInput]:
        """Return the inputs of the plot; inputs that are varied together are drawn over the first."""
        shown = []
        for each in self.inputs if self.combine == "product" else self.inputs[:1]:
            unit = self.typed_units.get(each.name) or self.unit_shown(each.unit, "m")
            if each.name == SPEED:
                value = None if self.scene.motion is None else self.scene.motion.final_speed
            else:
                value = number_at(self.scene, each.name)
            present = None if value is None or not np.isfinite(value) else value
            values, present = unit.of(each.values), present and unit.of(present)
            shown.append(MapInput(each.in_words, unit.name, values, present))
        return shown

    def in_own_words(self, part: Part) -> str | None:
        """Format an input's value in the unit in which it was typed; None for other parts of a text."""
        if not isinstance(part, InputValue) or part.name not in self.typed_units:
            return None
        return part.said(self.typed_units[part.name].say(part.value))

    def unit_shown(self, unit: str, usual_length: str) -> ShownUnit:
        """Return the display unit of quantities with a given SI unit."""
        units = self.display_units
        known = {"rad/s": units.speed_unit(), "m": units.length_unit(usual_length)}
        return known.get(unit, ShownUnit(unit, 1.0))

    def _lines(self) -> dict[str, np.ndarray]:
        """Return frequencies [Hz] of the excitation lines, if natural frequencies over speed are drawn."""
        speeds = next((each.values for each in self.inputs if each.name == SPEED), None)
        if self.what != "frequencies" or speeds is None:
            return {}
        place = [each.name for each in self.inputs].index(SPEED) if self.combine == "product" else 0
        along = np.moveaxis(speeds.reshape(*(1,) * (len(self.shape) - 1), -1), -1, place) / (2 * np.pi)
        with suppress(ValueError):  # the motion may have no steady state, and so no lines
            lines = lines_of(self.scene, float(speeds.max()))
            return {line.name: line.multiple * along for kind, line in lines if kind == "forced"}
        return {}


_REASONS = {
    "divergence": "buckles",
    "flutter": "flutters",
    "none up to the top speed": "no resonance up to the top speed",
}  # words in a plot for statuses without a number
