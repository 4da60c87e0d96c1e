"""Spreads whose answers have errors, gaps or refusals: what is printed has something behind it."""

import io
import re

import numpy as np
import pytest
from matplotlib.figure import Figure
from rich.console import Console

import beamdyn as bd
from beamdyn.cli import NO_ANSWER, main
from beamdyn.common.edge.spread_tables import headline, spread_table
from beamdyn.common.inputs.checks import InvalidValue, NoModelAnswer
from beamdyn.common.results.pictures import COLOURS
from beamdyn.common.spreading.solve import SpreadAnswers, solve_spread
from beamdyn.common.spreading.spread_result import draw_scatter
from beamdyn.common.spreading.statistics import scatter_of
from beamdyn.common.spreading.tolerances import SpreadInput, Uniform
from beamdyn.studies import spread as spreads

BEAM = {"length": 0.05, "width": 0.01, "thickness": 2e-4, "youngs_modulus": 2e11, "density": 7850.0}
SCENE = bd.Scene(bd.Beam.rectangular(**BEAM), bd.Mount(0.2))
FEW = {"samples": 128, "modes": 1}


def spread_of(function, inputs=2, samples=128, error=None, warn=None, refuse=None):
    """The spread of a function of inputs from 0 to 1, with relative errors and warnings of designs."""
    given = [SpreadInput(f"x{i}", "", 0.5, Uniform(0.0, 1.0)) for i in range(inputs)]

    def evaluate(columns):
        each = np.array([*columns.values()])
        if refuse is not None and (bad := refuse(*each)).any():
            raise InvalidValue("x0", float(each[0][bad][0]), "it is too much together with x1")
        value = function(*each)[:, None]
        wrong = np.zeros(value.shape) if error is None else error(*each)[:, None] * np.ones(value.shape)
        said = () if warn is None else warn(*each)
        state = np.where(np.isfinite(value), "done", "locks")
        return SpreadAnswers(("y",), ("N",), value, wrong, state, said, "a formula", "nothing")

    return solve_spread("y", given, samples, 0, evaluate)


def at_corners(x, y):
    return np.isin(x, (0.0, 1.0)) & np.isin(y, (0.0, 1.0))


def text_of(found):
    page = Console(file=io.StringIO(), width=120)
    page.print(spread_table(found))
    return page.file.getvalue()


# Worst cases --------------------------------------------------------------------------------------


def test_worst_cases_have_the_errors_of_their_own_designs():
    found = spread_of(lambda x, y: 1 + x + y, error=lambda x, y: np.where(at_corners(x, y), 0.3, 1e-9))
    assert found.worst.smallest_error[0] == pytest.approx(0.3)
    assert found.worst.largest_error[0] == pytest.approx(0.9)
    assert found.error[0] == pytest.approx(1e-9)  # of all others
    assert "; 1 to 3.0 ± 0.9 N at worst" in headline(found, 0)  # half a unit is not below 0.3, nor below 0.9
    assert "3e-01" in text_of(found)


def test_an_error_that_is_not_known_stays_so():
    found = spread_of(lambda x, y: 1 + x + y, error=lambda x, y: np.nan * x)
    assert np.isnan(found.worst.smallest_error[0]) and np.isnan(found.error[0])


def test_what_is_said_of_worst_cases_is_passed_on_once():
    def warn(x, y):
        return ("at 3 of 9 designs it slides",) + (("it tips",) if at_corners(x, y).any() else ())

    found = spread_of(lambda x, y: 1 + x + y, warn=warn)
    assert found.warnings == ("at 3 of 9 designs it slides", "worst cases: it tips")


def test_few_of_the_warnings_that_differ_in_their_numbers_are_passed_on():
    found = spread_of(lambda x, y: 1 + x * (1 - x) + y, warn=lambda x, y: (f"it slides by {x.max():.4g} mm",))
    assert sum("it slides by" in each for each in found.warnings) == 4  # one of random designs
    assert any(each.endswith(" more warnings") for each in found.warnings)


def test_an_infinite_result_has_no_error():
    made = spread_of(lambda x, y: np.where(x > 0.2, np.inf, x + y), error=lambda x, y: 0.0 * x)
    assert "inf" in text_of(made)


@pytest.mark.parametrize("error", [np.inf, 10.0])
def test_without_a_search_the_answer_of_a_corner_is_given(error):
    """Errors hide all trends, so that the only corner is the nominal design: random ones lie beyond it."""
    found = spread_of(lambda x, y: 1 + x + y, error=lambda x, y: error + 0 * x)
    worst = found.worst
    assert not worst.searched[0]
    assert worst.smallest[0] == worst.largest[0] == 2.0 and (worst.smallest_at == 0.5).all()
    beyond = 2.0 - found.sampled_answers.min()
    assert worst.smallest_error[0] >= error * 2.0 + beyond  # so that the true one, 1, lies within
    assert ("unresolved" in text_of(found).split("Scatter")[0]) == np.isinf(error)


