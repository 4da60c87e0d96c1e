"""Blades of BeamDyn as scenes: axes, centres, the reference line, and refusals that name line and station."""

from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.scene.section_matrices import split_mass
from tests.unit import beamdyn_written as written


@pytest.fixture
def turbine(tmp_path):
    return written.write_turbine(tmp_path)


def read(turbine):
    return bd.read_deck(turbine.with_name("primary.dat"), hub_radius=1.5)


def test_sections_have_the_axes_of_this_package(turbine):
    """1 = z, 2 = -x, 3 = -y: flap is bending in direction 2."""
    beam = read(turbine).scene.beam
    assert beam.matrices is not None
    root = np.zeros(1)
    K, (m, centre, inertia) = (
        beam.matrices.at("stiffness", root)[..., 0],
        split_mass(beam.matrices.at("mass", root)),
    )
    (x, y), (cx, cy) = written.TENSION, written.CENTRE
    np.testing.assert_allclose(K[0, [4, 5]] / K[0, 0], [-y, x], rtol=1e-12)  # t3, -t2
    np.testing.assert_allclose(np.diag(K)[:4], [written.AXIAL, *written.SHEAR, written.TORSION], rtol=1e-12)
    np.testing.assert_allclose(K[5, 5], written.FLAP + written.AXIAL * x**2, rtol=1e-12)
    np.testing.assert_allclose([m[0], *centre[:, 0]], [written.MASS, 0.0, -cx, -cy], rtol=1e-12)
    about_x, about_y = written.INERTIA
    np.testing.assert_allclose(np.diag(inertia[..., 0]), [about_x + about_y, about_x, about_y], rtol=1e-9)
    np.testing.assert_allclose(inertia[1, 2, 0], 0.0, atol=1e-9)


def test_the_reference_line_goes_through_the_key_points(turbine):
    scene = read(turbine).scene
    found = bd.equilibrium(scene, 0.0, discretization=bd.Ritz(3))
    x, y, z, _ = written.POINTS[-1]
    np.testing.assert_allclose(found.tip, [z, y, -x], atol=2e-3 * z)  # angles are linear between stations
    assert scene.beam.length > np.hypot(np.hypot(x, y), z)
    np.testing.assert_allclose(np.degrees(scene.beam.root_twist), -written.POINTS[0][3], rtol=1e-9)


def test_a_turbine_says_hub_speed_pitch_and_cone(turbine):
    deck = bd.read_deck(turbine)
    assert len(deck.sources) == 4
    np.testing.assert_allclose(deck.scene.mount.radius, 1.25)
    np.testing.assert_allclose(np.degrees(deck.scene.mount.bending_angle), 86.0)
    assert deck.scene.physics.large_deflection
    # ElastoDyn sets its tip masses to 0 where BeamDyn computes the blades (its source, ED_Init).
    assert deck.scene.beam.tip is None
    assert [entry.name for entry in deck.ignored] == ["mu1 to mu6", "TipMass(1)"]


def test_a_blade_of_matrices_moves_about_its_equilibrium(turbine):
    scene = replace(read(turbine).scene, motion=bd.SteadyRotation(2.0), damping_ratio=0.0, gravity=0.0)
    basis = bd.Ritz(6, "moments")
    run = bd.simulate(scene, 0.2, modes=3, initial="equilibrium", discretization=basis)
    found, at_rest = (bd.equilibrium(scene, speed, discretization=basis).tip for speed in (2.0, 0.0))
    tips = np.hypot(run.tip, run.tip_across)
    np.testing.assert_allclose(tips, np.linalg.norm((found - at_rest)[1:]), rtol=0.05)  # of three modes
    assert "offsets of sections" not in [effect.name for effect in bd.terms(scene).left_out]


def test_the_scene_in_its_file_is_that_of_the_deck(turbine):
    deck, path = bd.read_deck(turbine), turbine.with_name("scene.toml")
    deck.write_scene(path)
    assert bd.load_scene(path) == deck.scene


def soft(factor=1.0):
    K = written.stiffness(factor)
    K[3, 4] = K[4, 3] = 1.1 * np.sqrt(K[3, 3] * K[4, 4]) if factor < 0.2 else 0.0
    return K


def lopsided(factor=1.0):
    M = written.mass(factor)
    M[0, 5] *= 1.5
    return M


def odd(factor=1.0):
    M = written.mass(factor)
    M[0, 0] *= 1.1
    return M


def polar(factor=1.0):
    """Return a mass whose inertia about z is not the sum of the others, as of no flat section."""
    M = written.mass(factor)
    M[5, 5] *= 1.01
    return M


def weightless(factor=1.0):
    return written.mass(factor) * (factor > 0.2)


