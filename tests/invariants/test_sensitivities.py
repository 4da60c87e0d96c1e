"""Derivatives by the numbers of a scene: closed forms, differences, other methods, and what has none."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.common.results.statements import unannounced
from beamdyn.scene.numbers import with_numbers
from benchmarks.cases.reference.many_digits.differences import frequency_derivatives
from benchmarks.cases.reference.of_scene import exact_critical_speed
from benchmarks.cases.reference.of_two_planes import derivatives_by_collocation
from benchmarks.sensitivities import at_its_size, measure

BEAM = {"length": 0.05, "width": 0.01, "thickness": 2e-4, "youngs_modulus": 2e11, "density": 7850.0}
TIPPED = bd.Beam.rectangular(**BEAM, tip=bd.TipMass(1e-4, 1e-3, 1e-9))
OBLIQUE = bd.Scene(TIPPED, bd.Mount(0.215, 0.7, 0.3))
STRIP = bd.Beam.rectangular(0.6, 0.06, 0.012, 210e9, 7850.0, poissons_ratio=0.3, twist=0.4)
TWISTED = bd.Scene(
    STRIP,
    bd.Mount(0.5, math.pi, 0.3, root_stiffness=5e4),
    physics=bd.Physics(planes=2, shear=True, rotary_inertia=True),
)
STATIONS = bd.load_scene(Path(__file__).parents[2] / "examples" / "blade_of_stations.toml")
WHEEL = bd.RollingWheel(0.3, bd.SpinUp(55.0, 10.0), bd.RoadWave(0.3, 0.01))


def test_exponents_of_a_uniform_beam_at_rest():
    """The frequency is c h / L^2 (E / rho)^(1/2), whatever the width, radius and angles."""
    found = bd.frequency_sensitivities(bd.Scene(bd.Beam.rectangular(**BEAM), bd.Mount(0.2, 0.3)), 0.0, 4)
    exponents = {"length": -2.0, "width": 0.0, "thickness": 1.0, "youngs_modulus": 0.5, "density": -0.5}
    names = [each.name for each in found.inputs]
    for name, exponent in exponents.items():
        row = found.relative[names.index(f"beam.{name}")]
        np.testing.assert_allclose(row, exponent, rtol=0, atol=1e-11)  # rounding of integrals, some 1e-12
    for name in ("mount.radius", "mount.setting_angle", "mount.bending_angle", "speed"):
        assert np.abs(found.by(name) / found.value).max() < 1e-10


def test_dimensions_add_up():
    """Scaling all lengths, masses or times scales frequencies (Buckingham), at speed, with a tip body."""
    found = bd.frequency_sensitivities(OBLIQUE, 50.0)
    powers = {"m": (1, 0, 0), "m2": (2, 0, 0), "Pa": (-1, 1, -2), "kg/m3": (-3, 1, 0), "kg": (0, 1, 0)}
    powers |= {"kg m2": (2, 1, 0), "rad": (0, 0, 0), "rad/s": (0, 0, -1), "": (0, 0, 0)}
    table = np.array([powers[each.unit] for each in found.inputs])
    np.testing.assert_allclose(table.T @ found.relative, np.outer([0, 0, -1], np.ones(3)), rtol=0, atol=1e-10)


@pytest.mark.parametrize("name", ["beam.length", "beam.tip.mass", "mount.setting_angle"])
def test_derivatives_are_those_of_40_digit_frequencies(name):
    found = bd.frequency_sensitivities(OBLIQUE, 50.0, 3, [name])
    (number,) = found.inputs
    _, (reference,), (doubt,) = frequency_derivatives(OBLIQUE, 50.0, 3, [at_its_size(number)])
    assert (np.abs(found.by(name) - reference) <= found.error[0] + doubt).all()
    np.testing.assert_allclose(found.by(name), reference, rtol=1e-9)  # the digits that frequencies promise


@pytest.mark.parametrize("name", ["beam.twist", "beam.poissons_ratio", "mount.root_stiffness"])
def test_derivatives_in_two_planes_are_those_of_collocation(name):
    found = bd.frequency_sensitivities(TWISTED, 40.0, 3, [name])
    ((reference, doubt),) = derivatives_by_collocation(TWISTED, 40.0, found.inputs)
    assert (np.abs(found.by(name) - reference) <= found.error[0] + doubt).all()
    np.testing.assert_allclose(found.by(name), reference, rtol=1e-8)  # collocation is good to 1e-10 over 0.01


def differences(scene, number, solve):
    """Of fourth order, over a tenth of the steps at which the equations are evaluated."""
    h = number.step / 10
    rows = [solve(with_numbers(scene, {number.name: number.value + k * h})) for k in (-2, -1, 1, 2)]
    return (rows[0] - 8 * rows[1] + 8 * rows[2] - rows[3]) / (12 * h)


@pytest.mark.parametrize("damping", [0.0, 0.05])
@pytest.mark.parametrize("name", ["beam.thickness", "mount.precone", "mount.radius"])
def test_gyroscopic_and_damped_modes(name, damping):
    mount = bd.Mount(0.5, math.pi, 0.3, precone=0.2)
    scene = bd.Scene(STRIP, mount, damping_ratio=damping, physics=bd.Physics(planes=2))
    found = bd.frequency_sensitivities(scene, 60.0, 3, [name])
    basis = found.provenance.method
    assert "Ritz" in basis
    reference = differences(scene, found.inputs[0], lambda s: bd.natural_modes(s, 60.0, 3).frequency)
    # of the differences: 1e-3 to the fourth power, and 1e-12 of a frequency over a thousandth of the number
    np.testing.assert_allclose(found.by(name), reference, rtol=1e-7)


@pytest.mark.parametrize("name", ["mass_per_length", "bending_stiffness", "second_bending_stiffness"])
def test_scales_of_a_blade_of_many_stations(name):
    """Its functions are defined by bending moments, which depend on every property of the blade."""
    found = bd.frequency_sensitivities(STATIONS, 1.9, 3, [f"beam.scale.{name}"])
    assert "bending moments" in found.provenance.method
    reference = differences(STATIONS, found.inputs[0], lambda s: bd.natural_modes(s, 1.9, 3).frequency)
    np.testing.assert_allclose(found.derivative[0], reference, rtol=0, atol=1e-7)  # of the differences
    assert (found.error < 1e-7).all()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["length", "point_mass[0].position", "point_spring[0].position"])
def test_places_of_points_on_a_blade_of_many_stations(name):
    """Relative to the length, they move: the same functions are integrated over other cells."""
    points = {"point_masses": [bd.PointMass(22.0, 500.0)], "point_springs": [bd.PointSpring(30.0, 2e3)]}
    scene = replace(STATIONS, beam=replace(STATIONS.beam, **points))
    found = bd.frequency_sensitivities(scene, 1.9, 3, [f"beam.{name}"])
    assert "bending moments" in found.provenance.method
    reference = differences(scene, found.inputs[0], lambda s: bd.natural_modes(s, 1.9, 3).frequency)
    np.testing.assert_allclose(found.derivative[0], reference, rtol=0, atol=1e-7)  # of the differences
    assert (found.error < 1e-7).all()


def test_speed():
    found = bd.frequency_sensitivities(TWISTED, 40.0, 3, ["speed"])
    rows = [bd.natural_modes(TWISTED, 40.0 + k * 0.1, 3).frequency for k in (-2, -1, 1, 2)]
    reference = (rows[0] - 8 * rows[1] + 8 * rows[2] - rows[3]) / 1.2
    np.testing.assert_allclose(found.by("speed"), reference, rtol=1e-8)  # of the differences


def test_critical_speed_is_that_of_power_series():
    scene = bd.Scene(TIPPED, bd.Mount(0.215))
    found = bd.critical_speed_sensitivities(scene, ["beam.thickness", "mount.radius"])
    for number, derivative, error in zip(found.inputs, found.derivative, found.error, strict=True):
        reference = differences(scene, number, lambda s: np.array([float(exact_critical_speed(s))]))
        # 16 digits of the speed over a thousandth of the number, and the fourth power of that
        np.testing.assert_allclose(derivative, reference, rtol=1e-9)
        assert error[0] < 1e-9 * abs(derivative[0])


def test_damping_changes_no_sensitivity_of_a_critical_speed():
    """Rounding errors of modal damping took half of the digits, and most of the time of large models."""
    beam = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, poissons_ratio=0.3)
    scene = bd.Scene(beam, bd.Mount(0.215), physics=bd.Physics(planes=2, shear=True))
    names = ["beam.thickness", "beam.poissons_ratio", "mount.radius"]
    damping = bd.Damping((0.01, 0.02), mass_factor=0.1, stiffness_factor=1e-6, tip_damper=1e-3)
    plain = bd.critical_speed_sensitivities(scene, names)
    damped = bd.critical_speed_sensitivities(replace(scene, damping=damping), [*names, "damping.ratios[0]"])
    np.testing.assert_array_equal(damped.derivative[:3], plain.derivative)
    np.testing.assert_array_equal(damped.error[:3], plain.error)
    assert abs(damped.derivative[3]) <= damped.error[3] < 1e-6  # rad/s per 1, of 160 rad/s


def test_a_hinge_with_gyroscopic_terms_and_damping():
    beam = bd.Beam.from_stiffness(1.0, 1.0, 1.0, second_bending_stiffness=3.0)
    mount = bd.Mount(0.2, np.pi, 0.3, root_stiffness=0.0, precone=0.1)
    scene = bd.Scene(beam, mount, physics=bd.Physics(planes=2), damping=bd.Damping(tip_damper=0.1))
    found = bd.frequency_sensitivities(scene, 5.0, 3, ["mount.radius"])
    reference = differences(scene, found.inputs[0], lambda s: bd.natural_modes(s, 5.0, 3).frequency)
    np.testing.assert_allclose(found.derivative[0], reference, rtol=1e-6)  # of differences


def test_crossings():
    scene = bd.Scene(bd.Beam.rectangular(**BEAM), bd.Mount(0.215), WHEEL, gravity=9.81)
    found = bd.crossing_sensitivities(scene, 150.0, 2, ["beam.length", "mount.radius"])
    assert len(found.answers) >= 4 and any("parametric" in each for each in found.answers)

    def speeds(s):
        return np.array([c.speed for c in bd.resonance_speeds(s, 150.0, 2)])

    for number in found.inputs:
        np.testing.assert_allclose(found.by(number.name), differences(scene, number, speeds), rtol=1e-7)


@pytest.mark.parametrize("functions", [5, 7, 9])
def test_stated_errors_of_coarse_bases_cover(functions):
    fine = bd.frequency_sensitivities(OBLIQUE, 50.0)
    coarse = bd.frequency_sensitivities(OBLIQUE, 50.0, discretization=bd.Ritz(functions))
    apart = np.abs(fine.derivative - coarse.derivative)
    assert (apart <= coarse.error + fine.error).all()
    assert apart.max() > 1e-9 * np.abs(fine.derivative).max()  # else it shows nothing


@pytest.mark.slow
def test_elements_agree():
    ritz, fem = (
        bd.frequency_sensitivities(OBLIQUE, 50.0, 2, discretization=name) for name in ("ritz", "fem")
    )
    assert (np.abs(fem.derivative - ritz.derivative) <= fem.error + ritz.error).all()
    largest = np.abs(ritz.relative).max(axis=1) > 0.01
    assert largest.sum() >= 7
    np.testing.assert_allclose(fem.relative[largest], ritz.relative[largest], rtol=0, atol=1e-6)


def test_the_derivative_by_speed_of_elements_keeps_its_digits():
    """Stiffnesses of small elements cancel in that of the beam: not every error is magnified by that."""
    ritz = bd.frequency_sensitivities(OBLIQUE, 50.0, 2, ["speed"])
    fem = bd.frequency_sensitivities(OBLIQUE, 50.0, 2, ["speed"], discretization=bd.Fem(32))
    assert (np.abs(fem.derivative - ritz.derivative) <= fem.error + ritz.error).all()
    assert (fem.error < 1e-3 * np.abs(ritz.derivative)).all()


@pytest.mark.slow
def test_the_length_of_a_blade_of_many_stations_has_a_derivative_by_elements():
    """Nearby lengths may have meshes of another size: smaller steps do not."""
    rng = np.random.default_rng(0)
    stations = np.sort(np.r_[0.0, 1.0, rng.uniform(0.02, 0.98, 28)])
    mass, stiffness = (
        bd.Table(stations, first * 100.0**-power) for first, power in ((100, stations / 2), (1e6, stations))
    )
    scene = bd.Scene(bd.Beam.from_stiffness(10.0, mass, stiffness, point_masses=[bd.PointMass(6.0, 30.0)]))
    ritz, fem = (
        bd.frequency_sensitivities(scene, 0.0, 2, ["beam.length"], discretization=name)
        for name in ("ritz", "fem")
    )
    assert (np.abs(fem.derivative - ritz.derivative) <= fem.error + ritz.error).all()


# Near the critical speed; a damper, a mass, a spring; nearer; a stiff spring and a soft hinge, over whose
# places and stiffness 1 % of the length is a long step.
@pytest.mark.parametrize(
    "seed", [10, 11, 46, pytest.param(149, marks=pytest.mark.slow), pytest.param(171, marks=pytest.mark.slow)]
)
def test_random_scenes(seed):
    (case,) = measure(seed)
    assert max(case.errors) < 1e-8
    assert (np.array(case.errors) <= case.stated).all()


# What has no derivative ---------------------------------------------------------------------------


def test_modes_that_cross_have_none():
    square = bd.Beam.rectangular(1.0, 0.01, 0.01, 2e11, 7850.0)
    scene = bd.Scene(square, bd.Mount(), physics=bd.Physics(planes=2))
    found = bd.frequency_sensitivities(scene, 0.0, 2)
    assert np.isnan(found.derivative).all() and np.isinf(found.error).all()
    assert any("crossing" in each for each in found.warnings)


def test_a_tapered_strip_with_layers_has_those_of_its_section():
    """Its properties follow from the section and take no factors; both densities scale all of the mass."""
    strip = bd.Beam.rectangular(0.05, 0.01, bd.Table([0, 0.8, 1], [2e-4, 2e-4, 1e-4]), 200e9, 7850.0)
    layers = bd.Harvester(1.5e-4, 7750.0, d31=-171e-12, s11e=1 / 61e9, eps33t=15.33e-9, end=0.03)
    found = bd.frequency_sensitivities(bd.Scene(layers.on(strip), bd.Mount(0.2)))
    both = 7850.0 * found.by("beam.density") + 7750.0 * found.by("harvester.density")
    np.testing.assert_allclose(both / found.value, -0.5, rtol=1e-9)
    assert np.isfinite(found.by("beam.scale.thickness")).all()
    assert "beam.scale.mass_per_length" not in [each.name for each in found.inputs]


def test_a_number_that_cannot_change_alone_has_none():
    body = bd.TipMass(
        0.1, 0.0, 1e-4, 1e-4, 0.0
    )  # slender along the beam: neither moment may grow or shrink alone
    scene = bd.Scene(bd.Beam.rectangular(1.0, 0.05, 0.01, 2e11, 7850.0, tip=body), bd.Mount(0.5))
    found = bd.frequency_sensitivities(scene, 5.0)
    assert np.isnan(found.by("beam.tip.inertia")).all()
    assert np.isfinite(found.by("beam.tip.mass")).all()
    assert any("beam.tip.inertia cannot change alone" in each for each in found.warnings)


def test_a_mode_that_diverges_has_none():
    scene = bd.Scene(bd.Beam.rectangular(**BEAM), bd.Mount(0.215))
    with unannounced():
        found = bd.frequency_sensitivities(scene, 200.0, 2)
    assert np.isnan(found.derivative[:, 0]).all() and np.isfinite(found.derivative[:, 1]).all()
    assert any("without vibration" in each for each in found.warnings)


def test_a_hinge_may_become_a_spring():
    scene = bd.Scene(bd.Beam.rectangular(**BEAM), bd.Mount(0.2, math.pi, root_stiffness=0.0))
    found = bd.frequency_sensitivities(scene, 20.0, 3, ["mount.root_stiffness"])
    size = 1e-3 * found.inputs[0].step
    softest = bd.natural_modes(with_numbers(scene, {"mount.root_stiffness": size}), 20.0, 3)
    change = (softest.frequency - found.value) / size
    np.testing.assert_allclose(found.derivative[0], change, rtol=1e-4)  # a difference to one side


def test_no_crossing_has_no_derivative():
    still = bd.Scene(bd.Beam.rectangular(**BEAM), bd.Mount(0.2), bd.SteadyRotation(20.0))
    found = bd.crossing_sensitivities(still, 60.0)
    assert found.derivative.shape == (len(found.inputs), 0) == found.error.shape


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: bd.frequency_sensitivities(OBLIQUE, inputs=["beam.thicknes"]), "beam.thickness"),
        (lambda: bd.frequency_sensitivities(OBLIQUE, inputs="beam.length"), "in a list"),
        (
            lambda: bd.critical_speed_sensitivities(bd.Scene(TIPPED, bd.Mount(0.2, math.pi))),
            "no critical speed",
        ),
        (
            lambda: bd.frequency_sensitivities(
                bd.Scene(TIPPED, bd.Mount(0.2, math.pi), physics=bd.Physics(large_deflection=True))
            ),
            "large_deflection",
        ),
    ],
)
def test_refusals(call, said):
    with pytest.raises(ValueError, match=said):
        call()


# The result ---------------------------------------------------------------------------------------


def test_result_is_saved_drawn_and_read(tmp_path):
    found = bd.frequency_sensitivities(OBLIQUE, 50.0, 2, ["beam.thickness", "speed"])
    found.save(tmp_path / "s.json")
    again = bd.load(tmp_path / "s.json")
    np.testing.assert_array_equal(again.derivative, found.derivative)
    assert [text.get_text() for text in found.plot().get_yticklabels()] == ["speed", "thickness"]
    with pytest.raises(ValueError, match=r"beam\.thickness, speed"):
        found.by("mount.radius")


# Points and damping -------------------------------------------------------------------------------

POINTED = bd.Scene(
    bd.Beam.rectangular(
        **BEAM,
        point_masses=[bd.PointMass(0.02, 2e-4), bd.PointMass(0.035, 1e-4)],
        point_springs=[bd.PointSpring(0.03, 40.0)],
    ),
    bd.Mount(0.215, math.pi, 0.3),
)  # fmt: skip
DAMPED = {
    "damping.ratios[0]": bd.Damping(ratios=[0.2, 0.1]),
    "damping.ratios[1]": bd.Damping(ratios=[0.2, 0.1]),
    "damping.mass_factor": bd.Damping(mass_factor=100.0),
    "damping.stiffness_factor": bd.Damping(stiffness_factor=1e-4),
    "damping.tip_damper": bd.Damping(tip_damper=0.05),
}
OF_POINTS = (
    "point_mass[0].mass",
    "point_mass[1].position",
    "point_spring[0].stiffness",
    "point_spring[0].position",
)


@pytest.mark.parametrize("name", [f"beam.{each}" for each in OF_POINTS])
def test_point_masses_and_springs(name):
    found = bd.frequency_sensitivities(POINTED, 50.0, 3, [name])
    reference = differences(POINTED, found.inputs[0], lambda s: bd.natural_modes(s, 50.0, 3).frequency)
    np.testing.assert_allclose(
        found.by(name), reference, atol=1e-6 * np.abs(reference).max()
    )  # of differences
    assert np.abs(found.by(name)).max() > 0


@pytest.mark.parametrize("name", DAMPED)
def test_all_kinds_of_damping(name):
    scene = bd.Scene(POINTED.beam, POINTED.mount, damping=DAMPED[name])
    found = bd.frequency_sensitivities(scene, 50.0, 2, [name])
    reference = differences(scene, found.inputs[0], lambda s: bd.natural_modes(s, 50.0, 2).frequency)
    np.testing.assert_allclose(found.by(name), reference, atol=1e-6 * np.abs(reference).max())
    assert np.abs(reference).max() > 0


def test_a_point_mass_at_the_tip_is_a_tip_body():
    masses = [bd.Beam.rectangular(**BEAM, tip=bd.TipMass(2e-4)),
              bd.Beam.rectangular(**BEAM, point_masses=[bd.PointMass(0.05, 2e-4)])]  # fmt: skip
    tip, point = (bd.frequency_sensitivities(bd.Scene(beam, bd.Mount(0.2, 2.0)), 50.0) for beam in masses)
    np.testing.assert_allclose(point.by("beam.point_mass[0].mass"), tip.by("beam.tip.mass"), rtol=1e-9)
    assert "beam.point_mass[0].position" not in [each.name for each in point.inputs]
    assert np.isnan(point.by("beam.length")).all()  # the mass would stand beyond the tip, or before it
    assert any("beam.length cannot change alone" in said for said in point.warnings)
