"""Crossings of excitation lines with natural frequencies, and the list of them as a result."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from beamdyn.common.numerics import number_groups
from beamdyn.common.plots.campbell import Curves, plot_campbell
from beamdyn.common.results.one_line import error_at_most, listed, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.statements import Speeds
from beamdyn.common.words import Words
from beamdyn.modes.modal.discretization_choice import choose_model
from beamdyn.modes.modal.model import Model
from beamdyn.modes.model_error.left_out_changes import find_unlisted, left_out_of_modes, nothing_known
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, StatesModelError
from beamdyn.scene.motion.base import Line
from beamdyn.scene.scene import SceneResult

KINDS = ("forced", "parametric")
_SAME_SPEED = 1e-9  # relative difference of speeds that count as equal
_STEP = 1e-4  # relative step of the speed for the slope of the frequencies
_FURTHER_MODES = 2  # number of modes solved in addition: the order of modes may change with speed


@dataclass(frozen=True)
class Crossing:
    """Crossing of an excitation line with a natural frequency, at one speed.

    Parameters
    ----------
    line : Line
        Line of the excitation.
    mode : int
        Number of the mode, from 1, in the order at rest.
    speed : float
        Speed [rad/s].
    frequency : float
        Natural frequency of the mode [Hz].
    kind : {"forced", "parametric"}
        "forced": natural frequency = line.  "parametric": twice the natural frequency, or the sum of the
        frequencies of `mode` and `second_mode`, = line; the periodic stiffness makes the beam unstable.
    error : float
        Estimated relative error of the speed.
    second_mode : int or None
        Number of the other mode of a combination resonance.
    plane_share : tuple of float
        Share of the mode's kinetic energy, at this speed, in the direction of bending at the root and across.
    second_plane_share : tuple of float or None
        Shares of the other mode of a combination resonance.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> wheel = bd.RollingWheel(0.3, 55.0, bd.RoadWave(0.3, velocity_amplitude=0.01))
    >>> found = bd.resonance_speeds(bd.Scene(strip, bd.Mount(radius=0.215), wheel), top_speed=150.0, modes=1)
    >>> first = found.crossings[0]
    >>> first.mode, first.kind, round(first.frequency, 3)
    (1, 'forced', 61.535)
    """

    line: Line
    mode: int
    speed: float
    frequency: float
    kind: str
    error: float
    second_mode: int | None = None
    plane_share: tuple[float, float] = (1.0, 0.0)
    second_plane_share: tuple[float, float] | None = None


def order_by_speed(crossings: Sequence[Crossing]) -> tuple[Crossing, ...]:
    """Sort crossings by speed, and those at one speed by kind and modes, so that rounding does not decide."""
    by_speed = sorted(crossings, key=lambda crossing: crossing.speed)
    places = number_groups(np.array([crossing.speed for crossing in by_speed]), _SAME_SPEED)
    keyed = [
        (at, each.kind, each.mode, each.second_mode or each.mode, k)
        for k, (at, each) in enumerate(zip(places, by_speed, strict=True))
    ]
    return tuple(by_speed[k] for *_, k in sorted(keyed))


def label_crossing(line: Line, kind: str, mode: int, second_mode: int | None = None) -> str:
    """Return the label of a crossing for tables and plots: modes, line and kind."""
    modes = f"mode {mode}" if second_mode is None else f"modes {mode} and {second_mode}"
    return f"{modes}, {line.name} ({kind})"


@dataclass(frozen=True)
class Crossings(SceneResult, StatesModelError, Sequence[Crossing]):
    """List of crossings of excitation lines with natural frequencies, by ascending speed.

    Parameters
    ----------
    crossings : tuple of Crossing
        The crossings.
    lines : tuple of Line
        Excitation lines that force the beam.
    speeds : ndarray, shape (S,)
        Speeds of the locus [rad/s], up to the top speed or the critical one.
    frequency : ndarray, shape (S, m)
        Natural frequencies of m modes [Hz], in the order at rest.
    order : int
        Highest order of the excitation lines in the search, as in `resonance_speeds`.
    unlisted : int
        Number of crossings of the next order, which are weaker and not listed; those of still higher
        order are not counted.
    may_peak : int
        Number of unlisted forced crossings: near each the steady response may have a peak.  Parametric
        crossings cause no peak: where damping is too weak, free motion grows there.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result, and why there is no crossing.
    provenance : Provenance
        How the result was computed.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> wheel = bd.RollingWheel(0.3, 55.0, bd.RoadWave(0.3, velocity_amplitude=0.01))
    >>> found = bd.resonance_speeds(bd.Scene(strip, bd.Mount(radius=0.215), wheel), top_speed=150.0, modes=1)
    >>> [line.name for line in found.lines]
    ['road -', 'road +']
    """

    crossings: tuple[Crossing, ...]
    lines: tuple[Line, ...]
    speeds: np.ndarray
    frequency: np.ndarray
    order: int
    unlisted: int
    may_peak: int

    def headline(self) -> Iterator[str]:
        """Yield number, speeds and error of the crossings for a one-line summary; see `Result.headline`."""
        yield f"{len(self)} up to {self.say_speed(self.speeds[-1])}"
        unit, factor = self.display_units.speed_unit()
        yield listed([c.speed * factor for c in self], unit)
        yield from (error_at_most([c.error for c in self]) if len(self) else "", warned(self.warnings))

    def __getitem__(self, index):  # pyright: ignore[reportIncompatibleMethodOverride]
        return self.crossings[index]

    def __len__(self) -> int:
        return len(self.crossings)

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """Relative changes of each crossing's speed by the effects left out of the model."""
        if not self.crossings:
            return nothing_known(self.scene)
        speeds, modes = np.array([c.speed for c in self]), self.frequency.shape[1]
        first = 2 * np.pi * np.array([c.frequency for c in self])
        second = [c.line.multiple * c.speed - f for c, f in zip(self, first, strict=True)]
        single = [c.second_mode is None for c in self]
        pairs = np.stack([first, np.where(single, first, second)], axis=1)
        model = choose_model(self.scene, "ritz", speeds, modes + _FURTHER_MODES, 1e-6)
        return left_out_of_crossings(model, speeds, pairs, modes)

    @property
    def extent(self) -> str:
        """Sentence on the range and order of the search, and on crossings left out."""
        sought = f"Sought to order {self.order} up to ", Speeds(self.speeds[-1])
        if not self.unlisted:
            return Words(*sought, f"; there are none of order {self.order + 1}.")
        crossings = f"{self.unlisted} crossing{'s' * (self.unlisted != 1)} of order {self.order + 1}"
        weaker = *sought, f"; {crossings}, and those of higher order, are weaker and left out"
        if not self.may_peak:
            return Words(*weaker, ".")
        forced = (
            "this crossing is"
            if self.unlisted == 1
            else f"{self.may_peak} of these crossings {'is' if self.may_peak == 1 else 'are'}"
        )
        return Words(*weaker, f": {forced} forced, where the steady response may have a peak.")

    def plot(self, ax: Axes | None = None) -> Axes:
        """Plot the Campbell diagram: natural frequencies and lines over speed, with the crossings marked."""
        lines = {line.name: line.multiple for line in self.lines}
        marked = {kind: [(c.speed, c.frequency) for c in self if c.kind == kind] for kind in KINDS}
        names = tuple(f"mode {i}" for i in range(1, self.frequency.shape[1] + 1))
        unit = self.display_units.speed_unit().name
        return plot_campbell([Curves(self.speeds, self.frequency, names)], lines, marked, ax, unit)


