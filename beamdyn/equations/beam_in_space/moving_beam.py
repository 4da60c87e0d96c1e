"""Exact inertial forces and energies of a beam in space whose root moves with a rotating carrier.

Dots are rates of change.  Relative to the carrier, the sections have the angular velocity w and the velocity
v, by the strain rates k. and g.:

    w' = R k.,                            v' = w x r' + R g.,
    (w.)' = R k.. + w x R k.,             (v.)' = w. x r' + w x v' + w x R g. + R g..,

In axes fixed to the carrier, of angular velocity W, a centre of mass c has the acceleration of the root plus

    c.. + 2 W x c. + W. x c + W x (W x c),

and a section of inertia tensor I has the rate of angular momentum I (w. + W. + W x w) + (w + W) x I (w + W).

Arrays over N + 1 + k stations have the N Gauss points of the strains, the tip and the k point masses: see
`station_forces`.  n counts coordinates.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.equations.beam_in_space.bent_beam import BentBeam
from beamdyn.equations.beam_in_space.finite_rotations import cross, turn
from beamdyn.equations.beam_in_space.station_forces import ZERO
from beamdyn.equations.beam_in_space.tip_forces import TipForces
from beamdyn.equations.root_motion import RootMotion


class Carrier(NamedTuple):
    """Motion of the carrier, in axes fixed to it, at one time or several.

    Parameters
    ----------
    turning, turning_rate : ndarray, shape (..., 3)
        Angular velocity [rad/s] and acceleration [rad/s2].
    root_acceleration : ndarray, shape (..., 3)
        Acceleration of the root, less gravity [m/s2].
    """

    turning: np.ndarray = ZERO
    turning_rate: np.ndarray = ZERO
    root_acceleration: np.ndarray = ZERO

    def at(self, times: int | slice) -> Carrier:
        """Select the motion at one or several of the times, which are along the first axis of the arrays."""
        return Carrier(self.turning[times], self.turning_rate[times], self.root_acceleration[times])

    @classmethod
    def of_root(cls, axis: np.ndarray, root: RootMotion) -> Carrier:
        """Build the motion of a carrier that rotates about an axis (3,), from the motion of the root."""
        acceleration = np.stack([root.root_axial, root.root_transverse, root.root_across], axis=-1)
        return cls(axis * root.speed[..., None], axis * root.acceleration[..., None], acceleration)


@dataclass(frozen=True)
class MovingBeam(FieldsOnly):
    """Beam with given coordinates and rates on a moving carrier, at one time or several.

    Parameters
    ----------
    bent : BentBeam
        The beam deformed by the coordinates.
    rates : ndarray, shape (..., coordinates)
        Rates of the coordinates.
    carrier : Carrier
        Motion of the carrier.
    load : TipForces or None
        Load at the tip.
    """

    bent: BentBeam
    rates: np.ndarray
    carrier: Carrier
    load: TipForces | None = None

    @cached_property
    def _strain_rates(self) -> tuple[np.ndarray, np.ndarray]:
        """Rates of stretch and shears, and of curvatures, in carrier-fixed axes: (..., 3, points) each."""
        return self.bent.strain_rates(self.rates)

    @cached_property
    def _turning(self) -> np.ndarray:
        """Angular velocities (..., 3, sections) of the sections relative to the carrier [rad/s]."""
        return self.bent.turning_rate(self.rates, self._strain_rates[1])

    @cached_property
    def _tangent_rate(self) -> np.ndarray:
        """Time derivative (..., 3, points) of r', the derivative of the axis' position along its length."""
        return cross(self._turning[..., :-1], self.bent.tangents) + self._strain_rates[0]

    @cached_property
    def velocity(self) -> np.ndarray:
        """Velocities (..., 3, stations) of the stations relative to the carrier [m/s]."""
        return self.bent.beam.stations.to_all(self._tangent_rate)

    def forces(self, accelerations: np.ndarray) -> np.ndarray:
        """Compute inertial forces and moments (..., 6, stations) for accelerations of the coordinates."""
        bent, stations, masses = self.bent, self.bent.beam.stations, self.bent.masses
        straining, bending = bent.strain_rates(accelerations)
        w, strained = self._turning[..., :-1], self._strain_rates
        turning_rate = bent.turning_rate(accelerations, bending + cross(w, strained[1]))
        turning_rate = turning_rate + bent.turning_of_root(self.rates)
        tangent_rate = cross(turning_rate[..., :-1], bent.tangents) + straining
        tangent_rate += cross(w, self._tangent_rate + strained[0]) + bent.shortening_rate(self.rates)
        turning, turning_rate = (stations.of_all(each) for each in (self._turning, turning_rate))
        W, W_rate, root = (each[..., None] for each in self.carrier)
        lever, of_lever = masses.lever, cross(turning, masses.lever)
        relative = stations.to_all(tangent_rate) + cross(turning_rate, lever) + cross(turning, of_lever)
        carried = cross(W_rate, masses.centre) + root
        carried = carried + cross(W, cross(W, masses.centre) + 2 * (self.velocity + of_lever))
        F = masses.mass * (relative + carried)
        spin, spin_rate = turning + W, turning_rate + W_rate + cross(W, turning)
        M = turn(masses.inertia, spin_rate) + cross(spin, turn(masses.inertia, spin))
        return np.concatenate([F, M + cross(masses.lever, F)], axis=-2)

    def residual(self, accelerations: np.ndarray) -> np.ndarray:
        """Sum elastic, damping and inertial forces, minus the tip load: 0 for the true motion."""
        beam, forces = self.bent.beam, self.forces(accelerations)
        elastic = self.bent.q @ beam.stiffness + self.rates @ beam.damping
        return elastic + self.bent.work(forces if self.load is None else forces - self.load.forces(self.bent))

    @property
    def energy(self) -> np.ndarray:
        """Compute the energy integral [J], shape (...), on a steadily rotating carrier.

        It is the sum of the kinetic energy relative to the carrier, the elastic energy, and the potential of
        centrifugal forces, of the root's acceleration and of a force of fixed direction at the tip; other tip
        loads have no potential.
        """
        bent, masses, W = self.bent, self.bent.masses, self.carrier.turning[..., None]
        turning = bent.beam.stations.of_all(self._turning)
        velocity, carried = self.velocity + cross(turning, masses.lever), cross(W, masses.centre)
        kinetic = (velocity**2 - carried**2).sum(axis=-2) @ masses.mass
        each = (turning * turn(masses.inertia, turning)).sum(axis=-2)
        kinetic += (each - (W * turn(masses.inertia, W)).sum(axis=-2)).sum(axis=-1)
        elastic = ((bent.q @ bent.beam.stiffness) * bent.q).sum(axis=-1)
        by_root = (self.carrier.root_acceleration[..., None] * masses.centre).sum(axis=-2) @ masses.mass
        if self.load is not None and not self.load.follows:
            by_root = by_root - bent.tip @ self.load.force
        return (kinetic + elastic) / 2 + by_root
