"""Comparison of measured with computed natural frequencies: pairs, deviations, and whether each agrees.

In shapes of arrays, N counts measured values.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from beamdyn.common.plots.plots import mark_points, plot_locus
from beamdyn.common.results.one_line import counted, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import plain
from beamdyn.common.results.statements import Speeds, joined, unannounced
from beamdyn.common.words import InputName, Setting, Words, percent
from beamdyn.modes.locus import frequency_locus
from beamdyn.modes.modal.model import TORSION
from beamdyn.modes.modes import natural_modes
from beamdyn.scene.scene import SceneResult
from beamdyn.studies.beside_data.single_numbers import OneNumberFit, say_value

AGREES, LEFT_OUT, OUTSIDE, ALONE = "agrees", "within the model error", "outside", "no mode"
NOTHING = 1e-9  # relative change too small to be mentioned
_DIGITS = 6  # number of significant digits of frequencies in sentences
_PLACES = 61  # number of speeds at which a plot draws computed frequencies
_ONE_SPEED = 0.1  # top speed of a plot of data at rest, as a fraction of the first angular frequency


@dataclass(frozen=True)
class FrequencyComparison(SceneResult):
    """Measured natural frequencies, compared with computed ones of a scene.

    Parameters
    ----------
    label : tuple of str, shape (N,)
        Name of each measured value, such as "flap 1".
    speed : ndarray, shape (N,)
        Speeds [rad/s].
    measured, computed : ndarray, shape (N,)
        Frequencies [Hz]; computed ones are nan if the scene has no such mode.
    mode : ndarray of int, shape (N,)
        Number of the computed mode at its speed, from 1; 0 where there is none.
    allowance : ndarray, shape (N,)
        Possible error of the measured value [Hz]: `rounding` plus twice its uncertainty.
    rounding : ndarray, shape (N,)
        Half a unit of the last digit of the measured value [Hz].
    error : ndarray, shape (N,)
        Estimated numerical error of the computed frequency [Hz].
    model_error : ndarray, shape (N,)
        Model error of the computed frequency [Hz]: change by neglected effects, as far as it is known.
    likeness : ndarray, shape (N,)
        Modal assurance criterion of measured and computed shape (nondimensional); nan if no shapes were
        measured.
    resembles : tuple of str, shape (N,)
        For a measured shape without a mode, the mode with the most similar shape; empty for all others.
    unmeasured : tuple of str
        Modes of the scene between the measured ones that have no measured value.
    explanations : tuple of OneNumberFit
        Numbers of the scene that, changed alone, fit all data best; the best comes first.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        How the frequencies were computed.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> found = bd.compare(bd.Scene(strip), bd.MeasuredFrequencies([65.2305, 408.79], rounding=0.005))
    >>> found.verdict
    ('agrees', 'agrees')
    """

    label: tuple[str, ...]
    speed: np.ndarray
    measured: np.ndarray
    computed: np.ndarray
    mode: np.ndarray
    allowance: np.ndarray
    rounding: np.ndarray
    error: np.ndarray
    model_error: np.ndarray
    likeness: np.ndarray
    resembles: tuple[str, ...]
    unmeasured: tuple[str, ...]
    explanations: tuple[OneNumberFit, ...]
    source: str = field(default="", repr=False)

    field_units: ClassVar[dict[str, str]] = {
        "rad/s": "speed",
        "Hz": "measured computed allowance rounding error model_error",
    }

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"{self.verdict.count(AGREES)} of {counted(len(self.label), 'frequency', 'frequencies')} agree"
        if np.isfinite(self.deviation).any():
            yield f"largest deviation {percent(float(np.nanmax(np.abs(self.deviation))))}"
        if good := [each for each in self.explanations if each.explains]:
            more = f", and so would {counted(len(good) - 1, 'other')}" if len(good) > 1 else ""
            yield Words(InputName(good[0].name), " = ", self._value(good[0]), f" would explain it{more}")
        yield warned(self.warnings)

    @property
    def deviation(self) -> np.ndarray:
        """Relative deviation of each value: measured minus computed, divided by the computed one."""
        return self.measured / self.computed - 1

    @property
    def verdict(self) -> tuple[str, ...]:
        """Agreement of each value: "agrees", "within the model error", "outside" or "no mode".

        A value agrees if it deviates by at most `allowance` plus `error`, and is within the model error if
        it deviates by at most their sum with `model_error`; "no mode" if the scene has no such mode.
        """
        off, sure = np.abs(self.measured - self.computed), self.allowance + self.error
        each = [np.isnan(off), off <= sure, off <= sure + self.model_error]
        return tuple(np.select(each, [ALONE, AGREES, LEFT_OUT], OUTSIDE).tolist())

    @property
    def in_digits(self) -> np.ndarray:
        """Whether each value differs from the computed one by at most half a unit of its last digit."""
        return np.abs(self.measured - self.computed) <= self.rounding

    @property
    def agrees(self) -> bool:
        """Whether all values agree within `allowance` plus `error`."""
        return set(self.verdict) == {AGREES}

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain numbers, lists and strings, with deviations, verdicts and sentences."""
        more = {"deviation": self.deviation, "verdict": self.verdict, "sentences": self.sentences()}
        return super().to_dict() | {name: plain(value) for name, value in more.items()}

    def sentences(self) -> tuple[str, ...]:
        """Return sentences about the largest deviations, and about what would explain them."""
        return tuple(self._sentences())

    def _sentences(self) -> Iterator[str]:
        off, verdicts = np.nan_to_num(np.abs(self.deviation)), np.array(self.verdict)
        if self.in_digits.all():
            yield "All agree to the digits of the data."
        elif self.agrees:
            yield f"All agree: {self._say(int(off.argmax()), 'which is the largest deviation')}."
        for verdict, words in _WORDS.items():
            if (verdicts == verdict).any():
                worst = int(np.where(verdicts == verdict, off, -1.0).argmax())
                others = int((verdicts == verdict).sum()) - 1
                more = (
                    f"; so {'is' if others == 1 else 'are'} {counted(others, 'other value')}, by less"
                    if others
                    else ""
                )
                yield Words(self._say(worst, words), more, ".")
        for k in np.flatnonzero(verdicts == ALONE):
            yield self._alone(int(k))
        if self.unmeasured:
            yield Words("Without a measured value: ", joined(", ", self.unmeasured), ".")
        yield from self._explained()

    def _alone(self, k: int) -> Words:
        """State that measured value k has no computed mode, and the possible reason."""
        setting = Setting("physics", torsion=True)
        twists = TORSION in self.label[k].lower()
        advice = ["; with ", setting, " it may have one"] if twists else []
        if self.resembles[k]:
            advice = [f"; its shape is most like that of {self.resembles[k]}: columns may be exchanged"]
        start = f"{self.label[k]}, {self.measured[k]:.{_DIGITS}g} Hz at "
        return Words(start, Speeds(self.speed[k]), ": the model has no such mode", *advice, ".")

    def _say(self, k: int, words: str) -> Words:
        """Format the deviation of measured value k."""
        deviation, computed = float(self.deviation[k]), f"{self.computed[k]:.{_DIGITS}g} Hz"
        side = "the same as"
        if abs(deviation) > NOTHING:
            side = f"{percent(abs(deviation))} {'below' if deviation < 0 else 'above'}"
        left_out, own = (float(each[k] / self.computed[k]) for each in (self.model_error, self.allowance))
        said = outside(left_out, own) if words == OUTSIDE else words.format(left_out=percent(left_out))
        found = f": {self.measured[k]:.{_DIGITS}g} Hz is {side} {computed}, {said}"
        return Words(f"{self.label[k]} at ", Speeds(self.speed[k]), found)

    def _explained(self) -> Iterator[str]:
        good = [each for each in self.explanations if each.explains]
        if good:
            each = [Words(InputName(e.name), " = ", self._value(e), f" (leaves {e.left})") for e in good]
            yield Words("One number alone would explain it: ", joined(" or ", each), ".")
        elif self.explanations:
            best = self.explanations[0]
            value, left = self._value(best), f", which leaves {best.left}."
            none = "No number alone explains it: the nearest is "
            yield Words(none, InputName(best.name), " = ", value, left)

    def _value(self, fit: OneNumberFit) -> str:
        return say_value(fit.value, fit.unit, units=self.display_units)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the frequencies of the scene over speed, and the measured ones as points."""
        speeds = np.abs(self.speed)
        modes = max(int(self.mode.max()), 1)
        with unannounced():
            top = float(speeds.max())
            if not top:  # a range that suits the beam: measured frequencies may be far from its own
                first = float(np.nan_to_num(natural_modes(self.scene, 0.0, 1).frequency[0]))
                top = _ONE_SPEED * 2 * np.pi * (first or float(np.nanmin(self.measured)))
            locus = frequency_locus(self.scene, np.linspace(0.0, top, _PLACES), modes)
        ax = plot_locus(locus.speeds, locus.frequency, ax, units=self.display_units)
        per_si = self.display_units.speed_unit().per_si
        return mark_points(ax, speeds * per_si, self.measured, self.source or "measured")


_WORDS = {OUTSIDE: OUTSIDE, LEFT_OUT: "within what the model leaves out ({left_out})"}


def outside(left_out: float, own: float) -> str:
    """State that a deviation exceeds the model error and the data's uncertainty, both relative."""
    each = (left_out, "what the model leaves out"), (own, "the data's uncertainty")
    limits = [f"{name} ({percent(size)})" for size, name in each if size > NOTHING]
    return f"outside {' and '.join(limits) or 'the numerical error'}"
