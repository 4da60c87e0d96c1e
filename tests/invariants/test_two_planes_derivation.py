"""Two planes of bending, shear, rotary inertia and an oblique tip body, derived again from a Lagrangian.

The derivation knows nothing of beamdyn's formulas.  It takes a frame that follows each section: the first
axis is along the tangent of bending, and the frame does not twist about it along the beam, because
the beam is rigid in torsion.  Positions to second order in the coordinates, and the Lagrangian in the axes of
the root, which turns and accelerates, give the equations.  All is polynomial arithmetic with rationals;
the trial functions are powers of x, in both derivations.
"""

from dataclasses import dataclass
from functools import cache
from math import atan2

import numpy as np
import pytest
from sympy import QQ
from sympy.polys.rings import ring

import beamdyn as bd
from beamdyn.equations.assembly import assemble_equations
from tests.invariants.power_spaces import BENDING, STRETCH, PowerSeries

RTOL = 1e-12  # rounding of sums of products of numbers of order 1

BLOCKS = [(BENDING, 0, True), (BENDING, 1, True), (STRETCH, 0, False), (STRETCH, 1, False)]
FUNCTIONS = [(k, *rest) for powers, *rest in BLOCKS for k in powers]  # power, direction, bending or shear
N = len(FUNCTIONS)
RING, X, *VARIABLES = ring(["x", *(f"q{i}" for i in range(N)), *(f"v{i}" for i in range(N))], QQ)
POSITIONS, VELOCITIES = VARIABLES[:N], VARIABLES[N:]
ZERO, ONE = RING.zero, RING.one

# Parameters: rational, and rational cosines and sines.
LENGTH, MASS, INERTIAS = QQ(5, 4), QQ(3, 2), (QQ(1, 7), QQ(2, 5))  # of sections
TIP_MASS, OFFSET = QQ(4, 5), QQ(1, 3)
TIP_MOMENTS = QQ(3, 4), QQ(1, 5), QQ(1, 3)  # int x^2, int y^2, int z^2 along the body's axes
STIFFNESSES, SHEAR_STIFFNESSES = (QQ(2), QQ(7)), (QQ(30), QQ(50))
PSI, TWIST = (QQ(3, 5), QQ(4, 5)), (QQ(12, 13), QQ(5, 13))  # cosine and sine


def cut(p):
    """Without what is beyond second order in coordinates and velocities."""
    return RING.from_dict({k: c for k, c in p.items() if sum(k[1:]) <= 2})


def integral(p, upper):
    whole = RING.from_dict({(k[0] + 1, *k[1:]): c / (k[0] + 1) for k, c in p.items()})
    return whole.compose(X, upper)


def rate(p):
    """Derivative by time of what depends on the coordinates."""
    return sum((p.diff(q) * v for q, v in zip(POSITIONS, VELOCITIES, strict=True)), ZERO)


def dot(a, b):
    return cut(sum((p * q for p, q in zip(a, b, strict=True)), ZERO))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def transverse(bending_only):
    """Deflections u2, u3 along the axes of the root, from those in the directions of bending."""
    c, s = PSI
    v, w = (
        sum(
            (
                q * X**k
                for q, (k, d, bends) in zip(POSITIONS, FUNCTIONS, strict=True)
                if d == direction and (bends or not bending_only)
            ),
            ZERO,
        )
        for direction in (0, 1)
    )
    return [c * v - s * w, s * v + c * w]


def frame():
    """Columns of the rotation of a section, to second order: the tangent of bending, and no twist."""
    y, z = (u.diff(X) for u in transverse(bending_only=True))
    turn = [ZERO, -z, y]  # the rotation vector that takes b1 to the tangent, without twist
    columns = [columns_of(turn, axis) for axis in np.eye(3, dtype=int)]
    # Twist of this frame: how fast the second axis turns towards the third, along the beam.
    twist = dot([p.diff(X) for p in columns[1]], columns[2])
    angle = -integral(twist, X)  # turns the sections back
    second = [cut(a + angle * b) for a, b in zip(columns[1], columns[2], strict=True)]
    third = [cut(b - angle * a) for a, b in zip(columns[1], columns[2], strict=True)]
    return columns[0], second, third


