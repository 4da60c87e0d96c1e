"""The axis of an unloaded beam: its curvature, and the kinks between cells.

With the prebend b and the sweep a, the axes of the beam are those at the root turned by b about the third,
then by -a about the second, so that the axis points along (cos a cos b, cos a sin b, sin a).  Their curvature
is

    k1 = b' sin a,   k2 = -a',   k3 = b' cos a.
"""

from __future__ import annotations

import numpy as np

from beamdyn.equations.beam_in_space.finite_rotations import product, quaternion_about
from beamdyn.equations.discretization import ArcQuadrature, Sampler
from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import ONE, Profile

_STRAIGHT = ONE.scaled(0.0)


def curve_of_axis(beam: Beam, quadrature: ArcQuadrature) -> tuple[np.ndarray, np.ndarray]:
    """Compute the axis' curvature (3, N) [1/m] at the rule's points, and kinks (quaternions) before cells."""
    cells, sweep, prebend = quadrature.cells, beam.sweep or _STRAIGHT, beam.prebend or _STRAIGHT
    at_points = Sampler.on_cells(cells)
    a = at_points(sweep)
    swept, bent = (at_points(angle.derivative()) / beam.length for angle in (sweep, prebend))
    curvature = np.stack([bent * np.sin(a), -swept, bent * np.cos(a)])
    begin, end = (
        _axes(*angles) for angles in zip(*(_at_ends(p, cells.ends) for p in (sweep, prebend)), strict=True)
    )
    before = np.concatenate([quaternion_about(0, 0.0)[None], end[:-1]]) * [1.0, -1.0, -1.0, -1.0]
    return curvature, product(before, begin)


def _at_ends(angle: Profile, ends: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Evaluate an angle just inside both ends of each cell, so that jumps between cells are kept."""
    return angle.split(tuple(ends)).end_values()


def _axes(sweep: np.ndarray, prebend: np.ndarray) -> np.ndarray:
    """Convert sweep and prebend (c,) [rad] to unit quaternions (c, 4) of the axes of the unloaded beam."""
    return product(quaternion_about(2, prebend), quaternion_about(1, -sweep))
