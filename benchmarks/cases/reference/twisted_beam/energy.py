"""The quotient of the energies of a mode."""

from __future__ import annotations

import math

import numpy as np

from benchmarks.cases.reference.twisted_beam.blade import Blade
from benchmarks.cases.reference.twisted_beam.equations import Section, tip_conditions
from benchmarks.cases.reference.twisted_beam.mesh import Mesh


def quotient(
    blade: Blade,
    gamma: float,
    mesh: Mesh,
    section: Section,
    states: np.ndarray,
    first: np.ndarray,
    last: np.ndarray,
) -> float:
    """Energy of bending, shear, springs and spin over that of the motion, of one mode."""
    d = blade.planes
    weights = mesh.steps[:, None] * mesh.weights

    def twice(matrix: np.ndarray, a: np.ndarray, b: np.ndarray | None = None) -> float:
        b = a if b is None else b
        return float(np.einsum("kn,kni,knij,knj->", weights, a.conj(), matrix, b).real)

    u, p, moment, total = (states[..., i * d : (i + 1) * d] for i in range(4))
    tension = gamma**2 * section.tension[..., None, None] * np.eye(d)
    shear = np.linalg.solve(
        np.eye(d) + tension @ section.flexibility,
        (total - np.einsum("...ij,...j->...i", tension, p))[..., None],
    )[..., 0]
    slope = p + np.einsum("...ij,...j->...i", section.flexibility, shear)
    twist = gamma**2 * np.einsum("...ij,...j->...i", section.twisting, p)
    bend = np.einsum("...ij,...j->...i", section.compliance, moment - twist)
    stored = twice(np.linalg.inv(section.compliance), bend) + twice(section.flexibility, shear)
    spin = twice(tension, slope) - gamma**2 * twice(section.in_plane, u)
    spin += gamma**2 * (twice(section.spin, p) + 2 * twice(section.twisting, bend, p))
    motion = twice(section.mass, u) + twice(section.rotary, p)
    tip, tip_inertia = tip_conditions(blade, gamma)
    end = last[: 2 * d]
    spin += float((end.conj() @ tip[:, : 2 * d] @ end).real)
    motion += float((end.conj() @ tip_inertia[:, : 2 * d] @ end).real)
    return (stored + spin + _spring_energy(blade, first[d : 2 * d])) / motion


def _spring_energy(blade: Blade, slope: np.ndarray) -> float:
    c, s = math.cos(blade.bending_angle), math.sin(blade.bending_angle)
    pairs = list(zip(([c, s], [-s, c]), blade.springs, strict=True))[: blade.planes]
    return sum(k * abs(np.array(e) @ blade.basis @ slope) ** 2 for e, k in pairs if math.isfinite(k))