def test_one_design_with_an_infinite_error_hides_no_trend():
    found = spread_of(lambda x, y: 1 + x + y, error=lambda x, y: np.where(x > 0.995, np.inf, 0.0))
    assert found.trends.tolist() == [["rises"], ["rises"]]
    assert np.isinf(found.worst.largest_error[0]) and found.worst.smallest_error[0] == 0
    assert "to unresolved N at worst" in headline(found, 0) and "1.00000 to" in headline(found, 0)


def test_inputs_that_are_refused_together_only_at_a_corner():
    found = spread_of(lambda x, y: 1 + x + y, refuse=lambda x, y: (x == 1) & (y == 1))
    assert found.worst.smallest[0] == 1.0
    assert found.worst.searched[0] and found.worst.largest[0] > 2.9
    (said,) = [said for said in found.warnings if said.startswith("worst cases")]
    assert re.search(r"\d+ of \d+ designs have no answer", said) and "too much together with x1" in said


def test_designs_of_worst_cases_without_an_answer_are_counted():
    found = spread_of(lambda x, y: np.where((x == 1) & (y == 1), np.nan, 1 + x + y))
    assert any(re.search(r"\d of \d+ designs have no answer \(locks: \d", said) for said in found.warnings)


def test_a_search_is_bounded_and_says_so():
    """Of 20 inputs each step of two searches takes 80 designs: 40 steps are more than the random designs."""
    target = np.linspace(0.1, 0.9, 20)[:, None]
    found = spread_of(lambda *x: ((np.array(x) - target) ** 2).sum(axis=0), inputs=20)
    first = 1 + 4 * 20 + 22 * 128
    assert found.worst.designs <= first + 2 * 2**6 and found.worst.cut_short[0]
    assert any(f"ended after {found.worst.designs} designs" in said for said in found.warnings)
    few = spread_of(lambda x, y: np.sin(40 * x) + np.sin(30 * y), samples=128)
    assert few.worst.designs < 1 + 8 + 4 * 128 and not few.worst.cut_short[0]
    assert f"{few.worst.designs} for worst cases" in text_of(few)


def test_progress_counts_the_designs_of_worst_cases():
    seen = []
    found = bd.spread(
        SCENE, {"beam.thickness": "+-2%"}, **FEW, progress=lambda done, total: seen.append((done, total))
    )
    first = 1 + 4 + 3 * 128
    assert (first, first) in seen
    assert seen[-1] == (first + found.worst.designs, first + found.worst.designs)
    assert [done for done, _ in seen] == sorted(done for done, _ in seen)


# Statistics ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(("known", "finite"), [(1, False), (7, False), (8, True), (16, True)])
def test_few_answers_leave_no_error_of_a_statistic(known, finite):
    """Answers in some of 16 blocks, of 8 designs each in A and in B."""
    random = np.full((2, 16, 8), np.nan)
    random[0, :known, 0] = np.arange(known)
    found = scatter_of(random.reshape(2, 128, 1))
    for error in (found.mean_error, found.deviation_error, found.percentile_error):
        assert (np.isfinite(error) == finite).all()
    assert found.mean[0] == np.arange(known).mean() and found.no_answer[0] == 1 - known / 256


def test_scatter_below_the_numerical_error_says_nothing_of_the_inputs():
    found = spread_of(lambda x, y: 1 + 1e-3 * x + 1e-4 * y, error=lambda x, y: 1e-2 + 0 * x)
    assert np.isnan(found.indices.total).all() and found.matters_most() == ()
    said, table = headline(found, 0), text_of(found)
    assert "matters most" not in said
    (shown,) = re.findall(r"standard deviation ([^;N]*) N", said)
    assert shown.startswith("0 ±") and shown in table.split("Scatter")[1]
    sure = spread_of(lambda x, y: 1 + 1e-3 * x + 1e-4 * y, error=lambda x, y: 1e-8 + 0 * x)
    assert "x0 matters most" in headline(sure, 0)


# Slopes -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("refusal", "said"),
    [
        (InvalidValue("beam.length", 1.0, "it is refused"), True),
        (ValueError("no convergence"), True),
        (InvalidValue("physics.large_deflection", True, "linear equations only"), False),
        (NoModelAnswer("there is no critical speed"), False),
    ],
)
def test_a_refusal_of_derivatives_is_not_silent(refusal, said, monkeypatch):
    def refuse(*_, **__):
        raise refusal

    monkeypatch.setattr(spreads, "frequency_sensitivities", refuse)
    found = bd.spread(SCENE, {"beam.thickness": "+-2%"}, **FEW)
    assert not found.first_order.exact.any()
    assert any(str(refusal) in each for each in found.warnings) == said


