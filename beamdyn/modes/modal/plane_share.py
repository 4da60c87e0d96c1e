"""How the motion of modes is shared between the two directions of bending."""

from __future__ import annotations

import numpy as np

from beamdyn.equations.equations_of_motion import Equations


def plane_share(equations: Equations, vectors: np.ndarray) -> np.ndarray:
    """Share of the two directions in the kinetic energy of deflection of modes (S, n, k): (S, k, 2).

    The energy of other fields, such as the stretch, is not counted: the two add up to 1, or to 0 without any.
    """
    if equations.planes == 1:
        return np.stack([np.ones(vectors[:, 0].shape), np.zeros(vectors[:, 0].shape)], axis=2)
    energy = np.real(vectors.conj() * (equations.matrices[2]["unity"] @ vectors))
    by_plane = [energy[:, _coordinates(equations, direction)].sum(axis=1) for direction in (0, 1)]
    total = by_plane[0] + by_plane[1]
    return np.stack(by_plane, axis=2) / np.where(total == 0, 1.0, total)[..., None]


def _coordinates(equations: Equations, direction: int) -> np.ndarray:
    """Indices of the coordinates, before a reduction, that deflect the beam in a direction."""
    return equations.places(n for n, d in equations.deflections.items() if d.direction == direction)
