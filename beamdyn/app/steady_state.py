"""The screen of the steady-state response over speed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from beamdyn import resonance_speeds, steady_response
from beamdyn.app.scene_form import read
from beamdyn.app.scene_screen import brief, scene_screen
from beamdyn.app.sweeps import steady_outputs, sweeps_of
from beamdyn.common.drawing.shapes import Chart, ChartAxis, ChartBand, ChartCurve
from beamdyn.common.edge.config import MissingValue
from beamdyn.common.screens.screen_parts import KeyResult
from beamdyn.scene.validity import LARGE_DEFLECTION
from beamdyn.steady.response import SteadyResponse

_SPEEDS = 242
# Relative distances from a resonance speed at which further speeds are computed.
_BESIDE = (-4e-3, -1e-3, -2e-4, 2e-4, 1e-3, 4e-3)
_STABLE = "stable"
_PAST_LIMIT = f"deflection past {LARGE_DEFLECTION:g} of the length: not linear"


def solve(tables: Mapping[str, Any]) -> SteadyResponse:
    """Compute the steady-state response over speed, with more speeds near resonances, which may be narrow."""
    scene, top, modes = read(tables)
    if scene.motion is None:
        raise MissingValue("motion.kind", None, "choose the motion that excites the beam")
    speeds = np.linspace(2 * top / _SPEEDS, top, _SPEEDS)
    try:
        found = np.array([crossing.speed for crossing in resonance_speeds(scene, top, modes)])
        beside = np.array(_BESIDE + ((0.0,) if scene.is_damped else ()))
        near = np.multiply.outer(found, 1 + beside).ravel()
        speeds = np.union1d(speeds, near[near < top])
    except ValueError:  # the excitation lines of the motion are unknown
        pass
    return steady_response(scene, speeds, modes)


def chart(answer: SteadyResponse, _: float = 0.0) -> Sequence[Chart]:
    """Make the chart of the resonance curve; speeds at which the result is invalid are grey."""
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
    """Return for each speed the reason why the response is invalid; "" if it is valid."""
    said = np.where(answer.status == _STABLE, "", answer.status).astype(object)
    large = np.nan_to_num(answer.amplitude) > LARGE_DEFLECTION * answer.scene.beam.length
    said[(said == "") & large] = _PAST_LIMIT
    return said


def _bands(x: np.ndarray, said: np.ndarray) -> Iterator[ChartBand]:
    """Yield bands of speeds at which the response is invalid for the same reason.

    Each band ends midway between two speeds `x` with different reasons `said`.
    """
    changes = np.flatnonzero(said[1:] != said[:-1]) + 1
    ends = [x[0], *((x[:-1] + x[1:]) / 2)[changes - 1], x[-1]]
    for start, (low, high) in zip([0, *changes.tolist()], pairwise(ends), strict=True):
        if said[start]:
            yield ChartBand(float(low), float(high), str(said[start]))


def headline(response: SteadyResponse) -> Iterator[KeyResult]:
    """Yield the largest tip deflection, its speed, and whether it exceeds the range of linear theory."""
    amplitude = np.asarray(response.amplitude)
    if not np.isfinite(amplitude).any():
        yield KeyResult("largest deflection of the tip", "no steady state")
        return
    at = int(np.nanargmax(np.where(np.isfinite(amplitude), amplitude, np.nan)))
    past = amplitude[at] > LARGE_DEFLECTION * response.scene.beam.length
    units, beyond = response.display_units, ", past linear theory" if past else ""
    yield KeyResult(f"largest deflection of the tip{beyond}", brief(amplitude[at], units.length_unit()))
    yield KeyResult("at the speed", brief(response.speeds[at], units.speed_unit()))


STEADY_STATE = scene_screen(
    "Steady response",
    "Largest deflection of the tip over speed, after the transient of the start has decayed.",
    solve,
    left_out_of="amplitude, at a few of the speeds",
    sweeps=sweeps_of(steady_outputs, "beam.thickness=0.2:0.3:21 mm", "amplitude"),
    headline=headline,
    charts=chart,
)
