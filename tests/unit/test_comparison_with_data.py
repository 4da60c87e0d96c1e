"""Measured frequencies beside a scene: pairs, verdicts, and the numbers that would explain them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.common.edge.file_words import in_files
from beamdyn.scene.numbers import with_numbers
from beamdyn.studies.beside_data.pairing import NO_MODE, pair
from beamdyn.studies.beside_data.single_numbers import say_value

STRIP = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, poissons_ratio=0.3)
SCENE = bd.Scene(STRIP, bd.Mount(radius=0.215))
EXACT = [65.2304564374, 408.7922925, 1144.630256]


def test_pairs_are_those_of_least_total_distance():
    computed = np.array([13.6, 34.0, 59.5, 91.8, 130.8, 178.0])
    # A torsional mode between the bending modes has no partner; what follows it keeps its own.
    np.testing.assert_array_equal(pair(np.array([95.4, 106.6, 132.7]), computed), [3, NO_MODE, 4])
    # A mode that was not found shifts none, and the order in a row is free.
    np.testing.assert_array_equal(pair(np.array([62.9, np.nan, 14.8]), computed), [2, NO_MODE, 0])
    # The lowest may be far off: nothing lies below it.
    np.testing.assert_array_equal(pair(np.array([6.0, 33.0]), computed), [0, 1])


def test_shapes_tell_modes_of_one_frequency():
    likeness = np.array([[0.1, 0.99], [0.98, 0.05]])
    np.testing.assert_array_equal(pair(np.array([50.0, 50.1]), np.array([50.0, 50.05]), likeness), [1, 0])


def test_shapes_at_points_are_compared_by_the_modal_assurance_criterion():
    x = np.linspace(0.01, 0.05, 5)
    shapes = bd.natural_modes(SCENE, 0.0, 2).shape(x)
    data = bd.MeasuredFrequencies([408.0, 65.0], positions=x, shapes=-3 * shapes[::-1])
    found = bd.compare(SCENE, data)
    assert found.mode.tolist() == [2, 1]
    np.testing.assert_allclose(found.likeness, 1.0, rtol=1e-9)  # rounding of a quotient of sums


def test_verdicts_ask_the_data_first_then_the_model():
    # 1.3 % is what a beam without camber leaves out of the first frequency of the strip.
    shares = np.array([1 + 1e-6, 1.01, 1.05])
    data = bd.MeasuredFrequencies((shares * EXACT).tolist(), rounding=0.005)
    found = bd.compare(SCENE, data)
    assert found.verdict == ("agrees", "within the model error", "outside")
    np.testing.assert_allclose(found.deviation, shares - 1, atol=1e-8)  # digits of EXACT
    assert not found.agrees
    within, outside = found.sentences()[0], found.sentences()[1]
    assert "5 % above" in within + outside
    assert "1.1 %" in within + outside


def test_one_low_frequency_is_explained_by_each_number_alone():
    found = bd.compare(SCENE, bd.MeasuredFrequencies([62.1], rounding=0.05))
    values = {each.name: each.value for each in found.explanations if each.explains}
    for name in ("mount.root_stiffness", "beam.thickness", "beam.length", "beam.density", "beam.tip.mass"):
        changed = with_numbers(SCENE, {name: values[name]})
        # The fit of an explanation ends at 1e-7.
        np.testing.assert_allclose(bd.natural_modes(changed, 0.0, 1).frequency, 62.1, rtol=1e-5)
    assert round(values["mount.root_stiffness"], 2) == 1.03
    assert round(1e3 * values["beam.thickness"], 3) == 0.190
    (said,) = [text for text in found.sentences() if "explain" in text]
    assert "mount.root_stiffness = 1.03 N m/rad" in said


def test_what_no_number_explains_is_said():
    data = bd.MeasuredFrequencies([60.0, 450.0, 1144.0], rounding=0.05)
    found = bd.compare(SCENE, data)
    assert not any(each.explains for each in found.explanations)
    assert "No number alone explains it" in found.sentences()[-1]


def test_a_shape_of_another_mode_is_said_to_be_like_that():
    x = np.linspace(0.005, 0.05, 6)
    shapes = bd.natural_modes(SCENE, 0.0, 3).shape(x)
    found = bd.compare(
        SCENE, bd.MeasuredFrequencies([65.2, 408.8, 1145.0], positions=x, shapes=shapes[[1, 0, 2]])
    )
    assert found.mode.tolist() == [0, 0, 3]
    assert found.resembles[2] == ""
    assert "most like that of mode 2, 408.8 Hz (likeness 1.00): columns may be" in " ".join(found.sentences())


def test_modes_without_a_value_and_values_without_a_mode_are_named():
    data = bd.MeasuredFrequencies([65.23, 656.6, 1144.6], labels=["bending 1", "torsion 1", "bending 3"])
    found = bd.compare(SCENE, data)
    assert found.mode.tolist() == [1, 0, 3]
    assert found.verdict[1] == "no mode"
    said = " ".join(found.sentences())
    assert "mode 2 of the scene, 408.8 Hz at 0 rad/s" in said
    assert "torsion 1, 656.6 Hz at 0 rad/s: the model has no such mode" in said
    twisting = replace(SCENE, physics=bd.Physics(torsion=True))
    assert bd.compare(twisting, replace(data, uncertainty=np.full((1, 3), 50.0))).mode.tolist() == [1, 3, 4]


def test_another_kind_of_data_is_refused():
    with pytest.raises(ValueError, match=r"read a file by bd.read_measurements"):
        bd.compare(SCENE, [62.1])  # type: ignore[arg-type]


def test_a_density_is_said_without_an_exponent():
    assert say_value(7853.4, "kg/m3") == "7850 kg/m3"
    assert say_value(2.0e-4, "m").elsewhere == "0.2 mm"


@pytest.mark.parametrize(
    "factor, words",
    [
        (2 * np.pi, "2 pi times those of the scene, within 5 %: they may be in rad/s, and read as Hz"),
        (60.0, "60 times"),
        (1e3, "1000 times"),
        (1 / (2 * np.pi), "1/(2 pi) times"),
        (1 / 60, "1/60 times"),
        (1e-3, "1/1000 times"),
    ],
)
def test_values_off_by_the_factor_of_a_unit_are_said_to_be_in_another(factor, words):
    shares = np.array([0.95, 0.953, 0.957])
    for count in (2, 3):  # in radians a second the first and second come near modes 2 and 4
        found = bd.compare(SCENE, bd.MeasuredFrequencies((factor * shares * EXACT)[:count].tolist()))
        (said,) = [each for each in found.warnings if "all measured" in each]
        assert words in said and said.kind == "input"


@pytest.mark.parametrize(
    "values",
    [
        np.multiply(1.01, EXACT),
        np.multiply(10.0, EXACT),  # no factor of two units
        [2 * np.pi * EXACT[0], EXACT[1], EXACT[2]],  # not all
        2 * np.pi * np.multiply([0.88, 0.95, 0.97], EXACT),  # further off than 10 %
        [2 * np.pi * EXACT[0]],  # one value may be of mode 2
    ],
)
def test_other_values_are_not_said_to_be_in_another_unit(values):
    found = bd.compare(SCENE, bd.MeasuredFrequencies([*values], uncertainty=0.1))
    assert not any("all measured" in each for each in found.warnings)


def test_numbers_that_explain_are_in_the_unit_of_length_of_the_scene():
    inches = replace(SCENE, units=bd.DisplayUnits(length="in"))
    found = bd.compare(inches, bd.MeasuredFrequencies([62.1], rounding=0.05))
    (said,) = [in_files(text, found.display_units) for text in found.sentences() if "explain" in text]
    assert "beam.length = 2.02 in" in said and "beam.youngs_modulus = 181 GPa" in said


def test_the_picture_of_data_at_rest_has_speeds_that_suit_the_beam():
    """A blade bent in space was followed to speeds at which it has no equilibrium, for data far off."""
    strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    lines = [
        bd.compare(bd.Scene(strip), bd.MeasuredFrequencies([measured])).plot().lines[0].get_xdata()
        for measured in (65.0, 5000.0)
    ]
    np.testing.assert_array_equal(*lines)
    np.testing.assert_allclose(lines[0].max(), 0.1 * 2 * np.pi * 65.23, rtol=1e-4)
