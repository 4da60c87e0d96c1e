"""Stability limits: curves that bound stable regions over two numbers of a scene in periodic motion."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike
from time import perf_counter

import numpy as np

from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.results.one_line import counted, warned
from beamdyn.common.results.pictures import COLOURS, Axes, add_legend
from beamdyn.common.results.result import Provenance, Result
from beamdyn.common.results.statements import TOLERANCE, Statement, announced_of_plain_beam
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.scene.scene import Scene
from beamdyn.studies.floquet.limit_curves import LimitTracer
from beamdyn.studies.floquet.periodic_scenes import PeriodicScenes
from beamdyn.studies.floquet.stability_chart import StabilityChart, stability_chart

_REAL = 1e-3  # imaginary part of a multiplier below which it is real: two multipliers meet at 1 or -1


@dataclass(frozen=True)
class StabilityLimits(Result):
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
    warnings: tuple[str, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)

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
    method = f"{chart.provenance.method}, limits followed by {tracer.solved} scenes"
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
