"""A beam in space in any motion on a carrier in any motion: its exact inertial forces and energies.

With the rates k. and g. of the strains, the sections turn against the carrier with the rate w and move with
the velocity v,

    w' = R k.,                            v' = w x r' + R g.,
    (w.)' = R k.. + w x R k.,             (v.)' = w. x r' + w x v' + w x R g. + R g..,

and in axes that turn with the carrier at the rate W a centre of mass c has the acceleration of the root and

    c.. + 2 W x c. + W. x c + W x (W x c),

a section of inertia I the rate of angular momentum I (w. + W. + W x w) + (w + W) x I (w + W).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from beamdyn.common.results.pickling import FieldsOnly
from beamdyn.equations.beam_in_space.bent_beam import BentBeam
from beamdyn.equations.beam_in_space.rotations import cross, turn

_AT_REST = np.zeros(3)


@dataclass(frozen=True)
class Carrier:
    """Motion of the carrier, in axes that turn with it.

    Parameters
    ----------
    turning, turning_rate : ndarray, shape (3,)
        Angular velocity [rad/s] and acceleration [rad/s2].
    root_acceleration : ndarray, shape (3,)
        Acceleration of the root, less gravity [m/s2].
    """

    turning: np.ndarray = field(default_factory=_AT_REST.copy)
    turning_rate: np.ndarray = field(default_factory=_AT_REST.copy)
    root_acceleration: np.ndarray = field(default_factory=_AT_REST.copy)


@dataclass(frozen=True)
class MovingBeam(FieldsOnly):
    """A beam at given coordinates and rates, on a carrier.

    Parameters
    ----------
    bent : BentBeam
        The beam at the coordinates.
    rates : ndarray, shape (n,)
        Rates of the coordinates.
    carrier : Carrier
        Motion of the carrier.
    """

    bent: BentBeam
    rates: np.ndarray
    carrier: Carrier

    @cached_property
    def _velocity(self) -> np.ndarray:
        """Velocities and turning rates of the stations (6, N + 1 + k) against the carrier."""
        return np.tensordot(self.rates, self.bent.motions, 1)

    @cached_property
    def _convective(self) -> np.ndarray:
        """Accelerations of the stations (6, N + 1 + k) against the carrier while the rates are constant."""
        bent, stations = self.bent, self.bent.beam.stations
        turning, w = self._velocity[3:, : stations.sections - 1], np.zeros((6, stations.count))
        straining, bending = bent.strain_rates(self.rates)
        w[3:, : stations.sections] = stations.to_sections(cross(turning, bending))
        rate = cross(turning, bent.tangents) + straining
        moving = cross(w[3:, : stations.sections - 1], bent.tangents) + cross(turning, rate + straining)
        w[:3] = stations.to_all(moving + bent.shortening_rate(self.rates))
        return w

    def forces(self, accelerations: np.ndarray) -> np.ndarray:
        """Inertial forces on the stations (6, N + 1 + k), for accelerations (n,) of the coordinates."""
        masses, carrier = self.bent.masses, self.carrier
        W, W_rate, root = (each[:, None] for each in vars(carrier).values())
        velocity, turning = np.split(self._velocity, [3])
        moving, turning_rate = np.split(
            self._convective + np.tensordot(accelerations, self.bent.motions, 1), [3]
        )
        of_lever = cross(turning, masses.lever)
        centre_velocity = velocity + of_lever
        relative = moving + cross(turning_rate, masses.lever) + cross(turning, of_lever)
        carried = cross(W_rate, masses.centre) + cross(W, cross(W, masses.centre) + 2 * centre_velocity)
        F = masses.mass * (relative + carried + root)
        spin, spin_rate = turning + W, turning_rate + W_rate + cross(W, turning)
        M = turn(masses.inertia, spin_rate) + cross(spin, turn(masses.inertia, spin))
        return np.concatenate([F, M + cross(masses.lever, F)])

    def residual(self, accelerations: np.ndarray) -> np.ndarray:
        """Sum of elastic, damping and inertial forces (n,): 0 in motion."""
        beam = self.bent.beam
        elastic = beam.stiffness @ self.bent.q + beam.damping @ self.rates
        return elastic + self.bent.work(self.forces(accelerations))

    @cached_property
    def accelerations(self) -> np.ndarray:
        """Accelerations (n,) of the coordinates in motion."""
        return np.linalg.solve(self.bent.mass, -self.residual(np.zeros_like(self.rates)))

    @property
    def energy(self) -> float:
        """Energy integral [J] of a carrier that turns steadily, constant in free motion without damping.

        It is the kinetic energy against the carrier, the elastic one and the potential of the centrifugal
        forces and of the acceleration of the root.
        """
        masses, turning = self.bent.masses, self.carrier.turning
        carried = cross(turning[:, None], masses.centre)
        centrifugal = (carried**2).sum(axis=0) @ masses.mass
        centrifugal += np.einsum("a,abj,b->", turning, masses.inertia, turning)
        kinetic = self.rates @ self.bent.mass @ self.rates
        elastic = self.bent.q @ self.bent.beam.stiffness @ self.bent.q
        by_root = self.carrier.root_acceleration @ (masses.centre @ masses.mass)
        return float((kinetic + elastic - centrifugal) / 2 + by_root)
