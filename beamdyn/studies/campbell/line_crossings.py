"""Crossings of excitation lines with tracked natural frequencies, as accurate as the locus."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from beamdyn.modes.locus import Locus
from beamdyn.modes.modal.error_estimate import solve_with_error
from beamdyn.modes.modal.line_roots import ROUNDING, coincides, find_roots
from beamdyn.modes.modal.model import plane_share
from beamdyn.scene.motion.base import Line


@dataclass(frozen=True)
class LineCrossing:
    """Speed at which an excitation line meets a natural frequency.

    Parameters
    ----------
    label : str
        Label of the scene.
    line : Line
        The line: a multiple of the speed.
    mode : int
        Number of the mode, from 1, as in the locus.
    name : str
        Name of the mode, such as "flap 1".
    speed : float
        Speed [rad/s].
    frequency : float
        Natural frequency of the mode [Hz].
    error : float
        Estimated relative error of the speed.
    confidence : float
        Smallest confidence with which the mode was tracked from the first speed to this one: 1 is certain, 0
        a guess.
    plane_share : tuple of float
        Fractions of the mode's kinetic energy, at this speed, in the bending direction at the root and
        across.
    operating : bool
        Whether the speed is in the operating range; True if no range was given.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215, setting_angle=np.pi))
    >>> crossing = bd.campbell(scene, np.linspace(0, 200, 21), modes=1, per_rev=(4,)).crossings[0]
    >>> round(2 * np.pi * crossing.frequency / crossing.speed, 9)  # on the line: four a turn
    4.0
    """

    label: str
    line: Line
    mode: int
    name: str
    speed: float
    frequency: float
    error: float
    confidence: float
    plane_share: tuple[float, float]
    operating: bool


@dataclass(frozen=True)
class _Root:
    """Speed at which a line meets a natural frequency, which is given by its index in ascending order.

    `slope` is the derivative, with respect to the speed, of the natural angular frequency minus that of the
    line; `place` is the index.
    """

    line: Line
    place: int
    speed: float
    slope: float


def find_crossings(
    label: str,
    names: Sequence[str],
    locus: Locus,
    lines: Sequence[Line],
    operating: tuple[float, float] | None = None,
) -> list[LineCrossing]:
    """Find the crossings of excitation lines with the modes of a locus, by ascending speed.

    The roots are computed for frequencies in ascending order, which stay continuous where modes exchange
    their order; each root belongs to the tracked mode that is nearest there.

    Parameters
    ----------
    label : str
        Label of the scene.
    names : sequence of str, length m
        Names of the modes.
    locus : Locus
        The locus.
    lines : sequence of Line
        The lines.
    operating : (float, float), optional
        Operating range [rad/s].

    Returns
    -------
    list of LineCrossing
    """
    roots = sorted(_find_roots(locus, lines), key=lambda root: root.speed)
    if not roots:
        return []
    low, high = (-np.inf, np.inf) if operating is None else operating
    omega, shares = _solve(locus, np.array([root.speed for root in roots]))
    found = []
    for root, frequencies, share in zip(roots, omega, shares, strict=True):
        if (mode := _tracked_mode(locus, root, frequencies[root.place])) is None:
            continue  # an additional mode, computed only for the tracking
        node = _node(locus, root.speed)
        error = float(locus.error[node : node + 2, mode].max() * frequencies[root.place])
        along, across = share[root.place].tolist()
        found.append(
            LineCrossing(
                label=label,
                line=root.line,
                mode=mode + 1,
                name=names[mode],
                speed=root.speed,
                frequency=float(frequencies[root.place] / (2 * np.pi)),
                error=error / abs(root.slope * root.speed) + float(ROUNDING),
                confidence=float(locus.confidence[: node + 2, mode].min()),
                plane_share=(along, across),
                operating=bool(low <= root.speed <= high),
            )
        )
    return found


def coincident(locus: Locus, lines: Sequence[Line]) -> Iterator[tuple[Line, int]]:
    """Yield each line that equals a mode's frequency at every speed (as with a hinge), with the mode."""
    tracked = np.abs(np.imag(locus.eigenvalue))
    for line in lines:
        for mode, omega in enumerate(tracked.T):
            if coincides(omega - line.multiple * locus.speeds, omega):
                yield line, mode