def left_out_of_crossings(
    model: Model, speeds: np.ndarray, frequencies: np.ndarray, modes: int
) -> LeftOutEffects:
    """Estimate relative changes of resonance speeds (k,) by each effect left out, to first order.

    The relative change of a resonance speed is that of the frequency divided by 1 - (v/f) df/dv, with the
    speed v and the sum f of the frequencies that resonate.

    Parameters
    ----------
    model : Model
        The model with which the speeds were found.
    speeds : ndarray, shape (k,)
        Resonance speeds [rad/s].
    frequencies : ndarray, shape (k, 2)
        Angular frequencies of the two modes that resonate [rad/s]; of a single mode twice.
    modes : int
        Number of the modes that were sought.
    """
    at = np.concatenate([speeds, speeds * (1 + _STEP), speeds * (1 - _STEP)])
    here, above, below = model.solver.solve(at, modes + _FURTHER_MODES).eigenvalue.reshape(3, len(speeds), -1)
    effects = left_out_of_modes(model, speeds, here)
    nearest = _nearest(here, frequencies)
    size = np.take_along_axis(np.imag(here), nearest, axis=1)
    rise, fall = (np.take_along_axis(np.imag(s), _nearest(s, size), axis=1) for s in (above, below))
    detuning = size.sum(axis=1) - ((rise - fall) / (2 * _STEP)).sum(axis=1)

    def of_speeds(change: np.ndarray) -> np.ndarray:
        return (size * np.take_along_axis(change, nearest, axis=1)).sum(axis=1) / detuning

    changes = {name: of_speeds(change) for name, change in effects.changes.items()}
    unlisted = tuple(find_unlisted(model, speeds, here[:, :modes]))
    return replace(effects, changes=changes, shape=speeds.shape, unlisted=unlisted)


def _nearest(eigenvalue: np.ndarray, frequency: np.ndarray) -> np.ndarray:
    """Find, at each of k crossings, which of m eigenvalues (k, m) are nearest to two frequencies (k, 2)."""
    return np.abs(np.imag(eigenvalue)[:, None, :] - frequency[:, :, None]).argmin(axis=2)
