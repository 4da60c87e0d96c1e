"""Comparison of measured histories, peaks, loads and responses with computed ones, and whether each agrees.

In shapes of arrays, C counts curves.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from beamdyn.common.plots.axes_and_lines import panels, set_up_axes
from beamdyn.common.results.one_line import counted, number, warned
from beamdyn.common.results.pictures import COLOURS, Axes, new_axes
from beamdyn.common.results.result import plain
from beamdyn.common.results.statements import Speeds
from beamdyn.common.words import Words, amount, percent
from beamdyn.scene.scene import SceneResult
from beamdyn.studies.beside_data.frequency_comparison import AGREES, LEFT_OUT, NOTHING, OUTSIDE, outside

# Verdict if the numerical error is unknown, or if the model error is larger than the curve.
UNKNOWN = "not known"
_DIGITS = 5  # number of significant digits of values in sentences
_FEW = 100  # number of values up to which a plot draws them as points
_IN_PHASE = 1e-3  # phase difference [deg] too small to be mentioned
_VAIN = 1.0  # model error, relative to the largest value, above which no verdict is possible
# A curve counts as inverted if the opposite sign reduces the difference to at most this fraction.
_TURNED = 0.5
_WIDE = 0.8  # line width if a curve has more values than the plot has pixels


@dataclass(frozen=True)
class CurveComparison(SceneResult):
    """Measured curves over time, speed, position or frequency, compared with computed ones of a scene.

    Parameters
    ----------
    name : tuple of str, shape (C,)
        Quantity of each curve, such as "tip" or "tip by tip force".
    unit : tuple of str, shape (C,)
        Unit of each curve.
    along : str
        Abscissa of the curves: "time", "speed", "position" or "frequency".
    x : ndarray, shape (n,)
        Times [s], speeds [rad/s], positions [m] or frequencies [Hz].
    measured, computed : ndarray, shape (n, C)
        The values [unit of the curve].  Computed histories are delayed by `delay`: at time x they have the
        values of x - delay.  Responses are complex if the phase was measured.
    allowance : ndarray, shape (n, C)
        Possible error of the measured values [same unit]: `rounding` plus twice the uncertainty.
    rounding : ndarray, shape (n, C)
        Half a unit of the last digit of the measured values [same unit].
    error : ndarray, shape (n, C)
        Estimated numerical errors of the computed values [same unit].
    model_error : ndarray, shape (C,)
        Magnitude of the sum of the known changes by neglected effects, relative to the largest value.
    speed : float
        Speed at which loads and responses were computed [rad/s]; nan for other curves.
    delay : float
        Time by which measured histories lag behind the computed ones [s]; 0 for other curves.
    phase : ndarray, shape (C,)
        Phase by which the measured curve leads [rad]: for a history from the delay, at its main frequency;
        for a response at its maximum; nan if it is not known.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        How the curves were computed.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215))
    >>> pressed = [-0.3729, -0.1742]  # N, as the beam points inward
    >>> data = bd.MeasuredLoads([0.0, 0.025], pressed, ["axial"], speed=50.0, rounding=5e-5)
    >>> bd.compare(scene, data).verdict
    ('agrees',)
    """

    name: tuple[str, ...]
    unit: tuple[str, ...]
    along: str
    x: np.ndarray
    measured: np.ndarray
    computed: np.ndarray
    allowance: np.ndarray
    rounding: np.ndarray
    error: np.ndarray
    model_error: np.ndarray
    speed: float
    delay: float
    phase: np.ndarray
    source: str = field(default="", repr=False)

    field_units: ClassVar[dict[str, str]] = {"rad/s": "speed", "s": "delay", "rad": "phase"}

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"{self.verdict.count(AGREES)} of {counted(len(self.name), 'curve')} agree"
        yield f"largest values within {percent(float(np.abs(self.deviation).max()))}"
        yield f"rms {percent(float(self.rms.max()))}"
        yield warned(self.warnings)

    @property
    def places(self) -> np.ndarray:
        """Index of the largest measured value of each curve."""
        return np.abs(self.measured).argmax(axis=0)

    @property
    def peak(self) -> np.ndarray:
        """Largest measured magnitude of each curve [unit of the curve]."""
        return np.abs(self.measured).max(axis=0)

    @property
    def computed_peak(self) -> np.ndarray:
        """Largest computed magnitude of each curve at the same x [unit of the curve]."""
        return np.abs(self.computed).max(axis=0)

    @property
    def deviation(self) -> np.ndarray:
        """Largest measured minus largest computed value, divided by the computed; inf if only this is 0."""
        return _over(self.peak - self.computed_peak, self.computed_peak)

    @property
    def rms(self) -> np.ndarray:
        """Root mean square of the difference, divided by that of the computed curve."""
        return _over(_rms(self.measured - self.computed), _rms(self.computed))

    @property
    def is_turned(self) -> np.ndarray:
        """Whether each measured curve, if its sign is reversed, has less than half the rms difference."""
        return self.rms_turned < _TURNED * self.rms

    @property
    def rms_turned(self) -> np.ndarray:
        """Root mean square difference, as `rms`, if the signs of the measured curves are reversed."""
        return _over(_rms(self.measured + self.computed), _rms(self.computed))

    @property
    def in_digits(self) -> np.ndarray:
        """Whether curves differ, in peak and rms, by at most half a unit of the last measured digit."""
        half = self.rounding[self.places, np.arange(len(self.name))]
        within = _rms(self.measured - self.computed) <= _rms(self.rounding)
        return within & (np.abs(self.peak - self.computed_peak) <= half)

    @property
    def verdict(self) -> tuple[str, ...]:
        """Agreement of each curve: "agrees", "within the model error", "outside" or "not known".

        A curve agrees if the difference of the largest values, and the root mean square of the differences,
        are at most `allowance` plus `error`; it is within the model error if this suffices together with the
        model error.  With a model error larger than the curve, the agreement is "not known".
        """
        at = self.places, np.arange(len(self.name))
        off = np.array([np.abs(self.peak - self.computed_peak), _rms(self.measured - self.computed)])
        sure = np.array([(self.allowance + self.error)[at], _rms(self.allowance) + _rms(self.error)])
        left_out = self.model_error * np.array([self.computed_peak, _rms(self.computed)])
        each = [
            ~np.isfinite(sure).all(axis=0),
            (off <= sure).all(axis=0),
            self.model_error > _VAIN,
            (off <= sure + left_out).all(axis=0),
        ]
        return tuple(np.select(each, [UNKNOWN, AGREES, UNKNOWN, LEFT_OUT], OUTSIDE).tolist())

    @property
    def agrees(self) -> bool:
        """Whether all curves agree within `allowance` plus `error`."""
        return set(self.verdict) == {AGREES}

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain numbers, lists and strings, with deviations, verdicts and sentences."""
        names = "peak", "computed_peak", "deviation", "rms", "verdict"
        more = {name: plain(getattr(self, name)) for name in names}
        return super().to_dict() | more | {"sentences": plain(self.sentences())}

    def sentences(self) -> tuple[str, ...]:
        """Return a sentence about each curve, with the verdict."""
        return tuple(self._say(k) for k in range(len(self.name)))

    def _say(self, k: int) -> Words:
        """Describe the comparison of curve k as a sentence."""
        at_speed = (" at ", Speeds(self.speed)) if np.isfinite(self.speed) else ()
        largest = say(self.peak[k], self.unit[k]), " at ", self._where(float(self.x[self.places[k]]))
        start = self.name[k], *at_speed, ": the largest, ", *largest
        if self.in_digits[k]:
            said = ", and the whole curve agree to the digits of the data"
            return Words(*start, said, self._shifted(k), ".")
        rms = float(self.rms[k])
        whole = f", and the whole curve differs by {percent(rms)} (rms)" if np.isfinite(rms) else ""
        more = self._shifted(k), self._signed(k), f": {self._reason(k)}."
        return Words(*start, ", is ", *self._beside(k), whole, *more)

    def _beside(self, k: int) -> tuple[str, ...]:
        """State how the largest value of curve k compares with the computed one."""
        deviation, computed = float(self.deviation[k]), say(self.computed_peak[k], self.unit[k])
        if np.isinf(deviation):
            return ("compared with 0 in the model",)
        if abs(deviation) <= NOTHING:
            return "the same as ", computed
        return f"{percent(abs(deviation))} {'below' if deviation < 0 else 'above'} ", computed

    def _where(self, at: float) -> str:
        """Describe a point on the abscissa: a time, speed, position or frequency with its unit."""
        if self.along == "position":
            return amount(at)
        return Speeds(at) if self.along == "speed" else number(at, "s" if self.along == "time" else "Hz")

    def _signed(self, k: int) -> str:
        """State that measured curve k has the opposite sign of the computed one; empty text otherwise."""
        if not self.is_turned[k]:
            return ""
        left = percent(float(self.rms_turned[k]))
        return f"; its sign is opposite: with the other sign the whole curve differs by {left}"

    def _shifted(self, k: int) -> str:
        """State how far measured curve k leads or lags the computed one; empty text if they are in phase."""
        phase = float(np.degrees(self.phase[k]))
        if not abs(phase) > _IN_PHASE:  # this form of the condition treats nan as in phase
            return ""
        side = "ahead" if phase > 0 else "behind"
        if self.along == "frequency":
            return f", {abs(phase):.3g} deg {side} there"
        late = f"{abs(self.delay):.3g} s ({abs(phase):.3g} deg of its main frequency)"
        return f", after a shift by {late}, by which the data are {side}"

    def _reason(self, k: int) -> str:
        """State the reason for the verdict on curve k."""
        left_out = float(self.model_error[k])
        own = float(_over(self.allowance[self.places[k], k], self.peak[k]))
        lacking = "the numerical error is not known"
        if left_out > _VAIN:
            lacking = f"what the model leaves out ({percent(left_out)}) is more than the curve itself"
        of_data = f"the data's uncertainty ({percent(own)} of the maximum) and " if own > NOTHING else ""
        return {
            AGREES: f"within {of_data}the numerical error",
            LEFT_OUT: f"within what the model leaves out ({percent(left_out)})",
            OUTSIDE: outside(left_out, own),
            UNKNOWN: f"no verdict, as {lacking}",
        }[self.verdict[k]]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw each curve as measured and as computed, and for a response the phases."""
        curves = [(self._axis(k), *self._drawn(k)) for k in range(len(self.name))]
        if np.iscomplexobj(self.measured):
            turned = np.unwrap(np.angle(self.computed[:, 0]))
            ahead = np.angle(self.measured[:, 0] * self.computed[:, 0].conj())
            curves.append(("phase [deg]", np.degrees(turned + ahead), np.degrees(turned)))
        if len(curves) > 1:
            ax, places = panels(len(curves), ax, columns=1)
        else:
            ax = new_axes() if ax is None else ax
            places = [ax]
        units = self.display_units
        x = {"position": units.length_unit("m"), "speed": units.speed_unit()}.get(self.along)
        label = f"{self.along} [{x.name if x else {'time': 's'}.get(self.along, 'Hz')}]"
        for place, (name, measured, computed) in zip(places, curves, strict=True):
            set_up_axes(place, label if place is places[-1] else "", name)
            self._draw(place, x.of(self.x) if x else self.x, measured, computed)
        if self.along == "frequency" and (self.peak > 0).all():
            places[0].set_yscale("log")
        places[0].legend(loc="lower left", bbox_to_anchor=(0.0, 1.01), ncols=2, borderaxespad=0, fontsize=10)
        return ax

    def _axis(self, k: int) -> str:
        return f"{self.name[k]} [{self._unit_shown(k) or '-'}]"

    def _unit_shown(self, k: int) -> str:
        return self.display_units.length_unit().name if self.unit[k] == "m" else self.unit[k]

    def _drawn(self, k: int) -> tuple[np.ndarray, np.ndarray]:
        """Return measured and computed curve k in the unit of the plot; for a response the magnitudes."""
        size = self.display_units.length_unit().per_si if self.unit[k] == "m" else 1.0
        shown = abs if self.along == "frequency" else np.real
        return size * shown(self.measured[:, k]), size * shown(self.computed[:, k])

    def _draw(self, ax: Axes, x: np.ndarray, measured: np.ndarray, computed: np.ndarray) -> None:
        width = 1.8 if len(x) <= _FEW else _WIDE
        ax.plot(x, computed, color=COLOURS[0], linewidth=width, label="computed")
        style = (
            {"marker": "o", "linestyle": "", "markerfacecolor": "white"} if len(x) <= _FEW else {"ls": "--"}
        )
        ax.plot(x, measured, color="black", linewidth=width, label=self.source or "measured", **style)  # pyright: ignore[reportArgumentType]


def say(value: float, unit: str) -> str:
    """Format a value with few digits and its unit; each output medium has its own unit of length."""
    rounded = float(f"{value:.{_DIGITS}g}")
    return amount(rounded) if unit == "m" else f"{rounded:.{_DIGITS}g} {unit}".rstrip()


def _rms(values: np.ndarray) -> np.ndarray:
    return np.sqrt((np.abs(values) ** 2).mean(axis=0))


def _over(values: Any, sizes: Any) -> np.ndarray:
    """Divide values by sizes; 0 where both are 0, inf where only the size is 0."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(np.asarray(values) == 0, 0.0, np.asarray(values) / sizes)
