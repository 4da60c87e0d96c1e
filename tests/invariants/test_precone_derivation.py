"""A beam that leaves the plane of rotation, derived again from a Lagrangian.

In axes along the beam, precone is a rotation with a part about the beam: the derivation of
`test_two_planes_derivation` holds with another axis, and with sections, shear and an oblique tip body.
"""

from dataclasses import replace
from functools import cache
from math import atan2, pi

import numpy as np
import pytest
from sympy import QQ

import beamdyn as bd
from beamdyn.equations.assembly import assemble_equations
from beamdyn.equations.root_motion import root_motion
from beamdyn.scene.motion.base import MotionSample
from tests.invariants import test_two_planes_derivation as flat
from tests.invariants.power_spaces import PowerSeries
from tests.invariants.test_two_planes_derivation import assert_equal

SINE, COSINE = QQ(5, 13), QQ(12, 13)
PRECONE = atan2(float(SINE), float(COSINE))
QUANTITIES = ["speed_squared", "root_axial", "root_transverse", "root_across", "acceleration"]
SIGNS = [1, -1]


def derived(sign):
    return flat.derive((sign * SINE, COSINE))


@cache
def ours(sign):
    scene = flat.scene()
    mount = replace(scene.mount, setting_angle=pi, precone=sign * PRECONE)
    return assemble_equations(replace(scene, mount=mount), PowerSeries())


@pytest.mark.parametrize("sign", SIGNS)
def test_mass_is_that_without_precone(sign):
    assert_equal(ours(sign).matrices[2]["unity"], derived(sign).mass)


@pytest.mark.parametrize("sign", SIGNS)
def test_coriolis(sign):
    assert derived(sign).gyroscopic.any()
    assert_equal(ours(sign).matrices[1]["speed"], derived(sign).gyroscopic)


@pytest.mark.parametrize("sign", SIGNS)
@pytest.mark.parametrize("quantity", QUANTITIES)
def test_stiffness_by_motion(quantity, sign):
    nothing = np.zeros_like(derived(sign).mass)
    assert_equal(ours(sign).matrices[0].get(quantity, nothing), derived(sign).stiffness[quantity])


@pytest.mark.parametrize("sign", SIGNS)
@pytest.mark.parametrize("quantity", QUANTITIES)
def test_loads(quantity, sign):
    nothing = np.zeros(len(derived(sign).mass))
    assert_equal(ours(sign).vectors.get(quantity, nothing), derived(sign).load[quantity])


def test_no_precone_adds_no_term_and_changes_no_factor():
    """The factors by the precone are then 1 to the bit."""
    mount = replace(flat.scene().mount, setting_angle=pi)
    terms = assemble_equations(replace(flat.scene(), mount=mount), PowerSeries()).terms
    assert not any("planes" in t.name for t in terms)
    assert {t.factor for t in terms if t.name == "centrifugal stiffening"} == {1.0}
    assert {abs(t.factor) for t in terms if t.name == "twisting by inertia"} == {0.5}


# Stretch ------------------------------------------------------------------------------------------


def stretched_energy(x, s, u2, u3, du2, du3):
    """Centrifugal energy and the part linear in the speed, per mass, of a point of the axis, by hand.

    The point is at (x + s, u2, u3), and moves in these axes with (ds, du2, du3) =: v; ds enters below.
    """
    axis = np.array([float(SINE), 0.0, float(COSINE)])
    p = np.array([x + s, u2, u3])
    return 0.5 * (p @ p - (axis @ p) ** 2), axis @ np.cross(p, np.array([0.0, du2, du3]))


@cache
def stretched():
    beam = bd.Beam.from_stiffness(1.25, 1.5, 2.0, 30.0, tip=bd.TipMass(0.8, 0.25))
    mount = bd.Mount(1.0, pi, 0.7, precone=PRECONE)
    return bd.Scene(beam, mount, physics=bd.Physics(stretch=True))


def coefficient(function, *directions, h=1.0):
    """Mixed second difference of a quadratic function: exact but for rounding."""
    a, b = (h * np.array(d) for d in directions)
    return (function(a + b) - function(a) - function(b) + function(0 * a)) / h**2


