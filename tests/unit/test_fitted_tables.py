"""Tables on narrow screens: no number is ever cut."""

from __future__ import annotations

import io

import numpy as np
import pytest
from rich.console import Console

from beamdyn.common.edge.console import table

NUMBERS = [[f"{1000 * i + k}.{i}{k}" for k in range(9)] for i in range(4)]
HEADS = ["beam.thickness [mm]", "speed [rad/s]", *(f"mode {k} [Hz]" for k in range(7))]


def printed(width, heads=HEADS, rows=NUMBERS, left=(), keys=2):
    file = io.StringIO()
    Console(file=file, width=width).print(table("title", heads, rows, left, keys))
    lines = file.getvalue().splitlines()
    assert max(map(len, lines)) <= width
    return lines


@pytest.mark.parametrize("width", [20, 30, 40, 60, 80, 100, 120, 200])
def test_every_number_stands_whole(width):
    words = [word for line in printed(width) for word in line.split()]
    assert "…" not in "".join(words)
    assert {number for row in NUMBERS for number in row} <= {*words}


def test_a_table_that_fits_is_one():
    assert sum("beam.thickness" in line for line in printed(200)) == 1


def test_each_part_has_the_inputs_of_its_rows():
    lines = printed(80)
    parts = sum("beam.thickness" in line for line in lines)
    assert parts > 1
    for row in NUMBERS:
        assert sum(line.split()[:2] == row[:2] for line in lines) == parts


def test_where_the_inputs_have_no_room_rows_have_numbers():
    lines = printed(30)
    numbered = [line.split()[0] for line in lines if line.split() and line.split()[0].isdigit()]
    assert set(numbered) == {"1", "2", "3", "4"} and len(numbered) % 4 == 0


def test_words_are_wrapped_and_not_cut():
    lines = printed(40, ["x", "why"], [["1.5", "the truck overturns on it at rest"]], (1,), 1)
    assert " ".join(" ".join(lines[4:]).split()).removeprefix("1.5 ") == "the truck overturns on it at rest"


def test_a_study_of_many_modes_at_eighty_columns(run, monkeypatch):
    from pathlib import Path

    monkeypatch.setattr("beamdyn.common.edge.console._PIPE_WIDTH", 80)
    scene = Path(__file__).parents[2] / "examples" / "rolling_harvester.toml"
    _, out, _ = run("study", scene, "--vary", "speed=0,50 rad/s", "--modes", "8")
    assert "…" not in out and "mode 8 [Hz]" in out
    assert max(map(len, out.splitlines())) <= 80
    assert np.isfinite(float(out.split("mode 8 [Hz]")[1].split()[3]))
