"""The axis of an unloaded beam: its curvature, and the kinks between cells.

With the prebend b and the sweep a, the axes of the beam are those at the root turned by b about the third,
then by -a about the second, so that the axis points along (cos a cos b, cos a sin b, sin a).  Their curvature
is

    k1 = b' sin a,   k2 = -a',   k3 = b' cos a.
"""

from __future__ import annotations

import numpy as np

from beamdyn.equations.beam_in_space.finite_rotations import UNIT, product, quaternions_by_vectors
from beamdyn.equations.discretization import ArcQuadrature, Sampler
from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import ONE

_STRAIGHT = ONE.scaled(0.0)


def curve_of_axis(beam: Beam, quadrature: ArcQuadrature) -> tuple[np.ndarray, np.ndarray]:
    """Compute the axis' curvature (3, N) [1/m] at the rule's points, and kinks (quaternions) before cells."""
    cells, sweep, prebend = quadrature.cells, beam.sweep or _STRAIGHT, beam.prebend or _STRAIGHT
    at_points = Sampler.on_cells(cells)
    a = at_points(sweep)
    swept, bent = (at_points(angle.derivative()) / beam.length for angle in (sweep, prebend))
    curvature = np.stack([bent * np.sin(a), -swept, bent * np.cos(a)])
    # Angles just inside both ends of each cell, where cells may differ at a jump.
    a, b = (np.stack(angle.split(tuple(cells.ends)).end_values())[..., None] for angle in (sweep, prebend))
    begin, end = product(quaternions_by_vectors(b * [0, 0, 1]), quaternions_by_vectors(a * [0, -1, 0]))
    before = np.concatenate([UNIT[None], end[:-1]]) * [1.0, -1.0, -1.0, -1.0]
    return curvature, product(before, begin)
