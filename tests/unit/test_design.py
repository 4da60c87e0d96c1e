"""Designs sought backwards: wanted answers that are known, limits, the best, and what no design meets."""

from __future__ import annotations

import tomllib

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.cli import main
from beamdyn.common.results.statements import unannounced
from benchmarks.cases.wanted_designs import INWARD, ROLLING, WIDE, frequency

THICKNESS = {"beam.thickness": (1e-4, 4e-4)}
SCENE = "examples/tyre_harvester.toml"


def test_one_number_gives_the_wanted_frequency():
    found = bd.design(INWARD, THICKNESS, [bd.Target("frequencies", equals=frequency(thickness=3.3e-4))])
    assert found.found and found.solves <= 60 and not found.limited_by
    np.testing.assert_allclose(found.value, 3.3e-4, rtol=1e-10)  # the root is bracketed to that
    np.testing.assert_allclose(found.relative, 1.0, rtol=1e-9)  # f ~ h; differences of rounded frequencies
    np.testing.assert_allclose(found.derivative, [found.reached / 3.3e-4], rtol=1e-9)


def test_of_two_numbers_the_design_nearest_to_the_scene_is_found():
    found = bd.design(INWARD, WIDE, [bd.Target("frequencies", equals=1.2 * frequency())])
    spans = np.log([high / low for low, high in WIDE.values()])
    step = np.log(found.value / [0.0002, 0.05]) / spans  # in shares: along the gradient of h / L^2
    np.testing.assert_allclose(step[0] / step[1], -spans[0] / (2 * spans[1]), rtol=1e-6)
    np.testing.assert_allclose(found.relative, [[1.0, -2.0]], rtol=1e-6)  # by differences over 0.1 %


def test_a_limit_that_holds_the_best_is_named():
    critical = bd.critical_speed(INWARD)
    wanted = [
        bd.Target("frequencies", best="smallest"),
        bd.Target("critical_speed", at_least=0.8 * critical),
    ]
    found = bd.design(INWARD, THICKNESS, wanted)
    np.testing.assert_allclose(found.reached[0], 0.8 * frequency(), rtol=1e-6)  # both are proportional to h
    assert [each.partition(" at least")[0] for each in found.limited_by] == ["critical speed"]


def test_a_resonance_comes_to_the_wanted_speed():
    found = bd.design(ROLLING, THICKNESS, [bd.Target("crossings", equals=37.0, line="road +")])
    crossings = bd.resonance_speeds(found.scene_found, 60.0, 1)
    speed = next(each.speed for each in crossings if each.line.name == "road +" and each.kind == "forced")
    np.testing.assert_allclose(speed, 37.0, rtol=1e-9)  # the root is bracketed closer than that
    assert found.solves < 30  # though thick beams have no resonance up to the top speed


def test_the_strain_of_a_study_is_the_largest_of_the_steady_loads():
    with unannounced():
        found = bd.study(ROLLING, {"beam.thickness": [0.0003]}, "strain", speed=20.0)
        loads = bd.steady_loads(bd.steady_response(found.scene_at(0), [20.0], tolerance=1e-5))
    np.testing.assert_allclose(found.value, loads.largest("strain").value, rtol=1e-12)  # the same call


@pytest.mark.parametrize(
    ("targets", "is_sure"),
    [
        ([bd.Target("frequencies", equals=500.0)], True),
        ([bd.Target("critical_speed", at_most=10.0)], True),
        ([bd.Target("frequencies", at_least=80.0), bd.Target("critical_speed", at_most=100.0)], False),
    ],
)
def test_where_no_design_meets_the_targets_the_nearest_is_said(targets, is_sure):
    found = bd.design(INWARD, THICKNESS, targets)
    assert not found.found and found.only_one_way == is_sure
    said = "No design in the bounds has " if is_sure else "No design was found that has "
    assert found.sentences()[0].startswith(said)
    assert ("no other comes nearer" in " ".join(found.sentences())) == is_sure


