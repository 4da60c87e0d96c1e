"""Cycles of `beamdyn loads`: counted as the standard does, in files, with damage-equivalent ranges."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.cli import BAD_INPUT, DONE, main
from beamdyn.loads.load_path import LoadPath

pytest.importorskip("rainflow", reason="cycle counts are the extra fatigue")

ROLLING = str(Path(__file__).parents[2] / "examples" / "rolling_harvester.toml")
RUN = ("--t-end", "0.3 s", "--modes", "2", "--window", "0.1:0.3 s", "--at", "0 mm")
# ASTM E1049-85, section 5.4.4 and Fig. 6: a history, and its ranges with their numbers of cycles.
HISTORY = [-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0]
OF_THE_STANDARD = {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5}
ROUNDING = 1e-14  # of a sum of a few powers


@pytest.fixture(scope="module")
def loads() -> bd.TransientLoads:
    return bd.transient_loads(bd.simulate(bd.load_scene(ROLLING), 0.3, 2), at=[0.0])


@pytest.fixture
def standard(loads, monkeypatch) -> bd.LoadCycles:
    """Cycles of the standard's history in place of a moment's."""
    monkeypatch.setattr(LoadPath, "turning_values", lambda *_: np.array(HISTORY))
    return bd.count_cycles(loads, "moment")


def test_cycles_are_those_of_the_standard(standard):
    counted = {float(r): float(standard.counts[standard.ranges == r].sum()) for r in {*standard.ranges}}
    assert counted == OF_THE_STANDARD


@pytest.mark.parametrize(("exponent", "by_hand"), [(1.0, 23.0), (2.0, 151.0**0.5), (3.0, 1094.0 ** (1 / 3))])
def test_equivalent_ranges_are_those_by_hand(standard, exponent, by_hand):
    """(sum of n range^m)^(1/m): 23 = 1.5 + 6 + 3 + 8 + 4.5, 151 = 4.5 + 24 + 18 + 64 + 40.5, ..."""
    assert standard.equivalent_range(exponent) == pytest.approx(by_hand, rel=ROUNDING)
    assert standard.equivalent_range(exponent, 2.0**exponent) == pytest.approx(by_hand / 2, rel=ROUNDING)


@pytest.fixture
def run(capsys):
    def called(*arguments):
        code = main(["loads", ROLLING, *RUN, *map(str, arguments)])
        out, err = capsys.readouterr()
        return code, out, " ".join(err.split())

    return called


def test_cycles_are_written(run, loads, tmp_path):
    wanted = bd.count_cycles(loads, "moment", start=0.1, end=0.3)
    assert run("--cycles", "moment", "--cycles-file", tmp_path / "c.csv")[0] == DONE
    head, *rows = csv.reader((tmp_path / "c.csv").read_text().splitlines())
    assert head == ["range_of_moment_N_m", "mean_N_m", "cycles"]
    columns = np.array(rows, dtype=float).T
    assert np.array_equal(columns, [wanted.ranges, wanted.means, wanted.counts])
    assert run("--cycles", "moment", "--cycles-file", tmp_path / "c.json")[0] == DONE
    back = bd.load(tmp_path / "c.json")
    assert np.array_equal(back.ranges, wanted.ranges) and (back.start, back.end) == (0.1, 0.3)


def test_equivalent_ranges_of_several_exponents_are_printed(run, loads):
    cycles = bd.count_cycles(loads, "strain", start=0.1, end=0.3)
    code, out, _ = run(
        "--cycles", "strain", "--woehler", "3, 5.5", "--equivalent-cycles", "100"
    )  # fmt: skip
    assert code == DONE
    assert "Damage-equivalent ranges (number of equal cycles: 100)" in out
    rows = [line.split() for line in out.splitlines() if line.split()[:1] in (["3"], ["5.5"])]
    printed = {float(m): float(value) for m, value in rows}
    wanted = {m: 1e6 * cycles.equivalent_range(m, 100.0) for m in (3.0, 5.5)}
    assert printed == pytest.approx(wanted, rel=5e-3)


def test_no_digit_of_an_equivalent_range_is_beyond_its_error(run, loads):
    cycles = bd.count_cycles(loads, "strain", start=0.1, end=0.3)
    (found,) = cycles.equivalents([5.0], 1.0)
    _, out, _ = run("--cycles", "strain", "--woehler", "5")
    (value,) = (line.split()[1] for line in out.splitlines() if line.split()[:1] == ["5"])
    assert 1e-6 * 10.0 ** -len(value.partition(".")[2]) > found.error / 2


@pytest.mark.parametrize("exponent", [3.0, 10.0])
def test_turning_points_are_found_between_the_samples_of_a_run(exponent):
    """A run in few steps, against cycles that are counted from 200 001 samples of it."""
    from rainflow import extract_cycles

    strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, tip=bd.TipMass(0.001))
    wheel = bd.RollingWheel(0.3, bd.SpinUp(55.0, duration=0.3), bd.RoadWave(0.1, height=0.001))
    loads = bd.transient_loads(bd.simulate(bd.Scene(strip, bd.Mount(0.215), wheel), 0.5, 3), at=[0.0])
    cycles = bd.count_cycles(loads, "moment")
    values = loads.at("moment", np.linspace(0, 0.5, 200_001))[:, 0, 0]
    counted = np.array([cycle[:3] for cycle in extract_cycles(values)]).T
    exact = replace(cycles, ranges=counted[0], means=counted[1], counts=counted[2])
    of_each = 2e-6 * cycles.ranges.max()  # both ends are known to a millionth of the largest range
    assert cycles.error == pytest.approx(of_each + 2 * loads.moment_error[0, 0])
    (found,) = replace(cycles, error=of_each).equivalents([exponent], 1.0)
    assert found.error == pytest.approx(of_each * cycles.counts.sum() ** (1 / exponent))
    assert abs(found.range - exact.equivalent_range(exponent)) <= found.error


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (
            ("--woehler", "5"),
            '--woehler = "5": it needs counted cycles; give --cycles, too',
        ),
        (("--cycles-file", "c.csv"), "--cycles-file = c.csv: it needs counted cycles; give --cycles, too"),
        (("--cycles", "strain", "--equivalent-cycles", "5"), "give --woehler, too"),
        (("--cycles", "strain", "--woehler", "five"), 'give numbers, such as "3, 5, 10"'),
        (
            ("--cycles", "strain", "--woehler", "3, -5"),
            "--woehler = -5: it must be greater than 0",
        ),
        (
            ("--cycles", "strain", "--woehler", "3", "--equivalent-cycles", "0"),
            "--equivalent-cycles = 0: it must be greater than 0",
        ),
        (("--cycles", "strain", "--cycles-file", "c.png"), "--cycles-file = c.png: unknown suffix '.png'"),
    ],
)
def test_options_of_cycles_are_refused_in_a_sentence(options, said, run, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    code, _, err = run(*options)
    assert code == BAD_INPUT and said in err


def test_equivalent_ranges_are_in_the_json_file(run, loads, tmp_path):
    cycles, file = bd.count_cycles(loads, "strain", start=0.1, end=0.3), tmp_path / "loads.json"
    equal = "--woehler", "3, 5.5", "--equivalent-cycles", "100"
    assert run("--cycles", "strain", *equal, "--json", file)[0] == DONE
    found = json.loads(file.read_text())["equivalent_ranges"]
    assert [(each["exponent"], each["cycles"], each["range"]) for each in found] == [
        (m, 100.0, cycles.equivalent_range(m, 100.0)) for m in (3.0, 5.5)
    ]
    assert {(each["quantity"], each["x"], each["start"], each["end"]) for each in found} == {
        ("strain", cycles.x, 0.1, 0.3)
    }
    back = bd.load(file)
    assert isinstance(back, bd.TransientLoads)
    assert [each.exponent for each in back.equivalent_ranges] == [3.0, 5.5]
