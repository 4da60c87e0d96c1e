"""Large deflection, derived again from a Lagrangian in fixed axes.

The derivation knows nothing of beamdyn's formulas: no accelerations in turning axes, no moments of inertia
about them, no virtual work of such.  A section, and the tip body, is a centre of gravity with three second
moments along axes that turn with it.  Its kinetic energy in fixed axes and the potential of gravity give,
through Lagrange's equations, the forces that belong to its position (u, v) along b1 and e and to its angle
theta.  Along the beam these are functions of the coordinates q through the slope angle; integrals are by a
Gauss rule of its own, and derivatives by the coordinates are by an imaginary part, without a difference.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
import sympy as sp
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.equations.assembly import assemble_equations
from beamdyn.equations.beam_in_space.rotating_beam import RotatingBeam, assemble_beam_in_space
from beamdyn.equations.root_motion import root_motion
from tests.invariants.power_spaces import BENDING, PowerSeries

RTOL = 1e-12  # rounding of sums of products of numbers of order 1
TINY = 1e-100  # an imaginary part: the derivative of an analytic function, without a difference

# Numbers: properties of the beam over x/L, the tip body by its second moments.
LENGTH, GRAVITY, SPRING = 1.25, 0.7, 3.0
MASS, STIFFNESS, SECTIONS = Polynomial([1.5, -0.6]), Polynomial([2.0, -0.9]), Polynomial([0.14, -0.05])
TIP_MASS, OFFSET, TIP_MOMENTS = 0.8, 0.33, (0.3, 0.2, 0.45)  # int x^2, int y^2, int z^2 about its centre
POWERS = (1, *BENDING)  # of x in the deflection: the spring lets the root turn
SETTING, RADIUS = 0.7, 0.9

COSINES, SINES = (1.0, 0.0, -1.0, 0.0), (0.0, 1.0, 0.0, -1.0)  # of the bending angle, by quarters of a turn
by_quarter = pytest.mark.parametrize("quarters", range(4), ids=["in", "out", "in, back", "out, back"])
by_quantity = pytest.mark.parametrize(
    "quantity", ["speed_squared", "acceleration", "root_axial", "root_transverse"]
)


# Lagrange's equations of one section --------------------------------------------------------------

NAMES = "u v theta turn x1 x2 x3"  # position, angle; turn of the carrier about -n3, position of its centre
MOVING = 3  # of these are unknown, the rest is given


@cache
def forces_of_a_section():
    """Function of values, rates, accelerations and constants: left sides of the equations of u, v, theta."""
    t = sp.Symbol("t")
    motion = [sp.Function(name)(t) for name in NAMES.split()]
    constants = sp.symbols("m X Y Z g r cphi sphi c s")
    lagrangian = lagrangian_of_a_section(t, motion, constants)
    sides = []
    for x in motion[:MOVING]:
        momentum = sp.diff(lagrangian, sp.diff(x, t))
        sides.append(sp.diff(momentum, t) - sp.diff(lagrangian, x))
    symbols = [sp.symbols([f"{n}_{order}" for n in NAMES.split()]) for order in range(3)]
    for order in (2, 1, 0):
        names = {sp.diff(f, t, order) if order else f: n for f, n in zip(motion, symbols[order], strict=True)}
        sides = [side.subs(names) for side in sides]
    return sp.lambdify([*symbols, constants], sides, cse=True)


def lagrangian_of_a_section(t, motion, constants):
    """In fixed axes n1, n2, n3: the carrier turns about -n3, its root stands at -r a1."""
    u, v, theta, turn, *centre = motion
    m, X, Y, Z, g, r, cphi, sphi, c, s = constants
    a1 = sp.Matrix([sp.cos(turn), -sp.sin(turn), 0])
    a2, a3 = sp.Matrix([sp.sin(turn), sp.cos(turn), 0]), sp.Matrix([0, 0, 1])
    b1, b2 = cphi * a1 - sphi * a2, sphi * a1 + cphi * a2
    e, across = c * b2 + s * a3, -s * b2 + c * a3
    along = sp.cos(theta) * b1 + sp.sin(theta) * e
    normal = -sp.sin(theta) * b1 + sp.cos(theta) * e
    place = sp.Matrix(centre) - r * a1 + u * b1 + v * e
    squares = ((m, place), (X, along), (Y, normal), (Z, across))
    kinetic = sum(weight * p.diff(t).dot(p.diff(t)) for weight, p in squares) / 2
    return kinetic - m * g * place[1]


# The beam -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Carrier:
    """Values, rates and accelerations of the given motion: its turn, and the place of its centre."""

    turn: tuple[float, float, float] = (0.0, 0.0, 0.0)
    centre: tuple[tuple[float, float, float], ...] = ((0.0,) * 3,) * 3
    radius: float = RADIUS
    setting: float = SETTING
    gravity: float = GRAVITY


def nodes(upper):
    """Gauss rule from 0 to each `upper` (...): nodes and weights (..., k)."""
    t, w = np.polynomial.legendre.leggauss(24)
    return np.asarray(upper)[..., None] / 2 * (1 + t), np.asarray(upper)[..., None] / 2 * w


def angle_functions(x, order=0):
    """Slope angles per coordinate, or their derivatives: shape (n, ...) for x (...)."""
    return np.array([Polynomial([0] * k + [1]).deriv(1 + order)(x) for k in POWERS])


def direction(x, q, q1, q2):
    """Tangent of the beam: along b1 and e its values, two rates, and gradients by q."""
    T = angle_functions(x)
    theta, theta1, theta2 = (np.tensordot(rate, T, 1) for rate in (q, q1, q2))
    cos, sin = np.cos(theta), np.sin(theta)
    return (
        np.array([cos, -sin * theta1, -sin * theta2 - cos * theta1**2, *(-sin * T)]),
        np.array([sin, cos * theta1, cos * theta2 - sin * theta1**2, *(cos * T)]),
    )


def position(x, q, q1, q2):
    """As `direction`, of the point at x."""
    y, w = nodes(x)
    return [(values * w).sum(axis=-1) for values in direction(y, q, q1, q2)]


def work(x, weights, q, q1, q2, carrier, quarters, beyond=0.0):
    """Virtual work per coordinate (n,) of inertia and weight of bodies at x (k,), centred `beyond` it."""
    straight_on = direction(x, q, q1, q2)
    u, v = (p + beyond * d for p, d in zip(position(x, q, q1, q2), straight_on, strict=True))
    T = angle_functions(x)
    angle = [np.tensordot(rate, T, 1) for rate in (q, q1, q2)]
    given = [[u[i], v[i], angle[i], carrier.turn[i], *carrier.centre[i]] for i in range(3)]
    c, s = COSINES[quarters], SINES[quarters]
    mount = carrier.gravity, carrier.radius, math.cos(carrier.setting), math.sin(carrier.setting), c, s
    along_u, along_v, about = forces_of_a_section()(*given, (*weights, *mount))
    return (along_u * u[3:] + along_v * v[3:] + about * T).sum(axis=-1)


def residual(q, q1, q2, carrier, quarters):
    """Left side of the equations of motion (n,)."""
    x, w = nodes(LENGTH)
    sections = w * MASS(x / LENGTH), 0.0, w * SECTIONS(x / LENGTH), w * 0.2
    body, end = (TIP_MASS, *TIP_MOMENTS), np.array([LENGTH])
    by_sections = work(x, sections, q, q1, q2, carrier, quarters)
    return elastic() @ q + by_sections + work(end, body, q, q1, q2, carrier, quarters, OFFSET)


@cache
def elastic():
    x, w = nodes(LENGTH)
    curvature, root = angle_functions(x, 1), angle_functions(np.zeros(1))
    return (curvature * w * STIFFNESS(x / LENGTH)) @ curvature.T + SPRING * root @ root.T


def derivative(function, at):
    """Derivative of an analytic function of (n,): columns by component."""
    bumps = 1j * TINY * np.eye(len(at))
    return np.stack([np.imag(function(at + bump)) / TINY for bump in bumps], axis=-1)


# beamdyn ------------------------------------------------------------------------------------------


@cache
def elastica(quarters) -> RotatingBeam:
    x2, y2, z2 = TIP_MOMENTS
    tip = bd.TipMass(TIP_MASS, OFFSET, x2 + y2, x2 + z2, y2 + z2)
    beam = bd.Beam.from_stiffness(LENGTH, MASS, STIFFNESS, tip=tip, rotary_inertia=SECTIONS)
    mount = bd.Mount(RADIUS, SETTING, quarters * math.pi / 2, root_stiffness=SPRING)
    physics = bd.Physics(large_deflection=True, rotary_inertia=True)
    scene = bd.Scene(beam, mount, gravity=GRAVITY, physics=physics)
    return assemble_beam_in_space(scene, PowerSeries(), assemble_equations(scene, PowerSeries()))


def root_of(quarters, carrier):
    (turn, speed, acceleration), centre = carrier.turn, np.array(carrier.centre[2])
    mount = replace(elastica(quarters).linear.mount, radius=carrier.radius, setting_angle=carrier.setting)
    sample = bd.MotionSample(*map(np.array, (turn, speed, acceleration)), centre)
    return root_motion(mount, sample, carrier.gravity)


def some_state(seed):
    """Coordinates that turn the tip by about one radian, and their rates."""
    return np.random.default_rng(seed).uniform(-0.3, 0.3, (3, len(POWERS)))


def unit_motion(quantity, quarters):
    """A carrier on which the quantity is 1, and nothing else but the speed is."""
    along_e = (0.0, COSINES[quarters], SINES[quarters])
    acceleration = {"root_axial": (1.0, 0.0, 0.0), "root_transverse": along_e}
    centre = ((0.0,) * 3, (0.0,) * 3, acceleration.get(quantity, (0.0,) * 3))
    turn = (0.0, float(quantity == "speed_squared"), float(quantity == "acceleration"))
    return Carrier(turn, centre, radius=0.0, setting=0.0, gravity=0.0)


def force_at_rest(quantity, quarters):
    """Left side for a beam at rest on a carrier that moves by one quantity, as a function of q."""
    still, carrier = np.zeros(len(POWERS)), unit_motion(quantity, quarters)
    return lambda q: residual(q, still, still, carrier, quarters) - elastic() @ q


def assert_equal(found, derived):
    np.testing.assert_allclose(found, derived, rtol=0, atol=RTOL * max(1.0, np.abs(derived).max()))


# --------------------------------------------------------------------------------------------------


@by_quarter
@pytest.mark.parametrize("seed", range(5))
def test_equations_of_motion(quarters, seed):
    """At random states of beam and carrier, of which its place and velocity do not matter."""
    q, q1, q2 = some_state(seed)
    random = np.random.default_rng(100 + seed)
    turn, centre = random.uniform(-2, 2, 3), random.uniform(-2, 2, (3, 3))
    carrier = Carrier(tuple(turn.tolist()), tuple(map(tuple, centre.tolist())))
    found = elastica(quarters).at(q).work(q1, q2, root_of(quarters, carrier))
    assert_equal(found, residual(q, q1, q2, carrier, quarters))


@by_quarter
def test_mass(quarters):
    q, still, _ = some_state(7)
    derived = derivative(lambda q2: residual(q, still, q2, Carrier(), quarters), still)
    assert_equal(elastica(quarters).at(q).bent.mass, derived)


@by_quarter
def test_gyroscopic_matrix(quarters):
    q, still = some_state(8)[0], np.zeros(len(POWERS))
    turning = Carrier((0.4, 1.0, 0.0))
    derived = derivative(lambda q1: residual(q, q1, still, turning, quarters), still)
    assert_equal(elastica(quarters).at(q).gyroscopic, derived)
    assert (np.abs(derived).max() > 0.1) == (quarters in (0, 2))  # none out of the plane


@by_quarter
@by_quantity
def test_tangent_stiffness(quarters, quantity):
    q = some_state(9)[0]
    derived = derivative(force_at_rest(quantity, quarters), q)
    assert_equal(elastica(quarters).at(q).under({quantity: 1.0}).change, derived)


@by_quarter
@by_quantity
def test_loads(quarters, quantity):
    q = some_state(10)[0]
    linearized = elastica(quarters).at(q).linearized()
    assert_equal(linearized.vectors[quantity], -force_at_rest(quantity, quarters)(q))


@by_quarter
def test_elastic_forces(quarters):
    assert_equal(elastica(quarters).beam.stiffness, elastic())


@by_quarter
def test_small_deflections_are_those_of_the_linear_model(quarters):
    """About the straight beam both have the same matrices and loads."""
    bent = elastica(quarters)
    about_straight = bent.at(np.zeros(bent.beam.size)).linearized()
    for ours, linear in zip(about_straight.matrices, bent.linear.matrices, strict=True):
        for quantity in {*ours, *linear}:
            none = np.zeros((bent.beam.size, bent.beam.size))
            assert_equal(ours.get(quantity, none), linear.get(quantity, none))
    for quantity in {*about_straight.vectors, *bent.linear.vectors} - {"root_across"}:
        none = np.zeros(bent.beam.size)
        assert_equal(about_straight.vectors.get(quantity, none), bent.linear.vectors.get(quantity, none))


@by_quarter
def test_changes_of_the_deflection(quarters):
    """What `tip`, `shape` and the modal loads are made of: the change of v by the coordinates."""
    q, still = some_state(11)[0], np.zeros(len(POWERS))
    (deflection,) = elastica(quarters).at(q).linearized().deflections.values()
    for x in (0.3 * LENGTH, LENGTH):
        derived = derivative(lambda p, x=x: position(x, p, still, still)[1][0], q)
        assert_equal(deflection.space.evaluate(np.array([x / LENGTH]))[:, 0], derived)
    assert_equal(deflection.space.end(0), derived)
    assert_equal(deflection.P, force_at_rest("root_transverse", quarters)(q))
