"""Equations of motion for large deflection in one plane, in modal coordinates, for the integrators.

The equations are those of the beam in space with one curvature, in their cheapest form.  The positions p_i of
masses m_i are sums over the slope angles theta_j, p_i = sum_j P_ji (cos theta_j, sin theta_j), so that the
mass enters by one matrix H = P m P'.  The generalized forces on the angles are

    F = -sin theta (H X + a_1 g) + cos theta (H Y + a_2 g) + (moments of inertia),   g = P m,

with the root's acceleration a_1, a_2 along b1 (the beam's axis at the root) and e (the direction of bending),
and the second time derivatives X, Y of (cos theta, sin theta) in these directions, as seen from the ground.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from beamdyn.equations.beam_in_space.moving_beam import Carrier
from beamdyn.transient.beam_in_space_system import BeamInSpaceSystem


class ElasticaSystem(BeamInSpaceSystem):
    """Equations of motion of a straight inextensible beam that bends by any angle in one plane.

    Integrators evaluate them a million times, on small arrays, so that every operation counts: in one plane
    this takes a tenth of the time in space.
    """

    @cached_property
    def kernel_and_moments(self) -> np.ndarray:
        """Matrix (N + 2, N + 1): the negative mass matrix over the slope angles, and below it moments.

        The moments [kg m] act at the slope angles under a unit acceleration of the root.
        """
        stations, masses = self.elastica.beam.stations, self.elastica.beam.masses
        positions = np.zeros((stations.sections, stations.count))  # by cosines or sines of slope angles
        positions[:-1] = stations.to_all(np.eye(stations.sections - 1))
        positions[:, : stations.sections] += np.diag(masses.centre[0])
        return np.vstack([-(positions * masses.mass) @ positions.T, positions @ masses.mass])

    @cached_property
    def conditions(self) -> tuple[bool, bool, bool]:
        """Whether there are moments of inertia, damping, and rotation about an axis in the plane."""
        beam = self.elastica.beam
        return bool(beam.masses.inertia.any()), bool(beam.damping.any()), bool(self.elastica.axis[1])

    def residual(self, carrier: Carrier, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        """Compute the residual of the equations of motion, as for a beam in space.

        In the plane of rotation, rate and acceleration of an angle as seen from the ground, w and w', leave
        X = -w^2 cos theta - w' sin theta and Y = -w^2 sin theta + w' cos theta; out of it X has
        -omega^2 cos theta, too.
        """
        beam, (has_inertia, is_damped, is_tilted) = self.elastica.beam, self.conditions
        angles, of_mass, inertia = beam.angles, self.kernel_and_moments, beam.masses.inertia
        theta, w = q @ angles, v @ angles + carrier.turning[:, 2:]
        turned = a @ angles + carrier.turning_rate[:, 2:]
        cos, sin, squared = np.cos(theta), np.sin(theta), w * w
        changes = np.empty((2, *w.shape[:-1], len(of_mass)))
        changes[0, ..., :-1] = cos * squared + sin * turned
        changes[1, ..., :-1] = sin * squared - cos * turned
        tilting = carrier.turning[:, 1:2] ** 2 * cos if is_tilted else 0.0
        if is_tilted:
            changes[0, ..., :-1] += tilting
        changes[0, ..., -1], changes[1, ..., -1] = carrier.root_acceleration.T[:2]
        along, across = changes.reshape(-1, len(of_mass)).dot(of_mass).reshape(2, *w.shape)
        by_angle = cos * across - sin * along
        if has_inertia:
            by_angle += turned * inertia[2, 2]
        if has_inertia and is_tilted:
            by_angle += tilting * sin * (inertia[1, 1] - inertia[0, 0])
        total = by_angle @ angles.T + q @ beam.stiffness
        return total + v @ beam.damping if is_damped else total
