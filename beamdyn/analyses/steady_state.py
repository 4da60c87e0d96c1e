"""The steady state: speeds of resonance, and the response over speed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import beamdyn as bd
from beamdyn.analyses.analysis import Answer, AsText, analysis
from beamdyn.analyses.options import Discretization, ModeCount, Order, SmallestBasis, Speeds
from beamdyn.analyses.values import parse_positive

if TYPE_CHECKING:
    from beamdyn.scene.scene import Scene
    from beamdyn.steady.crossings import Crossings

TopOfSearch = Annotated[
    float,
    AsText(
        lambda option, text, scene: parse_positive(option, text, "rad/s", scene),
    ),
]


@analysis(
    'beamdyn resonances examples/rolling_harvester.toml --top-speed "150 rad/s"',
    about_scene="The scene; its motion and gravity give the frequencies that are excited.",
)
def resonances(
    scene: Scene,
    *,
    top_speed: TopOfSearch,
    modes: ModeCount = 3,
    order: Order = 1,
    discretization: Discretization = "ritz",
) -> Crossings:
    """Speeds of resonance, at which a frequency that the scene excites meets a natural frequency.

    Parameters
    ----------
    top_speed
        Largest speed to search, with its unit, e.g. "150 rad/s".
    order
        1: resonances with the load; more: also combination resonances by the periodic coefficients.
    """
    return bd.resonance_speeds(scene, top_speed, modes, order, discretization)


@analysis('beamdyn steady examples/rolling_harvester.toml --speeds "1:150:30 rad/s"')
def steady(
    scene: Scene,
    *,
    speeds: Speeds,
    modes: SmallestBasis = "auto",
    tolerance: float = 1e-5,
    discretization: Discretization = "ritz",
) -> Answer:
    """Steady response over speed, after the transient of the start has decayed.

    Parameters
    ----------
    speeds
        Speeds with their unit: start:stop:count, e.g. "1:150:1000 rad/s", or a list, e.g. "50, 55
        rad/s".
    tolerance
        Largest error by the harmonics left out, relative to the sum of all lines.
    """
    result = bd.steady_response(scene, speeds, modes, tolerance=tolerance, discretization=discretization)
    none = f"at none of {len(speeds)} speeds is there a steady response: {result.status[0]}"
    return Answer(result, "" if result.stable.any() else none)
