"""The 40-digit reference of derivatives: against power series, and differences of it solved again."""

import math
from dataclasses import replace

import pytest
from mpmath import mp, mpf

import beamdyn as bd
from benchmarks.cases.reference.many_digits.differences import Number, _changed
from benchmarks.cases.reference.many_digits.eigenvalues import Pencil, modes_of
from benchmarks.cases.reference.many_digits.numbers import Numbers
from benchmarks.cases.reference.of_scene import exact

BEAM = {"length": 0.05, "width": 0.01, "thickness": 2e-4, "youngs_modulus": 2e11, "density": 7850.0}
OBLIQUE = bd.Scene(
    bd.Beam.rectangular(**BEAM, tip=bd.TipMass(1e-4, 1e-3, 1e-9, axial_inertia=5e-10)),
    bd.Mount(0.215, 0.7, 0.3),
)


def test_eigenvalues_are_those_of_power_series():
    """Polynomials of degree 42 have 30 digits of the first modes of a uniform beam at this speed."""
    with mp.workdps(60):
        found = modes_of(Pencil.of(Numbers(OBLIQUE, 50.0, functions=40)), 3)
        for mode, s in zip(found, exact(OBLIQUE, 50.0, 3, 36), strict=True):
            assert abs(mode.s - s) < mpf(10) ** -28 * abs(s)


@pytest.mark.parametrize("name", ["beam.length", "beam.point_mass[0].position", "mount.precone"])
def test_eigenvalues_beside_are_those_of_the_scene_beside(name):
    """Of a damped, gyroscopic scene: a change of 1e-12 leaves quotients an error of 1e-24."""
    beam = bd.Beam.rectangular(**BEAM, point_masses=[bd.PointMass(0.02, 2e-4)])
    mount, damping = bd.Mount(0.2, math.pi, 0.3, precone=0.2), bd.Damping(tip_damper=0.02)
    scene = bd.Scene(beam, mount, damping=damping, physics=bd.Physics(planes=2))
    values = {"beam.length": 0.05, "beam.point_mass[0].position": 0.02, "mount.precone": 0.2}
    with mp.workdps(60):
        pencil = Pencil.of(Numbers(scene, 100.0, functions=6))
        beside = _changed(pencil, Number(name, values[name], values[name]), mpf(10) ** -12 * values[name])
        solved = modes_of(Pencil.of(beside.numbers), 2)
        for mode, again in zip(modes_of(pencil, 2), solved, strict=True):
            found = beside.quotient(replace(mode, s=pencil.quotient(mode)))
            assert abs(found - again.s) < mpf(10) ** -21 * abs(again.s)
            assert abs(found - mode.s) > mpf(10) ** -15 * abs(again.s)  # there is a change to be seen
