"""A beam under loads at its tip, which keep their direction in space or follow the tip."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from beamdyn.equations.beam_in_space.bent_beam import BeamInSpace, BentBeam
from beamdyn.equations.beam_in_space.finite_rotations import skew
from beamdyn.equations.beam_in_space.station_forces import StationForces

_NOTHING = np.zeros(3)


@dataclass(frozen=True)
class TipLoad:
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

    def on(self, bent: BentBeam) -> StationForces:
        """The load on the stations, with the sign of the right-hand side."""
        stations = bent.beam.stations
        force, tangent = np.zeros((6, stations.count)), np.zeros((6, 6, stations.count))
        F, M, tip = self.force, self.couple, stations.sections - 1
        if self.follows:
            R = bent.rotations[..., -1]
            F, M = R @ F, R @ M
            tangent[:3, 3:, tip], tangent[3:, 3:, tip] = -skew(F), -skew(M)
        force[:3, tip], force[3:, tip] = F, M
        return StationForces(force, tangent)


@dataclass(frozen=True)
class LoadedBeam:
    """Equilibrium of a beam at rest under p times a load at its tip.

    Parameters
    ----------
    beam : BeamInSpace
        The beam.
    load : TipLoad
        The load.
    scale : float
        Change of p that counts as an angle of 1.
    """

    beam: BeamInSpace
    load: TipLoad
    scale: float = 1.0

    @property
    def angles(self) -> np.ndarray:
        """Integrated strains per coordinate."""
        return self.beam.angles

    def residual(self, q: np.ndarray, p: float) -> np.ndarray:
        """Elastic force less the load (n,)."""
        return self.beam.stiffness @ q + p * self.rate(q, p)

    def jacobian(self, q: np.ndarray, p: float) -> np.ndarray:
        """Tangent stiffness (n, n); not symmetric where the load has no potential."""
        bent = self.beam.at(q)
        return self.beam.stiffness - p * bent.work_change(self.load.on(bent))

    def rate(self, q: np.ndarray, p: float) -> np.ndarray:
        """Derivative of the residual by p."""
        bent = self.beam.at(q)
        return -bent.work(self.load.on(bent).force)
