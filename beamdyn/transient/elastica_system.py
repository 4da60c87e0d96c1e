"""Equations of motion for large deflection in one plane, in modal coordinates, for time integrators.

They are the equations of the beam in space with a single curvature, in a form that is cheap to evaluate.  The
positions p_i of masses m_i are sums over the slope angles theta_j, p_i = sum_j P_ji (cos theta_j, sin
theta_j), so that the mass enters by one matrix H = P m P'.  The generalized forces on the angles are

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

    An integrator evaluates them a million times: in one plane this takes a tenth of the time that the
    equations in space need.
    """

    @cached_property
    def kernel_and_moments(self) -> np.ndarray:
        """Matrix with minus the mass matrix of the slope angles, and below it a row of moments.

        The row of moments [kg m] has the generalized force on each slope angle by a unit acceleration of the
        root.
        """
        stations, masses = self.elastica.beam.stations, self.elastica.beam.masses
        # Positions per unit of the cosine or sine of each slope angle.
        positions = np.zeros((stations.sections, stations.count))
        positions[:-1] = stations.to_all(np.eye(stations.sections - 1))
        positions[:, : stations.sections] += np.diag(masses.centre[0])
        return np.vstack([-(positions * masses.mass) @ positions.T, positions @ masses.mass])

    @cached_property
    def conditions(self) -> tuple[bool, bool, bool]:
        """Whether there are moments of inertia, damping, and rotation about an axis in the bending plane."""
        beam = self.elastica.beam
        return bool(beam.masses.inertia.any()), bool(beam.damping.any()), bool(self.elastica.axis[1])

    def residual(self, carrier: Carrier, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        """Compute the residual of the equations of motion, with arguments as for the beam in space.

        X and Y are the second time derivatives of the cosine and sine of a slope angle theta.  If bending is
        in the plane of rotation, an absolute angular rate w and acceleration w' give X = -w^2 cos theta - w'
        sin theta and Y = -w^2 sin theta + w' cos theta; if it is out of this plane, X contains -omega^2 cos
        theta in addition.
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
