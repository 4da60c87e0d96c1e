"""What a piezoelectric beam harvests over speed, and with which resistance most."""

from __future__ import annotations

from typing import TYPE_CHECKING

import beamdyn as bd
from beamdyn.analyses import options
from beamdyn.analyses.analysis import Answer, analysis

if TYPE_CHECKING:
    from beamdyn.scene.scene import Scene
    from beamdyn.steady.harvest import Harvest

_SCENE = "The scene, with a table [harvester]; gravity and its motion excite the beam."


@analysis('beamdyn harvest examples/bimorph.toml --speeds "10:130:61 rad/s"', about_scene=_SCENE)
def harvest(
    scene: Scene,
    *,
    speeds: options.Speeds,
    modes: options.SmallestBasis = "auto",
    tolerance: float = 1e-5,
    discretization: options.Discretization = "ritz",
) -> Answer:
    """How much power piezoelectric layers harvest over speed, with which voltage, strain and efficiency.

    Parameters
    ----------
    speeds
        Speeds with their unit: start:stop:count, e.g. "10:130:61 rad/s", or a list, e.g. "50, 55 rad/s".
    tolerance
        Largest error by the harmonics left out, relative to the sum of all lines.
    """
    result = bd.harvest(scene, speeds, modes, tolerance, discretization)
    none = f"at none of {len(speeds)} speeds is there a steady response: {result.status[0]}"
    return Answer(result, "" if (result.status == "stable").any() else none)


@analysis('beamdyn best-resistance examples/bimorph.toml --speed "55 rad/s"', about_scene=_SCENE)
def best_resistance(
    scene: Scene,
    *,
    speed: options.AtFinalSpeed,
    modes: options.SmallestBasis = 3,
    tolerance: float = 1e-5,
    discretization: options.Discretization = "ritz",
) -> Harvest:
    """The load resistance with which piezoelectric layers harvest most at a speed, and what they harvest.

    Parameters
    ----------
    tolerance
        Largest error by the harmonics left out, relative to the sum of all lines.
    """
    return bd.best_resistance(scene, speed, modes, tolerance, discretization)
