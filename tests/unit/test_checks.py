"""Checks: what a refusal carries, and how its message follows from that."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from beamdyn.common.edge.config import MissingValue
from beamdyn.common.edge.inputs import path_of
from beamdyn.common.edge.units import InvalidInput, quantity
from beamdyn.common.inputs.array_checks import numbers, pair
from beamdyn.common.inputs.array_checks import positive as positive_numbers
from beamdyn.common.inputs.checks import (
    OUT_OF_RANGE,
    InvalidValue,
    ascending,
    one_of,
    positive,
    real,
    reason_of,
    refuse,
)


def refusal(call, *arguments, **more):
    with pytest.raises(InvalidValue) as refused:
        call(*arguments, **more)
    return refused.value


def test_a_refusal_carries_what_it_says():
    error = refusal(positive, "radius", -0.2, "m", "give m")
    assert (error.field, error.value, error.unit, error.remedy) == ("radius", -0.2, "m", "give m")
    assert str(error) == "radius = -0.2 m: it must be greater than 0; give m"


def test_attributes_may_be_replaced():
    error = refusal(real, "speed", "fast", "rad/s")
    assert str(replace(error, field="motion.speed")) == "motion.speed = 'fast': give a finite number in rad/s"


def test_limit_and_other_argument_stand_in_the_sentence():
    bound = "it must exceed {other}, {limit}"
    error = refusal(refuse, [False, True, True], "b", [1.0, 2.0, 3.0], "m", bound, limit=[4, 5, 6], other="a")
    assert (error.value, error.limit, error.other) == (2.0, 5.0, "a")
    assert str(error) == "b = 2 m (and 1 more of 3 cases): it must exceed a, 5 m"


def test_good_values_are_not_refused():
    refuse(np.zeros(3, dtype=bool), "b", 1.0, "m", "never")
    assert positive("b", np.float64(2.0)) == 2.0
    np.testing.assert_array_equal(ascending("b", [1, 2]), [1.0, 2.0])


@pytest.mark.parametrize(
    "error",
    [
        InvalidValue("a", 1.0, "below {limit}", "more", "m", 2.0, "b", " at x = 0"),
        InvalidInput("a", "1 m", "no"),
        MissingValue("a", None, "give it"),
    ],
)
def test_refusals_pass_between_processes(error):
    copy = pickle.loads(pickle.dumps(error))
    assert (type(copy), str(copy), vars(copy)) == (type(error), str(error), vars(error))


def test_numbers_may_be_arrays():
    assert numbers("a", [1, 2]).tolist() == [1.0, 2.0]
    assert refusal(positive_numbers, "a", np.array([1.0, -2.0, -3.0]), "m").value == -2.0
    assert refusal(pair, "tip", (1.0, "x"), "m").field == "tip[1]"


def test_a_choice_names_all():
    assert (
        str(refusal(one_of, "law", "odd", ("smooth", "linear"))) == "law = 'odd': give 'smooth' or 'linear'"
    )
    assert "give 'a', 'b' or 'c'" in str(refusal(one_of, "law", "odd", ("a", "b", "c")))


def test_long_values_are_shortened():
    assert len(str(refusal(real, "a", [0] * 1000))) < 120


def test_a_quantity_is_shown_as_written():
    assert str(refusal(quantity, "5 kg", "m")).startswith('"5 kg": a unit of mass')


@pytest.mark.parametrize(
    ("field", "table", "path"),
    [
        ("slope", "", "stop.slope"),
        ("stop.slope", "", "stop.slope"),
        ("radius", "brake", "brake.radius"),
        ("radius", "", ""),
        ("distance of the pin", "", ""),
    ],
)
def test_the_input_that_a_refusal_is_about(field, table, path):
    paths = ["stop.slope", "brake.radius", "wheel.radius"]
    assert path_of(InvalidValue(field, 1.0, "no"), paths, table) == path
    assert path_of(ValueError("no"), paths, table) == ""


@pytest.mark.parametrize("failing", ["1.0 / 0.0", "2.0**5000", "np.float64(1e300) * 1e300", "0.0 + 1 // 0"])
def test_numbers_out_of_range_are_said_in_the_words_of_a_user(failing):
    with np.errstate(all="raise"), pytest.raises(ArithmeticError) as raised:
        eval(failing)
    assert reason_of(raised.value) == OUT_OF_RANGE
    assert reason_of(ArithmeticError("buckles")) == "buckles"


def test_values_as_far_apart_as_floats_go_are_put_in_order_without_overflow():
    largest = np.finfo(float).max
    np.testing.assert_array_equal(ascending("speeds", [-largest, largest]), [-largest, largest])
    with pytest.raises(ValueError, match="must ascend"):
        ascending("speeds", [largest, -largest])
