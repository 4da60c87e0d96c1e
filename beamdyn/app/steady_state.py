"""The screen of the steady response over speed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from beamdyn import resonance_speeds, steady_response
from beamdyn.app.headlines import of_steady
from beamdyn.app.inputs import read
from beamdyn.app.scene_screen import scene_screen
from beamdyn.app.sweeps import steady_outputs, sweeps_of
from beamdyn.common.drawing.chart import Chart, ChartAxis, ChartBand, ChartCurve
from beamdyn.common.edge.config import MissingValue
from beamdyn.scene.scene import Scene
from beamdyn.scene.validity import LARGE_DEFLECTION
from beamdyn.steady.response import SteadyResponse

_SPEEDS = 242
_BESIDE = (-4e-3, -1e-3, -2e-4, 2e-4, 1e-3, 4e-3)  # relative distances from a resonance speed
_STABLE = "stable"
_PAST_LIMIT = f"past {LARGE_DEFLECTION:g} of the length: not linear"


def solve(tables: Mapping[str, Any]) -> SteadyResponse:
    """The steady response over speed."""
    scene, top, modes = read(tables)
    if scene.motion is None:
        raise MissingValue("motion.kind", None, "choose the motion that excites the beam")
    return steady_response(scene, _speeds(scene, top, modes), modes)


def _speeds(scene: Scene, top: float, modes: int) -> np.ndarray:
    """Speeds up to the top, with more beside resonances, which may be narrower than the steps between."""
    even = np.linspace(2 * top / _SPEEDS, top, _SPEEDS)
    try:
        found = np.array([crossing.speed for crossing in resonance_speeds(scene, top, modes)])
    except ValueError:  # the lines of the motion are not known
        return even
    near = np.multiply.outer(found, 1 + np.array(_BESIDE + ((0.0,) if scene.is_damped else ()))).ravel()
    return np.union1d(even, near[near < top])


def chart(answer: SteadyResponse, _: float = 0.0) -> Sequence[Chart]:
    """The resonance curve, grey where it does not hold."""
    units = answer.display_units
    speed, length = units.speed_unit(), units.length_unit()
    x, size = speed.of(answer.speeds), length.of(np.where(answer.amplitude > 0, answer.amplitude, np.nan))
    said = stretches(answer)
    holds = said == ""
    limit = length.of(LARGE_DEFLECTION * answer.scene.beam.length)
    curves = [
        ChartCurve("largest deflection", x, np.where(holds, size, np.nan)),
        ChartCurve("sum of the lines", x, np.where(holds, length.of(answer.bound), np.nan), dashed=True),
    ]
    if not holds.all():
        beside = ~holds | np.append(~holds[1:], False) | np.insert(~holds[:-1], 0, False)
        reasons = "; ".join(dict.fromkeys(said[~holds].tolist()))
        curves.append(ChartCurve(reasons, x, np.where(beside, size, np.nan), pale=True))
    ends = np.array([x[0], x[-1]])
    curves.append(ChartCurve("0.1 of the length", ends, np.full(2, limit), dashed=True, pale=True))
    return [
        Chart(
            "Largest deflection of the tip over speed",
            ChartAxis("angular speed", speed.name, low=0.0, high=float(x[-1])),
            ChartAxis("deflection", length.name, logarithmic=True),
            curves,
            bands=[*_bands(x, said)],
        )
    ]


def stretches(answer: SteadyResponse) -> np.ndarray:
    """Why the response at each speed does not hold, in words (S,); "" where it does."""
    said = np.where(answer.status == _STABLE, "", answer.status).astype(object)
    large = np.nan_to_num(answer.amplitude) > LARGE_DEFLECTION * answer.scene.beam.length
    said[(said == "") & large] = _PAST_LIMIT
    return said


def _bands(x: np.ndarray, said: np.ndarray) -> Iterator[ChartBand]:
    """Bands over speeds with the same reason, which end midway between two speeds."""
    changes = np.flatnonzero(said[1:] != said[:-1]) + 1
    middles = (x[:-1] + x[1:]) / 2
    starts, ends = [0, *changes.tolist()], [*changes.tolist(), len(x)]
    for start, end in zip(starts, ends, strict=True):
        if said[start]:
            low = x[0] if start == 0 else middles[start - 1]
            high = x[-1] if end == len(x) else middles[end - 1]
            yield ChartBand(float(low), float(high), str(said[start]))


STEADY_STATE = scene_screen(
    "Steady response",
    "Largest deflection of the tip over speed, after the transient of the start has decayed.",
    solve,
    left_out_of="amplitude, at the speeds where that is judged",
    sweeps=sweeps_of(steady_outputs, "beam.thickness=0.2:0.3:21 mm", "amplitude"),
    headline=lambda answer: [*of_steady(answer)],
    charts=chart,
)
