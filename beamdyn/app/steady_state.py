"""The screen of the steady response over speed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from beamdyn import steady_response
from beamdyn.app.inputs import DRAGS, TABLES, read
from beamdyn.app.sweeps import steady_outputs, sweeps_of
from beamdyn.cautions import describe_choice, notes_of, warnings_of
from beamdyn.common.app.screens import Screen
from beamdyn.common.edge.config import MissingValue
from beamdyn.output.notes import note_below
from beamdyn.steady.response import SteadyResponse
from beamdyn.tables.results import steady_table
from beamdyn.tables.rows import steady_csv

_SPEEDS = 242


def solve(tables: Mapping[str, Any]) -> SteadyResponse:
    """The steady response over speed."""
    scene, top, modes = read(tables)
    if scene.motion is None:
        raise MissingValue("motion.kind", None, "choose the motion that excites the beam")
    return steady_response(scene, np.linspace(2 * top / _SPEEDS, top, _SPEEDS), modes)


def draw(answer: SteadyResponse, _: float = 0.0) -> Figure:
    """The resonance curve."""
    figure = Figure(figsize=(9.0, 5.4), layout="constrained")
    answer.plot(figure.subplots())
    return note_below(figure, notes_of(answer))


STEADY_STATE = Screen(
    "Steady response",
    "Largest deflection of the tip over speed, after the transient of the start has decayed.",
    TABLES,
    TABLES,
    solve,
    lambda answer: [steady_table(answer), *describe_choice(answer)],
    draw,
    warnings_of,
    steady_csv,
    sweeps=sweeps_of(steady_outputs, "beam.thickness=0.2:0.3:21 mm", "amplitude"),
    drags=DRAGS,
)
