"""Energies of a deflection, and their quotient for a mode."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from benchmarks.cases.reference.twisted_beam.blade import Blade
from benchmarks.cases.reference.twisted_beam.equations import Section, tip_conditions
from benchmarks.cases.reference.twisted_beam.mesh import Mesh


@dataclass(frozen=True)
class Deflection:
    """Deflection at the nodes, each of shape (pieces, nodes, d), and u, p at the tip, shape (2 d,).

    Parameters
    ----------
    u, slope
        Deflection u of the centre line, and u'.
    p, bend
        Rotation p of the sections, and p'.
    """

    u: np.ndarray
    slope: np.ndarray
    p: np.ndarray
    bend: np.ndarray
    tip: np.ndarray


def quotient(
    blade: Blade,
    gamma: float,
    mesh: Mesh,
    section: Section,
    states: np.ndarray,
    first: np.ndarray,
    last: np.ndarray,
) -> float:
    """Compute the quotient of stored energy (bending, shear, springs, spin) and kinetic energy of a mode."""
    d = blade.planes
    form = Forms(mesh)
    u, p, moment, total = (states[..., i * d : (i + 1) * d] for i in range(4))
    tension = gamma**2 * section.tension[..., None, None] * np.eye(d)
    shear = np.linalg.solve(
        np.eye(d) + tension @ section.flexibility, (total - times(tension, p))[..., None]
    )[..., 0]
    bend = times(section.compliance, moment - gamma**2 * times(section.twisting, p))
    mode = Deflection(u, p + times(section.flexibility, shear), p, bend, last[: 2 * d])
    stored = form(np.linalg.inv(section.compliance), bend) + form(section.flexibility, shear)
    stored += _spring_energy(blade, first[d : 2 * d])
    motion = form(section.mass, u) + form(section.rotary, p)
    inertia = tip_conditions(blade, gamma)[1][:, : 2 * d]
    spin = spin_energy(blade, gamma, mesh, section, mode)
    return (stored + spin) / (motion + float(mode.tip @ inertia @ mode.tip))


def spin_energy(blade: Blade, gamma: float, mesh: Mesh, section: Section, mode: Deflection) -> float:
    """Compute twice the energy of steady rotation, to second order."""
    form, d = Forms(mesh), blade.planes
    tension = section.tension[..., None, None] * np.eye(d)
    spin = form(tension, mode.slope) - form(section.in_plane, mode.u)
    spin += form(section.spin, mode.p) + 2 * form(section.twisting, mode.bend, mode.p)
    at_tip = tip_conditions(blade, gamma)[0][:, : 2 * d]
    return gamma**2 * spin + float(mode.tip @ at_tip @ mode.tip)


@dataclass(frozen=True)
class Forms:
    """Integrals of a . matrix b over the beam."""

    mesh: Mesh

    def __call__(self, matrix: np.ndarray, a: np.ndarray, b: np.ndarray | None = None) -> float:
        weights = self.mesh.steps[:, None] * self.mesh.weights
        return float(np.einsum("kn,kni,knij,knj->", weights, a, matrix, a if b is None else b))


def times(matrix: np.ndarray, vector: np.ndarray) -> np.ndarray:
    return np.einsum("...ij,...j->...i", matrix, vector)


def _spring_energy(blade: Blade, slope: np.ndarray) -> float:
    c, s = math.cos(blade.bending_angle), math.sin(blade.bending_angle)
    pairs = list(zip(([c, s], [-s, c]), blade.springs, strict=True))[: blade.planes]
    return sum(k * float(np.array(e) @ blade.basis @ slope) ** 2 for e, k in pairs if math.isfinite(k))
