"""The option --vary: its values, its keys, and designs among them that have no answer."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from beamdyn.common.edge.exit_codes import BAD_INPUT, DONE, NO_ANSWER
from beamdyn.common.edge.inputs import Input, Quantity, Section
from beamdyn.common.edge.varied_inputs import parse_axis
from brakes.cli import main

EXAMPLES = Path(__file__).parents[2] / "examples"
FORKLIFT, BLOCK = EXAMPLES / "forklift.toml", EXAMPLES / "block_brake.toml"


def axis(values):
    thickness = Input("beam.thickness", Section, float, Quantity("m", "h", "thickness"), (), True, None)
    return parse_axis([thickness], f"beam.thickness={values}")


def table(path):
    return [*csv.reader(path.read_text().splitlines())]


@pytest.fixture
def brakes(capsys):
    def brakes(*arguments):
        code = main([str(a) for a in arguments])
        return code, *capsys.readouterr()

    return brakes


def test_a_list_of_values():
    found = axis("0.2, 0.25,3e-1 mm")
    assert found.given.tolist() == [0.2, 0.25, 0.3] and found.unit == "mm"
    np.testing.assert_allclose(found.values, [2e-4, 2.5e-4, 3e-4], rtol=1e-15)


@pytest.mark.parametrize("values", ["0.1:10:3:log mm", "0.1:10:3log mm", "0.1 : 10 : 3 : log mm"])
def test_values_at_equal_ratios(values):
    np.testing.assert_allclose(axis(values).given, [0.1, 1, 10], rtol=1e-14)
    np.testing.assert_allclose(axis(values).values, [1e-4, 1e-3, 1e-2], rtol=1e-14)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ("0:10:3:log mm", "equal ratios need two ends of one sign, neither of them 0"),
        ("-1:1:3:log mm", "equal ratios need"),
        ("0.2 mm", 'or a list, "1,1.5,2 m"'),
        ("1,2", 'give a unit, e.g. "1 m"'),
        ("1,2 kg", "a unit of mass where length is wanted"),
        ("1,,2 mm", "give KEY=start:stop:count unit"),
        ("0.1:10:3:lg mm", "give KEY=start:stop:count unit"),
    ],
)
def test_values_that_are_refused(values, said):
    with pytest.raises(ValueError) as refusal:
        axis(values)
    assert said in str(refusal.value) and "--vary" in str(refusal.value)


def test_a_partial_key_of_several_inputs_names_them(brakes):
    code, out, err = brakes("caliper", BLOCK, "--vary", "friction=0.1:0.3:3")
    assert (code, out) == (BAD_INPUT, "")
    assert "friction is ambiguous; give run.friction or stop.friction" in err


@pytest.fixture
def tall(tmp_path):
    """A truck that overturns over its rear axle past 32.96 deg, whose tangent is 1.674 m over 2.581 m."""
    text = FORKLIFT.read_text(encoding="utf-8")
    assert 'empty_cg_y = "0.359 m"' in text
    path = tmp_path / "tall.toml"
    path.write_text(text.replace('empty_cg_y = "0.359 m"', 'empty_cg_y = "3.2 m"'), encoding="utf-8")
    return path


def test_one_truck_that_tips_is_a_row_with_its_reason(brakes, tall, tmp_path):
    sheet = tmp_path / "slopes.csv"
    vary = ("--vary", "stop.slope=5:40:8 deg", "--what", "torque_per_brake", "--csv", sheet)
    code, out, err = brakes("forklift", tall, *vary)
    assert code == DONE and "at 2 of 8 values there is no answer; stop.slope = 35 deg" in err
    assert "no answer, because" in out and "the truck overturns" in out
    heads, *rows = table(sheet)
    assert heads[-1] == "no_answer" and len(rows) == 8
    for slope, torque, *_, why in rows:
        tips = float(slope) > 32.96
        assert (
            np.isnan(float(torque)) == tips and why.startswith(f"stop.slope = {float(slope):g} deg") == tips
        )


def test_rows_beside_a_refused_one_are_those_without_it(brakes, tall, tmp_path):
    def torques(slopes):
        sheet = tmp_path / f"{slopes[:2]}.csv"
        vary = ("--vary", f"stop.slope={slopes} deg", "--vary", "stop.speed=10,20 km/h")
        brakes("forklift", tall, *vary, "--what", "torque_per_brake", "--csv", sheet)
        return {tuple(row[:2]): float(row[2]) for row in table(sheet)[1:]}

    alone, beside = torques("10,20"), torques("40,20,10")
    assert {key: beside[key] for key in alone} == alone
    assert sum(np.isnan([*beside.values()])) == 2


def test_where_every_truck_tips_there_is_no_answer(brakes, tall):
    code, out, err = brakes("forklift", tall, "--vary", "stop.slope=40,45 deg")
    assert (code, out) == (NO_ANSWER, "") and "there is no answer at any of 2 values" in err


def test_a_value_that_no_design_can_have_is_bad_input(brakes):
    code, _, err = brakes("forklift", FORKLIFT, "--vary", "stop.speed=-10,10 km/h")
    assert code == BAD_INPUT and 'stop.speed = "-10 km/h"' in err
