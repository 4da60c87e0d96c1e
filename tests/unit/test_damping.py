"""Damping mode by mode, by Rayleigh's factors and at the tip, and springs along the beam: closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import newton

import beamdyn as bd
from beamdyn.files.scenes import parse_scene

BEAM = bd.Beam.from_stiffness(1.0, 1.0, 1.0)  # uniform, of unit length, mass and stiffness
RTOL = 1e-9  # promised of frequencies; two digits more than their stated errors here
DISCRETIZATIONS = pytest.mark.parametrize("discretization", ["ritz", bd.Fem(60)])


def roots(characteristic, count):
    """Roots s of a function of s near the undamped cantilever's."""
    beta = np.array([1.8751040687, 4.6940911330, 7.8547574382, 10.9955407349])[:count]
    return np.array([newton(characteristic, 1j * b**2, tol=1e-14, maxiter=200) for b in beta])


def held_at_tip(spring):
    """Characteristic function of a unit cantilever whose tip is held by the force spring(s) w."""

    def characteristic(s):
        beta = (-(s**2)) ** 0.25
        c, s_, ch, sh = np.cos(beta), np.sin(beta), np.cosh(beta), np.sinh(beta)
        return 1 + c * ch + spring(s) / beta**3 * (s_ * ch - c * sh)

    return characteristic


@DISCRETIZATIONS
def test_rayleigh_damping_of_a_mode_is_half_of_alpha_and_beta_omega_squared(discretization):
    damped = bd.Scene(BEAM, damping=bd.Damping(mass_factor=0.2, stiffness_factor=1e-3))
    found = bd.natural_modes(damped, 0.0, 3, discretization=discretization)
    free = bd.natural_modes(bd.Scene(BEAM), 0.0, 3, discretization=discretization)
    omega = 2 * np.pi * free.frequency
    np.testing.assert_allclose(found.growth_rate, -(0.2 + 1e-3 * omega**2) / 2, rtol=RTOL)


def test_each_mode_has_its_ratio_and_further_ones_the_last():
    scene = bd.Scene(BEAM, damping=bd.Damping(ratios=[0.01, 0.0, 0.03]))
    s = bd.natural_modes(scene, 0.0, 4).eigenvalue
    np.testing.assert_allclose(-s.real / np.abs(s), [0.01, 0.0, 0.03, 0.03], rtol=RTOL, atol=1e-12)


def test_modes_of_two_planes_are_counted_together():
    beam = bd.Beam.from_stiffness(1.0, 1.0, 1.0, second_bending_stiffness=4.0)
    ratios = [0.01, 0.02, 0.03, 0.04]
    scene = bd.Scene(beam, damping=bd.Damping(ratios=ratios), physics=bd.Physics(planes=2))
    s = bd.natural_modes(scene, 0.0, 4).eigenvalue
    np.testing.assert_allclose(-s.real / np.abs(s), ratios, rtol=RTOL)


def test_equal_ratios_are_the_one_ratio():
    one = bd.natural_modes(bd.Scene(BEAM, damping_ratio=0.02), 3.0, 3).eigenvalue
    each = bd.natural_modes(bd.Scene(BEAM, damping=bd.Damping(ratios=[0.02])), 3.0, 3).eigenvalue
    np.testing.assert_allclose(each, one, rtol=1e-11)  # rounding of the same matrices


@DISCRETIZATIONS
def test_tip_damper_against_the_characteristic_equation(discretization):
    scene = bd.Scene(BEAM, damping=bd.Damping(tip_damper=0.3))
    found = bd.natural_modes(scene, 0.0, 3, discretization=discretization)
    exact = roots(held_at_tip(lambda s: 0.3 * s), 3)
    rtol = RTOL if discretization == "ritz" else 2e-6  # cubic elements, h^4 of the third mode
    np.testing.assert_allclose(found.eigenvalue, exact, rtol=rtol)