def _find_roots(locus: Locus, lines: Sequence[Line]) -> Iterator[_Root]:
    omega, solved = np.abs(np.imag(locus.ascending)), {}

    def frequencies(speed: float) -> np.ndarray:
        if speed not in solved:
            solved[speed] = _frequencies(locus, np.array([speed]))[0]
        return solved[speed]

    for line in lines:
        for place, values in enumerate(omega.T):
            distance = values - line.multiple * locus.speeds
            if coincides(distance, values):
                continue

            def detuning(speed: float, place: int = place, multiple: float = line.multiple) -> float:
                return float(frequencies(speed)[place] - multiple * speed)

            for speed, slope in find_roots(detuning, locus.speeds, distance):
                yield _Root(line, place, speed, slope)


def _frequencies(locus: Locus, speeds: np.ndarray) -> np.ndarray:
    """Compute k angular frequencies [rad/s] at S speeds, ascending, with the model of the locus: (S, k)."""
    count = locus.ascending.shape[1]
    if locus.model.discretization.order is None:
        return np.abs(np.imag(locus.model.solver.eigenvalues(speeds, count)))
    modes = locus.eigenvalue.shape[1]  # finite elements: extrapolated, as in the locus
    return np.abs(np.imag(solve_with_error(locus.model, speeds, modes, count - modes).eigen.eigenvalue))


def _solve(locus: Locus, speeds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Compute k angular frequencies [rad/s] at S speeds, ascending, and energy fractions of planes.

    The shapes are (S, k) and (S, k, 2).
    """
    eigen = locus.model.solver.solve(speeds, locus.ascending.shape[1])
    extrapolated = locus.model.discretization.order is not None
    omega = _frequencies(locus, speeds) if extrapolated else np.abs(np.imag(eigen.eigenvalue))
    return omega, plane_share(locus.model.equations, eigen.vector)


def _node(locus: Locus, speed: float) -> int:
    """Return the index of the locus' last speed below a given speed, at most the last index but one."""
    return int(np.clip(np.searchsorted(locus.speeds, speed) - 1, 0, len(locus.speeds) - 2))


def _tracked_mode(locus: Locus, root: _Root, omega: float) -> int | None:
    """Return the index of the tracked mode whose frequency a line meets at a root; None if there is none."""
    node = _node(locus, root.speed)
    ends, tracked = locus.speeds[node : node + 2], np.abs(np.imag(locus.eigenvalue[node : node + 2]))
    modes = np.flatnonzero((locus.place[node : node + 2] == root.place).any(axis=0))
    if not modes.size:
        return None
    distances = [abs(np.interp(root.speed, ends, tracked[:, mode]) - omega) for mode in modes]
    return int(modes[np.argmin(distances)])


# Margins ------------------------------------------------------------------------------------------


AT_RATED, IN_RANGE = "rated speed", "operating range"


@dataclass(frozen=True)
class Margin:
    """Distance of the nearest line from a natural frequency: the ratio of line to frequency, less 1.

    Parameters
    ----------
    label : str
        Label of the scene.
    mode : int
        Number of the mode, from 1.
    name : str
        Name of the mode, such as "flap 1".
    where : {"rated speed", "operating range"}
        Speeds at which the nearest line is searched.
    line : Line
        The nearest line.
    speed : float
        Speed at which the line is nearest [rad/s].
    frequency : float
        Natural frequency at that speed [Hz].
    margin : float
        Frequency of the line over the natural frequency, less one: negative if the line is below; 0 if they
        cross.

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
    """Yield the margin of each mode that vibrates at the rated speed [rad/s], a speed of the locus."""
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
    """Yield each mode's smallest margin from a line of excitation over a range of operating speeds [rad/s].

    The margin is 0 if a line crosses the mode's frequency within the range.
    """
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
    """Yield the margin of each mode from the nearest line, over the speeds with given indices."""
    excited = np.outer(locus.speeds[at], [line.multiple for line in lines]) / (2 * np.pi)
    for mode, name in enumerate(names):
        frequency = locus.frequency[at, mode]
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = excited / frequency[:, None] - 1
        if not np.isfinite(ratio).any():
            continue  # the mode is unstable, or a free rotation with the frequency 0
        size = np.where(np.isfinite(ratio), np.abs(ratio), np.inf)
        s, n = divmod(int(size.argmin()), len(lines))
        speed, here = float(locus.speeds[at[s]]), float(frequency[s])
        yield Margin(label, mode + 1, name, where, lines[n], speed, here, float(ratio[s, n]))
