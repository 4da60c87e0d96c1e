"""Exact eigenvalues of a scene: its binary numbers, made nondimensional in mpmath, and the power series."""

from __future__ import annotations

import math
from typing import Any

from mpmath import mp, mpc, mpf

import beamdyn as bd
from beamdyn.scene.profile import Profile
from benchmarks.cases.reference.power_series import (
    Tip,
    bending_eigenvalues,
    critical_speed,
)

_DIGITS = 40


def exact(scene: bd.Scene, speed: float, count: int = 3, digits: int = 30) -> list[mpc]:
    """Compute the lowest s of exp(s t) [1/s] of a beam without breakpoints, stretch and damping."""
    with mp.workdps(_DIGITS):
        tau = _time_unit(scene.beam)
        squares = bending_eigenvalues(mpf(speed) * tau, **_parameters(scene), count=count, digits=digits)
        return [mp.sqrt(mpc(-z)) / tau for z in squares]


def exact_critical_speed(scene: bd.Scene, digits: int = 30) -> mpf:
    """Compute the critical speed [rad/s] of a beam without breakpoints; inf if 48 functions give none."""
    with mp.workdps(_DIGITS):
        return critical_speed(**_parameters(scene), digits=digits) / _time_unit(scene.beam)


def _time_unit(beam: bd.Beam) -> mpf:
    mass, stiffness = (_monomials(p)[0] for p in (beam.mass_per_length, beam.bending_stiffness))
    return mp.sqrt(mass * mpf(beam.length) ** 4 / stiffness)


def _parameters(scene: bd.Scene) -> dict[str, Any]:
    """Return the nondimensional arguments of the power series."""
    beam, mount, L = scene.beam, scene.mount, mpf(scene.beam.length)
    mass, stiffness = map(_monomials, (beam.mass_per_length, beam.bending_stiffness))
    return {
        "delta": -_cosine(mount.setting_angle) * mpf(mount.radius) / L,
        "bending_angle": mpf(mount.bending_angle),
        "mass": [c / mass[0] for c in mass],
        "stiffness": [c / stiffness[0] for c in stiffness],
        "tip": _tip(beam.tip, mass[0], L),
    }


def relative_errors(found: bd.Modes, truth: list[mpc]) -> list[float]:
    """Compute relative errors of the eigenvalues of a result."""
    with mp.workdps(_DIGITS):
        pairs = zip(found.eigenvalue.tolist(), truth, strict=True)
        return [float(abs(mpc(s) - t) / abs(t)) for s, t in pairs]


def _cosine(angle: float) -> mpf:
    """Compute a cosine; exactly 0 at a quarter turn, as in a scene."""
    return mpf(0) if abs(math.cos(angle)) < 2e-16 else mp.cos(mpf(angle))


def _monomials(profile: Profile) -> list[mpf]:
    """Compute coefficients in x of a Legendre series in 2 x - 1."""
    (row,) = profile.coefficients
    size = len(row)
    return [
        sum(
            (-1) ** (k + j) * math.comb(k, j) * math.comb(k + j, j) * mpf(row[k])
            for k in range(j, size)
        )
        for j in range(size)
    ]  # fmt: skip


def _tip(tip: bd.TipMass | None, mass: mpf, L: mpf) -> Tip | None:
    if tip is None:
        return None
    inertias = (tip.inertia, tip.inertia_about_bending_direction, tip.axial_inertia)
    return Tip(mpf(tip.mass) / (mass * L), mpf(tip.offset) / L, *(mpf(j) / (mass * L**3) for j in inertias))
