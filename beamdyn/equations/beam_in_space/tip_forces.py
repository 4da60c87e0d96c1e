"""Forces at the tip of a beam in space, of fixed direction or following, and equilibria under them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from beamdyn.equations.beam_in_space.bent_beam import BeamInSpace, BentBeam
from beamdyn.equations.beam_in_space.finite_rotations import skew
from beamdyn.equations.beam_in_space.station_forces import StationForces
from beamdyn.scene.mount import aligned_cos_sin
from beamdyn.scene.scene import Scene

_NOTHING = np.zeros(3)


@dataclass(frozen=True)
class TipForces:
    """A force and a couple at the tip.

    Parameters
    ----------
    force : ndarray, shape (3,)
        Force [N].
    couple : ndarray, shape (3,)
        Couple [N m].
    follows : bool
        Whether components are those in the axes of the section at the tip, with which the load turns; else
        they are those in space.  A couple that keeps its direction has no potential.
    """

    force: np.ndarray = field(default_factory=_NOTHING.copy)
    couple: np.ndarray = field(default_factory=_NOTHING.copy)
    follows: bool = False

    def forces(self, bent: BentBeam) -> np.ndarray:
        """Compute force and moment (..., 6, N + 1 + k) on each station, which are 0 but at the tip."""
        stations, both = bent.beam.stations, np.stack([self.force, self.couple])
        if self.follows:
            both = np.einsum("...ab,kb->...ka", bent.rotations[..., -1], both)
        force = np.zeros((*bent.q.shape[:-1], 6, stations.count))
        force[..., stations.sections - 1] = both.reshape(*both.shape[:-2], 6)
        return force

    def on(self, bent: BentBeam) -> StationForces:
        """Return the load on the stations at one set of coordinates, with the sign of the right-hand side."""
        force, tip = self.forces(bent), bent.beam.stations.sections - 1
        tangent = np.zeros((6, *force.shape))
        if self.follows:
            tangent[:3, 3:, tip], tangent[3:, 3:, tip] = -skew(force[:3, tip]), -skew(force[3:, tip])
        return StationForces(force, tangent)


def forces_at_tip(scene: Scene, unloaded: BentBeam) -> TipForces | None:
    """Resolve the load at the tip along e1, e2, e3, or in the section's axes if it follows; None if 0."""
    load, (c, s) = scene.tip_load, aligned_cos_sin(scene.mount.bending_angle)
    if not load.acts:
        return None
    axes = np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]])
    if load.follows:
        axes = unloaded.rotations[..., -1].T @ axes
    return TipForces(axes @ load.force, axes @ load.moment, load.follows)


@dataclass(frozen=True)
class LoadedBeam:
    """Equilibrium of a beam at rest under p times a load at its tip.

    Parameters
    ----------
    beam : BeamInSpace
        The beam.
    load : TipForces
        The load.
    scale : float
        Change of p that counts as an angle of 1.
    """

    beam: BeamInSpace
    load: TipForces
    scale: float = 1.0

    @property
    def angles(self) -> np.ndarray:
        """Measure of changes of the shape per coordinate, shape (n, k): see `BeamInSpace.angles`."""
        return self.beam.angles

    def residual(self, q: np.ndarray, p: float) -> np.ndarray:
        """Compute the elastic force less the load (n,) at coordinates q (n,) and a multiple p of the load."""
        return self.beam.stiffness @ q + p * self.rate(q, p)

    def jacobian(self, q: np.ndarray, p: float) -> np.ndarray:
        """Compute the tangent stiffness (n, n); it is not symmetric where the load has no potential."""
        bent = self.beam.at(q)
        return self.beam.stiffness - p * bent.work_change(self.load.on(bent))

    def rate(self, q: np.ndarray, p: float) -> np.ndarray:
        """Compute the derivative of the residual by p, shape (n,)."""
        bent = self.beam.at(q)
        return -bent.work(self.load.on(bent).force)
