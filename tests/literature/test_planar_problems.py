"""Published problems of statics, solved by `brakes.planar` and compared to the printed digits."""

from __future__ import annotations

import pytest

from beamdyn.reproduce.entries import half_unit
from benchmarks.cases.statics import PROBLEMS, cantilever_brake
from brakes.planar import solve, stroke
from brakes.published import load

PRINTED = load("statics")
LOOSE = ("compound_bolt_cutter",)  # which nothing holds in space
ROUNDING = 3e-14  # of some ten sums, over the largest number of a problem


def test_every_printed_problem_is_solved():
    assert [*PRINTED] == [*PROBLEMS]


@pytest.mark.parametrize("name", PROBLEMS)
def test_what_the_book_prints(name: str):
    """To the last printed digit; numbers that are exact in the problem to rounding."""
    printed, ours = dict(PRINTED[name]), PROBLEMS[name].answers()
    printed.pop("source")
    assert [*ours] == [*printed]
    largest = max(abs(value) for values in ours.values() for value in values)
    for quantity, given in printed.items():
        texts = given["printed"] if isinstance(given["printed"], list) else [given["printed"]]
        for text, value in zip(texts, ours[quantity], strict=True):
            close = ROUNDING * largest if given.get("exact") else half_unit(text)
            assert value == pytest.approx(float(text), abs=close, rel=0), quantity


@pytest.mark.parametrize("name", PROBLEMS)
def test_what_statics_tells(name: str):
    mechanism = PROBLEMS[name].mechanism()
    answer = solve(mechanism)
    if name in LOOSE:
        assert (answer.status, answer.loose) == ("loose", mechanism.bodies)
    else:
        assert answer.status == "determined"
        assert answer.virtual_work < 1e-13  # rounding of some ten sums


def test_a_beam_that_is_fixed_has_no_mobility():
    assert solve(PROBLEMS["compound_beam"].mechanism()).mobility == 0


@pytest.mark.parametrize("angle", [25.0, 45.0, 70.0])
def test_cantilever_brake_by_hand(angle: float):
    """N/T = PC/(2 PS sin(alpha)): yoke legs at alpha from the horizontal, arm PC normal to the leg."""
    brake, expected = cantilever_brake(angle)
    answer = solve(brake)
    assert answer.status == "determined" and answer.virtual_work < 1e-13
    assert answer.amplitudes["pad"] == pytest.approx(expected, rel=1e-13)  # rounding
    rate = stroke(brake, "main cable", [0.0]).ratio["pad"][0]
    assert 2 * expected * rate == pytest.approx(-1.0, rel=1e-13)
