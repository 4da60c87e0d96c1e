"""Axis of an unloaded curved beam: its curvature, and its kinks between cells.

With the prebend angle b and the sweep angle a, the local axes are the root's axes rotated by b about the
third axis, then by -a about the second, so that the beam points along (cos a cos b, cos a sin b, sin a).  The
curvature is

    k1 = b' sin a,   k2 = -a',   k3 = b' cos a.
"""

from __future__ import annotations

import numpy as np

from beamdyn.equations.beam_in_space.finite_rotations import CONJUGATE, UNIT, product, quaternions_by_vectors
from beamdyn.equations.discretization import ArcQuadrature, Sampler
from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import ONE

_STRAIGHT = ONE.scaled(0.0)


def curve_of_axis(beam: Beam, quadrature: ArcQuadrature) -> tuple[np.ndarray, np.ndarray]:
    """Compute the axis' curvature (3, N) [1/m] at N Gauss points, and kinks (quaternions) before cells."""
    cells, sweep, prebend = quadrature.cells, beam.sweep or _STRAIGHT, beam.prebend or _STRAIGHT
    at_points = Sampler.on_cells(cells)
    a = at_points(sweep)
    swept, bent = (at_points(angle.derivative()) / beam.length for angle in (sweep, prebend))
    curvature = np.stack([bent * np.sin(a), -swept, bent * np.cos(a)])
    # Angles just inside both ends of each cell, as properties may jump between cells.
    a, b = (np.stack(angle.split(tuple(cells.ends)).end_values())[..., None] for angle in (sweep, prebend))
    begin, end = product(quaternions_by_vectors(b * [0, 0, 1]), quaternions_by_vectors(a * [0, -1, 0]))
    return curvature, product(np.concatenate([UNIT[None], end[:-1]]) * CONJUGATE, begin)
