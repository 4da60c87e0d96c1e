"""Messages of commands name options, files and commands, and nothing of Python."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from beamdyn.common.edge.exit_codes import DONE
from beamdyn.common.edge.refusal_words import as_typed
from beamdyn.common.inputs.checks import InvalidValue

EXAMPLES = Path(__file__).parents[2] / "examples"
ROLLING, TYRE = str(EXAMPLES / "rolling_harvester.toml"), str(EXAMPLES / "tyre_harvester.toml")
ROAD = str(EXAMPLES / "rough_road.toml")
THICKNESS = ("--vary", "beam.thickness=0.2,0.3 mm")

MESSAGES = [
    (("response", ROLLING, "--frequencies", "5, 1 Hz"), "--frequencies = 1: it follows 5"),
    (("response", ROLLING, "--frequencies", "5 Hz", "--modes", "0"), "--modes = 0"),
    (("response", ROLLING, "--frequencies", "5 Hz", "--input", "foo"), '--input = "foo"'),
    (("response", ROLLING, "--frequencies", "5 Hz", "--output", "foo"), 'or "deflection@20 mm"'),
    (("response", ROLLING, "--frequencies", "5 Hz", "--output", "tip across"), "[physics] planes = 2"),
    (("random", ROLLING, "--road", "A", "--input", "n1"), '--input = "n1"'),
    (("random", TYRE, "--road", "A"), "[motion]: missing: a road needs the rolling radius"),
    (("random", ROLLING, "--road", "A"), "--damping-ratio = 0"),
    (("random", ROAD, "--road", "A", "--highest", "1e-9 1/m"), "it must be below --highest = 1e-09 1/m"),
    (("random", ROAD, "--road", "A", "--input", "force@tip"), '--input = "force@tip"'),
    (("random", ROAD, "--road", "A", "--input", "force@2 mm across"), '--input = "force@2 mm across"'),
    (("random", ROAD, "--road", "A", "--output", "deflection@1 m"), "position after @ = 1 m"),
    (("loads", TYRE, "--points", "0:90 mm"), "leave --points out"),
    (("campbell", TYRE, "--top-speed", "9 rad/s", "--operating", "5:50 rad/s"), "--operating = 50 rad/s"),
    (("random", ROLLING, "--psd", "negative.csv"), "--psd, values = -2"),
    (
        ("study", ROLLING, *THICKNESS, "--vary", "speed=0,1,2 rad/s", "--together"),
        "--together: the inputs have 2",
    ),
    (
        ("study", ROLLING, *THICKNESS, "--vary", "speed=1,2 rad/s", "--what", "critical_speed"),
        '--vary = "speed"',
    ),
    (("study", ROLLING, *THICKNESS, "--tolerance", "5"), "--tolerance = 5"),
    (("study", ROLLING, *THICKNESS, "--workers", "0"), "--workers = 0"),
    (("study", TYRE, *THICKNESS, "--what", "crossings"), "--speed = 0 rad/s"),
    (("sensitivities", ROLLING, "--inputs", "beam.thicknes"), '--inputs = "beam.thicknes"'),
    (("steady", ROLLING, "--speeds", "5 rad/s", "--tolerance", "0"), "--tolerance = 0"),
    (("modes", ROLLING, "--modes", "0"), "--modes = 0"),
]
_OF_PYTHON = re.compile(r"\bbd\.|\bnumpy\b|\bNone\b|\bTrue\b|[A-Z]\w+\(|\bcombine\b|RollingWheel|= '")


@pytest.mark.parametrize(("command", "said"), MESSAGES, ids=lambda each: " ".join(each[2:]) or None)
def test_a_refusal_names_options(run, tmp_path, monkeypatch, command, said):
    (tmp_path / "negative.csv").write_text("f [Hz], psd [m2/s4/Hz]\n1,1\n50,-2\n")
    monkeypatch.chdir(tmp_path)
    code, _, err = run(*command)
    assert code != DONE and said in err
    assert not _OF_PYTHON.search(err.replace(str(EXAMPLES), "")), err


def test_a_name_that_is_no_option_of_the_command_stays(run):
    run("locus", ROLLING, "--speeds", "x")  # the last command typed, which has --speeds and no --speed
    assert as_typed(InvalidValue("speed", 5.0, "too fast")) == "speed = 5: too fast"
    assert as_typed(InvalidValue("speeds", 5.0, "too fast")) == "--speeds = 5: too fast"
