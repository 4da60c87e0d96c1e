"""Questions backwards: functions whose inverses are known, what is said where there are none, bad ones."""

import numpy as np
import pytest

import brakes
from brakes.cli import main

EXACT = 1e-12  # relative, of roots of functions of a few operations
SAMPLES = np.linspace(0.5, 5.0, 10)


@pytest.mark.parametrize(
    ("answer", "target", "known"),
    [
        (lambda x: x * (4 - x), 3.0, [1.0, 3.0]),
        (lambda x: (x - 3) ** 2 + (x - 3) ** 3 / 9, 1e-6, None),
        (lambda x: np.exp(x), np.exp(5.0), [5.0]),
        (lambda x: np.where(x > 2, np.sqrt(np.abs(x - 2)), np.nan), 1.5, [4.25]),
        (lambda x: np.where(x < 3.3, 1 / (3.3 - np.minimum(x, 3.2999)), np.nan), 5.0, [3.1]),
        (lambda x: np.minimum(x, 2.0), 1.2, [1.2]),
        (
            lambda x: np.abs(np.mod(x, 1.0) - 0.5),
            0.2,
            np.sort(np.ravel(np.arange(5)[:, None] + [0.3, 0.7]))[1:],
        ),
    ],
)
def test_all_solutions_are_found(answer, target, known):
    found = brakes.find(answer, target, SAMPLES)
    assert found.settled
    if known is None:  # two beside a turning point that is none of the samples
        assert len(found.values) == 2
        assert answer(found.values) == pytest.approx(target, rel=1e-9)
        return
    assert found.values == pytest.approx(np.array(known), rel=EXACT)
    assert np.max(np.abs(found.residuals)) <= EXACT * target


def test_a_value_that_is_only_touched_is_found():
    found = brakes.find(lambda x: x * (4 - x), 4.0, SAMPLES)
    assert found.values == pytest.approx([2.0], rel=1e-7)  # a turning point is sharp to the root of rounding


def test_zero_that_is_only_touched_is_found():
    """No height is small beside a wanted 0: it is rounding beside the last step to the turning point."""
    found = brakes.find(lambda x: (x - 0.3) ** 2, 0.0, np.linspace(-1.0, 1.0, 9))
    np.testing.assert_allclose(found.values, [0.3], rtol=1e-8)  # the place of a turning point
    missed = brakes.find(lambda x: (x - 0.3) ** 2 + 1e-9, 0.0, np.linspace(-1.0, 1.0, 9))
    assert missed.values.size == 0
    pole = brakes.find(lambda x: 5.0 + 1 / x**2, 4.9, np.geomspace(1e-7, 10.0, 9))
    assert pole.values.size == 0


@pytest.mark.parametrize(
    ("answer", "target", "said"),
    [
        (lambda x: x * (4 - x), 4.5, "none from 0.5 to 5: answer is at most 4, at input = 2"),
        (lambda x: 2 * x, 0.5, "none from 0.5 to 5: answer is at least 1, at input = 0.5"),
        (lambda x: np.floor(x), 1.5, "it jumps past the wanted value at input = 2"),
        (lambda x: 7.0 + 0 * x, 3.0, "none from 0.5 to 5: answer is 7 whatever input is"),
        (
            lambda x: np.where(x < 2, x, np.nan),
            3.0,
            "answer is at most 2, at input = 2; no answer from 2 to 5",
        ),
        (lambda x: np.nan * x, 3.0, "none from 0.5 to 5: it has no value"),
    ],
)
def test_none_says_what_keeps_the_answer_from_it(answer, target, said):
    found = brakes.find(answer, target, SAMPLES)
    assert not found.values.size
    assert said in found.message


@pytest.mark.parametrize(
    ("answer", "target", "alone", "ranges"),
    [
        (lambda x: np.minimum(x, 2.3), 2.3, [], [(2.3, 5.0)]),
        (lambda x: np.clip(x, 1.15, 3.3), 1.15, [], [(0.5, 1.15)]),
        (lambda x: np.clip(np.abs(x - 3.0), 0.25, 1.0), 1.0, [], [(0.5, 2.0), (4.0, 5.0)]),
        (lambda x: np.maximum(1.0, x * (4.5 - x)), 1.0, [], [(2.25 + 4.0625**0.5, 5.0)]),
        (lambda x: 7.0 + 0 * x, 7.0, [], [(0.5, 5.0)]),
        (lambda x: np.where(x < 2.2, 1.0, x - 2.2), 1.0, [3.2], [(0.5, 2.2)]),
    ],
)
def test_a_level_answer_is_a_range_of_inputs(answer, target, alone, ranges):
    found = brakes.find(answer, target, SAMPLES)
    assert found.values == pytest.approx(alone, rel=EXACT)
    assert found.ranges.ravel() == pytest.approx(np.ravel(ranges), rel=2e-12)  # level to 1e-12
    assert all(f"any input from {low:.6g} to {high:.6g}" in found.message for low, high in ranges)