def test_inputs_without_derivatives_are_named():
    given = {"beam.thickness": "+-2%", "beam.scale.thickness": "+-1%"}
    both = " ".join(text_of(bd.spread(SCENE, given, **FEW)).split())
    assert "from derivatives; for beam.scale.thickness, from designs near it" in both
    alone = " ".join(text_of(bd.spread(SCENE, {"beam.scale.thickness": "+-1%"}, **FEW)).split())
    assert "from designs near it" in alone and "derivatives" not in alone


# Words --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "remedy"),
    [
        ("+-2 mm", 'give "+-0.002"'),
        ("0.19 mm to 0.21 mm", 'give "0.00019 to 0.00021"'),
        ("0.19 to 0.21 mm", 'give "0.00019 to 0.00021"'),
        ("+1.5e1 um, -2%", 'give "+1.5e-05, -2%"'),
        ("+-2 ft", "give numbers without a unit, in m"),
    ],
)
def test_a_unit_in_python_is_refused_with_the_number_to_give(text, remedy):
    with pytest.raises(InvalidValue) as refused:
        bd.spread(SCENE, {"beam.thickness": text}, **FEW)
    assert remedy in str(refused.value)


def test_a_section_and_what_follows_from_it_are_refused_together():
    given = {"beam.thickness": "+-1%", "beam.bending_stiffness": "+-1%"}
    with pytest.raises(InvalidValue) as refused:
        bd.spread(SCENE, given, **FEW)
    for part in ("beam.thickness", "beam.bending_stiffness", "beam.scale.bending_stiffness"):
        assert part in str(refused.value)


def test_one_line():
    found = bd.spread(SCENE, {"beam.thickness": "+-2%", "mount.radius": "+-1%"}, **FEW)
    low, high = found.first_order.smallest[0], found.first_order.largest[0]
    assert repr(found) == (
        f"SceneSpread(mode 1 of 512 designs: first order {low:.2f} to {high:.2f} Hz, "
        "beam.thickness matters most)"
    )


def test_pictures_of_two_spreads_are_told_apart():
    ax = Figure().subplots()
    one, two = (bd.spread(SCENE, {"beam.thickness": width}, **FEW) for width in ("+-2%", "+-1%"))
    one.plot(ax, label="wide")
    before = {*map(tuple, (patch.get_facecolor() for patch in ax.patches))}
    count = len(ax.patches)
    two.plot(ax, label="narrow")
    after = {*map(tuple, (patch.get_facecolor() for patch in ax.patches[count:]))}
    assert not before & after
    lines = [line.get_color() for line in ax.lines if line.get_color() in COLOURS[:-1]]
    half = len(lines) // 2
    assert not {*lines[:half]} & {*lines[half:]}
    entries = ax.get_legend_handles_labels()[1]
    assert {"wide, random designs", "narrow, random designs"} <= {*entries}


def test_where_some_designs_have_no_answer_that_is_the_worst():
    made = spread_of(lambda x, y: np.where(x > 0.8, np.nan, x + y))
    assert re.search(
        r"no answer at worst \(in [12].? % of the random designs\), else 0.* to ", headline(made, 0)
    )
    assert "or no answer" in text_of(made)
    assert "no answer" not in headline(spread_of(lambda x, y: x + y), 0)


def test_where_no_design_has_an_answer_the_command_has_none(tmp_path, capsys):
    keys = ('length = "42 mm"', 'width = "8 mm"', 'thickness = "0.4 mm"', 'youngs_modulus = "195 GPa"')
    lines = ["[beam]", *keys, 'density = "7800 kg/m3"', "[mount]", 'radius = "230 mm"']
    (tmp_path / "s.toml").write_text(
        "\n".join([*lines, 'setting_angle = "0 deg"', 'bending_angle = "0 deg"'])
    )
    asked = ["study", str(tmp_path / "s.toml"), "--modes", "1", "--samples", "128"]
    assert main([*asked, "--speed", "9000 rpm", "--spread", "thickness=+-1%"]) == NO_ANSWER
    assert "none of" in capsys.readouterr().err


def test_outliers_do_not_make_a_picture_empty():
    values = np.append(np.linspace(1.0, 2.0, 999), 1e6)
    ax = draw_scatter(values, "distance", [("worst cases", "-", "red", (1.0, 1e6))], None)
    low, high = ax.get_xlim()
    assert 0 < low < 1 and 2 < high < 6
    assert [t.get_text() for t in ax.get_legend().get_texts()] == [
        "random designs, some beyond the picture",
        "worst cases, beyond the picture",
    ]


@pytest.mark.parametrize("number", [200.0, -3e-7, 0.0])
def test_a_histogram_shows_results_that_differ_by_rounding_as_one_number(number):
    """A torque that is given is the same for all designs; numpy found no bins between its last digits."""
    values = number * (1 + np.arange(-3, 4) * np.finfo(float).eps)
    ax = draw_scatter(values, "torque", [("nominal", "-", "black", (number,))], None)
    heights = [patch.get_height() for patch in ax.patches]
    assert max(heights) == pytest.approx(100) and np.count_nonzero(heights) == 1
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["random designs", "nominal"]
