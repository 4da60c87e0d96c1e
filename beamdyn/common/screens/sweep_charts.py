"""A sweep as charts: its results over its input."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from beamdyn.common.drawing.chart import Chart, ChartAxis, ChartCurve, ChartPoints
from beamdyn.common.edge.input_sweep import InputSweep
from beamdyn.common.plots.curves import input_words, panels_of

_FEW = 60  # most values of a sweep whose points are marked on the curves


def sweep_charts(swept: InputSweep) -> list[Chart]:
    """Charts of a sweep of one input, one for each unit of its results; designs without an answer are marked.

    Parameters
    ----------
    swept : InputSweep
        The sweep.
    """
    over = input_words(swept, 0)
    order = np.argsort(swept.values[0], kind="stable")
    x = swept.values[0][order]
    axis = ChartAxis(over, low=float(x[0]), high=float(x[-1])) if len(x) > 1 else ChartAxis(over)
    return [
        _chart(f"{heading} over {over}", axis, ChartAxis(heading), x, names, values[:, order])
        for heading, names, values in panels_of(swept)
    ]


def _chart(
    title: str, over: ChartAxis, of: ChartAxis, x: np.ndarray, names: Sequence[str], values: np.ndarray
) -> Chart:
    marked = len(x) <= _FEW
    curves = [ChartCurve(name, x, y, points=marked) for name, y in zip(names, values, strict=True)]
    return Chart(title, over, of, curves, [*_without_answer(x, names, values)])


def _without_answer(x: np.ndarray, names: Sequence[str], values: np.ndarray) -> list[ChartPoints]:
    """Marks at the foot of the chart where curves have no value."""
    known = np.where(np.isfinite(values), values, np.nan)
    foot = float(np.nanmin(known)) if np.isfinite(values).any() else 0.0
    lacking = [
        (place, foot, f"{name}: no answer at {place:.5g}")
        for name, y in zip(names, known, strict=True)
        for place in x[np.isnan(y)].tolist()
    ]
    return [ChartPoints("no answer", lacking)] if lacking else []