def test_a_level_answer_is_found_by_its_rounded_value_alone():
    """A rising answer is not: it has the wanted value itself."""
    found = brakes.find(lambda x: np.minimum(x, 2.3456), 2.35, SAMPLES, rounding=0.005)
    assert found.target == pytest.approx(2.3456, rel=2e-12)  # level to 1e-12
    assert not found.values.size
    assert found.ranges.ravel() == pytest.approx([2.3456, 5.0], rel=2e-12)
    assert not brakes.find(lambda x: np.minimum(x, 2.3456), 2.35, SAMPLES, rounding=0.004).there
    assert brakes.find(lambda x: x, 2.35, SAMPLES, rounding=0.005).values == pytest.approx([2.35], rel=EXACT)
    with pytest.raises(ValueError, match="rounding"):
        brakes.find(lambda x: x, 2.35, SAMPLES, rounding=-1.0)


def test_the_largest_of_a_level_answer_is_at_its_range():
    found = brakes.find(lambda x: np.minimum(x, 2.0), 3.0, SAMPLES)
    assert found.message == "none from 0.5 to 5: answer is at most 2, at any input from 2 to 5"


@pytest.mark.parametrize(
    ("answer", "target", "values", "said"),
    [
        (lambda n: 2.0 * n, 8.0, [4.0], "answer = 8 at input = 4"),
        (
            lambda n: 2.0 * n,
            7.0,
            [4.0],
            "answer passes 7 from input = 3 (6) to 4 (8): 4 is the first past it",
        ),
        (
            lambda n: 12.0 / n,
            7.0,
            [2.0],
            "answer passes 7 from input = 1 (12) to 2 (6): 2 is the first past it",
        ),
        (lambda n: n * (8 - n), 12.0, [2.0, 6.0], "answer = 12 at input = 2 and 6"),
        (lambda n: 2.0 * n, 30.0, [], "none from 1 to 10: answer is at most 20, at input = 10"),
        (
            lambda n: np.where(n < 4, 2.0 * n, np.nan),
            8.0,
            [],
            "answer is at most 6, at input = 3; no answer from 4",
        ),
    ],
)
def test_whole_numbers_are_tried(answer, target, values, said):
    found = brakes.find_whole(answer, target, range(1, 11))
    assert found.values.tolist() == values
    assert said in found.message


def test_a_curve_that_never_settles_is_said():
    found = brakes.find(lambda x: np.sin(1e5 * x**2), 0.5, SAMPLES)
    assert not found.settled
    assert "there may be more solutions" in found.warnings[0]


@pytest.mark.parametrize("samples", [[1.0], [2.0, 1.0], []])
def test_bounds_are_checked(samples):
    with pytest.raises(ValueError, match="samples"):
        brakes.find(np.sin, 0.5, samples)


def run(capsys, *arguments):
    code = main([*arguments])
    shown = capsys.readouterr()
    return code, " ".join(shown.out.split()), " ".join(shown.err.split())


@pytest.mark.parametrize("phase", np.linspace(0.0, 6.0, 13))
@pytest.mark.parametrize("way", [1, -1])
def test_no_rounding_makes_a_level_answer_rise(phase, way):
    """The value at the edge of a level piece is half as far from the level as rounding may be."""

    def answer(x):
        return np.minimum(way * (x - 2.0), 0.0) + 2.0 + 2e-13 * np.sin(1e5 * x + phase)

    found = brakes.find(answer, 2.0, SAMPLES)
    assert found.values.size == 0
    span = [2.0, SAMPLES[-1]] if way == 1 else [SAMPLES[0], 2.0]
    np.testing.assert_allclose(found.ranges, [span], rtol=2e-12)
    assert "is level" in {piece.course for piece in found.pieces}


@pytest.mark.slow
def test_command_finds_a_diameter_for_a_torque(capsys):
    code, out, _ = run(
        capsys, "disc", "examples/disc.toml", "--find", "disc.outer_radius", "--so-that", "torque = 800 N m"
    )
    # C* r is in proportion to the mean radius under uniform wear: 714.549 N m at (80 + 120) / 2 mm
    radius = 800 / 714.5486 * 200 - 80
    assert code == 0
    assert float(out.partition("outer_radius = ")[2].split()[0]) == pytest.approx(
        radius, rel=1e-5
    )  # as shown