def columns_of(turn, axis):
    """A unit vector turned by a rotation vector, to second order."""
    once = cross(turn, [ONE * int(a) for a in axis])
    twice = cross(turn, once)
    return [cut(ONE * int(a) + p + q / 2) for a, p, q in zip(axis, once, twice, strict=True)]


def centre():
    """Position of the axis of the beam: tension acts on the slope of the whole deflection."""
    u2, u3 = transverse(bending_only=False)
    shortening = integral((u2.diff(X) ** 2 + u3.diff(X) ** 2) / 2, X)
    return [X - shortening, u2, u3]


def turned_moments(first, second, angle):
    """Second moments along b2, b3 of a section with principal axes at an angle: cosine and sine."""
    c, s = angle
    return [[first * c**2 + second * s**2, (first - second) * c * s],
            [(first - second) * c * s, first * s**2 + second * c**2]]  # fmt: skip


def axes_of_sections():
    """Cosine and sine of the angle of the sections to the plane of rotation."""
    (c, s), (ct, st) = PSI, TWIST
    return c * ct - s * st, s * ct + c * st


def bodies():
    """Pairs of position vectors with the mass or second moment that multiplies their product."""
    along, second, third = frame()
    angle = axes_of_sections()
    # Bending in a direction turns the section about the axis across: its inertia is the moment along it.
    E = turned_moments(*INERTIAS, angle)
    of_sections = [(centre(), centre(), MASS)]
    of_sections += [(a, b, E[i][j]) for i, a in enumerate((second, third))
                    for j, b in enumerate((second, third))]  # fmt: skip
    whole = [(a, b, w, True) for a, b, w in of_sections]
    x2, y2, z2 = TIP_MOMENTS
    P = turned_moments(y2, z2, angle)
    gravity = [p + OFFSET * q for p, q in zip(centre(), along, strict=True)]
    tip = [(gravity, gravity, TIP_MASS), (along, along, x2)]
    tip += [(a, b, P[i][j]) for i, a in enumerate((second, third)) for j, b in enumerate((second, third))]
    return whole + [(a, b, w, False) for a, b, w in tip]


def total(density):
    """Sum over the bodies of a bilinear function of two position vectors."""
    result = ZERO
    for a, b, weight, distributed in bodies():
        p = cut(density(a, b)) * weight
        result += integral(p, LENGTH) if distributed else p.compose(X, RING(LENGTH))
    return result


@dataclass(frozen=True)
class Derived:
    """Matrices and loads by quantity of motion."""

    mass: np.ndarray
    gyroscopic: np.ndarray
    stiffness: dict
    load: dict


IN_PLANE = QQ(0), QQ(1)  # components along b1 and b3 of the axis of rotation


@cache
def derive(axis=IN_PLANE):
    """Lagrange's equations in axes that turn by -omega and whose origin accelerates.

    The axis of rotation has the given components along b1 and b3.
    """
    spin = [-ONE * axis[0], ZERO, -ONE * axis[1]]
    kinetic = total(lambda a, b: dot([rate(p) for p in a], [rate(p) for p in b])) / 2
    gyroscopic = total(lambda a, b: dot([rate(p) for p in a], cross(spin, b)))
    centrifugal = total(lambda a, b: dot(cross(spin, a), cross(spin, b))) / 2
    c, s = PSI
    moments = [-first_moment(i) for i in range(3)]  # potential of the inertia of a unit root acceleration
    accelerations = {
        "root_axial": moments[0],
        "root_transverse": c * moments[1] + s * moments[2],
        "root_across": -s * moments[1] + c * moments[2],
    }
    work = {"speed_squared": centrifugal, **accelerations}
    load = {name: gradient(p) for name, p in work.items()}
    stiffness = {name: -hessian(p, POSITIONS, POSITIONS) for name, p in work.items()}
    stiffness["acceleration"] = hessian(gyroscopic, VELOCITIES, POSITIONS)
    load["acceleration"] = -np.array([number(gyroscopic.diff(v)) for v in VELOCITIES])
    G = stiffness["acceleration"]
    return Derived(hessian(kinetic, VELOCITIES, VELOCITIES), G - G.T, stiffness, load)


