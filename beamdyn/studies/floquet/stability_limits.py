"""Stability limits: curves that bound stable regions over two numbers of a scene in periodic motion.

They are computed by continuation, as the roots of a function that is smooth across them.  With damping it is
the logarithm of the largest multiplier.  Without damping two multipliers m +- sqrt(s) meet on the unit circle
(at 1 or -1 in a principal tongue, elsewhere for a combination resonance): the function is s, computed from
their distance if both are on the circle, and from the growth if they left it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from os import PathLike
from time import perf_counter
from typing import NamedTuple

import numpy as np
from scipy.optimize import toms748

from beamdyn.common.inputs.described import VariedInput
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.results.one_line import counted, warned
from beamdyn.common.results.pictures import COLOURS, Axes, add_legend
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import TOLERANCE, Statement, announced_of_plain_beam
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.scene.scene import Scene, SceneResult
from beamdyn.studies.floquet.monodromy import PeriodicScenes
from beamdyn.studies.floquet.multipliers import STABLE, UNSTABLE, Multipliers, multipliers_of
from beamdyn.studies.floquet.stability_chart import StabilityChart, stability_chart

_REAL = 1e-3  # a multiplier with a smaller imaginary part counts as real, where two meet at 1 or -1


@dataclass(frozen=True)
class StabilityLimits(SceneResult):
    """Curves between stable and unstable free vibration, over two numbers of a scene in periodic motion.

    Parameters
    ----------
    chart : StabilityChart
        Stability chart whose regions the curves bound.
    curve : ndarray of int, shape (P,)
        Number of the curve that each point belongs to, from 1; the points of a curve are in order, with
        unstable motion to the left.
    place : ndarray, shape (P, 2)
        Values of the two numbers, in SI.
    error : ndarray, shape (P,)
        Error of the position, as a fraction of the ranges of the two numbers: at this distance from the limit
        the motion is certainly stable on one side and unstable on the other; inf if this was not found.
    multiplier : ndarray of complex, shape (P,)
        Nondimensional Floquet multiplier that leaves the unit circle.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        How the result was computed.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, motion=bd.ShakenCarrier(frequency=130.0, along_n1=100.0))
    >>> vary = {"motion.frequency": np.linspace(120, 140, 9), "motion.along_n1": [300.0, 500.0]}
    >>> found = bd.stability_limits(scene, vary, modes=1)
    >>> found.kinds, bool(found.error.max() < 1e-9)
    (('principal', 'principal'), True)
    """

    chart: StabilityChart
    curve: np.ndarray
    place: np.ndarray
    error: np.ndarray
    multiplier: np.ndarray

    def headline(self) -> Iterator[str]:
        """Yield the number of curves and their kinds, for the one-line summary.

        See `Result.headline`.
        """
        yield counted(len(self.kinds), "curve")
        yield ", ".join(self.kinds)
        yield warned(self.warnings)

    @property
    def kinds(self) -> tuple[str, ...]:
        """Kind of each curve, by its multipliers: "principal", near -1 or 1, or "combination"."""
        curves = (np.abs(np.imag(self.multiplier[self.curve == k])) for k in np.unique(self.curve))
        return tuple("principal" if np.median(size) < _REAL else "combination" for size in curves)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the curves over the chart."""
        ax = self.chart.plot(ax)
        for k in np.unique(self.curve):
            ax.plot(
                *self.place[self.curve == k].T,
                color=COLOURS[1],
                linewidth=1.2,
                label="" if k > 1 else "limit by continuation",
            )
        return add_legend(ax)