@DISCRETIZATIONS
def test_spring_at_the_tip_against_the_characteristic_equation(discretization):
    beam = replace(BEAM, point_springs=[bd.PointSpring(1.0, 2.0)])
    found = bd.natural_modes(bd.Scene(beam), 0.0, 3, discretization=discretization)
    exact = np.abs(roots(held_at_tip(lambda s: 2.0), 3))
    rtol = RTOL if discretization == "ritz" else 2e-6
    np.testing.assert_allclose(2 * np.pi * found.frequency, exact, rtol=rtol)


def test_static_deflection_over_a_spring_within_the_span():
    # A cantilever under a unit tip force with a spring k at a, which pulls by k w(a): superposition.
    a, k = 0.4, 50.0
    alone, across = a**2 * (3 - a) / 6, a**3 / 3  # w(a) by a unit force at the tip, and at a
    force = k * alone / (1 + k * across)
    tip = 1 / 3 - force * alone  # Maxwell: w(1) by a unit force at a is w(a) by one at the tip
    beam = replace(BEAM, point_springs=[bd.PointSpring(a, k)])
    model = bd.state_space(bd.Scene(beam), 0.0, ["tip force"], ["tip", "root moment"], modes=3)
    static = model.D - model.C @ np.linalg.solve(model.A, model.B)
    np.testing.assert_allclose(static[:, 0], [tip, 1 - force * a], rtol=1e-10)


def test_a_hinged_beam_on_a_spring_turns_against_it():
    # A rigid turn u = x on a soft spring: omega^2 = k a^2 / (1/3), as k L^3/EI vanishes.
    beam = replace(BEAM, point_springs=[bd.PointSpring(0.6, 1e-6)])
    hinged = bd.Scene(beam, bd.Mount(0.1, np.pi, root_stiffness=0.0))
    found = bd.natural_modes(hinged, 0.0, 1).frequency[0]
    assert (2 * np.pi * found) ** 2 == pytest.approx(3e-6 * 0.36, rel=1e-5)  # bending is softer by k a^3/EI
    inward = replace(hinged, mount=bd.Mount(0.1, 0.0, root_stiffness=0.0))
    assert 0 < bd.critical_speed(inward) < 0.1


@pytest.mark.parametrize(
    "damping", [bd.Damping(mass_factor=0.5), bd.Damping(mass_factor=0.5, stiffness_factor=1e-4)]
)
def test_a_damped_free_turn_has_frequency_0_and_leaves_the_other_modes(damping):
    # Proportional damping: s^2 + (alpha + beta omega^2) s + omega^2 = 0 for each mode; of the free turn's two
    # roots, 0 and -alpha, the slower is its eigenvalue.
    hinged = bd.Scene(BEAM, bd.Mount(root_stiffness=0.0))
    omega = 2 * np.pi * bd.natural_modes(hinged, 0.0, 3).frequency[1:]
    found = bd.natural_modes(replace(hinged, damping=damping), 0.0, 3)
    rate = (damping.mass_factor + damping.stiffness_factor * omega**2) / 2
    np.testing.assert_array_equal(found.status, ["neutral", "stable", "stable"])
    np.testing.assert_allclose(2 * np.pi * found.frequency[1:], np.sqrt(omega**2 - rate**2), rtol=RTOL)
    np.testing.assert_allclose(found.growth_rate, [0.0, *-rate], rtol=RTOL)
    assert found.error.max() < 1e-9


@pytest.mark.parametrize("damper", [5.0, 100.0])
def test_a_damped_tip_of_a_hinged_beam_takes_no_other_mode_for_its_free_turn(damper):
    """Its modes are the eigenvalues of the first-order equations; a strong damper holds the tip."""
    beam, mount = bd.Beam.from_stiffness(1.0, 1.0, 1.0), bd.Mount(root_stiffness=0.0)
    scene = bd.Scene(beam, mount, damping=bd.Damping(tip_damper=damper))
    found = bd.natural_modes(scene, 0.0, 4)
    given = bd.matrices(scene, 0.0, None, discretization=found.model.discretization)
    by_mass = [-np.linalg.solve(given.mass, each) for each in (given.stiffness, given.damping)]
    n = len(given.mass)
    A = np.block([[np.zeros((n, n)), np.eye(n)], by_mass])
    s = np.linalg.eigvals(A)
    lowest = np.sort(s.imag[s.imag > 1e-3])[:2]
    vibrating = np.sort(found.frequency[found.frequency > 1e-3])[:2]
    np.testing.assert_allclose(2 * np.pi * vibrating, lowest, rtol=1e-8)  # of a matrix that is not symmetric


