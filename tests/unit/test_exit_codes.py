"""One rule for the exit codes of all commands: 0 an answer, 1 the model has none, 2 bad input."""

from __future__ import annotations

from pathlib import Path

import pytest

from beamdyn.common.edge.exit_codes import BAD_INPUT, DONE, NO_ANSWER

ROOT = Path(__file__).parents[2]
INWARD = (ROOT / "examples" / "rolling_harvester.toml").read_text()  # it buckles at 159.8 rad/s
DAMPED = INWARD.replace("[motion]", "[model]\ndamping_ratio = 0.01\n\n[motion]", 1)
SCENES = {
    "inward": INWARD,
    "outward": INWARD.replace('"0 deg" # inward', '"180 deg"'),
    "damped": DAMPED,
    "fast": DAMPED.replace('"55 rad/s"', '"300 rad/s"'),
}
DESIGNS = ("--vary", "beam.thickness=0.1:0.12:2 mm")
SHORT = ("--window", "11:12 s")

# What does not exist is an answer to the question whether, and where, it exists.
NOTHING_THERE = [
    ("critical", "outward"),
    ("study", "outward", *DESIGNS, "--what", "critical_speed"),
    ("study", "outward", *DESIGNS, "--what", "crossings", "--speed", "1 rad/s"),
    ("resonances", "outward", "--top-speed", "1 rad/s"),
    ("sensitivities", "outward", "--what", "crossings", "--speed", "1 rad/s"),
    ("locus", "inward", "--speeds", "100, 300 rad/s"),  # there is an answer at one of them
    ("study", "inward", "--vary", "speed=100:300:2 rad/s"),
    ("steady", "damped", "--speeds", "100, 300 rad/s"),
    ("equilibrium", "inward", "--speed", "300 rad/s"),  # the beam has bent to it
    ("branches", "outward", "--top-speed", "9 rad/s"),  # nothing buckles
    ("campbell", "outward", "--top-speed", "1 rad/s"),  # no crossing
    ("matrices", "inward", "--speed", "300 rad/s"),  # the equations hold at any speed
]
PAST_THE_CRITICAL_SPEED = [
    ("modes", "inward", "--speed", "300 rad/s"),
    ("locus", "inward", "--speeds", "200, 300 rad/s"),
    ("sensitivities", "inward", "--speed", "300 rad/s"),
    ("sensitivities", "outward", "--what", "critical_speed"),
    ("loads", "inward", "--speed", "300 rad/s"),
    ("loads", "damped", "--speeds", "300 rad/s"),
    ("loads", "fast", "--t-end", "12 s"),
    ("response", "damped", "--speed", "300 rad/s", "--frequencies", "1, 2 Hz"),
    ("random", "damped", "--speed", "300 rad/s", "--road", "A"),
    ("random-loads", "damped", "--speed", "300 rad/s", "--road", "A"),
    ("steady", "damped", "--speeds", "300 rad/s"),
    ("simulate", "fast", "--t-end", "12 s"),
    ("sweep", "damped", "--speeds", "300 rad/s", *SHORT),
    ("study", "inward", *DESIGNS, "--speed", "300 rad/s"),
    ("study", "damped", *DESIGNS, "--speed", "300 rad/s", "--what", "amplitude"),
    ("study", "damped", *DESIGNS, "--speed", "300 rad/s", "--what", "peak", *SHORT),
]
BAD = [
    ("modes", "inward", "--speed", "300"),
    ("critical", "inward", "--discretization", "fe"),
    ("study", "inward"),
    ("response", "inward", "--frequencies", "2, 1 Hz"),
]


@pytest.fixture
def code_of(run, tmp_path):
    """Exit code of a command on one of the scenes, and what it says."""

    def code_of(command, scene, *options):
        path = tmp_path / f"{scene}.toml"
        path.write_text(SCENES[scene])
        code, _, err = run(command, path, *options)
        return code, err

    return code_of


@pytest.mark.parametrize("command", NOTHING_THERE, ids=" ".join)
def test_what_does_not_exist_is_an_answer(code_of, command):
    assert code_of(*command)[0] == DONE


@pytest.mark.parametrize("command", PAST_THE_CRITICAL_SPEED, ids=" ".join)
def test_past_the_critical_speed_there_is_no_answer(code_of, command):
    code, err = code_of(*command)
    assert code == NO_ANSWER and "beamdyn: no answer: " in err


@pytest.mark.parametrize("command", BAD, ids=" ".join)
def test_bad_input(code_of, command):
    assert code_of(*command)[0] == BAD_INPUT
