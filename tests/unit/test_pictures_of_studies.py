"""Pictures of studies: where there is no answer, and inputs that have no axis."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import beamdyn as bd
from beamdyn.common.plots.curves import mark_missing

SCENE = bd.load_scene(Path(__file__).parents[2] / "examples" / "rolling_harvester.toml")


def drawn(study):
    figure = Figure(figsize=(7.5, 4.8), layout="constrained")
    ax = study.plot(figure.subplots())
    figure.draw_without_rendering()
    return figure, ax


def test_designs_without_an_answer_are_marked():
    study = bd.study(SCENE, {"speed": [0.0, 100.0, 200.0, 300.0]}, modes=1)  # it buckles at 159.8 rad/s
    _, ax = drawn(study)
    crosses = [line for line in ax.get_lines() if line.get_marker() == "x" and len(line.get_xdata())]
    assert [list(line.get_xdata()) for line in crosses] == [[200.0, 300.0]]
    assert "none: divergence" in [text.get_text() for text in ax.get_legend().get_texts()]


def test_where_all_have_an_answer_nothing_is_marked():
    _, ax = drawn(bd.study(SCENE, {"speed": [0.0, 100.0]}, modes=1))
    assert not [line for line in ax.get_lines() if line.get_marker() == "x"]


def test_curves_with_gaps_have_rows_of_their_own():
    ax = Figure().subplots()
    for values in ([1.0, np.nan], [np.nan, 2.0]):
        ax.plot([0.0, 1.0], values)
    assert mark_missing(ax, "no answer")
    heights = [
        line.get_ydata()[0] for line in ax.get_lines() if line.get_marker() == "x" and len(line.get_xdata())
    ]
    assert len({*heights}) == 2


def test_four_inputs_keep_the_words_within_the_picture():
    vary = {"speed": [0.0, 50.0], "beam.thickness": [2e-4, 3e-4]}
    further = {"mount.radius": [0.1, 0.2], "mount.setting_angle": [0.1, 0.2], "beam.length": [0.04, 0.05]}
    figure, ax = drawn(bd.study(SCENE, vary | further, modes=1))
    whole = figure.bbox
    for text in (ax.yaxis.label, ax.xaxis.label, ax.title):
        box = text.get_window_extent()
        assert whole.x0 <= box.x0 <= box.x1 <= whole.x1 and whole.y0 <= box.y0 <= box.y1 <= whole.y1
    assert "mount.radius = 0.1 m" in ax.title.get_text()