@announced_of_plain_beam
@one_blas_thread()  # with small matrices, further threads only slow each other down
def stability_limits(
    scene: Scene,
    vary: Mapping[str, Sequence[float] | np.ndarray],
    modes: int = 3,
    discretization: DiscretizationChoice = "ritz",
    workers: int = 1,
    store: str | PathLike[str] | None = None,
) -> StabilityLimits:
    """Compute the limits of the regions in which free vibration about a periodic motion grows.

    They start where a chart has neighbouring stable and unstable points, and are traced by continuation to
    the ends of the chart or the tips of instability tongues.  A tongue that passes between all points of the
    chart is not found: give more values.

    Parameters
    ----------
    scene, vary, modes, discretization, workers, store
        As for `stability_chart`.

    Returns
    -------
    StabilityLimits

    Raises
    ------
    ValueError
        As for `stability_chart`.

    References
    ----------
    As for `stability_chart`; predictor and corrector: Allgower and Georg (1990), Numerical Continuation
    Methods, chapter 2; roots by Alefeld, Potra and Shi (1995), Algorithm 748.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> motion = bd.PulsatingRotation(50.0, fluctuation=0.1, frequency=124.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215), motion, damping_ratio=0.01)
    >>> vary = {"motion.frequency": np.linspace(110, 135, 11), "motion.fluctuation": np.linspace(0, 0.5, 6)}
    >>> found = bd.stability_limits(scene, vary, modes=1)
    >>> round(float(found.place[:, 1].min()), 2)  # the least fluctuation at which motion grows
    0.19
    """
    start = perf_counter()
    chart = stability_chart(scene, vary, modes, discretization, workers, store)
    tracer = LimitTracer(PeriodicScenes(chart.scene, modes, discretization), chart.inputs, chart.status)
    curves = tracer.curves()
    points = [point for curve in curves for point in curve]
    shares = np.array([point.place for point in points]).reshape(-1, 2)
    low, high = np.array([each.values[[0, -1]] for each in chart.inputs]).T
    error = np.array([point.error for point in points])
    method = f"{chart.provenance.method}, limits traced by solving {counted(tracer.solved, 'scene')}"
    return StabilityLimits(
        chart=chart,
        curve=np.repeat(np.arange(1, len(curves) + 1), [len(curve) for curve in curves]),
        place=low + (high - low) * shares,
        error=error,
        multiplier=np.array([point.multiplier for point in points], dtype=complex),
        warnings=(*chart.warnings, *_warnings(error)),
        provenance=Provenance.since(start, method, chart.provenance.compared_with),
        scene=chart.scene,
    )


def _warnings(error: np.ndarray) -> Iterator[Statement]:
    if number := int(np.isinf(error).sum()):
        said = f"at {counted(number, 'point')} of the limits stability on both sides is uncertain: see error"
        yield Statement(said, kind=TOLERANCE, quantity="undecided", value=number / len(error))


# Largest, first and smallest step along a curve, as fractions of the ranges.
_STEP, _FIRST, _LEAST = 1 / 20, 1 / 160, 1e-6
_WIDER = 2.0  # largest ratio of a step along a curve to the previous step
# Smallest cosine of the angle between a step and the previous one, and the same for the first step.
_TURNS, _FIRST_TURNS = 0.9, 0.2
# Factor by which the half width of a bracket about the limit is reduced, and the smallest half width.
_NARROWER, _NARROWEST = 0.25, 1e-7
_FINE = 1e-11  # accuracy of a root, as a fraction of the ranges of the two numbers
# Distances, as fractions of the ranges, that are tried in turn until the motion at this distance from a point
# of the limit is certainly stable on one side and unstable on the other.
_ERRORS = (1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5)
_MOST = 400  # largest number of points of a curve in each direction
# Distance from the border of the chart, over the length of a segment, below which the segment ends on the
# border.
_ROUNDED = 1e-9
_SLACK = 0.5  # fraction of a cell by which a polygonal curve may miss an edge that the true limit crosses


class LimitPoint(NamedTuple):
    """Point of a stability limit in the chart.

    Its position `place`, (2,), and the error of the position are fractions of the ranges of the two varied
    numbers; `multiplier` is the Floquet multiplier that leaves the unit circle there.
    """

    place: np.ndarray
    error: float
    multiplier: complex