def test_springs_at_one_place_add_up_and_the_second_plane_has_its_own():
    beam = bd.Beam.from_stiffness(1.0, 1.0, 1.0, second_bending_stiffness=1.0)
    halves = [bd.PointSpring(0.5, 3.0), bd.PointSpring(0.5, 4.0)]
    across = replace(beam, point_springs=[bd.PointSpring(0.5, 7.0, "across")])
    both = bd.Scene(across, physics=bd.Physics(planes=2))
    one = bd.natural_modes(bd.Scene(replace(beam, point_springs=halves)), 0.0, 1).frequency
    free = bd.natural_modes(bd.Scene(beam), 0.0, 1).frequency
    found = bd.natural_modes(both, 0.0, 2).frequency
    np.testing.assert_allclose(found, [*free, *one], rtol=RTOL)


@pytest.mark.parametrize("damping", [bd.Damping(tip_damper=0.2), bd.Damping(mass_factor=0.5, ratios=[0.01])])
def test_a_transient_with_local_damping_is_that_of_solve_ivp(damping):
    beam = replace(BEAM, outer_fibre=BEAM.mass_per_length)
    scene = bd.Scene(beam, bd.Mount(0.1, np.pi), bd.SpinUp(1.0, 2.0), damping=damping)
    own = bd.simulate(scene, 3.0, modes=2, tolerance=1e-8)
    other = bd.simulate(scene, 3.0, modes=2, tolerance=1e-9, method="DOP853", t_eval=own.t)
    np.testing.assert_allclose(own.tip, other.tip, atol=1e-6 * own.largest, rtol=0)
    strain = own.root_strain(own.t)
    np.testing.assert_allclose(strain, other.root_strain(own.t), atol=1e-6 * np.abs(strain).max(), rtol=0)


REFUSED = {
    "ratio and ratios": (
        lambda: bd.Scene(BEAM, damping_ratio=0.1, damping=bd.Damping([0.1])),
        "damping_ratio",
    ),
    "negative damper": (lambda: bd.Damping(tip_damper=-1.0), "damping.tip_damper"),
    "damper beside which the beam is lost to rounding": (
        lambda: bd.Scene(BEAM, damping=bd.Damping(tip_damper=1e9)),
        r"damping.tip_damper = 1e\+09 N s/m: it must be at most",
    ),
    "huge damper": (lambda: bd.Damping(tip_damper=1e300), "damping.tip_damper"),
    "huge factor": (lambda: bd.Damping(stiffness_factor=1e300), "damping.stiffness_factor"),
    "huge gravity": (lambda: bd.Scene(BEAM, gravity=1e300), "gravity"),
    "ratio of 1": (lambda: bd.Damping([0.1, 1.0]), "damping.ratios"),
    "beyond the tip": (lambda: replace(BEAM, point_springs=[bd.PointSpring(1.1, 1.0)]), "point_springs[0]"),
    "a support": (lambda: bd.Scene(sprung(1e12)), "point_springs[0].stiffness"),
    "rigid direction": (lambda: bd.Scene(sprung(1.0, "across")), "point_springs[0].direction"),
    "large deflection": (lambda: bd.Scene(sprung(1.0), physics=LARGE), "point_springs"),
    "damper, large deflection": (
        lambda: bd.Scene(BEAM, physics=LARGE, damping=bd.Damping(tip_damper=1.0)),
        "damping.tip_damper",
    ),
    "bounds of a damped beam": (
        lambda: bd.frequency_bounds(bd.Scene(BEAM, damping=bd.Damping(mass_factor=1.0))),
        "damping",
    ),
    "bounds of a sprung beam": (lambda: bd.frequency_bounds(bd.Scene(sprung(1.0))), "point_springs"),
    "strain of a material that damps": (lambda: damped_strain(), "damping.stiffness_factor"),
}
LARGE = bd.Physics(large_deflection=True)


