"""Force and couple at the tip of a beam in space, with fixed directions or rotating with the tip."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from beamdyn.equations.beam_in_space.bent_beam import BentBeam
from beamdyn.equations.beam_in_space.finite_rotations import skew
from beamdyn.equations.beam_in_space.station_forces import ZERO, StationForces
from beamdyn.scene.mount import aligned_cos_sin
from beamdyn.scene.scene import Scene


class TipForces(NamedTuple):
    """Force and couple at the tip.

    Parameters
    ----------
    force : ndarray, shape (3,)
        Force [N].
    couple : ndarray, shape (3,)
        Couple [N m].
    follows : bool
        Whether the components refer to the axes of the tip section, so that the load rotates with it;
        otherwise they refer to the axes at the root.  A couple of fixed direction has no potential.
    """

    force: np.ndarray = ZERO
    couple: np.ndarray = ZERO
    follows: bool = False

    def forces(self, bent: BentBeam) -> np.ndarray:
        """Compute force and moment (..., 6, stations) at each station, which are 0 except at the tip."""
        stations, both = bent.beam.stations, np.stack([self.force, self.couple])
        if self.follows:
            both = np.einsum("...ab,kb->...ka", bent.rotations[..., -1], both)
        force = np.zeros((*bent.q.shape[:-1], 6, stations.count))
        force[..., stations.sections - 1] = both.reshape(*both.shape[:-2], 6)
        return force

    def on(self, bent: BentBeam, share: float = 1.0) -> StationForces:
        """Return the load as forces at the stations of one deformed beam, multiplied by `share`."""
        force, tip = share * self.forces(bent), bent.beam.stations.sections - 1
        tangent = np.zeros((6, *force.shape))
        if self.follows:
            tangent[:3, 3:, tip], tangent[3:, 3:, tip] = -skew(force[:3, tip]), -skew(force[3:, tip])
        return StationForces(force, tangent)


def forces_at_tip(scene: Scene, unloaded: BentBeam) -> TipForces | None:
    """Resolve the tip load in the root's axes, or the tip's if the load rotates with it; None if it is 0."""
    load, (c, s) = scene.tip_load, aligned_cos_sin(scene.mount.bending_angle)
    if not load.acts:
        return None
    axes = np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]])
    if load.follows:
        axes = unloaded.rotations[..., -1].T @ axes
    return TipForces(axes @ load.force, axes @ load.moment, load.follows)