@pytest.mark.parametrize(
    ("tip", "radius", "wanted"), [(1e-3, 0.2, 57.0), (3e-4, 0.1, 78.5), (2e-3, 0.25, 67.7)]
)
def test_a_value_is_met_exactly_beside_the_best_of_another(tip, radius, wanted):
    """The last steps close what is missed when no more designs may be tried."""
    beam = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, tip=bd.TipMass(tip))
    free = {"beam.thickness": (1e-4, 5e-4), "beam.length": (0.03, 0.08), "beam.tip.mass": (1e-5, 4e-3)}
    best = bd.Target("critical_speed", best="largest")
    scene = bd.Scene(beam, bd.Mount(radius=radius))
    found = bd.design(scene, free, [bd.Target("frequencies", equals=wanted), best])
    assert found.found and found.solves <= 60
    np.testing.assert_allclose(found.reached[0], wanted, rtol=1e-10)


def test_of_designs_far_from_a_limit_the_nearest_is_found():
    """A thousand times less than is wanted: 0.4 mm, which is the thickest, has the most."""
    found = bd.design(INWARD, {"beam.thickness": (1e-4, 4e-4)}, [bd.Target("frequencies", at_least=1e5)])
    assert not found.found and found.value[0] == 4e-4


def test_an_answer_beyond_all_numbers_is_said_in_words():
    outward = bd.Scene(INWARD.beam, bd.Mount(radius=0.2, setting_angle=np.pi))
    found = bd.design(outward, THICKNESS, [bd.Target("critical_speed", equals=160.0)])
    assert "(there it does not buckle)" in found.sentences()[0]


def test_the_answer_follows_from_the_seed_alone():
    wanted = [bd.Target("frequencies", equals=80.0, speed=50.0), bd.Target("critical_speed", at_least=200.0)]
    values = [bd.design(INWARD, WIDE, wanted, seed=3).value for _ in range(2)]
    assert (values[0] == values[1]).all()


@pytest.mark.parametrize(
    ("free", "said"),
    [
        ({"speed": (1.0, 2.0)}, "no number of a scene"),
        ({"beam.thickness": (2e-4, 1e-4)}, "finite and ascending"),
        ({"beam.thickness": (1e-4, 1.0)}, "thickness"),
        ({"beam.thicknes": None}, "give beam.thickness"),
        ({}, "with their bounds"),
    ],
)
def test_wrong_numbers_are_refused(free, said):
    with pytest.raises(ValueError, match=said):
        bd.design(INWARD, free, [bd.Target("frequencies", equals=80.0)])


def test_wrong_targets_are_refused():
    for wrong, said in (
        ({}, "give one of equals"),
        ({"equals": 1.0, "at_most": 2.0}, "give one of equals"),
        ({"equals": -1.0}, "greater than 0"),
        ({"equals": 1.0, "line": "road +"}, "line"),
        ({"equals": 1.0, "window": (1.0, 2.0)}, "window"),
    ):
        with pytest.raises(ValueError, match=said):
            bd.Target("frequencies", **wrong)
    best = bd.Target("frequencies", best="largest")
    with pytest.raises(ValueError, match="one answer alone"):
        bd.design(INWARD, THICKNESS, [best, best])


def test_the_command_writes_the_scene_that_it_finds(tmp_path, capsys):
    to = tmp_path / "found.toml"
    ask = ["design", SCENE, "--free", "length=30:60 mm", "--so-that"]
    assert main([*ask, "frequency 1 at 10 rad/s = 80 Hz", "--write", str(to)]) == 0
    assert "met" in capsys.readouterr().out
    found = bd.load_scene(to)
    np.testing.assert_allclose(bd.natural_modes(found, 10.0, 1).frequency, 80.0, rtol=1e-9)  # ten digits
    assert "beam" in tomllib.loads(to.read_text())
    assert main([*ask, "frequency 1 = 800 Hz"]) == 1
    assert "the nearest is beam.length = 30 mm" in " ".join(capsys.readouterr().out.split())
    assert main([*ask, "frequenzy 1 = 800 Hz"]) == 2
    assert "give e.g." in capsys.readouterr().err