def sprung(stiffness, direction="bending"):
    return replace(BEAM, point_springs=[bd.PointSpring(0.5, stiffness, direction)])


def damped_strain():
    beam = replace(BEAM, outer_fibre=BEAM.mass_per_length)
    scene = bd.Scene(beam, motion=bd.SteadyRotation(0.0), damping=bd.Damping(stiffness_factor=1e-3))
    return bd.simulate(scene, 0.1, modes=1, tolerance=1e-3).root_strain([0.1])


@pytest.mark.parametrize("case", REFUSED)
def test_refused_by_name(case):
    make, name = REFUSED[case]
    with pytest.raises(ValueError, match="^" + name.replace("[", r"\[")):
        make()


TEXT = """
[beam]
length = "1 m"
mass_per_length = "1 kg/m"
bending_stiffness = "1 N m2"
[[beam.point_spring]]
position = "50 cm"
stiffness = "2 N/mm"
[mount]
radius = "0 m"
[damping]
mass_factor = "0.5 1/s"
stiffness_factor = "2 ms"
tip_damper = "0.1 N s/m"
ratios = [0.01, 0.02]
"""


@pytest.mark.parametrize("curved", ["sweep", "prebend"])
@pytest.mark.parametrize("discretization", [bd.Ritz(10), bd.Fem(10)], ids=str)
def test_damping_is_of_the_modes_at_rest_of_the_curved_beam(curved, discretization):
    axis = {curved: np.polynomial.Polynomial([0.0, np.radians(200.0)])}
    beam = bd.Beam.rectangular(1.0, 0.05, 0.01, 70e9, 2700.0, poissons_ratio=0.3, **axis)
    scene = bd.Scene(beam, physics=bd.Physics(planes=2, torsion=True, large_deflection=True))
    free = bd.natural_modes(scene, 0.0, 3, discretization)
    omega = 2 * np.pi * free.frequency

    by_ratio = bd.natural_modes(replace(scene, damping_ratio=0.01), 0.0, 3, discretization).eigenvalue
    np.testing.assert_allclose(-by_ratio.real / np.abs(by_ratio), 0.01, rtol=RTOL)
    np.testing.assert_allclose(np.abs(by_ratio), omega, rtol=RTOL)
    rayleigh = bd.Damping(mass_factor=0.2, stiffness_factor=1e-5)
    found = bd.natural_modes(replace(scene, damping=rayleigh), 0.0, 3, discretization)
    # Errors of an eigenvalue are relative to its size.
    assert (np.abs(found.growth_rate + (0.2 + 1e-5 * omega**2) / 2) <= RTOL * omega).all()


def test_damping_and_springs_in_a_file():
    scene = parse_scene(TEXT.replace("2 N/mm", "2 N/m"))
    assert scene.damping == bd.Damping((0.01, 0.02), 0.5, 0.002, 0.1)
    assert scene.beam.point_springs == (bd.PointSpring(0.5, 2.0),)


def test_a_mistake_in_a_file_has_its_key():
    with pytest.raises(bd.ConfigError, match=r"beam\.point_spring\[0\]\.position"):
        parse_scene(TEXT.replace("50 cm", "150 cm"))
    with pytest.raises(bd.ConfigError, match=r"damping\.tip_damper = \"-1 N s/m\""):
        parse_scene(TEXT.replace("0.1 N s/m", "-1 N s/m"))


def test_terms_say_what_is_there():
    terms = bd.terms(bd.Scene(sprung(1.0), damping=bd.Damping(tip_damper=1.0)))
    assert {"point springs", "damping"} <= {*terms.present}
    assert not {"point springs", "damping"} & {*bd.terms(bd.Scene(BEAM)).present}