def test_stretch_and_deflection_are_coupled_by_mass():
    """A unit mass with s along the beam and u along e: second derivatives of its energies are the factors."""
    c, s = np.cos(0.7), np.sin(0.7)
    equations = assemble_equations(stretched(), PowerSeries())
    bending, stretch = equations.blocks["bending"], equations.blocks["stretch"]

    def centrifugal(q):
        return stretched_energy(0.0, q[0], c * q[1], s * q[1], 0.0, 0.0)[0]

    matrices = {t.name: t.matrix for t in equations.terms}
    M11, M12 = matrices["stretch mass"], matrices["Coriolis coupling of stretch"]
    K = equations.matrices[0]["speed_squared"]
    along, across = [1.0, 0.0], [0.0, 1.0]
    assert_equal(K[stretch, stretch], -2 * centrifugal(np.array(along)) * M11)
    assert_equal(K[stretch, bending], -coefficient(centrifugal, along, across) * M12)
    assert_equal(K[bending, stretch], K[stretch, bending].T)

    def linear(q):  # with s = q[0] and the rate of u, q[1]
        return -stretched_energy(0.0, q[0], 0.0, 0.0, c * q[1], s * q[1])[1]

    # d/dt of dL/du' - dL/du: the part with s' is twice that by s u'.
    factor = coefficient(linear, along, across)
    assert_equal(equations.matrices[1]["speed"][bending, stretch], 2 * factor * M12.T)
    assert_equal(equations.matrices[1]["speed"][stretch, bending], -2 * factor * M12)
    assert_equal(equations.matrices[0]["acceleration"][bending, stretch], factor * M12.T)


def test_stretching_load():
    """The centrifugal force along the beam is omega^2 cos^2(eta) x per mass."""
    equations = assemble_equations(stretched(), PowerSeries())
    flat_scene = replace(stretched(), mount=replace(stretched().mount, precone=0.0))
    without = assemble_equations(flat_scene, PowerSeries())
    stretch = equations.blocks["stretch"]
    assert_equal(
        equations.vectors["speed_squared"][stretch],
        float(COSINE) ** 2 * without.vectors["speed_squared"][stretch],
    )


# Acceleration of the root ----------------------------------------------------------------------------


@pytest.mark.parametrize("sign", SIGNS)
def test_root_acceleration(sign):
    """Second differences of the position of the root, in axes that are turned matrix by matrix."""
    mount, gravity = bd.Mount(0.7, pi, 0.4, precone=sign * PRECONE), 9.81
    theta, speed, acceleration, carrier = 0.6, 2.0, 0.9, np.array([0.3, -0.2, 1.1])

    def about_n3(angle):  # columns a1, a2, a3
        c, s = np.cos(angle), np.sin(angle)
        return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])

    def position(t):
        angle = theta + speed * t + acceleration * t**2 / 2
        return carrier * t**2 / 2 - mount.radius * about_n3(angle)[:, 0]

    h = 1e-4
    found = (position(h) - 2 * position(0.0) + position(-h)) / h**2 + np.array([0.0, gravity, 0.0])
    outward = about_n3(theta) @ np.diag([-1.0, -1.0, 1.0])  # b1 = -a1, b2 = -a2
    b1, b2, b3 = outward.T
    eta = mount.precone
    along, across = np.cos(eta) * b1 + np.sin(eta) * b3, np.cos(eta) * b3 - np.sin(eta) * b1
    e1, e2 = np.cos(0.4) * b2 + np.sin(0.4) * across, np.cos(0.4) * across - np.sin(0.4) * b2
    sample = MotionSample(np.array(theta), np.array(speed), np.array(acceleration), carrier)
    root = root_motion(mount, sample, gravity)
    ours = [root.root_axial, root.root_transverse, root.root_across]
    # Second differences of a motion of size 1: rounding 1e-16/h^2, and h^2/12 of its fourth derivative.
    np.testing.assert_allclose(ours, [found @ e for e in (along, e1, e2)], atol=1e-6)
