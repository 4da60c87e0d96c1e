"""Numbers of a scene from frequencies: found, with intervals, or named as not determined."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.scene.numbers import with_numbers
from beamdyn.studies.beside_data.free_numbers import free_numbers
from benchmarks.cases.identified import OUTWARD, SPEEDS, identify, measured, unknowns

MATERIAL = {"beam.youngs_modulus": None, "beam.density": None}
MOST_SOLVES = 40  # a number


@pytest.mark.parametrize("seed", range(2))
def test_spring_thickness_and_body_are_found_without_noise(seed):
    true = unknowns(seed)
    found = identify(true)
    # Frequencies are good to 1e-11, and the numbers follow them up to a condition of some thousands.
    np.testing.assert_allclose(found.value, [*true.values()], rtol=1e-7)
    assert found.solves <= MOST_SOLVES * len(true)
    assert found.comparison.agrees or np.abs(found.comparison.deviation).max() < 1e-9


def test_scales_of_a_blade_of_many_stations_are_found():
    blade = bd.load_scene(Path(__file__).parents[2] / "examples" / "blade_of_stations.toml")
    true = {"beam.scale.bending_stiffness": 1.1, "beam.scale.second_bending_stiffness": 0.93}
    speeds = np.array([0.0, 1.9])
    frequencies = bd.frequency_locus(with_numbers(blade, true), speeds, 3).frequency
    found = bd.identify(blade, bd.MeasuredFrequencies(frequencies, speeds), dict.fromkeys(true))
    np.testing.assert_allclose(found.value, [*true.values()], rtol=1e-7)  # as above


def test_physics_that_is_chosen_automatically_is_that_of_the_fit():
    twist = Polynomial([0.0, 0.5])
    beam = bd.Beam.from_stiffness(1.02, 1.0, 100.0, second_bending_stiffness=250.0, twist=twist)
    data = bd.MeasuredFrequencies(
        bd.natural_modes(bd.Scene(beam, physics=bd.Physics(planes=2)), 0.0, 4).frequency, uncertainty=1e-3
    )
    longer = bd.Scene(replace(beam, length=1.0), physics="auto")
    assert bd.identify(longer, data, {"beam.length": (0.9, 1.1)}).value == pytest.approx([1.02], rel=1e-6)


def test_the_place_of_a_point_is_sought_on_the_beam():
    strip = bd.Beam.rectangular(0.5, 0.05, 0.004, 2e11, 7850.0, point_masses=[bd.PointMass(0.4, 0.05)])
    (place,) = free_numbers(bd.Scene(strip), {"beam.point_mass[0].position": None})
    assert place.bounds[1] == 0.5


def test_intervals_cover_the_numbers_behind_noisy_data():
    true = unknowns(4)
    found = identify(true, noise=0.005, seed=4)
    values = np.array([*true.values()])
    assert ((found.low < values) & (values < found.high)).all()
    half = (found.high - found.low)[1] / 2
    # The interval of a normal distribution, in which the thickness is nearly linear.
    np.testing.assert_allclose(half, 1.96 * np.sqrt(found.covariance[1, 1]), rtol=1e-3)
    assert found.warnings == ()


def test_intervals_shrink_with_the_uncertainty():
    true = {"beam.thickness": 0.00019}
    wide, narrow = (
        bd.identify(
            OUTWARD, replace(measured(true), uncertainty=np.full((5, 3), u)), {"beam.thickness": None}
        )
        for u in (1.0, 0.1)
    )
    np.testing.assert_allclose(  # linear about the same point
        (wide.high - wide.low) / (narrow.high - narrow.low), 10.0, rtol=1e-6
    )


@pytest.mark.parametrize("uncertainty", [np.nan, 0.3])
def test_stiffness_and_density_are_not_told_apart_by_frequencies_alone(uncertainty):
    data = replace(measured({}), uncertainty=np.full((5, 3), uncertainty))
    found = bd.identify(OUTWARD, data, MATERIAL)
    assert np.isnan([found.value, found.low, found.high]).all()
    (pair,) = found.not_separable
    assert pair.names == (*MATERIAL,)
    assert "the mass of the beam" in pair.measurements
    assert not any("speed" in each for each in pair.measurements)  # f^2 = (E/rho) a + speed^2 b
    with pytest.raises(ValueError, match=r"do not determine beam.youngs_modulus, beam.density"):
        _ = found.scene_found


def test_weighing_a_beam_tells_a_point_mass_from_the_stiffness():
    beam = bd.Beam.from_stiffness(0.05, 0.0157, 1.33e-3, point_masses=[bd.PointMass(0.03, 0.001)])
    data = bd.MeasuredFrequencies([[50.0], [50.0]], [0.0, 0.0], uncertainty=0.1)  # measured twice
    unknown = {"beam.bending_stiffness": None, "beam.point_mass[0].mass": None}
    (pair,) = bd.identify(bd.Scene(beam), data, unknown).not_separable
    assert pair.names == (*unknown,)
    assert "the mass of the beam" in pair.measurements


@pytest.mark.parametrize(
    ("names", "rows", "told"),
    [
        (("beam.thickness", "beam.youngs_modulus"), 2, False),  # h^2 E alone, at any speed
        (("beam.thickness", "beam.density"), 2, False),
        (("beam.length", "beam.youngs_modulus"), 1, False),  # E / L^4 at rest
        (("beam.length", "beam.youngs_modulus"), 2, True),  # the radius over the length, in rotation
        (("beam.width",), 2, False),
    ],
)
def test_pairs_that_make_up_for_each_other_are_named(names, rows, told):
    speeds = np.array([0.0, 150.0])[:rows]
    frequency = bd.frequency_locus(OUTWARD, speeds, 3).frequency
    data = bd.MeasuredFrequencies(frequency, speeds, uncertainty=0.05)
    found = bd.identify(OUTWARD, data, dict.fromkeys(names))
    assert np.isfinite(found.value).tolist() == [told] * len(names)
    assert [pair.names for pair in found.not_separable] == ([] if told else [names])


def test_a_known_body_tells_stiffness_and_density_apart():
    body = with_numbers(OUTWARD, {"beam.tip.mass": 4e-4})
    frequency = bd.frequency_locus(body, SPEEDS, 3).frequency
    found = bd.identify(body, bd.MeasuredFrequencies(frequency, SPEEDS), MATERIAL)
    np.testing.assert_allclose(found.value, [200e9, 7850.0], rtol=1e-7)  # as above
    assert found.not_separable == ()


def test_a_number_that_frequencies_do_not_hang_on_is_not_told():
    strip = bd.Scene(OUTWARD.beam, bd.Mount(radius=0.215))
    data = bd.MeasuredFrequencies([65.2, 408.8], uncertainty=0.1)  # at rest: the radius has no effect
    found = bd.identify(strip, data, {"mount.radius": None})
    assert np.isnan(found.value[0])
    assert found.not_separable[0].names == ("mount.radius",)
    assert "the first frequency at a higher speed" in found.not_separable[0].measurements


def test_an_outlier_is_named_and_kept():
    frequency = measured({}).frequency.copy()
    frequency[2, 1] *= 1.05
    for uncertainty in (np.nan, 0.3):
        data = bd.MeasuredFrequencies(frequency, SPEEDS, uncertainty)
        found = bd.identify(OUTWARD, data, {"beam.thickness": None})
        (said,) = found.outliers
        assert said.startswith("frequency 2 at 75 rad/s")
        assert np.isfinite(found.standardized).sum() == 15
        assert found.value[0] > 0.0002  # it pulls


def test_starts_that_are_no_scene_are_passed_over():
    """A thickness beyond the width is none; nobody gave it."""
    block = bd.Beam.rectangular(0.3, 0.05, 0.04, 70e9, 2700.0)
    thicker = with_numbers(bd.Scene(block), {"beam.thickness": 0.044})
    data = bd.MeasuredFrequencies(bd.natural_modes(thicker, modes=2).frequency, uncertainty=1e-3)
    found = bd.identify(bd.Scene(block), data, {"beam.thickness": None})
    np.testing.assert_allclose(found.value, 0.044, rtol=1e-6)


def test_a_clamped_root_stays_clamped():
    data = bd.MeasuredFrequencies([65.23, 408.79, 1144.63], uncertainty=0.05)
    found = bd.identify(bd.Scene(OUTWARD.beam), data, {"mount.root_stiffness": None})
    assert found.high[0] == np.inf
    assert found.low[0] > 10  # N m/rad, 400 times the stiffness of the beam over its length


@pytest.mark.parametrize(
    ("free", "said"),
    [
        ({}, "give the numbers that are unknown"),
        ({"beam.thicknes": None}, "give beam.thickness"),
        ({"beam.thickness": (2e-4, 1e-4)}, "bounds ascend"),
        ({"beam.thickness": 3}, "least and a largest"),
        ({"beam.thickness": None, "beam.length": None, "mount.radius": None}, "3 unknowns for 2 frequencies"),
        ({"mount.root_stiffness": (0.0, 1.0)}, "greater than 0"),
    ],
)
def test_questions_that_have_no_answer_are_refused(free, said):
    with pytest.raises(ValueError, match=said):
        bd.identify(OUTWARD, bd.MeasuredFrequencies([62.0, 389.0]), free)


def test_large_deflection_is_refused():
    bent = replace(OUTWARD, physics=bd.Physics(large_deflection=True))
    with pytest.raises(ValueError, match="computed for linear equations only"):
        bd.identify(bent, bd.MeasuredFrequencies([62.0]), {"beam.thickness": None})


def test_as_many_unknowns_as_data_have_no_interval_without_uncertainties():
    found = bd.identify(bd.Scene(OUTWARD.beam), bd.MeasuredFrequencies([62.0]), {"beam.thickness": None})
    assert np.isfinite(found.value[0])
    assert np.isnan(found.low[0])
    assert "no interval follows" in found.warnings[0]


def test_data_that_no_mode_meets_are_refused():
    data = bd.MeasuredFrequencies([6.2e6])
    with pytest.raises(ValueError, match=r"free = 'beam.thickness': only 0 of 1 frequencies are near modes"):
        bd.identify(
            bd.Scene(bd.Beam.rectangular(0.05, 0.01, 2e-4, 200e9, 7850.0)),
            data,
            free={"beam.thickness": None},
        )


@pytest.mark.parametrize("free", [{"beam.thickness": (1e-4, 5e-3)}, {"mount.root_stiffness": None}])
def test_data_in_another_unit_are_named_whether_or_not_a_number_makes_up_for_it(free):
    exact = bd.natural_modes(bd.Scene(OUTWARD.beam), 0.0, 3).frequency
    for factor, said in ((2 * np.pi, ["they may be in rad/s, and read as Hz"]), (1.0, [])):
        found = bd.identify(bd.Scene(OUTWARD.beam), bd.MeasuredFrequencies(0.96 * factor * exact), free)
        doubts = [each for each in found.warnings if "all measured" in each]
        assert [each.partition(": ")[2].partition(";")[0] for each in doubts] == said


def test_a_beam_that_bends_far_is_compared_without_explanations():
    scene = bd.Scene(
        bd.Beam.rectangular(0.05, 0.01, 2e-4, 200e9, 7850.0), physics=bd.Physics(large_deflection=True)
    )
    found = bd.compare(scene, bd.MeasuredFrequencies([50.0], uncertainty=0.1))
    assert found.verdict == ("outside",) and found.explanations == ()


def test_one_frequency_is_counted_in_the_singular():
    one = bd.MeasuredFrequencies(speeds=[0.0], frequency=[[10.0]])
    free = dict.fromkeys(("beam.thickness", "beam.width"))
    with pytest.raises(ValueError, match="there are 2 unknowns for 1 frequency; free fewer"):
        bd.identify(bd.Scene(bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)), one, free=free)
