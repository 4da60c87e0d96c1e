"""Power spectral densities of random inputs: tables, and roads by ISO 8608.

The module also finds the excitation and density of a random input at a steady speed, and frequencies at which
to list the density of a random response, so that straight lines between its values enclose its area.  These
frequencies are dense where the input's density is steep, and about each resonance, down to its bandwidth.  An
input that does not turn with the beam appears shifted by the speed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal, get_args

import numpy as np

from beamdyn.common.inputs.checks import (
    InvalidValue,
    ascending,
    kind,
    one_of,
    positive,
    real_array,
    refuse,
    set_fields,
)
from beamdyn.common.inputs.described import Described
from beamdyn.common.words import Words
from beamdyn.linear.inputs_outputs import BaseMotion, Excitation, as_excitation
from beamdyn.linear.model_at_speed import ModelAtSpeed
from beamdyn.scene.motion.rolling import RollingWheel
from beamdyn.scene.names_elsewhere import ROLLING_WHEEL
from beamdyn.scene.scene import Scene

BetweenPoints = Literal["linear", "log"]
# Largest ratio of end to start frequency of an interval on which a power law is nearly a polynomial.
_WIDEST = 1.5

REFERENCE = 0.1  # spatial frequency n0 of ISO 8608 [1/m]
# Geometric means of the displacement PSD at n0 [m3]: ISO 8608:2016, table C.1.
ISO_CLASSES = {name: 16e-6 * 4.0**k for k, name in enumerate("ABCDEFGH")}


@dataclass(frozen=True)
class SpectrumPiece:
    """Interval of a spectrum on which the density is one analytic function of frequency.

    Parameters
    ----------
    start, end : float
        Ends of the interval [Hz].
    constant, slope : float
        Coefficients of a straight line, `constant` + `slope` f; the slope is 0 for a power law.
    power : float
        Exponent of a power law, `constant` (f / `start`)^`power`; 0 for a straight line.
    """

    start: float
    end: float
    constant: float
    slope: float = 0.0
    power: float = 0.0

    def __call__(self, f: np.ndarray) -> np.ndarray:
        """Evaluate the density at real or complex frequencies [Hz]."""
        if self.power:
            return self.constant * (f / self.start) ** self.power
        return self.constant + self.slope * f

    def divided(self) -> tuple[np.ndarray, np.ndarray]:
        """Return starts and ends [Hz], (P, 1) each, of P shorter intervals.

        On each of them a power law is nearly a polynomial.
        """
        ends = np.array([[self.start], [self.end]])
        if self.power:
            parts = math.ceil(math.log(self.end / self.start, _WIDEST))
            ends = np.geomspace(self.start, self.end, parts + 1)[:, None]
        return ends[:-1], ends[1:]


@dataclass(frozen=True)
class PowerSpectrum:
    """One-sided power spectral density of an input, whose integral over frequency is its mean square.

    Parameters
    ----------
    frequencies : sequence of float
        Frequencies [Hz], ascending from 0 or more; the density is 0 outside.
    values : sequence of float
        Density at the frequencies [unit of the input squared per Hz], 0 or more.
    interpolation : "log" or "linear"
        Straight lines between points on logarithmic axes, as in standards, or on linear axes.

    Raises
    ------
    ValueError
        If a density is negative, the frequencies do not ascend from 0 or more, their numbers differ, or a
        frequency or a density is 0 on logarithmic axes.

    References
    ----------
    Standard: one-sided spectral densities.

    Examples
    --------
    >>> flat = bd.PowerSpectrum([5.0, 500.0], [1.0, 1.0])
    >>> round(float(flat.rms), 3)  # sqrt(495)
    22.249
    """

    frequencies: Sequence[float]
    values: Sequence[float]
    interpolation: BetweenPoints = "log"

    def __post_init__(self) -> None:
        one_of("interpolation", self.interpolation, get_args(BetweenPoints))
        f, S = ascending("psd.frequencies", self.frequencies), real_array("psd.values", self.values)
        if len(f) != len(S) or len(f) < 2:
            bound = f"give as many values (here {len(S)}) as frequencies ({len(f)}), at least two"
            raise InvalidValue("psd.values", self.values, bound)
        refuse(f < 0, "psd.frequencies", f, "Hz", "give 0 or more: the density is one-sided")
        refuse(
            S < 0, "psd.values", S, "", "a power spectral density is not negative", "check signs and units"
        )
        if self.interpolation == "log":
            remedy = 'leave the point out, or give interpolation = "linear"'
            refuse(f == 0, "psd.frequencies", f, "Hz", "logarithmic axes have no 0", remedy)
            refuse(S == 0, "psd.values", S, "", "logarithmic axes have no 0", remedy)
        set_fields(self, frequencies=tuple(f.tolist()), values=tuple(S.tolist()))

    def pieces(self) -> Iterator[SpectrumPiece]:
        """Yield the intervals of the spectrum between its points."""
        f, S = self.frequencies, self.values
        for a, b, low, high in zip(f[:-1], f[1:], S[:-1], S[1:], strict=True):
            if self.interpolation == "log":
                power = math.log(high / low) / math.log(b / a)
                yield SpectrumPiece(a, b, low, 0.0, round(power, 12))
            else:
                slope = (high - low) / (b - a)
                yield SpectrumPiece(a, b, low - slope * a, slope)

    def at(self, frequencies: np.ndarray) -> np.ndarray:
        """Evaluate the density at frequencies [Hz]: 0 outside the given range and for negative ones."""
        f, points, values = np.asarray(frequencies, dtype=float), self.frequencies, self.values
        inside = (f >= points[0]) & (f <= points[-1])
        if self.interpolation == "linear":
            return np.where(inside, np.interp(f, points, values), 0.0)
        safe = np.where(inside, f, points[0])
        return np.where(inside, np.exp(np.interp(np.log(safe), np.log(points), np.log(values))), 0.0)

    @property
    def rms(self) -> float:
        """Root mean square of the input [unit of the input]."""
        nodes, weights = np.polynomial.legendre.leggauss(16)
        parts = [(piece, *piece.divided()) for piece in self.pieces()]
        each = (
            (b - a) / 2 * piece((a + b) / 2 + nodes * (b - a) / 2) @ weights[:, None] for piece, a, b in parts
        )
        return math.sqrt(math.fsum(v for values in each for v in values[:, 0].tolist()))


@dataclass(frozen=True)
class RoadRoughness:
    """A random road by ISO 8608, with the height's density G(n0) (n/n0)^-w over spatial frequency n.

    Parameters
    ----------
    roughness : float or str
        Density G(n0) at n0 = 0.1 1/m [m3], or a class from "A" (very good, 16e-6 m3) to "H", each 4 times as
        rough as the one before.
    waviness : float
        Exponent w, nondimensional.
    lowest, highest : float
        Spatial frequencies between which the road is rough [1/m].

    Raises
    ------
    ValueError
        If a value is not positive, the class is unknown, or the frequencies do not ascend.

    References
    ----------
    ISO 8608:2016, table C.1.

    Examples
    --------
    >>> bd.RoadRoughness("C").roughness  # m3, ISO 8608 at 0.1 1/m
    'C'
    """

    roughness: Annotated[Any, Described("m3", "G", "density of the height at 0.1 1/m", above=0)]
    waviness: float = 2.0
    lowest: float = 0.011
    highest: float = 2.83

    def __post_init__(self) -> None:
        if isinstance(self.roughness, str):
            one_of("road.roughness", self.roughness, [*ISO_CLASSES])
        for name, unit in (("waviness", ""), ("lowest", "1/m"), ("highest", "1/m")):
            set_fields(self, **{name: positive(f"road.{name}", getattr(self, name), unit)})
        if not isinstance(self.roughness, str):
            set_fields(self, roughness=positive("road.roughness", self.roughness, "m3"))
        bound = "it must be below {other} = {limit}"
        bad = self.lowest >= self.highest
        highest = {"limit": self.highest, "other": "road.highest"}
        refuse(bad, "road.lowest", self.lowest, "1/m", bound, "raise {other}", **highest)

    @property
    def density(self) -> float:
        """Density G(n0) of the road at the reference wavenumber n0 [m3]."""
        return ISO_CLASSES[self.roughness] if isinstance(self.roughness, str) else self.roughness

    @property
    def words(self) -> str:
        """Describe the road in words: class or density, and the highest spatial frequency."""
        name = f"class {self.roughness}" if isinstance(self.roughness, str) else f"{self.roughness:g} m3"
        return f"{name}, up to {self.highest:g} 1/m"

    def acceleration(self, velocity: float) -> PowerSpectrum:
        """Compute the density of vertical acceleration [(m/s2)2/Hz] of a wheel on the road.

        At the frequency f = n v, with the velocity v [m/s], the density is (2 pi f)^4 G(n) / v.
        """
        v = positive("velocity", abs(velocity), "m/s", "at rest a road excites nothing")
        n = np.array([self.lowest, self.highest])
        height = self.density * (n / REFERENCE) ** -self.waviness / v
        return PowerSpectrum((n * v).tolist(), ((2 * np.pi * n * v) ** 4 * height).tolist())


# Random inputs at a steady speed: excitation and density ---------------------------------------------


_TURN = 2 * np.pi


def random_input(
    scene: Scene, speed: float, psd: PowerSpectrum | RoadRoughness | float, given: Excitation | str | None
) -> tuple[Excitation, PowerSpectrum | float]:
    """Return the excitation and its spectral density; a road is converted to the wheel's acceleration.

    Raises
    ------
    InvalidValue
        If a road is given with another input, without a wheel or a speed, or `psd` is no density.
    """
    if isinstance(psd, RoadRoughness):
        if given not in (None, "n2", BaseMotion("n2")):
            raise InvalidValue("input", given, "a road moves the wheel along n2", "leave the input out")
        wheel = scene.motion
        if not isinstance(wheel, RollingWheel):
            bound, remedy = "a road needs the rolling radius of a wheel", Words("give ", ROLLING_WHEEL)
            raise InvalidValue("scene.motion", wheel and type(wheel).__name__, bound, remedy)
        refuse(speed == 0, "speed", speed, "rad/s", "at rest a road excites nothing", "give a speed")
        return BaseMotion("n2"), psd.acceleration(wheel.rolling_radius * speed)
    excitation = as_excitation("input", "bending" if given is None else given)
    if isinstance(psd, PowerSpectrum):
        return excitation, psd
    if not hasattr(psd, "__float__"):
        kind("psd", psd, PowerSpectrum, "PowerSpectrum(frequencies, values), a RoadRoughness, or a number")
    return excitation, positive("psd", psd, "", "give the density of white noise")


def highest_frequency(spectrum: PowerSpectrum | float) -> float:
    """Return the highest frequency of the input [Hz]; 0 for white noise."""
    return spectrum.frequencies[-1] if isinstance(spectrum, PowerSpectrum) else 0.0


def warn_of_band(spectrum: PowerSpectrum | float, drive: Excitation, model: ModelAtSpeed) -> Iterator[str]:
    """Yield a warning if the input lacks a frequency that excites the first resonance.

    An input of fixed direction excites the beam at the input's frequency plus and minus that of rotation.
    """
    resonances = np.abs(np.imag(model.free_motion.finite_poles)) / _TURN
    if not isinstance(spectrum, PowerSpectrum) or not resonances.any():
        return
    first = resonances[resonances > 0].min()
    shifts = np.array([*model.drives(drive)]) * model.speed / _TURN
    exciting = np.unique(np.abs(first + shifts))
    lowest, highest = spectrum.frequencies[0], spectrum.frequencies[-1]
    missing = exciting[(exciting < lowest) | (exciting > highest)]
    if missing.size:
        by, lacks = (" and ".join(f"{f:.4g}" for f in each) for each in (exciting, missing))
        yield (
            f"the first resonance, at {first:.4g} Hz, is excited by inputs at {by} Hz, but the input has "
            f"{lowest:.4g} to {highest:.4g} Hz: what {lacks} Hz excites is not in the answer; "
            "extend the input"
        )


# Frequencies of the density of a random response --------------------------------------------------


_STEP = 0.02  # relative step between listed frequencies of the input
# Largest logarithm of the ratio of the input's densities at two neighbouring listed frequencies.
_STEEPEST = 0.1
_DECADES = 3  # number of decades in which frequencies are listed for an interval that begins at 0
_CLOSE = 0.2  # step near a resonance, relative to the larger of its half bandwidth and the distance from it
# Frequencies about a resonance are listed up to a distance from it on both sides: the resonance frequency
# plus this number of half bandwidths.
_REACH = 30.0
# Relative distance between the end of an input's range and a listed frequency just outside it, at which the
# density is 0.
_BESIDE = 1e-6
_SAME = 1e-13  # relative distance below which two frequencies are the same


def frequencies_of_response(
    spectrum: PowerSpectrum, poles: np.ndarray, shifts: Sequence[float]
) -> np.ndarray:
    """List frequencies at which an input causes a response [Hz], ascending.

    Parameters
    ----------
    spectrum : PowerSpectrum
        The density of the input.
    poles : ndarray of complex
        Poles of the response [1/s], all of them damped.
    shifts : sequence of float
        Response frequency minus input frequency [Hz].

    Returns
    -------
    ndarray
    """
    of_input = np.concatenate([_frequencies_of(piece) for piece in spectrum.pieces()])
    ends = np.array([of_input[0] * (1 - _BESIDE), of_input[-1] * (1 + _BESIDE)])
    excited, beside = (_shifted(f, shifts) for f in (of_input, ends))
    about = np.concatenate([beside, about_resonances(poles)])
    inside = (about > excited.min()) & (about < excited.max())
    return one_of_each(np.concatenate([excited, about[inside]]))


def _frequencies_of(piece: SpectrumPiece) -> np.ndarray:
    """List frequencies [Hz] of one interval of the input's spectrum, in a geometric sequence."""
    start = piece.start or piece.end / 10**_DECADES
    steps = math.log(piece.end / start) * max(1 / _STEP, abs(piece.power) / _STEEPEST)
    between = np.geomspace(start, piece.end, math.ceil(steps) + 1)[1:-1]
    return np.concatenate([[piece.start], between, [piece.end]])


def _shifted(f: np.ndarray, shifts: Sequence[float]) -> np.ndarray:
    """Compute response frequencies [Hz] from input frequencies f [Hz] as +-f plus each shift [Hz]."""
    return np.concatenate([np.abs(shift + each) for shift in shifts for each in (f, -f)])


def about_resonances(poles: np.ndarray) -> np.ndarray:
    """List non-negative frequencies [Hz], unsorted, that are dense near the resonances of poles."""
    each = [_about(float(pole.imag), -float(pole.real)) for pole in poles / _TURN if pole.imag >= 0]
    f = np.concatenate([*each, np.empty(0)])
    return f[f >= 0]


def _about(centre: float, half_width: float) -> np.ndarray:
    """List frequencies [Hz] near a centre in steps proportional to the distance from it."""
    reach = np.arcsinh(_REACH + centre / half_width)
    side = half_width * np.sinh(np.linspace(0.0, reach, math.ceil(reach / _CLOSE) + 1))
    return np.concatenate([centre - side[:0:-1], centre + side])


def one_of_each(f: np.ndarray) -> np.ndarray:
    """Sort frequencies, and remove duplicates within rounding."""
    f = np.unique(f)
    return f[np.diff(f, prepend=-1.0) > _SAME * f]
