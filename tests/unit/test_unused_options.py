"""Options on which an answer does not depend are refused: they are never ignored without a word."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.cli import BAD_INPUT, main
from beamdyn.common.inputs.checks import InvalidValue

EXAMPLES = Path(__file__).parents[2] / "examples"
HARVESTER, ROLLING = str(EXAMPLES / "tyre_harvester.toml"), str(EXAMPLES / "rolling_harvester.toml")
SCENE = bd.Scene(bd.Beam.rectangular(0.05, 0.01, 2e-4, 2e11, 7850.0), bd.Mount(0.2))
ROAD = bd.RoadWave(wavelength=0.3, velocity_amplitude=0.01)
MOVING = bd.Scene(SCENE.beam, SCENE.mount, bd.RollingWheel(0.3, bd.SpinUp(40.0, 0.5), ROAD))
VARY, TOLERANCE = {"beam.thickness": [2e-4, 3e-4]}, {"beam.thickness": "+-2%"}

UNUSED = [
    (
        "frequencies",
        {"window": (0.5, 0.6)},
        r"^window = \(0.5, 0.6\): .*frequencies.*only.*peak.*leave it out",
    ),
    ("critical_speed", {"speed": 10.0}, "^speed = 10: .*critical_speed.*only.*frequencies, crossings, amp"),
    ("critical_speed", {"modes": 3}, "^modes = 3: .*critical_speed.*only.*frequencies and crossings"),
    ("crossings", {"window": (0.5, 0.6)}, "^window = .*crossings.*only.*peak"),
    ("amplitude", {"modes": 2}, "^modes = 2: .*amplitude.*only.*frequencies and crossings"),
    ("amplitude", {"window": (20.0, 30.0)}, "^window = .*amplitude.*only.*peak"),
    ("peak", {"modes": 2}, "^modes = 2: .*peak.*only.*frequencies and crossings"),
]


@pytest.mark.parametrize(("what", "options", "said"), UNUSED)
def test_a_study_refuses_what_its_answer_does_not_use(what, options, said):
    with pytest.raises(InvalidValue, match=said):
        bd.study(MOVING, VARY, what, **options)


@pytest.mark.parametrize(("what", "options", "said"), UNUSED)
def test_so_does_a_spread(what, options, said):
    with pytest.raises(InvalidValue, match=said):
        bd.spread(MOVING, TOLERANCE, what, samples=128, **options)


def test_a_speed_beside_varied_speeds_is_refused():
    with pytest.raises(InvalidValue, match=r"^speed = 10 rad/s: .*varied.*leave one of the two out"):
        bd.study(SCENE, {"speed": [0.0, 20.0]}, speed=10.0)


def test_a_speed_beside_its_tolerance_is_the_nominal_one():
    found = bd.spread(SCENE, {"speed": "+-1%"}, speed=50.0, modes=1, samples=128)
    assert found.nominal == pytest.approx(bd.natural_modes(SCENE, 50.0, 1).frequency, rel=1e-9)
    by_speed = bd.frequency_sensitivities(SCENE, 50.0, 1, ["speed"]).derivative[0]
    assert found.first_order.slope[0] == pytest.approx(by_speed, rel=1e-6)


def test_a_tolerance_of_crossings_that_are_found_one_by_one_is_refused():
    both = bd.Scene(SCENE.beam, SCENE.mount, MOVING.motion, physics=bd.Physics(planes=2))
    with pytest.raises(InvalidValue, match=r"^tolerance = 1e-06: .*one by one.*crossings.*leave it out"):
        bd.study(both, {"mount.radius": [0.1, 0.2]}, "crossings", speed=60.0, modes=1, tolerance=1e-6)


@pytest.fixture
def refusal(finished, monkeypatch, tmp_path):
    """What a command says that ends as bad input."""
    monkeypatch.chdir(tmp_path)

    def called(*arguments):
        return " ".join(finished(main([*arguments]), BAD_INPUT).err.split())

    return called


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--window", "1:2 s"), '--window = "1:2 s": '),
        (("--what", "critical_speed", "--speed", "50 rpm"), '--speed = "50 rpm": '),
        (("--what", "critical_speed", "--modes", "3"), "--modes = 3: "),
    ],
)
@pytest.mark.parametrize("how", [("--vary", "thickness=0.2:0.3:2 mm"), ("--spread", "thickness=+-1%")])
def test_the_command_names_the_option_as_it_was_given(how, options, said, refusal):
    assert said in refusal("study", HARVESTER, *how, *options)


def test_the_command_refuses_a_speed_beside_varied_speeds(refusal):
    said = refusal("study", HARVESTER, "--vary", "speed=0:10:3 rad/s", "--speed", "50 rpm")
    assert "--speed = 50 rpm: the speed is varied" in said


def test_the_command_finds_speeds_where_none_is_used_or_given(capsys):
    for options in (["--what", "critical_speed"], ["--vary", "speed=0:10:2 rad/s"]):
        assert main(["study", HARVESTER, "--vary", "thickness=0.2:0.3:2 mm", *options]) == 0
    assert "critical speed" in capsys.readouterr().out


def test_peaks_of_the_command_have_a_window_by_default(tmp_path):
    path = tmp_path / "peak.json"
    arguments = ["study", ROLLING, "--vary", "speed=1:2:2 rad/s", "--what", "peak", "--json", str(path)]
    assert main(arguments) == 0
    assert bd.load(path).question.window == (20.0, 30.0)
    assert np.isfinite(bd.load(path).value).all()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--what", "critical_speed", "--speed", "5 rad/s"), '--speed = "5 rad/s": critical_speed does not'),
        (("--what", "critical_speed", "--modes", "3"), "--modes = 3: critical_speed does not depend on it"),
        (("--what", "critical_speed", "--order", "2"), "--order = 2: critical_speed does not depend on it"),
        (("--order", "2"), "--order = 2: frequencies does not depend on it, only crossings does"),
        (("--what", "crossings", "--tolerance", "1e-6"), "only frequencies and critical_speed do"),
    ],
)
def test_sensitivities_refuse_what_their_answer_does_not_use(options, said, refusal):
    assert said in refusal("sensitivities", ROLLING, *options)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--modes", "3"), "--modes = 3: the equilibrium does not depend on it; give --t-end or --speeds"),
        (("--tolerance", "1e-3"), "--tolerance = 0.001: the equilibrium does not depend on it; give --t-end"),
        (
            ("--quantity", "strain"),
            "--quantity = strain: it only affects pictures; give --plot or --report",
        ),
    ],
)
def test_loads_refuse_what_nothing_uses(options, said, refusal):
    assert said in refusal("loads", HARVESTER, *options)


def test_random_loads_refuse_a_quantity_without_a_picture(refusal):
    road = str(EXAMPLES / "rough_road.toml")
    said = refusal("random-loads", road, "--road", "C", "--at", "0 mm", "--quantity", "stress")
    assert "--quantity = stress: it only affects pictures; give --plot or --report, or leave it out" in said