REFUSED = [
    ({"blade_dat": written.blade_file(of_mass=weightless)}, r"line 41: the mass .* eta = 1: .*definite"),
    (
        {"primary_dat": written.primary_file(kp_total=10**12)},
        r"line 13: expected .*coordinates of a key point",
    ),
    ({"primary_dat": written.primary_file(members=("1 3.5",))}, r"line 6: expected at least 3 .* found 3.5"),
    (
        {"blade_dat": written.blade_file(soft)},
        r"line 41: the stiffness of the section at eta = 1: .*definite",
    ),
    ({"blade_dat": written.blade_file(of_mass=lopsided)}, r"line 11: the mass .*eta = 0: .*symmetric"),
    ({"blade_dat": written.blade_file(of_mass=odd)}, r"line 11: the mass .*eta = 0: .*m on the diagonal"),
    ({"blade_dat": written.blade_file(of_mass=polar)}, r"line 11: the mass .*eta = 0: .*inertia about z"),
    ({"blade_dat": written.blade_file(count=4)}, r"expected 4 stations of 13 lines"),
    (
        {"primary_dat": written.primary_file(((1, 0, 0, 0), *written.POINTS[1:]))},
        r"line 9: .*0 0 0, the root",
    ),
    (
        {"primary_dat": written.primary_file((*written.POINTS[:3], (0, 0, 15, 0)))},
        r"line 12: the reference line turns back on itself at key point 3",
    ),
    (
        {"primary_dat": written.primary_file(members=("1 3",))},
        r"the members have 3 key points, but kp_total .* 4",
    ),
    ({"primary_dat": written.primary_file(members=("1 5",))}, r"line 6: expected at least 3 key points"),
]


@pytest.mark.parametrize(("files", "said"), REFUSED)
def test_what_is_wrong_is_refused_with_its_line(tmp_path, files, said):
    turbine = written.write_turbine(tmp_path, **files)
    with pytest.raises(bd.ConfigError, match=said):
        bd.read_deck(turbine)


def test_an_axis_that_turns_back_on_itself_is_refused():
    kinked = bd.Table([0.0, 0.5, 0.5, 1.0], [0.0, 0.0, 2.0, 2.0])
    with pytest.raises(ValueError, match=r"turns by 2 rad at x/L = 0.5: the axis turns back on itself"):
        bd.Beam.from_stiffness(1.0, 1.0, 1.0, sweep=kinked)


@pytest.mark.parametrize("physics", [bd.Physics(), bd.Physics(2, torsion=True)])
def test_effects_that_matrices_couple_are_all_modelled(turbine, physics):
    beam = read(turbine).scene.beam
    with pytest.raises(
        ValueError, match=r"physics.(planes = 1|shear = False): the 6 x 6 matrices .*large_deflection=True"
    ):
        bd.Scene(beam, physics=physics)


def test_properties_beside_matrices_are_refused(turbine):
    beam = read(turbine).scene.beam
    with pytest.raises(ValueError, match=r"mass_per_length = Profile.*: differs from that of the 6 x 6 sec"):
        replace(beam, mass_per_length=beam.mass_per_length.scaled(2.0))


def test_both_sides_of_a_jump_of_matrices_count():
    """The section on the left of a station that is given twice is checked, and its inertia kept."""
    K, M = np.diag([1e9, 1e8, 1e8, 1e6, 4e6, 1e6]), np.diag([100.0, 100.0, 100.0, 3.0, 1.0, 2.0])
    stations, soft = [0.0, 0.5, 0.5, 1.0], K.copy()
    soft[0, 5] = soft[5, 0] = 8e7
    with pytest.raises(ValueError, match=r"matrices.stiffness = .* at x/L = 0.5: .*above 1e-10.*; check K"):
        bd.SectionMatrices.at_stations(stations, [K, soft, K, K], [M] * 4)
    found = bd.SectionMatrices.at_stations(stations, [K] * 4, [M, M, 4 * M, 4 * M]).properties
    np.testing.assert_allclose(found["rotary_inertia"](np.array([0.0, 0.49, 0.51, 1.0])), [2, 2, 8, 8])


def test_members_that_meet_at_a_kink(tmp_path):
    """Splines are natural at the ends of members: a straight member and a bent one meet at an angle."""
    points = ((0, 0, 0, 0), (0, 0, 5, 0), (0, 0, 10, 0), (0.5, 0, 15, 0), (2, 0, 20, 0))
    primary = written.primary_file(points, members=("1 3", "2 3"))
    deck = read(written.write_turbine(tmp_path, primary_dat=primary))
    prebend, kink = deck.scene.beam.prebend, 10 / deck.scene.beam.length
    assert prebend is not None
    slope = -np.degrees(
        np.arctan(0.05)
    )  # at the end of the natural spline through 0, 0.5 and 2 at 0, 5 and 10
    np.testing.assert_allclose(
        np.degrees(prebend(np.array([kink - 1e-6, kink + 1e-6]))), [0.0, slope], atol=0.3
    )
    assert len(deck.blade.stations) < 40