@pytest.mark.parametrize(
    ("question", "code", "said"),
    [
        (("vehicle", "lever.ratio", "largest_slope_front = 45 %"), 1, "at most 15.2447 deg"),
        (("vehicle", "lever.ratio", "largest_slope_front = 45 %"), 1, "a travel of 300 mm"),
        (
            ("vehicle", "lever.ratio", "largest_slope_front = 20 %"),
            0,
            "largest_slope_front = 20 % (11.3099 deg)",
        ),
        (("vehicle", "lever.ratio", "largest_slope_front = 10.0 deg"), 0, "largest_slope_front = 10 deg at"),
        (
            ("vehicle", "road.friction", "largest_slope_front = 14.606 deg"),
            0,
            "14.606 deg (14.6061 deg) at any road.friction from 0.261906 to 2",
        ),
        (("vehicle", "road.friction", "largest_slope_front = 14.605 deg"), 0, "at road.friction = 0.261"),
        (
            ("vehicle", "road.friction", "largest_slope_front = 15 deg"),
            1,
            "at most 14.6061 deg, at any road.",
        ),
        (("band", "friction", "torque = 1 N m"), 1, "no answer from 0.330953 to 2: locked"),
        (("vehicle", "lever.force", "rolling_slope_front = 45 deg"), 0, "past, front downhill: never"),
        (("cone", "friction", "torque = 100 N m"), 1, "torque is 200 N m whatever brake.friction is"),
        (("plates", "plates.faces", "torque = 300 N m"), 0, "13 is the first past it"),
        (("plates", "plates.faces=2:5:2", "torque = 300 N m"), 1, "at most 120 N m, at plates.faces = 5"),
        (
            ("vehicle", "cable.brakes=1:9e5:2", "pedal_travel = 1 m"),
            2,
            "there are more than 100000 whole numbers",
        ),
        (("disc", "load.torque", "torque = 100 N m"), 2, "the file gives it no value"),
        (("disc", "brake.friction", "torque = 100 MPa"), 2, "a unit of pressure or modulus where moment"),
        (("disc", "heat.stops", "hottest = 200 degC"), 2, "a difference from the temperature of the surr"),
        (("disc", "brake.friction", "torque"), 2, 'give RESULT = VALUE, such as "torque = 1 N m"'),
        (("disc", "brake.friction", "torque>9 N m"), 2, '"torque>9 N m": give RESULT = VALUE, such as "torq'),
        (("disc", "brake.friction", "c_star = x"), 2, "give a plain number"),
        (("disc", "friktion", "c_star = 1"), 2, "did you mean friction?"),
    ],
)
def test_what_cannot_be_had_is_one_sentence(question, code, said, capsys):
    name, sought, wanted = question
    found = run(capsys, name, f"examples/{name}.toml", "--find", sought, "--so-that", wanted)
    assert found[0] == code
    assert said in found[2 if code else 1]
    assert said not in found[1 if code else 2]  # said once


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--find", "friction"), "--find and --so-that go together"),
        (
            ("--find", "friction", "--so-that", "torque = 1 N m", "--what", "torque"),
            "--what does not go with",
        ),
        (
            ("--find", "friction", "--so-that", "torque = 1 N m", "--vary", "friction=0.1:0.2:3"),
            "--vary does not go with --find",
        ),
    ],
)
def test_options_that_do_not_go_together(options, said, capsys):
    code, _, err = run(capsys, "disc", "examples/disc.toml", *options)
    assert code == 2
    assert said in err


@pytest.mark.parametrize("power", [1, 2])
def test_beside_a_pole_only_sure_digits_are_shown(power):
    """The answer at the last input before the pole is by the rounding of the input alone."""
    found = brakes.find(lambda x: np.where(x < np.pi, 1 / np.abs(np.pi - x) ** power, np.nan), 0.1, SAMPLES)
    (piece,) = found.pieces
    first, last = piece.shown_ends
    assert float(first) == pytest.approx(piece.first, rel=5e-6) and last.startswith("about ")
    high = brakes.find(lambda x: np.where(x < np.pi, 1 / (np.pi - x), np.nan), 1e30, SAMPLES)
    assert "answer is at most about " in high.message


def test_ends_that_the_input_hardly_moves_have_all_their_digits():
    (piece,) = brakes.find(lambda x: 123.4567891 * x, 200.0, SAMPLES).pieces
    assert piece.shown_ends == ("61.7284", "617.284")