def first_moment(axis):
    gravity = [p + OFFSET * q for p, q in zip(centre(), frame()[0], strict=True)]
    return MASS * integral(centre()[axis], LENGTH) + TIP_MASS * gravity[axis].compose(X, RING(LENGTH))


def number(p):
    return float(p.coeff(1))


def gradient(p):
    return np.array([number(p.diff(q)) for q in POSITIONS])


def hessian(p, rows, columns):
    return np.array([[number(p.diff(a).diff(b)) for b in columns] for a in rows])


@cache
def scene():
    x2, y2, z2 = map(float, TIP_MOMENTS)
    tip = bd.TipMass(float(TIP_MASS), float(OFFSET), x2 + y2, x2 + z2, y2 + z2)
    (ew, es), (gw, gs), (rw, rs) = (map(float, p) for p in (STIFFNESSES, SHEAR_STIFFNESSES, INERTIAS))
    beam = bd.Beam.from_stiffness(
        float(LENGTH), float(MASS), ew, tip=tip, second_bending_stiffness=es,
        twist=atan2(float(TWIST[1]), float(TWIST[0])), shear_stiffness=gw, second_shear_stiffness=gs,
        rotary_inertia=rw, second_rotary_inertia=rs,
    )  # fmt: skip
    mount = bd.Mount(1.0, 0.3, atan2(float(PSI[1]), float(PSI[0])))
    return bd.Scene(beam, mount, physics=bd.Physics(planes=2, shear=True, rotary_inertia=True))


@cache
def ours():
    return assemble_equations(scene(), PowerSeries())


def assert_equal(found, derived):
    np.testing.assert_allclose(found, derived, rtol=RTOL, atol=RTOL * np.abs(derived).max())


def test_mass():
    assert_equal(ours().matrices[2]["unity"], derive().mass)


def test_no_gyroscopic_coupling():
    assert not ours().matrices[1] and not derive().gyroscopic.any()


@pytest.mark.parametrize("quantity", ["speed_squared", "root_axial"])
def test_stiffness_by_motion(quantity):
    assert_equal(ours().matrices[0][quantity], derive().stiffness[quantity])


@pytest.mark.parametrize("quantity", ["acceleration", "root_transverse", "root_across"])
def test_nothing_else_stiffens(quantity):
    assert quantity not in ours().matrices[0] and not derive().stiffness[quantity].any()


@pytest.mark.parametrize("quantity", ["acceleration", "root_transverse", "root_across"])
def test_loads(quantity):
    assert_equal(ours().vectors[quantity], derive().load[quantity])


def test_elastic_energy():
    """Curvature and shear strain along the axes of the sections, which the twist has turned."""
    (c, s), L = TWIST, LENGTH
    energy = ZERO
    for stiffness, order, bends in ((STIFFNESSES, 2, True), (SHEAR_STIFFNESSES, 1, False)):
        v, w = (
            sum((q * X**k for q, (k, d, b) in zip(POSITIONS, FUNCTIONS, strict=True)
                 if (d, b) == (direction, bends)), ZERO)
            for direction in (0, 1)
        )  # fmt: skip
        for _ in range(order):
            v, w = v.diff(X), w.diff(X)
        strains = c * v + s * w, c * w - s * v
        energy += sum((integral(k * e**2 / 2, L) for k, e in zip(stiffness, strains, strict=True)), ZERO)
    assert_equal(ours().matrices[0]["unity"], hessian(energy, POSITIONS, POSITIONS))
