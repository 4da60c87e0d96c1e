"""Precone: closed forms, the second method, and what its analyses refuse."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.common.inputs.checks import InvalidValue
from benchmarks.cases.reference.of_two_planes import coned_frequencies_of, squared_frequencies

# Rigid blades and massless shafts are of no material.
pytestmark = pytest.mark.filterwarnings("ignore:bending_stiffness:UserWarning")

RITZ, FEM = 1e-9, 1e-6  # promised relative errors
FLAP, EDGE = math.pi / 2, 0.0
BODY = bd.TipMass(0.4, 0.1, 0.05, transverse_inertia=0.03, axial_inertia=0.02)
TWIST = Polynomial([0.2, 0.6])


def blade(mass=1.0, stiffness=1.0, second=4.0, **properties):
    return bd.Beam.from_stiffness(1.0, mass, stiffness, second_bending_stiffness=second, **properties)


def angular(scene, speed, count, **options):
    return 2 * np.pi * bd.natural_modes(scene, speed, count, **options).frequency


def mounted(beam, radius, bending, precone, *springs, **physics):
    physics = bd.Physics(**({"planes": 2} | physics))
    return bd.Scene(beam, bd.Mount(radius, math.pi, bending, *springs, precone=precone), physics=physics)


STOCKY = {
    "rotary_inertia": 0.002,
    "second_rotary_inertia": 0.008,
    "shear_stiffness": 100.0,
    "second_shear_stiffness": 150.0,
}
TAPER = Polynomial([1.0, -0.5]), Polynomial([1.0, -0.7]), Polynomial([9.0, -6.0])
CASES = {
    "straight": mounted(blade(), 0.3, FLAP, 0.2),
    "twisted": mounted(blade(twist=TWIST), 0.3, FLAP, 0.2),
    "tapered": mounted(blade(*TAPER, twist=TWIST), 1.0, 0.4, -0.5),
    "tip body": mounted(blade(twist=TWIST, tip=BODY), 1.0, 0.4, 0.4),
    "stocky": mounted(blade(twist=TWIST, tip=BODY, **STOCKY), 1.0, 0.4, 0.4, shear=True, rotary_inertia=True),
    "on springs": mounted(blade(twist=TWIST, tip=BODY), 0.6, 1.2, 0.7, 3.0, 8.0),
    "past its critical speed": mounted(blade(second=1.0), 0.0, EDGE, 1.3),
}


@pytest.mark.parametrize("name", CASES)
def test_second_method(name):
    """Collocation, converged to 1e-10, with Coriolis terms: see its docstring."""
    expected, _ = coned_frequencies_of(CASES[name], 4.0, 4)
    modes = bd.natural_modes(CASES[name], 4.0, 4)
    np.testing.assert_allclose(2 * np.pi * modes.frequency, expected, rtol=RITZ)
    assert (modes.error <= RITZ).all()


def test_second_method_by_elements():
    expected, _ = coned_frequencies_of(CASES["tip body"], 4.0, 4)
    found = angular(CASES["tip body"], 4.0, 4, discretization="fem")
    np.testing.assert_allclose(found, expected, rtol=FEM)


@pytest.mark.parametrize("name", ["straight", "tapered", "stocky"])
def test_second_method_in_one_plane(name):
    scene = replace(CASES[name], physics=replace(CASES[name].physics, planes=1))
    squares, _ = squared_frequencies(scene, 4.0)
    np.testing.assert_allclose(angular(scene, 4.0, 3), np.sqrt(squares), rtol=RITZ)


# Closed forms -------------------------------------------------------------------------------------


@pytest.mark.parametrize("eta", [0.3, -0.6])
def test_flap_of_a_hinged_blade_on_the_axis(eta):
    """The turn x about the hinge is exact for any stiffness: omega^2 (cos^2 - sin^2) of twice the angle."""
    scene = mounted(blade(), 0.0, FLAP, eta, 0.0, planes=1)
    assert angular(scene, 2.0, 1)[0] == pytest.approx(2.0 * math.sqrt(math.cos(2 * eta)), rel=RITZ)


@pytest.mark.parametrize("bending", [FLAP, EDGE])
def test_rigid_hinged_blade(bending):
    """Flap: omega^2 (cos 2 eta + 3 r/(2 L) cos eta); lag: omega^2 (3 r/(2 L) cos eta - sin^2 eta).

    The stiffness is finite: bending lowers the square by about (omega/omega_1)^2, here 1e-9.
    """
    eta, r, speed = 0.35, 0.4, 2.0
    scene = mounted(blade(stiffness=1e8), r, bending, eta, 0.0, planes=1)
    by_turn = math.cos(2 * eta) if bending == FLAP else -(math.sin(eta) ** 2)
    squared = speed**2 * (by_turn + 1.5 * r * math.cos(eta))
    assert angular(scene, speed, 1)[0] == pytest.approx(math.sqrt(squared), rel=1e-8)


def test_rigid_hinged_blade_couples_flap_and_lag():
    """Of both hinges: (k_f - w^2) (k_l - w^2) = (2 omega sin eta w)^2, the Coriolis forces between them."""
    eta, r, speed = 0.35, 0.9, 2.0
    scene = mounted(blade(1.0, 1e8, 1e8), r, FLAP, eta, 0.0, 0.0)
    pull = 1.5 * r * math.cos(eta)
    flap, lag = speed**2 * (math.cos(2 * eta) + pull), speed**2 * (pull - math.sin(eta) ** 2)
    coupling = (2 * speed * math.sin(eta)) ** 2
    squared = np.sort(np.roots([1.0, -(flap + lag + coupling), flap * lag]))
    np.testing.assert_allclose(angular(scene, speed, 2), np.sqrt(squared), rtol=1e-8)


def test_tension_of_a_string_like_blade():
    """At high speed the flap of a blade on the axis is the string's: (N u')' has the squares of Legendre.

    omega^2 (cos^2 k (2 k - 1) - sin^2), k = 1, 2: odd Legendre polynomials of degree 2 k - 1.
    """
    eta, speed = 0.4, 3000.0
    scene = mounted(blade(stiffness=1e-3), 0.0, FLAP, eta, 0.0, planes=1)
    k = np.array([1, 2])
    squared = speed**2 * (math.cos(eta) ** 2 * k * (2 * k - 1) - math.sin(eta) ** 2)
    np.testing.assert_allclose(angular(scene, speed, 2), np.sqrt(squared), rtol=1e-6)  # EI/(omega L^2)^2


def test_a_round_beam_along_the_axis_is_a_shaft():
    """In axes that turn with it, a round shaft has the frequencies at rest less and plus the speed."""
    beam, speed = blade(second=1.0), 1.5
    at_rest = angular(mounted(beam, 0.0, EDGE, 0.0), 0.0, 4)[[0, 2]]
    found = angular(mounted(beam, 0.0, EDGE, math.pi / 2 - 1e-9), speed, 4)
    expected = np.add.outer(at_rest, [-speed, speed]).ravel()
    np.testing.assert_allclose(found, expected, rtol=RITZ)


def test_a_round_disc_on_a_shaft():
    """Gyroscopic moment of a disc, in axes at rest: J_t w^2 + J_1 omega w, with a massless shaft.

    Stiffness of the tip against deflection and slope: 12 EI/L^3, -6 EI/L^2, 4 EI/L.
    """
    m, transverse, axial, speed = 2.0, 0.3, 0.5, 0.8
    disc = bd.TipMass(m, 0.0, transverse, transverse_inertia=transverse, axial_inertia=axial)
    scene = mounted(blade(mass=1e-9, second=1.0, tip=disc), 0.0, EDGE, math.pi / 2 - 1e-9)
    found = angular(scene, speed, 4)
    K, M = np.array([[12.0, -6.0], [-6.0, 4.0]]), np.diag([m, transverse])
    # Whirl p exp(i w t) of deflection and slope: K - w^2 M, and +J_1 omega w on the slope.
    G = np.diag([0.0, axial * speed])
    zero, one = np.zeros((2, 2)), np.eye(2)
    whirl = np.linalg.eigvals(np.block([[zero, one], [np.linalg.solve(M, K), np.linalg.solve(M, G)]])).real
    np.testing.assert_allclose(found, np.sort(np.abs(whirl - speed)), rtol=1e-8)  # the shaft's mass


# Analyses -----------------------------------------------------------------------------------------


def test_critical_speed_is_where_modes_begin_to_grow():
    scene = mounted(blade(), 0.0, FLAP, 0.5)
    critical = bd.critical_speed(scene)
    below, above = (bd.natural_modes(scene, critical * f, 1).growth_rate[0] for f in (0.999, 1.001))
    assert below == 0 < above


def test_a_large_hub_radius_stiffens():
    """The rotation stiffens against every deflection where r >= L sin^2 eta / cos eta, 0.26 here."""
    assert bd.critical_speed(mounted(blade(), 0.3, FLAP, 0.5)) == math.inf
    assert bd.critical_speed(mounted(blade(), 0.1, FLAP, 0.5)) < math.inf


def test_bounds_in_one_plane():
    scene = mounted(blade(*TAPER, tip=BODY), 0.3, 1.1, 0.6, planes=1)
    bounds = bd.frequency_bounds(scene, 6.0, 3)
    exact = np.sqrt(squared_frequencies(scene, 6.0)[0]) / (2 * np.pi)
    assert (bounds.width < 1e-8).all()
    # The second method converged to 1e-12.
    assert (bounds.lower <= exact * (1 + 1e-11)).all() and (exact * (1 - 1e-11) <= bounds.upper).all()


def test_static_deflection_of_a_stiff_blade():
    """Rotation presses to the plane by omega^2 sin eta (r + x cos eta) per mass: deflection by hand."""
    eta, r, speed = 0.2, 0.5, 0.01  # so slow that tension does not matter: 1e-5
    scene = mounted(blade(), r, FLAP, eta, planes=1)
    modes = bd.natural_modes(scene, speed, 1)
    force = Polynomial([r, math.cos(eta)]) * (speed**2 * math.sin(eta))
    x = Polynomial([0.0, 1.0])
    tip = -(force * x**2 * (3 - x) / 6).integ()(1.0)  # influence of a force at x on the tip
    assert modes.static_deflection == pytest.approx(tip, rel=1e-4)


def test_a_run_keeps_its_equilibrium():
    scene = replace(
        mounted(blade(twist=TWIST), 0.5, FLAP, 0.2), motion=bd.SteadyRotation(1.0), damping_ratio=0.05
    )
    run = bd.simulate(scene, 5.0, modes=3, initial="equilibrium")
    assert np.ptp(run.tip) <= 1e-9 * np.abs(run.tip).max()


# Refusals -----------------------------------------------------------------------------------------

SCENE = mounted(blade(), 0.3, FLAP, 0.2)


@pytest.mark.parametrize(
    ("call", "field"),
    [
        (lambda: bd.Mount(0.3, 0.0, precone=0.1), "precone"),
        (lambda: bd.Mount(0.3, math.pi, precone=math.pi / 2), "precone"),
        (lambda: bd.Mount(0.3, math.pi, precone=math.nan), "precone"),
        (lambda: bd.frequency_bounds(SCENE, 1.0), "precone"),
        (lambda: bd.setting_angle_limits(SCENE, 10.0), "precone"),
    ],
)
def test_refused_by_name(call, field):
    with pytest.raises(InvalidValue) as refused:
        call()
    assert refused.value.field == field
    assert refused.value.bound or refused.value.remedy


def test_bounds_of_two_planes_at_rest():
    assert np.isfinite(bd.frequency_bounds(SCENE, 0.0).width).all()


def test_large_deflection_left_out_is_what_it_changes():
    plain, bent = (
        bd.natural_modes(replace(SCENE, physics=bd.Physics(large_deflection=large)), 1.0, 2)
        for large in (False, True)
    )
    change = bent.frequency / plain.frequency - 1
    np.testing.assert_allclose(plain.left_out["large deflection"], change, rtol=1e-6)
