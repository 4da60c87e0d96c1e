"""The differential equations and their conditions at the ends; see the package's docstring."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag

from benchmarks.cases.reference.twisted_beam.blade import Blade
from benchmarks.cases.reference.twisted_beam.mesh import Mesh

_TURN = np.array([[0.0, -1.0], [1.0, 0.0]])  # matrix J: J p = (-p3, p2)


@dataclass(frozen=True)
class Section:
    """Matrices at the nodes, along the directions in which the beam may bend: shape (pieces, nodes, d, d)."""

    mass: np.ndarray
    compliance: np.ndarray
    flexibility: np.ndarray
    rotary: np.ndarray
    in_plane: np.ndarray  # m P: mass per length, in the direction away from the axis of rotation
    spin: np.ndarray  # W: the stiffness by rotation of a section's rotary inertia, over gamma^2
    twisting: np.ndarray  # G J / 2, with the outboard integral G of the product of inertia
    tension: np.ndarray  # N / gamma^2, shape (pieces, nodes)


def sections_at(blade: Blade, mesh: Mesh) -> Section:
    x, basis, body = mesh.x, blade.basis, blade.body
    c, s = math.cos(blade.precone), math.sin(blade.precone)
    turned = blade.directions(x)

    def matrix(first: np.ndarray, second: np.ndarray) -> np.ndarray:
        return np.einsum("...ik,...k,...jk->...ij", turned, np.stack([first, second], -1), turned)

    def along(full: np.ndarray) -> np.ndarray:
        return basis.T @ full @ basis

    rotary = matrix(*(f(x) for f in blade.rotary))
    spin = s**2 * rotary
    spin[..., 0, 1] -= c**2 * rotary[..., 0, 1] / 2
    spin[..., 1, 0] -= c**2 * rotary[..., 0, 1] / 2
    spin[..., 1, 1] -= c**2 * rotary[..., 1, 1]
    product = c**2 * (mesh.outboard(rotary[..., 0, 1]) + body.product(blade.tip_angle))
    mass = blade.mass(x)
    reach = c * (blade.hub + c * (1 + body.offset))
    return Section(
        mass=along(mass[..., None, None] * np.eye(2)),
        compliance=along(matrix(*(1 / f(x) for f in blade.stiffness))),
        flexibility=along(matrix(*(f(x) for f in blade.flexibility))),
        rotary=along(rotary),
        in_plane=along(mass[..., None, None] * _pushed(blade)),
        spin=along(spin),
        twisting=along(product[..., None, None] * _TURN / 2),
        tension=mesh.outboard(mass * c * (blade.hub + c * x)) + body.mass * reach,
    )


def _pushed(blade: Blade) -> np.ndarray:
    """Return the matrix P of the deflection's component away from the axis of rotation."""
    return np.diag([1.0, math.sin(blade.precone) ** 2])


def rates(section: Section, gamma: float) -> tuple[np.ndarray, np.ndarray]:
    """Compute A and B of y' = (A + lambda^2 B) y, y = (u, p, M, Q): shape (pieces, nodes, 4 d, 4 d)."""
    one = np.eye(section.mass.shape[-1])
    tension = gamma**2 * section.tension[..., None, None] * one
    by_force = np.linalg.inv(one + tension @ section.flexibility)  # V = by_force (Q - N p)
    by_slope = -by_force @ tension
    twisting = gamma**2 * section.twisting
    bend = section.compliance
    zero = np.zeros_like(bend)
    moment = gamma**2 * section.spin - by_slope - np.swapaxes(twisting, -1, -2) @ bend @ twisting
    still = [
        [zero, one + section.flexibility @ by_slope, zero, section.flexibility @ by_force],
        [zero, -bend @ twisting, bend, zero],
        [zero, moment, np.swapaxes(twisting, -1, -2) @ bend, -by_force],
        [-(gamma**2) * section.in_plane, zero, zero, zero],
    ]
    moving = [[zero] * 4, [zero] * 4, [zero, -section.rotary, zero, zero], [-section.mass, zero, zero, zero]]
    return _blocks(still), _blocks(moving)


def _blocks(rows: list[list[np.ndarray]]) -> np.ndarray:
    shape = rows[0][0].shape
    return np.concatenate([np.concatenate([np.broadcast_to(b, shape) for b in row], -1) for row in rows], -2)


def root_conditions(blade: Blade) -> np.ndarray:
    """Compute the matrix C of the root conditions C y(0) = 0: shape (2 d, 4 d)."""
    basis, d = blade.basis, blade.planes
    c, s = math.cos(blade.bending_angle), math.sin(blade.bending_angle)
    rows = [np.hstack([np.eye(d), np.zeros((d, 3 * d))])]
    for e, k in list(zip(([c, s], [-s, c]), blade.springs, strict=True))[:d]:
        on_slope, on_moment = (1.0, 0.0) if math.isinf(k) else (k / (1 + k), -1 / (1 + k))
        along = np.array(e) @ basis
        rows.append(np.hstack([np.zeros(d), on_slope * along, on_moment * along, np.zeros(d)])[None])
    return np.vstack(rows)


def tip_conditions(blade: Blade, gamma: float) -> tuple[np.ndarray, np.ndarray]:
    """Compute C0, C1 of the tip conditions (C0 - lambda^2 C1) y(1) = 0: shapes (2 d, 4 d)."""
    body, basis, d = blade.body, blade.basis, blade.planes
    kinetic, flat = body.moments(blade.tip_angle)
    c, s = math.cos(blade.precone), math.sin(blade.precone)
    tilted = c**2 * flat - s**2 * (2 * body.along * np.eye(2) - kinetic)
    inertia, spin = (basis.T @ a @ basis for a in (kinetic, tilted))
    one, eps = np.eye(d), body.offset
    follower = np.vstack([one, eps * one])  # forces on u and p by a force on t = u + eps p
    translation = body.mass * follower @ follower.T
    push = body.mass * follower @ basis.T @ _pushed(blade) @ basis @ follower.T
    pull = body.mass * c * (blade.hub + c * (1 + eps)) * eps * one
    by_deflection = gamma**2 * (block_diag(0 * one, spin + pull) - push)
    by_force = np.kron(np.array([[0.0, 1.0], [1.0, 0.0]]), one)  # pairs force Q with u, and moment M with p
    still = np.hstack([by_deflection, by_force])
    moving = np.hstack([translation + block_diag(0 * one, inertia), np.zeros((2 * d, 2 * d))])
    return still, moving


def coriolis(blade: Blade, section: Section, gamma: float) -> tuple[np.ndarray, np.ndarray]:
    """Compute the terms by precone in rates (pieces, nodes, 4 d, 4 d) and tip conditions, factors of s.

    With the velocity v, the Coriolis force on a mass m is -2 gamma sin(precone) m T v in Q.
    """
    d, body = blade.planes, blade.body
    across = 2 * gamma * math.sin(blade.precone) * blade.basis.T @ _TURN.T @ blade.basis
    zero = np.zeros_like(section.mass)
    by_rates = _blocks([[zero] * 4, [zero] * 4, [zero] * 4, [section.mass @ across, zero, zero, zero]])
    one = np.eye(d)
    follower = np.vstack([one, body.offset * one])
    tip = body.mass * follower @ across @ follower.T + block_diag(0 * one, body.along * across)
    return by_rates, np.hstack([tip, np.zeros((2 * d, 2 * d))])
