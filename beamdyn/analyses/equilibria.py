"""Equilibria: how far rotation bends the beam, and where its equilibrium turns back."""

from __future__ import annotations

from typing import TYPE_CHECKING

import beamdyn as bd
from beamdyn.analyses.analysis import analysis
from beamdyn.analyses.options import AtSpeed, Discretization, PositiveSpeed, Text

if TYPE_CHECKING:
    from beamdyn.modes.equilibria import Equilibrium, EquilibriumBranches
    from beamdyn.scene.scene import Scene

_BENT = "The scene; large deflection is modelled in any case."


@analysis(
    'beamdyn equilibrium examples/rolling_harvester.toml --speed "50 rad/s"',
    about_scene=_BENT,
    physics=None,
)
def equilibrium(
    scene: Scene, *, speed: AtSpeed, branch: Text | None = None, discretization: Discretization = "ritz"
) -> Equilibrium:
    """Where the rotation bends the beam to, by any angle, and whether it stays there.

    Parameters
    ----------
    branch
        straight: the equilibrium that follows from rest as the speed rises; bent: the stable one
        beside it, at high speed. Default: that of the scene's physics.
    """
    return bd.equilibrium(scene, speed, branch, discretization)


@analysis(
    'beamdyn branches examples/rolling_harvester.toml --top-speed "250 rad/s"',
    about_scene=_BENT,
    physics=None,
)
def branches(
    scene: Scene, *, top_speed: PositiveSpeed, discretization: Discretization = "ritz"
) -> EquilibriumBranches:
    """Branches of equilibria over speed: where the beam buckles, and where an equilibrium turns back.

    Parameters
    ----------
    top_speed
        Speed up to which the branches are followed, with its unit, e.g. "250 rad/s".
    """
    return bd.equilibrium_branches(scene, top_speed, discretization)
