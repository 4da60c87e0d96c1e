"""Margins: relative distances of per-rev lines from natural frequencies at operating speeds."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from beamdyn.modes.locus import Locus
from beamdyn.scene.motion import Line
from beamdyn.studies.campbell.crossings import LineCrossing

AT_RATED, IN_RANGE = "rated speed", "operating range"


@dataclass(frozen=True)
class Margin:
    """Distance of the nearest line from a natural frequency: line over frequency, less one.

    Parameters
    ----------
    label : str
        Label of the scene.
    mode : int
        Number of the mode, from 1.
    name : str
        Its name, such as "flap 1".
    where : {"rated speed", "operating range"}
        Where the nearest line is sought.
    line : Line
        The nearest line.
    speed : float
        The speed at which it is nearest [rad/s].
    frequency : float
        Natural frequency there [Hz].
    margin : float
        Frequency of the line over the natural frequency, less one: negative where the line is below; 0
        where they cross.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215, setting_angle=np.pi))
    >>> margin = bd.campbell(scene, np.linspace(0, 200, 21), modes=1, per_rev=(3, 4), rated=130.0).margins[0]
    >>> margin.where, margin.mode
    ('rated speed', 1)
    """

    label: str
    mode: int
    name: str
    where: str
    line: Line
    speed: float
    frequency: float
    margin: float


def margins_at_rated(
    label: str, names: Sequence[str], locus: Locus, lines: Sequence[Line], rated: float
) -> Iterator[Margin]:
    """Margin of each mode that vibrates at the rated speed [rad/s], which is one of the locus."""
    at = np.abs(locus.speeds - rated).argmin()
    yield from _nearest(label, names, locus, lines, np.array([at]), AT_RATED)


def margins_in_range(
    label: str,
    names: Sequence[str],
    locus: Locus,
    lines: Sequence[Line],
    operating: tuple[float, float],
    crossings: Sequence[LineCrossing],
) -> Iterator[Margin]:
    """Least margin of each mode over the speeds of an operating range [rad/s]; 0 where a line crosses it."""
    low, high = operating
    inside = np.flatnonzero((locus.speeds >= low) & (locus.speeds <= high))
    crossed = {c.mode: c for c in reversed(crossings) if low <= c.speed <= high}
    for margin in _nearest(label, names, locus, lines, inside, IN_RANGE):
        c = crossed.get(margin.mode)
        if c is None:
            yield margin
        else:
            yield Margin(label, c.mode, c.name, IN_RANGE, c.line, c.speed, c.frequency, 0.0)


def _nearest(
    label: str, names: Sequence[str], locus: Locus, lines: Sequence[Line], at: np.ndarray, where: str
) -> Iterator[Margin]:
    """Margin of each mode from the nearest of all lines at speeds of some indices (s,)."""
    excited = np.outer(locus.speeds[at], [line.multiple for line in lines]) / (2 * np.pi)
    for mode, name in enumerate(names):
        frequency = locus.frequency[at, mode]
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = excited / frequency[:, None] - 1
        if not np.isfinite(ratio).any():
            continue  # unstable, or free to turn at the frequency 0
        size = np.where(np.isfinite(ratio), np.abs(ratio), np.inf)
        s, n = divmod(int(size.argmin()), len(lines))
        speed, here = float(locus.speeds[at[s]]), float(frequency[s])
        yield Margin(label, mode + 1, name, where, lines[n], speed, here, float(ratio[s, n]))