@dataclass(frozen=True)
class LimitTracer:
    """Tracer of stability limits over two numbers; it starts between neighbouring points of the chart.

    Parameters
    ----------
    scenes : PeriodicScenes
        The scenes.
    inputs : tuple of VariedInput
        The two numbers.
    status : ndarray of str, shape (first, second)
        Stability at each point of the chart.
    """

    scenes: PeriodicScenes
    inputs: tuple[VariedInput, ...]
    status: np.ndarray
    _known: dict[bytes, Multipliers] = field(default_factory=dict)

    def curves(self) -> list[list[LimitPoint]]:
        """Trace all limits once: a curve that passes the start of an earlier curve replaces that curve."""
        found: list[tuple[list[LimitPoint], np.ndarray, np.ndarray]] = []
        for low, high in self._edges():
            if any(_crosses(curve, low, high) for curve, *_ in found):
                continue
            first = self._between(low, high)
            normal = (high - low) / np.linalg.norm(high - low)
            # Unstable motion is to the left of the direction `along`.
            along = np.array([normal[1], -normal[0]])
            ahead, behind = self._trace(first, along, 1.0), self._trace(first, -along, -1.0)
            curve = [*reversed(behind), first, *ahead]
            found = [each for each in found if not _crosses(curve, *each[1:])] + [(curve, low, high)]
        return [curve for curve, *_ in found]

    @property
    def solved(self) -> int:
        """Number of scenes that have been integrated."""
        return len(self._known)

    # The function -----------------------------------------------------------------------------------

    def _multipliers(self, place: np.ndarray) -> Multipliers:
        place = np.clip(place, 0.0, 1.0)
        if place.tobytes() not in self._known:
            each = zip(self.inputs, place.tolist(), strict=True)
            numbers = {i.name: float(i.values[0] + (i.values[-1] - i.values[0]) * x) for i, x in each}
            self._known[place.tobytes()] = multipliers_of(self.scenes.monodromy(numbers))
        return self._known[place.tobytes()]

    def _beyond(self, place: np.ndarray) -> float:
        """Compute a function that is 0 on the limits and positive for unstable motion, at a position (2,)."""
        found = self._multipliers(place)
        largest = float(found.size[0, 0])
        if found.sign is None:
            return float(np.log(largest))
        if found.verdict[0] == UNSTABLE:
            return (largest - 1) ** 2
        return -float(_nearest(found)[0] ** 2 / 4)

    def _point(self, place: np.ndarray, normal: np.ndarray) -> LimitPoint:
        """Build the point of the limit at a root of the function, with its error.

        At a distance of the error along the normal, the motion is certainly stable on one side of the root,
        and unstable on the other.
        """
        error = next((e for e in _ERRORS if self._verdicts(place, e * normal) == (STABLE, UNSTABLE)), np.inf)
        found = self._multipliers(place)
        leaves = found.value[0, 0] if found.sign is None else _nearest(found)[1]
        return LimitPoint(place, error, complex(leaves))

    def _verdicts(self, place: np.ndarray, step: np.ndarray) -> tuple[str, str]:
        before, after = (str(self._multipliers(each).verdict[0]) for each in (place - step, place + step))
        return before, after

    # The curve --------------------------------------------------------------------------------------

    def _edges(self) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Yield the end points, as fractions (2,), of grid edges from a stable to an unstable point."""
        values = [(i.values - i.values[0]) / max(float(np.ptp(i.values)), 1e-300) for i in self.inputs]
        grid = np.stack(np.meshgrid(*values, indexing="ij"), axis=-1)
        for axis in (0, 1):
            at, status = np.moveaxis(grid, axis, 0), np.moveaxis(self.status, axis, 0)
            for low, high in (((0, -1), (1, None)), ((1, None), (0, -1))):
                low, high = slice(*low), slice(*high)
                crossed = (status[low] == STABLE) & (status[high] == UNSTABLE)
                yield from zip(at[low][crossed], at[high][crossed], strict=True)

    def _between(self, low: np.ndarray, high: np.ndarray) -> LimitPoint:
        """Find the limit on an edge of the grid, given by its end points."""
        x = toms748(lambda x: self._beyond(low + x * (high - low)), 0.0, 1.0, xtol=_FINE)
        return self._point(low + x * (high - low), (high - low) / np.linalg.norm(high - low))

    def _trace(self, first: LimitPoint, along: np.ndarray, side: float) -> list[LimitPoint]:
        """Trace a limit from a point; unstable motion is to the left (side 1) or right (-1) of `along`.

        The trace ends at the border of the chart, where the curve closes, or if steps become too small.
        """
        points, h, turns, last, width, start = [], _FIRST, _FIRST_TURNS, first.place, 1.0, along
        while len(points) < _MOST and h >= _LEAST:
            inside = _room(last, along)
            to, ends = last + min(h, inside) * along, inside <= h
            normal = side * np.array([-along[1], along[0]])
            if ends:
                normal = _within_border(to, normal)
            found, width = self._corrected(to, normal, min(h, width / _NARROWER))
            step = last - last if found is None else found.place - last
            length = float(np.linalg.norm(step))
            if found is None or not length or step @ along < turns * length:
                h, width = h / 2, 1.0
                continue
            points.append(found)
            closed = (
                np.linalg.norm(found.place - first.place) < h / 2 and step @ start > 0 and len(points) > 2
            )
            if ends or closed:
                break
            last, along, turns = found.place, step / length, _TURNS
            h = min(_WIDER * h, _STEP)
        return points

    def _corrected(
        self, place: np.ndarray, normal: np.ndarray, width: float
    ) -> tuple[LimitPoint | None, float]:
        """Find the limit on the normal through a position, and the half width that brackets it.

        The limit is None if no limit is found.  As a narrow tongue has a second limit close by, the width is
        reduced until only one limit is bracketed.
        """
        half = width
        while half > _NARROWEST:
            ends = -min(half, _room(place, -normal)), min(half, _room(place, normal))
            if ends[0] < ends[1] and self._beyond(place + ends[0] * normal) < 0 < self._beyond(
                place + ends[1] * normal
            ):
                x = toms748(lambda x: self._beyond(place + x * normal), *ends, xtol=_FINE)
                return self._point(place + x * normal, normal), half
            half *= _NARROWER
        return None, width


def _nearest(found: Multipliers) -> tuple[float, complex]:
    """Find the two closest Floquet multipliers of undamped motion not known to have equal Krein signs.

    Return their distance and mean.  Where two such multipliers meet, they may leave the unit circle.
    """
    value, sign = found.value[0], np.zeros(0) if found.sign is None else found.sign[0]
    apart = np.abs(value[:, None] - value)
    barred = (sign[:, None] * sign > 0) | np.eye(len(value), dtype=bool)
    i, j = np.unravel_index(int(np.where(barred, np.inf, apart).argmin()), apart.shape)
    return float(apart[i, j]), complex(value[i] + value[j]) / 2


def _room(place: np.ndarray, along: np.ndarray) -> float:
    """Compute the distance from a position (2,) to the border of the unit square, in a direction."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.where(along > 0, (1 - place) / along, np.where(along < 0, -place / along, np.inf))
    return max(float(ends.min()), 0.0)


def _within_border(place: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Return the direction along the border at a position (2,) on it, with an acute angle to a normal."""
    on = np.minimum(place, 1 - place)
    along = np.where(np.arange(2) == on.argmin(), 0.0, np.sign(normal))
    return along if along.any() else normal


def _crosses(curve: list[LimitPoint], low: np.ndarray, high: np.ndarray) -> bool:
    """Return whether a curve crosses an edge of the grid, with the unstable side towards the end `high`."""
    axis = int(np.abs(high - low).argmax())
    way, slack = np.sign(high - low)[axis], _SLACK * abs(high - low)[axis]
    ends = sorted((low[axis], high[axis]))
    for (p, *_), (q, *_) in pairwise(curve):
        across = q[1 - axis] - p[1 - axis]
        # The curve was traced such that unstable motion is on its left.
        toward = -across if axis == 0 else across
        share = (low[1 - axis] - p[1 - axis]) / across if across else np.inf
        at = p[axis] + share * (q[axis] - p[axis])
        if (
            -_ROUNDED <= share <= 1 + _ROUNDED
            and toward * way > 0
            and ends[0] - slack <= at <= ends[1] + slack
        ):
            return True
    return False
