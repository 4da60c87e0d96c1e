"""Upper bounds of the flexibility 1/EI, and of the work of loads on deflections of unit elastic energy.

All quantities are nondimensional, as in `beamdyn.modes.residual_bound`.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.polynomial import legendre

from beamdyn.common.numerics import gauss_rule, legendre_series
from beamdyn.equations.mass import axial_tension, outboard_moments
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.profile import Profile, mean

_EPS = float(np.finfo(float).eps)
_DEGREES = (0, 8, 16, 32, 64, 128)
_EXCESS = 1e-10  # relative margin of the bound above 1/EI
_HALVINGS = 40  # largest number of halvings of a segment on which no polynomial degree gives a bound


def bound_traces(beam: Beam, flexibility: Profile) -> np.ndarray:
    """Compute upper bounds (4,) of the traces of the forms P1 to P4 in `beamdyn.modes.residual_bound`.

    The forms are those of tension by rotation, tension by root acceleration, mass, and slope of the tip.  The
    traces are relative to the elastic energy; `flexibility` is an upper bound of 1/EI.

    The slope at x under unit energy is at most sqrt(int_0^x 1/EI), the deflection
    sqrt(int_0^x (x - s)^2 / EI).  Exchanging the integrals leaves outboard integrals of the loads:
    int_s^1 (x - s)^2 rho A dx is twice the triple integral of rho A from the tip to s.
    """
    tip = beam.tip or TipMass(0.0)
    n_a, n_b = axial_tension(beam)
    moment = outboard_moments(beam)[0].outboard_integral().outboard_integral().scaled(2.0)
    # Lever arm from s to the tip body's centre of mass, 1 - s + eps.
    arm = Profile((0.0, 1.0), ((0.5 + tip.offset, -0.5),))
    loads = (n_b.outboard_integral(), n_a.outboard_integral(), moment)
    tension_b, tension_a, inertia = (mean(flexibility * load) for load in loads)
    inertia += tip.mass * mean(flexibility * (arm * arm))
    return np.array([tension_b, tension_a, inertia, mean(flexibility)])


def bound_on_cells(profile: Profile, ends: np.ndarray) -> np.ndarray:
    """Return an upper bound of a property's absolute value on each cell, from its Legendre coefficients."""
    parts = profile.split(ends.tolist())
    first = np.searchsorted(parts.breakpoints, ends[:-1])
    return np.maximum.reduceat(np.abs(parts.series).sum(axis=0), first)


def bound_flexibility(stiffness: Profile) -> Profile | None:
    """Find a piecewise polynomial that is a close upper bound of 1/EI; None if the search fails."""
    for _ in range(_HALVINGS):
        rows = [bound_reciprocal(np.array(row)) for row in stiffness.coefficients]
        bounds = tuple(row for row in rows if row is not None)
        if len(bounds) == len(rows):
            return Profile(stiffness.breakpoints, bounds)
        parts = zip(pairwise(stiffness.breakpoints), rows, strict=True)
        stiffness = stiffness.split([(a + b) / 2 for (a, b), row in parts if row is None])
    return None


def bound_reciprocal(row: np.ndarray) -> tuple[float, ...] | None:
    """Find a polynomial that is a close upper bound of 1/EI on a segment, given Legendre coefficients of EI.

    With |1 - EI g| <= misfit < 1 for a polynomial g, the bound is g / (1 - misfit); None if no degree is
    close enough.
    """
    for degree in _DEGREES:
        t, _ = gauss_rule(degree + 1)
        g = legendre_series(degree + 1) @ (1 / legendre.legval(t, row))
        product = legendre.legmul(row, g)
        rounding = 4 * _EPS * (degree + len(row)) * np.abs(row).sum() * np.abs(g).sum()
        misfit = np.abs(legendre.legsub(product, [1.0])).sum() + rounding
        if misfit <= _EXCESS:
            return tuple((g / (1 - misfit)).tolist())
    return None
